//! An evaluated program.

use std::sync::Arc;

use apt_geometry::patience::Patience;
use apt_syntax::{StatementChange, SyntaxTree, dialect::DialectName};
use smol_str::SmolStr;

use super::{
    chunk::{Chunk, moved},
    close::closing_findings,
    run::{End, Old, Outcome, evaluate_from},
    unused::{Replacement, Unused},
};
use crate::{
    evaluator::State,
    finding::Finding,
    listing::ListingEntry,
    options::Options,
    record::Record,
    symbols::{DefinitionEvent, Value, values_of},
};

/// The result of Section 1: records, findings and definitions in order of execution, and the symbol table at the end.
#[derive(Debug, Clone)]
pub struct Program {
    chunks: Vec<Chunk>,
    end: Arc<State>,
    complete: bool,
    /// A statement asked for a file, which may change without any edit of the program.
    asked_for_files: bool,
    findings: Arc<Vec<Finding>>,
    unused: Unused,
    statistics: Statistics,
}

/// What an evaluation cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Top-level statements executed (a loop or a call counts as one).
    pub evaluated_statements: u64,
    /// Top-level statements whose results were taken over from before the edit.
    pub reused_statements: u64,
    /// Checkpoints kept.
    pub checkpoints: usize,
}

impl Program {
    /// Evaluates a program from its first statement.
    pub(crate) fn evaluate(tree: &SyntaxTree, options: &Options, cancel: &dyn Fn() -> bool) -> Program {
        let outcome = evaluate_from(tree, options, cancel, (0, State::default()), None);
        Program::assemble(Vec::new(), outcome, None, tree.dialect().name)
    }

    /// Evaluates after an edit: from the checkpoint before the first changed statement until the state is what it was
    /// before the edit at the same statement; everything else is taken over. The result equals that of [`crate::evaluate`].
    pub fn update(
        &self,
        tree: &SyntaxTree,
        change: &StatementChange,
        options: &Options,
        cancel: &dyn Fn() -> bool,
    ) -> Program {
        if !self.complete || self.asked_for_files {
            // Included files may have changed too.
            return Program::evaluate(tree, options, cancel);
        }
        // Statements are read in order of execution; a chunk that has read a changed statement is evaluated again.
        // At the end of the program the closing chunk depends on the last statement.
        let kept = self.chunks.iter().take_while(|chunk| chunk.read_to() <= change.first).count();
        let kept = if kept == self.chunks.len() { kept.saturating_sub(1) } else { kept };
        let start = match self.chunks.get(kept) {
            Some(chunk) => (chunk.start().min(change.first), chunk.before()),
            None => (0, State::default()),
        };
        let old = Old { chunks: &self.chunks, first: kept, change };
        let outcome = evaluate_from(tree, options, cancel, start, Some(&old));
        let kept = self.chunks[..kept.min(self.chunks.len())].to_vec();
        Program::assemble(kept, outcome, Some(self), tree.dialect().name)
    }

    /// [`Program::update`] for one edit after the other: each with the program after it. Only the last of them may be
    /// incomplete, when `cancel` said so.
    pub fn update_in_steps(
        &self,
        steps: &[(SyntaxTree, StatementChange)],
        options: &Options,
        cancel: &dyn Fn() -> bool,
    ) -> Program {
        let mut program = self.clone();
        let mut evaluated = 0;
        program.statistics.reused_statements += program.statistics.evaluated_statements;
        program.statistics.evaluated_statements = 0;
        for (tree, change) in steps {
            program = program.update(tree, change, options, cancel);
            evaluated += program.statistics.evaluated_statements;
            if !program.complete {
                break;
            }
        }
        // What one step has evaluated is no result from before the edits when the next one takes it over.
        let statistics = &mut program.statistics;
        let earlier = evaluated - statistics.evaluated_statements;
        statistics.reused_statements = statistics.reused_statements.saturating_sub(earlier);
        statistics.evaluated_statements = evaluated;
        program
    }

    /// Whether a statement asked for a file: then only a new evaluation is sure to be up to date.
    pub fn asked_for_files(&self) -> bool {
        self.asked_for_files
    }

