//! Regional milling on a patch: where passes start and end, the band at every location by an independent dense search,
//! patterns, avoidance.

use std::sync::Arc;

use std::cell::Cell;

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Plane, Remembering},
    cutter::Cutter,
    motion::NamedSurface,
    parametric::{CurveArc, Mesh, Patch, SculpturedSurface, SpaceCurve},
    regional::*,
};
use apt_sculptured::{
    error::MillingError,
    mill::{Milled, Move, Remedy, Setting, mill},
    tool::{Pose, Tool},
};

/// A hill 6 by 4.5 units; control points in rows along x.
const HILL: [[f64; 4]; 4] =
    [[0.0, 0.5, 0.8, 0.2], [0.3, 1.4, 1.1, 0.4], [0.2, 1.2, 1.6, 0.5], [0.1, 0.6, 0.7, 0.0]];
/// A valley of constant section.
const VALLEY: [[f64; 4]; 4] = [[3.0, -2.0, -2.0, 3.0]; 4];
/// A steep step.
const STEP: [[f64; 4]; 4] = [[0.0, 0.0, 6.0, 6.0]; 4];
const BUMP: [[f64; 4]; 4] = [[0.0; 4], [0.0, 5.0, 5.0, 0.0], [0.0, 5.0, 5.0, 0.0], [0.0; 4]];

/// The surface at parameters, by its definition.
fn at(heights: &[[f64; 4]; 4], u: f64, v: f64) -> Vec3 {
    let bernstein = |t: f64| {
        let s = 1.0 - t;
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
    };
    let (bu, bv) = (bernstein(u), bernstein(v));
    let z: f64 = (0..4).map(|j| (0..4).map(|i| bu[i] * bv[j] * heights[j][i]).sum::<f64>()).sum();
    Vec3::new(6.0 * u, 4.5 * v, z)
}

fn patch(heights: &[[f64; 4]; 4]) -> NamedSurface {
    let points = std::array::from_fn(|i| {
        std::array::from_fn(|j| Vec3::new(2.0 * i as f64, 1.5 * j as f64, heights[j][i]))
    });
    let patches = vec![Patch::from_points(&points)];
    let surface = SculpturedSurface::assembled(patches, Some((1, 1)), Vec::new(), 1.0, Mesh::default());
    NamedSurface { name: "S".to_owned(), geometry: Geometry::Sculptured(Remembering::new(surface)) }
}

const RANGE: ParameterRange = ParameterRange { low: 0.1, high: 0.9 };

fn command(heights: &[[f64; 4]; 4]) -> RegionalMilling {
    let surface = patch(heights);
    RegionalMilling {
        command: RegionalCommand::Path(pass([0.1, 0.5], FeedDirection::Spline, Sense::Plus)),
        guide: GuideCondition {
            guide: Guide::Surface { surface: surface.clone(), u: RANGE, v: RANGE },
            contact: GuideContact::On,
            projection: Projection::Vector(-Vec3::z()),
        },
        part: PartCondition { relation: PartRelation::To, surface, side: Sense::Plus, thickness: 0.0 },
        axis: AxisCondition::Fixed(Vec3::z()),
        checked: CheckedSurfaces::default(),
        avoidance: AvoidanceControl::default(),
        check_chords: false,
        list_avoidance: false,
    }
}

fn pass(start: [f64; 2], direction: FeedDirection, sense: Sense) -> Pass {
    Pass { start, direction, sense, skip: false }
}

fn setting(cutter: &[f64], band: f64) -> Setting {
    let cutter = Cutter::from_numbers(cutter, 1.0).expect("a cutter");
    Setting { cutter: Some(cutter), inside: band, outside: band, maximum_step: 1.0 }
}

fn run(command: &RegionalMilling, setting: &Setting) -> Milled {
    mill(command, setting, &|| false)
}

fn ends(milled: &Milled) -> (Pose, Pose) {
    (*milled.locations().next().expect("a location"), *milled.locations().next_back().expect("a location"))
}

