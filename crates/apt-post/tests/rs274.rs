//! The tape in the real interpreter: it runs to its end, and its moves are those of the CL file.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

mod interpreter;
#[path = "rs274/rotary.rs"]
mod rotary;

use apt_cldata::{
    record::{ClKind, ClRecord},
    text::read_text,
};
use apt_post::{MachineDefinition, MachineError, PostOptions, Tape, definition_file, machine, post};
use interpreter::{Call, TOLERANCE, follow, interpret, near};
use proptest::prelude::*;

fn mill() -> MachineDefinition {
    machine("linuxcnc-mill3").unwrap()
}

fn records(text: &str) -> Vec<ClRecord> {
    let (records, errors) = read_text(text);
    assert_eq!(errors, vec![]);
    records
}

/// The mill, told no centres of arcs but their radii.
fn mill_by_radius() -> MachineDefinition {
    let text = definition_file("linuxcnc-mill3").unwrap();
    let own = text.replace("center = \"incremental\"", "center = \"radius\"");
    assert_ne!(own, text);
    MachineDefinition::from_toml(&own).unwrap()
}

fn tape(text: &str) -> Tape {
    tape_for(&mill(), text)
}

fn tape_for(machine: &MachineDefinition, text: &str) -> Tape {
    let tape = post(&records(text), machine, &PostOptions::default());
    assert!(tape.is_ok(), "{:?}\n{}", tape.findings, tape.text());
    tape
}

/// CL positions with their move: rapid or feed.
fn path(records: &[ClRecord]) -> Vec<(bool, [f64; 3])> {
    let mut rapid = false;
    let mut path = Vec::new();
    for record in records {
        match &record.kind {
            ClKind::Postprocessor { word, .. } if word == "RAPID" => rapid = true,
            ClKind::Motion { from: false, points, .. } => {
                path.extend(points.iter().map(|point| (rapid, point.position.into())));
                rapid = false;
            }
            _ => {}
        }
    }
    path
}

#[test]
fn straight_moves_with_tool_spindle_and_coolant() {
    let text = "PARTNO SLOT 1001\nUNITS/INCHES\nLOADTL/1\nSPINDL/1200,CLW\nCOOLNT/ON\nRAPID\nGOTO/-1,0,2\nRAPID\n\
                GOTO/-1,0,.1\nFEDRAT/5,IPM\nGOTO/-1,0,-.25\nFEDRAT/20,IPM\nGOTO/3,0,-.25\nRAPID\nGOTO/3,0,2\n\
                COOLNT/OFF\nSPINDL/OFF\nFINI\n";
    let calls = interpret(&tape(text).text(), &[1]);
    assert_eq!(follow(&calls, &path(&records(text)), 0.0), (5, 0));
    let rates: Vec<&Call> = calls.iter().filter(|call| matches!(call, Call::FeedRate(_))).collect();
    assert_eq!(rates, [&Call::FeedRate(5.0), &Call::FeedRate(20.0)]);
    for wanted in [Call::Tool(1), Call::SpindleClockwise, Call::Flood] {
        assert!(calls.contains(&wanted), "{wanted:?}");
    }
}

#[test]
fn stated_arcs_in_all_planes_and_both_senses() {
    let start = "UNITS/MM\nFROM/0,0,50\nSPINDL/1000,CLW\nFEDRAT/100,MMPM\n";
    let cases = [
        "GOTO/40,20,-3\nCIRCLE/40,45,-3,0,0,1,25\nGOTO/65,45,-3\nGOTO/65,90,-3\n",
        "GOTO/40,20,-3\nCIRCLE/40,45,-3,0,0,-1,25\nGOTO/65,45,-3\nGOTO/65,90,-3\n",
        "GOTO/5,0,0\nCIRCLE/0,0,0,0,1,0,5\nGOTO/0,0,-5\n",
        "GOTO/5,0,0\nCIRCLE/0,0,0,0,1,0,5\nGOTO/0,0,5\n",
        "GOTO/0,5,0\nCIRCLE/0,0,0,1,0,0,5\nGOTO/0,0,5\n",
        "GOTO/0,5,0\nCIRCLE/0,0,0,-1,0,0,5\nGOTO/0,0,5\n",
    ];
    for case in cases {
        let text = format!("{start}{case}FINI\n");
        let calls = interpret(&tape(&text).text(), &[1]);
        let (_, arcs) = follow(&calls, &path(&records(&text)), TOLERANCE);
        assert_eq!(arcs, 1, "{case}");
    }
}

