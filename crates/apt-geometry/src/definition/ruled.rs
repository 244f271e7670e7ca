//! RLDSRF (language reference 4.16): two curves, each cut out of a surface by a plane, joined by rulings.

use std::sync::Arc;

use super::format::{Format, Parameter};
use super::given::Given;
use super::{DefinitionError, Impossible};
use crate::Vec3;
use crate::canonical::{Geometry, GeometryKind, RuledSurface};

use Parameter::Entity;

/// Squared distance of the end points of a curve that is too short (APT III 701).
const LEAST_SQUARED_CHORD: f64 = 1e-4;
/// Squared sine of the angle at the first point below which the three points are in line (APT III 702).
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
            Ok(Geometry::RuledSurface(Arc::new(RuledSurface { parts })))
        },
    },
    Format {
        parameters: &[SURFACE, POINT, POINT, SIDE, Entity("apex", &[GeometryKind::Point])],
        help: "between a curve on a surface and a point",
        build: |given| {
            let mut parts = curve(given, 0)?;
            parts.push(given.geometry(4)?.clone());
            Ok(Geometry::RuledSurface(Arc::new(RuledSurface { parts })))
        },
    },
];

/// One curve: the surface, its end points, and the unit vector in the cutting plane across the chord.
fn curve(given: &Given<'_>, first: usize) -> Result<Vec<Geometry>, DefinitionError> {
    let (start, end) = (given.place(first + 1)?, given.place(first + 2)?);
    let chord = end - start;
    if chord.norm_squared() <= LEAST_SQUARED_CHORD {
        return Err(DefinitionError::Special { number: 701, position: Some(first + 2) });
    }
    let toward = match given.geometry(first + 3)? {
        Geometry::Point(point) => point - start,
        _ => given.place(first + 3)?,
    };
    let across =
        across(&chord, &toward).ok_or(DefinitionError::Special { number: 702, position: Some(first + 3) })?;
    Ok(vec![
        given.geometry(first)?.clone(),
        Geometry::Point(start),
        Geometry::Point(end),
        Geometry::Vector(across.try_normalize(0.0).ok_or(Impossible::ZeroVector)?),
    ])
}

/// The part of `toward` across the chord; `None` when the two are nearly in line.
fn across(chord: &Vec3, toward: &Vec3) -> Option<Vec3> {
    let normal = chord.cross(toward);
    let squared_sine = normal.norm_squared() / (chord.norm_squared() * toward.norm_squared());
    // A third point at the first one gives NaN, which is in line too.
    (squared_sine > LEAST_SQUARED_SINE).then(|| normal.cross(chord))
}