/// The public system ends its searches at about this distance.
const PUBLIC_PRECISION: f64 = 1e-4;

fn near(found: &Vec3, expected: [f64; 3]) {
    assert!(
        (found - Vec3::from(expected)).norm() < PUBLIC_PRECISION,
        "found {found:?}, expected {expected:?}"
    );
}

/// Greatest depth of the surface in the tool by a dense search that uses nothing of the engine but the tool's profile.
fn dense_depth(heights: &[[f64; 4]; 4], setting: &Setting, pose: &Pose) -> f64 {
    let tool = Tool::new(&setting.cutter.expect("a cutter"), 0.0);
    let depth = |u: f64, v: f64| tool.depth(pose, &at(heights, u, v)).value;
    let (mut best, mut half) = ((f64::NEG_INFINITY, 0.5, 0.5), 0.5);
    let mut cells = 60;
    while half > 1e-9 {
        let (_, u, v) = best;
        for i in 0..=cells {
            for j in 0..=cells {
                let share = |k: i32| half * (2.0 * f64::from(k) / f64::from(cells) - 1.0);
                let (a, b) = ((u + share(i)).clamp(0.0, 1.0), (v + share(j)).clamp(0.0, 1.0));
                let value = depth(a, b);
                if value > best.0 {
                    best = (value, a, b);
                }
            }
        }
        (half, cells) = (half * 0.2, 12);
    }
    best.0
}

/// Every location touches the surface within the band.
fn in_band(heights: &[[f64; 4]; 4], milled: &Milled, setting: &Setting) {
    for pose in milled.locations() {
        let depth = dense_depth(heights, setting, pose);
        assert!(depth <= setting.inside + 1e-6 && depth >= -setting.outside - 1e-6, "{depth} at {pose:?}");
    }
}

#[test]
fn a_pass_starts_and_ends_where_the_public_system_does() {
    let table: &[(&[f64], [f64; 3], [f64; 3])] = &[
        (&[0.5, 0.25], [0.5993881, 2.2500036, 0.4669229], [5.4005441, 2.2500193, 0.6003818]),
        (&[0.8, 0.2], [0.3993883, 2.2511981, 0.4637366], [5.6005221, 2.2468488, 0.5979367]),
    ];
    for (cutter, first, last) in table {
        let setting = setting(cutter, 0.002);
        let milled = run(&command(&HILL), &setting);
        assert_eq!(milled.failure, None);
        let found = ends(&milled);
        near(&found.0.end, *first);
        near(&found.1.end, *last);
        in_band(&HILL, &milled, &setting);
        assert!(milled.locations().count() <= 20, "{}", milled.locations().count());
    }
}

#[test]
fn an_axis_at_an_angle_leans_as_that_of_the_public_system() {
    let alpha = 10.0f64.to_radians();
    let lead = 5.0f64.to_radians();
    let table = [
        (AxisReference::Guide, [0.5184211, 2.1189096, 0.4536792], [-0.2614086, 0.1750703, 0.949206]),
        (AxisReference::Part, [0.6934512, 2.1011399, 0.518647], [-0.4208266, 0.1750363, 0.890094]),
    ];
    for (reference, end, axis) in table {
        let mut command = command(&HILL);
        command.axis = AxisCondition::AtAngle { reference, across: alpha, lead };
        let setting = setting(&[0.5, 0.1], 0.002);
        let milled = run(&command, &setting);
        let (first, _) = ends(&milled);
        near(&first.axis, axis);
        near(&first.end, end);
        in_band(&HILL, &milled, &setting);
    }
}

#[test]
fn a_pass_ends_at_the_edge_where_the_range_reaches_beyond_it() {
    let setting = setting(&[0.5, 0.25], 0.002);
    let over = |low: f64, high: f64| {
        let mut command = command(&HILL);
        if let Guide::Surface { u, .. } = &mut command.guide.guide {
            (u.low, u.high) = (low, high);
        }
        command.command = RegionalCommand::Path(pass([0.5, 0.5], FeedDirection::Spline, Sense::Plus));
        run(&command, &setting)
    };
    let (beyond, exact) = (over(-0.3, 1.5), over(0.0, 1.0));
    assert_eq!((&beyond.failure, &exact.failure), (&None, &None));
    assert!(beyond.locations().eq(exact.locations()));
}

