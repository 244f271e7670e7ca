//! Clearances of single positions: worked cases of arelem reference 6.2, dense sampling, and quadrics against the closed
//! forms of the surfaces they also describe.

use apt_geometry::{
    Vec3,
    canonical::{Cone, Geometry},
    cutter::Cutter,
};
use proptest::prelude::*;

use super::{
    super::{
        clearance::{Clearance, Surface},
        quadric::PrincipalQuadric,
        tool::Profile,
    },
    BARRELS, cone, cutter, cylinder, plane, quadric, sphere,
};

pub(super) fn clearance(
    cutter: &Cutter,
    geometry: &Geometry,
    side: f64,
    tip: [f64; 3],
    axis: [f64; 3],
) -> (f64, Vec3, f64) {
    let profile = Profile::of(cutter).unwrap();
    let surface = Surface::of(geometry).unwrap();
    let c = Clearance::new(&surface, &profile, side);
    let reading = c.at(&Vec3::from(tip), &Vec3::from(axis).normalize()).unwrap();
    (reading.value, reading.normal, reading.error)
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];

#[test]
fn seven_parameter_tool_on_tilted_planes_touches_with_each_of_its_parts() {
    // W17: cutter of W14 on z = −kx.
    let tool = cutter(&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0]);
    for (k, z) in [(0.05, 0.0), (0.3, 0.056268300), (1.0, 0.375165043), (3.0, 1.362608615)] {
        let (value, ..) = clearance(&tool, &plane([k, 0.0, 1.0], 0.0), 1.0, [0.0, 0.0, z], UP);
        assert!(value.abs() < 1e-9, "k {k}: {value}");
    }
}

#[test]
fn profile_vertices_of_the_worked_case() {
    // W14.
    let profile = Profile::of(&cutter(&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0])).unwrap();
    let want = [[0.454976356, 0.080224607], [0.505839572, 0.154910100], [0.667264021, 2.0]];
    for (have, want) in profile.edges().iter().zip(want) {
        assert!((have[0] - want[0]).abs() < 1e-9 && (have[1] - want[1]).abs() < 1e-9, "{have:?} {want:?}");
    }
}

#[test]
fn worked_clearances_on_curved_surfaces() {
    // W18, W19; W20 is the corner ring alone, whose ball touches the cone with its upper half in the worked case.
    let tool = cutter(&[1.0, 0.125]);
    let (value, ..) = clearance(&tool, &sphere([0.0; 3], 2.0), 1.0, [1.1, 0.0, 1.9], UP);
    assert!((value - 0.025871916).abs() < 1e-9, "{value}");
    let skew = cylinder([0.0; 3], [0.5, 1.0, 0.2], 2.0);
    let (value, ..) = clearance(&tool, &skew, 1.0, [1.1, 0.0, 2.1], UP);
    assert!((value - 0.047944436).abs() < 1e-9, "{value}");
}

#[test]
fn impossible_cutters_are_refused() {
    for numbers in [
        [1.0, 0.1, 0.4, 0.1, 60.0, 40.0, 2.0],
        [1.0, -0.1, 0.4, 0.1, 0.0, 0.0, 2.0],
        [1.0, 0.1, 0.4, 0.3, 0.0, 0.0, 2.0],
    ] {
        assert!(Profile::of(&cutter(&numbers)).is_err(), "{numbers:?}");
    }
    let mut wild = cutter(&[1.0, 0.25]);
    wild.height = f64::NAN;
    assert!(Profile::of(&wild).is_err());
}

#[test]
fn a_pin_inside_the_tool_is_deep_penetration() {
    let tool = cutter(&[1.0, 0.0]);
    let pin = cylinder([0.1, 0.0, 0.0], UP, 0.05);
    let (value, ..) = clearance(&tool, &pin, 1.0, [0.0; 3], UP);
    assert!((value - (0.1 - 0.05 - 0.5)).abs() < 1e-12, "{value}");
    let (value, ..) = clearance(&tool, &sphere([0.2, 0.0, 1.0], 0.001), 1.0, [0.0; 3], UP);
    assert!((value + 0.301).abs() < 1e-12, "{value}");
}

