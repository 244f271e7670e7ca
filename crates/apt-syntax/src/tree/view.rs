//! One statement of a document.

use std::any::Any;
use std::hash::Hasher as _;
use std::sync::Arc;

use rowan::{TextRange, TextSize};
use rustc_hash::FxHasher;

use super::block::Block;
use super::{Document, SyntaxTree, green, range_at};
use crate::grammar::ParsedStatement;
use crate::kind::{SyntaxKind, SyntaxNode};
use crate::lexer;
use crate::record::Layout;
use crate::vocabulary::Word;

/// A statement of a document. It holds the snapshot that it was taken from.
#[derive(Debug, Clone)]
pub struct StatementView {
    /// Its index.
    pub index: usize,
    /// Where it begins in the document.
    pub start: TextSize,
    pub(super) document: Arc<Document>,
    pub(super) block: usize,
    pub(super) local: usize,
}

/// A run of some hundred statements: what versions of a document share. An edit replaces those that it touches.
#[derive(Debug, Clone, Copy)]
pub struct BlockView<'a> {
    pub(super) tree: &'a SyntaxTree,
    pub(super) block: &'a Block,
    pub(super) first: usize,
}

impl<'a> BlockView<'a> {
    /// The index of its first statement.
    pub fn first_statement(&self) -> usize {
        self.first
    }

    /// Its text.
    pub fn text(&self) -> &'a str {
        self.block.text()
    }

    /// How many statements it has.
    pub fn statement_count(&self) -> usize {
        self.block.statement_count() as usize
    }

    /// Its statements.
    pub fn statements(&self) -> impl Iterator<Item = StatementView> + use<'a> {
        let (tree, first) = (self.tree, self.first);
        let end = first + self.statement_count();
        (first..end).map(move |index| tree.statement(index))
    }

    /// What `make` finds out about the statements, kept with the block for all versions that share it. It must depend on
    /// nothing but the statements, and count them from the first one of the block. There is room for one kind of data:
    /// another kind is made anew at each call.
    pub fn derived<T: Any + Send + Sync>(&self, make: impl FnOnce() -> T) -> Arc<T> {
        self.block.derived(make)
    }
}

/// A token of a statement, for those who colour text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TokenView {
    /// What it is.
    pub kind: SyntaxKind,
    /// Where, relative to the start of the statement.
    pub range: TextRange,
    /// The element of the statement to which it belongs; none for blanks and comments.
    pub element: Option<usize>,
    /// The vocabulary entry, if that element is a word.
    pub word: Option<&'static Word>,
}

impl StatementView {
    /// The internal statement number: counted from one.
    pub fn isn(&self) -> u32 {
        u32::try_from(self.index).unwrap_or(u32::MAX).saturating_add(1)
    }

    /// Where it stands in the document, with its line end.
    pub fn range(&self) -> TextRange {
        range_at(self.start, self.text())
    }

    /// Its text, with its line end.
    pub fn text(&self) -> &str {
        self.document.blocks.get(self.block).map_or("", |block| block.statement_text(self.local))
    }

    /// What it says.
    pub fn parsed(&self) -> Arc<ParsedStatement> {
        let layout = &self.document.layout;
        match self.document.blocks.get(self.block) {
            Some(block) => block.parsed(self.local, layout, self.document.keeps_parsed()),
            None => Arc::new(crate::grammar::parse_statement("", layout)),
        }
    }

    /// Its lossless tree; ranges are relative to the start of the statement.
    pub fn syntax(&self) -> SyntaxNode {
        SyntaxNode::new_root(green::statement(self.text(), &self.document.layout))
    }

    /// Its tokens, without gaps.
    pub fn tokens(&self) -> Vec<TokenView> {
        tokens(self.text(), &self.document.layout)
    }

    /// A hash of its text and of all that decides how it is read: equal statements have equal hashes in every run.
    pub fn content_hash(&self) -> u64 {
        let mut hasher = FxHasher::default();
        hasher.write(self.text().as_bytes());
        hasher.write_u8(self.document.layout.dialect.name as u8);
        hasher.write_u8(u8::from(self.document.layout.sequence_field));
        hasher.finish()
    }
}

/// The tokens of one statement's text.
pub fn tokens(text: &str, layout: &Layout) -> Vec<TokenView> {
    tokens_of(&lexer::lex(text, layout))
}

/// The tokens of a statement that has been lexed.
pub fn tokens_of(lexed: &lexer::Lexed) -> Vec<TokenView> {
    let mut views: Vec<TokenView> = lexed
        .tokens
        .iter()
        .map(|token| TokenView { kind: token.kind, range: token.range, element: None, word: None })
        .collect();
    for (index, (element, (first, last))) in lexed.elements.iter().zip(&lexed.element_tokens).enumerate() {
        let word = (element.kind == crate::statement::ElementKind::Word)
            .then(|| crate::vocabulary::lookup(&element.text))
            .flatten();
        let pieces = views.get_mut(*first as usize..=*last as usize).unwrap_or_default();
        for piece in pieces.iter_mut().filter(|piece| !piece.kind.is_trivia()) {
            piece.element = Some(index);
            piece.word = word;
        }
    }
    views
}
