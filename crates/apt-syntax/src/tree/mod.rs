//! The document: text in blocks of statements, parsed when asked, edited in place.
//!
//! A document is a list of blocks of some hundred statements, each with its own text and statement boundaries. An edit
//! replaces the blocks that it touches and shares the others; within a touched block the statements that did not
//! change keep what was parsed. A [`SyntaxTree`] is a snapshot: cheap to clone, immutable, free to cross threads.

mod block;
mod edit;
mod green;
mod view;

use std::cell::Cell;
use std::fmt::{self, Write};
use std::sync::Arc;

use rowan::{TextRange, TextSize};

pub use edit::StatementChange;
pub use view::{BlockView, StatementView, TokenView, tokens, tokens_of};

use crate::dialect::{Dialect, SequenceFieldRule};
use crate::kind::SyntaxNode;
use crate::record::{Layout, SequenceEvidence};
use crate::{text_range, text_size};
use block::Block;

/// Above this many statements parsed statements are not kept: a CL file of a million lines is read once from its
/// start to its end, and what was parsed would take twenty times the memory of the text.
const MOST_KEPT_STATEMENTS: usize = 50_000;

/// A document.
#[derive(Debug, Clone)]
pub struct SyntaxTree {
    document: Arc<Document>,
}

#[derive(Debug)]
struct Document {
    layout: Layout,
    blocks: Vec<Arc<Block>>,
    /// Where every block begins, and after them where the last one ends.
    starts: Vec<BlockStart>,
}

/// Text offset and statement index of a block.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct BlockStart {
    text: u32,
    statement: u32,
}

impl SyntaxTree {
    /// Parses a document: finds its statements; what they say is found out when it is asked.
    pub fn parse(text: &str, dialect: Dialect) -> SyntaxTree {
        Self::read(text, dialect, &|| false)
    }

    /// The same; `None` when `cancel`, which is asked once in so many statements, said so before the end.
    pub fn parse_until(text: &str, dialect: Dialect, cancel: &dyn Fn() -> bool) -> Option<SyntaxTree> {
        let has_given_up = Cell::new(false);
        let ask = || {
            has_given_up.set(has_given_up.get() || cancel());
            has_given_up.get()
        };
        let tree = Self::read(text, dialect, &ask);
        (!has_given_up.get()).then_some(tree)
    }

    /// The document up to the end, or a part of it if it is given up.
    fn read(text: &str, dialect: Dialect, is_given_up: &dyn Fn() -> bool) -> SyntaxTree {
        // Only this dialect rule needs a look at the whole text before statements can be found.
        let evidence = match dialect.sequence_field {
            SequenceFieldRule::WhenPresent => SequenceEvidence::until(text, is_given_up),
            SequenceFieldRule::Always | SequenceFieldRule::Never => SequenceEvidence::default(),
        };
        let layout = Layout { dialect, sequence_field: evidence.decides(dialect.sequence_field) };
        SyntaxTree::from_blocks(layout, block::split(text, &layout, is_given_up))
    }

    fn from_blocks(layout: Layout, blocks: Vec<Arc<Block>>) -> SyntaxTree {
        let mut starts = Vec::with_capacity(blocks.len() + 1);
        let mut start = BlockStart::default();
        starts.push(start);
        for block in &blocks {
            start.text = start.text.saturating_add(block.text_length());
            start.statement = start.statement.saturating_add(block.statement_count());
            starts.push(start);
        }
        SyntaxTree { document: Arc::new(Document { layout, blocks, starts }) }
    }

    /// The dialect in which the document is read.
    pub fn dialect(&self) -> Dialect {
        self.document.layout.dialect
    }

    /// The dialect and whether columns 73 and later are a sequence field.
    pub fn layout(&self) -> Layout {
        self.document.layout
    }

    /// Whether columns 73 and later are a sequence field.
    pub fn sequence_field(&self) -> bool {
        self.document.layout.sequence_field
    }

    /// The length of the text.
    pub fn len(&self) -> TextSize {
        TextSize::new(self.end().text)
    }

    /// Whether there is no text at all.
    pub fn is_empty(&self) -> bool {
        self.end().text == 0
    }

    /// The whole text.
    pub fn text(&self) -> String {
        let mut text = String::with_capacity(self.end().text as usize);
        for block in &self.document.blocks {
            text.push_str(block.text());
        }
        text
    }

