//! Tapes in the dialogue language of Heidenhain controls: worked examples, and random programs that a small reader of such tapes follows.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

#[path = "heidenhain/cycles.rs"]
mod cycles;
#[path = "heidenhain/random.rs"]
mod random;
#[path = "heidenhain/reader.rs"]
mod reader;

use apt_cldata::text::read_text;
use apt_post::{
    MachineDefinition, MachineError, PostFindingKind, PostOptions, Tape, definition_file, machine, post,
};
use expect_test::{Expect, expect};

const MILL: &str = "heidenhain-mill3";

fn tape_for(name: &str, text: &str) -> Tape {
    let (records, errors) = read_text(text);
    assert_eq!(errors, vec![]);
    post(&records, &machine(name).unwrap(), &PostOptions::default())
}

/// The tape of a program about which nothing is found but the kinds that are named.
fn check_with(name: &str, text: &str, kinds: &[PostFindingKind], expected: &Expect) {
    let tape = tape_for(name, text);
    let found: Vec<&PostFindingKind> = tape.findings.iter().map(|finding| &finding.kind).collect();
    assert_eq!(found, kinds.iter().collect::<Vec<_>>(), "{}", tape.text());
    expected.assert_eq(&tape.text());
}

fn check(text: &str, expected: &Expect) {
    check_with(MILL, text, &[], expected);
}

const HEAD: &str = "UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\n";

