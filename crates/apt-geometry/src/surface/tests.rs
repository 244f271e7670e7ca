use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::{
    canonical::{Cone, Interval, Quadric, TabulatedCylinder},
    patience::Patience,
};

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1.1e-9, "found {found}, expected {expected}");
}

fn surface(geometry: &Geometry) -> Surface {
    Surface::from_geometry(geometry).expect("a surface")
}

fn ellipsoid() -> Surface {
    // x²/4 + y² + z²/2.25 = 1.
    let coefficients = [0.25, 1.0, 1.0 / 2.25, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    surface(&Geometry::Quadric(Quadric { coefficients }))
}

fn tabulated() -> Surface {
    let row =
        |u: f64, v: f64, a: f64, b: f64| Interval { u, v, a, b, length: 0.0, maximum: 0.0, minimum: 0.0 };
    surface(&Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals: vec![row(-10.0, 50.0, 0.0, 0.0), row(0.0, 0.0, 0.15, -0.1), row(2.0, 0.0, 0.0, 0.0)],
        last: [12.0, 30.0],
    })))
}

#[test]
fn w01_to_w04_quadratic_roots() {
    let choose = |a, b, c, s: RootSelection| s.choose(solve_quadratic(a, b, c));
    for selection in [RootSelection::Nearest, RootSelection::Ahead, RootSelection::AheadElseNearest] {
        near(choose(1.0, -3.0, 5.0, selection).expect("root"), 1.0);
    }
    near(choose(1.0, 1.0, -6.0, RootSelection::Nearest).expect("root"), 1.645751311);
    near(choose(1.0, 1.0, -6.0, RootSelection::Ahead).expect("root"), 1.645751311);
    near(choose(1.0, 3.0, 5.0, RootSelection::Nearest).expect("root"), -1.0);
    near(choose(1.0, 3.0, 5.0, RootSelection::AheadElseNearest).expect("root"), -1.0);
    assert_eq!(choose(1.0, 3.0, 5.0, RootSelection::Ahead), None);
    let small = choose(1.0, 1e8, 1.0, RootSelection::Nearest).expect("root");
    assert!((small + 5e-9).abs() < 1e-18, "{small}");
}

#[test]
fn w05_to_w09_directed_distances() {
    let (p, d) = (v(1.0, 2.0, 3.0), v(0.0, 0.6, -0.8));
    let plane = Plane { normal: v(2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0), distance: 1.5 };
    let distance = |s: &Surface, p: &Vec3, d: &Vec3, f| s.directed_distance(p, d, f).expect("hit");
    near(distance(&surface(&Geometry::Plane(plane)), &p, &d, RootSelection::Ahead), 5.5);
    let sphere = Sphere { center: v(1.0, 3.0, 1.5), radius: 1.0 };
    near(distance(&surface(&Geometry::Sphere(sphere)), &p, &d, RootSelection::Ahead), 0.805012563);
    let cylinder = Cylinder { point: v(0.0, 1.0, 0.0), axis: v(1.0, 1.0, 0.0), radius: 2.0 };
    near(distance(&surface(&Geometry::Cylinder(cylinder)), &p, &d, RootSelection::Ahead), 1.355597716);
    let cone = surface(&Geometry::Cone(Cone {
        vertex: Vec3::zeros(),
        axis: Vec3::z(),
        cosine: 30f64.to_radians().cos(),
    }));
    let ray = v(0.05, 0.0, -1.0).normalize();
    near(distance(&cone, &v(0.1, 0.0, 0.5), &ray, RootSelection::Nearest), 0.301124970);
    let behind = cone.directed_distance(&v(0.0, 0.0, -1.0), &v(1.0, 0.0, -0.2), RootSelection::Nearest);
    assert_eq!(behind, Err(NoDistance), "both roots lie on the false nappe");
    near(distance(&ellipsoid(), &v(0.5, 0.2, 4.0), &v(0.0, 0.0, -1.0), RootSelection::Ahead), 2.578952851);
}

