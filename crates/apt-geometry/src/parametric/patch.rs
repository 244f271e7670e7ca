//! One rational bicubic patch.

use serde::{Deserialize, Serialize};

use super::{
    arc::CurveArc,
    basis::{self, Homogeneous, Weights},
    topology::Edge,
};
use crate::{Vec3, canonical::Matrix};

/// Length of a cross product, as a share of the lengths of its factors, below which a patch has no normal there.
const DEGENERATE: f64 = 1e-9;
/// Step towards the middle of a patch where the normal has no limit of first or second order.
const INWARD_STEP: f64 = 1e-4;

/// A rational bicubic patch in Bézier form, with parameters 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Patch {
    /// Control points `(wx, wy, wz, w)` with positive weights: `control[i][j]`, `i` along u, `j` along v.
    pub control: [[Homogeneous; 4]; 4],
}

/// A place of a patch with its derivatives by the parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchPoint {
    /// The place.
    pub position: Vec3,
    /// Derivative by u.
    pub du: Vec3,
    /// Derivative by v.
    pub dv: Vec3,
    /// Second derivative by u.
    pub duu: Vec3,
    /// Mixed derivative.
    pub duv: Vec3,
    /// Second derivative by v.
    pub dvv: Vec3,
}

/// The normal of a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchNormal {
    /// Unit vector along `∂u × ∂v`, or its limit from inside; zero only where a patch has no area about the place.
    pub direction: Vec3,
    /// Whether the derivatives themselves give it.
    pub regular: bool,
}

impl Patch {
    /// A patch of control points with weight 1: `points[i][j]`, `i` along u, `j` along v.
    pub fn from_points(points: &[[Vec3; 4]; 4]) -> Patch {
        Patch { control: points.map(|row| row.map(|point| basis::place(&point))) }
    }

    /// The patch `Σ c[i][j] uⁱ vʲ`.
    pub fn from_power(coefficients: &[[Vec3; 4]; 4]) -> Patch {
        let mut rows = coefficients.map(|row| row.map(|vector| basis::direction(&vector)));
        rows[0][0].w = 1.0;
        Patch { control: both_ways(&rows, basis::from_power) }
    }

    /// The patch with the corner data of Ferguson and Coons: `corners[i][j]` is the place at u = i, v = j with its
    /// derivatives by u, by v and by both.
    pub fn from_hermite(corners: &[[[Vec3; 4]; 2]; 2]) -> Patch {
        let along_v = |i: usize, derivative: usize| {
            let data = |j: usize, kind: usize| {
                let vector = corners[i][j][kind];
                if kind == 0 { basis::place(&vector) } else { basis::direction(&vector) }
            };
            basis::from_hermite(
                &data(0, derivative),
                &data(1, derivative),
                &data(0, derivative + 2),
                &data(1, derivative + 2),
            )
        };
        let (p, q, dp, dq) = (along_v(0, 0), along_v(1, 0), along_v(0, 1), along_v(1, 1));
        let columns: [[Homogeneous; 4]; 4] =
            std::array::from_fn(|j| basis::from_hermite(&p[j], &q[j], &dp[j], &dq[j]));
        Patch { control: transposed(&columns) }
    }

    /// One span of a uniform bicubic B-spline with the control points `points[i][j]`.
    pub fn from_uniform(points: &[[Vec3; 4]; 4]) -> Patch {
        let rows = points.map(|row| row.map(|point| basis::place(&point)));
        Patch { control: both_ways(&rows, basis::from_uniform) }
    }

    /// The patch of straight rulings from one arc (v = 0) to another one of the same weights (v = 1).
    pub fn between(first: &CurveArc, last: &CurveArc) -> Patch {
        Patch {
            control: std::array::from_fn(|i| {
                let (a, b) = (first.control[i], last.control[i]);
                [a, (a * 2.0 + b) / 3.0, (a + b * 2.0) / 3.0, b]
            }),
        }
    }

    /// The control points along v of the curve at a value of u.
    pub fn at_u(&self, u: f64) -> [Homogeneous; 4] {
        let columns = transposed(&self.control);
        columns.map(|column| basis::cubic(&column, u)[0])
    }