/// Points all over the tool's boundary.
pub(crate) fn samples(tool: &Cutter, tip: Vec3, axis: Vec3) -> Vec<Vec3> {
    let profile = Profile::of(tool).unwrap();
    let mut meridian = Vec::new();
    for (a, b) in profile.lines() {
        for k in 0..=60 {
            let t = f64::from(k) / 60.0;
            meridian.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
        }
    }
    if let Some((c, r)) = profile.corner() {
        // Large arcs are narrow.
        let count = if r > 4.0 { 7200 } else { 720 };
        for k in 0..=count {
            let (s, co) = (f64::from(k) / f64::from(count) * std::f64::consts::TAU).sin_cos();
            if profile.fan_holds([co, s]) && co >= 0.0 {
                meridian.push([c[0] + r * co, c[1] + r * s]);
            }
        }
    }
    let x = super::super::tool::perpendicular(&axis);
    let y = axis.cross(&x);
    let mut all = Vec::new();
    for m in meridian {
        for k in 0..240 {
            let (s, c) = (f64::from(k) / 240.0 * std::f64::consts::TAU).sin_cos();
            all.push(tip + (x * c + y * s) * m[0] + axis * m[1]);
        }
    }
    all
}

pub(super) fn tools() -> impl Strategy<Value = Cutter> {
    prop_oneof![
        Just(cutter(&[0.5, 0.25])),
        Just(cutter(&[0.5, 0.0])),
        Just(cutter(&[1.0, 0.125])),
        Just(cutter(&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0])),
        Just(cutter(&[0.8, 0.0, 0.4, 0.0, 20.0, 8.0, 3.0])),
        proptest::sample::select(BARRELS.to_vec()).prop_map(|numbers| cutter(&numbers)),
    ]
}

pub(super) fn direction() -> impl Strategy<Value = [f64; 3]> {
    (-1.0..1.0, -1.0..1.0, 0.2..1.0).prop_map(|(x, y, z)| [x, y, z])
}

/// The surface as itself and as a quadric whose gradient points outward.
fn twins() -> impl Strategy<Value = (Geometry, Geometry)> {
    let ball = (-1.0..1.0f64, 1.0..4.0f64).prop_map(|(x, r)| {
        let q = [1.0, 1.0, 1.0, x * x - r * r, 0.0, 0.0, 0.0, -x, 0.0, 0.0];
        (sphere([x, 0.0, 0.0], r), quadric(q))
    });
    let pipe = (direction(), 1.0..4.0f64).prop_map(|(t, r)| {
        let t = Vec3::from(t).normalize();
        let q = [
            1.0 - t.x * t.x,
            1.0 - t.y * t.y,
            1.0 - t.z * t.z,
            -r * r,
            -t.y * t.z,
            -t.x * t.z,
            -t.x * t.y,
            0.0,
            0.0,
            0.0,
        ];
        (cylinder([0.0; 3], t.into(), r), quadric(q))
    });
    prop_oneof![ball, pipe]
}

