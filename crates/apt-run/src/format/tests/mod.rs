//! The style, row by row, and the edits that lead to it.

use apt_geometry::patience::Patience;
use apt_syntax::{Dialect, DialectName, SyntaxTree};

use super::*;

mod layout;

fn free(text: &str) -> String {
    styled(text, DialectName::Free, &FormatOptions::default())
}

/// The text in the style; it must be in the style then.
fn styled(text: &str, dialect: DialectName, options: &FormatOptions) -> String {
    let dialect = Dialect::named(dialect);
    let once = format_text(text, dialect, options, Patience::default()).unwrap();
    assert_eq!(
        format_text(&once, dialect, options, Patience::default()).unwrap(),
        once,
        "a second time changes it: {text:?}"
    );
    once
}

#[test]
fn blanks_and_letters_follow_the_style() {
    for (text, expected) in [
        ("p1 = point / 1 , 2 , 3\n", "P1=POINT/1,2,3\n"),
        ("  GOTO/P1   \n", "GOTO/P1\n"),
        ("A = ( B / C ) ** 2\n", "A=(B/C) ** 2\n"),
        ("A=B +C- D * - E\n", "A=B+C-D * -E\n"),
        ("A=B + C\n", "A=B + C\n"),
        ("A=B\t+\tC\n", "A=B + C\n"),
        ("A= - B\n", "A=-B\n"),
        ("x=1.e+2\n", "X=1.E+2\n"),
        ("A=2 * * 3\n", "A=2**3\n"),
        ("IF ( I - 3 ) A1 , A2 , A3\n", "IF(I - 3)A1,A2,A3\n"),
        ("RAPID , GOTO / P\n", "RAPID,GOTO/P\n"),
        ("   \n\t\n", "\n\n"),
        ("FINI", "FINI"),
        ("fini  ", "FINI"),
        ("A=1\r\n  B=2\r\n", "A=1\r\nB=2\r\n"),
    ] {
        assert_eq!(free(text), expected, "{text:?}");
    }
}

#[test]
fn blanks_inside_of_names_and_numbers_stay_as_evidence() {
    assert_eq!(free("P=POINT/1   2,3\n"), "P=POINT/1 2,3\n");
    assert_eq!(free("A  C = 7\n"), "A C=7\n");
    assert_eq!(free("G=CCL  W\n"), "G=CCL W\n");
}

#[test]
fn texts_and_what_is_no_program_stay() {
    for text in
        ["PARTNO  a  part ,  with blanks   \n", "PPRINTfoo = 1 \n", "REMARK = 5\n", "X = 1..2\n", "", "   "]
    {
        assert_eq!(free(text), text);
    }
}

#[test]
fn a_statement_never_becomes_a_text_or_another_statement() {
    // In column 1 it would be a remark, which has no mistakes.
    assert_eq!(free("  REMARKABLE=3\n"), "  REMARKABLE=3\n");
    assert_eq!(free("  TITLES=3\n"), "  TITLES=3\n");
    assert_eq!(free("P A R T N O = 3\n"), "P A R T N O=3\n");
}

#[test]
fn reasons_are_told() {
    let reasons = |text: &str, dialect| {
        let tree = SyntaxTree::parse(text, Dialect::named(dialect));
        let plan = plan(&tree, &FormatOptions::default(), Patience::default()).unwrap();
        assert_eq!(plan.edits, Vec::new());
        plan.kept.iter().map(|kept| (kept.statement, kept.reason)).collect::<Vec<_>>()
    };
    assert_eq!(reasons("A=1\nA # B=2\n", DialectName::Free), [(1, KeptReason::IllegalCharacter)]);
    assert_eq!(reasons(" REMARKABLE=3\n", DialectName::Free), [(0, KeptReason::ReadOtherwise)]);
    assert_eq!(reasons("N12 , GOTO / 1, 2, 3\n", DialectName::Cl), [(0, KeptReason::SequenceNumber)]);
    let card =
        format!("{:<72}0010\n", "  A=1 $$ the comment of this card goes on to the very last column of it.");
    assert_eq!(card.len(), 77);
    assert_eq!(reasons(&card.replace("  A=1", "L)A=1"), DialectName::Apt3), [(0, KeptReason::TooLong)]);
}

#[test]
fn statements_on_one_line_are_spaced_each() {
    let cases = [
        ("A = 1;B = 2\nC = 3\n", "A=1; B=2\nC=3\n"),
        ("  a = 1 ;   b=2 ; goto / 1 , 2,3 $$ there\n", "A=1; B=2; GOTO/1,2,3 $$ there\n"),
        ("A=1;L1 ) B = 2\n", "A=1; L1) B=2\n"),
        ("A = 1;PPRINT  x  ; y\n", "A=1;PPRINT  x  ; y\n"),
        ("A = 1 ;\nB = 2", "A=1;\nB=2"),
        ("A = 1 ; $$ one\nB=22 $$ two\n", "A=1; $$ one\nB=22 $$ two\n"),
        ("A = 1 ; GOTO / 1 , $\n2,3 ; B = 3\n", "A=1; GOTO/1,$\n     2,3; B=3\n"),
        (
            "LOOPST ; L1) A = 1\nIF ( A ) L1,L2,L2\nL2 ) LOOPND\n",
            "LOOPST; L1) A=1\n     IF(A)L1,L2,L2\nL2) LOOPND\n",
        ),
        (";; A = 1 ;;\n", ";; A=1;;\n"),
    ];
    for (text, expected) in cases {
        let once = free(text);
        assert_eq!(once, expected, "{text}");
        assert_eq!(free(&once), once, "{text} once more");
    }
}

