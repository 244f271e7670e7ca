//! Hovers of calls and loops: what they execute.

use crate::{Analysis, Cancel, Cancelled};

/// Statements of an expansion that a hover shows; more would not be read.
const GREATEST_LINES: usize = 12;
/// Values and records of a program that is expanded for a hover: making them once more takes a millisecond or two.
const GREATEST_PROGRAM: usize = 2_000;
/// Levels of calls and loops that are opened.
const LEVELS: u32 = 1;

impl Analysis {
    /// What the CALL or loop at an offset of the program executes, one level deep.
    pub(super) fn expansion_markdown(&self, offset: usize, cancel: Cancel<'_>) -> Result<String, Cancelled> {
        let program = self.program(cancel)?;
        if program.record_count() + program.definitions().take(GREATEST_PROGRAM).count() > GREATEST_PROGRAM {
            return Ok(
                "\n\nexecutes what the command `apt.expand` shows; the program is too long for a hover"
                    .to_owned(),
            );
        }
        let expansion = self.expand(Some(offset), Some(LEVELS), cancel)?;
        let lines: Vec<&str> = expansion.text.lines().collect();
        if lines.is_empty() {
            return Ok("\n\nexecutes nothing".to_owned());
        }
        let shown = lines[..lines.len().min(GREATEST_LINES)].join("\n");
        let mut text = format!("\n\nexecutes:\n```apt\n{shown}\n```");
        if lines.len() > GREATEST_LINES {
            text.push_str(&format!("\n… {} more lines", lines.len() - GREATEST_LINES));
        }
        Ok(text)
    }
}
