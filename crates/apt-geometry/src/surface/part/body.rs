//! How far parts of a surface keep off a convex body.

use super::{super::apart::Apart, Enclose, Part};
use crate::Vec3;

/// Bound of the halvings of a part beside a body: at a contact all about it they go on until rounding.
const DEEPEST: u32 = 48;

impl Part {
    /// No place of the part is farther from its middle along a unit direction.
    pub(in super::super) fn reach_along(&self, way: &Vec3) -> f64 {
        let Some(normal) = self.normal else { return self.radius };
        let [(a, u), (b, v)] = &self.strips;
        let [x, y, lean] = [a.dot(way), b.dot(way), a.dot(b)];
        let upright = 1.0 - lean * lean;
        let beside = ((x - lean * y).abs() * u + (y - lean * x).abs() * v) / upright;
        let above = normal.dot(way).abs() * self.sag;
        // Strips without width or direction tell nothing.
        if beside.is_finite() { (beside + above).min(self.radius) } else { self.radius }
    }

    /// Whether this part, cut as fine as need be, keeps off a body.
    pub(in super::super) fn keeps_apart(
        &self,
        sheet: &impl Enclose,
        asked: &mut Apart<'_>,
        depth: u32,
    ) -> bool {
        asked.takes_part(self, &mut |asked| {
            let mut keeps = depth < DEEPEST;
            self.for_halves(sheet, |half| keeps = keeps && half.keeps_apart(sheet, asked, depth + 1));
            keeps
        })
    }
}
