//! PARLEL: the axis along the rulings of the surface that the flank cuts.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{Geometry, RuledSurface},
    motion::{DriveSide, MotionCommand, Relation, ToolAxis, Turn},
    surface::Surface,
};

use crate::{
    clearance::{Gauge, Tool},
    error::{AxisFailure, MotionFailure},
    tests::{Program, circle, plane, start, v},
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
    Geometry::RuledSurface(Arc::new(RuledSurface { parts: [curve(6.0, 0.0), curve(5.0, 4.0)].concat() }))
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
    Geometry::RuledSurface(Arc::new(RuledSurface { parts: [curve(0.0), curve(4.0)].concat() }))
}
