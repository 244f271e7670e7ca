//! What motions cost, counted in clearances: linear in their cut vectors, and never many between two questions whether to
//! go on.

use std::cell::Cell;

use apt_geometry::{
    canonical::{Remembering, RuledSurface},
    motion::ToolAxis,
};

use super::{
    sheets::{ruled, twisted_to},
    turning::waves_across,
    *,
};
use crate::{
    clearance::{BOXES, EVALUATIONS, FLOORS, JUDGED, STEPS},
    verify::{
        VerifyError, WORK,
        tests::{lofted, lofts},
        verify,
    },
};

/// Clearances that the engine may compute before it asks again whether to go on. The slowest of them, on quadrics, take a
/// microsecond in a release build: 5 ms are thousands of them.
const BETWEEN_QUESTIONS: u64 = 1500;

/// Surfaces of every kind with a clearance of its own, and the side that the tool comes from.
fn parts() -> Vec<(&'static str, Geometry)> {
    vec![
        ("sphere", sphere(0.0, 0.0, 0.0, 3.0)),
        ("bowl", sphere(0.0, 0.0, 9.0, 6.0)),
        ("cylinder", cylinder(Vec3::zeros(), v(0.2, 1.0, 0.1), 3.0)),
        ("hollow cylinder", cylinder(v(0.0, 0.0, 9.0), v(0.2, 1.0, 0.1), 6.0)),
        ("cone", cone(v(0.0, 0.0, 3.0), v(0.1, 0.1, -1.0), 50.0)),
        ("ellipsoid", quadric([1.0 / 16.0, 1.0 / 9.0, 0.25, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])),
        ("dish", quadric([0.1, 0.05, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5])),
        ("saddle", quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5])),
    ]
}

const CUTTERS: [&[f64]; 2] = [&[0.5, 0.25], &[0.5, 0.1]];
/// A corner that touches neither of its slanted lines.
const SEVEN_NUMBERS: &[f64] = &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0];

/// A pass over a part surface, ready for its last command.
fn pass(part: &Geometry, cutter: &[f64], step: f64) -> (Program, MotionCommand) {
    let drive = plane(0.0, 1.0, 0.0, 0.4);
    let wall = |x: f64| plane(1.0, 0.0, 0.0, x);
    let mut p = Program::new();
    p.tolerance(0.0, 1e-3).cutter(cutter);
    p.run(&MotionCommand::MaximumPoints(100_000)).run(&MotionCommand::MaximumStep(step));
    p.from(-1.5, 0.4, 6.0);
    p.go(&[(Relation::On, &drive), (Relation::To, part), (Relation::On, &wall(-1.2))]);
    p.indirv(1.0, 0.0, 0.0).side(DriveSide::On);
    let check =
        CheckSurface { relation: Relation::On, occurrence: 1, surface: named(&wall(1.2)), label: None };
    (p, MotionCommand::Drive { turn: Turn::Forward, drive: named(&drive), checks: vec![check] })
}

/// Number of cut vectors and of clearances.
fn cost(part: &Geometry, cutter: &[f64], step: f64) -> (usize, u64) {
    let (mut p, command) = pass(part, cutter, step);
    let before = EVALUATIONS.get();
    p.run(&command);
    (p.last().points.len(), EVALUATIONS.get() - before)
}

#[test]
fn cost_is_linear_in_the_number_of_cut_vectors() {
    for (name, part) in parts() {
        for cutter in CUTTERS {
            let ((few, little), (many, much)) = (cost(&part, cutter, 0.02), cost(&part, cutter, 0.0025));
            assert!(many >= 7 * few, "{name}: {many} and {few} vectors");
            let each = [little as f64 / few as f64, much as f64 / many as f64];
            assert!(each[1] <= 1.15 * each[0], "{name}, cutter {cutter:?}: {each:?} clearances a vector");
            assert!(each[1] <= 30.0, "{name}, cutter {cutter:?}: {each:?} clearances a vector");
        }
    }
}

