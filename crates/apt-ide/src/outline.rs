//! The outline of a program: definitions, macros, loops and branches of IFs, nested, and the sections that PARTNO and LOADTL begin.

use std::{collections::BTreeMap, ops::Range};

use apt_geometry::patience::Waiting;
use apt_run::go_on;
use apt_syntax::statement::{Body, Clause};

use crate::{Analysis, Cancel, Cancelled, absolute};

/// The kind of an outline entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum OutlineKind {
    Part,
    Macro,
    Loop,
    Branch,
    Geometry,
    Scalar,
    Array,
    Tool,
}

/// One entry of the outline.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutlineEntry {
    /// What is shown.
    pub name: String,
    /// More about it: the type word, the operation.
    pub detail: String,
    /// The kind.
    pub kind: OutlineKind,
    /// The whole, bytes of the text.
    pub range: Range<usize>,
    /// The name in it.
    pub focus: Range<usize>,
    /// Entries inside.
    pub children: Vec<OutlineEntry>,
}

/// The most entries that one outline carries: a reply must stay small whatever the program.
pub const GREATEST_OUTLINE: usize = 20_000;

impl Analysis {
    /// The outline, in order of the text.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn outline(&self, cancel: Cancel<'_>) -> Result<Vec<OutlineEntry>, Cancelled> {
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let tree = self.document().tree();
        let mut stack: Vec<(usize, OutlineEntry)> = Vec::new();
        let mut top = Vec::new();
        let mut count = 0;
        let branches: BTreeMap<usize, usize> = self
            .with_marks(patience)?
            .branches()
            .into_iter()
            .map(|branch| (branch.start, branch.end))
            .collect();
        for view in tree.statements() {
            go_on(patience, 1)?;
            while stack.last().is_some_and(|(last, _)| *last < view.index) {
                pop(&mut stack, &mut top);
            }
            let branch = branches.get(&view.index);
            if count >= GREATEST_OUTLINE || (branch.is_none() && !may_define(view.text())) {
                continue;
            }
            let parsed = view.parsed();
            for part in &parsed.statement.parts {
                let whole = absolute(&view, part.range);
                let Some(mut entry) = entry(&view, &part.body, whole.clone()) else { continue };
                count += 1;
                let region = || self.regions().iter().find(|region| region.first == view.index);
                let last = match entry.kind {
                    OutlineKind::Macro | OutlineKind::Loop => region().map(|region| region.last),
                    // The clause that ends a branch belongs to the next one, or to none.
                    OutlineKind::Branch => branch.map(|end| end.saturating_sub(1)),
                    _ => None,
                };
                match last {
                    Some(last) => {
                        // While a program is written a block may end behind the one in which it begins.
                        let last = stack.last().map_or(last, |(outer, _)| last.min(*outer));
                        let end = usize::from(tree.statement(last).range().end());
                        entry.range = whole.start..end.max(whole.end);
                        stack.push((last, entry));
                    }
                    None => match stack.last_mut() {
                        Some((_, parent)) => parent.children.push(entry),
                        None => top.push(entry),
                    },
                }
            }
        }
        while !stack.is_empty() {
            pop(&mut stack, &mut top);
        }
        Ok(top)
    }
}

fn pop(stack: &mut Vec<(usize, OutlineEntry)>, top: &mut Vec<OutlineEntry>) {
    if let Some((_, entry)) = stack.pop() {
        match stack.last_mut() {
            Some((_, parent)) => parent.children.push(entry),
            None => top.push(entry),
        }
    }
}

/// Only these statements can have an entry; the rest need not be parsed.
fn may_define(text: &str) -> bool {
    let bytes = text.as_bytes();
    let first = text.trim_start().as_bytes().first().map(u8::to_ascii_uppercase);
    bytes.contains(&b'=') || matches!(first, Some(b'P' | b'L' | b'R'))
}

fn entry(view: &apt_syntax::tree::StatementView, body: &Body, range: Range<usize>) -> Option<OutlineEntry> {
    let named = |name: &str, detail: &str, kind, focus| OutlineEntry {
        name: name.to_owned(),
        detail: detail.to_owned(),
        kind,
        range: range.clone(),
        focus,
        children: Vec::new(),
    };
    Some(match body {
        Body::Text { word, text, .. } if word.word.spelling == "PARTNO" => {
            named(text.trim(), "PARTNO", OutlineKind::Part, absolute(view, word.range))
        }
        Body::Macro { name, .. } => {
            named(&name.text, "MACRO", OutlineKind::Macro, absolute(view, name.range))
        }
        Body::Definition { target, definition } => {
            let focus = absolute(view, target.range);
            named(&target.name.text, definition.kind.word.spelling, OutlineKind::Geometry, focus)
        }
        Body::Assignment { target, .. } => {
            named(&target.name.text, "", OutlineKind::Scalar, absolute(view, target.range))
        }
        Body::Clause { word, clause: clause @ (Clause::If(_) | Clause::ElseIf(_) | Clause::Else) } => {
            let text = view.text();
            let condition =
                text.find('(').zip(text.rfind(')')).and_then(|(open, end)| text.get(open + 1..end));
            let name = match clause {
                Clause::If(_) => "IF",
                Clause::ElseIf(_) => "ELSEIF",
                _ => "ELSE",
            };
            let detail = condition.filter(|_| name != "ELSE").unwrap_or("");
            named(name, detail, OutlineKind::Branch, absolute(view, word.range))
        }
        Body::Major { word, .. } => match word.word.spelling {
            "LOOPST" => named("LOOPST", "", OutlineKind::Loop, absolute(view, word.range)),
            "LOADTL" | "TURRET" | "TOOLNO" => {
                named(word.word.spelling, "", OutlineKind::Tool, absolute(view, word.range))
            }
            "RESERV" => named("RESERV", "", OutlineKind::Array, absolute(view, word.range)),
            _ => return None,
        },
        _ => return None,
    })
    .filter(|entry: &OutlineEntry| !entry.name.is_empty())
}
