//! Tools so thin that a step, or the place in the band where they stop, is wider: they go through a check surface without
//! ever being in it, and are TO and PAST it all the same.

use std::cell::Cell;

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Quadric},
    cutter::Cutter,
    motion::{DriveSide, MotionCommand, Relation, Turn},
    patience::Patience,
    surface::Surface,
};

use super::{Watcher, graze::least_value};
use crate::{
    attitude::Sweep,
    clearance::{EVALUATIONS, Enough, Memory, Tool, separation},
    directed::prepare::prepare,
    error::MotionFailure,
    tests::{Program, circle, cylinder, motion, named, plane, quadric, sphere, v},
    verify::{tests::lofts, verify},
};

/// A needle a thousandth high in the planes y = 0 and z = 0.3 x, at x = −3, looking along +x.
fn needle(inside: f64, outside: f64) -> Program {
    let mut p = Program::new();
    p.tolerance(inside, outside).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.001]).from(-3.0, 0.0, 0.0);
    let slope = plane(-0.3 / 1.09f64.sqrt(), 0.0, 1.0 / 1.09f64.sqrt(), 0.0);
    p.go(&[
        (Relation::On, &plane(0.0, 1.0, 0.0, 0.0)),
        (Relation::To, &slope),
        (Relation::On, &plane(1.0, 0.0, 0.0, -3.0)),
    ]);
    p.indirv(1.0, 0.0, 0.0);
    p
}

/// Where the needle ends along y = 0.
fn end(p: &mut Program, relation: Relation, occurrence: u32, check: &Geometry) -> Vec3 {
    let command = motion(Turn::Forward, &plane(0.0, 1.0, 0.0, 0.0), &[(relation, occurrence, check)]);
    p.run(&command);
    assert!(verify(p.last(), &|| false).unwrap().verified);
    p.tip()
}

#[test]
fn a_needle_stops_to_and_past_what_it_goes_through() {
    // Bands that leave rests outside, on and inside the surface.
    for (inside, outside) in [(0.01, 0.005), (0.0, 0.001), (0.001, 0.001), (0.0005, 0.0)] {
        let band = inside + outside + 0.001;
        let upright = [plane(1.0, 0.0, 0.0, 1.25), circle(1.75, 0.0, 0.5)];
        let leaning = [
            plane(0.8, 0.6, 0.0, 1.0),
            sphere(1.75, 0.0, 0.525, 0.5),
            cylinder(v(1.75, 0.0, 0.525), v(0.0, 1.0, 0.0), 0.5),
        ];
        for check in upright.iter().chain(&leaning) {
            for relation in [Relation::To, Relation::Past] {
                for force in [false, true] {
                    let mut p = needle(inside, outside);
                    p.run(&MotionCommand::ForceIteration(force));
                    let at = end(&mut p, relation, 1, check).x;
                    // Of the sphere and the lying cylinder about (1.75, 0.525) the slope meets the near side here.
                    let near = if matches!(check, Geometry::Sphere(_) | Geometry::Cylinder(_)) {
                        1.75 - 0.5 / 1.09f64.sqrt()
                    } else {
                        1.25
                    };
                    assert!((at - near).abs() <= 1.3 * band, "{check:?} {relation:?} {force}: {at}");
                }
            }
        }
    }
}

#[test]
fn a_needle_counts_both_walls_of_a_post() {
    for (relation, force) in
        [(Relation::To, false), (Relation::Past, false), (Relation::To, true), (Relation::Past, true)]
    {
        let mut p = needle(0.01, 0.005);
        p.run(&MotionCommand::ForceIteration(force));
        let at = end(&mut p, relation, 2, &circle(1.75, 0.0, 0.5)).x;
        assert!((at - 2.25).abs() <= 0.02, "{relation:?}: {at}");
        let third =
            motion(Turn::Forward, &plane(0.0, 1.0, 0.0, 0.0), &[(relation, 3, &circle(4.0, 0.0, 0.5))]);
        let refused = p.attempt(&third);
        assert!(matches!(refused, Err(MotionFailure::NoneAhead { .. })), "{refused:?}");
    }
}

/// For ON the band lies about the surface with OUTTOL on the side that the tool comes from, whether that is the outer or the inner one.
#[test]
fn on_a_curved_surface_the_tool_stops_in_the_band_of_the_side_it_comes_from() {
    let surfaces = [
        circle(1.75, 0.0, 0.5),
        sphere(1.75, 0.0, 0.525, 0.5),
        cylinder(v(1.75, 0.0, 0.525), v(0.0, 1.0, 0.0), 0.5),
        // An ellipsoid about the same place.
        quadric([1.0, 2.0, 1.5, 3.0625 + 1.5 * 0.275_625 - 0.25, 0.0, 0.0, 0.0, -1.75, 0.0, -0.7875]),
    ];
    for (inside, outside) in [(0.0, 0.001), (0.001, 0.0), (0.001, 0.004)] {
        for check in &surfaces {
            let surface = Surface::from_geometry(check).expect("a surface");
            for (occurrence, side) in [(1, 1.0), (2, -1.0)] {
                let mut p = needle(inside, outside);
                p.run(&MotionCommand::ForceIteration(true));
                let tip = end(&mut p, Relation::On, occurrence, check);
                let at = side * surface.signed_distance(&tip);
                let rounding = 1e-12;
                assert!(
                    (-inside - rounding..=outside + rounding).contains(&at),
                    "{check:?} position {occurrence}, band {inside} {outside}: {at}"
                );
            }
        }
    }
}

