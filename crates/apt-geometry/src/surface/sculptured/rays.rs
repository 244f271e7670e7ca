//! Crossings of a ray with a sculptured surface.

use nalgebra::Vector2;

use super::{SculpturedSheet, tree::Leaf};
use crate::Vec3;

/// Bound of Newton's method, and the step of the parameters that ends it.
const MAX_ITERATIONS: u32 = 30;
const SETTLED: f64 = 1e-14;
/// How far outside of its leaf, in parameters, a crossing may be.
const BESIDE: f64 = 1e-9;
/// Distance from the ray, relative to the surface, of a crossing.
const ON_RAY: f64 = 1e-11;
/// Distance along the ray, relative to the surface, up to which two crossings are one.
const SAME: f64 = 1e-9;
/// Starts of the search along each parameter of a leaf, as shares of its half sides.
const STARTS: [[f64; 2]; 5] = [[0.0, 0.0], [0.6, 0.6], [-0.6, -0.6], [0.6, -0.6], [-0.6, 0.6]];

impl SculpturedSheet {
    /// Parameters of all crossings of a ray with the surface, in units of |direction|.
    pub(in crate::surface) fn ray_roots(&self, from: &Vec3, direction: &Vec3) -> Vec<f64> {
        let mut roots = Vec::new();
        let Some(unit) = direction.try_normalize(0.0) else { return roots };
        let off = |x: &Vec3| {
            let w = x - from;
            w - unit * w.dot(&unit)
        };
        let far = |node: &super::Node| {
            let (center, radius) = node.ball();
            off(&center).norm() > radius
        };
        self.leaves_near(far, |leaf| {
            for start in STARTS {
                if let Some(root) = self.crossing(leaf, start, from, &unit) {
                    roots.push(root);
                }
            }
            true
        });
        roots.sort_by(f64::total_cmp);
        roots.dedup_by(|a, b| (*a - *b).abs() <= SAME * self.size);
        let length = direction.norm();
        roots.iter().map(|root| root / length).collect()
    }

    /// Distance along the ray of the crossing that Newton's method leads to, if it is in the leaf.
    fn crossing(&self, leaf: &Leaf, start: [f64; 2], from: &Vec3, unit: &Vec3) -> Option<f64> {
        let [x, y] = {
            let x = super::perpendicular(unit);
            [x, unit.cross(&x)]
        };
        let (middle, half) = (leaf.rectangle.middle, leaf.rectangle.half);
        let mut at = [0, 1].map(|k: usize| middle[k] + start[k] * half[k]);
        for _ in 0..MAX_ITERATIONS {
            let jet = self.jet(leaf.piece, at);
            let w = jet.point - from;
            let off = Vector2::new(w.dot(&x), w.dot(&y));
            let (a, b) = (jet.du.dot(&x), jet.dv.dot(&x));
            let (c, d) = (jet.du.dot(&y), jet.dv.dot(&y));
            let determinant = a * d - b * c;
            let step = [(b * off.y - d * off.x) / determinant, (c * off.x - a * off.y) / determinant];
            if !step.iter().all(|s| s.is_finite()) {
                return None;
            }
            let next = [0, 1].map(|k: usize| (at[k] + step[k]).clamp(0.0, 1.0));
            let moved = (next[0] - at[0]).abs().max((next[1] - at[1]).abs());
            at = next;
            if moved <= SETTLED {
                break;
            }
        }
        let inside = (0..2).all(|k| (at[k] - middle[k]).abs() <= half[k] + BESIDE);
        let w = self.jet(leaf.piece, at).point - from;
        let along = w.dot(unit);
        let on = (w - unit * along).norm() <= ON_RAY * (self.size + w.norm());
        (inside && on).then_some(along)
    }
}
