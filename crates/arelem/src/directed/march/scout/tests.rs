//! Paths that never meet their check surface, and paths that meet it late.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Interval, TabulatedCylinder},
    motion::{MotionCommand, Relation, Turn},
};

use crate::{
    directed::stop::REFINED,
    error::{Course, MotionFailure},
    tests::{Program, circle, cone, cylinder, motion, plane, quadric, sphere, v},
};

/// A ball on a cylinder along x, on its way towards −x or +x.
fn on_the_back() -> Program {
    let mut p = Program::new();
    p.cutter(&[0.5, 0.25]).from(0.0, 0.0, 3.0);
    let (back, middle) = (cylinder(v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), 1.0), plane(0.0, 1.0, 0.0, 0.0));
    p.go(&[(Relation::On, &middle), (Relation::To, &back), (Relation::On, &plane(1.0, 0.0, 0.0, 0.0))]);
    p.indirv(1.0, 0.0, 0.0);
    p
}

#[test]
fn a_check_surface_left_behind_is_never_met() {
    let middle = plane(0.0, 1.0, 0.0, 0.0);
    let mut p = on_the_back();
    let behind = motion(Turn::Forward, &middle, &[(Relation::To, 1, &plane(1.0, 0.0, 0.0, -5.0))]);
    let failure = p.attempt(&behind).expect_err("it lies behind");
    let MotionFailure::NeverMet { check: 0, nearest, at, .. } = failure else { panic!("{failure:?}") };
    assert!((nearest - 4.75).abs() < 1e-9 && at.x.abs() < 1e-6, "{nearest} at {at:?}");
}

