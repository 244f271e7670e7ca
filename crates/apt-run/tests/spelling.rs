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

/// The finding of a program that has one, with its number, and the text with its first fix.
fn mended(text: &str) -> (Diagnostic, String) {
    let all = found(text);
    let told = all
        .iter()
        .find(|one| !one.fixes.is_empty() && one.wording.hint.is_some())
        .unwrap_or_else(|| panic!("{text}: {all:?}"));
    let mut mended = text.to_owned();
    for (range, replacement) in &told.fixes[0].edits {
        mended.replace_range(range.clone(), replacement);
    }
    (told.clone(), mended)
}

#[test]
fn a_misspelt_type_is_told_in_a_nested_definition() {
    for (body, wrong, right) in [
        ("L1=LINE/(PIONT/0,0,0),(1,2,3)", "PIONT", "POINT"),
        ("L1=LINE/(1,2,3),(PIONT/0,0)", "PIONT", "POINT"),
        ("L1=LINE/(P=PIONT/0,0,0),(1,2,3)", "PIONT", "POINT"),
        ("P1=POINT/CENTER,(CIRCEL/1,2,3,4)", "CIRCEL", "CIRCLE"),
        ("P1=POINT/CENTER,(C1=CIRCEL/1,2,3,4)", "CIRCEL", "CIRCLE"),
        ("P1=POINT/INTOF,(LINE/XAXIS),(LIEN/(1,2),(3,4))", "LIEN", "LINE"),
        ("P1=POINT/INTOF,(LINE/XAXIS),(LIEN/(POINT/1,2),(3,4))", "LIEN", "LINE"),
        ("L1=LIEN/(1,2),(3,4)", "LIEN", "LINE"),
        ("L1=LIEN/(POINT/1,2),(3,4)", "LIEN", "LINE"),
        ("A=LNTHF((VECTR/1,2,3))", "VECTR", "VECTOR"),
        ("GOTO/(PIONT/1,2)", "PIONT", "POINT"),
    ] {
        let (told, mended) = mended(&format!("{body}\nFINI\n"));
        assert!(told.wording.message.starts_with(wrong), "{body}: {}", told.wording.message);
        assert_eq!(told.wording.hint.as_deref(), Some(&*format!("did you mean {right}?")), "{body}");
        assert_eq!(mended, format!("{}\nFINI\n", body.replacen(wrong, right, 1)));
        let left: Vec<Diagnostic> =
            found(&mended).into_iter().filter(|one| one.wording.apt3.is_some()).collect();
        assert!(left.is_empty(), "{mended}: {left:?}");
    }
}

/// A name without a value among the operands of a word may be one of the words that belong there.
#[test]
fn a_misspelt_word_among_operands_is_told() {
    for (text, wrong, right) in [
        ("C1=CIRCLE/CENTRE,(1,2),RADIUS,3\nFINI\n", "CENTRE", "CENTER"),
        ("L1=LINE/(1,2),ATNAGL,30\nFINI\n", "ATNAGL", "ATANGL"),
        ("L1=LINE/(P1=POINT/CENTRE,(CIRCLE/1,2,3)),(3,4)\nFINI\n", "CENTRE", "CENTER"),
        ("L1=LINE/XAXIS\nL2=LINE/YAXIS\nGO/PASTT,L1,L2\nFINI\n", "PASTT", "PAST"),
    ] {
        let (told, mended) = mended(text);
        assert_eq!(told.wording.code, "APT0101");
        assert!(told.wording.message.starts_with(wrong), "{text}: {}", told.wording.message);
        assert_eq!(told.wording.hint.as_deref(), Some(&*format!("did you mean {right}?")), "{text}");
        assert_eq!(mended, text.replacen(wrong, right, 1));
    }
    // What divides in an expression is no word, and names that have a value come first where they are as near.
    let (_, hint, _) = first("A=3\nB=A+(PIONT/3)\nGOTO/A,B,0\nFINI\n");
    assert!(hint.is_some_and(|hint| !hint.contains("POINT")));
}

#[test]
fn names_without_a_letter_in_common_are_not_alike() {
    let (code, hint, titles) = first("X=3\nGOTO/B,X,0\nFINI\n");
    assert_eq!((code.as_str(), titles), ("APT0101", Vec::new()));
    assert!(hint.is_some_and(|hint| !hint.contains("did you mean")));
    let (_, hint, _) = first("BX=3\nGOTO/B,BX,0\nFINI\n");
    assert_eq!(hint.as_deref(), Some("did you mean BX?"));
}

/// A nested matrix is a matrix; what it lacks is a name.
#[test]
fn refsys_with_a_matrix_without_a_name_is_told_that_it_needs_one() {
    let [told] = &found("REFSYS/(MATRIX/XYROT,90)\nREFSYS/NOMORE\nFINI\n")[..] else { panic!("one finding") };
    assert_eq!(told.wording.code, "APT0333");
    assert_eq!(told.wording.message, "REFSYS needs a matrix with a name");
    assert!(told.wording.hint.as_ref().unwrap().contains("REFSYS/(M1=MATRIX/"), "{told:?}");
    assert!(found("REFSYS/(M1=MATRIX/XYROT,90)\nREFSYS/NOMORE\nFINI\n").is_empty(), "as the hint has it");
}

/// Forms that differ in nothing that is said are told once.
#[test]
fn no_form_of_a_definition_is_told_twice() {
    for word in [
        "POINT", "LINE", "CIRCLE", "PLANE", "CYLNDR", "SPHERE", "CONE", "ELLIPS", "VECTOR", "MATRIX",
        "GCONIC",
    ] {
        let all = found(&format!("A={word}/1\nB=A\nFINI\n"));
        let hint = all.iter().find_map(|one| one.wording.hint.clone()).unwrap();
        let mut forms: Vec<&str> =
            hint.split("; ").map(|form| form.trim_start_matches("its forms are ")).collect();
        let count = forms.len();
        forms.sort_unstable();
        forms.dedup();
        assert_eq!(forms.len(), count, "{word}: {hint}");
    }
}
