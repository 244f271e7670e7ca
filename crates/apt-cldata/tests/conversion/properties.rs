//! Any numbers and any text.

use apt_cldata::{
    conversion::convert,
    record::{ClKind, ClPoint, ClRecord, ClWord},
    text::{ClDialect, ClText, read_with_remarks},
};
use apt_geometry::Vec3;
use proptest::prelude::*;

use super::{codes, text};

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1e3..1e3_f64,
        -1e-9..1e-9_f64,
        Just(0.0),
        (-1_000_000..1_000_000_i32).prop_map(f64::from),
        any::<f64>().prop_filter("finite", |value| value.is_finite())
    ]
}

fn any_axis() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1.0..1.0_f64)
        .prop_map(Vec3::from)
        .prop_filter("a direction", |axis| axis.norm() > 0.1)
        .prop_map(|axis| axis.normalize())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever numbers a path has, it is the same to the last bit, and so are the axes to rounding.
    #[test]
    fn positions_read_back_bit_for_bit(
        points in prop::collection::vec((prop::array::uniform3(any_number()), any_axis(), any::<bool>()), 1..9),
        number in any_number(),
    ) {
        let mut records: Vec<ClRecord> = Vec::new();
        let mut push = |kind| records.push(ClRecord { isn: 1, source: 0, kind });
        push(ClKind::Postprocessor { word: "ORIGIN".into(), code: None, arguments: vec![ClWord::Number(number)] });
        let mut multax = false;
        for (at, axis, tilted) in &points {
            if *tilted && !multax {
                multax = true;
                push(ClKind::MultipleAxes(true));
            }
            let axis = if multax { *axis } else { Vec3::z() };
            let point = ClPoint { position: (*at).into(), axis, with_axis: multax };
            push(ClKind::Motion { from: false, surface: "".into(), points: vec![point] });
        }
        push(ClKind::End);
        let file = ClText { records, ..ClText::default() };
        for to in ClDialect::ALL.into_iter().filter(|to| *to != ClDialect::Cltape) {
            let text = text(&file, ClDialect::PartProgram, to);
            let (again, errors) = read_with_remarks(&text);
            prop_assert_eq!(&errors, &vec![], "{}", text);
            let places = |file: &ClText| file.records.iter().filter_map(|record| match &record.kind {
                ClKind::Motion { points, .. } => Some(points.clone()),
                _ => None,
            }).flatten().collect::<Vec<ClPoint>>();
            let (a, b) = (places(&file), places(&again));
            prop_assert_eq!(a.len(), b.len());
            for (a, b) in a.iter().zip(&b) {
                prop_assert_eq!(a.position, b.position, "{}", text);
                prop_assert!((a.axis - b.axis).norm() < 1e-15, "{}", text);
            }
            let origin = again.records.iter().any(|record| matches!(&record.kind,
                ClKind::Postprocessor { arguments, .. } if *arguments == [ClWord::Number(number + 0.0)]));
            prop_assert!(origin, "{}", text);
        }
    }

    #[test]
    fn any_text_is_converted_without_panic(text in "[A-Z0-9/,.$+\\-='|>() \n]{0,200}") {
        let (file, _) = read_with_remarks(&text);
        for from in ClDialect::ALL {
            for to in ClDialect::ALL {
                let _ = convert(&file, from, to, &codes());
            }
        }
    }
}
