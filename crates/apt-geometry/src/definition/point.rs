//! POINT (language reference 4.1).

use super::choice::{PLANES, Toward, X_OR_Y, ZERO_COMPONENT, coordinate_plane};
use super::format::{Format, Parameter};
use super::given::Given;
use super::solve::{self, coincidence};
use super::tabulated_tangent;
use super::{Argument, DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::matrix::sine_cosine_degrees;
use crate::canonical::{Geometry, GeometryKind, Plane, Quadric};

use Parameter::{Entity, Scalar, Selector, Word};

const LINE: Parameter = Entity("line", &[GeometryKind::Line]);
const PLANE: Parameter = Entity("plane", &[GeometryKind::Plane]);
const CIRCLE: Parameter = Entity("circle", &[GeometryKind::Circle]);
const CONIC: Parameter = Entity(
    "conic",
    &[
        GeometryKind::Ellipse,
        GeometryKind::Hyperbola,
        GeometryKind::GeneralConic,
        GeometryKind::LoftConic,
        GeometryKind::Quadric,
    ],
);
const TABCYL: Parameter = Entity("tabcyl", &[GeometryKind::TabulatedCylinder]);
const NEAR: Parameter = Entity("near point", &[GeometryKind::Point]);
const INTOF: Parameter = Word(Modifier::IntersectionOf);
const WHICH: Parameter = Selector(X_OR_Y);

/// Least last pivot of the equations of three planes, relative to the first (APT III).
const SINGULAR_PIVOT: f64 = 1e-5;

pub(super) static FORMATS: &[Format] = &[
    Format {
        parameters: &[Scalar("x"), Scalar("y")],
        help: "by x and y; z from ZSURF",
        build: |given| given.lifted(given.scalar(0)?, given.scalar(1)?),
    },
    Format {
        parameters: &[Scalar("x"), Scalar("y"), Scalar("z")],
        help: "by its coordinates",
        build: |given| Ok(Geometry::Point(given.triple(0)?)),
    },
    Format {
        parameters: &[INTOF, LINE, LINE],
        help: "intersection of two lines; z from ZSURF",
        build: |given| {
            let place = solve::meet(&given.line(1)?, &given.line(2)?)?;
            given.lifted(place.x, place.y)
        },
    },
    Format {
        parameters: &[WHICH, INTOF, LINE, CIRCLE],
        help: "intersection of a line and a circle; z from ZSURF",
        build: |given| {
            let circle = given.circle(3)?;
            let place = solve::line_circle(&given.line(2)?, &circle.point, circle.radius, toward(given, 0)?)?;
            given.lifted(place.x, place.y)
        },
    },
    Format {
        parameters: &[WHICH, INTOF, CIRCLE, CIRCLE],
        help: "intersection of two circles; z from ZSURF",
        build: |given| {
            let (first, second) = (given.circle(2)?, given.circle(3)?);
            let place = solve::circle_circle(
                [&first.point, &second.point],
                [first.radius, second.radius],
                toward(given, 0)?,
            )?;
            given.lifted(place.x, place.y)
        },
    },
    Format {
        parameters: &[CIRCLE, Word(Modifier::AtAngle), Scalar("angle")],
        help: "on a circle at an angle from the x axis; z from ZSURF",
        build: |given| {
            let circle = given.circle(0)?;
            let (sine, cosine) = sine_cosine_degrees(given.scalar(2)?);
            given.lifted(circle.point.x + circle.radius * cosine, circle.point.y + circle.radius * sine)
        },
    },
    Format {
        parameters: &[Word(Modifier::Center), CIRCLE],
        help: "center of a circle; z from ZSURF",
        build: |given| {
            let circle = given.circle(1)?;
            given.lifted(circle.point.x, circle.point.y)
        },
    },
    Format {
        parameters: &[WHICH, INTOF, LINE, CONIC],
        help: "intersection of a line and a conic; z from ZSURF",
        build: |given| {
            let place = line_conic(&given.line(2)?, &conic(given, 3)?, toward(given, 0)?)?;
            given.lifted(place.x, place.y)
        },
    },
    Format {
        parameters: &[INTOF, PLANE, PLANE, PLANE],
        help: "intersection of three planes",
        build: |given| {
            let planes = [given.plane(1)?, given.plane(2)?, given.plane(3)?];
            Ok(Geometry::Point(three_planes(&planes)?))
        },
    },
    Format {
        parameters: &[
            Selector(&[Modifier::RadiusAngle]),
            Selector(PLANES),
            Scalar("radius"),
            Scalar("angle"),
        ],
        help: "by radius and angle in a coordinate plane",
        build: |given| polar(given, 2, 3),
    },
    Format {
        parameters: &[
            Selector(&[Modifier::AngleRadius]),
            Selector(PLANES),
            Scalar("angle"),
            Scalar("radius"),
        ],
        help: "by angle and radius in a coordinate plane",
        build: |given| polar(given, 3, 2),
    },
    Format {
        parameters: &[INTOF, LINE, TABCYL, NEAR],
        help: "intersection of a line and a TABCYL nearest to a point; z from ZSURF",
        build: |given| {
            let place =
                tabulated_tangent::intersection(given.tabulated(2)?, &given.line(1)?, &given.flat(3)?)?;
            given.lifted(place.x, place.y)
        },
    },
    Format {
        parameters: &[Entity("pattern", &[GeometryKind::Pattern]), Scalar("number")],
        help: "a point of a pattern, counted in definition order",
        build: pattern_point,
    },
];

fn toward(given: &Given<'_>, index: usize) -> Result<Toward, DefinitionError> {
    Toward::from_word(given.modifier(index)?).ok_or_else(|| given.unknown())
}

fn conic(given: &Given<'_>, index: usize) -> Result<Quadric, DefinitionError> {
    match given.geometry(index)? {
        Geometry::Ellipse(quadric)
        | Geometry::Hyperbola(quadric)
        | Geometry::GeneralConic(quadric)
        | Geometry::LoftConic(quadric)
        | Geometry::Quadric(quadric) => Ok(*quadric),
        _ => Err(given.unknown()),
    }
}

/// The place where a line meets a conic; of two the one farther `toward`. Where the word does not tell them apart the one
/// with the positive root is taken, as APT III does.
fn line_conic(line: &Plane, conic: &Quadric, toward: Toward) -> Result<Vec3, Impossible> {
    Ok(match line_conic_places(line, conic)? {
        (first, Some(second)) if toward.component(&second) > toward.component(&first) => second,
        (first, _) => first,
    })
}

/// The word of `POINT/word,INTOF,line,conic` when it does not tell the two intersections apart: they lie side by side as it
/// looks.
pub(super) fn idle_selector(arguments: &[Argument]) -> Option<Modifier> {
    let [
        Argument::Modifier(word),
        Argument::Modifier(Modifier::IntersectionOf),
        Argument::Geometry(Geometry::Line(line) | Geometry::Plane(line)),
        Argument::Geometry(
            Geometry::Ellipse(conic)
            | Geometry::Hyperbola(conic)
            | Geometry::GeneralConic(conic)
            | Geometry::LoftConic(conic)
            | Geometry::Quadric(conic),
        ),
    ] = arguments
    else {
        return None;
    };
    let toward = Toward::from_word(*word)?;
    let (first, second) = line_conic_places(line, conic).ok()?;
    let apart = (second? - first).try_normalize(0.0)?;
    (toward.component(&apart).abs() <= ZERO_COMPONENT).then_some(*word)
}

/// The two places where a line of the xy-plane meets the section of a quadric with that plane, that with the positive root
/// first; or the only one.
fn line_conic_places(line: &Plane, conic: &Quadric) -> Result<(Vec3, Option<Vec3>), Impossible> {
    let direction = line.line_direction();
    let foot = line.normal * line.distance;
    // On foot + t·direction the equation is square·t² + 2·half·t + constant.
    let [a, b, _, _, _, _, h, _, _, _] = conic.coefficients;
    let square =
        a * direction.x * direction.x + 2.0 * h * direction.x * direction.y + b * direction.y * direction.y;
    let half = 0.5 * conic.gradient(&foot).dot(&direction);
    let (constant, size) = conic.value_with_size(&foot);
    let curvature = a.abs().max(b.abs()).max(h.abs());
    if square.abs() <= f64::EPSILON * curvature {
        // The line is parallel to an asymptote or to the axis of a parabola: one intersection.
        if half.abs() <= f64::EPSILON * size.max(curvature) {
            return Err(Impossible::Parallel);
        }
        return Ok((foot - direction * (constant / (2.0 * half)), None));
    }
    let middle = foot - direction * (half / square);
    let reach = half * half - square * constant;
    // Where the line only nears the curve, the distance is the value over the gradient.
    let gap = conic.value(&middle).abs() / conic.gradient(&middle).norm();
    if gap <= coincidence(middle.amax().max((size / curvature).sqrt())) {
        return Ok((middle, None));
    }
    if reach < 0.0 {
        return Err(Impossible::NoIntersection { gap });
    }
    // The root that does not cancel, and the other from the product of both; in the order of −half ± √reach.
    let root = half + reach.sqrt().copysign(half);
    let mut stations = if root == 0.0 { [0.0, 0.0] } else { [-constant / root, -root / square] };
    if root < 0.0 {
        stations.swap(0, 1);
    }
    let [first, second] = stations.map(|station| foot + direction * station);
    Ok((first, Some(second)))
}

fn three_planes(planes: &[Plane; 3]) -> Result<Vec3, Impossible> {
    let [a, b, c] = planes;
    let volume = a.normal.dot(&b.normal.cross(&c.normal));
    if volume.abs() <= SINGULAR_PIVOT {
        return Err(Impossible::Singular);
    }
    let normals =
        nalgebra::Matrix3::from_rows(&[a.normal.transpose(), b.normal.transpose(), c.normal.transpose()]);
    let distances = Vec3::new(a.distance, b.distance, c.distance);
    normals.lu().solve(&distances).ok_or(Impossible::Singular)
}

fn polar(given: &Given<'_>, radius: usize, angle: usize) -> Result<Geometry, DefinitionError> {
    let plane = coordinate_plane(given.modifier(1)?).ok_or_else(|| given.unknown())?;
    let (sine, cosine) = sine_cosine_degrees(given.scalar(angle)?);
    let radius = given.scalar(radius)?;
    let [first, second, _] = plane.axes();
    let mut place = Vec3::zeros();
    place[first] = radius * cosine;
    place[second] = radius * sine;
    Ok(Geometry::Point(place))
}

/// APT III cuts fractions off, as it does with subscripts.
fn pattern_point(given: &Given<'_>) -> Result<Geometry, DefinitionError> {
    let Geometry::Pattern(pattern) = given.geometry(0)? else { return Err(given.unknown()) };
    let number = given.scalar(1)?.trunc();
    let outside = DefinitionError::Special { number: 154, position: Some(1) };
    if number < 1.0 || number > pattern.points.len() as f64 {
        return Err(outside);
    }
    pattern.points.get(number as usize - 1).map(|point| Geometry::Point(*point)).ok_or(outside)
}
