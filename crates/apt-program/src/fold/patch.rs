//! Names that have another meaning than a chunk remembers.

use std::{collections::BTreeMap, sync::Arc};

use smol_str::SmolStr;

use super::shift::Shift;
use crate::{evaluator::State, symbols::Symbol};

/// Names with the meaning they have now; none for a name that means nothing any more.
#[derive(Debug, Clone, Default)]
pub(super) struct Patch(Option<Arc<BTreeMap<SmolStr, Option<Symbol>>>>);

impl Patch {
    /// The meanings that some names have in a state.
    pub(super) fn of(state: &State, names: &[SmolStr]) -> Self {
        if names.is_empty() {
            return Self::default();
        }
        let meanings = names.iter().map(|name| (name.clone(), state.symbol(name).cloned()));
        Self(Some(Arc::new(meanings.collect())))
    }

    /// What it says of a name; none if it says nothing.
    pub(super) fn symbol(&self, name: &SmolStr) -> Option<Option<&Symbol>> {
        Some(self.0.as_ref()?.get(name)?.as_ref())
    }

    /// The names of which it says something.
    pub(super) fn names(&self) -> impl Iterator<Item = &SmolStr> {
        self.0.iter().flat_map(|meanings| meanings.keys())
    }

    /// Gives the names of a state their meanings.
    pub(super) fn apply(&self, state: &mut State) {
        for (name, symbol) in self.0.iter().flat_map(|meanings| meanings.iter()) {
            match symbol {
                Some(symbol) => drop(state.symbols.insert(name.clone(), Arc::new(symbol.clone()))),
                None => drop(state.symbols.remove(name)),
            }
        }
    }

    /// Whether it is another clone of the same patch.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (None, None) => true,
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            _ => false,
        }
    }

    /// The same after statements were inserted or removed.
    pub(super) fn moved(&self, shift: Shift) -> Self {
        let Some(meanings) = self.0.as_ref().filter(|_| !shift.is_nothing()) else { return self.clone() };
        let mut meanings = (**meanings).clone();
        meanings.values_mut().flatten().for_each(|symbol| shift.symbol(symbol));
        Self(Some(Arc::new(meanings)))
    }

    /// This patch and then another one.
    pub(super) fn then(&self, later: &Self) -> Self {
        match (&self.0, &later.0) {
            (_, None) => self.clone(),
            (None, Some(_)) => later.clone(),
            (Some(first), Some(second)) => {
                let mut meanings = (**first).clone();
                meanings.extend(second.iter().map(|(name, symbol)| (name.clone(), symbol.clone())));
                Self(Some(Arc::new(meanings)))
            }
        }
    }
}
