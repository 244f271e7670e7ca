//! Circles, cylinders, spheres and cones.

use super::{Cone, Cylinder, Sphere};
use crate::Vec3;

impl Cylinder {
    /// A circle in the xy-plane: z of the centre is dropped, as every definition but CANON does.
    pub fn circle(x: f64, y: f64, radius: f64) -> Cylinder {
        Cylinder { point: Vec3::new(x, y, 0.0), axis: Vec3::z(), radius }
    }

    /// Distance of `point` from the axis.
    pub fn axis_distance(&self, point: &Vec3) -> f64 {
        let from_axis = point - self.point;
        (from_axis - self.axis * self.axis.dot(&from_axis)).norm()
    }

    /// Signed distance of `point` from the surface, negative inside.
    pub fn signed_distance(&self, point: &Vec3) -> f64 {
        self.axis_distance(point) - self.radius
    }
}

impl Sphere {
    /// Signed distance of `point` from the surface, negative inside.
    pub fn signed_distance(&self, point: &Vec3) -> f64 {
        (point - self.center).norm() - self.radius
    }
}

impl Cone {
    /// Sine of the half angle.
    pub fn sine(&self) -> f64 {
        ((1.0 - self.cosine) * (1.0 + self.cosine)).max(0.0).sqrt()
    }
}
