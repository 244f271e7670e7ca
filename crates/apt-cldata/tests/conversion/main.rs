//! Files of every system, written in every dialect.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

mod properties;
mod small;

use apt_cldata::{
    cltape::read_tape,
    codes::CodeTable,
    conversion::{ConversionNote, ConversionNoteKind, ConvertedFile, convert},
    difference::{Path, Tolerance, compare},
    record::{ClKind, ClPoint, ClRecord},
    text::{ClDialect, ClText, detect, read_with_remarks},
};
use apt_geometry::Vec3;

/// The files of the corpus, with their dialects.
const FILES: [(&str, &str, ClDialect); 16] = [
    ("aptcl-01", include_str!("../data/aptcl-01.cl"), ClDialect::Generic),
    ("aptcl-02", include_str!("../data/aptcl-02.cl"), ClDialect::Generic),
    ("aptcl-03", include_str!("../data/aptcl-03.cl"), ClDialect::Generic),
    ("catia-01", include_str!("../data/catia-01.aptsource"), ClDialect::Catia),
    ("catia-02", include_str!("../data/catia-02.aptsource"), ClDialect::Catia),
    ("catia-03", include_str!("../data/catia-03.aptsource"), ClDialect::Catia),
    ("creo-01", include_str!("../data/creo-01.ncl.1"), ClDialect::Creo),
    ("creo-02", include_str!("../data/creo-02.ncl.1"), ClDialect::Creo),
    ("creo-03", include_str!("../data/creo-03.ncl.1"), ClDialect::Creo),
    ("hsm-01", include_str!("../data/hsm-01.apt"), ClDialect::Hsm),
    ("hsm-02", include_str!("../data/hsm-02.apt"), ClDialect::Hsm),
    ("ncl-01", include_str!("../data/ncl-01.as"), ClDialect::Ncl),
    ("ncl-02", include_str!("../data/ncl-02.as"), ClDialect::Ncl),
    ("nx-01", include_str!("../data/nx-01.cls"), ClDialect::Nx),
    ("nx-02", include_str!("../data/nx-02.cls"), ClDialect::Nx),
    ("nx-03", include_str!("../data/nx-03.cls"), ClDialect::Nx),
];

fn codes() -> CodeTable {
    let mut codes = CodeTable::new();
    for (word, code) in [
        ("END", 1),
        ("STOP", 2),
        ("OPSTOP", 3),
        ("RAPID", 5),
        ("RETRCT", 7),
        ("GOHOME", 14),
        ("MODE", 1003),
        ("REWIND", 1006),
        ("CUTCOM", 1007),
        ("FEDRAT", 1009),
        ("DELAY", 1010),
        ("MACHIN", 1015),
        ("COOLNT", 1030),
        ("SPINDL", 1031),
        ("TURRET", 1033),
        ("PPRINT", 1044),
        ("PARTNO", 1045),
        ("INSERT", 1046),
        ("CYCLE", 1054),
        ("LOADTL", 1055),
    ] {
        codes.major(word, code);
    }
    for (word, code) in [
        ("LEFT", 8),
        ("LENGTH", 9),
        ("CLW", 60),
        ("IPM", 73),
        ("ON", 71),
        ("OFF", 72),
        ("MIST", 90),
        ("FLOOD", 89),
        ("RPM", 78),
        ("ADJUST", 159),
        ("INCHES", 303),
        ("MM", 301),
        ("MMPM", 315),
    ] {
        codes.minor(word, code);
    }
    codes
}

fn read(text: &str) -> ClText {
    let (file, errors) = read_with_remarks(text);
    assert_eq!(errors, vec![], "{text}");
    file
}

fn made(file: &ClText, from: ClDialect, to: ClDialect) -> (ConvertedFile, Vec<ConversionNote>) {
    let conversion = convert(file, from, to, &codes()).unwrap();
    (conversion.file, conversion.notes)
}

fn text(file: &ClText, from: ClDialect, to: ClDialect) -> String {
    match made(file, from, to).0 {
        ConvertedFile::Text(text) => text,
        ConvertedFile::Tape(_) => panic!("a tape"),
    }
}

/// How far a converted path may be from its source: what the notes tell, and else rounding.
fn assert_same_path(source: &[ClRecord], result: &[ClRecord], notes: &[ConversionNote], what: &str) {
    let (a, b) = (Path::of(source), Path::of(result));
    let b = b.in_units(a.units);
    let told = notes.iter().map(|note| match note.kind {
        ConversionNoteKind::WithoutPositions { misfit } => misfit,
        _ => 0.0,
    });
    let mut tolerance = Tolerance::of([&a, &b]);
    tolerance.distance = tolerance.distance.max(told.fold(0.0, f64::max) * (1.0 + 1e-9));
    let found = compare([&a, &b], tolerance, &|| false).unwrap();
    assert!(found.stretches.is_empty(), "{what}: {:?}", found.stretches);
}

