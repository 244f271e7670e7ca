//! Exact distance of a point to a quadric, by its principal axes and the secular equation.
//!
//! In principal axes `F = Σ aᵢyᵢ² + 2bᵢyᵢ + D`, and the foot of a point p is `qᵢ = (pᵢ − λbᵢ)/(1 + λaᵢ)`. The *nearest* foot
//! is the one with all `1 + λaᵢ ≥ 0` (the single-constraint case of the trust-region theory: sufficient and necessary),
//! and on that interval F(q(λ)) decreases, so its root is found with a bracket and cannot be the wrong one.

mod from_body;

use apt_geometry::{Vec3, canonical};
use nalgebra::{Matrix3, SymmetricEigen};

/// Coefficients below this fraction of the greatest are round-off of the rotation to principal axes.
const NEGLIGIBLE: f64 = 1e-13;
/// Newton with bisection behind it: the bracket alone needs fewer steps than this to reach round-off.
const ROOT_STEPS: usize = 200;
/// Distance from the pole of the secular equation, relative to where it starts, below which the search goes to it in long
/// steps: the root is as near to it as the point is to a symmetry plane.
const NEAR_POLE: f64 = 1e-3;
/// How often the line of a body is halved where the bend of the surface beside it is bounded.
const MOST_HALVINGS: u32 = 6;
/// Rounding of the sine of the angle at which a body that does not end lies level.
const NEARLY_LEVEL: f64 = 1e-9;
/// Below this distance from the pole, at which squares of the foot are about to overflow, the point is on the plane.
const AT_POLE: f64 = 1e-140;

/// Which of the two regions of space, `F < 0` and `F > 0`, is made of convex pieces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Convexity {
    /// `F ≤ 0` is one convex body.
    Inner,
    /// `F ≥ 0` is one convex body.
    Outer,
    /// `F ≤ 0` is two convex bodies.
    InnerPair,
    /// `F ≥ 0` is two convex bodies.
    OuterPair,
    /// Neither.
    Saddle,
}

/// A quadric in its principal axes.
#[derive(Debug, Clone)]
pub(super) struct PrincipalQuadric {
    /// Columns are the principal directions.
    axes: Matrix3<f64>,
    /// Eigenvalues of the quadratic part, scaled.
    a: [f64; 3],
    /// Halves of the linear coefficients, scaled.
    b: [f64; 3],
    /// Constant, scaled.
    constant: f64,
    /// Shape of the two regions.
    pub(super) convexity: Convexity,
}

/// A quadratic function `Σ aᵢyᵢ² + 2bᵢyᵢ + c` in principal axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lower {
    a: Vec3,
    b: Vec3,
    constant: f64,
}

impl Lower {
    /// The value at a point.
    pub(super) fn at(&self, y: &Vec3) -> f64 {
        self.a.component_mul(y).dot(y) + 2.0 * self.b.dot(y) + self.constant
    }

    /// Half the gradient.
    pub(super) fn slope(&self, y: &Vec3) -> Vec3 {
        self.a.component_mul(y) + self.b
    }

    /// The form of the squares for two directions.
    pub(super) fn form(&self, v: &Vec3, w: &Vec3) -> f64 {
        self.a.component_mul(v).dot(w)
    }
}

/// A point's signed distance (positive where F > 0) and the unit gradient of that distance.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointDistance {
    pub(super) distance: f64,
    pub(super) normal: Vec3,
}

impl PrincipalQuadric {
    /// None if the coefficients describe no surface (not finite, or no variable in them).
    pub(super) fn of(quadric: &canonical::Quadric) -> Option<Self> {
        let [aa, bb, cc, dd, ff, gg, hh, pp, qq, rr] = quadric.coefficients;
        let scale = [aa, bb, cc, ff, gg, hh].iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let linear = [pp, qq, rr].iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let scale = if scale > 0.0 { scale } else { linear };
        if !quadric.coefficients.iter().all(|x| x.is_finite()) || scale <= 0.0 {
            return None;
        }
        let matrix = Matrix3::new(aa, hh, gg, hh, bb, ff, gg, ff, cc) / scale;
        let eigen = SymmetricEigen::try_new(matrix, f64::EPSILON, 1000)?;
        let rotated = eigen.eigenvectors.transpose() * Vec3::new(pp, qq, rr) / scale;
        let clean = |x: f64, greatest: f64| if x.abs() <= NEGLIGIBLE * greatest { 0.0 } else { x };
        let a = [0, 1, 2].map(|i| clean(eigen.eigenvalues[i], 1.0));
        let b = [0, 1, 2].map(|i| clean(rotated[i], linear / scale));
        let constant = dd / scale;
        let convexity = classify(&a, &b, constant);
        Some(Self { axes: eigen.eigenvectors, a, b, constant, convexity })
    }

