//! Every failure that suggests a change gets the change that works, and no other.

use std::cell::Cell;

use Relation::{On, Past, TangentToDrive as Tanto, To};
use Turn::{Forward, Left as GoLft, Right as GoRgt};
use apt_geometry::motion::{DriveSide, MotionCommand, NamedSurface, PartSide, Relation, StartSurface, Turn};

use super::{Cure, Earlier, Patience, Remedy, earlier, remedies};
use crate::{
    error::RoleName,
    section2::{State, execute},
    tests::{Program, circle, line, motion, plane, start, v},
};

/// The remedies of a command that must fail with this number.
fn offered(p: &mut Program, command: &MotionCommand, number: u16) -> Vec<Remedy> {
    let state = p.state.clone();
    let failure = p.attempt(command).expect_err("must fail");
    assert_eq!(failure.apt3(), Some(number), "{failure:?}");
    remedies(&state, command, &failure, &|| false)
}

fn cures(remedies: &[Remedy]) -> Vec<Cure> {
    remedies.iter().map(|remedy| remedy.cure.clone()).collect()
}

/// Tool of diameter .5 beside the x axis, at x=2, above it.
fn beside() -> Program {
    let mut p = Program::new();
    p.cutter(&[0.5]).from(2.0, 2.0, 0.0).go(&[(To, &line(0.0, 0.0, 1.0, 0.0))]).side(DriveSide::Left);
    p
}

#[test]
fn the_other_way_is_offered_when_the_check_surface_lies_behind() {
    let check = line(6.0, 0.0, 6.0, 1.0);
    // From (2,2) down to the line: right is towards −x.
    let wrong = motion(GoRgt, &line(0.0, 0.0, 1.0, 0.0), &[(To, 1, &check)]);
    let found = offered(&mut beside(), &wrong, 724);
    assert_eq!(cures(&found)[0], Cure::Turn(GoLft), "{found:?}");
    assert!((found[0].end - v(5.75, 0.25, 0.0)).norm() < 1e-9, "{found:?}");
}

#[test]
fn another_relation_is_offered_when_surfaces_are_not_tangent() {
    let wrong = motion(GoLft, &line(0.0, 0.0, 1.0, 0.0), &[(Tanto, 1, &circle(6.0, 0.5, 1.0))]);
    let found = offered(&mut beside(), &wrong, 721);
    let relations: Vec<_> = found
        .iter()
        .filter_map(|remedy| match remedy.cure {
            Cure::Relation { relation, .. } => Some(relation),
            _ => None,
        })
        .collect();
    assert_eq!(relations, [To, On], "{found:?}");
    assert!(found[0].end.x < found[1].end.x, "TO stops before ON: {found:?}");
}

/// A tangency that is missed by a hair, as where coordinates have few digits, is one in a wider band, in which the tool may go on, too.
#[test]
fn a_wider_tolerance_is_offered_where_a_tangency_is_missed_by_little() {
    let (x_axis, miss) = (line(0.0, 0.0, 1.0, 0.0), 0.0005);
    for (above, inside) in [(1.0 + miss, false), (1.0 - miss, true)] {
        // The tool passes below the circle, which ends above the wall by its own diameter of .5 and what is missed.
        let check = circle(6.0, 0.5 + above, 1.0);
        let mut p = beside();
        p.tolerance(0.0, 0.0001);
        let wrong = motion(GoLft, &x_axis, &[(Tanto, 1, &check)]);
        let found = offered(&mut p, &wrong, 721);
        let Some(Cure::Tolerance { role: RoleName::Check(0), inside: is_inside, values, .. }) =
            found.first().map(|found| found.cure.clone())
        else {
            panic!("{found:?}")
        };
        assert_eq!(is_inside, inside);
        assert_eq!(values.drive.to_bits(), values.check[0].to_bits());
        let set = if inside { p.state.inside } else { p.state.outside };
        assert_eq!(values.part.to_bits(), set.part.to_bits(), "the part surface needs no wider band");
        *(if inside { &mut p.state.inside } else { &mut p.state.outside }) = values;
        p.run(&wrong);
        p.run(&motion(GoLft, &check, &[(On, 1, &plane(0.0, 1.0, 0.0, 1.0))]));
    }
    // The same where a start-up is to end tangent to the circle.
    let mut p = Program::new();
    p.tolerance(0.0, 0.0001).cutter(&[0.5]).from(5.0, 2.0, 0.0);
    let (floor, bulge) = (plane(0.0, 0.0, 1.0, 0.0), circle(6.0, 1.5 + miss, 1.0));
    let wrong = start(&[(To, &x_axis), (To, &floor), (Tanto, &bulge)]);
    let found = offered(&mut p, &wrong, 721);
    let Some(Cure::Tolerance { inside: false, values, .. }) = found.first().map(|found| found.cure.clone())
    else {
        panic!("{found:?}")
    };
    p.state.outside = values;
    p.run(&wrong);
    // By much more than the band no tolerance is offered.
    let wrong = motion(GoLft, &x_axis, &[(Tanto, 1, &circle(6.0, 1.6, 1.0))]);
    let found = offered(&mut beside(), &wrong, 721);
    assert!(!cures(&found).iter().any(|cure| matches!(cure, Cure::Tolerance { .. })), "{found:?}");
}

