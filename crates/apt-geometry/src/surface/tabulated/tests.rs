//! Directrices whose extensions meet, that end where they begin, or that would come back to themselves: against dense sampling.

use proptest::prelude::*;

use super::*;
use crate::{canonical::Interval, patience::Patience, surface::Bend};

/// A curve through points by cubics of a bulge each, `v = b u (u − L)` over its chords, with straight first and last intervals.
pub(super) fn curve(points: &[[f64; 2]], bulge: f64) -> TabulatedCylinder {
    let count = points.len();
    let interval = |(k, [u, v]): (usize, &[f64; 2])| {
        let b = if k == 0 || k + 2 == count { 0.0 } else { bulge };
        Interval { u: *u, v: *v, a: 0.0, b, length: 0.0, maximum: 0.0, minimum: 0.0 }
    };
    TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals: points.iter().take(count - 1).enumerate().map(interval).collect(),
        last: points[count - 1],
    }
}

/// A drop with its tip at (5, 0), round to the left, of which the extensions lead up to shortly before the tip.
pub(super) fn drop_shape() -> TabulatedCylinder {
    let tip = |y: f64| [4.95, 0.01 * y];
    curve(&[tip(1.0), [0.0, 1.0], [-2.0, 0.0], [0.0, -1.0], tip(-1.0)], 0.1)
}

/// A square of four bulging sides that ends where it begins, with extensions away from there.
fn pillow() -> TabulatedCylinder {
    curve(&[[12.0, 4.0], [2.0, 2.0], [-2.0, 2.0], [-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [4.0, 12.0]], 0.1)
}

fn made(cylinder: &TabulatedCylinder) -> DirectrixCurve {
    DirectrixCurve::new(cylinder).expect("a curve")
}

/// Places of the intervals of a curve, close to each other.
fn places(curve: &DirectrixCurve) -> Vec<Vec2> {
    let of_interval = |interval: &Cubic| {
        let place = |k: u32| {
            let s = interval.length * f64::from(k) / 400.0;
            interval.start + interval.along * s + interval.normal_axis() * interval.height(s)[0]
        };
        (0..400).map(place).collect::<Vec<_>>()
    };
    curve.intervals.iter().flat_map(of_interval).collect()
}

/// Whether a closed polygon winds round a point.
fn is_inside(polygon: &[Vec2], p: Vec2) -> bool {
    let crosses = |(a, b): (&Vec2, &Vec2)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)
    };
    polygon.iter().zip(polygon.iter().cycle().skip(1)).filter(|pair| crosses(*pair)).count() % 2 == 1
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    /// The natural normal of curves that go round to the left points inward.
    #[test]
    fn a_closed_curve_has_an_inside_and_an_outside(which in 0..2usize, x in -6.0..12.0f64, y in -6.0..12.0f64) {
        let curve = made(&[drop_shape(), pillow()][which]);
        prop_assert!(curve.closed && !curve.has_ends());
        let (polygon, p) = (places(&curve), Vec2::new(x, y));
        let (foot, _) = curve.foot(&Vec3::new(x, y, 7.0));
        let nearest = polygon.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
        prop_assert!((foot.distance.abs() - nearest).abs() < 1e-2, "{} {nearest}", foot.distance);
        prop_assert!(nearest < 1e-2 || (foot.distance > 0.0) == is_inside(&polygon, p), "{}", foot.distance);
    }

    /// As over open curves the distance rises above its chords by no more than the bound says.
    #[test]
    fn the_bend_about_a_closed_curve_is_bounded(
        which in 0..2usize, center in prop::array::uniform2(-4.0..6.0f64), radius in 0.05..0.6f64, inside in any::<bool>(),
        ends in prop::collection::vec(prop::array::uniform4(-1.0..1.0f64), 30),
    ) {
        let cylinder = [drop_shape(), pillow()][which].clone();
        let surface = super::super::Surface::Tabulated(Box::new(made(&cylinder)));
        let (side, center) = (if inside { 1.0 } else { -1.0 }, Vec3::new(center[0], center[1], 0.0));
        let region = super::super::Region { center, radius, lowest: -0.02, highest: 3.0 };
        let bend = surface.bend(side, &surface.foot(&center), &region, Patience::default());
        let Bend::AtMost(bound) = bend else { return Ok(()) };
        let distance = |p: &Vec3| side * surface.signed_distance(p);
        for [a, b, c, d] in ends {
            let place = |x: f64, y: f64| center + Vec3::new(x, y, 0.0) * (radius / x.hypot(y).max(1.0));
            let (from, to) = (place(a, b), place(c, d));
            let heights: Vec<f64> =
                (0..=20).map(|k| distance(&(from + (to - from) * (f64::from(k) / 20.0)))).collect();
            if heights.iter().all(|h| (region.lowest..=region.highest).contains(h)) {
                let rise = 0.5 * (heights[0] + heights[20]) - heights[10];
                prop_assert!(rise <= bound * (to - from).norm_squared() / 8.0 + 1e-11, "{rise} {bound}");
            }
        }
    }
}

