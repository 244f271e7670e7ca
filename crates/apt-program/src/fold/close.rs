//! Findings of the program as a whole: unused names, transfers that lead nowhere.

use apt_geometry::canonical::{Geometry, Plane};
use apt_syntax::dialect::DialectName;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::chunk::Chunk;
use crate::{
    evaluator::{State, same_place_and_kind},
    finding::{Finding, FindingKind},
    record::Origin,
    symbols::{ARRAY_KEY_SUFFIX, Meaning},
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
        if chunks.iter().any(Chunk::moves) && !chunks.iter().any(Chunk::lists_all) {
            add_unused(chunks, end, dialect, &mut findings);
        }
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
            let kind = if matches!(end.symbol(label).map(|symbol| &symbol.meaning), Some(Meaning::Label)) {
                FindingKind::UnknownTransfer { name: label.clone() }
            } else {
                FindingKind::UnknownLabel { name: label.clone(), similar: Vec::new() }
            };
            push(findings, kind, dialect, origin);
        }
    }
}

/// Names of numbers and geometry that nobody reads, in the order of their definition.
fn add_unused(chunks: &[Chunk], end: &State, dialect: DialectName, findings: &mut Vec<Finding>) {
    let used: FxHashSet<&SmolStr> = chunks.iter().flat_map(Chunk::used).collect();
    let mut unused: Vec<(&SmolStr, &Origin)> = end
        .symbols
        .iter()
        .filter(|(name, symbol)| {
            let has_value =
                matches!(symbol.meaning, Meaning::Scalar(_) | Meaning::Geometry(_) | Meaning::Array(_));
            // A file that several programs include need not be used up by each.
            let own = symbol.origin.source.is_none();
            own && has_value && !used.contains(name) && !names_implied_part_surface(&symbol.meaning)
        })
        .map(|(name, symbol)| (name, &symbol.origin))
        .collect();
    unused.sort_unstable_by(|(name, origin), (other, elsewhere)| {
        let place = |origin: &Origin| (origin.isn, origin.range.start());
        place(origin).cmp(&place(elsewhere)).then_with(|| name.cmp(other))
    });
    for (name, origin) in unused {
        let name = SmolStr::new(name.trim_end_matches(ARRAY_KEY_SUFFIX));
        push(findings, FindingKind::Unused { name }, dialect, origin);
    }
}

/// The xy-plane is the part surface as long as no other is named: a name for it says what the motions run on, so that it
/// is not unused even when no statement reads it.
fn names_implied_part_surface(meaning: &Meaning) -> bool {
    matches!(meaning, Meaning::Geometry(stored)
        if matches!(*stored.geometry, Geometry::Plane(plane) if plane == Plane::horizontal()))
}

/// Adds a finding.
fn push(findings: &mut Vec<Finding>, kind: FindingKind, dialect: DialectName, origin: &Origin) {
    findings.push(Finding::new(kind, dialect, origin.clone()));
}
