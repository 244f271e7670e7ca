//! Sections 1 to 3 in order: transfers, output off and on, what is passed over after an error, cancellation, the memo
//! over edits.

#![expect(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use std::{
    cell::Cell,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
};

use apt_cldata::record::{ClKind, Units};
use apt_run::{
    Cancelled,
    document::{Document, Level},
    pipeline::{RunFindingKind, RunResult},
    settings::{Settings, SeveritySetting},
};

fn document_in(text: &str, dialect: &str) -> Document {
    let settings = Settings { dialect: Some(dialect.to_owned()), ..Settings::default() };
    Document::new(text, Some("sample.apt".to_owned()), &Arc::new(settings))
}

fn document(text: &str) -> Document {
    document_in(text, "free")
}

fn run(document: &Document) -> Arc<RunResult> {
    document.run(&|| false, &mut |_, _| {}).unwrap()
}

/// The last point of every motion record, rounded, with the statement number.
fn ends(result: &RunResult) -> Vec<(u32, [f64; 3])> {
    let round = |value: f64| (value * 1e6).round() / 1e6 + 0.0;
    let end = |record: &apt_cldata::record::ClRecord| match &record.kind {
        ClKind::Motion { points, .. } => {
            points.last().map(|point| (record.isn, point.position.map(round).into()))
        }
        _ => None,
    };
    result.records.iter().filter_map(end).collect()
}

fn codes(document: &Document) -> Vec<(&'static str, u32)> {
    let list = document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).unwrap();
    list.iter().map(|found| (found.wording.code, found.origin.isn)).collect()
}

#[test]
fn ptonly_leaves_the_motions_uncomputed() {
    let text =
        "CUTTER/.5\nL=LINE/XAXIS\nFROM/0,3,0\nGO/TO,L\nGOTO/1,1,1\nTLLFT,GOLFT/L,PAST,(LINE/5,0,5,1)\nFINI\n";
    let whole = run(&document(text));
    assert!(!whole.records.is_empty() && !whole.motions.is_empty());
    for program in [format!("PTONLY/1\n{text}"), text.replace("GOTO/1", "PTONLY/1\nGOTO/1")] {
        let document = document(&program);
        let result = run(&document);
        assert!(result.records.is_empty() && result.motions.is_empty() && result.findings.is_empty());
        assert!(codes(&document).iter().any(|(code, _)| *code == "APT0911"), "{:?}", codes(&document));
    }
    let again = document(&format!("PTONLY/2\n{text}"));
    assert_eq!(run(&again).motions.len(), whole.motions.len());
    assert!(codes(&again).contains(&("APT0912", 1)));
}

const TWO_CHECKS: &str = "\
CUTTER/.5
L1=LINE/XAXIS
L2=LINE/5,0,5,5
L3=LINE/8,0,8,5
FROM/FFF,2,0
GO/TO,L1
TLLFT,GOLFT/L1,ON,L2,A1,ON,L3,A2
GOTO/1,9,0
A2)GOTO/2,9,0
A1)GOTO/3,9,0
FINI
";

#[test]
fn the_check_surface_that_is_met_says_where_the_path_goes_on() {
    let near = run(&document(&TWO_CHECKS.replace("FFF", "0")));
    let after: Vec<_> = ends(&near).into_iter().filter(|(isn, _)| *isn >= 7).collect();
    assert_eq!(after, [(7, [5.0, 0.25, 0.0]), (10, [3.0, 9.0, 0.0])], "L2 is met first");
    let far = run(&document(&TWO_CHECKS.replace("FFF", "6")));
    let after: Vec<_> = ends(&far).into_iter().filter(|(isn, _)| *isn >= 7).collect();
    assert_eq!(
        after,
        [(7, [8.0, 0.25, 0.0]), (9, [2.0, 9.0, 0.0]), (10, [3.0, 9.0, 0.0])],
        "past L2, L3 is met"
    );
}

