//! Memory of a large file, measured in a process of its own.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use std::fmt::Write;

/// What a million lines may take beside their own text, bytes.
const MOST: u64 = 600 << 20;

/// What twenty edits may add: versions share what they have in common.
const MOST_FOR_EDITS: u64 = 64 << 20;

fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() * 1024
}

#[test]
fn a_million_lines_take_bounded_memory_and_versions_share_it() {
    let mut text = String::new();
    for number in 0..1_000_000_u32 {
        let _ = writeln!(text, "GOTO/{}.125,{}.5,-3.0625", number % 977, number % 313);
    }
    let before = resident();
    let first = apt_tests::runs::analysis(&text, "cl");
    first.document().program(&|| false).unwrap();
    let opened = resident();
    println!("opened and evaluated: {} bytes a line", (opened - before) / 1_000_000);
    assert!(opened - before < MOST, "{} bytes", opened - before);

    let mut versions = vec![first];
    for number in 0..20_usize {
        let last = versions.last().unwrap();
        let at = usize::from(last.document().tree().statement(number * 49_999).start) + 5;
        let next = last.edit(at..at, "7");
        next.document().program(&|| false).unwrap();
        versions.push(next);
    }
    let edited = resident();
    println!("one more version: {} bytes", edited.saturating_sub(opened) / 20);
    assert!(edited.saturating_sub(opened) < MOST_FOR_EDITS, "{} bytes", edited - opened);
    assert_eq!(versions.len(), 21);
}
