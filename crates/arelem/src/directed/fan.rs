//! FAN: the axis turns evenly from where the motion begins to the axis that TANDS gives where it ends. Where that is, passes
//! tell: the first with the present axis, each of the others with the fan to the end of the one before.

use super::{Path, Prepared, Stuck};
use crate::{
    attitude::Attitude,
    error::{AxisFailure, MotionFailure},
};

/// Bound of the passes until the end stays where it is.
const PASSES: u32 = 16;
/// How far, relative to the size of the coordinates, it may move in the last.
const SETTLED: f64 = 1e-9;

/// The path with the axis turning evenly, and what it was computed with. `prepared` holds the axis of TANDS.
pub(super) fn follow<'a>(
    prepared: Prepared<'a>,
    path: &dyn Fn(&Prepared<'_>) -> Result<Path, Stuck>,
) -> Result<(Prepared<'a>, Path), Stuck> {
    if !prepared.attitude.turns() {
        let only = path(&prepared)?;
        return Ok((prepared, only));
    }
    let fixed = prepared.with(Attitude::fixed(prepared.tool.clone()));
    let first = path(&fixed)?;
    let undetermined = |cause, tip| MotionFailure::AxisUndetermined { cause, tip };
    let mut end = first.points.last().copied().unwrap_or(prepared.tip);
    let mut moved = f64::INFINITY;
    for _ in 0..PASSES {
        let axis = prepared.attitude.tool_at(&end)?.axis;
        let begin = (&prepared.tool.axis, &prepared.tip);
        let attitude = prepared.attitude.fanned(begin, (&axis, &end));
        let fanned = prepared.with(attitude.map_err(|cause| undetermined(cause, end))?);
        let found = path(&fanned)?;
        let last = found.points.last().copied().unwrap_or(prepared.tip);
        moved = (last - end).norm();
        if moved <= SETTLED * prepared.size {
            return Ok((fanned, found));
        }
        end = last;
    }
    Err(undetermined(AxisFailure::NotSettled { change: moved / prepared.size }, end).into())
}
