//! What lints and comments need of a block of statements, found out once and kept with the block for all versions of a
//! program that share it.

use std::sync::{Arc, OnceLock};

use apt_geometry::patience::Patience;
use apt_syntax::{SyntaxTree, dialect::DialectName, tree::BlockView};

use super::{
    text::{self, TextNote},
    values::{Stretch, Summary},
};
use crate::{Cancelled, allow::ADDRESS, go_on};

/// What is known of a block.
pub(crate) struct Notes {
    /// A comment in it speaks to this program.
    pub(crate) addresses: bool,
    /// What is odd in the way in which its statements are written.
    pub(super) text: Box<[TextNote]>,
    /// What becomes of values, and the number of open macros and loops before the block for which that holds.
    values: (usize, Arc<Summary>),
    /// The same for another such number: an edit may have opened a macro far above.
    values_elsewhere: OnceLock<(usize, Arc<Summary>)>,
}

impl Notes {
    /// The notes of a block; `depth` tells how many macros and loops are open before it, as far as that is known.
    pub(crate) fn of(block: &BlockView<'_>, depth: usize) -> Arc<Self> {
        block.derived(|| Self::make(block, depth))
    }

    /// One reading of each statement for everything.
    fn make(block: &BlockView<'_>, depth: usize) -> Self {
        let mut values = Stretch::at_depth(depth);
        let mut notes = Vec::new();
        for (local, view) in (0_u32..).zip(block.statements()) {
            let parsed = view.parsed();
            values.statement(local, &parsed);
            notes.extend(text::notes(local, &view, &parsed));
        }
        Self {
            addresses: block.text().contains(ADDRESS),
            text: notes.into(),
            values: (depth, Arc::new(values.end())),
            values_elsewhere: OnceLock::new(),
        }
    }

    /// What becomes of values in the block behind so many open macros and loops.
    pub(super) fn values(&self, block: &BlockView<'_>, depth: usize) -> Arc<Summary> {
        let known = [Some(&self.values), self.values_elsewhere.get()];
        if let Some((_, sum)) = known.into_iter().flatten().find(|(at, _)| *at == depth) {
            return Arc::clone(sum);
        }
        let mut values = Stretch::at_depth(depth);
        for (local, view) in (0_u32..).zip(block.statements()) {
            values.statement(local, &view.parsed());
        }
        let sum = Arc::new(values.end());
        // The place may be taken by a third depth, which is then found out each time.
        let _ = self.values_elsewhere.set((depth, Arc::clone(&sum)));
        sum
    }
}

/// The blocks of a program whose comments may speak to this program.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub(crate) fn addressing_blocks<'a>(
    tree: &'a SyntaxTree,
    patience: Patience<'_>,
) -> Result<Vec<BlockView<'a>>, Cancelled> {
    let is_lint_free = tree.dialect().name == DialectName::Cl;
    let mut depth = 0;
    let mut addressing = Vec::new();
    for block in tree.blocks() {
        go_on(patience, block.statement_count())?;
        let addresses = if is_lint_free {
            // Nothing else is asked about these files, which are long: the notes would be made for this alone.
            block.text().contains(ADDRESS)
        } else {
            let notes = Notes::of(&block, depth);
            depth = notes.values(&block, depth).depth();
            notes.addresses
        };
        addressing.extend(addresses.then_some(block));
    }
    Ok(addressing)
}
