//! Runs a motion through the engine and says what became of it.

use std::{
    cell::Cell,
    collections::BTreeMap,
    sync::OnceLock,
    time::{Duration, Instant},
};

use apt_geometry::{Vec3, motion::MotionCommand};
use arelem::{
    MotionFailure,
    section2::{Output, State, execute},
    sequence::CutSequence,
    verify::{VerifyError, verify},
};

use crate::{
    case::Case,
    dense,
    ends::ToldEnd,
    laws::Laws,
    number,
    search::{Found, Reader},
};

/// What may be spent on a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Budget {
    /// How often it may ask whether it is cancelled: once for each clearance, more or less, and for what searches for it take.
    asks: u32,
    /// Clearances that the search for a path may read.
    pub(crate) reads: u32,
    /// Questions of the verifier while it reads for the search: its own searches count too.
    pub(crate) asks_of_search: u32,
}

impl Budget {
    /// Of motions whose distances are computed.
    const COMPUTED: Self = Self { asks: 1_500_000, reads: 60_000, asks_of_search: 1_500_000 };
    /// Where distances are searched for, which cost as much more.
    const SEARCHED: Self = Self { asks: 180_000, reads: 10_000, asks_of_search: 300_000 };

    /// The budget of a motion, if distances to one of its surfaces are searched for or not; `APT_BUDGET` times that.
    pub(crate) fn of(searched: bool) -> Self {
        let Self { asks, reads, asks_of_search } = if searched { Self::SEARCHED } else { Self::COMPUTED };
        let times = number("APT_BUDGET").and_then(|times| u32::try_from(times).ok()).unwrap_or(1);
        let [asks, reads, asks_of_search] =
            [asks, reads, asks_of_search].map(|most| most.saturating_mul(times));
        Self { asks, reads, asks_of_search }
    }
}

/// A motion that takes longer tells where the time goes; that decides nothing. With `APT_SILENT` one tells, too, that asks longer than so
/// many microseconds not whether to go on.
const LONG: Duration = Duration::from_secs(1);
/// Positions of a sequence that is not proven that are shown.
const SHOWN: usize = 12;

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
    /// Proven with more cut vectors than are needed.
    Lavish(String),
    /// Neither delivered nor refused within the budget.
    Slow(String),
    /// Refused, and the search for a path did not end within its own budget.
    NotJudged(String),
}

/// What engine, verifier and search took.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Times {
    engine: Duration,
    verifier: Duration,
    search: Duration,
    /// The longest that engine and verifier did not ask whether to go on.
    silent: [Duration; 2],
}

impl Times {
    fn all(&self) -> Duration {
        self.engine + self.verifier + self.search
    }

    fn add(&mut self, other: &Self) {
        self.engine += other.engine;
        self.verifier += other.verifier;
        self.search += other.search;
        self.silent = [0, 1].map(|k: usize| self.silent[k].max(other.silent[k]));
    }
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
    lavish: usize,
    slow: usize,
    not_judged: usize,
    /// What it took; it decides nothing.
    times: Times,
    pub(crate) faults: Vec<String>,
    /// Refusals that were not judged, and where the time of long motions goes.
    pub(crate) remarks: Vec<String>,
    /// What was said of motions that were rightly refused, and how often.
    refusals: BTreeMap<String, usize>,
}

impl Tally {
    /// Counts a verdict, and what it took.
    pub(crate) fn note(&mut self, index: u64, case: &Case, (verdict, times): (Verdict, Times)) {
        self.times.add(&times);
        if times.all() > LONG {
            let [engine, verifier, search] =
                [times.engine, times.verifier, times.search].map(|time| time.as_secs_f64());
            self.remarks.push(format!(
                "#{index} {}: engine {engine:.1} s, verifier {verifier:.1} s, search {search:.1} s",
                case.shape
            ));
        }
        let longest = times.silent[0].max(times.silent[1]);
        if number("APT_SILENT").is_some_and(|most| longest > Duration::from_micros(most)) {
            let [engine, verifier] = times.silent.map(|time| 1e3 * time.as_secs_f64());
            self.remarks.push(format!(
                "#{index} {}: not asked for {engine:.2} ms by the engine, {verifier:.2} by the verifier",
                case.shape
            ));
        }
        let fault = |words: &str| format!("#{index} {}: {words}", case.shape);
        match verdict {
            Verdict::Proven(vectors) => {
                self.proven += 1;
                self.vectors += vectors;
            }
            Verdict::Refused(words) => {
                self.refused += 1;
                let name = words.split([' ', '{', '(']).next().unwrap_or_default();
                *self.refusals.entry(name.to_owned()).or_default() += 1;
            }
            Verdict::WronglyRefused(words) => {
                self.wrongly_refused += 1;
                self.faults.push(fault(&format!("wrongly refused: {words}")));
            }
            Verdict::Wrong(words) => {
                self.wrong += 1;
                self.faults.push(fault(&format!("wrong: {words}")));
            }
            Verdict::Lavish(words) => {
                self.lavish += 1;
                self.faults.push(fault(&format!("lavish: {words}")));
            }
            Verdict::Slow(words) => {
                self.slow += 1;
                self.faults.push(fault(&format!("too slow: {words}")));
            }
            Verdict::NotJudged(words) => {
                self.not_judged += 1;
                self.remarks.push(fault(&format!("not judged: {words}")));
            }
        }
    }

