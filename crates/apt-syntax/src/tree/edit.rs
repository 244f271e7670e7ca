//! Edits.

use std::sync::Arc;

use rowan::TextRange;

use super::block::{self, Block};
use super::{Document, SyntaxTree};
use crate::record::{Layout, SequenceEvidence, statement_boundaries};

/// What an edit did to the list of statements: `removed` statements from `first` on are replaced by `inserted` ones.
/// All others are the same as before, those behind with a shifted index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StatementChange {
    /// The first statement that changed.
    pub first: usize,
    /// How many statements of the old document are gone.
    pub removed: usize,
    /// How many statements of the new document take their place: these, and no others, are lexed and parsed anew.
    pub inserted: usize,
    /// How many statements were looked at to find where statements end.
    pub scanned: usize,
}

/// A run of blocks with its text.
struct Region {
    first_block: usize,
    end_block: usize,
    text: String,
    starts: Vec<u32>,
}

pub(super) fn edit(tree: &SyntaxTree, range: TextRange, insert: &str) -> (SyntaxTree, StatementChange) {
    let document = &tree.document;
    let length = u32::from(tree.len());
    let (from, to) = (u32::from(range.start()).min(length), u32::from(range.end()).min(length));
    // A carriage return just before the edit may become part of another line end.
    let first_block = tree.block_at(from.saturating_sub(1));
    let last_block = tree.block_at(to);
    let origin = document.starts.get(first_block).copied().unwrap_or_default();

    let old = old_region(document, first_block, last_block + 1);
    let cut = |offset: u32| old.text.floor_char_boundary((offset - origin.text.min(offset)) as usize);
    let (cut_from, cut_to) = (cut(from), cut(to));
    let mut text = String::with_capacity(old.text.len() + insert.len());
    text.push_str(block::clamped(&old.text, 0, cut_from));
    text.push_str(insert);
    text.push_str(block::clamped(&old.text, cut_to, old.text.len()));

    let mut new = Region { first_block, end_block: old.end_block, text, starts: Vec::new() };
    let mut scanned = find_statements(document, &mut new);
    // Blocks that the last statement ran into belong to both sides.
    let old =
        if new.end_block > old.end_block { old_region(document, first_block, new.end_block) } else { old };

    let blocks = block::blocks_of(&new.text, &new.starts, &document.layout);
    let evidence = evidence_after(document, &new, &blocks);
    let rule = document.layout.dialect.sequence_field;
    if evidence.decides(rule) != document.layout.sequence_field {
        return reread(tree, &new);
    }
    let changed = difference(&old, &new, cut_from, cut_to, insert.len());
    take_over(document, &old, &blocks, &changed);
    scanned = scanned.max(changed.inserted);
    let all = spliced(document, &new, blocks);
    let change = StatementChange {
        first: origin.statement as usize + changed.prefix,
        removed: old.starts.len() - changed.prefix - changed.suffix,
        inserted: changed.inserted,
        scanned,
    };
    (SyntaxTree::from_blocks(document.layout, all), change)
}

/// The blocks of the old document in a run, joined.
fn old_region(document: &Document, first_block: usize, end_block: usize) -> Region {
    let end_block = end_block.min(document.blocks.len());
    let mut text = String::new();
    let mut starts = Vec::new();
    for block in document.blocks.get(first_block..end_block).unwrap_or_default() {
        let offset = super::length_of(&text);
        starts.extend(block.starts().iter().map(|start| start + offset));
        text.push_str(block.text());
    }
    Region { first_block, end_block, text, starts }
}

/// Finds the statements of the new text; while its last statement could go on, the next block is joined. Tells how
/// many statements were looked at.
fn find_statements(document: &Document, region: &mut Region) -> usize {
    let mut scanned = 0;
    loop {
        // Only what follows the last statement known to be complete is scanned again.
        let resume = region.starts.pop().unwrap_or(0);
        let tail = block::clamped(&region.text, resume as usize, region.text.len());
        let boundaries = statement_boundaries(tail, &document.layout);
        scanned += boundaries.starts.len();
        region.starts.extend(boundaries.starts.iter().map(|start| start + resume));
        let next = document.blocks.get(region.end_block).filter(|_| boundaries.open);
        let Some(next) = next else { return scanned };
        region.text.push_str(next.text());
        region.end_block += 1;
    }
}

