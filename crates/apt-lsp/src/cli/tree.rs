//! `tree`: the syntax tree.

use super::Outcome;
use super::arguments::ProgramArgument;
use super::console::Console;
use super::program::Program;
use crate::analysis::{Control, Language};

/// Prints the syntax tree of a program.
pub(super) fn tree(call: &ProgramArgument, console: &Console, language: &dyn Language) -> Outcome {
    let Some(program) = Program::read(call, console, language) else { return Outcome::Unusable };
    // Nobody ends it, so that there is one.
    let Ok(tree) = program.document.syntax_tree(&Control::unlimited()) else { return Outcome::Unusable };
    console.print(&format!("{}\n", tree.trim_end_matches('\n')))
}
