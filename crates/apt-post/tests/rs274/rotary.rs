//! Rotary axes in the real interpreter: where the tool end is on the part while slides and tables move, computed from its joints alone.

use apt_cldata::record::{ClKind, ClRecord};
use apt_geometry::Vec3;
use apt_post::{MachineDefinition, PostOptions, Tape, machine, post};
use proptest::prelude::*;

use super::{
    interpreter::rotary::{Goal, ROUNDED, follow_turning, moves, on_part},
    records,
};

fn mill() -> MachineDefinition {
    machine("linuxcnc-mill5").unwrap()
}

fn made(mill: &MachineDefinition, text: &str) -> Tape {
    let tape = post(&records(text), mill, &PostOptions::default());
    assert!(tape.is_ok(), "{:?}\n{}", tape.findings, tape.text());
    tape
}

/// Positions of a program with the direction of the tool; rapid or cut.
fn path(records: &[ClRecord]) -> Vec<Goal> {
    let mut rapid = false;
    let mut path = Vec::new();
    for record in records {
        match &record.kind {
            ClKind::Postprocessor { word, .. } if word == "RAPID" => rapid = true,
            ClKind::Motion { from: false, points, .. } => {
                path.extend(points.iter().map(|point| Goal {
                    rapid,
                    tip: point.position,
                    axis: point.axis.normalize(),
                }));
                rapid = false;
            }
            _ => {}
        }
    }
    path
}

#[test]
fn moves_on_which_tables_turn_keep_the_tool_on_its_way() {
    let text = "UNITS/MM\nMULTAX\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/1000\nRAPID\nGOTO/40,20,60,0,0,1\n\
                GOTO/40,20,10,0,-.5,.8660254\nGOTO/60,20,10,.5,0,.8660254\nGOTO/60,40,10,.353553,.353553,.866025\nFINI\n";
    let tape = made(&mill(), text);
    follow_turning(&moves(&tape.text(), &[1]), &path(&records(text)), false, 0.025, 0.1);
    assert!(tape.text().contains("G93"), "{}", tape.text());
}

#[test]
fn holes_in_faces_that_lean_are_drilled_by_the_control() {
    let text = "UNITS/MM\nMULTAX\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/200\nRAPID\nGOTO/0,0,50,0,0,1\nRAPID\n\
                GOTO/30,0,40,.6,0,.8\nCYCLE/DRILL,5,MMPM,100,2\nGOTO/20,0,10,.6,0,.8\nGOTO/20,10,10,.6,0,.8\n\
                CYCLE/OFF\nRAPID\nGOTO/30,0,40,.6,0,.8\nRAPID\nGOTO/0,30,40,0,.6,.8\nCYCLE/ON\nGOTO/0,20,10,0,.6,.8\nCYCLE/OFF\nFINI\n";
    let tape = made(&mill(), text);
    assert_eq!(tape.text().matches("G81").count(), 2, "{}", tape.text());
    let mut bottoms: Vec<Vec3> = Vec::new();
    for step in moves(&tape.text(), &[1]).iter().filter(|step| !step.rapid) {
        bottoms.push(on_part(step.to, 1.0).0);
    }
    let wanted =
        [(20.0, 0.0), (20.0, 10.0)].map(|(x, y)| Vec3::new(x, y, 10.0) - Vec3::new(0.6, 0.0, 0.8) * 5.0);
    let wanted = wanted.into_iter().chain([Vec3::new(0.0, 20.0, 10.0) - Vec3::new(0.0, 0.6, 0.8) * 5.0]);
    for (bottom, wanted) in bottoms.iter().zip(wanted) {
        assert!((bottom - wanted).norm() < ROUNDED, "{bottom:?} {wanted:?}");
    }
    assert_eq!(bottoms.len(), 3);
}

/// A circle square to a tool that leans lies in the XY plane once the tables have turned.
#[test]
fn a_circle_on_a_face_that_leans_is_an_arc() {
    let (mut text, axis) = (String::new(), Vec3::new(0.0, -0.6, 0.8));
    text.push_str("UNITS/MM\nMULTAX\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/200\nINTOL/.01\nOUTTOL/.01\nRAPID\nGOTO/10,0,0,0,-.6,.8\n");
    text.push_str("CIRCLE/0,0,0,0,-.6,.8,10\nGOTO/");
    let points: Vec<String> = (1..=90)
        .map(|step| {
            let (sine, cosine) = f64::from(step).to_radians().sin_cos();
            let place = Vec3::x() * (10.0 * cosine) + axis.cross(&Vec3::x()) * (10.0 * sine);
            format!("{:.7},{:.7},{:.7},0,-.6,.8", place.x, place.y, place.z)
        })
        .collect();
    text.push_str(&points.join("\nGOTO/"));
    text.push_str("\nFINI\n");
    let tape = made(&mill(), &text);
    assert!(tape.text().contains("G3 "), "{}", tape.text());
}

/// A program of cuts on which the tool turns, each with a rapid before it or not.
fn any_program() -> impl Strategy<Value = Vec<(bool, [f64; 3], f64, f64)>> {
    let place = [-80.0..80.0_f64, -80.0..80.0_f64, -10.0..60.0_f64];
    prop::collection::vec((prop::bool::weighted(0.2), place, 0.0..70.0_f64, -180.0..180.0_f64), 1..8)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn cuts_with_any_directions_keep_the_tool_on_its_way(steps in any_program()) {
        let mut text = "UNITS/MM\nMULTAX\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/1000\nRAPID\nGOTO/0,0,100,0,0,1\n".to_owned();
        for (rapid, [x, y, z], lean, toward) in steps {
            if rapid {
                text.push_str("RAPID\n");
            }
            let (out, up) = lean.to_radians().sin_cos();
            let (sine, cosine) = toward.to_radians().sin_cos();
            text.push_str(&format!(
                "GOTO/{x:.4},{y:.4},{z:.4},{:.9},{:.9},{:.9}\n",
                out * cosine, out * sine, up
            ));
        }
        text.push_str("FINI\n");
        let tape = made(&mill(), &text);
        follow_turning(&moves(&tape.text(), &[1]), &path(&records(&text)), false, 0.025, 0.1);
    }
}
