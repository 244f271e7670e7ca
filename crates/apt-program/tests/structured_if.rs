//! IF over several statements in the dialect `free`.

mod support;

use apt_program::{
    ControlFinding, Finding, FindingKind, Options, Program, RecordKind, Severity, evaluate, expand,
};
use apt_syntax::{Dialect, DialectName, SyntaxTree, TextRange};
use support::scalar;

fn tree(text: &str) -> SyntaxTree {
    SyntaxTree::parse(&format!("{text}\nFINI\n"), Dialect::named(DialectName::Free))
}

fn run(text: &str) -> Program {
    evaluate(&tree(text), &Options::default(), &|| false)
}

fn problems(program: &Program) -> Vec<(u32, String)> {
    let serious = program.findings().filter(|finding| finding.severity >= Severity::Warning);
    serious.map(|finding: &Finding| (finding.origin.isn, finding.kind.to_string())).collect()
}

/// Which branch is taken, told by R.
const GRADES: &str =
    "R=0\nIF(A.LT.1)THEN\nR=1\nELSEIF(A.LT.2)THEN\nR=2\nELSEIF(A.LT.3)THEN\nR=3\nELSE\nR=4\nENDIF";

#[test]
fn exactly_one_branch_is_taken() {
    for (value, branch) in [(0.0, 1.0), (1.0, 2.0), (2.5, 3.0), (3.0, 4.0), (9.0, 4.0)] {
        for text in [
            format!("A={value}\n{GRADES}"),
            format!("LOOPST\nA={value}\n{GRADES}\nLOOPND"),
            format!("M=MACRO/A\n{GRADES}\nTERMAC\nCALL/M,A={value}"),
            format!("A={value};{}", GRADES.replace('\n', ";")),
        ] {
            let program = run(&text);
            assert_eq!(problems(&program), [], "{text}");
            assert_eq!(scalar(&program, "R"), Some(branch), "{text}");
        }
    }
}

#[test]
fn conditions_may_be_joined_and_turned_round() {
    for (condition, holds) in [
        ("A.EQ.1.AND.B.EQ.2", true),
        ("A.EQ.1.AND.B.EQ.3", false),
        ("A.EQ.2.OR.B.EQ.2", true),
        (".NOT.A.EQ.1", false),
        (".NOT.(A.EQ.1.AND.B.EQ.3)", true),
        (".NOT.A.EQ.1.OR.B.EQ.2", true),
        ("A.NE.1.OR.A.EQ.1.AND.B.GE.2", true),
    ] {
        let program = run(&format!("A=1\nB=2\nR=0\nIF({condition})THEN\nR=1\nENDIF"));
        assert_eq!(problems(&program), [], "{condition}");
        assert_eq!(scalar(&program, "R"), Some(f64::from(u8::from(holds))), "{condition}");
    }
}

#[test]
fn ifs_nest_in_each_other_and_in_loops() {
    let nested = "N=0\nDO/E,I=1,4\nIF(I.GT.1)THEN\nIF(I.LT.3)THEN\nN=N+10\nELSE\nN=N+100\nENDIF\nELSE\nN=N+1\nENDIF\nE)CONTIN";
    for text in [
        nested.to_owned(),
        format!("M=MACRO\n{nested}\nTERMAC\nCALL/M"),
        format!("LOOPST\n{nested}\nLOOPND"),
        nested
            .replace("E)CONTIN", "")
            .replace("ENDIF\nELSE\nN=N+1\nENDIF\n", "ENDIF\nELSE\nN=N+1\nE)ENDIF\n"),
        format!("IF(1.EQ.1)THEN\n{nested}\nENDIF"),
        format!("IF(1.EQ.1)THEN\nLOOPST\n{nested}\nLOOPND\nELSE\nN=5\nENDIF"),
    ] {
        let program = run(&text);
        assert_eq!(problems(&program), [], "{text}");
        assert_eq!(scalar(&program, "N"), Some(211.0), "{text}");
    }
    let jumps = "K=0\nLOOPST\nA)K=K+1\nIF(K.LT.5)THEN\nJUMPTO/A\nELSE\nJUMPTO/B\nENDIF\nB)LOOPND";
    let program = run(jumps);
    assert_eq!((problems(&program), scalar(&program, "K")), (Vec::new(), Some(5.0)));
}

