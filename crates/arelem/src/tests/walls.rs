//! Ruled walls along which the flank of the tool lies: flat ones, fans that end beside the tool, and walls whose rulings are nearly along
//! it.

use apt_geometry::canonical::{Remembering, RuledSurface};

use Relation::{On, To};
use Turn::Forward;

use super::{
    ends::limited,
    refused::{AMPLE, Found},
    *,
};
use crate::{error::RoleName, verify::verify};

/// The straight curve of a ruled surface between two points, in the plane square to a direction across it.
fn straight(ends: [Vec3; 2], across: Vec3) -> Vec<Geometry> {
    let surface = Geometry::Plane(Plane { normal: across, distance: across.dot(&ends[0]) });
    vec![surface, Geometry::Point(ends[0]), Geometry::Point(ends[1]), Geometry::Vector(across)]
}

fn ruled(parts: Vec<Geometry>) -> Geometry {
    Geometry::RuledSurface(Remembering::new(RuledSurface { parts }))
}

/// A fan of rulings in the plane y = 0, from a base below to an apex at x 5, z 3.
fn fan() -> Geometry {
    let mut parts = straight([v(0.0, 0.0, -4.0), v(10.0, 0.0, -4.0)], v(0.0, 1.0, 0.0));
    parts.push(Geometry::Point(v(5.0, 0.0, 3.0)));
    ruled(parts)
}

/// The outcome of a motion that is proven, with no more than so many clearances.
fn proven(p: &Program, motion: &MotionCommand, most: u64) -> CutSequence {
    let (execution, taken) = limited(p, motion, most);
    let Some(Output::Sequence(sequence)) = execution.output else {
        panic!("{:?} after {taken} clearances", execution.failure);
    };
    let evidence = verify(&sequence, &|| false).expect("evidence");
    assert!(evidence.verified, "{:?}", evidence.violations);
    sequence
}

/// The last rulings of the fan's extension slant down from its apex on both sides, and the tool is higher than that. It is beside the end
/// of the wall, which it touches below, and goes along it.
#[test]
fn a_tool_goes_along_a_fan_that_ends_beside_it() {
    let fan = fan();
    for (axis, numbers) in [
        (Vec3::z(), [0.5, 0.0, 0.25, 0.0, 0.0, 0.0, 5.0]),
        (v(0.3, 0.0, 1.0).normalize(), [0.5, 0.25, 0.0, 0.25, 0.0, 0.0, 6.0]),
    ] {
        let mut p = Program::new();
        p.tolerance(0.0005, 0.0).cutter(&numbers);
        p.run(&MotionCommand::From { position: v(1.0, 3.0, 0.5), axis: Some(axis), name: String::new() });
        p.go(&[(To, &fan), (To, &ground()), (On, &x(1.0))]).side(DriveSide::Right).indirv(1.0, 0.0, 0.0);
        let sequence = proven(&p, &motion(Forward, &fan, &[(On, 1, &x(4.0))]), 2_000);
        assert!(sequence.points.len() <= 2, "{} cut vectors about {axis}", sequence.points.len());
    }
}

/// The tool lies along its way and is a little inside the wall. Its top comes to the end of that first, where nothing holds it any more: it
/// is told at once, and vectors do not creep there.
#[test]
fn the_end_of_a_wall_that_a_tool_lies_along_is_told_soon() {
    let up = v(0.0, 0.0, 5.0);
    let lines = [v(0.0, 0.0, 0.0), v(10.0, 0.0, 0.0)];
    let mut parts = straight(lines, Vec3::y());
    parts.extend(straight(lines.map(|end| end + up), Vec3::y()));
    let wall = ruled(parts);
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[0.5, 0.0, 0.25, 0.0, 0.0, 0.0, 5.0]);
    p.run(&MotionCommand::From {
        position: v(30.0, 3.0, 2.0),
        axis: Some(v(1.0, 0.0, 0.00002).normalize()),
        name: String::new(),
    });
    p.go(&[(To, &wall), (To, &ground()), (On, &x(30.0))]).side(DriveSide::Right).indirv(1.0, 0.0, 0.0);
    let (execution, taken) = limited(&p, &motion(Turn::Up, &wall, &[(On, 1, &x(900.0))]), 3_000);
    let failure = execution.failure.expect("no way there");
    assert!(
        matches!(failure, MotionFailure::SurfaceEnds { role: RoleName::Drive, .. }),
        "{failure:?} {taken}"
    );
}

