//! The place the evaluator stands at, its budgets, and the motion that waits for its check surface.

use std::sync::Arc;

use apt_geometry::motion::DriveSide;
use apt_syntax::SyntaxTree;
use smol_str::SmolStr;

use crate::record::{Frame, Origin, SourceFile};

/// Columns of a card before its sequence field.
const STATEMENT_COLUMNS: usize = 72;

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

/// The records behind the top-level step being executed: READ/1 takes cards from there.
#[derive(Debug, Clone, Default)]
pub(crate) struct DataCards {
    /// The statements; none before the first step.
    pub(crate) tree: Option<SyntaxTree>,
    /// The statement that the next card is.
    pub(crate) next: usize,
}

impl DataCards {
    /// The text of the next record; its sequence field is cut off.
    pub(crate) fn card(&mut self) -> Option<String> {
        let tree = self.tree.as_ref().filter(|tree| self.next < tree.statement_count())?;
        let view = tree.statement(self.next);
        let columns = if tree.sequence_field() { STATEMENT_COLUMNS } else { usize::MAX };
        self.next += 1;
        Some(view.text().trim_end().chars().take(columns).collect())
    }
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
