//! Curved part surfaces with curved drive surfaces and all kinds of cutters: what the engine delivers is proven, and what it
//! refuses is held against a search of the verifier's own for a path.

mod support;
#[path = "support/wave.rs"]
mod wave;

use std::{collections::BTreeMap, fmt::Write as _};

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Remembering, RuledSurface},
    cutter::Cutter,
    motion::{
        CheckSurface, Direction, DriveSide, MotionCommand, NamedSurface, PerRole, Relation, StartSurface,
        Turn,
    },
};
use arelem::{
    MotionFailure,
    section2::{Output, State, execute},
    sequence::{CutSequence, Role, ToolPosition},
    verify::verify,
};
use support::{Random, cone, cylinder, named, plane, quadric, sphere};
use wave::wave;

/// Where every motion starts and ends, along x.
const ENDS: [f64; 2] = [-1.2, 1.2];
/// Stations between them at which the search for a path looks.
const STATIONS: u32 = 6;
/// INTOL and OUTTOL of every motion.
const BAND: f64 = 0.001;
/// Places of a vector at which a changed sequence is looked at.
const SAMPLES: u32 = 16;
/// Part and drive surfaces, one of each makes a pair.
const PARTS: usize = 8;
const DRIVES: usize = 7;
/// Share of the motions that have a path which the engine may refuse.
const REFUSALS: f64 = 0.03;

/// A ruled surface between two straight sections, each of a plane with its normal across the chord.
fn ruled(curves: [(Vec3, Vec3, Vec3); 2]) -> Geometry {
    let mut parts = Vec::new();
    for (start, end, normal) in curves {
        parts.push(plane(normal.x, normal.y, normal.z, normal.dot(&start)));
        parts.extend([Geometry::Point(start), Geometry::Point(end), Geometry::Vector(normal.normalize())]);
    }
    Geometry::RuledSurface(Remembering::new(RuledSurface { parts }))
}

/// Surfaces under the tool, about z = 0, with the side of their natural normal that is up.
fn parts(random: &mut Random) -> Vec<(&'static str, Geometry, f64)> {
    let (a, b) = (random.between(-0.3, 0.3), random.between(-0.2, 0.2));
    let r = random.between(5.0, 12.0);
    vec![
        ("plane", plane(a, b, 1.0, 0.0), 1.0),
        ("cylinder", cylinder(-r, Vec3::new(a, 1.0, b), r), 1.0),
        ("sphere", sphere(-r, r), 1.0),
        (
            "cone",
            Geometry::Cone(apt_geometry::canonical::Cone {
                vertex: Vec3::new(-4.0, -1.0, 2.0),
                axis: -Vec3::z(),
                cosine: 0.45,
            }),
            1.0,
        ),
        ("quadric", quadric([0.04, 0.02, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.316]), 1.0),
        ("saddle", quadric([0.05, -0.04, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5]), 1.0),
        ("tabcyl", wave([Vec3::x(), Vec3::z(), -Vec3::y()], 0.0, a), 1.0),
        (
            "ruled",
            ruled([
                (Vec3::new(-5.0, -4.0, 0.0), Vec3::new(5.0, -4.0, 0.0), Vec3::z()),
                (Vec3::new(-5.0, 4.0, -5.0 * b), Vec3::new(5.0, 4.0, 5.0 * b), Vec3::new(-b, 0.0, 1.0)),
            ]),
            1.0,
        ),
    ]
}

