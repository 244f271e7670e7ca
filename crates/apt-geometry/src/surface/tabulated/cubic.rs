//! One interval of a directrix: a cubic over its chord, with straight extensions where the curve begins and ends.

use super::{Vec2, boxes::UprightBox, bracketed_root};

/// Spans of an interval that are searched for a nearest point each.
pub(super) const SPANS: u32 = 8;
/// Bound of the Newton iteration for the nearest point of an interval; it is bracketed.
const MAX_ITERATIONS: u32 = 60;
/// Step along the curve, relative to the lengths, below which its effect on the distance is far below rounding.
const RESOLUTION: f64 = 1e-13;

/// One cubic over its chord: `v = a u³ + b u² + c u` with the chord along u.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cubic {
    pub(super) start: Vec2,
    pub(super) along: Vec2,
    pub(super) length: f64,
    pub(super) coefficients: [f64; 3],
    /// Least and greatest height over the chord.
    pub(super) bounds: [f64; 2],
    /// The straight extension before the first or after the last point: it has no end on that side.
    pub(super) open: [bool; 2],
    /// Bounds of the curvature of each span, against either side.
    pub(super) bends: [[f64; 2]; SPANS as usize],
    /// Least and greatest slope over the chord on each span.
    pub(super) slopes: [[f64; 2]; SPANS as usize],
    /// Sine of the turn from the interval before, positive to the right.
    pub(super) turn: f64,
}

impl Cubic {
    pub(super) fn new(start: Vec2, end: Vec2, a: f64, b: f64) -> Option<Self> {
        let chord = end - start;
        let length = chord.norm();
        if !(length > 0.0 && a.is_finite() && b.is_finite() && length.is_finite()) {
            return None;
        }
        let coefficients = [a, b, -length * (a * length + b)];
        let mut cubic = Self {
            start,
            along: chord / length,
            length,
            coefficients,
            bounds: [0.0, 0.0],
            open: [false, false],
            bends: [[0.0; 2]; SPANS as usize],
            slopes: [[0.0; 2]; SPANS as usize],
            turn: 0.0,
        };
        for s in super::super::solve_quadratic(3.0 * a, b, coefficients[2]) {
            if s > 0.0 && s < length {
                let height = cubic.height(s)[0];
                cubic.bounds = [cubic.bounds[0].min(height), cubic.bounds[1].max(height)];
            }
        }
        cubic.bends = std::array::from_fn(|k| {
            let width = length / f64::from(SPANS);
            let span = [k as f64 * width, (k + 1) as f64 * width];
            [1.0, -1.0].map(|side| cubic.greatest_bend(side, span))
        });
        cubic.slopes = std::array::from_fn(|k| {
            let width = length / f64::from(SPANS);
            cubic.slope_range([k as f64 * width, (k + 1) as f64 * width])
        });
        Some(cubic)
    }

    /// Unit direction of the curve.
    pub(super) fn direction(&self, s: f64) -> Vec2 {
        let [_, slope, _] = self.height(s);
        (self.along + self.normal_axis() * slope) / slope.hypot(1.0)
    }

    /// Height over the chord, its slope and its second derivative. The extensions stay straight beyond their ends.
    pub(super) fn height(&self, s: f64) -> [f64; 3] {
        let [a, b, c] = self.coefficients;
        let inner = s.clamp(0.0, self.length);
        let value = ((a * inner + b) * inner + c) * inner;
        let slope = (3.0 * a * inner + 2.0 * b) * inner + c;
        if inner == s {
            [value, slope, 6.0 * a * s + 2.0 * b]
        } else {
            [value + slope * (s - inner), slope, 0.0]
        }
    }

    pub(super) fn normal_axis(&self) -> Vec2 {
        Vec2::new(-self.along.y, self.along.x)
    }

    pub(super) fn to_local(&self, p: Vec2) -> Vec2 {
        let w = p - self.start;
        Vec2::new(w.dot(&self.along), w.dot(&self.normal_axis()))
    }

    pub(super) fn straight(&self) -> bool {
        self.coefficients == [0.0; 3]
    }

    /// A box with sides along the axes of the plane that holds the interval and its extensions.
    pub(super) fn upright_box(&self) -> UprightBox {
        let corners = [0.0, self.length].into_iter().flat_map(|s| {
            self.bounds.map(|height| self.start + self.along * s + self.normal_axis() * height)
        });
        let inner = corners.fold(UprightBox::NOWHERE, |all, corner| all.with(corner));
        self.extensions()
            .into_iter()
            .flatten()
            .fold(inner, |all, [_, way]| all.open_towards(self.along * way.x + self.normal_axis() * way.y))
    }

