//! Defining conditions over random configurations.

mod support;

use apt_geometry::Vec3;
use apt_geometry::canonical::matrix::CoordinatePlane;
use apt_geometry::canonical::{Cylinder, Geometry, GeometryKind, Interval, Matrix, Plane, TabulatedCylinder};
use apt_geometry::definition::{
    Argument, ArgumentKind, DefinitionContext, DefinitionError, Modifier, define, formats, type_of_next,
};
use proptest::prelude::*;
use support::Session;

const TOLERANCE: f64 = 1e-9;

fn run(kind: GeometryKind, arguments: &[Argument]) -> Result<Geometry, DefinitionError> {
    define(kind, arguments, &DefinitionContext::standard())
}

fn word(modifier: Modifier) -> Argument {
    Argument::Modifier(modifier)
}

fn entity(geometry: impl Into<Geometry>) -> Argument {
    Argument::Geometry(geometry.into())
}

fn point(at: [f64; 3]) -> Argument {
    Argument::Geometry(Geometry::Point(Vec3::from(at)))
}

fn circle(at: [f64; 3]) -> (Cylinder, Argument) {
    let circle = Cylinder::circle(at[0], at[1], at[2]);
    (circle, Argument::Geometry(Geometry::Circle(circle)))
}

fn line(from: [f64; 3], to: [f64; 3]) -> Option<Plane> {
    match run(GeometryKind::Line, &[point(from), point(to)]) {
        Ok(Geometry::Line(line)) => Some(line),
        _ => None,
    }
}

fn place() -> impl Strategy<Value = [f64; 3]> {
    [-20.0..20.0f64, -20.0..20.0, -20.0..20.0]
}

fn round() -> impl Strategy<Value = [f64; 3]> {
    [-20.0..20.0f64, -20.0..20.0, 0.1..15.0]
}

fn side() -> impl Strategy<Value = Modifier> {
    prop_oneof![Just(Modifier::Left), Just(Modifier::Right)]
}

fn which() -> impl Strategy<Value = Modifier> {
    prop_oneof![
        Just(Modifier::XLarge),
        Just(Modifier::XSmall),
        Just(Modifier::YLarge),
        Just(Modifier::YSmall)
    ]
}

/// Height of an interval's cubic over its chord.
fn height(interval: &Interval, s: f64) -> f64 {
    s * (s - interval.length) * (interval.a * (s + interval.length) + interval.b)
}

