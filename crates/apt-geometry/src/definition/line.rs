//! LINE (language reference 4.2). The sign of the normal belongs to the format.

use super::choice::{Toward, X_OR_Y};
use super::format::{Format, Parameter};
use super::given::Given;
use super::solve::{PARALLEL_SINE, coincidence, distinct, turned_left};
use super::tabulated_tangent;
use super::{DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::matrix::sine_cosine_degrees;
use crate::canonical::{Geometry, GeometryKind, Plane};

use Parameter::{Entity, Scalar, Selector, Word};

const POINT: Parameter = Entity("point", &[GeometryKind::Point]);
const LINE: Parameter = Entity("line", &[GeometryKind::Line]);
const CIRCLE: Parameter = Entity("circle", &[GeometryKind::Circle]);
const PLANE: Parameter = Entity("plane", &[GeometryKind::Plane]);
const TABCYL: Parameter = Entity("tabcyl", &[GeometryKind::TabulatedCylinder]);
const NEAR: Parameter = Entity("near point", &[GeometryKind::Point]);
const AXIS: Parameter = Selector(&[Modifier::XAxis, Modifier::YAxis]);
const SIDE: Parameter = Selector(&[Modifier::Right, Modifier::Left]);
const TANTO: Parameter = Word(Modifier::TangentTo);
const ATANGL: Parameter = Word(Modifier::AtAngle);
const SLOPE: Parameter = Word(Modifier::Slope);
const INTERC: Parameter = Word(Modifier::Intercept);

pub(super) static FORMATS: &[Format] = &[
    Format {
        parameters: &[Scalar("x1"), Scalar("y1"), Scalar("x2"), Scalar("y2")],
        help: "through two points by x and y",
        build: |given| {
            let first = Vec3::new(given.scalar(0)?, given.scalar(1)?, 0.0);
            through(&first, &Vec3::new(given.scalar(2)?, given.scalar(3)?, 0.0))
        },
    },
    Format {
        parameters: &[Scalar("x1"), Scalar("y1"), Scalar("z1"), Scalar("x2"), Scalar("y2"), Scalar("z2")],
        help: "through two points by coordinates; z is ignored",
        build: |given| {
            let first = Vec3::new(given.scalar(0)?, given.scalar(1)?, 0.0);
            through(&first, &Vec3::new(given.scalar(3)?, given.scalar(4)?, 0.0))
        },
    },
    Format {
        parameters: &[POINT, POINT],
        help: "through two points",
        build: |given| through(&given.flat(0)?, &given.flat(1)?),
    },
    Format {
        parameters: &[POINT, SIDE, TANTO, CIRCLE],
        help: "through a point, tangent to a circle on the side seen from the point",
        build: |given| {
            let circle = given.circle(3)?;
            let side = given.modifier(1)?;
            tangent([&given.flat(0)?, &circle.point], [0.0, circle.radius], [side, side])
        },
    },
    Format {
        parameters: &[SIDE, TANTO, CIRCLE, SIDE, TANTO, CIRCLE],
        help: "tangent to two circles on the sides seen from the first circle",
        build: |given| {
            let (first, second) = (given.circle(2)?, given.circle(5)?);
            tangent(
                [&first.point, &second.point],
                [first.radius, second.radius],
                [given.modifier(0)?, given.modifier(3)?],
            )
        },
    },
    Format {
        parameters: &[POINT, ATANGL, Scalar("angle")],
        help: "through a point at an angle with the x axis",
        build: |given| inclined(&given.flat(0)?, &Vec3::y(), turn_of_angle(given.scalar(2)?)),
    },
    Format {
        parameters: &[POINT, ATANGL, Scalar("angle"), AXIS],
        help: "through a point at an angle with an axis",
        build: |given| inclined(&given.flat(0)?, &axis_normal(given, 3)?, turn_of_angle(given.scalar(2)?)),
    },
    Format {
        parameters: &[POINT, ATANGL, Scalar("angle"), LINE],
        help: "through a point at an angle with a line",
        build: |given| inclined(&given.flat(0)?, &given.line(3)?.normal, turn_of_angle(given.scalar(2)?)),
    },
    Format {
        parameters: &[POINT, SLOPE, Scalar("slope")],
        help: "through a point with a slope against the x axis",
        build: |given| inclined(&given.flat(0)?, &Vec3::y(), turn_of_slope(given.scalar(2)?)),
    },
    Format {
        parameters: &[POINT, SLOPE, Scalar("slope"), AXIS],
        help: "through a point with a slope against an axis",
        build: |given| inclined(&given.flat(0)?, &axis_normal(given, 3)?, turn_of_slope(given.scalar(2)?)),
    },
    Format {
        parameters: &[POINT, SLOPE, Scalar("slope"), LINE],
        help: "through a point with a slope against a line",
        build: |given| inclined(&given.flat(0)?, &given.line(3)?.normal, turn_of_slope(given.scalar(2)?)),
    },
    Format {
        parameters: &[AXIS],
        help: "the x axis or the y axis",
        build: |given| Ok(Geometry::Line(Plane { normal: axis_normal(given, 0)?, distance: 0.0 })),
    },
    Format {
        parameters: &[POINT, Word(Modifier::Parallel), LINE],
        help: "through a point, parallel to a line",
        build: |given| inclined(&given.flat(0)?, &given.line(2)?.normal, (0.0, 1.0)),
    },
    Format {
        parameters: &[POINT, Word(Modifier::PerpendicularTo), LINE],
        help: "through a point, perpendicular to a line",
        build: |given| inclined(&given.flat(0)?, &given.line(2)?.normal, (1.0, 0.0)),
    },
    Format {
        parameters: &[Word(Modifier::Parallel), LINE, Selector(X_OR_Y), Scalar("distance")],
        help: "parallel to a line at a distance on a side",
        build: |given| {
            let toward = Toward::from_word(given.modifier(2)?).ok_or_else(|| given.unknown())?;
            let line = toward.orient_plane(given.line(1)?)?;
            Ok(Geometry::Line(Plane { distance: line.distance + given.scalar(3)?, ..line }))
        },
    },
    Format {
        parameters: &[Word(Modifier::IntersectionOf), PLANE, PLANE],
        help: "intersection of two planes, seen along z",
        build: |given| projected_intersection(&given.plane(1)?, &given.plane(2)?),
    },
    Format {
        parameters: &[SLOPE, Scalar("slope"), INTERC, Scalar("intercept")],
        help: "by slope and y intercept",
        build: |given| intercepted(given, turn_of_slope(given.scalar(1)?), None, 3),
    },
    Format {
        parameters: &[SLOPE, Scalar("slope"), INTERC, AXIS, Scalar("intercept")],
        help: "by slope and intercept on an axis",
        build: |given| intercepted(given, turn_of_slope(given.scalar(1)?), Some(3), 4),
    },
    Format {
        parameters: &[ATANGL, Scalar("angle"), INTERC, Scalar("intercept")],
        help: "by angle and y intercept",
        build: |given| intercepted(given, turn_of_angle(given.scalar(1)?), None, 3),
    },
    Format {
        parameters: &[ATANGL, Scalar("angle"), INTERC, AXIS, Scalar("intercept")],
        help: "by angle and intercept on an axis",
        build: |given| intercepted(given, turn_of_angle(given.scalar(1)?), Some(3), 4),
    },
    Format {
        parameters: &[POINT, TANTO, TABCYL, NEAR],
        help: "through a point, tangent to a TABCYL near a second point",
        build: |given| {
            let (from, near) = (given.flat(0)?, given.flat(3)?);
            Ok(Geometry::Line(tabulated_tangent::tangent_line(given.tabulated(2)?, &from, &near)?))
        },
    },
    Format {
        parameters: &[POINT, Word(Modifier::PerpendicularTo), TABCYL, NEAR],
        help: "through a point, perpendicular to a TABCYL near a second point",
        build: |given| {
            let (from, near) = (given.flat(0)?, given.flat(3)?);
            Ok(Geometry::Line(tabulated_tangent::normal_line(given.tabulated(2)?, &from, &near)?))
        },
    },
];

/// Sine and cosine of a turn.
type Turn = (f64, f64);

fn turn_of_angle(degrees: f64) -> Turn {
    sine_cosine_degrees(degrees)
}

fn turn_of_slope(slope: f64) -> Turn {
    let length = slope.hypot(1.0);
    (slope / length, 1.0 / length)
}

fn axis_normal(given: &Given<'_>, index: usize) -> Result<Vec3, DefinitionError> {
    match given.modifier(index)? {
        Modifier::XAxis => Ok(Vec3::y()),
        Modifier::YAxis => Ok(Vec3::x()),
        _ => Err(given.unknown()),
    }
}

/// The normal is to the right of the direction from the first point to the second.
fn through(first: &Vec3, second: &Vec3) -> Result<Geometry, DefinitionError> {
    distinct(first, second)?;
    let along = (second - first).normalize();
    let normal = Vec3::new(along.y, -along.x, 0.0);
    // The nearer point gives the distance with the fewer lost digits.
    let seat = if first.norm_squared() <= second.norm_squared() { first } else { second };
    Ok(Geometry::Line(Plane { normal, distance: normal.dot(seat) }))
}

/// The line through `point` whose normal is `normal` after a turn counter-clockwise.
fn inclined(point: &Vec3, normal: &Vec3, (sine, cosine): Turn) -> Result<Geometry, DefinitionError> {
    let turned = normal * cosine + turned_left(normal) * sine;
    Plane::through(*point, turned).map(Geometry::Line).ok_or_else(|| Impossible::ZeroVector.into())
}

fn intercepted(
    given: &Given<'_>,
    turn: Turn,
    axis: Option<usize>,
    intercept: usize,
) -> Result<Geometry, DefinitionError> {
    let intercept = given.scalar(intercept)?;
    let on_x = axis.and_then(|index| given.word_at(index)) == Some(Modifier::XAxis);
    let point = if on_x { Vec3::new(intercept, 0.0, 0.0) } else { Vec3::new(0.0, intercept, 0.0) };
    inclined(&point, &Vec3::y(), turn)
}

/// The common tangent of two circles, of which the first may be a point. Sides are those on which the line passes the
/// circles, looking from the first centre to the second.
fn tangent(centers: [&Vec3; 2], radii: [f64; 2], sides: [Modifier; 2]) -> Result<Geometry, DefinitionError> {
    let between = centers[1] - centers[0];
    let distance = between.norm();
    let size = radii[0].max(radii[1]).max(distance);
    let same_side = sides[0] == sides[1];
    let reach = if same_side { radii[1] - radii[0] } else { radii[1] + radii[0] };
    if distance <= coincidence(size) {
        return Err(Impossible::Coincident { distance }.into());
    }
    if reach.abs() > distance + coincidence(size) {
        let reach = reach.abs();
        let is_point = radii[0] == 0.0;
        let reason = if is_point {
            Impossible::InsideCircle { distance, radius: reach }
        } else {
            Impossible::CirclesTooNear { distance, needed: reach }
        };
        return Err(reason.into());
    }
    let along = between / distance;
    let cosine = (reach / distance).clamp(-1.0, 1.0);
    // 1 − cos² factored, or the tangent at a circle just touched loses half its digits.
    let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    let sine = if sides[1] == Modifier::Right { -sine } else { sine };
    let normal = along * cosine - turned_left(&along) * sine;
    Ok(Geometry::Line(Plane { normal, distance: normal.dot(centers[1]) - radii[1] }))
}

/// Elimination of z from the equations of two planes.
fn projected_intersection(first: &Plane, second: &Plane) -> Result<Geometry, DefinitionError> {
    let (a, b) = (first, second);
    if a.normal.cross(&b.normal).norm() <= PARALLEL_SINE {
        return Err(Impossible::Parallel.into());
    }
    let eliminated = |of_a: f64, of_b: f64| of_a * b.normal.z - of_b * a.normal.z;
    let (x, y) = (eliminated(a.normal.x, b.normal.x), eliminated(a.normal.y, b.normal.y));
    // Seen along z the line is a point when both planes are parallel to z.
    if x.hypot(y) <= PARALLEL_SINE {
        return Err(Impossible::Parallel.into());
    }
    Plane::from_equation(x, y, 0.0, eliminated(a.distance, b.distance))
        .map(Geometry::Line)
        .ok_or_else(|| Impossible::Parallel.into())
}
