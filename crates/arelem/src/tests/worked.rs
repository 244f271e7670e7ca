//! Worked cases of the reference that need a motion.

use DriveSide::{Left, On as TlOn, Right};
use Relation::{On, Past, TangentToDrive as Tanto, To};
use Turn::{Forward, Left as GoLft, Right as GoRgt};

use super::*;
use crate::{
    attitude::Attitude,
    position::{self, Condition},
};

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1.1e-9, "found {found}, expected {expected}");
}

fn surface(geometry: &Geometry) -> apt_geometry::surface::Surface {
    apt_geometry::surface::Surface::from_geometry(geometry).expect("surface")
}

#[test]
fn w21_curvature_of_a_circle() {
    let circle = surface(&circle(0.0, 0.0, 3.0));
    let (sine, cosine) = 0.4_f64.sin_cos();
    let (foot, second) = circle.foot_and_hessian(&(v(cosine, sine, 0.0) * 3.0));
    let tangent = v(-sine, cosine, 0.0);
    let radius = 1.0 / tangent.dot(&(second * tangent));
    near(radius, 3.0);
    near((foot.point - foot.normal * radius).norm(), 0.0);
}

#[test]
fn w24_admissible_lengths() {
    for (radius, length) in [(2.501, 0.141435498), (1.5, 0.109526253)] {
        let ring = crate::bound::Ring {
            center: Vec3::zeros(),
            axis: Vec3::z(),
            inner: radius - 0.001,
            outer: radius,
        };
        near(ring.longest_chord(), length);
    }
}

#[test]
fn w25_worst_point_of_a_chord() {
    let circle = surface(&circle(0.0, 0.0, 2.5));
    let at = |angle: f64| v(angle.cos(), angle.sin(), 0.0) * 2.5009;
    let (from, to) = (at(0.0), at(0.0565));
    let depth = |share: f64| circle.signed_distance(&(from + (to - from) * share));
    let worst = (0..=1000).map(|step| depth(f64::from(step) / 1000.0)).fold(f64::INFINITY, f64::min);
    near(worst, -0.000097871);
}

#[test]
fn w26_distance_to_the_check_surface_along_the_path() {
    let (normal, along) = (v(1.0, 0.0, 0.1).normalize(), v(1.0, 0.2, 0.0).normalize());
    let tangent_plane = surface(&plane(normal.x, normal.y, normal.z, 1.0));
    let ahead = apt_geometry::surface::RootSelection::Ahead;
    near(tangent_plane.directed_distance(&Vec3::zeros(), &along, ahead).expect("a distance"), 1.024890238);
}

#[test]
fn w22_three_surfaces() {
    let tool =
        Tool::new(apt_geometry::cutter::Cutter::from_numbers(&[0.5, 0.25], 1.0).expect("cutter"), Vec3::z());
    let gauge = |geometry: Geometry, on: bool| Gauge {
        surface: surface(&geometry),
        on,
        side: 1.0,
        thickness: 0.0,
        disk: None,
        memory: Memory::default(),
    };
    let part = gauge(sphere(0.0, 0.0, 0.0, 2.0), false);
    let drive = gauge(cylinder(Vec3::zeros(), Vec3::z(), 0.8), false);
    let check = gauge(plane(1.0, 0.0, 0.0, 0.3), true);
    let conditions = [
        Condition::Clearance(&part, 0.0),
        Condition::Clearance(&drive, 0.0),
        Condition::Clearance(&check, 0.0),
    ];
    let tip = position::solve(&Attitude::fixed(tool.clone()), &conditions, &v(0.5, 1.2, 2.5))
        .expect("a position")
        .tip;
    near(tip.x, 0.3);
    near(tip.y, 1.006230590);
    near(tip.z, 1.739974874);
}

#[test]
fn w23_tangent_check() {
    let l1 = line(0.0, 0.0, 5.0, 0.0);
    for iterate in [false, true] {
        let mut p = Program::new();
        p.cutter(&[0.5]).run(&MotionCommand::ForceIteration(iterate)).from(-1.0, -1.0, 0.0);
        p.go(&[(To, &l1), (To, &ground())]).side(Right);
        p.drive(GoRgt, &l1, Tanto, &circle(2.0, 1.0, 1.0));
        near(p.tip().x, 2.0);
        near(p.tip().y, -0.25);
    }
}

#[test]
fn w31_two_dimensional_stops() {
    let (l1, c1) = (line(0.0, 0.0, 5.0, 0.0), circle(3.0, 0.0, 1.0));
    for (relation, occurrence, x) in [
        (To, 1, 1.775255129),
        (On, 1, 2.031754163),
        (Past, 1, 2.292893219),
        (To, 2, 3.707106781),
        (Past, 2, 4.224744871),
    ] {
        for iterate in [false, true] {
            let mut p = Program::new();
            p.cutter(&[0.5]).run(&MotionCommand::ForceIteration(iterate)).from(0.0, -1.0, 0.0);
            p.go(&[(To, &l1), (To, &ground())]).side(Right);
            p.run(&motion(GoRgt, &l1, &[(relation, occurrence, &c1)]));
            if iterate {
                p.ends(x, -0.25, 0.0, 5.1e-4);
            } else {
                near(p.tip().x, x);
            }
        }
    }
}

