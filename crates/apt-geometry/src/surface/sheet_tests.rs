//! Ruled and polyconic surfaces against dense samples, difference quotients, and themselves moved.

use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::canonical::{Matrix, RuledSurface, matrix::CoordinatePlane};

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

fn curve(surface: Geometry, start: Vec3, end: Vec3, across: Vec3) -> Vec<Geometry> {
    vec![surface, Geometry::Point(start), Geometry::Point(end), Geometry::Vector(across)]
}

fn ruled(first: Vec<Geometry>, second: Vec<Geometry>) -> Geometry {
    let parts = first.into_iter().chain(second).collect();
    Geometry::RuledSurface(Arc::new(RuledSurface { parts }))
}

fn plane(normal: Vec3, distance: f64) -> Geometry {
    Geometry::Plane(Plane { normal, distance })
}

fn circle(x: f64, y: f64, radius: f64) -> Geometry {
    Geometry::Circle(Cylinder { point: v(x, y, 0.0), axis: Vec3::z(), radius })
}

/// A twisted plane strip; its first edge is the x axis.
fn twisted() -> Geometry {
    ruled(
        curve(plane(Vec3::z(), 0.0), v(0.0, 0.0, 0.0), v(6.0, 0.0, 0.0), Vec3::z()),
        curve(plane(v(-1.0, 0.0, 6.0), 6.0), v(0.0, 4.0, 1.0), v(6.0, 4.0, 2.0), Vec3::z()),
    )
}

/// Between an arc of a circle of radius 6 in z = 0 and one of radius 4 in z = 5.
fn between_arcs() -> Geometry {
    let (a, b) = ((36f64 - 9.0).sqrt(), (16f64 - 4.0).sqrt());
    ruled(
        curve(circle(0.0, 0.0, 6.0), v(-3.0, a, 0.0), v(3.0, a, 0.0), Vec3::y()),
        curve(circle(0.5, 1.0, 4.0), v(-1.5, 1.0 + b, 5.0), v(2.5, 1.0 + b, 5.0), Vec3::y()),
    )
}

/// A quarter of a circular cone with its vertex at z = 3.
fn cone_piece() -> Geometry {
    let mut parts = curve(circle(0.0, 0.0, 2.0), v(2.0, 0.0, 0.0), v(0.0, 2.0, 0.0), v(1.0, 1.0, 0.0));
    parts.push(Geometry::Point(v(0.0, 0.0, 3.0)));
    Geometry::RuledSurface(Arc::new(RuledSurface { parts }))
}

/// Over the diameter of a circle to a straight line.
fn half_pipe() -> Geometry {
    ruled(
        curve(circle(0.0, 0.0, 2.0), v(-2.0, 0.0, 0.0), v(2.0, 0.0, 0.0), Vec3::y()),
        curve(plane(Vec3::y(), 1.0), v(-2.0, 1.0, 4.0), v(2.0, 1.0, 4.0), Vec3::y()),
    )
}

fn sheets() -> Vec<Geometry> {
    vec![twisted(), between_arcs(), cone_piece()]
}

/// The surfaces of [`sheets`], made once.
fn sheet(which: usize) -> &'static Surface {
    static MADE: std::sync::OnceLock<Vec<Surface>> = std::sync::OnceLock::new();
    &MADE.get_or_init(|| sheets().iter().map(surface).collect())[which]
}

fn surface(geometry: &Geometry) -> Surface {
    Surface::from_geometry(geometry).expect("a surface")
}

