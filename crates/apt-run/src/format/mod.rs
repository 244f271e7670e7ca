//! The formatter: gives statements one look and never another meaning.
//!
//! Every statement is laid out on the records that its author chose: letters, blanks, labels and the indentation of macro
//! bodies and loops follow the style, elements stay in their order. What comes out is read again before it is offered:
//! if its elements, comments or sequence fields are not those of before, the statement stays as it is and the reason is
//! told. Statements are neither made nor removed, as their numbers name places in listings; blank lines stay.
//!
//! `$$ apt-lsp: format off` and `$$ apt-lsp: format on` enclose what is left alone.

mod align;
mod edits;
mod line;
mod options;
mod record;
mod structure;
mod verify;
mod wrap;

#[cfg(test)]
mod tests;

use std::ops::Range;

use apt_geometry::patience::{Aside, Patience, put_away};
use apt_syntax::{Dialect, SyntaxTree, lexer::lex, record::Layout, tree::StatementView};

pub use options::{FormatOptions, FormatSettings, LAST_STATEMENT_COLUMN, LetterCase};

use line::Line;
use record::Division;

use crate::{Cancelled, go_on};

/// One replacement: bytes of the old text, and what takes their place.
pub type Edit = (Range<usize>, String);

/// Why a statement stays as it is although it is not between marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum KeptReason {
    /// It has a character that belongs to no element, or a malformed number.
    #[error("a character does not belong to the language")]
    IllegalCharacter,
    /// A sequence number stands before it (PostWorks).
    #[error("a sequence number stands before the statement")]
    SequenceNumber,
    /// It shares its line with another statement.
    #[error("another statement stands on the same line")]
    SharedLine,
    /// In its new form it would not fit before the sequence field.
    #[error("the statement would reach column {}", LAST_STATEMENT_COLUMN + 1)]
    TooLong,
    /// In its new form it would be read otherwise.
    #[error("the statement would be read otherwise")]
    ReadOtherwise,
    /// The new lines would change whether columns 73-80 of the file count as sequence fields.
    #[error("columns 73-80 of the file would be read otherwise")]
    SequenceFields,
}

/// A statement that stays as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kept {
    /// The index of the statement.
    pub statement: usize,
    /// Why.
    pub reason: KeptReason,
}

/// What formatting a program would do.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Plan {
    /// The edits in order of the text; they do not overlap.
    pub edits: Vec<Edit>,
    /// Statements that could not be given the style.
    pub kept: Vec<Kept>,
}

/// The edits that give a program the style, in order and without overlap; empty if it has it.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn format(
    tree: &SyntaxTree,
    options: &FormatOptions,
    patience: Patience<'_>,
) -> Result<Vec<Edit>, Cancelled> {
    Ok(plan(tree, options, patience)?.edits)
}

/// The edits of the statements that a range (bytes) touches.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn format_range(
    tree: &SyntaxTree,
    range: Range<usize>,
    options: &FormatOptions,
    patience: Patience<'_>,
) -> Result<Vec<Edit>, Cancelled> {
    if tree.statement_count() == 0 {
        return Ok(Vec::new());
    }
    let at = |offset: usize| {
        tree.statement_at(apt_syntax::TextSize::new(u32::try_from(offset).unwrap_or(u32::MAX)))
    };
    // A selection of whole lines ends at the start of the next one, which does not belong to it.
    let last = at(if range.end > range.start { range.end - 1 } else { range.end });
    Ok(plan_of(tree, at(range.start)..=last, options, patience)?.edits)
}

