//! The loop over top-level statements that makes chunks.

use apt_geometry::patience::put_away;
use apt_syntax::{StatementChange, SyntaxTree};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::{
    chunk::{Chunk, ChunkData, moved},
    converge::differing,
    patch::Patch,
    shift::Shift,
};
use crate::{
    evaluator::{Evaluator, Output, State, TopLevel},
    options::Options,
};

/// Most top-level statements between two checkpoints, and least.
const CHUNK_STEPS: [u64; 2] = [128, 16];

/// Checkpoints of a program in which they stand closer than the most: with fewer, an edit would evaluate much of a short
/// program again; more of them would cost more than they save.
const CHUNKS: u64 = 32;

/// Top-level statements between two checkpoints of a program.
fn chunk_steps(statements: usize) -> u64 {
    let [most, least] = CHUNK_STEPS;
    (statements as u64 / CHUNKS).clamp(least, most)
}

/// Chunks a program had before an edit, for reuse.
pub(super) struct Old<'o> {
    /// The chunks.
    pub(super) chunks: &'o [Chunk],
    /// The first of them that is evaluated again.
    pub(super) first: usize,
    /// The edit.
    pub(super) change: &'o StatementChange,
}

/// What an evaluation gives.
pub(crate) struct Outcome {
    /// The chunks made.
    pub(super) chunks: Vec<Chunk>,
    /// The state at the end; none if the rest is reused from the old chunk with this index.
    pub(super) end: End,
    /// Top-level statements executed.
    pub(super) steps: u64,
    /// Top-level statements of old chunks among `chunks`.
    pub(super) reused: u64,
    /// One of them asked for a file.
    pub(super) asked_for_files: bool,
}

/// How an evaluation ended.
pub(crate) enum End {
    /// At the end of the program.
    Complete(Box<State>),
    /// In the state of an old chunk, but for names that do not matter any more: the rest is that of the old evaluation,
    /// moved.
    Converged(usize, Shift, Patch),
    /// Cancelled.
    Cancelled,
}

/// Evaluates from a statement on; with `old` until the state is that of the old evaluation.
pub(crate) fn evaluate_from(
    tree: &SyntaxTree,
    options: &Options,
    cancel: &dyn Fn() -> bool,
    start: (usize, State),
    old: Option<&Old<'_>>,
) -> Outcome {
    let mut evaluator = Evaluator::new(tree.dialect(), options, cancel, start.1);
    let mut top = TopLevel::new(tree);
    let mut outcome =
        Outcome { chunks: Vec::new(), end: End::Cancelled, steps: 0, reused: 0, asked_for_files: false };
    let mut reuse = old.map(Reuse::new);
    let mut index = start.0;
    let count = tree.statement_count();
    loop {
        if evaluator.is_cancelled() {
            return outcome;
        }
        if let Some(reuse) = &mut reuse
            && let Some(takeover) = reuse.takeover(index, &evaluator.state)
        {
            let Takeover { first, until, patch } = takeover;
            let Some(next) = reuse.old.chunks.get(until) else {
                outcome.end = End::Converged(first, reuse.shift, patch);
                return outcome;
            };
            let taken_over = &reuse.old.chunks[first..until];
            outcome.reused += taken_over.iter().map(Chunk::steps).sum::<u64>();
            outcome.chunks.extend(moved(taken_over, reuse.shift, &patch));
            let mut state = next.before();
            if !reuse.shift.is_nothing() {
                reuse.shift.state(&mut state);
            }
            patch.apply(&mut state);
            evaluator.state = state;
            index = reuse.shift.index(next.start());
            reuse.candidate = until;
        }
        if index >= count || evaluator.state.ended {
            break;
        }
        let until = reuse.as_ref().and_then(|reuse| reuse.next_boundary(index));
        let before = evaluator.state.clone();
        let (chunk, next) = run_chunk(&mut evaluator, &mut top, index, until);
        if evaluator.cancelled {
            let parts = chunk.records.len() + chunk.definitions.len();
            put_away((chunk, evaluator.state), parts);
            return outcome;
        }
        outcome.steps += chunk.steps;
        outcome.asked_for_files |= evaluator.asked_for_files;
        if let Some(reuse) = &mut reuse {
            reuse.touched.extend(chunk.touched.iter().cloned());
        }
        outcome.chunks.push(Chunk::new(before, chunk));
        index = next;
    }
    close(&mut evaluator, tree, &mut outcome);
    outcome.end = End::Complete(Box::new(evaluator.state));
    outcome
}

/// The last chunk: what follows from the end of the program without FINI.
fn close(evaluator: &mut Evaluator<'_>, tree: &SyntaxTree, outcome: &mut Outcome) {
    let before = evaluator.state.clone();
    let count = tree.statement_count();
    evaluator.close_program(tree);
    let output = std::mem::take(&mut evaluator.output);
    if !output.findings.is_empty() || !output.records.is_empty() {
        let data = ChunkData::new(count, (0, count), 0, output);
        outcome.chunks.push(Chunk::new(before, data));
    }
}

