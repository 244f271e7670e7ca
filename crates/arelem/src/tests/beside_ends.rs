//! Tools that are higher than the sculptured surface beside them.

use apt_geometry::parametric::Patch;

use super::{sculptured::made, *};

/// A wall from z 0 to 4.5 over a curve, which leans towards y as it rises.
fn leaning(lean: f64) -> Geometry {
    let along = [0.3, 1.4, 1.1, 0.4];
    made(vec![Patch::from_points(&std::array::from_fn(|i| {
        std::array::from_fn(|j| v(2.0 * i as f64, along[i] + lean * j as f64, 1.5 * j as f64))
    }))])
}

#[test]
fn look() {
    let surface = apt_geometry::surface::Surface::from_geometry(&leaning(0.25)).expect("a surface");
    let natural = surface.foot(&v(1.0, 4.0, 2.0)).distance.signum();
    for side in [natural, -natural] {
        let gauge = Gauge {
            surface: surface.clone(),
            on: false,
            side,
            thickness: 0.0,
            disk: None,
            memory: Memory::default(),
        };
        let tool = Tool::new(
            apt_geometry::cutter::Cutter::from_numbers(&[0.5, 0.25, 0.0, 0.25, 0.0, 0.0, 12.0], 1.0)
                .expect("a cutter"),
            Vec3::z(),
        );
        for y in [4.0, 3.0, 2.5, 2.3, 2.1, 2.0, 1.9] {
            let t = std::time::Instant::now();
            let (c, missed) = gauge.contact_within(&tool, &v(1.0, y, 1.2));
            eprintln!(
                "{side} {y} {:.6} {:?} {:?} missed {missed:e} {:?}",
                c.clearance,
                c.tool,
                c.surface,
                t.elapsed()
            );
        }
    }
}

#[test]
fn look_flanges() {
    let Geometry::Sculptured(s) = leaning(0.25) else { panic!() };
    let own = apt_geometry::parametric::Extended::of(&s).expect("e");
    let f = apt_geometry::parametric::Flanged::of(&s).expect("f");
    eprintln!("{} {} {}", own.patches().len(), f.patches(1.0).len(), f.patches(-1.0).len());
    for p in &f.patches(-1.0)[own.patches().len()..] {
        eprintln!(
            "{:?} {:?}",
            [
                p.patch.evaluate(0.0, 0.0).position,
                p.patch.evaluate(0.0, 1.0).position,
                p.patch.evaluate(1.0, 0.0).position,
                p.patch.evaluate(1.0, 1.0).position
            ]
            .map(|p| [p.x, p.y, p.z].map(|x| (x * 1000.0).round() / 1000.0)),
            p.sides
        );
    }
}
