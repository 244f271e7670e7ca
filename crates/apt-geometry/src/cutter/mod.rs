//! The seven-parameter cutter of APT (arelem reference 1.3).

mod numbers;
mod profile;

use serde::{Deserialize, Serialize};

pub use numbers::{CutterError, CutterWarning};
pub use profile::{Profile, ProfilePoint};

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

/// A thin disk across the tool axis that takes the place of the cutter (CUTTER/OPTION, language reference 6.7).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Disk {
    /// Its radius, ≥ 0, in the part program's unit.
    pub radius: f64,
    /// How far it is above the tool end, along the tool axis; negative below it.
    pub height: f64,
}

impl Disk {
    /// The disk as a cutter whose end is the middle of the disk: a flat one without height.
    pub fn cutter(&self) -> Cutter {
        Cutter {
            diameter: 2.0 * self.radius,
            corner_radius: 0.0,
            corner_offset: 0.0,
            corner_height: 0.0,
            alpha: 0.0,
            beta: 0.0,
            height: 0.0,
        }
    }

    /// Greatest distance of a point of the disk from the tool end.
    pub fn reach(&self) -> f64 {
        self.radius.hypot(self.height)
    }
}

impl Cutter {
    /// Half the diameter, where lower and upper line meet.
    pub fn radius(&self) -> f64 {
        0.5 * self.diameter
    }

    /// Height of the point where lower and upper line meet.
    pub fn knee_height(&self) -> f64 {
        self.radius() * self.alpha.tan()
    }

    /// Radius of the upper line at the top.
    pub fn top_radius(&self) -> f64 {
        self.radius() + (self.height - self.knee_height()) * self.beta.tan()
    }

    /// The profile: vertices, corner arc and support function.
    pub fn profile(&self) -> Profile {
        Profile::new(self)
    }
}
