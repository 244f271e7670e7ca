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

#[cfg(test)]
mod tests {
    use super::super::matrix::CoordinatePlane;
    use super::super::{Plane, Remembering};
    use super::*;

    #[test]
    fn curves_move_with_the_surface_and_directions_only_turn() {
        let plane = Geometry::Plane(Plane { normal: Vec3::z(), distance: 3.0 });
        let at = |x: f64, y: f64, z: f64| Geometry::Point(Vec3::new(x, y, z));
        let parts = vec![plane, at(0.0, 0.0, 3.0), at(4.0, 0.0, 3.0), at(0.0, 1.0, 0.0), at(2.0, 5.0, 5.0)];
        let matrix = Matrix::translation(Vec3::new(10.0, 0.0, 0.0))
            .multiply(&Matrix::rotation(CoordinatePlane::Xy, 90.0))
            .multiply(&Matrix::scaling(2.0));
        let surface = Geometry::RuledSurface(Remembering::new(RuledSurface { parts }));
        let Ok(Geometry::RuledSurface(moved)) = surface.transform(&matrix) else { panic!("a ruled surface") };
        let (curve, end) = moved.curves().expect("the parts of a definition");
        assert_eq!(curve.end, Vec3::new(10.0, 8.0, 6.0));
        assert_eq!(curve.across, Vec3::new(-1.0, 0.0, 0.0));
        assert_eq!(end, RuledEnd::Apex(Vec3::new(0.0, 4.0, 10.0)));
        assert_eq!(RuledSurface { parts: Vec::new() }.curves(), None);
    }
}
