//! One small file as every system would write it.

use apt_cldata::text::ClDialect;

use super::{read, text};

/// A small file with one of everything.
const SMALL: &str = "PARTNO SMALL PART
$$ roughing
MACHIN/MILL5,3
UNITS/MM
INTOL/0.01
CUTTER/10,2,3,2,0,0,40
LOADTL/4,LENGTH,85.5,ADJUST,14
SPINDL/1200,RPM,CLW
COOLNT/FLOOD
PPRINT WATCH THE CLAMPS
FROM/0,0,100
RAPID
GOTO/20,0,5
FEDRAT/150.5,MMPM
GOTO/20,0,-2.25
CIRCLE/0,0,-2.25,0,0,1,20
GOTO/0,20,-2.25 $$ a quarter
GOTO/-5,30,-2.25
CYCLE/DRILL,FEDTO,10,MMPM,80,RAPTO,2
GOTO/1,2,0
CYCLE/OFF
MULTAX/ON
GOTO/1,2,3.3333333333333335,0,0.6,0.8
MULTAX/OFF
GOTO/1,2,50
FINI
";

fn small(to: ClDialect) -> String {
    let made = text(&read(SMALL), ClDialect::Generic, to);
    // Of the eighteen positions that the reader puts on the arc the first and the last but one are enough here.
    let mut lines: Vec<&str> = made.lines().collect();
    let near_ends = |line: &&str| line.contains("19.9238939618349");
    if let Some(first) = lines.iter().position(near_ends) {
        let last = lines.iter().rposition(near_ends).unwrap();
        lines.splice(first + 1..last, ["..."]);
    }
    lines.join("\n") + "\n"
}

