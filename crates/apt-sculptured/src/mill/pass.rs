//! One pass along the guide (SSPATH, sculptured surfaces reference 4.1).

use apt_geometry::regional::FeedDirection;

use super::{
    Job, Sink,
    station::{Course, Station},
    way::Stand,
};
use crate::{
    error::{MillingError, Reduction},
    tool::Pose,
};

/// Most reductions of one step (3552).
const MOST_REDUCTIONS: usize = 20;
/// How a step shrinks when there is no location at its end.
const WITHOUT_LOCATION: f64 = 0.5;
/// How a step shrinks at least, and at most, when the tool moved too far.
const SHRINK: [f64; 2] = [0.1, 0.75];
/// A move so many times as long as allowed leads to another part of the surface.
const JUMP: f64 = 5.0;
/// How much longer than the last one a step may be.
const GROWTH: f64 = 5.0;
/// Share of MAXDP that is tried for the end of the tool.
const CAUTION: f64 = 0.95;
/// How often a step is halved for what stands on the way to its end, where the tolerances do not end it before.
const MOST_HALVINGS: usize = 16;
/// Share of a step that is not worth a step of its own at the end of a pass.
const REST: f64 = 1e-3;
/// Difference of two tool ends, relative to the part surface, and of their unit axes that is rounding.
const SAME_PLACE: f64 = 1e-9;
/// Excess of a move over what is allowed that is rounding.
const MOVE_SLACK: f64 = 1e-9;

