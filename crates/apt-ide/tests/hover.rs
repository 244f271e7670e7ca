//! Hovers: words, names of every type, results of motions.

#![allow(
    clippy::unwrap_used,
    clippy::needless_pass_by_value,
    reason = "tests fail where something is missing, and say what they expect in place"
)]

mod support;

use std::sync::Arc;

use apt_ide::{Analysis, Settings};
use apt_syntax::vocabulary::words;
use expect_test::{Expect, expect};

use support::{analysis, marked, never};

fn check(text: &str, expected: Expect) {
    let (analysis, offset) = marked(text);
    let hover = analysis.hover(offset, &never).unwrap();
    expected.assert_eq(&hover.map_or("nothing".to_owned(), |hover| hover.markdown + "\n"));
}

#[test]
fn every_word_of_the_vocabulary_has_a_hover() {
    for word in words() {
        let dialect = word.dialects.first().map(|dialect| dialect.as_str().to_owned());
        let settings = Arc::new(Settings { dialect, ..Settings::default() });
        let text = format!("{}/1\n", word.spelling);
        let hover = Analysis::new(&text, None, &settings).hover(1, &never).unwrap();
        let hover = hover.unwrap_or_else(|| panic!("{} has no hover", word.spelling));
        assert_eq!(hover.range, 0..word.spelling.len(), "{}", word.spelling);
        assert!(hover.markdown.contains(word.help), "{}: {}", word.spelling, hover.markdown);
    }
}

const GEOMETRY: &str = "\
PARTNO KINDS
P1=POINT/1,2,3
V1=VECTOR/3,4,0
L1=LINE/0,0,0,3,4,0
PL1=PLANE/0,0,1,5
C1=CIRCLE/1,2,5
CY1=CYLNDR/0,0,0,0,0,1,2
SP1=SPHERE/0,0,0,4
CO1=CONE/(POINT/0,0,0),(VECTOR/0,0,1),30
M1=MATRIX/TRANSL,1,2,3
E1=ELLIPS/CENTER,(POINT/0,0,0),3,2,0
H1=HYPERB/CENTER,(POINT/0,0,0),3,2,0
G1=GCONIC/1,0,1,0,0,-4
Q1=QADRIC/1,1,1,0,0,0,0,0,0,-4
A=2.5
RESERV/T,3
T(2)=POINT/7,8,9
FINI
";

