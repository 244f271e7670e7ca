//! The memo of motions: a motion whose inputs did not change is not computed again.
//!
//! The key is the content of the modal state and of the command, so an edit before or after a motion that leaves both
//! as they were costs nothing.

use std::{
    collections::HashMap,
    fmt::{Debug, Write},
    hash::Hasher,
    sync::{Arc, Mutex, PoisonError},
};

use apt_geometry::{motion::MotionCommand, regional::RegionalMilling};
use apt_sculptured::mill::{Milled, Setting};
use arelem::{
    cure::{Patience, Remedy},
    section2::{Execution, Output, State},
    story::{Story, tell},
    verify::{Evidence, VerifyError},
};
use rustc_hash::{FxBuildHasher, FxHasher};

/// A motion that has been computed and verified.
#[derive(Debug)]
pub struct ComputedMotion {
    state: State,
    command: MotionCommand,
    /// What the engine answered.
    pub execution: Execution,
    /// What the verifier found; `None` where there was nothing to verify.
    pub evidence: Option<Result<Evidence, VerifyError>>,
    /// What would cure the failure, if there is one.
    pub remedies: Vec<Remedy>,
    /// What may be spent on trying more cures.
    pub patience: Patience,
    /// How long engine and verifier took, seconds; for people, never for decisions.
    pub seconds: f64,
}

impl ComputedMotion {
    /// The story of the motion; none for a failure, for commands that do not move along surfaces, and once `cancel` says true.
    pub fn story(&self, cancel: &dyn Fn() -> bool) -> Option<Story> {
        match &self.execution.output {
            Some(Output::Sequence(sequence)) => tell(&self.state, &self.command, sequence, cancel),
            _ => None,
        }
    }
}

/// What computing a motion gives.
#[derive(Debug)]
pub struct Computation {
    /// The engine's answer.
    pub execution: Execution,
    /// The verifier's, if there was something to verify.
    pub evidence: Option<Result<Evidence, VerifyError>>,
    /// What would cure a failure.
    pub remedies: Vec<Remedy>,
    /// What may be spent on trying cures.
    pub patience: Patience,
    /// The time taken, seconds.
    pub seconds: f64,
}

/// How often the memo had the answer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct MemoCounters {
    /// Motions taken from the memo.
    pub reused: u64,
    /// Motions computed.
    pub computed: u64,
}

#[derive(Debug)]
struct Entry {
    motion: Arc<ComputedMotion>,
    last_run: u64,
}

/// A path of regional milling with what it was made from.
#[derive(Debug)]
struct MilledEntry {
    setting: Setting,
    command: RegionalMilling,
    milled: Arc<Milled>,
    last_run: u64,
}

#[derive(Debug, Default)]
struct Inner {
    entries: HashMap<u64, Vec<Entry>, FxBuildHasher>,
    milled: HashMap<u64, Vec<MilledEntry>, FxBuildHasher>,
    run: u64,
    counters: MemoCounters,
}

/// The memo; cheap to clone, all clones share one table.
#[derive(Debug, Clone, Default)]
pub struct MotionMemo {
    inner: Arc<Mutex<Inner>>,
}

/// Motions that no run has used for this many runs are forgotten.
const RUNS_KEPT: u64 = 8;

impl MotionMemo {
    /// Marks the start of a run and forgets motions that have long been unused.
    pub fn begin_run(&self) {
        let mut inner = self.lock();
        inner.run += 1;
        let oldest = inner.run.saturating_sub(RUNS_KEPT);
        inner.entries.retain(|_, bucket| {
            bucket.retain(|entry| entry.last_run >= oldest);
            !bucket.is_empty()
        });
        inner.milled.retain(|_, bucket| {
            bucket.retain(|entry| entry.last_run >= oldest);
            !bucket.is_empty()
        });
    }

    /// The counters since the memo was made.
    pub fn counters(&self) -> MemoCounters {
        self.lock().counters
    }

    /// How many motions and paths of regional milling are kept.
    pub fn len(&self) -> usize {
        let inner = self.lock();
        inner.entries.values().map(Vec::len).sum::<usize>()
            + inner.milled.values().map(Vec::len).sum::<usize>()
    }

    /// Whether nothing is kept.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The motion of this command in this state: from the memo, or computed by `compute`, which gives `None` when it
    /// was cancelled.
    pub fn get_or_compute(
        &self,
        state: &State,
        command: &MotionCommand,
        compute: impl FnOnce() -> Option<Computation>,
    ) -> Option<Arc<ComputedMotion>> {
        let key = content_hash(state, command);
        if let Some(found) = self.find(key, state, command) {
            return Some(found);
        }
        let Computation { execution, evidence, remedies, patience, seconds } = compute()?;
        let motion = Arc::new(ComputedMotion {
            state: state.clone(),
            command: command.clone(),
            execution,
            evidence,
            remedies,
            patience,
            seconds,
        });
        let mut inner = self.lock();
        inner.counters.computed += 1;
        let last_run = inner.run;
        inner.entries.entry(key).or_default().push(Entry { motion: Arc::clone(&motion), last_run });
        Some(motion)
    }

