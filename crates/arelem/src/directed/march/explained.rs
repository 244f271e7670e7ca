//! Why no vector goes on, where that is not the tolerance.

use super::{March, Vertex, surface_end::just_ahead};
use crate::{
    directed::Prepared,
    error::{AxisFailure, MotionFailure},
};

/// How many times the bands ahead of a place without a way on it is looked whether the axis has a direction.
const WITHOUT_AXIS: f64 = 0.25;
/// How many times as far as its end the top of a tool goes while its axis leaps, at least.
const LEAP: f64 = 100.0;

impl March<'_> {
    /// Why no vector goes on, where that is not the tolerance: a surface ends, or the axis has no direction a little ahead.
    pub(super) fn explained(&self, here: &Vertex, failure: MotionFailure) -> MotionFailure {
        if failure == MotionFailure::Cancelled {
            return failure;
        }
        self.without_surface(here)
            .or_else(|| self.without_law(here))
            .or_else(|| self.without_axis(here))
            .unwrap_or(failure)
    }

    /// Where no vector goes on because the surface that tells the axis ends where its normal is taken, just ahead or here: that. With the axis the path
    /// may have turned on it, so that it lies behind.
    fn without_law(&self, here: &Vertex) -> Option<MotionFailure> {
        let reach = here.tangent * just_ahead(self.prepared);
        [here.tip + reach, here.tip, here.tip - reach]
            .iter()
            .find_map(|tip| self.prepared.attitude.end_of_law(tip))
    }

    /// Where no vector goes on because the axis has no direction a little ahead, or leaps to another there: that.
    fn without_axis(&self, here: &Vertex) -> Option<MotionFailure> {
        let Prepared { attitude, part, drive, .. } = self.prepared;
        let way = WITHOUT_AXIS * (part.band() + drive.band());
        let ahead = here.tip + here.tangent * way;
        let axes = [&here.tip, &ahead].map(|tip| attitude.tool_at(tip).map(|tool| tool.axis));
        match axes {
            [_, Err(failure)] => Some(failure),
            [Ok(from), Ok(to)] => {
                let angle = from.angle(&to);
                let leaps = angle * attitude.tool().reach() > LEAP * way;
                let cause = AxisFailure::Leaps { angle };
                leaps.then_some(MotionFailure::AxisUndetermined { cause, tip: ahead })
            }
            [Err(_), Ok(_)] => None,
        }
    }
}
