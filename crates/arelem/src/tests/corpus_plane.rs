//! Programs of the two-dimensional corpus: ends agree to the figures printed there.

use DriveSide::{Left, On as TlOn, Right};
use Relation::{On, Past, TangentToDrive as Tanto, To};
use Turn::{Back, Forward, Left as GoLft, Right as GoRgt};

use super::*;

/// The corpus prints seven digits.
const EXACT: f64 = 2e-6;

fn x_axis() -> Geometry {
    line(0.0, 0.0, 1.0, 0.0)
}

fn y_axis() -> Geometry {
    line(0.0, 0.0, 0.0, 1.0)
}

#[test]
fn calc_2d_and_3d() {
    let (l1, c1, ps, l2) = (x_axis(), circle(4.0, 2.0, 2.0), ground(), line(0.0, 2.0, 9.0, 2.0));
    for iterate in [false, true] {
        let mut p = Program::new();
        p.cutter(&[0.5]).run(&MotionCommand::ForceIteration(iterate)).from(-1.0, -1.0, 1.0);
        p.go(&[(To, &l1), (To, &ps), (On, &y_axis())]).ends(0.0, -0.25, 0.0, EXACT);
        p.side(Right).drive(GoRgt, &l1, Tanto, &c1).ends(4.0, -0.25, 0.0, EXACT);
        p.drive(Forward, &c1, On, &l2).ends(6.25, 2.0, 0.0, if iterate { 5.1e-4 } else { EXACT });
        p.verified();
    }
}

#[test]
fn circle_full_outside() {
    let mut p = Program::new();
    p.cutter(&[0.5]).from(5.0, 0.0, 1.0).go(&[(To, &circle(0.0, 0.0, 2.0))]).ends(2.25, 0.0, 0.0, EXACT);
    let full = motion(GoLft, &circle(0.0, 0.0, 2.0), &[(On, 2, &x_axis())]);
    p.side(Left).run(&full).ends(2.25, 0.0, 0.0, EXACT).verified();
    // The start lies in the middle of the ring, the peer needs 151 vectors.
    assert!(
        p.last().points.len() <= 151 && Some(p.last().points.len() as u32) <= p.last().minimum.map(|m| m + 1)
    );
}

#[test]
fn circle_half_turns() {
    let (c1, l1) = (circle(0.0, 0.0, 2.0), line(-5.0, 0.5, 5.0, 0.5));
    let mut p = Program::new();
    p.cutter(&[0.5]).from(3.0, -2.0, 0.0).go(&[(To, &c1)]).ends(1.872113, -1.248075, 0.0, EXACT);
    p.side(Right).drive(GoRgt, &c1, On, &l1).ends(2.193741, 0.5, 0.0, EXACT);
    p.run(&motion(Forward, &c1, &[(On, 2, &l1)])).ends(2.193741, 0.5, 0.0, EXACT).verified();
    assert!(p.last().points.len() > 100, "a full turn");
}

#[test]
fn circle_tolerances() {
    for (inside, outside) in [(1e-4, 1e-4), (0.01, 0.0), (0.0, 0.01)] {
        let mut p = Program::new();
        p.tolerance(inside, outside).cutter(&[0.5]).from(5.0, 0.0, 0.0);
        p.go(&[(To, &circle(0.0, 0.0, 2.0))]).ends(2.25, 0.0, 0.0, EXACT);
        p.side(Left)
            .drive(GoLft, &circle(0.0, 0.0, 2.0), On, &y_axis())
            .ends(0.0, -2.25, 0.0, EXACT)
            .verified();
        assert!(p.last().points.len() as u32 <= p.last().minimum.expect("a ring") + 1);
    }
}

#[test]
fn circle_to_circle_corner() {
    let (c1, c2) = (circle(0.0, 0.0, 2.0), circle(3.0, 0.0, 2.0));
    let mut p = Program::new();
    p.tolerance(0.002, 0.002).cutter(&[0.5]).from(-4.0, 3.0, 0.0);
    p.go(&[(To, &c1), (To, &ground()), (On, &line(-1.0, -5.0, -1.0, 5.0))])
        .ends(-1.0, 2.017352, 0.0, 0.00201);
    p.side(Left).drive(GoLft, &c1, To, &c2).ends(1.501201, 1.678125, 0.0, 0.00201);
    p.drive(GoLft, &c2, On, &line(3.0, 0.0, 3.0, 5.0)).ends(3.0, 2.25, 0.0, 0.00201).verified();
}

