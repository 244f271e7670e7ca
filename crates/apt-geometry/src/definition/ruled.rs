//! RLDSRF (language reference 4.16): two curves, each cut out of a surface by a plane, joined by rulings.

use super::DefinitionError;
use super::format::{Format, Parameter};
use super::given::Given;
use super::solve::PARALLEL_SINE;
use crate::Vec3;
use crate::canonical::{Geometry, GeometryKind, Remembering, RuledSurface};

use Parameter::Entity;

/// Squared distance of the end points of a curve that is too short (APT III 701).
const LEAST_SQUARED_CHORD: f64 = 1e-4;
/// Squared sine of the angle between chord and vector below which they span no plane (APT III 702).
const LEAST_SQUARED_SINE: f64 = 1e-2;

const SURFACE: Parameter = Entity(
    "surface",
    &[
        GeometryKind::Line,
        GeometryKind::Plane,
        GeometryKind::Circle,
        GeometryKind::Cylinder,
        GeometryKind::Ellipse,
        GeometryKind::Hyperbola,
        GeometryKind::Cone,
        GeometryKind::GeneralConic,
        GeometryKind::LoftConic,
        GeometryKind::Sphere,
        GeometryKind::Quadric,
        GeometryKind::TabulatedCylinder,
    ],
);
const POINT: Parameter = Entity("end point", &[GeometryKind::Point]);
const SIDE: Parameter =
    Entity("point or vector of the cutting plane", &[GeometryKind::Point, GeometryKind::Vector]);

pub(super) static FORMATS: &[Format] = &[
    Format {
        parameters: &[SURFACE, POINT, POINT, SIDE, SURFACE, POINT, POINT, SIDE],
        help: "between two curves, each on a surface in the plane of two end points and a third point or vector",
        build: |given| {
            let mut parts = curve(given, 0)?;
            parts.extend(curve(given, 4)?);
            Ok(Geometry::RuledSurface(Remembering::new(RuledSurface { parts })))
        },
    },
    Format {
        parameters: &[SURFACE, POINT, POINT, SIDE, Entity("apex", &[GeometryKind::Point])],
        help: "between a curve on a surface and a point",
        build: |given| {
            let mut parts = curve(given, 0)?;
            parts.push(given.geometry(4)?.clone());
            Ok(Geometry::RuledSurface(Remembering::new(RuledSurface { parts })))
        },
    },
];

/// One curve: the surface, its end points, and the unit direction in the cutting plane. The latter keeps the type word
/// that it was given with.
fn curve(given: &Given<'_>, first: usize) -> Result<Vec<Geometry>, DefinitionError> {
    let (start, end) = (given.place(first + 1)?, given.place(first + 2)?);
    let chord = end - start;
    if chord.norm_squared() <= LEAST_SQUARED_CHORD {
        return Err(DefinitionError::Special { number: 701, position: Some(first + 2) });
    }
    let in_line = DefinitionError::Special { number: 702, position: Some(first + 3) };
    let third = match given.geometry(first + 3)? {
        Geometry::Point(third) => Geometry::Point(across(&chord, &(third - start)).ok_or(in_line)?),
        _ => Geometry::Vector(steep(&chord, &given.place(first + 3)?).ok_or(in_line)?),
    };
    Ok(vec![given.geometry(first)?.clone(), Geometry::Point(start), Geometry::Point(end), third])
}

/// The unit vector across the chord in the plane with a third point; `None` when that is in line with the ends.
fn across(chord: &Vec3, toward: &Vec3) -> Option<Vec3> {
    let normal = chord.cross(toward);
    // A third point at the first one gives zero on both sides, which is in line too.
    (normal.norm() > PARALLEL_SINE * chord.norm() * toward.norm())
        .then(|| normal.cross(chord))
        .and_then(|across| across.try_normalize(0.0))
}

/// A given vector as a unit vector, not turned; `None` when it is nearly along the chord.
fn steep(chord: &Vec3, vector: &Vec3) -> Option<Vec3> {
    let unit = vector.try_normalize(0.0)?;
    let squared_sine = chord.cross(&unit).norm_squared() / chord.norm_squared();
    (squared_sine > LEAST_SQUARED_SINE).then_some(unit)
}
