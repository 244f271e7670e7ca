//! Lints of values: what is overwritten before anything reads it.
//!
//! Only straight stretches of the program are looked at: statements outside of macros and loops that are executed one
//! after the other. What a macro, a jump or an included file may read counts as read.

use std::collections::BTreeMap;

use apt_program::Origin;
use apt_syntax::{
    SyntaxTree, TextRange,
    grammar::ParsedStatement,
    statement::{Body, ElementKind, Part},
    tree::StatementView,
};
use smol_str::SmolStr;

use super::{Lint, LintKind};

pub(super) fn lints(tree: &SyntaxTree) -> Vec<Lint> {
    let mut stretch = Stretch::default();
    for view in tree.statements() {
        // Comments and blank lines change nothing.
        if !view.text().trim_start().is_empty() && !view.text().trim_start().starts_with("$$") {
            stretch.statement(&view);
        }
    }
    stretch.lints
}

/// A value that nothing has read so far.
struct Unread {
    isn: u32,
    range: TextRange,
}

#[derive(Default)]
struct Stretch {
    unread: BTreeMap<SmolStr, Unread>,
    /// How many macros and loops are open.
    depth: usize,
    lints: Vec<Lint>,
}

/// What a statement means for the values before it.
enum Effect {
    /// It gives a name a number.
    Assigns(SmolStr, TextRange),
    /// It may read the names in it.
    Reads,
    /// Anything may read and change anything; the stretch ends.
    Ends,
}

impl Stretch {
    fn statement(&mut self, view: &StatementView) {
        let parsed = view.parsed();
        let effect = effect(&parsed);
        self.depth = match opens(&parsed) {
            Some(true) => self.depth.saturating_add(1),
            Some(false) => self.depth.saturating_sub(1),
            None => self.depth,
        };
        if self.depth > 0 || matches!(effect, Effect::Ends) {
            self.unread.clear();
            return;
        }
        let target = match &effect {
            Effect::Assigns(_, range) => Some(*range),
            _ => None,
        };
        for element in &parsed.elements {
            if element.kind == ElementKind::Name && Some(element.range) != target {
                self.unread.remove(element.text.as_str());
            }
        }
        let Effect::Assigns(name, range) = effect else { return };
        let now = Unread { isn: view.isn(), range };
        let later = Origin::in_program(now.isn, now.range);
        if let Some(before) = self.unread.insert(name.clone(), now) {
            self.lints.push(Lint {
                kind: LintKind::Overwritten { name },
                origin: Origin::in_program(before.isn, before.range),
                other: Some(later),
                fixes: Vec::new(),
            });
        }
    }
}

fn effect(parsed: &ParsedStatement) -> Effect {
    let [part] = parsed.statement.parts.as_slice() else {
        return if parsed.statement.parts.is_empty() {
            Effect::Reads
        } else {
            worst(&parsed.statement.parts)
        };
    };
    if parsed.is_broken() || parsed.statement.label.is_some() {
        return Effect::Ends;
    }
    match &part.body {
        Body::Assignment { target, .. } if target.subscript.is_none() => {
            Effect::Assigns(target.name.text.clone(), target.name.range)
        }
        _ => worst(std::slice::from_ref(part)),
    }
}

/// Reads, unless one of the parts ends the stretch.
fn worst(parts: &[Part]) -> Effect {
    let harmless = |part: &Part| match &part.body {
        Body::Assignment { .. } | Body::Definition { .. } | Body::Text { .. } => true,
        Body::Major { word, .. } => !matches!(
            word.word.spelling,
            "LOOPST"
                | "LOOPND"
                | "TERMAC"
                | "JUMPTO"
                | "INCLUD"
                | "LIBRY"
                | "SYN"
                | "RESERV"
                | "READ"
                | "OBTAIN"
        ),
        _ => false,
    };
    if parts.iter().all(harmless) { Effect::Reads } else { Effect::Ends }
}

/// Whether a statement opens (true) or closes (false) a macro or loop.
fn opens(parsed: &ParsedStatement) -> Option<bool> {
    parsed.statement.parts.iter().find_map(|part| match &part.body {
        Body::Macro { .. } => Some(true),
        Body::Major { word, .. } => match word.word.spelling {
            "LOOPST" => Some(true),
            "LOOPND" | "TERMAC" => Some(false),
            _ => None,
        },
        _ => None,
    })
}
