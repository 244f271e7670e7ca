//! Lints of values: what is overwritten before anything reads it.
//!
//! Only straight stretches of the program are looked at: statements outside of macros and loops that are executed one
//! after the other. What a macro, a jump or an included file may read counts as read.
//!
//! Each block of statements is summed up once ([`Summary`]); the sums are joined from block to block, so that an edit
//! costs the blocks that it touches.

use std::collections::BTreeMap;

use apt_program::Origin;
use apt_syntax::{
    TextRange,
    grammar::ParsedStatement,
    statement::{Body, ElementKind, Part},
};
use smol_str::SmolStr;

use super::{Lint, LintKind};

/// The place where a name gets a value, in a statement counted from the first of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    local: u32,
    range: TextRange,
}

/// The first that a block does with a name.
#[derive(Debug, Clone, Copy, PartialEq)]
enum First {
    Reads,
    Overwrites(Place),
}

/// What a block of statements means for the values before and behind it.
#[derive(Debug, Default)]
pub(super) struct Summary {
    /// The first use of each name on the stretch with which the block begins, in order of the names.
    first: Box<[(SmolStr, First)]>,
    /// A stretch ends in it: what stands before it is out of reach for what stands behind.
    ends: bool,
    /// Values that nothing in the block reads, on the stretch with which it ends.
    unread: Box<[(SmolStr, Place)]>,
    /// Values that the block itself overwrites, with the place that does.
    overwritten: Box<[(SmolStr, Place, Place)]>,
    /// How many macros and loops are open behind it.
    depth: usize,
}

impl Summary {
    /// How many macros and loops are open behind the block.
    pub(super) fn depth(&self) -> usize {
        self.depth
    }

    fn first(&self, name: &str) -> Option<First> {
        let index = self.first.binary_search_by(|(other, _)| other.as_str().cmp(name)).ok()?;
        self.first.get(index).map(|(_, first)| *first)
    }
}

/// Sums up a block, statement by statement.
#[derive(Default)]
pub(super) struct Stretch {
    first: BTreeMap<SmolStr, First>,
    ends: bool,
    unread: BTreeMap<SmolStr, Place>,
    overwritten: Vec<(SmolStr, Place, Place)>,
    depth: usize,
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
    /// Behind so many open macros and loops.
    pub(super) fn at_depth(depth: usize) -> Self {
        Self { depth, ends: depth > 0, ..Self::default() }
    }

    /// The next statement, counted from the first of the block.
    pub(super) fn statement(&mut self, local: u32, parsed: &ParsedStatement) {
        // Comments and blank lines change nothing.
        if parsed.elements.is_empty() && !parsed.is_broken() {
            return;
        }
        let effect = effect(parsed);
        self.depth = match opens(parsed) {
            Some(true) => self.depth.saturating_add(1),
            Some(false) => self.depth.saturating_sub(1),
            None => self.depth,
        };
        if self.depth > 0 || matches!(effect, Effect::Ends) {
            self.unread.clear();
            self.ends = true;
            return;
        }
        let target = match &effect {
            Effect::Assigns(_, range) => Some(*range),
            _ => None,
        };
        for element in &parsed.elements {
            if element.kind == ElementKind::Name && Some(element.range) != target {
                self.unread.remove(element.text.as_str());
                self.begins_with(&element.text, First::Reads);
            }
        }
        let Effect::Assigns(name, range) = effect else { return };
        let now = Place { local, range };
        self.begins_with(&name, First::Overwrites(now));
        if let Some(before) = self.unread.insert(name.clone(), now) {
            self.overwritten.push((name, before, now));
        }
    }

    fn begins_with(&mut self, name: &SmolStr, first: First) {
        if !self.ends && !self.first.contains_key(name) {
            self.first.insert(name.clone(), first);
        }
    }

    /// The sum.
    pub(super) fn end(self) -> Summary {
        Summary {
            first: self.first.into_iter().collect(),
            ends: self.ends,
            unread: self.unread.into_iter().collect(),
            overwritten: self.overwritten.into(),
            depth: self.depth,
        }
    }
}

/// Joins the sums of blocks in the order of the program.
#[derive(Default)]
pub(super) struct Join {
    unread: BTreeMap<SmolStr, Origin>,
    lints: Vec<Lint>,
}

impl Join {
    /// The next block, whose first statement has this index.
    pub(super) fn block(&mut self, first_statement: usize, sum: &Summary) {
        let origin = |place: Place| {
            let isn = u32::try_from(first_statement).unwrap_or(u32::MAX).saturating_add(place.local + 1);
            Origin::in_program(isn, place.range)
        };
        // The shorter of the two lists is gone through.
        let met: Vec<(SmolStr, First)> = if self.unread.len() < sum.first.len() {
            self.unread.keys().filter_map(|name| Some((name.clone(), sum.first(name)?))).collect()
        } else {
            sum.first.iter().filter(|(name, _)| self.unread.contains_key(name)).cloned().collect()
        };
        for (name, first) in met {
            let before = self.unread.remove(&name);
            if let (Some(before), First::Overwrites(place)) = (before, first) {
                self.lints.push(overwritten(name, before, origin(place)));
            }
        }
        if sum.ends {
            self.unread.clear();
        }
        for (name, before, now) in &sum.overwritten {
            self.lints.push(overwritten(name.clone(), origin(*before), origin(*now)));
        }
        self.unread.extend(sum.unread.iter().map(|(name, place)| (name.clone(), origin(*place))));
    }

    /// What was found.
    pub(super) fn lints(self) -> Vec<Lint> {
        self.lints
    }
}

fn overwritten(name: SmolStr, before: Origin, now: Origin) -> Lint {
    Lint { kind: LintKind::Overwritten { name }, origin: before, other: Some(now), fixes: Vec::new() }
}

fn effect(parsed: &ParsedStatement) -> Effect {
    let [part] = parsed.statement.parts.as_slice() else {
        return if parsed.statement.parts.is_empty() {
            Effect::Reads
        } else {
            worst(&parsed.statement.parts)
        };
    };
    // PRINT/3,ALL reads every value.
    let all = || parsed.elements.iter().any(|one| one.kind == ElementKind::Word && one.text == "ALL");
    if parsed.is_broken() || parsed.statement.label.is_some() || all() {
        return Effect::Ends;
    }
    match &part.body {
        // Geometry is another matter: it can be defined again only where CANON/ON allows it, which somebody has written
        // on purpose.
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
