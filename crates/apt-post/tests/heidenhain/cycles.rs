//! Cycles: defined before the first hole and where a parameter changes, and made at each place.

use apt_post::PostFindingKind;
use expect_test::expect;

use super::{HEAD, MILL, check, check_with, tape_for};

/// Every cycle at three holes, of which the last is higher.
#[test]
fn three_holes_of_each_cycle() {
    let cycles = [
        "DRILL,DEPTH,18.8026,MMPM,180,CLEAR,3",
        "FACE,DEPTH,5,MMPM,180,CLEAR,3,DWELL,.5",
        "DEEP,DEPTH,20,STEP,6,MMPM,180,CLEAR,3,RTRCTO,3",
        "BRKCHP,DEPTH,20,STEP,6,MMPM,180,CLEAR,3",
        "REAM,DEPTH,10,MMPM,180,CLEAR,3",
        "BORE,DEPTH,10,MMPM,180,CLEAR,3,DWELL,1",
        "BORE9,DEPTH,10,MMPM,180,CLEAR,3,DWELL,1",
        "TAP,DEPTH,10,MMPR,1.25,CLEAR,3,TIMES,2",
    ];
    let holes = "GOTO/10,10,0\nGOTO/35,10,0\nGOTO/35,20,2.5\nCYCLE/OFF\n";
    let mut text = format!("{HEAD}RAPID\nGOTO/10,10,50\n");
    for cycle in cycles {
        text += &format!("CYCLE/{cycle}\n{holes}RAPID\nGOTO/10,10,50\n");
    }
    text += &format!("SPINDL/OFF\nSPINDL/300,CCLW\nCYCLE/REVERS,DEPTH,10,MMPR,1.25,CLEAR,3\n{holes}FINI\n");
    check(
        &text,
        &expect![[r#"
            0 BEGIN PGM 1 MM
            1 TOOL CALL 1 Z S1000
            2 L M3
            3 L X+10 Y+10 R0 FMAX
            4 L Z+50 R0 FMAX
            5 CYCL DEF 200 DRILLING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-18.803 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q202=18.803 ;PLUNGING DEPTH ~
                Q210=0 ;DWELL TIME AT TOP ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=50 ;2ND SET-UP CLEARANCE ~
                Q211=0 ;DWELL TIME AT DEPTH
            6 L X+10 Y+10 R0 FMAX M99
            7 L X+35 R0 FMAX M99
            8 CYCL DEF 200 DRILLING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-18.803 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q202=18.803 ;PLUNGING DEPTH ~
                Q210=0 ;DWELL TIME AT TOP ~
                Q203=+2.5 ;SURFACE COORDINATE ~
                Q204=47.5 ;2ND SET-UP CLEARANCE ~
                Q211=0 ;DWELL TIME AT DEPTH
            9 L X+35 Y+20 R0 FMAX M99
            10 L X+10 Y+10 Z+50 R0 FMAX
            11 CYCL DEF 200 DRILLING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-5 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q202=5 ;PLUNGING DEPTH ~
                Q210=0 ;DWELL TIME AT TOP ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=50 ;2ND SET-UP CLEARANCE ~
                Q211=0.5 ;DWELL TIME AT DEPTH
            12 L X+10 Y+10 R0 FMAX M99
            13 L X+35 R0 FMAX M99
            14 CYCL DEF 200 DRILLING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-5 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q202=5 ;PLUNGING DEPTH ~
                Q210=0 ;DWELL TIME AT TOP ~
                Q203=+2.5 ;SURFACE COORDINATE ~
                Q204=47.5 ;2ND SET-UP CLEARANCE ~
                Q211=0.5 ;DWELL TIME AT DEPTH
            15 L X+35 Y+20 R0 FMAX M99
            16 L X+10 Y+10 Z+50 R0 FMAX
            17 CYCL DEF 200 DRILLING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-20 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q202=6 ;PLUNGING DEPTH ~
                Q210=0 ;DWELL TIME AT TOP ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=3 ;2ND SET-UP CLEARANCE ~
                Q211=0 ;DWELL TIME AT DEPTH
            18 L X+10 Y+10 R0 FMAX M99
            19 L X+35 R0 FMAX M99
            20 L Z+5.5 R0 FMAX
            21 CYCL DEF 200 DRILLING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-20 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q202=6 ;PLUNGING DEPTH ~
                Q210=0 ;DWELL TIME AT TOP ~
                Q203=+2.5 ;SURFACE COORDINATE ~
                Q204=3 ;2ND SET-UP CLEARANCE ~
                Q211=0 ;DWELL TIME AT DEPTH
            22 L X+35 Y+20 R0 FMAX M99
            23 L X+10 Y+10 Z+50 R0 FMAX
            24 CYCL DEF 203 UNIVERSAL DRILLING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-20 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q202=6 ;PLUNGING DEPTH ~
                Q210=0 ;DWELL TIME AT TOP ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=50 ;2ND SET-UP CLEARANCE ~
                Q212=0 ;DECREMENT ~
                Q213=99999 ;NR OF BREAKS ~
                Q205=6 ;MIN. PLUNGING DEPTH ~
                Q211=0 ;DWELL TIME AT DEPTH ~
                Q208=99999 ;RETRACTION FEED RATE ~
                Q256=0.25 ;DIST FOR CHIP BRKNG
            25 L X+10 Y+10 R0 FMAX M99
            26 L X+35 R0 FMAX M99
            27 CYCL DEF 203 UNIVERSAL DRILLING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-20 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q202=6 ;PLUNGING DEPTH ~
                Q210=0 ;DWELL TIME AT TOP ~
                Q203=+2.5 ;SURFACE COORDINATE ~
                Q204=47.5 ;2ND SET-UP CLEARANCE ~
                Q212=0 ;DECREMENT ~
                Q213=99999 ;NR OF BREAKS ~
                Q205=6 ;MIN. PLUNGING DEPTH ~
                Q211=0 ;DWELL TIME AT DEPTH ~
                Q208=99999 ;RETRACTION FEED RATE ~
                Q256=0.25 ;DIST FOR CHIP BRKNG
            28 L X+35 Y+20 R0 FMAX M99
            29 L X+10 Y+10 Z+50 R0 FMAX
            30 CYCL DEF 201 REAMING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-10 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q211=0 ;DWELL TIME AT DEPTH ~
                Q208=0 ;RETRACTION FEED RATE ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=50 ;2ND SET-UP CLEARANCE
            31 L X+10 Y+10 R0 FMAX M99
            32 L X+35 R0 FMAX M99
            33 CYCL DEF 201 REAMING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-10 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q211=0 ;DWELL TIME AT DEPTH ~
                Q208=0 ;RETRACTION FEED RATE ~
                Q203=+2.5 ;SURFACE COORDINATE ~
                Q204=47.5 ;2ND SET-UP CLEARANCE
            34 L X+35 Y+20 R0 FMAX M99
            35 L X+10 Y+10 Z+50 R0 FMAX
            36 CYCL DEF 202 BORING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-10 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q211=1 ;DWELL TIME AT DEPTH ~
                Q208=99999 ;RETRACTION FEED RATE ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=50 ;2ND SET-UP CLEARANCE ~
                Q214=0 ;DISENGAGING DIRECTN ~
                Q336=0 ;ANGLE OF SPINDLE
            37 L X+10 Y+10 R0 FMAX M99
            38 L X+35 R0 FMAX M99
            39 CYCL DEF 202 BORING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-10 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q211=1 ;DWELL TIME AT DEPTH ~
                Q208=99999 ;RETRACTION FEED RATE ~
                Q203=+2.5 ;SURFACE COORDINATE ~
                Q204=47.5 ;2ND SET-UP CLEARANCE ~
                Q214=0 ;DISENGAGING DIRECTN ~
                Q336=0 ;ANGLE OF SPINDLE
            40 L X+35 Y+20 R0 FMAX M99
            41 L X+10 Y+10 Z+50 R0 FMAX
            42 CYCL DEF 201 REAMING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-10 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q211=1 ;DWELL TIME AT DEPTH ~
                Q208=0 ;RETRACTION FEED RATE ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=50 ;2ND SET-UP CLEARANCE
            43 L X+10 Y+10 R0 FMAX M99
            44 L X+35 R0 FMAX M99
            45 CYCL DEF 201 REAMING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-10 ;DEPTH ~
                Q206=180 ;FEED RATE FOR PLNGNG ~
                Q211=1 ;DWELL TIME AT DEPTH ~
                Q208=0 ;RETRACTION FEED RATE ~
                Q203=+2.5 ;SURFACE COORDINATE ~
                Q204=47.5 ;2ND SET-UP CLEARANCE
            46 L X+35 Y+20 R0 FMAX M99
            47 L X+10 Y+10 Z+50 R0 FMAX
            48 CYCL DEF 207 RIGID TAPPING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-10 ;DEPTH ~
                Q239=+1.25 ;THREAD PITCH ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=50 ;2ND SET-UP CLEARANCE
            49 L X+10 Y+10 R0 FMAX M99
            50 L X+10 Y+10 R0 FMAX M99
            51 L X+35 R0 FMAX M99
            52 L X+35 Y+10 R0 FMAX M99
            53 CYCL DEF 207 RIGID TAPPING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-10 ;DEPTH ~
                Q239=+1.25 ;THREAD PITCH ~
                Q203=+2.5 ;SURFACE COORDINATE ~
                Q204=47.5 ;2ND SET-UP CLEARANCE
            54 L X+35 Y+20 R0 FMAX M99
            55 L X+35 Y+20 R0 FMAX M99
            56 L X+10 Y+10 Z+50 R0 FMAX
            57 L M5
            58 TOOL CALL S300
            59 L M4
            60 CYCL DEF 207 RIGID TAPPING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-10 ;DEPTH ~
                Q239=-1.25 ;THREAD PITCH ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=50 ;2ND SET-UP CLEARANCE
            61 L X+10 Y+10 R0 FMAX M99
            62 L X+35 R0 FMAX M99
            63 CYCL DEF 207 RIGID TAPPING ~
                Q200=3 ;SET-UP CLEARANCE ~
                Q201=-10 ;DEPTH ~
                Q239=-1.25 ;THREAD PITCH ~
                Q203=+2.5 ;SURFACE COORDINATE ~
                Q204=47.5 ;2ND SET-UP CLEARANCE
            64 L X+35 Y+20 R0 FMAX M99
            65 L M5
            66 L Z-5 R0 FMAX M91
            67 L M30
            68 END PGM 1 MM
        "#]],
    );
}

/// A cycle is defined again where a parameter changes, and not for another hole at the same place.
#[test]
fn a_hole_that_is_made_again_needs_no_definition() {
    let text = format!(
        "{HEAD}RAPID\nGOTO/10,10,50\nCYCLE/DRILL,DEPTH,5,MMPM,180,CLEAR,3\nGOTO/10,10,0\nGOTO/10,10,0\nCYCLE/OFF\nFINI\n"
    );
    let tape = tape_for(MILL, &text).text();
    assert_eq!((tape.matches("CYCL DEF").count(), tape.matches("L X+10 Y+10 R0 FMAX M99").count()), (1, 2));
}

#[test]
fn feeds_and_threads_in_inches() {
    let text = "UNITS/INCHES\nLOADTL/1\nSPINDL/600,CLW\nRAPID\nGOTO/1,3,2\nCYCLE/DRILL,DEPTH,.4,IPM,5.5,CLEAR,.2\nGOTO/1,3,0\n\
                CYCLE/TAP,DEPTH,.4,TPI,20,CLEAR,.2\nGOTO/1,3,0\nCYCLE/OFF\nFEDRAT/.004,IPR\nGOTO/1,3,1\nFEDRAT/.5\nGOTO/2,3,1\nFINI\n";
    check(
        text,
        &expect![[r#"
            0 BEGIN PGM 1 INCH
            1 TOOL CALL 1 Z S600
            2 L M3
            3 L X+1 Y+3 R0 FMAX
            4 L Z+2 R0 FMAX
            5 CYCL DEF 200 DRILLING ~
                Q200=0.2 ;SET-UP CLEARANCE ~
                Q201=-0.4 ;DEPTH ~
                Q206=55 ;FEED RATE FOR PLNGNG ~
                Q202=0.4 ;PLUNGING DEPTH ~
                Q210=0 ;DWELL TIME AT TOP ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=2 ;2ND SET-UP CLEARANCE ~
                Q211=0 ;DWELL TIME AT DEPTH
            6 L X+1 Y+3 R0 FMAX M99
            7 CYCL DEF 207 RIGID TAPPING ~
                Q200=0.2 ;SET-UP CLEARANCE ~
                Q201=-0.4 ;DEPTH ~
                Q239=+0.05 ;THREAD PITCH ~
                Q203=+0 ;SURFACE COORDINATE ~
                Q204=2 ;2ND SET-UP CLEARANCE
            8 L X+1 Y+3 R0 FMAX M99
            9 L Z+1 R0 FU0.004
            10 L X+2 R0 F5
            11 L M5
            12 L Z-5 R0 FMAX M91
            13 L M30
            14 END PGM 1 INCH
        "#]],
    );
}

#[test]
fn a_cycle_that_the_control_lacks_is_made_of_moves() {
    let text = format!(
        "{HEAD}RAPID\nGOTO/10,10,50\nCYCLE/SHIFT,DEPTH,10,MMPM,180,CLEAR,3,OFFSET,.2\nGOTO/10,10,0\nCYCLE/OFF\nFINI\n"
    );
    let expanded = PostFindingKind::CycleExpanded { cycle: "SHIFT".into() };
    check_with(
        MILL,
        &text,
        &[expanded],
        &expect![[r#"
        0 BEGIN PGM 1 MM
        1 TOOL CALL 1 Z S1000
        2 L M3
        3 L X+10 Y+10 R0 FMAX
        4 L Z+50 R0 FMAX
        5 L Z+3 R0 FMAX
        6 L Z-10 R0 F180
        7 L M19
        8 L X+10.2 R0 FMAX
        9 L Z+50 R0 FMAX
        10 L X+10 R0 FMAX
        11 L M3
        12 L M5
        13 L Z-5 R0 FMAX M91
        14 L M30
        15 END PGM 1 MM
    "#]],
    );
}
