//! Labels, indentation, comments, continuation and cards.

use super::*;

#[test]
fn bodies_of_macros_and_loops_are_indented() {
    let text = "\
M=MACRO/A
$$ at the margin
  $$ in the body
B=A
L1)C=B
LABEL2) D=C
TERMAC
LOOPST
X=X+1
IF(X-3)L3,L3,L4
L3)X=X+1
L4)LOOPND
FINI
";
    let expected = "\
M=MACRO/A
$$ at the margin
     $$ in the body
     B=A
L1)  C=B
LABEL2) D=C
TERMAC
LOOPST
     X=X+1
     IF(X-3)L3,L3,L4
L3)  X=X+1
L4) LOOPND
FINI
";
    assert_eq!(free(text), expected);
    let flat = FormatOptions { indent: 0, ..FormatOptions::default() };
    assert_eq!(styled(expected, DialectName::Free, &flat).lines().nth(3), Some("B=A"));
}

#[test]
fn what_is_not_closed_is_not_indented() {
    assert_eq!(free("M=MACRO/A\n B=A\nLOOPST\nX=1\nFINI\n"), "M=MACRO/A\nB=A\nLOOPST\nX=1\nFINI\n");
    assert_eq!(free("TERMAC\nA=1\nLOOPND\nA=2\n"), "TERMAC\nA=1\nLOOPND\nA=2\n");
    assert_eq!(free("M=MACRO\nLOOPST\nA=1\nTERMAC\nB=1\n"), "M=MACRO\n     LOOPST\n     A=1\nTERMAC\nB=1\n");
}

#[test]
fn do_loops_reach_to_their_label() {
    let text = "DO/10,I=1,3\nDO/10,J=1,3\nA=I\n10)CONTIN\nB=1\n";
    let expected = "DO/10,I=1,3\n     DO/10,J=1,3\n          A=I\n10)       CONTIN\nB=1\n";
    assert_eq!(styled(text, DialectName::Apt4, &FormatOptions::default()), expected);
}

#[test]
fn texts_stay_in_column_one_of_a_body() {
    assert_eq!(free("M=MACRO\nPPRINT  x\nA=1\nTERMAC\n"), "M=MACRO\nPPRINT  x\n     A=1\nTERMAC\n");
}

#[test]
fn records_stay_where_their_author_broke_them() {
    assert_eq!(
        free("  C1 = CIRCLE / CENTER, P1, $\n RADIUS , $ how large\n   2.5\n"),
        "C1=CIRCLE/CENTER,P1,$\n     RADIUS,$ how large\n     2.5\n"
    );
    // An element goes on where it was divided.
    assert_eq!(free("AB$\nCD=12$\n34\n"), "AB$\n     CD=12$\n     34\n");
    assert_eq!(free("A=1,$\n$ only a remark\n  2\n"), "A=1,$\n$ only a remark\n     2\n");
    assert_eq!(free("A=1,$   \n$$ ends it\n"), "A=1,$\n$$ ends it\n");
}

#[test]
fn comments_of_adjacent_lines_begin_in_one_column() {
    assert_eq!(
        free("A=1 $$ one\nBCD = 234    $$ two\n\nE=5    $$ three\n"),
        "A=1     $$ one\nBCD=234 $$ two\n\nE=5 $$ three\n"
    );
    assert_eq!(free("P=POINT/1,$ x\n2,$ y\n3 $$ z\n"), "P=POINT/1,$ x\n     2,   $ y\n     3    $$ z\n");
    let apart = FormatOptions { align_comments: false, ..FormatOptions::default() };
    assert_eq!(
        styled("A=1    $$ one\nBCD=2 $$ two\n", DialectName::Free, &apart),
        "A=1 $$ one\nBCD=2 $$ two\n"
    );
    let long = format!("P=POINT/{}\n", "1111,".repeat(12) + "5 $$ long");
    assert_eq!(free(&format!("A=1 $$ x\n{long}")), format!("A=1 $$ x\n{long}"));
}

#[test]
fn a_statement_after_a_comment_sign_stays_a_comment() {
    assert_eq!(free("A=1 $ $ b=2\n"), "A=1 $ $ b=2\n");
    assert_eq!(free("$$ x $$ y  \n"), "$$ x $$ y\n");
}

#[test]
fn marks_enclose_what_is_left_alone() {
    let text = "A = 1\n$$ apt-lsp: format off\nB = 2\n  $$ apt-lsp: format on  \nC = 3\n";
    assert_eq!(free(text), text.replace("A = 1", "A=1").replace("C = 3", "C=3"));
    let text = "A = 1\nB = 2 $$ apt-lsp: format off\nC = 3\n";
    assert_eq!(free(text), text.replace("A = 1", "A=1"));
}

#[test]
fn long_lines_are_continued_on_request() {
    let wrap = |limit| FormatOptions { wrap: Some(limit), ..FormatOptions::default() };
    let text = "C=CIRCLE/CENTER,(POINT/1,2),RADIUS,3 $$ x\n";
    assert_eq!(styled(text, DialectName::Free, &wrap(72)), text);
    assert_eq!(
        styled(text, DialectName::Free, &wrap(20)),
        "C=CIRCLE/CENTER,$\n     (POINT/1,2),$\n     RADIUS,3 $$ x\n"
    );
    assert_eq!(
        styled("L1)A=1111 + 2222 + 3333\r\n", DialectName::Free, &wrap(13)),
        "L1) A=1111 +$\r\n     2222 +$\r\n     3333\r\n"
    );
    // A name longer than the line cannot be broken.
    assert_eq!(styled("ABCDEF=GHIJKL\n", DialectName::Free, &wrap(4)), "ABCDEF=$\n     GHIJKL\n");
    let goto = format!("GOTO/{}\n", ["P1"; 60].join(","));
    let broken = styled(&goto, DialectName::Free, &wrap(LAST_STATEMENT_COLUMN));
    assert!(broken.lines().all(|line| line.len() <= LAST_STATEMENT_COLUMN), "{broken}");
    assert_eq!(broken.lines().count(), 3, "{broken}");
}

#[test]
fn sequence_fields_stay_in_their_columns() {
    let card = |statement: &str, field: &str| format!("{statement:<72}{field}\n");
    let deck = card("PARTNO  X", "00010") + &card("  A = 1", "00020") + &card("B=2   $$ x", "00030");
    let expected = card("PARTNO  X", "00010") + &card("A=1", "00020") + &card("B=2 $$ x", "00030");
    assert_eq!(free(&deck), expected);
    assert_eq!(styled(&deck, DialectName::Apt3, &FormatOptions::default()), expected);
    // Text behind column 72 without a blank before it is cut there; the formatter leaves the evidence.
    let cut = format!("{:<70}34567\n", "A = 1+");
    let cut = cut.replace("  34567", "1234567");
    assert_eq!(styled(&cut, DialectName::Apt3, &FormatOptions::default()), cut);
}

#[test]
fn an_indented_statement_does_not_push_its_comment_off_the_card() {
    let comment = "x".repeat(60);
    let body = format!("{:<72}00020\n", format!("A=1 $$ {comment}"));
    let deck = format!("{:<72}00010\n{body}{:<72}00030\n", "M=MACRO", "TERMAC");
    assert_eq!(styled(&deck, DialectName::Apt3, &FormatOptions::default()), deck);
}
