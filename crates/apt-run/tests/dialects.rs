//! The dialect of a program that is being written is that of its text, as if it had just been opened.

use std::sync::Arc;

use apt_run::{document::Document, settings::Settings};
use apt_syntax::dialect::DialectName;

fn opened(text: &str) -> Document {
    Document::new(text, Some("sample.apt".to_owned()), &Arc::new(Settings::default()))
}

/// Replaces what stands once in the text of a document.
fn replaced(document: &Document, old: &str, new: &str) -> Document {
    let at = document.tree().text().find(old).expect("it stands there");
    document.edit(at..at + old.len(), new)
}

#[test]
fn the_comment_that_names_the_dialect_counts_when_it_is_written() {
    let text = "PARTNO X\nA=MAXF(1,2)\nGOTO/A,A,0\nFINI\n";
    let document = opened(text);
    assert_eq!(document.dialect(), DialectName::Free);
    let named = document.edit(0..0, "$$ apt-lsp: dialect=apt3\n");
    assert_eq!(named.dialect(), DialectName::Apt3);
    assert_eq!(replaced(&named, "apt3", "apt4").dialect(), DialectName::Apt4);
    assert_eq!(replaced(&named, "apt3", "apt").dialect(), DialectName::Free);
    assert_eq!(named.edit(0..25, "").dialect(), DialectName::Free);
    let lines = "A=1\n".repeat(60);
    assert_eq!(document.edit(text.len()..text.len(), &lines).dialect(), DialectName::Free);
}

#[test]
fn statements_speak_for_a_dialect_when_they_are_written_and_not_when_they_are_gone() {
    let filler = "B=1\n".repeat(200);
    let document = opened(&format!("PARTNO X\n{filler}FINI\n"));
    let late = replaced(&document, "FINI", "DO/5,I=1,3\nGOTO/I,0,0\n5) CONTIN\nFINI");
    assert_eq!(late.dialect(), DialectName::Apt4);
    assert_eq!(replaced(&late, "DO/5,I=1,3", "D").dialect(), DialectName::Free);
    assert_eq!(replaced(&late, "O/5", "").dialect(), DialectName::Free);
    // The line before and the one behind become one line.
    assert_eq!(replaced(&late, "\nDO/5", ",DO/5").dialect(), DialectName::Free);
    let empty = opened("");
    assert_eq!(empty.edit(0..0, "TOOL PATH/P,TOOL,T\nEND-OF-PATH\n").dialect(), DialectName::Cl);
}

#[test]
fn a_dialect_that_is_set_stays() {
    let settings = Settings { dialect: Some("apt3".to_owned()), ..Settings::default() };
    let document = Document::new("PARTNO X\nFINI\n", None, &Arc::new(settings));
    assert_eq!(document.edit(0..0, "$$ apt-lsp: dialect=apt4\n").dialect(), DialectName::Apt3);
}

/// Whatever is typed where: the version that edits lead to is the one that opening its text gives.
#[test]
fn edits_lead_to_what_opening_the_text_gives() {
    let pieces = [
        "DO/5,I=1,3\n",
        "$$ apt-lsp: dialect=apt4\n",
        "\n",
        "X=1\n",
        "IF(A.EQ.1)B=2\n",
        "IF(A.EQ.1)THEN\n",
        "$",
        "=",
        "/",
    ];
    let mut document = opened("PARTNO X\nP=POINT/1,2\nFINI\n");
    // A multiplicative generator: the same edits in every run.
    let mut seed = 17_u64;
    let mut next = |below: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % below
    };
    for step in 0..400 {
        let length = document.tree().text().len();
        let from = next(length + 1);
        let (to, piece) = match step % 3 {
            0 => ((from + next(20)).min(length), ""),
            _ => (from, pieces[next(pieces.len())]),
        };
        document = document.edit(from..to, piece);
        let text = document.tree().text();
        let fresh = opened(&text);
        assert_eq!(document.dialect(), fresh.dialect(), "step {step}: {text}");
        assert_eq!(document.dialect_reason(), fresh.dialect_reason(), "step {step}: {text}");
    }
}
