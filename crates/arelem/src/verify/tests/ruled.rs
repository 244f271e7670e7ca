//! Ruled surfaces: against the surfaces that some of them are, dense sampling, and broken sequences.

use std::cell::Cell;

use apt_geometry::{
    Vec3,
    canonical::Geometry,
    motion::{DriveSide, Relation},
    patience::{Patience, Waiting},
};
use proptest::prelude::*;

use super::{
    super::{
        Rule, VerifyError,
        clearance::Surface,
        ruled::RuledStrips,
        tool::{Profile, Tool},
        verify,
    },
    clearances::{clearance, direction, samples, tools},
    cone, cutter, cylinder,
    lines::line,
    lofts,
    paths::{self, BAND},
    plane, quadric, role, ruled, section, sphere, tabulated,
};
use crate::sequence::CutSequence;

const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// Half of a cylinder of radius 2 about z, ruled between its sections at z = −1 and 1; the natural normal is inward.
fn half_cylinder() -> Geometry {
    let wall = || cylinder([0.0; 3], UP, 2.0);
    let curve = |z: f64| section(wall(), [[-2.0, 0.0, z], [2.0, 0.0, z]], [0.0, 1.0, 0.0]);
    ruled(curve(-1.0), curve(1.0))
}

/// Half of a cone with its vertex at z = 3, over its section at z = 0; the natural normal is inward.
fn half_cone() -> Geometry {
    let peak = cone([0.0, 0.0, 3.0], [0.0, 0.0, -1.0], 30.0);
    let r = 3.0 * 30f64.to_radians().tan();
    let curve = section(peak, [[-r, 0.0, 0.0], [r, 0.0, 0.0]], [0.0, 1.0, 0.0]);
    ruled(curve, vec![Geometry::Point(Vec3::new(0.0, 0.0, 3.0))])
}

/// The twisted surface between a line and a line askew to it: z = y(1 + x/6)/4 over x from 0 to 6 and y from 0 to 4.
fn twisted() -> Geometry {
    let floor = plane([0.0, 0.0, 1.0], 0.0);
    let slope = plane([-1.0, 0.0, 6.0], 6.0);
    ruled(
        section(floor, [[0.0; 3], [6.0, 0.0, 0.0]], UP),
        section(slope, [[0.0, 4.0, 1.0], [6.0, 4.0, 2.0]], [-1.0, 0.0, 6.0]),
    )
}

