//! What a stretch of the program leaves behind.

use std::cell::RefCell;

use apt_geometry::pieces::Pieces;
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use crate::{
    finding::{Finding, FindingKind},
    listing::ListingEntry,
    record::{Origin, Record},
    symbols::DefinitionEvent,
};

/// Records, findings and definitions, in order of execution.
#[derive(Debug, Default)]
pub(crate) struct Output {
    /// Records.
    pub(crate) records: Pieces<Record>,
    /// Findings, one for each place and kind.
    pub(crate) findings: Vec<Finding>,
    /// What is printed and punched.
    pub(crate) listing: Vec<ListingEntry>,
    /// Definitions.
    pub(crate) definitions: Pieces<DefinitionEvent>,
    /// Names whose meaning changed.
    pub(crate) touched: FxHashSet<SmolStr>,
    /// Names that were used.
    pub(crate) used: FxHashSet<SmolStr>,
    /// Names whose meaning, or its absence, had an effect: whoever looks a name up is entered, readers of a shared
    /// state included.
    pub(crate) looked_up: RefCell<FxHashSet<SmolStr>>,
    /// The names there are had an effect: suggestions for a misspelt one were looked for.
    pub(crate) looked_at_all: bool,
    /// A PRINT or PUNCH has listed all names.
    pub(crate) lists_all: bool,
    /// Labels that TRANTO and check surfaces name, for a check at the end.
    pub(crate) transfers: Vec<(SmolStr, Origin)>,
    /// Labels of the statements in loops and macros that were executed.
    pub(crate) inner_labels: FxHashSet<SmolStr>,
}

impl Output {
    /// Adds a finding unless the same one was made at the same place; of both the graver one stays.
    pub(crate) fn add_finding(&mut self, finding: Finding) {
        match self.findings.iter_mut().find(|other| same_place_and_kind(other, &finding)) {
            Some(known) if known.severity < finding.severity => *known = finding,
            Some(_) => {}
            None => self.findings.push(finding),
        }
    }

    /// Whether the name at this place was already said to be undefined or misspelt. Only findings that every execution
    /// of the statement makes count: others depend on where the checkpoints are.
    pub(crate) fn has_name_finding_at(&self, isn: u32, range: apt_syntax::TextRange) -> bool {
        self.findings.iter().any(|finding| {
            finding.origin.isn == isn
                && finding.origin.range == range
                && matches!(finding.kind, FindingKind::Undefined { .. } | FindingKind::Syntax(_))
        })
    }
}

/// Whether two findings say the same about the same words of the program, whatever the loop turn.
pub(crate) fn same_place_and_kind(left: &Finding, right: &Finding) -> bool {
    left.origin.isn == right.origin.isn
        && left.origin.range == right.origin.range
        && left.origin.source == right.origin.source
        && std::mem::discriminant(&left.kind) == std::mem::discriminant(&right.kind)
        && !are_elements_of_one_list(left, right)
}

/// Whether two names without value are elements that one inclusive subscript names: each of them is told.
fn are_elements_of_one_list(left: &Finding, right: &Finding) -> bool {
    match (&left.kind, &right.kind) {
        (FindingKind::Undefined { name: one, .. }, FindingKind::Undefined { name: other, .. }) => {
            one != other && left.origin.frame == right.origin.frame
        }
        _ => false,
    }
}
