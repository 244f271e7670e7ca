//! `apt-lsp`: the language server and command line of APT.
//!
//! This crate knows protocols and terminals, and nothing of APT: it converts what comes in, asks the
//! analysis, and converts what comes back.

mod analysis;
mod cli;
mod convert;
mod server;
mod settings;
mod source;

use std::process::ExitCode;
use std::sync::Arc;

fn main() -> ExitCode {
    cli::main(Arc::new(analysis::Engine))
}