    /// The edge of a number as an arc that runs with the parameter that varies.
    pub fn edge(&self, edge: Edge) -> CurveArc {
        let control = match edge {
            Edge::LowU => self.control[0],
            Edge::HighU => self.control[3],
            Edge::LowV => self.control.map(|row| row[0]),
            Edge::HighV => self.control.map(|row| row[3]),
        };
        CurveArc { control }
    }

    /// The place at (u, v) and its derivatives.
    pub fn evaluate(&self, u: f64, v: f64) -> PatchPoint {
        let (by_u, by_v) = (Weights::at(u), Weights::at(v));
        // Rows one by one: mapped arrays are not taken apart by the compiler.
        let [one, two, three, four] = &self.control;
        let value = [by_v.value(one), by_v.value(two), by_v.value(three), by_v.value(four)];
        let first = [by_v.first(one), by_v.first(two), by_v.first(three), by_v.first(four)];
        let second = [by_v.second(one), by_v.second(two), by_v.second(three), by_v.second(four)];
        let (a, au, auu) = (by_u.value(&value), by_u.first(&value), by_u.second(&value));
        let (av, auv, avv) = (by_u.value(&first), by_u.first(&first), by_u.value(&second));
        let w = a.w;
        let position = a.xyz() / w;
        let du = (au.xyz() - position * au.w) / w;
        let dv = (av.xyz() - position * av.w) / w;
        let duu = (auu.xyz() - du * (2.0 * au.w) - position * auu.w) / w;
        let duv = (auv.xyz() - dv * au.w - du * av.w - position * auv.w) / w;
        let dvv = (avv.xyz() - dv * (2.0 * av.w) - position * avv.w) / w;
        PatchPoint { position, du, dv, duu, duv, dvv }
    }

    /// The unit normal along `∂u × ∂v`; where that vanishes its limit from inside the patch. No side is applied.
    pub fn normal(&self, u: f64, v: f64) -> PatchNormal {
        let at = self.evaluate(u, v);
        if let Some(direction) = at.regular_normal() {
            return PatchNormal { direction, regular: true };
        }
        // Towards the inside: along u or v away from the near edge.
        let (inward_u, inward_v) = (if u > 0.5 { -1.0 } else { 1.0 }, if v > 0.5 { -1.0 } else { 1.0 });
        let size = self.size();
        let limit = |du: Vec3, dv: Vec3| {
            let normal = du.cross(&dv);
            (normal.norm() > DEGENERATE * size * size).then(|| normal.normalize())
        };
        let small = |vector: &Vec3| vector.norm() <= DEGENERATE * size;
        let of_first_order = if small(&at.du) && !small(&at.dv) {
            limit(at.duv * inward_v, at.dv)
        } else if small(&at.dv) && !small(&at.du) {
            limit(at.du, at.duv * inward_u)
        } else {
            None
        };
        if let Some(direction) = of_first_order {
            return PatchNormal { direction, regular: false };
        }
        let mut step = INWARD_STEP;
        // Ten times as far each time: a patch that is flat to this order over its half has no area.
        while step < 0.5 {
            let inside = self.evaluate(u + (0.5 - u) * step, v + (0.5 - v) * step);
            if let Some(direction) = inside.regular_normal() {
                return PatchNormal { direction, regular: false };
            }
            step *= 10.0;
        }
        PatchNormal { direction: Vec3::zeros(), regular: false }
    }

    /// The unit tangents along u and along v; on an edge that is one point, along which a parameter leads nowhere, their limit from inside (first
    /// order). Null where there is none.
    pub fn tangents(&self, u: f64, v: f64) -> [Vec3; 2] {
        let at = self.evaluate(u, v);
        let least = DEGENERATE * self.size();
        let inward = |t: f64| if t > 0.5 { -1.0 } else { 1.0 };
        let unit = |tangent: Vec3, inside: Vec3| {
            tangent.try_normalize(least).or_else(|| inside.try_normalize(least)).unwrap_or_else(Vec3::zeros)
        };
        [unit(at.du, at.duv * inward(v)), unit(at.dv, at.duv * inward(u))]
    }

