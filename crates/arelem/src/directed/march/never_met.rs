//! What is told of a path on which no check surface is met, and when that is known of one that is closed.

use apt_geometry::Vec3;

use super::{March, Vertex, Watcher};
use crate::error::{Course, MotionFailure, TurnsBack};

impl March<'_> {
    /// On a closed path: a whole turn without a single position means that there is none.
    pub(super) fn count_revolution(
        &mut self,
        start: &Vertex,
        from: &Vertex,
        to: &Vertex,
    ) -> Result<(), MotionFailure> {
        let delta = to.tip - from.tip;
        let length = delta.norm();
        if self.points.len() < 3 || length <= 0.0 {
            return Ok(());
        }
        let along = (start.tip - from.tip).dot(&delta) / length;
        let aside = (start.tip - from.tip - delta * (along / length)).norm();
        let band = self.prepared.part.band() + self.prepared.drive.band();
        // At the end of the vector, as just beyond a corner, the path may lead elsewhere.
        let is_along = delta.dot(&start.tangent) > 0.5 * length;
        let passed = along > 0.0 && along <= length && aside <= 4.0 * band && is_along;
        if !passed {
            return Ok(());
        }
        self.revolutions += 1;
        let wanted = self.checks.iter().map(|c| c.occurrence).max().unwrap_or(1);
        if self.watcher.met == 0 && self.tangency.met == 0 || self.revolutions > wanted {
            let vertices = std::iter::once(&start.tip).chain(&self.points);
            let length = vertices.clone().zip(vertices.skip(1)).map(|(a, b)| (b - a).norm()).sum();
            let nothing = (f64::INFINITY, start.tip, 0);
            let met = self.watcher.met + self.tangency.met;
            return Err(self.never_met(nothing, Course::Closed { length }, met));
        }
        Ok(())
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
        let (nearest, at, check) = if watcher.nearest.0 <= ahead.0 { watcher.nearest } else { ahead };
        if nearest.is_finite() {
            return MotionFailure::NeverMet {
                check,
                relation: self.checks[check].relation,
                nearest,
                at,
                is_there: self.prepared.checks[check].is_as_near(nearest, self.prepared.size),
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
