//! The corner of a barrel, whose centre is beyond the axis: no circle of balls, but an arc that is turned about the axis, looked at by
//! the circles on which its places go round.

use super::{Search, Shape};
use crate::verify::{
    tool::{Meridian, Profile},
    trough::meeting,
};

/// Circles that are looked at along the arc before a trough between two of them is closed in, and the same where there may be more of
/// them, over a saddle.
const CIRCLES: u32 = 6;
const CIRCLES_OF_SADDLE: u32 = 16;
/// Golden sections of what is between two circles: the distance is off by the square of what is left, a ten-millionth.
const SECTIONS: u32 = 34;
/// Stretches of the arc that are halved for a proof; what is left then is error.
const STRETCHES: u32 = 80;

/// The arc of a corner whose centre is beyond the axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bulge {
    center: Meridian,
    radius: f64,
    /// Angles of its normals at both ends from straight down, radians.
    ends: [f64; 2],
}

impl Bulge {
    /// None of a tool that is no barrel.
    pub(super) fn of(profile: &Profile) -> Option<Self> {
        let (center, radius) = profile.corner().filter(|(center, _)| center[0] < 0.0)?;
        let [lower, upper, _] = profile.edges();
        let ends = [lower, upper].map(|p| (p[0] - center[0]).atan2(center[1] - p[1]));
        Some(Self { center, radius, ends })
    }

    fn at(&self, angle: f64) -> Meridian {
        let (sin, cos) = angle.sin_cos();
        [self.center[0] + self.radius * sin, self.center[1] - self.radius * cos]
    }

    fn share(&self, share: f64) -> f64 {
        self.ends[0] + share * (self.ends[1] - self.ends[0])
    }
}

impl Search<'_> {
    /// Candidates on the arc.
    pub(super) fn bulge(&mut self, bulge: &Bulge) -> Option<()> {
        let count = if self.shape == Shape::Free { CIRCLES_OF_SADDLE } else { CIRCLES };
        let angle = |k: u32| bulge.share(f64::from(k) / f64::from(count));
        let values: Vec<f64> = (0..=count).map(|k| self.on_bulge(bulge, angle(k))).collect::<Option<_>>()?;
        for k in 0..=count {
            let at = |k: u32| values.get(k as usize).copied().unwrap_or(f64::INFINITY);
            let before = if k > 0 { at(k - 1) } else { f64::INFINITY };
            if at(k) <= before && at(k) <= at(k + 1) {
                self.close_in_on_bulge(bulge, angle(k.saturating_sub(1)), angle((k + 1).min(count)))?;
            }
        }
        Some(())
    }

    /// The least distance found on the circle of the arc that has normals with an angle from straight down; it is a candidate, too.
    fn on_bulge(&mut self, bulge: &Bulge, angle: f64) -> Option<f64> {
        let known = self.best.take();
        let done = self.circle(bulge.at(angle), 0.0);
        let found = std::mem::replace(&mut self.best, known);
        done?;
        found.map(|found| {
            self.offer(found);
            found.value
        })
    }

    /// Golden section along the arc for the least distance.
    fn close_in_on_bulge(&mut self, bulge: &Bulge, mut low: f64, mut high: f64) -> Option<()> {
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let mut inner = [high - golden * (high - low), low + golden * (high - low)];
        let mut values = [self.on_bulge(bulge, inner[0])?, self.on_bulge(bulge, inner[1])?];
        for _ in 0..SECTIONS {
            if values[0] <= values[1] {
                high = inner[1];
                inner = [high - golden * (high - low), inner[0]];
                values = [self.on_bulge(bulge, inner[0])?, values[0]];
            } else {
                low = inner[0];
                inner = [inner[1], low + golden * (high - low)];
                values = [values[1], self.on_bulge(bulge, inner[1])?];
            }
        }
        Some(())
    }

    /// Inside a convex hollow: a stretch of the arc lies in the triangle of its ends and the place where its tangents meet, and so do the
    /// circles of its places between theirs, on which a concave function is least. The stretch that could be nearest is halved.
    pub(super) fn prove_bulge(&mut self, bulge: &Bulge) -> Option<()> {
        let slack = 1e-12 * self.tool.profile.reach();
        let mut open = vec![(bulge.ends, self.lowest_beyond(bulge, bulge.ends)?)];
        for _ in 0..STRETCHES {
            let Some(worst) = (0..open.len()).min_by(|a, b| open[*a].1.total_cmp(&open[*b].1)) else { break };
            if self.best_value() - open[worst].1 <= slack {
                break;
            }
            let ([from, to], _) = open.swap_remove(worst);
            let middle = 0.5 * (from + to);
            self.prove_circle(bulge.at(middle), 0.0)?;
            for ends in [[from, middle], [middle, to]] {
                open.push((ends, self.lowest_beyond(bulge, ends)?));
            }
        }
        let lowest = open.iter().map(|stretch| stretch.1).fold(f64::INFINITY, f64::min);
        self.gap = self.gap.max(self.best_value() - lowest);
        Some(())
    }

    /// No place of the circle where the tangents at both ends of a stretch meet is nearer than this, or than the best candidate.
    fn lowest_beyond(&mut self, bulge: &Bulge, ends: [f64; 2]) -> Option<f64> {
        match meeting(ends.map(|angle| bulge.at(angle)), bulge.center, bulge.radius) {
            Some(corner) => self.lowest_on_circle(corner, 0.0, false),
            None => Some(f64::NEG_INFINITY),
        }
    }
}
