//! CIRCLE.

use apt_geometry::Vec3;
use apt_geometry::canonical::{Cylinder, Geometry, GeometryKind, Plane};
use apt_geometry::definition::{Impossible, Modifier};
use proptest::prelude::*;

use crate::figure::{
    Figure, Part, Setting, Turns, Verdict, direction, flat_setting, line, line_through, narrow,
    near_flat_setting, point, toward, travel, unit, which,
};
use crate::points::{TOUCHING, UNDECIDED, circle};
use crate::tabulated::wave;

fn found(geometry: &Geometry) -> Cylinder {
    match geometry {
        Geometry::Circle(circle) => *circle,
        other => panic!("{other:?} is no circle"),
    }
}

/// Fails when the result does not touch a line on the side that a selector names.
fn touches_line(setting: &Setting, circle: &Cylinder, line: &Plane, which: Option<Modifier>) -> Verdict {
    setting.holds(
        "touches the line",
        line.signed_distance(&circle.point).abs() - circle.radius,
        &circle.point,
    )?;
    if let Some(which) = which {
        prop_assert!(toward(which, &(circle.point - line.project(&circle.point))) > 0.0);
    }
    Ok(())
}

fn goes_through(setting: &Setting, circle: &Cylinder, place: &Vec3) -> Verdict {
    let error = (circle.point - place).norm() - circle.radius;
    setting.holds("through the place", error, &(circle.point + direction(0.0) * circle.radius))
}

fn in_or_out() -> impl Strategy<Value = Modifier> {
    prop::sample::select(vec![Modifier::In, Modifier::Out])
}

/// Distance of the centres of two circles that touch.
fn reach(word: Modifier, other: f64, radius: f64) -> f64 {
    if word == Modifier::In { (other - radius).abs() } else { other + radius }
}

