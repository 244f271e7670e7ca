//! What the server asks of the client.

use serde_json::json;
use tower_lsp::ls_types as lsp;

use super::Backend;
use crate::server::documents::Event;
use crate::settings;

impl Backend {
    /// Asks the client for its settings. Never called by a handler itself: the answer comes through
    /// the same queue as the message that the handler handles.
    pub(super) fn ask_for_settings(&self) {
        let (client, events, outbox) = (self.client.clone(), self.events.clone(), self.outbox.clone());
        tokio::spawn(async move {
            let item = lsp::ConfigurationItem { scope_uri: None, section: Some("apt".to_owned()) };
            match client.configuration(vec![item]).await {
                Ok(values) => {
                    let values = values.first().map(settings::of_editor).unwrap_or_default();
                    let _ = events.send(Event::Settings(values));
                }
                Err(error) => outbox.warn(format!("the client does not tell its settings: {error}")),
            }
        });
    }

    /// Asks the client to tell of changed project files.
    pub(super) fn watch_project_files(&self) {
        let (client, outbox) = (self.client.clone(), self.outbox.clone());
        tokio::spawn(async move {
            let watcher =
                json!({ "watchers": [{ "globPattern": format!("**/{}", settings::PROJECT_FILE) }] });
            let registration = lsp::Registration {
                id: "apt-lsp/project-files".to_owned(),
                method: "workspace/didChangeWatchedFiles".to_owned(),
                register_options: Some(watcher),
            };
            if let Err(error) = client.register_capability(vec![registration]).await {
                outbox.warn(format!("the client does not watch project files: {error}"));
            }
        });
    }
}
