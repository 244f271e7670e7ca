//! What can be wrong with the edit statements, with the numbers of APT III.

use super::{MAXIMUM_COPIES_PER_INDEX, MAXIMUM_NESTING};
use crate::tilt::TiltError;

/// A mistake in the edit statements, with its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EditError {
    /// Statement number.
    pub isn: u32,
    /// Origin, as in [`crate::record::ClRecord::source`].
    pub source: u32,
    /// What is wrong.
    pub kind: EditErrorKind,
}

// By hand, because `source` is the place in the program here and no underlying error.
impl std::fmt::Display for EditError {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "statement {}: {}", self.isn, self.kind)
    }
}

impl std::error::Error for EditError {}

impl EditError {
    /// The number of the APT III edit phase message, where there is one.
    pub fn apt3(&self) -> Option<u16> {
        self.kind.apt3()
    }
}

/// What is wrong with an edit statement.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum EditErrorKind {
    /// INDEX ... COPY nested too deep; the range is not copied.
    #[error("INDEX {number} is nested {depth} deep, at most {MAXIMUM_NESTING} are allowed")]
    NestedTooDeep {
        /// Index number.
        number: i64,
        /// The depth it would have.
        depth: usize,
    },
    /// COPY names an index that no INDEX before it opened.
    #[error("COPY {number} without INDEX {number} before it")]
    CopyWithoutIndex {
        /// Index number.
        number: i64,
    },
    /// INDEX/n,NOMORE without INDEX/n open.
    #[error("INDEX {number},NOMORE without INDEX {number}")]
    EndWithoutIndex {
        /// Index number.
        number: i64,
    },
    /// Ranges overlap without one holding the other.
    #[error("the range of INDEX {number} overlaps that of INDEX {open}")]
    Overlap {
        /// Index number of the statement.
        number: i64,
        /// The inner range that is still open.
        open: i64,
    },
    /// INDEX with a number that an INDEX before it has.
    #[error("INDEX {number} was given before")]
    IndexReused {
        /// Index number.
        number: i64,
    },
    /// More INDEX statements than allowed.
    #[error("more than {limit} INDEX statements")]
    TooManyIndexes {
        /// How many are allowed.
        limit: usize,
    },
    /// More COPY statements for one INDEX than allowed.
    #[error("more than {MAXIMUM_COPIES_PER_INDEX} COPY statements name INDEX {number}")]
    TooManyCopies {
        /// Index number.
        number: i64,
    },
    /// COPY with a count of zero: nothing is copied.
    #[error("COPY {number} with a count of zero")]
    ZeroCount {
        /// Index number.
        number: i64,
    },
    /// The copies would exceed the budget of records.
    #[error("COPY {number} would make more than {limit} records")]
    TooManyRecords {
        /// Index number.
        number: i64,
        /// The budget.
        limit: usize,
    },
    /// The copies would make the path longer than allowed.
    #[error("COPY {number} would make more than {limit} positions")]
    TooManyPoints {
        /// Index number.
        number: i64,
        /// How many are allowed.
        limit: u64,
    },
    /// A transform squeezes a tool axis to nothing.
    #[error("the transformed tool axis has no direction")]
    AxisVanishes {
        /// The axis before the transform.
        axis: [f64; 3],
    },
    /// A transform makes a coordinate that is not a finite number.
    #[error("the transformed position is not finite")]
    NotFinite {
        /// The position before the transform.
        position: [f64; 3],
    },
    /// VTLAXS or WCORN.
    #[error(transparent)]
    Tilt(#[from] TiltError),
}

impl EditErrorKind {
    /// The number of the APT III edit phase message, where there is one.
    pub fn apt3(&self) -> Option<u16> {
        match self {
            EditErrorKind::TooManyIndexes { .. } => Some(4),
            EditErrorKind::NestedTooDeep { .. } => Some(5),
            EditErrorKind::CopyWithoutIndex { .. }
            | EditErrorKind::EndWithoutIndex { .. }
            | EditErrorKind::Overlap { .. }
            | EditErrorKind::IndexReused { .. }
            | EditErrorKind::TooManyCopies { .. } => Some(11),
            EditErrorKind::AxisVanishes { .. } => Some(37),
            EditErrorKind::Tilt(error) => error.apt3(),
            EditErrorKind::ZeroCount { .. }
            | EditErrorKind::TooManyRecords { .. }
            | EditErrorKind::TooManyPoints { .. }
            | EditErrorKind::NotFinite { .. } => None,
        }
    }
}
