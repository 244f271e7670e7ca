//! The geometric functions of arithmetic expressions: DOTF, LNTHF, ANGLF, DISTF, NUMF (language reference 2.6), the
//! wider forms of APT4, and CANF, SPATF (language reference 10.4).

use super::{Geometry, GeometryKind, Plane};
use crate::Vec3;

/// Sine of the angle between two lines or planes that still count as parallel for DISTF.
const PARALLEL_SINE: f64 = 1e-8;
/// Distance of a point from a circle's centre, in part-program units, below which its direction is unknown (ANGLF).
const CENTER_DISTANCE: f64 = 1e-6;

/// Which dialect's rules the arguments follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FunctionRules {
    /// APT III: two arguments of one type.
    Apt3,
    /// APT4: points and vectors mixed, DISTF of points, ANGLF of directions.
    Apt4,
}

/// Why a geometric function has no value. Positions are indices into the argument list.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FunctionError {
    /// An argument is of a type that the function does not take (APT III 66).
    #[error("argument {position} cannot be a {found:?}")]
    Kind {
        /// Index of the argument.
        position: usize,
        /// Its type.
        found: GeometryKind,
    },
    /// The two arguments must be of one type (APT III 80).
    #[error("the arguments are a {first:?} and a {second:?}")]
    Mixed {
        /// Type of the first argument.
        first: GeometryKind,
        /// Type of the second argument.
        second: GeometryKind,
    },
    /// DISTF of surfaces that meet (APT III 66, APT4 62).
    #[error("the sine of the angle between them is {sine}")]
    NotParallel {
        /// Sine of the angle between the surfaces.
        sine: f64,
    },
    /// A direction that is not there: the point is the circle's centre, or a vector has no length (APT III 66).
    #[error("no direction over a length of {length}")]
    NoDirection {
        /// The length found, in part-program units.
        length: f64,
    },
    /// CANF of a value that the canonical form does not have (APT4 40, or 41 when not positive).
    #[error("value {index} of {count}")]
    CanonicalIndex {
        /// The number asked for.
        index: f64,
        /// How many values there are.
        count: usize,
    },
}

impl FunctionError {
    /// The APT III diagnostic number; for CANF, which only APT4 has, the number there.
    pub fn apt3(&self) -> Option<u16> {
        Some(match self {
            FunctionError::Kind { .. }
            | FunctionError::NotParallel { .. }
            | FunctionError::NoDirection { .. } => 66,
            FunctionError::Mixed { .. } => 80,
            FunctionError::CanonicalIndex { index, .. } if *index < 1.0 => 41,
            FunctionError::CanonicalIndex { .. } => 40,
        })
    }
}

/// DOTF: the scalar product of two vectors or two points.
///
/// # Errors
/// Other types; under APT III a point with a vector.
pub fn dot_product(first: &Geometry, second: &Geometry, rules: FunctionRules) -> Result<f64, FunctionError> {
    let (a, b) = (position_vector(first, 0)?, position_vector(second, 1)?);
    if rules == FunctionRules::Apt3 && first.kind() != second.kind() {
        return Err(FunctionError::Mixed { first: first.kind(), second: second.kind() });
    }
    Ok(a.dot(&b))
}

/// LNTHF: the length of a vector, or of the vector to a point.
///
/// # Errors
/// Other types.
pub fn length(of: &Geometry) -> Result<f64, FunctionError> {
    Ok(position_vector(of, 0)?.norm())
}

/// ANGLF, in degrees: the direction from a circle's centre to a point, `0 ≤ angle < 360`. Under APT4 also the angle
/// between two directions, `0 ≤ angle ≤ 180`, where a plane gives its normal and a line its direction.
///
/// # Errors
/// Other types, or a direction that does not exist.
pub fn angle_degrees(
    first: &Geometry,
    second: &Geometry,
    rules: FunctionRules,
) -> Result<f64, FunctionError> {
    if let Geometry::Circle(circle) = first {
        let Geometry::Point(point) = second else {
            return Err(FunctionError::Kind { position: 1, found: second.kind() });
        };
        let (x, y) = (point.x - circle.point.x, point.y - circle.point.y);
        if x.abs() <= CENTER_DISTANCE && y.abs() <= CENTER_DISTANCE {
            return Err(FunctionError::NoDirection { length: x.hypot(y) });
        }
        let degrees = y.atan2(x).to_degrees();
        // A tiny negative angle plus 360 rounds to 360, which is outside the range.
        let turned = if degrees < 0.0 { degrees + 360.0 } else { degrees };
        return Ok(if turned >= 360.0 { 0.0 } else { turned });
    }
    if rules == FunctionRules::Apt3 {
        return Err(FunctionError::Kind { position: 0, found: first.kind() });
    }
    let (a, b) = (direction(first, 0)?, direction(second, 1)?);
    for vector in [&a, &b] {
        if vector.norm() == 0.0 {
            return Err(FunctionError::NoDirection { length: 0.0 });
        }
    }
    Ok(a.cross(&b).norm().atan2(a.dot(&b)).to_degrees())
}

