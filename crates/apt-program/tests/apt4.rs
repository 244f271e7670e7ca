//! The APT4 dialect: its numbers, and statement forms that it takes (language reference 10.4).

mod support;

use apt_geometry::motion::{Delta, MotionCommand};
use apt_program::{
    ControlFinding, FindingKind, FrameKind, Options, Program, RecordKind, Severity, evaluate,
    finding::{Expected, Finding, Found},
};
use apt_syntax::{Dialect, DialectName, SyntaxTree};
use support::{problems, run_as, scalar};

fn run(text: &str) -> Program {
    run_as(text, DialectName::Apt4)
}

/// Statements, and the findings as (statement, APT4 number).
const MISTAKES: &[(&str, &[(u32, u16)])] = &[
    ("X=Y+1", &[(1, 1007)]),
    ("Z=3 $ text\nPOINT/1,2", &[(1, 1007)]),
    ("W=3)", &[(1, 1007)]),
    ("R=ABSF(-3", &[(1, 1007)]),
    ("RESERV/2,A,3,B", &[(1, 2027)]),
    ("RESERV/A,B", &[(1, 2027)]),
    ("A=1\nIF(A.EQ.1)DO/B,I=1,3\nB)A=2", &[(2, 1007)]),
    ("U=ACOSF(.5)", &[(1, 1111)]),
    ("U=ASINF(.5)", &[(1, 1111)]),
    ("U=NIX(1,2)", &[(1, 1111)]),
    ("A(1)=3", &[(1, 1111)]),
    ("Q=3\nT=Q(1)", &[(2, 1013)]),
    ("RESERV/A,3\nT=A(1)", &[(2, 1014)]),
    ("RESERV/A,3\nA(1)=1\nT=A(2)", &[(3, 1007)]),
    ("P=POINT/1,2\nP=5", &[(2, 1012)]),
    ("P=5\nP=POINT/1,2", &[(2, 1001)]),
    ("RESERV/A,3\nA(1)=1\nA(2)=POINT/1,2", &[(3, 1012)]),
    ("RESERV/A,3\nA=1\nB=A(1)", &[(3, 1014)]),
    ("RESERV/A,3\nA(1)=1\nB=A+1", &[(3, 1012)]),
    ("RESERV/A,3\nA(1)=POINT/1,2\nL=LINE/A,(4,5)", &[(3, 1012)]),
    ("P=POINT/1,2\nX=P+1", &[(2, 1007)]),
    ("C=CIRCLE/(1,2),3", &[(1, 2001)]),
    ("P=POINT/UU,VV", &[(1, 2001), (1, 2001)]),
    ("P=POINT/CANON,1,2", &[(1, 2032)]),
    ("P=POINT/1,2\nQ=POINT/P,CANON,,4,5", &[(2, 2032)]),
    ("OBTAIN/POINT/(POINT/1,2),A", &[(1, 1007)]),
    ("P=POINT/", &[(1, 2001)]),
    ("P=POINT/1,2\nP=POINT/3,4", &[(2, 50)]),
    ("A1=SQRTF(-4)", &[(1, 20)]),
    ("A1=LOGF(-2)", &[(1, 20)]),
    ("A1=LOGF(0)", &[(1, 37)]),
    ("A1=ARSINF(2)", &[(1, 38)]),
    ("A1=ARCOSF(-2)", &[(1, 38)]),
    ("A1=LOG10F(-2)", &[(1, 36)]),
    ("A1=LOG10F(0)", &[(1, 37)]),
    ("A1=ARSINB(2)", &[(1, 38)]),
    ("A1=ARCOSB(2)", &[(1, 38)]),
    ("A=LINE/0,0,1,1\nB=LINE/0,0,1,2\nD=DISTF(A,B)", &[(3, 62)]),
    ("A=VECTOR/1,0,0\nB=POINT/0,0,1\nD=DISTF(A,B)", &[(3, 61)]),
    ("A=VECTOR/1,0,0\nB=POINT/0,1,0\nD=ANGLF(A,B)", &[(3, 80)]),
    ("A=POINT/1,2,0\nD=ANGLF(A,(POINT/1,2,5))", &[(2, 80)]),
    ("A=VECTOR/0,0,0\nD=ANGLB(A,A)", &[(2, 80)]),
    ("A=ELLIPS/CENTER,(0,0),2,1,0\nD=SPATF(A,A,A)", &[(2, 54)]),
    ("A=POINT/1,2\nD=NUMF(A)", &[(2, 36)]),
    ("P=PATERN/LINEAR,(0,0),(1,1),4\nA=CANF(1,P)", &[(2, 39)]),
    ("P=POINT/1,2\nA=CANF(4,P)", &[(2, 40)]),
    ("P=POINT/1,2\nA=CANF(0,P)", &[(2, 41)]),
    ("A=PARMF(1)", &[(1, 42)]),
    ("A=CLDATF(1)", &[(1, 93)]),
    ("A)X=1\nA)X=2", &[(2, 1003)]),
    ("A=1\nA)X=2", &[(2, 1007)]),
    ("JUMPTO/A\nX=1\nA)X=2", &[(2, 1009)]),
    ("IF(1)A,A,A\n$$ remark\nX=1\nA)X=2", &[(3, 1009)]),
    ("IF(1)A,B\nA)X=1\nB)X=1", &[(1, 1007)]),
    ("A=1\nIF(.NOT.A.EQ.1)A=2", &[(2, 1007)]),
    ("A=1\nIF(A.EQ.1)THEN", &[(2, 1007)]),
    ("A=1\nIF(A.EQ.1.EOR.A.EQ.2)A=2", &[(2, 1007)]),
    ("A=1\nIF(A.EQ.1.XOR.A.EQ.2)A=2", &[(2, 1007)]),
    ("DO/A,I=1,THRU,3\nA)X=1", &[(1, 1007)]),
    ("M=MACRO/N\nX=N\nTERMAC\nCALL/M", &[(4, 2055)]),
    ("M=MACRO/N\nX=N\nTERMAC\nCALL/M,K=1,N=2", &[(4, 1020)]),
    ("M=MACRO/N\nN=1\nTERMAC\nCALL/M,N=2", &[(2, 1007)]),
    ("CALL/NIX", &[(1, 72)]),
    ("OBTAIN,LINE/(POINT/1,2),A", &[(1, 1050)]),
    ("PRINT/4,ALL", &[(1, 2031)]),
    ("PRINT/1", &[(1, 2031)]),
    ("PRINT/AVMSG,ON", &[(1, 2031)]),
    ("ZSURF/3", &[(1, 2029)]),
    ("LIBRY/NIX", &[(1, 1007)]),
    ("TOOLONGNAME=3", &[(1, 16)]),
    ("L=LINE/XAXIS\nGO/TO,L,TO,L,TANTO,L", &[(2, 2006)]),
    ("L=LINE/XAXIS\nGOFWD/L,TO,L,TRANTO,A\nA)X=1", &[(2, 2022)]),
    ("FROM/0,0,5\nGOTO/1,2,3,0,0,1", &[(2, 22300)]),
    ("MULTAX/ON\nFROM/0,0,5\nMULTAX/OFF\nGOTO/1,2,3,0,0,1", &[(4, 22300)]),
    ("FROM/0,0,5\nGODLTA/1,2,3,0,.6,.8", &[(2, 22300)]),
    ("MULTAX/ON\nFROM/0,0,5\nGODLTA/1,2,3,0,.6,.8,10", &[]),
];

