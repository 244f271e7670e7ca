//! Cylinders and cones touched by a circle of the tool from outside, whatever the angle between the axes. The distance of a
//! point is linear in its distances from and along the axis, so that only the azimuth on the circle is looked for.

use apt_geometry::{Vec3, surface::Surface};

use super::{
    Contact, Tool,
    quadric::{Start, Touch},
    tool::Circle,
    waves::turned,
};

/// Bound of Newton's method; without convergence other means take over.
const MAX_ITERATIONS: u32 = 12;
/// A last step below this (radians) ends it: what is left is its square, and the clearance errs by the square of that.
const NEARLY: f64 = 1e-5;
/// Largest azimuth step, radians.
const LARGEST_STEP: f64 = 0.5;

/// A solid from which the distance of a point outside is `cosine · ρ − sine · z − radius`, ρ being its distance from the axis
/// and z that along it.
pub(super) struct Round {
    origin: Vec3,
    axis: Vec3,
    cosine: f64,
    sine: f64,
    radius: f64,
}

impl Round {
    /// `None` for surfaces that are neither cylinders nor cones.
    pub(super) fn new(surface: &Surface) -> Option<Self> {
        match surface {
            Surface::Cylinder(c) => {
                Some(Self { origin: c.point, axis: c.axis, cosine: 1.0, sine: 0.0, radius: c.radius })
            }
            Surface::Cone(c) => {
                Some(Self { origin: c.vertex, axis: c.axis, cosine: c.cosine, sine: c.sine, radius: 0.0 })
            }
            _ => None,
        }
    }

    /// Radius of a cylinder; a cone is as wide as one likes.
    pub(super) fn width(&self) -> f64 {
        if self.sine > 0.0 { f64::INFINITY } else { self.radius }
    }

    /// The contact of a circle of balls near a direction (cosine and sine of the azimuth).
    pub(super) fn touch(
        &self,
        tool: &Tool,
        tip: &Vec3,
        circle: &Circle,
        mut direction: [f64; 2],
    ) -> Option<Touch> {
        let radius = circle.radius;
        let center = tip + tool.axis * circle.height - self.origin;
        let [u, v] = &tool.across;
        let [along, ua, va] = [&center, u, v].map(|w| w.dot(&self.axis));
        let aside = center - self.axis * along;
        let (first, second) = (radius * aside.dot(u), radius * aside.dot(v));
        let square = aside.norm_squared() + 0.5 * radius * radius * (2.0 - ua * ua - va * va);
        // Of ρ² the waves of twice the azimuth, of z those of the azimuth.
        let (even, mixed) = (0.5 * radius * radius * (va * va - ua * ua), -radius * radius * ua * va);
        let (rise, turn) = (radius * ua, radius * va);
        for _ in 0..MAX_ITERATIONS {
            let [c, s] = direction;
            let (c2, s2) = (c * c - s * s, 2.0 * s * c);
            // ρ² and halves of its derivatives.
            let across = square + 2.0 * (first * c + second * s) + even * c2 + mixed * s2;
            let slope = second * c - first * s + mixed * c2 - even * s2;
            let bend = -first * c - second * s - 2.0 * (even * c2 + mixed * s2);
            if across <= 0.0 {
                return None;
            }
            // Derivatives of the distance, times ρ.
            let rho = across.sqrt();
            let slant = self.sine * rho;
            let falls = self.cosine * slope - slant * (turn * c - rise * s);
            let bends = self.cosine * (bend - slope * slope / across) + slant * (rise * c + turn * s);
            if bends <= 0.0 || !bends.is_finite() {
                return None;
            }
            let step = (-falls / bends).clamp(-LARGEST_STEP, LARGEST_STEP);
            direction = turned(direction, step);
            if step.abs() <= NEARLY {
                return self.made(tool, center, circle, direction);
            }
        }
        None
    }

    fn made(&self, tool: &Tool, center: Vec3, circle: &Circle, direction: [f64; 2]) -> Option<Touch> {
        let place = center + (tool.across[0] * direction[0] + tool.across[1] * direction[1]) * circle.radius;
        let along = place.dot(&self.axis);
        let aside = place - self.axis * along;
        let rho = aside.norm();
        let distance = self.cosine * rho - self.sine * along - self.radius;
        if rho <= 0.0 || circle.ball > 0.0 && distance <= 0.0 {
            return None;
        }
        let gradient = aside * (self.cosine / rho) - self.axis * self.sine;
        let place = place + self.origin;
        let contact = Contact {
            clearance: distance - circle.ball,
            gradient,
            tool: place - gradient * circle.ball,
            surface: place - gradient * distance,
        };
        let start = Start { direction, multiplier: None };
        Some(Touch { contact, lean: gradient.dot(&tool.axis), start })
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::{
        canonical::{Cone, Cylinder, Geometry},
        cutter::Cutter,
    };
    use proptest::prelude::*;

    use super::*;
    use crate::clearance::quadric::is_way_out;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        /// What is found is stationary on the circle, and its distance is that of the surface.
        #[test]
        fn contacts_are_stationary(
            is_cone in prop::bool::ANY, axis in prop::array::uniform3(-1.0..1.0f64),
            tip in prop::array::uniform3(-3.0..3.0f64), azimuth in 0.0..std::f64::consts::TAU,
        ) {
            let axis = Vec3::from(axis);
            prop_assume!(axis.norm() > 0.1);
            let (point, along) = (Vec3::new(0.1, 0.2, -0.3), Vec3::new(0.3, 1.0, 0.2).normalize());
            let geometry = if is_cone {
                Geometry::Cone(Cone { vertex: point, axis: along, cosine: 0.8 })
            } else {
                Geometry::Cylinder(Cylinder { point, axis: along, radius: 0.7 })
            };
            let surface = Surface::from_geometry(&geometry).expect("surface");
            let cutter = Cutter::from_numbers(&[1.0, 0.2], 1.0).expect("cutter");
            let tool = Tool::new(cutter, axis.normalize());
            let (tip, circle) = (Vec3::from(tip), Circle { radius: 0.3, height: 0.2, ball: 0.2 });
            let round = Round::new(&surface).expect("round");
            let start = [azimuth.cos(), azimuth.sin()];
            let touch = round.touch(&tool, &tip, &circle, start);
            let touch = touch.filter(|touch| is_way_out(&tool, &surface, &touch.contact));
            if let Some(Touch { contact, start: Start { direction: [c, s], .. }, .. }) = touch {
                let at = |turn: f64| {
                    let (x, y) = (c * turn.cos() - s * turn.sin(), s * turn.cos() + c * turn.sin());
                    tip + tool.axis * circle.height + (tool.across[0] * x + tool.across[1] * y) * circle.radius
                };
                let here = surface.foot(&at(0.0));
                prop_assert!((here.distance - circle.ball - contact.clearance).abs() < 1e-12);
                prop_assert!((here.normal - contact.gradient).norm() < 1e-9);
                prop_assert!((here.point - contact.surface).norm() < 1e-9);
                prop_assert!(here.normal.dot(&(at(1e-6) - at(-1e-6))).abs() < 1e-14);
            }
        }
    }
}
