//! Completion: what is proposed at each kind of place.

#![allow(
    clippy::unwrap_used,
    clippy::needless_pass_by_value,
    reason = "tests fail where something is missing, and say what they expect in place"
)]

mod support;

use apt_ide::completion::CompletionKind;
use expect_test::{Expect, expect};

use support::{marked, never};

/// The labels proposed at the mark, after an evaluation.
fn labels(text: &str) -> Vec<String> {
    let (analysis, offset) = marked(text);
    analysis.program(&never).unwrap();
    analysis.completions(offset, &|| false).unwrap().into_iter().map(|item| item.label).collect()
}

fn check(text: &str, expected: Expect) {
    expected.assert_eq(&labels(text).join(" "));
}

const NAMES: &str =
    "P1=POINT/1,2\nP2=POINT/3,4\nL1=LINE/P1,P2\nC1=CIRCLE/0,0,5\nA=2\nM1=MACRO/DX,DY\nTERMAC\n";

#[test]
fn a_statement_begins_with_a_verb() {
    let all = labels("$0\n");
    for word in ["GOLFT", "PARTNO", "FEDRAT", "CALL", "FINI"] {
        assert!(all.contains(&word.to_owned()), "{word}");
    }
    for word in ["POINT", "ATANGL", "SINF"] {
        assert!(!all.contains(&word.to_owned()), "{word}");
    }
    check("GOL$0\n", expect!["GOLFT"]);
    check("A) GOL$0\n", expect!["GOLFT"]);
}

#[test]
fn a_value_is_a_type_a_function_a_macro_or_a_name() {
    let all = labels(&format!("{NAMES}X=$0\nFINI\n"));
    for word in ["POINT", "SINF", "MACRO", "P1", "A"] {
        assert!(all.contains(&word.to_owned()), "{word}");
    }
    assert!(!all.contains(&"GOLFT".to_owned()));
}

#[test]
fn parameters_of_a_definition_follow_its_forms() {
    check(
        &format!("{NAMES}X=LINE/$0\nFINI\n"),
        expect![
            "P1 P2 A ABSF ANGLB ANGLF ARCOSB ARCOSF ARSINB ARSINF ATAN2B ATAN2F ATANB ATANF CANF COSB COSF COSHF COTANB COTANF DISTF DOTF EXPF INTF LNTHF LOG10F LOGF MAXF MINF MODF NUMF SIGNF SINB SINF SINHF SPATF SQRTF TANB TANF TANHF RIGHT LEFT XAXIS YAXIS PARLEL INTOF SLOPE ATANGL"
        ],
    );
    check(
        &format!("{NAMES}X=LINE/P1,$0\nFINI\n"),
        expect!["P1 P2 RIGHT LEFT ATANGL SLOPE PARLEL PERPTO TANTO"],
    );
    check(&format!("{NAMES}X=LINE/P1,ATANGL,A,$0\nFINI\n"), expect!["L1 XAXIS YAXIS"]);
    check(&format!("{NAMES}X=LINE/P1,AT$0\nFINI\n"), expect!["ATANGL"]);
    check(
        &format!("{NAMES}X=LINE/(POINT/1,2),$0\nFINI\n"),
        expect!["P1 P2 RIGHT LEFT ATANGL SLOPE PARLEL PERPTO TANTO"],
    );
    check(
        &format!("{NAMES}X=POINT/$0\nFINI\n"),
        expect![
            "C1 A ABSF ANGLB ANGLF ARCOSB ARCOSF ARSINB ARSINF ATAN2B ATAN2F ATANB ATANF CANF COSB COSF COSHF COTANB COTANF DISTF DOTF EXPF INTF LNTHF LOG10F LOGF MAXF MINF MODF NUMF SIGNF SINB SINF SINHF SPATF SQRTF TANB TANF TANHF INTOF XLARGE XSMALL YLARGE YSMALL CENTER RTHETA THETAR"
        ],
    );
    check(&format!("{NAMES}X=POINT/INTOF,$0\nFINI\n"), expect!["L1"]);
    check(&format!("{NAMES}X=CIRCLE/CENTER,P1,$0\nFINI\n"), expect!["P1 P2 RADIUS TANTO LARGE SMALL"]);
}

#[test]
fn a_call_takes_macros_and_their_variables() {
    check(&format!("{NAMES}CALL/$0\nFINI\n"), expect!["M1"]);
    check(&format!("{NAMES}CALL/M1,$0\nFINI\n"), expect!["DX DY"]);
    check(&format!("{NAMES}CALL/M1,DX=1,DY$0\nFINI\n"), expect!["DY"]);
}

#[test]
fn modifiers_are_those_of_the_verb() {
    let all = labels("GOLFT/L1,$0\n");
    assert!(all.contains(&"PAST".to_owned()) && !all.contains(&"CLW".to_owned()), "{all:?}");
    let all = labels("SPINDL/100,$0\n");
    assert!(all.contains(&"CLW".to_owned()) && !all.contains(&"PAST".to_owned()), "{all:?}");
}

