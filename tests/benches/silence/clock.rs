//! The clock of the thread, read at each question.

use std::{
    backtrace::Backtrace,
    sync::{LazyLock, Mutex},
    time::Duration,
};

use apt_ide::Cancel;
use rustix::time::{ClockId, clock_gettime};

/// Places that are told of one work; the first ones tell enough.
const MOST_TOLD: usize = 3;

/// What was heard of a work.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Heard {
    /// The longest time between two questions.
    pub(crate) longest: Duration,
    /// How often it asked.
    pub(crate) questions: u64,
    /// What all of it took.
    pub(crate) all: Duration,
}

impl Heard {
    /// Of two works the longest, and the sums.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            longest: self.longest.max(other.longest),
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
}

impl Watch {
    fn hear(&mut self, by: &str) {
        let silence = now().saturating_sub(self.last);
        self.heard.longest = self.heard.longest.max(silence);
        self.heard.all += silence;
        if LONG.is_some_and(|most| silence > most) && self.told < MOST_TOLD {
            self.told += 1;
            println!("{by} after {:.2} ms\n{}", 1e3 * silence.as_secs_f64(), Backtrace::force_capture());
        }
        self.last = now();
    }
}

/// Listens to a work that nobody cancels.
pub(crate) fn listen<T>(work: impl FnOnce(Cancel<'_>) -> T) -> (T, Heard) {
    let watch = Mutex::new(Watch { heard: Heard::default(), last: now(), told: 0 });
    let ask = || {
        let mut watch = watch.lock().unwrap();
        watch.heard.questions += 1;
        watch.hear("asked");
        false
    };
    let done = work(&ask);
    let mut watch = watch.into_inner().unwrap();
    watch.hear("ended");
    (done, watch.heard)
}
