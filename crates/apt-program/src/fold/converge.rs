//! Whether a new evaluation has come to the state that the old one had at the same statement.

use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::{chunk::Chunk, shift::Shift};
use crate::{
    evaluator::State,
    symbols::{Meaning, Symbol},
};

/// Most names that may differ where an old evaluation takes over.
const MOST_DIFFERENT: usize = 256;

/// The names in which `new` differs from the state before an old chunk moved by `shift`, in alphabetic order, given that
/// they can differ in `names` only. `None` when they differ in more than the meaning of some names.
///
/// Both evaluations started from one state; so only names that one of them touched since can differ.
pub(super) fn differing(
    new: &State,
    old: &Chunk,
    shift: Shift,
    names: &FxHashSet<SmolStr>,
) -> Option<Vec<SmolStr>> {
    if !new.same_modal_values(old.modal_before()) || new.reached != shift.index(old.reached()) {
        return None;
    }
    let mut different = Vec::new();
    for name in names {
        if !same_symbol(new.symbol(name), old.symbol_before(name).as_ref(), shift) {
            different.push(name.clone());
            if different.len() > MOST_DIFFERENT {
                return None;
            }
        }
    }
    different.sort_unstable();
    Some(different)
}

/// Whether two symbols mean the same and come from the same place.
fn same_symbol(new: Option<&Symbol>, old: Option<&Symbol>, shift: Shift) -> bool {
    match (new, old) {
        (None, None) => true,
        (Some(new), Some(old)) => {
            let mut moved = old.origin.clone();
            shift.origin(&mut moved);
            new.origin == moved && same_meaning(&new.meaning, &old.meaning, shift)
        }
        _ => false,
    }
}

/// Whether two meanings are the same; the body of a macro may have moved.
fn same_meaning(new: &Meaning, old: &Meaning, shift: Shift) -> bool {
    match (new, old) {
        (Meaning::Macro(new), Meaning::Macro(old)) => {
            let mut moved = (**old).clone();
            moved.body.first_isn = shift.isn(moved.body.first_isn);
            new.same_text(&moved)
        }
        _ => new.same(old),
    }
}