#[test]
fn arcs_turn_the_way_the_points_go() {
    let text = "UNITS/MM\nFROM/0,0,50\nSPINDL/1000,CLW\nFEDRAT/100,MMPM\nGOTO/40,20,-3\n\
                CIRCLE/40,45,-3,0,0,1,25\nGOTO/65,45,-3\nFINI\n";
    let sense = |text: &str| {
        interpret(&tape(text).text(), &[])
            .into_iter()
            .find_map(|call| match call {
                Call::Arc { turns, center, .. } => Some((turns, center)),
                _ => None,
            })
            .unwrap()
    };
    assert_eq!(sense(text), (1, [40.0, 45.0, 0.0]));
    assert_eq!(sense(&text.replace("0,0,1,25", "0,0,-1,25")), (-1, [40.0, 45.0, 0.0]));
}

#[test]
fn thread_milling_helix_of_two_turns() {
    let text = "UNITS/MM\nLOADTL/2\nSPINDL/4000,CLW\nRAPID\nGOTO/5,0,2\nFEDRAT/200,MMPM\nGOTO/5,0,-2\n\
                FEDRAT/300,MMPM\nCIRCLE/0,0,-2,0,0,1,5\nGOTO/5,0,-.5\nCIRCLE/0,0,-.5,0,0,1,5\nGOTO/5,0,1\nGOTO/0,0,1\nFINI\n";
    let calls = interpret(&tape(text).text(), &[2]);
    let arcs: Vec<&Call> = calls.iter().filter(|call| matches!(call, Call::Arc { .. })).collect();
    let turn = |z: f64| Call::Arc { end: [5.0, 0.0, z], center: [0.0, 0.0, 0.0], turns: 1, axis: 2 };
    assert_eq!(arcs, [&turn(-0.5), &turn(1.0)]);
    assert_eq!(follow(&calls, &path(&records(text)), TOLERANCE).1, 2);
}

#[test]
fn chord_points_outside_the_circle_become_one_arc_with_its_ends_kept() {
    // The vertices stand off the circle by the tolerance, as the arithmetic element leaves them; the ends do not.
    let outside = 0.01_f64;
    let mut text =
        "UNITS/MM\nINTOL/0\nOUTTOL/.01\nFROM/0,0,50\nSPINDL/1000,CLW\nFEDRAT/100,MMPM\nGOTO/20,0,0\n\
                    CIRCLE/0,0,0,0,0,1,20\n"
            .to_owned();
    for step in 1..30 {
        let (sine, cosine) = (f64::from(step) * 0.05).sin_cos();
        let radius = 20.0 + outside;
        text += &format!("GOTO/{},{},0\n", radius * cosine, radius * sine);
    }
    text += &format!("GOTO/{},{},0\nGOTO/0,50,0\nFINI\n", 20.0 * 1.5_f64.cos(), 20.0 * 1.5_f64.sin());
    let calls = interpret(&tape(&text).text(), &[]);
    let (_, arcs) = follow(&calls, &path(&records(&text)), outside + TOLERANCE);
    assert_eq!(arcs, 1);
}

#[test]
fn runs_of_points_are_fitted_when_their_chords_are_fine_enough() {
    let circle = |count: u32, outtol: &str| {
        let mut text =
            format!("UNITS/MM\n{outtol}FROM/0,0,50\nSPINDL/1000,CLW\nFEDRAT/100,MMPM\nGOTO/20,0,0\n");
        for step in 1..=count {
            let (sine, cosine) = (f64::from(step) * 1.2 / f64::from(count)).sin_cos();
            text += &format!("GOTO/{},{},0\n", 20.0 * cosine, 20.0 * sine);
        }
        text + "FINI\n"
    };
    let arcs = |text: &str| {
        let calls = interpret(&tape(text).text(), &[]);
        follow(&calls, &path(&records(text)), 0.005).1
    };
    assert_eq!(arcs(&circle(40, "")), 1);
    // Coarse chords are a polygon unless the tolerance says otherwise.
    assert_eq!(arcs(&circle(6, "")), 0);
    assert_eq!(arcs(&circle(6, "OUTTOL/.2\n")), 1);
}