/// Where a path begins to bend the other way, as where contact jumps from one part of the tool to another, few vectors are tried in vain;
/// and where a slanted bottom rolls on a place of the surface, one bound serves all of a vector.
#[test]
fn changes_of_the_bend_take_few_clearances() {
    let saddle = quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5]);
    let parts = [("saddle", saddle, 22.0), ("roof", lofts::roof(), 20.0), ("vault", lofts::vault(), 20.0)];
    for (name, part, most) in parts {
        let (mut p, command) = pass(&part, SEVEN_NUMBERS, 10.0);
        let before = EVALUATIONS.get();
        p.run(&command);
        let each = (EVALUATIONS.get() - before) as f64 / p.last().points.len() as f64;
        assert!(each <= most, "{name}: {each} clearances a vector");
    }
}

/// Functions made from the contacts at both ends of a stretch and in its middle show all of a vector; pieces of it take them again and again.
#[test]
fn few_circles_are_bounded_for_a_vector_over_a_quadric() {
    for (name, part) in parts() {
        for cutter in CUTTERS {
            let (mut p, command) = pass(&part, cutter, 10.0);
            let before = FLOORS.get();
            p.run(&command);
            let each = (FLOORS.get() - before) as f64 / p.last().points.len() as f64;
            assert!(each <= 200.0, "{name}, cutter {cutter:?}: {each} bounds a vector");
        }
    }
}

/// Where functions made from contacts show a vector no bound of the bend of all distances is searched for; and one for a part of a stretch does not
/// take the place of that for all of it, which serves the next vectors, too.
#[test]
fn few_boxes_are_looked_at_for_a_vector_over_a_saddle() {
    let (name, part) = parts().pop().expect("the saddle");
    for cutter in CUTTERS.into_iter().chain([SEVEN_NUMBERS]) {
        let (mut p, command) = pass(&part, cutter, 10.0);
        let before = BOXES.get();
        p.run(&command);
        let each = (BOXES.get() - before) as f64 / p.last().points.len() as f64;
        assert!(each <= 3.0, "{name}, cutter {cutter:?}: {each} boxes a vector");
    }
}

/// Contact is followed from where it was, on the axis, too; another piece of the tool is asked again where it can have come near; and a search that
/// leaves its piece ends.
#[test]
fn few_steps_lead_to_the_contacts_of_a_vector_over_a_saddle() {
    let (name, part) = parts().pop().expect("the saddle");
    for (cutter, most) in [(CUTTERS[0], 19.0), (CUTTERS[1], 36.0), (SEVEN_NUMBERS, 90.0)] {
        let (mut p, command) = pass(&part, cutter, 10.0);
        let before = STEPS.get();
        p.run(&command);
        let each = (STEPS.get() - before) as f64 / p.last().points.len() as f64;
        assert!(each <= most, "{name}, cutter {cutter:?}: {each} steps a vector");
    }
}

#[test]
fn the_engine_asks_often_whether_to_go_on() {
    for (name, part) in parts() {
        for cutter in CUTTERS {
            let (p, command) = pass(&part, cutter, 10.0);
            let (last, longest) = (Cell::new(EVALUATIONS.get()), Cell::new(0));
            let ask = || {
                let now = EVALUATIONS.get();
                longest.set(longest.get().max(now - last.get()));
                last.set(now);
                false
            };
            let execution = execute(&p.state, &command, &ask);
            assert!(execution.failure.is_none(), "{name}: {:?}", execution.failure);
            let longest = longest.get().max(EVALUATIONS.get() - last.get());
            assert!(longest > 0 && longest <= BETWEEN_QUESTIONS, "{name}, cutter {cutter:?}: {longest}");
        }
    }
}

/// Patches of the tool that the engine may look at before it asks again, and clearances that it may ask for once it is told to give up: these
/// are then found without a search. A patch takes some microseconds, a search without an end a thousand of them.
const PATCHES_BETWEEN_QUESTIONS: u64 = 40;
const AFTER_THE_LAST: u64 = 200;

