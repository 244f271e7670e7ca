//! Stretches of statements that are executed as a whole: loop regions and macro bodies, with their labels and jumps.

mod branches;
mod clause;
mod endless;
mod run;
mod substitute;

use std::{collections::BTreeMap, sync::Arc};

use apt_syntax::{
    ParsedStatement, TextRange,
    statement::{Body, Element, ElementKind, Name, Part},
};
use smol_str::SmolStr;

use crate::{record::SourceFile, statements::leaves_motion};

pub(crate) use branches::{BranchFinder, Branches, ClauseFault, ClauseMark, ClausePlace, clause_mark};
pub(crate) use run::{Activation, DoHeader, DoLoop};
pub(crate) use substitute::{Bindings, splice};

/// Statements with consecutive numbers, and where their labels are.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    /// Number of the first statement.
    pub(crate) first_isn: u32,
    /// The included file that the statements stand in.
    pub(crate) source: Option<Arc<SourceFile>>,
    /// The statements; the last is LOOPND or TERMAC, kept for its label.
    pub(crate) statements: Vec<Arc<ParsedStatement>>,
    /// Content hashes of the statements, to tell whether two blocks say the same.
    pub(crate) hashes: Vec<u64>,
    labels: BTreeMap<SmolStr, usize>,
    /// The branches of IFs over several statements.
    pub(crate) branches: Branches,
}

