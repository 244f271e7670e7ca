//! Stretches of statements that are executed as a whole: loop regions and macro bodies, with their labels and jumps.

mod run;
mod substitute;

use std::{collections::BTreeMap, sync::Arc};

use apt_syntax::{ParsedStatement, statement::Body};
use smol_str::SmolStr;

pub(crate) use run::{Activation, DoLoop};
pub(crate) use substitute::Bindings;

/// Statements with consecutive numbers, and where their labels are.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    /// Number of the first statement.
    pub(crate) first_isn: u32,
    /// The statements; the last is LOOPND or TERMAC, kept for its label.
    pub(crate) statements: Vec<Arc<ParsedStatement>>,
    /// Content hashes of the statements, to tell whether two blocks say the same.
    pub(crate) hashes: Vec<u64>,
    labels: BTreeMap<SmolStr, usize>,
}

impl Block {
    /// An empty block that begins with this statement number.
    pub(crate) fn new(first_isn: u32) -> Self {
        Self { first_isn, statements: Vec::new(), hashes: Vec::new(), labels: BTreeMap::new() }
    }

    /// Adds a statement; the first use of a label counts. Returns whether the label is new.
    pub(crate) fn push(&mut self, statement: Arc<ParsedStatement>, hash: u64) -> bool {
        let index = self.statements.len();
        let mut is_new = true;
        if let Some(label) = &statement.statement.label {
            let label = normalised_label(&label.text);
            is_new = !self.labels.contains_key(&label);
            self.labels.entry(label).or_insert(index);
        }
        self.statements.push(statement);
        self.hashes.push(hash);
        is_new
    }

    /// The index of the statement that carries a label.
    pub(crate) fn label(&self, label: &str) -> Option<usize> {
        self.labels.get(&normalised_label(label)).copied()
    }

    /// The labels.
    pub(crate) fn labels(&self) -> impl Iterator<Item = &str> {
        self.labels.keys().map(SmolStr::as_str)
    }

    /// The statement number of a statement.
    pub(crate) fn isn(&self, index: usize) -> u32 {
        self.first_isn.saturating_add(u32::try_from(index).unwrap_or(u32::MAX))
    }
}

/// Labels that are numbers are compared by value: `01` is `1`.
pub(crate) fn normalised_label(label: &str) -> SmolStr {
    if label.bytes().all(|byte| byte.is_ascii_digit()) {
        let trimmed = label.trim_start_matches('0');
        return SmolStr::new(if trimmed.is_empty() && !label.is_empty() { "0" } else { trimmed });
    }
    SmolStr::new(label)
}

/// The word of a statement that is a single major word, such as LOOPND.
pub(crate) fn single_word(statement: &ParsedStatement) -> Option<&'static str> {
    match statement.statement.parts.first().map(|part| &part.body) {
        Some(Body::Major { word, .. }) => Some(word.word.spelling),
        _ => None,
    }
}

/// Whether a statement is a macro header.
pub(crate) fn is_macro_header(statement: &ParsedStatement) -> bool {
    matches!(statement.statement.parts.first().map(|part| &part.body), Some(Body::Macro { .. }))
}

#[cfg(test)]
mod tests {
    use super::normalised_label;

    #[test]
    fn labels_that_are_numbers_are_compared_by_value() {
        assert_eq!(normalised_label("01"), "1");
        assert_eq!(normalised_label("000"), "0");
        assert_eq!(normalised_label("0A"), "0A");
        assert_eq!(normalised_label(""), "");
    }
}
