//! Contact within straight pieces of the tool, and tools whose top a solid reaches into.

use apt_geometry::{Vec3, canonical::Geometry, cutter::Cutter};
use proptest::prelude::*;

use super::{
    super::{
        clearance::{Clearance, Reading, Shape, Surface},
        tool::Profile,
    },
    clearances::samples,
    cutter, quadric,
};

/// An ellipsoid, a bowl z ≥ x²/2 + y²/3, and a parabolic cylinder across no axis.
fn solids() -> [Geometry; 3] {
    [
        quadric([0.16, 0.25, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        quadric([0.5, 1.0 / 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5]),
        quadric([0.4, 0.1, 0.0, 0.0, 0.0, 0.0, 0.2, 0.05, 0.1, -0.5]),
    ]
}

fn straight_tools() -> [Cutter; 5] {
    [
        cutter(&[1.1, 0.0, 0.55, 0.33, 31.0, 0.0, 4.5]),
        cutter(&[0.8, 0.3]),
        cutter(&[0.5, 0.0, 0.25, 0.0, 0.0, 12.0, 2.0]),
        cutter(&[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 3.0]),
        cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.3]),
    ]
}

fn read(geometry: &Geometry, tool: &Cutter, tip: &Vec3, axis: &Vec3) -> (Reading, Shape) {
    let (surface, profile) = (Surface::of(geometry).unwrap(), Profile::of(tool).unwrap());
    let clearance = Clearance::new(&surface, &profile, 1.0);
    (clearance.at(tip, axis).unwrap(), clearance.shape_along([tip, tip], axis))
}

fn sampled(geometry: &Geometry, tool: &Cutter, tip: &Vec3, axis: &Vec3) -> f64 {
    let surface = Surface::of(geometry).unwrap();
    let distances = samples(tool, *tip, *axis);
    distances.iter().map(|x| surface.point_distance(x).unwrap().0).fold(f64::INFINITY, f64::min)
}

