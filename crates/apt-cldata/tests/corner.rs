//! WCORN: where the tool stands in the corner of two leaning walls, where it starts and ends, and every mistake.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use apt_cldata::{
    edit::{EditErrorKind, EditItem, edit},
    record::{ClKind, ClPoint, ClRecord, ClWord, Units},
    tilt::TiltError,
};
use apt_geometry::Vec3;
use proptest::prelude::*;

fn record(isn: u32, kind: ClKind) -> EditItem {
    EditItem::Record(ClRecord { isn, source: isn, kind })
}

fn motion(isn: u32, positions: &[[f64; 3]]) -> EditItem {
    let point = |at: &[f64; 3]| ClPoint { position: (*at).into(), axis: Vec3::z(), with_axis: true };
    let points = positions.iter().map(point).collect();
    record(isn, ClKind::Motion { from: false, surface: "W".into(), points })
}

/// `WORD/ON,LEFT,10,...`: what is no number is a word.
fn word(isn: u32, text: &str) -> EditItem {
    let (word, arguments) = text.split_once('/').unwrap();
    let one = |one: &str| one.parse().map_or_else(|_| ClWord::Word(one.into()), ClWord::Number);
    let arguments = arguments.split(',').map(one).collect();
    record(isn, ClKind::Postprocessor { word: word.into(), code: None, arguments })
}

/// Positions and axes with their statements.
fn poses(records: &[ClRecord]) -> Vec<(u32, Vec3, Vec3)> {
    let of = |record: &ClRecord| match &record.kind {
        ClKind::Motion { points, .. } => {
            assert!(!points.is_empty(), "a record without positions");
            points.iter().map(|point| (record.isn, point.position, point.axis)).collect()
        }
        _ => Vec::new(),
    };
    records.iter().flat_map(of).collect()
}

/// Along +x to the corner at x = 8, then down along -y: a cutter on the right has the walls on its left.
fn program(on: &str, wcorn: &str, off: &str) -> Vec<EditItem> {
    vec![
        motion(1, &[[0.0, 0.0, 0.0]]),
        word(2, on),
        motion(3, &[[8.0, 0.0, 0.0]]),
        word(4, wcorn),
        motion(5, &[[8.0, -8.0, 0.0]]),
        word(6, off),
        motion(7, &[[9.0, -9.0, 5.0]]),
    ]
}

fn cleaned(on: &str, wcorn: &str, off: &str) -> Vec<(u32, Vec3, Vec3)> {
    let (records, errors) = edit(program(on, wcorn, off));
    assert_eq!(errors, vec![]);
    poses(&records)
}

#[track_caller]
fn near(found: Vec3, expected: [f64; 3]) {
    assert!((found - Vec3::from(expected)).norm() < 1e-12, "{found} is not {expected:?}");
}

#[test]
fn the_tool_turns_from_the_starting_position_into_the_corner() {
    // The second wall leans over the path by 45 degrees, so that two units up it is two units nearer: with the margin
    // the tool starts 2.15 before the corner.
    let all = cleaned("VTLAXS/ON,LEFT,0,2,0,RIGHT", "WCORN/LEFT,0,RIGHT,45,2", "VTLAXS/OFF,RIGHT,45");
    let isns: Vec<u32> = all.iter().map(|(isn, ..)| *isn).collect();
    assert_eq!(isns, [1, 3, 3, 3, 3, 3, 3, 3, 5, 7], "six steps into the corner");
    near(all[1].1, [5.85, 0.0, 0.0]);
    near(all[1].2, [0.0, 0.0, 1.0]);
    // In the corner: the wall x = 9 - z is one radius from the axis.
    let half = 0.5_f64.sqrt();
    near(all[7].2, [-half, 0.0, half]);
    let foot = all[7].1 - all[7].2 * (all[7].1.z / all[7].2.z);
    near(foot, [9.0 - 2.0_f64.sqrt(), 0.0, 0.0]);
    // Half way of six steps the foot is half way, and the axis has the direction of the mean of both axes.
    let middle = Vec3::new(-half, 0.0, 1.0 + half).normalize();
    near(all[4].2, middle.into());
    let foot = all[4].1 - all[4].2 * (all[4].1.z / all[4].2.z);
    near(foot, [f64::midpoint(5.85, 9.0 - 2.0_f64.sqrt()), 0.0, 0.0]);
    // The way out begins in the corner itself, with the tilt that VTLAXS/OFF has too.
    near(all[8].2, [-half, 0.0, half]);
    near(all[9].1, [9.0, -9.0, 5.0]);
}

