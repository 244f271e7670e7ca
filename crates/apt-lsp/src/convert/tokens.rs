//! Semantic tokens: the legend, the relative encoding, and the difference of two results.

use std::ops::Range;

use tower_lsp::ls_types::{self as lsp, SemanticTokenModifier, SemanticTokenType, SemanticTokensEdit};

use super::position::protocol_number;
use super::{Positions, TextIndex};
use crate::analysis::{Interrupted, Pace, Token, TokenClass};

/// Numbers of one encoded token.
const NUMBERS_PER_TOKEN: usize = 5;

/// Classes in the order of the legend, each with its name in the protocol. Standard names where there
/// are some, so that every colour theme knows them.
const TYPES: [(TokenClass, SemanticTokenType); 13] = [
    (TokenClass::Keyword, SemanticTokenType::KEYWORD),
    (TokenClass::Modifier, SemanticTokenType::MODIFIER),
    (TokenClass::Type, SemanticTokenType::TYPE),
    (TokenClass::Function, SemanticTokenType::FUNCTION),
    (TokenClass::Postprocessor, SemanticTokenType::EVENT),
    (TokenClass::Macro, SemanticTokenType::MACRO),
    (TokenClass::Parameter, SemanticTokenType::PARAMETER),
    (TokenClass::Variable, SemanticTokenType::VARIABLE),
    (TokenClass::Label, SemanticTokenType::new("label")),
    (TokenClass::Number, SemanticTokenType::NUMBER),
    (TokenClass::String, SemanticTokenType::STRING),
    (TokenClass::Operator, SemanticTokenType::OPERATOR),
    (TokenClass::Comment, SemanticTokenType::COMMENT),
];

/// What the numbers of encoded tokens mean.
pub(crate) fn legend() -> lsp::SemanticTokensLegend {
    lsp::SemanticTokensLegend {
        token_types: TYPES.iter().map(|(_, name)| name.clone()).collect(),
        token_modifiers: vec![SemanticTokenModifier::DEFINITION],
    }
}

/// Encodes tokens, each relative to the one before it; a token over several lines becomes one per line.
///
/// # Errors
///
/// [`Interrupted`] when nobody wants them any more.
pub(crate) fn encode(
    index: &TextIndex,
    tokens: &[Token],
    pace: &Pace<'_>,
) -> Result<Vec<lsp::SemanticToken>, Interrupted> {
    let mut encoded = Vec::with_capacity(tokens.len());
    let mut last = lsp::Position::default();
    let mut told_until = lsp::Position::default();
    let mut positions = Positions::of(index);
    for token in tokens {
        pace.go_on(1)?;
        let token_type = type_number(token.class);
        let mut tell = |range: lsp::Range| {
            if range.start < told_until || range.start.line != range.end.line || range.start == range.end {
                return; // Tokens that overlap or are empty cannot be said in the protocol.
            }
            let delta_line = range.start.line - last.line;
            let from = if delta_line == 0 { last.character } else { 0 };
            encoded.push(lsp::SemanticToken {
                delta_line,
                delta_start: range.start.character - from,
                length: range.end.character - range.start.character,
                token_type,
                token_modifiers_bitset: u32::from(token.definition),
            });
            last = range.start;
            told_until = range.end;
        };
        let range = positions.range(&token.range);
        if range.start.line == range.end.line {
            tell(range);
        } else {
            lines_of(index, &token.range).iter().for_each(|piece| tell(positions.range(piece)));
        }
    }
    Ok(encoded)
}

fn type_number(class: TokenClass) -> u32 {
    protocol_number(TYPES.iter().position(|(known, _)| *known == class).unwrap_or_default())
}

/// The pieces of a range on each of its lines, without the line breaks.
fn lines_of(index: &TextIndex, range: &Range<usize>) -> Vec<Range<usize>> {
    let rope = &index.rope;
    let end = range.end.min(rope.len_bytes());
    let start = range.start.min(end);
    let (first, last) = (rope.byte_to_line(start), rope.byte_to_line(end));
    if first == last {
        return std::iter::once(start..end).collect();
    }
    let piece = |line: usize| {
        let content_end = index.offset(lsp::Position { line: protocol_number(line), character: u32::MAX });
        start.max(rope.line_to_byte(line))..end.min(content_end)
    };
    (first..=last).map(piece).filter(|piece| piece.start < piece.end).collect()
}

