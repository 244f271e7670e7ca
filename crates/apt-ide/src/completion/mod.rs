//! Completion: the words and names that can stand at a place.

mod definition;
#[cfg(test)]
mod tests;

use apt_geometry::patience::{Patience, Waiting};
use apt_program::symbols::Value;
use apt_syntax::{
    dialect::DialectName,
    statement::{Element, ElementKind},
    tree::StatementView,
    vocabulary::{Word, WordClass, words},
};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

use crate::{
    Analysis, Cancel, Cancelled,
    context::{Context, Opener},
};
use definition::Next;

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
    /// What a client that knows snippets inserts instead: with places to fill in (`${1:x}`).
    pub snippet: Option<String>,
}

/// The most names of one answer; the nearest to the place are chosen.
const GREATEST_NAMES: usize = 500;

/// Where in a statement the cursor is.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Place {
    /// At the start: a verb or a new name.
    Start,
    /// After `=`: a type, MACRO, an expression.
    Value,
    /// The name of a macro after CALL.
    Macro,
    /// A variable in a CALL of this macro.
    Variable(SmolStr),
    /// A parameter of a definition or statement, by its forms.
    Definition(Next),
    /// A parameter where no form goes on.
    Parameter,
    /// In parentheses that have just been opened: a nested definition or an expression.
    Nested,
    /// In an expression.
    Expression,
    /// A name that is new here.
    NewName,
}

