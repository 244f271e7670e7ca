//! What the last search for a contact leaves for the next one near by: where contact was, and the patches of the tool
//! that may come into contact around there.
//!
//! A point of the tool comes nearer to a surface by no more than it moves. Patches farther away than the tool can move
//! need no second look.

use std::cell::RefCell;

use apt_geometry::Vec3;

use super::{
    Contact, Tool,
    certify::{Face, Patch, outline},
    near::Near,
    quadric::Start,
    tool::Piece,
};

/// How many times the last step the tool may move before the patches are looked at again.
const FORESIGHT: f64 = 3.0;
/// Smallest distance, relative to the tool's size, for which patches are kept.
const LEAST_SPREAD: f64 = 1e-6;

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
    outline: Option<Outline>,
}

/// The patches that matter around a tool end.
#[derive(Debug, Clone)]
struct Outline {
    tip: Vec3,
    spread: f64,
    /// Distance from the surface of all other points, with the tool end there.
    level: f64,
    patches: Vec<Patch>,
}

/// Remembers the contact of one tool with one surface. It changes what a search costs, never what it finds.
#[derive(Debug, Default, Clone)]
pub struct Memory {
    known: RefCell<Option<Known>>,
    /// The same for surfaces with charts.
    pub(super) near: RefCell<Option<Near>>,
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
        known.as_ref().filter(|k| k.axis == tool.axis && k.side == side).map(|k| k.place)
    }

    /// The patches to which a point of the tool lower than a level must belong.
    pub(super) fn patches(&self, tool: &Tool, side: f64, tip: &Vec3, level: f64) -> Option<Vec<Patch>> {
        let known = self.known.try_borrow().ok()?;
        let known = known.as_ref().filter(|k| k.axis == tool.axis && k.side == side)?;
        let outline = known.outline.as_ref()?;
        let moved = (tip - outline.tip).norm();
        (moved <= outline.spread && outline.level - moved >= level).then(|| outline.patches.clone())
    }

    /// Keeps where a contact is that was proven without patches.
    pub(super) fn remember(&self, tool: &Tool, side: f64, tip: &Vec3, place: Place) {
        let Ok(mut memory) = self.known.try_borrow_mut() else { return };
        match memory.as_mut() {
            Some(known) if known.axis == tool.axis && known.side == side => {
                (known.tip, known.place) = (*tip, place);
            }
            _ => *memory = Some(Known { tip: *tip, axis: tool.axis, side, place, outline: None }),
        }
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

    /// Keeps a contact that is proven, and the patches around it if those known do not reach so far.
    pub(super) fn keep(&self, face: Face<'_>, tool: &Tool, tip: &Vec3, place: Place, level: f64) {
        let Ok(mut memory) = self.known.try_borrow_mut() else { return };
        let known = memory.take().filter(|k| k.axis == tool.axis && k.side == face.side);
        let (last, old) = match known {
            Some(known) => (Some(known.tip), known.outline),
            None => (None, None),
        };
        let step = last.map_or(0.0, |last| (tip - last).norm());
        let reaches = old.as_ref().is_some_and(|o| (tip - o.tip).norm() <= o.spread);
        let outline = if reaches || last.is_none() {
            old
        } else {
            let least = LEAST_SPREAD * (tool.radius() + tool.profile.top.height);
            let spread = (FORESIGHT * step).max(0.5 * old.map_or(0.0, |o| o.spread)).max(least);
            let far = level + 2.0 * spread;
            outline(face, tool, tip, [level, far]).map(|patches| Outline {
                tip: *tip,
                spread,
                level: far,
                patches,
            })
        };
        *memory = Some(Known { tip: *tip, axis: tool.axis, side: face.side, place, outline });
    }
}
