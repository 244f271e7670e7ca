//! Why a SMIL stops.

use crate::{contact::NoContact, guide::GuideError, tool::NoPlaceOnTool};

/// Why a SMIL could not be carried out, or not to its end.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MillingError {
    /// No first contact with the part surface (3551).
    #[error("no contact with the part surface at the start, {parameters:?}: {cause}")]
    NoFirstContact {
        /// Global parameters of the guide.
        parameters: [f64; 2],
        /// What was in the way.
        cause: StationError,
    },
    /// The step was shortened too often (3552).
    #[error("the step was shortened {reductions} times after {parameters:?}: {cause}")]
    TooManyReductions {
        /// Global parameters of the last location.
        parameters: [f64; 2],
        /// How often.
        reductions: usize,
        /// Why at last.
        cause: Reduction,
    },
    /// More locations than there may be (3553).
    #[error("more than {most} locations")]
    TooManyLocations {
        /// The limit.
        most: usize,
    },
    /// The path is longer than it may be (3554).
    #[error("the path is longer than {most}")]
    TooLong {
        /// The limit, program units.
        most: f64,
    },
    /// The starting parameters lie outside of the range of the guide (3563).
    #[error("the start {parameters:?} lies outside of the range of the guide")]
    OutsideRange {
        /// Global parameters.
        parameters: [f64; 2],
    },
    /// There is no cutter (3566).
    #[error("no cutter has been defined")]
    NoCutter,
    /// The part surface is no sculptured surface, or a surface to be checked is none (3567).
    #[error("{name} is no sculptured surface")]
    NotSculptured {
        /// Its name.
        name: String,
    },
    /// The guide does not serve (3567).
    #[error(transparent)]
    Guide(#[from] GuideError),
    /// The clearance plane lies along the direction in which the tool should reach it (3567).
    #[error("the tool does not reach the plane: it runs along it")]
    PlaneNotReached,
    /// A guide curve has no passes side by side (3567).
    #[error("a guide curve has one pass only")]
    CurveHasOnePass,
    /// Somebody wanted no more of it.
    #[error("given up")]
    Cancelled,
}

/// Why there is no tool location for a guide point.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum StationError {
    /// The guide gives none.
    #[error(transparent)]
    Guide(#[from] GuideError),
    /// No contact.
    #[error(transparent)]
    Contact(#[from] NoContact),
    /// The tool has no place for it.
    #[error(transparent)]
    Tool(#[from] NoPlaceOnTool),
    /// The axis of the tool is not defined.
    #[error("the tool axis has no direction")]
    NoAxis,
}

/// Why a step was shortened.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Reduction {
    /// There was no location.
    #[error(transparent)]
    Station(StationError),
    /// The surface is more sharply concave than the tool.
    #[error("the surface has the radius {radius}, the tool {tool}")]
    Misfit {
        /// Radius of curvature.
        radius: f64,
        /// Radius of the tool at the contact, stock included.
        tool: f64,
    },
    /// The tool moved too far.
    #[error("the tool moved {moved}, {allowed} is allowed")]
    TooFar {
        /// By how much, program units.
        moved: f64,
        /// By how much it may.
        allowed: f64,
    },
    /// The chord leaves the tolerance band (GOUGCK).
    #[error("the chord is {deviation} from the surface")]
    Chord {
        /// Distance of the tool from the surface, negative inside; program units.
        deviation: f64,
    },
}

impl MillingError {
    /// The number of the public system.
    pub fn number(&self) -> Option<u16> {
        Some(match self {
            Self::NoFirstContact { .. } => 3551,
            Self::TooManyReductions { .. } => 3552,
            Self::TooManyLocations { .. } => 3553,
            Self::TooLong { .. } => 3554,
            Self::OutsideRange { .. } => 3563,
            Self::NoCutter => 3566,
            Self::NotSculptured { .. } | Self::Guide(_) | Self::PlaneNotReached | Self::CurveHasOnePass => {
                3567
            }
            Self::Cancelled => return None,
        })
    }
}