#[test]
fn a_transfer_that_finds_no_label_is_told_at_its_statement() {
    let result = run(&document("FROM/0,0,0\nL1)GOTO/1,0,0\nTRANTO/L1\nGOTO/2,0,0\nFINI\n"));
    assert_eq!(ends(&result), [(1, [0.0, 0.0, 0.0]), (2, [1.0, 0.0, 0.0])]);
    let [finding] = result.findings.as_slice() else { panic!("{:?}", result.findings) };
    assert_eq!(finding.kind, RunFindingKind::TransferPending { label: "L1".to_owned() });
    assert_eq!(finding.origin.isn, 3);
    assert!(
        matches!(result.records.last().map(|record| &record.kind), Some(ClKind::End)),
        "the tape still ends"
    );
}

#[test]
fn dntcut_keeps_positions_from_the_path_and_cut_gives_the_last_one() {
    let result = run(&document("FROM/0,0,0\nDNTCUT\nGOTO/1,0,0\nGOTO/2,0,0\nCUT\nGOTO/3,0,0\nFINI\n"));
    assert_eq!(ends(&result), [(1, [0.0, 0.0, 0.0]), (5, [2.0, 0.0, 0.0]), (6, [3.0, 0.0, 0.0])]);
    let never = run(&document("FROM/0,0,0\nCUT\nGOTO/3,0,0\nFINI\n"));
    assert_eq!(ends(&never).len(), 2, "CUT without DNTCUT adds nothing");
}

#[test]
fn after_an_error_motions_are_passed_over_up_to_a_from() {
    let text = "\
CUTTER/.5
L1=LINE/XAXIS
L2=LINE/5,0,5,5
L3=LINE/0,5,5,5
FROM/0,2,0
GO/TO,L1
TLLFT,GOLFT/L1,TANTO,L2
TLLFT,GOLFT/L2,ON,L3
TLLFT,GOLFT/L3,ON,L1
FROM/1,1,0
GOTO/2,2,0
FINI
";
    let document = document(text);
    // The lint needs no motion: ON L3, and then TLLFT of it.
    assert_eq!(codes(&document), [("APT0644", 7), ("APT0690", 8), ("APT0959", 9)]);
    let result = run(&document);
    let skipped = result.findings.iter().find_map(|finding| match finding.kind {
        RunFindingKind::Skipped { statements, last } => Some((statements, last)),
        _ => None,
    });
    assert_eq!(skipped, Some((2, 9)));
    let after: Vec<u32> = ends(&result).into_iter().map(|(isn, _)| isn).collect();
    assert_eq!(after, [5, 6, 10, 11]);
}

#[test]
fn a_negative_tolerance_is_told_once() {
    assert_eq!(codes(&document("OUTTOL/-.1\nGOTO/1,0,0\nFINI\n")), [("APT0323", 1)]);
}

#[test]
fn units_of_a_cl_file_become_a_unit_record() {
    for (word, unit) in [("MM", Units::Millimeters), ("INCHES", Units::Inches)] {
        let result = run(&document_in(&format!("UNITS/{word}\nGOTO/1,2,3\nFINI\n"), "cl"));
        assert_eq!(result.records[0].kind, ClKind::Units(unit));
    }
}

#[test]
fn copies_and_transformations_are_in_the_final_path() {
    let text = "M1=MATRIX/TRANSL,10,0,0\nTRACUT/M1\nINDEX/1\nGOTO/1,0,0\nCOPY/1,TRANSL,0,5,0,2\nTRACUT/NOMORE\nGOTO/0,0,0\nFINI\n";
    let points: Vec<_> = ends(&run(&document(text))).into_iter().map(|(_, point)| point).collect();
    assert_eq!(points, [[11.0, 0.0, 0.0], [11.0, 5.0, 0.0], [11.0, 10.0, 0.0], [0.0, 0.0, 0.0]]);
}

#[test]
fn a_fraction_of_a_copy_is_one_copy() {
    for (count, copies) in [("0", 0), (".5", 1), ("1.9", 1), ("2", 2)] {
        let text = format!("INDEX/1\nGOTO/1,0,0\nCOPY/1,TRANSL,1,0,0,{count}\nFINI\n");
        assert_eq!(ends(&run(&document(&text))).len(), 1 + copies, "COPY with {count}");
    }
}

