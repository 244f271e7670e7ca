//! Inlay hints and growing selections.

#![allow(clippy::unwrap_used, reason = "tests fail where something is missing")]

mod support;

use support::{analysis, marked, never};

#[test]
fn values_stand_behind_the_statements_that_compute_them() {
    let text = "A=2\nB=A*3 $$ six\nP1=POINT/1,2\nP2=POINT/B,A,1\nRESERV/T,3\nT(2)=POINT/A,0\nLOOPST\nC=1\n\
                D) C=C+A\nIF(C-5)D,E,E\nE) LOOPND\nFINI\n";
    let program = analysis(text);
    let shown = |range| {
        let inlays = program.inlays(range, &never).unwrap();
        let line = |offset: usize| text[..offset].matches('\n').count() + 1;
        inlays.iter().map(|one| format!("{}: {}", line(one.offset), one.text)).collect::<Vec<_>>()
    };
    let all = shown(0..text.len());
    assert_eq!(all, ["2: = 6", "4: = point (6, 2, 1)", "6: = point (2, 0, 0)", "9: = 5 (the last of 2)"]);
    let second = text.find("B=").unwrap();
    assert_eq!(shown(second..second + 1), ["2: = 6"]);
    assert!(text[..program.inlays(0..10, &never).unwrap()[0].offset].ends_with("A*3"), "before the comment");
    assert!(program.inlays(0..0, &never).unwrap().is_empty());
}

#[test]
fn selections_grow_from_the_word_to_the_program() {
    let (program, offset) = marked("M1=MACRO/DX\nA) L1=LINE/(POINT/1,D$0X),ATANGL,30 $$ x\nTERMAC\nFINI\n");
    let text = program.text();
    let grown: Vec<&str> = program.selections(offset).into_iter().map(|range| &text[range]).collect();
    let statement = "A) L1=LINE/(POINT/1,DX),ATANGL,30 $$ x";
    let expected = [
        "DX",
        "1,DX",
        "POINT/1,DX",
        "(POINT/1,DX)",
        "(POINT/1,DX),ATANGL,30",
        "LINE/(POINT/1,DX),ATANGL,30",
        "L1=LINE/(POINT/1,DX),ATANGL,30",
        statement,
        &format!("{statement}\n"),
        "M1=MACRO/DX\nA) L1=LINE/(POINT/1,DX),ATANGL,30 $$ x\nTERMAC\n",
        text.as_str(),
    ];
    assert_eq!(grown, expected);
    assert!(analysis("").selections(0).is_empty());
}

#[test]
fn elements_of_an_array_tell_their_own_values() {
    for (index, x) in [(1, 5), (2, 7)] {
        let text = "RESERV/T,3\nT(1)=POINT/5,0\nT(2)=POINT/7,0\nI=2\nGOTO/T(1)\nGOTO/T(2)\nFINI\n";
        let (program, offset) =
            marked(&text.replace(&format!("GOTO/T({index})"), &format!("GOTO/$0T({index})")));
        let hover = program.hover(offset, &never).unwrap().unwrap().markdown;
        assert!(hover.contains(&format!("T({index})")) && hover.contains(&format!("({x}, 0, 0)")), "{hover}");
    }
    let text = "RESERV/T,3\nT(1)=POINT/5,0\nT(2)=POINT/7,0\nI=1\nGOTO/$0T(I)\nGOTO/T(2)\nFINI\n";
    let (program, offset) = marked(text);
    let hover = program.hover(offset, &never).unwrap().unwrap().markdown;
    assert!(hover.contains("T(1)"), "{hover}");
}
