//! Execution of the statements of an IF over several statements.

use apt_syntax::{
    ParsedStatement,
    statement::{Body, Clause, Condition, ElementKind, Name},
};

use super::{Block, Branches, ClauseFault, ClauseMark, ClausePlace, clause_mark, says_motion};
use crate::{
    evaluator::Evaluator,
    finding::{ControlFinding, FindingKind, RelatedKind},
};

/// The condition of a clause; nothing if it has none, or if a mistake hides it.
fn condition_of(statement: &ParsedStatement) -> Option<&Condition> {
    match &statement.statement.parts.first()?.body {
        Body::Clause { clause: Clause::If(condition) | Clause::ElseIf(condition), .. } => Some(condition),
        _ => None,
    }
}

impl Evaluator<'_> {
    /// Executes the clause with this index: where control goes. `testing` is the clause that decides next, because none of
    /// its IF has been taken.
    pub(crate) fn clause(
        &mut self,
        (statement, index): (&ParsedStatement, usize),
        place: ClausePlace,
        testing: &mut Option<usize>,
        moves: &dyn Fn() -> bool,
    ) -> usize {
        self.open_statement(statement);
        let decides = testing.take() == Some(index);
        match clause_mark(&statement.elements) {
            Some(ClauseMark::If) => {}
            Some(ClauseMark::ElseIf) if decides => {}
            // The branch before has come to its end.
            Some(ClauseMark::ElseIf) => return place.end,
            Some(ClauseMark::Else) if !decides => return place.end,
            Some(ClauseMark::Else | ClauseMark::End) | None => return index + 1,
        }
        match condition_of(statement).and_then(|condition| self.condition(condition)) {
            Some(false) => {
                *testing = Some(place.next);
                place.next
            }
            Some(true) => index + 1,
            None => {
                // What the condition would have said is unknown. The first branch is as likely as the others, and what it
                // defines is not reported as missing; but where the tool is nobody knows.
                if moves() {
                    let range = statement.statement.parts.first().map(|part| part.range);
                    self.gap(range.unwrap_or_default());
                }
                index + 1
            }
        }
    }

    /// Executes the clause of a block.
    pub(crate) fn block_clause(
        &mut self,
        statement: &ParsedStatement,
        (block, index): (&Block, usize),
        testing: &mut Option<usize>,
    ) -> Option<usize> {
        clause_mark(&statement.elements)?;
        let place = block.branches.place(index)?;
        let moves = || {
            let inside = block.statements.get(index..place.end).unwrap_or_default();
            inside.iter().any(|statement| says_motion(&statement.elements))
        };
        Some(self.clause((statement, index), place, testing, &moves))
    }

    /// Reports what is wrong with the clauses of a run of statements. `statement` gives one with its number.
    pub(crate) fn report_clause_faults(
        &mut self,
        branches: &Branches,
        statement: &dyn Fn(usize) -> Option<(u32, std::sync::Arc<ParsedStatement>)>,
    ) {
        for (index, fault) in &branches.faults {
            let Some((isn, parsed)) = statement(*index) else { continue };
            let Some(range) = parsed.statement.parts.first().map(|part| part.range) else { continue };
            let word = parsed.elements.iter().find(|element| element.kind == ElementKind::Word);
            let word = word.map(|element| element.text.clone()).unwrap_or_default();
            let here = std::mem::replace(&mut self.here.isn, isn);
            match fault {
                ClauseFault::WithoutIf => {
                    self.report(FindingKind::Control(ControlFinding::ClauseWithoutIf { word }), range);
                }
                ClauseFault::NotClosed => {
                    self.report(FindingKind::Control(ControlFinding::BranchNotClosed), range);
                }
                ClauseFault::AfterElse(otherwise) => {
                    let other = statement(*otherwise).and_then(|(isn, parsed)| {
                        let mut origin = self.origin(parsed.statement.parts.first()?.range);
                        origin.isn = isn;
                        Some((RelatedKind::Branch, origin))
                    });
                    let related = other.into_iter().collect();
                    self.report_related(
                        FindingKind::Control(ControlFinding::ClauseAfterElse { word }),
                        range,
                        related,
                    );
                }
            }
            self.here.isn = here;
        }
    }

    /// A jump into a branch from outside.
    pub(crate) fn report_jump_into_branch(&mut self, isn: u32, label: &Name) {
        self.report_at(
            isn,
            FindingKind::Control(ControlFinding::JumpIntoBranch { name: label.text.clone() }),
            label.range,
        );
    }
}
