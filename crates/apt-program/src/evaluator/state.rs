//! Everything that later statements depend on. Cheap to clone: tables are persistent.

use std::sync::Arc;

use apt_geometry::{canonical::Plane, definition::ParametricPlace, motion::DriveSide};
use smol_str::SmolStr;

use crate::{
    Origin,
    finding::RelatedKind,
    statements::RegionalState,
    symbols::{ReferenceSystem, Symbol, SymbolTable},
};

/// The state of Section 1 between two statements.
#[derive(Debug, Clone)]
pub(crate) struct State {
    /// Names.
    pub(crate) symbols: SymbolTable,
    /// Synonyms, and words that have become names.
    pub(crate) synonyms: imbl::OrdMap<SmolStr, Synonym>,
    /// The plane that supplies z. Its numbers are those that it had at ZSURF and speak of whatever reference system is in
    /// force where a point is defined, as in APT III.
    pub(crate) z_surface: Plane,
    /// REFSYS in force.
    pub(crate) system: Option<Arc<ReferenceSystem>>,
    /// CANON/ON.
    pub(crate) canon: bool,
    /// PRINT/ON.
    pub(crate) print_all: bool,
    /// TLLFT, TLRGT or TLON in force, which decides implied check surfaces.
    pub(crate) drive_side: DriveSide,
    /// Plain MULTAX was given: the other forms are ignored from then on.
    pub(crate) axes_for_good: bool,
    /// MULTAX is on.
    pub(crate) axes_on: bool,
    /// MACHIN statements so far.
    pub(crate) machines: u32,
    /// Budgets exhausted so far; each one makes the next smaller.
    pub(crate) exhausted: u32,
    /// Statements executed again at the top level (dialects with free jumps).
    pub(crate) repeated: u64,
    /// The highest statement index reached, plus one (dialects with free jumps).
    pub(crate) reached: usize,
    /// Labels of check surfaces whose statements are still to come: Section 2 may go on there.
    pub(crate) open_checks: imbl::OrdSet<SmolStr>,
    /// Macros of the library that have been called (dialects with bounded tables).
    pub(crate) library_calls: imbl::OrdSet<SmolStr>,
    /// The conditions and switches of regional milling.
    pub(crate) regional: Arc<RegionalState>,
    /// The place that the last INTOF of a space curve or a sculptured surface has found.
    pub(crate) intersection: Option<Arc<ParametricPlace>>,
    /// The loop or macro of the program that is still open where its text ends, and where it begins.
    pub(crate) open_region: Option<(RelatedKind, Origin)>,
    /// FINI has been executed.
    pub(crate) ended: bool,
}

/// What a synonym stands for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Synonym {
    /// A vocabulary word.
    Word(SmolStr),
    /// A name: a vocabulary word that was assigned to (APT4).
    Name,
}

impl Default for State {
    fn default() -> Self {
        Self {
            symbols: SymbolTable::default(),
            synonyms: imbl::OrdMap::new(),
            z_surface: Plane::horizontal(),
            system: None,
            canon: false,
            print_all: false,
            drive_side: DriveSide::On,
            axes_for_good: false,
            axes_on: false,
            machines: 0,
            exhausted: 0,
            repeated: 0,
            reached: 0,
            open_checks: imbl::OrdSet::new(),
            library_calls: imbl::OrdSet::new(),
            regional: Arc::default(),
            intersection: None,
            open_region: None,
            ended: false,
        }
    }
}

impl State {
    /// Whether all but the symbols is the same.
    pub(crate) fn same_modal_values(&self, other: &State) -> bool {
        self.synonyms == other.synonyms
            && self.z_surface == other.z_surface
            && self.system == other.system
            && self.canon == other.canon
            && self.print_all == other.print_all
            && self.drive_side == other.drive_side
            && self.axes_for_good == other.axes_for_good
            && self.axes_on == other.axes_on
            && self.machines == other.machines
            && self.exhausted == other.exhausted
            && self.repeated == other.repeated
            && self.open_checks == other.open_checks
            && self.library_calls == other.library_calls
            && self.intersection == other.intersection
            && (Arc::ptr_eq(&self.regional, &other.regional) || self.regional == other.regional)
            && self.ended == other.ended
    }

    /// The meaning of a name.
    pub(crate) fn symbol(&self, name: &str) -> Option<&Symbol> {
        self.symbols.get(name).map(|symbol| &**symbol)
    }
}
