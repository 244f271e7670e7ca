//! Start-up motions: the rules of the dialects, and what a direction decides.

use std::sync::Arc;

use Relation::{On, Past, TangentToDrive, TangentToPart, To};
use apt_geometry::{
    Vec3,
    canonical::{Cone, Geometry, TabulatedCylinder},
    motion::{AxisAngle, Delta, Direction, DriveSide, MotionCommand, NamedSurface, Relation, ToolAxis, Turn},
};

use crate::{
    MotionFailure,
    clearance::EVALUATIONS,
    section2::StartUpRule,
    tests::{
        Program, circle, cylinder, economy::tabulated, ground, line, named, plane, quadric, sphere, start, v,
    },
};

/// The peers print seven digits.
const PRINTED: f64 = 2e-6;
/// Default OUTTOL: how far from the peer a position on a curved surface may be.
const BAND: f64 = 5.1e-4;

fn program(rule: StartUpRule) -> Program {
    let mut p = Program::new();
    p.state.start_up = rule;
    p
}

fn towards(p: &mut Program, x: f64, y: f64, z: f64) {
    p.run(&MotionCommand::Direction([Some(Direction::Point(v(x, y, z))), None, None]));
}

#[test]
fn a_direction_that_misses_is_an_error_in_apt3_and_a_detour_in_apt4() {
    let c = circle(8.0, 0.0, 3.0);
    let mut p = program(StartUpRule::Apt3);
    p.cutter(&[1.0]).from(-3.0, 0.0, 0.0);
    towards(&mut p, 8.0, 9.0, 0.0);
    assert_eq!(p.attempt(&start(&[(To, &c)])).expect_err("misses").apt3(), Some(714));

    let mut p = program(StartUpRule::Apt4);
    p.cutter(&[1.0]).from(-3.0, 0.0, 0.0);
    towards(&mut p, 8.0, 9.0, 0.0);
    p.go(&[(To, &c)]).ends(5.442_449_5, 2.389_997, 0.0, BAND).verified();
    p.from(-3.0, 0.0, 0.0).indirv(1.0, 0.0, 0.0).go(&[(To, &c)]).ends(4.5, 0.0, 0.0, BAND).verified();
    p.from(-3.0, 0.0, 0.0).indirv(1.0, 0.0, 0.0).go(&[(Past, &c)]).ends(5.5, 0.0, 0.0, BAND).verified();
}

#[test]
fn a_canted_part_plane_is_met_by_the_shortest_way_in_apt4_and_along_the_axis_in_apt3() {
    let canted = plane(-2.0 / 104_f64.sqrt(), 0.0, 10.0 / 104_f64.sqrt(), 0.0);
    let wall = line(0.0, 0.0, 10.0, 0.0);
    for (rule, x, z) in [
        // Across the line to y = -.5 first, then down the axis: the edge of the tool touches at x + .5.
        (StartUpRule::Apt3, -3.0, -0.5),
        (StartUpRule::Apt4, -1.942_307_7, -0.288_461_5),
    ] {
        let mut p = program(rule);
        p.cutter(&[1.0]).from(-3.0, -3.0, 5.0);
        p.run(&MotionCommand::PartSurface(NamedSurface { name: String::new(), geometry: canted.clone() }));
        p.go(&[(To, &wall)]).ends(x, -0.5, z, PRINTED).verified();
    }
}

#[test]
fn one_direction_keeps_the_move_in_its_plane() {
    let (boss, floor) = (circle(5.0, 1.0, 2.0), plane(0.0, 0.0, 1.0, 0.0));
    let mut p = program(StartUpRule::Apt4);
    p.cutter(&[0.5]).from(0.0, 0.0, 3.0).indirv(1.0, 0.0, 0.0);
    p.go(&[(To, &boss), (To, &floor)]).verified();
    assert!(p.tip().y.abs() < 1e-9, "left the plane of the direction: {:?}", p.tip());
    // Without a direction the shortest way bends towards the centre.
    let mut p = program(StartUpRule::Apt4);
    p.cutter(&[0.5]).from(0.0, 0.0, 3.0).go(&[(To, &boss), (To, &floor)]).verified();
    assert!(p.tip().y > 0.1, "{:?}", p.tip());
    // Both planes: also in APT III, where the part plane is canted so that the general route is taken.
    let (wall, canted) = (plane(0.8, 0.0, 0.6, 4.0), plane(0.0, -0.6, 0.8, 0.0));
    let mut p = program(StartUpRule::Apt3);
    p.cutter(&[0.5, 0.25]).from(0.0, 0.0, 3.0).indirv(1.0, 0.5, 0.0);
    p.go(&[(To, &wall), (To, &canted)]).verified();
    let moved = p.tip() - v(0.0, 0.0, 3.0);
    // The common tangent of the two planes, less its part along the direction.
    let across = v(-0.36, 0.64, 0.48);
    let normal = across - v(1.0, 0.5, 0.0) * (across.dot(&v(1.0, 0.5, 0.0)) / 1.25);
    assert!(moved.dot(&normal).abs() < 1e-9, "left the plane of the direction: {moved:?}");
}

