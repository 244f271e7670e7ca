//! Programs of the three-dimensional corpus: ends agree within the tolerances, vectors do not outnumber the peer's where
//! it keeps its tolerances.

use DriveSide::{Left, On as TlOn, Right};
use Relation::{On, To};
use Turn::{Down, Forward, Left as GoLft, Right as GoRgt, Up};

use super::*;

const TOLERANCE: f64 = 0.00101;
/// The corpus prints seven digits.
const EXACT: f64 = 2e-6;

fn program(cutter: &[f64], inside: f64, outside: f64) -> Program {
    let mut p = Program::new();
    p.tolerance(inside, outside).cutter(cutter);
    p
}

#[test]
fn planes_in_space() {
    let mut p = program(&[0.5], 0.0, 0.0005);
    p.from(-1.0, 1.0, 2.0).go(&[(To, &y(0.0)), (To, &ground()), (On, &x(0.0))]).side(Left);
    p.drive(GoLft, &y(0.0), To, &plane(1.0, 0.2, 0.4, 4.0)).ends(1.695049, 0.25, 0.0, EXACT).verified();

    let floor = plane(0.1, 0.1, 1.0, 1.0);
    let mut p = program(&[1.0, 0.1, 0.4, 0.210707, 15.0, 0.0, 3.0], 0.0, 0.0005);
    p.from(0.0, -1.0, 3.0).go(&[(To, &y(2.0)), (To, &floor), (On, &x(0.0))]).ends(0.0, 1.5, 0.85, 1e-5);
    p.side(Right).drive(GoRgt, &y(2.0), To, &x(4.0)).ends(3.5, 1.5, 0.5, 1e-5).verified();

    let mut p = program(&[1.0], 0.0, 0.0005);
    let leaning = plane(0.0, 1.0, 0.3, 1.0);
    p.from(0.0, -2.0, 1.0).go(&[(To, &leaning), (To, &ground()), (On, &x(0.0))]).ends(0.0, -1.0, 0.0, EXACT);
    p.side(Right).drive(GoRgt, &leaning, To, &x(5.0)).ends(4.5, -1.0, 0.0, EXACT).verified();

    let mut p = program(&[0.5, 0.25], 0.0, 0.0005);
    let (floor, wall) = (plane(0.2, 0.1, 1.0, 2.0), plane(1.0, 0.0, 0.1, 4.0));
    p.from(-1.0, 2.0, 4.0).run(&MotionCommand::Thickness(PerRole {
        part: 0.1,
        drive: 0.05,
        check: [0.2; 2],
    }));
    p.go(&[(To, &y(0.0)), (To, &floor), (On, &x(0.0))]).ends(0.0, 0.3, 2.078643, EXACT);
    p.side(Left).drive(GoLft, &y(0.0), To, &wall).ends(2.899121, 0.3, 1.498819, EXACT).verified();
}

#[test]
fn part_side_on_and_off() {
    let floor = plane(0.2, 0.1, 1.0, 2.0);
    for (relation, side, height) in [(To, PartSide::Offset, 2.006174), (On, PartSide::On, 2.0)] {
        let mut p = program(&[0.5, 0.25], 0.0, 0.0005);
        p.from(-1.0, 2.0, 4.0)
            .go(&[(On, &y(0.0)), (relation, &floor), (On, &x(0.0))])
            .ends(0.0, 0.0, height, EXACT);
        p.part_side(side)
            .side(TlOn)
            .drive(GoLft, &y(0.0), On, &x(4.0))
            .ends(4.0, 0.0, height - 0.8, EXACT)
            .verified();
    }
}

#[test]
fn check_surfaces_cone_and_sphere() {
    let mut p = program(&[0.5, 0.1], 0.0, 0.0005);
    let cn = cone(v(6.0, 0.0, 3.0), -Vec3::z(), 40.0);
    p.from(-1.0, 1.0, 2.0).go(&[(On, &y(0.5)), (To, &ground()), (On, &x(0.0))]).side(TlOn);
    p.drive(GoLft, &y(0.5), To, &cn).ends(3.331929, 0.5, 0.0, 5.1e-4).verified();

    let mut p = program(&[0.5, 0.25], 0.0, 0.0005);
    p.from(-1.0, 1.0, 2.0).go(&[(On, &y(0.0)), (To, &ground()), (On, &x(0.0))]).side(TlOn);
    p.drive(GoLft, &y(0.0), To, &sphere(6.0, 0.0, 0.0, 2.0)).ends(3.763479, 0.0, 0.0, 5.1e-4).verified();
}

