//! Section 1, phase 1: text to a lossless tree, typed statements, the vocabulary and the dialects.
//!
//! Nothing here knows geometry. Parsing never fails: for every input the text of the tree is the input.
//!
//! The way of a text: [`record`] divides lines into statement field, comment and sequence field and finds where
//! statements end; [`lexer`] makes tokens (every byte) and elements (what counts) of one statement; [`grammar`] makes a
//! [`statement::Statement`] of the elements and at the same time the nodes of the tree; [`tree`] keeps the document and
//! takes edits. The plain [`statement::Statement`] is the typed syntax tree of this project: the rowan tree beside it
//! serves those who need every byte.

pub mod dialect;
pub mod error;
pub mod grammar;
pub mod kind;
pub mod lexer;
pub mod record;
pub mod statement;
pub mod tree;
pub mod vocabulary;

pub use dialect::{Dialect, DialectName};
pub use error::{SyntaxError, SyntaxErrorKind};
pub use grammar::{JoinedElement, ParsedStatement, parse_elements, parse_statement};
pub use kind::{SyntaxKind, SyntaxNode, SyntaxToken};
pub use rowan::{TextRange, TextSize};
pub use tree::{StatementChange, StatementView, SyntaxTree};

/// A length as a [`TextSize`]; texts beyond four gigabytes saturate.
pub(crate) fn text_size(length: usize) -> TextSize {
    TextSize::new(u32::try_from(length).unwrap_or(u32::MAX))
}

/// The range between two byte offsets, in either order.
pub(crate) fn text_range(start: usize, end: usize) -> TextRange {
    TextRange::new(text_size(start.min(end)), text_size(end.max(start)))
}
