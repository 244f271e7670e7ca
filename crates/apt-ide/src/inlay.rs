//! Inlay hints: the values of names, behind the statements that give them.

use std::{ops::Range, path::Path};

use apt_geometry::patience::Waiting;
use apt_run::go_on;
use apt_syntax::{
    statement::{Argument, Body, Expression},
    tree::StatementView,
};
use rustc_hash::{FxBuildHasher, FxHashMap};

use crate::{Analysis, Cancel, Cancelled, absolute, hover::CanonicalForm};

/// A hint.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Inlay {
    /// Behind which byte of the text it stands.
    pub offset: usize,
    /// What it says.
    pub text: String,
    /// More about it, Markdown.
    pub tooltip: String,
}

/// The most hints of one answer: a screen has far fewer lines.
const GREATEST_INLAYS: usize = 2_000;

impl Analysis {
    /// The values that the statements in a range (bytes) give to names, where they do not stand there already: of
    /// scalars the number, of geometry its canonical form in a few words. A statement that was executed several times
    /// shows the last value.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn inlays(&self, range: Range<usize>, cancel: Cancel<'_>) -> Result<Vec<Inlay>, Cancelled> {
        self.inlays_in(None, range, cancel)
    }

    /// The same for a range of one of the files of the program; `None` is the program itself.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn inlays_in(
        &self,
        file: Option<&Path>,
        range: Range<usize>,
        cancel: Cancel<'_>,
    ) -> Result<Vec<Inlay>, Cancelled> {
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        self.with_marks(patience)?;
        let Some(tree) = self.files().iter().find(|one| one.is(file)).map(|one| &one.tree) else {
            return Ok(Vec::new());
        };
        if tree.statement_count() == 0 {
            return Ok(Vec::new());
        }
        let index = |offset: usize| tree.statement_at((offset.min(usize::from(tree.len())) as u32).into());
        let (first, last) = (index(range.start), index(range.end));
        let program = self.program(cancel)?;
        let isns = tree.statement(first).isn()..=tree.statement(last).isn();
        let mut events = Vec::new();
        for event in program.definitions() {
            go_on(patience, 1)?;
            let source = event.origin.source.as_ref().map(|source| source.path.as_path());
            if isns.contains(&event.origin.isn) && source == file {
                events.push(event);
            }
        }
        // A table that grows is made anew as a whole, which nobody can interrupt.
        let mut given: FxHashMap<(u32, &str), (usize, Option<u32>, &apt_program::Value)> =
            FxHashMap::with_capacity_and_hasher(events.len(), FxBuildHasher);
        for event in events {
            go_on(patience, 1)?;
            let times = given.get(&(event.origin.isn, event.name.as_str())).map_or(0, |(times, ..)| *times);
            given.insert((event.origin.isn, &event.name), (times + 1, event.subscript, &event.value));
        }
        let mut inlays = Vec::new();
        for view in (first..=last).map(|index| tree.statement(index)).take(GREATEST_INLAYS) {
            if cancel() {
                return Err(Cancelled);
            }
            for (name, end) in computed_targets(&view) {
                let Some((times, subscript, value)) = given.get(&(view.isn(), name.as_str())) else {
                    continue;
                };
                let title =
                    subscript.map_or_else(|| name.clone(), |subscript| format!("{name}({subscript})"));
                let form = CanonicalForm::new(&title, value);
                let text = match times {
                    1 => format!("= {}", form.text),
                    _ => format!("= {} (the last of {times})", form.text),
                };
                inlays.push(Inlay { offset: end, text, tooltip: form.markdown() });
            }
        }
        Ok(inlays)
    }
}

/// The names that a statement gives values to that do not stand there as numbers, with the byte behind the value.
fn computed_targets(view: &StatementView) -> Vec<(String, usize)> {
    let number = |expression: &Expression| match expression {
        Expression::Number { .. } => true,
        Expression::Sign { operand, .. } => matches!(**operand, Expression::Number { .. }),
        _ => false,
    };
    let plain =
        |argument: &Argument| matches!(argument, Argument::Expression(expression) if number(expression));
    let mut found = Vec::new();
    for part in &view.parsed().statement.parts {
        let target = match &part.body {
            Body::Assignment { target, value } if !number(value) => target,
            Body::Definition { target, definition } if !definition.arguments.iter().all(plain) => target,
            _ => continue,
        };
        found.push((target.name.text.to_string(), absolute(view, part.range).end));
    }
    found
}
