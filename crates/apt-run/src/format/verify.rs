//! The proof that a statement still says the same.

use apt_syntax::{
    SyntaxKind,
    lexer::{Lexed, lex},
    record::{Layout, statement_boundaries},
};

use super::record::BLANKS;

/// Whether two texts of a statement have the same elements, the same mistakes, the same comments and the same sequence
/// fields, and the new one is still one statement. The old one has been lexed.
pub(super) fn same_statement((old, before): (&str, &Lexed), new: &str, layout: &Layout) -> bool {
    if statement_boundaries(new, layout).starts.len() != 1 {
        return false;
    }
    let after = lex(new, layout);
    let elements = before.elements.len() == after.elements.len()
        && before.elements.iter().zip(&after.elements).all(|(a, b)| a.kind == b.kind && a.text == b.text);
    let mistakes =
        before.errors.iter().map(|error| &error.kind).eq(after.errors.iter().map(|error| &error.kind));
    elements
        && mistakes
        && texts(old, before, SyntaxKind::Comment).eq(texts(new, &after, SyntaxKind::Comment))
        && texts(old, before, SyntaxKind::SequenceField).eq(texts(new, &after, SyntaxKind::SequenceField))
}

/// The texts of the tokens of a kind, without trailing blanks and without those that are nothing else.
fn texts<'a>(text: &'a str, lexed: &'a Lexed, kind: SyntaxKind) -> impl Iterator<Item = &'a str> {
    lexed
        .tokens
        .iter()
        .filter(move |token| token.kind == kind)
        .filter_map(|token| text.get(std::ops::Range::<usize>::from(token.range)))
        .map(|piece| piece.trim_end_matches(BLANKS))
        .filter(|piece| !piece.is_empty())
}
