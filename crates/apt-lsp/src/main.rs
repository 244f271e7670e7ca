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

/// Gives memory back a little at a time: whoever cancels waits for a call of the allocator as well.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    cli::main(Arc::new(analysis::Engine))
}
