//! Crossings of a ray with a ruled surface.

use super::{RuledSheet, Strip};
use crate::{Vec3, surface::tabulated::bracketed_root};

/// Pieces of a strip in which crossings with a ray are looked for.
const SAMPLES: u32 = 6;

impl RuledSheet {
    /// Parameters of all crossings of a ray with the surface, in units of |direction|.
    pub(in crate::surface) fn ray_roots(&self, from: &Vec3, direction: &Vec3) -> Vec<f64> {
        let mut roots = Vec::new();
        let length = direction.norm();
        if length <= 0.0 {
            return roots;
        }
        let unit = direction / length;
        for nodes in self.bands.iter() {
            let mut open = vec![0usize];
            while let Some(node) = open.pop() {
                let Some(strip) = nodes.get(node).filter(|strip| strip.piece != usize::MAX) else { continue };
                if strip.ray_bound(from, &unit) > 0.0 {
                    continue;
                }
                if 2 * node + 1 < nodes.len() {
                    open.extend([2 * node + 2, 2 * node + 1]);
                } else {
                    self.crossings(strip, from, &unit, &mut roots);
                }
            }
        }
        roots.sort_by(f64::total_cmp);
        roots.dedup_by(|a, b| (*a - *b).abs() <= 1e-11 * self.size);
        roots.iter().map(|root| root / length).collect()
    }

    /// Crossings with the rulings of a strip: those that lie in one plane with the ray.
    fn crossings(&self, strip: &Strip, from: &Vec3, unit: &Vec3, roots: &mut Vec<f64>) {
        let volume = |t: f64| {
            let jet = self.jet(strip.piece, t, 0.0);
            (jet.point - from).cross(&jet.dv).dot(unit)
        };
        let [low, high] = strip.range;
        let mut before = (low, volume(low));
        for k in 1..=SAMPLES {
            let t = low + (high - low) * f64::from(k) / f64::from(SAMPLES);
            let here = (t, volume(t));
            if let Some(t) = bracketed_root(&volume, before.0, here.0) {
                roots.extend(self.along_ray(strip.piece, t, from, unit));
            }
            before = here;
        }
    }

    /// Distance along the ray of its crossing with a ruling in the same plane.
    fn along_ray(&self, piece: usize, t: f64, from: &Vec3, unit: &Vec3) -> Option<f64> {
        let jet = self.jet(piece, t, 0.0);
        let w = jet.point - from;
        // (w + v·dv) is along the ray: both without their parts along it.
        let flat = |x: &Vec3| x - unit * x.dot(unit);
        let (across, offset) = (flat(&jet.dv), flat(&w));
        let square = across.norm_squared();
        if square <= 1e-20 * jet.dv.norm_squared() {
            return None;
        }
        let v = -offset.dot(&across) / square;
        let [low, high] = self.limits[1];
        (v >= low && v <= high).then(|| (w + jet.dv * v).dot(unit))
    }
}

impl Strip {
    /// No point of a line is nearer than this.
    fn ray_bound(&self, from: &Vec3, unit: &Vec3) -> f64 {
        let flat = |x: &Vec3| x - unit * x.dot(unit);
        let (w, along) = (flat(&(from - self.middle[0])), flat(&self.middle[1]));
        let square = along.norm_squared();
        let x = if square > 0.0 { (w.dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
        (w - along * x).norm() - self.radius
    }
}
