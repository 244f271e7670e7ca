//! Positions before or after which the tool is in its check surface, or out of it, by so little that vectors elsewhere in their bands may not come to
//! them: the path ends where its own vectors do, and is made simpler only if it then still comes to the position.

use apt_geometry::Vec3;

use super::{March, Path, Vertex, Watcher, finish::End};
use crate::{attitude::Sweep, directed::stop::Event, error::MotionFailure};

/// How far from the end of a path, relative to the size of the coordinates, a position is met there.
const SAME_PLACE: f64 = 1e-9;

impl March<'_> {
    /// The path to a stop on its last vector.
    pub(super) fn finished_on_vectors(
        &mut self,
        start: &Vertex,
        event: &Event,
    ) -> Result<Path, MotionFailure> {
        let end = End { tip: event.tip, check: event.check, side: event.side };
        self.points.push(end.tip);
        let met = self.points.clone();
        let path = self.finished(start, &end)?;
        if self.comes_to(&path.points, &end) {
            return Ok(path);
        }
        self.points = met;
        Ok(self.path(&end))
    }

    /// Whether a path comes to its stop at its last point, and to no other before.
    fn comes_to(&self, points: &[Vec3], end: &End) -> bool {
        let mut watcher = Watcher::new(self.prepared, self.checks);
        let axis = &self.prepared.tool.axis;
        let from = std::iter::once(&self.prepared.tip).chain(points);
        for (from, to) in from.zip(points) {
            let sweep = Sweep::new(&self.prepared.tool, (from, axis), (to, axis));
            if let Some(stop) = watcher.scan(&sweep) {
                let off = (stop.tip - end.tip).norm();
                return stop.check == end.check && off <= SAME_PLACE * self.prepared.size;
            }
        }
        watcher.awaits(end.check)
    }
}
