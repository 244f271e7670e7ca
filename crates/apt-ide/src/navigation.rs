//! Definition, references, highlights and rename of names and labels.

use std::ops::Range;

use apt_syntax::{
    ParsedStatement,
    statement::{Body, Element, ElementKind},
};
use smol_str::SmolStr;

use crate::{Analysis, absolute, regions::Region, search::statements_with};

/// What a name stands for at a place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NameAt {
    /// The spelling, upper case.
    pub name: SmolStr,
    /// Where it stands, bytes of the text.
    pub range: Range<usize>,
    /// Where the name means the same.
    pub scope: Scope,
    /// A statement label or a jump target.
    pub label: bool,
}

/// Where a name means the same: the whole program, or the statements of a macro body or loop.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scope {
    /// First and last statement; `None` for the whole program.
    pub statements: Option<(usize, usize)>,
}

/// One occurrence of a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Occurrence {
    /// Where, bytes of the text.
    pub range: Range<usize>,
    /// It is given a value here.
    pub defines: bool,
}

/// Why a rename is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RenameError {
    /// There is no name at this place.
    #[error("there is no name here")]
    NoName,
    /// The new name is a vocabulary word.
    #[error("{0} is a word of the language")]
    Word(SmolStr),
    /// The new name breaks the rules of the dialect.
    #[error("{name} is not a name: {greatest} letters and digits at most, with at least one letter")]
    NotAName {
        /// What was asked for.
        name: SmolStr,
        /// How many characters the dialect allows.
        greatest: usize,
    },
    /// The new name is in use where the old one is.
    #[error("{0} is in use already")]
    InUse(SmolStr),
}

impl Analysis {
    /// The name at an offset.
    pub fn name_at(&self, offset: usize) -> Option<NameAt> {
        let (view, relative) = self.statement_at(offset)?;
        let parsed = view.parsed();
        let index = parsed.elements.iter().position(|element| {
            matches!(element.kind, ElementKind::Name | ElementKind::Number)
                && element.range.contains_inclusive(relative)
        })?;
        let element = &parsed.elements[index];
        let label = is_label(&parsed, index);
        if element.kind == ElementKind::Number && !label {
            return None;
        }
        let scope = self.element_scope(view.index, &parsed, index, label);
        Some(NameAt { name: element.text.clone(), range: absolute(&view, element.range), scope, label })
    }

    /// All occurrences of the name at an offset, in order.
    pub fn occurrences(&self, offset: usize) -> Vec<Occurrence> {
        let Some(at) = self.name_at(offset) else { return Vec::new() };
        self.occurrences_of(&at.name, at.label, &at.scope)
    }

    /// Where the name at an offset gets its value: all places, the one in force at the offset first.
    pub fn definitions_at(&self, offset: usize) -> Vec<Range<usize>> {
        let mut places: Vec<_> =
            self.occurrences(offset).into_iter().filter(|one| one.defines).map(|one| one.range).collect();
        let before = places.iter().rposition(|range| range.start <= offset);
        if let Some(before) = before {
            let inforce = places.remove(before);
            places.insert(0, inforce);
        }
        places
    }

    /// The edits that rename the name at an offset.
    ///
    /// # Errors
    ///
    /// [`RenameError`] when there is no name, or the new one cannot be used.
    pub fn rename(&self, offset: usize, new: &str) -> Result<Vec<(Range<usize>, String)>, RenameError> {
        let at = self.name_at(offset).ok_or(RenameError::NoName)?;
        let wanted = SmolStr::new(new.trim().to_ascii_uppercase());
        let greatest = self.document().tree().dialect().name_length.map_or(usize::MAX, usize::from);
        let spelled = wanted.chars().all(|c| c.is_ascii_alphanumeric());
        let lettered = at.label || wanted.chars().any(|c| c.is_ascii_alphabetic());
        if wanted.is_empty() || !spelled || !lettered || wanted.len() > greatest {
            return Err(RenameError::NotAName { name: wanted, greatest });
        }
        if apt_syntax::vocabulary::lookup(&wanted).is_some() {
            return Err(RenameError::Word(wanted));
        }
        if wanted != at.name && !self.occurrences_of(&wanted, at.label, &at.scope).is_empty() {
            return Err(RenameError::InUse(wanted));
        }
        let new = new.trim();
        Ok(self
            .occurrences_of(&at.name, at.label, &at.scope)
            .into_iter()
            .map(|one| (one.range, new.to_owned()))
            .collect())
    }

