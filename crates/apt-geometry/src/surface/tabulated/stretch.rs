//! The nearest place of a stretch of an interval, where the distance from a point may fall and rise more than once.

use super::{Cubic, Vec2};

/// Halvings of a stretch; a stretch of a millionth of a millionth is a place.
const MOST_HALVINGS: usize = 40;
/// Half of the squared distance, relative to what it is computed of, that is rounding.
const ROUNDING: f64 = 1e-15;

/// A stretch of an interval between two parameters, seen from a point.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    ends: [f64; 2],
    /// Half the squared distance at both ends, and its derivative.
    values: [f64; 2],
    gradients: [f64; 2],
}

impl Stretch {
    fn new(cubic: &Cubic, local: Vec2, ends: [f64; 2]) -> Self {
        let values = ends.map(|s| 0.5 * cubic.square(local, s));
        Self { ends, values, gradients: ends.map(|s| cubic.gradient(local, s)) }
    }

    fn width(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }

    /// Least and greatest second derivative of half the squared distance, `1 + h'² + (h − y) h''`.
    fn bends(&self, cubic: &Cubic, local: Vec2) -> [f64; 2] {
        let slopes = cubic.slope_range(self.ends);
        let [steepest, flattest] = {
            let squares = slopes.map(|slope| slope * slope);
            let crosses = slopes[0] < 0.0 && slopes[1] > 0.0;
            [squares[0].max(squares[1]), if crosses { 0.0 } else { squares[0].min(squares[1]) }]
        };
        let [from, to] = self.ends.map(|s| cubic.height(s));
        // Between its ends the curve keeps to the steepest lines through both.
        let (middle, half) = (0.5 * (from[0] + to[0]), 0.5 * self.width() * steepest.sqrt());
        let heights = [middle - half - local.y, middle + half - local.y];
        let products = heights.map(|height| [height * from[2], height * to[2]]);
        let least = products.as_flattened().iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = products.as_flattened().iter().copied().fold(f64::NEG_INFINITY, f64::max);
        [1.0 + flattest + least, 1.0 + steepest + greatest]
    }
}

impl Cubic {
    /// Squared distance of the place of a parameter.
    pub(super) fn square(&self, local: Vec2, s: f64) -> f64 {
        let (x, y) = (s - local.x, self.height(s)[0] - local.y);
        x * x + y * y
    }

    /// Tells of all places between two parameters, inside the interval, that may be the nearest, as long as they may be nearer
    /// than the nearest known, of which the answer tells the squared distance. Both ends are among them.
    ///
    /// A function with a second derivative of at most M is nowhere lower than the lower one of its ends by more than an eighth of M
    /// times the square of what is between; where the second derivative is positive it falls, then rises, once.
    pub(super) fn nearest_places(&self, local: Vec2, ends: [f64; 2], mut tell: impl FnMut(f64) -> f64) {
        let mut open = [Stretch::new(self, local, ends); MOST_HALVINGS + 1];
        let mut halvings = [0; MOST_HALVINGS + 1];
        let mut count = 1;
        ends.into_iter().for_each(|s| {
            tell(s);
        });
        while count > 0 {
            count -= 1;
            let (stretch, halved) = (open[count], halvings[count]);
            let [least, greatest] = stretch.bends(self, local);
            if least > 0.0 {
                if stretch.gradients[0] < 0.0 && stretch.gradients[1] > 0.0 {
                    let share = stretch.gradients[0] / (stretch.gradients[0] - stretch.gradients[1]);
                    tell(self.nearest_from(local, stretch.ends[0] + stretch.width() * share, stretch.ends));
                }
                continue;
            }
            let middle = 0.5 * (stretch.ends[0] + stretch.ends[1]);
            let nearest = 0.5 * tell(middle);
            let lowest = stretch.values[0].min(stretch.values[1])
                - 0.125 * greatest.max(0.0) * stretch.width() * stretch.width();
            let rounding = ROUNDING * (local.norm_squared() + self.length * self.length);
            if halved == MOST_HALVINGS || lowest >= nearest - rounding {
                continue;
            }
            for half in [[stretch.ends[0], middle], [middle, stretch.ends[1]]] {
                (open[count], halvings[count]) = (Stretch::new(self, local, half), halved + 1);
                count += 1;
            }
        }
    }
}
