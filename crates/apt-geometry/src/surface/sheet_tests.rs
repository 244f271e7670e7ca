//! Ruled and polyconic surfaces against dense samples, difference quotients, and themselves moved.

use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::canonical::{Matrix, Remembering, RuledSurface, matrix::CoordinatePlane};

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

fn curve(surface: Geometry, start: Vec3, end: Vec3, across: Vec3) -> Vec<Geometry> {
    vec![surface, Geometry::Point(start), Geometry::Point(end), Geometry::Vector(across)]
}

fn ruled(first: Vec<Geometry>, second: Vec<Geometry>) -> Geometry {
    let parts = first.into_iter().chain(second).collect();
    Geometry::RuledSurface(Remembering::new(RuledSurface { parts }))
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
    Geometry::RuledSurface(Remembering::new(RuledSurface { parts }))
}

/// Over the diameter of a circle to a straight line.
pub(super) fn half_pipe() -> Geometry {
    ruled(
        curve(circle(0.0, 0.0, 2.0), v(-2.0, 0.0, 0.0), v(2.0, 0.0, 0.0), Vec3::y()),
        curve(plane(Vec3::y(), 1.0), v(-2.0, 1.0, 4.0), v(2.0, 1.0, 4.0), Vec3::y()),
    )
}

pub(super) fn sheets() -> Vec<Geometry> {
    vec![twisted(), between_arcs(), cone_piece(), tube(1.0), bullet(), loft()]
}

/// Canonical values of a polyconic surface: thickness, base and length, polynomials and square roots of A to P.
fn poly_conic(head: [f64; 3], polynomials: [&[f64]; 7], roots: Option<[f64; 7]>) -> Geometry {
    let mut values = vec![if roots.is_some() { 2.0 } else { 1.0 }];
    values.extend([0.0; 12]);
    values.extend(head);
    for polynomial in polynomials {
        values.extend((0..8).map(|i| polynomial.get(i).copied().unwrap_or(0.0)));
    }
    values.extend(roots.unwrap_or([0.0; 7]));
    Geometry::PolyConic(Remembering::new(values))
}

/// Fullness of a quarter of a circle.
const ROUND: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A quarter of a tube of radius 2 about the x axis, from y to z.
fn tube(thickness: f64) -> Geometry {
    poly_conic([thickness, 1.0, 4.0], [&[-2.0], &[2.0], &[0.0], &[0.0], &[2.0], &[0.0], &[ROUND]], None)
}

/// A quarter of the paraboloid y² + z² = 4 (x − 1)/3.
fn bullet() -> Geometry {
    let none: &[f64] = &[];
    let roots = [-2.0, 2.0, 0.0, 0.0, 2.0, 0.0, 0.0];
    poly_conic([0.0, 1.0, 3.0], [none, none, none, none, none, none, &[ROUND]], Some(roots))
}

/// A surface that changes in every way along its stations.
fn loft() -> Geometry {
    let polynomials: [&[f64]; 7] =
        [&[-2.0, 0.5], &[2.0, -0.3, 0.2], &[0.1, 0.2], &[0.2], &[2.5, 0.0, -0.4], &[0.0, 0.3], &[0.6, 0.25]];
    poly_conic([0.0, 0.0, 5.0], polynomials, None)
}

/// A point of [`loft`] by the definition of its conics: `(w − u)² = φ u (1 − w)`.
fn loft_point(t: f64, station: f64) -> Vec3 {
    let Geometry::PolyConic(values) = loft() else { panic!("a polyconic surface") };
    let form = crate::canonical::PolyConicForm::read(&values).expect("values");
    let [a, b, c, d, l, h, p] = form.controls(station).expect("a station");
    let root = (2.0 * p - 1.0) / (1.0 - p);
    // With w − u = root·m and m² = u (1 − w), so that u = m x and 1 − w = m/x for some x.
    let x = t / (1.0 - t);
    let m = 1.0 / (root + x + 1.0 / x);
    let (u, w) = (m * x, 1.0 - m / x);
    v(5.0 * station, l + a * u + c * w, h + b * w + d * u)
}

/// The surfaces of [`sheets`], made once.
fn sheet(which: usize) -> &'static Surface {
    static MADE: std::sync::OnceLock<Vec<Surface>> = std::sync::OnceLock::new();
    &MADE.get_or_init(|| sheets().iter().map(surface).collect())[which]
}

pub(super) fn surface(geometry: &Geometry) -> Surface {
    Surface::from_geometry(geometry).expect("a surface")
}

