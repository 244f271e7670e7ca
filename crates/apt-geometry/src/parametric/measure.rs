//! Curvatures and areas.

use super::{
    patch::{Patch, PatchPoint},
    surface::SculpturedSurface,
};
use crate::Vec3;

/// Places along each parameter of a patch where curvatures are compared before the best are followed.
const PLACES: usize = 9;
/// Halvings of the step that follows an extreme curvature.
const REFINEMENTS: usize = 30;
/// Ratio of the lengths of the derivatives below which the curvature of a place, near a collapsed edge, is all rounding.
const COLLAPSING: f64 = 1e-3;
/// Difference of areas, as a share of the patch's, below which a part is not halved.
const AREA_CLOSE: f64 = 1e-10;
/// Halvings of a patch whose area is measured.
const AREA_HALVINGS: u32 = 6;
/// Abscissae and weights of the Gauss rule of order three on 0 to 1.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// The principal curvatures at a place, positive where the surface curves towards its natural normal `∂u × ∂v`: concave
/// seen from there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curvatures {
    /// Unit natural normal.
    pub normal: Vec3,
    /// The greater curvature, in reciprocal units of length.
    pub greatest: f64,
    /// The smaller curvature.
    pub least: f64,
    first: [f64; 3],
    second: [f64; 3],
}

/// An extreme curvature with its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvatureAt {
    /// The curvature, as of [`Curvatures`] but on the side of the sign word.
    pub curvature: f64,
    /// Index of the patch.
    pub patch: usize,
    /// Local parameters.
    pub local: [f64; 2],
}

impl PatchPoint {
    /// The principal curvatures; `None` where the tangents do not span a plane.
    pub fn curvatures(&self) -> Option<Curvatures> {
        let normal = self.regular_normal()?;
        let (e, f, g) = (self.du.norm_squared(), self.du.dot(&self.dv), self.dv.norm_squared());
        let (l, m, n) = (normal.dot(&self.duu), normal.dot(&self.duv), normal.dot(&self.dvv));
        let area = e * g - f * f;
        let mean = 0.5 * (e * n - 2.0 * f * m + g * l) / area;
        let product = (l * n - m * m) / area;
        let spread = (mean * mean - product).max(0.0).sqrt();
        // The larger in magnitude has no cancellation; the other one follows from the product.
        let large = if mean >= 0.0 { mean + spread } else { mean - spread };
        let small = if large == 0.0 { 0.0 } else { product / large };
        let (greatest, least) = (large.max(small), large.min(small));
        Some(Curvatures { normal, greatest, least, first: [e, f, g], second: [l, m, n] })
    }
}

impl Curvatures {
    /// The curvature of the section along `a ∂u + b ∂v`; `None` without a direction.
    pub fn along(&self, a: f64, b: f64) -> Option<f64> {
        let form = |[p, q, r]: [f64; 3]| p * a * a + 2.0 * q * a * b + r * b * b;
        let length = form(self.first);
        (length > 0.0).then(|| form(self.second) / length)
    }
}

impl Patch {
    /// The area of the patch, to about ten digits where it is smooth.
    pub fn area(&self) -> f64 {
        let whole = self.rough_area();
        self.area_between(whole, whole, AREA_HALVINGS)
    }

    fn rough_area(&self) -> f64 {
        let mut sum = 0.0;
        for (u, wu) in GAUSS {
            for (v, wv) in GAUSS {
                let at = self.evaluate(u, v);
                sum += wu * wv * at.du.cross(&at.dv).norm();
            }
        }
        sum
    }

    fn area_between(&self, rough: f64, whole: f64, depth: u32) -> f64 {
        let quarters: Vec<Patch> = self.halved_u().iter().flat_map(Patch::halved_v).collect();
        let areas: Vec<f64> = quarters.iter().map(Patch::rough_area).collect();
        let fine: f64 = areas.iter().sum();
        if depth == 0 || (fine - rough).abs() <= AREA_CLOSE * whole {
            return fine;
        }
        quarters.iter().zip(areas).map(|(part, area)| part.area_between(area, whole, depth - 1)).sum()
    }
}

impl SculpturedSurface {
    /// The area of all patches.
    pub fn area(&self) -> f64 {
        self.patches.iter().map(Patch::area).sum()
    }

    /// The least and the greatest principal curvature on the side of the sign word, as a dense search finds them; `None`
    /// where the surface has no normal anywhere.
    pub fn curvature_range(&self) -> Option<[CurvatureAt; 2]> {
        let least = self.extreme(|curvatures, side| {
            let value = if side < 0.0 { -curvatures.greatest } else { curvatures.least };
            -value
        })?;
        let greatest = self
            .extreme(|curvatures, side| if side < 0.0 { -curvatures.least } else { curvatures.greatest })?;
        Some([CurvatureAt { curvature: -least.curvature, ..least }, greatest])
    }

    /// The place where a function of the curvatures is greatest.
    fn extreme(&self, value: impl Fn(&Curvatures, f64) -> f64) -> Option<CurvatureAt> {
        let at = |patch: usize, local: [f64; 2]| {
            let place = self.patches.get(patch)?.evaluate(local[0], local[1]);
            let (du, dv) = (place.du.norm(), place.dv.norm());
            if du.min(dv) < COLLAPSING * du.max(dv) {
                return None;
            }
            let curvatures = place.curvatures()?;
            Some(CurvatureAt { curvature: value(&curvatures, self.side), patch, local })
        };
        let share = |index: usize| index as f64 / (PLACES - 1) as f64;
        let grid = (0..PLACES * PLACES).map(|index| [share(index % PLACES), share(index / PLACES)]);
        let places = (0..self.patches.len()).flat_map(|patch| grid.clone().map(move |local| (patch, local)));
        let mut best = places
            .filter_map(|(patch, local)| at(patch, local))
            .max_by(|a, b| a.curvature.total_cmp(&b.curvature))?;
        let mut step = 0.5 * share(1);
        for _ in 0..REFINEMENTS {
            let around = [[step, 0.0], [-step, 0.0], [0.0, step], [0.0, -step]].map(|by| {
                let local: [f64; 2] =
                    std::array::from_fn(|side| (best.local[side] + by[side]).clamp(0.0, 1.0));
                at(best.patch, local)
            });
            let next = around.into_iter().flatten().max_by(|a, b| a.curvature.total_cmp(&b.curvature));
            match next {
                Some(next) if next.curvature > best.curvature => best = next,
                _ => step *= 0.5,
            }
        }
        Some(best)
    }
}