/// Walls in front of the tool towards +y, with the side of their natural normal that the tool is on.
fn drives(random: &mut Random) -> Vec<(&'static str, Geometry, f64)> {
    let (a, b) = (random.between(-0.15, 0.15), random.between(-0.1, 0.1));
    let r = random.between(3.0, 7.0);
    let moved = |geometry: Geometry| match geometry {
        Geometry::Cylinder(mut c) => {
            c.point.y = 1.8 + r;
            Geometry::Cylinder(c)
        }
        Geometry::Sphere(mut s) => {
            s.center.y = 1.8 + r;
            Geometry::Sphere(s)
        }
        other => other,
    };
    let Geometry::Cone(mut peak) = cone(10.0, -Vec3::z(), 0.93) else { panic!("a cone") };
    peak.vertex.y = 6.0;
    vec![
        ("plane", plane(a, 1.0, b, 1.8), -1.0),
        ("cylinder", moved(cylinder(0.0, Vec3::new(a, b, 1.0), r)), 1.0),
        ("sphere", moved(sphere(1.0, r)), 1.0),
        ("cone", Geometry::Cone(peak), 1.0),
        // (x/4)² + ((y − 5)/3)² = 1 with a little of xz.
        (
            "quadric",
            quadric([1.0 / 16.0, 1.0 / 9.0, 0.002, 25.0 / 9.0 - 1.0, 0.0, 0.002, 0.0, 0.0, -5.0 / 9.0, 0.0]),
            1.0,
        ),
        ("tabcyl", wave([Vec3::x(), Vec3::y(), Vec3::z()], 2.0, a), -1.0),
        (
            "ruled",
            ruled([
                (Vec3::new(-5.0, 1.8, -3.0), Vec3::new(5.0, 1.8, -3.0), Vec3::y()),
                (
                    Vec3::new(-5.0, 1.8 - 5.0 * b, 6.0),
                    Vec3::new(5.0, 1.8 + 5.0 * b, 6.0),
                    Vec3::new(-b, 1.0, 0.0),
                ),
            ]),
            1.0,
        ),
    ]
}

const CUTTERS: [(&str, &[f64]); 5] = [
    ("ball", &[0.5, 0.25]),
    ("flat", &[0.5]),
    ("bull nose", &[0.75, 0.125]),
    ("tapered", &[0.4, 0.0, 0.2, 0.0, 0.0, 8.0, 3.0]),
    ("seven", &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0]),
];

/// A motion on a part surface along a drive surface.
struct Motion {
    cutter: Vec<f64>,
    part: (Geometry, f64),
    drive: (Geometry, f64),
    until: Relation,
}

impl Motion {
    fn commands(&self) -> Vec<MotionCommand> {
        let surface = |relation, name: &str, geometry: &Geometry| StartSurface {
            relation,
            surface: named(name, geometry.clone()),
        };
        let at = |x: f64| plane(1.0, 0.0, 0.0, x);
        vec![
            MotionCommand::Cutter(self.cutter.clone()),
            MotionCommand::InsideTolerance(PerRole::all(BAND)),
            MotionCommand::OutsideTolerance(PerRole::all(BAND)),
            MotionCommand::From { position: Vec3::new(ENDS[0], 0.0, 2.5), axis: None, name: String::new() },
            MotionCommand::Start(vec![
                surface(Relation::To, "DS", &self.drive.0),
                surface(Relation::To, "PS", &self.part.0),
                surface(Relation::On, "ST", &at(ENDS[0])),
            ]),
            MotionCommand::DriveSide(DriveSide::Right),
            MotionCommand::Direction([Some(Direction::Vector(Vec3::x())), None, None]),
            MotionCommand::Drive {
                turn: Turn::Forward,
                drive: named("DS", self.drive.0.clone()),
                checks: vec![CheckSurface {
                    relation: self.until,
                    occurrence: 1,
                    surface: named("CS", at(ENDS[1])),
                    label: None,
                }],
            },
        ]
    }

    /// Clearances to part and drive surface at a place, as the verifier reads them; None where it has none.
    fn read(&self, cutter: &Cutter, tip: Vec3) -> Option<[f64; 2]> {
        let role = |(geometry, side): &(Geometry, f64)| Role {
            surface: NamedSurface { name: String::new(), geometry: geometry.clone() },
            relation: Relation::To,
            side: *side,
            inside_tolerance: 1.0,
            outside_tolerance: 1.0,
            thickness: 0.0,
            disk: None,
        };
        let place = ToolPosition { tip, axis: Vec3::z() };
        let sequence = CutSequence {
            start: place,
            points: vec![place],
            cutter: *cutter,
            part: Some(role(&self.part)),
            drive: Some(role(&self.drive)),
            stop: None,
            drive_side: DriveSide::Right,
            start_up: true,
            forward: Vec3::zeros(),
            maximum_step: 10.0,
            minimum: None,
        };
        let evidence = verify(&sequence, &|| false).ok()?;
        Some([evidence.part?.min, evidence.drive?.min])
    }

