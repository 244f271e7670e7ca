//! What is told of a long program.

use std::sync::atomic::{AtomicUsize, Ordering};

use apt_run::{
    Cancel, Cancelled, Waiting,
    document::{Document, Level},
    position::LineIndex,
};
use apt_tests::runs;

use super::{asks_often, never, silent};

fn document(text: &str) -> Document {
    Document::new(text, Some("sample.apt".to_owned()), &runs::settings("free"))
}

#[test]
fn what_is_told_of_a_long_program_asks_often_and_what_is_told_of_a_short_one_never() {
    let points = 1_000;
    let text: String =
        (0..points).map(|number| format!("P{number}=POINT/{number},.5\nA{number}=B{number}\n")).collect();
    let long = document(&text);
    long.run(&never, &mut silent).unwrap();
    let findings = |cancel: Cancel<'_>| long.diagnostics(Level::Section1, cancel, &mut silent);
    let found = findings(&never).unwrap().len();
    assert!(found >= points, "{found}: nobody knows the other names");
    asks_often(2 * points + found, "findings", findings);
    let gravest = |cancel: Cancel<'_>| long.worst_diagnostics(Level::Section1, 10, cancel, &mut silent);
    asks_often(2 * points, "the gravest findings", gravest);
    let report = |cancel: Cancel<'_>| {
        let report = long.report(cancel, &mut silent, None)?;
        Ok(serde_json::to_string(&report).unwrap())
    };
    asks_often(3 * points + 2 * found, "a report of statements, names and findings", report);

    let short = document("P1=POINT/1,2\nGOTO/P1\nFINI\n");
    short.run(&never, &mut silent).unwrap();
    assert!(short.report(&|| true, &mut silent, None).is_ok(), "it is known already");
}

#[test]
fn the_lines_of_a_long_text_are_found_in_pieces() {
    let text = "GOTO/1,2,3\r\nGOTO/4,5,6\rGOTO/7,8,9\n".repeat(20_000);
    let asked = AtomicUsize::new(0);
    let until = |last: usize| {
        let ask = || asked.fetch_add(1, Ordering::Relaxed) + 1 >= last;
        let waiting = Waiting::until(&ask);
        LineIndex::until(&text, waiting.patience()).map(|lines| lines.line_of(text.len()))
    };
    assert_eq!(until(usize::MAX), Ok(60_000));
    assert!(asked.swap(0, Ordering::Relaxed) >= 2, "it is asked in the middle");
    assert_eq!(until(1), Err(Cancelled));
    assert_eq!(asked.load(Ordering::Relaxed), 1, "asked again after the answer");
}

#[test]
fn a_report_asks_while_it_lists_and_sums_up() {
    let records = 6_000;
    let gotos: String = (0..records).map(|number| format!("GOTO/{number},0,0\n")).collect();
    let path = document(&gotos);
    path.run(&never, &mut silent).unwrap();
    let report = |cancel: Cancel<'_>| {
        let report = path.report(cancel, &mut silent, None)?;
        Ok(serde_json::to_string(&report).unwrap())
    };
    // Statements, the records of Section 1 for the lints of the path, and the records as entries and as a sum.
    asks_often(4 * records, "a report of a path", report);
}
