//! PRINT, PUNCH, READ, TITLES, REMARK and the system flags (language reference 1.5, 7.9, 7.10).

mod support;

use apt_program::{FindingKind, ListingKind, Program, Severity, Value};
use apt_syntax::DialectName;
use support::{problems, run_as};

fn run(text: &str) -> Program {
    run_as(text, DialectName::Free)
}

fn listed(program: &Program) -> Vec<String> {
    program.listing().flat_map(apt_program::ListingEntry::lines).collect()
}

fn values(program: &Program) -> Vec<(String, Value)> {
    program.symbols().into_iter().map(|(name, value)| (name.to_string(), value)).collect()
}

#[test]
fn print_lists_what_it_names() {
    let start = "RESERV/A,4,B,2\nX=2.5\nP=POINT/1,2,3\nA(1)=1\nA(2)=4\nA(4)=16\nB(1)=POINT/7,8";
    let cases: &[(&str, &[&str])] = &[
        ("PRINT/0", &["\u{c}"]),
        ("PRINT/3,X", &["X SCALAR 1", "  2.500000"]),
        ("PRINT/2,X,P", &["  2.500000", "  1.000000 2.000000 3.000000"]),
        ("PRINT/1,X", &["  4004000000000000"]),
        ("PRINT/3,NONE", &["NONE IS NOT DEFINED"]),
        ("PRINT/2,A(2)", &["  4.000000"]),
        ("PRINT/2,A(3)", &["A(3) IS NOT DEFINED"]),
        ("PRINT/2,A(2,THRU,4)", &["  4.000000", "A(3) IS NOT DEFINED", "  16.000000"]),
        ("PRINT/2,A(ALL,DECR,3)", &["  16.000000", "  1.000000"]),
        ("PRINT/3,B", &["B(1) POINT 3", "  7.000000 8.000000 0.000000"]),
        ("PRINT/3,(POINT/4,5,6)", &["NESTED POINT 3", "  4.000000 5.000000 6.000000"]),
        ("PRINT/3,(Q=POINT/4,5,6)", &["Q POINT 3", "  4.000000 5.000000 6.000000"]),
        ("PRINT/4,X", &["X SCALAR 1", "  2.500000", "X 0 SCALAR 1", "4004000000000000", "END"]),
        (
            "PRINT/ON\nC=CIRCLE/(1,2),(3,4),(5,7)\nPRINT/OFF\nD=POINT/1,1",
            &["NESTED POINT 3", "  1.000000 2.000000 0.000000"],
        ),
    ];
    for (text, expected) in cases {
        let program = run(&format!("{start}\n{text}"));
        let lines = listed(&program);
        let expected: Vec<&str> = expected.to_vec();
        if text.starts_with("PRINT/ON") {
            assert!(lines.iter().any(|line| line == "C CIRCLE 7"), "{lines:?}");
            assert!(!lines.iter().any(|line| line.starts_with('D')), "{lines:?}");
            continue;
        }
        assert_eq!(lines, expected, "{text}");
        // A name without a value is warned of, where the list names it itself.
        let warned = expected.iter().any(|line| line.ends_with("IS NOT DEFINED")) && !text.contains("THRU");
        assert_eq!(problems(&program).len(), usize::from(warned), "{text}: {:?}", problems(&program));
    }
}

#[test]
fn a_list_tells_names_that_have_no_value() {
    let told = |text: &str| {
        let program =
            run(&format!("RESERV/A,4\nPLANE1=PLANE/0,0,1,0\nA(1)=1\nBAD=1/0\nA(2)=1/0\n{text}\nFINI"));
        let names: Vec<String> = program
            .findings()
            .filter_map(|finding| match &finding.kind {
                FindingKind::ListedUndefined { name, similar } => {
                    assert_eq!(finding.severity, Severity::Warning);
                    Some(format!("{name} {similar:?}"))
                }
                _ => None,
            })
            .collect();
        names
    };
    assert_eq!(told("PRINT/2,PLANE2"), ["PLANE2 [\"PLANE1\"]"]);
    assert_eq!(told("PRINT/3,NIX(2)"), ["NIX []"]);
    assert_eq!(told("PRINT/2,A(3)"), ["A(3) []"]);
    assert_eq!(told("PUNCH/1,ZZZZ"), ["ZZZZ []"]);
    // What lost its value by a mistake was told there; elements of a range may be without.
    for text in
        ["PRINT/2,BAD", "PRINT/2,A(2)", "PRINT/2,A(1,THRU,4)", "PRINT/2,A", "PRINT/3,ALL", "PRINT/2,PLANE1"]
    {
        assert!(told(text).is_empty(), "{text}: {:?}", told(text));
    }
}

