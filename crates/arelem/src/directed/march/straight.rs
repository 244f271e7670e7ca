//! Part and drive surface both planes: one straight vector of any length.

use apt_geometry::{motion::CheckSurface, patience::Patience};

use super::{Vertex, finish, first_stop, tangency};
use crate::{
    bound::Bent,
    directed::{Path, Prepared, is_tangent, stop::Watcher},
    error::{Course, MotionFailure},
};

/// How far ahead a stop is looked for, relative to the size of the coordinates and surfaces.
const REACH: f64 = 1e5;

pub(super) fn run(
    prepared: &Prepared,
    checks: &[CheckSurface],
    patience: Patience<'_>,
) -> Result<Path, MotionFailure> {
    let here = Vertex::at(prepared, prepared.tip, &prepared.tangent)?;
    let mut watcher = Watcher::new(prepared, checks).thorough();
    let mut tangency = tangency::Watch::new(prepared, checks, patience);
    let mut from = here;
    let mut length = prepared.size;
    let mut travelled = 0.0;
    // Stretches of growing length keep the steps of the search in proportion.
    while travelled < REACH * prepared.size {
        if patience.is_over() {
            return Err(MotionFailure::Cancelled);
        }
        let to = Vertex::at(prepared, from.tip + here.tangent * length, &here.tangent)?;
        let sweep = from.sweep(prepared, &to);
        if let Some(event) = first_stop((&mut watcher, &mut tangency), &sweep, [&from, &to])? {
            let begin = (travelled == 0.0).then_some(&prepared.tip);
            let towards = finish::Towards { event: &event, tangent: &here.tangent, held: None, begin };
            let end = finish::end(prepared, checks, (&watcher, &sweep), &towards)?;
            let bent = Bent::none(&prepared.tip);
            return Ok(Path { points: vec![end.tip], check: end.check, check_side: end.side, bent });
        }
        travelled += length;
        length *= 2.0;
        from = to;
    }
    let touched = watcher.touched;
    let (nearest, at, check) = touched.unwrap_or(watcher.nearest);
    if checks.iter().all(|c| is_tangent(c.relation)) {
        return Err(tangency.failure());
    }
    Err(if watcher.met > 0 {
        MotionFailure::NoneAhead { check, relation: checks[check].relation, found: watcher.met }
    } else {
        MotionFailure::NeverMet {
            check,
            relation: checks[check].relation,
            nearest,
            at,
            is_there: prepared.checks[check].is_as_near(nearest, prepared.size),
            is_touched: touched.is_some(),
            turns_back: None,
            course: Course::Away { travelled },
        }
    })
}
