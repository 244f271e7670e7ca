//! Cutter-location records (CLTAPE, ISO 3592), independent of the dialect they are written in.

use apt_geometry::Vec3;
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
        if let ClKind::Motion { points, .. } = &self.kind { points.len() } else { 0 }
    }
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
