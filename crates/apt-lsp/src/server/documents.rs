//! The owner of the documents: one thread, one queue, events in the order of their arrival.

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ropey::Rope;
use tokio::sync::{mpsc, oneshot};
use tokio_util::sync::CancellationToken;
use tower_lsp::ls_types::{self as lsp, TextDocumentContentChangeEvent, Uri};

use super::diagnostics::{self, Touched};
use super::outbox::{Notice, Outbox};
use super::workers::Workers;
use crate::analysis::{Document, Files, Language, Surroundings, TextEdit, normalised};
use crate::convert::{Encoding, Opened, Places, TextIndex, Uris, changes};
use crate::settings::{Settings, Values};

/// Something that happens to the documents, or a question about them.
pub(super) enum Event {
    /// The client has introduced itself.
    Introduced {
        /// How positions count.
        encoding: Encoding,
        /// True if findings are pushed.
        push: bool,
        /// True if the client can be told to pull again.
        refresh: bool,
        /// True if the client can watch files.
        watches: bool,
    },
    /// The settings of the editor are these.
    Settings(Values),
    /// Project files may have changed.
    ProjectChanged,
    /// Other files have changed on the disk.
    FilesChanged(Vec<PathBuf>),
    /// A document was opened.
    Opened {
        /// Which.
        uri: Uri,
        /// Its first version.
        version: i32,
        /// Its text.
        text: String,
    },
    /// A document was changed.
    Changed {
        /// Which.
        uri: Uri,
        /// The version after the changes.
        version: i32,
        /// The changes, each relative to the text that the one before it left.
        changes: Vec<TextDocumentContentChangeEvent>,
    },
    /// A document was closed.
    Closed(Uri),
    /// Somebody wants to see a document as it is now; none if it is not open.
    Snapshot(Uri, oneshot::Sender<Option<Snapshot>>),
    /// Somebody wants to read a file that is not open.
    Circumstances(Uri, oneshot::Sender<Circumstances>),
    /// Somebody wants to see all open documents as they are now.
    Snapshots(oneshot::Sender<Vec<Snapshot>>),
    /// Findings are ready; they are told if they are still about the present text.
    Found {
        /// The document.
        uri: Uri,
        /// The revision in which they were found.
        revision: u64,
        /// The message that tells them.
        message: Vec<u8>,
    },
}

/// What counts for a file that is not open, as it would if it were.
pub(super) struct Circumstances {
    /// The settings in force.
    pub settings: Arc<Settings>,
    /// The texts of open documents, which it may include.
    pub files: Files,
    /// What the client calls the files that it has opened.
    pub uris: Uris,
    /// Who does work on it.
    pub workers: Workers,
}

/// A document as it was at one moment.
#[derive(Clone)]
pub(super) struct Snapshot {
    /// Which document.
    pub uri: Uri,
    /// A number that no other state of any document in this conversation has.
    pub revision: u64,
    /// The version that the client gave its text.
    pub version: i32,
    /// Positions in its text.
    pub index: TextIndex,
    /// The analysis of its text.
    pub document: Arc<dyn Document>,
    /// The settings in force.
    pub settings: Arc<Settings>,
    /// Cancelled when the document changes, or a file that it includes, or a program that includes it.
    pub superseded: CancellationToken,
    /// The programs that include this file, as they were at that moment.
    pub includers: Vec<Snapshot>,
    /// What the client calls the files that it has opened.
    pub uris: Uris,
    /// Who does work on it.
    pub workers: Workers,
}

impl Snapshot {
    /// The program that the document belongs to: one that includes it, or itself.
    pub(super) fn program(&self) -> &Snapshot {
        self.includers.first().unwrap_or(self)
    }

    /// The path of the document, if it is a file.
    pub(super) fn path(&self) -> Option<PathBuf> {
        file_path(&self.uri).map(|path| normalised(&path))
    }