/// What the lines of the whole new document say about sequence fields.
fn evidence_after(document: &Document, region: &Region, blocks: &[Arc<Block>]) -> SequenceEvidence {
    let before = document.blocks.get(..region.first_block).unwrap_or_default();
    let after = document.blocks.get(region.end_block..).unwrap_or_default();
    before
        .iter()
        .chain(blocks)
        .chain(after)
        .map(|block| block.evidence())
        .fold(SequenceEvidence::default(), SequenceEvidence::plus)
}

/// All blocks of the new document.
fn spliced(document: &Document, region: &Region, blocks: Vec<Arc<Block>>) -> Vec<Arc<Block>> {
    let mut all = Vec::with_capacity(document.blocks.len() + blocks.len());
    all.extend(document.blocks.iter().take(region.first_block).cloned());
    all.extend(blocks);
    all.extend(document.blocks.iter().skip(region.end_block).cloned());
    all
}

/// The edit gave the document sequence fields, or took them away: every statement may mean something else.
fn reread(tree: &SyntaxTree, region: &Region) -> (SyntaxTree, StatementChange) {
    let layout = Layout { sequence_field: !tree.document.layout.sequence_field, ..tree.document.layout };
    let mut text = String::new();
    let before = tree.document.blocks.get(..region.first_block).unwrap_or_default();
    let after = tree.document.blocks.get(region.end_block..).unwrap_or_default();
    before.iter().for_each(|block| text.push_str(block.text()));
    text.push_str(&region.text);
    after.iter().for_each(|block| text.push_str(block.text()));
    let new = SyntaxTree::from_blocks(layout, block::split(&text, &layout, &|| false));
    let count = new.statement_count();
    let change =
        StatementChange { first: 0, removed: tree.statement_count(), inserted: count, scanned: count };
    (new, change)
}

/// How many statements at the start and at the end of a region are the same as before.
struct Difference {
    prefix: usize,
    suffix: usize,
    inserted: usize,
}

fn difference(old: &Region, new: &Region, from: usize, to: usize, inserted_length: usize) -> Difference {
    let end_of = |region: &Region, index: usize| {
        region.starts.get(index + 1).map_or(region.text.len(), |start| *start as usize)
    };
    let mut prefix = 0;
    while prefix < old.starts.len().min(new.starts.len())
        && end_of(old, prefix) <= from
        && end_of(old, prefix) == end_of(new, prefix)
        // The last statement of a text may go on behind its end.
        && (prefix + 1 < old.starts.len() || inserted_length == 0 && from == to)
    {
        prefix += 1;
    }
    let mut suffix = 0;
    let most = (old.starts.len() - prefix).min(new.starts.len() - prefix);
    while suffix < most {
        let start_of = |region: &Region| {
            region.starts.get(region.starts.len() - 1 - suffix).copied().unwrap_or(0) as usize
        };
        let (old_start, new_start) = (start_of(old), start_of(new));
        if old_start < to || old_start + inserted_length != new_start + (to - from) {
            break;
        }
        suffix += 1;
    }
    Difference { prefix, suffix, inserted: new.starts.len() - prefix - suffix }
}

/// Statements that did not change keep what was parsed of them.
fn take_over(document: &Document, old: &Region, blocks: &[Arc<Block>], changed: &Difference) {
    let old_blocks = document.blocks.get(old.first_block..old.end_block).unwrap_or_default();
    let old_places =
        || old_blocks.iter().flat_map(|block| (0..block.starts().len()).map(move |local| (block, local)));
    let new_places =
        || blocks.iter().flat_map(|block| (0..block.starts().len()).map(move |local| (block, local)));
    let new_count: usize = blocks.iter().map(|block| block.starts().len()).sum();
    let head = old_places().zip(new_places()).take(changed.prefix);
    let tail = old_places()
        .skip(old.starts.len() - changed.suffix)
        .zip(new_places().skip(new_count - changed.suffix));
    for ((old_block, old_local), (new_block, new_local)) in head.chain(tail) {
        if let Some(parsed) = old_block.already_parsed(old_local) {
            new_block.take_over(new_local, parsed);
        }
    }
}