#[test]
fn w10_w11_normals() {
    let normal = ellipsoid().natural_normal(&v(1.0, 0.5, 1.060660172)).expect("normal");
    for (found, expected) in normal.iter().zip([0.341881729, 0.683763459, 0.644658371]) {
        near(*found, expected);
    }
    let cone = Cone { vertex: Vec3::zeros(), axis: Vec3::z(), cosine: 30f64.to_radians().cos() };
    let cone = surface(&Geometry::Cone(cone));
    let normal = cone.natural_normal(&v(1.0, 0.0, 1.0)).expect("normal");
    near(normal.x, 0.866025404);
    near(normal.z, -0.5);
    assert_eq!(cone.natural_normal(&Vec3::zeros()), Err(NoNormal));
    assert_eq!(cone.natural_normal(&v(0.0, 0.0, 2.0)), Err(NoNormal));
    assert_eq!(cone.natural_normal(&v(0.1, 0.0, -2.0)), Err(NoNormal));
}

#[test]
fn a_tabulated_cylinder_has_no_foot_for_a_place_without_coordinates_and_says_so() {
    for place in [[f64::NAN, 0.0, 0.0], [0.0, f64::NAN, 0.0], [f64::INFINITY, f64::NEG_INFINITY, 0.0]] {
        assert!(!tabulated().foot(&Vec3::from(place)).distance.is_finite(), "{place:?}");
    }
}

#[test]
fn w12_w13_tabulated_cylinder() {
    let cylinder = tabulated();
    let up = cylinder.directed_distance(&v(1.0, -3.0, 7.0), &Vec3::y(), RootSelection::Nearest);
    near(up.expect("hit"), 2.65);
    let ray = v(1.0, 0.3, 0.0).normalize();
    near(
        cylinder.directed_distance(&v(-1.0, -0.5, 0.0), &ray, RootSelection::Ahead).expect("hit"),
        1.335566584,
    );
    let normal = cylinder.natural_normal(&v(1.0, -0.35, 0.0)).expect("normal");
    near(-normal.x / normal.y, -0.15);
}

#[test]
fn degenerate_and_foreign_entities_are_errors() {
    let plane = Geometry::Plane(Plane { normal: Vec3::zeros(), distance: 1.0 });
    assert_eq!(Surface::from_geometry(&plane), Err(SurfaceError::Degenerate { kind: GeometryKind::Plane }));
    let imaginary = Quadric { coefficients: [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] };
    let imaginary = Surface::from_geometry(&Geometry::Quadric(imaginary));
    assert_eq!(imaginary, Err(SurfaceError::Degenerate { kind: GeometryKind::Quadric }));
    let point = Surface::from_geometry(&Geometry::Point(Vec3::zeros()));
    assert_eq!(point, Err(SurfaceError::Unsupported { kind: GeometryKind::Point }));
}

/// Next to the plane between them the multiplier is next to a pole.
#[test]
fn between_two_walls_the_nearest_point_is_on_the_nearer_one() {
    for turn in [40.0_f64, 64.0, 90.0, 116.0] {
        let (sine, cosine) = turn.to_radians().sin_cos();
        // (y + 0.5)(−sine·x + cosine·y + 0.5) = 0
        let coefficients =
            [0.0, cosine, 0.0, 0.25, 0.0, 0.0, -0.5 * sine, -0.25 * sine, 0.25 * (1.0 + cosine), 0.0];
        let walls = Surface::from_geometry(&Geometry::Quadric(Quadric { coefficients })).expect("a surface");
        for (a, nearer) in [0.0, 1e-3, 0.3].into_iter().flat_map(|a| {
            (0..16).flat_map(move |k| [10.0_f64.powi(-k), -(10.0_f64.powi(-k))]).map(move |by| (a, by))
        }) {
            // Distances from both walls.
            let (first, second) = (0.5 + a, (0.5 + a) * (1.0 + 0.1 * nearer));
            let (y, across) = (first - 0.5, second - 0.5);
            let point = Vec3::new((y * cosine - across) / sine, y, 0.7);
            let foot = walls.foot(&point);
            let wanted = first.min(second);
            let off = (foot.distance.abs() - wanted).abs().max(((point - foot.point).norm() - wanted).abs());
            assert!(off < 1e-12, "{turn} {a} {nearer}: {foot:?}, {wanted}");
        }
    }
}

