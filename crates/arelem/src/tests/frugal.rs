//! Random conics and tabulated cylinders: never more cut vectors than 1.02 times the integral of √(κ/8τ) along the path, and two (arelem reference
//! 5.6); and the bound that is told is one.

use DriveSide::{Left, Right};
use Relation::{On, To};
use apt_geometry::motion::ToolAxis;
use proptest::{
    prelude::*,
    strategy::ValueTree,
    test_runner::{RngAlgorithm, TestRng, TestRunner},
};

use super::{
    economy::{Curve, LOST, along_directrix, integral, tabulated},
    *,
};

/// Tool radius, small against every bend.
const RADIUS: f64 = 0.1;
/// Share of the integral and number of cut vectors that may be more.
const SHARE: f64 = 1.02;
const MORE: f64 = 2.0;
/// Random curves that are tried: one in a hundred may take one vector more where its bend changes.
const CURVES: usize = 200;
/// The tightest bend that the tool fits into, times its radius.
const TIGHT: f64 = 0.8;

/// The count of the last motion, with the integral between two limits of x.
fn frugal(p: &Program, curve: Curve<'_>, range: [f64; 2], left: f64, between: [f64; 2], band: f64) {
    let wanted = integral(curve, range, left, 0, between, band);
    let sequence = p.last();
    let count = sequence.points.len() as f64;
    assert!(count <= SHARE * wanted + MORE, "{count} vectors, the integral is {wanted}: {sequence:?}");
    let minimum = f64::from(sequence.minimum.expect("a bound"));
    assert!(
        minimum <= count && minimum <= (wanted + LOST).ceil(),
        "bound {minimum}, {count} vectors, {wanted}"
    );
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

/// A directrix through places with slopes, as u, v, a, b of its intervals, and its end: straight beyond the first and the
/// last place.
fn directrix(nodes: &[[f64; 3]]) -> (Vec<[f64; 4]>, [f64; 2]) {
    let beyond = |[u, v, slope]: [f64; 3], reach: f64| [u + reach, v + slope * reach];
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    let [u, v] = beyond(first, -4.0);
    let mut table = vec![[u, v, 0.0, 0.0]];
    for pair in nodes.windows(2) {
        let [[u, v, before], [u2, v2, after]] = [pair[0], pair[1]];
        let (length, turn) = ((u2 - u).hypot(v2 - v), (v2 - v).atan2(u2 - u));
        let [s1, s2] = [before, after].map(|slope| (slope.atan() - turn).tan());
        table.push([u, v, (s1 + s2) / (length * length), -(2.0 * s1 + s2) / length]);
    }
    table.push([last[0], last[1], 0.0, 0.0]);
    (table, beyond(last, 4.0))
}

/// Places a unit apart at these heights, with the slopes of their chords to both sides.
fn nodes(heights: &[f64]) -> Vec<[f64; 3]> {
    let slope = |k: usize| {
        let (low, high) = (k.saturating_sub(1), (k + 1).min(heights.len() - 1));
        (heights[high] - heights[low]) / (high - low) as f64
    };
    heights.iter().enumerate().map(|(k, height)| [k as f64, *height, slope(k)]).collect()
}

/// The tightest bend of a curve.
fn tightest(curve: Curve<'_>, range: [f64; 2]) -> f64 {
    let bend = |k: u32| {
        let [_, d, dd] = curve(range[0] + (range[1] - range[0]) * f64::from(k) / 1000.0);
        (d[0] * dd[1] - d[1] * dd[0]).abs() / d[0].hypot(d[1]).powi(3)
    };
    (0..=1000).map(bend).fold(0.0, f64::max)
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

/// Curves that bend the other way again and again.
#[test]
fn tabulated_cylinders() {
    let mut runner =
        TestRunner::new_with_rng(ProptestConfig::default(), TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let drawn = (prop::collection::vec(-0.7f64..0.7, 4..14), band(), 0.0f64..1.0, any::<bool>());
    let (mut tried, mut over) = (0, 0);
    while tried < CURVES {
        let (heights, band, share, above) = drawn.new_tree(&mut runner).expect("a curve").current();
        let (table, last) = directrix(&nodes(&heights));
        let curve = |t: f64| along_directrix(&table, last, t);
        let range = [0.0, table.len() as f64];
        if tightest(&curve, range) * RADIUS >= TIGHT {
            continue;
        }
        tried += 1;
        let drive = tabulated(&table, last);
        let mut p = begun(band, share);
        let (side, left, aside) = if above { (Left, RADIUS, 1.0) } else { (Right, -RADIUS, -1.0) };
        let between = [0.3, heights.len() as f64 - 1.3];
        along(&mut p, &drive, v(between[0], heights[0] + aside, 0.0), side, between);
        let wanted = integral(&curve, range, left, 0, between, band);
        let (count, minimum) = (p.last().points.len() as f64, p.last().minimum.expect("a bound"));
        // Where the bend changes sides more is needed than the integral tells.
        assert!(
            f64::from(minimum) <= count && f64::from(minimum) <= 1.02 * wanted + MORE,
            "{minimum}, {wanted}"
        );
        assert!(count <= SHARE * wanted + MORE + 1.0, "{count} vectors, {wanted}: {heights:?} {band}");
        over += usize::from(count > SHARE * wanted + MORE);
    }
    assert!(over * 100 <= CURVES, "{over} of {CURVES} take one vector more");
}

/// In a corner that the tool does not fit into two vectors meet, however much the path turns there.
#[test]
fn a_vector_ends_in_a_corner() {
    for slope in [0.2, 0.3, 0.45] {
        for band in [1e-2, 1e-3, 1e-5] {
            let nodes = [
                [0.0, slope, -slope],
                [0.95, 0.05 * slope, -slope],
                [1.05, 0.05 * slope, slope],
                [2.0, slope, slope],
            ];
            let (table, last) = directrix(&nodes);
            let mut p = begun(band, 0.5);
            // Far greater than the bend between the flanks.
            p.cutter(&[0.8]);
            along(&mut p, &tabulated(&table, last), v(0.1, slope + 1.0, 0.0), Left, [0.1, 1.95]);
            let tips: Vec<_> = p.last().points.iter().map(|point| point.tip.x).collect();
            assert_eq!(tips.len(), 2, "slope {slope}, band {band}: {tips:?}");
            assert!((tips[0] - 1.0).abs() <= band / slope, "slope {slope}, band {band}: {tips:?}");
        }
    }
}

/// The tool end goes along a ruling of a hyperboloid whose narrow waist is near: how the distance bends there says nothing of the
/// stretches before it, though the bound for those was made for as far as that.
#[test]
fn a_narrow_waist_ahead_does_not_shorten_vectors() {
    let part = quadric([1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1e-6]);
    let drive = circle(1.0, 40.001, 40.0);
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[2.0]).from(1.5, 0.02, 1.5);
    p.run(&MotionCommand::PartSide(PartSide::On)).side(DriveSide::On);
    p.go(&[(On, &drive), (On, &part), (On, &x(1.7))]).indirv(-1.0, 0.0, 0.0);
    p.drive(Turn::Forward, &drive, On, &x(0.1)).verified();
    // From one limit of the band to the other and back: sag of the whole band over a circle of radius 40, seen at 45 degrees.
    let full = 0.99 * (2.0f64 * 8.0 * 40.0 * 0.0005).sqrt();
    let points = &p.last().points;
    for pair in points[..points.len() - 1].windows(2) {
        let length = (pair[1].tip - pair[0].tip).norm();
        assert!(length > full, "{length}, not {full}, from {}", pair[0].tip);
    }
    assert_eq!(points.len(), 5);
}

/// A ball whose flank goes along a cylinder comes from a bend to a straight way and on to the next bend: wherever it begins, that way is
/// one vector, as far into the bend as the band allows.
#[test]
fn a_straight_way_between_two_bends_is_one_vector() {
    let part = plane(-0.6, -0.8, 0.0, 1.1);
    let drive = cylinder(v(-3.4, -6.6, -4.2), v(-0.3, 0.95, 0.0), 5.2);
    for k in 0..10 {
        let begin = plane(-0.8, 0.6, 0.0, -2.4 + 0.1 * f64::from(k));
        let mut p = Program::new();
        p.tolerance(0.0, 0.001).cutter(&[0.25, 0.125]);
        p.run(&MotionCommand::ToolAxis(ToolAxis::Fixed(v(-0.5, -0.83, 0.25)))).from(1.0, -2.4, -0.5);
        p.indirv(-0.8, 0.6, 0.0).go(&[(Relation::Past, &begin), (To, &part), (To, &drive)]);
        p.side(Right).drive(Turn::Forward, &drive, To, &begin).verified();
        let count = p.last().points.len();
        let minimum = p.last().minimum.expect("a bound") as usize;
        assert!(count <= minimum + 2, "{count} vectors, {minimum} at least, begun at {k}");
    }
}

/// The tool end goes along an ellipsoid, its side along an elliptic cylinder, into a corner in which the path turns back: the farther a vector is
/// asked to lead beyond it the less far it does, and it is to end where the path turns all the same.
#[test]
fn vectors_do_not_creep_up_to_a_place_where_the_path_turns_back() {
    let part = quadric([0.2165, 0.1833, 0.4321, 5.916, 0.2666, 0.1738, 0.1598, 1.0988, 0.7861, 2.0591]);
    let drive = quadric([0.2803, 0.8509, 0.0, 2.549, 0.0, 0.0, -0.3122, -0.5219, 1.72, 0.0]);
    let begin = plane(0.708, 0.633, -0.313, -1.6576);
    let stop = cylinder(v(3.5595, 1.3047, -5.2286), v(0.402, 0.447, 0.799), 7.5325);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.184]);
    p.run(&MotionCommand::ToolAxis(ToolAxis::Fixed(v(0.7146, -0.1164, 0.6897)))).from(-1.63, -1.68, -0.7);
    p.run(&MotionCommand::PartSide(PartSide::On));
    p.indirv(-0.7, -0.6, 0.3).go(&[(To, &drive), (On, &part), (On, &begin)]);
    let command = motion(Turn::Forward, &drive, &[(To, 2, &stop)]);
    p.side(Right).indirv(-0.7, -0.6, 0.3).run(&command);
    p.verified();
    let count = p.last().points.len();
    let minimum = p.last().minimum.expect("a bound") as usize;
    assert!(count <= minimum + 2, "{count} vectors, {minimum} at least");
}

