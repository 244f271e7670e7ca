//! What the random motions are made of.

mod random;

use apt_geometry::{
    Vec3,
    canonical::{Cone, Cylinder, Geometry, Plane, Quadric, Sphere},
    motion::NamedSurface,
};

pub(crate) use self::random::Random;

pub(crate) fn named(name: &str, geometry: Geometry) -> NamedSurface {
    NamedSurface { name: name.to_owned(), geometry }
}

pub(crate) fn plane(x: f64, y: f64, z: f64, distance: f64) -> Geometry {
    let normal = Vec3::new(x, y, z);
    Geometry::Plane(Plane { normal: normal.normalize(), distance: distance / normal.norm() })
}

pub(crate) fn sphere(height: f64, radius: f64) -> Geometry {
    Geometry::Sphere(Sphere { center: Vec3::new(0.0, 0.0, height), radius })
}

pub(crate) fn cylinder(height: f64, axis: Vec3, radius: f64) -> Geometry {
    Geometry::Cylinder(Cylinder { point: Vec3::new(0.0, 0.0, height), axis: axis.normalize(), radius })
}

pub(crate) fn cone(height: f64, axis: Vec3, cosine: f64) -> Geometry {
    Geometry::Cone(Cone { vertex: Vec3::new(0.0, 0.0, height), axis, cosine })
}

pub(crate) fn quadric(coefficients: [f64; 10]) -> Geometry {
    Geometry::Quadric(Quadric { coefficients })
}