#[test]
fn cones_as_drive_and_part() {
    let down = |z: f64, angle: f64| cone(v(0.0, 0.0, z), -Vec3::z(), angle);
    let up = |angle: f64| cone(v(0.0, 0.0, -4.0), Vec3::z(), angle);
    let mut p = program(&[0.5], 0.001, 0.001);
    p.from(5.0, -0.5, 1.0).go(&[(To, &down(4.0, 30.0)), (To, &ground())]).side(Right);
    p.drive(GoRgt, &down(4.0, 30.0), On, &x(0.0)).ends(0.0, 2.560325, 0.0, TOLERANCE).verified();
    assert!(p.last().points.len() <= 21, "{}", p.last().points.len());

    let mut p = program(&[0.5, 0.25], 0.001, 0.001);
    p.from(1.0, -0.2, 1.0).indirv(1.0, 0.0, 0.0).go(&[(To, &up(30.0)), (To, &ground())]);
    p.ends(2.163381, -0.1062308, 0.0, TOLERANCE).side(Left);
    p.drive(GoLft, &up(30.0), On, &x(0.0)).ends(0.0, 2.165987, 0.0, TOLERANCE).verified();
    assert!(p.last().points.len() <= 18, "{}", p.last().points.len());

    for (surface, start, height, guide, vectors) in [
        (down(4.0, 45.0), v(-2.5, 1.0, 2.6), 1.868615, 0.3, 20),
        (up(60.0), v(-2.5, 1.0, 0.0), -2.671254, -0.2, 17),
    ] {
        let mut p = program(&[0.5, 0.25], 0.001, 0.001);
        p.from(start.x, start.y, start.z).go(&[(On, &y(1.0)), (To, &surface), (On, &x(-2.0))]);
        p.ends(-2.0, 1.0, height, TOLERANCE).indirv(1.0, 0.0, guide).side(TlOn);
        p.drive(Forward, &y(1.0), On, &x(2.0)).ends(2.0, 1.0, height, TOLERANCE).verified();
        assert!(p.last().points.len() <= vectors, "{}", p.last().points.len());
    }
}

#[test]
fn cylinders_as_drive_and_part() {
    let upright = |r: f64| cylinder(Vec3::zeros(), Vec3::z(), r);
    let lying = |r: f64| cylinder(Vec3::zeros(), Vec3::x(), r);
    let mut p = program(&[0.5, 0.25], 0.001, 0.001);
    p.from(4.0, -0.5, 6.0).go(&[(To, &upright(1.5)), (To, &lying(4.0))]);
    p.ends(1.749772, -0.05999708, 4.000374, TOLERANCE).side(Right);
    p.drive(GoRgt, &upright(1.5), On, &x(0.0)).ends(0.0, 1.7508, 3.623508, TOLERANCE).verified();
    assert!(p.last().points.len() <= 18, "{}", p.last().points.len());

    let mut p = program(&[0.5, 0.25], 0.001, 0.001);
    p.from(4.0, -0.5, 2.0).go(&[(To, &upright(2.0)), (To, &plane(0.2, 0.0, 1.0, 0.0))]);
    p.ends(2.232625, -0.2790782, -0.4415741, EXACT).side(Right);
    p.drive(GoRgt, &upright(2.0), On, &x(0.0)).ends(0.0, 2.25, 0.004950976, EXACT).verified();

    let mut p = program(&[0.5, 0.25], 0.001, 0.001);
    p.from(0.0, -2.0, 5.0).go(&[(On, &x(1.0)), (To, &lying(3.0)), (On, &y(-2.0))]);
    p.ends(1.0, -2.0, 2.312753, TOLERANCE).side(TlOn);
    p.drive(GoLft, &x(1.0), On, &y(2.0)).ends(1.0, 2.0, 2.31276, TOLERANCE).verified();
    assert!(p.last().points.len() <= 20, "{}", p.last().points.len());

    let mut p = program(&[0.5], 0.001, 0.001);
    p.from(0.0, -2.0, 5.0).go(&[(To, &x(1.0)), (To, &lying(3.0)), (On, &y(-2.0))]);
    p.ends(0.75, -2.0, 2.437684, TOLERANCE).side(Left);
    p.drive(GoLft, &x(1.0), To, &y(2.0)).ends(0.75, 1.75, 2.599001, TOLERANCE).verified();
    assert!(p.last().points.len() <= 18, "{}", p.last().points.len());
}

#[test]
fn up_and_down_a_corner() {
    let mut p = program(&[0.5, 0.25], 0.0, 0.0005);
    p.from(0.0, -2.0, 1.0).go(&[(To, &x(2.0)), (To, &y(0.0)), (On, &plane(0.0, 0.0, 1.0, 1.0))]);
    p.ends(1.75, -0.25, 1.0, EXACT).indirv(0.0, 0.0, 1.0).side(Left);
    p.drive(Up, &x(2.0), On, &plane(0.0, 0.0, 1.0, 3.0)).ends(1.75, -0.25, 3.0, EXACT);
    p.drive(Down, &x(2.0), On, &ground()).ends(1.75, -0.25, 0.0, EXACT).verified();
}

