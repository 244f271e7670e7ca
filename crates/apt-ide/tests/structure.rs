//! Outline, folds, lenses, colours, and what of it an edit keeps.

#![allow(clippy::unwrap_used, reason = "a test fails where something is missing")]

mod support;

use std::sync::atomic::{AtomicUsize, Ordering};

use apt_geometry::patience::Waiting;
use apt_ide::{
    Analysis, Cancel, Cancelled,
    format::{FormatOptions, plan},
    outline::OutlineEntry,
    tokens::TokenClass,
};
use apt_syntax::vocabulary::{WordClass, words};
use expect_test::expect;

use support::analysis;

const PROGRAM: &str = "\
PARTNO BRACKET
$$ first remark
$$ second remark
P1=POINT/1,2,$
   3
M1=MACRO/DX,DY=2
LOOPST
A) GODLTA/DX,DY,0
JUMPTO/A
LOOPND
TERMAC
RESERV/T,3
T(1)=7
LOADTL/1
FROM/0,0,0
GO/TO,P1
CALL/M1,DX=1
FINI
";

fn outline(entries: &[OutlineEntry], depth: usize, text: &str, out: &mut String) {
    for entry in entries {
        let indent = "  ".repeat(depth);
        let lines = text[entry.range.clone()].trim_end().lines().count();
        assert!(entry.range.start <= entry.focus.start && entry.focus.end <= entry.range.end, "{entry:?}");
        out.push_str(&format!("{indent}{:?} {} {} ({lines} lines)\n", entry.kind, entry.name, entry.detail));
        outline(&entry.children, depth + 1, text, out);
    }
}