#[test]
fn number_of_steps_and_unit() {
    let steps = |wcorn: &str| {
        let all = cleaned("VTLAXS/ON,LEFT,0,2,0,RIGHT", wcorn, "VTLAXS/OFF,RIGHT,45");
        all.iter().filter(|(isn, ..)| *isn == 3).count() - 1
    };
    assert_eq!(steps("WCORN/LEFT,0,RIGHT,45,2,10"), 10);
    assert_eq!(steps("WCORN/LEFT,0,RIGHT,45,2,-7.9"), 7);
    assert_eq!(steps("WCORN/LEFT,0,RIGHT,45,2,1"), 3, "three at least");
    // The margin of a tenth of an inch is 2.54 in millimeters.
    let mut items = program("VTLAXS/ON,LEFT,0,2,0,RIGHT", "WCORN/LEFT,0,RIGHT,45,2", "VTLAXS/OFF,RIGHT,45");
    items.insert(0, record(0, ClKind::Units(Units::Millimeters)));
    let (records, errors) = edit(items);
    assert_eq!(errors, vec![]);
    near(poses(&records)[1].1, [8.0 - 2.0 - 1.5 * 2.54, 0.0, 0.0]);
}

#[test]
fn walls_that_lean_away_are_cleaned_out_in_the_corner() {
    let all = cleaned("VTLAXS/ON,LEFT,10,2,.5,RIGHT", "WCORN/LEFT,20,LEFT,30,2", "VTLAXS/OFF,LEFT,40");
    let tilts: Vec<f64> = all.iter().map(|(.., axis)| axis.z.acos().to_degrees()).collect();
    assert!((tilts[0] - 10.0).abs() < 1e-9 && (tilts[1] - 20.0).abs() < 1e-9);
    let isns: Vec<u32> = all.iter().map(|(isn, ..)| *isn).collect();
    assert_eq!(isns[..8], [1, 3, 3, 3, 3, 3, 3, 3]);
    assert_eq!(isns[8..], [5, 5, 5, 5, 5, 5, 5, 7], "six steps out of the corner, then the end of the path");
    assert!((tilts[13] - 30.0).abs() < 1e-9 && (tilts[14] - 40.0).abs() < 1e-9, "{tilts:?}");
    // The axis in the corner lies in both leaning walls.
    let axis = all[7].2;
    let expected = Vec3::new(30.0_f64.to_radians().tan(), 20.0_f64.to_radians().tan(), 1.0).normalize();
    near(axis, expected.into());
}

#[test]
fn positions_between_start_and_corner_give_way() {
    let items = vec![
        motion(1, &[[0.0, 0.0, 0.0]]),
        word(2, "VTLAXS/ON,LEFT,0,2,0,RIGHT"),
        motion(3, &[[4.0, 0.0, 0.0], [7.0, 0.0, 0.0]]),
        motion(4, &[[8.0, 0.0, 0.0]]),
        word(5, "WCORN/LEFT,10,RIGHT,45,2"),
        motion(6, &[[8.0, -8.0, 0.0]]),
        word(7, "VTLAXS/OFF,RIGHT,45"),
    ];
    let (records, errors) = edit(items);
    assert_eq!(errors, vec![]);
    let all = poses(&records);
    assert!(all.iter().all(|(isn, ..)| *isn != 4), "its only position lies behind the start");
    // The tilt of the first part ends at the starting position, not at the corner.
    let start = all[2].1;
    let length = start.x;
    assert!(length < 6.0 && length > 5.0, "{start}");
    let tilt = all[1].2.z.acos().to_degrees();
    assert!((tilt - 10.0 * 4.0 / length).abs() < 1e-9);
}

#[test]
fn mistakes_are_told_at_the_corner() {
    let cases = [
        ("WCORN/LEFT,0,RIGHT,60,9", "", 8.0, Some(29)),
        ("WCORN/RIGHT,60,LEFT,0,9", "", 8.0, Some(30)),
        ("WCORN/LEFT,85,LEFT,0,1", "", 8.0, Some(20)),
        ("WCORN/LEFT,5,RIGHT,5,1", ",ZSMALL", 8.0, Some(41)),
        ("WCORN/LEFT,5,LEFT,5,1", "", -8.0, Some(25)),
        ("WCORN/LEFT,5,LEFT,5,1,20000", "", 8.0, None),
        ("WCORN/LEFT,5,LEFT,5", "", 8.0, None),
        ("WCORN/LEFT,5,ON,5,1", "", 8.0, Some(14)),
    ];
    for (wcorn, zsmall, down, number) in cases {
        let mut items = program(&format!("VTLAXS/ON,LEFT,0,2,0,RIGHT{zsmall}"), wcorn, "VTLAXS/OFF,LEFT,0");
        items[4] = motion(5, &[[8.0, -down, 0.0]]);
        let (records, errors) = edit(items);
        assert_eq!(errors.len(), 1, "{wcorn}: {errors:?}");
        assert_eq!((errors[0].isn, errors[0].apt3()), (4, number), "{wcorn}: {errors:?}");
        assert!(poses(&records).iter().all(|(.., axis)| *axis == Vec3::z()), "{wcorn}: something is tilted");
    }
    let (_, errors) =
        edit(program("VTLAXS/ON,LEFT,0,2,0,RIGHT", "WCORN/LEFT,0,RIGHT,45,9", "VTLAXS/OFF,LEFT,0"));
    let EditErrorKind::Tilt(TiltError::ShortBeforeCorner { wanted, length }) = errors[0].kind else {
        panic!("{errors:?}")
    };
    assert!((wanted - 9.1).abs() < 1e-12 && length == 8.0);
}

