//! Cut vectors against the integral of √(κ/8τ) along the exact path (arelem reference 5.6), worked out here from the
//! curves' own formulas.

use std::sync::Arc;

use DriveSide::{Left, Right};
use Relation::{On, To};
use Turn::{Forward, Left as GoLft, Right as GoRgt};
use apt_geometry::canonical::{Interval, TabulatedCylinder};

use super::*;

/// A plane curve by a parameter: position, first and second derivative in x and y.
pub(super) type Curve<'a> = &'a dyn Fn(f64) -> [[f64; 2]; 3];

/// The integral for the parallel curve at a signed distance to the left, over the part of it that lies between two
/// limits of x or y.
pub(super) fn integral(
    curve: Curve<'_>,
    range: [f64; 2],
    left: f64,
    axis: usize,
    between: [f64; 2],
    band: f64,
) -> f64 {
    let steps = 50_000;
    let width = (range[1] - range[0]) / f64::from(steps);
    let mut sum = 0.0;
    for k in 0..steps {
        let [p, d, dd] = curve(range[0] + width * (f64::from(k) + 0.5));
        let speed = d[0].hypot(d[1]);
        // Positive where the curve turns to the left.
        let curvature = (d[0] * dd[1] - d[1] * dd[0]) / speed.powi(3);
        let offset = [p[0] - left * d[1] / speed, p[1] + left * d[0] / speed];
        if offset[axis] < between[0] || offset[axis] > between[1] {
            continue;
        }
        let stretch = (1.0 - left * curvature).abs();
        sum += (curvature.abs() * stretch / (8.0 * band)).sqrt() * speed * width.abs();
    }
    sum
}

/// What a vector covers less, by the integral, that begins in the middle of the band and not at its limit: half of 1 − √½, and as much again in
/// the last vector, which may end in the middle, too.
pub(super) const LOST: f64 = 0.3;

fn assert_frugal(name: &str, sequence: &CutSequence, integral: f64) {
    let count = sequence.points.len();
    let minimum = sequence.minimum.expect("a bound");
    println!("{name}: {count} vectors, integral {integral:.3}, bound {minimum}");
    assert!(count as f64 <= 1.02 * integral + 2.0, "{name}: {count} vectors, integral {integral}");
    assert!(minimum as usize <= count, "{name}: bound {minimum} above {count}");
    assert!(f64::from(minimum) >= 0.97 * integral - 2.0, "{name}: bound {minimum} for integral {integral}");
    let most = (integral + LOST).ceil();
    assert!(f64::from(minimum) <= most, "{name}: bound {minimum} above the integral {integral}");
}

const BANDS: [f64; 3] = [1e-2, 1e-3, 1e-5];

