//! Findings for people: excerpt, caret, related places, hint.

use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use ropey::Rope;

use super::{Checked, Counts};
use crate::analysis::{Diagnostic, Severity};
use crate::cli::Outcome;
use crate::cli::console::Console;
use crate::cli::program::Program;
use crate::convert::outgoing::frame_text;
use crate::convert::{Encoding, TextIndex};

/// Lines shown of a place that spans more.
const GREATEST_EXCERPT: usize = 5;

/// A longer line is not shown (bytes): a file without line breaks would flood the screen.
const LONGEST_LINE: usize = 2_000;

/// Prints the findings, and their number on standard error.
pub(in crate::cli) fn print(checked: &[Checked], console: &Console) -> Outcome {
    let outcome = console.print(&text(checked));
    let Counts { errors, warnings } = Counts::of(checked);
    console.tell(&format!(
        "{}, {} in {}",
        count(errors, "error"),
        count(warnings, "warning"),
        count(checked.len(), "program")
    ));
    outcome
}

fn count(number: usize, name: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {name}{plural}")
}

/// All findings as text with colours.
pub(in crate::cli) fn text(checked: &[Checked]) -> String {
    let mut text = String::new();
    for checked in checked {
        for found in &checked.diagnostics {
            text.push_str(&render(&checked.program, found));
            text.push_str("\n\n");
        }
    }
    text
}

/// One finding as text with colours.
fn render(program: &Program, found: &Diagnostic) -> String {
    let level = match found.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Information => Level::INFO,
        Severity::Hint => Level::HELP.with_name("hint"),
    };
    let title = level.primary_title(found.message.as_str()).id(found.code.as_str());
    let mut group = place(Group::with_title(title), program, &found.range, AnnotationKind::Primary, None);
    for related in &found.related {
        let message = Some(related.message.as_str());
        group = place(group, program, &related.range, AnnotationKind::Context, message);
    }
    for one in &found.elsewhere {
        let rope = Rope::from_str(&one.source.tree.text());
        let start = TextIndex { rope, encoding: Encoding::Utf32 }.range(&one.range).start;
        let (path, line, column) = (one.source.path.display(), start.line + 1, start.character + 1);
        group = group.element(Level::NOTE.message(format!("{}: {path}:{line}:{column}", one.message)));
    }
    for frame in &found.origin {
        group = group.element(Level::NOTE.message(frame_text(frame)));
    }
    if let Some(number) = found.apt3 {
        group = group.element(Level::NOTE.message(format!("APT III diagnostic {number}")));
    }
    if let Some(hint) = &found.hint {
        group = group.element(Level::HELP.message(hint.as_str()));
    }
    Renderer::styled().render(&[group])
}

/// Adds a place: the lines it is on, or only where it is if they are too long to be shown.
fn place<'a>(
    group: Group<'a>,
    program: &'a Program,
    bytes: &Range<usize>,
    kind: AnnotationKind,
    label: Option<&'a str>,
) -> Group<'a> {
    match excerpt(program, bytes) {
        Some(Excerpt { first_line, text, span }) => {
            let annotation = kind.span(span).label(label);
            let snippet =
                Snippet::source(text).path(program.name.as_str()).line_start(first_line).fold(false);
            group.element(snippet.annotation(annotation))
        }
        None => {
            let at = program.index.position(bytes.start);
            let origin = Origin::path(program.name.as_str())
                .line(at.line as usize + 1)
                .char_column(at.character as usize + 1);
            group.element(origin)
        }
    }
}

#[derive(Debug, PartialEq, Eq)]
struct Excerpt {
    /// From 1.
    first_line: usize,
    /// The lines, with one line feed between them.
    text: String,
    /// The place, in `text`.
    span: Range<usize>,
}

fn excerpt(program: &Program, bytes: &Range<usize>) -> Option<Excerpt> {
    let rope = &program.index.rope;
    let end = bytes.end.min(rope.len_bytes());
    let start = bytes.start.min(end);
    let first = rope.byte_to_line(start);
    let last = rope.byte_to_line(end).min(first + GREATEST_EXCERPT - 1);
    let mut text = String::new();
    let mut span = None;
    for line in first..=last {
        let line_start = rope.line_to_byte(line);
        let slice = rope.line(line);
        if slice.len_bytes() > LONGEST_LINE {
            return None;
        }
        let content = slice.to_string();
        let content = content.trim_end_matches(['\r', '\n']);
        let column = |offset: usize| offset.saturating_sub(line_start).min(content.len());
        let (from, to) = (text.len() + column(start), text.len() + column(end));
        span = Some(span.map_or(from..to, |span: Range<usize>| span.start..to));
        text.push_str(content);
        if line < last {
            text.push('\n');
        }
    }
    Some(Excerpt { first_line: first + 1, text, span: span? })
}
