//! A chunk: the state before some top-level statements and what they left behind.

use std::sync::{Arc, OnceLock};

use apt_geometry::motion::MotionCommand;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::shift::Shift;
use crate::{
    evaluator::{Output, State},
    finding::Finding,
    record::{Origin, Record, RecordKind},
    symbols::DefinitionEvent,
};

/// What a chunk of statements left behind.
#[derive(Debug, Clone)]
pub(super) struct ChunkData {
    /// The state before its first statement.
    pub(super) before: State,
    /// Index of the statement it begins with.
    pub(super) start: usize,
    /// The lowest statement index that was read.
    pub(super) read_from: usize,
    /// One more than the highest statement index that was read.
    pub(super) read_to: usize,
    /// How many top-level statements it executed.
    pub(super) steps: u64,
    pub(super) records: Vec<Record>,
    pub(super) findings: Vec<Finding>,
    pub(super) definitions: Vec<DefinitionEvent>,
    pub(super) transfers: Vec<(SmolStr, Origin)>,
    /// Names whose meaning changed.
    pub(super) touched: FxHashSet<SmolStr>,
    /// Names that were used.
    pub(super) used: FxHashSet<SmolStr>,
    /// A statement has listed all names.
    pub(super) lists_all: bool,
    /// A record moves the tool.
    pub(super) moves: bool,
}

impl ChunkData {
    /// A chunk of what was put out since `before`.
    pub(super) fn new(
        before: State,
        start: usize,
        extent: (usize, usize),
        steps: u64,
        output: Output,
    ) -> Self {
        Self {
            before,
            start,
            read_from: extent.0,
            read_to: extent.1,
            steps,
            moves: output.records.iter().any(|record| moves_the_tool(&record.kind)),
            lists_all: output.lists_all,
            records: output.records,
            findings: output.findings,
            definitions: output.definitions,
            transfers: output.transfers,
            touched: output.touched,
            used: output.used,
        }
    }
}

/// Whether a record moves the tool, or would if its statement had no error.
fn moves_the_tool(kind: &RecordKind) -> bool {
    match kind {
        RecordKind::Gap => true,
        RecordKind::Motion(command) => matches!(
            **command,
            MotionCommand::From { .. }
                | MotionCommand::GoTo { .. }
                | MotionCommand::GoDelta(_)
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
    data: Arc<ChunkData>,
    shifts: Vec<Shift>,
    shifted: Arc<OnceLock<Arc<ChunkData>>>,
}

impl Chunk {
    /// A fresh chunk.
    pub(super) fn new(data: ChunkData) -> Self {
        Self { data: Arc::new(data), shifts: Vec::new(), shifted: Arc::new(OnceLock::new()) }
    }

    /// The chunk with all shifts made.
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

    /// The same chunk after statements before it were inserted or removed.
    pub(super) fn moved(&self, shift: Shift) -> Chunk {
        if shift.is_nothing() {
            return self.clone();
        }
        // What was already worked out is the new base, so that shifts do not pile up.
        let (data, mut shifts) = match self.shifted.get() {
            Some(shifted) => (Arc::clone(shifted), Vec::new()),
            None => (Arc::clone(&self.data), self.shifts.clone()),
        };
        shifts.push(shift);
        Chunk { data, shifts, shifted: Arc::new(OnceLock::new()) }
    }
}
