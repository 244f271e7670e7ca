//! Interference checking against closed forms and against an independent dense search (reference 5).

mod brute;
mod surfaces;
mod zigzag;

use std::cell::Cell;

use apt_geometry::{
    Vec3,
    cutter::Cutter,
    patience::{Patience, Waiting},
};
use apt_sculptured::{
    check::{Checker, Obstacle, Question, Report, check},
    tool::{Pose, Tool},
};
use brute::{Mill, deepest};
use proptest::prelude::*;
use surfaces::*;

const LENGTH: f64 = 100.0;
/// How exactly depths are asked for here.
const GAP: f64 = 1e-7;

fn mill(radius: f64, corner: f64, contact: Vec3, normal: Vec3, axis: Vec3) -> Mill {
    let across = normal - axis * normal.dot(&axis);
    let towards_axis = across.try_normalize(1e-9).unwrap_or_else(Vec3::zeros);
    let end = contact + normal * corner + towards_axis * (radius - corner) - axis * corner;
    Mill { radius, corner, length: LENGTH, end, axis }
}

fn asked(surface: &TestSurface, mill: &Mill, threshold: f64) -> Report {
    checked(surface, mill, &Question { threshold, gap: GAP, patience: Patience::default() })
}

fn checked(surface: &TestSurface, mill: &Mill, question: &Question<'_>) -> Report {
    let e = mill.radius - mill.corner;
    let numbers = [2.0 * mill.radius, mill.corner, e, mill.corner, 0.0, 0.0, mill.length];
    let tool = Tool::new(&Cutter::from_numbers(&numbers, 1.0).expect("a cutter"), 0.0);
    let obstacles = [Obstacle::new(surface.patches.clone())];
    let pose = Pose { end: mill.end, axis: mill.axis };
    check(&tool, &pose, &obstacles, question)
}

/// Checks a row of the table of reference 5.3: both searches find this depth.
fn row(name: &str, surface: &TestSurface, mill: &Mill, depth: f64) {
    let report = asked(surface, mill, 1e-6);
    assert!(report.proved, "{name}: no proof after {:?}", report.cost);
    let found = report.worst.map_or(0.0, |worst| worst.depth);
    assert!((found - depth).abs() < 2e-6, "{name}: found {found}, expected {depth}");
    assert!(report.bound >= found && report.bound <= found.max(0.0) + 2e-6, "{name}: {report:?}");
    let (dense, _) = deepest(surface, mill);
    assert!(dense <= found + 2e-6, "{name}: dense search found {dense}, expected {depth}");
    if let Some(worst) = report.worst {
        assert!((mill.depth(worst.point) - worst.depth).abs() < 1e-9, "{name}: {worst:?}");
    }
}

fn ball(radius: f64) -> Mill {
    mill(radius, radius, Vec3::zeros(), Vec3::z(), Vec3::z())
}

#[test]
fn t01_to_t05_one_patch() {
    row("T01", &t01(), &ball(5.0), 0.0);
    row("T02", &t02(), &ball(10.0), 10.0 - (68.0 + 4.0 * 28.0f64.sqrt()).sqrt());
    row("T03", &t03(), &ball(5.0), 5.0 - 21.0f64.sqrt());
    row("T04", &t04(), &ball(12.0), 12.0 - 140.0f64.sqrt());
    row("T05", &t05(), &mill(6.0, 0.0, Vec3::zeros(), Vec3::z(), Vec3::z()), 26.0 - 640.0f64.sqrt());
}

#[test]
fn t06_to_t08_creases_and_walls() {
    row("T06", &t06(), &ball(5.0), 5.0 - 20.0f64.sqrt());
    row("T07", &t07(), &ball(4.0), 2.0 - 2.0f64.sqrt());
    let boss = mill(5.0, 5.0, Vec3::new(14.0, 0.0, 0.0), Vec3::z(), Vec3::z());
    row("T08", &t08(), &boss, 1.0);
}

