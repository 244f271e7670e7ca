//! A space curve: arcs joined end to end.

use serde::{Deserialize, Serialize};

use super::{
    arc::{ArcPoint, CurveArc},
    flow::Flow,
};
use crate::{Vec3, canonical::Matrix};

/// A parameter that lies outside its range by less than this belongs to its end: operands are decimal numbers.
const PARAMETER_SLACK: f64 = 1e-12;
/// Length of the binormal, as a share of its factors, below which a curve is straight there.
const STRAIGHT: f64 = 1e-9;

/// A curve of rational cubic arcs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpaceCurve {
    /// The arcs in order.
    pub arcs: Vec<CurveArc>,
    /// Where the arcs end as the language numbers them, beginning with 0; empty where each is one of its arcs. An arc that
    /// turns too far for positive weights is made of two, and counts as one.
    pub breaks: Vec<f64>,
    /// The cross directions (CRSSPL) at the ends of the arcs, one more than there are arcs, where given.
    pub cross: Vec<Option<Vec3>>,
    /// The second parameter, where the definition has FLOW.
    pub flow: Option<Flow>,
}

/// The moving frame of a curve and its curvature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveFrame {
    /// Unit tangent; zero where the curve stands still.
    pub tangent: Vec3,
    /// Unit normal, towards the centre of curvature; zero where the curve is straight.
    pub normal: Vec3,
    /// Unit binormal, tangent × normal; zero where the curve is straight.
    pub binormal: Vec3,
    /// Curvature in reciprocal units of length, never negative.
    pub curvature: f64,
}

impl SpaceCurve {
    /// The cross direction of a curve that was given none: what the public system's normals of such curves are made with.
    pub const DEFAULT_CROSS: Vec3 = Vec3::new(1.0, 1.0, 0.0);

    /// A curve of arcs without cross directions and flow.
    pub fn of_arcs(arcs: Vec<CurveArc>) -> SpaceCurve {
        let cross = vec![None; arcs.len() + 1];
        SpaceCurve { arcs, breaks: Vec::new(), cross, flow: None }
    }

    /// How many arcs the language counts.
    pub fn count(&self) -> usize {
        self.breaks.last().map_or(self.arcs.len(), |end| end.round() as usize)
    }

    /// Where an arc (index) begins and ends as the language numbers parameters.
    fn range(&self, arc: usize) -> [f64; 2] {
        match (self.breaks.get(arc), self.breaks.get(arc + 1)) {
            (Some(first), Some(last)) => [*first, *last],
            _ => [arc as f64, arc as f64 + 1.0],
        }
    }

    /// How fast the parameter of an arc (index) grows with the one that the language numbers.
    pub fn rate(&self, arc: usize) -> f64 {
        let [first, last] = self.range(arc);
        1.0 / (last - first)
    }

    /// The global parameter as the language numbers it, from that of the arcs.
    pub fn numbered(&self, parameter: f64) -> f64 {
        if self.breaks.is_empty() {
            return parameter;
        }
        let index = (parameter.max(0.0) as usize).min(self.arcs.len().saturating_sub(1));
        let ([first, last], share) = (self.range(index), parameter - index as f64);
        // The end is that of the list, not what rounding makes of it.
        if share >= 1.0 { last } else { first + (last - first) * share }
    }

    /// The global parameter of the arcs, from the one that the language numbers.
    pub fn unnumbered(&self, parameter: f64) -> f64 {
        if self.breaks.is_empty() {
            return parameter;
        }
        let last = self.arcs.len().max(1);
        let index = self.breaks.partition_point(|end| *end <= parameter).clamp(1, last) - 1;
        let [first, last] = self.range(index);
        index as f64 + (parameter - first) / (last - first)
    }

    /// The arc (index) and its parameter at a parameter of an arc as the language numbers them (from 1): the end of one is not
    /// the start of the next.
    pub fn within(&self, number: usize, local: f64) -> Option<(usize, f64)> {
        let local = local.clamp(0.0, 1.0);
        if self.breaks.is_empty() {
            return (number >= 1 && number <= self.arcs.len()).then(|| (number - 1, local));
        }
        let start = number.checked_sub(1)? as f64;
        let parameter = start + local;
        let inside = |arc: &usize| {
            let [first, last] = self.range(*arc);
            first >= start && last >= parameter && last <= start + 1.0
        };
        let index = (0..self.arcs.len()).find(inside)?;
        let [first, last] = self.range(index);
        Some((index, ((parameter - first) / (last - first)).clamp(0.0, 1.0)))
    }

