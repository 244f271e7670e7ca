//! The page of the language: every word with its forms, its codes, its help and what this program does with it.

use std::fmt::Write as _;

use apt_syntax::vocabulary::{
    WordClass, WordStatus,
    generate::{Entry, entries},
};

use crate::failure::{Failure, Outcome};

/// The classes in the order of the page, with their headings and what they are.
const CLASSES: [(WordClass, &str, &str); 15] = [
    (
        WordClass::GeometricType,
        "Geometry",
        "`name=TYPE/…` defines a form; in parentheses it may stand in other statements.",
    ),
    (WordClass::Function, "Functions", "Angles are in degrees unless the help says otherwise."),
    (WordClass::Motion, "Motion", "Statements that move the tool or say how it will move."),
    (WordClass::ToolPosition, "Tool position", "Where the tool is, seen along the motion; modal."),
    (WordClass::PathParameter, "Path parameters", "Numbers that hold until they are given again."),
    (WordClass::PathControl, "Path control", "Switches; a comma and a motion may follow them."),
    (WordClass::Logic, "Logic", "Macros, loops, jumps and the end."),
    (WordClass::Declaration, "Declarations", "Arrays, synonyms, systems of reference, numbers of forms."),
    (
        WordClass::Transformation,
        "Transformation of the path",
        "What is done with the path after it has been computed.",
    ),
    (WordClass::InputOutput, "Input and output", "Listings and other files."),
    (WordClass::SystemFlag, "System flags", "Switches of the processors of old."),
    (
        WordClass::Text,
        "Text",
        "The rest of the card is text. In CL files these words may stand in any column.",
    ),
    (WordClass::Postprocessor, "Post-processor words", "Statements to the machine, with parameters."),
    (
        WordClass::PostprocessorBare,
        "Post-processor words without parameters",
        "Statements to the machine that stand alone.",
    ),
    (WordClass::Minor, "Minor words", "Words that stand in the parameter lists of others."),
];

/// What a status means to a user.
fn meaning(status: WordStatus) -> &'static str {
    match status {
        WordStatus::Evaluated => "the program does what the word says",
        WordStatus::OnTape => "the post-processor acts on it",
        WordStatus::PassedThrough => "it stands on the CL file; a machine definition may give it a meaning",
        WordStatus::NoEffect => {
            "it is accepted and its form is checked; what it switched in the old processor does not exist here"
        }
        WordStatus::Reported => "the language reserves it without a public meaning, and its use is reported",
        WordStatus::Parsed => "it is known, and its use is reported as not available",
    }
}

/// The page.
pub(super) fn page(source: &str) -> Outcome<String> {
    let words = entries(source).map_err(|fault| Failure::Vocabulary(fault.to_string()))?;
    let mut out = String::from(
        "<!-- Made from vocabulary.toml by `cargo xtask codegen`; do not edit. -->\n\n# The words of the language\n\n",
    );
    out.push_str("In the forms `[…]` may be left out, `{a|b}` is a choice, lower-case letters stand for numbers and names.\n\n");
    // Writing to a string cannot fail.
    for status in WordStatus::ALL {
        let count = words.iter().filter(|word| word.status == status).count();
        let _ = writeln!(out, "- **{}** ({count} words): {}.", status.as_str(), meaning(status));
    }
    for (class, heading, about) in CLASSES {
        let of_class: Vec<&Entry> = words.iter().filter(|word| word.class == class).collect();
        if of_class.is_empty() {
            continue;
        }
        let _ = write!(out, "\n## {heading}\n\n{about}\n\n");
        let place = if class == WordClass::Minor { "Used in" } else { "Forms" };
        let _ = writeln!(out, "| Word | {place} | Codes | Status | What it does |\n|---|---|---|---|---|");
        for word in of_class {
            row(&mut out, word);
        }
    }
    Ok(out)
}

fn row(out: &mut String, word: &Entry) {
    let forms: Vec<String> = word.forms.iter().map(|form| format!("`{}`", escaped(form))).collect();
    let place = if forms.is_empty() { word.used_in.join(", ") } else { forms.join("<br>") };
    let codes = match (word.record, word.code) {
        (Some((class, subclass)), _) => format!("{class} {subclass}"),
        (None, Some(code)) => code.to_string(),
        (None, None) => String::new(),
    };
    let mut help = escaped(&word.help);
    if !word.dialects.is_empty() {
        let names = |soft: bool| {
            let those = word.dialects.iter().filter(|name| word.soft_in.contains(name) == soft);
            those.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
        };
        let (reserved, soft) = (names(false), names(true));
        if !reserved.is_empty() {
            let _ = write!(help, " Reserved in {reserved} only.");
        }
        if !soft.is_empty() {
            let _ = write!(help, " In {soft} a word where no name can stand.");
        }
    }
    let status = word.status.as_str();
    let _ = writeln!(out, "| `{}` | {place} | {codes} | {status} | {help} |", word.spelling);
}

/// A bar would end the cell.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLE: &str = r#"
[[word]]
spelling = "TLLFT"
class = "tool-position"
status = "evaluated"
record = [6000, 9]
forms = ["TLLFT", "TLLFT,GOLFT/{a|b}"]
help = "Left of it."
[[word]]
spelling = "FLOOD"
class = "minor"
status = "on-tape"
code = 89
used_in = ["COOLNT"]
dialects = ["apt4", "cl"]
help = "Much of it."
"#;

    #[test]
    fn a_word_becomes_a_row_of_its_class() {
        let page = page(SAMPLE).expect("the sample is valid");
        for part in [
            "- **evaluated** (1 words): ",
            "## Tool position\n",
            "| `TLLFT` | `TLLFT`<br>`TLLFT,GOLFT/{a\\|b}` | 6000 9 | evaluated | Left of it. |\n",
            "| `FLOOD` | COOLNT | 89 | on tape | Much of it. Reserved in `apt4`, `cl` only. |\n",
        ] {
            assert!(page.contains(part), "{part:?} is missing in {page}");
        }
        assert!(!page.contains("## Text"), "a class without words has no heading");
    }

    #[test]
    fn every_class_has_its_heading() {
        let source = std::fs::read_to_string(crate::layout::vocabulary()).expect("the vocabulary is there");
        let words = page(&source)
            .expect("the vocabulary is valid")
            .lines()
            .filter(|line| line.starts_with("| `"))
            .count();
        assert_eq!(words, apt_syntax::vocabulary::words().len());
    }

    #[test]
    fn a_word_without_a_status_is_a_fault() {
        let fault = page("[[word]]\nspelling = \"GO\"\nclass = \"motion\"\nhelp = \"x\"\n");
        assert!(matches!(fault, Err(Failure::Vocabulary(message)) if message.contains("status")));
    }
}
