//! What can be folded: macro bodies, loops, branches of IFs, runs of comment lines, continued statements.

use std::ops::Range;

use apt_geometry::patience::Waiting;
use apt_run::go_on;
use apt_syntax::tree::SyntaxTree;

use crate::{Analysis, Cancel, Cancelled};

/// The kind of a fold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum FoldKind {
    Region,
    Comment,
    Statement,
}

/// One fold, bytes of the text, from the start of its first line to the end of its last.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fold {
    /// The kind.
    pub kind: FoldKind,
    /// The bytes.
    pub range: Range<usize>,
}

impl Analysis {
    /// All folds, in order of their start.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn folds(&self, cancel: Cancel<'_>) -> Result<Vec<Fold>, Cancelled> {
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let branches = self.with_marks(patience)?.branches();
        let tree = self.document().tree();
        let bytes = |index: usize| {
            let range = tree.statement(index).range();
            usize::from(range.start())..usize::from(range.end())
        };
        let mut folds: Vec<Fold> = self
            .regions()
            .iter()
            .filter(|region| region.last > region.first)
            .map(|region| Fold {
                kind: FoldKind::Region,
                range: bytes(region.first).start..bytes(region.last).end,
            })
            .collect();
        // The clause that ends a branch stays in sight.
        folds.extend(branches.into_iter().map(|branch| Fold {
            kind: FoldKind::Region,
            range: bytes(branch.start).start..bytes(branch.end).start,
        }));
        let mut comment: Option<Range<usize>> = None;
        for view in tree.statements() {
            go_on(patience, 1)?;
            let text = view.text();
            let range = bytes(view.index);
            if text.trim_start().starts_with("$$") {
                comment = Some(comment.map_or(range.clone(), |run| run.start..range.end));
                continue;
            }
            close(&mut folds, tree, &mut comment);
            if text.trim_end().contains('\n') {
                folds.push(Fold { kind: FoldKind::Statement, range });
            }
        }
        close(&mut folds, tree, &mut comment);
        folds.sort_by_key(|fold| (fold.range.start, std::cmp::Reverse(fold.range.end)));
        Ok(folds)
    }
}

/// Ends a run of comment lines; one line alone is no fold.
fn close(folds: &mut Vec<Fold>, tree: &SyntaxTree, comment: &mut Option<Range<usize>>) {
    let Some(range) = comment.take() else { return };
    let text = tree.slice(apt_syntax::TextRange::new((range.start as u32).into(), (range.end as u32).into()));
    if text.trim_end().contains('\n') {
        folds.push(Fold { kind: FoldKind::Comment, range });
    }
}
