//! The Vim syntax file.

use std::fmt::Write as _;

use apt_syntax::vocabulary::WordClass;

use super::words::Vocabulary;

/// The syntax group of a class, and the standard group whose colour it takes.
fn group(class: WordClass) -> (&'static str, &'static str) {
    match class {
        WordClass::Text => ("aptText", "PreProc"),
        WordClass::Motion => ("aptMotion", "Statement"),
        WordClass::ToolPosition => ("aptToolPosition", "Statement"),
        WordClass::PathParameter => ("aptPathParameter", "Keyword"),
        WordClass::PathControl => ("aptPathControl", "Keyword"),
        WordClass::Logic => ("aptLogic", "Conditional"),
        WordClass::Declaration => ("aptDeclaration", "StorageClass"),
        WordClass::Transformation => ("aptTransformation", "Keyword"),
        WordClass::InputOutput => ("aptInputOutput", "Keyword"),
        WordClass::SystemFlag => ("aptSystemFlag", "PreProc"),
        WordClass::GeometricType => ("aptGeometricType", "Type"),
        WordClass::Function => ("aptFunction", "Function"),
        WordClass::Postprocessor => ("aptPostprocessor", "Special"),
        WordClass::PostprocessorBare => ("aptPostprocessorBare", "Special"),
        WordClass::Minor => ("aptMinor", "Constant"),
    }
}

/// The fixed head: what is not a word of the vocabulary. Later items win over earlier ones at the same place.
const HEAD: &str = r#"" Made from vocabulary.toml by `cargo xtask codegen`; do not edit.
if exists('b:current_syntax')
  finish
endif
syntax case ignore
syntax iskeyword @,48-57,_

syntax match aptSymbol /\<[A-Za-z0-9_]\+\>/
syntax match aptNumber /\<\d\+\>/
syntax match aptNumber /\<\d\+\.\d*\%(E[-+]\=\d\+\)\=/
syntax match aptNumber /\%(\w\)\@<!\.\d\+\%(E[-+]\=\d\+\)\=/
syntax match aptOperator /\*\*\|[-+*=]/
syntax match aptLabel /^\s*\w\+\s*)/
syntax match aptDefinition /^\s*\w\+\ze\s*\%(([^()=]*)\)\=\s*=/
syntax match aptMacro /^\s*\w\+\ze\s*=\s*MACRO\>/
syntax match aptCalled /\%(\<CALL\s*\/\s*\)\@<=\w\+/
"#;

const LINKS: &[(&str, &str)] = &[
    ("aptNumber", "Number"),
    ("aptOperator", "Operator"),
    ("aptLabel", "Label"),
    ("aptDefinition", "Identifier"),
    ("aptMacro", "Function"),
    ("aptCalled", "Function"),
    ("aptTextLine", "String"),
    ("aptContinuation", "Comment"),
    ("aptComment", "Comment"),
];

/// The syntax file.
pub(super) fn syntax(vocabulary: &Vocabulary) -> String {
    let mut text = String::from(HEAD);
    // Writing to a string cannot fail.
    for class in vocabulary.classes() {
        let (name, _) = group(class);
        let _ = writeln!(text);
        let (plain, hyphened): (Vec<&String>, Vec<&String>) =
            vocabulary.of(class).iter().partition(|word| !word.contains('-'));
        for chunk in plain.chunks(10) {
            let words: Vec<&str> = chunk.iter().map(|word| word.as_str()).collect();
            let _ = writeln!(text, "syntax keyword {name} {}", words.join(" "));
        }
        // A hyphen is no letter of a keyword.
        for word in hyphened {
            let _ = writeln!(text, "syntax match {name} /\\<{word}\\>/");
        }
    }
    let text_words = vocabulary.of(WordClass::Text).join("\\|");
    let _ = write!(
        text,
        "\n\" The rest of the card is text: behind columns 1-6, or in CL files behind a blank or slash.\n\
         syntax match aptTextLine /\\%(^\\%({text_words}\\)\\)\\@<=.*$/\n\
         syntax match aptTextLine /\\%(^\\s\\+\\%({text_words}\\)\\)\\@<=[ \\t\\/].*$/\n\
         syntax match aptContinuation /\\$.*$/\n\
         syntax match aptComment /\\$\\s*\\$.*$/\n\n",
    );
    let classes = vocabulary.classes().map(group);
    for (name, standard) in classes.chain(LINKS.iter().copied()) {
        let _ = writeln!(text, "highlight default link {name} {standard}");
    }
    text.push_str("\nlet b:current_syntax = 'apt'\n");
    text
}

#[cfg(test)]
mod tests {
    use super::super::words::SAMPLE;
    use super::*;

    #[test]
    fn words_become_keywords_and_hyphened_ones_matches() {
        let text = syntax(&Vocabulary::parse(SAMPLE).expect("the sample is valid"));
        assert!(text.contains("syntax keyword aptMotion GOLFT GO\n"), "{text}");
        assert!(text.contains("syntax match aptPostprocessorBare /\\<END-OF-PATH\\>/\n"), "{text}");
        assert!(text.contains("highlight default link aptMotion Statement\n"), "{text}");
        assert!(!text.contains("aptLogic "), "a class without words has no line: {text}");
    }
}
