//! Tabulated cylinders: against planes, dense sampling and broken sequences.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Interval, TabulatedCylinder},
    motion::{DriveSide, Relation},
};
use proptest::prelude::*;

use super::{
    super::{Rule, VerifyError, verify},
    clearances::{clearance, direction, samples, tools},
    cutter,
    paths::{self, BAND},
    plane, role, tabulated,
};
use crate::sequence::CutSequence;

const UPRIGHT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// The rulings along y, as NOY makes them.
const LYING: [[f64; 3]; 3] = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// Samples of each piece of the wave.
const STEPS: u32 = 100;
/// Depth in diameters up to which violations are measured exactly.
const DEEP: f64 = 0.04;

fn frame(rows: [[f64; 3]; 3]) -> [Vec3; 3] {
    rows.map(Vec3::from)
}

/// v = height·sin u from u = −3 to 3, by pieces of a half.
fn wave_nodes(height: f64) -> Vec<[f64; 3]> {
    (-6..=6).map(|k| f64::from(k) * 0.5).map(|u: f64| [u, height * u.sin(), height * u.cos()]).collect()
}

/// A point and the natural normal of the directrix of `wave_nodes`, from its Hermite cubics over u… independent of the
/// control points of the verifier.
fn dense_wave(height: f64) -> Vec<([f64; 2], [f64; 2])> {
    let nodes = wave_nodes(height);
    let mut all = Vec::new();
    let mut ray = |from: [f64; 3], sense: f64| {
        for k in 0..400 {
            let x = sense * f64::from(k) * 0.02;
            let size = from[2].hypot(1.0);
            all.push(([from[0] + x / size, from[1] + x * from[2] / size], [-from[2] / size, 1.0 / size]));
        }
    };
    ray(nodes[0], -1.0);
    ray(nodes[nodes.len() - 1], 1.0);
    for pair in nodes.windows(2) {
        let ([u, v, before], [u2, v2, after]) = (pair[0], pair[1]);
        let (du, dv) = (u2 - u, v2 - v);
        let length = du.hypot(dv);
        let (c, s) = (du / length, dv / length);
        let [s1, s2] = [before, after].map(|m| (m * c - s) / (c + m * s));
        let (a, b) = ((s1 + s2) / (length * length), -(2.0 * s1 + s2) / length);
        for k in 0..=STEPS {
            let x = length * f64::from(k) / f64::from(STEPS);
            let y = x * (x - length) * (a * (x + length) + b);
            let slope = 3.0 * a * x * x + 2.0 * b * x - length * (a * length + b);
            let size = slope.hypot(1.0);
            let normal = [-slope / size, 1.0 / size];
            all.push((
                [u + x * c - y * s, v + x * s + y * c],
                [normal[0] * c - normal[1] * s, normal[0] * s + normal[1] * c],
            ));
        }
    }
    all
}

/// Signed distance of a point by the nearest sample.
fn dense_distance(curve: &[([f64; 2], [f64; 2])], axes: &[Vec3; 3], x: &Vec3) -> f64 {
    let p = [axes[0].dot(x), axes[1].dot(x)];
    let mut best = (f64::INFINITY, 0.0);
    for (q, n) in curve {
        let d = [p[0] - q[0], p[1] - q[1]];
        let size = d[0].hypot(d[1]);
        if size < best.0 {
            best = (size, d[0] * n[0] + d[1] * n[1]);
        }
    }
    best.0.copysign(best.1)
}

#[test]
fn points_beyond_the_last_point_are_measured_to_the_extension() {
    let surface = tabulated(frame(UPRIGHT), &[[0.0, 0.0, 0.0], [1.0, 0.5, 1.0]]);
    let tool = cutter(&[0.5, 0.0]);
    let far = 30.0;
    let (value, normal, _) =
        clearance(&tool, &surface, 1.0, [1.0 + far, 0.5 + far + 1.0, 0.0], [0.0, 0.0, 1.0]);
    assert!((value - (0.5f64.sqrt() - 0.25)).abs() < 1e-9, "{value}");
    assert!((normal - Vec3::new(-1.0, 1.0, 0.0).normalize()).norm() < 1e-9);
}

