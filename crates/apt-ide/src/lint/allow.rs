//! `$$ apt-lsp: allow CODE` and `allow-file CODE`.

use apt_syntax::{SyntaxTree, tree::StatementView};
use rustc_hash::FxHashSet;

use super::Lint;

/// Takes out what comments allow.
pub(super) fn remove_allowed(tree: &SyntaxTree, lints: &mut Vec<Lint>) {
    if lints.is_empty() {
        return;
    }
    let mut file: FxHashSet<String> = FxHashSet::default();
    let mut lines: FxHashSet<(usize, String)> = FxHashSet::default();
    for view in tree.statements().filter(|view| view.text().contains("apt-lsp:")) {
        let alone = view.parsed().elements.is_empty();
        for (whole_file, code) in marks(&view) {
            if whole_file {
                file.insert(code);
            } else {
                lines.insert((view.index + usize::from(alone), code));
            }
        }
    }
    lints.retain(|lint| {
        let code = lint.code.to_owned();
        !file.contains(&code) && !lines.contains(&(lint.statement, code))
    });
}

/// The codes that the comments of a statement allow, and whether they do it for the whole file.
fn marks(view: &StatementView) -> Vec<(bool, String)> {
    let parsed = view.parsed();
    let mut marks = Vec::new();
    for range in &parsed.comments {
        let comment = view.text().get(std::ops::Range::<usize>::from(*range)).unwrap_or("");
        let bare = comment.trim().trim_start_matches(['$', ' ', '\t']);
        let Some(rest) = bare.strip_prefix("apt-lsp:") else { continue };
        let mut words = rest.split([' ', '\t', ',']).filter(|word| !word.is_empty());
        let whole_file = match words.next() {
            Some("allow") => false,
            Some("allow-file") => true,
            _ => continue,
        };
        marks.extend(words.map(|code| (whole_file, code.to_ascii_uppercase())));
    }
    marks
}
