//! The binary tape against a file that the public APT III port wrote.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use apt_cldata::{
    cltape::{TapeWriteError, is_ncl_file, is_tape, read_tape, write_tape},
    codes::CodeTable,
    record::{ClKind, ClPoint, ClRecord, ClWord, Units},
    text::read_text,
};

fn codes() -> CodeTable {
    let mut codes = CodeTable::new();
    for (word, code) in [
        ("END", 1),
        ("STOP", 2),
        ("RAPID", 5),
        ("LOADTL", 1055),
        ("SPINDL", 1031),
        ("FEDRAT", 1009),
        ("COOLNT", 1030),
        ("PARTNO", 1045),
    ] {
        codes.major(word, code);
    }
    for (word, code) in [("LENGTH", 9), ("CLW", 60), ("IPM", 73), ("ON", 71), ("OFF", 72)] {
        codes.minor(word, code);
    }
    codes
}

const SAMPLE: &[u8] = include_bytes!("data/cltape-01.tap");
const NCL_SAMPLE: &[u8] = include_bytes!("data/ncl-03.tap");

#[test]
fn sample_is_read() {
    assert!(is_tape(SAMPLE));
    let contents = read_tape(SAMPLE, &codes()).unwrap();
    assert_eq!(contents.notes, vec![]);
    let words: Vec<String> = contents
        .records
        .iter()
        .map(|record| match &record.kind {
            ClKind::Text { word, text, .. } => format!("{} {word} {text}", record.isn),
            ClKind::Postprocessor { word, arguments, .. } | ClKind::Control { word, arguments, .. } => {
                let arguments: Vec<String> = arguments
                    .iter()
                    .map(|argument| match argument {
                        ClWord::Number(number) => number.to_string(),
                        ClWord::Word(word) => word.to_string(),
                    })
                    .collect();
                format!("{} {word}/{}", record.isn, arguments.join(","))
            }
            ClKind::Motion { from, surface, points } => {
                let start = if *from { "FROM" } else { "GOTO" };
                let position = points[0].position;
                format!(
                    "{} {start} {surface} {:.4} {:.4} {:.4} {}",
                    record.isn, position.x, position.y, position.z, points[0].axis.z
                )
            }
            ClKind::MultipleAxes(on) => format!("{} MULTAX {on}", record.isn),
            ClKind::End => format!("{} FINI", record.isn),
            other => format!("{other:?}"),
        })
        .collect();
    expect_test::expect![[r#"
        1 PARTNO BINARY SAMPLE 1
        2 INTOL/0,0,0,0
        3 OUTTOL/0.01,0.01,0.01,0.01
        4 CUTTER/10
        6 FROM SP 0.0000 0.0000 50.0000 1
        7 LOADTL/1,LENGTH,100
        8 SPINDL/1200,CLW
        9 FEDRAT/300,IPM
        10 COOLNT/ON
        11 RAPID/
        12 GOTO  -10.0000 0.0000 5.0000 1
        15 GOTO C1 20.4783 24.3826 0.0000 1
        16 GOTO TLAXIS 20.4783 24.3826 10.0000 1
        17 MULTAX true
        18 GOTO  0.0000 0.0000 20.0000 0.8
        19 COOLNT/OFF
        20 STOP/
        21 END/
        22 FINI"#]]
    .assert_eq(&words.join("\n"));
}

#[test]
fn sample_is_written_again_byte_for_byte() {
    let contents = read_tape(SAMPLE, &codes()).unwrap();
    let written = write_tape(&contents.records, &codes()).unwrap();
    // One filling byte stands at the end of the sample.
    assert_eq!(written, SAMPLE[..SAMPLE.len() - 1]);
}

/// What APT III wrote for these words: 6000/1 with 1 for DNTCUT and 0 for CUT, 6000/2 with 1 for 3DCALC and 0 for 2DCALC.
#[test]
fn a_number_tells_which_of_two_words_it_is() {
    for (word, subclass, number) in [("CUT", 1u16, 0u8), ("DNTCUT", 1, 1), ("2DCALC", 2, 0), ("3DCALC", 2, 1)]
    {
        let kind = ClKind::Control { word: word.into(), code: [6000, subclass], arguments: vec![] };
        let records = vec![ClRecord { isn: 7, source: u32::MAX, kind }];
        let bytes = write_tape(&records, &codes()).unwrap();
        let subclass = u8::try_from(subclass).unwrap();
        // Record 2 after that of the statement number, one word of class 6000, which is 0x1770.
        let expected: [u8; 24] =
            [2, 0, 0, 0, 1, 0, 0, 0, 0x70, 0x17, 0, 0, subclass, 0, 0, 0, number, 0, 0, 0, 0, 0, 0, 0];
        assert_eq!(bytes[bytes.len() - expected.len()..], expected, "{word}");
        assert_eq!(read_tape(&bytes, &codes()).unwrap().records, records, "{word}");
        assert_eq!(read_text(&format!("{word}\n")).0[0].kind, records[0].kind, "{word}");
    }
}

/// The name of a post-processor is no word of the language: it stands on the tape as names of surfaces do.
#[test]
fn the_name_of_a_machine_is_written_as_a_name() {
    let machine = |name: &str| {
        let arguments = vec![ClWord::Word(name.into()), ClWord::Number(3.0), ClWord::Word("ON".into())];
        let kind = ClKind::Postprocessor { word: "MACHIN".into(), code: Some(1015), arguments };
        vec![ClRecord { isn: 2, source: u32::MAX, kind }]
    };
    let mut codes = codes();
    codes.major("MACHIN", 1015);
    let bytes = write_tape(&machine("FANUC"), &codes).unwrap();
    assert_eq!(bytes[bytes.len() - 24..bytes.len() - 16], *b" FANUC  ");
    assert_eq!(read_tape(&bytes, &codes).unwrap().records, machine("FANUC"));
    // Seven characters are more than fit, and another word has no names.
    assert!(write_tape(&machine("FANUC12"), &codes).is_err());
    let arguments = vec![ClWord::Word("FANUC".into())];
    let kind = ClKind::Postprocessor { word: "COOLNT".into(), code: Some(1030), arguments };
    assert!(write_tape(&[ClRecord { isn: 2, source: u32::MAX, kind }], &codes).is_err());
}

#[test]
fn any_prefix_or_garbage_ends_in_a_result() {
    for length in 0..SAMPLE.len() {
        let _ = read_tape(&SAMPLE[..length], &codes());
    }
    let mut broken = SAMPLE.to_vec();
    for at in 0..broken.len() {
        broken[at] ^= 0xa5;
        let _ = read_tape(&broken, &codes());
    }
    assert!(read_tape(&[0xff; 64], &codes()).is_err());
}

#[test]
fn a_file_of_ncl_is_read() {
    assert!(is_ncl_file(NCL_SAMPLE) && !is_ncl_file(SAMPLE) && !is_tape(NCL_SAMPLE));
    let mut table = codes();
    table.major("MACHIN", 1015);
    let contents = read_tape(NCL_SAMPLE, &table).unwrap();
    assert_eq!(contents.notes, vec![]);
    let told = contents.records.iter().map(|record| match &record.kind {
        ClKind::Text { word, text, .. } => format!("{word} {text}"),
        ClKind::Postprocessor { word, arguments, .. } | ClKind::Control { word, arguments, .. } => {
            format!("{word} {arguments:?}")
        }
        ClKind::Motion { from, points, .. } => {
            let axes = points.iter().all(|point| point.with_axis && point.axis.z == 1.0);
            // The arc of the sample is a quarter of a circle about (0, 50).
            let radius = |at: &ClPoint| at.position.x.hypot(at.position.y - 50.0);
            let on_arc = points.iter().filter(|point| (radius(point) - 50.0).abs() < 1e-9).count();
            format!("from {from}, {} points, axes {axes}, {on_arc} on the arc", points.len())
        }
        other => format!("{other:?}"),
    });
    let told: Vec<_> =
        told.zip(&contents.records).map(|(what, record)| format!("{} {what}", record.isn)).collect();
    expect_test::expect![[r#"
        0 PARTNO SAMPLE
        2 MACHIN [Word("PWORKS"), Number(12.0)]
        3 MultipleAxes(true)
        4 CUTTER [Number(12.0), Number(1.0), Number(50.0)]
        5 from true, 1 points, axes true, 1 on the arc
        6 FEDRAT [Number(1000.0)]
        7 from false, 1 points, axes true, 1 on the arc
        8 from false, 45 points, axes true, 45 on the arc
        9 STOP []
        10 End"#]]
    .assert_eq(&told.join("\n"));
}

#[test]
fn broken_files_of_ncl_end_in_a_result() {
    for length in 0..NCL_SAMPLE.len() {
        let _ = read_tape(&NCL_SAMPLE[..length], &codes());
    }
    let mut broken = NCL_SAMPLE.to_vec();
    for at in 0..broken.len() {
        broken[at] ^= 0xa5;
        let _ = read_tape(&broken, &codes());
    }
    // A record that claims more words than there are.
    let mut long = NCL_SAMPLE.to_vec();
    long[0..2].copy_from_slice(&u16::MAX.to_le_bytes());
    assert!(read_tape(&long, &codes()).is_err());
}

#[test]
fn what_the_tape_cannot_say_is_told_as_what_it_is() {
    let written = |kind: ClKind| write_tape(&[ClRecord { isn: 3, source: 3, kind }], &codes());
    let error = written(ClKind::Units(Units::Millimeters)).unwrap_err();
    assert_eq!(error, TapeWriteError::Unit { isn: 3, unit: "MM".into() });
    assert!(error.to_string().contains("UNITS/MM"), "{error}");
    let name = |name: &str| ClKind::Postprocessor {
        word: "MACHIN".into(),
        code: Some(1015),
        arguments: vec![ClWord::Word(name.into()), ClWord::Number(2.0)],
    };
    let error = written(name("LINUXCNC")).unwrap_err();
    assert_eq!(error, TapeWriteError::MachineName { isn: 3, name: "LINUXCNC".into() });
    assert!(error.to_string().contains("LINUXCNC") && error.to_string().contains('6'), "{error}");
    assert!(written(name("LINCNC")).is_ok());
}

#[test]
fn a_displayed_text_comes_back_as_it_was() {
    let mut codes = codes();
    codes.major("DISPLY", 1021);
    let (records, errors) = read_text("DISPLY/PUT ON THE CLAMP, 3 mm left\nDISPLY/OFF\nFINI\n");
    assert_eq!(errors, vec![]);
    // As CL text too, a text that is spelt like a switch included.
    let quoted = read_text("DISPLY/'ON'\nFINI\n").0;
    for records in [&records, &quoted] {
        assert_eq!(read_text(&apt_cldata::text::write_text(records)).0, *records);
    }
    let kinds: Vec<ClKind> = read_tape(&write_tape(&records, &codes).unwrap(), &codes)
        .unwrap()
        .records
        .into_iter()
        .map(|record| record.kind)
        .collect();
    assert_eq!(
        kinds[..2],
        [
            ClKind::Text {
                word: "DISPLY".into(),
                code: Some(1021),
                text: "PUT ON THE CLAMP, 3 mm left".into()
            },
            ClKind::Postprocessor {
                word: "DISPLY".into(),
                code: Some(1021),
                arguments: vec![ClWord::Word("OFF".into())]
            },
        ]
    );
}
