//! How strongly the distance from a surface bends over a ball: strict upper bounds of its second derivatives. With
//! such a bound finitely many distances prove an inequality for all points between them.

use super::{ConeForm, Foot, Surface, part::Survey};
use crate::{Vec3, patience::Patience};

/// How much farther than its feet the paths between feet are looked for at first.
const WIDER: f64 = 1.25;
/// How much farther than the cosine over the feet says they are looked for where that is too far.
const STEEPER: f64 = 1.5;
/// How far from feet of one point the path between them can reach, in depths of the point, while all normals keep the least
/// cosine: `2 (1 − c²)/c` for c = 1/2.
const FARTHEST_BESIDE: f64 = 3.0;

/// An upper bound of the second derivative, along any unit direction, of the distance from a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bend {
    /// It is nowhere greater than this (1/length, not negative).
    AtMost(f64),
    /// No bound can be given for so large a region: it may hold an edge, a vertex, or a point where nearest points
    /// jump. A smaller region may have one.
    Unbounded,
}

/// The points for which a bound is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// Centre of a ball.
    pub center: Vec3,
    /// Its radius.
    pub radius: f64,
    /// Least distance from the surface, on the side asked for, of the points that matter; negative beyond the surface.
    pub lowest: f64,
    /// Greatest such distance.
    pub highest: f64,
}

impl Region {
    /// The foot of a point that matters is not farther from the centre than this.
    fn reach(&self, foot: &Foot) -> f64 {
        let away = (foot.distance.abs() + self.radius).min(self.highest.abs().max(self.lowest.abs()));
        self.radius + away
    }
}

impl Surface {
    /// A bound for `side · signed distance` over the points of a region, given the foot of its centre.
    ///
    /// The function may have concave ridges there (points with several nearest points on that side): its slope only
    /// falls at them, so that the bound holds along every straight line all the same. There is none once `patience` is over.
    pub fn bend(&self, side: f64, foot: &Foot, region: &Region, patience: Patience<'_>) -> Bend {
        let asked =
            |reach: f64| Survey::new(&region.center, [region.radius, reach], (side, &foot.normal), patience);
        let nearest = region.lowest.max(side * foot.distance - region.radius);
        // Distance is the least of the distances to points, and each of these bends by its reciprocal.
        let far = if nearest > 0.0 { 1.0 / nearest } else { f64::INFINITY };
        let near = match self {
            Self::Plane(_) => 0.0,
            // Outwards the solid is convex; inwards the distance is a concave function.
            Self::Cylinder(_) | Self::Sphere(_) | Self::Cone(_) if side < 0.0 => 0.0,
            Self::Cylinder(cylinder) => reciprocal(cylinder.radius + nearest),
            Self::Sphere(sphere) => reciprocal(sphere.radius + nearest),
            Self::Cone(cone) => cone_bend(cone, region, nearest),
            Self::Quadric(quadric) => quadric.bend(side, foot, region, nearest),
            Self::Tabulated(curve) => {
                let reach = region.reach(foot);
                if nearest < 0.0 && !curve.is_alone(side, foot, &region.center, reach, -nearest) {
                    f64::INFINITY
                } else {
                    parallel_bend(curve.greatest_curvature(side, &region.center, reach), nearest)
                }
            }
            Self::Ruled(sheet) => {
                return sheet_bend(|reach| sheet.survey(asked(reach)), region.reach(foot), nearest);
            }
            Self::Sculptured(sheet) => {
                return sheet_bend(|reach| sheet.survey(asked(reach)), region.reach(foot), nearest);
            }
            Self::PolyConic(sheet) => {
                // Off a surface that lies at a thickness from its conics distances bend as those from the conics.
                let stock = side * sheet.thickness();
                let survey = |reach| sheet.survey(asked(reach));
                return sheet_bend(survey, region.reach(foot) + stock.abs(), nearest + stock);
            }
        };
        let least = near.min(far);
        if least.is_finite() { Bend::AtMost(least) } else { Bend::Unbounded }
    }
}

impl Surface {
    /// Unit direction along which the surface may be shifted without change, if there is one (a plane has many: some
    /// direction in it).
    pub fn generator(&self) -> Option<Vec3> {
        match self {
            Self::Plane(plane) => Some(super::perpendicular(&plane.normal)),
            Self::Cylinder(cylinder) => Some(cylinder.axis),
            Self::Quadric(quadric) => quadric.generator(),
            Self::Tabulated(curve) => Some(curve.generator()),
            _ => None,
        }
    }

