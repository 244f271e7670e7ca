//! Records (lines): how a line divides into statement field, comment and sequence field, and where statements end.
//!
//! The fast scan over a whole document and the lexer of one statement use the same division, so they agree on where a
//! statement ends.

use crate::dialect::{Dialect, SequenceFieldRule, TextWords};

/// The column (counted from one) where the sequence field of a card begins.
pub const SEQUENCE_FIELD_COLUMN: usize = 73;
/// The last column of a card.
pub const LAST_CARD_COLUMN: usize = 80;

/// How the lines of one document are read: its dialect and whether it carries sequence fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// The dialect.
    pub dialect: Dialect,
    /// Whether columns 73 and later are no part of the statement.
    pub sequence_field: bool,
}

/// What a statement is, as far as its records go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StatementForm {
    /// An ordinary statement.
    Ordinary,
    /// A text word with free text; `text` is the byte offset where the text begins in the first record, `word` that of
    /// the word.
    Text {
        /// Offset of the word.
        word: usize,
        /// Offset after the word.
        text: usize,
    },
    /// A `$$->` record of CL files, which a trailing `$` continues.
    Remark,
}

/// How one record divides; all offsets are bytes from the start of the record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Record {
    /// The end of the part that counts: a comment, a continuation sign, the sequence field or the line end follows.
    pub significant: usize,
    /// Where the `$` of a continuation stands.
    pub continuation: Option<usize>,
    /// The end of the statement field: the sequence field or the line end follows.
    pub field: usize,
    /// The end of the record without its line end.
    pub content: usize,
    /// The end of the record with its line end (and, for a separated statement, after the `;`).
    pub end: usize,
    /// Whether the record ends with a `;` that separates statements.
    pub separated: bool,
    /// Whether the next record belongs to the same statement.
    pub continues: bool,
}

/// The length of the record that begins at the start of `text`: without and with its line end.
pub fn record_length(text: &str) -> (usize, usize) {
    let bytes = text.as_bytes();
    let content = bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(bytes.len());
    // A lone carriage return also ends a line.
    let with_end = match (bytes.get(content), bytes.get(content + 1)) {
        (Some(b'\r'), Some(b'\n')) => content + 2,
        (Some(_), _) => content + 1,
        (None, _) => content,
    };
    (content, with_end)
}

/// The word whose line is text in CL files, where it is none of its switches.
pub(crate) const DISPLAY_WORD: &str = "DISPLY";

/// What kind of statement begins with this record.
pub fn statement_form(record: &str, layout: &Layout) -> StatementForm {
    let dialect = &layout.dialect;
    if dialect.text_words != TextWords::Anywhere {
        let in_column_one = record.get(..6).is_some_and(|head| is_text_word(head, dialect));
        return match in_column_one {
            true => StatementForm::Text { word: 0, text: 6 },
            false if dialect.text_words == TextWords::Indented => indented_form(record, dialect),
            false => StatementForm::Ordinary,
        };
    }
    if record.trim_start().starts_with("$$->") {
        return StatementForm::Remark;
    }
    let word = record.len() - after_sequence_prefix(record).len();
    let Some(rest) = record.get(word..) else { return StatementForm::Ordinary };
    let length = rest.bytes().take_while(|byte| byte.is_ascii_alphanumeric() || *byte == b'_').count();
    let is_text = rest.get(..length).is_some_and(|head| {
        is_text_word(head, dialect)
            || head.eq_ignore_ascii_case(DISPLAY_WORD) && is_displayed(&rest[length..])
    });
    if is_text { StatementForm::Text { word, text: word + length } } else { StatementForm::Ordinary }
}

/// Whether what stands behind the DISPLY of a CL file is a text: behind a slash, not a switch, and not the number of a lamp
/// or of a display.
fn is_displayed(behind: &str) -> bool {
    const SWITCHES: [&str; 5] = ["ON", "OFF", "AUTO", "LIGHT", "NIXIE"];
    let Some(text) = behind.trim_start().strip_prefix('/') else { return false };
    let first = text.split([',', '$']).next().unwrap_or_default().trim();
    let is_switch = SWITCHES.iter().any(|switch| first.eq_ignore_ascii_case(switch));
    !(first.is_empty() || is_switch || first.parse::<f64>().is_ok())
}

