//! Bounds of curvature of tabulated, ruled, polyconic and sculptured surfaces against differences of their distances.

use std::{
    cell::Cell,
    sync::{Arc, OnceLock},
};

use nalgebra::SymmetricEigen;
use proptest::prelude::*;

use super::{
    sculptured::tests::{barrel, geometry, hill, roof},
    sheet_tests::{half_pipe, sheets, surface},
    *,
};
use crate::{
    canonical::{Interval, Made, Plane, Remembering, RuledSurface, TabulatedCylinder},
    patience::Waiting,
};

/// How many surfaces [`made`] has.
pub(super) const COUNT: usize = 11;
/// The one with a thickness.
pub(super) const THICK: usize = 3;
/// The one of two flat patches.
const ROOF: usize = COUNT - 1;

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

/// A hill of one patch, a part of a torus, and a roof of two patches.
fn patches() -> [Geometry; 3] {
    let moved = barrel(1.5);
    [geometry(vec![hill()], None, 1.0), geometry(vec![moved], None, 1.0), geometry(roof(), None, 1.0)]
}

/// The sheets, a half pipe, a tabulated cylinder, and sculptured surfaces.
fn geometries() -> impl Iterator<Item = Geometry> {
    sheets().into_iter().chain([half_pipe(), wave()]).chain(patches())
}

/// The same as surfaces.
pub(super) fn made(which: usize) -> &'static Surface {
    static MADE: OnceLock<Vec<Surface>> = OnceLock::new();
    &MADE.get_or_init(|| geometries().map(|g| surface(&g)).collect())[which]
}

#[test]
fn surfaces_are_made_with_questions_and_nothing_is_kept_of_one_that_was_given_up() {
    let asked = Cell::new(0);
    let until = |geometry: &Geometry, last: u32| {
        asked.set(0);
        let ask = || {
            asked.set(asked.get() + 1);
            asked.get() >= last
        };
        let waiting = Waiting::until(&ask);
        Surface::from_geometry_until(geometry, waiting.patience())
    };
    for (which, (geometry, again)) in geometries().zip(geometries()).enumerate() {
        // A tabulated cylinder is not cut, and flat patches are hardly.
        let is_cut = !matches!(geometry, Geometry::TabulatedCylinder(_)) && which != ROOF;
        let whole = until(&geometry, u32::MAX).expect("a surface");
        let all = asked.get();
        assert_eq!(all > 0, is_cut, "surface {which}: {all} questions");
        for last in 1..=all {
            assert_eq!(until(&again, last), Err(SurfaceError::GivenUp), "surface {which}, question {last}");
            assert_eq!(asked.get(), last, "surface {which} asks again after the answer");
        }
        assert_eq!(until(&again, u32::MAX), Ok(whole), "surface {which}");
        assert_eq!(asked.get(), all, "surface {which}");
        assert!(until(&again, 1).is_ok() && asked.get() == 0, "surface {which} is kept");
    }
}

#[test]
fn flanges_of_sculptured_surfaces_are_made_with_questions() {
    for geometry in patches() {
        let surface = surface(&geometry);
        let asked = Cell::new(0);
        let ask = || {
            asked.set(asked.get() + 1);
            true
        };
        let waiting = Waiting::until(&ask);
        assert!(std::ptr::eq(surface.met_from(1.0, waiting.patience()), &raw const surface));
        assert_eq!(asked.get(), 1);
        let met = surface.met_from(1.0, Patience::default());
        assert!(!std::ptr::eq(met, &raw const surface), "nothing was kept of what was given up");
    }
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
        let bend = surface.bend(side, &surface.foot(&center), &region, Patience::default());
        let Bend::AtMost(bound) = bend else { return Ok(()) };
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
}

/// Places about the surfaces, spread evenly.
pub(super) fn places(count: u32) -> impl Iterator<Item = Vec3> {
    (0..count).map(|k| {
        let share = |step: f64| (f64::from(k) * step).fract();
        Vec3::new(5.0 * share(0.819_173), 4.0 * share(0.671_044), 4.0 * share(0.549_7) - 0.5)
    })
}

