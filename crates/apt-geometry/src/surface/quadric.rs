//! Quadrics in principal axes. The nearest point solves one monotone equation in one unknown.

use nalgebra::{Matrix3, SymmetricEigen};

use super::{Convexity, Foot, NoNormal, Surface, bend::Region};
use crate::{
    Vec3,
    canonical::{Plane, Quadric},
};

/// An eigenvalue or linear term below this share of the largest is zero.
const NEGLIGIBLE: f64 = 1e-11;
/// The centre is far along a principal axis where completing the square makes a constant so many times greater than what the canonical form has
/// beside the squares: coordinates told from there would lose as many digits. A conic through rounded points of a parabola has such a centre.
const FAR_CENTER: f64 = 1e4;
/// Bound of the Newton iteration for the nearest point; it is bracketed, so this is never reached in practice.
const MAX_ITERATIONS: u32 = 80;

/// Share of a pole next to which multipliers are told from there: a component across the plane of symmetry is known by its factor `1 + λ aᵢ`, of which
/// the multiplier alone tells no more than rounding.
const BESIDE_POLE: f64 = 0.1;
/// Share of a pole next to which a multiplier is the pole, if the point is on the plane of symmetry but for so many units of rounding: of both nearest
/// points it has one and the same wherever that is.
const AT_POLE: f64 = 1e-14;
const ON_PLANE: f64 = 4.0;

/// A multiplier, and how it is told: as a step from zero or from a pole.
#[derive(Debug, Clone, Copy)]
struct Multiplier {
    origin: f64,
    step: f64,
}

impl Multiplier {
    fn value(&self) -> f64 {
        self.origin + self.step
    }

    fn is_pole(&self) -> bool {
        self.origin != 0.0 && self.step == 0.0
    }

    /// `1 + λ a`, which is zero at the pole of that square.
    fn factor(&self, square: f64) -> f64 {
        let there = if self.origin == -1.0 / square { 0.0 } else { 1.0 + self.origin * square };
        there + self.step * square
    }
}

/// `Σ (aᵢ yᵢ² + 2 bᵢ yᵢ) + d = 0` with `y = Rᵀ(x − origin)`. Where `aᵢ ≠ 0` the origin is level with the centre and `bᵢ = 0`, unless the centre is
/// so far away that digits would be lost; then the origin is level with that of the coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct PrincipalQuadric {
    /// Columns are the principal axes.
    pub(super) rotation: Matrix3<f64>,
    pub(super) origin: Vec3,
    pub(super) square: Vec3,
    pub(super) linear: Vec3,
    pub(super) constant: f64,
    /// The canonical coefficients, `A,B,C,D,F,G,H,P,Q,R`, for directed distances and normals.
    pub coefficients: [f64; 10],
}

/// The surface of a canonical quadric; a plane if it has no quadratic terms.
pub(super) fn surface(quadric: &Quadric) -> Option<Surface> {
    let [a, b, c, d, f, g, h, p, q, r] = quadric.coefficients;
    if !quadric.coefficients.iter().all(|x| x.is_finite()) {
        return None;
    }
    let matrix = Matrix3::new(a, h, g, h, b, f, g, f, c);
    let vector = Vec3::new(p, q, r);
    let scale = matrix.amax();
    let normal = vector * 2.0;
    if scale <= NEGLIGIBLE * vector.amax() {
        let norm = normal.norm();
        return (norm > 0.0).then(|| Surface::Plane(Plane { normal: normal / norm, distance: -d / norm }));
    }
    let eigen = SymmetricEigen::new(matrix);
    let rotation = eigen.eigenvectors;
    let mut square = eigen.eigenvalues;
    let mut linear = rotation.transpose() * vector;
    let mut shift = Vec3::zeros();
    let mut constant = d;
    for i in 0..3 {
        if square[i].abs() <= NEGLIGIBLE * scale {
            square[i] = 0.0;
            if linear[i].abs() <= NEGLIGIBLE * vector.amax().max(scale) {
                linear[i] = 0.0;
            }
        } else if linear[i] * linear[i] / square[i].abs()
            <= FAR_CENTER * (d.abs() + vector.norm_squared() / scale)
        {
            shift[i] = -linear[i] / square[i];
            constant -= linear[i] * linear[i] / square[i];
            linear[i] = 0.0;
        }
    }
    if constant.abs() <= NEGLIGIBLE * (d.abs() + scale * shift.norm_squared()) {
        constant = 0.0;
    }
    let form = PrincipalQuadric {
        rotation,
        origin: rotation * shift,
        square,
        linear,
        constant,
        coefficients: quadric.coefficients,
    };
    form.has_real_points().then(|| Surface::Quadric(Box::new(form)))
}