/// A text word behind blanks, if a blank, a slash or nothing follows it.
fn indented_form(record: &str, dialect: &Dialect) -> StatementForm {
    let rest = record.trim_start_matches([' ', '\t']);
    let word = record.len() - rest.len();
    let length = rest.bytes().take_while(u8::is_ascii_alphanumeric).count();
    let ends = matches!(rest.as_bytes().get(length), None | Some(b' ' | b'\t' | b'/' | b'\n' | b'\r'));
    let is_text = ends && rest.get(..length).is_some_and(|head| is_text_word(head, dialect));
    if is_text { StatementForm::Text { word, text: word + length } } else { StatementForm::Ordinary }
}

fn is_text_word(spelling: &str, dialect: &Dialect) -> bool {
    const LONGEST: usize = 8;
    if spelling.len() > LONGEST || !spelling.is_ascii() {
        return false;
    }
    let mut upper = [0_u8; LONGEST];
    for (to, from) in upper.iter_mut().zip(spelling.bytes()) {
        *to = from.to_ascii_uppercase();
    }
    // Nearly every line begins with something else; the first letter decides without a search.
    if !matches!(upper[0], b'P' | b'I' | b'T' | b'R' | b'L') {
        return false;
    }
    let upper = upper.get(..spelling.len()).and_then(|bytes| std::str::from_utf8(bytes).ok());
    upper
        .and_then(|upper| dialect.word(upper))
        .is_some_and(|word| word.class == crate::vocabulary::WordClass::Text)
}

/// The record after leading blanks and the `N12 ,` or `C12` prefix that PostWorks writes before its statements.
fn after_sequence_prefix(record: &str) -> &str {
    const BLANKS: [char; 2] = [' ', '\t'];
    let trimmed = record.trim_start_matches(BLANKS);
    let Some(rest) = trimmed.strip_prefix(['N', 'n', 'C', 'c']) else { return trimmed };
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    let rest = rest.get(digits..).unwrap_or("");
    let after = rest.trim_start_matches(BLANKS);
    if digits == 0 {
        return trimmed;
    }
    if trimmed.starts_with(['N', 'n']) {
        return after.strip_prefix(',').map_or(trimmed, |statement| statement.trim_start_matches(BLANKS));
    }
    let word_follows =
        after.len() < rest.len() && after.starts_with(|first: char| first.is_ascii_alphabetic());
    if word_follows { after } else { trimmed }
}

/// The bytes of a statement's first record that are a sequence number of PostWorks (with the blanks before it).
pub(crate) fn sequence_prefix_length(record: &str, layout: &Layout) -> usize {
    if layout.dialect.text_words != TextWords::Anywhere {
        return 0;
    }
    let rest = after_sequence_prefix(record);
    let prefix = record.len() - rest.len();
    let blank = record.get(..prefix).is_none_or(|prefix| prefix.trim().is_empty());
    if blank { 0 } else { prefix }
}

/// Divides the record at the start of `text`, which belongs to a statement of the given form.
pub fn divide_record(text: &str, form: StatementForm, layout: &Layout) -> Record {
    let (content, end) = record_length(text);
    let line = text.get(..content).unwrap_or(text);
    let field = if layout.sequence_field { sequence_field_start(line).unwrap_or(content) } else { content };
    let statement = line.get(..field).unwrap_or(line);
    let mut record = Record {
        significant: field,
        continuation: None,
        field,
        content,
        end,
        separated: false,
        continues: false,
    };
    match form {
        StatementForm::Text { .. } => {
            // PostWorks continues a text with `~`.
            record.continues =
                layout.dialect.text_words == TextWords::Anywhere && statement.trim_end().ends_with('~');
        }
        StatementForm::Remark => {
            record.significant = 0;
            let trimmed = statement.trim_end();
            record.continues = trimmed.ends_with('$') && !trimmed.ends_with("$$");
        }
        StatementForm::Ordinary => divide_ordinary(statement, &layout.dialect, &mut record),
    }
    record
}

fn divide_ordinary(statement: &str, dialect: &Dialect, record: &mut Record) {
    let Some(sign) = first_sign(statement, dialect) else { return };
    record.significant = sign;
    let bytes = statement.as_bytes();
    if bytes.get(sign) == Some(&b';') {
        record.field = sign;
        record.content = sign;
        record.end = sign + 1;
        record.separated = true;
        return;
    }
    let rest = statement.get(sign + 1..).unwrap_or("");
    if !rest.trim_start_matches([' ', '\t']).starts_with('$') {
        record.continuation = Some(sign);
        record.continues = true;
    }
}

