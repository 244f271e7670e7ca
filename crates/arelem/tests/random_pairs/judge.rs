//! Runs a motion through the engine and says what became of it.

use std::{
    cell::Cell,
    collections::BTreeMap,
    time::{Duration, Instant},
};

use apt_geometry::motion::MotionCommand;
use arelem::{
    MotionFailure,
    section2::{Output, State, execute},
    sequence::CutSequence,
    verify::{VerifyError, verify},
};

use crate::{
    case::Case,
    search::{Found, Reader},
};

/// How often a motion may ask whether it is cancelled: the budget of its clearances, more or less, in engine and verifier.
const BUDGET: u32 = 1_500_000;

/// What became of a motion.
#[derive(Debug, Clone)]
pub(crate) enum Verdict {
    /// Proven by the verifier; with so many cut vectors.
    Proven(usize),
    /// Refused, and the search finds no path either.
    Refused(String),
    /// Refused though the search finds a path.
    WronglyRefused(String),
    /// Delivered, and the verifier does not accept it.
    Wrong(String),
    /// Neither delivered nor refused within the budget.
    Slow(String),
}

/// Counts for a pair of surfaces.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) undrawn: usize,
    /// Not looked at for lack of time.
    pub(crate) left_out: usize,
    pub(crate) proven: usize,
    vectors: usize,
    refused: usize,
    wrongly_refused: usize,
    wrong: usize,
    slow: usize,
    /// What it took; it decides nothing.
    time: Duration,
    pub(crate) faults: Vec<String>,
    /// What was said of motions that were rightly refused, and how often.
    refusals: BTreeMap<String, usize>,
}

impl Tally {
    /// Counts a verdict, and what it took since `began`.
    pub(crate) fn note(&mut self, index: u64, case: &Case, (verdict, began): (Verdict, Instant)) {
        self.time += began.elapsed();
        match verdict {
            Verdict::Proven(vectors) => {
                self.proven += 1;
                self.vectors += vectors;
            }
            Verdict::Refused(words) => {
                self.refused += 1;
                *self.refusals.entry(words).or_default() += 1;
            }
            Verdict::WronglyRefused(words) => {
                self.wrongly_refused += 1;
                self.faults.push(format!("#{index} {}: wrongly refused: {words}", case.shape));
            }
            Verdict::Wrong(words) => {
                self.wrong += 1;
                self.faults.push(format!("#{index} {}: wrong: {words}", case.shape));
            }
            Verdict::Slow(words) => {
                self.slow += 1;
                self.faults.push(format!("#{index} {}: too slow: {words}", case.shape));
            }
        }
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.undrawn += other.undrawn;
        self.left_out += other.left_out;
        self.proven += other.proven;
        self.vectors += other.vectors;
        self.refused += other.refused;
        self.wrongly_refused += other.wrongly_refused;
        self.wrong += other.wrong;
        self.slow += other.slow;
        self.time += other.time;
        for (words, count) in &other.refusals {
            *self.refusals.entry(words.clone()).or_default() += count;
        }
    }

    /// Names of the columns of [`Tally::row`].
    pub(crate) const COLUMNS: &'static str =
        "run, proven, vectors, rightly refused, wrongly refused, wrong, slow, not drawn, left out, ms each";

    pub(crate) fn row(&self) -> String {
        let run = self.proven + self.refused + self.wrongly_refused + self.wrong + self.slow;
        let each = self.time.as_secs_f64() * 1e3 / run.max(1) as f64;
        let counts = [
            run,
            self.proven,
            self.vectors,
            self.refused,
            self.wrongly_refused,
            self.wrong,
            self.slow,
            self.undrawn,
            self.left_out,
        ];
        let mut row: String = counts.iter().map(|count| format!("{count:>9}")).collect();
        row += &format!("{each:>9.1}");
        row
    }

    /// What was said of the motions that were rightly refused.
    pub(crate) fn refusals(&self) -> String {
        self.refusals.iter().map(|(words, count)| format!("{words} {count}")).collect::<Vec<_>>().join(", ")
    }
}

/// Executes commands one after the other within the budget.
pub(crate) struct Runner {
    pub(crate) state: State,
    pub(crate) sequences: Vec<CutSequence>,
    left: Cell<u32>,
}

impl Runner {
    pub(crate) fn new() -> Self {
        Self { state: State::new(1.0), sequences: Vec::new(), left: Cell::new(BUDGET) }
    }

    fn spent(&self) -> bool {
        self.left.set(self.left.get().saturating_sub(1));
        self.left.get() == 0
    }

    pub(crate) fn run(&mut self, commands: &[MotionCommand]) -> Result<(), MotionFailure> {
        for command in commands {
            let execution = execute(&self.state, command, &|| self.spent());
            self.state = execution.state;
            if let Some(failure) = execution.failure {
                return Err(failure);
            }
            if let Some(Output::Sequence(sequence)) = execution.output {
                self.sequences.push(sequence);
            }
        }
        Ok(())
    }
}

/// Why a sequence is not proven, if it is not.
pub(crate) fn fault(sequence: &CutSequence) -> Option<String> {
    match verify(sequence, &|| false) {
        Ok(evidence) if evidence.verified => None,
        Ok(evidence) => Some(format!("{} vectors: {:?}", sequence.points.len(), evidence.violations)),
        Err(error) => Some(format!("{} vectors: {error:?}", sequence.points.len())),
    }
}

pub(crate) fn judge(case: &Case) -> Verdict {
    let mut runner = Runner::new();
    let outcome = runner.run(&case.commands());
    for sequence in &runner.sequences {
        let vectors = sequence.points.len();
        match verify(sequence, &|| runner.spent()) {
            Ok(evidence) if evidence.verified => {}
            Err(VerifyError::Cancelled) => return Verdict::Slow(format!("{vectors} vectors to verify")),
            _ => return Verdict::Wrong(fault(sequence).unwrap_or_default()),
        }
    }
    if matches!(outcome, Err(MotionFailure::Cancelled)) {
        return Verdict::Slow(format!("after {} sequences", runner.sequences.len()));
    }
    let Err(failure) = outcome else {
        return Verdict::Proven(runner.sequences.iter().map(|s| s.points.len()).sum());
    };
    let words = format!("{failure:?}");
    let reader = Reader::new(case);
    let start = if runner.sequences.is_empty() { None } else { runner.state.tip };
    match reader.search(start) {
        Found::Path(length) => Verdict::WronglyRefused(format!("a path of {length:.3}: {words}")),
        // The start-up alone was refused, and there is a start.
        found @ (Found::Ends(_) | Found::NotMet) if start.is_none() => {
            Verdict::WronglyRefused(format!("a start, then {found:?}: {words}"))
        }
        _ => Verdict::Refused(words.split([' ', '{', '(']).next().unwrap_or_default().to_owned()),
    }
}
