//! Blocks: some hundred statements with their text.

use std::any::Any;
use std::sync::{Arc, OnceLock};

use super::length_of;
use crate::dialect::SequenceFieldRule;
use crate::grammar::{ParsedStatement, parse_statement};
use crate::record::{LINES_BETWEEN_QUESTIONS, Layout, SequenceEvidence, boundaries_until};

/// How many statements a new block has. An edit copies the text of its block, some kilobytes.
const STATEMENTS_PER_BLOCK: usize = 128;

/// A parsed statement that is made when it is first asked.
type Kept = OnceLock<Arc<ParsedStatement>>;

/// A run of whole statements.
#[derive(Debug)]
pub(super) struct Block {
    text: Box<str>,
    /// Where the statements begin in the text.
    starts: Box<[u32]>,
    /// What the lines say about sequence fields.
    evidence: SequenceEvidence,
    kept: OnceLock<Box<[Kept]>>,
    /// What somebody else has found out about its statements.
    derived: OnceLock<Arc<dyn Any + Send + Sync>>,
}

/// Divides a text that begins at a statement into blocks.
pub(super) fn split(text: &str, layout: &Layout, is_given_up: &dyn Fn() -> bool) -> Vec<Arc<Block>> {
    let starts = boundaries_until(text, layout, is_given_up).starts;
    blocks_until(text, &starts, layout, is_given_up)
}

/// Blocks of a text whose statements are known.
pub(super) fn blocks_of(text: &str, starts: &[u32], layout: &Layout) -> Vec<Arc<Block>> {
    blocks_until(text, starts, layout, &|| false)
}

/// The same up to the end, or to where `is_given_up`, which is asked once in so many statements, says so.
fn blocks_until(
    text: &str,
    starts: &[u32],
    layout: &Layout,
    is_given_up: &dyn Fn() -> bool,
) -> Vec<Arc<Block>> {
    let mut blocks = Vec::with_capacity(starts.len().div_ceil(STATEMENTS_PER_BLOCK));
    for (number, chunk) in starts.chunks(STATEMENTS_PER_BLOCK).enumerate() {
        let from = chunk.first().copied().unwrap_or(0);
        let to = starts.get((number + 1) * STATEMENTS_PER_BLOCK).map_or(text.len(), |next| *next as usize);
        let text = clamped(text, from as usize, to);
        let starts = chunk.iter().map(|start| start - from).collect();
        let evidence = match layout.dialect.sequence_field {
            SequenceFieldRule::WhenPresent => SequenceEvidence::of(text),
            SequenceFieldRule::Always | SequenceFieldRule::Never => SequenceEvidence::default(),
        };
        blocks.push(Arc::new(Block {
            text: text.into(),
            starts,
            evidence,
            kept: OnceLock::new(),
            derived: OnceLock::new(),
        }));
        if blocks.len().is_multiple_of(LINES_BETWEEN_QUESTIONS / STATEMENTS_PER_BLOCK) && is_given_up() {
            break;
        }
    }
    blocks
}

impl Block {
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    pub(super) fn text_length(&self) -> u32 {
        length_of(&self.text)
    }

    pub(super) fn starts(&self) -> &[u32] {
        &self.starts
    }

    pub(super) fn statement_count(&self) -> u32 {
        u32::try_from(self.starts.len()).unwrap_or(u32::MAX)
    }

    pub(super) fn evidence(&self) -> SequenceEvidence {
        self.evidence
    }

    /// Where a statement begins; for the one after the last the end of the text.
    pub(super) fn start(&self, local: usize) -> u32 {
        self.starts.get(local).copied().unwrap_or_else(|| self.text_length())
    }

    /// The text of a statement.
    pub(super) fn statement_text(&self, local: usize) -> &str {
        clamped(&self.text, self.start(local) as usize, self.start(local + 1) as usize)
    }

    /// The statement in which an offset lies, or the last one.
    pub(super) fn statement_at(&self, offset: u32) -> usize {
        self.starts.partition_point(|start| *start <= offset).saturating_sub(1)
    }

    /// The parsed statement; kept if asked to.
    pub(super) fn parsed(&self, local: usize, layout: &Layout, keep: bool) -> Arc<ParsedStatement> {
        let parse = || Arc::new(parse_statement(self.statement_text(local), layout));
        if !keep {
            return self.already_parsed(local).unwrap_or_else(parse);
        }
        match self.kept().get(local) {
            Some(kept) => Arc::clone(kept.get_or_init(parse)),
            None => parse(),
        }
    }

    /// What was parsed before, if it was kept.
    pub(super) fn already_parsed(&self, local: usize) -> Option<Arc<ParsedStatement>> {
        self.kept.get()?.get(local)?.get().cloned()
    }

    /// Takes over what was parsed of the same statement in another block.
    pub(super) fn take_over(&self, local: usize, parsed: Arc<ParsedStatement>) {
        if let Some(kept) = self.kept().get(local) {
            // If it is there already, it is the same.
            let _ = kept.set(parsed);
        }
    }

    /// What `make` says about the statements, kept as long as the block lives. The first kind of data that is asked for
    /// is the one that is kept.
    pub(super) fn derived<T: Any + Send + Sync>(&self, make: impl FnOnce() -> T) -> Arc<T> {
        if let Some(kept) = self.derived.get() {
            return Arc::clone(kept).downcast::<T>().unwrap_or_else(|_| Arc::new(make()));
        }
        let made = Arc::new(make());
        // If somebody else was faster, theirs says the same.
        let _ = self.derived.set(Arc::clone(&made) as Arc<dyn Any + Send + Sync>);
        made
    }

    fn kept(&self) -> &[Kept] {
        self.kept.get_or_init(|| self.starts.iter().map(|_| Kept::new()).collect())
    }
}

/// The text between two offsets; both are cut to the text and moved to the start of their character.
pub(super) fn clamped(text: &str, from: usize, to: usize) -> &str {
    let from = text.floor_char_boundary(from);
    let to = text.floor_char_boundary(to).max(from);
    text.get(from..to).unwrap_or("")
}
