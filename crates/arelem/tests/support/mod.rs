//! What the random motions are made of.

use apt_geometry::{
    Vec3,
    canonical::{Cone, Cylinder, Geometry, Plane, Quadric, Sphere},
    motion::NamedSurface,
};

/// A small generator of its own (splitmix64), so that the motions are the same on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ x >> 31) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    pub(crate) fn pick<T: Clone>(&mut self, from: &[T]) -> T {
        let index = (self.next() * from.len() as f64) as usize;
        from[index.min(from.len() - 1)].clone()
    }
}

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