/// One vector ends at the surface, the next one begins beyond it by less than rounding: the stop is between them, also far from the
/// path, which tells nothing there.
#[test]
fn a_stop_where_one_vector_ends_and_the_next_one_begins_is_seen() {
    let (drive, check) = (plane(0.0, 1.0, 0.0, 0.0), plane(1.0, 0.0, 0.0, 0.0));
    let p = needle(0.01, 0.005);
    let MotionCommand::Drive { drive, checks, .. } =
        motion(Turn::Forward, &drive, &[(Relation::On, 1, &check)])
    else {
        unreachable!("a motion");
    };
    let prepared = prepare(&p.state, Turn::Forward, &drive, &checks, &mut Vec::new(), Patience::default())
        .expect("a motion");
    let sweep = |from: f64, to: f64| {
        let [from, to] = [from, to].map(|x| v(x, 0.0, 2.0 - x));
        let axis = Vec3::z();
        Sweep::new(&prepared.tool, (&from, &axis), (&to, &axis))
    };
    for (end, start) in [(0.0, 1e-17), (-1e-17, 1e-17), (1e-17, -1e-17), (1e-17, 0.0)] {
        let mut watcher = Watcher::new(&prepared, &checks);
        let found = [(-1.0, end), (start, 1.0)].map(|(from, to)| watcher.scan(&sweep(from, to)));
        let stop = found.into_iter().flatten().next().expect("a stop");
        assert!(stop.tip.x.abs() < 1e-9, "{stop:?}");
    }
}

#[test]
fn a_check_surface_costs_as_much_from_behind_as_from_the_front() {
    // The path runs along a plane a tenth beside it, and ends at another one.
    let clearances = |beside: Geometry| {
        let mut p = needle(0.01, 0.005);
        let checks = [(Relation::To, 1, &plane(1.0, 0.0, 0.0, 1.25)), (Relation::To, 1, &beside)];
        let before = EVALUATIONS.get();
        p.run(&motion(Turn::Forward, &plane(0.0, 1.0, 0.0, 0.0), &checks));
        EVALUATIONS.get() - before
    };
    let [front, behind] = [plane(0.0, -1.0, 0.0, -0.1), plane(0.0, 1.0, 0.0, 0.1)].map(clearances);
    assert_eq!(front, behind);
}

#[test]
fn the_least_value_takes_few_places_where_it_is_smooth() {
    let smooth = |x: f64| (1.0 + (x - 0.37).powi(2)).sqrt() + 0.02 * (x - 0.37).powi(3);
    let sharp = |x: f64| 0.2 + (x - 0.37).abs() * if x < 0.37 { 2.0 } else { 0.3 };
    let falling = |x: f64| 3.0 - x;
    for (value, least, most) in
        [(&smooth as &dyn Fn(f64) -> f64, 1.0, 16), (&sharp, 0.2, 60), (&falling, 1.0, 40)]
    {
        let places = Cell::new(0);
        let found = least_value([-1.0, 2.0], &|x| {
            places.set(places.get() + 1);
            value(x)
        });
        assert!((found.1 - least).abs() <= 2e-5, "{found:?} for {least}");
        assert!(places.get() <= most, "{} places for {least}", places.get());
    }
}

/// What is remembered of both sides of a check surface does not change the clearance.
#[test]
fn what_is_remembered_of_a_check_surface_changes_no_clearance() {
    let cutter = Cutter::from_numbers(&[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 2.0], 1.0).expect("a cutter");
    let tool = Tool::new(cutter, v(0.1, -0.2, 1.0).normalize());
    let bowl = quadric([1.0, 0.6, -0.8, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, -1.0]);
    for geometry in [lofts::roof(), bowl] {
        let surface = Surface::from_geometry(&geometry).expect("a surface");
        let memories = <[Memory; 2]>::default();
        for k in 0..40 {
            let tip = v(-0.8 + 0.02 * f64::from(k), 0.3, 2.5 - 0.03 * f64::from(k));
            let [remembered, fresh] = [&memories, &<[Memory; 2]>::default()].map(|memories| {
                let (contact, side) = separation(&tool, &surface, &tip, memories, Enough::ALL);
                (contact.clearance, side)
            });
            let is_same = remembered.1 == fresh.1 && (remembered.0 - fresh.0).abs() < 1e-7;
            assert!(is_same, "{remembered:?} and {fresh:?} at {tip}");
        }
    }
}