    /// Unit direction that all straight lines of a ruled or polyconic surface have, if they have one; along it the surface
    /// may be shifted without change, but it ends.
    pub fn common_ruling(&self) -> Option<Vec3> {
        match self {
            Self::Ruled(sheet) => sheet.common_ruling(),
            Self::PolyConic(sheet) => sheet.common_ruling(),
            Self::Sculptured(sheet) => sheet.common_ruling(),
            _ => None,
        }
    }
}

/// The bend for places at least `nearest` from a sheet, from what is found of it within so far from the centre. Beyond the
/// sheet its places are to be on one piece: the paths between feet of one point reach farther than the feet.
fn sheet_bend<'a>(survey: impl Fn(f64) -> Survey<'a>, reach: f64, nearest: f64) -> Bend {
    if nearest >= 0.0 {
        return survey(reach).bend(nearest);
    }
    let depth = -nearest;
    let within = |asked: f64| {
        let path = survey(asked);
        path.beside(depth)
            .map(|beside| if reach + beside <= asked { path.bend(nearest) } else { Bend::Unbounded })
    };
    match within(WIDER * reach) {
        Some(Bend::AtMost(bend)) => Bend::AtMost(bend),
        Some(Bend::Unbounded) => survey(reach + FARTHEST_BESIDE * depth).bend(nearest),
        // An edge or a wall may lie just beyond the paths.
        None => survey(reach)
            .beside(depth)
            .and_then(|beside| within(reach + STEEPER * beside))
            .unwrap_or(Bend::Unbounded),
    }
}

/// Greatest bend of surfaces parallel to one that bends by at most `curvature`, at least `nearest` away from it.
pub(super) fn parallel_bend(curvature: f64, nearest: f64) -> f64 {
    let stretch = 1.0 + nearest * curvature;
    if curvature <= 0.0 {
        0.0
    } else if stretch > 0.0 {
        // At a corner both are infinite: the distance from it bends by its reciprocal.
        if curvature.is_finite() { curvature / stretch } else { f64::INFINITY }
    } else {
        f64::INFINITY
    }
}

/// `1/x`, infinite where x is not positive.
fn reciprocal(x: f64) -> f64 {
    if x > 0.0 { 1.0 / x } else { f64::INFINITY }
}

/// Outside a cone the parallel surface at a distance ρ from the axis bends by `cos α/ρ`; beyond the vertex it is a
/// sphere, which the caller's bound covers.
fn cone_bend(cone: &ConeForm, region: &Region, nearest: f64) -> f64 {
    let w = region.center - cone.vertex;
    let along = w.dot(&cone.axis);
    let across = (w - cone.axis * along).norm();
    if along * cone.cosine + across * cone.sine < region.radius {
        return f64::INFINITY;
    }
    // Not nearer to the axis than the ball, nor than the depth allowed.
    let by_depth = ((along - region.radius) * cone.sine + nearest) / cone.cosine;
    cone.cosine * reciprocal((across - region.radius).max(by_depth))
}

#[cfg(test)]
mod tests {
    use nalgebra::SymmetricEigen;
    use proptest::prelude::*;

    use super::*;
    use crate::canonical::{Cone, Cylinder, Geometry, Quadric, Sphere};

    fn v(x: f64, y: f64, z: f64) -> Vec3 {
        Vec3::new(x, y, z)
    }

