//! Lints: what is allowed and yet probably not meant. Only what can be decided surely is told; a false alarm is worse
//! than a missed one.
//!
//! [`text`] looks at statements as they are written, [`values`] at what becomes of the values of names, [`path`] at the
//! records in order of execution, [`shadow`] at words that become names. The words and the gravity are those of the catalogue, as of every finding; comments
//! that allow a finding are [`crate::allow`].

mod path;
mod shadow;
mod text;
mod values;

#[cfg(test)]
mod tests;

pub(crate) use path::side_word;
pub(crate) use shadow::keep_shadowing;

use apt_geometry::motion::DriveSide;
use apt_program::{Origin, Program};
use apt_syntax::{SyntaxTree, dialect::DialectName};
use smol_str::SmolStr;

use crate::diagnostic::Fix;

/// What is odd, with its evidence.
#[derive(Debug, Clone, PartialEq)]
pub enum LintKind {
    /// Elements stand behind column 72, where processors that read cards cut them off.
    PastLastColumn {
        /// So many statements do that no more of them are told.
        and_others: bool,
    },
    /// Blanks divide what is read as one name or number.
    BlanksInside {
        /// The pieces.
        pieces: Vec<SmolStr>,
        /// What they are read as.
        read_as: SmolStr,
    },
    /// A tolerance is wide in comparison to the cutter.
    LooseTolerance {
        /// INTOL or OUTTOL.
        word: &'static str,
        /// Its largest value, program units.
        value: f64,
        /// Diameter of the cutter, program units.
        diameter: f64,
    },
    /// A motion along a curved part surface before any tolerance was given.
    ToleranceMissing,
    /// A motion along surfaces before any feed rate.
    FeedMissing,
    /// No motion feels the THICK.
    ThicknessUnfelt,
    /// INDIRV, INDIRP or SRFVCT that another one replaces before a motion.
    DirectionReplaced,
    /// One tool number with two cutters.
    ToolWithTwoCutters {
        /// The number in LOADTL.
        tool: i64,
    },
    /// The tool stands on one side of its next drive surface, and the program says another one.
    SideContradicted {
        /// The name of the drive surface.
        surface: SmolStr,
        /// What the program says.
        said: DriveSide,
        /// Where the tool stands after the motion before.
        stands: DriveSide,
    },
    /// A value that is overwritten before anything reads it.
    Overwritten {
        /// The name.
        name: SmolStr,
    },
    /// A modal statement that another one replaces before the tool moves.
    ModeReplaced {
        /// What it sets, in the language of the user.
        mode: &'static str,
    },
}

/// One finding.
#[derive(Debug, Clone, PartialEq)]
pub struct Lint {
    /// What.
    pub kind: LintKind,
    /// Where.
    pub origin: Origin,
    /// Another place that has to do with it: what replaces or overwrites it, what it contradicts.
    pub other: Option<Origin>,
    /// Changes that settle it; none if only the author can.
    pub fixes: Vec<Fix>,
}

/// Statements up to which overwritten values are looked for: that reads every statement again, and beyond this number
/// the tree keeps none of them read, so that each keystroke would cost the length of the program.
const MOST_STATEMENTS_FOR_VALUES: usize = 50_000;

/// The lints of a program, each place once however often its statement is executed. The order is that of the looks;
/// the catalogue sorts.
pub fn lint(tree: &SyntaxTree, program: &Program) -> Vec<Lint> {
    if tree.dialect().name == DialectName::Cl {
        // Programs write these files: their lines are of any length, their values are results, and a point has no
        // surface to hold a tolerance of.
        return Vec::new();
    }
    let mut lints = text::lints(tree);
    if tree.statement_count() <= MOST_STATEMENTS_FOR_VALUES {
        lints.extend(values::lints(tree));
    }
    lints.extend(path::lints(tree, program));
    lints
}
