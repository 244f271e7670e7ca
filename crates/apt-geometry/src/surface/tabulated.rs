//! Tabulated cylinders: a piecewise cubic directrix ruled along a straight line.

mod boxes;
mod cubic;
mod forms;

use nalgebra::{Matrix3, Vector2};

use self::{
    boxes::Boxes,
    cubic::{Cubic, SPANS},
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
/// Curvature of a corner: large enough to be infinite for any tool, small enough to compute with.
const CORNER_CURVATURE: f64 = 1e12;

/// The directrix with its frame.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectrixCurve {
    axes: [Vec3; 3],
    intervals: Vec<Cubic>,
    boxes: Boxes,
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
        if intervals.is_empty() {
            return None;
        }
        let boxes = Boxes::of(intervals.iter().map(Cubic::upright_box));
        Some(Self { axes, intervals, boxes })
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
