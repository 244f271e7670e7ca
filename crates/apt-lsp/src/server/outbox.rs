//! What the server tells the client of its own accord, in order, by one task.
//!
//! Those who tell something only put it here; nobody who handles a message ever waits for the client.

use serde::Serialize;
use serde_json::json;
use tokio::sync::mpsc;
use tower_lsp::Client;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{
    Diagnostic, MessageType, PublishDiagnosticsParams, Registration, Unregistration, Uri,
};

/// Something to tell.
#[derive(Debug)]
pub(super) enum Notice {
    /// The findings in one version of a document.
    Findings {
        /// The document.
        uri: Uri,
        /// The findings.
        diagnostics: Vec<Diagnostic>,
        /// The version in which they were found; none for a closed document.
        version: Option<i32>,
    },
    /// A line for the log of the client.
    Log(MessageType, String),
    /// Something that the user should see.
    Show(String),
    /// The findings of clients that pull are out of date.
    Refresh,
    /// Included files are to be watched, by name.
    Watch {
        /// All of them.
        names: Vec<String>,
        /// Whether others were watched before.
        again: bool,
    },
}

/// Registers the watching of included files anew.
async fn watch_included(client: &Client, names: &[String], again: bool) -> Result<()> {
    const ID: &str = "apt-lsp/included-files";
    const METHOD: &str = "workspace/didChangeWatchedFiles";
    if again {
        let old = Unregistration { id: ID.to_owned(), method: METHOD.to_owned() };
        client.unregister_capability(vec![old]).await?;
    }
    if names.is_empty() {
        return Ok(());
    }
    let watchers: Vec<_> = names.iter().map(|name| json!({ "globPattern": format!("**/{name}") })).collect();
    let registration = Registration {
        id: ID.to_owned(),
        method: METHOD.to_owned(),
        register_options: Some(json!({ "watchers": watchers })),
    };
    client.register_capability(vec![registration]).await
}

/// The findings of a document as a message. The library would make a JSON value of them first, which takes most of the
/// time of an edit.
#[derive(Serialize)]
struct Published {
    jsonrpc: &'static str,
    method: &'static str,
    params: PublishDiagnosticsParams,
}

/// Sends findings. After the end of the conversation they go nowhere.
async fn publish(frames: &mpsc::WeakSender<Vec<u8>>, params: PublishDiagnosticsParams) {
    let message = Published { jsonrpc: "2.0", method: "textDocument/publishDiagnostics", params };
    if let (Some(frames), Ok(body)) = (frames.upgrade(), serde_json::to_vec(&message)) {
        let _ = frames.send(body).await;
    }
}

/// The way into the outbox.
#[derive(Debug, Clone)]
pub(super) struct Outbox(mpsc::UnboundedSender<Notice>);

impl Outbox {
    /// Starts the task that empties the outbox. `frames` takes bodies of messages; it is weak, so that the outbox does not
    /// keep the conversation from its end.
    pub(super) fn start(client: Client, frames: mpsc::WeakSender<Vec<u8>>) -> Self {
        let (sender, mut waiting) = mpsc::unbounded_channel();
        let (watching, mut to_watch) = mpsc::unbounded_channel::<(Vec<String>, bool)>();
        let watcher = client.clone();
        tokio::spawn(async move {
            while let Some((names, again)) = to_watch.recv().await {
                if let Err(error) = watch_included(&watcher, &names, again).await {
                    let text = format!("the client does not watch included files: {error}");
                    watcher.log_message(MessageType::WARNING, text).await;
                }
            }
        });
        tokio::spawn(async move {
            while let Some(notice) = waiting.recv().await {
                match notice {
                    Notice::Findings { uri, diagnostics, version } => {
                        publish(&frames, PublishDiagnosticsParams { uri, diagnostics, version }).await;
                    }
                    Notice::Log(level, text) => client.log_message(level, text).await,
                    Notice::Show(text) => client.show_message(MessageType::WARNING, text).await,
                    Notice::Refresh => {
                        let client = client.clone();
                        // A request: its answer must not hold up the notices behind it.
                        tokio::spawn(async move { client.workspace_diagnostic_refresh().await });
                    }
                    Notice::Watch { names, again } => {
                        // Requests as well; one after the other, so that the last one counts.
                        let _ = watching.send((names, again));
                    }
                }
            }
        });
        Self(sender)
    }

    /// Puts something in. After the end of the conversation it goes nowhere.
    pub(super) fn tell(&self, notice: Notice) {
        let _ = self.0.send(notice);
    }

    /// A warning for the log.
    pub(super) fn warn(&self, text: String) {
        self.tell(Notice::Log(MessageType::WARNING, text));
    }
}
