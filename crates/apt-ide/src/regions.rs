//! Macro bodies and loop regions: where labels and macro variables are local.

use std::ops::Range;

use apt_geometry::patience::Patience;
use apt_run::go_on;
use apt_syntax::{
    statement::{Body, Clause},
    tree::SyntaxTree,
};
use smol_str::SmolStr;

use crate::{Cancelled, carry::Carried, files::names_of_files, search::contains};

/// The kind of a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum RegionKind {
    Macro,
    Loop,
}

/// A macro body (header to TERMAC) or a loop (LOOPST to LOOPND), by statement index, both ends included.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Region {
    /// Macro or loop.
    pub kind: RegionKind,
    /// Name of the macro; empty for a loop.
    pub name: SmolStr,
    /// Index of the opening statement.
    pub first: usize,
    /// Index of the closing statement; the last statement when it is missing.
    pub last: usize,
    /// Macro variables.
    pub variables: Vec<SmolStr>,
}

impl Region {
    /// Whether the statement belongs to the region.
    pub fn contains(&self, statement: usize) -> bool {
        (self.first..=self.last).contains(&statement)
    }
}

/// A statement that opens or closes a region.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Mark {
    Macro(SmolStr, Vec<SmolStr>),
    Loop,
    EndMacro,
    EndLoop,
    /// A statement that puts in another file.
    Inclusion,
    /// A clause of an IF over several statements.
    Branch {
        /// It opens a branch.
        opens: bool,
        /// It closes the one before it.
        closes: bool,
    },
}

/// Statements that are looked through for marks before their work is counted; less than is done between two questions.
const LOOKED_THROUGH_AT_ONCE: usize = 64;

/// The statements that open or close regions and branches, in order; after an edit only the statements that it touched are looked
/// at again.
#[derive(Debug, Clone, Default)]
pub(crate) struct Marks(Vec<(usize, Mark)>);

impl Marks {
    /// The marks of a program.
    pub(crate) fn of(tree: &SyntaxTree) -> Self {
        Self(Self::among(tree, 0..tree.statement_count()).collect())
    }

    /// The same for somebody who waits.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when who waits has given up before the end.
    pub(crate) fn find(tree: &SyntaxTree, patience: Patience<'_>) -> Result<Self, Cancelled> {
        let mut marks = Vec::new();
        let end = tree.statement_count();
        for from in (0..end).step_by(LOOKED_THROUGH_AT_ONCE) {
            let to = end.min(from + LOOKED_THROUGH_AT_ONCE);
            go_on(patience, to - from)?;
            marks.extend(Self::among(tree, from..to));
        }
        Ok(Self(marks))
    }

    /// The marks of the next version.
    pub(crate) fn carried(&self, carried: &Carried, new: &SyntaxTree) -> Self {
        let moved = |(index, mark): &(usize, Mark)| Some((carried.index(*index)?, mark.clone()));
        let (before, behind): (Vec<_>, Vec<_>) =
            self.0.iter().filter_map(moved).partition(|(index, _)| *index < carried.first);
        Self(before.into_iter().chain(Self::among(new, carried.changed())).chain(behind).collect())
    }

    fn among(tree: &SyntaxTree, statements: Range<usize>) -> impl Iterator<Item = (usize, Mark)> {
        const WORDS: [&str; 7] = ["MACRO", "TERMAC", "LOOPST", "LOOPND", "INCLUD", "LIBRY", "READ"];
        const CLAUSES: [&str; 3] = ["THEN", "ELSE", "ENDIF"];
        let clauses: &[&str] = if tree.dialect().structured_if { &CLAUSES } else { &[] };
        statements.filter_map(move |index| {
            let view = tree.statement(index);
            let text = view.text().as_bytes();
            let may_mark = WORDS.iter().chain(clauses).any(|word| contains(text, word.as_bytes()));
            Some((index, may_mark.then(|| mark(tree, index)).flatten()?))
        })
    }

    /// The statements that put in other files.
    pub(crate) fn inclusions(&self) -> impl Iterator<Item = usize> {
        self.0.iter().filter(|(_, mark)| *mark == Mark::Inclusion).map(|(index, _)| *index)
    }

    /// The branches of all IFs over several statements: from the clause that opens a branch to the one that ends it.
    /// Branches that nothing ends are left out.
    pub(crate) fn branches(&self) -> Vec<Range<usize>> {
        let mut branches = Vec::new();
        // The clauses that opened the branches which are open, innermost last.
        let mut open: Vec<usize> = Vec::new();
        for (index, mark) in &self.0 {
            let Mark::Branch { opens, closes } = mark else { continue };
            let first = if *closes { open.pop() } else { None };
            branches.extend(first.map(|first| first..*index));
            open.extend(opens.then_some(*index));
        }
        branches
    }

    /// All regions, in order of their opening statements.
    pub(crate) fn regions(&self, tree: &SyntaxTree) -> Vec<Region> {
        let end = tree.statement_count().saturating_sub(1);
        let mut regions: Vec<Region> = Vec::new();
        let mut open: Vec<usize> = Vec::new();
        for (index, mark) in &self.0 {
            let (kind, name, variables) = match mark {
                Mark::Macro(name, variables) => (RegionKind::Macro, name.clone(), variables.clone()),
                Mark::Loop => (RegionKind::Loop, SmolStr::default(), Vec::new()),
                Mark::EndMacro => {
                    close(&mut regions, &mut open, RegionKind::Macro, *index);
                    continue;
                }
                Mark::EndLoop => {
                    close(&mut regions, &mut open, RegionKind::Loop, *index);
                    continue;
                }
                Mark::Inclusion | Mark::Branch { .. } => continue,
            };
            open.push(regions.len());
            regions.push(Region { kind, name, first: *index, last: end, variables });
        }
        regions
    }
}

/// Closes the innermost open region of the kind.
fn close(regions: &mut [Region], open: &mut Vec<usize>, kind: RegionKind, index: usize) {
    if let Some(at) = open.iter().rposition(|&region| regions[region].kind == kind) {
        regions[open[at]].last = index;
        open.truncate(at);
    }
}

fn mark(tree: &SyntaxTree, index: usize) -> Option<Mark> {
    let parsed = tree.statement(index).parsed();
    let parts = &parsed.statement.parts;
    let region = parts.iter().find_map(|part| match &part.body {
        Body::Macro { name, parameters, .. } => {
            let variables = parameters.iter().map(|parameter| parameter.name.text.clone()).collect();
            Some(Mark::Macro(name.text.clone(), variables))
        }
        Body::Major { word, .. } => match word.word.spelling {
            "TERMAC" => Some(Mark::EndMacro),
            "LOOPST" => Some(Mark::Loop),
            "LOOPND" => Some(Mark::EndLoop),
            _ => (!names_of_files(&part.body).is_empty()).then_some(Mark::Inclusion),
        },
        _ => None,
    });
    region.or_else(|| branch(&parts.first()?.body).filter(|_| tree.dialect().structured_if))
}

/// What a clause does to the branches of its IF.
fn branch(body: &Body) -> Option<Mark> {
    let (opens, closes) = match body {
        Body::Clause { clause: Clause::If(_), .. } => (true, false),
        Body::Clause { clause: Clause::ElseIf(_) | Clause::Else, .. } => (true, true),
        Body::Clause { clause: Clause::End, .. } => (false, true),
        _ => return None,
    };
    Some(Mark::Branch { opens, closes })
}