#[test]
fn the_tool_end_runs_on_the_surface() {
    let mut command = command(&HILL);
    command.part.relation = PartRelation::On;
    let milled = run(&command, &setting(&[0.5, 0.25], 0.002));
    let (first, last) = ends(&milled);
    near(&first.end, [0.5993706, 2.2500038, 0.4505864]);
    near(&last.end, [5.4004893, 2.2499946, 0.5878338]);
}

#[test]
fn skip_leaves_the_first_location_out() {
    let setting = setting(&[0.5, 0.25], 0.002);
    let all: Vec<Pose> = run(&command(&HILL), &setting).locations().copied().collect();
    let mut skipping = command(&HILL);
    skipping.command =
        RegionalCommand::Path(Pass { skip: true, ..pass([0.1, 0.5], FeedDirection::Spline, Sense::Plus) });
    let rest: Vec<Pose> = run(&skipping, &setting).locations().copied().collect();
    assert_eq!(rest, all[1..]);
}

#[test]
fn a_position_backs_off() {
    let mut command = command(&HILL);
    let plane = Plane { normal: Vec3::z(), distance: 4.0 };
    let table = [
        (Retract::Vector(Vec3::new(0.0, 1.0, 1.0)), [2.9999457, 3.2499711, 1.9394502]),
        (Retract::Plane(plane), [2.9999457, 2.2499711, 4.0]),
        (Retract::Distance(1.0), [2.9999457, 2.2499711, 1.9394502]),
    ];
    for (retract, expected) in table {
        command.command = RegionalCommand::Position { start: [0.5, 0.5], retract };
        let milled = run(&command, &setting(&[0.5, 0.25], 0.002));
        assert_eq!(milled.locations().count(), 1);
        near(&ends(&milled).0.end, expected);
    }
}

fn region(greatest: f64, scallop: f64, lift: f64, passes: Option<u32>) -> Region {
    Region {
        pass: pass([0.1, 0.1], FeedDirection::Spline, Sense::Plus),
        stepover_sense: Sense::Plus,
        feed: FeedCondition { cutting: 1.0, stepover: 2.0, plunge: 3.0, rapid: 4.0 },
        stepover: StepoverCondition { scallop, greatest, lift, passes },
    }
}

fn feeds(milled: &Milled) -> Vec<f64> {
    let feed = |part: &Move| if let Move::Feed(feed) = part { Some(*feed) } else { None };
    milled.moves.iter().filter_map(feed).collect()
}

/// The y of the passes: where runs of locations at feed 1 (or before any feed) are.
fn lanes(milled: &Milled) -> Vec<f64> {
    let mut feed = 1.0;
    let mut lanes: Vec<f64> = Vec::new();
    for part in &milled.moves {
        match part {
            Move::Feed(next) => feed = *next,
            Move::Locations(poses) if feed == 1.0 => lanes.push(poses[0].end.y),
            Move::Locations(_) => {}
        }
    }
    lanes
}

#[test]
fn a_zigzag_covers_the_range_and_keeps_its_step() {
    let setting = setting(&[0.5, 0.25], 0.002);
    let mut command = command(&HILL);
    command.command = RegionalCommand::Zigzag(region(0.4, 0.0, 0.5, None));
    let milled = run(&command, &setting);
    assert_eq!(milled.failure, None);
    let lanes = lanes(&milled);
    assert_eq!(milled.passes as usize, lanes.len());
    assert!((lanes[0] - 0.4496194).abs() < 2e-6);
    assert!((lanes[lanes.len() - 1] - 4.05).abs() < 0.001, "{lanes:?}");
    assert!(lanes.windows(2).all(|pair| pair[1] - pair[0] <= 0.4), "{lanes:?}");
    assert!(lanes.len() <= 12, "{lanes:?}");
    assert_eq!(feeds(&milled)[..6], [2.0, 3.0, 1.0, 2.0, 3.0, 1.0]);
    near(&ends(&milled).0.end, [0.59953, 0.4496194, 0.2780174]);
    // No location is deeper than the band, lifted ones are far above it.
    for pose in milled.locations() {
        let depth = dense_depth(&HILL, &setting, pose);
        assert!(depth <= setting.inside + 1e-6 && depth >= -0.51, "{depth}");
    }
}

