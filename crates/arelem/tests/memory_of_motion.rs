//! A motion of 100,000 cut vectors takes memory for its points and no more: its resident size is read from the system.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Plane, Quadric},
    motion::{
        CheckSurface, Direction, DriveSide, MotionCommand, NamedSurface, PerRole, Relation, StartSurface,
        Turn,
    },
};
use arelem::{
    section2::{Output, State, execute},
    verify::verify,
};

/// Greatest resident size so far, bytes.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() * 1024
}

fn named(geometry: Geometry) -> NamedSurface {
    NamedSurface { name: String::new(), geometry }
}

fn wall(normal: Vec3, distance: f64) -> NamedSurface {
    named(Geometry::Plane(Plane { normal, distance }))
}

/// Bytes for one cut vector while the engine works: its point in a growing list (the old and the new one for a moment), then
/// tool end and axis in the sequence.
const ENGINE: u64 = 160;
/// Bytes for one cut vector while the verifier works: its position in a growing list, and one reading for each of two roles.
const VERIFIER: u64 = 240;

#[test]
fn motions_take_memory_for_their_points() {
    let saddle =
        Geometry::Quadric(Quadric { coefficients: [0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5] });
    let surface = |relation, surface| StartSurface { relation, surface };
    let drive = wall(Vec3::y(), 0.4);
    let commands = [
        MotionCommand::Cutter(vec![0.5, 0.1]),
        MotionCommand::OutsideTolerance(PerRole::all(1e-6)),
        MotionCommand::MaximumPoints(200_000),
        MotionCommand::MaximumStep(2.4e-5),
        MotionCommand::From { position: Vec3::new(-1.5, 0.4, 6.0), axis: None, name: String::new() },
        MotionCommand::Start(vec![
            surface(Relation::On, drive.clone()),
            surface(Relation::To, named(saddle)),
            surface(Relation::On, wall(Vec3::x(), -1.2)),
        ]),
        MotionCommand::Direction([Some(Direction::Vector(Vec3::x())), None, None]),
        MotionCommand::DriveSide(DriveSide::On),
    ];
    let mut state = State::new(1.0);
    for command in &commands {
        state = execute(&state, command, &|| false).state;
    }
    let check =
        CheckSurface { relation: Relation::On, occurrence: 1, surface: wall(Vec3::x(), 1.2), label: None };
    let command = MotionCommand::Drive { turn: Turn::Forward, drive, checks: vec![check] };
    let before = peak();
    let execution = execute(&state, &command, &|| false);
    let Some(Output::Sequence(sequence)) = execution.output else { panic!("{:?}", execution.failure) };
    let vectors = sequence.points.len() as u64;
    assert!(vectors >= 100_000, "{vectors}");
    let computed = peak();
    assert!(computed - before <= ENGINE * vectors, "{} bytes a vector", (computed - before) / vectors);
    let evidence = verify(&sequence, &|| false).unwrap();
    assert!(evidence.verified, "{evidence:?}");
    let taken = peak() - computed;
    assert!(taken <= VERIFIER * vectors, "{} bytes a vector", taken / vectors);
}