#[test]
fn a_smaller_count_is_offered_when_there_are_not_so_many_positions() {
    let wrong = motion(GoLft, &line(0.0, 0.0, 1.0, 0.0), &[(On, 3, &circle(6.0, 0.5, 1.0))]);
    let found = offered(&mut beside(), &wrong, 724);
    assert_eq!(cures(&found)[0], Cure::Occurrence { check: 0, occurrence: 2 }, "{found:?}");
}

#[test]
fn the_turn_along_the_path_is_offered_when_the_word_points_across() {
    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 0.25, 0.0).side(DriveSide::Left);
    let wrong = motion(Forward, &line(0.0, 0.0, 1.0, 0.0), &[(On, 1, &line(5.0, 0.0, 5.0, 5.0))]);
    let found = offered(&mut p, &wrong, 505);
    assert_eq!(cures(&found), [Cure::Turn(GoRgt)], "{found:?}");
}

#[test]
fn a_direction_is_offered_where_there_is_none() {
    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 0.25, 0.0).side(DriveSide::Left);
    // Straight along the axis: no forward direction.
    p.state.previous = v(0.0, 0.25, 5.0);
    p.state.forward = None;
    let wrong = motion(GoRgt, &line(0.0, 0.0, 1.0, 0.0), &[(On, 1, &line(5.0, 0.0, 5.0, 5.0))]);
    let found = offered(&mut p, &wrong, 504);
    let [Remedy { cure: Cure::Direction(vector), end }] = found.as_slice() else { panic!("{found:?}") };
    assert!((vector - v(0.0, 1.0, 0.0)).norm() < 1e-6 && (end.x - 5.0).abs() < 1e-3, "{found:?}");
}

#[test]
fn a_start_out_of_tolerance_is_moved_in_or_tolerated() {
    let drive = line(0.0, 0.0, 1.0, 0.0);
    let command = motion(GoRgt, &drive, &[(On, 1, &line(5.0, 0.0, 5.0, 5.0))]);
    let mut p = Program::new();
    p.cutter(&[0.5]).tolerance(0.0, 0.001).from(0.0, 0.252, 0.0).side(DriveSide::Left);
    let found = offered(&mut p, &command, 503);
    let [first, .., last] = found.as_slice() else { panic!("{found:?}") };
    let Cure::Tolerance { role: RoleName::Drive, inside: false, by, values } = &first.cure else {
        panic!("{found:?}")
    };
    assert!((by - 0.001).abs() < 2e-4 && values.drive >= 0.002 && values.part == 0.001, "{found:?}");
    let Cure::MoveTo { position, by, .. } = &last.cure else { panic!("{found:?}") };
    assert!((position - v(0.0, 0.25, 0.0)).norm() < 1e-6 && (by - 0.002).abs() < 1e-6, "{found:?}");
    // Far out, a tolerance is no cure; the tool end on the line asks for TLON.
    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 0.0, 0.0).side(DriveSide::Left);
    p.state.previous = v(0.0, -1.0, 0.0);
    let found = offered(&mut p, &command, 503);
    assert_eq!(cures(&found)[0], Cure::DriveSide(DriveSide::On), "{found:?}");
    assert!(!cures(&found).iter().any(|cure| matches!(cure, Cure::Tolerance { .. })), "{found:?}");
    // The tool end below the part surface by its height on it: TLONPS.
    let mut p = Program::new();
    p.cutter(&[0.5, 0.25]).from(0.0, 0.25, 0.0).side(DriveSide::Left);
    let tilted = plane(-0.6, 0.0, 0.8, 0.0);
    p.run(&MotionCommand::PartSurface(NamedSurface { name: String::new(), geometry: tilted }));
    let found = offered(&mut p, &command, 502);
    assert!(cures(&found).contains(&Cure::PartSide(PartSide::On)), "{found:?}");
}

