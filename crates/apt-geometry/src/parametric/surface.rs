//! A sculptured surface: patches with their arrangement.

use serde::{Deserialize, Serialize};

use super::{
    patch::{Patch, PatchNormal, PatchPoint},
    topology::{self, Neighbour},
};
use crate::{Vec3, canonical::Matrix};

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
    /// Global values of u where the columns end, beginning with 0; empty where each column is one unit long. Several
    /// columns may make one segment of a lofted surface: its patches are counted as one.
    pub breaks: Vec<f64>,
    /// The same for v, where the rows end: several rows may lie between two curves of a lofted surface.
    pub row_breaks: Vec<f64>,
    /// What lies beyond the edges of each patch, by the number of the edge.
    pub neighbours: Vec<[Option<Neighbour>; 4]>,
    /// The sign word of the definition: +1 where `∂u × ∂v` is the natural normal, −1 where it is turned over.
    pub side: f64,
    /// The splines the surface was made from; zero where it was made otherwise.
    pub mesh: Mesh,
}

impl SculpturedSurface {
    /// A surface with its topology.
    pub fn assembled(
        patches: Vec<Patch>,
        grid: Option<(usize, usize)>,
        breaks: Vec<f64>,
        side: f64,
        mesh: Mesh,
    ) -> SculpturedSurface {
        let neighbours = topology::neighbours(&patches);
        SculpturedSurface { patches, grid, breaks, row_breaks: Vec::new(), neighbours, side, mesh }
    }

    /// The surface with rows that end at these global values of v.
    pub fn with_row_breaks(self, row_breaks: Vec<f64>) -> SculpturedSurface {
        SculpturedSurface { row_breaks, ..self }
    }

    fn columns_rows(&self) -> (usize, usize) {
        self.grid.unwrap_or((self.patches.len(), 1))
    }

    /// The greatest global parameters; they begin at 0.
    pub fn extent(&self) -> [f64; 2] {
        let (columns, rows) = self.columns_rows();
        let last = |breaks: &[f64], count: usize| breaks.last().copied().unwrap_or(count as f64);
        [last(&self.breaks, columns), last(&self.row_breaks, rows)]
    }

    /// First and last global parameters of a patch (index), along u and along v.
    fn ranges(&self, patch: usize) -> [[f64; 2]; 2] {
        let columns = self.columns_rows().0.max(1);
        [range(&self.breaks, patch % columns), range(&self.row_breaks, patch / columns)]
    }

    /// The global values of u where the patches end, one after the other in a single row. Each row of patches counts as a
    /// whole one.
    pub fn flat_breaks(&self) -> Vec<f64> {
        let (columns, rows) = self.columns_rows();
        let [width, _] = self.extent();
        let mut breaks = vec![0.0];
        for row in 0..rows {
            breaks.extend((0..columns).map(|column| row as f64 * width + range(&self.breaks, column)[1]));
        }
        breaks
    }

    /// The patch (index) and its local parameters at global ones; `None` outside the surface.
    pub fn locate(&self, u: f64, v: f64) -> Option<(usize, f64, f64)> {
        let (columns, rows) = self.columns_rows();
        let (column, u) = part(u, &self.breaks, columns)?;
        let (row, v) = part(v, &self.row_breaks, rows)?;
        let index = row * columns + column;
        (index < self.patches.len()).then_some((index, u, v))
    }

    /// The global parameters of local ones of a patch (index).
    pub fn globally(&self, patch: usize, u: f64, v: f64) -> [f64; 2] {
        let [along, across] = self.ranges(patch);
        [along[0] + (along[1] - along[0]) * u, across[0] + (across[1] - across[0]) * v]
    }

    /// How many patches the language counts: those of a segment are one.
    pub fn count(&self) -> usize {
        let [u, v] = self.extent();
        (u * v).round() as usize
    }