#[test]
fn the_engine_asks_often_during_its_proofs() {
    let mut most = 0;
    for (name, part) in [("twisted", twisted_to(0.0)), ("vault", lofts::vault()), ("waves", waves_across())] {
        for cutter in [&[0.5][..], CUTTERS[1], SEVEN_NUMBERS] {
            let (p, command) = pass(&part, cutter, 10.0);
            let (last, longest) = (Cell::new(JUDGED.get()), Cell::new(0));
            let (asked, limit) = (Cell::new(0), Cell::new(u64::MAX));
            let ask = || {
                longest.set(longest.get().max(JUDGED.get() - last.replace(JUDGED.get())));
                asked.set(asked.get() + 1);
                asked.get() > limit.get()
            };
            let execution = execute(&p.state, &command, &ask);
            assert!(execution.failure.is_none(), "{name}, cutter {cutter:?}: {:?}", execution.failure);
            most = most.max(longest.get());
            // What is known of the surface by now is not looked for again.
            asked.set(0);
            execute(&p.state, &command, &ask);
            let all = asked.get();
            for share in [0, 1, all / 3, all / 2, all - 1] {
                asked.set(0);
                limit.set(share);
                let before = Cell::new(0);
                let execution = execute(&p.state, &command, &|| {
                    before.set(EVALUATIONS.get());
                    ask()
                });
                assert!(
                    matches!(execution.failure, Some(MotionFailure::Cancelled)),
                    "{name}: {:?}",
                    execution.failure
                );
                assert_eq!(asked.get(), share + 1, "{name}: asked again after the answer");
                let after = [EVALUATIONS.get() - before.get(), JUDGED.get() - last.get()];
                assert!(
                    after[0] <= AFTER_THE_LAST && after[1] == 0,
                    "{name}, {cutter:?}: {after:?}, {share}"
                );
            }
        }
    }
    assert!(most > 0 && most <= PATCHES_BETWEEN_QUESTIONS, "{most} patches");
}

/// Patches of the tool that may be looked at for one of the motions below; 30,000 were when how the
/// surface bends along its rulings was told by forms with one error for all directions.
const PATCHES_ALONG_RULINGS: u64 = 100;
/// Questions that the verifier may ask about one of them; 3,500 where slopes are taken from readings beside each.
const QUESTIONS_ALONG_RULINGS: u64 = 1500;

/// The flank of a tool whose axis goes along the rulings of a wall that is slightly twisted lies along that: balls about the axis show where
/// it is nearest, also if that is where the flank begins; and the verifier's readings tell by the place that touches how they change.
#[test]
fn a_flank_along_rulings_takes_few_patches() {
    let section = |y: f64, radius: f64, ends: [Vec3; 2]| {
        let tube = cylinder(v(0.0, y, 0.0), Vec3::z(), radius);
        let [first, last] = ends.map(Geometry::Point);
        [tube, first, last, Geometry::Vector(-Vec3::y())]
    };
    let lower = section(6.0, 9.3, [v(-4.0, -3.0, -1.0), v(4.0, -3.0, -1.0)]);
    let upper = section(7.0, 9.8, [v(-4.0, -2.6, 3.0), v(4.0, -2.6, 3.0)]);
    let parts = lower.into_iter().chain(upper).collect();
    let wall = Geometry::RuledSurface(Remembering::new(RuledSurface { parts }));
    for cutter in [&[0.75][..], &[0.5, 0.25], &[1.0, 0.2]] {
        let mut p = Program::new();
        p.tolerance(1e-3, 1e-3).cutter(cutter).from(-1.5, -6.0, 4.0);
        p.run(&MotionCommand::ToolAxis(ToolAxis::Parallel { part: false }));
        p.go(&[(Relation::To, &wall), (Relation::To, &ground()), (Relation::On, &x(-1.5))]);
        p.indirv(1.0, 0.0, 0.0).side(DriveSide::Right);
        let before = JUDGED.get();
        p.drive(Turn::Forward, &wall, Relation::On, &x(1.5));
        let count = JUDGED.get() - before;
        assert!(count <= PATCHES_ALONG_RULINGS, "{cutter:?}: {count} patches");
        let asked = Cell::new(0);
        let ask = || {
            asked.set(asked.get() + 1);
            false
        };
        assert!(verify(p.last(), &ask).expect("evidence").verified);
        assert!(asked.get() <= QUESTIONS_ALONG_RULINGS, "{cutter:?}: {} questions", asked.get());
    }
}

/// Clearances that may be computed for the motion below.
const CLEARANCES_ALONG_A_RULING: u64 = 200;

