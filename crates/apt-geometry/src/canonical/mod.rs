//! Canonical forms: what a definition leaves behind, in the shapes of APT III.
//!
//! Sign conventions are those of the public APT III processor: a plane is `n·x = d` with unit `n`, a line is a plane
//! that contains the z direction, a circle is an infinite cylinder about z.

mod cylinder;
pub mod extent;
pub mod function;
mod kind;
pub mod matrix;
mod plane;
mod poly_conic;
mod quadric;
mod remembering;
mod ruled;
mod sculptured;
mod tabulated;
mod transform;
mod values;

pub use poly_conic::PolyConicForm;
pub use remembering::{Made, Remembering};
pub use ruled::{RuledCurve, RuledEnd};
pub use tabulated::Joint;
pub use transform::TransformError;
pub use values::CanonicalError;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::{
    Vec3,
    parametric::{SculpturedSurface, SpaceCurve},
};

/// `n·x = d`, with `n` a unit vector unless it was entered by CANON.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Plane {
    /// Unit normal.
    pub normal: Vec3,
    /// Signed distance of the plane from the origin along the normal, in part-program units.
    pub distance: f64,
}

/// A circle (axis z) or a cylinder: every point at `radius` from the axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cylinder {
    /// A point on the axis; the centre for a circle.
    pub point: Vec3,
    /// Unit direction of the axis.
    pub axis: Vec3,
    /// Radius, positive unless it was entered by CANON.
    pub radius: f64,
}

/// A sphere.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sphere {
    /// Centre.
    pub center: Vec3,
    /// Radius.
    pub radius: f64,
}

/// One nappe of a circular cone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cone {
    /// Vertex.
    pub vertex: Vec3,
    /// Unit axis, pointing from the vertex into the solid.
    pub axis: Vec3,
    /// Cosine of the half angle.
    pub cosine: f64,
}

/// `Ax²+By²+Cz²+D+2Fyz+2Gxz+2Hxy+2Px+2Qy+2Rz = 0`, stored in the order `A,B,C,D,F,G,H,P,Q,R` and not normalised.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Quadric {
    /// Coefficients `A,B,C,D,F,G,H,P,Q,R`.
    pub coefficients: [f64; 10],
}

/// An affine map: twelve numbers by rows, the fourth column being the translation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Matrix {
    /// Rows of the 3×4 matrix.
    pub rows: [[f64; 4]; 3],
}

/// One interval of a tabulated cylinder: a cubic over its chord, in the (u,v) plane of the cylinder.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// Left point, u.
    pub u: f64,
    /// Left point, v.
    pub v: f64,
    /// Cubic coefficient: the height above the chord at `s` is `s(s−L)(a(s+L)+b)`.
    pub a: f64,
    /// Second cubic coefficient.
    pub b: f64,
    /// Chord length `L`.
    pub length: f64,
    /// Greatest height above the chord, divided by `L` as APT III stores it; never negative.
    pub maximum: f64,
    /// Least height above the chord, divided by `L` as APT III stores it; never positive.
    pub minimum: f64,
}

/// A general cylinder: a piecewise cubic directrix in the (u,v) plane, ruled along w.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TabulatedCylinder {
    /// Rows are the unit u, v and w axes in part-program coordinates.
    pub axes: [Vec3; 3],
    /// APT III's second word of the canonical form, which is always 0 there and which listings leave out.
    pub kind: f64,
    /// Intervals in order; the first and the last are the straight extensions.
    pub intervals: Vec<Interval>,
    /// The last point (u,v).
    pub last: [f64; 2],
}

/// A ruled surface: its defining surfaces, points and vectors in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RuledSurface {
    /// The parts in the order of the definition: surface, two end points, direction across the chord; then the same
    /// of the second curve or a single point. See [`RuledSurface::curves`].
    pub parts: Vec<Geometry>,
}

