//! The grammar: one function per production, over the elements of one statement.
//!
//! Every function returns the typed part that it read and notes the node that it found, so that there is one grammar
//! for the typed statement and for the tree. The functions see only elements: statements of a text, and statements
//! whose elements a macro call has replaced, are read by the same code.

mod argument;
mod expression;
mod logic;
mod part;

use rowan::TextRange;
use smol_str::SmolStr;

use crate::dialect::{Dialect, TextWords};
use crate::error::{SyntaxError, SyntaxErrorKind};
use crate::kind::SyntaxKind;
use crate::lexer::{self, Lexed};
use crate::record::Layout;
use crate::statement::{Body, Element, ElementKind, Name, Statement, WordUse};
use crate::vocabulary::Word;

/// The deepest nesting of parentheses, definitions and operators in a statement. APT III takes 600 elements, so no
/// program of its time comes near; the limit keeps hostile input from exhausting the stack.
pub const MAXIMUM_DEPTH: u16 = 200;

/// The most signs, `**` and logical operators of a statement, which nest, for the same reason.
pub const MAXIMUM_OPERATORS: u16 = 1000;

/// The most `**` in a chain (language reference 1.10).
pub const MAXIMUM_POWER_CHAIN: u16 = 39;

/// What a statement says, and all that was found out about it on the way. Ranges are relative to its start.
#[derive(Debug, Clone, PartialEq)]
pub struct ParsedStatement {
    /// The statement.
    pub statement: Statement,
    /// Its elements: what macro and synonym substitution work on.
    pub elements: Vec<Element>,
    /// What is wrong, in the order of the text.
    pub errors: Vec<SyntaxError>,
    /// The comments, with their signs.
    pub comments: Vec<TextRange>,
    /// Names, words and numbers that are written with blanks inside: a comma may be missing there.
    pub joined: Vec<JoinedElement>,
    /// The name that the statement would define if it had no errors, so that its later uses need not be reported.
    pub spoiled: Option<Name>,
}

impl ParsedStatement {
    /// Whether an error keeps the statement from being used.
    pub fn is_broken(&self) -> bool {
        self.errors.iter().any(|error| !error.kind.keeps_meaning())
    }
}

/// An element that blanks divide.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JoinedElement {
    /// The whole.
    pub range: TextRange,
    /// The pieces.
    pub pieces: Vec<SmolStr>,
}

/// A node of the tree: a kind over a run of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NodeSpan {
    pub(crate) kind: SyntaxKind,
    /// The first element.
    pub(crate) first: u32,
    /// After the last element.
    pub(crate) end: u32,
}

/// Parses the text of one statement.
pub fn parse_statement(text: &str, layout: &Layout) -> ParsedStatement {
    parse_with_nodes(text, layout).0
}

/// Parses a list of elements as a statement. The elements may come from several places; they keep their ranges.
///
/// An element of kind [`ElementKind::Name`] whose spelling is a word of the dialect is read as the name that it is
/// said to be, and the reverse; so a caller decides about synonyms and words that became names.
pub fn parse_elements(elements: &[Element], dialect: &Dialect) -> ParsedStatement {
    let mut parser = Parser::new(elements, dialect);
    let statement = parser.statement();
    let spoiled = parser.spoiled.take();
    ParsedStatement {
        statement,
        errors: parser.errors,
        elements: elements.to_vec(),
        comments: Vec::new(),
        joined: Vec::new(),
        spoiled,
    }
}

/// Parses the text of one statement, and gives what the tree is made of.
pub(crate) fn parse_with_nodes(text: &str, layout: &Layout) -> (ParsedStatement, Lexed, Vec<NodeSpan>) {
    let mut lexed = lexer::lex(text, layout);
    let elements = std::mem::take(&mut lexed.elements);
    let mut parser = Parser::new(&elements, &layout.dialect);
    parser.errors = std::mem::take(&mut lexed.errors);
    let misplaced = misplaced_text_word(text, &elements, layout);
    let statement = match misplaced {
        Some(error) => {
            parser.errors = vec![error];
            parser.unreadable()
        }
        None => parser.statement(),
    };
    let Parser { nodes, mut errors, spoiled, .. } = parser;
    errors.sort_by_key(|error| error.range.start());
    let comments = lexed
        .tokens
        .iter()
        .filter(|token| token.kind == SyntaxKind::Comment)
        .map(|token| token.range)
        .collect();
    let joined = joined_elements(text, &elements, &lexed);
    let parsed = ParsedStatement { statement, elements, errors, comments, joined, spoiled };
    (parsed, lexed, nodes)
}