/// The one edit that turns the old tokens into the new ones: what lies between the longest common
/// beginning and the longest common end.
pub(crate) fn difference(old: &[lsp::SemanticToken], new: &[lsp::SemanticToken]) -> Vec<SemanticTokensEdit> {
    let before = old.iter().zip(new).take_while(|(old, new)| old == new).count();
    let (old_rest, new_rest) = (&old[before..], &new[before..]);
    let after = old_rest.iter().rev().zip(new_rest.iter().rev()).take_while(|(old, new)| old == new).count();
    let removed = old_rest.len() - after;
    let inserted = &new_rest[..new_rest.len() - after];
    if removed == 0 && inserted.is_empty() {
        return Vec::new();
    }
    vec![SemanticTokensEdit {
        start: protocol_number(before * NUMBERS_PER_TOKEN),
        delete_count: protocol_number(removed * NUMBERS_PER_TOKEN),
        data: (!inserted.is_empty()).then(|| inserted.to_vec()),
    }]
}

#[cfg(test)]
mod tests {
    use ropey::Rope;

    use super::super::Encoding;
    use super::*;
    use crate::analysis::Control;

    fn token(range: Range<usize>, class: TokenClass) -> Token {
        Token { range, class, definition: false }
    }

    fn numbers(tokens: &[lsp::SemanticToken]) -> Vec<[u32; 4]> {
        tokens.iter().map(|t| [t.delta_line, t.delta_start, t.length, t.token_type]).collect()
    }

    #[test]
    fn tokens_are_relative_and_split_at_lines() {
        let text = "P1 😀 $\r\n X/1\nREMARK a\r\nb";
        let index = TextIndex { rope: Rope::from_str(text), encoding: Encoding::Utf16 };
        let remark = text.find("REMARK").unwrap();
        let tokens = [
            token(0..2, TokenClass::Type),
            token(3..7, TokenClass::Operator),
            token(text.find('X').unwrap()..text.find('/').unwrap(), TokenClass::Keyword),
            token(remark..text.len(), TokenClass::Comment),
        ];
        assert_eq!(
            numbers(&encode(&index, &tokens, &Control::unlimited().pace()).unwrap()),
            [[0, 0, 2, 2], [0, 3, 2, 11], [1, 1, 1, 0], [1, 0, 8, 12], [1, 0, 1, 12]]
        );
    }

    #[test]
    fn tokens_that_overlap_are_left_out() {
        let index = TextIndex { rope: Rope::from_str("A=12 $ x\n"), encoding: Encoding::Utf16 };
        let tokens = [token(2..8, TokenClass::Number), token(6..8, TokenClass::Comment)];
        assert_eq!(numbers(&encode(&index, &tokens, &Control::unlimited().pace()).unwrap()), [[0, 2, 6, 9]]);
    }

    #[test]
    fn every_class_is_in_the_legend_once() {
        for (number, (class, _)) in TYPES.iter().enumerate() {
            assert_eq!(type_number(*class) as usize, number);
        }
    }

    #[test]
    fn a_difference_replaces_only_what_changed() {
        let make = |lengths: &[u32]| -> Vec<lsp::SemanticToken> {
            let token = |&length| lsp::SemanticToken {
                delta_line: 1,
                delta_start: 0,
                length,
                token_type: 0,
                token_modifiers_bitset: 0,
            };
            lengths.iter().map(token).collect()
        };
        for (old, new) in [
            (&[1, 2, 3][..], &[1, 9, 3][..]),
            (&[1, 2, 3], &[1, 2, 3]),
            (&[], &[1]),
            (&[1, 1, 1], &[1, 1]),
            (&[1, 2], &[]),
        ] {
            let mut patched = make(old);
            let new = make(new);
            for edit in difference(&patched.clone(), &new) {
                let start = edit.start as usize / NUMBERS_PER_TOKEN;
                let end = start + edit.delete_count as usize / NUMBERS_PER_TOKEN;
                patched.splice(start..end, edit.data.unwrap_or_default());
            }
            assert_eq!(patched, new);
        }
        assert_eq!(difference(&make(&[1, 2, 3]), &make(&[1, 9, 3]))[0].start, 5);
    }
}
