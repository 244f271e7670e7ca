//! The independent proof that a cut sequence keeps its tolerances (arelem reference 6.1). It shares no contact code
//! with the engine: only `sequence`, canonical forms and the cutter's seven numbers.

use serde::Serialize;

/// Extreme signed clearances of one role over the whole of every cut vector, and the band they must lie in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Extent {
    /// Least clearance (most negative = deepest cut).
    pub min: f64,
    /// Greatest clearance.
    pub max: f64,
    /// Allowed depth.
    pub intol: f64,
    /// Allowed stock.
    pub outtol: f64,
}

/// What the verifier found for a sequence.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evidence {
    /// Part surface, if the sequence is bound to one.
    pub part: Option<Extent>,
    /// Drive surface, if the sequence is bound to one.
    pub drive: Option<Extent>,
    /// Check surface, at the last point.
    pub check: Option<Extent>,
    /// Everything the sequence promises was proven.
    pub verified: bool,
    /// Why not, if not: what is broken and where.
    pub violations: Vec<Violation>,
}

/// One broken promise.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Violation {
    /// Which rule is broken.
    pub rule: Rule,
    /// Index of the cut vector (0 = from the start to the first point).
    pub vector: usize,
    /// The measured value (clearance, angle, length …).
    pub value: f64,
}

/// The rules of 6.1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Rule {
    PartBand,
    DriveBand,
    CheckBand,
    StopEvent,
    Tangency,
    Side,
    Progress,
    StepLength,
}
