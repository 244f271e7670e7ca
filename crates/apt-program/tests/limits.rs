//! The limits of APT III (language reference 1.10): cards hold to them, the free form does not.

use apt_program::{Finding, Options, Program, Severity, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree};

fn run(text: &str, dialect: DialectName) -> Program {
    evaluate(&SyntaxTree::parse(text, Dialect::named(dialect)), &Options::default(), &|| false)
}

/// The errors as (statement, number).
fn errors(text: &str, dialect: DialectName) -> Vec<(u32, Option<u16>)> {
    let program = run(&format!("{text}\nFINI\n"), dialect);
    let errors = program.findings().filter(|finding| finding.severity == Severity::Error);
    errors.map(|finding: &Finding| (finding.origin.isn, finding.number)).collect()
}

/// `item` with the numbers from 1 on for `#`, each on a record of its own.
fn list(head: &str, item: &str, count: usize) -> String {
    let items: Vec<String> = (1..=count).map(|number| item.replace('#', &number.to_string())).collect();
    format!("{head}{}", items.join(",$\n"))
}

/// A chain of macros that call each other, and the call of the last.
fn calls(depth: usize) -> String {
    let mut text = "M1=MACRO\nA=1\nTERMAC\n".to_owned();
    for level in 2..=depth {
        text += &format!("M{level}=MACRO\nCALL/M{}\nTERMAC\n", level - 1);
    }
    text + &format!("CALL/M{depth}")
}

fn lines(line: &str, count: usize) -> String {
    vec![line; count].join("\n")
}

/// What the limit is for, a program with a number of such things, the limit, the number of the error, and whether the free
/// form has the limit too.
type Limit = (&'static str, fn(usize) -> String, usize, u16, bool);

const LIMITS: &[Limit] = &[
    ("elements", |count| list("GOTO/-", "1", (count - 2) / 2), 600, 13, false),
    ("nests", |count| list("P=PATERN/RANDOM,", "(#,1)", count), 10, 70, false),
    ("macro variables", |count| list("M=MACRO/", "V#=1", count) + "\nTERMAC", 50, 205, false),
    ("nested calls", calls, 5, 231, false),
    ("synonyms", |count| list("SYN/", "S#,POINT", count), 50, 354, false),
    ("machines", |count| lines("MACHIN/A", count), 9, 504, false),
    ("points of a curve", |count| list("T=TABCYL/NOZ,SPLINE,", "#,1", count), 139, 1001, false),
    ("points of a pattern", |count| format!("P=PATERN/LINEAR,(1,1),(2,2),{count}"), 330, 802, false),
    ("powers", |count| "A=1".to_owned() + &"$\n**1".repeat(count), 39, 56, true),
    ("points of a pocket", |count| list("POCKET/.4,1,.8,5,5,5,1,1,", "#,1,0", count), 20, 377, true),
    ("check surfaces", |count| list("L=LINE/XAXIS\nGOLFT/L,", "TO,L,L#", count), 2, 129, true),
    ("tolerances", |count| list("INTOL/", ".1", count), 4, 129, true),
    ("thicknesses", |count| list("THICK/", ".1", count), 4, 129, true),
];

#[test]
fn cards_hold_to_the_limits_and_the_free_form_has_few() {
    let mut wrong = Vec::new();
    for (what, text, limit, number, everywhere) in LIMITS {
        let told = |count: usize, dialect| {
            errors(&text(count), dialect).iter().filter(|(_, found)| *found == Some(*number)).count()
        };
        let found = [
            told(*limit, DialectName::Apt3),
            told(limit + 2, DialectName::Apt3).min(1),
            told(limit + 2, DialectName::Free).min(1),
        ];
        let expected = [0, 1, usize::from(*everywhere)];
        if found != expected {
            let all = errors(&text(limit + 2), DialectName::Apt3);
            wrong.push(format!("{what}: {found:?}, not {expected:?}; {all:?}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn a_budget_bounds_calls_and_statements_where_the_language_does_not() {
    let options =
        |macro_depth, statement_budget| Options { macro_depth, statement_budget, ..Options::default() };
    let run = |text: &str, options: &Options| {
        let tree = SyntaxTree::parse(&format!("{text}\nFINI\n"), Dialect::named(DialectName::Free));
        let program = evaluate(&tree, options, &|| false);
        program.findings().filter(|finding| finding.severity == Severity::Error).count()
    };
    assert_eq!(run(&calls(8), &options(8, 1000)), 0);
    assert_eq!(run(&calls(9), &options(8, 1000)), 1);
    let turns = "I=0\nLOOPST\nA)I=I+1\nIF(I-2000)A,B,B\nB)LOOPND";
    assert_eq!(run(turns, &options(8, 10_000)), 0);
    assert_eq!(run(turns, &options(8, 3_000)), 1);
    // However small it is: four turns are eight statements and LOOPND. What stands outside is not counted.
    let few = "A=1\nB=2\nI=0\nLOOPST\nA)I=I+1\nIF(I-4)A,B,B\nB)LOOPND";
    assert_eq!(run(few, &options(8, 9)), 0);
    assert_eq!(run(few, &options(8, 8)), 1);
}