    /// True if the surface is a cylinder with rulings along this unit direction.
    pub(super) fn is_ruled_along(&self, direction: &Vec3) -> bool {
        let local = self.axes.transpose() * direction;
        // A direction given to full precision; anything else takes the general route.
        (0..3).all(|i| local[i].abs() <= 1e-12 || (self.a[i] == 0.0 && self.b[i] == 0.0))
    }

    /// Of two convex bodies, the plane between them that each is the mirror image of the other by: unit normal and distance.
    pub(super) fn mirror(&self) -> Option<(Vec3, f64)> {
        let single = match self.convexity {
            Convexity::InnerPair => -1.0,
            Convexity::OuterPair => 1.0,
            _ => return None,
        };
        let k = (0..3).find(|k| self.a[*k] * single > 0.0)?;
        Some((self.axes.column(k).into_owned(), -self.b[k] / self.a[k]))
    }

    /// Direction of the straight lines of a cylinder of any section, in principal axes.
    pub(super) fn generator(&self) -> Option<Vec3> {
        let flat: Vec<usize> = (0..3).filter(|i| self.a[*i] == 0.0).collect();
        let mut generator = Vec3::zeros();
        match flat[..] {
            [i] if self.b[i] == 0.0 => generator[i] = 1.0,
            [i, j] => (generator[i], generator[j]) = (self.b[j], -self.b[i]),
            _ => return None,
        }
        generator.try_normalize(0.0)
    }

    /// Of one convex body on the other side than `side`, the place that is farthest along a unit direction, both in principal
    /// axes; what is not determined is as at a given place. None where nothing is farthest.
    pub(super) fn farthest(&self, side: f64, direction: &Vec3, about: &Vec3) -> Option<Vec3> {
        let (a, b) = (self.a.map(|a| a * side), self.b.map(|b| b * side));
        // Where the gradient has the direction: a y + b = t n with t > 0, the same for all coordinates.
        let linear = (0..3).filter(|i| a[*i] == 0.0).max_by(|i, j| b[*i].abs().total_cmp(&b[*j].abs()));
        let linear = linear.filter(|i| b[*i] != 0.0);
        let curved = || (0..3).filter(|i| a[*i] != 0.0);
        let t = match linear {
            Some(i) => b[i] / direction[i],
            None => {
                let level = curved().map(|i| b[i] * b[i] / a[i]).sum::<f64>() - side * self.constant;
                (level / curved().map(|i| direction[i] * direction[i] / a[i]).sum::<f64>()).sqrt()
            }
        };
        let is_level = |i: usize| (t * direction[i] - b[i]).abs() <= NEARLY_LEVEL * (b[i].abs() + t);
        if !(t > 0.0 && t.is_finite() && (0..3).all(|i| a[i] != 0.0 || is_level(i))) {
            return None;
        }
        let mut place =
            Vec3::from_fn(|i, _| if a[i] != 0.0 { (t * direction[i] - b[i]) / a[i] } else { about[i] });
        if let Some(i) = linear {
            place[i] -= side * self.value(&place) / (2.0 * b[i]);
        }
        Some(place)
    }

    /// Bound of the curvature with which the surface bends away from what is on a side of it, at places nearer than `reach` to a
    /// round body of a radius about a straight line; parts of it whose ball has more than `enough` are halved.
    pub(super) fn hill_along(
        &self,
        side: f64,
        line: [Vec3; 2],
        [radius, reach]: [f64; 2],
        enough: f64,
    ) -> Option<f64> {
        let mut greatest: f64 = 0.0;
        let mut open = vec![(line, 0)];
        while let Some(([from, to], depth)) = open.pop() {
            let middle = 0.5 * (from + to);
            let ball = (0.5 * (to - from).norm()).hypot(radius) + reach;
            let hill = self.hill(side, &middle, ball);
            if hill <= enough.max(greatest) {
                greatest = greatest.max(hill);
            } else if self.distance(&middle)?.distance.abs() <= ball {
                if depth == MOST_HALVINGS {
                    greatest = hill;
                } else {
                    open.extend([([from, middle], depth + 1), ([middle, to], depth + 1)]);
                }
            }
        }
        Some(greatest)
    }

