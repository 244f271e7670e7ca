//! Machines with rotary axes: worked tapes, what is found, and definitions that make no machine.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use apt_cldata::text::read_text;
use apt_post::{
    MachineDefinition, MachineError, PostFindingKind, PostOptions, Severity, Tape, definition_file, machine,
    post,
};
use expect_test::{Expect, expect};

#[path = "rotary/between.rs"]
mod between;
#[path = "rotary/follow.rs"]
mod follow;
#[path = "rotary/holes.rs"]
mod holes;
#[path = "rotary/mill.rs"]
mod mill;
#[path = "rotary/nutating.rs"]
mod nutating;
#[path = "rotary/random.rs"]
mod random;
#[path = "rotary/reader.rs"]
mod reader;
#[path = "rotary/statements.rs"]
mod statements;

fn tape_for(machine: &MachineDefinition, text: &str) -> Tape {
    let (records, errors) = read_text(text);
    assert_eq!(errors, vec![]);
    post(&records, machine, &PostOptions::default())
}

fn found(machine: &MachineDefinition, text: &str) -> Vec<PostFindingKind> {
    tape_for(machine, text).findings.into_iter().map(|finding| finding.kind).collect()
}

/// The tape between its first motion and the way home, without findings that are errors.
fn check(machine: &MachineDefinition, text: &str, expected: &Expect) {
    let tape = tape_for(machine, text);
    assert!(tape.is_ok(), "{:?}\n{}", tape.findings, tape.text());
    let body = tape.text();
    let from = body.find("M3\n").map_or(0, |at| at + 3);
    let body: String = body[from..].lines().flat_map(|line| [line, "\n"]).collect();
    expected.assert_eq(&body);
}

/// A bundled machine with some lines of its definition changed.
fn changed(name: &str, changes: &[(&str, &str)]) -> Result<MachineDefinition, MachineError> {
    let mut text = definition_file(name).unwrap().to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    MachineDefinition::from_toml(&text)
}

/// A tolerance that divides nothing, for what is computed by hand.
const WIDE: [(&str, &str); 2] = [
    ("tolerance_mm = 0.025", "tolerance_mm = 100.0"),
    ("axis_tolerance_degrees = 0.1", "axis_tolerance_degrees = 90.0"),
];

/// Rapids as they are told where no tolerance divides them.
const UNDIVIDED: (&str, &str) = ("rapid_tolerance_mm = 1.0", "");

const HEAD: &str = "UNITS/MM\nMULTAX\nLOADTL/1,LENGTH,0\nSPINDL/1000,CLW\nFEDRAT/1000\n";

const LEANING: &str = "RAPID\nGOTO/40,20,60,0,0,1\nGOTO/40,20,10,0,-.5,.8660254\nGOTO/60,20,10,.5,0,.8660254\n\
                       GOTO/60,40,10,.353553,.353553,.866025\nRAPID\nGOTO/60,40,90,.353553,.353553,.866025\nFINI\n";