#[test]
fn an_unknown_side_is_settled_by_either_surface_vector() {
    let wall = line(3.0, 0.0, 3.0, 5.0);
    let mut p = Program::new();
    p.cutter(&[1.0]).from(3.0, 1.0, 2.0);
    let found = offered(&mut p, &start(&[(To, &wall), (To, &plane(0.0, 0.0, 1.0, 0.0))]), 40);
    let ends: Vec<f64> = found.iter().map(|remedy| remedy.end.x).collect();
    assert!(
        found.iter().all(|one| matches!(one.cure, Cure::SurfaceVector { role: RoleName::Drive, .. })),
        "{found:?}"
    );
    assert!(ends.contains(&2.5) && ends.contains(&3.5), "both sides: {found:?}");
}

#[test]
fn a_start_up_that_misses_is_turned_to_the_surface() {
    let mut p = Program::new();
    p.cutter(&[0.5]).from(0.0, 0.0, 0.0).indirv(1.0, 0.0, 0.0).run(&MotionCommand::NoPartSurface);
    let found = offered(&mut p, &start(&[(To, &circle(5.0, 9.0, 1.0))]), 714);
    let kinds = cures(&found);
    assert!(matches!(kinds[0], Cure::Direction(_)) && kinds[1] == Cure::WithoutDirection, "{found:?}");
    assert!((found[0].end - found[1].end).norm() < 1e-3, "both end at the nearest point: {found:?}");

    let mut p = Program::new();
    p.cutter(&[1.0]).from(0.0, 1.0, 2.0);
    let wall = line(4.0, 0.0, 5.0, 5.0);
    let surfaces = [&wall, &plane(0.0, 0.0, 1.0, 0.0)].map(|geometry| StartSurface {
        relation: To,
        surface: NamedSurface { name: String::new(), geometry: geometry.clone() },
    });
    let found = offered(&mut p, &MotionCommand::Offset(surfaces.to_vec()), 33);
    assert!(matches!(cures(&found)[..], [Cure::Direction(_)]), "{found:?}");
}

#[test]
fn more_points_are_offered_only_if_they_suffice() {
    let command = motion(GoLft, &circle(0.0, 0.0, 2.0), &[(Past, 1, &line(0.0, -9.0, 0.0, 9.0))]);
    let found = |most: u32| {
        let mut p = Program::new();
        p.cutter(&[0.5]).from(5.0, 0.0, 1.0).go(&[(To, &circle(0.0, 0.0, 2.0))]).side(DriveSide::Left);
        p.run(&MotionCommand::MaximumPoints(most));
        offered(&mut p, &command, 803)
    };
    assert!(cures(&found(20)).contains(&Cure::Points(160)), "{:?}", found(20));
    // Where eight times as many are not enough: as many as it takes, in two digits.
    let found = found(2);
    let [Cure::Points(count), ..] = cures(&found)[..] else { panic!("{found:?}") };
    assert!(count > 20 && count < 160, "{count}");
}

#[test]
fn what_cannot_be_cured_gets_no_remedy() {
    let mut p = Program::new();
    p.from(0.0, 2.0, 0.0);
    assert_eq!(offered(&mut p, &start(&[(To, &line(0.0, 0.0, 1.0, 0.0))]), 311), []);
    // Cancelled at once: nothing is tried.
    let mut p = beside();
    let state = p.state.clone();
    let wrong = motion(GoRgt, &line(0.0, 0.0, 1.0, 0.0), &[(To, 1, &line(6.0, 0.0, 6.0, 1.0))]);
    let failure = p.attempt(&wrong).expect_err("must fail");
    assert_eq!(remedies(&state, &wrong, &failure, &|| true), []);
}

