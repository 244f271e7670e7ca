//! Which patch meets which along their edges.

use serde::{Deserialize, Serialize};

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
