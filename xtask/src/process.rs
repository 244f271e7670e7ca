//! Running other programs: every call is shown, its failure is a [`Failure`], its test counts can be collected.

use std::ffi::{OsStr, OsString};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::failure::{Failure, Outcome};

/// Tests that ran, counted from what the test programs print.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct TestCount {
    /// Tests that passed.
    pub(crate) passed: u64,
    /// Tests that failed.
    pub(crate) failed: u64,
}

impl std::ops::AddAssign for TestCount {
    fn add_assign(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
    }
}

impl TestCount {
    /// The counts in one line of output, in the form of cargo ("12 passed; 0 failed") or of the editor
    /// tests ("12 passed, 0 failed").
    pub(crate) fn of_line(line: &str) -> Option<Self> {
        let number_before = |word: &str| {
            let head = line.split_once(word)?.0.trim_end();
            head.rsplit(|c: char| !c.is_ascii_digit()).next()?.parse::<u64>().ok()
        };
        Some(Self { passed: number_before(" passed")?, failed: number_before(" failed")? })
    }
}

/// One call of another program.
#[derive(Debug)]
pub(crate) struct Call {
    program: OsString,
    arguments: Vec<OsString>,
    folder: Option<PathBuf>,
    environment: Vec<(OsString, OsString)>,
}

impl Call {
    /// A call of `program` with no arguments yet.
    pub(crate) fn new(program: impl AsRef<OsStr>) -> Self {
        Self {
            program: program.as_ref().to_owned(),
            arguments: Vec::new(),
            folder: None,
            environment: Vec::new(),
        }
    }

    /// Adds arguments.
    pub(crate) fn args<I: IntoIterator<Item = S>, S: AsRef<OsStr>>(mut self, arguments: I) -> Self {
        self.arguments.extend(arguments.into_iter().map(|a| a.as_ref().to_owned()));
        self
    }

    /// Sets the working folder.
    pub(crate) fn folder(mut self, folder: impl AsRef<Path>) -> Self {
        self.folder = Some(folder.as_ref().to_owned());
        self
    }

    /// Sets an environment variable.
    pub(crate) fn env(mut self, name: impl AsRef<OsStr>, value: impl AsRef<OsStr>) -> Self {
        self.environment.push((name.as_ref().to_owned(), value.as_ref().to_owned()));
        self
    }

    /// Program and arguments as a person would type them.
    fn shown(&self) -> String {
        let mut shown =
            Path::new(&self.program).file_name().unwrap_or(&self.program).to_string_lossy().into_owned();
        for argument in &self.arguments {
            shown.push(' ');
            shown.push_str(&argument.to_string_lossy());
        }
        shown
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.args(&self.arguments).stdin(Stdio::null());
        if let Some(folder) = &self.folder {
            command.current_dir(folder);
        }
        for (name, value) in &self.environment {
            command.env(name, value);
        }
        command
    }

    fn start_failure(&self, source: std::io::Error) -> Failure {
        Failure::Start { program: self.program.to_string_lossy().into_owned(), source }
    }

    fn judge(&self, status: std::process::ExitStatus) -> Outcome {
        if status.success() { Ok(()) } else { Err(Failure::Status { call: self.shown(), status }) }
    }

    /// Runs the call with its output going straight through.
    pub(crate) fn run(&self) -> Outcome {
        println!("$ {}", self.shown());
        let status = self.command().status().map_err(|e| self.start_failure(e))?;
        self.judge(status)
    }

    /// Runs the call and returns its standard output; standard error goes straight through.
    pub(crate) fn output(&self) -> Outcome<String> {
        let output = self.command().stderr(Stdio::inherit()).output().map_err(|e| self.start_failure(e))?;
        self.judge(output.status)?;
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }

    /// Runs the call, passes its standard output on and adds the tests it counts to `count`, whether the call
    /// succeeds or not.
    pub(crate) fn run_counting(&self, count: &mut TestCount) -> Outcome {
        println!("$ {}", self.shown());
        self.count_into(count, &mut std::io::stdout())
    }

    fn count_into(&self, count: &mut TestCount, shown: &mut impl Write) -> Outcome {
        let mut child = self.command().stdout(Stdio::piped()).spawn().map_err(|e| self.start_failure(e))?;
        if let Some(stdout) = child.stdout.take() {
            for line in BufReader::new(stdout).split(b'\n') {
                let Ok(line) = line else { break };
                let line = String::from_utf8_lossy(&line);
                // A closed standard output must not stop the tests; their verdict is the exit status.
                let _ = writeln!(shown, "{line}");
                if let Some(found) = TestCount::of_line(&line) {
                    *count += found;
                }
            }
        }
        let status = child.wait().map_err(|e| self.start_failure(e))?;
        self.judge(status)
    }
}

/// Where `program` is found on the search path.
pub(crate) fn find_program(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(program)).find(|file| file.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_read_from_both_forms() {
        let cargo = "test result: ok. 12 passed; 3 failed; 0 ignored; 0 measured; 0 filtered out";
        assert_eq!(TestCount::of_line(cargo), Some(TestCount { passed: 12, failed: 3 }));
        assert_eq!(TestCount::of_line("9 passed, 0 failed"), Some(TestCount { passed: 9, failed: 0 }));
        assert_eq!(
            TestCount::of_line("nvim 0.7.2: 7 passed, 2 failed"),
            Some(TestCount { passed: 7, failed: 2 })
        );
        assert_eq!(TestCount::of_line("the motion passed the check"), None);
        assert_eq!(TestCount::of_line("all passed, none failed"), None);
    }

    #[test]
    fn a_failing_program_is_a_failure_and_still_counted() {
        let mut count = TestCount::default();
        let call = Call::new("sh").args(["-c", "echo '2 passed, 1 failed'; exit 3"]);
        let mut shown = Vec::new();
        assert!(matches!(call.count_into(&mut count, &mut shown), Err(Failure::Status { .. })));
        assert_eq!(shown, b"2 passed, 1 failed\n");
        assert_eq!(count, TestCount { passed: 2, failed: 1 });
    }

    #[test]
    fn a_missing_program_cannot_be_started() {
        let result = Call::new("no-such-program-of-apt").run();
        assert!(matches!(result, Err(Failure::Start { .. })));
    }
}