#[test]
fn the_number_of_passes_counts_cutting_passes() {
    let mut command = command(&HILL);
    command.command = RegionalCommand::Zigzag(region(-0.2, 0.0, 0.0, Some(3)));
    let milled = run(&command, &setting(&[0.5, 0.25], 0.002));
    assert_eq!(milled.passes, 3);
    let last = ends(&milled).1;
    assert!((last.end.y - 4.5 * 0.5).abs() < 0.001 && last.end.x > 5.0, "{last:?}");
}

#[test]
fn scallops_stay_below_the_height_asked_for() {
    let mut command = command(&HILL);
    command.command = RegionalCommand::Zigzag(region(1.0, 0.02, 0.5, None));
    let lanes = lanes(&run(&command, &setting(&[0.5, 0.25], 0.002)));
    // On a plane the ball of radius 0.25 would step 0.196; the hill is convex.
    assert!(lanes.windows(2).all(|pair| pair[1] - pair[0] <= 0.196), "{lanes:?}");
    assert!(lanes.windows(2).rev().skip(1).all(|pair| pair[1] - pair[0] >= 0.15), "{lanes:?}");
}

#[test]
fn pickfeed_cuts_one_way_and_travels_on_the_plane() {
    let mut command = command(&HILL);
    let clearance = Plane { normal: Vec3::z(), distance: 4.0 };
    command.command = RegionalCommand::Pickfeed { region: region(0.6, 0.0, 0.5, None), clearance };
    let milled = run(&command, &setting(&[0.5, 0.25], 0.002));
    assert_eq!(milled.failure, None);
    assert_eq!(feeds(&milled)[..5], [4.0, 3.0, 2.0, 3.0, 1.0]);
    let travelling: Vec<_> = milled.locations().filter(|pose| (pose.end.z - 4.0).abs() < 1e-12).collect();
    assert_eq!(travelling.len(), 2 * (milled.passes as usize - 1));
    let (_, last) = ends(&milled);
    assert!(last.end.x > 5.3 && (last.end.y - 4.05).abs() < 0.001, "{last:?}");
}

#[test]
fn the_other_direction_runs_backwards() {
    let mut command = command(&HILL);
    command.command = RegionalCommand::Path(pass([0.5, 0.9], FeedDirection::CrossSpline, Sense::Minus));
    let setting = setting(&[0.5, 0.25], 0.002);
    let milled = run(&command, &setting);
    let (first, last) = ends(&milled);
    assert!(first.end.y > 4.0 && last.end.y < 0.5);
    in_band(&HILL, &milled, &setting);
}

#[test]
fn a_guide_curve_is_projected_along_the_vector() {
    let mut command = command(&HILL);
    let corners = [Vec3::new(1.0, 1.0, 4.0), Vec3::new(3.0, 2.5, 4.0), Vec3::new(5.0, 2.0, 4.0)];
    let arcs = corners.windows(2).map(|pair| CurveArc::segment(&pair[0], &pair[1])).collect();
    let curve = Geometry::SpaceCurve(Arc::new(SpaceCurve::of_arcs(arcs)));
    command.guide.guide = Guide::Curve {
        curve: NamedSurface { name: "E".to_owned(), geometry: curve },
        u: ParameterRange { low: 0.1, high: 1.9 },
    };
    command.command = RegionalCommand::Path(pass([0.1, 0.0], FeedDirection::Spline, Sense::Plus));
    let setting = setting(&[0.5, 0.25], 0.002);
    let milled = run(&command, &setting);
    assert_eq!(milled.failure, None);
    in_band(&HILL, &milled, &setting);
    let (first, last) = ends(&milled);
    assert!((first.end.xy() - nalgebra::Vector2::new(1.2, 1.15)).norm() < 0.002, "{first:?}");
    assert!((last.end.xy() - nalgebra::Vector2::new(4.8, 2.05)).norm() < 0.002, "{last:?}");
    // A pass stops where the arcs meet.
    assert!(milled.locations().any(|pose| (pose.end.xy() - corners[1].xy()).norm() < 0.002));
}

