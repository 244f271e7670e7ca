//! The program with macros and loops unrolled: each executed statement as text, with its origin.

use apt_syntax::{
    SyntaxTree,
    statement::{Element, ElementKind},
};

use crate::{
    evaluator::{Evaluator, State, TopLevel, Trace, TracedLine},
    options::Options,
    record::{Frame, Origin},
};

/// An unrolled program.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Expansion {
    /// The statements in order of execution. Jumps, loop words, macro bodies and calls leave no line of their own.
    pub lines: Vec<ExpandedLine>,
}

/// One executed statement.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpandedLine {
    /// The statement in canonical spelling: upper case, no blanks but those of texts, macro variables replaced.
    pub text: String,
    /// Where it comes from, with the macro calls and loop turns around it.
    pub origin: Origin,
}

impl Expansion {
    /// The lines as a text.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for line in &self.lines {
            text.push_str(&line.text);
            text.push('\n');
        }
        text
    }
}

/// Unrolls a program.
///
/// With `at` only what the statement with this index (from 0) executes is given: the body of a call, the turns of a
/// loop. With `depth` calls and loops nested deeper than this are left out.
pub fn expand(
    tree: &SyntaxTree,
    options: &Options,
    at: Option<usize>,
    depth: Option<u32>,
    cancel: &dyn Fn() -> bool,
) -> Expansion {
    let mut evaluator = Evaluator::new(tree.dialect(), options, cancel, State::default());
    evaluator.trace = Some(Trace::default());
    let mut top = TopLevel::new(tree);
    let count = tree.statement_count();
    let mut index = 0;
    while index < count && !evaluator.state.ended && !evaluator.is_cancelled() {
        index = evaluator.step(&mut top, index).next;
    }
    let lines = evaluator.trace.map(|trace| trace.lines).unwrap_or_default();
    let lines = lines
        .into_iter()
        .filter(|line| at.is_none_or(|at| executes(&line.origin, at)))
        .filter(|line| depth.is_none_or(|depth| nesting(line.origin.frame.as_deref()) <= depth))
        .map(expanded_line)
        .collect();
    Expansion { lines }
}

/// Whether the statement with this index executes what comes from this origin: itself, or as a call or loop around it.
fn executes(origin: &Origin, at: usize) -> bool {
    let isn = u32::try_from(at.saturating_add(1)).unwrap_or(u32::MAX);
    let mut frame = origin.frame.as_deref();
    if origin.isn == isn {
        return true;
    }
    while let Some(inner) = frame {
        if inner.isn == isn {
            return true;
        }
        frame = inner.parent.as_deref();
    }
    false
}

/// How many frames are around a statement.
fn nesting(mut frame: Option<&Frame>) -> u32 {
    let mut depth = 0;
    while let Some(inner) = frame {
        depth += 1;
        frame = inner.parent.as_deref();
    }
    depth
}

/// The text of an executed statement.
fn expanded_line(line: TracedLine) -> ExpandedLine {
    ExpandedLine { text: canonical_text(&line.elements), origin: line.origin }
}

/// Elements without blanks; the text after a text word stands as it was written.
fn canonical_text(elements: &[Element]) -> String {
    let mut text = String::new();
    for (index, element) in elements.iter().enumerate() {
        if element.kind == ElementKind::Text
            && index > 0
            && !text.ends_with(['/', ','])
            && !element.text.starts_with(' ')
        {
            text.push(' ');
        }
        text.push_str(&element.text);
    }
    text
}
