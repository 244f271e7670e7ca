//! Who gives up what is told or made of a long program, or asked at a place of it, is heard soon: questions are counted, not timed.

#![expect(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use std::{
    fmt::Debug,
    sync::atomic::{AtomicUsize, Ordering},
};

use apt_ide::{Cancel, Cancelled};

mod made;
mod told;

/// Statements, records, names or findings that are gone through between two questions; one takes some microseconds.
const GONE_THROUGH_BETWEEN_QUESTIONS: usize = 512;

/// Nobody cancels.
fn never() -> bool {
    false
}

/// Nobody watches.
fn silent(_: usize, _: usize) {}

/// How often a work asks, which must be once in so much of what it goes through. It is given up at the first question, in the
/// middle and at the last, never asks again after the answer, and then gives what it gave before.
fn asks_often<T: PartialEq + Debug>(
    gone_through: usize,
    what: &str,
    work: impl Fn(Cancel<'_>) -> Result<T, Cancelled>,
) {
    let asked = AtomicUsize::new(0);
    let until = |last: usize| {
        asked.store(0, Ordering::Relaxed);
        work(&|| asked.fetch_add(1, Ordering::Relaxed) + 1 >= last)
    };
    // What is kept is found out before.
    until(usize::MAX).unwrap();
    let whole = until(usize::MAX).unwrap();
    let all = asked.load(Ordering::Relaxed);
    let enough = all * GONE_THROUGH_BETWEEN_QUESTIONS >= gone_through;
    assert!(enough, "{all} questions for {gone_through} of {what}");
    for last in [1, all / 2, all] {
        assert_eq!(until(last).err(), Some(Cancelled), "{what}");
        assert_eq!(asked.load(Ordering::Relaxed), last, "{what} asks again after the answer");
    }
    assert!(until(usize::MAX).unwrap() == whole, "{what} after it was given up");
}