    /// The path of the document, if it is an included file.
    pub(super) fn included_path(&self) -> Option<PathBuf> {
        self.includers.first().and_then(|_| file_path(&self.uri)).map(|path| normalised(&path))
    }

    /// The version of the text of a file of the program, if the client has opened it.
    pub(super) fn version_of(&self, uri: &Uri) -> Option<i32> {
        let program = self.program();
        if *uri == program.uri { Some(program.version) } else { self.uris.version(uri) }
    }

    /// Locations in the files of the program that the document belongs to.
    pub(super) fn places(&self) -> Places<'_> {
        let program = self.program();
        Places::new(&program.uri, &program.index, &self.uris)
    }
}

/// Starts the owner; it ends when the last sender of events is gone.
pub(super) fn start(
    language: Arc<dyn Language>,
    events: mpsc::UnboundedReceiver<Event>,
    touched: mpsc::UnboundedSender<Touched>,
    outbox: Outbox,
) -> std::io::Result<()> {
    let documents = Documents {
        language,
        open: BTreeMap::new(),
        editor: Values::new(),
        encoding: Encoding::default(),
        push: false,
        refresh: false,
        watches: false,
        watched: BTreeSet::new(),
        files: Files::default(),
        revisions: 0,
        told: BTreeSet::new(),
        touched,
        outbox,
        workers: Workers::default(),
    };
    std::thread::Builder::new().name("documents".to_owned()).spawn(move || documents.run(events)).map(drop)
}

struct Documents {
    language: Arc<dyn Language>,
    open: BTreeMap<Uri, OpenDocument>,
    editor: Values,
    encoding: Encoding,
    push: bool,
    refresh: bool,
    watches: bool,
    /// The names of the included files that the client watches.
    watched: BTreeSet<String>,
    /// The texts of open documents, for programs that include them.
    files: Files,
    revisions: u64,
    /// Problems with settings that the user has been told; once is enough until something changes.
    told: BTreeSet<String>,
    touched: mpsc::UnboundedSender<Touched>,
    outbox: Outbox,
    workers: Workers,
}

struct OpenDocument {
    path: Option<PathBuf>,
    version: i32,
    revision: u64,
    index: TextIndex,
    settings: Arc<Settings>,
    /// The analysis of the text before `edits`; none before anybody asked and after a fault.
    analysed: Option<Arc<dyn Document>>,
    /// Edits that the analysis has not seen. A burst of them costs one analysis.
    edits: Vec<TextEdit>,
    superseded: CancellationToken,
    /// The files that it was last known to include.
    included: Vec<PathBuf>,
    /// The revision whose included files are watched.
    noted: u64,
}

impl Documents {
    fn run(mut self, mut events: mpsc::UnboundedReceiver<Event>) {
        while let Some(event) = events.blocking_recv() {
            if catch_unwind(AssertUnwindSafe(|| self.apply(event))).is_err() {
                self.outbox.tell(Notice::Log(
                    lsp::MessageType::ERROR,
                    "internal fault while a document was read; it is read afresh".to_owned(),
                ));
                for document in self.open.values_mut() {
                    document.forget_analysis();
                }
            }
        }
    }

    fn apply(&mut self, event: Event) {
        match event {
            Event::Introduced { encoding, push, refresh, watches } => {
                (self.encoding, self.push, self.refresh) = (encoding, push, refresh);
                self.watches = watches;
            }
            Event::Settings(settings) => {
                self.editor = settings;
                self.read_settings_again();
            }
            Event::ProjectChanged => {
                self.read_settings_again();
                self.reset_includers(None);
            }
            Event::FilesChanged(paths) => self.files_changed(&paths),
            Event::Opened { uri, version, text } => self.open(&uri, version, &text),
            Event::Changed { uri, version, changes } => self.change(&uri, version, changes),
            Event::Closed(uri) => self.close(&uri),
            Event::Snapshot(uri, reply) => {
                let snapshot = self.snapshot(&uri);
                let _ = reply.send(snapshot);
            }
            Event::Circumstances(uri, reply) => {
                let _ = reply.send(Circumstances {
                    settings: Arc::new(self.settings_for(&uri)),
                    files: self.files.clone(),
                    uris: self.uris(),
                    workers: self.workers.clone(),
                });
            }
            Event::Snapshots(reply) => {
                let uris: Vec<Uri> = self.open.keys().cloned().collect();
                let all = uris.iter().filter_map(|uri| self.plain_snapshot(uri)).collect();
                let _ = reply.send(all);
            }
            Event::Found { uri, revision, message } => self.tell(&uri, revision, message),
        }
    }

