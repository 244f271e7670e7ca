//! The general quadric as a symmetric matrix of order four.

use nalgebra::{Matrix4, Vector4};

use super::{Matrix, Quadric};
use crate::Vec3;

impl Quadric {
    /// The symmetric matrix `S` with `(x,y,z,1) S (x,y,z,1)ᵀ = 0` on the surface.
    pub fn to_symmetric(&self) -> Matrix4<f64> {
        let [a, b, c, d, f, g, h, p, q, r] = self.coefficients;
        Matrix4::new(a, h, g, p, h, b, f, q, g, f, c, r, p, q, r, d)
    }

    /// The quadric of a symmetric matrix; only the upper triangle is read.
    pub fn from_symmetric(symmetric: &Matrix4<f64>) -> Quadric {
        let s = |row: usize, column: usize| symmetric[(row, column)];
        Quadric {
            coefficients: [
                s(0, 0),
                s(1, 1),
                s(2, 2),
                s(3, 3),
                s(1, 2),
                s(0, 2),
                s(0, 1),
                s(0, 3),
                s(1, 3),
                s(2, 3),
            ],
        }
    }

    /// A curve of the xy-plane as a cylinder parallel to z:
    /// `a x² + b y² + d + 2h xy + 2p x + 2q y = 0`.
    pub fn plane_conic(a: f64, b: f64, d: f64, h: f64, p: f64, q: f64) -> Quadric {
        Quadric { coefficients: [a, b, 0.0, d, 0.0, 0.0, h, p, q, 0.0] }
    }

    /// Value of the equation at `point`; its sign tells the side.
    pub fn value(&self, point: &Vec3) -> f64 {
        let place = Vector4::new(point.x, point.y, point.z, 1.0);
        place.dot(&(self.to_symmetric() * place))
    }

    /// Gradient of the equation at `point`.
    pub fn gradient(&self, point: &Vec3) -> Vec3 {
        let [a, b, c, _, f, g, h, p, q, r] = self.coefficients;
        2.0 * Vec3::new(
            a * point.x + h * point.y + g * point.z + p,
            h * point.x + b * point.y + f * point.z + q,
            g * point.x + f * point.y + c * point.z + r,
        )
    }

    /// Value of the equation and the greatest sum of the magnitudes of its terms, which tells how exact the value can
    /// be.
    pub fn value_with_size(&self, point: &Vec3) -> (f64, f64) {
        let magnitude = Quadric { coefficients: self.coefficients.map(f64::abs) };
        (self.value(point), magnitude.value(&point.abs()))
    }

    /// The quadric of the points `M x`, where `inverse` is the inverse of `M`.
    pub(super) fn under_inverse(&self, inverse: &Matrix) -> Quadric {
        let back = inverse.to_homogeneous();
        Quadric::from_symmetric(&(back.transpose() * self.to_symmetric() * back))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn value_and_gradient_follow_the_equation() {
        let quadric = Quadric { coefficients: [1.0, 2.0, 3.0, 10.0, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5] };
        let [x, y, z] = [0.5, -2.0, 3.0];
        let expected = x * x
            + 2.0 * y * y
            + 3.0 * z * z
            + 4.0 * y * z
            + 5.0 * x * z
            + 6.0 * x * y
            + 7.0 * x
            + 8.0 * y
            + 9.0 * z
            + 10.0;
        let point = Vec3::new(x, y, z);
        assert!((quadric.value(&point) - expected).abs() < 1e-12);
        let gradient = Vec3::new(
            2.0 * x + 5.0 * z + 6.0 * y + 7.0,
            4.0 * y + 4.0 * z + 6.0 * x + 8.0,
            6.0 * z + 4.0 * y + 5.0 * x + 9.0,
        );
        assert!((quadric.gradient(&point) - gradient).norm() < 1e-12);
        assert_eq!(Quadric::from_symmetric(&quadric.to_symmetric()), quadric);
    }
}
