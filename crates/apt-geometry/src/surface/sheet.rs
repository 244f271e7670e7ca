//! Parametric surfaces near a point: natural normal, nearest point and curvature of the parallel surface from partial
//! derivatives. Ruled, polyconic and sculptured surfaces share it.

use nalgebra::Matrix3;

use super::{Foot, perpendicular};
use crate::Vec3;

/// Sine of the angle between the partial derivatives, or their length relative to the surface, below which they span no
/// tangent plane.
const SINGULAR: f64 = 1e-10;
/// Distance, relative to the size of a surface, below which a point lies on it.
pub(super) const ON_SURFACE: f64 = 1e-9;
/// Cosine between the way to an edge and the normal there, below one, at which a point is over the surface.
const OVER_EDGE: f64 = 1e-9;
/// Stretch `1 + d·κ` of the parallel surface below which it is at its focus and has no curvature.
const FOCUS: f64 = 1e-12;

/// A place of a parametric surface with its partial derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jet {
    pub(super) point: Vec3,
    pub(super) du: Vec3,
    pub(super) dv: Vec3,
    pub(super) duu: Vec3,
    pub(super) duv: Vec3,
    pub(super) dvv: Vec3,
}

/// Where on the parameter rectangle the nearest place lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rest {
    /// Inside: the offset is along the normal.
    Inside,
    /// On an edge along which v runs (u is at its limit).
    AlongV,
    /// On an edge along which u runs (v is at its limit).
    AlongU,
    /// In a corner.
    Corner,
}

/// Which limits of its parameters a place is at, but for rounding: low and high of the first, low and high of the second.
pub(super) fn at_limits(at: [f64; 2], limits: [[f64; 2]; 2]) -> [bool; 4] {
    let near = |k: usize, limit: f64| (at[k] - limit).abs() <= ON_SURFACE * (limits[k][1] - limits[k][0]);
    [near(0, limits[0][0]), near(0, limits[0][1]), near(1, limits[1][0]), near(1, limits[1][1])]
}

/// The nearest place to a point: its foot, the surface there and where on the rectangle that is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Landing {
    pub(super) foot: Foot,
    pub(super) jet: Jet,
    pub(super) rest: Rest,
}

impl Landing {
    /// The foot, with the second derivatives of the signed distance at the point.
    pub(super) fn with_hessian(self) -> (Foot, Matrix3<f64>) {
        (self.foot, self.jet.hessian(&self.foot, self.rest))
    }
}

impl Jet {
    /// The unit natural normal, `du × dv`; `None` where the partial derivatives span no plane.
    pub(super) fn natural(&self, size: f64) -> Option<Vec3> {
        let (a, b) = (self.du.norm(), self.dv.norm());
        if a <= SINGULAR * size || b <= SINGULAR * size {
            return None;
        }
        let normal = self.du.cross(&self.dv) / (a * b);
        let sine = normal.norm();
        (sine > SINGULAR).then(|| normal / sine)
    }

    /// The foot of `p` if this is its nearest place; `natural` is the natural normal here, `size` that of the surface. Beyond an edge
    /// the distance has the sign of `beyond`, else that of the tangent plane.
    pub(super) fn foot(
        &self,
        p: &Vec3,
        rest: Rest,
        (natural, beyond): (&Vec3, Option<f64>),
        size: f64,
    ) -> Foot {
        let offset = p - self.point;
        let height = offset.dot(natural);
        let length = offset.norm();
        // Beyond an edge the nearest point stays on it while the normal turns, as at a corner of a curve.
        if rest == Rest::Inside || length <= ON_SURFACE * size || height.abs() >= length * (1.0 - OVER_EDGE) {
            return Foot { distance: height, point: p - natural * height, normal: *natural };
        }
        let distance = length.copysign(beyond.unwrap_or(height));
        Foot { distance, point: self.point, normal: offset / distance }
    }

    /// Second derivatives of the signed distance at the point whose foot this is. Just over an edge they are those that it has on the side of
    /// the surface: on the other side the normal turns at once.
    pub(super) fn hessian(&self, foot: &Foot, rest: Rest) -> Matrix3<f64> {
        let d = foot.distance;
        let natural = self.du.cross(&self.dv);
        let aside = foot.normal.cross(&natural).norm_squared();
        if rest != Rest::Inside
            && natural != Vec3::zeros()
            && aside <= 2.0 * OVER_EDGE * natural.norm_squared()
        {
            return self.parallel(&foot.normal, d);
        }
        let across = |n: &Vec3| Matrix3::identity() - n * n.transpose();
        let (tangent, bent) = match rest {
            Rest::Inside => return self.parallel(&foot.normal, d),
            Rest::AlongV => (self.dv, self.dvv),
            Rest::AlongU => (self.du, self.duu),
            Rest::Corner => return across(&foot.normal) / away_from_zero(d),
        };
        let speed = tangent.norm();
        if speed <= 0.0 {
            return across(&foot.normal) / away_from_zero(d);
        }
        let t = tangent / speed;
        let b = foot.normal.cross(&t);
        let curvature = -bent.dot(&foot.normal) / (speed * speed);
        let stretch = 1.0 + d * curvature;
        let along = if stretch.abs() > FOCUS { curvature / stretch } else { 0.0 };
        t * t.transpose() * along + b * b.transpose() / away_from_zero(d)
    }

    /// The shape operator of the parallel surface at a distance: `W (1 + d W)⁻¹` in the tangent plane.
    fn parallel(&self, normal: &Vec3, d: f64) -> Matrix3<f64> {
        let (x, y) = {
            let x = self.du.try_normalize(0.0).unwrap_or_else(|| perpendicular(normal));
            (x, normal.cross(&x))
        };
        // Rows of the inverse of the Jacobian in the frame (x, y): du = a·x, dv = b·x + c·y.
        let (a, b, c) = (self.du.dot(&x), self.dv.dot(&x), self.dv.dot(&y));
        if a.abs() <= 0.0 || c.abs() <= 0.0 {
            return Matrix3::zeros();
        }
        let (l, m, n) = (self.duu.dot(normal), self.duv.dot(normal), self.dvv.dot(normal));
        // Second fundamental form in the frame, turned so that it is positive where the surface curves away.
        let xx = -l / (a * a);
        let xy = -(m - l * b / a) / (a * c);
        let yy = -(n - 2.0 * m * b / a + l * b * b / (a * a)) / (c * c);
        let determinant = (1.0 + d * xx) * (1.0 + d * yy) - d * d * xy * xy;
        if determinant.abs() <= FOCUS {
            return Matrix3::zeros();
        }
        let gauss = xx * yy - xy * xy;
        let (p, q, r) = ((xx + d * gauss) / determinant, xy / determinant, (yy + d * gauss) / determinant);
        x * x.transpose() * p + (x * y.transpose() + y * x.transpose()) * q + y * y.transpose() * r
    }

    /// Principal curvatures' greatest absolute value at this place, in 1/length.
    pub(super) fn greatest_curvature(&self, normal: &Vec3) -> f64 {
        let shape = self.parallel(normal, 0.0);
        shape.symmetric_eigenvalues().amax()
    }
}

/// A distance to divide by, kept from zero.
fn away_from_zero(d: f64) -> f64 {
    if d.abs() < f64::MIN_POSITIVE { f64::MIN_POSITIVE } else { d }
}