    /// Counts a motion that the laws were tried on.
    pub(crate) fn note_laws(&mut self, index: u64, case: &Case, laws: Laws) {
        match laws {
            Laws::NoMotion => self.refused += 1,
            Laws::Slow(words) => {
                self.slow += 1;
                self.faults.push(format!("#{index} {}: too slow: {words}", case.shape));
            }
            Laws::Tried(broken) => {
                self.proven += usize::from(broken.is_empty());
                self.wrong += usize::from(!broken.is_empty());
                self.faults.extend(broken.iter().map(|words| format!("#{index} {}: {words}", case.shape)));
            }
        }
    }

    /// Faults, then what else is to be told.
    pub(crate) fn lines(&self) -> impl Iterator<Item = &String> {
        self.faults.iter().chain(&self.remarks)
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.undrawn += other.undrawn;
        self.left_out += other.left_out;
        self.proven += other.proven;
        self.vectors += other.vectors;
        self.refused += other.refused;
        self.wrongly_refused += other.wrongly_refused;
        self.wrong += other.wrong;
        self.lavish += other.lavish;
        self.slow += other.slow;
        self.not_judged += other.not_judged;
        self.times.add(&other.times);
        for (words, count) in &other.refusals {
            *self.refusals.entry(words.clone()).or_default() += count;
        }
    }

    /// Names of the columns of [`Tally::row`].
    pub(crate) const COLUMNS: &'static str = "run, proven, vectors, rightly refused, wrongly refused, wrong, lavish, slow, not judged, not drawn, left out, ms each";

