//! Patterns and the lists of their points, canonical values with skipped positions (language reference 4.17, 4.18, 6.2
//! and 7.7): numbers worked out by hand.

mod support;

use apt_geometry::motion::MotionCommand;
use apt_program::{Program, RecordKind, Value, record::PostArgument};
use apt_syntax::DialectName;
use support::{problems, run_as};

fn run(text: &str) -> Program {
    run_as(text, DialectName::Free)
}

/// Where the tool goes, as `x,y` or `x,y,z`, with the words of CYCLE between.
fn path(program: &Program) -> String {
    let steps = program.records().filter_map(|record| match &record.kind {
        RecordKind::Motion(command) => match &**command {
            MotionCommand::GoTo { position, .. } if position.z == 0.0 => {
                Some(format!("{},{}", position.x, position.y))
            }
            MotionCommand::GoTo { position, .. } => {
                Some(format!("{},{},{}", position.x, position.y, position.z))
            }
            other => Some(format!("{other:?}")),
        },
        RecordKind::Postprocessor { arguments, .. } => match arguments.first() {
            Some(PostArgument::Word(word, _)) => Some(word.to_string()),
            other => Some(format!("{other:?}")),
        },
        _ => None,
    });
    steps.collect::<Vec<_>>().join(" ")
}

/// A row of three, and the same row at two heights: forth and back.
const GRID: &str = "A=PATERN/LINEAR,(0,0),(2,0),3\nP=PATERN/PARLEL,A,(VECTOR/0,1,0),2\n";
/// Five points on the x axis, and point numbers in an array.
const ROW: &str = "P=PATERN/LINEAR,(0,0),(4,0),5\nRESERV/N,3\nN(1)=1\nN(2)=3\nN(3)=4\n";

/// Statements after a head, and the path.
const PATHS: &[(&str, &str, &str)] = &[
    // Forms of the definition.
    ("", "P=PATERN/LINEAR,(0,0),(VECTOR/2,1,0),4\nGOTO/P", "0,0 2,1 4,2 6,3"),
    ("", "P=PATERN/LINEAR,(1,1),(VECTOR/0,3,0),INCR,3,AT,2\nGOTO/P", "1,1 1,3 1,5 1,7"),
    ("", "P=PATERN/LINEAR,(0,0),(VECTOR/9,0,0),INCR,1,2,3\nGOTO/P", "0,0 1,0 3,0 6,0"),
    ("", "P=PATERN/LINEAR,(0,0),(VECTOR/9,0,0),INCR,1,2,AT,2,.5\nGOTO/P", "0,0 1,0 3,0 5,0 5.5,0"),
    ("", "P=PATERN/ARC,(CIRCLE/0,0,2),0,90,CCLW,2\nGOTO/P", "2,0 0,2"),
    ("", "P=PATERN/CIRCUL,(CIRCLE/0,0,2),90,0,CLW,2\nGOTO/P", "0,2 2,0"),
    ("", "ZSURF/0,0,1,5\nP=PATERN/ARC,(CIRCLE/0,0,2),0,CCLW,INCR,2,AT,90\nGOTO/P", "2,0,5 0,2,5 -2,0,5"),
    ("", "P=PATERN/ARC,(CIRCLE/0,0,2),180,CLW,INCR,90,90\nGOTO/P", "-2,0 0,2 2,0"),
    (GRID, "GOTO/P", "0,0 1,0 2,0 2,1 1,1 0,1"),
    (GRID, "B=PATERN/LINEAR,(5,5),(5,9),3\nQ=PATERN/GRID,A,B\nGOTO/Q,RETAIN,3,4,7", "2,0 2,2 0,4"),
    (GRID, "Q=PATERN/PARLEL,A,(VECTOR/0,2,0),INCR,1,3\nGOTO/Q,RETAIN,1,4,7", "0,0 2,1 0,4"),
    (GRID, "Q=PATERN/RANDOM,(9,9),A,(7,7)\nGOTO/Q", "9,9 0,0 1,0 2,0 7,7"),
    // Order, and what the numbers refer to.
    (ROW, "GOTO/P,INVERS", "4,0 3,0 2,0 1,0 0,0"),
    (GRID, "GOTO/P,ZIGZAG", "0,0 1,0 2,0 0,1 1,1 2,1"),
    (GRID, "GOTO/P,INVERS,ZIGZAG", "2,1 1,1 0,1 2,0 1,0 0,0"),
    (GRID, "GOTO/P,INVERS,RETAIN,1,6", "0,1 0,0"),
    (GRID, "GOTO/P,INVERS,CONST,RETAIN,6,1", "0,1 0,0"),
    (GRID, "GOTO/P,ZIGZAG,RETAIN,4", "0,1"),
    (GRID, "GOTO/P,ZIGZAG,CONST,RETAIN,4", "2,1"),
    (GRID, "GOTO/P,ZIGZAG,CONST,OMIT,2,THRU,3,6,THRU,5", "0,0 2,1"),
    // Lists.
    (ROW, "GOTO/P,OMIT,1,3,THRU,4", "1,0 4,0"),
    (ROW, "GOTO/P,OMIT,1,OMIT,3,THRU,4", "1,0 4,0"),
    (ROW, "GOTO/P,RETAIN,2,THRU,2,RETAIN,5", "1,0 4,0"),
    (ROW, "GOTO/P,RETAIN,2.9", "1,0"),
    (ROW, "GOTO/P,OMIT,N(ALL)", "1,0 4,0"),
    (ROW, "GOTO/P,RETAIN,N(1,THRU,ALL,INCR,2),5", "0,0 3,0 4,0"),
    (ROW, "GOTO/P,INVERS,CONST,RETAIN,N(ALL,DECR,1)", "3,0 2,0 0,0"),
    (ROW, "GOTO/P,OMIT,N(2),THRU,N(3)", "0,0 1,0 4,0"),
    // AVOID lifts at the point and at the next one that is visited.
    (ROW, "GOTO/P,OMIT,1,2,AVOID,7,4", "2,0 3,0 NOMORE 3,0,7 4,0,7 ON 4,0"),
    (ROW, "GOTO/P,AVOID,7,1,OMIT,2,THRU,4", "0,0 NOMORE 0,0,7 4,0,7 ON 4,0"),
    (
        ROW,
        "GOTO/P,OMIT,1,AVOID,7,2,OMIT,4,5,AVOID,8,3",
        // The last list goes back behind 5.
        "",
    ),
    (
        ROW,
        "GOTO/P,RETAIN,1,2,3,AVOID,7,1,AVOID,8,2",
        "0,0 NOMORE 0,0,7 1,0,7 ON 1,0 NOMORE 1,0,8 2,0,8 ON 2,0",
    ),
    (ROW, "GOTO/P,AVOID,7,1,RETAIN,1,3", "0,0 NOMORE 0,0,7 2,0,7 ON 2,0"),
    (ROW, "GOTO/P,RETAIN,1,2,AVOID,7,2", "0,0 1,0"),
    (
        ROW,
        "GOTO/P,INVERS,OMIT,3,THRU,5,AVOID,7,1",
        // AVOID goes back behind 5.
        "",
    ),
    (ROW, "GOTO/P,INVERS,AVOID,7,1,OMIT,3,THRU,5", "4,0 NOMORE 4,0,7 3,0,7 ON 3,0"),
];