    fn next_revision(&mut self) -> u64 {
        self.revisions += 1;
        self.revisions
    }

    fn open(&mut self, uri: &Uri, version: i32, text: &str) {
        let settings = Arc::new(self.settings_for(uri));
        let path = file_path(uri).map(|path| normalised(&path));
        let document = OpenDocument {
            path,
            version,
            revision: self.next_revision(),
            index: TextIndex { rope: Rope::from_str(text), encoding: self.encoding },
            settings,
            analysed: None,
            edits: Vec::new(),
            superseded: CancellationToken::new(),
            included: Vec::new(),
            noted: 0,
        };
        if let Some(old) = self.open.insert(uri.clone(), document) {
            old.superseded.cancel();
        }
        self.touch(uri.clone());
        self.text_changed(uri, true);
    }

    /// The text of a document is another one now: programs that include it are evaluated again, and the files that it
    /// includes are judged again. `all`: programs that could not find the file before may find it now.
    fn text_changed(&mut self, uri: &Uri, all: bool) {
        let Some(document) = self.open.get(uri) else { return };
        if let Some(path) = document.path.clone() {
            let rope = document.index.rope.clone();
            self.files.open(&path, Arc::new(move || rope.to_string()));
            if self.open.len() > 1 {
                self.reset_includers(Some((Some(uri), &path, all)));
            }
        }
        if self.open.len() > 1 {
            self.judge_included(uri);
        }
    }

    /// Lets programs that include a file, or any file at all, forget what depends on it.
    fn reset_includers(&mut self, changed: Option<(Option<&Uri>, &Path, bool)>) {
        let other = |uri: &&Uri| changed.is_none_or(|(own, ..)| own != Some(*uri));
        let others: Vec<Uri> = self.open.keys().filter(other).cloned().collect();
        for uri in others {
            let included = self.included(&uri);
            let Some(document) = self.open.get(&uri) else { continue };
            let Some(analysed) = document.analysed.clone() else { continue };
            let concerned = match changed {
                Some((_, path, false)) => included.iter().any(|one| one == path),
                _ => analysed.has_inclusions(),
            };
            if concerned {
                let analysed = analysed.with_changed_files();
                self.supersede(&uri, |document| document.analysed = Some(analysed));
            }
        }
    }

    /// Files have changed on the disk: programs that include one are evaluated again, unless it is open. A file that
    /// nobody includes yet, or that is gone, may be one that was missing, or hide another one no more.
    fn files_changed(&mut self, paths: &[PathBuf]) {
        for path in paths.iter().map(|path| normalised(path)) {
            if self.open.values().any(|document| document.path.as_ref() == Some(&path)) {
                continue;
            }
            let known = self.open.values().any(|document| document.included.contains(&path));
            self.reset_includers(Some((None, &path, !known || !path.exists())));
        }
        if self.refresh && !self.push {
            self.outbox.tell(Notice::Refresh);
        }
    }

    /// Has the client watch the files that the open programs include, by their names: they may lie in any folder.
    fn watch(&mut self) {
        let paths = self.open.values().flat_map(|document| &document.included);
        let names = paths.filter_map(|path| path.file_name()?.to_str().map(str::to_owned));
        let names: BTreeSet<String> = names.collect();
        if names != self.watched {
            let again = !self.watched.is_empty();
            self.watched.clone_from(&names);
            self.outbox.tell(Notice::Watch { names: names.into_iter().collect(), again });
        }
    }

