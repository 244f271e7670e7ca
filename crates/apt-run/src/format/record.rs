//! The records of one statement with the pieces that stand on them.

use apt_syntax::{
    SyntaxKind,
    lexer::Lexed,
    record::{Layout, StatementForm, record_length, statement_form},
    tree,
};

use super::KeptReason;

/// Blanks, as far as the language knows them.
pub(super) const BLANKS: [char; 2] = [' ', '\t'];

/// An element, or a part of one that is written in several.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Piece<'a> {
    pub(super) kind: SyntaxKind,
    /// The index of its element in the statement.
    pub(super) element: usize,
    pub(super) text: &'a str,
    /// Whether a blank stands before it on its record.
    pub(super) after_blank: bool,
}

/// One record.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Record<'a> {
    pub(super) pieces: Vec<Piece<'a>>,
    /// Whether its first column is in use.
    pub(super) at_margin: bool,
    /// Whether a `$` continues it.
    pub(super) continued: bool,
    /// What stands after the `$`, or from the `$$` on, without trailing blanks.
    pub(super) comment: Option<&'a str>,
    /// The sequence field without trailing blanks.
    pub(super) sequence: Option<&'a str>,
    /// What ends it: the end of a line, or the `;` before the next statement on it.
    pub(super) line_end: &'a str,
}

/// How a statement divides.
pub(super) enum Division<'a> {
    /// A statement that can be laid out.
    Records(Vec<Record<'a>>),
    /// PARTNO and its kin, and remarks of CL files: they are what they are.
    Verbatim,
    /// A statement that cannot be laid out surely.
    Kept(KeptReason),
}

/// Divides a statement, which has been lexed.
pub(super) fn divide<'a>(text: &'a str, lexed: &Lexed, layout: &Layout) -> Division<'a> {
    let first_record = text.get(..record_length(text).0).unwrap_or(text);
    if statement_form(first_record, layout) != StatementForm::Ordinary {
        return Division::Verbatim;
    }
    let mut records = Vec::new();
    let mut record = Record { at_margin: is_at_margin(text), ..Record::default() };
    let mut after_blank = false;
    for token in tree::tokens_of(lexed) {
        let range = std::ops::Range::<usize>::from(token.range);
        let piece = text.get(range.clone()).unwrap_or("");
        match token.kind {
            SyntaxKind::Whitespace => after_blank = true,
            SyntaxKind::Continuation => record.continued = true,
            SyntaxKind::Comment => record.comment = not_blank(piece),
            SyntaxKind::SequenceField if range.start == 0 => {
                return Division::Kept(KeptReason::SequenceNumber);
            }
            SyntaxKind::SequenceField => record.sequence = not_blank(piece),
            SyntaxKind::Bad => return Division::Kept(KeptReason::IllegalCharacter),
            SyntaxKind::LineEnd | SyntaxKind::Semicolon => {
                record.line_end = piece;
                let rest = text.get(range.end..).unwrap_or("");
                records.push(std::mem::replace(
                    &mut record,
                    Record { at_margin: is_at_margin(rest), ..Record::default() },
                ));
                after_blank = false;
            }
            kind => {
                let element = token.element.unwrap_or(usize::MAX);
                record.pieces.push(Piece { kind, element, text: piece, after_blank });
                after_blank = false;
            }
        }
    }
    if record != (Record { at_margin: record.at_margin, ..Record::default() }) {
        records.push(record);
    }
    Division::Records(records)
}

fn is_at_margin(text: &str) -> bool {
    !text.starts_with(BLANKS)
}

fn not_blank(text: &str) -> Option<&str> {
    Some(text.trim_end_matches(BLANKS)).filter(|text| !text.is_empty())
}
