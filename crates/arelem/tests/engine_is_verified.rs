//! Random motions through the engine, judged by the verifier: what the engine delivers must be proven, whatever the pair of
//! surfaces, the side and the cutter.

mod support;

use std::{collections::BTreeMap, fmt::Write as _};

use apt_geometry::{
    Vec3,
    canonical::{Cylinder, Geometry, Quadric},
    motion::{
        CheckSurface, Direction, DriveSide, MotionCommand, NamedSurface, PerRole, Relation, StartSurface,
        Turn,
    },
};
use arelem::{
    section2::{Output, State, execute},
    verify::verify,
};
use support::{Random, cone, cylinder, named, plane, quadric, sphere};

fn start(relation: Relation, surface: &NamedSurface) -> StartSurface {
    StartSurface { relation, surface: surface.clone() }
}

/// A motion: the commands, and the class it belongs to.
struct Motion {
    class: String,
    commands: Vec<MotionCommand>,
}

fn from(x: f64, y: f64, z: f64) -> MotionCommand {
    MotionCommand::From { position: Vec3::new(x, y, z), axis: None, name: String::new() }
}

fn forward(direction: Vec3) -> MotionCommand {
    MotionCommand::Direction([Some(Direction::Vector(direction)), None, None])
}

fn drive_until(drive: NamedSurface, check: Geometry, random: &mut Random) -> MotionCommand {
    MotionCommand::Drive {
        turn: Turn::Forward,
        drive,
        checks: vec![CheckSurface {
            relation: random.pick(&[Relation::On, Relation::To, Relation::Past]),
            occurrence: 1,
            surface: named("CS", check),
            label: None,
        }],
    }
}

fn settings(random: &mut Random) -> (&'static str, Vec<MotionCommand>) {
    let (name, cutter) = random.pick(&[
        ("ball", vec![0.5, 0.25]),
        ("flat", vec![0.5]),
        ("bull nose", vec![0.75, 0.125]),
        ("seven", vec![0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0]),
    ]);
    let (inside, outside) = random.pick(&[(0.0, 0.001), (0.001, 0.001), (0.0005, 0.0), (0.01, 0.005)]);
    let mut commands = vec![
        MotionCommand::Cutter(cutter),
        MotionCommand::InsideTolerance(PerRole::all(inside)),
        MotionCommand::OutsideTolerance(PerRole::all(outside)),
    ];
    if random.next() < 0.25 {
        commands.push(MotionCommand::Thickness(PerRole::all(random.between(0.01, 0.1))));
    }
    (name, commands)
}

