//! Cards: columns, blanks, continuation, texts, numbers, names and labels as APT III reads them (language reference 1.1 to
//! 1.9 and 2.1 to 2.5).

mod support;

use apt_program::Program;
use apt_syntax::DialectName;
use support::{problems, run_as, scalar};

fn run(text: &str) -> Program {
    run_as(text, DialectName::Apt3)
}

/// A card: statement field and sequence field.
fn card(statement: &str, sequence: &str) -> String {
    format!("{statement:<72}{sequence}")
}

/// A program in which nothing is wrong, a name, and its value.
const VALUES: &[(&str, &str, f64)] = &[
    // Blanks, case, tabs.
    ("A C=7", "AC", 7.0),
    ("a=3\nB=A+1", "B", 4.0),
    ("W=2 3", "W", 23.0),
    ("X Y=5\nZ=X Y", "Z", 5.0),
    ("\tA\t=\t1\t2", "A", 12.0),
    // Continuation and comments.
    ("AB$\nCD=12$\n34", "ABCD", 1234.0),
    ("A=1$ commentary, =)\n+2", "A", 3.0),
    ("A=1$\n$ nothing yet\n+2", "A", 3.0),
    ("X=2 $$ a $$ b", "X", 2.0),
    ("X=2 $ $ the two signs may stand apart", "X", 2.0),
    ("$$ only a remark\n\nX=2", "X", 2.0),
    // Texts.
    ("PARTNO A=5\nA=1", "A", 1.0),
    ("PPRINTA=5 $\nA=1", "A", 1.0),
    ("REMARKABLE=3\nA=1", "A", 1.0),
    ("insert/A=2\nA=1", "A", 1.0),
    // Numbers.
    ("A=1.", "A", 1.0),
    ("A=.01E2", "A", 1.0),
    ("A=1.E+2", "A", 100.0),
    ("A=10.E2", "A", 1000.0),
    ("A=.5E-1", "A", 0.05),
    ("A=.E2", "A", 0.0),
    ("10E2=4\nA=10E2", "A", 4.0),
    ("A=0000000000000000000012", "A", 12.0),
    ("A=1234567890123456", "A", 1_234_567_890_123_456.0),
    // Names and labels.
    ("12A=6\nB=12A", "B", 6.0),
    ("LOOPST\nJUMPTO/1\nA=9\n01)A=2\nLOOPND", "A", 2.0),
    ("LOOPST\nA1)A=2\nEND1)LOOPND", "A", 2.0),
    // Arithmetic.
    ("A=-2**2", "A", 4.0),
    ("B=2\nA=-B**2", "A", 4.0),
    ("B=2\nA=3-B**2", "A", -1.0),
    ("A=2*-3", "A", -6.0),
    ("A=2**-1", "A", 0.5),
    ("A=2**3**2", "A", 512.0),
    ("A=8/2/2", "A", 2.0),
    ("B=3\nA=B**2/4*3", "A", 6.75),
    ("A=(-8)**3", "A", -512.0),
    ("A=2**3.0000001", "A", 8.0),
    ("A=SQRTF(ABSF(-16))+1", "A", 5.0),
    ("B=(D=3)+2", "B", 5.0),
    ("RESERV/A,3\nA(1.9)=4\nB=A(1)", "B", 4.0),
    ("RESERV/3,A,4,C\nC(4)=4\nB=C(4)", "B", 4.0),
    ("RESERV/A,3\nA(1)=1\nA(A(1)+1)=7\nB=A(2)", "B", 7.0),
];

#[test]
fn cards_say_what_they_say_in_apt_iii() {
    let mut wrong = Vec::new();
    for (text, name, expected) in VALUES {
        let program = run(text);
        let (found, told) = (scalar(&program, name), problems(&program));
        let near = found.is_some_and(|found| (found - expected).abs() <= 1e-6 * expected.abs());
        let told: Vec<_> = told.into_iter().filter(|(_, number)| number.is_some()).collect();
        if !near || !told.is_empty() {
            wrong.push(format!("{text:?}: {name} = {found:?}, not {expected}; {told:?}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// A program without FINI, and the problems as (statement, number).
const MISTAKES: &[(&str, &[(u32, u16)])] = &[
    ("A=1$\n$$ ends the statement\n+2", &[(1 + 1, 5)]),
    ("  PARTNO X", &[(1, 21)]),
    ("A;B=1", &[(1, 8)]),
    ("A=12345678901234567", &[(1, 2)]),
    ("A=1.2.3", &[(1, 20)]),
    ("A=B.5", &[(1, 20)]),
    ("A=10E2", &[(1, 101)]),
    ("A=5E", &[(1, 101)]),
    ("LONGNAME=3", &[(1, 1)]),
    ("TANTO=3", &[(1, 155)]),
    ("XX)", &[(1, 11)]),
    ("XX) $$ text", &[(1, 11)]),
    ("GOTO)A=1", &[(1, 17)]),
    ("A=1\nA)B=2", &[(2, 3)]),
    ("A)B=1\nA)B=2", &[(2, 6)]),
    (",A=3", &[(1, 5)]),
    ("COPY/", &[(1, 11)]),
    ("NOSUCH/3", &[(1, 82)]),
    ("A1", &[(1, 82)]),
    ("POINT/1,2", &[(1, 76)]),
    ("TANTO", &[(1, 76)]),
    ("SEC1", &[(1, 76)]),
    ("RAPID,A=1", &[(1, 81)]),
    ("SPINDL/3+4", &[(1, 7)]),
    ("A=(2+3)(4+5)", &[(1, 7)]),
    ("A=2(3)", &[(1, 7)]),
    ("A=--5", &[(1, 54)]),
    ("A=1/0", &[(1, 63)]),
    ("A=(-8)**.5", &[(1, 68)]),
    ("A=SQRTF(-4)", &[(1, 67)]),
    ("FINI,", &[(1, 23)]),
    ("IF=3", &[(1, 78)]),
    ("RESERV/A,(2+1)", &[(1, 255)]),
    ("RESERV/A,3\nRESERV/A,4", &[(2, 256)]),
    ("RESERV/A,3,4,B", &[(1, 255)]),
];

#[test]
fn mistakes_on_cards_have_their_numbers() {
    let mut wrong = Vec::new();
    for (text, expected) in MISTAKES {
        let found: Vec<_> = problems(&run(text)).into_iter().filter(|(_, number)| number.is_some()).collect();
        let expected: Vec<_> = expected.iter().map(|(isn, number)| (*isn, Some(*number))).collect();
        if found != expected {
            wrong.push(format!("{text:?}: expected {expected:?}, found {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn columns_73_to_80_are_no_part_of_a_statement() {
    let deck = [card("A=1", "=)$0010"), card("B=A$", "+7"), card("  +2", "ABC"), card("C=3", "$")].join("\n");
    let program = run(&deck);
    assert_eq!(problems(&program), []);
    let values: Vec<_> = ["A", "B", "C"].iter().map(|name| scalar(&program, name)).collect();
    assert_eq!(values, [Some(1.0), Some(3.0), Some(3.0)]);
    // What runs past column 72 is cut, which is an error only where the rest is no statement.
    let long = format!("A={}1+2", " ".repeat(68));
    let program = run(&long);
    assert_eq!((scalar(&program, "A"), problems(&program)), (None, vec![(1, Some(11)), (1, None)]));
}

#[test]
fn statements_are_counted_by_records_that_continue_none() {
    let text = "$$ remark\n\nA=1$\n+2\nPARTNO X\nB=NIX";
    assert_eq!(problems(&run(text)), [(5, Some(101))]);
}
