//! Stories of motions whose course is known.

use Relation::{On, To};
use Turn::{Left as GoLft, Right as GoRgt};
use apt_geometry::motion::{DriveSide, MotionCommand, Relation, Turn};

use super::{Route, Story, SurfaceShape, VectorEnd, tell};
use crate::{
    error::RoleName,
    tests::{Program, circle, line, motion, plane, sphere, start, v},
};

/// Runs a command and tells it.
fn story(p: &mut Program, command: &MotionCommand) -> Story {
    let state = p.state.clone();
    p.run(command);
    tell(&state, command, p.last(), &|| false).expect("a motion along surfaces")
}

#[test]
fn a_start_up_tells_its_surfaces_and_its_route() {
    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 2.0, 3.0);
    let command = start(&[(To, &line(0.0, 0.0, 1.0, 0.0)), (On, &plane(0.0, 0.0, 1.0, 0.5))]);
    let told = story(&mut p, &command);
    assert_eq!((told.route, told.start_up, told.corrections), (Route::ClosedForm, true, None));
    let roles: Vec<_> = told.surfaces.iter().map(|surface| (surface.role, surface.relation)).collect();
    assert_eq!(roles, [(RoleName::Part, On), (RoleName::Drive, To)]);
    assert!(
        (told.surfaces[1].clearance[0] - 1.75).abs() < 1e-12 && told.surfaces[1].clearance[1].abs() < 1e-12
    );
    assert_eq!((told.surfaces[1].side, told.surfaces[1].shape), (1.0, SurfaceShape::Flat));
    assert_eq!(told.vectors.len(), 1);
    assert_eq!(told.vectors[0].end, VectorEnd::Position);
    assert_eq!(told.vectors[0].clearance, [None, None], "only the end is bound to the surfaces");

    // On a sphere the way is found by iteration.
    let mut p = Program::new();
    p.cutter(&[0.5, 0.25]).from(0.0, 0.3, 3.0);
    let command = start(&[(On, &line(0.0, 0.0, 1.0, 0.0)), (To, &sphere(0.0, 0.0, 0.0, 2.0))]);
    let told = story(&mut p, &command);
    assert_eq!(told.route, Route::Iteration);
    assert!(told.corrections.is_some_and(|count| (1..=10).contains(&count)), "{:?}", told.corrections);
}

#[test]
fn a_straight_motion_ends_at_its_check_surface() {
    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 2.0, 0.0).go(&[(To, &line(0.0, 0.0, 1.0, 0.0))]).side(DriveSide::Left);
    let command = motion(GoLft, &line(0.0, 0.0, 1.0, 0.0), &[(On, 2, &circle(5.0, 0.0, 1.0))]);
    let told = story(&mut p, &command);
    assert_eq!(told.route, Route::ClosedForm);
    let ends: Vec<_> = told.vectors.iter().map(|vector| vector.end).collect();
    assert_eq!(ends, [VectorEnd::CheckSurface { check: 0, relation: On, occurrence: 2 }]);
    assert_eq!(told.forward, Some(v(1.0, 0.0, 0.0)));
    // 3DCALC forbids the closed form, and both surfaces are planes.
    p.from(0.0, 2.0, 0.0).go(&[(To, &line(0.0, 0.0, 1.0, 0.0))]).run(&MotionCommand::ForceIteration(true));
    assert_eq!(story(&mut p, &command).route, Route::Straight);
}

#[test]
fn vectors_round_a_circle_end_by_its_curvature_or_by_maxdp() {
    let boss = circle(0.0, 0.0, 2.0);
    let command = motion(GoRgt, &boss, &[(On, 1, &line(0.0, 0.0, 1.0, 0.0))]);
    for force in [false, true] {
        let mut p = Program::new();
        p.cutter(&[0.5]).tolerance(0.0, 0.001).from(0.0, 5.0, 0.0).go(&[(To, &boss)]).side(DriveSide::Right);
        p.run(&MotionCommand::ForceIteration(force));
        let told = story(&mut p, &motion(Turn::Right, &boss, &[(On, 1, &line(0.0, 0.0, 1.0, 0.0))]));
        assert_eq!(told.route, if force { Route::Iteration } else { Route::ClosedForm });
        let (last, on_the_way) = told.vectors.split_last().expect("vectors");
        assert!(matches!(last.end, VectorEnd::CheckSurface { .. }), "{last:?}");
        let by_curvature = |vector: &&super::StoryVector| matches!(vector.end, VectorEnd::Curvature { role: RoleName::Drive, used } if used > 0.9);
        let count = on_the_way.iter().filter(by_curvature).count();
        assert!(
            count + 2 >= on_the_way.len(),
            "{count} of {} by curvature: {on_the_way:?}",
            on_the_way.len()
        );
        assert!(told.vectors.iter().all(|vector| {
            vector.clearance[1].is_some_and(|[least, greatest]| least >= -1e-9 && greatest <= 0.001 + 1e-9)
        }));
    }
    let mut p = Program::new();
    p.cutter(&[0.5]).tolerance(0.0, 0.001).from(0.0, 5.0, 0.0).go(&[(To, &boss)]).side(DriveSide::Right);
    p.run(&MotionCommand::ForceIteration(true)).run(&MotionCommand::MaximumStep(0.05));
    let told = story(&mut p, &command);
    let at_maximum = told.vectors.iter().filter(|vector| vector.end == VectorEnd::MaximumStep).count();
    assert!(at_maximum + 2 >= told.vectors.len(), "{at_maximum} of {}", told.vectors.len());
}

#[test]
fn a_mere_move_has_no_story() {
    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 2.0, 0.0).go(&[(To, &line(0.0, 0.0, 1.0, 0.0))]);
    let command = MotionCommand::NoPartSurface;
    assert_eq!(tell(&p.state, &command, p.last(), &|| false), None);
}

#[test]
fn a_turning_axis_is_told() {
    let (ball, middle) = (sphere(0.0, 0.0, 0.0, 5.0), plane(0.0, 1.0, 0.0, 0.0));
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5]).from(0.0, 0.0, 7.0);
    p.run(&MotionCommand::ToolAxis(apt_geometry::motion::ToolAxis::Normal { part: true }));
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let told = story(&mut p, &start(&[(On, &middle), (To, &ball), (On, &x(0.0))]));
    assert!(told.turned < 1e-9, "{}", told.turned);
    p.indirv(1.0, 0.0, 0.0);
    let told = story(&mut p, &motion(Turn::Forward, &middle, &[(On, 1, &x(2.5))]));
    // In a clearance of half the band, as at the end of each motion.
    let expected = (2.5f64 / 5.0005).asin();
    assert!((told.turned - expected).abs() < 1e-5, "{} {expected}", told.turned);
}
