//! Lints are silent about good programs.

use std::sync::Arc;

use apt_ide::{Level, Settings};
use apt_run::{diagnostic::absolute_range, document::Document};
use apt_syntax::DialectName;
use apt_tests::{oracle, repository};

fn document(text: &str, dialect: DialectName) -> Document {
    let settings = Settings { dialect: Some(dialect.as_str().to_owned()), ..Settings::default() };
    Document::new(text, None, &Arc::new(settings))
}

fn is_lint(code: &str) -> bool {
    code.starts_with("APT095") || code.starts_with("APT096")
}

fn alarms(text: &str, dialect: DialectName) -> Vec<String> {
    let document = document(text, dialect);
    let found = document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).expect("nobody cancels");
    found
        .into_iter()
        .filter(|one| is_lint(one.wording.code))
        .map(|one| {
            let place = &text[absolute_range(document.tree(), &one.origin)];
            format!("{} {place:?}: {}", one.wording.code, one.wording.message)
        })
        .collect()
}

#[test]
fn good_programs_have_no_lints() {
    let mut looked_at = 0;
    let mut found = Vec::new();
    let groups = oracle::GROUPS.into_iter().chain(oracle::MILLING_GROUPS);
    for group in groups.filter(|group| *group != "errors") {
        let dialect = oracle::dialect_of(group);
        for path in oracle::programs(group) {
            let text = std::fs::read_to_string(&path).expect("the program can be read");
            looked_at += 1;
            let lints = alarms(&text, dialect).into_iter();
            found.extend(lints.map(|alarm| format!("{}: {alarm}", path.display())));
        }
    }
    for entry in std::fs::read_dir(repository("examples")).expect("there are examples") {
        let path = entry.expect("the folder can be read").path();
        if path.extension().is_some_and(|extension| extension == "apt") {
            let text = std::fs::read_to_string(&path).expect("the program can be read");
            looked_at += 1;
            let lints = alarms(&text, DialectName::Free).into_iter();
            found.extend(lints.map(|alarm| format!("{}: {alarm}", path.display())));
        }
    }
    assert!(looked_at > 180, "{looked_at} programs");
    assert!(found.is_empty(), "{}", found.join("\n"));
}

fn example() -> String {
    std::fs::read_to_string(repository("examples/bearing-cover.apt")).expect("the example exists")
}

#[test]
fn what_an_example_loses_is_told() {
    let without = |words: &[&str]| {
        let kept = |line: &&str| !words.iter().any(|word| line.trim().starts_with(word));
        example().lines().filter(kept).map(|line| format!("{line}\n")).collect::<String>()
    };
    let codes = |text: &str| {
        let mut codes: Vec<String> =
            alarms(text, DialectName::Free).iter().map(|alarm| alarm[..7].to_owned()).collect();
        codes.dedup();
        codes
    };
    assert_eq!(codes(&without(&["FEDRAT"])), ["APT0955"]);
    assert_eq!(codes(&without(&["INTOL", "OUTTOL"])), ["APT0954"]);
    assert_eq!(codes(&example().replace("OUTTOL/.001", "OUTTOL/.5")), ["APT0953"]);
}

#[test]
fn lints_of_damaged_programs_stay_inside_of_the_text() {
    let example = example();
    for cut in (0..example.len()).step_by(29) {
        for insert in ["", " 1 2", "$\n", ",INDIRV/1,0,0\n"] {
            let rest = &example[(cut + 13).min(example.len())..];
            let damaged = format!("{}{insert}{rest}", &example[..cut]);
            let document = document(&damaged, DialectName::Free);
            let found = document.diagnostics(Level::Section1, &|| false, &mut |_, _| {});
            for one in found.expect("nobody cancels") {
                let range = absolute_range(document.tree(), &one.origin);
                assert!(damaged.get(range).is_some(), "{one:?}");
                let mut edits = one.fixes.iter().flat_map(|fix| &fix.edits);
                assert!(edits.all(|(range, _)| damaged.get(range.clone()).is_some()), "{one:?}");
                assert!(!one.wording.message.is_empty(), "{one:?}");
            }
        }
    }
}
