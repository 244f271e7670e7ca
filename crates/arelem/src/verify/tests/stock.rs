//! Stock below zero: the tool is meant to be deeper in the surface than any tolerance.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Interval, TabulatedCylinder},
};

use super::{
    super::{
        clearance::{Clearance, Surface},
        tool::Profile,
    },
    cutter,
    lofts::{roof, vault},
};

/// Tables along y: a hill about x = 0 and the roof and the vault of the bench.
fn hills() -> [(Geometry, f64); 3] {
    let row = |u: f64, b: f64| Interval { u, v: 2.0, a: 0.0, b, length: 0.0, maximum: 0.0, minimum: 0.0 };
    let hill = TabulatedCylinder {
        axes: [Vec3::x(), Vec3::z(), -Vec3::y()],
        kind: 0.0,
        intervals: vec![row(-3.0, 0.1), row(-1.0, -0.2), row(1.0, 0.1)],
        last: [3.0, 2.0],
    };
    [(Geometry::TabulatedCylinder(Arc::new(hill)), 1.0), (roof(), 1.0), (vault(), -1.0)]
}

/// A ball is as deep as its centre is near.
#[test]
fn a_ball_is_as_deep_as_its_stock_below_zero_lets_it() {
    let (radius, depths) = (0.25, [0.01, 0.03, 0.06, 0.1]);
    let profile = Profile::of(&cutter(&[2.0 * radius, radius])).unwrap();
    for (geometry, side) in hills() {
        let surface = Surface::of(&geometry).unwrap();
        for depth in depths {
            let clearance = Clearance { thickness: -depth, ..Clearance::new(&surface, &profile, side) };
            for k in 0..7 {
                let at = Vec3::new(-0.9 + 0.3 * f64::from(k), 0.4, 0.0);
                let mut center = at + Vec3::z() * 5.0;
                for _ in 0..60 {
                    center.z -= side * surface.point_distance(&center).unwrap().0 - (radius - depth);
                }
                let tip = center - Vec3::z() * radius;
                let reading = clearance.at(&tip, &Vec3::z()).unwrap();
                assert!(reading.error < 1e-6, "{geometry:?} {depth} {k}: {reading:?}");
                assert!(reading.value.abs() <= reading.error + 1e-9, "{geometry:?} {depth} {k}: {reading:?}");
            }
        }
    }
}