#[test]
fn w32_turns() {
    for (turn, direction) in [(GoRgt, -Vec3::y()), (GoLft, Vec3::y()), (Turn::Up, Vec3::z())] {
        let mut p = Program::new();
        p.cutter(&[0.5]).from(0.0, 0.0, 0.0).indirv(1.0, 0.0, 0.0).part_side(PartSide::On).side(TlOn);
        let (part, drive) = if turn == Turn::Up {
            (plane(1.0, 0.0, 0.0, 0.0), plane(0.0, 1.0, 0.0, 0.0))
        } else {
            (ground(), plane(1.0, 0.0, 0.0, 0.0))
        };
        p.run(&MotionCommand::PartSurface(named(&part)));
        let end = plane(direction.x, direction.y, direction.z, 2.0);
        p.drive(turn, &drive, On, &end);
        near((p.tip() - direction * 2.0).norm(), 0.0);
        near((p.last().forward - direction).norm(), 0.0);
    }
}

#[test]
fn w33_start_on_a_cone() {
    let cn = cone(v(0.0, 0.0, 3.0), -Vec3::z(), 30.0);
    let tool =
        Tool::new(apt_geometry::cutter::Cutter::from_numbers(&[0.5, 0.25], 1.0).expect("cutter"), Vec3::z());
    let gauge = |geometry: &Geometry| Gauge {
        surface: surface(geometry),
        on: false,
        side: 1.0,
        thickness: 0.0,
        disk: None,
        memory: Memory::default(),
    };
    let (drive, part) = (gauge(&cn), gauge(&ground()));
    for (aim, expected) in [(0.0, 1.876388375), (0.0009, 1.877427605)] {
        let conditions = [Condition::Clearance(&drive, aim), Condition::Clearance(&part, 0.0)];
        near(
            position::solve(&Attitude::fixed(tool.clone()), &conditions, &v(4.0, 0.0, 1.0))
                .expect("a position")
                .tip
                .x,
            expected,
        );
    }
    let mut p = Program::new();
    p.tolerance(0.0, 0.001)
        .cutter(&[0.5, 0.25])
        .from(4.0, 0.0, 1.0)
        .go(&[(To, &cn), (To, &ground())])
        .verified();
}

#[test]
fn w34_start_on_a_circle() {
    let c1 = circle(0.0, 0.0, 2.0);
    for (x, ends) in [(4.0, [2.25, 2.0, 1.75]), (0.5, [1.75, 2.0, 2.25])] {
        for (relation, end) in [To, On, Past].into_iter().zip(ends) {
            let mut p = Program::new();
            p.cutter(&[0.5]).from(x, 0.0, 0.0).go(&[(relation, &c1)]);
            near(p.tip().x, end);
        }
    }
}

/// Number of vectors and bound of the last motion.
fn counts(p: &Program) -> (u32, u32) {
    (p.last().points.len() as u32, p.last().minimum.expect("a bound"))
}

#[test]
fn fewest_vectors_on_circles() {
    // Tool .5: circle paths of radius R ± .25.
    for (radius, outside, tolerance) in [
        (2.25, true, 1e-3),
        (1.75, false, 1e-3),
        (2.25, true, 1e-4),
        (2.25, true, 1e-2),
        (504.75, true, 1e-2),
        (5004.75, true, 1e-2),
    ] {
        for iterate in [false, true] {
            let c1 = circle(0.0, 0.0, radius);
            let mut p = Program::new();
            p.tolerance(0.0, tolerance).cutter(&[0.5]).run(&MotionCommand::ForceIteration(iterate));
            p.run(&MotionCommand::MaximumPoints(5000)).run(&MotionCommand::MaximumStep(1000.0));
            if outside {
                p.from(radius + 1.0, 0.0, 0.0).go(&[(To, &c1)]).side(Right);
            } else {
                p.from(radius - 1.0, 0.0, 0.0).go(&[(To, &c1)]).side(Left);
            }
            p.drive(GoLft, &c1, On, &line(0.0, 0.0, 0.0, 1.0)).verified();
            let (count, least) = counts(&p);
            assert!(
                count <= least + 1,
                "radius {radius}, {tolerance}, iterate {iterate}: {count} over {least}"
            );
        }
    }
}

