//! The tokens and elements of one statement.
//!
//! Blanks mean nothing inside a statement (language reference 1.3), and a name may even be divided over two records.
//! So the text is first reduced to the characters that count, each with its place; elements are found among these, and
//! the tokens of the tree are the pieces in which an element is written, between the tokens of blanks and comments.

mod number;
mod significant;
mod soft;

use rowan::TextRange;
use smol_str::SmolStr;

use crate::dialect::LongNames;
use crate::error::{SyntaxError, SyntaxErrorKind};
use crate::kind::SyntaxKind;
use crate::record::{Layout, statement_form};
use crate::statement::{Element, ElementKind};
use crate::{text_range, text_size};
pub(crate) use number::number_value;
use significant::{Significant, reduce};

/// How many errors of single elements are told of one statement; what has more is no statement.
pub const MAXIMUM_ERRORS: usize = 32;

/// A token: every byte of a statement belongs to exactly one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub kind: SyntaxKind,
    /// Where, relative to the start of the statement.
    pub range: TextRange,
}

/// The tokens and elements of a statement.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Lexed {
    /// All tokens, in order and without gaps.
    pub tokens: Vec<Token>,
    /// What counts.
    pub elements: Vec<Element>,
    /// For every element the index of its first token and of its last one.
    pub element_tokens: Vec<(u32, u32)>,
    /// What is wrong with single elements.
    pub errors: Vec<SyntaxError>,
}

/// Lexes one statement.
pub fn lex(text: &str, layout: &Layout) -> Lexed {
    let end = crate::record::record_length(text).0;
    let first_record = text.get(..end).unwrap_or(text);
    let form = statement_form(first_record, layout);
    let reduced = reduce(text, form, layout);
    let mut lexer = Lexer { layout, characters: &reduced.characters, position: 0, lexed: Lexed::default() };
    lexer.lexed.errors = reduced.errors;
    lexer.elements();
    lexer.soft_words();
    if let Some((word, text_part)) = reduced.text_statement {
        lexer.text_statement(text, word, text_part);
    }
    let mut lexed = lexer.lexed;
    merge_tokens(text, &reduced.trivia, &mut lexed);
    lexed
}

struct Lexer<'a> {
    layout: &'a Layout,
    characters: &'a [Significant],
    position: usize,
    lexed: Lexed,
}