/// Over a small ball the bound is never below the curvature, and nearly everywhere it comes near the greatest within
/// reach. Where a surface is drawn out to a point its parts stay wider than the ball, and the bounds looser.
#[test]
fn small_regions_have_bounds_near_the_curvature() {
    let radius = 1e-3;
    // What no bound needs to tell from flat.
    let flat = part::FLAT / (part::FINE * radius);
    let eigenvalues = |surface: &Surface, p: &Vec3, side: f64| {
        SymmetricEigen::new(surface.foot_and_hessian(p).1 * side).eigenvalues
    };
    // With a thickness a greater part of the conics is within reach.
    for which in (0..COUNT).filter(|which| *which != THICK) {
        let surface = made(which);
        let (mut bounded, mut near) = (0, 0);
        for (place, side) in places(100).flat_map(|place| [(place, 1.0), (place, -1.0)]) {
            let center = surface.foot(&place).point;
            let region = Region { center, radius, lowest: -radius, highest: radius };
            let Bend::AtMost(bound) =
                surface.bend(side, &surface.foot(&center), &region, Patience::default())
            else {
                continue;
            };
            let here = eigenvalues(surface, &center, side).max();
            assert!(bound >= here * (1.0 - 1e-3) - 1e-8, "{which}: {bound} below {here}");
            let steps = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| axis * (0.5 * radius));
            let around = steps.iter().flat_map(|step| [center + step, center - step, center]);
            let (greatest, size) = around.fold((0.0_f64, 0.0_f64), |(greatest, size), p| {
                let bends = eigenvalues(surface, &p, side);
                (greatest.max(bends.max()), size.max(bends.amax()))
            });
            bounded += 1;
            near += u32::from(bound <= greatest + 0.35 * size + flat);
        }
        assert!(bounded >= 100 && near * 20 >= bounded * 19, "{which}: {near} of {bounded} bounds are near");
    }
}

#[test]
fn nearly_all_places_away_from_edges_have_bounds() {
    for which in 0..COUNT {
        let surface = made(which);
        let mut bounded = 0;
        for near in places(400) {
            let foot = surface.foot(&near);
            let region = Region { center: foot.point, radius: 0.02, lowest: -1e-3, highest: 0.02 };
            bounded += usize::from(matches!(
                surface.bend(1.0, &foot, &region, Patience::default()),
                Bend::AtMost(_)
            ));
        }
        assert!(bounded >= 300, "{which}: only {bounded} of 400 places have a bound");
    }
}

#[test]
fn a_region_about_an_edge_has_no_bound() {
    let cone = made(2);
    let region = Region { center: Vec3::new(0.0, 0.0, 3.0), radius: 0.01, lowest: -0.01, highest: 0.01 };
    assert_eq!(cone.bend(1.0, &cone.foot(&region.center), &region, Patience::default()), Bend::Unbounded);
}

/// Rulings from a line to a point lie in a plane, and their directions change fast near the point: that bends nothing.
#[test]
fn a_flat_fan_of_rulings_is_flat_in_few_parts() {
    let plane = Geometry::Plane(Plane { normal: Vec3::y(), distance: 0.0 });
    let [from, to, apex] = [[-3.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.5, 8.0, 0.0]].map(Vec3::from);
    let parts = vec![
        plane,
        Geometry::Point(from),
        Geometry::Point(to),
        Geometry::Vector(Vec3::y()),
        Geometry::Point(apex),
    ];
    let fan = surface(&Geometry::RuledSurface(Remembering::new(RuledSurface { parts })));
    let center = Vec3::new(0.4, 5.0, 0.1);
    let region = Region { center, radius: 0.2, lowest: -0.1, highest: 0.5 };
    for side in [1.0, -1.0] {
        let bend = fan.bend(side, &fan.foot(&center), &region, Patience::default());
        assert!(matches!(bend, Bend::AtMost(bound) if bound < 1e-3), "{bend:?}");
    }
    let Surface::Ruled(sheet) = &fan else { panic!("not ruled") };
    assert!(Made::parts(&**sheet) < 300, "{} parts", Made::parts(&**sheet));
}
