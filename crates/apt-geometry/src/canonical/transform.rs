//! Geometry under an affine map `x' = M x`, as REFSYS and TRACUT move it.
//!
//! Planes take the inverse transpose of the map, quadrics the congruence with its inverse: these stay what they are
//! under every map that can be inverted. Circles, cylinders, spheres, cones and tabulated cylinders stay what they
//! are only if the map keeps their sections round (or, for the last, to scale); otherwise the error says so. A circle
//! is the infinite cylinder that it stands for: a map that tilts z tilts its axis.

use std::sync::Arc;

use nalgebra::Matrix3;

use super::{
    Cone, Cylinder, Geometry, GeometryKind, Interval, Matrix, Pattern, Plane, Remembering, Sphere,
    TabulatedCylinder,
};
use crate::Vec3;

/// Departure from a round section, relative, that is taken as rounding in the numbers of the matrix: processors with
/// nine-digit degree constants and sources with six decimals write matrices that are this far from orthogonal.
const ROUNDNESS: f64 = 2e-6;

/// Why geometry has no image of its type.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TransformError {
    /// The matrix cannot be inverted.
    #[error("the matrix is singular")]
    Singular,
    /// The map does not keep the round section of this type.
    #[error("the map distorts a {kind:?} by {distortion}")]
    Distorted {
        /// The type.
        kind: GeometryKind,
        /// Relative difference between the scales of the section, 0 for a similarity.
        distortion: f64,
    },
    /// This type is not moved (MATRIX, LOFT, or a POLCON whose values have no meaning).
    #[error("a {kind:?} is not moved")]
    NotMoved {
        /// The type.
        kind: GeometryKind,
    },
}

impl TransformError {
    /// The APT III diagnostic number, if the case has one.
    pub fn apt3(&self) -> Option<u16> {
        match self {
            TransformError::Singular | TransformError::Distorted { .. } => Some(1005),
            TransformError::NotMoved { .. } => Some(1006),
        }
    }
}

impl Geometry {
    /// The image under `x' = M x`.
    ///
    /// # Errors
    /// The matrix is singular, it distorts a round section, or the type does not move.
    pub fn transform(&self, matrix: &Matrix) -> Result<Geometry, TransformError> {
        let kind = self.kind();
        let inverse = || matrix.inverse().ok_or(TransformError::Singular);
        Ok(match self {
            Geometry::Point(point) => Geometry::Point(matrix.apply_point(point)),
            Geometry::Vector(vector) => Geometry::Vector(matrix.apply_vector(vector)),
            Geometry::Line(plane) => Geometry::Line(plane_image(plane, matrix)?),
            Geometry::Plane(plane) => Geometry::Plane(plane_image(plane, matrix)?),
            Geometry::Circle(cylinder) => Geometry::Circle(cylinder_image(cylinder, matrix, kind)?),
            Geometry::Cylinder(cylinder) => Geometry::Cylinder(cylinder_image(cylinder, matrix, kind)?),
            Geometry::Sphere(sphere) => Geometry::Sphere(sphere_image(sphere, matrix)?),
            Geometry::Cone(cone) => Geometry::Cone(cone_image(cone, matrix)?),
            Geometry::Ellipse(quadric) => Geometry::Ellipse(quadric.under_inverse(&inverse()?)),
            Geometry::Hyperbola(quadric) => Geometry::Hyperbola(quadric.under_inverse(&inverse()?)),
            Geometry::GeneralConic(quadric) => Geometry::GeneralConic(quadric.under_inverse(&inverse()?)),
            Geometry::LoftConic(quadric) => Geometry::LoftConic(quadric.under_inverse(&inverse()?)),
            Geometry::Quadric(quadric) => Geometry::Quadric(quadric.under_inverse(&inverse()?)),
            Geometry::TabulatedCylinder(surface) => {
                Geometry::TabulatedCylinder(Arc::new(tabulated_image(surface, matrix)?))
            }
            Geometry::RuledSurface(surface) => {
                Geometry::RuledSurface(Remembering::new(surface.image(matrix)?))
            }
            Geometry::Pattern(pattern) => Geometry::Pattern(Arc::new(Pattern {
                points: pattern.points.iter().map(|point| matrix.apply_point(point)).collect(),
                ..Pattern::clone(pattern)
            })),
            Geometry::Sculptured(surface) => {
                inverse()?;
                Geometry::Sculptured(Remembering::new(surface.transformed(matrix)))
            }
            Geometry::SpaceCurve(curve) => {
                inverse()?;
                Geometry::SpaceCurve(Arc::new(curve.transformed(matrix)))
            }
            Geometry::PolyConic(values) => {
                Geometry::PolyConic(Remembering::new(super::poly_conic::image(values, matrix)?))
            }
            Geometry::Matrix(_) | Geometry::Loft(_) | Geometry::Mesh(_) | Geometry::ElementSurface(_) => {
                return Err(TransformError::NotMoved { kind });
            }
        })
    }
}

