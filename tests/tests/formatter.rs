//! The formatter over every program of the repository and over damaged ones: idempotent, and nothing but the look
//! changes.

use apt_ide::format::{
    FormatOptions, Kept, KeptReason, LAST_STATEMENT_COLUMN, LetterCase, applied, format, format_text, plan,
};
use apt_program::{Options, Program, RecordKind, Value, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree, record::Layout, statement::ElementKind};
use apt_tests::{oracle, repository, runs};
use proptest::prelude::*;

/// The styles that are tried.
fn styles() -> [FormatOptions; 4] {
    let usual = FormatOptions::default();
    [
        usual,
        FormatOptions { wrap: Some(LAST_STATEMENT_COLUMN), ..usual },
        FormatOptions { wrap: Some(24), letter_case: LetterCase::Keep, ..usual },
        FormatOptions {
            indent: 0,
            continuation_indent: 0,
            align_comments: false,
            letter_case: LetterCase::Words,
            ..usual
        },
    ]
}

/// What a statement says: its elements, and the comments behind them.
type Meaning = (Vec<(ElementKind, String)>, Vec<String>);

fn meaning(text: &str, layout: &Layout) -> Vec<Meaning> {
    let tree = SyntaxTree::parse(text, layout.dialect);
    assert_eq!(tree.sequence_field(), layout.sequence_field, "{text:?}");
    let of = |view: apt_syntax::StatementView| {
        let parsed = view.parsed();
        let elements = parsed.elements.iter().map(|element| (element.kind, element.text.to_string()));
        let comments = parsed.comments.iter().map(|range| {
            view.text()[std::ops::Range::<usize>::from(*range)].trim_end_matches([' ', '\t']).to_owned()
        });
        (elements.collect(), comments.filter(|comment| !comment.is_empty()).collect())
    };
    tree.statements().map(of).collect()
}

/// Formats in every style and compares; the texts that come out.
fn formatted(text: &str, dialect: DialectName) -> Vec<String> {
    let dialect = Dialect::named(dialect);
    let tree = SyntaxTree::parse(text, dialect);
    let before = meaning(text, &tree.layout());
    let one = |options: FormatOptions| {
        let edits = format(&tree, &options);
        for pair in edits.windows(2) {
            assert!(pair[0].0.end <= pair[1].0.start, "edits overlap: {pair:?} in {text:?}");
        }
        for (range, insert) in &edits {
            assert_ne!(&text[range.clone()], insert, "an edit without effect at {range:?} in {text:?}");
        }
        let once = applied(text, &edits);
        assert_eq!(meaning(&once, &tree.layout()), before, "the meaning of {text:?} has changed");
        assert_eq!(format_text(&once, dialect, &options), once, "a second time changes {text:?}");
        once
    };
    styles().map(one).to_vec()
}

/// All programs of the repository with the dialects in which they are read.
fn programs() -> Vec<(DialectName, String, String)> {
    let mut programs = Vec::new();
    for group in oracle::GROUPS {
        let dialect = match group {
            "apt4-language" | "apt4-motion" => DialectName::Apt4,
            "errors" => DialectName::Apt3,
            _ => DialectName::Free,
        };
        programs.extend(oracle::programs(group).into_iter().map(|path| (dialect, path)));
    }
    for folder in ["examples", "crates/apt-syntax/tests/data"] {
        let entries = std::fs::read_dir(repository(folder)).expect("the folder exists");
        for path in entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| path.is_file()) {
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            let part_program = name.ends_with(".apt") && !name.starts_with("hsm");
            let dialect = match part_program {
                true if name.starts_with("apt4") => DialectName::Apt4,
                true => DialectName::Free,
                false => DialectName::Cl,
            };
            programs.push((dialect, path));
        }
    }
    let read = |(dialect, path): (DialectName, std::path::PathBuf)| {
        let text = std::fs::read(&path).expect("the file can be read");
        (dialect, path.display().to_string(), String::from_utf8_lossy(&text).into_owned())
    };
    programs.sort_by(|a, b| a.1.cmp(&b.1));
    programs.into_iter().map(read).collect()
}

fn evaluated(text: &str, dialect: DialectName) -> Program {
    let tree = SyntaxTree::parse(text, Dialect::named(dialect));
    evaluate(&tree, &Options::default(), &|| false)
}

/// Records, values and findings without their places.
type Results = (Vec<(u32, Option<String>, RecordKind)>, Vec<(String, Value)>, Vec<String>);

fn results(program: &Program) -> Results {
    let records = program.records().map(|record| {
        (record.origin.isn, record.label.as_ref().map(ToString::to_string), record.kind.clone())
    });
    let symbols = program.symbols().into_iter().map(|(name, value)| (name.to_string(), value));
    let findings = program.findings().map(|finding| format!("{} {:?}", finding.origin.isn, finding.kind));
    (records.collect(), symbols.collect(), findings.collect())
}

/// Records compared as text: a value that is not a number equals itself there.
fn assert_same_results(before: &str, after: &str, dialect: DialectName, name: &str) {
    let (before, after) = (results(&evaluated(before, dialect)), results(&evaluated(after, dialect)));
    assert_eq!(std::format!("{before:?}"), std::format!("{after:?}"), "{name} means something else");
}

