//! On which side of a sculptured surface a place is that is nearest to an edge or corner of it: the directions to such places make a fan between
//! the normals of all faces that meet there, and where the surface turns by more than a right angle many are behind one or another of these.

use apt_geometry::Vec3;

use super::{SculpturedStrips, normal_at};
use crate::verify::{
    patch::{Patch, extent, jet, sides},
    strip::{Cubic, Touch, place, tangent},
};

/// Distance, relative to the patch, within which places of others are its own, beside how far these may be off: ten times as far as a place that
/// is taken for one of its sides is from that.
const ONE_PLACE: f64 = 1e-6;
/// Places of the side of a patch from which the nearest is closed in on, and steps in which it is.
const LOOKS: u32 = 8;
const CLOSING_STEPS: usize = 12;
/// Parameter next to the end of a side within which a place is a corner of the patch.
const CORNER: f64 = 1e-5;

/// The parameter of the place of a cubic nearest to a point, if it is within a distance.
fn parameter_of(curve: &Cubic, x: &Vec3, within: f64) -> Option<f64> {
    let off = |t: f64| (place(curve, t) - x).norm_squared();
    let looks = (0..=LOOKS).map(|k| f64::from(k) / f64::from(LOOKS));
    let mut t = looks.min_by(|a, b| off(*a).total_cmp(&off(*b)))?;
    for _ in 0..CLOSING_STEPS {
        let rate = tangent(curve, t) * 3.0;
        let step = rate.dot(&(x - place(curve, t))) / rate.norm_squared();
        if !step.is_finite() {
            break;
        }
        t = (t + step).clamp(0.0, 1.0);
    }
    (off(t) <= within * within).then_some(t)
}

/// The angle between two directions.
fn angle(a: &Vec3, b: &Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

/// How much of a turn about a place a patch takes up that has it on one of its sides, and where that is.
fn sector(patch: &Patch, x: &Vec3, within: f64) -> Option<([f64; 2], f64)> {
    let (side, curve, t) = sides(&patch.net)
        .into_iter()
        .enumerate()
        .find_map(|(side, curve)| Some((side, curve, parameter_of(&curve, x, within)?)))?;
    let low_or_high = f64::from(side % 2 == 1);
    let at = |t: f64| if side < 2 { [low_or_high, t] } else { [t, low_or_high] };
    let ways = |t: f64| {
        let [_, along, across] = jet(&patch.net, at(t));
        if side < 2 { [across, along] } else { [along, across] }
    };
    let is_point = curve.iter().all(|control| (control - curve[0]).norm() <= within);
    if is_point {
        // All of the side is there: what spreads about it lies between the directions at both its ends.
        return Some((at(0.5), angle(&ways(0.0)[1], &ways(1.0)[1])));
    }
    if t > CORNER && t < 1.0 - CORNER {
        return Some((at(t), std::f64::consts::PI));
    }
    // Both ways into the patch.
    let [beside, inward] = ways(t.round());
    let sense = |high: f64| 1.0 - 2.0 * high;
    Some((at(t.round()), angle(&(beside * sense(t.round())), &(inward * sense(low_or_high)))))
}

impl SculpturedStrips {
    /// A direction to the natural side at a place that is at an edge of the surface: the mean of the normals of all patches that meet there, each
    /// by how much of a turn about the place it takes up, which is on the same side as every direction of the fan (J. A. Bærentzen and H. Aanæs,
    /// 2005). Elsewhere the natural normal.
    pub(in crate::verify) fn facing(&self, touch: &Touch, close: f64) -> Option<Vec3> {
        if !self.is_sharp(touch, close) {
            return self.natural(touch);
        }
        let x = &touch.point;
        let [along, across] = extent(&self.sheet.patches.get(touch.piece)?.net);
        let within = ONE_PLACE * along.max(across) + 2.0 * self.error;
        let near = self.sheet.patches.iter().filter(|patch| patch.within(x, within).is_some());
        let faces = near.filter_map(|patch| {
            let (at, turn) = sector(patch, x, within)?;
            Some(normal_at(&patch.net, at)? * turn)
        });
        faces.sum::<Vec3>().try_normalize(0.0).or_else(|| self.natural(touch))
    }
}