/// `  PARTNO …`: a text word that does not begin in column 1 is none, and what follows runs into it.
fn misplaced_text_word(text: &str, elements: &[Element], layout: &Layout) -> Option<SyntaxError> {
    if layout.dialect.text_words == TextWords::Anywhere || elements.first()?.kind != ElementKind::Name {
        return None;
    }
    let trimmed = text.trim_start_matches([' ', '\t']);
    let start = text.len() - trimmed.len();
    let length = trimmed.bytes().take_while(u8::is_ascii_alphanumeric).count();
    let spelling: SmolStr = trimmed.get(..length)?.to_ascii_uppercase().into();
    let word = layout.dialect.word(&spelling)?;
    let is_text = start > 0 && word.class == crate::vocabulary::WordClass::Text;
    let range = crate::text_range(start, start + length);
    is_text.then(|| SyntaxError::new(SyntaxErrorKind::TextWordNotInColumnOne { word: spelling }, range))
}

fn joined_elements(text: &str, elements: &[Element], lexed: &Lexed) -> Vec<JoinedElement> {
    let mut joined = Vec::new();
    for (element, (first, last)) in elements.iter().zip(&lexed.element_tokens) {
        if first == last
            || !matches!(element.kind, ElementKind::Name | ElementKind::Word | ElementKind::Number)
        {
            continue;
        }
        let tokens = lexed.tokens.get(*first as usize..=*last as usize).unwrap_or_default();
        // A name divided over two records is divided on purpose.
        if tokens.iter().any(|token| token.kind == SyntaxKind::Continuation) {
            continue;
        }
        let pieces = tokens
            .iter()
            .filter(|token| !token.kind.is_trivia())
            .filter_map(|token| text.get(std::ops::Range::<usize>::from(token.range)))
            .map(SmolStr::new)
            .collect();
        joined.push(JoinedElement { range: element.range, pieces });
    }
    joined
}

/// The result of a production: an error ends the statement part.
type Parsed<T> = Result<T, SyntaxError>;

struct Parser<'a> {
    elements: &'a [Element],
    position: usize,
    dialect: &'a Dialect,
    nodes: Vec<NodeSpan>,
    errors: Vec<SyntaxError>,
    depth: u16,
    operators: u16,
    spoiled: Option<Name>,
}

