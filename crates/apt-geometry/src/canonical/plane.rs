//! Planes and lines.

use super::Plane;
use crate::Vec3;

impl Plane {
    /// The plane `a x + b y + c z = d` with the equation divided by the length of its normal; `None` when the normal
    /// has no length.
    pub fn from_equation(a: f64, b: f64, c: f64, d: f64) -> Option<Plane> {
        let normal = Vec3::new(a, b, c);
        let length = normal.norm();
        (length > 0.0 && length.is_finite()).then(|| Plane { normal: normal / length, distance: d / length })
    }

    /// The plane through `point` whose normal has the direction of `normal`; `None` when that has no length.
    pub fn through(point: Vec3, normal: Vec3) -> Option<Plane> {
        let normal = normal.try_normalize(0.0)?;
        Some(Plane { normal, distance: normal.dot(&point) })
    }

    /// The xy-plane, which supplies z as long as there is no ZSURF.
    pub fn horizontal() -> Plane {
        Plane { normal: Vec3::z(), distance: 0.0 }
    }

    /// Signed distance of `point` from the plane, positive on the side to which the normal points.
    pub fn signed_distance(&self, point: &Vec3) -> f64 {
        self.normal.dot(point) - self.distance
    }

    /// The foot of the perpendicular from `point`.
    pub fn project(&self, point: &Vec3) -> Vec3 {
        point - self.normal * self.signed_distance(point)
    }

    /// The same plane with the opposite normal.
    pub fn reversed(&self) -> Plane {
        Plane { normal: -self.normal, distance: -self.distance }
    }

    /// z of the plane over (x, y); `None` when the plane is parallel to z.
    pub fn z_over(&self, x: f64, y: f64) -> Option<f64> {
        let z = (self.distance - self.normal.x * x - self.normal.y * y) / self.normal.z;
        z.is_finite().then_some(z)
    }

    /// Direction of a line in the xy-plane: its normal turned clockwise by 90 degrees.
    pub fn line_direction(&self) -> Vec3 {
        Vec3::new(self.normal.y, -self.normal.x, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_have_the_sign_of_the_normal_side() {
        let plane = Plane::from_equation(0.0, 0.0, 2.0, 3.0).expect("a normal");
        assert_eq!(plane.distance, 1.5);
        assert_eq!(plane.signed_distance(&Vec3::new(7.0, 8.0, 2.5)), 1.0);
        assert_eq!(plane.reversed().signed_distance(&Vec3::new(7.0, 8.0, 2.5)), -1.0);
        assert_eq!(plane.project(&Vec3::new(7.0, 8.0, 2.5)), Vec3::new(7.0, 8.0, 1.5));
        assert_eq!(plane.z_over(4.0, 5.0), Some(1.5));
    }

    #[test]
    fn a_plane_needs_a_normal_and_z_needs_a_slope() {
        assert_eq!(Plane::from_equation(0.0, 0.0, 0.0, 3.0), None);
        assert_eq!(Plane::through(Vec3::x(), Vec3::zeros()), None);
        assert_eq!(Plane { normal: Vec3::x(), distance: 1.0 }.z_over(0.0, 0.0), None);
    }
}
