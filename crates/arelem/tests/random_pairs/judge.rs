//! Runs a motion through the engine and says what became of it.

use std::{cell::Cell, collections::BTreeMap};

use apt_geometry::motion::MotionCommand;
use arelem::{
    MotionFailure,
    section2::{Output, State, execute},
    sequence::CutSequence,
    verify::verify,
};

use crate::{
    case::Case,
    search::{Found, Reader},
};

/// How often a motion may ask whether it is cancelled: the budget of its iterations.
const BUDGET: u32 = 20_000;

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
    pub(crate) faults: Vec<String>,
    /// What was said of motions that were rightly refused, and how often.
    refusals: BTreeMap<String, usize>,
}

impl Tally {
    pub(crate) fn note(&mut self, index: u64, case: &Case, verdict: Verdict) {
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
        for (words, count) in &other.refusals {
            *self.refusals.entry(words.clone()).or_default() += count;
        }
    }

    pub(crate) fn counts(&self) -> String {
        let run = self.proven + self.refused + self.wrongly_refused + self.wrong;
        format!(
            "{run} run, {} proven ({} vectors), {} rightly refused {:?}, {} wrongly refused, {} wrong, {} not drawn, {} left out",
            self.proven,
            self.vectors,
            self.refused,
            self.refusals,
            self.wrongly_refused,
            self.wrong,
            self.undrawn,
            self.left_out
        )
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

    pub(crate) fn run(&mut self, commands: &[MotionCommand]) -> Result<(), MotionFailure> {
        for command in commands {
            let spent = || {
                self.left.set(self.left.get().saturating_sub(1));
                self.left.get() == 0
            };
            let execution = execute(&self.state, command, &spent);
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
    if let Some(words) = runner.sequences.iter().find_map(fault) {
        return Verdict::Wrong(words);
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
