//! The flow of a curve: a second parameter that follows length, chord, angle or the arcs' own parameters.

use serde::{Deserialize, Serialize};

use super::{arc::CurveArc, curve::SpaceCurve};
use crate::{Vec3, canonical::Matrix};

/// What the flow of a range of arcs measures.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum FlowKind {
    /// The length of the curve. The factor of the tolerance is kept; the length here is exact.
    Arc {
        /// Factor of the tolerance, 0.005 where none was given.
        tolerance: f64,
    },
    /// The parameter of the arcs.
    Param,
    /// The way along a direction.
    Chord {
        /// The direction; of unit length unless the curve was moved by a map that changes lengths.
        direction: Vec3,
    },
    /// The angle about an axis through a point, in radians.
    Angle {
        /// A point of the axis.
        center: Vec3,
        /// Unit direction of the axis.
        axis: Vec3,
    },
}

/// The flow over the arcs from `first` to `last`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FlowRange {
    /// What it measures.
    pub kind: FlowKind,
    /// The arc boundary where it begins, 0 at the start of the curve.
    pub first: usize,
    /// The arc boundary where it ends.
    pub last: usize,
}

/// How the parameter runs inside a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SegmentMeasure {
    /// In proportion to the flow.
    Length,
    /// In proportion to the parameter of the arcs.
    Param,
}

/// A segment of the flow, which corresponds to the segment of the same number of other curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FlowSegment {
    /// How the parameter runs inside.
    pub measure: SegmentMeasure,
    /// Where it begins, as a global parameter of the arcs.
    pub first: f64,
    /// Where it ends.
    pub last: f64,
}

impl FlowSegment {
    /// The global parameter of the arcs at a share of the segment, in proportion to the parameter that the language numbers.
    pub fn along(&self, curve: &SpaceCurve, share: f64) -> f64 {
        if curve.breaks.is_empty() {
            return self.first + (self.last - self.first) * share;
        }
        let (first, last) = (curve.numbered(self.first), curve.numbered(self.last));
        curve.unnumbered(first + (last - first) * share)
    }
}

/// Ranges and segments of a curve's flow. The global flow parameter is the index of the segment plus the local one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Flow {
    /// The ranges in order, without gaps.
    pub ranges: Vec<FlowRange>,
    /// The segments in order.
    pub segments: Vec<FlowSegment>,
}

/// Halvings that find the place of an amount of flow: as many as the digits of a parameter.
const HALVINGS: usize = 60;
/// Pieces per arc over which a length is integrated.
const LENGTH_PIECES: usize = 8;
/// Places per arc at which a flow is tested for growth.
const GROWTH_PLACES: usize = 32;
/// Abscissae and weights of the Gauss rule of order five on −1 to 1.
const GAUSS: [(f64, f64); 5] = [
    (0.0, 128.0 / 225.0),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

impl FlowKind {
    /// How much of this is between two parameters of an arc.
    pub fn amount(&self, arc: &CurveArc, from: f64, to: f64) -> f64 {
        match self {
            FlowKind::Param => to - from,
            FlowKind::Arc { .. } => length(arc, from, to),
            FlowKind::Chord { direction } => {
                direction.dot(&(arc.evaluate(to).position - arc.evaluate(from).position))
            }
            FlowKind::Angle { center, axis } => {
                let ray = |t: f64| {
                    let ray = arc.evaluate(t).position - center;
                    ray - axis * axis.dot(&ray)
                };
                // In pieces of less than half a turn.
                let place = |piece: usize| from + (to - from) * piece as f64 / LENGTH_PIECES as f64;
                (0..LENGTH_PIECES)
                    .map(|piece| {
                        let (a, b) = (ray(place(piece)), ray(place(piece + 1)));
                        a.cross(&b).dot(axis).atan2(a.dot(&b))
                    })
                    .sum()
            }
        }
    }
}

impl FlowKind {
    /// How fast this grows with the parameter of an arc.
    fn rate(&self, arc: &CurveArc, t: f64) -> f64 {
        let at = arc.evaluate(t);
        match self {
            FlowKind::Param => 1.0,
            FlowKind::Arc { .. } => at.first.norm(),
            FlowKind::Chord { direction } => direction.dot(&at.first).abs(),
            FlowKind::Angle { center, axis } => {
                let ray = at.position - center;
                let ray = ray - axis * axis.dot(&ray);
                (ray.cross(&at.first).dot(axis) / ray.norm_squared()).abs()
            }
        }
    }
}

/// How much of what is measured a unit of it is along an arc of a curve (index): the parameter that the language numbers runs through several
/// arcs where these are one to the language.
fn unit(kind: &FlowKind, curve: &SpaceCurve, arc: usize) -> f64 {
    if *kind == FlowKind::Param { 1.0 / curve.rate(arc) } else { 1.0 }
}

/// The parameter of an arc where an amount of flow from the low end is reached: Newton's steps, halving where they leave
/// what is known to hold the place.
fn place_of(kind: &FlowKind, arc: &CurveArc, [start, end]: [f64; 2], wanted: f64, whole: f64) -> f64 {
    let (mut low, mut high) = (start, end);
    let mut t = start + (end - start) * (wanted / whole);
    for _ in 0..HALVINGS {
        let over = kind.amount(arc, start, t).abs() - wanted;
        if over <= 0.0 {
            low = t;
        } else {
            high = t;
        }
        let next = t - over / kind.rate(arc, t);
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - t).abs() <= f64::EPSILON {
            return next;
        }
        t = next;
    }
    t
}

