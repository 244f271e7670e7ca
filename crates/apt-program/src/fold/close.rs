//! Findings of the program as a whole: transfers that lead nowhere. Names that nobody reads are [`super::unused`].

use apt_syntax::dialect::DialectName;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::chunk::Chunk;
use crate::{
    evaluator::{State, same_place_and_kind},
    finding::{ControlFinding, Finding, FindingKind},
    record::Origin,
    symbols::Meaning,
};

/// The findings of all chunks, each once, and those that need the whole program.
pub(super) fn closing_findings(
    chunks: &[Chunk],
    end: &State,
    dialect: DialectName,
    complete: bool,
) -> Vec<Finding> {
    let mut findings: Vec<Finding> = Vec::new();
    let mut by_place: FxHashMap<(u32, u32), Vec<usize>> = FxHashMap::default();
    let reporting = chunks.iter().filter(|chunk| chunk.has_findings());
    for finding in reporting.flat_map(|chunk| chunk.data().findings.iter()) {
        let place = (finding.origin.isn, u32::from(finding.origin.range.start()));
        let known = by_place.entry(place).or_default();
        let alike = known.iter().find(|index| same_place_and_kind(&findings[**index], finding));
        if let Some(known) = alike.and_then(|index| findings.get_mut(*index)) {
            if known.severity < finding.severity {
                *known = finding.clone();
            }
            continue;
        }
        known.push(findings.len());
        findings.push(finding.clone());
    }
    if complete {
        add_unknown_transfers(chunks, end, dialect, &mut findings);
    }
    findings
}

/// TRANTO and labels of check surfaces that no statement carries.
fn add_unknown_transfers(chunks: &[Chunk], end: &State, dialect: DialectName, findings: &mut Vec<Finding>) {
    let mut carried: FxHashSet<SmolStr> = FxHashSet::default();
    let transfers: Vec<&(SmolStr, Origin)> = chunks
        .iter()
        .filter(|chunk| chunk.has_transfers())
        .flat_map(|chunk| chunk.data().transfers.iter())
        .collect();
    if transfers.is_empty() {
        return;
    }
    carried.extend(chunks.iter().flat_map(Chunk::record_labels).cloned());
    for (label, origin) in transfers {
        if !carried.contains(label) {
            let at_top = matches!(end.symbol(label).map(|symbol| &symbol.meaning), Some(Meaning::Label));
            let kind = if at_top || chunks.iter().any(|chunk| chunk.has_inner_label(label)) {
                FindingKind::Control(ControlFinding::UnknownTransfer { name: label.clone() })
            } else {
                FindingKind::Control(ControlFinding::UnknownLabel {
                    name: label.clone(),
                    similar: Vec::new(),
                })
            };
            push(findings, kind, dialect, origin);
        }
    }
}

/// Adds a finding.
fn push(findings: &mut Vec<Finding>, kind: FindingKind, dialect: DialectName, origin: &Origin) {
    findings.push(Finding::new(kind, dialect, origin.clone()));
}
