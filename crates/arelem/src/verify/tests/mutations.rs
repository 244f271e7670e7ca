//! Valid sequences are accepted; sequences with one thing broken are rejected, for the right reason.

use apt_geometry::{
    Vec3,
    motion::{DriveSide, Relation},
};

use super::{
    super::{Evidence, Rule, VerifyError, verify},
    cylinder,
    paths::{self, BAND, Curved, Path},
    plane,
};
use crate::sequence::{CutSequence, ToolPosition};

fn judge(sequence: &CutSequence) -> Evidence {
    verify(sequence, &|| false).unwrap()
}

fn rules(sequence: &CutSequence) -> Vec<Rule> {
    judge(sequence).violations.iter().map(|v| v.rule).collect()
}

fn curved() -> Vec<Path> {
    paths::all().into_iter().filter(|p| p.curved != Curved::Neither).collect()
}

fn curved_rule(path: &Path) -> Rule {
    if path.curved == Curved::Part { Rule::PartBand } else { Rule::DriveBand }
}

#[test]
fn valid_sequences_are_proven() {
    for path in paths::all() {
        let evidence = judge(&path.sequence);
        assert!(evidence.verified, "{}: {:?}", path.name, evidence.violations);
        for extent in [evidence.part, evidence.drive, evidence.check].into_iter().flatten() {
            assert!(
                extent.min <= extent.max && extent.min >= -extent.intol - 1e-8,
                "{}: {extent:?}",
                path.name
            );
            assert!(extent.max <= extent.outtol + 1e-8, "{}: {extent:?}", path.name);
        }
    }
}

#[test]
fn extremes_are_the_true_ones() {
    // Chords of vertices at R+τo with a dip of very nearly τi.
    let path = paths::circle(true);
    let extent = judge(&path.sequence).drive.unwrap();
    assert!((extent.max - BAND.1).abs() < 1e-9, "{extent:?}");
    let step = std::f64::consts::FRAC_PI_2 / path.sequence.points.len() as f64;
    let dip = (2.75 + BAND.1) * (0.5 * step).cos() - 2.75;
    assert!((extent.min - dip).abs() < 1e-8, "{extent:?} {dip}");
}

#[test]
fn valid_sequences_are_proven_when_the_surfaces_are_quadrics() {
    for mut path in paths::all() {
        for role in [&mut path.sequence.part, &mut path.sequence.drive].into_iter().flatten() {
            role.surface.geometry = paths::as_quadric(&role.surface.geometry);
        }
        let evidence = judge(&path.sequence);
        assert!(evidence.verified, "{}: {:?}", path.name, evidence.violations);
    }
}

#[test]
fn a_shifted_vertex_is_found() {
    let tau = BAND.0 + BAND.1;
    for path in curved() {
        let count = path.sequence.points.len();
        for index in [0, count / 2, count - 1] {
            for sense in [1.5, -1.5] {
                let mut broken = path.sequence.clone();
                let tip = broken.points[index].tip;
                let normal = match path.name {
                    "ball over a sphere" => (tip + Vec3::z() * 0.25).normalize(),
                    "ball in a bowl" => (tip + Vec3::z() * 0.25 - Vec3::z() * 5.0).normalize(),
                    _ => Vec3::new(tip.x, tip.y, 0.0).normalize(),
                };
                // A cone's band is wider by 1/cos α along the radius.
                let wider = if path.name == "round a cone" { 1.2 } else { 1.0 };
                broken.points[index].tip += normal * (sense * tau * wider);
                let found = judge(&broken);
                let wanted = curved_rule(&path);
                let hit = found.violations.iter().find(|v| v.rule == wanted);
                let hit = hit.unwrap_or_else(|| panic!("{} at {index}: {found:?}", path.name));
                assert!(hit.vector == index || hit.vector == index + 1, "{} at {index}: {hit:?}", path.name);
            }
        }
    }
}

