//! How far parts of a surface keep off a convex body.

use super::{super::apart::Apart, Enclose, MOST_KEPT, Part};
use crate::Vec3;

/// Bound of the halvings of a part beside a body: at a contact all about it they go on until rounding.
const DEEPEST: u32 = 48;
/// How much longer than the other a side of a part is that is halved because it is long: far along it the distance tells nothing of
/// the rest.
const SLENDER: f64 = 4.0;

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

    /// The side that is by far the longer one, if the part lies in a plane.
    fn longer(&self) -> Option<usize> {
        let [across_u, across_v] = self.strips.map(|(_, half)| half);
        let is_longer = |one: f64, other: f64| one > SLENDER * other && one.is_finite();
        if is_longer(across_u, across_v) { Some(1) } else { is_longer(across_v, across_u).then_some(0) }
    }

    /// Both halves of a side.
    fn for_shorter(&self, sheet: &impl Enclose, side: usize, look: impl FnMut(&Self)) {
        let cut = || self.rectangle.halves(side).map(|half| Self::new(sheet, half));
        match self.shorter.made() {
            None if sheet.parts().get() >= MOST_KEPT => cut().iter().rev().for_each(look),
            known => {
                if known.is_none() {
                    sheet.parts().add(2);
                }
                self.shorter.get(|| Box::new(cut())).iter().rev().for_each(look);
            }
        }
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
            let look = |half: &Self| keeps = keeps && half.keeps_apart(sheet, asked, depth + 1);
            match self.longer() {
                Some(side) => self.for_shorter(sheet, side, look),
                None => self.for_halves(sheet, look),
            }
            keeps
        })
    }
}
