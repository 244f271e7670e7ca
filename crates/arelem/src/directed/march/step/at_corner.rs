//! A vector that ends where the path turns on the spot. Beyond that place it would be out of the band almost at once, short of it
//! another one had to lead there: so it ends just beyond, where the tool touches what it then follows.

use apt_geometry::Vec3;

use super::{
    Stepper, Trial,
    attempt::{Aim, LeastCosines},
};
use crate::{
    clearance::{Contact, Shape},
    directed::march::Vertex,
    role::{Bend, Working},
};

/// Bound of the corners that are looked for on one vector: the place comes nearer with each.
const MOST_CORNERS: u32 = 4;
/// Share of a vector by which it may be longer for a place where the path turns so much to be one where it has to end.
const TOO_SHARP: f64 = 0.1;
/// Share of a vector between two positions of the path, farther than which they do not tell whether it turns or bends between.
const NEAR: f64 = 0.5;
/// Sine below which two directions of the path do not tell where it turns.
const TELLING_SINE: f64 = 1e-3;
/// How far beyond the corner a vector ends, as a share of how far it may.
const BEYOND: f64 = 0.25;
/// How many times that a vector is long that is to lead on from there.
const WAY_ON: f64 = 4.0;
/// Share of the band by which a position may be off the limits.
const AT_LIMIT: f64 = 1e-3;
/// Share of the band that is left for going about a corner.
const ROUNDED: f64 = 0.1;

/// A position that has been found too far.
#[derive(Clone, Copy)]
struct Beyond {
    vertex: Vertex,
    /// Whether the path turns so much until there that a vector of any length is refused.
    is_square: bool,
}

/// What is known of a corner on a vector.
#[derive(Default)]
pub(super) struct Corners {
    /// The nearest of the positions that are too far, and the one that was before.
    beyond: [Option<Beyond>; 2],
    looked: u32,
    /// Where the vector ended from which a corner was looked for last.
    from: Option<Vec3>,
    /// Whether a vector that ends at a corner has been proven.
    pub(super) is_met: bool,
}

impl Corners {
    /// Whether no position is known to be too far.
    pub(super) fn is_unknown(&self) -> bool {
        self.beyond[0].is_none()
    }

    /// Notes a position at which a vector from `here` is too long.
    pub(super) fn note(&mut self, here: &Vertex, vertex: Vertex, is_square: bool) {
        let distance = |vertex: &Vertex| (vertex.tip - here.tip).norm();
        let [nearest, _] = self.beyond;
        if nearest.is_none_or(|known| distance(&vertex) < distance(&known.vertex)) {
            self.beyond = [Some(Beyond { vertex, is_square }), nearest];
        }
    }
}

/// A place where the path turns on the spot.
struct Corner {
    at: Vec3,
    /// The directions of the path before it and beyond.
    tangents: [Vec3; 2],
    /// How fast the clearances from part and drive surface grow beyond it for the contacts before it.
    leaves: [f64; 2],
}

