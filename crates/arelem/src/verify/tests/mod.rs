//! Tests of the verifier against closed forms, dense sampling and deliberately broken sequences.

mod barrels;
mod bends;
mod branches;
pub(crate) mod clearances;
mod depths;
mod edges;
mod every_kind;
mod followed;
mod halves;
mod lines;
#[path = "../../../tests/support/lofts.rs"]
pub(crate) mod lofts;
mod mutations;
mod paths;
mod poly_conics;
mod round_numbers;
mod ruled;
mod rulings;
mod searched;
mod sharp;
mod stock;
mod straight;
mod turning;
mod vertices;

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{
        Cone, Cylinder, Geometry, Interval, Plane, Quadric, Remembering, RuledSurface, Sphere,
        TabulatedCylinder,
    },
    cutter::Cutter,
    motion::{NamedSurface, Relation},
};

use super::clearance::Surface;
use crate::sequence::Role;

/// The signed distance of a point along the natural normal as the verifier measures it.
pub(crate) fn point_distance(geometry: &Geometry, x: &Vec3) -> f64 {
    Surface::of(geometry).expect("a surface").point_distance(x).expect("a distance").0
}

/// CUTTER/d,r and CUTTER/d,r,e,f,α,β,h; degrees.
pub(super) fn cutter(numbers: &[f64]) -> Cutter {
    match *numbers {
        [d, r] => Cutter {
            diameter: d,
            corner_radius: r,
            corner_offset: d / 2.0 - r,
            corner_height: r,
            alpha: 0.0,
            beta: 0.0,
            height: 5.0,
        },
        [d, r, e, f, alpha, beta, h] => Cutter {
            diameter: d,
            corner_radius: r,
            corner_offset: e,
            corner_height: f,
            alpha: alpha.to_radians(),
            beta: beta.to_radians(),
            height: h,
        },
        _ => panic!("two or seven numbers"),
    }
}

/// Cutters whose corner has its centre beyond the axis: a barrel that joins its flank smoothly, one with edges at both ends of its arc and
/// slanted lines, a flat lens, one whose arc reaches the axis above the tip (APT III 415), a drill point with a bulge, and a lens that leans
/// on its arc.
pub(crate) const BARRELS: [[f64; 7]; 6] = [
    [1.0, 3.0, -2.5, 1.5, 0.0, 0.0, 3.0],
    [1.0, 1.82, -1.2, 0.9, 10.0, 5.0, 2.5],
    [2.0, 20.0, -0.5, 19.98, 0.0, 0.0, 1.5],
    [1.0, 3.0, -2.5, 2.9, 0.0, 0.0, 4.0],
    [1.0, 2.2, -1.5, 1.6, 30.0, 0.0, 2.5],
    [1.0, 2.0, -0.1, 1.98, 0.0, 0.0, 2.5],
];

pub(super) fn plane(normal: [f64; 3], distance: f64) -> Geometry {
    let normal = Vec3::from(normal);
    Geometry::Plane(Plane { normal: normal.normalize(), distance: distance / normal.norm() })
}

pub(super) fn sphere(center: [f64; 3], radius: f64) -> Geometry {
    Geometry::Sphere(Sphere { center: Vec3::from(center), radius })
}

pub(super) fn cylinder(point: [f64; 3], axis: [f64; 3], radius: f64) -> Geometry {
    Geometry::Cylinder(Cylinder { point: Vec3::from(point), axis: Vec3::from(axis).normalize(), radius })
}

pub(super) fn cone(vertex: [f64; 3], axis: [f64; 3], half_angle: f64) -> Geometry {
    Geometry::Cone(Cone {
        vertex: Vec3::from(vertex),
        axis: Vec3::from(axis).normalize(),
        cosine: half_angle.to_radians().cos(),
    })
}

pub(super) fn quadric(coefficients: [f64; 10]) -> Geometry {
    Geometry::Quadric(Quadric { coefficients })
}

/// A tabulated cylinder through points with slopes dv/du, extensions of length 10 at both ends.
pub(crate) fn tabulated(axes: [Vec3; 3], nodes: &[[f64; 3]]) -> Geometry {
    let mut intervals = Vec::new();
    let reach = |slope: f64| 10.0 / slope.hypot(1.0);
    let straight =
        |u: f64, v: f64| Interval { u, v, a: 0.0, b: 0.0, length: 10.0, maximum: 0.0, minimum: 0.0 };
    let [u, v, slope] = nodes[0];
    intervals.push(straight(u - reach(slope), v - slope * reach(slope)));
    for pair in nodes.windows(2) {
        let ([u, v, before], [u2, v2, after]) = (pair[0], pair[1]);
        let length = (u2 - u).hypot(v2 - v);
        let turn = (v2 - v).atan2(u2 - u);
        let [s1, s2] = [before, after].map(|s| (s.atan() - turn).tan());
        let (a, b) = ((s1 + s2) / (length * length), -(2.0 * s1 + s2) / length);
        intervals.push(Interval { u, v, a, b, length, maximum: 0.0, minimum: 0.0 });
    }
    let [u, v, slope] = nodes[nodes.len() - 1];
    intervals.push(straight(u, v));
    let last = [u + reach(slope), v + slope * reach(slope)];
    Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder { axes, kind: 0.0, intervals, last }))
}

/// A curve of a ruled surface: its surface, ends and direction across the chord.
pub(super) fn section(surface: Geometry, ends: [[f64; 3]; 2], across: [f64; 3]) -> Vec<Geometry> {
    let [start, end] = ends.map(|p| Geometry::Point(Vec3::from(p)));
    vec![surface, start, end, Geometry::Vector(Vec3::from(across).normalize())]
}

pub(super) fn ruled(first: Vec<Geometry>, second: Vec<Geometry>) -> Geometry {
    Geometry::RuledSurface(Remembering::new(RuledSurface {
        parts: first.into_iter().chain(second).collect(),
    }))
}

pub(super) fn role(geometry: Geometry, relation: Relation, side: f64, intol: f64, outtol: f64) -> Role {
    Role {
        surface: NamedSurface { name: "S".to_owned(), geometry },
        relation,
        side,
        inside_tolerance: intol,
        outside_tolerance: outtol,
        thickness: 0.0,
        disk: None,
    }
}

/// A ruled and a polyconic surface.
pub(crate) fn lofted() -> [Geometry; 2] {
    [lofts::roof(), lofts::vault()]
}