    pub(crate) fn row(&self) -> String {
        let refused = self.refused + self.wrongly_refused + self.not_judged;
        let run = self.proven + refused + self.wrong + self.lavish + self.slow;
        let each = self.times.all().as_secs_f64() * 1e3 / run.max(1) as f64;
        let counts = [
            run,
            self.proven,
            self.vectors,
            self.refused,
            self.wrongly_refused,
            self.wrong,
            self.lavish,
            self.slow,
            self.not_judged,
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

/// Cut vectors that a motion may have for each that it needs at least, and besides (arelem reference 5.6).
const SHARE: f64 = 1.02;
const MORE: f64 = 2.0;

/// Why a sequence has more cut vectors than are needed, if it has, or fewer than are told to be.
fn lavish(sequence: &CutSequence) -> Option<String> {
    let least = f64::from(sequence.minimum?);
    let count = sequence.points.len() as f64;
    (count > SHARE * least + MORE || count < least).then(|| format!("{count} vectors, {least} at least"))
}

/// Executes commands one after the other within the budget.
pub(crate) struct Runner {
    pub(crate) state: State,
    pub(crate) sequences: Vec<CutSequence>,
    left: Cell<u32>,
    /// When it was asked last whether to go on, and the longest time between two such questions.
    asked: Cell<Instant>,
    pub(crate) silent: Cell<Duration>,
}

impl Runner {
    pub(crate) fn new(case: &Case) -> Self {
        Self {
            state: State::new(1.0),
            sequences: Vec::new(),
            left: Cell::new(case.budget.asks),
            asked: Cell::new(Instant::now()),
            silent: Cell::default(),
        }
    }

    fn spend(&self) -> bool {
        let now = Instant::now();
        self.silent.set(self.silent.get().max(now - self.asked.replace(now)));
        self.left.set(self.left.get().saturating_sub(1));
        self.left.get() == 0
    }

    pub(crate) fn run(&mut self, commands: &[MotionCommand]) -> Result<(), MotionFailure> {
        for command in commands {
            self.asked.set(Instant::now());
            let execution = execute(&self.state, command, &|| self.spend());
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

    /// Why a sequence is not proven, if it is not.
    pub(crate) fn fault(&self, sequence: &CutSequence) -> Option<Fault> {
        self.asked.set(Instant::now());
        let words = match verify(sequence, &|| self.spend()) {
            Ok(evidence) if evidence.verified => return None,
            Err(VerifyError::Cancelled) => return Some(Fault::Slow(sequence.points.len())),
            Ok(evidence) => {
                let dense: Vec<_> =
                    evidence.violations.iter().filter_map(|v| dense::told(sequence, v)).collect();
                format!("{:?} {}", evidence.violations, dense.join("; "))
            }
            Err(error) => format!("{error:?}"),
        };
        Some(Fault::Wrong(format!("{} vectors: {words} {}", sequence.points.len(), positions(sequence))))
    }
}

/// The first positions of a sequence, in short.
fn positions(sequence: &CutSequence) -> String {
    let all = std::iter::once(&sequence.start).chain(&sequence.points).take(SHOWN);
    let triple = |v: &Vec3| format!("({:.5} {:.5} {:.5})", v.x, v.y, v.z);
    all.map(|p| format!("{}{}", triple(&p.tip), triple(&p.axis))).collect::<Vec<_>>().join(" ")
}

/// Why a sequence is not proven.
#[derive(Debug, Clone)]
pub(crate) enum Fault {
    /// The verifier does not accept it.
    Wrong(String),
    /// The verifier did not end within the budget; with the number of vectors.
    Slow(usize),
}

/// Processor time of this thread, where the system tells it; else the time that passes.
fn spent() -> Duration {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|words| words.split(' ').next()?.parse().ok())
        .map_or_else(|| BEGIN.get_or_init(Instant::now).elapsed(), Duration::from_nanos)
}

fn timed<T>(time: &mut Duration, work: impl FnOnce() -> T) -> T {
    let before = spent();
    let result = work();
    *time += spent().saturating_sub(before);
    result
}

pub(crate) fn judge(case: &Case) -> (Verdict, Times) {
    let mut times = Times::default();
    let mut runner = Runner::new(case);
    let outcome = timed(&mut times.engine, || runner.run(&case.commands()));
    times.silent[0] = runner.silent.take();
    let fault = timed(&mut times.verifier, || runner.sequences.iter().find_map(|s| runner.fault(s)));
    times.silent[1] = runner.silent.take();
    let verdict = match (fault, outcome) {
        (_, Err(MotionFailure::Cancelled)) => {
            Verdict::Slow(format!("engine after {} sequences", runner.sequences.len()))
        }
        (Some(Fault::Slow(vectors)), _) => Verdict::Slow(format!("verifier, {vectors} vectors")),
        (Some(Fault::Wrong(words)), _) => Verdict::Wrong(words),
        (None, Ok(())) => match runner.sequences.iter().find_map(lavish) {
            Some(words) => Verdict::Lavish(words),
            None => Verdict::Proven(runner.sequences.iter().map(|s| s.points.len()).sum()),
        },
        (None, Err(failure)) => timed(&mut times.search, || refused(case, &runner, &failure)),
    };
    (verdict, times)
}

/// A verdict with what it took, all counted as the engine's.
pub(crate) fn timed_verdict(work: impl FnOnce() -> Verdict) -> (Verdict, Times) {
    let mut times = Times::default();
    let verdict = timed(&mut times.engine, work);
    (verdict, times)
}

/// Whether a refusal is right.
fn refused(case: &Case, runner: &Runner, failure: &MotionFailure) -> Verdict {
    let start = if runner.sequences.is_empty() { None } else { runner.state.tip };
    told(&Reader::new(case), start, failure)
}

/// What a search from a start, or for one, says of a failure.
pub(crate) fn told(reader: &Reader<'_>, start: Option<Vec3>, failure: &MotionFailure) -> Verdict {
    let words = format!("{failure:?}");
    match reader.search(start, ToldEnd::of(failure)) {
        _ if reader.is_spent() => Verdict::NotJudged(words),
        Found::Path(length) => Verdict::WronglyRefused(format!("a path of {length:.3}: {words}")),
        // The start-up alone was refused, and there is a start.
        found @ (Found::Ends(_) | Found::NotMet) if start.is_none() => {
            Verdict::WronglyRefused(format!("a start, then {found:?}: {words}"))
        }
        _ => Verdict::Refused(words),
    }
}