impl Lexer<'_> {
    fn elements(&mut self) {
        while let Some(first) = self.peek(0) {
            let start = self.position;
            match first.byte {
                b'A'..=b'Z' | b'0'..=b'9' => self.name_or_number(start),
                b'.' => self.point(start),
                b',' => self.mark(ElementKind::Comma, 1),
                b'/' => self.mark(ElementKind::Slash, 1),
                b'=' => self.mark(ElementKind::Equals, 1),
                b'(' => self.mark(ElementKind::LeftParenthesis, 1),
                b')' => self.mark(ElementKind::RightParenthesis, 1),
                b'+' => self.mark(ElementKind::Plus, 1),
                b'-' => self.mark(ElementKind::Minus, 1),
                b'*' if self.byte(1) == Some(b'*') => self.mark(ElementKind::Power, 2),
                b'*' => self.mark(ElementKind::Star, 1),
                b'\'' if self.layout.dialect.quoted_text => self.quoted(start),
                _ => self.illegal(first),
            }
        }
    }

    fn peek(&self, ahead: usize) -> Option<Significant> {
        self.characters.get(self.position + ahead).copied()
    }

    fn byte(&self, ahead: usize) -> Option<u8> {
        self.peek(ahead).map(|character| character.byte)
    }

    fn mark(&mut self, kind: ElementKind, length: usize) {
        let start = self.position;
        self.position += length;
        self.push(kind, start);
    }

    /// Adds the element from `start` to the present position.
    fn push(&mut self, kind: ElementKind, start: usize) {
        let text = self.spelling(start);
        self.push_text(kind, start, text);
    }

    fn push_text(&mut self, kind: ElementKind, start: usize, text: SmolStr) {
        let range = self.range(start);
        self.lexed.elements.push(Element { kind, text, range });
    }

    fn spelling(&self, start: usize) -> SmolStr {
        let characters = self.characters.get(start..self.position).unwrap_or_default();
        characters.iter().map(|character| char::from(character.byte)).collect()
    }

    fn range(&self, start: usize) -> TextRange {
        let first = self.characters.get(start);
        let last = self.position.checked_sub(1).and_then(|index| self.characters.get(index));
        match (first, last) {
            (Some(first), Some(last)) => text_range(first.offset as usize, last.end()),
            _ => TextRange::empty(text_size(0)),
        }
    }

    fn error(&mut self, kind: SyntaxErrorKind, start: usize) {
        if self.lexed.errors.len() >= MAXIMUM_ERRORS {
            return;
        }
        let range = self.range(start);
        self.lexed.errors.push(SyntaxError::new(kind, range));
    }

    /// Whether the character `ahead` follows its predecessor without a blank, as far as blanks count.
    fn joined(&self, ahead: usize) -> bool {
        if !self.layout.dialect.blanks_separate {
            return true;
        }
        let position = self.position + ahead;
        match (
            position.checked_sub(1).and_then(|before| self.characters.get(before)),
            self.characters.get(position),
        ) {
            (Some(before), Some(here)) => before.end() == here.offset as usize,
            _ => false,
        }
    }

    fn name_or_number(&mut self, start: usize) {
        let length = self.word_length();
        let digits = (0..length).all(|ahead| self.byte(ahead).is_some_and(|byte| byte.is_ascii_digit()));
        self.position += length;
        if digits {
            self.number(start);
            return;
        }
        let spelling = self.spelling(start);
        if self.layout.dialect.blanks_separate
            && let Some(joined) = self.two_word_spelling(&spelling)
        {
            self.position += joined.len() - spelling.len() - 1;
            self.push_text(ElementKind::Word, start, joined);
            return;
        }
        let dialect = &self.layout.dialect;
        if dialect.word(&spelling).is_some() {
            self.push_text(ElementKind::Word, start, spelling);
            return;
        }
        let name = match dialect.name_length.filter(|limit| spelling.len() > usize::from(*limit)) {
            Some(limit) => self.long_name(spelling, limit, start),
            None => spelling,
        };
        self.push_text(ElementKind::Name, start, name);
    }

    /// A name with more characters than the limit, as the dialect wants it.
    fn long_name(&mut self, spelling: SmolStr, limit: u16, start: usize) -> SmolStr {
        let rule = self.layout.dialect.long_names;
        let pieces = self.pieces(start);
        if rule == LongNames::Taken && pieces.is_empty() {
            return spelling;
        }
        // Names consist of ASCII letters and digits.
        let cut = spelling.get(..usize::from(limit)).map(SmolStr::new);
        self.error(SyntaxErrorKind::NameTooLong { name: spelling.clone(), limit, pieces }, start);
        if rule == LongNames::Taken { spelling } else { cut.unwrap_or(spelling) }
    }

    /// How many characters belong to the name or the digits that begin here.
    fn word_length(&self) -> usize {
        let long = self.layout.dialect.long_word_characters;
        let begins_with_letter = self.byte(0).is_some_and(|byte| byte.is_ascii_uppercase());
        let mut length = 1;
        while self.joined(length) {
            match self.byte(length) {
                Some(byte) if byte.is_ascii_alphanumeric() => length += 1,
                Some(b'_') if long => length += 1,
                Some(b'-')
                    if long
                        && begins_with_letter
                        && self.joined(length + 1)
                        && self.byte(length + 1).is_some_and(|byte| byte.is_ascii_uppercase()) =>
                {
                    length += 2;
                }
                _ => break,
            }
        }
        length
    }

    /// `TOOL PATH`: a word of the vocabulary that has a blank in it.
    fn two_word_spelling(&self, first: &str) -> Option<SmolStr> {
        let rest = self.characters.get(self.position..)?;
        let second: String = rest
            .iter()
            .take_while(|character| character.byte.is_ascii_uppercase())
            .take(crate::vocabulary::LONGEST_SPELLING)
            .map(|character| char::from(character.byte))
            .collect();
        let both = format!("{first} {second}");
        self.layout.dialect.word(&both).map(|word| SmolStr::new_static(word.spelling))
    }

    /// The pieces in which the element from `start` is written.
    fn pieces(&self, start: usize) -> Vec<SmolStr> {
        self.pieces_of(start, self.position)
    }

    /// The pieces in which the characters of a range of indices are written; none if they are one.
    fn pieces_of(&self, start: usize, end: usize) -> Vec<SmolStr> {
        let characters = self.characters.get(start..end).unwrap_or_default();
        let pieces: Vec<SmolStr> = characters
            .chunk_by(|before, here| before.end() == here.offset as usize)
            .map(|piece| piece.iter().map(|character| char::from(character.byte)).collect())
            .collect();
        if pieces.len() > 1 { pieces } else { Vec::new() }
    }

    fn illegal(&mut self, character: Significant) {
        let start = self.position;
        self.position += 1;
        // Characters outside ASCII are kept as a question mark, as the card code had no more.
        self.push_text(ElementKind::Bad, start, SmolStr::new_inline("?"));
        self.error(SyntaxErrorKind::IllegalCharacter(character.character), start);
    }

    fn quoted(&mut self, start: usize) {
        // `reduce` keeps the blanks inside of quotes; an unclosed quote is a bad character there.
        let rest = self.characters.get(start + 1..).unwrap_or_default();
        let Some(length) = rest.iter().position(|character| character.byte == b'\'') else {
            self.position = self.characters.len();
            self.push_text(ElementKind::Bad, start, SmolStr::new_inline("'"));
            self.error(SyntaxErrorKind::UnclosedText, start);
            return;
        };
        let text =
            rest.get(..length).unwrap_or_default().iter().map(|character| character.character).collect();
        self.position = start + length + 2;
        self.push_text(ElementKind::Text, start, text);
    }

    /// The word and the text of a text statement, of which `reduce` leaves no characters.
    fn text_statement(&mut self, text: &str, word: TextRange, text_part: TextRange) {
        let piece = |range: TextRange| text.get(std::ops::Range::<usize>::from(range)).unwrap_or("");
        let spelling: SmolStr = piece(word).to_ascii_uppercase().into();
        self.lexed.elements.push(Element { kind: ElementKind::Word, text: spelling, range: word });
        if !text_part.is_empty() {
            let text = piece(text_part).into();
            self.lexed.elements.push(Element { kind: ElementKind::Text, text, range: text_part });
        }
    }
}