/// The length of an arc between two parameters.
fn length(arc: &CurveArc, from: f64, to: f64) -> f64 {
    let half = 0.5 * (to - from) / LENGTH_PIECES as f64;
    let mut sum = 0.0;
    for piece in 0..LENGTH_PIECES {
        let middle = from + (2.0 * piece as f64 + 1.0) * half;
        for (place, weight) in GAUSS {
            sum += weight * arc.evaluate(middle + place * half).first.norm();
        }
    }
    sum * half
}

impl Flow {
    /// Whether every range grows all along, or the index of the first that does not.
    ///
    /// # Errors
    /// The index of the range.
    pub fn check(&self, curve: &SpaceCurve) -> Result<(), usize> {
        // A collapsed curve flows by its parameter alone.
        if curve.size() == 0.0 {
            return Ok(());
        }
        for (index, range) in self.ranges.iter().enumerate() {
            let mut sense = 0.0;
            for arc in curve.arcs.get(range.first..range.last).unwrap_or_default() {
                for place in 0..GROWTH_PLACES {
                    let at = |place: usize| place as f64 / GROWTH_PLACES as f64;
                    let amount = range.kind.amount(arc, at(place), at(place + 1));
                    if sense == 0.0 {
                        sense = amount.signum();
                    }
                    if amount * sense <= 0.0 || !amount.is_finite() {
                        return Err(index);
                    }
                }
            }
        }
        Ok(())
    }

    /// The flow between two global parameters of the arcs.
    pub fn amount(&self, curve: &SpaceCurve, from: f64, to: f64) -> f64 {
        let mut sum = 0.0;
        for range in &self.ranges {
            for index in range.first..range.last {
                let Some(arc) = curve.arcs.get(index) else { break };
                let (low, high) = ((from - index as f64).max(0.0), (to - index as f64).min(1.0));
                if low < high {
                    sum += range.kind.amount(arc, low, high).abs() * unit(&range.kind, curve, index);
                }
            }
        }
        sum
    }

    /// The flow of the curve's image under an affine map: a chord is measured by the same planes, an angle about the image
    /// of its axis (exactly so under similarities).
    pub fn transformed(&self, matrix: &Matrix) -> Flow {
        let kind = |kind: FlowKind| match kind {
            FlowKind::Chord { direction } => {
                let back = matrix.inverse().map(|inverse| inverse.linear().transpose() * direction);
                FlowKind::Chord { direction: back.unwrap_or(direction) }
            }
            FlowKind::Angle { center, axis } => {
                let turned = matrix.apply_vector(&axis).try_normalize(f64::MIN_POSITIVE);
                FlowKind::Angle { center: matrix.apply_point(&center), axis: turned.unwrap_or(axis) }
            }
            measured => measured,
        };
        let ranges = self.ranges.iter().map(|range| FlowRange { kind: kind(range.kind), ..*range }).collect();
        Flow { ranges, segments: self.segments.clone() }
    }

