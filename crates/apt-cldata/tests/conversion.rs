//! Files of every system, written in every dialect.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use apt_cldata::{
    cltape::read_tape,
    codes::CodeTable,
    conversion::{ConversionNote, ConversionNoteKind, ConvertedFile, convert},
    difference::{Path, Tolerance, compare},
    record::{ClKind, ClPoint, ClRecord, ClWord},
    text::{ClDialect, ClText, detect, read_with_remarks},
};
use apt_geometry::Vec3;
use proptest::prelude::*;

/// The files of the corpus, with their dialects.
const FILES: [(&str, &str, ClDialect); 16] = [
    ("aptcl-01", include_str!("data/aptcl-01.cl"), ClDialect::Generic),
    ("aptcl-02", include_str!("data/aptcl-02.cl"), ClDialect::Generic),
    ("aptcl-03", include_str!("data/aptcl-03.cl"), ClDialect::Generic),
    ("catia-01", include_str!("data/catia-01.aptsource"), ClDialect::Catia),
    ("catia-02", include_str!("data/catia-02.aptsource"), ClDialect::Catia),
    ("catia-03", include_str!("data/catia-03.aptsource"), ClDialect::Catia),
    ("creo-01", include_str!("data/creo-01.ncl.1"), ClDialect::Creo),
    ("creo-02", include_str!("data/creo-02.ncl.1"), ClDialect::Creo),
    ("creo-03", include_str!("data/creo-03.ncl.1"), ClDialect::Creo),
    ("hsm-01", include_str!("data/hsm-01.apt"), ClDialect::Hsm),
    ("hsm-02", include_str!("data/hsm-02.apt"), ClDialect::Hsm),
    ("ncl-01", include_str!("data/ncl-01.as"), ClDialect::Ncl),
    ("ncl-02", include_str!("data/ncl-02.as"), ClDialect::Ncl),
    ("nx-01", include_str!("data/nx-01.cls"), ClDialect::Nx),
    ("nx-02", include_str!("data/nx-02.cls"), ClDialect::Nx),
    ("nx-03", include_str!("data/nx-03.cls"), ClDialect::Nx),
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

/// A small file with one of everything.
const SMALL: &str = "PARTNO SMALL PART
$$ roughing
MACHIN/MILL5,3
UNITS/MM
INTOL/0.01
CUTTER/10,2,3,2,0,0,40
LOADTL/4,LENGTH,85.5,ADJUST,14
SPINDL/1200,RPM,CLW
COOLNT/FLOOD
PPRINT WATCH THE CLAMPS
FROM/0,0,100
RAPID
GOTO/20,0,5
FEDRAT/150.5,MMPM
GOTO/20,0,-2.25
CIRCLE/0,0,-2.25,0,0,1,20
GOTO/0,20,-2.25 $$ a quarter
GOTO/-5,30,-2.25
CYCLE/DRILL,FEDTO,10,MMPM,80,RAPTO,2
GOTO/1,2,0
CYCLE/OFF
MULTAX/ON
GOTO/1,2,3.3333333333333335,0,0.6,0.8
MULTAX/OFF
GOTO/1,2,50
FINI
";

fn small(to: ClDialect) -> String {
    let made = text(&read(SMALL), ClDialect::Generic, to);
    // Of the eighteen positions that the reader puts on the arc the first and the last but one are enough here.
    let mut lines: Vec<&str> = made.lines().collect();
    let near_ends = |line: &&str| line.contains("19.9238939618349");
    if let Some(first) = lines.iter().position(near_ends) {
        let last = lines.iter().rposition(near_ends).unwrap();
        lines.splice(first + 1..last, ["..."]);
    }
    lines.join("\n") + "\n"
}

#[test]
fn small_file_as_apt_text() {
    expect_test::expect![[r#"
        PARTNO SMALL PART
        $$ roughing
        MACHIN/MILL5,3.0
        UNITS/MM
        INTOL/0.01
        CUTTER/10.0,2.0,3.0,2.0,0.0,0.0,40.0
        LOADTL/4.0,LENGTH,85.5,ADJUST,14.0
        SPINDL/1200.0,RPM,CLW
        COOLNT/FLOOD
        PPRINT WATCH THE CLAMPS
        FROM/0.0,0.0,100.0
        RAPID
        GOTO/20.0,0.0,5.0
        FEDRAT/150.5,MMPM
        GOTO/20.0,0.0,-2.25
        CIRCLE/0.0,0.0,-2.25,0.0,0.0,1.0,20.0
        GOTO/19.92389396183491,1.7431148549531632,-2.25
        ...
        GOTO/1.7431148549531672,19.92389396183491,-2.25
        GOTO/0.0,20.0,-2.25
        $$ a quarter
        GOTO/-5.0,30.0,-2.25
        CYCLE/DRILL,FEDTO,10.0,MMPM,80.0,RAPTO,2.0
        GOTO/1.0,2.0,0.0
        CYCLE/OFF
        MULTAX/ON
        GOTO/1.0,2.0,3.3333333333333335,0.0,0.6,0.8
        MULTAX/OFF
        GOTO/1.0,2.0,50.0
        FINI
    "#]]
    .assert_eq(&small(ClDialect::Generic));
}

#[test]
fn small_file_as_catia() {
    expect_test::expect![[r#"
        $$     CATIA APT VERSION 1.0
        PARTNO SMALL PART
        $$ roughing
        MACHIN/MILL5,3
        UNITS/MM
        INTOL/  0.010000
        CUTTER/ 10.000000,  2.000000,  3.000000,  2.000000,  0.000000,  0.000000,$
            40.000000
        LOADTL/4,LENGTH,   85.5000,ADJUST,14
        SPINDL/ 1200.0000,RPM,CLW
        COOLNT/FLOOD
        PPRINT WATCH THE CLAMPS
        FROM/    0.00000,    0.00000,  100.00000
        RAPID
        GOTO  /   20.00000,    0.00000,    5.00000
        FEDRAT/  150.5000,MMPM
        GOTO  /   20.00000,    0.00000,   -2.25000
        AUTOPS
        INDIRV/  0.00000,  1.00000,  0.00000
        TLON,GOFWD/ (CIRCLE/    0.00000,    0.00000,   -2.25000,$
           20.00000),ON,(LINE/    0.00000,    0.00000,   -2.25000,$
            0.00000,   20.00000,   -2.25000)
        $$ a quarter
        GOTO  /   -5.00000,   30.00000,   -2.25000
        CYCLE/DRILL,   10.0000,   80.0000,MMPM,    2.0000
        GOTO  /    1.00000,    2.00000,    0.00000
        CYCLE/OFF
        MULTAX
        GOTO  /    1.00000,    2.00000,3.3333333333333335, 0.000000, 0.600000, 0.800000
        MULTAX/OFF
        GOTO  /    1.00000,    2.00000,   50.00000
        FINI
    "#]]
    .assert_eq(&small(ClDialect::Catia));
}

#[test]
fn small_file_as_creo() {
    expect_test::expect![[r#"
        $$*         Pro/CLfile  Version
        PARTNO / SMALL PART
        $$ roughing
        MACHIN / MILL5, 3
        UNITS / MM
        INTOL / 0.010000
        $$-> CUTTER / 10.000000, 2.000000, 3.000000, 2.000000, 0.000000,  $
                0.000000, 40.000000
        LOADTL / 4, LENGTH, 85.500000, OSETNO, 14
        SPINDL / RPM, 1200.000000, CLW
        COOLNT / FLOOD
        PPRINT / WATCH THE CLAMPS
        FROM / 0.0000000000, 0.0000000000, 100.0000000000
        RAPID
        GOTO / 20.0000000000, 0.0000000000, 5.0000000000
        FEDRAT / 150.500000, MMPM
        GOTO / 20.0000000000, 0.0000000000, -2.2500000000
        CIRCLE / 0.0000000000, 0.0000000000, -2.2500000000, 0.0000000000,  $
                0.0000000000, 1.0000000000, 20.0000000000
        GOTO / 19.92389396183491, 1.7431148549531632, -2.2500000000
        ...
        1.7431148549531672, 19.92389396183491, -2.2500000000
        0.0000000000, 20.0000000000, -2.2500000000
        $$ a quarter
        GOTO / -5.0000000000, 30.0000000000, -2.2500000000
        CYCLE / DRILL, DEPTH, 10.000000, MMPM, 80.000000, CLEAR, 2.000000
        GOTO / 1.0000000000, 2.0000000000, 0.0000000000
        CYCLE / OFF
        MULTAX / ON
        GOTO / 1.0000000000, 2.0000000000, 3.3333333333333335,  $
                0.0000000000, 0.6000000000, 0.8000000000
        MULTAX / OFF
        GOTO / 1.0000000000, 2.0000000000, 50.0000000000
        FINI
    "#]]
    .assert_eq(&small(ClDialect::Creo));
}

#[test]
fn small_file_as_hsm() {
    expect_test::expect![[r#"
        PARTNO/'SMALL PART'
        $$ roughing
        MACHIN/MILL5, 3
        UNITS/MM
        INTOL/0.010000
        CUTTER/10.000000, 2.000000, 3.000000, 2.000000, 0.000000, 0.000000, 40.000000
        LOADTL/4, 0, 85.500000, 14
        SPINDL/1200.000000, RPM, CLW
        COOLNT/FLOOD
        PPRINT/'WATCH THE CLAMPS'
        FROM/0.000000, 0.000000, 100.000000
        RAPID
        GOTO/20.000000, 0.000000, 5.000000
        FEDRAT/150.500000, MMPM
        GOTO/20.000000, 0.000000, -2.250000
        MOVARC/0.000000, 0.000000, -2.250000, 0.000000000, 0.000000000, 1.000000000, 20.000000, ANGLE, 90.000000
        GOTO/0.000000, 20.000000, -2.250000
        $$ a quarter
        GOTO/-5.000000, 30.000000, -2.250000
        CYCLE/DRILL, 10.000000, MMPM, 80.000000, 2.000000
        GOTO/1.000000, 2.000000, 0.000000
        CYCLE/OFF
        MULTAX/ON
        GOTO/1.000000, 2.000000, 3.3333333333333335, 0.000000000, 0.600000000, 0.800000000
        MULTAX/OFF
        GOTO/1.000000, 2.000000, 50.000000
        FINI
    "#]].assert_eq(&small(ClDialect::Hsm));
}

#[test]
fn small_file_as_ncl() {
    expect_test::expect![[r#"
        N1    , PARTNO SMALL PART
        $$ roughing
        N3    , MACHIN/ MILL5, 3.
        N4    , UNITS/ MM
        N5    , INTOL/ 0.01
        N6    , CUTTER/ 10., 2., 3., 2., 0., 0., 40.
        N7    , LOADTL/ 4., LENGTH, 85.5, OFFSET, 14.
        N8    , SPINDL/ RPM, 1200., CLW
        N9    , COOLNT/ FLOOD
        N10   , PPRINT WATCH THE CLAMPS
        N11   , FROM/    0.        ,    0.        ,  100.
        N12   , RAPID
        N13   , GOTO/   20.        ,    0.        ,    5.
        N14   , FEDRAT/ MMPM, 150.5
        N15   , GOTO/   20.        ,    0.        ,   -2.25
        N16   , CIRCLE/ 0., 0., -2.25, 0., 0., 1., 20.
        N16   , GOTO/ 19.92389396183491, 1.7431148549531632,   -2.25
        ...
                GOTO/ 1.7431148549531672, 19.92389396183491,   -2.25
                GOTO/    0.        ,   20.        ,   -2.25
        $$ a quarter
        N18   , GOTO/   -5.        ,   30.        ,   -2.25
        N19   , CYCLE/ DRILL, FEDTO, 10., MMPM, 80., RAPTO, 2.
        N20   , GOTO/    1.        ,    2.        ,    0.
        N21   , CYCLE/ OFF
        N22   , MULTAX/ ON
        N23   , GOTO/    1.        ,    2.        , 3.3333333333333335, $
                   0.        ,    0.6       ,    0.8
        N24   , MULTAX/ OFF
        N25   , GOTO/    1.        ,    2.        ,   50.
        N26   , FINI
    "#]]
    .assert_eq(&small(ClDialect::Ncl));
}

#[test]
fn small_file_as_nx() {
    expect_test::expect![[r#"
        TOOL PATH/SMALL_PART,TOOL,NONE
        PARTNO SMALL PART
        $$ roughing
        MACHIN/MILL5,3
        UNITS/MM
        INTOL/0.0100
        TLDATA/MILL,10.0000,2.0000,40.0000,0.0000,0.0000
        LOAD/TOOL,4,ADJUST,14
        $$ |LOADTL/LENGTH,85.5
        SPINDL/RPM,1200.0000,CLW
        COOLNT/FLOOD
        PPRINT/WATCH THE CLAMPS
        FROM/0.0000,0.0000,100.0000
        RAPID
        GOTO/20.0000,0.0000,5.0000
        FEDRAT/MMPM,150.5000
        GOTO/20.0000,0.0000,-2.2500
        CIRCLE/0.0000,0.0000,-2.2500,0.0000000,0.0000000,1.0000000,20.0000
        GOTO/0.0000,20.0000,-2.2500
        $$ a quarter
        GOTO/-5.0000,30.0000,-2.2500
        CYCLE/DRILL,RAPTO,2.0000,FEDTO,-10.0000,MMPM,80.0000
        GOTO/1.0000,2.0000,0.0000
        CYCLE/OFF
        MULTAX/ON
        GOTO/1.0000,2.0000,3.3333333333333335,0.0000000,0.6000000,0.8000000
        MULTAX/OFF
        GOTO/1.0000,2.0000,50.0000
        END-OF-PATH
    "#]]
    .assert_eq(&small(ClDialect::Nx));
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
