//! Quadrics whose solid is two convex halves: both nappes of a cone, both sheets of a hyperboloid or of a hyperbolic cylinder.
//! A tool that touches one of them and is nowhere near the other is beside a convex solid.

use apt_geometry::{Vec3, cutter::ProfilePoint};

use super::{Means, Posed, Scene, Start, Touch, above_plane, floor::Bound};
use crate::clearance::{Contact, tool::Piece};

/// Steepness of F by which bounds are made, as shares of that at the contact: nearer to the vertex of a cone it is less.
const STEEPNESS: [f64; 4] = [1.0, 0.3, 0.1, 0.03];

/// Golden sections by which a plane between tool and half is looked for, each way: slopes are then known to some ten thousandths.
const SECTIONS: u32 = 18;

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
    /// way. Of the circle of centres of a barrel's corner, beyond the axis, it is the point that is farthest: the ball there holds all of
    /// the corner.
    fn room(&self, posed: &Posed<'_>, circle: &ProfilePoint) -> f64 {
        let center = posed.tip + posed.axis * circle.height;
        let aside = posed.across.map(|u| u.dot(&self.inward));
        let nearer = posed.way.map_or(0.0, |way| self.inward.dot(&way).min(0.0));
        self.inward.dot(&center) + nearer - circle.radius * aside[0].hypot(aside[1]) + self.gap
    }
}