/// The same records. Positions on an arc of which the file has the end alone are computed, and equal to rounding.
fn assert_same_records(source: &[ClRecord], result: &[ClRecord], what: &str) {
    assert_eq!(source.len(), result.len(), "{what}");
    for (one, other) in source.iter().zip(result) {
        let (ClKind::Motion { points: a, from, .. }, ClKind::Motion { points: b, from: also, .. }) =
            (&one.kind, &other.kind)
        else {
            assert_eq!(one.kind, other.kind, "{what}");
            continue;
        };
        assert_eq!((a.len(), from), (b.len(), also), "{what}");
        for (a, b) in a.iter().zip(b) {
            assert!((a.position - b.position).norm() <= 1e-12 * a.position.norm(), "{what}: {a:?} {b:?}");
            assert_eq!((a.axis, a.with_axis), (b.axis, b.with_axis), "{what}");
        }
        assert_eq!(a.last().map(|one| one.position), b.last().map(|one| one.position), "{what}");
    }
}

#[test]
fn every_file_in_every_dialect_has_the_path_of_its_source() {
    for (name, source, from) in FILES {
        assert_eq!(detect(source), Some(from), "{name}");
        let file = read(source);
        for to in ClDialect::ALL {
            let what = format!("{name} as {}", to.as_str());
            let (converted, notes) = made(&file, from, to);
            match converted {
                ConvertedFile::Text(text) => {
                    assert_eq!(detect(&text), Some(to), "{what}\n{text}");
                    let (again, errors) = read_with_remarks(&text);
                    assert_eq!(errors, vec![], "{what}\n{text}");
                    assert_same_path(&file.records, &again.records, &notes, &what);
                }
                ConvertedFile::Tape(bytes) => {
                    let contents = read_tape(&bytes, &codes()).unwrap();
                    assert_eq!(contents.notes, vec![], "{what}");
                    assert_same_path(&file.records, &contents.records, &notes, &what);
                }
            }
        }
    }
}

#[test]
fn a_file_in_its_own_dialect_keeps_all_its_records_and_remarks() {
    for (name, source, dialect) in FILES {
        let file = read(source);
        let (_, notes) = made(&file, dialect, dialect);
        let again = read(&text(&file, dialect, dialect));
        assert_same_records(&file.records, &again.records, name);
        let remarks = |file: &ClText| file.remarks.iter().map(|one| one.text.clone()).collect::<Vec<_>>();
        assert_eq!(remarks(&again), remarks(&file), "{name}");
        // The tolerances and the cutter behind a CIRCLE of NX have no place in the records, and that is told.
        let shortened = ConversionNoteKind::Shortened { word: "CIRCLE".into() };
        let told: Vec<&ConversionNoteKind> = notes.iter().map(|note| &note.kind).collect();
        assert_eq!(told, if name == "nx-01" { vec![&shortened] } else { vec![] }, "{name}");
    }
}

#[test]
fn what_another_system_has_is_quoted_and_comes_back() {
    for (name, source, dialect) in FILES {
        let file = read(source);
        for by in [ClDialect::Creo, ClDialect::Generic, ClDialect::Hsm, ClDialect::Catia, ClDialect::Nx] {
            let there = text(&file, dialect, by);
            let back = read(&text(&read(&there), by, dialect));
            // Statements of one system and remarks that are signs of one survive the way through another.
            let own = |file: &ClText| {
                let statements = file.records.iter().filter_map(|record| match &record.kind {
                    ClKind::Postprocessor { word, arguments, .. }
                        if ["TOOL PATH", "MSYS", "PAINT", "END-OF-PATH"].contains(&word.as_str()) =>
                    {
                        Some(format!("{word} {arguments:?}"))
                    }
                    _ => None,
                });
                let pseudo = |text: &&String| text.starts_with("->") && !text.contains("CUTTER");
                let signs = |text: &&String| {
                    text.contains("OPERATION NAME") || text.contains("*CATIA0") || pseudo(text)
                };
                let remarks = file.remarks.iter().map(|remark| &remark.text).filter(signs).cloned();
                statements.chain(remarks).collect::<Vec<String>>()
            };
            assert_eq!(own(&back), own(&file), "{name} by {by:?}");
        }
    }
}