#[test]
fn without_part_surface_the_move_is_made_along_the_direction() {
    let ball = sphere(5.0, 1.0, 0.5, 2.0);
    for (relation, sign) in [(To, -1.0), (On, -1.0)] {
        let mut p = program(StartUpRule::Apt3);
        p.cutter(&[0.5, 0.25]).from(0.0, 0.0, 0.0).run(&MotionCommand::NoPartSurface);
        p.indirv(4.0, 1.0, 0.0).go(&[(relation, &ball)]).verified();
        let tip = p.tip();
        assert!((tip.y - tip.x / 4.0).abs() < 1e-9 && tip.z.abs() < 1e-9, "off the ray: {tip:?}");
        assert!((tip - v(5.0, 1.0, 0.5)).dot(&v(4.0, 1.0, 0.0)) * sign > 0.0, "on the far side: {tip:?}");
    }
    let mut p = program(StartUpRule::Apt3);
    p.cutter(&[0.5, 0.25]).from(0.0, 0.0, 0.0).run(&MotionCommand::NoPartSurface);
    p.indirv(0.0, 1.0, 0.0);
    let failure = p.attempt(&start(&[(To, &ball)])).expect_err("the ray misses");
    assert!(matches!(failure, MotionFailure::NotReachedAlong { .. }), "{failure:?}");
}

/// A direction that leads up or down as well does so, whether or not a closed form finds where the surface is met.
#[test]
fn without_part_surface_an_inclined_move_to_an_upright_surface_is_made_along_the_direction() {
    let (wall, boss) = (line(4.0, -1.0, 4.0, 1.0), circle(6.0, 0.0, 2.0));
    for rule in [StartUpRule::Apt3, StartUpRule::Apt4] {
        for (relation, surface, x) in
            [(To, &wall, 3.5), (On, &wall, 4.0), (Past, &wall, 4.5), (To, &boss, 3.5)]
        {
            let mut p = program(rule);
            p.cutter(&[1.0]).from(0.0, 0.0, 3.0).run(&MotionCommand::NoPartSurface);
            // Down by a half of the way.
            p.indirv(2.0, 0.0, -1.0).go(&[(relation, surface)]).ends(x, 0.0, 3.0 - 0.5 * x, BAND).verified();
        }
    }
}

/// NOPS and SRFVCT are for the next start-up; a directed motion before it is none. INDIRV is for the next motion of any kind.
#[test]
fn what_is_said_for_the_next_start_up_outlasts_directed_motion() {
    let (floor, stop, wall) = (line(0.0, 0.0, 9.0, 0.0), line(3.0, 0.0, 3.0, 1.0), line(9.0, -1.0, 9.0, 1.0));
    let there = |p: &mut Program| {
        p.side(DriveSide::Left).indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &floor, To, &stop);
        p.run(&MotionCommand::GoDelta { delta: Delta::Vector(v(0.0, 0.0, 2.0), None), name: String::new() });
    };
    let mut p = program(StartUpRule::Apt3);
    p.cutter(&[0.5]).from(0.0, 0.25, 0.0).run(&MotionCommand::NoPartSurface);
    there(&mut p);
    p.go(&[(To, &wall)]).ends(8.75, 0.25, 2.0, BAND);
    // Once only.
    p.go(&[(Past, &wall)]).ends(9.25, 0.25, 0.0, BAND);

    let mut p = program(StartUpRule::Apt3);
    p.cutter(&[0.5]).from(0.0, 0.25, 0.0).run(&MotionCommand::SurfaceVectors([Some(-Vec3::x()), None, None]));
    there(&mut p);
    // The vector points from the side of TO to that of PAST.
    p.go(&[(To, &wall)]).ends(9.25, 0.25, 0.0, BAND);
}