#[test]
fn extensions_that_meet_end_where_they_meet() {
    let curve = made(&drop_shape());
    let distance = |x: f64, y: f64| curve.foot(&Vec3::new(x, y, 0.0)).0.distance;
    // Ahead of the tip, and beside it where the lines would go on crosswise.
    assert!((distance(6.0, 0.0) + 1.0).abs() < 1e-9, "{}", distance(6.0, 0.0));
    assert!((distance(8.0, 0.6) + 3f64.hypot(0.6)).abs() < 1e-9, "{}", distance(8.0, 0.6));
    // A walk along the curve goes on over the tip, where the first interval follows the last.
    let at_tip = curve.place_near(&Vec3::new(4.9, -0.1, 0.0));
    let over = curve.shifted(&at_tip, [0.0, 0.2]).expect("a place");
    let chart = curve.chart(&over).expect("a chart");
    assert!(over.piece < at_tip.piece && chart.point.y > 0.0, "{over:?} {}", chart.point);
}

/// Of extensions along one line it is rounding alone where the lines of both cross, so that they meet nowhere.
#[test]
fn a_straight_curve_goes_on_for_ever_at_both_ends() {
    for k in 0..2000 {
        let angle = 1e-3 * f64::from(k);
        let (sine, cosine) = angle.sin_cos();
        let along = |x: f64| [0.3 + x * cosine, 0.7 + x * sine];
        let curve = made(&curve(&[along(-2.0), along(-1.1), along(0.0), along(0.9), along(1.7)], 0.0));
        assert!(!curve.closed && !curve.has_ends(), "{angle}");
        for (x, y) in [(0.3, 0.4), (-7.0, -0.2), (9.0, 1.3)] {
            let [u, v] = along(x);
            let (foot, _) = curve.foot(&Vec3::new(u - y * sine, v + y * cosine, 0.0));
            assert!((foot.distance - y).abs() < 1e-12, "{angle}: {} for {y}", foot.distance);
        }
    }
}

#[test]
fn a_curve_that_ends_where_it_begins_has_no_extensions() {
    let curve = made(&pillow());
    assert_eq!(curve.intervals.len(), 4);
    assert!((curve.foot(&Vec3::new(6.0, 5.0, 0.0)).0.distance + 5.0).abs() < 1e-9);
    // So it is where the extensions would meet at once and have no length.
    let mut bare = pillow();
    bare.intervals[0].u = 2.0;
    bare.intervals[0].v = 2.0;
    bare.last = [2.0, 2.0];
    assert_eq!(made(&bare), curve);
}

#[test]
fn an_extension_that_would_come_back_to_the_curve_ends_where_it_is_defined_to_end() {
    // A hook: the last extension would go on to the long side.
    let hook = curve(&[[-10.0, 0.0], [0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [12.0, 10.0], [12.0, 7.0]], 0.0);
    let curve = made(&hook);
    assert_eq!(curve.tips, [Vec2::new(12.0, 7.0)]);
    let distance = |x: f64, y: f64| curve.foot(&Vec3::new(x, y, 0.0)).0.distance;
    assert!((distance(10.0, 3.0) - 3.0).abs() < 1e-12 && (distance(-40.0, 2.0) - 2.0).abs() < 1e-12);
    assert!((distance(12.0, 4.0).abs() - 3.0).abs() < 1e-12, "{}", distance(12.0, 4.0));
    assert!(curve.has_ends() && curve.ends_at(&Vec3::new(12.5, 6.0, 0.0)));
    assert!(!curve.ends_at(&Vec3::new(12.5, 8.0, 0.0)) && !curve.ends_at(&Vec3::new(-40.0, 2.0, 0.0)));
    assert!(curve.forms(1.0, &Vec3::new(12.0, 6.5, 0.0), 1.0).is_none());
    assert_eq!(curve.greatest_curvature(1.0, &Vec3::new(12.0, 6.5, 0.0), 1.0), f64::INFINITY);
}

/// Two places of an interval all but next to each other are as near to a point, with one that is a little farther between them.
#[test]
fn of_two_nearest_places_in_one_span_the_nearer_is_found() {
    // From (1, −.3) on, where the curve has just been turning by a radius of a sixth.
    let points = [[0.0, 0.0], [1.0, -0.3], [3.0, -0.4]];
    let row = |k: usize, a: f64, b: f64| Interval {
        u: points[k][0],
        v: points[k][1],
        a,
        b,
        length: 0.0,
        maximum: 0.0,
        minimum: 0.0,
    };
    let cylinder = TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals: vec![row(0, -2.545_304, 5.394_014), row(1, -0.024_41, 0.128_87)],
        last: points[2],
    };
    let curve = made(&cylinder);
    let all = places(&curve);
    for k in 0..4000 {
        let p = Vec2::new(0.7 + 0.5 * f64::from(k % 200) / 200.0, -0.5 - 0.1 * f64::from(k / 200) / 20.0);
        let found = curve.foot(&Vec3::new(p.x, p.y, 0.0)).0.distance.abs();
        let sampled = all.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
        assert!(found <= sampled + 1e-12, "{p}: {found} {sampled}");
    }
}