#[test]
fn t09_and_t10_twist_and_bumps() {
    row("T09", &t09(), &mill(6.0, 0.0, Vec3::zeros(), Vec3::z(), Vec3::z()), 56.0 - 50.0 * 1.24f64.sqrt());
    row("T10", &t10(), &mill(6.0, 6.0, Vec3::new(15.0, 5.0, -2.0), Vec3::z(), Vec3::z()), 0.038302);
}

#[test]
fn t11_a_leaning_bull_nose_in_a_trough() {
    for (lead, depth) in [
        (5.0f64, 0.541462),
        (10.0, 0.235094),
        (15.0, 0.053480),
        (19.0, 0.000607),
        (19.4, 0.0000139),
        (19.48, 0.0),
    ] {
        let (s, c) = lead.to_radians().sin_cos();
        let bull = mill(8.0, 2.0, Vec3::zeros(), Vec3::z(), Vec3::new(0.0, s, c));
        row("T11", &t11(), &bull, depth);
    }
}

#[test]
fn t12_the_shank_meets_a_tall_wall_that_its_tip_does_not() {
    row("T12", &t12(), &ball(5.0), 1.0);
}

#[test]
fn t13_a_collapsed_edge() {
    let pole = Vec3::new(0.0, 0.0, -6.0);
    row("T13", &t13(), &mill(5.0, 5.0, pole, Vec3::z(), Vec3::z()), 0.0);
    row("T13", &t13(), &mill(7.0, 7.0, pole, Vec3::z(), Vec3::z()), 7.0 - 37.0f64.sqrt());
}

/// Boxes and cells that are bounded between two questions whether to go on, some microseconds each.
const WORK_BETWEEN_QUESTIONS: u64 = 150;

#[test]
fn a_check_asks_often_whether_to_go_on_and_proves_nothing_once_it_is_given_up() {
    let (surface, flat) = (t09(), mill(6.0, 0.0, Vec3::zeros(), Vec3::z(), Vec3::z()));
    let whole = asked(&surface, &flat, 1e-6);
    let depth = whole.worst.expect("the twist is in the tool").depth;
    let (mut before, mut ended) = (0, 0);
    for most in 1.. {
        let questions = Cell::new(0);
        let cancel = || {
            questions.set(questions.get() + 1);
            questions.get() == most
        };
        let waiting = Waiting::until(&cancel);
        let question = Question { threshold: 1e-6, gap: GAP, patience: waiting.patience() };
        let report = checked(&surface, &flat, &question);
        let work = report.cost.boxes + report.cost.cells;
        assert!(work - before <= WORK_BETWEEN_QUESTIONS, "{work} after {before}");
        before = work;
        if !waiting.has_given_up() {
            assert_eq!(report, whole);
            break;
        }
        ended += 1;
        assert!(!report.proved && report.bound >= depth, "{report:?}");
    }
    assert!(ended >= 2, "{whole:?}");
}

/// A ball in contact at parameters of a surface with the axis along z.
fn ball_at(surface: &TestSurface, radius: f64, u: f64, v: f64) -> Mill {
    let at = surface.patches.evaluate_global(u, v).expect("inside");
    let normal = at.regular_normal().expect("regular");
    mill(radius, radius, at.position, normal, Vec3::z())
}

#[test]
fn t14_and_t15_free_form() {
    let wide = t14();
    for (u, v, depth) in [(3.37, 7.94, 1.142930), (6.63, 4.02, 0.693816), (9.25, 4.67, 0.122116)] {
        row("T14", &wide, &ball_at(&wide, 20.0, u, v), depth);
    }
    let fine = t15();
    for (u, v, depth) in [(9.87, 17.85, 0.162399), (3.03, 8.73, 0.033117), (15.57, 11.01, 0.0)] {
        row("T15", &fine, &ball_at(&fine, 4.0, u, v), depth);
    }
}

/// A number that repeats itself from run to run.
fn spread(index: u32, share: f64) -> f64 {
    (f64::from(index) * share).fract()
}

