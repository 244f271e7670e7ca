//! The four lines at which a polyconic surface ends.

use super::{Jet, PolyConicSheet};
use crate::{
    Vec3,
    parametric::Edge,
    surface::{Crease, Place, sheet::at_limits},
};

impl PolyConicSheet {
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
            Some((Crease { piece: place.piece, edge }, (place.at[course] - low) / (high - low)))
        })
    }

    /// A place of such a line, off the conics by the thickness, and the derivative there by the parameter along it.
    pub(in crate::surface) fn on_edge(&self, edge: Edge, parameter: f64) -> [Vec3; 2] {
        let course = edge.course();
        let shares = edge.parameters(parameter);
        let [t, s] = [0, 1].map(|k: usize| {
            let [low, high] = self.limits[k];
            low + (high - low) * shares[k]
        });
        let Jet { point, du, dv, duu, duv, dvv } = self.jet(t, s);
        let (mut place, mut way) = (point, if course == 0 { du } else { dv });
        let across = du.cross(&dv);
        if let Some(normal) = across.try_normalize(0.0).filter(|_| self.form.thickness != 0.0) {
            let change =
                if course == 0 { duu.cross(&dv) + du.cross(&duv) } else { duv.cross(&dv) + du.cross(&dvv) };
            let turn = (change - normal * normal.dot(&change)) / across.norm();
            place += normal * self.form.thickness;
            way += turn * self.form.thickness;
        }
        let [low, high] = self.limits[course];
        // Before the nose the station falls as the parameter grows, and derivatives are by the station.
        let sense = if course == 1 { self.turned(s) } else { 1.0 };
        [self.linear.tr_mul(&(place - self.origin)), self.linear.tr_mul(&way) * (sense * (high - low))]
    }
}
