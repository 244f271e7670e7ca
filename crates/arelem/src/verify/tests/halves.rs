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

/// How deep a line is in a sharp body is told by the planes along it that have the body behind them: about its deepest place the way out
/// leaps from one side of the body to the other, and the planes there cut the line.
#[test]
fn a_line_through_the_tip_of_a_body_is_as_deep_as_the_planes_along_it_tell() {
    // Half angles of both nappes along x, 22 and 31 degrees.
    let [narrow, wide] = [0.16, 0.36];
    let surface =
        Surface::of(&quadric([-1.0, 1.0 / narrow, 1.0 / wide, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])).unwrap();
    let profile = Profile::of(&cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0])).unwrap();
    let clearance = Clearance::new(&surface, &profile, 1.0);
    for axis in [[0.1, 1.0, 0.3], [0.2, -0.4, 1.0], [0.0, 0.0, 1.0], [-0.3, 0.9, -0.8]] {
        let axis = Vec3::from(axis).normalize();
        // A plane along the line through the vertex with a nappe behind it: its normal n is square to the line, and narrow·n.y² + wide·n.z² is n.x².
        let across = axis.cross(&Vec3::x()).normalize();
        let other = across.cross(&axis);
        let level = |n: &Vec3| n.x * n.x - narrow * n.y * n.y - wide * n.z * n.z;
        let normal = |phi: f64| other * phi.cos() + across * phi.sin();
        let between = |sense: f64| {
            let [mut low, mut high] = [0.0, sense * std::f64::consts::FRAC_PI_2];
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if level(&normal(middle)) > 0.0 { low = middle } else { high = middle }
            }
            let n = normal(low);
            n * n.x.signum()
        };
        let planes = [between(1.0), between(-1.0)];
        for off in [-0.6, -0.2, 0.0, 0.35, 0.8] {
            // From a plane to the other one, inside.
            let inside = Vec3::new(-0.02, 0.0, 0.0) + across * (0.005 * off);
            let depth = planes.iter().map(|n| n.dot(&inside)).fold(f64::NEG_INFINITY, f64::max);
            assert!(depth < 0.0, "{axis:?} {off} {depth}");
            let found = clearance.at(&(inside - axis), &axis).unwrap();
            let told = [found.value - found.error, found.value + found.error];
            assert!(
                told[0] <= depth + 1e-12 && told[1] >= depth - 1e-12,
                "{axis:?} {off}: {found:?} {depth}"
            );
            assert!(told[0] >= depth - 1e-9, "{axis:?} {off}: {found:?} {depth}");
        }
    }
}
