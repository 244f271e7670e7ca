//! Words of the language that become names.
//!
//! Dialects that allow it have it on purpose, and a program that never uses the word as a word is none the worse. Told is
//! what changes the meaning of a word in the middle of its use.

use std::collections::BTreeMap;

use apt_program::Origin;
use apt_syntax::{SyntaxTree, statement::ElementKind};
use smol_str::SmolStr;

use crate::diagnostic::Diagnostic;

/// The code of a word that becomes a name.
const WORD_BECOMES_NAME: &str = "APT0111";

/// Keeps the findings about words that have been used as words before, and shows where.
pub(crate) fn keep_shadowing(tree: &SyntaxTree, findings: &mut Vec<Diagnostic>) {
    let is_shadow = |finding: &Diagnostic| finding.wording.code == WORD_BECOMES_NAME;
    let mut words: BTreeMap<SmolStr, Option<Origin>> =
        findings.iter().filter(|one| is_shadow(one)).map(|one| (word(tree, &one.origin), None)).collect();
    let Some(last) = findings.iter().filter(|one| is_shadow(one)).map(|one| one.origin.isn).max() else {
        return;
    };
    for view in tree.statements().take_while(|view| view.isn() < last) {
        for element in view.parsed().elements.iter().filter(|element| element.kind == ElementKind::Word) {
            if let Some(use_before @ None) = words.get_mut(&element.text) {
                *use_before = Some(Origin::in_program(view.isn(), element.range));
            }
        }
    }
    findings.retain_mut(|finding| {
        if !is_shadow(finding) {
            return true;
        }
        let before = words.get(&word(tree, &finding.origin)).cloned().flatten();
        match before.filter(|before| before.isn < finding.origin.isn) {
            Some(before) => {
                finding.related.push(("it is used as a word here".to_owned(), before));
                true
            }
            None => false,
        }
    });
}

/// The element at a place, as the language spells it.
fn word(tree: &SyntaxTree, origin: &Origin) -> SmolStr {
    let index = (origin.isn.max(1) - 1) as usize;
    let parsed = tree.statement(index).parsed();
    let element = parsed.elements.iter().find(|element| element.range.start() == origin.range.start());
    element.map(|element| element.text.clone()).unwrap_or_default()
}
