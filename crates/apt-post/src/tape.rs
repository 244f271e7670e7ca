//! The control tape as blocks.

use apt_cldata::record::Units;
use serde::{Deserialize, Serialize};

use crate::finding::{PostFinding, Severity};

/// One block of the tape.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Block {
    /// Its text, without end-of-block character.
    pub text: String,
    /// Number of the source statement, 0 when there is none.
    pub isn: u32,
    /// Origin, as in [`apt_cldata::record::ClRecord::source`].
    pub source: u32,
}

/// What the caller may decide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PostOptions {
    /// Unit of a program that does not say it.
    pub default_units: Units,
    /// Whether runs of points are fitted by arcs where no circle record vouches for them; `None` as the machine says.
    pub fit_points: Option<bool>,
    /// Most characters of text that PARTNO, PPRINT and INSERT may carry.
    pub text_limit: usize,
    /// Whether DEEP lifts the drill a little between its steps, so that chips break, as in NCL and PostWorks; elsewhere it
    /// is withdrawn from the hole.
    pub deep_breaks_chips: bool,
}

/// Characters of text on a card: columns 7 to 72.
pub const CARD_TEXT: usize = 66;

impl Default for PostOptions {
    fn default() -> Self {
        PostOptions {
            default_units: Units::Inches,
            fit_points: None,
            text_limit: CARD_TEXT,
            deep_breaks_chips: false,
        }
    }
}

/// What the post-processor made.
#[derive(Debug, Clone, PartialEq)]
pub struct Tape {
    /// Blocks in order.
    pub blocks: Vec<Block>,
    /// What it found, in the order of the records.
    pub findings: Vec<PostFinding>,
    /// Unit of the numbers on the tape.
    pub units: Units,
}

impl Tape {
    /// The blocks as text, one per line.
    pub fn text(&self) -> String {
        self.blocks.iter().flat_map(|block| [block.text.as_str(), "\n"]).collect()
    }

    /// Whether no finding is an error.
    pub fn is_ok(&self) -> bool {
        self.findings.iter().all(|finding| finding.kind.severity() != Severity::Error)
    }
}
