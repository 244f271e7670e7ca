//! CIRCLE (language reference 4.4): always in the xy-plane, given z is dropped. A radius that is not positive is taken as
//! it is, as APT III does.

use super::choice::{Toward, X_OR_Y};
use super::format::{Format, Parameter};
use super::given::Given;
use super::solve::{self, PARALLEL_SINE, coincidence, distinct, turned_left};
use super::tabulated_tangent;
use super::{DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::{Cylinder, Geometry, GeometryKind, Plane};

use Parameter::{Entity, Scalar, Selector, Word};

const POINT: Parameter = Entity("point", &[GeometryKind::Point]);
const CENTER_POINT: Parameter = Entity("center", &[GeometryKind::Point]);
const LINE: Parameter = Entity("line", &[GeometryKind::Line]);
const CIRCLE: Parameter = Entity("circle", &[GeometryKind::Circle]);
const TABCYL: Parameter = Entity("tabcyl", &[GeometryKind::TabulatedCylinder]);
const CENTER: Parameter = Word(Modifier::Center);
const RADIUS: Parameter = Word(Modifier::Radius);
const TANTO: Parameter = Word(Modifier::TangentTo);
const WHICH: Parameter = Selector(X_OR_Y);
const IN_OR_OUT: Parameter = Selector(&[Modifier::In, Modifier::Out]);

pub(super) static FORMATS: &[Format] = &[
    Format {
        parameters: &[Scalar("x"), Scalar("y"), Scalar("radius")],
        help: "by center coordinates and radius",
        build: |given| circle(given.scalar(0)?, given.scalar(1)?, given.scalar(2)?),
    },
    Format {
        parameters: &[Scalar("x"), Scalar("y"), Scalar("z"), Scalar("radius")],
        help: "by center coordinates and radius; z is ignored",
        build: |given| circle(given.scalar(0)?, given.scalar(1)?, given.scalar(3)?),
    },
    Format {
        parameters: &[CENTER, CENTER_POINT, RADIUS, Scalar("radius")],
        help: "by center and radius",
        build: |given| about(&given.flat(1)?, given.scalar(3)?),
    },
    Format {
        parameters: &[CENTER, Scalar("x"), Scalar("y"), Scalar("z"), RADIUS, Scalar("radius")],
        help: "by center coordinates and radius; z is ignored",
        build: |given| circle(given.scalar(1)?, given.scalar(2)?, given.scalar(5)?),
    },
    Format {
        parameters: &[CENTER, CENTER_POINT, TANTO, LINE],
        help: "by center, tangent to a line",
        build: |given| {
            let center = given.flat(1)?;
            about(&center, given.line(3)?.signed_distance(&center).abs())
        },
    },
    Format {
        parameters: &[CENTER, CENTER_POINT, POINT],
        help: "by center and a point of the circle",
        build: |given| about(&given.flat(1)?, (given.flat(2)? - given.flat(1)?).norm()),
    },
    Format {
        parameters: &[POINT, POINT, POINT],
        help: "through three points",
        build: |given| through_three(&given.flat(0)?, &given.flat(1)?, &given.flat(2)?),
    },
    Format {
        parameters: &[CENTER, CENTER_POINT, Selector(&[Modifier::Large, Modifier::Small]), TANTO, CIRCLE],
        help: "by center, tangent to a circle: the larger or the smaller one",
        build: |given| {
            let (center, other) = (given.flat(1)?, given.circle(4)?);
            let distance = (other.point - center).norm();
            let large = given.modifier(2)? == Modifier::Large;
            about(&center, if large { distance + other.radius } else { (other.radius - distance).abs() })
        },
    },
    Format {
        parameters: &[WHICH, LINE, WHICH, LINE, RADIUS, Scalar("radius")],
        help: "tangent to two lines, the center on the named side of each",
        build: |given| {
            let radius = given.scalar(5)?;
            let center = solve::meet(&offset_line(given, 0, radius)?, &offset_line(given, 2, radius)?)?;
            about(&center, radius)
        },
    },
    Format {
        parameters: &[TANTO, LINE, WHICH, POINT, RADIUS, Scalar("radius")],
        help: "tangent to a line, through a point",
        build: line_and_point,
    },
    Format {
        parameters: &[WHICH, LINE, WHICH, IN_OR_OUT, CIRCLE, RADIUS, Scalar("radius")],
        help: "tangent to a line and a circle, inside or outside the circle",
        build: |given| {
            let radius = given.scalar(6)?;
            let other = given.circle(4)?;
            let line = offset_line(given, 0, radius)?;
            let reach = center_distance(given.modifier(3)?, &other, radius);
            about(&solve::line_circle(&line, &other.point, reach, toward(given, 2)?)?, radius)
        },
    },
    Format {
        parameters: &[WHICH, IN_OR_OUT, CIRCLE, IN_OR_OUT, CIRCLE, RADIUS, Scalar("radius")],
        help: "tangent to two circles, inside or outside each",
        build: two_circles,
    },
    Format {
        parameters: &[TANTO, LINE, WHICH, TABCYL, WHICH, POINT, RADIUS, Scalar("radius")],
        help: "tangent to a line and to a TABCYL near a point",
        build: |given| {
            let radius = given.positive(7)?;
            let sides = [toward(given, 2)?, toward(given, 4)?];
            let line = sides[0].orient_plane(given.line(1)?)?;
            let line = Plane { distance: line.distance + radius, ..line };
            let near = given.flat(5)?;
            about(
                &tabulated_tangent::rolling_center(given.tabulated(3)?, &line, sides[1], &near, radius)?,
                radius,
            )
        },
    },
];

fn circle(x: f64, y: f64, radius: f64) -> Result<Geometry, DefinitionError> {
    Ok(Geometry::Circle(Cylinder::circle(x, y, radius)))
}

fn about(center: &Vec3, radius: f64) -> Result<Geometry, DefinitionError> {
    circle(center.x, center.y, radius)
}

fn toward(given: &Given<'_>, index: usize) -> Result<Toward, DefinitionError> {
    Toward::from_word(given.modifier(index)?).ok_or_else(|| given.unknown())
}

/// The line after the selector at `selector`, moved by the radius to the side where the selector wants the centre.
fn offset_line(given: &Given<'_>, selector: usize, radius: f64) -> Result<Plane, DefinitionError> {
    let line = toward(given, selector)?.orient_plane(given.line(selector + 1)?)?;
    Ok(Plane { distance: line.distance + radius, ..line })
}

/// Distance between the centres of two circles that touch: inside (either in the other) or outside.
fn center_distance(word: Modifier, other: &Cylinder, radius: f64) -> f64 {
    if word == Modifier::In { (other.radius - radius).abs() } else { (other.radius + radius).abs() }
}

/// The centre lies on the bisectors; the sides are taken relative to the first point.
fn through_three(first: &Vec3, second: &Vec3, third: &Vec3) -> Result<Geometry, DefinitionError> {
    for (a, b) in [(first, second), (first, third), (second, third)] {
        distinct(a, b)?;
    }
    let (b, c) = (second - first, third - first);
    let area = b.x * c.y - b.y * c.x;
    if area.abs() <= PARALLEL_SINE * b.norm() * c.norm() {
        return Err(Impossible::Collinear.into());
    }
    let (bb, cc) = (b.norm_squared(), c.norm_squared());
    let from_first = Vec3::new(c.y * bb - b.y * cc, b.x * cc - c.x * bb, 0.0) / (2.0 * area);
    about(&(first + from_first), from_first.norm())
}

/// The circle lies on the side of the line where the point is; a point on the line leaves the side to the selector.
fn line_and_point(given: &Given<'_>) -> Result<Geometry, DefinitionError> {
    let radius = given.positive(5)?;
    let (line, point, toward) = (given.line(1)?, given.flat(3)?, toward(given, 2)?);
    let distance = line.signed_distance(&point);
    if distance.abs() <= coincidence(radius) {
        let line = toward.orient_plane(line)?;
        return about(&(line.project(&point) + line.normal * radius), radius);
    }
    if distance.abs() > 2.0 * radius + coincidence(radius) {
        return Err(Impossible::RadiusTooSmall { radius, least: 0.5 * distance.abs() }.into());
    }
    let line = if distance > 0.0 { line } else { line.reversed() };
    let centers = Plane { distance: line.distance + radius, ..line };
    about(&solve::line_circle(&centers, &point, radius, toward)?, radius)
}

fn two_circles(given: &Given<'_>) -> Result<Geometry, DefinitionError> {
    let radius = given.scalar(6)?;
    let (first, second) = (given.circle(2)?, given.circle(4)?);
    let words = [given.modifier(1)?, given.modifier(3)?];
    let distances = [center_distance(words[0], &first, radius), center_distance(words[1], &second, radius)];
    let apart = (second.point - first.point).norm();
    let needed = apart - first.radius - second.radius;
    if words == [Modifier::Out, Modifier::Out] && 2.0 * radius < needed - coincidence(apart) {
        return Err(Impossible::RadiusTooSmall { radius, least: 0.5 * needed }.into());
    }
    let center = solve::circle_circle([&first.point, &second.point], distances, toward(given, 0)?)?;
    about(&center, radius)
}

/// Tangent direction at the middle one of three points on their circle, and at the first of them: used where curves
/// are made from points alone. `None` when points coincide.
pub(super) fn three_point_tangents(first: &Vec3, middle: &Vec3, last: &Vec3) -> Option<(Vec3, Vec3)> {
    let (to_middle, to_last) = (middle - first, last - middle);
    let (before, after) = (to_middle.norm_squared(), to_last.norm_squared());
    let at_middle = (to_middle * after + to_last * before).try_normalize(0.0)?;
    // The tangents at both ends of a chord make the same angle with it.
    let chord = to_middle.try_normalize(0.0)?;
    let (cosine, sine) = (chord.dot(&at_middle), turned_left(&chord).dot(&at_middle));
    Some((at_middle, chord * cosine - turned_left(&chord) * sine))
}
