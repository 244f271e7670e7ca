//! FAN: the axis turns evenly from where the motion begins to the axis that TANDS gives where it ends. Where that is, passes
//! tell: the first with the axis of TANDS all along, which stands at the end as the fan does, or with the present one where that leads
//! nowhere; each of the others with the fan to where those before say that it ends, and aimed at that place.

use apt_geometry::Vec3;

use super::{Path, Prepared, Stuck};
use crate::{
    attitude::Attitude,
    error::{AxisFailure, MotionFailure},
};

/// Bound of the passes until the end stays where it is.
const PASSES: u32 = 16;
/// How far, relative to the size of the coordinates, it may move in the last.
const SETTLED: f64 = 1e-9;
/// How far off the surface an axis may lead at the top of the tool, as a share of the band, where motions end now here, now there in their
/// band.
const AMISS: f64 = 0.01;
/// How many times as far as the last two ends are apart the next may be looked for from them.
const FARTHEST: f64 = 8.0;

/// The path with the axis turning evenly, and what it was computed with. `prepared` holds the axis of TANDS.
pub(super) fn follow<'a>(
    prepared: Prepared<'a>,
    path: &dyn Fn(&Prepared<'_>) -> Result<Path, Stuck>,
) -> Result<(Prepared<'a>, Path), Stuck> {
    if !prepared.attitude.turns() {
        let only = path(&prepared)?;
        return Ok((prepared, only));
    }
    let end = |path: &Path| path.points.last().copied().unwrap_or(prepared.tip);
    let undetermined = |cause, tip| MotionFailure::AxisUndetermined { cause, tip };
    let fixed = || prepared.with(Attitude::fixed(prepared.tool.clone()));
    let first = path(&prepared).or_else(|stuck| path(&fixed()).map_err(|_| stuck))?;
    let mut guess = Guess { asked: end(&first), last: None };
    let mut nearest: Option<(f64, Prepared<'a>, Path)> = None;
    for _ in 0..PASSES {
        let asked = guess.asked;
        let pass = || -> Result<(Prepared<'a>, Path), Stuck> {
            let axis = prepared.attitude.tool_at(&asked)?.axis;
            let begin = (&prepared.tool.axis, &prepared.tip);
            let attitude = prepared.attitude.fanned(begin, (&axis, &asked));
            let fanned = prepared.with(attitude.map_err(|cause| undetermined(cause, asked))?).aimed_at(asked);
            let found = path(&fanned)?;
            Ok((fanned, found))
        };
        match pass() {
            Ok((fanned, found)) => {
                let end = end(&found);
                let moved = (end - asked).norm();
                if moved <= SETTLED * prepared.size {
                    return Ok((fanned, found));
                }
                guess = guess.after(end);
                if nearest.as_ref().is_none_or(|(least, ..)| moved < *least) {
                    nearest = Some((moved, fanned, found));
                }
            }
            Err(stuck) => guess = guess.without_foresight().ok_or(stuck)?,
        }
    }
    let change = nearest.as_ref().map_or(f64::INFINITY, |(moved, ..)| moved / prepared.size);
    if let Some((_, fanned, found)) = nearest {
        let last = end(&found);
        let amiss = (fanned.attitude.tool_at(&last)?.axis - prepared.attitude.tool_at(&last)?.axis).norm();
        if amiss * prepared.drive.gauge.reach(&prepared.tool) <= AMISS * prepared.drive.band() {
            return Ok((fanned, found));
        }
    }
    Err(undetermined(AxisFailure::NotSettled { change }, guess.asked).into())
}

/// Where the motion is taken to end, with the last one and where it ended then.
struct Guess {
    asked: Vec3,
    last: Option<[Vec3; 2]>,
}

impl Guess {
    /// The next one, from where the motion ended with this: there, but where what is left has changed in proportion, where nothing is
    /// left (Anderson's mixing of two).
    fn after(&self, end: Vec3) -> Self {
        let foreseen = self.last.and_then(|[asked, ended]| {
            let left = end - self.asked;
            let change = left - (ended - asked);
            let share = left.dot(&change) / change.norm_squared();
            (share.abs() <= FARTHEST).then(|| end - (end - ended) * share)
        });
        Self { asked: foreseen.unwrap_or(end), last: Some([self.asked, end]) }
    }

    /// Where the last motion ended, if this is another place.
    fn without_foresight(&self) -> Option<Self> {
        let [_, ended] = self.last?;
        (ended != self.asked).then_some(Self { asked: ended, last: None })
    }
}