#[test]
fn checked_chords_stay_in_the_band() {
    let setting = setting(&[0.8, 0.2], 0.002);
    let mut command = command(&HILL);
    command.check_chords = true;
    let milled = run(&command, &setting);
    assert_eq!(milled.failure, None);
    let poses: Vec<Pose> = milled.locations().copied().collect();
    for pair in poses.windows(2) {
        for share in [0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875] {
            let end = pair[0].end + (pair[1].end - pair[0].end) * share;
            let depth = dense_depth(&HILL, &setting, &Pose { end, axis: Vec3::z() });
            assert!(depth <= 1.1 * setting.inside && depth >= -1.1 * setting.outside, "{depth} at {share}");
        }
    }
}

fn checked(heights: &[[f64; 4]; 4], lift: LiftDirection, limit: f64) -> RegionalMilling {
    let mut command = command(heights);
    command.checked.part = true;
    command.avoidance = AvoidanceControl { enabled: true, tilt: None, lift, limit: Some(limit) };
    command
}

#[test]
fn a_ball_too_large_for_a_valley_stops_and_is_told() {
    let setting = setting(&[6.0, 3.0], 0.005);
    let mut command = command(&VALLEY);
    let unchecked = run(&command, &setting);
    assert!(
        matches!(unchecked.failure, Some(MillingError::TooManyReductions { .. })),
        "{:?}",
        unchecked.failure
    );
    assert_eq!(unchecked.failure.as_ref().and_then(MillingError::number), Some(3552));
    assert!(unchecked.encounters.is_empty());
    near(&ends(&unchecked).0.end, [0.6, 2.25, 6.5777472]);
    command.checked.part = true;
    let told = run(&command, &setting);
    assert_eq!(told.failure, unchecked.failure);
    assert!(!told.encounters.is_empty());
    for encounter in &told.encounters {
        let depth = dense_depth(&VALLEY, &setting, &encounter.pose);
        assert!((encounter.hit.depth - depth).abs() < 1e-5, "{encounter:?} against {depth}");
        assert_eq!(encounter.remedy, Remedy::None);
    }
}

#[test]
fn a_flat_cutter_is_lifted_out_of_a_valley_no_farther_than_needed() {
    let setting = setting(&[3.0], 0.005);
    let milled = run(&checked(&VALLEY, LiftDirection::Axis, 5.0), &setting);
    assert_eq!(milled.failure, None);
    assert!(milled.encounters.len() >= 5);
    for encounter in &milled.encounters {
        let Remedy::Avoided { lift, pose, .. } = encounter.remedy else { panic!("{encounter:?}") };
        let clear = |way: f64| {
            let pose = Pose { end: encounter.pose.end + Vec3::z() * way, ..pose };
            dense_depth(&VALLEY, &setting, &pose) <= setting.inside + 1e-6
        };
        assert!(clear(lift), "{encounter:?}");
        assert!(!clear(0.98 * lift - 0.01), "{encounter:?} is lifted too far");
    }
    for pose in milled.locations() {
        assert!(dense_depth(&VALLEY, &setting, pose) <= setting.inside + 1e-6, "{pose:?}");
    }
}

#[test]
fn a_lift_along_the_normal_that_cannot_help_fails_and_leaves_the_location() {
    let setting = setting(&[6.0, 3.0], 0.005);
    let milled = run(&checked(&VALLEY, LiftDirection::PartNormal, 5.0), &setting);
    let mut failed =
        milled.encounters.iter().filter(|one| matches!(one.remedy, Remedy::Failed(_))).peekable();
    assert!(failed.peek().is_some(), "{:?}", milled.encounters);
    assert!(failed.all(|one| milled.locations().any(|pose| *pose == one.pose)));
}

