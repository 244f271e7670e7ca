//! The whole test run. Every step runs, also after a failed one, so that one run tells everything.

use std::time::Instant;

use crate::failure::{Failure, Outcome};
use crate::process::{Call, TestCount};
use crate::{codegen, layout, nvim, setup, vscode};

/// What one step did.
struct Report {
    name: &'static str,
    seconds: f64,
    count: TestCount,
    failure: Option<Failure>,
}

/// Collects the steps.
#[derive(Default)]
pub(crate) struct Run {
    reports: Vec<Report>,
}

impl Run {
    /// Does one step and keeps what came of it.
    pub(crate) fn step(&mut self, name: &'static str, action: impl FnOnce(&mut TestCount) -> Outcome) {
        println!("\n== {name}");
        let start = Instant::now();
        let mut count = TestCount::default();
        let failure = action(&mut count).err();
        if let Some(failure) = &failure {
            println!("FAILED {name}: {failure}");
        }
        self.reports.push(Report { name, seconds: start.elapsed().as_secs_f64(), count, failure });
    }

    /// Prints the table of the steps; fails when one of them did.
    pub(crate) fn finish(self) -> Outcome {
        println!("\n{:<28} {:>8} {:>8} {:>8}  result", "step", "seconds", "passed", "failed");
        let mut total = TestCount::default();
        for report in &self.reports {
            total += report.count;
            let verdict = if report.failure.is_none() { "ok" } else { "FAILED" };
            println!(
                "{:<28} {:>8.1} {:>8} {:>8}  {verdict}",
                report.name, report.seconds, report.count.passed, report.count.failed
            );
        }
        println!("in all: {} tests passed, {} failed", total.passed, total.failed);
        let failed: Vec<String> =
            self.reports.iter().filter(|r| r.failure.is_some()).map(|r| r.name.to_owned()).collect();
        if failed.is_empty() { Ok(()) } else { Err(Failure::Steps(failed)) }
    }
}

/// A call of cargo in the workspace.
pub(crate) fn cargo(arguments: &[&str]) -> Call {
    Call::new("cargo").args(arguments).folder(layout::root())
}

/// Runs every check of the project; `editors` tells whether the editors are among them.
pub(crate) fn run(editors: bool) -> Outcome {
    let mut run = Run::default();
    run.step("needed programs", |_| setup::run(setup::Purpose::Test, true));
    run.step("format", |_| cargo(&["fmt", "--all", "--check"]).run());
    run.step("generated files", |_| codegen::run(true));
    run.step("lints", |_| {
        cargo(&["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"]).run()
    });
    run.step("tests", |count| {
        cargo(&["test", "--workspace", "--locked", "--no-fail-fast"]).run_counting(count)
    });
    run.step("documentation", |_| {
        cargo(&["doc", "--workspace", "--no-deps", "--locked"]).env("RUSTDOCFLAGS", "-D warnings").run()
    });
    if editors {
        // The tests above have built it; asked for again so that a failed test run does not leave an old one.
        run.step("server binary", |_| cargo(&["build", "--package", "apt-lsp", "--locked"]).run());
        let server = layout::server("debug");
        run.step("Neovim", |count| nvim::run(&["nvim".into()], &server, count));
        run.step("VS Code", |count| vscode::tests::run(&server, count));
    }
    run.finish()
}
