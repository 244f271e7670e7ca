//! Lints: what is allowed and yet probably not meant. Only what can be decided surely is told.
//!
//! [`text`] looks at statements as they are written, [`path`] at the records in order of execution. [`allow`] takes out
//! what the author has looked at: `$$ apt-lsp: allow APT0952` on the statement or on the comment before it, and
//! `$$ apt-lsp: allow-file APT0951` anywhere for the whole file.

mod allow;
mod path;
mod text;

#[cfg(test)]
mod tests;

use std::ops::Range;

use apt_program::Program;
use apt_syntax::SyntaxTree;

use crate::{Severity, format::Edit};

/// The statement runs past column 72.
pub const PAST_COLUMN_72: &str = "APT0951";
/// Blanks divide what is read as one name or number.
pub const MISSING_COMMA: &str = "APT0952";
/// The tolerances are wide in comparison to the cutter.
pub const LOOSE_TOLERANCE: &str = "APT0953";
/// A motion along a curved part surface without tolerances.
pub const TOLERANCE_MISSING: &str = "APT0954";
/// A motion along surfaces before any feed rate.
pub const FEED_MISSING: &str = "APT0955";
/// No motion feels the THICK.
pub const THICKNESS_WITHOUT_EFFECT: &str = "APT0956";
/// A direction that another one replaces before a motion.
pub const DIRECTION_WITHOUT_EFFECT: &str = "APT0957";
/// One tool number with two cutters.
pub const CUTTER_AND_TOOL: &str = "APT0958";

/// All codes of this module, ascending.
pub const CODES: [&str; 8] = [
    PAST_COLUMN_72,
    MISSING_COMMA,
    LOOSE_TOLERANCE,
    TOLERANCE_MISSING,
    FEED_MISSING,
    THICKNESS_WITHOUT_EFFECT,
    DIRECTION_WITHOUT_EFFECT,
    CUTTER_AND_TOOL,
];

/// One finding.
#[derive(Debug, Clone, PartialEq)]
pub struct Lint {
    /// Its stable code, one of [`CODES`].
    pub code: &'static str,
    /// How grave.
    pub severity: Severity,
    /// The index of the statement.
    pub statement: usize,
    /// Where, bytes of the text.
    pub range: Range<usize>,
    /// What is odd.
    pub message: String,
    /// What would help.
    pub hint: Option<String>,
    /// Edits that settle it, in order of the text; empty if only the author can.
    pub fix: Vec<Edit>,
}

/// The lints of a program, in order of their place; each stands once, however often its statement is executed.
pub fn lint(tree: &SyntaxTree, program: &Program) -> Vec<Lint> {
    let mut lints = text::lints(tree);
    lints.extend(path::lints(tree, program));
    allow::remove_allowed(tree, &mut lints);
    lints.sort_by(|a, b| (a.range.start, a.code, a.range.end).cmp(&(b.range.start, b.code, b.range.end)));
    lints.dedup_by(|a, b| a.code == b.code && a.range == b.range);
    lints
}
