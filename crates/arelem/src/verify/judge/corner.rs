//! Corners in which a tool that turns goes on along another leg by more than a right angle.

use super::{super::span::between, Bound, Judge};
use crate::sequence::ToolPosition;

/// How many vectors are looked at for the way that led to a corner: before it some are short, for a vertex has to lie in it.
const MOST_VECTORS_BACK: usize = 8;

impl Judge<'_> {
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