/// Exact point of a ruled test surface by its definition.
fn exact(which: usize, t: f64, share: f64) -> Vec3 {
    let arc = |x: f64, y: f64, radius: f64, left: f64, width: f64, z: f64| {
        let along = left + width * t;
        v(along, y + (radius * radius - (along - x) * (along - x)).sqrt(), z)
    };
    let (first, second) = match which {
        0 => (v(6.0 * t, 0.0, 0.0), v(6.0 * t, 4.0, 1.0 + t)),
        1 => (arc(0.0, 0.0, 6.0, -3.0, 6.0, 0.0), arc(0.5, 1.0, 4.0, -1.5, 4.0, 5.0)),
        _ => {
            let chord = v(2.0 - 2.0 * t, 2.0 * t, 0.0);
            let out = v(1.0, 1.0, 0.0).normalize();
            let height = -chord.dot(&out) + (4.0 - chord.norm_squared() + chord.dot(&out).powi(2)).sqrt();
            (chord + out * height, v(0.0, 0.0, 3.0))
        }
    };
    first + (second - first) * share
}

#[test]
fn rulings_join_equal_shares_of_the_chords() {
    for (which, geometry) in sheets().iter().enumerate() {
        let sheet = surface(geometry);
        for i in 0..=20 {
            for j in 0..=10 {
                let place = exact(which, f64::from(i) / 20.0, f64::from(j) / 10.0);
                let distance = sheet.signed_distance(&place);
                assert!(distance.abs() < 1e-10, "surface {which} at {i}, {j}: {distance:e}");
            }
        }
    }
}

#[test]
fn the_natural_normal_is_chord_times_ruling() {
    let normal = surface(&twisted()).natural_normal(&v(3.0, 0.0, 0.0)).expect("a normal");
    let expected = Vec3::x().cross(&v(0.0, 4.0, 1.5)).normalize();
    assert!((normal - expected).norm() < 1e-9, "{normal}");
}

#[test]
fn a_section_over_the_diameter_is_followed_to_its_ends() {
    let sheet = surface(&half_pipe());
    for degrees in [0.5f64, 5.0, 45.0, 90.0, 179.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let distance = sheet.signed_distance(&v(2.0 * cos, 2.0 * sin, 0.0));
        assert!(distance.abs() < 2e-6, "{degrees}: {distance:e}");
    }
}

#[test]
fn a_section_that_misses_its_end_points_is_degenerate() {
    let astray = ruled(
        curve(circle(0.0, 0.0, 6.0), v(-3.0, 5.0, 0.0), v(3.0, 2.0, 0.0), Vec3::y()),
        curve(plane(Vec3::y(), 1.0), v(-2.0, 1.0, 4.0), v(2.0, 1.0, 4.0), Vec3::y()),
    );
    let kind = GeometryKind::RuledSurface;
    assert_eq!(Surface::from_geometry(&astray), Err(SurfaceError::Degenerate { kind }));
}

#[test]
fn a_tabulated_cylinder_may_carry_a_curve() {
    let row = |u: f64, v: f64, a: f64, b: f64| crate::canonical::Interval {
        u,
        v,
        a,
        b,
        length: 0.0,
        maximum: 0.0,
        minimum: 0.0,
    };
    let table = Geometry::TabulatedCylinder(Arc::new(crate::canonical::TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals: vec![
            row(-10.0, 4.0, 0.0, 0.0),
            row(0.0, 0.0, 0.15, -0.1),
            row(2.0, 0.0, -0.1, 0.2),
            row(4.0, 1.0, 0.0, 0.0),
        ],
        last: [14.0, 5.0],
    }));
    let sheet = ruled(
        curve(table.clone(), v(0.0, 0.0, 0.0), v(4.0, 1.0, 0.0), Vec3::y()),
        curve(table.clone(), v(0.0, 0.0, 3.0), v(4.0, 1.0, 3.0), Vec3::y()),
    );
    let (sheet, table) = (surface(&sheet), surface(&table));
    for k in 0..=40 {
        let above = v(0.1 * f64::from(k), 3.0, 1.5);
        let down = table.directed_distance(&above, &-Vec3::y(), RootSelection::Ahead).expect("a hit");
        let place = above - Vec3::y() * down;
        assert!(sheet.signed_distance(&place).abs() < 1e-9, "{k}: {:e}", sheet.signed_distance(&place));
    }
}

