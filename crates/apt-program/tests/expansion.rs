//! The unrolled program, and that it does the same as the program.

use apt_program::{Expansion, Options, RecordKind, Severity, evaluate, expand};
use apt_syntax::{Dialect, DialectName, SyntaxTree};
use expect_test::expect;

const PROGRAM: &str = "PARTNO ROWS
ROW=MACRO/N,Y,D=-1
I=0
A)GOTO/I,Y,0
GODLTA/D
I=I+1
IF(I-N)A,B,B
B)TERMAC
CUTTER/.5
CALL/ROW,N=2,Y=3
J=0
LOOPST
C)CALL/ROW,N=1,Y=J,D=(-2)
J=J+1
IF(J-2)C,E,E
E)LOOPND
FINI
";

fn parse(text: &str) -> SyntaxTree {
    SyntaxTree::parse(text, Dialect::named(DialectName::Free))
}

fn unroll(text: &str, at: Option<usize>, depth: Option<u32>) -> Expansion {
    expand(&parse(text), &Options::default(), at, depth, &|| false)
}

fn motions(text: &str) -> Vec<RecordKind> {
    evaluate(&parse(text), &Options::default(), &|| false)
        .records()
        .map(|record| record.kind.clone())
        .collect()
}

#[test]
fn macros_and_loops_are_unrolled() {
    let text = PROGRAM.replace("D=(-2)", "D=-2");
    let expansion = unroll(&text, None, None);
    expect![[r#"
        PARTNO ROWS
        CUTTER/.5
        I=0
        GOTO/0,3,0
        GODLTA/-1
        I=0+1
        GOTO/1,3,0
        GODLTA/-1
        I=1+1
        J=0
        I=0
        GOTO/0,0,0
        GODLTA/-2
        I=0+1
        J=0+1
        I=0
        GOTO/0,1,0
        GODLTA/-2
        I=0+1
        J=1+1
        FINI
    "#]]
    .assert_eq(&expansion.text());
    assert_eq!(motions(&text), motions(&expansion.text()), "the expansion does the same");
    let turns: Vec<u32> = expansion
        .lines
        .iter()
        .filter(|line| line.origin.isn == 4)
        .filter_map(|line| line.origin.frame.as_ref().map(|frame| frame.turn))
        .collect();
    assert_eq!(turns, [1, 2, 1, 1]);
}

#[test]
fn one_call_or_one_level_can_be_shown() {
    let text = PROGRAM.replace("D=(-2)", "D=-2");
    let call = unroll(&text, Some(9), None);
    assert_eq!(call.lines.len(), 7);
    assert!(call.lines.iter().all(|line| line.origin.frame.as_ref().is_some_and(|frame| frame.isn == 10)));
    let inner = unroll(&text, Some(3), None);
    assert_eq!(inner.text(), "GOTO/0,3,0\nGOTO/1,3,0\nGOTO/0,0,0\nGOTO/0,1,0\n", "all that statement 4 does");
}

#[test]
fn what_stays_closed_stands_as_it_is_written_with_the_macros_it_needs() {
    let program = &PROGRAM.replace("D=(-2)", "D=-2");
    let flat = unroll(program, None, Some(0));
    expect![[r#"
        PARTNO ROWS
        ROW=MACRO/N,Y,D=-1
        I=0
        A)GOTO/I,Y,0
        GODLTA/D
        I=I+1
        IF(I-N)A,B,B
        B)TERMAC
        CUTTER/.5
        CALL/ROW,N=2,Y=3
        J=0
        LOOPST
        C)CALL/ROW,N=1,Y=J,D=-2
        J=J+1
        IF(J-2)C,E,E
        E)LOOPND
        FINI
    "#]]
    .assert_eq(&flat.text());
    let one = unroll(program, None, Some(1));
    expect![[r#"
        PARTNO ROWS
        ROW=MACRO/N,Y,D=-1
        I=0
        A)GOTO/I,Y,0
        GODLTA/D
        I=I+1
        IF(I-N)A,B,B
        B)TERMAC
        CUTTER/.5
        I=0
        GOTO/0,3,0
        GODLTA/-1
        I=0+1
        GOTO/1,3,0
        GODLTA/-1
        I=1+1
        J=0
        CALL/ROW,N=1,Y=0,D=-2
        J=0+1
        CALL/ROW,N=1,Y=1,D=-2
        J=1+1
        FINI
    "#]]
    .assert_eq(&one.text());
    let isns: Vec<u32> = one.lines.iter().map(|line| line.origin.isn).collect();
    assert_eq!(isns[1..8], [2, 3, 4, 5, 6, 7, 8], "each line of a macro keeps its own statement");
    let call = unroll(program, Some(9), Some(0));
    assert_eq!(call.text(), "CALL/ROW,N=2,Y=3\n");
    for depth in [None, Some(0), Some(1), Some(2)] {
        assert_eq!(motions(program), motions(&unroll(program, None, depth).text()), "{depth:?}");
    }
}

