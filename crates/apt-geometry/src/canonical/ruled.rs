//! The parts of a ruled surface with their roles.

use super::{Geometry, Matrix, RuledSurface, TransformError};
use crate::Vec3;

/// Parts that define one curve: surface, end points, direction across the chord.
const CURVE_PARTS: usize = 4;

/// One of the two curves of a ruled surface: the section of `surface` with the plane of the chord and `across`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RuledCurve<'a> {
    /// The surface that the curve lies on.
    pub surface: &'a Geometry,
    /// Where the curve starts.
    pub start: Vec3,
    /// Where it ends.
    pub end: Vec3,
    /// Unit direction in the cutting plane in which the curve is looked for from the chord.
    pub across: Vec3,
}

/// What the rulings run to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RuledEnd<'a> {
    /// A second curve: points at equal parts of the two chords correspond.
    Curve(RuledCurve<'a>),
    /// A point that all rulings meet in.
    Apex(Vec3),
}

impl RuledSurface {
    /// The first curve and what its rulings run to; `None` if the parts are not those of a definition.
    ///
    /// The direction across a chord stands among the parts under the type word that it was given with: a third point
    /// has become a direction but is still called POINT there, as in APT III.
    pub fn curves(&self) -> Option<(RuledCurve<'_>, RuledEnd<'_>)> {
        let first = self.curve(0)?;
        let end = if self.parts.len() == CURVE_PARTS + 1 {
            RuledEnd::Apex(self.place(CURVE_PARTS)?)
        } else {
            RuledEnd::Curve(self.curve(CURVE_PARTS)?)
        };
        Some((first, end))
    }

    fn curve(&self, first: usize) -> Option<RuledCurve<'_>> {
        Some(RuledCurve {
            surface: self.parts.get(first)?,
            start: self.place(first + 1)?,
            end: self.place(first + 2)?,
            across: self.place(first + 3)?,
        })
    }

    fn place(&self, index: usize) -> Option<Vec3> {
        match self.parts.get(index)? {
            Geometry::Point(place) | Geometry::Vector(place) => Some(*place),
            _ => None,
        }
    }

    /// The image under `x' = M x`; directions across a chord stay unit vectors.
    pub(super) fn image(&self, matrix: &Matrix) -> Result<RuledSurface, TransformError> {
        let part = |(index, part): (usize, &Geometry)| {
            if index % CURVE_PARTS != CURVE_PARTS - 1 {
                return part.transform(matrix);
            }
            let direction = |across: &Vec3| {
                matrix.apply_vector(across).try_normalize(0.0).ok_or(TransformError::Singular)
            };
            match part {
                Geometry::Point(across) => Ok(Geometry::Point(direction(across)?)),
                Geometry::Vector(across) => Ok(Geometry::Vector(direction(across)?)),
                other => other.transform(matrix),
            }
        };
        let parts: Result<Vec<_>, _> = self.parts.iter().enumerate().map(part).collect();
        Ok(RuledSurface { parts: parts? })
    }
}
