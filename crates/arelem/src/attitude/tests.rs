//! Axes along the surface that the flank cuts: PARLEL, PERPTO, TANDS and FAN.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Remembering, RuledSurface},
    motion::{AxisTangency, DriveSide, MotionCommand, Relation, ToolAxis, Turn},
    surface::Surface,
};

use crate::{
    clearance::{EVALUATIONS, Gauge, Tool},
    error::{AxisFailure, MotionFailure},
    tests::{Program, circle, cone, plane, sphere, start, v},
};

/// A wall that leans inward: from a circle of radius 6 at z=0 to one of radius 5 at z=4, both about (3, −6).
fn leaning_wall() -> Geometry {
    let curve = |radius: f64, z: f64| {
        let far = (radius * radius - 16.0).sqrt() - 6.0;
        [
            circle(3.0, -6.0, radius),
            Geometry::Point(v(-1.0, far, z)),
            Geometry::Point(v(7.0, far, z)),
            Geometry::Vector(Vec3::y()),
        ]
    };
    Geometry::RuledSurface(Remembering::new(RuledSurface {
        parts: [curve(6.0, 0.0), curve(5.0, 4.0)].concat(),
    }))
}

fn program(axis: Vec3) -> Program {
    let mut p = Program::new();
    p.tolerance(0.01, 0.01).cutter(&[0.5]).from(1.0, 4.0, 0.5);
    p.run(&MotionCommand::ToolAxis(ToolAxis::Fixed(axis)));
    p.run(&MotionCommand::ToolAxis(ToolAxis::Parallel { part: false }));
    p
}

#[test]
fn the_axis_follows_the_rulings_of_the_drive_surface() {
    let (wall, floor) = (leaning_wall(), plane(0.0, 0.0, 1.0, 0.3));
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let surface = Surface::from_geometry(&wall).expect("a surface");
    let Surface::Ruled(sheet) = &surface else { panic!("not ruled") };
    let mut p = program(Vec3::z());
    p.go(&[(Relation::To, &wall), (Relation::On, &floor), (Relation::On, &x(1.5))]);
    p.part_side(apt_geometry::motion::PartSide::On).side(DriveSide::Left);
    p.drive(Turn::Left, &wall, Relation::On, &x(4.5));
    let sequence = p.last();
    assert!(sequence.points.len() > 2, "the path bends: {} vectors", sequence.points.len());
    let drive = sequence.drive.as_ref().expect("a drive surface");
    let gauge = Gauge {
        surface: surface.clone(),
        on: false,
        side: drive.side,
        thickness: 0.0,
        disk: None,
        memory: Default::default(),
    };
    for point in &sequence.points {
        let ruling = sheet.ruling(&point.tip).expect("a ruling");
        assert!(
            point.axis.z > 0.9 && point.axis.cross(&ruling).norm() < 1e-9,
            "{point:?} against {ruling:?}"
        );
        let tool = Tool::new(sequence.cutter, point.axis);
        let clearance = gauge.contact(&tool, &point.tip).clearance;
        assert!((-0.0101..=0.0101).contains(&clearance), "{clearance} at {point:?}");
    }
}