/// In the middle of a sphere no direction is plainly the nearest: along its axis the tool comes out first, for its tip is all that has to.
#[test]
fn without_part_surface_the_move_is_the_shortest_one_from_a_centre_too() {
    let ball = sphere(0.0, 0.0, 0.0, 2.0);
    let same = quadric([1.0, 1.0, 1.0, -4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    for (cutter, surface) in
        [(&[0.5, 0.25][..], &ball), (&[0.5], &ball), (&[0.5, 0.25], &same), (&[0.5], &same)]
    {
        let mut p = program(StartUpRule::Apt3);
        p.cutter(cutter).from(0.0, 0.0, 0.0).run(&MotionCommand::NoPartSurface);
        p.go(&[(To, surface)]).verified().ends(0.0, 0.0, 2.0, 1e-3);
    }
    // On the axis of an upright cylinder all directions are alike.
    let mut p = program(StartUpRule::Apt3);
    p.cutter(&[0.5]).from(0.0, 0.0, 0.0).run(&MotionCommand::NoPartSurface);
    let failure = p.attempt(&start(&[(To, &cylinder(v(0.0, 0.0, 0.0), v(0.0, 0.0, 1.0), 2.0))]));
    assert!(matches!(failure, Err(MotionFailure::StartUpAmbiguous { .. })), "{failure:?}");
}

#[test]
fn the_move_of_apt4_stops_at_the_first_of_the_surfaces() {
    // On the way to the far wall the near wall is met first; the tool must not cross it before the sides are settled.
    let (far, near) = (line(9.0, -5.0, 9.0, 5.0), line(4.0, -5.0, 12.0, 5.0));
    let mut p = program(StartUpRule::Apt4);
    p.cutter(&[1.0]).from(0.0, 0.0, 0.0).indirv(1.0, 0.0, 0.0);
    p.go(&[(To, &far), (To, &plane(0.0, 0.0, 1.0, 0.0)), (To, &near)]).verified();
    let above = |x: f64, y: f64| (y + 5.0) * 8.0 - (x - 4.0) * 10.0;
    assert!(above(p.tip().x, p.tip().y) > 0.0, "the tool crossed the near wall: {:?}", p.tip());
}

/// The way from the start is mirrored on the other side of the nearest position, not at another one.
#[test]
fn two_sides_of_the_nearest_position_are_one_answer() {
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[1.0812946301719006, 0.5406473150859503]);
    p.run(&MotionCommand::From {
        position: v(0.7987517285383947, -1.3196763852697064, 0.8093604275514281),
        axis: Some(v(-0.022819020368739142, 0.11185669524198244, 0.9934623153592457)),
        name: String::new(),
    });
    let part = plane(0.022819020368739125, -0.11185669524198252, -0.9934623153592457, -0.006105292586625594);
    let drive = Geometry::Cone(Cone {
        vertex: v(1.0342376874744765, -0.38116317227157537, 1.5495471580819273),
        axis: v(0.0942804055146963, 0.5524393781953678, -0.8282040440345),
        cosine: 0.7669948205624006,
    });
    p.run(&MotionCommand::PartSurface(NamedSurface { name: String::new(), geometry: part }));
    p.go(&[(To, &drive)]).verified();
}

/// Above a parabola, on its axis, neither a mirror image at a normal nor one at the tool axis leads from one side to the other.
#[test]
fn two_answers_that_are_equally_near_are_told_wherever_they_lie() {
    let parabola = quadric([0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5, 0.0]);
    let from = |x: f64, y: f64| {
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(x, y, 1.0);
        p.attempt(&start(&[(To, &parabola), (To, &ground())])).map(|_| p.tip())
    };
    let failure = from(0.0, 8.0).expect_err("two answers");
    let MotionFailure::StartUpAmbiguous { places: [one, other] } = failure else { panic!("{failure:?}") };
    assert!((one.x + other.x).abs() < 1e-6 && one.x.abs() > 1.0, "{one:?} {other:?}");
    // Nearer to the vertex than its radius of curvature there is one, and beside the axis one is the nearer.
    assert!(from(0.0, 4.0).is_ok_and(|tip| tip.x.abs() < 1e-6));
    assert!(from(0.5, 8.0).is_ok_and(|tip| tip.x > 1.0));
}

/// A needle that is longer than the hole is wide by less than the band: at its best it lies deeper in the wall than motions
/// end elsewhere.
#[test]
fn a_position_anywhere_in_the_bands_will_do_where_none_is_in_its_usual_place() {
    let hole = circle(0.0, 0.0, 1.0);
    let attempt = |length: f64| {
        let mut p = Program::new();
        p.tolerance(0.004, 0.004).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, length]);
        p.run(&MotionCommand::From {
            position: v(-0.8, 0.3, 0.5),
            axis: Some(v(1.0, 0.0, 0.0)),
            name: String::new(),
        });
        let command =
            start(&[(On, &plane(0.0, 1.0, 0.0, 0.01)), (To, &hole), (On, &plane(0.0, 0.0, 1.0, 0.2))]);
        p.attempt(&command).map(|_| p.verified().tip())
    };
    // Its ends are 1.0025 from the middle, where the tool would lie .002 deep.
    let tip = attempt(2.005).expect("a position");
    assert!((tip - v(-1.0025, 0.01, 0.2)).norm() < 2e-3, "{tip:?}");
    let failure = attempt(2.009).expect_err("no position in the bands");
    assert!(matches!(failure, MotionFailure::StartUpDiverges { .. }), "{failure:?}");
}

