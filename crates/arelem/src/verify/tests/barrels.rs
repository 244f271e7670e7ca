//! Barrels and lenses: cutters whose corner arc has its centre beyond the axis.

use std::f64::consts::{FRAC_PI_2, TAU};

use apt_geometry::{Vec3, cutter::Cutter};
use proptest::prelude::*;

use super::{
    super::tool::{Meridian, Profile, Tool},
    BARRELS,
    clearances::clearance,
    cutter, cylinder, plane, sphere,
};

/// Places of the meridian by the seven numbers alone: tip, top, and of the corner circle what is before the axis and inside both lines.
fn outline(cutter: &Cutter, count: u32) -> Vec<Meridian> {
    let (sa, ca) = cutter.alpha.sin_cos();
    let (sb, cb) = cutter.beta.sin_cos();
    let knee = [cutter.radius(), cutter.knee_height()];
    let mut places = vec![[0.0; 2], [cutter.top_radius(), cutter.height]];
    let (e, f, r) = (cutter.corner_offset, cutter.corner_height, cutter.corner_radius);
    // Where the circle leaves the lower line: all that there is of an arc between two samples.
    let along = e * ca + f * sa + (r * r - (f * ca - e * sa).powi(2)).max(0.0).sqrt();
    let samples = (0..=count).map(|k| {
        let (s, c) = (FRAC_PI_2 * f64::from(k) / f64::from(count)).sin_cos();
        [e + r * s, f - r * c]
    });
    for p in std::iter::once([along * ca, along * sa]).chain(samples) {
        let below = sa * p[0] - ca * p[1];
        let beyond = cb * (p[0] - knee[0]) - sb * (p[1] - knee[1]);
        if p[0] >= 0.0 && below <= 1e-9 && beyond <= 1e-9 {
            places.push(p);
        }
    }
    places
}

fn support(outline: &[Meridian], [s, c]: Meridian) -> f64 {
    outline.iter().map(|p| s * p[0] + c * p[1]).fold(f64::NEG_INFINITY, f64::max)
}

/// Places that an outline has on a quarter of a turn of its circle.
const SAMPLES: u32 = 20_000;

