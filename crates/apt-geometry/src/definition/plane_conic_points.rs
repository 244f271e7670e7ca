//! LCONIC (language reference 4.9): a conic through points with slopes at some of them.
//!
//! The conics through four conditions are the pencil `L1·L2 + R·L3·L4 = 0` of two pairs of lines; the fifth condition
//! gives `R`. A slope at a point stands for two points that have run together.

use super::format::{Format, Parameter};
use super::given::Given;
use super::solve::distinct;
use super::{DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::{Geometry, GeometryKind, Plane, Quadric};

use Parameter::{Choice, Entity, Scalar, Word};

const PLACE: Parameter = Choice(&[&[Entity("point", &[GeometryKind::Point])], &[Scalar("x"), Scalar("y")]]);
const SLOPE: Parameter = Scalar("slope");

/// Value of a pair of lines at a point, relative to the square of its distance from the farthest other point, below which
/// the point lies on the pair and the conic falls apart.
const ON_LINES: f64 = 1e-9;

pub(super) static FORMATS: &[Format] = &[
    Format {
        parameters: &[Word(Modifier::FivePoints), PLACE, PLACE, PLACE, PLACE, PLACE],
        help: "through five points",
        build: |given| {
            let mut reader = Reader { given, next: 1 };
            let points =
                [reader.place()?, reader.place()?, reader.place()?, reader.place()?, reader.place()?];
            let [first, second, third, fourth, fifth] = &points;
            pencil(
                [chord(first, second)?, chord(fourth, fifth)?],
                [chord(first, fourth)?, chord(second, fifth)?],
                third,
                &[first, second, fourth, fifth],
            )
        },
    },
    Format {
        parameters: &[Word(Modifier::FourPointsOneSlope), PLACE, SLOPE, PLACE, PLACE, PLACE],
        help: "through four points, with the slope at the first",
        build: |given| {
            let mut reader = Reader { given, next: 1 };
            let (first, slope) = (reader.place()?, reader.scalar()?);
            let [third, fourth, fifth] = [reader.place()?, reader.place()?, reader.place()?];
            pencil(
                [sloped(&first, slope)?, chord(&fourth, &fifth)?],
                [chord(&first, &fourth)?, chord(&first, &fifth)?],
                &third,
                &[&first, &fourth, &fifth],
            )
        },
    },
    Format {
        parameters: &[Word(Modifier::ThreePointsTwoSlopes), PLACE, SLOPE, PLACE, SLOPE, PLACE],
        help: "through three points, with the slopes at the first two",
        build: |given| {
            let mut reader = Reader { given, next: 1 };
            let (first, first_slope) = (reader.place()?, reader.scalar()?);
            let (second, second_slope) = (reader.place()?, reader.scalar()?);
            let third = reader.place()?;
            let between = chord(&first, &second)?;
            pencil(
                [sloped(&first, first_slope)?, sloped(&second, second_slope)?],
                [between, between],
                &third,
                &[&first, &second],
            )
        },
    },
];

/// Takes points, given by name or as two numbers, and numbers in turn.
struct Reader<'a, 'b> {
    given: &'a Given<'b>,
    next: usize,
}

impl Reader<'_, '_> {
    fn scalar(&mut self) -> Result<f64, DefinitionError> {
        let value = self.given.scalar(self.next)?;
        self.next += 1;
        Ok(value)
    }

    fn place(&mut self) -> Result<Vec3, DefinitionError> {
        if let Ok(place) = self.given.flat(self.next) {
            self.next += 1;
            return Ok(place);
        }
        Ok(Vec3::new(self.scalar()?, self.scalar()?, 0.0))
    }
}

/// The line through two points, its normal to the right.
fn chord(first: &Vec3, second: &Vec3) -> Result<Plane, Impossible> {
    distinct(first, second)?;
    let along = second - first;
    Plane::through(*first, Vec3::new(along.y, -along.x, 0.0)).ok_or(Impossible::ZeroLength)
}

/// The line through a point with a slope, its normal to the right of growing x.
fn sloped(point: &Vec3, slope: f64) -> Result<Plane, Impossible> {
    Plane::through(*point, Vec3::new(slope, -1.0, 0.0)).ok_or(Impossible::ZeroLength)
}

/// The conic of the pencil of two pairs of lines through the points `others` that also goes through one more point.
fn pencil(
    first: [Plane; 2],
    second: [Plane; 2],
    through: &Vec3,
    others: &[&Vec3],
) -> Result<Geometry, DefinitionError> {
    let value = |pair: &[Plane; 2]| pair[0].signed_distance(through) * pair[1].signed_distance(through);
    let (of_first, of_second) = (value(&first), value(&second));
    let size = others.iter().map(|other| (*other - through).xy().norm_squared()).fold(0.0, f64::max);
    if of_first.abs() <= ON_LINES * size || of_second.abs() <= ON_LINES * size {
        return Err(Impossible::Collinear.into());
    }
    let ratio = -of_first / of_second;
    let (one, other) = (product(&first).coefficients, product(&second).coefficients);
    Ok(Geometry::LoftConic(Quadric {
        coefficients: std::array::from_fn(|index| one[index] + ratio * other[index]),
    }))
}

/// The pair of lines as a conic.
fn product([first, second]: &[Plane; 2]) -> Quadric {
    let (m, n) = (first.normal, second.normal);
    let (d, e) = (first.distance, second.distance);
    Quadric::plane_conic(
        m.x * n.x,
        m.y * n.y,
        d * e,
        0.5 * (m.x * n.y + m.y * n.x),
        -0.5 * (m.x * e + n.x * d),
        -0.5 * (m.y * e + n.y * d),
    )
}
