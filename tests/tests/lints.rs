//! Lints are silent about good programs.

use apt_ide::lint::lint;
use apt_program::{Options, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree};
use apt_tests::{oracle, repository};

fn alarms(text: &str, dialect: DialectName) -> Vec<String> {
    let tree = SyntaxTree::parse(text, Dialect::named(dialect));
    let program = evaluate(&tree, &Options::default(), &|| false);
    let told = |lint: apt_ide::lint::Lint| format!("{} {:?}: {}", lint.code, &text[lint.range], lint.message);
    lint(&tree, &program).into_iter().map(told).collect()
}

#[test]
fn good_programs_have_no_lints() {
    let mut looked_at = 0;
    let mut found = Vec::new();
    for group in oracle::GROUPS.into_iter().filter(|group| *group != "errors") {
        let dialect = if group.starts_with("apt4") { DialectName::Apt4 } else { DialectName::Free };
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
            let tree = SyntaxTree::parse(&damaged, Dialect::named(DialectName::Free));
            let program = evaluate(&tree, &Options::default(), &|| false);
            for lint in lint(&tree, &program) {
                assert!(damaged.get(lint.range.clone()).is_some(), "{lint:?}");
                assert!(lint.fix.iter().all(|(range, _)| damaged.get(range.clone()).is_some()), "{lint:?}");
                assert!(apt_ide::lint::CODES.contains(&lint.code) && !lint.message.is_empty(), "{lint:?}");
            }
        }
    }
}