#[test]
fn spheres_as_part() {
    for (inside, outside, start, end, tolerance, vectors) in
        [(1e-4, 1e-4, 4.500088, 3.940864, 1.11e-4, 59), (0.0, 0.01, 4.510143, 3.95204, 0.01001, 10)]
    {
        let mut p = program(&[0.5, 0.25], inside, outside);
        p.from(-3.0, 0.0, 7.0).go(&[(On, &y(1.0)), (To, &sphere(0.0, 0.0, 0.0, 5.0)), (On, &x(-2.0))]);
        p.ends(-2.0, 1.0, start, tolerance).side(TlOn);
        p.drive(GoRgt, &y(1.0), On, &x(3.0)).ends(3.0, 1.0, end, tolerance).verified();
        let (count, least) = (p.last().points.len() as u32, p.last().minimum.expect("a ring"));
        assert!(count <= vectors && count <= least + 1, "{count} vectors, least {least}");
    }
    let mut p = program(&[0.5], 0.001, 0.001);
    p.from(-3.0, 0.0, 7.0).go(&[(On, &y(1.0)), (To, &sphere(0.0, 0.0, 0.0, 5.0)), (On, &x(-2.0))]);
    p.ends(-2.0, 1.0, 4.589655, TOLERANCE).side(TlOn);
    p.drive(GoRgt, &y(1.0), On, &x(3.0)).ends(3.0, 1.0, 4.065301, TOLERANCE).verified();
    assert!(p.last().points.len() <= 19, "{}", p.last().points.len());
}

#[test]
fn longest_step() {
    let mut p = program(&[0.5, 0.25], 0.01, 0.01);
    p.run(&MotionCommand::MaximumStep(0.2)).from(-3.0, 0.0, 7.0);
    p.go(&[(On, &y(1.0)), (To, &sphere(0.0, 0.0, 0.0, 5.0)), (On, &x(-1.0))]).side(TlOn);
    p.drive(GoRgt, &y(1.0), On, &x(1.0)).ends(1.0, 1.0, 4.81497, 0.01001).verified();
    let sequence = p.last();
    let mut from = sequence.start.tip;
    for point in &sequence.points {
        assert!((point.tip - from).norm() <= 0.2 * (1.0 + 1e-9));
        from = point.tip;
    }
}

#[test]
fn too_many_points() {
    let mut p = program(&[0.5, 0.25], 1e-4, 1e-4);
    p.run(&MotionCommand::MaximumPoints(10)).from(-3.0, 0.0, 7.0);
    p.go(&[(On, &y(1.0)), (To, &sphere(0.0, 0.0, 0.0, 5.0)), (On, &x(-2.0))]).side(TlOn);
    let failure = p.attempt(&motion(GoRgt, &y(1.0), &[(On, 1, &x(3.0))])).expect_err("too many");
    assert_eq!(failure.apt3(), Some(803));
}

#[test]
fn sphere_as_drive() {
    let mut p = program(&[0.5], 0.001, 0.001);
    let ball = sphere(0.0, 0.0, 0.0, 3.0);
    p.from(5.0, -0.5, 2.0).go(&[(To, &ball), (To, &plane(0.0, 0.0, 1.0, -1.0))]);
    p.ends(3.234667, -0.3234667, -1.0, TOLERANCE).side(Right);
    p.drive(GoRgt, &ball, On, &x(0.0)).ends(0.0, 3.2508, -1.0, TOLERANCE).verified();
    assert!(p.last().points.len() <= 25, "{}", p.last().points.len());
}

