//! Findings as annotations of GitHub workflows.

use std::fmt::Write as _;

use super::Checked;
use crate::analysis::{Diagnostic, Severity};

/// One line per finding.
pub(in crate::cli) fn text(checked: &[Checked]) -> String {
    let mut text = String::new();
    for checked in checked {
        for found in &checked.diagnostics {
            let range = checked.program.index.range(&found.range);
            let (start, end) = (range.start, range.end);
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "::{} file={},line={},endLine={},col={},endColumn={},title={}::{}",
                level(found.severity),
                property(&checked.program.name),
                start.line + 1,
                end.line + 1,
                start.character + 1,
                end.character + 1,
                property(&found.code),
                data(&message(found)),
            );
        }
    }
    text
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Information | Severity::Hint => "notice",
    }
}

fn message(found: &Diagnostic) -> String {
    match &found.hint {
        Some(hint) => format!("{}\nhelp: {hint}", found.message),
        None => found.message.clone(),
    }
}

/// What ends a line or begins an escape is escaped.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// In properties, what ends a property is escaped too.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_end_an_annotation_is_escaped() {
        assert_eq!(data("50%\r\n: a, b"), "50%25%0D%0A: a, b");
        assert_eq!(property("C:\\a,b.apt"), "C%3A\\a%2Cb.apt");
    }
}