    /// The number that the language gives a patch (from 1) and the local parameters there, from global parameters.
    pub fn numbered(&self, u: f64, v: f64) -> Option<(usize, [f64; 2])> {
        let [width, rows] = self.extent();
        let (columns, rows) = (width.round() as usize, rows.round() as usize);
        let ((column, u), (row, v)) = (cell(u, columns)?, cell(v, rows)?);
        Some((row * columns + column + 1, [u, v]))
    }

    /// The global parameters of local ones of a patch as the language numbers it (from 1).
    pub fn unnumbered(&self, number: usize, u: f64, v: f64) -> [f64; 2] {
        let columns = (self.extent()[0].round() as usize).max(1);
        let index = number.saturating_sub(1);
        [(index % columns) as f64 + u, (index / columns) as f64 + v]
    }

    /// Greatest extent of the box of the control points.
    pub fn size(&self) -> f64 {
        let [low, high] = self.bounds();
        (high - low).norm()
    }

    /// The box of the control points, which holds the surface: least and greatest coordinates.
    pub fn bounds(&self) -> [Vec3; 2] {
        let start = [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)];
        let points = self.patches.iter().flat_map(Patch::points).flatten();
        points.fold(start, |[low, high], point| [low.inf(&point), high.sup(&point)])
    }

    /// Whether all numbers are finite and all weights positive.
    pub fn is_finite(&self) -> bool {
        let mut points = self.patches.iter().flat_map(|patch| patch.control).flatten();
        points.all(|point| point.iter().all(|number| number.is_finite()) && point.w > 0.0)
    }

    /// The place at global parameters with the derivatives by them; `None` outside the surface.
    pub fn evaluate_global(&self, u: f64, v: f64) -> Option<PatchPoint> {
        let (index, u, v) = self.locate(u, v)?;
        let mut at = self.patches.get(index)?.evaluate(u, v);
        let [by_u, by_v] = self.ranges(index).map(|[first, last]| 1.0 / (last - first));
        if by_u != 1.0 {
            (at.du, at.duv, at.duu) = (at.du * by_u, at.duv * by_u, at.duu * (by_u * by_u));
        }
        if by_v != 1.0 {
            (at.dv, at.duv, at.dvv) = (at.dv * by_v, at.duv * by_v, at.dvv * (by_v * by_v));
        }
        Some(at)
    }

    /// The unit normal at global parameters, along `∂u × ∂v`: the side is not applied.
    pub fn normal_global(&self, u: f64, v: f64) -> Option<PatchNormal> {
        let (patch, u, v) = self.locate(u, v)?;
        self.patches.get(patch).map(|patch| patch.normal(u, v))
    }

    /// The unit tangents along u and along v at global parameters; on an edge that is one point their limits from inside, null where there is none.
    pub fn tangents_global(&self, u: f64, v: f64) -> Option<[Vec3; 2]> {
        let (patch, u, v) = self.locate(u, v)?;
        self.patches.get(patch).map(|patch| patch.tangents(u, v))
    }

    /// The image under an affine map.
    pub fn transformed(&self, matrix: &Matrix) -> SculpturedSurface {
        SculpturedSurface {
            patches: self.patches.iter().map(|patch| patch.transformed(matrix)).collect(),
            ..self.clone()
        }
    }
}

/// First and last global parameter of a column or a row: its breaks, or one unit.
fn range(breaks: &[f64], index: usize) -> [f64; 2] {
    match (breaks.get(index), breaks.get(index + 1)) {
        (Some(first), Some(last)) => [*first, *last],
        _ => [index as f64, index as f64 + 1.0],
    }
}

/// The column or row of `count` at a global parameter, and the parameter in it.
fn part(parameter: f64, breaks: &[f64], count: usize) -> Option<(usize, f64)> {
    let Some(&end) = breaks.last() else { return cell(parameter, count) };
    if !(parameter >= -PARAMETER_SLACK && parameter <= end + PARAMETER_SLACK * end.max(1.0)) {
        return None;
    }
    let index = breaks.partition_point(|end| *end <= parameter).clamp(1, count.max(1)) - 1;
    let [first, last] = range(breaks, index);
    Some((index, ((parameter - first) / (last - first)).clamp(0.0, 1.0)))
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
