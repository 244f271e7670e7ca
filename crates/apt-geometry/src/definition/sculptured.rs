//! What defines a sculptured surface (SSURF), as typed arguments.

use std::sync::Arc;

use super::space_curve::ParametricNode;
use crate::{
    Vec3,
    canonical::{Geometry, Matrix, Remembering, matrix::CoordinatePlane},
    parametric::{SculpturedSurface, SpaceCurve},
};

/// The operands of AXIS.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AxisInput {
    /// A vector alone.
    Vector(Vec3),
    /// Two points.
    Points(Vec3, Vec3),
    /// A point and a vector.
    PointVector(Vec3, Vec3),
}

/// CLW or CCLW of REVOLV.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turning {
    /// CLW.
    Clockwise,
    /// CCLW, from the second to the third axis about the first one.
    CounterClockwise,
}

/// The word after SMESH.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshRestriction {
    /// XYZ: none.
    Free,
    /// XYPLAN, YZPLAN, ZXPLAN: a height over this plane.
    Height(CoordinatePlane),
}

/// The products of two curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurveProduct {
    /// TRANSL: the sum of the position vectors.
    Translate,
    /// SCALE: the product coordinate by coordinate.
    Scale,
    /// XYROT, YZROT, ZXROT: the product of the parts in the plane as complex numbers, the sum of the others.
    Turn(CoordinatePlane),
}

/// The words after PATCH.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PatchForm {
    /// POLYGN: control points.
    Polygon,
    /// PNTVEC: corners, tangents and twists.
    PointsVectors,
    /// PNTSON: points on the patch.
    PointsOn,
}

/// Which range of a classic surface FROM takes; what the ranges mean depends on the surface.
///
/// PLANE: two coordinates in the plane about the foot of the origin. CYLNDR, CONE: degrees about the axis and length along it
/// (from the point, from the vertex). SPHERE: degrees of longitude about z and of latitude. TABCYL: intervals (0 at the first
/// point between the extensions) and length along the rulings. RLDSRF: shares of the curves and of the rulings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceRange {
    /// First and last value of the first parameter.
    pub u: [f64; 2],
    /// First and last value of the second parameter.
    pub v: [f64; 2],
}

/// How the surface itself is made.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceShape {
    /// GENCUR.
    Curves {
        /// The curves, each with FLOW and SEG.
        curves: Vec<Arc<SpaceCurve>>,
        /// The curves after CROSS, at the first and the last end.
        cross: Vec<Arc<SpaceCurve>>,
    },
    /// RULED: the curve moved along an axis.
    Ruled {
        /// The curve.
        curve: Arc<SpaceCurve>,
        /// AXIS.
        axis: AxisInput,
    },
    /// REVOLV.
    Revolved {
        /// The profile.
        curve: Arc<SpaceCurve>,
        /// AXIS.
        axis: AxisInput,
        /// CLW or CCLW.
        turning: Turning,
        /// First and last position in degrees.
        angles: [f64; 2],
    },
    /// SMESH.
    Mesh {
        /// XYZ or a plane.
        restriction: MeshRestriction,
        /// The points of each SPLINE.
        rows: Vec<Vec<ParametricNode>>,
    },
    /// TRANSL, SCALE, XYROT … CROSS.
    Product {
        /// Which one.
        product: CurveProduct,
        /// The profile.
        profile: Arc<SpaceCurve>,
        /// The curve after CROSS.
        control: Arc<SpaceCurve>,
    },
    /// PATCH.
    Patches {
        /// POLYGN, PNTVEC or PNTSON.
        form: PatchForm,
        /// The sign word (+1 PLUS, −1 MINUS) and the data of each patch, as the statement has them.
        patches: Vec<(f64, [Vec3; 16])>,
    },
    /// COMBIN.
    Combined {
        /// The surfaces.
        surfaces: Vec<Remembering<SculpturedSurface>>,
    },
    /// NURBS.
    BSpline {
        /// Degrees along u and v, 1 to 3.
        degrees: [usize; 2],
        /// Knots along u and v.
        knots: [Vec<f64>; 2],
        /// Control points, those along u running fastest.
        points: Vec<Vec3>,
        /// Weights in the same order; all 1 where none are given.
        weights: Vec<f64>,
    },
    /// FROM: a piece of a classic surface.
    Converted {
        /// The surface.
        surface: Geometry,
        /// The piece.
        range: SurfaceRange,
    },
}

/// An SSURF definition.
#[derive(Debug, Clone, PartialEq)]
pub struct SculpturedDefinition {
    /// The surface.
    pub shape: SurfaceShape,
    /// TRFORM.
    pub matrix: Option<Matrix>,
}