/// Inverse transpose of the linear part, which takes normals to normals (up to their length).
fn normal_map(matrix: &Matrix) -> Result<Matrix3<f64>, TransformError> {
    Ok(matrix.inverse().ok_or(TransformError::Singular)?.linear().transpose())
}

/// `n·x = d` becomes `(M⁻ᵀ n)·x' = d + (M⁻ᵀ n)·shift`, divided by the growth of the normal so that a unit normal stays
/// one and one that CANON entered with another length keeps that length.
fn plane_image(plane: &Plane, matrix: &Matrix) -> Result<Plane, TransformError> {
    let normal = normal_map(matrix)? * plane.normal;
    let growth = normal.norm() / plane.normal.norm();
    if !(growth > 0.0 && growth.is_finite()) {
        return Err(TransformError::Singular);
    }
    Ok(Plane { normal: normal / growth, distance: (plane.distance + normal.dot(&matrix.shift())) / growth })
}

/// The section of a cylinder across its axis under the map, seen along the new axis: the common scale if the section
/// stays round. With `Q` the form `M⁻ᵀ(1 − aaᵀ)M⁻¹`, whose eigenvalues are `0, 1/s₁², 1/s₂²`.
fn section_scale(linear: &Matrix3<f64>, axis: &Vec3, kind: GeometryKind) -> Result<f64, TransformError> {
    let image = (linear * axis).try_normalize(0.0).ok_or(TransformError::Singular)?;
    let first = perpendicular(axis);
    let second = axis.cross(&first);
    let across = |direction: &Vec3| {
        let moved = linear * direction;
        moved - image * image.dot(&moved)
    };
    let (first, second) = (across(&first), across(&second));
    let (a, b, c) = (first.norm_squared(), first.dot(&second), second.norm_squared());
    let mean = 0.5 * (a + c);
    let spread = (0.5 * (a - c)).hypot(b);
    if mean.is_nan() || mean <= 0.0 {
        return Err(TransformError::Singular);
    }
    let distortion = spread / mean;
    if distortion > ROUNDNESS {
        return Err(TransformError::Distorted { kind, distortion });
    }
    Ok(mean.sqrt())
}

/// A unit vector across `axis`.
fn perpendicular(axis: &Vec3) -> Vec3 {
    let least = axis.iamin();
    let mut across = Vec3::zeros();
    across[least] = 1.0;
    let across = axis.cross(&across);
    across.try_normalize(0.0).unwrap_or_else(Vec3::x)
}

fn cylinder_image(
    cylinder: &Cylinder,
    matrix: &Matrix,
    kind: GeometryKind,
) -> Result<Cylinder, TransformError> {
    let linear = matrix.linear();
    let unit = cylinder.axis.try_normalize(0.0).ok_or(TransformError::Singular)?;
    let scale = section_scale(&linear, &unit, kind)?;
    let axis = (linear * unit).try_normalize(0.0).ok_or(TransformError::Singular)?;
    Ok(Cylinder { point: matrix.apply_point(&cylinder.point), axis, radius: cylinder.radius * scale })
}

fn sphere_image(sphere: &Sphere, matrix: &Matrix) -> Result<Sphere, TransformError> {
    let scale = similarity(matrix, GeometryKind::Sphere)?;
    Ok(Sphere { center: matrix.apply_point(&sphere.center), radius: sphere.radius * scale })
}

/// The common scale of a similarity.
fn similarity(matrix: &Matrix, kind: GeometryKind) -> Result<f64, TransformError> {
    if let Some(scale) = matrix.uniform_scale(ROUNDNESS) {
        return Ok(scale);
    }
    let linear = matrix.linear();
    let scales = (linear.transpose() * linear).symmetric_eigenvalues();
    let (least, greatest) = (scales.min().max(0.0).sqrt(), scales.max().sqrt());
    if least.is_nan() || least <= 0.0 {
        return Err(TransformError::Singular);
    }
    Err(TransformError::Distorted { kind, distortion: (greatest - least) / greatest })
}

