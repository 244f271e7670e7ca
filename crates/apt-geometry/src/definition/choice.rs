//! Directional words: which way, and which of two solutions.

use super::{Impossible, Modifier};
use crate::Vec3;
use crate::canonical::Plane;
use crate::canonical::matrix::CoordinatePlane;

/// Component of a unit vector below which it points neither way (APT III's zero-vector test).
pub(super) const ZERO_COMPONENT: f64 = 1e-6;

/// The words that choose by x or y.
pub(super) const X_OR_Y: &[Modifier] =
    &[Modifier::XLarge, Modifier::XSmall, Modifier::YLarge, Modifier::YSmall];

/// The words that choose by x, y or z.
pub(super) const X_Y_OR_Z: &[Modifier] = &[
    Modifier::XLarge,
    Modifier::XSmall,
    Modifier::YLarge,
    Modifier::YSmall,
    Modifier::ZLarge,
    Modifier::ZSmall,
];

/// The words for the sense of a vector.
pub(super) const SENSES: &[Modifier] = &[
    Modifier::PositiveX,
    Modifier::PositiveY,
    Modifier::PositiveZ,
    Modifier::NegativeX,
    Modifier::NegativeY,
    Modifier::NegativeZ,
];

/// The words for the coordinate planes.
pub(super) const PLANES: &[Modifier] = &[Modifier::XyPlane, Modifier::YzPlane, Modifier::ZxPlane];

/// A sense along a coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Toward {
    word: Modifier,
    axis: usize,
    sign: f64,
}

impl Toward {
    /// The sense that a word names; `None` for words that name none.
    pub(super) fn from_word(word: Modifier) -> Option<Toward> {
        let (axis, sign) = match word {
            Modifier::XLarge | Modifier::PositiveX => (0, 1.0),
            Modifier::XSmall | Modifier::NegativeX => (0, -1.0),
            Modifier::YLarge | Modifier::PositiveY => (1, 1.0),
            Modifier::YSmall | Modifier::NegativeY => (1, -1.0),
            Modifier::ZLarge | Modifier::PositiveZ => (2, 1.0),
            Modifier::ZSmall | Modifier::NegativeZ => (2, -1.0),
            _ => return None,
        };
        Some(Toward { word, axis, sign })
    }

    /// How far `vector` goes in this sense.
    pub(super) fn component(&self, vector: &Vec3) -> f64 {
        self.sign * vector[self.axis]
    }

    /// The unit vector or its opposite, whichever goes in this sense.
    pub(super) fn orient(&self, unit: Vec3) -> Result<Vec3, Impossible> {
        let component = self.component(&unit);
        if component.abs() <= ZERO_COMPONENT { Err(self.undecided()) } else { Ok(unit * component.signum()) }
    }

    /// The plane or its reverse, whichever has a normal in this sense.
    pub(super) fn orient_plane(&self, plane: Plane) -> Result<Plane, Impossible> {
        let component = self.component(&plane.normal);
        if component.abs() <= ZERO_COMPONENT {
            Err(self.undecided())
        } else {
            Ok(if component > 0.0 { plane } else { plane.reversed() })
        }
    }

    /// The error of a word that does not tell the two solutions apart.
    pub(super) fn undecided(&self) -> Impossible {
        Impossible::Undecided { word: self.word }
    }
}

/// The coordinate plane of XYPLAN or XYROT and their like.
pub(super) fn coordinate_plane(word: Modifier) -> Option<CoordinatePlane> {
    match word {
        Modifier::XyPlane | Modifier::XyRotation => Some(CoordinatePlane::Xy),
        Modifier::YzPlane | Modifier::YzRotation => Some(CoordinatePlane::Yz),
        Modifier::ZxPlane | Modifier::ZxRotation => Some(CoordinatePlane::Zx),
        _ => None,
    }
}