/// Over or in a part surface, along a plane the tool end is on, until a plane across.
fn over_part(random: &mut Random) -> Motion {
    let (cutter, mut commands) = settings(random);
    let r = random.between(4.0, 8.0);
    let tilt = (random.between(-0.3, 0.3), random.between(-0.3, 0.3));
    let down = -Vec3::z();
    let (class, part, from_z) = random.pick(&[
        ("tilted plane", plane(tilt.0, tilt.1, 1.0, 0.2), 4.0),
        ("sphere outside", sphere(0.0, r), r + 2.0),
        ("sphere inside", sphere(r, r), 2.5),
        ("cylinder outside", cylinder(0.0, Vec3::new(tilt.0, 1.0, 0.0), r), r + 2.0),
        ("cylinder inside", cylinder(r, Vec3::y(), r), 2.5),
        ("cone outside", cone(4.0, down, 0.7), 5.0),
        ("cone inside", cone(-4.0, Vec3::z(), 0.5), 2.0),
        ("ellipsoid outside", quadric([0.04, 0.02, 0.1, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 5.0),
        ("paraboloid inside", quadric([1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0]), 4.0),
        ("saddle", quadric([0.05, -0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5]), 4.0),
    ]);
    let y = random.between(-1.0, 1.0);
    let part = named("PS", part);
    let drive = named("DS", plane(0.0, 1.0, 0.0, y));
    let check = plane(1.0, random.between(-0.2, 0.2), 0.0, random.between(0.8, 2.0));
    let first = named("ST", plane(1.0, 0.0, 0.0, -2.0));
    commands.extend([
        from(-2.5, y - 0.2, from_z),
        MotionCommand::Start(vec![
            start(Relation::On, &drive),
            start(Relation::To, &part),
            start(Relation::On, &first),
        ]),
        MotionCommand::DriveSide(DriveSide::On),
        forward(Vec3::x()),
        drive_until(drive, check, random),
    ]);
    Motion { class: format!("part {class}, {cutter}"), commands }
}

/// Round a drive surface on a part plane, a quarter turn.
fn round_drive(random: &mut Random) -> Motion {
    let (cutter, mut commands) = settings(random);
    let r = random.between(1.5, 4.0);
    let upright = Cylinder { point: Vec3::zeros(), axis: Vec3::z(), radius: r };
    let ellipse = Quadric { coefficients: [1.0 / (r * r), 0.25, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] };
    let (class, drive, reach) = random.pick(&[
        ("circle", Geometry::Circle(upright), r),
        ("skew cylinder", cylinder(0.0, Vec3::new(0.2, 0.1, 1.0), r), r),
        ("sphere", sphere(0.5, r + 4.0), r + 4.0),
        ("ellipse", Geometry::Ellipse(ellipse), 2.0),
        ("cone", cone(6.0, -Vec3::z(), 0.9), 3.0),
    ]);
    let outside = random.next() < 0.5;
    let part = named("PS", plane(random.between(-0.1, 0.1), 0.0, 1.0, 0.0));
    let drive = named("DS", drive);
    let at = if outside { reach + 1.5 } else { (0.6 * reach).min(1.1) };
    // Counter-clockwise from the negative y axis: the tool inside is on the left of the surface.
    let side = if outside { DriveSide::Right } else { DriveSide::Left };
    let toward = Vec3::y() * if outside { 1.0 } else { -1.0 };
    let check = plane(0.0, 1.0, 0.0, random.between(-0.1, 0.3));
    commands.extend([
        from(0.1, -at, 1.0),
        forward(toward),
        MotionCommand::Start(vec![start(Relation::To, &drive), start(Relation::To, &part)]),
        MotionCommand::DriveSide(side),
        forward(Vec3::x()),
        drive_until(drive, check, random),
    ]);
    Motion {
        class: format!("drive {class} {}, {cutter}", if outside { "outside" } else { "inside" }),
        commands,
    }
}

/// What became of the motions of a class.
#[derive(Debug, Default)]
struct Tally {
    proven: usize,
    refused: Vec<String>,
    broken: Vec<String>,
}

fn run(motion: &Motion, tally: &mut Tally) {
    let mut state = State::new(1.0);
    for (step, command) in motion.commands.iter().enumerate() {
        let execution = execute(&state, command, &|| false);
        state = execution.state;
        if let Some(failure) = execution.failure {
            tally.refused.push(format!("step {step}: {failure:?}"));
            return;
        }
        let Some(Output::Sequence(sequence)) = execution.output else { continue };
        match verify(&sequence, &|| false) {
            Ok(evidence) if evidence.verified => tally.proven += 1,
            found => tally.broken.push(format!("step {step}: {found:?}")),
        }
    }
}

fn describe(classes: &BTreeMap<String, Tally>) -> String {
    let mut report = String::new();
    for (class, tally) in classes {
        let counts = [tally.proven, tally.refused.len(), tally.broken.len()];
        let _ =
            writeln!(report, "{class}: {} proven, {} refused, {} broken", counts[0], counts[1], counts[2]);
        for line in tally.broken.iter().take(2).chain(tally.refused.iter().take(1)) {
            let _ = writeln!(report, "    {line}");
        }
    }
    report
}

#[test]
fn whatever_the_engine_delivers_is_proven() {
    let mut random = Random(20_260_725);
    let mut classes: BTreeMap<String, Tally> = BTreeMap::new();
    for turn in 0..120 {
        let motion = if turn % 2 == 0 { over_part(&mut random) } else { round_drive(&mut random) };
        run(&motion, classes.entry(motion.class.clone()).or_default());
    }
    let proven: usize = classes.values().map(|t| t.proven).sum();
    let broken: usize = classes.values().map(|t| t.broken.len()).sum();
    assert_eq!(broken, 0, "\n{}", describe(&classes));
    // Most of the motions can be made; a few are honestly impossible (a tool larger than its hollow).
    assert!(proven >= 150, "only {proven} proven\n{}", describe(&classes));
}