#[test]
fn small_file_as_apt_text() {
    expect_test::expect![[r#"
        PARTNO SMALL PART
        $$ roughing
        MACHIN/MILL5,3.0
        UNITS/MM
        INTOL/0.01
        CUTTER/10.0,2.0,3.0,2.0,0.0,0.0,40.0
        LOADTL/4.0,LENGTH,85.5,ADJUST,14.0
        SPINDL/1200.0,RPM,CLW
        COOLNT/FLOOD
        PPRINT WATCH THE CLAMPS
        FROM/0.0,0.0,100.0
        RAPID
        GOTO/20.0,0.0,5.0
        FEDRAT/150.5,MMPM
        GOTO/20.0,0.0,-2.25
        CIRCLE/0.0,0.0,-2.25,0.0,0.0,1.0,20.0
        GOTO/19.92389396183491,1.7431148549531632,-2.25
        ...
        GOTO/1.7431148549531672,19.92389396183491,-2.25
        GOTO/0.0,20.0,-2.25
        $$ a quarter
        GOTO/-5.0,30.0,-2.25
        CYCLE/DRILL,FEDTO,10.0,MMPM,80.0,RAPTO,2.0
        GOTO/1.0,2.0,0.0
        CYCLE/OFF
        MULTAX/ON
        GOTO/1.0,2.0,3.3333333333333335,0.0,0.6,0.8
        MULTAX/OFF
        GOTO/1.0,2.0,50.0
        FINI
    "#]]
    .assert_eq(&small(ClDialect::Generic));
}

#[test]
fn small_file_as_catia() {
    expect_test::expect![[r#"
        $$     CATIA APT VERSION 1.0
        PARTNO SMALL PART
        $$ roughing
        MACHIN/MILL5,3
        UNITS/MM
        INTOL/  0.010000
        CUTTER/ 10.000000,  2.000000,  3.000000,  2.000000,  0.000000,  0.000000,$
            40.000000
        LOADTL/4,LENGTH,   85.5000,ADJUST,14
        SPINDL/ 1200.0000,RPM,CLW
        COOLNT/FLOOD
        PPRINT WATCH THE CLAMPS
        FROM/    0.00000,    0.00000,  100.00000
        RAPID
        GOTO  /   20.00000,    0.00000,    5.00000
        FEDRAT/  150.5000,MMPM
        GOTO  /   20.00000,    0.00000,   -2.25000
        AUTOPS
        INDIRV/  0.00000,  1.00000,  0.00000
        TLON,GOFWD/ (CIRCLE/    0.00000,    0.00000,   -2.25000,$
           20.00000),ON,(LINE/    0.00000,    0.00000,   -2.25000,$
            0.00000,   20.00000,   -2.25000)
        $$ a quarter
        GOTO  /   -5.00000,   30.00000,   -2.25000
        CYCLE/DRILL,   10.0000,   80.0000,MMPM,    2.0000
        GOTO  /    1.00000,    2.00000,    0.00000
        CYCLE/OFF
        MULTAX
        GOTO  /    1.00000,    2.00000,3.3333333333333335, 0.000000, 0.600000, 0.800000
        MULTAX/OFF
        GOTO  /    1.00000,    2.00000,   50.00000
        FINI
    "#]]
    .assert_eq(&small(ClDialect::Catia));
}

#[test]
fn small_file_as_creo() {
    expect_test::expect![[r#"
        $$*         Pro/CLfile  Version
        PARTNO / SMALL PART
        $$ roughing
        MACHIN / MILL5, 3
        UNITS / MM
        INTOL / 0.010000
        $$-> CUTTER / 10.000000, 2.000000, 3.000000, 2.000000, 0.000000,  $
                0.000000, 40.000000
        LOADTL / 4, LENGTH, 85.500000, OSETNO, 14
        SPINDL / RPM, 1200.000000, CLW
        COOLNT / FLOOD
        PPRINT / WATCH THE CLAMPS
        FROM / 0.0000000000, 0.0000000000, 100.0000000000
        RAPID
        GOTO / 20.0000000000, 0.0000000000, 5.0000000000
        FEDRAT / 150.500000, MMPM
        GOTO / 20.0000000000, 0.0000000000, -2.2500000000
        CIRCLE / 0.0000000000, 0.0000000000, -2.2500000000, 0.0000000000,  $
                0.0000000000, 1.0000000000, 20.0000000000
        GOTO / 19.92389396183491, 1.7431148549531632, -2.2500000000
        ...
        1.7431148549531672, 19.92389396183491, -2.2500000000
        0.0000000000, 20.0000000000, -2.2500000000
        $$ a quarter
        GOTO / -5.0000000000, 30.0000000000, -2.2500000000
        CYCLE / DRILL, DEPTH, 10.000000, MMPM, 80.000000, CLEAR, 2.000000
        GOTO / 1.0000000000, 2.0000000000, 0.0000000000
        CYCLE / OFF
        MULTAX / ON
        GOTO / 1.0000000000, 2.0000000000, 3.3333333333333335,  $
                0.0000000000, 0.6000000000, 0.8000000000
        MULTAX / OFF
        GOTO / 1.0000000000, 2.0000000000, 50.0000000000
        FINI
    "#]]
    .assert_eq(&small(ClDialect::Creo));
}

#[test]
fn small_file_as_hsm() {
    expect_test::expect![[r#"
        PARTNO/'SMALL PART'
        $$ roughing
        MACHIN/MILL5, 3
        UNITS/MM
        INTOL/0.010000
        CUTTER/10.000000, 2.000000, 3.000000, 2.000000, 0.000000, 0.000000, 40.000000
        LOADTL/4, 0, 85.500000, 14
        SPINDL/1200.000000, RPM, CLW
        COOLNT/FLOOD
        PPRINT/'WATCH THE CLAMPS'
        FROM/0.000000, 0.000000, 100.000000
        RAPID
        GOTO/20.000000, 0.000000, 5.000000
        FEDRAT/150.500000, MMPM
        GOTO/20.000000, 0.000000, -2.250000
        MOVARC/0.000000, 0.000000, -2.250000, 0.000000000, 0.000000000, 1.000000000, 20.000000, ANGLE, 90.000000
        GOTO/0.000000, 20.000000, -2.250000
        $$ a quarter
        GOTO/-5.000000, 30.000000, -2.250000
        CYCLE/DRILL, 10.000000, MMPM, 80.000000, 2.000000
        GOTO/1.000000, 2.000000, 0.000000
        CYCLE/OFF
        MULTAX/ON
        GOTO/1.000000, 2.000000, 3.3333333333333335, 0.000000000, 0.600000000, 0.800000000
        MULTAX/OFF
        GOTO/1.000000, 2.000000, 50.000000
        FINI
    "#]].assert_eq(&small(ClDialect::Hsm));
}

#[test]
fn small_file_as_ncl() {
    expect_test::expect![[r#"
        N1    , PARTNO SMALL PART
        $$ roughing
        N3    , MACHIN/ MILL5, 3.
        N4    , UNITS/ MM
        N5    , INTOL/ 0.01
        N6    , CUTTER/ 10., 2., 3., 2., 0., 0., 40.
        N7    , LOADTL/ 4., LENGTH, 85.5, OFFSET, 14.
        N8    , SPINDL/ RPM, 1200., CLW
        N9    , COOLNT/ FLOOD
        N10   , PPRINT WATCH THE CLAMPS
        N11   , FROM/    0.        ,    0.        ,  100.
        N12   , RAPID
        N13   , GOTO/   20.        ,    0.        ,    5.
        N14   , FEDRAT/ MMPM, 150.5
        N15   , GOTO/   20.        ,    0.        ,   -2.25
        N16   , CIRCLE/ 0., 0., -2.25, 0., 0., 1., 20.
        N16   , GOTO/ 19.92389396183491, 1.7431148549531632,   -2.25
        ...
                GOTO/ 1.7431148549531672, 19.92389396183491,   -2.25
                GOTO/    0.        ,   20.        ,   -2.25
        $$ a quarter
        N18   , GOTO/   -5.        ,   30.        ,   -2.25
        N19   , CYCLE/ DRILL, FEDTO, 10., MMPM, 80., RAPTO, 2.
        N20   , GOTO/    1.        ,    2.        ,    0.
        N21   , CYCLE/ OFF
        N22   , MULTAX/ ON
        N23   , GOTO/    1.        ,    2.        , 3.3333333333333335, $
                   0.        ,    0.6       ,    0.8
        N24   , MULTAX/ OFF
        N25   , GOTO/    1.        ,    2.        ,   50.
        N26   , FINI
    "#]]
    .assert_eq(&small(ClDialect::Ncl));
}

#[test]
fn small_file_as_nx() {
    expect_test::expect![[r#"
        TOOL PATH/SMALL_PART,TOOL,NONE
        PARTNO SMALL PART
        $$ roughing
        MACHIN/MILL5,3
        UNITS/MM
        INTOL/0.0100
        TLDATA/MILL,10.0000,2.0000,40.0000,0.0000,0.0000
        LOAD/TOOL,4,ADJUST,14
        $$ |LOADTL/LENGTH,85.5
        SPINDL/RPM,1200.0000,CLW
        COOLNT/FLOOD
        PPRINT/WATCH THE CLAMPS
        FROM/0.0000,0.0000,100.0000
        RAPID
        GOTO/20.0000,0.0000,5.0000
        FEDRAT/MMPM,150.5000
        GOTO/20.0000,0.0000,-2.2500
        CIRCLE/0.0000,0.0000,-2.2500,0.0000000,0.0000000,1.0000000,20.0000
        GOTO/0.0000,20.0000,-2.2500
        $$ a quarter
        GOTO/-5.0000,30.0000,-2.2500
        CYCLE/DRILL,RAPTO,2.0000,FEDTO,-10.0000,MMPM,80.0000
        GOTO/1.0000,2.0000,0.0000
        CYCLE/OFF
        MULTAX/ON
        GOTO/1.0000,2.0000,3.3333333333333335,0.0000000,0.6000000,0.8000000
        MULTAX/OFF
        GOTO/1.0000,2.0000,50.0000
        END-OF-PATH
    "#]]
    .assert_eq(&small(ClDialect::Nx));
}
