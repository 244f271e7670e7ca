//! Canonical forms as rows of numbers, in the order in which CANON takes them and OBTAIN gives them.

use std::sync::Arc;

use super::{
    Arrangement, Cone, Cylinder, Geometry, GeometryKind, Interval, Matrix, Pattern, Plane, Quadric,
    Remembering, Sphere, TabulatedCylinder, sculptured,
};
use crate::Vec3;

/// Numbers per interval of a tabulated cylinder in its canonical form.
const INTERVAL_VALUES: usize = 7;
/// Numbers before the intervals of a tabulated cylinder: the number of points and the nine of the axes.
const TABULATED_HEAD: usize = 10;
/// Numbers before the points of a pattern: its arrangement, the number of points, the points per column.
const PATTERN_HEAD: usize = 3;

/// Why a row of numbers is not a canonical form.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CanonicalError {
    /// The type has another number of values (APT III 84).
    #[error("{kind:?} takes {expected} canonical values, not {found}")]
    Count {
        /// The type.
        kind: GeometryKind,
        /// How many values it takes; for types of variable length what the head of the row promises.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// The canonical form of this type is not a row of numbers.
    #[error("{kind:?} has no canonical row")]
    NoRow {
        /// The type.
        kind: GeometryKind,
    },
    /// A value of the head (a count, a type code) is not what it can be.
    #[error("value {position} of {kind:?} cannot be {value}")]
    Value {
        /// The type.
        kind: GeometryKind,
        /// Index of the value.
        position: usize,
        /// The value.
        value: f64,
    },
}

impl CanonicalError {
    /// The APT III diagnostic number, if the case has one.
    pub fn apt3(&self) -> Option<u16> {
        match self {
            CanonicalError::Count { .. } => Some(84),
            CanonicalError::NoRow { .. } => Some(1000),
            CanonicalError::Value { .. } => Some(83),
        }
    }
}

impl Geometry {
    /// The canonical values in the order of APT III.
    ///
    /// A TABCYL gives the number of its points (extensions included), nine numbers of the axes, seven numbers per
    /// interval and the last point; a PATERN its arrangement (1 LINEAR, 2 ARC, 3 RANDOM, 4 PARLEL), the number of
    /// points, the points per column and the points; a RLDSRF each of its parts, preceded by the surface code; SSURF and
    /// SCURV their heads and control points.
    pub fn canonical_values(&self) -> Vec<f64> {
        match self {
            Geometry::Point(place) | Geometry::Vector(place) => place.iter().copied().collect(),
            Geometry::Line(plane) | Geometry::Plane(plane) => {
                vec![plane.normal.x, plane.normal.y, plane.normal.z, plane.distance]
            }
            Geometry::Circle(cylinder) | Geometry::Cylinder(cylinder) => {
                axis_values(&cylinder.point, &cylinder.axis, cylinder.radius)
            }
            Geometry::Cone(cone) => axis_values(&cone.vertex, &cone.axis, cone.cosine),
            Geometry::Sphere(sphere) => {
                vec![sphere.center.x, sphere.center.y, sphere.center.z, sphere.radius]
            }
            Geometry::Ellipse(quadric)
            | Geometry::Hyperbola(quadric)
            | Geometry::GeneralConic(quadric)
            | Geometry::LoftConic(quadric)
            | Geometry::Quadric(quadric) => quadric.coefficients.to_vec(),
            Geometry::Matrix(matrix) => matrix.rows.concat(),
            Geometry::PolyConic(values) => values.to_vec(),
            Geometry::Loft(values) | Geometry::Mesh(values) | Geometry::ElementSurface(values) => {
                values.to_vec()
            }
            Geometry::TabulatedCylinder(surface) => tabulated_values(surface),
            Geometry::RuledSurface(surface) => surface.parts.iter().flat_map(coded_values).collect(),
            Geometry::Pattern(pattern) => pattern_values(pattern),
            Geometry::Sculptured(surface) => sculptured::surface_values(surface),
            Geometry::SpaceCurve(curve) => sculptured::curve_values(curve),
        }
    }

