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

/// Squared sine of the angle between axes below which they are parallel: a whole line of the tool then touches.
const PARALLEL: f64 = 1e-12;
/// Rounding of the length of a unit vector; a normal that is longer is none.
const ROUNDING: f64 = 1e-12;

/// A solid from which the distance of a point outside is `cosine · ρ − sine · z − radius`, ρ being its distance from the axis
/// and z that along it.
pub(super) struct Round<'a> {
    origin: &'a Vec3,
    axis: &'a Vec3,
    cosine: f64,
    sine: f64,
    radius: f64,
}

impl<'a> Round<'a> {
    /// `None` for surfaces that are neither cylinders nor cones.
    pub(super) fn new(surface: &'a Surface) -> Option<Self> {
        match surface {
            Surface::Cylinder(c) => {
                Some(Self { origin: &c.point, axis: &c.axis, cosine: 1.0, sine: 0.0, radius: c.radius })
            }
            Surface::Cone(c) => {
                Some(Self { origin: &c.vertex, axis: &c.axis, cosine: c.cosine, sine: c.sine, radius: 0.0 })
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
        let [along, ua, va] = [&center, u, v].map(|w| w.dot(self.axis));
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

    /// The contact on a straight piece of the profile between two circles, near a direction. Its normal makes the angle with the tool axis that the piece
    /// has, and with that of the solid the one that all its normals have: two normals do, one to either side of both axes. While contact goes along the
    /// piece the normal is one and the same.
    pub(super) fn touch_line(
        &self,
        tool: &Tool,
        tip: &Vec3,
        [[low, high], [bottom, top]]: [[f64; 2]; 2],
        direction: [f64; 2],
    ) -> Option<Touch> {
        let (out, up) = (high - low, top - bottom);
        let (sloping, upright) = (out / out.hypot(up), up / out.hypot(up));
        let between = self.axis.dot(&tool.axis);
        let square = 1.0 - between * between;
        if upright <= 0.0 || square <= PARALLEL {
            return None;
        }
        // By both axes, and across them.
        let by_tool = (sloping + self.sine * between) / square;
        let by_solid = -self.sine - by_tool * between;
        let planar = tool.axis * by_tool + self.axis * by_solid;
        let across = self.axis.cross(&tool.axis);
        let share = ((1.0 - planar.norm_squared()) / square).max(0.0).sqrt();
        let radial = tool.across[0] * direction[0] + tool.across[1] * direction[1];
        let gradient = planar - across * share.copysign(across.dot(&radial));
        let towards = (tool.axis * sloping - gradient) / upright;
        // Where its perpendicular to the axis of the solid lies along the normal.
        let aside = self.axis.cross(&gradient);
        let start = tip + tool.axis * bottom + towards * low - self.origin;
        let line = tool.axis * up + towards * out;
        let along = -start.dot(&aside) / line.dot(&aside);
        if !(0.0..=1.0).contains(&along) || (gradient.norm_squared() - 1.0).abs() > ROUNDING {
            return None;
        }
        let place = start + line * along;
        let distance = gradient.dot(&place) - self.radius;
        if (gradient + self.axis * self.sine).dot(&place) <= 0.0 {
            return None;
        }
        let place = place + self.origin;
        let contact =
            Contact { clearance: distance, gradient, tool: place, surface: place - gradient * distance };
        let direction = [0, 1].map(|k| towards.dot(&tool.across[k]));
        Some(Touch { contact, lean: sloping, start: Start { direction, multiplier: None } })
    }

    fn made(&self, tool: &Tool, center: Vec3, circle: &Circle, direction: [f64; 2]) -> Option<Touch> {
        let place = center + (tool.across[0] * direction[0] + tool.across[1] * direction[1]) * circle.radius;
        let along = place.dot(self.axis);
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
    use crate::clearance::{
        dual,
        quadric::{contact_anywhere, is_way_out},
    };

    /// A tool with a slanted bottom, a corner and a slanted flank, beside solids whose axis leans to its own.
    fn slanted() -> Tool<'static> {
        let cutter = Cutter::from_numbers(&[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0], 1.0).expect("cutter");
        Tool::new(cutter, Vec3::z())
    }

    fn solid(is_cone: bool, axis: Vec3) -> Surface {
        let (point, axis) = (Vec3::new(0.1, 0.2, -0.3), axis.normalize());
        let geometry = if is_cone {
            Geometry::Cone(Cone { vertex: point, axis, cosine: 0.8 })
        } else {
            Geometry::Cylinder(Cylinder { point, axis, radius: 0.7 })
        };
        Surface::from_geometry(&geometry).expect("surface")
    }

    /// While contact goes along the slanted bottom it is found there, and is what the greatest of the distances by planes tells.
    #[test]
    fn contact_on_a_slanted_bottom_needs_no_search() {
        let (tool, surface) = (slanted(), solid(false, Vec3::new(0.2, 1.0, 0.1)));
        let bottom = tool.profile.lower;
        let mut on_bottom = 0;
        for k in -60..=60 {
            let tip = Vec3::new(0.1 + 0.01 * f64::from(k), 0.3, 0.45);
            let wanted = dual::contact(&tool, &surface, 1.0, &tip).expect("a contact");
            let from_tip = wanted.tool - tip;
            let share = from_tip.z / bottom.height;
            if share > 0.01 && share < 0.99 {
                on_bottom += 1;
                let (found, missed) =
                    contact_anywhere(&tool, &surface, 1.0, &tip, None).expect("a contact on the bottom");
                assert_eq!(missed, 0.0);
                assert!((found.clearance - wanted.clearance).abs() < 1e-13, "{found:?} {wanted:?}");
                assert!((found.gradient - wanted.gradient).norm() < 1e-9, "{found:?} {wanted:?}");
                assert!((found.tool - wanted.tool).norm() < 1e-6, "{found:?} {wanted:?}");
            }
        }
        assert!(on_bottom >= 10, "{on_bottom} contacts on the bottom");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        /// What is found anywhere on a tool is what the greatest of the distances by planes tells, on straight pieces of it, too.
        #[test]
        fn contacts_are_those_of_the_best_plane(
            is_cone in prop::bool::ANY, axis in prop::array::uniform3(-1.0..1.0f64),
            tip in prop::array::uniform3(-3.0..3.0f64),
        ) {
            let axis = Vec3::from(axis);
            prop_assume!(axis.norm() > 0.1);
            let (tool, surface, tip) = (slanted(), solid(is_cone, axis), Vec3::from(tip));
            let wanted = dual::contact(&tool, &surface, 1.0, &tip).expect("a contact");
            prop_assume!(wanted.clearance > 0.0);
            if let Some((found, missed)) = contact_anywhere(&tool, &surface, 1.0, &tip, None) {
                prop_assert!((found.clearance - wanted.clearance).abs() <= missed + 1e-12, "{found:?} {wanted:?}");
            }
        }

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