#[test]
fn tables_without_division() {
    let mill = changed("linuxcnc-mill5", &WIDE).unwrap();
    check(
        &mill,
        &format!("{HEAD}{LEANING}"),
        &expect![[r#"
        N40 G0 A0. C0.
        N50 G0 X40. Y20.
        N60 G43 H1 Z60.
        N70 G93 G1 Y47.3205 Z-8.0385 A30. F20.
        N80 X20. Y-21.9615 Z31.9615 C90. F50.
        N90 X-14.1421 Y-31.2372 Z37.3169 C135. F50.
        N100 G0 Y8.7628 Z106.5989
        N110 M5
        N120 G53 G0 Z0.
        N130 G0 A0. C0.
        N140 M2
        %
    "#]],
    );
}

/// A head about whose axes the tool end is 200 away: 50 of the machine and a tool of 150.
#[test]
fn heads_without_division() {
    let mut changes = WIDE.to_vec();
    changes.extend([
        ("carried = \"table\"", "carried = \"head\""),
        ("chain = [\"C\", \"A\"]", "chain = [\"C\", \"A\"]\npivot_mm = 50.0"),
    ]);
    let mill = changed("linuxcnc-mill5", &changes).unwrap();
    let head = HEAD.replace("LENGTH,0", "LENGTH,150");
    check(
        &mill,
        &format!("{head}RAPID\nGOTO/0,0,10,0,0,1\nGOTO/0,0,0,0,0,1\nGOTO/10,0,0,.5,0,.8660254\nFINI\n"),
        &expect![[r#"
            N40 G0 A0. C90.
            N50 G0 X0. Y0.
            N60 G43 H1 Z10.
            N70 G1 Z0. F1000.
            N80 G93 X110. Z-26.7949 A30. F90.9091
            N90 M5
            N100 G53 G0 Z0.
            N110 G0 A0. C0.
            N120 M2
            %
        "#]],
    );
}

#[test]
fn a_head_over_a_table_without_division() {
    let mut changes = WIDE.to_vec();
    changes.extend([
        ("coordinates = \"tip\"", "coordinates = \"slides\""),
        ("pivot_mm = 0.0", "pivot_mm = 200.0"),
        ("follow_on = [\"G43.4 {!H}\"]", ""),
    ]);
    let mill = changed("fanuc-mill5", &changes).unwrap();
    check(
        &mill,
        &format!("{HEAD}RAPID\nGOTO/50,0,60,0,0,1\nGOTO/50,0,20,0,.5,.8660254\nFINI\n"),
        &expect![[r#"
        N40 G0 B0. C90.
        N50 G54 G0 X0. Y-50.
        N60 G43 H1 Z60.
        N70 G93 G1 X100. Z-6.795 B30. F25.
        N80 M5
        N90 G91 G28 Z0.
        N100 G90
        N110 G0 B0. C0.
        N120 M30
        %
    "#]],
    );
}

#[test]
fn a_control_that_follows_the_tool_end() {
    let mill = changed("fanuc-mill5", &WIDE).unwrap();
    check(
        &mill,
        &format!("{HEAD}{LEANING}"),
        &expect![[r#"
        N40 G0 B0. C-90.
        N50 G54
        N60 G43.4 H1
        N70 X40. Y20. Z60.
        N80 G1 Z10. B30. F1000.
        N90 X60. C0.
        N100 Y40. C45.
        N110 G0 Z90.
        N120 G49
        N130 M5
        N140 G91 G28 Z0.
        N150 G90
        N160 G0 B0. C0.
        N170 M30
        %
    "#]],
    );
}

#[test]
fn a_control_that_is_told_directions() {
    let mill = machine("sinumerik-mill5").unwrap();
    check(
        &mill,
        &format!("{HEAD}{LEANING}"),
        &expect![[r#"
        N50 G54
        N60 TRAORI
        ORIWKS ORIVECT
        N70 G0 X40 Y20 Z60 A3=0 B3=0 C3=1
        N80 G1 Z10 A3=0 B3=-0.5 C3=0.866025 F1000
        N90 X60 A3=0.5 B3=0 C3=0.866025
        N100 Y40 A3=0.353553 B3=0.353553 C3=0.866026
        N110 G0 Z90
        N120 TRAFOOF
        N130 M5
        N140 SUPA G0 Z0 D0
        N150 M30
    "#]],
    );
}

/// An upright tool is posted as on a machine without rotary axes, once these stand at 0.
#[test]
fn an_upright_tool_is_nothing_new() {
    let text = format!(
        "{HEAD}RAPID\nGOTO/0,0,10\nGOTO/0,0,0\nCYCLE/DRILL,5,MMPM,100,2\nGOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\nFINI\n"
    );
    for (three, five) in
        [("linuxcnc-mill3", "linuxcnc-mill5"), ("fanuc-mill3", "fanuc-mill5"), ("haas-mill3", "haas-mill5")]
    {
        let unnumbered = |name: &str| -> Vec<String> {
            let tape = tape_for(&machine(name).unwrap(), &text);
            assert!(tape.findings.is_empty(), "{:?}", tape.findings);
            let text = tape.text();
            let blocks =
                text.lines().map(|line| line.split_once(' ').map_or(line, |(_, rest)| rest).to_owned());
            blocks.filter(|block| !block.contains("A0.") && !block.contains("B0.")).collect()
        };
        let five = unnumbered(five);
        let three = unnumbered(three);
        assert!(three.iter().all(|block| five.contains(block)), "{three:#?}\n{five:#?}");
    }
}

/// Where the tool leans the control makes no cycle of its own while it follows the tool end, nor along a head that leans.
#[test]
fn holes_of_a_tool_that_leans_are_made_of_moves() {
    let text = format!(
        "{HEAD}RAPID\nGOTO/0,0,50,0,.6,.8\nCYCLE/DRILL,5,MMPM,100,2\nGOTO/0,0,0,0,.6,.8\nCYCLE/OFF\nRAPID\nGOTO/0,0,50,0,0,1\n\
         CYCLE/ON\nGOTO/0,0,0,0,0,1\nCYCLE/OFF\nFINI\n"
    );
    check(
        &changed("fanuc-mill5", &WIDE).unwrap(),
        &text,
        &expect![[r#"
        N40 G0 B36.87 C90.
        N50 G54
        N60 G43.4 H1
        N70 X0. Y0. Z50.
        N80 Y24. Z32.
        N90 Y1.2 Z1.6
        N100 G1 Y-3. Z-4. F100.
        N110 G0 Y24. Z32.
        N120 Z50. B0.
        N130 Y0.
        N140 Z2.
        N150 G1 Z-5.
        N160 G0 Z50.
        N170 G49
        N180 M5
        N190 G91 G28 Z0.
        N200 G90
        N210 G0 C0.
        N220 M30
        %
    "#]],
    );
}

/// While the tool stands along the axis of the table that turns, the table is turned to where the tool is to lean.
#[test]
fn a_table_turns_before_the_tool_leans() {
    let mill = changed("linuxcnc-mill5", &WIDE).unwrap();
    let text = format!(
        "{HEAD}RAPID\nGOTO/0,0,50,0,0,1\nGOTO/0,0,10,0,0,1\nGOTO/10,0,10,.5,0,.8660254\nGOTO/10,10,10,0,0,1\n\
         GOTO/10,20,10,0,-.5,.8660254\nFINI\n"
    );
    check(
        &mill,
        &text,
        &expect![[r#"
        N40 G0 A0. C90.
        N50 G0 X0. Y0.
        N60 G43 H1 Z50.
        N70 G1 Z10. F1000.
        N80 G93 Y21.3397 Z6.9615 A30. F100.
        N90 X10. Y-10. Z10. A0. F100.
        N100 Y10. C0. F60.
        N110 Y47.3205 Z-8.0385 A30. F100.
        N120 M5
        N130 G53 G0 Z0.
        N140 G0 A0.
        N150 M2
        %
    "#]],
    );
}

/// Round a cone, with a table that turns by half a turn at most.
fn round(turns: f64) -> String {
    let mut text = format!("{HEAD}RAPID\nGOTO/30,0,60,.5,0,.8660254\n");
    let steps = 12.0 * turns;
    for step in 0..=steps as u32 {
        let (sine, cosine) = (f64::from(step) * 30.0).to_radians().sin_cos();
        text += &format!(
            "GOTO/{:.6},{:.6},0,{:.9},{:.9},.866025404\n",
            30.0 * cosine,
            30.0 * sine,
            0.5 * cosine,
            0.5 * sine
        );
    }
    text + "FINI\n"
}

#[test]
fn an_axis_that_comes_to_its_end_in_the_cut_is_turned_back_off_the_part() {
    let limits = ("# Without limits_degrees it turns without end.", "limits_degrees = [-200.0, 200.0]");
    let endless = changed("linuxcnc-mill5", &WIDE).unwrap();
    assert_eq!(found(&endless, &round(2.0)), []);
    let limited = changed("linuxcnc-mill5", &[WIDE[0], WIDE[1], UNDIVIDED, limits]).unwrap();
    let kinds = found(&limited, &round(2.0));
    let [PostFindingKind::RotaryLimit { axis, least, greatest, positions, .. }] = &kinds[..] else {
        panic!("{kinds:?}")
    };
    assert_eq!((axis.as_str(), *least, *greatest), ("C", -200.0, 200.0));
    assert!(*positions > 10, "{positions}");
    assert_eq!(kinds[0].severity(), Severity::Error);
    let retract = ("warn_degrees = 10.0", "warn_degrees = 10.0\nretract_mm = 25.0");
    let retracting = changed("linuxcnc-mill5", &[WIDE[0], WIDE[1], UNDIVIDED, limits, retract]).unwrap();
    let kinds = found(&retracting, &round(2.0));
    assert!(
        !kinds.is_empty()
            && kinds.iter().all(|kind| matches!(kind, PostFindingKind::RotaryTurnedBack { .. })),
        "{kinds:?}"
    );
    check(
        &retracting,
        &round(1.5),
        &expect![[r#"
        N40 G0 A-30. C-90.
        N50 G0 X0. Y-29.0192
        N60 G43 H1 Z60.2628
        N70 G1 Y.9808 Z8.3013 F1000.
        N80 G93 C-60. F64.395
        N90 C-30. F64.395
        N100 C0. F64.395
        N110 C30. F64.395
        N120 C60. F64.395
        N130 C90. F64.395
        N140 C120. F64.395
        N150 C150. F64.395
        N160 C180. F64.395
        N170 G0 Z33.3013
        N180 C-180.
        N190 G94 G1 Z8.3013 F1000.
        N200 G93 C-150. F64.395
        N210 C-120. F64.395
        N220 C-90. F64.395
        N230 C-60. F64.395
        N240 C-30. F64.395
        N250 C0. F64.395
        N260 C30. F64.395
        N270 C60. F64.395
        N280 C90. F64.395
        N290 M5
        N300 G53 G0 Z0.
        N310 G0 A0. C0.
        N320 M2
        %
    "#]],
    );
}

#[test]
fn what_the_machine_does_not_reach_is_told() {
    let mill = machine("linuxcnc-mill5").unwrap();
    let under = format!(
        "{HEAD}RAPID\nGOTO/0,0,50,0,0,1\nGOTO/0,0,0,0,.1,-.994987\nGOTO/1,0,0,0,.1,-.994987\nGOTO/1,0,9,0,0,1\nFINI\n"
    );
    let kinds = found(&mill, &under);
    assert!(!kinds.is_empty() && kinds.iter().all(|kind| kind.severity() == Severity::Error), "{kinds:?}");
    // Round the pole: the tool leans by a degree, and the table turns by a right angle.
    let near =
        format!("{HEAD}RAPID\nGOTO/0,0,50,0,-.0174524,.9998477\nGOTO/10,0,50,.0174524,0,.9998477\nFINI\n");
    let kinds = found(&mill, &near);
    let [PostFindingKind::RotarySwing { axis, degrees, turned }] = &kinds[..] else { panic!("{kinds:?}") };
    assert!(axis == "C" && (degrees - 90.0).abs() < 1e-3 && (turned - 1.414).abs() < 1e-3, "{kinds:?}");
    let few = changed("linuxcnc-mill5", &[("most_parts = 10000", "most_parts = 3")]).unwrap();
    let kinds = found(&few, &format!("{HEAD}{LEANING}"));
    assert!(kinds.contains(&PostFindingKind::TooManyParts { most: 3 }), "{kinds:?}");
    let head = changed("linuxcnc-mill5", &[("carried = \"table\"", "carried = \"head\"")]).unwrap();
    let kinds = found(&head, &format!("{HEAD}{LEANING}").replace(",LENGTH,0", ""));
    assert_eq!(kinds, [PostFindingKind::NoToolLength]);
    let compensated = format!(
        "{HEAD}RAPID\nGOTO/0,0,50,0,0,1\nCUTCOM/LEFT,1\nGOTO/0,10,0,0,0,1\nGOTO/10,0,50,.5,0,.8660254\nFINI\n"
    );
    assert!(found(&mill, &compensated).contains(&PostFindingKind::CompensationTurns));
    let holes = format!(
        "{HEAD}RAPID\nGOTO/0,0,50,0,0,1\nCYCLE/DRILL,5,MMPM,100,2\nGOTO/0,10,0,0,0,1\nGOTO/10,0,0,.5,0,.8660254\nCYCLE/OFF\nFINI\n"
    );
    assert_eq!(found(&mill, &holes), [PostFindingKind::CycleTurns]);
}

#[test]
fn a_tool_that_leans_is_drawn_out_along_itself() {
    let mill = changed("linuxcnc-mill5", &WIDE).unwrap();
    let text =
        format!("{HEAD}CLEARP/40\nRAPID\nGOTO/0,0,50,.6,0,.8\nGOTO/0,0,0,.6,0,.8\nRETRCT\nPLUNGE\nFINI\n");
    check(
        &mill,
        &text,
        &expect![[r#"
        N40 G0 A36.8699 C90.
        N50 G0 X0. Y60.
        N60 G43 H1 Z30.
        N70 G1 Y30. Z-10. F1000.
        N80 G0 Z40.
        N90 Z-10.
        N100 M5
        N110 G53 G0 Z0.
        N120 G0 A0. C0.
        N130 M2
        %
    "#]],
    );
    let lies = format!("{HEAD}CLEARP/40\nRAPID\nGOTO/0,0,50,1,0,0\nGOTO/0,0,0,1,0,0\nRETRCT\nFINI\n");
    assert_eq!(found(&mill, &lies), [PostFindingKind::ClearanceNotReached { word: "RETRCT".into() }]);
}

#[test]
fn definitions_that_make_no_machine() {
    let cases: [(&[(&str, &str)], &str); 9] = [
        (&[("chain = [\"C\", \"A\"]", "chain = []")], "ChainLength { axes: 0 }"),
        (&[("chain = [\"C\", \"A\"]", "chain = [\"C\", \"B\"]")], "UnknownRotaryAxis { axis: \"B\" }"),
        (&[("prefer = { A = \"+\" }", "prefer = { B = \"+\" }")], "UnknownRotaryAxis { axis: \"B\" }"),
        (
            &[("chain = [\"C\", \"A\"]", "chain = [\"C\"]"), ("prefer = { A = \"+\" }", "")],
            "NotInChain { axis: \"A\" }",
        ),
        (&[("vector = [1.0, 0.0, 0.0]", "vector = [0.0, 0.0, -2.0]")], "ParallelAxes"),
        (
            &[("vector = [1.0, 0.0, 0.0]", "vector = [0.0, 0.0, 0.0]")],
            "NotPositive { place: \"rotary.A.vector\" }",
        ),
        (
            &[("limits_degrees = [-120.0, 120.0]", "limits_degrees = [120.0, -120.0]")],
            "Limits { place: \"rotary.A.limits_degrees\"",
        ),
        (&[("feed_inverse = \"G93\"", "")], "MissingCode { code: \"codes.feed_inverse\" }"),
        (&[("coordinates = \"slides\"", "coordinates = \"vector\"")], "MissingRegister { register: \"VI\" }"),
    ];
    for (changes, expected) in cases {
        let error = changed("linuxcnc-mill5", changes).unwrap_err();
        assert!(format!("{error:?}").starts_with(expected), "{error:?} for {changes:?}");
    }
    let error = changed(
        "fanuc-mill5",
        &[
            ("vector = [0.0, 0.0, 1.0]\ncarried = \"table\"", "vector = [0.0, 0.0, 1.0]\ncarried = \"head\""),
            ("vector = [0.0, 1.0, 0.0]\ncarried = \"head\"", "vector = [0.0, 1.0, 0.0]\ncarried = \"table\""),
        ],
    )
    .unwrap_err();
    assert_eq!(error, MachineError::TableBehindHead { table: "B".into(), head: "C".into() });
}

/// A table that turns and a fixed spindle: only what leans square to its axis is reached.
#[test]
fn one_rotary_axis_is_a_machine() {
    let text = definition_file("linuxcnc-mill5").unwrap();
    let from = text.find("[rotary.C]").unwrap();
    let to = text.find("[kinematics]").unwrap();
    let one =
        format!("{}{}", &text[..from], &text[to..]).replace("chain = [\"C\", \"A\"]", "chain = [\"A\"]");
    let one = one.replace("G0 {A} {C}", "G0 {A}").replace(WIDE[0].0, WIDE[0].1).replace(WIDE[1].0, WIDE[1].1);
    let mill = MachineDefinition::from_toml(&one).unwrap();
    check(
        &mill,
        &format!("{HEAD}RAPID\nGOTO/0,0,50,0,0,1\nGOTO/10,0,0,0,-.5,.8660254\nFINI\n"),
        &expect![[r#"
        N40 G0 A0.
        N50 G0 X0. Y0.
        N60 G43 H1 Z50.
        N70 G93 G1 X10. Y25. Z-6.6987 A30. F19.6116
        N80 M5
        N90 G53 G0 Z0.
        N100 G0 A0.
        N110 M2
        %
    "#]],
    );
    let kinds = found(&mill, &format!("{HEAD}RAPID\nGOTO/0,0,50,0,0,1\nGOTO/10,0,0,.5,0,.8660254\nFINI\n"));
    assert!(matches!(kinds[..], [PostFindingKind::AxisUnreachable { positions: 1, .. }]), "{kinds:?}");
}

/// What leads the machine over to other angles is turned between the way out of the part and the way in.
#[test]
fn the_machine_turns_over_off_the_part() {
    let limits = ("# Without limits_degrees it turns without end.", "limits_degrees = [-200.0, 200.0]");
    let mill = changed("linuxcnc-mill5", &[WIDE[0], WIDE[1], UNDIVIDED, limits]).unwrap();
    let on_cone = |degrees: i32, height: f64| {
        let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
        let (x, y) = (30.0 * cosine, 30.0 * sine);
        format!("GOTO/{x:.6},{y:.6},{height},{:.9},{:.9},.866025404\n", 0.5 * cosine, 0.5 * sine)
    };
    let cut = |from: i32, to: i32| (from..=to).step_by(30).map(|at| on_cone(at, 0.0)).collect::<String>();
    // The first cut ends near the end of the table, the second one would go beyond it.
    let (first, second) = (cut(0, 90), cut(90, 270));
    let out = format!("RAPID\n{}RAPID\n{}RAPID\n{}", on_cone(90, 50.0), on_cone(90, 60.0), on_cone(90, 10.0));
    let text = format!("{HEAD}RAPID\n{}{first}{out}{second}FINI\n", on_cone(0, 50.0));
    check(
        &mill,
        &text,
        &expect![[r#"
        N40 G0 A30. C90.
        N50 G0 X0. Y24.0192
        N60 G43 H1 Z51.6025
        N70 G1 Y-.9808 Z8.3013 F1000.
        N80 G93 C120. F64.395
        N90 C150. F64.395
        N100 C180. F64.395
        N110 G0 Y24.0192 Z51.6025
        N120 Y-29.0192 Z60.2628 A-30. C0.
        N130 Y-4.0192 Z16.9615
        N140 G94 G1 Y.9808 Z8.3013 F1000.
        N150 G93 C30. F64.395
        N160 C60. F64.395
        N170 C90. F64.395
        N180 C120. F64.395
        N190 C150. F64.395
        N200 C180. F64.395
        N210 M5
        N220 G53 G0 Z0.
        N230 G0 A0. C0.
        N240 M2
        %
    "#]],
    );
    // Where it need not turn it does not, whatever side it prefers.
    let back: String = [270, 240].map(|at| on_cone(at, 0.0)).concat();
    let up = format!("RAPID\n{}RAPID\n{}", on_cone(270, 50.0), on_cone(270, 10.0));
    let text = format!("{HEAD}RAPID\n{}{first}{out}{second}{up}{back}FINI\n", on_cone(0, 50.0));
    let tape = tape_for(&mill, &text).text();
    let tilted: Vec<&str> = tape.split_whitespace().filter(|word| word.starts_with('A')).collect();
    assert_eq!(tilted, ["A30.", "A-30.", "A0."], "{tape}");
}

/// A control that turns a table the shorter way is told its angle from 0 to 360, and no block turns it by nearly half a turn.
#[test]
fn an_axis_that_wraps_is_told_from_nought_to_a_turn() {
    let endless = "# Without limits_degrees it turns without end.";
    let mill = changed("linuxcnc-mill5", &[WIDE[0], WIDE[1], UNDIVIDED, (endless, "wraps = true")]).unwrap();
    let tape = tape_for(&mill, &round(2.0));
    assert!(tape.is_ok(), "{:?}", tape.findings);
    let angles: Vec<f64> =
        tape.text().split_whitespace().filter_map(|word| word.strip_prefix('C')?.parse().ok()).collect();
    assert!(angles.len() > 24 && angles.iter().all(|angle| (0.0..360.0).contains(angle)), "{angles:?}");
    let turned = |pair: &[f64]| (pair[1] - pair[0]).rem_euclid(360.0);
    assert!(angles[..25].windows(2).all(|pair| (turned(pair) - 30.0).abs() < 1e-9), "{angles:?}");
    // Along the table the tool turns in place: by nearly half a turn in two blocks.
    let text = format!(
        "{HEAD}RAPID\nGOTO/0,0,50,.5,0,.8660254\nGOTO/0,0,50,0,0,1\nGOTO/0,0,50,-.5,-.01,.8660254\nRAPID\nGOTO/0,0,60,0,0,1\nFINI\n"
    );
    let limited =
        [WIDE[0], WIDE[1], UNDIVIDED, (endless, "wraps = true"), ("[-120.0, 120.0]", "[0.0, 120.0]")];
    check(
        &changed("linuxcnc-mill5", &limited).unwrap(),
        &text,
        &expect![[r#"
        N40 G0 A30. C90.
        N50 G0 X0. Y50.
        N60 G43 H1 Z36.6025
        N70 G93 G1 Y0. Z50. A0. F120.
        N80 C.5729 F60.3844
        N90 C271.1458 F60.3844
        N100 Y50.0076 Z36.5982 A30.005 F119.98
        N110 G0 Y0. Z60. A0.
        N120 M5
        N130 G53 G0 Z0.
        N140 G0 C0.
        N150 M2
        %
    "#]],
    );
    let both = changed("linuxcnc-mill5", &[(endless, "wraps = true\nlimits_degrees = [-10.0, 10.0]")]);
    assert_eq!(both, Err(MachineError::WrapsWithinLimits { axis: "C".into() }));
}

/// On a rapid the tool end stays near its way, too, where the machine says so.
#[test]
fn rapids_are_divided_where_the_machine_wants_it() {
    let text =
        format!("{HEAD}RAPID\nGOTO/40,20,60,0,-.5,.8660254\nRAPID\nGOTO/60,20,60,.5,0,.8660254\nFINI\n");
    let blocks = |changes: &[(&str, &str)]| {
        let tape = tape_for(&changed("linuxcnc-mill5", changes).unwrap(), &text);
        assert!(tape.is_ok(), "{:?}", tape.findings);
        tape.blocks.len()
    };
    let undivided = blocks(&[UNDIVIDED]);
    let divided = blocks(&[]);
    let finely = blocks(&[("rapid_tolerance_mm = 1.0", "rapid_tolerance_mm = 0.1")]);
    assert!(undivided < divided && divided < finely, "{undivided} {divided} {finely}");
}
