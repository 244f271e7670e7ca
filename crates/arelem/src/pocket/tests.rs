//! Pockets by hand, faults, and properties of pockets of any convex shape.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Plane, Sphere},
    cutter::Cutter,
    motion::{MotionCommand, NamedSurface, PerRole, Pocket},
    patience::{Patience, Waiting},
};
use nalgebra::{Rotation3, Unit};
use proptest::prelude::*;

use super::{CornerFault, PocketFailure, PocketPath, clear};
use crate::{
    error::MotionFailure,
    section2::{Execution, Output, State, execute},
    verify::{Rule, verify_pocket},
};

const LEVEL: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 5.0, 0.0], [0.0, 5.0, 0.0]];

fn state(cutter: &[f64]) -> State {
    let mut state = State::new(1.0);
    state.cutter = Some(Cutter::from_numbers(cutter, 1.0).unwrap());
    state
}

fn statement(numbers: [f64; 6], keep_offsets: bool, point_kind: u8, points: &[[f64; 3]]) -> Pocket {
    Pocket { numbers, keep_offsets, point_kind, points: points.iter().copied().map(Vec3::from).collect() }
}

fn part(geometry: Geometry) -> NamedSurface {
    NamedSurface { name: String::new(), geometry }
}

fn tips(path: &PocketPath) -> Vec<Vec3> {
    path.positions().map(|position| position.tip).collect()
}

fn near(found: &[Vec3], wanted: &[[f64; 3]]) {
    let wanted: Vec<Vec3> = wanted.iter().copied().map(Vec3::from).collect();
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (found, wanted) in found.iter().zip(&wanted) {
        assert!((found - wanted).norm() < 1e-12, "{found} is not {wanted}");
    }
}

fn fault(state: &State, pocket: &Pocket) -> PocketFailure {
    match clear(state, pocket, Patience::default()) {
        Err(MotionFailure::Pocket(failure)) => failure,
        other => panic!("{other:?}"),
    }
}

fn assert_verified(path: &PocketPath) {
    let evidence = verify_pocket(path, &|| false).unwrap();
    assert!(evidence.verified, "{:?} of {path:?}", evidence.violations);
}

#[test]
fn a_rectangle_is_cut_from_its_middle_to_its_walls() {
    let pocket = statement([0.49, 1.0, 0.8, 5.0, 10.0, 8.0], true, 1, &LEVEL);
    let path = clear(&state(&[1.0]), &pocket, Patience::default()).unwrap();
    assert_eq!(
        path.passes.each_ref().map(|pass| (pass.feed, pass.points.len())),
        [(5.0, 1), (10.0, 19), (8.0, 5)]
    );
    let all = tips(&path);
    near(
        &all[..6],
        &[
            [2.15, 2.15, 0.0],
            [5.85, 2.15, 0.0],
            [5.85, 2.85, 0.0],
            [2.15, 2.85, 0.0],
            [2.15, 2.15, 0.0],
            [1.9, 1.9, 0.0],
        ],
    );
    let finish: Vec<Vec3> = path.passes[2].points.iter().map(|position| position.tip).collect();
    near(&finish, &[[0.5, 0.5, 0.0], [7.5, 0.5, 0.0], [7.5, 4.5, 0.0], [0.5, 4.5, 0.0], [0.5, 0.5, 0.0]]);
    assert_verified(&path);
}

#[test]
fn one_pass_belongs_to_the_plunge_and_the_finish() {
    let points = [[0.0, 0.0, 0.0], [1.8, 0.0, 0.0], [1.8, 1.6, 0.0], [0.0, 1.6, 0.0]];
    let pocket = statement([0.49, 1.0, 1.0, 5.0, 10.0, 8.0], true, 1, &points);
    let path = clear(&state(&[1.0]), &pocket, Patience::default()).unwrap();
    assert_eq!(path.passes.each_ref().map(|pass| pass.points.len()), [1, 0, 4]);
    assert_verified(&path);
}

#[test]
fn a_narrow_middle_is_cut_by_one_line() {
    // Half an offset inside the finishing pass the rest is .485 wide: one side reaches all of it.
    let points = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 1.985, 0.0], [0.0, 1.985, 0.0]];
    let pocket = statement([0.49, 1.0, 1.0, 5.0, 10.0, 8.0], true, 1, &points);
    let path = clear(&state(&[1.0]), &pocket, Patience::default()).unwrap();
    // Its end nearer to the first corner leads to the finishing pass.
    near(&tips(&path)[..3], &[[7.25, 0.75, 0.0], [0.75, 0.75, 0.0], [0.5, 0.5, 0.0]]);
    assert_eq!(path.passes.each_ref().map(|pass| pass.points.len()), [1, 1, 5]);
}

