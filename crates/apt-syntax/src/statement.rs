//! Statements as plain data: what a statement says, free of blanks, comments and cards.
//!
//! The evaluator works on these. They come from the same grammar as the lossless tree, and every part keeps its
//! [`TextRange`] relative to the start of the statement, so that an edit elsewhere leaves them valid. Names, words and
//! numbers are upper case with the insignificant blanks removed.

use rowan::TextRange;
use smol_str::SmolStr;

pub use crate::kind::ElementKind;
use crate::vocabulary::Word;

/// A name as written (upper case, blanks removed).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// The spelling.
    pub text: SmolStr,
    /// Where it stands.
    pub range: TextRange,
}

/// A use of a vocabulary word.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WordUse {
    /// The vocabulary entry.
    pub word: &'static Word,
    /// Where it stands.
    pub range: TextRange,
}

/// One statement of the program: an optional label and one or more parts on the same line (language reference 2.4).
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// `label)`.
    pub label: Option<Name>,
    /// The parts in order; empty for a blank or comment line.
    pub parts: Vec<Part>,
}

/// One part of a statement.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// From its first to its last element.
    pub range: TextRange,
    /// What it says.
    pub body: Body,
}

impl Part {
    /// Whether another part may follow after a comma: a word such as TLRGT, without parameters.
    pub(crate) fn joins_another(&self) -> bool {
        match &self.body {
            Body::Major { word, slash: false, .. } => word.word.class.joins_statements(),
            _ => false,
        }
    }
}

/// What a statement part says.
#[derive(Debug, Clone, PartialEq)]
pub enum Body {
    /// PARTNO, PPRINT, INSERT, TITLES, REMARK and, where a dialect says so, other words followed by free text.
    Text {
        /// The word.
        word: WordUse,
        /// The text, verbatim.
        text: SmolStr,
        /// Where the text stands.
        range: TextRange,
    },
    /// `target = expression`.
    Assignment {
        /// What is assigned to.
        target: Reference,
        /// The value.
        value: Expression,
    },
    /// `target = TYPE/…`.
    Definition {
        /// The name defined.
        target: Reference,
        /// The definition.
        definition: Definition,
    },
    /// `name = MACRO/…`.
    Macro {
        /// The macro's name.
        name: Name,
        /// The word MACRO.
        word: WordUse,
        /// Its variables.
        parameters: Vec<MacroParameter>,
    },
    /// `CALL/name,a=…`.
    Call {
        /// The word CALL.
        word: WordUse,
        /// The macro.
        name: Name,
        /// Values for its variables.
        arguments: Vec<MacroParameter>,
        /// `SEC1` or `SEC2` of a call of an installation routine.
        section: Option<WordUse>,
    },
    /// `IF(e) a,b,c`.
    ArithmeticIf {
        /// The word IF.
        word: WordUse,
        /// The condition.
        condition: Expression,
        /// Labels for negative, zero, positive.
        labels: [Name; 3],
    },
    /// `IF(a.LT.b) statement` (dialects that have it).
    LogicalIf {
        /// The word IF.
        word: WordUse,
        /// The condition.
        condition: Condition,
        /// What is done if it holds: the parts of one statement.
        then: Vec<Part>,
    },
    /// A statement of an IF over several statements (dialects that have it).
    Clause {
        /// The word IF, ELSEIF, ELSE or ENDIF.
        word: WordUse,
        /// What it says.
        clause: Clause,
    },
    /// `DO/label,i=first,last,step` (dialects that have it).
    Do {
        /// The word DO.
        word: WordUse,
        /// The label of the last statement of the loop.
        label: Name,
        /// The index.
        index: Reference,
        /// First, last and perhaps step.
        bounds: Vec<Expression>,
    },
    /// `JUMPTO/id` and `TRANTO/id`.
    Jump {
        /// JUMPTO or TRANTO.
        word: WordUse,
        /// Where to.
        label: Name,
    },
    /// Any other major word with its parameters: motion, post-processor words, parameters, declarations. A line of bare
    /// numbers in a CL file is a GOTO whose word has an empty range and no slash.
    Major {
        /// The word.
        word: WordUse,
        /// Whether a slash follows.
        slash: bool,
        /// The parameters.
        arguments: Vec<Argument>,
    },
    /// A major word that nobody knows, where the dialect keeps such statements (CL files).
    UnknownMajor {
        /// The word, which is none of the vocabulary.
        name: Name,
        /// Whether a slash follows.
        slash: bool,
        /// The parameters.
        arguments: Vec<Argument>,
    },
    /// OBTAIN: the type word and what follows.
    Obtain {
        /// The word OBTAIN.
        word: WordUse,
        /// The type.
        kind: WordUse,
        /// The surface, then the names; empty positions kept.
        arguments: Vec<Argument>,
    },
    /// A statement with syntax errors; they are reported beside it.
    Error,
}

/// A macro variable in a header (value = default) or a value in a CALL.
#[derive(Debug, Clone, PartialEq)]
pub struct MacroParameter {
    /// The variable.
    pub name: Name,
    /// The elements after `=`, none if there is no `=`.
    pub value: Option<Vec<Element>>,
    /// From the name to the end of the value.
    pub range: TextRange,
}

/// A name with an optional subscript.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The name.
    pub name: Name,
    /// The subscript.
    pub subscript: Option<Box<Expression>>,
    /// The whole.
    pub range: TextRange,
}

