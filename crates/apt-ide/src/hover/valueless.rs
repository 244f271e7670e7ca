//! Hovers of names without a value: who should give them one, and why nobody does.

use apt_syntax::{dialect::DialectName, vocabulary::lookup};

use super::word_markdown;
use crate::{
    Analysis, Cancel, Cancelled, Diagnostic, Level, Severity,
    navigation::{NameAt, Spot, statement_at},
};

/// More statements than this would not be read.
const GREATEST_STATEMENTS: usize = 4;

impl Analysis {
    /// What is to be said about a name that has no value; nothing in a CL file, where a name that is none of the language is a text.
    pub(super) fn valueless_markdown(
        &self,
        spot: Spot<'_>,
        at: &NameAt,
        cancel: Cancel<'_>,
    ) -> Result<Option<String>, Cancelled> {
        if self.document().tree().dialect().name == DialectName::Cl {
            return Ok(None);
        }
        let Some(program) = self.files().first() else { return Ok(None) };
        let mut text = format!("`{}` has no value", at.name);
        let places = self.occurrences_everywhere(spot, cancel)?;
        let mut giving: Vec<u32> = Vec::new();
        let mut elsewhere = false;
        for one in places.iter().filter(|one| one.occurrence.defines) {
            match (&one.source, statement_at(&program.tree, one.occurrence.range.start)) {
                (None, Some((view, _))) => giving.push(view.isn()),
                _ => elsewhere = true,
            }
        }
        giving.dedup();
        // A word that the dialect does not reserve, as INCLUD, is a name only where it is given a value.
        if giving.is_empty()
            && !elsewhere
            && let Some(word) = lookup(&at.name)
        {
            return Ok(Some(word_markdown(word)));
        }
        if giving.is_empty() {
            text.push_str(if elsewhere {
                "; an included file should give it one"
            } else {
                ": no statement gives it one"
            });
            return Ok(Some(text));
        }
        let found = self.diagnostics(Level::Section1, cancel, &mut |_, _| {})?;
        text.push(':');
        for isn in giving.iter().take(GREATEST_STATEMENTS) {
            let is_reason = |one: &&Diagnostic| {
                one.severity == Severity::Error && one.origin.source.is_none() && one.origin.isn == *isn
            };
            let mut mistakes = found.iter().filter(is_reason).peekable();
            if mistakes.peek().is_none() {
                text.push_str(&format!("\n- statement {isn} gives it none"));
            }
            for one in mistakes {
                text.push_str(&format!(
                    "\n- statement {isn}: {} ({})",
                    one.wording.message, one.wording.code
                ));
            }
        }
        if giving.len() > GREATEST_STATEMENTS {
            text.push_str(&format!("\n- … {} more", giving.len() - GREATEST_STATEMENTS));
        }
        Ok(Some(text))
    }
}
