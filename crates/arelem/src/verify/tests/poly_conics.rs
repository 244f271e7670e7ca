//! Polyconic surfaces: against the cylinder that one of them is, dense sampling by their formula, and broken sequences.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Remembering, extent::POLYCONIC_STATIONS_BEYOND},
    motion::{DriveSide, Relation},
};
use proptest::prelude::*;

use super::{
    super::{
        Rule, VerifyError,
        clearance::{Clearance, Surface},
        ruling_clearance::searched,
        tool::{Profile, Tool, WORK},
        verify,
    },
    clearances::{clearance, direction},
    cutter, cylinder,
    paths::{self, BAND},
    plane, role,
};
use crate::sequence::CutSequence;

/// The coefficients of A, B, C, D, L, H, P.
pub(super) type Functions = [[f64; 3]; 7];

/// The 79 values; the rows of the matrix are those of a rotation.
pub(super) fn poly_conic(
    rows: [[f64; 3]; 3],
    thickness: f64,
    base: f64,
    length: f64,
    functions: &Functions,
) -> Geometry {
    let mut values = vec![1.0];
    for row in rows {
        values.extend(row);
        values.push(0.0);
    }
    values.extend([thickness, base, length]);
    for coefficients in functions {
        values.extend(coefficients);
        values.extend([0.0; 5]);
    }
    values.extend([0.0; 7]);
    Geometry::PolyConic(Remembering::new(values))
}

pub(super) const ALONG_X: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const ALONG_Z: [[f64; 3]; 3] = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// An arc of a tube, counter-clockwise seen against the stations: its natural normal is outward.
fn tube(rows: [[f64; 3]; 3], radius: f64, center: f64, degrees: [f64; 2], stations: [f64; 2]) -> Geometry {
    let [from, to] = degrees.map(f64::to_radians);
    let half = 0.5 * (to - from);
    let at = |angle: f64, r: f64| [center + r * angle.cos(), r * angle.sin()];
    let (start, meet, end) = (at(from, radius), at(from + half, radius / half.cos()), at(to, radius));
    let fullness = (1.0 + 2.0 * half.cos()) / (2.0 + 2.0 * half.cos());
    let functions = [
        end[0] - meet[0],
        meet[1] - start[1],
        meet[0] - start[0],
        end[1] - meet[1],
        start[0],
        start[1],
        fullness,
    ];
    poly_conic(rows, 0.0, stations[0], stations[1] - stations[0], &functions.map(|k| [k, 0.0, 0.0]))
}

/// A loft whose conics grow, turn and fill up.
pub(super) const LOFT: Functions = [
    [1.5, 0.2, -0.1],
    [1.0, 0.3, 0.2],
    [1.5, -0.1, 0.0],
    [-1.0, 0.1, -0.3],
    [-1.4, 0.1, 0.3],
    [0.0, 0.2, -0.4],
    [0.62, 0.1, 0.05],
];

/// A place of the loft: the conic as the curve of second degree through its ends with their tangents and its fullness.
fn loft_place(t: f64, d: f64) -> Vec3 {
    let [a, b, c, dd, l, h, p] = LOFT.map(|[k0, k1, k2]| k0 + k1 * d + k2 * d * d);
    let w = (2.0 * p - 1.0) / (2.0 * (1.0 - p));
    let share = [(1.0 - t) * (1.0 - t), 2.0 * w * t * (1.0 - t), t * t];
    let mean = |x: [f64; 3]| {
        (x[0] * share[0] + x[1] * share[1] + x[2] * share[2]) / (share[0] + share[1] + share[2])
    };
    Vec3::new(3.0 * d, mean([l, l + c, l + c + a]), mean([h, h + b, h + b + dd]))
}

fn loft(thickness: f64) -> Geometry {
    poly_conic(ALONG_X, thickness, 0.0, 3.0, &LOFT)
}