    /// Bound of the curvature with which the surface bends away from what is on a side of it, in a ball.
    fn hill(&self, side: f64, center: &Vec3, radius: f64) -> f64 {
        let slope = self.slope(&self.turned_in(center));
        let local = Vec3::from_fn(|i, _| (slope[i].abs() - self.a[i].abs() * radius).max(0.0)).norm();
        let greatest = self.a.iter().map(|a| side * a).fold(0.0, f64::max);
        if greatest > 0.0 { greatest / local.max(self.least_slope()) } else { 0.0 }
    }

    /// Half of the gradient is nowhere on the surface less than this: of `Σ aᵢzᵢ² = C` about the centre the squares with the
    /// sign of C make up at least C.
    fn least_slope(&self) -> f64 {
        let flat = (0..3).filter(|i| self.a[*i] == 0.0).map(|i| self.b[i].abs()).fold(0.0, f64::max);
        let round = || (0..3).filter(|i| self.a[*i] != 0.0);
        let level = round().map(|i| self.b[i] * self.b[i] / self.a[i]).sum::<f64>() - self.constant;
        let least = round().map(|i| self.a[i]).filter(|a| a * level > 0.0).map(f64::abs);
        let least = least.fold(f64::INFINITY, f64::min);
        // With a linear part left the level differs from place to place.
        let central = if flat > 0.0 || least.is_infinite() { 0.0 } else { (least * level.abs()).sqrt() };
        flat.max(central)
    }

    /// `k (ρ² − r²) − l z²` about an axis through the origin.
    pub(super) fn round(
        frame: &[Vec3; 2],
        axis: &Vec3,
        [k, l]: [f64; 2],
        radius: f64,
        convexity: Convexity,
    ) -> Self {
        let axes = Matrix3::from_columns(&[frame[0], frame[1], *axis]);
        Self { axes, a: [k, k, -l], b: [0.0; 3], constant: -k * radius * radius, convexity }
    }

    /// A point or direction in principal axes.
    pub(super) fn turned_in(&self, v: &Vec3) -> Vec3 {
        self.axes.tr_mul(v)
    }

    /// A direction given in principal axes.
    pub(super) fn turned_out(&self, v: &Vec3) -> Vec3 {
        self.axes * v
    }

    /// The eigenvalues.
    pub(super) fn squares(&self) -> Vec3 {
        Vec3::from(self.a)
    }

    /// `1/(1 + λaᵢ)`: by how much the foot draws nearer. All are positive where it is the nearest one.
    pub(super) fn shrink(&self, lambda: f64) -> Vec3 {
        Vec3::from_fn(|i, _| 1.0 / (1.0 + lambda * self.a[i]))
    }

    /// A first guess of the multiplier: as if F were linear, but this side of the poles. None where F is stationary.
    pub(super) fn first_multiplier(&self, p: &Vec3) -> Option<f64> {
        let slope = self.slope(p);
        let guess = self.value(p) / (2.0 * slope.norm_squared());
        let critical =
            self.a.iter().filter(|a| *a * guess < 0.0).map(|a| 1.0 / a.abs()).fold(f64::INFINITY, f64::min);
        guess.is_finite().then(|| guess.clamp(-0.8 * critical, 0.8 * critical))
    }

    /// A function that, times λ ≥ 0, is nowhere above the squared distance from the points with `side·F ≤ 0`: the least
    /// `|x − y|² + λ·side·F(y)` over all y. None where that has no least value.
    pub(super) fn lower(&self, side: f64, lambda: f64) -> Option<Lower> {
        let k = self.shrink(side * lambda);
        if lambda < 0.0 || k.min() <= 0.0 {
            return None;
        }
        let mut lower = Lower { a: Vec3::zeros(), b: Vec3::zeros(), constant: side * self.constant };
        for i in 0..3 {
            lower.a[i] = side * self.a[i] * k[i];
            lower.b[i] = side * self.b[i] * k[i];
            lower.constant -= lambda * self.b[i] * self.b[i] * k[i];
        }
        Some(lower)
    }

