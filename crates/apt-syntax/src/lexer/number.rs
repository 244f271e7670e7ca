//! Numbers, decimal points and relations.

use super::Lexer;
use crate::error::SyntaxErrorKind;
use crate::statement::ElementKind;

/// The relations and logical operators that stand between points.
const RELATIONS: [&[u8]; 9] = [b"EQ", b"NE", b"LT", b"LE", b"GT", b"GE", b"AND", b"OR", b"NOT"];

impl Lexer<'_> {
    /// A number that begins with digits, which are read.
    pub(super) fn number(&mut self, start: usize) {
        if self.byte(0) == Some(b'.') && self.joined(0) && self.relation_length().is_none() {
            self.position += 1;
            self.digits();
            self.exponent();
            if self.second_point(start) {
                return;
            }
        }
        self.finish_number(start);
    }

    /// A number that begins with its point, or a relation.
    pub(super) fn point(&mut self, start: usize) {
        if let Some(length) = self.relation_length() {
            self.position += length;
            self.push(ElementKind::Relation, start);
            return;
        }
        let after_name = matches!(
            self.lexed.elements.last().map(|element| element.kind),
            Some(ElementKind::Name | ElementKind::Word)
        );
        self.position += 1;
        let before = self.position;
        self.digits();
        self.exponent();
        if after_name && self.joined_to_previous(start) || self.position == before {
            self.push(ElementKind::Bad, start);
            self.error(SyntaxErrorKind::MisplacedDecimalPoint, start);
            return;
        }
        if !self.second_point(start) {
            self.finish_number(start);
        }
    }

    fn joined_to_previous(&self, start: usize) -> bool {
        if !self.layout.dialect.blanks_separate {
            return true;
        }
        match (
            start.checked_sub(1).and_then(|before| self.characters.get(before)),
            self.characters.get(start),
        ) {
            (Some(before), Some(here)) => before.end() == here.offset as usize,
            _ => false,
        }
    }

    fn digits(&mut self) {
        while self.byte(0).is_some_and(|byte| byte.is_ascii_digit()) && self.joined(0) {
            self.position += 1;
        }
    }

    /// `E`, perhaps a sign, and digits; only after a decimal point (language reference 1.7).
    fn exponent(&mut self) {
        if self.byte(0) != Some(b'E') || !self.joined(0) {
            return;
        }
        let sign = usize::from(matches!(self.byte(1), Some(b'+' | b'-')) && self.joined(1));
        if self.byte(1 + sign).is_some_and(|byte| byte.is_ascii_digit()) && self.joined(1 + sign) {
            self.position += 1 + sign;
            self.digits();
        }
    }

    /// A second decimal point makes the whole run of digits and points bad.
    fn second_point(&mut self, start: usize) -> bool {
        if self.byte(0) != Some(b'.') || !self.joined(0) || self.relation_length().is_some() {
            return false;
        }
        while self.byte(0).is_some_and(|byte| byte.is_ascii_digit() || byte == b'.') && self.joined(0) {
            self.position += 1;
        }
        self.push(ElementKind::Bad, start);
        self.error(SyntaxErrorKind::MisplacedDecimalPoint, start);
        true
    }

    fn finish_number(&mut self, start: usize) {
        let text = self.spelling(start);
        if number_value(&text).is_none() {
            self.push(ElementKind::Bad, start);
            self.error(SyntaxErrorKind::NumberNotConvertible { text }, start);
            return;
        }
        let digits = significant_digits(&text);
        if let Some(limit) = self.layout.dialect.number_digits.filter(|limit| digits > u32::from(*limit)) {
            self.error(SyntaxErrorKind::NumberTooLong { digits, limit }, start);
        }
        self.push_text(ElementKind::Number, start, text);
    }

    /// The length of `.EQ.` and the like, if one begins here.
    fn relation_length(&self) -> Option<usize> {
        if self.byte(0) != Some(b'.') {
            return None;
        }
        RELATIONS.iter().find_map(|name| {
            let same = name.iter().enumerate().all(|(index, byte)| self.byte(1 + index) == Some(*byte));
            (same && self.byte(1 + name.len()) == Some(b'.')).then_some(name.len() + 2)
        })
    }
}

/// The value of a number as the language spells it; none if it is none or too large.
pub(crate) fn number_value(text: &str) -> Option<f64> {
    // `.E2`, a point without digits, is zero (language reference 1.7).
    if let Some(rest) = text.strip_prefix('.')
        && (rest.is_empty() || rest.starts_with('E'))
    {
        return (!rest.is_empty()).then_some(0.0);
    }
    text.parse::<f64>().ok().filter(|value| value.is_finite())
}

/// The significant digits of a number: those before the exponent, without leading zeros.
fn significant_digits(text: &str) -> u32 {
    let mantissa = text.split('E').next().unwrap_or("");
    let digits = mantissa.bytes().filter(u8::is_ascii_digit).skip_while(|byte| *byte == b'0').count();
    u32::try_from(digits).unwrap_or(u32::MAX)
}
