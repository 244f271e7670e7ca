//! MATRIX (language reference 4.11): maps from the new system to the old, `x' = R x + d`.

use nalgebra::Matrix3;

use super::choice::{PLANES, ZERO_COMPONENT, coordinate_plane};
use super::format::{Format, Parameter};
use super::given::Given;
use super::solve::PARALLEL_SINE;
use super::{DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::{Geometry, GeometryKind, Matrix, Plane};

use Parameter::{Choice, Entity, Scalar, Selector, Word};

const MATRIX: Parameter = Entity("matrix", &[GeometryKind::Matrix]);
const PLANE: Parameter = Entity("plane", &[GeometryKind::Plane]);
const POINT: Parameter = Entity("origin", &[GeometryKind::Point]);
const VECTOR: Parameter = Entity("vector", &[GeometryKind::Vector]);
const TRANSL: Parameter = Word(Modifier::Translate);
const SCALE: Parameter = Word(Modifier::Scale);
const MIRROR: Parameter = Word(Modifier::Mirror);
const ROTATION: Parameter = Selector(&[Modifier::XyRotation, Modifier::YzRotation, Modifier::ZxRotation]);
const MIRROR_PLANE: Parameter = Selector(PLANES);
const FACTOR: Parameter = Choice(&[
    &[MATRIX],
    &[TRANSL, Scalar("x"), Scalar("y")],
    &[TRANSL, Scalar("x"), Scalar("y"), Scalar("z")],
    &[ROTATION, Scalar("angle")],
    &[SCALE, Scalar("factor")],
]);

pub(super) static FORMATS: &[Format] = &[
    Format {
        parameters: &[
            Scalar("a11"),
            Scalar("a12"),
            Scalar("a13"),
            Scalar("a14"),
            Scalar("a21"),
            Scalar("a22"),
            Scalar("a23"),
            Scalar("a24"),
            Scalar("a31"),
            Scalar("a32"),
            Scalar("a33"),
            Scalar("a34"),
        ],
        help: "twelve numbers by rows",
        build: |given| {
            let mut rows = [[0.0; 4]; 3];
            for (index, value) in rows.iter_mut().flatten().enumerate() {
                *value = given.scalar(index)?;
            }
            matrix(Matrix { rows })
        },
    },
    Format {
        parameters: &[TRANSL, Scalar("x"), Scalar("y")],
        help: "translation in x and y",
        build: |given| matrix(factor(given, 0)?.matrix),
    },
    Format {
        parameters: &[TRANSL, Scalar("x"), Scalar("y"), Scalar("z")],
        help: "translation",
        build: |given| matrix(factor(given, 0)?.matrix),
    },
    Format {
        parameters: &[ROTATION, Scalar("angle")],
        help: "rotation in a coordinate plane, in degrees",
        build: |given| matrix(factor(given, 0)?.matrix),
    },
    Format {
        parameters: &[SCALE, Scalar("factor")],
        help: "scaling of all coordinates",
        build: |given| matrix(factor(given, 0)?.matrix),
    },
    Format {
        parameters: &[FACTOR, FACTOR],
        help: "product of two matrices, translations, rotations or scalings",
        build: product,
    },
    Format {
        parameters: &[Word(Modifier::Inverse), MATRIX],
        help: "inverse of a matrix",
        build: |given| matrix(given.matrix(1)?.inverse().ok_or(Impossible::Singular)?),
    },
    Format {
        parameters: &[PLANE, PLANE, PLANE],
        help: "by the yz, zx and xy planes of the new system",
        build: |given| {
            let planes = [given.plane(0)?, given.plane(1)?, given.plane(2)?];
            let columns = planes.map(|plane| plane.normal);
            let origin: Vec3 = planes.iter().map(|plane| plane.normal * plane.distance).sum();
            matrix(Matrix::from_parts(&Matrix3::from_columns(&columns), &origin))
        },
    },
    Format {
        parameters: &[POINT, VECTOR, VECTOR],
        help: "by the origin, the x axis and a vector on the side of the y axis",
        build: |given| {
            let (along, beside) = (unit(&given.place(1)?)?, unit(&given.place(2)?)?);
            let across = along.cross(&beside);
            if across.norm() <= PARALLEL_SINE {
                return Err(Impossible::Parallel.into());
            }
            // The product of nearly parallel vectors is known to few digits: what it has along x is rounding.
            let across = (across - along * across.dot(&along)).normalize();
            let columns = [along, across.cross(&along), across];
            matrix(Matrix::from_parts(&Matrix3::from_columns(&columns), &given.place(0)?))
        },
    },
    Format {
        parameters: &[MIRROR, MIRROR_PLANE],
        help: "mirror image in a coordinate plane",
        build: mirrored,
    },
    Format {
        parameters: &[MIRROR, MIRROR_PLANE, MIRROR_PLANE],
        help: "mirror image in two coordinate planes",
        build: mirrored,
    },
    Format {
        parameters: &[MIRROR, MIRROR_PLANE, MIRROR_PLANE, MIRROR_PLANE],
        help: "mirror image in three coordinate planes",
        build: mirrored,
    },
    Format {
        parameters: &[MIRROR, Entity("line or plane", &[GeometryKind::Line, GeometryKind::Plane])],
        help: "mirror image in a line or plane",
        build: |given| matrix(Matrix::reflection(&given.plane(1)?)),
    },
];

fn matrix(value: Matrix) -> Result<Geometry, DefinitionError> {
    Ok(Geometry::Matrix(value))
}

fn unit(vector: &Vec3) -> Result<Vec3, Impossible> {
    if vector.amax() <= ZERO_COMPONENT {
        return Err(Impossible::ZeroVector);
    }
    vector.try_normalize(0.0).ok_or(Impossible::ZeroVector)
}

/// What a factor of a product was given as: the order of multiplication depends on it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum FactorKind {
    Named,
    Translation,
    Rotation,
    Scaling,
}

