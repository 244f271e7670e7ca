//! Corners that turn the path sharply, in all bands and from all distances: one vertex does for a corner.

use super::{
    refused::{AMPLE, Found, turns_sharply},
    *,
};
use crate::{
    error::RoleName,
    verify::{Rule, Violation},
};

/// Of the tool.
const RADIUS: f64 = 0.5;
/// How far beyond the corner motions end.
const AWAY: f64 = 0.5;

/// The walls y = -0.5 and another one with a normal, as far from the origin.
fn walls(second: &Vec3) -> Geometry {
    let first = Vec3::y();
    let product = |k: usize, l: usize| 0.5 * (first[k] * second[l] + first[l] * second[k]);
    let along = |k: usize| 0.5 * RADIUS * (first[k] + second[k]);
    quadric([
        product(0, 0),
        product(1, 1),
        0.0,
        RADIUS * RADIUS,
        0.0,
        0.0,
        product(0, 1),
        along(0),
        along(1),
        0.0,
    ])
}

/// A tool of radius 0.5 left of two upright walls, one along the x-axis and one that turns the path by an angle, from so far before the corner.
/// The tool end is in the origin where it touches both.
fn around(turn: f64, band: [f64; 2], back: f64) -> Result<CutSequence, MotionFailure> {
    let (sine, cosine) = turn.to_radians().sin_cos();
    let walls = walls(&v(-sine, cosine, 0.0));
    let mut program = Program::new();
    program.cutter(&[2.0 * RADIUS]).tolerance(band[0], band[1]).from(-back, 0.0, 0.0);
    program.run(&MotionCommand::PartSurface(named(&ground())));
    program.side(DriveSide::Left).indirv(1.0, 0.0, 0.0);
    let check = plane(cosine, sine, 0.0, AWAY);
    let command = motion(Turn::Forward, &walls, &[(Relation::On, 1, &check)]);
    program.cut(&command)
}

/// Bands, inside and outside, and how many of them before the corner motions begin.
const BANDS: [[f64; 2]; 3] = [[0.001, 0.001], [0.02, 0.0], [0.0, 0.005]];
const BEFORE: [f64; 5] = [0.3, 0.5, 1.0, 3.0, 40.0];

/// How far before the corner motions begin to which it is nothing at first.
const FAR: f64 = 0.9;

/// From within the corner's bands one vector may do; elsewhere two vectors do, however the path turns.
#[test]
fn one_vertex_does_for_a_sharp_corner() {
    for band in BANDS {
        for before in BEFORE {
            for turn in 60..=120 {
                let motion = around(f64::from(turn), band, before * (band[0] + band[1]));
                let sequence =
                    motion.unwrap_or_else(|failure| panic!("{turn} {band:?} {before}: {failure:?}"));
                let count = sequence.points.len();
                let evidence = crate::verify::verify(&sequence, &|| false).expect("evidence");
                assert!(count <= 2, "{turn} {band:?} {before}: {count} vectors");
                assert!(evidence.verified, "{turn} {band:?} {before}: {evidence:?}");
            }
        }
    }
}

/// The same with a ball cutter over a plane that leans so that its normal is by an angle beside the middle of those of both walls: the path turns by
/// more than a right angle though the walls are only so far apart, and comes out of the wedge beside the way by which it came.
fn within_a_wedge(apart: f64, beside: f64, band: [f64; 2], back: f64) -> Result<CutSequence, MotionFailure> {
    let ((sine, cosine), half) = (apart.to_radians().sin_cos(), 0.5 * apart.to_radians());
    let second = v(-sine, cosine, 0.0);
    let (up, level) = beside.to_radians().sin_cos();
    let leaning = v(-half.sin() * level, half.cos() * level, up);
    let part = Geometry::Plane(Plane { normal: leaning, distance: RADIUS * (leaning.z - 1.0) });
    let legs = [leaning.cross(&Vec3::y()), leaning.cross(&second)].map(|leg| leg.normalize());
    // Towards the second wall, and away from the first one.
    let before = legs[0] * -second.dot(&legs[0]).signum();
    let beyond = legs[1] * legs[1].y.signum();
    let side = if Vec3::z().cross(&before).y > 0.0 { DriveSide::Left } else { DriveSide::Right };
    let at = before * -back;
    let mut program = Program::new();
    program.cutter(&[2.0 * RADIUS, RADIUS]).tolerance(band[0], band[1]).from(at.x, at.y, at.z);
    program.run(&MotionCommand::PartSurface(named(&part)));
    program.side(side).indirv(before.x, before.y, before.z);
    let check = plane(beyond.x, beyond.y, beyond.z, AWAY);
    let command = motion(Turn::Forward, &walls(&second), &[(Relation::On, 1, &check)]);
    program.cut(&command)
}

