//! CUTTER/OPTION: a disk in place of the cutter for the part or the drive surface (language reference 6.7).

use apt_geometry::{
    canonical::Geometry,
    cutter::Disk,
    motion::{AxisAngle, DriveSide, MotionCommand, PartSide, Relation, RoleDisk, ToolAxis, Turn},
};
use proptest::prelude::*;

use super::{Program, circle, cone, cylinder, plane, quadric, sphere, v};
use crate::{error::MotionFailure, verify};

fn disk(part: bool, radius: f64, height: f64) -> MotionCommand {
    MotionCommand::Disk(Some(RoleDisk { part, disk: Disk { radius, height } }))
}

/// The independent verifier proves every motion of a program.
fn proven(program: &Program) {
    for sequence in &program.sequences {
        let evidence = verify::verify(sequence, &|| false).expect("a verdict");
        assert!(evidence.verified, "{:?}\n{sequence:?}", evidence.violations);
    }
}

#[test]
fn the_disk_stands_off_the_drive_surface_and_the_cutter_off_the_check_surface() {
    let (wall, floor, end) =
        (plane(0.0, 1.0, 0.0, 0.0), plane(0.0, 0.0, 1.0, 0.0), plane(1.0, 0.0, 0.0, 5.0));
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.5]).run(&disk(false, 2.0, 1.0)).from(-3.0, 5.0, 3.0);
    p.go(&[(Relation::To, &wall), (Relation::To, &floor)]).ends(-3.0, 2.0, 0.0, 1e-9);
    p.indirv(1.0, 0.0, 0.0).side(DriveSide::Left);
    p.drive(Turn::Forward, &wall, Relation::To, &end).ends(4.75, 2.0, 0.0, 0.0011);
    // OFF, and the cutter counts again.
    p.run(&MotionCommand::Disk(None)).from(-3.0, 5.0, 3.0);
    p.go(&[(Relation::To, &wall), (Relation::To, &floor)]).ends(-3.0, 0.25, 0.0, 1e-9);
    proven(&p);
}

#[test]
fn the_disk_of_the_part_surface_rests_on_it_above_the_tool_end() {
    // The plane z = x/2 and a disk of radius 1 at a height of 2: n·(tip + 2k) − |n across the axis| = 0.
    let norm = 1.25f64.sqrt();
    let (slope, wall) = (plane(-0.5 / norm, 0.0, 1.0 / norm, 0.0), plane(0.0, 1.0, 0.0, 0.0));
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.5]).run(&disk(true, 1.0, 2.0)).from(0.0, 3.0, 3.0);
    p.go(&[(Relation::To, &wall), (Relation::To, &slope), (Relation::On, &plane(1.0, 0.0, 0.0, 0.0))]);
    p.ends(0.0, 0.25, -1.5, 2e-3);
    let tip = p.tip();
    let clearance = (-0.5 * tip.x + tip.z + 2.0) / norm - 0.5 / norm;
    assert!((-1e-9..=0.001).contains(&clearance), "{clearance}");
    p.indirv(1.0, 0.0, 0.0).side(DriveSide::Left);
    p.drive(Turn::Forward, &wall, Relation::On, &plane(1.0, 0.0, 0.0, 4.0)).ends(4.0, 0.25, 0.5, 2e-3);
    // A plane across the axis is touched by the flat of the disk.
    let mut q = Program::new();
    q.tolerance(0.0, 0.001).cutter(&[0.5]).run(&disk(true, 1.0, 2.0)).from(0.0, 3.0, 3.0);
    q.go(&[(Relation::To, &wall), (Relation::To, &plane(0.0, 0.0, 1.0, 0.0))]).ends(0.0, 0.25, -2.0, 1e-9);
    proven(&p);
    proven(&q);
}

#[test]
fn on_leaves_the_disk_out() {
    let (wall, floor) = (plane(0.0, 1.0, 0.0, 0.0), plane(0.0, 0.0, 1.0, 0.0));
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.5]).run(&disk(false, 2.0, 1.0)).from(0.0, 3.0, 3.0);
    p.go(&[(Relation::On, &wall), (Relation::To, &floor)]).ends(0.0, 0.0, 0.0, 1e-9);
    proven(&p);
}