#[test]
fn names_of_every_type_tell_their_canonical_form() {
    let program = analysis(GEOMETRY);
    let mut all = String::new();
    for line in GEOMETRY.lines().filter(|line| line.contains('=')) {
        let offset = GEOMETRY.find(&format!("\n{line}")).unwrap() + 1;
        let hover = program.hover(offset, &never).unwrap().unwrap_or_else(|| panic!("nothing about {line}"));
        let form = program.canonical_form(offset, &never).unwrap().unwrap();
        assert!(hover.markdown.contains(&form.text), "{line}: {}", hover.markdown);
        assert_eq!(form.canonical.len(), form.meaning.len(), "{line}");
        all.push_str(&format!("{} {}: {}\n", form.name, form.kind, form.text));
    }
    expect![[r#"
        P1 POINT: point (1, 2, 3)
        V1 VECTOR: vector (3, 4, 0) of length 5
        L1 LINE: line 0.8·x − 0.6·y = 0, at 53.1301024° to the x axis
        PL1 PLANE: plane z = 5
        C1 CIRCLE: circle of radius 5 about (1, 2)
        CY1 CYLNDR: cylinder of radius 2 about the axis through (0, 0, 0) along (0, 0, 1)
        SP1 SPHERE: sphere of radius 4 about (0, 0, 0)
        CO1 CONE: cone with vertex (0, 0, 0), opening along (0, 0, 1), half angle 30°
        M1 MATRIX: matrix, by rows; the fourth column is the shift
        E1 ELLIPS: ellipse (a cylinder parallel to z)
        H1 HYPERB: hyperbola (a cylinder parallel to z)
        G1 GCONIC: conic (a cylinder parallel to z)
        Q1 QADRIC: quadric Ax²+By²+Cz²+D+2Fyz+2Gxz+2Hxy+2Px+2Qy+2Rz = 0
        A SCALAR: 2.5
        T(2) POINT: point (7, 8, 9)
    "#]]
    .assert_eq(&all);
}

#[test]
fn a_circle_has_a_table_of_its_numbers() {
    check(
        "C1=CIRCLE/1,2,5\nGOFWD/C$01\nFINI\n",
        expect![[r#"
        ```apt
        C1=CIRCLE
        ```
        circle of radius 5 about (1, 2)

        | | canonical |
        |---|---|
        | centre x | 1 |
        | centre y | 2 |
        | centre z | 0 |
        | axis i | 0 |
        | axis j | 0 |
        | axis k | 1 |
        | radius | 5 |

    "#]],
    );
}

#[test]
fn a_motion_tells_its_cut_vectors_and_the_proof() {
    check(
        "PARTNO M\nCUTTER/1\nINTOL/0.01\nOUTTOL/0.01\nC1=CIRCLE/0,0,5\nL1=LINE/0,0,1,0\nFROM/8,-3,0\nGO/TO,C1\n\
         INDIRV/0,1,0\nTLRGT,GOF$0WD/C1,PAST,L1\nFINI\n",
        expect![[r#"
            **3 cut vectors** (no fewer than 3 are possible) — verified

            | surface | clearance | allowed |
            |---|---|---|
            | part | 0 … 0 | -0.01 … 0.01 |
            | drive | -0.00929576189 … 0.00999 | -0.01 … 0.01 |
            | check | 0 … 0 | -0.01 … 0.01 |

            - motion computed in closed form, in the plane across the vertical tool
            - vectors 1 to 2 end where the sag at the drive surface fills 96 % of its tolerance (lengths 0.780240547 to 0.914291751)
            - vector 3 ends PAST the check surface (length 0.780240547)

            `GOTO/5.38085115,-1.1859303,0`  
            `GOTO/5.50288027,-0.279818663,0`  
            `GOTO/5.47722558,0.5,0`  

            ---
            ```apt
            GOFWD/ds
            GOFWD/ds,[{TO|ON|PAST|TANTO|DSTAN|PSTAN},][n,INTOF,]cs[,feed]
            GOFWD/ds,[mod,]cs1,label1,[mod,]cs2,label2
            ```
            Keep the present direction and move along the drive surface; after an implied check surface the passage is tangent.
        "#]],
    );
}

#[test]
fn a_pocket_tells_its_passes_and_the_proof() {
    let text = "PARTNO P\nCUTTER/1\nINTOL/0.01\nOUTTOL/0.01\nFROM/0,0,5\n\
                POC$0KET/.49,1,1,5,10,8,1,1,0,0,0,8,0,0,8,5,0,0,5,0\nFINI\n";
    let (analysis, offset) = marked(text);
    let hover = analysis.hover(offset, &never).unwrap().unwrap().markdown;
    expect![[r#"
        **pocket**, plunge: 1 position at feed 5; general passes: 19 positions at feed 10; finishing pass: 5 positions at feed 8 — verified

        | surface | clearance | allowed |
        |---|---|---|
        | part | 0 … 0 | 0 … 0 |
        | drive | 0 … 0 | 0 … 0 |

        `GOTO/2.25,2.25,0`  
        `GOTO/5.75,2.25,0`  
        `GOTO/5.75,2.75,0`  
        `GOTO/2.25,2.75,0`  
        … 21 more  

        ---
        ```apt
        POCKET/re,c,f,f1,f2,f3,o,p,point,point,point,...
        ```
        Clear a convex pocket: radius, offsets, three feeds, two switches, then three to twenty corner points."#]].assert_eq(&hover);
}

#[test]
fn motions_to_points_tell_their_positions() {
    let text =
        "FROM/0,0,5\nP1=POINT/1,2,3\nLOOPST\nA=1\nB)GOD$0LTA/A,0,0\nA=A+1\nIF(A-3)B,C,C\nC)LOOPND\nFINI\n";
    check(
        text,
        expect![[r#"
        **2 positions**

        `GOTO/1,0,5`  
        `GOTO/3,0,5`  

        ---
        ```apt
        GODLTA/dx,dy,dz[,feed]
        GODLTA/vector[,feed]
        GODLTA/d[,feed]
        ```
        Move by increments, along a vector, or with one number along the tool axis (positive withdraws).
    "#]],
    );
}

#[test]
fn words_are_explained_inside_of_other_statements() {
    check(
        "P1=POINT/1,2\nL1=LINE/P1,ATAN$0GL,30\nFINI\n",
        expect![[r#"
        **ATANGL** At an angle, in degrees, to an axis, a line, a plane or a surface normal.

        modifier, code 1

        here in LINE:
        ```apt
        LINE/point,{ATANGL,angle|SLOPE,s}[,{XAXIS|YAXIS}]
        LINE/point,{ATANGL,angle|SLOPE,s},line
        ```
    "#]],
    );
}

#[test]
fn a_name_in_a_loop_tells_its_first_and_last_value() {
    check(
        "LOOPST\nA=1\nB) A$0=A+1\nIF(A-5)B,C,C\nC) LOOPND\nFINI\n",
        expect![[r#"
        ```apt
        A=5
        ```
        scalar

        the last of 4 times; the first: 2
    "#]],
    );
}

#[test]
fn a_macro_and_its_variables_tell_what_they_get() {
    let text =
        "M1=MACRO/DX,DY=2\nGODLTA/DX,DY,0\nTERMAC\nFROM/0,0,0\nCALL/M1,DX=7,DY=1\nCALL/M1,DX=8\nFINI\n";
    check(
        &text.replacen("M1=", "M$01=", 1),
        expect![[r#"
            ```apt
            M1=MACRO/DX,DY
            ```
            macro of 1 statement
        "#]],
    );
    check(
        &text.replacen("GODLTA/DX", "GODLTA/D$0X", 1),
        expect![[r#"
            variable `DX` of macro `M1`:

            - `7` at statement 5
            - `8` at statement 6
        "#]],
    );
    check(
        &text.replacen("GODLTA/DX,DY", "GODLTA/DX,D$0Y", 1),
        expect![[r#"
            variable `DY` of macro `M1`:

            - `1` at statement 5
            - `(default)` at statement 6
        "#]],
    );
}

#[test]
fn there_is_nothing_to_say_about_blanks_comments_and_text() {
    for text in ["P1=POINT/1,2 $0  $$ X\n", "$$ P1$0\n", "PARTNO P$0ART\n", "P1=POINT/1$02,2\n", "$0"] {
        let (analysis, offset) = marked(text);
        assert_eq!(analysis.hover(offset, &never).unwrap(), None, "{text:?}");
    }
}

#[test]
fn a_cancelled_hover_is_no_answer() {
    let (analysis, offset) = marked("P1=POINT/1,2\nL1=LINE/P$01,ATANGL,30\nFINI\n");
    assert!(analysis.hover(offset, &|| true).is_err());
    assert!(analysis.hover(offset, &never).unwrap().is_some());
}

const JUMPS: &str = "\
A=0
LOOPST
L1)A=A+1
IF(A-3)L1,L1,L2
B=1
L3)B=2
L2)GOTO/A,0,0
LOOPND
JUMPTO/L9
L4)A=9
FINI
";

#[test]
fn labels_tell_where_they_are_who_jumps_there_and_whether_they_are_reached() {
    let told = |mark: &str, with: &str| {
        let (analysis, offset) = marked(&JUMPS.replacen(mark, with, 1));
        analysis.hover(offset, &never).unwrap().unwrap().markdown
    };
    let first = "label `L1` of statement 3, which is reached 4 times\n\njumped to from:\n- statement 4, IF";
    assert_eq!(told("L1)", "$0L1)"), first);
    assert_eq!(told("IF(A-3)L1", "IF(A-3)$0L1"), first);
    assert_eq!(
        told("L2)", "$0L2)"),
        "label `L2` of statement 7, which is reached once\n\njumped to from:\n- statement 4, IF"
    );
    assert_eq!(
        told("L3)", "$0L3)"),
        "label `L3` of statement 6, which is never reached\n\nnothing jumps here"
    );
    assert_eq!(
        told("JUMPTO/L9", "JUMPTO/$0L9"),
        "label `L9`, which stands before no statement\n\njumped to from:\n- statement 9, JUMPTO"
    );
}

#[test]
fn modifiers_are_told_in_their_forms() {
    let told = |text: &str| {
        let (analysis, offset) = marked(text);
        analysis.program(&never).unwrap();
        analysis.hover(offset, &never).unwrap().unwrap().markdown
    };
    let word = told("SPINDL/800,$0CLW\nFINI\n");
    assert!(word.starts_with("**CLW** ") && word.contains("here in SPINDL:\n"), "{word}");
    let line = told("P=POINT/1,2\nL=LINE/P,$0ATANGL,30\nFINI\n");
    assert!(line.contains("\nLINE/point,{ATANGL,") && !line.contains("PARLEL"), "{line}");
    let motion = told("L1=LINE/XAXIS\nL2=LINE/YAXIS\nGOLFT/L1,$0PAST,L2\nFINI\n");
    assert!(motion.contains("GOLFT/ds,") && motion.contains("here in GOLFT:"), "{motion}");
    // A word that is no modifier of this statement is told alone.
    assert!(!told("SPINDL/800,$0XLARGE\nFINI\n").contains("in SPINDL"));
}

const MILLING: &str = "\
$$ apt-lsp: dialect=apt4
A1=POINT/0,0,0
A2=POINT/2,0,0
B1=POINT/0,2,0
B2=POINT/2,2,0
VZ=VECTOR/0,0,1
VM=VECTOR/0,0,-1
PL=PLANE/0,0,1,4
K1=SCURV/SPLINE,A1,A2
S1=SSURF/SMESH,XYZ,SPLINE,A1,A2,SPLINE,B1,B2
CUTTER/.5,.25
SCON/DS,S1,PARAM,0,1,0,1,ON,VM
SCON/PS,TO,S1,PLUS,0
";

#[test]
fn straight_directions_of_a_surface_have_no_curvature() {
    let told = |text: &str| {
        let (analysis, offset) = marked(text);
        analysis.hover(offset, &never).unwrap().unwrap().markdown
    };
    let curve =
        "$$ apt-lsp: dialect=apt4\nC=SCURV/SPLINE,(POINT/0,0,0),TANSPL,(VECTOR/1,0,0),(POINT/20,0,2)\n";
    let ruled = told(&format!("{curve}S=SSURF/RULED,C,AXIS,(VECTOR/0,1,0)\nCHKSRF/$0S,ON\nFINI\n"));
    assert!(ruled.contains(", curvature 0 … 0.0099"), "{ruled}");
}

#[test]
fn a_command_of_regional_milling_tells_its_conditions() {
    let conditions = |text: &str| {
        let (analysis, offset) = marked(text);
        let markdown = analysis.hover(offset, &never).unwrap().unwrap().markdown;
        let rows: Vec<&str> = markdown.lines().filter(|line| line.starts_with('|')).collect();
        rows.join("\n") + "\n"
    };
    expect![[r#"
        | condition | |
        |---|---|
        | `SCON/DS` | valid |
        | `SCON/PS` | valid |
        | `SCON/AXIS` | **missing** |
        | `SCON/FEED` | **has a mistake** |
        | `SCON/STEPOV` | **missing** |
    "#]]
    .assert_eq(&conditions(&format!(
        "{MILLING}SCON/FEED,1,2,3\nS$0MIL/ZIGZAG,DS,PARAM,0,0,TANSPL,PLUS,STEPOV,PLUS\nFINI\n"
    )));
    expect![[r#"
        | condition | in force |
        |---|---|
        | `SCON/DS` | S1, u 0 … 1, v 0 … 1; the tool end along (0, 0, -1) |
        | `SCON/PS` | TO S1, PLUS, stock 0 |
        | `SCON/AXIS` | from the normal of the part 0° across and 5° to the feed |
        | `SCON/FEED` | cutting 1, step over 2, plunge 3, rapid 4 |
        | `SCON/STEPOV` | scallops of 0.02, at most 1 apart, lift 0.5, at most 3 passes |
        | `SCON/FEED,plane` | z = 4 |
        | `CHKSRF` | PS |
        | `AVCTRL` | tilt -10° … 20° and 1° more, then lift along the normal of the part, at most 2 |
        | `GOUGCK` | ON |
    "#]]
    .assert_eq(&conditions(&format!(
        "{MILLING}SCON/AXIS,ATANGL,PS,0,CUTANG,5\nSCON/FEED,1,2,3,4\nSCON/FEED,PL\nSCON/STEPOV,.02,1,.5,3\n\
         CHKSRF/PS,ON\nGOUGCK/ON\nAVCTRL/CUTANG,CONST,1,RANGE,-10,20,NORMPS,LIMIT,2\n\
         S$0MIL/PICKFD,DS,PARAM,0,0,TANSPL,PLUS,STEPOV,PLUS\nFINI\n"
    )));
}

#[test]
fn curves_and_surfaces_tell_their_size() {
    let text = |name: &str| {
        let program = analysis(&format!("{MILLING}FINI\n"));
        let offset = MILLING.find(&format!("\n{name}=")).unwrap() + 1;
        program.canonical_form(offset, &never).unwrap().unwrap().text
    };
    let curve = text("K1");
    assert_eq!(
        curve,
        "space curve of 1 arc, 2 long, from (0, 0, 0) to (2, 0, 0), inside (0, 0, 0) … (2, 0, 0)"
    );
    expect![[
        r#"sculptured surface of 1 patch, inside (0, 0, 0) … (2, 2, 0), area 4, curvature 0 … 0 (positive where it is hollow on the side of its sign word)"#
    ]]
    .assert_eq(&text("S1"));
}

#[test]
fn a_name_without_a_value_tells_why() {
    let told = |text: &str| {
        let (analysis, offset) = marked(text);
        analysis.hover(offset, &never).unwrap().map(|hover| hover.markdown)
    };
    let parallel = "L1=LINE/0,0,1,0\nL2=LINE/0,1,1,1\n$0P1=POINT/INTOF,L1,L2\nGOTO/P1\nFINI\n";
    let why = told(parallel).unwrap();
    assert!(why.starts_with("`P1` has no value:\n- statement 3: ") && why.ends_with(')'), "{why}");
    assert_eq!(why.matches("(APT0").count(), 1, "hints are no reason: {why}");
    assert_eq!(told(&parallel.replace("$0", "").replace("GOTO/", "GOTO/$0")), Some(why));
    assert_eq!(told("GOTO/$0P2\nFINI\n").unwrap(), "`P2` has no value: no statement gives it one");
    assert_eq!(told("RESERV/$0A,3\nFINI\n").unwrap(), "`A` has no value:\n- statement 1 gives it none");
    let word = told("$0INCLUD/SHARED\nFINI\n").unwrap();
    assert!(word.contains("Insert the statements of another file"), "{word}");
    assert_eq!(told("$$ apt-lsp: dialect=cl\nTOOL PATH/$0OP1,TOOL,T1\n"), None, "a text");
}

#[test]
fn calls_and_loops_show_what_they_execute() {
    let told = |text: &str| {
        let (analysis, offset) = marked(text);
        analysis.hover(offset, &never).unwrap().unwrap().markdown
    };
    let text = "M1=MACRO/X,Y=2\nGOTO/X,Y,0\nGODLTA/X\nTERMAC\nFROM/0,0,0\nCALL/M1,X=3\nLOOPST\nI=1\nA) GOTO/I,0,0\nI=I+1\n\
        IF(I-20)A,B,B\nB) LOOPND\nFINI\n";
    let body = "\n\nexecutes:\n```apt\nGOTO/3,2,0\nGODLTA/3\n```";
    for place in ["$0CALL/M1", "CALL/$0M1"] {
        let hover = told(&text.replace("CALL/M1", place));
        assert!(hover.ends_with(body), "{place}: {hover}");
    }
    let hover = told(&text.replace("LOOPST", "$0LOOPST"));
    assert!(
        hover.contains("executes:\n```apt\nI=1\nGOTO/1,0,0\n") && hover.ends_with(" more lines"),
        "{hover}"
    );
    assert!(
        !told(&text.replace("M1=MACRO", "$0M1=MACRO")).contains("executes"),
        "a definition executes nothing"
    );
    assert!(told("M1=MACRO/X\n$0CALL/M1,X=1\nTERMAC\nFINI\n").ends_with("executes nothing"));
}

#[test]
fn a_cycle_with_steps_tells_what_the_drill_does_between_them() {
    let breaks = "In this file it breaks chips";
    let withdraws = "In this file it withdraws the drill";
    let ncl =
        "N1    , PARTNO X\nN2    , CYCLE/ WORD, FEDTO, 10., MMPM, 80., RAPTO, 2., STEP, 3.\nN3    , FINI\n";
    let other = "CYCLE/WORD,FEDTO,10,MMPM,80,RAPTO,2,STEP,3\nFINI\n";
    for (text, word, said) in
        [(ncl, "DEEP", breaks), (ncl, "THRU", withdraws), (ncl, "BRKCHP", breaks), (other, "DEEP", withdraws)]
    {
        let (analysis, offset) = marked(&text.replace("WORD", &format!("{}$0{}", &word[..2], &word[2..])));
        let hover = analysis.hover(offset, &never).unwrap().unwrap().markdown;
        assert!(hover.contains(said), "{word} in {text}: {hover}");
    }
}
