//! Space curves and sculptured surfaces: rational cubic arcs and rational bicubic patches in Bézier form, with
//! everything that can be said of them from their control points.
//!
//! Lengths are in the part program's unit. Parameters of an arc or a patch run from 0 to 1; global parameters add the
//! index of the arc, or of the column and row of patches.

mod arc;
mod basis;
mod curve;
mod extended;
mod flanged;
mod flow;
mod measure;
mod nearest;
mod patch;
mod pierce;
mod surface;
mod topology;

pub use arc::{ArcPoint, CurveArc};
pub use curve::{CurveFrame, SpaceCurve};
pub use extended::{Extended, ExtendedPatch, SCULPTURED_BEYOND, Side};
pub use flanged::Flanged;
pub use flow::{Flow, FlowKind, FlowRange, FlowSegment, SegmentMeasure};
pub use measure::{CurvatureAt, Curvatures};
pub use nearest::SurfacePlace;
pub use patch::{Patch, PatchNormal, PatchPoint};
pub use surface::{Mesh, SculpturedSurface};
pub use topology::{Edge, Neighbour};
