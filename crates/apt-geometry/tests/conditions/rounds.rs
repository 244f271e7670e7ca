//! CYLNDR, CONE and SPHERE.

use apt_geometry::Vec3;
use apt_geometry::canonical::{Geometry, GeometryKind, Plane, Sphere};
use apt_geometry::definition::{Impossible, Modifier};
use proptest::prelude::*;

use crate::figure::{Figure, Part, Setting, Turns, Verdict, narrow, plane, point, setting, travel, unit};

fn sphere(geometry: &Geometry) -> Sphere {
    match geometry {
        Geometry::Sphere(sphere) => *sphere,
        other => panic!("{other:?} is no sphere"),
    }
}

fn goes_through(setting: &Setting, sphere: &Sphere, place: &Vec3) -> Verdict {
    let far = sphere.center + (place - sphere.center) * 2.0;
    setting.holds("through the place", (place - sphere.center).norm() - sphere.radius, &far)
}

proptest! {
    #![proptest_config(crate::figure::config())]

    #[test]
    fn cylinders(setting in setting(), at in unit(), axis in unit(), length in 1e-2..1e3f64, radius in 1e-3..1.0f64, form in 0..4usize, travel in travel()) {
        let axis = Vec3::from(axis);
        prop_assume!(axis.norm() > 0.1);
        let (place, vector, radius) = (setting.place(at), axis * length, setting.length(radius));
        let mut parts = if form / 2 == 0 { vec![Part::Place(place, 3)] } else { vec![point(place)] };
        parts.push(if form % 2 == 0 { Part::Components(vector) } else { Part::Entity(Geometry::Vector(vector)) });
        parts.push(Part::Length(radius));
        Figure::space(GeometryKind::Cylinder, setting, Turns::Space, parts).hold(travel, |_| false, |geometry| {
            let Geometry::Cylinder(cylinder) = geometry else { panic!("no cylinder") };
            prop_assert_eq!((cylinder.point, cylinder.radius), (place, radius));
            prop_assert!((cylinder.axis - axis.normalize()).norm() < 1e-14);
            Ok(())
        })?;
    }

    #[test]
    fn cones(setting in setting(), at in unit(), axis in unit(), degrees in 0.01..89.99f64, around in -3.0..3.0f64, travel in travel()) {
        let axis = Vec3::from(axis);
        prop_assume!(axis.norm() > 0.1);
        let vertex = setting.place(at);
        let parts = vec![point(vertex), Part::Entity(Geometry::Vector(axis)), Part::Number(degrees)];
        Figure::space(GeometryKind::Cone, setting, Turns::Space, parts).hold(travel, |_| false, |geometry| {
            let Geometry::Cone(cone) = geometry else { panic!("no cone") };
            prop_assert_eq!(cone.vertex, vertex);
            // A ray at the half angle lies on the cone.
            let across = axis.cross(&Vec3::new(axis.y, axis.z, axis.x + 2.0)).normalize();
            let across = across * around.cos() + axis.normalize().cross(&across) * around.sin();
            let half = degrees.to_radians();
            let ray = axis.normalize() * half.cos() + across * half.sin();
            prop_assert!((ray.dot(&cone.axis) - cone.cosine).abs() < 1e-14);
            Ok(())
        })?;
    }

    #[test]
    fn spheres_by_center_and_radius(setting in setting(), at in unit(), radius in 1e-3..1.0f64, form in 0..3usize, travel in travel()) {
        let (center, radius) = (setting.place(at), setting.length(radius));
        let parts = match form {
            0 => vec![Part::Place(center, 3), Part::Length(radius)],
            1 => vec![point(center), Part::Length(radius)],
            _ => vec![Part::Word(Modifier::Center), point(center), Part::Word(Modifier::Radius), Part::Length(radius)],
        };
        Figure::space(GeometryKind::Sphere, setting, Turns::Space, parts).hold(travel, |_| false, |geometry| {
            prop_assert_eq!(sphere(geometry), Sphere { center, radius });
            Ok(())
        })?;
    }

    #[test]
    fn spheres_about_a_center(setting in setting(), places in [unit(), unit()], normal in unit(), close in narrow(), touching in any::<bool>(), travel in travel()) {
        let normal = Vec3::from(normal);
        prop_assume!(normal.norm() > 0.1);
        let center = setting.place(places[0]);
        let other = center + Vec3::from(places[1]) * (setting.size * close);
        let given = Plane::through(other, normal).expect("a normal");
        let radius = if touching { given.signed_distance(&center).abs() } else { (other - center).norm() };
        let mut parts = vec![Part::Word(Modifier::Center), point(center)];
        if touching {
            parts.extend([Part::Word(Modifier::TangentTo), plane(given)]);
        } else {
            parts.push(point(other));
        }
        Figure::space(GeometryKind::Sphere, setting, Turns::Space, parts).condition(setting.size / radius).hold(
            travel,
            |_| false,
            |geometry| {
                let sphere = sphere(geometry);
                prop_assert_eq!(sphere.center, center);
                setting.holds("radius", sphere.radius - radius, &center)
            },
        )?;
    }

    /// Four points, often nearly in one plane.
    #[test]
    fn spheres_through_four_points(setting in setting(), places in [unit(), unit(), unit(), unit()], flat in narrow(), travel in travel()) {
        let [first, second, third, away] = places.map(|at| setting.place(at));
        let fourth = first + (second - first) * 0.7 - (third - first) * 0.6 + (away - first) * flat;
        let points = [first, second, third, fourth];
        let sides = [second, third, fourth].map(|place| place - first);
        prop_assume!(sides.iter().all(|side| side.norm() > 0.02 * setting.size));
        let units = sides.map(|side| side.normalize());
        let volume = units[0].cross(&units[1]).dot(&units[2]);
        let least = sides.iter().fold(f64::INFINITY, |least, side| least.min(side.norm()));
        let condition = (setting.size / least) * volume.recip().abs().powi(2);
        Figure::space(GeometryKind::Sphere, setting, Turns::Space, points.map(point).to_vec()).condition(condition).hold(
            travel,
            |reason| *reason == Impossible::Singular && volume.abs() <= 1.01e-5,
            |geometry| {
                let sphere = sphere(geometry);
                points.iter().try_for_each(|place| goes_through(&setting, &sphere, place))
            },
        )?;
    }
}