#[test]
fn fewest_vectors_in_space() {
    let ball = [0.5, 0.25];
    // Ball over a sphere, through the centre and beside it.
    for away in [0.0, 0.8] {
        let (part, drive) = (sphere(0.0, 0.0, 0.0, 2.0), plane(0.0, 1.0, 0.0, away));
        let mut p = Program::new();
        p.tolerance(0.0, 1e-3).cutter(&ball).from(-1.5, away, 4.0);
        p.go(&[(On, &drive), (To, &part), (On, &plane(1.0, 0.0, 0.0, -1.2))]).side(TlOn);
        p.drive(Forward, &drive, On, &plane(1.0, 0.0, 0.0, 1.2)).verified();
        let (count, least) = counts(&p);
        assert!(count <= least + 1, "sphere at {away}: {count} over {least}");
    }
    // Ball round a cone at constant height.
    let cn = cone(v(0.0, 0.0, 3.0), -Vec3::z(), 30.0);
    let mut p = Program::new();
    p.tolerance(0.0, 1e-3).cutter(&ball).from(4.0, 0.0, 1.0).go(&[(To, &cn), (To, &ground())]).side(Right);
    p.drive(GoLft, &cn, On, &plane(1.0, 0.0, 0.0, 0.0)).verified();
    assert!(p.last().points.len() <= 24, "{}", p.last().points.len());
    // Ball on a lying cylinder in a plane at 45°.
    let (part, drive) = (cylinder(Vec3::zeros(), Vec3::x(), 1.0), plane(1.0, -1.0, 0.0, 0.0));
    let mut p = Program::new();
    p.tolerance(0.0, 1e-3).cutter(&ball).from(-1.2, -1.2, 3.0);
    p.go(&[(On, &drive), (To, &part), (On, &plane(0.0, 1.0, 0.0, -0.9))]).side(TlOn);
    p.drive(Forward, &drive, On, &plane(0.0, 1.0, 0.0, 0.9)).verified();
    let (count, least) = counts(&p);
    assert!(count <= least + 1 && count <= 22, "{count} over {least}");
    // Along a ruling one vector does.
    let drive = plane(0.0, 1.0, 0.0, 0.5);
    let mut p = Program::new();
    p.tolerance(0.0, 1e-3).cutter(&ball).from(-3.0, 0.5, 3.0);
    p.go(&[(On, &drive), (To, &cylinder(Vec3::zeros(), Vec3::x(), 1.0)), (On, &plane(1.0, 0.0, 0.0, -2.0))]);
    p.side(TlOn).drive(Forward, &drive, On, &plane(1.0, 0.0, 0.0, 2.0)).verified();
    assert_eq!(p.last().points.len(), 1);
}

#[test]
fn several_check_surfaces() {
    let (drive, far, near_by) = (plane(0.0, 1.0, 0.0, 0.0), plane(1.0, 0.0, 0.0, 9.0), circle(5.0, 0.0, 1.0));
    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 1.0, 0.0).go(&[(To, &drive)]).side(Left).indirv(1.0, 0.0, 0.0);
    p.run(&motion(Forward, &drive, &[(To, 1, &far), (To, 1, &near_by)]));
    assert_eq!(p.last().stop.as_ref().map(|s| s.index), Some(1));
    p.ends(5.0 - (1.25f64 * 1.25 - 0.0625).sqrt(), 0.25, 0.0, 5.1e-4).verified();
}

#[test]
fn cancelling_changes_nothing() {
    let mut p = Program::new();
    p.cutter(&[0.5, 0.25]).from(-3.0, 0.0, 7.0);
    let command = start(&[(On, &plane(0.0, 1.0, 0.0, 1.0)), (To, &sphere(0.0, 0.0, 0.0, 5.0))]);
    let execution = execute(&p.state, &command, &|| true);
    assert_eq!(execution.failure, Some(MotionFailure::Cancelled));
    assert_eq!(execution.state, p.state);
}

/// Operation 2 of AREPRE: the last move counts but where it is parallel to the axis, then the move before it.
#[test]
fn a_steep_move_says_which_way_is_left() {
    let (rail, left_end, right_end) = (x(5.0), y(-3.0), y(3.0));
    let steps = |steps: &[(f64, f64, f64)]| {
        let mut p = Program::new();
        p.cutter(&[0.0]).tolerance(0.0, 0.001).from(4.0, 0.5, 2.0);
        for &(x, y, z) in steps {
            p.run(&MotionCommand::GoTo { position: v(x, y, z), axis: None, name: String::new() });
        }
        p.run(&MotionCommand::PartSurface(named(&ground()))).side(DriveSide::On);
        p
    };
    // Half a degree from the axis, towards smaller x: left is towards smaller y, though the move before went to larger x.
    let mut steep = steps(&[(5.01, 0.0, 1.0), (5.0, 0.0, 0.0)]);
    steep.drive(Turn::Left, &rail, Relation::On, &left_end).ends(5.0, -3.0, 0.0, 1e-9).verified();
    // Along the axis: the move before it, towards larger x, and left is towards larger y.
    let mut along = steps(&[(4.0, 0.0, 1.0), (5.0, 0.0, 1.0), (5.0, 0.0, 0.0)]);
    along.drive(Turn::Left, &rail, Relation::On, &right_end).ends(5.0, 3.0, 0.0, 1e-9).verified();
}