/// What tells the corner is that the contact leaps there, not by how much.
#[test]
fn a_path_goes_on_out_of_a_wedge_along_its_other_wall() {
    for apart in [12.0, 20.0, 28.0, 40.0] {
        for beside in [6.0, 8.0] {
            for band in BANDS {
                for back in BEFORE.map(|bands| bands * (band[0] + band[1])).into_iter().chain([FAR]) {
                    let what = format!("{apart} {beside} {band:?} {back}");
                    let sequence = within_a_wedge(apart, beside, band, back);
                    let sequence = sequence.unwrap_or_else(|failure| panic!("{what}: {failure:?}"));
                    let evidence = crate::verify::verify(&sequence, &|| false).expect("evidence");
                    assert!(evidence.verified, "{what}: {evidence:?}");
                    assert!(sequence.points.len() <= 3, "{what}: {} vectors", sequence.points.len());
                }
            }
        }
    }
}

/// Between both branches of a hyperbola of half-width 1, as long as told, before the neck; and where that is.
fn between_branches(long: f64, radius: f64) -> (Program, Geometry, f64) {
    let branches = Geometry::Hyperbola(Quadric {
        coefficients: [1.0, -1.0 / (long * long), 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    });
    let before = -3.0 * (radius - 1.0) * long - 4.0;
    let mut program = Program::new();
    program.cutter(&[2.0 * radius]).tolerance(0.001, 0.001).from(0.0, before, 0.0).indirv(-1.0, 0.0, 0.0);
    program.go(&[(Relation::To, &branches), (Relation::To, &ground()), (Relation::On, &y(before))]);
    program.side(DriveSide::Right).indirv(0.0, 1.0, 0.0);
    (program, branches, before)
}

/// The same, on the way into the neck.
fn before_the_neck(long: f64, radius: f64) -> (Program, Geometry, f64) {
    let (mut program, branches, before) = between_branches(long, radius);
    program.drive(Turn::Forward, &branches, Relation::On, &y(before + 0.5));
    program.indirv(0.0, 1.0, 0.0);
    (program, branches, before)
}

/// The same, and back to a line before it along the other branch or on to one behind it.
fn into_the_neck(long: f64, radius: f64, ahead: Option<f64>) -> Result<CutSequence, MotionFailure> {
    let (mut program, branches, before) = before_the_neck(long, radius);
    let stop = ahead.unwrap_or(before + 0.25);
    program.cut(&motion(Turn::Forward, &branches, &[(Relation::On, 1, &y(stop))]))
}

/// Behind a neck that is too narrow no surface is met: it is told where the path turns back.
#[test]
fn where_a_path_turns_back_in_a_neck_is_told_if_nothing_stops_it() {
    let failure = into_the_neck(1.5, 1.05, Some(4.0)).expect_err("the tool does not get through");
    let MotionFailure::NeverMet { turns_back: Some(corner), .. } = failure else { panic!("{failure:?}") };
    // A circle about (0, y) with this radius touches both branches.
    let square = 1.0 / (1.5 * 1.5);
    let touched = ((1.05_f64.powi(2) - 1.0) / (square + square * square)).sqrt();
    let middle = v(0.0, -touched * (1.0 + square), 0.0);
    assert!((corner.at - middle).norm() < 0.01, "{corner:?} {middle}");
    assert!((corner.onward - Vec3::y()).norm() < 0.01, "{corner:?}");
}

/// GOUGCK/ON tells how much too wide the tool is where the neck is narrowest, though the path goes back before.
#[test]
fn the_neck_in_which_a_path_turns_back_is_told_with_place_and_depth() {
    for (long, wide) in [(1.5, 0.05), (1.5, 0.2), (0.8, 0.01), (4.0, 0.05), (4.4, 0.005)] {
        for check in [true, false] {
            let (mut program, branches, _) = before_the_neck(long, 1.0 + wide);
            program.run(&MotionCommand::GougeCheck(check)).warnings.clear();
            let on = motion(Turn::Forward, &branches, &[(Relation::On, 1, &y(4.0))]);
            let failure = program.cut(&on).expect_err("the tool does not get through");
            assert!(matches!(failure, MotionFailure::NeverMet { .. }), "{long} {wide}: {failure:?}");
            let told: Vec<_> = program
                .warnings
                .iter()
                .map(|warning| match warning {
                    MotionWarning::Gouge { role: RoleName::Drive, depth, contact, ahead: true, .. } => {
                        (*depth, *contact)
                    }
                    other => panic!("{long} {wide}: {other:?}"),
                })
                .collect();
            assert_eq!(told.len(), if check { 2 } else { 0 }, "{long} {wide}: a wall on either side");
            for (depth, contact) in told {
                assert!((depth - wide).abs() < 0.02 * wide, "{long} {wide}: {depth}");
                assert!(contact.tip.norm() < 0.05, "{long} {wide}: {contact:?}");
                let wall = v(contact.tool.x.signum(), 0.0, 0.0);
                assert!((contact.surface - wall).norm() < 0.05, "{long} {wide}: {contact:?}");
            }
        }
    }
}

/// Both walls are one surface, and a tool in the band of each may pass: along the wall that it follows, as if the neck were wider.
#[test]
fn a_tool_passes_a_neck_that_is_narrower_by_less_than_its_band() {
    let necks = [0.9, 1.7, 2.6, 3.5, 4.4].into_iter();
    let necks = necks.flat_map(|long| [0.0001, 0.0004, 0.0007, 0.0009, 0.00098].map(|wide| (long, wide)));
    for (long, wide) in necks {
        let sequence = into_the_neck(long, 1.0 + wide, Some(4.0));
        let sequence = sequence.unwrap_or_else(|failure| panic!("{long} {wide}: {failure:?}"));
        let evidence = crate::verify::verify(&sequence, &|| false).expect("evidence");
        assert!(evidence.verified, "{long} {wide}: {evidence:?}");
        let end = sequence.points.last().expect("a vertex").tip;
        assert!(end.x < 0.0, "{long} {wide}: {end}");
    }
}

/// The walls of a neck bulge towards the tool and are all but one line where it touches both: it goes back along the second one from there, with the drive
/// surface on its side.
#[test]
fn a_tool_goes_back_from_a_neck_along_the_other_wall() {
    let necks = [1.5, 2.5, 3.5, 4.5].into_iter().flat_map(|long| [0.01, 0.03, 0.1].map(|wide| (long, wide)));
    for (long, wide) in necks.chain([(4.413217071466309, 0.0017497000724391)]) {
        let sequence = into_the_neck(long, 1.0 + wide, None);
        let sequence = sequence.unwrap_or_else(|failure| panic!("{long} {wide}: {failure:?}"));
        let evidence = crate::verify::verify(&sequence, &|| false).expect("evidence");
        assert!(evidence.verified, "{long} {wide}: {evidence:?}");
        let (end, least) =
            (sequence.points.last().expect("a vertex").tip, sequence.minimum.expect("a bound"));
        assert!(end.x > 0.0, "{long} {wide}: {end}");
        let most = 1.02 * f64::from(least) + 2.0;
        assert!(
            sequence.points.len() as f64 <= most,
            "{long} {wide}: {} with {least}",
            sequence.points.len()
        );
    }
}

/// The walls of a neck may be one line but for a degree or two, and the contact leaps from the one to the other: the path has two directions there,
/// whichever vectors come to it.
#[test]
fn a_tool_goes_back_from_a_neck_whose_walls_are_all_but_one_line() {
    let longs = (0..14).map(|step| 1.75 + 0.25 * f64::from(step));
    let necks = longs.flat_map(|long| [0.0011, 0.00125, 0.0015, 0.002, 0.004].map(|wide| (long, wide)));
    for (long, wide) in necks {
        let (mut program, branches, before) = between_branches(long, 1.0 + wide);
        let sequence = program.cut(&motion(Turn::Forward, &branches, &[(Relation::On, 2, &y(before + 0.5))]));
        let sequence = sequence.unwrap_or_else(|failure| panic!("{long} {wide}: {failure:?}"));
        let evidence = crate::verify::verify(&sequence, &|| false).expect("evidence");
        assert!(evidence.verified, "{long} {wide}: {evidence:?}");
        let end = sequence.points.last().expect("a vertex").tip;
        assert!(end.x > 0.0, "{long} {wide}: {end}");
    }
}

/// A line that touches a hollow sphere with its end and then with its top.
fn end_and_top() -> Found {
    Found {
        cutter: &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.230688854157487],
        axis: v(-0.44493995633705036, 0.1938010330624687, 0.8743395192021824),
        from: v(1.151351006060364, -0.10722283346716854, 0.31524096845428706),
        band: [2e-5, 3e-5],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: v(-0.7526964522240472, 0.4768935115888702, -0.4538949541620491),
        part: (
            Relation::To,
            sphere(0.23589032805829246, -0.05345688782006158, 2.156428965912056, 2.790044368293636),
        ),
        drive: (
            Relation::To,
            cylinder(
                v(1.525132237371737, 3.7292783577522792, 3.7088800373379027),
                Vec3::z(),
                4.323950331748025,
            ),
        ),
        first: (
            Relation::To,
            plane(-0.7526964522240472, 0.4768935115888705, -0.45389495416204895, -1.133049327460995),
        ),
        stop: (Relation::Past, plane(0.8447248292631784, -0.5352008621314936, 0.0, 0.8556519259081886)),
    }
}