/// A part surface that leans makes the vectors along a large circle longer than they are seen from above, by as much as the way rises: all of
/// them keep to MAXDP, and are as few as it allows.
#[test]
fn vectors_round_a_circle_that_rise_with_the_part_surface_are_no_longer_than_told() {
    let (wall, stop) = (circle(0.0, 0.0, 200.0), line(0.0, 0.0, 0.0, 300.0));
    for (part, most) in [(plane(0.1, -0.15, 1.0, 0.0), 10.0), (plane(-0.5, 0.2, 1.0, 0.0), 7.0)] {
        for relation in [Relation::On, Relation::To] {
            let mut program = Program::new();
            program.run(&MotionCommand::MaximumStep(most));
            program.cutter(&[4.0, 0.0]).tolerance(0.04, 0.04).from(-210.0, -5.0, 50.0).indirv(1.0, 0.0, 0.0);
            program.go(&[
                (relation, &wall),
                (Relation::To, &part),
                (Relation::On, &line(-1.0, 0.0, 0.0, 0.0)),
            ]);
            program.side(if relation == Relation::On { DriveSide::On } else { DriveSide::Left });
            program.indirv(0.0, 1.0, 0.0).drive(Turn::Forward, &wall, Relation::On, &stop).verified();
            let (sequence, mut from) = (program.last(), program.last().start.tip);
            let mut longest: f64 = 0.0;
            for point in &sequence.points {
                longest = longest.max((point.tip - from).norm());
                from = point.tip;
            }
            assert!(longest <= most * (1.0 + 1e-9), "{longest} of {most}, {relation:?}");
            let (count, least) = (sequence.points.len(), sequence.minimum.expect("a bound"));
            assert!(count as f64 <= 1.02 * f64::from(least) + 2.0, "{count} of {least}, {relation:?}");
            assert!(crate::verify::verify(sequence, &|| false).expect("evidence").verified, "{relation:?}");
        }
    }
}
