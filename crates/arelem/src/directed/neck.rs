//! The neck in which a path turns back because the tool comes to a second wall: where it is narrowest, and how far a tool half way
//! between both walls would be in them there.

use apt_geometry::Vec3;

use super::{Prepared, stop::graze::least_value};
use crate::{
    clearance::Shape,
    error::TurnsBack,
    role::{ROUNDING, Working},
};

/// How far from one place to the next it is looked whether a neck grows narrower, as a share of the tool's radius.
const STEP: f64 = 0.05;
/// How many of these steps a neck is followed: as far as the tool is wide.
const STEPS: usize = 40;
/// How far aside the middle of the neck may be, as a share of the way to it.
const ASIDE: f64 = 0.5;
/// Most corrections that keep the tool on the other surface.
const CORRECTIONS: u32 = 4;

/// Where a tool would go on through a neck.
pub(super) struct Place {
    pub(super) tip: Vec3,
    /// From the surface that makes the neck.
    pub(super) clearance: f64,
}

/// A neck in the surface of a role, beyond a place at which the path turns back.
pub(super) struct Neck<'a> {
    prepared: &'a Prepared<'a>,
    role: &'a Working,
    other: &'a Working,
    corner: TurnsBack,
    /// Unit direction across the neck.
    aside: Vec3,
}

impl<'a> Neck<'a> {
    /// The neck; `None` if the tool keeps to no side of that surface or touches it at one place alone, if it has no width, for which nothing is narrow, or if
    /// the way onward is square to the other one.
    pub(super) fn new(
        prepared: &'a Prepared<'a>,
        [role, other]: [&'a Working; 2],
        corner: TurnsBack,
    ) -> Option<Self> {
        let is_wide = STEP * prepared.tool.radius() > ROUNDING * prepared.size;
        if role.gauge.on || !is_wide || !matches!(role.shape, Shape::General | Shape::Concave) {
            return None;
        }
        let posture = prepared.attitude.posture(&corner.at).ok()?;
        let normal = posture.contact(&other.gauge, &corner.at).gradient;
        let across = |onward: &Vec3| onward.cross(&normal).try_normalize(ROUNDING);
        let seen = Self { prepared, role, other, corner, aside: across(&corner.onward)? };
        // The legs are vectors, which are as far from the tangents of the path as its bands let them be.
        let [here, ahead] = [0.0, seen.step()].map(|on| seen.at(on, seen.middle(on)));
        let (here, ahead) = (here?.tip, ahead?.tip);
        let onward = (ahead - here).try_normalize(0.0)?;
        Some(Self { corner: TurnsBack { at: here, onward }, aside: across(&onward)?, ..seen })
    }

    /// The place so far on and aside.
    fn at(&self, on: f64, aside: f64) -> Option<Place> {
        let Self { prepared, role, other, corner, .. } = self;
        let mut tip = corner.at + corner.onward * on + self.aside * aside;
        let mut posture = prepared.attitude.posture(&tip).ok()?;
        for _ in 0..CORRECTIONS {
            let contact = posture.contact(&other.gauge, &tip);
            let missing = other.rest() - contact.clearance;
            if missing.abs() <= ROUNDING * prepared.size {
                break;
            }
            tip += contact.gradient * (missing / contact.gradient.norm_squared().max(f64::MIN_POSITIVE));
            posture = prepared.attitude.posture(&tip).ok()?;
        }
        Some(Place { tip, clearance: posture.contact(&role.gauge, &tip).clearance })
    }

    fn clearance(&self, on: f64, aside: f64) -> Option<f64> {
        self.at(on, aside).map(|place| place.clearance)
    }

    /// Clearances straight on, a step from one to the next.
    fn profile(&self) -> Vec<f64> {
        let going_on = (0..=STEPS).take_while(|_| !self.prepared.tool.patience.is_over());
        going_on.map_while(|index| self.clearance(self.step() * index as f64, 0.0)).collect()
    }

    fn step(&self) -> f64 {
        STEP * self.prepared.tool.radius()
    }

    /// Unit direction of the way on between both walls.
    pub(super) fn onward(&self) -> &Vec3 {
        &self.corner.onward
    }

    /// The place so far on, and so far aside of half way between both walls.
    pub(super) fn beside_middle(&self, on: f64, aside: f64) -> Option<Place> {
        self.at(on, self.middle(on) + aside)
    }

    /// How far on the neck is narrowest, and the place half way between its walls there, if it grows wider behind that.
    pub(super) fn narrowest(&self) -> Option<(f64, Place)> {
        let profile = self.profile();
        let is_valley = |around: &[f64]| matches!(around, [a, b, c] if b < a && b <= c);
        // Where the tool is never deeper than at first the neck is no longer than a step.
        let ends = match profile.get(..2)? {
            [first, second] if first <= second => [0, 1],
            _ => profile.windows(3).position(is_valley).map(|index| [index, index + 2])?,
        };
        let ends = ends.map(|index| self.step() * index as f64);
        // Half way between the walls at each place: the way straight on need not be that.
        let (on, _) = least_value(ends, &|on| self.clearance(on, self.middle(on)).unwrap_or(f64::INFINITY));
        Some((on, self.beside_middle(on, 0.0)?))
    }

    /// How far aside the middle of the neck is.
    fn middle(&self, on: f64) -> f64 {
        let most = (ASIDE * on).max(self.step());
        let depth = |aside: f64| self.clearance(on, aside).map_or(f64::INFINITY, |clearance| -clearance);
        least_value([-most, most], &depth).0
    }

    /// The first place straight on at which the tool is deeper than a clearance.
    pub(super) fn first_below(&self, limit: f64) -> Option<Place> {
        let index = self.profile().iter().position(|clearance| *clearance < limit)?;
        self.at(self.step() * index as f64, 0.0)
    }
}