#[test]
fn chain_of_lines() {
    let (l1, l2, l3) = (x_axis(), line(3.0, 0.0, 3.0, 4.0), line(0.0, 3.0, 5.0, 3.0));
    let mut p = Program::new();
    p.cutter(&[0.25]).from(-1.0, -1.0, 1.0);
    p.go(&[(To, &l1), (To, &plane(0.0, 0.0, 1.0, -0.1)), (On, &line(-1.0, 0.0, -1.0, 1.0))]);
    p.ends(-1.0, -0.125, -0.1, EXACT);
    p.side(Right).drive(GoRgt, &l1, Past, &l2).ends(3.125, -0.125, -0.1, EXACT);
    p.drive(GoLft, &l2, Past, &l3).ends(3.125, 3.125, -0.1, EXACT);
    p.drive(GoLft, &l3, On, &y_axis()).ends(0.0, 3.125, -0.1, EXACT);
    p.side(Left).drive(Back, &l3, On, &line(1.0, 0.0, 1.0, 1.0)).ends(1.0, 3.125, -0.1, EXACT).verified();
    assert!(p.warnings.is_empty(), "{:?}", p.warnings);
    assert!(p.sequences.iter().all(|s| s.points.len() == 1));
}

#[test]
fn tangent_chain() {
    let (l1, c1, l2) = (line(0.0, 0.0, 5.0, 0.0), circle(5.0, 2.0, 2.0), line(0.0, 4.0, 5.0, 4.0));
    let mut p = Program::new();
    p.cutter(&[0.5]).from(-1.0, -1.0, 1.0);
    p.go(&[(To, &l1), (To, &ground()), (On, &y_axis())]).side(Right);
    p.drive(GoRgt, &l1, Tanto, &c1).ends(5.0, -0.25, 0.0, EXACT);
    p.drive(Forward, &c1, Tanto, &l2).ends(5.0, 4.25, 0.0, EXACT);
    p.drive(Forward, &l2, On, &y_axis()).ends(0.0, 4.25, 0.0, EXACT).verified();
}

#[test]
fn start_ups() {
    let wall = line(3.0, 0.0, 3.0, 5.0);
    let floor = plane(0.0, 0.0, 1.0, 0.5);
    for (relations, end) in [
        ((To, To), (2.5, 2.0, 0.5)),
        ((On, To), (3.0, 2.0, 0.5)),
        ((Past, To), (3.5, 2.0, 0.5)),
        ((Past, On), (3.5, 2.0, 0.5)),
    ] {
        let mut p = Program::new();
        p.cutter(&[1.0]).from(0.0, 2.0, 3.0);
        p.go(&[(relations.0, &wall), (relations.1, &floor)]).ends(end.0, end.1, end.2, EXACT).verified();
    }
    let cross = line(0.0, 4.0, 5.0, 4.0);
    for (relations, end) in
        [((To, To), (2.5, 3.5, 0.5)), ((To, Past), (2.5, 4.5, 0.5)), ((On, Past), (3.0, 4.5, 0.5))]
    {
        let mut p = Program::new();
        p.cutter(&[1.0]).from(0.0, 1.0, 3.0);
        p.go(&[(relations.0, &wall), (To, &floor), (relations.1, &cross)]).ends(end.0, end.1, end.2, EXACT);
    }
    let mut p = Program::new();
    p.cutter(&[1.0]).from(0.0, 1.0, 3.0);
    p.go(&[(On, &line(3.0, 0.0, 4.0, 5.0)), (On, &floor), (On, &line(0.0, 4.0, 5.0, 3.0))]);
    p.ends(3.653846, 3.269231, 0.5, EXACT);
}

#[test]
fn start_on_circles() {
    let outside = circle(3.0, 3.0, 1.5);
    for (relation, x, y) in [(To, 1.6, 1.95), (On, 1.8, 2.1), (Past, 2.0, 2.25)] {
        let mut p = Program::new();
        p.cutter(&[0.5]).from(-1.0, 0.0, 0.0).go(&[(relation, &outside)]).ends(x, y, 0.0, EXACT);
        let mut p = Program::new();
        p.cutter(&[0.5]).from(-1.0, 0.0, 0.0);
        p.run(&MotionCommand::Direction([Some(Direction::Point(v(3.0, 3.0, 0.0))), None, None]));
        p.go(&[(relation, &outside)]).ends(x, y, 0.0, EXACT);
    }
    let inside = circle(3.0, 3.0, 2.0);
    for (relation, x, y) in [(To, 4.565248, 3.782624), (On, 4.788854, 3.894427), (Past, 5.012461, 4.006231)] {
        let mut p = Program::new();
        p.cutter(&[0.5]).from(3.5, 3.25, 0.0).go(&[(relation, &inside)]).ends(x, y, 0.0, EXACT);
    }
}