    /// Finds out which files a document includes, once for each of its revisions, and has them watched.
    fn note_included(&mut self, uri: &Uri) {
        let Some(document) = self.open.get(uri) else { return };
        let revision = document.revision;
        if document.noted != revision {
            self.included(uri);
            if let Some(document) = self.open.get_mut(uri) {
                document.noted = revision;
            }
            self.watch();
        }
    }

    /// Judges the open files again that a document includes or included.
    fn judge_included(&mut self, uri: &Uri) {
        let mut paths = self.open.get(uri).map(|document| document.included.clone()).unwrap_or_default();
        paths.extend(self.included(uri));
        let included =
            |document: &OpenDocument| document.path.as_ref().is_some_and(|path| paths.contains(path));
        let others = self.open.iter().filter(|(other, document)| *other != uri && included(document));
        let others: Vec<Uri> = others.map(|(other, _)| other.clone()).collect();
        for other in others {
            self.supersede(&other, |_| {});
        }
    }

    /// The files that a document includes.
    fn included(&mut self, uri: &Uri) -> Vec<PathBuf> {
        let Some(document) = self.open.get_mut(uri) else { return Vec::new() };
        let analysed = document.analysis(self.language.as_ref(), uri, &self.files);
        document.included = if analysed.has_inclusions() { analysed.included_paths() } else { Vec::new() };
        document.included.clone()
    }

    /// Gives a document a new revision, so that what is under way for it counts no more.
    fn supersede(&mut self, uri: &Uri, change: impl FnOnce(&mut OpenDocument)) {
        let revision = self.next_revision();
        let Some(document) = self.open.get_mut(uri) else { return };
        change(document);
        document.revision = revision;
        document.superseded.cancel();
        document.superseded = CancellationToken::new();
        self.touch(uri.clone());
    }

    fn change(&mut self, uri: &Uri, version: i32, changes: Vec<TextDocumentContentChangeEvent>) {
        let revision = self.next_revision();
        let Some(document) = self.open.get_mut(uri) else {
            self.outbox.warn(format!("change of {}, which is not open; ignored", uri.as_str()));
            return;
        };
        // Versions only have to increase; some editors count in larger steps, so a gap is no loss.
        if version <= document.version {
            self.outbox.warn(format!(
                "change of {} to version {version} after version {}; ignored",
                uri.as_str(),
                document.version
            ));
            return;
        }
        document.version = version;
        document.revision = revision;
        document.superseded.cancel();
        document.superseded = CancellationToken::new();
        for change in changes {
            let edit = changes::apply(&mut document.index, change);
            document.edits.push(edit);
        }
        self.touch(uri.clone());
        self.text_changed(uri, false);
    }

    fn close(&mut self, uri: &Uri) {
        let Some(document) = self.open.remove(uri) else { return };
        document.superseded.cancel();
        if let Some(path) = &document.path {
            self.files.close(path);
            self.reset_includers(Some((Some(uri), path, true)));
        }
        let freed =
            |other: &OpenDocument| other.path.as_ref().is_some_and(|path| document.included.contains(path));
        let freed: Vec<Uri> =
            self.open.iter().filter(|(_, other)| freed(other)).map(|(uri, _)| uri.clone()).collect();
        for uri in freed {
            self.supersede(&uri, |_| {});
        }
        if self.push {
            self.outbox.tell(Notice::Findings(diagnostics::none(uri)));
        }
    }

    fn snapshot(&mut self, uri: &Uri) -> Option<Snapshot> {
        let mut snapshot = self.plain_snapshot(uri)?;
        let path = self.open.get(uri)?.path.clone();
        if let Some(path) = path.filter(|_| self.open.len() > 1) {
            let others: Vec<Uri> = self.open.keys().filter(|other| *other != uri).cloned().collect();
            for other in others {
                if self.included(&other).contains(&path) {
                    snapshot.includers.extend(self.plain_snapshot(&other));
                }
            }
        }
        Some(snapshot)
    }

