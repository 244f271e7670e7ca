//! How far two paths go together: a tool on each, neither of which turns back, and never farther from each other than the tolerance.
//!
//! That is the question whether the Fréchet distance of two chains is within a bound (Alt & Godau, "Computing the Fréchet distance between
//! two polygonal curves", 1995): of the plane of points (s, t) on both, the part where both tools are near each other is convex in the
//! cell of two vectors, for position and axis run straight; and a way through it that goes up in s and t is found by what of the sides
//! of each cell can be come to. Cells that cannot are not looked at, so that it takes as long as the paths are, not their product.

use apt_geometry::Vec3;

use super::{
    Tolerance,
    path::{Path, Place, Point},
};

/// How far two paths have been found to go together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run {
    /// Where they are last together.
    pub(super) ends: [Point; 2],
    /// Whether that is the end of both.
    pub(super) is_complete: bool,
}

/// The part of a side of a cell that can be come to.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Reach {
    low: f64,
    high: f64,
}

/// Follows both paths from a point on each, at which they are together, as far as they stay so. `None` if whoever waits has given up.
pub(super) fn together(
    paths: [&Path; 2],
    from: [Point; 2],
    tolerance: Tolerance,
    cancel: &dyn Fn() -> bool,
) -> Option<Run> {
    let mut sweep = Sweep { paths, from, tolerance, run: Run { ends: from, is_complete: false } };
    let mut below = Vec::new();
    for row in from[0].vector..paths[0].vectors() {
        if cancel() {
            return None;
        }
        below = sweep.row(row, &below);
        if below.is_empty() {
            break;
        }
    }
    Some(sweep.run)
}

struct Sweep<'a> {
    paths: [&'a Path; 2],
    from: [Point; 2],
    tolerance: Tolerance,
    run: Run,
}

impl Sweep<'_> {
    /// The cells of one vector of the first path, from what can be come to of their lower sides to the same of their upper ones.
    fn row(&mut self, row: usize, below: &[(usize, Reach)]) -> Vec<(usize, Reach)> {
        let mut above = Vec::new();
        let mut left: Option<Reach> = None;
        let mut waiting = below.iter().copied().peekable();
        let is_first = row == self.from[0].vector;
        let mut column = if is_first { self.from[1].vector } else { usize::MAX };
        loop {
            if left.is_none() && !(is_first && column == self.from[1].vector) {
                let Some((next, _)) = waiting.peek() else { return above };
                column = *next;
            }
            let under = waiting.next_if(|(at, _)| *at == column).map(|(_, reach)| reach);
            let [right, top] = self.cell([row, column], left, under);
            if let Some(reach) = right {
                self.come_to([Point { vector: row, fraction: reach.high }, self.paths[1].place(column + 1)]);
            }
            if let Some(reach) = top {
                self.come_to([self.paths[0].place(row + 1), Point { vector: column, fraction: reach.high }]);
                above.push((column, reach));
            }
            column += 1;
            if column >= self.paths[1].vectors() {
                return above;
            }
            left = right;
        }
    }

    /// What can be come to of the right and the upper side of a cell.
    fn cell(
        &self,
        [row, column]: [usize; 2],
        left: Option<Reach>,
        under: Option<Reach>,
    ) -> [Option<Reach>; 2] {
        let [a, b] = self.paths;
        if a.manner(row) != b.manner(column) {
            // Both wait for each other at the ends of what they do alike, and go on together: through a corner only.
            let through = |reach: Option<Reach>| {
                reach.filter(|reach| reach.high >= 1.0).map(|_| Reach { low: 0.0, high: 0.0 })
            };
            return [through(under), through(left)];
        }
        let is_start = [row, column] == self.from.map(|point| point.vector);
        // Nothing of the cell is before where the paths begin, and nothing of the other side before where that is come to.
        let least = |side: Option<Reach>, other: Option<Reach>, start: f64| {
            let from_side = side.map(|reach| reach.low);
            let from_other = other.map(|_| 0.0);
            let from_start = is_start.then_some(start);
            [from_side, from_other, from_start].into_iter().flatten().reduce(f64::min)
        };
        let right = least(left, under, self.from[0].fraction);
        let top = least(under, left, self.from[1].fraction);
        let within = |low: Option<f64>, free: Option<Reach>| {
            let (low, free) = low.zip(free)?;
            (free.high >= low).then(|| Reach { low: free.low.max(low), high: free.high })
        };
        [
            within(right, self.free(&b.places[column + 1], [&a.places[row], &a.places[row + 1]])),
            within(top, self.free(&a.places[row + 1], [&b.places[column], &b.places[column + 1]])),
        ]
    }

    /// The part of a vector that is near a place.
    fn free(&self, place: &Place, vector: [&Place; 2]) -> Option<Reach> {
        let positions = near(place.position, vector.map(|end| end.position), self.tolerance.distance)?;
        let axes = near(place.axis, vector.map(|end| end.axis), self.tolerance.axis_chord())?;
        let both = Reach { low: positions.low.max(axes.low), high: positions.high.min(axes.high) };
        (both.low <= both.high).then_some(both)
    }

    /// Keeps the points that are farthest along both paths.
    fn come_to(&mut self, ends: [Point; 2]) {
        let [a, b] = self.paths;
        let far =
            |[first, second]: [Point; 2]| (a.along(first) + b.along(second), first.vector + second.vector);
        let is_complete = ends == [a.end(), b.end()];
        if is_complete || (!self.run.is_complete && far(ends) >= far(self.run.ends)) {
            self.run = Run { ends, is_complete };
        }
    }
}

/// The part of the straight way between two points that is within a distance from a third one.
fn near(place: Vec3, [from, to]: [Vec3; 2], distance: f64) -> Option<Reach> {
    let (start, along) = (from - place, to - from);
    let (is_near_start, is_near_end) = (start.norm() <= distance, (to - place).norm() <= distance);
    let square = along.norm_squared();
    if square == 0.0 {
        return is_near_start.then_some(Reach { low: 0.0, high: 1.0 });
    }
    let middle = -start.dot(&along) / square;
    let left = distance.powi(2) - (start + along * middle).norm_squared();
    if left < 0.0 {
        // Rounding may not take away what the ends say of themselves.
        return match (is_near_start, is_near_end) {
            (true, true) => Some(Reach { low: 0.0, high: 1.0 }),
            (true, false) => Some(Reach { low: 0.0, high: 0.0 }),
            (false, true) => Some(Reach { low: 1.0, high: 1.0 }),
            (false, false) => None,
        };
    }
    let half = (left / square).sqrt();
    let low = if is_near_start { 0.0 } else { middle - half };
    let high = if is_near_end { 1.0 } else { middle + half };
    (low <= 1.0 && high >= 0.0).then(|| Reach { low: low.max(0.0), high: high.min(1.0) })
}
