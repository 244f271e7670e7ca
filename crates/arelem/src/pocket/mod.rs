//! POCKET: clears a convex area by passes parallel to its sides (language reference 6.10).
//!
//! The passes are found from the outermost to the innermost ([`passes`]) and cut the other way round, each a closed
//! polygon from its first corner to its first corner. All lengths in program units, base coordinate system.

mod failure;
mod outline;
mod passes;
mod polygon;

#[cfg(test)]
mod tests;

use apt_geometry::{motion::Pocket, patience::Patience};

pub use self::failure::{CornerFault, PocketFailure};
use self::{outline::Outline, passes::Offsets};
use crate::{
    error::MotionFailure,
    section2::State,
    sequence::{PocketPass, PocketPath, ToolPosition},
};

/// Numbers of a POCKET statement whose sign is checked, in the order of the statement.
const EFFECTIVE_RADIUS: usize = 0;
const GENERAL_OFFSET: usize = 1;
const FINISH_OFFSET: usize = 2;
const PLUNGE_FEED: usize = 3;
const GENERAL_FEED: usize = 4;
const FINISH_FEED: usize = 5;

/// Computes a pocket from the modal state (tool axis, cutter, part surface) and the statement. `patience` is asked
/// once per pass.
///
/// # Errors
///
/// [`MotionFailure::Pocket`] with the APT III numbers 3501 to 3519, [`MotionFailure::NotFinite`], and
/// [`MotionFailure::Cancelled`].
pub(crate) fn clear(
    state: &State,
    pocket: &Pocket,
    patience: Patience<'_>,
) -> Result<PocketPath, MotionFailure> {
    let finite = pocket.numbers.iter().chain(pocket.points.iter().flatten()).all(|x| x.is_finite());
    if !finite {
        return Err(MotionFailure::NotFinite);
    }
    let boundary = match pocket.point_kind {
        0 | 1 => pocket.points.clone(),
        2 | 3 => outline::project(&pocket.points, &state.axis, &state.part)?,
        kind => return Err(PocketFailure::PointKind { kind }.into()),
    };
    signs(&pocket.numbers)?;
    let outline = Outline::of(&boundary, &state.axis)?;
    let cutter = state.cutter.ok_or(PocketFailure::CutterRadius { radius: 0.0 })?;
    let radius = cutter.radius();
    if radius <= 0.0 {
        return Err(PocketFailure::CutterRadius { radius }.into());
    }
    let walls = pocket.point_kind % 2 == 1;
    let outermost = if walls { outline.centers(radius)? } else { outline.polygon.clone() };
    let offsets = Offsets::new(&pocket.numbers, radius, !pocket.keep_offsets);
    let effective_radius = offsets.effective_radius;
    let rings = passes::clear(outermost, offsets, patience)?;
    let position = |point: &polygon::Vec2| ToolPosition { tip: outline.in_space(point), axis: state.axis };
    let finish = rings.first().map_or(0, Vec::len);
    let path: Vec<ToolPosition> = rings.iter().rev().flatten().map(position).collect();
    // The finishing pass is the last ring; if it is the only one its first position belongs to the plunge.
    let plunge = path.len().min(1);
    let general = path.len().saturating_sub(finish).max(plunge);
    let pass = |feed: usize, points: &[ToolPosition]| PocketPass {
        feed: pocket.numbers[feed],
        points: points.to_vec(),
    };
    Ok(PocketPath {
        passes: [
            pass(PLUNGE_FEED, &path[..plunge]),
            pass(GENERAL_FEED, &path[plunge..general]),
            pass(FINISH_FEED, &path[general..]),
        ],
        boundary,
        walls,
        axis: state.axis,
        cutter,
        effective_radius,
        tolerance: state.inside.part.max(state.outside.part),
    })
}

/// None of the numbers may be negative (3511 to 3514).
fn signs(numbers: &[f64; 6]) -> Result<(), PocketFailure> {
    if numbers[EFFECTIVE_RADIUS] < 0.0 {
        return Err(PocketFailure::NegativeEffectiveRadius { value: numbers[EFFECTIVE_RADIUS] });
    }
    for (index, finish) in [(GENERAL_OFFSET, false), (FINISH_OFFSET, true)] {
        if numbers[index] < 0.0 {
            return Err(PocketFailure::NegativeOffset { value: numbers[index], finish });
        }
    }
    match numbers[PLUNGE_FEED..].iter().find(|feed| **feed < 0.0) {
        Some(feed) => Err(PocketFailure::NegativeFeed { value: *feed }),
        None => Ok(()),
    }
}
