//! Moving results when statements before them were inserted or removed: only statement numbers change.

use std::sync::Arc;

use super::chunk::ChunkData;
use crate::{
    evaluator::State,
    macros::MacroDefinition,
    record::{Frame, Origin},
    symbols::{Meaning, Symbol},
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

    /// Adds it to shifts that were made before; as one with the last of them where both together move what one would.
    pub(super) fn append_to(&self, shifts: &mut Vec<Shift>) {
        let joined = shifts.last().and_then(|last| last.joined_with(self));
        match (joined, shifts.last_mut()) {
            (Some(joined), Some(last)) => *last = joined,
            _ => shifts.push(*self),
        }
    }

    /// The one shift that has the effect of this one and then a later one, if there is one: what this one moved, and
    /// nothing else, is moved by the later one.
    fn joined_with(&self, later: &Shift) -> Option<Shift> {
        let moved_to = self.index(self.from);
        let by = self.by.checked_add(later.by)?;
        (self.from.min(moved_to)..=moved_to).contains(&later.from).then_some(Shift { from: self.from, by })
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
        if origin.source.is_none() {
            origin.isn = self.isn(origin.isn);
        }
        if let Some(frame) = &origin.frame {
            origin.frame = Some(self.frame(frame));
        }
    }

    /// A frame with the frames around it.
    fn frame(&self, frame: &Arc<Frame>) -> Arc<Frame> {
        let mut moved = (**frame).clone();
        if moved.source.is_none() {
            moved.isn = self.isn(moved.isn);
        }
        if let Some(parent) = &moved.parent {
            moved.parent = Some(self.frame(parent));
        }
        Arc::new(moved)
    }

    /// Everything in a chunk but the state before it, which is moved when an evaluation begins there.
    pub(super) fn chunk(&self, data: &mut ChunkData) {
        data.start = self.index(data.start);
        data.read_from = self.index(data.read_from);
        data.read_to = self.index(data.read_to);
        for record in data.records.iter_mut() {
            self.origin(&mut record.origin);
        }
        for finding in &mut data.findings {
            self.origin(&mut finding.origin);
            for (_, origin) in &mut finding.related {
                self.origin(origin);
            }
        }
        for entry in &mut data.listing {
            self.origin(&mut entry.origin);
        }
        for event in data.definitions.iter_mut() {
            self.origin(&mut event.origin);
        }
        for (_, origin) in &mut data.transfers {
            self.origin(origin);
        }
    }

    /// The symbols of a state.
    pub(super) fn state(&self, state: &mut State) {
        state.reached = self.index(state.reached);
        let names: Vec<_> = state.symbols.keys().cloned().collect();
        for name in names {
            if let Some(symbol) = state.symbols.get_mut(&name) {
                self.symbol(Arc::make_mut(symbol));
            }
        }
    }

    /// A symbol with its place.
    pub(super) fn symbol(&self, symbol: &mut Symbol) {
        self.origin(&mut symbol.origin);
        if let Meaning::Macro(definition) = &symbol.meaning {
            let mut moved: MacroDefinition = (**definition).clone();
            if moved.body.source.is_none() {
                moved.body.first_isn = self.isn(moved.body.first_isn);
            }
            symbol.meaning = Meaning::Macro(Arc::new(moved));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_shifts_move_what_both_would() {
        for (from, by) in [(5, 3), (5, 1), (5, -2), (7, -3)] {
            let first = Shift { from, by };
            for later in (0..12).flat_map(|from| [-2, 1, 4].map(|by| Shift { from, by })) {
                let Some(joined) = first.joined_with(&later) else { continue };
                // Statements that a shift removed have no new index.
                let removed = |shift: &Shift, index: usize| {
                    shift.by < 0 && index < shift.from && index >= shift.index(shift.from)
                };
                for index in (0..40).filter(|index| !removed(&first, *index)) {
                    let between = first.index(index);
                    if !removed(&later, between) {
                        assert_eq!(joined.index(index), later.index(between), "{first:?} {later:?} {index}");
                    }
                }
            }
        }
        let mut shifts = Vec::new();
        (0..100).for_each(|at| Shift { from: 10 + at, by: 1 }.append_to(&mut shifts));
        assert_eq!(shifts, [Shift { from: 10, by: 100 }]);
    }
}
