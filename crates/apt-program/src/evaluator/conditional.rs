//! IFs over several statements at the top level.

use apt_syntax::{ParsedStatement, SyntaxTree};

use super::{Evaluator, StepEnd, TopLevel};
use crate::blocks::{self, BranchFinder, Branches, clause_mark};

/// An IF over several statements at the top level, with those inside of it.
pub(super) struct Conditional {
    first: usize,
    /// The ENDIF, or the last statement of an IF that has none.
    last: usize,
    /// One more than the last statement that was looked at to find its end.
    read_to: usize,
    branches: Branches,
}

impl Conditional {
    /// Whether a statement stands in it, its first and last one included.
    pub(super) fn contains(&self, index: usize) -> bool {
        (self.first..=self.last).contains(&index)
    }

    /// Whether a statement stands behind it.
    pub(super) fn is_before(&self, index: usize) -> bool {
        index > self.last
    }
}

impl Evaluator<'_> {
    /// Executes a clause at the top level; nothing if it belongs to no IF.
    pub(super) fn top_level_clause(
        &mut self,
        top: &mut TopLevel<'_>,
        index: usize,
        statement: &ParsedStatement,
    ) -> Option<StepEnd> {
        clause_mark(&statement.elements)?;
        let known = top.conditional.as_ref().is_some_and(|open| open.contains(index));
        if !known {
            let found = self.find_conditional(top.tree, index)?;
            let numbered = |at: usize| {
                let isn = u32::try_from(at + 1).unwrap_or(u32::MAX);
                Some((isn, top.tree.statement(at).parsed()))
            };
            self.report_clause_faults(&found.branches, &numbered);
            top.conditional = Some(found);
        }
        let open = top.conditional.as_ref()?;
        let place = open.branches.place(index)?;
        let (read_from, read_to) = (open.first, open.read_to);
        let moves =
            || (index..place.end).any(|at| blocks::says_motion(&top.tree.statement(at).parsed().elements));
        let next = self.clause((statement, index), place, &mut top.testing, &moves);
        let next = self.continue_do_loops(statement, &mut top.do_loops).unwrap_or(next);
        Some(StepEnd { next, read_to, read_from: read_from.min(next) })
    }

    /// The IF that begins at a statement, up to its ENDIF; nothing if the statement begins none. Loops and macros inside of
    /// it have branches of their own.
    fn find_conditional(&self, tree: &SyntaxTree, first: usize) -> Option<Conditional> {
        let count = tree.statement_count();
        let mut finder = BranchFinder::default();
        let mut region: Option<&'static str> = None;
        for index in first..count {
            let original = tree.statement(index).parsed();
            let statement = self.state.without_synonyms(&original, &self.dialect);
            let word = blocks::single_word(&statement);
            match region {
                Some(closing) => region = region.filter(|_| word != Some(closing)),
                None if blocks::is_macro_header(&statement) => region = Some("TERMAC"),
                None if word == Some("LOOPST") && !self.dialect.branch_anywhere => region = Some("LOOPND"),
                None if word == Some("FINI") => {
                    return Some(without_end(tree, finder, first, index));
                }
                None => {
                    finder.statement(index, &statement);
                    if !finder.is_open() {
                        // A clause without an IF opens nothing.
                        clause_mark(&statement.elements).filter(|_| index > first)?;
                        let (last, read_to) = (index, index + 1);
                        return Some(Conditional { first, last, read_to, branches: finder.finish(count) });
                    }
                }
            }
        }
        Some(without_end(tree, finder, first, count))
    }

    /// Whether an IF over several statements begins between a DO and the end of its loop and closes behind it, or the
    /// reverse.
    pub(super) fn crosses_branches(&self, tree: &SyntaxTree, first: usize, last: usize) -> bool {
        if !self.dialect.structured_if || last < first {
            return false;
        }
        let mut finder = BranchFinder::default();
        for index in first..=last {
            finder.statement(index, &tree.statement(index).parsed());
        }
        finder.is_open() || !finder.finish(last + 1).faults.is_empty()
    }
}

/// An IF without ENDIF before the statement `limit`, as while it is being written: it ends where the statements behind its
/// last clause are no more indented than it is, so that the rest of the program stays what it was.
fn without_end(tree: &SyntaxTree, finder: BranchFinder, first: usize, limit: usize) -> Conditional {
    let own = indentation(tree, first).unwrap_or(0);
    let behind = finder.last_clause().map_or(first, |clause| clause.max(first)) + 1;
    let end = (behind..limit).find(|index| indentation(tree, *index).is_some_and(|column| column <= own));
    let end = end.unwrap_or(limit);
    let read_to = limit.saturating_add(1).min(tree.statement_count());
    Conditional { first, last: end.saturating_sub(1), read_to, branches: finder.finish(end) }
}

/// How many characters stand before a statement, or before what follows its label; nothing for lines without one.
fn indentation(tree: &SyntaxTree, index: usize) -> Option<usize> {
    let view = tree.statement(index);
    let parsed = view.parsed();
    let after_label = if parsed.statement.label.is_some() { 2 } else { 0 };
    let start = usize::from(parsed.elements.get(after_label)?.range.start());
    let line = view.text().get(..start)?.rsplit(['\n', '\r']).next()?;
    Some(line.chars().count())
}
