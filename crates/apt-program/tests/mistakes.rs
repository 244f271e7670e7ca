//! Mistakes and the findings they give: statement number and APT III number (language reference 9.5).

mod support;

use apt_program::{ControlFinding, Finding, FindingKind, Options, Program, RecordKind, Severity, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree};
use support::{problems, run_whole};

fn run(text: &str) -> Program {
    run_whole(text, DialectName::Free)
}

/// Name, program without FINI, and the problems as (statement, APT III number).
type Case = (&'static str, &'static str, &'static [(u32, u16)]);

const CASES: &[Case] = &[
    ("undefined name", "A=ZZZ", &[(1, 101)]),
    ("three undefined names", "P=POINT/UU,VV,WW", &[(1, 101), (1, 101), (1, 101)]),
    ("poisoned name is silent", "P=POINT/UU,0\nL=LINE/P,P\nL2=LINE/L,L", &[(1, 101)]),
    ("poisoned scalar is silent", "A=4/0\nB=A+1\nGOTO/B,0,0", &[(1, 63)]),
    ("label as scalar", "XX)A=1\nB=XX+1", &[(2, 251)]),
    ("label is a name", "A=1\nA)B=2", &[(2, 3)]),
    ("label twice", "A)B=1\nA)B=2", &[(2, 6)]),
    ("point as scalar", "P=POINT/1,2\nA=P+1", &[(2, 83)]),
    ("surface copy", "P1=POINT/1,2\nP2=P1", &[(2, 83)]),
    ("redefined surface", "P=POINT/1,2\nP=POINT/3,4", &[(2, 1002)]),
    ("scalar to surface", "P=3\nP=POINT/3,4", &[(2, 1002)]),
    ("surface to scalar", "P=POINT/3,4\nP=3", &[(2, 108)]),
    ("other type under CANON", "P=POINT/3,4\nCANON/ON\nP=LINE/0,0,1,1", &[(3, 1006)]),
    ("redefinition allowed", "P=POINT/3,4\nCANON/ON\nP=POINT/0,0", &[]),
    ("redefinition by CANON", "P=POINT/3,4\nP=POINT/CANON,1,2,3", &[]),
    ("subscript range", "RESERV/A,3\nA(4)=1", &[(2, 104)]),
    ("subscript zero", "RESERV/A,3\nA(0)=1", &[(2, 104)]),
    ("subscript missing", "RESERV/A,3\nA=1", &[(2, 105)]),
    ("not reserved", "A(1)=3", &[(1, 108)]),
    ("unknown function", "A=NOSUCHF(3)", &[(1, 108)]),
    ("missing comma in a long name", "P=POINT/RADIUS SIZE", &[(1, 1)]),
    ("missing comma in a short name", "P=POINT/A B", &[(1, 101)]),
    ("DO without the end of its loop", "DO/A,I=1,3", &[(1, 406)]),
    ("mixed array", "RESERV/A,3\nA(1)=1\nA(2)=POINT/1,2", &[(3, 106)]),
    ("mixed order of RESERV", "RESERV/A,3,4,B", &[(1, 255)]),
    ("RESERV of a used name", "A=1\nRESERV/A,3", &[(2, 256)]),
    ("RESERV in a macro", "M=MACRO\nRESERV/A,3\nTERMAC\nCALL/M", &[(2, 252)]),
    ("RESERV in a loop", "LOOPST\nRESERV/A,3\nLOOPND", &[(2, 252)]),
    ("operand of LOOPST", "LOOPST/3\nA=1\nLOOPND", &[(1, 505)]),
    ("operand of LOOPND", "LOOPST\nA=1\nLOOPND/3", &[(3, 505)]),
    ("operand of TERMAC", "M=MACRO\nA=1\nTERMAC/3\nCALL/M", &[(3, 505)]),
    ("no such format", "P=POINT/1", &[(1, 1000)]),
    ("degenerate geometry", "L=LINE/1,2,1,2", &[(1, 1005)]),
    ("CANON count", "P=POINT/CANON,1,2", &[(1, 84)]),
    ("OBTAIN other type", "C=CIRCLE/0,0,1\nOBTAIN,LINE/C,X", &[(2, 153)]),
    ("OBTAIN too many", "P=POINT/0,0,1\nOBTAIN,POINT/P,X,Y,Z,W", &[(2, 154)]),
    ("OBTAIN into geometry", "P=POINT/0,0,1\nOBTAIN,POINT/P,P", &[(2, 1002)]),
    ("scalar to PSIS", "PSIS/3", &[(1, 1000)]),
    ("point to PSIS", "PSIS/(POINT/1,2)", &[(1, 576)]),
    ("point to REFSYS", "P=POINT/1,2\nREFSYS/P", &[(2, 651)]),
    ("unnamed matrix to REFSYS", "REFSYS/(MATRIX/SCALE,2)", &[(1, 651)]),
    ("TRACUT of a scalar", "TRACUT/4", &[(1, 506)]),
    ("point in a post statement", "P=POINT/1,2\nSPINDL/P", &[(2, 501)]),
    ("line for CLEARP", "L=LINE/XAXIS\nCLEARP/L", &[(2, 502)]),
    ("undefined in a post statement", "SPINDL/N", &[(1, 101)]),
    ("number for MACHIN", "MACHIN/1,2", &[(1, 503)]),
    ("SYN with one operand", "SYN/A", &[(1, 351)]),
    ("SYN in a macro", "M=MACRO\nSYN/GL,GOLFT\nTERMAC\nCALL/M", &[(2, 353)]),
    ("COPY count", "COPY/1,TRANSL,1,0,0", &[(1, 507)]),
    ("COPY option", "COPY/1,SCALE,2,2", &[(1, 503)]),
    ("implied check before GOTO", "L=LINE/XAXIS\nGOLFT/L\nGOTO/1,1,1", &[(3, 137)]),
    ("implied check before FINI", "L=LINE/XAXIS\nGOLFT/L", &[(3, 650)]),
    ("implied check of GOUP", "L=LINE/XAXIS\nGOUP/L", &[(2, 136)]),
    ("modifier on drive", "L=LINE/XAXIS\nGOLFT/TO,L,TO,L", &[(2, 135)]),
    ("GO with four surfaces", "L=LINE/XAXIS\nGO/L,L,L,L", &[(2, 129)]),
    ("OFFSET with three surfaces", "L=LINE/XAXIS\nOFFSET/L,L,L", &[(2, 129)]),
    ("five numbers", "GOTO/1,2,3,4,5", &[(1, 129)]),
    ("three cutter numbers", "CUTTER/1,2,3", &[(1, 129)]),
    ("five tolerances", "INTOL/1,2,3,4,5", &[(1, 129)]),
    ("pattern number", "P=PATERN/LINEAR,(1,1),(2,2),5\nGOTO/P,OMIT,9", &[(2, 812)]),
    ("OMIT and RETAIN", "P=PATERN/LINEAR,(1,1),(2,2),5\nGOTO/P,OMIT,1,RETAIN,2", &[(2, 811)]),
    ("OMIT without number", "P=PATERN/LINEAR,(1,1),(2,2),5\nGOTO/P,OMIT", &[(2, 836)]),
    ("OMIT not ascending", "P=PATERN/LINEAR,(1,1),(2,2),5\nGOTO/P,OMIT,3,1", &[(2, 838)]),
    ("unknown pattern word", "P=PATERN/LINEAR,(1,1),(2,2),5\nGOTO/P,LEFT", &[(2, 832)]),
    ("number after pattern", "P=PATERN/LINEAR,(1,1),(2,2),5\nGOTO/P,2", &[(2, 830)]),
    ("INVERS twice", "P=PATERN/LINEAR,(1,1),(2,2),5\nGOTO/P,INVERS,INVERS", &[(2, 834)]),
    ("INVERS too late", "P=PATERN/LINEAR,(1,1),(2,2),5\nGOTO/P,OMIT,1,INVERS", &[(2, 833)]),
    ("ZIGZAG of a row", "P=PATERN/LINEAR,(1,1),(2,2),5\nGOTO/P,ZIGZAG", &[(2, 835)]),
    ("JUMPTO outside", "A)B=1\nJUMPTO/A", &[(2, 407)]),
    ("IF outside", "A)B=1\nIF(B)A,A,A", &[(2, 407)]),
    ("foreign label", "A)B=1\nLOOPST\nJUMPTO/A\nLOOPND", &[(3, 406)]),
    ("LOOPND alone", "LOOPND", &[(1, 208)]),
    ("nested loop", "LOOPST\nLOOPST\nLOOPND\nLOOPND", &[(2, 206), (4, 208)]),
    ("loop in macro", "M=MACRO\nLOOPST\nTERMAC\nCALL/M", &[(2, 210)]),
    ("TERMAC alone", "TERMAC", &[(1, 209)]),
    ("loop in a macro that is never called", "M=MACRO\nLOOPST\nB=1\nLOOPND\nTERMAC", &[(2, 210), (4, 210)]),
    ("array in a macro that is never called", "M=MACRO\nRESERV/A,3\nTERMAC", &[(2, 252)]),
    ("synonym in a macro that is never called", "M=MACRO\nSYN/GL,GOLFT\nTERMAC", &[(2, 353)]),
    ("segment in a macro that is never called", "M=MACRO\nREAD/2,SEG\nTERMAC", &[(2, 37)]),
    ("undefined label in a macro that is never called", "M=MACRO\nJUMPTO/A\nTERMAC", &[(2, 406)]),
    ("IF to an undefined label, never called", "M=MACRO\nA)IF(1)A,B,A\nTERMAC", &[(2, 406)]),
    ("macro not closed", "M=MACRO\nA=1", &[(3, 16)]),
    ("loop not closed", "LOOPST\nA=1", &[(3, 16)]),
    ("macro in macro", "M=MACRO\nN=MACRO\nTERMAC\nTERMAC", &[(2, 201), (4, 209)]),
    ("macro in loop", "LOOPST\nN=MACRO\nTERMAC\nLOOPND", &[(2, 201), (3, 209)]),
    ("macro name used", "M=1\nM=MACRO\nTERMAC", &[(2, 202)]),
    ("unknown macro", "CALL/NOSUCH", &[(1, 233)]),
    ("unknown macro variable", "M=MACRO/A\nTERMAC\nCALL/M,A=1,B=2", &[(3, 228)]),
    ("macro variable without value", "M=MACRO/A\nTERMAC\nCALL/M", &[(3, 230)]),
    ("inclusive subscript after CANON", "RESERV/A,3\nP=POINT/CANON,A(ALL)", &[(2, 103)]),
    ("inclusive subscript in a function", "RESERV/A,3\nB=ABSF(A(ALL))", &[(2, 103)]),
    ("inclusive subscript of a tolerance", "RESERV/A,3\nINTOL/A(ALL)", &[(2, 103)]),
    ("step of an inclusive subscript", "RESERV/A,3\nA(1)=1\nP=POINT/A(ALL,INCR,0)", &[(3, 109)]),
    ("two types in DOTF", "V=VECTOR/1,0,0\nP=POINT/1,2\nA=DOTF(V,P)", &[(3, 80)]),
    ("line and plane in DISTF", "L=LINE/XAXIS\nP=PLANE/1,0,0,1\nA=DISTF(L,P)", &[(3, 80)]),
    ("number in LNTHF", "A=LNTHF(3)", &[(1, 66)]),
    ("geometry in an IF", "P=POINT/1,2\nLOOPST\nIF(P)A,A,A\nA)LOOPND", &[(3, 402)]),
    ("segment not found", "READ/2,SEG", &[(1, 31)]),
    ("two segments", "READ/2,SEG,TWO", &[(1, 34)]),
    ("segment in a loop", "LOOPST\nREAD/2,SEG\nLOOPND", &[(2, 37)]),
    ("library without the macro", "LIBRY/NIX", &[(1, 31)]),
    ("macro as value", "M=MACRO\nTERMAC\nA=M+1", &[(3, 211)]),
    ("macro assigned", "M=MACRO\nTERMAC\nM=1", &[(3, 211)]),
    ("label assigned", "M)A=1\nM=1", &[(2, 251)]),
    ("subscripted label", "M)A=1\nB=M(1)", &[(2, 108)]),
    ("extent of RESERV", "RESERV/A,0", &[(1, 255)]),
    ("half a pair of RESERV", "RESERV/A", &[(1, 255)]),
    ("OBTAIN of a large surface", "P=PATERN/LINEAR,(1,1),(2,2),5\nOBTAIN,PATERN/P,A", &[(2, 157)]),
    ("OBTAIN of a number", "A=1\nOBTAIN,POINT/A,X", &[(2, 152)]),
    ("unnamed nested pattern", "GOTO/(PATERN/LINEAR,(1,1),(2,2),5)", &[(1, 820)]),
    ("pattern of one point", "P=PATERN/LINEAR,(1,1)", &[(1, 800)]),
    ("ruled surface of one curve", "P=RLDSRF/(PLANE/0,0,1,0),(0,0),(4,0),(2,1)", &[(1, 1002)]),
    ("two words of SYN", "SYN/GOLFT,GORGT", &[(1, 355)]),
    ("a number in SYN", "SYN/3,POINT", &[(1, 19)]),
    ("a number for the word of SYN", "SYN/A,3", &[(1, 19)]),
    ("two names in SYN", "SYN/A,B", &[(1, 356)]),
    ("SYN of itself", "SYN/A,SYN", &[(1, 356)]),
    ("SYN of a used name", "A=1\nSYN/A,POINT", &[(2, 355)]),
    ("the first pair of SYN fixes the order", "SYN/GL,GOLFT,GORGT,GR", &[(1, 355)]),
    ("the other order of SYN", "SYN/GOLFT,GL,GR,GORGT", &[(1, 355)]),
    ("pairs behind a wrong one", "SYN/A,B,P,POINT\nQ=P/1,2", &[(1, 356)]),
    ("a synonym as a name", "SYN/P,POINT\nP=3", &[(2, 155)]),
    ("a synonym as a macro variable", "SYN/P,POINT\nM=MACRO/P\nTERMAC", &[(2, 207)]),
    // The text of a macro whose header has a mistake is no part of the program, and calls of it are quiet.
    (
        "a number as a macro variable",
        "M=MACRO/A,3\nB=A+1\nL1)GOTO/A,B,0\nTERMAC\nCALL/M,A=1\nC=4",
        &[(1, 207)],
    ),
    ("an expression as a normal value", "M=MACRO/A=3+4\nB=A\nTERMAC\nCALL/M,A=2", &[(1, 235)]),
    (
        "an open parenthesis in a header",
        "M=MACRO/A=(3\nB=A\nTERMAC\nCALL/M,A=2\nJUMPTO/L",
        &[(1, 10), (5, 407)],
    ),
    ("a comma at the end of a header", "M=MACRO/A,\nB=A\nTERMAC\nCALL/M,A=2", &[(1, 11)]),
    ("expression as a label", "L=LINE/XAXIS\nGOLFT/L,TO,L,(3+4),TO,L,8", &[(2, 453)]),
    ("scalar as the first label", "X=7\nL=LINE/XAXIS\nGOLFT/L,TO,L,X,TO,L,8", &[(3, 453)]),
    ("scalar as the second label", "X=7\nL=LINE/XAXIS\nGOLFT/L,TO,L,8,TO,L,X\n8)STOP", &[(3, 453)]),
    ("TLAXIS without length", "TLAXIS/0,0,0", &[(1, 3)]),
    ("TLAXIS/NORMPS across nothing", "TLAXIS/NORMPS,0,0,0", &[(1, 3)]),
    ("TLAXIS/ATANGL across nothing", "TLAXIS/ATANGL,1,5,0,0,0", &[(1, 19)]),
    ("check surfaces without labels", "L=LINE/XAXIS\nGOLFT/L,TO,L,TO,L", &[(2, 132)]),
    ("label of a statement without motion", "TRANTO/A\nA)B=1", &[(1, 456)]),
    ("label of a CONTIN", "TRANTO/A\nA)CONTIN", &[(1, 456)]),
    ("label of a LOOPND", "LOOPST\nTRANTO/A\nA)LOOPND", &[(2, 456)]),
    ("label of a CONTIN in a loop", "LOOPST\nTRANTO/A\nA)CONTIN\nLOOPND", &[(2, 456)]),
    ("label of a TERMAC", "M=MACRO\nTRANTO/A\nA)TERMAC\nCALL/M", &[(2, 456)]),
    ("PTONLY", "PTONLY/7", &[(1, 553)]),
    ("DEBUG", "DEBUG/7", &[(1, 22)]),
    ("second PSIS operand", "P=PLANE/0,0,1,0\nPSIS/P,P", &[(2, 576)]),
    ("macro value expression", "M=MACRO/A\nB=A\nTERMAC\nCALL/M,A=3+4", &[(4, 235)]),
    ("assignment to a number", "M=MACRO/A\nA=9\nTERMAC\nCALL/M,A=4", &[(2, 5)]),
    ("recursion", "M=MACRO\nCALL/M\nTERMAC\nCALL/M", &[(2, 231)]),
    ("error in a macro stands at the body", "M=MACRO/A\nB=1/A\nTERMAC\nCALL/M,A=0", &[(2, 63)]),
    ("SQRTF negative", "A=SQRTF(-4)\nB=A+1", &[(1, 67)]),
    ("fractional power of negative", "A=(-8)**.5", &[(1, 68)]),
    ("LOGF of zero", "A=LOGF(0)", &[(1, 66)]),
    ("DISTF not parallel", "A=LINE/0,0,1,1\nB=LINE/0,0,1,2\nD=DISTF(A,B)", &[(3, 66)]),
    ("SINF of two", "A=SINF(1,2)", &[(1, 65)]),
    ("ATAN2F of one", "A=ATAN2F(1)", &[(1, 65)]),
    ("ANGLF of one", "C=CIRCLE/0,0,1\nA=ANGLF(C)", &[(2, 65)]),
    ("DOTF of one", "V=VECTOR/1,0,0\nA=DOTF(V)", &[(2, 66)]),
    ("scalar to ZSURF", "Z=4\nZSURF/Z", &[(2, 1000)]),
    ("circle to ZSURF", "C=CIRCLE/0,0,1\nZSURF/C", &[(2, 26)]),
    ("vertical ZSURF", "ZSURF/1,0,0,1", &[(1, 1005)]),
    ("POCKET without a slash", "POCKET", &[(1, 376)]),
    ("POCKET without points", "POCKET/1,2,3", &[(1, 377)]),
    ("POCKET with a point for a number", "P=POINT/1,2\nPOCKET/P,1,2", &[(2, 376)]),
    ("a name before a list", "A=1\nPOINT 1,2", &[(2, 7)]),
    ("POCKET points", "POCKET/.4,1,.8,5,5,5,1,1,0,0,0,1,1,1", &[(1, 377)]),
    ("unknown transfer label", "TRANTO/NIX", &[(1, 406)]),
    ("PRINT number", "PRINT/7", &[(1, 326)]),
];

/// Where cards differ from free form.
const CARDS: &[Case] = &[
    ("unknown function", "A=INTF(3)", &[(1, 108)]),
    ("function of two", "A=MAXF(1,2)", &[(1, 108)]),
    ("long name", "LONGNAME=3", &[(1, 1)]),
];

#[test]
fn each_mistake_is_reported_at_its_statement_with_its_number() {
    let free = CASES.iter().map(|case| (case, DialectName::Free));
    let cards = CARDS.iter().map(|case| (case, DialectName::Apt3));
    let mut wrong = String::new();
    for ((name, text, expected), dialect) in free.chain(cards) {
        let program = run_whole(&format!("{text}\nFINI\n"), dialect);
        let found = problems(&program);
        let expected: Vec<(u32, Option<u16>)> =
            expected.iter().map(|(isn, number)| (*isn, Some(*number))).collect();
        if found != expected {
            let kinds: Vec<String> =
                program.findings().map(|finding| format!("{:?}", finding.kind)).collect();
            wrong.push_str(&format!("{name}: expected {expected:?}, found {found:?} {kinds:?}\n"));
        }
        assert!(program.is_complete());
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// The statements with a finding of a kind.
fn places(program: &Program, wanted: fn(&FindingKind) -> bool) -> Vec<u32> {
    program.findings().filter(|finding| wanted(&finding.kind)).map(|finding| finding.origin.isn).collect()
}

#[test]
fn definitions_that_are_hardly_meant_are_warned_of() {
    let doubts = |text: &str| -> Vec<String> {
        let program = run(&format!("{text}\nFINI\n"));
        let warnings = program.findings().filter(|finding| finding.severity == Severity::Warning);
        let told = warnings.map(|finding| match &finding.kind {
            FindingKind::Doubtful { statement, value } => {
                format!("{}:{statement} {value}", finding.origin.isn)
            }
            FindingKind::NotNormalised { kind, length, normalised } => {
                format!("{}:{kind:?} {length} {normalised:?}", finding.origin.isn)
            }
            other => format!("{other:?}"),
        });
        told.collect()
    };
    for (text, expected) in [
        ("P=PATERN/LINEAR,(0,0),(1,1),0", "1:PATERN 0"),
        ("P=PATERN/LINEAR,(0,0),(VECTOR/1,1,0),.5", "1:PATERN 0"),
        ("P=PATERN/ARC,(CIRCLE/0,0,1),0,90,CLW,0", "1:PATERN 0"),
        ("A=PATERN/LINEAR,(0,0),(1,1),2\nP=PATERN/PARLEL,A,(VECTOR/1,0,0),0", "2:PATERN 0"),
        ("C=CIRCLE/CANON,0,0,0,0,0,1,-2", "1:CIRCLE -2"),
        ("S=SPHERE/CANON,0,0,0,-2", "1:SPHERE -2"),
        ("L=LINE/CANON,3,4,0,5", "1:Line 5 [0.6, 0.8, 0.0, 1.0]"),
        ("L=PLANE/CANON,0,0,-2,4", "1:Plane 2 [0.0, 0.0, -1.0, 2.0]"),
        ("L=PLANE/CANON,0,0,0,4", "1:Plane 0 []"),
        ("C=CIRCLE/CANON,1,2,3,0,0,4,5", "1:Circle 4 [1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 5.0]"),
        ("C=CYLNDR/CANON,1,2,3,0,3,4,5", "1:Cylinder 5 [1.0, 2.0, 3.0, 0.0, 0.6, 0.8, 5.0]"),
        ("C=CONE/CANON,1,2,3,2,0,0,.5", "1:Cone 2 [1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.5]"),
    ] {
        assert_eq!(doubts(text), [expected], "{text}");
    }
    for text in [
        "P=PATERN/LINEAR,(0,0),(1,1),1",
        "P=PATERN/LINEAR,(0,0),(VECTOR/1,1,0),INCR,0,AT,2",
        "L=LINE/CANON,.707107,.707107,0,5",
        "L=LINE/CANON,.8660,.5000,0,5",
        "V=VECTOR/CANON,3,4,5",
        "L=LINE/CANON,0,1,0,5\nM=LINE/L,CANON,3,4",
    ] {
        assert_eq!(doubts(text), [""; 0], "{text}");
    }
}

#[test]
fn statements_that_are_never_reached_are_found() {
    let unreachable = |text: &str| places(&run(text), |kind| matches!(kind, FindingKind::Unreachable));
    assert_eq!(unreachable("LOOPST\nA)B=1\nJUMPTO/C\n\nD=2\nE=3\nC)LOOPND\nFINI\n"), [5]);
    assert_eq!(unreachable("M=MACRO\nIF(1)A,B,B\nC=1\nA)C=2\nB)TERMAC\nFINI\n"), [3]);
    assert_eq!(unreachable("LOOPST\nA)B=1\nJUMPTO/C\nC)D=1\nIF(D)E,E,E\nE)LOOPND\nFINI\n"), []);
    assert_eq!(unreachable("LOOPST\nA)B=1\nJUMPTO/B\nREMARK\nB)C=1\nIF(0)B,D,D\nD)LOOPND\nFINI\n"), []);
}

#[test]
fn statements_after_fini_are_a_hint() {
    let after = |text: &str| places(&run(text), |kind| matches!(kind, FindingKind::AfterEnd));
    assert_eq!(after("A=1\nFINI\n\n$$ the end\nB=2\nC=3\n"), [5]);
    assert_eq!(after("A=1\nFINI\n\n$$ the end\n"), []);
}

#[test]
fn names_that_nobody_reads_are_told_only_of_programs_that_move() {
    let unused = |text: &str| {
        let program = run(text);
        let name = |finding: &Finding| match &finding.kind {
            FindingKind::Unused { name } => Some(name.to_string()),
            _ => None,
        };
        program.findings().filter_map(name).collect::<Vec<_>>()
    };
    assert_eq!(unused("A=1\nP=POINT/1,2\nFINI\n"), [""; 0]);
    assert_eq!(unused("A=1\nP=POINT/1,2\nFROM/0,0\nFINI\n"), ["A", "P"]);
    assert_eq!(unused("A=1\nP=POINT/1,2\nFROM/P\nPRINT/3,A\nFINI\n"), [""; 0]);
    assert_eq!(
        unused("PS=PLANE/0,0,1,0\nQ=PLANE/0,0,1,1\nFROM/0,0\nFINI\n"),
        ["Q"],
        "PS is the implied part surface"
    );
    assert_eq!(unused("A=1\nB=2\nFROM/0,0\nPRINT/3,ALL\nFINI\n"), [""; 0]);
    assert_eq!(unused("A=1\nB=2\nFROM/0,0\nPUNCH/2,A,B\nFINI\n"), [""; 0]);
    assert_eq!(unused("M=MACRO\nTERMAC\nA)FROM/0,0\nFINI\n"), [""; 0], "no values");
}

#[test]
fn longer_names_and_later_functions_are_taken_in_free_form() {
    let text = "RADIUS1=MAXF(1,2,MINF(7,3))\nRESERV/INTF,3\nINTF(2)=8\nB=INTF(2)\nC=MODF(7,4)+TANF(45)\n\
                D=ASINF(1)+ACOSF(1)\nE=SINHF(-0)\nFINI\n";
    let program = run(text);
    assert_eq!(problems(&program), []);
    let value = |name: &str| {
        let values = program.symbols();
        let found = values.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone());
        match found {
            Some(apt_program::Value::Scalar(value)) => value,
            other => panic!("{name} is {other:?}"),
        }
    };
    assert_eq!([value("RADIUS1"), value("B")], [3.0, 8.0]);
    assert!((value("C") - 4.0).abs() < 1e-12 && (value("D") - 90.0).abs() < 1e-12 && value("E") == 0.0);
}

/// Functions that later systems have (language reference 10.1 and 10.4), with their values.
const LATER_FUNCTIONS: &[(&str, f64)] = &[
    ("TANF(45)", 1.0),
    ("ATAN2F(1,-1)", 135.0),
    ("ATAN2F(-1,-1)", -135.0),
    ("LOG10F(1000)", 3.0),
    ("MAXF(1,7,3)", 7.0),
    ("MINF(4,-2)", -2.0),
    ("MODF(-7,4)", -3.0),
    ("INTF(-2.7)", -2.0),
    ("SIGNF(3,-2)", -3.0),
    ("ACOSF(.5)", 60.0),
    ("ASINF(-.5)", -30.0),
    ("ARCOSF(0)", 90.0),
    ("ARSINF(1)", 90.0),
    ("COTANF(45)", 1.0),
    ("SINB(0)", 0.0),
    ("COSHF(0)", 1.0),
    ("CANF(2,(POINT/4,5,6))", 5.0),
    ("SPATF((VECTOR/1,0,0),(VECTOR/0,1,0),(VECTOR/0,0,1))", 1.0),
];

#[test]
fn later_functions_have_their_values_in_free_form_and_are_arrays_on_cards() {
    for (call, expected) in LATER_FUNCTIONS {
        let program = run(&format!("X={call}\nFINI\n"));
        assert_eq!(problems(&program), [], "{call}");
        let values = program.symbols();
        let found = values.iter().find(|(name, _)| name == "X").map(|(_, value)| value.clone());
        match found {
            Some(apt_program::Value::Scalar(value)) => {
                assert!((value - expected).abs() < 1e-9, "{call}: {value}");
            }
            other => panic!("{call}: {other:?}"),
        }
        let in_apt_iii = ["TANF", "ATAN2F", "LOG10F"].iter().any(|name| call.starts_with(name));
        let cards = problems(&run_whole(&format!("X={call}\nFINI\n"), DialectName::Apt3));
        // APT III takes the nest in a subscript for a name without its slash.
        let number = if call.contains("VECTOR") { 155 } else { 108 };
        assert_eq!(cards, if in_apt_iii { vec![] } else { vec![(1, Some(number))] }, "{call}");
    }
}

/// Where motions are missing: `isn` of each gap.
fn gaps(text: &str) -> Vec<u32> {
    let program = run(text);
    let gaps = program.records().filter(|record| record.kind == RecordKind::Gap);
    gaps.map(|record| record.origin.isn).collect()
}

#[test]
fn a_gap_stands_where_a_motion_is_missing() {
    assert_eq!(gaps("FROM/0,0\nGOTO/NIX,1\nGOTO/1,1\nFINI\n"), [2]);
    assert_eq!(gaps("A=4/0\nGOTO/A,1\nFINI\n"), [2], "unknown values are silent, not forgotten");
    assert_eq!(gaps("GOTO/1,,2\nFINI\n"), [1], "syntax errors");
    assert_eq!(gaps("L=LINE/XAXIS\nGOLFT/L\nGOTO/1,1,1\nFINI\n"), [2], "no check surface");
    assert_eq!(gaps("CALL/NIX\nFINI\n"), [1]);
    assert_eq!(gaps("M=MACRO/A\nGOTO/A,1\nTERMAC\nCALL/M\nFINI\n"), [4]);
    assert_eq!(gaps("M=MACRO/A\nB=A\nTERMAC\nCALL/M\nFINI\n"), [], "a macro without motion");
    assert_eq!(gaps("LOOPST\nA)GOTO/1,1\nJUMPTO/A\nLOOPND\nFINI\n"), [2], "an endless loop");
    assert_eq!(gaps("A=NIX\nSPINDL/A\nGOTO/1,1\nFINI\n"), [], "nothing moves there");
}

#[test]
fn words_of_other_dialects_are_told_as_such() {
    for text in ["DO/A,I=1,3", "IF(1.EQ.1)THEN", "ELSE", "ELSEIF(1.EQ.1)THEN", "ENDIF"] {
        let program = run_whole(&format!("{text}\nFINI\n"), DialectName::Apt3);
        assert_eq!(problems(&program), [(1, Some(82))], "{text}");
    }
}

#[test]
fn a_missing_fini_is_a_warning() {
    let program = run("A=1\nB=A");
    assert_eq!(problems(&program), [(2, Some(23))]);
}

#[test]
fn an_endless_loop_ends_and_says_where_it_went() {
    let program = run("I=0\nLOOPST\nA)I=I+1\nJ=2\nJUMPTO/A\nLOOPND\nGOTO/1,2,3\nFINI\n");
    let found: Vec<&Finding> =
        program.findings().filter(|finding| finding.severity == Severity::Error).collect();
    let [endless] = found.as_slice() else { panic!("{found:?}") };
    let apt_program::FindingKind::Control(ControlFinding::Endless { changing, unchanged, statements }) =
        &endless.kind
    else {
        panic!("{endless:?}")
    };
    assert_eq!(changing.as_slice(), ["I"]);
    assert_eq!(unchanged.as_slice(), [""; 0], "no condition decides");
    assert_eq!(*statements, Options::default().statement_budget);
    let frame = endless.origin.frame.as_ref().expect("a loop turn");
    assert!(frame.turn > 1000 && frame.isn == 2);
    assert_eq!(program.record_count(), 2, "the program goes on after the loop");
}

/// Dialect, program, and the unknown labels as (statement, severity).
type LabelCase = (DialectName, &'static str, &'static [(u32, Severity)]);

#[test]
fn a_label_that_is_nowhere_is_a_warning_until_a_jump_leads_there() {
    let severity = |text: &str, dialect: DialectName| -> Vec<(u32, Severity)> {
        let program = run_whole(&format!("{text}\nFINI\n"), dialect);
        let unknown = program.findings().filter(|finding| {
            matches!(finding.kind, FindingKind::Control(ControlFinding::UnknownLabel { .. }))
        });
        unknown.map(|finding| (finding.origin.isn, finding.severity)).collect()
    };
    use DialectName::{Apt4, Free};
    let cases: &[LabelCase] = &[
        (Free, "LOOPST\nI=1\nIF(I)A,B,B\nB)LOOPND", &[(3, Severity::Warning)]),
        (Free, "LOOPST\nI=-1\nIF(I)A,B,B\nB)LOOPND", &[(3, Severity::Error)]),
        (Free, "M=MACRO/N\nIF(N)A,B,B\nB)TERMAC", &[(2, Severity::Warning)]),
        (Free, "M=MACRO/N\nIF(N)A,B,B\nB)TERMAC\nCALL/M,N=1", &[(2, Severity::Warning)]),
        (Free, "M=MACRO/N\nIF(N)A,B,B\nB)TERMAC\nCALL/M,N=1\nCALL/M,N=-1", &[(2, Severity::Error)]),
        (Free, "M=MACRO/N,L\nIF(N)L,B,B\nB)TERMAC\nCALL/M,N=1,L=B", &[]),
        (Free, "M=MACRO\nTRANTO/E\nTERMAC\nCALL/M\nE)GOTO/1,2,3", &[]),
        (Apt4, "M=MACRO/N\nIF(N.EQ.2)JUMPTO/A\nTERMAC\nCALL/M,N=1", &[(2, Severity::Warning)]),
    ];
    for (dialect, text, expected) in cases {
        assert_eq!(severity(text, *dialect), *expected, "{text}");
    }
}

/// Dialect, program, the names that changed and those that should have.
type EndlessCase = (DialectName, &'static str, &'static [&'static str], &'static [&'static str]);

#[test]
fn an_endless_loop_names_what_decides_and_does_not_change() {
    use DialectName::{Apt4, Free};
    let cases: &[EndlessCase] = &[
        (Free, "J=0\nLOOPST\nI=0\nA)I=I+1\nIF(J-5)A,A,B\nB)LOOPND", &["I"], &["J"]),
        (Free, "M=MACRO/N,X\nA)X=X\nIF(X-N)A,A,B\nB)TERMAC\nK=1\nCALL/M,N=4,X=K", &[], &["K"]),
        (Free, "J=0\nN=3\nLOOPST\nA)I=1\nIF(J*2-N)A,A,B\nB)LOOPND", &[], &["J", "N"]),
        (Apt4, "J=0\nI=0\nA)I=I+1\nIF(J.LT.5)JUMPTO/A", &["I"], &["J"]),
        (Apt4, "M=MACRO/N\nK=0\nA)IF(K.LT.N.AND.K.GE.0)JUMPTO/A\nTERMAC\nCALL/M,N=2", &[], &["K"]),
    ];
    for (dialect, text, changes, stays) in cases {
        let tree = SyntaxTree::parse(&format!("{text}\nFINI\n"), Dialect::named(*dialect));
        let options = Options { statement_budget: 5_000, ..Options::default() };
        let program = evaluate(&tree, &options, &|| false);
        let found = program.findings().find_map(|finding| match &finding.kind {
            FindingKind::Control(ControlFinding::Endless { changing, unchanged, statements }) => {
                Some((changing.clone(), unchanged.clone(), *statements))
            }
            _ => None,
        });
        let (changing, unchanged, statements) = found.expect(text);
        assert_eq!(changing.as_slice(), *changes, "{text}");
        assert_eq!(unchanged.as_slice(), *stays, "{text}");
        assert_eq!(statements, 5_000, "{text}");
    }
}

#[test]
fn a_finding_in_a_loop_in_a_macro_tells_the_way_there() {
    let text = "M=MACRO/N\nI=0\nA)I=I+1\nB=1/(I-2)\nIF(I-N)A,Z,Z\nZ)TERMAC\nCALL/M,N=3\nFINI\n";
    let program = run(text);
    let error = program.findings().find(|finding| finding.severity == Severity::Error).expect("an error");
    assert_eq!((error.origin.isn, error.kind.apt3()), (4, Some(63)));
    let frame = error.origin.frame.as_ref().expect("a frame");
    assert_eq!((frame.name.as_str(), frame.isn, frame.turn), ("M", 7, 2));
}

#[test]
fn similar_names_are_offered() {
    let program = run("RADIU1=2\nC=CIRCLE/0,0,RADIU2\nFINI\n");
    let kinds: Vec<_> = program.findings().map(|finding| finding.kind.clone()).collect();
    let expected =
        apt_program::FindingKind::Undefined { name: "RADIU2".into(), similar: vec!["RADIU1".into()] };
    assert!(kinds.contains(&expected), "{kinds:?}");
}

#[test]
fn a_word_that_a_statement_does_not_take_is_told_with_those_that_it_takes() {
    for (text, statement, name, similar) in [
        ("TLAXIS/FOO\nFINI\n", "TLAXIS", "FOO", ""),
        ("TLAXIS/NORMSP\nFINI\n", "TLAXIS", "NORMSP", "NORMPS"),
        ("UP1=VECTOR/0,0,1\nTLAXIS/UP2\nFINI\n", "TLAXIS", "UP2", "UP1"),
        ("GOUGCK/MAYBE\nFINI\n", "GOUGCK", "MAYBE", ""),
        ("MULTAX/YES\nFINI\n", "MULTAX", "YES", ""),
        ("DNTCUT/NOLIST\nFINI\n", "DNTCUT", "NOLIST", ""),
    ] {
        let program = run(text);
        let found: Vec<_> = program.findings().collect();
        let told = found.iter().find_map(|finding| match &finding.kind {
            apt_program::FindingKind::UndefinedOption { statement, name, similar } => {
                Some((statement.as_str(), name.as_str(), similar.first().map_or("", |word| word.as_str())))
            }
            _ => None,
        });
        assert_eq!(told, Some((statement, name, similar)), "{text}: {found:?}");
        assert!(found.iter().any(|finding| finding.number == Some(101)), "{text}: {found:?}");
    }
}

#[test]
fn cancelled_work_is_not_complete() {
    let tree = SyntaxTree::parse("A=1\nFINI\n", Dialect::named(DialectName::Free));
    let program = evaluate(&tree, &Options::default(), &|| true);
    assert!(!program.is_complete());
}

#[test]
fn every_major_word_of_apt_iii_does_something() {
    use apt_program::FindingKind;
    use apt_syntax::vocabulary::{WordClass, words};
    let majors = words().iter().filter(|word| {
        !matches!(
            word.class,
            WordClass::Minor | WordClass::Function | WordClass::GeometricType | WordClass::Text
        ) && word.dialects.contains(&DialectName::Apt3)
    });
    let mut count = 0;
    for word in majors {
        count += 1;
        let program = run(&format!("{}\nFINI\n", word.spelling));
        let unknown = program.findings().find(|finding| {
            matches!(finding.kind, FindingKind::Control(ControlFinding::NotInDialect { .. }))
        });
        assert!(unknown.is_none(), "{} is not handled", word.spelling);
    }
    assert!(count > 120, "{count} major words");
}

#[test]
fn a_word_that_does_not_choose_between_two_intersections_is_told() {
    let told = |selector: &str, line: &str| {
        let program =
            run(&format!("E=ELLIPS/CENTER,(POINT/0,0),3,2,0\nP=POINT/{selector},INTOF,({line}),E\nFINI\n"));
        problems(&program)
    };
    for (selector, line) in [("YLARGE", "LINE/XAXIS"), ("YSMALL", "LINE/0,1,1,1"), ("XLARGE", "LINE/1,0,1,1")]
    {
        assert_eq!(told(selector, line), [(2, None)], "{selector} {line}");
    }
    // It chooses, or there is nothing to choose: the line touches.
    for (selector, line) in
        [("XLARGE", "LINE/XAXIS"), ("YLARGE", "LINE/0,0,1,.01"), ("YLARGE", "LINE/0,2,1,2")]
    {
        assert_eq!(told(selector, line), [], "{selector} {line}");
    }
}