    /// What the client calls the files that it has opened.
    fn uris(&self) -> Uris {
        let uris = self.open.iter().filter_map(|(uri, one)| {
            Some((one.path.clone()?, Opened { uri: uri.clone(), version: one.version }))
        });
        Uris(Arc::new(uris.collect()))
    }

    /// A document without the programs that include it.
    fn plain_snapshot(&mut self, uri: &Uri) -> Option<Snapshot> {
        let uris = self.uris();
        if self.watches {
            self.note_included(uri);
        }
        let document = self.open.get_mut(uri)?;
        let analysed = document.analysis(self.language.as_ref(), uri, &self.files);
        Some(Snapshot {
            includers: Vec::new(),
            uris,
            uri: uri.clone(),
            revision: document.revision,
            version: document.version,
            index: document.index.clone(),
            document: analysed,
            settings: Arc::clone(&document.settings),
            superseded: document.superseded.clone(),
            workers: self.workers.clone(),
        })
    }

    fn tell(&self, uri: &Uri, revision: u64, message: Vec<u8>) {
        if self.open.get(uri).is_some_and(|document| document.revision == revision) {
            self.outbox.tell(Notice::Findings(message));
        }
    }

    fn touch(&self, uri: Uri) {
        if self.push {
            let _ = self.touched.send(Touched(uri));
        }
    }

    fn settings_for(&mut self, uri: &Uri) -> Settings {
        let (settings, problems) = Settings::resolve(
            self.language.as_ref(),
            file_path(uri).as_deref(),
            &self.editor,
            &Values::new(),
        );
        for problem in problems {
            let text = problem.to_string();
            if self.told.insert(text.clone()) {
                self.outbox.tell(Notice::Show(text));
            }
        }
        settings
    }

    fn read_settings_again(&mut self) {
        self.told.clear();
        let uris: Vec<Uri> = self.open.keys().cloned().collect();
        let mut changed = false;
        for uri in uris {
            let settings = self.settings_for(&uri);
            let revision = self.next_revision();
            let Some(document) = self.open.get_mut(&uri) else { continue };
            if *document.settings == settings {
                continue;
            }
            changed = true;
            document.settings = Arc::new(settings);
            document.revision = revision;
            document.forget_analysis();
            document.superseded.cancel();
            document.superseded = CancellationToken::new();
            self.touch(uri);
        }
        if changed && self.refresh && !self.push {
            self.outbox.tell(Notice::Refresh);
        }
    }
}

impl OpenDocument {
    fn analysis(&mut self, language: &dyn Language, uri: &Uri, files: &Files) -> Arc<dyn Document> {
        let edits = std::mem::take(&mut self.edits);
        // Taken out, so that a fault below leaves nothing half done behind.
        let analysed = match self.analysed.take() {
            Some(analysed) if edits.is_empty() => analysed,
            Some(analysed) => analysed.edit(&edits),
            None => {
                let path = file_path(uri);
                let name = path.as_ref().and_then(|path| path.file_name()).and_then(|name| name.to_str());
                let surroundings =
                    Surroundings { path: path.clone(), files: files.clone(), ..Surroundings::default() };
                language.open(&self.index.rope.to_string(), name, &self.settings.program, surroundings)
            }
        };
        self.analysed = Some(Arc::clone(&analysed));
        analysed
    }

    fn forget_analysis(&mut self) {
        self.analysed = None;
        self.edits.clear();
    }
}

/// The path of a document that is a file.
pub(super) fn file_path(uri: &Uri) -> Option<PathBuf> {
    if uri.scheme().as_str() != "file" {
        return None;
    }
    uri.to_file_path().map(std::borrow::Cow::into_owned)
}
