//! In whose parameters a place stands, and what is typed of them.

use apt_syntax::{
    statement::{Element, ElementKind},
    vocabulary::{Word, WordClass, lookup},
};

use crate::forms::{Typed, ValueKind};

/// Whose parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Opener<'a> {
    /// A word's.
    Word(&'static Word),
    /// A macro's, in a CALL.
    Call(&'a str),
}

/// The parameters that a place stands in.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Context<'a> {
    /// Whose.
    pub(crate) opener: Opener<'a>,
    /// The elements of each parameter, the one that the place is in last, perhaps empty.
    pub(crate) parameters: Vec<&'a [&'a Element]>,
}

impl<'a> Context<'a> {
    /// The innermost parameters that the end of `before` stands in.
    pub(crate) fn innermost(before: &'a [&'a Element]) -> Option<Self> {
        let mut depth = 0_usize;
        for (index, element) in before.iter().enumerate().rev() {
            let word = index.checked_sub(1).and_then(|word| before.get(word)).copied();
            let word = word.filter(|word| word.kind == ElementKind::Word).and_then(|word| lookup(&word.text));
            match element.kind {
                ElementKind::RightParenthesis => depth += 1,
                ElementKind::LeftParenthesis if depth > 0 => depth -= 1,
                ElementKind::LeftParenthesis => {
                    if let Some(word) =
                        word.filter(|word| matches!(word.class, WordClass::Function | WordClass::Logic))
                    {
                        return Some(Self::of(Opener::Word(word), before.get(index + 1..)?));
                    }
                }
                ElementKind::Slash if depth == 0 => {
                    // A slash behind a name or a number divides.
                    if let Some(word) = word.filter(|word| word.class != WordClass::Minor) {
                        return Some(Self::behind_slash(word, before.get(index + 1..)?));
                    }
                }
                _ => {}
            }
        }
        None
    }

    fn behind_slash(word: &'static Word, parameters: &'a [&'a Element]) -> Self {
        match (word.spelling, parameters) {
            ("CALL", [name, comma, rest @ ..]) if comma.kind == ElementKind::Comma => {
                Self::of(Opener::Call(&name.text), rest)
            }
            _ => Self::of(Opener::Word(word), parameters),
        }
    }

    /// Divides elements at the commas outside of parentheses.
    fn of(opener: Opener<'a>, elements: &'a [&'a Element]) -> Self {
        let mut parameters = Vec::new();
        let (mut depth, mut start) = (0_usize, 0);
        for (index, element) in elements.iter().enumerate() {
            match element.kind {
                ElementKind::LeftParenthesis => depth += 1,
                ElementKind::RightParenthesis => depth = depth.saturating_sub(1),
                ElementKind::Comma if depth == 0 => {
                    parameters.extend(elements.get(start..index));
                    start = index + 1;
                }
                _ => {}
            }
        }
        parameters.extend(elements.get(start..));
        Self { opener, parameters }
    }

    /// The parameter that the place is in.
    pub(crate) fn begun(&self) -> &'a [&'a Element] {
        self.parameters.last().copied().unwrap_or_default()
    }

    /// What stands before the parameter that the place is in.
    pub(crate) fn typed(&self, kind_of: &impl Fn(&str) -> ValueKind) -> Vec<Typed<'a>> {
        let finished = self.parameters.len().saturating_sub(1);
        let mut typed = Vec::new();
        for parameter in self.parameters.iter().take(finished) {
            typed.extend(typed_parameter(parameter, kind_of));
            typed.push(Typed::Comma);
        }
        typed
    }
}

/// What the elements of one parameter are; nothing for none.
pub(crate) fn typed_parameter<'a>(
    elements: &[&'a Element],
    kind_of: &impl Fn(&str) -> ValueKind,
) -> Option<Typed<'a>> {
    Some(match elements {
        [] => return None,
        [word] if word.kind == ElementKind::Word => Typed::Word(&word.text),
        [name] if name.kind == ElementKind::Name => Typed::Value(kind_of(&name.text)),
        // `NAME(subscript)`
        [name, open, ..] if name.kind == ElementKind::Name && open.kind == ElementKind::LeftParenthesis => {
            Typed::Value(kind_of(&name.text))
        }
        // `(TYPE/…)`, `(NAME=TYPE/…)`, `(NAME(n)=TYPE/…)`, or an expression.
        [open, rest @ ..] if open.kind == ElementKind::LeftParenthesis => {
            let nested = rest.iter().find_map(|element| {
                let word = lookup(&element.text).filter(|word| word.class == WordClass::GeometricType)?;
                apt_geometry::canonical::GeometryKind::from_word(word.spelling)
            });
            Typed::Value(nested.map_or(ValueKind::Scalar, ValueKind::Geometry))
        }
        _ => Typed::Value(ValueKind::Scalar),
    })
}
