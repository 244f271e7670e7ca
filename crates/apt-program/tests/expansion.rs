//! The unrolled program, and that it does the same as the program.

use apt_program::{Expansion, Options, RecordKind, evaluate, expand};
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
        GOTO/I,3,0
        GODLTA/-1
        I=I+1
        GOTO/I,3,0
        GODLTA/-1
        I=I+1
        J=0
        I=0
        GOTO/I,J,0
        GODLTA/-2
        I=I+1
        J=J+1
        I=0
        GOTO/I,J,0
        GODLTA/-2
        I=I+1
        J=J+1
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
    let flat = unroll(&text, None, Some(0));
    assert_eq!(flat.text(), "PARTNO ROWS\nCUTTER/.5\nJ=0\nFINI\n");
}
