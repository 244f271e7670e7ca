//! Changes of the program that settle findings of Section 1.
//!
//! A fix is offered where its place and its text are sure; whether it is what the author meant is another question, and
//! only where that is sure too it is preferred. Statements of included files are not changed from here.

mod block;
mod motion;
mod spelling;

#[cfg(test)]
mod tests;

use std::ops::Range;

use apt_program::{ControlFinding, Finding, FindingKind, Origin, SculpturedFinding, symbols::similar_names};
use apt_syntax::{
    SyntaxTree, TextRange, TextSize,
    dialect::name_in_comment,
    error::SyntaxErrorKind,
    grammar::ParsedStatement,
    statement::{Body, ElementKind},
    tree::StatementView,
};
use smol_str::SmolStr;

use crate::{diagnostic::Fix, document, settings::Settings};

/// The fixes of a finding, the likeliest first. A comment that names the dialect counts for nothing where the settings do.
pub(crate) fn of_finding(tree: &SyntaxTree, finding: &Finding, settings: &Settings) -> Vec<Fix> {
    let needs_comment = matches!(finding.kind, FindingKind::Syntax(SyntaxErrorKind::NotInDialect { .. }));
    if needs_comment && settings.dialect.is_some() {
        return Vec::new();
    }
    let Some(here) = Here::of(tree, &finding.origin) else { return Vec::new() };
    let index = here.view.index;
    match &finding.kind {
        FindingKind::Syntax(kind) => here.syntax(kind),
        FindingKind::Undefined { name, similar } => {
            here.misspelt(name, &here.words_or_names_like(name, similar))
        }
        FindingKind::ListedUndefined { name, similar }
        | FindingKind::UndefinedOption { name, similar, .. }
        | FindingKind::Control(ControlFinding::UnknownLabel { name, similar })
        | FindingKind::Control(ControlFinding::UnknownMacro { name, similar }) => {
            here.misspelt(name, similar)
        }
        FindingKind::Control(ControlFinding::UnknownMacroVariable { parameter, known, .. }) => {
            here.misspelt(parameter, &similar_names(parameter, known.iter().map(SmolStr::as_str)))
        }
        FindingKind::Unused { name } => here.unused(name).into_iter().collect(),
        // In a loop or macro that is still open it would be wrong: that is closed first.
        FindingKind::EndMissing if !finding.related.is_empty() => Vec::new(),
        FindingKind::EndMissing => block::end_of_program(tree).into_iter().collect(),
        FindingKind::Control(ControlFinding::MacroNotClosed { .. }) => {
            block::end_of_block(tree, index, "TERMAC").into_iter().collect()
        }
        FindingKind::Control(ControlFinding::LoopNotClosed) => {
            block::end_of_block(tree, index, "LOOPND").into_iter().collect()
        }
        FindingKind::Control(ControlFinding::EndInRegion)
        | FindingKind::Control(ControlFinding::MacroInRegion) => {
            block::end_before(&here.view, &here.parsed, finding)
        }
        FindingKind::Control(ControlFinding::MacroEndAlone)
        | FindingKind::Control(ControlFinding::LoopEndAlone)
        | FindingKind::AfterEnd
        | FindingKind::Unreachable => here.without_statement("Remove the statement").into_iter().collect(),
        FindingKind::PostBare { .. } => here.without_parameters().into_iter().collect(),
        FindingKind::Redefined { name, .. } => {
            here.line_before("CANON/ON", format!("Allow {name} to be defined again")).into_iter().collect()
        }
        FindingKind::Sculptured(SculpturedFinding::OlderSpelling { present, .. }) => {
            let edits = vec![(here.bytes(finding.origin.range), present.to_string())];
            vec![Fix { title: format!("Write {present}"), edits, preferred: true }]
        }
        FindingKind::Sculptured(SculpturedFinding::AvoidanceWithoutCheck) => here
            .line_before("CHKSRF/PS,ON", "Check the part surface for interference".to_owned())
            .into_iter()
            .collect(),
        _ => Vec::new(),
    }
}