    /// The straight extensions, in the coordinates of the chord: where each begins, and the way that it goes.
    fn extensions(&self) -> [Option<[Vec2; 2]>; 2] {
        let extension = |open: bool, s: f64, sense: f64| {
            let [height, slope, _] = self.height(s);
            open.then_some([Vec2::new(s, height), Vec2::new(sense, sense * slope)])
        };
        [extension(self.open[0], 0.0, -1.0), extension(self.open[1], self.length, 1.0)]
    }

    /// The straight extensions in the plane: where each begins, and the unit way that it goes.
    pub(super) fn ways_on(&self) -> [Option<[Vec2; 2]>; 2] {
        let turned = |local: Vec2| self.along * local.x + self.normal_axis() * local.y;
        self.extensions().map(|extension| {
            extension.map(|[begin, way]| [self.start + turned(begin), turned(way.normalize())])
        })
    }

    /// The least second derivative of the height on a stretch, no greater than zero, and the greatest, no less: it changes evenly.
    pub(super) fn bend_range(&self, ends: [f64; 2]) -> [f64; 2] {
        let [a, b, _] = self.coefficients;
        let [first, last] = ends.map(|s| 6.0 * a * s + 2.0 * b);
        [first.min(last).min(0.0), first.max(last).max(0.0)]
    }

    /// No point of the interval is nearer than the root of this.
    pub(super) fn least_square(&self, local: Vec2) -> f64 {
        let aside = (-local.x).max(local.x - self.length).max(0.0);
        let inner = aside * aside + least_offset(self.bounds, local.y);
        self.extensions().iter().flatten().fold(inner, |least, ray| least.min(square_from(local, ray)))
    }

    /// Half the derivative of the squared distance to the point of a parameter.
    pub(super) fn gradient(&self, local: Vec2, s: f64) -> f64 {
        let [h, h1, _] = self.height(s);
        (s - local.x) + (h - local.y) * h1
    }

    /// Whether the squared distance from a point has one minimum at most along the interval and its extensions: its slope
    /// grows where `1 + h'² + (h − y) h''` is positive, and the extensions go on with the slope of their ends.
    fn has_one_nearest(&self, local: Vec2) -> bool {
        let [a, b, _] = self.coefficients;
        let bends = [2.0 * b, 6.0 * a * self.length + 2.0 * b];
        let least =
            self.bounds.iter().flat_map(|h| bends.map(|bend| (h - local.y) * bend)).fold(0.0, f64::min);
        least > -1.0
    }

    /// Whether a step of Newton's method leaves no more than a resolution: its error is the square of the step, times half the
    /// third derivative by the second, which changes over the step as the fourth says.
    fn is_settled(&self, local: Vec2, [from, to]: [f64; 2], resolution: f64) -> bool {
        let inside = |s: f64| s >= 0.0 && s <= self.length;
        if !inside(from) || !inside(to) {
            return false;
        }
        let [h, h1, h2] = self.height(from);
        let h3 = 6.0 * self.coefficients[0];
        let second = 1.0 + h1 * h1 + (h - local.y) * h2;
        let third = 3.0 * h1 * h2 + (h - local.y) * h3;
        let fourth = 3.0 * h2 * h2 + 4.0 * h1 * h3;
        let step = (to - from).abs();
        (third.abs() + fourth.abs() * step) * step * step <= resolution * second
    }

    /// Parameter of the nearest point near a starting value, between limits.
    pub(super) fn nearest_from(&self, local: Vec2, from: f64, limits: [f64; 2]) -> f64 {
        let [mut low, mut high] = limits;
        let mut s = from;
        for _ in 0..MAX_ITERATIONS {
            let [h, h1, h2] = self.height(s);
            let gradient = (s - local.x) + (h - local.y) * h1;
            if gradient > 0.0 {
                high = s;
            } else {
                low = s;
            }
            let curvature = 1.0 + h1 * h1 + (h - local.y) * h2;
            let newton = s - gradient / curvature;
            let is_newton = curvature > 0.0 && newton >= low && newton <= high;
            let next = if is_newton { newton } else { 0.5 * (low + high) };
            let resolution = RESOLUTION * (self.length + s.abs() + local.y.abs());
            let step = (next - s).abs();
            if step <= resolution || is_newton && self.is_settled(local, [s, next], resolution) {
                return next;
            }
            s = next;
        }
        s
    }

