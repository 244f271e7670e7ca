//! Vectors on which the tool axis turns: tools kept normal or at an angle to plane, sphere, cylinder and cone.

use apt_geometry::{
    Vec3,
    canonical::Geometry,
    motion::{DriveSide, Relation},
};

use super::{
    super::{
        Rule, VerifyError,
        clearance::{Clearance, Surface},
        span::between,
        tool::Profile,
        verify,
    },
    cone, cutter, cylinder,
    paths::BAND,
    plane, role, sphere,
};
use crate::sequence::{CutSequence, Stop, ToolPosition};

fn sequence(part: Geometry, tool: &[f64], places: &[(Vec3, Vec3)]) -> CutSequence {
    let at = |(tip, axis): &(Vec3, Vec3)| ToolPosition { tip: *tip, axis: axis.normalize() };
    let ends = [places[0].0, places[places.len() - 1].0];
    let forward = (ends[1] - ends[0]).normalize();
    let stop = role(plane(forward.into(), forward.dot(&ends[1])), Relation::On, -1.0, BAND.0, BAND.1);
    CutSequence {
        start: at(&places[0]),
        points: places[1..].iter().map(at).collect(),
        cutter: cutter(tool),
        part: Some(role(part, Relation::To, 1.0, BAND.0, BAND.1)),
        drive: None,
        stop: Some(Stop { role: stop, occurrence: 1, index: 0 }),
        drive_side: DriveSide::On,
        start_up: false,
        forward,
        maximum_step: 10.0,
        minimum: None,
    }
}

/// Places over an arc of a unit circle in the xz-plane about `axis`-free centre, `count` steps.
fn arc(count: usize, turn: f64, place: impl Fn(f64) -> (Vec3, Vec3)) -> Vec<(Vec3, Vec3)> {
    (0..=count).map(|k| place(turn * (k as f64 / count as f64 - 0.5))).collect()
}

/// Sequences with the tool normal to the part surface, or leaning.
fn normal_sequences() -> Vec<(&'static str, CutSequence)> {
    let flat = [0.5, 0.0];
    let bull = [0.5, 0.1];
    let radial = |phi: f64| Vec3::new(phi.sin(), 0.0, phi.cos());
    let ball = arc(40, 1.2, |phi| (radial(phi) * (2.0 + 0.5 * BAND.1), radial(phi)));
    let (s, c) = 30f64.to_radians().sin_cos();
    // Round a cone about z with its vertex at 3: at distance 2 from the axis.
    let round = arc(60, 1.2, |phi| {
        let out = Vec3::new(phi.sin(), -phi.cos(), 0.0);
        let normal = out * c + Vec3::z() * s;
        (out * 2.0 + Vec3::z() * (3.0 - 2.0 * c / s) + normal * (0.5 * BAND.1), normal)
    });
    // Leaning by an angle that grows, on a plane: the edge of the flat tool touches.
    let lean = arc(40, 0.6, |phi| {
        let (s, c) = (phi + 0.4).sin_cos();
        (Vec3::new(phi * 3.0, 0.0, 0.25 * s + 0.5 * BAND.1), Vec3::new(s, 0.0, c))
    });
    vec![
        ("sphere", sequence(sphere([0.0; 3], 2.0), &flat, &ball)),
        ("cylinder", sequence(cylinder([0.0; 3], [0.0, 1.0, 0.0], 2.0), &bull, &ball)),
        ("cone", sequence(cone([0.0, 0.0, 3.0], [0.0, 0.0, -1.0], 30.0), &bull, &round)),
        ("plane", sequence(plane([0.0, 0.0, 1.0], 0.0), &flat, &lean)),
    ]
}

fn rules(sequence: &CutSequence) -> Vec<Rule> {
    verify(sequence, &|| false).unwrap().violations.iter().map(|v| v.rule).collect()
}

/// Extremes of the part clearance by dense sampling of every vector.
fn sampled(sequence: &CutSequence) -> (f64, f64) {
    let profile = Profile::of(&sequence.cutter).unwrap();
    let surface = Surface::of(&sequence.part.as_ref().unwrap().surface.geometry).unwrap();
    let clearance = Clearance::new(&surface, &profile, 1.0);
    let places: Vec<ToolPosition> =
        std::iter::once(sequence.start).chain(sequence.points.iter().copied()).collect();
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    for pair in places.windows(2) {
        for k in 0..=500 {
            let at = between(&pair[0], &pair[1], f64::from(k) / 500.0).unwrap();
            let value = clearance.at(&at.tip, &at.axis).unwrap().value;
            range = (range.0.min(value), range.1.max(value));
        }
    }
    range
}

