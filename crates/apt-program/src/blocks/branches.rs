//! IF over several statements: which branch of a run of statements each statement stands in.
//!
//! Branches are found from the text alone, before anything is executed: so a branch that is never taken is checked like
//! the others, and no jump can lead into one from outside.

use std::collections::BTreeMap;

use apt_syntax::{
    ParsedStatement,
    statement::{Element, ElementKind},
};

/// What a statement is for the IFs around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClauseMark {
    /// `IF(c)THEN`
    If,
    /// `ELSEIF(c)THEN`
    ElseIf,
    /// `ELSE`
    Else,
    /// `ENDIF`
    End,
}

/// What is wrong with the order of the clauses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClauseFault {
    /// ELSE, ELSEIF or ENDIF without an IF.
    WithoutIf,
    /// ELSE or ELSEIF behind the ELSE of the same IF, which is the statement with this index.
    AfterElse(usize),
    /// An IF without ENDIF.
    NotClosed,
}

/// Where control goes from a clause.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ClausePlace {
    /// The next clause of the same IF; that of an ENDIF is itself.
    pub(crate) next: usize,
    /// The ENDIF.
    pub(crate) end: usize,
}

/// The branches of a run of statements, by statement index.
#[derive(Debug, Clone, Default)]
pub(crate) struct Branches {
    clauses: BTreeMap<usize, ClausePlace>,
    /// First clause and the one that ends it, of every branch.
    branches: Vec<(usize, usize)>,
    /// What is wrong, in the order of the statements.
    pub(crate) faults: Vec<(usize, ClauseFault)>,
}

/// An IF that is open while branches are looked for.
struct OpenIf {
    clauses: Vec<usize>,
    otherwise: Option<usize>,
}

/// Finds branches: statements are shown to it in order.
#[derive(Default)]
pub(crate) struct BranchFinder {
    found: Branches,
    open: Vec<OpenIf>,
}

impl BranchFinder {
    /// Looks at the next statement.
    pub(crate) fn statement(&mut self, index: usize, statement: &ParsedStatement) {
        let Some(mark) = clause_mark(&statement.elements) else { return };
        match (mark, self.open.last_mut()) {
            (ClauseMark::If, _) => self.open.push(OpenIf { clauses: vec![index], otherwise: None }),
            (_, None) => self.found.faults.push((index, ClauseFault::WithoutIf)),
            (ClauseMark::End, Some(_)) => self.close(index),
            (mark, Some(open)) => {
                if let Some(otherwise) = open.otherwise {
                    self.found.faults.push((index, ClauseFault::AfterElse(otherwise)));
                }
                open.clauses.push(index);
                open.otherwise = open.otherwise.or((mark == ClauseMark::Else).then_some(index));
            }
        }
    }

    /// Whether an IF is open.
    pub(crate) fn is_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// The last clause of the outermost IF that is open.
    pub(crate) fn last_clause(&self) -> Option<usize> {
        self.open.first()?.clauses.last().copied()
    }

    fn close(&mut self, end: usize) {
        let Some(open) = self.open.pop() else { return };
        self.found.add(&open.clauses, end);
    }

    /// The branches; `end` is the number of statements. An IF without its ENDIF reaches to there.
    pub(crate) fn finish(mut self, end: usize) -> Branches {
        while let Some(open) = self.open.pop() {
            if let Some(first) = open.clauses.first() {
                self.found.faults.push((*first, ClauseFault::NotClosed));
            }
            self.found.add(&open.clauses, end);
        }
        self.found.faults.sort_by_key(|(index, _)| *index);
        self.found
    }
}

impl Branches {
    fn add(&mut self, clauses: &[usize], end: usize) {
        for (at, clause) in clauses.iter().enumerate() {
            let next = clauses.get(at + 1).copied().unwrap_or(end);
            self.clauses.insert(*clause, ClausePlace { next, end });
            self.branches.push((*clause, next));
        }
        self.clauses.insert(end, ClausePlace { next: end, end });
    }

    /// Where control goes from the clause with this index.
    pub(crate) fn place(&self, index: usize) -> Option<ClausePlace> {
        self.clauses.get(&index).copied()
    }

    /// Whether a jump from one statement may lead to another: not into a branch that it does not come from. The ENDIF
    /// stands outside of its branches, the label of an ELSE at the end of the branch before.
    pub(crate) fn may_jump(&self, from: usize, to: usize) -> bool {
        self.branches.iter().all(|(first, next)| {
            let is_inside =
                |index: usize| index > *first && (index < *next || index == *next && !self.ends_at(*next));
            !is_inside(to) || is_inside(from)
        })
    }

    /// Whether the statements from `first` to `last` open and close the same branches.
    pub(crate) fn same_branch(&self, first: usize, last: usize) -> bool {
        self.may_jump(first, last) && self.may_jump(last, first)
    }

    fn ends_at(&self, index: usize) -> bool {
        self.clauses.get(&index).is_some_and(|place| place.end == index)
    }
}

/// What a statement is for the IFs around it. Only its elements count, so that a mistake in a condition does not take the
/// IF from its ENDIF.
pub(crate) fn clause_mark(elements: &[Element]) -> Option<ClauseMark> {
    let labelled = elements.get(1).is_some_and(|element| element.kind == ElementKind::RightParenthesis);
    let elements = elements.get(if labelled { 2 } else { 0 }..)?;
    let word = |element: &Element, text: &str| element.kind == ElementKind::Word && element.text == text;
    let (first, last) = (elements.first()?, elements.last()?);
    match () {
        () if word(first, "ELSE") => Some(ClauseMark::Else),
        () if word(first, "ENDIF") => Some(ClauseMark::End),
        () if word(first, "ELSEIF") => Some(ClauseMark::ElseIf),
        () if word(first, "IF") && word(last, "THEN") => Some(ClauseMark::If),
        () => None,
    }
}