    /// The place at (u, v), which may lie outside of 0 to 1: there along the tangent plane of the nearest place of the
    /// patch (first order), for the search of contacts only.
    pub fn extended(&self, u: f64, v: f64) -> PatchPoint {
        let (inside_u, inside_v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        let at = self.evaluate(inside_u, inside_v);
        let (over_u, over_v) = (u - inside_u, v - inside_v);
        if over_u == 0.0 && over_v == 0.0 {
            return at;
        }
        PatchPoint {
            position: at.position + at.du * over_u + at.dv * over_v + at.duv * (over_u * over_v),
            du: at.du + at.duv * over_v,
            dv: at.dv + at.duv * over_u,
            duu: if over_u == 0.0 { at.duu } else { Vec3::zeros() },
            duv: at.duv,
            dvv: if over_v == 0.0 { at.dvv } else { Vec3::zeros() },
        }
    }

    /// The halves below and above u = ½.
    #[inline]
    pub fn halved_u(&self) -> [Patch; 2] {
        self.cut_u(0.5)
    }

    /// The halves below and above v = ½.
    #[inline]
    pub fn halved_v(&self) -> [Patch; 2] {
        self.cut_v(0.5)
    }

    /// The parts below and above a value of u.
    #[inline]
    pub fn cut_u(&self, u: f64) -> [Patch; 2] {
        let mut parts = [*self; 2];
        let [first, second] = &mut parts;
        for j in 0..4 {
            let [low, high] = basis::cut(&[0, 1, 2, 3].map(|i| self.control[i][j]), u);
            for i in 0..4 {
                (first.control[i][j], second.control[i][j]) = (low[i], high[i]);
            }
        }
        parts
    }

    /// The parts below and above a value of v.
    #[inline]
    pub fn cut_v(&self, v: f64) -> [Patch; 2] {
        let mut parts = [*self; 2];
        let [first, second] = &mut parts;
        for (i, row) in self.control.iter().enumerate() {
            [first.control[i], second.control[i]] = basis::cut(row, v);
        }
        parts
    }

    /// The patch with u and v exchanged, which turns its normal over.
    pub fn swapped(&self) -> Patch {
        Patch { control: transposed(&self.control) }
    }

    /// The image under an affine map.
    pub fn transformed(&self, matrix: &Matrix) -> Patch {
        let map = matrix.to_homogeneous();
        Patch { control: self.control.map(|row| row.map(|point| map * point)) }
    }

    /// The control points as places.
    #[inline]
    pub fn points(&self) -> [[Vec3; 4]; 4] {
        let mut points = [[Vec3::zeros(); 4]; 4];
        for (row, control) in points.iter_mut().zip(&self.control) {
            for (point, value) in row.iter_mut().zip(control) {
                *point = basis::project(value);
            }
        }
        points
    }

    /// Whether all weights are the same, so that the patch is a polynomial.
    pub fn is_polynomial(&self) -> bool {
        let weight = self.control[0][0].w;
        self.control.iter().flatten().all(|point| (point.w - weight).abs() <= f64::EPSILON * weight.abs())
    }

    /// Greatest distance of a control point from the first one.
    pub fn size(&self) -> f64 {
        let points = self.points();
        let first = points[0][0];
        points.iter().flatten().map(|point| (point - first).norm()).fold(0.0, f64::max)
    }
}

impl PatchPoint {
    /// The unit vector along `∂u × ∂v`, if these are not parallel or zero.
    pub fn regular_normal(&self) -> Option<Vec3> {
        let normal = self.du.cross(&self.dv);
        let (length, size) = (normal.norm(), self.du.norm() * self.dv.norm());
        let longer = self.du.norm().max(self.dv.norm());
        let collapsed = self.du.norm().min(self.dv.norm()) <= DEGENERATE * longer;
        (!collapsed && length > DEGENERATE * size && length.is_finite()).then(|| normal / length)
    }
}

fn transposed(control: &[[Homogeneous; 4]; 4]) -> [[Homogeneous; 4]; 4] {
    std::array::from_fn(|i| std::array::from_fn(|j| control[j][i]))
}

/// A conversion of four points applied along v and then along u.
fn both_ways(
    rows: &[[Homogeneous; 4]; 4],
    convert: fn(&[Homogeneous; 4]) -> [Homogeneous; 4],
) -> [[Homogeneous; 4]; 4] {
    transposed(&transposed(&rows.map(|row| convert(&row))).map(|column| convert(&column)))
}
