//! What can come next in a definition, by its forms.

use apt_geometry::{
    canonical::GeometryKind,
    definition::{ArgumentKind, Modifier, type_of_next},
};
use apt_program::symbols::Value;
use apt_syntax::{
    statement::{Element, ElementKind},
    vocabulary::{WordClass, lookup, words},
};

use crate::{
    context::{Context, Opener},
    forms::{Atom, ValueKind, forms_of, kinds_of},
};

/// What the forms of a definition let stand at a place.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Next {
    /// Modifier words, in the order of the forms.
    pub(super) modifiers: Vec<&'static str>,
    /// Types of entities.
    pub(super) kinds: Vec<GeometryKind>,
    /// A number.
    pub(super) scalar: bool,
    /// A name of anything.
    pub(super) anything: bool,
    /// A label of a statement.
    pub(super) labels: bool,
}

impl Next {
    /// Both together.
    pub(super) fn with(mut self, more: Next) -> Next {
        self.modifiers.extend(
            more.modifiers.iter().filter(|word| !self.modifiers.contains(word)).copied().collect::<Vec<_>>(),
        );
        self.kinds.extend(more.kinds);
        self.scalar |= more.scalar;
        self.anything |= more.anything;
        self.labels |= more.labels;
        self
    }

    /// Whether a value can stand here.
    pub(super) fn takes(&self, value: &Value) -> bool {
        match value {
            _ if self.anything => true,
            Value::Scalar(_) => self.scalar,
            Value::Geometry(geometry) => self.kinds.contains(&geometry.kind()),
        }
    }
}

/// What can follow `before` by the forms of the word whose parameters the place is in; nothing if no form goes on
/// there, or the place is in the middle of an expression.
pub(super) fn next_by_forms(before: &[&Element], kind_of: impl Fn(&str) -> ValueKind) -> Option<Next> {
    let context = Context::innermost(before)?;
    let Opener::Word(word) = context.opener else { return None };
    if !context.begun().is_empty() {
        return None;
    }
    let typed = context.typed(&kind_of);
    let mut next = Next::default();
    for form in forms_of(word) {
        let matched = form.matched(&typed);
        if !matched.all {
            continue;
        }
        next.anything |= matched.more;
        for parameter in matched.next.iter().filter_map(|&index| form.parameters.get(index)) {
            match parameter.atom {
                Atom::Word(spelling) if !next.modifiers.contains(&spelling) => next.modifiers.push(spelling),
                Atom::Word(_) => {}
                Atom::Number(_) => next.scalar = true,
                Atom::Placeholder("mod" | "modifier") => {
                    let used = words().iter().filter(|one| one.used_in.contains(&word.spelling));
                    next.modifiers.extend(used.map(|one| one.spelling));
                }
                Atom::Placeholder(name) if name.starts_with("label") => next.labels = true,
                Atom::Placeholder(name) => match kinds_of(name) {
                    None => next.scalar = true,
                    Some([]) => next.anything = true,
                    Some(kinds) => next.kinds.extend(kinds),
                },
            }
        }
    }
    if next.anything {
        let used = words().iter().filter(|one| one.used_in.contains(&word.spelling)).map(|one| one.spelling);
        let more: Vec<_> = used.filter(|one| !next.modifiers.contains(one)).collect();
        next.modifiers.extend(more);
    }
    (next != Next::default()).then_some(next)
}

/// What can follow `before`, the elements before the place, if the place is in the parameters of a definition and
/// what is there begins a form of it. `kind_of` tells the type of a name's value, nothing for a number.
pub(super) fn next(before: &[&Element], kind_of: impl Fn(&str) -> Option<GeometryKind>) -> Option<Next> {
    let (kind, start) = innermost(before)?;
    let mut given = Vec::new();
    let mut argument: Vec<&Element> = Vec::new();
    let mut depth = 0_usize;
    for element in &before[start..] {
        match element.kind {
            ElementKind::Comma if depth == 0 => {
                given.push(argument_kind(&argument, &kind_of));
                argument.clear();
                continue;
            }
            ElementKind::LeftParenthesis => depth += 1,
            ElementKind::RightParenthesis => depth = depth.saturating_sub(1),
            _ => {}
        }
        argument.push(element);
    }
    if !argument.is_empty() {
        return None; // In the middle of an expression.
    }
    let mut next = Next::default();
    for kind in type_of_next(kind, &given) {
        match kind {
            ArgumentKind::Scalar => next.scalar = true,
            ArgumentKind::Modifier(word) => next.modifiers.push(word.word()),
            ArgumentKind::Geometry(kind) => next.kinds.push(kind),
            ArgumentKind::Empty => {}
        }
    }
    (next != Next::default()).then_some(next)
}

/// The definition whose parameters the end of `before` is in: its type, and where its parameters begin.
fn innermost(before: &[&Element]) -> Option<(GeometryKind, usize)> {
    let mut depth = 0_usize;
    for (index, element) in before.iter().enumerate().rev() {
        match element.kind {
            ElementKind::RightParenthesis => depth += 1,
            // A parenthesis that is open: the place is in a nested definition, or in an expression.
            ElementKind::LeftParenthesis if depth == 0 => return None,
            ElementKind::LeftParenthesis => depth -= 1,
            ElementKind::Slash if depth == 0 => {
                let word = before.get(index.checked_sub(1)?)?;
                return Some((GeometryKind::from_word(&word.text)?, index + 1));
            }
            _ => {}
        }
    }
    None
}

fn argument_kind(elements: &[&Element], kind_of: &impl Fn(&str) -> Option<GeometryKind>) -> ArgumentKind {
    let of_name = |name: &str| kind_of(name).map_or(ArgumentKind::Scalar, ArgumentKind::Geometry);
    match elements {
        [] => ArgumentKind::Empty,
        [one] if one.kind == ElementKind::Word => {
            Modifier::from_word(&one.text).map_or(ArgumentKind::Scalar, ArgumentKind::Modifier)
        }
        [one] => of_name(&one.text),
        [first, rest @ ..] if first.kind == ElementKind::LeftParenthesis => {
            // `(TYPE/…)`, `(NAME=TYPE/…)` or an expression.
            let nested = rest.iter().take(3).find_map(|element| {
                let word = lookup(&element.text).filter(|word| word.class == WordClass::GeometricType)?;
                GeometryKind::from_word(word.spelling)
            });
            nested.map_or(ArgumentKind::Scalar, ArgumentKind::Geometry)
        }
        // An element of an array.
        [name, parenthesis, ..] if parenthesis.kind == ElementKind::LeftParenthesis => of_name(&name.text),
        _ => ArgumentKind::Scalar,
    }
}
