//! How far a net of cubics is off the rational patch that it stands for, and how much more that may bend: bounds, from the
//! control points of their difference times the weight, a polynomial of degree six both ways.

use std::ops::Sub;

use apt_geometry::{Vec3, parametric};

use super::super::patch::{Net, turned};

/// The degree of the difference times the weight.
const DEGREE: usize = 6;
/// Share of the coordinates of a patch that is rounding of its places.
const ROUNDING: f64 = 1e-14;

/// Bounds of the difference of two patches, by the same parameters, and of its derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Misfit {
    /// Its length.
    pub(super) off: f64,
    /// By u and by v.
    first: [f64; 2],
    /// By u twice, by both, by v twice.
    second: [f64; 3],
}

/// Control points by u and v.
type Grid<T, const U: usize, const V: usize> = [[T; V]; U];

/// Differences of neighbours along the first index, of which there is one less.
fn along<T: Copy + Sub<Output = T>, const U: usize, const LESS: usize, const V: usize>(
    grid: &Grid<T, U, V>,
) -> Grid<T, LESS, V> {
    std::array::from_fn(|i| std::array::from_fn(|j| grid[i + 1][j] - grid[i][j]))
}

/// The same along the second.
fn across<T: Copy + Sub<Output = T>, const U: usize, const V: usize, const LESS: usize>(
    grid: &Grid<T, U, V>,
) -> Grid<T, U, LESS> {
    std::array::from_fn(|i| std::array::from_fn(|j| grid[i][j + 1] - grid[i][j]))
}

/// Greatest size of a form with `N` control values each way, and of its derivatives: by u and by v, and as
/// [`Misfit::second`].
fn greatest<T: Copy + Sub<Output = T>, const N: usize, const FIRST: usize, const SECOND: usize>(
    grid: &Grid<T, N, N>,
    size: fn(&T) -> f64,
) -> (f64, [f64; 2], [f64; 3]) {
    let most = |values: &mut dyn Iterator<Item = &T>| values.map(size).fold(0.0, f64::max);
    let (first, second) = (FIRST as f64, (FIRST * SECOND) as f64);
    let u: Grid<T, FIRST, N> = along(grid);
    let v: Grid<T, N, FIRST> = across(grid);
    let uu: Grid<T, SECOND, N> = along(&u);
    let uv: Grid<T, FIRST, FIRST> = across(&u);
    let vv: Grid<T, N, SECOND> = across(&v);
    (
        most(&mut grid.as_flattened().iter()),
        [first * most(&mut u.as_flattened().iter()), first * most(&mut v.as_flattened().iter())],
        [
            second * most(&mut uu.as_flattened().iter()),
            first * first * most(&mut uv.as_flattened().iter()),
            second * most(&mut vv.as_flattened().iter()),
        ],
    )
}

/// How often a product of two control values of cubics is in a control value of their product: `binomial(3, i)·binomial(3,
/// k)/binomial(6, i + k)`.
fn share(i: usize, k: usize) -> f64 {
    const CUBIC: [f64; 4] = [1.0, 3.0, 3.0, 1.0];
    const PRODUCT: [f64; DEGREE + 1] = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0];
    CUBIC[i] * CUBIC[k] / PRODUCT[i + k]
}

