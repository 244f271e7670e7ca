//! Surfaces as the arithmetic element sees them: signed distance with foot, natural normal and curvature, and
//! directed distances. Made from canonical forms.

mod apart;
mod bend;
mod chart;
mod cone;
mod crease;
mod descent;
mod directed;
mod interval;
mod part;
mod poly_conic;
mod quadric;
mod quadric_bound;
mod ruled;
mod sculptured;
mod section_curve;
mod sheet;
mod tabulated;

use std::sync::Arc;

use nalgebra::Matrix3;

pub use self::{
    apart::{AtEnds, Away, Beside, Body, HalfSpace, Limit, Nearer},
    bend::{Bend, Region},
    chart::{Chart, Place, Steady},
    cone::ConeForm,
    crease::{Crease, SurfaceEdge},
    directed::{NoDistance, RootSelection, solve_quadratic},
    part::{Form, LENGTHWISE, Lengthwise, Lying},
    poly_conic::PolyConicSheet,
    quadric::PrincipalQuadric,
    quadric_bound::{QuadraticFunction, Stationary},
    ruled::RuledSheet,
    sculptured::SculpturedSheet,
    tabulated::DirectrixCurve,
};
use crate::{
    Vec3,
    canonical::{Cylinder, Geometry, GeometryKind, Plane, Sphere},
    parametric::{Extended, Flanged},
    patience::Patience,
};

/// A surface ready for distance questions.
#[derive(Debug, Clone, PartialEq)]
pub enum Surface {
    /// Plane or line, with a unit normal.
    Plane(Plane),
    /// Cylinder or circle, with a unit axis and a radius that is not negative.
    Cylinder(Cylinder),
    /// Sphere.
    Sphere(Sphere),
    /// One nappe of a circular cone.
    Cone(ConeForm),
    /// Quadric in principal axes: ellipse, hyperbola and conic cylinders too.
    Quadric(Box<PrincipalQuadric>),
    /// Tabulated cylinder; the straight extensions go on for ever, up to where they meet, or no farther than they are defined where they
    /// would come back to the curve.
    Tabulated(Box<DirectrixCurve>),
    /// Ruled surface with its extensions.
    Ruled(Arc<RuledSheet>),
    /// Polyconic surface with its extensions.
    PolyConic(Arc<PolyConicSheet>),
    /// Sculptured surface with its extensions.
    Sculptured(Arc<SculpturedSheet>),
}

/// Why a geometric entity is no surface here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SurfaceError {
    /// This kind of entity is not a surface, or not one that distances are computed for.
    #[error("{kind:?} is no surface for motion")]
    Unsupported {
        /// What it is.
        kind: GeometryKind,
    },
    /// The canonical form describes no surface (zero normal or axis, no real points).
    #[error("degenerate {kind:?}")]
    Degenerate {
        /// What it is.
        kind: GeometryKind,
    },
    /// Who waits for it has given up before it was made.
    #[error("given up before it was made")]
    GivenUp,
}

/// The nearest point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Signed distance, positive on the side that the natural normal points to.
    pub distance: f64,
    /// The nearest point.
    pub point: Vec3,
    /// Unit gradient of the signed distance: the natural normal at the nearest point.
    pub normal: Vec3,
}

/// There is no normal: the point lies on an axis, a centre or a vertex (APT III 1021).
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("no normal at this point")]
pub struct NoNormal;

/// How the solid behind a surface (against its natural normal) is shaped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Convexity {
    /// A half space.
    Flat,
    /// A convex solid: its signed distance is a convex function.
    Convex,
    /// The complement of a convex solid.
    Hollow,
    /// Neither, or not known.
    General,
}

impl Surface {
    /// The surface of a canonical form.
    ///
    /// # Errors
    /// [`SurfaceError`] for points, vectors and the like, and for degenerate forms.
    pub fn from_geometry(geometry: &Geometry) -> Result<Self, SurfaceError> {
        Self::from_geometry_until(geometry, Patience::default())
    }

    /// The same for somebody who may give up: surfaces that end are cut into many pieces when they are first made.
    ///
    /// # Errors
    /// [`SurfaceError`] as before, and [`SurfaceError::GivenUp`].
    pub fn from_geometry_until(geometry: &Geometry, patience: Patience<'_>) -> Result<Self, SurfaceError> {
        match Self::of(geometry, patience) {
            Err(SurfaceError::Degenerate { .. }) if patience.was_over() => Err(SurfaceError::GivenUp),
            made => made,
        }
    }

