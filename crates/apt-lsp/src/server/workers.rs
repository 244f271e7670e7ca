//! Threads for work on snapshots.
//!
//! The allocator keeps what a thread has freed for that thread. So the thread that was busy last gets the next work, and
//! its memory is used again; a pool that takes its threads in turn would keep the memory of a run for each of them.

use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::thread::{ThreadId, current};
use std::time::Duration;

use tokio::sync::oneshot;

/// More work than this waits for its turn. Hardly ever are there more threads than there is work at a time.
const MOST_THREADS: usize = 64;

/// A thread that has had no work for so long ends, and its memory is free for the others.
const PATIENCE: Duration = Duration::from_secs(10);

type Work = Box<dyn FnOnce() + Send>;

/// The threads; they end with the last clone, when their work is done.
#[derive(Clone, Default)]
pub(super) struct Workers(Arc<Mutex<State>>);

#[derive(Default)]
struct State {
    threads: usize,
    /// The threads without work, the one that was busy last at the end.
    idle: Vec<(ThreadId, Sender<Work>)>,
    waiting: VecDeque<Work>,
}

impl Workers {
    /// Has work done. There is no answer if it panics or no thread can be had.
    pub(super) fn run<T: Send + 'static>(
        &self,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> oneshot::Receiver<T> {
        let (reply, answer) = oneshot::channel();
        self.take_up(Box::new(move || {
            let _ = reply.send(work());
        }));
        answer
    }

    fn take_up(&self, mut work: Work) {
        let mut state = locked(&self.0);
        while let Some((_, thread)) = state.idle.pop() {
            match thread.send(work) {
                Ok(()) => return,
                Err(refused) => work = refused.0, // It waits no more: there are others.
            }
        }
        state.waiting.push_back(work);
        if state.threads < MOST_THREADS {
            let own = Arc::downgrade(&self.0);
            let thread = std::thread::Builder::new().name("worker".to_owned());
            if thread.spawn(move || do_work(&own)).is_ok() {
                state.threads += 1;
            } else if state.threads == 0 {
                state.waiting.clear();
            }
        }
    }
}

/// The life of a thread.
fn do_work(state: &Weak<Mutex<State>>) {
    while let Some(work) = next_work(state) {
        // What happened stands on standard error, and the one who waits gets no answer.
        let _ = catch_unwind(AssertUnwindSafe(work));
    }
}

/// Waits for work; none when nobody can bring any.
fn next_work(state: &Weak<Mutex<State>>) -> Option<Work> {
    let (sender, receiver) = channel();
    {
        let state = state.upgrade()?;
        let mut state = locked(&state);
        if let Some(work) = state.waiting.pop_front() {
            return Some(work);
        }
        state.idle.push((current().id(), sender));
    }
    match receiver.recv_timeout(PATIENCE) {
        Ok(work) => Some(work),
        Err(RecvTimeoutError::Disconnected) => None,
        Err(RecvTimeoutError::Timeout) => {
            let state = state.upgrade()?;
            let mut state = locked(&state);
            // Work is brought under the lock: it has come by now, or never comes.
            let work = receiver.try_recv().ok();
            if work.is_none() {
                state.idle.retain(|(thread, _)| *thread != current().id());
                state.threads -= 1;
            }
            work
        }
    }
}

fn locked(state: &Mutex<State>) -> MutexGuard<'_, State> {
    // Nothing that is kept here is ever half changed.
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Waits until all threads are without work.
    fn wait_for_quiet(workers: &Workers) {
        loop {
            let state = locked(&workers.0);
            if state.idle.len() == state.threads {
                return;
            }
            drop(state);
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn work_that_comes_alone_is_always_done_by_the_same_thread() {
        let workers = Workers::default();
        let first = workers.run(|| current().id()).blocking_recv().unwrap();
        for _ in 0..100 {
            wait_for_quiet(&workers);
            assert_eq!(workers.run(|| current().id()).blocking_recv(), Ok(first));
        }
        assert_eq!(locked(&workers.0).threads, 1);
    }

    #[test]
    fn more_work_than_threads_is_all_done() {
        let workers = Workers::default();
        let (open, gate) = std::sync::mpsc::channel::<()>();
        let gate = Arc::new(Mutex::new(gate));
        let work = |number: usize| {
            let gate = Arc::clone(&gate);
            workers.run(move || {
                let _ = gate.lock().map(|gate| gate.recv());
                number
            })
        };
        let answers: Vec<_> = (0..3 * MOST_THREADS).map(work).collect();
        assert_eq!(locked(&workers.0).threads, MOST_THREADS);
        drop(open);
        let done: Vec<usize> = answers.into_iter().map(|one| one.blocking_recv().unwrap()).collect();
        assert_eq!(done, (0..3 * MOST_THREADS).collect::<Vec<_>>());
    }

    #[test]
    fn a_panic_costs_one_answer_and_no_thread() {
        let workers = Workers::default();
        let broken = workers.run(|| std::panic::resume_unwind(Box::new("on purpose")));
        assert!(Result::<(), _>::is_err(&broken.blocking_recv()));
        assert_eq!(workers.run(|| 7).blocking_recv(), Ok(7));
        wait_for_quiet(&workers);
        assert!(locked(&workers.0).threads <= 2);
    }

    #[test]
    fn the_threads_end_with_the_last_clone() {
        let workers = Workers::default();
        let clone = workers.clone();
        assert_eq!(clone.run(|| 7).blocking_recv(), Ok(7));
        let state = Arc::downgrade(&workers.0);
        drop((workers, clone));
        let mut left = 5_000;
        while state.strong_count() > 0 && left > 0 {
            std::thread::sleep(Duration::from_millis(1));
            left -= 1;
        }
        assert_eq!(state.strong_count(), 0);
    }
}
