//! The four lines at which a polyconic surface ends.

use super::{Jet, PolyConicSheet};
use crate::{Vec3, parametric::Edge, surface::crease::on_end_line};

impl PolyConicSheet {
    /// Ranges of the parameters of a place.
    pub(in crate::surface) fn limits(&self) -> [[f64; 2]; 2] {
        self.limits
    }

    /// Whether it is the surface as a tool on a side meets it.
    pub(in crate::surface) fn is_met(&self) -> bool {
        self.beyond.is_some()
    }

    /// A place of such a line, off the conics by the thickness, and the derivative there by the parameter along it.
    pub(in crate::surface) fn on_edge(&self, edge: Edge, parameter: f64) -> [Vec3; 2] {
        let course = edge.course();
        let [t, s] = on_end_line(self.limits, edge, parameter);
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
