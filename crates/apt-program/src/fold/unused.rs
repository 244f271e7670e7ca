//! Names that nobody reads, kept from version to version: an edit changes a few of them.

use apt_geometry::canonical::{Geometry, Plane};
use apt_syntax::{TextSize, dialect::DialectName};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::chunk::Chunk;
use crate::{
    evaluator::State,
    finding::{Finding, FindingKind},
    symbols::{ARRAY_KEY_SUFFIX, Meaning, Symbol},
};

/// The place of a definition, then the name.
type Key = (u32, TextSize, SmolStr);

/// The findings about names of numbers and geometry that nobody reads, in the order of their definition.
#[derive(Debug, Clone, Default)]
pub(super) struct Unused {
    /// None where they are not told: in a program that moves nothing, or lists all names.
    names: Option<imbl::OrdMap<Key, Finding>>,
}

/// What took the place of what, between two versions that agree about everything else.
pub(super) struct Replacement<'a> {
    /// The chunks that are gone.
    pub(super) old: &'a [Chunk],
    /// Those that are there instead.
    pub(super) new: &'a [Chunk],
    /// Names that have another meaning behind them.
    pub(super) patched: Vec<&'a SmolStr>,
}

impl Unused {
    /// Looks at all names.
    pub(super) fn find(chunks: &[Chunk], end: &State, dialect: DialectName) -> Self {
        if !are_told(chunks) {
            return Self::default();
        }
        let used: FxHashSet<&SmolStr> = chunks.iter().flat_map(Chunk::used).collect();
        let unused = end.symbols.iter().filter(|(name, symbol)| wants_use(symbol) && !used.contains(name));
        Self { names: Some(unused.map(|(name, symbol)| entry(name, symbol, dialect)).collect()) }
    }

    /// Looks at the names again that a replacement touches; `before` is the end of the old version, `chunks` and `end`
    /// are the new one, in which no statement has another number.
    pub(super) fn after(
        &self,
        replacement: &Replacement<'_>,
        before: &State,
        (chunks, end): (&[Chunk], &State),
        dialect: DialectName,
    ) -> Self {
        let told = are_told(chunks);
        let Some(names) = self.names.as_ref().filter(|_| told) else {
            return Self::find(chunks, end, dialect);
        };
        let used = |chunks: &'_ [Chunk]| -> FxHashSet<SmolStr> {
            chunks.iter().flat_map(Chunk::used).cloned().collect()
        };
        let (used_before, used_now) = (used(replacement.old), used(replacement.new));
        let otherwise_used: FxHashSet<&SmolStr> = used_before.symmetric_difference(&used_now).collect();
        let touched = replacement.old.iter().chain(replacement.new).flat_map(Chunk::touched);
        let concerned: FxHashSet<&SmolStr> = touched
            .chain(replacement.patched.iter().copied())
            .chain(otherwise_used.iter().copied())
            .collect();
        let mut names = names.clone();
        for name in concerned {
            let old = before.symbol(name).filter(|symbol| wants_use(symbol));
            let was_unused = old.and_then(|symbol| names.remove(&key(name, symbol))).is_some();
            let Some(symbol) = end.symbol(name).filter(|symbol| wants_use(symbol)) else { continue };
            // Nobody has begun or ceased to read it: what was found before still holds.
            let is_known = old.is_some() && !otherwise_used.contains(name);
            let is_unused =
                if is_known { was_unused } else { !chunks.iter().any(|chunk| chunk.used().contains(name)) };
            if is_unused {
                let (key, finding) = entry(name, symbol, dialect);
                names.insert(key, finding);
            }
        }
        Self { names: Some(names) }
    }

    /// The findings.
    pub(super) fn findings(&self) -> impl Iterator<Item = &Finding> {
        self.names.iter().flat_map(|names| names.values())
    }
}

/// Whether unused names are told at all.
fn are_told(chunks: &[Chunk]) -> bool {
    chunks.iter().any(Chunk::moves) && !chunks.iter().any(Chunk::lists_all)
}

/// Whether a name has a value that somebody should read. A file that several programs include need not be used up by each.
fn wants_use(symbol: &Symbol) -> bool {
    let has_value = matches!(symbol.meaning, Meaning::Scalar(_) | Meaning::Geometry(_) | Meaning::Array(_));
    has_value && symbol.origin.source.is_none() && !names_implied_part_surface(&symbol.meaning)
}

/// The xy-plane is the part surface as long as no other is named: a name for it says what the motions run on, so that it
/// is not unused even when no statement reads it.
fn names_implied_part_surface(meaning: &Meaning) -> bool {
    matches!(meaning, Meaning::Geometry(stored)
        if matches!(*stored.geometry, Geometry::Plane(plane) if plane == Plane::horizontal()))
}

fn key(name: &SmolStr, symbol: &Symbol) -> Key {
    (symbol.origin.isn, symbol.origin.range.start(), name.clone())
}

fn entry(name: &SmolStr, symbol: &Symbol, dialect: DialectName) -> (Key, Finding) {
    let kind = FindingKind::Unused { name: SmolStr::new(name.trim_end_matches(ARRAY_KEY_SUFFIX)) };
    (key(name, symbol), Finding::new(kind, dialect, symbol.origin.clone()))
}
