//! The four lines at which a ruled surface ends: the last rulings of its extension, and where all of them end.

use super::RuledSheet;
use crate::{
    Vec3,
    parametric::Edge,
    surface::{Crease, Place, sheet::at_limits},
};

impl RuledSheet {
    /// Ranges of the parameters of a place.
    pub(in crate::surface) fn limits(&self) -> [[f64; 2]; 2] {
        self.limits
    }

    /// The line on which a place lies, with the parameter there: as a tool meets the surface, nothing is behind what is beyond it, and it
    /// stands out to both sides.
    pub(in crate::surface) fn crease_at(&self, place: &Place) -> Option<(Crease, f64)> {
        let is_at = at_limits(place.at, self.limits);
        let beside = self.creases_beside(place).into_iter().flatten();
        beside.into_iter().find(|(crease, _)| is_at[crease.edge.number()])
    }

    pub(in crate::surface) fn creases_beside(&self, place: &Place) -> [Option<(Crease, f64)>; 4] {
        Edge::ALL.map(|edge| {
            self.beyond?;
            let course = edge.course();
            let [low, high] = self.limits[course];
            // A line goes on over the pieces of the curves.
            Some((Crease { piece: 0, edge }, (place.at[course] - low) / (high - low)))
        })
    }

    /// A place of such a line, and the derivative there by the parameter along it.
    pub(in crate::surface) fn on_edge(&self, edge: Edge, parameter: f64) -> [Vec3; 2] {
        let course = edge.course();
        let shares = edge.parameters(parameter);
        let [t, v] = [0, 1].map(|k: usize| {
            let [low, high] = self.limits[k];
            low + (high - low) * shares[k]
        });
        let jet = self.jet(self.piece_at(t), t, v);
        let [low, high] = self.limits[course];
        let way = if course == 0 { jet.du } else { jet.dv };
        [jet.point, way * (high - low)]
    }

    /// The piece of the curves with a parameter.
    fn piece_at(&self, t: f64) -> usize {
        self.pieces
            .partition_point(|piece| piece.from + piece.width < t)
            .min(self.pieces.len().saturating_sub(1))
    }
}