/// A tool laid against a solid with a place of a straight piece of it, so far away, where the solid is nearest to a place; leaning. None where a
/// piece is level, or the place is in the solid.
fn laid_against(
    geometry: &Geometry,
    [from, to]: [[f64; 2]; 2],
    share: f64,
    aim: &Vec3,
    lean: [f64; 2],
    clear: f64,
) -> Option<(Vec3, Vec3)> {
    let (distance, normal) = Surface::of(geometry).unwrap().point_distance(aim)?;
    let foot = aim - normal * distance;
    let (spread, rise) = (to[0] - from[0], to[1] - from[1]);
    let outward = [rise, -spread].map(|x| x / spread.hypot(rise));
    if distance <= 0.0 || outward[0] <= 1e-6 {
        return None;
    }
    // −normal = outward across the axis and along it.
    let across = normal.cross(&Vec3::new(lean[0], lean[1], 1.0)).normalize();
    let third = across.cross(&normal);
    let axis = (-normal * outward[1] + third * outward[0]).normalize();
    let radial = (-normal - axis * outward[1]) / outward[0];
    let at = [from[0] + share * spread, from[1] + share * rise];
    Some((foot + normal * clear - radial * at[0] - axis * at[1], axis))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Beside the point of a drill lines out of it in nearly all directions are as near as it is.
    #[test]
    fn contact_beside_the_point_of_a_drill_is_proven_to_rounding(
        solid in 0usize..4, power in 1.0..6.0f64, round in 0.0..std::f64::consts::TAU, height in -1.5..1.5f64,
        clear in 1e-6..0.05f64, lean in prop::array::uniform2(-0.3..0.3f64),
    ) {
        let bodies = quadric([0.4, 0.5, -0.3, 0.2, 0.0, 0.0, 0.1, 0.0, 0.05, 0.1]);
        let geometry = &solids().into_iter().chain([bodies]).nth(solid).unwrap();
        let tool = &cutter(&[0.8, 0.0, 0.4, 0.24, 31.0, 0.0, 2.4]);
        let [bottom, ..] = Profile::of(tool).unwrap().edges();
        let aim = Vec3::new(3.0 * round.cos(), 3.0 * round.sin(), height);
        let laid = laid_against(geometry, [[0.0; 2], bottom], 10f64.powf(-power), &aim, lean, clear);
        prop_assume!(laid.is_some());
        let (tip, axis) = laid.unwrap();
        let (reading, _) = read(geometry, tool, &tip, &axis);
        // The other body of the last may be nearer.
        prop_assert!(reading.value - clear < 1e-9, "{} for {clear}", reading.value);
        prop_assert!(reading.error < 1e-9, "error {}", reading.error);
    }

    /// A tool beside a convex solid, so that its straight pieces touch: what the bound leaves open is rounding.
    #[test]
    fn contact_within_a_straight_piece_is_proven_to_rounding(
        solid in 0usize..3, tool in 0usize..5, share in 0.0..1.0f64, round in 0.0..std::f64::consts::TAU,
        place in prop::array::uniform2(-0.8..0.8f64), lower in any::<bool>(), clear in 1e-6..0.05f64,
        lean in prop::array::uniform2(-0.3..0.3f64),
    ) {
        let (geometry, tool) = (&solids()[solid], &straight_tools()[tool]);
        let profile = Profile::of(tool).unwrap();
        let [bottom, upper, top] = profile.edges();
        let (from, to) = if lower { ([0.0; 2], bottom) } else { (upper, top) };
        prop_assume!((to[0] - from[0]).hypot(to[1] - from[1]) > 1e-9);
        let aim = Vec3::new(3.0 * round.cos(), 3.0 * round.sin(), place[0]) + Vec3::z() * place[1];
        let laid = laid_against(geometry, [from, to], share, &aim, lean, clear);
        prop_assume!(laid.is_some());
        let (tip, axis) = laid.unwrap();
        let (reading, _) = read(geometry, tool, &tip, &axis);
        prop_assert!((reading.value - clear).abs() < 1e-10, "{} for {clear}", reading.value);
        prop_assert!(reading.error < 1e-10, "error {}", reading.error);
    }

    /// A tool below a solid, or with the solid's lowest place in its top.
    #[test]
    fn nothing_touches_the_disc_at_the_top(
        solid in 0usize..2, tool in 0usize..4, aside in prop::array::uniform2(-0.5..0.5f64), above in -0.2..0.6f64,
        lean in prop::array::uniform2(-0.2..0.2f64),
    ) {
        let (geometry, tool) = (&solids()[solid], &straight_tools()[tool]);
        let axis = Vec3::new(lean[0], lean[1], 1.0).normalize();
        let lowest = Vec3::z() * if solid == 0 { -1.0 } else { 0.0 };
        let tip = lowest + Vec3::new(aside[0], aside[1], -above) - axis * tool.height;
        let (reading, shape) = read(geometry, tool, &tip, &axis);
        let sampled = sampled(geometry, tool, &tip, &axis);
        prop_assert!(reading.value <= sampled + reading.error + 1e-9, "{reading:?} sampled {sampled}");
        prop_assert!(sampled - reading.value < 5e-3, "{reading:?} sampled {sampled}");
        prop_assert!(reading.error < 1e-8, "{reading:?}");
        // Where the disc would be touched nothing is said about the course on a way.
        let surface = Surface::of(geometry).unwrap();
        let disc = (0..40).flat_map(|k| (0..40).map(move |m| (f64::from(k) / 40.0, f64::from(m) * 0.157))).map(|(rho, phi)| {
            let u = super::super::tool::perpendicular(&axis);
            let radius = Profile::of(tool).unwrap().open_top().unwrap() * rho;
            let place = tip + axis * tool.height + (u * phi.cos() + axis.cross(&u) * phi.sin()) * radius;
            surface.point_distance(&place).unwrap().0
        });
        if disc.fold(f64::INFINITY, f64::min) < reading.value - 1e-6 {
            prop_assert_eq!(shape, Shape::Free);
        }
    }
}

/// About the nearest place of a straight piece distances differ by rounding alone, over a way on which the normal turns by 10⁻⁸.
#[test]
fn a_line_beside_a_quadric_touches_where_the_slope_vanishes() {
    let form = quadric([
        -0.09198637233625799,
        0.05623249295794469,
        0.08133053295622357,
        0.6863698330549635,
        0.03985566391016435,
        -0.07366055028688899,
        0.1119924420414996,
        0.37909290863343836,
        -0.25908184516348776,
        -0.11211901364406392,
    ]);
    let line = cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.2954852525404523]);
    let [from, to] = [Vec3::new(-0.58611, 0.21449, 0.49025), Vec3::new(-0.62094, 0.16542, 0.46108)];
    for k in 0..=200 {
        let (reading, _) = read(&form, &line, &from.lerp(&to, f64::from(k) / 200.0), &Vec3::z());
        assert!(reading.error < 1e-10, "{k}: {reading:?}");
    }
}

#[test]
fn a_solid_that_is_over_no_part_of_the_disc_leaves_the_clearance_convex() {
    let (geometry, tool) = (&solids()[0], &straight_tools()[1]);
    for (tip, shape) in [
        ([0.0, 0.0, 1.0], Shape::Convex),
        ([3.0, 0.0, -1.0], Shape::Convex),
        ([3.0, 0.0, -6.0], Shape::Convex),
        ([0.2, 0.0, -6.0], Shape::Free),
    ] {
        let (_, found) = read(geometry, tool, &Vec3::from(tip), &Vec3::z());
        assert_eq!(found, shape, "{tip:?}");
    }
}
