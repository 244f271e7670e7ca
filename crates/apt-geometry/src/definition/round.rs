//! CYLNDR, CONE and SPHERE (language reference 4.5, 4.7, 4.12). A radius or an angle that is not positive is taken as it is,
//! as APT III does.

use nalgebra::Matrix3;

use super::choice::ZERO_COMPONENT;
use super::format::{Format, Parameter};
use super::given::Given;
use super::solve::distinct;
use super::{DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::{Cone, Cylinder, Geometry, GeometryKind, Sphere};

use Parameter::{Entity, Scalar, Word};

const POINT: Parameter = Entity("point", &[GeometryKind::Point]);
const VECTOR: Parameter = Entity("axis vector", &[GeometryKind::Vector]);
const PLANE: Parameter = Entity("plane", &[GeometryKind::Plane]);
const CENTER: Parameter = Word(Modifier::Center);

/// Volume of three unit vectors below which four points lie in a plane (APT III's last pivot).
const COPLANAR_VOLUME: f64 = 1e-5;

pub(super) static CYLINDER_FORMATS: &[Format] = &[
    Format {
        parameters: &[
            Scalar("x"),
            Scalar("y"),
            Scalar("z"),
            Scalar("i"),
            Scalar("j"),
            Scalar("k"),
            Scalar("radius"),
        ],
        help: "by a point of the axis, the axis and the radius",
        build: |given| cylinder(given.triple(0)?, given.triple(3)?, given.scalar(6)?),
    },
    Format {
        parameters: &[POINT, Scalar("i"), Scalar("j"), Scalar("k"), Scalar("radius")],
        help: "by a point of the axis, the axis and the radius",
        build: |given| cylinder(given.place(0)?, given.triple(1)?, given.scalar(4)?),
    },
    Format {
        parameters: &[Scalar("x"), Scalar("y"), Scalar("z"), VECTOR, Scalar("radius")],
        help: "by a point of the axis, the axis and the radius",
        build: |given| cylinder(given.triple(0)?, given.place(3)?, given.scalar(4)?),
    },
    Format {
        parameters: &[POINT, VECTOR, Scalar("radius")],
        help: "by a point of the axis, the axis and the radius",
        build: |given| cylinder(given.place(0)?, given.place(1)?, given.scalar(2)?),
    },
];

pub(super) static CONE_FORMATS: &[Format] = &[Format {
    parameters: &[POINT, VECTOR, Scalar("half angle")],
    help: "by vertex, axis and half angle in degrees",
    build: |given| {
        let (vertex, axis) = (given.place(0)?, unit(&given.place(1)?)?);
        let degrees = given.scalar(2)?;
        // The cosine, which is what is stored, does not know a sign.
        if degrees.abs() >= 90.0 {
            return Err(Impossible::AngleOutOfRange { degrees }.into());
        }
        Ok(Geometry::Cone(Cone { vertex, axis, cosine: degrees.to_radians().cos() }))
    },
}];

pub(super) static SPHERE_FORMATS: &[Format] = &[
    Format {
        parameters: &[Scalar("x"), Scalar("y"), Scalar("z"), Scalar("radius")],
        help: "by center coordinates and radius",
        build: |given| sphere(given.triple(0)?, given.scalar(3)?),
    },
    Format {
        parameters: &[POINT, Scalar("radius")],
        help: "by center and radius",
        build: |given| sphere(given.place(0)?, given.scalar(1)?),
    },
    Format {
        parameters: &[CENTER, POINT, Word(Modifier::Radius), Scalar("radius")],
        help: "by center and radius",
        build: |given| sphere(given.place(1)?, given.scalar(3)?),
    },
    Format {
        parameters: &[CENTER, POINT, POINT],
        help: "by center and a point of the sphere",
        build: |given| {
            let center = given.place(1)?;
            sphere(center, (given.place(2)? - center).norm())
        },
    },
    Format {
        parameters: &[CENTER, POINT, Word(Modifier::TangentTo), PLANE],
        help: "by center, tangent to a plane",
        build: |given| {
            let center = given.place(1)?;
            sphere(center, given.plane(3)?.signed_distance(&center).abs())
        },
    },
    Format { parameters: &[POINT, POINT, POINT, POINT], help: "through four points", build: through_four },
];

fn unit(axis: &Vec3) -> Result<Vec3, Impossible> {
    if axis.amax() <= ZERO_COMPONENT {
        return Err(Impossible::ZeroVector);
    }
    axis.try_normalize(0.0).ok_or(Impossible::ZeroVector)
}

fn cylinder(point: Vec3, axis: Vec3, radius: f64) -> Result<Geometry, DefinitionError> {
    Ok(Geometry::Cylinder(Cylinder { point, axis: unit(&axis)?, radius }))
}

fn sphere(center: Vec3, radius: f64) -> Result<Geometry, DefinitionError> {
    Ok(Geometry::Sphere(Sphere { center, radius }))
}

/// The centre relative to the first point solves `2(Pᵢ−P₁)·c = |Pᵢ−P₁|²`; each equation is divided by its length.
fn through_four(given: &Given<'_>) -> Result<Geometry, DefinitionError> {
    let first = given.place(0)?;
    let mut rows = Vec::with_capacity(3);
    let mut sides = Vec3::zeros();
    for index in 1..4 {
        let other = given.place(index)?;
        distinct(&first, &other)?;
        let across = other - first;
        let length = across.norm();
        rows.push((across / length).transpose());
        sides[index - 1] = 0.5 * length;
    }
    let equations = Matrix3::from_rows(&rows);
    if equations.determinant().abs() <= COPLANAR_VOLUME {
        return Err(Impossible::Singular.into());
    }
    let from_first = equations.lu().solve(&sides).ok_or(Impossible::Singular)?;
    sphere(first + from_first, from_first.norm())
}
