//! The program with macros and loops unrolled, each line with its origin.

use apt_geometry::patience::{Aside, Patience, Waiting, put_away};
use apt_program::{ExpandedLine, Options, Origin, expand, expand_with_remarks};
use apt_run::{
    format::{FormatOptions, format_text},
    go_on,
};
use apt_syntax::{
    Dialect, StatementView, SyntaxTree, dialect::SequenceFieldRule, record::SEQUENCE_FIELD_COLUMN,
    statement::Body,
};

use crate::{Analysis, Cancel, Cancelled};

/// What unrolls a program: with the remarks in it or without.
type Unroll =
    fn(&SyntaxTree, &Options, Option<usize>, Option<u32>, &dyn Fn() -> bool) -> apt_program::Expansion;

/// An expansion.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// The expanded statements. On cards a statement that is longer than a card goes on in the next lines; elsewhere
    /// each has a line.
    pub text: String,
    /// The origin of each statement.
    pub origins: Vec<Origin>,
    /// The line, from 0, in which each statement begins.
    pub lines: Vec<usize>,
    /// Whether a remark may stand behind each statement: it would be part of a free text, and the end of a statement that goes on.
    pub room_behind: Vec<bool>,
}

impl Analysis {
    /// Expands the whole program, or the statement at an offset; `depth` limits how many levels of macros and loops
    /// are opened.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn expand(
        &self,
        offset: Option<usize>,
        depth: Option<u32>,
        cancel: Cancel<'_>,
    ) -> Result<Expansion, Cancelled> {
        self.expanded(offset, depth, expand, cancel)
    }

    /// Expands the statement at an offset with what is said in the loop or macro: behind a statement that has one remark,
    /// otherwise on lines of their own.
    pub(crate) fn expand_with_remarks(
        &self,
        offset: usize,
        depth: u32,
        cancel: Cancel<'_>,
    ) -> Result<Expansion, Cancelled> {
        self.expanded(Some(offset), Some(depth), expand_with_remarks, cancel)
    }

    fn expanded(
        &self,
        offset: Option<usize>,
        depth: Option<u32>,
        unroll: Unroll,
        cancel: Cancel<'_>,
    ) -> Result<Expansion, Cancelled> {
        let at = offset.and_then(|offset| self.statement_at(offset)).map(|(view, _)| view.index);
        let options = self.document().options();
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let expansion = unroll(self.document().tree(), &options, at, depth, &|| waiting.is_over());
        let expanded = Aside::from(expansion.lines);
        if waiting.has_given_up() {
            return Err(Cancelled);
        }
        let mut text = String::new();
        let mut origins = Aside::from(Vec::with_capacity(expanded.len()));
        let mut behind = None;
        for (index, line) in expanded.iter().enumerate() {
            go_on(patience, 1)?;
            if behind.is_none() && stands_behind(&expanded, index) {
                behind = Some(line.text.as_str());
                continue;
            }
            text.push_str(&line.text);
            if let Some(remark) = behind.take() {
                text.push(' ');
                text.push_str(remark);
            }
            text.push('\n');
            origins.push(line.origin.clone());
        }
        // Statements are neither made nor removed. What stands past the statement field of a card is lost there, so that
        // the statements are read without one until they are laid out for it.
        let dialect = self.document().tree().dialect();
        let on_cards = dialect.sequence_field == SequenceFieldRule::Always;
        let wrap = on_cards.then_some(SEQUENCE_FIELD_COLUMN - 1);
        let style = FormatOptions { wrap, ..FormatOptions::of(&dialect) };
        let unbounded = Dialect { sequence_field: SequenceFieldRule::Never, ..dialect };
        let formatted = format_text(&text, if on_cards { unbounded } else { dialect }, &style, patience)?;
        let read = parsed(&formatted, dialect, patience)?;
        let (text, tree) = if read.statement_count() == origins.len() {
            (formatted, read)
        } else {
            let tree = parsed(&text, dialect, patience)?;
            (text, tree)
        };
        let (lines, room_behind) = places(&tree, on_cards, patience)?;
        put_away(tree, lines.len());
        Ok(Expansion { text, origins: origins.taken(), lines, room_behind })
    }
}

/// Whether the line with an index is the one remark of the statement that the next line does.
fn stands_behind(lines: &[ExpandedLine], index: usize) -> bool {
    let is_of_next =
        |remark: &ExpandedLine, next: &ExpandedLine| remark.is_remark && same_statement(remark, next);
    let [Some(line), Some(next)] = [lines.get(index), lines.get(index + 1)] else { return false };
    let before = index.checked_sub(1).and_then(|before| lines.get(before));
    is_of_next(line, next) && !next.is_remark && !before.is_some_and(|before| is_of_next(before, line))
}

fn same_statement(one: &ExpandedLine, other: &ExpandedLine) -> bool {
    let (one, other) = (&one.origin, &other.origin);
    one.isn == other.isn && one.frame == other.frame && one.source == other.source
}

/// The least that a remark takes behind a statement: a blank and its sign.
const LEAST_REMARK: usize = 3;

fn parsed(text: &str, dialect: Dialect, patience: Patience<'_>) -> Result<SyntaxTree, Cancelled> {
    SyntaxTree::parse_until(text, dialect, &|| patience.is_over()).ok_or(Cancelled)
}

/// The line in which each statement of a text begins, and whether a remark may stand behind it.
fn places(
    tree: &SyntaxTree,
    on_cards: bool,
    patience: Patience<'_>,
) -> Result<(Vec<usize>, Vec<bool>), Cancelled> {
    let mut line = 0;
    let place = |view: StatementView| {
        go_on(patience, 1)?;
        let (first, count) = (line, view.text().lines().count());
        line += count;
        let width = view.text().trim_end().chars().count();
        let fits = !on_cards || width + LEAST_REMARK < SEQUENCE_FIELD_COLUMN;
        Ok((first, count <= 1 && fits && !ends_in_text(&view)))
    };
    tree.statements().map(place).collect()
}

/// Whether what stands behind a statement belongs to its free text.
fn ends_in_text(view: &StatementView) -> bool {
    let parsed = view.parsed();
    parsed.statement.parts.last().is_some_and(|part| matches!(part.body, Body::Text { .. }))
}