#[test]
fn macros_and_motions_depend_on_conditions() {
    let program = run("M=MACRO/X,W\nIF(X.GT.0)THEN\nW/X,0,0\nELSE\nFEDRAT/5\nENDIF\nTERMAC\n\
                       FROM/0,0,0\nCALL/M,X=3,W=GOTO\nCALL/M,X=-3,W=GOTO");
    assert_eq!(problems(&program), []);
    let motions = program.records().filter(|record| matches!(record.kind, RecordKind::Motion(_)));
    assert_eq!(motions.map(|record| record.origin.isn).collect::<Vec<_>>(), [8, 3]);
}

/// Program and the findings as (statement, text).
const MISTAKES: &[(&str, &[(u32, &str)])] = &[
    ("ELSE", &[(1, "ELSE without an IF")]),
    ("A=1\nELSEIF(A.EQ.1)THEN\nENDIF", &[(2, "ELSEIF without an IF"), (3, "ENDIF without an IF")]),
    ("LOOPST\nENDIF\nLOOPND", &[(2, "ENDIF without an IF")]),
    ("M=MACRO\nELSE\nTERMAC", &[(2, "ELSE without an IF")]),
    ("IF(1.EQ.1)THEN\nA=1", &[(1, "IF without ENDIF")]),
    ("LOOPST\nIF(1.EQ.1)THEN\nA=1\nLOOPND\nENDIF", &[(2, "IF without ENDIF"), (5, "ENDIF without an IF")]),
    ("IF(1.EQ.1)THEN\nLOOPST\nENDIF\nLOOPND", &[(1, "IF without ENDIF"), (3, "ENDIF without an IF")]),
    ("IF(1.EQ.1)THEN\nELSE\nELSE\nENDIF", &[(3, "ELSE behind ELSE")]),
    ("IF(1.EQ.1)THEN\nELSE\nELSEIF(1.EQ.2)THEN\nENDIF", &[(3, "ELSEIF behind ELSE")]),
    ("IF(Q.EQ.1)THEN\nA=1\nELSE\nA=2\nENDIF", &[(1, "Q is not defined")]),
    ("IF(1.EQ)THEN\nA=1\nELSE\nA=2\nENDIF", &[(1, "syntax: RelationMissing")]),
    (
        "LOOPST\nIF(1.EQ.1)THEN\nA)X=1\nELSE\nJUMPTO/A\nB)ENDIF\nJUMPTO/A\nLOOPND",
        &[(5, "a jump to A inside of an IF"), (7, "a jump to A inside of an IF")],
    ),
    (
        "M=MACRO/L\nJUMPTO/L\nIF(1.EQ.2)THEN\nA)X=1\nENDIF\nTERMAC\nCALL/M,L=A",
        &[(2, "a jump to A inside of an IF")],
    ),
    ("LOOPST\nIF(1.EQ.2)THEN\nJUMPTO/B\nENDIF\nJUMPTO/B\nX=1\nB)LOOPND", &[(6, "never reached")]),
    (
        "DO/E,I=1,3\nIF(I.EQ.1)THEN\nE)X=I\nENDIF",
        &[(1, "the DO loop to E begins and ends in different branches")],
    ),
    (
        "LOOPST\nIF(1.EQ.1)THEN\nDO/E,I=1,3\nENDIF\nE)LOOPND",
        &[(3, "the DO loop to E begins and ends in different branches")],
    ),
];