#[test]
fn ellipse_drive() {
    let ellipse = quadric([1.0 / 16.0, 0.25, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let curve = |t: f64| {
        let (s, c) = t.sin_cos();
        [[4.0 * c, 2.0 * s], [-4.0 * s, 2.0 * c], [-4.0 * c, -2.0 * s]]
    };
    for band in BANDS {
        for (side, y, left) in [(Left, 6.0, -0.25), (Right, 0.5, 0.25)] {
            let mut p = Program::new();
            p.run(&MotionCommand::MaximumPoints(100_000)).tolerance(0.3 * band, 0.7 * band).cutter(&[0.5]);
            p.from(0.0, y, 0.0).go(&[(To, &ellipse), (To, &ground()), (On, &x(0.0))]);
            p.indirv(1.0, 0.0, 0.0).side(side).drive(Forward, &ellipse, On, &x(3.5)).verified();
            let wanted = integral(&curve, [0.0, std::f64::consts::FRAC_PI_2], left, 0, [0.0, 3.5], band);
            assert_frugal("ellipse", p.last(), wanted);
        }
    }
}

#[test]
fn hyperbola_drive() {
    let hyperbola = quadric([0.25, -1.0 / 2.25, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let curve = |t: f64| {
        let (s, c) = (t.sinh(), t.cosh());
        [[2.0 * c, 1.5 * s], [2.0 * s, 1.5 * c], [2.0 * c, 1.5 * s]]
    };
    for band in BANDS {
        let mut p = Program::new();
        p.run(&MotionCommand::MaximumPoints(100_000)).tolerance(0.0, band).cutter(&[0.5]);
        p.from(0.0, 0.0, 0.0).run(&MotionCommand::Direction([
            Some(Direction::Vector(v(1.0, 0.0, 0.0))),
            None,
            None,
        ]));
        p.go(&[(To, &hyperbola)]).side(Right);
        p.drive(GoLft, &hyperbola, On, &plane(0.0, 1.0, 0.0, 2.0)).verified();
        let wanted = integral(&curve, [0.0, 3.0], 0.25, 1, [0.0, 2.0], band);
        assert_frugal("hyperbola", p.last(), wanted);
    }
}

/// The directrix of the corpus program tabcyl-drive: u, v, a, b of its intervals.
const TABLE: [[f64; 4]; 5] = [
    [-7.748_959_71, -6.320_887_87, 0.0, 0.0],
    [0.0, 0.0, 0.0, -0.100_286_59],
    [2.0, 1.0, 0.006_513_64, -0.102_191_29],
    [5.0, 1.0, 0.0, -0.042_835_06],
    [8.0, 0.0, 0.0, 0.0],
];
const TABLE_END: [f64; 2] = [16.976_504_32, -4.407_081_82];

pub(super) fn table() -> Geometry {
    tabulated(&TABLE, TABLE_END)
}

pub(crate) fn tabulated(table: &[[f64; 4]], end: [f64; 2]) -> Geometry {
    let interval = |[u, v, a, b]: [f64; 4]| Interval { u, v, a, b, length: 0.0, maximum: 0.0, minimum: 0.0 };
    Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals: table.iter().copied().map(interval).collect(),
        last: end,
    }))
}

/// The directrix over the intervals in order: the whole part of the parameter tells which.
fn along_table(t: f64) -> [[f64; 2]; 3] {
    along_directrix(&TABLE, TABLE_END, t)
}

/// The same for any directrix, given by u, v, a, b of its intervals and its end.
pub(super) fn along_directrix(table: &[[f64; 4]], table_end: [f64; 2], t: f64) -> [[f64; 2]; 3] {
    let k = (t as usize).min(table.len() - 1);
    let [u, v, a, b] = table[k];
    let end = table.get(k + 1).map_or(table_end, |next| [next[0], next[1]]);
    let (dx, dy) = (end[0] - u, end[1] - v);
    let length = dx.hypot(dy);
    let (cx, cy) = (dx / length, dy / length);
    let s = (t - k as f64) * length;
    let c = -length * (a * length + b);
    let (h, h1, h2) = (((a * s + b) * s + c) * s, (3.0 * a * s + 2.0 * b) * s + c, 6.0 * a * s + 2.0 * b);
    let turn = |along: f64, up: f64| [cx * along - cy * up, cy * along + cx * up];
    let [px, py] = turn(s, h);
    let scale = |[x, y]: [f64; 2], by: f64| [x * by, y * by];
    [[u + px, v + py], scale(turn(1.0, h1), length), scale(turn(0.0, h2), length * length)]
}

#[test]
fn tabulated_drive() {
    for band in BANDS {
        let mut p = Program::new();
        p.run(&MotionCommand::MaximumPoints(100_000)).tolerance(0.5 * band, 0.5 * band).cutter(&[0.5]);
        p.from(0.5, 3.0, 0.0).go(&[(To, &table()), (To, &ground()), (On, &x(0.5))]).side(Left);
        p.drive(GoLft, &table(), On, &x(7.5)).verified();
        let wanted = integral(&along_table, [0.0, 5.0], 0.25, 0, [0.5, 7.5], band);
        assert_frugal("tabulated cylinder", p.last(), wanted);
    }
}

#[test]
fn conic_part_surface() {
    // A parabolic cylinder z = 2 − x²/4 under a ball.
    let conic = quadric([0.25, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5]);
    let curve = |t: f64| [[t, 2.0 - 0.25 * t * t], [1.0, -0.5 * t], [0.0, -0.5]];
    for band in BANDS {
        let mut p = Program::new();
        p.run(&MotionCommand::MaximumPoints(100_000)).tolerance(0.0, band).cutter(&[0.5, 0.25]);
        let wall = plane(0.0, 1.0, 0.0, 0.5);
        p.from(-2.0, 0.5, 5.0).go(&[(On, &wall), (To, &conic), (On, &x(-2.0))]).indirv(1.0, 0.0, 0.0);
        p.side(DriveSide::On).drive(Forward, &wall, On, &x(2.0)).verified();
        let wanted = integral(&curve, [-3.0, 3.0], 0.25, 0, [-2.0, 2.0], band);
        assert_frugal("parabolic part surface", p.last(), wanted);
    }
}

#[test]
fn cones_have_the_bound_of_their_ring() {
    let vertical = cone(v(0.0, 0.0, 3.0), v(0.0, 0.0, -1.0), 30.0);
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.5, 0.25]);
    p.from(4.0, 0.0, 1.0).go(&[(To, &vertical), (To, &ground()), (On, &plane(0.0, 1.0, 0.0, 0.0))]);
    p.side(Left).drive(GoLft, &vertical, On, &x(0.0)).verified();
    let sequence = p.last();
    // Worked case W29: 23 vectors from limit to limit.
    assert!(sequence.minimum >= Some(23), "{:?}", sequence.minimum);
    assert!(sequence.points.len() <= sequence.minimum.unwrap_or(0) as usize + 1);
}

