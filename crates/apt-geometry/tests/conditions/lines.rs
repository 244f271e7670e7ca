//! LINE.

use apt_geometry::Vec3;
use apt_geometry::canonical::{Geometry, GeometryKind, Plane};
use apt_geometry::definition::{Impossible, Modifier};
use proptest::prelude::*;

use crate::figure::{
    Figure, Part, Setting, Turns, Verdict, direction, flat_setting, line, line_through, narrow,
    near_flat_setting, plane, point, setting, toward, travel, unit, which,
};
use crate::points::{TOUCHING, UNDECIDED, circle};
use crate::tabulated::wave;

fn found(geometry: &Geometry) -> Plane {
    match geometry {
        Geometry::Line(line) => *line,
        other => panic!("{other:?} is no line"),
    }
}

/// Fails when a line is no line of the xy-plane with a unit normal, or does not go through a place.
fn through(setting: &Setting, line: &Plane, place: &Vec3) -> Verdict {
    prop_assert!((line.normal.norm() - 1.0).abs() < 1e-14 && line.normal.z == 0.0);
    setting.holds("through the place", line.signed_distance(place), place)
}

fn right_of(vector: &Vec3) -> Vec3 {
    Vec3::new(vector.y, -vector.x, 0.0)
}

/// Tangent lines: distances from the centres, and the sides seen from the first centre.
fn touches(setting: &Setting, line: &Plane, circles: [(Vec3, f64, Modifier); 2], touching: bool) -> Verdict {
    let along = circles[1].0 - circles[0].0;
    let left = -right_of(&along.normalize());
    for (center, radius, side) in circles {
        let distance = line.signed_distance(&center);
        let error = distance.abs() - radius;
        if !(touching && error.abs() <= TOUCHING * 1.01) {
            setting.holds("distance from the centre", error, &center)?;
        }
        let contact = (line.project(&center) - center).dot(&left);
        let wanted = if side == Modifier::Left { contact } else { -contact };
        prop_assert!(touching || wanted >= -setting.allowed(radius), "on the wrong side: {wanted:e}");
    }
    Ok(())
}

fn side() -> impl Strategy<Value = Modifier> {
    prop::sample::select(vec![Modifier::Left, Modifier::Right])
}

