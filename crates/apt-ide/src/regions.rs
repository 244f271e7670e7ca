//! Macro bodies and loop regions: where labels and macro variables are local.

use apt_syntax::{statement::Body, tree::SyntaxTree};
use smol_str::SmolStr;

use crate::search::statements_with;

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

enum Mark {
    Macro(SmolStr, Vec<SmolStr>),
    Loop,
    EndMacro,
    EndLoop,
}

/// All regions, in order of their opening statements.
pub fn find(tree: &SyntaxTree) -> Vec<Region> {
    let mut candidates: Vec<usize> =
        ["MACRO", "TERMAC", "LOOPST", "LOOPND"].iter().flat_map(|word| statements_with(tree, word)).collect();
    candidates.sort_unstable();
    candidates.dedup();
    let end = tree.statement_count().saturating_sub(1);
    let mut regions: Vec<Region> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    for index in candidates {
        match mark(tree, index) {
            Some(Mark::Macro(name, variables)) => {
                open.push(regions.len());
                regions.push(Region { kind: RegionKind::Macro, name, first: index, last: end, variables });
            }
            Some(Mark::Loop) => {
                open.push(regions.len());
                let name = SmolStr::default();
                regions.push(Region {
                    kind: RegionKind::Loop,
                    name,
                    first: index,
                    last: end,
                    variables: Vec::new(),
                });
            }
            Some(Mark::EndMacro) => close(&mut regions, &mut open, RegionKind::Macro, index),
            Some(Mark::EndLoop) => close(&mut regions, &mut open, RegionKind::Loop, index),
            None => {}
        }
    }
    regions
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
    parsed.statement.parts.iter().find_map(|part| match &part.body {
        Body::Macro { name, parameters, .. } => {
            let variables = parameters.iter().map(|parameter| parameter.name.text.clone()).collect();
            Some(Mark::Macro(name.text.clone(), variables))
        }
        Body::Major { word, .. } => match word.word.spelling {
            "TERMAC" => Some(Mark::EndMacro),
            "LOOPST" => Some(Mark::Loop),
            "LOOPND" => Some(Mark::EndLoop),
            _ => None,
        },
        _ => None,
    })
}