#[test]
fn what_is_said_otherwise_is_told_once_with_its_place() {
    let (_, source, from) = FILES[13];
    let (_, notes) = made(&read(source), from, ClDialect::Catia);
    let paint = notes.iter().find(|note| note.kind == ConversionNoteKind::AsRemark { word: "PAINT".into() });
    assert_eq!(paint.map(|note| (note.source, note.times)), Some((4, 10)), "{notes:?}");
    // Inner points of an arc that the target has no place for.
    let (_, source, from) = FILES[6];
    let (_, notes) = made(&read(source), from, ClDialect::Nx);
    let misfit = notes.iter().find_map(|note| match note.kind {
        ConversionNoteKind::WithoutPositions { misfit } => Some(misfit),
        _ => None,
    });
    assert!((misfit.unwrap() - 25.0 * (1.0 - 22.5_f64.to_radians().cos())).abs() < 1e-6, "{notes:?}");
    // No unit, and feed rates that contradict each other.
    let file = read("FEDRAT/10,IPM\nGOTO/1,2,3\nFEDRAT/10,MMPM\nGOTO/1,2,4\nFINI\n");
    let (_, notes) = made(&file, ClDialect::Generic, ClDialect::Creo);
    assert_eq!(notes.iter().map(|note| &note.kind).collect::<Vec<_>>(), [&ConversionNoteKind::NoUnits]);
}

/// DEEP withdraws the drill in one system and breaks chips in the other: the word stays, and that is told.
#[test]
fn a_cycle_that_does_something_else_elsewhere_is_told() {
    let told = |(_, source, from): (&str, &str, ClDialect), to| {
        let notes = made(&read(source), from, to).1;
        notes.iter().any(|note| note.kind == ConversionNoteKind::OtherCycle { word: "DEEP".into() })
    };
    let (ncl, creo) = (FILES[12], FILES[7]);
    assert!(told(ncl, ClDialect::Creo) && told(ncl, ClDialect::Hsm) && told(creo, ClDialect::Ncl));
    assert!(!told(creo, ClDialect::Hsm) && !told(creo, ClDialect::Creo) && !told(ncl, ClDialect::Generic));
}

/// The axis of a surface that is touched with a tilted tool is none of the path.
#[test]
fn a_circle_that_is_none_of_the_path_stands_in_a_remark() {
    let circle = ClKind::Arc { surface: "C".into(), center: Vec3::zeros(), axis: Vec3::z(), radius: 20.0 };
    let point =
        |x: f64, y: f64| ClPoint { position: Vec3::new(x, y, 0.0), axis: Vec3::z(), with_axis: false };
    let go = |points: Vec<ClPoint>| ClKind::Motion { from: false, surface: "C".into(), points };
    let kinds =
        [go(vec![point(25.0, 0.0)]), circle, go(vec![point(24.0, 9.0), point(18.0, 20.0)]), ClKind::End];
    let records = kinds.into_iter().map(|kind| ClRecord { isn: 1, source: 0, kind }).collect();
    let file = ClText { records, ..ClText::default() };
    for to in ClDialect::ALL.into_iter().filter(|to| *to != ClDialect::Cltape) {
        let (converted, notes) = made(&file, ClDialect::PartProgram, to);
        let ConvertedFile::Text(text) = converted else { panic!("a tape") };
        assert!(text.contains("$$ |CIRCLE/0.0,0.0,0.0,0.0,0.0,1.0,20.0\n"), "{text}");
        assert!(notes.iter().any(|note| note.kind == ConversionNoteKind::PositionsAlone), "{notes:?}");
        assert_same_path(&file.records, &read(&text).records, &[], to.as_str());
    }
}

/// A rapid motion of several positions is one record of a program, and in text each position is a motion of its own.
#[test]
fn rapid_counts_for_all_positions_of_a_record() {
    let point = |x: f64| ClPoint { position: Vec3::new(x, 0.0, 0.0), axis: Vec3::z(), with_axis: false };
    let rapid = ClKind::Postprocessor { word: "RAPID".into(), code: Some(5), arguments: Vec::new() };
    let go = |points: Vec<ClPoint>| ClKind::Motion { from: false, surface: "".into(), points };
    let kinds = [go(vec![point(0.0)]), rapid, go(vec![point(1.0), point(2.0)]), go(vec![point(3.0)])];
    let records = kinds.into_iter().map(|kind| ClRecord { isn: 1, source: 0, kind }).collect();
    let file = ClText { records, ..ClText::default() };
    for to in ClDialect::ALL.into_iter().filter(|to| *to != ClDialect::Cltape) {
        let text = text(&file, ClDialect::PartProgram, to);
        assert_same_path(&file.records, &read(&text).records, &[], to.as_str());
    }
}
