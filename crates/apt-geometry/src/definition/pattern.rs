//! PATERN (language reference 4.17): sets of points for GOTO.

use std::sync::Arc;

use super::choice::ZERO_COMPONENT;
use super::format::{Format, Parameter};
use super::given::Given;
use super::{DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::matrix::sine_cosine_degrees;
use crate::canonical::{Arrangement, Geometry, GeometryKind, Pattern};

use Parameter::{Choice, Entity, Repeated, Scalar, Selector, Word};

const POINT: Parameter = Entity("point", &[GeometryKind::Point]);
const VECTOR: Parameter = Entity("vector", &[GeometryKind::Vector]);
const CIRCLE: Parameter = Entity("circle", &[GeometryKind::Circle]);
const PATTERN: Parameter = Entity("pattern", &[GeometryKind::Pattern]);
const LINEAR: Parameter = Word(Modifier::Linear);
const ARC: Parameter = Word(Modifier::Arc);
const PARLEL: Parameter = Word(Modifier::Parallel);
const INCR: Parameter = Word(Modifier::Increment);
const SENSE: Parameter = Selector(&[Modifier::Clockwise, Modifier::Counterclockwise]);
const INCREMENT: Parameter =
    Choice(&[&[Scalar("increment")], &[Scalar("count"), Word(Modifier::At), Scalar("increment")]]);
const INCREMENTS: Parameter = Repeated(&[INCREMENT]);
/// APT III takes INCR again before each increment of a LINEAR pattern, and only there.
const MORE_INCREMENTS: Parameter =
    Choice(&[&[], &[Repeated(&[Choice(&[&[INCREMENT], &[INCR, INCREMENT]])])]]);

/// Most points of a pattern. APT III had room for 330; the bound here only keeps a slip in a count from filling the
/// memory (APT III 802).
const MOST_POINTS: f64 = 100_000.0;

pub(super) static FORMATS: &[Format] = &[
    Format {
        parameters: &[LINEAR, POINT, POINT, Scalar("number")],
        help: "points at equal distances between two points, both included",
        build: |given| {
            let (first, last) = (given.place(1)?, given.place(2)?);
            let number = at_least_one(given, 3)?;
            let gaps = number.saturating_sub(1).max(1) as f64;
            linear((0..number).map(|index| first + (last - first) * (index as f64 / gaps)).collect())
        },
    },
    Format {
        parameters: &[LINEAR, POINT, VECTOR, Scalar("number")],
        help: "points one vector apart",
        build: |given| {
            let (first, step) = (given.place(1)?, given.place(2)?);
            linear((0..at_least_one(given, 3)?).map(|index| first + step * index as f64).collect())
        },
    },
    Format {
        parameters: &[LINEAR, POINT, VECTOR, INCR, INCREMENT, MORE_INCREMENTS],
        help: "points at increments along a vector",
        build: |given| {
            let (first, along) = (given.place(1)?, unit(given, 2)?);
            linear(stations(given, 4)?.into_iter().map(|station| first + along * station).collect())
        },
    },
    Format {
        parameters: &[ARC, CIRCLE, Scalar("start angle"), Scalar("end angle"), SENSE, Scalar("number")],
        help: "points at equal angles on a circle, both angles included; z from ZSURF",
        build: arc_between,
    },
    Format {
        parameters: &[ARC, CIRCLE, Scalar("start angle"), SENSE, INCR, INCREMENTS],
        help: "points at increments of angle on a circle; z from ZSURF",
        build: |given| {
            let start = given.scalar(2)?;
            let sense = sense(given, 3)?;
            let angles = stations(given, 5)?.into_iter().map(|turn| start + sense * turn);
            arc(given, angles)
        },
    },
    Format {
        parameters: &[PARLEL, PATTERN, PATTERN],
        help: "a linear pattern repeated along another",
        build: |given| {
            let rows = linear_points(given, 2)?;
            let origin = rows.first().copied().unwrap_or_else(Vec3::zeros);
            let offsets: Vec<Vec3> = rows.iter().map(|point| point - origin).collect();
            parallel(given, &offsets)
        },
    },
    Format {
        parameters: &[PARLEL, PATTERN, VECTOR, Scalar("number")],
        help: "a linear pattern repeated one vector apart",
        build: |given| {
            let step = given.place(2)?;
            let offsets: Vec<Vec3> = (0..at_least_one(given, 3)?).map(|index| step * index as f64).collect();
            parallel(given, &offsets)
        },
    },
    Format {
        parameters: &[PARLEL, PATTERN, VECTOR, INCR, INCREMENTS],
        help: "a linear pattern repeated at increments along a vector",
        build: |given| {
            let along = unit(given, 2)?;
            let offsets: Vec<Vec3> = stations(given, 4)?.into_iter().map(|station| along * station).collect();
            parallel(given, &offsets)
        },
    },
    Format {
        parameters: &[Word(Modifier::Random), Repeated(&[Choice(&[&[POINT], &[PATTERN]])])],
        help: "points and patterns one after the other",
        build: random,
    },
];

/// A count of points: the whole part of a number; nothing where that is negative, as in APT III.
fn count(given: &Given<'_>, index: usize) -> Result<usize, DefinitionError> {
    let number = given.scalar(index)?.trunc().max(0.0);
    if number > MOST_POINTS {
        return Err(DefinitionError::Special { number: 802, position: Some(index) });
    }
    Ok(number as usize)
}

/// The count of a whole pattern: its first point, or column, is there whatever the count says, as in APT III.
fn at_least_one(given: &Given<'_>, index: usize) -> Result<usize, DefinitionError> {
    Ok(count(given, index)?.max(1))
}

fn unit(given: &Given<'_>, index: usize) -> Result<Vec3, DefinitionError> {
    let vector = given.place(index)?;
    if vector.amax() <= ZERO_COMPONENT {
        return Err(Impossible::ZeroVector.into());
    }
    vector.try_normalize(0.0).ok_or_else(|| Impossible::ZeroVector.into())
}

/// Zero and the sums of the increments from `index` on; `n,AT,d` stands for d taken n times.
fn stations(given: &Given<'_>, mut index: usize) -> Result<Vec<f64>, DefinitionError> {
    let mut stations = vec![0.0];
    let mut reached = 0.0;
    while index < given.count() {
        if given.word_at(index) == Some(Modifier::Increment) {
            index += 1;
        }
        let grouped = given.word_at(index + 1) == Some(Modifier::At);
        let (times, increment) = if grouped {
            (count(given, index)?, given.scalar(index + 2)?)
        } else {
            (1, given.scalar(index)?)
        };
        if (stations.len() + times) as f64 > MOST_POINTS {
            return Err(DefinitionError::Special { number: 802, position: Some(index) });
        }
        // Multiples of the increment, not repeated sums: the last point stays exact.
        stations.extend((1..=times).map(|turn| reached + increment * turn as f64));
        reached += increment * times as f64;
        index += if grouped { 3 } else { 1 };
    }
    Ok(stations)
}

fn linear(points: Vec<Vec3>) -> Result<Geometry, DefinitionError> {
    let column = points.len();
    Ok(pattern(Arrangement::Linear, points, column))
}

fn pattern(arrangement: Arrangement, points: Vec<Vec3>, column: usize) -> Geometry {
    Geometry::Pattern(Arc::new(Pattern { arrangement, points, column }))
}

/// 1 counter-clockwise, −1 clockwise.
fn sense(given: &Given<'_>, index: usize) -> Result<f64, DefinitionError> {
    Ok(if given.modifier(index)? == Modifier::Clockwise { -1.0 } else { 1.0 })
}

/// An end angle that lies against the sense is taken whole turns on, so that equal angles stand for the whole circle; one
/// more than a turn ahead stays there, as in APT III.
fn arc_between(given: &Given<'_>) -> Result<Geometry, DefinitionError> {
    let (start, end) = (given.scalar(2)?, given.scalar(3)?);
    let sense = sense(given, 4)?;
    let number = at_least_one(given, 5)?;
    let ahead = sense * (end - start);
    let turn = if ahead > 0.0 { ahead } else { ahead.rem_euclid(360.0) };
    let turn = if turn == 0.0 { 360.0 } else { turn };
    let gaps = number.saturating_sub(1).max(1) as f64;
    arc(given, (0..number).map(|index| start + sense * turn * (index as f64 / gaps)))
}

fn arc(given: &Given<'_>, angles: impl Iterator<Item = f64>) -> Result<Geometry, DefinitionError> {
    let circle = given.circle(1)?;
    let points: Result<Vec<Vec3>, DefinitionError> = angles
        .map(|degrees| {
            let (sine, cosine) = sine_cosine_degrees(degrees);
            given.on_z_surface(circle.point.x + circle.radius * cosine, circle.point.y + circle.radius * sine)
        })
        .collect();
    let points = points?;
    let column = points.len();
    Ok(pattern(Arrangement::Arc, points, column))
}

fn linear_points<'a>(given: &Given<'a>, index: usize) -> Result<&'a [Vec3], DefinitionError> {
    match given.geometry(index)? {
        Geometry::Pattern(pattern) if pattern.arrangement == Arrangement::Linear => Ok(&pattern.points),
        Geometry::Pattern(_) => Err(DefinitionError::Special { number: 801, position: Some(index) }),
        _ => Err(given.unknown()),
    }
}

