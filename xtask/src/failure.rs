//! What can go wrong in a task, with the evidence.

use std::path::PathBuf;

/// Why a task stopped.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// A program could not be started.
    #[error("cannot start `{program}`: {source}")]
    Start {
        /// The program's name as it was called.
        program: String,
        /// The operating system's reason.
        source: std::io::Error,
    },
    /// A program ended with a status other than zero.
    #[error("`{call}` ended with {status}")]
    Status {
        /// Program and arguments.
        call: String,
        /// Exit code or signal.
        status: std::process::ExitStatus,
    },
    /// A file could not be read, written, copied or removed.
    #[error("{action} {path}: {source}", path = path.display())]
    File {
        /// What was tried: "read", "write" ...
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        source: std::io::Error,
    },
    /// The vocabulary file does not have the expected shape.
    #[error("vocabulary: {0}")]
    Vocabulary(String),
    /// Generated files differ from what the vocabulary gives.
    #[error("stale generated files (run `cargo xtask codegen`): {}", .0.join(", "))]
    Stale(Vec<String>),
    /// Something that the task needs is not on this machine.
    #[error("{what} is missing; {remedy}")]
    Missing {
        /// What was looked for.
        what: String,
        /// How to get it.
        remedy: String,
    },
    /// Some steps of a task failed; they were reported when they ran.
    #[error("{} of the steps failed: {}", .0.len(), .0.join(", "))]
    Steps(Vec<String>),
}

/// The result of a task.
pub(crate) type Outcome<T = ()> = Result<T, Failure>;

/// Turns an input/output error into a [`Failure`] that names the file.
pub(crate) trait FileContext<T> {
    /// Adds what was tried on which file.
    fn on(self, action: &'static str, path: impl Into<PathBuf>) -> Outcome<T>;
}

impl<T> FileContext<T> for std::io::Result<T> {
    fn on(self, action: &'static str, path: impl Into<PathBuf>) -> Outcome<T> {
        self.map_err(|source| Failure::File { action, path: path.into(), source })
    }
}
