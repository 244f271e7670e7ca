//! What INTOF, PARMF and NUMF ask of parametric geometry, as typed arguments.

use std::sync::Arc;

use crate::{
    Vec3,
    canonical::Plane,
    parametric::{SculpturedSurface, SpaceCurve},
};

/// PARAM or FLOW.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurveParameter {
    /// PARAM: the parameter of the arcs.
    Param,
    /// FLOW: that of the segments of the flow.
    Flow,
}

/// Where INTOF looks.
#[derive(Debug, Clone, PartialEq)]
pub enum ParametricQuery {
    /// `s,PARAM,u,v,k`.
    SurfaceParameters {
        /// The surface.
        surface: Arc<SculpturedSurface>,
        /// u, local to the patch or global.
        u: f64,
        /// v likewise.
        v: f64,
        /// Patch number from 1, 0 for global parameters, −1 for the last patch.
        patch: f64,
    },
    /// `c,{PARAM|FLOW},u[,k]`.
    CurveParameter {
        /// The curve.
        curve: Arc<SpaceCurve>,
        /// Which parameter.
        kind: CurveParameter,
        /// Its value, local to the arc or segment or global.
        value: f64,
        /// Arc or segment number from 1, 0 for global, −1 for the last one.
        number: f64,
    },
    /// `s,p`: the place nearest to a point.
    SurfaceNearest {
        /// The surface.
        surface: Arc<SculpturedSurface>,
        /// The point.
        point: Vec3,
    },
    /// `s,p,q`, `s,p,v` and `s,p,v,q`: on a line.
    SurfaceLine {
        /// The surface.
        surface: Arc<SculpturedSurface>,
        /// A point of the line.
        point: Vec3,
        /// Its direction, of any length.
        direction: Vec3,
        /// Of several places the one nearest to this point is meant.
        near: Vec3,
    },
    /// `{line|plane},c,p`: a curve and a plane (a line is one that contains the z direction).
    CurvePlane {
        /// The curve.
        curve: Arc<SpaceCurve>,
        /// The plane.
        plane: Plane,
        /// Of several places the one nearest to this point is meant.
        near: Vec3,
    },
}

/// What VECTOR/INTOF takes of the place found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParametricDirection {
    /// TANSPL: the derivative along the spline.
    Tangent,
    /// CRSSPL: the derivative across.
    Cross,
    /// NORMAL.
    Normal,
    /// BINORM.
    Binormal,
}

/// A place on parametric geometry, with the parameters that PARMF gives. Numbers count from 1.
#[derive(Debug, Clone, PartialEq)]
pub enum ParametricPlace {
    /// On a surface.
    Surface {
        /// The place.
        position: Vec3,
        /// Number of the patch.
        patch: usize,
        /// Local parameters.
        local: [f64; 2],
        /// Global parameters.
        global: [f64; 2],
    },
    /// On a curve.
    Curve {
        /// The place.
        position: Vec3,
        /// Number of the arc.
        arc: usize,
        /// Local parameter of the arc.
        local: f64,
        /// Global parameter of the arcs.
        global: f64,
        /// Global parameter of the flow, where the curve has one and the place is on it.
        flow: Option<f64>,
    },
}

/// What NUMF counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParametricCount {
    /// ARC: arcs of a curve.
    Arcs,
    /// SEG: segments of the flow of a curve.
    Segments,
    /// PATCH: patches of a surface.
    Patches,
    /// SPLINE: splines of a surface.
    Splines,
    /// CRSSPL: cross splines of a surface.
    CrossSplines,
}
