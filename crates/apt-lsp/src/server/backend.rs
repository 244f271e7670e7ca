//! The handlers: each puts an event into the queue, or asks for a snapshot and has work done on it.

mod calls;
mod sent_tokens;
mod whole;
mod wishes;

use std::collections::{BTreeMap, HashMap};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use serde_json::{Value, json};
use tokio::sync::mpsc;
use tower_lsp::jsonrpc::{ErrorCode, Result};
use tower_lsp::ls_types::{self as lsp, ProgressToken, Uri};
use tower_lsp::{Client, LanguageServer};

use self::sent_tokens::SentTokens;
use super::capabilities::{ClientFeatures, server_capabilities};
use super::documents::{self, Event, Snapshot};
use super::job::{self, Events};
use super::outbox::Outbox;
use super::parcels::Parcels;
use super::progress::{Cancellations, Frames};
use super::{commands, diagnostics, lifetime, symbols};
use crate::analysis::{ActionKind, Answer, Control, Language, Level, Located, Refusal, Spot};
use crate::convert::{joined, outgoing, tokens};
use crate::settings::{self, Values};

/// The server gave up the work, and the client may ask again (an error code of the protocol).
const SERVER_CANCELLED: ErrorCode = ErrorCode::ServerError(-32802);

/// The server's side of one conversation.
pub(super) struct Backend {
    client: Client,
    language: Arc<dyn Language>,
    events: Events,
    outbox: Outbox,
    frames: Frames,
    features: OnceLock<ClientFeatures>,
    parcels: Parcels,
    cancellations: Cancellations,
    offered: AtomicU64,
    /// The client has told its settings with its introduction.
    told_settings: AtomicBool,
    /// What was last sent, for differences.
    sent_tokens: Mutex<BTreeMap<Uri, SentTokens>>,
}

impl Backend {
    /// Starts the tasks of a conversation. `notices` takes the bodies of messages to the client.
    pub(super) fn new(
        client: Client,
        language: Arc<dyn Language>,
        parcels: Parcels,
        notices: Frames,
    ) -> Self {
        let (events, waiting) = mpsc::unbounded_channel();
        let (touched, touches) = mpsc::unbounded_channel();
        let outbox = Outbox::start(client.clone(), notices.clone());
        if let Err(error) = documents::start(Arc::clone(&language), waiting, touched, outbox.clone()) {
            lifetime::complain(&format!("cannot start a thread: {error}"));
        }
        tokio::spawn(diagnostics::watch(touches, events.clone()));
        Self {
            client,
            language,
            events,
            outbox,
            frames: notices,
            features: OnceLock::new(),
            parcels,
            cancellations: Cancellations::default(),
            offered: AtomicU64::new(0),
            told_settings: AtomicBool::new(false),
            sent_tokens: Mutex::default(),
        }
    }

    /// The client, and the way to it past the library.
    pub(super) fn for_progress(&self) -> (Client, Frames) {
        (self.client.clone(), self.frames.clone())
    }

    pub(super) fn language(&self) -> &Arc<dyn Language> {
        &self.language
    }

    pub(super) fn events(&self) -> &Events {
        &self.events
    }

    pub(super) fn cancellations(&self) -> &Cancellations {
        &self.cancellations
    }

    /// What the client can do; the least before it has said so.
    pub(super) fn features(&self) -> ClientFeatures {
        self.features.get().cloned().unwrap_or_default()
    }

    /// A token for progress that the server begins, if the client shows such.
    pub(super) fn offered_progress(&self) -> Option<ProgressToken> {
        let shows = self.features.get().is_some_and(|features| features.progress);
        shows.then(|| {
            ProgressToken::String(format!("apt-lsp/{}", self.offered.fetch_add(1, Ordering::Relaxed)))
        })
    }

    fn happened(&self, event: Event) {
        // The owner of the documents ends only with the conversation.
        let _ = self.events.send(event);
    }

