//! Barrels and lenses, whose corner has its centre beyond the axis: positions that the verifier reads as the engine does, motions that it
//! proves, and what it finds where one is broken.

use apt_geometry::motion::{AxisAngle, ToolAxis};

use Relation::{On, To};
use Turn::Forward;

use super::{ends::limited, *};
use crate::verify::{
    tests::{BARRELS, lofts, tabulated},
    verify,
};

/// Walls near the origin that are touched from where y is less, with names.
fn walls() -> Vec<(&'static str, Geometry)> {
    let leaning = v(1.0, 0.0, 0.0);
    vec![
        ("upright plane", y(0.0)),
        ("plane over the tool", plane(0.0, 1.0, 0.35, 0.0)),
        ("plane leaning away", plane(0.1, 1.0, -0.5, 0.0)),
        ("cylinder outside", cylinder(v(0.0, 3.0, 0.0), Vec3::z(), 3.0)),
        ("cylinder inside", cylinder(v(0.0, -4.0, 0.0), Vec3::z(), 4.0)),
        ("skew cylinder outside", cylinder(v(0.0, 3.0, 0.0), v(0.2, 0.1, 1.0), 3.0)),
        ("level cylinder", cylinder(v(0.0, 2.0, 1.0), leaning, 2.0)),
        ("sphere outside", sphere(0.0, 3.0, 1.0, 3.0)),
        ("sphere inside", sphere(0.0, -4.0, 1.0, 4.0)),
        ("cone outside", cone(v(0.0, 4.0, 8.0), -Vec3::z(), 25.0)),
        ("cone over the tool", cone(v(0.0, 5.0, -8.0), Vec3::z(), 25.0)),
        ("cone inside", cone(v(0.0, -4.0, -8.0), Vec3::z(), 25.0)),
        ("skew cylinder inside", cylinder(v(0.0, -4.0, 0.0), v(0.0, 0.2, 1.0), 4.0)),
        ("ellipsoid outside", quadric([1.0, 1.0, 0.3, 0.0, 0.0, 0.0, 0.0, 0.0, -3.0, 0.0])),
        ("ellipsoid inside", quadric([1.0, 1.0, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0])),
        ("saddle", quadric([1.0, 1.0, -0.3, 3.0, 0.0, 0.0, 0.0, 0.0, -3.0, 0.0])),
        ("tabulated", tabulated([Vec3::x(), Vec3::y(), Vec3::z()], &WAVE)),
        (
            "leaning tabulated",
            tabulated([Vec3::x(), v(0.0, 1.0, -0.3).normalize(), v(0.0, 0.3, 1.0).normalize()], &WAVE),
        ),
        ("roof on its side", lofts::roof()),
    ]
}

/// A wave along which a cutter fits.
const WAVE: [[f64; 3]; 3] = [[-2.0, 0.0, 0.1], [0.0, 0.0, -0.1], [2.0, 0.1, 0.1]];

/// Both sheets that lie below, with the ground.
fn floors() -> Vec<(&'static str, Geometry)> {
    vec![
        ("level plane", ground()),
        ("canted plane", plane(0.2, 0.1, 1.0, 0.0)),
        ("cylinder", cylinder(v(0.0, 0.0, -3.0), v(0.3, 1.0, 0.1), 3.0)),
        ("hollow cylinder", cylinder(v(0.0, 0.0, 6.0), v(0.3, 1.0, 0.1), 6.0)),
        ("sphere", sphere(0.0, 0.0, -4.0, 4.0)),
        ("cone", cone(v(0.0, 0.0, 1.0), v(0.1, 0.0, -1.0), 65.0)),
        ("bowl", quadric([0.3, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0])),
        ("roof", lofts::roof()),
        ("vault", lofts::vault()),
    ]
}