/// The normal of the loft along the conic × along the stations, by differences.
fn loft_normal(t: f64, d: f64) -> Vec3 {
    let step = 1e-5;
    let along = loft_place(t + step, d) - loft_place(t - step, d);
    let across = loft_place(t, d + step) - loft_place(t, d - step);
    along.cross(&across).normalize()
}

#[test]
fn a_tube_is_a_cylinder_for_the_whole_tool() {
    let arc = tube(ALONG_X, 2.0, 0.0, [45.0, 135.0], [0.0, 6.0]);
    let whole = cylinder([0.0; 3], [1.0, 0.0, 0.0], 2.0);
    let tools = [cutter(&[0.5, 0.25]), cutter(&[0.5, 0.1]), cutter(&[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0])];
    for tool in &tools {
        for (y, height) in [(-0.6f64, 0.02), (0.0, 0.5), (0.3, -0.004), (0.7, 0.0)] {
            let tip = [2.5, y, (4.0 - y * y).sqrt() + height];
            for axis in [[0.0, 0.0, 1.0], [0.1, 0.3, 1.0]] {
                let (value, normal, error) = clearance(tool, &arc, 1.0, tip, axis);
                let (closed, wanted, _) = clearance(tool, &whole, 1.0, tip, axis);
                if closed < -0.02 {
                    // So deep that it is no question of tolerance any more, only a lower bound is promised.
                    assert!(value <= -0.02 && value >= closed - 1e-6, "{value} {closed}");
                    continue;
                }
                assert!((value - closed).abs() <= error + 1e-9 && error < 1e-6, "{value} {closed} {error}");
                assert!((normal - wanted).norm() < 1e-3, "{normal} {wanted}");
            }
        }
    }
    // From within, a short tool hanging under the roof.
    let short = cutter(&[0.5, 0.1, 0.15, 0.1, 0.0, 0.0, 0.8]);
    for height in [1.6, 1.94] {
        let (value, ..) = clearance(&short, &arc, -1.0, [2.5, 0.2, height], [0.0, 0.0, -1.0]);
        let (closed, ..) = clearance(&short, &whole, -1.0, [2.5, 0.2, height], [0.0, 0.0, -1.0]);
        assert!((value - closed).abs() < 1e-6, "{value} {closed}");
    }
}

/// A tool that stands over the end of a surface is as deep in it as it takes to come out past the end on its own side, be some of it
/// under the surface by ever so much more, or a line that goes through.
#[test]
fn a_tool_over_the_end_is_as_deep_as_it_is_over_it() {
    let stations = [0.0, 6.0];
    let arc = tube(ALONG_X, 2.0, 0.0, [45.0, 135.0], stations);
    let end = stations[1] + (stations[1] - stations[0]) * POLYCONIC_STATIONS_BEYOND;
    let lean = 0.1f64;
    let across = Vec3::new(lean.cos(), 0.0, lean.sin());
    let axis = [-lean.sin(), 0.0, lean.cos()];
    let cylinder = cutter(&[0.5, 0.0]);
    let line = cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0]);
    for depth in [1e-5, 3e-4, 2e-3] {
        for (tool, radius) in [(&cylinder, 0.25), (&line, 0.0)] {
            // The end is .1 above the tool end.
            let tip = Vec3::new(end, 0.0, 2.0) - Vec3::from(axis) * 0.1 + across * (radius - depth);
            let profile = Profile::of(tool).expect("a tool");
            let surface = Surface::of(&arc).expect("a surface");
            let deep = Clearance { allowed: 0.01, ..Clearance::new(&surface, &profile, 1.0) };
            let found = deep.at(&tip, &Vec3::from(axis)).expect("a clearance");
            assert!(
                (found.value + depth).abs() <= found.error + 1e-9 && found.error < 1e-7,
                "{depth} {radius}: {found:?}"
            );
            assert!((found.normal - across).norm() < 1e-2, "{found:?}");
        }
    }
}