/// Reference 6.3: the cost of a checked pose, counted.
#[test]
fn a_checked_pose_costs_tens_of_cells_and_boxes() {
    let cost = |surface: &TestSurface, extent: f64| {
        let (mut boxes, mut cells) = (Vec::new(), Vec::new());
        for index in 0..60 {
            let (u, v) = (
                1.0 + (extent - 2.0) * spread(index, 0.618_034),
                1.0 + (extent - 2.0) * spread(index, 0.414_214),
            );
            let report = asked(surface, &ball_at(surface, 4.0, u, v), 0.01);
            assert!(report.proved);
            boxes.push(report.cost.boxes);
            cells.push(report.cost.cells);
        }
        boxes.sort_unstable();
        cells.sort_unstable();
        (boxes[30], cells[30], boxes[59] + cells[59])
    };
    let (boxes, cells, most) = cost(&t15(), 30.0);
    assert!(boxes + cells <= 300, "{boxes} boxes, {cells} cells");
    assert!(most <= 1500, "{most} at most");
    // A hundred times the patches cost hardly more.
    let wide = |count: usize| {
        spline(count, |i, j| {
            Vec3::new(
                2.0 * i,
                2.0 * j,
                3.0 * (0.45 * i).sin() * (0.35 * j).cos() + 0.5 * (1.7 * i + 0.3 * j).sin(),
            )
        })
    };
    let (small, large) = (cost(&wide(13), 10.0), cost(&wide(103), 100.0));
    let ratio = (large.0 + large.1) as f64 / (small.0 + small.1) as f64;
    assert!(ratio <= 1.5, "{small:?} and {large:?}");
}

/// The number of random cases: more in a longer run, by the environment.
fn cases() -> u32 {
    std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(64)
}