/// The first `$`, or `;` where it separates statements, outside of quoted text.
fn first_sign(statement: &str, dialect: &Dialect) -> Option<usize> {
    if !dialect.quoted_text && !dialect.semicolon_separates {
        return statement.find('$');
    }
    let mut quoted = false;
    for (offset, byte) in statement.bytes().enumerate() {
        match byte {
            b'\'' if dialect.quoted_text => quoted = !quoted,
            b'$' if !quoted => return Some(offset),
            b';' if !quoted && dialect.semicolon_separates => return Some(offset),
            _ => {}
        }
    }
    // A quote that is never closed quotes nothing.
    if quoted { statement.find('$') } else { None }
}

/// The byte offset of column 73, if the line has one.
fn sequence_field_start(line: &str) -> Option<usize> {
    if line.len() < SEQUENCE_FIELD_COLUMN {
        return None;
    }
    line.char_indices().nth(SEQUENCE_FIELD_COLUMN - 1).map(|(offset, _)| offset)
}

/// Where the statements of a text begin, as far as it goes, and what its last statement still waits for.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Boundaries {
    /// The byte offset of every statement; ascending, the first is zero if the text is not empty.
    pub starts: Vec<u32>,
    /// Whether text put after the end could belong to the last statement.
    pub open: bool,
}

/// Lines or statements that are looked at between two questions whether to go on, each in a fraction of a microsecond.
pub(crate) const LINES_BETWEEN_QUESTIONS: usize = 1024;

/// Finds the statements of a text. The text begins at a statement.
pub fn statement_boundaries(text: &str, layout: &Layout) -> Boundaries {
    boundaries_until(text, layout, &|| false)
}

/// The same up to the end, or to where `is_given_up`, which is asked once in so many statements, says so.
pub(crate) fn boundaries_until(text: &str, layout: &Layout, is_given_up: &dyn Fn() -> bool) -> Boundaries {
    let mut boundaries = Boundaries::default();
    let mut offset = 0;
    while let Some(rest) = text.get(offset..).filter(|rest| !rest.is_empty()) {
        boundaries.starts.push(u32::try_from(offset).unwrap_or(u32::MAX));
        let (length, open) = statement_length(rest, layout);
        offset += length;
        boundaries.open = open;
        if boundaries.starts.len().is_multiple_of(LINES_BETWEEN_QUESTIONS) && is_given_up() {
            break;
        }
    }
    boundaries
}

/// The length of the statement at the start of a text that is not empty, and whether more text could belong to it.
pub fn statement_length(text: &str, layout: &Layout) -> (usize, bool) {
    let form = statement_form(text, layout);
    let mut offset = 0;
    loop {
        let rest = text.get(offset..).unwrap_or("");
        let record = divide_record(rest, form, layout);
        offset += record.end;
        let ended = record.separated || record.end > record.content;
        // After a lone carriage return at the very end a line feed would still belong to the line end.
        let open = !ended || record.continues || (offset == text.len() && text.ends_with('\r'));
        if !record.continues || offset >= text.len() {
            return (offset, open && offset >= text.len());
        }
    }
}

/// What speaks for and against sequence fields in a text: counts of lines.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SequenceEvidence {
    /// Lines with something in them.
    pub lines: u32,
    /// Lines whose columns 73-80 look like a sequence field.
    pub fields: u32,
    /// Lines whose sequence field cannot be part of a statement: it begins in column 73, and what stands before it is
    /// complete.
    pub apart: u32,
    /// Lines with other text in or after these columns.
    pub others: u32,
}

/// How many lines with a sequence field outweigh one line with other text there: a line that is being typed too long
/// must not change the meaning of the whole deck.
const FIELDS_PER_EXCEPTION: u32 = 20;

impl SequenceEvidence {
    /// Counts the lines of a text.
    pub fn of(text: &str) -> SequenceEvidence {
        Self::until(text, &|| false)
    }

    /// The same up to the end, or to where `is_given_up`, which is asked once in so many lines, says so.
    pub(crate) fn until(text: &str, is_given_up: &dyn Fn() -> bool) -> SequenceEvidence {
        let mut evidence = SequenceEvidence::default();
        for (number, line) in (1_usize..).zip(text.lines()) {
            evidence.add_line(line);
            if number.is_multiple_of(LINES_BETWEEN_QUESTIONS) && is_given_up() {
                break;
            }
        }
        evidence
    }

    /// The sum of two counts.
    pub fn plus(self, other: SequenceEvidence) -> SequenceEvidence {
        SequenceEvidence {
            lines: self.lines.saturating_add(other.lines),
            fields: self.fields.saturating_add(other.fields),
            apart: self.apart.saturating_add(other.apart),
            others: self.others.saturating_add(other.others),
        }
    }

