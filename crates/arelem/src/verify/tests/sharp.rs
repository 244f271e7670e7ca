//! Which side of a sculptured surface a tool is on that is beside a sharp edge or corner of it.

use apt_geometry::parametric::{Mesh, Patch, SculpturedSurface};

use super::*;
use crate::verify::clearance::{Clearance, Surface};
use crate::verify::tool::Profile;

/// Flat patches, each from a corner along two edges, whose product is the natural normal.
fn flat(faces: &[[Vec3; 3]]) -> Surface {
    let patch = |[corner, along, across]: &[Vec3; 3]| {
        Patch::from_points(&std::array::from_fn(|i| {
            std::array::from_fn(|j| corner + (along * i as f64 + across * j as f64) / 3.0)
        }))
    };
    let patches = faces.iter().map(patch).collect();
    let surface = SculpturedSurface::assembled(patches, None, Vec::new(), 1.0, Mesh::default());
    Surface::of(&Geometry::Sculptured(Remembering::new(surface))).expect("a surface")
}

/// A ball of which the place of the surface nearest to it is the origin, in a direction.
fn is_clear_of_origin(surface: &Surface, direction: &Vec3) {
    const RADIUS: f64 = 0.25;
    const APART: f64 = 0.4;
    let profile = Profile::of(&cutter(&[2.0 * RADIUS, RADIUS])).expect("a cutter");
    let tip = direction.normalize() * (RADIUS + APART) - Vec3::z() * RADIUS;
    let found = Clearance::new(surface, &profile, 1.0).at(&tip, &Vec3::z()).expect("a clearance");
    assert!((found.value - APART).abs() < 1e-7, "{found:?} in the direction {direction}");
}

/// Beside the edge of a fin the direction to the tool is nearly square to the one face, and behind the other.
#[test]
fn a_ball_beside_a_fin_is_outside_of_it() {
    let (sin, cos) = 0.2f64.sin_cos();
    let across = Vec3::y() * 6.0;
    for widths in [[3.0, 3.0], [0.6, 3.0], [3.0, 0.6]] {
        let [up, down] = [0, 1].map(|k| Vec3::new([-sin, sin][k], 0.0, -cos) * widths[k]);
        let fin = flat(&[[up - across * 0.5, -up, across], [-across * 0.5, down, across]]);
        for k in -13..=13 {
            let (sin, cos) = (0.1 * f64::from(k)).sin_cos();
            is_clear_of_origin(&fin, &Vec3::new(sin, 0.0, cos));
        }
    }
}

#[test]
fn a_ball_beside_the_tip_of_a_spike_is_outside_of_it() {
    let (sin, cos) = 0.3f64.sin_cos();
    let edges = [0, 1, 2].map(|k| {
        let (y, x) = (std::f64::consts::TAU * f64::from(k) / 3.0).sin_cos();
        Vec3::new(sin * x, sin * y, -cos)
    });
    for lengths in [[3.0; 3], [3.0, 0.6, 0.6], [0.6, 3.0, 3.0]] {
        let edge = |k: usize| edges[k % 3] * lengths[k % 3];
        let spike = flat(&[0, 1, 2].map(|k| [Vec3::zeros(), edge(k), edge(k + 1)]));
        for k in 0..24 {
            let (y, x) = (std::f64::consts::TAU * f64::from(k) / 24.0).sin_cos();
            for height in [0.35, 1.0] {
                is_clear_of_origin(&spike, &Vec3::new(x, y, height));
            }
        }
    }
}
