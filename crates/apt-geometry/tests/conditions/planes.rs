//! PLANE.

use apt_geometry::Vec3;
use apt_geometry::canonical::{Geometry, GeometryKind, Plane};
use apt_geometry::definition::{Impossible, Modifier};
use proptest::prelude::*;

use crate::figure::{
    Figure, Part, Setting, Turns, Verdict, narrow, plane, point, setting, toward, travel, unit,
};
use crate::points::{TOUCHING, UNDECIDED};

fn found(geometry: &Geometry) -> Plane {
    match geometry {
        Geometry::Plane(plane) => *plane,
        other => panic!("{other:?} is no plane"),
    }
}

fn through(setting: &Setting, plane: &Plane, place: &Vec3) -> Verdict {
    prop_assert!((plane.normal.norm() - 1.0).abs() < 1e-14);
    setting.holds("through the place", plane.signed_distance(place), place)
}

/// A unit vector.
fn direction() -> impl Strategy<Value = Vec3> {
    unit().prop_filter_map("too short", |at| {
        let vector = Vec3::from(at);
        (vector.norm() > 0.1).then(|| vector.normalize())
    })
}

/// A selector of any axis.
pub(crate) fn selector() -> impl Strategy<Value = Modifier> {
    use Modifier::{XLarge, XSmall, YLarge, YSmall, ZLarge, ZSmall};
    prop::sample::select(vec![XLarge, XSmall, YLarge, YSmall, ZLarge, ZSmall])
}