/// A flank goes along a ruling of a cone that leans, towards its vertex: contact goes up the flank, nothing turns, and the clearance stays what it is. The
/// ruling shows that it is nowhere greater, and the cone that it is nowhere less, on all of a vector at once.
#[test]
fn a_flank_along_a_leaning_ruling_takes_few_clearances() {
    let tube = cylinder(Vec3::zeros(), Vec3::x(), 3.0);
    let [first, last, vertex] =
        [v(0.0, -2.4, -1.8), v(0.0, -2.4, 1.8), v(8.0, 0.0, 1.0)].map(Geometry::Point);
    let parts = vec![tube, first, last, Geometry::Vector(-Vec3::y()), vertex];
    let wall = Geometry::RuledSurface(Remembering::new(RuledSurface { parts }));
    let floor = plane(0.0, 0.0, 1.0, -1.0);
    let mut p = Program::new();
    p.tolerance(5e-4, 1e-4).cutter(&[0.34, 0.17]).from(0.5, -4.0, 2.0);
    p.go(&[(Relation::To, &wall), (Relation::To, &floor), (Relation::On, &x(0.5))]);
    p.indirv(1.0, 0.0, 0.0).side(DriveSide::Right);
    let before = EVALUATIONS.get();
    p.drive(Turn::Forward, &wall, Relation::On, &x(7.8));
    let count = EVALUATIONS.get() - before;
    assert_eq!(p.last().points.len(), 1);
    assert!(count <= CLEARANCES_ALONG_A_RULING, "{count} clearances");
    assert!(verify(p.last(), &|| false).expect("evidence").verified);
}

/// Distances of points and parts of surfaces that the verifier may look at before it asks again. One takes up to a microsecond
/// in a release build.
const WORK_BETWEEN_QUESTIONS: u64 = 1000;

/// Readings of a motion besides those at its positions: of the extremes of both roles, and of the check surface.
const READINGS_OF_EXTREMES: usize = 40;

#[test]
fn the_verifier_asks_often_whether_to_go_on() {
    let [ruled, polyconic] = lofted();
    let searched = [("tabulated cylinder", waves_across()), ("ruled", ruled), ("polyconic", polyconic)];
    let cutters = [CUTTERS[0], CUTTERS[1], SEVEN_NUMBERS];
    for (name, part) in parts().into_iter().chain(searched) {
        for cutter in cutters {
            let (mut p, command) = pass(&part, cutter, 0.2);
            p.run(&command);
            let (last, longest) = (Cell::new(WORK.get()), Cell::new(0));
            let (asked, limit) = (Cell::new(0), Cell::new(u64::MAX));
            let ask = || {
                let now = WORK.get();
                longest.set(longest.get().max(now - last.get()));
                last.set(now);
                asked.set(asked.get() + 1);
                asked.get() > limit.get()
            };
            let evidence = verify(p.last(), &ask).expect("evidence");
            assert!(evidence.verified, "{name}, cutter {cutter:?}: {evidence:?}");
            let longest = longest.get().max(WORK.get() - last.get());
            assert!(longest <= WORK_BETWEEN_QUESTIONS, "{name}, cutter {cutter:?}: {longest}");
            // Given up at any question, it does no more; what is known of the surface by now is not looked for again.
            asked.set(0);
            verify(p.last(), &ask).expect("evidence");
            let all = asked.get();
            for share in [0, 1, all / 3, all / 2, all - 1] {
                asked.set(0);
                limit.set(share);
                assert_eq!(verify(p.last(), &ask), Err(VerifyError::Cancelled), "{name}, cutter {cutter:?}");
                let after = WORK.get() - last.get();
                assert!(after <= WORK_BETWEEN_QUESTIONS, "{name}, cutter {cutter:?}: {after} after {share}");
            }
        }
    }
}

/// The passes over all parts with all cutters, each with its name.
fn passes() -> impl Iterator<Item = (String, Program)> {
    let of_part = |(name, part): (&'static str, Geometry)| {
        CUTTERS.into_iter().chain([SEVEN_NUMBERS]).map(move |cutter| {
            let (mut p, command) = pass(&part, cutter, 0.02);
            p.run(&command);
            (format!("{name}, cutter {cutter:?}"), p)
        })
    };
    parts().into_iter().flat_map(of_part)
}

/// What the readings at the ends of a vector show to be within the band is not read between them: each role is read once at each position,
/// and looked at on the two vectors on which it is least and greatest.
#[test]
fn the_verifier_reads_little_between_vertices() {
    for (name, p) in passes() {
        let asked = Cell::new(0);
        let ask = || {
            asked.set(asked.get() + 1);
            false
        };
        let evidence = verify(p.last(), &ask).expect("evidence");
        assert!(evidence.verified, "{name}: {evidence:?}");
        let positions = p.last().points.len() + 1;
        // Both roles, and the check surface at the end and along the last vector.
        let most = 2 * positions + READINGS_OF_EXTREMES;
        assert!(asked.get() <= most, "{name}: {} of {positions}", asked.get());
    }
}

