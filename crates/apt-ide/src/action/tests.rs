//! Each kind of action on small programs.

use std::sync::Arc;

use super::*;
use crate::{Settings, format::applied};

fn analysis(text: &str) -> Analysis {
    let settings = Settings { dialect: Some("free".to_owned()), ..Settings::default() };
    Analysis::new(text, None, &Arc::new(settings))
}

/// Titles and the text after each action of a kind at a piece of the text.
fn offered(text: &str, at: &str, kind: ActionKind) -> Vec<(String, String)> {
    let start = text.find(at).unwrap();
    let actions =
        analysis(text).actions(start..start, &[kind], Level::Section1, &|| false, &mut |_, _| {}).unwrap();
    assert!(actions.iter().all(|action| action.kind == kind));
    actions.into_iter().map(|action| (action.title, applied(text, &action.edits))).collect()
}

#[test]
fn findings_can_be_fixed_or_allowed() {
    let text = "$$ apt-lsp: dialect=free\nPARTNO X\n  P=POINT/1 2,3\nGOTO/P\nFINI\n";
    let expected = [
        ("Insert the comma", text.replace("1 2", "1,2")),
        ("Write 12 without blanks", text.replace("1 2", "12")),
        ("Allow APT0952 in this statement", text.replace("  P=", "  $$ apt-lsp: allow APT0952\n  P=")),
        (
            "Allow APT0952 in the whole program",
            text.replace("PARTNO", "$$ apt-lsp: allow-file APT0952\nPARTNO"),
        ),
    ];
    let found = offered(text, "1 2", ActionKind::QuickFix);
    assert_eq!(found, expected.map(|(title, new)| (title.to_owned(), new)));
    assert_eq!(offered(text, "GOTO", ActionKind::QuickFix), [], "another place");
    for (title, new) in found {
        let left = analysis(&new).diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap();
        assert_eq!(left, [], "after {title}");
    }
}

#[test]
fn errors_can_be_fixed_and_not_allowed() {
    let text = "PNT1=POINT/1,2\nGOTO/PNT2\nFINI\n";
    let found = offered(text, "PNT2", ActionKind::QuickFix);
    assert_eq!(found, [("Replace PNT2 by PNT1".to_owned(), text.replace("PNT2", "PNT1"))]);
}

#[test]
fn all_certain_fixes_are_applied_at_once() {
    let text = "PNT1=POINT/1,2\nGOTO/PNT2\nP=POINT/1 2,3 $$ apt-lsp: allow APT0999\nGOTO/P";
    let found = offered(text, "GOTO", ActionKind::FixAll);
    let new = "PNT1=POINT/1,2\nGOTO/PNT1\nP=POINT/1 2,3\nGOTO/P\nFINI\n";
    assert_eq!(found, [("Apply all certain fixes".to_owned(), new.to_owned())]);
    assert_eq!(offered(new, "GOTO", ActionKind::FixAll), []);
}

#[test]
fn calls_and_loops_are_written_out_when_that_means_the_same() {
    let text = "M=MACRO/A,B=2\nGOTO/A,B,0\nGODLTA/0,0,A\nTERMAC\nFROM/0,0,0\nCALL/M,A=1\nGOTO/0,0,0\nFINI\n";
    let found = offered(text, "CALL", ActionKind::Inline);
    let new = text.replace("CALL/M,A=1\n", "GOTO/1,2,0\nGODLTA/0,0,1\n");
    assert_eq!(found, [("Write out the call of M".to_owned(), new)]);
    // In the lines of the file, with what is said beside the call.
    let remarked = text.replace("A=1\n", "A=1 $$ the first pass\n").replace('\n', "\r\n");
    let new = "M=MACRO/A,B=2\nGOTO/A,B,0\nGODLTA/0,0,A\nTERMAC\nFROM/0,0,0\n$$ the first pass\nGOTO/1,2,0\n\
               GODLTA/0,0,1\nGOTO/0,0,0\nFINI\n";
    let found = offered(&remarked, "CALL", ActionKind::Inline);
    assert_eq!(found, [("Write out the call of M".to_owned(), new.replace('\n', "\r\n"))]);
    // A variable that only the loop has used is no reason against it.
    let counted = "FROM/0,0,0\nI=0\nLOOPST\nL1)I=I+1\nGOTO/I,0,0\nIF(I-2)L1,L2,L2\nL2)LOOPND\nFINI\n";
    let new = "FROM/0,0,0\nI=0\nI=0+1\nGOTO/1,0,0\nI=1+1\nGOTO/2,0,0\nFINI\n";
    let found = offered(counted, "LOOPST", ActionKind::Inline);
    assert_eq!(found, [("Write out the loop".to_owned(), new.to_owned())]);
    assert_eq!(offered(text, "GOTO/0,0,0", ActionKind::Inline), []);
    assert_eq!(
        offered("FROM/0,0,0\nCALL/M9\nFINI\n", "CALL", ActionKind::Inline),
        [],
        "there is no such macro"
    );
}

