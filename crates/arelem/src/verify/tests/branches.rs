//! Surfaces of two branches: a tool, or a straight move, that reaches from one branch to the other.

use apt_geometry::{
    Vec3,
    motion::{DriveSide, Relation},
};

use super::{
    clearances::{clearance, samples},
    cutter,
    paths::sequence,
    plane, quadric, role,
};
use crate::verify::{
    clearance::Surface,
    tool::{Profile, perpendicular},
    verify,
};

/// x² − y² = ¼, and the surface of revolution that it makes about x.
const TWO_BRANCHES: [[f64; 10]; 2] = [
    [1.0, -1.0, 0.0, -0.25, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, -1.0, -1.0, -0.25, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
];

#[test]
fn a_tool_that_reaches_into_both_branches_is_deep_between_them() {
    let flat = cutter(&[1.0, 0.0]);
    for form in TWO_BRANCHES {
        // From (0, ½) the feet are at y = ¼: ¼ + 2/16 away.
        let (value, ..) = clearance(&flat, &quadric(form), 1.0, [-2.5, 0.0, 0.0], [1.0, 0.0, 0.0]);
        assert!((value + 0.375f64.sqrt()).abs() < 1e-9, "{value}");
    }
}

#[test]
fn distance_is_true_however_near_a_point_is_to_the_plane_between_the_branches() {
    for form in TWO_BRANCHES {
        let surface = Surface::of(&quadric(form)).unwrap();
        for k in 0..40 {
            let x = if k == 0 { 0.0 } else { 10f64.powf(-0.5 * f64::from(k)) };
            for y in [0.0, 1e-9, 0.3, 0.5] {
                // At x = 0 the distance is √(¼ + y²/2), and it falls no faster than the point moves.
                let (distance, normal) = surface.point_distance(&Vec3::new(x, y, 0.0)).unwrap();
                let off = (distance + (0.25 + 0.5 * y * y).sqrt()).abs();
                assert!(off <= x + 1e-9 && (normal.norm() - 1.0).abs() < 1e-9, "{x:e} {y}: {distance}");
            }
        }
    }
}

#[test]
fn no_point_of_a_tool_is_deeper_than_its_clearance() {
    let shapes =
        [cutter(&[0.75, 0.17]), cutter(&[0.68, 0.34]), cutter(&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 3.0])];
    for tool in shapes {
        for form in TWO_BRANCHES {
            for (k, axis) in [[1.0, 0.2, 0.1], [0.6, 0.5, -0.3], [1.0, -0.7, 0.9]].into_iter().enumerate() {
                let tip = [-1.6 + 0.3 * k as f64, 0.2, -0.1];
                let (value, ..) = clearance(&tool, &quadric(form), 1.0, tip, axis);
                let surface = Surface::of(&quadric(form)).unwrap();
                let deepest = samples(&tool, Vec3::from(tip), Vec3::from(axis).normalize())
                    .iter()
                    .map(|p| surface.point_distance(p).unwrap().0)
                    .fold(f64::INFINITY, f64::min);
                assert!(value < 0.0 && value <= deepest + 1e-9, "{form:?} {axis:?}: {value}, {deepest}");
            }
        }
    }
}

#[test]
fn a_vector_from_one_branch_to_the_other_is_out_of_tolerance() {
    let form = quadric(TWO_BRANCHES[0]);
    let tips = [Vec3::new(-0.6, 0.0, 0.0), Vec3::new(0.6, 0.0, 0.0)];
    let ball = cutter(&[0.2, 0.1]);
    let [part, wall, stop] = [
        (plane([0.0, 0.0, 1.0], 0.0), Relation::To),
        (form, Relation::To),
        (plane([1.0, 0.0, 0.0], 0.6), Relation::On),
    ]
    .map(|(surface, relation)| role(surface, relation, 1.0, 0.001, 0.001));
    let path = sequence(&tips, ball, part, wall, stop, DriveSide::Left);
    let evidence = verify(&path, &|| false).unwrap();
    // Half way the ball is 0.6 deep; what is far beyond the band is not looked into further.
    let least = evidence.drive.unwrap().min;
    assert!(!evidence.verified && least < -0.25, "{least}");
}

