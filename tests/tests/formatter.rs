//! The formatter over every program of the repository and over damaged ones: idempotent, and nothing but the look
//! changes.

use apt_geometry::patience::Patience;
use apt_ide::format::{
    FormatOptions, Kept, KeptReason, LAST_STATEMENT_COLUMN, LetterCase, applied, format, format_text, plan,
};
use apt_program::{Options, Program, RecordKind, Value, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxKind, SyntaxTree, record::Layout, statement::ElementKind};
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
        let edits = format(&tree, &options, Patience::default()).expect("nobody waits");
        for pair in edits.windows(2) {
            assert!(pair[0].0.end <= pair[1].0.start, "edits overlap: {pair:?} in {text:?}");
        }
        for (range, insert) in &edits {
            assert_ne!(&text[range.clone()], insert, "an edit without effect at {range:?} in {text:?}");
        }
        let once = applied(text, &edits);
        assert_eq!(meaning(&once, &tree.layout()), before, "the meaning of {text:?} has changed");
        assert_eq!(
            format_text(&once, dialect, &options, Patience::default()).expect("nobody waits"),
            once,
            "a second time changes {text:?}"
        );
        once
    };
    styles().map(one).to_vec()
}

/// All programs of the repository with the dialects in which they are read.
fn programs() -> Vec<(DialectName, String, String)> {
    let mut programs = Vec::new();
    for group in oracle::GROUPS.into_iter().chain(oracle::MILLING_GROUPS) {
        let dialect = oracle::dialect_of(group);
        programs.extend(oracle::programs(group).into_iter().map(|path| (dialect, path)));
    }
    for folder in
        ["examples", "editors/parts", "crates/apt-syntax/tests/data", "crates/apt-cldata/tests/data"]
    {
        let entries = std::fs::read_dir(repository(folder)).expect("the folder exists");
        for path in entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| path.is_file()) {
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            if name.ends_with(".tap") {
                // The bytes of a magnetic tape.
                continue;
            }
            let of_others = name.starts_with("hsm") || name.starts_with("cltape");
            let part_program = name.ends_with(".apt") && !of_others;
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

/// A report without the places of the text: lines, characters, and the blanks of what a fix would write there. The
/// measured times are gone already. Everything else stays, and every number to its last bit.
///
/// APT0951 is a statement about a place, column 72, and goes with it.
fn without_places(mut report: serde_json::Value) -> serde_json::Value {
    fn walk(value: &mut serde_json::Value) {
        match value {
            serde_json::Value::Object(fields) => {
                fields.remove("range");
                fields.remove("line");
                for edit in
                    fields.get_mut("edits").and_then(serde_json::Value::as_array_mut).into_iter().flatten()
                {
                    if let Some(serde_json::Value::String(text)) = edit.get_mut("text") {
                        text.retain(|character| !character.is_whitespace());
                    }
                }
                fields.values_mut().for_each(walk);
            }
            serde_json::Value::Array(items) => items.iter_mut().for_each(walk),
            _ => {}
        }
    }
    if let Some(found) = report["diagnostics"].as_array_mut() {
        found.retain(|one| one["code"] != "APT0951");
    }
    walk(&mut report);
    report
}

/// The statements of motions, which are shown as their author wrote them: taken out of the report.
fn statements(report: &mut serde_json::Value) -> Vec<String> {
    let motions = report["motions"].as_array_mut().into_iter().flatten();
    let text =
        |motion: &mut serde_json::Value| motion["statement"].take().as_str().unwrap_or_default().to_owned();
    motions.map(text).collect()
}

/// The elements of a statement one after the other, in the letters that a style wants: which letters change is asked
/// of the option and of the vocabulary, blanks mean nothing.
fn spelled(statement: &str, dialect: Dialect, case: Option<LetterCase>) -> String {
    let tree = SyntaxTree::parse(statement, dialect);
    let mut spelled = String::new();
    for view in tree.statements() {
        for token in view.tokens().iter().filter(|token| !token.kind.is_trivia()) {
            let text = &view.text()[std::ops::Range::<usize>::from(token.range)];
            let word = matches!(token.kind, SyntaxKind::Word | SyntaxKind::Relation);
            let text_of_a_word = token.kind == SyntaxKind::Text;
            let upper = match case {
                Some(LetterCase::Upper) => !text_of_a_word,
                Some(LetterCase::Words) => word,
                Some(LetterCase::Keep) | None => false,
            };
            spelled.push_str(&if upper { text.to_ascii_uppercase() } else { text.to_owned() });
        }
    }
    spelled
}

/// Runs a program and every style of it, and compares the reports. The number of styles that differ in their text.
fn assert_same_report(name: &str, text: &str, dialect: DialectName, different: &mut Vec<String>) -> usize {
    let before = runs::analysis(text, dialect.as_str());
    let mut report =
        without_places(runs::report(&before).unwrap_or_else(|error| panic!("{name}: {error:?}")));
    let written = statements(&mut report);
    let dialect = Dialect::named(dialect);
    let mut changed = 0;
    for style in styles() {
        let new = format_text(text, dialect, &style, Patience::default()).expect("nobody waits");
        if new == *text {
            continue;
        }
        changed += 1;
        // The next version shares the memo of motions, so that only what has changed is computed twice.
        let after = before.edit(0..text.len(), &new);
        let mut after =
            without_places(runs::report(&after).unwrap_or_else(|error| panic!("{name}: {error:?}")));
        let shown = statements(&mut after);
        let wanted: Vec<_> =
            written.iter().map(|one| spelled(one, dialect, Some(style.letter_case))).collect();
        let shown: Vec<_> = shown.iter().map(|one| spelled(one, dialect, None)).collect();
        if shown != wanted || after != report {
            let first = ["diagnostics", "symbols", "listing", "cl", "motions", "totals"]
                .into_iter()
                .find(|key| after[key] != report[key]);
            different.push(std::format!("{name}: {}", first.unwrap_or("statements")));
        }
    }
    changed
}

#[test]
fn the_report_of_every_program_stays_the_same_bit_for_bit() {
    let mut changed = 0;
    let mut different = Vec::new();
    for (dialect, name, text) in &programs() {
        changed += assert_same_report(name, text, *dialect, &mut different);
    }
    assert!(changed > 250, "{changed} texts changed");
    assert!(different.is_empty(), "{}", different.join("\n"));
}

#[test]
fn the_report_of_every_sample_of_a_finding_stays_the_same_bit_for_bit() {
    let mut different = Vec::new();
    let mut looked_at = 0;
    for page in apt_run::catalogue::pages() {
        let dialect =
            page.dialect.as_deref().map_or(DialectName::Free, |name| name.parse().expect("a dialect"));
        for (kind, text) in [("wrong", &page.wrong), ("right", &page.right)] {
            looked_at += 1;
            assert_same_report(&std::format!("{} {kind}", page.code), text, dialect, &mut different);
            formatted(text, dialect);
        }
    }
    assert!(looked_at > 400, "{looked_at} samples");
    assert!(different.is_empty(), "{}", different.join("\n"));
}

#[test]
fn examples_have_the_style() {
    for path in runs::examples() {
        let text = runs::read(&path);
        let free = Dialect::named(DialectName::Free);
        assert_eq!(
            format_text(&text, free, &FormatOptions::of(&free), Patience::default()).expect("nobody waits"),
            text,
            "{}",
            path.display()
        );
    }
}

#[test]
fn no_good_program_has_a_statement_that_cannot_be_laid_out() {
    for (dialect, name, text) in programs().iter().filter(|(_, name, _)| !name.contains("errors")) {
        let tree = SyntaxTree::parse(text, Dialect::named(*dialect));
        let kept = plan(&tree, &FormatOptions::default(), Patience::default()).expect("nobody waits").kept;
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
