//! Tabulated cylinders: a piecewise cubic directrix ruled along a straight line.

mod apart;
mod boxes;
mod cubic;
mod extensions;
mod forms;
mod stretch;

use nalgebra::{Matrix3, Vector2};

use self::{
    boxes::Boxes,
    cubic::{Cubic, SPANS},
    extensions::Beyond,
};
use super::{Chart, Foot, Place, chart::Facing, part::LEAST_COSINE, sheet::Jet};
use crate::{Vec3, canonical::TabulatedCylinder};

type Vec2 = Vector2<f64>;

/// Cosine defect above which the nearest point is a corner of the curve.
const CORNER: f64 = 1e-9;
/// Distance from the curve, relative to the size of the coordinates, below which a point lies on it.
const ON_CURVE: f64 = 1e-12;
/// Sine of a turn between intervals below which they join smoothly.
const SMOOTH: f64 = 1e-7;
/// How near the end of an interval, in lengths of it, a nearest place is the joint with its neighbour.
const JOINT: f64 = 1e-9;
/// Curvature of a corner: large enough to be infinite for any tool, small enough to compute with.
const CORNER_CURVATURE: f64 = 1e12;

/// The directrix with its frame.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectrixCurve {
    axes: [Vec3; 3],
    intervals: Vec<Cubic>,
    boxes: Boxes,
    /// Whether its extensions meet, so that the last interval is followed by the first.
    closed: bool,
    /// Ends beyond which it does not go on.
    tips: Vec<Vec2>,
}

impl DirectrixCurve {
    pub(super) fn new(cylinder: &TabulatedCylinder) -> Option<Self> {
        let mut axes = cylinder.axes;
        for axis in &mut axes {
            *axis = super::unit(axis)?;
        }
        let mut intervals: Vec<Cubic> = Vec::with_capacity(cylinder.intervals.len());
        for (k, interval) in cylinder.intervals.iter().enumerate() {
            let start = Vec2::new(interval.u, interval.v);
            let end = match cylinder.intervals.get(k + 1) {
                Some(next) => Vec2::new(next.u, next.v),
                None => Vec2::from(cylinder.last),
            };
            // Extensions that meet at once have no length.
            if start != end {
                intervals.push(Cubic::new(start, end, interval.a, interval.b)?);
            }
        }
        let (mut intervals, mut closed) = extensions::without_extensions(intervals);
        let mut tips = Vec::new();
        match Beyond::of(&intervals) {
            _ if closed => {}
            Beyond::Meeting(meeting) => {
                intervals = extensions::closed_at(meeting, intervals)?;
                closed = true;
            }
            Beyond::Apart([before, after]) => {
                let (first, last) = (intervals.first_mut()?.start, Vec2::from(cylinder.last));
                intervals.first_mut()?.open[0] = before;
                intervals.last_mut()?.open[1] = after;
                tips.extend(
                    [(before, first), (after, last)].into_iter().filter(|end| !end.0).map(|end| end.1),
                );
            }
        }
        let boxes = Boxes::of(intervals.iter().map(Cubic::upright_box));
        let mut curve = Self { axes, intervals, boxes, closed, tips };
        for k in 0..curve.intervals.len() {
            if let Some(before) = curve.neighbour(k, false) {
                let (end, start) = (before.direction(before.length), curve.intervals[k].direction(0.0));
                curve.intervals[k].turn = end.y * start.x - end.x * start.y;
            }
        }
        Some(curve)
    }

    /// The interval before or after one; none at an end of the curve.
    fn neighbour(&self, k: usize, after: bool) -> Option<&Cubic> {
        self.intervals.get(self.number_beside(k, after)?)
    }

    fn number_beside(&self, k: usize, after: bool) -> Option<usize> {
        let count = self.intervals.len();
        let inner = if after { k + 1 < count } else { k > 0 };
        (inner || self.closed).then(|| if after { (k + 1) % count } else { (k + count - 1) % count })
    }

    /// Whether it ends somewhere.
    pub(super) fn has_ends(&self) -> bool {
        !self.tips.is_empty()
    }

    /// Whether the place nearest to a point is one where it ends.
    pub(super) fn ends_at(&self, p: &Vec3) -> bool {
        let place = self.flat(&self.foot(p).0.point);
        self.tips.iter().any(|tip| (tip - place).norm() <= ON_CURVE * (tip.norm() + self.size()))
    }

    /// Length of the chords of its intervals.
    fn size(&self) -> f64 {
        self.intervals.iter().map(|interval| interval.length).sum()
    }

    /// Whether it ends within reach of a point.
    fn ends_within(&self, flat: Vec2, reach: f64) -> bool {
        self.tips.iter().any(|tip| (tip - flat).norm() <= reach)
    }

    /// Unit direction of the generators.
    pub fn generator(&self) -> Vec3 {
        self.axes[2]
    }

