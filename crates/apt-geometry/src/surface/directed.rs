//! Directed distances (DDST and its kin): how far along a ray the surface is.

use super::{ConeForm, PrincipalQuadric, Surface};
use crate::{
    Vec3,
    canonical::{Cylinder, Plane, Sphere},
};

/// Which of several roots is wanted (FIOP).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RootSelection {
    /// Least absolute value, ties to the positive one (FIOP 0).
    Nearest,
    /// Least that is not negative, or none (FIOP 1).
    Ahead,
    /// Least that is not negative, else least absolute value (FIOP −1).
    AheadElseNearest,
}

/// The ray does not meet the surface as asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the ray does not meet the surface")]
pub struct NoDistance;

/// A coefficient below this share of the largest is zero.
const NEGLIGIBLE: f64 = 1e-14;
/// Cosine below which a ray is parallel to a plane.
const PARALLEL: f64 = 1e-12;

impl RootSelection {
    /// The chosen root among any number of them.
    pub fn choose(self, roots: impl IntoIterator<Item = f64>) -> Option<f64> {
        let mut nearest: Option<f64> = None;
        let mut ahead: Option<f64> = None;
        for root in roots {
            if !root.is_finite() {
                continue;
            }
            let nearer = match nearest {
                None => true,
                Some(best) => root.abs() < best.abs() || (root.abs() == best.abs() && root > best),
            };
            if nearer {
                nearest = Some(root);
            }
            if root >= 0.0 && ahead.is_none_or(|best| root < best) {
                ahead = Some(root);
            }
        }
        match self {
            Self::Nearest => nearest,
            Self::Ahead => ahead,
            Self::AheadElseNearest => ahead.or(nearest),
        }
    }
}

/// Real roots of `a λ² + 2 b λ + c = 0` without cancellation (QUAD).
pub fn solve_quadratic(a: f64, b: f64, c: f64) -> impl Iterator<Item = f64> + Clone {
    let scale = a.abs().max(b.abs()).max(c.abs());
    let (first, second) = if a.abs() <= NEGLIGIBLE * scale {
        if b.abs() <= NEGLIGIBLE * scale { (None, None) } else { (Some(-c / (2.0 * b)), None) }
    } else {
        let discriminant = b * b - a * c;
        if discriminant < 0.0 {
            (None, None)
        } else if discriminant == 0.0 {
            (Some(-b / a), None)
        } else {
            let q = -(b + b.signum() * discriminant.sqrt());
            (Some(q / a), (q != 0.0).then(|| c / q))
        }
    };
    first.into_iter().chain(second)
}

impl Surface {
    /// λ such that `from + λ·direction` lies on the surface, in units of |direction| (DDST).
    ///
    /// # Errors
    /// [`NoDistance`] if no root exists or none satisfies the selection.
    pub fn directed_distance(
        &self,
        from: &Vec3,
        direction: &Vec3,
        selection: RootSelection,
    ) -> Result<f64, NoDistance> {
        let root = match self {
            Self::Plane(plane) => selection.choose(plane_root(plane, from, direction)),
            Self::Sphere(sphere) => selection.choose(sphere_roots(sphere, from, direction)),
            Self::Cylinder(cylinder) => selection.choose(cylinder_roots(cylinder, from, direction)),
            Self::Cone(cone) => selection.choose(cone_roots(cone, from, direction)),
            Self::Quadric(quadric) => selection.choose(quadric_roots(quadric, from, direction)),
            Self::Tabulated(curve) => selection.choose(curve.ray_roots(from, direction)),
            Self::Ruled(sheet) => selection.choose(sheet.ray_roots(from, direction)),
            Self::PolyConic(sheet) => selection.choose(sheet.ray_roots(from, direction)),
            Self::Sculptured(sheet) => selection.choose(sheet.ray_roots(from, direction)),
        };
        root.ok_or(NoDistance)
    }
}

fn plane_root(plane: &Plane, from: &Vec3, direction: &Vec3) -> Option<f64> {
    let cosine = plane.normal.dot(direction);
    if cosine.abs() <= PARALLEL * direction.norm() {
        return None;
    }
    Some((plane.distance - plane.normal.dot(from)) / cosine)
}

fn sphere_roots(sphere: &Sphere, from: &Vec3, direction: &Vec3) -> impl Iterator<Item = f64> {
    let w = from - sphere.center;
    let c = w.norm_squared() - sphere.radius * sphere.radius;
    solve_quadratic(direction.norm_squared(), w.dot(direction), c)
}

fn cylinder_roots(cylinder: &Cylinder, from: &Vec3, direction: &Vec3) -> impl Iterator<Item = f64> {
    let w = from - cylinder.point;
    let (dt, wt) = (direction.dot(&cylinder.axis), w.dot(&cylinder.axis));
    let a = direction.norm_squared() - dt * dt;
    let b = direction.dot(&w) - dt * wt;
    let c = w.norm_squared() - wt * wt - cylinder.radius * cylinder.radius;
    // Parallel to the axis: the distance does not change, whatever rounding leaves of `a`.
    let parallel = a <= PARALLEL * direction.norm_squared();
    solve_quadratic(a, b, c).filter(move |_| !parallel)
}

/// Squaring brings in the other nappe; its roots are removed before one is selected.
fn cone_roots(cone: &ConeForm, from: &Vec3, direction: &Vec3) -> impl Iterator<Item = f64> {
    let w = from - cone.vertex;
    let (dt, wt) = (direction.dot(&cone.axis), w.dot(&cone.axis));
    let k2 = cone.cosine * cone.cosine;
    let a = dt * dt - k2 * direction.norm_squared();
    let b = dt * wt - k2 * direction.dot(&w);
    let c = wt * wt - k2 * w.norm_squared();
    solve_quadratic(a, b, c).filter(move |root| wt + root * dt > 0.0)
}

fn quadric_roots(quadric: &PrincipalQuadric, from: &Vec3, direction: &Vec3) -> impl Iterator<Item = f64> {
    let [a, b, c, d, f, g, h, l, m, n] = quadric.coefficients;
    let bilinear = |u: &Vec3, v: &Vec3| {
        a * u.x * v.x
            + b * u.y * v.y
            + c * u.z * v.z
            + f * (u.y * v.z + u.z * v.y)
            + g * (u.x * v.z + u.z * v.x)
            + h * (u.x * v.y + u.y * v.x)
    };
    let linear = Vec3::new(l, m, n);
    let square = bilinear(direction, direction);
    let middle = bilinear(direction, from) + linear.dot(direction);
    let constant = bilinear(from, from) + 2.0 * linear.dot(from) + d;
    solve_quadratic(square, middle, constant)
}