    fn surfaces() -> Vec<Surface> {
        let quadric = |coefficients| Geometry::Quadric(Quadric { coefficients });
        [
            Geometry::Cylinder(Cylinder { point: v(0.1, 0.2, 0.0), axis: v(0.3, 1.0, 0.2), radius: 1.5 }),
            Geometry::Sphere(Sphere { center: v(0.2, 0.0, -0.1), radius: 1.8 }),
            Geometry::Cone(Cone {
                vertex: v(0.0, 0.0, 1.5),
                axis: v(0.1, 0.0, -1.0).normalize(),
                cosine: 0.8,
            }),
            quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5]),
            quadric([1.0, 0.6, 0.0, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, -1.5]),
            quadric([0.25, 1.0, 0.4, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            quadric([1.0, 0.8, -0.7, -1.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0]),
            quadric([1.0, 0.8, -0.7, 1.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0]),
            quadric([1.0, 0.8, -0.7, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            quadric([1.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        ]
        .iter()
        .map(|g| Surface::from_geometry(g).expect("surface"))
        .collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        /// Along straight lines through the region the distance stays above its chords by no more than the bound says:
        /// for a smooth stretch that is the second derivative, over ridges the fall of the slope.
        #[test]
        fn second_differences_stay_below_the_bound(
            which in 0usize..10, side in prop::bool::ANY, center in prop::array::uniform3(-2.5..2.5f64),
            radius in 0.01..0.6f64, depth in 0.0..0.1f64, height in 0.0..0.5f64,
            ends in prop::collection::vec(prop::array::uniform6(-1.0..1.0f64), 40),
        ) {
            let surface = &surfaces()[which];
            let side = if side { 1.0 } else { -1.0 };
            let center = Vec3::from(center);
            let region = Region { center, radius, lowest: -depth, highest: height };
            let bend = surface.bend(side, &surface.foot(&center), &region, Patience::default());
            let Bend::AtMost(bound) = bend else { return Ok(()) };
            let inside = |p: &Vec3| {
                let d = side * surface.signed_distance(p);
                ((p - center).norm() <= radius && d >= -depth && d <= height).then_some(d)
            };
            for e in ends {
                let p = center + v(e[0], e[1], e[2]) * radius;
                let q = p + v(e[3], e[4], e[5]) * (0.2 * radius);
                let m = (p + q) * 0.5;
                let (Some(a), Some(b), Some(c)) = (inside(&p), inside(&q), inside(&m)) else { continue };
                let length = (q - p).norm();
                let rise = 0.5 * (a + b) - c;
                prop_assert!(rise <= bound * length * length / 8.0 + 1e-11, "{rise} over {length}, bound {bound}");
            }
        }

        /// The bound is of use: over a small ball it comes near the greatest curvature there.
        #[test]
        fn small_regions_have_bounds_near_the_curvature(
            which in 0usize..7, center in prop::array::uniform3(-1.5..1.5f64),
        ) {
            let surface = &surfaces()[which];
            let foot = surface.foot(&Vec3::from(center));
            prop_assume!(surface.natural_normal(&foot.point).is_ok());
            let center = foot.point;
            let (foot, hessian) = surface.foot_and_hessian(&center);
            let greatest = SymmetricEigen::new(hessian).eigenvalues.max();
            let region = Region { center, radius: 1e-4, lowest: -1e-4, highest: 1e-4 };
            match surface.bend(1.0, &foot, &region, Patience::default()) {
                Bend::AtMost(bound) => prop_assert!(bound >= greatest * (1.0 - 1e-6)),
                other => prop_assert!(greatest > 100.0, "{other:?} where it bends by {greatest}"),
            }
        }
    }

    #[test]
    fn inside_of_round_solids_distances_do_not_bend_upward() {
        for surface in &surfaces()[..3] {
            let center = v(0.1, 0.1, -0.5);
            let region = Region { center, radius: 0.5, lowest: 0.0, highest: 2.0 };
            assert_eq!(
                surface.bend(-1.0, &surface.foot(&center), &region, Patience::default()),
                Bend::AtMost(0.0)
            );
        }
    }

    #[test]
    fn surfaces_are_shifted_along_their_generators_without_change() {
        let count = surfaces()
            .iter()
            .filter_map(|surface| {
                let along = surface.generator()?;
                let p = v(1.9, 0.4, -0.7);
                let (a, b) = (surface.signed_distance(&p), surface.signed_distance(&(p + along * 3.0)));
                assert!((a - b).abs() < 1e-12, "{a} {b}");
                Some(())
            })
            .count();
        assert_eq!(count, 2);
    }

    #[test]
    fn a_region_about_the_vertex_of_a_cone_has_no_bound() {
        let cone = &surfaces()[2];
        let center = v(0.0, 0.0, 1.6);
        let region = Region { center, radius: 0.2, lowest: -0.1, highest: 0.3 };
        assert_eq!(cone.bend(1.0, &cone.foot(&center), &region, Patience::default()), Bend::Unbounded);
    }
}
