//! Answers about one immutable version of a part program: plain data for editors and the command line.
//!
//! Offsets are bytes from the start of the text. Nothing here knows a protocol, a line number or a JSON shape of its
//! own; the run report comes from `apt-run` as it is.

pub mod completion;
pub mod dialect;
pub mod expansion;
pub mod folding;
pub mod format;
pub mod hover;
pub mod lens;
pub mod lint;
pub mod navigation;
pub mod outline;
pub mod picture;
pub mod regions;
pub mod run;
pub mod search;
pub mod tape;
pub mod tokens;

use std::{
    ops::Range,
    sync::{Arc, OnceLock},
};

pub use apt_run::{
    Cancel, Cancelled,
    catalogue::explain,
    diagnostic::{Diagnostic, Severity},
    document::{Document, Level},
    settings::Settings,
};
use apt_syntax::{TextRange, TextSize, tree::StatementView};

/// One version of a part program with what has been found out about it; cheap to clone.
#[derive(Debug, Clone)]
pub struct Analysis {
    document: Arc<Document>,
    regions: Arc<OnceLock<Vec<regions::Region>>>,
}

impl Analysis {
    /// Parses a text; everything else is computed when asked for.
    pub fn new(text: &str, file: Option<String>, settings: &Arc<Settings>) -> Self {
        Self::of(Document::new(text, file, settings))
    }

    fn of(document: Document) -> Self {
        Self { document: Arc::new(document), regions: Arc::default() }
    }

    /// The next version: `range` (bytes) replaced by `insert`. Only the touched statements are parsed again.
    pub fn edit(&self, range: Range<usize>, insert: &str) -> Self {
        Self::of(self.document.edit(range, insert))
    }

    /// The program under analysis.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The whole text.
    pub fn text(&self) -> String {
        self.document.tree().text()
    }

    /// Macro bodies and loops.
    pub fn regions(&self) -> &[regions::Region] {
        self.regions.get_or_init(|| regions::find(self.document.tree()))
    }

    /// The syntax tree as text.
    pub fn syntax_tree(&self) -> String {
        self.document.tree().debug_tree()
    }

    /// The statement at an offset and the offset relative to its start; `None` in an empty text.
    pub(crate) fn statement_at(&self, offset: usize) -> Option<(StatementView, TextSize)> {
        let tree = self.document.tree();
        if tree.statement_count() == 0 {
            return None;
        }
        let offset = TextSize::new(offset.min(usize::from(tree.len())) as u32);
        let view = tree.statement(tree.statement_at(offset));
        let relative = offset.checked_sub(view.range().start())?;
        Some((view, relative))
    }
}

/// The absolute bytes of a range relative to a statement.
pub(crate) fn absolute(view: &StatementView, range: TextRange) -> Range<usize> {
    let start = usize::from(view.range().start());
    start + usize::from(range.start())..start + usize::from(range.end())
}