#[test]
fn the_last_statement_holds() {
    let (wall, floor) = (plane(0.0, 1.0, 0.0, 0.0), plane(0.0, 0.0, 1.0, 0.0));
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.5]).run(&disk(false, 2.0, 1.0)).run(&disk(true, 1.0, 0.5));
    p.from(0.0, 3.0, 3.0);
    p.go(&[(Relation::To, &wall), (Relation::To, &floor)]).ends(0.0, 0.25, -0.5, 1e-9);
}

#[test]
fn a_negative_radius_is_refused() {
    let mut p = Program::new();
    let failure = p.attempt(&disk(true, -1.0, 0.5)).expect_err("no disk");
    assert!(matches!(failure, MotionFailure::Cutter(_)), "{failure:?}");
    assert_eq!(failure.apt3(), Some(401));
    assert_eq!(p.attempt(&disk(true, 1.0, f64::NAN)), Err(MotionFailure::NotFinite));
}

#[test]
fn the_tilted_disk_keeps_the_band_of_the_drive_surface() {
    // Along a wall that leans by 20 degrees, with the axis 30 degrees off the normal of the floor.
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let (wall, floor) = (plane(0.0, cos, sin, 0.0), sphere(0.0, 0.0, -20.0, 20.0));
    let mode = AxisAngle::PerpendicularTo(v(0.0, 1.0, 0.0));
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.1]).run(&disk(false, 1.0, 0.7)).from(-1.0, 4.0, 2.0);
    p.go(&[(Relation::To, &wall), (Relation::To, &floor)]);
    p.indirv(1.0, 0.0, 0.0).side(DriveSide::Left);
    p.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: true, angle: 0.1, mode }));
    p.run(&MotionCommand::MultipleAxes(Some(true)));
    p.go(&[(Relation::To, &wall), (Relation::To, &floor)]);
    p.indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &wall, Relation::On, &plane(1.0, 0.0, 0.0, 1.5));
    assert!(p.last().points.len() > 1, "the axis turns on the way");
    proven(&p);
}

fn surfaces() -> impl Strategy<Value = Geometry> {
    prop_oneof![
        (1.0..4.0).prop_map(|r| sphere(0.0, 0.0, 0.0, r)),
        (1.0..4.0, -0.5..0.5, -0.5..0.5).prop_map(|(r, x, y)| cylinder(v(0.0, 0.0, 0.0), v(x, y, 1.0), r)),
        (20.0..60.0).prop_map(|half| cone(v(0.0, 0.0, 5.0), v(0.0, 0.0, -1.0), half)),
        (0.05..0.3, 0.05..0.3, 0.02..0.2)
            .prop_map(|(a, b, c)| quadric([a, b, c, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])),
        (1.0..4.0).prop_map(|r| circle(0.0, 0.0, r)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Around a round drive surface with a disk: the verifier, which has its own model of it, proves the motion. The tool is
    /// short and stands low: the ray of the hidden move begins half way up the tool, and where it meets the surface near its
    /// top the tool comes to lie deep inside, from where the nearest way out may lead aside, along the way it came.
    #[test]
    fn motions_around_round_surfaces_are_proven(
        surface in surfaces(), radius in 0.0..1.5, height in -0.5..0.8, onto in any::<bool>(),
    ) {
        let floor = plane(0.0, 0.0, 1.0, 0.0);
        let mut p = Program::new();
        p.tolerance(0.001, 0.002).cutter(&[0.6, 0.1, 0.2, 0.1, 0.0, 0.0, 0.4]).run(&disk(false, radius, height));
        p.from(-9.0, 0.0, 0.1);
        if onto {
            p.part_side(PartSide::On);
        }
        let part = if onto { Relation::On } else { Relation::To };
        p.indirv(1.0, 0.0, 0.0).go(&[(Relation::To, &surface), (part, &floor)]);
        p.side(DriveSide::Right);
        p.drive(Turn::Left, &surface, Relation::On, &plane(1.0, 0.0, 0.0, 0.3));
        prop_assert!(p.last().points.len() > 2);
        for sequence in &p.sequences {
            let evidence = verify::verify(sequence, &|| false).expect("a verdict");
            prop_assert!(evidence.verified, "{:?}", evidence.violations);
        }
        p.verified();
    }
}
