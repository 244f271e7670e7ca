//! Sculptured surfaces against dense samples, exact shapes and difference quotients.

use nalgebra::{Matrix3, Vector4};
use proptest::prelude::*;

use super::*;
use crate::{
    canonical::{Geometry, Remembering},
    parametric::{Mesh, SCULPTURED_BEYOND},
    patience::Patience,
    surface::{RootSelection, Surface},
};

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

fn made(patches: Vec<Patch>, grid: Option<(usize, usize)>, side: f64) -> Surface {
    Surface::from_geometry(&geometry(patches, grid, side)).expect("a surface")
}

pub(in crate::surface) fn geometry(patches: Vec<Patch>, grid: Option<(usize, usize)>, side: f64) -> Geometry {
    let surface = SculpturedSurface::assembled(patches, grid, Vec::new(), side, Mesh::default());
    Geometry::Sculptured(Remembering::new(surface))
}

/// A hill over the rectangle from 0 to 6 and 0 to 4.5.
pub(in crate::surface) fn hill() -> Patch {
    let heights = [[0.0, 0.5, 0.8, 0.2], [0.3, 1.4, 1.1, 0.4], [0.2, 1.2, 1.6, 0.5], [0.1, 0.6, 0.7, 0.0]];
    Patch::from_points(&std::array::from_fn(|i| {
        std::array::from_fn(|j| v(2.0 * i as f64, 1.5 * j as f64, heights[j][i]))
    }))
}

/// A quarter of the unit circle from x to y as a rational cubic.
fn quarter() -> [[f64; 3]; 4] {
    let w = std::f64::consts::FRAC_1_SQRT_2;
    let (third, near) = ((1.0 + 2.0 * w) / 3.0, 2.0 * w / 3.0);
    [
        [1.0, 0.0, 1.0],
        [(1.0 + 2.0 * w) / 3.0, near, third],
        [near, (1.0 + 2.0 * w) / 3.0, third],
        [0.0, 1.0, 1.0],
    ]
}

/// An eighth of a barrel about the z axis, a part of a torus: profile radius 2 about a circle of radius `ring`.
pub(in crate::surface) fn barrel(ring: f64) -> Patch {
    let control = quarter().map(|[c, s, w]| {
        quarter().map(|[x, y, weight]| {
            let r = ring * w + 2.0 * c;
            Vector4::new(r * x, r * y, 2.0 * s * weight, w * weight)
        })
    });
    Patch { control }
}

/// Two flat patches that meet in an edge over x = 2, which stands out upwards.
pub(in crate::surface) fn roof() -> Vec<Patch> {
    let flat = |from: f64, heights: [f64; 2]| {
        Patch::from_points(&std::array::from_fn(|i| {
            let share = i as f64 / 3.0;
            let z = heights[0] + (heights[1] - heights[0]) * share;
            std::array::from_fn(|j| v(from + 2.5 * share, 4.0 * j as f64 / 3.0, z))
        }))
    };
    vec![flat(0.0, [0.0, 1.5]), flat(2.5, [1.5, 0.5])]
}

/// The least distance to the surface by its definition, searched for on finer and finer grids of each patch.
fn searched(patches: &[Patch], p: &Vec3) -> f64 {
    let mut best = f64::INFINITY;
    for patch in patches {
        let (mut center, mut half) = ([0.5; 2], 0.5);
        let mut own = f64::INFINITY;
        for _ in 0..14 {
            let from = center;
            for (i, j) in (-8..=8).flat_map(|i| (-8..=8).map(move |j| (i, j))) {
                let at = [(i, 0), (j, 1)]
                    .map(|(k, side): (i32, usize)| (from[side] + half * f64::from(k) / 8.0).clamp(0.0, 1.0));
                let distance = (patch.evaluate(at[0], at[1]).position - p).norm();
                if distance < own {
                    (own, center) = (distance, at);
                }
            }
            half *= 0.3;
        }
        best = best.min(own);
    }
    best
}

#[test]
fn extensions_go_on_along_the_tangents() {
    let surface = made(vec![hill()], Some((1, 1)), 1.0);
    let at = hill().evaluate(0.0, 0.4);
    let way = at.du / at.du.norm();
    // A little beyond the edge, and a little above it.
    let normal = at.regular_normal().expect("a normal");
    let p = at.position - way * 0.4 + normal * 0.3;
    let foot = surface.foot(&p);
    assert!((foot.distance - 0.3).abs() < 1e-2 && foot.normal.dot(&normal) > 0.99, "{foot:?}");
    let edge = made(vec![hill()], Some((1, 1)), 1.0).foot(&(at.position - way * 1e-9));
    assert!((edge.normal - normal).norm() < 1e-6);
    // They end.
    let size = match geometry(vec![hill()], Some((1, 1)), 1.0) {
        Geometry::Sculptured(surface) => surface.size(),
        _ => panic!("a sculptured surface"),
    };
    let far = surface.foot(&(at.position - way * (3.0 * SCULPTURED_BEYOND * size)));
    assert!(far.distance.abs() > SCULPTURED_BEYOND * size, "{far:?}");
}

