//! Random conics: never more cut vectors than 1.02 times the integral of √(κ/8τ) along the path, and two (arelem reference
//! 5.6); and the bound that is told is one.

use DriveSide::{Left, Right};
use Relation::{On, To};
use proptest::prelude::*;

use super::{
    economy::{Curve, ground, integral, x},
    *,
};

/// Tool radius, small against every bend.
const RADIUS: f64 = 0.1;
/// Share of the integral and number of cut vectors that may be more.
const SHARE: f64 = 1.02;
const MORE: f64 = 2.0;

/// The count of the last motion, with the integral between two limits of x.
fn frugal(p: &Program, curve: Curve<'_>, range: [f64; 2], left: f64, between: [f64; 2], band: f64) {
    let wanted = integral(curve, range, left, 0, between, band);
    let sequence = p.last();
    let count = sequence.points.len() as f64;
    assert!(count <= SHARE * wanted + MORE, "{count} vectors, the integral is {wanted}: {sequence:?}");
    let minimum = f64::from(sequence.minimum.expect("a bound"));
    assert!(minimum <= count && minimum <= wanted.max(1.0), "bound {minimum}, {count} vectors, {wanted}");
}

fn begun(band: f64, share: f64) -> Program {
    let mut p = Program::new();
    p.run(&MotionCommand::MaximumPoints(100_000)).tolerance(share * band, (1.0 - share) * band);
    p.cutter(&[2.0 * RADIUS]);
    p
}

/// From one x to another along a drive surface that the tool stands on one side of.
fn along(p: &mut Program, drive: &Geometry, from: Vec3, side: DriveSide, between: [f64; 2]) {
    p.from(from.x, from.y, 0.0).go(&[(To, drive), (To, &ground()), (On, &x(between[0]))]);
    p.indirv(1.0, 0.0, 0.0).side(side).drive(Turn::Forward, drive, On, &x(between[1])).verified();
}

fn band() -> impl Strategy<Value = f64> {
    (-4.5f64..-2.0).prop_map(|power| 10f64.powf(power))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn ellipses(a in 1.0f64..6.0, b in 0.5f64..6.0, begin in -0.8f64..0.0, end in 0.1f64..0.8, band in band(), share in 0.0f64..1.0, outside: bool) {
        // The tightest bend inside leaves room for the tool.
        prop_assume!(b * b / a > 3.0 * RADIUS && a * a / b > 3.0 * RADIUS);
        let ellipse = quadric([1.0 / (a * a), 1.0 / (b * b), 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let curve = |t: f64| {
            let (s, c) = t.sin_cos();
            [[-a * c, b * s], [a * s, b * c], [a * c, -b * s]]
        };
        let mut p = begun(band, share);
        let (y, side, left) = if outside { (b + 1.0, Left, RADIUS) } else { (0.1 * b, Right, -RADIUS) };
        let between = [begin * a, end * a];
        along(&mut p, &ellipse, v(between[0], y, 0.0), side, between);
        frugal(&p, &curve, [0.0, std::f64::consts::PI], left, between, band);
    }

    #[test]
    fn parabolas(rise in -0.6f64..0.6, end in 0.5f64..3.0, band in band(), share in 0.0f64..1.0, above: bool) {
        // y = rise x².
        let conic = Geometry::GeneralConic(Quadric {
            coefficients: [rise, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5, 0.0],
        });
        prop_assume!(rise.abs() > 0.01);
        let curve = |t: f64| [[t, rise * t * t], [1.0, 2.0 * rise * t], [0.0, 2.0 * rise]];
        let mut p = begun(band, share);
        let start = rise * 4.0;
        let (y, side, left) = if above { (start + 1.0, Left, RADIUS) } else { (start - 1.0, Right, -RADIUS) };
        along(&mut p, &conic, v(-2.0, y, 0.0), side, [-2.0, end]);
        frugal(&p, &curve, [-4.0, 4.0], left, [-2.0, end], band);
    }

    #[test]
    fn hyperbolas(a in 0.8f64..3.0, b in 0.8f64..3.0, begin in -3.0f64..0.0, end in 0.5f64..3.0, band in band(), share in 0.0f64..1.0) {
        // The upper branch, from outside: y² / b² − x² / a² = 1.
        let hyperbola = quadric([-1.0 / (a * a), 1.0 / (b * b), 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let curve = |t: f64| {
            let (s, c) = (t.sinh(), t.cosh());
            [[a * s, b * c], [a * c, b * s], [a * s, b * c]]
        };
        prop_assume!(a * a / b > 3.0 * RADIUS);
        let height = b * (1.0f64 + begin * begin / (a * a)).sqrt() + 1.5;
        let mut p = begun(band, share);
        along(&mut p, &hyperbola, v(begin, height, 0.0), Left, [begin, end]);
        frugal(&p, &curve, [-3.0, 3.0], RADIUS, [begin, end], band);
    }
}
