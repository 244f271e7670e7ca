//! Motions over polyconic surfaces: what the engine delivers is proven.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Plane, Remembering},
    motion::{
        CheckSurface, Direction, DriveSide, MotionCommand, NamedSurface, PerRole, Relation, StartSurface,
        Turn,
    },
};
use arelem::{
    section2::{Output, State, execute},
    verify::verify,
};

fn named(name: &str, geometry: Geometry) -> NamedSurface {
    NamedSurface { name: name.to_owned(), geometry }
}

fn plane(x: f64, y: f64, z: f64, distance: f64) -> Geometry {
    Geometry::Plane(Plane { normal: Vec3::new(x, y, z), distance })
}

/// The 79 values of a surface along x, from the constant and linear coefficients of A, B, C, D, L, H, P.
fn poly_conic(length: f64, functions: [[f64; 2]; 7]) -> Geometry {
    let mut values = vec![1.0];
    values.extend([0.0; 14]);
    values.push(length);
    for coefficients in functions {
        values.extend(coefficients);
        values.extend([0.0; 6]);
    }
    values.extend([0.0; 7]);
    Geometry::PolyConic(Remembering::new(values))
}

#[test]
fn passes_over_a_polyconic_roof_are_proven() {
    let root = std::f64::consts::SQRT_2;
    let constants = [root, root, root, -root, -root, root, std::f64::consts::FRAC_1_SQRT_2];
    let tube = poly_conic(6.0, constants.map(|k| [k, 0.0]));
    for (name, roof) in [("tube", tube)] {
        for numbers in [vec![0.5, 0.25], vec![0.5, 0.1]] {
            let drive = named("DS", plane(1.0, 0.0, 0.0, 3.0));
            let start = |relation, surface| StartSurface { relation, surface };
            let commands = [
                MotionCommand::Cutter(numbers.clone()),
                MotionCommand::InsideTolerance(PerRole::all(0.001)),
                MotionCommand::OutsideTolerance(PerRole::all(0.001)),
                MotionCommand::From { position: Vec3::new(3.0, 0.0, 4.0), axis: None, name: String::new() },
                MotionCommand::Start(vec![
                    start(Relation::On, drive.clone()),
                    start(Relation::To, named("PS", roof.clone())),
                    start(Relation::On, named("ST", plane(0.0, 1.0, 0.0, -0.5))),
                ]),
                MotionCommand::DriveSide(DriveSide::On),
                MotionCommand::Direction([Some(Direction::Vector(Vec3::y())), None, None]),
                MotionCommand::Drive {
                    turn: Turn::Forward,
                    drive: drive.clone(),
                    checks: vec![CheckSurface {
                        relation: Relation::On,
                        occurrence: 1,
                        surface: named("CS", plane(0.0, 1.0, 0.0, 0.7)),
                        label: None,
                    }],
                },
            ];
            let mut state = State::new(1.0);
            let mut proven = 0;
            for command in &commands {
                let execution = execute(&state, command, &|| false);
                assert!(execution.failure.is_none(), "{name} {numbers:?}: {:?}", execution.failure);
                state = execution.state;
                let Some(Output::Sequence(sequence)) = execution.output else { continue };
                let evidence = verify(&sequence, &|| false).expect("a verdict");
                assert!(evidence.verified, "{name} {numbers:?}: {evidence:?}");
                proven += 1;
                let mut turned = sequence.clone();
                if let Some(part) = &mut turned.part {
                    part.side = -part.side;
                }
                assert!(!verify(&turned, &|| false).is_ok_and(|e| e.verified), "{name} {numbers:?}");
            }
            assert_eq!(proven, 2, "{name} {numbers:?}: the start and the pass");
        }
    }
}
