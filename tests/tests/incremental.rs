//! Work costs what it touches: counters after edits, and random edits against fresh runs.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use apt_ide::Analysis;
use apt_syntax::{StatementChange, TextRange, TextSize};
use apt_tests::{
    repository,
    runs::{analysis, bounded, examples, read, report},
};
use proptest::prelude::*;

/// The syntax tree keeps statements in blocks of this many; an edit looks through the blocks it touches.
const BLOCK: usize = 256;

/// Evaluation keeps a checkpoint at least this often, statements.
const CHECKPOINT: u64 = 128;

fn place(text: &str, needle: &str) -> usize {
    text.find(needle).unwrap_or_else(|| panic!("{needle} is not in the program"))
}

/// Replaces the first occurrence of a part of the text.
fn replace(analysis: &Analysis, old: &str, new: &str) -> Analysis {
    let start = place(&analysis.text(), old);
    analysis.edit(start..start + old.len(), new)
}

fn change(analysis: &Analysis, at: usize, insert: &str) -> StatementChange {
    let at = TextSize::new(u32::try_from(at).unwrap());
    analysis.document().tree().edit(TextRange::empty(at), insert).1
}

fn run(analysis: &Analysis) {
    bounded(|cancel| analysis.document().run(cancel, &mut |_, _| {})).unwrap();
}

/// Motions computed and motions taken from the memo by one run.
fn counted(analysis: &Analysis) -> (u64, u64) {
    let before = analysis.document().memo().counters();
    run(analysis);
    let after = analysis.document().memo().counters();
    (after.computed - before.computed, after.reused - before.reused)
}

fn straight_program(statements: usize) -> String {
    let lines = (0..statements).map(|number| format!("GOTO/{number},{},1\n", number % 7));
    format!("PARTNO LONG\nFROM/0,0,1\n{}FINI\n", lines.collect::<String>())
}

#[test]
fn only_touched_statements_are_parsed_again() {
    let text = straight_program(20_000);
    let analysis = analysis(&text, "free");
    let count = analysis.document().tree().statement_count();
    for index in [0, 1, 2, 777, 10_000, count - 2] {
        let start = usize::from(analysis.document().tree().statement(index).start);
        let inside = change(&analysis, start + 4, "7");
        assert_eq!((inside.first, inside.removed, inside.inserted), (index, 1, 1), "{index}");
        assert!(inside.scanned <= 2 * BLOCK, "{index}: {inside:?}");
        let before = change(&analysis, start, "X=1\n");
        assert!(before.first <= index && before.removed <= 2 && before.inserted <= 3, "{index}: {before:?}");
        assert!(before.scanned <= 2 * BLOCK, "{index}: {before:?}");
    }
}

#[test]
fn evaluation_restarts_at_the_changed_statement_and_stops_where_nothing_differs() {
    for dialect in ["free", "apt3", "apt4", "cl"] {
        restarts_at_the_changed_statement(dialect);
    }
}

fn restarts_at_the_changed_statement(dialect: &str) {
    let text = straight_program(20_000);
    let first = analysis(&text, dialect);
    let program = first.document().program(&|| false).unwrap();
    let statements = first.document().tree().statement_count() as u64;
    assert_eq!(program.statistics().reused_statements, 0);
    assert!(program.statistics().evaluated_statements + 1 >= statements);
    for needle in ["GOTO/5,", "GOTO/9999,", "GOTO/19990,"] {
        let edited = replace(&first, needle, "GOTO/3,");
        let statistics = edited.document().program(&|| false).unwrap().statistics();
        assert!(statistics.evaluated_statements <= 2 * CHECKPOINT, "{dialect}, {needle}: {statistics:?}");
        assert!(
            statistics.reused_statements + 2 * CHECKPOINT >= statements,
            "{dialect}, {needle}: {statistics:?}"
        );
    }
}

