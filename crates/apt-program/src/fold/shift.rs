//! Moving results when statements before them were inserted or removed: only statement numbers change.

use std::sync::Arc;

use super::chunk::ChunkData;
use crate::{
    evaluator::State,
    macros::MacroDefinition,
    record::{Frame, Origin},
    symbols::Meaning,
};

/// Statements from `from` on have moved by `by`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shift {
    /// First statement index (from 0, before the change) that moves.
    pub(super) from: usize,
    /// How far, in statements.
    pub(super) by: i64,
}

impl Shift {
    /// Whether nothing moves.
    pub(super) fn is_nothing(&self) -> bool {
        self.by == 0
    }

    /// The new index of a statement, or of the place after one.
    pub(super) fn index(&self, index: usize) -> usize {
        if index < self.from {
            return index;
        }
        let distance = usize::try_from(self.by.unsigned_abs()).unwrap_or(usize::MAX);
        if self.by < 0 { index.saturating_sub(distance) } else { index.saturating_add(distance) }
    }

    /// The new number of a statement.
    pub(super) fn isn(&self, isn: u32) -> u32 {
        let index = usize::try_from(isn).unwrap_or(usize::MAX).saturating_sub(1);
        u32::try_from(self.index(index).saturating_add(1)).unwrap_or(u32::MAX)
    }

    /// An origin. Statements of included files keep their numbers; the INCLUD itself moves.
    pub(super) fn origin(&self, origin: &mut Origin) {
        let included = origin.frame.as_deref().is_some_and(is_included);
        if !included {
            origin.isn = self.isn(origin.isn);
        }
        if let Some(frame) = &origin.frame {
            origin.frame = Some(self.frame(frame));
        }
    }

    /// A frame with the frames around it.
    fn frame(&self, frame: &Arc<Frame>) -> Arc<Frame> {
        let mut moved = (**frame).clone();
        if !moved.parent.as_deref().is_some_and(is_included) {
            moved.isn = self.isn(moved.isn);
        }
        if let Some(parent) = &moved.parent {
            moved.parent = Some(self.frame(parent));
        }
        Arc::new(moved)
    }

    /// Everything in a chunk.
    pub(super) fn chunk(&self, data: &mut ChunkData) {
        data.start = self.index(data.start);
        data.read_from = self.index(data.read_from);
        data.read_to = self.index(data.read_to);
        for record in &mut data.records {
            self.origin(&mut record.origin);
        }
        for finding in &mut data.findings {
            self.origin(&mut finding.origin);
            for (_, origin) in &mut finding.related {
                self.origin(origin);
            }
        }
        for event in &mut data.definitions {
            self.origin(&mut event.origin);
        }
        for (_, origin) in &mut data.transfers {
            self.origin(origin);
        }
        self.state(&mut data.before);
    }

    /// The symbols of a state.
    pub(super) fn state(&self, state: &mut State) {
        state.reached = self.index(state.reached);
        let names: Vec<_> = state.symbols.keys().cloned().collect();
        for name in names {
            if let Some(symbol) = state.symbols.get_mut(&name) {
                self.origin(&mut symbol.origin);
                if let Meaning::Macro(definition) = &symbol.meaning {
                    let mut moved: MacroDefinition = (**definition).clone();
                    moved.body.first_isn = self.isn(moved.body.first_isn);
                    symbol.meaning = Meaning::Macro(Arc::new(moved));
                }
            }
        }
    }
}

/// Whether a frame is an included file, or stands in one.
fn is_included(frame: &Frame) -> bool {
    frame.kind == crate::record::FrameKind::Include || frame.parent.as_deref().is_some_and(is_included)
}
