//! VTLAXS: what the tilted tool keeps of the vertical one, worked positions, and every mistake with its number.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use apt_cldata::{
    edit::{EditErrorKind, EditItem, edit},
    record::{ClKind, ClPoint, ClRecord, ClWord},
    tilt::TiltError,
};
use apt_geometry::{Vec3, canonical::Matrix, copy::CopyStep};
use proptest::prelude::*;

fn record(isn: u32, kind: ClKind) -> EditItem {
    EditItem::Record(ClRecord { isn, source: isn, kind })
}

fn points(positions: &[[f64; 3]], with_axis: bool) -> Vec<ClPoint> {
    let point = |position: &[f64; 3]| ClPoint { position: (*position).into(), axis: Vec3::z(), with_axis };
    positions.iter().map(point).collect()
}

fn motion(isn: u32, positions: &[[f64; 3]]) -> EditItem {
    record(isn, ClKind::Motion { from: false, surface: "W".into(), points: points(positions, true) })
}

fn from(isn: u32) -> EditItem {
    record(isn, ClKind::Motion { from: true, surface: "".into(), points: points(&[[0.0; 3]], true) })
}

/// `WORD/ON,LEFT,10,...`: capitals are words.
fn word(isn: u32, text: &str) -> EditItem {
    let (word, arguments) = text.split_once('/').unwrap();
    let arguments = arguments
        .split(',')
        .map(|one| one.parse().map_or_else(|_| ClWord::Word(one.into()), ClWord::Number))
        .collect();
    record(isn, ClKind::Postprocessor { word: word.into(), code: None, arguments })
}

fn positions(records: &[ClRecord]) -> Vec<(Vec3, Vec3)> {
    let of = |record: &ClRecord| match &record.kind {
        ClKind::Motion { points, .. } => points.iter().map(|point| (point.position, point.axis)).collect(),
        _ => Vec::new(),
    };
    records.iter().flat_map(of).collect()
}

fn tilted(on: &str, off: &str) -> Vec<(Vec3, Vec3)> {
    let items = vec![
        from(1),
        motion(2, &[[1.0, 0.0, 0.0]]),
        word(3, on),
        motion(4, &[[2.0, 0.0, 0.0], [5.0, 0.0, 0.0]]),
        word(5, off),
        motion(6, &[[9.0, 0.0, 0.0]]),
    ];
    let (records, errors) = edit(items);
    assert_eq!(errors, vec![]);
    positions(&records)
}

#[test]
fn the_tilt_grows_with_the_path() {
    // From 0 degrees at x = 1 to 40 at x = 5; the wall is on the left, +y, of a cutter on its right.
    let all = tilted("VTLAXS/ON,LEFT,0,2,0,RIGHT", "VTLAXS/OFF,LEFT,40");
    let leaning: Vec<f64> =
        all.iter().map(|(_, axis)| (axis.y.atan2(axis.z).to_degrees() * 1e9).round() / 1e9).collect();
    assert_eq!(leaning, [0.0, 0.0, 10.0, 40.0, 0.0]);
    assert!(all.iter().all(|(_, axis)| axis.x.abs() < 1e-15 && (axis.norm() - 1.0).abs() < 1e-15));
    // Leaning over the wall the edge at the wall is the lowest point and stays where it was, one radius from the path.
    let (end, axis) = all[3];
    let edge = end + Vec3::new(0.0, axis.z, -axis.y);
    assert!((edge - Vec3::new(5.0, 1.0, 0.0)).norm() < 1e-12, "{edge}");
    assert_eq!(all[4], (Vec3::new(9.0, 0.0, 0.0), Vec3::z()), "after VTLAXS/OFF nothing is tilted");
}