impl Misfit {
    /// Of a net in the place of a rational patch with positive weights.
    pub(super) fn between(patch: &parametric::Patch, net: &Net) -> Self {
        let (points, cubic) = (patch.points(), turned(net));
        let mut product = [[Vec3::zeros(); DEGREE + 1]; DEGREE + 1];
        for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
            for (k, l) in (0..4).flat_map(|k| (0..4).map(move |l| (k, l))) {
                let weight = share(i, k) * share(j, l) * patch.control[i][j].w;
                product[i + k][j + l] += (points[i][j] - cubic[k][l]) * weight;
            }
        }
        let weights: Grid<f64, 4, 4> =
            std::array::from_fn(|i| std::array::from_fn(|j| patch.control[i][j].w));
        let least = weights.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        let (n, [nu, nv], [nuu, nuv, nvv]) = greatest::<_, 7, DEGREE, 5>(&product, |x| x.norm());
        let (_, [wu, wv], [wuu, wuv, wvv]) = greatest::<_, 4, 3, 2>(&weights, |w| w.abs());
        let rounding = ROUNDING * points.iter().flatten().map(|p| p.amax()).fold(0.0, f64::max);
        // The quotient rule.
        let off = n / least + rounding;
        let (u, v) = ((nu + off * wu) / least, (nv + off * wv) / least);
        let second = [
            (nuu + 2.0 * u * wu + off * wuu) / least,
            (nuv + u * wv + v * wu + off * wuv) / least,
            (nvv + 2.0 * v * wv + off * wvv) / least,
        ];
        Self { off, first: [u, v], second }
    }

    /// Whether the part is off more across than along.
    pub(super) fn is_across(&self) -> bool {
        self.second[2] > self.second[0]
    }

    /// How much more than the net, in curvature, what it stands for may bend at the same parameters; infinite where the net's
    /// parameters do not spread.
    ///
    /// Along `(a, b)` in the parameters the net C goes at least m times `|(a·s, b·t)|`, with s and t the lengths of its mean
    /// derivatives, and the other patch S, off by E, at least m − ε times. Its curvature there is `n·S″/|S′|²`: n is as far from
    /// the normal of C as E leads the derivatives aside, and S″ from C″ as far as E″ is long.
    pub(super) fn slack(&self, net: &Net) -> f64 {
        let grid = turned(net);
        let mean = |differences: &[Vec3]| {
            let mean = differences.iter().sum::<Vec3>() / differences.len() as f64;
            let off = differences.iter().map(|d| (d - mean).norm()).fold(0.0, f64::max);
            (mean * 3.0, off * 3.0)
        };
        let by_u: Grid<Vec3, 3, 4> = along(&grid);
        let by_v: Grid<Vec3, 4, 3> = across(&grid);
        let ((u, off_u), (v, off_v)) = (mean(by_u.as_flattened()), mean(by_v.as_flattened()));
        let (s, t) = (u.norm(), v.norm());
        let form = |[a, b, c]: [f64; 3]| {
            let (a, b, c) = (a / (s * s), b / (s * t), c / (t * t));
            0.5 * (a + c) + (0.5 * (a - c)).hypot(b)
        };
        let cosine = u.dot(&v).abs() / (s * t);
        let way = (1.0 - cosine).max(0.0).sqrt() - (off_u / s).hypot(off_v / t);
        let area = u.cross(&v).norm() - (off_u * t + s * off_v + off_u * off_v);
        let [eu, ev] = self.first;
        let left = way - (eu / s).hypot(ev / t);
        if !(left > 0.0 && area > 0.0) {
            return f64::INFINITY;
        }
        let tilt = 2.0 * (eu * (t + off_v) + (s + off_u) * ev + eu * ev) / area;
        let own = form(greatest::<_, 4, 3, 2>(&grid, |x| x.norm()).2);
        let stretched = own / (left * left) - own / (way * way);
        stretched + (tilt * own + form(self.second)) / (left * left)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector4;
    use proptest::prelude::*;

    use super::*;
    use crate::verify::patch::jet;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Neither the difference, nor its curvature, is ever greater than the bounds.
        #[test]
        fn no_place_is_farther_off_or_bends_more(
            off in proptest::collection::vec(-0.08..0.08f64, 96), weights in proptest::collection::vec(0.5..2.0f64, 16),
            near in 1e-6..0.1f64, [a, b] in [0.0..1.0f64, 0.0..1.0f64], turn in 0.0..3.1f64,
        ) {
            let control = std::array::from_fn(|i| std::array::from_fn(|j| {
                let k = 3 * (4 * i + j);
                let w = 1.0 + (weights[4 * i + j] - 1.0) * near;
                Vector4::new(
                    (i as f64 + off[k]) * w, (0.7 * j as f64 + off[k + 1]) * w, off[k + 2] * w, w,
                )
            }));
            let patch = parametric::Patch { control };
            let points = patch.points();
            let net: Net = std::array::from_fn(|j| std::array::from_fn(|i| {
                let k = 48 + 3 * (4 * i + j);
                points[i][j] + Vec3::new(off[k], off[k + 1], off[k + 2]) * near
            }));
            let misfit = Misfit::between(&patch, &net);
            let exact = patch.evaluate(a, b);
            let [place, ..] = jet(&net, [a, b]);
            prop_assert!((exact.position - place).norm() <= misfit.off);
            let slack = misfit.slack(&net);
            prop_assume!(slack.is_finite());
            let cubic = parametric::Patch::from_points(&turned(&net)).evaluate(a, b);
            let curvature = |at: &parametric::PatchPoint| {
                let (x, y) = (turn.cos(), turn.sin());
                let normal = at.du.cross(&at.dv).normalize();
                let along = at.du * x + at.dv * y;
                normal.dot(&(at.duu * (x * x) + at.duv * (2.0 * x * y) + at.dvv * (y * y))) / along.norm_squared()
            };
            let (exact, cubic) = (curvature(&exact), curvature(&cubic));
            prop_assert!((exact - cubic).abs() <= slack + 1e-9, "{exact} {cubic} {slack}");
        }
    }
}