#[test]
fn a_bent_path_may_have_no_starting_or_ending_position() {
    // Seen from the near leg of the path the leaning wall takes more than the leg is long, and seen from the leg before
    // it less: neither gives a position.
    const ON: &str = "VTLAXS/ON,LEFT,0,.2,0,RIGHT";
    let bent = |up: f64| [[6.5, -2.0 * up, 0.0], [6.5, 2.6 * up, 0.0]];
    let corner = [8.0, 0.0, 0.0];
    let number = |on: &str, before: &[[f64; 3]], wcorn: &str, behind: &[[f64; 3]]| {
        let (first, rest) = before.split_first().unwrap();
        let items = vec![
            motion(1, &[*first]),
            word(2, on),
            motion(3, &[rest, &[corner]].concat()),
            word(4, wcorn),
            motion(5, behind),
            word(6, "VTLAXS/OFF,RIGHT,45"),
        ];
        let (_, errors) = edit(items);
        assert_eq!(errors.len(), 1, "{errors:?}");
        assert_eq!(errors[0].isn, 4);
        errors[0].apt3()
    };
    let down = [[8.0, -8.0, 0.0]];
    assert_eq!(number(ON, &bent(1.0), "WCORN/LEFT,0,RIGHT,45,2", &down), Some(26));
    assert_eq!(number(ON, &bent(-1.0), "WCORN/LEFT,0,RIGHT,45,2", &down), Some(27));
    let mut behind = bent(1.0);
    behind.reverse();
    let on = "VTLAXS/ON,LEFT,0,.2,0,LEFT";
    assert_eq!(number(on, &down, "WCORN/LEFT,45,LEFT,0,2", &behind), Some(28));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn in_the_corner_the_tool_touches_both_walls(
        radius in 0.2..2.0_f64, part in 0.0..1.0_f64, first in -40.0..40.0_f64, second in -40.0..40.0_f64,
        turn in 20.0..150.0_f64, height in 0.1..3.0_f64, left in any::<bool>(), heading in 0.0..360.0_f64,
    ) {
        // The cutter on the right of its walls turns to the right.
        let side = if left { 1.0 } else { -1.0 };
        let direction = |degrees: f64| Vec3::new(degrees.to_radians().cos(), degrees.to_radians().sin(), 0.0);
        let (incoming, outgoing) = (direction(heading), direction(heading + turn * side));
        let (start, end) = (incoming * -200.0, outgoing * 200.0);
        let tilt = |degrees: f64| format!("{},{}", if degrees < 0.0 { "RIGHT" } else { "LEFT" }, degrees.abs());
        let cutter = if left { "LEFT" } else { "RIGHT" };
        let corner = radius * part;
        let items = vec![
            motion(1, &[start.into()]),
            word(2, &format!("VTLAXS/ON,LEFT,0,{},{corner},{cutter}", radius * 2.0)),
            motion(3, &[[0.0; 3]]),
            word(4, &format!("WCORN/{},{},{height},8", tilt(first), tilt(second))),
            motion(5, &[end.into()]),
            word(6, "VTLAXS/OFF,LEFT,0"),
        ];
        let (records, errors) = edit(items);
        prop_assert_eq!(errors, vec![]);
        let all = poses(&records);
        let entering: Vec<_> = all.iter().filter(|(isn, ..)| *isn == 3).collect();
        let (_, end_of_tool, axis) = **entering.last().unwrap();
        // The lowest point of the tool keeps its height on the whole way.
        for (_, end, axis) in &all {
            let low = end.z + corner * axis.z - (radius - corner) * axis.x.hypot(axis.y) - corner;
            prop_assert!(low.abs() < 1e-9, "{}", low);
        }
        for (direction, degrees) in [(incoming, first), (outgoing, second)] {
            // A wall stands one radius beside the path and leans by the angle to the left of the path.
            let leftwards = Vec3::z().cross(&direction);
            let wall_axis = leftwards * degrees.to_radians().sin() + Vec3::z() * degrees.to_radians().cos();
            let normal = direction.cross(&wall_axis).normalize();
            let towards = if left { -leftwards } else { leftwards };
            let distance = (end_of_tool - towards * radius).dot(&normal).abs();
            prop_assert!((distance - radius).abs() < 1e-9, "{}", distance);
            prop_assert!(axis.dot(&normal).abs() < 1e-9);
        }
        // At the starting position the tool is clear of the upper edge of the second wall.
        let (_, end_of_tool, axis) = *entering[0];
        let foot = end_of_tool - axis * (end_of_tool.z / axis.z);
        if foot.dot(&incoming) < -1e-3 {
            let leftwards = Vec3::z().cross(&outgoing);
            let towards = if left { -leftwards } else { leftwards };
            let edge = towards * radius + (leftwards * second.to_radians().tan() + Vec3::z()) * height;
            let across = axis.cross(&outgoing).normalize();
            let across = if across.dot(&towards) > 0.0 { -across } else { across };
            let clear = (foot - edge).dot(&across) - radius;
            prop_assert!(clear > -1e-9, "{}", clear);
        }
    }
}