    fn occurrences_of(&self, name: &str, label: bool, scope: &Scope) -> Vec<Occurrence> {
        let tree = self.document().tree();
        let mut found = Vec::new();
        for index in statements_with(tree, name) {
            let view = tree.statement(index);
            let parsed = view.parsed();
            for (at, element) in parsed.elements.iter().enumerate() {
                let same = element.text == name && is_label(&parsed, at) == label;
                if same
                    && (label || element.kind == ElementKind::Name)
                    && self.element_scope(index, &parsed, at, label) == *scope
                {
                    found.push(Occurrence {
                        range: absolute(&view, element.range),
                        defines: defines(&parsed, at),
                    });
                }
            }
        }
        found
    }

    /// Where the name at an element means the same. In a CALL, what stands before `=` is a variable of the macro.
    fn element_scope(&self, statement: usize, parsed: &ParsedStatement, index: usize, label: bool) -> Scope {
        let element = &parsed.elements[index];
        let called = parsed.statement.parts.iter().find_map(|part| match &part.body {
            Body::Call { name, arguments, .. } => {
                arguments.iter().any(|argument| argument.name.range == element.range).then_some(&name.text)
            }
            _ => None,
        });
        let region = called.and_then(|called| {
            let named = |region: &&Region| region.name == *called && region.variables.contains(&element.text);
            let before = self.regions().iter().rfind(|region| named(region) && region.first < statement);
            before.or_else(|| self.regions().iter().find(named))
        });
        match region {
            Some(region) => Scope { statements: Some((region.first, region.last)) },
            None => self.scope(statement, &element.text, label),
        }
    }

    /// Labels are local to their loop or macro, macro variables to their macro.
    fn scope(&self, statement: usize, name: &str, label: bool) -> Scope {
        let innermost = |wanted: &dyn Fn(&Region) -> bool| {
            self.regions().iter().rfind(|region| region.contains(statement) && wanted(region))
        };
        let region = if label {
            innermost(&|region| region.first != statement || region.last != statement)
        } else {
            innermost(&|region| region.variables.iter().any(|variable| variable == name))
        };
        Scope { statements: region.map(|region| (region.first, region.last)) }
    }
}

/// Whether an element is a statement label or a jump target.
fn is_label(parsed: &ParsedStatement, index: usize) -> bool {
    let range = parsed.elements[index].range;
    let statement = &parsed.statement;
    let target = |body: &Body| match body {
        Body::ArithmeticIf { labels, .. } => labels.iter().any(|label| label.range == range),
        Body::Jump { label, .. } | Body::Do { label, .. } => label.range == range,
        _ => false,
    };
    statement.label.as_ref().is_some_and(|label| label.range == range)
        || statement.parts.iter().any(|part| match &part.body {
            Body::LogicalIf { then, .. } => target(&then.body),
            body => target(body),
        })
}

/// Whether the element at `index` is given a value by its statement: a label, a target of `=`, a macro variable of a
/// header, a name of OBTAIN or RESERV.
fn defines(parsed: &ParsedStatement, index: usize) -> bool {
    let element: &Element = &parsed.elements[index];
    let next = |at: usize| parsed.elements.get(at).map(|element| element.kind);
    if parsed.statement.label.as_ref().is_some_and(|label| label.range == element.range) {
        return true;
    }
    let in_part = |body: &Body| match body {
        Body::Macro { name, parameters, .. } => {
            name.range == element.range
                || parameters.iter().any(|parameter| parameter.name.range == element.range)
        }
        Body::Call { .. } => false,
        Body::Major { word, .. } if word.word.spelling == "RESERV" => true,
        Body::Obtain { .. } => {
            // The first name after the slash is the surface that is taken apart.
            let names = parsed.elements.iter().filter(|element| element.kind == ElementKind::Name);
            names.clone().count() > 0 && names.skip(1).any(|name| name.range == element.range)
        }
        Body::Assignment { target, .. } | Body::Definition { target, .. }
            if target.name.range == element.range =>
        {
            true
        }
        // A nested definition or assignment: `(NAME=…`, with an optional subscript.
        _ => {
            let mut at = index + 1;
            if next(at) == Some(ElementKind::LeftParenthesis) {
                let mut depth = 0_usize;
                while let Some(kind) = next(at) {
                    match kind {
                        ElementKind::LeftParenthesis => depth += 1,
                        ElementKind::RightParenthesis => depth = depth.saturating_sub(1),
                        _ => {}
                    }
                    at += 1;
                    if depth == 0 {
                        break;
                    }
                }
            }
            next(at) == Some(ElementKind::Equals)
        }
    };
    parsed.statement.parts.iter().any(|part| part.range.contains_range(element.range) && in_part(&part.body))
}
