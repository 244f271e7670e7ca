//! The program with macros and loops unrolled: each executed statement as text, with its origin.

use std::{collections::BTreeSet, ops::Range};

use apt_geometry::{
    patience::{Patience, Waiting, put_away},
    pieces::Pieces,
};
use apt_syntax::{
    StatementView, SyntaxTree,
    dialect::TextWords,
    statement::{Element, ElementKind},
};
use smol_str::SmolStr;

use crate::{
    evaluator::{Evaluator, RegionLabels, State, TopLevel, Trace, TracedLine, assigned_names},
    options::Options,
    record::Origin,
};

/// An unrolled program.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Expansion {
    /// The statements in order of execution. Jumps, and the words of loops, macros and calls that are opened, leave no
    /// line of their own.
    pub lines: Vec<ExpandedLine>,
}

/// One executed statement.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpandedLine {
    /// The statement in canonical spelling: upper case, no blanks but those of texts. Macro variables are replaced, and
    /// so are names that the loop or macro around it assigns to: by their values.
    pub text: String,
    /// Where it comes from, with the macro calls and loop turns around it.
    pub origin: Origin,
    /// Whether it is a remark of a statement, and not what the statement does: that follows, if it leaves a line.
    pub is_remark: bool,
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

/// Unrolls a program. What comes out does the same as the program.
///
/// With `at` only what the statement with this index (from 0) executes is given: the body of a call, the turns of a
/// loop. With `depth` calls, loops and inclusions nested deeper than this stand as they are written, with the
/// definitions of the macros that are still called.
pub fn expand(
    tree: &SyntaxTree,
    options: &Options,
    at: Option<usize>,
    depth: Option<u32>,
    cancel: &dyn Fn() -> bool,
) -> Expansion {
    unroll(tree, options, (at, depth), false, cancel)
}

/// The same with the remarks of the statements in loops and macros that are opened, once for each turn and call: each is a
/// line before what its statement does.
pub fn expand_with_remarks(
    tree: &SyntaxTree,
    options: &Options,
    at: Option<usize>,
    depth: Option<u32>,
    cancel: &dyn Fn() -> bool,
) -> Expansion {
    unroll(tree, options, (at, depth), true, cancel)
}

/// The remarks of a statement, each so that it can stand behind any statement or alone.
pub fn remarks_of(statement: &StatementView) -> Vec<String> {
    let parsed = statement.parsed();
    let said = parsed.comments.iter().filter_map(|comment| statement.text().get(Range::from(*comment)));
    let said = said.map(str::trim).filter(|comment| !comment.is_empty());
    let alone = said.map(|comment| {
        // Behind the sign of a continued line a remark has none of its own.
        if comment.starts_with("$$") { comment.to_owned() } else { format!("$$ {comment}") }
    });
    alone.collect()
}

fn unroll(
    tree: &SyntaxTree,
    options: &Options,
    (at, depth): (Option<usize>, Option<u32>),
    with_remarks: bool,
    cancel: &dyn Fn() -> bool,
) -> Expansion {
    let mut evaluator = Evaluator::new(tree.dialect(), options, cancel, State::default());
    let isn = at.map(|at| u32::try_from(at.saturating_add(1)).unwrap_or(u32::MAX));
    let count = tree.statement_count();
    let waiting = Waiting::until(cancel);
    let patience = waiting.patience();
    let (jumps_free, do_loops) = (tree.dialect().branch_anywhere, tree.dialect().do_loops);
    let mut labels = RegionLabels::default();
    let (mut varying, mut has_do) = (BTreeSet::new(), false);
    for index in (0..count).take_while(|_| !patience.ends_after(1)) {
        let statement = tree.statement(index).parsed();
        labels.statement(&statement);
        has_do |= is_do(&statement.elements);
        if (jumps_free || do_loops) && repeats(&statement.elements) {
            varying.extend(assigned_names(&statement));
        }
    }
    evaluator.trace = Some(Trace::new(isn, depth, with_remarks, labels));
    if jumps_free || do_loops {
        // The whole program is one region then: loops are made of jumps.
        evaluator.enter_names(if jumps_free || has_do { varying } else { BTreeSet::new() });
    }
    let mut top = TopLevel::new(tree);
    let mut index = 0;
    while index < count && !evaluator.state.ended && !patience.was_over() && !evaluator.is_cancelled() {
        index = evaluator.step(&mut top, index).next;
    }
    let Evaluator { trace, state, output, .. } = evaluator;
    let mut trace = trace.unwrap_or_default();
    let traced = std::mem::take(&mut trace.lines);
    put_away((state, output, trace), traced.len());
    let needed = needed_macros(&traced, patience);
    let count = traced.len();
    let mut lines = Vec::with_capacity(count);
    let mut traced = traced.into_iter();
    for line in traced.by_ref() {
        if patience.ends_after(1) {
            break;
        }
        if line.definition_of.as_ref().is_none_or(|name| needed.contains(name)) {
            if line.is_remark {
                lines.extend(remark_lines(line.origin, tree));
            } else {
                lines.push(expanded_line(line, tree.dialect().text_words));
            }
        }
    }
    put_away(traced, count);
    Expansion { lines }
}