proptest! {
    #![proptest_config(crate::figure::config())]

    #[test]
    fn coefficients(setting in setting(), normal in direction(), length in 1e-3..1e3f64) {
        let distance = normal.dot(&setting.at);
        let numbers = [normal.x * length, normal.y * length, normal.z * length, distance * length];
        let parts = numbers.map(Part::Number).to_vec();
        let plane = found(&Figure::space(GeometryKind::Plane, setting, Turns::None, parts).define().expect("a plane"));
        prop_assert!((plane.normal - normal).norm() < 1e-14);
        through(&setting, &plane, &setting.at)?;
    }

    /// Often nearly in line, often near each other.
    #[test]
    fn three_points(setting in setting(), places in [unit(), unit(), unit()], bulge in narrow(), close in narrow(), travel in travel()) {
        let [first, second, away] = places.map(|at| setting.place(at));
        let third = first + (second - first) * close + (away - first) * (bulge * close.abs());
        let (b, c) = (second - first, third - first);
        prop_assume!(b.norm() > 1e-2 * setting.size && c.norm() > 0.0);
        let sine = b.cross(&c).norm() / (b.norm() * c.norm());
        let nearest = b.norm().min(c.norm()).min((third - second).norm());
        Figure::space(GeometryKind::Plane, setting, Turns::Space, [first, second, third].map(point).to_vec())
            .condition(setting.size / (sine * nearest))
            .hold(
                travel,
                |reason| match reason {
                    Impossible::Collinear => sine <= 1.01e-5,
                    Impossible::Coincident { distance } => *distance <= TOUCHING,
                    _ => false,
                },
                |geometry| {
                    let plane = found(geometry);
                    prop_assert!(plane.normal.dot(&(first - second).cross(&(first - third))) > 0.0);
                    [first, second, third].iter().try_for_each(|place| through(&setting, &plane, place))
                },
            )?;
    }

    #[test]
    fn parallel_through_a_point(setting in setting(), at in unit(), normal in direction(), travel in travel()) {
        let (place, given) = (setting.place(at), Plane::through(setting.at, normal).expect("a normal"));
        let parts = vec![point(place), Part::Word(Modifier::Parallel), plane(given)];
        Figure::space(GeometryKind::Plane, setting, Turns::Space, parts).hold(travel, |_| false, |geometry| {
            let plane = found(geometry);
            prop_assert!((plane.normal - given.normal).norm() < 1e-15);
            through(&setting, &plane, &place)
        })?;
    }

    #[test]
    fn parallel_at_a_distance(setting in setting(), normal in direction(), tilt in narrow(), word in selector(), distance in -1.0..1.0f64, travel in travel()) {
        let mut normal = normal;
        normal[usize::from(distance > 0.0)] *= tilt;
        prop_assume!(normal.norm() > 0.1);
        let given = Plane::through(setting.place([0.3, 0.2, -0.1]), normal).expect("a normal");
        let shift = setting.length(distance);
        let component = toward(word, &given.normal);
        let parts = vec![Part::Word(Modifier::Parallel), plane(given), Part::Word(word), Part::Length(shift)];
        Figure::space(GeometryKind::Plane, setting, Turns::Quarter, parts).condition(component.recip()).hold(
            travel,
            |reason| matches!(reason, Impossible::Undecided { .. }) && component.abs() <= UNDECIDED,
            |geometry| {
                let plane = found(geometry);
                prop_assert!(toward(word, &plane.normal) > 0.0);
                prop_assert!(plane.normal.cross(&given.normal).norm() < 1e-14);
                through(&setting, &plane, &(given.project(&setting.at) + plane.normal * shift))
            },
        )?;
    }

    #[test]
    fn perpendicular_to_a_vector(setting in setting(), at in unit(), normal in direction(), length in 1e-3..1e3f64, travel in travel()) {
        let place = setting.place(at);
        let parts = vec![point(place), Part::Word(Modifier::PerpendicularTo), Part::Entity(Geometry::Vector(normal * length))];
        Figure::space(GeometryKind::Plane, setting, Turns::Space, parts).hold(travel, |_| false, |geometry| {
            let plane = found(geometry);
            prop_assert!((plane.normal - normal).norm() < 1e-14);
            through(&setting, &plane, &place)
        })?;
    }

    /// Both orders of words; the points often nearly above each other on the plane.
    #[test]
    fn perpendicular_to_a_plane(setting in setting(), at in unit(), normal in direction(), way in direction(), lean in narrow(), first_form in any::<bool>(), travel in travel()) {
        let (first, given) = (setting.place(at), Plane::through(setting.at, normal).expect("a normal"));
        let second = first + (given.normal + way * lean) * setting.size;
        let along = (second - first).normalize();
        let sine = along.cross(&given.normal).norm();
        let parts = if first_form {
            vec![Part::Word(Modifier::PerpendicularTo), plane(given), point(first), point(second)]
        } else {
            vec![point(first), point(second), Part::Word(Modifier::PerpendicularTo), plane(given)]
        };
        Figure::space(GeometryKind::Plane, setting, Turns::Space, parts).condition(sine.recip().max(setting.size / (second - first).norm())).hold(
            travel,
            |reason| match reason {
                Impossible::Parallel => sine <= 1.01e-5,
                Impossible::Coincident { distance } => *distance <= TOUCHING,
                _ => false,
            },
            |geometry| {
                let plane = found(geometry);
                through(&setting, &plane, &first)?;
                through(&setting, &plane, &second)?;
                // The normal is known no better than the points let it be.
                let known = 1e-14 + 1e-14 * setting.at.norm() / (setting.size * sine);
                prop_assert!(plane.normal.dot(&given.normal).abs() < 1e-10 + known);
                prop_assert!(plane.normal.dot(&given.normal.cross(&(first - second))) > 0.0);
                Ok(())
            },
        )?;
    }

    #[test]
    fn perpendicular_to_two_planes(setting in setting(), at in unit(), normal in direction(), way in direction(), lean in narrow(), travel in travel()) {
        let place = setting.place(at);
        let planes = [normal, normal + way * lean].map(|normal| Plane::through(setting.at, normal).expect("a normal"));
        let sine = planes[0].normal.cross(&planes[1].normal).norm();
        let parts = vec![point(place), Part::Word(Modifier::PerpendicularTo), plane(planes[0]), plane(planes[1])];
        Figure::space(GeometryKind::Plane, setting, Turns::Space, parts).condition(sine.recip()).hold(
            travel,
            |reason| *reason == Impossible::Parallel && sine <= 1.01e-5,
            |geometry| {
                let plane = found(geometry);
                through(&setting, &plane, &place)?;
                for given in &planes {
                    prop_assert!(plane.normal.dot(&given.normal).abs() < 1e-10, "{:e} at {sine:e}", plane.normal.dot(&given.normal));
                }
                Ok(())
            },
        )?;
    }
}