/// Two bodies that are almost a double cone.
const NEARLY_A_CONE: [f64; 10] = [
    0.7174650662862181,
    1.0231540868029048,
    0.2987843472166665,
    8.547745331835097,
    -0.3493505300902319,
    -0.028187046383605738,
    -0.7356979094928593,
    0.7006808965052893,
    1.075518447073334,
    -1.5701039218368291,
];

/// Part of a turn of the rim over which the tool touches both bodies.
const BESIDE: f64 = 0.05;

#[test]
fn a_rim_that_touches_both_bodies_at_places_close_to_each_other_is_as_near_as_the_nearer() {
    let [alpha, beta] = [0.19134375311007784_f64, 0.08726646259971647].map(f64::to_degrees);
    let tool = cutter(&[1.0, 0.1875, 0.33, 0.22, alpha, beta, 2.8551858613504546]);
    let axis = Vec3::new(-0.8359763968861117, -0.4121287885835951, 0.3623442085502854);
    let surface = Surface::of(&quadric(NEARLY_A_CONE)).unwrap();
    let [.., rim] = Profile::of(&tool).unwrap().edges();
    let across = perpendicular(&axis);
    let azimuth = std::f64::consts::FRAC_PI_2;
    // A way of the tool end along which the contact goes over from one body to the other.
    for k in 0..=64 {
        let way = Vec3::new(1.0989573, -0.2720640, 3.1376563)
            .lerp(&Vec3::new(1.1012855, -0.2720402, 3.1593623), f64::from(k) / 64.0);
        let (value, ..) = clearance(&tool, &quadric(NEARLY_A_CONE), 1.0, way.into(), axis.into());
        let about = (0..=20_000).map(|k| {
            let phi = azimuth + BESIDE * (f64::from(k) / 10_000.0 - 1.0);
            let out = across * phi.cos() + axis.cross(&across) * phi.sin();
            surface.point_distance(&(way + out * rim[0] + axis * rim[1])).unwrap().0
        });
        let nearest = about.fold(f64::INFINITY, f64::min);
        assert!((value - nearest).abs() < 1e-7, "{k}: {value}, {nearest}");
    }
}

/// A double cone whose vertex is beside the rim of the top, with two troughs of the rim on one half less than a sixteenth of a turn apart.
const OVER_THE_TOP: [f64; 10] = [
    0.07741525839254744,
    0.9269846193599236,
    0.36701156147448505,
    2.607996112387654,
    -0.12239733261105845,
    -0.20685326169926,
    -0.32271914647674027,
    0.8685269621072716,
    -1.0863790332660728,
    -0.5409126224533783,
];

#[test]
fn a_rim_beside_a_vertex_is_as_near_as_its_nearest_place() {
    let tool = cutter(&[
        0.7431640004802544,
        0.0,
        0.3715820002401272,
        0.22326899068378192,
        31.0,
        0.0,
        2.3542807465970745,
    ]);
    let axis = Vec3::new(0.8213860347196389, 0.052822403161719725, -0.5679214520440032);
    let surface = Surface::of(&quadric(OVER_THE_TOP)).unwrap();
    let [.., rim] = Profile::of(&tool).unwrap().edges();
    let across = perpendicular(&axis);
    for k in 0..=64 {
        let way = Vec3::new(-1.931625433669924, 1.6877122524849912, 3.3126769235158537).lerp(
            &Vec3::new(-1.931916211312098, 1.6850271335681324, 3.3120642713710398),
            f64::from(k) / 64.0,
        );
        let (value, ..) = clearance(&tool, &quadric(OVER_THE_TOP), 1.0, way.into(), axis.into());
        let about = (0..=100_000).map(|k| {
            let phi = f64::from(k) / 100_000.0 * std::f64::consts::TAU;
            let out = across * phi.cos() + axis.cross(&across) * phi.sin();
            surface.point_distance(&(way + out * rim[0] + axis * rim[1])).unwrap().0
        });
        let nearest = about.fold(f64::INFINITY, f64::min);
        assert!((value - nearest).abs() < 1e-7, "{k}: {value}, {nearest}");
    }
}