#[test]
fn numbers_of_index_are_used_once_and_their_table_ends_in_apt3() {
    let again = "INDEX/1\nGOTO/1,0,0\nCOPY/1,SAME,1\nINDEX/1\nGOTO/2,0,0\nCOPY/1,SAME,1\nFINI\n";
    assert_eq!(codes(&document(again)), [("APT0714", 4)]);
    let many = |count: u32| (1..=count).map(|n| format!("INDEX/{n}\n")).collect::<String>() + "FINI\n";
    assert_eq!(codes(&document_in(&many(79), "apt3")), []);
    assert_eq!(codes(&document_in(&many(80), "apt3")), [("APT0715", 80)]);
    assert_eq!(codes(&document_in(&many(80), "free")), []);
}

#[test]
fn surfaces_of_single_installations_are_no_surfaces_of_a_motion() {
    let program = |motion: &str| {
        format!(
            "S1=LOFT/CANON,1,2,3,4,5,6,7,8\nS2=MESH/CANON,1,2,3\nS3=ELMSRF/CANON,1\nP1=PLANE/0,0,1,0\nL1=LINE/XAXIS\nCUTTER/1\nFROM/0,-5,0\n{motion}\nFINI\n"
        )
    };
    let said = |motion: &str| {
        let document = document_in(&program(motion), "apt3");
        let list = document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).unwrap();
        // Not every motion has a use for every definition.
        let told = list.iter().filter(|one| one.wording.code != "APT0110");
        told.map(|one| (one.wording.code, one.wording.message.clone())).collect::<Vec<_>>()
    };
    assert_eq!(said("GO/TO,S1"), [("APT0608", "a LOFT cannot be a drive surface".to_owned())]);
    assert_eq!(said("GO/TO,L1,TO,S1"), [("APT0608", "a LOFT cannot be a part surface".to_owned())]);
    assert_eq!(said("GO/TO,S2"), [("APT0608", "a MESH cannot be a drive surface".to_owned())]);
    assert_eq!(said("GO/TO,S3"), [("APT0608", "an ELMSRF cannot be a drive surface".to_owned())]);
    assert_eq!(said("GO/TO,L1,TO,P1"), []);
}

#[test]
fn a_corner_of_leaning_walls_is_cleaned_out() {
    let text = "MULTAX\nFROM/0,0,0\nVTLAXS/ON,LEFT,0,2,0,RIGHT\nGOTO/8,0,0\nWCORN/LEFT,0,RIGHT,45,2\nGOTO/8,-8,0\n\
                VTLAXS/OFF,RIGHT,45\nFINI\n";
    let document = document(text);
    assert_eq!(codes(&document), []);
    let result = run(&document);
    let of = |record: &apt_cldata::record::ClRecord| match &record.kind {
        ClKind::Motion { points, .. } if record.isn == 4 => {
            points.iter().map(|point| point.position).collect()
        }
        _ => Vec::new(),
    };
    let in_corner: Vec<_> = result.records.iter().flat_map(of).collect();
    assert_eq!(in_corner.len(), 7);
    assert!((in_corner[0][0] - 5.85).abs() < 1e-12, "{in_corner:?}");
}

#[test]
fn cancelled_work_leaves_nothing_and_can_be_started_again() {
    let document = document(&TWO_CHECKS.replace("FFF", "0"));
    assert_eq!(document.program(&|| true).unwrap_err(), Cancelled);
    document.program(&|| false).unwrap();
    assert_eq!(document.run(&|| true, &mut |_, _| {}).unwrap_err(), Cancelled);
    let polls = AtomicUsize::new(0);
    let late = || polls.fetch_add(1, Ordering::Relaxed) >= 4;
    assert_eq!(document.run(&late, &mut |_, _| {}).unwrap_err(), Cancelled, "in the middle of a motion");
    assert_eq!(ends(&run(&document)).last(), Some(&(10, [3.0, 9.0, 0.0])));
}

#[test]
fn progress_rises_and_stays_below_the_number_of_records() {
    let text = format!("FROM/0,0,0\n{}FINI\n", "GOTO/1,0,0\nGOTO/2,0,0\n".repeat(200));
    let document = document(&text);
    let last = Cell::new(None);
    let mut calls = 0;
    document
        .run(&|| false, &mut |done, total| {
            assert!(last.get().is_none_or(|before| before < done) && done < total, "{done} of {total}");
            last.set(Some(done));
            calls += 1;
        })
        .unwrap();
    assert!(calls > 3, "{calls} calls");
}

