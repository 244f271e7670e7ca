//! Which part of a surface is nearest to a place, and where on it.

use apt_geometry::Vec3;

use super::Part;
use crate::verify::patch::{Net, jet};

/// Steps towards the place of a part that is nearest to a point, and the last of them, in parameters.
const NEARING_STEPS: u32 = 6;
const LAST_NEARING: f64 = 1e-6;

/// The part that is nearest by some measure.
pub(in crate::verify) fn nearest_by(parts: &[Part], apart: impl Fn(&Part) -> f64) -> Option<usize> {
    let all = parts.iter().map(apart).enumerate();
    all.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
}

/// The part nearest to a place, if one is as near as `close`: that in whose middle the place is most first, so that few others
/// can be nearer.
pub(in crate::verify) fn nearest_to(parts: &[Part], place: &Vec3, close: f64) -> Option<usize> {
    let least = |part: &Part| (part.center - place).norm() - part.radius;
    let first = nearest_by(parts, least)?;
    let apart = |part: &Part| (part.near(place) - place).norm();
    let mut best = (first, apart(parts.get(first)?));
    for (k, part) in parts.iter().enumerate() {
        if k == first || least(part) > close.min(best.1) {
            continue;
        }
        let distance = apart(part);
        if distance < best.1 {
            best = (k, distance);
        }
    }
    Some(best.0)
}

/// About the place of a patch nearest to a point, with its parameters.
pub(super) fn near(net: &Net, x: &Vec3) -> ([f64; 2], Vec3) {
    let mut at = [0.5; 2];
    let mut jets = jet(net, at);
    for _ in 0..NEARING_STEPS {
        let [here, along, across] = jets;
        let from = x - here;
        let (a, b, c) = (along.norm_squared(), along.dot(&across), across.norm_squared());
        let (p, q) = (along.dot(&from), across.dot(&from));
        let area = a * c - b * b;
        if area <= 0.0 {
            break;
        }
        let before = at;
        at = [at[0] + (c * p - b * q) / area, at[1] + (a * q - b * p) / area].map(|t| t.clamp(0.0, 1.0));
        jets = jet(net, at);
        if (at[0] - before[0]).abs().max((at[1] - before[1]).abs()) <= LAST_NEARING {
            break;
        }
    }
    (at, jets[0])
}
