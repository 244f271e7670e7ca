//! Quadrics whose solid is two convex halves: both nappes of a cone, both sheets of a hyperboloid or of a hyperbolic cylinder.
//! A tool that touches one of them and is nowhere near the other is beside a convex solid.

use apt_geometry::{Vec3, cutter::ProfilePoint};

use super::{Bound, Posed, above_plane};
use crate::clearance::Contact;

/// Steepness of F by which bounds are made, as shares of that at the contact: nearer to the vertex of a cone it is less.
const STEEPNESS: [f64; 4] = [1.0, 0.3, 0.1, 0.03];

/// Tilt of the tangent plane at a contact that is rounding: an azimuth errs by the square of its last step.
const TILT: f64 = 1e-10;

/// The half of a solid that a contact is on, in principal coordinates.
pub(in crate::clearance) struct Half {
    /// Unit vector into this half, across the plane between both.
    inward: Vec3,
    /// Distance of the other half from that plane.
    gap: f64,
}

impl Half {
    /// Whether it is the same half of the same solid as another one.
    pub(in crate::clearance) fn is(&self, other: &Self) -> bool {
        self.inward == other.inward
    }

    /// No point of a circle about the tool's axis, nor of the disc in it, is nearer to the other half than this, here and on the
    /// way.
    fn room(&self, posed: &Posed<'_>, circle: &ProfilePoint) -> f64 {
        let center = posed.tip + posed.axis * circle.height;
        let aside = posed.across.map(|u| u.dot(&self.inward));
        let nearer = posed.way.map_or(0.0, |way| self.inward.dot(&way).min(0.0));
        self.inward.dot(&center) + nearer - circle.radius * aside[0].hypot(aside[1]) + self.gap
    }
}

impl Posed<'_> {
    /// The half that a contact is on, if the solid has two.
    pub(in crate::clearance) fn half_touched(&self, contact: &Contact) -> Option<Half> {
        let square = self.form.squares() * self.side;
        let origin = self.form.stationary(&Vec3::zeros(), 0.0);
        let mut hollow = (0..3).filter(|i| square[*i] < 0.0);
        let (across, constant) = (hollow.next()?, origin.value * self.side);
        let place = self.form.to_principal(&contact.surface)[across];
        let has_halves = hollow.next().is_none() && origin.gradient == Vec3::zeros() && constant >= 0.0;
        (has_halves && place != 0.0).then(|| {
            let mut inward = Vec3::zeros();
            inward[across] = place.signum();
            Half { inward, gap: (constant / -square[across]).sqrt() }
        })
    }

    /// The half that a contact is on, if the tangent plane there shows that no point of the tool is nearer to it than a level, here
    /// and on the way.
    pub(in crate::clearance) fn half_by_plane(&self, level: f64, contact: &Contact) -> Option<Half> {
        let half = self.half_touched(contact)?;
        let is_above = |tip: &Vec3| above_plane(self.tool, contact, &self.form.from_principal(tip)) >= level;
        let ends = [Some(self.tip), self.way.map(|way| self.tip + way)];
        ends.iter().flatten().all(is_above).then_some(half)
    }

    /// The half that a contact is on, if the tool is nowhere nearer to it.
    pub(in crate::clearance) fn half_beside(&self, contact: &Contact) -> Option<Half> {
        let size = self.tool.radius() + self.tool.profile.top.height;
        self.half_by_plane(contact.clearance - TILT * size, contact)
    }

    /// Whether no point of the tool is nearer to the other half than a level. What lies in front of the plane between both is
    /// not; the rest is shown by a bound of the distance from either.
    pub(in crate::clearance) fn keeps_off(&self, half: &Half, level: f64, contact: &Contact) -> bool {
        let level = level.max(0.0);
        let Some((_, steepness, towards)) = self.bound_from(level, contact) else { return false };
        let bound = |share: f64| self.bound(level, share * steepness, &towards);
        STEEPNESS.into_iter().filter_map(bound).any(|bound| self.keeps_off_by(&bound, half, level, &towards))
    }

    fn keeps_off_by(&self, bound: &Bound, half: &Half, level: f64, towards: &Vec3) -> bool {
        let profile = &self.tool.profile;
        let is_beyond = |circle: &ProfilePoint| half.room(self, circle) >= level;
        let floor = |circle: &ProfilePoint| (*circle, self.floor(bound, circle, towards));
        let lower = || floor(&profile.lower);
        let corner = if profile.arc > 0.0 {
            half.room(self, &profile.center) - profile.arc >= level
                || self.arcs(bound, [lower(), floor(&profile.upper)], towards)
        } else {
            is_beyond(&profile.lower) || lower().1 >= bound.target
        };
        let flank = |ends: [&ProfilePoint; 2]| {
            self.not_beyond(half, level, ends)
                .is_none_or(|ends| self.flank(bound, ends.map(|circle| floor(&circle)), towards))
        };
        let tip = ProfilePoint { radius: 0.0, height: 0.0 };
        let bottom = if profile.lower.height > 0.0 {
            flank([&tip, &profile.lower])
        } else {
            is_beyond(&profile.lower) || self.bottom(bound, lower())
        };
        let is_high = profile.top.height > profile.upper.height;
        corner && bottom && (!is_high || flank([&profile.upper, &profile.top]))
    }

    /// What of the patch between two circles does not lie beyond the plane between both halves by a level. Along the profile the
    /// room changes linearly.
    fn not_beyond(
        &self,
        half: &Half,
        level: f64,
        [low, high]: [&ProfilePoint; 2],
    ) -> Option<[ProfilePoint; 2]> {
        let [first, last] = [low, high].map(|circle| half.room(self, circle) - level);
        let share = first / (first - last);
        let between = ProfilePoint {
            radius: low.radius + share * (high.radius - low.radius),
            height: low.height + share * (high.height - low.height),
        };
        match (first >= 0.0, last >= 0.0) {
            (true, true) => None,
            (true, false) => Some([between, *high]),
            (false, true) => Some([*low, between]),
            (false, false) => Some([*low, *high]),
        }
    }
}
