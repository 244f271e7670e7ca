//! Cutter-location records (CLTAPE, ISO 3592), independent of the dialect they are written in.

use apt_geometry::{Vec3, patience::Patience};
use serde::{Deserialize, Serialize};
use smol_str::SmolStr;

/// One group of CL records that a statement left behind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClRecord {
    /// Internal statement number of the source statement (0 when unknown).
    pub isn: u32,
    /// Index into the caller's table of origins (macro and loop stack); `u32::MAX` when there is none.
    pub source: u32,
    /// What it says.
    pub kind: ClKind,
}

impl ClRecord {
    /// How many positions it holds: those of a motion, none of anything else.
    pub fn position_count(&self) -> usize {
        self.kind.position_count()
    }
}

impl ClKind {
    /// How many positions it says: those of a motion, none of anything else.
    pub fn position_count(&self) -> usize {
        if let Self::Motion { points, .. } = self { points.len() } else { 0 }
    }
}

/// Whether who waits gives up before a record with so many positions.
pub(crate) fn ends_before(positions: usize, patience: Patience<'_>) -> bool {
    patience.ends_after(u32::try_from(1 + positions).unwrap_or(u32::MAX))
}

/// Positions or records that are counted as one unit of work where one is looked at in some nanoseconds.
pub const POSITIONS_A_UNIT: usize = 16;

/// Things that are looked at one after the other, each in some nanoseconds, until who waits gives up.
pub(crate) fn looked_through<I: Iterator>(
    things: I,
    patience: Patience<'_>,
) -> impl Iterator<Item = I::Item> {
    let goes_on = move |(done, _): &(usize, I::Item)| !patience.ends_among(*done, POSITIONS_A_UNIT);
    things.enumerate().take_while(goes_on).map(|(_, thing)| thing)
}

/// How many positions records hold; fewer where who waits gives up before the end.
pub fn positions(records: &[ClRecord], patience: Patience<'_>) -> usize {
    let pieces = records.chunks(POSITIONS_A_UNIT).take_while(|_| !patience.ends_after(1));
    pieces.flatten().map(ClRecord::position_count).sum()
}

/// What a CL record says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum ClKind {
    /// A post-processor statement, class 2000.
    Postprocessor {
        /// The word.
        word: SmolStr,
        /// Its subclass; `None` for a word no vocabulary knows.
        code: Option<u16>,
        /// Its parameters.
        arguments: Vec<ClWord>,
    },
    /// PARTNO, PPRINT, INSERT and their kin with free text.
    Text {
        /// The word.
        word: SmolStr,
        /// Its subclass.
        code: Option<u16>,
        /// The text.
        text: SmolStr,
    },
    /// The canonical form of a circle or cylinder written before a motion along it, class 3000:2.
    Arc {
        /// Name of the surface, empty if it has none.
        surface: SmolStr,
        /// Centre.
        center: Vec3,
        /// Unit axis.
        axis: Vec3,
        /// Radius.
        radius: f64,
    },
    /// Tool positions, class 5000: one statement's worth.
    Motion {
        /// FROM (no motion) or GOTO and computed motion.
        from: bool,
        /// Name of the drive surface or point, empty if it has none.
        surface: SmolStr,
        /// The positions in order.
        points: Vec<ClPoint>,
    },
    /// A parameter of the arithmetic element, class 6000 (INTOL 4, OUTTOL 5, CUTTER 6, CUT and DNTCUT 1 …).
    Control {
        /// The word.
        word: SmolStr,
        /// Class and subclass.
        code: [u16; 2],
        /// Its parameters.
        arguments: Vec<ClWord>,
    },
    /// MULTAX on or off, class 9000:2.
    MultipleAxes(bool),
    /// UNITS.
    Units(Units),
    /// FINI, class 14000.
    End,
}

/// Length unit of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Units {
    Inches,
    Millimeters,
}

/// One tool position.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClPoint {
    /// Tool end.
    pub position: Vec3,
    /// Unit tool axis from the tip to the spindle.
    pub axis: Vec3,
    /// Whether the axis is written (MULTAX in effect).
    pub with_axis: bool,
}

/// One parameter of a CL record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ClWord {
    /// A number.
    Number(f64),
    /// A word.
    Word(SmolStr),
}
