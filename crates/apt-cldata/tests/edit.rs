//! TRACUT, INDEX and COPY: worked programs and properties.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use std::cell::Cell;

use apt_cldata::{
    edit::{EditErrorKind, EditItem, EditLimits, MAXIMUM_INDEXES, edit, edit_until, edit_within},
    record::{ClKind, ClPoint, ClRecord, ClWord},
};
use apt_geometry::{
    Vec3,
    canonical::{Matrix, matrix::CoordinatePlane},
    copy::CopyStep,
};
use proptest::prelude::*;

fn motion(isn: u32, at: [f64; 3]) -> EditItem {
    let point = ClPoint { position: at.into(), axis: Vec3::z(), with_axis: false };
    EditItem::Record(ClRecord {
        isn,
        source: isn,
        kind: ClKind::Motion { from: false, surface: "".into(), points: vec![point] },
    })
}

fn index(isn: u32, number: i64, end: bool) -> EditItem {
    EditItem::Index { number, end, isn, source: isn }
}

fn copy(isn: u32, number: i64, matrix: Option<Matrix>, count: u32) -> EditItem {
    let step = matrix.map_or(CopyStep::Same, CopyStep::Matrix);
    EditItem::Copy { number, step, count, isn, source: isn }
}

fn tracut(isn: u32, matrix: Option<Matrix>) -> EditItem {
    EditItem::Transform { matrix, isn, source: isn }
}

fn shift(x: f64, y: f64, z: f64) -> Option<Matrix> {
    Some(Matrix::translation(Vec3::new(x, y, z)))
}

fn turn(degrees: f64) -> Option<Matrix> {
    Some(Matrix::rotation(CoordinatePlane::Xy, degrees))
}

/// One line per record: statement, and position or word.
fn listing(records: &[ClRecord]) -> Vec<String> {
    records
        .iter()
        .map(|record| match &record.kind {
            ClKind::Motion { points, .. } => {
                let at = points[0].position.map(|value| (value * 1e9).round() / 1e9 + 0.0);
                format!("{} {} {} {}", record.isn, at.x, at.y, at.z)
            }
            ClKind::Postprocessor { word, arguments, .. } => {
                let first = match arguments.first() {
                    Some(ClWord::Number(number)) => number.to_string(),
                    Some(ClWord::Word(word)) => word.to_string(),
                    None => String::new(),
                };
                format!("{} {word} {first}", record.isn)
            }
            other => format!("{other:?}"),
        })
        .collect()
}

fn edited(items: Vec<EditItem>) -> Vec<String> {
    let (records, errors) = edit(items);
    assert_eq!(errors, vec![]);
    listing(&records)
}

#[test]
fn nested_copies_repeat_the_edit_statements_too() {
    let items = vec![
        index(5, 1, false),
        index(6, 2, false),
        motion(7, [1.0, 0.0, 0.0]),
        copy(8, 2, shift(1.0, 0.0, 0.0), 1),
        copy(9, 1, shift(0.0, 5.0, 0.0), 1),
    ];
    assert_eq!(
        edited(items),
        [
            "5 INDEX 1",
            "6 INDEX 2",
            "7 1 0 0",
            "8 INDEX 2",
            "7 2 0 0",
            "8 COPY 2",
            "9 INDEX 1",
            "6 INDEX 2",
            "7 1 5 0",
            "8 INDEX 2",
            "7 2 5 0",
            "8 COPY 2",
            "9 COPY 1"
        ]
    );
}

#[test]
fn copies_accumulate_their_step() {
    let items = vec![index(5, 7, false), motion(6, [2.0, 0.0, 0.0]), copy(8, 7, turn(90.0), 3)];
    assert_eq!(
        edited(items),
        [
            "5 INDEX 7",
            "6 2 0 0",
            "8 INDEX 7",
            "6 0 2 0",
            "8 INDEX 7",
            "6 -2 0 0",
            "8 INDEX 7",
            "6 0 -2 0",
            "8 COPY 7"
        ]
    );
}

#[test]
fn same_repeats_and_nomore_bounds_the_range() {
    let items = vec![
        index(1, 1, false),
        motion(2, [1.0, 0.0, 0.0]),
        index(3, 1, true),
        motion(4, [9.0, 9.0, 0.0]),
        copy(5, 1, None, 1),
    ];
    assert_eq!(
        edited(items),
        ["1 INDEX 1", "2 1 0 0", "3 INDEX 1", "4 9 9 0", "5 INDEX 1", "2 1 0 0", "5 COPY 1"]
    );
}

