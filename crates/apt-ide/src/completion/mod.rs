//! Completion: the words and names that can stand at a place.

use apt_program::symbols::Value;
use apt_syntax::{
    statement::ElementKind,
    vocabulary::{Word, WordClass, words},
};
use rustc_hash::FxHashSet;

use crate::Analysis;

/// The kind of a completion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum CompletionKind {
    Name,
    Scalar,
    Macro,
    Modifier,
    Type,
    Function,
    Statement,
    Postprocessor,
}

/// One proposal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Completion {
    /// What is inserted.
    pub label: String,
    /// The kind.
    pub kind: CompletionKind,
    /// One line about it.
    pub detail: String,
    /// More about it, Markdown.
    pub documentation: String,
}

/// The most proposals of one answer.
const GREATEST_COMPLETIONS: usize = 1_000;

/// Where in a statement the cursor is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// At the start: a verb or a new name.
    Start,
    /// After `=`: a type, MACRO, an expression.
    Value,
    /// In a parameter list or expression.
    Parameter,
}

impl Analysis {
    /// What can be written at an offset. Names come from the last evaluation, if there is one, so that typing never
    /// waits for it.
    pub fn completions(&self, offset: usize) -> Vec<Completion> {
        let Some((view, relative)) = self.statement_at(offset) else { return Vec::new() };
        let parsed = view.parsed();
        let comment = view.text().find("$$").is_some_and(|at| at < usize::from(relative));
        if comment || parsed.elements.iter().any(|element| element.kind == ElementKind::Text) {
            return Vec::new();
        }
        let before: Vec<_> =
            parsed.elements.iter().filter(|element| element.range.end() < relative).collect();
        let first = parsed
            .elements
            .iter()
            .find(|element| element.kind == ElementKind::Word)
            .map(|one| one.text.as_str());
        let place = match before.last().map(|element| element.kind) {
            None => Place::Start,
            Some(ElementKind::RightParenthesis) if before.len() == 2 => Place::Start,
            Some(ElementKind::Equals) => Place::Value,
            _ => Place::Parameter,
        };
        let mut items: Vec<Completion> =
            words().iter().filter(|word| fits(word, place, first)).map(word_completion).collect();
        if place != Place::Start {
            items.extend(self.names());
        }
        items.sort_by(|a, b| (a.kind, &a.label).cmp(&(b.kind, &b.label)));
        items.truncate(GREATEST_COMPLETIONS);
        items
    }

    fn names(&self) -> Vec<Completion> {
        let mut items = Vec::new();
        if let Some(program) = self.document().evaluated() {
            let mut seen = FxHashSet::default();
            for (name, value) in program.symbols() {
                let stem = name.split('(').next().unwrap_or(&name).to_owned();
                if !seen.insert(stem.clone()) || items.len() >= GREATEST_COMPLETIONS {
                    continue;
                }
                let (kind, detail) = match value {
                    Value::Scalar(number) => (CompletionKind::Scalar, format!("{number}")),
                    Value::Geometry(geometry) => (CompletionKind::Name, geometry.kind().word().to_owned()),
                };
                items.push(Completion { label: stem, kind, detail, documentation: String::new() });
            }
        }
        for region in self.regions() {
            if !region.name.is_empty() {
                let detail = format!("MACRO/{}", region.variables.join(","));
                items.push(Completion {
                    label: region.name.to_string(),
                    kind: CompletionKind::Macro,
                    detail,
                    documentation: String::new(),
                });
            }
        }
        items
    }
}

fn fits(word: &Word, place: Place, verb: Option<&str>) -> bool {
    use WordClass as Class;
    match place {
        Place::Start => !matches!(word.class, Class::Minor | Class::GeometricType | Class::Function),
        Place::Value => {
            matches!(word.class, Class::GeometricType | Class::Function) || word.spelling == "MACRO"
        }
        Place::Parameter => match word.class {
            Class::GeometricType | Class::Function => true,
            Class::Minor => verb.is_none_or(|verb| used_in(word, verb)),
            _ => false,
        },
    }
}

/// Whether a minor word is known to be used with a verb; a word that says nothing about it is proposed everywhere.
fn used_in(word: &Word, verb: &str) -> bool {
    word.used_in.is_empty() || word.used_in.contains(&verb)
}

fn word_completion(word: &Word) -> Completion {
    let kind = match word.class {
        WordClass::Minor => CompletionKind::Modifier,
        WordClass::GeometricType => CompletionKind::Type,
        WordClass::Function => CompletionKind::Function,
        WordClass::Postprocessor | WordClass::PostprocessorBare => CompletionKind::Postprocessor,
        _ => CompletionKind::Statement,
    };
    Completion {
        label: word.spelling.to_owned(),
        kind,
        detail: word.help.to_owned(),
        documentation: crate::hover::word_markdown(word),
    }
}
