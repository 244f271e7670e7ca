//! One statement laid out in lines.

use apt_syntax::{SyntaxKind, record::Layout};

use super::{
    options::{FormatOptions, LAST_STATEMENT_COLUMN, LetterCase},
    record::{Piece, Record},
    wrap,
};

/// One line, ready but for the column of its comment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Line {
    /// Indentation, label and elements.
    pub(super) code: String,
    /// Whether `$` follows.
    pub(super) continued: bool,
    /// The comment: from `$$` on, or what stands after the `$`.
    pub(super) comment: Option<String>,
    /// The sequence field.
    pub(super) sequence: Option<String>,
    /// The line end, or `;`.
    pub(super) line_end: String,
}

impl Line {
    /// Columns that the code takes.
    pub(super) fn width(&self) -> usize {
        columns(&self.code)
    }

    /// Whether a comment follows code.
    pub(super) fn has_trailing_comment(&self) -> bool {
        self.comment.is_some() && !self.code.trim().is_empty()
    }

    /// Where the sign or comment behind the code begins if nothing moves it: `$` at once, `$$` after a blank.
    pub(super) fn own_column(&self) -> usize {
        let blank = self.has_trailing_comment() && !self.continued;
        self.width() + usize::from(blank)
    }

    /// Columns that the line takes before its sequence field, with sign and comment from a column on.
    pub(super) fn length(&self, column: usize) -> usize {
        let tail = usize::from(self.continued) + self.comment.as_deref().map_or(0, columns);
        if tail == 0 { columns(self.code.trim_end()) } else { column.max(self.width()) + tail }
    }

    /// The last column that may be used: of a card with a sequence field one less, so that a blank divides the two.
    pub(super) fn limit(&self, layout: &Layout) -> usize {
        match (layout.sequence_field, &self.sequence) {
            (false, _) => usize::MAX,
            (true, None) => LAST_STATEMENT_COLUMN,
            (true, Some(_)) => LAST_STATEMENT_COLUMN - 1,
        }
    }

    /// The text of the line with sign and comment from a column on.
    pub(super) fn write(&self, column: usize, out: &mut String) {
        let start = out.len();
        out.push_str(&self.code);
        if self.continued || self.comment.is_some() {
            pad(out, column.saturating_sub(self.width()));
        }
        if self.continued {
            out.push('$');
        }
        out.push_str(self.comment.as_deref().unwrap_or(""));
        out.truncate(start + out.get(start..).unwrap_or("").trim_end_matches(super::record::BLANKS).len());
        if let Some(sequence) = &self.sequence {
            let written = columns(out.get(start..).unwrap_or(""));
            pad(out, LAST_STATEMENT_COLUMN.saturating_sub(written));
            out.push_str(sequence);
        }
        out.push_str(&self.line_end);
    }
}

/// How many columns a text takes.
pub(super) fn columns(text: &str) -> usize {
    text.chars().count()
}

fn pad(out: &mut String, blanks: usize) {
    out.extend(std::iter::repeat_n(' ', blanks));
}

/// An unbreakable part of a line: its text and what may be done after it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Atom {
    /// With the blank before it, if there is one.
    pub(super) text: String,
    /// What it is.
    pub(super) kind: SyntaxKind,
    /// Whether a line may end after it.
    pub(super) may_break: bool,
}

