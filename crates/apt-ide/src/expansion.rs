//! The program with macros and loops unrolled, each line with its origin.

use apt_program::{Origin, expand};
use apt_run::format::{FormatOptions, format_text};

use crate::{Analysis, Cancel, Cancelled};

/// An expansion.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// The expanded statements, one per line.
    pub text: String,
    /// The origin of each line.
    pub origins: Vec<Origin>,
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
        // Statements are neither made nor removed, and with nothing wrapped each stays on its line.
        let dialect = self.document().tree().dialect();
        let style = FormatOptions { wrap: None, ..FormatOptions::of(&dialect) };
        let formatted = format_text(&text, dialect, &style);
        let text = if formatted.lines().count() == origins.len() { formatted } else { text };
        Ok(Expansion { text, origins })
    }
}
