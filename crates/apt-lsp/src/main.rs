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

/// Gives memory back to the system on a thread of its own: whoever cancels waits for a call of the allocator as well.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

fn main() -> ExitCode {
    cli::main(Arc::new(analysis::Engine))
}
