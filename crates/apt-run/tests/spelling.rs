//! "Did you mean": names and words that are misspelt, with the word that is like them and the change that settles it.

#![expect(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use std::sync::Arc;

use apt_run::{
    diagnostic::Diagnostic,
    document::{Document, Level},
    settings::Settings,
};

fn found(text: &str) -> Vec<Diagnostic> {
    let document = Document::new(text, Some("sample.apt".to_owned()), &Arc::new(Settings::default()));
    document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap()
}

/// Code, hint, and titles of the fixes of the first finding.
fn first(text: &str) -> (String, Option<String>, Vec<String>) {
    let all = found(text);
    let first = all.first().unwrap();
    let titles = first.fixes.iter().map(|fix| fix.title.clone()).collect();
    (first.wording.code.to_owned(), first.wording.hint.clone(), titles)
}

#[test]
fn a_misspelt_word_that_begins_a_statement_is_told_with_the_word_it_is_like() {
    for (wrong, right) in [("FORM/0,0,0", "FROM"), ("GOTOO/0,0,0", "GOTO"), ("SPINDLE/ON", "SPINDL")] {
        let (code, hint, titles) = first(&format!("{wrong}\nFINI\n"));
        assert_eq!(code, "APT0017");
        assert!(hint.unwrap().contains(right), "{wrong}");
        assert!(titles.iter().any(|title| title.ends_with(&format!("by {right}"))), "{wrong}: {titles:?}");
    }
    let (_, hint, titles) = first("ZZYZX/0,0,0\nFINI\n");
    assert!(hint.unwrap().contains("name = value") && titles.is_empty(), "nothing is like it");
}

/// Behind `=` and `(` a name with a slash divides, and a division is followed by nothing.
#[test]
fn a_misspelt_type_of_geometry_is_told_where_it_stands() {
    for (text, name, right) in [
        ("P1=PIONT/0,0,0\nGOTO/P1\nFINI\n", "PIONT", "POINT"),
        ("P1=(PIONT/CENTER,C1)\nGOTO/P1\nFINI\n", "PIONT", "POINT"),
        ("C1=CIRCEL/CENTER,(POINT/0,0),RADIUS,2\nFINI\n", "CIRCEL", "CIRCLE"),
    ] {
        let all = found(text);
        let told = all.iter().find(|one| one.wording.code == "APT0040").unwrap();
        let number = if text.contains("CENTER") { 76 } else { 7 };
        assert_eq!(told.wording.apt3, Some(number));
        assert!(told.wording.message.starts_with(name), "{}", told.wording.message);
        assert_eq!(told.wording.hint.as_deref(), Some(&*format!("did you mean {right}?")));
        let titles: Vec<&str> = told.fixes.iter().map(|fix| &*fix.title).collect();
        assert_eq!(titles, [format!("Replace {name} by {right}")]);
        let (range, replacement) = &told.fixes[0].edits[0];
        let mut mended = text.to_owned();
        mended.replace_range(range.clone(), replacement);
        assert!(found(&mended).iter().all(|one| one.wording.code != "APT0040"), "{mended}");
    }
    let (code, hint, titles) = first("B=2\nA=B/2,3\nGOTO/A,B,0\nFINI\n");
    assert_eq!((code.as_str(), titles), ("APT0040", Vec::new()));
    assert!(hint.is_some());
}

#[test]
fn names_without_a_letter_in_common_are_not_alike() {
    let (code, hint, titles) = first("X=3\nGOTO/B,X,0\nFINI\n");
    assert_eq!((code.as_str(), titles), ("APT0101", Vec::new()));
    assert!(hint.is_some_and(|hint| !hint.contains("did you mean")));
    let (_, hint, _) = first("BX=3\nGOTO/B,BX,0\nFINI\n");
    assert_eq!(hint.as_deref(), Some("did you mean BX?"));
}