    /// Puts kept, new and reused chunks together.
    fn assemble(kept: Vec<Chunk>, outcome: Outcome, old: Option<&Program>, dialect: DialectName) -> Program {
        let mut reused: u64 = outcome.reused + kept.iter().map(Chunk::steps).sum::<u64>();
        let mut chunks = kept;
        let from = chunks.len();
        chunks.extend(outcome.chunks);
        let to = chunks.len();
        let mut unused = None;
        let (end, complete) = match outcome.end {
            End::Complete(state) => (Arc::new(*state), true),
            End::Cancelled => (Arc::new(State::default()), false),
            End::Converged(first, shift, patch) => {
                let Some(old) = old else { return Program::assemble_nothing() };
                reused += old.chunks[first..].iter().map(Chunk::steps).sum::<u64>();
                chunks.extend(moved(&old.chunks[first..], shift, &patch));
                // The states agree at the seam but for names that nothing behind it changes: so do they at the end.
                let mut end = (*old.end).clone();
                if !shift.is_nothing() {
                    shift.state(&mut end);
                }
                patch.apply(&mut end);
                if shift.is_nothing() {
                    let replacement = Replacement {
                        old: old.chunks.get(from..first).unwrap_or_default(),
                        new: chunks.get(from..to).unwrap_or_default(),
                        patched: patch.names().collect(),
                    };
                    unused = Some(old.unused.after(&replacement, &old.end, (&chunks, &end), dialect));
                }
                (Arc::new(end), true)
            }
        };
        let findings = Arc::new(closing_findings(&chunks, &end, dialect, complete));
        let unused = match unused {
            Some(unused) => unused,
            None if complete => Unused::find(&chunks, &end, dialect),
            None => Unused::default(),
        };
        let statistics = Statistics {
            evaluated_statements: outcome.steps,
            reused_statements: reused,
            checkpoints: chunks.len(),
        };
        let asked_for_files = outcome.asked_for_files;
        Program { chunks, end, complete, asked_for_files, findings, unused, statistics }
    }

    /// An evaluation that gave nothing.
    fn assemble_nothing() -> Program {
        Program {
            chunks: Vec::new(),
            end: Arc::new(State::default()),
            complete: false,
            asked_for_files: false,
            findings: Arc::new(Vec::new()),
            unused: Unused::default(),
            statistics: Statistics::default(),
        }
    }

    /// The records in order of execution.
    pub fn records(&self) -> impl Iterator<Item = &Record> {
        self.chunks.iter().flat_map(|chunk| chunk.data().records.iter())
    }

    /// How many records there are.
    pub fn record_count(&self) -> usize {
        self.chunks.iter().map(Chunk::record_count).sum()
    }

    /// All findings: those of the statements in order of execution, then those of the program as a whole. A finding of
    /// a statement that is executed many times stands once.
    pub fn findings(&self) -> impl Iterator<Item = &Finding> {
        self.findings.iter().chain(self.unused.findings())
    }

    /// What the program prints and punches, in order of execution.
    pub fn listing(&self) -> impl Iterator<Item = &ListingEntry> {
        self.chunks.iter().flat_map(|chunk| chunk.data().listing.iter())
    }

    /// Whether the program wants its motions left uncomputed (PTONLY/1).
    pub fn skips_motion(&self) -> bool {
        self.records().any(|record| record.kind == crate::record::RecordKind::SkipMotion)
    }

    /// Every definition in order of execution.
    pub fn definitions(&self) -> impl Iterator<Item = &DefinitionEvent> {
        self.chunks.iter().flat_map(|chunk| chunk.data().definitions.iter())
    }

    /// All names with their values at the end, sorted; elements of arrays as `NAME(3)`. Geometry is in the coordinates
    /// of the reference system in force at the end.
    pub fn symbols(&self) -> Vec<(SmolStr, Value)> {
        values_of(&self.end.symbols, self.end.system.as_ref(), Patience::default())
    }

    /// The same; `None` when who waits has given up before the end.
    pub fn symbols_until(&self, patience: Patience<'_>) -> Option<Vec<(SmolStr, Value)>> {
        let values = values_of(&self.end.symbols, self.end.system.as_ref(), patience);
        (!patience.was_over()).then_some(values)
    }

    /// What the evaluation cost.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// False when the evaluation was cancelled; what there is of it is then the beginning.
    pub fn is_complete(&self) -> bool {
        self.complete
    }
}
