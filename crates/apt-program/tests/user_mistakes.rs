//! Mistakes that users make and the numbers that APT III gives for them (language reference 9.5), on cards.

use apt_program::{Finding, Options, Severity, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree};

/// The mistake, a program without FINI, and the problems as (statement, number).
type Row = (&'static str, &'static str, &'static [(u32, u16)]);

const ROWS: &[Row] = &[
    ("missing comma", "P=POINT/1 2", &[(1, 1000)]),
    ("name too long", "LONGNAME=3", &[(1, 1)]),
    ("word for name", "POINT=3", &[(1, 155)]),
    ("function as variable", "A=SINF 3", &[(1, 101)]),
    ("unknown function", "A=INTF(3)", &[(1, 108)]),
    ("expression in list", "SPINDL/3+4", &[(1, 7)]),
    ("implicit product", "A=3(4)", &[(1, 7)]),
    ("unclosed parenthesis", "A=(3+4", &[(1, 10)]),
    ("unopened parenthesis", "A=3+4)", &[(1, 9)]),
    ("dangling operator", "A=3*", &[(1, 11)]),
    ("double operator", "A=3+*4", &[(1, 54)]),
    ("empty parentheses", "A=()", &[(1, 78)]),
    ("undefined name", "A=ZZZ", &[(1, 101)]),
    ("label used as scalar", "XX)A=1\nB=XX+1", &[(2, 251)]),
    ("point used as scalar", "P=POINT/1,2\nA=P+1", &[(2, 83)]),
    ("surface redefined", "P=POINT/1,2\nP=POINT/3,4", &[(2, 1002)]),
    ("scalar to surface", "P=3\nP=POINT/1,2", &[(2, 1002)]),
    ("surface to scalar", "P=POINT/1,2\nP=3", &[(2, 108)]),
    ("subscript out of range", "RESERV/A,3\nA(4)=1", &[(2, 104)]),
    ("subscript missing", "RESERV/A,3\nA=1", &[(2, 105)]),
    ("array without RESERV", "A(1)=3", &[(1, 108)]),
    ("mixed array", "RESERV/A,3\nA(1)=1\nA(2)=POINT/1,2", &[(3, 106)]),
    ("no such form of POINT", "P=POINT/1", &[(1, 1000)]),
    ("too many coordinates", "P=POINT/1,2,3,4,5", &[(1, 1000)]),
    ("no such form of LINE", "L=LINE/1,2", &[(1, 1000)]),
    ("degenerate geometry", "L=LINE/1,2,1,2", &[(1, 1005)]),
    ("CANON with a wrong count", "P=POINT/CANON,1,2", &[(1, 84)]),
    ("OBTAIN of another type", "C=CIRCLE/0,0,1\nOBTAIN,LINE/C,X", &[(2, 153)]),
    ("OBTAIN without a type word", "C=CIRCLE/0,0,1\nOBTAIN,C,X", &[(2, 153)]),
    ("OBTAIN of too many", "P=POINT/0,0,1\nOBTAIN,POINT/P,X,Y,Z,W", &[(2, 154)]),
    ("scalar to ZSURF", "Z=4\nZSURF/Z", &[(2, 1000)]),
    ("scalar to PSIS", "Z=4\nPSIS/Z", &[(2, 1000)]),
    ("scalar to REFSYS", "Z=4\nREFSYS/Z", &[(2, 651)]),
    ("scalar to TRACUT", "Z=4\nTRACUT/Z", &[(2, 506)]),
    ("surface in a post-processor statement", "P=POINT/1,2\nSPINDL/P", &[(2, 501)]),
    ("parameter on a bare word", "STOP/3", &[(1, 505)]),
    ("number for the name of MACHIN", "MACHIN/1,2", &[(1, 503)]),
    ("SYN with one operand", "SYN/A", &[(1, 351)]),
    ("implied check surface left open by GOTO", "L=LINE/XAXIS\nTLON,GOFWD/L\nGOTO/1,1", &[(3, 137)]),
    ("implied check surface left open by FINI", "L=LINE/XAXIS\nTLON,GOFWD/L", &[(3, 650)]),
    ("pattern point number 0", "P=PATERN/LINEAR,(1,1),(2,2),3\nGOTO/P,OMIT,0", &[(2, 812)]),
    ("pattern point number too big", "P=PATERN/LINEAR,(1,1),(2,2),3\nGOTO/P,OMIT,4", &[(2, 812)]),
    ("OMIT with RETAIN", "P=PATERN/LINEAR,(1,1),(2,2),3\nGOTO/P,OMIT,1,RETAIN,2", &[(2, 811)]),
    ("OMIT without number", "P=PATERN/LINEAR,(1,1),(2,2),3\nGOTO/P,OMIT", &[(2, 836)]),
    ("points not ascending", "P=PATERN/LINEAR,(1,1),(2,2),3\nGOTO/P,OMIT,3,1", &[(2, 838)]),
];

#[test]
fn every_row_has_its_number() {
    let mut wrong = Vec::new();
    for (mistake, text, expected) in ROWS {
        let tree = SyntaxTree::parse(&format!("{text}\nFINI\n"), Dialect::named(DialectName::Apt3));
        let program = evaluate(&tree, &Options::default(), &|| false);
        let serious = program.findings().filter(|finding| finding.severity >= Severity::Warning);
        let found: Vec<_> = serious.map(|finding: &Finding| (finding.origin.isn, finding.number)).collect();
        let expected: Vec<_> = expected.iter().map(|(isn, number)| (*isn, Some(*number))).collect();
        if found != expected {
            wrong.push(format!("{mistake}: expected {expected:?}, found {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}