#[test]
fn extensions_of_neighbours_join_and_corners_are_filled() {
    let pieces = |patches: Vec<Patch>, grid| {
        SculpturedSurface::assembled(patches, Some(grid), Vec::new(), 1.0, Mesh::default()).extended()
    };
    let [low, high] = hill().cut_u(0.5);
    let one = pieces(vec![hill()], (1, 1));
    // Four sides and four corners.
    assert_eq!(one.len(), 9);
    let ends = |pieces: &[ExtendedPatch]| {
        pieces.iter().flat_map(|piece| piece.sides).filter(|side| *side == Side::End).count()
    };
    assert_eq!(ends(&one), 12);
    let two = pieces(vec![low, high], (2, 1));
    assert_eq!((two.len(), ends(&two)), (12, 14));
    assert!(two.iter().flat_map(|piece| piece.sides).all(|side| !side.is_crease()));
}

#[test]
fn patches_are_turned_to_one_side() {
    // The second patch of the roof with its parameters exchanged.
    let mut patches = roof();
    patches[1] = patches[1].swapped();
    for side in [1.0, -1.0] {
        let surface = made(patches.clone(), None, side);
        for x in [1.0, 4.0] {
            let foot = surface.foot(&v(x, 2.0, 3.0));
            assert!(foot.distance * side > 0.0 && foot.normal.z * side > 0.5, "{foot:?}");
        }
    }
}

#[test]
fn the_edge_of_a_roof_is_round_from_above_and_a_valley_from_below() {
    let surface = made(roof(), Some((2, 1)), 1.0);
    let above = surface.foot(&v(2.5, 2.0, 2.5));
    assert!(
        (above.distance - 1.0).abs() < 1e-12 && (above.point - v(2.5, 2.0, 1.5)).norm() < 1e-12,
        "{above:?}"
    );
    assert!((above.normal - Vec3::z()).norm() < 1e-12);
    let below = surface.foot(&v(2.5, 2.0, 0.5));
    assert!(below.distance < 0.0 && below.distance > -0.99, "{below:?}");
}

#[test]
fn rays_meet_the_surface_where_it_is() {
    let surface = made(vec![hill()], Some((1, 1)), 1.0);
    for (u, w) in [(0.1, 0.2), (0.5, 0.5), (0.93, 0.71)] {
        let at = hill().evaluate(u, w).position;
        for way in [Vec3::z(), v(0.3, -0.2, -1.5)] {
            let root = surface.directed_distance(&(at - way * 2.0), &way, RootSelection::Ahead);
            assert!(root.is_ok_and(|root| (root - 2.0).abs() < 1e-9), "{root:?}");
        }
    }
    // A line over the top meets nothing, one through the barrel twice.
    assert!(surface.directed_distance(&v(3.0, 2.0, 5.0), &Vec3::x(), RootSelection::Nearest).is_err());
    let ball = made(vec![barrel(0.0)], None, 1.0);
    let Surface::Sculptured(sheet) = &ball else { panic!("a sculptured surface") };
    let roots = sheet.ray_roots(&v(1.0, 1.0, 0.0), &Vec3::z());
    assert!(roots.iter().any(|root| (root - 2f64.sqrt()).abs() < 1e-9), "{roots:?}");
}

#[test]
fn a_shifted_curve_has_a_ruling() {
    let arc = hill().control.map(|row| row[1]);
    let up = Vector4::new(0.0, 0.0, 2.0, 0.0);
    let control = arc.map(|c| {
        let c = Vector4::new(c.x, c.y + 0.2 * c.x * c.x, 0.0, c.w);
        std::array::from_fn(|j| c + up * j as f64)
    });
    let wall = made(vec![Patch { control }], Some((1, 1)), 1.0);
    let ruling = wall.common_ruling().expect("a ruling");
    assert!(ruling.cross(&Vec3::z()).norm() < 1e-12);
    assert_eq!(made(vec![hill()], None, 1.0).common_ruling(), None);
}

#[test]
fn what_has_no_extent_is_no_surface() {
    let point = Patch::from_points(&[[v(1.0, 2.0, 3.0); 4]; 4]);
    assert!(Surface::from_geometry(&geometry(vec![point], None, 1.0)).is_err());
    assert!(Surface::from_geometry(&geometry(Vec::new(), None, 1.0)).is_err());
}