    /// The text of a range, cut to the document; bounds inside a character move to its start.
    pub fn slice(&self, range: TextRange) -> String {
        let first = self.block_at(u32::from(range.start()));
        let mut text = String::new();
        for (block, start) in self.document.blocks.iter().zip(&self.document.starts).skip(first) {
            if start.text >= u32::from(range.end()) {
                break;
            }
            let from = u32::from(range.start()).saturating_sub(start.text) as usize;
            let to = u32::from(range.end()).saturating_sub(start.text) as usize;
            text.push_str(block::clamped(block.text(), from, to));
        }
        text
    }

    /// How many statements there are: every record that does not continue another one, blank lines and comments too.
    pub fn statement_count(&self) -> usize {
        self.end().statement as usize
    }

    /// A statement. Beyond the last one stands an empty statement at the end of the text.
    pub fn statement(&self, index: usize) -> StatementView {
        let index = index.min(self.statement_count());
        let statement = u32::try_from(index).unwrap_or(u32::MAX);
        let starts = &self.document.starts;
        let block = starts.partition_point(|start| start.statement <= statement).saturating_sub(1);
        let start = starts.get(block).copied().unwrap_or_default();
        let local = statement.saturating_sub(start.statement) as usize;
        let within = self.document.blocks.get(block).map_or(0, |block| block.start(local));
        StatementView {
            index,
            start: TextSize::new(start.text.saturating_add(within)),
            document: Arc::clone(&self.document),
            block,
            local,
        }
    }

    /// All statements in order.
    pub fn statements(&self) -> impl Iterator<Item = StatementView> + '_ {
        (0..self.statement_count()).map(|index| self.statement(index))
    }

    /// The runs of statements that versions of the document share, in order.
    pub fn blocks(&self) -> impl Iterator<Item = BlockView<'_>> {
        let places = self.document.blocks.iter().zip(&self.document.starts);
        places.map(|(block, start)| BlockView { tree: self, block, first: start.statement as usize })
    }

    /// The index of the statement in which an offset lies; at and beyond the end of the text the last one.
    pub fn statement_at(&self, offset: TextSize) -> usize {
        let block = self.block_at(u32::from(offset));
        let start = self.document.starts.get(block).copied().unwrap_or_default();
        let local = u32::from(offset).saturating_sub(start.text);
        let within = self.document.blocks.get(block).map_or(0, |block| block.statement_at(local));
        start.statement as usize + within
    }

    /// Replaces a range by a text. Only the statements that the edit touches are looked at again.
    ///
    /// Bounds beyond the text are cut to it.
    pub fn edit(&self, range: TextRange, insert: &str) -> (SyntaxTree, StatementChange) {
        edit::edit(self, range, insert)
    }

    /// The lossless tree of the whole document. It is made anew at every call.
    pub fn syntax(&self) -> SyntaxNode {
        green::document(self, &|| false)
    }

    /// The tree as indented text, one node or token on a line.
    pub fn debug_tree(&self) -> String {
        self.debug_tree_until(&|| false).unwrap_or_default()
    }

    /// The same; `None` when `cancel`, which is asked for each statement and each word, said so before the end, and goes on
    /// saying so.
    pub fn debug_tree_until(&self, cancel: &dyn Fn() -> bool) -> Option<String> {
        let mut page = Page { text: String::new(), cancel };
        write!(page, "{:#?}", green::document(self, cancel)).ok()?;
        (!cancel()).then_some(page.text)
    }

    fn end(&self) -> BlockStart {
        self.document.starts.last().copied().unwrap_or_default()
    }

    /// The block in which an offset lies, or the last one.
    fn block_at(&self, offset: u32) -> usize {
        let found = self.document.starts.partition_point(|start| start.text <= offset).saturating_sub(1);
        found.min(self.document.blocks.len().saturating_sub(1))
    }
}

impl Document {
    fn keeps_parsed(&self) -> bool {
        let count = self.starts.last().map_or(0, |end| end.statement as usize);
        count <= MOST_KEPT_STATEMENTS
    }
}

/// Text that is written until whoever waits for it gives up.
struct Page<'a> {
    text: String,
    cancel: &'a dyn Fn() -> bool,
}

impl Write for Page<'_> {
    fn write_str(&mut self, piece: &str) -> fmt::Result {
        if (self.cancel)() {
            return Err(fmt::Error);
        }
        self.text.push_str(piece);
        Ok(())
    }
}

/// The range of a text that starts at an offset.
fn range_at(start: TextSize, text: &str) -> TextRange {
    let start = u32::from(start) as usize;
    text_range(start, start + text.len())
}

/// The length of a text for positions in blocks.
fn length_of(text: &str) -> u32 {
    u32::from(text_size(text.len()))
}