/// DISTF: the distance of two parallel lines or planes. Under APT4 also between two points, and between a point and a
/// line or plane.
///
/// # Errors
/// Surfaces that are not parallel, mixed types, or types that have no distance.
pub fn distance(first: &Geometry, second: &Geometry, rules: FunctionRules) -> Result<f64, FunctionError> {
    match (first, second) {
        (Geometry::Line(a), Geometry::Line(b)) | (Geometry::Plane(a), Geometry::Plane(b)) => {
            parallel_distance(a, b)
        }
        (Geometry::Line(_) | Geometry::Plane(_), Geometry::Line(_) | Geometry::Plane(_)) => {
            Err(FunctionError::Mixed { first: first.kind(), second: second.kind() })
        }
        _ if rules == FunctionRules::Apt3 => {
            let position = usize::from(matches!(first, Geometry::Line(_) | Geometry::Plane(_)));
            Err(FunctionError::Kind { position, found: [first.kind(), second.kind()][position] })
        }
        (Geometry::Point(a), Geometry::Point(b)) => Ok((b - a).norm()),
        (Geometry::Point(point), Geometry::Line(plane) | Geometry::Plane(plane))
        | (Geometry::Line(plane) | Geometry::Plane(plane), Geometry::Point(point)) => {
            Ok(plane.signed_distance(point).abs())
        }
        (Geometry::Point(_) | Geometry::Line(_) | Geometry::Plane(_), _) => {
            Err(FunctionError::Kind { position: 1, found: second.kind() })
        }
        _ => Err(FunctionError::Kind { position: 0, found: first.kind() }),
    }
}

/// NUMF: the number of points of a pattern.
///
/// # Errors
/// Anything but a pattern.
pub fn point_count(of: &Geometry) -> Result<f64, FunctionError> {
    match of {
        Geometry::Pattern(pattern) => Ok(pattern.points.len() as f64),
        _ => Err(FunctionError::Kind { position: 0, found: of.kind() }),
    }
}

/// SPATF: the triple product `(a × b)·c`.
///
/// # Errors
/// Anything but points and vectors.
pub fn triple_product(first: &Geometry, second: &Geometry, third: &Geometry) -> Result<f64, FunctionError> {
    let (a, b, c) = (position_vector(first, 0)?, position_vector(second, 1)?, position_vector(third, 2)?);
    Ok(a.cross(&b).dot(&c))
}

/// CANF: the canonical value with this number, counted from one; a fraction is cut off.
///
/// # Errors
/// There is no value with this number.
pub fn canonical_value(of: &Geometry, index: f64) -> Result<f64, FunctionError> {
    let values = of.canonical_values();
    let missing = FunctionError::CanonicalIndex { index, count: values.len() };
    if index >= 1.0 && index < values.len() as f64 + 1.0 {
        values.get(index as usize - 1).copied().ok_or(missing)
    } else {
        Err(missing)
    }
}

/// A point or vector as the vector from the origin.
fn position_vector(of: &Geometry, position: usize) -> Result<Vec3, FunctionError> {
    match of {
        Geometry::Point(vector) | Geometry::Vector(vector) => Ok(*vector),
        _ => Err(FunctionError::Kind { position, found: of.kind() }),
    }
}

fn direction(of: &Geometry, position: usize) -> Result<Vec3, FunctionError> {
    match of {
        Geometry::Plane(plane) => Ok(plane.normal),
        Geometry::Line(plane) => Ok(plane.line_direction()),
        _ => position_vector(of, position),
    }
}

fn parallel_distance(first: &Plane, second: &Plane) -> Result<f64, FunctionError> {
    let sine = first.normal.cross(&second.normal).norm() / (first.normal.norm() * second.normal.norm());
    if sine.is_nan() || sine > PARALLEL_SINE {
        return Err(FunctionError::NotParallel { sine });
    }
    let offset = |plane: &Plane| plane.distance / plane.normal.norm();
    let sense = if first.normal.dot(&second.normal) < 0.0 { -1.0 } else { 1.0 };
    Ok((offset(first) - sense * offset(second)).abs())
}