#[test]
fn a_dropped_vertex_is_found() {
    for path in curved() {
        for index in [0, path.sequence.points.len() / 2] {
            let mut broken = path.sequence.clone();
            broken.points.remove(index);
            assert!(rules(&broken).contains(&curved_rule(&path)), "{}", path.name);
        }
        let mut broken = path.sequence.clone();
        broken.points.pop();
        assert!(rules(&broken).contains(&Rule::CheckBand), "{}", path.name);
    }
}

#[test]
fn a_reversed_side_is_found() {
    for path in paths::all() {
        let mut broken = path.sequence.clone();
        let role = if path.curved == Curved::Part { &mut broken.part } else { &mut broken.drive };
        role.as_mut().unwrap().side *= -1.0;
        assert!(rules(&broken).contains(&curved_rule(&path)), "{}", path.name);
        if path.sequence.drive_side != DriveSide::On {
            let mut broken = path.sequence.clone();
            broken.drive_side =
                if broken.drive_side == DriveSide::Left { DriveSide::Right } else { DriveSide::Left };
            assert_eq!(rules(&broken), [Rule::Side], "{}", path.name);
        }
    }
}

#[test]
fn to_and_past_are_told_apart() {
    for (relation, wrong) in [(Relation::To, Relation::Past), (Relation::Past, Relation::To)] {
        for occurrence in [1, 2] {
            let mut broken = paths::to_circle(relation, occurrence).sequence;
            broken.stop.as_mut().unwrap().role.relation = wrong;
            assert_eq!(rules(&broken), [Rule::StopEvent], "{relation:?} {occurrence}");
            let mut moved = paths::to_circle(relation, occurrence).sequence;
            moved.stop = paths::to_circle(wrong, occurrence).sequence.stop;
            assert!(rules(&moved).contains(&Rule::CheckBand), "{relation:?} {occurrence}");
        }
    }
}

/// Where the path goes through the middle of the band of a check surface, to which vertices are moved, and out again, if only in the band, that
/// may be called a PAST position; where it stops before that, or comes near without going in, it may not.
#[test]
fn a_position_past_what_is_only_brushed_is_one() {
    let cases: [([f64; 2], f64, bool); 6] = [
        ([0.0004, 0.0003], 1.0, true),
        ([0.0004, 0.0003], -1.0, false),
        ([-0.0002, 0.0004], 1.0, true),
        ([-0.0003, 0.0004], 1.0, false),
        ([0.0004, -0.0001], 1.0, true),
        ([0.0004, -0.0001], -1.0, false),
    ];
    for ([depth, left], sense, is_past) in cases {
        let (near, at_end): (f64, f64) = (1.25 - depth, 1.25 + left);
        let end = 2.0 + sense * (at_end * at_end - near * near).sqrt();
        assert_stop(Relation::Past, [2.0, 1.0 - depth, 0.0], end, is_past);
    }
}

/// That the path along a line to an end beside a circle of radius 1 ends at a position of the label there, or at none.
fn assert_stop(relation: Relation, center: [f64; 3], end: f64, is_position: bool) {
    assert_stop_in(BAND, relation, center, end, is_position);
}

/// The same with another band of the circle, inside and outside.
fn assert_stop_in(band: (f64, f64), relation: Relation, center: [f64; 3], end: f64, is_position: bool) {
    let mut brushed = paths::to_circle(relation, 1).sequence;
    let stop = &mut brushed.stop.as_mut().unwrap().role;
    (stop.inside_tolerance, stop.outside_tolerance) = band;
    stop.surface.geometry = cylinder(center, [0.0, 0.0, 1.0], 1.0);
    stop.side = if relation == Relation::Past { 1.0 } else { -1.0 };
    brushed.points[0].tip.x = end;
    let wanted: &[Rule] = if is_position { &[] } else { &[Rule::StopEvent] };
    assert_eq!(rules(&brushed), wanted, "{relation:?} {center:?} {end}");
}

