//! Paths that close on themselves: every relation and count over several turns, several check surfaces at once, and check
//! surfaces that are never met.

use std::sync::Arc;

use apt_geometry::{
    canonical::{Interval, Remembering, RuledSurface, TabulatedCylinder},
    motion::DriveSide,
};

use super::{
    refused::{AMPLE, Found},
    *,
};
use crate::{clearance::EVALUATIONS, error::Course};

/// Tool radius.
const RADIUS: f64 = 0.25;
/// The check plane is across x at this place.
const AT: f64 = 0.3;
/// Width of each half of the bands.
const BAND: f64 = 0.005;

/// A closed path: drive and part surface, where the tool comes from, and where it is along the drive surface.
struct Loop {
    name: &'static str,
    drive: Geometry,
    part: Geometry,
    from: Vec3,
    side: DriveSide,
    /// 3DCALC.
    iterate: bool,
}

/// An upright tabulated cylinder through places with a heading in degrees each, with straight extensions of a length.
pub(super) fn table_through(nodes: &[[f64; 3]], extension: f64) -> Geometry {
    let row = |u: f64, v: f64, [a, b]: [f64; 2], length: f64| Interval {
        u,
        v,
        a,
        b,
        length,
        maximum: 0.0,
        minimum: 0.0,
    };
    let ahead = |[u, v, heading]: [f64; 3], way: f64| {
        let (sine, cosine) = heading.to_radians().sin_cos();
        [u + way * cosine, v + way * sine]
    };
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    let [u, v] = ahead(first, -extension);
    let mut intervals = vec![row(u, v, [0.0; 2], extension)];
    for pair in nodes.windows(2) {
        let ([u, v, before], [u2, v2, after]) = (pair[0], pair[1]);
        let (length, chord) = ((u2 - u).hypot(v2 - v), (v2 - v).atan2(u2 - u));
        let [s1, s2] = [before, after].map(|heading| (heading.to_radians() - chord).tan());
        intervals.push(row(u, v, [(s1 + s2) / (length * length), -(2.0 * s1 + s2) / length], length));
    }
    intervals.push(row(last[0], last[1], [0.0; 2], extension));
    Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals,
        last: ahead(last, extension),
    }))
}

/// Round to the left and drawn out to a tip at the right, where the extensions would meet a hundredth farther on.
fn drop_shape() -> Geometry {
    let to_tip = 0.8 / 10f64.to_radians().sin();
    table_through(&[[1.0, 0.8, 170.0], [-2.0, 0.0, 270.0], [1.0, -0.8, 10.0]], 0.99 * to_tip)
}

/// All but a circle, that ends where it begins.
fn ring() -> Geometry {
    let quarter = |k: f64| {
        let (sine, cosine) = (90.0 * k).to_radians().sin_cos();
        [2.0 * cosine, 2.0 * sine, 90.0 * (k + 1.0)]
    };
    table_through(&[0.0, 1.0, 2.0, 3.0, 4.0].map(quarter), 10.0)
}

