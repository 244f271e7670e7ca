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

/// The four lines at which a surface with one range of parameters ends, each with its parameter beside a place. As a tool meets such a
/// surface, nothing is behind what is beyond them, and they stand out to both sides.
fn end_lines(place: &Place, limits: [[f64; 2]; 2]) -> [(Crease, f64); 4] {
    Edge::ALL.map(|edge| {
        let course = edge.course();
        let [low, high] = limits[course];
        // A line goes on over all pieces.
        (Crease { piece: 0, edge }, (place.at[course] - low) / (high - low))
    })
}

/// That of these lines on which a place lies.
fn end_line_at(place: &Place, limits: [[f64; 2]; 2]) -> Option<(Crease, f64)> {
    let is_at = at_limits(place.at, limits);
    end_lines(place, limits).into_iter().find(|(crease, _)| is_at[crease.edge.number()])
}

/// The parameters of a surface at a parameter along such a line.
pub(super) fn on_end_line(limits: [[f64; 2]; 2], edge: Edge, parameter: f64) -> [f64; 2] {
    let shares = edge.parameters(parameter);
    [0, 1].map(|k: usize| {
        let [low, high] = limits[k];
        low + (high - low) * shares[k]
    })
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
            Self::Ruled(sheet) if sheet.is_met() => end_line_at(place, sheet.limits()),
            Self::PolyConic(sheet) if sheet.is_met() => end_line_at(place, sheet.limits()),
            Self::Sculptured(sheet) => sheet.crease_at(place, side),
            _ => None,
        }
    }

    /// The lines about a place that stand out to a side, each with its parameter beside the place.
    pub fn creases_beside(&self, place: &Place, side: f64) -> [Option<(Crease, f64)>; 4] {
        match self {
            Self::Ruled(sheet) if sheet.is_met() => end_lines(place, sheet.limits()).map(Some),
            Self::PolyConic(sheet) if sheet.is_met() => end_lines(place, sheet.limits()).map(Some),
            Self::Sculptured(sheet) => sheet.creases_beside(place, side),
            _ => [None; 4],
        }
    }

    /// How far the places of the chord between two places of a line at which a surface ends are from the line at most; `None` where that
    /// is not known, and for other surfaces.
    pub fn crease_sag(&self, crease: &Crease, ends: [f64; 2]) -> Option<f64> {
        let limits = match self {
            Self::Ruled(sheet) => sheet.limits(),
            Self::PolyConic(sheet) => sheet.limits(),
            _ => return None,
        };
        let course = crease.edge.course();
        let [a, b] = ends.map(|parameter| on_end_line(limits, crease.edge, parameter));
        let (from, to) = (a[course].min(b[course]), a[course].max(b[course]));
        let beside = a[1 - course];
        let bend = match self {
            Self::Ruled(sheet) => sheet.edge_bend(course, [from, to], beside),
            Self::PolyConic(sheet) => sheet.edge_bend(course, [from, to], beside),
            _ => None,
        }?;
        Some(0.125 * bend * (to - from).powi(2))
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