    /// What is left of a count when that of some of its lines is taken out.
    #[must_use]
    pub fn minus(self, other: SequenceEvidence) -> SequenceEvidence {
        SequenceEvidence {
            lines: self.lines.saturating_sub(other.lines),
            fields: self.fields.saturating_sub(other.fields),
            apart: self.apart.saturating_sub(other.apart),
            others: self.others.saturating_sub(other.others),
        }
    }

    /// Whether the document carries sequence fields (language reference 1.11): at least half of its lines do, and
    /// next to none has other text there; or only few do, in a deck to which lines were added by hand, and then each of
    /// them must be one beyond doubt and none may have other text there.
    pub fn decides(self, rule: SequenceFieldRule) -> bool {
        match rule {
            SequenceFieldRule::Always => true,
            SequenceFieldRule::Never => false,
            SequenceFieldRule::WhenPresent => {
                let many = self.fields.saturating_mul(2) >= self.lines
                    && self.others.saturating_mul(FIELDS_PER_EXCEPTION) <= self.fields;
                let beyond_doubt = self.apart == self.fields && self.others == 0;
                self.fields > 0 && (many || beyond_doubt)
            }
        }
    }

    fn add_line(&mut self, line: &str) {
        if line.len() < SEQUENCE_FIELD_COLUMN {
            self.lines += u32::from(!line.trim().is_empty());
            return;
        }
        let line = line.trim_end();
        self.lines += u32::from(!line.is_empty());
        let Some(start) = sequence_field_start(line) else { return };
        let field = line.get(start..).unwrap_or("").trim();
        let separated = line.get(..start).is_some_and(|head| head.ends_with([' ', '\t']))
            || line.get(start..).is_some_and(|tail| tail.starts_with([' ', '\t']));
        let short = line.chars().count() <= LAST_CARD_COLUMN;
        if short && separated && looks_like_sequence_field(field) {
            self.fields += 1;
            self.apart += u32::from(stands_apart(line, start));
        } else if !line.get(..start).is_some_and(|statement| statement.contains("$$")) {
            // A comment loses nothing by its end, and tells nothing.
            self.others += 1;
        }
    }
}

/// Whether what follows `start` cannot go on with the statement before it: it begins in that column, and the statement
/// stops short of it with something after which only punctuation could follow. A list that goes on to column 80 would
/// have its comma before the last number.
fn stands_apart(line: &str, start: usize) -> bool {
    let begins_there = line.get(start..).is_some_and(|field| !field.starts_with([' ', '\t']));
    let statement = line.get(..start).unwrap_or("").trim_end();
    let complete =
        statement.ends_with(|last: char| last.is_ascii_alphanumeric() || matches!(last, ')' | '.'));
    begins_there && complete && !statement.contains('$')
}