#[test]
fn transforms_replace_each_other_and_end() {
    let items = vec![
        tracut(1, shift(1.0, 0.0, 0.0)),
        motion(2, [0.0; 3]),
        tracut(3, turn(90.0)),
        motion(4, [5.0, 0.0, 0.0]),
        tracut(5, None),
        motion(6, [5.0, 0.0, 0.0]),
    ];
    assert_eq!(
        edited(items),
        ["1 TRACUT 1", "2 1 0 0", "3 TRACUT 0", "4 0 5 0", "5 TRACUT NOMORE", "6 5 0 0"]
    );
}

#[test]
fn a_transform_around_a_range_acts_after_its_copies() {
    // Turned by 90 degrees at the end, the step along x becomes one along y.
    let items = vec![
        tracut(1, turn(90.0)),
        index(2, 1, false),
        motion(3, [1.0, 0.0, 0.0]),
        copy(4, 1, shift(1.0, 0.0, 0.0), 1),
        tracut(5, None),
    ];
    let lines = edited(items);
    assert!(lines.contains(&"3 0 1 0".to_owned()) && lines.contains(&"3 0 2 0".to_owned()), "{lines:?}");
}

#[test]
fn a_transform_inside_a_range_acts_before_its_copies() {
    let items = vec![
        index(1, 1, false),
        tracut(2, turn(90.0)),
        motion(3, [1.0, 0.0, 0.0]),
        tracut(4, None),
        copy(5, 1, shift(1.0, 0.0, 0.0), 1),
        motion(6, [7.0, 0.0, 0.0]),
    ];
    let lines = edited(items);
    assert!(lines.contains(&"3 0 1 0".to_owned()) && lines.contains(&"3 1 1 0".to_owned()), "{lines:?}");
    assert_eq!(lines.last().unwrap(), "6 7 0 0");
}

#[test]
fn axes_turn_and_stay_unit_circles_scale() {
    let matrix = Matrix::rotation(CoordinatePlane::Yz, 90.0).multiply(&Matrix::scaling(2.0));
    let point = ClPoint { position: Vec3::new(1.0, 2.0, 3.0), axis: Vec3::z(), with_axis: true };
    let arc = ClKind::Arc { surface: "C".into(), center: Vec3::x(), axis: Vec3::z(), radius: 3.0 };
    let go = ClKind::Motion { from: false, surface: "C".into(), points: vec![point] };
    let record = |kind| EditItem::Record(ClRecord { isn: 1, source: 0, kind });
    let (records, errors) = edit(vec![tracut(1, Some(matrix)), record(arc), record(go)]);
    assert_eq!(errors, vec![]);
    let ClKind::Arc { center, axis, radius, .. } = &records[1].kind else { panic!("{records:?}") };
    assert!((center - Vec3::new(2.0, 0.0, 0.0)).norm() < 1e-12 && (axis + Vec3::y()).norm() < 1e-12);
    assert!((radius - 6.0).abs() < 1e-12);
    let ClKind::Motion { points, .. } = &records[2].kind else { panic!("{records:?}") };
    assert!((points[0].position - Vec3::new(2.0, -6.0, 4.0)).norm() < 1e-12);
    assert!((points[0].axis + Vec3::y()).norm() < 1e-12);
}

