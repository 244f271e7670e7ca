//! The four lines at which a polyconic surface ends.

use super::{Jet, PolyConicSheet};
use crate::{
    Vec3,
    parametric::Edge,
    surface::{
        crease::on_end_line,
        part::{Enclose, Rectangle},
    },
};

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

    /// The greatest second derivative along an end line between two parameters, at the parameter across it; `None` where it has a corner
    /// or is off the conics.
    pub(in crate::surface) fn edge_bend(
        &self,
        course: usize,
        [from, to]: [f64; 2],
        across: f64,
    ) -> Option<f64> {
        if self.form.thickness != 0.0 {
            return None;
        }
        // The conics go on straight before 0 and behind 1, with the same tangents.
        let joints = if course == 0 { [0.0, 1.0] } else { [from; 2] };
        let [first, last] = joints.map(|joint| joint.max(from).min(to));
        let cuts = [from, first, last, to];
        let mut greatest: f64 = 0.0;
        for pair in cuts.windows(2).filter(|pair| pair[1] > pair[0]) {
            let along = [pair[0], pair[1]];
            let beside = [across; 2];
            let rectangle = if course == 0 {
                Rectangle::between(along, beside)
            } else {
                Rectangle::between(beside, along)
            };
            let enclosure = self.enclose(&rectangle);
            if enclosure.split {
                return None;
            }
            let bend = if course == 0 { &enclosure.duu } else { &enclosure.dvv };
            greatest = greatest.max(bend.length());
        }
        greatest.is_finite().then_some(greatest)
    }
}