/// Contact goes along all of the flank within a vector, because the surface bends hardly along it: what is shown of it patch by patch is
/// shown by how little that is.
#[test]
fn contact_that_sweeps_a_flank_along_nearly_straight_lines_is_proven() {
    let arc = |point: Vec3, radius: f64, ends: [Vec3; 2]| {
        let axis = v(-0.9239060297164301, -0.28801009575677516, -0.2518885328787243);
        let across = v(-0.16702012913878134, -0.288715591076561, 0.9427341003335866);
        vec![
            Geometry::Circle(Cylinder { point, axis, radius }),
            Geometry::Point(ends[0]),
            Geometry::Point(ends[1]),
            Geometry::Vector(across),
        ]
    };
    let mut parts = arc(
        v(7.152296817778105, 2.2133096877346192, -2.7315307090399905),
        6.080062123023011,
        [
            v(10.536195637044345, -1.8969587185564871, 1.466335156972502),
            v(7.782266955718407, 5.407586681503332, 3.2154758936301695),
        ],
    );
    parts.extend(arc(
        v(7.395776147614049, 2.63419475704323, -4.1058337235705595),
        7.24172993298739,
        [
            v(4.992759458745764, -3.6250192930971377, -0.0449960402998435),
            v(2.2388307774198264, 3.6795261069626815, 1.7041446963578242),
        ],
    ));
    let wall = ruled(parts);
    let part = plane(-0.9999532027566644, -0.009674311173886362, 0.0, -1.8526194453435183);
    let first = plane(0.009638276591321769, -0.9962286072171889, -0.08623030665867595, -0.8748807644363729);
    let mut p = Program::new();
    p.tolerance(2e-5, 3e-5).cutter(&[0.7053850067844152, 0.3526925033922076]);
    let axis = Some(v(0.9167257185372315, 0.27111840678619786, 0.29344295267412773));
    let position = v(2.3346202728151764, 0.7297554635516785, 0.6942745124516664);
    p.run(&MotionCommand::From { position, axis, name: String::new() });
    p.go(&[(To, &wall), (To, &part), (On, &first)]).side(DriveSide::Right);
    p.indirv(-0.009638276591321802, 0.9962286072171889, 0.0862303066586759);
    let check = plane(0.009638276591321769, -0.9962286072171889, -0.08623030665867595, -0.98);
    let sequence = proven(&p, &motion(Forward, &wall, &[(On, 1, &check)]), 6_000);
    assert!(sequence.points.len() <= 12, "{} cut vectors", sequence.points.len());
}

/// A tool that goes along its axis rubs along a bulging wall at one place of that, at the limit of the band all the way: shorter and shorter
/// stretches of the vector would show nothing.
#[test]
fn a_flank_that_rubs_along_a_wall_takes_few_clearances() {
    let arc = |z: f64| {
        let geometry = Geometry::Circle(Cylinder { point: v(0.0, -3.0, z), axis: Vec3::z(), radius: 3.0 });
        vec![
            geometry,
            Geometry::Point(v(-2.0, -3.0 + 5f64.sqrt(), z)),
            Geometry::Point(v(2.0, -3.0 + 5f64.sqrt(), z)),
            Geometry::Vector(Vec3::y()),
        ]
    };
    let mut parts = arc(-1.0);
    parts.extend(arc(3.0));
    let wall = ruled(parts);
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.5, 0.0, 0.25, 0.0, 0.0, 0.0, 6.0]);
    p.run(&MotionCommand::From { position: v(-5.0, 3.0, 2.0), axis: Some(Vec3::x()), name: String::new() });
    p.go(&[(To, &wall), (To, &ground()), (On, &x(-5.0))]).side(DriveSide::Right).indirv(1.0, 0.0, 0.0);
    let sequence = proven(&p, &motion(Turn::Up, &wall, &[(On, 1, &x(-1.0))]), 2_000);
    assert!(sequence.points.len() <= 2, "{} cut vectors", sequence.points.len());
}

