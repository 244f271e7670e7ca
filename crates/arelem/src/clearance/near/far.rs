//! The ends of the tool, beyond what a steady ball holds: that they are far from the surface is shown once for many positions.

use apt_geometry::Vec3;

use super::{
    AHEAD, Near, PATIENCE, Pose, Zone,
    held::{Held, Rest},
};
use crate::clearance::{
    certify::{Certificate, Effort, Face, Proof, certify},
    patch::flank_between,
};

/// Ends of the tool that are remembered: above one height and another, below it or behind, here and there.
const MOST_FAR: usize = 9;
/// Shares of the radius by which the flank is first shown to be farther away than contact, and then less.
const FAR: [f64; 4] = [0.5, 0.25, 0.1, 0.02];
/// The same where the sizes of the surface's parts show it, which gives as much more as they do.
const APART: [f64; 4] = [0.1, 0.02, 0.005, 0.001];
/// Share of the radius that is to be left of that above the level of the contact, or the tool may have moved since.
const RESERVE: f64 = 0.04;

/// An end of the tool, beyond what a ball holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End {
    /// The flank above a height.
    Above(f64),
    /// All below a height of the flank.
    Below(f64),
    /// What is not held about a contact on the other side of a part.
    Behind(Rest),
}

impl End {
    /// Whether another one is part of it, in a position of the tool.
    pub(super) fn has(self, other: Self, pose: &Pose<'_>) -> bool {
        match (self, other) {
            (Self::Above(own), Self::Above(from)) => own <= from,
            (Self::Below(own), Self::Below(to)) => own >= to,
            (Self::Behind(own), Self::Behind(other)) => pose.is_behind(&other, &own),
            _ => false,
        }
    }

    fn number(self) -> usize {
        match self {
            Self::Above(_) => 0,
            Self::Below(_) => 1,
            Self::Behind(_) => 2,
        }
    }
}

/// An end of the tool keeps a distance.
#[derive(Debug, Clone, Copy)]
pub(super) struct Far {
    pub(super) side: f64,
    /// The position in which that was shown.
    tip: Vec3,
    axis: Vec3,
    pub(super) end: End,
    level: f64,
}

/// What showed last that the flank above a height is farther away, and by which of the shares.
#[derive(Debug, Clone)]
pub(super) struct Flank {
    from: f64,
    /// Above this height balls are off the surface.
    to: f64,
    size: usize,
    proof: Proof,
}

/// Where an end of the tool was not shown to be far, and where no farther than is needed.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Doubts {
    doubtful: Option<Vec3>,
    without_reserve: Option<Vec3>,
}

impl Zone {
    /// The ends of the tool beyond it: above, below, and behind.
    pub(super) fn ends(&self, pose: &Pose<'_>) -> [Option<End>; 3] {
        let Held { low, top, cap, .. } = self.held;
        let above = (top < pose.tool.profile.top.height).then_some(End::Above(top));
        let below = (low > 0.0).then_some(End::Below(low));
        [above, below, cap.map(|cap| End::Behind(cap.rest))]
    }
}

impl Near {
    /// Whether an end of the tool is not nearer than a level.
    pub(super) fn is_alone(&mut self, pose: &Pose<'_>, end: End, level: f64, far: &mut Vec<Far>) -> bool {
        let keeps = |far: &Far| far.end.has(end, pose) && far.left(pose) >= level;
        let serves = |far: &Far| keeps(far) && far.has_reserve(pose, level);
        if let Some(known) = far.iter().position(serves) {
            far[..=known].rotate_right(1);
            return true;
        }
        let kept = far.iter().any(keeps);
        let patient = |tried: &Option<Vec3>| {
            tried.is_some_and(|tried| (pose.tip - tried).norm() <= PATIENCE * pose.scale())
        };
        let doubts = &self.doubts[end.number()];
        if patient(if kept { &doubts.without_reserve } else { &doubts.doubtful }) {
            return kept;
        }
        let end = match end {
            End::Behind(rest) => End::Behind(rest.wider()),
            _ => end,
        };
        let shown = APART.iter().find_map(|share| pose.apart_of(end, level.abs() + share * pose.scale()));
        let shown = match end {
            End::Above(from) if shown.is_none() && !kept => self.shown_far(pose, from, level),
            _ => shown,
        };
        let doubts = &mut self.doubts[end.number()];
        let Some(level) = shown else {
            *(if kept { &mut doubts.without_reserve } else { &mut doubts.doubtful }) = Some(*pose.tip);
            return kept;
        };
        *doubts = Doubts::default();
        far.truncate(MOST_FAR - 1);
        far.insert(0, Far { side: pose.side, tip: *pose.tip, axis: pose.tool.axis, end, level });
        true
    }

    /// What the flank above a height is shown to keep patch by patch, farther away than a level.
    fn shown_far(&mut self, pose: &Pose<'_>, from: f64, level: f64) -> Option<f64> {
        let face = Face { surface: pose.surface, side: pose.side };
        let mut flank = self.flank.take().filter(|flank| flank.from == from);
        let first = flank.as_ref().map_or(0, |flank| flank.size);
        for (size, share) in FAR.iter().enumerate().skip(first) {
            let level = level + share * pose.scale();
            let to = pose.off_above(from, level);
            let serves = flank.take().filter(|flank| flank.to >= to && flank.proof.serves());
            let mut known = serves.unwrap_or_else(|| {
                let patch = flank_between(pose.tool, [from, to]);
                Flank { from, to, size, proof: Proof::of(vec![patch]) }
            });
            (known.size, known.proof.spread) = (size, AHEAD * pose.scale());
            let is_far = to <= from
                || certify(face, pose.tool, pose.tip, level, &mut known.proof, None, Effort::All)
                    == Certificate::Holds;
            flank = Some(known);
            if is_far {
                self.flank = flank;
                return Some(level);
            }
        }
        None
    }
}

impl Far {
    /// What the end of the tool keeps in another position: its points move no farther than the end does and the turn of the axis takes the
    /// farthest of them.
    pub(super) fn left(&self, pose: &Pose<'_>) -> f64 {
        self.level - pose.moved_from(&self.tip, &self.axis)
    }

    /// Whether more than a level is left, unless the tool has hardly moved since: moves are bounded by what is left.
    fn has_reserve(&self, pose: &Pose<'_>, level: f64) -> bool {
        let (left, reserve) = (self.left(pose), RESERVE * pose.scale());
        left >= level + reserve || self.level - left <= reserve
    }
}