    async fn ask<T: Send + 'static>(
        &self,
        name: &'static str,
        uri: Uri,
        work: impl FnOnce(&Snapshot, &Control) -> Answer<T> + Send + 'static,
    ) -> Result<T> {
        let snapshot = job::snapshot(&self.events, uri).await?;
        job::on_snapshot(name, snapshot, work).await
    }

    async fn ask_at<T: Send + 'static>(
        &self,
        name: &'static str,
        place: lsp::TextDocumentPositionParams,
        work: impl FnOnce(&Snapshot, usize, &Control) -> Answer<T> + Send + 'static,
    ) -> Result<T> {
        let position = place.position;
        self.ask(name, place.text_document.uri, move |snapshot, control| {
            work(snapshot, snapshot.index.offset(position), control)
        })
        .await
    }

    async fn own(&self, command: &str, mut params: Value) -> Result<Value> {
        let token = params.as_object_mut().and_then(|fields| fields.remove("workDoneToken"));
        let token = token.and_then(|token| serde_json::from_value(token).ok());
        commands::execute(self, command, params, token).await
    }

    pub(super) async fn run_motion(&self, params: Value) -> Result<Value> {
        self.own("apt.runMotion", params).await
    }

    pub(super) async fn expand(&self, params: Value) -> Result<Value> {
        self.own("apt.expand", params).await
    }

    pub(super) async fn canonical_form(&self, params: Value) -> Result<Value> {
        self.own("apt.canonicalForm", params).await
    }

    pub(super) async fn post(&self, params: Value) -> Result<Value> {
        self.own("apt.post", params).await
    }

    pub(super) async fn syntax_tree(&self, params: Value) -> Result<Value> {
        self.own("apt.syntaxTree", params).await
    }

    pub(super) async fn machines(&self, params: Value) -> Result<Value> {
        self.own("apt.machines", params).await
    }

    pub(super) async fn status(&self, params: Value) -> Result<Value> {
        self.own("apt.status", params).await
    }

    pub(super) async fn cancel_progress(&self, params: lsp::WorkDoneProgressCancelParams) {
        self.cancellations.cancel(&params.token);
    }
}

/// Edits of one answer: more cost an editor far more time than the text between them.
const MOST_EDITS: usize = 1_000;

/// The edits that give a document its style, or the statements in a range of it.
fn formatting_edits(
    snapshot: &Snapshot,
    range: Option<lsp::Range>,
    control: &Control,
) -> Answer<Vec<lsp::TextEdit>> {
    let range = range.map(|range| snapshot.index.bytes(range));
    let edits = snapshot.document.format(range, control)?.edits;
    let edits = joined(&snapshot.index.rope, edits, MOST_EDITS).into_iter();
    Ok(edits.map(|edit| outgoing::edit(&snapshot.index, edit)).collect())
}

/// Places in the files of the program that a document belongs to, as locations.
fn locations(snapshot: &Snapshot, found: &[Located], control: &Control) -> Answer<Vec<lsp::Location>> {
    let (mut places, pace) = (snapshot.places(), control.pace());
    let mut locations = Vec::with_capacity(found.len());
    for one in found {
        pace.go_on(1)?;
        locations.extend(places.location(one.source.as_ref(), &one.occurrence.range));
    }
    Ok(locations)
}

