//! What is made of a long program, or asked at a place of it.

use apt_ide::{
    Analysis, Cancel, Cancelled,
    conversion::{ClDialect, ConversionError, Converted},
    navigation::RenameError,
    tape::{ClTapeError, ControlTape, TapeError},
};
use apt_tests::runs;

use super::{asks_often, never, silent};

/// A program of the standard dialect.
fn analysis(text: &str) -> Analysis {
    runs::analysis(text, "free")
}

/// The control tape; nothing but a cancellation is awaited.
fn tape(program: &Analysis, cancel: Cancel<'_>) -> Result<ControlTape, Cancelled> {
    program.tape("linuxcnc", cancel, &mut silent).map_err(|error| match error {
        TapeError::Cancelled(cancelled) => cancelled,
        other => panic!("{other}"),
    })
}

/// The program in another dialect, likewise.
fn converted(program: &Analysis, cancel: Cancel<'_>) -> Result<Converted, Cancelled> {
    program.convert(ClDialect::Nx, None, cancel, &mut silent).map_err(|error| match error {
        ConversionError::Cancelled(cancelled) => cancelled,
        other => panic!("{other}"),
    })
}

#[test]
fn what_is_made_of_a_path_asks_at_each_look_at_its_records() {
    let records = 6_000;
    let gotos: String = (0..records).map(|number| format!("GOTO/{number},{},0\n", number % 7)).collect();
    let text = format!("FEDRAT/10,IPM\nSPINDL/1000,CLW\n{gotos}FINI\n");
    let program = analysis(&text);
    program.result(&never, &mut silent).unwrap();
    // The records of Section 1 are looked at for conditions of milling, those of the path for positions.
    let first = text.find("GOTO").unwrap();
    asks_often(2 * records, "a hover of a position", |cancel| program.hover(first, cancel));
    // The lints of the path look at the statements too.
    asks_often(3 * records, "a control tape", |cancel| tape(&program, cancel));
    asks_often(3 * records, "a tool path", |cancel| program.tool_path(cancel, &mut silent));
    asks_often(records, "a CL text", |cancel| program.cl_text(cancel, &mut silent));
    asks_often(records, "a CL tape", |cancel| {
        program.cl_tape(cancel, &mut silent).map_err(|error| match error {
            ClTapeError::Cancelled(cancelled) => cancelled,
            other => panic!("{other}"),
        })
    });
    asks_often(3 * records, "a file in another dialect", |cancel| converted(&program, cancel));
}

#[test]
fn statements_that_are_unrolled_are_gone_through_with_questions() {
    let turns = 6_000;
    let text = format!("LOOPST\nA=0\nM)A=A+1\nGOTO/A,0,0\nIF(A-{turns})M,N,N\nN)B=A\nLOOPND\nFINI\n");
    let unrolled = analysis(&text);
    // Three statements a turn: traced, written, read again, and laid out.
    asks_often(4 * 3 * turns, "the expansion of a loop", |cancel| unrolled.expand(None, None, cancel));
    let points: String = (0..turns).map(|number| format!("P{number}=POINT/{number},5\n")).collect();
    let flat = analysis(&points);
    asks_often(4 * turns, "the expansion of statements", |cancel| flat.expand(None, None, cancel));
}

#[test]
fn what_is_made_of_copies_asks_at_each_look_at_them() {
    let (positions, times) = (100, 60);
    let records = positions * times;
    let gotos: String = (0..positions).map(|number| format!("GOTO/{number},{},0\n", number % 7)).collect();
    let program = analysis(&format!("FROM/0,0,0\nINDEX/1\n{gotos}COPY/1,TRANSL,0,1,0,{times}\nFINI\n"));
    program.result(&never, &mut silent).unwrap();
    asks_often(2 * records, "a control tape of copies", |cancel| tape(&program, cancel));
    asks_often(2 * records, "copies in another dialect", |cancel| converted(&program, cancel));
}

#[test]
fn a_cl_file_is_read_with_questions() {
    let lines = 6_000;
    let text: String = (0..lines).map(|number| format!("GOTO/{number},{},0\n", number % 7)).collect();
    let file = runs::analysis(&text, "cl");
    // Statements, the statements of lines, records, and the records again as a path.
    asks_often(4 * lines, "a tool path", |cancel| file.tool_path(cancel, &mut silent));
}

#[test]
fn what_is_asked_at_a_place_of_a_long_program_asks_often() {
    let points = 20_000;
    let mut text = "P=POINT/0,0\n".to_owned();
    text.extend((0..points).map(|number| format!("P{number}=POINT/{number},5\nGOTO/P\n")));
    text += "GOTO/P";
    let program = analysis(&text);
    program.program(&never).unwrap();
    // The name stands in every other statement; of the others only the text is looked at.
    asks_often(points, "occurrences", |cancel| program.occurrences(0, cancel));
    asks_often(points, "definitions", |cancel| program.definitions_at(0, cancel));
    asks_often(points, "a new name", |cancel| {
        program.rename(0, "Q", cancel).map_err(|error| match error {
            RenameError::Cancelled(cancelled) => cancelled,
            other => panic!("{other}"),
        })
    });
    asks_often(points, "proposals", |cancel| program.completions(text.len(), cancel));
    asks_often(points, "a hover", |cancel| program.hover(0, cancel));
}

#[test]
fn what_is_asked_at_a_place_of_a_short_program_is_answered_before_the_first_question() {
    let text = "P=POINT/0,0\nGOTO/P";
    let program = analysis(text);
    program.program(&never).unwrap();
    let given_up = || true;
    assert_eq!(program.occurrences(0, &given_up).map(|found| found.len()), Ok(2));
    assert_eq!(program.rename(0, "Q", &given_up).map(|edits| edits.len()), Ok(2));
    assert!(!program.completions(text.len(), &given_up).unwrap().is_empty());
}
