//! The worked examples of the language reference: programs with the values that they give.

mod support;

use std::f64::consts::FRAC_1_SQRT_2;

use apt_program::{Program, RecordKind, Severity};
use apt_syntax::DialectName;
use support::{numbers, run_as};

fn run(text: &str) -> Program {
    run_as(text, DialectName::Apt3)
}

/// Section, program, a name and its numbers.
type Example = (&'static str, &'static str, &'static str, &'static [f64]);

/// The reference prints six decimals.
const TOLERANCE: f64 = 1e-6;

const H: f64 = 0.5;
/// Half the square root of three.
const Q: f64 = 0.866_025_403_784_438_6;

const EXAMPLES: &[Example] = &[
    ("1.3", "A C=7", "AC", &[7.0]),
    ("1.3", "W=2 3", "W", &[23.0]),
    ("1.3", "XY=4\nZ=X Y", "Z", &[4.0]),
    ("1.3", "P=POINT/1 2,3", "P", &[12.0, 3.0, 0.0]),
    ("1.4", "AB$\nCD=12$\n34", "ABCD", &[1234.0]),
    ("1.4", "X=1$ the first\n$ nothing\n+2", "X", &[3.0]),
    ("1.4", "X=2 $$ a $$ b", "X", &[2.0]),
    ("1.7", "A=1.E+2", "A", &[100.0]),
    ("1.7", "A=.5E-1", "A", &[0.05]),
    ("1.7", "A=10.E2", "A", &[1000.0]),
    ("1.7", "A=.01E2", "A", &[1.0]),
    ("1.8", "12A=5\n1B=12A", "1B", &[5.0]),
    ("1.9", "LOOPST\nI=0\n01)I=I+1\nIF(I-3)1,1,2\n2)LOOPND", "I", &[4.0]),
    ("2.3", "A=1\nS=2\nP=POINT/A,-A,-2", "P", &[1.0, -1.0, -2.0]),
    ("2.3", "S=2\nP=PLANE/-S,0,S,0", "P", &[-FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2, 0.0]),
    ("2.3", "2A=5\nX=2A", "X", &[5.0]),
    ("2.5", "A=-2**2", "A", &[4.0]),
    ("2.5", "A=2\nC=-A**2", "C", &[4.0]),
    ("2.5", "A=2\nC=3-A**2", "C", &[-1.0]),
    ("2.5", "A=2*-3", "A", &[-6.0]),
    ("2.5", "A=3\nB=A*-A", "B", &[-9.0]),
    ("2.5", "A=2**-1", "A", &[0.5]),
    ("2.5", "A=2**3**2", "A", &[512.0]),
    ("2.5", "A=8/2/2", "A", &[2.0]),
    ("2.5", "A=4\nB=A**2/4*3", "B", &[12.0]),
    ("2.5", "A=(-8)**3", "A", &[-512.0]),
    ("2.6", "A=ABSF(-3)+SQRTF(16)+EXPF(0)+LOGF(1)", "A", &[8.0]),
    ("2.6", "A=LOG10F(1000)", "A", &[3.0]),
    ("2.6", "A=SINF(30)+COSF(60)+TANF(45)", "A", &[2.0]),
    ("2.6", "A=COSF(90)", "A", &[0.0]),
    ("2.6", "A=ATANF(1)", "A", &[45.0]),
    ("2.6", "A=ATAN2F(1,-1)", "A", &[135.0]),
    ("2.6", "A=DOTF((VECTOR/1,2,3),(VECTOR/4,5,6))", "A", &[32.0]),
    ("2.6", "A=DOTF((POINT/1,2,3),(POINT/4,5,6))", "A", &[32.0]),
    ("2.6", "A=LNTHF((VECTOR/2,3,6))", "A", &[7.0]),
    ("2.6", "A=ANGLF((CIRCLE/0,0,2),(POINT/-1,-1))", "A", &[225.0]),
    ("2.6", "A=DISTF((LINE/0,0,1,0),(LINE/0,5,1,5))", "A", &[5.0]),
    ("2.6", "PA=PATERN/LINEAR,(POINT/0,0),(POINT/9,0),4\nA=NUMF(PA)", "A", &[4.0]),
    ("2.7", "RESERV/A,50,B,10\nA(1.9)=3\nX=A(1)", "X", &[3.0]),
    ("2.7", "RESERV/50,A,10,B\nB(10)=4\nX=B(10)", "X", &[4.0]),
    ("2.7", "RESERV/AA,9\nAA(1)=3\nAA(AA(1)+1)=7\nX=AA(4)", "X", &[7.0]),
    ("2.8", "C=CIRCLE/(1,2),(3,4),(5,7)", "C", &[-9.5, 14.5, 0.0, 0.0, 0.0, 1.0, 16.324_828]),
    ("2.8", "B=(D=3)+2", "B", &[5.0]),
    ("2.8", "B=(D=3)+2", "D", &[3.0]),
    ("2.8", "P=POINT/0,0\nL=LINE/P,ATANGL,(A=45)", "A", &[45.0]),
    ("2.8", "C=CIRCLE/CENTER,(P1=POINT/3,4),RADIUS,1\nX=LNTHF(P1)", "X", &[5.0]),
    ("4.0", "ZSURF/0,0,2,3\nP=POINT/1,2", "P", &[1.0, 2.0, 1.5]),
    (
        "4.0",
        "M=MATRIX/TRANSL,5,0,0\nREFSYS/M\nP=POINT/1,2\nREFSYS/NOMORE\nQ=POINT/P,CANON,,,9",
        "Q",
        &[6.0, 2.0, 9.0],
    ),
    ("4.1", "P=POINT/RTHETA,XYPLAN,2,90", "P", &[0.0, 2.0, 0.0]),
    ("4.1", "P=POINT/RTHETA,YZPLAN,2,0", "P", &[0.0, 2.0, 0.0]),
    ("4.1", "P=POINT/THETAR,ZXPLAN,0,2", "P", &[0.0, 0.0, 2.0]),
    ("4.1", "C=CIRCLE/1,1,2\nP=POINT/C,ATANGL,90", "P", &[1.0, 3.0, 0.0]),
    ("4.1", "PA=PATERN/LINEAR,(POINT/0,0),(POINT/9,0),4\nP=POINT/PA,2", "P", &[3.0, 0.0, 0.0]),
    ("4.2", "L=LINE/0,0,3,4", "L", &[0.8, -0.6, 0.0, 0.0]),
    ("4.2", "P=POINT/0,0\nL=LINE/P,ATANGL,30", "L", &[-H, Q, 0.0, 0.0]),
    ("4.2", "L=LINE/XAXIS", "L", &[0.0, 1.0, 0.0, 0.0]),
    ("4.2", "L=LINE/YAXIS", "L", &[1.0, 0.0, 0.0, 0.0]),
    ("4.2", "L=LINE/(POINT/3,4),LEFT,TANTO,(CIRCLE/0,0,2)", "L", &[-0.973_212, 0.229_909, 0.0, -2.0]),
    ("4.3", "P=PLANE/0,0,2,3", "P", &[0.0, 0.0, 1.0, 1.5]),
    ("4.3", "P=PLANE/(1,1,1),(2,3,2),(3,4,0)", "P", &[-0.845_154, 0.507_093, -0.169_031, -0.507_093]),
    ("4.4", "C=CIRCLE/1,2,3,4", "C", &[1.0, 2.0, 0.0, 0.0, 0.0, 1.0, 4.0]),
    ("4.5", "C=CYLNDR/1,2,3,0,0,5,2", "C", &[1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 2.0]),
    ("4.7", "C=CONE/(POINT/0,0,0),(VECTOR/0,0,2),60", "C", &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.5]),
    ("4.8", "G=GCONIC/1,2,3,4,5,6", "G", &[1.0, 3.0, 0.0, 6.0, 0.0, 0.0, 1.0, 2.0, 2.5, 0.0]),
    ("4.10", "V=VECTOR/LENGTH,2,ATANGL,90,YZPLAN", "V", &[0.0, 0.0, 2.0]),
    ("4.10", "V=VECTOR/(VECTOR/1,0,0),CROSS,(VECTOR/0,2,0)", "V", &[0.0, 0.0, 2.0]),
    (
        "4.11",
        "M=MATRIX/XYROT,90,TRANSL,1,2,3",
        "M",
        &[0.0, -1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 1.0, 3.0],
    ),
    (
        "4.11",
        "M=MATRIX/TRANSL,1,2,3,XYROT,90",
        "M",
        &[0.0, -1.0, 0.0, -2.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 3.0],
    ),
    ("4.11", "M=MATRIX/MIRROR,YZPLAN", "M", &[-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    ("4.13", "K=QADRIC/1,2,3,4,5,6,7,8,9,10", "K", &[1.0, 2.0, 3.0, 10.0, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5]),
    ("4.18", "C1=CIRCLE/1,2,3\nC2=CIRCLE/C1,CANON,,,,,,,.25", "C2", &[1.0, 2.0, 0.0, 0.0, 0.0, 1.0, 0.25]),
    ("4.18", "L=LINE/CANON,3,4,0,5", "L", &[3.0, 4.0, 0.0, 5.0]),
    ("4.18", "P=POINT/1,2\nP=POINT/CANON,4,5,6", "P", &[4.0, 5.0, 6.0]),
    ("4.18", "CANON/ON\nP=POINT/1,2\nP=POINT/7,8\nCANON/OFF", "P", &[7.0, 8.0, 0.0]),
    (
        "5",
        "LX=LINE/XAXIS\nLY=LINE/YAXIS\nC=CIRCLE/XLARGE,LY,YSMALL,LX,RADIUS,.5",
        "C",
        &[0.5, -0.5, 0.0, 0.0, 0.0, 1.0, 0.5],
    ),
    (
        "5",
        "E=ELLIPS/CENTER,(1,1,1),3,2,30",
        "E",
        &[5.25, 7.75, 0.0, -27.330_127, 0.0, 0.0, -2.165_063, -3.084_936, -5.584_937, 0.0],
    ),
    ("5", "S=SPHERE/(0,0,0),(1,1,1),(2,3,2),(3,4,0)", "S", &[-3.166_667, 5.5, -0.833_333, 6.400_955]),
    ("7.1", SQUARES, "SQ(4)", &[16.0]),
    ("7.1", SQUARES, "I", &[6.0]),
    ("7.2", "M=MACRO/A\nA=9\nTERMAC\nZ=1\nCALL/M,A=Z", "Z", &[9.0]),
    ("7.2", "M=MACRO/A\nA=9\nTERMAC\nCALL/M,A=NEW", "NEW", &[9.0]),
    ("7.2", "M=MACRO/T,N,P\nN=T/P,2\nTERMAC\nX=3\nCALL/M,T=POINT,N=R,P=X", "R", &[3.0, 2.0, 0.0]),
    ("7.2", "RESERV/PT,4\nM=MACRO/A,N\nA(N)=N*2\nTERMAC\nCALL/M,A=PT,N=3", "PT(3)", &[6.0]),
    ("7.2", "M=MACRO/A,B=5\nX=A+B\nTERMAC\nCALL/M,B=1,A=2\nY=X\nCALL/M,A=2", "X", &[7.0]),
    ("7.2", "Q=1\nM=MACRO/Q\nX=Q\nTERMAC\nCALL/M,Q=77\nY=Q", "X", &[77.0]),
    ("7.2", "Q=1\nM=MACRO/Q\nX=Q\nTERMAC\nCALL/M,Q=77\nY=Q", "Y", &[1.0]),
    ("7.2", "M=MACRO/K\nX=K*2\nTERMAC\nN=MACRO/N\nCALL/M,K=N\nTERMAC\nCALL/N,N=21", "X", &[42.0]),
    ("7.2", "M=MACRO/A\nX=A**2\nTERMAC\nCALL/M,A=-3", "X", &[9.0]),
    (
        "7.2",
        "RESERV/B,5\nM=MACRO/P\nX=P(2)\nTERMAC\nN=MACRO/R\nCALL/M,P=R\nTERMAC\nB(2)=8\nCALL/N,R=B",
        "X",
        &[8.0],
    ),
    ("7.7", "P=POINT/1,2,3\nOBTAIN,POINT/P,A,,C", "C", &[3.0]),
    ("7.7", "P=POINT/1,2,3\nOBTAIN/POINT/P,A", "A", &[1.0]),
];

const SQUARES: &str = "RESERV/SQ,5\nI=1\nLOOPST\nA1)SQ(I)=I**2\nI=I+1\nIF(I-5)A1,A1,A2\nA2)LOOPND";

#[test]
fn worked_examples_give_their_values() {
    let mut wrong = Vec::new();
    for (section, text, name, expected) in EXAMPLES {
        let program = run(text);
        let errors: Vec<String> = program
            .findings()
            .filter(|finding| finding.severity == Severity::Error)
            .map(|finding| format!("{:?}", finding.kind))
            .collect();
        let found = numbers(&program, name).unwrap_or_default();
        let near = found.len() == expected.len()
            && found.iter().zip(*expected).all(|(a, b)| (a - b).abs() <= TOLERANCE * b.abs().max(1.0));
        if !near || !errors.is_empty() {
            wrong.push(format!("{section} {text:?}: {name} = {found:?}, not {expected:?}; {errors:?}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn a_row_of_holes_is_drilled() {
    let text = "RESERV/HL,4\nHL(1)=POINT/0,0\nHL(2)=POINT/1,0\nHL(3)=POINT/2,0\nHL(4)=POINT/3,0\n\
                DROW=MACRO/PA,N,DEP,FD=5\nK=1\nR1)GOTO/PA(K)\nGODLTA/0,0,DEP,FD\nGODLTA/0,0,2\nK=K+1\n\
                IF(K-N)R1,R1,R2\nR2)TERMAC\nCALL/DROW,PA=HL,N=4,DEP=-2";
    let program = run(text);
    assert!(program.findings().all(|finding| finding.severity < Severity::Error));
    let motions = program.records().filter(|record| matches!(record.kind, RecordKind::Motion(_))).count();
    let feeds = program
        .records()
        .filter(|record| matches!(&record.kind, RecordKind::Postprocessor { word, .. } if word == "FEDRAT"))
        .count();
    assert_eq!((motions, feeds), (12, 4));
}

#[test]
fn several_statements_stand_on_one_line() {
    let count = |text: &str| run(text).record_count() - 1;
    assert_eq!(count("P1=POINT/1,2\nRAPID,GOTO/P1"), 2);
    assert_eq!(count("NOPOST,CUTTER/.5"), 1);
    assert_eq!(count("STOP,GOTO/1,1"), 2);
    assert_eq!(count("RAPID,STOP,GOTO/1,1"), 3);
}
