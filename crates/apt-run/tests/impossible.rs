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