#[test]
fn a_change_that_everything_depends_on_is_carried_to_the_end() {
    let lines = (0..2_000).map(|number| format!("GOTO/A,{number},0\n"));
    let text = format!("PARTNO LONG\nA=1\n{}FINI\n", lines.collect::<String>());
    let first = analysis(&text, "free");
    run(&first);
    let edited = replace(&first, "A=1", "A=2");
    let statistics = edited.document().program(&|| false).unwrap().statistics();
    assert!(statistics.evaluated_statements >= 2_000, "{statistics:?}");
    let last = report(&edited).unwrap();
    assert_eq!(apt_tests::runs::path_of(&last).last().unwrap().at, [2.0, 1999.0, 0.0]);
}

#[test]
fn an_included_file_is_read_again_and_costs_nothing_where_there_is_none() {
    let folder =
        std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("include-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let write = |text: &str| std::fs::write(folder.join("shape.apt"), text).unwrap();
    let file = folder.join("main.apt").to_string_lossy().into_owned();
    write("A=1\n");
    let settings = apt_tests::runs::settings("free");
    let first = Analysis::new("PARTNO\nINCLUD/SHAPE\nGOTO/A,0,0\nGOTO/0,0,0\nFINI\n", Some(file), &settings);
    let at = |analysis: &Analysis| apt_tests::runs::path_of(&report(analysis).unwrap())[0].at[0];
    assert_eq!(at(&first), 1.0);
    write("A=2\n");
    let edited = replace(&first, "GOTO/0,0,0", "GOTO/0,0,1");
    assert_eq!(at(&edited), 2.0, "the file has changed before the edit");
    std::fs::remove_dir_all(&folder).unwrap();
}

const CONTOUR: &str = "PARTNO CONTOUR\nCUTTER/.5\nINTOL/.001\nOUTTOL/.001\n$$ geometry\nL1=LINE/0,0,5,0\n\
                       C1=CIRCLE/5,2,2\nL2=LINE/5,4,0,4\nL3=LINE/0,4,0,0\nPS=PLANE/0,0,1,0\nFROM/-2,-2,1\n\
                       GO/TO,L1,TO,PS,TO,L3\nTLRGT,GORGT/L1,TANTO,C1\nGOFWD/C1,TANTO,L2\nGOFWD/L2,PAST,L3\n\
                       GOLFT/L3,PAST,L1\nGODLTA/0,0,1\nGOTO/9,9,9\nFINI\n";

#[test]
fn motions_with_unchanged_inputs_are_not_computed_again() {
    let first = analysis(CONTOUR, "free");
    let (computed, reused) = counted(&first);
    assert_eq!((computed, reused), (5, 0), "{}", report(&first).unwrap()["diagnostics"]);

    // A remark, and another statement before everything: all statement numbers move, no motion does.
    let remark = replace(&first, "$$ geometry", "$$ the geometry");
    assert_eq!(counted(&remark), (0, 5));
    let moved = replace(&remark, "L1=LINE", "UNUSED=POINT/1,1\nL1=LINE");
    assert_eq!(counted(&moved), (0, 5));
    let isns = |analysis: &Analysis| -> Vec<u64> {
        let report = report(analysis).unwrap();
        report["motions"].as_array().unwrap().iter().map(|motion| motion["isn"].as_u64().unwrap()).collect()
    };
    assert_eq!(isns(&moved), isns(&remark).iter().map(|isn| isn + 1).collect::<Vec<_>>());

    // What comes after all motions.
    let after = replace(&moved, "GOTO/9,9,9", "GOTO/9,9,8");
    assert_eq!(counted(&after), (0, 5));

    // A surface of the last motion but two: it and those that start where it ends.
    let surface = replace(&after, "L2=LINE/5,4,0,4", "L2=LINE/5,4,0,4.0");
    assert_eq!(counted(&surface), (0, 5), "the same surface, written otherwise");
    let last = replace(&surface, "GOLFT/L3,PAST,L1", "GOLFT/L3,ON,L1");
    assert_eq!(counted(&last), (1, 4));

    // What all motions depend on, and back: the memo still knows them.
    let cutter = replace(&last, "CUTTER/.5", "CUTTER/.25");
    assert_eq!(counted(&cutter), (5, 0));
    assert_eq!(counted(&replace(&cutter, "CUTTER/.25", "CUTTER/.5")), (0, 5));
}

#[test]
fn a_motion_that_occurs_twice_is_computed_once() {
    let example = read(&repository("examples/bearing-cover.apt"));
    let first = analysis(&example, "free");
    let (computed, _) = counted(&first);
    assert!(computed > 0);
    assert_eq!(counted(&analysis(&example, "free")).0, computed, "two documents share nothing");
    let hole = replace(&first, "DEP=.6", "DEP=.7");
    assert_eq!(counted(&hole).0, 0, "holes are drilled point to point");
    let pass = replace(&hole, "FEED=20", "FEED=25");
    assert_eq!(counted(&pass).0, 0, "the feed is no input of a motion");
}

/// What may be typed, pasted or deleted.
fn snippets() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(String::new()),
        prop::sample::select(vec![
            "\n",
            "$\n",
            "$$",
            ",",
            "/",
            "(",
            ")",
            "=",
            "1",
            ".5",
            "-",
            "7E3",
            " ",
            "é",
            "\r\n",
            "A=1\n",
            "TO,",
            "PAST,",
            "\nGOLFT/L1,PAST,L2\n",
            "\nGOTO/1,2,3\n",
            "\nFROM/0,0,0\n",
            "\nFINI\n",
            "\nLOOPST\n",
            "\nLOOPND\n",
            "\nP1=POINT/1,2,3\n",
            "\nC1=CIRCLE/0,0,2\n",
            "\nM=MACRO/X\n",
            "\nTERMAC\n",
            "\nCALL/M,X=1\n",
            "\nINTOL/.01\n",
            "\nCUTTER/1\n",
            "\nREFSYS/NOMORE\n",
            "\nJUMPTO/A1\n",
            "A1) ",
            "\nTRACUT/NOMORE\n",
        ])
        .prop_map(str::to_owned),
        "[A-Z0-9/,.=()$ \n-]{0,12}",
    ]
}