#[test]
fn print_all_lists_every_value_in_the_system_in_force() {
    let program =
        run("RESERV/A,9\nM=MATRIX/TRANSL,1,0,0\nREFSYS/M\nP=POINT/0,0,0\nREFSYS/NOMORE\nA(2)=5\nPRINT/3,ALL");
    let lines = listed(&program);
    assert!(lines.contains(&"A(2) SCALAR 1".to_owned()), "{lines:?}");
    let point = lines.iter().position(|line| line == "P POINT 3").expect("the point is listed");
    assert_eq!(lines[point + 1], "  1.000000 0.000000 0.000000");
}

#[test]
fn lists_come_in_order_of_execution_with_their_turn() {
    let program = run("M=MACRO/N\nI=0\nA)I=I+1\nPRINT/2,I\nIF(I-N)A,B,B\nB)TERMAC\nCALL/M,N=3");
    assert_eq!(listed(&program), ["  1.000000", "  2.000000", "  3.000000"]);
    let turns: Vec<u32> =
        program.listing().map(|entry| entry.origin.frame.as_ref().map_or(0, |frame| frame.turn)).collect();
    assert_eq!(turns, [1, 2, 3]);
}

#[test]
fn headings_and_remarks_are_listed_and_nothing_else() {
    let program = run("TITLES THE PART\nREMARK note\nPARTNO X");
    let kinds: Vec<&ListingKind> = program.listing().map(|entry| &entry.kind).collect();
    assert!(matches!(kinds.as_slice(), [ListingKind::Heading(_), ListingKind::Remark(_)]), "{kinds:?}");
    assert_eq!(program.record_count(), 2, "PARTNO and FINI");
}

#[test]
fn wrong_forms_of_lists_are_told() {
    let cases: &[(&str, &[(u32, u16)])] = &[
        ("PRINT/5", &[(1, 326)]),
        ("PRINT/-1", &[(1, 326)]),
        ("PRINT/1.5", &[(1, 326)]),
        ("PRINT", &[(1, 326)]),
        ("PUNCH/0,ALL", &[(1, 326)]),
        ("PUNCH/4,ALL", &[(1, 326)]),
        ("READ/3", &[(1, 326)]),
        ("PUNCH/3,(POINT/1,2)", &[(1, 2005)]),
        ("RESERV/A,3\nPRINT/3,A(4)", &[(2, 104)]),
        ("READ/1", &[(1, 2000)]),
        ("READ/1\nA 0 SCALAR 1", &[(1, 2000)]),
        ("A=POINT/1,2\nREAD/1\nA 0 SCALAR 1\n3FF0000000000000\nEND", &[(2, 2001)]),
        ("A=1\nREAD/1\nA 0 POINT 3\n3FF0000000000000 3FF0000000000000 3FF0000000000000\nEND", &[(2, 2001)]),
        ("RESERV/A,3\nREAD/1\nA 4 SCALAR 1\n3FF0000000000000\nEND", &[(2, 2004)]),
        ("READ/1\nA 4 SCALAR 1\n3FF0000000000000\nEND", &[(1, 108)]),
    ];
    for (text, expected) in cases {
        let mut found = problems(&run(text));
        // What follows a READ that found no dump is part of the program again.
        found.truncate(expected.len());
        let expected: Vec<(u32, Option<u16>)> =
            expected.iter().map(|(isn, number)| (*isn, Some(*number))).collect();
        assert_eq!(found, expected, "{text}");
    }
}

#[test]
fn what_punch_writes_read_takes_back() {
    let source = "RESERV/A,5\nX=1/3\nA(2)=-7\nA(5)=SQRTF(2)\nP=POINT/X,2,3\nC=CIRCLE/1,2,X\nM=MATRIX/XYROT,30\n\
                  T=TABCYL/NOZ,SPLINE,0,0,1,1,2,0,3,1\nPA=PATERN/LINEAR,P,(POINT/9,9,9),4\nPUNCH/1,ALL";
    let program = run(source);
    assert!(problems(&program).is_empty(), "{:?}", problems(&program));
    let cards = listed(&program);
    let text = format!("RESERV/A,5\nREAD/1\n{}\nY=X", cards.join("\n"));
    let again = run(&text);
    assert!(problems(&again).is_empty(), "{:?}", problems(&again));
    let mut expected = values(&program);
    expected.push(("Y".to_owned(), Value::Scalar(1.0 / 3.0)));
    assert_eq!(values(&again), expected);
}

#[test]
fn punch_selects_by_sort() {
    let start = "X=1\nP=POINT/1,2,3";
    let heads = |text: &str| -> Vec<String> {
        let program = run(&format!("{start}\n{text}"));
        listed(&program).into_iter().filter(|card| card.contains(' ') && !card.starts_with('3')).collect()
    };
    assert_eq!(heads("PUNCH/1,ALL").len(), 2);
    assert_eq!(heads("PUNCH/2,ALL"), ["X 0 SCALAR 1"]);
    assert_eq!(heads("PUNCH/3,X,P"), ["P 0 POINT 3"]);
}