#[test]
fn every_program_keeps_its_meaning_and_its_results() {
    let programs = programs();
    assert!(programs.len() > 200, "{} programs", programs.len());
    let mut changed = 0;
    for (dialect, name, text) in &programs {
        for new in formatted(text, *dialect) {
            changed += u32::from(new != *text);
            assert_same_results(text, &new, *dialect, name);
        }
    }
    assert!(changed > 200, "{changed} texts changed");
}

/// A report without what the look of the text decides: places, what fixes would change, and the spelling of statements.
fn without_places(mut report: serde_json::Value) -> serde_json::Value {
    fn walk(value: &mut serde_json::Value) {
        match value {
            serde_json::Value::Object(fields) => {
                fields.remove("range");
                fields.remove("fixes");
                if let Some(serde_json::Value::String(statement)) = fields.get_mut("statement") {
                    statement.retain(|character| !character.is_whitespace());
                    statement.make_ascii_uppercase();
                }
                fields.values_mut().for_each(walk);
            }
            serde_json::Value::Array(items) => items.iter_mut().for_each(walk),
            _ => {}
        }
    }
    // These are about the look itself.
    let of_the_look = |one: &serde_json::Value| one["code"] == "APT0951" || one["code"] == "APT0952";
    if let Some(found) = report["diagnostics"].as_array_mut() {
        found.retain(|one| !of_the_look(one));
    }
    walk(&mut report);
    report
}

#[test]
fn the_report_of_every_program_stays_the_same_bit_for_bit() {
    let mut changed = 0;
    let mut different = Vec::new();
    for (dialect, name, text) in programs().iter().filter(|(_, name, _)| !name.contains("crates")) {
        let before = runs::analysis(text, dialect.as_str());
        let report = runs::report(&before).map(without_places);
        for style in styles() {
            let new = format_text(text, Dialect::named(*dialect), &style);
            if new == *text {
                continue;
            }
            changed += 1;
            // The next version shares the memo of motions, so that only what has changed is computed twice.
            let after = before.edit(0..text.len(), &new);
            if report.is_err() || runs::report(&after).map(without_places) != report {
                different.push(name.clone());
            }
        }
    }
    assert!(changed > 150, "{changed} texts changed");
    assert!(different.is_empty(), "{}", different.join("\n"));
}

#[test]
fn examples_have_the_style() {
    for path in runs::examples() {
        let text = runs::read(&path);
        let free = Dialect::named(DialectName::Free);
        assert_eq!(format_text(&text, free, &FormatOptions::of(&free)), text, "{}", path.display());
    }
}

#[test]
fn no_good_program_has_a_statement_that_cannot_be_laid_out() {
    for (dialect, name, text) in programs().iter().filter(|(_, name, _)| !name.contains("errors")) {
        let tree = SyntaxTree::parse(text, Dialect::named(*dialect));
        let kept = plan(&tree, &FormatOptions::default()).kept;
        let numbered = |kept: &Kept| kept.reason == KeptReason::SequenceNumber;
        assert!(kept.iter().all(numbered), "{name}: {kept:?}");
    }
}

fn dialects() -> impl Strategy<Value = DialectName> {
    proptest::sample::select(DialectName::ALL.to_vec())
}

/// Pieces of which statements are made, good and bad.
fn piece() -> impl Strategy<Value = &'static str> {
    proptest::sample::select(vec![
        " ",
        "  ",
        "\t",
        "\n",
        "\r\n",
        "\r",
        "$",
        "$\n",
        "$ x\n",
        "$$",
        "$$ c\n",
        "$$ apt-lsp: format off\n",
        "$$ apt-lsp: format on\n",
        ",",
        "/",
        "=",
        "(",
        ")",
        "+",
        "-",
        "*",
        "**",
        ".",
        ".EQ.",
        "1",
        "12",
        "1.5",
        "1.E+2",
        "A",
        "b",
        "P1",
        "LONGNAME",
        "point",
        "LINE",
        "GOTO",
        "TLLFT",
        "GOLFT",
        "M1=MACRO/A,B=2\n",
        "TERMAC\n",
        "LOOPST\n",
        "LOOPND\n",
        "DO/10,I=1,3\n",
        "10)",
        "IF(A)",
        "PARTNO",
        "\nPARTNO X",
        "\nREMARK",
        "ARKABLE",
        "TOOL PATH",
        "'a  b'",
        "'",
        ";",
        "?",
        "ü",
        "\u{a0}",
        "N12 , ",
        "C3 ",
        "~\n",
        "$$->",
        "CALL/M1",
        "                                                                        00010\n",
        "                                                                  000123 \n",
    ])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn texts_of_random_pieces_keep_their_meaning(
        pieces in proptest::collection::vec(piece(), 0..60),
        dialect in dialects(),
    ) {
        formatted(&pieces.concat(), dialect);
    }

    #[test]
    fn random_texts_keep_their_meaning(text in "[ -~\\t\\n\\rü]{0,200}", dialect in dialects()) {
        formatted(&text, dialect);
    }

    #[test]
    fn damaged_programs_keep_their_meaning(
        which in any::<proptest::sample::Index>(),
        at in any::<proptest::sample::Index>(),
        length in 0_usize..12,
        insert in proptest::collection::vec(piece(), 0..4),
    ) {
        let programs = programs();
        let (dialect, _, text) = which.get(&programs);
        let from = text.floor_char_boundary(at.index(text.len() + 1));
        let to = text.floor_char_boundary((from + length).min(text.len())).max(from);
        let damaged = std::format!("{}{}{}", &text[..from], insert.concat(), &text[to..]);
        formatted(&damaged, *dialect);
    }
}
