//! A definition with what was made from it: surfaces take long to make, and many motions ask the same one.

use std::{
    any::Any,
    fmt,
    ops::Deref,
    sync::{Arc, Mutex, PoisonError},
};

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Parts, of a few hundred bytes each, above which something is made anew.
const MOST_PARTS: usize = 30_000;

/// What can be kept with a definition.
pub trait Made: Any + Send + Sync {
    /// The parts that it has by now: a measure of its memory.
    fn parts(&self) -> usize;
}

/// A definition that its clones share, together with what was made from it, one of each type.
///
/// It is equal to others, written and read as the definition alone. What is kept follows from the definition and changes
/// no result; it goes with the last clone.
pub struct Remembering<D>(Arc<Entry<D>>);

struct Entry<D> {
    definition: D,
    made: Mutex<Vec<Arc<dyn Any + Send + Sync>>>,
}

impl<D> Remembering<D> {
    /// The definition with nothing made from it yet.
    pub fn new(definition: D) -> Self {
        Self(Arc::new(Entry { definition, made: Mutex::new(Vec::new()) }))
    }

    /// What of this type was made from the definition; made now if it is not kept. `None` is not kept.
    pub fn made<T: Made>(&self, make: impl FnOnce(&D) -> Option<T>) -> Option<Arc<T>> {
        if let Some(kept) = self.kept() {
            return Some(kept);
        }
        // Not under the lock: other types are made from the same definition meanwhile.
        let made = Arc::new(make(&self.0.definition)?);
        let mut all = self.0.made.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|kept| !kept.as_ref().is::<T>());
        all.push(Arc::clone(&made) as Arc<dyn Any + Send + Sync>);
        Some(made)
    }

    fn kept<T: Made>(&self) -> Option<Arc<T>> {
        let all = self.0.made.lock().unwrap_or_else(PoisonError::into_inner);
        let found = all.iter().find_map(|kept| Arc::clone(kept).downcast::<T>().ok())?;
        (found.parts() <= MOST_PARTS).then_some(found)
    }
}

impl<D> Deref for Remembering<D> {
    type Target = D;

    fn deref(&self) -> &D {
        &self.0.definition
    }
}

impl<D> Clone for Remembering<D> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<D: PartialEq> PartialEq for Remembering<D> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<D: fmt::Debug> fmt::Debug for Remembering<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

impl<D: Serialize> Serialize for Remembering<D> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (**self).serialize(serializer)
    }
}

impl<'de, D: Deserialize<'de>> Deserialize<'de> for Remembering<D> {
    fn deserialize<S: Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        D::deserialize(deserializer).map(Self::new)
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    struct Half(f64);
    struct Root {
        value: f64,
        parts: usize,
    }

    impl Made for Half {
        fn parts(&self) -> usize {
            1
        }
    }

    impl Made for Root {
        fn parts(&self) -> usize {
            self.parts
        }
    }

    #[test]
    fn clones_share_what_was_made_and_equals_do_not() {
        let times = Cell::new(0);
        let half = |of: &Remembering<f64>| {
            let made = of.made(|x| {
                times.set(times.get() + 1);
                Some(Half(0.5 * x))
            });
            made.map(|half| half.0)
        };
        let (one, other) = (Remembering::new(4.0), Remembering::new(4.0));
        assert_eq!([half(&one), half(&one.clone()), half(&one)], [Some(2.0); 3]);
        assert_eq!(times.get(), 1);
        assert_eq!((half(&other), times.get()), (Some(2.0), 2));
        assert_eq!(one, other);
    }

    #[test]
    fn each_type_is_kept_beside_the_others() {
        let one = Remembering::new(4.0);
        let root = |x: &f64| Some(Root { value: x.sqrt(), parts: 1 });
        assert_eq!(one.made(|x| Some(Half(0.5 * x))).map(|made| made.0), Some(2.0));
        assert_eq!(one.made(root).map(|made| made.value), Some(2.0));
        assert!(one.made::<Half>(|_| None).is_some());
        assert!(one.made::<Root>(|_| None).is_some());
    }

    #[test]
    fn what_cannot_be_made_or_has_very_many_parts_is_tried_again() {
        let one = Remembering::new(4.0);
        assert!(one.made::<Root>(|_| None).is_none());
        let large = |x: &f64| Some(Root { value: *x, parts: MOST_PARTS + 1 });
        let small = |x: &f64| Some(Root { value: x + 1.0, parts: MOST_PARTS });
        assert_eq!(one.made(large).map(|made| made.value), Some(4.0));
        assert_eq!(one.made(small).map(|made| made.value), Some(5.0));
        assert_eq!(one.made(large).map(|made| made.value), Some(5.0));
    }

    #[test]
    fn what_was_made_goes_with_the_last_clone() {
        let one = Remembering::new(4.0);
        let other = one.clone();
        let made = one.made(|x| Some(Half(0.5 * x))).map(|made| Arc::downgrade(&made));
        drop(one);
        assert!(made.as_ref().is_some_and(|made| made.strong_count() == 1));
        drop(other);
        assert!(made.is_some_and(|made| made.strong_count() == 0));
    }
}
