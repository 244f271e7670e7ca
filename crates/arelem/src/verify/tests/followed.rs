//! Contacts that are followed along ruled and polyconic surfaces, and bounds of how the slope of a clearance grows.

use std::cell::Cell;

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Remembering},
    parametric::{Mesh, Patch, SculpturedSurface},
    patience::Waiting,
};

use super::{
    super::{
        clearance::{Clearance, Reading, Surface},
        ruling_clearance::searched,
        span::{between, round, turning},
        tool::{Profile, Tool},
    },
    cutter, cylinder,
    lofts::{roof, vault},
    plane, quadric, ruled, section, sphere,
};
use crate::sequence::ToolPosition;

pub(super) const BALL: [f64; 2] = [0.5, 0.25];
pub(super) const FLAT: [f64; 2] = [0.5, 0.0];
pub(super) const BULL: [f64; 2] = [0.5, 0.1];
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

/// A wall between two arcs, of which the upper one is a little flatter.
fn wall() -> Geometry {
    let arc = |y: f64, radius: f64, z: f64| {
        let depth = y - (radius * radius - 16.0f64).sqrt();
        let round = cylinder([0.0, y, 0.0], [0.0, 0.0, 1.0], radius);
        section(round, [[-4.0, depth, z], [4.0, depth, z]], [0.0, -1.0, 0.0])
    };
    ruled(arc(6.0, 9.3, -1.0), arc(7.0, 9.8, 3.0))
}

/// How often one may be asked whether to go on while clearances are shown at ten places: it was up to 520 times.
const ASKED: u32 = 20;

/// A flank that lies along a wall is nearly as near all along: its parts have no contacts of their own.
#[test]
fn a_flank_along_a_twisted_wall_is_measured_in_few_looks() {
    let surface = Surface::of(&wall()).unwrap();
    let Surface::Ruled(wall) = &surface else { panic!("{surface:?}") };
    let profile = Profile::of(&cutter(&BALL)).unwrap();
    // The ruling from x = 1 on the one arc to x = 1 on the other.
    let [low, high] = [(6.0, 9.3, -1.0), (7.0, 9.8, 3.0)]
        .map(|(y, radius, z): (f64, f64, f64)| Vec3::new(1.0, y - (radius * radius - 1.0).sqrt(), z));
    let along = (high - low).normalize();
    let out = Vec3::new(1.0, -6.0, 0.0);
    let outward = (out - along * along.dot(&out)).normalize();
    for tilt in [1e-3, 5e-4, 2e-4, 1e-4] {
        let tool = Tool::new(&profile, (along + outward * tilt).normalize());
        let mut tip = low + along + outward * 0.3;
        for _ in 0..40 {
            tip -= outward * searched(wall, 1.0, &tip, &tool).unwrap().value;
        }
        let asked = Cell::new(0);
        let count = || {
            asked.set(asked.get() + 1);
            false
        };
        let waiting = Waiting::until(&count);
        let tool = Tool { patience: waiting.patience(), ..tool };
        for k in 0..10 {
            let above = 1e-6 * f64::from(k);
            let found = wall.followed(1.0, &(tip + outward * above), &tool).expect("it is shown");
            assert!((found.value - above).abs() <= 5e-3 * above + found.error, "{tilt} {above}: {found:?}");
        }
        assert!(asked.get() <= ASKED, "{tilt}: {}", asked.get());
    }
}

/// One patch with a hill and a saddle beside it.
fn hill_and_saddle() -> Geometry {
    let heights = [[0.0, 0.9, 0.6, 0.3], [1.5, 6.0, 2.0, 1.8], [2.4, 1.5, 6.5, 2.1], [0.6, 1.2, 1.5, 0.0]];
    let patch = Patch::from_points(&std::array::from_fn(|i| {
        std::array::from_fn(|j| Vec3::new(2.0 * i as f64, 1.5 * j as f64, heights[i][j]))
    }));
    let surface = SculpturedSurface::assembled(vec![patch], None, Vec::new(), 1.0, Mesh::default());
    Geometry::Sculptured(Remembering::new(surface))
}

/// There the tool touches inside its bottom, with one side of its rim or the other, and with both at once.
#[test]
fn contacts_of_flat_cutters_that_stand_normal_to_a_patch_are_followed() {
    let surface = Surface::of(&hill_and_saddle()).unwrap();
    let Surface::Ruled(ruled) = &surface else { panic!("{surface:?}") };
    for numbers in [&FLAT[..], &BULL, &SEVEN] {
        let profile = Profile::of(&cutter(numbers)).unwrap();
        for k in 0..40 {
            let end = Vec3::new(0.8 + 0.11 * f64::from(k), 1.2 + 0.05 * f64::from(k), 5.0);
            let normal = surface.point_distance(&end).unwrap().1;
            for lean in [0.0, 0.01, 0.1] {
                let tool = Tool::new(&profile, (normal + Vec3::x() * lean).normalize());
                let mut tip = end;
                for _ in 0..12 {
                    let found = ruled.followed(1.0, &tip, &tool);
                    let found = found.unwrap_or_else(|| panic!("{numbers:?} {k} {lean} {tip}"));
                    tip -= tool.axis * found.value;
                }
                // A little above, in the surface a little, and there.
                for above in [1e-3, -1e-3, 0.0] {
                    let tip = tip + tool.axis * above;
                    let found = ruled.followed(1.0, &tip, &tool);
                    let found = found.unwrap_or_else(|| panic!("{numbers:?} {k} {lean} {above} {tip}"));
                    if k % 8 == 0 && above > 0.0 {
                        let wanted = searched(ruled, 1.0, &tip, &tool).unwrap();
                        let error = found.error + wanted.error;
                        assert!((found.value - wanted.value).abs() <= error, "{found:?} {wanted:?}");
                        assert!(error < 1e-8, "{found:?} {wanted:?}");
                    }
                }
            }
        }
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
    let mut told = 0;
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
        let at = |k: i32| f64::from(k) / f64::from(count);
        let read: Vec<Reading> = (0..=count)
            .map(|k| between(from, to, at(k)).unwrap())
            .map(|p| clearance.at(&p.tip, &p.axis).unwrap())
            .collect();
        let values: Vec<f64> = read.iter().map(|reading| reading.value).collect();
        for v in values.windows(3) {
            let second = (v[0] - 2.0 * v[1] + v[2]) * f64::from(count * count);
            assert!(second <= most + 1e-4, "{geometry:?} {profile:?}: {second} {most}");
        }
        // Where a reading tells a place of the tool, it rises no faster from there than that place does.
        for (k, reading) in (0..).zip(&read) {
            let Some(place) = reading.place else { continue };
            told += 1;
            let slope = reading.normal.dot(&(to.tip - from.tip + round(from, to).cross(&place)));
            for (j, other) in (0..).zip(&read) {
                let way = at(j) - at(k);
                let bound = reading.value + slope * way + 0.5 * most * way * way;
                assert!(
                    other.value <= bound + reading.error + other.error + 1e-9,
                    "{geometry:?} {profile:?} from {k} to {j}: {} {bound}",
                    other.value
                );
            }
        }
    }
    assert!(told >= 200, "{told} places");
}
