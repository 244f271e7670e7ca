//! The TextMate grammar: colours before (and without) a server.

use apt_syntax::vocabulary::WordClass;
use serde_json::{Value, json};

use super::words::Vocabulary;

/// The scope of the words of a class. The first parts are what colour themes know. They are those that the
/// extension gives to the server's semantic tokens of the class (`semanticTokenScopes` in its `package.json`), so
/// that no colour changes when the tokens arrive.
fn scope(class: WordClass) -> &'static str {
    match class {
        WordClass::Text => "support.function.postprocessor.text.apt",
        WordClass::Motion => "keyword.control.motion.apt",
        WordClass::ToolPosition => "keyword.control.tool-position.apt",
        WordClass::PathParameter => "keyword.control.path-parameter.apt",
        WordClass::PathControl => "keyword.control.path-control.apt",
        WordClass::Logic => "keyword.control.logic.apt",
        WordClass::Declaration => "keyword.control.declaration.apt",
        WordClass::Transformation => "keyword.control.transformation.apt",
        WordClass::InputOutput => "keyword.control.input-output.apt",
        WordClass::SystemFlag => "keyword.control.system-flag.apt",
        WordClass::GeometricType => "support.type.geometric.apt",
        WordClass::Function => "support.function.arithmetic.apt",
        WordClass::Postprocessor => "support.function.postprocessor.apt",
        WordClass::PostprocessorBare => "support.function.postprocessor.bare.apt",
        WordClass::Minor => "variable.other.enummember.minor.apt",
    }
}

/// A pattern for any of `words`, whole and in any case.
fn any_of(words: &[String]) -> String {
    let escaped: Vec<String> = words.iter().map(|word| word.replace('-', "\\-")).collect();
    format!("(?i)(?<![A-Za-z0-9_])(?:{})(?![A-Za-z0-9_])", escaped.join("|"))
}

/// Words that take the rest of the card as text: in columns 1-6 without any separator; elsewhere, as CL files have
/// them, with a blank or slash behind the word.
fn text_statements(words: &[String]) -> Value {
    let words = words.join("|");
    let captures = json!({
        "1": { "name": scope(WordClass::Text) },
        "2": { "name": "string.unquoted.text.apt" }
    });
    json!([
        { "match": format!("^((?i:{words}))(.*)$"), "captures": captures },
        { "match": format!("^\\s+((?i:{words}))(?=[\\s/])(.*)$"), "captures": captures }
    ])
}

/// The grammar as the text of a JSON file.
pub(super) fn grammar(vocabulary: &Vocabulary) -> String {
    let words: Vec<Value> = vocabulary
        .classes()
        .map(|class| json!({ "name": scope(class), "match": any_of(vocabulary.of(class)) }))
        .collect();
    let includes: Vec<Value> =
        ["text-statement", "comment", "label", "definition", "call", "number", "words", "operator", "symbol"]
            .iter()
            .map(|part| json!({ "include": format!("#{part}") }))
            .collect();
    let grammar = json!({
        "information_for_contributors": "Made from vocabulary.toml by `cargo xtask codegen`; do not edit.",
        "name": "APT",
        "scopeName": "source.apt",
        "patterns": includes,
        "repository": {
            "text-statement": { "patterns": text_statements(vocabulary.of(WordClass::Text)) },
            "comment": { "patterns": [
                {
                    "match": "(\\$\\s*\\$)(.*)$",
                    "name": "comment.line.double-dollar.apt",
                    "captures": { "1": { "name": "punctuation.definition.comment.apt" } }
                },
                {
                    "match": "(\\$)(.*)$",
                    "captures": {
                        "1": { "name": "punctuation.separator.continuation.apt" },
                        "2": { "name": "comment.line.continuation.apt" }
                    }
                }
            ] },
            "label": {
                "match": "^\\s*([A-Za-z0-9]+)\\s*(\\))",
                "captures": {
                    "1": { "name": "entity.name.label.apt" },
                    "2": { "name": "punctuation.separator.label.apt" }
                }
            },
            "definition": { "patterns": [
                {
                    "match": "(?<![A-Za-z0-9_])([A-Za-z0-9_]+)\\s*(=)\\s*((?i:MACRO))(?![A-Za-z0-9_])",
                    "captures": {
                        "1": { "name": "entity.name.function.macro.apt" },
                        "2": { "name": "keyword.operator.assignment.apt" },
                        "3": { "name": scope(WordClass::Logic) }
                    }
                },
                {
                    "match": "^\\s*([A-Za-z0-9_]+)(?:\\s*\\([^()=]*\\))?\\s*(?==)",
                    "captures": { "1": { "name": "variable.other.definition.apt" } }
                }
            ] },
            "call": {
                "match": "(?<![A-Za-z0-9_])((?i:CALL))\\s*(/)\\s*([A-Za-z0-9_]+)",
                "captures": {
                    "1": { "name": scope(WordClass::Logic) },
                    "2": { "name": "punctuation.separator.parameters.apt" },
                    "3": { "name": "entity.name.function.macro.apt" }
                }
            },
            "number": {
                // An exponent only behind a decimal point: 10E2 is a name.
                "match": "(?<![A-Za-z0-9_.])(?:\\d+\\.\\d*(?:[Ee][-+]?\\d+)?|\\.\\d+(?:[Ee][-+]?\\d+)?|\\d+(?![A-Za-z0-9_.]))",
                "name": "constant.numeric.apt"
            },
            "words": { "patterns": words },
            "operator": { "patterns": [
                { "match": "\\*\\*|[-+*]", "name": "keyword.operator.arithmetic.apt" },
                { "match": "=", "name": "keyword.operator.assignment.apt" },
                { "match": "/", "name": "punctuation.separator.parameters.apt" },
                { "match": ",", "name": "punctuation.separator.apt" },
                { "match": "[()]", "name": "punctuation.section.parens.apt" }
            ] },
            "symbol": { "match": "(?<![A-Za-z0-9_])[A-Za-z0-9_]+", "name": "variable.other.apt" }
        }
    });
    format!("{grammar:#}\n")
}

