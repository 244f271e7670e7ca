//! The lossless tree.

use apt_syntax::{Dialect, DialectName, SyntaxKind, SyntaxTree};
use expect_test::{Expect, expect};

fn check(text: &str, dialect: DialectName, expected: &Expect) {
    expected.assert_eq(&SyntaxTree::parse(text, Dialect::named(dialect)).debug_tree());
}

#[test]
fn a_definition_with_a_nest_over_two_records() {
    check(
        "A1) L=LI NE/(1,2), $ note\n P 1 $$ end\n",
        DialectName::Free,
        &expect![[r#"
        Root@0..38
          Statement@0..38
            Label@0..3
              Name@0..2 "A1"
              RightParenthesis@2..3 ")"
            Whitespace@3..4 " "
            Definition@4..30
              Reference@4..5
                Name@4..5 "L"
              Equals@5..6 "="
              DefinitionBody@6..30
                Split@6..11
                  Word@6..8 "LI"
                  Whitespace@8..9 " "
                  Word@9..11 "NE"
                Slash@11..12 "/"
                ParameterList@12..30
                  NestedPoint@12..17
                    LeftParenthesis@12..13 "("
                    ParameterList@13..16
                      Number@13..14 "1"
                      Comma@14..15 ","
                      Number@15..16 "2"
                    RightParenthesis@16..17 ")"
                  Comma@17..18 ","
                  Whitespace@18..19 " "
                  Continuation@19..20 "$"
                  Comment@20..25 " note"
                  LineEnd@25..26 "\n"
                  Whitespace@26..27 " "
                  Reference@27..30
                    Split@27..30
                      Name@27..28 "P"
                      Whitespace@28..29 " "
                      Name@29..30 "1"
            Whitespace@30..31 " "
            Comment@31..37 "$$ end"
            LineEnd@37..38 "\n"
    "#]],
    );
}

#[test]
fn an_expression() {
    check(
        "A(I)=-B**2+SINF(3)",
        DialectName::Free,
        &expect![[r#"
        Root@0..18
          Statement@0..18
            Assignment@0..18
              Reference@0..4
                Name@0..1 "A"
                Subscript@1..4
                  LeftParenthesis@1..2 "("
                  Reference@2..3
                    Name@2..3 "I"
                  RightParenthesis@3..4 ")"
              Equals@4..5 "="
              Binary@5..18
                Binary@5..10
                  Signed@5..7
                    Minus@5..6 "-"
                    Reference@6..7
                      Name@6..7 "B"
                  Power@7..9 "**"
                  Number@9..10 "2"
                Plus@10..11 "+"
                FunctionCall@11..18
                  Word@11..15 "SINF"
                  LeftParenthesis@15..16 "("
                  ParameterList@16..17
                    Number@16..17 "3"
                  RightParenthesis@17..18 ")"
    "#]],
    );
}

#[test]
fn a_mistake_stays_in_its_statement() {
    check(
        "A=3*\nRAPID,STOP/3\n",
        DialectName::Free,
        &expect![[r#"
        Root@0..18
          Statement@0..5
            Error@0..4
              Reference@0..1
                Name@0..1 "A"
              Equals@1..2 "="
              Number@2..3 "3"
              Star@3..4 "*"
            LineEnd@4..5 "\n"
          Statement@5..18
            Major@5..10
              Word@5..10 "RAPID"
            Comma@10..11 ","
            Error@11..17
              Word@11..15 "STOP"
              Slash@15..16 "/"
              Number@16..17 "3"
            LineEnd@17..18 "\n"
    "#]],
    );
}

#[test]
fn cards_and_texts() {
    let text = format!("{:<72}00010\n{:<72}00020\n", "PARTNO X", "A=1 $$ c");
    check(
        &text,
        DialectName::Apt3,
        &expect![[r#"
        Root@0..156
          Statement@0..78
            TextStatement@0..72
              Word@0..6 "PARTNO"
              Text@6..72 " X                    ..."
            SequenceField@72..77 "00010"
            LineEnd@77..78 "\n"
          Statement@78..156
            Assignment@78..81
              Reference@78..79
                Name@78..79 "A"
              Equals@79..80 "="
              Number@80..81 "1"
            Whitespace@81..82 " "
            Comment@82..150 "$$ c                  ..."
            SequenceField@150..155 "00020"
            LineEnd@155..156 "\n"
    "#]],
    );
}

#[test]
fn tokens_know_their_words() {
    let tree = SyntaxTree::parse("GO TO/P1 $$ c\n", Dialect::default());
    let tokens = tree.statement(0).tokens();
    let words: Vec<_> = tokens
        .iter()
        .filter_map(|token| Some((token.word?.spelling, u32::from(token.range.start()))))
        .collect();
    assert_eq!(words, [("GOTO", 0), ("GOTO", 3)], "both pieces of a divided word are that word");
    assert!(tokens.iter().any(|token| token.kind == SyntaxKind::Comment));
}

#[test]
fn who_gives_up_a_long_text_is_heard_soon_and_a_short_one_is_read() {
    let dialect = Dialect::named(DialectName::Free);
    let statements = 20_000;
    let text = "GOTO/1,2,3\n".repeat(statements);
    let asked = std::cell::Cell::new(0);
    let until = |last: usize| {
        SyntaxTree::parse_until(&text, dialect, &|| {
            asked.set(asked.get() + 1);
            asked.get() >= last
        })
    };
    assert_eq!(until(usize::MAX).map(|tree| tree.statement_count()), Some(statements));
    let all = asked.replace(0);
    assert!(all * STATEMENTS_BETWEEN_QUESTIONS >= statements, "{all} questions");
    for last in [1, all / 2, all] {
        asked.set(0);
        assert!(until(last).is_none());
        assert_eq!(asked.get(), last, "asked again after the answer");
    }
    assert!(SyntaxTree::parse_until("GOTO/1,2,3\n", dialect, &|| true).is_some());
}

/// Statements that are found between two questions whether to go on, each in a fraction of a microsecond.
const STATEMENTS_BETWEEN_QUESTIONS: usize = 2_048;

/// Whoever gives up gets nothing, be it while the tree is made or while its text is.
#[test]
fn the_text_of_a_tree_is_given_up_at_any_time() {
    let tree = SyntaxTree::parse(&"P1=POINT/1,2,3\n".repeat(50), Dialect::named(DialectName::Free));
    let asked = std::cell::Cell::new(0_usize);
    let after = |limit: usize| {
        asked.set(0);
        tree.debug_tree_until(&|| {
            asked.set(asked.get() + 1);
            asked.get() > limit
        })
    };
    assert_eq!(after(usize::MAX), Some(tree.debug_tree()));
    let all = asked.get();
    for limit in [0, 1, 49, 60, all / 2, all - 1] {
        assert_eq!(after(limit), None, "{limit} of {all}");
        assert!(asked.get() <= limit + 3, "soon after {limit}: {}", asked.get());
    }
}