impl<'a> Parser<'a> {
    fn new(elements: &'a [Element], dialect: &'a Dialect) -> Parser<'a> {
        Parser {
            elements,
            position: 0,
            dialect,
            nodes: Vec::new(),
            errors: Vec::new(),
            depth: 0,
            operators: 0,
            spoiled: None,
        }
    }

    /// A statement that is not looked at any further.
    fn unreadable(&mut self) -> Statement {
        self.position = self.elements.len();
        self.note(SyntaxKind::Error, 0);
        Statement {
            label: None,
            parts: vec![crate::statement::Part { range: self.range_from(0), body: Body::Error }],
        }
    }

    // Looking.

    fn element(&self, ahead: usize) -> Option<&'a Element> {
        self.elements.get(self.position + ahead)
    }

    fn kind(&self, ahead: usize) -> Option<ElementKind> {
        self.element(ahead).map(|element| element.kind)
    }

    fn at(&self, kind: ElementKind) -> bool {
        self.kind(0) == Some(kind)
    }

    fn at_end(&self) -> bool {
        self.position >= self.elements.len()
    }

    /// The vocabulary entry of the element `ahead`, if that is a word.
    fn word_at(&self, ahead: usize) -> Option<&'static Word> {
        let element = self.element(ahead)?;
        if element.kind != ElementKind::Word {
            return None;
        }
        // A synonym may have made a word of another dialect a word here.
        self.dialect.word(&element.text).or_else(|| crate::vocabulary::lookup(&element.text))
    }

    fn at_word(&self, spelling: &str) -> bool {
        self.word_at(0).is_some_and(|word| word.spelling == spelling)
    }

    // Going on.

    fn bump(&mut self) -> Option<&'a Element> {
        let element = self.elements.get(self.position);
        self.position = self.elements.len().min(self.position + 1);
        element
    }

    fn eat(&mut self, kind: ElementKind) -> bool {
        let found = self.at(kind);
        self.position += usize::from(found);
        found
    }

    fn word_use(&mut self) -> Option<WordUse> {
        let word = self.word_at(0)?;
        let range = self.bump()?.range;
        Some(WordUse { word, range })
    }

    // Noting.

    /// Notes that the elements from `first` to the present position are a node.
    fn note(&mut self, kind: SyntaxKind, first: usize) {
        if self.position > first {
            let index = |position: usize| u32::try_from(position).unwrap_or(u32::MAX);
            self.nodes.push(NodeSpan { kind, first: index(first), end: index(self.position) });
        }
    }

    /// From the element `first` to the last one read.
    fn range_from(&self, first: usize) -> TextRange {
        let start = self.elements.get(first).or(self.elements.last()).map(|element| element.range);
        let last = self.position.checked_sub(1).and_then(|last| self.elements.get(last.max(first)));
        match (start, last) {
            (Some(start), Some(last)) => start.cover(last.range),
            (Some(start), None) => start,
            _ => TextRange::default(),
        }
    }

    // Complaining.

    /// An error at the present element, or at the last one if there is no more.
    fn fail<T>(&self, kind: SyntaxErrorKind) -> Parsed<T> {
        let element = self.element(0).or(self.elements.last());
        Err(SyntaxError::new(kind, element.map(|element| element.range).unwrap_or_default()))
    }

    /// What is wrong if the present element cannot follow an operand.
    fn fail_after_operand<T>(&self, in_list: bool) -> Parsed<T> {
        let Some(element) = self.element(0) else { return self.fail(SyntaxErrorKind::EndsOnPunctuation) };
        let kind = match element.kind {
            ElementKind::Plus
            | ElementKind::Minus
            | ElementKind::Star
            | ElementKind::Power
            | ElementKind::Comma
                if self.element(1).is_none() =>
            {
                SyntaxErrorKind::EndsOnPunctuation
            }
            ElementKind::Plus
            | ElementKind::Minus
            | ElementKind::Star
            | ElementKind::Power
            | ElementKind::Slash
                if in_list =>
            {
                SyntaxErrorKind::OperatorInList
            }
            ElementKind::Name | ElementKind::Number | ElementKind::LeftParenthesis | ElementKind::Text => {
                SyntaxErrorKind::MissingSeparator
            }
            ElementKind::Word => SyntaxErrorKind::MissingSeparator,
            ElementKind::Comma => match self.list_without_word(false) {
                Some(error) => return Err(error),
                None => SyntaxErrorKind::MissingSeparator,
            },
            ElementKind::Equals => {
                let Some(name) = self.divided_name_behind(self.position) else {
                    return self.fail(SyntaxErrorKind::UnexpectedMark(element.text.clone()));
                };
                let kind = SyntaxErrorKind::ListWithoutWord { name: name.text.clone(), before_word: false };
                return Err(SyntaxError::new(kind, name.range));
            }
            ElementKind::Relation => SyntaxErrorKind::RelationNotAllowed(element.text.clone()),
            ElementKind::RightParenthesis => SyntaxErrorKind::UnopenedParenthesis,
            ElementKind::Bad => return self.fail_at_bad(),
            _ => SyntaxErrorKind::UnexpectedMark(element.text.clone()),
        };
        self.fail(kind)
    }

    /// An error at the name behind the last `=` or open parenthesis before the present element, if a slash follows it: most
    /// likely a misspelt word with its list. A parenthesis that follows such a slash at once is the first item of the list.
    fn list_without_word(&self, before_word: bool) -> Option<SyntaxError> {
        let mut opening = self.opening_before(self.position)?;
        loop {
            if let Some(name) = self.divided_name_behind(opening) {
                let kind = SyntaxErrorKind::ListWithoutWord { name: name.text.clone(), before_word };
                return Some(SyntaxError::new(kind, name.range));
            }
            let outer = self.opening_before(opening)?;
            if outer + 3 != opening {
                return None;
            }
            opening = outer;
        }
    }

    /// The name with a slash that follows an element at once.
    fn divided_name_behind(&self, element: usize) -> Option<&Element> {
        match self.elements.get(element + 1..=element + 2)? {
            [name, slash] if name.kind == ElementKind::Name && slash.kind == ElementKind::Slash => Some(name),
            _ => None,
        }
    }

    /// The last `=`, or open parenthesis that is not closed, before an element.
    fn opening_before(&self, end: usize) -> Option<usize> {
        let mut closed = 0_usize;
        self.elements.get(..end)?.iter().rposition(|element| match element.kind {
            ElementKind::RightParenthesis => {
                closed += 1;
                false
            }
            ElementKind::LeftParenthesis if closed > 0 => {
                closed -= 1;
                false
            }
            kind => closed == 0 && matches!(kind, ElementKind::LeftParenthesis | ElementKind::Equals),
        })
    }

    /// The lexer has said what is wrong with a bad element; its error is repeated and later recognised as the same.
    fn fail_at_bad<T>(&self) -> Parsed<T> {
        let range = self.element(0).map(|element| element.range).unwrap_or_default();
        let known = self.errors.iter().find(|error| error.range == range);
        Err(known.cloned().unwrap_or_else(|| SyntaxError::new(SyntaxErrorKind::MisplacedDecimalPoint, range)))
    }

    /// Goes one level deeper for the length of a production.
    fn nested<T>(&mut self, production: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth >= MAXIMUM_DEPTH {
            return self.fail(SyntaxErrorKind::TooDeep);
        }
        self.depth += 1;
        let result = production(self);
        self.depth -= 1;
        result
    }

    /// Counts an operator that makes the statement deeper.
    fn count_operator(&mut self) -> Parsed<()> {
        if self.operators >= MAXIMUM_OPERATORS {
            return self.fail(SyntaxErrorKind::TooDeep);
        }
        self.operators += 1;
        Ok(())
    }
}