impl PrincipalQuadric {
    fn has_real_points(&self) -> bool {
        if (0..3).any(|i| self.square[i] == 0.0 && self.linear[i] != 0.0) {
            return true;
        }
        let level = self.value_at_center();
        let positive = self.square.iter().any(|&a| a > 0.0) && level <= 0.0;
        let negative = self.square.iter().any(|&a| a < 0.0) && level >= 0.0;
        positive || negative || (self.square.min() < 0.0 && self.square.max() > 0.0)
    }

    pub(super) fn convexity(&self) -> Convexity {
        // {F ≤ 0} is convex when F is a convex function, {F ≥ 0} when it is concave.
        if self.square.min() >= 0.0 {
            Convexity::Convex
        } else if self.square.max() <= 0.0 {
            Convexity::Hollow
        } else {
            Convexity::General
        }
    }

    /// The coordinate of the centre along a principal axis along which F is quadratic.
    fn center(&self, axis: usize) -> f64 {
        -self.linear[axis] / self.square[axis]
    }

    /// F at the centre, its linear parts along the axes without a centre left out.
    fn value_at_center(&self) -> f64 {
        let round = (0..3).filter(|i| self.square[*i] != 0.0);
        self.constant + round.map(|i| self.linear[i] * self.center(i)).sum::<f64>()
    }

    fn local(&self, p: &Vec3) -> Vec3 {
        self.rotation.tr_mul(&(p - self.origin))
    }

    fn value_local(&self, y: &Vec3) -> f64 {
        (0..3).map(|i| (self.square[i] * y[i] + 2.0 * self.linear[i]) * y[i]).sum::<f64>() + self.constant
    }

    /// Point and value of F for a multiplier: `Qᵢ = (yᵢ − λ bᵢ)/(1 + λ aᵢ)`.
    fn at(&self, y: &Vec3, multiplier: &Multiplier) -> (Vec3, f64, f64) {
        let mut q = Vec3::zeros();
        let mut slope = 0.0;
        for i in 0..3 {
            let k = multiplier.factor(self.square[i]);
            q[i] = (y[i] - multiplier.value() * self.linear[i]) / k;
            let gradient = self.square[i] * q[i] + self.linear[i];
            slope -= 2.0 * gradient * gradient / k;
        }
        (q, self.value_local(&q), slope)
    }

    /// The nearest point and its multiplier: `p − Q = λ·∇F(Q)/2`, with every `1 + λ aᵢ > 0`.
    pub(super) fn foot(&self, p: &Vec3) -> (Foot, f64) {
        let y = self.local(p);
        let (lowest, highest) = (
            if self.square.max() > 0.0 { -1.0 / self.square.max() } else { f64::NEG_INFINITY },
            if self.square.min() < 0.0 { -1.0 / self.square.min() } else { f64::INFINITY },
        );
        let start = self.value_local(&y);
        let found = self.multiplier(&y, [lowest, highest]);
        let multiplier = found.value();
        let is_at_pole = found.is_pole();
        let q = if is_at_pole { self.on_symmetry_plane(&y, multiplier) } else { self.at(&y, &found).0 };
        let gradient = self.square.component_mul(&q) + self.linear;
        let length = gradient.norm();
        let offset = y - q;
        let (distance, normal) = if length > 0.0 && !is_at_pole {
            (multiplier * length, gradient / length)
        } else if length > 0.0 {
            (offset.norm() * start.signum(), gradient / length)
        } else {
            let d = offset.norm();
            let normal = if d > 0.0 { offset / d } else { Vec3::z() };
            (d * start.signum(), normal * start.signum())
        };
        let foot = Foot { distance, point: self.origin + self.rotation * q, normal: self.rotation * normal };
        (foot, multiplier)
    }

