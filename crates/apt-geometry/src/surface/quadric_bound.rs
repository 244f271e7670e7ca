//! Quadratic functions below the squared distance from a quadric: one of them bounds the distance of a whole circle or
//! patch from below, without a nearest point for each place.
//!
//! For any multiplier `λ ≥ 0` the squared distance of x from the set `side · F ≤ 0` is at least
//! `min |x − y|² + λ · side · F(y)` over all y. Where every `1 + λ · side · aᵢ` is positive that minimum exists and is λ
//! times a quadratic function of x. With the multiplier of a nearest point it touches the squared distance there, and
//! as a tangent of a square it stays close to it around.

use std::borrow::Cow;

use nalgebra::Matrix3;

use super::{ConeForm, PrincipalQuadric, Surface, perpendicular};
use crate::{Vec3, canonical::Cylinder};

/// A quadratic function `Σ (mᵢ yᵢ² + 2 lᵢ yᵢ) + k` in the principal coordinates of a quadric.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadraticFunction {
    /// Coefficients of the squares.
    pub square: Vec3,
    /// Halves of the linear coefficients.
    pub linear: Vec3,
    /// The constant.
    pub constant: f64,
}

/// The stationary point of `|x − y|² + λ F(y)` for a place x and a multiplier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stationary {
    /// The point, in principal coordinates.
    pub point: Vec3,
    /// Half the gradient of F there.
    pub gradient: Vec3,
    /// F there: zero where the point is a foot of x on the surface.
    pub value: f64,
    /// `1/(1 + λ aᵢ)`: all positive where the foot is the nearest one.
    pub stretch: Vec3,
    /// Size of the terms that F is the sum of: what its rounding is measured against.
    pub terms: f64,
}

impl QuadraticFunction {
    /// The value at a point.
    pub fn at(&self, y: &Vec3) -> f64 {
        (0..3).map(|i| (self.square[i] * y[i] + 2.0 * self.linear[i]) * y[i]).sum::<f64>() + self.constant
    }

    /// Half the gradient at a point.
    pub fn half_gradient(&self, y: &Vec3) -> Vec3 {
        self.square.component_mul(y) + self.linear
    }

    /// The bilinear form of the squares.
    pub fn form(&self, v: &Vec3, w: &Vec3) -> f64 {
        self.square.component_mul(v).dot(w)
    }
}

impl PrincipalQuadric {
    /// A point in principal coordinates.
    pub fn to_principal(&self, p: &Vec3) -> Vec3 {
        self.rotation.tr_mul(&(p - self.origin))
    }

    /// A direction in principal coordinates.
    pub fn direction_to_principal(&self, v: &Vec3) -> Vec3 {
        self.rotation.tr_mul(v)
    }

    /// The point with these principal coordinates.
    pub fn from_principal(&self, y: &Vec3) -> Vec3 {
        self.origin + self.rotation * y
    }

    /// The direction with these principal coordinates.
    pub fn direction_from_principal(&self, v: &Vec3) -> Vec3 {
        self.rotation * v
    }

    /// Coefficients `aᵢ` of the squares.
    pub fn squares(&self) -> &Vec3 {
        &self.square
    }

    /// F and half its gradient at the origin of the principal coordinates.
    pub fn at_origin(&self) -> (f64, &Vec3) {
        (self.constant, &self.linear)
    }

    /// The stationary point for a place in principal coordinates.
    pub fn stationary(&self, y: &Vec3, multiplier: f64) -> Stationary {
        let stretch = self.square.map(|a| 1.0 / (1.0 + multiplier * a));
        let point = (y - self.linear * multiplier).component_mul(&stretch);
        let gradient = self.square.component_mul(&point) + self.linear;
        let (mut value, mut terms) = (self.constant, self.constant.abs());
        for i in 0..3 {
            let term = (gradient[i] + self.linear[i]) * point[i];
            value += term;
            terms += term.abs();
        }
        Stationary { point, gradient, value, stretch, terms }
    }

    /// A function whose product with the multiplier (not negative; squared length per unit of F) is nowhere above the
    /// squared distance from the set where `side · F ≤ 0`, `side · F` itself for the multiplier zero. `None` if there is
    /// none for this multiplier.
    pub fn distance_bound(&self, side: f64, multiplier: f64) -> Option<QuadraticFunction> {
        let stretch = self.square.map(|a| 1.0 + multiplier * side * a);
        if !(multiplier >= 0.0 && stretch.min() > 0.0) {
            return None;
        }
        let linear = self.linear * side;
        let shrunk = stretch.map(|stretch| 1.0 / stretch);
        let lowered = linear.component_mul(&shrunk);
        Some(QuadraticFunction {
            square: (self.square * side).component_mul(&shrunk),
            linear: lowered,
            constant: side * self.constant - multiplier * linear.dot(&lowered),
        })
    }