#[test]
fn quadrics() {
    let elliptic = quadric([1.0, 4.0, 0.0, -16.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let mut p = program(&[0.5, 0.25], 0.001, 0.001);
    p.from(0.0, -4.0, 2.0).go(&[(To, &elliptic), (To, &plane(0.1, 0.1, 1.0, 0.0)), (On, &x(0.0))]);
    p.ends(0.0, -2.2508, 0.2275676, TOLERANCE).side(Left);
    p.drive(GoLft, &elliptic, On, &y(0.0)).ends(-4.2508, 0.0, 0.4275676, TOLERANCE).verified();
    assert!(p.last().points.len() <= 25, "{}", p.last().points.len());

    let bowl = quadric([1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0]);
    let mut p = program(&[0.5, 0.25], 0.001, 0.001);
    p.from(-2.0, 0.5, 4.0).go(&[(On, &y(0.5)), (To, &bowl), (On, &x(-2.0))]);
    p.ends(-2.0, 0.5, 1.178705, TOLERANCE).indirv(1.0, 0.0, -0.2).side(TlOn);
    p.drive(Forward, &y(0.5), On, &x(2.0)).ends(2.0, 0.5, 1.178717, TOLERANCE).verified();
    assert!(p.last().points.len() <= 23, "{}", p.last().points.len());
}

#[test]
fn inside_a_sphere_and_tool_end_on_it() {
    let bowl = sphere(0.0, 0.0, 5.0, 5.0);
    let mut p = program(&[0.5, 0.25], 0.001, 0.001);
    p.from(-2.0, 0.0, 3.0)
        .go(&[(On, &y(0.0)), (To, &bowl), (On, &x(-2.0))])
        .indirv(1.0, 0.0, -0.2)
        .side(TlOn);
    p.drive(Forward, &y(0.0), On, &x(2.0)).verified();

    let ball = sphere(0.0, 0.0, 0.0, 5.0);
    let mut p = program(&[0.5, 0.25], 0.001, 0.001);
    p.from(-3.0, 0.0, 7.0)
        .go(&[(On, &y(1.0)), (On, &ball), (On, &x(-2.0))])
        .ends(-2.0, 1.0, 4.473292, TOLERANCE);
    p.part_side(PartSide::On)
        .side(TlOn)
        .drive(GoRgt, &y(1.0), On, &x(3.0))
        .ends(3.0, 1.0, 3.874019, TOLERANCE);
    p.verified();
}

#[test]
fn thickness_on_curved_surfaces() {
    let ball = sphere(0.0, 0.0, 0.0, 5.0);
    let mut p = program(&[0.5, 0.25], 0.001, 0.001);
    p.run(&MotionCommand::Thickness(PerRole { part: 0.1, drive: 0.05, check: [0.0; 2] }))
        .from(-3.0, 0.0, 7.0);
    p.go(&[(To, &y(1.0)), (To, &ball), (On, &x(-2.0))]).ends(-2.0, 0.7, 4.663394, TOLERANCE).side(Right);
    p.drive(GoRgt, &y(1.0), On, &x(3.0)).ends(3.0, 0.7, 4.12505, TOLERANCE).verified();
}

#[test]
fn tilted_axis() {
    let axis = MotionCommand::ToolAxis(apt_geometry::motion::ToolAxis::Fixed(v(0.3, 0.2, 1.0)));
    let mut p = program(&[0.5, 0.25], 0.0, 0.0005);
    p.from(0.0, -2.0, 4.0).run(&axis).go(&[(To, &y(0.0)), (To, &ground()), (On, &x(0.0))]);
    p.ends(0.0, -1.186256, 0.01481978, EXACT).side(Right);
    p.drive(GoRgt, &y(0.0), To, &x(3.0)).ends(1.349081, -1.186256, 0.01481978, EXACT).verified();

    let axis = MotionCommand::ToolAxis(apt_geometry::motion::ToolAxis::Fixed(v(0.2, 0.0, 1.0)));
    let mut p = program(&[0.75, 0.2], 0.001, 0.001);
    p.from(-2.0, 0.0, 7.0).run(&axis);
    p.go(&[(On, &y(0.0)), (To, &sphere(0.0, 0.0, 0.0, 5.0)), (On, &x(-1.0))])
        .ends(-1.0, 0.0, 4.978782, TOLERANCE);
    p.side(TlOn).drive(Forward, &y(0.0), On, &x(2.0)).ends(2.0, 0.0, 4.62346, TOLERANCE).verified();
    assert!(p.last().points.len() <= 12, "{}", p.last().points.len());
}

/// Vertices lie at a limit of the band and the stop at rest in it: a stop just behind a vertex must not be reached by a
/// vector across the path.
#[test]
fn every_vector_leads_along_the_path_wherever_the_stop_lies() {
    let part = cone(v(0.0, 0.0, 10.0), v(0.0, 0.0, -1.0), 32.6302);
    for k in 0..300 {
        let mut p = program(&[1.0, 0.25], 0.002, 0.002);
        p.from(-6.3377, 1.0, 11.6105).go(&[(On, &y(1.0)), (To, &part), (On, &x(-3.1449))]);
        let stop = -1.5 + 0.004 * f64::from(k);
        p.indirv(1.0, 0.0, 0.0).side(TlOn).drive(Forward, &y(1.0), On, &x(stop)).verified();
        let sequence = p.last();
        let mut from = sequence.start.tip;
        for point in &sequence.points {
            let delta = point.tip - from;
            assert!(delta.x > 0.4 * delta.norm(), "stop at {stop}: {from:?} to {:?}", point.tip);
            from = point.tip;
        }
    }
}
