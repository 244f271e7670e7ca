//! PLANE (language reference 4.3).

use super::choice::{Toward, X_Y_OR_Z, ZERO_COMPONENT};
use super::format::{Format, Parameter};
use super::solve::{PARALLEL_SINE, distinct};
use super::{DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::{Geometry, GeometryKind, Plane};

use Parameter::{Entity, Scalar, Selector, Word};

const POINT: Parameter = Entity("point", &[GeometryKind::Point]);
const PLANE: Parameter = Entity("plane", &[GeometryKind::Plane]);
const VECTOR: Parameter = Entity("vector", &[GeometryKind::Vector]);
const PARLEL: Parameter = Word(Modifier::Parallel);
const PERPTO: Parameter = Word(Modifier::PerpendicularTo);

pub(super) static FORMATS: &[Format] = &[
    Format {
        parameters: &[Scalar("a"), Scalar("b"), Scalar("c"), Scalar("d")],
        help: "by the coefficients of ax + by + cz = d",
        build: |given| {
            let normal = given.triple(0)?;
            if normal.amax() <= ZERO_COMPONENT {
                return Err(Impossible::ZeroVector.into());
            }
            Plane::from_equation(normal.x, normal.y, normal.z, given.scalar(3)?)
                .map(Geometry::Plane)
                .ok_or_else(|| Impossible::ZeroVector.into())
        },
    },
    Format {
        parameters: &[POINT, POINT, POINT],
        help: "through three points",
        build: |given| through_three(&given.place(0)?, &given.place(1)?, &given.place(2)?),
    },
    Format {
        parameters: &[POINT, PARLEL, PLANE],
        help: "through a point, parallel to a plane",
        build: |given| through(given.place(0)?, given.plane(2)?.normal),
    },
    Format {
        parameters: &[PARLEL, PLANE, Selector(X_Y_OR_Z), Scalar("distance")],
        help: "parallel to a plane at a distance on a side",
        build: |given| {
            let toward = Toward::from_word(given.modifier(2)?).ok_or_else(|| given.unknown())?;
            let plane = toward.orient_plane(given.plane(1)?)?;
            Ok(Geometry::Plane(Plane { distance: plane.distance + given.scalar(3)?, ..plane }))
        },
    },
    Format {
        parameters: &[POINT, PERPTO, VECTOR],
        help: "through a point, perpendicular to a vector",
        build: |given| {
            let normal = given.place(2)?;
            if normal.amax() <= ZERO_COMPONENT {
                return Err(Impossible::ZeroVector.into());
            }
            through(given.place(0)?, normal)
        },
    },
    Format {
        parameters: &[PERPTO, PLANE, POINT, POINT],
        help: "perpendicular to a plane, through two points",
        build: |given| upright(&given.plane(1)?, &given.place(2)?, &given.place(3)?),
    },
    Format {
        parameters: &[POINT, POINT, PERPTO, PLANE],
        help: "through two points, perpendicular to a plane",
        build: |given| upright(&given.plane(3)?, &given.place(0)?, &given.place(1)?),
    },
    Format {
        parameters: &[POINT, PERPTO, PLANE, PLANE],
        help: "through a point, perpendicular to two planes",
        build: |given| {
            let normal = given.plane(2)?.normal.cross(&given.plane(3)?.normal);
            if normal.norm() <= PARALLEL_SINE {
                return Err(Impossible::Parallel.into());
            }
            through(given.place(0)?, normal)
        },
    },
];

fn through(point: Vec3, normal: Vec3) -> Result<Geometry, DefinitionError> {
    Plane::through(point, normal).map(Geometry::Plane).ok_or_else(|| Impossible::ZeroVector.into())
}

fn through_three(first: &Vec3, second: &Vec3, third: &Vec3) -> Result<Geometry, DefinitionError> {
    distinct(first, second)?;
    distinct(first, third)?;
    distinct(second, third)?;
    let (to_second, to_third) = ((first - second).normalize(), (first - third).normalize());
    let normal = to_second.cross(&to_third);
    if normal.norm() <= PARALLEL_SINE {
        return Err(Impossible::Collinear.into());
    }
    through(*first, normal)
}

fn upright(plane: &Plane, first: &Vec3, second: &Vec3) -> Result<Geometry, DefinitionError> {
    distinct(first, second)?;
    let normal = plane.normal.cross(&(first - second).normalize());
    if normal.norm() <= PARALLEL_SINE {
        return Err(Impossible::Parallel.into());
    }
    through(*first, normal)
}
