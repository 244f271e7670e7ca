//! A tool beside one of two convex bodies.

use apt_geometry::Vec3;
use proptest::prelude::*;

use super::{
    super::{
        clearance::{Clearance, Surface},
        tool::Profile,
    },
    cutter, quadric,
};

/// Least and greatest clearance at nine places of a move by those at its ends with their slopes, if it is said to be beside one body.
fn worst(clearance: &Clearance<'_>, ends: [Vec3; 2], axis: &Vec3) -> Option<f64> {
    let [first, last] = ends.map(|tip| clearance.at(&tip, axis));
    let (first, last) = (first?, last?);
    clearance.beside_one_body([&ends[0], &ends[1]], [&first, &last], axis)?;
    let way = ends[1] - ends[0];
    let mut worst: f64 = 0.0;
    for k in 1..8 {
        let t = f64::from(k) / 8.0;
        let read = clearance.at(&(ends[0] + way * t), axis)?;
        let chord = first.value + t * (last.value - first.value);
        let tangents =
            [first.value + t * first.normal.dot(&way), last.value - (1.0 - t) * last.normal.dot(&way)];
        let error = read.error + first.error + last.error;
        worst = worst.max(read.value - chord - error).max(tangents[0].max(tangents[1]) - read.value - error);
    }
    Some(worst)
}

/// A tool along a ruling of a double cone, at the vertex of which no bend has a bound.
#[test]
fn a_tool_along_a_ruling_is_beside_one_nappe() {
    // With z = 0 for tangent plane along x; above it is outside.
    let mut coefficients = [0.0; 10];
    (coefficients[1], coefficients[2], coefficients[5]) = (1.0, 1.0, 0.8);
    let surface = Surface::of(&quadric(coefficients)).unwrap();
    for numbers in [&[1.0, 0.0][..], &[1.0, 0.1]] {
        let profile = Profile::of(&cutter(numbers)).unwrap();
        let clearance = Clearance::new(&surface, &profile, 1.0);
        for ends in [[0.7, 0.6], [0.9, 2.0], [0.6, 0.52]] {
            let ends = ends.map(|x| Vec3::new(x, 0.0, 1e-3));
            let found = worst(&clearance, ends, &Vec3::z()).expect("beside one nappe");
            assert!(found < 1e-9, "{numbers:?} {ends:?}: {found:e}");
        }
        // From beside the one nappe, the other farther away, into the other.
        let through = [0.7, -0.5].map(|x| Vec3::new(x, 0.0, 1e-3));
        assert!(worst(&clearance, through, &Vec3::z()).is_none());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    /// The clearance is convex wherever it is said to be that from one body.
    #[test]
    fn beside_one_body_the_clearance_is_convex(
        squares in [0.2..3.0f64, 0.2..3.0f64, -3.0..-0.2f64],
        gap in prop_oneof![Just(0.0), 0.0..1.0f64],
        is_cylinder in prop::bool::ANY,
        side in prop_oneof![Just(-1.0), Just(1.0)],
        shape in 0usize..4,
        from in [-2.0..2.0f64, -2.0..2.0f64, -2.0..2.0f64],
        way in [-0.6..0.6f64, -0.6..0.6f64, -0.6..0.6f64],
        axis in [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64],
        height in -0.01..0.3f64,
    ) {
        let [a, b, c] = squares.map(|x| x * side);
        let b = if is_cylinder { 0.0 } else { b };
        let surface = Surface::of(&quadric([a, b, c, gap * side, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])).unwrap();
        let shapes: [&[f64]; 4] = [&[1.0, 0.0], &[1.0, 0.1], &[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0], &[0.6, 0.25]];
        let profile = Profile::of(&cutter(shapes[shape])).unwrap();
        let Some(axis) = Vec3::from(axis).try_normalize(0.1) else { return Ok(()) };
        let clearance = Clearance::new(&surface, &profile, side);
        let mut tip = Vec3::from(from);
        for _ in 0..4 {
            let Some(reading) = clearance.at(&tip, &axis) else { return Ok(()) };
            tip -= reading.normal * (reading.value - height);
        }
        if let Some(worst) = worst(&clearance, [tip, tip + Vec3::from(way)], &axis) {
            prop_assert!(worst < 1e-8, "{worst:e}");
        }
    }
}
