//! Definitions, references and renaming of names, labels and variables of macros.

#![allow(
    clippy::unwrap_used,
    clippy::needless_pass_by_value,
    reason = "tests fail where something is missing, and say what they expect in place"
)]

mod support;

use apt_ide::navigation::RenameError;
use expect_test::{Expect, expect};

use support::marked;

/// The text with every occurrence of the name at the mark in brackets, those that define it in braces.
fn check_occurrences(text: &str, expected: Expect) {
    let (analysis, offset) = marked(text);
    let mut shown = analysis.text();
    for one in analysis.occurrences(offset, &|| false).unwrap().into_iter().rev() {
        let (open, close) = if one.defines { ("{", "}") } else { ("[", "]") };
        shown.insert_str(one.range.end, close);
        shown.insert_str(one.range.start, open);
    }
    expected.assert_eq(&shown);
}

fn renamed(text: &str, new: &str) -> Result<String, RenameError> {
    let (analysis, offset) = marked(text);
    let mut shown = analysis.text();
    for (range, insert) in analysis.rename(offset, new, &|| false)?.into_iter().rev() {
        shown.replace_range(range, &insert);
    }
    Ok(shown)
}

#[test]
fn names_are_found_whatever_their_case_and_place() {
    check_occurrences(
        "P1=POINT/1,2\nL1=LINE/p1,(P2=POINT/3,4)\nP1$0=POINT/5,6\nL2=LINE/P 1,P2 $$ P1\nPPRINT P1\nFINI\n",
        expect![[r#"
            {P1}=POINT/1,2
            L1=LINE/[p1],(P2=POINT/3,4)
            {P1}=POINT/5,6
            L2=LINE/[P 1],P2 $$ P1
            PPRINT P1
            FINI
        "#]],
    );
}

#[test]
fn nested_definitions_define() {
    check_occurrences(
        "L1=LINE/P1,(P$02=POINT/3,4)\nL2=LINE/P2,P1\nFINI\n",
        expect![[r#"
        L1=LINE/P1,({P2}=POINT/3,4)
        L2=LINE/[P2],P1
        FINI
    "#]],
    );
}

#[test]
fn labels_belong_to_their_loop() {
    check_occurrences(
        "LOOPST\nA=1\nB$01) A=A+1\nIF(A-5)B1,C1,C1\nC1) LOOPND\nLOOPST\nB1) A=A+1\nJUMPTO/B1\nLOOPND\nFINI\n",
        expect![[r#"
            LOOPST
            A=1
            {B1}) A=A+1
            IF(A-5)[B1],C1,C1
            C1) LOOPND
            LOOPST
            B1) A=A+1
            JUMPTO/B1
            LOOPND
            FINI
        "#]],
    );
}

#[test]
fn variables_belong_to_their_macro() {
    check_occurrences(
        "M1=MACRO/DX,DY\nGODLTA/D$0X,DY,0\nTERMAC\nM2=MACRO/DX\nGODLTA/DX,0,0\nTERMAC\nDX=3\nCALL/M1,DX=DX,DY=1\nFINI\n",
        expect![[r#"
            M1=MACRO/{DX},DY
            GODLTA/[DX],DY,0
            TERMAC
            M2=MACRO/DX
            GODLTA/DX,0,0
            TERMAC
            DX=3
            CALL/M1,[DX]=DX,DY=1
            FINI
        "#]],
    );
    check_occurrences(
        "M1=MACRO/DX,DY\nGODLTA/DX,DY,0\nTERMAC\nD$0X=3\nCALL/M1,DX=DX,DY=1\nFINI\n",
        expect![[r#"
            M1=MACRO/DX,DY
            GODLTA/DX,DY,0
            TERMAC
            {DX}=3
            CALL/M1,DX=[DX],DY=1
            FINI
        "#]],
    );
}

#[test]
fn subscripted_names_are_one_name() {
    check_occurrences(
        "RESERV/T,3\nT(1)=POINT/1,2\nT$0(2)=POINT/3,4\nL=LINE/T(1),T(2)\nFINI\n",
        expect![[r#"
        RESERV/{T},3
        {T}(1)=POINT/1,2
        {T}(2)=POINT/3,4
        L=LINE/[T](1),[T](2)
        FINI
    "#]],
    );
}

#[test]
fn the_definition_in_force_comes_first() {
    let text = "A=1\nB=A\nA=2\nC=A$0\nA=3\nFINI\n";
    let (analysis, offset) = marked(text);
    let lines: Vec<usize> = analysis
        .definitions_at(offset, &|| false)
        .unwrap()
        .iter()
        .map(|range| text[..range.start].lines().count())
        .collect();
    assert_eq!(lines, [2, 0, 4]);
}

#[test]
fn a_rename_changes_every_occurrence_and_nothing_else() {
    let text = "P1=POINT/1,2\nL1=LINE/P$01,(POINT/3,4)\nPPRINT P1\nFINI\n";
    expect![[r#"
        corner=POINT/1,2
        L1=LINE/corner,(POINT/3,4)
        PPRINT P1
        FINI
    "#]]
    .assert_eq(&renamed(text, "corner").unwrap());
    let label = "LOOPST\nA) B=1\nJUMPTO/A$0\nLOOPND\nA=4\nFINI\n";
    expect![[r#"
        LOOPST
        10) B=1
        JUMPTO/10
        LOOPND
        A=4
        FINI
    "#]]
    .assert_eq(&renamed(label, "10").unwrap());
}

#[test]
fn a_rename_that_would_change_the_meaning_is_refused() {
    let text = "P1=POINT/1,2\nP2=POINT/1,2\nL1=LINE/P$01,P2\nFINI\n";
    assert_eq!(renamed(text, "P2"), Err(RenameError::InUse("P2".into())));
    assert_eq!(renamed(text, "goto"), Err(RenameError::Word("GOTO".into())));
    for wrong in ["", "1", "A B", "A-1", "Ä"] {
        assert!(matches!(renamed(text, wrong), Err(RenameError::NotAName { .. })), "{wrong:?}");
    }
    assert_eq!(renamed("$0$$ A\n", "B"), Err(RenameError::NoName));
}

/// Section 1 takes the unit for a word, and the machine for what it is called, whatever has that name.
#[test]
fn units_and_machines_are_no_names() {
    let text = "MM=3\nFANUC=4\nMACHIN/FANUC\nUNITS/MM\nP1=POINT/MM,FANUC\nFINI\n";
    let with_mark = |before: &str| text.replacen(before, &format!("{before}$0"), 1);
    assert_eq!(
        renamed(&with_mark("POINT/M"), "XX").unwrap(),
        "XX=3\nFANUC=4\nMACHIN/FANUC\nUNITS/MM\nP1=POINT/XX,FANUC\nFINI\n"
    );
    assert_eq!(
        renamed(&with_mark("MM,F"), "XX").unwrap(),
        "MM=3\nXX=4\nMACHIN/FANUC\nUNITS/MM\nP1=POINT/MM,XX\nFINI\n"
    );
    for word in ["UNI", "UNITS/M", "MACHIN/FA"] {
        assert_eq!(renamed(&with_mark(word), "XX"), Err(RenameError::NoName), "{word}");
    }
    let (analysis, offset) = marked("FEDRAT/10,I$0PM\nFINI\n");
    assert_eq!(analysis.name_at(offset), None);
}
