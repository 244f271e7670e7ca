//! What the tests of this folder share: evaluating a program, and what it tells and leaves.

#![allow(dead_code, reason = "not every test file needs everything")]

use apt_program::{Finding, Options, Program, Severity, Value, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree};

/// A program as it stands.
pub(crate) fn run_whole(text: &str, dialect: DialectName) -> Program {
    evaluate(&SyntaxTree::parse(text, Dialect::named(dialect)), &Options::default(), &|| false)
}

/// A program to which FINI is added.
pub(crate) fn run_as(text: &str, dialect: DialectName) -> Program {
    run_whole(&format!("{text}\nFINI\n"), dialect)
}

/// Errors and warnings as statement and number of the dialect.
pub(crate) fn problems(program: &Program) -> Vec<(u32, Option<u16>)> {
    let serious = program.findings().filter(|finding| finding.severity >= Severity::Warning);
    serious.map(|finding: &Finding| (finding.origin.isn, finding.number)).collect()
}

/// The value of a name that holds a number.
pub(crate) fn scalar(program: &Program, name: &str) -> Option<f64> {
    program.symbols().iter().find(|(known, _)| known == name).and_then(|(_, value)| match value {
        Value::Scalar(value) => Some(*value),
        Value::Geometry(_) => None,
    })
}

/// The canonical numbers of a name.
pub(crate) fn numbers(program: &Program, name: &str) -> Option<Vec<f64>> {
    let found = program.symbols().into_iter().find(|(known, _)| known == name)?;
    Some(Value::canonical_values(&found.1))
}
