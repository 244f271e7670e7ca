//! What may stand in loops and macros, what may jump where, and what is never reached (language reference 7.1 to 7.3).

mod support;

use std::{path::PathBuf, sync::Arc};

use apt_program::{IncludeFailure, IncludeResolver, Options, Program, SourceFile, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree};
use support::problems;

/// The library: a segment that reads another one, a segment, a macro.
struct Library;

impl IncludeResolver for Library {
    fn resolve(&self, name: &str) -> Result<Arc<SourceFile>, IncludeFailure> {
        let text = match name {
            "OUTER" => "READ/2,INNER\n",
            "INNER" => "B=2\n",
            "CALLER" => "CALL/SYSMAC,X=4\n",
            "SYSMAC" => "SYSMAC=MACRO/X\nC=X\nTERMAC\n",
            _ => return Err(IncludeFailure::NotFound { searched: Vec::new() }),
        };
        let tree = SyntaxTree::parse(text, Dialect::named(DialectName::Apt3));
        Ok(Arc::new(SourceFile { path: PathBuf::from(name), tree }))
    }
}

fn run(text: &str, dialect: DialectName) -> Program {
    let options = Options { include: Some(Arc::new(Library)), ..Options::default() };
    evaluate(&SyntaxTree::parse(&format!("{text}\nFINI\n"), Dialect::named(dialect)), &options, &|| false)
}