#[test]
fn mistakes_have_their_numbers() {
    let deep = vec![
        index(1, 1, false),
        index(2, 2, false),
        index(3, 3, false),
        index(4, 4, false),
        motion(5, [0.0; 3]),
        copy(6, 4, None, 1),
        copy(7, 3, None, 1),
        copy(8, 2, None, 1),
        copy(9, 1, None, 1),
    ];
    let overlap = vec![
        index(1, 1, false),
        index(2, 2, false),
        motion(3, [0.0; 3]),
        copy(4, 1, None, 1),
        copy(5, 2, None, 1),
    ];
    let many = vec![
        index(1, 1, false),
        motion(2, [0.0; 3]),
        copy(3, 1, None, 1),
        copy(4, 1, None, 1),
        copy(5, 1, None, 1),
        copy(6, 1, None, 1),
    ];
    let again = vec![
        index(1, 1, false),
        motion(2, [0.0; 3]),
        copy(3, 1, None, 1),
        index(4, 1, false),
        motion(5, [1.0; 3]),
        copy(6, 1, None, 1),
    ];
    let ended_twice = vec![index(1, 1, false), index(2, 1, true), index(3, 1, true), copy(4, 1, None, 1)];
    let cases: [(Vec<EditItem>, u32, EditErrorKind, Option<u16>); 11] = [
        (again, 4, EditErrorKind::IndexReused { number: 1 }, Some(11)),
        (vec![index(1, 1, false), index(2, 1, false)], 2, EditErrorKind::IndexReused { number: 1 }, Some(11)),
        (ended_twice, 3, EditErrorKind::EndWithoutIndex { number: 1 }, Some(11)),
        (deep, 4, EditErrorKind::NestedTooDeep { number: 4, depth: 4 }, Some(5)),
        (overlap, 4, EditErrorKind::Overlap { number: 1, open: 2 }, Some(11)),
        (many, 6, EditErrorKind::TooManyCopies { number: 1 }, Some(11)),
        (
            vec![motion(1, [0.0; 3]), copy(2, 3, None, 2)],
            2,
            EditErrorKind::CopyWithoutIndex { number: 3 },
            Some(11),
        ),
        (vec![index(1, 3, true)], 1, EditErrorKind::EndWithoutIndex { number: 3 }, Some(11)),
        (
            vec![index(1, 1, false), index(2, 1, false), copy(3, 1, None, 1)],
            2,
            EditErrorKind::IndexReused { number: 1 },
            Some(11),
        ),
        (vec![index(1, 1, false), copy(2, 1, None, 0)], 2, EditErrorKind::ZeroCount { number: 1 }, None),
        (
            vec![tracut(1, Some(Matrix::scaling(0.0))), motion(2, [1.0; 3])],
            2,
            EditErrorKind::AxisVanishes { axis: [0.0, 0.0, 1.0] },
            Some(37),
        ),
    ];
    for (items, isn, kind, apt3) in cases {
        let (_, errors) = edit(items);
        assert_eq!(errors.len(), 1, "{errors:?}");
        assert_eq!((errors[0].isn, errors[0].kind, errors[0].apt3()), (isn, kind, apt3));
    }
}

#[test]
fn the_table_of_indexes_has_an_end_in_apt3() {
    let indexes = |count: u32| (1..=count).map(|number| index(number, i64::from(number), false)).collect();
    let most = MAXIMUM_INDEXES as u32;
    let limits = EditLimits { indexes: MAXIMUM_INDEXES, ..EditLimits::default() };
    assert_eq!(edit_within(indexes(most), &limits).1, vec![]);
    let (records, errors) = edit_within(indexes(most + 1), &limits);
    assert_eq!(records.len(), MAXIMUM_INDEXES + 1, "the records stay");
    assert_eq!(errors.len(), 1);
    assert_eq!((errors[0].isn, errors[0].apt3()), (most + 1, Some(4)));
    assert_eq!(edit(indexes(500)).1, vec![], "other dialects have no such table");
}

#[test]
fn a_slip_in_a_count_ends_in_a_message() {
    let items = vec![index(1, 1, false), motion(2, [0.0; 3]), copy(3, 1, None, u32::MAX)];
    let (records, errors) = edit(items);
    assert!(records.len() < 10);
    assert!(matches!(errors[0].kind, EditErrorKind::TooManyRecords { number: 1, .. }));
}

fn positions(records: &[ClRecord]) -> Vec<Vec3> {
    let points = records.iter().filter_map(|record| match &record.kind {
        ClKind::Motion { points, .. } => Some(points[0].position),
        _ => None,
    });
    points.collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn the_kth_copy_carries_k_steps(
        count in 1_u32..6, degrees in -180.0..180.0_f64, by in prop::array::uniform3(-5.0..5.0_f64),
        at in prop::array::uniform3(-9.0..9.0_f64),
    ) {
        let step = Matrix::translation(by.into()).multiply(&Matrix::rotation(CoordinatePlane::Xy, degrees));
        let (records, errors) = edit(vec![index(1, 1, false), motion(2, at), copy(3, 1, Some(step), count)]);
        prop_assert_eq!(errors.len(), 0);
        let positions = positions(&records);
        prop_assert_eq!(positions.len(), count as usize + 1);
        for pair in positions.windows(2) {
            prop_assert!((step.apply_point(&pair[0]) - pair[1]).norm() < 1e-9);
        }
    }

    #[test]
    fn any_order_of_statements_keeps_all_motions(script in prop::collection::vec((0_u8..5, 1_i64..4, 0_u32..3), 0..24)) {
        let mut motions = 0;
        let items: Vec<EditItem> = script
            .iter()
            .zip(1_u32..)
            .map(|(&(what, number, count), isn)| match what {
                0 => index(isn, number, false),
                1 => index(isn, number, true),
                2 => copy(isn, number, turn(30.0), count),
                3 => tracut(isn, (count > 0).then(Matrix::identity)),
                _ => {
                    motions += 1;
                    motion(isn, [f64::from(isn), 0.0, 0.0])
                }
            })
            .collect();
        let (records, _) = edit(items);
        prop_assert!(positions(&records).len() >= motions);
    }
}