#[test]
fn a_corner_of_the_directrix_is_touched_in_its_fan() {
    // A roof of two straight pieces; the ball stands on the ridge.
    let axes = frame(UPRIGHT);
    let up = tabulated(axes, &[[-2.0, -1.0, 0.5], [0.0, 0.0, 0.5]]);
    let down = tabulated(axes, &[[0.0, 0.0, -0.5], [2.0, -1.0, -0.5]]);
    let (Geometry::TabulatedCylinder(up), Geometry::TabulatedCylinder(down)) = (up, down) else {
        panic!("tabcyls")
    };
    let mut roof = (*up).clone();
    roof.intervals.pop();
    roof.intervals.extend(down.intervals[1..].iter().copied());
    roof.last = down.last;
    let roof = Geometry::TabulatedCylinder(std::sync::Arc::new(roof));
    let tool = cutter(&[0.5, 0.25]);
    for x in [-0.1, 0.0, 0.05] {
        let (value, normal, _) = clearance(&tool, &roof, 1.0, [x, 0.6, 0.0], [0.0, 0.0, 1.0]);
        let away = Vec3::new(x, 0.6, 0.0);
        assert!((value - (away.norm() - 0.25)).abs() < 1e-9, "{x}: {value}");
        assert!((normal - away.normalize()).norm() < 1e-6, "{x}: {normal}");
    }
}

