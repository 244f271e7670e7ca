//! Statements that end something: FINI, TERMAC, LOOPND.

use apt_program::{Finding, RelatedKind};
use apt_syntax::{SyntaxTree, grammar::ParsedStatement, statement::Body, tree::StatementView};

use super::line_end;
use crate::diagnostic::Fix;

/// FINI behind the last statement.
pub(super) fn end_of_program(tree: &SyntaxTree) -> Option<Fix> {
    insertion(tree, tree.statement_count(), "FINI", "Add FINI", true)
}

/// The end of a block that the program never closes: before the first statement that cannot stand in it, or behind the
/// last statement.
pub(super) fn end_of_block(tree: &SyntaxTree, opening: usize, word: &'static str) -> Option<Fix> {
    let outside = (opening + 1..tree.statement_count())
        .find(|index| cannot_be_inside(&tree.statement(*index).parsed()));
    insertion(tree, outside.unwrap_or(tree.statement_count()), word, &format!("Add {word}"), false)
}

/// The end of the block that is still open where a statement cannot stand in one.
pub(super) fn end_before(view: &StatementView, parsed: &ParsedStatement, finding: &Finding) -> Vec<Fix> {
    let word = match finding.related.first().map(|(kind, _)| *kind) {
        Some(RelatedKind::Macro) => "TERMAC",
        Some(RelatedKind::Loop) => "LOOPND",
        _ => return Vec::new(),
    };
    if parsed.elements.is_empty() {
        return Vec::new();
    }
    let start = usize::from(view.start);
    let insert = format!("{word}{}", line_end(view.text()));
    vec![Fix { title: format!("Add {word} before it"), edits: vec![(start..start, insert)], preferred: true }]
}

fn cannot_be_inside(parsed: &ParsedStatement) -> bool {
    parsed.statement.parts.iter().any(|part| match &part.body {
        Body::Macro { .. } => true,
        Body::Major { word, .. } => matches!(word.word.spelling, "FINI" | "LOOPST" | "TERMAC" | "LOOPND"),
        _ => false,
    })
}

/// A statement on a line of its own before the statement with this index.
fn insertion(tree: &SyntaxTree, index: usize, word: &str, title: &str, preferred: bool) -> Option<Fix> {
    let before = index.checked_sub(1).map(|index| tree.statement(index))?;
    let text = before.text();
    let end = line_end(text);
    let last_line = text.lines().last().unwrap_or("");
    // A statement that goes on would take the word as its own.
    if !last_line.contains("$$") && last_line.contains('$') {
        return None;
    }
    let at = usize::from(before.range().end());
    let insert = match text.ends_with(['\n', '\r']) {
        true => format!("{word}{end}"),
        false => format!("{end}{word}{end}"),
    };
    Some(Fix { title: title.to_owned(), edits: vec![(at..at, insert)], preferred })
}