/// The kinds of actions that a client asks for: without saying so all that belong to a place.
fn wanted_actions(only: Option<&[lsp::CodeActionKind]>) -> Vec<ActionKind> {
    let is_wanted = |kind: &ActionKind| match only {
        None => *kind != ActionKind::FixAll,
        Some(only) => only.iter().any(|wanted| {
            let rest = kind.name().strip_prefix(wanted.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.') || wanted.as_str().is_empty())
        }),
    };
    ActionKind::ALL.into_iter().filter(is_wanted).collect()
}

impl LanguageServer for Backend {
    async fn initialize(&self, params: lsp::InitializeParams) -> Result<lsp::InitializeResult> {
        let features = ClientFeatures::of(&params.capabilities);
        let capabilities = server_capabilities(&features);
        self.happened(Event::Introduced {
            encoding: features.encoding,
            push: !features.pulls,
            refresh: features.refresh,
            watches: features.watches_files,
        });
        let _ = self.features.set(features);
        let options = params.initialization_options.unwrap_or_default();
        self.told_settings.store(!options.is_null(), Ordering::Relaxed);
        self.happened(Event::Settings(settings::of_editor(&options)));
        if let Some(parent) = params.process_id.and_then(|id| i32::try_from(id).ok()) {
            lifetime::watch_parent(parent);
        }
        let server_info = lsp::ServerInfo {
            name: env!("CARGO_PKG_NAME").to_owned(),
            version: Some(env!("CARGO_PKG_VERSION").to_owned()),
        };
        Ok(lsp::InitializeResult { capabilities, server_info: Some(server_info), offset_encoding: None })
    }

    async fn initialized(&self, _: lsp::InitializedParams) {
        let features = self.features();
        if features.watches_files {
            self.watch_project_files();
        }
        // Some clients tell their settings only when they are asked for them.
        if features.configuration && !self.told_settings.load(Ordering::Relaxed) {
            self.ask_for_settings();
        }
    }

    async fn shutdown(&self) -> Result<()> {
        Ok(())
    }

    async fn did_open(&self, params: lsp::DidOpenTextDocumentParams) {
        let document = params.text_document;
        self.happened(Event::Opened { uri: document.uri, version: document.version, text: document.text });
    }

    async fn did_change(&self, params: lsp::DidChangeTextDocumentParams) {
        let lsp::VersionedTextDocumentIdentifier { uri, version } = params.text_document;
        self.happened(Event::Changed { uri, version, changes: params.content_changes });
    }

    async fn did_close(&self, params: lsp::DidCloseTextDocumentParams) {
        let uri = params.text_document.uri;
        self.forget_tokens(&uri);
        self.happened(Event::Closed(uri));
    }

    async fn did_change_configuration(&self, params: lsp::DidChangeConfigurationParams) {
        if params.settings.is_object() {
            self.happened(Event::Settings(settings::of_changed_editor(&params.settings)));
        } else if self.features().configuration {
            self.ask_for_settings();
        } else {
            self.happened(Event::Settings(Values::new()));
        }
    }

    async fn did_change_watched_files(&self, params: lsp::DidChangeWatchedFilesParams) {
        let paths = params.changes.iter().filter_map(|change| documents::file_path(&change.uri));
        let is_project =
            |path: &std::path::PathBuf| path.file_name().is_some_and(|name| name == settings::PROJECT_FILE);
        let (project, others): (Vec<_>, Vec<_>) = paths.partition(is_project);
        if !project.is_empty() || others.is_empty() {
            self.happened(Event::ProjectChanged);
        }
        if !others.is_empty() {
            self.happened(Event::FilesChanged(others));
        }
    }

    async fn hover(&self, params: lsp::HoverParams) -> Result<Option<lsp::Hover>> {
        self.ask_at("hover", params.text_document_position_params, |snapshot, offset, control| {
            let file = snapshot.included_path();
            let spot = Spot { file: file.as_deref(), offset };
            let found = snapshot.program().document.hover(spot, control)?;
            Ok(found.map(|found| outgoing::hover(&snapshot.index, found)))
        })
        .await
    }

    async fn completion(&self, params: lsp::CompletionParams) -> Result<Option<lsp::CompletionResponse>> {
        let snippets = self.features().snippets;
        self.ask_at("completion", params.text_document_position, move |snapshot, offset, control| {
            let items = outgoing::completions(snapshot.document.completions(offset, control)?, snippets);
            Ok(Some(lsp::CompletionResponse::Array(items)))
        })
        .await
    }

    async fn signature_help(&self, params: lsp::SignatureHelpParams) -> Result<Option<lsp::SignatureHelp>> {
        let offsets = self.features().label_offsets;
        self.ask_at("signature help", params.text_document_position_params, move |snapshot, offset, _| {
            let found = snapshot.document.signature_help(offset);
            Ok(found.map(|found| outgoing::signature_help(found, offsets)))
        })
        .await
    }

    async fn goto_definition(
        &self,
        params: lsp::GotoDefinitionParams,
    ) -> Result<Option<lsp::GotoDefinitionResponse>> {
        self.ask_at("definition", params.text_document_position_params, |snapshot, offset, control| {
            let file = snapshot.included_path();
            let spot = Spot { file: file.as_deref(), offset };
            let found = snapshot.program().document.definitions(spot, control)?;
            let places = locations(snapshot, &found, control)?;
            Ok((!places.is_empty()).then_some(lsp::GotoDefinitionResponse::Array(places)))
        })
        .await
    }

    async fn goto_declaration(
        &self,
        params: lsp::request::GotoDeclarationParams,
    ) -> Result<Option<lsp::request::GotoDeclarationResponse>> {
        // Names are declared where they get their value: there is no other place for it.
        self.goto_definition(params).await
    }

    async fn prepare_call_hierarchy(
        &self,
        params: lsp::CallHierarchyPrepareParams,
    ) -> Result<Option<Vec<lsp::CallHierarchyItem>>> {
        self.routine_at(params.text_document_position_params).await
    }

    async fn incoming_calls(
        &self,
        params: lsp::CallHierarchyIncomingCallsParams,
    ) -> Result<Option<Vec<lsp::CallHierarchyIncomingCall>>> {
        self.callers_of(params.item).await
    }

    async fn outgoing_calls(
        &self,
        params: lsp::CallHierarchyOutgoingCallsParams,
    ) -> Result<Option<Vec<lsp::CallHierarchyOutgoingCall>>> {
        self.callees_of(params.item).await
    }

    async fn document_highlight(
        &self,
        params: lsp::DocumentHighlightParams,
    ) -> Result<Option<Vec<lsp::DocumentHighlight>>> {
        self.ask_at("highlights", params.text_document_position_params, |snapshot, offset, control| {
            let (found, pace) = (snapshot.document.occurrences(offset, control)?, control.pace());
            let highlight = |one| pace.go_on(1).map(|()| outgoing::highlight(&snapshot.index, one));
            found.iter().map(highlight).collect::<Answer<_>>().map(Some)
        })
        .await
    }

    async fn prepare_rename(
        &self,
        params: lsp::TextDocumentPositionParams,
    ) -> Result<Option<lsp::PrepareRenameResponse>> {
        self.ask_at("rename", params, |snapshot, offset, _| {
            let file = snapshot.included_path();
            let found = snapshot.program().document.renamable(Spot { file: file.as_deref(), offset });
            Ok(found.map(|range| lsp::PrepareRenameResponse::Range(snapshot.index.range(&range))))
        })
        .await
    }

    async fn rename(&self, params: lsp::RenameParams) -> Result<Option<lsp::WorkspaceEdit>> {
        let place = params.text_document_position;
        let snapshot = job::snapshot(&self.events, place.text_document.uri).await?;
        let versioned = self.features().versioned_edits;
        let changes = job::on_snapshot("rename", snapshot, move |snapshot, control| {
            let file = snapshot.included_path();
            let spot = Spot { file: file.as_deref(), offset: snapshot.index.offset(place.position) };
            let edits = snapshot.program().document.rename(spot, &params.new_name, control)?;
            let pace = control.pace();
            let mut places = snapshot.places();
            let mut changes = HashMap::<Uri, Vec<lsp::TextEdit>>::new();
            for (one, new_text) in edits {
                pace.go_on(1)?;
                if let Some(at) = places.location(one.source.as_ref(), &one.occurrence.range) {
                    changes.entry(at.uri).or_default().push(lsp::TextEdit { range: at.range, new_text });
                }
            }
            if !versioned {
                return Ok(outgoing::plain_edit(changes));
            }
            let mut changes: Vec<_> = changes
                .into_iter()
                .map(|(uri, edits)| {
                    let version = snapshot.version_of(&uri);
                    (uri, version, edits)
                })
                .collect();
            changes.sort_by(|one, other| one.0.as_str().cmp(other.0.as_str()));
            Ok::<_, Refusal>(outgoing::versioned_edit(changes))
        })
        .await?;
        Ok(Some(changes))
    }

    async fn inlay_hint(&self, params: lsp::InlayHintParams) -> Result<Option<Vec<lsp::InlayHint>>> {
        let range = params.range;
        self.ask("inlay hints", params.text_document.uri, move |snapshot, control| {
            let file = snapshot.included_path();
            let range = snapshot.index.bytes(range);
            let found = snapshot.program().document.inlays(file.as_deref(), range, control)?;
            Ok(Some(outgoing::inlays(&snapshot.index, found)))
        })
        .await
    }

    async fn selection_range(
        &self,
        params: lsp::SelectionRangeParams,
    ) -> Result<Option<Vec<lsp::SelectionRange>>> {
        let positions = params.positions;
        self.ask("selection ranges", params.text_document.uri, move |snapshot, _| {
            let selection = |position: lsp::Position| {
                let offset = snapshot.index.offset(position);
                outgoing::selection(&snapshot.index, offset, &snapshot.document.selections(offset))
            };
            Ok(Some(positions.into_iter().map(selection).collect()))
        })
        .await
    }

    async fn symbol(
        &self,
        params: lsp::WorkspaceSymbolParams,
    ) -> Result<Option<lsp::WorkspaceSymbolResponse>> {
        /// Symbols of one answer; nobody reads more, and a longer query finds fewer.
        const MOST_SYMBOLS: usize = 1_000;
        let mut found: Vec<lsp::SymbolInformation> = Vec::new();
        let open = job::snapshots(&self.events).await?;
        for snapshot in &open {
            let query = params.query.clone();
            let named = job::on_snapshot("workspace symbols", snapshot.clone(), move |snapshot, control| {
                symbols::of_document(snapshot, &query, control)
            });
            found.extend(named.await?);
        }
        if let Some(first) = open.first().cloned() {
            let language = Arc::clone(&self.language);
            let closed = job::on_snapshot("workspace symbols", first, move |_, control| {
                symbols::of_closed_files(&open, language.as_ref(), &params.query, control)
            });
            found.extend(closed.await?);
        }
        found.truncate(MOST_SYMBOLS);
        Ok(Some(found.into()))
    }

    async fn document_link(&self, params: lsp::DocumentLinkParams) -> Result<Option<Vec<lsp::DocumentLink>>> {
        self.ask("document links", params.text_document.uri, |snapshot, _| {
            let found = snapshot.document.inclusions();
            Ok(Some(outgoing::links(&snapshot.index, &snapshot.uris, found)))
        })
        .await
    }

    async fn code_action(&self, params: lsp::CodeActionParams) -> Result<Option<lsp::CodeActionResponse>> {
        let wanted = wanted_actions(params.context.only.as_deref());
        // What the editor shows says how far the findings go that are asked about.
        let of_motion = params.context.diagnostics.iter().any(outgoing::is_of_motion);
        let versioned = self.features().versioned_edits;
        let range = params.range;
        self.ask("code actions", params.text_document.uri, move |snapshot, control| {
            let level = if of_motion { Level::Motion } else { Level::Section1 };
            let range = snapshot.index.bytes(range);
            let found = snapshot.document.actions(range, &wanted, level, control)?;
            let version = versioned.then_some(snapshot.version);
            let action = |one| outgoing::action(&snapshot.index, &snapshot.uri, version, one).into();
            Ok(Some(found.into_iter().map(action).collect()))
        })
        .await
    }

    async fn range_formatting(
        &self,
        params: lsp::DocumentRangeFormattingParams,
    ) -> Result<Option<Vec<lsp::TextEdit>>> {
        let range = params.range;
        self.ask("formatting", params.text_document.uri, move |snapshot, control| {
            formatting_edits(snapshot, Some(range), control).map(Some)
        })
        .await
    }

    async fn semantic_tokens_range(
        &self,
        params: lsp::SemanticTokensRangeParams,
    ) -> Result<Option<lsp::SemanticTokensRangeResult>> {
        let range = params.range;
        self.ask("semantic tokens", params.text_document.uri, move |snapshot, control| {
            let found = snapshot.document.tokens(Some(snapshot.index.bytes(range)), control)?;
            let data = tokens::encode(&snapshot.index, &found, &control.pace())?;
            Ok(Some(lsp::SemanticTokens { result_id: None, data }.into()))
        })
        .await
    }

    async fn execute_command(&self, params: lsp::ExecuteCommandParams) -> Result<Option<Value>> {
        let argument = params.arguments.into_iter().next().unwrap_or_else(|| json!({}));
        let token = params.work_done_progress_params.work_done_token;
        commands::execute(self, &params.command, argument, token).await.map(Some)
    }
}