#[test]
fn rulings_are_needed_and_one_of_their_senses() {
    let floor = plane(0.0, 0.0, 1.0, 0.3);
    let cause = |p: &mut Program, drive: &Geometry| {
        let command = start(&[(Relation::To, drive), (Relation::On, &floor)]);
        match p.attempt(&command).expect_err("no axis") {
            MotionFailure::AxisUndetermined { cause, .. } => cause,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(cause(&mut program(Vec3::z()), &circle(3.0, -6.0, 6.0)), AxisFailure::NotRuled);
    assert_eq!(AxisFailure::NotRuled.apt3(), 852);
    // Across the rulings either sense would do.
    assert_eq!(cause(&mut program(Vec3::x()), &plane_wall()), AxisFailure::SignUnresolved);
}

/// A plane wall with upright rulings.
fn plane_wall() -> Geometry {
    let curve = |z: f64| {
        let floor = plane(0.0, 0.0, 1.0, z);
        [
            floor,
            Geometry::Point(v(-9.0, 0.0, z)),
            Geometry::Point(v(9.0, 0.0, z)),
            Geometry::Vector(Vec3::z()),
        ]
    };
    Geometry::RuledSurface(Remembering::new(RuledSurface { parts: [curve(0.0), curve(4.0)].concat() }))
}

/// A ball end round a dome that stands on the floor, with an axis that follows it.
fn round_the_dome(mode: ToolAxis) -> Program {
    let (dome, floor) = (sphere(0.0, 0.0, -1.0, 4.0), plane(0.0, 0.0, 1.0, 0.5));
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(-0.4, -5.0, 0.5).run(&MotionCommand::ToolAxis(mode));
    p.part_side(apt_geometry::motion::PartSide::On);
    p.go(&[(Relation::To, &dome), (Relation::On, &floor), (Relation::On, &plane(1.0, 0.0, 0.0, -0.4))]);
    p.side(DriveSide::Left).indirv(-1.0, 0.0, 0.0);
    p.drive(Turn::Forward, &dome, Relation::On, &plane(0.0, 1.0, 0.0, -0.4));
    p
}

fn verified(p: &Program) {
    for sequence in &p.sequences {
        let evidence = crate::verify::verify(sequence, &|| false).expect("a judgement");
        assert!(evidence.verified, "{:?}", evidence.violations);
    }
}

#[test]
fn an_axis_along_the_drive_surface_is_perpendicular_to_its_normal() {
    let hill = Surface::from_geometry(&sphere(0.0, 0.0, -1.0, 4.0)).expect("a surface");
    let across = Vec3::new(1.0, -1.0, 0.0).normalize();
    for height in [0.0, 0.7] {
        let modes = [AxisTangency::Across, AxisTangency::PerpendicularTo(across)];
        for mode in modes {
            let p = round_the_dome(ToolAxis::Tangent { height, mode });
            assert!(p.last().points.len() > 3, "{}", p.last().points.len());
            for point in &p.last().points {
                let normal = hill.foot(&(point.tip + point.axis * height)).normal;
                assert!(point.axis.dot(&normal).abs() < 1e-9 && point.axis.z > 0.0, "{point:?}");
                let plane = match mode {
                    AxisTangency::PerpendicularTo(vector) => vector,
                    // Across the motion: in the plane of both normals.
                    _ => normal.cross(&Vec3::z()).normalize(),
                };
                assert!(point.axis.dot(&plane).abs() < 1e-9, "{point:?}");
            }
            verified(&p);
        }
    }
}

#[test]
fn a_fan_turns_evenly_with_the_way() {
    // Along a wall that leans by 20° from the upright; the tool begins upright.
    let (sine, cosine) = 20f64.to_radians().sin_cos();
    let (wall, floor) = (plane(0.0, cosine, -sine, 0.0), plane(0.0, 0.0, 1.0, 0.0));
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5]).from(0.0, 2.0, 1.0);
    p.go(&[(Relation::To, &wall), (Relation::On, &floor), (Relation::On, &plane(1.0, 0.0, 0.0, 0.0))]);
    p.part_side(apt_geometry::motion::PartSide::On).side(DriveSide::Left).indirv(1.0, 0.0, 0.0);
    p.run(&MotionCommand::ToolAxis(ToolAxis::Tangent { height: 0.0, mode: AxisTangency::Fan }));
    p.drive(Turn::Forward, &wall, Relation::On, &plane(1.0, 0.0, 0.0, 4.0));
    let sequence = p.last();
    let (begin, end) = (sequence.start, sequence.points[sequence.points.len() - 1]);
    assert_eq!(begin.axis, Vec3::z());
    assert!((end.axis - v(0.0, sine, cosine)).norm() < 1e-9, "{end:?}");
    let way = end.tip - begin.tip;
    for point in &sequence.points {
        let share = (point.tip - begin.tip).dot(&way) / way.norm_squared();
        let angle = begin.axis.cross(&point.axis).norm().atan2(begin.axis.dot(&point.axis));
        assert!((angle - share * 20f64.to_radians()).abs() < 1e-9, "{share} {angle}");
    }
    verified(&p);
    // Round a dome, too, where the end depends on the axis there.
    let p = round_the_dome(ToolAxis::Tangent { height: 0.0, mode: AxisTangency::Fan });
    verified(&p);
}