/// Of the circles of a tool, of which a cutter of seven numbers has five, the one that touches is asked first but about where contact goes over
/// from one to another.
#[test]
fn the_verifier_expects_the_circle_that_touches() {
    for (name, p) in passes() {
        let before = WORK.get();
        assert!(verify(p.last(), &|| false).expect("evidence").verified, "{name}");
        let each = (WORK.get() - before) as f64 / p.last().points.len() as f64;
        assert!(each <= 2.0, "{name}: {each} circles a vector");
    }
}

#[test]
fn a_cancelled_motion_computes_nothing_more() {
    for (name, part) in parts() {
        let (p, command) = pass(&part, CUTTERS[1], 0.02);
        let (questions, at) = (Cell::new(0), Cell::new(0));
        let ask = || {
            questions.set(questions.get() + 1);
            at.set(EVALUATIONS.get());
            questions.get() >= 5
        };
        let execution = execute(&p.state, &command, &ask);
        assert!(
            matches!(execution.failure, Some(MotionFailure::Cancelled)),
            "{name}: {:?}",
            execution.failure
        );
        assert_eq!(questions.get(), 5, "{name}: asked again after the answer");
        assert_eq!(EVALUATIONS.get(), at.get(), "{name}");
    }
}

/// Along its straight lines a hyperbolic cylinder does not change, however long the vectors and fine the band are.
#[test]
fn vectors_along_generators_cost_little() {
    let wall = quadric([1.0, -1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let (drive, level) = (plane(0.0, 1.0, 0.0, 0.3), |z: f64| plane(0.0, 0.0, 1.0, z));
    for cutter in [&[0.5, 0.25][..], &[0.5, 0.1], &[1.0, 0.1875, 0.33, 0.22, 11.0, 5.0, 3.0]] {
        let mut p = Program::new();
        p.tolerance(5e-4, 0.0).cutter(cutter);
        let axis = Some(v(1.0, 0.2, 0.3).normalize());
        p.run(&MotionCommand::From { position: v(3.0, 0.3, 0.0), axis, name: String::new() });
        p.go(&[(Relation::On, &drive), (Relation::To, &wall), (Relation::On, &level(0.0))]);
        p.indirv(0.0, 0.0, -1.0).side(DriveSide::On);
        let before = EVALUATIONS.get();
        p.drive(Turn::Forward, &drive, Relation::On, &level(-100.0));
        let (vectors, clearances) = (p.last().points.len(), EVALUATIONS.get() - before);
        assert!(vectors <= 12, "cutter {cutter:?}: {vectors} vectors");
        assert!(clearances <= 5000, "cutter {cutter:?}: {clearances}");
        p.verified();
    }
}

/// Distances and parts of a surface that the verifier may look at for all of a motion along a strip.
const STRIP_WORK: u64 = 500_000;

/// Over a twisted strip of straight lines the contact of a slanted bottom jumps from its tip to its edge.
#[test]
fn the_verifier_looks_at_little_where_contact_jumps_on_a_twisted_strip() {
    let (strip, drive) = (twisted_to(0.0), y(2.0));
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(SEVEN_NUMBERS).from(1.0, 2.0, 4.0);
    p.go(&[(Relation::On, &drive), (Relation::To, &strip), (Relation::On, &x(1.0))]);
    p.side(DriveSide::On).drive(Turn::Right, &drive, Relation::On, &x(5.0));
    let before = WORK.get();
    let evidence = verify(p.last(), &|| WORK.get() - before > STRIP_WORK).expect("evidence");
    assert!(evidence.verified, "{evidence:?}");
}

/// Distances and parts of a surface that the verifier may look at for each vector of a line along the hollow of a saddle.
const LINE_WORK: u64 = 2_000;

/// Along its hollow a saddle falls away from a line across the way alone: the readings at the ends of a vector show all of it.
#[test]
fn the_verifier_looks_at_little_where_a_line_goes_along_the_hollow_of_a_saddle() {
    let place = |c: f64, t: f64| v(0.5 * (t + c), -0.05 * c * t, 0.5 * (t - c));
    let curve = |c: f64| (plane(1.0, 0.0, -1.0, c), place(c, -6.0), place(c, 6.0), v(1.0, 0.0, -1.0));
    let wall = ruled([curve(-4.0), curve(4.0)]);
    let mut p = Program::new();
    p.tolerance(2e-5, 0.0).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0]).from(-2.0, -1.0, -0.8);
    p.go(&[(Relation::To, &wall), (Relation::On, &level(-1.0)), (Relation::On, &x(-2.0))]);
    p.indirv(1.0, 0.0, 0.0).side(DriveSide::Right).drive(Turn::Forward, &wall, Relation::On, &x(2.0));
    let before = WORK.get();
    let evidence = verify(p.last(), &|| false).expect("evidence");
    assert!(evidence.verified, "{evidence:?}");
    let each = (WORK.get() - before) / p.last().points.len() as u64;
    assert!(each <= LINE_WORK, "{each} for each of {}", p.last().points.len());
}

