//! GOUGCK/ON over the length of motions with the tool end ON part surfaces of every kind that is hollow somewhere, under every
//! axis that such a motion can have: what is told agrees with dense sampling of the tool's boundary.

use apt_geometry::{
    canonical::Remembering,
    cutter::Disk,
    motion::{RoleDisk, ToolAxis},
    surface::Surface,
};

use super::{turning::part_surface, *};
use crate::{attitude::Sweep, error::RoleName};

/// Tool radius.
const RADIUS: f64 = 0.25;
/// INTOL and OUTTOL.
const BAND: f64 = 0.001;
/// Places on a cut vector, and around the tool.
const PLACES: [u32; 2] = [24, 240];
/// How far the depth that is told may be from the sampled one, as a share of it.
const AGREEMENT: f64 = 0.02;

/// A part surface and where along x the motion runs over it.
fn hollows() -> Vec<(&'static str, Geometry, [f64; 2])> {
    let dish = [1.0 / 25.0, 1.0 / 16.0, 1.0 / 16.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.25];
    vec![
        ("trough", cylinder(v(0.0, 0.0, 5.0), v(1.0, 0.6, 0.0), 5.0), [-0.8, 0.9]),
        ("bowl", sphere(0.0, 0.0, 5.0, 5.0), [-0.8, 0.9]),
        ("funnel", cone(v(0.0, 0.0, -1.0), v(0.0, 0.0, 1.0), 60.0), [0.8, 1.6]),
        ("dish", quadric(dish), [-0.8, 0.9]),
        ("saddle", part_surface(4, 0.5, 0.0), [-0.8, 0.9]),
        ("wave", part_surface(5, 0.5, 0.2), [-0.6, 0.6]),
        ("twisted strip", part_surface(6, 0.5, 0.0), [-0.5, 0.5]),
        ("channel", channel(4.0), [-0.8, 0.9]),
    ]
}

/// The lower quarter of a tube along x from −3 to 3, as a polyconic; its bottom is at z = 0.
fn channel(radius: f64) -> Geometry {
    let side = radius * std::f64::consts::FRAC_1_SQRT_2;
    let mut values = vec![1.0];
    values.extend([0.0; 12]);
    values.extend([0.0, -3.0, 6.0]);
    for constant in [side, -side, side, side, -side, radius - side, std::f64::consts::FRAC_1_SQRT_2] {
        values.push(constant);
        values.extend([0.0; 7]);
    }
    values.extend([0.0; 7]);
    Geometry::PolyConic(Remembering::new(values))
}

/// The deepest place of the tool's edges below the surface, over the whole motion.
fn sampled(sequence: &CutSequence) -> f64 {
    let role = sequence.part.as_ref().expect("a part surface");
    let surface = Surface::from_geometry(&role.surface.geometry).expect("a surface");
    let tool = Tool::new(sequence.cutter, sequence.start.axis);
    let mut deepest = f64::NEG_INFINITY;
    let mut from = &sequence.start;
    for to in &sequence.points {
        let sweep = Sweep::new(&tool, (&from.tip, &from.axis), (&to.tip, &to.axis));
        for place in 0..=PLACES[0] {
            let (tip, tool) = sweep.at(sweep.length * f64::from(place) / f64::from(PLACES[0]));
            for turn in 0..PLACES[1] {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(turn) / f64::from(PLACES[1])).sin_cos();
                let (radius, heights) = match role.disk {
                    Some(disk) => (disk.radius, [disk.height, disk.height + disk.cutter().height]),
                    None => (RADIUS, [0.0, tool.cutter.height]),
                };
                let edge = (tool.across[0] * cos + tool.across[1] * sin) * radius;
                for height in heights {
                    let point = tip + edge + tool.axis * height;
                    deepest = deepest.max(-role.side * surface.signed_distance(&point));
                }
            }
        }
        from = to;
    }
    deepest
}

/// The depths that are told of a motion over a part surface, with the tool end ON it, and the sampled depth.
fn told_and_sampled(
    part: &Geometry,
    [begin, end]: [f64; 2],
    mode: ToolAxis,
    disk: Option<RoleDisk>,
) -> (Vec<f64>, f64) {
    let drive = plane(-0.1, 1.0, 0.0, 0.05);
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let mut p = Program::new();
    p.tolerance(BAND, BAND).cutter(&[2.0 * RADIUS]).from(begin - 0.3, 0.0, 2.0);
    p.run(&MotionCommand::ToolAxis(mode)).run(&MotionCommand::GougeCheck(true));
    p.run(&MotionCommand::Disk(disk)).part_side(PartSide::On);
    p.go(&[(Relation::On, &drive), (Relation::On, part), (Relation::On, &x(begin))]);
    p.warnings.clear();
    p.indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &drive, Relation::On, &x(end));
    let depths = p.warnings.iter().map(|warning| match warning {
        MotionWarning::Gouge { role: RoleName::Part, depth, ahead: false, .. } => *depth,
        other => panic!("{other:?}"),
    });
    (depths.collect(), sampled(p.last()))
}

/// What is told agrees with what is sampled.
fn agree(told: &str, depths: &[f64], expected: f64) {
    let most = depths.iter().copied().fold(0.0, f64::max);
    if expected <= BAND {
        assert!(most <= BAND * (1.0 + AGREEMENT), "{told}: {most} told, {expected} sampled");
    } else {
        assert!((most - expected).abs() <= AGREEMENT * expected, "{told}: {most}, {expected} sampled");
    }
}

#[test]
fn gouges_of_a_tool_on_hollow_part_surfaces_agree_with_dense_sampling() {
    let leaning = v(0.15, -0.1, 1.0).normalize();
    for (name, part, range) in hollows() {
        for mode in [ToolAxis::Fixed(Vec3::z()), ToolAxis::Fixed(leaning), ToolAxis::Normal { part: true }] {
            let told = format!("{name}, {mode:?}");
            let (depths, expected) = told_and_sampled(&part, range, mode, None);
            agree(&told, &depths, expected);
            // A flat bottom ON a hollow surface cannot but cut into it.
            assert!(name == "wave" || name == "twisted strip" || expected > BAND, "{told}: {expected}");
        }
    }
}

/// A disk that the part surface is measured by is what cuts into it.
#[test]
fn gouges_of_a_disk_above_the_tool_end_agree_with_dense_sampling() {
    let leaning = v(0.05, -0.04, 1.0).normalize();
    for (name, part, range) in hollows() {
        for (radius, height) in [(0.6, 0.0), (1.2, 0.03)] {
            for mode in [ToolAxis::Fixed(Vec3::z()), ToolAxis::Fixed(leaning)] {
                let disk = RoleDisk { part: true, disk: Disk { radius, height } };
                let (depths, expected) = told_and_sampled(&part, range, mode, Some(disk));
                agree(&format!("{name}, {radius} {height}, {mode:?}"), &depths, expected);
            }
        }
    }
}