/// Between an arc of a sphere and an arc of an ellipse: both curves bent, not alike.
fn bent() -> Geometry {
    let ball = sphere([0.0, -2.0, -3.0], 5.0);
    let ellipse = quadric([1.0 / 16.0, 0.0, 1.0 / 4.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let rise = 2.0 * 0.75f64.sqrt();
    ruled(
        section(ball, [[-3.0, -2.0, 1.0], [3.0, -2.0, 1.0]], UP),
        section(ellipse, [[-2.0, 3.0, rise], [2.0, 3.0, rise]], UP),
    )
}

/// A place of `bent`: shares of the chords and along the ruling.
fn bent_place(s: f64, t: f64) -> Vec3 {
    let x = -3.0 + 6.0 * s;
    let first = Vec3::new(x, -2.0, -3.0 + (25.0 - x * x).sqrt());
    let x = -2.0 + 4.0 * s;
    let second = Vec3::new(x, 3.0, 2.0 * (1.0 - x * x / 16.0).sqrt());
    first + (second - first) * t
}

#[test]
fn the_twisted_surface_has_its_equation() {
    let surface = Surface::of(&twisted()).unwrap();
    for (x, y) in [(0.5, 0.5), (3.0, 2.0), (5.9, 3.9), (8.0, 5.0), (-2.0, -1.0)] {
        let foot = Vec3::new(x, y, 0.25 * y * (1.0 + x / 6.0));
        let normal = Vec3::new(-y / 24.0, -0.25 * (1.0 + x / 6.0), 1.0).normalize();
        let (distance, gradient) = surface.point_distance(&(foot + normal * 0.1)).unwrap();
        assert!((distance - 0.1).abs() < 1e-8, "{x} {y}: {distance}");
        assert!((gradient - normal).norm() < 1e-4, "{x} {y}: {gradient}");
    }
}

#[test]
fn a_half_circle_is_a_cylinder_to_its_upright_ends() {
    let (half, whole) = (half_cylinder(), cylinder([0.0; 3], UP, 2.0));
    for degrees in [1.0f64, 20.0, 90.0, 150.0, 179.0] {
        let (s, c) = degrees.to_radians().sin_cos();
        for (side, radius) in [(-1.0, 2.3), (1.0, 1.7)] {
            let tip = [radius * c, radius * s, 0.2];
            // The tool leans away from the wall.
            let lean = 0.1 * f64::signum(radius - 2.0);
            let axis = [lean * c, lean * s, 1.0];
            let (value, normal, error) = clearance(&cutter(&[0.5, 0.1]), &half, side, tip, axis);
            let (closed, wanted, _) = clearance(&cutter(&[0.5, 0.1]), &whole, -side, tip, axis);
            assert!(
                (value - closed).abs() <= error + 1e-9 && error < 1e-7,
                "{degrees}: {value} {closed} {error}"
            );
            assert!((normal - wanted).norm() < 1e-4, "{degrees}: {normal} {wanted}");
        }
    }
}

#[test]
fn rulings_to_a_point_are_a_cone() {
    let (half, whole) = (half_cone(), cone([0.0, 0.0, 3.0], [0.0, 0.0, -1.0], 30.0));
    let tool = cutter(&[0.5, 0.25, 0.0, 0.25, 0.0, 0.0, 1.0]);
    for degrees in [10.0f64, 60.0, 120.0] {
        let (s, c) = degrees.to_radians().sin_cos();
        for (side, radius) in [(-1.0, 1.62), (1.0, 0.4)] {
            let tip = [radius * c, radius * s, 0.5];
            let (value, ..) = clearance(&tool, &half, side, tip, UP);
            let (closed, ..) = clearance(&tool, &whole, -side, tip, UP);
            assert!((value - closed).abs() < 1e-7, "{degrees}: {value} {closed}");
        }
    }
}

#[test]
fn sections_of_a_tabulated_cylinder_give_it_back() {
    let nodes: Vec<[f64; 3]> =
        (-6..=6).map(|k| 0.5 * f64::from(k)).map(|u: f64| [u, 0.4 * u.sin(), 0.4 * u.cos()]).collect();
    let wave = || tabulated([Vec3::x(), Vec3::z(), -Vec3::y()], &nodes);
    let [low, high] = [-2.0f64, 2.0].map(|u| 0.4 * u.sin());
    let curve = |y: f64| section(wave(), [[-2.0, y, low], [2.0, y, high]], UP);
    // From y = 1 to −1, so that the natural normal is up as that of the wave.
    let surface = ruled(curve(-1.0), curve(1.0));
    for x in [-1.5, -0.3, 0.0, 0.9, 1.7] {
        let tip = [x, 0.1, 0.4 * f64::sin(x) + 0.05];
        let (value, ..) = clearance(&cutter(&[0.5, 0.25]), &surface, 1.0, tip, [0.1, 0.0, 1.0]);
        let (closed, ..) = clearance(&cutter(&[0.5, 0.25]), &wave(), 1.0, tip, [0.1, 0.0, 1.0]);
        assert!((value - closed).abs() < 1e-7, "{x}: {value} {closed}");
    }
}

#[test]
fn sections_that_miss_their_ends_are_degenerate() {
    let ball = sphere([0.0; 3], 1.0);
    let far = section(ball, [[-3.0, 0.0, 0.0], [3.0, 0.0, 0.0]], UP);
    let floor = section(plane(UP, 0.0), [[-3.0, 1.0, 0.0], [3.0, 1.0, 0.0]], UP);
    let mut broken = over_twisted();
    broken.part.as_mut().unwrap().surface.geometry = ruled(far, floor);
    assert!(matches!(verify(&broken, &|| false), Err(VerifyError::Degenerate { .. })));
    broken.part.as_mut().unwrap().surface.geometry = ruled(Vec::new(), Vec::new());
    assert!(matches!(verify(&broken, &|| false), Err(VerifyError::Degenerate { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn bent_rulings_agree_with_dense_sampling(
        tool in tools(),
        at in (0.1..0.9f64, 0.1..0.9f64, 0.0..0.5f64),
        axis in direction(),
    ) {
        let surface = bent();
        let foot = bent_place(at.0, at.1);
        let tip = foot + Vec3::z() * at.2;
        let (value, normal, error) = clearance(&tool, &surface, 1.0, tip.into(), axis);
        prop_assert!((normal.norm() - 1.0).abs() < 1e-9);
        // Distance to the tool of places of the surface: the tool's boundary sampled against the surface sampled is
        // too coarse, but the height of the tool's samples over the surface says whether it is clear.
        let model = Surface::of(&surface).unwrap();
        let unit = Vec3::from(axis).normalize();
        let samples = samples(&tool, tip, unit);
        let lowest = |step: usize| {
            let heights = samples.iter().step_by(step).map(|x| model.point_distance(x).unwrap().0);
            heights.fold(f64::INFINITY, f64::min)
        };
        let mut sampled = lowest(499);
        // Of a long flank few samples may be too far apart.
        if sampled > 0.1 && sampled - value >= 0.1 {
            sampled = lowest(7);
        }
        prop_assert!(value <= sampled.max(-0.02) + 1e-6, "value {value} ± {error} sampled {sampled}");
        if sampled > 0.1 {
            prop_assert!(sampled - value < 0.1 && error < 1e-6, "value {value} ± {error} sampled {sampled}");
        }
    }

    #[test]
    fn the_nearest_place_of_bent_rulings_is_nearest(
        x in (-2.0..2.0f64, -2.0..3.0f64, 0.0..4.0f64),
    ) {
        let p = Vec3::new(x.0, x.1, x.2);
        let model = Surface::of(&bent()).unwrap();
        let (distance, normal) = model.point_distance(&p).unwrap();
        let mut least = f64::INFINITY;
        for i in 0..=60 {
            for k in 0..=60 {
                let place = bent_place(f64::from(i) / 60.0, f64::from(k) / 60.0);
                least = least.min((place - p).norm());
            }
        }
        prop_assert!(distance.abs() <= least + 1e-8, "{distance} {least}");
        // Over the middle of the surface nothing beyond its ends is nearer.
        if distance.abs() < 0.3 && x.0.abs() < 1.5 && x.1 > -1.5 && x.1 < 2.5 {
            prop_assert!(least - distance.abs() < 0.05, "{distance} {least}");
            prop_assert!((normal.z > 0.0) && (distance > 0.0) == (p.z > (p - normal * distance).z));
        }
    }
}

#[test]
fn a_coarse_model_is_as_close_as_it_was_asked_to_be() {
    let surface = half_cylinder();
    for accuracy in [1e-5, 1e-6, 1e-8] {
        let model = Surface::within(&surface, accuracy, Patience::default()).unwrap();
        assert!(model.error() <= accuracy, "{} for {accuracy}", model.error());
        for k in 1..40 {
            let angle = std::f64::consts::PI * f64::from(k) / 40.0;
            let p = Vec3::new(1.7 * angle.cos(), 1.7 * angle.sin(), 0.3);
            let distance = model.point_distance(&p).unwrap().0;
            assert!((distance - 0.3).abs() <= accuracy + 1e-10, "{distance} for {accuracy}");
        }
    }
}

/// A ball over the twisted surface, along x at y = 2: the centre a little more than its radius off the surface.
fn over_twisted() -> CutSequence {
    let count = 40;
    let tips: Vec<Vec3> = (0..=count)
        .map(|k| {
            let x = 1.0 + 4.0 * f64::from(k) / f64::from(count);
            // The foot whose normal passes through the plane y = 2 with the centre there.
            let reach = 0.25 + 0.5 * BAND.1;
            let mut y: f64 = 2.0;
            let mut foot = Vec3::zeros();
            let mut normal = Vec3::z();
            for _ in 0..60 {
                let fx = x - reach * normal.x;
                foot = Vec3::new(fx, y, 0.25 * y * (1.0 + fx / 6.0));
                normal = Vec3::new(-y / 24.0, -0.25 * (1.0 + fx / 6.0), 1.0).normalize();
                y = 2.0 - reach * normal.y;
            }
            foot + normal * reach - Vec3::z() * 0.25
        })
        .collect();
    let part = role(twisted(), Relation::To, 1.0, BAND.0, BAND.1);
    let drive = role(plane([0.0, 1.0, 0.0], 2.0), Relation::On, 1.0, BAND.0, BAND.1);
    let stop = paths::end_plane(&tips, Vec3::x());
    paths::sequence(&tips, cutter(&[0.5, 0.25]), part, drive, stop, DriveSide::On)
}

fn rules(sequence: &CutSequence) -> Vec<Rule> {
    verify(sequence, &|| false).unwrap().violations.iter().map(|v| v.rule).collect()
}

#[test]
fn a_pass_over_a_twisted_surface_is_proven_and_broken_ones_are_not() {
    let path = over_twisted();
    let evidence = verify(&path, &|| false).unwrap();
    assert!(evidence.verified, "{evidence:?}");
    let part = evidence.part.unwrap();
    assert!((part.max - 0.5 * BAND.1).abs() < 1e-6, "{part:?}");
    for index in [1, 20] {
        for shift in [1.5, -1.5] {
            let mut broken = path.clone();
            broken.points[index].tip.z += shift * (BAND.0 + BAND.1);
            assert_eq!(rules(&broken), [Rule::PartBand], "{index} {shift}");
        }
    }
    let mut turned = path.clone();
    turned.part.as_mut().unwrap().side = -1.0;
    assert!(rules(&turned).contains(&Rule::PartBand));
}

#[test]
fn a_ruled_wall_as_drive_and_check_surface_is_judged() {
    // The half cylinder from outside, a quarter turn counter-clockwise; its natural normal is inward.
    let mut drive = paths::circle(true);
    let shifted = |r: f64| {
        let wall = || cylinder([0.0; 3], UP, r);
        let curve = |z: f64| section(wall(), [[-r, 0.0, z], [r, 0.0, z]], [0.0, 1.0, 0.0]);
        ruled(curve(-1.0), curve(6.0))
    };
    let role_of = drive.sequence.drive.as_mut().unwrap();
    role_of.surface.geometry = shifted(2.5);
    role_of.side = -1.0;
    // The path has its vertices right at the limit, where the error term of a surface of no known shape counts.
    role_of.outside_tolerance *= 1.001;
    let found = verify(&drive.sequence, &|| false).unwrap();
    assert!(found.verified, "{found:?}");
    drive.sequence.points[5].tip *= 1.001;
    assert!(rules(&drive.sequence).contains(&Rule::DriveBand));
    // A wall across the motion as check surface: TO, ON and PAST are told apart.
    let wall = |x: f64| {
        let across = || plane([1.0, 0.0, 0.0], x);
        let curve = |z: f64| section(across(), [[x, -3.0, z], [x, 3.0, z]], [1.0, 0.0, 0.0]);
        ruled(curve(-1.0), curve(6.0))
    };
    for (relation, x, side) in
        [(Relation::To, 3.75, -1.0), (Relation::On, 4.0, -1.0), (Relation::Past, 4.25, 1.0)]
    {
        let mut sequence = paths::to_circle(relation, 1).sequence;
        sequence.points[0].tip.x = x;
        let stop = sequence.stop.as_mut().unwrap();
        stop.role = role(wall(4.0), relation, side, BAND.0, BAND.1);
        assert_eq!(rules(&sequence), [], "{relation:?}");
        sequence.points[0].tip.x += 0.01;
        assert!(rules(&sequence).contains(&Rule::CheckBand), "{relation:?}");
    }
}

/// A straight line under the vault, as near to it with one end as with the other: no ball that touches there holds all of it.
#[test]
fn a_line_along_a_hollow_is_measured_by_its_pieces() {
    let surface = Surface::of(&bent()).unwrap();
    let Surface::Ruled(ruled) = &surface else { panic!("{surface:?}") };
    for (places, below) in [
        ([[0.2, 0.3], [0.8, 0.3]], [1e-3, 1.3e-3]),
        ([[0.7, 0.6], [0.3, 0.5]], [2e-3, 1.8e-3]),
        ([[0.25, 0.7], [0.75, 0.2]], [-1e-3, 5e-4]),
    ] {
        let ends: [Vec3; 2] =
            std::array::from_fn(|k| bent_place(places[k][0], places[k][1]) - Vec3::z() * below[k]);
        let way = ends[1] - ends[0];
        let profile = Profile::of(&cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, way.norm()])).unwrap();
        let mut tool = Tool::new(&profile, way.normalize());
        tool.depth = 0.01;
        let found = ruled.followed(-1.0, &ends[0], &tool).expect("it is shown");
        let samples = (0..=400).map(|k| {
            let place = ends[0] + way * (f64::from(k) / 400.0);
            -surface.point_distance(&place).expect("a distance").0
        });
        let least = samples.fold(f64::INFINITY, f64::min);
        let error = found.error + 2.0 * ruled.error() + 1e-9;
        assert!((found.value - least).abs() <= error && error < 1e-5, "{found:?} {least}");
    }
}

/// How often one may be asked whether to go on while a line is measured that leans away from what it touches: more than 140 times did not always do.
const ASKED: u32 = 70;

/// A line that touches a hollow surface with one end and leans away from it is far from it but for a little of its length, which is told by what
/// holds the parts of the surface; and the place where it touches is told from its end, on whichever of its pieces that is.
#[test]
fn the_pieces_of_a_line_that_are_off_a_hollow_are_told_in_few_looks() {
    let surface = Surface::of(&half_cone()).unwrap();
    let Surface::Ruled(ruled) = &surface else { panic!("{surface:?}") };
    for [low, high] in [
        [[-0.088_949, -0.094_951, 2.831_576], [0.013_804, 0.601_478, 1.956_202]],
        [[0.144_398, -0.085_717, 2.733_099], [-0.878_850, 1.162_340, 0.474_334]],
        [[0.106_128, -0.123_793, 2.780_959], [0.261_334, 1.101_540, 1.037_385]],
        [[-0.110_809, -0.035_581, 2.630_482], [0.446_691, 1.201_706, 0.777_706]],
        [[0.113_097, -0.072_928, 2.746_306], [-0.028_282, 0.600_184, 1.957_564]],
    ] {
        let [low, high] = [low, high].map(Vec3::from);
        let way = high - low;
        let profile = line(way.norm());
        let asked = Cell::new(0);
        let count = || {
            asked.set(asked.get() + 1);
            false
        };
        let waiting = Waiting::until(&count);
        let mut tool = Tool::new(&profile, way.normalize());
        (tool.depth, tool.patience) = (0.01, waiting.patience());
        let found = ruled.followed(1.0, &low, &tool).expect("it is shown");
        assert!(asked.get() <= ASKED, "{low:?}: {}", asked.get());
        let at = |height: f64| surface.point_distance(&(low + tool.axis * height)).expect("a distance").0;
        let least = (0..=400).map(|k| at(way.norm() * f64::from(k) / 400.0)).fold(f64::INFINITY, f64::min);
        let error = found.error + 2.0 * ruled.error() + 1e-9;
        assert!((found.value - least).abs() <= error && error < 1e-5, "{found:?} {least}");
        if let Some(place) = found.place {
            let own = at(place.dot(&tool.axis));
            assert!((own - found.value).abs() <= error, "{place:?} is as far as {own}: {found:?}");
        }
    }
}

/// Contacts near the ends of curves that do not stand upright there: the strips spread evenly up to them.
#[test]
fn contacts_beside_the_end_of_a_curve_are_followed() {
    let surface = Surface::of(&twisted()).unwrap();
    let Surface::Ruled(ruled) = &surface else { panic!("{surface:?}") };
    let drill = cutter(&[0.3, 0.0, 0.15, 0.09, 31.0, 0.0, 2.0]);
    for profile in [&Profile::tool_end(), &Profile::of(&drill).unwrap()] {
        let tool = Tool::new(profile, Vec3::z());
        for x in [0.02, 0.002, 0.0, -0.002, 5.98, 5.998, 6.0, 6.002] {
            let y = 1.7;
            let tip = Vec3::new(x, y, 0.25 * y * (1.0 + x / 6.0) + 0.01);
            let found = ruled.followed(1.0, &tip, &tool).expect("it is followed");
            assert!(found.value < 0.01 + 1e-6 && found.error < 1e-6, "{x}: {found:?}");
        }
    }
}

/// However rough the model is: that its patches are off the surface by a little makes no edges between the ends of the curves.
#[test]
fn a_surface_that_is_smooth_between_the_ends_of_its_curves_has_no_edges_there() {
    let Geometry::RuledSurface(surface) = &lofts::roof() else { panic!("a ruled surface") };
    for accuracy in [0.0, 1e-9, 1e-6, 1e-3] {
        let strips = RuledStrips::of(surface, accuracy, Patience::default()).expect("patches");
        // Its chords go from x = −2 to x = 2.
        let inside = |place: &Vec3| place.x.abs() < 2.0 + 1e-9;
        let joints = strips.sheet.patches.iter().filter(|patch| inside(&patch.net[0][0]));
        let edges: Vec<bool> = joints.map(|patch| patch.edges.sides[0]).collect();
        assert!(edges.len() >= 4 && edges.iter().all(|is_edge| !is_edge), "{accuracy}: {edges:?}");
    }
}

/// Beyond the point in which all rulings meet that is the nearest place, which has the normals of all of them.
#[test]
fn what_is_beyond_an_apex_is_as_far_away_as_that() {
    let surface = Surface::of(&half_cone()).unwrap();
    let apex = Vec3::new(0.0, 0.0, 3.0);
    for away in [[0.0, 0.0, 1.0], [0.3, 0.2, 0.9], [-0.1, 0.05, 4.0], [0.0, 5e-4, 1e-3], [0.0, 0.0, 0.0]] {
        let away = Vec3::from(away);
        let (distance, normal) = surface.point_distance(&(apex + away)).expect("a distance");
        assert!((distance.abs() - away.norm()).abs() < 1e-9, "{away:?}: {distance}");
        let is_along = normal.dot(&away) * distance.signum() > (1.0 - 1e-6) * away.norm();
        assert!(away.norm() == 0.0 || is_along, "{away:?}: {normal:?}");
    }
}