/// A band that is wider inside has its middle in the surface: what goes into that by less, and out again, has gone PAST it all the same, for the
/// tool cuts it there; where it stops before that, or does not cut it, it has not.
#[test]
fn a_position_past_what_is_cut_by_less_than_the_middle_of_the_band_is_one() {
    let cases: [([f64; 2], f64, bool); 6] = [
        ([0.0002, 0.0003], 1.0, true),
        ([0.0002, 0.0003], -1.0, false),
        ([0.0002, -0.0001], 1.0, true),
        ([0.0002, -0.0001], -1.0, false),
        ([-0.0001, 0.0003], 1.0, false),
        ([0.0004, -0.0001], 1.0, true),
    ];
    for ([depth, left], sense, is_past) in cases {
        let (near, at_end): (f64, f64) = (1.25 - depth, 1.25 + left);
        let end = 2.0 + sense * (at_end * at_end - near * near).sqrt();
        assert_stop_in((BAND.1, BAND.0), Relation::Past, [2.0, 1.0 - depth, 0.0], end, is_past);
    }
}

/// What leads a little into a check surface and out again does so about a vertex, between two places at which the clearance is read: it is read there, too.
#[test]
fn a_position_past_what_is_only_brushed_at_a_vertex_is_one() {
    let depth = 0.0002;
    for k in 0..8 {
        let mut brushed = paths::to_circle(Relation::Past, 1).sequence;
        brushed.drive = None;
        let stop = &mut brushed.stop.as_mut().unwrap().role;
        (stop.surface.geometry, stop.side) = (plane([0.0, 1.0, 0.0], 0.0), -1.0);
        let from = -1.0 - 1e-4 * f64::from(k);
        let tip = |x: f64| Vec3::new(x, -0.25 + depth - x.abs(), 0.0);
        brushed.start.tip = tip(from);
        brushed.points = [0.0, depth].map(|x| ToolPosition { tip: tip(x), ..brushed.start }).to_vec();
        // A corner as sharp as that without a drive surface is no path, but that is another rule.
        assert!(!rules(&brushed).contains(&Rule::StopEvent), "from {from}");
    }
}

/// Where the path comes out of a check surface, if only in the band, and goes in again, that may be called a TO position; where it stops before
/// that, or stays in, it may not.
#[test]
fn a_position_to_what_is_only_brushed_from_within_is_one() {
    let cases: [([f64; 2], f64, bool); 7] = [
        ([0.0003, 0.0003], 1.0, true),
        ([0.0003, 0.0003], -1.0, false),
        ([0.0002, 0.0004], 1.0, true),
        ([0.0002, 0.0004], -1.0, false),
        ([-0.0002, 0.0004], 1.0, false),
        ([0.0003, -0.0001], 1.0, true),
        ([0.0003, -0.0001], -1.0, false),
    ];
    for ([out, left], sense, is_to) in cases {
        let (near, at_end): (f64, f64) = (0.75 - out, 0.75 + left);
        let end = 0.9 + sense * (at_end * at_end - near * near).sqrt();
        assert_stop(Relation::To, [0.9, 0.5 - out, 0.0], end, is_to);
    }
}

/// Where the tool end goes through a check surface by less than the band and comes back to it, that may be called the second position
/// ON it; where it comes to the surface first it is the first one alone.
#[test]
fn a_position_on_what_was_gone_through_by_little_may_be_the_second() {
    let depth: f64 = 0.0004;
    let half = (1.0 - (1.0 - depth) * (1.0 - depth)).sqrt();
    for (end, occurrence, is_position) in
        [(2.0 - half, 1, true), (2.0 - half, 2, false), (2.0 + half, 2, true), (2.0 + half, 3, false)]
    {
        let mut path = paths::to_circle(Relation::On, occurrence).sequence;
        let check = &mut path.stop.as_mut().unwrap().role;
        check.surface.geometry = cylinder([2.0, 0.75 - depth, 0.0], [0.0, 0.0, 1.0], 1.0);
        path.points[0].tip.x = end;
        let wanted: &[Rule] = if is_position { &[] } else { &[Rule::StopEvent] };
        assert_eq!(rules(&path), wanted, "{end} {occurrence}");
    }
}

