//! Clearances where planes, axes, rulings and ends of tools coincide, as those of drawings with round numbers do.

use apt_geometry::{Vec3, canonical::Geometry, cutter::Cutter};
use proptest::{prelude::*, sample::select};

use super::{
    super::{
        clearance::{Clearance, Reading, Surface},
        tool::Profile,
    },
    cone, cutter, cylinder, plane, quadric, sphere,
};

/// Places of a meridian and azimuths at which a tool is looked at.
const HEIGHTS: u32 = 24;
const AZIMUTHS: u32 = 96;

/// Places all over the boundary of a tool but the disc at its top, which surfaces need not touch.
fn places(tool: &Cutter, tip: &Vec3, axis: &Vec3) -> Vec<Vec3> {
    let profile = Profile::of(tool).expect("a tool");
    let along = |k: u32| f64::from(k) / f64::from(HEIGHTS);
    let mut meridian: Vec<[f64; 2]> = Vec::new();
    for (a, b) in profile.lines() {
        meridian.extend((0..=HEIGHTS).map(|k| [0, 1].map(|i| a[i] + along(k) * (b[i] - a[i]))));
    }
    if let Some((center, radius)) = profile.corner() {
        let arc = (0..=4 * HEIGHTS).map(|k| (along(k) * 0.5 * std::f64::consts::PI).sin_cos());
        let held = arc.filter(|(sin, cos)| profile.fan_holds([*sin, -*cos]));
        meridian.extend(held.map(|(sin, cos)| [center[0] + radius * sin, center[1] - radius * cos]));
    }
    let across = super::super::tool::perpendicular(axis);
    let other = axis.cross(&across);
    let turned = |k: u32, m: &[f64; 2]| {
        let (sin, cos) = (f64::from(k) / f64::from(AZIMUTHS) * std::f64::consts::TAU).sin_cos();
        tip + (across * cos + other * sin) * m[0] + axis * m[1]
    };
    meridian.iter().flat_map(|m| (0..AZIMUTHS).map(move |k| turned(k, m))).collect()
}

fn level() -> impl Strategy<Value = f64> {
    select(vec![-5.0, -2.0, -1.0, -0.5, 0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 5.0])
}

fn round_direction() -> impl Strategy<Value = [f64; 3]> {
    select(vec![
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, -1.0],
        [0.6, 0.8, 0.0],
        [0.0, 0.6, 0.8],
        [0.5, 0.0, 0.75_f64.sqrt()],
        [0.75_f64.sqrt(), 0.0, 0.5],
    ])
}

fn surfaces() -> impl Strategy<Value = Geometry> {
    let place = || [level(), level(), level()];
    prop_oneof![
        (round_direction(), level()).prop_map(|(normal, distance)| plane(normal, distance)),
        (place(), select(vec![0.5, 1.0, 2.0, 5.0])).prop_map(|(at, radius)| sphere(at, radius)),
        (place(), round_direction(), select(vec![0.25, 0.5, 1.0, 2.0, 5.0]))
            .prop_map(|(at, axis, radius)| cylinder(at, axis, radius)),
        (place(), round_direction(), select(vec![30.0, 45.0, 60.0, 53.130_102_354_155_98, 10.0]))
            .prop_map(|(at, axis, angle)| cone(at, axis, angle)),
        (
            prop::array::uniform3(select(vec![-1.0, -0.25, 0.0, 0.25, 1.0])),
            prop::array::uniform3(select(vec![0.0, 0.0, 0.5])),
            prop::array::uniform3(select(vec![0.0, 0.0, -0.5, 0.5])),
            select(vec![-1.0, -0.25, 0.25]),
        )
            .prop_map(|([a, b, c], [f, g, h], [p, q, r], d)| quadric([a, b, c, d, f, g, h, p, q, r])),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// No place of the tool is nearer than it is told to be, on either side of the surface.
    #[test]
    fn no_place_of_a_tool_is_nearer_than_its_clearance(
        tool in select(vec![
            cutter(&[1.0, 0.5]),
            cutter(&[1.0, 0.0]),
            cutter(&[1.0, 0.25]),
            cutter(&[2.0, 0.0, 1.0, 0.0, 0.0, 30.0, 2.0]),
            cutter(&[2.0, 0.0, 1.0, 0.0, 45.0, 0.0, 2.0]),
            cutter(&[1.0, 0.25, 0.25, 0.25, 0.0, 0.0, 1.0]),
        ]),
        tip in [level(), level(), level()],
        axis in round_direction(),
        geometry in surfaces(),
        outside in any::<bool>(),
    ) {
        let Ok(surface) = Surface::of(&geometry) else { return Ok(()) };
        let side = if outside { 1.0 } else { -1.0 };
        let unit = Vec3::from(axis).normalize();
        let tip = Vec3::from(tip);
        let distances: Option<Vec<f64>> = places(&tool, &tip, &unit)
            .iter()
            .map(|place| Some(side * surface.point_distance(place)?.0))
            .collect();
        let Some(distances) = distances else { return Ok(()) };
        let nearest = distances.into_iter().fold(f64::INFINITY, f64::min);
        let profile = Profile::of(&tool).expect("a tool");
        // Where two planes cross that are one quadric there is no clearance.
        let Some(reading) = Clearance::new(&surface, &profile, side).at(&tip, &unit) else { return Ok(()) };
        let Reading { value, normal, error, .. } = reading;
        // How deep it is is no question of tolerance where it is deep.
        let close = if nearest < -0.1 { 0.5 * nearest.abs() } else { 1e-9 };
        prop_assert!(value - error <= nearest + close, "{} ± {} nearest {}", value, error, nearest);
        prop_assert!((normal.norm() - 1.0).abs() < 1e-9, "{}", normal);
        // The places looked at are not far from the nearest, but where the disc at the top may be that.
        let is_top = normal.dot(&unit) < -1.0 + 1e-9;
        prop_assert!(value <= 0.0 || is_top || nearest - value < 0.05, "{} ± {} nearest {}", value, error, nearest);
    }
}
