//! Tabulated cylinders: a piecewise cubic directrix ruled along a straight line.

mod forms;

use nalgebra::{Matrix3, Vector2};

use super::{Chart, Foot, Place, chart::Facing, part::LEAST_COSINE, sheet::Jet};
use crate::{Vec3, canonical::TabulatedCylinder};

type Vec2 = Vector2<f64>;

/// Spans of an interval that are searched for a nearest point each.
const SPANS: u32 = 8;
/// Bound of the Newton iteration for the nearest point of an interval; it is bracketed.
const MAX_ITERATIONS: u32 = 60;

/// Step along the curve, relative to the lengths, below which its effect on the distance is far below rounding.
const RESOLUTION: f64 = 1e-13;
/// Cosine defect above which the nearest point is a corner of the curve.
const CORNER: f64 = 1e-9;
/// Distance from the curve, relative to the size of the coordinates, below which a point lies on it.
const ON_CURVE: f64 = 1e-12;
/// Sine of a turn between intervals below which they join smoothly.
const SMOOTH: f64 = 1e-7;
/// Curvature of a corner: large enough to be infinite for any tool, small enough to compute with.
const CORNER_CURVATURE: f64 = 1e12;

/// One cubic over its chord: `v = a u³ + b u² + c u` with the chord along u.
#[derive(Debug, Clone, PartialEq)]
struct Cubic {
    start: Vec2,
    along: Vec2,
    length: f64,
    coefficients: [f64; 3],
    /// Least and greatest height over the chord.
    bounds: [f64; 2],
    /// The straight extension before the first or after the last point: it has no end on that side.
    open: [bool; 2],
    /// Bounds of the curvature of each span, against either side.
    bends: [[f64; 2]; SPANS as usize],
    /// Least and greatest slope over the chord on each span.
    slopes: [[f64; 2]; SPANS as usize],
    /// Sine of the turn from the interval before, positive to the right.
    turn: f64,
}

/// The directrix with its frame.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectrixCurve {
    axes: [Vec3; 3],
    intervals: Vec<Cubic>,
}