#[test]
fn a_limit_stops_the_lift() {
    let setting = setting(&[3.0], 0.005);
    let milled = run(&checked(&VALLEY, LiftDirection::Axis, 0.5), &setting);
    assert!(milled.encounters.iter().any(|one| matches!(one.remedy, Remedy::Failed(_))));
    for encounter in &milled.encounters {
        if let Remedy::Avoided { lift, .. } = encounter.remedy {
            assert!(lift <= 0.5);
        }
    }
}

#[test]
fn a_tilt_clears_the_foot_of_a_step_within_its_range() {
    let setting = setting(&[2.0, 0.3], 0.005);
    let mut command = checked(&STEP, LiftDirection::Axis, 5.0);
    command.axis = AxisCondition::GuideNormal(Sense::Plus);
    let degrees = f64::to_radians;
    command.avoidance.tilt =
        Some(TiltControl { constant: degrees(1.0), least: degrees(-40.0), greatest: degrees(40.0) });
    let milled = run(&command, &setting);
    assert_eq!(milled.failure, None);
    assert!(!milled.encounters.is_empty());
    let mut tilted = 0;
    for encounter in &milled.encounters {
        let Remedy::Avoided { tilt, lift, pose, .. } = encounter.remedy else { panic!("{encounter:?}") };
        assert!(tilt.abs() <= degrees(40.0) + 1e-9);
        tilted += usize::from(tilt != 0.0 && lift == 0.0);
        assert!((pose.axis.angle(&encounter.pose.axis) - tilt.abs()).abs() < 1e-9);
        assert!(dense_depth(&STEP, &setting, &pose) <= setting.inside + 1e-6, "{encounter:?}");
    }
    assert!(tilted > 0, "{:?}", milled.encounters);
}

/// Boxes and cells that are bounded between two questions whether to go on, some microseconds each.
const WORK_BETWEEN_QUESTIONS: u64 = 200;

#[test]
fn milling_asks_often_whether_to_go_on_and_adds_nothing_once_it_is_cancelled() {
    let setting = setting(&[2.0, 0.3], 0.005);
    let mut command = checked(&STEP, LiftDirection::Axis, 5.0);
    command.axis = AxisCondition::GuideNormal(Sense::Plus);
    let degrees = f64::to_radians;
    command.avoidance.tilt =
        Some(TiltControl { constant: degrees(1.0), least: degrees(-40.0), greatest: degrees(40.0) });
    let whole = run(&command, &setting);
    let mut before = 0;
    for most in 1.. {
        let questions = Cell::new(0);
        let cancel = || {
            questions.set(questions.get() + 1);
            questions.get() >= most
        };
        let milled = mill(&command, &setting, &cancel);
        let work = milled.cost.boxes + milled.cost.cells;
        assert!(work <= before + WORK_BETWEEN_QUESTIONS, "{work} after {before} at question {most}");
        before = work;
        if milled.failure.is_none() {
            assert_eq!(milled, whole);
            break;
        }
        assert_eq!(milled.failure, Some(MillingError::Cancelled));
        assert_eq!(questions.get(), most, "asked again after the answer");
        assert!(milled.locations().zip(whole.locations()).all(|(one, other)| one == other), "{milled:?}");
        let told = whole.encounters.get(..milled.encounters.len());
        assert_eq!(told, Some(milled.encounters.as_slice()));
    }
}