fn numbers() -> impl Strategy<Value = Cutter> {
    let wild =
        (0.2..2.0f64, 0.0..40.0f64, 0.0..20.0f64, -3.0..0.0f64, 0.0..3.0f64, [0.0..1.0f64, 0.1..3.0f64]);
    let wild = wild.prop_filter_map("legal", |(d, alpha, beta, e, up, [share, h])| {
        let base = cutter(&[d, 0.0, e, 0.0, alpha, beta, 0.0]);
        let f = base.knee_height() + up;
        // Between the farther of the two lines and the place where they meet.
        let (sa, ca) = base.alpha.sin_cos();
        let (sb, cb) = base.beta.sin_cos();
        let lines = [f * ca - e * sa, (0.5 * d - e) * cb + up * sb];
        let least = lines[0].max(lines[1]);
        let r = least + share * ((0.5 * d - e).hypot(up) - least);
        let made = Cutter { corner_radius: r, corner_height: f, height: f + h, ..base };
        Cutter::from_numbers(&[d, r, e, f, alpha, beta, f + h], 1.0).is_ok().then_some(made)
    });
    prop_oneof![prop::sample::select(BARRELS.to_vec()).prop_map(|numbers| cutter(&numbers)), wild]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_barrel_is_its_outline(cutter in numbers(), at in prop::collection::vec([0.0..3.0f64, -1.0..4.0f64], 12)) {
        let profile = Profile::of(&cutter).unwrap();
        let places = outline(&cutter, SAMPLES);
        // The arc ends up to a sample before its true ends.
        let sampling = 1e-9 + cutter.corner_radius * FRAC_PI_2 / f64::from(SAMPLES);
        let other = cutter.profile();
        for k in 0..=360 {
            let (s, c) = (TAU * f64::from(k) / 720.0).sin_cos();
            let (value, place) = profile.support([s, -c]);
            let sampled = support(&places, [s, -c]);
            prop_assert!((value - sampled).abs() < sampling, "{k}: {value} {sampled}");
            prop_assert!((s * place[0] - c * place[1] - value).abs() < 1e-12);
            // The engine has the same body.
            prop_assert!((other.support(s, -c).0 - value).abs() < 1e-9);
        }
        for p in at {
            // How far a place is from a convex body is how far it stands out over it in the direction in which that is most.
            let over = |k: u32| {
                let (s, c) = (TAU * f64::from(k) / 20_000.0).sin_cos();
                s * p[0] + c * p[1] - profile.support([s.abs(), c]).0
            };
            let sampled = (0..20_000).map(over).fold(f64::NEG_INFINITY, f64::max);
            let (distance, nearest) = profile.signed_distance(p);
            prop_assert!((distance - sampled).abs() < 2e-3, "{p:?}: {distance} {sampled}");
            prop_assert!(((p[0] - nearest[0]).hypot(p[1] - nearest[1]) - distance.abs()).abs() < 1e-9);
            let found = other.distance(p[0], p[1]).0;
            prop_assert!((found - distance).abs() < 1e-9, "{p:?}: {found} {distance}");
            let farthest = places.iter().map(|q| (p[0] + q[0]).hypot(p[1] - q[1])).fold(0.0, f64::max);
            for found in [profile.farthest(p).0, other.greatest_distance(p[0], p[1]).0] {
                prop_assert!((found - farthest).abs() < sampling, "{p:?}: {found} {farthest}");
            }
        }
    }

    /// The ball that a body is said to hold where it is touched is in it, and how far the place moves is told.
    #[test]
    fn what_touches_a_barrel_touches_a_ball_in_it(
        cutter in numbers(), n in prop::array::uniform3(-1.0..1.0f64), along in prop::array::uniform3(-1.0..1.0f64),
    ) {
        let n = Vec3::from(n);
        prop_assume!(n.norm() > 0.1);
        let n = n.normalize();
        let along = (Vec3::from(along) - n * n.dot(&Vec3::from(along))).try_normalize(0.1);
        prop_assume!(along.is_some());
        let along = along.unwrap();
        let profile = Profile::of(&cutter).unwrap();
        let tool = Tool::new(&profile, Vec3::z());
        let found = tool.turning_support(&n, &along);
        let (value, place) = tool.support(&n);
        prop_assert!((found.value - value).abs() < 1e-12);
        prop_assert!((found.center + n * found.ball - place).norm() < 1e-9);
        prop_assert!(found.ball <= 0.0 || tool.signed_distance(&found.center).0 <= 1e-9 - found.ball);
        let turn = 1e-5;
        let beside = |sense: f64| tool.support(&(n + along * (sense * turn)).normalize()).1;
        let [before, after] = [-1.0, 1.0].map(beside);
        let moved = (after - before).dot(&along) / (2.0 * turn);
        // Not where the normal is that of an end of the arc, or across the axis.
        let is_steady = ((beside(2.0) - after) - (after - place)).norm() < 1e-3 * turn && n.xy().norm() > 0.05;
        if is_steady && found.swing < 10.0 {
            prop_assert!((moved - found.swing).abs() < 1e-2 * (1.0 + found.swing), "{moved} {}", found.swing);
        }
    }

    /// Where no edge is the body bends no more than it is round, and somewhere as much.
    #[test]
    fn a_barrel_bends_no_more_than_it_is_round(which in prop::sample::select(vec![0, 2]), share in 0.02..0.98f64, turn in 0.0..TAU) {
        let profile = Profile::of(&cutter(&BARRELS[which])).unwrap();
        let tool = Tool::new(&profile, Vec3::z());
        let ([lower, upper, _], (center, radius)) = (profile.edges(), profile.corner().unwrap());
        let [first, last] = [lower, upper].map(|p| (p[0] - center[0]).atan2(center[1] - p[1]));
        let (sin, cos) = (first + share * (last - first)).sin_cos();
        let n = Vec3::new(sin, 0.0, -cos);
        let place = tool.support(&n).1;
        let across = Vec3::y() * turn.cos() + Vec3::new(cos, 0.0, sin) * turn.sin();
        let reach = 1e-3;
        let distance = |t: f64| tool.distance(&(place + n * 1e-4 + across * t));
        let bend = (distance(reach) + distance(-reach) - 2.0 * distance(0.0)) / (reach * reach);
        let round = tool.roundness_at(&place, reach, reach).unwrap();
        prop_assert!(bend <= round, "{bend} {round}");
        // Round the axis it bends by the sine of the normal over the distance from that.
        let own = sin / place.x;
        let at_lower = (lower[0] - center[0]) / (radius * lower[0]);
        prop_assert!(own <= at_lower && (round - at_lower.max(1.0 / upper[0])).abs() < 1e-12);
        if turn.sin().abs() < 1e-3 {
            prop_assert!((bend - own).abs() < 0.01 * own, "{bend} {own}");
        }
    }
}

