//! What defines a space curve (SCURV), as typed arguments.

use std::sync::Arc;

use super::parametric_error::ParametricError;
use crate::{
    Vec3,
    canonical::{Cylinder, Matrix, Plane},
    parametric::{SegmentMeasure, SpaceCurve},
};

/// A point of SPLINE, CURSEG or SMESH with its qualifiers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParametricNode {
    /// The point.
    pub point: Vec3,
    /// TANSPL: the direction of the curve here.
    pub tangent: Option<Vec3>,
    /// NORMAL: the principal normal of a curve, the normal of a surface.
    pub normal: Option<Vec3>,
    /// CRSSPL: the direction across.
    pub cross: Option<Vec3>,
    /// WEIGHT of fairing, 0 to 1; 1 keeps the point.
    pub weight: Option<f64>,
    /// LIMIT: how far fairing may move the point.
    pub limit: Option<f64>,
}

impl ParametricNode {
    /// A point without qualifiers.
    pub fn plain(point: Vec3) -> ParametricNode {
        ParametricNode { point, tangent: None, normal: None, cross: None, weight: None, limit: None }
    }
}

/// Which intersection of SEG is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the words of the language: the one farther along or against x or y")]
pub enum SegmentSide {
    PositiveX,
    NegativeX,
    PositiveY,
    NegativeY,
}

/// A line or a circle, as SEG takes them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LineOrCircle {
    /// A line.
    Line(Plane),
    /// A circle.
    Circle(Cylinder),
}

/// What a flow range measures, as FLOW gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlowMeasure {
    /// ARC with its tolerance factor, if given.
    Arc(Option<f64>),
    /// PARAM.
    Param,
    /// CHORD along a vector; of two points their difference.
    Chord(Vec3),
    /// ANGLE about a point, with the reference vector if given.
    Angle(Vec3, Option<Vec3>),
}

/// A range of FLOW.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowInput {
    /// What it measures.
    pub measure: FlowMeasure,
    /// Arc boundary where it begins.
    pub first: f64,
    /// Arc boundary where it ends.
    pub last: f64,
}

/// A range of SEG.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SegmentInput {
    /// How the parameter runs.
    pub measure: SegmentMeasure,
    /// Arc boundary where it begins.
    pub first: f64,
    /// Arc boundary where it ends.
    pub last: f64,
}

/// How the curve itself is made.
#[derive(Debug, Clone, PartialEq)]
pub enum CurveShape {
    /// CURSEG: one conic arc.
    Conic {
        /// Points with TANSPL and NORMAL.
        nodes: Vec<ParametricNode>,
    },
    /// SPLINE.
    Spline {
        /// WEIGHT before the first point.
        weight: Option<f64>,
        /// LIMIT before the first point.
        limit: Option<f64>,
        /// The points.
        nodes: Vec<ParametricNode>,
    },
    /// COMBIN.
    Combined {
        /// The curves in order.
        curves: Vec<Arc<SpaceCurve>>,
    },
    /// SEG of a line or circle, between its intersections with two others.
    Bounded {
        /// The line or circle.
        base: LineOrCircle,
        /// The first bound and which intersection with it.
        from: (LineOrCircle, SegmentSide),
        /// The last bound and which intersection with it.
        to: (LineOrCircle, SegmentSide),
        /// The plane that supplies z.
        z_surface: Plane,
    },
    /// NURBS.
    BSpline {
        /// Degree, 1 to 3.
        degree: usize,
        /// Knots, one more than points and degree together.
        knots: Vec<f64>,
        /// Control points.
        points: Vec<Vec3>,
        /// Weights; all 1 where none are given.
        weights: Vec<f64>,
    },
}

/// A SCURV definition.
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceCurveDefinition {
    /// The curve.
    pub shape: CurveShape,
    /// FLOW.
    pub flow: Vec<FlowInput>,
    /// SEG after FLOW.
    pub segments: Vec<SegmentInput>,
    /// TRFORM.
    pub matrix: Option<Matrix>,
}

/// A definition that succeeded, with what is worth telling.
#[derive(Debug, Clone, PartialEq)]
pub struct Defined<T> {
    /// The geometry.
    pub geometry: T,
    /// What is doubtful about it.
    pub warnings: Vec<ParametricError>,
}
