//! Findings of Section 1: what is wrong or doubtful, where, and the evidence. Words are made elsewhere.

mod control;
mod evidence;
mod kind;
mod number;
mod sculptured;

use apt_syntax::dialect::DialectName;

use crate::record::Origin;

pub use control::ControlFinding;
pub use evidence::{ConditionBlock, Expected, Found, SynonymFault};
pub use kind::FindingKind;
pub use sculptured::SculpturedFinding;

/// Something to tell the programmer.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What it is, with the evidence.
    pub kind: FindingKind,
    /// How bad it is unless the project says otherwise.
    pub severity: Severity,
    /// The diagnostic number of the dialect in force (APT III or APT4), where there is one.
    pub number: Option<u16>,
    /// Where it is.
    pub origin: Origin,
    /// Other places that matter.
    pub related: Vec<(RelatedKind, Origin)>,
}

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Severity {
    Hint,
    Information,
    Warning,
    Error,
}

/// What a related place is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RelatedKind {
    /// The name is defined here.
    Definition,
    /// The array is reserved here.
    Reservation,
    /// The macro is defined here.
    Macro,
    /// The loop begins here.
    Loop,
    /// The label stands here.
    Label,
    /// The last branch of the IF begins here.
    Branch,
    /// The motion statement that waits for its check surface.
    WaitingMotion,
}

impl Finding {
    /// A finding with the number and the severity that it has in a dialect.
    pub(crate) fn new(kind: FindingKind, dialect: DialectName, origin: Origin) -> Self {
        let (severity, number) = (kind.severity_in(dialect), kind.number(dialect));
        Self { kind, severity, number, origin, related: Vec::new() }
    }
}
