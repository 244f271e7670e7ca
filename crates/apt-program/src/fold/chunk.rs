//! A chunk: the state before some top-level statements and what they left behind.

use std::sync::{Arc, OnceLock};

use apt_geometry::{motion::MotionCommand, pieces::Pieces};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::{patch::Patch, shift::Shift};
use crate::{
    evaluator::{Output, State},
    finding::Finding,
    listing::ListingEntry,
    record::{Origin, Record, RecordKind},
    symbols::{DefinitionEvent, Symbol},
};

/// What a chunk of statements left behind.
#[derive(Debug, Clone)]
pub(super) struct ChunkData {
    /// Index of the statement it begins with.
    pub(super) start: usize,
    /// The lowest statement index that was read.
    pub(super) read_from: usize,
    /// One more than the highest statement index that was read.
    pub(super) read_to: usize,
    /// How many top-level statements it executed.
    pub(super) steps: u64,
    pub(super) records: Pieces<Record>,
    pub(super) findings: Vec<Finding>,
    pub(super) listing: Vec<ListingEntry>,
    pub(super) definitions: Pieces<DefinitionEvent>,
    pub(super) transfers: Vec<(SmolStr, Origin)>,
    /// Labels of the statements in loops and macros that were executed.
    pub(super) inner_labels: FxHashSet<SmolStr>,
    /// Names whose meaning changed.
    pub(super) touched: FxHashSet<SmolStr>,
    /// Names that were used.
    pub(super) used: FxHashSet<SmolStr>,
    /// Names whose meaning, or its absence, had an effect.
    pub(super) looked_up: FxHashSet<SmolStr>,
    /// All names there are had an effect.
    pub(super) looked_at_all: bool,
    /// A statement has listed all names.
    pub(super) lists_all: bool,
    /// A record moves the tool.
    pub(super) moves: bool,
}

impl ChunkData {
    /// A chunk of what was put out by statements from `start` on.
    pub(super) fn new(start: usize, extent: (usize, usize), steps: u64, output: Output) -> Self {
        let moves = output.records.iter().any(|record| moves_the_tool(&record.kind));
        Self {
            start,
            read_from: extent.0,
            read_to: extent.1,
            steps,
            moves,
            looked_up: output.looked_up.into_inner(),
            looked_at_all: output.looked_at_all,
            lists_all: output.lists_all,
            records: output.records,
            findings: output.findings,
            listing: output.listing,
            definitions: output.definitions,
            transfers: output.transfers,
            inner_labels: output.inner_labels,
            touched: output.touched,
            used: output.used,
        }
    }
}

/// Whether a record moves the tool, or would if its statement had no error.
fn moves_the_tool(kind: &RecordKind) -> bool {
    match kind {
        RecordKind::Gap | RecordKind::Regional(_) => true,
        RecordKind::Motion(command) => matches!(
            **command,
            MotionCommand::From { .. }
                | MotionCommand::GoTo { .. }
                | MotionCommand::GoDelta { .. }
                | MotionCommand::Start(_)
                | MotionCommand::Offset(_)
                | MotionCommand::Drive { .. }
                | MotionCommand::Pocket(_)
        ),
        _ => false,
    }
}

/// A chunk that may have moved: the shift of statement numbers is made when somebody looks.
#[derive(Debug, Clone)]
pub(super) struct Chunk {
    /// The state before its first statement, as it was before `before_shifts` and `patch`.
    before: Arc<State>,
    before_shifts: Vec<Shift>,
    /// Names that have another meaning before this chunk, which has no effect in it.
    patch: Patch,
    data: Arc<ChunkData>,
    shifts: Vec<Shift>,
    shifted: Arc<OnceLock<Arc<ChunkData>>>,
}

impl Chunk {
    /// A fresh chunk with the state before its first statement.
    pub(super) fn new(before: State, data: ChunkData) -> Self {
        Self {
            before: Arc::new(before),
            before_shifts: Vec::new(),
            patch: Patch::default(),
            data: Arc::new(data),
            shifts: Vec::new(),
            shifted: Arc::new(OnceLock::new()),
        }
    }

    /// The state before its first statement.
    pub(super) fn before(&self) -> State {
        let mut state = (*self.before).clone();
        self.before_shifts.iter().for_each(|shift| shift.state(&mut state));
        self.patch.apply(&mut state);
        state
    }

    /// The state before its first statement without the symbols, for comparison of all else.
    pub(super) fn modal_before(&self) -> &State {
        &self.before
    }

    /// The state's `reached`, in present indices.
    pub(super) fn reached(&self) -> usize {
        self.before_shifts.iter().fold(self.before.reached, |index, shift| shift.index(index))
    }

