//! Access to the arguments of a matched format.
//!
//! A builder asks for what its format promises. Should table and builder ever disagree, the access says "no such
//! format" and nothing panics.

use super::{Argument, DefinitionContext, DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::{Cylinder, Geometry, GeometryKind, Matrix, Plane, TabulatedCylinder};

/// The arguments of a definition whose format is known.
#[derive(Clone, Copy)]
pub(super) struct Given<'a> {
    pub(super) kind: GeometryKind,
    pub(super) arguments: &'a [Argument],
    pub(super) context: &'a DefinitionContext,
}

impl<'a> Given<'a> {
    /// How many arguments there are.
    pub(super) fn count(&self) -> usize {
        self.arguments.len()
    }

    /// The error of an argument that is not what the format promised.
    pub(super) fn unknown(&self) -> DefinitionError {
        DefinitionError::UnknownFormat { kind: self.kind }
    }

    /// The number at `index`.
    pub(super) fn scalar(&self, index: usize) -> Result<f64, DefinitionError> {
        match self.arguments.get(index) {
            Some(Argument::Scalar(value)) => Ok(*value),
            _ => Err(self.unknown()),
        }
    }

    /// Three numbers from `index` on.
    pub(super) fn triple(&self, index: usize) -> Result<Vec3, DefinitionError> {
        Ok(Vec3::new(self.scalar(index)?, self.scalar(index + 1)?, self.scalar(index + 2)?))
    }

    /// The word at `index`.
    pub(super) fn modifier(&self, index: usize) -> Result<Modifier, DefinitionError> {
        match self.arguments.get(index) {
            Some(Argument::Modifier(modifier)) => Ok(*modifier),
            _ => Err(self.unknown()),
        }
    }

    /// The word at `index`, if there is one.
    pub(super) fn word_at(&self, index: usize) -> Option<Modifier> {
        self.modifier(index).ok()
    }

    /// The geometry at `index`.
    pub(super) fn geometry(&self, index: usize) -> Result<&'a Geometry, DefinitionError> {
        match self.arguments.get(index) {
            Some(Argument::Geometry(geometry)) => Ok(geometry),
            _ => Err(self.unknown()),
        }
    }

    /// The point or vector at `index`.
    pub(super) fn place(&self, index: usize) -> Result<Vec3, DefinitionError> {
        match self.geometry(index)? {
            Geometry::Point(place) | Geometry::Vector(place) => Ok(*place),
            _ => Err(self.unknown()),
        }
    }

    /// The point at `index` without its z: lines and circles are plane figures.
    pub(super) fn flat(&self, index: usize) -> Result<Vec3, DefinitionError> {
        let place = self.place(index)?;
        Ok(Vec3::new(place.x, place.y, 0.0))
    }

    /// The line or plane at `index`, with a unit normal whatever CANON stored.
    pub(super) fn plane(&self, index: usize) -> Result<Plane, DefinitionError> {
        match self.geometry(index)? {
            Geometry::Line(plane) | Geometry::Plane(plane) => {
                let normal = plane.normal;
                Plane::from_equation(normal.x, normal.y, normal.z, plane.distance)
                    .ok_or_else(|| Impossible::ZeroVector.into())
            }
            _ => Err(self.unknown()),
        }
    }

    /// The line at `index` in the xy-plane, with a unit normal.
    pub(super) fn line(&self, index: usize) -> Result<Plane, DefinitionError> {
        let plane = self.plane(index)?;
        Plane::from_equation(plane.normal.x, plane.normal.y, 0.0, plane.distance)
            .ok_or_else(|| Impossible::ZeroVector.into())
    }

    /// The circle at `index`: its xy-centre and its radius, which CANON may have stored negative.
    pub(super) fn circle(&self, index: usize) -> Result<Cylinder, DefinitionError> {
        match self.geometry(index)? {
            Geometry::Circle(circle) => {
                Ok(Cylinder::circle(circle.point.x, circle.point.y, circle.radius.abs()))
            }
            _ => Err(self.unknown()),
        }
    }

    /// The tabulated cylinder at `index`.
    pub(super) fn tabulated(&self, index: usize) -> Result<&'a TabulatedCylinder, DefinitionError> {
        match self.geometry(index)? {
            Geometry::TabulatedCylinder(surface) => Ok(surface.as_ref()),
            _ => Err(self.unknown()),
        }
    }

    /// The matrix at `index`.
    pub(super) fn matrix(&self, index: usize) -> Result<Matrix, DefinitionError> {
        match self.geometry(index)? {
            Geometry::Matrix(matrix) => Ok(*matrix),
            _ => Err(self.unknown()),
        }
    }

    /// (x, y) as a point with the z that the ZSURF plane has there.
    pub(super) fn on_z_surface(&self, x: f64, y: f64) -> Result<Vec3, DefinitionError> {
        let z = self.context.z_surface.z_over(x, y).ok_or(Impossible::VerticalZSurface)?;
        Ok(Vec3::new(x, y, z))
    }

    /// A point with the z of the ZSURF plane.
    pub(super) fn lifted(&self, x: f64, y: f64) -> Result<Geometry, DefinitionError> {
        Ok(Geometry::Point(self.on_z_surface(x, y)?))
    }

    /// A radius or length that must be positive.
    pub(super) fn positive(&self, index: usize) -> Result<f64, DefinitionError> {
        let value = self.scalar(index)?;
        if value > 0.0 { Ok(value) } else { Err(Impossible::NotPositive { value }.into()) }
    }
}
