//! The independent proof that a cut sequence keeps its tolerances (arelem reference 6.1). It shares no contact code
//! with the engine: only `sequence`, canonical forms and the cutter's seven numbers.
//!
//! The clearance of the whole tool is measured by tangent planes and supports, the extremes over a cut vector by
//! convexity ([`span`]); the stop by replaying the path against the check surface ([`stop`]).

mod beside;
mod bow;
mod circle_contact;
mod clearance;
mod directrix;
mod followed;
mod halves;
mod hand;
mod judge;
mod leaning;
mod models;
mod patch;
mod pencil;
mod pocket;
mod poly_conic;
mod quadric;
mod quadric_clearance;
mod roundness;
mod ruled;
mod ruling;
mod ruling_clearance;
mod sculptured;
mod section;
mod shadow;
mod span;
mod stop;
mod straight_contact;
mod strip;
mod survey;
mod tool;
mod trough;
mod vertex;
mod weighed;

#[cfg(test)]
pub(crate) mod tests;

use apt_geometry::canonical::GeometryKind;
use serde::Serialize;

#[cfg(test)]
pub(crate) use tool::WORK;

pub use judge::verify;
pub use pocket::verify_pocket;

/// Extreme signed clearances of one role over the whole of every cut vector, and the band they must lie in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Extent {
    /// Least clearance (most negative = deepest cut).
    pub min: f64,
    /// Greatest clearance.
    pub max: f64,
    /// Allowed depth. For ON the wider of INTOL and OUTTOL, which counts on both sides (arelem reference 1.6).
    pub intol: f64,
    /// Allowed stock. For ON the wider of INTOL and OUTTOL.
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
    /// Why not, if not: what is broken and where. Each rule is named once, at its worst place.
    pub violations: Vec<Violation>,
}

/// One broken promise.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Violation {
    /// Which rule is broken.
    pub rule: Rule,
    /// Index of the cut vector (0 = from the start to the first point).
    pub vector: usize,
    /// The measured value: a clearance for the bands, the number of the position really reached (0: none) for the stop,
    /// the sine of an angle for tangency, side and progress, a length for the step.
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
    Cleared,
}

/// Why a sequence could not be judged. None of these says that it is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VerifyError {
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// The verifier has no model of this kind of surface.
    #[error("no model of {kind:?}")]
    Unsupported {
        /// The kind of the surface.
        kind: GeometryKind,
    },
    /// The canonical form describes no surface.
    #[error("{kind:?} without a surface")]
    Degenerate {
        /// The kind of the surface.
        kind: GeometryKind,
    },
    /// The seven numbers describe no convex tool.
    #[error("impossible cutter")]
    Cutter,
    /// A position, axis or limit is not finite, or an axis has no length.
    #[error("a number of the sequence is not finite")]
    NotFinite,
    /// There is no distance to a surface at a place of the path.
    #[error("no distance to a surface on vector {vector}")]
    NoDistance {
        /// Index of the cut vector.
        vector: usize,
    },
    /// The sequence has no positions.
    #[error("a sequence without positions")]
    Empty,
    /// The proof was given up after this many steps.
    #[error("no proof after {limit} steps")]
    Effort {
        /// The bound.
        limit: usize,
    },
}

impl VerifyError {
    /// The APT III diagnostic with the same meaning: none, APT III had no verifier.
    pub fn apt3(&self) -> Option<u16> {
        None
    }
}