impl Posed<'_> {
    /// Both halves, if the solid has two.
    fn halves(&self) -> Option<[Half; 2]> {
        let (value, gradient) = self.form.at_origin();
        if gradient.iter().any(|slope| *slope != 0.0) {
            return None;
        }
        let (square, constant) = (self.form.squares() * self.side, value * self.side);
        let mut hollow = (0..3).filter(|i| square[*i] < 0.0);
        let across = hollow.next()?;
        let has_halves = hollow.next().is_none() && constant >= 0.0;
        let half = |sign: f64| {
            let mut inward = Vec3::zeros();
            inward[across] = sign;
            Half { inward, gap: (constant / -square[across]).sqrt() }
        };
        has_halves.then(|| [half(1.0), half(-1.0)])
    }

    /// The half that a contact is on, if the solid has two.
    fn half_touched(&self, contact: &Contact) -> Option<Half> {
        let place = self.form.to_principal(&contact.surface);
        self.halves()?.into_iter().find(|half| half.inward.dot(&place) > 0.0)
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
            || self.plane_between(half, level).0 >= 0.0
    }

    /// Of the planes that have the other half behind them, the best one to show that the tool, here and on the way, is no nearer to
    /// them than a level: by how much they show it, or fail to, and the normal. Two convex bodies are as far apart as the best of the
    /// planes between them tells. What is spare at a plane, times the length of its normal, is a concave function of the two
    /// slopes of the plane.
    fn plane_between(&self, half: &Half, level: f64) -> (f64, Vec3) {
        let squares = self.form.squares();
        let across = half.inward.iamax();
        let [first, second] = [(across + 1) % 3, (across + 2) % 3];
        // How steep a plane may be so as not to cut into the half, which widens to a cone.
        let steepest = [first, second].map(|k| (squares[k] / -squares[across]).max(0.0).sqrt());
        let spare = |slopes: [f64; 2]| {
            let mut normal = half.inward;
            normal[first] = slopes[0] * steepest[0];
            normal[second] = slopes[1] * steepest[1];
            let along = normal.dot(&self.axis);
            let sideways = (normal.norm_squared() - along * along).max(0.0).sqrt();
            let lowest = self.way.map_or(0.0, |way| normal.dot(&way).min(0.0)) + normal.dot(&self.tip);
            let behind = -half.gap * (1.0 - slopes[0] * slopes[0] - slopes[1] * slopes[1]).max(0.0).sqrt();
            let spare = lowest - self.tool.profile.support(sideways, -along).0 - behind;
            (spare - level * normal.norm(), normal)
        };
        greatest(1.0, &|x| greatest((1.0 - x * x).max(0.0).sqrt(), &|y| spare([x, y])))
    }

    /// Where the tool is nearest to the other half than this, seen from the tool end in the frame of the part, if it is no farther
    /// from that than a level; and by how much it is shown to be.
    fn nearest_to_other(&self, half: &Half, level: f64) -> (f64, Vec3) {
        let (spare, normal) = self.plane_between(half, level);
        let along = normal.dot(&self.axis);
        let sideways = normal - self.axis * along;
        let place = self.tool.profile.support(sideways.norm(), -along).1;
        let radial = sideways.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let point = self.axis * place.height - radial * place.radius;
        (spare, self.form.direction_from_principal(&point))
    }

    fn keeps_off_by(&self, bound: &Bound, half: &Half, level: f64, towards: &Vec3) -> bool {
        let profile = &self.tool.profile;
        let is_beyond = |circle: &ProfilePoint| half.room(self, circle) >= level;
        let floor = |circle: &ProfilePoint| (*circle, self.floor(bound, circle, towards));
        let slants = &self.slants(bound);
        let lower = || floor(&profile.lower);
        let corner = if profile.arc > 0.0 {
            half.room(self, &profile.center) - profile.arc >= level
                || self.arcs((bound, slants), [lower(), floor(&profile.upper)], towards)
        } else {
            is_beyond(&profile.lower) || bound.keeps(lower().1)
        };
        let flank = |ends: [&ProfilePoint; 2]| {
            self.not_beyond(half, level, ends)
                .is_none_or(|ends| self.flank((bound, slants), ends.map(|circle| floor(&circle)), towards))
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

impl<'a> Scene<'a> {
    /// The contacts with both halves of a solid that has two.
    pub(super) fn on_either_half(&self) -> Vec<(usize, Touch)> {
        let Means::General(posed) = &self.means else { return Vec::new() };
        // Some point of the tool is nearer than this.
        let most = (self.side * self.surface.signed_distance(self.tip)).max(0.0);
        let halves = posed.halves().into_iter().flatten();
        halves.flat_map(|half| self.touches_near(posed.nearest_to_other(&half, most).1)).collect()
    }

    /// Where a solid has two halves and one is touched: the contact with the other one, if that is nearer.
    pub(super) fn on_the_other_half(&self, touched: &Touch) -> Option<(usize, Touch)> {
        let Means::General(posed) = &self.means else { return None };
        let clearance = touched.contact.clearance;
        let (spare, point) =
            posed.nearest_to_other(&posed.half_touched(&touched.contact)?, clearance.max(0.0));
        if spare >= 0.0 {
            return None;
        }
        let touches = self.touches_near(point).filter(|(_, touch)| touch.contact.clearance < clearance);
        touches.min_by(|(_, a), (_, b)| a.contact.clearance.total_cmp(&b.contact.clearance))
    }

    /// Contacts on all pieces of the tool from a point of it, given from its end.
    fn touches_near(&self, point: Vec3) -> impl Iterator<Item = (usize, Touch)> {
        let radial = self.tool.split(&point).2;
        let direction = [0, 1].map(|k| radial.dot(&self.tool.across[k]));
        let foot = self.surface.foot(&(self.tip + point));
        let pieces = self.tool.pieces.iter().enumerate();
        pieces.filter_map(move |(index, piece)| {
            let ball = if let Piece::Ring { ball, .. } = piece { *ball } else { 0.0 };
            let multiplier = match &self.means {
                Means::Convex(posed) | Means::General(posed) => {
                    Some((foot.distance + self.side * ball) / posed.steepness(&foot.point))
                }
                Means::Round(_) => None,
            };
            Some((index, self.touch(piece, &point, &Start { direction, multiplier })?))
        })
    }
}

/// Greatest value found of a concave function between a number and its negative, by golden sections, with what comes with it; the
/// first that is not negative will do.
fn greatest<T: Copy>(bound: f64, value: &dyn Fn(f64) -> (f64, T)) -> (f64, T) {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let better = |a: (f64, T), b: (f64, T)| if b.0 > a.0 { b } else { a };
    let mut found = value(0.0);
    let (mut low, mut high) = (-bound, bound);
    let mut inner = [high - golden * (high - low), low + golden * (high - low)];
    let mut values = inner.map(value);
    for _ in 0..SECTIONS {
        found = better(better(found, values[0]), values[1]);
        if found.0 >= 0.0 {
            break;
        }
        if values[0].0 >= values[1].0 {
            (high, inner[1], values[1]) = (inner[1], inner[0], values[0]);
            inner[0] = high - golden * (high - low);
            values[0] = value(inner[0]);
        } else {
            (low, inner[0], values[0]) = (inner[0], inner[1], values[1]);
            inner[1] = low + golden * (high - low);
            values[1] = value(inner[1]);
        }
    }
    better(better(found, values[0]), values[1])
}
