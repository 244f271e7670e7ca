//! Which patch meets which along their edges.

use serde::{Deserialize, Serialize};

use super::patch::Patch;
use crate::Vec3;

/// Distance of edges, as a share of the size of the surface, up to which they are the same.
pub(super) const SAME_EDGE: f64 = 1e-6;
/// Parameters where edges are compared.
pub(super) const PROBES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// Cosine of the angle (0.1 degrees) between tangent planes up to which a joint is smooth.
const SMOOTH: f64 = 0.999_998_476_913_287_7;

/// An edge of a patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Edge {
    /// u = 0.
    LowU,
    /// u = 1.
    HighU,
    /// v = 0.
    LowV,
    /// v = 1.
    HighV,
}

/// What lies beyond an edge of a patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Neighbour {
    /// Index of the other patch.
    pub patch: usize,
    /// Its edge.
    pub edge: Edge,
    /// Whether its edge runs against this one.
    pub reversed: bool,
    /// Whether the tangent planes agree along the edge.
    pub smooth: bool,
}

impl Edge {
    /// The four edges in the order of their numbers.
    pub const ALL: [Edge; 4] = [Edge::LowU, Edge::HighU, Edge::LowV, Edge::HighV];

    /// The number of the edge: 0 u=0, 1 u=1, 2 v=0, 3 v=1.
    pub fn number(self) -> usize {
        match self {
            Edge::LowU => 0,
            Edge::HighU => 1,
            Edge::LowV => 2,
            Edge::HighV => 3,
        }
    }

    /// The number of the parameter that varies along the edge.
    pub fn course(self) -> usize {
        usize::from(matches!(self, Edge::LowU | Edge::HighU))
    }

    /// The parameters at `t` along the edge, which runs with the parameter that varies.
    pub fn parameters(self, t: f64) -> [f64; 2] {
        match self {
            Edge::LowU => [0.0, t],
            Edge::HighU => [1.0, t],
            Edge::LowV => [t, 0.0],
            Edge::HighV => [t, 1.0],
        }
    }
}

/// An edge with the places where it is compared.
struct Candidate {
    patch: usize,
    edge: Edge,
    places: [Vec3; 5],
}

/// What lies beyond the edges of each patch. Of several patches along one edge the first is taken; collapsed edges have no
/// neighbours.
pub(super) fn neighbours(patches: &[Patch]) -> Vec<[Option<Neighbour>; 4]> {
    let mut found = vec![[None; 4]; patches.len()];
    let extent = patches.iter().map(Patch::size).fold(0.0, f64::max);
    let close = SAME_EDGE * extent;
    let mut edges = Vec::with_capacity(4 * patches.len());
    for (patch, form) in patches.iter().enumerate() {
        for edge in Edge::ALL {
            let arc = form.edge(edge);
            let places = PROBES.map(|t| arc.evaluate(t).position);
            let length = places.iter().map(|place| (place - places[0]).norm()).fold(0.0, f64::max);
            if length > close {
                edges.push(Candidate { patch, edge, places });
            }
        }
    }
    // Edges that meet have their middles in the same place: only near ones in this order are compared.
    edges.sort_by(|a, b| a.places[2].x.total_cmp(&b.places[2].x));
    for (index, one) in edges.iter().enumerate() {
        for other in edges.iter().skip(index + 1) {
            // Also ends the search where a coordinate is no number.
            let apart = other.places[2].x - one.places[2].x;
            if apart > close || apart.is_nan() {
                break;
            }
            let Some(reversed) = one.meets(other, close) else { continue };
            let smooth = is_smooth(patches, one, other, reversed);
            for (from, to) in [(one, other), (other, one)] {
                let place = &mut found[from.patch][from.edge.number()];
                if place.is_none() {
                    *place = Some(Neighbour { patch: to.patch, edge: to.edge, reversed, smooth });
                }
            }
        }
    }
    found
}

impl Candidate {
    /// Whether another edge is the same one, and then whether it runs the other way.
    fn meets(&self, other: &Candidate, close: f64) -> Option<bool> {
        if self.patch == other.patch && self.edge == other.edge {
            return None;
        }
        let near = |reversed: bool| {
            (0..PROBES.len()).all(|index| {
                let across = if reversed { PROBES.len() - 1 - index } else { index };
                (self.places[index] - other.places[across]).norm() <= close
            })
        };
        if near(false) { Some(false) } else { near(true).then_some(true) }
    }
}

fn is_smooth(patches: &[Patch], one: &Candidate, other: &Candidate, reversed: bool) -> bool {
    let (Some(a), Some(b)) = (patches.get(one.patch), patches.get(other.patch)) else { return false };
    PROBES.iter().all(|&t| {
        let ([u, v], [s, w]) =
            (one.edge.parameters(t), other.edge.parameters(if reversed { 1.0 - t } else { t }));
        a.normal(u, v).direction.dot(&b.normal(s, w).direction).abs() >= SMOOTH
    })
}
