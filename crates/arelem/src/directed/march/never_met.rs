//! What is told of a path on which no check surface is met, and when that is known of one that is closed.

use apt_geometry::Vec3;

use super::{March, Vertex, Watcher};
use crate::error::{Course, MotionFailure, TurnsBack};

/// How many bands a path may be aside from a vertex that it comes by again: it goes at either limit of both of them.
const BANDS_ASIDE: f64 = 4.0;
/// The number of the first vertex that is marked: what goes on is not compared with that which just began.
const FIRST_MARK: usize = 16;

/// A vertex that the path may come by again.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mark {
    vertex: Vertex,
    /// Its place among the points.
    index: usize,
    /// How many positions and tangencies had been met there.
    met: usize,
}

impl March<'_> {
    /// On a closed path: a whole turn without a single position means that there is none.
    pub(super) fn count_revolution(
        &mut self,
        start: &Vertex,
        from: &Vertex,
        to: &Vertex,
    ) -> Result<(), MotionFailure> {
        if self.points.len() < 3 {
            return Ok(());
        }
        self.go_round(from, to)?;
        if !self.passes(start, [from, to]) {
            return Ok(());
        }
        self.revolutions += 1;
        let wanted = self.checks.iter().map(|c| c.occurrence).max().unwrap_or(1);
        if self.watcher.met == 0 && self.tangency.met == 0 || self.revolutions > wanted {
            return Err(self.closed(start, 0));
        }
        Ok(())
    }

    /// The same of a ring that does not come by where the motion began, as that of a tool that turned on its way there: it comes by a vertex again, with
    /// no position since. Each vertex is marked that has twice the number of the one before, so that the last one is on the ring some time, and a
    /// turn later the path is there again.
    fn go_round(&mut self, from: &Vertex, to: &Vertex) -> Result<(), MotionFailure> {
        let (count, met) = (self.points.len(), self.watcher.met + self.tangency.met);
        // A vertex that has been moved since is marked anew where it is now.
        let mark = self.mark.filter(|mark| self.points.get(mark.index) == Some(&mark.vertex.tip));
        if let Some(Mark { vertex, index, met: met_there }) = &mark
            && met == *met_there
            && self.passes(vertex, [from, to])
        {
            return Err(self.closed(vertex, index + 1));
        }
        if count >= mark.map_or(FIRST_MARK, |mark| 2 * (mark.index + 1)) {
            self.mark = Some(Mark { vertex: *to, index: count - 1, met });
        }
        Ok(())
    }

    /// Whether a vector passes a vertex of the path, in the direction that it had there.
    fn passes(&self, vertex: &Vertex, [from, to]: [&Vertex; 2]) -> bool {
        let delta = to.tip - from.tip;
        let length = delta.norm();
        let along = (vertex.tip - from.tip).dot(&delta) / length;
        let aside = (vertex.tip - from.tip - delta * (along / length)).norm();
        let band = self.prepared.part.band() + self.prepared.drive.band();
        // At the end of the vector, as just beyond a corner, the path may lead elsewhere.
        let is_along = delta.dot(&vertex.tangent) > 0.5 * length;
        along > 0.0 && along <= length && aside <= BANDS_ASIDE * band && is_along
    }

    /// The path comes by a vertex again that so many of its points lead to.
    fn closed(&self, vertex: &Vertex, index: usize) -> MotionFailure {
        let vertices = std::iter::once(&vertex.tip).chain(&self.points[index..]);
        let length = vertices.clone().zip(vertices.skip(1)).map(|(a, b)| (b - a).norm()).sum();
        let nothing = (f64::INFINITY, vertex.tip, 0);
        self.never_met(nothing, Course::Closed { length }, self.watcher.met + self.tangency.met)
    }

    /// The evidence: the positions met, if they were too few, or the nearest approach on the cut vectors made and on the way
    /// ahead of them.
    pub(super) fn never_met(&self, ahead: (f64, Vec3, usize), course: Course, met: usize) -> MotionFailure {
        if met > 0 {
            let check = if self.tangency.met > 0 { self.tangency.check } else { self.watcher.nearest.2 };
            return MotionFailure::NoneAhead { check, relation: self.checks[check].relation, found: met };
        }
        let mut watcher = Watcher::new(self.prepared, self.checks).thorough();
        let mut here = Vertex::start(self.prepared);
        for point in &self.points {
            let next = Vertex::at(self.prepared, *point, &self.prepared.tangent);
            if let (Ok(from), Ok(to)) = (&here, &next) {
                watcher.scan(&from.sweep(self.prepared, to));
            }
            here = next;
        }
        let touched = self.watcher.touched.or(watcher.touched);
        let (nearest, at, check) = match touched {
            Some(touch) => touch,
            None if watcher.nearest.0 <= ahead.0 => watcher.nearest,
            None => ahead,
        };
        if nearest.is_finite() {
            return MotionFailure::NeverMet {
                check,
                relation: self.checks[check].relation,
                nearest,
                at,
                is_there: self.prepared.checks[check].is_as_near(nearest, self.prepared.size),
                is_touched: touched.is_some(),
                turns_back: self.turns_back(),
                course,
            };
        }
        self.tangency.failure()
    }

    /// The first vertex at which the path turns by more than a right angle.
    fn turns_back(&self) -> Option<TurnsBack> {
        let before = std::iter::once(&self.prepared.tip).chain(&self.points);
        let mut corners = before.zip(self.points.windows(2));
        corners.find_map(|(from, corner)| {
            let legs = [corner[0] - from, corner[1] - corner[0]];
            let [to, away] = legs.map(|leg| leg.try_normalize(0.0));
            let (to, away) = (to?, away?);
            if to.dot(&away) >= 0.0 {
                return None;
            }
            Some(TurnsBack { at: corner[0], onward: (to - away).normalize() })
        })
    }
}