    /// F at a point in principal axes.
    pub(super) fn value(&self, y: &Vec3) -> f64 {
        (0..3).map(|i| (self.a[i] * y[i] + 2.0 * self.b[i]) * y[i]).sum::<f64>() + self.constant
    }

    /// Half gradient.
    pub(super) fn slope(&self, y: &Vec3) -> Vec3 {
        Vec3::from_fn(|i, _| self.a[i] * y[i] + self.b[i])
    }

    /// The stationary point of `|p − y|² + λF(y)`.
    pub(super) fn foot(&self, p: &Vec3, lambda: f64) -> Vec3 {
        Vec3::from_fn(|i, _| (p[i] - lambda * self.b[i]) / (1.0 + lambda * self.a[i]))
    }

    /// Signed distance of a point; None if the surface has no real points or the point is not finite.
    pub(super) fn distance(&self, point: &Vec3) -> Option<PointDistance> {
        super::tool::count_work();
        let p = self.axes.transpose() * point;
        let value = self.value(&p);
        let slope = self.slope(&p);
        if !value.is_finite() {
            return None;
        }
        if value == 0.0 {
            let size = slope.norm();
            return (size > 0.0).then(|| PointDistance { distance: 0.0, normal: self.axes * slope / size });
        }
        let foot = self.nearest(&p, value, &slope)?;
        let away = p - foot;
        let distance = away.norm();
        let sign = value.signum();
        // Close to the surface the difference p − q loses its digits: take the gradient at the foot.
        let gradient = self.slope(&foot);
        let (away_size, gradient_size) = (distance, gradient.norm());
        let normal = if gradient_size > 0.0 && distance < 1e-6 * (p.norm() + 1.0) {
            gradient / gradient_size
        } else if away_size > 0.0 {
            away * (sign / away_size)
        } else {
            return None;
        };
        Some(PointDistance { distance: sign * distance, normal: self.axes * normal })
    }

    fn nearest(&self, p: &Vec3, value: f64, slope: &Vec3) -> Option<Vec3> {
        // F(q(λ)) decreases: the root is at λ > 0 where F > 0.
        let toward = value.signum();
        let size = slope.norm();
        let first = if size > 0.0 { value / (2.0 * size * size) } else { toward };
        let pole = (0..3)
            .filter(|i| self.a[*i] * toward < 0.0)
            .max_by(|i, j| self.a[*i].abs().total_cmp(&self.a[*j].abs()));
        let Some(pole) = pole else { return self.nearest_without_pole(p, toward, first, slope) };
        // Half way to the pole: of a root before that λ has the digits, of one beyond it what is left to the pole.
        let half = -0.5 / self.a[pole];
        if self.value(&self.foot(p, half)) * toward <= 0.0 {
            return Some(self.nearest_between(p, [0.0, half], first, slope));
        }
        self.nearest_before_pole(p, pole, toward, first)
    }

    /// Every λ on the way is allowed.
    fn nearest_without_pole(&self, p: &Vec3, toward: f64, first: f64, slope: &Vec3) -> Option<Vec3> {
        let f = |lambda: f64| self.value(&self.foot(p, lambda));
        // Bracket: `inside` has the sign of F(p), `outside` the other.
        let mut inside = 0.0;
        let mut trial = first;
        let mut outside = None;
        for _ in 0..ROOT_STEPS {
            let at = f(trial);
            if !at.is_finite() || at * toward <= 0.0 {
                outside = Some(trial);
                break;
            }
            inside = trial;
            trial *= 8.0;
        }
        Some(self.nearest_between(p, [inside, outside?], first, slope))
    }

