//! VECTOR. Vectors have no place: only turns and changes of unit matter.

use apt_geometry::Vec3;
use apt_geometry::canonical::{Geometry, GeometryKind, Plane};
use apt_geometry::definition::{Impossible, Modifier};
use proptest::prelude::*;

use crate::figure::{
    Figure, Part, Setting, Turns, direction, line, line_through, narrow, plane, point, setting, toward,
    travel, unit,
};
use crate::points::UNDECIDED;

fn found(geometry: &Geometry) -> Vec3 {
    match geometry {
        Geometry::Vector(vector) => *vector,
        other => panic!("{other:?} is no vector"),
    }
}

fn vector(value: Vec3) -> Part {
    Part::Entity(Geometry::Vector(value))
}

fn sense() -> impl Strategy<Value = Modifier> {
    use Modifier::{NegativeX, NegativeY, NegativeZ, PositiveX, PositiveY, PositiveZ};
    prop::sample::select(vec![PositiveX, PositiveY, PositiveZ, NegativeX, NegativeY, NegativeZ])
}

/// The unit of the figure and its middle at the origin.
fn unit_setting() -> Setting {
    Setting { at: Vec3::zeros(), size: 1.0 }
}

proptest! {
    #![proptest_config(crate::figure::config())]

    #[test]
    fn by_components_and_differences(setting in setting(), places in [unit(), unit()], form in 0..3usize, travel in travel()) {
        let [first, second] = places.map(|at| setting.place(at));
        let parts = match form {
            0 => vec![Part::Components(second - first)],
            1 => vec![Part::Place(first, 3), Part::Place(second, 3)],
            _ => vec![point(first), point(second)],
        };
        let condition = (setting.size / (second - first).norm()).max(1.0);
        Figure::space(GeometryKind::Vector, setting, Turns::Space, parts).condition(condition).hold(travel, |_| false, |geometry| {
            prop_assert_eq!(found(geometry), second - first);
            Ok(())
        })?;
    }

    #[test]
    fn perpendicular_to_a_plane(setting in setting(), normal in unit(), tilt in narrow(), word in sense(), travel in travel()) {
        let mut normal = Vec3::from(normal);
        normal[usize::from(tilt > 0.0)] *= tilt;
        prop_assume!(normal.norm() > 0.1);
        let given = Plane::through(setting.at, normal).expect("a normal");
        let component = toward(word, &given.normal);
        let parts = vec![Part::Word(Modifier::PerpendicularTo), plane(given), Part::Word(word)];
        // A unit vector does not change with the unit of length, so it is compared in one unit only.
        let figure = Figure::space(GeometryKind::Vector, setting, Turns::Quarter, parts).condition(component.recip());
        figure.hold(travel.rigid(), |reason| matches!(reason, Impossible::Undecided { .. }) && component.abs() <= UNDECIDED, |geometry| {
            let vector = found(geometry);
            prop_assert!((vector.norm() - 1.0).abs() < 1e-14 && vector.cross(&given.normal).norm() < 1e-14);
            prop_assert!(toward(word, &vector) > 0.0);
            Ok(())
        })?;
    }

    #[test]
    fn arithmetic(first in unit(), second in unit(), factor in -1e3..1e3f64, points in any::<bool>(), form in 0..4usize, travel in travel()) {
        let (a, b) = (Vec3::from(first), Vec3::from(second));
        let part = |value: Vec3| if points { point(value) } else { vector(value) };
        let (parts, expected) = match form {
            0 => (vec![Part::Number(factor), Part::Word(Modifier::Times), part(a)], a * factor),
            1 => (vec![part(a), Part::Word(Modifier::Cross), part(b)], a.cross(&b)),
            2 => (vec![part(a), Part::Word(Modifier::Plus), part(b)], a + b),
            _ => (vec![part(a), Part::Word(Modifier::Minus), part(b)], a - b),
        };
        let condition = if form == 1 { a.norm() * b.norm() } else { a.norm() + b.norm() } / expected.norm();
        let figure = Figure::space(GeometryKind::Vector, unit_setting(), Turns::Space, parts).condition(condition);
        let check = |geometry: &Geometry| {
            prop_assert!((found(geometry) - expected).norm() <= 1e-14 * (1.0 + expected.norm()));
            Ok(())
        };
        // Points move, a product of lengths is no length: only what is linear in vectors moves as a vector.
        if points || form == 1 {
            check(&figure.define().expect("a vector"))?;
        } else {
            figure.hold(travel, |_| false, check)?;
        }
    }

    #[test]
    fn cross_products_turn(first in unit(), second in unit(), travel in travel()) {
        let (a, b) = (Vec3::from(first), Vec3::from(second));
        let expected = a.cross(&b);
        let parts = vec![vector(a), Part::Word(Modifier::Cross), vector(b)];
        Figure::space(GeometryKind::Vector, unit_setting(), Turns::Space, parts)
            .condition(a.norm() * b.norm() / expected.norm())
            .hold(travel.rigid(), |_| false, |geometry| {
                let found = found(geometry);
                prop_assert!(found.dot(&a).abs() < 1e-14 && found.dot(&b).abs() < 1e-14);
                Ok(())
            })?;
    }

    #[test]
    fn unit_vectors(way in unit(), length in -5.0..8.0f64, form in 0..3usize, travel in travel()) {
        let given = Vec3::from(way) * 10f64.powf(length);
        let parts = vec![Part::Word(Modifier::Unit), match form {
            0 => Part::Components(given),
            1 => vector(given),
            _ => point(given),
        }];
        let figure = Figure::space(GeometryKind::Vector, unit_setting(), Turns::Space, parts).condition(if form == 2 { 1e9 } else { 1.0 });
        let refusal = |reason: &Impossible| *reason == Impossible::ZeroVector && given.amax() <= 1.01e-6;
        figure.hold(travel.rigid(), refusal, |geometry| {
            let found = found(geometry);
            prop_assert!((found.norm() - 1.0).abs() < 1e-14);
            prop_assert!((found * given.norm() - given).norm() <= 1e-14 * given.norm());
            Ok(())
        })?;
    }

    #[test]
    fn length_and_angle(length in -1e3..1e3f64, angle in -720.0..720.0f64, plane in 0..3usize) {
        let (word, first, second) = [(Modifier::XyPlane, 0, 1), (Modifier::YzPlane, 1, 2), (Modifier::ZxPlane, 2, 0)][plane];
        let parts = vec![
            Part::Word(Modifier::Length), Part::Length(length), Part::Word(Modifier::AtAngle), Part::Number(angle), Part::Word(word),
        ];
        let vector = found(&Figure::space(GeometryKind::Vector, unit_setting(), Turns::None, parts).define().expect("a vector"));
        let (sine, cosine) = angle.to_radians().sin_cos();
        prop_assert!((vector[first] - length * cosine).abs() <= 1e-12 * length.abs());
        prop_assert!((vector[second] - length * sine).abs() <= 1e-12 * length.abs());
        prop_assert_eq!(vector[3 - first - second], 0.0);
    }

    #[test]
    fn parallel_to_an_intersection(setting in setting(), normal in unit(), way in unit(), lean in narrow(), word in sense(), travel in travel()) {
        let normal = Vec3::from(normal);
        prop_assume!(normal.norm() > 0.1);
        let second = normal + Vec3::from(way) * lean;
        prop_assume!(second.norm() > 0.1);
        let planes = [normal, second].map(|normal| Plane::through(setting.at, normal).expect("a normal"));
        let across = planes[0].normal.cross(&planes[1].normal);
        let component = if across.norm() > 0.0 { toward(word, &across.normalize()) } else { 0.0 };
        let parts = vec![
            Part::Word(Modifier::Parallel), Part::Word(Modifier::IntersectionOf), plane(planes[0]), plane(planes[1]), Part::Word(word),
        ];
        let condition = across.norm().recip().max(component.abs().recip());
        Figure::space(GeometryKind::Vector, setting, Turns::Quarter, parts).condition(condition).hold(
            travel.rigid(),
            |reason| match reason {
                Impossible::Parallel => across.norm() <= 1.01e-5,
                Impossible::Undecided { .. } => component.abs() <= UNDECIDED,
                _ => false,
            },
            |geometry| {
                let vector = found(geometry);
                prop_assert!((vector.norm() - 1.0).abs() < 1e-14 && toward(word, &vector) > 0.0);
                for plane in &planes {
                    prop_assert!(vector.dot(&plane.normal).abs() < 1e-10);
                }
                Ok(())
            },
        )?;
    }

    #[test]
    fn at_an_angle_with_a_line(base in -180.0..180.0f64, angle in -360.0..360.0f64, word in 0..8usize, travel in travel()) {
        use Modifier::{NegativeX, NegativeY, PositiveX, PositiveY, XLarge, XSmall, YLarge, YSmall};
        let word = [PositiveX, XLarge, NegativeX, XSmall, PositiveY, YLarge, NegativeY, YSmall][word];
        let given = line_through(&Vec3::new(0.3, -0.4, 0.0), base);
        let parts = vec![Part::Word(Modifier::AtAngle), Part::Number(angle), line(given), Part::Word(word)];
        // The direction of the line is a quarter turn behind its normal.
        let expected = direction(base - 90.0 + angle);
        let component = toward(word, &expected);
        Figure::flat(GeometryKind::Vector, unit_setting(), Turns::Quarter, parts).condition(component.recip()).hold(
            travel.rigid(),
            |_| false,
            |geometry| {
                let vector = found(geometry);
                prop_assert!(vector.cross(&expected).norm() < 1e-12 && (vector.norm() - 1.0).abs() < 1e-14);
                prop_assert!(component.abs() < 1e-12 || toward(word, &vector) > 0.0);
                Ok(())
            },
        )?;
    }
}