/// Two quadrics whose clearances are .5 and .74 have their only position with a plane 3.6 away.
#[test]
fn a_position_several_times_as_far_as_the_surfaces_is_found() {
    let drive = quadric([
        -0.012435601476738445,
        -0.7396921836064178,
        0.15715515534635274,
        0.6390054922632246,
        -0.10300244498026476,
        0.02880658359959453,
        0.4045841277223315,
        -0.30298795881320356,
        0.4118451022552385,
        -0.3077807518715024,
    ]);
    let part = quadric([
        0.1008883126078387,
        -0.08944580499338531,
        -0.21527082728714908,
        -1.9179159633565794,
        0.20865514558114634,
        -0.29786094380863704,
        0.1971468895500809,
        0.2364996084049605,
        -0.3752082855878351,
        0.6639724353416032,
    ]);
    let first = plane(-0.5010998371837274, -0.5150622342785687, -0.6954206266673506, 0.6018092949030475);
    let taper =
        [0.5753910758072707, 0.0, 0.28769553790363533, 0.0, 0.0, 4.007270550142197, 3.7646554896274247];
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&taper).from(-0.8141593126300082, -1.6291925265470364, 1.5846595283796383);
    p.go(&[(On, &drive), (To, &part), (On, &first)]).verified();
}

/// From far off, beside the tangency, past it and at it; on either side of the drive surface, and with the tool end on it.
#[test]
fn go_with_tanto_comes_to_the_tangency_of_drive_and_check_surface() {
    let (wall, boss, floor) = (line(0.0, 0.0, 5.0, 0.0), circle(2.0, 1.0, 1.0), plane(0.0, 0.0, 1.0, 0.0));
    for (relation, from, y) in [
        (To, v(-7.0, -3.0, 1.0), -0.25),
        (To, v(1.9, -1.0, 1.0), -0.25),
        (To, v(2.0, -1.0, 1.0), -0.25),
        (To, v(40.0, -1.0, 1.0), -0.25),
        (Past, v(-1.0, 1.0, 1.0), -0.25),
        (On, v(-1.0, -1.0, 1.0), 0.0),
    ] {
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[0.5]).from(from.x, from.y, from.z);
        p.go(&[(relation, &wall), (On, &floor), (TangentToDrive, &boss)]).ends(2.0, y, 0.0, 1e-6).verified();
    }
    // Around the boss to the wall, between walls that touch it from outside and inside, and PSTAN.
    let (inner, hollow) = (circle(2.0, 3.0, 3.0), circle(2.0, 4.0, 2.0));
    for (drive, check, from, y) in [
        (&boss, &wall, v(-3.0, 1.5, 1.0), -0.25),
        (&inner, &boss, v(2.4, 1.0, 1.0), 0.25),
        (&boss, &hollow, v(-3.0, 1.5, 1.0), 2.25),
    ] {
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[0.5]).from(from.x, from.y, from.z);
        p.go(&[(To, drive), (On, &floor), (TangentToDrive, check)]).ends(2.0, y, 0.0, 1.1e-3).verified();
    }
    let (bar, side) = (cylinder(v(4.0, 0.0, -2.0), v(0.0, 1.0, 0.0), 2.0), plane(0.0, 1.0, 0.0, 1.0));
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(-1.0, -1.0, 3.0);
    p.go(&[(To, &side), (To, &floor), (TangentToPart, &bar)]).ends(4.0, 0.75, 0.0, 1e-6).verified();
}

