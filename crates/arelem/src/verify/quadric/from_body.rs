//! Distance of a point from one of the two convex bodies that a quadric may be, wherever the point is.
//!
//! On its own side of the plane by which the bodies mirror each other a body is the nearer one. Across it the foot is `q = z + (p − z)/(1 +
//! λa)` with a λ beyond the pole of the axis: with every such λ the foot lies on the side of the body, and p − q is λ > 0 times its outward
//! normal where F(q) = 0. A convex body has one such place, the nearest one, so F changes sign once and a bracket finds it.

use apt_geometry::Vec3;

use super::{Pair, PointDistance, PrincipalQuadric, ROOT_STEPS};

impl PrincipalQuadric {
    /// Distance of a point from the body of a pair with outward normals of this sign along its axis, positive outside, and its gradient.
    /// `side` is the side that the pair was made for. None where the point is not finite or is the vertex of a cone.
    pub(in crate::verify) fn distance_from_body(
        &self,
        (pair, body): (&Pair, f64),
        side: f64,
        point: &Vec3,
    ) -> Option<PointDistance> {
        let p = self.turned_in(point);
        let across = (p[pair.axis] - pair.center[pair.axis]) * body;
        if across > 0.0 {
            return pair
                .distance_across(&p, across, body)
                .map(|found| PointDistance { normal: self.turned_out(&found.normal), ..found });
        }
        let own = self.distance(point)?;
        let mut normal = self.turned_in(&own.normal) * side;
        // On the plane between the bodies both are as near.
        normal[pair.axis] = normal[pair.axis].abs() * body;
        Some(PointDistance { distance: side * own.distance, normal: self.turned_out(&normal) })
    }
}

impl Pair {
    /// The distance from a body of a point in principal axes that is so far across the plane between the bodies.
    fn distance_across(&self, p: &Vec3, across: f64, body: f64) -> Option<PointDistance> {
        let steepest = -self.a[self.axis];
        let away = p - self.center;
        // How far the foot is on the other side, relative to how far the point is on this one: none where λ is infinite, all of the
        // way to the pole.
        let foot = |share: f64| {
            Vec3::from_fn(|i, _| {
                let bend = self.a[i] / steepest;
                match i {
                    i if i == self.axis => -body * across * share,
                    i if self.a[i] == 0.0 => away[i],
                    i => away[i] * share / (share + bend * (share + 1.0)),
                }
            })
        };
        let value = |foot: &Vec3| self.a.component_mul(foot).dot(foot) + self.constant;
        // F is not negative in the vertex and falls without end.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..ROOT_STEPS {
            if value(&foot(high)) <= 0.0 {
                break;
            }
            (low, high) = (high, 4.0 * high);
        }
        let mut share = 0.5 * (low + high);
        for _ in 0..ROOT_STEPS {
            let at = foot(share);
            let off = value(&at);
            if off > 0.0 {
                low = share;
            } else {
                high = share;
            }
            let rate: f64 = (0..3)
                .map(|i| {
                    let bend = self.a[i] / steepest;
                    let shrink = if i == self.axis || self.a[i] == 0.0 {
                        1.0
                    } else {
                        bend / (share + bend * (share + 1.0))
                    };
                    if self.a[i] == 0.0 { 0.0 } else { 2.0 * self.a[i] * at[i] * at[i] * shrink / share }
                })
                .sum();
            let newton = share - off / rate;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - share).abs() <= 4.0 * f64::EPSILON * next || next == share {
                break;
            }
            share = next;
        }
        let apart = away - foot(share);
        let distance = apart.norm();
        (distance > 0.0 && distance.is_finite()).then(|| PointDistance { distance, normal: apart / distance })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::verify::{clearance::Surface, tests::quadric};

    /// Places of a body that are compared with the nearest one.
    const PLACES: u32 = 4000;

    proptest! {
        /// Both sheets of x² − y² = c, a cylinder along z.
        #[test]
        fn no_place_of_a_body_is_nearer_than_it_is_and_one_is_as_near(
            constant in prop_oneof![1e-9..1e-6f64, 1e-6..1.0f64], at in prop::array::uniform3(-2.0..2.0f64),
        ) {
            let form = quadric([1.0, -1.0, 0.0, -constant, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            let Surface::Quadric(form) = Surface::of(&form).unwrap() else { return Ok(()) };
            let side = -1.0;
            let pair = form.pair(side).unwrap();
            let point = Vec3::from(at);
            for sign in [-1.0, 1.0] {
                let found = form.distance_from_body((&pair, sign), side, &point).unwrap();
                // The body lies against its normals.
                let way = -form.turned_out(&pair.outward(sign)).x.signum();
                let nearest = (0..=PLACES).map(|k| {
                    let y = 8.0 * (f64::from(k) / f64::from(PLACES) - 0.5);
                    (Vec3::new(way * (constant + y * y).sqrt(), y, at[2]) - point).norm()
                });
                let nearest = nearest.fold(f64::INFINITY, f64::min);
                prop_assert!((found.distance.abs() - nearest).abs() < 4e-3, "{} {nearest}", found.distance);
                prop_assert!(found.distance.abs() <= nearest + 1e-9, "{} {nearest}", found.distance);
                let foot = point - found.normal * found.distance;
                let off = foot.x * foot.x - foot.y * foot.y - constant;
                prop_assert!(off.abs() < 1e-6 * (1.0 + foot.norm_squared()), "{off:e}");
            }
        }
    }
}
