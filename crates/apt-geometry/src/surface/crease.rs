//! Lines on which a surface has an edge that stands out to one side. A tool may touch such a line as it touches a wire.

use super::{Chart, Place, Surface, sheet::at_limits};
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

impl SurfaceEdge {
    /// The end at a limit of the parameters, given by its number as an edge.
    pub(super) fn at(edge: Edge, [du, dv]: [Vec3; 2], normal: Vec3) -> Option<Self> {
        let (along, across) = match edge {
            Edge::LowU => (dv, -du),
            Edge::HighU => (dv, du),
            Edge::LowV => (du, -dv),
            Edge::HighV => (du, dv),
        };
        let along = along.try_normalize(0.0)?;
        let outward = (across - along * along.dot(&across)).try_normalize(0.0)?;
        Some(Self { normal, outward, along })
    }
}

impl Surface {
    /// The end that the place nearest to a point lies on, for surfaces that tell directions there.
    pub fn edge_at(&self, p: &Vec3) -> Option<SurfaceEdge> {
        match self {
            Self::Sculptured(sheet) => sheet.edge_at(p),
            Self::Ruled(sheet) => self.edge_of_limits(p, sheet.limits()),
            Self::PolyConic(sheet) => self.edge_of_limits(p, sheet.limits()),
            _ => None,
        }
    }

    /// The same where places have one range of parameters.
    fn edge_of_limits(&self, p: &Vec3, limits: [[f64; 2]; 2]) -> Option<SurfaceEdge> {
        let place = self.place(p)?;
        let at_edges = Edge::ALL.into_iter().zip(at_limits(place.at, limits));
        let (edge, _) = at_edges.into_iter().find(|(_, is_at)| *is_at)?;
        let Chart { first: [du, dv], sense, .. } = self.chart(&place)?;
        SurfaceEdge::at(edge, [du, dv], du.cross(&dv).try_normalize(0.0)? * sense)
    }

    /// The line that stands out to a side, positive for that of the natural normal, on which a place lies, and its parameter there.
    pub fn crease_at(&self, place: &Place, side: f64) -> Option<(Crease, f64)> {
        match self {
            Self::Ruled(sheet) => sheet.crease_at(place),
            Self::PolyConic(sheet) => sheet.crease_at(place),
            Self::Sculptured(sheet) => sheet.crease_at(place, side),
            _ => None,
        }
    }

    /// The lines about a place that stand out to a side, each with its parameter beside the place.
    pub fn creases_beside(&self, place: &Place, side: f64) -> [Option<(Crease, f64)>; 4] {
        match self {
            Self::Ruled(sheet) => sheet.creases_beside(place),
            Self::PolyConic(sheet) => sheet.creases_beside(place),
            Self::Sculptured(sheet) => sheet.creases_beside(place, side),
            _ => [None; 4],
        }
    }

    /// A place of such a line, and the derivative there by the parameter along it.
    pub fn on_crease(&self, crease: &Crease, parameter: f64) -> Option<[Vec3; 2]> {
        match self {
            Self::Ruled(sheet) => Some(sheet.on_edge(crease.edge, parameter)),
            Self::PolyConic(sheet) => Some(sheet.on_edge(crease.edge, parameter)),
            _ => {
                let at = crease.edge.parameters(parameter);
                let Chart { point, first, .. } = self.chart(&Place { piece: crease.piece, at })?;
                Some([point, first[crease.edge.course()]])
            }
        }
    }
}