    /// Whether there is a position on both surfaces at every station, found by going down to the part surface and across
    /// to the drive surface by turns.
    fn has_path(&self) -> bool {
        let Ok(cutter) = Cutter::from_numbers(&self.cutter, 1.0) else { return false };
        let root = |read: &dyn Fn(f64) -> Option<f64>, far: f64, near: f64| -> Option<f64> {
            let (mut clear, mut cut) = (far, near);
            if read(clear)? < 0.0 || read(cut)? > 0.0 {
                return None;
            }
            for _ in 0..26 {
                let middle = 0.5 * (clear + cut);
                if read(middle)? < 0.0 {
                    cut = middle;
                } else {
                    clear = middle;
                }
            }
            Some(clear)
        };
        let station = |x: f64| -> Option<Vec3> {
            let mut at = Vec3::new(x, 0.0, 0.0);
            for _ in 0..6 {
                at.z = root(&|z| Some(self.read(&cutter, Vec3::new(x, at.y, z))?[0]), 4.0, -4.0)?;
                at.y = root(&|y| Some(self.read(&cutter, Vec3::new(x, y, at.z))?[1]), -3.0, 4.0)?;
            }
            let [part, drive] = self.read(&cutter, at)?;
            (part.abs() < 5e-3 && drive.abs() < 5e-3).then_some(at)
        };
        (0..=STATIONS).all(|k| {
            let t = f64::from(k) / f64::from(STATIONS);
            station(ENDS[0] + (ENDS[1] - ENDS[0]) * t).is_some()
        })
    }
}

/// What became of the motions of a pair of surfaces.
#[derive(Debug, Default)]
struct Tally {
    motions: usize,
    proven: usize,
    broken: Vec<String>,
    refused: Vec<String>,
    refused_with_path: usize,
    /// Mutated sequences, and those that were accepted though they leave the band.
    mutated: usize,
    missed: Vec<String>,
}

/// What can be wrong with a sequence, with whether it surely is: then the verifier must find it; else it may be in the band.
fn mutations(sequence: &CutSequence) -> Vec<(&'static str, bool, CutSequence)> {
    let mut found = Vec::new();
    let mut add = |name, sure, change: &dyn Fn(&mut CutSequence)| {
        let mut mutated = sequence.clone();
        change(&mut mutated);
        found.push((name, sure, mutated));
    };
    let middle = sequence.points.len() / 2;
    if middle + 1 < sequence.points.len() {
        for (name, shift) in [("raised", 1.5), ("lowered", -1.5)] {
            add(name, true, &|s: &mut CutSequence| s.points[middle].tip.z += shift * 2.0 * BAND * 1.3);
        }
        add("without a vertex", false, &|s: &mut CutSequence| {
            s.points.remove(middle);
        });
    }
    add("on the other side of the part", true, &|s: &mut CutSequence| {
        if let Some(part) = &mut s.part {
            part.side = -part.side;
        }
    });
    add("on the other side of the drive surface", true, &|s: &mut CutSequence| {
        s.drive_side = DriveSide::Left;
    });
    add("with TO for PAST", true, &|s: &mut CutSequence| {
        if let Some(stop) = &mut s.stop {
            stop.role.relation = match stop.role.relation {
                Relation::To => Relation::Past,
                Relation::Past => Relation::To,
                _ => Relation::Past,
            };
        }
    });
    found
}

/// Whether a sequence is in its bands at many places of every vector, a little more allowed than the band.
fn is_in_band(motion: &Motion, sequence: &CutSequence) -> bool {
    let mut from = sequence.start.tip;
    for point in &sequence.points {
        for k in 0..=SAMPLES {
            let tip = from + (point.tip - from) * (f64::from(k) / f64::from(SAMPLES));
            let read = motion.read(&sequence.cutter, tip);
            if !read.is_some_and(|r| r.iter().all(|g| g.abs() <= BAND * (1.0 + 1e-3))) {
                return false;
            }
        }
        from = point.tip;
    }
    true
}

fn mutate(motion: &Motion, sequence: &CutSequence, tally: &mut Tally) {
    for (name, sure, mutated) in mutations(sequence) {
        tally.mutated += 1;
        let accepted = verify(&mutated, &|| false).is_ok_and(|e| e.verified);
        if accepted && (sure || !is_in_band(motion, &mutated)) {
            tally.missed.push(name.to_owned());
        }
    }
}

impl Tally {
    fn is_remarkable(&self) -> bool {
        [&self.broken, &self.refused, &self.missed].iter().any(|list| !list.is_empty())
    }
}