impl Analysis {
    /// What can be written at an offset: all that begins with what stands there already. Names come from the last
    /// evaluation of this program, perhaps of a version before this one, so that typing never waits for it.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn completions(&self, offset: usize, cancel: Cancel<'_>) -> Result<Vec<Completion>, Cancelled> {
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        self.with_files(patience)?;
        let Some((view, relative)) = self.statement_at(offset) else { return Ok(Vec::new()) };
        let parsed = view.parsed();
        let comment = parsed.comments.iter().any(|range| range.start() < relative && relative <= range.end());
        if comment || parsed.elements.iter().any(|element| element.kind == ElementKind::Text) {
            return Ok(Vec::new());
        }
        let spelled = |element: &&Element| matches!(element.kind, ElementKind::Word | ElementKind::Name);
        let begun =
            parsed.elements.iter().filter(spelled).find(|element| {
                element.range.start() < relative && element.range.contains_inclusive(relative)
            });
        let begun_at = begun.map_or(relative, |element| element.range.start());
        let length = usize::from(relative - begun_at);
        // Blanks inside of what is typed are not counted in its spelling; the whole of it is as good then.
        let prefix = begun.map_or("", |element| element.text.get(..length).unwrap_or(&element.text));
        let before: Vec<&Element> =
            parsed.elements.iter().filter(|element| element.range.end() <= begun_at).collect();
        // Parameters that stand there already are not to be written again.
        let behind = parsed.elements.iter().find(|element| element.range.start() >= relative);
        let bare = behind.is_none_or(|element| {
            use ElementKind::{Equals, LeftParenthesis, Slash};
            !matches!(element.kind, Slash | LeftParenthesis | Equals)
        });
        let verb = parsed.elements.iter().find(|element| element.kind == ElementKind::Word);
        let place = self.place(&before, patience);
        let wrapped = self.needs_parentheses(&before);
        let mut items: Vec<Completion> = words()
            .iter()
            .filter(|word| word.spelling.starts_with(prefix) && word.is_in(self.document().dialect()))
            .filter(|word| fits(word, &place, verb.map(|verb| verb.text.as_str())))
            .map(|word| word_completion(word, wrapped))
            .collect();
        items.extend(self.names(&place, prefix, &view, patience));
        if patience.was_over() {
            return Err(Cancelled);
        }
        if !bare {
            items.iter_mut().for_each(|item| item.snippet = None);
        }
        items.sort_by(|a, b| (rank(a, &place), &a.label).cmp(&(rank(b, &place), &b.label)));
        items.dedup();
        Ok(items)
    }

    /// Where the end of `before` is in its statement.
    fn place(&self, before: &[&Element], patience: Patience<'_>) -> Place {
        let spelling = |index: usize| before.get(index).map(|element| element.text.as_str());
        let labelled = before.len() >= 2 && before[1].kind == ElementKind::RightParenthesis;
        let begin = if labelled { 2 } else { 0 };
        let Some(last) = before.get(begin..).and_then(<[_]>::last) else { return Place::Start };
        if spelling(begin) == Some("CALL") && spelling(begin + 1) == Some("/") {
            match (last.kind, before.get(begin + 2)) {
                (ElementKind::Slash, _) => return Place::Macro,
                (ElementKind::Comma, Some(name)) => return Place::Variable(name.text.clone()),
                _ => {}
            }
        }
        if last.kind == ElementKind::Equals {
            let called = before.iter().any(|one| one.kind == ElementKind::Word && one.text == "CALL");
            return match called {
                true => Place::Definition(Next { anything: true, ..Next::default() }),
                false => Place::Value,
            };
        }
        let kind_of = |name: &str| self.kind_of(name, patience);
        let by_forms = || definition::next_by_forms(before, |name| self.value_kind(name));
        let next = match definition::next(before, kind_of) {
            // The table of the definitions does not hold those of space curves and sculptured surfaces.
            Some(next) if self.document().dialect() == DialectName::Apt4 => {
                Some(by_forms().map_or(next.clone(), |more| next.with(more)))
            }
            next => next.or_else(by_forms),
        };
        match (next, last.kind) {
            (Some(next), _) => Place::Definition(next),
            (None, ElementKind::Slash | ElementKind::Comma) if names_macro(before) => Place::NewName,
            (None, ElementKind::Slash | ElementKind::Comma) => Place::Parameter,
            (None, ElementKind::LeftParenthesis) => Place::Nested,
            (None, _) => Place::Expression,
        }
    }

    /// Whether an expression that begins behind `before` needs parentheses: in the list of a statement or definition,
    /// where the dialect takes no bare expressions.
    fn needs_parentheses(&self, before: &[&Element]) -> bool {
        let begins =
            before.last().is_some_and(|last| matches!(last.kind, ElementKind::Slash | ElementKind::Comma));
        let of_function = matches!(
            Context::innermost(before),
            Some(Context { opener: Opener::Word(word), .. }) if word.class == WordClass::Function
        );
        begins && !of_function && !self.document().tree().dialect().bare_expressions
    }

    /// What a name is, as far as it has been looked for where who waits gives up.
    fn kind_of(&self, name: &str, patience: Patience<'_>) -> Option<apt_geometry::canonical::GeometryKind> {
        let events = self.known_program()?.definitions().take_while(|_| !patience.ends_after(1));
        let event = events.filter(|event| event.name == name).last()?;
        match &event.value {
            Value::Geometry(geometry) => Some(geometry.kind()),
            Value::Scalar(_) => None,
        }
    }

    /// The names that fit at a place, some of them where who waits gives up before the end.
    fn names(
        &self,
        place: &Place,
        prefix: &str,
        view: &StatementView,
        patience: Patience<'_>,
    ) -> Vec<Completion> {
        let isn = view.isn();
        match place {
            Place::Start | Place::NewName => Vec::new(),
            Place::Macro => self.macros(prefix),
            Place::Variable(name) => self.variables(name, prefix),
            Place::Definition(next) => {
                let mut found = self.values(prefix, isn, |value| next.takes(value), patience);
                if next.labels {
                    found.extend(self.labels(prefix, view.index, patience));
                }
                found
            }
            Place::Value | Place::Parameter | Place::Nested | Place::Expression => {
                self.values(prefix, isn, |_| true, patience)
            }
        }
    }

    /// The labels that a jump in a statement can lead to: those of its macro or loop, else those outside of both.
    fn labels(&self, prefix: &str, statement: usize, patience: Patience<'_>) -> Vec<Completion> {
        let tree = self.document().tree();
        let regions = self.regions();
        let innermost = |statement: usize| regions.iter().rposition(|region| region.contains(statement));
        let here = innermost(statement);
        let (first, last) = match here.and_then(|index| regions.get(index)) {
            Some(region) => (region.first, region.last),
            None => (0, tree.statement_count()),
        };
        let mut found = Vec::new();
        for view in tree.statements().skip(first).take(last.saturating_sub(first) + 1) {
            if patience.ends_after(1) {
                break;
            }
            if !begins_with_label(view.text().as_bytes()) || innermost(view.index) != here {
                continue;
            }
            let parsed = view.parsed();
            let Some(label) = &parsed.statement.label else { continue };
            if label.text.starts_with(prefix) && found.len() < GREATEST_NAMES {
                let detail = format!("label of statement {}", view.isn());
                found.push(plain(&label.text, CompletionKind::Name, detail));
            }
        }
        found
    }

    /// Names with a value, the nearest to a statement first if there are too many.
    fn values(
        &self,
        prefix: &str,
        isn: u32,
        wanted: impl Fn(&Value) -> bool,
        patience: Patience<'_>,
    ) -> Vec<Completion> {
        let Some(program) = self.known_program() else { return Vec::new() };
        let mut last: FxHashMap<&SmolStr, (u32, &Value, bool)> = FxHashMap::default();
        for event in program.definitions().take_while(|_| !patience.ends_after(1)) {
            if event.name.starts_with(prefix) {
                let distance = event.origin.isn.abs_diff(isn);
                last.insert(&event.name, (distance, &event.value, event.subscript.is_some()));
            }
        }
        let mut found: Vec<_> = last.into_iter().filter(|(_, (_, value, _))| wanted(value)).collect();
        if found.len() > GREATEST_NAMES {
            found.select_nth_unstable_by_key(GREATEST_NAMES, |(name, (distance, ..))| (*distance, *name));
            found.truncate(GREATEST_NAMES);
        }
        let item = |(name, (_, value, subscripted)): (&SmolStr, (u32, &Value, bool))| {
            let (kind, detail) = match value {
                _ if subscripted => (CompletionKind::Name, "subscripted".to_owned()),
                Value::Scalar(number) => (CompletionKind::Scalar, crate::hover::number(*number)),
                Value::Geometry(geometry) => (CompletionKind::Name, geometry.kind().word().to_owned()),
            };
            plain(name, kind, detail)
        };
        found.into_iter().map(item).collect()
    }

    fn macros(&self, prefix: &str) -> Vec<Completion> {
        let named =
            self.files().iter().flat_map(|file| &file.regions).filter(|region| !region.name.is_empty());
        let begun = named.filter(|region| region.name.starts_with(prefix));
        begun
            .map(|region| {
                let detail = format!("MACRO/{}", region.variables.join(","));
                let variables = self.macro_variables(&region.name).unwrap_or_default();
                let needed = variables.iter().filter(|(_, default)| default.is_none()).zip(1..);
                let places = needed.map(|((name, _), place)| format!(",{name}=${{{place}:{name}}}"));
                let snippet = format!("{}{}$0", region.name, places.collect::<String>());
                Completion { snippet: Some(snippet), ..plain(&region.name, CompletionKind::Macro, detail) }
            })
            .collect()
    }

    fn variables(&self, name: &str, prefix: &str) -> Vec<Completion> {
        let variables = self.macro_variables(name).unwrap_or_default();
        let begun = variables.iter().filter(|(variable, _)| variable.starts_with(prefix));
        begun
            .map(|(variable, default)| {
                let detail = match default {
                    Some(default) => format!("variable of {name}, {default} if not given"),
                    None => format!("variable of {name}"),
                };
                let value = default.as_deref().unwrap_or(variable);
                let snippet = Some(format!("{variable}=${{1:{value}}}$0"));
                Completion { snippet, ..plain(variable, CompletionKind::Scalar, detail) }
            })
            .collect()
    }
}

