//! Work-done progress: told by a task of its own, so that nobody who works waits for the client.
//!
//! It is written past the library, which may send an answer before a notice that was given to it earlier: a token of the
//! client is good until the answer comes, and not longer.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use serde_json::json;
use tokio::sync::{mpsc, watch};
use tokio::task::JoinHandle;
use tokio::time::sleep;
use tokio_util::sync::CancellationToken;
use tower_lsp::Client;
use tower_lsp::ls_types::{
    ProgressParams, ProgressParamsValue, ProgressToken, WorkDoneProgress, WorkDoneProgressBegin,
    WorkDoneProgressEnd, WorkDoneProgressReport,
};

use crate::analysis::Progress;

/// Work that ends sooner is not announced by the server.
const WORTH_SHOWING: Duration = Duration::from_millis(250);

/// Time between two reports.
const INTERVAL: Duration = Duration::from_millis(100);

/// The works whose progress is shown, by the token of the client, so that its user can end them: also before they have
/// begun.
#[derive(Debug, Clone, Default)]
pub(super) struct Cancellations(Arc<Mutex<BTreeMap<String, CancellationToken>>>);

impl Cancellations {
    /// Ends the work with this token.
    pub(super) fn cancel(&self, token: &ProgressToken) {
        if let Some(work) = self.lock().get(&key(token)) {
            work.cancel();
        }
    }

    /// Notes that work with this token was asked for. Until it begins, its user's wish to end it is kept here.
    pub(super) fn expect(&self, token: &ProgressToken) -> Expected {
        self.lock().insert(key(token), CancellationToken::new());
        Expected { cancellations: self.clone(), token: token.clone() }
    }

    /// From now on the token ends this work; at once, if that has been wished for before.
    fn insert(&self, token: &ProgressToken, work: &CancellationToken) {
        if self.lock().insert(key(token), work.clone()).is_some_and(|expected| expected.is_cancelled()) {
            work.cancel();
        }
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<String, CancellationToken>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn remove(&self, token: &ProgressToken) {
        self.lock().remove(&key(token));
    }
}

/// Work that was asked for. Dropping it forgets the token.
#[derive(Debug)]
pub(super) struct Expected {
    cancellations: Cancellations,
    token: ProgressToken,
}

impl Drop for Expected {
    fn drop(&mut self) {
        self.cancellations.remove(&self.token);
    }
}

/// A number and a string that look the same are different tokens.
fn key(token: &ProgressToken) -> String {
    match token {
        ProgressToken::Number(number) => format!("number {number}"),
        ProgressToken::String(text) => format!("string {text}"),
    }
}

/// The end at which work tells its progress. Dropping it ends the display.
#[derive(Debug)]
pub(super) struct Reporter(watch::Sender<Option<Progress>>);

impl Reporter {
    /// Tells how far the work is; cheap, and never waits.
    pub(super) fn report(&self, progress: Progress) {
        self.0.send_replace(Some(progress));
    }
}

/// Who shows the progress.
#[derive(Debug)]
pub(super) enum Display {
    /// The client gave a token with the request and waits for reports.
    Requested(ProgressToken),
    /// The server asks for a display under this token if the work takes long.
    Offered(ProgressToken),
}

/// Where the bodies of messages to the client are put in; weak, so that it does not keep the conversation from its end.
pub(super) type Frames = mpsc::WeakSender<Vec<u8>>;

/// The display of a progress that the client asked for with its request.
#[derive(Debug)]
pub(super) struct Shown(JoinHandle<()>);

impl Shown {
    /// Waits until the end of the work has been told.
    pub(super) async fn ended(self) {
        // A display that broke down tells no more.
        let _ = self.0.await;
    }
}

/// Begins to tell the progress of a work that `work` ends.
pub(super) fn begin(
    (client, frames): (Client, Frames),
    cancellations: &Cancellations,
    display: Display,
    title: &'static str,
    work: &CancellationToken,
) -> (Reporter, Option<Shown>) {
    let (sender, receiver) = watch::channel(None);
    let cancellations = cancellations.clone();
    let (Display::Requested(token) | Display::Offered(token)) = &display;
    cancellations.insert(token, work);
    let token = token.clone();
    let is_requested = matches!(display, Display::Requested(_));
    let task = tokio::spawn(async move {
        show((client, frames), display, title, receiver).await;
        if !is_requested {
            cancellations.remove(&token);
        }
    });
    // A display that the server offers may wait long for the client; its token is the server's own.
    (Reporter(sender), is_requested.then_some(Shown(task)))
}

async fn show(
    (client, frames): (Client, Frames),
    display: Display,
    title: &str,
    mut progress: watch::Receiver<Option<Progress>>,
) {
    let token = match display {
        Display::Requested(token) => token,
        Display::Offered(token) => {
            sleep(WORTH_SHOWING).await;
            if is_over(&progress) {
                return;
            }
            // Whoever agrees waits for a begin and an end from then on, be the work over or not; who never answers is not
            // told, and costs this task.
            if client.create_work_done_progress(token.clone()).await.is_err() {
                return;
            }
            token
        }
    };
    let begin =
        WorkDoneProgressBegin { title: title.to_owned(), cancellable: Some(true), ..Default::default() };
    tell(&frames, &token, WorkDoneProgress::Begin(begin)).await;
    while progress.changed().await.is_ok() {
        let report = progress.borrow_and_update().as_ref().map(|now| WorkDoneProgressReport {
            cancellable: Some(true),
            message: Some(now.message.clone()),
            percentage: percentage(now),
        });
        if let Some(report) = report {
            tell(&frames, &token, WorkDoneProgress::Report(report)).await;
        }
        let mut end = progress.clone();
        tokio::select! {
            () = sleep(INTERVAL) => {}
            _ = end.wait_for(|_| false) => {}
        }
    }
    tell(&frames, &token, WorkDoneProgress::End(WorkDoneProgressEnd::default())).await;
}

fn is_over(progress: &watch::Receiver<Option<Progress>>) -> bool {
    progress.has_changed().is_err()
}

fn percentage(progress: &Progress) -> Option<u32> {
    let total = progress.total.filter(|total| *total > 0)?;
    u32::try_from(progress.done.min(total).saturating_mul(100) / total).ok()
}

async fn tell(frames: &Frames, token: &ProgressToken, value: WorkDoneProgress) {
    let params = ProgressParams { token: token.clone(), value: ProgressParamsValue::WorkDone(value) };
    let message = json!({ "jsonrpc": "2.0", "method": "$/progress", "params": params });
    // After the end of the conversation it goes nowhere.
    if let Some(frames) = frames.upgrade() {
        let _ = frames.send(message.to_string().into_bytes()).await;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentages_stay_within_bounds() {
        let of = |done, total| percentage(&Progress { done, total, message: String::new() });
        assert_eq!(of(0, Some(3)), Some(0));
        assert_eq!(of(2, Some(3)), Some(66));
        assert_eq!(of(9, Some(3)), Some(100));
        assert_eq!(of(1, Some(0)), None);
        assert_eq!(of(1, None), None);
    }

    #[test]
    fn tokens_that_look_alike_are_told_apart() {
        let cancellations = Cancellations::default();
        let (number, text) = (CancellationToken::new(), CancellationToken::new());
        cancellations.insert(&ProgressToken::Number(1), &number);
        cancellations.insert(&ProgressToken::String("1".to_owned()), &text);
        cancellations.cancel(&ProgressToken::String("1".to_owned()));
        assert_eq!((number.is_cancelled(), text.is_cancelled()), (false, true));
    }
}