#[test]
fn a_check_surface_that_is_met_once_is_not_met_twice() {
    let middle = plane(0.0, 1.0, 0.0, 0.0);
    let mut p = on_the_back();
    p.run(&MotionCommand::MaximumPoints(1500));
    let twice = motion(Turn::Forward, &middle, &[(Relation::On, 2, &plane(1.0, 0.0, 0.0, 5.0))]);
    match p.attempt(&twice) {
        Err(MotionFailure::NoneAhead { check: 0, relation: Relation::On, found: 1 }) => {}
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_check_surface_far_ahead_is_met() {
    let middle = plane(0.0, 1.0, 0.0, 0.0);
    let mut p = on_the_back();
    p.drive(Turn::Forward, &middle, Relation::To, &plane(1.0, 0.0, 0.0, 2000.0)).verified();
    assert!((p.tip().x - 1999.75).abs() < 1e-6, "{:?}", p.tip());
}

#[test]
fn a_large_circle_comes_back() {
    // The path leaves the check surface for 60,000 units before it comes round.
    let (ring, floor) = (circle(0.0, 0.0, 20_000.0), plane(0.0, 0.0, 1.0, 0.0));
    let mut p = Program::new();
    p.tolerance(0.0, 5.0).cutter(&[0.5, 0.25]).from(20_100.0, 5.0, 0.0);
    p.run(&MotionCommand::ForceIteration(true)).run(&MotionCommand::MaximumStep(1e5));
    p.go(&[(Relation::To, &ring), (Relation::To, &floor)]);
    p.side(apt_geometry::motion::DriveSide::Left);
    p.drive(Turn::Left, &ring, Relation::On, &plane(0.0, 1.0, 0.0, 100.0));
    assert!((p.tip().y - 100.0).abs() < 5.1, "{:?}", p.tip());
    assert!(p.last().points.len() > 20, "all the way round: {}", p.last().points.len());
}

/// The failure of a motion that never meets its check surface: how near it comes, where, and how that is known.
fn lost(
    p: &mut Program,
    turn: Turn,
    drive: &Geometry,
    relation: Relation,
    check: &Geometry,
) -> (f64, Vec3, Course) {
    let failure = p.attempt(&motion(turn, drive, &[(relation, 1, check)])).expect_err("it is never met");
    let MotionFailure::NeverMet { nearest, at, course, .. } = failure else { panic!("{failure:?}") };
    (nearest, at, course)
}

#[test]
fn branches_of_conics_run_to_infinity() {
    // On x² − y² = 1 up to its vertex and away again; the check surface lies behind the vertex.
    let (branch, floor) =
        (quadric([1.0, -1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), plane(0.0, 0.0, 1.0, 0.0));
    let start = |p: &mut Program, drive: &Geometry, x: f64, y: f64| {
        p.cutter(&[0.5]).from(x, y, 0.0);
        p.go(&[(Relation::On, drive), (Relation::To, &floor), (Relation::On, &plane(0.0, 1.0, 0.0, y))]);
        p.indirv(0.0, 1.0, 0.0);
    };
    let mut p = Program::new();
    start(&mut p, &branch, 3.0, -3.0);
    let (nearest, at, course) =
        lost(&mut p, Turn::Forward, &branch, Relation::On, &plane(1.0, 0.0, 0.0, 0.5));
    assert!((nearest - 0.5).abs() < 2e-3 && (at - v(1.0, 0.0, 0.0)).norm() < 0.1, "{nearest} at {at:?}");
    assert!(matches!(course, Course::Away { travelled } if travelled > 1e4), "{course:?}");
    // On the parabola y² = 2x.
    let parabola = quadric([0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0]);
    let mut p = Program::new();
    start(&mut p, &parabola, 2.0, -2.0);
    let (nearest, at, course) =
        lost(&mut p, Turn::Forward, &parabola, Relation::To, &plane(1.0, 0.0, 0.0, -3.0));
    assert!((nearest - 2.75).abs() < 1e-3 && at.xy().norm() < 0.1, "{nearest} at {at:?}");
    assert!(matches!(course, Course::Away { .. }), "{course:?}");
}

#[test]
fn a_closed_section_is_known_before_the_points_run_out() {
    // So fine a band takes thousands of vectors a turn; NUMPTS allows 400.
    let body = quadric([0.25, 1.0, 1.0 / 2.25, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let cut = plane(0.0, 0.0, 1.0, 0.3);
    let mut p = Program::new();
    p.tolerance(0.0, 1e-6).cutter(&[0.5, 0.25]).from(5.0, 0.0, 0.3);
    p.go(&[(Relation::On, &cut), (Relation::To, &body), (Relation::On, &plane(0.0, 1.0, 0.0, 0.0))]);
    p.indirv(0.0, 1.0, 0.0);
    let (nearest, at, course) =
        lost(&mut p, Turn::Forward, &cut, Relation::To, &sphere(-9.0, 0.0, 0.55, 5.0));
    // Centre of the ball on z = .55: the extreme point of the offset ellipsoid section is on the x axis.
    assert!((nearest - (4.0 - 0.25 + at.x)).abs() < 1e-3 && at.x < -2.1, "{nearest} at {at:?}");
    assert!(matches!(course, Course::Closed { length } if (9.0..12.0).contains(&length)), "{course:?}");
    // One that is met stays a matter of NUMPTS.
    let command = motion(Turn::Forward, &cut, &[(Relation::On, 1, &plane(1.0, 0.0, 0.0, -2.0))]);
    let failure = p.attempt(&MotionCommand::From { position: p.tip(), axis: None, name: String::new() });
    assert!(failure.is_ok());
    p.indirv(0.0, 1.0, 0.0);
    let failure = p.attempt(&command).expect_err("too many vectors");
    assert!(matches!(failure, MotionFailure::TooManyPoints { limit: 400, .. }), "{failure:?}");
}

/// The spiral r = 1 + θ/10 over four turns, as a tabulated cylinder along z.
fn spiral() -> Geometry {
    let node = |k: i32| {
        let angle = 0.2 * f64::from(k);
        let (radius, (sin, cos)) = (1.0 + 0.1 * angle, angle.sin_cos());
        ([radius * cos, radius * sin], [0.1 * cos - radius * sin, 0.1 * sin + radius * cos])
    };
    let nodes: Vec<_> = (0..=126).map(node).collect();
    let interval = |u: f64, v: f64, a: f64, b: f64, length: f64| Interval {
        u,
        v,
        a,
        b,
        length,
        maximum: 0.0,
        minimum: 0.0,
    };
    let ray = |(p, d): ([f64; 2], [f64; 2]), reach: f64| {
        let size = d[0].hypot(d[1]);
        [p[0] + d[0] / size * reach, p[1] + d[1] / size * reach]
    };
    // Inwards the extension ends at once: it would cross the spiral.
    let first = ray(nodes[0], -0.1);
    let mut intervals = vec![interval(first[0], first[1], 0.0, 0.0, 0.1)];
    for pair in nodes.windows(2) {
        let ((p, d), (q, e)) = (pair[0], pair[1]);
        let length = (q[0] - p[0]).hypot(q[1] - p[1]);
        let turn = (q[1] - p[1]).atan2(q[0] - p[0]);
        let [s1, s2] = [d, e].map(|t| (t[1].atan2(t[0]) - turn).tan());
        let (a, b) = ((s1 + s2) / (length * length), -(2.0 * s1 + s2) / length);
        intervals.push(interval(p[0], p[1], a, b, length));
    }
    let last = nodes[nodes.len() - 1];
    intervals.push(interval(last.0[0], last.0[1], 0.0, 0.0, 10.0));
    let surface = TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals,
        last: ray(last, 10.0),
    };
    Geometry::TabulatedCylinder(Arc::new(surface))
}

#[test]
fn a_spiral_over_a_cone_leaves_along_its_extension() {
    let (hill, spiral) = (cone(v(0.0, 0.0, 4.0), v(0.0, 0.0, -1.0), 60.0), spiral());
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(1.3, 0.6, 6.0);
    let entry = plane(0.0, 1.0, 0.0, 0.6);
    p.go(&[(Relation::On, &spiral), (Relation::To, &hill), (Relation::On, &entry)]);
    p.indirv(0.0, 1.0, 0.0);
    let (nearest, _, course) = lost(&mut p, Turn::Forward, &spiral, Relation::On, &circle(0.0, 0.0, 0.4));
    // Nearest where it begins.
    let begin = p.last().points[0].tip.xy().norm();
    assert!((nearest - (begin - 0.4)).abs() < 0.01, "{nearest} from {begin}");
    assert!(matches!(course, Course::Away { .. }), "{course:?}");
}

/// A long step that comes near a check surface is shortened, however much nearer it comes: that is not looked for closely.
#[test]
fn the_nearest_approach_of_a_step_that_is_shortened_is_not_closed_in() {
    let (ring, floor) = (circle(0.0, 0.0, 20.0), plane(0.0, 0.0, 1.0, 0.0));
    let mut p = Program::new();
    p.tolerance(0.0, 1e-4).cutter(&[0.5, 0.25]).from(20.5, 0.0, 0.0);
    p.run(&MotionCommand::ForceIteration(true)).run(&MotionCommand::MaximumPoints(3000));
    p.go(&[(Relation::To, &ring), (Relation::To, &floor)]);
    p.side(apt_geometry::motion::DriveSide::Left);
    // A post that the tool passes at a hundredth, and a wall behind it.
    let (post, wall) = (circle(0.0, -21.51, 1.0), plane(0.0, 1.0, 0.0, 5.0));
    let before = REFINED.get();
    p.attempt(&motion(Turn::Left, &ring, &[(Relation::To, 1, &post), (Relation::On, 1, &wall)]))
        .expect("a path");
    let refined = REFINED.get() - before;
    assert!(refined <= 24, "{refined} places");
}