#[test]
fn copies_keep_the_budget_of_positions() {
    let items =
        || vec![index(1, 1, false), motion(2, [1.0, 0.0, 0.0]), copy(3, 1, None, 4), motion(4, [0.0; 3])];
    let within = |points| edit_within(items(), &EditLimits { points, ..EditLimits::default() });
    assert_eq!(within(6).1, vec![], "one, its four copies and the last");
    let (records, errors) = within(5);
    assert_eq!(errors[0].kind, EditErrorKind::TooManyPoints { number: 1, limit: 5 });
    let positions = records.iter().filter(|one| matches!(one.kind, ClKind::Motion { .. })).count();
    assert_eq!(positions, 2, "nothing is copied");
}

#[test]
fn a_copy_is_written_in_the_words_of_the_program() {
    let numbers = |values: &[f64]| values.iter().copied().map(ClWord::Number).collect::<Vec<_>>();
    let matrix = Matrix::rotation(CoordinatePlane::Xy, 90.0);
    let cases = [
        (CopyStep::Same, "SAME", vec![]),
        (CopyStep::Translation(Vec3::new(1.0, -0.0, 2.0)), "TRANSL", vec![1.0, 0.0, 2.0]),
        (CopyStep::RotationAboutZ(90.0), "XYROT", vec![90.0]),
        (CopyStep::Matrix(matrix), "MODIFY", matrix.rows.into_iter().flatten().collect()),
    ];
    for (step, word, values) in cases {
        let order = EditItem::Copy { number: 7, step, count: 2, isn: 3, source: 3 };
        let (records, errors) = edit(vec![index(1, 7, false), motion(2, [1.0, 0.0, 0.0]), order]);
        assert_eq!(errors, vec![]);
        let ClKind::Postprocessor { word: major, arguments, .. } = &records.last().unwrap().kind else {
            panic!("{word}: no statement")
        };
        let mut expected = numbers(&[7.0]);
        expected.push(ClWord::Word(word.into()));
        expected.extend(numbers(&values));
        expected.extend(numbers(&[2.0]));
        assert_eq!((major.as_str(), arguments), ("COPY", &expected));
        let negative_zero =
            |word: &ClWord| matches!(word, ClWord::Number(n) if *n == 0.0 && n.is_sign_negative());
        assert!(!arguments.iter().any(negative_zero), "no negative zero stands in a CL file: {arguments:?}");
    }
}

/// Positions that may be copied or transformed between two questions whether to go on, a tenth of a microsecond each.
const POSITIONS_BETWEEN_QUESTIONS: u64 = 3_000;

#[test]
fn copies_and_transforms_ask_often_whether_to_go_on() {
    let copies = || vec![index(1, 1, false), motion(2, [1.0, 0.0, 0.0]), copy(3, 1, turn(1.0), 20_000)];
    let mut long = motion(2, [0.0; 3]);
    if let EditItem::Record(ClRecord { kind: ClKind::Motion { points, .. }, .. }) = &mut long {
        let point = points[0];
        points.resize(20_000, point);
    }
    let whole_motion = || vec![tracut(1, Some(Matrix::rotation(CoordinatePlane::Xy, 90.0))), long.clone()];
    for items in [copies(), whole_motion()] {
        let asked = Cell::new(0);
        let count = || {
            asked.set(asked.get() + 1);
            false
        };
        let all = edit_until(items.clone(), &EditLimits::default(), &count);
        assert_eq!(all, Some(edit(items.clone())));
        assert!(asked.get() * POSITIONS_BETWEEN_QUESTIONS >= 20_000, "{} questions", asked.get());
        let at = asked.replace(0) / 2;
        let cancelled = edit_until(items, &EditLimits::default(), &|| {
            asked.set(asked.get() + 1);
            asked.get() >= at
        });
        assert_eq!(cancelled, None);
        assert_eq!(asked.get(), at, "asked again after the answer");
    }
}