    /// The points between intervals, in the plane through the origin.
    pub(super) fn joints(&self) -> Vec<Vec3> {
        let first = if self.closed { 0 } else { 1 };
        self.intervals.iter().skip(first).map(|interval| self.lift(interval.start)).collect()
    }

    fn flat(&self, p: &Vec3) -> Vec2 {
        Vec2::new(self.axes[0].dot(p), self.axes[1].dot(p))
    }

    fn lift(&self, v: Vec2) -> Vec3 {
        self.axes[0] * v.x + self.axes[1] * v.y
    }

    /// The interval with the nearest point and its parameter there; that is no number for a place without coordinates.
    fn nearest(&self, flat: Vec2) -> (usize, f64) {
        if !flat.iter().all(|x| x.is_finite()) {
            return (0, f64::NAN);
        }
        let mut best = (0, 0.0, f64::INFINITY);
        self.boxes.visit(flat, |k, nearest| {
            let Some(interval) = self.intervals.get(k) else { return nearest };
            let local = interval.to_local(flat);
            if interval.least_square(local) <= best.2 {
                let (s, square) = interval.nearest(local);
                if square < best.2 {
                    best = (k, s, square);
                }
            }
            best.2
        });
        (best.0, best.1)
    }

    /// The nearest point, and the curvature of the directrix there, positive where it curves away from the natural
    /// normal `(−sin φ, cos φ)`.
    pub(super) fn foot(&self, p: &Vec3) -> (Foot, f64) {
        let flat = self.flat(p);
        let (k, s) = self.nearest(flat);
        let interval = &self.intervals[k];
        let [h, h1, h2] = interval.height(s);
        let norm = (1.0 + h1 * h1).sqrt();
        let normal = (interval.normal_axis() - interval.along * h1) / norm;
        let point = interval.start + interval.along * s + interval.normal_axis() * h;
        let offset = flat - point;
        let (height, length) = (offset.dot(&normal), offset.norm());
        // At a corner between intervals the nearest point stays while the normal turns. On the curve itself the offset is
        // rounding and says nothing.
        let corner =
            height.abs() < length * (1.0 - CORNER) && length > ON_CURVE * (interval.length + flat.norm());
        let height = if corner { offset.dot(&(normal + self.normal_beside(k, s))) } else { height };
        let distance = if corner { length.copysign(height) } else { height };
        let curvature = if corner { CORNER_CURVATURE.copysign(height) } else { -h2 / (norm * norm * norm) };
        let normal = self.lift(if corner { offset / distance } else { normal });
        (Foot { distance, point: p - normal * distance, normal }, curvature)
    }

    /// The natural normal on the other side of a joint, of an interval that a corner of the curve is at an end of; no direction
    /// elsewhere. Between both normals lie those of the side that the corner stands out to, however sharp it is.
    fn normal_beside(&self, k: usize, s: f64) -> Vec2 {
        let length = self.intervals[k].length;
        let is_after = s > 0.5 * length;
        let is_joint = s.min(length - s).abs() <= JOINT * length;
        let beside = if is_joint { self.neighbour(k, is_after) } else { None };
        beside.map_or_else(Vec2::zeros, |beside| {
            let direction = beside.direction(if is_after { 0.0 } else { beside.length });
            Vec2::new(-direction.y, direction.x)
        })
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
        let piece = self.number_beside(place.piece, after)?;
        let next = self.intervals.get(piece)?;
        let s = if before { next.length + s } else { s - interval.length };
        let within = (next.open[0] || s >= 0.0) && (next.open[1] || s <= next.length);
        within.then_some(Place { piece, at: [z, s] })
    }

    /// The interval that a walk along the curve about a point begins with: of a closed one that which is farthest away.
    fn beginning(&self, flat: Vec2) -> usize {
        if !self.closed {
            return 0;
        }
        let square = |interval: &Cubic| interval.least_square(interval.to_local(flat));
        let farthest = self.intervals.iter().enumerate().max_by(|a, b| square(a.1).total_cmp(&square(b.1)));
        farthest.map_or(0, |one| one.0)
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
        if self.ends_within(flat, reach) {
            return None;
        }
        let (rest, begun) = self.intervals.split_at(self.beginning(flat));
        let intervals = || begun.iter().chain(rest);
        let first = intervals().enumerate().find_map(|one| place(one, true))?;
        let count = self.intervals.len();
        let last =
            intervals().rev().zip(1..).find_map(|(interval, k)| place((count - k, interval), false))?;
        let spans = intervals().flat_map(|interval| (0..SPANS as usize).map(move |k| (interval, k)));
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
        let mut greatest = if self.ends_within(flat, reach) { f64::INFINITY } else { f64::NEG_INFINITY };
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

#[cfg(test)]
mod tests;
