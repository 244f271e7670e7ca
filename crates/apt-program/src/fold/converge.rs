//! Whether a new evaluation has come to the state that the old one had at the same statement.

use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::shift::Shift;
use crate::{
    evaluator::State,
    symbols::{Meaning, Symbol},
};

/// Whether `new` equals `old` moved by `shift`, given that they can differ in `names` only.
///
/// Both evaluations started from one state; so only names that one of them touched since can differ.
pub(super) fn same_state(new: &State, old: &State, shift: Shift, names: &FxHashSet<SmolStr>) -> bool {
    new.same_modal_values(old)
        && new.reached == shift.index(old.reached)
        && names.iter().all(|name| same_symbol(new.symbol(name), old.symbol(name), shift))
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
