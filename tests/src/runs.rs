//! Runs of whole programs as users have them: through the analysis, with a limit on work that is no clock.

use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
};

use apt_ide::{Analysis, Settings};
use serde_json::Value;

use crate::{oracle, repository};

/// How often a run of a small program may ask whether to stop before it is taken for endless. The question is put at
/// least once per statement, record and cut vector.
pub const MOST_QUESTIONS: u64 = 20_000_000;

/// The work asked this often whether to stop and was still not done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Endless {
    /// How often.
    pub questions: u64,
}

/// Settings that differ from the standard ones in the dialect only.
pub fn settings(dialect: &str) -> Arc<Settings> {
    Arc::new(Settings { dialect: Some(dialect.to_owned()), ..Settings::default() })
}

/// A program in a dialect, standard settings else.
pub fn analysis(text: &str, dialect: &str) -> Analysis {
    Analysis::new(text, Some("test.apt".to_owned()), &settings(dialect))
}

/// The report of `run --format json` without the times of motions, which no two runs share.
///
/// # Errors
///
/// [`Endless`] when the run asked too often whether to stop.
pub fn report(analysis: &Analysis) -> Result<Value, Endless> {
    bounded(|cancel| analysis.run(None, cancel, &mut |_, _| {})).map(|report| {
        let mut value = serde_json::to_value(report).expect("a report is JSON");
        without_times(&mut value);
        value
    })
}

/// Does work that can be cancelled and cancels it when it has asked too often.
///
/// # Errors
///
/// [`Endless`] when it has.
pub fn bounded<T>(
    work: impl FnOnce(apt_ide::Cancel<'_>) -> Result<T, apt_ide::Cancelled>,
) -> Result<T, Endless> {
    let questions = AtomicU64::new(0);
    let cancel = || questions.fetch_add(1, Ordering::Relaxed) >= MOST_QUESTIONS;
    work(&cancel).map_err(|_| Endless { questions: questions.load(Ordering::Relaxed) })
}

fn without_times(report: &mut Value) {
    for motion in report["motions"].as_array_mut().into_iter().flatten() {
        if let Some(motion) = motion.as_object_mut() {
            motion.remove("seconds");
        }
    }
}

/// The text of a file.
pub fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A path for messages: group and name.
pub fn title(path: &Path) -> String {
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    format!("{}/{}", part(path.parent().and_then(Path::file_name)), part(path.file_stem()))
}

/// All programs that [`oracle::run_corpus`] compares: (dialect, path), in a fixed order.
pub fn oracle_programs() -> Vec<(&'static str, PathBuf)> {
    let of_group = |group: &&'static str| {
        oracle::programs(group).into_iter().map(|path| (oracle::dialect_of(group).as_str(), path)).collect()
    };
    oracle::GROUPS.iter().flat_map(of_group as fn(&&'static str) -> Vec<_>).collect()
}

/// The programs in `examples/`, in alphabetic order.
pub fn examples() -> Vec<PathBuf> {
    let folder = repository("examples");
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "apt"));
    paths.sort();
    paths
}

/// One tool position of a report.
#[derive(Debug, Clone, PartialEq)]
pub struct Location {
    /// The statement.
    pub isn: u64,
    /// The move to it is rapid.
    pub rapid: bool,
    /// The tool end.
    pub at: [f64; 3],
    /// The direction of the tool, upright where none is told.
    pub axis: [f64; 3],
    /// It comes from FROM: the tool is there, nothing moves.
    pub from: bool,
}

/// The tool positions of a report in order; RAPID concerns the next statement that moves.
pub fn path_of(report: &Value) -> Vec<Location> {
    let mut rapid = false;
    let mut path = Vec::new();
    for entry in report["cl"].as_array().into_iter().flatten() {
        match (entry["type"].as_str(), entry["words"][0].as_str()) {
            (Some("postprocessor"), Some("RAPID")) => rapid = true,
            (Some(kind @ ("from" | "go")), _) => {
                let from = kind == "from";
                let isn = entry["isn"].as_u64().unwrap_or(0);
                for point in entry["points"].as_array().into_iter().flatten() {
                    let number = |index: usize| point[index].as_f64().expect("a coordinate is a number");
                    let axis = [3, 4, 5].map(|index| point[index].as_f64());
                    let axis =
                        if let [Some(i), Some(j), Some(k)] = axis { [i, j, k] } else { [0.0, 0.0, 1.0] };
                    path.push(Location { isn, rapid, at: [number(0), number(1), number(2)], axis, from });
                }
                rapid &= from;
            }
            _ => {}
        }
    }
    path
}
