//! Contacts that are followed along ruled and polyconic surfaces, and bounds of how the slope of a clearance grows.

use apt_geometry::{Vec3, canonical::Geometry};

use super::{
    super::{
        clearance::{Clearance, Surface},
        ruling_clearance::searched,
        span::{between, turning},
        tool::{Profile, Tool},
    },
    cutter, cylinder,
    lofts::{roof, vault},
    plane, quadric, sphere,
};
use crate::sequence::ToolPosition;

const BALL: [f64; 2] = [0.5, 0.25];
const FLAT: [f64; 2] = [0.5, 0.0];
const BULL: [f64; 2] = [0.5, 0.1];
const SEVEN: [f64; 7] = [0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0];

fn saddle() -> Geometry {
    quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5])
}

#[test]
fn contacts_are_followed_and_are_those_of_the_search() {
    for (geometry, side, tool) in [
        (roof(), 1.0, &BALL[..]),
        (roof(), 1.0, &FLAT),
        (roof(), 1.0, &BULL),
        (roof(), 1.0, &SEVEN),
        (vault(), -1.0, &BULL),
        (vault(), -1.0, &FLAT),
        (vault(), -1.0, &BALL),
        (vault(), -1.0, &SEVEN),
    ] {
        let surface = Surface::of(&geometry).unwrap();
        let Surface::Ruled(ruled) = &surface else { panic!("{geometry:?}") };
        let profile = Profile::of(&cutter(tool)).unwrap();
        let tool = Tool::new(&profile, Vec3::z());
        let mut tip = Vec3::new(-0.6, 0.4, 5.0);
        for _ in 0..60 {
            tip.z -= searched(ruled, side, &tip, &tool).unwrap().value;
        }
        let mut followed = 0;
        for k in 0..30 {
            tip.x += 0.02;
            let Some(found) = ruled.followed(side, &tip, &tool) else { continue };
            followed += 1;
            if k % 6 == 0 {
                let wanted = searched(ruled, side, &tip, &tool).unwrap();
                let error = found.error + wanted.error + 2.0 * ruled.error();
                assert!((found.value - wanted.value).abs() <= error, "{k}: {found:?} {wanted:?}");
                assert!(error < 1e-6, "{found:?} {wanted:?}");
            }
            tip.z -= found.value;
        }
        assert!(followed >= 28, "{followed} of 30: {profile:?} {side}");
    }
}

#[test]
fn the_slope_of_a_clearance_grows_no_faster_than_its_bound() {
    let surfaces = [
        (plane([0.1, 0.2, 1.0], 0.5), 1.0),
        (sphere([0.0, 0.0, -3.0], 3.0), 1.0),
        (sphere([0.0, 0.0, 6.0], 6.0), -1.0),
        (cylinder([0.0, 0.0, -3.0], [0.2, 1.0, 0.1], 3.0), 1.0),
        (saddle(), 1.0),
        (quadric([1.0 / 16.0, 1.0 / 9.0, 0.25, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 1.0),
        (roof(), 1.0),
        (vault(), -1.0),
    ];
    for ((geometry, side), tool) in surfaces.iter().flat_map(|s| [BALL, FLAT, BULL].map(|tool| (s, tool))) {
        let surface = Surface::of(geometry).unwrap();
        let mut numbers = cutter(&tool);
        numbers.height = 1.0;
        let profile = Profile::of(&numbers).unwrap();
        let clearance = Clearance { raise: 0.1, ..Clearance::new(&surface, &profile, *side) };
        let place = |x: f64, lean: f64| {
            let axis = Vec3::new(lean, 0.1, 1.0).normalize();
            let mut tip = Vec3::new(x, 0.5, 6.0);
            if *side < 0.0 && matches!(geometry, Geometry::Sphere(_)) {
                tip.z = 3.0;
            }
            for _ in 0..60 {
                tip.z -= clearance.at(&tip, &axis).unwrap().value;
            }
            ToolPosition { tip, axis }
        };
        let ends = [place(0.5, 0.0), place(0.6, 0.08)];
        let [from, to] = &ends;
        let readings = ends.map(|p| clearance.at(&p.tip, &p.axis).unwrap());
        let turn = turning(from, to);
        let swing = turn * clearance.reach();
        let travel = (to.tip - from.tip).norm() + swing;
        let bend = clearance.bend_along([from, to], [&readings[0], &readings[1]], [travel, 0.0]);
        let bend = bend.unwrap_or_else(|| panic!("{geometry:?} {profile:?}"));
        let most = bend.rate * travel * travel + turn * swing;
        let count = 40;
        let values: Vec<f64> = (0..=count)
            .map(|k| between(from, to, f64::from(k) / f64::from(count)).unwrap())
            .map(|p| clearance.at(&p.tip, &p.axis).unwrap().value)
            .collect();
        for v in values.windows(3) {
            let second = (v[0] - 2.0 * v[1] + v[2]) * f64::from(count * count);
            assert!(second <= most + 1e-4, "{geometry:?} {profile:?}: {second} {most}");
        }
    }
}