    /// The range that holds an arc (index).
    fn range_of(&self, arc: usize) -> Option<&FlowRange> {
        self.ranges.iter().find(|range| (range.first..range.last).contains(&arc))
    }

    /// The global parameter of the arcs at a local parameter of a segment (index); `None` if there is no such segment.
    pub fn arc_parameter(&self, curve: &SpaceCurve, segment: usize, local: f64) -> Option<f64> {
        let segment = self.segments.get(segment)?;
        let along = |share: f64| segment.along(curve, share);
        let total = self.amount(curve, segment.first, segment.last);
        if segment.measure == SegmentMeasure::Param || total <= 0.0 || local <= 0.0 || local >= 1.0 {
            return Some(along(local.clamp(0.0, 1.0)));
        }
        let mut left = local * total;
        for (index, arc) in curve.arcs.iter().enumerate() {
            let start = index as f64;
            let (low, high) = ((segment.first - start).max(0.0), (segment.last - start).min(1.0));
            let Some(range) = self.range_of(index).filter(|_| low < high) else { continue };
            let (amount, unit) = (range.kind.amount(arc, low, high).abs(), unit(&range.kind, curve, index));
            if left <= amount * unit {
                return Some(start + place_of(&range.kind, arc, [low, high], left / unit, amount));
            }
            left -= amount * unit;
        }
        Some(segment.last)
    }

    /// The flow of a curve in equal parts.
    pub fn even(curve: &SpaceCurve, parts: usize, measure: SegmentMeasure) -> Flow {
        let (arcs, step) = (curve.arcs.len(), curve.extent() / parts.max(1) as f64);
        let part = |index: usize| FlowSegment {
            measure,
            first: index as f64 * step,
            last: if index + 1 == parts { arcs as f64 } else { (index + 1) as f64 * step },
        };
        Flow {
            ranges: vec![FlowRange { kind: FlowKind::Param, first: 0, last: arcs }],
            segments: (0..parts).map(part).collect(),
        }
    }

    /// Derivative of the arcs' parameter by the local parameter of a segment, at a place of an arc (index).
    pub fn pace(&self, curve: &SpaceCurve, segment: usize, arc: usize, t: f64) -> f64 {
        let Some(part) = self.segments.get(segment) else { return 0.0 };
        let even = (curve.numbered(part.last) - curve.numbered(part.first)) * curve.rate(arc);
        let total = self.amount(curve, part.first, part.last);
        let (Some(range), Some(whole), SegmentMeasure::Length) =
            (self.range_of(arc), curve.arcs.get(arc), part.measure)
        else {
            return even;
        };
        let rate = range.kind.rate(whole, t) * unit(&range.kind, curve, arc);
        if total > 0.0 && rate > 0.0 { total / rate } else { even }
    }

    /// The global parameter of the flow at a global parameter of the arcs; `None` outside the segments.
    pub fn flow_parameter(&self, curve: &SpaceCurve, parameter: f64) -> Option<f64> {
        let inside = |segment: &FlowSegment| (segment.first..=segment.last).contains(&parameter);
        let index = self.segments.iter().position(inside)?;
        let segment = self.segments.get(index)?;
        let total = self.amount(curve, segment.first, segment.last);
        let local = match segment.measure {
            SegmentMeasure::Length if total > 0.0 => self.amount(curve, segment.first, parameter) / total,
            _ => {
                let first = curve.numbered(segment.first);
                (curve.numbered(parameter) - first) / (curve.numbered(segment.last) - first)
            }
        };
        Some(index as f64 + local)
    }
}