    /// The same, degenerate where who waits has given up.
    fn of(geometry: &Geometry, patience: Patience<'_>) -> Result<Self, SurfaceError> {
        let kind = geometry.kind();
        let degenerate = SurfaceError::Degenerate { kind };
        match geometry {
            Geometry::Plane(plane) | Geometry::Line(plane) => {
                let norm = plane.normal.norm();
                if !(norm > 0.0 && norm.is_finite() && plane.distance.is_finite()) {
                    return Err(degenerate);
                }
                Ok(Self::Plane(unit_plane(plane, norm)))
            }
            Geometry::Circle(cylinder) | Geometry::Cylinder(cylinder) => {
                let axis = unit(&cylinder.axis).ok_or(degenerate)?;
                if !(cylinder.radius.is_finite() && all_finite(&cylinder.point)) {
                    return Err(degenerate);
                }
                Ok(Self::Cylinder(Cylinder { point: cylinder.point, axis, radius: cylinder.radius.abs() }))
            }
            Geometry::Sphere(sphere) => {
                if !(sphere.radius.is_finite() && all_finite(&sphere.center)) {
                    return Err(degenerate);
                }
                Ok(Self::Sphere(Sphere { center: sphere.center, radius: sphere.radius.abs() }))
            }
            Geometry::Cone(cone) => ConeForm::new(cone).map(Self::Cone).ok_or(degenerate),
            Geometry::Ellipse(quadric)
            | Geometry::Hyperbola(quadric)
            | Geometry::GeneralConic(quadric)
            | Geometry::LoftConic(quadric)
            | Geometry::Quadric(quadric) => quadric::surface(quadric).ok_or(degenerate),
            Geometry::TabulatedCylinder(cylinder) => {
                DirectrixCurve::new(cylinder).map(|curve| Self::Tabulated(Box::new(curve))).ok_or(degenerate)
            }
            Geometry::RuledSurface(surface) => {
                let sheet = surface.made(|surface| RuledSheet::new(surface, patience));
                sheet.map(Self::Ruled).ok_or(degenerate)
            }
            Geometry::PolyConic(values) => {
                let sheet = values.made(|values| PolyConicSheet::new(values, patience));
                sheet.map(Self::PolyConic).ok_or(degenerate)
            }
            Geometry::Sculptured(surface) => {
                let extended = Extended::of(surface).ok_or(degenerate)?;
                let flanged = Flanged::of(surface).ok_or(degenerate)?;
                let sheet =
                    surface.made(|own| SculpturedSheet::new(own, extended.patches(), flanged, patience));
                sheet.map(Self::Sculptured).ok_or(degenerate)
            }
            Geometry::Point(_)
            | Geometry::Vector(_)
            | Geometry::Matrix(_)
            | Geometry::Loft(_)
            | Geometry::Mesh(_)
            | Geometry::ElementSurface(_)
            | Geometry::Pattern(_)
            | Geometry::SpaceCurve(_) => Err(SurfaceError::Unsupported { kind }),
        }
    }

    /// True if the surface ends somewhere and does not go on. Planes and quadrics go on for ever or close, and so do most tabulated
    /// cylinders; the vertex of a cone is no end.
    pub fn has_ends(&self) -> bool {
        match self {
            Self::Ruled(_) | Self::PolyConic(_) | Self::Sculptured(_) => true,
            Self::Tabulated(curve) => curve.has_ends(),
            _ => false,
        }
    }

    /// True if the place nearest to a point lies where the surface ends.
    pub fn ends_at(&self, p: &Vec3) -> bool {
        match self {
            Self::Tabulated(curve) => curve.has_ends() && curve.ends_at(p),
            Self::Ruled(sheet) => sheet.ends_at(p),
            Self::PolyConic(sheet) => sheet.ends_at(p),
            Self::Sculptured(sheet) => sheet.ends_at(p),
            _ => false,
        }
    }

    /// The surface as a body of a tool on one side of it meets it, positive for that of the natural normal: where a surface ends it
    /// is taken for the face of a body, which leads away from there on the other side. Most surfaces are that themselves.
    ///
    /// It is made when it is first asked for; to somebody who has given up before it is the surface itself.
    pub fn met_from(&self, side: f64, patience: Patience<'_>) -> &Self {
        match self {
            Self::Ruled(sheet) => sheet.met_from(side),
            Self::PolyConic(sheet) => sheet.met_from(side),
            Self::Sculptured(sheet) => sheet.met_from(side, patience).unwrap_or(self),
            _ => self,
        }
    }

    /// The nearest point with signed distance and natural normal. Where several points are nearest (on an axis or in
    /// a centre) one of them is taken, always the same.
    pub fn foot(&self, p: &Vec3) -> Foot {
        match self {
            Self::Plane(plane) => {
                let distance = plane.normal.dot(p) - plane.distance;
                Foot { distance, point: p - plane.normal * distance, normal: plane.normal }
            }
            Self::Cylinder(cylinder) => {
                let w = p - cylinder.point;
                let along = w.dot(&cylinder.axis);
                let radial = w - cylinder.axis * along;
                let rho = radial.norm();
                let normal = if rho > 0.0 { radial / rho } else { perpendicular(&cylinder.axis) };
                let distance = rho - cylinder.radius;
                Foot { distance, point: p - normal * distance, normal }
            }
            Self::Sphere(sphere) => {
                let w = p - sphere.center;
                let rho = w.norm();
                let normal = if rho > 0.0 { w / rho } else { Vec3::z() };
                Foot { distance: rho - sphere.radius, point: sphere.center + normal * sphere.radius, normal }
            }
            Self::Cone(cone) => cone.foot(p),
            Self::Quadric(quadric) => quadric.foot(p).0,
            Self::Tabulated(curve) => curve.foot(p).0,
            Self::Ruled(sheet) => sheet.place(p).foot,
            Self::PolyConic(sheet) => sheet.foot(p),
            Self::Sculptured(sheet) => sheet.place(p).foot,
        }
    }

