//! The command line: one file per call, one place for findings in every format.

mod arguments;
mod check;
mod console;
mod convert;
mod diff;
mod expand;
mod explain;
mod file;
mod findings;
mod fmt;
mod listing;
mod post;
mod program;
mod run;
mod tree;
mod view;

use std::process::ExitCode;
use std::sync::Arc;

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, CommandFactory, FromArgMatches};

use self::arguments::{Arguments, CheckOptions, Command};
use self::console::Console;
use crate::analysis::Language;

/// How a call ended, as its exit code says it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Outcome {
    /// Nothing was found.
    Clean = 0,
    /// Something was found.
    Findings = 1,
    /// Arguments or input cannot be used, or something of ours is broken.
    Unusable = 2,
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> Self {
        Self::from(outcome as u8)
    }
}

/// Does what the arguments of the process say.
pub(crate) fn main(language: Arc<dyn Language>) -> ExitCode {
    let arguments = typed();
    if arguments.command.is_none() && !arguments.check {
        return crate::server::run(language);
    }
    let console = Console::new(arguments.color);
    // A fault of ours is no finding: it has an exit code of its own, and no half a report before it.
    let work = std::panic::AssertUnwindSafe(|| dispatch(arguments, &console, language.as_ref()));
    match std::panic::catch_unwind(work) {
        Ok(outcome) => outcome.into(),
        Err(_) => {
            console.error("internal fault; the lines above say where");
            Outcome::Unusable.into()
        }
    }
}

/// What was typed; what cannot be understood, and options that would do nothing, end the process with a message.
fn typed() -> Arguments {
    let matches = Arguments::command().get_matches();
    let arguments = Arguments::from_arg_matches(&matches)
        .unwrap_or_else(|error| error.format(&mut Arguments::command()).exit());
    if !arguments.check
        && let Some(message) = misplaced(&matches)
    {
        Arguments::command().error(ErrorKind::ArgumentConflict, message).exit();
    }
    arguments
}

/// Why an option of `--check` that was typed without it would do nothing.
fn misplaced(matches: &ArgMatches) -> Option<String> {
    let definition = Arguments::command();
    let typed = CheckOptions::augment_args(clap::Command::new("check"))
        .get_arguments()
        .find(|option| matches.value_source(option.get_id().as_str()) == Some(ValueSource::CommandLine))
        .cloned()?;
    let option = typed.get_long().unwrap_or_default();
    let Some(command) = matches.subcommand_name() else {
        return Some(format!(
            "`--{option}` goes with `--check` or a command; the server takes its settings from the editor"
        ));
    };
    let takes = |one: &clap::Arg| one.get_long() == Some(option);
    if !definition.find_subcommand(command).is_some_and(|call| call.get_arguments().any(takes)) {
        return Some(format!("`--{option}` does not go with `{command}`"));
    }
    let value = if typed.get_action().takes_values() { " …" } else { "" };
    Some(format!("`--{option}` stands behind the command: `apt-lsp {command} --{option}{value}`"))
}

fn dispatch(arguments: Arguments, console: &Console, language: &dyn Language) -> Outcome {
    if arguments.command.is_some() && (arguments.stdio || arguments.check) {
        let message = "`--stdio` and `--check` stand alone, without a command";
        Arguments::command().error(ErrorKind::ArgumentConflict, message).exit();
    }
    match arguments.command {
        None => check::check(&arguments.paths, &arguments.check_options, console, language),
        Some(Command::Check(call)) => check::check(&call.paths, &call.options, console, language),
        Some(Command::Run(call)) => run::run(&call, console, language),
        Some(Command::Post(call)) => post::post(&call, console, language),
        Some(Command::Expand(call)) => expand::expand(&call, console, language),
        Some(Command::Fmt(call)) => fmt::fmt(&call, console, language),
        Some(Command::View(call)) => view::view(&call, console, language),
        Some(Command::Diff(call)) => diff::diff(&call, console, language),
        Some(Command::Convert(call)) => convert::convert(&call, console, language),
        Some(Command::Explain(call)) => explain::explain(&call.code, console, language),
        Some(Command::Tree(call)) => tree::tree(&call, console, language),
        Some(Command::Machines(call)) => post::machines(&call, console, language),
    }
}
