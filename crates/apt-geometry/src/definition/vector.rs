//! VECTOR (language reference 4.10). Points stand for vectors from the origin.

use super::choice::{PLANES, SENSES, Toward, ZERO_COMPONENT, coordinate_plane};
use super::format::{Format, Parameter};
use super::given::Given;
use super::solve::PARALLEL_SINE;
use super::{DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::matrix::sine_cosine_degrees;
use crate::canonical::{Geometry, GeometryKind};

use Parameter::{Entity, Scalar, Selector, Word};

const VECTOR: Parameter = Entity("vector", &[GeometryKind::Vector, GeometryKind::Point]);
const POINT: Parameter = Entity("point", &[GeometryKind::Point]);
const PLANE: Parameter = Entity("plane", &[GeometryKind::Plane]);
const SENSE: Parameter = Selector(SENSES);

pub(super) static FORMATS: &[Format] = &[
    Format {
        parameters: &[Scalar("x"), Scalar("y"), Scalar("z")],
        help: "by its components",
        build: |given| vector(given.triple(0)?),
    },
    Format {
        parameters: &[Scalar("x1"), Scalar("y1"), Scalar("z1"), Scalar("x2"), Scalar("y2"), Scalar("z2")],
        help: "from one place to another, by coordinates",
        build: |given| vector(given.triple(3)? - given.triple(0)?),
    },
    Format {
        parameters: &[POINT, POINT],
        help: "from one point to another",
        build: |given| vector(given.place(1)? - given.place(0)?),
    },
    Format {
        parameters: &[Word(Modifier::PerpendicularTo), PLANE, SENSE],
        help: "unit vector perpendicular to a plane",
        build: |given| vector(toward(given, 2)?.orient(given.plane(1)?.normal)?),
    },
    Format {
        parameters: &[Scalar("factor"), Word(Modifier::Times), VECTOR],
        help: "a vector multiplied by a number",
        build: |given| vector(given.place(2)? * given.scalar(0)?),
    },
    Format {
        parameters: &[VECTOR, Word(Modifier::Cross), VECTOR],
        help: "cross product",
        build: |given| vector(given.place(0)?.cross(&given.place(2)?)),
    },
    Format {
        parameters: &[Word(Modifier::Unit), VECTOR],
        help: "unit vector of a vector",
        build: |given| unit(given.place(1)?),
    },
    Format {
        parameters: &[Word(Modifier::Unit), Scalar("x"), Scalar("y"), Scalar("z")],
        help: "unit vector of components",
        build: |given| unit(given.triple(1)?),
    },
    Format {
        parameters: &[
            Word(Modifier::Length),
            Scalar("length"),
            Word(Modifier::AtAngle),
            Scalar("angle"),
            Selector(PLANES),
        ],
        help: "by length and angle in a coordinate plane",
        build: |given| {
            let plane = coordinate_plane(given.modifier(4)?).ok_or_else(|| given.unknown())?;
            let (sine, cosine) = sine_cosine_degrees(given.scalar(3)?);
            let length = given.scalar(1)?;
            let [first, second, _] = plane.axes();
            let mut result = Vec3::zeros();
            result[first] = length * cosine;
            result[second] = length * sine;
            vector(result)
        },
    },
    Format {
        parameters: &[Word(Modifier::Parallel), Word(Modifier::IntersectionOf), PLANE, PLANE, SENSE],
        help: "unit vector parallel to the intersection of two planes",
        build: |given| {
            let along = given.plane(2)?.normal.cross(&given.plane(3)?.normal);
            if along.norm() <= PARALLEL_SINE {
                return Err(Impossible::Parallel.into());
            }
            vector(toward(given, 4)?.orient(along.normalize())?)
        },
    },
    Format {
        parameters: &[VECTOR, Selector(&[Modifier::Plus, Modifier::Minus]), VECTOR],
        help: "sum or difference of two vectors",
        build: |given| {
            let (first, second) = (given.place(0)?, given.place(2)?);
            vector(if given.modifier(1)? == Modifier::Plus { first + second } else { first - second })
        },
    },
    Format {
        parameters: &[
            Word(Modifier::AtAngle),
            Scalar("angle"),
            Entity("line", &[GeometryKind::Line]),
            Selector(&[
                Modifier::PositiveX,
                Modifier::XLarge,
                Modifier::NegativeX,
                Modifier::XSmall,
                Modifier::PositiveY,
                Modifier::YLarge,
                Modifier::NegativeY,
                Modifier::YSmall,
            ]),
        ],
        help: "unit vector at an angle from a line",
        build: |given| {
            let normal = given.line(2)?.normal;
            let (sine, cosine) = sine_cosine_degrees(given.scalar(1)?);
            let base =
                Vec3::new(normal.x * sine + normal.y * cosine, normal.y * sine - normal.x * cosine, 0.0);
            // A component of zero is no error here: APT III then takes the opposite of the base vector.
            let along = toward(given, 3)?.component(&base) > 0.0;
            vector(if along { base } else { -base })
        },
    },
];

fn vector(value: Vec3) -> Result<Geometry, DefinitionError> {
    Ok(Geometry::Vector(value))
}

fn unit(value: Vec3) -> Result<Geometry, DefinitionError> {
    if value.amax() <= ZERO_COMPONENT {
        return Err(Impossible::ZeroVector.into());
    }
    value.try_normalize(0.0).map(Geometry::Vector).ok_or_else(|| Impossible::ZeroVector.into())
}

fn toward(given: &Given<'_>, index: usize) -> Result<Toward, DefinitionError> {
    Toward::from_word(given.modifier(index)?).ok_or_else(|| given.unknown())
}