#[cfg(test)]
mod tests {
    use super::super::Cylinder;
    use super::FunctionRules::{Apt3, Apt4};
    use super::*;

    fn point(x: f64, y: f64, z: f64) -> Geometry {
        Geometry::Point(Vec3::new(x, y, z))
    }

    fn vector(x: f64, y: f64, z: f64) -> Geometry {
        Geometry::Vector(Vec3::new(x, y, z))
    }

    fn line(a: f64, b: f64, d: f64) -> Geometry {
        Geometry::Line(Plane { normal: Vec3::new(a, b, 0.0), distance: d })
    }

    #[test]
    fn products_and_lengths() {
        assert_eq!(dot_product(&vector(1.0, 2.0, 3.0), &vector(4.0, 5.0, 6.0), Apt3), Ok(32.0));
        assert_eq!(
            dot_product(&vector(1.0, 2.0, 3.0), &point(4.0, 5.0, 6.0), Apt3),
            Err(FunctionError::Mixed { first: GeometryKind::Vector, second: GeometryKind::Point })
        );
        assert_eq!(dot_product(&vector(1.0, 2.0, 3.0), &point(4.0, 5.0, 6.0), Apt4), Ok(32.0));
        assert_eq!(length(&point(3.0, 0.0, 4.0)), Ok(5.0));
        assert_eq!(length(&line(1.0, 0.0, 0.0)).map_err(|error| error.apt3()), Err(Some(66)));
        assert_eq!(
            triple_product(&vector(1.0, 0.0, 0.0), &vector(0.0, 2.0, 0.0), &point(5.0, 6.0, 7.0)),
            Ok(14.0)
        );
    }

    #[test]
    fn angles_go_round_from_the_x_axis() {
        let circle = Geometry::Circle(Cylinder::circle(0.0, 0.0, 3.0));
        let angle = angle_degrees(&circle, &point(2.0, -2.0, 0.0), Apt3).expect("an angle");
        assert!((angle - 315.0).abs() < 1e-12);
        assert_eq!(angle_degrees(&circle, &point(1.0, -1e-300, 0.0), Apt3), Ok(0.0));
        assert!(matches!(
            angle_degrees(&circle, &point(0.0, 1e-7, 0.0), Apt3),
            Err(FunctionError::NoDirection { .. })
        ));
        let between = angle_degrees(&vector(1.0, 0.0, 0.0), &vector(1.0, 1.0, 0.0), Apt4).expect("an angle");
        assert!((between - 45.0).abs() < 1e-12);
        assert!(angle_degrees(&vector(1.0, 0.0, 0.0), &vector(1.0, 1.0, 0.0), Apt3).is_err());
    }

    #[test]
    fn distances_of_parallels_ignore_the_sense_of_the_normals() {
        assert_eq!(distance(&line(0.0, -1.0, 0.0), &line(0.0, -1.0, -2.5), Apt3), Ok(2.5));
        assert_eq!(distance(&line(0.0, 1.0, 1.0), &line(0.0, -1.0, 2.0), Apt3), Ok(3.0));
        assert!(matches!(
            distance(&line(0.0, 1.0, 1.0), &line(1.0, 0.0, 2.0), Apt3),
            Err(FunctionError::NotParallel { .. })
        ));
        let plane = Geometry::Plane(Plane { normal: Vec3::x(), distance: 1.0 });
        assert!(matches!(distance(&plane, &line(1.0, 0.0, 0.0), Apt3), Err(FunctionError::Mixed { .. })));
        assert!(matches!(
            distance(&point(0.0, 0.0, 0.0), &plane, Apt3),
            Err(FunctionError::Kind { position: 0, .. })
        ));
        assert_eq!(distance(&point(4.0, 0.0, 0.0), &plane, Apt4), Ok(3.0));
        assert_eq!(distance(&plane, &point(4.0, 0.0, 0.0), Apt4), Ok(3.0));
        assert_eq!(distance(&point(0.0, 3.0, 0.0), &point(4.0, 0.0, 0.0), Apt4), Ok(5.0));
    }

    #[test]
    fn canonical_values_count_from_one() {
        let circle = Geometry::Circle(Cylinder::circle(1.0, 2.0, 3.0));
        assert_eq!(canonical_value(&circle, 7.9), Ok(3.0));
        assert_eq!(canonical_value(&circle, 8.0).map_err(|error| error.apt3()), Err(Some(40)));
        assert_eq!(canonical_value(&circle, 0.0).map_err(|error| error.apt3()), Err(Some(41)));
        assert!(canonical_value(&circle, f64::NAN).is_err());
    }
}