#[test]
fn drilling_in_every_cycle() {
    let holes = "GOTO/10,10,0\nGOTO/35,10,0\nGOTO/60,10,-5\nCYCLE/OFF\nRAPID\nGOTO/60,10,50\nFINI\n";
    let start = "UNITS/MM\nLOADTL/5\nSPINDL/1800,CLW\nRAPID\nGOTO/10,10,50\nFEDRAT/180,MMPM\n";
    for (cycle, passes) in [
        ("DRILL,DEPTH,18.8026,CLEAR,3", 1),
        ("FACE,DEPTH,18.8026,CLEAR,3,DWELL,.5", 1),
        ("REAM,DEPTH,18.8026,CLEAR,3", 2),
        ("BORE,DEPTH,18.8026,CLEAR,3", 1),
        ("DEEP,DEPTH,18.8026,STEP,8,CLEAR,3", 3),
        ("BRKCHP,DEPTH,18.8026,STEP,8,CLEAR,3", 3),
    ] {
        let calls = interpret(&tape(&format!("{start}CYCLE/{cycle}\n{holes}")).text(), &[5]);
        let feeds: Vec<[f64; 3]> = calls
            .iter()
            .filter_map(|call| match call {
                Call::Feed(end) => Some(*end),
                _ => None,
            })
            .collect();
        assert_eq!(feeds.len(), 3 * passes, "{cycle}: {feeds:?}");
        for (x, top) in [(10.0, 0.0), (35.0, 0.0), (60.0, -5.0)] {
            let bottom = feeds.iter().filter(|end| near(**end, [x, 10.0, top - 18.8026], TOLERANCE)).count();
            assert_eq!(bottom, 1, "{cycle}: {feeds:?}");
        }
        // Without RTRCTO the tool goes back to where it came from.
        assert_eq!(
            calls
                .iter()
                .filter(|call| matches!(call, Call::Traverse(end) if end[2] == 50.0 && end[0] == 35.0))
                .count(),
            2,
            "{cycle}"
        );
    }
}

#[test]
fn cycles_of_two_tools_and_of_moves() {
    let program = |direction: &str, cycle: &str| {
        format!(
            "UNITS/MM\nLOADTL/5\nSPINDL/600,{direction}\nRAPID\nGOTO/0,0,50\nCYCLE/{cycle},DEPTH,10,CLEAR,3,MMPM,600\n\
             GOTO/10,10,0\nGOTO/35,10,0\nCYCLE/OFF\nRAPID\nGOTO/0,0,50\nFINI\n"
        )
    };
    for (direction, cycle, bottoms) in [
        ("CCLW", "REVERS", 1),
        ("CLW", "SHIFT,OFFSET,.5", 1),
        ("CLW", "SHIFT,OFFSET,.3,-.4,ORIENT,45,TIMES,2", 2),
        ("CLW", "DRILL,TIMES,3", 3),
        ("CLW", "BORE9,DWELL,1,REPEAT,2", 2),
    ] {
        let calls = interpret(&tape(&program(direction, cycle)).text(), &[5]);
        for x in [10.0, 35.0] {
            let made = calls
                .iter()
                .filter(|call| matches!(call, Call::Feed(end) if near(*end, [x, 10.0, -10.0], TOLERANCE)))
                .count();
            assert_eq!(made, bottoms, "{cycle}: {calls:?}");
        }
    }
}

#[test]
fn retract_planes_of_a_cycle() {
    let program = |retract: &str| {
        format!(
            "UNITS/MM\nLOADTL/5\nSPINDL/1800,CLW\nRAPID\nGOTO/0,0,50\nCYCLE/DRILL,DEPTH,10,CLEAR,3,MMPM,180{retract}\n\
             GOTO/10,10,0\nGOTO/35,10,0\nCYCLE/OFF\nFINI\n"
        )
    };
    let between = |retract: &str| {
        let calls = interpret(&tape(&program(retract)).text(), &[5]);
        let over = calls.iter().find_map(|call| match call {
            Call::Traverse(end) if end[0] == 35.0 => Some(end[2]),
            _ => None,
        });
        over.unwrap()
    };
    assert_eq!(between(",RTRCTO,AUTO"), 50.0);
    assert_eq!(between(",RTRCTO,3"), 3.0);
    assert_eq!(between(",RTRCTO,20"), 20.0);
}

#[test]
fn rigid_tapping() {
    let text = "UNITS/INCHES\nLOADTL/4\nSPINDL/600,CLW\nRAPID\nGOTO/1,3,2\nCYCLE/TAP,DEPTH,.4,TPI,20,CLEAR,.2\n\
                GOTO/1,3,0\nGOTO/2,3,0\nCYCLE/OFF\nFINI\n";
    let calls = interpret(&tape(text).text(), &[4]);
    let taps: Vec<&Call> = calls.iter().filter(|call| matches!(call, Call::Tap(_))).collect();
    assert_eq!(taps, [&Call::Tap([1.0, 3.0, -0.4]), &Call::Tap([2.0, 3.0, -0.4])]);
}