/// A cone stays circular under a similarity, and under a map that stretches along its axis: the tangent of the half
/// angle takes the ratio of the two scales.
fn cone_image(cone: &Cone, matrix: &Matrix) -> Result<Cone, TransformError> {
    let kind = GeometryKind::Cone;
    let linear = matrix.linear();
    let unit = cone.axis.try_normalize(0.0).ok_or(TransformError::Singular)?;
    let across = section_scale(&linear, &unit, kind)?;
    let image = linear * unit;
    let along = image.norm();
    let axis = image.try_normalize(0.0).ok_or(TransformError::Singular)?;
    // The directions across the axis must stay across it, or the sections lean.
    let first = perpendicular(&unit);
    let lean = (linear * first).dot(&axis).hypot((linear * unit.cross(&first)).dot(&axis)) / across;
    if lean > ROUNDNESS {
        return Err(TransformError::Distorted { kind, distortion: lean });
    }
    let ratio = across / along;
    let cosine = if (ratio - 1.0).abs() <= ROUNDNESS {
        cone.cosine
    } else {
        cone.cosine / cone.cosine.hypot(cone.sine() * ratio)
    };
    Ok(Cone { vertex: matrix.apply_point(&cone.vertex), axis, cosine })
}

/// The directrix moves in the plane across the new generatrix. The sense of the new w axis follows from the u and v
/// axes, so that a mirrored cylinder keeps a right-handed system.
fn tabulated_image(
    surface: &TabulatedCylinder,
    matrix: &Matrix,
) -> Result<TabulatedCylinder, TransformError> {
    let linear = matrix.linear();
    let [u, v, w] = &surface.axes;
    let scale = section_scale(&linear, w, GeometryKind::TabulatedCylinder)?;
    let rulings = (linear * w).try_normalize(0.0).ok_or(TransformError::Singular)?;
    let across = |direction: &Vec3| {
        let moved = linear * direction;
        (moved - rulings * rulings.dot(&moved)).try_normalize(0.0).ok_or(TransformError::Singular)
    };
    let new_u = across(u)?;
    let sense = if new_u.cross(&across(v)?).dot(&rulings) < 0.0 { -1.0 } else { 1.0 };
    let new_w = rulings * sense;
    let new_v = new_w.cross(&new_u);
    let (shift_u, shift_v) = (new_u.dot(&matrix.shift()), new_v.dot(&matrix.shift()));
    let moved = |interval: &Interval| Interval {
        u: scale * interval.u + shift_u,
        v: scale * interval.v + shift_v,
        a: interval.a / (scale * scale),
        b: interval.b / scale,
        length: scale * interval.length,
        ..*interval
    };
    Ok(TabulatedCylinder {
        axes: [new_u, new_v, new_w],
        kind: surface.kind,
        intervals: surface.intervals.iter().map(moved).collect(),
        last: [scale * surface.last[0] + shift_u, scale * surface.last[1] + shift_v],
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{Quadric, matrix::CoordinatePlane};
    use super::*;

    fn similarity_map(degrees: [f64; 2], scale: f64, shift: [f64; 3], mirror: bool) -> Matrix {
        let turn = Matrix::rotation(CoordinatePlane::Xy, degrees[0])
            .multiply(&Matrix::rotation(CoordinatePlane::Yz, degrees[1]));
        let flip = if mirror {
            Matrix::reflection(&Plane { normal: Vec3::x(), distance: 0.5 })
        } else {
            Matrix::identity()
        };
        Matrix::translation(Vec3::from(shift))
            .multiply(&turn)
            .multiply(&Matrix::scaling(scale))
            .multiply(&flip)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        /// A point at signed distance d of a surface maps to one at distance |scale|·d of the surface's image.
        #[test]
        fn distances_scale_with_a_similarity(
            turn in [-180.0..180.0f64, -180.0..180.0], scale in 0.2..5.0f64, shift in [-9.0..9.0f64, -9.0..9.0, -9.0..9.0],
            mirror: bool, at in [-9.0..9.0f64, -9.0..9.0, -9.0..9.0], seat in [-9.0..9.0f64, -9.0..9.0, -9.0..9.0],
            axis in [0.1..1.0f64, -1.0..1.0, -1.0..1.0], radius in 0.5..4.0f64,
        ) {
            let matrix = similarity_map(turn, scale, shift, mirror);
            let (at, seat) = (Vec3::from(at), Vec3::from(seat));
            let axis = Vec3::from(axis).normalize();
            let image = matrix.apply_point(&at);

            let plane = Plane { normal: axis, distance: radius };
            let Ok(Geometry::Plane(moved)) = Geometry::Plane(plane).transform(&matrix) else { panic!("a plane") };
            prop_assert!((moved.signed_distance(&image) - scale * plane.signed_distance(&at)).abs() < 1e-9);

            let cylinder = Cylinder { point: seat, axis, radius };
            let Ok(Geometry::Cylinder(moved)) = Geometry::Cylinder(cylinder).transform(&matrix) else { panic!("a cylinder") };
            prop_assert!((moved.signed_distance(&image) - scale * cylinder.signed_distance(&at)).abs() < 1e-9);

            let sphere = Sphere { center: seat, radius };
            let Ok(Geometry::Sphere(moved)) = Geometry::Sphere(sphere).transform(&matrix) else { panic!("a sphere") };
            prop_assert!((moved.signed_distance(&image) - scale * sphere.signed_distance(&at)).abs() < 1e-9);

            let cone = Cone { vertex: seat, axis, cosine: 0.8 };
            let Ok(Geometry::Cone(moved)) = Geometry::Cone(cone).transform(&matrix) else { panic!("a cone") };
            let angle = |cone: &Cone, point: &Vec3| cone.axis.dot(&(point - cone.vertex)) / (point - cone.vertex).norm();
            prop_assert!((angle(&moved, &image) - angle(&cone, &at)).abs() < 1e-9 && moved.cosine == 0.8);

            let quadric = Quadric { coefficients: [1.0, 2.0, -3.0, 10.0, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5] };
            let Ok(Geometry::Quadric(moved)) = Geometry::Quadric(quadric).transform(&matrix) else { panic!("a quadric") };
            let (value, size) = moved.value_with_size(&image);
            prop_assert!((value - quadric.value(&at)).abs() < 1e-9 * size.max(1.0));
        }

        /// The points of a tabulated cylinder's directrix stay on it.
        #[test]
        fn tabulated_cylinders_move_with_their_points(
            turn in [-180.0..180.0f64, -180.0..180.0], scale in 0.2..5.0f64, shift in [-9.0..9.0f64, -9.0..9.0, -9.0..9.0],
            mirror: bool,
        ) {
            let matrix = similarity_map(turn, scale, shift, mirror);
            let interval = Interval { u: 1.0, v: 2.0, a: 0.1, b: 0.2, length: 5.0, maximum: 0.0, minimum: -0.3 };
            let surface = TabulatedCylinder {
                axes: [Vec3::x(), -Vec3::z(), Vec3::y()], kind: 0.0, intervals: vec![interval], last: [4.0, 6.0],
            };
            let place = |surface: &TabulatedCylinder, s: f64| {
                let interval = surface.intervals[0];
                let chord = Vec3::new(surface.last[0] - interval.u, surface.last[1] - interval.v, 0.0) / interval.length;
                let height = s * (s - interval.length) * (interval.a * (s + interval.length) + interval.b);
                let (u, v) = (interval.u + s * chord.x - height * chord.y, interval.v + s * chord.y + height * chord.x);
                surface.axes[0] * u + surface.axes[1] * v
            };
            let geometry = Geometry::TabulatedCylinder(Arc::new(surface.clone()));
            let Ok(Geometry::TabulatedCylinder(moved)) = geometry.transform(&matrix) else { panic!("a tabcyl") };
            let [u, v, w] = moved.axes;
            prop_assert!((u.cross(&v) - w).norm() < 1e-12);
            for part in [0.0, 0.3, 0.7, 1.0] {
                let image = matrix.apply_point(&place(&surface, 5.0 * part));
                let found = place(&moved, moved.intervals[0].length * part) - image;
                prop_assert!((found - w * w.dot(&found)).norm() < 1e-9);
            }
        }
    }

    #[test]
    fn a_map_that_stretches_across_the_axis_is_refused() {
        let mut matrix = Matrix::identity();
        matrix.rows[0][0] = 2.0;
        let circle = Geometry::Circle(Cylinder::circle(1.0, 2.0, 3.0));
        assert!(matches!(
            circle.transform(&matrix),
            Err(TransformError::Distorted { kind: GeometryKind::Circle, .. })
        ));
        let mut along = Matrix::identity();
        along.rows[2][2] = 2.0;
        assert_eq!(circle.transform(&along), Ok(circle.clone()));
        let cone = Cone { vertex: Vec3::zeros(), axis: Vec3::z(), cosine: 0.5f64.sqrt() };
        let Ok(Geometry::Cone(steep)) = Geometry::Cone(cone).transform(&along) else { panic!("a cone") };
        assert!((steep.sine() / steep.cosine - 0.5).abs() < 1e-12);
        assert!(matches!(
            Geometry::Sphere(Sphere { center: Vec3::zeros(), radius: 1.0 }).transform(&along),
            Err(TransformError::Distorted { .. })
        ));
    }

    #[test]
    fn singular_maps_and_unmoved_types_are_errors() {
        let flat = Matrix::scaling(0.0);
        let line = Geometry::Line(Plane { normal: Vec3::x(), distance: 1.0 });
        assert_eq!(line.transform(&flat), Err(TransformError::Singular));
        let matrix = Geometry::Matrix(Matrix::identity());
        assert_eq!(
            matrix.transform(&Matrix::identity()),
            Err(TransformError::NotMoved { kind: GeometryKind::Matrix })
        );
    }
}
