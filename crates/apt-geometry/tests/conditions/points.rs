//! POINT.

use std::sync::Arc;

use apt_geometry::Vec3;
use apt_geometry::canonical::{Arrangement, Cylinder, Geometry, GeometryKind, Pattern, Plane};
use apt_geometry::definition::{Argument, DefinitionContext, Impossible, Modifier, define};
use proptest::prelude::*;

use crate::figure::{
    Figure, Part, Setting, Turns, Verdict, direction, flat_setting, line, line_through, narrow,
    near_flat_setting, plane, point, quadric, setting, toward, travel, unit, which,
};
use crate::tabulated::wave;

/// Greatest length, in program units, that counts as touching (language reference 4.0).
pub(crate) const TOUCHING: f64 = 1e-5;
/// Component below which a selector does not decide.
pub(crate) const UNDECIDED: f64 = 1.1e-6;

pub(crate) fn circle(center: Vec3, radius: f64) -> Part {
    Part::Entity(Geometry::Circle(Cylinder::circle(center.x, center.y, radius)))
}

fn found(geometry: &Geometry) -> Vec3 {
    match geometry {
        Geometry::Point(place) => *place,
        other => panic!("{other:?} is no point"),
    }
}

/// Fails when a place is not on a line.
fn on_line(setting: &Setting, of: &Plane, place: &Vec3) -> Verdict {
    setting.holds("on the line", of.signed_distance(place), place)
}

/// Fails when a place is not on a circle; where line or circle only touch it, the language allows more.
fn on_circle(setting: &Setting, center: &Vec3, radius: f64, touches: bool, place: &Vec3) -> Verdict {
    let error = (place - center).norm() - radius;
    if touches && error.abs() <= TOUCHING * 1.01 {
        return Ok(());
    }
    setting.holds("on the circle", error, place)
}