#[test]
fn a_trough_beside_the_least_sample_is_not_missed() {
    // Found by the test of any quadric: the nearest place is on a patch away from its best azimuth.
    let tool = cutter(&[1.0, 0.125]);
    let geometry = quadric([
        0.23808009362337754,
        0.0,
        0.0,
        4.0 * 0.09513111979415872,
        0.3 * 0.3071115931637662,
        0.3 * 0.14908785089225807,
        0.3 * -0.3795612941551737,
        0.030526734657112125,
        -0.27243022049315974,
        -0.06267653112909427,
    ]);
    let axis = [-0.605053331033449, 0.9607706662660351, 0.976070396536526];
    let tip = [-1.3979615360849758, -0.23896563127939927, 0.8219082145204151];
    let surface = Surface::of(&geometry).unwrap();
    let side = surface.point_distance(&Vec3::from(tip)).unwrap().0.signum();
    let (value, ..) = clearance(&tool, &geometry, side, tip, axis);
    let sampled = samples(&tool, Vec3::from(tip), Vec3::from(axis).normalize())
        .iter()
        .map(|x| side * surface.point_distance(x).unwrap().0)
        .fold(f64::INFINITY, f64::min);
    assert!(value <= sampled + 1e-9 && sampled - value < 5e-3, "value {value} sampled {sampled}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn outside_and_inside_agree_with_dense_sampling(
        tool in tools(),
        tip in (-2.5..2.5f64, -2.5..2.5f64, -2.0..3.5f64),
        axis in direction(),
        which in 0usize..4,
        outside in any::<bool>(),
    ) {
        let geometry = [
            sphere([0.3, 0.1, -0.2], 2.0),
            cylinder([0.1, 0.2, 0.0], [0.5, 1.0, 0.2], 1.5),
            cone([0.0, 0.1, 3.0], [0.1, 0.0, -1.0], 35.0),
            cone([0.0, 0.0, -3.0], [0.0, 0.2, 1.0], 60.0),
        ][which].clone();
        let side = if outside { 1.0 } else { -1.0 };
        let unit = Vec3::from(axis).normalize();
        let (value, normal, error) = clearance(&tool, &geometry, side, [tip.0, tip.1, tip.2], axis);
        let surface = Surface::of(&geometry).unwrap();
        let sampled = samples(&tool, Vec3::from([tip.0, tip.1, tip.2]), unit)
            .iter()
            .map(|p| side * surface.point_distance(p).unwrap().0)
            .fold(f64::INFINITY, f64::min);
        prop_assert!(error < 1e-6);
        prop_assert!((normal.norm() - 1.0).abs() < 1e-9);
        // Samples can only be too far. In penetration the least way out is no shorter than the deepest sample is deep.
        prop_assert!(value <= sampled + 1e-9, "value {value} sampled {sampled}");
        if value > 0.0 || !outside {
            prop_assert!(sampled - value < 5e-3, "value {value} sampled {sampled}");
        }
    }

    #[test]
    fn the_gradient_predicts_the_clearance_nearby(
        tool in tools(),
        tip in (-2.5..2.5f64, -2.5..2.5f64, -2.0..3.5f64),
        step in direction(),
        pair in twins(),
        outside in any::<bool>(),
    ) {
        // Convex outside, concave inside: the tangent is a bound on the one side.
        let side = if outside { 1.0 } else { -1.0 };
        let tip = Vec3::from([tip.0, tip.1, tip.2]);
        let to = tip + Vec3::from(step) * 0.3;
        let (value, normal, _) = clearance(&tool, &pair.0, side, tip.into(), UP);
        let (next, ..) = clearance(&tool, &pair.0, side, to.into(), UP);
        let predicted = value + normal.dot(&(to - tip));
        prop_assert!(side * (next - predicted) > -1e-9, "{next} {predicted}");
        prop_assert!((next - value).abs() <= (to - tip).norm() + 1e-9);
    }

    #[test]
    fn a_quadric_agrees_with_the_closed_form_of_the_same_surface(
        tool in tools(),
        tip in (-4.5..4.5f64, -4.5..4.5f64, -3.0..4.5f64),
        axis in direction(),
        pair in twins(),
        outside in any::<bool>(),
    ) {
        let side = if outside { 1.0 } else { -1.0 };
        let tip = [tip.0, tip.1, tip.2];
        let (closed, normal, _) = clearance(&tool, &pair.0, side, tip, axis);
        let (value, _, error) = clearance(&tool, &pair.1, side, tip, axis);
        // The disc at the top of the tool is part of it in the one alone.
        prop_assume!(normal.dot(&Vec3::from(axis).normalize()) > -1.0 + 1e-12);
        // Deep penetration of a solid is measured by the way out in the one and by depth in the other.
        if closed > -0.05 || !outside {
            prop_assert!((closed - value).abs() < 1e-8 + error, "closed {closed} quadric {value} ± {error}");
            prop_assert!(error < 1e-5, "error {error}");
        } else {
            prop_assert!(value < 0.0);
        }
    }

    #[test]
    fn point_distance_to_a_quadric_is_least(
        coefficients in prop::array::uniform10(-2.0..2.0f64),
        point in (-3.0..3.0f64, -3.0..3.0f64, -3.0..3.0f64),
        aim in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), 40),
    ) {
        let surface = Surface::of(&quadric(coefficients)).unwrap();
        let p = Vec3::new(point.0, point.1, point.2);
        let [a, b, c, d, f, g, h, pp, q, r] = coefficients;
        let value = |x: &Vec3| {
            a * x.x * x.x + b * x.y * x.y + c * x.z * x.z + d
                + 2.0 * (f * x.y * x.z + g * x.x * x.z + h * x.x * x.y + pp * x.x + q * x.y + r * x.z)
        };
        if let Some((distance, normal)) = surface.point_distance(&p) {
            let foot = p - normal * distance;
            prop_assert!(value(&foot).abs() < 1e-7 * (1.0 + foot.norm_squared()), "foot off by {}", value(&foot));
            prop_assert!(distance == 0.0 || (distance > 0.0) == (value(&p) > 0.0));
            // No ray leaves the ball of this radius without a change of sign being farther than the distance.
            for d in aim {
                let d = Vec3::new(d.0, d.1, d.2);
                if d.norm() > 1e-3 {
                    let near = p + d.normalize() * (distance.abs() * (1.0 - 1e-6));
                    prop_assert!(value(&near) * value(&p) >= 0.0);
                }
            }
        }
    }

    #[test]
    fn any_quadric_agrees_with_dense_sampling(
        tool in tools(),
        tip in (-3.0..3.0f64, -3.0..3.0f64, -3.0..3.0f64),
        axis in direction(),
        squares in prop::array::uniform3(prop_oneof![-1.0..-0.2f64, 0.2..1.0f64, Just(0.0)]),
        rest in prop::array::uniform7(-0.4..0.4f64),
    ) {
        let [f, g, h, p, q, r, d] = rest;
        let [a, b, c] = squares;
        let geometry = quadric([a, b, c, 4.0 * d, 0.3 * f, 0.3 * g, 0.3 * h, p, q, r]);
        let unit = Vec3::from(axis).normalize();
        let tip = Vec3::new(tip.0, tip.1, tip.2);
        let surface = Surface::of(&geometry).unwrap();
        let Some((at_tip, _)) = surface.point_distance(&tip) else { return Ok(()) };
        // The side that the tool end is on.
        let side = at_tip.signum();
        let (value, normal, error) = clearance(&tool, &geometry, side, tip.into(), axis);
        let sampled = samples(&tool, tip, unit)
            .iter()
            .map(|x| side * surface.point_distance(x).unwrap().0)
            .fold(f64::INFINITY, f64::min);
        prop_assert!((normal.norm() - 1.0).abs() < 1e-6);
        // Only a tool that stands clear must be measured exactly: in penetration there is more than one depth.
        if sampled > 0.0 {
            prop_assert!(value <= sampled + error + 1e-9, "value {value} ± {error} sampled {sampled}");
            prop_assert!(sampled - value < 5e-3, "value {value} sampled {sampled}");
            prop_assert!(error < 1e-4, "error {error}");
        } else {
            prop_assert!(value < 5e-3, "value {value} sampled {sampled}");
        }
    }
}