/// A set of points with the structure that GOTO modifiers refer to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pattern {
    /// How it was made.
    pub arrangement: Arrangement,
    /// The points in definition order.
    pub points: Vec<Vec3>,
    /// Points per column of a PARLEL pattern, else the number of points.
    pub column: usize,
}

/// How a pattern was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the language's own")]
pub enum Arrangement {
    Linear,
    Arc,
    Random,
    Parallel,
}

/// The type word of a definition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the language's own")]
pub enum GeometryKind {
    Point,
    Line,
    Plane,
    Circle,
    Cylinder,
    Ellipse,
    Hyperbola,
    Cone,
    GeneralConic,
    LoftConic,
    Vector,
    Matrix,
    Sphere,
    Quadric,
    PolyConic,
    Loft,
    TabulatedCylinder,
    RuledSurface,
    Pattern,
    Mesh,
    ElementSurface,
    Sculptured,
    SpaceCurve,
}

/// A defined geometric entity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "each variant is its GeometryKind")]
pub enum Geometry {
    Point(Vec3),
    Line(Plane),
    Plane(Plane),
    Circle(Cylinder),
    Cylinder(Cylinder),
    Ellipse(Quadric),
    Hyperbola(Quadric),
    Cone(Cone),
    GeneralConic(Quadric),
    LoftConic(Quadric),
    Vector(Vec3),
    Matrix(Matrix),
    Sphere(Sphere),
    Quadric(Quadric),
    /// The 79 canonical values.
    PolyConic(Remembering<Vec<f64>>),
    /// The eight canonical values; what they mean is known to the installation that had the type.
    Loft(Arc<Vec<f64>>),
    TabulatedCylinder(Arc<TabulatedCylinder>),
    RuledSurface(Remembering<RuledSurface>),
    Pattern(Arc<Pattern>),
    /// The canonical values, as many as there are; what they mean is known to the installation that had the type.
    Mesh(Arc<Vec<f64>>),
    /// As for [`Geometry::Mesh`].
    ElementSurface(Arc<Vec<f64>>),
    Sculptured(Remembering<SculpturedSurface>),
    SpaceCurve(Arc<SpaceCurve>),
}

impl Geometry {
    /// The type word this entity was defined with.
    pub fn kind(&self) -> GeometryKind {
        match self {
            Geometry::Point(_) => GeometryKind::Point,
            Geometry::Line(_) => GeometryKind::Line,
            Geometry::Plane(_) => GeometryKind::Plane,
            Geometry::Circle(_) => GeometryKind::Circle,
            Geometry::Cylinder(_) => GeometryKind::Cylinder,
            Geometry::Ellipse(_) => GeometryKind::Ellipse,
            Geometry::Hyperbola(_) => GeometryKind::Hyperbola,
            Geometry::Cone(_) => GeometryKind::Cone,
            Geometry::GeneralConic(_) => GeometryKind::GeneralConic,
            Geometry::LoftConic(_) => GeometryKind::LoftConic,
            Geometry::Vector(_) => GeometryKind::Vector,
            Geometry::Matrix(_) => GeometryKind::Matrix,
            Geometry::Sphere(_) => GeometryKind::Sphere,
            Geometry::Quadric(_) => GeometryKind::Quadric,
            Geometry::PolyConic(_) => GeometryKind::PolyConic,
            Geometry::Loft(_) => GeometryKind::Loft,
            Geometry::TabulatedCylinder(_) => GeometryKind::TabulatedCylinder,
            Geometry::RuledSurface(_) => GeometryKind::RuledSurface,
            Geometry::Pattern(_) => GeometryKind::Pattern,
            Geometry::Mesh(_) => GeometryKind::Mesh,
            Geometry::ElementSurface(_) => GeometryKind::ElementSurface,
            Geometry::Sculptured(_) => GeometryKind::Sculptured,
            Geometry::SpaceCurve(_) => GeometryKind::SpaceCurve,
        }
    }
}
