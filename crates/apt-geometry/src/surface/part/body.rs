//! How far parts of a surface keep off a convex body.

use super::{super::apart::Apart, Box3, Enclose, Extent, MOST_KEPT, Part, Rectangle};
use crate::Vec3;

/// Bound of the halvings of a part beside a body: at a contact all about it they go on until rounding.
const DEEPEST: u32 = 48;

impl Extent {
    /// The side along which the distance from a body is least like its tangent in the middle, if the part lies in a plane: that is what halves
    /// of it tell more of. Along the other one the tangent tells all, however long it is, as along rulings that a tool lies on.
    fn side_to_halve(&self, asked: &Apart<'_>, tangent: (f64, Vec3)) -> Option<usize> {
        let off = self.normal?.dot(&tangent.1).abs();
        let above = self.sides()?.map(|way| asked.above_tangent(&self.center, tangent, &way));
        let (shares, eased) = (self.shares(), self.eased());
        let [u, v] =
            [0, 1].map(|k: usize| shares[k][0] * above[0] + shares[k][1] * above[1] + off * eased[k]);
        Some(usize::from(v > u))
    }
}

impl Part {
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
        asked.takes_part(&self.extent, &mut |asked, tangent| {
            let side = self.extent.side_to_halve(asked, tangent);
            if let Some(side) = side.filter(|_| self.is_even) {
                let bends = sheet.enclose(&self.rectangle);
                return Cuts { sheet, bends: [bends.duu, bends.duv, bends.dvv] }.keep_apart(
                    &self.rectangle,
                    side,
                    asked,
                    depth + 1,
                );
            }
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

/// Pieces that are cut from a part which bends evenly: the bounds of its second derivatives serve all of them, so that a piece costs no more than
/// the place in its middle.
struct Cuts<'a, S> {
    sheet: &'a S,
    bends: [Box3; 3],
}

impl<S: Enclose> Cuts<'_, S> {
    /// Whether both halves of a side keep off a body.
    fn keep_apart(&self, all: &Rectangle, side: usize, asked: &mut Apart<'_>, depth: u32) -> bool {
        depth < DEEPEST && all.halves(side).iter().rev().all(|half| self.keeps_apart(half, asked, depth))
    }

    /// Whether a piece, cut as fine as need be, keeps off a body.
    fn keeps_apart(&self, piece: &Rectangle, asked: &mut Apart<'_>, depth: u32) -> bool {
        let jet = self.sheet.middle_of(piece);
        let normal = jet.du.cross(&jet.dv).try_normalize(0.0);
        let extent = Extent::of(&jet, self.bends.each_ref(), piece.half, normal);
        asked.takes_part(&extent, &mut |asked, tangent| {
            let side = extent.side_to_halve(asked, tangent);
            let [u, v] = [jet.du.norm() * piece.half[0], jet.dv.norm() * piece.half[1]];
            self.keep_apart(piece, side.unwrap_or(usize::from(v > u)), asked, depth + 1)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Body, HalfSpace, Limit, sheet_tests};
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
        let keeps = |wanted: f64| {
            cone.keeps_off_body(
                Body::new(&away),
                wanted,
                Limit { looks: 3000, enough: wanted, patience: Patience::default() },
            )
            .is_some()
        };
        assert!(keeps(off - slack));
        assert!(!keeps(off + slack));
    }

    /// About the edge of a disc distances bend without bound, however far it is from the surface; planes across it tell what it keeps.
    #[test]
    fn few_parts_keep_off_the_edge_of_a_disc() {
        let sheet = sheet_tests::surface(&sheet_tests::sheets()[0]);
        let foot = sheet.foot(&Vec3::new(1.3, 0.4, 0.9));
        let [radius, off, slack] = [0.5, 1e-6, 3e-9];
        for turn in [0.3, 1.1, 2.5] {
            // The edge touches along a tangent of the surface, the disc stands on it all but upright.
            let any = Vec3::x().cross(&foot.normal).normalize();
            let tangent = any * f64::cos(turn) + foot.normal.cross(&any) * f64::sin(turn);
            let (rise, lean) = f64::sin_cos(1.4);
            let out = foot.normal.cross(&tangent) * lean - foot.normal * rise;
            let axis = out.cross(&tangent);
            let middle = foot.point + foot.normal * off - out * radius;
            let away = |place: &Vec3| {
                let from = place - middle;
                let flat = from - axis * from.dot(&axis);
                let way = from - flat * (radius / flat.norm()).min(1.0);
                (way.norm(), way.normalize())
            };
            let beside = |out: &Vec3, normal: &Vec3| {
                let around = axis.cross(out).normalize();
                let across = (normal - around * around.dot(normal)).normalize();
                let outward = -across * across.dot(&foot.normal).signum();
                let reach = radius * (outward - axis * outward.dot(&axis)).norm();
                HalfSpace { outward, level: outward.dot(&middle) + reach }
            };
            let keeps = |body: Body<'_>, wanted: f64| {
                let limit = Limit { looks: 1500, enough: wanted, patience: Patience::default() };
                sheet.keeps_off_body(body, wanted, limit).is_some()
            };
            let sharp = Body { beside: Some(&beside), ..Body::new(&away) };
            assert!(keeps(sharp, off - slack), "{turn}");
            assert!(!keeps(sharp, off + slack), "{turn}");
        }
    }
}