#[test]
fn statements_ask_for_what_their_forms_take_next() {
    check(&format!("{NAMES}GOLFT/$0\nFINI\n"), expect!["C1 L1"]);
    check(
        &format!("{NAMES}GOLFT/C1,$0\nFINI\n"),
        expect![
            "C1 L1 A ABSF ANGLB ANGLF ARCOSB ARCOSF ARSINB ARSINF ATAN2B ATAN2F ATANB ATANF CANF COSB COSF COSHF COTANB COTANF DISTF DOTF EXPF INTF LNTHF LOG10F LOGF MAXF MINF MODF NUMF SIGNF SINB SINF SINHF SPATF SQRTF TANB TANF TANHF TO ON PAST TANTO DSTAN PSTAN INTOF"
        ],
    );
    check(&format!("{NAMES}GOLFT/C1,PAST,2,$0\nFINI\n"), expect!["INTOF"]);
    check(&format!("{NAMES}SPINDL/800,$0\nFINI\n"), expect!["CLW CCLW"]);
    check(
        &format!("{NAMES}GOTO/$0\nFINI\n"),
        expect![
            "P1 P2 A ABSF ANGLB ANGLF ARCOSB ARCOSF ARSINB ARSINF ATAN2B ATAN2F ATANB ATANF CANF COSB COSF COSHF COTANB COTANF DISTF DOTF EXPF INTF LNTHF LOG10F LOGF MAXF MINF MODF NUMF SIGNF SINB SINF SINHF SPATF SQRTF TANB TANF TANHF"
        ],
    );
    check(&format!("{NAMES}TRACUT/$0\nFINI\n"), expect!["NOMORE"]);
    check(&format!("{NAMES}CALL/M1,DX=$0\nFINI\n"), expect!["C1 L1 P1 P2 A"]);
}

#[test]
fn snippets_ask_for_parameters_unless_they_stand_there() {
    let snippet = |text: &str, label: &str| {
        let (analysis, offset) = marked(&format!("M1=MACRO/DX,DY=2\nTERMAC\n{text}\nFINI\n"));
        analysis.program(&never).unwrap();
        let item = analysis
            .completions(offset, &|| false)
            .unwrap()
            .into_iter()
            .find(|item| item.label == label)
            .unwrap();
        item.snippet.unwrap_or_default()
    };
    assert_eq!(snippet("GOL$0", "GOLFT"), "GOLFT/${1:ds}$0");
    assert_eq!(snippet("GOL$0/C1", "GOLFT"), "");
    assert_eq!(snippet("C1=CIR$0", "CIRCLE"), "CIRCLE/${1:x},${2:y},${3:r}$0");
    assert_eq!(snippet("A=SIN$0", "SINF"), "SINF(${1:x})$0");
    assert_eq!(snippet("CALL/$0", "M1"), "M1,DX=${1:DX}$0");
    assert_eq!(snippet("CALL/M1,$0", "DY"), "DY=${1:2}$0");
    assert_eq!(snippet("CALL/M1,DY$0=3", "DY"), "");
    assert_eq!(snippet("FIN$0", "FINI"), "");
}

#[test]
fn nothing_is_proposed_in_comments_and_text() {
    for text in ["$$ GO$0\n", "P1=POINT/1,2 $$ GO$0\n", "PARTNO GO$0\n"] {
        assert_eq!(labels(text), Vec::<String>::new(), "{text:?}");
    }
}

#[test]
fn names_are_known_while_an_edit_is_not_evaluated_yet() {
    let (analysis, offset) = marked(&format!("{NAMES}X=LINE/$0\nFINI\n"));
    analysis.program(&never).unwrap();
    let edited = analysis.edit(offset..offset, "P");
    assert!(edited.document().evaluated().is_none());
    let items = edited.completions(offset + 1, &|| false).unwrap();
    let names: Vec<_> = items.iter().filter(|item| item.kind == CompletionKind::Name).collect();
    assert_eq!(names.iter().map(|item| item.label.as_str()).collect::<Vec<_>>(), ["P1", "P2"]);
    assert!(edited.document().evaluated().is_none(), "completion has evaluated");
}

#[test]
fn the_nearest_names_are_chosen_from_very_many() {
    let many: String = (0..2_000).map(|n| format!("P{n}=POINT/{n},0\n")).collect();
    let all = labels(&format!("{many}X=LINE/P$0\nFINI\n"));
    assert!(all.contains(&"P1999".to_owned()) && !all.contains(&"P7".to_owned()));
    assert!(all.len() < 600, "{}", all.len());
}

#[test]
fn sculptured_statements_offer_what_may_come_next() {
    const NAMES: &str = "$$ apt-lsp: dialect=apt4\nP1=POINT/0,0,0\nP2=POINT/2,0,0\nV1=VECTOR/0,0,1\n\
        CV=SCURV/SPLINE,P1,P2\nSS=SSURF/RULED,CV,AXIS,V1\nPL=PLANE/0,0,1,5\n";
    for (text, expected) in [
        ("SMIL/$0", &["POSN", "PATH", "ZIGZAG", "PICKFD"][..]),
        ("SMIL/PATH,DS,PARAM,0,0,$0", &["TANSPL", "CRSSPL"]),
        ("SCON/DS,$0", &["SS", "CV"]),
        ("SCON/PS,TO,$0", &["SS"]),
        ("SCON/FEED,$0", &["PL"]),
        ("CHKSRF/$0", &["PS", "SS"]),
        ("X=SSURF/REVOLV,CV,AXIS,P1,V1,$0", &["CLW", "CCLW"]),
        ("X=POINT/INTOF,$0", &["SS", "CV", "PL"]),
        ("X=VECTOR/INTOF,SS,PARAM,0,0,1,$0", &["TANSPL", "CRSSPL", "NORMAL"]),
        ("X=PARMF($0", &["UVAL", "VVAL", "PVAL", "TVAL", "SVAL"]),
    ] {
        let (analysis, offset) = marked(&format!("{NAMES}{text}\nFINI\n"));
        analysis.program(&never).unwrap();
        let offers: Vec<String> =
            analysis.completions(offset, &|| false).unwrap().into_iter().map(|one| one.label).collect();
        for word in expected {
            assert!(offers.iter().any(|offer| offer == word), "{text} offers {offers:?}");
        }
    }
}
