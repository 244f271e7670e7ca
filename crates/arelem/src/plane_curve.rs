//! Lines and circles in the plane normal to the tool axis, for the exact two-dimensional routes.

use apt_geometry::{
    Vec3,
    surface::{Surface, solve_quadratic},
};

/// Sine below which a surface is parallel to the tool axis.
const PARALLEL: f64 = 1e-7;
/// Sine below which a line and a direction are parallel.
const NO_CROSSING: f64 = 1e-12;

/// A surface parallel to the tool axis, seen along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Curve {
    /// `normal·x = distance`.
    Line { normal: Vec3, distance: f64 },
    /// All points at a radius from the axis through the centre.
    Circle { center: Vec3, radius: f64 },
}

impl Curve {
    /// The curve of a surface that is parallel to the tool axis.
    pub(crate) fn of(surface: &Surface, axis: &Vec3) -> Option<Self> {
        match surface {
            Surface::Plane(plane) if plane.normal.dot(axis).abs() <= PARALLEL => {
                Some(Self::Line { normal: plane.normal, distance: plane.distance })
            }
            Surface::Cylinder(cylinder) if cylinder.axis.cross(axis).norm() <= PARALLEL => {
                Some(Self::Circle { center: cylinder.point, radius: cylinder.radius })
            }
            _ => None,
        }
    }

    /// Signed distance, positive on the side of the natural normal.
    pub(crate) fn signed_distance(&self, p: &Vec3, axis: &Vec3) -> f64 {
        match self {
            Self::Line { normal, distance } => normal.dot(p) - distance,
            Self::Circle { center, radius } => flat(&(p - center), axis).norm() - radius,
        }
    }

    /// Parameters at which a straight path is at a signed distance from the curve.
    pub(crate) fn line_crossings(&self, from: &Vec3, direction: &Vec3, level: f64, axis: &Vec3) -> Vec<f64> {
        match self {
            Self::Line { normal, distance } => {
                let cosine = normal.dot(direction);
                if cosine.abs() <= NO_CROSSING {
                    Vec::new()
                } else {
                    vec![(distance + level - normal.dot(from)) / cosine]
                }
            }
            Self::Circle { center, radius } => {
                let wanted = radius + level;
                if wanted < 0.0 {
                    return Vec::new();
                }
                let w = flat(&(from - center), axis);
                solve_quadratic(1.0, w.dot(direction), w.norm_squared() - wanted * wanted).collect()
            }
        }
    }

    /// Directions from the centre of a circular path at which it is at a signed distance from the curve, as pairs of a
    /// unit vector and the half angle to both sides of it.
    pub(crate) fn circle_crossings(
        &self,
        path_center: &Vec3,
        path_radius: f64,
        level: f64,
        axis: &Vec3,
    ) -> Option<(Vec3, f64)> {
        let (towards, cosine) = match self {
            Self::Line { normal, distance } => {
                (*normal, (distance + level - normal.dot(path_center)) / path_radius)
            }
            Self::Circle { center, radius } => {
                let wanted = radius + level;
                let v = flat(&(path_center - center), axis);
                let apart = v.norm();
                if wanted < 0.0 || apart <= NO_CROSSING * (radius + path_radius) {
                    return None;
                }
                let along =
                    (wanted * wanted - path_radius * path_radius - apart * apart) / (2.0 * path_radius);
                (v / apart, along / apart)
            }
        };
        (cosine.abs() <= 1.0).then(|| (towards, cosine.acos()))
    }

    /// Unit directions, seen from a centre, in which the curve runs parallel to a circle about that centre.
    pub(crate) fn parallel_directions(&self, path_center: &Vec3, axis: &Vec3) -> Option<Vec3> {
        match self {
            Self::Line { normal, .. } => Some(*normal),
            Self::Circle { center, .. } => flat(&(path_center - center), axis).try_normalize(NO_CROSSING),
        }
    }
}

/// The part of a vector normal to the axis.
pub(crate) fn flat(v: &Vec3, axis: &Vec3) -> Vec3 {
    v - axis * v.dot(axis)
}