    /// The entity with these canonical values, taken unchanged: nothing is normalised or tested, as in
    /// `TYPE/CANON,…`.
    ///
    /// # Errors
    /// The number of values is not that of the type, or the type has no row of values (RLDSRF).
    pub fn from_canonical(kind: GeometryKind, values: &[f64]) -> Result<Geometry, CanonicalError> {
        if let Some(expected) = kind.canonical_count()
            && expected != values.len()
        {
            return Err(CanonicalError::Count { kind, expected, found: values.len() });
        }
        let at = |index: usize| values.get(index).copied().unwrap_or(0.0);
        let vector = |first: usize| Vec3::new(at(first), at(first + 1), at(first + 2));
        let plane = || Plane { normal: vector(0), distance: at(3) };
        let cylinder = || Cylinder { point: vector(0), axis: vector(3), radius: at(6) };
        let quadric = || Quadric { coefficients: std::array::from_fn(at) };
        Ok(match kind {
            GeometryKind::Point => Geometry::Point(vector(0)),
            GeometryKind::Vector => Geometry::Vector(vector(0)),
            GeometryKind::Line => Geometry::Line(plane()),
            GeometryKind::Plane => Geometry::Plane(plane()),
            GeometryKind::Circle => Geometry::Circle(cylinder()),
            GeometryKind::Cylinder => Geometry::Cylinder(cylinder()),
            GeometryKind::Cone => Geometry::Cone(Cone { vertex: vector(0), axis: vector(3), cosine: at(6) }),
            GeometryKind::Sphere => Geometry::Sphere(Sphere { center: vector(0), radius: at(3) }),
            GeometryKind::Ellipse => Geometry::Ellipse(quadric()),
            GeometryKind::Hyperbola => Geometry::Hyperbola(quadric()),
            GeometryKind::GeneralConic => Geometry::GeneralConic(quadric()),
            GeometryKind::LoftConic => Geometry::LoftConic(quadric()),
            GeometryKind::Quadric => Geometry::Quadric(quadric()),
            GeometryKind::Matrix => Geometry::Matrix(Matrix {
                rows: std::array::from_fn(|row| std::array::from_fn(|column| at(4 * row + column))),
            }),
            GeometryKind::PolyConic => Geometry::PolyConic(Remembering::new(values.to_vec())),
            GeometryKind::Loft => Geometry::Loft(Arc::new(values.to_vec())),
            GeometryKind::Mesh | GeometryKind::ElementSurface if values.is_empty() => {
                return Err(CanonicalError::Count { kind, expected: 1, found: 0 });
            }
            GeometryKind::Mesh => Geometry::Mesh(Arc::new(values.to_vec())),
            GeometryKind::ElementSurface => Geometry::ElementSurface(Arc::new(values.to_vec())),
            GeometryKind::TabulatedCylinder => Geometry::TabulatedCylinder(Arc::new(tabulated_from(values)?)),
            GeometryKind::Pattern => Geometry::Pattern(Arc::new(pattern_from(values)?)),
            GeometryKind::Sculptured => {
                Geometry::Sculptured(Remembering::new(sculptured::surface_from(values)?))
            }
            GeometryKind::SpaceCurve => Geometry::SpaceCurve(Arc::new(sculptured::curve_from(values)?)),
            GeometryKind::RuledSurface => return Err(CanonicalError::NoRow { kind }),
        })
    }
}

fn axis_values(point: &Vec3, axis: &Vec3, last: f64) -> Vec<f64> {
    vec![point.x, point.y, point.z, axis.x, axis.y, axis.z, last]
}

fn coded_values(part: &Geometry) -> Vec<f64> {
    let mut values = vec![f64::from(part.kind().surface_code())];
    values.extend(part.canonical_values());
    values
}

fn tabulated_values(surface: &TabulatedCylinder) -> Vec<f64> {
    let mut values = vec![(surface.intervals.len() + 1) as f64];
    values.extend(surface.axes.iter().flat_map(|axis| axis.iter().copied()));
    for interval in &surface.intervals {
        let Interval { u, v, a, b, length, maximum, minimum } = *interval;
        values.extend([u, v, a, b, length, stored_maximum(maximum, minimum), minimum]);
    }
    values.extend(surface.last);
    values
}

/// APT III writes the maximum of an interval with a bump on either side of its chord with the wrong sign, and canonical
/// forms are compared with its numbers. In [`Interval`] the maximum is the maximum.
fn stored_maximum(maximum: f64, minimum: f64) -> f64 {
    if maximum > 0.0 && minimum < 0.0 { -maximum } else { maximum }
}

fn pattern_values(pattern: &Pattern) -> Vec<f64> {
    let arrangement = match pattern.arrangement {
        Arrangement::Linear => 1.0,
        Arrangement::Arc => 2.0,
        Arrangement::Random => 3.0,
        Arrangement::Parallel => 4.0,
    };
    let mut values = vec![arrangement, pattern.points.len() as f64, pattern.column as f64];
    values.extend(pattern.points.iter().flat_map(|point| point.iter().copied()));
    values
}

/// A count at `position`, or the error that says that it is none.
pub(super) fn count(kind: GeometryKind, values: &[f64], position: usize) -> Result<usize, CanonicalError> {
    let missing = CanonicalError::Count { kind, expected: position + 1, found: values.len() };
    let value = *values.get(position).ok_or(missing)?;
    // More values than the row has is impossible, so the row's length bounds the count.
    if value.fract() == 0.0 && value >= 0.0 && value <= values.len() as f64 {
        Ok(value as usize)
    } else {
        Err(CanonicalError::Value { kind, position, value })
    }
}