pub(crate) use motion::of_run;
pub(crate) use spelling::{operands_like, words_like};

/// The program without the statement of a place, where it stands in the program itself, does nothing else and can go
/// away whole.
pub(crate) fn removal(tree: &SyntaxTree, origin: &Origin, title: &str) -> Option<Fix> {
    let here = Here::of(tree, origin)?;
    let equals = here.parsed.elements.iter().filter(|element| element.kind == ElementKind::Equals).count();
    let single = here.parsed.statement.parts.len() == 1 && equals <= 1 && !here.parsed.is_broken();
    if single { here.without_statement(title) } else { None }
}

/// The statement of a place written anew, where it does nothing else and stands on one line.
pub(crate) fn rewriting(tree: &SyntaxTree, origin: &Origin, title: String, text: String) -> Option<Fix> {
    let here = Here::of(tree, origin)?;
    let elements = &here.parsed.elements;
    let first = match here.parsed.statement.label {
        None => elements.first()?,
        // The label keeps its place.
        Some(_) => elements.iter().find(|element| element.range.start() >= origin.range.start())?,
    };
    let whole = TextRange::new(first.range.start(), elements.last()?.range.end());
    let single = here.parsed.statement.parts.len() == 1 && !here.parsed.is_broken();
    let one_line = !here.written(whole).contains(['\n', '\r']);
    (single && one_line).then(|| Fix { title, edits: vec![(here.bytes(whole), text)], preferred: false })
}

/// The program with statements of their own lines before the one of a place, where that begins a line.
pub(crate) fn inserting(
    tree: &SyntaxTree,
    origin: &Origin,
    statements: &[String],
    title: String,
) -> Option<Fix> {
    let here = Here::of(tree, origin).filter(|here| !here.parsed.is_broken())?;
    here.lines_before(statements, title)
}

/// The statement of a place of the program itself as it is written, without comments, if it does nothing else and
/// stands on one line.
pub(crate) fn written(tree: &SyntaxTree, origin: &Origin) -> Option<String> {
    let here = Here::of(tree, origin)?;
    let elements = &here.parsed.elements;
    let whole = TextRange::new(elements.first()?.range.start(), elements.last()?.range.end());
    let text = here.written(whole);
    let single = here.parsed.statement.parts.len() == 1 && here.parsed.statement.label.is_none();
    (single && !text.contains(['\n', '\r'])).then(|| text.to_owned())
}

/// The statement that a finding is about.
struct Here<'a> {
    tree: &'a SyntaxTree,
    view: StatementView,
    parsed: std::sync::Arc<ParsedStatement>,
    origin: &'a Origin,
}

impl<'a> Here<'a> {
    /// The statement of a place; none in included files.
    fn of(tree: &'a SyntaxTree, origin: &'a Origin) -> Option<Self> {
        let last = tree.statement_count().checked_sub(1).filter(|_| origin.source.is_none())?;
        let view = tree.statement((origin.isn.max(1) as usize - 1).min(last));
        Some(Here { tree, parsed: view.parsed(), view, origin })
    }
}

