//! Solids of two convex halves: cones with both nappes and hyperboloids of two sheets.

use super::*;
use crate::clearance::quadric::Posed;

/// A cone with its vertex in the origin whose ruling along +x has the plane z = 0 for tangent plane; above it is outside.
pub(super) fn cone_under_x(width: f64) -> Geometry {
    let mut coefficients = [0.0; 10];
    (coefficients[1], coefficients[2], coefficients[5]) = (1.0, 1.0, width);
    Geometry::Quadric(Quadric { coefficients })
}

#[test]
fn contact_along_a_ruling_of_a_cone_is_proven() {
    for (numbers, width) in [(&[1.0][..], 0.4), (&[1.0, 0.1], 0.4), (&[1.0, 0.1], 2.5)] {
        let (tool, gauge) = (tool(numbers), gauge(&cone_under_x(width), 1.0));
        for (x, height) in [(0.9, 0.001), (0.7, 1e-5), (3.0, 0.02)] {
            let (contact, missed) = gauge.contact_within(&tool, &v(x, 0.0, height), Enough::ALL);
            near(contact.clearance, height);
            assert!(missed < 1e-8, "{numbers:?} at {x}: {missed} may be missed");
            let next = gauge.contact(&tool, &v(x + 0.01, 0.02, height));
            let places = (v(x, 0.0, height), v(x + 0.01, 0.02, height));
            let contacts = [(&places.0, &contact), (&places.1, &next)];
            assert!(gauge.is_beside_one_half(&tool, contacts, 0.001));
        }
    }
}

#[test]
fn a_tool_between_both_halves_is_beside_none() {
    // Two sheets 2 apart at their vertices; the ball between them is as near to one as to the other.
    let sheets = Quadric { coefficients: [1.0, 1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] };
    let (tool, gauge) = (tool(&[1.6, 0.8, 0.0, 0.8, 0.0, 0.0, 1.6]), gauge(&Geometry::Quadric(sheets), 1.0));
    let places = [v(0.0, 0.0, -0.75), v(0.0, 0.0, -0.7)];
    let contacts = places.map(|tip| gauge.contact(&tool, &tip));
    let pairs = [(&places[0], &contacts[0]), (&places[1], &contacts[1])];
    assert!(!gauge.is_beside_one_half(&tool, pairs, 0.25));
}

/// Least distance of points of the boundary, the disc at the top left out: nothing touches it.
pub(super) fn least_of_boundary(tool: &Tool, gauge: &Gauge, tip: &Vec3) -> f64 {
    let profile = &tool.profile;
    let line = |from: [f64; 2], to: [f64; 2], t: f64| [0, 1].map(|k| from[k] + t * (to[k] - from[k]));
    let at = |p: &apt_geometry::cutter::ProfilePoint| [p.radius, p.height];
    let mut least = f64::INFINITY;
    for step in 0..=40 {
        let t = f64::from(step) / 40.0;
        let polar = profile.fan[0] + t * (profile.fan[1] - profile.fan[0]);
        let arc = [
            profile.center.radius + profile.arc * polar.sin(),
            profile.center.height - profile.arc * polar.cos(),
        ];
        let lines = [
            line([0.0, 0.0], at(&profile.lower), t),
            line(at(&profile.upper), at(&profile.top), t),
            if profile.arc > 0.0 { arc } else { at(&profile.lower) },
        ];
        for (radius, height) in lines.map(|[radius, height]| (radius, height)) {
            for k in 0..48 {
                let (sine, cosine) = (f64::from(k) * std::f64::consts::TAU / 48.0).sin_cos();
                let radial = (tool.across[0] * cosine + tool.across[1] * sine) * radius;
                let place = tip + tool.axis * height + radial;
                least = least.min(gauge.side * gauge.surface.signed_distance(&place));
            }
        }
    }
    least
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    /// What is told of both halves together holds for every point of the tool.
    #[test]
    fn no_point_is_nearer_than_both_halves_are_shown_to_be(
        squares in [0.2..3.0f64, 0.2..3.0f64, -3.0..-0.2f64],
        gap in prop_oneof![Just(0.0), 0.0..1.0f64],
        shape in 0usize..7,
        from in [-2.0..2.0f64, -2.0..2.0f64, -2.0..2.0f64],
        axis in [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64],
        height in 0.0..0.2f64,
    ) {
        let [a, b, c] = squares;
        let sheets = Quadric { coefficients: [a, b, c, gap, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] };
        let gauge = gauge(&Geometry::Quadric(sheets), 1.0);
        let Some(axis) = Vec3::from(axis).try_normalize(0.1) else { return Ok(()) };
        let tool = Tool::new(tools()[shape].cutter, axis);
        // Towards the surface.
        let mut tip = Vec3::from(from);
        for _ in 0..4 {
            let contact = gauge.contact(&tool, &tip);
            tip -= contact.gradient * (contact.clearance - height);
        }
        let contact = gauge.contact(&tool, &tip);
        let posed = Posed::new(&tool, &gauge.surface, 1.0, &tip).expect("a quadric");
        let Some(half) = posed.half_by_plane(contact.clearance - 1e-9, &contact) else { return Ok(()) };
        let level = contact.clearance - 1e-9;
        if posed.keeps_off(&half, level, &contact) {
            let least = least_of_boundary(&tool, &gauge, &tip);
            prop_assert!(least >= level - 1e-9, "{least} below {level}");
        }
    }
}