    /// The nearest point by a λ between two, the first of which F has the sign of F(p) at, the other not; both are as far as the poles at most.
    fn nearest_between(
        &self,
        p: &Vec3,
        [mut inside, mut outside]: [f64; 2],
        first: f64,
        slope: &Vec3,
    ) -> Vec3 {
        let toward = outside.signum();
        let mut lambda =
            first.abs().clamp(inside.abs().min(outside.abs()), inside.abs().max(outside.abs())) * toward;
        for _ in 0..ROOT_STEPS {
            let at = self.value(&self.foot(p, lambda));
            if at * toward > 0.0 {
                inside = lambda;
            } else {
                outside = lambda;
            }
            let derivative: f64 =
                -2.0 * (0..3).map(|i| slope[i].powi(2) / (1.0 + lambda * self.a[i]).powi(3)).sum::<f64>();
            let step = -at / derivative;
            let newton = lambda + step;
            let (low, high) = (inside.min(outside), inside.max(outside));
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - lambda).abs() <= 4.0 * f64::EPSILON * next.abs() || next == lambda {
                return self.foot(p, next);
            }
            lambda = next;
        }
        self.foot(p, lambda)
    }

    /// λ ends at the pole of one principal axis. The root can be so near to it that λ itself has no digits left for the
    /// difference; so μ = 1 + λa of that axis is looked for, from one down to zero.
    fn nearest_before_pole(&self, p: &Vec3, pole: usize, toward: f64, first: f64) -> Option<Vec3> {
        let steepest = self.a[pole];
        let shrunk =
            |mu: f64| Vec3::from_fn(|i, _| (steepest - self.a[i]) / steepest + mu * (self.a[i] / steepest));
        let offset = Vec3::from_fn(|i, _| p[i] + self.b[i] / steepest);
        let foot = |mu: f64| {
            let rise = Vec3::from_fn(|i, _| mu * (self.b[i] / steepest));
            (offset - rise).component_div(&shrunk(mu))
        };
        // Bracket: F has the sign of F(p) at `inside`, the other at `outside`.
        let (mut inside, mut outside) = (1.0, None);
        let mut trial = 1.0 + first * steepest;
        for _ in 0..ROOT_STEPS {
            if trial <= 0.0 || trial >= inside {
                trial = if inside > NEAR_POLE { 0.5 * inside } else { NEAR_POLE * inside };
            }
            if trial < AT_POLE {
                break;
            }
            let at = self.value(&foot(trial));
            if !at.is_finite() || at * toward <= 0.0 {
                outside = Some(trial);
                break;
            }
            inside = trial;
        }
        let Some(mut outside) = outside else { return self.hard_case(p, -1.0 / steepest) };
        let mut mu = (outside * inside).sqrt();
        for _ in 0..ROOT_STEPS {
            let q = foot(mu);
            let at = self.value(&q);
            if at * toward > 0.0 {
                inside = mu;
            } else {
                outside = mu;
            }
            // dF/dλ, and dλ/dμ = 1/a.
            let gradient = self.slope(&q);
            let rate = -2.0 * gradient.component_div(&shrunk(mu)).dot(&gradient) / steepest;
            let newton = mu - at / rate;
            let next = if newton > outside && newton < inside { newton } else { (outside * inside).sqrt() };
            if (next - mu).abs() <= 4.0 * f64::EPSILON * next {
                return Some(foot(next));
            }
            mu = next;
        }
        Some(foot(mu))
    }

    /// The point is on a symmetry plane beyond the centre of curvature: the foot leaves that plane.
    fn hard_case(&self, p: &Vec3, lambda: f64) -> Option<Vec3> {
        let vanishing = (0..3)
            .min_by(|i, j| (1.0 + lambda * self.a[*i]).abs().total_cmp(&(1.0 + lambda * self.a[*j]).abs()))?;
        let near = |i: usize| (1.0 + lambda * self.a[i]).abs() <= 1e-12;
        let mut q = Vec3::from_fn(|i, _| {
            if near(i) {
                -self.b[i] / self.a[i]
            } else {
                (p[i] - lambda * self.b[i]) / (1.0 + lambda * self.a[i])
            }
        });
        // a(y − y₀)² must make up for the value that is left.
        let left = self.value(&q) / self.a[vanishing];
        if left > 0.0 {
            // Round-off only: the remaining terms already satisfy the equation.
            return (left.abs() <= 1e-9 * (1.0 + p.norm_squared())).then_some(q);
        }
        q[vanishing] += (-left).sqrt();
        Some(q)
    }
}

/// Two convex bodies `Σ aᵢ (yᵢ − zᵢ)² + c ≤ 0` in principal axes, one coefficient being negative and c not. A body is told by the
/// sign of its outward normals along that axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    a: Vec3,
    center: Vec3,
    constant: f64,
    /// The coordinate across the plane between both.
    axis: usize,
}

impl PrincipalQuadric {
    /// The two bodies on the other side than `side`, if there are two.
    pub(super) fn pair(&self, side: f64) -> Option<Pair> {
        if self.convexity != (if side > 0.0 { Convexity::InnerPair } else { Convexity::OuterPair }) {
            return None;
        }
        let a = Vec3::from(self.a) * side;
        let center = Vec3::from_fn(|i, _| if a[i] == 0.0 { 0.0 } else { -self.b[i] / self.a[i] });
        let constant = (side * self.value(&center)).max(0.0);
        Some(Pair { a, center, constant, axis: (0..3).find(|i| a[*i] < 0.0)? })
    }
}