#[test]
fn start_without_part_and_with_surface_vectors() {
    let wall = line(3.0, 0.0, 3.0, 5.0);
    let mut p = Program::new();
    p.cutter(&[1.0]).from(0.0, 2.0, 3.0).run(&MotionCommand::NoPartSurface);
    p.go(&[(To, &wall)]).ends(2.5, 2.0, 3.0, EXACT);
    for (relation, x) in [(To, 2.5), (Past, 3.5)] {
        let mut p = Program::new();
        p.cutter(&[1.0]).from(3.0, 1.0, 2.0);
        p.run(&MotionCommand::SurfaceVectors([Some(Vec3::x()), None, None]));
        p.go(&[(relation, &wall), (To, &ground())]).ends(x, 1.0, 0.0, EXACT);
    }
}

#[test]
fn offset_start() {
    let mut p = Program::new();
    p.cutter(&[1.0]).from(0.0, 1.0, 2.0).indirv(1.0, 0.5, 0.0);
    let wall = line(4.0, 0.0, 5.0, 5.0);
    let MotionCommand::Start(surfaces) = start(&[(To, &wall), (To, &ground())]) else { panic!("a start") };
    p.run(&MotionCommand::Offset(surfaces)).ends(4.176376, 3.431391, 0.0, EXACT);
}

#[test]
fn offset_start_with_a_tilted_axis() {
    let wall = line(4.0, 0.0, 5.0, 5.0);
    let MotionCommand::Start(surfaces) = start(&[(To, &wall), (To, &ground())]) else { panic!("a start") };
    for axis in [v(0.0, 0.2, 1.0), v(0.3, -0.1, 1.0), v(-0.4, 0.2, 1.0)] {
        let mut p = Program::new();
        p.cutter(&[1.0]).run(&MotionCommand::ToolAxis(apt_geometry::motion::ToolAxis::Fixed(axis)));
        p.from(0.0, 1.0, 2.0).indirv(1.0, 0.5, 0.0).run(&MotionCommand::Offset(surfaces.clone())).verified();
    }
}

#[test]
fn corners_and_sides() {
    let (l1, l2) = (x_axis(), line(5.0, 0.0, 3.0, 2.0));
    let mut p = Program::new();
    p.cutter(&[0.5]).from(1.0, -2.0, 0.0).go(&[(To, &l1), (To, &ground()), (On, &line(1.0, 0.0, 1.0, 1.0))]);
    p.side(Right).drive(GoRgt, &l1, Past, &l2).ends(5.603553, -0.25, 0.0, EXACT);
    p.drive(GoLft, &l2, On, &line(0.0, 2.0, 5.0, 2.0)).ends(3.353553, 2.0, 0.0, EXACT).verified();

    let (l1, l2) = (line(0.0, 0.0, 4.0, 1.0), line(4.0, 0.0, 5.0, 5.0));
    let mut p = Program::new();
    p.cutter(&[0.5]).from(-1.0, -1.0, 0.0).go(&[(On, &y_axis()), (To, &ground()), (On, &l1)]);
    p.ends(0.0, 0.0, 0.0, EXACT).side(TlOn).drive(GoRgt, &l1, On, &l2).ends(4.210526, 1.052632, 0.0, EXACT);
    p.drive(GoLft, &l2, On, &line(0.0, 5.0, 6.0, 4.0)).ends(4.83871, 4.193548, 0.0, EXACT).verified();
}

#[test]
fn thickness_on_drive_and_check() {
    let (l1, l2) = (x_axis(), line(5.0, 0.0, 5.0, 5.0));
    let mut p = Program::new();
    p.cutter(&[0.5]).from(1.0, 2.0, 1.0);
    p.run(&MotionCommand::Thickness(PerRole { part: 0.0, drive: 0.1, check: [0.1, 0.1] }));
    p.go(&[(To, &l1), (To, &ground()), (On, &line(1.0, 0.0, 1.0, 5.0))]).ends(1.0, 0.35, 0.0, EXACT);
    p.side(Left).drive(GoLft, &l1, To, &l2).ends(4.65, 0.35, 0.0, EXACT);
    p.drive(GoLft, &l2, On, &line(0.0, 4.0, 5.0, 4.0)).ends(4.65, 4.0, 0.0, EXACT).verified();
}