#[test]
fn an_edit_computes_only_the_motions_whose_inputs_changed() {
    let text = "\
CUTTER/.5
L1=LINE/XAXIS
L2=LINE/5,0,5,5
L3=LINE/0,5,5,5
FROM/0,2,0
GO/TO,L1
TLLFT,GOLFT/L1,PAST,L2
TLLFT,GOLFT/L2,PAST,L3
FINI
";
    let first = document(text);
    run(&first);
    assert_eq!((first.memo().counters().computed, first.memo().counters().reused), (3, 0));
    let at = text.find("L3=LINE/0,5,5,5").unwrap() + "L3=LINE/0,".len();
    let second = first.edit(at..at + 1, "6");
    run(&second);
    assert_eq!(
        (first.memo().counters().computed, first.memo().counters().reused),
        (4, 2),
        "only the last motion"
    );
    let scratch = run(&document(&second.tree().text()));
    assert_eq!(ends(&run(&second)), ends(&scratch), "as computed from scratch");
    let third = second.edit(0..0, "$$ A REMARK\n");
    run(&third);
    assert_eq!((first.memo().counters().computed, first.memo().counters().reused), (4, 5), "nothing is new");
}

#[test]
fn settings_change_and_silence_findings() {
    let text = "GOTO/1,2,3\n";
    let with = |setting| {
        let mut settings = Settings { dialect: Some("free".to_owned()), ..Settings::default() };
        settings.severity.insert("APT0901".to_owned(), setting);
        let document = Document::new(text, None, &Arc::new(settings));
        document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap()
    };
    assert!(with(SeveritySetting::Off).is_empty());
    let list = with(SeveritySetting::Error);
    assert_eq!(list.len(), 1);
    assert_eq!(list[0].severity, apt_run::diagnostic::Severity::Error);
}

#[test]
fn a_motion_that_section_1_gave_up_brings_no_findings_with_it() {
    let text = "CUTTER/.5\nL1=LINE/0,0,5,0\nL2=LINE/5,0,5,5\nFROM/-2,-2,1\nGO/TO,LX\nTLRGT,GORGT/L1,PAST,L2\n\
                GOLFT/L2,PAST,L1\nFROM/-2,-2,1\nGO/TO,L1\nTLRGT,GORGT/L1,PAST,L2\nFINI\n";
    let document = document(text);
    assert_eq!(codes(&document), [("APT0101", 5), ("APT0690", 6)]);
    let ends = ends(&run(&document));
    assert_eq!(
        ends.iter().map(|(isn, _)| *isn).collect::<Vec<_>>(),
        [4, 8, 9, 10],
        "motion goes on at the FROM"
    );
}

/// Records of a path between two questions whether to go on; copying and telling one takes less than a microsecond each.
const RECORDS_BETWEEN_QUESTIONS: usize = 3_000;

#[test]
fn copies_and_their_report_are_cancelled_soon() {
    let records = 20_000;
    let text = format!("FROM/0,0,0\nINDEX/1\nGOTO/1,0,0\nCOPY/1,TRANSL,0,1,0,{records}\nFINI\n");
    let document = document(&text);
    document.program(&|| false).unwrap();
    let polls = AtomicUsize::new(0);
    let count = || {
        polls.fetch_add(1, Ordering::Relaxed);
        false
    };
    document.run(&count, &mut |_, _| {}).unwrap();
    assert!(polls.swap(0, Ordering::Relaxed) * RECORDS_BETWEEN_QUESTIONS >= records, "of the run");
    document.report(&count, &mut |_, _| {}, None).unwrap();
    let all = polls.swap(0, Ordering::Relaxed);
    assert!(all * RECORDS_BETWEEN_QUESTIONS >= records, "{all} of the report");
    let late = || polls.fetch_add(1, Ordering::Relaxed) + 1 >= all / 2;
    assert_eq!(document.report(&late, &mut |_, _| {}, None).err(), Some(Cancelled));
    assert_eq!(polls.load(Ordering::Relaxed), all / 2, "asked again after the answer");
}
