//! Lints: what is allowed and yet probably not meant. Only what can be decided surely is told; a false alarm is worse
//! than a missed one.
//!
//! [`text`] looks at statements as they are written, [`values`] at what becomes of the values of names, [`path`] at the
//! records in order of execution, [`shadow`] at words that become names. The words and the gravity are those of the catalogue, as of every finding; comments
//! that allow a finding are [`crate::allow`].

pub(crate) mod notes;
mod path;
mod shadow;
mod text;
mod values;

#[cfg(test)]
mod tests;

pub(crate) use path::side_word;
pub(crate) use shadow::keep_shadowing;

use apt_geometry::{motion::DriveSide, patience::Patience};
use apt_program::{
    Origin, Program,
    finding::{Finding, Severity},
};
use apt_syntax::{SyntaxTree, dialect::DialectName};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use crate::{Cancelled, diagnostic::Fix, fix::removal, go_on, settings::Units};

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
    FeedMissing {
        /// The first FEDRAT that the program has later on, if its parameters are numbers and words.
        later: Option<SmolStr>,
    },
    /// No motion feels the THICK.
    ThicknessUnfelt {
        /// The one before it was not zero, and would hold without it.
        hides: bool,
    },
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

/// The lints of a program, each place once however often its statement is executed. The order is that of the looks;
/// the catalogue sorts.
///
/// What is written is looked at once per block of statements ([`notes`]); what the path makes of it is found by a walk
/// over the records.
///
/// `units` are those of the settings, in which the processor has its own tolerances.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn lint(
    tree: &SyntaxTree,
    program: &Program,
    units: Units,
    patience: Patience<'_>,
) -> Result<Vec<Lint>, Cancelled> {
    if tree.dialect().name == DialectName::Cl {
        // Programs write these files: their lines are of any length, their values are results, and a point has no
        // surface to hold a tolerance of.
        return Ok(Vec::new());
    }
    let mut texts = text::TextLints::new(tree);
    let mut values = values::Join::default();
    let mut depth = 0;
    for block in tree.blocks() {
        go_on(patience, block.statement_count())?;
        let notes = notes::Notes::of(&block, depth);
        let sum = notes.values(&block, depth);
        texts.block(block.first_statement(), &notes.text);
        values.block(block.first_statement(), &sum);
        depth = sum.depth();
    }
    let mut lints = texts.lints();
    lints.extend(effective_overwriting(tree, program, values.lints()));
    lints.extend(path::lints(tree, program, units, patience)?);
    Ok(lints)
}

/// The overwritten values of which nothing else is told: a name that cannot take the value keeps its meaning.
fn effective_overwriting(tree: &SyntaxTree, program: &Program, mut lints: Vec<Lint>) -> Vec<Lint> {
    if lints.is_empty() {
        return lints;
    }
    let is_grave = |finding: &&Finding| finding.severity >= Severity::Warning;
    let told: FxHashSet<u32> =
        program.findings().filter(is_grave).map(|finding| finding.origin.isn).collect();
    let is_told = |lint: &Lint| {
        let places = [Some(&lint.origin), lint.other.as_ref()];
        places.into_iter().flatten().any(|place| told.contains(&place.isn))
    };
    lints.retain(|lint| !is_told(lint));
    for lint in &mut lints {
        lint.fixes.extend(removal(tree, &lint.origin, "Remove the value that nothing reads"));
    }
    lints
}
