//! Contact of a ball about a point of the axis, followed from place to place.

use super::{kept::quadric, *};

/// Quadrics of several kinds, from both sides where there is room.
fn solids() -> Vec<(&'static str, Geometry, f64)> {
    vec![
        ("saddle", quadric([0.2, -0.15, 0.0], [0.0, 0.0, 0.5], 0.0), 1.0),
        ("bowl", quadric([0.1, 0.07, 0.0], [0.0, 0.0, -0.5], 0.0), -1.0),
        ("hill", quadric([0.1, 0.07, 0.0], [0.0, 0.0, 0.5], 0.0), 1.0),
        ("sheets", quadric([-0.3, -0.2, 0.5], [0.0; 3], -1.0), -1.0),
        ("neck", quadric([0.3, 0.2, -0.1], [0.0; 3], -1.0), -1.0),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// It is as far as the place of the surface nearest to the centre, wherever the last contact was.
    #[test]
    fn a_ball_on_the_axis_is_as_far_as_the_nearest_place(
        start in prop::array::uniform3(-0.6..0.6f64), steps in prop::collection::vec(prop::array::uniform3(-0.2..0.2f64), 1..8),
    ) {
        let tool = tool(&[0.2, 0.1]);
        let center = Vec3::z() * 0.1;
        for (name, solid, side) in solids() {
            let gauge = gauge(&solid, side);
            let foot = |tip: &Vec3| gauge.surface.foot(&(tip + center));
            let mut tip = Vec3::from(start);
            // To where the ball touches, about.
            for _ in 0..5 {
                let foot = foot(&tip);
                tip -= foot.normal * (foot.distance - side * 0.1);
            }
            for step in &steps {
                tip += Vec3::from(*step);
                let (contact, foot) = (gauge.contact(&tool, &tip), foot(&tip));
                // Beside the flank and far in another place of the tool is nearer.
                let is_by_ball = (contact.tool - tip - center).norm() <= 0.1 + 1e-9;
                if is_by_ball && contact.clearance > -0.05 {
                    let expected = side * foot.distance - 0.1;
                    prop_assert!((contact.clearance - expected).abs() < 1e-12, "{name} {}", contact.clearance - expected);
                    prop_assert!((contact.gradient - foot.normal * side).norm() < 1e-9, "{name}");
                }
            }
        }
    }
}
