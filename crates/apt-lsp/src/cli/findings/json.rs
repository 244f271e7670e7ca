//! Findings as JSON.

use ropey::Rope;
use serde_json::{Value, json};

use super::{Checked, Counts};
use crate::analysis::Diagnostic;
use crate::cli::program::Program;
use crate::convert::TextIndex;

/// The report as a line of JSON.
pub(in crate::cli) fn text(checked: &[Checked]) -> String {
    let Counts { errors, warnings } = Counts::of(checked);
    let file = |checked: &Checked| {
        let diagnostics: Vec<_> =
            checked.diagnostics.iter().map(|found| diagnostic(&checked.program, found)).collect();
        json!({ "file": checked.program.name, "diagnostics": diagnostics })
    };
    let files: Vec<_> = checked.iter().map(file).collect();
    format!("{}\n", json!({ "files": files, "summary": { "errors": errors, "warnings": warnings } }))
}

fn diagnostic(program: &Program, found: &Diagnostic) -> Value {
    let range = |bytes| json!(program.index.range(bytes));
    let related = found.related.iter().map(
        |related| json!({ "message": related.message, "file": program.name, "range": range(&related.range) }),
    );
    let elsewhere = found.elsewhere.iter().map(|one| {
        let index = TextIndex { rope: Rope::from_str(&one.source.tree.text()), ..program.index.clone() };
        let file = one.source.path.display().to_string();
        json!({ "message": one.message, "file": file, "range": index.range(&one.range) })
    });
    let edit = |(range, text): &(std::ops::Range<usize>, String)| json!({ "range": program.index.range(range), "text": text });
    let fixes = found.fixes.iter().map(|fix| {
        let edits: Vec<_> = fix.edits.iter().map(edit).collect();
        json!({ "title": fix.title, "preferred": fix.preferred, "edits": edits })
    });
    json!({
        "code": found.code,
        "severity": found.severity,
        "message": found.message,
        "isn": found.isn,
        "apt3": found.apt3,
        "file": program.name,
        "range": range(&found.range),
        "origin": found.origin,
        "related": elsewhere.chain(related).collect::<Vec<_>>(),
        "hint": found.hint,
        "fixes": fixes.collect::<Vec<_>>(),
    })
}
