//! Motions on which the tool axis follows a surface: the axis is what the law says, and the independent verifier agrees.

use apt_geometry::motion::{AxisAngle, ToolAxis};

use super::*;
use crate::{error::AxisFailure, verify::verify};

fn program(cutter: &[f64], mode: ToolAxis) -> Program {
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(cutter).from(-2.0, 0.0, 7.0).run(&MotionCommand::ToolAxis(mode));
    p
}

fn over_the_ball(cutter: &[f64], mode: ToolAxis) -> Program {
    let (ball, middle) = (sphere(0.0, 0.0, 0.0, 5.0), plane(0.0, 1.0, 0.0, 0.0));
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let mut p = program(cutter, mode);
    p.go(&[(Relation::On, &middle), (Relation::To, &ball), (Relation::On, &x(-1.0))]);
    p.drive(Turn::Forward, &middle, Relation::On, &x(2.0));
    p
}

fn proven(p: &Program) {
    for sequence in &p.sequences {
        let evidence = verify(sequence, &|| false).expect("a judgement");
        assert!(evidence.verified, "{:?}", evidence.violations);
    }
}

#[test]
fn a_tool_normal_to_a_ball_keeps_its_band() {
    for cutter in [&[0.5][..], &[0.5, 0.25], &[0.75, 0.2]] {
        let p = over_the_ball(cutter, ToolAxis::Normal { part: true });
        for point in p.sequences.iter().flat_map(|sequence| &sequence.points) {
            assert!((point.axis - point.tip.normalize()).norm() < 1e-12, "{point:?}");
        }
        assert!(p.last().points.len() > 3);
        proven(&p);
    }
}

#[test]
fn angle_and_lead_hold_at_the_contact_of_a_ball_end() {
    let (angle, lead) = (10f64.to_radians(), 5f64.to_radians());
    let mode = ToolAxis::AtAngle { part: true, angle, mode: AxisAngle::Lead(lead) };
    let p = over_the_ball(&[0.5, 0.25], mode);
    for point in &p.last().points {
        let normal = (point.tip + point.axis * 0.25).normalize();
        assert!((normal.dot(&point.axis) - angle.cos()).abs() < 1e-10, "{point:?}");
        let ahead = Vec3::y().cross(&normal).normalize();
        assert!((ahead.dot(&point.axis) - lead.sin()).abs() < 1e-3, "{point:?}");
        assert!(point.axis.y > 0.0);
    }
    proven(&p);
}

#[test]
fn angles_that_exclude_each_other_are_named() {
    let mode = ToolAxis::AtAngle { part: true, angle: 0.0, mode: AxisAngle::Lead(0.1) };
    let mut p = program(&[0.5], mode);
    let (middle, ball) = (plane(0.0, 1.0, 0.0, 0.0), sphere(0.0, 0.0, 0.0, 5.0));
    let failure = p.attempt(&start(&[(Relation::On, &middle), (Relation::To, &ball)])).expect_err("no axis");
    let MotionFailure::AxisUndetermined { cause: AxisFailure::ImpossibleAngles { .. }, .. } = failure else {
        panic!("{failure:?}")
    };
    assert_eq!(failure.apt3(), Some(859));
}

#[test]
fn an_axis_that_would_turn_on_the_vertex_of_a_cone_is_named() {
    // In a plane through the axis of the cone, up one side; on the vertex itself the normal jumps to the other side.
    let (hill, middle) = (cone(v(0.0, 0.0, 3.0), v(0.0, 0.0, -1.0), 60.0), plane(0.0, 1.0, 0.0, 0.0));
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let mut p = program(&[0.5], ToolAxis::Normal { part: true });
    p.go(&[(Relation::On, &middle), (Relation::To, &hill), (Relation::On, &x(-1.0))]);
    p.indirv(1.0, 0.0, 0.0);
    let command = motion(Turn::Forward, &middle, &[(Relation::On, 1, &x(1.0))]);
    let failure = p.attempt(&command).expect_err("the axis jumps");
    let MotionFailure::AxisUndetermined { cause: AxisFailure::Vertex, tip } = failure else {
        panic!("{failure:?}")
    };
    assert!((tip - v(0.0, 0.0, 3.0)).norm() < 0.01, "{tip:?}");
    assert_eq!(failure.apt3(), Some(855));
    // Up to it there is no difficulty.
    let mut p = program(&[0.5], ToolAxis::Normal { part: true });
    p.go(&[(Relation::On, &middle), (Relation::To, &hill), (Relation::On, &x(-1.0))]);
    p.indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &middle, Relation::On, &x(-0.1));
    proven(&p);
}