/// Where a fan ends its axis stands as that of TANDS does: it ends in the same position, which one pass with that tells.
#[test]
fn a_fan_ends_where_an_axis_along_the_surface_does() {
    let of = |mode: AxisTangency| {
        let before = EVALUATIONS.get();
        let p = round_the_dome(ToolAxis::Tangent { height: 0.0, mode });
        let last = *p.last().points.last().expect("a position");
        (last, EVALUATIONS.get() - before)
    };
    let (along, fan) = (of(AxisTangency::Across), of(AxisTangency::Fan));
    let apart = (along.0.tip - fan.0.tip).norm() + (along.0.axis - fan.0.axis).norm();
    assert!(apart <= 1e-9, "{along:?} and {fan:?}");
    // Passes until the end stays where it is took six times as many.
    assert!(fan.1 <= 4 * along.1, "{} clearances, {} along the surface", fan.1, along.1);
}

/// A flank along the rulings of a cone that stands on its vertex or on its base, from outside and inside.
fn along_the_rulings(upward: f64, inside: bool, height: f64, mode: AxisTangency) -> Program {
    // Of radius 5 at z=0.
    let (half, floor) = (20f64.to_radians(), plane(0.0, 0.0, 1.0, 0.0));
    let wall = cone(v(0.0, 0.0, -upward * 5.0 / half.tan()), v(0.0, 0.0, upward), 20.0);
    let begin = if inside { 4.0 } else { 6.0 };
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5]).from(0.3, -begin, 0.0);
    p.run(&MotionCommand::ToolAxis(ToolAxis::Tangent { height, mode }));
    p.part_side(apt_geometry::motion::PartSide::On);
    p.go(&[(Relation::To, &wall), (Relation::On, &floor), (Relation::On, &plane(1.0, 0.0, 0.0, 0.3))]);
    let side = if inside { DriveSide::Left } else { DriveSide::Right };
    p.side(side).indirv(1.0, 0.0, 0.0);
    p.drive(Turn::Forward, &wall, Relation::On, &plane(1.0, 0.0, 0.0, 2.0));
    p
}

/// Most clearances that one cut vector along the rulings may cost; contacts that jump from end to end of the flank, which
/// the vectors were once measured with, cost thousands.
const MOST_CLEARANCES: u64 = 150;

#[test]
fn a_flank_along_the_rulings_of_a_cone_costs_a_bounded_number_of_clearances() {
    let modes = [AxisTangency::Across, AxisTangency::PerpendicularTo(v(1.0, 0.0, 0.0))];
    for (upward, inside, height) in
        [(1.0, false, 0.0), (1.0, true, 0.5), (-1.0, false, 0.5), (-1.0, false, 0.0), (-1.0, true, 0.5)]
    {
        for mode in modes {
            let before = EVALUATIONS.get();
            let p = along_the_rulings(upward, inside, height, mode);
            let (spent, vectors) = (EVALUATIONS.get() - before, p.last().points.len() as u64);
            assert!((4..12).contains(&vectors), "{upward} {inside} {height} {mode:?}: {vectors} vectors");
            assert!(spent <= MOST_CLEARANCES * vectors, "{upward} {inside} {height} {mode:?}: {spent}");
            if matches!(mode, AxisTangency::Across) {
                // Along the ruling: it leans by the half angle, and points to the vertex or away from it.
                for point in &p.last().points {
                    assert!((point.axis.z - 20f64.to_radians().cos()).abs() < 1e-9, "{point:?}");
                }
            }
            verified(&p);
        }
    }
}