proptest! {
    #![proptest_config(crate::figure::config())]

    #[test]
    fn coordinates(setting in setting(), at in unit(), slope in unit()) {
        let place = setting.place(at);
        let context = DefinitionContext { z_surface: Plane::from_equation(slope[0], slope[1], 2.0, place.z).expect("a normal") };
        let scalars = [Argument::Scalar(place.x), Argument::Scalar(place.y), Argument::Scalar(place.z)];
        let lifted = found(&define(GeometryKind::Point, &scalars[..2], &context).expect("a point"));
        prop_assert_eq!([lifted.x, lifted.y], [place.x, place.y]);
        setting.holds("on ZSURF", context.z_surface.signed_distance(&lifted), &lifted)?;
        let given = found(&define(GeometryKind::Point, &scalars, &context).expect("a point"));
        prop_assert_eq!(given, place);
    }

    #[test]
    fn of_two_lines(setting in flat_setting(), at in unit(), angle in -180.0..180.0f64, narrow in narrow(), travel in travel()) {
        let place = setting.flat(at);
        let (first, second) = (line_through(&place, angle), line_through(&place, angle + 90.0 * narrow));
        let sine = first.normal.cross(&second.normal).norm();
        Figure::flat(GeometryKind::Point, setting, Turns::Flat, vec![Part::Word(Modifier::IntersectionOf), line(first), line(second)])
            .condition(sine.recip())
            .hold(travel, |reason| *reason == Impossible::Parallel && sine <= 1.01e-5, |geometry| {
                let place = found(geometry);
                on_line(&setting, &first, &place)?;
                on_line(&setting, &second, &place)
            })?;
    }

    #[test]
    fn of_line_and_circle(
        setting in flat_setting(), at in unit(), radius in 0.1..1.0f64, angle in -180.0..180.0f64, inset in narrow(), which in which(),
        travel in travel(),
    ) {
        let (center, radius) = (setting.flat(at), setting.length(radius));
        // From through the centre to just touching, on either side, and just missing.
        let offset = radius * (1.0 - inset.abs()) * inset.signum();
        let of = Plane { distance: direction(angle).dot(&center) + offset, ..line_through(&center, angle) };
        let offset = of.signed_distance(&center);
        let along = toward(which, &of.line_direction());
        let half = ((radius - offset) * (radius + offset)).max(0.0).sqrt();
        let touches = (offset.abs() - radius).abs() <= TOUCHING * 1.01;
        let parts = vec![Part::Word(which), Part::Word(Modifier::IntersectionOf), line(of), circle(center, radius)];
        let condition = (radius / half).powi(2).max(along.abs().recip());
        Figure::flat(GeometryKind::Point, setting, Turns::Quarter, parts).condition(condition).hold(
            travel,
            |reason| match reason {
                Impossible::Undecided { .. } => along.abs() <= UNDECIDED,
                Impossible::NoIntersection { gap } => *gap > 0.0 && offset.abs() > radius,
                _ => false,
            },
            |geometry| {
                let place = found(geometry);
                on_line(&setting, &of, &place)?;
                on_circle(&setting, &center, radius, touches, &place)?;
                let middle = of.project(&center);
                prop_assert!(touches || toward(which, &(place - middle)) > 0.0);
                Ok(())
            },
        )?;
    }

    #[test]
    fn of_two_circles(
        setting in flat_setting(), at in unit(), radii in [0.1..1.0f64, 0.1..1.0], angle in -180.0..180.0f64, inset in narrow(),
        which in which(), travel in travel(),
    ) {
        let (first, radii) = (setting.flat(at), radii.map(|radius| setting.length(radius)));
        let (least, most) = ((radii[0] - radii[1]).abs(), radii[0] + radii[1]);
        // Between touching inside and touching outside; near the one or the other.
        let part = if inset > 0.0 { inset } else { 1.0 + inset };
        let apart = least + (most - least) * part;
        let second = first + direction(angle) * apart;
        let apart = (second - first).norm();
        let across = toward(which, &direction(angle + 90.0));
        let tolerance = TOUCHING.min(1e-3 * radii[0].max(radii[1])) * 1.01;
        let touches = apart - least <= tolerance || most - apart <= tolerance;
        let condition = (setting.size / (apart - least)).max(setting.size / (most - apart)).max(across.abs().recip()).max(setting.size / apart);
        let parts = vec![Part::Word(which), Part::Word(Modifier::IntersectionOf), circle(first, radii[0]), circle(second, radii[1])];
        Figure::flat(GeometryKind::Point, setting, Turns::Quarter, parts).condition(condition).hold(
            travel,
            |reason| match reason {
                Impossible::Undecided { .. } => across.abs() <= UNDECIDED,
                Impossible::Coincident { .. } => apart <= tolerance,
                _ => false,
            },
            |geometry| {
                let place = found(geometry);
                on_circle(&setting, &first, radii[0], touches, &place)?;
                on_circle(&setting, &second, radii[1], touches, &place)?;
                prop_assert!(touches || toward(which, &direction(angle + 90.0)) * (place - first).dot(&direction(angle + 90.0)) > 0.0);
                Ok(())
            },
        )?;
    }

    #[test]
    fn on_a_circle_at_an_angle(setting in flat_setting(), at in unit(), radius in 0.1..1.0f64, angle in -720.0..720.0f64, travel in travel()) {
        let (center, radius) = (setting.flat(at), setting.length(radius));
        let parts = vec![circle(center, radius), Part::Word(Modifier::AtAngle), Part::Heading(angle)];
        Figure::flat(GeometryKind::Point, setting, Turns::Flat, parts).hold(travel, |_| false, |geometry| {
            let place = found(geometry);
            setting.holds("radius", (place - center).norm() - radius, &place)?;
            setting.holds("angle", (place - center).cross(&direction(angle)).z, &place)?;
            prop_assert!((place - center).dot(&direction(angle)) > 0.0);
            Ok(())
        })?;
    }

    #[test]
    fn center_of_a_circle(setting in flat_setting(), at in unit(), travel in travel()) {
        let center = setting.flat(at);
        let parts = vec![Part::Word(Modifier::Center), circle(center, setting.size)];
        Figure::flat(GeometryKind::Point, setting, Turns::Flat, parts).hold(travel, |_| false, |geometry| {
            prop_assert_eq!(found(geometry), center);
            Ok(())
        })?;
    }

    /// An ellipse or hyperbola and a line through a place of it: everything that a conic can be to a line.
    #[test]
    fn of_line_and_conic(
        setting in near_flat_setting(), at in unit(), axes in [0.2..1.0f64, 0.2..1.0], turn in -180.0..180.0f64, hyperbola in any::<bool>(),
        station in -2.0..2.0f64, angle in -180.0..180.0f64, which in which(), travel in travel(),
    ) {
        let center = setting.flat(at);
        let [a, b] = axes.map(|axis| setting.length(axis));
        let kind = if hyperbola { GeometryKind::Hyperbola } else { GeometryKind::Ellipse };
        let conic = Figure::flat(kind, setting, Turns::Flat, vec![
            Part::Word(Modifier::Center), point(center), Part::Length(a), Part::Length(b), Part::Heading(turn),
        ]).define().expect("a conic");
        let (u, v) = if hyperbola { (a * station.cosh(), b * station.sinh()) } else { (a * station.cos(), b * station.sin()) };
        let on = center + direction(turn) * u + direction(turn + 90.0) * v;
        let of = line_through(&on, angle);
        let equation = quadric(&conic);
        // How far the line is from touching the conic at the place.
        let steep = equation.gradient(&on).normalize().dot(&of.line_direction()).abs();
        // How far it is from an asymptote, in the axes of the conic.
        let along = of.line_direction();
        let (du, dv) = (along.dot(&direction(turn)) / a, along.dot(&direction(turn + 90.0)) / b);
        let bend = (if hyperbola { du * du - dv * dv } else { du * du + dv * dv }).abs() * a.min(b).powi(2);
        let parts = vec![Part::Word(which), Part::Word(Modifier::IntersectionOf), line(of), Part::Entity(conic)];
        let condition = (0.1 * steep * steep).recip().max(bend.recip()).max(toward(which, &along).abs().recip());
        Figure::flat(GeometryKind::Point, setting, Turns::Quarter, parts).condition(condition).hold(
            travel,
            // Where the line touches, rounding may take it off the curve.
            |reason| matches!(reason, Impossible::NoIntersection { .. }) && steep < 1e-5,
            |geometry| {
                let place = found(geometry);
                on_line(&setting, &of, &place)?;
                let error = equation.value(&place) / equation.gradient(&place).norm();
                let touches = error.abs() <= TOUCHING && steep * steep * setting.size <= 100.0 * TOUCHING;
                // The equation itself is known to its roundings only.
                let (_, size) = equation.value_with_size(&place);
                let rounding = 16.0 * f64::EPSILON * size / equation.gradient(&place).norm();
                if !touches && error.abs() > rounding {
                    setting.holds("on the conic", error, &place)?;
                }
                prop_assert!(
                    steep < 0.05 || toward(which, &(place - on)) >= -1e-8 * setting.size.max((place - on).norm()),
                    "the other intersection {on:?} goes farther"
                );
                Ok(())
            },
        )?;
    }

    #[test]
    fn of_three_planes(setting in setting(), at in unit(), normals in [unit(), unit(), unit()], narrow in narrow(), travel in travel()) {
        let normals = normals.map(Vec3::from);
        prop_assume!(normals.iter().all(|normal| normal.norm() > 0.1));
        let third = (normals[0] + normals[1]) * 0.7 + normals[2] * narrow;
        prop_assume!(third.norm() > 0.1);
        let place = setting.place(at);
        let planes = [normals[0], normals[1], third].map(|normal| Plane::through(place, normal).expect("a normal"));
        let volume = planes[0].normal.cross(&planes[1].normal).dot(&planes[2].normal);
        let mut parts = vec![Part::Word(Modifier::IntersectionOf)];
        parts.extend(planes.map(plane));
        Figure::space(GeometryKind::Point, setting, Turns::Space, parts).condition(volume.recip()).hold(
            travel,
            |reason| *reason == Impossible::Singular && volume.abs() <= 1.01e-5,
            |geometry| {
                let place = found(geometry);
                planes.iter().try_for_each(|of| setting.holds("on the plane", of.signed_distance(&place), &place))
            },
        )?;
    }

    #[test]
    fn polar(setting in setting(), radius in 0.01..1.0f64, angle in -720.0..720.0f64, plane in 0..3usize, order in any::<bool>()) {
        let (word, first, second) = [(Modifier::XyPlane, 0, 1), (Modifier::YzPlane, 1, 2), (Modifier::ZxPlane, 2, 0)][plane];
        let (radius, at_origin) = (setting.length(radius), Setting { at: Vec3::zeros(), ..setting });
        let parts = if order {
            vec![Part::Word(Modifier::RadiusAngle), Part::Word(word), Part::Length(radius), Part::Number(angle)]
        } else {
            vec![Part::Word(Modifier::AngleRadius), Part::Word(word), Part::Number(angle), Part::Length(radius)]
        };
        let geometry = Figure::space(GeometryKind::Point, at_origin, Turns::None, parts).define().expect("a point");
        let place = found(&geometry);
        let (sine, cosine) = angle.to_radians().sin_cos();
        at_origin.holds("first coordinate", place[first] - radius * cosine, &place)?;
        at_origin.holds("second coordinate", place[second] - radius * sine, &place)?;
        prop_assert_eq!(place[3 - first - second], 0.0);
    }

    #[test]
    fn of_line_and_tabulated_cylinder(setting in near_flat_setting(), (heights, station) in wave(), angle in -60.0..60.0f64, travel in travel()) {
        let (surface, place, _) = crate::tabulated::place_on_wave(&setting, &heights, station);
        let of = line_through(&place, angle);
        let parts = vec![Part::Word(Modifier::IntersectionOf), line(of), Part::Entity(surface.clone()), point(place)];
        let steep = crate::tabulated::direction_at(&surface, &place).dot(&of.normal).abs();
        Figure::flat(GeometryKind::Point, setting, Turns::Flat, parts).condition(steep.powi(2).recip() * 10.0).hold(
            travel,
            |reason| *reason == Impossible::NotReal && steep < 1e-5,
            |geometry| {
                let found = found(geometry);
                on_line(&setting, &of, &found)?;
                let distance = crate::tabulated::distance(&surface, &found);
                setting.holds("on the curve", distance, &found)?;
                prop_assert!((found - place).norm() <= 1e-9 * setting.size / steep.max(1e-6), "the nearest is {place:?}, not {found:?}");
                Ok(())
            },
        )?;
    }

    #[test]
    fn of_a_pattern(setting in setting(), places in prop::collection::vec(unit(), 1..9), number in 0.0..1.0f64, fraction in 0.0..0.99f64, travel in travel()) {
        let points: Vec<Vec3> = places.iter().map(|at| setting.place(*at)).collect();
        let index = ((points.len() as f64 * number) as usize).min(points.len() - 1);
        let pattern = Pattern { arrangement: Arrangement::Random, column: points.len(), points: points.clone() };
        let parts = vec![Part::Entity(Geometry::Pattern(Arc::new(pattern))), Part::Number(index as f64 + 1.0 + fraction)];
        Figure::space(GeometryKind::Point, setting, Turns::Space, parts).hold(travel, |_| false, |geometry| {
            prop_assert_eq!(found(geometry), points[index]);
            Ok(())
        })?;
    }
}
