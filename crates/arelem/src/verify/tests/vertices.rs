//! The vertex of a cone: over it, past it, and through it from inside.

use apt_geometry::{
    Vec3,
    motion::{DriveSide, Relation},
};
use proptest::prelude::*;

use super::{
    super::{Rule, tool::Profile, tool::Tool, verify},
    clearances::{clearance, direction, tools},
    cone, cutter,
    paths::{self, BAND},
    plane, quadric, role,
};
use crate::sequence::CutSequence;

const VERTEX: [f64; 3] = [0.0, 0.0, 2.0];
const HALF_ANGLE: f64 = 40.0;
/// Distance of the pass from the vertex.
const BESIDE: f64 = -0.05;

/// A ball over a cone in the plane y = −.05, with vertices at most `step` apart and at `offset` from the cone.
fn past_vertex(step: f64, offset: f64) -> CutSequence {
    let (s, c) = HALF_ANGLE.to_radians().sin_cos();
    let reach = 0.25 + offset;
    let count = (2.4 / step).ceil() as usize;
    let tips: Vec<Vec3> = (0..=count)
        .map(|k| {
            let x = -1.2 + 2.4 * k as f64 / count as f64;
            let rho = x.hypot(BESIDE);
            // The centre stays at its distance from the vertex, or from the nearest generator.
            let height =
                if rho <= reach * c { (reach * reach - rho * rho).sqrt() } else { (reach - rho * c) / s };
            Vec3::new(x, BESIDE, 2.0 + height - 0.25)
        })
        .collect();
    let part = role(cone(VERTEX, [0.0, 0.0, -1.0], HALF_ANGLE), Relation::To, 1.0, BAND.0, BAND.1);
    let drive = role(plane([0.0, 1.0, 0.0], BESIDE), Relation::On, 1.0, BAND.0, BAND.1);
    let stop = paths::end_plane(&tips, Vec3::x());
    paths::sequence(&tips, cutter(&[0.5, 0.25]), part, drive, stop, DriveSide::On)
}

#[test]
fn a_pass_beside_the_vertex_is_proven_wherever_it_lies_in_the_band() {
    for offset in [-0.9 * BAND.0, -0.5 * BAND.0, 0.0, 0.9 * BAND.1] {
        let evidence = verify(&past_vertex(0.004, offset), &|| false).unwrap();
        let part = evidence.part.unwrap();
        assert!(evidence.verified, "{offset}: {evidence:?}");
        assert!((part.max - offset).abs() < 1e-9, "{offset}: {part:?}");
    }
    for offset in [-1.1 * BAND.0, 1.1 * BAND.1] {
        let evidence = verify(&past_vertex(0.004, offset), &|| false).unwrap();
        assert!(evidence.violations.iter().any(|v| v.rule == Rule::PartBand), "{offset}: {evidence:?}");
    }
}

#[test]
fn a_broken_pass_beside_the_vertex_is_found() {
    let path = past_vertex(0.004, 0.0);
    let middle = path.points.len() / 2;
    for shift in [-1.5, 1.5] {
        let mut broken = path.clone();
        broken.points[middle].tip.z += shift * (BAND.0 + BAND.1);
        let found = verify(&broken, &|| false).unwrap();
        assert!(found.violations.iter().any(|v| v.rule == Rule::PartBand), "{shift}: {found:?}");
    }
    let mut dropped = path.clone();
    dropped.points.drain(middle - 10..middle + 10);
    let found = verify(&dropped, &|| false).unwrap();
    assert!(found.violations.iter().any(|v| v.rule == Rule::PartBand), "{found:?}");
}

#[test]
fn a_flat_tool_cuts_the_vertex_off_by_the_depth_it_is_lowered() {
    let peak = cone(VERTEX, [0.0, 0.0, -1.0], HALF_ANGLE);
    for (x, z) in [(0.0, 2.01), (0.1, 1.999), (0.24, 1.99)] {
        let (value, normal, _) = clearance(&cutter(&[0.5, 0.0]), &peak, 1.0, [x, 0.0, z], [0.0, 0.0, 1.0]);
        assert!((value - (z - 2.0)).abs() < 1e-12, "{x} {z}: {value}");
        assert!((normal - Vec3::z()).norm() < 1e-12, "{x} {z}: {normal}");
    }
}

