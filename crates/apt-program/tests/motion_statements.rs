//! The rows of the language reference for motion, parameters, tool axis, POCKET and transformations: every form is
//! taken, every mistake has its number (sections 6.2 to 6.11).

use apt_geometry::copy::CopyStep;
use apt_program::{Options, Program, RecordKind, Severity, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree};

const NAMES: &str = "P1=POINT/1,2,3\nP2=POINT/5,2,3\nP3=POINT/5,6,3\nV1=VECTOR/0,0,2\nV2=VECTOR/1,0,0\nL1=LINE/XAXIS\n\
    L2=LINE/YAXIS\nPL=PLANE/0,0,1,0\nC1=CIRCLE/0,0,2\nMA=MATRIX/TRANSL,1,0,0\nD=.5\n\
    PA=PATERN/LINEAR,P1,P2,5\nPB=PATERN/PARLEL,PA,V2,3\n";

fn run(text: &str) -> Program {
    let tree = SyntaxTree::parse(&format!("{NAMES}{text}\nFINI\n"), Dialect::named(DialectName::Free));
    evaluate(&tree, &Options::default(), &|| false)
}

/// The numbers of what is found, with zero for findings without one.
fn numbers(program: &Program) -> Vec<u16> {
    let serious = program.findings().filter(|finding| finding.severity >= Severity::Warning);
    serious.map(|finding| finding.number.unwrap_or_default()).collect()
}

