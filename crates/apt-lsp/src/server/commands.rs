//! The server's own commands, as `workspace/executeCommand` and as requests `apt/…`.

use std::sync::Arc;

use ropey::Rope;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use tokio_util::sync::CancellationToken;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::{Position, ProgressToken, Range, Uri};

use super::backend::Backend;
use super::documents::{Circumstances, Snapshot, file_path};
use super::job;
use super::progress::{self, Display};
use super::status;
use crate::analysis::{Control, Refusal, RunRequest};
use crate::convert::{TextIndex, outgoing};
use crate::settings::Settings;
use crate::source::ProgramFile;

#[derive(Deserialize)]
struct RunArgument {
    uri: Uri,
    range: Option<Range>,
    machine: Option<String>,
    #[serde(default)]
    scene: bool,
    #[serde(default)]
    story: bool,
}

#[derive(Deserialize)]
struct ExpandArgument {
    uri: Uri,
    position: Option<Position>,
    depth: Option<u32>,
}

#[derive(Deserialize)]
struct PlaceArgument {
    uri: Uri,
    position: Position,
}

#[derive(Deserialize)]
struct PostArgument {
    uri: Uri,
    machine: Option<String>,
}

#[derive(Deserialize)]
struct DocumentArgument {
    uri: Uri,
}

/// Does a command. `token` is where the client wants to see progress.
pub(super) async fn execute(
    server: &Backend,
    command: &str,
    argument: Value,
    token: Option<ProgressToken>,
) -> Result<Value> {
    // Before anything is waited for, so that no wish to end the work is lost.
    let _expected = token.as_ref().map(|token| server.cancellations().expect(token));
    match command {
        "apt.runMotion" => run_motion(server, read(argument)?, token).await,
        "apt.expand" => expand(server, read(argument)?, token).await,
        "apt.canonicalForm" => canonical_form(server, read(argument)?, token).await,
        "apt.post" => post(server, read(argument)?, token).await,
        "apt.syntaxTree" => syntax_tree(server, read(argument)?, token).await,
        "apt.machines" => machines(server),
        "apt.status" => status::status(server).await,
        unknown => Err(Error::invalid_params(format!("there is no command `{unknown}`"))),
    }
}

fn read<T: DeserializeOwned>(argument: Value) -> Result<T> {
    serde_json::from_value(argument).map_err(|error| Error::invalid_params(error.to_string()))
}

async fn run_motion(server: &Backend, argument: RunArgument, token: Option<ProgressToken>) -> Result<Value> {
    let snapshot = present(server, argument.uri).await?;
    let RunArgument { range, machine, scene, story, .. } = argument;
    let language = Arc::clone(server.language());
    long(server, "Run motion", snapshot, token, move |snapshot, control| {
        let machine = match machine.or_else(|| default_machine(&snapshot.settings)) {
            Some(machine) => Some(machine),
            // Nobody has asked for this one: if it is another's, there is a run without a tape.
            None => snapshot.document.machine_of_program(control)?.filter(|name| language.has_machine(name)),
        };
        let range = range.map(|range| snapshot.index.bytes(range));
        snapshot.document.run(&RunRequest { range, machine, scene, story }, control)
    })
    .await
}

async fn expand(server: &Backend, argument: ExpandArgument, token: Option<ProgressToken>) -> Result<Value> {
    let snapshot = present(server, argument.uri).await?;
    let ExpandArgument { position, depth, .. } = argument;
    long(server, "Expand", snapshot, token, move |snapshot, control| {
        let at = position.map(|position| snapshot.index.offset(position));
        let expansion = snapshot.document.expand(at, depth, control)?;
        Ok(outgoing::expansion(&snapshot.index, &expansion))
    })
    .await
}

async fn canonical_form(
    server: &Backend,
    argument: PlaceArgument,
    token: Option<ProgressToken>,
) -> Result<Value> {
    let snapshot = present(server, argument.uri).await?;
    let position = argument.position;
    long(server, "Canonical form", snapshot, token, move |snapshot, control| {
        let found = snapshot.document.canonical_form(snapshot.index.offset(position), control)?;
        Ok(found.map_or(Value::Null, |form| {
            json!({ "name": form.name, "type": form.kind, "canonical": form.canonical, "text": form.text })
        }))
    })
    .await
}

async fn post(server: &Backend, argument: PostArgument, token: Option<ProgressToken>) -> Result<Value> {
    let snapshot = present(server, argument.uri).await?;
    long(server, "Post", snapshot, token, move |snapshot, control| {
        let machine = match argument.machine.or_else(|| default_machine(&snapshot.settings)) {
            Some(machine) => machine,
            None => snapshot.document.machine_of_program(control)?.ok_or(Refusal::NoMachine)?,
        };
        snapshot.document.tape(&machine, control)
    })
    .await
}

async fn syntax_tree(
    server: &Backend,
    argument: DocumentArgument,
    token: Option<ProgressToken>,
) -> Result<Value> {
    let snapshot = present(server, argument.uri).await?;
    long(server, "Syntax tree", snapshot, token, |snapshot, control| {
        Ok(json!({ "text": snapshot.document.syntax_tree(control)? }))
    })
    .await
}

fn machines(server: &Backend) -> Result<Value> {
    serde_json::to_value(server.language().machines()).map_err(|_| Error::internal_error())
}

fn default_machine(settings: &Settings) -> Option<String> {
    settings.program.get("machine").and_then(Value::as_str).map(str::to_owned)
}

/// Work that shows progress and can be cancelled from there.
async fn long(
    server: &Backend,
    title: &'static str,
    snapshot: Snapshot,
    requested: Option<ProgressToken>,
    work: impl FnOnce(&Snapshot, &Control) -> std::result::Result<Value, Refusal> + Send + 'static,
) -> Result<Value> {
    let token = snapshot.superseded.child_token();
    let display =
        requested.map(Display::Requested).or_else(|| server.offered_progress().map(Display::Offered));
    let (reporter, shown) = display
        .map(|display| progress::begin(server.for_progress(), server.cancellations(), display, title, &token))
        .unzip();
    let answer = job::with_progress(title, snapshot, token, reporter, work).await;
    if let Some(shown) = shown.flatten() {
        shown.ended().await;
    }
    answer
}

/// The document as it is now; a file that is not open is read from the disk, and is what it would be if it were open.
async fn present(server: &Backend, uri: Uri) -> Result<Snapshot> {
    let not_open = match job::snapshot(server.events(), uri.clone()).await {
        Ok(snapshot) => return Ok(snapshot),
        Err(error) => error,
    };
    let Some(path) = file_path(&uri) else { return Err(not_open) };
    let language = Arc::clone(server.language());
    let encoding = server.features().encoding;
    let circumstances = job::circumstances(server.events(), uri.clone()).await?;
    let read = move || {
        if !path.is_file() {
            return Err(not_open);
        }
        let file = ProgramFile::read(&path, language.as_ref()).map_err(Error::invalid_params)?;
        let Circumstances { settings, files, uris, workers } = circumstances;
        Ok(Snapshot {
            uri,
            revision: 0,
            version: 0,
            index: TextIndex { rope: Rope::from_str(&file.source.text), encoding },
            document: file.open(&path, language.as_ref(), &settings, files),
            settings,
            superseded: CancellationToken::new(),
            includers: Vec::new(),
            uris,
            workers,
        })
    };
    let read = tokio::task::spawn_blocking(read).await;
    read.unwrap_or_else(|_| Err(job::internal_fault("reading the file")))
}