/// Digits, or letters and then digits.
fn looks_like_sequence_field(field: &str) -> bool {
    let digits = field.trim_start_matches(|character: char| character.is_ascii_alphabetic());
    !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dialect::DialectName;

    fn layout(name: DialectName) -> Layout {
        let dialect = Dialect::named(name);
        Layout { dialect, sequence_field: dialect.sequence_field == SequenceFieldRule::Always }
    }

    fn split(text: &str, name: DialectName) -> Vec<&str> {
        let starts = statement_boundaries(text, &layout(name)).starts;
        let ends = starts.iter().skip(1).map(|start| *start as usize).chain([text.len()]);
        starts.iter().zip(ends).map(|(start, end)| &text[*start as usize..end]).collect()
    }

    #[test]
    fn continuations_and_comments_decide_where_statements_end() {
        assert_eq!(
            split("A=1\n\n$$ x\nB=2$ y\n$ z\n3\nC=1 $$ $\nD", DialectName::Free),
            ["A=1\n", "\n", "$$ x\n", "B=2$ y\n$ z\n3\n", "C=1 $$ $\n", "D"]
        );
        assert_eq!(split("A=1$\n$$ ends it\nB", DialectName::Free), ["A=1$\n$$ ends it\n", "B"]);
        assert_eq!(split("A=1 $  $ comment\nB", DialectName::Free), ["A=1 $  $ comment\n", "B"]);
        assert_eq!(split("PPRINT COST $\nX=1\n", DialectName::Free), ["PPRINT COST $\n", "X=1\n"]);
        assert_eq!(split("a\rb\r\nc\n", DialectName::Free), ["a\r", "b\r\n", "c\n"]);
    }

    #[test]
    fn a_sign_in_the_sequence_field_does_not_count() {
        let long = format!("{:<72}$0001\nB=2\n", "A=1");
        assert_eq!(split(&long, DialectName::Apt3).len(), 2);
        assert_eq!(split(&long, DialectName::Free).len(), 1);
    }

    #[test]
    fn cl_files_continue_remarks_and_texts() {
        assert_eq!(
            split("$$-> CSYS / 1, $\n 2, $\n 3\nGOTO/1,2,3\n", DialectName::Cl),
            ["$$-> CSYS / 1, $\n 2, $\n 3\n", "GOTO/1,2,3\n"]
        );
        assert_eq!(
            split("N5  , PPRINT FIRST ~\nSECOND\nEND\n", DialectName::Cl),
            ["N5  , PPRINT FIRST ~\nSECOND\n", "END\n"]
        );
        assert_eq!(split("  PPRINT $ 5\nEND\n", DialectName::Cl), ["  PPRINT $ 5\n", "END\n"]);
    }

    #[test]
    fn semicolons_separate_where_the_dialect_says_so() {
        let free = layout(DialectName::Free);
        assert_eq!(statement_boundaries("A=1;B=2 $$ x;y\nC=3;\n", &free).starts, [0, 4, 15, 19]);
        assert_eq!(split("A=1$ a;b\n+2; C=1\n", DialectName::Free), ["A=1$ a;b\n+2;", " C=1\n"]);
        for dialect in [DialectName::Apt3, DialectName::Apt4, DialectName::Cl] {
            assert_eq!(split("A=1;B=2\n", dialect).len(), 1, "{dialect}");
        }
    }

    #[test]
    fn texts_reach_to_the_end_of_the_line() {
        for text in ["PPRINT A; B $$ C\n", "  PPRINT A;B\n", "\tpprint/A;B $\n", " PARTNO;X\n"] {
            let count = if text.starts_with(" PARTNO;") { 2 } else { 1 };
            assert_eq!(split(text, DialectName::Free).len(), count, "{text:?}");
        }
        assert_eq!(
            split("RAPID; PPRINT A;B\nX=1\n", DialectName::Free),
            ["RAPID;", " PPRINT A;B\n", "X=1\n"]
        );
    }

    #[test]
    fn sequence_fields_are_recognised() {
        let card = |text: &str, field: &str| format!("{text:<72}{field}\n");
        let deck = card("PARTNO X", "00010") + &card("A=1", "P 0020") + &card("FINI", " 0030");
        let deck_of = |text: &str| SequenceEvidence::of(text).decides(SequenceFieldRule::WhenPresent);
        assert!(!deck_of(&deck), "a field with a blank in it is none");
        assert!(deck_of(&deck.replace("P 0020", "P0020")));
        assert!(!deck_of("A=1\nB=2\n"));
        assert!(!deck_of(&card("A=1", "")));
        let long = format!("GOTO/{}\n", "1.000,".repeat(20));
        assert!(!deck_of(&long));
        let many: String = (0..40).map(|number| card("A=1", &format!("{number:05}"))).collect();
        assert!(deck_of(&(many + &long)), "one long line in a deck changes nothing");
    }

    #[test]
    fn one_card_among_lines_written_by_hand_makes_a_deck() {
        let deck_of = |text: &str| SequenceEvidence::of(text).decides(SequenceFieldRule::WhenPresent);
        let lines = "PARTNO X\nA=1\nB=2\nC=3\n";
        let with = |text: &str, field: &str| format!("{lines}{text:<72}{field}\n");
        assert!(deck_of(&with("FINI", "TEST1470")));
        assert!(deck_of(&with("L1=LINE/PARLEL,LY,XLARGE,(D/2)", "10000000")));
        for (text, field, why) in [
            ("GOTO/1,2,", "33", "the list goes on"),
            ("A=B+", "12", "an operand is missing"),
            ("GOTO/P $ goes on", "12", "the remark goes on"),
            ("PPRINT NOTES $$", "12", "so does this one"),
            ("FINI", " 1470", "it may be a number that was moved there"),
        ] {
            assert!(!deck_of(&with(text, field)), "{why}");
        }
        let and_line = |line: &str| with("FINI", "TEST1470") + line + "\n";
        assert!(!deck_of(&and_line(&format!("{:<74}X=1", "A=1"))), "one line has other text");
        assert!(deck_of(&and_line(&"$$**".repeat(30))), "a comment may be long");
    }
}