impl Cubic {
    fn new(start: Vec2, end: Vec2, a: f64, b: f64) -> Option<Self> {
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
        for s in super::solve_quadratic(3.0 * a, b, coefficients[2]) {
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
    fn direction(&self, s: f64) -> Vec2 {
        let [_, slope, _] = self.height(s);
        (self.along + self.normal_axis() * slope) / slope.hypot(1.0)
    }

    /// Height over the chord, its slope and its second derivative. The extensions stay straight beyond their ends.
    fn height(&self, s: f64) -> [f64; 3] {
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

    fn normal_axis(&self) -> Vec2 {
        Vec2::new(-self.along.y, self.along.x)
    }

    fn to_local(&self, p: Vec2) -> Vec2 {
        let w = p - self.start;
        Vec2::new(w.dot(&self.along), w.dot(&self.normal_axis()))
    }

    fn straight(&self) -> bool {
        self.coefficients == [0.0; 3]
    }

    /// No point of the interval is nearer than the root of this.
    fn least_square(&self, local: Vec2) -> f64 {
        if (self.open[0] || self.open[1]) && !self.straight() {
            return 0.0;
        }
        let before = if self.open[0] { 0.0 } else { -local.x };
        let after = if self.open[1] { 0.0 } else { local.x - self.length };
        let dx = before.max(after).max(0.0);
        dx * dx + least_offset(self.bounds, local.y)
    }

    /// Half the derivative of the squared distance to the point of a parameter.
    fn gradient(&self, local: Vec2, s: f64) -> f64 {
        let [h, h1, _] = self.height(s);
        (s - local.x) + (h - local.y) * h1
    }

    /// Parameter of the nearest point near a starting value, between limits.
    fn nearest_from(&self, local: Vec2, from: f64, limits: [f64; 2]) -> f64 {
        let [mut low, mut high] = limits;
        let mut s = from;
        for _ in 0..MAX_ITERATIONS {
            let [h, h1, h2] = self.height(s);
            let gradient = self.gradient(local, s);
            if gradient > 0.0 {
                high = s;
            } else {
                low = s;
            }
            let curvature = 1.0 + h1 * h1 + (h - local.y) * h2;
            let newton = s - gradient / curvature;
            let next =
                if curvature > 0.0 && newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - s).abs() <= RESOLUTION * (self.length + s.abs() + local.y.abs()) {
                return next;
            }
            s = next;
        }
        s
    }

    /// The nearest point: its parameter and squared distance.
    fn nearest(&self, local: Vec2) -> (f64, f64) {
        let reach = self.length + local.norm();
        let low = if self.open[0] { -reach } else { 0.0 };
        let high = if self.open[1] { self.length + reach } else { self.length };
        if self.straight() {
            let s = local.x.clamp(low, high);
            return (s, (s - local.x) * (s - local.x) + local.y * local.y);
        }
        let distance = |s: f64| {
            let (x, y) = (s - local.x, self.height(s)[0] - local.y);
            x * x + y * y
        };
        let mut best = (low, distance(low));
        let mut take = |s: f64| {
            let d = distance(s);
            if d < best.1 {
                best = (s, d);
            }
        };
        take(high);
        if self.open[0] || self.open[1] {
            take(self.nearest_from(local, local.x.clamp(low, high), [low, high]));
            return best;
        }
        let mut left = (low, self.gradient(local, low));
        for k in 1..=SPANS {
            let right = low + (high - low) * f64::from(k) / f64::from(SPANS);
            let right = (right, self.gradient(local, right));
            // A nearest point lies where the distance stops falling; elsewhere there is nothing to be found.
            if left.1 <= 0.0 && right.1 >= 0.0 {
                let share = if right.1 > left.1 { left.1 / (left.1 - right.1) } else { 0.5 };
                let start = left.0 + (right.0 - left.0) * share;
                take(self.nearest_from(local, start, [left.0, right.0]));
            }
            left = right;
        }
        best
    }
}

impl DirectrixCurve {
    pub(super) fn new(cylinder: &TabulatedCylinder) -> Option<Self> {
        let mut axes = cylinder.axes;
        for axis in &mut axes {
            *axis = super::unit(axis)?;
        }
        let count = cylinder.intervals.len();
        let mut intervals: Vec<Cubic> = Vec::with_capacity(count);
        for (k, interval) in cylinder.intervals.iter().enumerate() {
            let start = Vec2::new(interval.u, interval.v);
            let end = match cylinder.intervals.get(k + 1) {
                Some(next) => Vec2::new(next.u, next.v),
                None => Vec2::from(cylinder.last),
            };
            let mut cubic = Cubic::new(start, end, interval.a, interval.b)?;
            cubic.open = [k == 0, k + 1 == count];
            if let Some(before) = intervals.last() {
                let (end, start) = (Cubic::direction(before, before.length), cubic.direction(0.0));
                cubic.turn = end.y * start.x - end.x * start.y;
            }
            intervals.push(cubic);
        }
        if intervals.is_empty() { None } else { Some(Self { axes, intervals }) }
    }

    /// Unit direction of the generators.
    pub fn generator(&self) -> Vec3 {
        self.axes[2]
    }

    /// The points between intervals, in the plane through the origin.
    pub(super) fn joints(&self) -> Vec<Vec3> {
        self.intervals.iter().skip(1).map(|interval| self.lift(interval.start)).collect()
    }

    fn flat(&self, p: &Vec3) -> Vec2 {
        Vec2::new(self.axes[0].dot(p), self.axes[1].dot(p))
    }

    fn lift(&self, v: Vec2) -> Vec3 {
        self.axes[0] * v.x + self.axes[1] * v.y
    }

    /// The interval with the nearest point and its parameter there.
    fn nearest(&self, flat: Vec2) -> (usize, f64) {
        // First the interval that may be nearest, then all that still may be nearer.
        let mut first = (f64::INFINITY, 0);
        for (k, interval) in self.intervals.iter().enumerate() {
            let least = interval.least_square(interval.to_local(flat));
            if least < first.0 {
                first = (least, k);
            }
        }
        let mut best = (first.1, 0.0, f64::INFINITY);
        let others = (0..self.intervals.len()).filter(|k| *k != first.1);
        for k in std::iter::once(first.1).chain(others) {
            let Some(interval) = self.intervals.get(k) else { continue };
            let local = interval.to_local(flat);
            if interval.least_square(local) <= best.2 {
                let (s, square) = interval.nearest(local);
                if square < best.2 {
                    best = (k, s, square);
                }
            }
        }
        (best.0, best.1)
    }

    /// The nearest point, and the curvature of the directrix there, positive where it curves away from the natural
    /// normal `(−sin φ, cos φ)`.
    pub(super) fn foot(&self, p: &Vec3) -> (Foot, f64) {
        let flat = self.flat(p);
        let (k, s) = self.nearest(flat);
        let interval = &self.intervals[k];
        let [h, h1, h2] = interval.height(s);
        let norm = h1.hypot(1.0);
        let normal = (interval.normal_axis() - interval.along * h1) / norm;
        let point = interval.start + interval.along * s + interval.normal_axis() * h;
        let offset = flat - point;
        let (height, length) = (offset.dot(&normal), offset.norm());
        // At a corner between intervals the nearest point stays while the normal turns. On the curve itself the offset is
        // rounding and says nothing.
        let corner =
            height.abs() < length * (1.0 - CORNER) && length > ON_CURVE * (interval.length + flat.norm());
        let distance = if corner { length.copysign(height) } else { height };
        let curvature = if corner { CORNER_CURVATURE.copysign(height) } else { -h2 / (norm * norm * norm) };
        let normal = self.lift(if corner { offset / distance } else { normal });
        (Foot { distance, point: p - normal * distance, normal }, curvature)
    }

    /// The first parameter is the distance along the generators from the plane through the origin.
    pub(super) fn place_near(&self, p: &Vec3) -> Place {
        let (piece, s) = self.nearest(self.flat(p));
        Place { piece, at: [self.axes[2].dot(p), s] }
    }

    pub(super) fn chart(&self, place: &Place) -> Option<Chart> {
        let interval = self.intervals.get(place.piece)?;
        let [z, s] = place.at;
        let [h, slope, bend] = interval.height(s);
        let across = interval.normal_axis();
        let jet = Jet {
            point: self.lift(interval.start + interval.along * s + across * h) + self.axes[2] * z,
            du: self.axes[2],
            dv: self.lift(interval.along + across * slope),
            duu: Vec3::zeros(),
            duv: Vec3::zeros(),
            dvv: self.lift(across * bend),
        };
        let sense = self.axes[2].dot(&self.axes[0].cross(&self.axes[1])).signum();
        Some(Chart::new(&jet, sense, 0.0))
    }

    pub(super) fn shifted(&self, place: &Place, step: [f64; 2]) -> Option<Place> {
        let interval = self.intervals.get(place.piece)?;
        let (z, s) = (place.at[0] + step[0], place.at[1] + step[1]);
        let before = s < 0.0 && !interval.open[0];
        let after = s > interval.length && !interval.open[1];
        if !before && !after {
            return s.is_finite().then_some(Place { piece: place.piece, at: [z, s] });
        }
        // On from the end of the neighbour, over the same chord.
        let piece = if before { place.piece.checked_sub(1)? } else { place.piece + 1 };
        let next = self.intervals.get(piece)?;
        let s = if before { next.length + s } else { s - interval.length };
        let within = (next.open[0] || s >= 0.0) && (next.open[1] || s <= next.length);
        within.then_some(Place { piece, at: [z, s] })
    }

    /// Curvatures and normals of the directrix between the first and the last of its spans within reach of a point, unless
    /// some normal has less than a cosine to the given one.
    pub(super) fn facing(&self, center: &Vec3, reach: f64, normal: &Vec3, least: f64) -> Option<Facing> {
        let (flat, normal) = (self.flat(center), self.flat(normal));
        let mut found = Facing { curvature: [f64::NEG_INFINITY; 2], cosine: 1.0 };
        let within = |interval: &Cubic, sense: bool| {
            let local = interval.to_local(flat);
            if interval.least_square(local) > reach * reach {
                return None;
            }
            let mut spans = 0..SPANS as usize;
            let near = |k: &usize| interval.is_near(*k, local, reach);
            if sense { spans.find(near) } else { spans.rev().find(near) }
        };
        let place =
            |(i, interval): (usize, &Cubic), sense: bool| Some(i * SPANS as usize + within(interval, sense)?);
        let first = self.intervals.iter().enumerate().find_map(|one| place(one, true))?;
        let last = self.intervals.iter().enumerate().rev().find_map(|one| place(one, false))?;
        let spans =
            self.intervals.iter().flat_map(|interval| (0..SPANS as usize).map(move |k| (interval, k)));
        let count = (last + 1).saturating_sub(first);
        for (number, (interval, k)) in spans.skip(first).take(count).enumerate() {
            let bends = if interval.straight() { [0.0; 2] } else { *interval.bends.get(k)? };
            for (found, (bend, side)) in found.curvature.iter_mut().zip(bends.into_iter().zip([1.0, -1.0])) {
                let sharp = number > 0 && k == 0 && side * interval.turn > SMOOTH;
                *found = found.max(if sharp { f64::INFINITY } else { bend });
            }
            for slope in interval.slopes.get(k)? {
                let own = (interval.normal_axis() - interval.along * *slope) / slope.hypot(1.0);
                found.cosine = found.cosine.min(own.dot(&normal));
            }
        }
        (found.cosine >= least).then_some(found)
    }

    /// Whether points near another one, no deeper beyond the curve than given, have one nearest point each: that of opposite walls
    /// is not the same.
    pub(super) fn is_alone(&self, side: f64, foot: &Foot, center: &Vec3, reach: f64, depth: f64) -> bool {
        self.facing(center, reach, &foot.normal, LEAST_COSINE).is_some_and(|facing| {
            let [natural, other] = facing.curvature;
            depth * (if side > 0.0 { natural } else { other }).max(0.0) * facing.lean() < 1.0
        })
    }

    /// Whether the boxes of all intervals are farther from a point than a distance.
    pub(super) fn keeps_off(&self, p: &Vec3, distance: f64) -> bool {
        let flat = self.flat(p);
        self.intervals.iter().all(|interval| {
            let local = interval.to_local(flat);
            // The spans' own boxes are smaller.
            interval.least_square(local) > distance * distance
                || (0..SPANS as usize).all(|k| !interval.is_near(k, local, distance))
        })
    }

    /// Greatest curvature against a side of the stretches of the directrix that lie within a distance of a point:
    /// positive where the curve turns away from that side, infinite at a corner that does.
    pub(super) fn greatest_curvature(&self, side: f64, center: &Vec3, reach: f64) -> f64 {
        let flat = self.flat(center);
        let mut greatest = f64::NEG_INFINITY;
        for interval in &self.intervals {
            let local = interval.to_local(flat);
            // Turning to the right is turning away from the natural normal.
            if side * interval.turn > SMOOTH && local.norm_squared() <= reach * reach {
                return f64::INFINITY;
            }
            if interval.least_square(local) <= reach * reach {
                greatest = greatest.max(interval.greatest_curvature(side, local, reach));
            }
        }
        greatest
    }

    pub(super) fn hessian(&self, foot: &Foot, curvature: f64) -> Matrix3<f64> {
        let tangent = self.axes[2].cross(&foot.normal);
        let stretch = 1.0 + foot.distance * curvature;
        if stretch.abs() <= 1e-12 {
            return Matrix3::zeros();
        }
        tangent * tangent.transpose() * (curvature / stretch)
    }

    /// Parameters of all crossings of a ray with the curve (DDTABC), in units of |direction|.
    pub(super) fn ray_roots(&self, from: &Vec3, direction: &Vec3) -> Vec<f64> {
        let (p, d) = (self.flat(from), self.flat(direction));
        let mut roots = Vec::new();
        if d.norm() <= 1e-12 * direction.norm() {
            return roots;
        }
        for interval in &self.intervals {
            interval.ray_roots(p, d, &mut roots);
        }
        roots
    }
}

impl Cubic {
    /// Whether a point may be within reach of a span, by the least height of the span over its chord and the greatest, or of the
    /// straight line that goes on from it.
    fn is_near(&self, k: usize, local: Vec2, reach: f64) -> bool {
        let width = self.length / f64::from(SPANS);
        let (start, end) = (k as f64 * width, (k + 1) as f64 * width);
        let aside = (start - local.x).max(local.x - end).max(0.0);
        let steepest = self.slopes.get(k).map_or(0.0, |[least, greatest]| least.abs().max(greatest.abs()));
        // Between its ends the span keeps to the steepest lines through both.
        let (middle, half) = (self.height(start)[0] + self.height(end)[0], width * steepest);
        let heights = [0.5 * (middle - half), 0.5 * (middle + half)];
        let beyond = |open: bool, from: f64, sense: f64| {
            let [height, slope, _] = self.height(from);
            let (w, way) = (local - Vec2::new(from, height), Vec2::new(sense, sense * slope));
            let along = (w.dot(&way) / way.norm_squared()).max(0.0);
            open && (w - way * along).norm_squared() <= reach * reach
        };
        aside * aside + least_offset(heights, local.y) <= reach * reach
            || beyond(k == 0 && self.open[0], 0.0, -1.0)
            || beyond(k + 1 == SPANS as usize && self.open[1], self.length, 1.0)
    }

    /// A bound of the curvature against a side over the spans within reach of a point.
    fn greatest_curvature(&self, side: f64, local: Vec2, reach: f64) -> f64 {
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
    fn slope_range(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let [a, b, _] = self.coefficients;
        let turn = (-b / (3.0 * a)).clamp(from, to);
        let turn = if turn.is_nan() { from } else { turn };
        let slopes = [from, to, turn].map(|s| self.height(s)[1]);
        [slopes[0].min(slopes[1]).min(slopes[2]), slopes[0].max(slopes[1]).max(slopes[2])]
    }

    fn ray_roots(&self, p: Vec2, d: Vec2, roots: &mut Vec<f64>) {
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
        for s in super::solve_quadratic(3.0 * a, b, c - slope) {
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

/// Squared distance of a height from a range of heights.
fn least_offset(bounds: [f64; 2], height: f64) -> f64 {
    let away = (bounds[0] - height).max(height - bounds[1]).max(0.0);
    away * away
}

/// Root of a monotone function between limits of opposite sign.
pub(super) fn bracketed_root(f: &impl Fn(f64) -> f64, low: f64, high: f64) -> Option<f64> {
    let (mut low, mut high) = (low, high);
    let (at_low, at_high) = (f(low), f(high));
    if at_low == 0.0 {
        return Some(low);
    }
    if at_high == 0.0 {
        return Some(high);
    }
    if (at_low > 0.0) == (at_high > 0.0) {
        return None;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if (f(middle) > 0.0) == (at_low > 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}