    /// The nearest point: its parameter and squared distance.
    pub(super) fn nearest(&self, local: Vec2) -> (f64, f64) {
        let reach = self.length + local.norm();
        let low = if self.open[0] { -reach } else { 0.0 };
        let high = if self.open[1] { self.length + reach } else { self.length };
        if self.straight() {
            let s = local.x.clamp(low, high);
            return (s, (s - local.x) * (s - local.x) + local.y * local.y);
        }
        if self.has_one_nearest(local) {
            let s = if !self.open[0] && self.gradient(local, low) >= 0.0 {
                low
            } else if !self.open[1] && self.gradient(local, high) <= 0.0 {
                high
            } else {
                self.nearest_from(local, local.x.clamp(low, high), [low, high])
            };
            return (s, self.square(local, s));
        }
        let mut best = (low, self.square(local, low));
        let mut take = |s: f64| {
            let square = self.square(local, s);
            if square < best.1 {
                best = (s, square);
            }
            best.1
        };
        take(high);
        if self.open[0] {
            take(self.nearest_from(local, 0.0_f64.min(local.x), [low, 0.0]));
        }
        if self.open[1] {
            take(self.nearest_from(local, self.length.max(local.x), [self.length, high]));
        }
        for k in 0..SPANS {
            let end = |k: u32| self.length * f64::from(k) / f64::from(SPANS);
            self.nearest_places(local, [end(k), end(k + 1)], &mut take);
        }
        best
    }

    /// Whether a point may be within reach of a span, by the least height of the span over its chord and the greatest, or of the
    /// straight line that goes on from it.
    pub(super) fn is_near(&self, k: usize, local: Vec2, reach: f64) -> bool {
        let width = self.length / f64::from(SPANS);
        let (start, end) = (k as f64 * width, (k + 1) as f64 * width);
        let aside = (start - local.x).max(local.x - end).max(0.0);
        let steepest = self.slopes.get(k).map_or(0.0, |[least, greatest]| least.abs().max(greatest.abs()));
        // Between its ends the span keeps to the steepest lines through both.
        let (middle, half) = (self.height(start)[0] + self.height(end)[0], width * steepest);
        let heights = [0.5 * (middle - half), 0.5 * (middle + half)];
        let [before, after] = self
            .extensions()
            .map(|extension| extension.is_some_and(|ray| square_from(local, &ray) <= reach * reach));
        aside * aside + least_offset(heights, local.y) <= reach * reach
            || (k == 0 && before)
            || (k + 1 == SPANS as usize && after)
    }

    /// A bound of the curvature against a side over the spans within reach of a point.
    pub(super) fn greatest_curvature(&self, side: f64, local: Vec2, reach: f64) -> f64 {
        if self.straight() {
            return 0.0;
        }
        let mut greatest = f64::NEG_INFINITY;
        let width = self.length / f64::from(SPANS);
        let within = (reach * reach - least_offset(self.bounds, local.y)).max(0.0).sqrt();
        for (k, bends) in self.bends.iter().enumerate() {
            let start = k as f64 * width;
            if start - local.x <= within && local.x - start - width <= within {
                greatest = greatest.max(if side > 0.0 { bends[0] } else { bends[1] });
            }
        }
        greatest
    }

    /// A bound of the curvature against a side over a span.
    fn greatest_bend(&self, side: f64, [a, b]: [f64; 2]) -> f64 {
        let ([_, s0, b0], [_, s1, b1]) = (self.height(a), self.height(b));
        // The second derivative is linear, the slope monotone unless it turns.
        let bend = (-side * b0).max(-side * b1);
        let wavers = (b0 > 0.0) != (b1 > 0.0) || (s0 > 0.0) != (s1 > 0.0);
        let flattest = if wavers { 0.0 } else { s0.abs().min(s1.abs()) };
        let steepest = s0.abs().max(s1.abs()) + b0.abs().max(b1.abs()) * (b - a);
        bend / (if bend > 0.0 { flattest } else { steepest }).hypot(1.0).powi(3)
    }

    /// Least and greatest slope over a span: at its ends, or where the slope turns.
    pub(super) fn slope_range(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let [a, b, _] = self.coefficients;
        let turn = (-b / (3.0 * a)).clamp(from, to);
        let turn = if turn.is_nan() { from } else { turn };
        let slopes = [from, to, turn].map(|s| self.height(s)[1]);
        [slopes[0].min(slopes[1]).min(slopes[2]), slopes[0].max(slopes[1]).max(slopes[2])]
    }

