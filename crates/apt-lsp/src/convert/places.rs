//! Places in the files of a program, out.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ropey::Rope;
use tower_lsp::ls_types::{self as lsp, Uri};

use super::TextIndex;
use crate::analysis::SourceFile;

/// What the client calls the files that it has opened.
#[derive(Debug, Clone, Default)]
pub(crate) struct Uris(pub Arc<BTreeMap<PathBuf, Opened>>);

/// A file that the client has opened.
#[derive(Debug, Clone)]
pub(crate) struct Opened {
    /// As the client writes it.
    pub uri: Uri,
    /// The version of its text.
    pub version: i32,
}

impl Uris {
    /// The URI of a file: as the client wrote it, if it has opened the file.
    pub(crate) fn of(&self, path: &Path) -> Option<Uri> {
        self.0.get(path).map(|opened| opened.uri.clone()).or_else(|| Uri::from_file_path(path))
    }

    /// The version of the text that the client has of a file, if it has opened it.
    pub(crate) fn version(&self, uri: &Uri) -> Option<i32> {
        self.0.values().find(|opened| opened.uri == *uri).map(|opened| opened.version)
    }
}

/// Turns places in a program and in the files that it includes into locations; the text of each file is read once.
pub(crate) struct Places<'a> {
    uri: &'a Uri,
    index: &'a TextIndex,
    uris: &'a Uris,
    others: BTreeMap<PathBuf, Option<(Uri, TextIndex)>>,
}

impl<'a> Places<'a> {
    /// For a program with this URI and text.
    pub(crate) fn new(uri: &'a Uri, index: &'a TextIndex, uris: &'a Uris) -> Self {
        Self { uri, index, uris, others: BTreeMap::new() }
    }

    /// The location of bytes of an included file, or of the program for none. Nothing for a file that has no URI.
    pub(crate) fn location(
        &mut self,
        source: Option<&Arc<SourceFile>>,
        range: &Range<usize>,
    ) -> Option<lsp::Location> {
        let Some(source) = source else {
            return Some(lsp::Location { uri: self.uri.clone(), range: self.index.range(range) });
        };
        let read = || {
            let rope = Rope::from_str(&source.tree.text());
            Some((self.uris.of(&source.path)?, TextIndex { rope, encoding: self.index.encoding }))
        };
        let other = self.others.entry(source.path.clone()).or_insert_with(read);
        other.as_ref().map(|(uri, index)| lsp::Location { uri: uri.clone(), range: index.range(range) })
    }
}