    /// Root of the decreasing function F(Q(λ)) between the poles; a pole itself if there is none. Next to a pole it is told as how far it is from there.
    fn multiplier(&self, y: &Vec3, poles: [f64; 2]) -> Multiplier {
        let from_zero = self.root(y, Multiplier { origin: 0.0, step: 0.0 }, poles);
        let near = |pole: &f64| {
            let off = from_zero.step - pole;
            pole.is_finite() && off.abs() <= BESIDE_POLE * pole.abs()
        };
        let Some(pole) = poles.into_iter().find(near) else { return from_zero };
        let rounding = f64::EPSILON * pole.abs();
        let inward = -pole.signum();
        let step = inward * (inward * (from_zero.step - pole)).max(rounding);
        let found = self.root(y, Multiplier { origin: pole, step }, poles.map(|limit| limit - pole));
        let at_pole = (0..3).filter(|i| -1.0 / self.square[*i] == pole);
        let off_plane = at_pole.map(|i| (y[i] - self.center(i)).abs()).fold(0.0, f64::max);
        let is_on_plane = off_plane <= ON_PLANE * f64::EPSILON * (y.norm() + self.origin.norm());
        // Without a root the bracket closes on the pole.
        if is_on_plane && found.step.abs() <= AT_POLE * pole.abs() {
            Multiplier { step: 0.0, ..found }
        } else {
            found
        }
    }

    /// The same by Newton's method from a beginning, between limits of the step.
    fn root(&self, y: &Vec3, start: Multiplier, [mut low, mut high]: [f64; 2]) -> Multiplier {
        let Multiplier { origin, step: mut x } = start;
        let smallest_step = f64::EPSILON * y.norm();
        for _ in 0..MAX_ITERATIONS {
            let (q, value, slope) = self.at(y, &Multiplier { origin, step: x });
            if value == 0.0 {
                break;
            }
            if value > 0.0 {
                low = x;
            } else {
                high = x;
            }
            let newton = if slope < 0.0 { x - value / slope } else { f64::NAN };
            // No more than rounding: the limits are as near.
            if (newton - x).abs() <= 4.0 * f64::EPSILON * x.abs() {
                break;
            }
            let next = if newton > low && newton < high {
                newton
            } else if low.is_finite() && high.is_finite() {
                0.5 * (low + high)
            } else if low.is_finite() {
                // No upper pole: go outward.
                low + 2.0 * (low.abs() + 1.0 / self.square.amax().max(f64::MIN_POSITIVE))
            } else {
                high - 2.0 * (high.abs() + 1.0 / self.square.amax().max(f64::MIN_POSITIVE))
            };
            // A step of Newton that moves the point by less than its own rounding ends the search, too: on the surface
            // the multiplier is zero and has no size to compare with.
            let moved = (next - x).abs() * (self.square.component_mul(&q) + self.linear).norm();
            let is_small = next == newton && origin == 0.0 && moved <= smallest_step;
            let done = (next - x).abs() <= 4.0 * f64::EPSILON * x.abs() || is_small;
            x = next;
            if done {
                break;
            }
        }
        Multiplier { origin, step: x }
    }

    /// Nearest point when the multiplier is a pole: the component with the pole is free and is set by F = 0.
    fn on_symmetry_plane(&self, y: &Vec3, multiplier: f64) -> Vec3 {
        let mut q = Vec3::zeros();
        let mut free = 0;
        let mut smallest = f64::INFINITY;
        for i in 0..3 {
            let k = 1.0 + multiplier * self.square[i];
            if k.abs() < smallest {
                smallest = k.abs();
                free = i;
            }
        }
        for i in 0..3 {
            let k = 1.0 + multiplier * self.square[i];
            let is_at_pole = i == free || k.abs() <= 1e-9;
            q[i] = if is_at_pole { self.center(i) } else { (y[i] - multiplier * self.linear[i]) / k };
        }
        let rest = self.value_local(&q);
        q[free] += (-rest / self.square[free]).max(0.0).sqrt();
        q
    }