/// The column at every offset; every second column runs backwards, so that the tool goes to and fro.
fn parallel(given: &Given<'_>, offsets: &[Vec3]) -> Result<Geometry, DefinitionError> {
    let column = linear_points(given, 1)?;
    if (column.len() * offsets.len()) as f64 > MOST_POINTS {
        return Err(DefinitionError::Special { number: 802, position: None });
    }
    let mut points = Vec::with_capacity(column.len() * offsets.len());
    for (index, offset) in offsets.iter().enumerate() {
        let shifted = column.iter().map(|point| point + offset);
        if index % 2 == 0 {
            points.extend(shifted);
        } else {
            points.extend(shifted.rev());
        }
    }
    Ok(pattern(Arrangement::Parallel, points, column.len()))
}

fn random(given: &Given<'_>) -> Result<Geometry, DefinitionError> {
    let mut points = Vec::new();
    for index in 1..given.count() {
        match given.geometry(index)? {
            Geometry::Pattern(part) => points.extend(part.points.iter().copied()),
            _ => points.push(given.place(index)?),
        }
        if points.len() as f64 > MOST_POINTS {
            return Err(DefinitionError::Special { number: 802, position: Some(index) });
        }
    }
    let column = points.len();
    Ok(pattern(Arrangement::Random, points, column))
}