/// A patch with a random net about the unit square, scaled to ten units.
fn random_patch(z: &[f64]) -> TestSurface {
    let net: [[Vec3; 4]; 4] = std::array::from_fn(|i| {
        std::array::from_fn(|j| Vec3::new(10.0 * i as f64 / 3.0, 10.0 * j as f64 / 3.0, z[4 * i + j]))
    });
    let bernstein = |t: f64| {
        let s = 1.0 - t;
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
    };
    let at = move |u: f64, v: f64| {
        let (bu, bv) = (bernstein(u), bernstein(v));
        let mut sum = Vec3::zeros();
        for (row, wu) in net.iter().zip(bu) {
            for (point, wv) in row.iter().zip(bv) {
                sum += point * (wu * wv);
            }
        }
        sum
    };
    let patch = apt_geometry::parametric::Patch::from_points(&net);
    TestSurface {
        patches: surface(vec![patch], Some((1, 1))),
        pieces: vec![Function { low: [0.0; 2], high: [1.0; 2], cells: [60, 60], at: Box::new(at) }],
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases()) })]

    /// No filter clears a pose that the dense search finds in the surface, and depths agree.
    #[test]
    fn nothing_is_missed(
        z in prop::collection::vec(-4.0..4.0f64, 16),
        end in prop::array::uniform3(-2.0..12.0f64), lean in prop::array::uniform2(-0.8..0.8f64),
        radius in 0.5..4.0f64, part in 0.0..1.0f64, length in 3.0..20.0f64,
    ) {
        let surface = random_patch(&z);
        let corner = if part < 0.2 { 0.0 } else if part > 0.8 { radius } else { radius * part };
        let length = length.max(corner + 0.1);
        let axis = Vec3::new(lean[0], lean[1], 1.0).normalize();
        let mill = Mill { radius, corner, length, end: Vec3::new(end[0], end[1], 0.4 * (end[2] - 5.0)), axis };
        let (dense, _) = deepest(&surface, &mill);
        let report = asked(&surface, &mill, 0.01);
        prop_assert!(report.proved);
        prop_assert!(report.bound >= dense - 1e-9, "{} below {dense}", report.bound);
        match report.worst {
            Some(worst) => {
                // On a ridge of the depth the nested grids stop short; what was found must be there all the same.
                let [u, v] = worst.parameters;
                let there = (surface.pieces[0].at)(u, v);
                prop_assert!((there - worst.point).norm() < 1e-9);
                prop_assert!((mill.depth(there) - worst.depth).abs() < 1e-9);
                prop_assert!(worst.depth >= dense - 2.0 * GAP, "{worst:?} against {dense}");
            }
            None => prop_assert!(dense <= 0.01 + 1e-9, "missed {dense}"),
        }
    }

    /// What a checker has kept from other poses changes no answer.
    #[test]
    fn what_is_kept_from_pose_to_pose_changes_no_answer(
        start in prop::array::uniform2(4.0..26.0f64), moves in prop::collection::vec((prop::array::uniform3(-1.0..1.0f64), 0.0..1.0f64), 12),
        corner in prop::sample::select(vec![0.0, 0.5, 2.0]), lean in prop::array::uniform2(-0.3..0.3f64),
    ) {
        let surface = t15();
        let obstacles = [Obstacle::new(surface.patches.clone())];
        let numbers = [4.0, corner, 2.0 - corner, corner, 0.0, 0.0, 10.0];
        let tool = Tool::new(&Cutter::from_numbers(&numbers, 1.0).expect("a cutter"), 0.0);
        let mut checker = Checker::new(tool, &obstacles);
        let mut end = surface.patches.evaluate_global(start[0], start[1]).expect("inside").position;
        let mut axis = Vec3::z();
        for (way, far) in moves {
            // Some moves are small, some lead away.
            end += Vec3::from(way) * far.powi(4) * 4.0;
            axis = (axis + Vec3::new(lean[0], lean[1], 0.0) * far.powi(4)).normalize();
            let pose = Pose { end, axis };
            let question = Question { threshold: 0.01, gap: GAP, patience: Patience::default() };
            let (again, anew) = (checker.check(&pose, &question), check(&tool, &pose, &obstacles, &question));
            prop_assert!(again.proved && anew.proved);
            let depth = |report: &Report| report.worst.map_or(0.0, |worst| worst.depth);
            prop_assert!((depth(&again) - depth(&anew)).abs() <= 2.0 * GAP, "{again:?} against {anew:?}");
        }
    }

    /// A rigid motion, a shift by 10,000 units and inches in place of millimetres change no decision.
    #[test]
    fn decisions_move_with_the_work(
        z in prop::collection::vec(-4.0..4.0f64, 16), end in prop::array::uniform3(1.0..9.0f64),
        turn in prop::array::uniform3(-1.0..1.0f64), scale in prop::sample::select(vec![1.0, 25.4, 1.0 / 25.4]),
        shift in prop::sample::select(vec![0.0, 1e4]),
    ) {
        let surface = random_patch(&z);
        let mill = Mill { radius: 2.0, corner: 0.5, length: 8.0, end: Vec3::new(end[0], end[1], 0.3 * (end[2] - 5.0)), axis: Vec3::z() };
        let before = asked(&surface, &mill, 0.01);
        let rotation = nalgebra::Rotation3::new(Vec3::from(turn));
        let place = |p: &Vec3| rotation * (p * scale) + Vec3::repeat(shift * scale);
        let points = surface.patches.patches[0].points().map(|row| row.map(|point| place(&point)));
        let moved = TestSurface {
            patches: crate::surfaces::surface(vec![apt_geometry::parametric::Patch::from_points(&points)], Some((1, 1))),
            pieces: Vec::new(),
        };
        let moved_mill = Mill {
            radius: 2.0 * scale, corner: 0.5 * scale, length: 8.0 * scale, end: place(&mill.end), axis: rotation * mill.axis,
        };
        let after = asked(&moved, &moved_mill, 0.01 * scale);
        match (before.worst, after.worst) {
            (Some(a), Some(b)) => prop_assert!((a.depth * scale - b.depth).abs() < 1e-6 * scale.max(1.0)),
            (a, b) => prop_assert_eq!(a.is_some(), b.is_some()),
        }
    }
}
