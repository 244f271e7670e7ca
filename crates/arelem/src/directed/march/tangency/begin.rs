//! Where a way on which the path is parallel to a check surface begins, looked for from before it.

use super::{Gap, OnWay, Reading, STRETCH, Slope, Stretch, Watch};
use crate::{
    directed::march::{Vertex, parallel_way::ParallelWay},
    error::MotionFailure,
};

impl Watch<'_> {
    /// A way that begins before a place on it, where the slope comes to nothing: what tells where it begins from farther on may not find that.
    pub(super) fn way_begun_before(
        &self,
        index: usize,
        vector: [&Vertex; 2],
        before: f64,
        on: &Reading,
    ) -> Result<Option<OnWay>, MotionFailure> {
        let begin = self.comes_to_nothing_before(index, vector, before, on)?;
        let (check, start) = (&self.prepared.checks[index], (&begin.vertex, begin.slope));
        let check = (check, &self.sides[index]);
        if ParallelWay::from(self.prepared, check, start, self.patience)?.is_none() {
            return Ok(None);
        }
        let vertex = &begin.vertex;
        let gap = self.touching(&Stretch { index, from: vertex, to: vertex, slope: Slope::Stays })?;
        let Gap::Closed(vertex, side) = gap else { return Ok(None) };
        Ok(Some(OnWay { slope: begin.slope, stop: Some((*vertex, side)) }))
    }

    /// The first place seen between two at which the slope is nothing.
    fn comes_to_nothing_before(
        &self,
        index: usize,
        vector: [&Vertex; 2],
        mut before: f64,
        on: &Reading,
    ) -> Result<Reading, MotionFailure> {
        let mut begin = on.clone();
        while begin.x - before > STRETCH * self.prepared.size {
            let place = self.read(index, vector, 0.5 * (before + begin.x))?;
            match place.grows() {
                None => begin = place,
                Some(_) => before = place.x,
            }
        }
        Ok(begin)
    }
}
