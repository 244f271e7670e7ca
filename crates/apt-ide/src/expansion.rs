//! The program with macros and loops unrolled, each line with its origin.

use apt_program::{Origin, expand};
use apt_run::format::{FormatOptions, format_text};
use apt_syntax::{
    Dialect, StatementView, SyntaxTree, dialect::SequenceFieldRule, record::SEQUENCE_FIELD_COLUMN,
};

use crate::{Analysis, Cancel, Cancelled};

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
        let at = offset.and_then(|offset| self.statement_at(offset)).map(|(view, _)| view.index);
        let options = self.document().options();
        let expansion = expand(self.document().tree(), &options, at, depth, &cancel);
        if cancel() {
            return Err(Cancelled);
        }
        let mut text = String::new();
        let mut origins = Vec::with_capacity(expansion.lines.len());
        for line in expansion.lines {
            text.push_str(&line.text);
            text.push('\n');
            origins.push(line.origin);
        }
        // Statements are neither made nor removed. What stands past the statement field of a card is lost there, so that
        // the statements are read without one until they are laid out for it.
        let dialect = self.document().tree().dialect();
        let on_cards = dialect.sequence_field == SequenceFieldRule::Always;
        let wrap = on_cards.then_some(SEQUENCE_FIELD_COLUMN - 1);
        let style = FormatOptions { wrap, ..FormatOptions::of(&dialect) };
        let unbounded = Dialect { sequence_field: SequenceFieldRule::Never, ..dialect };
        let formatted = format_text(&text, if on_cards { unbounded } else { dialect }, &style);
        let lines = first_lines(&formatted, dialect);
        Ok(if lines.len() == origins.len() {
            Expansion { text: formatted, origins, lines }
        } else {
            let lines = (0..origins.len()).collect();
            Expansion { text, origins, lines }
        })
    }
}

/// The line in which each statement of a text begins.
fn first_lines(text: &str, dialect: Dialect) -> Vec<usize> {
    let tree = SyntaxTree::parse(text, dialect);
    let mut line = 0;
    let line_of = |view: StatementView| {
        let first = line;
        line += view.text().lines().count();
        first
    };
    tree.statements().map(line_of).collect()
}