    /// The greatest global parameter, the number of arcs.
    pub fn extent(&self) -> f64 {
        self.arcs.len() as f64
    }

    /// The arc (index) and the local parameter at a global one; `None` outside the curve.
    pub fn locate(&self, parameter: f64) -> Option<(usize, f64)> {
        let count = self.arcs.len();
        let end = count as f64;
        let within = parameter >= -PARAMETER_SLACK && parameter <= end + PARAMETER_SLACK * end.max(1.0);
        if count == 0 || !within {
            return None;
        }
        let parameter = parameter.clamp(0.0, end);
        let index = (parameter as usize).min(count - 1);
        Some((index, parameter - index as f64))
    }

    /// The place at a global parameter; `None` outside the curve.
    pub fn evaluate_global(&self, parameter: f64) -> Option<ArcPoint> {
        let (index, t) = self.locate(parameter)?;
        self.arcs.get(index).map(|arc| arc.evaluate(t))
    }

    /// The cross direction at a global parameter: between the given ones of an arc in proportion, the one of an end where
    /// only that is given, and [`SpaceCurve::DEFAULT_CROSS`] without any.
    pub fn cross_at(&self, parameter: f64) -> Vec3 {
        self.given_cross_at(parameter).unwrap_or(Self::DEFAULT_CROSS)
    }

    /// The same where a cross direction is given; `None` also outside the curve.
    pub fn given_cross_at(&self, parameter: f64) -> Option<Vec3> {
        let (arc, t) = self.locate(parameter)?;
        let [first, last] = self.range(arc);
        let (number, share) = (first.floor(), (first + (last - first) * t - first.floor()).min(1.0));
        let given = |number: f64| {
            let arc = self.unnumbered(number).round() as usize;
            self.cross.get(arc).copied().flatten()
        };
        match (given(number), given(number + 1.0)) {
            (Some(first), Some(last)) => Some(first * (1.0 - share) + last * share),
            (Some(one), None) | (None, Some(one)) => Some(one),
            (None, None) => None,
        }
    }

    /// Greatest distance of a control point from the first one.
    pub fn size(&self) -> f64 {
        let mut points = self.arcs.iter().flat_map(CurveArc::points);
        let Some(first) = points.next() else { return 0.0 };
        points.map(|point| (point - first).norm()).fold(0.0, f64::max)
    }

    /// Whether all numbers are finite and all weights positive.
    pub fn is_finite(&self) -> bool {
        let points = self.arcs.iter().flat_map(|arc| arc.control);
        let cross = self.cross.iter().flatten();
        points.into_iter().all(|point| point.iter().all(|number| number.is_finite()) && point.w > 0.0)
            && cross.into_iter().all(|vector| vector.iter().all(|number| number.is_finite()))
    }

    /// The image under an affine map.
    pub fn transformed(&self, matrix: &Matrix) -> SpaceCurve {
        SpaceCurve {
            arcs: self.arcs.iter().map(|arc| arc.transformed(matrix)).collect(),
            breaks: self.breaks.clone(),
            cross: self.cross.iter().map(|cross| cross.map(|vector| matrix.apply_vector(&vector))).collect(),
            flow: self.flow.as_ref().map(|flow| flow.transformed(matrix)),
        }
    }
}

impl ArcPoint {
    /// The moving frame here.
    pub fn frame(&self) -> CurveFrame {
        let (pace, turn) = (self.first.norm(), self.first.cross(&self.second));
        let zero = Vec3::zeros();
        if pace <= f64::MIN_POSITIVE {
            return CurveFrame { tangent: zero, normal: zero, binormal: zero, curvature: 0.0 };
        }
        let tangent = self.first / pace;
        if turn.norm() <= STRAIGHT * pace * pace.max(self.second.norm()) {
            return CurveFrame { tangent, normal: zero, binormal: zero, curvature: 0.0 };
        }
        let binormal = turn.normalize();
        let curvature = turn.norm() / (pace * pace * pace);
        CurveFrame { tangent, normal: binormal.cross(&tangent), binormal, curvature }
    }
}