#[test]
fn tool_centres_are_the_outermost_pass() {
    let pocket = statement([0.49, 1.0, 0.8, 5.0, 10.0, 8.0], true, 0, &LEVEL);
    let path = clear(&state(&[1.0]), &pocket, Patience::default()).unwrap();
    let finish: Vec<Vec3> = path.passes[2].points.iter().map(|position| position.tip).collect();
    near(&finish, &[LEVEL[0], LEVEL[1], LEVEL[2], LEVEL[3], LEVEL[0]]);
    assert_verified(&path);
}

#[test]
fn walls_of_a_canted_pocket_stand_along_the_tool_axis() {
    let mut state = state(&[1.0]);
    state.part =
        part(Geometry::Plane(Plane { normal: Vec3::new(0.5, 0.0, 1.0).normalize(), distance: -1.0 }));
    let pocket = statement([0.49, 1.0, 0.8, 5.0, 10.0, 8.0], true, 3, &LEVEL);
    let path = clear(&state, &pocket, Patience::default()).unwrap();
    let level: Vec<Vec3> =
        path.passes[2].points.iter().map(|position| Vec3::new(position.tip.x, position.tip.y, 0.0)).collect();
    near(&level, &[[0.5, 0.5, 0.0], [7.5, 0.5, 0.0], [7.5, 4.5, 0.0], [0.5, 4.5, 0.0], [0.5, 0.5, 0.0]]);
    assert_verified(&path);
}

#[test]
fn points_that_make_no_convex_figure_are_refused() {
    let cases: [(CornerFault, usize, u16, &[[f64; 3]]); 10] = [
        (
            CornerFault::Duplicate { other: 1 },
            2,
            3501,
            &[[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 5.0, 0.0]],
        ),
        // The figure closes by itself.
        (
            CornerFault::Duplicate { other: 0 },
            3,
            3501,
            &[[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 0.0]],
        ),
        // Points need not follow one another to be the same: there and back again, and a figure of eight.
        (
            CornerFault::Duplicate { other: 0 },
            2,
            3501,
            &[[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 5.0, 0.0]],
        ),
        (
            CornerFault::Duplicate { other: 1 },
            4,
            3501,
            &[
                [0.0, 0.0, 0.0],
                [4.0, 2.0, 0.0],
                [8.0, 0.0, 0.0],
                [8.0, 4.0, 0.0],
                [4.0, 2.0, 0.0],
                [0.0, 4.0, 0.0],
            ],
        ),
        (
            CornerFault::Collinear,
            1,
            3502,
            &[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 5.0, 0.0]],
        ),
        (CornerFault::Collinear, 2, 3502, &[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [2.0, 0.0, 0.0]]),
        (
            CornerFault::NotInPlane,
            1,
            3503,
            &[[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 5.0, 1.0], [0.0, 5.0, 0.0]],
        ),
        (
            CornerFault::Concave,
            2,
            3504,
            &[[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 5.0, 0.0]],
        ),
        // The corner that is told is the one that turns against the figure, though the statement begins with it.
        (
            CornerFault::Concave,
            0,
            3504,
            &[[2.0, 1.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 0.0], [8.0, 0.0, 0.0]],
        ),
        (
            CornerFault::Concave,
            3,
            3504,
            &[[0.0, 4.0, 0.0], [2.4, -3.2, 0.0], [-3.8, 1.2, 0.0], [3.8, 1.2, 0.0], [-2.4, -3.2, 0.0]],
        ),
    ];
    for (wanted, at, number, points) in cases {
        let failure = fault(&state(&[1.0]), &statement([0.49, 1.0, 0.8, 5.0, 10.0, 8.0], true, 1, points));
        let PocketFailure::Corner { corner, fault, .. } = failure else { panic!("{failure:?}") };
        assert_eq!((fault, corner, failure.apt3()), (wanted, at, Some(number)), "{points:?}");
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    let good = [0.49, 1.0, 0.8, 5.0, 10.0, 8.0];
    for (index, number) in [(0, 3511), (1, 3512), (2, 3513), (3, 3514), (4, 3514), (5, 3514)] {
        let mut numbers = good;
        numbers[index] = -0.1;
        assert_eq!(fault(&state(&[1.0]), &statement(numbers, true, 1, &LEVEL)).apt3(), Some(number));
    }
    assert_eq!(fault(&state(&[1.0]), &statement(good, true, 4, &LEVEL)).apt3(), Some(3516));
    assert_eq!(fault(&state(&[0.0]), &statement(good, true, 1, &LEVEL)).apt3(), Some(3510));
    assert_eq!(fault(&State::new(1.0), &statement(good, true, 1, &LEVEL)).apt3(), Some(3510));
    let mut zero = good;
    zero[1] = 0.0;
    assert_eq!(fault(&state(&[1.0]), &statement(zero, true, 1, &LEVEL)), PocketFailure::NoOffset);
    zero[1] = 1e-9;
    let many = fault(&state(&[1.0]), &statement(zero, true, 1, &LEVEL));
    assert!(matches!(many, PocketFailure::TooManyPasses { .. }), "{many:?}");
    let not_finite = statement([f64::NAN, 1.0, 0.8, 5.0, 10.0, 8.0], true, 1, &LEVEL);
    assert_eq!(clear(&state(&[1.0]), &not_finite, Patience::default()), Err(MotionFailure::NotFinite));
    let waiting = Waiting::until(&|| true);
    let cancelled = clear(&state(&[1.0]), &statement(good, true, 1, &LEVEL), waiting.patience());
    assert_eq!(cancelled, Err(MotionFailure::Cancelled));
}

