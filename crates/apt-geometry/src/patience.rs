//! Who waits for an answer that may take long, and may give it up.
//!
//! Searches say how much work they do; once in so much of it they ask. What is given up has not been shown: searches answer as they
//! do where they find no bound.

use std::{
    cell::Cell,
    ops::{Deref, DerefMut},
};

/// Work between two questions. A unit takes up to some microseconds.
const WORK_BETWEEN_QUESTIONS: u32 = 256;

/// Somebody who waits, and who is not asked again once he has given up.
pub struct Waiting<'a> {
    cancel: &'a dyn Fn() -> bool,
    has_given_up: Cell<bool>,
    /// Work that is done before the next question.
    left: Cell<u32>,
}

impl<'a> Waiting<'a> {
    /// Somebody who says when to give up.
    pub fn until(cancel: &'a dyn Fn() -> bool) -> Self {
        Self { cancel, has_given_up: Cell::new(false), left: Cell::new(WORK_BETWEEN_QUESTIONS) }
    }

    /// Asks; whether he has given up.
    pub fn is_over(&self) -> bool {
        self.left.set(WORK_BETWEEN_QUESTIONS);
        let over = self.has_given_up() || (self.cancel)();
        self.has_given_up.set(over);
        over
    }

    /// Whether he is known to have given up.
    pub fn has_given_up(&self) -> bool {
        self.has_given_up.get()
    }

    /// What long searches ask.
    pub fn patience(&self) -> Patience<'_> {
        Patience(Some(self))
    }
}

/// Gives back, on a thread of its own, something of so many parts that nobody needs any more, so that nobody waits until
/// all its memory is free. Little is given back at once, and so is all where no thread can be had.
pub fn put_away<T: Send + 'static>(thing: T, parts: usize) {
    if parts >= PARTS_FOR_A_THREAD {
        // Where it does not start, what it was to do is dropped, and the thing with it.
        drop(std::thread::Builder::new().name("put away".to_owned()).spawn(move || drop(thing)));
    }
}

/// A list that is put away when nobody needs it any more, also where the work on it is given up half done.
#[derive(Debug)]
pub struct Aside<T: Send + 'static>(Vec<T>);

impl<T: Send + 'static> Aside<T> {
    /// The list, which somebody needs.
    pub fn taken(mut self) -> Vec<T> {
        std::mem::take(&mut self.0)
    }
}

impl<T: Send + 'static> From<Vec<T>> for Aside<T> {
    fn from(list: Vec<T>) -> Self {
        Self(list)
    }
}

impl<T: Send + 'static> Deref for Aside<T> {
    type Target = Vec<T>;

    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<T: Send + 'static> DerefMut for Aside<T> {
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.0
    }
}

impl<T: Send + 'static> Drop for Aside<T> {
    fn drop(&mut self) {
        // Memory without things is given back as well.
        let parts = self.0.capacity();
        put_away(std::mem::take(&mut self.0), parts);
    }
}

/// Parts that are given back in about as long as a thread takes to start.
const PARTS_FOR_A_THREAD: usize = 1024;

/// How long a search may go on; without end if nobody waits.
#[derive(Clone, Copy, Default)]
pub struct Patience<'a>(Option<&'a Waiting<'a>>);

impl Patience<'_> {
    /// Counts work, and asks once in so much of it; whether the search is to be given up.
    pub fn ends_after(&self, work: u32) -> bool {
        let Some(waiting) = self.0 else { return false };
        let left = waiting.left.get();
        if left > work {
            waiting.left.set(left - work);
            return waiting.has_given_up();
        }
        waiting.is_over()
    }

    /// Counts things that are looked at one after the other, of which so many are done, where `a_unit` of them are one unit
    /// of work; whether the search is to be given up.
    pub fn ends_among(&self, done: usize, a_unit: usize) -> bool {
        self.ends_after(u32::from(done % a_unit == a_unit - 1))
    }

    /// Asks; whether the search is to be given up.
    pub fn is_over(&self) -> bool {
        self.0.is_some_and(Waiting::is_over)
    }

    /// The same as far as it is known without a question.
    pub fn was_over(&self) -> bool {
        self.0.is_some_and(Waiting::has_given_up)
    }
}

impl std::fmt::Debug for Patience<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Patience").field("has_limit", &self.0.is_some()).finish()
    }
}

/// What is measured does not depend on who waits for it.
impl PartialEq for Patience<'_> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_waits_is_asked_once_in_so_much_work_and_never_again_once_he_has_given_up() {
        let asked = Cell::new(0);
        let cancel = || {
            asked.set(asked.get() + 1);
            asked.get() == 3
        };
        let waiting = Waiting::until(&cancel);
        let patience = waiting.patience();
        let mut done = 0;
        while !patience.ends_after(8) {
            done += 8;
            assert!(!patience.was_over());
        }
        assert!(patience.was_over() && patience.is_over() && waiting.is_over() && patience.ends_after(1_000));
        assert_eq!(asked.get(), 3);
        assert_eq!(done / WORK_BETWEEN_QUESTIONS, 2, "{done}");
        assert!(!Patience::default().ends_after(u32::MAX));
    }

    #[test]
    fn what_nobody_needs_is_given_back_much_of_it_elsewhere() {
        use std::{
            sync::mpsc::{Sender, channel},
            thread::{ThreadId, current},
        };

        struct Told(Sender<ThreadId>);
        impl Drop for Told {
            fn drop(&mut self) {
                let _ = self.0.send(current().id());
            }
        }

        let (tell, told) = channel();
        put_away(Told(tell.clone()), 1);
        assert_eq!(told.recv(), Ok(current().id()));
        put_away(Told(tell.clone()), PARTS_FOR_A_THREAD);
        assert!(told.recv().is_ok_and(|thread| thread != current().id()));
        let mut list = Aside::from(Vec::with_capacity(PARTS_FOR_A_THREAD));
        list.push(Told(tell.clone()));
        drop(list);
        assert!(told.recv().is_ok_and(|thread| thread != current().id()));
        let few = Aside::from(vec![Told(tell)]);
        drop(few.taken());
        assert_eq!(told.recv(), Ok(current().id()));
    }
}
