//! What COPY adds from one copy of a path to the next, in the words of the program.

use crate::{
    Vec3,
    canonical::{Matrix, matrix::CoordinatePlane},
};

/// What each copy of a COPY statement adds to the one before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CopyStep {
    /// SAME: nothing.
    Same,
    /// TRANSL: a shift, in the unit of the program.
    Translation(Vec3),
    /// XYROT: a turn about the z axis from x towards y, degrees.
    RotationAboutZ(f64),
    /// MODIFY: a matrix of the program.
    Matrix(Matrix),
}

impl CopyStep {
    /// The transform from one copy to the next; `None` where they are the same.
    pub fn matrix(&self) -> Option<Matrix> {
        match self {
            CopyStep::Same => None,
            CopyStep::Translation(by) => Some(Matrix::translation(*by)),
            CopyStep::RotationAboutZ(degrees) => Some(Matrix::rotation(CoordinatePlane::Xy, *degrees)),
            CopyStep::Matrix(matrix) => Some(*matrix),
        }
    }
}
