//! The section of a polyconic surface by the plane of a station: a rational conic, straight on beyond its ends.

use super::Course;
use crate::{canonical::extent::POLYCONIC_ENDS_BEYOND, surface::interval::Number};

/// Both coordinates in a section plane.
pub(super) type Flat<T> = [T; 2];

/// A point of a section plane with derivatives by the station parameter.
pub(super) type Control<T> = [Flat<T>; 3];

/// The three control points of a conic from A, B, C, D, L, H.
pub(super) fn controls<T: Number>([a, b, c, d, l, h]: [Course<T>; 6]) -> [Control<T>; 3] {
    let sum = |x: Course<T>, y: Course<T>| -> Course<T> { std::array::from_fn(|k| x[k] + y[k]) };
    let of = |y: Course<T>, z: Course<T>| -> Control<T> { std::array::from_fn(|k| [y[k], z[k]]) };
    let (y1, z1) = (sum(l, c), sum(h, b));
    [of(l, h), of(y1, z1), of(sum(y1, a), sum(z1, d))]
}

/// Weight of the middle control point from the fullness `p`: `(2p − 1)/(2(1 − p))`.
pub(super) fn weight<T: Number>([p, p1, p2]: Course<T>) -> Course<T> {
    let half = T::from(0.5);
    let rest = T::from(1.0) - p;
    let slope = half / (rest * rest);
    [half / rest - T::from(1.0), slope * p1, slope * p2 + p1 * p1 / (rest * rest * rest)]
}

/// The place of a conic parameter on the section through a station, with its derivatives: value, t, s, tt, ts, ss.
pub(super) fn section<T: Number>(
    controls: &[Control<T>; 3],
    weight: &Course<T>,
    t: T,
    [before, after]: [bool; 2],
) -> [Flat<T>; 6] {
    let [p0, p1, p2] = controls;
    if before {
        straight(p0, p1, t, 1.0)
    } else if after {
        straight(p2, p1, T::from(1.0) - t, -1.0)
    } else {
        conic(controls, weight, t)
    }
}

/// A straight end: from a control point away from where the end tangents meet. `x` is negative; it grows with the
/// parameter in the given sense.
fn straight<T: Number>(end: &Control<T>, meet: &Control<T>, x: T, sense: f64) -> [Flat<T>; 6] {
    let beyond = T::from(POLYCONIC_ENDS_BEYOND);
    let way: Control<T> = std::array::from_fn(|k| std::array::from_fn(|i| (meet[k][i] - end[k][i]) * beyond));
    let at = |k: usize| -> Flat<T> { std::array::from_fn(|i| end[k][i] + way[k][i] * x) };
    let along = |k: usize| way[k].map(|w| w * T::from(sense));
    [at(0), along(0), at(1), [T::from(0.0); 2], along(1), at(2)]
}

/// The rational conic with its derivatives: value, t, s, tt, ts, ss.
fn conic<T: Number>(controls: &[Control<T>; 3], weight: &Course<T>, t: T) -> [Flat<T>; 6] {
    let number = T::from;
    let two = number(2.0);
    let r = number(1.0) - t;
    // Basis by t: value, first, second derivative.
    let basis = [
        [r * r, two * t * r, t * t],
        [number(-2.0) * r, two - number(4.0) * t, two * t],
        [two, number(-4.0), two],
    ];
    let [w, w1, w2] = *weight;
    let denominator = |i: usize, k: usize| {
        let [start, middle, end] = basis[i];
        let ends = if k == 0 { start + end } else { number(0.0) };
        ends + weight[k] * middle
    };
    let d = denominator(0, 0);
    let (dt, ds, dtt, dts, dss) =
        (denominator(1, 0), denominator(0, 1), denominator(2, 0), denominator(1, 1), denominator(0, 2));
    let mut found = [[number(0.0); 2]; 6];
    for c in 0..2 {
        // Weighted middle point with derivatives by s.
        let [p, p1, p2] = [0, 1, 2].map(|k: usize| controls[1][k][c]);
        let middle = [p * w, p1 * w + p * w1, p2 * w + two * p1 * w1 + p * w2];
        let numerator = |i: usize, k: usize| {
            controls[0][k][c] * basis[i][0] + middle[k] * basis[i][1] + controls[2][k][c] * basis[i][2]
        };
        let value = numerator(0, 0) / d;
        let by_t = (numerator(1, 0) - value * dt) / d;
        let by_s = (numerator(0, 1) - value * ds) / d;
        let tt = (numerator(2, 0) - value * dtt - by_t * two * dt) / d;
        let ts = (numerator(1, 1) - value * dts - by_t * ds - by_s * dt) / d;
        let ss = (numerator(0, 2) - value * dss - by_s * two * ds) / d;
        for (all, one) in found.iter_mut().zip([value, by_t, by_s, tt, ts, ss]) {
            all[c] = one;
        }
    }
    found
}
