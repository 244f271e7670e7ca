//! Bounds of curvature of tabulated, ruled and polyconic surfaces against differences of their distances.

use std::sync::{Arc, OnceLock};

use nalgebra::SymmetricEigen;
use proptest::prelude::*;

use super::{
    sheet_tests::{half_pipe, sheets, surface},
    *,
};
use crate::canonical::{Interval, TabulatedCylinder};

/// How many surfaces [`made`] has.
const COUNT: usize = 8;
/// The one with a thickness.
const THICK: usize = 3;

/// A wave of three cubics, its joints without corners.
fn wave() -> Geometry {
    let row = |u: f64, a: f64, b: f64| Interval { u, v: 0.0, a, b, length: 0.0, maximum: 0.0, minimum: 0.0 };
    Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals: vec![row(-1.0, 0.0, -0.3), row(1.0, 0.0, 0.3), row(3.0, 0.0, -0.3)],
        last: [5.0, 0.0],
    }))
}

/// The sheets, a half pipe, and a tabulated cylinder.
fn made(which: usize) -> &'static Surface {
    static MADE: OnceLock<Vec<Surface>> = OnceLock::new();
    &MADE.get_or_init(|| sheets().into_iter().chain([half_pipe(), wave()]).map(|g| surface(&g)).collect())
        [which]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    /// Along straight lines through a region near the surface the distance stays above its chords by no more than the
    /// bound says.
    #[test]
    fn second_differences_stay_below_the_bound(
        which in 0usize..COUNT, side in prop::bool::ANY, near in prop::array::uniform3(-1.0..6.0f64),
        off in -0.4..0.4f64, radius in 0.01..0.5f64, depth in 0.0..0.8f64, height in 0.0..0.5f64,
        ends in prop::collection::vec(prop::array::uniform6(-1.0..1.0f64), 40),
    ) {
        let surface = made(which);
        let side = if side { 1.0 } else { -1.0 };
        let foot = surface.foot(&Vec3::from(near));
        let center = foot.point + foot.normal * off;
        let region = Region { center, radius, lowest: -depth, highest: height };
        let Bend::AtMost(bound) = surface.bend(side, &surface.foot(&center), &region) else { return Ok(()) };
        let inside = |p: &Vec3| {
            let d = side * surface.signed_distance(p);
            ((p - center).norm() <= radius && d >= -depth && d <= height).then_some(d)
        };
        for e in ends {
            let p = center + Vec3::new(e[0], e[1], e[2]) * radius;
            let q = p + Vec3::new(e[3], e[4], e[5]) * (0.3 * radius);
            let m = (p + q) * 0.5;
            let (Some(a), Some(b), Some(c)) = (inside(&p), inside(&q), inside(&m)) else { continue };
            let length = (q - p).norm();
            let rise = 0.5 * (a + b) - c;
            prop_assert!(rise <= bound * length * length / 8.0 + 1e-10, "{which}: {rise} over {length}, bound {bound}");
        }
    }

    /// Over a small ball the bound comes near the greatest curvature there, on both sides.
    #[test]
    fn small_regions_have_bounds_near_the_curvature(
        which in 0usize..COUNT, near in prop::array::uniform3(-1.0..6.0f64), side in prop::bool::ANY,
    ) {
        let surface = made(which);
        let center = surface.foot(&Vec3::from(near)).point;
        let side = if side { 1.0 } else { -1.0 };
        let (foot, hessian) = surface.foot_and_hessian(&center);
        let eigen = SymmetricEigen::new(hessian * side).eigenvalues;
        // The normal's own direction has none.
        let mut bends: Vec<f64> = eigen.iter().copied().collect();
        bends.sort_by(f64::total_cmp);
        let greatest = bends[2].max(0.0);
        let size = bends[0].abs().max(bends[2].abs());
        let region = Region { center, radius: 1e-5, lowest: -1e-5, highest: 1e-5 };
        if let Bend::AtMost(bound) = surface.bend(side, &foot, &region) {
            prop_assert!(bound >= greatest * (1.0 - 1e-3) - 1e-8, "{which}: {bound} below {greatest}");
            // Where the surface lies off its conics a greater part of them is within reach.
            let high = which != THICK && bound > greatest + 0.35 * size + 1e-2;
            prop_assert!(!high, "{which}: {bound} far above {greatest} of {size}");
        }
    }
}

#[test]
fn nearly_all_places_away_from_edges_have_bounds() {
    for which in 0..COUNT {
        let surface = made(which);
        let mut bounded = 0;
        for k in 0..400 {
            // Low-discrepancy places about the surfaces.
            let share = |step: f64| (f64::from(k) * step).fract();
            let near = Vec3::new(5.0 * share(0.819_173), 4.0 * share(0.671_044), 4.0 * share(0.549_7) - 0.5);
            let foot = surface.foot(&near);
            let region = Region { center: foot.point, radius: 0.02, lowest: -1e-3, highest: 0.02 };
            bounded += usize::from(matches!(surface.bend(1.0, &foot, &region), Bend::AtMost(_)));
        }
        assert!(bounded >= 300, "{which}: only {bounded} of 400 places have a bound");
    }
}

#[test]
fn a_region_about_an_edge_has_no_bound() {
    let cone = made(2);
    let region = Region { center: Vec3::new(0.0, 0.0, 3.0), radius: 0.01, lowest: -0.01, highest: 0.01 };
    assert_eq!(cone.bend(1.0, &cone.foot(&region.center), &region), Bend::Unbounded);
}
