//! The flow of a curve: a second parameter that follows length, chord, angle or the arcs' own parameters.

use serde::{Deserialize, Serialize};

use crate::Vec3;

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
        /// The unit direction.
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

/// Ranges and segments of a curve's flow. The global flow parameter is the index of the segment plus the local one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Flow {
    /// The ranges in order, without gaps.
    pub ranges: Vec<FlowRange>,
    /// The segments in order.
    pub segments: Vec<FlowSegment>,
}