#[test]
fn conics_inside() {
    // x² = 4y from the corpus, by its general coefficients.
    let parabola = quadric([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0, 0.0]);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5]).from(0.0, 4.0, 0.0);
    p.go(&[(To, &parabola), (To, &ground()), (On, &y_axis())]).ends(0.0, 0.2492, 0.0, 0.00101);
    p.side(Left)
        .drive(GoLft, &parabola, On, &line(4.0, 0.0, 4.0, 5.0))
        .ends(4.0, 4.569782, 0.0, 0.00101)
        .verified();
    assert!(p.last().points.len() <= 21, "{} vectors", p.last().points.len());

    // x²/4 − y²/2.25 = 1.
    let hyperbola = quadric([0.25, -1.0 / 2.25, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5]).from(0.0, 0.0, 0.0).indirv(1.0, 0.0, 0.0);
    p.go(&[(To, &hyperbola)]).ends(1.7492, 0.0, 0.0, 0.00101);
    p.side(Left)
        .drive(GoLft, &hyperbola, On, &line(0.0, 2.0, 5.0, 2.0))
        .ends(2.969988, 2.0, 0.0, 0.00101)
        .verified();
    assert!(p.last().points.len() <= 12, "{} vectors", p.last().points.len());
}

#[test]
fn ellipse_inside_with_direction() {
    // Centre (1,1), half axes 4 and 2.5, turned 30°.
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let (a, b) = (1.0 / 16.0, 1.0 / 6.25);
    let (xx, yy, xy) = (a * cos * cos + b * sin * sin, a * sin * sin + b * cos * cos, (a - b) * sin * cos);
    let (p1, q1) = (-(xx + xy), -(xy + yy));
    let ellipse = quadric([xx, yy, 0.0, xx + yy + 2.0 * xy - 1.0, 0.0, 0.0, xy, p1, q1, 0.0]);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5]).from(1.0, 1.0, 0.0).indirv(0.0, -1.0, 0.0);
    p.go(&[(To, &ellipse)]).ends(0.9971791, -1.454729, 0.0, 0.00101);
    let across = line(1.0, 1.0, 1.0 + cos, 1.0 + sin);
    p.side(Right).drive(GoRgt, &ellipse, On, &across).ends(-2.248288, -0.8754, 0.0, 0.00101).verified();
    assert!(p.last().points.len() <= 19, "{} vectors", p.last().points.len());
}

#[test]
fn first_of_to_on_past() {
    for (relation, x) in [(To, 3.267949), (On, 3.52098), (Past, 3.775255)] {
        let mut p = Program::new();
        p.cutter(&[0.5]).from(0.0, 2.0, 0.0).go(&[(To, &x_axis()), (To, &ground()), (On, &y_axis())]);
        p.side(Left).drive(GoLft, &x_axis(), relation, &circle(5.0, 0.0, 1.5)).ends(x, 0.25, 0.0, EXACT);
    }
}

/// APT III passes over what comes until the tool is placed again; in APT4 the tool stays and the next statement goes on.
#[test]
fn after_a_failure_apt4_goes_on_from_where_the_tool_stays() {
    let (behind, ahead) = (line(-5.0, 0.0, -5.0, 5.0), line(5.0, 0.0, 5.0, 5.0));
    for (rule, goes_on) in
        [(crate::section2::StartUpRule::Apt4, true), (crate::section2::StartUpRule::Apt3, false)]
    {
        let mut p = Program::new();
        p.state.start_up = rule;
        p.cutter(&[0.5]).from(0.0, 2.0, 0.0).go(&[(To, &x_axis())]).indirv(1.0, 0.0, 0.0).side(Left);
        p.attempt(&motion(Forward, &x_axis(), &[(On, 1, &behind)])).expect_err("the other way");
        p.ends(0.0, 0.25, 0.0, EXACT);
        let next =
            p.attempt(&motion(Forward, &x_axis(), &[(On, 1, &ahead)])).expect("carried out or passed over");
        assert_eq!(!matches!(next, Some(Output::Ignored)), goes_on, "{rule:?}");
        p.ends(if goes_on { 5.0 } else { 0.0 }, 0.25, 0.0, EXACT);
    }
}