/// Directions of the curve at the start and at the end of every interval, in the (u,v) plane.
fn end_directions(surface: &TabulatedCylinder) -> Vec<(f64, f64)> {
    let ends = surface.intervals.iter().skip(1).map(|next| [next.u, next.v]).chain([surface.last]);
    surface
        .intervals
        .iter()
        .zip(ends)
        .map(|(interval, end)| {
            let chord = (end[1] - interval.v).atan2(end[0] - interval.u);
            let l = interval.length;
            let start = -(interval.a * l + interval.b) * l;
            let finish = (2.0 * interval.a * l + interval.b) * l;
            (chord + start.atan(), chord + finish.atan())
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn a_tangent_touches_both_circles_on_the_named_sides(first in round(), second in round(), sides in [side(), side()]) {
        let ((first, a), (second, b)) = (circle(first), circle(second));
        let arguments = [word(sides[0]), word(Modifier::TangentTo), a, word(sides[1]), word(Modifier::TangentTo), b];
        if let Ok(Geometry::Line(line)) = run(GeometryKind::Line, &arguments) {
            let along = (second.point - first.point).normalize();
            let left = Vec3::new(-along.y, along.x, 0.0);
            for (circle, side) in [(first, sides[0]), (second, sides[1])] {
                let distance = line.signed_distance(&circle.point);
                prop_assert!((distance.abs() - circle.radius).abs() < TOLERANCE * 100.0);
                let contact = line.project(&circle.point) - circle.point;
                prop_assert!((contact.dot(&left) > -TOLERANCE) == (side == Modifier::Left) || contact.dot(&left).abs() < 1e-6);
            }
        } else {
            let apart = (second.point - first.point).norm();
            let reach = if sides[0] == sides[1] { (first.radius - second.radius).abs() } else { first.radius + second.radius };
            prop_assert!(apart < reach);
        }
    }

    #[test]
    fn a_line_meets_a_circle_on_both(from in place(), to in place(), round in round(), which in which()) {
        prop_assume!((from[0] - to[0]).hypot(from[1] - to[1]) > 0.1);
        let Some(line) = line(from, to) else { return Err(TestCaseError::fail("a line")) };
        let (circle, argument) = circle(round);
        let arguments = [word(which), word(Modifier::IntersectionOf), entity(Geometry::Line(line)), argument];
        match run(GeometryKind::Point, &arguments) {
            Ok(Geometry::Point(found)) => {
                prop_assert!(line.signed_distance(&found).abs() < TOLERANCE * 10.0);
                let gap = line.signed_distance(&circle.point).abs() - circle.radius;
                if gap.abs() > 1e-4 {
                    prop_assert!(circle.signed_distance(&found).abs() < 1e-7);
                }
            }
            Ok(_) => prop_assert!(false, "not a point"),
            Err(_) => prop_assert!(line.signed_distance(&circle.point).abs() > circle.radius - 1e-4 || line.normal.x.abs().min(line.normal.y.abs()) < 1e-5),
        }
    }

    #[test]
    fn a_circle_in_a_corner_touches_both_lines(points in [place(), place(), place(), place()], radius in 0.1..9.0f64, selectors in [which(), which()]) {
        let (Some(first), Some(second)) = (line(points[0], points[1]), line(points[2], points[3])) else { return Ok(()) };
        let arguments = [
            word(selectors[0]), entity(Geometry::Line(first)), word(selectors[1]), entity(Geometry::Line(second)),
            word(Modifier::Radius), Argument::Scalar(radius),
        ];
        if let Ok(Geometry::Circle(found)) = run(GeometryKind::Circle, &arguments) {
            let size = found.point.norm().max(1.0);
            for (line, selector) in [(first, selectors[0]), (second, selectors[1])] {
                prop_assert!((line.signed_distance(&found.point).abs() - radius).abs() < TOLERANCE * size);
                let away = found.point - line.project(&found.point);
                let right = match selector {
                    Modifier::XLarge => away.x > 0.0,
                    Modifier::XSmall => away.x < 0.0,
                    Modifier::YLarge => away.y > 0.0,
                    _ => away.y < 0.0,
                };
                prop_assert!(right);
            }
        }
    }

    #[test]
    fn circles_planes_and_spheres_go_through_their_points(points in [place(), place(), place(), place()]) {
        let arguments: Vec<Argument> = points.iter().map(|at| point(*at)).collect();
        let places: Vec<Vec3> = points.iter().map(|at| Vec3::from(*at)).collect();
        if let Ok(Geometry::Circle(found)) = run(GeometryKind::Circle, &arguments[..3]) {
            for place in &places[..3] {
                prop_assert!(found.signed_distance(place).abs() < TOLERANCE * found.radius.max(1.0));
            }
        }
        if let Ok(Geometry::Plane(found)) = run(GeometryKind::Plane, &arguments[..3]) {
            for place in &places[..3] {
                prop_assert!(found.signed_distance(place).abs() < 1e-8);
            }
            prop_assert!((found.normal.norm() - 1.0).abs() < 1e-14);
        }
        if let Ok(Geometry::Sphere(found)) = run(GeometryKind::Sphere, &arguments) {
            for place in &places {
                prop_assert!(found.signed_distance(place).abs() < 1e-8 * found.radius.max(1.0));
            }
        }
    }

    #[test]
    fn a_conic_goes_through_its_five_points(points in [place(), place(), place(), place(), place()]) {
        let mut arguments = vec![word(Modifier::FivePoints)];
        arguments.extend(points.iter().map(|at| point(*at)));
        if let Ok(Geometry::LoftConic(found)) = run(GeometryKind::LoftConic, &arguments) {
            for at in points {
                let (value, size) = found.value_with_size(&Vec3::new(at[0], at[1], 0.0));
                prop_assert!(value.abs() < TOLERANCE * size);
            }
        }
    }

    /// Definitions of space commute with moves: what is defined from moved parts is the moved definition.
    #[test]
    fn definitions_of_space_move_with_their_parts(
        points in [place(), place(), place(), place()], degrees in [-180.0..180.0f64, -180.0..180.0], shift in place(),
    ) {
        let matrix = Matrix::translation(Vec3::from(shift))
            .multiply(&Matrix::rotation(CoordinatePlane::Zx, degrees[0]))
            .multiply(&Matrix::rotation(CoordinatePlane::Xy, degrees[1]));
        let parts: Vec<Geometry> = points.iter().map(|at| Geometry::Point(Vec3::from(*at))).collect();
        let moved: Vec<Geometry> = parts.iter().map(|part| part.transform(&matrix).expect("a point moves")).collect();
        for (kind, count) in [(GeometryKind::Plane, 3), (GeometryKind::Sphere, 4), (GeometryKind::Vector, 2)] {
            let of = |parts: &[Geometry]| {
                let arguments: Vec<Argument> = parts[..count].iter().cloned().map(Argument::Geometry).collect();
                run(kind, &arguments)
            };
            if let (Ok(before), Ok(after)) = (of(&parts), of(&moved)) {
                let expected = before.transform(&matrix).expect("a rigid move").canonical_values();
                let size = expected.iter().fold(1.0f64, |most, value| most.max(value.abs()));
                prop_assert!(support::difference(&after.canonical_values(), &expected) < 1e-7 * size);
            }
        }
    }

    /// Curves pass through their points, have no corner (but FOURPT may), and a spline has no jump of curvature.
    #[test]
    fn tabulated_cylinders_interpolate(steps in prop::collection::vec((0.5..3.0f64, -1.0..1.0f64), 4..9), option in 0..3usize) {
        let option = [Modifier::Spline, Modifier::TwoPoint, Modifier::FourPoint][option];
        let mut arguments = vec![word(Modifier::NoZ), word(option)];
        let (mut u, mut v) = (0.0, 0.0);
        let mut places = Vec::new();
        for (du, dv) in steps {
            places.push([u, v]);
            arguments.extend([Argument::Scalar(u), Argument::Scalar(v)]);
            u += du;
            v += dv;
        }
        let Geometry::TabulatedCylinder(surface) = run(GeometryKind::TabulatedCylinder, &arguments).expect("a curve") else {
            return Err(TestCaseError::fail("not a tabcyl"));
        };
        prop_assert_eq!(surface.intervals.len(), places.len() + 1);
        for (interval, place) in surface.intervals[1..].iter().zip(&places) {
            prop_assert_eq!([interval.u, interval.v], *place);
        }
        for interval in &surface.intervals {
            for part in 0..=20 {
                let relative = height(interval, interval.length * f64::from(part) / 20.0) / interval.length;
                prop_assert!(relative <= interval.maximum + 1e-9 && relative >= interval.minimum - 1e-9);
            }
        }
        let directions = end_directions(&surface);
        if option != Modifier::FourPoint {
            for pair in directions.windows(2) {
                prop_assert!((pair[0].1 - pair[1].0).sin().abs() < 1e-9);
            }
        }
    }

    /// Whatever is given, the answer is a geometry of finite numbers or an error.
    #[test]
    fn nothing_panics(kind in 0..18usize, choices in prop::collection::vec((0..12usize, 0..80usize, -1e3..1e3f64), 0..9)) {
        let kinds: Vec<GeometryKind> = GeometryKind::all().collect();
        let pool = pool();
        let kind = kinds[kind];
        let mut arguments: Vec<Argument> = Vec::new();
        for (turn, pick, value) in choices {
            let given: Vec<ArgumentKind> = arguments.iter().map(Argument::kind).collect();
            let next = type_of_next(kind, &given);
            let wanted = next.get(pick % next.len().max(1));
            arguments.push(match wanted {
                _ if turn == 0 => Argument::Empty,
                _ if turn == 1 => Argument::Scalar([0.0, f64::NAN, f64::INFINITY, 1e300, -1e-300][pick % 5]),
                Some(ArgumentKind::Modifier(modifier)) => word(*modifier),
                Some(ArgumentKind::Geometry(wanted)) => pool
                    .iter()
                    .find(|geometry| geometry.kind() == *wanted)
                    .map_or(Argument::Scalar(value), |geometry| Argument::Geometry(geometry.clone())),
                _ => Argument::Scalar(value),
            });
        }
        if let Ok(found) = run(kind, &arguments) {
            prop_assert!(found.canonical_values().iter().all(|value| value.is_finite()));
        }
    }
}

/// One entity of every type that definitions take.
fn pool() -> Vec<Geometry> {
    let mut session = Session::new();
    [
        "A=POINT/1,2,3",
        "B=LINE/0,0,3,4",
        "C=PLANE/1,2,3,4",
        "D=CIRCLE/1,1,2",
        "E=VECTOR/1,1,0",
        "F=MATRIX/XYROT,30",
        "G=ELLIPS/CENTER,(0,0),3,2,10",
        "H=QADRIC/1,1,1,0,0,0,0,0,0,-9",
        "I=TABCYL/NOZ,SPLINE,0,0,1,1,2,1.5,3,1.2",
        "J=PATERN/LINEAR,(0,0),(6,3),4",
        "K=CYLNDR/1,2,3,0,0,1,2",
        "L=SPHERE/1,2,3,4",
    ]
    .iter()
    .map(|statement| session.run(statement).expect("well formed").expect("a definition"))
    .collect()
}

#[test]
fn completion_follows_the_formats() {
    use ArgumentKind::{Geometry as Entity, Modifier as Word, Scalar};
    let first = type_of_next(GeometryKind::Circle, &[]);
    assert!(
        first.contains(&Scalar)
            && first.contains(&Word(Modifier::Center))
            && first.contains(&Word(Modifier::Canon))
    );
    assert!(!first.contains(&Word(Modifier::Plus)));
    let after = type_of_next(GeometryKind::Circle, &[Word(Modifier::Center), Entity(GeometryKind::Point)]);
    assert_eq!(
        after,
        [
            Word(Modifier::Radius),
            Word(Modifier::TangentTo),
            Entity(GeometryKind::Point),
            Word(Modifier::Large),
            Word(Modifier::Small)
        ]
    );
    assert_eq!(type_of_next(GeometryKind::Circle, &[Word(Modifier::Plus)]), []);
    assert_eq!(
        type_of_next(GeometryKind::Cone, &[Entity(GeometryKind::Point), Entity(GeometryKind::Vector)]),
        [Scalar]
    );
    assert!(formats(GeometryKind::PolyConic).is_empty());
}

/// The spline leaves no jump of curvature that shows.
#[test]
fn a_spline_has_continuous_curvature() {
    let mut arguments = vec![word(Modifier::NoZ), word(Modifier::Spline)];
    for value in [0.0, 0.0, 1.0, 1.0, 2.0, 1.5, 3.0, 1.2, 4.0, 0.5, 5.5, 0.7] {
        arguments.push(Argument::Scalar(value));
    }
    let Ok(Geometry::TabulatedCylinder(surface)) = run(GeometryKind::TabulatedCylinder, &arguments) else {
        panic!("a curve")
    };
    let curvature = |interval: &Interval, s: f64| {
        let l = interval.length;
        let slope = 3.0 * interval.a * s * s + 2.0 * interval.b * s - (interval.a * l + interval.b) * l;
        (6.0 * interval.a * s + 2.0 * interval.b) / (1.0 + slope * slope).powf(1.5)
    };
    let inner = &surface.intervals[1..surface.intervals.len() - 1];
    for pair in inner.windows(2) {
        let jump = curvature(&pair[0], pair[0].length) - curvature(&pair[1], 0.0);
        assert!(jump.abs() < 2e-3, "jump of {jump}");
    }
    assert_eq!(inner[0].a, 0.0, "a free end is a parabola");
}