impl Here<'_> {
    /// Bytes of the text for a range of the statement.
    fn bytes(&self, range: TextRange) -> Range<usize> {
        let start = usize::from(self.view.start);
        start + usize::from(range.start())..start + usize::from(range.end())
    }

    fn written(&self, range: TextRange) -> &str {
        self.view.text().get(Range::<usize>::from(range)).unwrap_or("")
    }

    fn syntax(&self, kind: &SyntaxErrorKind) -> Vec<Fix> {
        let here = self.origin.range;
        let one = |title: &str, range: TextRange, text: &str, preferred| {
            vec![Fix {
                title: title.to_owned(),
                edits: vec![(self.bytes(range), text.to_owned())],
                preferred,
            }]
        };
        let before = TextRange::empty(here.start());
        match kind {
            SyntaxErrorKind::NameWithoutEquals { name, .. }
            | SyntaxErrorKind::ListWithoutWord { name, .. } => {
                self.misspelt(name, &words_like(self.tree.dialect(), kind))
            }
            SyntaxErrorKind::NotInDialect { dialect, .. } => {
                let named = name_in_comment(&document::head_of(self.tree));
                let comment = || (0..0, format!("$$ apt-lsp: dialect={dialect}{}", self.line_end()));
                vec![Fix {
                    title: format!("Set the dialect of the program to {dialect}"),
                    edits: vec![named.map_or_else(comment, |name| (name, dialect.to_string()))],
                    preferred: false,
                }]
            }
            SyntaxErrorKind::MissingSeparator => {
                let is_list = self.is_in_list(here.start());
                let next = self.parsed.elements.iter().find(|element| element.range.start() >= here.start());
                let (is_comma, is_word) = next.map_or((false, false), |next| {
                    (next.kind == ElementKind::Comma, next.kind == ElementKind::Word)
                });
                let mut fixes = Vec::new();
                if is_list && !is_comma {
                    fixes.extend(one("Insert a comma", before, ",", false));
                }
                if !is_list && !is_comma && !is_word {
                    fixes.extend(one("Insert *", before, "*", false));
                }
                fixes
            }
            SyntaxErrorKind::ObtainComma(_) => one("Write a slash", here, "/", true),
            SyntaxErrorKind::UnopenedParenthesis => one("Remove the parenthesis", here, "", false),
            SyntaxErrorKind::UnclosedParenthesis => match self.parsed.elements.last() {
                Some(last) => one(
                    "Close it at the end of the statement",
                    TextRange::empty(last.range.end()),
                    ")",
                    false,
                ),
                None => Vec::new(),
            },
            SyntaxErrorKind::EndsOnPunctuation => self.without_last_mark().into_iter().collect(),
            SyntaxErrorKind::TextWordNotInColumnOne { .. } => {
                let blanks = self.view.text().len() - self.view.text().trim_start_matches([' ', '\t']).len();
                let start = usize::from(self.view.start);
                let edit = (start..start + blanks, String::new());
                let title = "Move it to the start of the line".to_owned();
                let fix = Fix { title, edits: vec![edit], preferred: true };
                if blanks > 0 { vec![fix] } else { Vec::new() }
            }
            SyntaxErrorKind::TakesNoParameters(_) => self.without_parameters().into_iter().collect(),
            _ => Vec::new(),
        }
    }

    /// Whether parameters are listed at a place: behind the slash of a word a comma separates them, and they take no
    /// operators; in parentheses and elsewhere a comma separates nothing.
    fn is_in_list(&self, place: TextSize) -> bool {
        let mut closed = 0_usize;
        let before = self.parsed.elements.iter().take_while(|element| element.range.end() <= place);
        let before: Vec<ElementKind> = before.map(|element| element.kind).collect();
        // Inside the innermost parentheses that are open there, what stands in closed ones left out.
        let open = before.iter().rev().take_while(|kind| {
            match kind {
                ElementKind::RightParenthesis => closed += 1,
                ElementKind::LeftParenthesis if closed == 0 => return false,
                ElementKind::LeftParenthesis => closed -= 1,
                _ => {}
            }
            true
        });
        let first = before.len() - open.count();
        before[first..].windows(2).any(|pair| pair == [ElementKind::Word, ElementKind::Slash])
    }

    /// Another spelling for a name, if the name stands once in the place of the finding.
    fn misspelt(&self, name: &str, similar: &[SmolStr]) -> Vec<Fix> {
        let here = self.origin.range;
        let is_name = |kind| matches!(kind, ElementKind::Name | ElementKind::Word | ElementKind::Number);
        let mut places = self.parsed.elements.iter().filter(|element| {
            is_name(element.kind)
                && element.text == name
                && (here.contains_range(element.range) || here.is_empty())
        });
        let (Some(place), None) = (places.next(), places.next()) else { return Vec::new() };
        let fix = |other: &SmolStr| Fix {
            title: format!("Replace {name} by {other}"),
            edits: vec![(self.bytes(place.range), other.to_string())],
            preferred: similar.len() == 1,
        };
        similar.iter().map(fix).collect()
    }

    /// The statement without its last mark.
    fn without_last_mark(&self) -> Option<Fix> {
        let last = self.parsed.elements.last()?;
        let mark = self.written(last.range);
        (matches!(last.kind, ElementKind::Comma)).then(|| Fix {
            title: format!("Remove the {mark} at the end"),
            edits: vec![(self.bytes(last.range), String::new())],
            preferred: false,
        })
    }

    /// The word alone, without the slash and what follows it.
    fn without_parameters(&self) -> Option<Fix> {
        let here = self.origin.range;
        let elements = &self.parsed.elements;
        let slash = elements
            .iter()
            .filter(|element| element.kind == ElementKind::Slash)
            .find(|slash| slash.range.start() >= here.start() || here.contains_range(slash.range))?;
        let last = elements.last()?;
        let range = TextRange::new(slash.range.start(), last.range.end());
        let one_line = !self.written(range).contains(['\n', '\r']);
        one_line.then(|| Fix {
            title: "Remove the parameters".to_owned(),
            edits: vec![(self.bytes(range), String::new())],
            preferred: false,
        })
    }

    /// The program without a definition that nobody reads, if the statement does nothing else.
    fn unused(&self, name: &str) -> Option<Fix> {
        let [part] = self.parsed.statement.parts.as_slice() else { return None };
        let target = match &part.body {
            Body::Assignment { target, .. } | Body::Definition { target, .. } => target,
            _ => return None,
        };
        let equals =
            self.parsed.elements.iter().filter(|element| element.kind == ElementKind::Equals).count();
        if target.name.text != name || target.subscript.is_some() || equals != 1 {
            return None;
        }
        self.without_statement(&format!("Remove the definition of {name}"))
    }

    /// The program without this statement. Comments stay, and a label keeps its statement.
    fn without_statement(&self, title: &str) -> Option<Fix> {
        let begins_line = self.begins_line();
        let elements = &self.parsed.elements;
        let (first, last) = (elements.first()?, elements.last()?);
        let whole = TextRange::new(first.range.start(), last.range.end());
        if self.parsed.statement.label.is_some() || !begins_line || !self.view.text().ends_with(['\n', '\r'])
        {
            return None;
        }
        let range = match self.parsed.comments.as_slice() {
            [] => Range::<usize>::from(self.view.range()),
            _ if self.written(whole).contains(['\n', '\r']) => return None,
            _ => self.bytes(whole),
        };
        Some(Fix { title: title.to_owned(), edits: vec![(range, String::new())], preferred: false })
    }

    /// The statement with another one before it, both with the same indentation.
    fn line_before(&self, statement: &str, title: String) -> Option<Fix> {
        self.lines_before(&[statement.to_owned()], title)
    }

    /// The statement with others before it, all with the same indentation.
    fn lines_before(&self, statements: &[String], title: String) -> Option<Fix> {
        if !self.begins_line() {
            return None;
        }
        let text = self.view.text();
        let blanks = text.get(..text.len() - text.trim_start_matches([' ', '\t']).len())?;
        let start = usize::from(self.view.start);
        let line = |statement: &String| format!("{blanks}{statement}{}", self.line_end());
        let insert = statements.iter().map(line).collect();
        Some(Fix { title, edits: vec![(start..start, insert)], preferred: false })
    }

    fn begins_line(&self) -> bool {
        let before = self.view.index.checked_sub(1).map(|index| self.tree.statement(index));
        before.is_none_or(|before| before.text().ends_with(['\n', '\r']))
    }

    fn line_end(&self) -> &'static str {
        line_end(self.view.text())
    }
}

/// The line end that a statement uses.
pub(crate) fn line_end(text: &str) -> &'static str {
    if text.ends_with("\r\n") { "\r\n" } else { "\n" }
}