/// A line goes down a fan of rulings to the corner of that, where it touches the lower end: from a vector that was too long there the contact was
/// followed back, so that each shorter one led there again.
#[test]
fn contact_with_an_end_far_ahead_does_not_lead_there_again() {
    let across = v(-0.047834568003666124, -0.3400740204709623, 0.9391813002315464);
    let ends = [
        v(-3.3663630234291535, 4.601172424464638, 1.5145316983353747),
        v(3.8290757612701496, 1.206313113306883, 0.6517454090257297),
    ];
    let mut parts = straight(ends, across);
    parts.push(Geometry::Point(v(-3.9316589701235323, -4.290921436366604, -2.445113680128799)));
    let wall = v(-0.9877218623669045, -0.15622266993766906, 0.0);
    let forward = v(0.1440008218105673, -0.9104489121703481, -0.3877454598647301);
    let plane = |normal: Vec3, distance: f64| Geometry::Plane(Plane { normal, distance });
    let motion = Found {
        cutter: &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.405035293687699],
        axis: Vec3::z(),
        from: v(-1.3964753072204128, 0.7898258857637066, 0.2184929357377464),
        band: [0.0, 0.001],
        thickness: 0.14119772651226822,
        drive_side: DriveSide::On,
        forward,
        part: (To, ruled(parts)),
        drive: (On, plane(wall, 1.2289549614733588)),
        first: (On, plane(forward, -0.6219470478132826)),
        stop: (On, plane(forward, 0.7)),
    };
    let sequences = motion.run(AMPLE).expect("a path");
    assert_eq!(sequences[1].points.len(), 1);
}

/// The line that a motion follows goes through its check surface twice. Where it ends is looked for from where it is stopped, and found there: contacts
/// with the wall that were found last led on to where the line comes out again.
#[test]
fn a_motion_ends_where_it_is_stopped_whatever_was_looked_at_before() {
    let across = v(0.43351334617324094, 0.9006223078848883, 0.03075121509432563);
    let plane = |normal: Vec3, distance: f64| Geometry::Plane(Plane { normal, distance });
    let wall = vec![
        plane(across, -1.0979192171322778),
        Geometry::Point(v(1.5131145471527279, -1.7895743795519912, -4.622385142573217)),
        Geometry::Point(v(4.613388945916635, -3.534676564759477, 2.7811476340930246)),
        Geometry::Vector(across),
        Geometry::Point(v(-4.110677723202009, 1.3759816060930055, 2.779640040947334)),
    ];
    let forward = v(-0.7274426578101095, 0.40946755302166293, 0.5506028538071844);
    let round = Cylinder {
        point: v(-0.6645951344507777, -0.9742269632328473, -0.7938699293671724),
        axis: v(-0.1377073201950309, -0.1781993760331566, -0.9743108725381736),
        radius: 1.8181554408275402,
    };
    let motion = Found {
        cutter: &[0.6028979673961188],
        axis: Vec3::z(),
        from: v(2.1289190483362384, -0.9249607585726708, -1.219929161394698),
        band: [0.001, 0.001],
        thickness: 0.09768639998255561,
        drive_side: DriveSide::Right,
        forward,
        part: (
            To,
            plane(v(-0.41599844088761284, 0.37496745739626747, -0.8284592344061679), 0.22228262738739504),
        ),
        drive: (To, ruled(wall)),
        first: (
            To,
            plane(v(0.7274426578101094, -0.40946755302166304, -0.5506028538071844), 2.757377857077608),
        ),
        stop: (On, Geometry::Cylinder(round)),
    };
    let sequences = motion.run(AMPLE).expect("a path");
    let end = sequences[1].points.last().expect("an end").tip;
    assert!((end - v(1.134, -1.118, -1.022)).norm() < 1e-2, "{end:?}");
}