#[test]
fn centre_of_an_ellipsoid_has_a_nearest_point() {
    let foot = ellipsoid().foot(&Vec3::zeros());
    near(foot.distance, -1.0);
    near(foot.point.y.abs(), 1.0);
}

fn all_surfaces() -> Vec<Surface> {
    let quadric = |coefficients| surface(&Geometry::Quadric(Quadric { coefficients }));
    vec![
        surface(&Geometry::Plane(Plane { normal: v(0.2, 0.1, 1.0), distance: 0.3 })),
        surface(&Geometry::Cylinder(Cylinder {
            point: v(0.1, 0.2, 0.0),
            axis: v(0.5, 1.0, 0.2),
            radius: 0.7,
        })),
        surface(&Geometry::Sphere(Sphere { center: v(0.1, 0.2, 0.3), radius: 0.8 })),
        surface(&Geometry::Cone(Cone { vertex: v(0.0, 0.1, -0.4), axis: v(0.1, 0.0, 1.0), cosine: 0.8 })),
        ellipsoid(),
        quadric([1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0]),
        quadric([1.0, 1.0, -1.0, -1.0, 0.1, 0.0, 0.2, 0.3, 0.0, 0.1]),
        quadric([1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5]),
        tabulated(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    #[test]
    fn the_foot_is_on_the_surface_and_its_normal_is_the_gradient(
        which in 0usize..9, x in -3.0..3.0, y in -3.0..3.0, z in -3.0..3.0,
    ) {
        let surface = &all_surfaces()[which];
        let p = v(x, y, z);
        let (foot, hessian) = surface.foot_and_hessian(&p);
        prop_assert!((foot.distance - surface.signed_distance(&p)).abs() < 1e-11);
        prop_assert!(surface.foot(&foot.point).distance.abs() < 1e-9);
        prop_assert!(((p - foot.point) - foot.normal * foot.distance).norm() < 1e-8);
        let direction = v(0.3, -0.5, 0.8).normalize();
        let h = 1e-5;
        let (ahead, behind) = (surface.foot(&(p + direction * h)), surface.foot(&(p - direction * h)));
        // Away from the medial axis the distance is smooth.
        let smooth = (ahead.point - behind.point).norm() < 50.0 * h;
        if smooth {
            let slope = (ahead.distance - behind.distance) / (2.0 * h);
            prop_assert!((slope - foot.normal.dot(&direction)).abs() < 1e-5, "slope {slope}");
            let bend = (ahead.normal - behind.normal) / (2.0 * h);
            let expected = hessian * direction;
            // Where the curvature jumps (tabulated cylinders) a difference quotient sees both sides.
            if which != 8 {
                prop_assert!((bend - expected).norm() < 1e-3 * (1.0 + expected.norm()), "{bend} {expected}");
            }
        }
    }

    #[test]
    fn directed_distances_end_on_the_surface(
        which in 0usize..9, x in -3.0..3.0, y in -3.0..3.0, z in -3.0..3.0, a in -1.0..1.0, b in -1.0..1.0,
    ) {
        let surface = &all_surfaces()[which];
        let (p, d) = (v(x, y, z), v(a, b, 0.37));
        if let Ok(distance) = surface.directed_distance(&p, &d, RootSelection::Ahead) {
            prop_assert!(distance >= 0.0);
            let hit = p + d * distance;
            prop_assert!(surface.signed_distance(&hit).abs() < 1e-8 * (1.0 + hit.norm()));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    /// Over a ball the distance from a tabulated cylinder rises above its chords by no more than the bound says.
    #[test]
    fn the_bend_of_a_tabulated_cylinder_is_bounded(
        center in prop::array::uniform3(-3.0..5.0f64), radius in 0.01..0.5f64, above in any::<bool>(),
        ends in prop::collection::vec(prop::array::uniform6(-1.0..1.0f64), 30),
    ) {
        let surface = tabulated();
        let (side, center) = (if above { 1.0 } else { -1.0 }, Vec3::from(center));
        let region = Region { center, radius, lowest: -0.05, highest: 3.0 };
        let bend = surface.bend(side, &surface.foot(&center), &region, Patience::default());
        let Bend::AtMost(bound) = bend else { return Ok(()) };
        let distance = |p: &Vec3| side * surface.signed_distance(p);
        for end in ends {
            let place = |k: usize| {
                let w = v(end[k], end[k + 1], end[k + 2]);
                center + w * (radius / w.norm().max(1.0))
            };
            let (a, b) = (place(0), place(3));
            let inside = (0..=20).all(|k| {
                let d = distance(&(a + (b - a) * (f64::from(k) / 20.0)));
                d >= region.lowest && d <= region.highest
            });
            if inside {
                let rise = 0.5 * (distance(&a) + distance(&b)) - distance(&(0.5 * (a + b)));
                prop_assert!(rise <= bound * (b - a).norm_squared() / 8.0 + 1e-11, "{rise} bound {bound}");
            }
        }
    }

    #[test]
    fn the_foot_on_a_tabulated_cylinder_is_nearer_than_every_sample(x in -6.0..8.0, y in -6.0..8.0) {
        let surface = tabulated();
        let p = v(x, y, 0.3);
        let foot = surface.foot(&p);
        prop_assert!((foot.distance.abs() - (p - foot.point).norm()).abs() < 1e-12);
        for k in 0..=1000 {
            let s = -4.0 + 0.01 * f64::from(k);
            // The middle interval and both straight ones by their formulas.
            let place = if s < 0.0 {
                v(s, -5.0 * s, 0.3)
            } else if s <= 2.0 {
                v(s, 0.15 * s.powi(3) - 0.1 * s * s - 0.4 * s, 0.3)
            } else {
                v(s, 3.0 * (s - 2.0), 0.3)
            };
            prop_assert!(foot.distance.abs() <= (p - place).norm() + 1e-12);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    /// x² + εy² = 2py, turned: an ellipse or hyperbola whose centre is far away, as one through rounded points of a parabola is.
    #[test]
    fn nearest_points_of_a_conic_with_a_far_centre_have_all_their_digits(
        flatness in 3.0..13.0f64, sign in prop::sample::select(vec![1.0, -1.0]), half_width in 2.0..50.0f64, turn in 0.0..6.3f64,
        x in -40.0..40.0f64, share in -5.0..0.9f64,
    ) {
        let squeeze = sign * 10f64.powf(-flatness);
        let (sine, cosine) = turn.sin_cos();
        let [across, along] = [v(cosine, sine, 0.0), v(-sine, cosine, 0.0)];
        let matrix = across * across.transpose() + along * along.transpose() * squeeze;
        let linear = along * -half_width;
        let coefficients =
            [matrix.m11, matrix.m22, 0.0, 0.0, 0.0, 0.0, matrix.m12, linear.x, linear.y, 0.0];
        let surface = surface(&Geometry::Quadric(Quadric { coefficients }));
        let y = x * x / (half_width + (half_width * half_width - squeeze * x * x).sqrt());
        let gradient = [x, squeeze * y - half_width];
        let slope = gradient[0].hypot(gradient[1]);
        let normal = (across * gradient[0] + along * gradient[1]) / slope;
        // Inside as far as a share of the way to the plane of symmetry, outside as far as one likes.
        let distance = -share * slope;
        let place = across * x + along * y + normal * distance + v(0.0, 0.0, 3.0);
        let foot = surface.foot(&place);
        let off = foot.point - (place - normal * distance);
        let size = 1.0 + place.norm() + distance.abs();
        prop_assert!(off.norm() < 1e-11 * size, "{off} beside {place}");
        prop_assert!((foot.distance - distance).abs() < 1e-12 * size, "{} {distance}", foot.distance);
        prop_assert!((foot.normal - normal).norm() < 1e-11, "{} {normal}", foot.normal);
    }
}
