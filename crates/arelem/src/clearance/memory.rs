//! What the last search for a contact leaves for the next one near by: where contact was, and the proof that it was the
//! nearest.
//!
//! A point of the tool comes nearer to a surface by no more than it moves, and what bounds the bend of the distance in a ball
//! holds for all positions in it. Most patches of the tool need no second look.

use std::cell::{Cell, RefCell};

use apt_geometry::{Vec3, surface::Nearer};

use super::{
    Contact, Tool,
    certify::Proof,
    crease::Spot,
    near::Contacts,
    quadric::Start,
    search::Courses,
    tool::{Piece, are_same},
};

/// How many times the last steps the tool may move before the bends are looked at again.
const FORESIGHT: f64 = 3.0;
/// What is left of the length of a step with the next one, if that is shorter.
const FADING: f64 = 0.7;
/// Way of the tool, in radii of it, over which contact may jump back to where it was before.
const BACK: f64 = 0.1;

/// For how many contacts at most parts of a surface are not asked that were asked in vain.
const LONGEST_PAUSE: u32 = 32;

/// Where on the tool contact was.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// Index of the piece.
    pub(super) piece: usize,
    /// The point of contact from the tool end.
    pub(super) point: Vec3,
    /// On which side of a circle it is, and the multiplier of its nearest point on a quadric.
    pub(super) start: Option<Start>,
}

impl Place {
    /// Where to begin on the circle.
    pub(super) fn start(&self, tool: &Tool) -> Start {
        self.start.unwrap_or_else(|| {
            let radial = tool.split(&self.point).2;
            let direction = [radial.dot(&tool.across[0]), radial.dot(&tool.across[1])];
            Start { direction, multiplier: None }
        })
    }
}

#[derive(Debug, Clone)]
struct Known {
    /// The last tool end asked for.
    tip: Vec3,
    axis: Vec3,
    side: f64,
    place: Place,
    /// Where contact was on another piece of the tool.
    other: Option<Other>,
    /// How far the tool moved lately between two contacts.
    stride: f64,
    proof: Option<Proof>,
}

/// A place on another piece of the tool than the last contact.
#[derive(Debug, Clone, Copy)]
struct Other {
    place: Place,
    /// The last tool end at which contact was there.
    left: Vec3,
    /// A tool end, and how much farther from the surface the tool was there than in contact.
    farther: Option<(Vec3, f64)>,
}

impl Other {
    /// Whether contact may be there again: the tool has moved little since it was, and each place comes nearer, or goes away, by no more than the
    /// tool moves.
    fn may_touch(&self, tool: &Tool, tip: &Vec3) -> bool {
        let is_farther = |(at, by): &(Vec3, f64)| 2.0 * (tip - at).norm() < *by;
        (tip - self.left).norm() <= BACK * tool.radius() && !self.farther.as_ref().is_some_and(is_farther)
    }
}

impl Known {
    fn is_of(&self, tool: &Tool, side: f64) -> bool {
        self.side == side && tool.has_axis(&self.axis)
    }
}

/// Positions of which it is remembered what was shown there: the ends of a vector and of some that are tried, and places between.
const MOST_SHOWN: usize = 8;

/// A level that no part of the tool is below in a position.
#[derive(Debug, Clone, Copy)]
struct Shown {
    tip: Vec3,
    axis: Vec3,
    side: f64,
    level: f64,
}

/// What parts of the surface showed of contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ByParts {
    /// The last one, where they took less than patches of the tool: they are asked first about the next.
    Cheaper,
    /// The last one, where patches of the tool did not decide: so are they.
    Needed,
    /// Not the last one: for so many contacts they are not asked after few patches, and for so many when that is in vain again.
    Not { pause: u32, next: u32 },
}

impl Default for ByParts {
    fn default() -> Self {
        Self::Not { pause: 0, next: 1 }
    }
}

impl ByParts {
    /// Whether they showed the last contact.
    pub(super) fn showed(self) -> bool {
        matches!(self, Self::Cheaper | Self::Needed)
    }

