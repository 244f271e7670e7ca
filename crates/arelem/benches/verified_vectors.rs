//! Cost of the verifier per cut vector: sequences of the engine over one part surface each, judged again and again.

#[path = "../tests/support/lofts.rs"]
mod lofts;
#[path = "../tests/support/wave.rs"]
mod wave;

use apt_geometry::{
    Vec3,
    canonical::{Cone, Cylinder, Geometry, Plane, Quadric, Sphere},
    motion::{
        CheckSurface, Direction, DriveSide, MotionCommand, NamedSurface, PerRole, Relation, StartSurface,
        Turn,
    },
};
use arelem::{
    section2::{Output, State, execute},
    sequence::CutSequence,
    verify::verify,
};
use divan::{Bencher, counter::ItemsCount};
use lofts::{roof, vault};
use wave::wave;

fn main() {
    divan::main();
}

fn named(geometry: Geometry) -> NamedSurface {
    NamedSurface { name: String::new(), geometry }
}

fn wall(normal: Vec3, distance: f64) -> Geometry {
    Geometry::Plane(Plane { normal, distance })
}

fn surfaces() -> Vec<(&'static str, Geometry)> {
    let quadric = |coefficients| Geometry::Quadric(Quadric { coefficients });
    vec![
        ("plane", wall(Vec3::new(0.1, 0.2, 1.0).normalize(), 3.0)),
        ("sphere", Geometry::Sphere(Sphere { center: Vec3::zeros(), radius: 3.0 })),
        ("bowl", Geometry::Sphere(Sphere { center: Vec3::new(0.0, 0.0, 9.0), radius: 6.0 })),
        (
            "cylinder",
            Geometry::Cylinder(Cylinder {
                point: Vec3::zeros(),
                axis: Vec3::new(0.2, 1.0, 0.1).normalize(),
                radius: 3.0,
            }),
        ),
        (
            "hollow",
            Geometry::Cylinder(Cylinder {
                point: Vec3::new(0.0, 0.0, 9.0),
                axis: Vec3::new(0.2, 1.0, 0.1).normalize(),
                radius: 6.0,
            }),
        ),
        (
            "cone",
            Geometry::Cone(Cone {
                vertex: Vec3::new(0.0, 0.0, 3.0),
                axis: Vec3::new(0.1, 0.1, -1.0).normalize(),
                cosine: 0.6,
            }),
        ),
        ("ellipsoid", quadric([1.0 / 16.0, 1.0 / 9.0, 0.25, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])),
        ("dish", quadric([0.1, 0.05, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5])),
        ("saddle", quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5])),
        ("tabcyl", wave([Vec3::x(), Vec3::z(), -Vec3::y()], 0.0, 0.3)),
        ("ruled", roof()),
        ("polyconic", vault()),
    ]
}

/// The part surfaces by name.
const NAMES: [&str; 12] = [
    "plane",
    "sphere",
    "bowl",
    "cylinder",
    "hollow",
    "cone",
    "ellipsoid",
    "dish",
    "saddle",
    "tabcyl",
    "ruled",
    "polyconic",
];

/// A pass over a part surface in the plane y = .4 from x = −1.2 to 1.2.
fn pass(name: &str, numbers: &[f64]) -> Option<CutSequence> {
    let part = surfaces().into_iter().find(|s| s.0 == name)?.1;
    let drive = wall(Vec3::y(), 0.4);
    let mut state = State::new(1.0);
    let surface = |relation, geometry| StartSurface { relation, surface: named(geometry) };
    let check = CheckSurface {
        relation: Relation::On,
        occurrence: 1,
        surface: named(wall(Vec3::x(), 1.2)),
        label: None,
    };
    let commands = [
        MotionCommand::Cutter(numbers.to_vec()),
        MotionCommand::OutsideTolerance(PerRole::all(1e-4)),
        MotionCommand::MaximumPoints(100_000),
        MotionCommand::MaximumStep(0.02),
        MotionCommand::From { position: Vec3::new(-1.5, 0.4, 6.0), axis: None, name: String::new() },
        MotionCommand::Start(vec![
            surface(Relation::On, drive.clone()),
            surface(Relation::To, part),
            surface(Relation::On, wall(Vec3::x(), -1.2)),
        ]),
        MotionCommand::Direction([Some(Direction::Vector(Vec3::x())), None, None]),
        MotionCommand::DriveSide(DriveSide::On),
        MotionCommand::Drive { turn: Turn::Forward, drive: named(drive), checks: vec![check] },
    ];
    let mut made = None;
    for command in &commands {
        let execution = execute(&state, command, &|| false);
        state = execution.state;
        if let Some(Output::Sequence(sequence)) = execution.output {
            made = Some(sequence);
        }
    }
    made.filter(|s| !s.start_up)
}

fn bench(bencher: Bencher<'_, '_>, name: &str, numbers: &[f64]) {
    let Some(sequence) = pass(name, numbers) else { panic!("{name} fails") };
    let evidence = verify(&sequence, &|| false);
    assert!(evidence.is_ok_and(|e| e.verified), "{name} is not verified");
    bencher.counter(ItemsCount::new(sequence.points.len())).bench(|| verify(&sequence, &|| false));
}

#[divan::bench(args = NAMES)]
fn ball(bencher: Bencher<'_, '_>, name: &str) {
    bench(bencher, name, &[0.5, 0.25]);
}

#[divan::bench(args = NAMES)]
fn flat(bencher: Bencher<'_, '_>, name: &str) {
    bench(bencher, name, &[0.5, 0.0]);
}

#[divan::bench(args = NAMES)]
fn bull(bencher: Bencher<'_, '_>, name: &str) {
    bench(bencher, name, &[0.5, 0.1]);
}

#[divan::bench(args = NAMES)]
fn seven(bencher: Bencher<'_, '_>, name: &str) {
    bench(bencher, name, &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0]);
}