/// Statements after a head, and the APT III number at the last of them.
const MISTAKES: &[(&str, &str, u16)] = &[
    (ROW, "GOTO/P,OMIT,0", 812),
    (ROW, "GOTO/P,OMIT,-1", 812),
    (ROW, "GOTO/P,OMIT,6", 812),
    (ROW, "GOTO/P,OMIT,2,THRU,6", 812),
    (ROW, "GOTO/P,OMIT,1,AVOID,7,3,RETAIN,2", 811),
    (ROW, "GOTO/P,OMIT,2,THRU", 836),
    (ROW, "GOTO/P,OMIT,THRU,2", 836),
    (ROW, "GOTO/P,AVOID", 836),
    (ROW, "GOTO/P,AVOID,7", 836),
    (ROW, "GOTO/P,RETAIN,1,THRU,3,2", 838),
    (ROW, "GOTO/P,OMIT,3,THRU,2", 838),
    (ROW, "GOTO/P,OMIT,2,AVOID,7,2", 838),
    (ROW, "GOTO/P,OMIT,4,AVOID,7,1", 838),
    (ROW, "GOTO/P,AVOID,7,3,OMIT,2", 838),
    (ROW, "GOTO/P,RETAIN,1,AVOID,7,2", 838),
    (ROW, "GOTO/P,RETAIN,N(ALL,DECR,1)", 838),
    (ROW, "GOTO/P,INVERS,CONST,RETAIN,1,3", 838),
    (ROW, "GOTO/P,OMIT,2,CONST", 833),
    (GRID, "GOTO/P,OMIT,2,ZIGZAG", 833),
    (GRID, "GOTO/P,ZIGZAG,ZIGZAG", 834),
    (GRID, "GOTO/P,ZIGZAG,CONST,OMIT,3,THRU,4", 837),
    (GRID, "GOTO/P,ZIGZAG,OMIT,2,THRU,5", 837),
    (GRID, "GOTO/P,INVERS,ZIGZAG,RETAIN,3,THRU,4", 837),
    (GRID, "Q=PATERN/PARLEL,P,(VECTOR/1,0,0),2", 801),
    (GRID, "Q=PATERN/LINEAR,(0,0),(1,1),900000", 802),
    (GRID, "GOTO/P,A", 831),
];