#[test]
fn a_cutter_that_does_not_fit_is_told_what_would() {
    let failure = fault(&state(&[6.0]), &statement([0.49, 1.0, 0.8, 5.0, 10.0, 8.0], true, 1, &LEVEL));
    let PocketFailure::DoesNotFit { radius, greatest } = failure else { panic!("{failure:?}") };
    assert!(radius == 3.0 && (greatest - 2.5).abs() < 1e-9, "{radius} {greatest}");
    assert_eq!(PocketFailure::DoesNotFit { radius, greatest }.apt3(), Some(3518));
}

#[test]
fn the_tool_axis_must_stand_on_the_pocket_and_the_part_surface_be_a_plane() {
    let numbers = [0.49, 1.0, 0.8, 5.0, 10.0, 8.0];
    let mut tilted = state(&[1.0]);
    tilted.axis = Vec3::new(1.0, 0.0, 0.1).normalize();
    assert_eq!(fault(&tilted, &statement(numbers, true, 1, &LEVEL)).apt3(), Some(3507));
    tilted.axis = Vec3::x();
    assert_eq!(fault(&tilted, &statement(numbers, true, 2, &LEVEL)).apt3(), Some(3507));
    let mut curved = state(&[1.0]);
    curved.part = part(Geometry::Sphere(Sphere { center: Vec3::zeros(), radius: 20.0 }));
    assert_eq!(fault(&curved, &statement(numbers, true, 2, &LEVEL)).apt3(), Some(3519));
    assert!(
        clear(&curved, &statement(numbers, true, 1, &LEVEL), Patience::default()).is_ok(),
        "no projection, no plane"
    );
}

#[test]
fn motion_goes_on_from_the_last_corner() {
    let mut state = state(&[1.0]);
    state.tip = Some(Vec3::new(4.0, 2.0, 3.0));
    let pocket = statement([0.49, 1.0, 0.8, 5.0, 10.0, 8.0], true, 1, &LEVEL);
    let execution: Execution = execute(&state, &MotionCommand::Pocket(pocket), &|| false);
    assert!(matches!(execution.output, Some(Output::Pocket(_))), "{execution:?}");
    assert!((execution.state.tip.unwrap() - Vec3::new(0.5, 0.5, 0.0)).norm() < 1e-12);
    assert_eq!(execution.state.forward, Some(-Vec3::y()));
    assert_eq!(execution.state.part, state.part);
    assert_eq!(execution.state.inside, PerRole::all(0.0));
}