/// Numbers of one's own: beside what is upright counts how wide the barrel is, over what leans its arc.
#[test]
fn a_barrel_is_as_far_as_it_is_by_hand() {
    let barrel = cutter(&BARRELS[0]);
    let up = [0.0, 0.0, 1.0];
    let wall = plane([1.0, 0.0, 0.0], 0.0);
    assert!((clearance(&barrel, &wall, 1.0, [0.7, 0.3, 0.0], up).0 - 0.2).abs() < 1e-12);
    for (side, x, expected) in [(1.0, 2.7, 0.2), (-1.0, 1.2, 0.3)] {
        let upright = cylinder([0.0; 3], up, 2.0);
        assert!((clearance(&barrel, &upright, side, [x, 0.0, 0.0], up).0 - expected).abs() < 1e-12);
    }
    // A wall that leans over the tool by 20 degrees touches it on the arc: 3 from its centre, which is 2.5 beyond the axis and 1.5 up.
    let (s, c) = 20f64.to_radians().sin_cos();
    let leaning = plane([c, 0.0, s], 0.0);
    let height = |tip: f64| c * tip;
    let expected = height(4.0) - (3.0 - 2.5 * c - 1.5 * s);
    assert!((clearance(&barrel, &leaning, 1.0, [4.0, 0.0, 0.0], up).0 - expected).abs() < 1e-12);
    // A ball that faces the arc square: on the line from its centre through the place with its normal 70 degrees from straight down.
    let [s, c] = [70f64.to_radians().sin(), 70f64.to_radians().cos()];
    let away = |by: f64| [-2.5 + (3.0 + by) * s, 0.0, 1.5 - (3.0 + by) * c];
    let (value, normal, _) = clearance(&barrel, &sphere(away(1.25), 1.0), 1.0, [0.0; 3], up);
    assert!(
        (value - 0.25).abs() < 1e-12 && (normal - Vec3::new(-s, 0.0, c)).norm() < 1e-9,
        "{value} {normal}"
    );
    // In a hollow ball about the middle of the axis the top is nearest.
    let (value, ..) = clearance(&barrel, &sphere([0.0, 0.0, 1.5], 2.0), -1.0, [0.0; 3], up);
    assert!((value - (2.0 - 1.5f64.hypot(0.5))).abs() < 1e-12);
}

/// The numbers that a barrel may not have.
#[test]
fn an_arc_that_is_no_part_of_a_convex_outline_is_refused() {
    for numbers in [
        // It does not come to the bottom, nor to the flank, or ends beyond the bottom.
        [1.0, 3.0, -2.5, 3.5, 0.0, 0.0, 6.0],
        [1.0, 3.0, -3.0, 1.5, 0.0, 0.0, 3.0],
        [1.0, 4.0, -2.5, 0.5, 0.0, 0.0, 3.0],
        // A centre below the end of the bottom.
        [1.0, 2.2, -1.5, 0.1, 30.0, 0.0, 2.5],
    ] {
        assert!(
            Profile::of(&cutter(&numbers)).is_err()
                || Profile::of(&cutter(&numbers)).unwrap().corner().is_none(),
            "{numbers:?}"
        );
        assert!(Cutter::from_numbers(&numbers, 1.0).is_err() || numbers[1] == 4.0, "{numbers:?}");
    }
}
