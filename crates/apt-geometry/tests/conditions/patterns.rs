//! PATERN.

use std::sync::Arc;

use apt_geometry::Vec3;
use apt_geometry::canonical::{Arrangement, Geometry, GeometryKind, Pattern};
use apt_geometry::definition::Modifier;
use proptest::prelude::*;

use crate::figure::{
    Figure, Part, Setting, Turns, Verdict, direction, flat_setting, point, setting, travel, unit,
};
use crate::points::circle;

fn found(geometry: &Geometry) -> &Pattern {
    match geometry {
        Geometry::Pattern(pattern) => pattern,
        other => panic!("{other:?} is no pattern"),
    }
}

fn stands(setting: &Setting, pattern: &Pattern, expected: &[Vec3]) -> Verdict {
    prop_assert_eq!(pattern.points.len(), expected.len());
    for (found, expected) in pattern.points.iter().zip(expected) {
        setting.holds("place", (found - expected).norm(), expected)?;
    }
    Ok(())
}

/// Increments, each alone or as a group of equal ones.
#[derive(Debug, Clone)]
struct Increments {
    groups: Vec<(f64, Option<u8>)>,
}

fn increments() -> impl Strategy<Value = Increments> {
    prop::collection::vec((-1.0..1.0f64, prop::option::of(0..4u8)), 1..5)
        .prop_map(|groups| Increments { groups })
}

impl Increments {
    fn parts(&self, scale: impl Fn(f64) -> Part) -> Vec<Part> {
        let mut parts = vec![Part::Word(Modifier::Increment)];
        for (value, times) in &self.groups {
            if let Some(times) = times {
                parts.extend([Part::Number(f64::from(*times)), Part::Word(Modifier::At)]);
            }
            parts.push(scale(*value));
        }
        parts
    }

    fn stations(&self) -> Vec<f64> {
        let mut reached = 0.0;
        let mut stations = vec![reached];
        for (value, times) in &self.groups {
            for _ in 0..times.unwrap_or(1) {
                reached += value;
                stations.push(reached);
            }
        }
        stations
    }
}

fn linear(points: Vec<Vec3>) -> Part {
    let column = points.len();
    Part::Entity(Geometry::Pattern(Arc::new(Pattern { arrangement: Arrangement::Linear, points, column })))
}

/// Column by column, every second one backwards.
fn serpentine(column: &[Vec3], offsets: &[Vec3]) -> Vec<Vec3> {
    let mut points = Vec::new();
    for (index, offset) in offsets.iter().enumerate() {
        let mut shifted: Vec<Vec3> = column.iter().map(|point| point + offset).collect();
        if index % 2 == 1 {
            shifted.reverse();
        }
        points.extend(shifted);
    }
    points
}