/// Without a width it goes through no neck in that corner: it went back the way that it came.
#[test]
fn a_line_that_touches_with_both_ends_is_in_no_neck() {
    turns_sharply(&end_and_top());
}

/// A path that goes back from a corner the way that it came is not proven, whether it turns there on the spot or by steps as short as the band is wide.
#[test]
fn a_path_that_goes_back_by_short_steps_is_not_proven() {
    let mut path = end_and_top().run(AMPLE).expect("a path").remove(1);
    let way = |at: &[ToolPosition]| at[1].tip - at[0].tip;
    let turn = path.points.windows(3).position(|at| way(at).dot(&way(&at[1..])) < 0.0).expect("a corner") + 1;
    let led_there: Vec<ToolPosition> = path.points[..turn].iter().rev().copied().collect();
    let corner = path.points[turn];
    let beside = |step: Vec3| ToolPosition { tip: corner.tip + step, ..corner };
    let aside = v(0.8207, 0.5714, 0.0071) * 1.2e-5;
    let steps = [beside(aside), beside(aside + v(-0.5493, -0.6499, 0.5252) * 1.5e-5)];
    path.points.truncate(turn + 1);
    for steps in [&steps[..], &[]] {
        let mut back = path.clone();
        back.points.extend(steps.iter().chain(&led_there));
        let evidence = crate::verify::verify(&back, &|| false).expect("evidence");
        let is_against = |violation: &Violation| violation.rule == Rule::Progress;
        assert!(evidence.violations.iter().any(is_against), "{} steps: {evidence:?}", steps.len());
    }
}
