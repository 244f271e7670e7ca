//! A sculptured surface: patches with their arrangement.

use serde::{Deserialize, Serialize};

use super::{
    patch::{Patch, PatchNormal, PatchPoint},
    topology::Neighbour,
};
use crate::canonical::Matrix;

/// A parameter that lies outside its range by less than this belongs to its end: operands are decimal numbers.
const PARAMETER_SLACK: f64 = 1e-12;

/// The splines a surface was made from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Mesh {
    /// Splines, which run along u.
    pub splines: usize,
    /// Cross splines, which run along v.
    pub cross_splines: usize,
}

/// A surface of rational bicubic patches.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SculpturedSurface {
    /// The patches; in a grid patch `row · columns + column`.
    pub patches: Vec<Patch>,
    /// Number of patches along u (columns) and along v (rows), if they form a grid whose global parameters run
    /// through. Other surfaces count their patches along u.
    pub grid: Option<(usize, usize)>,
    /// What lies beyond the edges of each patch, by the number of the edge.
    pub neighbours: Vec<[Option<Neighbour>; 4]>,
    /// The sign word of the definition: +1 where `∂u × ∂v` is the natural normal, −1 where it is turned over.
    pub side: f64,
    /// The splines the surface was made from; zero where it was made otherwise.
    pub mesh: Mesh,
}

impl SculpturedSurface {
    /// The greatest global parameters; they begin at 0.
    pub fn extent(&self) -> [f64; 2] {
        let (columns, rows) = self.grid.unwrap_or((self.patches.len(), 1));
        [columns as f64, rows as f64]
    }

    /// The patch (index) and its local parameters at global ones; `None` outside the surface.
    pub fn locate(&self, u: f64, v: f64) -> Option<(usize, f64, f64)> {
        let (columns, rows) = self.grid.unwrap_or((self.patches.len(), 1));
        let (column, u) = cell(u, columns)?;
        let (row, v) = cell(v, rows)?;
        let index = row * columns + column;
        (index < self.patches.len()).then_some((index, u, v))
    }

    /// The global parameters of local ones of a patch (index).
    pub fn globally(&self, patch: usize, u: f64, v: f64) -> [f64; 2] {
        let columns = self.grid.map_or(self.patches.len(), |grid| grid.0).max(1);
        [(patch % columns) as f64 + u, (patch / columns) as f64 + v]
    }

    /// The place at global parameters with the derivatives by them; `None` outside the surface.
    pub fn evaluate_global(&self, u: f64, v: f64) -> Option<PatchPoint> {
        let (patch, u, v) = self.locate(u, v)?;
        self.patches.get(patch).map(|patch| patch.evaluate(u, v))
    }

    /// The unit normal at global parameters, along `∂u × ∂v`: the side is not applied.
    pub fn normal_global(&self, u: f64, v: f64) -> Option<PatchNormal> {
        let (patch, u, v) = self.locate(u, v)?;
        self.patches.get(patch).map(|patch| patch.normal(u, v))
    }

    /// The image under an affine map.
    pub fn transformed(&self, matrix: &Matrix) -> SculpturedSurface {
        SculpturedSurface {
            patches: self.patches.iter().map(|patch| patch.transformed(matrix)).collect(),
            ..self.clone()
        }
    }
}

/// The cell of a row of `count` and the parameter in it.
fn cell(parameter: f64, count: usize) -> Option<(usize, f64)> {
    let end = count as f64;
    if count == 0 || !(parameter >= -PARAMETER_SLACK && parameter <= end + PARAMETER_SLACK * end.max(1.0)) {
        return None;
    }
    let parameter = parameter.clamp(0.0, end);
    let index = (parameter as usize).min(count - 1);
    Some((index, parameter - index as f64))
}