/// Whether a statement makes a new value of a name out of its old one, as the counter of a loop does, or is a DO.
fn repeats(elements: &[Element]) -> bool {
    let equals = elements.iter().position(|element| element.kind == ElementKind::Equals);
    let counts = equals.is_some_and(|equals| {
        let (targets, values) = elements.split_at(equals);
        let named = targets.iter().filter(|element| element.kind == ElementKind::Name);
        named.clone().any(|name| values.iter().any(|value| value.text == name.text))
    });
    counts || is_do(elements)
}

fn is_do(elements: &[Element]) -> bool {
    elements.iter().any(|element| element.kind == ElementKind::Word && element.text == "DO")
}

/// The macros that the lines still call, and those that these call.
fn needed_macros(lines: &Pieces<TracedLine>, patience: Patience<'_>) -> BTreeSet<SmolStr> {
    let mut needed: BTreeSet<SmolStr> = BTreeSet::new();
    loop {
        let before = needed.len();
        let looked_at = lines.iter().take_while(|_| !patience.ends_after(1));
        let standing =
            looked_at.filter(|line| line.definition_of.as_ref().is_none_or(|name| needed.contains(name)));
        let called: Vec<SmolStr> = standing.filter_map(|line| called_macro(&line.elements)).collect();
        needed.extend(called);
        // Each round adds a macro, or is the last one.
        if needed.len() == before {
            return needed;
        }
    }
}

/// The macro that a statement calls.
fn called_macro(elements: &[Element]) -> Option<SmolStr> {
    let call = elements.iter().position(|one| one.kind == ElementKind::Word && one.text == "CALL")?;
    elements.get(call.checked_add(2)?).map(|name| name.text.clone())
}

/// The text of an executed statement.
fn expanded_line(line: TracedLine, text_words: TextWords) -> ExpandedLine {
    ExpandedLine { text: canonical_text(&line.elements, text_words), origin: line.origin, is_remark: false }
}

/// The remarks of the statement that an origin names.
fn remark_lines(origin: Origin, program: &SyntaxTree) -> impl Iterator<Item = ExpandedLine> {
    let tree = origin.source.as_ref().map_or(program, |source| &source.tree);
    let remarks = remarks_of(&tree.statement(origin.isn.saturating_sub(1) as usize));
    remarks.into_iter().map(move |text| ExpandedLine { text, origin: origin.clone(), is_remark: true })
}

/// Elements without blanks; the text after a text word stands so that it is read as it was: a blank counts, but where
/// text words may stand anywhere.
fn canonical_text(elements: &[Element], text_words: TextWords) -> String {
    let mut text = String::new();
    for (index, element) in elements.iter().enumerate() {
        if element.kind == ElementKind::Text
            && index > 0
            && !text.ends_with(['/', ','])
            && !element.text.starts_with(' ')
        {
            match text_words {
                // Without the slash the text of DISPLY would be none.
                TextWords::Anywhere if text == "DISPLY" => text.push('/'),
                TextWords::Anywhere => text.push(' '),
                // Behind the word in its columns the text would begin with the slash.
                TextWords::Indented if index == 1 && !element.text.starts_with('/') => {
                    text.insert(0, ' ');
                    text.push('/');
                }
                TextWords::Indented | TextWords::InColumnOne => {}
            }
        }
        text.push_str(&element.text);
    }
    text
}
