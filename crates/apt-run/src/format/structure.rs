//! What stands where: how deep every statement is nested, and which ones the author wants left alone.

use apt_geometry::patience::Patience;
use apt_syntax::{
    SyntaxTree,
    grammar::ParsedStatement,
    statement::{Body, Clause, Part},
    tree::StatementView,
};
use smol_str::SmolStr;

use crate::{Cancelled, go_on};

/// The place of one statement.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Place {
    /// How many macro bodies and loops it stands in.
    pub(super) depth: usize,
    /// Whether it stands between the marks `format off` and `format on`.
    pub(super) off: bool,
}

/// A bracket that is open, with the index of its statement.
enum Open {
    Macro(usize),
    Loop(usize),
    Do(usize, SmolStr),
    /// An IF over several statements, by its last clause.
    Branch(usize),
}

/// The places of all statements. Only macros and loops that are closed count, so that a program that is being typed
/// does not jump to and fro.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub(super) fn places(tree: &SyntaxTree, patience: Patience<'_>) -> Result<Vec<Place>, Cancelled> {
    let mut survey =
        Survey { places: Vec::with_capacity(tree.statement_count()), open: Vec::new(), bodies: Vec::new() };
    let mut off = false;
    for view in tree.statements() {
        go_on(patience, 1)?;
        let parsed = view.parsed();
        let mark = mark(&view, &parsed);
        // The marks themselves belong to what is left alone.
        let here = off || mark == Some(true);
        off = mark.unwrap_or(off);
        survey.places.push(Place { depth: 0, off: here });
        survey.statement(view.index, &parsed);
    }
    Ok(survey.nested())
}

struct Survey {
    places: Vec<Place>,
    open: Vec<Open>,
    /// First and last statement of every body.
    bodies: Vec<(usize, usize)>,
}

impl Survey {
    fn statement(&mut self, index: usize, parsed: &ParsedStatement) {
        for part in &parsed.statement.parts {
            self.part(index, part);
        }
        let Some(label) = &parsed.statement.label else { return };
        let label = label.label();
        // One labelled statement may end several DO loops; it is part of their bodies.
        while let Some(Open::Do(first, _)) =
            self.open.pop_if(|open| matches!(open, Open::Do(_, to) if *to == label))
        {
            self.bodies.push((first + 1, index));
        }
    }

    fn part(&mut self, index: usize, part: &Part) {
        match &part.body {
            Body::Macro { .. } => self.open.push(Open::Macro(index)),
            Body::Do { label, .. } => self.open.push(Open::Do(index, label.label())),
            Body::LogicalIf { then, .. } => then.iter().for_each(|part| self.part(index, part)),
            Body::Clause { clause, .. } => self.clause(index, clause),
            Body::Major { word, .. } => match word.word.spelling {
                "LOOPST" => self.open.push(Open::Loop(index)),
                "LOOPND" => self.close(index, |open| matches!(open, Open::Loop(_))),
                "TERMAC" => self.close(index, |open| matches!(open, Open::Macro(_))),
                _ => {}
            },
            _ => {}
        }
    }

    fn close(&mut self, index: usize, is_wanted: impl Fn(&Open) -> bool) {
        let Some(at) = self.open.iter().rposition(is_wanted) else { return };
        if let Some(Open::Macro(first) | Open::Loop(first) | Open::Branch(first)) = self.open.get(at) {
            // The closing statement stands below the opening one.
            self.bodies.push((first + 1, index.saturating_sub(1)));
        }
        self.open.truncate(at);
    }

    /// Clauses stand below each other, what is between them deeper.
    fn clause(&mut self, index: usize, clause: &Clause) {
        if !matches!(clause, Clause::If(_)) {
            self.close(index, |open| matches!(open, Open::Branch(_)));
        }
        if !matches!(clause, Clause::End) {
            self.open.push(Open::Branch(index));
        }
    }

    /// Adds up the bodies.
    fn nested(mut self) -> Vec<Place> {
        let mut steps = vec![0_isize; self.places.len() + 1];
        for (first, last) in self.bodies {
            if first > last {
                continue;
            }
            if let Some(step) = steps.get_mut(first) {
                *step += 1;
            }
            if let Some(step) = steps.get_mut(last + 1) {
                *step -= 1;
            }
        }
        let mut depth = 0_isize;
        for (place, step) in self.places.iter_mut().zip(steps) {
            depth += step;
            place.depth = usize::try_from(depth).unwrap_or(0);
        }
        self.places
    }
}

/// `$$ apt-lsp: format off` (true) or `on` (false).
fn mark(view: &StatementView, parsed: &ParsedStatement) -> Option<bool> {
    parsed.comments.iter().find_map(|range| {
        let comment = view.text().get(std::ops::Range::<usize>::from(*range))?;
        let rest = comment.trim().trim_start_matches(['$', ' ', '\t']).strip_prefix("apt-lsp:")?;
        let mut words = rest.split_whitespace();
        match (words.next(), words.next()) {
            (Some("format"), Some("off")) => Some(true),
            (Some("format"), Some("on")) => Some(false),
            _ => None,
        }
    })
}