#[test]
fn failures_have_their_numbers() {
    let fails = |p: &mut Program, command: &MotionCommand| p.attempt(command).expect_err("must fail").apt3();
    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 0.25, 0.0);
    let check = line(5.0, 0.0, 5.0, 5.0);
    let forward = motion(Forward, &x_axis(), &[(On, 1, &check)]);
    assert_eq!(fails(&mut p, &forward), Some(505));
    assert!(matches!(p.attempt(&forward), Ok(Some(Output::Ignored))), "restart mode");

    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 2.0, 0.0).go(&[(To, &x_axis())]);
    p.run(&MotionCommand::PartSurface(named(&plane(0.0, 0.0, 1.0, 3.0))));
    let left = motion(GoLft, &x_axis(), &[(On, 1, &check)]);
    p.side(Left);
    assert_eq!(fails(&mut p, &left), Some(502));

    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 2.0, 0.0).go(&[(To, &x_axis())]).side(Right).run(&left);
    assert_eq!(p.warnings.len(), 1);
    assert_eq!(p.warnings[0].apt3(), Some(1601));
    p.ends(5.0, 0.25, 0.0, EXACT);

    let mut p = Program::new();
    p.cutter(&[0.5]).from(5.0, -0.5, 0.0).go(&[(To, &circle(0.0, 0.0, 2.0))]).side(Right);
    let never = motion(GoRgt, &circle(0.0, 0.0, 2.0), &[(To, 1, &line(0.0, 9.0, 5.0, 9.0))]);
    assert_eq!(fails(&mut p, &never), Some(714));
    p.from(5.0, -0.5, 0.0).run(&MotionCommand::ForceIteration(true)).go(&[(To, &circle(0.0, 0.0, 2.0))]);
    assert_eq!(fails(&mut p, &never), Some(714));

    let mut p = Program::new();
    p.cutter(&[3.0]).from(0.0, 0.0, 0.0).indirv(1.0, 0.0, 0.0);
    assert_eq!(fails(&mut p, &start(&[(To, &circle(0.0, 0.0, 1.0))])), Some(724));

    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 0.0, 0.0).indirv(1.0, 0.0, 0.0).run(&MotionCommand::NoPartSurface);
    assert_eq!(fails(&mut p, &start(&[(To, &circle(5.0, 9.0, 1.0))])), Some(714));

    let mut p = Program::new();
    p.from(0.0, 2.0, 0.0);
    assert_eq!(fails(&mut p, &start(&[(To, &x_axis())])), Some(311));
    p.from(0.0, 2.0, 0.0);
    let zero = MotionCommand::Direction([Some(Direction::Vector(Vec3::zeros())), None, None]);
    assert_eq!(fails(&mut p, &zero), Some(7));

    let mut p = Program::new();
    p.cutter(&[0.5]).from(2.0, 2.0, 0.0).go(&[(To, &x_axis())]).side(Left);
    assert_eq!(fails(&mut p, &motion(GoLft, &x_axis(), &[(To, 1, &line(-4.0, 0.0, -4.0, 1.0))])), Some(724));
}

/// Line and circle miss each other by less than the drive surface's band: the path gives way so that the check surface
/// keeps its own band too, and what cannot be tangent is told.
#[test]
fn a_tangency_may_use_the_band_of_the_drive_surface() {
    for (radius, tangent) in [(2.0, true), (2.0002, true), (1.9998, true), (2.0007, false), (1.9992, false)] {
        for force in [false, true] {
            let mut p = Program::new();
            p.cutter(&[0.5]);
            let (line, circle) = (line(0.0, 0.0, 1.0, 0.0), circle(4.0, 2.0, radius));
            p.run(&MotionCommand::ForceIteration(force));
            p.from(-1.0, -1.0, 1.0).go(&[(To, &line), (To, &ground()), (On, &plane(1.0, 0.0, 0.0, 0.0))]);
            p.side(Right);
            let outcome = p.attempt(&motion(GoRgt, &line, &[(Tanto, 1, &circle)]));
            assert_eq!(outcome.is_ok(), tangent, "{radius} {force}: {outcome:?}");
            p.verified();
            if tangent {
                let gap = (p.tip() - v(4.0, 2.0, 0.0)).norm() - radius - 0.25;
                assert!((-1e-9..=0.0005).contains(&gap), "{radius} {force}: {gap}");
            }
        }
    }
}
