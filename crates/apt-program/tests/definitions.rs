//! Definitions in whole programs: reference systems, ZSURF, nests, canonical forms, redefinition, subscripts (language
//! reference 2.7, 2.8, 3.3, 4.0, 4.18 and 7.6). Numbers are worked out by hand.

mod support;

use apt_geometry::definition::RuledFault;
use apt_program::{FindingKind, Program, Severity};
use apt_syntax::DialectName;
use support::{problems, run_as};

fn run(text: &str) -> Program {
    run_as(text, DialectName::Apt3)
}

/// The numbers of a name; none where it has no value.
fn numbers(program: &Program, name: &str) -> Vec<f64> {
    support::numbers(program, name).unwrap_or_default()
}

/// Statements, a name, and its numbers; no finding.
type Case = (&'static str, &'static str, &'static [f64]);

fn check(head: &str, cases: &[Case]) {
    let mut wrong = String::new();
    for (text, name, expected) in cases {
        let program = run(&format!("{head}{text}"));
        let found = numbers(&program, name);
        let near = found.len() == expected.len()
            && found.iter().zip(*expected).all(|(a, b)| (a - b).abs() <= 1e-9 * b.abs().max(1.0));
        if !near || !problems(&program).is_empty() {
            let findings: Vec<_> = program.findings().map(|finding| &finding.kind).collect();
            wrong.push_str(&format!("{text:?}: {name} = {found:?}, not {expected:?}; {findings:?}\n"));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// x' = 10 − y, y' = x, z' = z + 2.
const TURN: &str = "M=MATRIX/XYROT,90,TRANSL,10,0,2\nN=MATRIX/TRANSL,0,0,5\n";

/// A definition inside of REFSYS/M, and what a copy of it made outside says.
const OUTSIDE: &[(&str, &str, &[f64])] = &[
    ("POINT", "1,2,3", &[8.0, 1.0, 5.0]),
    ("VECTOR", "1,2,3", &[-2.0, 1.0, 3.0]),
    ("LINE", "0,1,5,1", &[1.0, 0.0, 0.0, 9.0]),
    ("PLANE", "1,0,0,1", &[0.0, 1.0, 0.0, 1.0]),
    ("PLANE", "0,0,1,3", &[0.0, 0.0, 1.0, 5.0]),
    ("CIRCLE", "1,0,2", &[10.0, 1.0, 2.0, 0.0, 0.0, 1.0, 2.0]),
    ("CYLNDR", "1,2,3,2,0,0,4", &[8.0, 1.0, 5.0, 0.0, 1.0, 0.0, 4.0]),
    ("SPHERE", "1,2,3,4", &[8.0, 1.0, 5.0, 4.0]),
    ("CONE", "(POINT/1,2,3),(VECTOR/2,0,0),60", &[8.0, 1.0, 5.0, 0.0, 1.0, 0.0, 0.5]),
    // (x'−10)²/4 + y'²/16 = 1 times 64: 16 x'² + 4 y'² − 320 x' + 1536 = 0.
    ("ELLIPS", "CENTER,(POINT/0,0),4,2,0", &[16.0, 4.0, 0.0, 1536.0, 0.0, 0.0, 0.0, -160.0, 0.0, 0.0]),
    // x = y'.
    ("HYPERB", "CENTER,(POINT/0,0),1,1,0", &[-1.0, 1.0, 0.0, -101.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0]),
    ("GCONIC", "0,0,0,1,0,-3", &[0.0, 0.0, 0.0, -3.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0]),
    ("QADRIC", "0,0,0,0,0,0,0,0,2,0", &[0.0, 0.0, 0.0, -4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
];

#[test]
fn geometry_is_seen_from_the_system_in_force() {
    let mut wrong = String::new();
    for (word, body, expected) in OUTSIDE {
        let names: Vec<String> = (1..=expected.len()).map(|number| format!("X{number}")).collect();
        let text = format!(
            "{TURN}REFSYS/M\nG={word}/{body}\nREFSYS/NOMORE\nOBTAIN,{word}/G,{}\nREFSYS/N\nREFSYS/M\nH={word}/{body}\n",
            names.join(",")
        );
        let program = run(&text);
        let found: Vec<f64> = names.iter().flat_map(|name| numbers(&program, name)).collect();
        let near =
            found.len() == expected.len() && found.iter().zip(*expected).all(|(a, b)| (a - b).abs() < 1e-9);
        // The stored form never changes.
        let stored = numbers(&program, "G") == numbers(&program, "H");
        if !near || !stored || !problems(&program).is_empty() {
            wrong
                .push_str(&format!("{word}/{body}: {found:?}, not {expected:?}; {:?}\n", problems(&program)));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn systems_change_what_a_definition_uses() {
    check(
        TURN,
        &[
            // From the base into a system by the inverse.
            ("P=POINT/8,1,5\nREFSYS/M\nOBTAIN,POINT/P,X,Y,Z", "X", &[1.0]),
            ("P=POINT/8,1,5\nREFSYS/M\nOBTAIN,POINT/P,X,Y,Z", "Z", &[3.0]),
            ("P=POINT/8,1,5\nREFSYS/M\nS=SPHERE/P,1", "S", &[1.0, 2.0, 3.0, 1.0]),
            // From one system into another, by way of the base.
            ("REFSYS/N\nP=POINT/8,1,0\nREFSYS/M\nQ=SPHERE/P,2", "Q", &[1.0, 2.0, 3.0, 2.0]),
            ("REFSYS/M\nL=LINE/0,1,5,1\nREFSYS/NOMORE\nP=POINT/INTOF,L,(LINE/XAXIS)", "P", &[9.0, 0.0, 0.0]),
            ("REFSYS/M\nC=CIRCLE/1,0,2\nREFSYS/NOMORE\nP=POINT/CENTER,C", "P", &[10.0, 1.0, 0.0]),
            ("REFSYS/M\nV=VECTOR/1,0,0\nREFSYS/NOMORE\nW=VECTOR/2,TIMES,V", "W", &[0.0, 2.0, 0.0]),
            // A matrix is not moved.
            ("REFSYS/N\nK=MATRIX/M,M\nREFSYS/NOMORE\nJ=MATRIX/INVERS,K\nP=POINT/1,2", "P", &[1.0, 2.0, 0.0]),
            (
                "REFSYS/M\nP=PATERN/LINEAR,(POINT/0,0),(POINT/1,0),2\nREFSYS/NOMORE\nQ=POINT/P,2",
                "Q",
                &[10.0, 1.0, 2.0],
            ),
            (
                "REFSYS/M\nT=TABCYL/NOZ,PTSLOP,0,0,0,4,0,0\nREFSYS/NOMORE\nQ=POINT/INTOF,(LINE/0,3,9,3),T,(POINT/10,3)",
                "Q",
                &[10.0, 3.0, 0.0],
            ),
        ],
    );
}

#[test]
fn the_z_of_zsurf_belongs_to_the_system_in_which_a_point_is_defined() {
    check(
        TURN,
        &[
            ("REFSYS/N\nP=POINT/1,2", "P", &[1.0, 2.0, 0.0]),
            ("REFSYS/N\nP=POINT/1,2\nREFSYS/NOMORE\nOBTAIN,POINT/P,X,Y,Z", "Z", &[5.0]),
            ("ZSURF/0,0,1,2\nREFSYS/N\nP=POINT/1,2\nREFSYS/NOMORE\nOBTAIN,POINT/P,X,Y,Z", "Z", &[7.0]),
            ("REFSYS/N\nZSURF/(PLANE/0,0,1,2)\nREFSYS/NOMORE\nP=POINT/1,2", "P", &[1.0, 2.0, 2.0]),
            // A plane of another system is carried over when ZSURF takes it.
            ("REFSYS/N\nE=PLANE/0,0,1,2\nREFSYS/NOMORE\nZSURF/E\nP=POINT/1,2", "P", &[1.0, 2.0, 7.0]),
            ("ZSURF/0,.5,1,2\nP=POINT/1,2\nZSURF/NOMORE\nQ=POINT/P,CANON,5", "Q", &[5.0, 2.0, 1.0]),
            ("ZSURF/0,0,1,2\nP=POINT/INTOF,(LINE/XAXIS),(LINE/YAXIS)", "P", &[0.0, 0.0, 2.0]),
            ("ZSURF/0,0,1,2\nC=CIRCLE/3,4,9,1\nP=POINT/CENTER,C", "P", &[3.0, 4.0, 2.0]),
            ("ZSURF/0,0,1,2\nS=SPHERE/CENTER,(3,4),RADIUS,1", "S", &[3.0, 4.0, 2.0, 1.0]),
            ("ZSURF/0,0,1,2\nP=POINT/RTHETA,XYPLAN,2,0", "P", &[2.0, 0.0, 0.0]),
            (
                "ZSURF/0,0,1,2\nP=POINT/INTOF,(PLANE/1,0,0,1),(PLANE/0,1,0,2),(PLANE/0,0,1,3)",
                "P",
                &[1.0, 2.0, 3.0],
            ),
        ],
    );
}

#[test]
fn nests_define_what_they_name_and_arrays_are_listed_by_their_ends() {
    check(
        "",
        &[
            (
                "C=CIRCLE/CENTER,(P=POINT/INTOF,(LINE/XAXIS),(L=LINE/3,0,3,5)),$\nRADIUS,(R=2)",
                "C",
                &[3.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0],
            ),
            (
                "C=CIRCLE/CENTER,(P=POINT/INTOF,(LINE/XAXIS),(L=LINE/3,0,3,5)),$\nRADIUS,(R=2)",
                "L",
                &[1.0, 0.0, 0.0, 3.0],
            ),
            ("C=CIRCLE/CENTER,(P=POINT/1,2),RADIUS,(R=SQRTF(4))\nX=LNTHF(P)*R", "R", &[2.0]),
            (
                "A=VECTOR/UNIT,(VECTOR/(VECTOR/(POINT/0,0,0),(POINT/1,0,0)),$\nCROSS,(0,5,0))",
                "A",
                &[0.0, 0.0, 1.0],
            ),
            (
                "RESERV/Q,9\nC=CIRCLE/CENTER,(Q(3)=POINT/1,2),RADIUS,1\nP=POINT/CENTER,C",
                "Q(3)",
                &[1.0, 2.0, 0.0],
            ),
            ("RESERV/A,5\nA(1)=1\nA(2)=2\nA(3)=3\nP=POINT/A(1,THRU,3)", "P", &[1.0, 2.0, 3.0]),
            ("RESERV/A,3\nA(1)=1\nA(2)=2\nA(3)=3\nP=POINT/A(ALL)", "P", &[1.0, 2.0, 3.0]),
            ("RESERV/A,3\nA(1)=1\nA(2)=2\nA(3)=3\nP=POINT/A(THRU,ALL)", "P", &[1.0, 2.0, 3.0]),
            ("RESERV/A,3\nA(1)=1\nA(2)=2\nA(3)=3\nP=POINT/A(THRU,2)", "P", &[1.0, 2.0, 0.0]),
            ("RESERV/A,3\nA(1)=1\nA(2)=2\nA(3)=3\nP=POINT/A(ALL,DECR,1)", "P", &[3.0, 2.0, 1.0]),
            ("RESERV/A,5\nA(1)=1\nA(3)=3\nA(5)=5\nP=POINT/A(ALL,INCR,2)", "P", &[1.0, 3.0, 5.0]),
            ("RESERV/A,5\nA(1)=1\nA(3)=3\nA(5)=5\nP=POINT/A(ALL,DECR,2)", "P", &[5.0, 3.0, 1.0]),
            ("RESERV/A,5\nA(5)=5\nP=POINT/A(5,THRU,3),6,7", "P", &[5.0, 6.0, 7.0]),
            ("RESERV/A,5\nA(2)=2\nA(3)=3\nI=2\nP=POINT/A(I,THRU,I+1)", "P", &[2.0, 3.0, 0.0]),
            ("RESERV/Q,2\nQ(1)=POINT/0,0\nQ(2)=POINT/3,4\nL=LINE/Q(ALL)", "L", &[0.8, -0.6, 0.0, 0.0]),
            // Types of single installations are stored as they are given.
            ("L=LOFT/CANON,1,2,3,4,5,6,7,8", "L", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]),
            ("L=LOFT/CANON,1,2,3,4,5,6,7,8\nOBTAIN,LOFT/L,,,,,,,,X", "X", &[8.0]),
            ("L=MESH/CANON,1,2,3,4,5", "L", &[1.0, 2.0, 3.0, 4.0, 5.0]),
            ("L=ELMSRF/CANON,7", "L", &[7.0]),
            ("L=MESH/CANON,1,2,3\nM=MESH/L,CANON,,9", "M", &[1.0, 9.0, 3.0]),
            ("L=MESH/CANON,1,2,3\nL=MESH/CANON,4,5", "L", &[4.0, 5.0]),
            (
                "L=LOFT/CANON,1,2,3,4,5,6,7,8\nM=LOFT/L,CANON,,9",
                "M",
                &[1.0, 9.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0],
            ),
        ],
    );
}

/// Statements, and the findings as (statement, APT III number).
const MISTAKES: &[(&str, &[(u32, u16)])] = &[
    ("C=CIRCLE/0,0,1\nC=CIRCLE/1,1,1", &[(2, 1002)]),
    ("C=CIRCLE/0,0,1\nC=LINE/XAXIS", &[(2, 1002)]),
    ("C=CIRCLE/0,0,1\nC=LINE/CANON,0,1,0,0", &[(2, 1006)]),
    ("C=CIRCLE/0,0,1\nCANON/ON\nC=LINE/XAXIS", &[(3, 1006)]),
    ("C=CIRCLE/0,0,1\nCANON/ON\nCANON/OFF\nC=CIRCLE/1,1,1", &[(4, 1002)]),
    ("RESERV/A,2\nA(1)=POINT/1,2\nA(1)=POINT/3,4", &[(3, 1002)]),
    ("C=CIRCLE/0,0,1\nC=4", &[(2, 108)]),
    ("C=4\nC=CIRCLE/0,0,1", &[(2, 1002)]),
    ("P=POINT/0,0\nX=SPHERE/(P=POINT/1,1),2", &[(2, 1002)]),
    // The second of two faults is a consequence of the first.
    ("P=POINT/NIX,0\nP=POINT/1,1\nQ=SPHERE/P,1", &[(1, 101)]),
    ("C=CIRCLE/CANON,1,2,3,0,0,1", &[(1, 84)]),
    ("L=LINE/CANON,1,2,3", &[(1, 84)]),
    ("K=CONE/CANON,0,0,0,0,0,1,.5,9", &[(1, 84)]),
    ("Q=QADRIC/CANON,1,2,3,4,5,6,7,8,9", &[(1, 84)]),
    ("Q=MATRIX/CANON,1,2,3,4,5,6,7,8,9", &[(1, 84)]),
    ("C=CIRCLE/0,0,1\nS=SPHERE/C,CANON,1", &[(2, 80)]),
    ("R=RLDSRF/CANON,1,2,3", &[(1, 1000)]),
    ("P=PATERN/CANON,1,2,3", &[(1, 1000)]),
    ("L=LOFT/1,2,3,4,5,6,7,8", &[(1, 1000)]),
    ("L=LOFT/1,2,3,4,5,6,7,8,9", &[(1, 1000)]),
    ("L=LOFT/CANON,1,2,3,4,5,6,7", &[(1, 84)]),
    ("L=MESH/1,2,3", &[(1, 1000)]),
    ("L=MESH/CANON", &[(1, 84)]),
    ("L=MESH/CANON,(POINT/1,2)", &[(1, 83)]),
    ("L=MESH/CANON,1,2\nM=MESH/L,CANON,1,2,3", &[(2, 84)]),
    ("L=MESH/CANON,1,2\nM=ELMSRF/L,CANON,1", &[(2, 80)]),
    ("L=MESH/CANON,1,2\nL=MESH/1,2", &[(2, 1000)]),
    ("L=MESH/CANON,1,2\nOBTAIN,MESH/L,A", &[(2, 157)]),
    ("L=CONSEC/CANON,1,2,3", &[(1, 1000)]),
    ("L=CONSEC/1,2,3", &[(1, 1000)]),
    ("L=ELMSRF/1,2,3", &[(1, 1000)]),
    ("L=TOOL/1,2,3", &[(1, 1000)]),
    ("L=POLCON/1,2,3", &[(1, 1000)]),
    ("L=POLCON/CANON,1,2,3", &[(1, 84)]),
    ("ZSURF/(LINE/XAXIS)", &[(1, 26)]),
    ("REFSYS/(POINT/1,2)", &[(1, 651)]),
    ("T=TABCYL/NOZ,SPLINE,0,0,1,1,2,0\nOBTAIN,TABCYL/T,A", &[(2, 157)]),
    ("P=POINT/1,2,3\nOBTAIN,POINT/P,A,B,C,D", &[(2, 154)]),
    ("P=POINT/1,2,3\nOBTAIN,P,A", &[(2, 153)]),
    ("RESERV/A,3\nA(1)=1\nP=POINT/A(1,THRU,3)", &[(3, 101), (3, 101)]),
    ("RESERV/A,2\nA(1)=1\nA(2)=1\nP=POINT/A(1,THRU,3)", &[(4, 104)]),
];

#[test]
fn mistakes_in_definitions_have_their_numbers() {
    let mut wrong = String::new();
    for (text, expected) in MISTAKES {
        let program = run(text);
        let expected: Vec<_> = expected.iter().map(|(isn, number)| (*isn, Some(*number))).collect();
        if problems(&program) != expected {
            let findings: Vec<_> = program.findings().map(|finding| &finding.kind).collect();
            wrong.push_str(&format!("{text:?}: expected {expected:?}, found {findings:?}\n"));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn numbers_that_nothing_can_be_made_of_are_warned_of() {
    for (text, word, number) in [
        ("P=PATERN/LINEAR,(0,0),(1,1),-3", "PATERN", -3.0),
        ("P=PATERN/LINEAR,(0,0),(VECTOR/1,1,0),0", "PATERN", 0.0),
        ("C=CIRCLE/0,0,-2", "CIRCLE", -2.0),
        ("C=CIRCLE/CENTER,(POINT/0,0),TANTO,(LINE/XAXIS)", "CIRCLE", 0.0),
        ("C=CYLNDR/0,0,0,0,0,1,0", "CYLNDR", 0.0),
        ("C=SPHERE/0,0,0,-2", "SPHERE", -2.0),
        ("C=CONE/(POINT/0,0,0),(VECTOR/0,0,1),-30", "CONE", -30.0),
        ("C=ELLIPS/CENTER,(POINT/0,0),-3,2,0", "ELLIPS", -3.0),
        ("C=HYPERB/CENTER,(POINT/0,0),3,0,0", "HYPERB", 0.0),
        ("C=QADRIC/0,0,0,0,0,0,0,0,0,4", "QADRIC", 0.0),
        ("C=GCONIC/0,0,0,0,0,4", "GCONIC", 0.0),
    ] {
        let program = run(text);
        let warned: Vec<_> =
            program.findings().filter(|finding| finding.severity >= Severity::Warning).collect();
        let [warning] = warned.as_slice() else { panic!("{text}: {warned:?}") };
        assert_eq!(warning.severity, Severity::Warning, "{text}");
        assert_eq!(warning.kind, FindingKind::Doubtful { statement: word.into(), value: number }, "{text}");
    }
}

#[test]
fn curves_of_a_ruled_surface_past_their_points_are_told_where_they_are_defined() {
    let head = "A=PLANE/0,0,1,0\nV=VECTOR/0,0,1\nP=POINT/0,3,0\nQ=POINT/4,3,0\n";
    let told = |first: &str| {
        let program = run(&format!("{head}R=RLDSRF/A,{first},A,P,Q,V"));
        let findings: Vec<_> =
            program.findings().map(|finding| (finding.severity, finding.kind.clone())).collect();
        assert_eq!(numbers(&program, "R").len(), 34, "defined all the same");
        findings
    };
    let fault = |fault| [(Severity::Warning, FindingKind::RuledCurve { fault })];
    assert_eq!(told("(0,0,0),(4,0,0),V"), []);
    let off = RuledFault::OffSurface { curve: 1, distances: [1.0, 0.5] };
    assert_eq!(told("(0,0,1),(4,0,.5),V"), fault(off));
    assert_eq!(told("(0,0,1),(4,0,1),(0,5,1)"), fault(RuledFault::NotMet { curve: 1 }));
}
