//! How a tabulated cylinder bends: along its directrix, and along its generators not at all.

use super::{super::part::Form, Cubic, DirectrixCurve, SMOOTH, SPANS, Vec2};
use crate::Vec3;

impl Cubic {
    /// The directions of a span lie about one of them, off it by no more than an angle with a sine.
    fn heading(&self, k: usize) -> Option<(Vec2, f64)> {
        let [least, greatest] = (*self.slopes.get(k)?).map(f64::atan);
        let (sin, cos) = (0.5 * (least + greatest)).sin_cos();
        Some((self.along * cos + self.normal_axis() * sin, (0.5 * (greatest - least)).sin()))
    }
}

impl DirectrixCurve {
    /// The forms of the spans within reach of a point, as bent towards a side; `None` at a corner.
    pub(in super::super) fn forms(&self, side: f64, center: &Vec3, reach: f64) -> Option<Vec<Form>> {
        let flat = self.flat(center);
        if self.ends_within(flat, reach) {
            return None;
        }
        let mut forms = Vec::new();
        for interval in &self.intervals {
            let local = interval.to_local(flat);
            if interval.least_square(local) > reach * reach {
                continue;
            }
            if interval.turn.abs() > SMOOTH && local.norm_squared() <= reach * reach {
                return None;
            }
            for k in (0..SPANS as usize).filter(|k| interval.is_near(*k, local, reach)) {
                let bends = if interval.straight() { [0.0; 2] } else { *interval.bends.get(k)? };
                // Against the natural side the curve bends by the first at most, and to it by the second.
                let (towards, half) = (0.5 * (bends[1] - bends[0]), 0.5 * (bends[0] + bends[1]));
                let (direction, sine) = interval.heading(k)?;
                let error = half + towards.abs() * sine;
                forms.push(Form::of_ridge(&self.lift(direction), side * towards, error));
            }
        }
        Some(forms)
    }
}
