//! What can be folded: macro bodies, loops, branches of IFs, runs of comment lines, continued statements.

use std::ops::Range;

use apt_syntax::{
    statement::{Body, Clause},
    tree::{StatementView, SyntaxTree},
};

use crate::{Analysis, search::contains};

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
    pub fn folds(&self) -> Vec<Fold> {
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
        folds.extend(branches(tree).into_iter().map(|branch| Fold {
            kind: FoldKind::Region,
            range: bytes(branch.start).start..bytes(branch.end).start,
        }));
        let mut comment: Option<Range<usize>> = None;
        for view in tree.statements() {
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
        folds
    }
}

/// The branches of all IFs over several statements: from the clause that opens a branch to the one that ends it.
/// Branches that nothing ends are left out.
pub(crate) fn branches(tree: &SyntaxTree) -> Vec<Range<usize>> {
    let mut branches = Vec::new();
    if !tree.dialect().structured_if {
        return branches;
    }
    // The clauses that opened the branches which are open, innermost last.
    let mut open: Vec<usize> = Vec::new();
    for view in tree.statements() {
        let Some((opens, closes)) = branch_ends(&view) else { continue };
        let first = if closes { open.pop() } else { None };
        branches.extend(first.map(|first| first..view.index));
        open.extend(opens.then_some(view.index));
    }
    branches
}

/// Whether a statement opens and whether it closes a branch of an IF over several statements; nothing if neither.
fn branch_ends(view: &StatementView) -> Option<(bool, bool)> {
    let text = view.text().as_bytes();
    if ![b"THEN".as_slice(), b"ELSE", b"ENDIF"].iter().any(|word| contains(text, word)) {
        return None;
    }
    let parsed = view.parsed();
    match &parsed.statement.parts.first()?.body {
        Body::Clause { clause: Clause::If(_), .. } => Some((true, false)),
        Body::Clause { clause: Clause::ElseIf(_) | Clause::Else, .. } => Some((true, true)),
        Body::Clause { clause: Clause::End, .. } => Some((false, true)),
        _ => None,
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
