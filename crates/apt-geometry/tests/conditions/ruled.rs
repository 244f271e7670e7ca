//! RLDSRF: the parts of the definition and the directions across the chords; POLCON by its canonical values.

use apt_geometry::Vec3;
use apt_geometry::canonical::{Geometry, GeometryKind, Plane, RuledEnd};
use apt_geometry::definition::{DefinitionError, Modifier};
use proptest::prelude::*;

use crate::figure::{Figure, Part, Turns, narrow, plane, point, setting, travel, unit};

proptest! {
    #![proptest_config(crate::figure::config())]

    /// One curve with a point or a vector across its chord, and a second curve or an apex.
    #[test]
    fn curves_and_ends(
        setting in setting(), places in [unit(), unit(), unit(), unit()], lean in narrow(), by_vector in any::<bool>(), apex in any::<bool>(), travel in travel(),
    ) {
        let [start, end, third, last] = places.map(|at| setting.place(at));
        let chord = end - start;
        prop_assume!(chord.norm() > 0.1 * setting.size);
        // Often nearly in line with the chord.
        let third = start + chord * 0.4 + (third - start) * lean;
        let toward = third - start;
        let sine = chord.cross(&toward).norm() / (chord.norm() * toward.norm());
        let given = Plane::through(start, chord.cross(&(last - start)) + Vec3::new(1e-3, 0.0, 2e-3)).expect("a normal");
        let side = if by_vector { Part::Entity(Geometry::Vector(toward)) } else { point(third) };
        let curve = vec![plane(given), point(start), point(end), side];
        let mut parts = curve.clone();
        if apex {
            parts.push(point(last));
        } else {
            parts.extend(curve);
        }
        let figure = Figure::space(GeometryKind::RuledSurface, setting, Turns::Space, parts).condition(sine.recip() * 10.0);
        match figure.define() {
            Ok(_) => {}
            Err(DefinitionError::Special { number: 701, .. }) => {
                prop_assert!(chord.norm_squared() <= 1.01e-4);
                return Ok(());
            }
            Err(DefinitionError::Special { number: 702, .. }) => {
                let in_line = if by_vector { sine * sine <= 1.01e-2 } else { sine <= 1.01e-5 };
                prop_assert!(in_line);
                return Ok(());
            }
            Err(other) => return Err(TestCaseError::fail(format!("{other:?}"))),
        }
        // The shortest chord and the flattest vector are lengths and angles of the language: stay away from them.
        let comfortable = chord.norm() > 0.5 && (!by_vector || sine > 0.2);
        let check = |geometry: &Geometry| {
            let Geometry::RuledSurface(surface) = geometry else { panic!("no ruled surface") };
            let (curve, other) = surface.curves().expect("the parts of a definition");
            prop_assert_eq!((curve.start, curve.end), (start, end));
            let across = curve.across;
            prop_assert!((across.norm() - 1.0).abs() < 1e-14);
            // In the plane of the chord and the third place, on its side; at a right angle when a point was given.
            let off = across.dot(&chord.cross(&toward)) / (chord.norm() * toward.norm() * sine);
            prop_assert!(off.abs() < 1e-10, "off the cutting plane by {off:e} at {sine:e}");
            prop_assert!(across.dot(&toward) > 0.0);
            if by_vector {
                prop_assert!((across - toward.normalize()).norm() < 1e-14);
            } else {
                prop_assert!(across.dot(&chord.normalize()).abs() < 1e-10, "{:e}", across.dot(&chord.normalize()));
            }
            match other {
                RuledEnd::Apex(place) => prop_assert!(apex && place == last),
                RuledEnd::Curve(second) => prop_assert!(!apex && second.start == start),
            }
            Ok(())
        };
        if comfortable {
            figure.hold(travel.enlarging(), |_| false, check)?;
        } else {
            check(&figure.define().expect("defined above"))?;
        }
    }

    /// POLCON takes its 79 canonical values as they are.
    #[test]
    fn poly_conics(values in prop::collection::vec(-1e3..1e3f64, 79)) {
        let mut parts = vec![Part::Word(Modifier::Canon)];
        parts.extend(values.iter().copied().map(Part::Number));
        let setting = crate::figure::Setting { at: Vec3::zeros(), size: 1.0 };
        let geometry = Figure::space(GeometryKind::PolyConic, setting, Turns::None, parts).define().expect("a surface");
        prop_assert_eq!(geometry.canonical_values(), values);
    }
}