impl Block {
    /// An empty block that begins with this statement number of a file.
    pub(crate) fn new(first_isn: u32, source: Option<Arc<SourceFile>>) -> Self {
        Self {
            first_isn,
            source,
            statements: Vec::new(),
            hashes: Vec::new(),
            labels: BTreeMap::new(),
            branches: Branches::default(),
        }
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

    /// Lets the label of the LOOPST before the block stand for the block's first statement, unless a statement of the
    /// block carries it: no jump from outside comes to a loop, so a label there can only be meant for jumps back to the
    /// beginning.
    pub(crate) fn name_beginning(&mut self, label: &str) {
        self.labels.entry(normalised_label(label)).or_insert(0);
    }

    /// The index of the statement that carries a label.
    pub(crate) fn label(&self, label: &str) -> Option<usize> {
        self.labels.get(&normalised_label(label)).copied()
    }

    /// The labels.
    pub(crate) fn labels(&self) -> impl Iterator<Item = &str> {
        self.labels.keys().map(SmolStr::as_str)
    }

    /// Whether a statement of the block may give the name a value: as a target, or by handing it to another macro.
    pub(crate) fn may_assign(&self, name: &str) -> bool {
        self.statements.iter().any(|statement| {
            let elements = &statement.elements;
            (0..elements.len()).any(|index| {
                let named = elements[index].text == name;
                named && (is_target(elements, index) || is_handed_over(elements, index))
            })
        })
    }

    /// Whether a statement of the block moves the tool.
    pub(crate) fn moves(&self) -> bool {
        self.statements.iter().any(|statement| says_motion(&statement.elements))
    }

    /// Statements without label after one that always jumps: they are never reached.
    pub(crate) fn unreachable(&self) -> Vec<(u32, TextRange)> {
        let mut found = Vec::new();
        let mut after_jump = false;
        for (index, statement) in self.statements.iter().enumerate() {
            let Some(part) = statement.statement.parts.first() else { continue };
            if after_jump && statement.statement.label.is_none() && wants_to_be_reached(part) {
                found.push((self.isn(index), part.range));
            }
            after_jump = always_jumps(statement);
        }
        found
    }

    /// The labels that IF and JUMPTO name and no statement of the block carries, with their statement numbers. Names for
    /// which `is_variable` says so are replaced when the block is executed.
    pub(crate) fn missing_labels(&self, is_variable: &dyn Fn(&str) -> bool) -> Vec<(u32, Name)> {
        let mut missing = Vec::new();
        for (index, statement) in self.statements.iter().enumerate() {
            let named = statement.statement.parts.iter().flat_map(|part| labels_named(&part.body));
            for label in named.filter(|label| !is_variable(&label.text) && self.label(&label.text).is_none())
            {
                missing.push((self.isn(index), label.clone()));
            }
        }
        missing
    }

    /// The labels to which IF and JUMPTO would jump into a branch from outside, with the statement numbers of the jumps.
    pub(crate) fn jumps_into_branches(&self) -> Vec<(u32, Name)> {
        let mut jumps = Vec::new();
        for (index, statement) in self.statements.iter().enumerate() {
            let named = statement.statement.parts.iter().flat_map(|part| labels_named(&part.body));
            let into = |label: &&Name| {
                self.label(&label.text).is_some_and(|target| !self.branches.may_jump(index, target))
            };
            jumps.extend(named.filter(into).map(|label| (self.isn(index), label.clone())));
        }
        jumps
    }

    /// The statement number of a statement.
    pub(crate) fn isn(&self, index: usize) -> u32 {
        self.first_isn.saturating_add(u32::try_from(index).unwrap_or(u32::MAX))
    }
}

/// The labels of its own region that a statement part may jump to.
fn labels_named(body: &Body) -> &[Name] {
    match body {
        Body::ArithmeticIf { labels, .. } => labels,
        Body::Jump { word, label } if word.word.spelling == "JUMPTO" => std::slice::from_ref(label),
        Body::LogicalIf { then, .. } => then.last().map_or(&[], |part| labels_named(&part.body)),
        _ => &[],
    }
}

/// Whether the element at `index` is a name before `=`, with or without a subscript.
pub(crate) fn is_target(elements: &[Element], index: usize) -> bool {
    let mut depth = 0_u32;
    for element in elements.get(index + 1..).unwrap_or_default() {
        match element.kind {
            ElementKind::LeftParenthesis => depth += 1,
            ElementKind::RightParenthesis if depth == 0 => return false,
            ElementKind::RightParenthesis => depth -= 1,
            ElementKind::Equals if depth == 0 => return true,
            _ if depth == 0 => return false,
            _ => {}
        }
    }
    false
}

/// Whether the element at `index` is a value of a CALL: the macro may then assign to it.
fn is_handed_over(elements: &[Element], index: usize) -> bool {
    let before = index.checked_sub(1).and_then(|before| elements.get(before));
    before.is_some_and(|before| before.kind == ElementKind::Equals)
        && elements.iter().any(|element| element.kind == ElementKind::Word && element.text == "CALL")
}

/// Labels that are numbers are compared by value: `01` is `1`.
pub(crate) fn normalised_label(label: &str) -> SmolStr {
    if label.bytes().all(|byte| byte.is_ascii_digit()) {
        let trimmed = label.trim_start_matches('0');
        return SmolStr::new(if trimmed.is_empty() && !label.is_empty() { "0" } else { trimmed });
    }
    SmolStr::new(label)
}

/// Whether the words of a statement say that the tool moves.
pub(crate) fn says_motion(elements: &[Element]) -> bool {
    elements.iter().any(|element| element.kind == ElementKind::Word && leaves_motion(&element.text))
}

/// Whether a statement always leads somewhere else than to the next one.
pub(crate) fn always_jumps(statement: &ParsedStatement) -> bool {
    match statement.statement.parts.last().map(|part| &part.body) {
        Some(Body::Jump { word, .. }) => word.word.spelling == "JUMPTO",
        Some(Body::ArithmeticIf { .. }) => true,
        _ => false,
    }
}

/// Whether a statement does something that is missed when it is never reached.
pub(crate) fn wants_to_be_reached(part: &Part) -> bool {
    match &part.body {
        Body::Text { .. } | Body::Macro { .. } | Body::Clause { .. } | Body::Error => false,
        Body::Major { word, .. } => {
            !matches!(word.word.spelling, "LOOPST" | "LOOPND" | "TERMAC" | "FINI" | "CONTIN")
        }
        _ => true,
    }
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
