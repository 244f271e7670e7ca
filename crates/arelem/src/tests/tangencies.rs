//! TANTO and PSTAN where the path runs parallel to a check surface that is not tangent there.

use apt_geometry::motion::{DriveSide, Relation, Turn};

use super::{Program, ground, line, motion, sphere};
use crate::{error::MotionFailure, sequence::Stop, verify::Rule, verify::verify};

/// Along a wall to a ball in front of it whose middle is so far below the tool: the rim of the tool touches it.
fn to_a_ball(below: f64) -> (Program, Result<(), MotionFailure>) {
    let wall = line(-5.0, 0.0, 5.0, 0.0);
    let mut program = Program::new();
    program.cutter(&[1.0, 0.0]).tolerance(0.001, 0.001).from(-3.0, -2.0, 0.0).indirv(0.0, 1.0, 0.0);
    program.go(&[(Relation::To, &wall), (Relation::To, &ground())]);
    program.side(DriveSide::Right).indirv(1.0, 0.0, 0.0);
    let ball = sphere(2.0, (1.0 - below * below).sqrt(), -below, 1.0);
    let outcome =
        program.attempt(&motion(Turn::Forward, &wall, &[(Relation::TangentToDrive, 1, &ball)])).map(|_| ());
    (program, outcome)
}

/// Where the path is parallel to the ball, tool and ball touch, however far below its middle is; but wall and ball are tangent
/// only as far as the bands allow, by a thousandth each way.
#[test]
fn surfaces_that_lean_to_each_other_across_the_path_are_not_tangent() {
    for below in [0.0, 0.02, 0.05] {
        let (mut program, outcome) = to_a_ball(below);
        outcome.expect("a tangency");
        program.verified();
        assert!((program.tip().x - 2.0).abs() < 1e-6, "{below}: {:?}", program.tip());
        let evidence = verify(program.last(), &|| false).expect("evidence");
        assert!(evidence.verified, "{below}: {evidence:?}");
    }
    for below in [0.12_f64, 0.3] {
        let missed = 0.5 * below * below;
        match to_a_ball(below).1 {
            Err(MotionFailure::NotTangent { gap, .. }) => {
                assert!((gap - missed).abs() < 0.1 * missed, "{gap} for {missed}");
            }
            other => panic!("{below}: {other:?}"),
        }
    }
}

/// The verifier tells the same of a path that ends there.
#[test]
fn a_path_to_such_a_place_is_not_accepted() {
    for (below, is_tangent) in [(0.05, true), (0.12_f64, false), (0.3, false)] {
        let (program, _) = to_a_ball(0.0);
        let mut sequence = program.last().clone();
        let ball = sphere(2.0, (1.0 - below * below).sqrt(), -below, 1.0);
        let Some(Stop { role, .. }) = &mut sequence.stop else { panic!("a stop") };
        role.surface.geometry = ball;
        let violations = verify(&sequence, &|| false).expect("evidence").violations;
        let leans = violations.iter().any(|violation| violation.rule == Rule::Tangency);
        assert_eq!(leans, !is_tangent, "{below}: {violations:?}");
    }
}