/// The edits that end the lines of one statement in column 72 at the latest and change nothing else that is seen: the
/// letters and the indentation stay. Empty if that is so already, or cannot be done.
pub fn wrap_statement(tree: &SyntaxTree, view: &StatementView) -> Vec<Edit> {
    let text = view.text();
    let before = view.index.checked_sub(1).map(|index| tree.statement(index));
    let shares = |text: &str| !text.ends_with(['\n', '\r']);
    let has_next = view.index + 1 < tree.statement_count();
    if before.is_some_and(|before| shares(before.text())) || (has_next && shares(text)) {
        return Vec::new();
    }
    let indent = text.chars().take_while(|character| record::BLANKS.contains(character)).count();
    let options = FormatOptions {
        letter_case: LetterCase::Keep,
        indent,
        wrap: Some(LAST_STATEMENT_COLUMN),
        align_comments: false,
        ..FormatOptions::default()
    };
    let layout = tree.layout();
    // One level deep, so that the indentation is the one that is there.
    let Ok(lines) = laid_out(text, 1, false, &options, &layout) else { return Vec::new() };
    if lines.is_empty() {
        return Vec::new();
    }
    let mut new = String::with_capacity(text.len());
    for line in &lines {
        line.write(line.own_column(), &mut new);
    }
    edits::between(text, &new, usize::from(view.start))
}

/// The text in the style. For every text of a dialect the result of a second call is that of the first.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn format_text(
    text: &str,
    dialect: Dialect,
    options: &FormatOptions,
    patience: Patience<'_>,
) -> Result<String, Cancelled> {
    let tree = SyntaxTree::parse_until(text, dialect, &|| patience.is_over()).ok_or(Cancelled)?;
    let (edits, statements) = (format(&tree, options, patience)?, tree.statement_count());
    let formatted = applied_until(text, &edits, patience);
    put_away((tree, edits), statements);
    formatted
}

/// A text with edits in order of the text applied to it.
pub fn applied(text: &str, edits: &[Edit]) -> String {
    with_edits(text, edits, Patience::default())
}

/// The same.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
fn applied_until(text: &str, edits: &[Edit], patience: Patience<'_>) -> Result<String, Cancelled> {
    let text = with_edits(text, edits, patience);
    if patience.was_over() { Err(Cancelled) } else { Ok(text) }
}

/// The text up to its end, or with the edits up to where who waits gives up.
fn with_edits(text: &str, edits: &[Edit], patience: Patience<'_>) -> String {
    let mut out = String::with_capacity(text.len());
    let mut end = 0;
    for (range, insert) in edits.iter().take_while(|_| !patience.ends_after(1)) {
        out.push_str(text.get(end..range.start).unwrap_or(""));
        out.push_str(insert);
        end = range.end;
    }
    out.push_str(text.get(end..).unwrap_or(""));
    out
}

/// What formatting the whole program would do, with what it has to leave.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn plan(tree: &SyntaxTree, options: &FormatOptions, patience: Patience<'_>) -> Result<Plan, Cancelled> {
    plan_of(tree, 0..=tree.statement_count(), options, patience)
}

/// What a statement that is laid out and read again counts in units of work.
const WORK_OF_LAYOUT: usize = 4;

/// A statement with its new lines, none for one that stays.
struct Laid {
    view: StatementView,
    lines: Vec<Line>,
    /// Whether it shares a line with another statement.
    shared: bool,
}

