use apt_geometry::{
    canonical::{Cone, Cylinder, Geometry, Plane, Quadric, Sphere},
    cutter::Cutter,
};
use proptest::prelude::*;

use super::*;

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

fn tool(numbers: &[f64]) -> Tool {
    Tool::new(Cutter::from_numbers(numbers, 1.0).expect("cutter"), Vec3::z())
}

fn gauge(geometry: &Geometry, side: f64) -> Gauge {
    Gauge {
        surface: Surface::from_geometry(geometry).expect("surface"),
        on: false,
        side,
        thickness: 0.0,
        memory: Memory::default(),
    }
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1.1e-9, "found {found}, expected {expected}");
}

#[test]
fn w18_sphere() {
    let sphere = Geometry::Sphere(Sphere { center: Vec3::zeros(), radius: 2.0 });
    near(gauge(&sphere, 1.0).contact(&tool(&[1.0, 0.125]), &v(1.1, 0.0, 1.9)).clearance, 0.025871916);
}

#[test]
fn w19_skew_cylinder() {
    let cylinder = Geometry::Cylinder(Cylinder { point: Vec3::zeros(), axis: v(0.5, 1.0, 0.2), radius: 2.0 });
    near(gauge(&cylinder, 1.0).contact(&tool(&[1.0, 0.125]), &v(1.1, 0.0, 2.1)).clearance, 0.047944436);
}

#[test]
fn w20_cone() {
    let cosine = 30f64.to_radians().cos();
    let cone = Geometry::Cone(Cone { vertex: v(0.0, 0.0, 3.0), axis: -Vec3::z(), cosine });
    // The corner ring alone: a torus of radius .375 at height .125 with a ball of .125.
    let gauge = gauge(&cone, 1.0);
    let ring = v(1.9 - 0.375, 0.0, 0.125);
    near(gauge.surface.signed_distance(&ring) - 0.125, -0.241811259);
}

#[test]
fn w17_planes() {
    let shape = tool(&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0]);
    for (slope, height) in [(0.05, 0.0), (0.3, 0.056268300), (1.0, 0.375165043), (3.0, 1.362608615)] {
        let plane = Geometry::Plane(Plane { normal: v(slope, 0.0, 1.0), distance: 0.0 });
        near(gauge(&plane, 1.0).contact(&shape, &v(0.0, 0.0, height)).clearance, 0.0);
    }
}

fn surfaces() -> Vec<Geometry> {
    let quadric = |coefficients| Geometry::Quadric(Quadric { coefficients });
    vec![
        Geometry::Plane(Plane { normal: v(0.3, 0.1, 1.0), distance: 0.0 }),
        Geometry::Sphere(Sphere { center: v(0.1, 0.0, -0.2), radius: 1.5 }),
        Geometry::Cylinder(Cylinder { point: v(0.0, 0.0, 0.0), axis: Vec3::z(), radius: 1.2 }),
        Geometry::Cylinder(Cylinder { point: v(0.0, 0.0, 0.0), axis: v(0.4, 1.0, 0.3), radius: 1.2 }),
        Geometry::Cone(Cone { vertex: v(0.0, 0.0, 2.0), axis: -Vec3::z(), cosine: 0.8 }),
        Geometry::Cone(Cone { vertex: v(0.2, 0.0, 2.0), axis: v(0.2, 0.1, -1.0), cosine: 0.8 }),
        quadric([0.25, 1.0, 1.0 / 2.25, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        quadric([1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.7]),
    ]
}

fn tools() -> Vec<Tool> {
    let cutter = |numbers: &[f64]| Cutter::from_numbers(numbers, 1.0).expect("cutter");
    let tilted = v(0.2, -0.1, 1.0).normalize();
    vec![
        tool(&[0.5, 0.0, 0.25, 0.0, 0.0, 0.0, 2.0]),
        tool(&[0.5, 0.25]),
        tool(&[0.6, 0.1]),
        tool(&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0]),
        tool(&[1.0, 0.1, 0.4, 0.210707, 15.0, 0.0, 3.0]),
        Tool::new(cutter(&[0.6, 0.1]), tilted),
        Tool::new(cutter(&[0.5]), tilted),
    ]
}

/// Least signed distance over a dense cloud of boundary points.
fn sampled(tool: &Tool, gauge: &Gauge, tip: &Vec3) -> f64 {
    let profile = &tool.profile;
    let mut least = f64::INFINITY;
    let mut section = Vec::new();
    for k in 0..=60 {
        let t = f64::from(k) / 60.0;
        section.push((t * profile.lower.radius, t * profile.lower.height));
        section.push((
            profile.upper.radius + t * (profile.top.radius - profile.upper.radius),
            profile.upper.height + t * (profile.top.height - profile.upper.height),
        ));
        section.push((t * profile.top.radius, profile.top.height));
        let polar = profile.fan[0] + t * (profile.fan[1] - profile.fan[0]);
        section.push((
            profile.center.radius + profile.arc * polar.sin(),
            profile.center.height - profile.arc * polar.cos(),
        ));
    }
    for (radius, height) in section {
        for k in 0..90 {
            let angle = f64::from(k) * std::f64::consts::TAU / 90.0;
            let radial = tool.across[0] * angle.cos() + tool.across[1] * angle.sin();
            let p = tip + tool.axis * height + radial * radius;
            least = least.min(gauge.side * gauge.surface.signed_distance(&p));
        }
    }
    least
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn clearance_is_the_least_distance_of_the_body(
        which in 0usize..8, shape in 0usize..7, inside in any::<bool>(),
        x in -2.5..2.5, y in -2.5..2.5, z in -1.0..2.5,
    ) {
        let side = if inside { -1.0 } else { 1.0 };
        let (gauge, tool) = (gauge(&surfaces()[which], side), &tools()[shape]);
        let tip = v(x, y, z);
        let contact = gauge.contact(tool, &tip);
        let least = sampled(tool, &gauge, &tip);
        // The closed forms measure penetration by the shift that separates; deep inside that is another number.
        if contact.clearance > -0.02 {
            prop_assert!(contact.clearance <= least + 1e-9, "{} above {least}", contact.clearance);
            prop_assert!(contact.clearance >= least - 0.03, "{} below {least}", contact.clearance);
            prop_assert!((contact.gradient.norm() - 1.0).abs() < 1e-9);
            let gap = (contact.tool - contact.surface).dot(&contact.gradient);
            prop_assert!((gap - contact.clearance).abs() < 1e-9, "gap {gap}");
        }
    }

    #[test]
    fn the_gradient_is_the_derivative(
        which in 0usize..8, shape in 0usize..7, x in -2.5..2.5, y in -2.5..2.5, z in -1.0..2.5,
    ) {
        let (gauge, tool) = (gauge(&surfaces()[which], 1.0), &tools()[shape]);
        let (tip, direction, h) = (v(x, y, z), v(0.6, -0.3, 0.5).normalize(), 1e-5);
        let here = gauge.contact(tool, &tip);
        let (ahead, behind) = (gauge.contact(tool, &(tip + direction * h)), gauge.contact(tool, &(tip - direction * h)));
        let smooth = (ahead.gradient - behind.gradient).norm() < 100.0 * h;
        if here.clearance > 0.0 && smooth {
            let slope = (ahead.clearance - behind.clearance) / (2.0 * h);
            prop_assert!((slope - here.gradient.dot(&direction)).abs() < 2e-4, "{slope}");
        }
    }
}