/// Vectors may run elsewhere in the bands of part and drive surface than others that touch: where they come near to a check surface by no more than these,
/// and go away again, that may be counted. What comes no nearer, or has not gone away, is not.
#[test]
fn a_position_that_other_vectors_touch_may_be_counted() {
    for (gap, occurrence, is_position) in
        [(0.002, 1, true), (0.002, 2, true), (0.002, 3, false), (0.02, 1, true), (0.02, 2, false)]
    {
        let mut path = paths::to_circle(Relation::To, occurrence).sequence;
        path.drive = None;
        let check = &mut path.stop.as_mut().unwrap().role;
        (check.surface.geometry, check.side) = (plane([0.0, 1.0, 0.0], 0.0), -1.0);
        let tip = |x: f64, apart: f64| Vec3::new(x, -0.25 - apart, 0.0);
        path.start.tip = tip(-1.0, 1.0);
        let tips = [tip(0.0, gap), tip(0.5, 0.5), tip(1.0, 0.0)];
        path.points = tips.map(|tip| ToolPosition { tip, ..path.start }).to_vec();
        // A corner as sharp as that without a drive surface is no path, but that is another rule.
        let is_told = !rules(&path).contains(&Rule::StopEvent);
        assert_eq!(is_told, is_position, "{gap} {occurrence}");
    }
}

#[test]
fn the_count_of_positions_is_replayed() {
    for relation in [Relation::To, Relation::On, Relation::Past] {
        for (made, asked) in [(1, 2), (2, 1), (2, 3)] {
            let mut broken = paths::to_circle(relation, made).sequence;
            broken.stop.as_mut().unwrap().occurrence = asked;
            let found = judge(&broken);
            let stop = found.violations.iter().find(|v| v.rule == Rule::StopEvent).unwrap();
            assert_eq!(stop.value, f64::from(made), "{relation:?}: {stop:?}");
        }
    }
}

#[test]
fn a_missed_tangency_is_found() {
    let mut broken = paths::tangent().sequence;
    broken.points[0].tip.x -= 0.2;
    let found = rules(&broken);
    assert!(found.contains(&Rule::Tangency), "{found:?}");
}

#[test]
fn going_back_and_long_steps_are_found() {
    for path in curved() {
        let mut broken = path.sequence.clone();
        let first = broken.points[0];
        let middle = broken.points[1];
        broken.points.insert(2, first);
        broken.points.insert(3, middle);
        assert!(rules(&broken).contains(&Rule::Progress), "{}", path.name);
        let mut short = path.sequence.clone();
        short.maximum_step = 0.01;
        assert_eq!(rules(&short), [Rule::StepLength], "{}", path.name);
        let mut turned = path.sequence.clone();
        turned.forward = -turned.forward;
        assert!(rules(&turned).contains(&Rule::Progress), "{}", path.name);
    }
}

#[test]
fn a_start_up_is_bound_at_its_end_only() {
    let mut path = paths::circle(true).sequence;
    path.start_up = true;
    path.start.tip = Vec3::new(9.0, 9.0, 9.0);
    path.forward = Vec3::zeros();
    assert!(judge(&path).verified);
    let last = path.points.len() - 1;
    path.points[last].tip.z -= 2.0 * BAND.0;
    assert_eq!(rules(&path), [Rule::PartBand]);
}

#[test]
fn point_to_point_motion_is_not_bound() {
    let mut path = paths::circle(true).sequence;
    (path.part, path.drive, path.stop) = (None, None, None);
    let evidence = judge(&path);
    assert!(evidence.verified && evidence.part.is_none() && evidence.check.is_none());
}

#[test]
fn what_cannot_be_judged_is_an_error() {
    let path = paths::circle(true).sequence;
    assert_eq!(verify(&path, &|| true), Err(VerifyError::Cancelled));
    let mut wild = path.clone();
    wild.points[3].tip.x = f64::NAN;
    assert_eq!(verify(&wild, &|| false), Err(VerifyError::NotFinite));
    let mut none = path.clone();
    none.points.clear();
    assert_eq!(verify(&none, &|| false), Err(VerifyError::Empty));
    let mut point = path;
    point.drive.as_mut().unwrap().surface.geometry = apt_geometry::canonical::Geometry::Point(Vec3::zeros());
    assert!(matches!(verify(&point, &|| false), Err(VerifyError::Unsupported { .. })));
}