/// Executes statements until it is time for a checkpoint: not while a motion waits for its check surface or a DO loop
/// is open.
fn run_chunk(
    evaluator: &mut Evaluator<'_>,
    top: &mut TopLevel<'_>,
    start: usize,
    until: Option<usize>,
) -> (ChunkData, usize) {
    let count = top.tree.statement_count();
    let chunk_steps = chunk_steps(count);
    let mut index = start;
    let mut steps = 0;
    let (mut read_from, mut read_to) = (start, start);
    while index < count && !evaluator.state.ended && !evaluator.cancelled {
        let end = evaluator.step(top, index);
        steps += 1;
        read_from = read_from.min(end.read_from);
        read_to = read_to.max(end.read_to);
        index = end.next;
        let settled = evaluator.pending.is_none() && top.is_settled(index);
        if settled && (steps >= chunk_steps || until == Some(index)) {
            break;
        }
        if steps % chunk_steps == 0 && evaluator.is_cancelled() {
            break;
        }
    }
    let output: Output = std::mem::take(&mut evaluator.output);
    (ChunkData::new(start, (read_from, read_to), steps, output), index)
}

/// Chunks that have moved are taken over in the middle of a program if there are at least this many.
const LEAST_MOVED_STRETCH: usize = 16;

/// Among so many of the next old chunks the one is looked for at which a new one ends: in a straight program it is the first
/// or the second, in a loop of jumps one of a turn.
const MOST_CHUNKS_AHEAD: usize = 64;

/// Old chunks that can be taken over.
struct Takeover {
    /// The first of them.
    first: usize,
    /// The first one behind that cannot; the number of chunks if there is none.
    until: usize,
    /// The names that mean something else than in the old evaluation.
    patch: Patch,
}

/// Looks for a statement where the old evaluation can take over.
struct Reuse<'o> {
    old: &'o Old<'o>,
    shift: Shift,
    /// The next old chunk to compare with.
    candidate: usize,
    /// Names that either evaluation touched since the restart.
    touched: FxHashSet<SmolStr>,
    /// The first old chunk from which on nothing before the end of the change is read.
    independent_from: usize,
}

impl<'o> Reuse<'o> {
    fn new(old: &'o Old<'o>) -> Self {
        let change = old.change;
        let by = i64::try_from(change.inserted)
            .unwrap_or(i64::MAX)
            .saturating_sub(i64::try_from(change.removed).unwrap_or(i64::MAX));
        let from = change.first + change.removed;
        let mut independent_from = old.chunks.len();
        while independent_from > 0 && old.chunks[independent_from - 1].read_from() >= from {
            independent_from -= 1;
        }
        Self {
            old,
            shift: Shift { from, by },
            candidate: old.first,
            touched: FxHashSet::default(),
            independent_from,
        }
    }

    /// Where the next old chunk begins, in new indices, if that is one of the next. Where the program jumps back over and over
    /// all chunks that are left may begin before this place, and to look through them at each turn takes a time that grows
    /// with the square of the turns.
    fn next_boundary(&self, index: usize) -> Option<usize> {
        let ahead = self.old.chunks[self.candidate.min(self.old.chunks.len())..].iter();
        ahead
            .take(MOST_CHUNKS_AHEAD)
            .map(Chunk::start)
            .filter(|start| *start >= self.shift.from)
            .map(|start| self.shift.index(start))
            .find(|start| *start > index)
    }

    /// The old chunks that can be taken over from here on: one begins here, in the same state but for names on which they
    /// do not depend.
    fn takeover(&mut self, index: usize, state: &State) -> Option<Takeover> {
        while let Some(chunk) = self.old.chunks.get(self.candidate) {
            let start = chunk.start();
            let passed = start < self.shift.from || self.shift.index(start) < index;
            if passed {
                self.touched.extend(chunk.touched().iter().cloned());
                self.candidate += 1;
                continue;
            }
            if self.shift.index(start) != index || self.candidate < self.independent_from {
                return None;
            }
            let names = differing(state, chunk, self.shift, &self.touched)?;
            let (first, count) = (self.candidate, self.old.chunks.len());
            let until = (first..count).find(|at| self.old.chunks[*at].depends_on(&names)).unwrap_or(count);
            // The state behind is moved name by name, which a short stretch is not worth.
            let worthwhile = until == count
                || until > first && (self.shift.is_nothing() || until - first >= LEAST_MOVED_STRETCH);
            return worthwhile.then(|| Takeover { first, until, patch: Patch::of(state, &names) });
        }
        None
    }
}
