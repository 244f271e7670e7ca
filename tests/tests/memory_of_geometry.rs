//! Memory of large programs of mixed geometry, measured in a process of its own: it grows with the number of statements
//! and no faster.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use std::fmt::Write;

use apt_ide::Analysis;
use apt_tests::runs::analysis;

/// What one statement may take in a program of this kind, evaluated and run, bytes: its text, its syntax, its meaning,
/// its place in the checkpoints and its records.
const MOST_PER_STATEMENT: u64 = 6_000;

/// How much more a statement may take in the largest program than in the smallest: trees grow deeper, and the allocator
/// rounds up.
const MOST_GROWTH: f64 = 1.35;

/// Points, lines, circles, planes and vectors of each other, a number between them, and positions.
fn mixed_geometry(statements: usize) -> String {
    let mut text = String::from("PARTNO MEMORY\nFROM/0,0,0\n");
    for n in 0..statements / 8 {
        let (x, y) = (n % 997, n % 613);
        let _ = write!(
            text,
            "A{n}={x}.5+{y}\nP{n}=POINT/{x},{y}\nQ{n}=POINT/A{n},{y}.25,1\nL{n}=LINE/P{n},Q{n}\n\
             C{n}=CIRCLE/CENTER,P{n},RADIUS,2.5\nN{n}=PLANE/PARLEL,(PLANE/0,0,1,0),ZLARGE,{x}.125\n\
             V{n}=VECTOR/P{n},Q{n}\nGOTO/Q{n}\n"
        );
    }
    text.push_str("FINI\n");
    text
}

fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() * 1024
}

fn evaluated(statements: usize) -> Analysis {
    let whole = analysis(&mixed_geometry(statements), "free");
    let program = whole.document().program(&|| false).unwrap();
    assert_eq!(program.statistics().evaluated_statements as usize, whole.document().tree().statement_count());
    let result = whole.document().run(&|| false, &mut |_, _| {}).unwrap();
    assert_eq!(result.totals().points, statements / 8 + 1);
    whole
}

#[test]
fn memory_grows_with_the_number_of_statements_and_no_faster() {
    // What the process needs once (tables of words, the allocator's first pages) is there before anything is counted.
    let mut kept = vec![evaluated(12_500)];
    let mut per_statement = Vec::new();
    for statements in [25_000_usize, 50_000, 100_000] {
        let before = resident();
        kept.push(evaluated(statements));
        let taken = resident() - before;
        println!("{statements} statements: {} bytes each", taken / statements as u64);
        per_statement.push(taken as f64 / statements as f64);
    }
    let least = per_statement.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(per_statement[2] <= MOST_GROWTH * least.max(1.0), "{per_statement:?} bytes a statement");
    assert!(per_statement.iter().all(|&bytes| bytes <= MOST_PER_STATEMENT as f64), "{per_statement:?}");
    assert_eq!(kept.len(), 4);
}
