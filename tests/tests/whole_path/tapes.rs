//! Tapes of whole programs in the real interpreter.

use std::collections::BTreeSet;

use apt_geometry::Vec3;
use apt_ide::Analysis;
use apt_ide::difference::Units;
use apt_tests::{
    oracle::programs,
    runs::{Location, analysis, examples, path_of, read, report, title},
};
use serde_json::Value;

use crate::interpreter::{
    Call, follow, interpret,
    rotary::{Goal, follow_turning, moves as joints},
};

const MACHINE: &str = "linuxcnc-mill3";
/// One on which the tool may lean, its tolerance in millimetres and degrees.
const FIVE_AXES: (&str, f64, f64) = ("linuxcnc-mill5", 0.025, 0.1);

/// Programs whose tape the machine cannot make, and why; the test fails when this list is wrong in either direction.
const NO_TAPE: [(&str, &str); 0] = [];

fn tape(analysis: &Analysis) -> apt_post::Tape {
    analysis.tape(MACHINE, &|| false, &mut |_, _| {}).unwrap().tape
}

/// Tools that the program loads.
fn tools(report: &Value) -> Vec<u32> {
    let mut tools = BTreeSet::new();
    for entry in report["cl"].as_array().into_iter().flatten() {
        if entry["words"][0] == "LOADTL" {
            tools.extend(entry["words"][1].as_f64().map(|number| number as u32));
        }
    }
    tools.into_iter().collect()
}

/// Positions to which the machine moves, with the kind of move.
fn moves(path: &[Location]) -> Vec<(bool, [f64; 3])> {
    path.iter().filter(|location| !location.from).map(|location| (location.rapid, location.at)).collect()
}

/// How far points may be from fitted arcs: the widest tolerance of the program, each way.
fn widest_tolerance(report: &Value) -> f64 {
    let mut widest: f64 = 0.0005;
    for entry in report["cl"].as_array().into_iter().flatten() {
        if matches!(entry["words"][0].as_str(), Some("INTOL" | "OUTTOL")) {
            let values = entry["words"].as_array().unwrap().iter().filter_map(Value::as_f64);
            widest = values.fold(widest, f64::max);
        }
    }
    2.0 * widest
}

/// Runs the tape to its end and follows it along the CL file; the number of straight moves and of arcs.
fn followed(analysis: &Analysis) -> (usize, usize) {
    let report = report(analysis).unwrap();
    let tape = tape(analysis);
    let calls = interpret(&tape.text(), &tools(&report));
    assert_eq!(calls.last(), Some(&Call::End));
    follow(&calls, &moves(&path_of(&report)), widest_tolerance(&report) + 1.0e-4)
}

#[test]
fn every_example_runs_to_its_end_along_its_path() {
    let (mut upright, mut leaning) = (0, 0);
    for path in examples() {
        let analysis = analysis(&read(&path), "free");
        let report = report(&analysis).unwrap();
        if path_of(&report).iter().any(|location| location.axis != [0.0, 0.0, 1.0]) {
            let tape = analysis.tape(FIVE_AXES.0, &|| false, &mut |_, _| {}).unwrap().tape;
            assert!(tape.is_ok(), "{}: {:?}", title(&path), tape.findings);
            // Its holes lean, too, so that the control makes them: what it does is looked at with the post-processor.
            assert!(!joints(&tape.text(), &tools(&report)).is_empty());
            leaning += 1;
            continue;
        }
        let tape = tape(&analysis);
        assert!(tape.is_ok(), "{}: {:?}", title(&path), tape.findings);
        let (straight, arcs) = followed(&analysis);
        assert!(straight + arcs > 0, "{}", title(&path));
        upright += 1;
    }
    assert!(upright > 0 && leaning > 0);
}

/// The programs of the oracle say nothing about spindle and feed, which the machine wants to know.
fn with_feed(text: &str) -> String {
    let (first, rest) = text.split_once('\n').unwrap();
    format!("{first}\nSPINDL/1000,CLW\nFEDRAT/10\n{rest}")
}

#[test]
fn every_oracle_program_runs_to_its_end_along_its_path() {
    let mut without = BTreeSet::new();
    let (mut count, mut straight, mut arcs) = (0, 0, 0);
    for group in ["motion2d", "motion3d", "language"] {
        for path in programs(group) {
            let analysis = analysis(&with_feed(&read(&path)), "free");
            let report = report(&analysis).unwrap();
            if !tape(&analysis).is_ok() {
                println!("{}: {:?}", title(&path), tape(&analysis).findings.first());
                without.insert(title(&path));
                continue;
            }
            if path_of(&report).iter().all(|location| location.from) {
                continue;
            }
            println!("{}", title(&path));
            let (lines, circles) = followed(&analysis);
            (count, straight, arcs) = (count + 1, straight + lines, arcs + circles);
        }
    }
    println!("{count} tapes: {straight} straight moves, {arcs} arcs");
    let listed: BTreeSet<String> = NO_TAPE.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(without, listed);
    assert!(NO_TAPE.iter().all(|(_, reason)| reason.len() > 10), "every entry says why");
    assert!(count > 70, "{count} tapes");
}

/// Where the tool leans and turns the tables follow it: their joints keep the tool end on its way.
#[test]
fn tapes_of_tools_that_lean_keep_them_on_their_way() {
    let (machine, tip, axis) = FIVE_AXES;
    let (mut count, mut blocks) = (0, 0);
    for group in ["multaxis", "apt4-motion"] {
        for path in programs(group) {
            let analysis = analysis(&with_feed(&read(&path)), "free");
            let report = report(&analysis).unwrap();
            let locations = path_of(&report);
            if locations.iter().all(|location| location.axis == [0.0, 0.0, 1.0]) {
                continue;
            }
            let tape = analysis.tape(machine, &|| false, &mut |_, _| {}).unwrap().tape;
            assert!(tape.is_ok(), "{}: {:?}", title(&path), tape.findings);
            let goals: Vec<Goal> = locations
                .iter()
                .filter(|location| !location.from)
                .map(|location| Goal {
                    rapid: location.rapid,
                    tip: location.at.into(),
                    axis: Vec3::from(location.axis).normalize(),
                })
                .collect();
            println!("{}", title(&path));
            let inches = tape.units == Units::Inches;
            let moves = joints(&tape.text(), &tools(&report));
            follow_turning(&moves, &goals, inches, tip, axis);
            (count, blocks) = (count + 1, blocks + moves.len());
        }
    }
    println!("{count} tapes of {blocks} moves");
    assert!(count > 5, "{count} tapes");
}
