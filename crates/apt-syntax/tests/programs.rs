//! Whole programs: good ones have no syntax errors, in the dialect that is detected or given.

use apt_syntax::dialect::detect;
use apt_syntax::{Dialect, DialectName, SyntaxTree};

fn data() -> Vec<(String, String)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data");
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("the folder of programs")
        .map(|entry| {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            (name, std::fs::read_to_string(&path).expect("a text"))
        })
        .collect();
    files.sort();
    files
}

#[test]
fn good_programs_have_no_syntax_errors() {
    let files = data();
    assert!(files.len() > 25, "{}", files.len());
    for (name, text) in files {
        let detected = detect(&text, Some(&name)).name;
        let dialect = if name.starts_with("apt4-") { DialectName::Apt4 } else { detected };
        let is_cl = !name.ends_with(".apt") || name.starts_with("hsm");
        assert_eq!(detected == DialectName::Cl, is_cl, "{name} was taken for {detected}");
        let tree = SyntaxTree::parse(&text, Dialect::named(dialect));
        let mut in_macro = false;
        for view in tree.statements() {
            // What a macro's text says is known only when its variables have values.
            in_macro = (in_macro || view.text().contains("=MACRO")) && !view.text().contains("TERMAC");
            if in_macro {
                continue;
            }
            assert_eq!(view.parsed().errors, [], "{name} statement {}: {:?}", view.isn(), view.text());
        }
        assert_eq!(tree.text(), text);
    }
}

#[test]
fn programs_with_line_ends_of_other_systems_say_the_same() {
    for (name, text) in data() {
        let dialect = Dialect::named(detect(&text, Some(&name)).name);
        let plain = SyntaxTree::parse(&text, dialect);
        for end in ["\r\n", "\r"] {
            let other = SyntaxTree::parse(&text.replace('\n', end), dialect);
            assert_eq!(other.statement_count(), plain.statement_count(), "{name} {end:?}");
            for (other, plain) in other.statements().zip(plain.statements()) {
                let spell = |view: &apt_syntax::StatementView| {
                    view.parsed()
                        .elements
                        .iter()
                        .map(|element| element.text.replace(['\r', '\n'], ""))
                        .collect::<Vec<_>>()
                };
                assert_eq!(spell(&other), spell(&plain), "{name} {end:?}");
            }
        }
    }
}

#[test]
fn lower_case_says_the_same() {
    for (name, text) in data() {
        if name.ends_with("-03.aptsource") || name.starts_with("hsm") {
            continue;
        }
        let dialect = Dialect::named(detect(&text, Some(&name)).name);
        let upper = SyntaxTree::parse(&text, dialect);
        let lower = SyntaxTree::parse(&text.to_ascii_lowercase(), dialect);
        for (lower, upper) in lower.statements().zip(upper.statements()) {
            let spell = |view: &apt_syntax::StatementView| {
                view.parsed()
                    .elements
                    .iter()
                    .map(|element| (element.kind, element.text.to_ascii_uppercase()))
                    .collect::<Vec<_>>()
            };
            assert_eq!(spell(&lower), spell(&upper), "{name}");
        }
    }
}
