//! The clock of the thread, read at each question.

use std::{
    backtrace::Backtrace,
    sync::{LazyLock, Mutex},
    time::Duration,
};

use apt_ide::Cancel;
use rustix::time::{ClockId, clock_gettime};

/// How many times later than the time before a work is given up.
const LATER: u64 = 4;

/// Places that are told of one work; the first ones tell enough.
const MOST_TOLD: usize = 3;

/// What was heard of a work.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Heard {
    /// The longest time between two questions.
    pub(crate) longest: Duration,
    /// The longest time from the answer that it is given up to its end.
    pub(crate) given_up: Duration,
    /// How often it asked when nobody gave it up.
    pub(crate) questions: u64,
    /// What all of it took then, less what it still knew of the times before.
    pub(crate) all: Duration,
}

impl Heard {
    /// Of two works the longest, and the sums.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            longest: self.longest.max(other.longest),
            given_up: self.given_up.max(other.given_up),
            questions: self.questions + other.questions,
            all: self.all + other.all,
        }
    }
}

/// From when on a silence is told.
static LONG: LazyLock<Option<Duration>> = LazyLock::new(|| {
    let most = std::env::var("APT_SILENT").ok()?;
    Some(Duration::from_micros(most.parse().ok()?))
});

/// Processor time of this thread.
fn now() -> Duration {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), u32::try_from(time.tv_nsec).unwrap_or_default())
}

struct Watch {
    heard: Heard,
    last: Duration,
    told: usize,
    is_given_up: bool,
}

impl Watch {
    fn hear(&mut self, by: &str) {
        let silence = now().saturating_sub(self.last);
        let longest = if self.is_given_up { &mut self.heard.given_up } else { &mut self.heard.longest };
        *longest = silence.max(*longest);
        self.heard.all += silence;
        if LONG.is_some_and(|most| silence > most) && self.told < MOST_TOLD {
            self.told += 1;
            println!("{by} after {:.2} ms\n{}", 1e3 * silence.as_secs_f64(), Backtrace::force_capture());
        }
        self.last = now();
    }
}

/// Listens to a work that is given up at its first question, then at one some times later, and so on, until it comes to its end
/// before. What it keeps it finds the next time, so that the longest silence is that of all times.
pub(crate) fn listen<T>(mut work: impl FnMut(Cancel<'_>) -> T) -> Heard {
    let (mut heard, mut last) = (Heard::default(), 1);
    loop {
        let Heard { questions, all, .. } = heard;
        heard = heard.and(once(&mut work, last));
        (heard.questions, heard.all) = (heard.questions - questions, heard.all - all);
        if heard.questions < last {
            return heard;
        }
        last *= LATER;
    }
}

/// Listens to a work that is given up at a question.
fn once<T>(work: &mut impl FnMut(Cancel<'_>) -> T, last: u64) -> Heard {
    let watch = Watch { heard: Heard::default(), last: now(), told: 0, is_given_up: false };
    let watch = Mutex::new(watch);
    let ask = || {
        let mut watch = watch.lock().unwrap();
        if !watch.is_given_up {
            watch.heard.questions += 1;
            watch.hear("asked");
            watch.is_given_up = watch.heard.questions >= last;
        }
        watch.is_given_up
    };
    let done = work(&ask);
    let mut watch = watch.into_inner().unwrap();
    watch.hear(if watch.is_given_up { "given up" } else { "ended" });
    drop(done);
    watch.heard
}
