//! Contact of a convex quadric within a straight piece of the tool, by its tangent planes: across a straight piece the
//! normal has one angle with the tool axis, so that only its azimuth is looked for. Every such plane bounds the clearance
//! of the whole tool from below, and the best of them touches: it is contact and proof in one, and what is left of the
//! azimuth counts by its square.

use apt_geometry::Vec3;

use super::{
    circle_contact::{Place, Touch},
    tool::Meridian,
};

/// Steps of the secant before the general search is asked.
const STEPS: usize = 16;
/// First step of the secant, radians.
const FIRST_STEP: f64 = 1e-4;
/// A last step below this (radians) ends it.
const LAST_STEP: f64 = 1e-8;
/// Largest step, radians.
const LARGEST_STEP: f64 = 0.5;
/// Share of a piece by which contact may lie beyond its ends for rounding.
const BEYOND_END: f64 = 1e-9;
/// Sine of the angle between a straight line of a cylinder and the tool's meridian below which they are parallel.
const PARALLEL: f64 = 1e-9;

/// A tangent plane of the solid.
struct Plane {
    /// Towards the tool.
    normal: Vec3,
    /// Where it touches the solid.
    foot: Vec3,
    /// How far the tool stands beyond it.
    value: f64,
    /// Change of that with the azimuth.
    rate: f64,
}

impl Place<'_> {
    /// The contact of a convex solid within the piece between two circles, looked for from a direction towards the solid on.
    pub(super) fn touch_straight(&self, ends: [Meridian; 2], facing: &Vec3) -> Option<Touch> {
        let [a, b] = ends;
        let (spread, rise) = (b[0] - a[0], b[1] - a[1]);
        let length = spread.hypot(rise);
        let outward = [rise / length, -spread / length];
        let generator = self.quadric.generator();
        let (phi, plane) = match &generator {
            // A flat bottom has one normal.
            _ if outward[0] <= 0.0 => (0.0, self.plane(a, outward, 0.0)?),
            Some(generator) => self.plane_along(a, outward, generator)?,
            None => self.best_plane(a, outward, facing)?,
        };
        let Plane { normal, foot, value, .. } = plane;
        let [radial, round] = self.on_circle(phi);
        let mut place = foot + normal * value - self.tip;
        if let Some(generator) = generator.filter(|g| outward[0] > 0.0 && g.dot(&round).abs() > PARALLEL) {
            // It touches all along one of its straight lines: where that meets the piece.
            place -= generator * (place.dot(&round) / generator.dot(&round));
        }
        let height = place.dot(&self.axis);
        let across = place - self.axis * height;
        let rho = if outward[0] > 0.0 { across.dot(&radial) } else { across.norm() };
        // Deep in the solid another of its places may be nearer than the one that the plane touches.
        let steepness = self.quadric.slope(&foot).norm();
        let is_nearest = self.quadric.shrink(self.side * value / steepness).min() > 0.0;
        let share = ((rho - a[0]) * spread + (height - a[1]) * rise) / (length * length);
        (is_nearest && (-BEYOND_END..=1.0 + BEYOND_END).contains(&share)).then_some(Touch {
            distance: value,
            normal,
            steepness,
            foot,
            meridian: [rho, height],
        })
    }

    /// The best of the planes about a direction towards the solid.
    fn best_plane(&self, circle: Meridian, outward: [f64; 2], facing: &Vec3) -> Option<(f64, Plane)> {
        let mut phi = facing.dot(&self.across[1]).atan2(facing.dot(&self.across[0]));
        let mut before = (phi, self.plane(circle, outward, phi)?.rate);
        phi += FIRST_STEP.copysign(before.1);
        for _ in 0..STEPS {
            let plane = self.plane(circle, outward, phi)?;
            let bend = (plane.rate - before.1) / (phi - before.0);
            let next = -plane.rate / bend;
            if plane.rate == 0.0 || bend < 0.0 && next.abs() <= LAST_STEP {
                return Some((phi, plane));
            }
            if bend >= 0.0 || !next.is_finite() {
                return None;
            }
            before = (phi, plane.rate);
            phi += next.clamp(-LARGEST_STEP, LARGEST_STEP);
        }
        None
    }

    /// The better of the two planes that hold the straight lines of a cylinder.
    fn plane_along(&self, circle: Meridian, outward: [f64; 2], generator: &Vec3) -> Option<(f64, Plane)> {
        let [x, y] = [0, 1].map(|k| self.across[k].dot(generator));
        let turn = (-outward[1] * self.axis.dot(generator) / (outward[0] * x.hypot(y))).acos();
        let planes = [turn, -turn].map(|turn| {
            let phi = y.atan2(x) + turn;
            Some((phi, self.plane(circle, outward, phi)?))
        });
        planes.into_iter().flatten().max_by(|a, b| a.1.value.total_cmp(&b.1.value))
    }

    /// The tangent plane that is parallel to a piece through a circle of the tool, at an azimuth.
    fn plane(&self, circle: Meridian, outward: [f64; 2], phi: f64) -> Option<Plane> {
        let [radial, round] = self.on_circle(phi);
        let normal = -(radial * outward[0] + self.axis * outward[1]);
        let foot = self.quadric.farthest(self.side, &normal, &self.tip)?;
        let away = self.tip - foot;
        // Nothing of the tool is beyond a straight piece of it.
        let value = normal.dot(&away) - outward[0] * circle[0] - outward[1] * circle[1];
        let rate = -outward[0] * round.dot(&away);
        value.is_finite().then_some(Plane { normal, foot, value, rate })
    }
}