#[test]
fn mistakes_are_told_where_they_are() {
    let mut wrong = Vec::new();
    for (text, expected) in MISTAKES {
        let found = problems(&run(text));
        let expected: Vec<_> = expected.iter().map(|(isn, text)| (*isn, (*text).to_owned())).collect();
        if found != expected {
            wrong.push(format!("{text:?}\n  expected {expected:?}\n  found    {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn an_unknown_condition_leaves_a_gap_where_the_tool_moves() {
    let gaps = |text: &str| -> Vec<u32> {
        let program = run(text);
        let gaps = program.records().filter(|record| record.kind == RecordKind::Gap);
        gaps.map(|record| record.origin.isn).collect()
    };
    assert_eq!(gaps("FROM/0,0\nIF(Q.EQ.1)THEN\nGOTO/1,1\nENDIF"), [2]);
    assert_eq!(gaps("FROM/0,0\nIF(Q.EQ.1)THEN\nA=1\nELSE\nA=2\nENDIF"), []);
}

#[test]
fn loops_that_never_end_are_noticed() {
    for text in ["LOOPST\nA)X=1\nIF(X.LT.2)THEN\nJUMPTO/A\nENDIF\nLOOPND", "DO/E,I=1,2\nI=1\nE)CONTIN"] {
        let options = Options { statement_budget: 20_000, ..Options::default() };
        let program = evaluate(&tree(text), &options, &|| false);
        let endless = program
            .findings()
            .filter(|finding| matches!(finding.kind, FindingKind::Control(ControlFinding::Endless { .. })));
        assert_eq!(endless.count(), 1, "{text}");
    }
}

#[test]
fn an_expansion_shows_the_branch_that_was_taken() {
    let text = "M=MACRO/X\nIF(X.GT.1)THEN\nGOTO/X,0\nELSE\nGOTO/0,X\nENDIF\nTERMAC\nCALL/M,X=1\nCALL/M,X=2\n\
                IF(1.EQ.2)THEN\nGOTO/5,5\nENDIF\nDO/E,I=1,2\nE)GOTO/I,I";
    let expansion = expand(&tree(text), &Options::default(), None, None, &|| false);
    assert_eq!(expansion.text(), "GOTO/0,1\nGOTO/2,0\nI=1\nE)GOTO/1,1\nI=2\nGOTO/2,2\nFINI\n");
}

#[test]
fn an_edit_gives_what_a_fresh_evaluation_gives() {
    let base =
        "A=1\nB=0\nIF(A.EQ.1)THEN\nB=1\nELSE\nB=2\nENDIF\nC=B+1\nIF(C.GT.2)THEN\nC=7\nENDIF\nD=C\nFINI\n";
    let edits = [
        ("A=1", "A=2"),
        ("ENDIF", ""),
        ("ELSE\n", "\n"),
        ("IF(A.EQ.1)THEN", ""),
        ("B=2", "B=3;ENDIF"),
        ("D=C", "ELSE"),
    ];
    let dialect = Dialect::named(DialectName::Free);
    let options = Options::default();
    for (from, to) in edits {
        for padding in [0, 300] {
            let text = format!("{}{base}", "X=1\n".repeat(padding));
            let tree = SyntaxTree::parse(&text, dialect);
            let program = evaluate(&tree, &options, &|| false);
            let at = text.find(from).expect("the text has it");
            let length = u32::try_from(from.len()).expect("short");
            let at = u32::try_from(at).expect("short");
            let range = TextRange::new(at.into(), (at + length).into());
            let (edited, change) = tree.edit(range, to);
            let updated = program.update(&edited, &change, &options, &|| false);
            let fresh = evaluate(&edited, &options, &|| false);
            assert_eq!(problems(&updated), problems(&fresh), "{from:?} to {to:?}");
            assert_eq!(updated.symbols(), fresh.symbols(), "{from:?} to {to:?}");
        }
    }
}

#[test]
fn an_if_that_is_being_written_leaves_the_rest_of_the_program_as_it_is() {
    let rest = "X=3\nIF(X.EQ.3)THEN\nY=4\nENDIF";
    for (open, inside) in [
        ("IF(1.EQ.2)THEN\n  R=1\n", None),
        ("IF(1.EQ.1)THEN\n  R=1\n", Some(1.0)),
        ("IF(1.EQ.2)THEN\n  R=1\nELSE\n  R=2\n", Some(2.0)),
        ("A)   IF(1.EQ.2)THEN\n$$ why\n          R=1\n", None),
        ("IF(1.EQ.2)THEN\n", None),
    ] {
        let program = run(&format!("{open}{rest}"));
        assert_eq!(scalar(&program, "R"), inside, "{open}");
        assert_eq!((scalar(&program, "X"), scalar(&program, "Y")), (Some(3.0), Some(4.0)), "{open}");
        let told: Vec<_> = program.findings().map(|finding| finding.kind.to_string()).collect();
        let open_told = told.iter().filter(|one| *one == "IF without ENDIF").count();
        assert_eq!(open_told, 1, "{open}: {told:?}");
    }
}
