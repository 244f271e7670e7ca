//! One rational cubic arc of a curve.

use serde::{Deserialize, Serialize};

use super::basis::{self, Homogeneous};
use crate::{Vec3, canonical::Matrix};

/// A rational cubic in Bézier form, with the parameter 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CurveArc {
    /// Control points `(wx, wy, wz, w)` with positive weights.
    pub control: [Homogeneous; 4],
}

/// A place of an arc with its derivatives by the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArcPoint {
    /// The place.
    pub position: Vec3,
    /// First derivative.
    pub first: Vec3,
    /// Second derivative.
    pub second: Vec3,
}

impl CurveArc {
    /// The cubic `P0 + P1 t + P2 t² + P3 t³`.
    pub fn from_power(coefficients: &[Vec3; 4]) -> CurveArc {
        let [value, rest @ ..] = coefficients;
        let [a, b, c] = rest.map(|vector| basis::direction(&vector));
        CurveArc { control: basis::from_power(&[basis::place(value), a, b, c]) }
    }

    /// The cubic from `p` to `q` with the derivatives `dp` and `dq` there.
    pub fn from_hermite(p: &Vec3, q: &Vec3, dp: &Vec3, dq: &Vec3) -> CurveArc {
        let control = basis::from_hermite(
            &basis::place(p),
            &basis::place(q),
            &basis::direction(dp),
            &basis::direction(dq),
        );
        CurveArc { control }
    }

    /// The straight arc from `p` to `q`, at an even pace.
    pub fn segment(p: &Vec3, q: &Vec3) -> CurveArc {
        CurveArc::from_hermite(p, q, &(q - p), &(q - p))
    }

    /// The conic arc with three control points and their weights, raised to a cubic. A circle of angle 2φ has the weights
    /// 1, cos φ and 1.
    pub fn conic(p: &Vec3, middle: &Vec3, weights: [f64; 3], q: &Vec3) -> CurveArc {
        let [first, middle, last] = [(p, weights[0]), (middle, weights[1]), (q, weights[2])]
            .map(|(at, weight)| basis::place(at) * weight);
        CurveArc { control: [first, (first + middle * 2.0) / 3.0, (middle * 2.0 + last) / 3.0, last] }
    }

    /// The place at `t` and its derivatives.
    pub fn evaluate(&self, t: f64) -> ArcPoint {
        let [value, first, second] = basis::cubic(&self.control, t);
        let position = basis::project(&value);
        let du = (first.xyz() - position * first.w) / value.w;
        let duu = (second.xyz() - du * (2.0 * first.w) - position * second.w) / value.w;
        ArcPoint { position, first: du, second: duu }
    }

    /// The parts before and after `t`.
    pub fn cut(&self, t: f64) -> [CurveArc; 2] {
        basis::cut(&self.control, t).map(|control| CurveArc { control })
    }

    /// The part between two parameters.
    pub fn between(&self, from: f64, to: f64) -> CurveArc {
        let [before, _] = self.cut(to);
        if from <= 0.0 || to <= 0.0 {
            return before;
        }
        let [_, part] = before.cut(from / to);
        part
    }

    /// The arc moved by a vector.
    pub fn shifted(&self, by: &Vec3) -> CurveArc {
        CurveArc { control: self.control.map(|point| point + basis::direction(&(by * point.w))) }
    }

    /// The arc that runs the other way.
    pub fn reversed(&self) -> CurveArc {
        let [a, b, c, d] = self.control;
        CurveArc { control: [d, c, b, a] }
    }

    /// The image under an affine map.
    pub fn transformed(&self, matrix: &Matrix) -> CurveArc {
        let map = matrix.to_homogeneous();
        CurveArc { control: self.control.map(|point| map * point) }
    }

    /// The control points as places.
    pub fn points(&self) -> [Vec3; 4] {
        self.control.map(|point| basis::project(&point))
    }

    /// Whether all weights are the same, so that the arc is a polynomial.
    pub fn is_polynomial(&self) -> bool {
        let weight = self.control[0].w;
        self.control.iter().all(|point| (point.w - weight).abs() <= f64::EPSILON * weight.abs())
    }
}