/// Where one vector leads into a surface by no more than steps may overlook, a fiftieth of the band, and the next one out again on the same side, the
/// tool has touched it: it is not past it. The other way round it has not come to it anew. Farther in it is, and where it goes through.
#[test]
fn what_is_in_a_surface_by_less_than_a_step_is_not_past_it() {
    let (drive, check) = (plane(0.0, 1.0, 0.0, 0.0), plane(1.0, 0.0, 0.0, 0.0));
    let p = needle(0.01, 0.005);
    let ball = Cutter::from_numbers(&[0.5, 0.25], 1.0).expect("a cutter");
    let stopped = |relation: Relation, along: &[f64]| {
        let MotionCommand::Drive { drive, checks, .. } =
            motion(Turn::Forward, &drive, &[(relation, 1, &check)])
        else {
            unreachable!("a motion");
        };
        let mut prepared =
            prepare(&p.state, Turn::Forward, &drive, &checks, &mut Vec::new(), Patience::default())
                .expect("a motion");
        (prepared.tool, prepared.tip) = (Tool::new(ball, Vec3::z()), v(along[0], 0.0, 2.0));
        let mut watcher = Watcher::new(&prepared, &checks);
        let places = along.iter().enumerate().map(|(k, x)| v(*x, 0.0, 2.0 - 0.1 * k as f64));
        let places: Vec<Vec3> = places.collect();
        let vectors = places.windows(2).map(|pair| {
            let axis = Vec3::z();
            Sweep::new(&prepared.tool, (&pair[0], &axis), (&pair[1], &axis))
        });
        vectors.map(|vector| watcher.scan(&vector)).position(|event| event.is_some())
    };
    // The ball touches the plane at x = −.25, and again at x = .25.
    let depths = [(1e-6, None), (0.0002, None), (0.0004, Some(1)), (0.4, Some(1)), (0.6, Some(0))];
    for (depth, at) in depths {
        assert_eq!(stopped(Relation::Past, &[-1.0, -0.25 + depth, -1.0]), at, "{depth}");
    }
    for (clear, at) in [(1e-6, None), (0.0002, None), (0.0004, Some(1)), (0.1, Some(1))] {
        assert_eq!(stopped(Relation::To, &[-0.1, -0.25 - clear, -0.1]), at, "{clear}");
    }
}

/// Between two vectors a ball touches one branch of a hyperbola, a little farther in than where motions end, and goes away from it: it does not end past it.
#[test]
fn a_ball_that_touches_a_branch_of_a_hyperbola_is_not_past_it() {
    let part = sphere(-5.208353327512224, -2.0365204985022602, -1.441116980945119, 4.547810533408308);
    let drive = sphere(-0.5880981285256697, 5.637803385139276, 2.996323777565291, 6.990165624160236);
    let hyperbola = Geometry::Hyperbola(Quadric {
        coefficients: [
            0.005115217843847424,
            -0.07312684686360733,
            0.0,
            -0.46506796383282134,
            0.0,
            0.0,
            -0.06773276266589956,
            -0.32971892676645187,
            -0.11699659214964706,
            0.0,
        ],
    });
    let mut p = Program::new();
    p.tolerance(0.01, 0.005)
        .cutter(&[0.4356463409940147, 0.21782317049700736])
        .run(&MotionCommand::MaximumStep(10.0))
        .from(-1.7166157495342078, -1.2775828209032412, 1.9468240198828721)
        .run(&MotionCommand::PartSurface(named(&part)))
        .go(&[(Relation::On, &drive)])
        .side(DriveSide::On)
        .indirv(0.7171240246344116, -0.009004206414390125, -0.696887406658343);
    let refused = p.attempt(&motion(Turn::Forward, &drive, &[(Relation::Past, 1, &hyperbola)]));
    let Err(MotionFailure::NeverMet { .. }) = refused else { panic!("{refused:?}") };
}

/// A cylinder that the path does not go through, but its vectors do a little: a turn later these are to be the same, that the path is not made simpler to
/// come through it beyond doubt.
#[test]
fn what_is_taken_for_a_touch_stays_one() {
    let (drive, part) =
        (sphere(0.0, 0.0, -0.098, 7.815), cylinder(v(0.0, 0.0, -30.0), v(1.0, 0.0, 0.0), 30.0));
    for k in -4..12 {
        let reach = 8.010_882_192_050_643 + 0.0005 * f64::from(k);
        let check = cylinder(v(reach + 5.0, 0.0, 0.0), v(0.0, 0.3, 1.0).normalize(), 5.0);
        for occurrence in [2, 3] {
            let mut p = Program::new();
            p.tolerance(0.0005, 0.002).cutter(&[0.4]).from(0.0, -40.0, 0.0).indirv(0.0, 1.0, 0.0);
            p.go(&[(Relation::To, &drive), (Relation::To, &part)]);
            p.side(DriveSide::Right).indirv(1.0, 0.0, 0.0);
            p.run(&motion(Turn::Forward, &drive, &[(Relation::On, occurrence, &check)]));
            let evidence = verify(p.last(), &|| false).expect("evidence");
            assert!(evidence.verified, "{reach} {occurrence}: {evidence:?}");
        }
    }
}