#[test]
fn cutter_compensation() {
    let text = "UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nRAPID\nGOTO/-20,-20,10\nRAPID\nGOTO/-20,-20,-5\nFEDRAT/600\n\
                CUTCOM/LEFT,1\nGOTO/0,-10,-5\nGOTO/0,40,-5\nGOTO/50,40,-5\nGOTO/50,0,-5\nGOTO/-10,0,-5\nCUTCOM/OFF\n\
                GOTO/-20,-20,-5\nFINI\n";
    let calls = interpret(&tape(text).text(), &[1]);
    // The tool of the table is a quarter inch: 3.175 mm to the left of x = 0.
    assert!(
        calls.iter().any(|call| matches!(call, Call::Feed(end) if (end[0] + 3.175).abs() < TOLERANCE)),
        "{calls:?}"
    );
    assert!(
        matches!(calls.iter().rev().find(|call| matches!(call, Call::Feed(_))), Some(Call::Feed(end)) if near(*end, [-20.0, -20.0, -5.0], TOLERANCE))
    );
}

#[test]
fn feed_modes_delays_and_stops() {
    let text = "UNITS/MM\nFROM/0,0,10\nSPINDL/1200,CLW\nFEDRAT/.2,MMPR\nGOTO/10,0,10\nFEDRAT/100,MMPM\nGOTO/10,10,10\n\
                FEDRAT/INVERS,AUTO\nGOTO/10,60,10\nGOTO/10,65,10\nFEDRAT/200,MMPM\nGOTO/0,0,10\nDELAY/1.5\nDELAY/10,REV\n\
                STOP\nOPSTOP\nGOHOME\nEND\nFINI\n";
    let made = tape(text);
    let calls = interpret(&made.text(), &[]);
    let dwells: Vec<&Call> = calls.iter().filter(|call| matches!(call, Call::Dwell(_))).collect();
    assert_eq!(dwells, [&Call::Dwell(1.5), &Call::Dwell(0.5)]);
    for wanted in ["G95", "G93", "F2.", "F20.", "M0", "M1", "G53"] {
        assert!(made.text().contains(wanted), "{wanted}\n{}", made.text());
    }
}

#[test]
fn a_tape_with_an_error_is_not_ok_and_the_interpreter_agrees() {
    let text = "UNITS/MM\nFROM/0,0,10\nSPINDL/1200,CLW\nGOTO/10,0,10\nFINI\n";
    let made = post(&records(text), &mill(), &PostOptions::default());
    assert!(!made.is_ok());
    assert!(!interpreter::run(&made.text(), &[]).contains("PROGRAM_END"));
}

/// Arcs one after another about one centre are one: what is told by radii is divided between positions of the CL file, too.
fn joined(calls: &[Call]) -> Vec<Call> {
    let mut joined: Vec<Call> = Vec::new();
    for call in calls.iter().filter(|call| !matches!(call, Call::FeedRate(_))) {
        if let Call::Arc { end, center, turns, axis } = call
            && let Some(Call::Arc { end: last, center: before, turns: same, axis: across }) =
                joined.last_mut()
            && (turns, axis) == (same, across)
            && (0..3).all(|k| k == *axis || (center[k] - before[k]).abs() <= RADIUS_TOLERANCE)
        {
            *last = *end;
        } else {
            joined.push(call.clone());
        }
    }
    joined
}

/// How far the last decimals of ends and radii, and the tolerance of the machine, move the centre of an arc.
const RADIUS_TOLERANCE: f64 = 0.01;