#[test]
fn nothing_is_told_where_there_is_nothing() {
    let ball = run(&checked(&VALLEY, LiftDirection::Axis, 5.0), &setting(&[0.5, 0.25], 0.005));
    assert_eq!((ball.failure, ball.encounters.len()), (None, 0));
    let corner = run(&checked(&STEP, LiftDirection::Axis, 5.0), &setting(&[2.0, 0.3], 0.005));
    assert_eq!((corner.failure, corner.encounters.len()), (None, 0));
    let mut bump = checked(&BUMP, LiftDirection::PartNormal, 3.0);
    bump.command = RegionalCommand::Path(pass([0.1, 0.15], FeedDirection::Spline, Sense::Plus));
    let flat = run(&bump, &setting(&[2.0], 0.005));
    assert_eq!((flat.failure, flat.encounters.len()), (None, 0));
}

/// A thin upright post beside or across the middle of the pass: its top edge runs along y from `y0` to `y1` at x = 3.
fn post(y0: f64, y1: f64, top: f64) -> NamedSurface {
    let point = |i: usize, j: usize| {
        Vec3::new(3.0, y0 + (y1 - y0) * i as f64 / 3.0, -1.0 + (top + 1.0) * j as f64 / 3.0)
    };
    let patches = vec![Patch::from_points(&std::array::from_fn(|i| std::array::from_fn(|j| point(i, j))))];
    let surface = SculpturedSurface::assembled(patches, Some((1, 1)), Vec::new(), 1.0, Mesh::default());
    NamedSurface { name: "W".to_owned(), geometry: Geometry::Sculptured(Remembering::new(surface)) }
}

/// Greatest depth of the post in the tool on the ways between all locations, by dense poses and points.
fn deepest_on_ways(milled: &Milled, setting: &Setting, [y0, y1, top]: [f64; 3]) -> f64 {
    let tool = Tool::new(&setting.cutter.expect("a cutter"), 0.0);
    let poses: Vec<Pose> = milled.locations().copied().collect();
    let mut deepest = f64::NEG_INFINITY;
    for (pair, k) in poses.windows(2).flat_map(|pair| (0..=200).map(move |k| (pair, f64::from(k) / 200.0))) {
        let axis = (pair[0].axis * (1.0 - k) + pair[1].axis * k).normalize();
        let pose = Pose { end: pair[0].end * (1.0 - k) + pair[1].end * k, axis };
        for (i, j) in (0..=40).flat_map(|i| (0..=40).map(move |j| (f64::from(i) / 40.0, f64::from(j) / 40.0)))
        {
            let point = Vec3::new(3.0, y0 + (y1 - y0) * i, -1.0 + (top + 1.0) * j);
            deepest = deepest.max(tool.depth(&pose, &point).value);
        }
    }
    deepest
}

#[test]
fn what_stands_between_two_locations_is_met() {
    // A floor is crossed in one step; a post beside the pass or a wall across it stands between both ends.
    const FLOOR: [[f64; 4]; 4] = [[0.0; 4]; 4];
    for (place, cutter) in
        [([2.5, 4.0, 2.0], vec![1.0]), ([2.0, 2.6, 1.0], vec![1.0, 0.5]), ([0.5, 4.0, 2.0], vec![1.0, 0.2])]
    {
        let setting = Setting { maximum_step: 10.0, ..setting(&cutter, 0.005) };
        let mut command = command(&FLOOR);
        assert_eq!(run(&command, &setting).locations().count(), 2);
        command.checked.named.push(post(place[0], place[1], place[2]));
        // Told without avoidance, with the depth of the tool in the middle.
        let told = run(&command, &setting);
        assert!(!told.encounters.is_empty() && told.encounters.iter().all(|one| one.remedy == Remedy::None));
        let deepest = told.encounters.iter().map(|one| one.hit.depth).fold(0.0, f64::max);
        assert!(deepest > 0.1, "{place:?}: {deepest}");
        // Lifted over it.
        command.avoidance =
            AvoidanceControl { enabled: true, tilt: None, lift: LiftDirection::Axis, limit: Some(5.0) };
        let milled = run(&command, &setting);
        assert_eq!(milled.failure, None);
        assert!(milled.encounters.iter().any(|one| matches!(one.remedy, Remedy::Avoided { .. })));
        let left = deepest_on_ways(&milled, &setting, place);
        // INTOL, the band that a way may be deeper, and a band between the poses that are looked at.
        assert!(left <= 5.0 * setting.inside, "{place:?}: {left} deep on the way");
    }
}

