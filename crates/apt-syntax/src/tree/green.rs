//! Green trees of statements and documents.

use rowan::{GreenNode, GreenNodeBuilder, Language as _};

use super::SyntaxTree;
use crate::grammar::{NodeSpan, parse_with_nodes};
use crate::kind::{Apt, SyntaxKind, SyntaxNode};
use crate::lexer::Lexed;
use crate::record::Layout;

/// The green tree of one statement.
pub(super) fn statement(text: &str, layout: &Layout) -> GreenNode {
    let mut builder = GreenNodeBuilder::new();
    build_statement(&mut builder, text, layout);
    builder.finish()
}

/// The tree of a whole document, or of as much of it as was made until `is_over` said true.
pub(super) fn document(tree: &SyntaxTree, is_over: &dyn Fn() -> bool) -> SyntaxNode {
    let mut builder = GreenNodeBuilder::new();
    builder.start_node(Apt::kind_to_raw(SyntaxKind::Root));
    for view in tree.statements() {
        if is_over() {
            break;
        }
        build_statement(&mut builder, view.text(), &tree.layout());
    }
    builder.finish_node();
    SyntaxNode::new_root(builder.finish())
}

fn build_statement(builder: &mut GreenNodeBuilder<'_>, text: &str, layout: &Layout) {
    let (_, lexed, nodes) = parse_with_nodes(text, layout);
    let spans = token_spans(&lexed, &nodes);
    let mut spans = spans.into_iter().peekable();
    // The tokens after which the open nodes end, innermost last.
    let mut open: Vec<u32> = Vec::new();
    builder.start_node(Apt::kind_to_raw(SyntaxKind::Statement));
    for (index, token) in lexed.tokens.iter().enumerate() {
        while let Some(span) = spans.next_if(|span| span.first as usize <= index) {
            builder.start_node(Apt::kind_to_raw(span.kind));
            open.push(span.last);
        }
        let piece = text.get(std::ops::Range::<usize>::from(token.range)).unwrap_or("");
        builder.token(Apt::kind_to_raw(token.kind), piece);
        while open.pop_if(|last| *last as usize <= index).is_some() {
            builder.finish_node();
        }
    }
    for _ in open {
        builder.finish_node();
    }
    builder.finish_node();
}

/// A node over tokens.
struct TokenSpan {
    kind: SyntaxKind,
    first: u32,
    last: u32,
}

/// The nodes as spans of tokens, outer before inner.
fn token_spans(lexed: &Lexed, nodes: &[NodeSpan]) -> Vec<TokenSpan> {
    let token_of = |element: u32| lexed.element_tokens.get(element as usize).copied();
    // Elements in several pieces become nodes, inside all others.
    let split = lexed
        .element_tokens
        .iter()
        .filter(|(first, last)| first < last)
        .map(|(first, last)| TokenSpan { kind: SyntaxKind::Split, first: *first, last: *last });
    let noted = nodes.iter().filter_map(|node| {
        let (first, _) = token_of(node.first)?;
        let (_, last) = token_of(node.end.checked_sub(1)?)?;
        ((last as usize) < lexed.tokens.len()).then_some(TokenSpan { kind: node.kind, first, last })
    });
    let mut spans: Vec<TokenSpan> = split.chain(noted).collect();
    // Inner nodes are noted before outer ones, so of two equal spans the later one is the outer one.
    spans.reverse();
    spans.sort_by_key(|span| (span.first, std::cmp::Reverse(span.last)));
    spans
}
