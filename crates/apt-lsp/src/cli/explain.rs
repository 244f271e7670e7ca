//! `explain`: the page of a diagnostic.

use super::Outcome;
use super::console::Console;
use crate::analysis::Language;

/// Prints the page of a code.
pub(super) fn explain(code: &str, console: &Console, language: &dyn Language) -> Outcome {
    match language.explain(&code.to_ascii_uppercase()) {
        Some(page) => console.print(&format!("{}\n", page.trim_end())),
        None => {
            console.error(&format!("there is no diagnostic `{code}`; codes look like APT0101"));
            Outcome::Unusable
        }
    }
}