proptest! {
    #![proptest_config(crate::figure::config())]

    #[test]
    fn between_points_or_along_a_vector(setting in setting(), places in [unit(), unit()], number in 1..20u16, by_vector in any::<bool>(), travel in travel()) {
        let [first, second] = places.map(|at| setting.place(at));
        let step = second - first;
        let count = Part::Number(f64::from(number));
        let parts = if by_vector {
            vec![Part::Word(Modifier::Linear), point(first), Part::Entity(Geometry::Vector(step)), count]
        } else {
            vec![Part::Word(Modifier::Linear), point(first), point(second), count]
        };
        let gaps = if by_vector { 1.0 } else { f64::from(number.max(2) - 1) };
        let expected: Vec<Vec3> = (0..number).map(|index| first + step * (f64::from(index) / gaps)).collect();
        Figure::space(GeometryKind::Pattern, setting, Turns::Space, parts).condition(10.0).hold(travel, |_| false, |geometry| {
            prop_assert_eq!(found(geometry).arrangement, Arrangement::Linear);
            stands(&setting, found(geometry), &expected)
        })?;
    }

    #[test]
    fn increments_along_a_vector(setting in setting(), at in unit(), way in unit(), increments in increments(), travel in travel()) {
        let (first, way) = (setting.place(at), Vec3::from(way));
        prop_assume!(way.norm() > 0.1);
        let mut parts = vec![Part::Word(Modifier::Linear), point(first), Part::Entity(Geometry::Vector(way))];
        parts.extend(increments.parts(|value| Part::Length(setting.length(value))));
        let expected: Vec<Vec3> = increments.stations().into_iter().map(|station| first + way.normalize() * setting.length(station)).collect();
        Figure::space(GeometryKind::Pattern, setting, Turns::Space, parts).condition(10.0).hold(travel, |_| false, |geometry| {
            stands(&setting, found(geometry), &expected)
        })?;
    }

    #[test]
    fn between_angles(setting in flat_setting(), at in unit(), radius in 0.1..1.0f64, angles in [-360.0..360.0f64, -360.0..360.0], clockwise in any::<bool>(), number in 2..20u16, travel in travel()) {
        let (center, radius) = (setting.flat(at), setting.length(radius));
        let word = if clockwise { Modifier::Clockwise } else { Modifier::Counterclockwise };
        let parts = vec![
            Part::Word(Modifier::Arc), circle(center, radius), Part::Heading(angles[0]), Part::Heading(angles[1]), Part::Word(word), Part::Number(f64::from(number)),
        ];
        let sense = if clockwise { -1.0 } else { 1.0 };
        let ahead = sense * (angles[1] - angles[0]);
        // An end that lies against the sense is reached whole turns on.
        let sweep = if ahead > 0.0 { ahead } else { ahead.rem_euclid(360.0) };
        prop_assume!(sweep > 1e-3 && (ahead > 0.0 || sweep < 359.999));
        Figure::flat(GeometryKind::Pattern, setting, Turns::Flat, parts).condition(1e3).hold(travel, |_| false, |geometry| {
            let pattern = found(geometry);
            prop_assert_eq!((pattern.arrangement, pattern.points.len()), (Arrangement::Arc, usize::from(number)));
            let expected: Vec<Vec3> = (0..number)
                .map(|index| center + direction(angles[0] + sense * sweep * f64::from(index) / f64::from(number - 1)) * radius)
                .collect();
            stands(&setting, pattern, &expected)?;
            let last = center + direction(angles[1]) * radius;
            setting.holds("last", (pattern.points[usize::from(number) - 1] - last).norm(), &last)
        })?;
    }

    #[test]
    fn increments_of_angle(setting in flat_setting(), at in unit(), radius in 0.1..1.0f64, angle in -360.0..360.0f64, clockwise in any::<bool>(), increments in increments(), travel in travel()) {
        let (center, radius) = (setting.flat(at), setting.length(radius));
        let word = if clockwise { Modifier::Clockwise } else { Modifier::Counterclockwise };
        let mut parts = vec![Part::Word(Modifier::Arc), circle(center, radius), Part::Heading(angle), Part::Word(word)];
        parts.extend(increments.parts(|value| Part::Number(90.0 * value)));
        let sense = if clockwise { -1.0 } else { 1.0 };
        let expected: Vec<Vec3> =
            increments.stations().into_iter().map(|turn| center + direction(angle + sense * 90.0 * turn) * radius).collect();
        Figure::flat(GeometryKind::Pattern, setting, Turns::Flat, parts).condition(10.0).hold(travel, |_| false, |geometry| {
            stands(&setting, found(geometry), &expected)
        })?;
    }

    /// The three forms of PARLEL.
    #[test]
    fn grids(setting in setting(), column in prop::collection::vec(unit(), 1..6), way in unit(), number in 1..6u16, increments in increments(), form in 0..3usize, travel in travel()) {
        let column: Vec<Vec3> = column.into_iter().map(|at| setting.place(at)).collect();
        let way = Vec3::from(way);
        prop_assume!(way.norm() > 0.1);
        let mut parts = vec![Part::Word(Modifier::Parallel), linear(column.clone())];
        let step = way * setting.size;
        let steps: Vec<Vec3> = (0..number).map(|index| step * f64::from(index)).collect();
        let offsets = match form {
            0 => {
                let start = setting.place([0.2, 0.1, -0.3]);
                parts.push(linear(steps.iter().map(|offset| start + offset).collect()));
                steps
            }
            1 => {
                parts.extend([Part::Entity(Geometry::Vector(step)), Part::Number(f64::from(number))]);
                steps
            }
            _ => {
                parts.push(Part::Entity(Geometry::Vector(step)));
                parts.extend(increments.parts(|value| Part::Length(setting.length(value))));
                increments.stations().into_iter().map(|station| way.normalize() * setting.length(station)).collect()
            }
        };
        Figure::space(GeometryKind::Pattern, setting, Turns::Space, parts).condition(10.0).hold(travel, |_| false, |geometry| {
            let pattern = found(geometry);
            prop_assert_eq!((pattern.arrangement, pattern.column), (Arrangement::Parallel, column.len()));
            stands(&setting, pattern, &serpentine(&column, &offsets))
        })?;
    }

    #[test]
    fn one_after_the_other(setting in setting(), parts in prop::collection::vec(prop::collection::vec(unit(), 1..5), 1..5), travel in travel()) {
        let mut expected = Vec::new();
        let mut list = vec![Part::Word(Modifier::Random)];
        for part in parts {
            let points: Vec<Vec3> = part.into_iter().map(|at| setting.place(at)).collect();
            expected.extend(points.iter().copied());
            list.push(if points.len() == 1 { point(points[0]) } else { linear(points) });
        }
        Figure::space(GeometryKind::Pattern, setting, Turns::Space, list).hold(travel, |_| false, |geometry| {
            prop_assert_eq!(&found(geometry).points, &expected);
            Ok(())
        })?;
    }
}