/// Exact point of a test surface by its definition.
fn exact(which: usize, t: f64, share: f64) -> Vec3 {
    let arc = |x: f64, y: f64, radius: f64, left: f64, width: f64, z: f64| {
        let along = left + width * t;
        v(along, y + (radius * radius - (along - x) * (along - x)).sqrt(), z)
    };
    let (first, second) = match which {
        0 => (v(6.0 * t, 0.0, 0.0), v(6.0 * t, 4.0, 1.0 + t)),
        1 => (arc(0.0, 0.0, 6.0, -3.0, 6.0, 0.0), arc(0.5, 1.0, 4.0, -1.5, 4.0, 5.0)),
        3 => {
            let (sin, cos) = (std::f64::consts::FRAC_PI_2 * t).sin_cos();
            return v(1.0 + 4.0 * share, 3.0 * cos, 3.0 * sin);
        }
        4 => {
            let (sin, cos) = (std::f64::consts::FRAC_PI_2 * t).sin_cos();
            let radius = 2.0 * share.sqrt();
            return v(1.0 + 3.0 * share, radius * cos, radius * sin);
        }
        5 => return loft_point(0.001 + 0.998 * t, share),
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
fn the_surfaces_are_where_their_definitions_say() {
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
fn a_section_that_does_not_reach_its_end_points_is_degenerate() {
    let astray = ruled(
        curve(circle(0.0, 0.0, 6.0), v(-9.0, 5.0, 0.0), v(9.0, 2.0, 0.0), Vec3::y()),
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

#[test]
fn the_natural_normal_of_a_polyconic_surface_is_conic_times_station() {
    for which in [3, 4] {
        let normal = sheet(which).natural_normal(&exact(which, 0.5, 0.5)).expect("a normal");
        assert!(normal.y > 0.5 && (normal.y - normal.z).abs() < 1e-9, "outward: {normal}");
    }
    let thin = surface(&tube(0.0));
    assert!((thin.signed_distance(&v(3.0, 0.0, 5.0)) - 3.0).abs() < 1e-9);
    assert!((sheet(3).signed_distance(&v(3.0, 0.0, 5.0)) - 2.0).abs() < 1e-9, "thickness 1 outward");
}

#[test]
fn on_the_surface_the_hessian_is_that_of_its_curvature() {
    for which in 0..6 {
        for (t, share) in [(0.3, 0.4), (0.5, 0.5), (0.71, 0.17)] {
            let place = sheet(which).foot(&exact(which, t, share)).point;
            let (foot, hessian) = sheet(which).foot_and_hessian(&place);
            let away = sheet(which).foot_and_hessian(&(place + foot.normal * 1e-4)).1;
            assert!((hessian - away).norm() < 1e-3, "surface {which} at {t}, {share}: {hessian} {away}");
        }
    }
    let bent = sheet(3).foot_and_hessian(&sheet(3).foot(&exact(3, 0.5, 0.5)).point).1;
    assert!((bent.trace() - 1.0 / 3.0).abs() < 1e-6, "a tube of radius 3: {bent}");
    let bent = sheet(0).foot_and_hessian(&sheet(0).foot(&exact(0, 0.5, 0.5)).point).1;
    assert!(bent.trace().powi(2) < bent.norm_squared(), "a twisted strip is a saddle: {bent}");
}

#[test]
fn over_an_edge_the_hessian_is_that_of_the_surface() {
    for which in [0, 1, 2, 5] {
        for share in [0.17, 0.4, 0.71] {
            for (edge, inward) in [([0.0, share], [1e-4, share]), ([share, 0.0], [share, 1e-4])] {
                let [over, beside] = [edge, inward].map(|[t, share]| {
                    let on = exact(which, t, share);
                    let normal = sheet(which).natural_normal(&on).expect("a normal");
                    sheet(which).foot_and_hessian(&(on + normal * 1e-5)).1
                });
                // Beyond the edge the normal turns within that distance.
                assert!(
                    (over - beside).norm() < 0.01 * (1.0 + beside.norm()),
                    "{which} {edge:?}: {over} {beside}"
                );
            }
        }
    }
}

#[test]
fn values_without_a_surface_are_degenerate() {
    let Geometry::PolyConic(values) = tube(0.0) else { panic!("a polyconic surface") };
    let kind = GeometryKind::PolyConic;
    for (index, value) in [(15, 0.0), (20, f64::NAN), (1, 3.0)] {
        let mut broken = values.to_vec();
        broken[index] = value;
        let found = Surface::from_geometry(&Geometry::PolyConic(Remembering::new(broken)));
        assert_eq!(found, Err(SurfaceError::Degenerate { kind }), "value {index}");
    }
    let stretched = Matrix { rows: [[2.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] };
    let found = tube(0.0).transform(&stretched);
    assert!(matches!(found, Err(crate::canonical::TransformError::Distorted { .. })), "{found:?}");
}

#[test]
fn a_surface_ends_where_it_is_left_and_nowhere_else() {
    for (which, geometry) in sheets().iter().enumerate() {
        let surface = surface(geometry);
        assert!(surface.has_ends());
        let middle = exact(which, 0.45, 0.4);
        let normal = surface.foot(&middle).normal;
        let across = perpendicular(&normal);
        assert!(!surface.ends_at(&middle) && !surface.ends_at(&(middle + normal * 0.1)), "surface {which}");
        // Far away along the tangent plane nearest places are on an edge, whichever way; ahead of a nose (4) they are not.
        for k in if which == 4 { 0..0 } else { 0..12 } {
            let (sine, cosine) = (f64::from(k) * std::f64::consts::PI / 6.0).sin_cos();
            let far = middle + (across * cosine + normal.cross(&across) * sine) * 300.0;
            assert!(surface.ends_at(&far), "surface {which}, direction {k}: {}", surface.foot(&far).point);
        }
    }
    assert!(![plane(Vec3::z(), 0.0), circle(0.0, 0.0, 2.0)].iter().any(|g| surface(g).has_ends()));
}

#[test]
fn what_is_beyond_the_end_of_a_polyconic_surface_is_behind_it_for_no_tool() {
    let tube = surface(&tube(0.0));
    let middle = exact(3, 0.45, 0.4);
    let normal = tube.foot(&middle).normal;
    let across = perpendicular(&normal);
    for side in [1.0, -1.0] {
        let met = tube.met_from(side, Patience::default());
        for height in [0.3, -0.3] {
            let beside = middle + normal * height;
            assert_eq!(met.foot(&beside), tube.foot(&beside));
            for k in 0..12 {
                let (sine, cosine) = (f64::from(k) * std::f64::consts::PI / 6.0).sin_cos();
                let beyond = beside + (across * cosine + normal.cross(&across) * sine) * 300.0;
                let (found, bare) = (met.foot(&beyond), tube.foot(&beyond));
                assert!((found.distance - side * bare.distance.abs()).abs() < 1e-12 * bare.distance.abs());
                assert_eq!(found.point, bare.point);
                let gradient = (met.signed_distance(&(beyond + found.normal)) - found.distance - 1.0).abs();
                assert!(gradient < 1e-9, "{k}: {gradient}");
            }
        }
    }
}

/// How far along a surface of this size the way to a nearest place may lead: what is left by parameters that are known to thirteen digits.
const AMISS: f64 = 1e-11;

/// The distance hardly tells where it is least: to within the root of its rounding. The place has to be where its slope vanishes.
#[test]
fn the_way_to_a_nearest_place_of_a_ruled_surface_is_as_square_to_it_as_slopes_tell() {
    let mut worst = [0.0_f64; 3];
    for (which, worst) in worst.iter_mut().enumerate() {
        let sheet = sheet(which);
        for k in 0..4000 {
            let share = |step: f64| (f64::from(k) * step).fract();
            let p = v(-3.0 + 10.0 * share(0.7548), -1.0 + 8.0 * share(0.5698), -1.0 + 6.0 * share(0.3247));
            if sheet.ends_at(&p) {
                continue;
            }
            let chart = sheet.place(&p).and_then(|place| sheet.chart(&place)).expect("a chart");
            let way = p - chart.point;
            let [a, b] = chart.first.map(|along| way.dot(&along).abs() / along.norm());
            *worst = worst.max(a).max(b);
        }
    }
    assert!(worst.iter().all(|along| *along <= AMISS), "{worst:?}");
}

fn moved(geometry: &Geometry, matrix: &Matrix) -> Surface {
    surface(&geometry.transform(matrix).expect("a rigid motion"))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]
    #[test]
    fn the_foot_is_nearer_than_every_sample(which in 0usize..6, x in -4.0..8.0, y in -3.0..8.0, z in -3.0..6.0) {
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
        // Beside the edge of a surface with thickness the foot may stand over the edge itself.
        if which != 3 || (0.0..6.0).contains(&x) {
            prop_assert!(sheet.signed_distance(&foot.point).abs() < 1e-9);
        }
        prop_assert!(((p - foot.point) - foot.normal * foot.distance).norm() < 1e-8);
    }

    #[test]
    fn gradient_and_hessian_are_those_of_the_distance(
        which in 0usize..6, x in -3.0..7.0, y in -1.0..7.0, z in -1.0..5.0, a in -1.0..1.0, b in -1.0..1.0,
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
        which in 0usize..6, t in 0.05..0.95, share in 0.05..0.95, x in -1.0..1.0, y in -1.0..1.0, far in 0.1..9.0,
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
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn rigid_motions_and_scales_carry_the_distance(
        which in 0usize..6, x in -3.0..7.0, y in -1.0..7.0, z in -1.0..5.0, turn in -180.0..180.0, large in any::<bool>(),
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