#[test]
fn the_next_position_is_offered_where_one_cannot_be_taken() {
    // The first crossing of the circle is not the trouble here, but what a trouble with it suggests must work.
    let mut p = beside();
    let command = motion(GoLft, &line(0.0, 0.0, 1.0, 0.0), &[(On, 1, &circle(6.0, 0.5, 1.0))]);
    let iteration = crate::error::Iteration::ThreeSurfaces;
    let failure = crate::error::MotionFailure::IterationLimit { iteration, limit: 60, tip: p.tip() };
    let found = remedies(&p.state, &command, &failure, &|| false);
    assert_eq!(cures(&found), [Cure::Occurrence { check: 0, occurrence: 2 }]);
    p.run(&command);
    assert!(p.tip().x < 6.0 && found[0].end.x > 6.0, "{found:?}");
    // TO a wall: past it the same way.
    let mut p = beside();
    let command = motion(GoLft, &line(0.0, 0.0, 1.0, 0.0), &[(To, 1, &line(6.0, 0.0, 6.0, 1.0))]);
    let found = remedies(&p.state, &command, &failure, &|| false);
    assert_eq!(cures(&found), [Cure::Relation { check: 0, relation: Past }]);
    p.run(&command);
    assert!((found[0].end.x - p.tip().x - 0.5).abs() < 1e-9, "{found:?}");
}

#[test]
fn a_later_crossing_in_the_motion_before_is_found() {
    let (round, upright, above) =
        (circle(0.0, 0.0, 2.0), line(1.0, -9.0, 1.0, 9.0), line(-9.0, 6.0, 9.0, 6.0));
    let mut p = Program::new();
    p.cutter(&[0.5]).from(-5.0, 0.0, 0.0).go(&[(To, &round)]).side(DriveSide::Left);
    let (state, first) = (p.state.clone(), motion(GoLft, &round, &[(On, 1, &upright)]));
    p.run(&first);
    let between = [MotionCommand::DriveSide(DriveSide::On)];
    p.run(&between[0]);
    let second = motion(GoRgt, &upright, &[(To, 1, &above)]);
    let failure = p.attempt(&second).expect_err("it leads down");
    let before = Earlier { state: &state, command: &first, between: &between };
    let mut carry_out = |state: &State, command: &MotionCommand| Some(execute(state, command, &|| false));
    let found = earlier(before, &second, &failure, &mut carry_out).expect("a remedy");
    assert_eq!(found.cure, Cure::EarlierOccurrence { check: 0, occurrence: 2 });
    assert!((found.end - v(1.0, 5.75, 0.0)).norm() < 1e-9, "{found:?}");
    // Cancelled, or with a failure that has nothing to do with places: none.
    assert_eq!(earlier(before, &second, &failure, &mut |_, _| None), None);
    let other = crate::error::MotionFailure::NoCutter { start_up: false };
    assert_eq!(earlier(before, &second, &other, &mut carry_out), None);
}