proptest! {
    #![proptest_config(crate::figure::config())]

    #[test]
    fn through_two_places(setting in flat_setting(), at in unit(), angle in -180.0..180.0f64, narrow in narrow(), form in 0..3usize, travel in travel()) {
        let first = setting.flat(at);
        let second = first + direction(angle) * setting.length(narrow);
        let parts = match form {
            0 => vec![point(first), point(second)],
            1 => vec![Part::Place(first, 2), Part::Place(second, 2)],
            _ => vec![Part::Place(first, 3), Part::Place(second, 3)],
        };
        let apart = (second - first).norm();
        Figure::flat(GeometryKind::Line, setting, Turns::Flat, parts).condition(setting.size / apart).hold(
            travel,
            |reason| matches!(reason, Impossible::Coincident { distance } if *distance <= TOUCHING),
            |geometry| {
                let line = found(geometry);
                through(&setting, &line, &first)?;
                through(&setting, &line, &second)?;
                prop_assert!(line.normal.dot(&right_of(&(second - first))) > 0.0);
                Ok(())
            },
        )?;
    }

    #[test]
    fn tangent_from_a_point(
        setting in flat_setting(), at in unit(), radius in 0.1..1.0f64, outset in narrow(), angle in -180.0..180.0f64, side in side(), travel in travel(),
    ) {
        let (center, radius) = (setting.flat(at), setting.length(radius));
        let from = center + direction(angle) * (radius * (1.0 + outset));
        let distance = (from - center).norm();
        let parts = vec![point(from), Part::Word(side), Part::Word(Modifier::TangentTo), circle(center, radius)];
        let touching = (distance - radius).abs() <= TOUCHING * 1.01;
        Figure::flat(GeometryKind::Line, setting, Turns::Flat, parts).condition(outset.abs().recip().max(setting.size / distance)).hold(
            travel,
            |reason| match reason {
                Impossible::InsideCircle { distance, radius } => distance < radius,
                Impossible::Coincident { distance } => *distance <= TOUCHING,
                _ => false,
            },
            |geometry| {
                let line = found(geometry);
                if !touching {
                    through(&setting, &line, &from)?;
                }
                touches(&setting, &line, [(from, 0.0, side), (center, radius, side)], touching)
            },
        )?;
    }

    #[test]
    fn tangent_to_two_circles(
        setting in flat_setting(), at in unit(), radii in [0.05..1.0f64, 0.05..1.0], outset in narrow(), angle in -180.0..180.0f64,
        sides in [side(), side()], travel in travel(),
    ) {
        let (first, radii) = (setting.flat(at), radii.map(|radius| setting.length(radius)));
        let reach = if sides[0] == sides[1] { (radii[0] - radii[1]).abs() } else { radii[0] + radii[1] };
        let apart = reach + setting.length(outset);
        prop_assume!(apart > 0.0);
        let second = first + direction(angle) * apart;
        let apart = (second - first).norm();
        let parts = vec![
            Part::Word(sides[0]), Part::Word(Modifier::TangentTo), circle(first, radii[0]),
            Part::Word(sides[1]), Part::Word(Modifier::TangentTo), circle(second, radii[1]),
        ];
        let touching = (apart - reach).abs() <= TOUCHING * 1.01;
        Figure::flat(GeometryKind::Line, setting, Turns::Flat, parts).condition((setting.size / (apart - reach)).abs().max(setting.size / apart)).hold(
            travel,
            |reason| match reason {
                Impossible::CirclesTooNear { distance, needed } => distance < needed,
                Impossible::Coincident { distance } => *distance <= TOUCHING,
                _ => false,
            },
            |geometry| touches(&setting, &found(geometry), [(first, radii[0], sides[0]), (second, radii[1], sides[1])], touching),
        )?;
    }

    /// ATANGL and SLOPE, against an axis or a line.
    #[test]
    fn inclined(setting in flat_setting(), at in unit(), angle in -89.9..89.9f64, slope in any::<bool>(), against in 0..4usize, base in -180.0..180.0f64, travel in travel()) {
        let place = setting.flat(at);
        let mut parts = vec![point(place)];
        if slope {
            parts.extend([Part::Word(Modifier::Slope), Part::Number(angle.to_radians().tan())]);
        } else {
            parts.extend([Part::Word(Modifier::AtAngle), Part::Number(angle)]);
        }
        let normal = match against {
            0 => 90.0,
            1 => { parts.push(Part::Word(Modifier::XAxis)); 90.0 }
            2 => { parts.push(Part::Word(Modifier::YAxis)); 0.0 }
            _ => { parts.push(line(line_through(&setting.flat([0.3, -0.4, 0.0]), base))); base }
        };
        let turns = if against == 3 { Turns::Flat } else { Turns::None };
        Figure::flat(GeometryKind::Line, setting, turns, parts).condition(10.0).hold(travel, |_| false, |geometry| {
            let line = found(geometry);
            through(&setting, &line, &place)?;
            prop_assert!((line.normal - direction(normal + angle)).norm() < 1e-10);
            Ok(())
        })?;
    }

    #[test]
    fn parallel_and_perpendicular_through_a_point(setting in flat_setting(), at in unit(), base in -180.0..180.0f64, parallel in any::<bool>(), travel in travel()) {
        let (place, given) = (setting.flat(at), line_through(&setting.flat([0.3, -0.4, 0.0]), base));
        let word = if parallel { Modifier::Parallel } else { Modifier::PerpendicularTo };
        let parts = vec![point(place), Part::Word(word), line(given)];
        Figure::flat(GeometryKind::Line, setting, Turns::Flat, parts).hold(travel, |_| false, |geometry| {
            let line = found(geometry);
            through(&setting, &line, &place)?;
            let expected = if parallel { given.normal } else { -right_of(&given.normal) };
            prop_assert!((line.normal - expected).norm() < 1e-14);
            Ok(())
        })?;
    }

    #[test]
    fn axes(word in prop::sample::select(vec![Modifier::XAxis, Modifier::YAxis]), at in -1e4..1e4f64) {
        let setting = Setting { at: Vec3::zeros(), size: 1.0 };
        let line = found(&Figure::flat(GeometryKind::Line, setting, Turns::None, vec![Part::Word(word)]).define().expect("an axis"));
        let on = if word == Modifier::XAxis { Vec3::new(at, 0.0, 0.0) } else { Vec3::new(0.0, at, 0.0) };
        through(&setting, &line, &on)?;
    }

    #[test]
    fn parallel_at_a_distance(setting in flat_setting(), base in -180.0..180.0f64, tilt in narrow(), distance in -1.0..1.0f64, which in which(), travel in travel()) {
        // Often nearly at a right angle to the selector.
        let given = line_through(&setting.flat([0.3, -0.4, 0.0]), if base > 0.0 { base } else { 90.0 * tilt });
        let shift = setting.length(distance);
        let parts = vec![Part::Word(Modifier::Parallel), line(given), Part::Word(which), Part::Length(shift)];
        let component = toward(which, &given.normal);
        Figure::flat(GeometryKind::Line, setting, Turns::Quarter, parts).condition(component.recip()).hold(
            travel,
            |reason| matches!(reason, Impossible::Undecided { .. }) && component.abs() <= UNDECIDED,
            |geometry| {
                let line = found(geometry);
                prop_assert!(toward(which, &line.normal) > 0.0);
                prop_assert!(line.normal.cross(&given.normal).norm() < 1e-14);
                let on = given.project(&setting.at) + line.normal * shift;
                setting.holds("distance", line.signed_distance(&on), &on)
            },
        )?;
    }

    #[test]
    fn of_two_planes(setting in setting(), at in unit(), normals in [unit(), unit()], narrow in narrow(), travel in travel()) {
        let [first, second] = normals.map(Vec3::from);
        prop_assume!(first.norm() > 0.1);
        let second = first + second * narrow;
        prop_assume!(second.norm() > 0.1);
        let place = setting.place(at);
        let planes = [first, second].map(|normal| Plane::through(place, normal).expect("a normal"));
        let across = planes[0].normal.cross(&planes[1].normal);
        let level = across.x.hypot(across.y);
        let flat = Figure::flat(GeometryKind::Line, setting, Turns::Flat, vec![Part::Word(Modifier::IntersectionOf), plane(planes[0]), plane(planes[1])]);
        flat.condition(level.recip()).hold(
            travel,
            |reason| *reason == Impossible::Parallel && level <= 1.5e-5,
            |geometry| {
                let line = found(geometry);
                let along = across.normalize();
                let level = along.x.hypot(along.y);
                // How sharply the planes cut tells how well the place on them is known.
                let sharp = across.norm();
                for station in [-1.0, 0.0, 1.0] {
                    let on = place + along * setting.length(station);
                    let error = line.signed_distance(&on) * sharp * level;
                    setting.holds("through the intersection", error, &on)?;
                }
                Ok(())
            },
        )?;
    }

    /// SLOPE or ATANGL with INTERC on either axis.
    #[test]
    fn by_intercept(setting in flat_setting(), angle in -80.0..80.0f64, slope in any::<bool>(), axis in 0..3usize, intercept in -1.0..1.0f64) {
        let setting = Setting { at: Vec3::zeros(), ..setting };
        let place = setting.length(intercept);
        let mut parts = if slope {
            vec![Part::Word(Modifier::Slope), Part::Number(angle.to_radians().tan())]
        } else {
            vec![Part::Word(Modifier::AtAngle), Part::Number(angle)]
        };
        parts.push(Part::Word(Modifier::Intercept));
        match axis {
            0 => {}
            1 => parts.push(Part::Word(Modifier::YAxis)),
            _ => parts.push(Part::Word(Modifier::XAxis)),
        }
        parts.push(Part::Length(place));
        let on = if axis == 2 { Vec3::new(place, 0.0, 0.0) } else { Vec3::new(0.0, place, 0.0) };
        let line = found(&Figure::flat(GeometryKind::Line, setting, Turns::None, parts).define().expect("a line"));
        through(&setting, &line, &on)?;
        prop_assert!((line.normal - direction(angle + 90.0)).norm() < 1e-10);
    }

    /// TANTO and PERPTO a tabulated cylinder: from a place off the curve along its tangent or its normal.
    #[test]
    fn at_a_tabulated_cylinder(
        setting in near_flat_setting(), (heights, station) in wave(), away in 0.1..1.0f64, tangent in any::<bool>(), travel in travel(),
    ) {
        let (surface, place, along) = crate::tabulated::place_on_wave(&setting, &heights, station);
        let way = if tangent { along } else { -right_of(&along) };
        let from = place + way * setting.length(away);
        let word = if tangent { Modifier::TangentTo } else { Modifier::PerpendicularTo };
        let parts = vec![point(from), Part::Word(word), Part::Entity(surface.clone()), point(place)];
        let figure = Figure::flat(GeometryKind::Line, setting, Turns::Flat, parts).condition(1e3);
        figure.hold(travel, |_| false, |geometry| {
            let line = found(geometry);
            through(&setting, &line, &from)?;
            // Where the curve runs along the line, or across it, the two meet.
            let wanted = if tangent { line.normal } else { line.line_direction() };
            let feet = crate::tabulated::places_where(&surface, |_, direction| direction.dot(&wanted));
            let error = feet.iter().map(|foot| line.signed_distance(foot).abs()).fold(f64::INFINITY, f64::min);
            // Where the curve only just turns across the line, the foot is known to half the digits.
            let turning = crate::tabulated::turning_places(crate::tabulated::surface(&surface), |_, direction| direction.dot(&wanted));
            let touching = turning.iter().any(|foot| line.signed_distance(foot).abs() < 1e-6 * setting.size);
            if !touching {
                setting.holds("meets the curve", error, &place)?;
            }
            Ok(())
        })?;
    }
}
