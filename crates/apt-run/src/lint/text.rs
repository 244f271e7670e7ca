//! Lints of statements as they are written.

use apt_program::Origin;
use apt_syntax::{
    SyntaxKind, SyntaxTree, TextRange, TextSize,
    grammar::{JoinedElement, ParsedStatement},
    statement::ElementKind,
    tree::{StatementView, TokenView},
};

use smol_str::SmolStr;

use super::{Lint, LintKind};
use crate::{
    diagnostic::Fix,
    format::{LAST_STATEMENT_COLUMN, wrap_statement},
};

/// In a program with more long statements than this nobody thinks of cards: the last of them speaks for the others.
const MOST_PAST_LAST_COLUMN: usize = 50;

/// Something odd in one statement. Places are relative to it.
#[derive(Debug)]
pub(super) struct TextNote {
    /// The statement, counted from the first of its block.
    pub(super) local: u32,
    /// What.
    pub(super) odd: Odd,
}

/// What can be odd in the way in which a statement is written.
#[derive(Debug)]
pub(super) enum Odd {
    /// Elements stand behind column 72.
    PastLastColumn(TextRange),
    /// Blanks divide an element of a list.
    BlanksInside {
        /// The element.
        place: TextRange,
        /// The blanks.
        gaps: Box<[TextRange]>,
        /// The pieces.
        pieces: Vec<SmolStr>,
        /// What they are read as.
        read_as: SmolStr,
    },
}

/// What is odd in a statement.
pub(super) fn notes(local: u32, view: &StatementView, parsed: &ParsedStatement) -> Vec<TextNote> {
    let mut notes = Vec::new();
    if reaches_past_last_column(view.text()) {
        notes.extend(past_last_column(view).map(Odd::PastLastColumn));
    }
    if !parsed.joined.is_empty() && !parsed.is_broken() {
        notes.extend(parsed.joined.iter().filter_map(|joined| missing_comma(view, parsed, joined)));
    }
    notes.into_iter().map(|odd| TextNote { local, odd }).collect()
}

/// The notes of all blocks as lints, in the order of the program.
pub(super) struct TextLints<'a> {
    tree: &'a SyntaxTree,
    long: usize,
    lints: Vec<Lint>,
}

impl<'a> TextLints<'a> {
    pub(super) fn new(tree: &'a SyntaxTree) -> Self {
        Self { tree, long: 0, lints: Vec::new() }
    }

    /// The notes of the next block, whose first statement has this index.
    pub(super) fn block(&mut self, first_statement: usize, notes: &[TextNote]) {
        for note in notes {
            let view = self.tree.statement(first_statement + note.local as usize);
            match &note.odd {
                Odd::PastLastColumn(place) => {
                    // A file with sequence fields has none: they stand there.
                    if self.tree.sequence_field() || self.long == MOST_PAST_LAST_COLUMN {
                        continue;
                    }
                    self.long += 1;
                    let and_others = self.long == MOST_PAST_LAST_COLUMN;
                    let edits = wrap_statement(self.tree, &view);
                    let title = "Continue the statement on the next line".to_owned();
                    let fix = Fix { title, edits, preferred: true };
                    self.lints.push(Lint {
                        kind: LintKind::PastLastColumn { and_others },
                        origin: Origin::in_program(view.isn(), *place),
                        other: None,
                        fixes: if fix.edits.is_empty() { Vec::new() } else { vec![fix] },
                    });
                }
                Odd::BlanksInside { place, gaps, pieces, read_as } => {
                    self.lints.push(blanks_inside(&view, *place, gaps, pieces, read_as));
                }
            }
        }
    }

    /// What was found.
    pub(super) fn lints(self) -> Vec<Lint> {
        self.lints
    }
}

/// A first look, without reading the statement: whether a line of it is long.
fn reaches_past_last_column(text: &str) -> bool {
    text.len() > LAST_STATEMENT_COLUMN && text.lines().any(|line| line.len() > LAST_STATEMENT_COLUMN)
}

/// The elements behind column 72, which card processors cut off in silence.
fn past_last_column(view: &StatementView) -> Option<TextRange> {
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
        return Some(TextRange::new(start.min(last.range.end()), last.range.end()));
    }
    None
}

/// A number or name in a list that blanks divide: the language reads one element.
fn missing_comma(view: &StatementView, parsed: &ParsedStatement, joined: &JoinedElement) -> Option<Odd> {
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
    let gaps: Box<[TextRange]> = pieces
        .iter()
        .zip(pieces.iter().skip(1))
        .map(|(left, right)| TextRange::new(left.end(), right.start()))
        .collect();
    // An element that goes on behind a `$` was divided on purpose.
    let blank = |gap: &TextRange| {
        let between = view.text().get(std::ops::Range::<usize>::from(*gap)).unwrap_or("");
        !between.is_empty() && between.chars().all(|character| matches!(character, ' ' | '\t'))
    };
    let divided = !gaps.is_empty() && gaps.iter().all(blank);
    let (pieces, read_as) = (joined.pieces.clone(), element.text.clone());
    divided.then_some(Odd::BlanksInside { place: joined.range, gaps, pieces, read_as })
}

fn blanks_inside(
    view: &StatementView,
    place: TextRange,
    gaps: &[TextRange],
    pieces: &[SmolStr],
    read_as: &SmolStr,
) -> Lint {
    let start = usize::from(view.start);
    let filled = |insert: &str| {
        let edit = |gap: &TextRange| {
            let gap = std::ops::Range::<usize>::from(*gap);
            (start + gap.start..start + gap.end, insert.to_owned())
        };
        gaps.iter().map(edit).collect()
    };
    let fixes = vec![
        Fix { title: "Insert the comma".to_owned(), edits: filled(","), preferred: false },
        Fix { title: format!("Write {read_as} without blanks"), edits: filled(""), preferred: false },
    ];
    Lint {
        kind: LintKind::BlanksInside { pieces: pieces.to_vec(), read_as: read_as.clone() },
        origin: Origin::in_program(view.isn(), place),
        other: None,
        fixes,
    }
}