#[cfg(test)]
mod tests {
    use super::super::words::SAMPLE;
    use super::*;

    #[test]
    fn every_class_becomes_a_pattern() {
        let vocabulary = Vocabulary::parse(SAMPLE).expect("the sample is valid");
        let grammar: Value = serde_json::from_str(&grammar(&vocabulary)).expect("the grammar is JSON");
        let patterns = grammar["repository"]["words"]["patterns"].as_array().expect("a list");
        let found: Vec<&str> = patterns.iter().filter_map(|pattern| pattern["match"].as_str()).collect();
        assert!(found.iter().any(|p| p.contains("(?:GOLFT|GO)")), "{found:?}");
        assert!(found.iter().any(|p| p.contains("(?:END\\-OF\\-PATH)")), "{found:?}");
        assert_eq!(patterns.len(), 4);
    }

    #[test]
    fn the_grammar_agrees_with_the_semantic_tokens() {
        let package = crate::layout::vscode().join("package.json");
        let package = std::fs::read_to_string(package).expect("the extension has a package file");
        let package: Value = serde_json::from_str(&package).expect("the package file is JSON");
        let scopes = &package["contributes"]["semanticTokenScopes"][0]["scopes"];
        for (class, token) in [
            (WordClass::Text, "event"),
            (WordClass::Motion, "keyword"),
            (WordClass::ToolPosition, "keyword"),
            (WordClass::PathParameter, "keyword"),
            (WordClass::PathControl, "keyword"),
            (WordClass::Logic, "keyword"),
            (WordClass::Declaration, "keyword"),
            (WordClass::Transformation, "keyword"),
            (WordClass::InputOutput, "keyword"),
            (WordClass::SystemFlag, "keyword"),
            (WordClass::GeometricType, "type"),
            (WordClass::Function, "function"),
            (WordClass::Postprocessor, "event"),
            (WordClass::PostprocessorBare, "event"),
            (WordClass::Minor, "modifier"),
        ] {
            let token_scope = scopes[token][0].as_str().unwrap_or_default();
            let common = token_scope.strip_suffix(".apt").expect("a scope of the language");
            assert!(scope(class).starts_with(common), "{class:?}: {} and {token_scope}", scope(class));
        }
    }

    #[test]
    fn every_reference_has_a_definition() {
        let vocabulary = Vocabulary::parse(SAMPLE).expect("the sample is valid");
        let grammar: Value = serde_json::from_str(&grammar(&vocabulary)).expect("the grammar is JSON");
        for pattern in grammar["patterns"].as_array().expect("a list") {
            let name = pattern["include"].as_str().expect("a reference").trim_start_matches('#');
            assert!(grammar["repository"].get(name).is_some(), "{name}");
        }
    }
}