#[test]
fn cards_follow_the_read_the_loop_or_the_call() {
    let card = |name: &str| format!("{name} 0 SCALAR 1\n3FF0000000000000\nEND");
    let cases = [
        format!("READ/1\n{}\nB=A+1", card("A")),
        format!("READ/1,A\n{}\nB=A+1", card("OTHER")),
        format!("LOOPST\nREAD/1\nB=A+1\nLOOPND\n{}", card("A")),
        format!("M=MACRO\nREAD/1\nB=A+1\nTERMAC\nCALL/M\n{}\nC=B", card("A")),
        format!("M=MACRO\nREAD/1\nTERMAC\nCALL/M\n{}\nCALL/M\n{}\nB=A+1", card("A"), card("A")),
        format!("LOOPST\nI=0\nL)READ/1\nI=I+1\nIF(I-2)L,E,E\nE)B=A+1\nLOOPND\n{}\n{}", card("A"), card("A")),
    ];
    for text in cases {
        let program = run(&text);
        assert!(problems(&program).is_empty(), "{text}: {:?}", problems(&program));
        let b = values(&program).into_iter().find(|(name, _)| name == "B");
        assert_eq!(b, Some(("B".to_owned(), Value::Scalar(2.0))), "{text}");
    }
}

#[test]
fn cards_stand_before_the_sequence_field() {
    let deck: String = ["READ/1", "A 0 SCALAR 1", "4000000000000000", "END", "B=A*2"]
        .iter()
        .enumerate()
        .map(|(number, text)| format!("{text:<72}{number:08}\n"))
        .collect();
    let program = run_as(&deck, DialectName::Apt3);
    let b = values(&program).into_iter().find(|(name, _)| name == "B");
    assert_eq!(b, Some(("B".to_owned(), Value::Scalar(4.0))));
}

#[test]
fn system_flags_are_checked() {
    let cases: &[(&str, &[Option<u16>])] = &[
        ("NOPOST", &[]),
        ("NOPLOT", &[]),
        ("CLPRNT", &[]),
        ("CLPRNT/ON", &[]),
        ("CLPRNT/OPTION", &[]),
        ("CLPRNT/3", &[Some(133)]),
        ("CLPRNT/ONN", &[Some(101)]),
        ("CLPRNT/ON,OFF", &[Some(129)]),
        ("CLTV/OPTION", &[]),
        ("CLTV/ON", &[Some(133)]),
        ("DAC/ON", &[]),
        ("DAC", &[Some(129)]),
        ("DEBUG/SEC1,ON", &[]),
        ("DEBUG/OFF", &[]),
        ("DEBUG/3", &[Some(22)]),
        ("DEBUG/SEC2", &[Some(22)]),
        ("DYNDMP/1,2,3,4", &[]),
        ("DYNDMP/1,2,3", &[Some(129)]),
        ("TUNEUP/2750,2225,2225", &[]),
        ("TUNEUP/1,2", &[Some(129)]),
        ("TUNEUP/1,2,3", &[None]),
        ("PTONLY/1", &[]),
        ("PTONLY/2", &[None]),
        ("PTONLY/3,7", &[None]),
        ("PTONLY/3", &[Some(129)]),
        ("PTONLY/9", &[Some(553)]),
        ("PTONLY/1,2", &[Some(553)]),
        ("PRINT/0", &[]),
        ("PRINT/1", &[Some(326)]),
        ("PRINT/3", &[Some(326)]),
        ("PRINT/4", &[Some(326)]),
        ("PUNCH/1", &[Some(326)]),
        ("PUNCH/3,ALL", &[]),
        ("LTV", &[None]),
        ("MIT", &[None]),
        ("CMIT", &[None]),
        ("TANCRV", &[None]),
    ];
    for (text, expected) in cases {
        let found: Vec<Option<u16>> = problems(&run(text)).into_iter().map(|(_, number)| number).collect();
        assert_eq!(found, *expected, "{text}");
    }
    let kind = |text: &str| run(text).findings().map(|finding| finding.kind.clone()).next();
    assert!(matches!(kind("PTONLY/9"), Some(FindingKind::OperandRange { value: 9.0, .. })));
    assert!(matches!(kind("PTONLY/1,2"), Some(FindingKind::OperandCount { found: 2, .. })));
    assert!(matches!(kind("CLPRNT/ONN"), Some(FindingKind::UndefinedOption { .. })));
    let warned = run("TANCRV");
    assert!(warned.findings().any(|finding| matches!(finding.kind, FindingKind::NoEffect { .. })));
}