#[test]
fn the_points_of_a_pattern_come_in_the_order_that_the_statement_says() {
    let mut wrong = String::new();
    for (head, text, expected) in PATHS {
        let program = run(&format!("{head}{text}"));
        let (found, problems) = (path(&program), problems(&program));
        let refused = expected.is_empty();
        if found != *expected || (problems.iter().map(|problem| problem.1).ne(refused.then_some(Some(838)))) {
            wrong.push_str(&format!("{text}: expected {expected}, found {found} {problems:?}\n"));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn mistakes_in_the_lists_of_a_pattern_have_their_numbers() {
    let mut wrong = String::new();
    for (head, text, number) in MISTAKES {
        let program = run(&format!("{head}{text}"));
        let isn = u32::try_from(head.lines().count() + text.lines().count()).expect("few statements");
        let found = problems(&program);
        if found != [(isn, Some(*number))] {
            wrong.push_str(&format!("{text}: expected {number} at {isn}, found {found:?}\n"));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// Statements that give X, Y and Z, and their values; `None` is a name that gets none.
const TAKEN_APART: &[(&str, [Option<f64>; 3])] = &[
    ("C=CIRCLE/1,2,3\nOBTAIN,CIRCLE/C,X,,,,,,Z", [Some(1.0), None, Some(3.0)]),
    ("C=CIRCLE/1,2,3\nOBTAIN/CIRCLE/C,,Y", [None, Some(2.0), None]),
    ("X=9\nP=POINT/4,5,6\nOBTAIN,POINT/P,,,Z", [Some(9.0), None, Some(6.0)]),
    (
        "C=CIRCLE/1,2,3\nD=CIRCLE/C,CANON,,,,,,,.25\nOBTAIN,CIRCLE/D,X,Y,,,,,Z",
        [Some(1.0), Some(2.0), Some(0.25)],
    ),
    ("C=CIRCLE/1,2,3\nD=CIRCLE/C,CANON,7\nOBTAIN,CIRCLE/D,X,Y,,,,,Z", [Some(7.0), Some(2.0), Some(3.0)]),
    ("P=POINT/1,2,3\nQ=POINT/P,CANON,,8\nOBTAIN,POINT/Q,X,Y,Z", [Some(1.0), Some(8.0), Some(3.0)]),
    ("L=LINE/CANON,0,1,0,5\nM=LINE/L,CANON,3,4\nOBTAIN,LINE/M,X,Y,,Z", [Some(0.6), Some(0.8), Some(1.0)]),
    ("RESERV/W,2\nC=CIRCLE/1,2,3\nOBTAIN,CIRCLE/C,,W(2)\nX=W(2)", [Some(2.0), None, None]),
];

#[test]
fn skipped_positions_of_canonical_values_are_left_alone() {
    let mut wrong = String::new();
    for (text, expected) in TAKEN_APART {
        let program = run(text);
        let symbols = program.symbols();
        for (name, expected) in ["X", "Y", "Z"].iter().zip(expected) {
            let found = symbols.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone());
            let right = match (&found, expected) {
                (None, None) => true,
                (Some(Value::Scalar(found)), Some(expected)) => (found - expected).abs() < 1e-15,
                _ => false,
            };
            if !right {
                wrong.push_str(&format!("{text}: {name} is {found:?}, not {expected:?}\n"));
            }
        }
        let found = problems(&program);
        if !found.is_empty() {
            wrong.push_str(&format!("{text}: {found:?}\n"));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn mistakes_in_canonical_values_have_their_numbers() {
    for (text, expected) in [
        ("P=POINT/1,2\nOBTAIN,POINT/P,,,,W", 154),
        ("P=POINT/1,2\nQ=POINT/P,CANON,,,,4", 84),
        ("P=POINT/1,2\nQ=POINT/P,CANON,,P", 83),
        ("P=POINT/1,2\nQ=LINE/P,CANON,1", 80),
        ("C=CIRCLE/1,2,3\nQ=CIRCLE/C,CANON,,,,,,,0", 1005),
        ("L=LINE/XAXIS\nQ=LINE/L,CANON,0,0", 1005),
    ] {
        assert_eq!(problems(&run(text)), [(2, Some(expected))], "{text}");
    }
}
