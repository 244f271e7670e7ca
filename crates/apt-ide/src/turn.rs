//! One does the work, the others wait for its result instead of doing it as well.

use std::{
    sync::{Mutex, MutexGuard, PoisonError, TryLockError},
    time::Duration,
};

use crate::{Cancel, Cancelled};

/// How often somebody who waits looks whether the wait is over, or not wanted any more.
const PAUSE: Duration = Duration::from_micros(500);

/// The right to do a piece of work.
#[derive(Debug, Default)]
pub(crate) struct Turn(Mutex<()>);

impl Turn {
    /// Waits until nobody else does the work.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before.
    pub(crate) fn wait(&self, cancel: Cancel<'_>) -> Result<MutexGuard<'_, ()>, Cancelled> {
        loop {
            match self.0.try_lock() {
                Ok(turn) => return Ok(turn),
                // Nothing is kept under the lock, so nothing can be broken by a panic.
                Err(TryLockError::Poisoned(turn)) => return Ok(PoisonError::into_inner(turn)),
                Err(TryLockError::WouldBlock) if cancel() => return Err(Cancelled),
                Err(TryLockError::WouldBlock) => std::thread::sleep(PAUSE),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_has_the_turn_and_another_can_give_up_waiting() {
        let turn = Turn::default();
        let held = turn.wait(&|| false).unwrap();
        assert!(turn.wait(&|| true).is_err());
        drop(held);
        assert!(turn.wait(&|| true).is_ok(), "a free turn is taken without asking");
    }
}