#[test]
fn mistakes_get_the_numbers_of_apt4() {
    let mut wrong = String::new();
    for (text, expected) in MISTAKES {
        let program = run(text);
        let expected: Vec<_> = expected.iter().map(|(isn, number)| (*isn, Some(*number))).collect();
        if problems(&program) != expected {
            let findings: Vec<_> = program.findings().collect();
            wrong.push_str(&format!("{text:?}: expected {expected:?}, found {findings:?}\n"));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// Statements that are accepted without error and warning, and the numbers that they leave.
const ACCEPTED: &[(&str, &[(&str, f64)])] = &[
    ("X=3\nIF(X.GT.2)JUMPTO/L1\nL1)X=5", &[("X", 5.0)]),
    ("X=3\nDO/L1,I=1,3\nL1)X=X+I", &[("X", 9.0), ("I", 3.0)]),
    ("S=0\nDO/L1,I=5,1\nL1)S=S+1", &[("S", 1.0), ("I", 5.0)]),
    ("LOOPND", &[]),
    ("X=-3**2", &[("X", -9.0)]),
    ("X=2**3**2", &[("X", 64.0)]),
    ("X=2/3/4", &[("X", 2.0 / 3.0 / 4.0)]),
    ("X=ATAN2F(1,1)", &[("X", 45.0)]),
    ("X=INTF(2.7)", &[("X", 2.0)]),
    ("X=MAXF(1,2)", &[("X", 2.0)]),
    ("X=--5\nY=2*-3\nZ=1/-2", &[("X", 5.0), ("Y", -6.0), ("Z", -0.5)]),
    ("R=(W=3)+1\nX=Y=Z=4", &[("R", 4.0), ("W", 3.0), ("X", 4.0), ("Y", 4.0), ("Z", 4.0)]),
    ("V=VECTOR/1,0,0\nU=VECTOR/0,1,0\nX=DOTF(V,U)\nY=ANGLF(V,U)", &[("X", 0.0), ("Y", 90.0)]),
    ("P=POINT/3,4\nV=VECTOR/1,0,0\nX=DOTF(P,V)\nY=LNTHF(P)", &[("X", 3.0), ("Y", 5.0)]),
    (
        "RESERV/A,9\nI=0\nA(I=I+1)=POINT/1,2,3\nA(I=I+1)=POINT/4,5,6\nX=CANF(2,A(2))\nPRINT/3,A(1,THRU,2)",
        &[("I", 2.0), ("X", 5.0)],
    ),
    ("P1=POINT/1,2\nRESERV/P,2\nP(1)=P1\nX=CANF(1,P(1))", &[("X", 1.0)]),
    ("TO=4\nPOINT=3\nX=TO/POINT", &[("X", 4.0 / 3.0)]),
    // Every function of one number: in degrees, in radians, of whole numbers.
    ("X=SINF(30)\nY=COSF(60)\nZ=TANF(45)\nW=COTANF(45)", &[("X", 0.5), ("Y", 0.5), ("Z", 1.0), ("W", 1.0)]),
    ("X=ARSINF(.5)\nY=ARCOSF(.5)\nZ=ATANF(1)", &[("X", 30.0), ("Y", 60.0), ("Z", 45.0)]),
    (
        "X=SINB(.5)\nY=COSB(.5)\nZ=TANB(.5)\nW=COTANB(.5)",
        &[
            ("X", 0.479_425_538_604_203),
            ("Y", 0.877_582_561_890_372_7),
            ("Z", 0.546_302_489_843_790_5),
            ("W", 1.830_487_721_712_452),
        ],
    ),
    (
        "X=ARSINB(1)*2\nY=ARCOSB(-1)\nZ=ATANB(1)*4\nW=ATAN2B(1,-1)*4/3",
        &[
            ("X", std::f64::consts::PI),
            ("Y", std::f64::consts::PI),
            ("Z", std::f64::consts::PI),
            ("W", std::f64::consts::PI),
        ],
    ),
    (
        "X=SINHF(1)\nY=COSHF(1)\nZ=TANHF(1)",
        &[("X", 1.175_201_193_643_801_4), ("Y", 1.543_080_634_815_243_7), ("Z", 0.761_594_155_955_764_9)],
    ),
    (
        "X=INTF(-2.7)\nY=MODF(7.5,2)\nZ=MODF(-7.5,2)\nW=MODF(7.5,-2)",
        &[("X", -2.0), ("Y", 1.5), ("Z", -1.5), ("W", 1.5)],
    ),
    (
        "X=SIGNF(3,-2)\nY=SIGNF(-3,2)\nZ=MINF(3,1,2)\nW=MAXF(-1,-5)",
        &[("X", -3.0), ("Y", 3.0), ("Z", 1.0), ("W", -1.0)],
    ),
    (
        "X=MINF(4)\nY=EXPF(0)\nZ=LOG10F(100)\nW=ATAN2F(1,-1)",
        &[("X", 4.0), ("Y", 1.0), ("Z", 2.0), ("W", 135.0)],
    ),
    // Geometry leads with a place, a normal or a vector.
    (
        "A=(0,0,0)\nB=(-1,-1,5)\nC=CIRCLE/1,0,2\nX=ANGLF(A,B)\nY=ANGLF(C,(POINT/1,7))\nZ=ANGLF((POINT/1,7),C)",
        &[("X", 225.0), ("Y", 90.0), ("Z", 270.0)],
    ),
    (
        "E=PLANE/0,0,1,3\nF=PLANE/1,0,1,0\nV=VECTOR/0,0,-2\nL=LINE/0,0,1,0\nX=ANGLF(E,F)\nY=ANGLF(E,V)\nZ=ANGLF(L,E)\nW=ANGLB(V,E)",
        &[("X", 45.0), ("Y", 180.0), ("Z", 90.0), ("W", std::f64::consts::PI)],
    ),
    // The normal of a line points to its left: of the x axis up, of one at 30 degrees 30 degrees on.
    (
        "X=ANGLF((LINE/0,0,1,0),(LINE/(0,0),ATANGL,30))\nY=ANGLF((LINE/0,0,1,0),(VECTOR/0,1,0))",
        &[("X", 30.0), ("Y", 0.0)],
    ),
    (
        "E=PLANE/0,0,1,3\nP=POINT/1,2,7\nX=DISTF(P,E)\nY=DISTF(E,(POINT/0,0,0))\nZ=DISTF(E,(PLANE/0,0,-2,4))\nW=DISTF(P,(POINT/1,2,3))",
        &[("X", 4.0), ("Y", -3.0), ("Z", 5.0), ("W", 4.0)],
    ),
    (
        "L=LINE/0,2,1,2\nX=DISTF((POINT/5,7),L)\nY=DISTF(L,(LINE/0,0,-1,0))\nZ=DISTF((CIRCLE/1,2,9),(CIRCLE/4,6,9))\nW=DISTF(L,(PLANE/0,1,0,5))",
        &[("X", 5.0), ("Y", 2.0), ("Z", 5.0), ("W", 3.0)],
    ),
    (
        "U=VECTOR/1,0,0\nV=VECTOR/3,4,0\nW=VECTOR/0,0,2\nX=SPATF(U,V,W)\nY=SPATF((POINT/0,0,2),U,V)\nZ=DOTF(V,(POINT/1,2,3))\nR=LNTHF((POINT/2,3,6))",
        &[("X", 8.0), ("Y", 8.0), ("Z", 11.0), ("R", 7.0)],
    ),
    ("PA=PATERN/LINEAR,(POINT/0,0),(POINT/9,0),4\nX=NUMF(PA)", &[("X", 4.0)]),
    // CANF takes the n-th number of every type; the number is truncated.
    (
        "X=CANF(4,(PLANE/0,0,2,3))\nY=CANF(7,(CIRCLE/1,2,3))\nZ=CANF(2.9,(POINT/1,2,3))\nW=CANF(3,(VECTOR/4,5,6))",
        &[("X", 1.5), ("Y", 3.0), ("Z", 2.0), ("W", 6.0)],
    ),
    (
        "X=CANF(1,(LINE/0,0,3,4))\nY=CANF(4,(SPHERE/1,2,3,9))\nZ=CANF(7,(CONE/(POINT/0,0,0),(VECTOR/0,0,1),60))\nW=CANF(7,(CYLNDR/0,0,0,0,0,1,5))",
        &[("X", -0.8), ("Y", 9.0), ("Z", 0.5), ("W", 5.0)],
    ),
    (
        "M=MATRIX/TRANSL,7,8,9\nX=CANF(4,M)\nY=CANF(8,M)\nZ=CANF(4,(QADRIC/1,2,3,4,5,6,7,8,9,10))\nW=CANF(1,(ELLIPS/CENTER,(0,0),4,2,0))",
        &[("X", 7.0), ("Y", 8.0), ("Z", 10.0), ("W", 4.0)],
    ),
    // Operands without parentheses, signs, chains and assignments from left to right.
    ("A=2\nB=3\nP=POINT/A+1,A*3,-A\nX=CANF(1,P)*100+CANF(2,P)*10+CANF(3,P)", &[("X", 358.0)]),
    ("A=2\nB=3\nV=VECTOR/A*B,B/A,A**2\nX=LNTHF(V)**2", &[("X", 36.0 + 2.25 + 16.0)]),
    ("P=POINT/(X=5),(Y=X+1),Y\nZ=CANF(3,P)", &[("X", 5.0), ("Y", 6.0), ("Z", 6.0)]),
    (
        "X=-2**.5\nY=2**-2**2\nZ=0**0\nW=2**-1",
        &[("X", -std::f64::consts::SQRT_2), ("Y", 0.0625), ("Z", 1.0), ("W", 0.5)],
    ),
    ("L=LINE/(0,0),(3,4)\nX=CANF(1,L)*10+CANF(2,L)", &[("X", -8.0 + 0.6)]),
    ("P=(1,2)\nQ=P\nX=CANF(2,Q)\nY=CANF(3,Q)", &[("X", 2.0), ("Y", 0.0)]),
    ("TO=4\nSTOP=5\nX=TO+STOP", &[("X", 9.0)]),
    ("P=POINT/1,2\nOBTAIN,POINT/P,A,,C\nX=A+C", &[("X", 1.0)]),
    ("C=CIRCLE/CANON,1,2,3,0,0,1,4\nX=CANF(3,C)", &[("X", 3.0)]),
    ("ZSURF/(PLANE/0,0,1,7)\nP=(1,2)\nX=CANF(3,P)", &[("X", 7.0)]),
    ("M=MACRO/\nX=3\nTERMAC\nCALL/M", &[("X", 3.0)]),
    // A line without comma or operator is one statement: a chain over the name 1Y.
    ("X=1 Y=2\nZ=1Y", &[("X", 2.0), ("Z", 2.0)]),
    ("RESERV/A,2\nA(1)=POINT/1,2\nP=A(1)\nX=CANF(2,P)", &[("X", 2.0)]),
    (
        "RESERV/Q,2\nQ(2)=7\nY=3\nM=MACRO/A,B,P\nX=A*B\nZ=CANF(1,P)\nTERMAC\nCALL/M,P=(POINT/5,6),A=-Y,B=Q(2)",
        &[("X", -21.0), ("Z", 5.0)],
    ),
    ("M=MACRO/T,N\nN=T/1,2,3\nTERMAC\nCALL/M,T=VECTOR,N=V\nX=LNTHF(V)**2", &[("X", 14.0)]),
    ("X=1\nIF(X.EQ.1.AND.(X.GT.2.OR.X.LT.5))Y=1", &[("Y", 1.0)]),
    ("DO/A,I=0,1,.25\nA)X=I\nY=I", &[("X", 1.0), ("Y", 1.0)]),
    ("DO/L1,I=1,3\nP=POINT/I,0\nL1)X=CANF(1,P)", &[("X", 3.0)]),
    ("P=POINT/1,2\nCANON/ON\nP=POINT/3,4", &[]),
    ("UNITS/FATHOM", &[]),
    ("PRINT/0", &[]),
    ("PRINT/SSPRT,ON\nPRINT/AVPRT,OFF\nPRINT/ON", &[]),
    ("1X=6\nY=1X+1", &[("Y", 7.0)]),
    ("LOOPST\nLOOPST\nX=1\nLOOPND\nLOOPND", &[("X", 1.0)]),
    ("SYN/S,SQRTF,P,POINT\nX=S(9)\nA=P/1,2", &[("X", 3.0)]),
    ("M=MACRO/A,B=2\nX=A*B\nTERMAC\nCALL/M,A=3+4", &[("X", 14.0)]),
    ("N=MACRO/A,R\nR=A*2\nTERMAC\nM=MACRO/K\nCALL/N,A=K,R=W\nTERMAC\nCALL/M,K=4", &[("W", 8.0)]),
];

#[test]
fn forms_of_apt4_are_taken() {
    let mut wrong = String::new();
    for (text, values) in ACCEPTED {
        let program = run(text);
        if !problems(&program).is_empty() {
            wrong.push_str(&format!("{text:?}: {:?}\n", program.findings().collect::<Vec<_>>()));
        }
        for (name, expected) in *values {
            match scalar(&program, name) {
                Some(found) if (found - expected).abs() < 1e-12 => {}
                found => wrong.push_str(&format!("{text:?}: {name} is {found:?}, expected {expected}\n")),
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn a_part_of_print_is_switched_on_or_off() {
    let told = |text: &str| -> Vec<(Expected, Found)> {
        let operand = |finding: &Finding| match &finding.kind {
            FindingKind::Operand { expected, found, number: 326, .. } => Some((*expected, found.clone())),
            _ => None,
        };
        run(text).findings().filter_map(operand).collect()
    };
    assert_eq!(told("PRINT/AVPRT"), [(Expected::OnOrOff, Found::Nothing)]);
    assert_eq!(told("PRINT/AVPRT,1"), [(Expected::OnOrOff, Found::Scalar)]);
    assert_eq!(told("PRINT/SSPRT,ALL"), [(Expected::OnOrOff, Found::Word("ALL".into()))]);
    assert_eq!(told("PRINT/AVPRT,ON,OFF"), [(Expected::Nothing, Found::Word("OFF".into()))]);
    assert_eq!(told("PRINT/AVPRT,ON"), []);
}

#[test]
fn functions_go_on_after_an_argument_outside_their_domain() {
    let program = run("A=SQRTF(-4)\nB=LOGF(-1)\nC=ARSINF(2)\nD=7");
    assert_eq!(scalar(&program, "A"), Some(2.0));
    assert_eq!(scalar(&program, "B"), Some(0.0));
    assert_eq!(scalar(&program, "C"), Some(0.0));
    assert_eq!(scalar(&program, "D"), Some(7.0));
    let program =
        run("A=LOG10F(-100)\nB=PARMF(UVAL)\nC=ANGLF((VECTOR/1,0,0),(POINT/1,0))\nD=NUMF((POINT/1,2))");
    let values = ["A", "B", "C", "D"].map(|name| scalar(&program, name));
    assert_eq!(values, [Some(2.0), Some(0.0), Some(0.0), Some(0.0)]);
}

#[test]
fn names_with_the_same_first_six_characters_are_one() {
    let program = run("RADIUSA=3\nX=RADIUSB+1");
    assert_eq!(scalar(&program, "X"), Some(4.0));
    assert_eq!(problems(&program), [(1, Some(16)), (2, Some(16))]);
}

#[test]
fn a_macro_variable_can_be_the_verb_and_an_axis_is_dropped_without_multax() {
    let program = run(
        "V=MACRO/W,P\nW/P\nTERMAC\nFROM/0,0,5\nCALL/V,W=GOTO,P=(POINT/2,0,0)\nGOTO/1,2,3,0,0,1\nGODLTA/1,0,0,0,.6,.8",
    );
    let axes: Vec<bool> = program
        .records()
        .filter_map(|record| match &record.kind {
            RecordKind::Motion(command) => match &**command {
                MotionCommand::GoTo { axis, .. } => Some(axis.is_some()),
                MotionCommand::GoDelta { delta: Delta::Vector(_, axis), .. } => Some(axis.is_some()),
                _ => None,
            },
            _ => None,
        })
        .collect();
    assert_eq!(axes, [false; 3]);
}

#[test]
fn a_statement_may_have_22000_characters_on_640_lines() {
    let mut text = "X=MAXF(".to_owned();
    let mut count = 0_u32;
    for line in 0..640 {
        for _ in 0..7 {
            text.push_str(&format!("{:4},", count % 9000 + 1000));
            count += 1;
        }
        text.push_str(if line == 639 { "1)\n" } else { "$ text\n" });
    }
    text.push_str("Y=X+1");
    assert!(text.lines().count() == 641 && text.len() > 22_000);
    let program = run(&text);
    assert!(problems(&program).is_empty(), "{:?}", problems(&program));
    assert_eq!(scalar(&program, "X"), Some(f64::from(count + 999)));
    assert_eq!(scalar(&program, "Y"), Some(f64::from(count + 1000)));
    let sum: String =
        (0..640).map(|line| if line == 0 { "S=1$\n".to_owned() } else { "+1 $\n".to_owned() }).collect();
    assert_eq!(scalar(&run(&format!("{sum}+1")), "S"), Some(641.0));
    let long = format!("S=1{}", "$\n-1+1*1/1-1+1+1+1-1*1+1+1".repeat(1_000));
    assert_eq!(scalar(&run(&long), "S"), Some(3001.0), "twelve thousand operators");
}

#[test]
fn constructs_nest_and_combine() {
    let cases: &[(&str, &str, f64)] = &[
        ("Z=0\nDO/A,I=1,3\nDO/A,J=I,3\nA)Z=Z+I*J", "Z", 25.0),
        ("Z=0\nDO/A,I=10,1,-3\nA)Z=Z*100+I", "Z", 10_070_401.0),
        ("Z=0\nDO/A,I=1,10\nIF(I.EQ.4)JUMPTO/B\nZ=Z+I\nA)CONTIN\nB)Z=Z*I", "Z", 24.0),
        (
            "M=MACRO/N,R\nR=0\nDO/A,I=1,N\nIF(MODF(I,2).EQ.0)R=R+I\nA)CONTIN\nTERMAC\nCALL/M,N=10,R=S",
            "S",
            30.0,
        ),
        ("RESERV/A,9\nI=0\nDO/L,K=1,3\nL)A(I=I+1)=K**2\nX=A(I)+A(I=I-1)*10+A(I=I-1)*100", "X", 149.0),
        ("TO=3\nON=TO*2\nDO/TO1,PAST=1,ON\nTO1)TO=TO+PAST", "TO", 24.0),
        ("M=MACRO/V,A,B,C\nC=V(A,B)\nTERMAC\nCALL/M,V=MAXF,A=3,B=2+5,C=R", "R", 7.0),
        ("X=-2**2\nY=(-2)**2\nIF(X.LT.Y.AND.Y.EQ.4.OR.X.GT.100)Z=1", "Z", 1.0),
        ("X=2\nIF(X.EQ.1.OR.X.EQ.2.AND.X.EQ.3)Y=1\nIF(X.EQ.2.OR.X.EQ.9.AND.X.EQ.8)Y=7", "Y", 7.0),
        ("SYN/C,CIRCLE,R,RADIUS\nK=C/CENTER,(1,2),R,3\nX=CANF(7,K)", "X", 3.0),
        ("LOOPST\nK=0\nLOOPST\nA)K=K+1\nIF(K.LT.4)JUMPTO/A\nLOOPND\nK=K*10\nLOOPND", "K", 40.0),
        ("M=MACRO/K\nX=K*2\nTERMAC\nN=MACRO/K\nCALL/M,K=K+1\nTERMAC\nCALL/N,K=4", "X", 10.0),
        ("V A L U E = 1 2 . 5 $ text\n+ 1 $$ the end\nX=VALUE", "X", 13.5),
        ("P=(1,2,3)\nQ=P\nX=DISTF(Q,(POINT/4,6,3))", "X", 5.0),
        ("A=3\nIF(A-3)1,02,3\n1)X=1\nJUMPTO/4\n2)X=2\nJUMPTO/4\n3)X=3\n4)Y=X", "Y", 2.0),
    ];
    for (text, name, expected) in cases {
        let program = run(text);
        let errors: Vec<_> =
            program.findings().filter(|finding| finding.severity == Severity::Error).collect();
        assert!(errors.is_empty(), "{text}: {errors:?}");
        assert_eq!(scalar(&program, name), Some(*expected), "{text}");
    }
}

#[test]
fn do_loops_end_at_their_label_and_are_left_by_jumps() {
    let missing = run("DO/B,I=1,3\nX=I");
    let kinds: Vec<_> = missing.findings().map(|finding| &finding.kind).collect();
    assert!(
        matches!(kinds.as_slice(), [FindingKind::Control(ControlFinding::UnknownLabel { name, .. })] if name == "B"),
        "{kinds:?}"
    );
    for text in [
        "DO/A,I=1,3\nDO/B,J=1,2\nA)X=I\nB)Y=J",
        "M=MACRO\nDO/A,I=1,3\nDO/B,J=1,2\nA)X=I\nB)Y=J\nTERMAC\nCALL/M",
    ] {
        let program = run(text);
        let kinds: Vec<_> = program.findings().map(|finding| finding.kind.clone()).collect();
        let expected =
            FindingKind::Control(ControlFinding::LoopsCross { label: "B".into(), outer: "A".into() });
        assert_eq!(kinds, [expected], "{text}");
    }
    let backwards = run("A)X=1\nDO/A,I=1,3\nX=2");
    assert!(
        backwards
            .findings()
            .any(|finding| matches!(finding.kind, FindingKind::Control(ControlFinding::UnknownLabel { .. })))
    );
    // A loop that a jump has left is over, wherever the jump goes.
    let text =
        "N=0\nS=0\nC)N=N+1\nDO/A,I=1,4\nIF(N.EQ.1.AND.I.EQ.2)JUMPTO/B\nA)S=S+I\nB)IF(N.LT.2)JUMPTO/C\nA1)X=I";
    for program in [run(text), run(&format!("M=MACRO\n{text}\nTERMAC\nCALL/M"))] {
        assert!(problems(&program).is_empty(), "{:?}", problems(&program));
        assert_eq!((scalar(&program, "S"), scalar(&program, "X")), (Some(11.0), Some(4.0)));
    }
    let outer = "S=0\nDO/A,I=1,2\nDO/B,J=1,9\nIF(J.EQ.2)JUMPTO/A\nS=S+1\nB)S=S+10\nA)S=S+100";
    assert_eq!(scalar(&run(outer), "S"), Some(222.0));
}

#[test]
fn an_endless_program_is_no_program_without_fini() {
    let program = run("J=0\nA)I=1\nIF(J.LT.3)JUMPTO/A");
    let kinds: Vec<_> = program.findings().map(|finding| &finding.kind).collect();
    assert!(matches!(kinds.as_slice(), [FindingKind::Control(ControlFinding::Endless { .. })]), "{kinds:?}");
    let unended = evaluate(
        &SyntaxTree::parse("A=1\nB=A\n", Dialect::named(DialectName::Apt4)),
        &Options::default(),
        &|| false,
    );
    assert!(unended.findings().any(|finding| finding.kind == FindingKind::EndMissing));
}

/// APT III gives error 23 (language reference 1.1); elsewhere the program ends at its last line, with a warning.
#[test]
fn a_program_without_fini_is_an_error_on_cards() {
    for (dialect, severity) in [
        (DialectName::Apt3, Severity::Error),
        (DialectName::Apt4, Severity::Warning),
        (DialectName::Free, Severity::Warning),
    ] {
        let program =
            evaluate(&SyntaxTree::parse("A=1\nB=A\n", Dialect::named(dialect)), &Options::default(), &|| {
                false
            });
        let end =
            program.findings().find(|finding| finding.kind == FindingKind::EndMissing).expect("no FINI");
        assert_eq!(end.severity, severity, "{dialect:?}");
    }
}

/// TLRGT and its kin join the statement of a logical IF as they join any other.
#[test]
fn a_logical_if_takes_the_words_before_its_statement() {
    let run = |begin: &str| {
        let text =
            format!("L=LINE/XAXIS\nM=LINE/YAXIS\nFROM/3,-3,0\nGO/TO,L\n{begin}TLRGT,GORGT/L,PAST,M\nFINI");
        let program = run(&text);
        assert_eq!(problems(&program), [], "{begin}");
        program.records().map(|record| format!("{:?}", record.kind)).collect::<Vec<_>>()
    };
    assert_eq!(run("IF(1.LT.2)"), run(""));
    assert_eq!(run("IF(2.LT.1)").len() + 2, run("").len());
}

#[test]
fn a_finding_in_a_do_loop_tells_the_turns() {
    // The frames around the first finding, from the inside: what it is, its statement and its turn.
    let frames = |text: &str| -> Vec<(FrameKind, u32, u32)> {
        let program = run(text);
        let finding = program.findings().find(|finding| finding.severity == Severity::Error);
        let frame = finding.and_then(|finding| finding.origin.frame.as_deref());
        std::iter::successors(frame, |frame| frame.parent.as_deref())
            .map(|frame| (frame.kind, frame.isn, frame.turn))
            .collect()
    };
    let (to_loop, to_macro) = (FrameKind::Loop, FrameKind::Macro);
    assert_eq!(frames("DO/A,I=1,5\nB=1/(I-3)\nA)C=I"), [(to_loop, 1, 3)]);
    let in_macro = "M=MACRO/K\nX=K\nDO/A,I=1,5\nB=1/(I-3)\nA)C=I\nTERMAC\nCALL/M,K=1";
    assert_eq!(frames(in_macro), [(to_loop, 3, 3), (to_macro, 7, 1)]);
    let around_macro = "M=MACRO/K\nB=1/(K-3)\nTERMAC\nDO/A,I=1,5\nCALL/M,K=I\nA)C=I";
    assert_eq!(frames(around_macro), [(to_macro, 5, 1), (to_loop, 4, 3)]);
    let nested = "DO/A,I=1,2\nDO/A,J=1,3\nB=1/(I+J-5)\nA)C=I";
    assert_eq!(frames(nested), [(to_loop, 2, 3), (to_loop, 1, 2)]);
    // Behind a loop that is done, and behind one that a jump has left, there is none.
    assert_eq!(frames("DO/A,I=1,2\nA)C=I\nB=1/0"), []);
    assert_eq!(frames("DO/A,I=1,2\nIF(I-1)X,X,A\nA)C=I\nX)B=1/0"), []);
    // Labels and names of the body are no others in another turn.
    let sound = run("DO/A,I=1,3\nX)C=I\nA)P=I\nGOTO/C,P,0\nFINI");
    assert_eq!(problems(&sound), vec![]);
}