#[test]
fn a_pin_that_sticks_out_of_a_hollow_cone_is_measured_from_the_vertex() {
    let hollow = cone([0.0; 3], [0.0, 0.0, 1.0], HALF_ANGLE);
    // A drill point sharper than the cone, its tip through the vertex.
    let tool = cutter(&[0.2, 0.0, 0.1, 0.0, 80.0, 0.0, 2.0]);
    let (value, normal, _) = clearance(&tool, &hollow, -1.0, [0.0, 0.0, -0.01], [0.0, 0.0, 1.0]);
    assert!((value + 0.01).abs() < 1e-12, "{value}");
    assert!((normal - Vec3::z()).norm() < 1e-9, "{normal}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// The clearance outside is the greatest that any plane at the cone leaves, those through the vertex included.
    #[test]
    fn no_plane_leaves_more_than_the_clearance(
        tool in tools(),
        lateral in (-0.8..0.8f64, -0.8..0.8f64),
        depth in -0.3..0.6f64,
        axis in direction(),
        half_angle in 10.0..80.0f64,
    ) {
        let unit = Vec3::from(axis).normalize();
        let tip = Vec3::from(VERTEX) + Vec3::new(lateral.0, lateral.1, depth);
        let solid = cone(VERTEX, [0.0, 0.0, -1.0], half_angle);
        let (value, normal, error) = clearance(&tool, &solid, 1.0, tip.into(), axis);
        let profile = Profile::of(&tool).unwrap();
        let body = Tool::new(&profile, unit);
        let w = tip - Vec3::from(VERTEX);
        let leaves = |n: &Vec3| n.dot(&w) - body.support(&-n).0;
        prop_assert!((normal.norm() - 1.0).abs() < 1e-9);
        prop_assert!((leaves(&normal) - value).abs() < 1e-7, "{value} {}", leaves(&normal));
        prop_assert!(normal.z >= half_angle.to_radians().sin() - 1e-9, "not a plane at the cone: {normal}");
        let widest = (90.0 - half_angle).to_radians();
        let mut best = f64::NEG_INFINITY;
        for i in 0..=40 {
            let (s, c) = (widest * f64::from(i) / 40.0).sin_cos();
            for k in 0..120 {
                let (y, x) = (std::f64::consts::TAU * f64::from(k) / 120.0).sin_cos();
                best = best.max(leaves(&Vec3::new(s * x, s * y, c)));
            }
        }
        prop_assert!(value >= best - error - 1e-9, "{value} ± {error} but {best}");
        // The planes tried are no farther apart than a twentieth of a right angle.
        prop_assert!(value - best < 0.08 * (w.norm() + profile.reach()), "{value} ± {error} but {best}");
    }
}

/// Over a vertex beside its rim a flat tool is left alone most by one of two planes, whose directions are close together.
#[test]
fn the_better_of_two_planes_beside_a_rim_is_found() {
    let vertex = Vec3::new(0.42019088193205056, 2.1891450898765585, -1.5971004661473838);
    let axis = Vec3::new(0.1572990016479519, -0.8644689768872117, -0.47744152739381107);
    let cosine = 0.7455130481320136_f64;
    let solid = cone(vertex.into(), axis.into(), cosine.acos().to_degrees());
    let tool = cutter(&[0.95051726928291, 0.0, 0.475258634641455, 0.0, 0.0, 5.090617643105038, 4.3]);
    let profile = Profile::of(&tool).unwrap();
    let body = Tool::new(&profile, Vec3::z());
    let first = axis.cross(&Vec3::x()).normalize();
    let frame = [first, axis.cross(&first)];
    for share in [0.0, 0.3, 0.6, 0.7, 1.0] {
        let tip = Vec3::new(0.7640799882692666, 2.5171263426203696, -1.597088997828671)
            + Vec3::new(4.3e-5, 2.26e-4, -1.79e-4) * share;
        let value = clearance(&tool, &solid, 1.0, tip.into(), [0.0, 0.0, 1.0]).0;
        let best = (0..40_000).map(|k| {
            let (y, x) = (std::f64::consts::TAU * f64::from(k) / 40_000.0).sin_cos();
            let n = (frame[0] * x + frame[1] * y) * cosine - axis * cosine.acos().sin();
            n.dot(&(tip - vertex)) - body.support(&-n).0
        });
        let best = best.fold(f64::NEG_INFINITY, f64::max);
        assert!(value >= best - 1e-9 && value < best + 1e-6, "{share}: {value} but {best}");
    }
}

/// A line along one half of a double cone to its vertex, and from there along the other half: on the same hand, or straight on with that on the
/// wrong side, within the bands all the way.
#[test]
fn a_path_that_crosses_over_beyond_the_vertex_of_a_double_cone_is_not_proven() {
    // x² = y² + z², whose halves are on both sides of the vertex along x.
    let double_cone = quadric([-1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let drive = role(double_cone, Relation::To, 1.0, BAND.0, BAND.1);
    let part = role(plane([0.0, 0.0, 1.0], 0.0), Relation::On, 1.0, BAND.0, BAND.1);
    for (beyond, broken) in [(1.0, vec![]), (-1.0, vec![Rule::Progress])] {
        let place = |x: f64| Vec3::new(x, if x > 0.0 { beyond * x } else { -x } + 0.3 * BAND.1, 0.0);
        let tips = [-1.0, -0.5, -0.01 * BAND.1, 0.5, 1.0].map(place);
        let stop = paths::end_plane(&tips, (tips[4] - tips[3]).normalize());
        let line = cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        let path = paths::sequence(&tips, line, part.clone(), drive.clone(), stop, DriveSide::Left);
        let evidence = verify(&path, &|| false).unwrap();
        let found: Vec<Rule> = evidence.violations.iter().map(|violation| violation.rule).collect();
        assert_eq!(found, broken, "{evidence:?}");
    }
}
