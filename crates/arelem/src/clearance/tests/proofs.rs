//! What is proven of levels is true.

use super::{
    kept::{laid, quadric},
    *,
};
use crate::{
    clearance::{
        certify::{self, Certificate, Effort, Face, Proof},
        floor::Bases,
    },
    verify::tests::lofts,
};

fn square() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), -3.0..3.0f64]
}

/// A quadric, or a ruled surface or polyconic with ends.
fn geometry() -> impl Strategy<Value = Geometry> {
    let squares = [square(), square(), square()];
    let linear = [-0.5..0.5f64, -0.5..0.5f64, -0.5..0.5f64];
    let quadrics = (squares, linear, -1.0..1.0f64)
        .prop_map(|(squares, linear, constant)| quadric(squares, linear, constant));
    prop_oneof![4 => quadrics, 1 => Just(lofts::roof()), 1 => Just(lofts::vault())]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    /// A level above that of a point of the tool is never proven, neither anew nor by what was proven of a lower one near by.
    #[test]
    fn no_level_above_the_contact_is_proven(
        geometry in geometry(),
        (shape, side) in (0usize..7, prop_oneof![Just(-1.0), Just(1.0)]),
        from in [-2.0..2.0f64, -2.0..2.0f64, -2.0..2.0f64],
        axis in [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64],
        height in prop_oneof![-0.01..0.01f64, 0.0..1.0f64],
        towards in [-0.1..0.1f64, -0.1..0.1f64, -0.1..0.1f64],
        (below, above) in (1e-5..0.3f64, 1e-9..0.05f64),
    ) {
        let Ok(surface) = Surface::from_geometry(&geometry) else { return Ok(()) };
        let gauge = gauge(&geometry, side);
        let Some(axis) = Vec3::from(axis).try_normalize(0.1) else { return Ok(()) };
        let tool = Tool::new(tools()[shape].cutter, axis);
        let (first, contact) = laid(&gauge, &tool, Vec3::from(from), height);
        let face = Face { surface: &surface, side };
        let mut proof = Proof::of_tool(&tool);
        let mut proven = |tip: &Vec3, contact: &Contact, level: f64| {
            if !proof.serves() {
                proof = Proof::of_tool(&tool);
            }
            let bases = Bases::about(&tool, tip, (&surface, side), &contact.tool);
            certify::certify(face, &tool, tip, level, &mut proof, Some(&bases), Effort::All)
        };
        proven(&first, &contact, contact.clearance - below);
        for step in [0.01, 0.1, 1.0] {
            let tip = first + Vec3::from(towards) * step;
            let contact = gauge.contact(&tool, &tip);
            // Of the point itself: the search may tell less of another one.
            let level = side * surface.signed_distance(&contact.tool) + above;
            prop_assert!(proven(&tip, &contact, level) != Certificate::Holds, "{level} above {contact:?} at {tip}");
        }
    }
}