/// The two may miss each other by both bands, and not by more.
#[test]
fn go_with_tanto_tells_how_far_surfaces_are_from_being_tangent() {
    let (wall, floor) = (line(0.0, 0.0, 5.0, 0.0), plane(0.0, 0.0, 1.0, 0.0));
    let attempt = |check: &Geometry| {
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[0.5]).from(-1.0, -1.0, 1.0);
        p.attempt(&start(&[(To, &wall), (On, &floor), (TangentToDrive, check)])).map(|_| p.verified().tip())
    };
    for off in [-0.0035, -0.0015, 0.0015, 0.0035] {
        let found = attempt(&circle(3.0, 1.0 + off, 1.0));
        if off.abs() < 0.002 {
            let tip = found.expect("the bands reach from one to the other");
            assert!((tip.x - 3.0).abs() < 1e-6 && (tip.y + 0.25).abs() < 0.001, "{tip:?}");
        } else {
            let failure = found.expect_err("too far apart");
            assert!(
                matches!(failure, MotionFailure::NotTangent { gap, .. } if (gap - off).abs() < 1e-9),
                "{failure:?}"
            );
        }
    }
    let failure = attempt(&line(3.0, 0.0, 4.0, 1.0)).expect_err("lines that cross");
    assert!(matches!(failure, MotionFailure::TangentLines { .. }), "{failure:?}");
}

/// An ellipse touches the circle about its shorter axis at both ends of it.
#[test]
fn of_two_tangencies_that_are_equally_near_a_direction_takes_one() {
    let (boss, floor) = (circle(0.0, 0.0, 2.0), plane(0.0, 0.0, 1.0, 0.0));
    let ellipse = quadric([4.0 / 36.0, 9.0 / 36.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5]).from(5.0, 0.0, 1.0);
    let command = start(&[(To, &boss), (On, &floor), (TangentToDrive, &ellipse)]);
    let failure = p.attempt(&command).expect_err("which of the two");
    let MotionFailure::StartUpAmbiguous { places } = failure else { panic!("{failure:?}") };
    let mut heights = places.map(|place| place.y);
    heights.sort_by(f64::total_cmp);
    assert!((heights[0] + 2.25).abs() < 2e-3 && (heights[1] - 2.25).abs() < 2e-3, "{places:?}");
    for sense in [-1.0, 1.0] {
        p.from(5.0, 0.0, 1.0).indirv(-1.0, 0.3 * sense, 0.0).run(&command).ends(0.0, 2.25 * sense, 0.0, 2e-3);
    }
    p.from(5.0, 0.5, 1.0).run(&command).ends(0.0, 2.25, 0.0, 2e-3).verified();
}

/// Two positions on a straight line as far from the start as each other are images of each other, and the one between them is nearer: what has been looked at
/// before must not hide it.
#[test]
fn images_on_a_straight_line_are_no_answers_but_what_lies_between_them() {
    let Geometry::TabulatedCylinder(flat) = tabulated(
        &[
            [-13.444014669092924, 4.789919741660916, 0.0, 0.0],
            [-4.302381237703852, 0.7364597127338194, 0.07314270986291686, -0.19303162647432406],
            [-3.8023812377038517, 0.461031953697784, 0.05440582989184188, -0.07022950244074715],
            [-3.3023812377038517, 0.12734383421567655, 0.062261340946403475, 0.02462777952899794],
            [-2.8023812377038517, -0.18290615628326537, 0.08665670320160895, 0.13552613313899256],
            [-2.3023812377038517, -0.39375799977820825, 0.044519462167320785, 0.29000062274696525],
            [-1.8023812377038517, -0.4535878112664663, -0.0702876272228463, 0.35299627794833],
            [-1.3023812377038517, -0.34774716625809043, -0.08085088623083928, 0.23470162854813634],
            [-0.8023812377038516, -0.10214954597267237, -0.05726413964769404, 0.1007833398073363],
            [-0.3023812377038516, 0.22307418662746395, -0.05726413964769404, 0.001684822480449847],
            [0.1976187622961484, 0.5482979192276003, -0.08085088623083928, -0.099584733430902],
            [0.6976187622961484, 0.7938955395130183, -0.0702876272228463, -0.24522858453645838],
            [1.1976187622961483, 0.8997361845213941, 0.044519462167320785, -0.357256203227556],
            [1.6976187622961483, 0.8399063730331361, 0.08665670320160895, -0.2765963925368959],
            [2.1976187622961483, 0.6290545295381933, 0.062261340946403475, -0.1345379260807922],
            [2.6976187622961483, 0.3188045390392513, 0.05440582989184188, -0.02788413526265978],
            [3.1976187622961483, -0.014883580442856092, 0.07314270986291686, 0.06777286074604609],
            [3.6976187622961483, -0.29031133947889154, 0.0, 0.0],
        ],
        [12.83925219368522, -4.343771368405988],
    ) else {
        panic!("a tabulated cylinder")
    };
    let axes = [
        v(-0.15226193607504473, 0.3809561715327728, -0.911969680523301),
        v(0.502657703719282, 0.8243273723299284, 0.2604219962278426),
        v(0.850970937056218, -0.41875622813127034, -0.3170042360709616),
    ];
    let drive = Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder { axes, ..(*flat).clone() }));
    let part = plane(0.21127955028960135, 0.0004845773858409097, 0.9774255556379632, -1.489269547824169);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.1974512530758923]);
    p.run(&MotionCommand::From {
        position: v(0.3048989295706205, 2.203536159552636, -0.876332749623354),
        axis: Some(v(0.2112795502896014, 0.00048457738584078, 0.9774255556379631)),
        name: String::new(),
    });
    p.run(&MotionCommand::PartSurface(named(&part)));
    p.go(&[(To, &drive)]);
    let middle = v(-0.169221435, 1.485780504, -1.487823279);
    assert!((p.tip() - middle).norm() < 0.03, "{}", p.tip());
}