/// A cone that is blunt at its tip by next to nothing bends sharply there; a tool farther up is bounded by what is beside it.
#[test]
fn the_bend_beside_a_long_tool_is_that_of_the_places_beside_it() {
    let [least, radius, reach] = [0.5, 0.5, 1.0];
    let Geometry::Quadric(blunt) = quadric([1.0, 1.0, -1.0, -1e-12, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) else {
        panic!("a quadric")
    };
    let form = PrincipalQuadric::of(&blunt).unwrap();
    for x in [3.0, 5.0, 9.0] {
        let line = [Vec3::new(x, 0.0, least), Vec3::new(x, 0.0, least + 20.0)];
        let bound = form.hill_along(1.0, line, [radius, reach], 0.0).unwrap();
        let mut greatest: f64 = 0.0;
        for k in 0..=400 {
            for turn in 0..60 {
                let (z, (s, c)) =
                    (f64::from(k) * 0.1 - 10.0, (f64::from(turn) * std::f64::consts::PI / 30.0).sin_cos());
                let place = Vec3::new(z * c, z * s, z);
                let beside = (place.x - x).hypot(place.y) - radius;
                let over = (least - z).max(z - least - 20.0);
                if beside.max(0.0).hypot(over.max(0.0)) <= reach {
                    // Across a generator, 1/(z√2).
                    greatest = greatest.max(1.0 / (z.abs() * std::f64::consts::SQRT_2));
                }
            }
        }
        assert!(greatest > 0.0 && bound >= greatest && bound <= 2.0 * greatest, "{bound} {greatest}");
        // One ball about the whole tool holds the tip.
        let all = form.hill_along(1.0, line, [radius, reach], f64::MAX).unwrap();
        assert!(all > 1e3 * bound, "{all}");
    }
}

/// Beside the axis of a hollow cone nearly the same is left all round: a ball that leans, and a round corner and a rim that do not.
#[test]
fn a_tool_that_touches_a_hollow_cone_all_round_is_measured_to_rounding() {
    let hollow = cone([0.0; 3], UP, 60.0);
    let (sine, cosine) = 60f64.to_radians().sin_cos();
    for ([diameter, corner], lean) in [([0.6, 0.3], [-0.5, 0.6, 0.9]), ([0.8, 0.3], UP), ([0.8, 0.0], UP)] {
        let tool = cutter(&[diameter, corner]);
        let axis = Vec3::from(lean).normalize();
        for aside in [0.0, 1e-9, 1e-6, 1e-3] {
            let tip = Vec3::new(aside, 0.0, 2.0) - axis * corner;
            let (value, _, error) = clearance(&tool, &hollow, -1.0, tip.into(), axis.into());
            let exact = 2.0 * sine - (aside + 0.5 * diameter - corner) * cosine - corner;
            assert!((value - exact).abs() < 1e-9, "{aside}: {value}, not {exact}");
            assert!(error < 1e-9, "{aside}: {error}");
        }
    }
}

/// A bell tool in a hollow touches in two places that are equally near, and the ball of its corner comes nearer than both with its far side,
/// which is inside the tool.
#[test]
fn the_far_side_of_a_ball_tells_nothing_of_the_corner() {
    let bell = cutter(&[0.6, 0.11, 0.2, 0.13, 6.1004642321928, 2.273556894334401, 2.735673037174148]);
    let hollow = quadric([
        0.07080613925957382,
        0.10559833774391138,
        -0.11744145850813797,
        0.5167916003422437,
        0.10731085762130174,
        0.010141314362686537,
        -0.029311589715129413,
        0.08310674847737345,
        -0.1515829452663683,
        -0.5560604253087537,
    ]);
    let axis = [-0.1816524186998199, -0.27106077408772283, 0.94526634105498];
    for t in [0.455, 0.459, 0.4605, 0.461, 0.4615, 0.4625, 0.467] {
        let tip = Vec3::new(0.92077, 1.78176, 0.61053).lerp(&Vec3::new(0.61428, 2.08527, 0.59630), t);
        let (value, _, error) = clearance(&bell, &hollow, -1.0, tip.into(), axis);
        assert!(value > 0.0 && error < 1e-9, "{t}: {value} ± {error}");
    }
}

/// The top of a tool in a hollow cone, in the plane that touches the cone along a ruling: all of its rim but two places sticks out.
#[test]
fn a_top_in_a_tangent_plane_of_a_hollow_cone_is_not_taken_to_touch_it() {
    let geometry = Geometry::Cone(Cone {
        vertex: Vec3::new(-0.20838950592030625, 0.2862256579411938, 6.6654386073157905),
        axis: Vec3::new(0.3997818281081601, 0.23543041262376063, -0.8858594757219135),
        cosine: 0.46395364991957616,
    });
    let tool = cutter(&[0.9854804994995121, 0.29749053829409555]);
    let from = Vec3::new(0.965497250232437, 0.9775243212206997, 1.665438607315791);
    let surface = Surface::of(&geometry).expect("a surface");
    for (right, above) in [(0.0, 0.0), (0.0, 1e-9), (0.0, -1e-9), (0.03, 0.0), (-0.1, 0.0), (0.3, 1e-6)] {
        let tip = from + Vec3::new(0.5 * right, right, above);
        let (value, _, error) = clearance(&tool, &geometry, -1.0, tip.into(), UP);
        let places = samples(&tool, tip, Vec3::z());
        let sampled = places
            .iter()
            .map(|x| -surface.point_distance(x).expect("a distance").0)
            .fold(f64::INFINITY, f64::min);
        let is_deep = sampled < -0.01 && value <= sampled + 1e-9 && sampled - value < 5e-3;
        assert!(is_deep && error < 1e-8, "{right} {above}: {value} sampled {sampled}");
    }
}

/// Where the centre of a conic is so far away that nothing told from there has digits, as that of one through rounded points of a parabola, distances
/// have all of theirs.
#[test]
fn distances_from_a_conic_with_a_far_centre_have_all_their_digits() {
    let half_width = 15.0;
    for squeeze in [1e-4, 1e-7, 1e-9, 1e-11, -1e-4, -1e-7, -1e-9, -1e-11] {
        let Geometry::Quadric(conic) =
            quadric([1.0, squeeze, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -half_width, 0.0])
        else {
            panic!("a quadric")
        };
        let form = PrincipalQuadric::of(&conic).unwrap();
        for (x, share) in [(-30.0, 0.5), (-7.0, -2.0), (0.5, 0.9), (12.0, -0.01), (31.0, 0.3)] {
            let x: f64 = x;
            let y = x * x / (half_width + (half_width * half_width - squeeze * x * x).sqrt());
            let gradient = Vec3::new(x, squeeze * y - half_width, 0.0);
            let slope = gradient.norm();
            let expected = -share * slope;
            let place = Vec3::new(x, y, 0.0) + gradient * (expected / slope);
            let found = form.distance(&place).unwrap();
            let off = found.distance - expected;
            assert!(off.abs() < 1e-12 * place.norm(), "{squeeze}: {off:.2e} at {place}");
            assert!(
                (found.normal - gradient / slope).norm() < 1e-10,
                "{squeeze}: {} at {place}",
                found.normal
            );
        }
    }
}
