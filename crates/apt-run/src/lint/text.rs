//! Lints of statements as they are written.

use apt_program::Origin;
use apt_syntax::{
    SyntaxKind, SyntaxTree, TextRange, TextSize,
    grammar::{JoinedElement, ParsedStatement},
    statement::ElementKind,
    tree::{StatementView, TokenView},
};

use super::{Lint, LintKind};
use crate::{
    diagnostic::Fix,
    format::{LAST_STATEMENT_COLUMN, wrap_statement},
};

/// In a program with more long statements than this nobody thinks of cards: the last of them speaks for the others.
const MOST_PAST_LAST_COLUMN: usize = 50;

pub(super) fn lints(tree: &SyntaxTree) -> Vec<Lint> {
    let mut lints = Vec::new();
    let mut long = 0;
    for view in tree.statements() {
        if !tree.sequence_field() && long < MOST_PAST_LAST_COLUMN && reaches_past_last_column(view.text()) {
            let found = past_last_column(tree, &view, long + 1 == MOST_PAST_LAST_COLUMN);
            long += usize::from(found.is_some());
            lints.extend(found);
        }
        if has_divided_letters(view.text()) {
            let parsed = view.parsed();
            if !parsed.is_broken() {
                lints.extend(parsed.joined.iter().filter_map(|joined| missing_comma(&view, &parsed, joined)));
            }
        }
    }
    lints
}

/// A first look, without reading the statement: whether a line of it is long.
fn reaches_past_last_column(text: &str) -> bool {
    text.len() > LAST_STATEMENT_COLUMN && text.lines().any(|line| line.len() > LAST_STATEMENT_COLUMN)
}

/// A first look, without reading the statement: whether blanks stand between two letters or digits.
fn has_divided_letters(text: &str) -> bool {
    let is_blank = |byte: &u8| matches!(byte, b' ' | b'\t');
    let bytes = text.as_bytes();
    bytes.windows(2).enumerate().any(|(at, pair)| {
        matches!(pair, [letter, blank] if letter.is_ascii_alphanumeric() && is_blank(blank))
            && bytes
                .iter()
                .skip(at + 1)
                .find(|byte| !is_blank(byte))
                .is_some_and(|next| next.is_ascii_alphanumeric())
    })
}

/// Elements behind column 72, which card processors cut off in silence. A file with sequence fields has none.
fn past_last_column(tree: &SyntaxTree, view: &StatementView, and_others: bool) -> Option<Lint> {
    let mut line_start = 0;
    for line in view.text().split_inclusive(['\n', '\r']) {
        let cut = line.char_indices().nth(LAST_STATEMENT_COLUMN).map(|(offset, _)| line_start + offset);
        line_start += line.len();
        let Some(cut) = cut else { continue };
        let cut_off = |token: &TokenView| {
            let range = std::ops::Range::<usize>::from(token.range);
            let counts = !token.kind.is_trivia() || token.kind == SyntaxKind::Continuation;
            // A text that is too long cannot be continued.
            let counts = counts && token.kind != SyntaxKind::Text;
            counts && range.end > cut && range.end <= line_start
        };
        let tokens = view.tokens();
        let Some(last) = tokens.iter().rfind(|token| cut_off(token)) else { continue };
        let start = TextSize::new(u32::try_from(cut).unwrap_or(u32::MAX));
        let edits = wrap_statement(tree, view);
        let title = "Continue the statement on the next line".to_owned();
        return Some(Lint {
            kind: LintKind::PastLastColumn { and_others },
            origin: Origin::in_program(
                view.isn(),
                TextRange::new(start.min(last.range.end()), last.range.end()),
            ),
            other: None,
            fixes: if edits.is_empty() { Vec::new() } else { vec![Fix { title, edits, preferred: true }] },
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
    let gaps: Vec<TextRange> = pieces
        .iter()
        .zip(pieces.iter().skip(1))
        .map(|(left, right)| TextRange::new(left.end(), right.start()))
        .collect();
    // An element that goes on behind a `$` was divided on purpose.
    let blank = |gap: &TextRange| {
        let between = view.text().get(std::ops::Range::<usize>::from(*gap)).unwrap_or("");
        !between.is_empty() && between.chars().all(|character| matches!(character, ' ' | '\t'))
    };
    if gaps.is_empty() || !gaps.iter().all(blank) {
        return None;
    }
    let start = usize::from(view.start);
    let filled = |insert: &str| {
        let edit = |gap: &TextRange| {
            let gap = std::ops::Range::<usize>::from(*gap);
            (start + gap.start..start + gap.end, insert.to_owned())
        };
        gaps.iter().map(edit).collect()
    };
    let read_as = element.text.clone();
    let fixes = vec![
        Fix { title: "Insert the comma".to_owned(), edits: filled(","), preferred: false },
        Fix { title: format!("Write {read_as} without blanks"), edits: filled(""), preferred: false },
    ];
    Some(Lint {
        kind: LintKind::BlanksInside { pieces: joined.pieces.clone(), read_as },
        origin: Origin::in_program(view.isn(), joined.range),
        other: None,
        fixes,
    })
}