proptest! {
    #![proptest_config(crate::figure::config())]

    /// The forms that name centre and radius.
    #[test]
    fn center_and_radius(setting in flat_setting(), at in unit(), radius in 1e-3..1.0f64, form in 0..4usize, travel in travel()) {
        let (center, radius) = (setting.flat(at), setting.length(radius));
        let (word, length) = (Part::Word, Part::Length(radius));
        let parts = match form {
            0 => vec![Part::Place(center, 2), length],
            1 => vec![Part::Place(center, 3), length],
            2 => vec![word(Modifier::Center), point(center), word(Modifier::Radius), length],
            _ => vec![word(Modifier::Center), Part::Place(center, 3), word(Modifier::Radius), length],
        };
        Figure::flat(GeometryKind::Circle, setting, Turns::Flat, parts).hold(travel, |_| false, |geometry| {
            prop_assert_eq!(found(geometry), Cylinder::circle(center.x, center.y, radius));
            Ok(())
        })?;
    }

    #[test]
    fn center_and_line(setting in flat_setting(), at in unit(), base in -180.0..180.0f64, travel in travel()) {
        let (center, given) = (setting.flat(at), line_through(&setting.flat([0.3, -0.4, 0.0]), base));
        let radius = given.signed_distance(&center).abs();
        let parts = vec![Part::Word(Modifier::Center), point(center), Part::Word(Modifier::TangentTo), line(given)];
        Figure::flat(GeometryKind::Circle, setting, Turns::Flat, parts).condition(setting.size / radius).hold(travel, |_| false, |geometry| {
            let circle = found(geometry);
            prop_assert_eq!(circle.point, center);
            touches_line(&setting, &circle, &given, None)
        })?;
    }

    #[test]
    fn center_and_point(setting in flat_setting(), places in [unit(), unit()], travel in travel()) {
        let [center, on] = places.map(|at| setting.flat(at));
        let parts = vec![Part::Word(Modifier::Center), point(center), point(on)];
        Figure::flat(GeometryKind::Circle, setting, Turns::Flat, parts).hold(travel, |_| false, |geometry| {
            let circle = found(geometry);
            prop_assert_eq!(circle.point, center);
            goes_through(&setting, &circle, &on)
        })?;
    }

    /// Three points of a circle, often nearly in line and two of them often near each other.
    #[test]
    fn three_points(setting in flat_setting(), at in unit(), angle in -180.0..180.0f64, stations in [0.1..1.0f64, 0.1..1.0], bulge in narrow(), close in narrow(), travel in travel()) {
        let first = setting.flat(at);
        let along = direction(angle);
        let second = first + along * setting.length(stations[0] * close.abs()) + direction(angle + 90.0) * setting.length(bulge * close.abs());
        let third = first + along * setting.length(stations[0] + stations[1]);
        let (b, c) = (second - first, third - first);
        let sine = b.cross(&c).norm() / (b.norm() * c.norm());
        let nearest = b.norm().min(c.norm()).min((third - second).norm());
        let condition = setting.size / (sine * nearest);
        let parts = [first, second, third].map(point).to_vec();
        Figure::flat(GeometryKind::Circle, setting, Turns::Flat, parts).condition(condition).hold(
            travel,
            |reason| match reason {
                Impossible::Collinear => sine <= 1.01e-5,
                Impossible::Coincident { distance } => *distance <= TOUCHING,
                _ => false,
            },
            |geometry| {
                let circle = found(geometry);
                [first, second, third].iter().try_for_each(|place| goes_through(&setting, &circle, place))
            },
        )?;
    }

    #[test]
    fn center_and_circle(setting in flat_setting(), places in [unit(), unit()], radius in 0.1..1.0f64, large in any::<bool>(), travel in travel()) {
        let ([center, other], radius) = (places.map(|at| setting.flat(at)), setting.length(radius));
        let word = if large { Modifier::Large } else { Modifier::Small };
        let parts = vec![Part::Word(Modifier::Center), point(center), Part::Word(word), Part::Word(Modifier::TangentTo), circle(other, radius)];
        Figure::flat(GeometryKind::Circle, setting, Turns::Flat, parts).hold(travel, |_| false, |geometry| {
            let circle = found(geometry);
            let distance = (other - center).norm();
            prop_assert_eq!(circle.point, center);
            let expected = if large { distance + radius } else { (radius - distance).abs() };
            setting.holds("touches the circle", circle.radius - expected, &center)
        })?;
    }

    #[test]
    fn two_lines(setting in flat_setting(), at in unit(), angle in -180.0..180.0f64, narrow in narrow(), radius in 0.01..1.0f64, selectors in [which(), which()], travel in travel()) {
        let place = setting.flat(at);
        let lines = [line_through(&place, angle), line_through(&place, angle + 90.0 * narrow)];
        let radius = setting.length(radius);
        let sine = lines[0].normal.cross(&lines[1].normal).norm();
        let components = [toward(selectors[0], &lines[0].normal), toward(selectors[1], &lines[1].normal)];
        let decided = components[0].abs().min(components[1].abs());
        let parts = vec![
            Part::Word(selectors[0]), line(lines[0]), Part::Word(selectors[1]), line(lines[1]), Part::Word(Modifier::Radius), Part::Length(radius),
        ];
        Figure::flat(GeometryKind::Circle, setting, Turns::Quarter, parts).condition(sine.recip().max(decided.recip())).hold(
            travel,
            |reason| match reason {
                Impossible::Parallel => sine <= 1.01e-5,
                Impossible::Undecided { .. } => decided <= UNDECIDED,
                _ => false,
            },
            |geometry| {
                let circle = found(geometry);
                prop_assert_eq!(circle.radius, radius);
                touches_line(&setting, &circle, &lines[0], Some(selectors[0]))?;
                touches_line(&setting, &circle, &lines[1], Some(selectors[1]))
            },
        )?;
    }

    /// From a point on the line to one that the circle just reaches.
    #[test]
    fn line_and_point(setting in flat_setting(), at in unit(), angle in -180.0..180.0f64, height in narrow(), radius in 0.1..1.0f64, which in which(), travel in travel()) {
        let radius = setting.length(radius);
        let given = line_through(&setting.flat(at), angle);
        // Near the line, or near the far end of the circle.
        let place = given.project(&setting.at) + given.normal * (radius * if height > 0.0 { height } else { 2.0 + height });
        let place = Vec3::new(place.x, place.y, 0.0);
        let distance = given.signed_distance(&place);
        let along = toward(which, &given.line_direction());
        let across = toward(which, &given.normal);
        let half = (radius * radius - (radius - distance.abs()).powi(2)).max(0.0).sqrt();
        let touching = distance.abs() <= TOUCHING * 1.01 || (2.0 * radius - distance.abs()) <= TOUCHING * 1.01;
        let parts = vec![Part::Word(Modifier::TangentTo), line(given), Part::Word(which), point(place), Part::Word(Modifier::Radius), Part::Length(radius)];
        let condition = (radius / half).powi(2).max(along.abs().recip());
        Figure::flat(GeometryKind::Circle, setting, Turns::Quarter, parts).condition(condition).hold(
            travel,
            |reason| match reason {
                Impossible::Undecided { .. } => along.abs() <= UNDECIDED || across.abs() <= UNDECIDED,
                Impossible::RadiusTooSmall { least, .. } => *least > radius,
                _ => false,
            },
            |geometry| {
                let circle = found(geometry);
                prop_assert_eq!(circle.radius, radius);
                touches_line(&setting, &circle, &given, None)?;
                if !touching {
                    goes_through(&setting, &circle, &place)?;
                    prop_assert!(given.signed_distance(&circle.point) * distance > 0.0, "on the side of the point");
                    prop_assert!(toward(which, &(circle.point - place)) * 1.0 > toward(which, &(circle.point - given.project(&circle.point) + given.project(&place) - place)) - 1e-9 * radius);
                }
                let error = (circle.point - place).norm() - radius;
                prop_assert!(error.abs() <= TOUCHING * 1.01 + 1e-9 * radius);
                Ok(())
            },
        )?;
    }

    #[test]
    fn line_and_circle(
        setting in flat_setting(), at in unit(), angle in -180.0..180.0f64, radii in [0.1..1.0f64, 0.1..1.0], inset in narrow(),
        selectors in [which(), which()], inside in in_or_out(), travel in travel(),
    ) {
        let (center, radii) = (setting.flat(at), radii.map(|radius| setting.length(radius)));
        let wanted = reach(inside, radii[0], radii[1]);
        prop_assume!(wanted > 0.02 * setting.size);
        // The line of the centres from through the given centre to just touching the circle of the centres.
        let gap = wanted * (1.0 - inset.abs()) * inset.signum();
        let normal = direction(angle);
        let sense = toward(selectors[0], &normal).signum();
        let given = line_through(&(center + normal * (gap - sense * radii[1])), angle);
        let offset = (given.signed_distance(&center) + 0.0) + sense * -radii[1];
        let along = toward(selectors[1], &given.line_direction());
        let decided = toward(selectors[0], &given.normal).abs().min(along.abs());
        let touching = (offset.abs() - wanted).abs() <= TOUCHING * 1.01;
        let parts = vec![
            Part::Word(selectors[0]), line(given), Part::Word(selectors[1]), Part::Word(inside), circle(center, radii[0]),
            Part::Word(Modifier::Radius), Part::Length(radii[1]),
        ];
        let half = ((wanted - offset) * (wanted + offset)).max(0.0).sqrt();
        let condition = (setting.size / half).powi(2).max(decided.recip()).max(setting.size / wanted);
        Figure::flat(GeometryKind::Circle, setting, Turns::Quarter, parts).condition(condition).hold(
            travel,
            |reason| match reason {
                Impossible::Undecided { .. } => decided <= UNDECIDED,
                Impossible::NoIntersection { .. } => offset.abs() > wanted - setting.allowed(wanted),
                _ => false,
            },
            |geometry| {
                let found = found(geometry);
                prop_assert_eq!(found.radius, radii[1]);
                touches_line(&setting, &found, &given, Some(selectors[0]))?;
                let error = (found.point - center).norm() - wanted;
                if !(touching && error.abs() <= TOUCHING * 1.01) {
                    setting.holds("touches the circle", error, &found.point)?;
                    let middle = found.point - given.line_direction() * given.line_direction().dot(&(found.point - center));
                    prop_assert!(toward(selectors[1], &(found.point - middle)) > 0.0);
                }
                Ok(())
            },
        )?;
    }

    #[test]
    fn two_circles(
        setting in flat_setting(), at in unit(), radii in [0.1..1.0f64, 0.1..1.0, 0.1..1.0], inset in narrow(), angle in -180.0..180.0f64,
        words in [in_or_out(), in_or_out()], which in which(), travel in travel(),
    ) {
        let (first, radii) = (setting.flat(at), radii.map(|radius| setting.length(radius)));
        let reaches = [reach(words[0], radii[0], radii[2]), reach(words[1], radii[1], radii[2])];
        prop_assume!(reaches[0].min(reaches[1]) > 0.02 * setting.size);
        let (least, most) = ((reaches[0] - reaches[1]).abs(), reaches[0] + reaches[1]);
        let part = if inset > 0.0 { inset } else { 1.0 + inset };
        let second = first + direction(angle) * (least + (most - least) * part);
        let apart = (second - first).norm();
        let across = toward(which, &direction(angle + 90.0));
        let tolerance = TOUCHING.min(1e-3 * reaches[0].max(reaches[1])) * 1.01;
        let touching = apart - least <= tolerance || most - apart <= tolerance;
        let size = setting.size;
        let condition = (size / (apart - least)).max(size / (most - apart)).max(across.abs().recip()).max(size / apart);
        let parts = vec![
            Part::Word(which), Part::Word(words[0]), circle(first, radii[0]), Part::Word(words[1]), circle(second, radii[1]),
            Part::Word(Modifier::Radius), Part::Length(radii[2]),
        ];
        Figure::flat(GeometryKind::Circle, setting, Turns::Quarter, parts).condition(condition).hold(
            travel,
            |reason| match reason {
                Impossible::Undecided { .. } => across.abs() <= UNDECIDED,
                Impossible::Coincident { .. } => apart <= tolerance,
                _ => false,
            },
            |geometry| {
                let found = found(geometry);
                prop_assert_eq!(found.radius, radii[2]);
                for (center, wanted) in [(first, reaches[0]), (second, reaches[1])] {
                    let error = (found.point - center).norm() - wanted;
                    if !(touching && error.abs() <= TOUCHING * 1.01) {
                        setting.holds("touches the circle", error, &found.point)?;
                    }
                }
                Ok(())
            },
        )?;
    }

    /// A circle beside a place of the curve, with the line on its other side.
    #[test]
    fn line_and_tabulated_cylinder(
        setting in near_flat_setting(), (heights, station) in wave(), radius in 0.01..0.1f64, above in any::<bool>(), angle in 20.0..160.0f64, travel in travel(),
    ) {
        let (surface, place, along) = crate::tabulated::place_on_wave(&setting, &heights, station);
        let normal = Vec3::new(-along.y, along.x, 0.0) * if above { 1.0 } else { -1.0 };
        let radius = setting.length(radius);
        let center = place + normal * radius;
        // The line touches the circle somewhere else than the curve does.
        let toward_line = direction(angle * if above { 1.0 } else { -1.0 });
        let given = Plane::through(center + toward_line * radius, toward_line).expect("a unit normal");
        // The sides by the selectors that decide best.
        let best = |vector: &Vec3| match (vector.x.abs() > vector.y.abs(), vector.x > 0.0, vector.y > 0.0) {
            (true, true, _) => Modifier::XLarge,
            (true, false, _) => Modifier::XSmall,
            (false, _, true) => Modifier::YLarge,
            (false, _, false) => Modifier::YSmall,
        };
        let sides = [best(&-toward_line), best(&normal)];
        let parts = vec![
            Part::Word(Modifier::TangentTo), line(given), Part::Word(sides[0]), Part::Entity(surface.clone()), Part::Word(sides[1]), point(place),
            Part::Word(Modifier::Radius), Part::Length(radius),
        ];
        Figure::flat(GeometryKind::Circle, setting, Turns::Quarter, parts).condition(1e3).hold(travel, |_| false, |geometry| {
            let found = found(geometry);
            prop_assert_eq!(found.radius, radius);
            touches_line(&setting, &found, &given, Some(sides[0]))?;
            // A foot of the centre on the curve lies on the circle.
            let feet = crate::tabulated::places_where(&surface, |at, direction| (at - found.point).dot(&direction));
            let error = feet.iter().map(|foot| ((foot - found.point).norm() - radius).abs()).fold(f64::INFINITY, f64::min);
            setting.holds("touches the curve", error, &place)
        })?;
    }
}
