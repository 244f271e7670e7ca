//! Who gives up a long tape is heard soon: questions are counted, not timed.

use std::{cell::Cell, fmt::Write};

use apt_cldata::{record::ClRecord, text::read_text};
use apt_geometry::patience::Waiting;
use apt_post::{Cancelled, PostOptions, Tape, machine, post, post_until};

/// Positions that are looked at between two questions; one takes up to some microseconds.
const LOOKED_AT_BETWEEN_QUESTIONS: usize = 512;

/// A tape that is given up at a question, and how often was asked.
fn given_up(records: &[ClRecord], last: usize) -> (Result<Tape, Cancelled>, usize) {
    let mill = machine("linuxcnc-mill3").expect("a machine of the house");
    let asked = Cell::new(0);
    let ask = || {
        asked.set(asked.get() + 1);
        asked.get() >= last
    };
    let waiting = Waiting::until(&ask);
    (post_until(records, &mill, &PostOptions::default(), waiting.patience()), asked.get())
}

/// A tape asks so often that no more is looked at between two questions. It is given up at the first question, in the
/// middle and at the last, never asks again after the answer, and else is the tape that nobody waits for.
fn asks_often(records: &[ClRecord], looked_at: usize) {
    let mill = machine("linuxcnc-mill3").expect("a machine of the house");
    let (tape, all) = given_up(records, usize::MAX);
    assert_eq!(tape, Ok(post(records, &mill, &PostOptions::default())));
    assert!(all * LOOKED_AT_BETWEEN_QUESTIONS >= looked_at, "{all} questions for {looked_at} positions");
    for last in [1, all / 2, all] {
        assert_eq!(given_up(records, last), (Err(Cancelled), last), "asks again after the answer");
    }
}

fn records(text: &str) -> Vec<ClRecord> {
    let (records, errors) = read_text(text);
    assert!(errors.is_empty(), "{errors:?}");
    records
}

const BEFORE: &str = "UNITS/MM\nFROM/0,0,50\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/100,MMPM\n";

#[test]
fn a_run_of_many_positions_asks_at_each_look_at_them() {
    let positions = 20_000;
    let mut text = BEFORE.to_owned();
    for step in 0..positions {
        let word = if step == 0 { "GOTO/" } else { "" };
        let _ = writeln!(text, "{word}{step},{},0", step % 7);
    }
    let mut path = records(&text);
    // As one record, as a motion along surfaces is.
    let one: Vec<_> = path.drain(5..).collect();
    let points = one.iter().flat_map(|record| match &record.kind {
        apt_cldata::record::ClKind::Motion { points, .. } => points.clone(),
        _ => Vec::new(),
    });
    let points: Vec<_> = points.collect();
    assert_eq!(points.len(), positions);
    let surface = "S".into();
    let kind = apt_cldata::record::ClKind::Motion { from: false, surface, points };
    path.push(ClRecord { isn: 6, source: 6, kind });
    // Where they are on the tape, as the control reads them, and their blocks.
    asks_often(&path, 3 * positions);
}
