//! Work on a snapshot, away from the threads that carry messages.

use tokio::sync::{mpsc, oneshot};
use tokio_util::sync::CancellationToken;
use tower_lsp::jsonrpc::{Error, ErrorCode, Result};
use tower_lsp::ls_types::Uri;

use super::documents::{Circumstances, Event, Snapshot};
use super::progress::Reporter;
use crate::analysis::{Control, Refusal};

/// The way to the owner of the documents.
pub(super) type Events = mpsc::UnboundedSender<Event>;

/// The request was in order, but cannot be done (an error code of the protocol).
const REQUEST_FAILED: ErrorCode = ErrorCode::ServerError(-32803);

/// The document as it is now, with every change that was sent before this call.
pub(super) async fn snapshot(events: &Events, uri: Uri) -> Result<Snapshot> {
    let unknown = format!("{} is not open", uri.as_str());
    let (reply, answer) = oneshot::channel();
    events.send(Event::Snapshot(uri, reply)).map_err(|_| Error::internal_error())?;
    match answer.await {
        Ok(Some(snapshot)) => Ok(snapshot),
        Ok(None) => Err(Error::invalid_params(unknown)),
        Err(_) => Err(internal_fault("reading the document")),
    }
}

/// What counts for a file that is not open.
pub(super) async fn circumstances(events: &Events, uri: Uri) -> Result<Circumstances> {
    let (reply, answer) = oneshot::channel();
    events.send(Event::Circumstances(uri, reply)).map_err(|_| Error::internal_error())?;
    answer.await.map_err(|_| internal_fault("reading the settings"))
}

/// All open documents as they are now.
pub(super) async fn snapshots(events: &Events) -> Result<Vec<Snapshot>> {
    let (reply, answer) = oneshot::channel();
    events.send(Event::Snapshots(reply)).map_err(|_| Error::internal_error())?;
    answer.await.map_err(|_| internal_fault("reading the documents"))
}

/// Does work on a thread of its own. It is cancelled when the caller is dropped (that is what the
/// cancelling of a request does) and when the document changes.
pub(super) async fn on_snapshot<T: Send + 'static, E: Into<Refusal> + Send + 'static>(
    name: &'static str,
    snapshot: Snapshot,
    work: impl FnOnce(&Snapshot, &Control) -> std::result::Result<T, E> + Send + 'static,
) -> Result<T> {
    let token = snapshot.superseded.child_token();
    with_progress(name, snapshot, token, None, work).await
}

/// The same, with a token of the caller (a child of the snapshot's) and somebody to tell the progress.
pub(super) async fn with_progress<T: Send + 'static, E: Into<Refusal> + Send + 'static>(
    name: &'static str,
    snapshot: Snapshot,
    token: CancellationToken,
    reporter: Option<Reporter>,
    work: impl FnOnce(&Snapshot, &Control) -> std::result::Result<T, E> + Send + 'static,
) -> Result<T> {
    let superseded = snapshot.superseded.clone();
    let _guard = token.clone().drop_guard();
    let workers = snapshot.workers.clone();
    let done = workers.run(move || {
        let mut control = Control::new(token);
        if let Some(reporter) = reporter {
            control = control.with_progress(move |progress| reporter.report(progress));
        }
        work(&snapshot, &control)
    });
    match done.await.map(|answer| answer.map_err(Into::into)) {
        Ok(Ok(answer)) => Ok(answer),
        Ok(Err(Refusal::Interrupted)) if superseded.is_cancelled() => Err(Error::content_modified()),
        Ok(Err(Refusal::Interrupted)) => Err(Error::request_cancelled()),
        Ok(Err(refusal)) => {
            Err(Error { code: REQUEST_FAILED, message: refusal.to_string().into(), data: None })
        }
        Err(_) => Err(internal_fault(name)),
    }
}

/// The answer to a request whose work panicked. What happened stands on standard error.
pub(super) fn internal_fault(name: &str) -> Error {
    let message = format!("internal fault in {name}; the server goes on");
    Error { code: ErrorCode::InternalError, message: message.into(), data: None }
}