#[test]
fn the_outline_nests_macros_and_loops() {
    let mut shown = String::new();
    outline(&analysis(PROGRAM).outline(&|| false).unwrap(), 0, PROGRAM, &mut shown);
    expect![[r#"
        Part BRACKET PARTNO (1 lines)
        Geometry P1 POINT (2 lines)
        Macro M1 MACRO (6 lines)
          Loop LOOPST  (4 lines)
        Array RESERV  (1 lines)
        Scalar T  (1 lines)
        Tool LOADTL  (1 lines)
    "#]]
    .assert_eq(&shown);
}

#[test]
fn the_outline_nests_the_branches_of_an_if() {
    let text = "A=1\nIF(A.EQ.1)THEN\nB=1\nIF(A.EQ.2)THEN\nC=3\nENDIF\nELSEIF(A.GT.2)THEN\nP1=POINT/1,2\nELSE\nD=2\n\
                ENDIF\nE=1\nIF(A.EQ.3)THEN\nFINI\n";
    let mut shown = String::new();
    outline(&analysis(text).outline(&|| false).unwrap(), 0, text, &mut shown);
    expect![[r#"
        Scalar A  (1 lines)
        Branch IF A.EQ.1 (5 lines)
          Scalar B  (1 lines)
          Branch IF A.EQ.2 (2 lines)
            Scalar C  (1 lines)
        Branch ELSEIF A.GT.2 (2 lines)
          Geometry P1 POINT (1 lines)
        Branch ELSE  (2 lines)
          Scalar D  (1 lines)
        Scalar E  (1 lines)
    "#]]
    .assert_eq(&shown);
}

#[test]
fn the_branches_of_an_if_fold() {
    let text = "A=1\nIF(A.EQ.1)THEN\nB=1\nIF(A.EQ.2)THEN\nB=3\nENDIF\nELSE\nB=2\nENDIF\nENDIF\nFINI\n";
    let lines = |offset: usize| text[..offset].matches('\n').count();
    let folds: Vec<(usize, usize)> = analysis(text)
        .folds(&|| false)
        .unwrap()
        .iter()
        .map(|fold| (lines(fold.range.start), lines(fold.range.end)))
        .collect();
    assert_eq!(folds, [(1, 6), (3, 5), (6, 8)]);
}

#[test]
fn regions_remarks_and_continued_statements_fold() {
    let lines = |offset: usize| PROGRAM[..offset].matches('\n').count();
    let folds: Vec<String> = analysis(PROGRAM)
        .folds(&|| false)
        .unwrap()
        .iter()
        .map(|fold| format!("{:?} {}-{}", fold.kind, lines(fold.range.start), lines(fold.range.end)))
        .collect();
    expect![[r#"
        Comment 1-3
        Statement 3-5
        Region 5-11
        Region 6-10"#]]
    .assert_eq(&folds.join("\n"));
}

#[test]
fn lenses_run_the_program_and_each_start() {
    let lenses: Vec<String> = analysis(PROGRAM)
        .lenses(&|| false)
        .unwrap()
        .iter()
        .map(|lens| {
            format!("{} | {:?}", PROGRAM[lens.range.clone()].trim_end(), (&lens.title, lens.run.is_some()))
        })
        .collect();
    expect![[r#"
        PARTNO BRACKET | ("Run motion", false)
        GO/TO,P1 | ("Run GO", true)
        CALL/M1,DX=1 | ("Run CALL", true)"#]]
    .assert_eq(&lenses.join("\n"));
}

#[test]
fn tokens_cover_words_names_numbers_and_comments() {
    let tokens: Vec<String> = analysis(PROGRAM)
        .tokens(None, &|| false)
        .unwrap()
        .iter()
        .filter(|token| token.class != TokenClass::Operator)
        .map(|token| {
            let star = if token.definition { "*" } else { "" };
            format!("{}:{:?}{star}", &PROGRAM[token.range.clone()], token.class)
        })
        .collect();
    expect!["PARTNO:Postprocessor  BRACKET:String $$ first remark:Comment $$ second remark:Comment P1:Variable* POINT:Type 1:Number 2:Number 3:Number M1:Macro* MACRO:Keyword DX:Parameter DY:Parameter 2:Number LOOPST:Keyword A:Label* GODLTA:Keyword DX:Parameter DY:Parameter 0:Number JUMPTO:Keyword A:Label LOOPND:Keyword TERMAC:Keyword RESERV:Keyword T:Variable 3:Number T:Variable* 1:Number 7:Number LOADTL:Postprocessor 1:Number FROM:Keyword 0:Number 0:Number 0:Number GO:Keyword TO:Modifier P1:Variable CALL:Keyword M1:Macro DX:Parameter 1:Number FINI:Keyword"].assert_eq(&tokens.join(" "));
}

/// While a program is written a loop may end behind the macro in which it begins: the outline is nested all the same.
#[test]
fn entries_lie_within_those_they_are_inside_of() {
    fn check(text: &str, entries: &[OutlineEntry], outer: &std::ops::Range<usize>) {
        for entry in entries {
            let within = outer.start <= entry.range.start && entry.range.end <= outer.end;
            assert!(within, "{} {:?} in {outer:?}:\n{text}", entry.name, entry.range);
            check(text, &entry.children, &entry.range);
        }
    }
    for text in [
        "M1=MACRO/A\nLOOPST\nGOTO/A,0,0\nTERMAC\nGOTO/1,2,3\nLOOPND\nFINI\n",
        "LOOPST\nM1=MACRO/A\nGOTO/A,0,0\nLOOPND\nB=1\nTERMAC\nFINI\n",
        "M1=MACRO/A\nIF(A.GT.1)THEN\nB=1\nTERMAC\nC=1\nENDIF\nFINI\n",
    ] {
        check(text, &analysis(text).outline(&|| false).unwrap(), &(0..text.len()));
    }
}

/// What stands between the pieces of a name or a number that a continuation divides is no part of it: tokens that overlap
/// cannot be said in the protocol.
#[test]
fn tokens_of_an_element_over_several_lines_leave_out_what_stands_between_its_pieces() {
    let card = |text: &str, field: &str| format!("{text:<72}{field}");
    let on_cards = format!("{}\n{}\n", card("      A=12$", "CARD0010"), card("      34", "CARD0020"));
    let texts = ["A=1.2$ remark\n  3 5\nAB  C $ x\r\n $ y\r\n  D=7\n", on_cards.as_str()];
    let told = texts.map(|text| {
        let tokens = analysis(text).tokens(None, &|| false).unwrap();
        for (one, next) in tokens.iter().zip(&tokens[1..]) {
            assert!(one.range.end <= next.range.start, "{one:?} and {next:?} overlap in {text:?}");
        }
        let pieces = tokens.iter().map(|token| format!("{:?}", &text[token.range.clone()]));
        pieces.collect::<Vec<_>>().join(" ")
    });
    expect![[r#"
        "A" "=" "1.2" " remark" "3 5" "AB  C" " x" " y" "D" "=" "7"
        "A" "=" "12" "34""#]]
    .assert_eq(&told.join("\n"));
}

#[test]
fn tokens_of_a_long_text_are_without_marks_and_bounded() {
    use apt_ide::tokens::{MOST_STATEMENTS_WITH_MARKS, MOST_TOKENS};
    let long = |statements: usize| analysis(&"GOTO/1,2,A\n".repeat(statements));
    let is_mark = |class: TokenClass| class == TokenClass::Operator;
    let short = long(MOST_STATEMENTS_WITH_MARKS - 1);
    assert!(short.tokens(None, &|| false).unwrap().iter().any(|token| is_mark(token.class)));
    let program = long(MOST_STATEMENTS_WITH_MARKS + 1);
    let all = program.tokens(None, &|| false).unwrap();
    assert!(all.iter().all(|token| !is_mark(token.class)), "marks are left out");
    assert_eq!(all.len(), 4 * (MOST_STATEMENTS_WITH_MARKS + 1));
    assert_eq!(long(MOST_TOKENS).tokens(None, &|| false).unwrap().len(), MOST_TOKENS);
    let seen = program.tokens(Some(0..40), &|| false).unwrap();
    assert!(seen.iter().any(|token| is_mark(token.class)), "what is shown is complete");
}

#[test]
fn tokens_of_a_range_are_those_of_the_whole() {
    let program = analysis(PROGRAM);
    let all = program.tokens(None, &|| false).unwrap();
    for line in PROGRAM.split_inclusive('\n') {
        let start = line.as_ptr() as usize - PROGRAM.as_ptr() as usize;
        let range = start..start + line.len() - 1;
        let part = program.tokens(Some(range.clone()), &|| false).unwrap();
        let inside: Vec<_> =
            all.iter().filter(|one| one.range.start >= range.start && one.range.end <= range.end).collect();
        assert!(inside.iter().all(|one| part.contains(one)), "{line:?}");
        assert!(part.iter().all(|one| all.contains(one)), "{line:?}");
    }
}

/// The scopes of the TextMate grammar that go with a class; the grammar is made from the same vocabulary.
#[test]
fn words_have_the_class_that_the_grammar_of_the_editors_gives_them() {
    for word in words() {
        let text = format!("{}/1\n", word.spelling);
        let settings = apt_ide::Settings {
            dialect: word.dialects.first().map(|dialect| dialect.as_str().to_owned()),
            ..Default::default()
        };
        let program = Analysis::new(&text, None, &std::sync::Arc::new(settings));
        let token = &program.tokens(None, &|| false).unwrap()[0];
        let expected = match word.class {
            WordClass::Minor => TokenClass::Modifier,
            WordClass::GeometricType => TokenClass::Type,
            WordClass::Function => TokenClass::Function,
            WordClass::Postprocessor | WordClass::PostprocessorBare | WordClass::Text => {
                TokenClass::Postprocessor
            }
            _ => TokenClass::Keyword,
        };
        assert_eq!(
            (token.class, token.range.clone()),
            (expected, 0..word.spelling.len()),
            "{}",
            word.spelling
        );
    }
}

#[test]
fn regions_after_edits_are_those_of_a_fresh_program() {
    let text = "M1=MACRO/A\nP=POINT/A,1\nLOOPST\nB) A=A+1\nJUMPTO/B\nLOOPND\nTERMAC\nCALL/M1,A=1\nFINI\n";
    let edits: [(&str, &str); 8] = [
        ("TERMAC", "TERMA"),
        ("TERMA\n", "TERMAC\n"),
        ("LOOPST\n", ""),
        ("P=POINT", "LOOPST\nP=POINT"),
        ("MACRO/A", "MACRO/A,$\nC"),
        ("M1=MACRO", "$$ M1=MACRO"),
        ("$$ M1", "M1"),
        ("FINI", "M2=MACRO\nTERMAC\nFINI"),
    ];
    let mut program = analysis(text);
    for (from, to) in edits {
        assert!(!program.regions().is_empty() || program.text().starts_with("$$"));
        let at = program.text().find(from).unwrap();
        program = program.edit(at..at + from.len(), to);
        let fresh = analysis(&program.text());
        assert_eq!(program.regions(), fresh.regions(), "{}", program.text());
    }
}

/// Statements that are looked through between two questions whether to go on; one takes some microseconds.
const STATEMENTS_BETWEEN_QUESTIONS: usize = 512;

#[test]
fn what_is_told_of_a_long_text_asks_often() {
    let statements = 6_000;
    let text = "P1=POINT/1,2\n".repeat(statements);
    let program = analysis(&text);
    let asks = |what: &str, work: &dyn Fn(Cancel<'_>) -> Result<(), Cancelled>| {
        let asked = AtomicUsize::new(0);
        let until = |last: usize| work(&|| asked.fetch_add(1, Ordering::Relaxed) + 1 >= last);
        // What is kept is found out before.
        assert_eq!(until(usize::MAX), Ok(()));
        asked.store(0, Ordering::Relaxed);
        assert_eq!(until(usize::MAX), Ok(()));
        let all = asked.swap(0, Ordering::Relaxed);
        assert!(all * STATEMENTS_BETWEEN_QUESTIONS >= statements, "{all} questions of the {what}");
        for last in [1, all / 2] {
            asked.store(0, Ordering::Relaxed);
            assert_eq!(until(last), Err(Cancelled), "{what}");
            assert_eq!(asked.load(Ordering::Relaxed), last, "the {what} asks again after the answer");
        }
    };
    asks("outline", &|cancel| program.outline(cancel).map(drop));
    asks("folds", &|cancel| program.folds(cancel).map(drop));
    asks("lenses", &|cancel| program.lenses(cancel).map(drop));
    asks("tokens", &|cancel| program.tokens(None, cancel).map(drop));
    asks("style", &|cancel| {
        let waiting = Waiting::until(cancel);
        let options = FormatOptions::default();
        plan(program.document().tree(), &options, waiting.patience()).map(drop)
    });
    asks("expansion", &|cancel| program.expand(None, None, cancel).map(drop));
    asks("inlays", &|cancel| program.inlays(0..text.len(), cancel).map(drop));
}