impl Stepper<'_> {
    /// A vector to the corner between the longest one that is proven and what is too far, if there is one and that vector is proven.
    pub(super) fn to_corner(
        &self,
        here: &Vertex,
        proven: Option<&Trial>,
        cap: f64,
        aim: Aim<'_>,
        corners: &mut Corners,
    ) -> Option<Trial> {
        let (corner, targets) = self.corner_ahead(here, proven, aim.0, corners)?;
        let bends = aim.2;
        let room = self.room(&corner, targets)?;
        let vertex = self.meet(here, &(corner.at + corner.tangents[1] * (BEYOND * room)), targets)?;
        let [until, onward] = corner.tangents.map(|tangent| vertex.tangent.dot(&tangent));
        // There it may turn by up to a right angle.
        let is_there = (vertex.tip - corner.at).norm() <= room;
        let least = if is_there { LeastCosines::ROUND_CORNER } else { LeastCosines::ALONG };
        let trial = self.judge(here, vertex, bends, least).filter(|trial| trial.length <= cap);
        match trial {
            Some(trial)
                if trial.proven && self.leads_on(&trial.vertex, WAY_ON * room, cap, (targets, bends)) =>
            {
                corners.is_met = onward > until;
                Some(trial)
            }
            refused => {
                corners.note(here, vertex, refused.is_none());
                None
            }
        }
    }

    /// A corner that has not been looked at from the end of this vector, and the clearances that a vertex has there.
    fn corner_ahead(
        &self,
        here: &Vertex,
        proven: Option<&Trial>,
        targets: [f64; 2],
        corners: &mut Corners,
    ) -> Option<(Corner, [f64; 2])> {
        if corners.is_unknown() || corners.looked >= MOST_CORNERS || !self.may_have_corners() {
            return None;
        }
        let from = proven.map_or(here.tip, |trial| trial.vertex.tip);
        if corners.from == Some(from) {
            return None;
        }
        let (before, beyond, corner) = corners.beyond.into_iter().flatten().find_map(|beyond| {
            let before = match proven {
                Some(trial) => trial.vertex,
                None if beyond.is_square => *here,
                None => return None,
            };
            let before = self.at_limits(here, before, targets)?;
            let after = self.at_limits(here, beyond.vertex, targets)?;
            let corner = corner_between(here, &before, &after, beyond.is_square)?;
            self.sharpness(here, &corner).contains(&true).then_some((before, after, corner))
        })?;
        corners.looked += 1;
        corners.from = Some(from);
        let targets = self.targets_in(here, &corner, targets);
        let [before, beyond] = [before, beyond].map(|vertex| self.meet(here, &vertex.tip, targets));
        Some((corner_between(here, &before?, &beyond?, true)?, targets))
    }

    /// Whether a tool that keeps its axis may touch a surface at a second place: outside of a convex one it does not.
    pub(super) fn may_have_corners(&self) -> bool {
        let may_touch_twice = |role: &Working| matches!(role.shape, Shape::General | Shape::Concave);
        !self.prepared.attitude.turns() && self.roles().into_iter().any(may_touch_twice)
    }

    /// True if a vector of a length is proven that begins at a corner: what touches the tool twice may be hard to prove.
    pub(super) fn leads_on(
        &self,
        corner: &Vertex,
        length: f64,
        cap: f64,
        (targets, bends): ([f64; 2], &[Bend; 2]),
    ) -> bool {
        let onward = self.attempt(corner, length.min(cap), cap, (targets, &[0.0; 2], bends));
        onward.is_some_and(|onward| onward.proven)
    }

    /// A position at the limits: only places there tell where between them the path turns.
    fn at_limits(&self, here: &Vertex, vertex: Vertex, targets: [f64; 2]) -> Option<Vertex> {
        let clearances = [vertex.part.clearance, vertex.drive.clearance];
        let is_there =
            |(role, k): (&Working, usize)| (clearances[k] - targets[k]).abs() <= AT_LIMIT * role.band();
        if self.roles().into_iter().zip(0..).all(is_there) {
            return Some(vertex);
        }
        self.meet(here, &vertex.tip, targets)
    }

    /// For which role a vector cannot go on beyond a corner for a share of its length that is worth it.
    fn sharpness(&self, here: &Vertex, corner: &Corner) -> [bool; 2] {
        let length = (corner.at - here.tip).norm();
        let [part, drive] = self.roles().map(Working::band);
        let [by_part, by_drive] = corner.leaves.map(|leaves| leaves * TOO_SHARP * length);
        [part < by_part, drive < by_drive]
    }

    /// The clearances in a corner: where it is left along another contact, not at the limit that a vector about it goes beyond.
    fn targets_in(&self, here: &Vertex, corner: &Corner, mut targets: [f64; 2]) -> [f64; 2] {
        let is_sharp = self.sharpness(here, corner);
        for ((target, role), is_sharp) in targets.iter_mut().zip(self.roles()).zip(is_sharp) {
            if is_sharp {
                *target = target.min(role.outside - ROUNDED * role.band());
            }
        }
        targets
    }

    /// How far beyond a corner a vector may end there; `None` where no contact is left.
    fn room(&self, corner: &Corner, targets: [f64; 2]) -> Option<f64> {
        let roles = self.roles().into_iter().zip(targets).zip(corner.leaves);
        let rooms = roles.map(|((role, target), leaves)| (role.outside - target) / leaves);
        Some(rooms.fold(f64::INFINITY, f64::min)).filter(|room| room.is_finite() && *room > 0.0)
    }
}

/// Where the tangents of two positions of the path meet, which they have to do near them unless it is square.
fn corner_between(here: &Vertex, before: &Vertex, beyond: &Vertex, is_square: bool) -> Option<Corner> {
    let [behind, ahead] = ways_to_meeting(before, beyond)?;
    let at = before.tip + before.tangent * behind;
    if !is_square && behind + ahead > NEAR * (at - here.tip).norm() {
        return None;
    }
    // Into a corner the path comes along another contact than it leaves it; about the end of a surface it bends without that.
    let leaves = |a: &Contact, b: &Contact| (a.gradient - b.gradient).dot(&beyond.tangent).max(0.0);
    Some(Corner {
        at,
        tangents: [before.tangent, beyond.tangent],
        leaves: [leaves(&before.part, &beyond.part), leaves(&before.drive, &beyond.drive)],
    })
}

/// How far it is to where the lines of motion at two positions are nearest to each other: onward from the first one, and back from the
/// other one.
fn ways_to_meeting(before: &Vertex, beyond: &Vertex) -> Option<[f64; 2]> {
    let (way, cosine) = (beyond.tip - before.tip, before.tangent.dot(&beyond.tangent));
    let square_of_sine = 1.0 - cosine * cosine;
    if square_of_sine < TELLING_SINE * TELLING_SINE {
        return None;
    }
    let along = [before.tangent.dot(&way), beyond.tangent.dot(&way)];
    let ways = [0, 1].map(|k: usize| (along[k] - cosine * along[1 - k]) / square_of_sine);
    ways.iter().all(|way| *way > 0.0).then_some(ways)
}
