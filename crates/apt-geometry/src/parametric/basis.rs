//! Cubic Bernstein polynomials: values, halving, and the conversions of other cubic forms to control points.

use nalgebra::Vector4;

use crate::Vec3;

/// A point in homogeneous coordinates `(wx, wy, wz, w)`.
pub(super) type Homogeneous = Vector4<f64>;

/// What control points and their differences count in a cubic and its derivatives at a parameter.
pub(super) struct Weights {
    value: [f64; 4],
    first: [f64; 3],
    second: [f64; 2],
}

impl Weights {
    #[inline]
    pub(super) fn at(t: f64) -> Self {
        let s = 1.0 - t;
        Self {
            value: [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
            first: [3.0 * s * s, 6.0 * s * t, 3.0 * t * t],
            second: [6.0 * s, 6.0 * t],
        }
    }

    /// The value of a cubic.
    #[inline]
    pub(super) fn value(&self, [a, b, c, d]: &[Homogeneous; 4]) -> Homogeneous {
        let by = &self.value;
        let at = |k: usize| a[k] * by[0] + b[k] * by[1] + c[k] * by[2] + d[k] * by[3];
        Homogeneous::new(at(0), at(1), at(2), at(3))
    }

    /// Its first derivative. Of differences, because coordinates may be far greater than these.
    #[inline]
    pub(super) fn first(&self, [a, b, c, d]: &[Homogeneous; 4]) -> Homogeneous {
        let by = &self.first;
        let at = |k: usize| (b[k] - a[k]) * by[0] + (c[k] - b[k]) * by[1] + (d[k] - c[k]) * by[2];
        Homogeneous::new(at(0), at(1), at(2), at(3))
    }

    /// Its second derivative.
    #[inline]
    pub(super) fn second(&self, [a, b, c, d]: &[Homogeneous; 4]) -> Homogeneous {
        let by = &self.second;
        let at = |k: usize| {
            let (low, middle, high) = (b[k] - a[k], c[k] - b[k], d[k] - c[k]);
            (middle - low) * by[0] + (high - middle) * by[1]
        };
        Homogeneous::new(at(0), at(1), at(2), at(3))
    }
}

/// Four control points of a cubic, and the value with two derivatives at `t`.
pub(super) fn cubic(control: &[Homogeneous; 4], t: f64) -> [Homogeneous; 3] {
    let weights = Weights::at(t);
    [weights.value(control), weights.first(control), weights.second(control)]
}

/// Both parts of a cubic cut at `t` (de Casteljau).
#[inline]
pub(super) fn cut(control: &[Homogeneous; 4], t: f64) -> [[Homogeneous; 4]; 2] {
    let between = |a: &Homogeneous, b: &Homogeneous| a + (b - a) * t;
    let [a, b, c, d] = control;
    let (ab, bc, cd) = (between(a, b), between(b, c), between(c, d));
    let (abc, bcd) = (between(&ab, &bc), between(&bc, &cd));
    let middle = between(&abc, &bcd);
    [[*a, ab, abc, middle], [middle, bcd, cd, *d]]
}

/// Control points of `P0 + P1 t + P2 t² + P3 t³`.
pub(super) fn from_power(c: &[Homogeneous; 4]) -> [Homogeneous; 4] {
    let third = 1.0 / 3.0;
    [c[0], c[0] + c[1] * third, c[0] + c[1] * (2.0 * third) + c[2] * third, c[0] + c[1] + c[2] + c[3]]
}

/// Control points of the cubic from `p` to `q` with the derivatives `dp` and `dq` there.
pub(super) fn from_hermite(
    p: &Homogeneous,
    q: &Homogeneous,
    dp: &Homogeneous,
    dq: &Homogeneous,
) -> [Homogeneous; 4] {
    [*p, p + dp / 3.0, q - dq / 3.0, *q]
}

/// Control points of one span of a uniform cubic B-spline.
pub(super) fn from_uniform(d: &[Homogeneous; 4]) -> [Homogeneous; 4] {
    [
        (d[0] + d[1] * 4.0 + d[2]) / 6.0,
        (d[1] * 2.0 + d[2]) / 3.0,
        (d[1] + d[2] * 2.0) / 3.0,
        (d[1] + d[2] * 4.0 + d[3]) / 6.0,
    ]
}

/// A place with weight 1.
pub(super) fn place(point: &Vec3) -> Homogeneous {
    Vector4::new(point.x, point.y, point.z, 1.0)
}

/// A direction: weight 0.
pub(super) fn direction(vector: &Vec3) -> Homogeneous {
    Vector4::new(vector.x, vector.y, vector.z, 0.0)
}

/// The quotient `A/w` of a homogeneous value.
#[inline]
pub(super) fn project(value: &Homogeneous) -> Vec3 {
    value.xyz() / value.w
}
