//! The oracle corpus: a table per group, and an exact list of the programs that do not pass.

use std::collections::BTreeMap;

use apt_tests::{oracle::run_corpus, repository};

/// Reads `not-passing.toml`: `"group/name" = "reason"` lines.
fn known() -> BTreeMap<String, String> {
    let text =
        std::fs::read_to_string(repository("tests/oracle/not-passing.toml")).expect("the list is there");
    let pair = |line: &str| {
        let (name, reason) = line.split_once('=')?;
        Some((name.trim().trim_matches('"').to_owned(), reason.trim().trim_matches('"').to_owned()))
    };
    text.lines().filter(|line| line.starts_with('"')).filter_map(pair).collect()
}

#[test]
fn every_program_passes_or_is_listed_with_its_reason() {
    let (table, failures) = run_corpus();
    println!("{table}");
    for (name, problems) in &failures {
        println!("{name}");
        for problem in problems.iter().take(4) {
            println!("    {problem}");
        }
    }
    let known = known();
    let unexpected: Vec<_> = failures.keys().filter(|name| !known.contains_key(*name)).collect();
    let healed: Vec<_> = known.keys().filter(|name| !failures.contains_key(*name)).collect();
    assert!(unexpected.is_empty(), "these fail and are not listed: {unexpected:?}");
    assert!(healed.is_empty(), "these pass now, take them off the list: {healed:?}");
    assert!(known.values().all(|reason| reason.len() > 10), "every entry of the list says why");
}