/// Puts blanks and comments and the pieces of elements in order: what lies between two trivia tokens belongs to the
/// elements, whose boundaries divide it.
fn merge_tokens(text: &str, trivia: &[Token], lexed: &mut Lexed) {
    let length = text_size(text.len());
    let mut tokens = Vec::with_capacity(trivia.len() + lexed.elements.len());
    let mut element_tokens = Vec::with_capacity(lexed.elements.len());
    let mut trivia = trivia.iter().copied().peekable();
    let mut offset = text_size(0);
    for element in &lexed.elements {
        while let Some(token) = trivia.next_if(|token| token.range.start() < element.range.start()) {
            offset = token.range.end();
            tokens.push(token);
        }
        let kind = SyntaxKind::from(element.kind);
        let first = tokens.len();
        offset = offset.max(element.range.start());
        while offset < element.range.end() {
            let next = trivia
                .peek()
                .map_or(element.range.end(), |token| token.range.start().min(element.range.end()));
            if next > offset {
                tokens.push(Token { kind, range: TextRange::new(offset, next) });
                offset = next;
            }
            if let Some(token) = trivia.next_if(|token| token.range.start() < element.range.end()) {
                offset = token.range.end();
                tokens.push(token);
            }
        }
        let index = |position: usize| u32::try_from(position).unwrap_or(u32::MAX);
        element_tokens.push((index(first), index(tokens.len().saturating_sub(1).max(first))));
    }
    for token in trivia {
        offset = token.range.end();
        tokens.push(token);
    }
    debug_assert_eq!(offset, length, "{text:?} {tokens:?}");
    lexed.tokens = tokens;
    lexed.element_tokens = element_tokens;
}