fn loops() -> Vec<Loop> {
    let floor = || plane(0.0, 0.0, 1.0, 0.0);
    let oval = quadric([1.0 / 9.0, 0.25, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let (outside, inside) = (v(-5.0, -0.2, 0.0), v(-1.0, -0.2, 0.0));
    let new = |name, drive, part, from, side, iterate| Loop { name, drive, part, from, side, iterate };
    vec![
        new("circle", circle(0.0, 0.0, 2.0), floor(), outside, DriveSide::Left, false),
        new("circle, iterated", circle(0.0, 0.0, 2.0), floor(), outside, DriveSide::Left, true),
        new("inside a circle", circle(0.0, 0.0, 2.0), floor(), inside, DriveSide::Right, true),
        new("ellipse", oval.clone(), floor(), outside, DriveSide::Left, false),
        new("inside an ellipse", oval, floor(), inside, DriveSide::Right, false),
        new(
            "sphere on a slope",
            sphere(0.0, 0.0, 0.0, 2.5),
            plane(-0.2, 0.0, 1.0, 0.0),
            outside,
            DriveSide::Left,
            false,
        ),
        new(
            "cone",
            cone(v(0.0, 0.0, 6.0), v(0.0, 0.0, -1.0), 20.0),
            floor(),
            outside,
            DriveSide::Left,
            false,
        ),
        new(
            "cylinder through a slope",
            cylinder(v(0.0, 0.0, 0.0), v(0.2, 0.0, 1.0), 2.0),
            floor(),
            outside,
            DriveSide::Left,
            false,
        ),
        new("drop", drop_shape(), floor(), outside, DriveSide::Left, false),
        new("ring", ring(), floor(), outside, DriveSide::Left, false),
        new("inside a ring", ring(), floor(), inside, DriveSide::Right, false),
    ]
}

impl Loop {
    /// Standing at the start of the path.
    fn program(&self) -> Program {
        let mut p = Program::new();
        p.tolerance(BAND, BAND).cutter(&[2.0 * RADIUS]).from(self.from.x, self.from.y, self.from.z + 0.5);
        p.run(&MotionCommand::MaximumPoints(4000)).run(&MotionCommand::ForceIteration(self.iterate));
        p.go(&[(Relation::To, &self.drive), (Relation::To, &self.part)]);
        p.side(self.side).indirv(0.0, 1.0, 0.0);
        p
    }

    fn motion(&self, checks: &[(Relation, u32, &Geometry)]) -> MotionCommand {
        motion(Turn::Forward, &self.drive, checks)
    }

    /// Carries a motion out; its end, the last vector and the length of the path.
    fn end(&self, checks: &[(Relation, u32, &Geometry)]) -> (Vec3, Vec3, f64, usize) {
        let mut p = self.program();
        p.run(&self.motion(checks)).verified();
        let last = p.last();
        let mut tips = vec![last.start.tip];
        tips.extend(last.points.iter().map(|point| point.tip));
        let length = tips.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        let [.., before, end] = tips[..] else { panic!("{}: no vector", self.name) };
        (end, end - before, length, last.stop.as_ref().expect("a stop").index)
    }
}

#[test]
fn every_count_of_every_relation_is_found_over_several_turns() {
    let wall = plane(1.0, 0.0, 0.0, AT);
    for path in loops() {
        for relation in [Relation::On, Relation::To, Relation::Past] {
            let ends: Vec<_> = (1..=5).map(|count| path.end(&[(relation, count, &wall)])).collect();
            for (k, (end, last, length, _)) in ends.iter().enumerate() {
                let told = format!("{}, {relation:?}, {}: {end:?}", path.name, k + 1);
                // Before the plane, on it, or behind it, seen along the motion.
                let ahead = (end.x - AT) * last.x.signum();
                let expected = match relation {
                    Relation::On => 0.0,
                    Relation::To => -RADIUS,
                    _ => RADIUS,
                };
                assert!((ahead - expected).abs() < 1e-6, "{told}");
                let sense = if k % 2 == 0 { 1.0 } else { -1.0 };
                assert!(sense * last.x * ends[0].1.x > 0.0, "{told}: there and back in turn");
                // The same place a turn later.
                if let Some((again, _, later, _)) = ends.get(k + 2) {
                    assert!((again - end).norm() < 4.0 * BAND, "{told}, and {again:?}");
                    let turn = ends[2].2 - ends[0].2;
                    assert!(
                        turn > 8.0 && (later - length - turn).abs() < 0.05,
                        "{told}: {turn} {later} {length}"
                    );
                }
            }
        }
    }
}

#[test]
fn of_several_check_surfaces_the_first_that_is_met_stops_the_motion() {
    let walls = [plane(1.0, 0.0, 0.0, AT), plane(0.0, 1.0, 0.0, -0.4)];
    for path in loops() {
        for counts in [[1, 1], [2, 1], [3, 2], [2, 4]] {
            for relations in [[Relation::On, Relation::On], [Relation::Past, Relation::To]] {
                let checks = [0, 1].map(|k| (relations[k], counts[k], &walls[k]));
                let alone = checks.map(|check| path.end(&[check]));
                let (end, _, length, index) = path.end(&checks);
                let first = usize::from(alone[1].2 < alone[0].2);
                let told = format!("{}, {counts:?}, {relations:?}", path.name);
                assert_eq!(index, first, "{told}: {} and {}", alone[0].2, alone[1].2);
                // In closed form, which is for one check surface, motions end elsewhere in the band.
                assert!((end - alone[first].0).norm() < 2.0 * BAND, "{told}: {end:?}");
                assert!((length - alone[first].2).abs() < 0.05, "{told}: {length}");
            }
        }
        // The same one twice: the one that is named first.
        assert_eq!(path.end(&[(Relation::On, 1, &walls[0]), (Relation::On, 1, &walls[0])]).3, 0);
    }
}

#[test]
fn a_check_surface_that_a_closed_path_never_meets_is_told_with_the_length_of_a_turn() {
    let (near, far) = (plane(1.0, 0.0, 0.0, AT), plane(1.0, 0.0, 0.0, 30.0));
    for path in loops() {
        let lengths = [1, 3].map(|count| path.end(&[(Relation::On, count, &near)]).2);
        let failure =
            path.program().attempt(&path.motion(&[(Relation::On, 1, &far)])).expect_err("never met");
        match failure {
            MotionFailure::NeverMet { nearest, at, course, .. } => {
                assert!((30.0 - at.x - nearest).abs() < 0.1, "{}: {nearest} at {at:?}", path.name);
                match course {
                    Course::Closed { length } => {
                        let turn = lengths[1] - lengths[0];
                        assert!((length - turn).abs() < 0.2 * turn, "{}: {length} {turn}", path.name);
                    }
                    Course::Analytic => assert!(!path.iterate && path.name == "circle", "{}", path.name),
                    Course::Parallel | Course::Concentric | Course::Away { .. } => {
                        panic!("{}: {course:?}", path.name)
                    }
                }
            }
            other => panic!("{}: {other:?}", path.name),
        }
    }
}

#[test]
fn a_tangency_comes_once_in_every_turn() {
    let top = line(-9.0, 2.0, 9.0, 2.0);
    for path in loops().into_iter().filter(|path| path.name.starts_with("circle")) {
        let ends = [1, 2, 3].map(|count| path.end(&[(Relation::TangentToDrive, count, &top)]));
        for (end, ..) in &ends {
            assert!((end - v(0.0, 2.0 + RADIUS, 0.0)).norm() < 0.1, "{}: {end:?}", path.name);
            assert!((end.y - 2.0 - RADIUS).abs() < 2.0 * BAND, "{}: {end:?}", path.name);
        }
        let turn = std::f64::consts::TAU * (2.0 + RADIUS);
        assert!((ends[1].2 - ends[0].2 - turn).abs() < 0.1 && (ends[2].2 - ends[1].2 - turn).abs() < 0.1);
    }
}

#[test]
fn a_check_surface_that_is_never_met_is_told_before_many_vectors_are_made() {
    let (near, far) = (plane(1.0, 0.0, 0.0, AT), plane(1.0, 0.0, 0.0, 30.0));
    for path in loops().into_iter().filter(|path| path.iterate || path.name.contains("slope")) {
        let cost = |checks: &[(Relation, u32, &Geometry)]| {
            let mut p = path.program();
            p.run(&MotionCommand::MaximumStep(0.02));
            let before = EVALUATIONS.get();
            let made = p.attempt(&path.motion(checks)).map(|_| p.last().points.len());
            (EVALUATIONS.get() - before, made)
        };
        let (whole, made) = cost(&[(Relation::On, 2, &near)]);
        assert!(made.is_ok_and(|vectors| vectors > 200), "{}", path.name);
        let (lost, failure) = cost(&[(Relation::On, 1, &far)]);
        assert!(matches!(failure, Err(MotionFailure::NeverMet { .. })), "{}: {failure:?}", path.name);
        assert!(2 * lost < whole, "{}: {lost} clearances, and {whole} for the motion", path.name);
    }
}

/// A closed path that begins just before a corner: the vector that comes by there again leads round the corner.
#[test]
fn a_closed_path_that_begins_just_before_a_corner_is_told_as_closed() {
    let axis = v(-0.40317970207932163, 0.48902551056524585, 0.7734986605338304);
    let across = v(0.6225244558415225, -0.4729693164269667, 0.6235088833351328);
    let circle = |point: Vec3, radius: f64| Geometry::Cylinder(Cylinder { point, axis, radius });
    let upright = |point: Vec3, radius: f64| Geometry::Cylinder(Cylinder { point, axis: Vec3::z(), radius });
    let parts = vec![
        circle(v(-8.076577819251057, 6.763624649828748, -3.1009239860265003), 9.965214786005511),
        Geometry::Point(v(-3.868154378494525, -1.951962158907147, 0.7244157967774689)),
        Geometry::Point(v(1.4978686834637926, 3.9113015096515635, -0.18549389736307154)),
        Geometry::Vector(across),
        circle(v(0.5747427876321312, 0.19069541751962626, 5.564077365093378), 6.22516191069994),
        Geometry::Point(v(-6.287232590970456, 0.9821909044843287, 5.365407759980453)),
        Geometry::Point(v(-0.921209529012138, 6.845454573043039, 4.455498065839912)),
        Geometry::Vector(-across),
    ];
    let first = v(0.06684034618414801, -0.9332548488046197, -0.35294157491665656);
    let motion = Found {
        cutter: &[0.8496348961938025, 0.42481744809690125],
        axis: v(-0.6288020626260622, 0.6688836928633426, 0.3964877948420449),
        from: v(-3.144446741764784, 1.090909034209761, 0.2237065847690797),
        band: [0.01, 0.005],
        thickness: 0.07945789194168443,
        drive_side: DriveSide::Left,
        forward: -first,
        part: (Relation::To, upright(v(-5.3233498054700465, 0.8139187283003739, 0.0), 3.7649623346183407)),
        drive: (Relation::To, Geometry::RuledSurface(Remembering::new(RuledSurface { parts }))),
        first: (Relation::On, Geometry::Plane(Plane { normal: first, distance: -1.1453475359336744 })),
        stop: (Relation::Past, upright(v(-1.6205709274013484, -5.242149193315278, 0.0), 7.939600724196356)),
    };
    let refused = motion.run(AMPLE);
    let Err(MotionFailure::NeverMet { course: Course::Closed { length }, .. }) = refused else {
        panic!("{refused:?}")
    };
    assert!((length - 15.0).abs() < 3.0, "{length}");
}
