//! The characters of a statement that count.

use rowan::TextRange;

use super::Token;
use crate::dialect::TextWords;
use crate::error::{SyntaxError, SyntaxErrorKind};
use crate::kind::SyntaxKind;
use crate::record::{Layout, Record, StatementForm, divide_record, sequence_prefix_length};
use crate::text_range;

/// A character that counts, and where it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Significant {
    /// Its offset from the start of the statement.
    pub(super) offset: u32,
    /// The character in upper case if it is ASCII, zero otherwise.
    pub(super) byte: u8,
    /// The character as written.
    pub(super) character: char,
}

impl Significant {
    /// The offset after it.
    pub(super) fn end(self) -> usize {
        self.offset as usize + self.character.len_utf8()
    }
}

/// A statement reduced to what counts.
#[derive(Debug, Default)]
pub(super) struct Reduced {
    pub(super) characters: Vec<Significant>,
    /// The tokens of blanks, comments, signs and line ends.
    pub(super) trivia: Vec<Token>,
    /// Of a text statement the word and the text.
    pub(super) text_statement: Option<(TextRange, TextRange)>,
    pub(super) errors: Vec<SyntaxError>,
}

/// Reduces a statement.
pub(super) fn reduce(text: &str, form: StatementForm, layout: &Layout) -> Reduced {
    let mut reduced = Reduced::default();
    if form == StatementForm::Ordinary {
        reduced.characters.reserve_exact(text.len());
    }
    let mut offset = 0;
    let mut text_end = 0;
    while let Some(rest) = text.get(offset..).filter(|rest| !rest.is_empty()) {
        let record = divide_record(rest, form, layout);
        match form {
            StatementForm::Ordinary => reduced.ordinary(rest, offset, &record, layout),
            StatementForm::Remark => reduced.trivia(SyntaxKind::Comment, offset, offset + record.field),
            // The records of a text are one text; only the columns after it and the last line end are not.
            StatementForm::Text { .. } => text_end = offset + record.field,
        }
        let goes_on = record.continues && offset + record.end < text.len();
        if !matches!(form, StatementForm::Text { .. }) || !goes_on {
            reduced.trivia(SyntaxKind::SequenceField, offset + record.field, offset + record.content);
            let end_kind = if record.separated { SyntaxKind::Semicolon } else { SyntaxKind::LineEnd };
            reduced.trivia(end_kind, offset + record.content, offset + record.end);
        }
        offset += record.end;
    }
    if let StatementForm::Text { word, text: text_start } = form {
        reduced.text(text, word, text_start, text_end, layout);
    }
    reduced
}

impl Reduced {
    fn trivia(&mut self, kind: SyntaxKind, start: usize, end: usize) {
        if end > start {
            self.trivia.push(Token { kind, range: text_range(start, end) });
        }
    }

    fn ordinary(&mut self, rest: &str, offset: usize, record: &Record, layout: &Layout) {
        self.runs_into_sequence_field(rest, offset, record);
        let significant = rest.get(..record.significant).unwrap_or("");
        // A sequence number of PostWorks before the statement.
        let prefix = if offset == 0 { sequence_prefix_length(significant, layout) } else { 0 };
        self.trivia(SyntaxKind::SequenceField, 0, prefix);
        let quotes = layout.dialect.quoted_text && significant.matches('\'').count() >= 2;
        let mut quoted = false;
        let mut blank_start = None;
        for (index, character) in significant.char_indices().skip_while(|(index, _)| *index < prefix) {
            if quotes && character == '\'' {
                quoted = !quoted;
            }
            if matches!(character, ' ' | '\t') && !quoted {
                blank_start.get_or_insert(index);
                continue;
            }
            if let Some(start) = blank_start.take() {
                self.trivia(SyntaxKind::Whitespace, offset + start, offset + index);
            }
            let byte = if character.is_ascii() { (character as u8).to_ascii_uppercase() } else { 0 };
            let offset = u32::try_from(offset + index).unwrap_or(u32::MAX);
            self.characters.push(Significant { offset, byte, character });
        }
        if let Some(start) = blank_start {
            self.trivia(SyntaxKind::Whitespace, offset + start, offset + record.significant);
        }
        let mut comment = record.significant;
        if let Some(sign) = record.continuation {
            self.trivia(SyntaxKind::Continuation, offset + sign, offset + sign + 1);
            comment = sign + 1;
        }
        self.trivia(SyntaxKind::Comment, offset + comment, offset + record.field);
    }

    /// Columns 72 and 73 both in use: the card cuts the statement, perhaps without the author's knowledge.
    fn runs_into_sequence_field(&mut self, rest: &str, offset: usize, record: &Record) {
        if record.field == record.content || record.significant < record.field {
            return;
        }
        let before = rest.get(..record.field).and_then(|head| head.chars().next_back());
        let after = rest.get(record.field..record.content).and_then(|tail| tail.chars().next());
        let in_use = |character: Option<char>| character.is_some_and(|character| !character.is_whitespace());
        if in_use(before) && in_use(after) {
            let range = text_range(offset + record.field, offset + record.content);
            self.errors.push(SyntaxError::new(SyntaxErrorKind::RunsIntoSequenceField, range));
        }
    }

    /// The word and the text. In columns 1-6 the text is everything after the word, verbatim, and so it is behind blanks,
    /// but for a slash; where text words may stand anywhere, blanks, a slash and quotes around it are none of it.
    fn text(&mut self, text: &str, word: usize, start: usize, end: usize, layout: &Layout) {
        let end = end.max(start);
        let word_range = text_range(word, start);
        let (mut from, mut to) = (start, end);
        if layout.dialect.text_words == TextWords::Indented && word > 0 {
            let inner = text.get(start..end).unwrap_or("");
            if let Some(after) = inner.trim_start_matches([' ', '\t']).strip_prefix('/') {
                from = end - after.len();
            }
        }
        if layout.dialect.text_words == TextWords::Anywhere {
            let inner = text.get(start..end).unwrap_or("");
            let trimmed = inner.trim_start_matches([' ', '\t']);
            let trimmed = trimmed.strip_prefix('/').unwrap_or(trimmed).trim_start_matches([' ', '\t']);
            from = end - trimmed.len();
            let trimmed = trimmed.trim_end_matches([' ', '\t']);
            to = from + trimmed.len();
            if let Some(bare) = trimmed.strip_prefix('\'').and_then(|rest| rest.strip_suffix('\'')) {
                from += 1;
                to = from + bare.len();
            }
        }
        let after = std::mem::take(&mut self.trivia);
        // The `N12 ,` of PostWorks is a sequence number.
        let prefix_is_blank = text.get(..word).is_none_or(|prefix| prefix.trim().is_empty());
        let prefix = if prefix_is_blank { SyntaxKind::Whitespace } else { SyntaxKind::SequenceField };
        self.trivia(prefix, 0, word);
        self.trivia(SyntaxKind::Whitespace, start, from);
        self.trivia(SyntaxKind::Whitespace, to, end);
        self.trivia.extend(after);
        self.text_statement = Some((word_range, text_range(from, to)));
    }
}