/// What is said in a loop or a macro is said again in each turn and each call, where it was: on a line of its own or behind
/// the statement. Of statements that leave none, and of those that were left out, the same holds.
#[test]
fn what_is_said_inside_is_written_out_with_the_statements() {
    let counted = "FROM/0,0,0\nI=0\nLOOPST $$ two moves\n$$ count up\nL1)I=I+1\n\n  $$ go there\nGOTO/I,0,$ from here\n  0 $$ a move\n\
                   GODLTA/1 $$ and up\nIF(I-2)L3,L2,L2 $$ again?\n$$ never\nGODLTA/9 $$ at all\n$$ once more\nL3)JUMPTO/L1\n\
                   $$ the end\nL2)LOOPND $$ done\nFINI\n";
    let turn = |before: &str, after: &str| {
        format!(
            "$$ count up\nI={before}+1\n$$ go there\n$$ from here\n$$ a move\nGOTO/{after},0,0\nGODLTA/1 $$ and up\n$$ again?\n"
        )
    };
    let (first, second) = (turn("0", "1"), turn("1", "2"));
    let new =
        format!("FROM/0,0,0\nI=0\n$$ two moves\n{first}$$ once more\n{second}$$ the end\n$$ done\nFINI\n");
    let found = offered(counted, "LOOPST", ActionKind::Inline);
    assert_eq!(found, [("Write out the loop".to_owned(), new)]);

    let called =
        "M=MACRO/A $$ up\n$$ first\nGOTO/A,0,0 $$ there\nTERMAC $$ over\nFROM/0,0,0\nCALL/M,A=1\nFINI\n";
    let found = offered(called, "CALL", ActionKind::Inline);
    let new = called.replace("CALL/M,A=1\n", "$$ first\nGOTO/1,0,0 $$ there\n$$ over\n");
    assert_eq!(found, [("Write out the call of M".to_owned(), new)]);
}

#[test]
fn labels_are_renumbered_with_the_jumps_to_them() {
    let text =
        "A=0\nLOOPST\n7)A=A+1\nIF(A-2)7,3,03\n3)A=A\nLOOPND\nGOTO/A,0,0\n3)GOTO/0,0,0\nJUMPTO/3\nFINI\n";
    let whole = "A=0\nLOOPST\n10)A=A+1\nIF(A-2)10,20,20\n20)A=A\nLOOPND\nGOTO/A,0,0\n30)GOTO/0,0,0\nJUMPTO/30\nFINI\n";
    let offers = |text: &str, from: &str, to: &str| {
        let range = text.find(from).unwrap()..text.find(to).unwrap();
        let kinds = [ActionKind::Renumber];
        let actions =
            analysis(text).actions(range, &kinds, Level::Section1, &|| false, &mut |_, _| {}).unwrap();
        actions.into_iter().map(|one| (one.title, applied(text, &one.edits))).collect::<Vec<_>>()
    };
    let expected = |title: &str, text: &str| [(title.to_owned(), text.to_owned())];
    assert_eq!(offers(text, "7)A", "7)A"), expected("Renumber all labels", whole));
    // Of those chosen the first one is 10; the others keep theirs.
    let some = text.replace("7)A", "10)A").replace("IF(A-2)7", "IF(A-2)10");
    assert_eq!(offers(text, "7)A", "IF("), expected("Renumber the label", &some));
    // Where nothing is numbered, or all of it already is, there is nothing to do.
    assert_eq!(offers(text, "A=0", "A=0"), []);
    assert_eq!(offers(whole, "10)A", "10)A"), []);
    // A number that a jump names without a label keeps meaning nothing.
    let lost = "JUMPTO/10\n5)GOTO/0,0,0\nFINI\n";
    let found = offers(lost, "5)", "5)");
    assert_eq!(found, expected("Renumber all labels", &lost.replace("5)", "20)")));
}