#[test]
fn a_tool_that_leans_away_keeps_its_side_or_with_zsmall_its_edge() {
    let away = tilted("VTLAXS/ON,RIGHT,30,2,0,RIGHT", "VTLAXS/OFF,RIGHT,30");
    let (end, axis) = away[2];
    assert!((axis.y + 0.5).abs() < 1e-12);
    // The edge away from the wall is at height 0.
    let low = end + Vec3::new(0.0, -axis.z, axis.y);
    assert!(low.z.abs() < 1e-12, "{low}");
    // The side at the wall meets height 0 one radius from the path.
    let edge = end + Vec3::new(0.0, axis.z, -axis.y);
    let base = edge - axis * (edge.z / axis.z);
    assert!((base - Vec3::new(2.0, 1.0, 0.0)).norm() < 1e-12, "{base}");
    let below = tilted("VTLAXS/ON,RIGHT,30,2,0,RIGHT,ZSMALL", "VTLAXS/OFF,RIGHT,30");
    let (end, axis) = below[2];
    let edge = end + Vec3::new(0.0, axis.z, -axis.y);
    assert!((edge - Vec3::new(2.0, 1.0, 0.0)).norm() < 1e-12, "{edge}");
    assert!(end.z < 0.0);
}

#[test]
fn ranges_may_follow_each_other_and_transformations_come_after() {
    let items = vec![
        EditItem::Transform {
            matrix: Some(Matrix::translation(Vec3::new(0.0, 0.0, 7.0))),
            isn: 1,
            source: 1,
        },
        motion(2, &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
        word(3, "VTLAXS/ON,LEFT,0,2,0,LEFT"),
        record(4, ClKind::Arc { surface: "C".into(), center: Vec3::zeros(), axis: Vec3::z(), radius: 1.0 }),
        motion(5, &[[2.0, 0.0, 0.0]]),
        word(6, "VTLAXS/OFF,LEFT,20"),
        word(7, "VTLAXS/ON,LEFT,30,2,0,LEFT"),
        motion(8, &[[3.0, 0.0, 0.0]]),
        word(9, "VTLAXS/OFF,LEFT,30"),
    ];
    let (records, errors) = edit(items);
    assert_eq!(errors, vec![]);
    let all = positions(&records);
    let leaning: Vec<f64> = all.iter().map(|(_, axis)| axis.y.asin().to_degrees().round()).collect();
    assert_eq!(leaning, [0.0, 0.0, 30.0, 30.0], "the second range begins with its own tilt");
    // Only the last position before the range is changed, in a record of its own; the circle in the range is none.
    let isns: Vec<u32> = records.iter().map(|record| record.isn).collect();
    assert_eq!(isns, [1, 2, 2, 3, 5, 6, 7, 8, 9]);
    assert!((all[0].0.z - 7.0).abs() < 1e-12 && (all[1].0.z - 7.0).abs() < 1e-12);
    assert!((all[2].0.z - 7.5).abs() < 1e-12, "half the radius higher");
}

#[test]
fn mistakes_have_their_numbers() {
    const ON: &str = "VTLAXS/ON,LEFT,5,2,.5,RIGHT";
    const OFF: &str = "VTLAXS/OFF,LEFT,10";
    let a = || motion(1, &[[0.0, 0.0, 0.0]]);
    let b = || motion(3, &[[4.0, 0.0, 0.0]]);
    let copy = |isn| EditItem::Copy { number: 1, step: CopyStep::Same, count: 1, isn, source: isn };
    let index = |isn| EditItem::Index { number: 1, end: false, isn, source: isn };
    let tracut = EditItem::Transform { matrix: None, isn: 9, source: 9 };
    let flat =
        record(3, ClKind::Motion { from: false, surface: "".into(), points: points(&[[4.0; 3]], false) });
    let cases: Vec<(Vec<EditItem>, u32, TiltError, Option<u16>)> = vec![
        (vec![a(), word(2, OFF)], 2, TiltError::NotOn, Some(15)),
        (vec![a(), word(2, ON), b()], 2, TiltError::NotOff, Some(15)),
        (vec![a(), word(2, ON), b(), word(4, ON), word(5, OFF)], 4, TiltError::OnTwice, Some(16)),
        (vec![a(), word(2, ON), from(9), b(), word(5, OFF)], 9, TiltError::From, Some(17)),
        (vec![word(2, ON), b(), word(5, OFF)], 2, TiltError::NoMotionBefore, Some(18)),
        (vec![a(), word(2, ON), flat, word(5, OFF)], 2, TiltError::NoAxes, Some(19)),
        (
            vec![a(), word(2, ON), b(), word(5, "VTLAXS/OFF,RIGHT,81")],
            5,
            TiltError::TooFar { degrees: -81.0 },
            Some(20),
        ),
        (
            vec![a(), word(2, "VTLAXS/ON,LEFT,5,2,1.5,RIGHT"), b(), word(5, OFF)],
            2,
            TiltError::CornerRadius { corner: 1.5, radius: 1.0 },
            Some(21),
        ),
        (
            vec![a(), word(2, "VTLAXS/ON,LEFT,5,2,.5,RIGHT,ZSMALL"), b(), word(5, OFF)],
            2,
            TiltError::RoundedEdge { corner: 0.5 },
            Some(22),
        ),
        (vec![a(), word(2, ON), word(5, OFF)], 5, TiltError::NoMotion, Some(23)),
        (
            vec![
                a(),
                word(2, ON),
                b(),
                word(6, "WCORN/LEFT,5,LEFT,5,1"),
                word(7, "WCORN/LEFT,5,LEFT,5,1"),
                word(8, OFF),
            ],
            7,
            TiltError::CornerTwice,
            Some(24),
        ),
        (
            vec![a(), word(2, ON), word(6, "WCORN/LEFT,5,LEFT,5,1"), b(), word(8, OFF)],
            6,
            TiltError::NoMotionBeforeCorner,
            Some(29),
        ),
        (
            vec![a(), word(2, ON), b(), word(6, "WCORN/LEFT,5,LEFT,5,1"), word(8, OFF)],
            8,
            TiltError::NoMotionAfterCorner,
            Some(30),
        ),
        (vec![a(), index(7), word(8, ON), b(), word(9, OFF), copy(10)], 8, TiltError::IndexBefore, Some(31)),
        (vec![a(), word(2, ON), b(), tracut, word(10, OFF)], 9, TiltError::Transform, Some(32)),
        (vec![index(1), a(), word(2, ON), b(), copy(9), word(10, OFF)], 9, TiltError::Copy, Some(33)),
        (
            vec![a(), word(2, ON), motion(3, &[[0.0, 0.0, 5.0]]), word(5, OFF)],
            5,
            TiltError::Vertical,
            Some(37),
        ),
        (vec![a(), word(2, ON), index(9), b(), word(10, OFF)], 9, TiltError::Index, Some(39)),
        (vec![a(), word(6, "WCORN/LEFT,5,LEFT,5,1"), b()], 6, TiltError::CornerOutside, None),
        (vec![a(), word(2, "VTLAXS/ON,LEFT,5"), b(), word(5, OFF)], 2, TiltError::Form("VTLAXS"), None),
        (vec![a(), word(2, ON), b(), word(5, "VTLAXS/OFF,UP,0")], 5, TiltError::Modifier("VTLAXS"), Some(14)),
        (vec![a(), word(2, ON), b(), word(5, "VTLAXS/OFF")], 5, TiltError::Form("VTLAXS"), None),
        (vec![a(), word(2, "VTLAXS/UP,5"), b()], 2, TiltError::Modifier("VTLAXS"), Some(14)),
        (vec![a(), word(2, "VTLAXS/5"), b()], 2, TiltError::Form("VTLAXS"), None),
    ];
    for (items, isn, kind, apt3) in cases {
        let before = items.iter().filter(|item| matches!(item, EditItem::Record(_))).count();
        let (records, errors) = edit(items);
        assert_eq!(errors.len(), 1, "{kind}: {errors:?}");
        let error = errors[0];
        assert_eq!((error.isn, error.kind, error.apt3()), (isn, EditErrorKind::Tilt(kind), apt3));
        assert!(records.len() >= before, "{kind}: a record is lost");
        assert!(
            positions(&records).iter().all(|(_, axis)| *axis == Vec3::z()),
            "{kind}: something is tilted"
        );
    }
}

#[test]
fn a_range_inside_of_a_copy_is_copied_tilted() {
    let items = vec![
        EditItem::Index { number: 1, end: false, isn: 1, source: 1 },
        motion(2, &[[0.0, 0.0, 0.0]]),
        word(3, "VTLAXS/ON,LEFT,10,2,0,RIGHT"),
        motion(4, &[[3.0, 0.0, 0.0]]),
        word(5, "VTLAXS/OFF,LEFT,10"),
        EditItem::Copy {
            number: 1,
            step: CopyStep::Translation(Vec3::new(0.0, 50.0, 0.0)),
            count: 1,
            isn: 6,
            source: 6,
        },
    ];
    let (records, errors) = edit(items);
    assert_eq!(errors, vec![]);
    let all = positions(&records);
    assert_eq!(all.len(), 4);
    for (first, copy) in all.iter().zip(&all[2..]) {
        assert!((copy.0 - first.0 - Vec3::new(0.0, 50.0, 0.0)).norm() < 1e-12 && copy.1 == first.1);
    }
}

/// Height of the lowest point of a cutter with a corner radius.
fn lowest(end: Vec3, axis: Vec3, radius: f64, corner: f64) -> f64 {
    let level = axis.x.hypot(axis.y);
    end.z + corner * axis.z - (radius - corner) * level - corner
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn the_tilted_tool_keeps_its_height_and_the_foot_of_the_wall(
        radius in 0.1..5.0_f64, part in 0.0..1.0_f64, start in 0.0..79.0_f64, end in 0.0..79.0_f64,
        left in any::<bool>(), cutter_left in any::<bool>(),
        path in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 3..8),
    ) {
        let path: Vec<[f64; 3]> = path.into_iter().map(|(x, y)| [x, y, 2.0]).collect();
        let far = path.windows(2).all(|pair| (Vec3::from(pair[1]) - Vec3::from(pair[0])).norm() > 1e-3);
        prop_assume!(far);
        let corner = radius * part;
        let side = |left: bool| if left { "LEFT" } else { "RIGHT" };
        let items = vec![
            motion(1, &path[..1]),
            word(2, &format!("VTLAXS/ON,{},{start},{},{corner},{}", side(left), radius * 2.0, side(cutter_left))),
            motion(3, &path[1..]),
            word(4, &format!("VTLAXS/OFF,{},{end}", side(left))),
        ];
        let (records, errors) = edit(items);
        prop_assert_eq!(errors.len(), 0);
        let tilted = positions(&records);
        prop_assert_eq!(tilted.len(), path.len());
        for (at, (tip, axis)) in tilted.iter().enumerate() {
            let (a, b) = if at == 0 { (path[0], path[1]) } else { (path[at - 1], path[at]) };
            let direction = (Vec3::from(b) - Vec3::from(a)).normalize();
            // Left of the path lies +y for a path along +x.
            let leftwards = Vec3::z().cross(&direction);
            let wall = if cutter_left { -leftwards } else { leftwards };
            prop_assert!(axis.dot(&direction).abs() < 1e-9);
            prop_assert!((axis.norm() - 1.0).abs() < 1e-12 && axis.z > 0.17);
            let leans = axis.dot(&leftwards);
            prop_assert!((left && leans > -1e-12) || (!left && leans < 1e-12));
            prop_assert!((lowest(*tip, *axis, radius, corner) - 2.0).abs() < 1e-9);
            // The side towards the wall is a plane with this normal at the radius from the axis; the foot of the wall
            // lies in it.
            let normal = direction.cross(axis) * if wall.dot(&direction.cross(axis)) > 0.0 { 1.0 } else { -1.0 };
            let foot = Vec3::from(path[at]) + wall * radius;
            prop_assert!(((foot - tip).dot(&normal) - radius).abs() < 1e-9);
        }
        let angle = |axis: Vec3| axis.z.clamp(-1.0, 1.0).acos().to_degrees();
        prop_assert!((angle(tilted[0].1) - start).abs() < 1e-5);
        prop_assert!((angle(tilted[tilted.len() - 1].1) - end).abs() < 1e-5);
    }
}
