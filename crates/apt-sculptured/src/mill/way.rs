//! The way of the tool from one location to the next (sculptured surfaces reference 4.6): locations that are clear say
//! nothing of what stands between them.

use apt_geometry::Vec3;

use super::{Job, Sink};
use crate::{
    check::{Hit, Question},
    tool::Pose,
};

/// Most poses that are checked on one way.
const MOST_POSES: f64 = 64.0;

/// A location that was put out.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stand {
    pub(super) pose: Pose,
    /// Whether the tool is clear there.
    pub(super) clear: bool,
}

/// Where the tool is deepest on a way.
#[derive(Debug, Clone, Copy)]
pub(super) struct OnTheWay {
    pub(super) pose: Pose,
    pub(super) hit: Hit,
}

impl Job<'_> {
    /// The deepest pose of the way from the last location, if one is deeper than a way may be: a chord that just keeps the
    /// band on a concave surface is deeper than INTOL by rounding and by what its curvature did not tell, so that a whole
    /// band more is asked for. Nothing is said of ways from or to locations that are not clear.
    ///
    /// Poses `d` apart of a tool whose sharpest rounding has the radius R leave crests of `d²/8R` between them: here a band.
    pub(super) fn on_the_way(&self, to: &Stand, sink: &mut Sink<'_>) -> Option<OnTheWay> {
        let from = sink.last.filter(|last| last.clear && to.clear && !self.checked.is_empty())?.pose;
        let band = self.setting.inside + self.setting.outside;
        let corner = self.tool.corner_radius();
        let round = if corner > 0.0 { corner } else { self.tool.corner_offset() } + self.thickness();
        let apart = (8.0 * round.max(0.0) * band).sqrt();
        let chord: Vec3 = to.pose.end - from.end;
        // The top of the tool moves farther than its end where the axis turns.
        let length = chord.norm() + (to.pose.axis - from.axis).norm() * self.tool.reach();
        if length <= apart {
            return None;
        }
        let pieces = (length / apart).ceil().min(MOST_POSES + 1.0);
        let mut question = self.question();
        question.threshold += band;
        let mut worst: Option<OnTheWay> = None;
        for piece in 1..pieces as u32 {
            let share = f64::from(piece) / pieces;
            let axis = from.axis * (1.0 - share) + to.pose.axis * share;
            let pose =
                Pose { end: from.end + chord * share, axis: axis.try_normalize(0.0).unwrap_or(from.axis) };
            let deepest = self.deepest(&pose, &question, sink);
            if let Some(hit) = deepest
                && worst.is_none_or(|worst| hit.depth > worst.hit.depth)
            {
                worst = Some(OnTheWay { pose, hit });
            }
        }
        worst
    }

    /// The deepest point of a pose, counted among the checks.
    pub(super) fn deepest(&self, pose: &Pose, question: &Question<'_>, sink: &mut Sink<'_>) -> Option<Hit> {
        if sink.checker.is_idle() {
            return None;
        }
        let report = sink.checker.check(pose, question);
        sink.milled.unproved += u32::from(!report.proved);
        sink.milled.cost = sink.checker.cost();
        report.worst
    }
}
