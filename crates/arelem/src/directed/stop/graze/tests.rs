//! Check surfaces touched by a hair's breadth, deep or not at all.

use std::cell::Cell;

use apt_geometry::{
    canonical::Geometry,
    motion::{DriveSide, MotionCommand, PartSide, Relation, Turn},
};
use proptest::prelude::*;

use super::{least, least_up_to};
use crate::{
    tests::{Program, cylinder, motion, plane, quadric, sphere, v},
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

/// Vectors lie elsewhere in their bands than the path at rest, which comes to a kink here: they cross the check surface .01 before
/// that path does. It is one position and no touch besides.
#[test]
fn a_crossing_is_not_counted_as_a_touch_again() {
    let part = quadric([
        0.2732029069050007,
        0.09879660793492376,
        -0.09374798503344749,
        0.1019472654063256,
        -0.01175681794648914,
        -0.056491455556991636,
        -0.03856956655932688,
        -0.5636841839083837,
        -0.1475478959169045,
        -0.3706537770380258,
    ]);
    let axis = v(-0.6205487544921438, -0.20939966304762936, -0.7556924138919144);
    let drive =
        cylinder(v(2.1712143818051066, -1.5034569092829262, -1.5602616229139143), axis, 2.8516286405890128);
    let axis = v(-0.5017572993808361, 0.8347298197764669, -0.22686061909021887);
    let check =
        cylinder(v(4.819902244680961, 2.5119449734973696, -4.046804601192701), axis, 3.4235244981093955);
    let drill =
        [0.4044985105585313, 0.0, 0.20224925527926566, 0.12152361272496265, 31.0, 0.0, 2.7959763426763846];
    let start = [
        MotionCommand::MaximumStep(10.0),
        MotionCommand::MaximumPoints(1500),
        MotionCommand::From {
            position: v(1.5663848161065832, 1.4733756398789906, -1.040372478962763),
            axis: Some(v(0.05288733130916908, 0.05832561045577427, 0.996895708362693)),
            name: String::new(),
        },
    ];
    let mut p = Program::new();
    p.tolerance(0.01, 0.005).cutter(&drill);
    start.iter().for_each(|command| {
        p.run(command);
    });
    p.part_side(PartSide::Offset).go(&[(Relation::On, &drive), (Relation::To, &part)]);
    p.side(DriveSide::On).indirv(0.854631922115876, 0.2418849648028124, -0.45945178365402534);
    let before = p.sequences.len();
    let outcome = p.attempt(&motion(Turn::Forward, &drive, &[(Relation::On, 2, &check)]));
    for sequence in &p.sequences[before..] {
        let evidence = verify(sequence, &|| false).expect("a judgement");
        assert!(evidence.verified, "{:?} after {outcome:?}", evidence.violations);
    }
}

/// Where a function cannot come down to a level any more that is known after few places; where it does, its least place is told as ever.
#[test]
fn few_places_tell_that_a_valley_is_not_deep_enough() {
    let looks = Cell::new(0);
    let valley = |x: f64| {
        looks.set(looks.get() + 1);
        Some(0.05 + (x - 0.3).abs())
    };
    assert_eq!(least_up_to((0.04, 1.0), [0.0, 1.0], &valley), None);
    assert!(looks.take() <= 12);
    let whole = least([0.0, 1.0], &valley);
    assert_eq!(least_up_to((0.06, 1.0), [0.0, 1.0], &valley), whole);
}

/// Where a ball comes nearest to a plane the path at rest is along that for long, and vectors cross it before: between what the path does not touch and what
/// it goes through there is no depth at which no position is found.
#[test]
fn a_plane_beside_a_bend_of_the_path_is_met_however_little_that_goes_through_it() {
    let drive = quadric([1.0, 1.44, 0.3, -9.419, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let part = cylinder(v(0.0, 0.0, -30.0), v(0.0, 1.0, 0.0), 30.0);
    for k in 0..20 {
        let check = plane(1.0, 0.0, 0.0, 4.0645 + 0.0002 * f64::from(k));
        let mut p = Program::new();
        p.tolerance(0.0, 0.002).cutter(&[1.0, 0.5]).from(0.0, -40.0, 0.0).indirv(0.0, 1.0, 0.0);
        p.go(&[(Relation::To, &drive), (Relation::To, &part)]).side(DriveSide::Right).indirv(1.0, 0.0, 0.0);
        p.run(&motion(Turn::Forward, &drive, &[(Relation::To, 1, &check)]));
        assert!(verify(p.last(), &|| false).expect("a judgement").verified, "{k}: {:?}", p.tip());
    }
}