    /// Whether they are asked after few patches.
    pub(super) fn is_worthwhile(self) -> bool {
        !matches!(self, Self::Not { pause: 1.., .. })
    }

    /// After they have been asked in vain.
    pub(super) fn in_vain(self) -> Self {
        match self {
            Self::Not { next, .. } => Self::Not { pause: next, next: (2 * next).min(LONGEST_PAUSE) },
            Self::Cheaper | Self::Needed => Self::Not { pause: 1, next: 2 },
        }
    }

    /// After a contact that was shown without them, or not at all.
    pub(super) fn without(self) -> Self {
        match self {
            Self::Not { pause, next } => Self::Not { pause: pause.saturating_sub(1), next },
            Self::Cheaper | Self::Needed => Self::default(),
        }
    }
}

/// Remembers the contact of one tool with one surface. It changes what a search costs, never what it finds.
#[derive(Debug, Default, Clone)]
pub struct Memory {
    known: RefCell<Option<Known>>,
    /// The same for surfaces with charts.
    pub(super) near: RefCell<Contacts>,
    /// The place of an edge of the surface that contact was at last, if it was at one, and the side.
    crease: Cell<Option<(f64, Spot)>>,
    /// The same of places that are only passed through, where nothing is proven.
    crease_passed: Cell<Option<(f64, Spot)>>,
    /// What parts of the surface showed of the last contact.
    by_parts: Cell<ByParts>,
    /// The place of the surface that was too near to a tool that turns, and the side.
    too_near: Cell<Option<(f64, Nearer)>>,
    /// How distances bend in balls about the axis of a tool whose flank was in contact.
    pub(super) courses: Courses,
    /// What was shown last, in turn.
    shown: RefCell<(usize, [Option<Shown>; MOST_SHOWN])>,
}

/// Memories do not tell gauges apart.
impl PartialEq for Memory {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Memory {
    /// Where contact was, if that was with the same axis on the same side.
    pub(super) fn place(&self, tool: &Tool, side: f64) -> Option<Place> {
        let known = self.known.try_borrow().ok()?;
        known.as_ref().filter(|known| known.is_of(tool, side)).map(|known| known.place)
    }

    /// The same, and where contact was on another piece before, if it may be there again.
    pub(super) fn places(&self, tool: &Tool, side: f64, tip: &Vec3) -> Option<(Place, Option<Place>)> {
        let known = self.known.try_borrow().ok()?;
        let known = known.as_ref().filter(|known| known.is_of(tool, side))?;
        let other = known.other.as_ref().filter(|other| other.may_touch(tool, tip));
        Some((known.place, other.map(|other| other.place)))
    }

    /// Keeps by how much farther from the surface than in contact the tool is at the place on the other piece.
    pub(super) fn note_farther(&self, tip: &Vec3, by: f64) {
        let Ok(mut known) = self.known.try_borrow_mut() else { return };
        if let Some(other) = known.as_mut().and_then(|known| known.other.as_mut()) {
            other.farther = Some((*tip, by));
        }
    }

    /// Whether there is a last contact near a surface with charts, on a side, that the next one can be followed from.
    pub(super) fn has_last(&self, side: f64) -> bool {
        self.near.try_borrow().is_ok_and(|near| near.has_last(side))
    }

    /// Keeps what a contact was shown to be in a position.
    pub(super) fn remember_level(&self, axis: &Vec3, side: f64, tip: &Vec3, level: f64) {
        let Ok(mut shown) = self.shown.try_borrow_mut() else { return };
        let (next, places) = &mut *shown;
        places[*next] = Some(Shown { tip: *tip, axis: *axis, side, level });
        *next = (*next + 1) % MOST_SHOWN;
    }

    /// Whether a contact in exactly this position was shown to be at least a level.
    pub(super) fn has_shown(&self, axis: &Vec3, side: f64, tip: &Vec3, level: f64) -> bool {
        let is_there = |shown: &Shown| {
            shown.level >= level
                && shown.side == side
                && are_same(&shown.tip, tip)
                && are_same(&shown.axis, axis)
        };
        self.shown.try_borrow().is_ok_and(|shown| shown.1.iter().flatten().any(is_there))
    }