/// Proven clearances that a start-up without a position may ask for.
const VAIN_START: u64 = 500;

/// The tool end cannot be on a small ball while the tool touches a strip far below it.
#[test]
fn a_start_up_without_a_position_proves_few_clearances() {
    let (strip, ball) = (twisted_to(0.0), sphere(3.0, 2.0, 8.0, 0.5));
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[1.0, 0.25]).from(2.5, 2.2, 6.0);
    let before = EVALUATIONS.get();
    let failure =
        p.attempt(&start(&[(Relation::On, &ball), (Relation::To, &strip), (Relation::On, &x(3.1))]));
    let clearances = EVALUATIONS.get() - before;
    assert!(matches!(failure, Err(MotionFailure::StartUpDiverges { .. })), "{failure:?}");
    assert!(clearances <= VAIN_START, "{clearances}");
}

/// Where the path is parallel to a ruled surface is closed in along the last contacts, on the side of the surface on which the tool is. What
/// is known of contact is not lost on the way.
#[test]
fn a_tangency_takes_few_clearances() {
    let section = |y: f64| {
        let ends = [v(-1.8, y, 2.0 - 0.76_f64.sqrt()), v(0.0, y, 0.0)].map(Geometry::Point);
        let trough = cylinder(v(0.0, 0.0, 2.0), Vec3::y(), 2.0);
        [trough].into_iter().chain(ends).chain([Geometry::Vector(-Vec3::z())])
    };
    let parts = section(-1.0).chain(section(5.0)).collect();
    let valley = Geometry::RuledSurface(Remembering::new(RuledSurface { parts }));
    let wall = plane(0.0, 1.0, 0.0, 2.0);
    let mut p = Program::new();
    p.tolerance(0.0, 1e-3).cutter(&[0.5, 0.25]).from(3.0, 0.0, 1.0);
    p.go(&[(Relation::To, &wall), (Relation::To, &ground()), (Relation::On, &x(2.0))]);
    p.indirv(-1.0, 0.0, 0.0).side(DriveSide::Right);
    let before = EVALUATIONS.get();
    p.drive(Turn::Forward, &wall, Relation::TangentToPart, &valley).ends(0.0, 1.75, 0.0, 1e-3).verified();
    let count = EVALUATIONS.get() - before;
    assert!(count <= 500, "{count} clearances");
}

/// Twice what two looks ahead take, one each way, as far as a motion is looked along that may have few cut vectors. As far as the
/// longest are, they take millions.
const LOOKS_BOTH_WAYS: u64 = 18_000;

/// In a bowl the path leads ever more steeply along the check surface, and away from it. A position to go to hangs on no count of
/// cut vectors, so that no way is looked along for the sake of that.
#[test]
fn a_start_up_without_a_tangency_takes_few_clearances() {
    let bowl = quadric([1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0]);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(-2.0, 0.5, 4.0);
    let go = start(&[(Relation::On, &y(0.5)), (Relation::To, &bowl), (Relation::TangentToDrive, &x(-2.0))]);
    let before = EVALUATIONS.get();
    let failure = p.attempt(&go);
    let count = EVALUATIONS.get() - before;
    assert!(matches!(failure, Err(MotionFailure::NotTangent { .. })), "{failure:?}");
    assert!(count <= LOOKS_BOTH_WAYS, "{count} clearances");
}