#[test]
fn the_verifier_sees_gouges_gaps_and_unfinished_walls() {
    let pocket = statement([0.49, 1.0, 0.8, 5.0, 10.0, 8.0], true, 1, &LEVEL);
    let good = clear(&state(&[1.0]), &pocket, Patience::default()).unwrap();
    let rules = |path: &PocketPath| -> Vec<Rule> {
        let evidence = verify_pocket(path, &|| false).unwrap();
        assert_eq!(evidence.verified, evidence.violations.is_empty());
        evidence.violations.iter().map(|violation| violation.rule).collect()
    };
    assert_eq!(rules(&good), []);
    let mut gouge = good.clone();
    gouge.passes[1].points[17].tip.x = 0.4999;
    assert!(rules(&gouge).contains(&Rule::DriveBand));
    let mut high = good.clone();
    high.passes[1].points[3].tip.z = 1e-4;
    assert_eq!(rules(&high), [Rule::PartBand]);
    let mut unfinished = good.clone();
    unfinished.passes[2].points[2].tip.y -= 1e-4;
    assert_eq!(rules(&unfinished), [Rule::DriveBand]);
    let mut gap = good.clone();
    gap.passes[1].points.drain(4..14);
    assert_eq!(rules(&gap), [Rule::Cleared]);
    let mut small = good.clone();
    small.cutter = Cutter::from_numbers(&[1.0, 0.5], 1.0).unwrap();
    small.effective_radius = 0.2;
    assert_eq!(rules(&small), [Rule::Cleared]);
}

/// A convex polygon from random angles on an ellipse, in either sense of rotation.
fn shapes() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let gaps = prop::collection::vec(0.08..1.0, 3..=20);
    (gaps, 0.3..1.0, 0.0..std::f64::consts::TAU, any::<bool>()).prop_map(|(gaps, squeeze, start, reverse)| {
        let whole: f64 = gaps.iter().sum();
        let mut angle: f64 = start;
        let corner = |gap: &f64| {
            angle += gap / whole * std::f64::consts::TAU;
            [5.0 * angle.cos(), 5.0 * squeeze * angle.sin()]
        };
        let mut corners: Vec<[f64; 2]> = gaps.iter().map(corner).collect();
        if reverse {
            corners.reverse();
        }
        corners
    })
}

/// Cutter radius and the six numbers of the statement.
fn numbers() -> impl Strategy<Value = (f64, [f64; 6])> {
    (0.1..0.7_f64, 0.4..1.0, 0.3..2.0, 0.0..2.0)
        .prop_map(|(radius, effective, c, f)| (radius, [effective * radius, c, f, 5.0, 10.0, 8.0]))
}