fn plan_of(
    tree: &SyntaxTree,
    wanted: std::ops::RangeInclusive<usize>,
    options: &FormatOptions,
    patience: Patience<'_>,
) -> Result<Plan, Cancelled> {
    let layout = tree.layout();
    let mut plan = Plan::default();
    let not_wrapped = FormatOptions { wrap: None, ..*options };
    let last = tree.statement_count().saturating_sub(1);
    let mut inside_next = false;
    let mut all = Aside::from(Vec::with_capacity(tree.statement_count()));
    for (view, place) in tree.statements().zip(structure::places(tree, patience)?) {
        go_on(patience, WORK_OF_LAYOUT)?;
        let text = view.text();
        let ends_inside = !text.ends_with(['\n', '\r']) && view.index < last;
        let inside = std::mem::replace(&mut inside_next, ends_inside);
        let shared = inside || ends_inside;
        let laid = match (place.off, shared) {
            (true, _) => Ok(Vec::new()),
            // How long the line is depends on all its statements.
            (false, true) if layout.sequence_field => Err(KeptReason::SharedLine),
            (false, true) => laid_out(text, place.depth, inside, &not_wrapped, &layout),
            (false, false) => laid_out(text, place.depth, false, options, &layout),
        };
        let lines = laid.unwrap_or_else(|reason| {
            if wanted.contains(&view.index) {
                plan.kept.push(Kept { statement: view.index, reason });
            }
            Vec::new()
        });
        all.push(Laid { view, lines, shared });
    }
    for (view, new) in written(&all, options, &layout, patience)? {
        go_on(patience, 1)?;
        if wanted.contains(&view.index) {
            plan.edits.extend(edits::between(view.text(), &new, usize::from(view.start)));
        }
    }
    drop(all);
    if !reads_the_same(tree, &plan.edits, patience)? {
        let statement = *wanted.start();
        return Ok(Plan {
            edits: Vec::new(),
            kept: vec![Kept { statement, reason: KeptReason::SequenceFields }],
        });
    }
    Ok(plan)
}

/// The lines of a statement; none if it is to stay as it is.
fn laid_out(
    text: &str,
    depth: usize,
    inside_line: bool,
    options: &FormatOptions,
    layout: &Layout,
) -> Result<Vec<Line>, KeptReason> {
    let lexed = lex(text, layout);
    let records = match record::divide(text, &lexed, layout) {
        Division::Records(records) => records,
        Division::Verbatim => return Ok(Vec::new()),
        Division::Kept(reason) => return Err(reason),
    };
    let lines = line::lines(&records, depth, inside_line, options, layout);
    if lines.iter().any(|line| line.length(line.own_column()) > line.limit(layout)) {
        return Err(KeptReason::TooLong);
    }
    let mut new = String::with_capacity(text.len());
    for line in &lines {
        line.write(line.own_column(), &mut new);
    }
    if new == text || verify::same_statement((text, &lexed), &new, layout) {
        Ok(lines)
    } else {
        Err(KeptReason::ReadOtherwise)
    }
}

/// The new texts of the statements that have new lines.
fn written<'a>(
    all: &'a [Laid],
    options: &FormatOptions,
    layout: &Layout,
    patience: Patience<'_>,
) -> Result<Vec<(&'a StatementView, String)>, Cancelled> {
    // A statement that stays divides its neighbours, as an empty line does; so does one that shares a line.
    let lines = all.iter().flat_map(|laid| {
        let none = laid.lines.is_empty().then_some(None);
        laid.lines.iter().map(|line| Some(line).filter(|_| !laid.shared)).chain(none)
    });
    let mut columns = align::columns(lines, options.align_comments, layout, patience)?.into_iter();
    // A list that grows is copied as a whole, which nobody can interrupt.
    let mut texts = Vec::with_capacity(all.len());
    for laid in all {
        go_on(patience, 1)?;
        if laid.lines.is_empty() {
            columns.next();
            continue;
        }
        let mut text = String::with_capacity(laid.view.text().len());
        for line in &laid.lines {
            let column = columns.next().filter(|_| !laid.shared);
            line.write(column.unwrap_or_else(|| line.own_column()), &mut text);
        }
        texts.push((&laid.view, text));
    }
    Ok(texts)
}

/// Whether the edited text has as many statements and the same columns as before.
fn reads_the_same(tree: &SyntaxTree, edits: &[Edit], patience: Patience<'_>) -> Result<bool, Cancelled> {
    if edits.is_empty() {
        return Ok(true);
    }
    let text = applied_until(&tree.text(), edits, patience)?;
    let new = SyntaxTree::parse_until(&text, tree.dialect(), &|| patience.is_over()).ok_or(Cancelled)?;
    let same =
        new.statement_count() == tree.statement_count() && new.sequence_field() == tree.sequence_field();
    put_away(new, tree.statement_count());
    Ok(same)
}
