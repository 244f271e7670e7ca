//! Lints of statements as they are written.

use apt_syntax::{
    SyntaxKind, SyntaxTree, TextRange,
    dialect::DialectName,
    grammar::{JoinedElement, ParsedStatement},
    statement::ElementKind,
    tree::StatementView,
};

use super::{Lint, MISSING_COMMA, PAST_COLUMN_72};
use crate::{
    Severity, absolute,
    format::{FormatOptions, LAST_STATEMENT_COLUMN, LetterCase, format_range},
};

pub(super) fn lints(tree: &SyntaxTree) -> Vec<Lint> {
    let mut lints = Vec::new();
    if tree.dialect().name == DialectName::Cl {
        // Programs write these files; their lines are of any length.
        return lints;
    }
    for view in tree.statements() {
        let parsed = view.parsed();
        if !tree.sequence_field() {
            lints.extend(past_last_column(tree, &view));
        }
        if !parsed.is_broken() {
            lints.extend(parsed.joined.iter().filter_map(|joined| missing_comma(&view, &parsed, joined)));
        }
    }
    lints
}

/// Elements behind column 72, which card processors cut off in silence. A file with sequence fields has none.
fn past_last_column(tree: &SyntaxTree, view: &StatementView) -> Option<Lint> {
    let text = view.text();
    if text.len() <= LAST_STATEMENT_COLUMN {
        return None;
    }
    let mut line_start = 0;
    for line in text.split_inclusive(['\n', '\r']) {
        let cut = line.char_indices().nth(LAST_STATEMENT_COLUMN).map(|(offset, _)| line_start + offset);
        line_start += line.len();
        let Some(cut) = cut else { continue };
        let cut_off = |token: &apt_syntax::tree::TokenView| {
            let range = std::ops::Range::<usize>::from(token.range);
            let counts = !token.kind.is_trivia() || token.kind == SyntaxKind::Continuation;
            // A text that is too long cannot be continued.
            let counts = counts && token.kind != SyntaxKind::Text;
            counts && range.end > cut && range.end <= line_start
        };
        let tokens = view.tokens();
        let Some(last) = tokens.iter().rfind(|token| cut_off(token)) else { continue };
        let end = std::ops::Range::<usize>::from(last.range).end;
        let start = usize::from(view.start);
        let options = FormatOptions {
            wrap: Some(LAST_STATEMENT_COLUMN),
            letter_case: LetterCase::Keep,
            ..FormatOptions::default()
        };
        return Some(Lint {
            code: PAST_COLUMN_72,
            severity: Severity::Hint,
            statement: view.index,
            range: start + cut..start + end,
            message: "this stands behind column 72, where processors that read cards cut it off".to_owned(),
            hint: Some("continue the statement with $ on the next line".to_owned()),
            fix: format_range(tree, start..start + text.len(), &options),
        });
    }
    None
}

/// A number or name in a list that blanks divide: the language reads one element.
fn missing_comma(view: &StatementView, parsed: &ParsedStatement, joined: &JoinedElement) -> Option<Lint> {
    let index = parsed.elements.iter().position(|element| element.range == joined.range)?;
    let element = parsed.elements.get(index)?;
    let in_list = parsed.elements.get(..index)?.iter().any(|before| before.kind == ElementKind::Slash);
    let suspicious = match element.kind {
        ElementKind::Number => true,
        // Each piece alone would be a name or a word.
        ElementKind::Name => {
            joined.pieces.iter().all(|piece| piece.starts_with(|first: char| first.is_ascii_alphabetic()))
        }
        _ => false,
    };
    if !in_list || !suspicious {
        return None;
    }
    let pieces: Vec<TextRange> = view
        .tokens()
        .iter()
        .filter(|token| token.element == Some(index) && !token.kind.is_trivia())
        .map(|token| token.range)
        .collect();
    let gaps = || pieces.windows(2).map(|pair| TextRange::new(pair[0].end(), pair[1].start()));
    // An element that goes on behind a `$` was divided on purpose.
    let blank = |gap: TextRange| {
        let between = view.text().get(std::ops::Range::<usize>::from(gap)).unwrap_or("");
        !between.is_empty() && between.chars().all(|character| matches!(character, ' ' | '\t'))
    };
    if pieces.len() < 2 || !gaps().all(blank) {
        return None;
    }
    Some(Lint {
        code: MISSING_COMMA,
        severity: Severity::Warning,
        statement: view.index,
        range: absolute(view, joined.range),
        message: format!("{} is read as one, {}", joined.pieces.join(" "), element.text),
        hint: Some("blanks mean nothing: write a comma, or close the gap".to_owned()),
        fix: gaps().map(|gap| (absolute(view, gap), ",".to_owned())).collect(),
    })
}
