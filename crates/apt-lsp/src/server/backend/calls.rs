//! Call hierarchy: who calls whom in a program and the files that it includes.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use serde_json::json;
use tower_lsp::jsonrpc::{Error, Result};
use tower_lsp::ls_types::{self as lsp, Uri};

use super::Backend;
use crate::analysis::{Calls, Interrupted, Routine, Spot};
use crate::convert::Places;
use crate::server::documents::Snapshot;
use crate::server::job;

/// What an item says of itself when the client asks on from it.
#[derive(Serialize, Deserialize)]
struct Key {
    /// The program, which may be another file than the one of the item.
    program: Uri,
    /// The macro; none for the statements outside of all macros.
    name: Option<String>,
    /// The included file; none for the program itself.
    file: Option<PathBuf>,
}

impl Key {
    fn of(asked: lsp::CallHierarchyItem) -> Result<Self> {
        let data = asked.data.ok_or_else(|| Error::invalid_params("an item of another server"))?;
        serde_json::from_value(data).map_err(|error| Error::invalid_params(error.to_string()))
    }
}

impl Backend {
    /// The macro at a place, or the program at its PARTNO.
    pub(super) async fn routine_at(
        &self,
        place: lsp::TextDocumentPositionParams,
    ) -> Result<Option<Vec<lsp::CallHierarchyItem>>> {
        self.ask_at("call hierarchy", place, |snapshot, offset, control| {
            let file = snapshot.included_path();
            let found =
                snapshot.program().document.routine(Spot { file: file.as_deref(), offset }, control)?;
            Ok(found.and_then(|found| Some(vec![item(snapshot, &mut snapshot.places(), found)?])))
        })
        .await
    }

    /// Who calls a macro; nobody calls a program or an included file.
    pub(super) async fn callers_of(
        &self,
        asked: lsp::CallHierarchyItem,
    ) -> Result<Option<Vec<lsp::CallHierarchyIncomingCall>>> {
        let key = Key::of(asked)?;
        let snapshot = job::snapshot(&self.events, key.program).await?;
        let callers = job::on_snapshot("call hierarchy", snapshot, move |snapshot, control| {
            let found =
                key.name.map(|name| snapshot.program().document.callers(&name, control)).transpose()?;
            let mut places = snapshot.places();
            let mut calls = Vec::new();
            for one in found.unwrap_or_default() {
                let from_ranges = ranges(&mut places, &one);
                if let Some(from) = item(snapshot, &mut places, one.routine) {
                    calls.push(lsp::CallHierarchyIncomingCall { from, from_ranges });
                }
            }
            Ok::<_, Interrupted>(calls)
        });
        callers.await.map(Some)
    }

    /// Whom a macro or a program calls.
    pub(super) async fn callees_of(
        &self,
        asked: lsp::CallHierarchyItem,
    ) -> Result<Option<Vec<lsp::CallHierarchyOutgoingCall>>> {
        let key = Key::of(asked)?;
        let snapshot = job::snapshot(&self.events, key.program).await?;
        let callees = job::on_snapshot("call hierarchy", snapshot, move |snapshot, control| {
            let (name, file) = (key.name.as_deref(), key.file.as_deref());
            let found = snapshot.program().document.callees(name, file, control)?;
            let mut places = snapshot.places();
            let mut calls = Vec::new();
            for one in found {
                let from_ranges = ranges(&mut places, &one);
                if let Some(to) = item(snapshot, &mut places, one.routine) {
                    calls.push(lsp::CallHierarchyOutgoingCall { to, from_ranges });
                }
            }
            Ok::<_, Interrupted>(calls)
        });
        callees.await.map(Some)
    }
}

/// A routine as an item; nothing for one in a file that has no URI.
fn item(snapshot: &Snapshot, places: &mut Places<'_>, routine: Routine) -> Option<lsp::CallHierarchyItem> {
    let Routine { name, source, detail, range, selection } = routine;
    let at = places.location(source.as_ref(), &range)?;
    let selection_range = places.location(source.as_ref(), &selection)?.range;
    let file = source.map(|source| source.path.clone());
    let kind = if name.is_some() { lsp::SymbolKind::FUNCTION } else { lsp::SymbolKind::MODULE };
    let path = file.clone().or_else(|| snapshot.program().path());
    let file_name =
        || path.as_deref().and_then(|path| path.file_name()).map(|name| name.to_string_lossy().into_owned());
    let title = name.as_ref().map(ToString::to_string).or_else(file_name).unwrap_or_else(|| detail.clone());
    let key = Key { program: snapshot.program().uri.clone(), name: name.map(Into::into), file };
    Some(lsp::CallHierarchyItem {
        name: title,
        kind,
        tags: None,
        detail: Some(detail),
        uri: at.uri,
        range: at.range,
        selection_range,
        data: Some(json!(key)),
    })
}

/// The places of CALLs in the file in which they stand.
fn ranges(places: &mut Places<'_>, calls: &Calls) -> Vec<lsp::Range> {
    let place = |range| Some(places.location(calls.source.as_ref(), range)?.range);
    calls.places.iter().filter_map(place).collect()
}
