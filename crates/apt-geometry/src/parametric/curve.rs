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
        SpaceCurve { arcs, cross, flow: None }
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
        let Some((index, t)) = self.locate(parameter) else { return Self::DEFAULT_CROSS };
        let given = |index: usize| self.cross.get(index).copied().flatten();
        match (given(index), given(index + 1)) {
            (Some(first), Some(last)) => first * (1.0 - t) + last * t,
            (Some(one), None) | (None, Some(one)) => one,
            (None, None) => Self::DEFAULT_CROSS,
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
