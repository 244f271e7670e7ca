//! Semantic tokens: the class of every element, for colouring.

use std::ops::Range;

use apt_geometry::patience::Waiting;
use apt_run::go_on;
use apt_syntax::{
    SyntaxKind, TextRange,
    statement::{Body, ElementKind},
    tree::{StatementView, TokenView},
    vocabulary::{WordClass, lookup},
};

use crate::{Analysis, Cancel, Cancelled, absolute};

/// The class of a token; the TextMate grammar and the Vim syntax use the same classes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum TokenClass {
    Keyword,
    Modifier,
    Type,
    Function,
    Postprocessor,
    Macro,
    Parameter,
    Variable,
    Label,
    Number,
    String,
    Operator,
    Comment,
}

/// One token.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Token {
    /// Bytes of the text; never over a line end.
    pub range: Range<usize>,
    /// The class.
    pub class: TokenClass,
    /// The name is given its value here.
    pub definition: bool,
}

/// Above this many statements the tokens of the whole text leave out the marks between names (`/ , = ( )` and operators),
/// half of all tokens: every grammar of an editor colours them. The tokens of a range have them.
pub const MOST_STATEMENTS_WITH_MARKS: usize = 5_000;

/// The most tokens of a whole text: a reply must stay small whatever the program. Editors ask for the tokens of the range
/// that they show, which are never cut.
pub const MOST_TOKENS: usize = 100_000;

impl Analysis {
    /// The tokens of the statements that a byte range touches, or of the whole text, in order; of a long text no marks
    /// and at most [`MOST_TOKENS`].
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn tokens(&self, range: Option<Range<usize>>, cancel: Cancel<'_>) -> Result<Vec<Token>, Cancelled> {
        let tree = self.document().tree();
        if tree.statement_count() == 0 {
            return Ok(Vec::new());
        }
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        self.with_marks(patience)?;
        let whole = 0..usize::from(tree.len());
        let is_whole = range.is_none();
        let with_marks = !is_whole || tree.statement_count() <= MOST_STATEMENTS_WITH_MARKS;
        let range = range.unwrap_or(whole);
        let index = |offset: usize| tree.statement_at((offset.min(usize::from(tree.len())) as u32).into());
        let (first, last) = (index(range.start), index(range.end));
        let mut tokens = Vec::new();
        for statement in first..=last {
            go_on(patience, 1)?;
            self.statement_tokens(&tree.statement(statement), with_marks, &mut tokens);
            if is_whole && tokens.len() >= MOST_TOKENS {
                tokens.truncate(MOST_TOKENS);
                break;
            }
        }
        Ok(tokens)
    }

    fn statement_tokens(&self, view: &StatementView, with_marks: bool, tokens: &mut Vec<Token>) {
        let start = usize::from(view.range().start());
        let text = view.text();
        let parsed = view.parsed();
        let from = tokens.len();
        let mut pieces = None;
        for (index, element) in parsed.elements.iter().enumerate() {
            let labelled = parsed.statement.label.as_ref().is_some_and(|label| label.range == element.range);
            let defined = parsed.statement.parts.iter().any(|part| match &part.body {
                Body::Assignment { target, .. } | Body::Definition { target, .. } => {
                    target.name.range == element.range
                }
                Body::Macro { name, .. } => name.range == element.range,
                _ => false,
            });
            let class = match element.kind {
                ElementKind::Word => {
                    lookup(&element.text).map_or(TokenClass::Variable, |word| class(word.class))
                }
                ElementKind::Name | ElementKind::Number if labelled => TokenClass::Label,
                ElementKind::Name => self.name_class(view.index, &element.text, &parsed, index),
                ElementKind::Number => TokenClass::Number,
                ElementKind::Text => TokenClass::String,
                ElementKind::Bad => continue,
                _ if with_marks => TokenClass::Operator,
                _ => continue,
            };
            let defined = labelled || defined;
            if is_over_lines(text, element.range) {
                for piece in pieces_by_line(pieces.get_or_insert_with(|| view.tokens()), element.range) {
                    push_lines(tokens, text, start, absolute(view, piece), class, defined);
                }
            } else {
                push_lines(tokens, text, start, absolute(view, element.range), class, defined);
            }
        }
        for comment in &parsed.comments {
            push_lines(tokens, text, start, absolute(view, *comment), TokenClass::Comment, false);
        }
        tokens[from..].sort_by_key(|token| token.range.start);
    }

    fn name_class(
        &self,
        statement: usize,
        name: &str,
        parsed: &apt_syntax::ParsedStatement,
        index: usize,
    ) -> TokenClass {
        let range = parsed.elements[index].range;
        for part in &parsed.statement.parts {
            match &part.body {
                Body::Macro { name, .. } | Body::Call { name, .. } if name.range == range => {
                    return TokenClass::Macro;
                }
                Body::Call { arguments, .. } if arguments.iter().any(|one| one.name.range == range) => {
                    return TokenClass::Parameter;
                }
                Body::Jump { label, .. } | Body::Do { label, .. } if label.range == range => {
                    return TokenClass::Label;
                }
                Body::ArithmeticIf { labels, .. } if labels.iter().any(|label| label.range == range) => {
                    return TokenClass::Label;
                }
                _ => {}
            }
        }
        let local = |region: &crate::regions::Region| {
            region.contains(statement) && region.variables.iter().any(|variable| variable == name)
        };
        if self.regions().iter().any(local) { TokenClass::Parameter } else { TokenClass::Variable }
    }
}

fn class(class: WordClass) -> TokenClass {
    match class {
        WordClass::Minor => TokenClass::Modifier,
        WordClass::GeometricType => TokenClass::Type,
        WordClass::Function => TokenClass::Function,
        WordClass::Postprocessor | WordClass::PostprocessorBare | WordClass::Text => {
            TokenClass::Postprocessor
        }
        _ => TokenClass::Keyword,
    }
}

/// Whether a piece of a statement goes on behind the end of a line.
fn is_over_lines(text: &str, range: TextRange) -> bool {
    text.get(Range::<usize>::from(range)).is_some_and(|piece| piece.contains(['\n', '\r']))
}

/// Where an element over several lines stands on each of them: without the sign and the remark of the continuation, the
/// sequence field of the card and the blanks before its first character.
fn pieces_by_line(tokens: &[TokenView], element: TextRange) -> Vec<TextRange> {
    let mut lines: Vec<TextRange> = Vec::new();
    let mut line_ended = true;
    let first = tokens.partition_point(|token| token.range.start() < element.start());
    for token in tokens[first..].iter().take_while(|token| token.range.start() < element.end()) {
        line_ended |= token.kind == SyntaxKind::LineEnd;
        if token.element.is_none() {
            continue;
        }
        match lines.last_mut() {
            Some(line) if !line_ended => *line = line.cover(token.range),
            _ => lines.push(token.range),
        }
        line_ended = false;
    }
    lines
}

/// Adds a token, cut at line ends: a text may be continued.
fn push_lines(
    tokens: &mut Vec<Token>,
    text: &str,
    start: usize,
    range: Range<usize>,
    class: TokenClass,
    definition: bool,
) {
    let Some(piece) = text.get(range.start - start..range.end - start) else { return };
    let mut at = range.start;
    for line in piece.split_inclusive('\n') {
        let visible = line.trim_end_matches(['\n', '\r']);
        if !visible.trim().is_empty() {
            tokens.push(Token { range: at..at + visible.len(), class, definition });
        }
        at += line.len();
    }
}
