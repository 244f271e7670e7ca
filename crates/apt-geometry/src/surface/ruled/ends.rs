//! The four lines at which a ruled surface ends: the last rulings of its extension, and where all of them end.

use std::sync::Arc;

use super::{
    RuledSheet,
    bounds::{SMOOTH, ranges},
};
use crate::{
    Vec3,
    parametric::Edge,
    surface::{Surface, crease::on_end_line, sheet::at_limits},
};

impl RuledSheet {
    /// Ranges of the parameters of a place.
    pub(in crate::surface) fn limits(&self) -> [[f64; 2]; 2] {
        self.limits
    }

    /// Whether it is the surface as a tool on a side meets it.
    pub(in crate::surface) fn is_met(&self) -> bool {
        self.beyond.is_some()
    }

    /// The surface as a tool on a side meets it: what is beyond the end is not behind it.
    pub(in crate::surface) fn met_from(&self, side: f64) -> &Surface {
        self.met[usize::from(side < 0.0)].get_or_init(|| {
            let sheet = Self { beyond: Some(side), met: Default::default(), ..self.clone() };
            Box::new(Surface::Ruled(Arc::new(sheet)))
        })
    }

    /// Whether the nearest place lies at an end of the curves or of the rulings.
    pub(in crate::surface) fn ends_at(&self, p: &Vec3) -> bool {
        let nearest = self.nearest(p);
        let start = self.jet(nearest.piece, nearest.t, 0.0);
        let (v, _) = self.share(p, &start.point, &start.dv);
        at_limits([nearest.t, v], self.limits).contains(&true)
    }

    /// A place of such a line, and the derivative there by the parameter along it.
    pub(in crate::surface) fn on_edge(&self, edge: Edge, parameter: f64) -> [Vec3; 2] {
        let course = edge.course();
        let [t, v] = on_end_line(self.limits, edge, parameter);
        let jet = self.jet(self.piece_at(t), t, v);
        let [low, high] = self.limits[course];
        let way = if course == 0 { jet.du } else { jet.dv };
        [jet.point, way * (high - low)]
    }

    /// The greatest second derivative along an end line between two parameters, at the parameter across it; `None` where it has a corner.
    pub(in crate::surface) fn edge_bend(
        &self,
        course: usize,
        [from, to]: [f64; 2],
        across: f64,
    ) -> Option<f64> {
        if course == 1 {
            return Some(0.0);
        }
        let (first, last) = (self.piece_at(from), self.piece_at(to));
        let mut greatest: f64 = 0.0;
        for k in first..=last {
            let piece = self.pieces.get(k)?;
            let (low, high) = (from.max(piece.from), to.min(piece.from + piece.width));
            let [_, _, bent] =
                ranges(piece, 0.5 * (low + high), 0.5 * (high - low), |e, f| e + (f - e) * across);
            greatest = greatest.max(bent.length());
            if k < last {
                let [before, after] = [k, k + 1].map(|k| self.jet(k, high, across).du);
                if (before - after).norm() > SMOOTH * before.norm() {
                    return None;
                }
            }
        }
        Some(greatest)
    }

    /// The piece of the curves with a parameter.
    pub(super) fn piece_at(&self, t: f64) -> usize {
        self.pieces
            .partition_point(|piece| piece.from + piece.width < t)
            .min(self.pieces.len().saturating_sub(1))
    }
}
