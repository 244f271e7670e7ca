//! `cargo xtask`: everything of the project that is not plain cargo.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a command-line tool talks to its user")]

mod codegen;
mod failure;
mod layout;
mod nightly;
mod nvim;
mod process;
mod setup;
mod vscode;
mod whole;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

use crate::failure::Outcome;
use crate::process::TestCount;

/// Tasks of the apt-lsp project.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Make everything that is made from the vocabulary: Rust table, TextMate grammar, Vim syntax, page of the language.
    Codegen {
        /// Write nothing; fail when a generated file is stale.
        #[arg(long)]
        check: bool,
    },
    /// Install the Debian packages that the tests need and this machine lacks.
    Setup {
        /// Only say what is missing; fail when something is.
        #[arg(long)]
        check: bool,
        /// Only what is needed to build apt-lsp.
        #[arg(long)]
        build: bool,
    },
    /// Build the VS Code extension with the release binary in it.
    PackageVscode {
        /// Where the .vsix goes.
        #[arg(long, default_value = "editors/vscode/apt-lsp.vsix")]
        output: PathBuf,
    },
    /// Run everything: format, lints, tests, documentation, generated files, both editors.
    Test {
        /// Leave the editors out.
        #[arg(long)]
        no_editors: bool,
    },
    /// Run the random tests with many more cases than `test` has time for, in the release profile.
    Nightly {
        /// Cases per form of a definition.
        #[arg(long, default_value_t = nightly::DEFINITION_CASES)]
        definition_cases: u32,
        /// Random motions of each pair of surfaces.
        #[arg(long, default_value_t = nightly::MOTION_CASES)]
        motion_cases: u32,
        /// One motion in so many is run of pairs with tabulated, ruled or polyconic surfaces.
        #[arg(long, default_value_t = nightly::SHARE)]
        share: u32,
        /// A part of the pairs of surfaces, as 2/5 for the second of five parts.
        #[arg(long)]
        pairs: Option<String>,
        /// Seed of the random numbers, to repeat a run; another one every time if not given.
        #[arg(long)]
        seed: Option<u64>,
    },
    /// Test the extension in the real VS Code: inside its extension host and clicked through in the browser.
    TestVscode(EditorArguments),
    /// Install the VS Code of the tests into the cache folder (`test-vscode` does it by itself).
    VscodeHost,
    /// Test the plugin in the real Neovim, without a screen.
    TestNvim {
        #[command(flatten)]
        editor: EditorArguments,
        /// The Neovim programs to test in (repeatable).
        #[arg(long = "nvim", default_value = "nvim")]
        programs: Vec<PathBuf>,
    },
}

/// What both editor tests take.
#[derive(Debug, Args)]
struct EditorArguments {
    /// The server binary to test with; without it the debug binary is built and used.
    #[arg(long)]
    server: Option<PathBuf>,
}

impl EditorArguments {
    fn server(self) -> Outcome<PathBuf> {
        match self.server {
            Some(server) => std::path::absolute(&server).map_err(|source| failure::Failure::File {
                action: "find",
                path: server,
                source,
            }),
            None => {
                process::Call::new("cargo")
                    .args(["build", "--package", "apt-lsp"])
                    .folder(layout::root())
                    .run()?;
                Ok(layout::server("debug"))
            }
        }
    }
}

fn perform(task: Task) -> Outcome {
    let mut count = TestCount::default();
    match task {
        Task::Codegen { check } => codegen::run(check),
        Task::Setup { check, build } => {
            setup::run(if build { setup::Purpose::Build } else { setup::Purpose::Test }, check)
        }
        Task::PackageVscode { output } => vscode::package::run(&layout::root().join(output)),
        Task::Nightly { definition_cases, motion_cases, share, pairs, seed } => {
            nightly::run(&nightly::Extent { definition_cases, motion_cases, share, pairs, seed })
        }
        Task::Test { no_editors } => whole::run(!no_editors),
        Task::TestVscode(editor) => vscode::tests::run(&editor.server()?, &mut count),
        Task::VscodeHost => vscode::host::install().map(|host| println!("{}", host.entry.display())),
        Task::TestNvim { editor, programs } => nvim::run(&programs, &editor.server()?, &mut count),
    }
}

fn main() -> ExitCode {
    match perform(Arguments::parse().task) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        super::Arguments::command().debug_assert();
    }
}