#[test]
fn the_branches_of_an_if_are_indented() {
    assert_eq!(
        free(
            "if(a.eq.1)then\nb=1\nelse if(a.gt.2.and..not.b.eq.3)then\nif(b.lt.1)then\nc=1\nend if\nelse\nb=2\nendif\n"
        ),
        "IF(A.EQ.1)THEN\n     B=1\nELSE IF(A.GT.2.AND..NOT.B.EQ.3)THEN\n     IF(B.LT.1)THEN\n          C=1\n     END IF\nELSE\n     B=2\nENDIF\n"
    );
    // An IF that is being typed moves nothing.
    assert_eq!(free("IF(A.EQ.1)THEN\nB=1\n"), "IF(A.EQ.1)THEN\nB=1\n");
}

#[test]
fn indented_texts_stay_texts() {
    for text in ["  PPRINT  A ; b $$ c\n", "A=1; PPRINT/x\nB=2\n", "PARTNO X\n"] {
        assert_eq!(free(text), text);
    }
}

#[test]
fn letters_can_be_kept() {
    let style = |letter_case| FormatOptions { letter_case, ..FormatOptions::default() };
    let text = "Pt=Point/1.e2,b\n";
    assert_eq!(styled(text, DialectName::Free, &style(LetterCase::Words)), "Pt=POINT/1.e2,b\n");
    assert_eq!(styled(text, DialectName::Free, &style(LetterCase::Keep)), text);
    assert_eq!(FormatOptions::of(&Dialect::named(DialectName::Cl)).letter_case, LetterCase::Words);
    assert_eq!(FormatOptions::of(&Dialect::named(DialectName::Apt4)).letter_case, LetterCase::Upper);
}

#[test]
fn cl_files_keep_the_blanks_that_divide_words() {
    let cl = |text: &str| {
        let dialect = Dialect::named(DialectName::Cl);
        styled(text, DialectName::Cl, &FormatOptions::of(&dialect))
    };
    assert_eq!(cl("Tool Path/Rough_1,TOOL,Cutter_a\n"), "TOOL PATH/Rough_1,TOOL,Cutter_a\n");
    assert_eq!(cl("GOTO / 1.0, 2.0 , -3.0\n"), "GOTO/1.0,2.0,-3.0\n");
    assert_eq!(cl("loadtl / 1, OSETNO, 2\n"), "LOADTL/1,OSETNO,2\n");
    assert_eq!(cl("  PPRINT / a  b\n"), "  PPRINT / a  b\n");
    assert_eq!(cl("$$-> CSYS / 1, $\n 2\n"), "$$-> CSYS / 1, $\n 2\n");
}

#[test]
fn edits_are_small_and_in_order() {
    let text = "A = 1\nB=2\nC= 3 $$  x\n";
    let tree = SyntaxTree::parse(text, Dialect::default());
    let edits = format(&tree, &FormatOptions::default(), Patience::default()).unwrap();
    let blank = String::new;
    assert_eq!(edits, [(1..2, blank()), (3..4, blank()), (12..13, blank())]);
    assert_eq!(applied(text, &edits), "A=1\nB=2\nC=3 $$  x\n");
}

#[test]
fn a_range_changes_only_its_statements() {
    let text = "A = 1\nB = 2\nC = 3\n";
    let tree = SyntaxTree::parse(text, Dialect::default());
    let of = |range| {
        applied(text, &format_range(&tree, range, &FormatOptions::default(), Patience::default()).unwrap())
    };
    assert_eq!(of(6..12), "A = 1\nB=2\nC = 3\n");
    assert_eq!(of(7..7), "A = 1\nB=2\nC = 3\n");
    assert_eq!(of(0..text.len()), "A=1\nB=2\nC=3\n");
    assert_eq!(of(5..7), "A=1\nB=2\nC = 3\n");
    let empty = SyntaxTree::parse("", Dialect::default());
    assert_eq!(format_range(&empty, 0..9, &FormatOptions::default(), Patience::default()), Ok(Vec::new()));
}

#[test]
fn settings_can_be_written_down() {
    let options: FormatOptions =
        serde_json::from_str(r#"{"letter-case":"keep","wrap":72}"#).expect("these are options");
    assert_eq!(options.letter_case, LetterCase::Keep);
    assert_eq!(options.wrap, Some(LAST_STATEMENT_COLUMN));
    assert_eq!(options.indent, FormatOptions::default().indent);
    assert!(serde_json::from_str::<FormatOptions>(r#"{"tabs":1}"#).is_err());
}