fn kind(failure: &MotionFailure) -> String {
    let words = format!("{failure:?}");
    words.split([' ', '{', '(']).next().unwrap_or_default().to_owned()
}

fn run(motion: &Motion, cutter: &str, mutating: bool, tally: &mut Tally) {
    tally.motions += 1;
    let mut state = State::new(1.0);
    for (step, command) in motion.commands().iter().enumerate() {
        let execution = execute(&state, command, &|| false);
        state = execution.state;
        if let Some(failure) = execution.failure {
            let path = motion.has_path();
            tally.refused_with_path += usize::from(path);
            let path = if path { "though there is a path" } else { "and no path was found" };
            tally.refused.push(format!("{cutter}, step {step}: {} {path}: {failure:?}", kind(&failure)));
            return;
        }
        let Some(Output::Sequence(sequence)) = execution.output else { continue };
        match verify(&sequence, &|| false) {
            Ok(evidence) if evidence.verified => {
                tally.proven += 1;
                if mutating && !sequence.start_up {
                    mutate(motion, &sequence, tally);
                }
            }
            found => tally.broken.push(format!("{cutter}, step {step}: {found:?}")),
        }
    }
}

fn describe(pairs: &BTreeMap<String, Tally>) -> String {
    let mut report = String::new();
    for (pair, tally) in pairs.iter().filter(|(_, t)| t.is_remarkable()) {
        let (refused, broken) = (tally.refused.len(), tally.broken.len());
        let _ = writeln!(
            report,
            "{pair}: {} proven, {refused} of {} refused, {broken} broken",
            tally.proven, tally.motions
        );
        for line in tally.broken.iter().chain(&tally.refused).chain(&tally.missed) {
            let _ = writeln!(report, "    {line}");
        }
    }
    report
}

/// Motions of every pair in the long run, for which the variable `APT_CASES` of the environment has so many of its own.
const SHARE: usize = 500;

/// Motions of every pair: one, or a share of those that `APT_CASES` asks for.
fn cases() -> usize {
    std::env::var("APT_CASES").ok().and_then(|n| n.parse().ok()).map_or(1, |n: usize| n.div_ceil(SHARE))
}

#[test]
fn curved_pairs_are_proven_and_seldom_refused() {
    let mut random = Random(19_700_101);
    let mut pairs: BTreeMap<String, Tally> = BTreeMap::new();
    let mut turn = 0;
    for round in 0..cases() {
        for (part_index, drive_index) in (0..PARTS).flat_map(|p| (0..DRIVES).map(move |d| (p, d))) {
            // The surfaces with straight rulings are the slowest by far: every second pair of theirs, in turn.
            let slow = part_index >= 6 || drive_index >= 5;
            if slow && (part_index + drive_index + round) % 2 == 0 {
                continue;
            }
            // Ruled surfaces take longer still: from the second round on.
            let ruled = part_index + 1 == PARTS || drive_index + 1 == DRIVES;
            if ruled && round == 0 {
                continue;
            }
            let (part_name, part, up) = parts(&mut random).swap_remove(part_index);
            let (drive_name, drive, side) = drives(&mut random).swap_remove(drive_index);
            let (cutter_name, cutter) = CUTTERS[turn % CUTTERS.len()];
            let until = random.pick(&[Relation::On, Relation::To, Relation::Past]);
            turn += 1;
            let motion = Motion { cutter: cutter.to_vec(), part: (part, up), drive: (drive, side), until };
            let tally = pairs.entry(format!("{part_name} along {drive_name}")).or_default();
            run(&motion, cutter_name, !slow && turn % 4 == 1 && turn < 16, tally);
        }
    }
    let report = describe(&pairs);
    println!("{report}");
    let broken: usize = pairs.values().map(|t| t.broken.len()).sum();
    assert_eq!(broken, 0, "\n{report}");
    let missed: usize = pairs.values().map(|t| t.missed.len()).sum();
    let mutated: usize = pairs.values().map(|t| t.mutated).sum();
    assert!(missed == 0 && mutated > 0, "{missed} of {mutated} mutated sequences accepted\n{report}");
    let motions: usize = pairs.values().map(|t| t.motions).sum();
    let refused: usize = pairs.values().map(|t| t.refused_with_path).sum();
    assert!(refused as f64 <= REFUSALS * motions as f64, "{refused} of {motions} refused\n{report}");
}
