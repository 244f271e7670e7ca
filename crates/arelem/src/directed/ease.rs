//! A motion that begins with another axis than TLAXIS asks for, as a GO leaves it that took the sense of a lead angle from
//! its own move: where no cut vector can turn the tool on the spot, it turns while it goes, over the first stretch.

use super::{Path, Prepared};
use crate::error::{MotionFailure, MotionWarning};

/// Length of the stretch, in what a point of the cutter's end is carried by the turn. A tool end must go ahead faster than
/// the turn carries it back.
const STRETCHES: [f64; 3] = [3.0, 8.0, 20.0];
/// Angle between two axes (radians) that needs no stretch.
const SAME_AXIS: f64 = 1e-9;
/// Distance, relative to the size of the coordinates, within which a motion is stuck at its start.
const SAME_PLACE: f64 = 1e-9;

/// The path, and what it was computed with; where the tool cannot turn on the spot at the start, with an axis that goes over
/// to that of TLAXIS. What is found out only on the way that does not lead on is not told.
pub(super) fn follow(
    prepared: Prepared,
    warnings: &mut Vec<MotionWarning>,
    path: &mut dyn FnMut(&Prepared, &mut Vec<MotionWarning>) -> Result<Path, MotionFailure>,
) -> Result<(Prepared, Path), MotionFailure> {
    let before = warnings.len();
    let failure = match path(&prepared, warnings) {
        Ok(path) => return Ok((prepared, path)),
        Err(failure) => failure,
    };
    let MotionFailure::NoAdmissibleVector { tip, .. } = failure else { return Err(failure) };
    if !prepared.attitude.turns() || (tip - prepared.tip).norm() > SAME_PLACE * prepared.size {
        return Err(failure);
    }
    let (from, to) = (prepared.tool.axis, prepared.attitude.tool_at(&tip)?.axis);
    let angle = from.cross(&to).norm().atan2(from.dot(&to));
    let arm = prepared.tool.radius() + prepared.tool.cutter.corner_height.max(0.0);
    if angle <= SAME_AXIS || arm <= 0.0 {
        return Err(failure);
    }
    for stretch in STRETCHES {
        let way = prepared.tangent * (stretch * angle * arm);
        let eased = Prepared { attitude: prepared.attitude.eased(&from, &tip, &way), ..prepared.clone() };
        let mut told = Vec::new();
        match path(&eased, &mut told) {
            Ok(path) => {
                warnings.truncate(before);
                warnings.extend(told);
                return Ok((eased, path));
            }
            Err(MotionFailure::Cancelled) => return Err(MotionFailure::Cancelled),
            Err(_) => {}
        }
    }
    Err(failure)
}