/// How far a tool is moved in a direction until no place of the end of a tube is in it, by many of these.
fn way_off_end(tool: &Tool<'_>, tip: &Vec3, out: &Vec3, end: &[Vec3]) -> f64 {
    let is_free = |way: f64| {
        let from = tip + out * way;
        end.iter().all(|place| tool.distance(&(place - from)) >= 0.0)
    };
    let (mut low, mut high) = (0.0, 0.1);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if is_free(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// Where the end crosses the edge of a tool both faces there are as near: neither leads the tool out by the least way, nor both in turn.
#[test]
fn a_tool_whose_edge_crosses_the_end_is_led_past_it_by_the_least_way() {
    let stations = [0.0, 6.0];
    let arc = tube(ALONG_X, 2.0, 0.0, [45.0, 135.0], stations);
    let surface = Surface::of(&arc).expect("a surface");
    let end = stations[1] + (stations[1] - stations[0]) * POLYCONIC_STATIONS_BEYOND;
    // The more of them the nearer to the top.
    let places: Vec<Vec3> = (-2000..=2000)
        .map(|k| 0.05 * f64::from(k) * f64::from(k).abs() / 4e6)
        .map(|angle| Vec3::new(end, 2.0 * angle.sin(), 2.0 * angle.cos()))
        .collect();
    let flat = cutter(&[0.5, 0.0]);
    let profile = Profile::of(&flat).expect("a tool");
    for lean in [0.3f64, 0.5, 0.7] {
        // Seen along the end the edge is an ellipse; it crosses the end behind the tool end.
        let axis = Vec3::new(0.2, lean.sin(), lean.cos()).normalize();
        let tool = Tool::new(&profile, axis);
        let radial = (Vec3::x() - axis * axis.x).normalize();
        for depth in [1e-4, 1e-3, 4e-3] {
            let tip = Vec3::new(end, 0.0, 2.0) + radial * (0.25 - depth) - axis * depth;
            let deep = Clearance { allowed: 0.02, ..Clearance::new(&surface, &profile, 1.0) };
            let found = deep.at(&tip, &axis).expect("a clearance");
            let outs = (0..=40).map(|k| f64::from(k) * std::f64::consts::PI / 40.0);
            let ways = outs
                .map(|angle| Vec3::new(angle.cos(), 0.0, angle.sin()))
                .map(|out| way_off_end(&tool, &tip, &out, &places));
            let least = ways.fold(f64::INFINITY, f64::min);
            let [low, high] = [found.value - found.error, found.value + found.error];
            assert!(low >= -1.01 * least - 1e-8 && high >= -least, "{lean} {depth}: {found:?}, {least}");
        }
    }
}

#[test]
fn thickness_lies_on_the_natural_normal() {
    for thickness in [0.0, 0.3, -0.2] {
        let model = Surface::of(&loft(thickness)).unwrap();
        for (t, d) in [(0.2, 0.3), (0.5, 0.5), (0.8, 0.9), (0.4, 0.1)] {
            let normal = loft_normal(t, d);
            for off in [0.05, -0.05] {
                let (distance, gradient) =
                    model.point_distance(&(loft_place(t, d) + normal * (thickness + off))).unwrap();
                assert!((distance - off).abs() < 1e-5, "{thickness} {t} {d}: {distance}");
                assert!((gradient - normal).norm() < 0.05, "{t} {d}: {gradient} {normal}");
            }
        }
    }
}

#[test]
fn square_roots_make_a_nose() {
    // z = √d over x = 4d, from y = −1 to 1: the parabola x = 4z².
    let mut values = vec![2.0];
    values.extend([0.0; 12]);
    values.extend([0.0, 0.0, 4.0]);
    for constant in [1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.7] {
        values.push(constant);
        values.extend([0.0; 7]);
    }
    values.extend([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let model = Surface::of(&Geometry::PolyConic(Remembering::new(values))).unwrap();
    for z in [0.02f64, 0.3, 0.9] {
        let foot = Vec3::new(4.0 * z * z, 0.2, z);
        // Along y × along growing x.
        let normal = Vec3::new(1.0, 0.0, -8.0 * z).normalize();
        for off in [0.05, -0.05] {
            let (distance, gradient) = model.point_distance(&(foot + normal * off)).unwrap();
            assert!((distance - off).abs() < 1e-5, "{z}: {distance}");
            assert!((gradient - normal).norm() < 0.05, "{z}: {gradient}");
        }
    }
}

#[test]
fn values_without_a_surface_are_degenerate() {
    let mut sequence = over_tube();
    let mut values = match &sequence.part.as_ref().unwrap().surface.geometry {
        Geometry::PolyConic(values) => values.to_vec(),
        other => panic!("{other:?}"),
    };
    values[15] = 0.0;
    for broken in [values.clone(), values[..78].to_vec()] {
        sequence.part.as_mut().unwrap().surface.geometry = Geometry::PolyConic(Remembering::new(broken));
        assert!(matches!(verify(&sequence, &|| false), Err(VerifyError::Degenerate { .. })));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_ball_over_a_loft_agrees_with_dense_sampling(
        at in (0.2..0.8f64, 0.2..0.8f64),
        off in 0.0..0.3f64,
        axis in direction(),
    ) {
        let (t, d) = at;
        // Above the roof, which is against the natural normal.
        let center = loft_place(t, d) - loft_normal(t, d) * (0.25 + off);
        let unit = Vec3::from(axis).normalize();
        let unit = if unit.dot(&loft_normal(t, d)) > 0.0 { -unit } else { unit };
        let ball = cutter(&[0.5, 0.25, 0.0, 0.25, 0.0, 0.0, 0.3]);
        let tip = center - unit * 0.25;
        let (value, _, error) = clearance(&ball, &loft(0.0), -1.0, tip.into(), unit.into());
        // The ball alone against the sampled surface, then closer round the nearest sample.
        let (mut middle, mut half, mut least) = ([0.5, 0.5], 0.5, f64::INFINITY);
        for _ in 0..12 {
            let from: [f64; 2] = middle;
            for i in -10..=10 {
                for k in -10..=10 {
                    let place = [from[0] + half * f64::from(i) / 10.0, from[1] + half * f64::from(k) / 10.0];
                    let there = (loft_place(place[0].clamp(0.0, 1.0), place[1]) - center).norm();
                    if there < least {
                        (least, middle) = (there, place);
                    }
                }
            }
            half *= 0.3;
        }
        prop_assert!((value - (least - 0.25)).abs() <= error + 1e-6 && error < 1e-4, "{value} ± {error}, {least}");
    }
}

/// A ball over the tube in the plane x = 3.
fn over_tube() -> CutSequence {
    let (radius, inner) = (2.25 + BAND.1, 2.25 - BAND.0);
    let step = 2.0 * f64::acos(inner / radius) * 0.999;
    let turn = 0.5f64;
    let count = (turn / step).ceil() as usize;
    let tips: Vec<Vec3> = (0..=count)
        .map(|k| {
            let (s, c) = (turn * (k as f64 / count as f64 - 0.5)).sin_cos();
            Vec3::new(3.0, radius * s, radius * c - 0.25)
        })
        .collect();
    let roof = tube(ALONG_X, 2.0, 0.0, [45.0, 135.0], [0.0, 6.0]);
    let mut part = role(roof, Relation::To, 1.0, BAND.0, BAND.1);
    // The path has its vertices right at the limit, where the error term of strips counts.
    part.outside_tolerance *= 1.001;
    let drive = role(plane([1.0, 0.0, 0.0], 3.0), Relation::On, 1.0, BAND.0, BAND.1);
    let stop = paths::end_plane(&tips, Vec3::y());
    paths::sequence(&tips, cutter(&[0.5, 0.25]), part, drive, stop, DriveSide::On)
}

fn rules(sequence: &CutSequence) -> Vec<Rule> {
    verify(sequence, &|| false).unwrap().violations.iter().map(|v| v.rule).collect()
}

#[test]
fn a_pass_over_a_polyconic_part_surface_is_proven_and_broken_ones_are_not() {
    let path = over_tube();
    let evidence = verify(&path, &|| false).unwrap();
    assert!(evidence.verified, "{evidence:?}");
    let part = evidence.part.unwrap();
    assert!((part.max - BAND.1).abs() < 1e-6 && part.min > -BAND.0 - 1e-6, "{part:?}");
    for shift in [1.5, -1.5] {
        let mut broken = path.clone();
        broken.points[2].tip.z += shift * (BAND.0 + BAND.1);
        assert_eq!(rules(&broken), [Rule::PartBand], "{shift}");
    }
    let mut turned = path.clone();
    turned.part.as_mut().unwrap().side = -1.0;
    assert!(rules(&turned).contains(&Rule::PartBand));
}

#[test]
fn a_polyconic_wall_as_drive_and_check_surface_is_judged() {
    let mut drive = paths::circle(true).sequence;
    let role_of = drive.drive.as_mut().unwrap();
    role_of.surface.geometry = tube(ALONG_Z, 2.5, 0.0, [-15.0, 105.0], [-1.0, 6.0]);
    role_of.outside_tolerance *= 1.001;
    let found = verify(&drive, &|| false).unwrap();
    assert!(found.verified, "{found:?}");
    let mut shifted = drive.clone();
    shifted.points[5].tip *= 1.001;
    assert!(rules(&shifted).contains(&Rule::DriveBand));
    drive.drive.as_mut().unwrap().side = -1.0;
    assert!(rules(&drive).contains(&Rule::DriveBand));
    // The near half of a round wall across the motion: TO, ON and PAST are told apart.
    for relation in [Relation::To, Relation::On, Relation::Past] {
        let mut sequence = paths::to_circle(relation, 1).sequence;
        let wall = &mut sequence.stop.as_mut().unwrap().role.surface;
        wall.geometry = tube(ALONG_Z, 1.0, 3.0, [135.0, 225.0], [-1.0, 6.0]);
        assert_eq!(rules(&sequence), [], "{relation:?}");
        sequence.points[0].tip.x += 0.01;
        assert!(rules(&sequence).contains(&Rule::CheckBand), "{relation:?}");
    }
}

/// Parts of a surface that may be looked at for how deep a tool is that is far in it: one deepest place to rounding at each of the ways out that are
/// tried takes forty times as many.
const FEW: u64 = 8_000;

/// A surface that a lens is far in is deep in it at many places where the lens is led out of it at one: which way it is led next is told by about the
/// deepest of them.
#[test]
fn a_lens_far_in_a_surface_is_measured_in_few_looks() {
    let functions = [
        [2.92415, -0.00096],
        [2.92415, -0.01021],
        [2.92415, -0.09809],
        [-2.92415, -0.09402],
        [-2.92415, -0.07965],
        [2.92415, 0.1239],
        [0.70712, 0.0293],
    ];
    let surface = poly_conic(ALONG_X, 0.0, 0.0, 6.0, &functions.map(|[at, by]| [at, by, 0.0]));
    let surface = Surface::of(&surface).unwrap();
    let Surface::Ruled(surface) = &surface else { panic!("{surface:?}") };
    let lens = cutter(&[1.0, 0.1875, 0.33, 0.22, 6.459909894817512, 5.0, 2.957981794971618]);
    let profile = Profile::of(&lens).unwrap();
    let mut tool = Tool::new(&profile, Vec3::new(0.3034, -0.9139, -0.2697).normalize());
    tool.depth = 1e3;
    WORK.set(0);
    let found = searched(surface, 1.0, &Vec3::new(2.5031, 2.0610, 3.5153), &tool).unwrap();
    assert!(WORK.get() < FEW, "{}", WORK.get());
    assert!(found.value + found.error > 0.0 && (found.value + 0.2).abs() < 1e-2, "{found:?}");
}