/// Compares a table of statements and numbers with what is found, and tells all differences at once.
fn check(cases: &[(&str, &[u16])]) {
    let mut wrong = String::new();
    for (text, expected) in cases {
        let found = numbers(&run(text));
        if found != *expected {
            wrong += &format!("{text:?}: {found:?}, expected {expected:?}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

const GOOD: &[u16] = &[];

#[test]
fn from_goto_godlta() {
    check(&[
        ("FROM/1,2", GOOD),
        ("FROM/1,2,3", GOOD),
        ("FROM/1,2,3,20", GOOD),
        ("FROM/P1", GOOD),
        ("FROM/P1,20", GOOD),
        ("GOTO/1,2,3,0,0,1", GOOD),
        ("GOTO/1,2,3,0,0,1,20", GOOD),
        ("GOTO/P1,V1", GOOD),
        ("GOTO/P1,V1,20", GOOD),
        ("GOTO/P1,0,0,1", GOOD),
        ("GOTO/P1,0,0,1,20", GOOD),
        ("GOTO/1,2,3,V1", GOOD),
        ("GOTO/(POINT/1,2)", GOOD),
        ("GOTO/(1+1),2,3", GOOD),
        ("GOTO/1,2,3,4,5", &[129]),
        ("GOTO/1", &[129]),
        ("GOTO/1,2,3,4,5,6,7,8", &[129]),
        ("GOTO/L1", &[129]),
        ("GODLTA/1", GOOD),
        ("GODLTA/1,20", GOOD),
        ("GODLTA/1,2,3", GOOD),
        ("GODLTA/1,2,3,20", GOOD),
        ("GODLTA/1,2,3,0,0,1", GOOD),
        ("GODLTA/1,2,3,0,0,1,20", GOOD),
        ("GODLTA/V1", GOOD),
        ("GODLTA/V1,20", GOOD),
        // A point counts as three numbers.
        ("GODLTA/P1", GOOD),
        ("GODLTA/1,2,3,4,5", &[129]),
        ("GOTO/1,2,3,0,0,0", &[3]),
    ]);
}

#[test]
fn patterns_in_goto() {
    check(&[
        ("GOTO/PA", GOOD),
        ("GOTO/PA,INVERS", GOOD),
        ("GOTO/PB,ZIGZAG", GOOD),
        ("GOTO/PA,CONST,OMIT,2", GOOD),
        ("GOTO/PA,OMIT,2,4", GOOD),
        ("GOTO/PA,OMIT,2,THRU,4", GOOD),
        ("GOTO/PA,RETAIN,1,THRU,3", GOOD),
        ("GOTO/PA,AVOID,2,3", GOOD),
        ("GOTO/PA,OMIT,2,AVOID,1,3", GOOD),
        ("GOTO/PA,INVERS,CONST,RETAIN,5,4", GOOD),
        ("GOTO/PA,OMIT,2,RETAIN,3", &[811]),
        ("GOTO/PA,OMIT,9", &[812]),
        ("GOTO/PA,OMIT,0", &[812]),
        ("GOTO/PA,3", &[830]),
        ("GOTO/PA,CLW", &[832]),
        ("GOTO/PA,OMIT,2,INVERS", &[833]),
        ("GOTO/PA,INVERS,INVERS", &[834]),
        ("GOTO/PA,ZIGZAG", &[835]),
        ("GOTO/PA,OMIT", &[836]),
        ("GOTO/PA,OMIT,3,1", &[838]),
    ]);
}

#[test]
fn directions() {
    check(&[
        ("INDIRV/V2", GOOD),
        ("INDIRV/1,0,0", GOOD),
        ("INDIRV/,,V2", GOOD),
        ("INDIRV/V2,,V1", GOOD),
        ("INDIRV/1,0,0,0,1,0,0,0,1", GOOD),
        ("INDIRP/P1", GOOD),
        ("INDIRP/1,2,3", GOOD),
        ("INDIRP/P1,P2,P3", GOOD),
        ("SRFVCT/V2", GOOD),
        ("SRFVCT/V2,V1", GOOD),
        // That a vector has no length is said by Section 2.
        ("INDIRV/0,0,0", GOOD),
        ("INDIRV/L1", &[129]),
        ("INDIRV/V1,V1,V1,V1", &[129]),
        ("INDIRP/L1", &[129]),
    ]);
}

#[test]
fn start_up_and_directed_motion() {
    check(&[
        ("GO/C1", GOOD),
        ("GO/TO,C1,ON,PL,PAST,L1", GOOD),
        ("GO/TO,C1,TO,PL,TANTO,L1", GOOD),
        ("GO/C1,PL,20", GOOD),
        ("GO/C1,PL,L1,L2", &[129]),
        ("OFFSET/C1", GOOD),
        ("OFFSET/ON,C1,TO,PL", GOOD),
        ("OFFSET/C1,PL,L1", &[129]),
        ("PSIS/PL", GOOD),
        ("PSIS/P1", &[576]),
        ("PSIS/3", &[1000]),
        ("AUTOPS", GOOD),
        ("NOPS", GOOD),
        ("GOLFT/L1,L2", GOOD),
        ("TLLFT,GOLFT/L1,TO,L2", GOOD),
        ("TLLFT,TLOFPS,GOLFT/L1,TO,L2", GOOD),
        ("GORGT/L1,ON,2,INTOF,C1", GOOD),
        ("GORGT/L1,ON,2,INTOF,C1,20", GOOD),
        ("GOLFT/L1,TANTO,C1", GOOD),
        ("GOLFT/L1,PSTAN,C1", GOOD),
        ("GOLFT/L1,DSTAN,C1", GOOD),
        ("GOLFT/L1,TO,L2,A1,PAST,C1,B1\nA1)GOTO/1,1,1\nB1)GOTO/2,2,2", GOOD),
        ("GOLFT/L1\nGOLFT/L2,TO,L1", GOOD),
        ("GOLFT/L1\nSPINDL/OFF\nGOFWD/C1,TO,L2", GOOD),
        ("GOLFT/TO,L1,TO,L2", &[135]),
        ("GOUP/L1", &[136]),
        ("GODOWN/L1", &[136]),
        ("GOLFT/L1\nGOTO/1,1,1", &[137]),
        ("GOLFT/L1\nGO/L2", &[137]),
        ("GOLFT/L1\nFROM/1,1,1", &[137]),
        ("GOLFT/L1\nGODLTA/1,1,1", &[137]),
        ("GOLFT/L1", &[650]),
        ("GOLFT/P1,TO,L1", &[133]),
        ("TRANTO/A1\nA1)GOTO/1,1,1", GOOD),
        ("TRANTO/A1\nA1)D=2\nFROM/1,1,1", &[456]),
    ]);
}

#[test]
fn cutter_and_tolerances() {
    check(&[
        ("CUTTER/1", GOOD),
        ("CUTTER/0", GOOD),
        ("CUTTER/1,.25", GOOD),
        ("CUTTER/1,.25,.25,.25,0,0,2", GOOD),
        ("CUTTER/OPTION,1,2,3", GOOD),
        ("CUTTER/OPTION,2,2,-3", GOOD),
        ("CUTTER/OPTION,1,-2,3", &[129]),
        ("CUTTER/OPTION,2,OFF", GOOD),
        ("CUTTER/1,2,3", &[129]),
        ("CUTTER/P1", &[129]),
        ("CUTTER/OPTION,3,OFF", &[129]),
        ("CUTTER/OPTION,1", &[129]),
        ("CUTTER/OPTION,1,2", &[129]),
        ("INTOL/.1", GOOD),
        ("OUTTOL/.1,.2,.3,.4", GOOD),
        ("TOLER/.1,.2", GOOD),
        ("THICK/.1,-.1", GOOD),
        ("INTOL/1,2,3,4,5", &[129]),
        ("THICK/P1", &[129]),
        ("MAXDP/.5", GOOD),
        ("NUMPTS/500", GOOD),
        ("MAXDP/1,2", &[129]),
        ("GOUGCK/ON", GOOD),
        ("GOUGCK/OFF", GOOD),
        ("GOUGCK/3", &[132]),
        ("CUT", GOOD),
        ("DNTCUT", GOOD),
        ("DNTCUT/PRINT", GOOD),
        ("CUT/1", &[505]),
        // Told to be without effect.
        ("DMILL/DSTAN", &[0]),
        ("DMILL/PSTAN", &[0]),
        ("DMILL/NOMORE", &[0]),
        ("DMILL/ON", &[133]),
        ("DMILL/1", &[132]),
        ("DMILL/DSTAN,PSTAN", &[132]),
        ("BEVELS/ON", &[0]),
        ("BEVELS/OFF", &[0]),
        ("BEVELS/DSTAN", &[133]),
        ("BEVELS/ON,OFF", &[132]),
        ("2DCALC", GOOD),
        ("3DCALC", GOOD),
        ("NDTEST", GOOD),
        ("NDTEST/1", &[505]),
    ]);
}

#[test]
fn tool_axes() {
    check(&[
        ("TLAXIS/V1", GOOD),
        ("TLAXIS/0,0,1", GOOD),
        ("TLAXIS/1", GOOD),
        ("TLAXIS/NORMPS", GOOD),
        ("TLAXIS/NORMDS", GOOD),
        ("TLAXIS/PARLEL,1", GOOD),
        ("TLAXIS/PARLEL,2", GOOD),
        ("TLAXIS/ATANGL,1,10", GOOD),
        ("TLAXIS/ATANGL,2,-10,V2", GOOD),
        ("TLAXIS/ATANGL,1,10,1,0,0", GOOD),
        ("TLAXIS/ATANGL,1,10,CUTANG,5", GOOD),
        ("TLAXIS/0,0,0", &[3]),
        ("TLAXIS/PARLEL,3", &[4]),
        ("TLAXIS/ATANGL,3,5", &[4]),
        ("TLAXIS/ATANGL,1,91", &[16]),
        ("TLAXIS/ATANGL,1,5,CUTANG,-91", &[17]),
        ("TLAXIS/P1", &[129]),
        ("TLAXIS/CLW", &[133]),
        ("MULTAX", GOOD),
        ("MULTAX/ON", GOOD),
        ("MULTAX/OFF", GOOD),
        ("MULTAX/3", &[132]),
    ]);
}

#[test]
fn pockets() {
    let head = |keep: &str, kind: &str| format!("POCKET/.4,1,.8,5,5,5,{keep},{kind},");
    for (text, expected) in [
        (format!("{}P1,P2,P3", head("0", "0")), GOOD),
        (format!("{}0,0,0,1,0,0,1,1,0", head("1", "1")), GOOD),
        (format!("{}P1,5,2,3,P3", head("0", "2")), GOOD),
        (format!("{}P1,P2,P3", head("0", "3")), GOOD),
        (format!("{}P1,P2", head("0", "0")), &[377]),
        (format!("{}P1,P2,1,2", head("0", "0")), &[377]),
        (format!("{}L1,P2,P3", head("0", "0")), &[377]),
        (format!("{}P1,P2,P3", head("2", "0")), &[3515]),
        (format!("{}P1,P2,P3", head("0", "4")), &[3516]),
        (format!("{}{}", head("0", "0"), vec!["P1"; 21].join(",")), &[377]),
        ("POCKET/1,2,3".to_owned(), &[377]),
        ("POCKET/1,2,P1,4,5,6,7,8,P1,P2,P3".to_owned(), &[376]),
    ] {
        assert_eq!(numbers(&run(&text)), expected, "{text}");
    }
}

#[test]
fn transformations() {
    check(&[
        ("TRACUT/MA", GOOD),
        ("TRACUT/(MATRIX/XYROT,30)", GOOD),
        ("TRACUT/NOMORE", GOOD),
        ("TRACUT/4", &[506]),
        ("TRACUT/MA,MA", &[506]),
        ("TRACUT/CLW", &[506]),
        ("TRACUT/L1", &[506]),
        ("INDEX/1", GOOD),
        ("INDEX/1,NOMORE", GOOD),
        ("INDEX/1,ON", &[503]),
        ("INDEX/P1", &[503]),
        ("COPY/1,SAME,2", GOOD),
        ("COPY/1,TRANSL,1,2,3,2", GOOD),
        ("COPY/1,XYROT,30,2", GOOD),
        ("COPY/1,MODIFY,MA,2", GOOD),
        ("COPY/1,MODIFY,(MATRIX/MIRROR,YZPLAN),1", GOOD),
        ("COPY/1,SAME,0", GOOD),
        ("COPY/1,SAME", &[507]),
        ("COPY/1", &[507]),
        ("COPY/1,TRANSL,1,0,0", &[507]),
        ("COPY/1,XYROT,30,2,2", &[507]),
        ("COPY/1,SCALE,2,2", &[503]),
        ("COPY/1,3,2", &[503]),
        ("COPY/1,MODIFY,L1,2", &[503]),
        ("COPY/1,TRANSL,1,P1,3,2", &[503]),
        ("COPY/P1,SAME,2", &[503]),
        ("COPY/1,SAME,P1", &[503]),
        ("COPY/1,SAME,-2", &[9]),
        ("COPY/1,MIRROR,YZPLAN,1", &[10]),
        ("VTLAXS/ON,LEFT,10,1,0,RIGHT,ZSMALL", GOOD),
        ("VTLAXS/OFF,LEFT,10", GOOD),
        ("WCORN/LEFT,10,LEFT,5,1,8", GOOD),
        ("VTLAXS/ON,P1", &[501]),
    ]);
}

#[test]
fn copies_carry_what_they_say() {
    let step = |text: &str| {
        let program = run(text);
        let found = program.records().find_map(|record| match &record.kind {
            RecordKind::Copy { number, step, count } => Some((*number, *step, *count)),
            _ => None,
        });
        found.unwrap_or_else(|| panic!("{text} leaves no COPY"))
    };
    assert_eq!(step("COPY/7,SAME,3"), (7, CopyStep::Same, 3));
    assert_eq!(step("COPY/1,XYROT,90,2"), (1, CopyStep::RotationAboutZ(90.0), 2));
    let shift = apt_geometry::Vec3::new(1.0, 2.0, 3.0);
    assert_eq!(step("COPY/1,TRANSL,1,2,3,1"), (1, CopyStep::Translation(shift), 1));
    let (_, CopyStep::Matrix(mirror), 1) = step("COPY/1,MODIFY,(MATRIX/MIRROR,YZPLAN),1") else {
        panic!("a matrix")
    };
    assert_eq!(mirror.apply_point(&[4.0, 5.0, 6.0].into()), apt_geometry::Vec3::new(-4.0, 5.0, 6.0));
}
