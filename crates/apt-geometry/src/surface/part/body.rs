//! How far parts of a surface keep off a convex body.

use super::{super::apart::Apart, Enclose, MOST_KEPT, Part};
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

    /// The ways from the middle to the ends of each side, if the part lies in a plane: along both pairs of planes that it lies between.
    fn sides(&self) -> Option<[Vec3; 2]> {
        let normal = self.normal?;
        let [(a, wide_a), (b, wide_b)] = &self.strips;
        let upright = a.cross(b).norm();
        let ways = [a.cross(&normal) * (wide_b / upright), b.cross(&normal) * (wide_a / upright)];
        ways.iter().all(|way| way.iter().all(|x| x.is_finite())).then_some(ways)
    }

    /// The side along which the distance from a body is least like its tangent in the middle, if the part lies in a plane: that is what halves
    /// of it tell more of. Along the other one the tangent tells all, however long it is, as along rulings that a tool lies on.
    fn side_to_halve(&self, asked: &Apart<'_>, tangent: (f64, Vec3)) -> Option<usize> {
        let off = self.normal?.dot(&tangent.1).abs();
        let [u, v] = self.sides()?.map(|way| asked.above_tangent(&self.center, tangent, &way));
        Some(usize::from(v + off * self.eased[1] > u + off * self.eased[0]))
    }

    /// Both halves of a side.
    fn for_shorter(&self, sheet: &impl Enclose, side: usize, look: impl FnMut(&Self)) {
        if self.halved == Some(side) {
            return self.for_halves(sheet, look);
        }
        let cut = || self.rectangle.halves(side).map(|half| Self::new(sheet, half));
        let shorter = &self.shorter[side];
        match shorter.made() {
            None if sheet.parts().get() >= MOST_KEPT => cut().iter().rev().for_each(look),
            known => {
                if known.is_none() {
                    sheet.parts().add(2);
                }
                shorter.get(|| Box::new(cut())).iter().rev().for_each(look);
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
        asked.takes_part(self, &mut |asked, tangent| {
            let side = self.side_to_halve(asked, tangent);
            let mut keeps = depth < DEEPEST;
            let look = |half: &Self| keeps = keeps && half.keeps_apart(sheet, asked, depth + 1);
            match side {
                Some(side) => self.for_shorter(sheet, side, look),
                None => self.for_halves(sheet, look),
            }
            keeps
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Body, Limit, sheet_tests};
    use crate::{Vec3, patience::Patience};

    /// Beside a tool that lies along a ruling of a cone parts are as long as the ruling, however narrow: few of them show it.
    #[test]
    fn few_parts_keep_off_a_cylinder_that_lies_along_a_ruling() {
        let cone = sheet_tests::surface(&sheet_tests::sheets()[2]);
        let [radius, off, slack] = [0.3, 1e-3, 5e-9];
        let out = Vec3::new(1.5 * 2.0_f64.sqrt(), 1.5 * 2.0_f64.sqrt(), 2.0).normalize();
        let on_ruling = |share: f64| {
            let across = 2.0_f64.sqrt() * (1.0 - share);
            Vec3::new(across, across, 3.0 * share)
        };
        let [from, to] = [0.2, 0.8].map(|share| on_ruling(share) + out * (radius + off));
        let along = to - from;
        let away = |place: &Vec3| {
            let share = ((place - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            let way = place - from - along * share;
            (way.norm() - radius, way.normalize())
        };
        let limit = Limit { looks: 3000, patience: Patience::default() };
        let keeps =
            |wanted: f64| cone.keeps_off_body(Body { away: &away, within: None }, wanted, limit).is_some();
        assert!(keeps(off - slack));
        assert!(!keeps(off + slack));
    }
}