    fn round(axis: &Vec3, origin: Vec3, square: Vec3, constant: f64) -> Self {
        let x = perpendicular(axis);
        let rotation = Matrix3::from_columns(&[x, axis.cross(&x), *axis]);
        Self { rotation, origin, square, linear: Vec3::zeros(), constant, coefficients: [0.0; 10] }
    }

    fn of_cylinder(cylinder: &Cylinder) -> Self {
        let r = cylinder.radius;
        // F = (ρ² − r²)/2r: half its gradient is as long as ρ/2r.
        let k = if r > 0.0 { 0.5 / r } else { 1.0 };
        Self::round(&cylinder.axis, cylinder.point, Vec3::new(k, k, 0.0), -k * r * r)
    }

    fn of_cone(cone: &ConeForm) -> Self {
        let (c, s) = (cone.cosine * cone.cosine, cone.sine * cone.sine);
        Self::round(&cone.axis, cone.vertex, Vec3::new(c, c, -s), 0.0)
    }
}

impl Surface {
    /// The quadric in principal axes that a cylinder, a cone (with its other nappe) or a quadric is. Its F is positive where
    /// the signed distance is, beyond the other nappe excepted.
    pub fn principal_quadric(&self) -> Option<Cow<'_, PrincipalQuadric>> {
        match self {
            Self::Quadric(form) => Some(Cow::Borrowed(form.as_ref())),
            Self::Cylinder(cylinder) => Some(Cow::Owned(PrincipalQuadric::of_cylinder(cylinder))),
            Self::Cone(cone) => Some(Cow::Owned(PrincipalQuadric::of_cone(cone))),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::canonical::{Cone, Geometry, Quadric};

    fn v(x: f64, y: f64, z: f64) -> Vec3 {
        Vec3::new(x, y, z)
    }

    fn surfaces() -> Vec<Surface> {
        let quadric = |coefficients| Geometry::Quadric(Quadric { coefficients });
        [
            quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5]),
            quadric([0.25, 1.0, 0.4, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            quadric([1.0, 0.8, -0.7, -1.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0]),
            quadric([1.0, 0.8, -0.7, 1.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0]),
            quadric([1.0, 0.6, 0.0, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, -1.5]),
            Geometry::Cylinder(Cylinder { point: v(0.1, 0.2, 0.0), axis: v(0.3, 1.0, 0.2), radius: 1.5 }),
            Geometry::Cone(Cone {
                vertex: v(0.0, 0.0, 1.5),
                axis: v(0.1, 0.0, -1.0).normalize(),
                cosine: 0.8,
            }),
        ]
        .iter()
        .map(|g| Surface::from_geometry(g).expect("surface"))
        .collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        /// A bound made at one place is below the squared distance everywhere, and touches it at that place.
        #[test]
        fn bounds_touch_the_squared_distance_and_stay_below(
            which in 0usize..7, side in prop::bool::ANY, place in prop::array::uniform3(-2.0..2.0f64),
            others in prop::collection::vec(prop::array::uniform3(-2.5..2.5f64), 20),
        ) {
            let form = surfaces()[which].principal_quadric().expect("a quadric").into_owned();
            // A cone with both nappes.
            let surface = Surface::Quadric(Box::new(form.clone()));
            let side = if side { 1.0 } else { -1.0 };
            let place = Vec3::from(place);
            let distance = side * surface.signed_distance(&place);
            let y = form.to_principal(&place);
            prop_assume!(distance > 1e-3);
            let foot = form.to_principal(&surface.foot(&place).point);
            let gradient = form.stationary(&foot, 0.0).gradient.norm();
            prop_assume!(gradient > 1e-3);
            let multiplier = distance / gradient;
            // None only where nearest points jump: a hair nearer there is one.
            let Some(bound) = form.distance_bound(side, multiplier * (1.0 - 1e-6)) else {
                prop_assert!(false, "no bound");
                return Ok(());
            };
            let multiplier = multiplier * (1.0 - 1e-6);
            prop_assert!((multiplier * bound.at(&y) - distance * distance).abs() < 1e-5);
            for other in others {
                let other = Vec3::from(other);
                let below = multiplier * bound.at(&form.to_principal(&other));
                let d = (side * surface.signed_distance(&other)).max(0.0);
                prop_assert!(below <= d * d + 1e-9, "{below} above {}", d * d);
            }
        }
    }

    #[test]
    fn no_bound_for_multipliers_beyond_the_pole() {
        let surfaces = surfaces();
        let form = surfaces[1].principal_quadric().expect("a quadric");
        assert!(form.distance_bound(1.0, 50.0).is_some());
        assert!(form.distance_bound(-1.0, 50.0).is_none());
        assert!(form.distance_bound(1.0, -0.1).is_none());
    }
}
