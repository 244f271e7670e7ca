//! Reference systems (REFSYS) and geometry that remembers in which of them it was defined.

use std::sync::Arc;

use apt_geometry::canonical::{Geometry, Matrix};
use smol_str::SmolStr;

/// The matrix of a REFSYS statement, with its name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ReferenceSystem {
    /// The name of the matrix, empty for a nest.
    pub(crate) name: SmolStr,
    /// From this system to the base: `x' = M x`.
    pub(crate) matrix: Matrix,
    /// From the base to this system.
    pub(crate) inverse: Matrix,
}

impl ReferenceSystem {
    /// The system of this matrix, unless the matrix has no inverse.
    pub(crate) fn new(name: SmolStr, matrix: Matrix) -> Option<Self> {
        matrix.inverse().map(|inverse| Self { name, matrix, inverse })
    }
}

/// Geometry in the coordinates of the system in which it was defined; the stored form never changes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stored {
    /// The canonical form.
    pub(crate) geometry: Arc<Geometry>,
    /// The system; none for the base.
    pub(crate) system: Option<Arc<ReferenceSystem>>,
}

impl Stored {
    /// The geometry in the coordinates of `system`; none if it cannot be carried there.
    ///
    /// Systems are told apart by matrix name and value, as APT III compares names. A MATRIX is never carried.
    pub(crate) fn seen_from(&self, system: Option<&Arc<ReferenceSystem>>) -> Option<Arc<Geometry>> {
        if matches!(*self.geometry, Geometry::Matrix(_)) || self.system.as_ref() == system {
            return Some(Arc::clone(&self.geometry));
        }
        let mut geometry = Arc::clone(&self.geometry);
        if let Some(own) = &self.system {
            geometry = Arc::new(geometry.transform(&own.matrix).ok()?);
        }
        if let Some(target) = system {
            geometry = Arc::new(geometry.transform(&target.inverse).ok()?);
        }
        Some(geometry)
    }
}
