//! Tools that touch the end of a sculptured wall lower than they are.

use apt_geometry::parametric::{Mesh, Patch, SculpturedSurface};

use super::*;
use crate::sequence::ToolPosition;
use crate::verify::clearance::{Clearance, Surface};
use crate::verify::tool::Profile;

/// A wall from z 0 to 4.5 over a curve, which leans towards y.
fn leaning_wall() -> Geometry {
    let along = [0.3, 1.4, 1.1, 0.4];
    let patch = Patch::from_points(&std::array::from_fn(|i| {
        std::array::from_fn(|j| Vec3::new(2.0 * i as f64, along[i] + 0.25 * j as f64, 1.5 * j as f64))
    }));
    let surface = SculpturedSurface::assembled(vec![patch], None, Vec::new(), 1.0, Mesh::default());
    Geometry::Sculptured(Remembering::new(surface))
}

/// Positions on a move.
const STEPS: u32 = 40;
/// Where the tool is to be at its beginning.
const CLEARANCE: f64 = 5e-4;
/// Rounding of a second difference.
const NOISE: f64 = 1e-3;

fn bends_as_the_tool_is_round([diameter, corner_radius, corner_offset, corner_height]: [f64; 4]) {
    let leaning = Surface::of(&leaning_wall()).expect("a surface");
    let (alpha, beta, height) = (0.0, 0.0, 12.0);
    let cutter = Cutter { diameter, corner_radius, corner_offset, corner_height, alpha, beta, height };
    let profile = Profile::of(&cutter).expect("a cutter");
    // The side to which the wall leans.
    let clearance = Clearance::new(&leaning, &profile, -1.0);
    let at = |tip: &Vec3| clearance.at(tip, &Vec3::z()).expect("a clearance");
    for k in 0..8 {
        // Up to the wall along y.
        let mut near = Vec3::new(1.0 + 0.5 * f64::from(k), 3.4, 1.2);
        for _ in 0..60 {
            near.y -= at(&near).value - CLEARANCE;
        }
        let way = Vec3::new(0.06, 0.01, 0.0);
        let positions = [near, near + way].map(|tip| ToolPosition { tip, axis: Vec3::z() });
        let ends = positions.map(|position| at(&position.tip));
        let bend = clearance.bend_along(positions.each_ref(), ends.each_ref(), [way.norm(), 0.0]);
        let rate = bend.map(|bend| bend.rate).expect("a bound");
        let step = way.norm() / f64::from(STEPS);
        let value = |i: u32| at(&(near + way * (f64::from(i) / f64::from(STEPS)))).value;
        let values: Vec<f64> = (0..=STEPS).map(value).collect();
        for three in values.windows(3) {
            let second = (three[0] - 2.0 * three[1] + three[2]) / (step * step);
            assert!(second <= rate + NOISE, "{diameter} {corner_radius} at {near}: {second} over {rate}");
        }
    }
}

#[test]
fn beside_an_edge_the_clearance_bends_as_the_tool_is_round() {
    bends_as_the_tool_is_round([0.5, 0.25, 0.0, 0.25]);
    bends_as_the_tool_is_round([0.5, 0.1, 0.15, 0.1]);
}