#[test]
fn a_contour_with_an_arc() {
    let text = "UNITS/MM\nSPINDL/1000,CLW\nFROM/0,0,50\nRAPID\nGOTO/0,0,-2\nFEDRAT/1000\nGOTO/45,5,-2\nMOVARC/45,10,-2,0,0,1,5,ANGLE,90\nGOTO/50,10,-2\n\
                GOTO/50,40,-2\nFINI\n";
    check(
        text,
        &expect![[r#"
            0 BEGIN PGM 1 MM
            1 TOOL CALL S1000
            2 L M3
            3 L X+0 Y+0 Z-2 R0 FMAX
            4 L X+45 Y+5 R0 F1000
            5 CC X+45 Y+10
            6 C X+50 Y+10 DR+
            7 L Y+40 R0
            8 L M5
            9 L Z-5 R0 FMAX M91
            10 L M30
            11 END PGM 1 MM
        "#]],
    );
}

#[test]
fn an_inch_slot() {
    let text = "PARTNO SLOT 1001\nUNITS/INCHES\nLOADTL/1\nSPINDL/1200,CLW\nCOOLNT/ON\nRAPID\nGOTO/-1,0,2\nRAPID\nGOTO/-1,0,.1\n\
                FEDRAT/5,IPM\nGOTO/-1,0,-.25\nFEDRAT/20,IPM\nGOTO/3,0,-.25\nRAPID\nGOTO/3,0,2\nCOOLNT/OFF\nSPINDL/OFF\nFINI\n";
    check(
        text,
        &expect![[r#"
        0 BEGIN PGM 1001 INCH
        1 ; SLOT 1001
        2 TOOL CALL 1 Z S1200
        3 L M3
        4 L X-1 Y+0 R0 FMAX
        5 L Z+2 R0 FMAX M8
        6 L Z+0.1 R0 FMAX
        7 L Z-0.25 R0 F50
        8 L X+3 R0 F200
        9 L Z+2 R0 FMAX
        10 L M9
        11 L M5
        12 L Z-5 R0 FMAX M91
        13 L M30
        14 END PGM 1001 INCH
    "#]],
    );
}

#[test]
fn arcs_of_both_senses_and_a_full_circle() {
    let text = format!(
        "{HEAD}RAPID\nGOTO/0,0,5\nFEDRAT/200\nGOTO/0,0,-2\nFEDRAT/300\nMOVARC/10,0,-2,0,0,-1,10,ANGLE,180\nGOTO/20,0,-2\n\
         MOVARC/10,0,-2,0,0,1,10,ANGLE,90\nGOTO/10,10,-2\nMOVARC/10,0,-2,0,0,1,10,ANGLE,360\nGOTO/10,10,-2\nRAPID\nGOTO/10,10,5\n\
         GOTO/0,10,5\nFINI\n"
    );
    check(
        &text,
        &expect![[r#"
        0 BEGIN PGM 1 MM
        1 TOOL CALL 1 Z S1000
        2 L M3
        3 L X+0 Y+0 R0 FMAX
        4 L Z+5 R0 FMAX
        5 L Z-2 R0 F200
        6 CC X+10 Y+0
        7 C X+20 Y+0 DR- F300
        8 C X+10 Y+10 DR+
        9 C X+10 Y+10 DR+
        10 L Z+5 R0 FMAX
        11 L X+0 R0
        12 L M5
        13 L Z-5 R0 FMAX M91
        14 L M30
        15 END PGM 1 MM
    "#]],
    );
}

#[test]
fn turns_of_a_helix_are_one_block() {
    let text = format!(
        "{HEAD}RAPID\nGOTO/5,0,5\nFEDRAT/200\nGOTO/5,0,-2\nFEDRAT/300\nCIRCLE/0,0,-2,0,0,1,5\nGOTO/5,0,-.5\nCIRCLE/0,0,-.5,0,0,1,5\n\
         GOTO/5,0,1\nFEDRAT/400\nCIRCLE/0,0,1,0,0,1,5\nGOTO/5,0,3\nGOTO/10,0,3\nFINI\n"
    );
    check(
        &text,
        &expect![[r#"
        0 BEGIN PGM 1 MM
        1 TOOL CALL 1 Z S1000
        2 L M3
        3 L X+5 Y+0 R0 FMAX
        4 L Z+5 R0 FMAX
        5 L Z-2 R0 F200
        6 CC X+0 Y+0
        7 CP IPA+720 IZ+3 DR+ F300
        8 CP IPA+360 IZ+2 DR+ F400
        9 L X+10 R0
        10 L M5
        11 L Z-5 R0 FMAX M91
        12 L M30
        13 END PGM 1 MM
    "#]],
    );
}

/// Turns that rise otherwise are another helix, and so are more of them than the control takes in one.
#[test]
fn turns_that_do_not_go_on_are_blocks_of_their_own() {
    let turn = |from: f64, to: f64| format!("CIRCLE/0,0,{from},0,0,1,5\nGOTO/5,0,{to}\n");
    let helices = |turns: &str| -> Vec<String> {
        let text = format!("{HEAD}RAPID\nGOTO/5,0,5\nFEDRAT/300\nGOTO/5,0,0\n{turns}FINI\n");
        let tape = tape_for(MILL, &text).text();
        let blocks = tape.lines().filter(|line| line.contains(" CP "));
        blocks.map(|line| line.split_once(' ').unwrap().1.to_owned()).collect()
    };
    let uneven = turn(0.0, 1.0) + &turn(1.0, 2.0) + &turn(2.0, 4.0);
    assert_eq!(helices(&uneven), ["CP IPA+720 IZ+2 DR+", "CP IPA+360 IZ+2 DR+"]);
    let many: String = (0..20).map(|at| turn(f64::from(at), f64::from(at) + 1.0)).collect();
    assert_eq!(helices(&many), ["CP IPA+5400 IZ+15 DR+", "CP IPA+1800 IZ+5 DR+"]);
}

/// An inverse time is that of one arc.
#[test]
fn turns_with_a_time_of_their_own_are_not_one_block() {
    let text = definition_file(MILL).unwrap();
    let inverse = "FI = { address = \"FI\", style = \"plain\", left = 5, right = 3, modal = true }\nS = {";
    let text = text.replacen("S = {", inverse, 1).replace("{F} {FR}", "{F} {FR} {FI}");
    let text = text.replace("feed_per_revolution = \"\"", "feed_per_revolution = \"\"\nfeed_inverse = \"\"");
    let mill = MachineDefinition::from_toml(&text).unwrap();
    let program = format!(
        "{HEAD}RAPID\nGOTO/5,0,5\nFEDRAT/4,INVERS\nGOTO/5,0,0\nCIRCLE/0,0,0,0,0,1,5\nGOTO/5,0,1\nCIRCLE/0,0,1,0,0,1,5\nGOTO/5,0,2\nFINI\n"
    );
    let (records, _) = read_text(&program);
    let tape = post(&records, &mill, &PostOptions::default()).text();
    assert_eq!(tape.matches("CP IPA+360 IZ+1 DR+ FI4").count(), 2, "{tape}");
}

#[test]
fn a_part_of_a_turn_is_followed_by_whole_places() {
    let text = format!(
        "{HEAD}RAPID\nGOTO/5,0,5\nFEDRAT/300\nGOTO/5,0,-2\nMOVARC/5,-5,-2,0,0,-1,5,ANGLE,180\nGOTO/5,-10,-3\nGOTO/5,-20,-3\nFINI\n"
    );
    check(
        &text,
        &expect![[r#"
            0 BEGIN PGM 1 MM
            1 TOOL CALL 1 Z S1000
            2 L M3
            3 L X+5 Y+0 R0 FMAX
            4 L Z+5 R0 FMAX
            5 L Z-2 R0 F300
            6 CC X+5 Y-5
            7 CP IPA-180 IZ-1 DR-
            8 L X+5 Y-20 R0
            9 L M5
            10 L Z-5 R0 FMAX M91
            11 L M30
            12 END PGM 1 MM
        "#]],
    );
}

#[test]
fn arcs_in_other_planes_are_chords() {
    let text = format!(
        "{HEAD}RAPID\nGOTO/0,0,5\nFEDRAT/300\nINTOL/.5\nMOVARC/5,0,5,0,1,0,5,ANGLE,90\nGOTO/5,0,10\nFINI\n"
    );
    let tape = tape_for(MILL, &text);
    assert!(!tape.text().contains("CC"), "{}", tape.text());
}

/// The speed goes with the tool, whichever comes first; one that changes is told alone.
#[test]
fn tools_and_speeds_in_both_orders() {
    let after = "UNITS/MM\nSELCTL/2\nLOADTL/1\nCUTTER/10\nSPINDL/1000,CLW\nRAPID\nGOTO/0,0,50\nSPINDL/1200,CLW\nSPINDL/1200,CCLW\nSPINDL/OFF\n\
                 LOADTL/2\nSPINDL/100,SMM,CLW\nRAPID\nGOTO/0,0,50\nSPINDL/OFF\nUNLOAD\nFINI\n";
    check(
        after,
        &expect![[r#"
        0 BEGIN PGM 1 MM
        1 TOOL DEF 2
        2 TOOL CALL 1 Z S1000
        3 L M3
        4 L X+0 Y+0 R0 FMAX
        5 L Z+50 R0 FMAX
        6 TOOL CALL S1200
        7 L M3
        8 L M4
        9 L M5
        10 TOOL CALL 2 Z S3183
        11 L M3
        12 L X+0 Y+0 R0 FMAX
        13 L Z+50 R0 FMAX
        14 L M5
        15 TOOL CALL 0 Z
        16 L Z-5 R0 FMAX M91
        17 L M30
        18 END PGM 1 MM
    "#]],
    );
    let before = "UNITS/MM\nSPINDL/1000,CLW\nSPINDL/OFF\nLOADTL/1\nSPINDL/ON\nRAPID\nGOTO/0,0,50\nSPINDL/OFF\nLOADTL/2\nRAPID\nGOTO/1,0,50\nFINI\n";
    check(
        before,
        &expect![[r#"
        0 BEGIN PGM 1 MM
        1 TOOL CALL S1000
        2 L M3
        3 L M5
        4 TOOL CALL 1 Z S1000
        5 L M3
        6 L X+0 Y+0 R0 FMAX
        7 L Z+50 R0 FMAX
        8 L M5
        9 TOOL CALL 2 Z S1000
        10 L X+1 Y+0 R0 FMAX
        11 L Z+50 R0 FMAX
        12 L Z-5 R0 FMAX M91
        13 L M30
        14 END PGM 1 MM
    "#]],
    );
}

/// A tool that is loaded while the spindle turns stops it, as on every machine, and is told its speed all the same.
#[test]
fn a_spindle_that_turns_before_its_tool() {
    let text = "UNITS/MM\nSPINDL/1000,CLW\nLOADTL/1\nRAPID\nGOTO/0,0,50\nFINI\n";
    let told = PostFindingKind::ToolChangeWhile { what: "SPINDL".into() };
    check_with(
        MILL,
        text,
        &[told],
        &expect![[r#"
        0 BEGIN PGM 1 MM
        1 TOOL CALL S1000
        2 L M3
        3 L M5
        4 TOOL CALL 1 Z S1000
        5 L X+0 Y+0 R0 FMAX
        6 L Z+50 R0 FMAX
        7 L Z-5 R0 FMAX M91
        8 L M30
        9 END PGM 1 MM
    "#]],
    );
}

#[test]
fn compensation_is_told_in_every_straight_block() {
    let text = "UNITS/MM\nFROM/-20,-20,-5\nSPINDL/1000,CLW\nFEDRAT/600\nCUTCOM/LEFT,1\nGOTO/-20,-20,-6\nGOTO/0,-10,-6\nGOTO/0,40,-6\n\
                GOTO/50,40,-6\nMOVARC/50,20,-6,0,0,-1,20,ANGLE,180\nGOTO/50,0,-6\nGOTO/-10,0,-6\nCUTCOM/OFF\nGOTO/-20,-20,-6\nCUTCOM/RIGHT,1\nGOTO/0,0,-6\n\
                CUTCOM/OFF\nRAPID\nGOTO/9,9,5\nFINI\n";
    check(
        text,
        &expect![[r#"
        0 BEGIN PGM 1 MM
        1 TOOL CALL S1000
        2 L M3
        3 L X-20 Y-20 Z-6 RL F600
        4 L X+0 Y-10 RL
        5 L Y+40 RL
        6 L X+50 RL
        7 CC X+50 Y+20
        8 C X+50 Y+0 DR-
        9 L X-10 RL
        10 L X-20 Y-20 R0
        11 L X+0 Y+0 RR
        12 L X+9 Y+9 Z+5 R0 FMAX
        13 L M5
        14 L Z-5 R0 FMAX M91
        15 L M30
        16 END PGM 1 MM
    "#]],
    );
}

#[test]
fn words_of_the_control() {
    let text = "PARTNO A (B)\nUNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nCOOLNT/MIST\nCLEARP/XYPLAN,30\nPPRINT CHECK CLAMP\nRAPID\nGOTO/0,0,50\nFEDRAT/100\n\
                GOTO/1,0,50\nDELAY/1.5\nSTOP\nOPSTOP\nOPSKIP/ON\nGOTO/2,0,50\nOPSKIP/OFF\nGOTO/3,0,50\nINSERT L Z+70 R0 FMAX\nGOTO/3,0,50\n\
                AUXFUN/50\nRETRCT\nFEDRAT/.1,MMPR\nGOTO/4,0,30\nFEDRAT/100,MMPM\nGOTO/5,0,30\nGOHOME\nSPINDL/ORIENT\nCOOLNT/OFF\nEND\nFINI\n";
    check(
        text,
        &expect![[r#"
            0 BEGIN PGM 1 MM
            1 ; A [B]
            2 TOOL CALL 1 Z S1000
            3 L M3
            4 ; CHECK CLAMP
            5 L X+0 Y+0 R0 FMAX
            6 L Z+50 R0 FMAX M7
            7 L X+1 R0 F100
            8 CYCL DEF 9.0 DWELL TIME
            9 CYCL DEF 9.1 DWELL 1.5
            10 STOP M0
            11 L M1
            12 /L X+2 Y+0 Z+50 R0 F100
            13 L X+3 Y+0 Z+50 R0 F100
            14 L Z+70 R0 FMAX
            15 L X+3 Y+0 Z+50 R0 F100
            16 L M50
            17 L Z+30 R0 FMAX
            18 L X+4 R0 FU0.1
            19 L X+5 R0 F100
            20 L Z-5 R0 FMAX M91
            21 L X-5 Y-5 R0 FMAX M91
            22 L M19
            23 L M9
            24 L Z-5 R0 FMAX M91
            25 L M30
            26 END PGM 1 MM
        "#]],
    );
}

#[test]
fn what_the_control_does_not_take_is_told() {
    let unsupported = |word: &str| PostFindingKind::NotSupported { word: word.into() };
    let cases = [
        ("SEQNO/10", unsupported("SEQNO")),
        ("PREFUN/61", unsupported("PREFUN")),
        ("PPRINT A ~", PostFindingKind::Character { character: '~' }),
        ("FEDRAT/2,INVERS", PostFindingKind::NoCode { word: "FEDRAT".into(), name: "feed_inverse".into() }),
    ];
    for (statement, kind) in cases {
        let tape = tape_for(MILL, &format!("{HEAD}{statement}\nFINI\n"));
        let kinds: Vec<PostFindingKind> = tape.findings.into_iter().map(|finding| finding.kind).collect();
        assert_eq!(kinds, [kind], "{statement}");
    }
}

/// A line that goes on has the number of the first, and may be skipped with it.
#[test]
fn lines_of_one_block_have_one_number() {
    let text = format!(
        "{HEAD}OPSKIP/ON\nINSERT CYCL DEF 240 CENTERING ~\nINSERT Q200=2 ~\nINSERT Q343=0\nPPRINT A ~\nOPSKIP/OFF\nINSERT L M7\nFINI\n"
    );
    let tape = tape_for(MILL, &text).text();
    let lines = "3 /CYCL DEF 240 CENTERING ~\n    Q200=2 ~\n    Q343=0\n4 ; A ?\n5 L M7\n";
    assert!(tape.contains(lines), "{tape}");
}

#[test]
fn a_motion_behind_the_end_is_in_the_same_program() {
    let text = format!("{HEAD}RAPID\nGOTO/0,0,50\nEND\nRAPID\nGOTO/1,0,50\nFINI\n");
    let tape = tape_for(MILL, &text).text();
    assert_eq!((tape.matches("BEGIN PGM").count(), tape.matches("M30").count()), (1, 2), "{tape}");
}

const MILL5: &str = "heidenhain-mill5";
const LEANING: &str = "UNITS/MM\nMULTAX\nLOADTL/1\nSPINDL/1000,CLW\nCOOLNT/ON\nFEDRAT/1000\nRAPID\nGOTO/40,20,60,0,0,1\n\
                       GOTO/40,20,10,0,-.5,.8660254\nGOTO/60,20,10,.5,0,.8660254\nGOTO/60,40,10,.353553,.353553,.866025\nRAPID\n\
                       GOTO/60,40,90,.353553,.353553,.866025\nFINI\n";

#[test]
fn a_tool_that_leans() {
    check_with(
        MILL5,
        LEANING,
        &[],
        &expect![[r#"
        0 BEGIN PGM 1 MM
        1 TOOL CALL 1 Z S1000
        2 L M3
        3 L B+0 C-90 R0 FMAX
        4 L M128
        5 L M8
        6 L X+40 Y+20 Z+60 R0 FMAX
        7 L Z+10 B+30 R0 F1000
        8 L X+42.234 B+27.177 C-82.33 R0
        9 L X+44.354 B+24.958 C-73.695 R0
        10 L X+46.424 B+23.35 C-63.973 R0
        11 L X+48.494 B+22.415 C-53.202 R0
        12 L X+50.574 B+22.238 C-41.857 R0
        13 L X+52.655 B+22.844 C-30.717 R0
        14 L X+54.718 B+24.162 C-20.509 R0
        15 L X+56.81 B+26.113 C-11.394 R0
        16 L X+58.405 B+27.939 C-5.333 R0
        17 L X+60 B+30 C+0 R0
        18 L Y+24.438 B+28.685 C+9.633 R0
        19 L Y+28.875 B+28.101 C+19.865 R0
        20 L Y+33.338 B+28.296 C+30.286 R0
        21 L Y+36.669 B+28.947 C+37.84 R0
        22 L Y+40 B+30 C+45 R0
        23 L Z+90 R0 FMAX
        24 L M129
        25 L M9
        26 L M5
        27 L Z-5 R0 FMAX M91
        28 L B+0 C+0 R0 FMAX
        29 L M30
        30 END PGM 1 MM
    "#]],
    );
}

/// An upright tool is posted as on the machine with three axes, once the others stand at 0.
#[test]
fn an_upright_tool_is_nothing_new() {
    let text = format!(
        "{HEAD}RAPID\nGOTO/0,0,10\nFEDRAT/100\nGOTO/0,0,0\nMOVARC/5,0,0,0,0,1,5,ANGLE,180\nGOTO/10,0,0\nRAPID\nGOTO/10,0,10\n\
         CYCLE/DRILL,5,MMPM,100,2\nGOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\nGOHOME\nFINI\n"
    );
    let bare = |name: &str| -> Vec<String> {
        let tape = tape_for(name, &text);
        assert_eq!(tape.findings, vec![]);
        let text = tape.text();
        let blocks = text.lines().map(|line| line.split_once(' ').unwrap().1.to_owned());
        blocks.filter(|block| !block.contains('B') || block.contains("PGM")).collect()
    };
    assert_eq!(bare(MILL), bare(MILL5));
}

#[test]
fn templates_that_tell_no_motion_are_refused() {
    let text = definition_file(MILL).unwrap();
    for (from, to, place, register) in [
        ("linear = \"L {X} {Y} {Z}", "linear = \"L {X} {Y}", "templates.linear", "Z"),
        ("rapid = \"L {X} {Y} {Z}", "rapid = \"L {X} {Z}", "templates.rapid", "Y"),
        ("arc_center = \"CC {!I} {!J}\"", "arc_center = \"CC {!I}\"", "templates.arc", "J"),
        ("helix = \"CP {!PA} {!IZ}", "helix = \"CP {!PA}", "templates.helix", "IZ"),
        ("helix = \"CP {!PA} {!IZ} {turn} {F} {FR}\"", "", "templates.arc", "Z"),
        ("planes = [\"xy\"]", "planes = [\"xy\", \"yz\"]", "templates.arc", "Z"),
    ] {
        assert!(text.contains(from), "{from}");
        let lacks = MachineError::TemplateLacks { place: place.to_owned(), register: register.to_owned() };
        assert_eq!(MachineDefinition::from_toml(&text.replace(from, to)), Err(lacks), "{from}");
    }
    let text = text.replace("helix_degrees = 5400.0", "helix_degrees = 0.0");
    assert!(matches!(MachineDefinition::from_toml(&text), Err(MachineError::NotPositive { .. })));
}
