//! A wrong and a right sample of every lint.

use apt_program::{Options, evaluate};
use apt_syntax::{Dialect, DialectName};

use super::*;
use crate::format::applied;

fn lints_of(text: &str, dialect: DialectName) -> Vec<Lint> {
    let tree = SyntaxTree::parse(text, Dialect::named(dialect));
    lint(&tree, &evaluate(&tree, &Options::default(), &|| false))
}

/// Code and text of the lints.
fn found(text: &str) -> Vec<(&'static str, &str)> {
    lints_of(text, DialectName::Free).into_iter().map(|lint| (lint.code, &text[lint.range])).collect()
}

/// The text after all fixes.
fn fixed(text: &str) -> String {
    let edits: Vec<Edit> = lints_of(text, DialectName::Free).into_iter().flat_map(|lint| lint.fix).collect();
    applied(text, &edits)
}

const PART: &str = "L1=LINE/0,0,10,0\nL2=LINE/10,-5,10,5\nL3=LINE/0,-5,0,5\nPL=PLANE/0,0,1,0\nFROM/-2,-2,0\n";

#[test]
fn text_behind_column_72() {
    let long = format!("A=1{}\nFINI\n", "+1".repeat(40));
    assert_eq!(found(&long), [(PAST_COLUMN_72, "+1+1+1+1+1+")].map(|(code, _)| (code, &long[72..83])));
    let once = fixed(&long);
    assert!(once.lines().all(|line| line.len() <= 72), "{once}");
    assert_eq!(found(&once), []);
    assert_eq!(found(&format!("A=1 $$ {}\nFINI\n", "+1".repeat(40))), []);
    assert_eq!(found(&format!("PARTNO {}\nFINI\n", "+1".repeat(40))), []);
}

#[test]
fn blanks_where_a_comma_may_be_missing() {
    let text = "P=POINT/1 2,3\nPRINT/3,P\nFINI\n";
    assert_eq!(found(text), [(MISSING_COMMA, "1 2")]);
    assert_eq!(fixed(text), "P=POINT/1,2,3\nPRINT/3,P\nFINI\n");
    let text = "A=1\nB=2\nAB=3\nP=POINT/A B,2\nFINI\n";
    assert_eq!(found(text), [(MISSING_COMMA, "A B")]);
    assert_eq!(found("A=1 000\nP=POINT/1$\n2,3\nFINI\n"), []);
}

#[test]
fn tolerances_as_wide_as_the_cutter() {
    let part = |tolerance: &str| {
        format!("{PART}CUTTER/.5\n{tolerance}\nGO/TO,L1,TO,PL,TO,L3\nTLLFT,GORGT/L1,PAST,L2\nFINI\n")
    };
    assert_eq!(found(&part("INTOL/.5")), [(LOOSE_TOLERANCE, "INTOL/.5")]);
    assert_eq!(found(&part("OUTTOL/.01")), []);
}

#[test]
fn curved_part_surface_without_tolerances() {
    let part = |tolerance: &str| {
        format!(
            "S=SPHERE/0,0,0,5\nL1=PLANE/0,1,0,0\nL2=PLANE/1,0,0,3\nFROM/0,0,9\nCUTTER/.5,.25\n{tolerance}\n\
             GO/ON,L1,TO,S,ON,(PLANE/1,0,0,0)\nINDIRV/1,0,0\nTLON,GOFWD/L1,ON,L2\nFINI\n"
        )
    };
    assert_eq!(found(&part("INTOL/.001")), []);
    let text = part("$$");
    assert_eq!(found(&text), [(TOLERANCE_MISSING, "GOFWD/L1,ON,L2")]);
}

#[test]
fn cutting_without_a_feed() {
    let part = |machine: &str, feed: &str| {
        format!("{machine}\n{PART}CUTTER/.5\n{feed}\nGO/TO,L1,TO,PL,TO,L3\nTLLFT,GORGT/L1,PAST,L2\nFINI\n")
    };
    let text = part("MACHIN/X,1", "$$");
    assert_eq!(found(&text), [(FEED_MISSING, "GORGT/L1,PAST,L2")]);
    assert_eq!(found(&part("MACHIN/X,1", "FEDRAT/10")), []);
    assert_eq!(found(&part("$$", "$$")), [], "no machine, no feed");
}

#[test]
fn thickness_that_no_motion_feels() {
    let part = |side: &str, check: &str| {
        format!("{PART}CUTTER/.5\nTHICK/0,.1\nGO/ON,L1,TO,PL,ON,L3\n{side},GORGT/L1,{check},L2\nFINI\n")
    };
    assert_eq!(found(&part("TLON", "ON")), [(THICKNESS_WITHOUT_EFFECT, "THICK/0,.1")]);
    assert_eq!(found(&part("TLLFT", "ON")), []);
    assert_eq!(found(&part("TLON", "PAST")), [], "the last value holds for the check surface too");
}

#[test]
fn directions_one_after_the_other() {
    let part = |between: &str| {
        format!("{PART}CUTTER/.5\nINDIRV/1,0,0\n{between}\nINDIRV/0,1,0\nGO/TO,L1,TO,PL,TO,L3\nFINI\n")
    };
    assert_eq!(found(&part("$$")), [(DIRECTION_WITHOUT_EFFECT, "INDIRV/1,0,0")]);
    assert_eq!(found(&part("GO/TO,L3,TO,PL,TO,L1")), []);
}

#[test]
fn one_tool_with_two_cutters() {
    let part = |tool: &str| {
        format!("LOADTL/1\nCUTTER/.5\nFROM/0,0,0\nGOTO/1,1,1\nLOADTL/{tool}\nCUTTER/.25\nGOTO/2,2,2\nFINI\n")
    };
    assert_eq!(found(&part("1")), [(CUTTER_AND_TOOL, "CUTTER/.25")]);
    assert_eq!(found(&part("2")), []);
}

#[test]
fn comments_allow_what_was_looked_at() {
    let comma = "P=POINT/1 2,3";
    assert_eq!(found(&format!("{comma} $$ apt-lsp: allow APT0952\nPRINT/3,P\nFINI\n")), []);
    assert_eq!(found(&format!("$$ apt-lsp: allow APT0951, apt0952\n{comma}\nPRINT/3,P\nFINI\n")), []);
    assert_eq!(found(&format!("{comma}\nPRINT/3,P\nFINI\n$$ apt-lsp: allow-file APT0952\n")), []);
    assert_eq!(found(&format!("{comma} $$ apt-lsp: allow APT0951\nPRINT/3,P\nFINI\n")).len(), 1);
}

#[test]
fn codes_ascend() {
    assert!(CODES.is_sorted() && CODES.iter().all(|code| code.starts_with("APT095")));
}