#[test]
fn a_pole_is_bounded_like_its_surroundings() {
    use crate::surface::{Bend, Region};
    let ball = made(vec![barrel(0.0)], None, 1.0);
    let pole = v(0.0, 0.0, 2.0);
    let side = ball.foot(&v(0.1, 0.1, 3.0)).distance.signum();
    for off in [0.0, 0.01, 0.2] {
        let center = v(off + 0.05, 0.05, 2.0);
        let region = Region { center, radius: 0.02, lowest: -1e-3, highest: 0.1 };
        let bend = ball.bend(side, &ball.foot(&center), &region, Patience::default());
        assert!(
            matches!(bend, Bend::AtMost(bend) if (0.45..1.0).contains(&bend)),
            "{bend:?} at {off} from {pole}"
        );
    }
    // The vertex of a cone is none.
    let line = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
    let cone = Patch {
        control: line.map(|t| quarter().map(|[x, y, w]| Vector4::new(t * x, t * y, -0.1 * t * w, w))),
    };
    let cone = made(vec![cone], None, 1.0);
    let center = v(0.01, 0.01, 0.0);
    let region = Region { center, radius: 0.02, lowest: -1e-3, highest: 0.05 };
    assert_eq!(cone.bend(1.0, &cone.foot(&center), &region, Patience::default()), Bend::Unbounded);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]
    /// Over the surface itself the foot is the nearest place of all.
    #[test]
    fn feet_are_nearest(which in 0usize..3, u in 0.1..0.9f64, w in 0.1..0.9f64, off in -0.8..0.8f64) {
        let patches = [vec![hill()], vec![barrel(1.5)], roof()][which].clone();
        let at = patches[0].evaluate(u, w);
        let p = at.position + at.regular_normal().expect("a normal") * off;
        let surface = made(patches.clone(), None, 1.0);
        let foot = surface.foot(&p);
        let dense = searched(&patches, &p);
        prop_assert!(foot.distance.abs() <= dense + 1e-9, "{} beyond {dense}", foot.distance);
        // Extensions may be nearer only where the surface is not.
        let extended: Vec<Patch> = match &geometry(patches, None, 1.0) {
            Geometry::Sculptured(surface) => surface.extended().iter().map(|piece| piece.patch).collect(),
            _ => Vec::new(),
        };
        let all = searched(&extended, &p);
        prop_assert!((foot.distance.abs() - all).abs() < 1e-6, "{} and {all}", foot.distance);
        prop_assert!((foot.point - p).norm() - foot.distance.abs() < 1e-9);
    }

    /// A barrel without ring radius is a ball.
    #[test]
    fn a_rational_patch_is_exactly_round(azimuth in 0.1..1.4f64, height in 0.1..1.3f64, off in -1.0..2.0f64) {
        let out = v(azimuth.cos() * height.cos(), azimuth.sin() * height.cos(), height.sin());
        let surface = made(vec![barrel(0.0)], None, 1.0);
        let p = out * (2.0 + off);
        let (foot, hessian) = surface.foot_and_hessian(&p);
        prop_assert!((foot.distance.abs() - off.abs()).abs() < 1e-10, "{} {off}", foot.distance);
        let side = foot.normal.dot(&out);
        prop_assert!(side.abs() > 1.0 - 1e-10);
        let bend = 1.0 / (2.0 + off);
        prop_assert!((hessian * side - (Matrix3::identity() - out * out.transpose()) * bend).norm() < 1e-6);
    }

    /// Steps over joints go on the surface as they would without them.
    #[test]
    fn steps_cross_joints(u in 0.3..0.49f64, w in 0.2..0.8f64, step in 0.02..0.1f64) {
        let [low, high] = hill().cut_u(0.5);
        let joined = made(vec![low, high], Some((2, 1)), 1.0);
        let place = joined.place(&hill().evaluate(u, w).position).expect("a place");
        let there = joined.shifted(&place, [2.0 * (0.5 - u + step), 0.01]).expect("a place beyond");
        let found = joined.chart(&there).expect("a chart").point;
        let wanted = hill().evaluate(0.5 + step, w + 0.01).position;
        prop_assert!((found - wanted).norm() < 0.1 * step, "{found} {wanted}");
    }
}

/// Parts about a pole are cut by their length, not into slivers that all reach as far from it.
#[test]
fn few_parts_tell_of_what_is_beside_a_pole() {
    let surface = made(vec![barrel(0.0)], Some((1, 1)), 1.0);
    let Surface::Sculptured(sheet) = &surface else { panic!("a sculptured surface") };
    let mut steady = 0;
    for (away, along) in (1..=8).flat_map(|away| (1..8).map(move |along| (away, along))) {
        let [polar, azimuth] = [0.04 * f64::from(away), 0.2 * f64::from(along)];
        let out = v(polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos());
        let center = out * 2.2;
        let side = surface.signed_distance(&center).signum();
        steady += usize::from(surface.steady(side, &center, [0.25, 0.01], Patience::default()).is_some());
    }
    assert!(steady > 20, "{steady} of 56 balls are steady");
    assert!(sheet.parts.get() < 1_500, "{} parts", sheet.parts.get());
}
