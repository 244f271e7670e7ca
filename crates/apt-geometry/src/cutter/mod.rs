//! The seven-parameter cutter of APT (arelem reference 1.3).

use serde::{Deserialize, Serialize};

/// The seven numbers of CUTTER, completed: lengths in the part program's unit, angles in radians.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cutter {
    /// Diameter where lower and upper line meet.
    pub diameter: f64,
    /// Corner radius `r`.
    pub corner_radius: f64,
    /// Distance `e` of the corner centre from the axis.
    pub corner_offset: f64,
    /// Height `f` of the corner centre above the tool end.
    pub corner_height: f64,
    /// Angle of the lower line from the plane normal to the axis, radians.
    pub alpha: f64,
    /// Angle of the upper line from the axis, leaning outward, radians.
    pub beta: f64,
    /// Height of the top.
    pub height: f64,
}
