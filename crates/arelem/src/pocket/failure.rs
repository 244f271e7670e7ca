//! Why a pocket cannot be computed.

use apt_geometry::{Vec3, canonical::GeometryKind};

/// What is wrong with the points of a pocket.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CornerFault {
    /// The point and one that the statement names earlier are the same (3501).
    Duplicate {
        /// Index of the earlier one.
        other: usize,
    },
    /// The point lies on the line through its neighbours (3502).
    Collinear,
    /// The sides at the point are not in the plane of the others (3503).
    NotInPlane,
    /// The figure turns the other way at the point, or goes round more than once (3504).
    Concave,
}

/// Why POCKET gives no path. Lengths in program units.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PocketFailure {
    /// The points make no convex polygon in a plane (3501 to 3504).
    #[error("corner {corner}: {fault:?}")]
    Corner {
        /// Index of the point in the statement.
        corner: usize,
        /// Where it is, after projection.
        at: Vec3,
        /// What is wrong there.
        fault: CornerFault,
    },
    /// The tool axis lies nearly in the plane of the pocket or of the part surface (3507).
    #[error("tool axis in the plane: sine {sine}")]
    AxisInPlane {
        /// Sine of the angle between the axis and the plane.
        sine: f64,
    },
    /// The cutter has no radius, or there is no cutter (3510).
    #[error("cutter radius {radius}")]
    CutterRadius {
        /// Its radius.
        radius: f64,
    },
    /// The effective radius is negative (3511).
    #[error("effective radius {value}")]
    NegativeEffectiveRadius {
        /// The number of the statement.
        value: f64,
    },
    /// The offset factor (3512) or the finishing factor (3513) is negative.
    #[error("offset factor {value}")]
    NegativeOffset {
        /// The number of the statement.
        value: f64,
        /// It is the finishing factor.
        finish: bool,
    },
    /// A feed is negative (3514).
    #[error("feed {value}")]
    NegativeFeed {
        /// The number of the statement.
        value: f64,
    },
    /// The kind of the points is none of 0 to 3 (3516).
    #[error("point kind {kind}")]
    PointKind {
        /// The number of the statement.
        kind: u8,
    },
    /// The cutter does not fit between the sides (3518).
    #[error("radius {radius} does not fit; greatest {greatest}")]
    DoesNotFit {
        /// Radius of the cutter.
        radius: f64,
        /// The greatest radius that would fit.
        greatest: f64,
    },
    /// The points are to be projected on a part surface that is no plane (3519).
    #[error("{kind:?} as part surface")]
    PartNotPlane {
        /// What it is.
        kind: GeometryKind,
    },
    /// The passes come no nearer to the middle: the offset factor is zero.
    #[error("no offset between the passes")]
    NoOffset,
    /// The offset is so small that there would be too many passes.
    #[error("more than {limit} passes with offset {offset}")]
    TooManyPasses {
        /// The bound.
        limit: usize,
        /// Distance between two passes.
        offset: f64,
    },
}

impl PocketFailure {
    /// The APT III diagnostic number. APT III does not end when the offset is zero.
    pub fn apt3(&self) -> Option<u16> {
        Some(match self {
            Self::Corner { fault, .. } => match fault {
                CornerFault::Duplicate { .. } => 3501,
                CornerFault::Collinear => 3502,
                CornerFault::NotInPlane => 3503,
                CornerFault::Concave => 3504,
            },
            Self::AxisInPlane { .. } => 3507,
            Self::CutterRadius { .. } => 3510,
            Self::NegativeEffectiveRadius { .. } => 3511,
            Self::NegativeOffset { finish: false, .. } => 3512,
            Self::NegativeOffset { finish: true, .. } => 3513,
            Self::NegativeFeed { .. } => 3514,
            Self::PointKind { .. } => 3516,
            Self::DoesNotFit { .. } => 3518,
            Self::PartNotPlane { .. } => 3519,
            Self::NoOffset | Self::TooManyPasses { .. } => return None,
        })
    }
}