fn tabulated_from(values: &[f64]) -> Result<TabulatedCylinder, CanonicalError> {
    let kind = GeometryKind::TabulatedCylinder;
    let points = count(kind, values, 0)?;
    if points < 2 {
        return Err(CanonicalError::Value { kind, position: 0, value: points as f64 });
    }
    let expected = TABULATED_HEAD + INTERVAL_VALUES * (points - 1) + 2;
    if values.len() != expected {
        return Err(CanonicalError::Count { kind, expected, found: values.len() });
    }
    let at = |index: usize| values.get(index).copied().unwrap_or(0.0);
    let axis = |row: usize| Vec3::new(at(1 + 3 * row), at(2 + 3 * row), at(3 + 3 * row));
    let interval = |index: usize| {
        let first = TABULATED_HEAD + INTERVAL_VALUES * index;
        let [u, v, a, b, length, maximum, minimum] = std::array::from_fn(|offset| at(first + offset));
        Interval { u, v, a, b, length, maximum: if minimum < 0.0 { maximum.abs() } else { maximum }, minimum }
    };
    Ok(TabulatedCylinder {
        axes: [axis(0), axis(1), axis(2)],
        kind: 0.0,
        intervals: (0..points - 1).map(interval).collect(),
        last: [at(expected - 2), at(expected - 1)],
    })
}

fn pattern_from(values: &[f64]) -> Result<Pattern, CanonicalError> {
    let kind = GeometryKind::Pattern;
    let arrangement = match count(kind, values, 0)? {
        1 => Arrangement::Linear,
        2 => Arrangement::Arc,
        3 => Arrangement::Random,
        4 => Arrangement::Parallel,
        other => return Err(CanonicalError::Value { kind, position: 0, value: other as f64 }),
    };
    let (points, column) = (count(kind, values, 1)?, count(kind, values, 2)?);
    let expected = PATTERN_HEAD + 3 * points;
    if values.len() != expected {
        return Err(CanonicalError::Count { kind, expected, found: values.len() });
    }
    let points = values[PATTERN_HEAD..].chunks_exact(3).map(Vec3::from_column_slice).collect();
    Ok(Pattern { arrangement, points, column })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_fixed_length_come_back_unchanged() {
        for kind in GeometryKind::all() {
            let Some(length) = kind.canonical_count() else { continue };
            let values: Vec<f64> = (0..length).map(|index| index as f64 + 0.5).collect();
            let geometry = Geometry::from_canonical(kind, &values).expect("the right length");
            assert_eq!(geometry.kind(), kind);
            assert_eq!(geometry.canonical_values(), values);
            assert_eq!(
                Geometry::from_canonical(kind, &values[1..]),
                Err(CanonicalError::Count { kind, expected: length, found: length - 1 })
            );
        }
    }

    #[test]
    fn rows_of_variable_length_come_back_unchanged() {
        let mut tabulated = vec![3.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        tabulated.extend([0.0, 1.0, 0.5, 0.5, 2.0, -0.25, -0.125]);
        tabulated.extend((0..9).map(f64::from));
        let pattern = vec![4.0, 2.0, 1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let stored = vec![1.0, -2.0, 3.5];
        for (kind, values) in [
            (GeometryKind::TabulatedCylinder, tabulated),
            (GeometryKind::Pattern, pattern),
            (GeometryKind::Mesh, stored.clone()),
            (GeometryKind::ElementSurface, stored),
        ] {
            let geometry = Geometry::from_canonical(kind, &values).expect("a canonical row");
            assert_eq!(geometry.canonical_values(), values);
        }
    }

    #[test]
    fn heads_that_promise_something_else_are_refused() {
        let kind = GeometryKind::TabulatedCylinder;
        assert!(matches!(Geometry::from_canonical(kind, &[]), Err(CanonicalError::Count { .. })));
        assert!(matches!(
            Geometry::from_canonical(GeometryKind::Mesh, &[]),
            Err(CanonicalError::Count { .. })
        ));
        assert!(matches!(Geometry::from_canonical(kind, &[1e9, 0.0]), Err(CanonicalError::Value { .. })));
        assert!(matches!(Geometry::from_canonical(kind, &[f64::NAN]), Err(CanonicalError::Value { .. })));
        assert!(matches!(
            Geometry::from_canonical(GeometryKind::Pattern, &[7.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            Err(CanonicalError::Value { .. })
        ));
        assert!(matches!(
            Geometry::from_canonical(GeometryKind::RuledSurface, &[]),
            Err(CanonicalError::NoRow { .. })
        ));
    }
}
