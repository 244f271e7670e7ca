//! Contact within a part of the meridian: inside a straight piece, or on the arc of a corner whose centre is beyond the axis.

use apt_geometry::Vec3;
use nalgebra::Matrix3;

use super::{LAST_STEP, Place, STEPS, Touch};
use crate::verify::tool::{Meridian, Profile};

/// A part of the meridian, followed upwards from 0 to 1.
#[derive(Debug, Clone, Copy)]
pub(super) enum Part {
    /// Straight, between two places.
    Line([Meridian; 2]),
    /// An arc about a centre between two angles of its normal from straight down, radians.
    Arc { center: Meridian, radius: f64, ends: [f64; 2] },
}

impl Part {
    /// The arc of the corner about a centre; None where it has no length.
    pub(super) fn arc(profile: &Profile, center: Meridian, radius: f64) -> Option<Self> {
        let [lower, upper, _] = profile.edges();
        let ends = [lower, upper].map(|p| (p[0] - center[0]).atan2(center[1] - p[1]));
        (ends[1] > ends[0]).then_some(Self::Arc { center, radius, ends })
    }

    /// A place with its first and second derivatives.
    fn at(&self, t: f64) -> [Meridian; 3] {
        match *self {
            Self::Line([a, b]) => {
                let way = [b[0] - a[0], b[1] - a[1]];
                [[a[0] + t * way[0], a[1] + t * way[1]], way, [0.0; 2]]
            }
            Self::Arc { center, radius, ends: [first, last] } => {
                let turn = last - first;
                let (sin, cos) = (first + t * turn).sin_cos();
                let (speed, bend) = (radius * turn, radius * turn * turn);
                [
                    [center[0] + radius * sin, center[1] - radius * cos],
                    [speed * cos, speed * sin],
                    [-bend * sin, bend * cos],
                ]
            }
        }
    }

    /// The place whose normal is nearest to a direction, about.
    fn towards(&self, [out, up]: Meridian) -> f64 {
        match *self {
            Self::Line(_) => 0.5,
            Self::Arc { ends: [first, last], .. } => {
                let t = (out.atan2(-up) - first) / (last - first);
                if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.5 }
            }
        }
    }
}

impl Place<'_> {
    /// The contact within a part of the meridian: azimuth, place on the part and multiplier.
    pub(super) fn touch_piece(&self, part: Part) -> Option<Touch> {
        let middle = self.tip + self.axis * part.at(0.5)[0][1];
        let facing = self.quadric.slope(&middle) * -self.side;
        let (first, last) = (facing.dot(&self.across[0]), facing.dot(&self.across[1]));
        let mut phi = last.atan2(first);
        let mut t = part.towards([first.hypot(last), facing.dot(&self.axis)]);
        let mut lambda = None;
        for _ in 0..STEPS {
            let [out, round] = self.on_circle(phi);
            let [[rho, height], [spread, rise], [widening, climbing]] = part.at(t);
            let p = self.tip + self.axis * height + out * rho;
            let multiplier = match lambda {
                Some(known) => known,
                None => self.quadric.first_multiplier(&p)?,
            };
            let k = self.quadric.shrink(multiplier);
            if k.min() <= 0.0 {
                return None;
            }
            let foot = self.quadric.foot(&p, multiplier);
            let g = self.quadric.slope(&foot);
            let (around, along) = (round * rho, out * spread + self.axis * rise);
            let curved = self.quadric.squares().component_mul(&k);
            let bend = |v: &Vec3, w: &Vec3| curved.component_mul(v).dot(w);
            let kg = k.component_mul(&g);
            let twist = bend(&around, &along) + spread * g.dot(&round);
            let matrix = Matrix3::new(
                bend(&around, &around) - rho * g.dot(&out),
                twist,
                -bend(&g, &around),
                twist,
                bend(&along, &along) + g.dot(&(out * widening + self.axis * climbing)),
                -bend(&g, &along),
                2.0 * kg.dot(&around),
                2.0 * kg.dot(&along),
                -2.0 * kg.dot(&g),
            );
            let wrong = Vec3::new(-g.dot(&around), -g.dot(&along), -self.quadric.value(&foot));
            let step = matrix.try_inverse()? * wrong;
            if !step.iter().all(|x| x.is_finite()) {
                return None;
            }
            phi += step.x.clamp(-0.5, 0.5);
            t += step.y.clamp(-0.5, 0.5);
            lambda = Some(multiplier + step.z);
            if !(-1.0..=2.0).contains(&t) {
                return None;
            }
            if step.x.abs().max(step.y.abs()).max(step.z.abs() * curved.amax()) <= LAST_STEP {
                if !(0.0..=1.0).contains(&t) {
                    return None;
                }
                let [meridian, ..] = part.at(t);
                let p = self.tip + self.axis * meridian[1] + self.on_circle(phi)[0] * meridian[0];
                return self.finished(meridian, &p, multiplier + step.z, 0.0);
            }
        }
        None
    }
}
