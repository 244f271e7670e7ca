//! The language server.
//!
//! One thread owns the documents and applies events in the order in which they arrive; handlers ask it
//! for immutable snapshots through the same queue, so each sees every edit that was sent before it.
//! Work happens on threads of its own, with a token that ends it when nobody wants the answer any more.

mod backend;
mod capabilities;
mod commands;
mod diagnostics;
mod documents;
mod framing;
mod job;
mod lifetime;
mod outbox;
mod parcels;
mod progress;
mod status;
mod symbols;
#[cfg(test)]
mod tests;
mod workers;

use std::process::ExitCode;
use std::sync::Arc;

use tokio::io::AsyncRead;
use tokio::task::JoinHandle;
use tower_lsp::{LspService, Server};

use self::backend::Backend;
use self::parcels::{Parcels, method};
use crate::analysis::Language;

/// Requests answered at the same time. Order does not depend on it; a small number would only delay
/// cancellation, which waits for a free place.
const CONCURRENT_REQUESTS: usize = 256;

/// Bytes between the framing and the service before the reader waits.
const PIPE_SIZE: usize = 1 << 16;

/// Threads for the two standard streams, and for files of machines. Work on snapshots has threads of its own.
const BLOCKING_THREADS: usize = 4;

/// How the conversation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ending {
    /// `shutdown`, then `exit` or the end of input.
    Orderly,
    /// `exit` or the end of input without `shutdown`.
    Abrupt,
}

/// Runs the server on standard input and output, and ends the process.
pub(crate) fn run(language: Arc<dyn Language>) -> ExitCode {
    let mut builder = tokio::runtime::Builder::new_multi_thread();
    builder.enable_all().max_blocking_threads(BLOCKING_THREADS);
    let runtime = match builder.build() {
        Ok(runtime) => runtime,
        Err(error) => {
            lifetime::complain(&format!("cannot start: {error}"));
            return ExitCode::from(2);
        }
    };
    lifetime::report_panics();
    let conversation = serve(tokio::io::stdin(), framing::to_standard_output, language);
    let ending = runtime.block_on(async { tokio::spawn(conversation).await });
    // Not a return: the thread that reads standard input would keep the process.
    std::process::exit(match ending {
        Ok(Ending::Orderly) => 0,
        Ok(Ending::Abrupt) => 1,
        Err(_) => lifetime::EXIT_AFTER_PANIC,
    });
}

/// Holds one conversation, whose messages a writer takes out, until `exit` or the end of input.
pub(crate) async fn serve(
    input: impl AsyncRead + Unpin + Send + 'static,
    writer: impl FnOnce(framing::Waiting) -> JoinHandle<()> + Send + 'static,
    language: Arc<dyn Language>,
) -> Ending {
    let (outgoing, parcels) = (framing::Outgoing::new(), Parcels::default());
    let notices = outgoing.frames.downgrade();
    let (service, socket) =
        LspService::build(|client| Backend::new(client, language, parcels.clone(), notices))
            .custom_method("apt/runMotion", Backend::run_motion)
            .custom_method("apt/expand", Backend::expand)
            .custom_method("apt/canonicalForm", Backend::canonical_form)
            .custom_method("apt/post", Backend::post)
            .custom_method("apt/syntaxTree", Backend::syntax_tree)
            .custom_method("apt/machines", Backend::machines)
            .custom_method("apt/status", Backend::status)
            .custom_method(method::SYMBOLS, Backend::symbols)
            .custom_method(method::REFERENCES, Backend::all_references)
            .custom_method(method::FOLDS, Backend::folds)
            .custom_method(method::LENSES, Backend::lenses)
            .custom_method(method::FORMATTING, Backend::format)
            .custom_method(method::TOKENS, Backend::tokens)
            .custom_method(method::TOKENS_DELTA, Backend::tokens_delta)
            .custom_method(method::DIAGNOSTIC, Backend::pulled_findings)
            .custom_method("window/workDoneProgress/cancel", Backend::cancel_progress)
            .finish();
    let (frames_in, service_in) = tokio::io::duplex(PIPE_SIZE);
    let (service_out, frames_out) = tokio::io::duplex(PIPE_SIZE);
    let mut framing = tokio::spawn(framing::run(input, frames_in, frames_out, writer, outgoing, parcels));
    let server = Server::new(service_in, service_out, socket).concurrency_level(CONCURRENT_REQUESTS);
    let ending = tokio::select! {
        () = server.serve(service) => framing.await,
        // The end of input, and answers that take too long; dropping the service ends their work.
        ending = &mut framing => ending,
    };
    ending.unwrap_or(Ending::Abrupt)
}