    /// What a name means before its first statement.
    pub(super) fn symbol_before(&self, name: &SmolStr) -> Option<Symbol> {
        if let Some(symbol) = self.patch.symbol(name) {
            return symbol.cloned();
        }
        let mut symbol = self.before.symbol(name)?.clone();
        self.before_shifts.iter().for_each(|shift| shift.symbol(&mut symbol));
        Some(symbol)
    }

    /// Whether another meaning of one of these names could change what the chunk left behind.
    pub(super) fn depends_on(&self, names: &[SmolStr]) -> bool {
        let data = &self.data;
        let matters =
            |name| data.looked_up.contains(name) || data.touched.contains(name) || data.used.contains(name);
        !names.is_empty() && (data.looked_at_all || data.lists_all || names.iter().any(matters))
    }

    /// The chunk with all shifts made, but for the state before it.
    pub(super) fn data(&self) -> &Arc<ChunkData> {
        if self.shifts.is_empty() {
            return &self.data;
        }
        self.shifted.get_or_init(|| {
            let mut data = (*self.data).clone();
            for shift in &self.shifts {
                shift.chunk(&mut data);
            }
            Arc::new(data)
        })
    }

    /// Index of its first statement.
    pub(super) fn start(&self) -> usize {
        self.shifts.iter().fold(self.data.start, |index, shift| shift.index(index))
    }

    /// The lowest statement index that it read.
    pub(super) fn read_from(&self) -> usize {
        self.shifts.iter().fold(self.data.read_from, |index, shift| shift.index(index))
    }

    /// One more than the highest statement index that it read.
    pub(super) fn read_to(&self) -> usize {
        self.shifts.iter().fold(self.data.read_to, |index, shift| shift.index(index))
    }

    /// How many top-level statements it executed.
    pub(super) fn steps(&self) -> u64 {
        self.data.steps
    }

    /// How many records it left.
    pub(super) fn record_count(&self) -> usize {
        self.data.records.len()
    }

    /// Whether it left findings.
    pub(super) fn has_findings(&self) -> bool {
        !self.data.findings.is_empty()
    }

    /// Whether it names labels that Section 2 may go on at.
    pub(super) fn has_transfers(&self) -> bool {
        !self.data.transfers.is_empty()
    }

    /// Names that were used; these do not move.
    pub(super) fn used(&self) -> &FxHashSet<SmolStr> {
        &self.data.used
    }

    /// Whether a statement has listed all names.
    pub(super) fn lists_all(&self) -> bool {
        self.data.lists_all
    }

    /// Whether a record moves the tool.
    pub(super) fn moves(&self) -> bool {
        self.data.moves
    }

    /// Names whose meaning changed; these do not move.
    pub(super) fn touched(&self) -> &FxHashSet<SmolStr> {
        &self.data.touched
    }

    /// Labels that records carry; these do not move.
    pub(super) fn record_labels(&self) -> impl Iterator<Item = &SmolStr> {
        self.data.records.iter().filter_map(|record| record.label.as_ref())
    }

    /// Whether a statement in a loop or macro that it executed carries a label; these do not move.
    pub(super) fn has_inner_label(&self, label: &SmolStr) -> bool {
        self.data.inner_labels.contains(label)
    }

    /// The same chunk after statements before it were inserted or removed; names of which `patch` says something have
    /// that meaning before it.
    fn moved(&self, shift: Shift, patch: Patch) -> Chunk {
        let mut chunk = Self { patch, ..self.clone() };
        if !shift.is_nothing() {
            // What was already worked out is the new base, so that shifts do not pile up.
            if let Some(shifted) = self.shifted.get() {
                chunk.data = Arc::clone(shifted);
                chunk.shifts.clear();
            }
            shift.append_to(&mut chunk.shifts);
            shift.append_to(&mut chunk.before_shifts);
            chunk.shifted = Arc::new(OnceLock::new());
        }
        chunk
    }
}

/// Chunks after statements before them were inserted or removed, and after names that they do not depend on got another
/// meaning. Those that remembered the same meanings share the new ones: of each edit of a long session there are some.
pub(super) fn moved(chunks: &[Chunk], shift: Shift, patch: &Patch) -> impl Iterator<Item = Chunk> {
    let mut last: Option<(&Patch, Patch)> = None;
    chunks.iter().map(move |chunk| {
        let known = last.as_ref().filter(|(before, _)| before.is_same(&chunk.patch));
        let now = known.map(|(_, now)| now.clone()).unwrap_or_else(|| {
            let now = chunk.patch.moved(shift).then(patch);
            last = Some((&chunk.patch, now.clone()));
            now
        });
        chunk.moved(shift, now)
    })
}
