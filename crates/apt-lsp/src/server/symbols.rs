//! `workspace/symbol`: names of the open documents, of the files that they include, and of the programs of their
//! projects.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ropey::Rope;
use tower_lsp::ls_types::SymbolInformation;

use super::documents::Snapshot;
use crate::analysis::{Answer, Control, Files, Language, Refusal, normalised};
use crate::convert::{TextIndex, outgoing};
use crate::settings::Settings;
use crate::source::{self, ProgramFile};

/// Files that are not open and yet read for one answer.
const MOST_FILES: usize = 500;
/// A file larger than this (bytes) is not read: its own editor shows its outline.
const LARGEST_FILE: u64 = 4 << 20;

/// The symbols of an open document whose names contain what is wanted.
pub(super) fn of_document(
    snapshot: &Snapshot,
    wanted: &str,
    control: &Control,
) -> Answer<Vec<SymbolInformation>> {
    let outline = snapshot.document.outline(control)?;
    Ok(outgoing::symbols_named(&snapshot.index, &snapshot.uri, outline, wanted))
}

/// The symbols of the files that belong to the open documents and are not open themselves.
pub(super) fn of_closed_files(
    open: &[Snapshot],
    language: &dyn Language,
    wanted: &str,
    control: &Control,
) -> Result<Vec<SymbolInformation>, Refusal> {
    let mut found = Vec::new();
    for (path, settings) in closed_files(open, control)? {
        if control.is_cancelled() {
            return Err(Refusal::Interrupted);
        }
        let Some(snapshot) = open.first() else { break };
        let large = std::fs::metadata(&path).map_or(true, |one| one.len() > LARGEST_FILE);
        // What cannot be read is told where it is included.
        let (Some(uri), false, Ok(file)) =
            (snapshot.uris.of(&path), large, ProgramFile::read(&path, language))
        else {
            continue;
        };
        let document = file.open(&path, language, &settings, Files::default());
        let index = TextIndex { rope: Rope::from_str(&file.source.text), encoding: snapshot.index.encoding };
        found.extend(outgoing::symbols_named(&index, &uri, document.outline(control)?, wanted));
    }
    Ok(found)
}

/// The files that are included or lie in the projects, in order of their paths, with the settings of the program that
/// leads to them.
fn closed_files(open: &[Snapshot], control: &Control) -> Result<BTreeMap<PathBuf, Arc<Settings>>, Refusal> {
    let mut files = BTreeMap::new();
    let mut projects: BTreeMap<PathBuf, Arc<Settings>> = BTreeMap::new();
    for snapshot in open {
        if snapshot.document.has_inclusions() {
            let included = snapshot.document.included_paths().into_iter();
            files.extend(included.map(|path| (path, Arc::clone(&snapshot.settings))));
        }
        if let Some(folder) = snapshot.settings.project_file.as_deref().and_then(Path::parent) {
            projects.insert(folder.to_owned(), Arc::clone(&snapshot.settings));
        }
    }
    for (folder, settings) in projects {
        let mut walk = ignore::WalkBuilder::new(folder);
        walk.require_git(false).sort_by_file_path(Path::cmp);
        for entry in walk.build().flatten() {
            if control.is_cancelled() {
                return Err(Refusal::Interrupted);
            }
            if files.len() >= MOST_FILES {
                break;
            }
            let is_file = entry.file_type().is_some_and(|kind| kind.is_file());
            if is_file && source::is_program(entry.path()) {
                files.entry(normalised(entry.path())).or_insert_with(|| Arc::clone(&settings));
            }
        }
    }
    for snapshot in open {
        if let Some(path) = snapshot.path() {
            files.remove(&path);
        }
    }
    Ok(files)
}
