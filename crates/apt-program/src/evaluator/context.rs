//! The place the evaluator stands at, its budgets, and the motion that waits for its check surface.

use std::sync::Arc;

use apt_geometry::motion::DriveSide;
use smol_str::SmolStr;

use crate::record::{Frame, Origin, SourceFile};

/// The statement being executed.
#[derive(Debug, Clone, Default)]
pub(crate) struct Here {
    /// Its number.
    pub(crate) isn: u32,
    /// The macro call or loop turn around it.
    pub(crate) frame: Option<Arc<Frame>>,
    /// The included file that it stands in.
    pub(crate) source: Option<Arc<SourceFile>>,
    /// Its label.
    pub(crate) label: Option<SmolStr>,
    /// Whether jumps may be taken here.
    pub(crate) region: Region,
    /// How many macro calls and included files are around it.
    pub(crate) depth: u32,
}

/// What kind of region a statement stands in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Region {
    /// None: the top level of the program or of an included file.
    #[default]
    Top,
    /// A LOOPST region.
    Loop,
    /// A macro body.
    Macro,
}

/// What is left for the present top-level step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Budget {
    /// What there was.
    pub(crate) granted: u64,
    /// Statements that may still be executed in loops and macros.
    pub(crate) left: u64,
}

impl Budget {
    /// A budget of so many statements.
    pub(crate) fn new(statements: u64) -> Self {
        Self { granted: statements, left: statements }
    }
}

/// A directed motion without check surface: the drive surface of the next one will be it (arelem reference 3.2).
#[derive(Debug, Clone)]
pub(crate) struct PendingDrive {
    /// Index of its record in the output.
    pub(crate) record: usize,
    /// Where the tool was said to be when the motion was held.
    pub(crate) side: DriveSide,
    /// The statement.
    pub(crate) origin: Origin,
}