impl Pair {
    /// The body that may have an outward normal.
    pub(super) fn body_with(&self, normal: &Vec3) -> f64 {
        normal[self.axis].signum()
    }

    /// Unit vector from one body to the other.
    pub(super) fn outward(&self, body: f64) -> Vec3 {
        let mut outward = Vec3::zeros();
        outward[self.axis] = body;
        outward
    }

    /// Place of a body that is nearest to the other one.
    pub(super) fn tip(&self, body: f64) -> Vec3 {
        self.center - self.outward(body) * (self.constant / -self.a[self.axis]).sqrt()
    }

    /// What the squares of a direction along the axis and across it come to, each over its coefficient.
    fn dual(&self, direction: &Vec3) -> (f64, f64) {
        let share =
            |i: usize| if self.a[i] == 0.0 { 0.0 } else { direction[i] * direction[i] / self.a[i].abs() };
        let all = (0..3).map(share).sum::<f64>();
        (share(self.axis), all - share(self.axis))
    }

    /// Unit normal near a given one and level of a plane that has the body with such normals behind it: a body has normals only as
    /// far as its asymptotic cone has them, and of a cylinder none along its generators.
    pub(super) fn plane(&self, normal: &Vec3) -> Option<(Vec3, f64)> {
        let (along, across) = self.dual(normal);
        let share = if across > along { (along / across).sqrt() } else { 1.0 };
        let kept = Vec3::from_fn(|i, _| {
            if i == self.axis {
                normal[i]
            } else if self.a[i] == 0.0 {
                0.0
            } else {
                share * normal[i]
            }
        });
        let kept = kept.try_normalize(0.0)?;
        let (along, across) = self.dual(&kept);
        let center = kept.component_mul(&self.center);
        let reach = (self.constant * (along - across).max(0.0)).sqrt();
        // Where the other body is far away, the difference has as few digits as the distance of the centre.
        let rounding = 4.0 * f64::EPSILON * (center.lp_norm(1) + reach);
        (kept[self.axis] != 0.0).then_some((kept, center.sum() - reach + rounding))
    }

    /// The place of a body that is farthest along a unit direction; what is not determined is as at a given place. None where
    /// nothing is farthest.
    pub(super) fn farthest(&self, body: f64, direction: &Vec3, about: &Vec3) -> Option<Vec3> {
        let (along, across) = self.dual(direction);
        let is_level = |i: usize| self.a[i] != 0.0 || direction[i].abs() <= NEARLY_LEVEL;
        if self.body_with(direction) != body || along < across || !(0..3).all(is_level) {
            return None;
        }
        let stretch = if self.constant > 0.0 { (self.constant / (along - across)).sqrt() } else { 0.0 };
        let place = |i: usize| self.center[i] + stretch * direction[i] / self.a[i];
        let farthest = Vec3::from_fn(|i, _| if self.a[i] == 0.0 { about[i] } else { place(i) });
        farthest.iter().all(|x| x.is_finite()).then_some(farthest)
    }
}

/// Convexity of the regions from the signs of the principal coefficients.
fn classify(a: &[f64; 3], b: &[f64; 3], constant: f64) -> Convexity {
    let positive = a.iter().filter(|x| **x > 0.0).count();
    let negative = a.iter().filter(|x| **x < 0.0).count();
    if negative == 0 {
        return Convexity::Inner;
    }
    if positive == 0 {
        return Convexity::Outer;
    }
    if (0..3).any(|i| a[i] == 0.0 && b[i] != 0.0) {
        return Convexity::Saddle;
    }
    // The value of F at its centre tells one sheet from two.
    let center = constant - (0..3).filter(|i| a[*i] != 0.0).map(|i| b[i] * b[i] / a[i]).sum::<f64>();
    let round_off = 1e-14 * (constant.abs() + (0..3).map(|i| b[i] * b[i]).sum::<f64>());
    if negative == 1 && center >= -round_off {
        Convexity::InnerPair
    } else if positive == 1 && center <= round_off {
        Convexity::OuterPair
    } else {
        Convexity::Saddle
    }
}
