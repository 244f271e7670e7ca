//! Paths that come to the end of a surface that does not go on: what is told, and how soon.

use std::cell::Cell;

use DriveSide::On as TlOn;
use Relation::{On, Past, To};
use Turn::Forward;
use apt_geometry::canonical::Remembering;

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

/// A quarter of a tube along z of the frame, which is bent a little, as random motions drew it.
fn bent_tube() -> Geometry {
    let mut values = vec![1.0];
    values.extend([-0.7203098736145479, 0.31826242407683, 0.6163300377185381, 3.2769407274546487]);
    values.extend([0.6649305279844482, 0.5698429247456475, 0.48285239366875826, 1.5632895124873518]);
    values.extend([-0.19753753202180826, 0.7576200040508871, -0.6220858867826983, 2.4879464171815577]);
    values.extend([0.0, 0.0, 6.0]);
    let root = 1.882338027343659;
    for [constant, slope] in [
        [root, 0.22766491999288646],
        [root, -0.13346673001331158],
        [root, -0.1601852499202981],
        [-root, -0.05606693729027007],
        [-root, 0.11917647553657851],
        [root, -0.1686325335037907],
        [std::f64::consts::FRAC_1_SQRT_2, 0.005467286334565918],
    ] {
        values.extend([constant, slope]);
        values.extend([0.0; 6]);
    }
    values.extend([0.0; 7]);
    Geometry::PolyConic(Remembering::new(values))
}

/// Questions whether to give up until it is known that the path comes to the end: proofs beside the end take ten times as many.
const FEW: u32 = 6_000;

/// A ball that is held a little inside a surface has no place beside the end of that: the path turns away there. The end is looked for
/// where it is within sight of the tool, and known from what is just ahead.
#[test]
fn the_end_is_told_where_a_path_turns_away_beside_it() {
    let part = bent_tube();
    let drive = plane(-0.9678283625021933, -0.02744948661376305, -0.2501095488400315, 0.1826977983457426);
    let first = plane(0.2332050278409635, -0.4710612262623264, -0.8507154260397121, 2.0420985820674877);
    let check = quadric([
        -0.11687352401546064,
        -0.10625833217570983,
        0.320680502367368,
        1.430974971838379,
        0.038575827015484815,
        0.09748639918028584,
        -0.11573944626939493,
        -0.4959262240460561,
        0.26818543390337624,
        -0.22882470333471683,
    ]);
    let axis = Some(v(0.270099827140038, -0.12480775439553388, 0.9547089126124599));
    let position = v(0.8990415489750634, -1.5005022122426463, -1.2475519542193017);
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[0.27585590266142807, 0.13792795133071403]);
    p.run(&MotionCommand::From { position, axis, name: String::new() });
    p.go(&[(To, &drive), (To, &part), (To, &first)]).side(DriveSide::Left);
    p.indirv(0.2332050278409635, -0.47106122626232655, -0.8507154260397121);
    let asks = Cell::new(0);
    let onward = motion(Forward, &drive, &[(Past, 1, &check)]);
    let execution = execute(&p.state, &onward, &|| {
        asks.set(asks.get() + 1);
        false
    });
    let failure = execution.failure.expect("no way there");
    assert!(matches!(failure, MotionFailure::SurfaceEnds { role: RoleName::Part, .. }), "{failure:?}");
    assert!(asks.get() <= FEW, "{} questions", asks.get());
}
