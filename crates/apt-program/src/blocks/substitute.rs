//! Substitution by token: macro variables and synonyms are replaced in the elements, and the statement is parsed anew
//! (language reference 7.2, 7.5).

use std::sync::Arc;

use apt_syntax::{
    Dialect, ParsedStatement, parse_elements,
    statement::{Element, ElementKind},
};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

use crate::evaluator::{State, Synonym};

/// The values of the variables of one macro call.
#[derive(Debug, Clone, Default)]
pub(crate) struct Bindings {
    values: FxHashMap<SmolStr, Vec<Element>>,
}

impl Bindings {
    /// Binds a variable.
    pub(crate) fn bind(&mut self, name: SmolStr, value: Vec<Element>) {
        self.values.insert(name, value);
    }

    /// Whether any element is a variable.
    fn concerns(&self, elements: &[Element]) -> bool {
        !self.values.is_empty()
            && elements
                .iter()
                .any(|element| is_replaceable(element) && self.values.contains_key(&element.text))
    }

    /// The statement with the variables replaced; the statement itself if it has none.
    pub(crate) fn apply(&self, statement: &Arc<ParsedStatement>, dialect: &Dialect) -> Arc<ParsedStatement> {
        if !self.concerns(&statement.elements) {
            return Arc::clone(statement);
        }
        reparsed(statement, &self.replaced(&statement.elements), dialect)
    }

    /// The elements with the variables replaced, at the places where the variables stood.
    pub(crate) fn replaced(&self, elements: &[Element]) -> Vec<Element> {
        let is_call = first_word(elements) == Some("CALL");
        let mut replaced = Vec::with_capacity(elements.len() + 8);
        for (index, element) in elements.iter().enumerate() {
            let value = self.values.get(&element.text).filter(|_| is_replaceable(element));
            let next = elements.get(index + 1).map(|next| next.kind);
            let previous =
                index.checked_sub(1).and_then(|index| elements.get(index)).map(|element| element.kind);
            let is_formal =
                is_call && previous == Some(ElementKind::Comma) && next == Some(ElementKind::Equals);
            match value {
                Some(value) if !is_formal => {
                    let is_value = next == Some(ElementKind::Equals)
                        || (is_call && previous == Some(ElementKind::Equals));
                    splice(&mut replaced, element, value, (previous, next), is_value);
                }
                _ => replaced.push(element.clone()),
            }
        }
        replaced
    }
}

/// Names and words can be variables; a variable may have the spelling of a word of a later dialect.
fn is_replaceable(element: &Element) -> bool {
    matches!(element.kind, ElementKind::Name | ElementKind::Word)
}

/// The first element after a label.
fn first_word(elements: &[Element]) -> Option<&str> {
    let labelled = elements.get(1).is_some_and(|element| element.kind == ElementKind::RightParenthesis);
    elements.get(if labelled { 2 } else { 0 }).map(|element| element.text.as_str())
}

/// Puts a value in the place of a variable; in parentheses where its signs and operators would otherwise bind to the
/// elements around it.
pub(crate) fn splice(
    into: &mut Vec<Element>,
    variable: &Element,
    value: &[Element],
    (previous, next): (Option<ElementKind>, Option<ElementKind>),
    is_value: bool,
) {
    let has_sign =
        matches!(value.first().map(|element| element.kind), Some(ElementKind::Plus | ElementKind::Minus));
    let after_operator = matches!(
        previous,
        Some(ElementKind::Plus | ElementKind::Minus | ElementKind::Star | ElementKind::Power)
    );
    let binds = is_expression(value) || (has_sign && (after_operator || next == Some(ElementKind::Power)));
    let wrap = binds && !is_value;
    let placed =
        |kind: ElementKind, text: &str| Element { kind, text: SmolStr::new(text), range: variable.range };
    if wrap {
        into.push(placed(ElementKind::LeftParenthesis, "("));
    }
    into.extend(value.iter().map(|element| placed(element.kind, &element.text)));
    if wrap {
        into.push(placed(ElementKind::RightParenthesis, ")"));
    }
}

/// Whether a value has an operator outside parentheses, not counting a leading sign.
fn is_expression(value: &[Element]) -> bool {
    let mut depth = 0_u32;
    value.iter().enumerate().any(|(index, element)| {
        match element.kind {
            ElementKind::LeftParenthesis => depth += 1,
            ElementKind::RightParenthesis => depth = depth.saturating_sub(1),
            ElementKind::Plus
            | ElementKind::Minus
            | ElementKind::Star
            | ElementKind::Slash
            | ElementKind::Power => return depth == 0 && index > 0,
            _ => {}
        }
        false
    })
}

impl State {
    /// The statement with synonyms replaced; the statement itself if there are none in it.
    pub(crate) fn without_synonyms(
        &self,
        statement: &Arc<ParsedStatement>,
        dialect: &Dialect,
    ) -> Arc<ParsedStatement> {
        if self.synonyms.is_empty() {
            return Arc::clone(statement);
        }
        let is_synonym =
            |element: &Element| is_replaceable(element) && self.synonyms.contains_key(&element.text);
        if !statement.elements.iter().any(is_synonym) || first_word(&statement.elements) == Some("SYN") {
            return Arc::clone(statement);
        }
        let elements: Vec<Element> = statement
            .elements
            .iter()
            .map(|element| match self.synonyms.get(&element.text) {
                Some(Synonym::Word(word)) if is_replaceable(element) => {
                    Element { kind: ElementKind::Word, text: word.clone(), range: element.range }
                }
                Some(Synonym::Name) if is_replaceable(element) => {
                    Element { kind: ElementKind::Name, text: element.text.clone(), range: element.range }
                }
                _ => element.clone(),
            })
            .collect();
        reparsed(statement, &elements, dialect)
    }
}

/// A statement whose elements were replaced. What the lexer said of the original still holds.
fn reparsed(original: &ParsedStatement, elements: &[Element], dialect: &Dialect) -> Arc<ParsedStatement> {
    let mut parsed = parse_elements(elements, dialect);
    for error in original.errors.iter().filter(|error| error.kind.is_lexical()) {
        parsed.errors.retain(|other| other.range != error.range);
        parsed.errors.push(error.clone());
    }
    parsed.errors.sort_by_key(|error| error.range.start());
    Arc::new(parsed)
}