fn plain(label: &str, kind: CompletionKind, detail: String) -> Completion {
    Completion { label: label.to_owned(), kind, detail, documentation: String::new(), snippet: None }
}

/// The order of the list: what the forms ask for comes first, words of definitions in the order of the forms.
fn rank(item: &Completion, place: &Place) -> (usize, CompletionKind) {
    match place {
        Place::Definition(next) => {
            let at = next.modifiers.iter().position(|word| *word == item.label);
            (
                at.map_or(if item.kind == CompletionKind::Modifier { usize::MAX } else { 0 }, |at| at + 1),
                item.kind,
            )
        }
        _ => (0, item.kind),
    }
}

fn fits(word: &Word, place: &Place, verb: Option<&str>) -> bool {
    use WordClass as Class;
    match place {
        Place::Start => !matches!(word.class, Class::Minor | Class::GeometricType | Class::Function),
        Place::Value => {
            matches!(word.class, Class::GeometricType | Class::Function) || word.spelling == "MACRO"
        }
        Place::Macro | Place::Variable(_) | Place::NewName => false,
        Place::Definition(next) => match word.class {
            Class::Function => next.scalar,
            Class::Minor => next.modifiers.contains(&word.spelling),
            _ => false,
        },
        Place::Parameter => match word.class {
            Class::Function => true,
            Class::Minor => verb.is_some_and(|verb| word.used_in.contains(&verb)),
            _ => false,
        },
        Place::Nested => matches!(word.class, Class::GeometricType | Class::Function),
        Place::Expression => word.class == Class::Function,
    }
}

/// Whether what stands before is the header of a macro up to one of its variables.
fn names_macro(before: &[&Element]) -> bool {
    before.iter().any(|element| element.kind == ElementKind::Word && element.text == "MACRO")
}

/// Whether a statement may begin with a label: letters and digits, blanks among them, and a parenthesis.
fn begins_with_label(text: &[u8]) -> bool {
    let end = text.iter().position(|byte| !byte.is_ascii_alphanumeric() && !byte.is_ascii_whitespace());
    end.is_some_and(|end| text.get(end) == Some(&b')'))
}

/// A word as a proposal; `wrapped` in parentheses if it begins an expression that needs them.
fn word_completion(word: &Word, wrapped: bool) -> Completion {
    let kind = match word.class {
        WordClass::Minor => CompletionKind::Modifier,
        WordClass::GeometricType => CompletionKind::Type,
        WordClass::Function => CompletionKind::Function,
        WordClass::Postprocessor | WordClass::PostprocessorBare => CompletionKind::Postprocessor,
        _ => CompletionKind::Statement,
    };
    let mut snippet = crate::forms::forms_of(word).first().and_then(|form| form.snippet(word.spelling));
    if wrapped && word.class == WordClass::Function {
        snippet = snippet.map(|snippet| format!("({})$0", snippet.trim_end_matches("$0")));
    }
    Completion {
        label: word.spelling.to_owned(),
        kind,
        detail: word.help.to_owned(),
        documentation: crate::hover::word_markdown(word),
        snippet,
    }
}