impl Job<'_> {
    /// Follows the guide from a station, which is not put out, to a limit of the running parameter. All stations.
    pub(super) fn pass(
        &self,
        first: Station,
        course: &Course,
        limit: f64,
        sink: &mut Sink<'_>,
    ) -> Result<Vec<Station>, MillingError> {
        let mut stations = vec![first];
        let mut last = first;
        let mut step = self.intended_move(&first, course.stock) / first.guide.along.norm();
        // All reductions since the last location, and those for want of a place since one was reached without: near the end
        // of what the tool can reach each location comes after some.
        let (mut reductions, mut dead_ends) = (0, 0);
        let mut halvings = 0;
        loop {
            let running = last.running(course.direction);
            let left = (limit - running) * course.sign;
            if left <= 0.0 {
                return Ok(stations);
            }
            self.cancelled()?;
            let target = self.target(running, step, limit, course);
            let mut parameters = last.parameters;
            match course.direction {
                FeedDirection::Spline => parameters[0] = target,
                FeedDirection::CrossSpline => parameters[1] = target,
            }
            let tried = (target - running).abs();
            match self.try_step(&last, parameters, course) {
                // Along an edge of the guide that is one point the tool stays where it is.
                Ok((next, _)) if target != running && self.stands_still(&last.pose, &next.pose) => {
                    step = tried * GROWTH;
                    last = next;
                    stations.push(next);
                }
                Ok((next, moved)) => {
                    let unproved = sink.milled.unproved;
                    let found = self.freed(&next, course, sink);
                    let way = self.on_the_way(&found.stand, sink);
                    // What stands between two locations is met at one, where the tool can be avoided. Closer ones than the
                    // band would change no depth by more than it: what is left is told.
                    let half = 0.5 * tried;
                    let can_halve = moved > self.setting.inside + self.setting.outside
                        && halvings < MOST_HALVINGS
                        && running + course.sign * half != running;
                    if way.is_some() && can_halve {
                        sink.milled.unproved = unproved;
                        halvings += 1;
                        step = half;
                        continue;
                    }
                    halvings = 0;
                    if !found.met_anything() {
                        self.put_between(&last.pose, &next.pose, sink)?;
                    }
                    self.put_freed(&next, found, way, sink)?;
                    let intended = self.intended_move(&next, course.stock) / moved;
                    // A tool end that swings about the ball goes farther than the ball.
                    let swung = (next.pose.end - last.pose.end).norm();
                    let admissible = CAUTION * self.setting.maximum_step / swung;
                    // Where nothing moved there is no ratio, and the step just grows.
                    step = tried * intended.min(admissible).min(GROWTH);
                    if reductions == 0 {
                        dead_ends = 0;
                    }
                    reductions = 0;
                    last = next;
                    stations.push(next);
                }
                Err((cause, factor)) => {
                    reductions += 1;
                    let jumped =
                        matches!(cause, Reduction::TooFar { moved, allowed } if moved > JUMP * allowed);
                    if jumped || matches!(cause, Reduction::Station(_) | Reduction::Misfit { .. }) {
                        dead_ends += 1;
                    }
                    let stands = running + course.sign * tried * factor == running;
                    if reductions.max(dead_ends) > MOST_REDUCTIONS || stands {
                        let parameters = last.parameters;
                        return Err(MillingError::TooManyReductions {
                            parameters,
                            reductions: MOST_REDUCTIONS,
                            cause,
                        });
                    }
                    step = tried * factor;
                }
            }
        }
    }

    /// Whether two locations are one but for rounding.
    fn stands_still(&self, from: &Pose, to: &Pose) -> bool {
        (to.end - from.end).norm() <= SAME_PLACE * self.size && (to.axis - from.axis).norm() <= SAME_PLACE
    }

    /// Places on the straight way between two locations, so that no move is longer than MAXDP. The ball has gone no farther
    /// than that, but the end of the tool may: where a flat bottom lies on the surface the contact goes from one side of it
    /// to the other at once, however short the step.
    fn put_between(&self, from: &Pose, to: &Pose, sink: &mut Sink<'_>) -> Result<(), MillingError> {
        // Only on from a location that was put out as it is.
        if sink.last.is_none_or(|last| last.pose != *from) {
            return Ok(());
        }
        let chord = to.end - from.end;
        let moves = (chord.norm() / self.setting.maximum_step * (1.0 - MOVE_SLACK)).ceil();
        if !moves.is_finite() {
            return Ok(());
        }
        let clear = sink.last.is_some_and(|last| last.clear);
        let mut done = 1.0;
        while done < moves {
            let share = done / moves;
            let axis = from.axis * (1.0 - share) + to.axis * share;
            let pose =
                Pose { end: from.end + chord * share, axis: axis.try_normalize(0.0).unwrap_or(from.axis) };
            sink.location(self, Stand { pose, clear })?;
            done += 1.0;
        }
        Ok(())
    }

    /// Where a step leads: not beyond the limit, nor beyond where arcs of a guide curve meet.
    fn target(&self, running: f64, step: f64, limit: f64, course: &Course) -> f64 {
        let mut target = limit;
        if let Some(junction) = self.guide.junction(running, course.sign)
            && (limit - junction) * course.sign > 0.0
        {
            target = junction;
        }
        if (target - running) * course.sign > step * (1.0 + REST) {
            target = running + course.sign * step;
        }
        target
    }

    /// The next station and the move of the ball, or why not and by what the step shrinks.
    fn try_step(
        &self,
        last: &Station,
        parameters: [f64; 2],
        course: &Course,
    ) -> Result<(Station, f64), (Reduction, f64)> {
        let next = self
            .station(parameters, course, Some(last))
            .map_err(|cause| (Reduction::Station(cause), WITHOUT_LOCATION))?;
        let ball = self.ball_radius(course.stock);
        let [sharpest, _] = next.contact.curvature().principal();
        if !self.part_is_guide && !next.contact.on_crease && sharpest * ball > 1.0 {
            let cause = Reduction::Misfit { radius: 1.0 / sharpest, tool: ball };
            return Err((cause, WITHOUT_LOCATION));
        }
        let allowed = self.greatest_move(last, &next, course.stock);
        let moved = (next.center - last.center).norm();
        if moved > allowed * (1.0 + MOVE_SLACK) {
            let factor = (allowed / moved).clamp(SHRINK[0], SHRINK[1]);
            return Err((Reduction::TooFar { moved, allowed }, factor));
        }
        if self.command.check_chords {
            self.chord(last, &next, course)?;
        }
        Ok((next, moved))
    }
}
