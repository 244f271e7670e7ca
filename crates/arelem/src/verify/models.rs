//! Models of a surface that are kept with its definition, one for each accuracy that was asked, so that motions with the same
//! bands share them and none depends on those before.

use std::sync::{Arc, Mutex, PoisonError};

/// What the fit of a patch of a model counts in units of work.
pub(super) const WORK_OF_PATCH: u32 = 64;

/// Models of one surface by how far they may be off it.
#[derive(Debug)]
pub(super) struct Models<M>(Mutex<Vec<(f64, Arc<M>)>>);

impl<M> Default for Models<M> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<M> Models<M> {
    /// The one that may be off by `accuracy`; made now if it is not kept. None, and none is kept, if it cannot be made or is given up.
    pub(super) fn within(&self, accuracy: f64, make: impl FnOnce(f64) -> Option<M>) -> Option<Arc<M>> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, kept)) = all.iter().find(|(of, _)| of.total_cmp(&accuracy).is_eq()) {
            return Some(Arc::clone(kept));
        }
        let model = Arc::new(make(accuracy)?);
        all.push((accuracy, Arc::clone(&model)));
        Some(model)
    }

    /// The sum of something over those that are kept.
    pub(super) fn sum(&self, of: impl Fn(&M) -> usize) -> usize {
        let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.iter().map(|(_, model)| of(model)).sum()
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn each_accuracy_has_its_model_which_is_made_once() {
        let (models, times) = (Models::default(), Cell::new(0));
        let of = |accuracy: f64| {
            let model = models.within(accuracy, |accuracy| {
                times.set(times.get() + 1);
                Some(accuracy)
            });
            model.map(|model| *model)
        };
        assert_eq!([1e-9, 1e-7, 1e-9, 1e-7].map(of), [Some(1e-9), Some(1e-7), Some(1e-9), Some(1e-7)]);
        assert_eq!((times.get(), models.sum(|_| 3)), (2, 6));
    }

    #[test]
    fn what_cannot_be_made_is_none() {
        let models = Models::<f64>::default();
        assert_eq!(models.within(1e-3, |_| None), None);
        assert_eq!(models.sum(|_| 1), 0);
    }
}
