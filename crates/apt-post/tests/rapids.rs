//! The order in which the axes move in a rapid.

use apt_cldata::text::read_text;
use apt_post::{PostOptions, machine, post};

/// The blocks behind the approach, without sequence numbers and up to the end of the program.
fn blocks(name: &str, statements: &str) -> Vec<String> {
    let text = format!("UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nRAPID\nGOTO/0,0,50\n{statements}FINI\n");
    let (records, errors) = read_text(&text);
    assert_eq!(errors, vec![]);
    let machine = machine(name).unwrap_or_else(|error| panic!("{error}"));
    let tape = post(&records, &machine, &PostOptions::default());
    assert!(tape.is_ok(), "{name}: {:?}\n{}", tape.findings, tape.text());
    let bare = |line: &str| line.split_once(' ').map_or(line, |(_, rest)| rest).to_owned();
    let blocks: Vec<String> = tape.text().lines().map(bare).collect();
    let start = blocks.iter().position(|block| block.starts_with("G43")).map_or(0, |at| at + 1);
    blocks[start..].iter().take_while(|block| *block != "M5").cloned().collect()
}

#[test]
fn a_rapid_rises_before_it_goes_aside_and_falls_after() {
    let statements = "RAPID\nGOTO/10,20,5\nRAPID\nGOTO/30,40,60\nRAPID\nGOTO/50,40,60\nRAPID\nGOTO/50,40,2\n";
    let in_steps = ["X10. Y20.", "Z5.", "Z60.", "X30. Y40.", "X50.", "Z2."];
    assert_eq!(blocks("fanuc-mill3", statements), in_steps);
    assert_eq!(blocks("haas-mill3", statements), in_steps);
    // A rapid of LinuxCNC is a straight line, and so it is on the CL file.
    let straight = ["X10. Y20. Z5.", "X30. Y40. Z60.", "X50.", "Z2."];
    assert_eq!(blocks("linuxcnc-mill3", statements), straight);
}

#[test]
fn the_axis_that_moves_apart_may_be_stated() {
    let statements = "RAPID/ZAXIS\nGOTO/10,20,5\nRAPID/XAXIS\nGOTO/30,40,60\nRAPID/TOOL\nGOTO/0,0,70\nRAPID/YAXIS\nGOTO/50,-40,2\n";
    let in_steps = ["X10. Y20.", "Z5.", "X30.", "Y40. Z60.", "Z70.", "X0. Y0.", "X50. Z2.", "Y-40."];
    for name in ["fanuc-mill3", "haas-mill3", "linuxcnc-mill3"] {
        assert_eq!(blocks(name, statements), in_steps, "{name}");
    }
    // It is stated for one motion.
    let next = "RAPID/XAXIS\nGOTO/10,20,50\nRAPID\nGOTO/30,40,50\n";
    assert_eq!(blocks("fanuc-mill3", next), ["X10.", "Y20.", "X30. Y40."]);
}

#[test]
fn a_rapid_from_nobody_knows_where_has_one_block() {
    let statements = "INSERT G4 P1\nRAPID\nGOTO/10,20,60\n";
    assert_eq!(blocks("fanuc-mill3", statements)[1..], ["G0 X10. Y20. Z60."]);
}