    /// Signed distance, positive on the side of the natural normal.
    pub fn signed_distance(&self, p: &Vec3) -> f64 {
        match self {
            Self::Plane(plane) => plane.normal.dot(p) - plane.distance,
            Self::Cylinder(cylinder) => {
                let w = p - cylinder.point;
                let along = w.dot(&cylinder.axis);
                (w.norm_squared() - along * along).max(0.0).sqrt() - cylinder.radius
            }
            Self::Sphere(sphere) => (p - sphere.center).norm() - sphere.radius,
            _ => self.foot(p).distance,
        }
    }

    /// The nearest point, and the second derivatives of the signed distance there: curvature of the parallel surface
    /// through `p`, positive where the surface curves away from its natural normal.
    pub fn foot_and_hessian(&self, p: &Vec3) -> (Foot, Matrix3<f64>) {
        match self {
            Self::Plane(_) => (self.foot(p), Matrix3::zeros()),
            Self::Cylinder(cylinder) => {
                let foot = self.foot(p);
                let rho = (foot.distance + cylinder.radius).max(f64::MIN_POSITIVE);
                let tangent = cylinder.axis.cross(&foot.normal);
                (foot, tangent * tangent.transpose() / rho)
            }
            Self::Sphere(sphere) => {
                let foot = self.foot(p);
                let rho = (foot.distance + sphere.radius).max(f64::MIN_POSITIVE);
                (foot, (Matrix3::identity() - foot.normal * foot.normal.transpose()) / rho)
            }
            Self::Cone(cone) => cone.foot_and_hessian(p),
            Self::Quadric(quadric) => {
                let (foot, root) = quadric.foot(p);
                (foot, quadric.hessian(&foot, root))
            }
            Self::Tabulated(curve) => {
                let (foot, curvature) = curve.foot(p);
                (foot, curve.hessian(&foot, curvature))
            }
            Self::Ruled(sheet) => sheet.place(p).with_hessian(),
            Self::PolyConic(sheet) => sheet.foot_and_hessian(p),
            Self::Sculptured(sheet) => sheet.place(p).with_hessian(),
        }
    }

    /// Shape of the solid behind the surface.
    pub fn convexity(&self) -> Convexity {
        match self {
            Self::Plane(_) => Convexity::Flat,
            Self::Cylinder(_) | Self::Sphere(_) | Self::Cone(_) => Convexity::Convex,
            Self::Quadric(quadric) => quadric.convexity(),
            Self::Tabulated(_) | Self::Ruled(_) | Self::PolyConic(_) | Self::Sculptured(_) => {
                Convexity::General
            }
        }
    }

    /// The natural normal at a point on or near the surface (UNRMAL and its kin).
    ///
    /// # Errors
    /// [`NoNormal`] on the axis of a cylinder, in the centre of a sphere, at the vertex of a cone and outside the
    /// region whose nearest point is on its side, and where the gradient of a quadric vanishes.
    pub fn natural_normal(&self, p: &Vec3) -> Result<Vec3, NoNormal> {
        match self {
            Self::Plane(plane) => Ok(plane.normal),
            Self::Cylinder(cylinder) => {
                let w = p - cylinder.point;
                let radial = w - cylinder.axis * w.dot(&cylinder.axis);
                if radial.norm() <= ON_AXIS * (1.0 + w.norm()) {
                    Err(NoNormal)
                } else {
                    Ok(radial.normalize())
                }
            }
            Self::Sphere(sphere) => {
                let w = p - sphere.center;
                if w.norm() <= ON_AXIS * (1.0 + sphere.radius) { Err(NoNormal) } else { Ok(w.normalize()) }
            }
            Self::Cone(cone) => cone.natural_normal(p),
            Self::Quadric(quadric) => quadric.natural_normal(p),
            Self::Tabulated(_) | Self::Ruled(_) | Self::PolyConic(_) | Self::Sculptured(_) => {
                Ok(self.foot(p).normal)
            }
        }
    }
}

/// Relative distance below which a point counts as lying on an axis or in a centre.
const ON_AXIS: f64 = 1e-12;

fn unit_plane(plane: &Plane, norm: f64) -> Plane {
    Plane { normal: plane.normal / norm, distance: plane.distance / norm }
}

fn unit(v: &Vec3) -> Option<Vec3> {
    if all_finite(v) { v.try_normalize(0.0) } else { None }
}

fn all_finite(v: &Vec3) -> bool {
    v.iter().all(|x| x.is_finite())
}

/// Some unit vector perpendicular to a unit vector, always the same one.
pub fn perpendicular(v: &Vec3) -> Vec3 {
    let least = v.iamin();
    let mut other = Vec3::zeros();
    other[least] = 1.0;
    v.cross(&other).normalize()
}

#[cfg(test)]
mod chart_tests;
#[cfg(test)]
mod sheet_bend_tests;
#[cfg(test)]
mod sheet_tests;
#[cfg(test)]
mod tests;
