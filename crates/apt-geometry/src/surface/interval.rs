//! Intervals of numbers: the result of an operation holds the results for all members of its operands. Rounding is not
//! counted; it is far below what the bounds made from them are used for.

use std::ops::{Add, Div, Mul, Neg, Sub};

use nalgebra::Vector3;

use crate::Vec3;

/// What curves and surfaces are computed with: plain numbers, or intervals of them.
pub(super) trait Number:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
}

impl Number for f64 {}
impl Number for Interval {}

/// All numbers between two, both included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Interval {
    /// From `middle − radius` to `middle + radius`.
    pub(super) fn about(middle: f64, radius: f64) -> Self {
        Self { low: middle - radius, high: middle + radius }
    }

    pub(super) fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }

    pub(super) fn radius(self) -> f64 {
        0.5 * (self.high - self.low)
    }

    /// Greatest absolute value.
    pub(super) fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }
}

impl From<f64> for Interval {
    fn from(x: f64) -> Self {
        Self { low: x, high: x }
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let [a, b, c, d] =
            [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        Self { low: a.min(b).min(c.min(d)), high: a.max(b).max(c.max(d)) }
    }
}

impl Div for Interval {
    type Output = Self;
    /// Everything, if the divisor may be zero.
    fn div(self, other: Self) -> Self {
        if other.low > 0.0 || other.high < 0.0 {
            self * Self { low: 1.0 / other.high, high: 1.0 / other.low }
        } else {
            Self { low: f64::NEG_INFINITY, high: f64::INFINITY }
        }
    }
}

/// Vectors whose coordinates are in intervals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Box3(pub(super) [Interval; 3]);

impl Box3 {
    pub(super) fn zero() -> Self {
        Self([Interval::from(0.0); 3])
    }

    pub(super) fn scaled(&self, k: f64) -> Self {
        Self(self.0.map(|x| x * Interval::from(k)))
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    pub(super) fn dot(&self, v: &Vec3) -> Interval {
        let [x, y, z] = [0, 1, 2].map(|i| self.0[i] * Interval::from(v[i]));
        x + y + z
    }

    /// Greatest distance of one of them from another vector.
    pub(super) fn farthest(&self, from: &Vec3) -> f64 {
        let far = |i: usize| (self.0[i] - Interval::from(from[i])).magnitude();
        Vector3::new(far(0), far(1), far(2)).norm()
    }

    /// No vector has a longer part across a unit direction.
    pub(super) fn across(&self, along: &Vec3) -> f64 {
        let middle = Vec3::from(self.0.map(Interval::middle));
        let beside = Vec3::from(self.0.map(Interval::radius));
        (middle - along * middle.dot(along)).norm() + beside.norm()
    }

    /// Greatest length.
    pub(super) fn length(&self) -> f64 {
        Vector3::from(self.0.map(Interval::magnitude)).norm()
    }
}

/// Values, first and second derivatives of `Σ aₖ xᵏ` for all |x| up to `half`: middle and radius of each.
pub(super) fn taylor_ranges<const N: usize>(coefficients: &[f64; N], half: f64) -> [Interval; 3] {
    let mut radii = [0.0; 3];
    for k in (1..N).rev() {
        let a = coefficients[k].abs();
        let order = k as f64;
        // Horner's rule for Σ aₖ xᵏ⁻¹ and for the higher terms of the derivatives.
        radii[0] = radii[0] * half + a;
        if k > 1 {
            radii[1] = radii[1] * half + order * a;
        }
        if k > 2 {
            radii[2] = radii[2] * half + order * (order - 1.0) * a;
        }
    }
    let coefficient = |k: usize| coefficients.get(k).copied().unwrap_or(0.0);
    [
        Interval::about(coefficient(0), radii[0] * half),
        Interval::about(coefficient(1), radii[1] * half),
        Interval::about(2.0 * coefficient(2), radii[2] * half),
    ]
}

/// The coefficients of the same polynomial about another place: `Σ cₖ (x₀ + y)ᵏ = Σ aₖ yᵏ`.
pub(super) fn shifted<const N: usize>(coefficients: &[f64; N], place: f64) -> [f64; N] {
    let mut shifted = *coefficients;
    for first in 0..N {
        for k in (first..N.saturating_sub(1)).rev() {
            shifted[k] += place * shifted[k + 1];
        }
    }
    shifted
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        #[test]
        fn results_hold_those_of_the_members(
            a in (-3.0..3.0f64, 0.0..2.0f64), b in (-3.0..3.0f64, 0.0..2.0f64), x in -1.0..1.0f64, y in -1.0..1.0f64,
        ) {
            let (p, q) = (Interval::about(a.0, a.1), Interval::about(b.0, b.1));
            let (x, y) = (a.0 + x * a.1, b.0 + y * b.1);
            let holds = |i: Interval, value: f64| i.low <= value + 1e-9 && value <= i.high + 1e-9;
            prop_assert!(holds(p + q, x + y) && holds(p - q, x - y) && holds(p * q, x * y));
            prop_assert!(y == 0.0 || holds(p / q, x / y));
        }

        #[test]
        fn shifted_polynomials_stay_in_their_ranges(
            c in prop::array::uniform6(-2.0..2.0f64), place in -2.0..2.0f64, half in 0.0..0.5f64, share in -1.0..1.0f64,
        ) {
            let about = shifted(&c, place);
            let [value, first, second] = taylor_ranges(&about, half);
            let x = place + share * half;
            let horner = |c: &[f64]| c.iter().rev().fold(0.0, |sum, k| sum * x + k);
            let derived = |c: &[f64]| -> Vec<f64> { c.iter().enumerate().skip(1).map(|(k, a)| k as f64 * a).collect() };
            let (d, dd) = (derived(&c), derived(&derived(&c)));
            for (range, exact) in [(value, horner(&c)), (first, horner(&d)), (second, horner(&dd))] {
                prop_assert!(range.low <= exact + 1e-9 && exact <= range.high + 1e-9, "{range:?} {exact}");
            }
        }
    }
}
