//! What the server tells the client of its own accord, in order, by one task.
//!
//! Those who tell something only put it here; nobody who handles a message ever waits for the client.

use serde_json::json;
use tokio::sync::mpsc;
use tower_lsp::Client;
use tower_lsp::jsonrpc::Result;
use tower_lsp::ls_types::{MessageType, Registration, Unregistration};

/// Something to tell.
#[derive(Debug)]
pub(super) enum Notice {
    /// A message that is written already: the findings in a version of a document.
    Findings(Vec<u8>),
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
                    // After the end of the conversation they go nowhere.
                    Notice::Findings(message) => {
                        if let Some(frames) = frames.upgrade() {
                            let _ = frames.send(message).await;
                        }
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
