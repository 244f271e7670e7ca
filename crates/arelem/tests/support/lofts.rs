//! A ruled and a polyconic surface, both bent both ways, over x and y from −2 to 2.

use apt_geometry::{
    Vec3,
    canonical::{Cylinder, Geometry, Remembering, RuledSurface},
};

/// A roof between arcs of different radius at y = ±2.
pub(crate) fn roof() -> Geometry {
    let curve = |y: f64, z: f64, radius: f64| {
        let round = Cylinder { point: Vec3::new(0.0, y, z), axis: Vec3::y(), radius };
        let height = z + (radius * radius - 4.0).sqrt();
        let [start, end] = [-2.0, 2.0].map(|x| Geometry::Point(Vec3::new(x, y, height)));
        [Geometry::Cylinder(round), start, end, Geometry::Vector(Vec3::z())]
    };
    let parts = curve(-2.0, 0.0, 3.0).into_iter().chain(curve(2.0, 0.3, 2.6)).collect();
    Geometry::RuledSurface(Remembering::new(RuledSurface { parts }))
}

/// A vault along y that widens and flattens: quarter circles change to fuller conics.
pub(crate) fn vault() -> Geometry {
    let mut values = vec![1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    values.extend([0.0, -3.0, 6.0]);
    for [constant, linear] in
        [[2.0, 0.2], [2.0, 0.1], [2.0, 0.0], [-2.0, 0.0], [-2.0, -0.1], [0.3, -0.1], [0.7, 0.03]]
    {
        values.extend([constant, linear, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    }
    values.extend([0.0; 7]);
    Geometry::PolyConic(Remembering::new(values))
}