struct Factor {
    matrix: Matrix,
    kind: FactorKind,
    /// How many arguments it took.
    length: usize,
}

fn factor(given: &Given<'_>, index: usize) -> Result<Factor, DefinitionError> {
    if let Ok(matrix) = given.matrix(index) {
        return Ok(Factor { matrix, kind: FactorKind::Named, length: 1 });
    }
    let value = given.scalar(index + 1)?;
    match given.modifier(index)? {
        Modifier::Translate => {
            let y = given.scalar(index + 2)?;
            let z = given.scalar(index + 3).ok();
            let matrix = Matrix::translation(Vec3::new(value, y, z.unwrap_or(0.0)));
            Ok(Factor { matrix, kind: FactorKind::Translation, length: if z.is_some() { 4 } else { 3 } })
        }
        Modifier::Scale => {
            Ok(Factor { matrix: Matrix::scaling(value), kind: FactorKind::Scaling, length: 2 })
        }
        word => {
            let plane = coordinate_plane(word).ok_or_else(|| given.unknown())?;
            Ok(Factor { matrix: Matrix::rotation(plane, value), kind: FactorKind::Rotation, length: 2 })
        }
    }
}

/// The left factor times the right one, except that a rotation and a translation given directly act in the order in
/// which they are written (checked against APT III, whose manual says otherwise).
fn product(given: &Given<'_>) -> Result<Geometry, DefinitionError> {
    let first = factor(given, 0)?;
    let second = factor(given, first.length)?;
    let as_written = matches!(
        (first.kind, second.kind),
        (FactorKind::Rotation, FactorKind::Translation) | (FactorKind::Translation, FactorKind::Rotation)
    );
    matrix(if as_written {
        second.matrix.multiply(&first.matrix)
    } else {
        first.matrix.multiply(&second.matrix)
    })
}

fn mirrored(given: &Given<'_>) -> Result<Geometry, DefinitionError> {
    let mut result = Matrix::identity();
    for index in 1..given.count() {
        let plane = coordinate_plane(given.modifier(index)?).ok_or_else(|| given.unknown())?;
        let mut normal = Vec3::zeros();
        normal[plane.axes()[2]] = 1.0;
        result = result.multiply(&Matrix::reflection(&Plane { normal, distance: 0.0 }));
    }
    matrix(result)
}
