//! Worked examples: CL text and the tape that comes of it, and what the post-processor finds.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use apt_cldata::text::read_text;
use apt_post::{MachineDefinition, PostFindingKind, PostOptions, Severity, Tape, machine, machines, post};
use expect_test::{Expect, expect};

fn tape_for(machine: &MachineDefinition, text: &str) -> Tape {
    let (records, errors) = read_text(text);
    assert_eq!(errors, vec![]);
    post(&records, machine, &PostOptions::default())
}

fn check(name: &str, text: &str, expected: &Expect) {
    let tape = tape_for(&machine(name).unwrap(), text);
    assert!(tape.is_ok(), "{:?}", tape.findings);
    expected.assert_eq(&tape.text());
}

const SLOT: &str = "PARTNO SLOT 1001\nUNITS/INCHES\nLOADTL/1\nSPINDL/1200,CLW\nCOOLNT/ON\nRAPID\nGOTO/-1,0,2\nRAPID\n\
                    GOTO/-1,0,.1\nFEDRAT/5,IPM\nGOTO/-1,0,-.25\nFEDRAT/20,IPM\nGOTO/3,0,-.25\nRAPID\nGOTO/3,0,2\n\
                    COOLNT/OFF\nSPINDL/OFF\nFINI\n";

#[test]
fn inch_slot() {
    check(
        "linuxcnc-mill3",
        SLOT,
        &expect![[r#"
        %
        (SLOT 1001)
        N10 G17 G20 G40 G49 G54 G80 G90 G94
        N20 T1 M6
        N30 S1200 M3
        N40 G0 X-1. Y0.
        N50 G43 H1 Z2. M8
        N60 Z.1
        N70 G1 Z-.25 F5.
        N80 X3. F20.
        N90 G0 Z2.
        N100 M9
        N110 M5
        N120 M2
        %
    "#]],
    );
    check(
        "fanuc-mill3",
        SLOT,
        &expect![[r#"
        %
        O1001
        (SLOT 1001)
        N10 G17 G20 G40 G49 G80 G90 G94
        N20 T1 M6
        N30 S1200 M3
        N40 G54 G0 X-1. Y0.
        N50 G43 H1 Z2. M8
        N60 Z.1
        N70 G1 Z-.25 F5.
        N80 X3. F20.
        N90 G0 Z2.
        N100 M9
        N110 M5
        N120 G91 G28 Z0.
        N130 M30
        %
    "#]],
    );
    check(
        "haas-mill3",
        SLOT,
        &expect![[r#"
        %
        O1001
        (SLOT 1001)
        N10 G17 G20 G40 G49 G80 G90 G94
        N20 T1 M6
        N30 S1200 M3
        N40 G54 G0 X-1. Y0.
        N50 G43 H1 Z2. M8
        N60 Z.1
        N70 G1 Z-.25 F5.
        N80 X3. F20.
        N90 G0 Z2.
        N100 M9
        N110 M5
        N120 G53 G0 Z0.
        N130 M30
        %
    "#]],
    );
}

#[test]
fn quarter_arc() {
    let text = "UNITS/MM\nFROM/0,0,50\nSPINDL/2400,CLW\nRAPID\nGOTO/-10,20,2\nFEDRAT/150\nGOTO/-10,20,-3\nFEDRAT/600.\n\
                GOTO/40,20,-3\nCIRCLE/40,45,-3,0,0,1,25\nGOTO/57.6777,27.3223,-3\n65,45,-3\nGOTO/65,90,-3\nFINI\n";
    check(
        "linuxcnc-mill3",
        text,
        &expect![[r#"
        %
        N10 G17 G21 G40 G49 G54 G80 G90 G94
        N20 S2400 M3
        N30 G0 X-10. Y20. Z2.
        N40 G1 Z-3. F150.
        N50 X40. F600.
        N60 G3 X65. Y45. I0. J25.
        N70 G1 Y90.
        N80 M5
        N90 M2
        %
    "#]],
    );
}

#[test]
fn three_holes() {
    let text = "UNITS/MM\nLOADTL/5\nSPINDL/1800,CLW\nRAPID\nGOTO/10,10,50\n\
                CYCLE/DRILL,RAPTO,3.,FEDTO,-18.8026,RTRCTO,AUTO,MMPM,180.\nGOTO/10,10,0\nGOTO/35,10,0\nGOTO/60,10,0\n\
                CYCLE/OFF\nFINI\n";
    check(
        "fanuc-mill3",
        text,
        &expect![[r#"
        %
        O1
        N10 G17 G21 G40 G49 G80 G90 G94
        N20 T5 M6
        N30 S1800 M3
        N40 G54 G0 X10. Y10.
        N50 G43 H5 Z50.
        N60 G98 G81 X10. Y10. Z-18.803 R3. F180.
        N70 X35.
        N80 X60.
        N90 G80
        N100 M5
        N110 G91 G28 Z0.
        N120 M30
        %
    "#]],
    );
}

#[test]
fn pecking_and_tapping() {
    let peck = "UNITS/INCHES\nLOADTL/4\nSPINDL/3000,CLW\nRAPID\nGOTO/3,3,2\n\
                CYCLE/DEEP,DEPTH,1.25,STEP,.25,IPM,5.,CLEAR,.1\nGOTO/3,3,0\nCYCLE/OFF\nFINI\n";
    check(
        "linuxcnc-mill3",
        peck,
        &expect![[r#"
        %
        N10 G17 G20 G40 G49 G54 G80 G90 G94
        N20 T4 M6
        N30 S3000 M3
        N40 G0 X3. Y3.
        N50 G43 H4 Z2.
        N60 G98 G83 X3. Y3. Z-1.25 R.1 Q.25 F5.
        N70 G80
        N80 M5
        N90 M2
        %
    "#]],
    );
    let tap = "UNITS/INCHES\nLOADTL/4\nSPINDL/600,CLW\nRAPID\nGOTO/1,3,2\nCYCLE/TAP,DEPTH,.4,TPI,20,CLEAR,.2\n\
               GOTO/1,3,0\nCYCLE/OFF\nFINI\n";
    check(
        "linuxcnc-mill3",
        tap,
        &expect![[r#"
        %
        N10 G17 G20 G40 G49 G54 G80 G90 G94
        N20 T4 M6
        N30 S600 M3
        N40 G0 X1. Y3.
        N50 G43 H4 Z2.
        N60 G0 Z.2
        N70 G33.1 Z-.4 K.05
        N80 G0 Z2.
        N90 M5
        N100 M2
        %
    "#]],
    );
    check(
        "fanuc-mill3",
        tap,
        &expect![[r#"
        %
        O1
        N10 G17 G20 G40 G49 G80 G90 G94
        N20 T4 M6
        N30 S600 M3
        N40 G54 G0 X1. Y3.
        N50 G43 H4 Z2.
        N60 M29 S600
        N70 G98 G84 X1. Y3. Z-.4 R.2 F30.
        N80 G80
        N90 M5
        N100 G91 G28 Z0.
        N110 M30
        %
    "#]],
    );
}

#[test]
fn helix_of_two_turns() {
    let text = "UNITS/MM\nFROM/5,0,2\nSPINDL/4000,CLW\nFEDRAT/200\nGOTO/5,0,-2\nFEDRAT/300\nCIRCLE/0,0,-2,0,0,1,5\n\
                GOTO/5,0,-.5\nCIRCLE/0,0,-.5,0,0,1,5\nGOTO/5,0,1\nFINI\n";
    check(
        "linuxcnc-mill3",
        text,
        &expect![[r#"
        %
        N10 G17 G21 G40 G49 G54 G80 G90 G94
        N20 S4000 M3
        N30 G1 X5. Y0. Z-2. F200.
        N40 G3 X5. Y0. Z-.5 I-5. J0. F300.
        N50 X5. Y0. Z1. I-5. J0.
        N60 M5
        N70 M2
        %
    "#]],
    );
}

#[test]
fn compensation() {
    let text = "UNITS/MM\nFROM/-20,-20,-5\nSPINDL/1000,CLW\nFEDRAT/600\nCUTCOM/LEFT,1\nGOTO/0,-10,-5\nGOTO/0,40,-5\n\
                GOTO/50,40,-5\nGOTO/50,0,-5\nGOTO/-10,0,-5\nCUTCOM/OFF\nGOTO/-20,-20,-5\nFINI\n";
    check(
        "linuxcnc-mill3",
        text,
        &expect![[r#"
        %
        N10 G17 G21 G40 G49 G54 G80 G90 G94
        N20 S1000 M3
        N30 G41 D1 G1 X0. Y-10. Z-5. F600.
        N40 Y40.
        N50 X50.
        N60 Y0.
        N70 X-10.
        N80 G40 X-20. Y-20.
        N90 M5
        N100 M2
        %
    "#]],
    );
}

#[test]
fn texts_numbers_and_optional_blocks() {
    let text = "PARTNO A (B)\nUNITS/MM\nFROM/0,0,0\nPPRINT CHECK CLAMP\nSPINDL/1000,CLW\nSEQNO/100,INCR,5\nFEDRAT/100\nGOTO/1,0,0\nOPSKIP/ON\n\
                GOTO/2,0,0\nOPSKIP/OFF\nSEQNO/OFF\nINSERT G4 P1\nGOTO/3,0,0\nAUXFUN/50\nPREFUN/61\nFINI\n";
    check(
        "linuxcnc-mill3",
        text,
        &expect![[r#"
        %
        (A [B])
        N10 G17 G21 G40 G49 G54 G80 G90 G94
        (MSG,CHECK CLAMP)
        N20 S1000 M3
        N100 G1 X1. Y0. Z0. F100.
        /N105 G94 G1 X2. Y0. Z0. F100.
        G4 P1
        G94 G1 X3. Y0. Z0. F100.
        M50
        G61
        M5
        M2
        %
    "#]],
    );
}

#[test]
fn old_control_without_points() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/machines/linuxcnc-mill3.toml"))
        .unwrap();
    let text = text
        .replace(
            "style = \"point\", left = 6, right = 4, right_inch = 5",
            "style = \"leading-zeros-suppressed\", left = 3, right = 4",
        )
        .replace(
            "style = \"point\", left = 6, right = 4, modal",
            "style = \"leading-zeros-suppressed\", left = 3, right = 1, modal",
        )
        .replace("spaces = true", "spaces = false")
        .replace("\"G17 {unit} G40 G49 G54 G80 G90 G94\"", "\"G90 {unit}\"");
    let machine = MachineDefinition::from_toml(&text).unwrap();
    let program = "FROM/0,0,3\nRAPID\nGOTO/1,.5,2\nFEDRAT/5\nGOTO/1,.5,-.25\nGOTO/3,.5,-.25\nRAPID\nGOTO/3,.5,2\nFINI\n";
    expect![[r#"
        %
        N10G90G20
        N20G0X10000Y5000Z20000
        N30G94G1Z-2500F50
        N40X30000
        N50G0Z20000
        N60M2
        %
    "#]]
    .assert_eq(&tape_for(&machine, program).text());
}

#[test]
fn every_block_knows_its_statement() {
    let tape = tape_for(&machine("linuxcnc-mill3").unwrap(), SLOT);
    let statement = |wanted: &str| tape.blocks.iter().find(|block| block.text.contains(wanted)).unwrap().isn;
    assert_eq!(statement("(SLOT 1001)"), 1);
    assert_eq!(statement("M6"), 3);
    assert_eq!(statement("Z-.25"), 11);
    assert_eq!(statement("M2"), 18);
}

#[test]
fn findings() {
    let cases: [(&str, PostFindingKind); 25] = [
        ("SPINDL/1000\nGOTO/1,0,0\n", PostFindingKind::NoFeed),
        ("FEDRAT/10\nGOTO/1,0,0\n", PostFindingKind::SpindleOff),
        ("FEDRAT/0\n", PostFindingKind::FeedNotPositive { value: 0.0 }),
        ("FEDRAT/10,MMPM\n", PostFindingKind::UnitMismatch { word: "MMPM".into() }),
        ("UNITS/MM\n", PostFindingKind::UnitsChanged),
        ("SPINDL/ON\n", PostFindingKind::NoSpindleSpeed),
        (
            "SPINDL/99999\n",
            PostFindingKind::SpindleOutOfRange { value: 99999.0, least: 1.0, greatest: 60000.0 },
        ),
        ("SPINDL/200,SFM\n", PostFindingKind::NoCutterDiameter),
        ("FOO/1\n", PostFindingKind::UnknownWord { word: "FOO".into() }),
        ("VACUUM/ON\n", PostFindingKind::NotSupported { word: "VACUUM".into() }),
        (
            "COOLNT/WATER\n",
            PostFindingKind::UnknownArgument { word: "COOLNT".into(), argument: "WATER".into() },
        ),
        (
            "LOADTL\n",
            PostFindingKind::MissingArgument { word: "LOADTL".into(), missing: "the tool number".into() },
        ),
        (
            "LOADTL/1.5\n",
            PostFindingKind::BadValue { word: "LOADTL".into(), argument: "tool".into(), value: 1.5 },
        ),
        ("RETRCT\n", PostFindingKind::NoClearance { word: "RETRCT".into() }),
        ("GOHOME\nGOCLER\n", PostFindingKind::NoClearance { word: "GOCLER".into() }),
        ("PLUNGE\n", PostFindingKind::NoRetract),
        ("RAPID\nRAPID\nGOTO/1,0,0\n", PostFindingKind::RapidUnused),
        ("CUTCOM/LEFT,1\n", PostFindingKind::CompensationUnused),
        ("FEDRAT/5\nCYCLE/DRILL,DEPTH,1,CLEAR,.1\nCYCLE/OFF\n", PostFindingKind::CycleWithoutPoints),
        (
            "CYCLE/CIRCUL,DEPTH,1,CLEAR,.1,IPM,5\nGOTO/1,0,0\nGOTO/2,0,0\nCYCLE/OFF\n",
            PostFindingKind::HolesLeftOut { holes: 2 },
        ),
        (
            "CYCLE/DEEP,DEPTH,1,STEP,2,CLEAR,.1,IPM,5\n",
            PostFindingKind::StepNotLessThanDepth { step: 2.0, depth: 1.0 },
        ),
        ("GOTO/1,0,0,0,.6,.8\n", PostFindingKind::ToolAxis { i: 0.0, j: 0.6, k: 0.8, motions: 1 }),
        (
            "CLRSRF/HOME\n",
            PostFindingKind::UnknownArgument { word: "CLRSRF".into(), argument: "HOME".into() },
        ),
        ("END\nRAPID\nGOTO/1,0,0\n", PostFindingKind::MotionAfterEnd),
        (
            "RAPID\nGOTO/100,0,0\n",
            PostFindingKind::AxisLimit {
                axis: "X".into(),
                value: 100.0,
                least: -1000.0 / 25.4,
                greatest: 1000.0 / 25.4,
            },
        ),
    ];
    let mill = machine("linuxcnc-mill3").unwrap();
    for (text, kind) in cases {
        let tape = tape_for(&mill, &format!("UNITS/INCHES\nFROM/0,0,0\n{text}FINI\n"));
        let kinds: Vec<&PostFindingKind> = tape.findings.iter().map(|finding| &finding.kind).collect();
        assert!(kinds.contains(&&kind), "{text}: {kinds:?}");
        assert!(tape.findings.iter().all(|finding| finding.isn > 0), "{text}");
    }
    let tape = tape_for(&mill, "FROM/0,0,0\n");
    assert_eq!(tape.findings[0].kind, PostFindingKind::NoFini);
    assert_eq!(tape.findings[0].kind.severity(), Severity::Warning);
}

#[test]
fn motions_in_a_row_with_another_axis_are_one_finding() {
    let mill = machine("linuxcnc-mill3").unwrap();
    let text = "UNITS/INCHES\nFROM/0,0,0\nRAPID\nGOTO/1,0,0,0,.6,.8\nGOTO/2,0,0,0,.8,.6\nGOTO/3,0,0,1,0,0\n\
                RAPID\nGOTO/4,0,0,0,0,1\nRAPID\nGOTO/5,0,0,0,1,0\nFINI\n";
    let tape = tape_for(&mill, text);
    let found: Vec<_> = tape
        .findings
        .iter()
        .filter_map(|finding| match finding.kind {
            PostFindingKind::ToolAxis { j, motions, .. } => Some((finding.isn, j, motions)),
            _ => None,
        })
        .collect();
    assert_eq!(found, [(4, 0.6, 3), (10, 1.0, 1)]);
}

#[test]
fn one_finding_is_enough_for_a_clearance_without_its_plane() {
    let mill = machine("linuxcnc-mill3").unwrap();
    let about = |statement: &str| -> Vec<PostFindingKind> {
        let tape = tape_for(&mill, &format!("UNITS/INCHES\nFROM/0,0,0\n{statement}\nFINI\n"));
        tape.findings.into_iter().map(|finding| finding.kind).collect()
    };
    for word in ["CLEARP", "CLRSRF"] {
        let unknown = PostFindingKind::UnknownArgument { word: word.into(), argument: "NOW".into() };
        assert_eq!(about(&format!("{word}/NOW")), [unknown]);
        let not_used = PostFindingKind::ArgumentNotUsed { word: word.into(), argument: "0.5".into() };
        assert_eq!(about(&format!("{word}/0,0,1,.1,.5")), [not_used], "the plane is level");
    }
}

#[test]
fn good_programs_are_silent() {
    for info in machines() {
        let tape = tape_for(&machine(&info.name).unwrap(), SLOT);
        assert_eq!(tape.findings, vec![], "{}", info.name);
    }
}

/// Statements with arguments of every kind, most of them wrong in some way.
fn any_statement() -> impl proptest::strategy::Strategy<Value = String> {
    use proptest::prelude::*;
    let word = prop::sample::select(vec![
        "GOTO", "FROM", "GODLTA", "RAPID", "FEDRAT", "SPINDL", "COOLNT", "LOADTL", "SELCTL", "UNLOAD",
        "CUTCOM", "CYCLE", "DELAY", "STOP", "END", "REWIND", "GOHOME", "CLEARP", "RETRCT", "PLUNGE",
        "ORIGIN", "TRANS", "SEQNO", "OPSKIP", "AUXFUN", "PREFUN", "MCHTOL", "ARCSLP", "UNITS", "CIRCLE",
        "MOVARC", "INTOL", "CUTTER", "MULTAX", "FINI", "TOOLNO", "OFSTNO", "FOO", "ROTABL", "ROTHED",
        "ROTATE", "LINTOL", "MAXDPM", "PIVOTZ",
    ]);
    let argument = prop::sample::select(vec![
        "0", "1", "-1", "2.5", "10", "0.25", "1.0E9", "-1.0E300", "1.0E-300", "ON", "OFF", "DRILL", "DEEP",
        "TAP", "BRKCHP", "BORE", "DEPTH", "STEP", "CLEAR", "TPI", "IPM", "MMPR", "INVERS", "AUTO", "CLW",
        "SFM", "REV", "LEFT", "LINCIR", "INCR", "MM", "INCHES", "XYPLAN", "ANGLE", "RTRCTO", "ATANGL",
        "AAXIS", "BAXIS", "CAXIS", "ROTREF", "LENGTH", "90",
    ]);
    let statement = (word, prop::collection::vec(argument, 0..8))
        .prop_map(|(word, arguments)| format!("{word}/{}\n", arguments.join(",")));
    let number = prop::sample::select(vec!["0", "1", "-1", "5", "-20", "1.0E-300", "0.3"]);
    // A tool that leans, or whose direction has no length.
    let leaning = prop::collection::vec(number, 6..7)
        .prop_map(|numbers| format!("MULTAX/ON\nGOTO/{}\n", numbers.join(",")));
    prop_oneof![4 => statement, 1 => leaning]
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig { cases: 256, failure_persistence: None, ..Default::default() })]

    #[test]
    fn any_statements_end_in_a_tape(statements in proptest::collection::vec(any_statement(), 0..40)) {
        let (records, _) = read_text(&statements.concat());
        for info in machines() {
            let tape = post(&records, &machine(&info.name).unwrap(), &PostOptions::default());
            let text = tape.text();
            proptest::prop_assert!(text.is_ascii() && !text.contains("NaN") && !text.contains("inf"), "{}", text);
            proptest::prop_assert!(!text.contains("-0.\n") && !text.contains("-0. "), "{}", text);
            proptest::prop_assert_eq!(text, post(&records, &machine(&info.name).unwrap(), &PostOptions::default()).text());
        }
    }
}

#[test]
fn a_long_straight_run_costs_what_its_points_cost() {
    let mut text = "UNITS/MM\nFROM/0,0,0\nSPINDL/1000\nFEDRAT/100\n".to_owned();
    for step in 1..=40_000_u32 {
        // A zigzag in which no arc fits.
        text += &format!("GOTO/{},{},0\n", f64::from(step) * 0.001, f64::from(step % 2));
    }
    text += "FINI\n";
    let tape = tape_for(&machine("linuxcnc-mill3").unwrap(), &text);
    assert_eq!(tape.blocks.iter().filter(|block| block.text.contains('X')).count(), 40_000);
}
