use apt_geometry::{
    canonical::{Cone, Cylinder, Geometry, Plane, Quadric, Sphere},
    cutter::Cutter,
};
use proptest::prelude::*;

use super::*;
use crate::verify::tests::BARRELS;

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

fn tool(numbers: &[f64]) -> Tool<'static> {
    Tool::new(Cutter::from_numbers(numbers, 1.0).expect("cutter"), Vec3::z())
}

fn gauge(geometry: &Geometry, side: f64) -> Gauge {
    Gauge {
        surface: Surface::from_geometry(geometry).expect("surface"),
        on: false,
        side,
        thickness: 0.0,
        disk: None,
        memory: Memory::default(),
    }
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1.1e-9, "found {found}, expected {expected}");
}

/// A vertex that is on the top of the tool leaves that along its axis. What rounding leaves between both, taken for the direction, told a clearance that
/// rises for one that falls, and a vector that leads .0015 into the cone was taken for proven.
#[test]
fn a_vertex_on_the_top_of_a_tool_leaves_it_along_its_axis() {
    let cone = Geometry::Cone(Cone {
        vertex: v(-2.284233974742581, 1.1029708138754806, -2.204774247555039),
        axis: v(0.39206650470231097, 0.40400414585006794, 0.82647716606478),
        cosine: 0.8980899452236097,
    });
    let numbers = [0.6, 0.11, 0.2, 0.13, 10.634764718895052, 5.795519457427483, 4.841833376683445];
    let axis = v(0.2222083608048357, -0.4540956810517563, 0.8627980973776945);
    let tool = Tool::new(Cutter::from_numbers(&numbers, 1.0).expect("cutter"), axis);
    let tip = v(-3.496150463196518, 3.964443024744387, -5.998423350276359);
    let found = gauge(&cone, 1.0).contact(&tool, &tip);
    assert!(found.clearance.abs() < 1e-14, "{found:?}");
    assert!((found.gradient + axis).norm() < 1e-9, "{found:?}");
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

fn tools() -> Vec<Tool<'static>> {
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
        Tool::new(cutter(&BARRELS[0]), tilted),
        tool(&BARRELS[1]),
        tool(&BARRELS[2]),
        Tool::new(cutter(&BARRELS[3]), tilted),
        tool(&BARRELS[4]),
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
        which in 0usize..8, shape in 0usize..12, inside in any::<bool>(),
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
        which in 0usize..8, shape in 0usize..12, x in -2.5..2.5, y in -2.5..2.5, z in -1.0..2.5,
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

/// Samples of the whole boundary made finer and finer about the least, for a tool outside a convex solid.
fn refined(tool: &Tool, gauge: &Gauge, tip: &Vec3) -> f64 {
    let p = &tool.profile;
    let part = |from: f64, to: f64, t: f64| from + (to - from) * t;
    // Lower line, arc, upper line.
    let place = |t: f64| -> (f64, f64) {
        if t < 1.0 {
            (t * p.lower.radius, t * p.lower.height)
        } else if t < 2.0 {
            let polar = part(p.fan[0], p.fan[1], t - 1.0);
            (p.center.radius + p.arc * polar.sin(), p.center.height - p.arc * polar.cos())
        } else {
            (part(p.upper.radius, p.top.radius, t - 2.0), part(p.upper.height, p.top.height, t - 2.0))
        }
    };
    let (mut center, mut half) = ([1.5, 0.0], [1.5, std::f64::consts::PI]);
    let mut least = f64::INFINITY;
    for round in 0..12 {
        let around = center;
        let count = if round == 0 { 300 } else { 20 };
        for i in -count..=count {
            for k in -count..=count {
                let share = [i, k].map(|x| f64::from(x) / f64::from(count));
                let t = (around[0] + half[0] * share[0]).clamp(0.0, 3.0);
                let angle = around[1] + half[1] * share[1];
                let (radius, height) = place(t);
                let radial = tool.across[0] * angle.cos() + tool.across[1] * angle.sin();
                let at = tip + tool.axis * height + radial * radius;
                let distance = gauge.side * gauge.surface.signed_distance(&at);
                if distance < least {
                    (least, center) = (distance, [t, angle]);
                }
            }
        }
        half = half.map(|x| x / if round == 0 { 60.0 } else { 6.0 });
    }
    least
}

/// Contact in the middle of a straight flank, or near one of its ends, is a kink of the distance over the normals.
#[test]
fn flanks_touch_round_solids_anywhere() {
    let cases = [
        (
            // Near the lower end of the flank.
            vec![1.0, 0.1875, 0.33, 0.22, 7.89935231433134, 5.0, 4.758946859480256],
            v(0.7758241689643466, 0.13424432236515066, 0.616502490476318),
            Geometry::Cone(Cone {
                vertex: v(-0.8282937380995063, 1.5912313630978119, -1.1926614803459095),
                axis: v(0.7034415620627794, -0.469664425010695, -0.5334653659255212),
                cosine: 0.8092552061698755,
            }),
            v(-1.0261350464787444, 2.0727186094774916, -1.301037892945468),
        ),
        (
            // Near the top of the flank of a ball cutter.
            vec![0.8566182138664524, 0.4283091069332262],
            v(-0.5658602179305312, -0.09487492796095744, 0.8190243963448312),
            Geometry::Cylinder(Cylinder {
                point: v(-4.191214300936019, 0.20250018134231199, 3.9437397023330467),
                axis: v(-0.3522485896704196, 0.8026075630360932, 0.4813959184179167),
                radius: 2.7073650317223756,
            }),
            v(1.2524411509704407, 0.7367360738332862, 1.6617951117870124),
        ),
    ];
    for (numbers, axis, geometry, tip) in cases {
        let cutter = Cutter::from_numbers(&numbers, 1.0).expect("cutter");
        let (tool, gauge) = (Tool::new(cutter, axis.normalize()), gauge(&geometry, 1.0));
        let (found, wanted) = (gauge.contact(&tool, &tip).clearance, refined(&tool, &gauge, &tip));
        assert!((found - wanted).abs() < 1e-10, "{found:e}, samples {wanted:e}");
    }
}

mod enough;
mod halves;
mod kept;
mod near;
mod on_axis;
mod proofs;

/// A flank that leans little against an ellipsoid: contact is inside of it, near the tip.
#[test]
fn contact_on_a_shallow_flank_near_the_tip_is_found() {
    let ellipsoid = Geometry::Quadric(Quadric {
        coefficients: [
            0.889948197825192,
            0.2480181002908702,
            0.5256485647940492,
            2.1842086677464274,
            0.029351327660240633,
            0.15939218384872025,
            0.30990362108909264,
            -0.7513715908857705,
            -0.1354983762307729,
            0.9369436894603721,
        ],
    });
    let bell = tool(&[0.6, 0.11, 0.2, 0.13, 9.78528083003446, 3.643337133155286, 3.0389449769320658]);
    let gauge = gauge(&ellipsoid, 1.0);
    // From the tip, where the azimuth is lost, the search must find its way out again.
    for (tip, expected) in [
        (v(1.6381600650219679, -1.9676514758421877, -0.882930366992134), 7.5e-5),
        (v(1.6793591150990066, -1.9516625750054228, -0.8801426202756157), -2.954819942910169e-5),
        (v(1.7009626382338618, -1.9431379137327112, -0.8789322094997449), 9.99e-5),
        (v(1.6793591150990066, -1.9516625750054228, -0.8801426202756157), -2.954819942910169e-5),
    ] {
        let contact = gauge.contact(&bell, &tip);
        assert!((contact.clearance - expected).abs() < 1e-9, "{} {expected}", contact.clearance);
    }
}

/// Seen along generators a tool that is parallel to them is a disc, whose clearance bends as that of its middle: at a radius from the
/// surface, and without a search for which of its points may touch.
#[test]
fn along_generators_the_clearance_bends_as_the_distance_of_the_tool_end() {
    let [a, b, r] = [2.0, 1.0, 0.25];
    let coefficients = [1.0 / (a * a), 1.0 / (b * b), 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let gauge = gauge(&Geometry::Quadric(Quadric { coefficients }), 1.0);
    let found = steady_bend(&gauge, &tool(&[2.0 * r]), &v(a + r, 0.0, 0.3), 1e-3, [-1e-3, 1e-3]);
    let own = 1.0 / (b * b / a + r);
    assert!(found.is_some_and(|found| found >= own && found <= 1.02 * own), "{found:?} for {own}");
}

/// The tool stands along the normal of a cylinder: what is left of that across the tool is rounding, and no direction.
#[test]
fn a_corner_on_a_cylinder_along_whose_normal_the_tool_stands_is_as_far_as_the_bottom() {
    let geometry = Geometry::Cylinder(Cylinder { point: v(0.0, 0.0, -8.0), axis: Vec3::y(), radius: 8.5 });
    for k in 0..200 {
        let x = 0.04 * f64::from(k) - 4.0;
        let tip = v(x, 0.5, (8.566_f64.powi(2) - x * x).sqrt() - 8.0);
        let axis = v(tip.x, 0.0, tip.z + 8.0).normalize();
        let tool = Tool::new(Cutter::from_numbers(&[1.0, 0.2], 1.0).expect("cutter"), axis);
        let clearance = gauge(&geometry, 1.0).contact(&tool, &tip).clearance;
        assert!((clearance - 0.066).abs() <= 1e-9, "at {tip}: {clearance}");
    }
}

/// A surface that sticks into the flank between the places that are looked at first is found as deep as it is.
#[test]
fn how_deep_a_surface_sticks_into_a_tool_is_told_wherever_it_does() {
    let tool = tool(&[1.0, 0.0, 0.5, 0.0, 0.0, 0.0, 2.0]);
    let depth = 0.002;
    for height in [0.0, 0.2, 0.37, 1.26, 1.9] {
        let center = v(0.6 - depth, 0.0, height);
        let sphere = gauge(&Geometry::Sphere(Sphere { center, radius: 0.1 }), 1.0);
        let found = tool.depth_of(&sphere.surface, &Vec3::zeros(), 0.5 * depth);
        assert!(found >= 0.5 * depth && found <= depth + 1e-12, "{height}: {found}");
    }
}