/// The lines of a statement at a depth. With `inside_line` another statement stands before it on its first line.
pub(super) fn lines(
    records: &[Record<'_>],
    depth: usize,
    inside_line: bool,
    options: &FormatOptions,
    layout: &Layout,
) -> Vec<Line> {
    let indent = depth.saturating_mul(options.indent).min(LAST_STATEMENT_COLUMN);
    let further = indent.saturating_add(options.continuation_indent).min(LAST_STATEMENT_COLUMN);
    let line_end = records.iter().map(|record| record.line_end).find(|end| !end.is_empty()).unwrap_or("\n");
    let mut lines = Vec::with_capacity(records.len());
    for (number, record) in records.iter().enumerate() {
        let first = number == 0;
        let atoms = atoms(record, first, if inside_line { 0 } else { indent }, options, layout);
        let start = match (first, has_label(record)) {
            // Behind the `;` of the statement before.
            (true, _) if inside_line => 1,
            (true, true) => 0,
            (true, false) => indent,
            (false, _) => further,
        };
        let mut codes = match (atoms.is_empty(), options.wrap.filter(|_| !layout.sequence_field)) {
            (true, _) => vec![if record.at_margin && !(first && inside_line) {
                String::new()
            } else {
                " ".repeat(start)
            }],
            (false, None) => vec![wrap::joined(start, &atoms)],
            (false, Some(limit)) => wrap::broken(start, further, &atoms, record.continued, limit),
        };
        let last = codes.pop().unwrap_or_default();
        lines.extend(codes.into_iter().map(|code| Line {
            code,
            continued: true,
            comment: None,
            sequence: None,
            line_end: line_end.to_owned(),
        }));
        lines.push(Line {
            code: last,
            continued: record.continued,
            comment: record.comment.map(str::to_owned),
            sequence: record.sequence.map(str::to_owned),
            line_end: record.line_end.to_owned(),
        });
    }
    lines
}

/// `label)`: the first two elements, each in one piece.
fn has_label(record: &Record<'_>) -> bool {
    matches!(
        record.pieces.as_slice(),
        [label, mark, ..] if mark.kind == SyntaxKind::RightParenthesis
            && matches!(label.kind, SyntaxKind::Name | SyntaxKind::Number | SyntaxKind::Word)
    )
}

/// The parts of a record with the blanks that the style wants between them.
fn atoms(
    record: &Record<'_>,
    first: bool,
    indent: usize,
    options: &FormatOptions,
    layout: &Layout,
) -> Vec<Atom> {
    let pieces = &record.pieces;
    let label = first && has_label(record);
    let spaced: Vec<bool> = (0..pieces.len()).map(|index| is_spaced_operator(pieces, index)).collect();
    let mut atoms: Vec<Atom> = Vec::with_capacity(pieces.len());
    for (index, piece) in pieces.iter().enumerate() {
        let previous = index.checked_sub(1).and_then(|before| pieces.get(before));
        let around = |at: usize| spaced.get(at).copied().unwrap_or(false);
        let blanks = match previous {
            None => 0,
            // The statement begins in its column, or one blank after a long label.
            Some(_) if label && index == 2 => {
                let written = pieces.iter().take(2).map(|piece| columns(piece.text)).sum::<usize>();
                indent.saturating_sub(written).max(1)
            }
            Some(previous) => {
                let operator = around(index) || around(index - 1);
                usize::from(operator || needs_blank(previous, piece, layout))
            }
        };
        let mut text = " ".repeat(blanks);
        text.push_str(&spelled(piece, options.letter_case));
        let next = pieces.get(index + 1);
        let may_break = next.is_none_or(|next| next.element != piece.element) && !(label && index < 2);
        atoms.push(Atom { text, kind: piece.kind, may_break });
    }
    atoms
}

/// Whether a blank must stay between two pieces. Blanks inside of a name or number stay, as they show that a comma may
/// be missing there.
fn needs_blank(previous: &Piece<'_>, next: &Piece<'_>, layout: &Layout) -> bool {
    use SyntaxKind as Kind;
    let is_word = |kind| matches!(kind, Kind::Name | Kind::Word | Kind::Number | Kind::Text);
    let is_tight = |kind| {
        matches!(
            kind,
            Kind::Comma | Kind::Slash | Kind::Equals | Kind::LeftParenthesis | Kind::RightParenthesis
        )
    };
    if !next.after_blank {
        return false;
    }
    if next.element == previous.element {
        return is_word(next.kind);
    }
    layout.dialect.blanks_separate && !is_tight(previous.kind) && !is_tight(next.kind)
}

/// `a + b`: an operator between two operands with a blank on both sides keeps them. At the start or end of a record only
/// the side that stands on it counts.
fn is_spaced_operator(pieces: &[Piece<'_>], index: usize) -> bool {
    use SyntaxKind as Kind;
    let Some(operator) = pieces.get(index) else { return false };
    let previous = index.checked_sub(1).and_then(|before| pieces.get(before));
    let next = pieces.get(index + 1);
    let is_operand = |piece: &Piece<'_>| {
        matches!(piece.kind, Kind::Name | Kind::Word | Kind::Number | Kind::RightParenthesis)
    };
    matches!(operator.kind, Kind::Plus | Kind::Minus | Kind::Star | Kind::Power)
        && (previous.is_some() || next.is_some())
        && previous.is_none_or(|previous| is_operand(previous) && operator.after_blank)
        && next.is_none_or(|next| next.after_blank && next.element != operator.element)
}

fn spelled(piece: &Piece<'_>, case: LetterCase) -> String {
    let upper = match piece.kind {
        SyntaxKind::Word | SyntaxKind::Relation => case != LetterCase::Keep,
        SyntaxKind::Name | SyntaxKind::Number => case == LetterCase::Upper,
        _ => false,
    };
    if upper { piece.text.to_ascii_uppercase() } else { piece.text.to_owned() }
}