#[test]
fn arcs_by_radius_are_divided_where_a_radius_does_not_tell_them() {
    let start = "UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nRAPID\nGOTO/20,0,10\nFEDRAT/2,INVERS\nGOTO/20,0,0\n";
    // Sweep in degrees, rise, and the blocks that it takes: where the ends of half a turn are rounded the radius may be less than half the chord.
    for (sweep, rise, blocks) in [
        (90.0_f64, 0.0, 1),
        (150.0, 3.0, 1),
        (179.9, 0.0, 2),
        (180.0, 0.0, 1),
        (200.0, 0.0, 2),
        (-270.0, 1.0, 2),
        (-360.0, 0.0, 2),
    ] {
        let (sine, cosine) = sweep.to_radians().sin_cos();
        let text = format!(
            "{start}MOVARC/0,0,0,0,0,1,20,ANGLE,{sweep}\nGOTO/{},{},{rise}\nFINI\n",
            20.0 * cosine,
            20.0 * sine
        );
        let made = tape_for(&mill_by_radius(), &text).text();
        let calls = interpret(&made, &[1]);
        let (_, arcs) = follow(&joined(&calls), &path(&records(&text)), RADIUS_TOLERANCE);
        let lines: Vec<&str> = made.lines().filter(|line| line.contains(" R")).collect();
        assert_eq!((arcs, lines.len()), (1, blocks), "{sweep}: {made}");
        // An arc that is divided takes the time that the program tells.
        assert!(
            lines.iter().all(|line| line.contains("R20. ") && line.contains(&format!(" F{}.", 2 * blocks))),
            "{made}"
        );
        assert!(!made.contains(" I") && !made.contains(" J"), "{made}");
    }
}

#[test]
fn a_machine_that_is_told_radii_has_a_register_for_them() {
    let text =
        definition_file("linuxcnc-mill3").unwrap().replace("center = \"incremental\"", "center = \"radius\"");
    let without: String =
        text.lines().filter(|line| !line.starts_with("R = ")).map(|line| format!("{line}\n")).collect();
    assert_eq!(
        MachineDefinition::from_toml(&without),
        Err(MachineError::MissingRegister { register: "R".to_owned() })
    );
}

/// A step of a random program.
#[derive(Debug, Clone)]
enum Step {
    Go([f64; 3], bool),
    /// Turn by degrees about a centre at an offset from here, with a rise.
    Turn([f64; 2], f64, f64),
}

fn any_step() -> impl Strategy<Value = Step> {
    prop_oneof![
        (prop::array::uniform3(-400.0..400.0_f64), any::<bool>()).prop_map(|(at, rapid)| Step::Go(at, rapid)),
        (
            prop::array::uniform2(-60.0..60.0_f64),
            15.0..330.0_f64,
            any::<bool>(),
            prop_oneof![Just(0.0), -5.0..5.0_f64]
        )
            .prop_filter("a radius", |(center, ..)| center[0].hypot(center[1]) > 1.0)
            .prop_map(|(center, sweep, left, rise)| Step::Turn(
                center,
                if left { sweep } else { -sweep },
                rise
            )),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_path_comes_through(steps in prop::collection::vec(any_step(), 1..12), metric in any::<bool>()) {
        let unit = if metric { "MM" } else { "INCHES" };
        let shrink = if metric { 1.0 } else { 1.0 / 25.4 };
        let mut text = format!("UNITS/{unit}\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/50\nRAPID\nGOTO/0,0,10\n");
        let mut here = [0.0, 0.0, 10.0];
        let mut turns = 0;
        for step in steps {
            match step {
                Step::Go(at, rapid) => {
                    here = at.map(|value| value * shrink);
                    let word = if rapid { "RAPID\n" } else { "" };
                    text += &format!("{word}GOTO/{},{},{}\n", here[0], here[1], here[2]);
                }
                Step::Turn(arm, sweep, rise) => {
                    let arm = arm.map(|value| value * shrink);
                    let center = [here[0] + arm[0], here[1] + arm[1]];
                    let (sine, cosine) = sweep.to_radians().sin_cos();
                    let end = [
                        center[0] - arm[0] * cosine + arm[1] * sine,
                        center[1] - arm[0] * sine - arm[1] * cosine,
                        here[2] + rise * shrink,
                    ];
                    let radius = arm[0].hypot(arm[1]);
                    text += &format!(
                        "MOVARC/{},{},{},0,0,1,{radius},ANGLE,{sweep}\nGOTO/{},{},{}\n",
                        center[0], center[1], here[2], end[0], end[1], end[2]
                    );
                    here = end;
                    turns += 1;
                }
            }
        }
        text += "FINI\n";
        let calls = interpret(&tape(&text).text(), &[1]);
        let (_, arcs) = follow(&calls, &path(&records(&text)), 0.005 * shrink + TOLERANCE);
        prop_assert!(arcs >= turns, "{arcs} arcs of {turns}\n{text}");
        let calls = interpret(&tape_for(&mill_by_radius(), &text).text(), &[1]);
        let (_, arcs) = follow(&joined(&calls), &path(&records(&text)), RADIUS_TOLERANCE * shrink + TOLERANCE);
        prop_assert!(arcs >= turns, "{arcs} arcs of {turns} by radius\n{text}");
    }
}