    /// The path of this SMIL with these modal data: from the memo, or computed by `compute`, which gives `None` when it was
    /// cancelled.
    pub fn get_or_mill(
        &self,
        setting: &Setting,
        command: &RegionalMilling,
        compute: impl FnOnce() -> Option<Milled>,
    ) -> Option<Arc<Milled>> {
        let key = content_hash(setting, command);
        {
            let mut inner = self.lock();
            let run = inner.run;
            let same = |entry: &&mut MilledEntry| entry.setting == *setting && entry.command == *command;
            if let Some(entry) = inner.milled.get_mut(&key).and_then(|bucket| bucket.iter_mut().find(same)) {
                entry.last_run = run;
                let found = Arc::clone(&entry.milled);
                inner.counters.reused += 1;
                return Some(found);
            }
        }
        let milled = Arc::new(compute()?);
        let mut inner = self.lock();
        inner.counters.computed += 1;
        let (last_run, command) = (inner.run, command.clone());
        let entry = MilledEntry { setting: *setting, command, milled: Arc::clone(&milled), last_run };
        inner.milled.entry(key).or_default().push(entry);
        Some(milled)
    }

    fn find(&self, key: u64, state: &State, command: &MotionCommand) -> Option<Arc<ComputedMotion>> {
        let mut inner = self.lock();
        let run = inner.run;
        let bucket = inner.entries.get_mut(&key)?;
        let entry = bucket
            .iter_mut()
            .find(|entry| entry.motion.state == *state && entry.motion.command == *command)?;
        entry.last_run = run;
        let found = Arc::clone(&entry.motion);
        inner.counters.reused += 1;
        Some(found)
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Inner> {
        // A panic while the lock is held can only lose an entry, never corrupt one.
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Hashes the `Debug` form, which writes every number so that it reads back to the same bits.
fn content_hash(state: &impl Debug, command: &impl Debug) -> u64 {
    struct Sink(FxHasher);
    impl Write for Sink {
        fn write_str(&mut self, text: &str) -> std::fmt::Result {
            self.0.write(text.as_bytes());
            Ok(())
        }
    }
    let mut sink = Sink(FxHasher::default());
    // Writing to the hasher cannot fail.
    let _ = write!(sink, "{state:?}{command:?}");
    sink.0.finish()
}

#[cfg(test)]
mod tests {
    use arelem::section2::execute;

    use super::*;

    fn ask(memo: &MotionMemo, state: &State, limit: u32) -> Arc<ComputedMotion> {
        let command = MotionCommand::MaximumPoints(limit);
        let compute = || {
            let execution = execute(state, &command, &|| false);
            let patience = Patience::after(0);
            Some(Computation { execution, evidence: None, remedies: Vec::new(), patience, seconds: 0.0 })
        };
        memo.get_or_compute(state, &command, compute).unwrap()
    }

    #[test]
    fn the_same_command_in_the_same_state_is_computed_once() {
        let (memo, state) = (MotionMemo::default(), State::new(1.0));
        memo.begin_run();
        let first = ask(&memo, &state, 5);
        let second = ask(&memo.clone(), &state.clone(), 5);
        assert!(Arc::ptr_eq(&first, &second));
        assert_eq!(memo.counters(), MemoCounters { reused: 1, computed: 1 });
    }

    #[test]
    fn another_command_and_another_state_are_computed_anew() {
        let (memo, state) = (MotionMemo::default(), State::new(1.0));
        memo.begin_run();
        let first = ask(&memo, &state, 5);
        let other = ask(&memo, &state, 6);
        assert!(!Arc::ptr_eq(&first, &other));
        let later = ask(&memo, &first.execution.state, 5);
        assert!(!Arc::ptr_eq(&first, &later));
        assert_eq!(memo.counters(), MemoCounters { reused: 0, computed: 3 });
    }

    #[test]
    fn what_was_cancelled_is_not_remembered() {
        let (memo, state) = (MotionMemo::default(), State::new(1.0));
        memo.begin_run();
        let command = MotionCommand::MaximumPoints(5);
        assert!(memo.get_or_compute(&state, &command, || None).is_none());
        assert_eq!(memo.counters(), MemoCounters::default());
        ask(&memo, &state, 5);
        assert_eq!(memo.counters(), MemoCounters { reused: 0, computed: 1 });
    }

    #[test]
    fn a_motion_is_forgotten_when_no_run_uses_it() {
        let (memo, state) = (MotionMemo::default(), State::new(1.0));
        memo.begin_run();
        ask(&memo, &state, 5);
        ask(&memo, &state, 6);
        for _ in 0..RUNS_KEPT {
            memo.begin_run();
            ask(&memo, &state, 5);
        }
        let before = memo.counters();
        ask(&memo, &state, 6);
        assert_eq!(memo.counters().reused, before.reused + 1, "still there after {RUNS_KEPT} runs");
        for _ in 0..=RUNS_KEPT {
            memo.begin_run();
            ask(&memo, &state, 5);
        }
        let before = memo.counters();
        ask(&memo, &state, 6);
        assert_eq!(memo.counters().computed, before.computed + 1, "forgotten");
        ask(&memo, &state, 5);
        assert_eq!(memo.counters().reused, before.reused + 1, "kept, because every run used it");
    }
}
