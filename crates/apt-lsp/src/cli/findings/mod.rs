//! Findings, in every format in which they are told.

pub(super) mod github;
pub(super) mod human;
pub(super) mod json;
pub(super) mod sarif;
#[cfg(test)]
mod tests;

use super::Outcome;
use super::console::Console;
use super::program::Program;
use crate::analysis::{Diagnostic, Severity};

/// A program with what was found in it.
pub(super) struct Checked {
    /// The program.
    pub program: Program,
    /// The findings.
    pub diagnostics: Vec<Diagnostic>,
}

/// How many there are of the kinds that count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Counts {
    /// Errors.
    pub errors: usize,
    /// Warnings.
    pub warnings: usize,
}

impl Counts {
    pub(super) fn of(checked: &[Checked]) -> Self {
        let all = || checked.iter().flat_map(|checked| &checked.diagnostics);
        Self {
            errors: all().filter(|found| found.severity == Severity::Error).count(),
            warnings: all().filter(|found| found.severity == Severity::Warning).count(),
        }
    }
}

/// What the findings mean for the exit code.
pub(super) fn outcome(checked: &[Checked], deny_warnings: bool) -> Outcome {
    let counts = Counts::of(checked);
    if counts.errors > 0 || (deny_warnings && counts.warnings > 0) {
        Outcome::Findings
    } else {
        Outcome::Clean
    }
}

/// Tells the findings of a program beside what was asked for, and what they mean for the exit code.
pub(super) fn tell(checked: Checked, deny_warnings: bool, console: &Console) -> Outcome {
    let checked = [checked];
    let text = human::text(&checked);
    if !text.is_empty() {
        console.tell(text.trim_end());
    }
    outcome(&checked, deny_warnings)
}