fn base_programs() -> Vec<(&'static str, String)> {
    let oracle = |path: &str| read(&repository("tests/oracle").join(path));
    let mut programs = vec![
        ("free", CONTOUR.to_owned()),
        ("free", oracle("motion2d/circle-full-outside.apt")),
        ("free", oracle("motion3d/sphere-ps-flat.apt")),
        ("free", oracle("motion3d/thick-planes.apt")),
    ];
    for group in ["language", "apt4-language", "motion2d"] {
        let paths = apt_tests::oracle::programs(group);
        programs.extend(
            paths.iter().step_by(5).map(|path| (apt_tests::oracle::dialect_of(group).as_str(), read(path))),
        );
    }
    programs.extend(examples().iter().map(|path| ("free", read(path))));
    programs
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn after_any_edits_the_report_is_that_of_a_fresh_run(
        base in prop::sample::select(base_programs()),
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..20, snippets(), any::<bool>()), 1..8),
    ) {
        let (dialect, text) = base;
        let mut edited = analysis(&text, dialect);
        run(&edited);
        for (index, length, insert, runs) in edits {
            let text = edited.text();
            let start = text.floor_char_boundary(index.index(text.len() + 1));
            let end = text.floor_char_boundary((start + length).min(text.len())).max(start);
            edited = edited.edit(start..end, &insert);
            if runs {
                run(&edited);
            }
        }
        let fresh = analysis(&edited.text(), dialect);
        prop_assert_eq!(report(&edited).unwrap(), report(&fresh).unwrap(), "{}", edited.text());
    }
}