/// A roof or a trough along y of two planes that meet at x = 3, each with the slope given.
fn two_planes(slope: f64) -> NamedSurface {
    let flat = |from: f64, to: f64| {
        let height = |x: f64| slope * (3.0 - x).abs();
        let point = |i: usize, j: usize| {
            let x = from + (to - from) * i as f64 / 3.0;
            Vec3::new(x, 1.5 * j as f64, height(x))
        };
        Patch::from_points(&std::array::from_fn(|i| std::array::from_fn(|j| point(i, j))))
    };
    let patches = vec![flat(0.0, 3.0), flat(3.0, 6.0)];
    let surface = SculpturedSurface::assembled(patches, Some((2, 1)), Vec::new(), 1.0, Mesh::default());
    NamedSurface { name: "S".to_owned(), geometry: Geometry::Sculptured(Remembering::new(surface)) }
}

/// Distance of a ball from the two planes, for its centre at height `z` over `x`.
fn ball_over_planes(slope: f64, radius: f64, x: f64, z: f64) -> f64 {
    let steps = 60_000;
    let away = |k: i32| {
        let at = 6.0 * f64::from(k) / f64::from(steps);
        (x - at).hypot(z - slope * (3.0 - at).abs())
    };
    (0..=steps).map(away).fold(f64::INFINITY, f64::min) - radius
}

#[test]
fn a_pass_goes_over_a_ridge_and_through_a_valley_with_an_edge() {
    for slope in [-0.5, 0.5] {
        let mut command = command(&HILL);
        let surface = two_planes(slope);
        let u = ParameterRange { low: 0.3, high: 1.7 };
        command.guide.guide = Guide::Surface { surface: surface.clone(), u, v: RANGE };
        command.part.surface = surface;
        command.command = RegionalCommand::Path(pass([0.3, 0.5], FeedDirection::Spline, Sense::Plus));
        let setting = setting(&[1.0, 0.5], 0.002);
        let milled = run(&command, &setting);
        assert_eq!(milled.failure, None, "slope {slope}");
        for pose in milled.locations() {
            let gap = ball_over_planes(slope, 0.5, pose.end.x, pose.end.z + 0.5);
            assert!(gap.abs() <= 0.002 + 1e-6, "slope {slope}: {gap} at {pose:?}");
        }
        let (first, last) = ends(&milled);
        assert!((first.end.x - 0.9).abs() < 0.002 && (last.end.x - 5.1).abs() < 0.002);
        assert!(milled.locations().count() < 60, "{}", milled.locations().count());
    }
}

#[test]
fn mistakes_have_their_numbers() {
    let good = setting(&[0.5, 0.25], 0.002);
    let mut outside = command(&HILL);
    outside.command = RegionalCommand::Path(pass([0.05, 0.5], FeedDirection::Spline, Sense::Plus));
    assert_eq!(run(&outside, &good).failure.and_then(|error| error.number()), Some(3563));
    let no_cutter = Setting { cutter: None, ..good };
    assert_eq!(run(&command(&HILL), &no_cutter).failure.and_then(|error| error.number()), Some(3566));
    let mut plane = command(&HILL);
    plane.part.surface.geometry = Geometry::Plane(Plane { normal: Vec3::z(), distance: 0.0 });
    assert_eq!(run(&plane, &good).failure.and_then(|error| error.number()), Some(3567));
    let mut away = command(&HILL);
    away.guide.projection = Projection::Vector(Vec3::y());
    away.command = RegionalCommand::Path(pass([0.5, 0.5], FeedDirection::Spline, Sense::Plus));
    away.part.surface = patch(&[[50.0; 4]; 4]);
    assert_eq!(run(&away, &good).failure.and_then(|error| error.number()), Some(3551));
    assert_eq!(mill(&command(&HILL), &good, &|| true).failure, Some(MillingError::Cancelled));
}
