//! Files as large as CAM systems write them. What is asserted is counted, not timed.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use std::fmt::Write;

use apt_syntax::{TextRange, TextSize};
use apt_tests::runs::{analysis, settings};

/// The syntax tree keeps statements in blocks of this many; an edit looks through the blocks it touches.
const BLOCK: usize = 256;

/// Statements that one typed character may cause to be evaluated again.
const MOST_EVALUATED: u64 = 1_024;

const MILLION: usize = 1_000_000;

fn cl_lines(count: usize) -> String {
    let mut text = String::with_capacity(count * 24);
    for number in 0..count {
        let _ = writeln!(text, "GOTO/{}.125,{}.5,-3.0625", number % 977, number % 313);
    }
    text
}

#[test]
fn a_million_lines_of_cl_text_open_and_take_edits() {
    let first = analysis(&cl_lines(MILLION), "cl");
    let tree = first.document().tree();
    assert_eq!(tree.statement_count(), MILLION);
    let program = first.document().program(&|| false).unwrap();
    assert_eq!(program.record_count(), MILLION);
    assert_eq!(program.findings().count(), 0);

    let mut edited = first;
    for (index, insert) in [(MILLION / 2, "7"), (3, "1"), (MILLION - 2, "\nGOTO/1,2,3"), (MILLION / 3, "$$")]
    {
        let at = usize::from(edited.document().tree().statement(index).start) + 5;
        let range = TextRange::empty(TextSize::new(u32::try_from(at).unwrap()));
        let change = edited.document().tree().edit(range, insert).1;
        assert!(change.inserted <= 2 && change.scanned <= 2 * BLOCK, "{index}: {change:?}");
        edited = edited.edit(at..at, insert);
        let statistics = edited.document().program(&|| false).unwrap().statistics();
        assert!(statistics.evaluated_statements <= MOST_EVALUATED, "{index}: {statistics:?}");
        assert!(statistics.reused_statements + MOST_EVALUATED > MILLION as u64, "{index}: {statistics:?}");
    }
    // What an editor asks for while typing concerns what is seen.
    let at = usize::from(edited.document().tree().statement(MILLION / 2).start);
    assert!(!edited.tokens(Some(at..at + 400), &|| false).unwrap().is_empty());
}

#[test]
fn a_million_lines_of_cl_text_run() {
    let whole = analysis(&cl_lines(MILLION), "cl");
    let result = whole.document().run(&|| false, &mut |_, _| {}).unwrap();
    assert_eq!(result.totals().points, MILLION);
}

#[test]
fn a_line_of_ten_megabytes_is_one_statement() {
    let text = "GOTO/".to_owned() + &"1.5,".repeat(2_500_000) + "2\nGOTO/1,2,3\n";
    let whole = analysis(&text, "free");
    assert_eq!(whole.document().tree().statement_count(), 2);
    let report = apt_tests::runs::report(&whole).unwrap();
    assert_eq!(report["ok"], false, "that many coordinates are a mistake");
    assert_eq!(report["diagnostics"][0]["isn"], 1);
    assert_eq!(report["totals"]["points"], 1, "the next statement is read as ever");
    assert_eq!(whole.text(), text);
}

#[test]
fn a_million_statements_are_evaluated() {
    let mut text = String::from("PARTNO SUM\nA=0\n");
    for _ in 0..MILLION {
        text.push_str("A=A+1\n");
    }
    text.push_str("FINI\n");
    let whole = analysis(&text, "free");
    let program = whole.document().program(&|| false).unwrap();
    let sum = program.symbols().into_iter().find(|(name, _)| name == "A").unwrap().1;
    assert_eq!(sum, apt_program::Value::Scalar(1e6));
}

#[test]
fn a_loop_of_half_a_million_turns_is_within_the_budget_and_a_greater_one_says_where() {
    let text = |turns: u32| {
        format!("PARTNO LOOP\nI=0\nLOOPST\nA)I=I+1\nIF(I-{turns})A,Z,Z\nZ)LOOPND\nGOTO/I,0,0\nFINI\n")
    };
    let within = apt_tests::runs::report(&analysis(&text(500_000), "free")).unwrap();
    assert_eq!((&within["ok"], &within["symbols"]["I"]["canonical"][0]), (&true.into(), &500_000.0.into()));
    let beyond = apt_tests::runs::report(&analysis(&text(5_000_000), "free")).unwrap();
    let budget = settings("free").budget.statements;
    let told = beyond["diagnostics"].as_array().unwrap();
    assert!(
        told.iter().any(|one| one["severity"] == "error" && (3..=6).contains(&one["isn"].as_u64().unwrap())),
        "the budget of {budget} is told at the loop: {told:?}"
    );
}