fn moved(geometry: &Geometry, matrix: &Matrix) -> Surface {
    surface(&geometry.transform(matrix).expect("a rigid motion"))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]
    #[test]
    fn the_foot_is_nearer_than_every_sample(which in 0usize..3, x in -4.0..8.0, y in -3.0..8.0, z in -3.0..6.0) {
        let sheet = sheet(which);
        let p = v(x, y, z);
        let foot = sheet.foot(&p);
        let mut nearest = f64::INFINITY;
        for i in 0..=60 {
            for j in 0..=40 {
                nearest = nearest.min((p - exact(which, f64::from(i) / 60.0, f64::from(j) / 40.0)).norm());
            }
        }
        prop_assert!(foot.distance.abs() <= nearest + 1e-9, "{} beside {nearest}", foot.distance);
        prop_assert!((foot.distance.abs() - (p - foot.point).norm()).abs() < 1e-9);
        prop_assert!(sheet.signed_distance(&foot.point).abs() < 1e-9);
        prop_assert!(((p - foot.point) - foot.normal * foot.distance).norm() < 1e-8);
    }

    #[test]
    fn gradient_and_hessian_are_those_of_the_distance(
        which in 0usize..3, x in -3.0..7.0, y in -1.0..7.0, z in -1.0..5.0, a in -1.0..1.0, b in -1.0..1.0,
    ) {
        let sheet = sheet(which);
        let p = v(x, y, z);
        let (foot, hessian) = sheet.foot_and_hessian(&p);
        let direction = v(a, b, 0.7).normalize();
        let h = 1e-5;
        let (ahead, behind) = (sheet.foot(&(p + direction * h)), sheet.foot(&(p - direction * h)));
        // Away from the medial axis the distance is smooth.
        if (ahead.point - behind.point).norm() < 20.0 * h && foot.distance.abs() > 1e-6 {
            let slope = (ahead.distance - behind.distance) / (2.0 * h);
            prop_assert!((slope - foot.normal.dot(&direction)).abs() < 1e-5, "slope {slope}");
            let bend = (ahead.normal - behind.normal) / (2.0 * h);
            let expected = hessian * direction;
            prop_assert!((bend - expected).norm() < 2e-3 * (1.0 + expected.norm()), "{bend} {expected}");
        }
    }

    #[test]
    fn directed_distances_end_on_the_sheet(
        which in 0usize..3, t in 0.05..0.95, share in 0.05..0.95, x in -1.0..1.0, y in -1.0..1.0, far in 0.1..9.0,
    ) {
        let sheet = sheet(which);
        let place = exact(which, t, share);
        let direction = v(x, y, 0.6).normalize();
        if sheet.natural_normal(&place).expect("a normal").dot(&direction).abs() < 0.05 {
            return Ok(());
        }
        let from = place - direction * far;
        let found = sheet.directed_distance(&from, &(direction * 2.0), RootSelection::Ahead).expect("a hit");
        prop_assert!(found * 2.0 <= far + 1e-8, "{} beyond {far}", found * 2.0);
        prop_assert!(sheet.signed_distance(&(from + direction * (2.0 * found))).abs() < 1e-8);
    }

    #[test]
    fn rigid_motions_and_scales_carry_the_distance(
        which in 0usize..3, x in -3.0..7.0, y in -1.0..7.0, z in -1.0..5.0, turn in -180.0..180.0, large in any::<bool>(),
    ) {
        let geometry = &sheets()[which];
        let scale = if large { 25.4 } else { 1.0 };
        let matrix = Matrix::translation(v(3.0, -2.0, 7.0))
            .multiply(&Matrix::rotation(CoordinatePlane::Xy, turn))
            .multiply(&Matrix::rotation(CoordinatePlane::Yz, 0.5 * turn))
            .multiply(&Matrix::scaling(scale));
        let p = v(x, y, z);
        let here = sheet(which).foot(&p);
        let there = moved(geometry, &matrix).foot(&matrix.apply_point(&p));
        prop_assert!((there.distance - scale * here.distance).abs() < 1e-8 * scale);
    }
}
