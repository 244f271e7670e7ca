//! Paths that come to the end of a surface that does not go on: what is told, and how soon.

use DriveSide::On as TlOn;
use Relation::{On, To};
use Turn::Forward;

use super::{
    sculptured::{hill, made},
    sheets::round_wall,
    *,
};
use crate::{clearance::EVALUATIONS, error::RoleName, verify::tests::lofts};

/// Clearances until it is known that the path comes to the end. Most of them are spent where the extension begins.
const SOON: u64 = 10_000;

const BALL: &[f64] = &[0.5, 0.25];

/// Surfaces with ends, with the place where a pass along x begins.
fn passes() -> [(&'static str, Geometry, Vec3); 3] {
    [
        ("ruled", lofts::roof(), v(4.0, 0.4, 6.0)),
        ("polyconic", lofts::vault(), v(-1.0, 0.4, 6.0)),
        ("patch", made(vec![hill()]), v(1.0, 2.0, 6.0)),
    ]
}

/// A tool on a part surface, ready to go along x.
fn on_part(part: &Geometry, at: Vec3, cutter: &[f64]) -> (Program, Geometry) {
    let drive = y(at.y);
    let mut p = Program::new();
    p.tolerance(0.002, 0.002).cutter(cutter).from(at.x, at.y, at.z);
    p.run(&MotionCommand::MaximumPoints(1000));
    p.go(&[(On, &drive), (To, part), (On, &x(at.x))]).indirv(1.0, 0.0, 0.0).side(TlOn);
    (p, drive)
}

#[test]
fn a_part_surface_that_ends_before_the_check_surface_is_told_soon() {
    for (name, part, at) in passes() {
        let (mut p, drive) = on_part(&part, at, BALL);
        let before = EVALUATIONS.get();
        let failure = p.attempt(&motion(Forward, &drive, &[(On, 1, &x(500.0))])).expect_err("no way there");
        let cost = EVALUATIONS.get() - before;
        let MotionFailure::SurfaceEnds { role: RoleName::Part, tip, place, remaining } = failure else {
            panic!("{name}: {failure:?}");
        };
        let remaining = remaining.expect("a check surface that is crossed");
        assert!((remaining - (500.0 - tip.x)).abs() < 1e-6, "{name}: {remaining} at {tip}");
        assert!((place - tip).norm() < 2.0, "{name}: {place} {tip}");
        assert!(cost <= SOON, "{name}: {cost} clearances");
    }
}

#[test]
fn a_check_surface_a_little_before_the_end_is_met() {
    // The extension of the ruled surface ends at 18, and the ball touches it there at 18.23.
    let (mut p, drive) = on_part(&lofts::roof(), v(4.0, 0.4, 6.0), BALL);
    p.drive(Forward, &drive, On, &x(17.9)).verified();
    assert!((p.tip().x - 17.9).abs() < 1e-9);
}

#[test]
fn a_drive_surface_that_ends_is_told() {
    // Beside a wall that is straight along x and ends with its extension.
    let wall = round_wall();
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5]).from(3.0, 3.0, 1.0);
    p.go(&[(To, &wall), (To, &level(1.0)), (On, &x(3.0))]).side(DriveSide::Left).indirv(1.0, 0.0, 0.0);
    let failure = p.attempt(&motion(Forward, &wall, &[(On, 1, &x(900.0))])).expect_err("no way there");
    assert!(matches!(failure, MotionFailure::SurfaceEnds { role: RoleName::Drive, .. }), "{failure:?}");
}
