//! What is said of geometry that cannot exist: its cause, and what would help.

#![expect(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use std::sync::Arc;

use apt_run::{
    document::{Document, Level},
    settings::Settings,
};

/// Message and hint of the error of a program.
fn told(text: &str) -> (String, Option<String>) {
    let settings = Arc::new(Settings::default());
    let document = Document::new(text, Some("sample.apt".to_owned()), &settings);
    let all = document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap();
    let error = all.into_iter().find(|one| one.wording.apt3 == Some(1005)).unwrap();
    (error.wording.message, error.wording.hint)
}

#[test]
fn words_that_do_not_decide_are_told_with_those_that_may() {
    for (text, word, other) in [
        ("P=POINT/YLARGE,INTOF,(LINE/XAXIS),(CIRCLE/0,0,5)", "YLARGE", "XLARGE"),
        ("P=POINT/XSMALL,INTOF,(LINE/YAXIS),(CIRCLE/0,0,5)", "XSMALL", "YLARGE"),
        ("L=LINE/PARLEL,(LINE/XAXIS),XLARGE,2", "XLARGE", "YLARGE"),
        ("A=PLANE/PARLEL,(PLANE/1,0,0,2),ZLARGE,2", "ZLARGE", "XLARGE"),
        ("V=VECTOR/PERPTO,(PLANE/0,0,1,2),POSX", "POSX", "POSY"),
        ("V=VECTOR/PERPTO,(PLANE/1,0,0,2),NEGZ", "NEGZ", "POSX"),
    ] {
        let (message, hint) = told(&format!("{text}\nFINI\n"));
        assert!(message.contains(&format!("{word} does not decide")), "{message}");
        assert!(hint.as_deref().is_some_and(|hint| hint.contains(other)), "{text}: {hint:?}");
    }
}

#[test]
fn circles_without_a_common_tangent_are_told_as_circles() {
    let circles = |first: &str, second: &str| {
        format!("L=LINE/{first},TANTO,(CIRCLE/0,0,5),{second},TANTO,(CIRCLE/1,0,3)\nFINI\n")
    };
    for (first, second, needed) in [("LEFT", "RIGHT", "8"), ("LEFT", "LEFT", "2")] {
        let (message, _) = told(&circles(first, second));
        assert!(message.contains("circles") && !message.contains("point"), "{message}");
        assert!(message.contains("1 apart") && message.contains(needed), "{message}");
    }
    let (message, _) = told("L=LINE/(1,1),LEFT,TANTO,(CIRCLE/0,0,5)\nFINI\n");
    assert!(message.contains("the point lies inside the circle"), "{message}");
}

/// Number and hint of the error of a program whose motions are run.
fn refused(motion: &str) -> (Option<u16>, Option<String>) {
    let text =
        format!("CUTTER/4\nL=LINE/0,0,1,0\nC=CIRCLE/0,-14,10\nFROM/0,-2,0\nINDIRV/1,0,0\n{motion}\nFINI\n");
    let document = Document::new(&text, Some("sample.apt".to_owned()), &Arc::new(Settings::default()));
    let all = document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).unwrap();
    let error = all.into_iter().find(|one| one.wording.code == "APT0641").unwrap();
    (error.wording.apt3, error.wording.hint)
}

#[test]
fn lines_that_are_parallel_and_circles_with_one_centre_are_told_as_such() {
    for relation in ["TO", "ON", "PAST"] {
        let (number, hint) = refused(&format!("TLRGT,GOFWD/L,{relation},(LINE/0,-9,5,-9)"));
        assert_eq!(number, Some(715), "{relation}");
        assert!(hint.unwrap().contains("parallel"), "{relation}");
        let (number, hint) = refused(&format!("TLLFT,GOFWD/C,{relation},(CIRCLE/0,-14,30)"));
        assert_eq!(number, Some(717), "{relation}");
        assert!(hint.unwrap().contains("one centre"), "{relation}");
    }
    // Circles beside one another and a line beside a circle have no number of their own.
    for motion in [
        "TLLFT,GOFWD/C,TO,(CIRCLE/50,-14,20)",
        "TLLFT,GOFWD/C,TO,(LINE/0,9,5,9)",
        "TLRGT,GOFWD/L,TO,(CIRCLE/0,-50,20)",
    ] {
        assert_eq!(refused(motion).0, Some(714), "{motion}");
    }
}