/// A position and attitude of the whole part.
fn attitudes() -> impl Strategy<Value = (Rotation3<f64>, Vec3)> {
    let direction = prop::array::uniform3(-1.0..1.0_f64).prop_filter("zero", |v| Vec3::from(*v).norm() > 0.1);
    (direction, -3.0..3.0_f64, prop::array::uniform3(-20.0..20.0_f64)).prop_map(|(axis, angle, shift)| {
        (Rotation3::from_axis_angle(&Unit::new_normalize(Vec3::from(axis)), angle), Vec3::from(shift))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    #[test]
    fn reduced_offsets_clear_every_pocket(corners in shapes(), (radius, numbers) in numbers(), tilt in 0.0..0.8_f64) {
        let mut state = state(&[2.0 * radius]);
        // The tool leans in the plane of x and z: the pocket is canted.
        state.axis = Vec3::new(tilt.sin(), 0.0, tilt.cos());
        let points: Vec<[f64; 3]> = corners.iter().map(|[x, y]| [*x, *y, 0.5]).collect();
        let pocket = statement(numbers, false, 1, &points);
        match clear(&state, &pocket, Patience::default()) {
            Ok(path) => {
                let evidence = verify_pocket(&path, &|| false).unwrap();
                prop_assert!(evidence.verified, "{:?}", evidence.violations);
            }
            Err(MotionFailure::Pocket(PocketFailure::DoesNotFit { radius, greatest })) => {
                prop_assert!(greatest < radius);
            }
            Err(other) => prop_assert!(false, "{other:?}"),
        }
    }

    #[test]
    fn kept_offsets_neither_gouge_nor_miss_the_walls(corners in shapes(), (radius, numbers) in numbers()) {
        let points: Vec<[f64; 3]> = corners.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        let pocket = statement(numbers, true, 1, &points);
        if let Ok(path) = clear(&state(&[2.0 * radius]), &pocket, Patience::default()) {
            let evidence = verify_pocket(&path, &|| false).unwrap();
            let broken = evidence.violations.iter().find(|violation| violation.rule != Rule::Cleared);
            prop_assert!(broken.is_none(), "{broken:?}");
        }
    }

    #[test]
    fn a_pocket_moves_with_the_part(
        corners in shapes(),
        (radius, numbers) in numbers(),
        (turn, shift) in attitudes(),
        kind in 0..4_u8,
        reduce in any::<bool>(),
    ) {
        let points: Vec<[f64; 3]> = corners.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        let mut here = state(&[2.0 * radius]);
        here.part = part(Geometry::Plane(Plane { normal: Vec3::new(0.2, 0.1, 1.0).normalize(), distance: 0.3 }));
        let pocket = statement(numbers, !reduce, kind, &points);
        let mut there = here.clone();
        there.axis = turn * here.axis;
        let Geometry::Plane(plane) = &here.part.geometry else { unreachable!() };
        let normal = turn * plane.normal;
        there.part = part(Geometry::Plane(Plane { normal, distance: plane.distance + normal.dot(&shift) }));
        let mut moved = pocket.clone();
        moved.points = pocket.points.iter().map(|point| turn * point + shift).collect();
        match (clear(&here, &pocket, Patience::default()), clear(&there, &moved, Patience::default())) {
            (Ok(here), Ok(there)) => {
                prop_assert_eq!(here.positions().count(), there.positions().count());
                for (a, b) in here.positions().zip(there.positions()) {
                    prop_assert!((turn * a.tip + shift - b.tip).norm() < 1e-8, "{} {}", a.tip, b.tip);
                }
            }
            (Err(a), Err(b)) => prop_assert_eq!(std::mem::discriminant(&a), std::mem::discriminant(&b)),
            (a, b) => prop_assert!(false, "{:?} {:?}", a, b),
        }
    }
}

/// Distance of a place from the path, all seen from above.
fn distance_from_path(path: &[Vec3], place: &Vec3) -> f64 {
    let distance = |pair: &[Vec3]| {
        let run = pair[1] - pair[0];
        let square = run.norm_squared();
        let share = if square > 0.0 { ((place - pair[0]).dot(&run) / square).clamp(0.0, 1.0) } else { 0.0 };
        (pair[0] + run * share - place).norm()
    };
    path.windows(2).map(distance).fold((path[0] - place).norm(), f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// What the verifier says of the bottom, against a look at many places of it: with offsets that are reduced nothing is
    /// left, whatever the shape; with those that are kept what is left is told.
    #[test]
    fn what_is_left_on_the_bottom_is_told_and_nothing_else(
        corners in shapes(), (radius, numbers) in numbers(), keep in any::<bool>(), ball in any::<bool>(),
    ) {
        let points: Vec<[f64; 3]> = corners.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        // A flat end clears all of its width, a ball what the programmer takes for enough.
        let cutter: &[f64] = if ball { &[2.0 * radius, radius] } else { &[2.0 * radius] };
        let Ok(path) = clear(&state(cutter), &statement(numbers, keep, 1, &points), Patience::default()) else {
            return Ok(());
        };
        let evidence = verify_pocket(&path, &|| false).unwrap();
        let told = evidence.violations.iter().any(|violation| violation.rule == Rule::Cleared);
        prop_assert!(keep || !told, "{:?}", evidence.violations);
        // The area of the tool centre has the corners of the last pass: its places are their mixtures.
        let (tips, wall) = (tips(&path), path.passes[2].points.iter().map(|at| at.tip).collect::<Vec<_>>());
        let middle = wall.iter().sum::<Vec3>() / wall.len() as f64;
        let width = if ball { path.effective_radius.min(radius) } else { radius };
        let reach = width + path.tolerance.max(1e-6 * radius) + 1e-9;
        let mut most = 0.0_f64;
        for pair in wall.windows(2) {
            for step in 0..8 {
                let side = pair[0] + (pair[1] - pair[0]) * (f64::from(step) / 8.0);
                for share in 1..=8 {
                    let place = middle + (side - middle) * (f64::from(share) / 8.0);
                    most = most.max(distance_from_path(&tips, &place));
                }
            }
        }
        prop_assert!(told || most <= reach, "{most} of {reach} from the path, and not told");
    }
}
