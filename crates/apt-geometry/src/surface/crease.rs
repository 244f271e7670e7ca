//! Lines on which a surface has an edge that stands out to one side. A tool may touch such a line as it touches a wire.

use super::{Place, Surface};
use crate::{Vec3, parametric::Edge};

/// A line at a side of a patch on which a surface has an edge; places of it have a parameter from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crease {
    pub(super) piece: usize,
    pub(super) edge: Edge,
}

/// Unit directions at a place where a surface ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceEdge {
    /// The natural normal.
    pub normal: Vec3,
    /// Straight on over the end.
    pub outward: Vec3,
    /// Along it.
    pub along: Vec3,
}

impl Surface {
    /// The end that the place nearest to a point lies on, for surfaces that tell directions there.
    pub fn edge_at(&self, p: &Vec3) -> Option<SurfaceEdge> {
        match self {
            Self::Sculptured(sheet) => sheet.edge_at(p),
            _ => None,
        }
    }

    /// The line that stands out to a side, positive for that of the natural normal, on which a place lies, and its parameter there.
    pub fn crease_at(&self, place: &Place, side: f64) -> Option<(Crease, f64)> {
        match self {
            Self::Sculptured(sheet) => sheet.crease_at(place, side),
            _ => None,
        }
    }

    /// The lines about a place that stand out to a side, each with its parameter beside the place.
    pub fn creases_beside(&self, place: &Place, side: f64) -> [Option<(Crease, f64)>; 4] {
        match self {
            Self::Sculptured(sheet) => sheet.creases_beside(place, side),
            _ => [None; 4],
        }
    }

    /// The place of such a line at a parameter.
    pub fn on_crease(&self, crease: &Crease, parameter: f64) -> Place {
        Place { piece: crease.piece, at: crease.edge.parameters(parameter) }
    }

    /// Which derivative by the parameters of a place, the first or the second, is that along such a line.
    pub fn along_crease(&self, crease: &Crease) -> usize {
        usize::from(matches!(crease.edge, Edge::LowU | Edge::HighU))
    }
}
