//! Words of the language that become names.
//!
//! Dialects that allow it have it on purpose, and a program that never uses the word as a word is none the worse. Told is
//! what changes the meaning of a word in the middle of its use.

use std::collections::BTreeMap;

use apt_geometry::patience::Patience;
use apt_program::Origin;
use apt_syntax::{SyntaxTree, statement::ElementKind, vocabulary};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use crate::{
    Cancelled,
    diagnostic::{Diagnostic, Fix, statement_range},
    go_on,
};

/// The code of a word that becomes a name.
const WORD_BECOMES_NAME: &str = "APT0111";
/// Letters of a name that every dialect takes.
const SHORT_NAME: usize = 6;
/// Words that let statements be executed in another order than they are written in.
const OUT_OF_ORDER: [&str; 7] = ["MACRO", "LOOPST", "IF", "JUMPTO", "DO", "READ", "LIBRY"];

/// Keeps the findings about words that have been used as words before, and shows where.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub(crate) fn keep_shadowing(
    tree: &SyntaxTree,
    findings: &mut Vec<Diagnostic>,
    patience: Patience<'_>,
) -> Result<(), Cancelled> {
    let is_shadow = |finding: &Diagnostic| finding.wording.code == WORD_BECOMES_NAME;
    let mut words: BTreeMap<SmolStr, Option<Origin>> =
        findings.iter().filter(|one| is_shadow(one)).map(|one| (word(tree, &one.origin), None)).collect();
    let Some(last) = findings.iter().filter(|one| is_shadow(one)).map(|one| one.origin.isn).max() else {
        return Ok(());
    };
    for view in tree.statements().take_while(|view| view.isn() < last) {
        go_on(patience, 1)?;
        for element in view.parsed().elements.iter().filter(|element| element.kind == ElementKind::Word) {
            if let Some(use_before @ None) = words.get_mut(&element.text) {
                *use_before = Some(Origin::in_program(view.isn(), element.range));
            }
        }
    }
    let mut kept = Vec::with_capacity(findings.len());
    for mut finding in std::mem::take(findings) {
        if is_shadow(&finding) {
            let before = words.get(&word(tree, &finding.origin)).cloned().flatten();
            let Some(before) = before.filter(|before| before.isn < finding.origin.isn) else { continue };
            finding.related.push(("it is used as a word here".to_owned(), before));
            finding.fixes.extend(other_name(tree, &finding.origin, patience)?);
        }
        kept.push(finding);
    }
    *findings = kept;
    Ok(())
}

/// Another name for what a word becomes the name of, where it is sure which of its uses mean the name: all from the
/// definition on.
fn other_name(tree: &SyntaxTree, origin: &Origin, patience: Patience<'_>) -> Result<Option<Fix>, Cancelled> {
    let is_plain = origin.source.is_none() && origin.frame.is_none();
    let word = is_plain.then(|| word(tree, origin)).filter(|word| !word.is_empty());
    let Some(word) = word else { return Ok(None) };
    let mut taken = FxHashSet::default();
    let mut edits = Vec::new();
    for view in tree.statements() {
        go_on(patience, 1)?;
        for element in &view.parsed().elements {
            if element.kind == ElementKind::Word && OUT_OF_ORDER.contains(&element.text.as_str()) {
                return Ok(None);
            }
            if element.kind == ElementKind::Word && element.text == word {
                if (view.isn(), element.range.start()) < (origin.isn, origin.range.start()) {
                    continue;
                }
                edits.push(statement_range(tree, view.isn(), element.range));
            } else if !taken.contains(&element.text) {
                taken.insert(element.text.clone());
            }
        }
    }
    let stem: String = word.chars().take(SHORT_NAME - 1).collect();
    let is_free = |name: &String| !taken.contains(name.as_str()) && vocabulary::lookup(name).is_none();
    let name = (1..10).map(|number| format!("{stem}{number}")).find(is_free);
    Ok(name.map(|name| Fix {
        title: format!("Call it {name}"),
        edits: edits.into_iter().map(|range| (range, name.clone())).collect(),
        preferred: false,
    }))
}

/// The element at a place, as the language spells it.
fn word(tree: &SyntaxTree, origin: &Origin) -> SmolStr {
    let index = (origin.isn.max(1) - 1) as usize;
    let parsed = tree.statement(index).parsed();
    let element = parsed.elements.iter().find(|element| element.range.start() == origin.range.start());
    element.map(|element| element.text.clone()).unwrap_or_default()
}
