//! What parts keep of themselves, without being told apart by it.

use std::sync::{
    OnceLock,
    atomic::{AtomicUsize, Ordering},
};

/// Something made when it is first asked for. It tells no surfaces apart.
#[derive(Debug, Clone)]
pub(in super::super) struct Later<T>(OnceLock<T>);

impl<T> Later<T> {
    pub(in super::super) fn new() -> Self {
        Self(OnceLock::new())
    }

    pub(in super::super) fn get(&self, make: impl FnOnce() -> T) -> &T {
        self.0.get_or_init(make)
    }

    /// What has been made, if it has been asked for.
    pub(in super::super) fn made(&self) -> Option<&T> {
        self.0.get()
    }
}

impl<T> PartialEq for Later<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A number of parts. It tells no surfaces apart.
#[derive(Debug, Default)]
pub(in super::super) struct Count(AtomicUsize);

impl Count {
    pub(in super::super) fn add(&self, more: usize) {
        self.0.fetch_add(more, Ordering::Relaxed);
    }

    pub(in super::super) fn get(&self) -> usize {
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
