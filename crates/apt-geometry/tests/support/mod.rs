//! Definitions written as in the language, for tables of tests: names, numbers, words and nested definitions, no
//! expressions. The real parser and evaluator are elsewhere; this splits text that is known to be well formed.

use std::collections::BTreeMap;

use apt_geometry::canonical::{Geometry, GeometryKind, Plane};
use apt_geometry::definition::{Argument, DefinitionContext, DefinitionError, Modifier, define};

/// The names defined so far and the ZSURF plane.
pub(crate) struct Session {
    pub(crate) names: BTreeMap<String, Geometry>,
    pub(crate) context: DefinitionContext,
}

impl Session {
    pub(crate) fn new() -> Session {
        Session { names: BTreeMap::new(), context: DefinitionContext::standard() }
    }

    /// Runs `NAME=TYPE/…` or `ZSURF/a,b,c,d`.
    pub(crate) fn run(&mut self, statement: &str) -> Result<Option<Geometry>, DefinitionError> {
        if let Some(parameters) = statement.strip_prefix("ZSURF/") {
            self.context.z_surface = match self.arguments(parameters)?.as_slice() {
                [Argument::Geometry(Geometry::Plane(plane))] => *plane,
                [Argument::Scalar(a), Argument::Scalar(b), Argument::Scalar(c), Argument::Scalar(d)] => {
                    Plane::from_equation(*a, *b, *c, *d).expect("a normal")
                }
                other => panic!("not a plane: {other:?}"),
            };
            return Ok(None);
        }
        let (name, body) = statement.split_once('=').unwrap_or_else(|| panic!("no name: {statement}"));
        let geometry = self.body(body)?;
        self.names.insert(name.to_owned(), geometry.clone());
        Ok(Some(geometry))
    }

    /// Evaluates `TYPE/…`.
    pub(crate) fn body(&self, body: &str) -> Result<Geometry, DefinitionError> {
        let (word, parameters) = body.split_once('/').unwrap_or_else(|| panic!("no type: {body}"));
        let kind = GeometryKind::from_word(word).unwrap_or_else(|| panic!("no such type: {word}"));
        define(kind, &self.arguments(parameters)?, &self.context)
    }

    pub(crate) fn arguments(&self, text: &str) -> Result<Vec<Argument>, DefinitionError> {
        split(text).into_iter().map(|item| self.argument(item)).collect()
    }

    fn argument(&self, item: &str) -> Result<Argument, DefinitionError> {
        if item.is_empty() {
            return Ok(Argument::Empty);
        }
        if let Some(nested) = item.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')) {
            let coordinates = nested.starts_with(|first: char| !first.is_ascii_alphabetic());
            let body = if coordinates { format!("POINT/{nested}") } else { nested.to_owned() };
            return Ok(Argument::Geometry(self.body(&body)?));
        }
        if let Some(geometry) = self.names.get(item) {
            return Ok(Argument::Geometry(geometry.clone()));
        }
        if let Some(modifier) = Modifier::from_word(item) {
            return Ok(Argument::Modifier(modifier));
        }
        Ok(Argument::Scalar(item.parse().unwrap_or_else(|_| panic!("neither name, word nor number: {item}"))))
    }
}

/// Splits at commas outside parentheses.
fn split(text: &str) -> Vec<&str> {
    let mut items = Vec::new();
    let (mut depth, mut start) = (0, 0);
    for (index, character) in text.char_indices() {
        match character {
            '(' => depth += 1,
            ')' => depth -= 1,
            ',' if depth == 0 => {
                items.push(&text[start..index]);
                start = index + 1;
            }
            _ => {}
        }
    }
    items.push(&text[start..]);
    items
}

/// Greatest difference of two rows, relative to the greatest magnitude in the expected one (at least 1).
pub(crate) fn difference(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len(), "found {found:?}, expected {expected:?}");
    let size = expected.iter().fold(1.0, |most: f64, value| most.max(value.abs()));
    found.iter().zip(expected).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())) / size
}