    /// What is proven of the tool about there; the proof is taken out.
    pub(super) fn proof(&self, tool: &Tool, side: f64, tip: &Vec3) -> Proof {
        let Ok(mut known) = self.known.try_borrow_mut() else { return Proof::of_tool(tool) };
        let Some(known) = known.as_mut().filter(|k| k.side == side) else { return Proof::of_tool(tool) };
        let step = (tip - known.tip).norm() + tool.reach() * (tool.axis - known.axis).norm();
        known.stride = step.max(FADING * known.stride);
        let mut proof = known.proof.take().filter(Proof::serves).unwrap_or_else(|| Proof::of_tool(tool));
        proof.spread = FORESIGHT * known.stride;
        proof
    }

    /// Keeps a proof that was taken out.
    pub(super) fn keep_proof(&self, side: f64, proof: Proof) {
        let Ok(mut known) = self.known.try_borrow_mut() else { return };
        if let Some(known) = known.as_mut().filter(|k| k.side == side) {
            known.proof = Some(proof);
        }
    }

    /// Keeps where a contact is that was proven without patches.
    pub(super) fn remember(&self, tool: &Tool, side: f64, tip: &Vec3, place: Place) {
        let Ok(mut memory) = self.known.try_borrow_mut() else { return };
        match memory.as_mut() {
            Some(known) if known.side == side => {
                if known.place.piece != place.piece {
                    known.other = Some(Other { place: known.place, left: known.tip, farther: None });
                }
                (known.tip, known.axis, known.place) = (*tip, tool.axis, place);
            }
            _ => {
                *memory = Some(Known {
                    tip: *tip,
                    axis: tool.axis,
                    side,
                    place,
                    other: None,
                    stride: 0.0,
                    proof: None,
                });
            }
        }
    }

    /// The place of an edge of the surface that contact was at last on a side, if it was at one.
    pub(super) fn crease(&self, side: f64) -> Option<Spot> {
        self.crease.get().filter(|(seen, _)| *seen == side).map(|(_, spot)| spot)
    }

    /// Keeps whether contact is at an edge of the surface, and where.
    pub(super) fn remember_crease(&self, side: f64, spot: Option<Spot>) {
        self.crease.set(spot.map(|spot| (side, spot)));
    }

    /// The place of an edge that contact was at where it was only passed through last, on a side, if it was at one.
    pub(super) fn crease_passed(&self, side: f64) -> Option<Spot> {
        self.crease_passed.get().filter(|(seen, _)| *seen == side).map(|(_, spot)| spot)
    }

    /// Keeps whether a contact that is only passed through is at an edge of the surface, and where.
    pub(super) fn pass_crease(&self, side: f64, spot: Option<Spot>) {
        self.crease_passed.set(spot.map(|spot| (side, spot)));
    }

    /// What parts of the surface showed of the last contact.
    pub(super) fn by_parts(&self) -> ByParts {
        self.by_parts.get()
    }

    /// Keeps what they showed.
    pub(super) fn show_by_parts(&self, by_parts: ByParts) {
        self.by_parts.set(by_parts);
    }

    /// The place of the surface that was too near to a tool on a side the last time that one was on its way.
    pub(super) fn too_near(&self, side: f64) -> Option<Nearer> {
        self.too_near.get().filter(|(seen, _)| *seen == side).map(|(_, place)| place)
    }

    /// Keeps such a place.
    pub(super) fn remember_too_near(&self, side: f64, place: Nearer) {
        self.too_near.set(Some((side, place)));
    }

    /// Keeps a contact at the tool's corner.
    pub(super) fn remember_corner(&self, tool: &Tool, side: f64, tip: &Vec3, contact: &Contact) {
        let center = &tool.profile.center;
        if center.radius == 0.0 {
            return;
        }
        let corner = tool.pieces.iter().position(|piece| {
            matches!(piece, Piece::Ring { radius, height, .. } if *radius == center.radius && *height == center.height)
        });
        if let Some(piece) = corner {
            self.remember(tool, side, tip, Place { piece, point: contact.tool - tip, start: None });
        }
    }
}