#[test]
fn straight_paths_on_curved_surfaces_need_one_vector() {
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.5, 0.25]);
    let roof = cylinder(Vec3::zeros(), Vec3::x(), 2.0);
    let wall = plane(0.0, 1.0, 0.0, 0.5);
    p.from(-2.0, 0.5, 5.0).go(&[(On, &wall), (To, &roof), (On, &x(-2.0))]).indirv(1.0, 0.0, 0.0);
    p.side(DriveSide::On).drive(Forward, &wall, On, &x(2.0)).verified();
    assert_eq!((p.last().points.len(), p.last().minimum), (1, Some(1)));
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.5]).from(2.0, 3.0, 0.0);
    p.go(&[(To, &circle(0.0, 0.0, 2.0)), (To, &ground()), (On, &x(1.0))]);
    p.side(Left).drive(GoRgt, &circle(0.0, 0.0, 2.0), On, &x(1.3)).verified();
    assert!(p.last().minimum <= Some(p.last().points.len() as u32));
}

/// MAXDP does not count where part and drive surface are both planes (language reference 6.8): the bound does not count it either, as
/// far as either surface is no plane it does.
#[test]
fn maxdp_is_no_bound_between_planes() {
    let canted = plane(0.1, 0.0, 1.0, 0.0);
    for part in [ground(), canted] {
        let mut p = Program::new();
        p.run(&MotionCommand::MaximumStep(0.1)).cutter(&[0.5, 0.25]).from(0.0, 2.0, 1.0);
        p.go(&[(To, &y(0.0)), (To, &part), (On, &x(0.0))])
            .side(Left)
            .drive(GoLft, &y(0.0), On, &x(105.0))
            .verified();
        assert_eq!((p.last().points.len(), p.last().minimum), (1, Some(1)));
    }
    let mut p = Program::new();
    p.run(&MotionCommand::MaximumStep(0.1)).cutter(&[0.5, 0.25]).from(0.0, -5.0, 1.0);
    let hill = cylinder(Vec3::zeros(), Vec3::x(), 1.0);
    p.go(&[(On, &y(0.0)), (To, &hill), (On, &x(0.0))]).side(DriveSide::On);
    p.drive(GoRgt, &y(0.0), On, &x(5.0)).verified();
    assert!(p.last().minimum.is_some_and(|minimum| (45..=50).contains(&minimum)), "{:?}", p.last().minimum);
}
