//! Check surfaces touched by a hair's breadth, deep or not at all.

use apt_geometry::{
    canonical::Geometry,
    motion::{Relation, Turn},
};
use proptest::prelude::*;

use crate::{
    tests::{Program, cylinder, motion, plane, sphere, v},
    verify::verify,
};

/// OUTTOL of all surfaces; INTOL is zero.
const BAND: f64 = 0.001;
/// Radius of the ball end.
const BALL: f64 = 0.25;

/// A ball over a cylinder along x or a sphere, of radius 2, in the plane y = 0, on its way towards +x. With the centre of
/// the ball at `rest` over the top, the path is a line or a circle.
fn over(top: &Geometry) -> Program {
    let middle = plane(0.0, 1.0, 0.0, 0.0);
    let mut p = Program::new();
    p.tolerance(0.0, BAND).cutter(&[2.0 * BALL, BALL]).from(-1.0, 0.0, 4.0);
    p.go(&[(Relation::On, &middle), (Relation::To, top), (Relation::On, &plane(1.0, 0.0, 0.0, -1.0))]);
    p.indirv(1.0, 0.0, 0.0);
    p
}

/// The motion towards +x with a sphere beside the path at x = `at`, `gap` away from touching the nominal path.
fn beside(
    top: &Geometry,
    curved: bool,
    at: f64,
    radius: f64,
    gap: f64,
    relation: Relation,
) -> (Program, Geometry, bool) {
    let rise = 2.0 + BALL;
    let height = if curved { (rise * rise - at * at).sqrt() } else { rise };
    let reach = if relation == Relation::On { 0.0 } else { BALL };
    // ON measures the tool end, BALL below the centre.
    let down = if relation == Relation::On { BALL } else { 0.0 };
    let check = sphere(at, radius + reach + gap, height - down, radius);
    let mut p = over(top);
    let command = motion(
        Turn::Forward,
        &plane(0.0, 1.0, 0.0, 0.0),
        &[(relation, 1, &check), (Relation::On, 1, &plane(1.0, 0.0, 0.0, 1.5))],
    );
    p.run(&command);
    let stopped = p.last().stop.as_ref().expect("a stop").index == 0;
    (p, check, stopped)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    /// What touches is a stop, however little; what stays clear of the band is none.
    #[test]
    fn no_contact_between_two_cut_vectors_is_missed(
        curved in any::<bool>(),
        at in -0.6..1.2f64,
        radius in prop_oneof![0.05..0.5f64, 0.5..20.0f64],
        share in prop_oneof![-30.0..-0.5f64, -0.5..0.2f64, 4.0..40.0f64],
        on in any::<bool>(),
    ) {
        // The tool begins clear of the check surface.
        let half_width = (2.2 * (radius + BALL) * (-share * BAND).max(0.0)).sqrt();
        prop_assume!(half_width < at + 0.95);
        let top = if curved { sphere(0.0, 0.0, 0.0, 2.0) } else { cylinder(v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), 2.0) };
        let relation = if on { Relation::On } else { Relation::To };
        let (p, check, stopped) = beside(&top, curved, at, radius, share * BAND, relation);
        prop_assert_eq!(stopped, share < 1.0, "gap {} bands beside {:?}", share, &check);
        let evidence = verify(p.last(), &|| false).expect("a judgement");
        prop_assert!(evidence.verified, "{:?}", evidence.violations);
        if stopped && share > -0.5 {
            let Geometry::Sphere(ball) = &check else { unreachable!() };
            prop_assert!((p.tip().x - ball.center.x).abs() < 0.3 * (radius * BAND * 40.0).sqrt() + 0.05);
        }
    }
}

#[test]
fn a_touch_counts_like_any_position() {
    // The second position is the crossing of the plane of a second check surface.
    let top = sphere(0.0, 0.0, 0.0, 2.0);
    let (p, _, stopped) = beside(&top, true, 0.4, 1.0, 0.1 * BAND, Relation::To);
    assert!(stopped && (p.tip().x - 0.4).abs() < 0.05, "{:?}", p.tip());
    // The second time is a turn later.
    let rise = 2.0 + BALL;
    let check = sphere(0.4, 1.0 + BALL + 0.1 * BAND, (rise * rise - 0.16).sqrt(), 1.0);
    let mut p = over(&top);
    p.run(&motion(Turn::Forward, &plane(0.0, 1.0, 0.0, 0.0), &[(Relation::To, 2, &check)]));
    assert!((p.tip().x - 0.4).abs() < 0.05 && p.last().points.len() > 60, "{:?}", p.tip());
}
