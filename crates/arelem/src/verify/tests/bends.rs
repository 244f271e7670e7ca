//! How clearances bend on straight ways along surfaces of patches: no faster than is told of the way.

use super::{
    super::{
        clearance::{Clearance, Reading, Surface},
        span::{between, round, turning},
        tool::{Profile, WORK},
        verify,
    },
    followed::{BALL, BULL, FLAT},
    lines::line,
    *,
};
use apt_geometry::motion::DriveSide;

use crate::sequence::{CutSequence, Stop, ToolPosition};

/// Positions on a way.
const STEPS: i32 = 40;
/// Rounding of a second difference, by the parameter of the way.
const NOISE: f64 = 2e-5;
/// How much more of the band a bound may leave than the clearance takes.
const LOOSE: f64 = 2e-5;

/// Part of y = k(z² − x²), by its straight lines.
fn saddle() -> Geometry {
    let k = 0.05;
    let place = |c: f64, t: f64| [0.5 * (t + c), -k * c * t, 0.5 * (t - c)];
    let curve =
        |c: f64| section(plane([1.0, 0.0, -1.0], c), [place(c, -6.0), place(c, 6.0)], [1.0, 0.0, -1.0]);
    ruled(curve(-4.0), curve(4.0))
}

/// Bounds and measured growth of the slope on a way along a surface, at the places that touch.
fn looked_at(
    geometry: &Geometry,
    side: f64,
    profile: &Profile,
    ends: [ToolPosition; 2],
    depth: f64,
) -> [f64; 2] {
    let surface = Surface::of(geometry).expect("a surface");
    let clearance = Clearance { raise: 0.1, allowed: 0.01, ..Clearance::new(&surface, profile, side) };
    let read = |p: &ToolPosition| clearance.at(&p.tip, &p.axis).expect("a clearance");
    let touching = ends.map(|mut p| {
        for _ in 0..60 {
            let Reading { value, normal, .. } = read(&p);
            p.tip -= normal * (value + depth);
        }
        p
    });
    let [from, to] = &touching;
    let readings = touching.map(|p| read(&p));
    let way = to.tip - from.tip;
    let swing = turning(from, to) * clearance.reach();
    let travel = way.norm() + swing;
    let bend = clearance.bend_along([from, to], readings.each_ref(), [travel, 0.0]).expect("a bound");
    let crude = bend.rate * travel * travel + turning(from, to) * swing;
    let lowest = readings[0].value.min(readings[1].value) - crude / 8.0;
    let middle = between(from, to, 0.5).expect("a middle");
    let values = [lowest, readings[0].value.max(readings[1].value) + crude / 8.0];
    let closer = clearance.bend_on(&middle, (way, round(from, to)), values, |_| false).expect("a closer one");
    let at = |k: i32| between(from, to, f64::from(k) / f64::from(STEPS)).expect("a position");
    let values: Vec<f64> = (0..=STEPS).map(|k| read(&at(k)).value).collect();
    let seconds = values.windows(3).map(|v| (v[0] - 2.0 * v[1] + v[2]) * f64::from(STEPS * STEPS));
    let greatest = seconds.fold(f64::NEG_INFINITY, f64::max);
    assert!(greatest <= closer + NOISE, "{greatest} {closer} of {crude}");
    [closer, crude]
}

fn at(x: f64, y: f64, axis: [f64; 3]) -> ToolPosition {
    ToolPosition { tip: Vec3::new(x, y, -1.0), axis: Vec3::from(axis).normalize() }
}

/// On its hollow side, along it, a saddle never falls away from a line, however much it does so across the way.
#[test]
fn along_the_hollow_of_a_saddle_the_slope_of_a_line_does_not_grow() {
    for depth in [-1e-3, 0.0, 1e-3] {
        for x in [-1.5, -0.4, 0.9] {
            let ends = [at(x, -0.5, [0.0, 0.0, 1.0]), at(x + 0.1, -0.5, [0.0, 0.0, 1.0])];
            let [closer, crude] = looked_at(&saddle(), -1.0, &line(2.0), ends, depth);
            assert!(closer / 8.0 <= LOOSE * 0.01 && crude > 5e-4, "{closer} of {crude}");
        }
    }
}

#[test]
fn no_slope_grows_faster_than_is_told_of_a_way() {
    let mut closer_by = 0.0;
    let mut looks = 0.0;
    let tools = [BALL, FLAT, BULL].map(|numbers| {
        let mut numbers = cutter(&numbers);
        numbers.height = 1.5;
        Profile::of(&numbers).expect("a cutter")
    });
    let tools: Vec<Profile> = tools.into_iter().chain([line(1.5), Profile::tool_end()]).collect();
    for profile in &tools {
        for (side, y) in [(-1.0, -0.8), (1.0, 0.8)] {
            for turn in [0.0, 0.02, 0.1] {
                for depth in [-1e-3, 2e-3] {
                    let ends = [at(-0.4, y, [0.1, 0.05, 1.0]), at(-0.3, y, [0.1 + turn, 0.05 - turn, 1.0])];
                    let [closer, crude] = looked_at(&saddle(), side, profile, ends, depth);
                    closer_by += closer / crude;
                    looks += 1.0;
                }
            }
        }
    }
    assert!(closer_by < 0.5 * looks, "{closer_by} of {looks}");
}

/// Parts of the surface that may be looked at for each vector of a line that turns.
const TURNING_WORK: u64 = 600;

/// A line that is through the surface tells where it touches that when it has been led out: how fast its clearance changes while it turns
/// needs no readings beside that.
#[test]
fn a_line_that_turns_in_a_saddle_is_read_once_at_each_place() {
    let surface = Surface::of(&saddle()).expect("a surface");
    let (profile, allowed) = (line(2.0), 2e-5);
    let clearance = Clearance { allowed, ..Clearance::new(&surface, &profile, -1.0) };
    let places: Vec<ToolPosition> = (0..=10)
        .map(|k| {
            let x = 0.02 * f64::from(k);
            let mut p = at(x, -0.5, [0.1 * x, 0.05, 1.0]);
            for _ in 0..60 {
                let Reading { value, normal, .. } = clearance.at(&p.tip, &p.axis).expect("a clearance");
                p.tip -= normal * (value + 0.9 * allowed);
            }
            p
        })
        .collect();
    let end = places[places.len() - 1].tip;
    let stop = role(plane([1.0, 0.0, 0.0], end.x), Relation::On, -1.0, 1e-3, 1e-3);
    let sequence = CutSequence {
        start: places[0],
        points: places[1..].to_vec(),
        cutter: cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0]),
        part: Some(role(saddle(), Relation::To, -1.0, allowed, allowed)),
        drive: None,
        stop: Some(Stop { role: stop, occurrence: 1, index: 0 }),
        drive_side: DriveSide::On,
        start_up: false,
        forward: (end - places[0].tip).normalize(),
        maximum_step: 10.0,
        minimum: None,
    };
    let before = WORK.get();
    let evidence = verify(&sequence, &|| false).expect("evidence");
    assert!(evidence.verified, "{:?}", evidence.violations);
    let each = (WORK.get() - before) / sequence.points.len() as u64;
    assert!(each <= TURNING_WORK, "{each}");
}