/// Of extensions along one line it is rounding alone where the lines of both cross, so that they meet nowhere.
#[test]
fn the_extensions_of_a_straight_directrix_do_not_meet() {
    let tool = cutter(&[0.5, 0.25]);
    for k in 0..4000 {
        let slope = (-1.1 + 5.37e-4 * f64::from(k)).tan();
        let surface = tabulated(frame(UPRIGHT), &[0.0, 1.0, 2.0].map(|u: f64| [u, 0.3 + slope * u, slope]));
        let size = slope.hypot(1.0);
        for (x, y) in [(0.3, 0.5), (-5.0, 0.6), (6.0, 0.7)] {
            let tip = [(x - slope * y) / size, 0.3 + (slope * x + y) / size, 0.0];
            let (value, ..) = clearance(&tool, &surface, 1.0, tip, [0.0, 0.0, 1.0]);
            assert!((value - (y - 0.25)).abs() < 1e-9, "slope {slope}: {value} for {y}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn a_straight_directrix_is_a_plane(
        tool in tools(),
        tip in (-2.5..2.5f64, -2.5..2.5f64, -2.0..2.0f64),
        axis in direction(),
        slope in -2.0..2.0f64,
        lying in any::<bool>(),
        outside in any::<bool>(),
    ) {
        let side = if outside { 1.0 } else { -1.0 };
        let axes = frame(if lying { LYING } else { UPRIGHT });
        let surface = tabulated(axes, &[[0.0, 0.3, slope], [1.0, 0.3 + slope, slope], [2.0, 0.3 + 2.0 * slope, slope]]);
        let normal = (axes[1] - axes[0] * slope).normalize();
        let flat = plane(normal.into(), normal.dot(&(axes[1] * 0.3)));
        let tip = [tip.0, tip.1, tip.2];
        let (value, gradient, error) = clearance(&tool, &surface, side, tip, axis);
        let (wanted, ..) = clearance(&tool, &flat, side, tip, axis);
        if wanted < -DEEP * tool.diameter {
            prop_assert!(value < -0.9 * DEEP * tool.diameter, "{value} plane {wanted}");
            return Ok(());
        }
        prop_assert!((value - wanted).abs() < 1e-8, "{value} plane {wanted}");
        prop_assert!(error < 1e-8 && (gradient - normal * side).norm() < 1e-4, "{error} {gradient}");
    }

    #[test]
    fn a_wave_agrees_with_dense_sampling(
        tool in tools(),
        at in (-2.5..2.5f64, -0.3..1.2f64),
        axis in direction(),
        height in 0.2..1.2f64,
        lying in any::<bool>(),
        outside in any::<bool>(),
    ) {
        let side = if outside { 1.0 } else { -1.0 };
        let axes = frame(if lying { LYING } else { UPRIGHT });
        let surface = tabulated(axes, &wave_nodes(height));
        // The tool stands off the surface on its side, its axis leaning away from it or not.
        let tip = axes[0] * at.0 + axes[1] * (height * at.0.sin() + side * at.1);
        let unit = Vec3::from(axis).normalize();
        let (value, gradient, error) = clearance(&tool, &surface, side, tip.into(), axis);
        let curve = dense_wave(height);
        let sampled = samples(&tool, tip, unit)
            .iter()
            .step_by(7)
            .map(|x| side * dense_distance(&curve, &axes, x))
            .fold(f64::INFINITY, f64::min);
        prop_assert!((gradient.norm() - 1.0).abs() < 1e-9);
        prop_assert!(value <= sampled.max(-0.9 * DEEP * tool.diameter) + 2e-3, "value {value} ± {error} sampled {sampled}");
        if sampled > 0.0 {
            prop_assert!(sampled - value < 3e-2 && error < 1e-8, "value {value} ± {error} sampled {sampled}");
        }
    }

    #[test]
    fn clearance_changes_no_faster_than_the_tool_moves(
        tool in tools(),
        at in (-2.5..2.5f64, 0.0..0.6f64),
        axis in direction(),
        step in direction(),
        lying in any::<bool>(),
    ) {
        let axes = frame(if lying { LYING } else { UPRIGHT });
        let surface = tabulated(axes, &wave_nodes(0.6));
        let tip = axes[0] * at.0 + axes[1] * (0.6 * at.0.sin() + at.1);
        let (value, normal, error) = clearance(&tool, &surface, 1.0, tip.into(), axis);
        for size in [1e-5, 1e-2] {
            let motion = Vec3::from(step).normalize() * size;
            let (next, _, more) = clearance(&tool, &surface, 1.0, (tip + motion).into(), axis);
            // Far under the surface the depth is only a bound.
            let deep = value.min(next) < -0.02;
            prop_assert!(deep || (next - value).abs() <= size + error + more + 1e-9, "{value} {next} over {size}");
            if size < 1e-4 && value > 1e-3 && (next - value - normal.dot(&motion)).abs() > 1e-7 {
                // Only a change of contact bends it more: then there are two contacts, and it falls faster.
                prop_assert!(next < value + normal.dot(&motion), "{value} {next} {normal}");
            }
        }
    }
}

/// Along the wave on its natural side with an upright tool, or with a ball over it.
fn along_wave(lying: bool) -> CutSequence {
    let axes = frame(if lying { LYING } else { UPRIGHT });
    let surface = tabulated(axes, &wave_nodes(0.6));
    let (numbers, center) =
        if lying { ([0.5, 0.25], -Vec3::z() * 0.25) } else { ([0.5, 0.1], Vec3::zeros()) };
    let mut curve: Vec<_> = dense_wave(0.6).into_iter().skip(800).collect();
    curve.retain(|(p, _)| p[0].abs() < 1.7);
    // Lying, v points along x and u up: the tool must come from above, so the wave is turned to z = v there.
    let tips: Vec<Vec3> = curve
        .iter()
        .step_by(10)
        .map(|(p, n)| {
            let (q, m) = (axes[0] * p[0] + axes[1] * p[1], axes[0] * n[0] + axes[1] * n[1]);
            q + m * 0.2502 + center
        })
        .collect();
    let wave = role(surface, Relation::To, 1.0, BAND.0, BAND.1);
    let end = paths::end_plane(&tips, (tips[tips.len() - 1] - tips[tips.len() - 2]).normalize());
    if lying {
        let across = role(plane([0.0, 1.0, 0.0], 0.0), Relation::On, 1.0, BAND.0, BAND.1);
        paths::sequence(&tips, cutter(&numbers), wave, across, end, DriveSide::On)
    } else {
        // The natural normal is on the left of the sense of the curve, and so is the tool: the surface is on its right.
        paths::sequence(&tips, cutter(&numbers), paths::floor(), wave, end, DriveSide::Left)
    }
}

/// The wave as a floor: u along x, v up, the rulings along −y.
fn over_wave() -> CutSequence {
    let axes = [Vec3::x(), Vec3::z(), -Vec3::y()];
    let mut sequence = along_wave(true);
    let surface = tabulated(axes, &wave_nodes(0.6));
    let tips: Vec<Vec3> = dense_wave(0.6)
        .into_iter()
        .skip(800)
        .filter(|(p, _)| p[0].abs() < 1.7)
        .step_by(10)
        .map(|(p, n)| Vec3::new(p[0] + 0.2502 * n[0], 0.0, p[1] + 0.2502 * n[1] - 0.25))
        .collect();
    sequence.start.tip = tips[0];
    sequence.points =
        tips[1..].iter().map(|t| crate::sequence::ToolPosition { tip: *t, axis: Vec3::z() }).collect();
    sequence.forward = (tips[1] - tips[0]).normalize();
    sequence.part = Some(role(surface, Relation::To, 1.0, BAND.0, BAND.1));
    let end = paths::end_plane(&tips, Vec3::x());
    sequence.stop.as_mut().unwrap().role = end;
    sequence
}

fn rules(sequence: &CutSequence) -> Vec<Rule> {
    verify(sequence, &|| false).unwrap().violations.iter().map(|v| v.rule).collect()
}

#[test]
fn sequences_along_and_over_a_wave_are_proven_and_broken_ones_are_not() {
    for (sequence, rule) in [(along_wave(false), Rule::DriveBand), (over_wave(), Rule::PartBand)] {
        let evidence = verify(&sequence, &|| false).unwrap();
        assert!(evidence.verified, "{rule:?}: {evidence:?}");
        let tau = BAND.0 + BAND.1;
        for index in [1, sequence.points.len() / 2, sequence.points.len() - 2] {
            for sense in [1.5, -1.5] {
                let mut broken = sequence.clone();
                let along = broken.points[index + 1].tip - broken.points[index - 1].tip;
                let across = if rule == Rule::DriveBand { Vec3::z() } else { Vec3::y() };
                broken.points[index].tip += along.cross(&across).normalize() * (sense * tau);
                assert!(rules(&broken).contains(&rule), "{rule:?} at {index}");
            }
        }
        let mut dropped = sequence.clone();
        dropped.points.drain(10..20);
        assert!(rules(&dropped).contains(&rule), "{rule:?} with a long chord");
        let mut turned = sequence.clone();
        let role = if rule == Rule::DriveBand { &mut turned.drive } else { &mut turned.part };
        role.as_mut().unwrap().side = -1.0;
        assert!(rules(&turned).contains(&rule), "{rule:?} on the other side");
    }
    let mut other = along_wave(false);
    other.drive_side = DriveSide::Right;
    assert_eq!(rules(&other), [Rule::Side]);
}

/// A wall of hollows with corners between, which stand out to the tool, as FOURPT makes them: how little the slope of a vector that fills the band in a
/// hollow can grow at the corners of others is no matter of how finely it is read.
#[test]
fn a_vector_beside_corners_may_fill_its_band() {
    // Hollows v = b·u(u − 1) over chords of length one, and a vector from end to end of one of them.
    let (bend, radius, inside, open) = (0.015, 0.25, BAND.0, 2e-4);
    let axes = frame(UPRIGHT);
    let hollows = (-3..4).map(|k| Interval {
        u: f64::from(k),
        v: 0.0,
        a: 0.0,
        b: bend,
        length: 1.0,
        maximum: 0.0,
        minimum: 0.0,
    });
    let geometry = Geometry::TabulatedCylinder(std::sync::Arc::new(TabulatedCylinder {
        axes,
        kind: 0.0,
        intervals: hollows.collect(),
        last: [4.0, 0.0],
    }));
    let tool = cutter(&[2.0 * radius, 0.0]);
    let beside = |u: f64| {
        let (height, slope) = (bend * u * (u - 1.0), bend * (2.0 * u - 1.0));
        Vec3::new(u, height, 0.0) + Vec3::new(-slope, 1.0, 0.0).normalize() * (radius - inside)
    };
    let tips = [beside(0.1), beside(0.9)];
    let middle = 0.5 * (tips[0] + tips[1]);
    let (greatest, ..) = clearance(&tool, &geometry, 1.0, middle.into(), [0.0, 0.0, 1.0]);
    let proven = |outside: f64| {
        let wall = role(geometry.clone(), Relation::To, 1.0, inside, outside);
        let end = paths::end_plane(&tips, Vec3::x());
        verify(&paths::sequence(&tips, tool, paths::floor(), wall, end, DriveSide::Left), &|| false)
            .unwrap()
            .verified
    };
    let band = inside + greatest;
    assert!(proven(greatest + open * band));
    assert!(!proven(greatest - open * band));
}

#[test]
fn a_wave_as_check_surface_tells_its_positions_apart() {
    // Along x at y = 0.3 with the wave standing across: u = y, v = x − 4, natural normal towards +x.
    let axes = [Vec3::y(), -Vec3::x(), Vec3::z()];
    let surface = tabulated(axes, &[[-1.0, -4.0, 0.0], [0.0, -4.0, 0.0], [1.0, -4.0, 0.0]]);
    for (relation, x, side) in
        [(Relation::To, 3.75, 1.0), (Relation::On, 4.0, 1.0), (Relation::Past, 4.25, -1.0)]
    {
        let mut sequence = paths::to_circle(relation, 1).sequence;
        sequence.points[0].tip.x = x;
        let stop = sequence.stop.as_mut().unwrap();
        stop.role = role(surface.clone(), relation, side, BAND.0, BAND.1);
        assert_eq!(rules(&sequence), [], "{relation:?}");
        for wrong in [Relation::To, Relation::Past].into_iter().filter(|r| *r != relation) {
            let mut broken = sequence.clone();
            broken.stop.as_mut().unwrap().role.relation = wrong;
            assert!(!rules(&broken).is_empty(), "{relation:?} called {wrong:?}");
        }
        sequence.points[0].tip.x -= 0.01;
        assert!(rules(&sequence).contains(&Rule::CheckBand), "{relation:?}");
    }
}

#[test]
fn a_broken_frame_or_an_empty_curve_is_an_error() {
    let good = along_wave(false);
    let Some(drive) = &good.drive else { panic!("a drive surface") };
    let Geometry::TabulatedCylinder(form) = &drive.surface.geometry else { panic!("a tabcyl") };
    let mut skew = (**form).clone();
    skew.axes[0] = skew.axes[1];
    let mut empty = (**form).clone();
    empty.intervals.clear();
    let mut wild = (**form).clone();
    wild.intervals[3].a = f64::NAN;
    for form in [skew, empty, wild] {
        let mut broken = good.clone();
        broken.drive.as_mut().unwrap().surface.geometry =
            Geometry::TabulatedCylinder(std::sync::Arc::new(form));
        assert!(matches!(verify(&broken, &|| false), Err(VerifyError::Degenerate { .. })));
    }
}

/// Where the rim of a flat tool all but touches the ruling between two pieces, which are tangent there, the difference of both places tells no
/// direction.
#[test]
fn a_rim_at_a_joint_stands_away_from_the_surface() {
    let ramp = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.2], [2.0, 0.5, 0.6], [3.0, 1.2, 0.5], [4.0, 1.5, 0.0]];
    let geometry = tabulated(frame([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]), &ramp);
    for (x, z) in
        [-1e-10, -1e-12, 0.0, 3e-12, 1e-10].into_iter().flat_map(|x| [-1e-11, 1e-12, 1e-11].map(|z| (x, z)))
    {
        let tip = [3.75 + x, 0.25, 1.5 + z];
        let (value, normal, _) = clearance(&cutter(&[0.5, 0.0]), &geometry, 1.0, tip, [0.0, 0.0, 1.0]);
        assert!(value.abs() < 1e-9 && normal.z > 1.0 - 1e-6, "{tip:?}: {value} {normal:?}");
    }
}