#[test]
fn the_axis_turns_evenly_between_two_positions() {
    let from = ToolPosition { tip: Vec3::zeros(), axis: Vec3::z() };
    let to = ToolPosition { tip: Vec3::x(), axis: Vec3::new(0.8, 0.0, 0.6) };
    for t in [0.0, 0.2, 0.7, 1.0] {
        let at = between(&from, &to, t).unwrap();
        let angle = t * 0.8f64.atan2(0.6);
        assert!((at.axis - Vec3::new(angle.sin(), 0.0, angle.cos())).norm() < 1e-15, "{t}");
        assert!((at.tip - Vec3::x() * t).norm() < 1e-15);
    }
    assert_eq!(between(&from, &ToolPosition { tip: Vec3::x(), axis: -Vec3::z() }, 0.5), None);
}

#[test]
fn tools_kept_normal_or_leaning_are_proven() {
    for (name, sequence) in normal_sequences() {
        let evidence = verify(&sequence, &|| false).unwrap();
        assert!(evidence.verified, "{name}: {evidence:?}");
        let (low, high) = sampled(&sequence);
        let part = evidence.part.unwrap();
        assert!(
            (part.min - low).abs() < 1e-6 && (part.max - high).abs() < 1e-6,
            "{name}: {part:?} {low} {high}"
        );
    }
}

#[test]
fn the_dip_over_a_sphere_has_its_closed_form() {
    // The axis turns with the normal of the sphere: at the middle of a chord it stands on it again.
    let (_, sequence) = normal_sequences().swap_remove(0);
    let part = verify(&sequence, &|| false).unwrap().part.unwrap();
    let dip = (2.0 + 0.5 * BAND.1) * (0.015f64).cos() - 2.0;
    assert!((part.min - dip).abs() < 1e-7, "{part:?} {dip}");
}

#[test]
fn a_tilted_axis_a_shifted_tip_and_a_dropped_position_are_found() {
    for (name, sequence) in normal_sequences() {
        for index in [0, 15, sequence.points.len() - 1] {
            let mut tilted = sequence.clone();
            tilted.points[index].axis = (tilted.points[index].axis + Vec3::new(0.05, 0.03, 0.0)).normalize();
            assert!(rules(&tilted).contains(&Rule::PartBand), "{name} tilted at {index}");
            for sense in [-1.5, 1.5] {
                let mut shifted = sequence.clone();
                let normal = if name == "plane" { Vec3::z() } else { shifted.points[index].axis };
                shifted.points[index].tip += normal * (sense * (BAND.0 + BAND.1));
                assert!(rules(&shifted).contains(&Rule::PartBand), "{name} shifted at {index}");
            }
        }
        let mut dropped = sequence.clone();
        dropped.points.drain(4..30);
        assert!(rules(&dropped).contains(&Rule::PartBand), "{name} with a long chord");
    }
}

#[test]
fn opposite_axes_are_not_judged() {
    let (_, mut sequence) = normal_sequences().swap_remove(3);
    sequence.points[0].axis = -sequence.start.axis;
    assert_eq!(verify(&sequence, &|| false), Err(VerifyError::NoDistance { vector: 0 }));
}

/// A stick over a plane that leans with its top on a wall and rises: its end comes nearer to the wall as fast as its top would go away from it,
/// and goes along the wall by what is left of the way.
fn rising_along_a_wall(drift: f64, drive_side: DriveSide) -> CutSequence {
    let height = 5.0;
    let at = |lean: f64, along: f64| {
        let (sine, cosine) = lean.sin_cos();
        (Vec3::new(height * sine + 0.5 * BAND.1, along, 0.5 * BAND.1), Vec3::new(-sine, 0.0, cosine))
    };
    let wall = role(plane([1.0, 0.0, 0.0], 0.0), Relation::To, 1.0, BAND.0, BAND.1);
    let floor = plane([0.0, 0.0, 1.0], 0.0);
    let places = [at(0.3, 0.0), at(0.29, drift)];
    CutSequence { drive: Some(wall), drive_side, ..sequence(floor, &[0.0, 0.0], &places) }
}

#[test]
fn a_tool_that_turns_sets_out_in_the_direction_that_it_is_told() {
    // The chord has the wall on the right, the path sets out nearly straight at it.
    let mut set_out = rising_along_a_wall(0.005, DriveSide::Left);
    assert_eq!(rules(&set_out), [Rule::Side]);
    let straight = |along: f64| Vec3::new(-1.0, along, 0.0).normalize();
    set_out.forward = straight(-0.02);
    assert_eq!(rules(&set_out), []);
    // On the other side it sets out, too, or in a direction in which no turn about that line keeps the clearances.
    for forward in [straight(0.08), Vec3::new(-1.0, -0.02, 0.1).normalize()] {
        set_out.forward = forward;
        assert_eq!(rules(&set_out), [Rule::Side], "{forward}");
    }
}
