//! How far the places of a part reach from its middle: they lie in a disc about that, as thick as the part bends, and between two pairs of planes.

use super::{Box3, Enclosure, rulings::distance_from};
use crate::{Vec3, surface::sheet::Jet};

/// How far a part reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct Extent {
    pub(super) center: Vec3,
    /// No place is farther from the centre.
    pub(super) radius: f64,
    /// No place is farther from the tangent plane in the middle.
    pub(super) sag: f64,
    /// By how much less that is for the halves of each side.
    eased: [f64; 2],
    /// The part lies between two pairs of planes: their unit normals, in the tangent plane, and how far they are from the centre.
    strips: [(Vec3, f64); 2],
    /// How much of that is due to the bend along each side.
    bent: [f64; 2],
    /// Natural normal in the middle, if it has one.
    pub(super) normal: Option<Vec3>,
}

/// The planes that a part lies between which goes no farther from its centre than half its sides `u` and `v` and, beside
/// these, a length. A part without tangent plane may lie anywhere.
fn strips(normal: Option<Vec3>, [u, v]: [&Vec3; 2], bent: f64) -> [(Vec3, f64); 2] {
    let strip = |along: &Vec3, other: &Vec3| {
        let across = normal.and_then(|normal| normal.cross(along).try_normalize(0.0));
        across.map_or((Vec3::zeros(), f64::INFINITY), |across| (across, other.dot(&across).abs() + bent))
    };
    [strip(u, v), strip(v, u)]
}

impl Extent {
    /// That of all places whose parameters are within `half` of those of a place, by bounds of the second derivatives there.
    pub(super) fn of(
        jet: &Jet,
        [duu, duv, dvv]: [&Box3; 3],
        [hu, hv]: [f64; 2],
        normal: Option<Vec3>,
    ) -> Self {
        let (u, v) = (jet.du * hu, jet.dv * hv);
        let bent_by = [duu.length() * hu * hu, dvv.length() * hv * hv]
            .map(|own| 0.5 * own + 0.5 * duv.length() * hu * hv);
        let bent = bent_by[0] + bent_by[1];
        let radius = (u + v).norm().max((u - v).norm()) + bent;
        let (sag, eased) = normal.map_or((radius, [0.0; 2]), |normal| {
            let off = |bend: &Box3| bend.dot(&normal).magnitude();
            let [by_u, by_v] = [0.5 * off(duu) * hu * hu, 0.5 * off(dvv) * hv * hv];
            let by_both = off(duv) * hu * hv;
            let sag = by_u + by_v + by_both;
            let eased = [by_u, by_v].map(|own| 0.75 * own + 0.5 * by_both);
            if sag.is_finite() { (sag.min(radius), eased) } else { (radius, [0.0; 2]) }
        });
        let strips = strips(normal, [&u, &v], bent);
        Self { center: jet.point, radius, sag, eased, strips, bent: bent_by, normal }
    }

    /// That of a part by all that is known of it: no place is farther from its middle than its reach, and where it is split the derivatives tell
    /// nothing more.
    pub(super) fn of_part(enclosure: &Enclosure, half: [f64; 2], normal: Option<Vec3>) -> Self {
        let Enclosure { jet, duu, duv, dvv, reach, split, .. } = enclosure;
        let smooth = Self::of(jet, [duu, duv, dvv], half, normal.filter(|_| !split));
        let radius = if smooth.radius.is_nan() { *reach } else { smooth.radius.min(*reach) };
        let sag =
            if smooth.sag.is_nan() || smooth.normal.is_none() { radius } else { smooth.sag.min(radius) };
        Self { radius, sag, normal, ..smooth }
    }

    /// No place is nearer to a point than this.
    pub(super) fn bound(&self, p: &Vec3) -> f64 {
        let w = p - self.center;
        let square = w.norm_squared();
        let away = square.sqrt() - self.radius;
        let Some(normal) = self.normal else { return away };
        let height = w.dot(&normal);
        let mut beside = (square - height * height).max(0.0).sqrt() - self.radius;
        for (across, half) in &self.strips {
            beside = beside.max(w.dot(across).abs() - half);
        }
        let (beside, above) = (beside.max(0.0), (height.abs() - self.sag).max(0.0));
        away.max((beside * beside + above * above).sqrt())
    }

    /// Whether it is known that no place is within a distance of a straight piece.
    pub(super) fn is_off(&self, ends: &[Vec3; 2], distance: f64) -> bool {
        if distance_from(ends, &self.center) > self.radius + distance {
            return true;
        }
        // Both ends on one side of a pair of planes: so is all between.
        let is_beyond = |across: &Vec3, half: f64| {
            let [first, last] = ends.map(|end| (end - self.center).dot(across));
            first * last > 0.0 && first.abs().min(last.abs()) > half + distance
        };
        self.strips.iter().any(|(across, half)| is_beyond(across, *half))
            || self.normal.is_some_and(|normal| is_beyond(&normal, self.sag))
    }

    /// The middle.
    pub(in super::super) fn center(&self) -> &Vec3 {
        &self.center
    }

    /// The natural normal there, if there is one.
    pub(in super::super) fn normal(&self) -> Option<Vec3> {
        self.normal
    }

    /// No place is farther from the middle along a unit direction.
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
    pub(super) fn sides(&self) -> Option<[Vec3; 2]> {
        let normal = self.normal?;
        let [(a, wide_a), (b, wide_b)] = &self.strips;
        let upright = a.cross(b).norm();
        let ways = [a.cross(&normal) * (wide_b / upright), b.cross(&normal) * (wide_a / upright)];
        ways.iter().all(|way| way.iter().all(|x| x.is_finite())).then_some(ways)
    }

    /// What each side has of how far the part goes along the ways to the ends of both ([`Extent::sides`]): a side that bends makes the part wider across
    /// itself, too, and halves of the other one are as wide.
    pub(super) fn shares(&self) -> [[f64; 2]; 2] {
        let [(_, wide_v), (_, wide_u)] = self.strips;
        let [by_u, by_v] = self.bent;
        let of = |bent: f64, wide: f64| if wide > 0.0 { (bent / wide).min(1.0) } else { 0.0 };
        let (of_v, of_u) = (of(by_v, wide_u), of(by_u, wide_v));
        [[1.0 - of_v, of_u], [of_v, 1.0 - of_u]]
    }

    /// By how much halves of each side are less far from the tangent plane in the middle.
    pub(super) fn eased(&self) -> [f64; 2] {
        self.eased
    }
}