/// `TYPE/parameters`, also inside a nest.
#[derive(Debug, Clone, PartialEq)]
pub struct Definition {
    /// The type word.
    pub kind: WordUse,
    /// The parameters.
    pub arguments: Vec<Argument>,
    /// The whole.
    pub range: TextRange,
}

/// One parameter of a list.
#[derive(Debug, Clone, PartialEq)]
pub enum Argument {
    /// Two commas in a row.
    Empty(TextRange),
    /// A number, a reference (scalar or geometry), a signed or parenthesised expression.
    Expression(Expression),
    /// A vocabulary word.
    Word(WordUse),
    /// `(name=TYPE/…)` or `(TYPE/…)`.
    Nested {
        /// The name it defines.
        target: Option<Reference>,
        /// The definition.
        definition: Definition,
        /// With its parentheses.
        range: TextRange,
    },
    /// `(x,y)` or `(x,y,z)`.
    Point {
        /// Two or three coordinates.
        coordinates: Vec<Argument>,
        /// With its parentheses.
        range: TextRange,
    },
    /// `A(2,THRU,ALL,INCR,2)`.
    Inclusive {
        /// The array.
        name: Name,
        /// The low end, if written.
        first: Option<Expression>,
        /// The high end; none for ALL.
        last: Option<Expression>,
        /// `INCR` (true) or `DECR` (false) with the step.
        step: Option<(bool, Expression)>,
        /// The whole.
        range: TextRange,
    },
    /// Quoted text (CL dialects).
    Text {
        /// The text without quotes.
        text: SmolStr,
        /// With its quotes.
        range: TextRange,
    },
}

/// An arithmetic expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A number.
    Number {
        /// Its value.
        value: f64,
        /// Where.
        range: TextRange,
    },
    /// A name.
    Reference(Reference),
    /// `+e` or `-e`.
    Sign {
        /// True for minus.
        negative: bool,
        /// What it applies to.
        operand: Box<Expression>,
        /// The whole.
        range: TextRange,
    },
    /// `a ** b`.
    Power {
        /// The base.
        base: Box<Expression>,
        /// The exponent.
        exponent: Box<Expression>,
        /// The whole.
        range: TextRange,
    },
    /// `a op b op c …` with operators of one rank, which are carried out from left to right. A list and no tree: a
    /// statement may have ten thousand operators.
    Chain {
        /// The first operand.
        first: Box<Expression>,
        /// Each operator with the operand behind it; never empty.
        rest: Vec<(Operator, Expression)>,
        /// The whole.
        range: TextRange,
    },
    /// `F(a,b)`.
    Call {
        /// The function word.
        function: WordUse,
        /// Its arguments.
        arguments: Vec<Argument>,
        /// The whole.
        range: TextRange,
    },
    /// `(name=e)`.
    Assign {
        /// What is assigned to.
        target: Reference,
        /// The value.
        value: Box<Expression>,
        /// The whole.
        range: TextRange,
    },
    /// `(e)`.
    Parenthesised {
        /// What stands inside.
        inner: Box<Expression>,
        /// With the parentheses.
        range: TextRange,
    },
}

/// An arithmetic operator between the operands of a chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
}

/// A statement of an IF over several statements: each opens a branch, the last closes them.
#[derive(Debug, Clone, PartialEq)]
pub enum Clause {
    /// `IF(condition)THEN`
    If(Condition),
    /// `ELSEIF(condition)THEN`
    ElseIf(Condition),
    /// `ELSE`
    Else,
    /// `ENDIF`
    End,
}

/// A logical condition (dialects that have it).
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Condition {
    Relation { operator: RelationOperator, left: Expression, right: Expression },
    And(Box<Condition>, Box<Condition>),
    Or(Box<Condition>, Box<Condition>),
    Not(Box<Condition>),
}

/// A relation of a logical condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names are the language's own")]
pub enum RelationOperator {
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
}

/// One significant element of a statement: macro and synonym substitution work on these.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    /// What it is.
    pub kind: ElementKind,
    /// Its spelling, upper case, blanks removed (text elements verbatim).
    pub text: SmolStr,
    /// Where it stands, relative to the start of the statement.
    pub range: TextRange,
}

impl Name {
    /// The name as a label: numeric labels are compared by value, so `01` is `1` (language reference 1.9).
    pub fn label(&self) -> SmolStr {
        normalised_label(&self.text)
    }
}

/// The spelling under which a label is known: digits lose their leading zeros.
pub fn normalised_label(text: &str) -> SmolStr {
    if text.is_empty() || !text.bytes().all(|byte| byte.is_ascii_digit()) {
        return SmolStr::new(text);
    }
    let digits = text.trim_start_matches('0');
    if digits.is_empty() { SmolStr::new_static("0") } else { SmolStr::new(digits) }
}

impl Argument {
    /// Where the parameter stands.
    pub fn range(&self) -> TextRange {
        match self {
            Argument::Empty(range) => *range,
            Argument::Expression(expression) => expression.range(),
            Argument::Word(word) => word.range,
            Argument::Nested { range, .. }
            | Argument::Point { range, .. }
            | Argument::Inclusive { range, .. }
            | Argument::Text { range, .. } => *range,
        }
    }
}

impl Expression {
    /// Where the expression stands.
    pub fn range(&self) -> TextRange {
        match self {
            Expression::Reference(reference) => reference.range,
            Expression::Number { range, .. }
            | Expression::Sign { range, .. }
            | Expression::Power { range, .. }
            | Expression::Chain { range, .. }
            | Expression::Call { range, .. }
            | Expression::Assign { range, .. }
            | Expression::Parenthesised { range, .. } => *range,
        }
    }
}
