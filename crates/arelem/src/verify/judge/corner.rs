//! Corners in which a tool goes on along another leg by more than a right angle.

use apt_geometry::Vec3;

use super::{
    super::{
        hand::{Hand, Leap, sign_along},
        span::between,
    },
    Bound, Judge,
};
use crate::sequence::ToolPosition;

/// How many vectors are looked at for the way that led to a corner: before it some are short, for a vertex has to lie in it.
const MOST_VECTORS_BACK: usize = 8;
/// By how many bands a tool in its band is moved towards a wall to be too deep in it, if it is there, by one of them.
const INTO_WALL: f64 = 2.0;
/// Halvings of a vector for the place on it where a contact leaps.
const LEAP_HALVINGS: u32 = 30;
/// Cosine between the directions of the path on both sides of that below which they are two but for rounding.
const SAME_LINE: f64 = 1.0 - 1e-6;

impl Judge<'_> {
    /// Where a contact leaps beside a vertex.
    pub(super) fn leap_beside(&self, hand: &Hand, roles: [&Bound<'_>; 2], vector: usize) -> Option<Leap> {
        if self.leaps_on(roles, vector) {
            Some(Leap::Ahead)
        } else if hand.is_beyond_corner() || self.keeps_hand_before(hand, roles, vector) {
            Some(Leap::Behind)
        } else {
            None
        }
    }

    /// Whether the path keeps its hand on the vector that leads to a vertex: that leads along on it at both ends, or a contact leaps.
    pub(super) fn keeps_hand_before(&self, hand: &Hand, roles: [&Bound<'_>; 2], vector: usize) -> bool {
        let Some(before) = vector.checked_sub(1) else { return false };
        let (from, to) = (&self.positions[before], &self.positions[vector]);
        let is_on_hand = |position: usize| {
            let normals = roles.map(|role| role.normal_at(position).ok());
            let [Some(part), Some(drive)] = normals else { return false };
            hand.is_told_by(&[part, drive], &(to.tip - from.tip))
        };
        from.axis == to.axis && is_on_hand(before) && (is_on_hand(vector) || self.leaps_on(roles, before))
    }

    /// The cosine between a vector and the path on the hand that was kept, where the path has crossed over to the other hand: what leads straight on in a
    /// corner is beside the wall that it came along all the same, or else it goes along the other wall with that on the wrong side, as beyond the vertex
    /// of a double cone.
    pub(super) fn crosses_over(
        &self,
        hand: &mut Hand,
        roles: [&Bound<'_>; 2],
        vector: usize,
        ends: &[[Vec3; 2]; 2],
    ) -> Option<f64> {
        let (from, to) = (&self.positions[vector], &self.positions[vector + 1]);
        let cosine = hand.against(ends, &(to.tip - from.tip).normalize())?;
        let walls = hand.walls_of_corner()?;
        let is_gone = |(role, normal): (&Bound<'_>, &Vec3)| {
            let deeper = INTO_WALL * (role.intol + role.outtol + self.guard());
            let reading = role.clearance().at(&(to.tip - normal * deeper), &to.axis);
            reading.is_some_and(|read| read.value - read.error > -role.intol)
        };
        let mut of_sides = roles.into_iter().zip(walls).filter(|(role, _)| !role.on);
        let is_crossed = from.axis == to.axis && of_sides.any(is_gone);
        is_crossed.then_some(cosine)
    }

    /// Whether a contact leaps on a vector of a tool that does not turn, where the path turns by more than a right angle: however near to each other its
    /// normals are on either side, the path has two directions. Where both surfaces come to be tangent and part again the hand changes along a
    /// vector as well, but there the normals go over into each other, and in between they do not tell it.
    fn leaps_on(&self, roles: [&Bound<'_>; 2], vector: usize) -> bool {
        self.lines_beside_leap(roles, vector)
            .is_some_and(|[before, beyond]| before.dot(&beyond).abs() < SAME_LINE)
    }

    /// The lines of the path on both sides of the place on a vector where the hand changes against it.
    fn lines_beside_leap(&self, roles: [&Bound<'_>; 2], vector: usize) -> Option<[Vec3; 2]> {
        let (from, to) = (&self.positions[vector], &self.positions[vector + 1]);
        let motion = to.tip - from.tip;
        if from.axis != to.axis || motion.norm() <= self.guard() {
            return None;
        }
        let normals_at = |share: f64| -> Option<[Vec3; 2]> {
            let place = ToolPosition { tip: from.tip + motion * share, axis: from.axis };
            Some([roles[0].normal(&place)?, roles[1].normal(&place)?])
        };
        let mut ends = [normals_at(0.0)?, normals_at(1.0)?];
        let [before, beyond] = ends.map(|normals| sign_along(&normals, &motion));
        if before? == beyond? {
            return None;
        }
        let mut shares = [0.0, 1.0];
        for _ in 0..LEAP_HALVINGS {
            let share = 0.5 * (shares[0] + shares[1]);
            let middle = normals_at(share)?;
            let side = usize::from(sign_along(&middle, &motion)? != before?);
            (shares[side], ends[side]) = (share, middle);
        }
        Some(ends.map(|normals| normals[0].cross(&normals[1]).normalize()))
    }

    /// Whether a tool that turns goes on by a vector along the other leg of a corner, away from the place where it touched a surface before, by whatever
    /// angle.
    ///
    /// The axis goes with the tool end: what this keeps clear of a surface is a region whose edges are the legs. Within the corner, between places as far
    /// from it on the way there and on the vector, the tool is clear of the surface, beyond the band by more than that is wide; a place between two of one
    /// leg is about in the band, as they are. The normal need not tell, which is the same all along a flank that comes to lie along a plane.
    pub(super) fn goes_round(&self, roles: [&Bound<'_>; 2], vector: usize) -> bool {
        let (here, beyond) = (&self.positions[vector], &self.positions[vector + 1]);
        let length = (beyond.tip - here.tip).norm();
        let Some((from, way)) = self.way_back(vector, length) else { return false };
        if from.axis == here.axis || here.axis == beyond.axis || way <= self.guard() {
            return false;
        }
        let within = between(here, beyond, way / length).and_then(|to| between(&from, &to, 0.5));
        within.is_some_and(|place| {
            roles.iter().filter(|role| !role.on).any(|role| {
                let reading = role.clearance().at(&place.tip, &place.axis);
                let clear = role.outtol + (role.intol + role.outtol) + self.guard();
                reading.is_some_and(|read| read.value - read.error > clear)
            })
        })
    }

    /// The place on the way to a position that is a distance from that, or as near to that as few vectors lead which come steadily nearer; and how far
    /// it is. None at the beginning.
    fn way_back(&self, position: usize, distance: f64) -> Option<(ToolPosition, f64)> {
        let here = self.positions[position];
        let mut farthest = (here, 0.0);
        for before in self.positions[..position].iter().rev().take(MOST_VECTORS_BACK) {
            let away = (before.tip - here.tip).norm();
            if away <= farthest.1 {
                break;
            }
            if away >= distance {
                let share = (distance - farthest.1) / (away - farthest.1);
                return Some((between(&farthest.0, before, share)?, distance));
            }
            farthest = (*before, away);
        }
        (farthest.1 > 0.0).then_some(farthest)
    }
}
