//! What the caller decides about an evaluation: budgets and where included files come from.

use std::{fmt, path::Path, sync::Arc};

use smol_str::SmolStr;

use crate::record::SourceFile;

/// Limits that make every evaluation end, and the resolver of INCLUD.
#[derive(Clone)]
pub struct Options {
    /// Most statements that one top-level loop, macro call or included file may execute, and most that jumps at the top
    /// level execute again. What is executed once is bounded by the text.
    pub statement_budget: u64,
    /// Deepest nesting of macro calls and included files; the `apt3` dialect has its own limit of five.
    pub macro_depth: u32,
    /// Most jumps that are still taken in a loop or macro body after an error in it.
    pub jumps_after_error: u32,
    /// Finds the program text of an INCLUD statement.
    pub include: Option<Arc<dyn IncludeResolver>>,
}

/// Finds included program text.
pub trait IncludeResolver: Send + Sync {
    /// The file that INCLUD names, parsed.
    ///
    /// # Errors
    ///
    /// [`IncludeFailure`] when there is no such file, or it cannot be read.
    fn resolve(&self, name: &str) -> Result<Arc<SourceFile>, IncludeFailure>;

    /// Whether this is the file of the program itself, which must not include itself.
    fn is_program(&self, _path: &Path) -> bool {
        false
    }
}

/// Why a file cannot be included.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum IncludeFailure {
    /// No folder that is searched has a file of this name.
    NotFound {
        /// The folders, in the order in which they are searched.
        searched: Vec<SmolStr>,
    },
    /// The file is there and cannot be read.
    Unreadable {
        /// Where it is.
        path: SmolStr,
        /// What the system says.
        reason: SmolStr,
    },
    /// The file is no part program: it is larger than any could be.
    TooLarge {
        /// Where it is.
        path: SmolStr,
        /// The largest that is taken, bytes.
        limit: u64,
    },
}

/// Statements that one top-level loop or macro call may execute by default.
pub const DEFAULT_STATEMENT_BUDGET: u64 = 2_000_000;
/// Nesting of macro calls by default.
pub const DEFAULT_MACRO_DEPTH: u32 = 50;
/// Nesting of macro calls in APT III (language reference 1.10).
pub const APT3_MACRO_DEPTH: u32 = 5;
/// Jumps after an error by default: enough to finish an ordinary loop, too few to notice an endless one.
pub const DEFAULT_JUMPS_AFTER_ERROR: u32 = 1_000;

impl Default for Options {
    fn default() -> Self {
        Self {
            statement_budget: DEFAULT_STATEMENT_BUDGET,
            macro_depth: DEFAULT_MACRO_DEPTH,
            jumps_after_error: DEFAULT_JUMPS_AFTER_ERROR,
            include: None,
        }
    }
}

impl fmt::Debug for Options {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Options")
            .field("statement_budget", &self.statement_budget)
            .field("macro_depth", &self.macro_depth)
            .field("jumps_after_error", &self.jumps_after_error)
            .field("include", &self.include.is_some())
            .finish()
    }
}