/// The rule, a program without FINI, and the problems as (statement, number).
type Rule = (&'static str, &'static str, &'static [(u32, Option<u16>)]);

const RULES: &[Rule] = &[
    // What may jump where.
    ("forward and back in a loop", "I=0\nLOOPST\nA)I=I+1\nIF(I-3)A,B,B\nB)LOOPND", &[]),
    ("out of the middle of a loop by its end", "LOOPST\nJUMPTO/B\nA)I=1\nB)LOOPND", &[]),
    ("in a macro without LOOPST", "M=MACRO/N\nK=0\nA)K=K+1\nIF(K-N)A,B,B\nB)TERMAC\nCALL/M,N=3", &[]),
    ("the same labels in two loops", "LOOPST\nJUMPTO/A\nA)LOOPND\nLOOPST\nJUMPTO/A\nA)LOOPND", &[]),
    ("numeric labels by their value", "LOOPST\nJUMPTO/01\n1)LOOPND", &[]),
    ("back to LOOPST", "I=0\nA)LOOPST\nI=I+1\nIF(I-3)A,B,B\nB)LOOPND", &[]),
    (
        "back to a statement with the label of LOOPST",
        "I=0\nA)LOOPST\nI=I+1\nIF(I-3)A,B,B\nA)I=3\nB)LOOPND",
        &[],
    ),
    ("to LOOPST from another loop", "A)LOOPST\nI=1\nLOOPND\nLOOPST\nJUMPTO/A\nLOOPND", &[(5, Some(406))]),
    ("IF outside of loops", "A=1\nIF(A)B,B,B\nB)C=1", &[(2, Some(407))]),
    ("JUMPTO outside of loops", "JUMPTO/B\nB)C=1", &[(1, Some(407))]),
    ("out of a loop", "LOOPST\nJUMPTO/B\nLOOPND\nB)C=1", &[(2, Some(406))]),
    ("into a loop", "LOOPST\nB)C=1\nLOOPND\nLOOPST\nJUMPTO/B\nLOOPND", &[(5, Some(406))]),
    (
        "from a macro into the loop that calls it",
        "M=MACRO\nJUMPTO/B\nTERMAC\nLOOPST\nCALL/M\nB)LOOPND",
        &[(2, Some(406))],
    ),
    ("a condition that is a point", "P=POINT/1,2\nLOOPST\nIF(P)A,A,A\nA)LOOPND", &[(3, Some(402))]),
    ("two labels of three", "LOOPST\nIF(1)A,A\nA)LOOPND", &[(2, Some(409))]),
    ("a label twice in a loop", "LOOPST\nA)B=1\nA)B=2\nLOOPND", &[(3, Some(6))]),
    // What is never reached.
    ("a statement behind a jump", "LOOPST\nJUMPTO/A\nB=1\nA)LOOPND", &[(3, None)]),
    ("a statement behind an IF", "LOOPST\nIF(1)A,A,A\nB=1\nA)LOOPND", &[(3, None)]),
    ("a remark behind a jump", "LOOPST\nJUMPTO/A\n$$ so\nREMARK\nA)LOOPND", &[]),
    (
        "a statement behind a jump in a macro that is never called",
        "M=MACRO\nJUMPTO/A\nB=1\nA)TERMAC",
        &[(3, None)],
    ),
    // What may stand where.
    ("a loop in a loop", "LOOPST\nLOOPST\nLOOPND", &[(2, Some(206))]),
    ("LOOPND alone", "LOOPND", &[(1, Some(208))]),
    ("TERMAC alone", "TERMAC", &[(1, Some(209))]),
    ("TERMAC in a loop", "LOOPST\nTERMAC\nLOOPND", &[(2, Some(209))]),
    ("MACRO in a loop", "LOOPST\nM=MACRO\nLOOPND", &[(2, Some(201))]),
    ("MACRO in a macro", "M=MACRO\nN=MACRO\nTERMAC", &[(2, Some(201))]),
    ("LOOPST in a macro", "M=MACRO\nLOOPST\nTERMAC\nCALL/M", &[(2, Some(210))]),
    ("LOOPND in a macro", "M=MACRO\nLOOPND\nTERMAC\nCALL/M", &[(2, Some(210))]),
    ("RESERV in a loop", "LOOPST\nRESERV/A,3\nLOOPND", &[(2, Some(252))]),
    ("RESERV in a macro", "M=MACRO\nRESERV/A,3\nTERMAC\nCALL/M", &[(2, Some(252))]),
    ("SYN in a loop", "LOOPST\nSYN/GL,GOLFT\nLOOPND", &[(2, Some(353))]),
    ("SYN in a macro", "M=MACRO\nSYN/GL,GOLFT\nTERMAC\nCALL/M", &[(2, Some(353))]),
    ("READ/2 in a loop", "LOOPST\nREAD/2,INNER\nLOOPND", &[(2, Some(37))]),
    ("READ/2 in a macro", "M=MACRO\nREAD/2,INNER\nTERMAC\nCALL/M", &[(2, Some(37))]),
    ("READ/2 in a segment", "READ/2,OUTER", &[(1, Some(30))]),
    ("the first CALL of a system macro in a segment", "LIBRY/SYSMAC\nREAD/2,CALLER", &[(1, Some(38))]),
    ("a later CALL of a system macro in a segment", "LIBRY/SYSMAC\nCALL/SYSMAC,X=1\nREAD/2,CALLER", &[]),
    ("a CALL of another macro in a segment", "SYSMAC=MACRO/X\nC=X\nTERMAC\nREAD/2,CALLER", &[]),
    ("READ/2 of nothing", "READ/2,NIX", &[(1, Some(31))]),
    ("READ/2 of two", "READ/2,INNER,OUTER", &[(1, Some(34))]),
    ("LIBRY of nothing", "LIBRY/NIX", &[(1, Some(31))]),
    ("a system macro", "LIBRY/SYSMAC\nCALL/SYSMAC,X=4", &[]),
    ("FINI in a loop", "LOOPST\nA=1", &[(3, Some(16))]),
    ("FINI in a macro", "M=MACRO\nA=1", &[(3, Some(16))]),
    ("CALL in a loop", "M=MACRO\nA=1\nTERMAC\nLOOPST\nCALL/M\nLOOPND", &[]),
    ("a macro before it is defined", "CALL/M\nM=MACRO\nTERMAC", &[(1, Some(233))]),
    ("a macro name twice", "M=MACRO\nTERMAC\nM=MACRO\nTERMAC", &[(3, Some(202))]),
];

#[test]
fn rules_of_loops_and_macros_hold_on_cards() {
    let mut wrong = Vec::new();
    for (rule, text, expected) in RULES {
        let found = problems(&run(text, DialectName::Apt3));
        if found != *expected {
            wrong.push(format!("{rule}: expected {expected:?}, found {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn segments_may_hold_segments_in_free_form() {
    let program = run("READ/2,OUTER\nC=B", DialectName::Free);
    assert_eq!(problems(&program), []);
    assert!(program.symbols().iter().any(|(name, _)| name == "B"));
}
