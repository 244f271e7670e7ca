//! One nappe of a circular cone.

use nalgebra::Matrix3;

use super::{Foot, NoNormal, ON_AXIS, all_finite, perpendicular, unit};
use crate::{Vec3, canonical::Cone};

/// A cone with sine and cosine of its half angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConeForm {
    /// Vertex.
    pub vertex: Vec3,
    /// Unit axis from the vertex into the solid.
    pub axis: Vec3,
    /// Cosine of the half angle, in (0, 1).
    pub cosine: f64,
    /// Sine of the half angle, in (0, 1).
    pub sine: f64,
}

/// A point relative to a cone: along and across its axis, and the unit radial direction.
struct Section {
    along: f64,
    across: f64,
    radial: Vec3,
}

impl ConeForm {
    pub(super) fn new(cone: &Cone) -> Option<Self> {
        let axis = unit(&cone.axis)?;
        let cosine = cone.cosine.abs();
        if !(all_finite(&cone.vertex) && cosine > 0.0 && cosine < 1.0) {
            return None;
        }
        Some(Self { vertex: cone.vertex, axis, cosine, sine: (1.0 - cosine * cosine).sqrt() })
    }

    fn section(&self, p: &Vec3) -> Section {
        let w = p - self.vertex;
        let along = w.dot(&self.axis);
        let radial = w - self.axis * along;
        let across = radial.norm();
        let radial = if across > 0.0 { radial / across } else { perpendicular(&self.axis) };
        Section { along, across, radial }
    }

    pub(super) fn foot(&self, p: &Vec3) -> Foot {
        let s = self.section(p);
        let generator = s.across * self.sine + s.along * self.cosine;
        if generator <= 0.0 {
            let w = p - self.vertex;
            let distance = w.norm();
            let normal = if distance > 0.0 { w / distance } else { -self.axis };
            return Foot { distance, point: self.vertex, normal };
        }
        let distance = s.across * self.cosine - s.along * self.sine;
        let normal = s.radial * self.cosine - self.axis * self.sine;
        let point = self.vertex + (self.axis * self.cosine + s.radial * self.sine) * generator;
        Foot { distance, point, normal }
    }

    pub(super) fn foot_and_hessian(&self, p: &Vec3) -> (Foot, Matrix3<f64>) {
        let foot = self.foot(p);
        let s = self.section(p);
        if s.across * self.sine + s.along * self.cosine <= 0.0 {
            let distance = foot.distance.max(f64::MIN_POSITIVE);
            return (foot, (Matrix3::identity() - foot.normal * foot.normal.transpose()) / distance);
        }
        let around = self.axis.cross(&s.radial);
        (foot, around * around.transpose() * (self.cosine / s.across.max(f64::MIN_POSITIVE)))
    }

    /// UNCON: `(cos α · U − cos(α−θ) · T) / sin θ`, which is `−sin α T + cos α E`.
    pub(super) fn natural_normal(&self, p: &Vec3) -> Result<Vec3, NoNormal> {
        let s = self.section(p);
        let size = s.along.abs() + s.across;
        if s.across <= ON_AXIS * (1.0 + size) || s.across * self.sine + s.along * self.cosine < 0.0 {
            return Err(NoNormal);
        }
        Ok(s.radial * self.cosine - self.axis * self.sine)
    }
}