/// How many times the clearances of a start-up with a fixed axis one without a position takes while the axis follows the part surface: with the
/// present axis, with its own and, if it is tilted, with that tilted to the other side, each looked for once from the start, and somewhat more.
const TIMES_OF_FIXED: [f64; 2] = [2.5, 3.5];

/// The tool end cannot be on a small ball while the tool touches a saddle far below it: what was looked for in vain from a place is not looked for from
/// there again.
#[test]
fn a_start_up_whose_axis_follows_looks_once_from_a_place_without_a_position() {
    let saddle = quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5]);
    let (ball, wall) = (sphere(3.0, 2.0, 8.0, 0.5), plane(1.0, 0.0, 0.0, 3.1));
    let clearances = |mode: ToolAxis| {
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[1.0, 0.25]).from(2.5, 2.2, 6.0);
        p.run(&MotionCommand::ToolAxis(mode));
        let before = EVALUATIONS.get();
        let failure = p.attempt(&start(&[(On, &ball), (To, &saddle), (On, &wall)]));
        assert!(matches!(failure, Err(MotionFailure::StartUpDiverges { .. })), "{failure:?}");
        (EVALUATIONS.get() - before) as f64
    };
    let fixed = clearances(ToolAxis::Keep);
    let tilted = AxisAngle::PerpendicularTo(v(0.0, 1.0, 0.0));
    let following =
        [ToolAxis::Normal { part: true }, ToolAxis::AtAngle { part: true, angle: 0.2, mode: tilted }];
    for (mode, times) in following.into_iter().zip(TIMES_OF_FIXED) {
        let count = clearances(mode);
        assert!(count <= times * fixed, "{count} with {fixed}");
    }
}

/// From a place that is all but there no position beside the nearest is another answer: how far away either is differs by less than rounding tells.
#[test]
fn a_place_next_to_the_nearest_is_no_other_answer() {
    let solid = quadric([
        -0.14737141947101604,
        0.08220842280658947,
        -0.05410063852838261,
        -1.1140667738725427,
        -0.023783571734824545,
        -0.092042842688767,
        -0.0696986449129062,
        0.3133324031756974,
        -0.10397954811196013,
        0.15245862163309726,
    ]);
    let floor = plane(-0.2798885629478282, -0.31690889606954054, 0.9062180443596258, 0.9335968840664657);
    let [place, nearest] = [
        v(2.6506935993967016, -1.1655666182467836, 1.441283678097008),
        v(2.650690802261091, -1.1655762858231504, 1.4412794333931593),
    ];
    for share in [0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0] {
        let from = nearest + (place - nearest) * share;
        let mut p = Program::new();
        p.cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.001]).tolerance(2e-5, 3e-5);
        let axis = v(-0.20426461867215745, -0.19536204372160154, 0.9592234554219561);
        p.run(&MotionCommand::ToolAxis(ToolAxis::Fixed(axis))).from(from.x, from.y, from.z);
        p.run(&MotionCommand::PartSurface(named(&floor)));
        let outcome = p.attempt(&start(&[(Relation::To, &solid)]));
        assert!(outcome.is_ok(), "{share}: {outcome:?}");
    }
}
