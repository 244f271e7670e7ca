//! Findings as SARIF 2.1.0.

use std::collections::BTreeMap;
use std::path::Path;

use ropey::Rope;
use serde_json::{Value, json};
use serde_sarif::sarif;

use super::Checked;
use crate::analysis::{Diagnostic, Elsewhere, Fix, Language, Related, Severity};
use crate::cli::Outcome;
use crate::cli::console::Console;
use crate::cli::program::Program;
use crate::convert::TextIndex;
use crate::convert::outgoing::frame_text;

/// Writes the log to a file, or to standard output.
pub(in crate::cli) fn write(
    checked: &[Checked],
    file: Option<&Path>,
    console: &Console,
    language: &dyn Language,
) -> Outcome {
    match serde_json::to_string_pretty(&log(checked, language)) {
        Ok(text) => console.write(format!("{text}\n").as_bytes(), file),
        Err(error) => {
            console.error(&format!("SARIF: {error}"));
            Outcome::Unusable
        }
    }
}

/// The log, with one rule for each code that occurs.
pub(super) fn log(checked: &[Checked], language: &dyn Language) -> sarif::Sarif {
    let codes = rule_numbers(checked);
    let results: Vec<_> = checked
        .iter()
        .flat_map(|checked| checked.diagnostics.iter().map(|found| result(&checked.program, found, &codes)))
        .collect();
    let rules: Vec<_> = codes.keys().map(|code| rule(code, language)).collect();
    let driver = sarif::ToolComponent::builder()
        .name(env!("CARGO_PKG_NAME"))
        .version(env!("CARGO_PKG_VERSION"))
        .rules(rules)
        .build();
    let tool = sarif::Tool::builder().driver(driver).build();
    let run = sarif::Run::builder().tool(tool).results(results).column_kind(json!("utf16CodeUnits")).build();
    sarif::Sarif::builder()
        .version(json!("2.1.0"))
        .schema("https://json.schemastore.org/sarif-2.1.0.json")
        .runs(vec![run])
        .build()
}

/// The codes that occur, each with its place in the list of rules.
fn rule_numbers(checked: &[Checked]) -> BTreeMap<&str, i64> {
    let found = checked.iter().flat_map(|checked| &checked.diagnostics);
    let codes: std::collections::BTreeSet<&str> = found.map(|found| found.code.as_str()).collect();
    codes.into_iter().zip(0..).collect()
}

fn rule(code: &str, language: &dyn Language) -> sarif::ReportingDescriptor {
    let words = |text: String| sarif::MultiformatMessageString::builder().text(text).build();
    let title = language.title(code).unwrap_or_else(|| code.to_owned());
    let mut rule = sarif::ReportingDescriptor::builder().id(code).short_description(words(title)).build();
    rule.help = language
        .explain(code)
        .map(|page| sarif::MultiformatMessageString::builder().text(page.clone()).markdown(page).build());
    rule
}

fn result(program: &Program, found: &Diagnostic, codes: &BTreeMap<&str, i64>) -> sarif::Result {
    let text = match &found.hint {
        Some(hint) => format!("{}\nhelp: {hint}", found.message),
        None => found.message.clone(),
    };
    let level = match found.severity {
        Severity::Error => sarif::ResultLevel::Error,
        Severity::Warning => sarif::ResultLevel::Warning,
        Severity::Information | Severity::Hint => sarif::ResultLevel::Note,
    };
    let inside = |one: &Elsewhere| {
        let index = TextIndex { rope: Rope::from_str(&one.source.tree.text()), ..program.index.clone() };
        let file = artifact(&one.source.path.display().to_string());
        located(file, region(&index, &one.range), Some(&one.message))
    };
    let mut related: Vec<_> = found.elsewhere.iter().map(inside).collect();
    let beside = |one: &Related| location(program, &one.range, Some(&one.message));
    related.extend(found.related.iter().map(beside));
    related.extend(
        found
            .origin
            .iter()
            .filter_map(|frame| Some(location(program, frame.range.as_ref()?, Some(&frame_text(frame))))),
    );
    let mut result = sarif::Result::builder()
        .rule_id(found.code.as_str())
        .message(sarif::Message::builder().text(text).build())
        .level(level)
        .locations(vec![location(program, &found.range, None)])
        .build();
    result.rule_index = codes.get(found.code.as_str()).copied();
    result.related_locations = (!related.is_empty()).then_some(related);
    result.properties = Some(properties(found));
    let fixes: Vec<_> = found.fixes.iter().map(|one| fix(program, one)).collect();
    result.fixes = (!fixes.is_empty()).then_some(fixes);
    result
}

fn fix(program: &Program, found: &Fix) -> sarif::Fix {
    let replacement = |(range, text): &(std::ops::Range<usize>, String)| {
        sarif::Replacement::builder()
            .deleted_region(region(&program.index, range))
            .inserted_content(sarif::ArtifactContent::builder().text(text.as_str()).build())
            .build()
    };
    let change = sarif::ArtifactChange::builder()
        .artifact_location(artifact(&program.name))
        .replacements(found.edits.iter().map(replacement).collect::<Vec<_>>())
        .build();
    sarif::Fix::builder()
        .description(sarif::Message::builder().text(found.title.as_str()).build())
        .artifact_changes(vec![change])
        .build()
}

fn properties(found: &Diagnostic) -> sarif::PropertyBag {
    let facts: [(&str, Value); 2] = [("isn", json!(found.isn)), ("apt3", json!(found.apt3))];
    let known = facts.into_iter().filter(|(_, value)| !value.is_null());
    let additional: BTreeMap<String, Value> = known.map(|(name, value)| (name.to_owned(), value)).collect();
    sarif::PropertyBag::builder().additional_properties(additional).build()
}

fn region(index: &TextIndex, bytes: &std::ops::Range<usize>) -> sarif::Region {
    let range = index.range(bytes);
    sarif::Region::builder()
        .start_line(i64::from(range.start.line) + 1)
        .start_column(i64::from(range.start.character) + 1)
        .end_line(i64::from(range.end.line) + 1)
        .end_column(i64::from(range.end.character) + 1)
        .build()
}

fn artifact(name: &str) -> sarif::ArtifactLocation {
    sarif::ArtifactLocation::builder().uri(uri_reference(name)).build()
}

fn location(program: &Program, bytes: &std::ops::Range<usize>, message: Option<&str>) -> sarif::Location {
    located(artifact(&program.name), region(&program.index, bytes), message)
}

fn located(file: sarif::ArtifactLocation, region: sarif::Region, message: Option<&str>) -> sarif::Location {
    let place = sarif::PhysicalLocation::builder().artifact_location(file).region(region).build();
    let mut location = sarif::Location::builder().physical_location(place).build();
    location.message = message.map(|text| sarif::Message::builder().text(text).build());
    location
}

/// A path as a relative reference or, if it is absolute, a `file` URI.
fn uri_reference(path: &str) -> String {
    let mut uri = String::new();
    for byte in path.replace('\\', "/").bytes() {
        let plain = byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
        if plain {
            uri.push(char::from(byte));
        } else {
            uri.push_str(&format!("%{byte:02X}"));
        }
    }
    if uri.starts_with('/') { format!("file://{uri}") } else { uri }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_become_references() {
        assert_eq!(uri_reference("parts/a b.apt"), "parts/a%20b.apt");
        assert_eq!(uri_reference("/é.apt"), "file:///%C3%A9.apt");
        assert_eq!(uri_reference("<stdin>"), "%3Cstdin%3E");
    }
}