/// A position is as far from every surface as the verifier reads it, met anew and along a way.
#[test]
fn the_verifier_reads_a_barrel_as_the_engine_does() {
    let (mut seen, mut measured, mut wrong) = (0, 0, Vec::new());
    for (name, geometry) in walls().into_iter().chain(floors()) {
        for (which, numbers) in BARRELS.iter().enumerate() {
            let cutter = Cutter::from_numbers(numbers, 1.0).expect("cutter");
            for axis in [Vec3::z(), v(0.25, -0.3, 1.0).normalize()] {
                let tool = Tool::new(cutter, axis);
                let mut role = touched(&geometry);
                let from = v(-0.8, -0.6, 1.0);
                role.side = gauge(&role).surface.signed_distance(&(from + axis)).signum();
                let known = gauge(&role);
                for k in 0..6 {
                    let mut tip = from + v(0.3, 0.05, 0.02) * f64::from(k);
                    // Near the surface, where it has one way out.
                    for _ in 0..8 {
                        let contact = known.contact(&tool, &tip);
                        tip -= contact.gradient * (contact.clearance - 0.02);
                    }
                    let found = known.contact(&tool, &tip);
                    let fresh = gauge(&role).contact(&tool, &tip).clearance;
                    let gap = (found.tool - found.surface).dot(&found.gradient);
                    let read = read_by_verifier(&role, cutter, ToolPosition { tip, axis });
                    let off = [fresh, gap, read].map(|other| (other - found.clearance).abs());
                    let is_near = found.clearance.abs() < 0.1;
                    (seen, measured) = (seen + 1, measured + u32::from(is_near));
                    if is_near && off.iter().any(|off| *off > 1e-7) {
                        wrong.push(format!("{name} {which} {k} {}: {} {off:?}", axis.z, found.clearance));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {seen}: {wrong:#?}", wrong.len());
    assert!(measured * 10 >= seen * 9, "{measured} of {seen}");
}

/// The outcome of a motion that is proven, with no more than so many clearances.
fn proven(p: &Program, motion: &MotionCommand, most: u64) -> Result<CutSequence, String> {
    let (execution, taken) = limited(p, motion, most);
    let Some(Output::Sequence(sequence)) = execution.output else {
        return Err(format!("{:?} after {taken} clearances", execution.failure));
    };
    match verify(&sequence, &|| false) {
        Ok(evidence) if evidence.verified => Ok(sequence),
        Ok(evidence) => Err(format!("{:?}", evidence.violations)),
        Err(error) => Err(format!("{error:?}")),
    }
}

/// What a vertex that is moved by one and a half bands does to a motion.
fn is_found_out(sequence: &CutSequence, role: &Role) -> bool {
    let middle = sequence.points.len() / 2;
    let ToolPosition { tip, axis } = sequence.points[middle];
    let normal = gauge(role).contact(&Tool::new(sequence.cutter, axis), &tip).gradient;
    let band = role.inside_tolerance + role.outside_tolerance;
    [1.5, -1.5].into_iter().all(|share| {
        let mut broken = sequence.clone();
        broken.points[middle].tip += normal * (share * band);
        !verify(&broken, &|| false).expect("evidence").verified
    })
}

/// Along every wall on level and canted ground.
#[test]
fn barrels_go_along_walls() {
    let mut wrong = Vec::new();
    for (name, wall) in walls().iter().take(18) {
        for (which, numbers) in BARRELS.iter().enumerate() {
            for (floor, part) in [("level", ground()), ("canted", plane(0.1, -0.15, 1.0, 0.0))] {
                let mut p = Program::new();
                p.tolerance(0.001, 0.001).cutter(numbers).from(-1.0, -2.5, 1.5);
                p.indirv(0.0, 1.0, 0.0);
                let start = start(&[(To, wall), (To, &part), (On, &x(-0.8))]);
                if let Err(failure) = p.attempt(&start) {
                    wrong.push(format!("{name} {which} {floor}: start {failure:?}"));
                    continue;
                }
                p.side(DriveSide::Right).indirv(1.0, 0.0, 0.0);
                match proven(&p, &motion(Forward, wall, &[(On, 1, &x(0.8))]), 20_000) {
                    Err(what) => wrong.push(format!("{name} {which} {floor}: {what}")),
                    Ok(sequence) => {
                        let drive = sequence.drive.as_ref().expect("a drive surface");
                        if !is_found_out(&sequence, drive) {
                            wrong.push(format!("{name} {which} {floor}: a broken one is proven"));
                        }
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}: {wrong:#?}", wrong.len());
}

/// Over every floor, along planes upright and leaning.
#[test]
fn barrels_go_over_floors() {
    let mut wrong = Vec::new();
    for (name, floor) in &floors() {
        for (which, numbers) in BARRELS.iter().enumerate() {
            for drive in [y(0.3), plane(0.2, 1.0, 0.3, 0.3)] {
                let mut p = Program::new();
                p.tolerance(0.001, 0.001).cutter(numbers).from(-1.0, -2.0, 4.0);
                let start = start(&[(To, &drive), (To, floor), (On, &x(-0.8))]);
                if let Err(failure) = p.attempt(&start) {
                    wrong.push(format!("{name} {which}: start {failure:?}"));
                    continue;
                }
                p.side(DriveSide::Right).indirv(1.0, 0.0, 0.0);
                match proven(&p, &motion(Forward, &drive, &[(On, 1, &x(0.8))]), 20_000) {
                    Err(what) => wrong.push(format!("{name} {which}: {what}")),
                    Ok(sequence) => {
                        let part = sequence.part.as_ref().expect("a part surface");
                        if !is_found_out(&sequence, part) {
                            wrong.push(format!("{name} {which}: a broken one is proven"));
                        }
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}: {wrong:#?}", wrong.len());
}

/// Normal to a ball, and at angles to it: the angle holds at the contact, on the bottom, its edge or the arc, and the motion is proven.
#[test]
fn a_barrel_that_follows_a_ball_has_its_angle_at_the_contact() {
    let (ball, middle) = (sphere(0.0, 0.0, 0.0, 5.0), y(0.0));
    let [little, more] = [0.1f64, 0.25];
    let at = |angle: f64, mode: AxisAngle| ToolAxis::AtAngle { part: true, angle, mode };
    for numbers in &BARRELS {
        for (angle, mode) in [
            (0.0, ToolAxis::Normal { part: true }),
            (little, at(little, AxisAngle::Plain)),
            (more, at(more, AxisAngle::Lead(0.1))),
            (more, at(more, AxisAngle::PerpendicularTo(Vec3::y()))),
        ] {
            let mut p = Program::new();
            p.tolerance(0.001, 0.001).cutter(numbers).from(-2.0, 0.0, 7.0);
            p.run(&MotionCommand::ToolAxis(mode));
            p.go(&[(On, &middle), (To, &ball), (On, &x(-1.0))]);
            p.drive(Forward, &middle, On, &x(2.0));
            for sequence in &p.sequences {
                let evidence = verify(sequence, &|| false).expect("evidence");
                assert!(evidence.verified, "{numbers:?} {mode:?}: {:?}", evidence.violations);
            }
            let part = p.last().part.as_ref().expect("a part surface");
            for place in &p.last().points {
                let tool = Tool::new(p.last().cutter, place.axis);
                let normal = gauge(part).contact(&tool, &place.tip).gradient;
                let off = normal.dot(&place.axis) - angle.cos();
                // A slanted bottom touches with its tip or along a line, where the nearest place is another one.
                let is_flat = numbers[4] == 0.0 && tool.profile.lower.height == 0.0;
                assert!(!is_flat || off.abs() < 1e-9, "{numbers:?} {mode:?}: {off} at {place:?}");
            }
        }
    }
}

/// Inside an ellipsoid that the top of a barrel and its arc touch at once no bound of one contact shows all, and circles about the arc do. Places
/// of these, which are outside of the tool, are none of its.
#[test]
fn a_barrel_that_touches_a_hollow_at_two_places_is_read_closely() {
    let hollow = quadric([
        0.06614692768663992,
        0.0008863881793618935,
        0.13829445350677125,
        1.4633751965988875,
        -0.002639682580704473,
        0.01746953577405721,
        -0.007644685435752386,
        0.1500487509904771,
        -0.014867742736422149,
        -0.49310482664104327,
    ]);
    let numbers =
        [0.8467886636148241, 1.0210002007888628, -0.5976058689814507, 0.6968801654050862, 0.0, 0.0, 2.345];
    let cutter = Cutter::from_numbers(&numbers, 1.0).expect("cutter");
    let axis = v(0.6680636576480471, 0.3239511822090283, 0.6698854983318313).normalize();
    let tool = Tool::new(cutter, axis);
    let role = Role { side: -1.0, ..touched(&hollow) };
    for share in [0.9, 0.95, 0.99, 1.0, 1.01] {
        let tip = v(-1.31384, -0.51094, 1.64015) + v(-0.00907, -0.02922, -0.01743) * share;
        let found = gauge(&role).contact(&tool, &tip).clearance;
        let read = read_by_verifier(&role, cutter, ToolPosition { tip, axis });
        assert!((read - found).abs() < 1e-9, "{share}: {read} and {found}");
    }
}