#[test]
fn values_bind_as_the_names_did() {
    let text = "I=-2\nLOOPST\nA)K=I**2-I\nP=POINT/I,-I,(J=I+3),J\nGOTO/P\nPRINT/3,I\nI=I+.1\n\
                IF(I+1.7)A,B,B\nB)LOOPND\nGOTO/I,K,J\nFINI\n";
    let text = text.replace(",(J=I+3),J\n", ",(J=I+3)\n");
    let expansion = unroll(&text, None, None);
    expect![[r#"
        I=-2
        K=(-2)**2-(-2)
        P=POINT/-2,-(-2),(J=-2+3)
        GOTO/P
        PRINT/3,I
        I=-2+.1
        K=(-1.9)**2-(-1.9)
        P=POINT/-1.9,-(-1.9),(J=-1.9+3)
        GOTO/P
        PRINT/3,I
        I=-1.9+.1
        K=(-1.7999999999999998)**2-(-1.7999999999999998)
        P=POINT/-1.7999999999999998,-(-1.7999999999999998),(J=-1.7999999999999998+3)
        GOTO/P
        PRINT/3,I
        I=-1.7999999999999998+.1
        GOTO/I,K,J
        FINI
    "#]]
    .assert_eq(&expansion.text());
    assert_eq!(motions(&text), motions(&expansion.text()));
}

#[test]
fn a_macro_that_assigns_to_its_variable_is_handed_the_name() {
    let text = "MORE=MACRO/V,DX\nV=V+DX\nTERMAC\nI=0\nLOOPST\nA)CALL/MORE,V=I,DX=1\nGOTO/I,0,0\n\
                IF(I-3)A,B,B\nB)LOOPND\nFINI\n";
    for depth in [None, Some(1)] {
        let expansion = unroll(text, None, depth);
        assert_eq!(motions(text), motions(&expansion.text()), "{depth:?}: {}", expansion.text());
    }
    let open = unroll(text, None, None).text();
    assert!(open.contains("I=0+1\nGOTO/1,0,0\n"), "{open}");
    assert!(unroll(text, None, Some(1)).text().contains("CALL/MORE,V=I,DX=1\nGOTO/1,0,0\n"));
}

fn unroll_apt4(text: &str) -> String {
    let tree = SyntaxTree::parse(text, Dialect::named(DialectName::Apt4));
    expand(&tree, &Options::default(), None, None, &|| false).text()
}

#[test]
fn loops_of_jumps_and_of_do_show_their_values_too() {
    let text = "I=0\nA)I=I+1\nGOTO/I,0,0\nIF(I.LT.2)JUMPTO/A\nDO/B,K=1,3,2\nIF(K.GT.2)GOTO/K,1,1\n\
                B)CONTIN\nFINI\n";
    expect![[r#"
        I=0
        A)I=0+1
        GOTO/1,0,0
        I=1+1
        GOTO/2,0,0
        K=1
        K=3
        GOTO/3,1,1
        FINI
    "#]]
    .assert_eq(&unroll_apt4(text));
}

/// The positions of a program in APT III.
fn positions_apt3(text: &str) -> Vec<RecordKind> {
    let program =
        evaluate(&SyntaxTree::parse(text, Dialect::named(DialectName::Apt3)), &Options::default(), &|| false);
    let findings: Vec<_> = program.findings().filter(|finding| finding.severity > Severity::Hint).collect();
    assert!(findings.is_empty(), "{text}: {findings:?}");
    program.records().map(|record| record.kind.clone()).collect()
}

#[test]
fn values_that_the_dialect_cannot_write_stay_names() {
    // APT III reads sixteen digits, and some doubles take seventeen; the exponent of a small value needs a point.
    let text = "I=-2\nD=.000001\nLOOPST\nA)GOTO/I,D,0\nI=I+.1\nD=D*3\nIF(I+1.5)A,B,B\nB)LOOPND\nFINI\n";
    let tree = SyntaxTree::parse(text, Dialect::named(DialectName::Apt3));
    let unrolled = expand(&tree, &Options::default(), None, None, &|| false).text();
    assert_eq!(positions_apt3(&unrolled), positions_apt3(text));
    assert!(unrolled.contains("GOTO/-2,1.E-6,0\n"), "{unrolled}");
    assert!(unrolled.contains("GOTO/I,9.E-6,0\nI=I+.1\n"), "{unrolled}");
    assert!(
        unroll(text, None, None).text().contains("GOTO/-1.7999999999999998,"),
        "free form reads all digits"
    );
}

#[test]
fn a_label_that_the_path_may_go_on_at_stays() {
    let text = "L1=LINE/0,0,1,0\nTRANTO/A\nGOTO/1,1,1\nA)GOTO/2,2,2\nFINI\n";
    assert_eq!(unroll(text, None, None).text(), text);
}

#[test]
fn texts_are_read_again_as_they_were() {
    let text = "  PPRINT/HELLO\nPPRINT/HI\nPPRINT YO\n  PPRINT/ FAR\n\tPPRINT// X\nFINI\n";
    let unrolled = unroll(text, None, None).text();
    assert_eq!(unrolled, " PPRINT/HELLO\nPPRINT/HI\nPPRINT YO\nPPRINT FAR\nPPRINT/ X\nFINI\n");
    let texts = |text: &str| -> Vec<RecordKind> {
        motions(text).into_iter().filter(|kind| matches!(kind, RecordKind::Text { .. })).collect()
    };
    assert_eq!(texts(text).len(), 5);
    assert_eq!(texts(text), texts(&unrolled));
    assert_eq!(unroll(&unrolled, None, None).text(), unrolled);
    let tree = SyntaxTree::parse("DISPLY / 3 mm left, a b\nFINI\n", Dialect::named(DialectName::Cl));
    let unrolled = expand(&tree, &Options::default(), None, None, &|| false).text();
    assert_eq!(unrolled, "DISPLY/3 mm left, a b\nFINI\n");
}

#[test]
fn labels_of_check_surfaces_in_macros_and_loops_stay_apart() {
    let text = "L=LINE/XAXIS\nC1=CIRCLE/5,0,1\nC2=CIRCLE/9,0,1\nZL0001=1\n\
                M=MACRO/Y\nGOFWD/L,TO,C1,A,TO,C2,B\nA)GOTO/Y,ZL0001\nTRANTO/B\nGOTO/Y,2\nB)GOTO/Y,3\nTERMAC\n\
                CALL/M,Y=5\nCALL/M,Y=6\nI=0\n\
                LOOPST\nE)I=I+1\nTRANTO/F\nF)GOTO/I,7\nIF(I-2)E,G,G\nG)LOOPND\n\
                FINI\n";
    let expansion = unroll(text, None, None);
    expect![[r#"
        L=LINE/XAXIS
        C1=CIRCLE/5,0,1
        C2=CIRCLE/9,0,1
        ZL0001=1
        GOFWD/L,TO,C1,A,TO,C2,B
        A)GOTO/5,ZL0001
        TRANTO/B
        GOTO/5,2
        B)GOTO/5,3
        GOFWD/L,TO,C1,ZL0002,TO,C2,ZL0003
        ZL0002)GOTO/6,ZL0001
        TRANTO/ZL0003
        GOTO/6,2
        ZL0003)GOTO/6,3
        I=0
        I=0+1
        TRANTO/F
        F)GOTO/1,7
        I=1+1
        TRANTO/ZL0004
        ZL0004)GOTO/2,7
        FINI
    "#]]
    .assert_eq(&expansion.text());
}
