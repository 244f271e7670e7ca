//! `tree`: the syntax tree.

use super::Outcome;
use super::arguments::ProgramArgument;
use super::console::Console;
use super::program::Program;
use crate::analysis::Language;

/// Prints the syntax tree of a program.
pub(super) fn tree(call: &ProgramArgument, console: &Console, language: &dyn Language) -> Outcome {
    let Some(program) = Program::read(call, console, language) else { return Outcome::Unusable };
    let tree = program.document.syntax_tree();
    console.print(&format!("{}\n", tree.trim_end_matches('\n')))
}