    /// Second derivatives of the signed distance at the point whose foot this is.
    pub(super) fn hessian(&self, foot: &Foot, multiplier: f64) -> Matrix3<f64> {
        let q = self.local(&foot.point);
        let gradient = self.square.component_mul(&q) + self.linear;
        let length = gradient.norm();
        if length <= 0.0 {
            return Matrix3::zeros();
        }
        let n = gradient / length;
        let mut stretch = Vec3::zeros();
        for i in 0..3 {
            let k = 1.0 + multiplier * self.square[i];
            stretch[i] = if k.abs() > 1e-12 { 1.0 / k } else { 0.0 };
        }
        let sn = stretch.component_mul(&n);
        let along = sn.dot(&n);
        if along.abs() <= f64::MIN_POSITIVE {
            return Matrix3::zeros();
        }
        let moved = Matrix3::from_diagonal(&stretch) - sn * sn.transpose() / along;
        let bent = Matrix3::from_diagonal(&self.square) * moved;
        let projected = bent - n * (n.transpose() * bent);
        self.rotation * (projected / length) * self.rotation.transpose()
    }

    /// Upper bound of the second derivatives of `side · distance` over a region (see [`Surface::bend`]), `nearest` being
    /// the least distance in it: infinite if there is none.
    ///
    /// At its foot the surface bends by `vᵀAv/|Ax + b|` along a tangent v. The gradient is bounded from below by its
    /// components over the box that holds all feet. As long as a point below the surface is no deeper than the
    /// smallest radius of curvature, the quadratic form `I + λA` of its multiplier is definite, so that its foot is the
    /// only one.
    pub(super) fn bend(&self, side: f64, foot: &Foot, region: &Region, nearest: f64) -> f64 {
        let steepest = self.square.iter().map(|a| side * a).fold(0.0, f64::max);
        if steepest <= 0.0 {
            return 0.0;
        }
        let reach = region.lowest.abs().max(region.highest.abs()).min(foot.distance.abs() + region.radius);
        let reach = region.radius + reach;
        let y = self.local(&region.center);
        let mut least = 0.0;
        for i in 0..3 {
            let middle = self.square[i] * y[i] + self.linear[i];
            let low = (middle.abs() - self.square[i].abs() * reach).max(0.0);
            least += low * low;
        }
        let gradient = least.max(self.least_gradient()).sqrt();
        let curvature = if gradient > 0.0 { steepest / gradient } else { f64::INFINITY };
        let stretch = 1.0 + nearest * curvature;
        if stretch > 0.0 && curvature.is_finite() { curvature / stretch } else { f64::INFINITY }
    }

    /// The direction that neither the quadratic nor the linear terms know.
    pub(super) fn generator(&self) -> Option<Vec3> {
        let free = (0..3).find(|&i| self.square[i] == 0.0 && self.linear[i] == 0.0)?;
        Some(self.rotation.column(free).into_owned())
    }

    /// Square of the least half gradient on the whole surface: what is linear has it everywhere, and where `Σ aᵢ yᵢ² = C` about the centre, the terms
    /// of the sign of C add up to |C| at least.
    fn least_gradient(&self) -> f64 {
        let flat =
            (0..3).filter(|i| self.square[*i] == 0.0).map(|i| self.linear[i] * self.linear[i]).sum::<f64>();
        if flat > 0.0 {
            return flat;
        }
        let level = -self.value_at_center();
        let smallest =
            self.square.iter().filter(|&&a| a * level > 0.0).map(|a| a.abs()).fold(f64::INFINITY, f64::min);
        if smallest.is_finite() { smallest * level.abs() } else { 0.0 }
    }

    /// UNQUAD: the direction of the gradient of the canonical form.
    pub(super) fn natural_normal(&self, p: &Vec3) -> Result<Vec3, NoNormal> {
        let [a, b, c, _, f, g, h, l, m, n] = self.coefficients;
        let gradient = Vec3::new(
            a * p.x + h * p.y + g * p.z + l,
            h * p.x + b * p.y + f * p.z + m,
            g * p.x + f * p.y + c * p.z + n,
        );
        let scale = self.square.amax() * (1.0 + p.norm()) + self.linear.amax();
        if gradient.norm() <= super::ON_AXIS * scale { Err(NoNormal) } else { Ok(gradient.normalize()) }
    }
}
