//! Cost per cut vector: directed motions over one pair of surfaces each, divided by their vectors.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{Cone, Cylinder, Geometry, Interval, Plane, Quadric, Sphere, TabulatedCylinder},
    motion::{
        CheckSurface, Direction, DriveSide, MotionCommand, NamedSurface, PerRole, Relation, StartSurface,
        Turn,
    },
};
use arelem::section2::{Output, State, execute};
use divan::{Bencher, counter::ItemsCount};

#[path = "../tests/support/lofts.rs"]
mod lofts;

fn main() {
    divan::main();
}

fn named(geometry: Geometry) -> NamedSurface {
    NamedSurface { name: String::new(), geometry }
}

fn wall(normal: Vec3, distance: f64) -> Geometry {
    Geometry::Plane(Plane { normal, distance })
}

/// A pass over a part surface in the plane y = .4 from x = −1.2 to 1.2.
fn pass(part: &Geometry, numbers: &[f64]) -> (State, MotionCommand) {
    let drive = wall(Vec3::y(), 0.4);
    let mut state = State::new(1.0);
    let surface = |relation, geometry| StartSurface { relation, surface: named(geometry) };
    let commands = [
        MotionCommand::Cutter(numbers.to_vec()),
        MotionCommand::OutsideTolerance(PerRole::all(1e-5)),
        MotionCommand::MaximumPoints(100_000),
        MotionCommand::From { position: Vec3::new(-1.5, 0.4, 6.0), axis: None, name: String::new() },
        MotionCommand::Start(vec![
            surface(Relation::On, drive.clone()),
            surface(Relation::To, part.clone()),
            surface(Relation::On, wall(Vec3::x(), -1.2)),
        ]),
        MotionCommand::Direction([Some(Direction::Vector(Vec3::x())), None, None]),
        MotionCommand::DriveSide(DriveSide::On),
    ];
    for command in &commands {
        state = execute(&state, command, &|| false).state;
    }
    let check = CheckSurface {
        relation: Relation::On,
        occurrence: 1,
        surface: named(wall(Vec3::x(), 1.2)),
        label: None,
    };
    (state, MotionCommand::Drive { turn: Turn::Forward, drive: named(drive), checks: vec![check] })
}

fn vectors(state: &State, command: &MotionCommand) -> usize {
    match execute(state, command, &|| false).output {
        Some(Output::Sequence(sequence)) => sequence.points.len(),
        _ => 0,
    }
}

/// The roof z = 2 − x²/4 as a tabulated cylinder along y.
fn tabulated() -> Geometry {
    let height = |x: f64| 2.0 - 0.25 * x * x;
    let mut intervals = Vec::new();
    for k in -3..3 {
        let (u, w) = (f64::from(k), f64::from(k + 1));
        let (v, chord) = (height(u), height(w) - height(u));
        let (length, lean) = (1f64.hypot(chord), chord.atan());
        let [first, last] = [u, w].map(|x| ((-0.5 * x).atan() - lean).tan());
        let (a, b) = ((first + last) / (length * length), -(2.0 * first + last) / length);
        intervals.push(Interval { u, v, a, b, length, maximum: 0.0, minimum: 0.0 });
    }
    let straight =
        |u: f64, v: f64| Interval { u, v, a: 0.0, b: 0.0, length: 0.0, maximum: 0.0, minimum: 0.0 };
    intervals.insert(0, straight(-9.0, height(-3.0) - 9.0));
    intervals.push(straight(3.0, height(3.0)));
    let axes = [Vec3::x(), Vec3::z(), -Vec3::y()];
    let last = [9.0, height(3.0) - 9.0];
    Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder { axes, kind: 0.0, intervals, last }))
}

fn surfaces() -> [(&'static str, Geometry); 9] {
    let quadric = |coefficients| Geometry::Quadric(Quadric { coefficients });
    [
        ("sphere", Geometry::Sphere(Sphere { center: Vec3::zeros(), radius: 3.0 })),
        (
            "cylinder",
            Geometry::Cylinder(Cylinder {
                point: Vec3::zeros(),
                axis: Vec3::new(0.2, 1.0, 0.1).normalize(),
                radius: 3.0,
            }),
        ),
        ("cone", Geometry::Cone(Cone { vertex: Vec3::new(0.0, 0.0, 3.0), axis: -Vec3::z(), cosine: 0.6 })),
        (
            "skew cone",
            Geometry::Cone(Cone {
                vertex: Vec3::new(0.0, 0.0, 3.0),
                axis: Vec3::new(0.1, 0.1, -1.0).normalize(),
                cosine: 0.6,
            }),
        ),
        ("ellipsoid", quadric([1.0 / 16.0, 1.0 / 9.0, 0.25, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])),
        ("saddle", quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5])),
        ("tabulated cylinder", tabulated()),
        ("ruled surface", lofts::roof()),
        ("polyconic", lofts::vault()),
    ]
}

fn bench(bencher: Bencher<'_, '_>, which: usize, numbers: &[f64]) {
    let (state, command) = pass(&surfaces()[which].1, numbers);
    let count = vectors(&state, &command);
    assert!(count > 0, "{} fails", surfaces()[which].0);
    bencher.counter(ItemsCount::new(count)).bench(|| vectors(&state, &command));
}

#[divan::bench(args = [0, 1, 2, 3, 4, 5, 6, 7, 8])]
fn ball(bencher: Bencher<'_, '_>, which: usize) {
    bench(bencher, which, &[0.5, 0.25]);
}

#[divan::bench(args = [0, 1, 2, 3, 4, 5, 6, 7, 8])]
fn bull(bencher: Bencher<'_, '_>, which: usize) {
    bench(bencher, which, &[0.5, 0.1]);
}

/// A corner that touches neither of its lines.
#[divan::bench(args = [0, 1, 2, 3, 4, 5, 6, 7, 8])]
fn seven_numbers(bencher: Bencher<'_, '_>, which: usize) {
    bench(bencher, which, &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0]);
}