#[test]
fn a_start_up_with_several_answers_is_named_and_a_direction_settles_it() {
    let floor = plane(0.0, 0.0, 1.0, 0.0);
    let (axis, ring, right) = (line(-9.0, 0.0, 9.0, 0.0), circle(0.0, 0.0, 2.0), circle(3.0, 0.0, 2.0));
    let hollow = crate::tests::sphere(0.0, 0.0, 2.5, 4.0);
    let oval = crate::tests::quadric([1.0 / 16.0, 0.25, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    // Both crossings of line and circle, from the middle between them; of two circles; all around the centre of a circle, on
    // the axis of a sphere; both sides of an ellipse.
    for (from, surfaces) in [
        (v(0.0, 5.0, 0.0), vec![(On, &axis), (To, &floor), (On, &ring)]),
        (v(0.0, 3.0, 0.0), vec![(To, &ring), (To, &floor), (To, &axis)]),
        (v(1.5, 0.0, 0.0), vec![(On, &ring), (To, &floor), (On, &right)]),
        (v(0.0, 0.0, 0.0), vec![(To, &ring)]),
        (v(0.0, 0.0, 1.0), vec![(To, &ring), (To, &floor)]),
        (v(0.0, 0.0, 0.0), vec![(To, &hollow)]),
        (v(0.0, 0.0, 0.0), vec![(To, &oval), (To, &floor)]),
    ] {
        let mut p = Program::new();
        p.cutter(&[0.5]).from(from.x, from.y, from.z);
        let (state, command) = (p.state.clone(), start(&surfaces));
        let failure = p.attempt(&command).expect_err("several answers");
        let crate::error::MotionFailure::StartUpAmbiguous { places } = failure else {
            panic!("{surfaces:?}: {failure:?}")
        };
        let far = places.map(|place| (place - from).norm());
        assert!((far[0] - far[1]).abs() < 1e-6 && (places[0] - places[1]).norm() > 1.0, "{places:?}");
        let found = remedies(&state, &command, &failure, &|| false);
        assert_eq!(found.len(), 2, "{surfaces:?}: {found:?}");
        for (remedy, place) in found.iter().zip(places) {
            assert!(matches!(remedy.cure, Cure::Direction(_)), "{found:?}");
            assert!((remedy.end - place).norm() < 0.01, "{surfaces:?}: {remedy:?}, not {place:?}");
        }
        // A little nearer to one of them there is no doubt.
        let nearer = from + (places[1] - from) * 0.01;
        let mut p = Program::new();
        p.cutter(&[0.5]).from(nearer.x, nearer.y, nearer.z).run(&command);
        assert!((p.tip() - places[1]).norm() < 0.05, "{:?}", p.tip());
    }
}

/// The direction to an answer leads elsewhere, for along it the tool meets the drive surface at another place.
#[test]
fn each_answer_of_a_start_up_gets_a_remedy_that_leads_to_it() {
    let floor = plane(0.0, 0.0, 1.0, 0.0);
    let (axis, ring) = (line(0.0, 0.0, 10.0, 0.0), circle(0.0, 0.0, 2.0));
    let peak = crate::tests::cone(v(0.0, 0.0, 3.0), v(0.0, 0.0, -1.0), 30.0);
    for (cutter, from, surfaces) in [
        (&[0.5][..], v(0.0, 1.0, 3.0), vec![(To, &axis), (To, &floor), (To, &ring)]),
        (&[0.5, 0.25], v(0.0, 0.0, 6.0), vec![(To, &peak), (To, &floor)]),
    ] {
        let mut p = Program::new();
        p.cutter(cutter).from(from.x, from.y, from.z);
        let (state, command) = (p.state.clone(), start(&surfaces));
        let failure = p.attempt(&command).expect_err("several answers");
        let crate::error::MotionFailure::StartUpAmbiguous { places } = failure else {
            panic!("{surfaces:?}: {failure:?}")
        };
        let found = remedies(&state, &command, &failure, &|| false);
        assert_eq!(found.len(), 2, "{surfaces:?}: {found:?}");
        for (remedy, place) in found.iter().zip(places) {
            assert!((remedy.end - place).norm() < 0.05, "{surfaces:?}: {remedy:?}, not {place:?}");
        }
    }
}

/// Trying the cures of a motion may ask as often as the motion did, and some times more, on every machine.
#[test]
fn cures_are_tried_with_a_patience_that_depends_on_the_motion_alone() {
    let asked = |patience: Patience| {
        let limit = patience.limit(&|| false);
        (0..100_000).take_while(|_| !limit()).count()
    };
    assert_eq!([0, 50, 5_000].map(|before| asked(Patience::after(before))), [15_000, 15_100, 25_000]);
    assert!(Patience::after(50).limit(&|| true)());
    // Which cures are offered is a matter of that: those found by then.
    let mut p = beside();
    let state = p.state.clone();
    let wrong = motion(GoRgt, &line(0.0, 0.0, 1.0, 0.0), &[(To, 1, &line(6.0, 0.0, 6.0, 1.0))]);
    let failure = p.attempt(&wrong).expect_err("must fail");
    let within = |questions: u32| {
        let left = Cell::new(questions);
        remedies(&state, &wrong, &failure, &|| left.replace(left.get().saturating_sub(1)) == 0).len()
    };
    assert_eq!([0, 1, 10_000].map(within), [0, 0, 1]);
}
