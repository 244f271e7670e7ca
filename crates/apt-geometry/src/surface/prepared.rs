//! Surfaces that take long to make, kept for the next motions on the same definition together with the bounds that were found
//! for their parts. What is kept changes no result: a surface made anew has the same parts.

use std::sync::{
    Arc, Mutex, PoisonError, Weak,
    atomic::{AtomicUsize, Ordering},
};

use super::{PolyConicSheet, RuledSheet};
use crate::canonical::RuledSurface;

/// Surfaces of each kind that are kept: those used last.
const KEPT: usize = 8;
/// Parts with bounds, of a few hundred bytes each, above which a surface is made anew.
const MOST_PARTS: usize = 30_000;

/// What counts the parts that it has made.
pub(super) trait Parted {
    fn parts(&self) -> usize;
}

/// A number of parts. It tells no surfaces apart.
#[derive(Debug, Default)]
pub(super) struct Count(AtomicUsize);

impl Count {
    pub(super) fn add(&self, more: usize) {
        self.0.fetch_add(more, Ordering::Relaxed);
    }

    pub(super) fn get(&self) -> usize {
        self.0.load(Ordering::Relaxed)
    }
}

impl Clone for Count {
    fn clone(&self) -> Self {
        Self(AtomicUsize::new(self.get()))
    }
}

impl PartialEq for Count {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// The surfaces of the definitions used last, the last one first.
pub(super) struct Shelf<D, S>(Mutex<Vec<(Weak<D>, Arc<S>)>>);

pub(super) static RULED: Shelf<RuledSurface, RuledSheet> = Shelf::new();
pub(super) static POLY_CONIC: Shelf<Vec<f64>, PolyConicSheet> = Shelf::new();

impl<D, S: Parted> Shelf<D, S> {
    const fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// The surface of a definition, made if it is not kept; definitions are told apart by where they are stored.
    pub(super) fn get(&self, definition: &Arc<D>, make: impl FnOnce(&D) -> Option<S>) -> Option<Arc<S>> {
        if let Some(kept) = self.kept(definition) {
            return Some(kept);
        }
        let made = Arc::new(make(definition)?);
        let mut shelf = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        shelf.truncate(KEPT - 1);
        shelf.insert(0, (Arc::downgrade(definition), Arc::clone(&made)));
        Some(made)
    }

    fn kept(&self, definition: &Arc<D>) -> Option<Arc<S>> {
        let mut shelf = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        // A weak pointer keeps the place of its definition from being used again.
        shelf.retain(|(known, surface)| known.strong_count() > 0 && surface.parts() <= MOST_PARTS);
        let place =
            shelf.iter().position(|(known, _)| std::ptr::eq(known.as_ptr(), Arc::as_ptr(definition)))?;
        let found = shelf.remove(place);
        let surface = Arc::clone(&found.1);
        shelf.insert(0, found);
        Some(surface)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Thing(f64, Count);

    impl Parted for Thing {
        fn parts(&self) -> usize {
            self.1.get()
        }
    }

    #[test]
    fn surfaces_are_made_once_while_their_definition_lives() {
        let shelf: Shelf<f64, Thing> = Shelf::new();
        let made = std::cell::Cell::new(0);
        let get = |definition: &Arc<f64>| {
            let make = |x: &f64| {
                made.set(made.get() + 1);
                Some(Thing(*x, Count::default()))
            };
            shelf.get(definition, make).map(|thing| thing.0)
        };
        let (one, same) = (Arc::new(1.0), Arc::new(1.0));
        assert_eq!([get(&one), get(&one), get(&same)], [Some(1.0); 3]);
        assert_eq!(made.get(), 2, "equal definitions are not the same");
        let others: Vec<Arc<f64>> = (0..KEPT).map(|k| Arc::new(k as f64)).collect();
        for (k, other) in others.iter().enumerate() {
            assert_eq!(get(other), Some(k as f64));
        }
        assert_eq!(get(&one), Some(1.0));
        assert_eq!(made.get(), 3 + KEPT, "the one not used for longest went");
        drop((one, same, others));
        assert_eq!(get(&Arc::new(2.0)), Some(2.0));
        assert_eq!(shelf.0.lock().expect("no thread failed").len(), 1, "nothing of what is gone is kept");
    }

    #[test]
    fn a_surface_with_very_many_parts_is_made_anew() {
        let shelf: Shelf<f64, Thing> = Shelf::new();
        let definition = Arc::new(1.0);
        let get = |x: f64| shelf.get(&definition, |_| Some(Thing(x, Count::default())));
        let first = get(1.0).expect("made");
        first.1.add(MOST_PARTS + 1);
        assert_eq!(get(2.0).map(|thing| thing.0), Some(2.0));
    }

    #[test]
    fn what_cannot_be_made_is_not_kept() {
        let shelf: Shelf<f64, Thing> = Shelf::new();
        let definition = Arc::new(1.0);
        assert!(shelf.get(&definition, |_| None).is_none());
        assert!(shelf.get(&definition, |x| Some(Thing(*x, Count::default()))).is_some());
    }
}
