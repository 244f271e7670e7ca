//! The statements executed, for an expansion.

use apt_syntax::statement::Element;

use crate::record::Origin;

/// Collects executed statements.
#[derive(Debug, Default)]
pub(crate) struct Trace {
    /// The statements in order of execution.
    pub(crate) lines: Vec<TracedLine>,
}

/// One executed statement.
#[derive(Debug, Clone)]
pub(crate) struct TracedLine {
    /// Its elements after substitution, without its label.
    pub(crate) elements: Vec<Element>,
    /// Where it comes from.
    pub(crate) origin: Origin,
}