    pub(super) fn ray_roots(&self, p: Vec2, d: Vec2, roots: &mut Vec<f64>) {
        let local = self.to_local(p);
        let (du, dv) = (d.dot(&self.along), d.dot(&self.normal_axis()));
        let inside = |s: f64| (self.open[0] || s >= 0.0) && (self.open[1] || s <= self.length);
        if du.abs() <= 1e-12 * dv.abs() {
            if inside(local.x) {
                roots.push((self.height(local.x)[0] - local.y) / dv);
            }
            return;
        }
        // Signed height of the curve over the ray, as a function of s; its turning points split the interval.
        let slope = dv / du;
        let gap = |s: f64| self.height(s)[0] - (local.y + slope * (s - local.x));
        let [a, b, c] = self.coefficients;
        let mut limits = vec![0.0];
        for s in super::super::solve_quadratic(3.0 * a, b, c - slope) {
            if s > 0.0 && s < self.length {
                limits.push(s);
            }
        }
        limits.push(self.length);
        limits.sort_by(f64::total_cmp);
        for pair in limits.windows(2) {
            if let Some(s) = bracketed_root(&gap, pair[0], pair[1]) {
                roots.push((s - local.x) / du);
            }
        }
        // The straight extensions beyond their ends.
        for (open, end, outward) in [(self.open[0], 0.0, -1.0), (self.open[1], self.length, 1.0)] {
            let [h, h1, _] = self.height(end);
            let relative = h1 - slope;
            if open && relative != 0.0 {
                let s = end - (h - (local.y + slope * (end - local.x))) / relative;
                if (s - end) * outward > 0.0 {
                    roots.push((s - local.x) / du);
                }
            }
        }
    }
}

/// Squared distance of a point from a ray: where it begins, and the way that it goes.
fn square_from(p: Vec2, [begin, way]: &[Vec2; 2]) -> f64 {
    let from = p - begin;
    (from - way * (from.dot(way) / way.norm_squared()).max(0.0)).norm_squared()
}

/// Squared distance of a height from a range of heights.
fn least_offset(bounds: [f64; 2], height: f64) -> f64 {
    let away = (bounds[0] - height).max(height - bounds[1]).max(0.0);
    away * away
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Places on an interval, and as far again on its extensions.
    fn places(cubic: &Cubic) -> impl Iterator<Item = Vec2> + '_ {
        let [before, after] = cubic.open.map(|open| if open { 1.0 } else { 0.0 });
        let reach = cubic.length + before * 3.0 + after * 3.0;
        (0..=2000).map(move |k| {
            let s = f64::from(k) / 2000.0 * reach - before * 3.0;
            Vec2::new(s, cubic.height(s)[0])
        })
    }

    fn bent() -> impl Strategy<Value = Cubic> {
        let numbers = [-8.0..8.0f64, -4.0..4.0f64, 0.3..2.0f64];
        (numbers, any::<[bool; 2]>()).prop_filter_map("no interval", |([a, b, length], open)| {
            let mut cubic = Cubic::new(Vec2::new(0.2, -0.1), Vec2::new(0.2 + length, 0.3), a, b)?;
            cubic.open = open;
            Some(cubic)
        })
    }

    proptest! {
        #[test]
        fn no_place_of_an_interval_is_nearer_than_the_nearest(cubic in bent(), [x, y] in [-2.0..4.0f64, -3.0..3.0f64]) {
            let local = Vec2::new(x, y);
            let (s, square) = cubic.nearest(local);
            let found = Vec2::new(s, cubic.height(s)[0]);
            prop_assert!(((found - local).norm_squared() - square).abs() <= 1e-12);
            let least = cubic.least_square(local);
            for place in places(&cubic) {
                let away = (place - local).norm_squared();
                prop_assert!(away >= square - 1e-12, "{place} {found}");
                prop_assert!(away >= least - 1e-12, "{place} {least}");
            }
            // Inside, the way to it is square to the curve.
            if s > 0.0 && s < cubic.length {
                prop_assert!(cubic.gradient(local, s).abs() <= 1e-10, "{}", cubic.gradient(local, s));
            }
        }

        #[test]
        fn the_box_holds_the_interval_and_its_extensions(cubic in bent()) {
            let around = cubic.upright_box();
            for place in places(&cubic) {
                let p = cubic.start + cubic.along * place.x + cubic.normal_axis() * place.y;
                prop_assert!(around.square(p) <= 1e-24, "{p} {around:?}");
            }
        }
    }
}
