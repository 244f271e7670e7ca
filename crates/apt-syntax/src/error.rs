//! Syntax errors, as data.

use rowan::TextRange;
use smol_str::SmolStr;

use crate::dialect::DialectName;

/// A syntax error with its place relative to the start of the statement.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{kind}")]
pub struct SyntaxError {
    /// What is wrong.
    pub kind: SyntaxErrorKind,
    /// Where.
    pub range: TextRange,
}

impl SyntaxError {
    /// An error at a place.
    pub fn new(kind: SyntaxErrorKind, range: TextRange) -> SyntaxError {
        SyntaxError { kind, range }
    }

    /// The APT III diagnostic number, where there is one.
    pub fn apt3(&self) -> Option<u16> {
        self.kind.apt3()
    }
}

/// What is wrong with a statement.
///
/// The short texts are for logs and tests; what a user reads is made elsewhere from the data.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SyntaxErrorKind {
    // Lexical.
    /// A name has more characters than the dialect allows.
    #[error("name {name} is longer than {limit} characters")]
    NameTooLong {
        /// The whole name.
        name: SmolStr,
        /// The most characters.
        limit: u16,
        /// The pieces that blanks divide, if there are several: a comma may be missing between them.
        pieces: Vec<SmolStr>,
    },
    /// A number has more significant digits than the dialect allows.
    #[error("number has {digits} significant digits, more than {limit}")]
    NumberTooLong {
        /// How many it has.
        digits: u32,
        /// The most.
        limit: u16,
    },
    /// A number that cannot be represented.
    #[error("number {text} cannot be converted")]
    NumberNotConvertible {
        /// Its text.
        text: SmolStr,
    },
    /// A second decimal point, or one after a name.
    #[error("misplaced decimal point")]
    MisplacedDecimalPoint,
    /// A character outside the set.
    #[error("character {0:?} is not allowed")]
    IllegalCharacter(char),
    /// Quoted text without its end.
    #[error("quoted text is not closed")]
    UnclosedText,
    /// PARTNO and its kin outside columns 1-6.
    #[error("{word} must stand in columns 1-6")]
    TextWordNotInColumnOne {
        /// The word.
        word: SmolStr,
    },
    /// Statement text runs into the columns of the sequence field and is cut there.
    #[error("text runs into column 73")]
    RunsIntoSequenceField,

    // Statement as a whole.
    /// The statement begins neither with a name nor with a word.
    #[error("a statement begins with a name or a word")]
    BadStatementStart,
    /// The statement has more elements than the dialect allows.
    #[error("{count} elements, more than {limit}")]
    TooManyElements {
        /// How many it has.
        count: u32,
        /// The most.
        limit: u32,
    },
    /// The statement has more nested definitions and points than the dialect allows.
    #[error("{count} nests, more than {limit}")]
    TooManyNests {
        /// How many it has.
        count: u32,
        /// The most.
        limit: u32,
    },
    /// `label)` without a statement.
    #[error("label without a statement")]
    LabelWithoutStatement,
    /// A vocabulary word as a label.
    #[error("word {0} used as a label")]
    WordAsLabel(SmolStr),
    /// The statement ends on punctuation.
    #[error("the statement ends on punctuation")]
    EndsOnPunctuation,
    /// `(` without `)`.
    #[error("parenthesis is never closed")]
    UnclosedParenthesis,
    /// `)` without `(`.
    #[error("parenthesis was never opened")]
    UnopenedParenthesis,
    /// A name that is not followed by `=`.
    #[error("{name} is not followed by =")]
    NameWithoutEquals {
        /// The name.
        name: SmolStr,
        /// A comma follows: a list without a word that takes it.
        listed: bool,
    },
    /// A statement that begins with a word of another dialect.
    #[error("{word} belongs to the dialect {dialect}")]
    NotInDialect {
        /// The word.
        word: SmolStr,
        /// A dialect that has it.
        dialect: DialectName,
    },
    /// THEN, ELSE, ELSEIF or ENDIF in a dialect that does not have the IF over several statements.
    #[error("{word} belongs to an IF over several statements")]
    StructuredIf {
        /// The word.
        word: SmolStr,
    },
    /// THEN, ELSE or `ENDIF` with something else behind it on the line.
    #[error("{word} ends its statement")]
    RunsOnAfterWord {
        /// The word.
        word: SmolStr,
    },
    /// ELSEIF, or an IF without a statement, that does not end on THEN.
    #[error("{word} wants THEN behind its condition")]
    ThenMissing {
        /// The word.
        word: SmolStr,
    },
    /// A word that cannot begin a statement or cannot stand in this place.
    #[error("word {0} is not allowed here")]
    WordNotAllowed(SmolStr),
    /// A vocabulary word as the target of `=`, or a type word without its slash.
    #[error("word {0} without a slash")]
    NoSlash(SmolStr),
    /// A statement whose word always has a slash behind it, without one.
    #[error("{statement}: no slash behind {word}")]
    SlashMissing {
        /// The word of the statement.
        statement: SmolStr,
        /// The word that the slash follows: the same, or the type of OBTAIN.
        word: SmolStr,
    },
    /// A second word for where the tool is: on which side of the drive surface, or whether on the part surface.
    #[error("{second} after {first}")]
    ToolPositionTwice {
        /// The word that has said it.
        first: SmolStr,
        /// The word that says it again.
        second: SmolStr,
    },
    /// A word was required after the comma.
    #[error("a vocabulary word is required here")]
    WordRequired,
    /// FINI with something else on its statement.
    #[error("FINI stands alone")]
    FiniNotAlone,
    /// A slash after a word that takes no parameters.
    #[error("{0} takes no parameters")]
    TakesNoParameters(SmolStr),

    // Expressions.
    /// Two operators in a row.
    #[error("two operators in a row")]
    TwoOperators,
    /// An operand is missing.
    #[error("operand missing")]
    OperandMissing,
    /// `()`.
    #[error("empty parentheses")]
    EmptyParentheses,
    /// A function without its parentheses.
    #[error("{0} needs its argument in parentheses")]
    FunctionWithoutParentheses(SmolStr),
    /// More than [`crate::grammar::MAXIMUM_POWER_CHAIN`] `**` in a chain.
    #[error("too many ** in a chain")]
    TooManyPowers,
    /// Parentheses or operators nest deeper than [`crate::grammar::MAXIMUM_DEPTH`].
    #[error("nested too deeply")]
    TooDeep,
    /// A relation such as `.EQ.` where the dialect has none.
    #[error("relation {0} is not part of this dialect")]
    RelationNotAllowed(SmolStr),
    /// A relation or a logical operator is missing in a condition.
    #[error("relation missing")]
    RelationMissing,

    // Lists.
    /// A comma (or an operator) is missing between two operands.
    #[error("comma or operator missing")]
    MissingSeparator,
    /// A list behind a name and a slash, which only divide.
    #[error("{name} takes no list")]
    ListWithoutWord {
        /// The name.
        name: SmolStr,
        /// A word stands behind the slash.
        before_word: bool,
    },
    /// An operator between parameters of a list, where expressions need parentheses.
    #[error("expression in a list needs parentheses")]
    OperatorInList,
    /// An empty position where the form has none.
    #[error("empty position")]
    EmptyPosition,
    /// A mark that does not belong here.
    #[error("unexpected {0}")]
    UnexpectedMark(SmolStr),
    /// A name with several arguments in an expression: a function that the dialect does not have.
    #[error("there is no function {0}")]
    UnknownFunction(SmolStr),
    /// A slash, but no parameters.
    #[error("parameters missing after the slash")]
    MissingParameters,
    /// A badly formed inclusive subscript.
    #[error("badly formed inclusive subscript")]
    BadInclusiveSubscript,

    // Macros, branches, OBTAIN.
    /// The form must be `name=MACRO/…`.
    #[error("the form is name=MACRO/…")]
    MacroForm,
    /// A macro variable is not a name.
    #[error("macro variable is not a name")]
    MacroVariableNotName,
    /// An expression as a macro value.
    #[error("expression as a macro value")]
    MacroValueExpression,
    /// A subscripted name or a nest as a macro value.
    #[error("nested or subscripted macro value")]
    MacroValueNested,
    /// A macro value is missing after `=`.
    #[error("macro value missing")]
    MacroValueMissing,
    /// CALL without a slash.
    #[error("CALL without a slash")]
    CallWithoutSlash,
    /// What follows `CALL/` is not a name.
    #[error("macro name expected")]
    CallNameExpected,
    /// No `=` after the variable in a CALL.
    #[error("{name} needs = and a value")]
    CallValueExpected {
        /// The variable.
        name: SmolStr,
    },
    /// A comma is missing in a CALL.
    #[error("comma expected in CALL")]
    CallCommaExpected,
    /// A label is missing.
    #[error("label missing")]
    LabelMissing,
    /// IF without exactly three labels, JUMPTO without exactly one.
    #[error("{found} labels instead of {expected}")]
    LabelCount {
        /// How many there are.
        found: u32,
        /// How many are needed.
        expected: u32,
    },
    /// IF without its condition in parentheses.
    #[error("IF needs a condition in parentheses")]
    ConditionMissing,
    /// A logical IF where the dialect has none.
    #[error("a logical IF takes one statement")]
    LogicalIfStatement,
    /// An ELSE, ENDIF or IF over several statements as the statement of a logical IF.
    #[error("{word} cannot be the statement of an IF")]
    ConditionalClause {
        /// The word.
        word: SmolStr,
    },
    /// A DO as the statement of a logical IF.
    #[error("DO cannot be the statement of an IF")]
    ConditionalDo,
    /// OBTAIN without a type word.
    #[error("OBTAIN needs a type word")]
    ObtainTypeExpected,
    /// A comma before the surface of OBTAIN.
    #[error("a slash stands between {0} and the surface of OBTAIN")]
    ObtainComma(SmolStr),
    /// DO whose form is not `DO/label,i=first,last[,step]`.
    #[error("the form is DO/label,i=first,last,step")]
    DoForm,
}

impl SyntaxErrorKind {
    /// The APT III diagnostic number (language reference 9.2 and 9.5), where there is one.
    pub fn apt3(&self) -> Option<u16> {
        use SyntaxErrorKind as Kind;
        Some(match self {
            Kind::NameTooLong { .. } => 1,
            Kind::NumberTooLong { .. } => 2,
            Kind::NumberNotConvertible { .. } => 4,
            Kind::BadStatementStart => 5,
            Kind::MissingSeparator
            | Kind::ListWithoutWord { before_word: false, .. }
            | Kind::OperatorInList
            | Kind::EmptyPosition
            | Kind::NameWithoutEquals { listed: true, .. } => 7,
            Kind::IllegalCharacter(_) | Kind::UnclosedText => 8,
            Kind::UnopenedParenthesis => 9,
            Kind::UnclosedParenthesis => 10,
            Kind::EndsOnPunctuation | Kind::LabelWithoutStatement => 11,
            Kind::TooManyElements { .. } => 13,
            Kind::WordAsLabel(_) => 17,
            Kind::MisplacedDecimalPoint | Kind::RelationNotAllowed(_) => 20,
            Kind::TextWordNotInColumnOne { .. } => 21,
            Kind::FiniNotAlone => 23,
            Kind::OperandMissing => 53,
            Kind::TwoOperators => 54,
            Kind::TooManyPowers => 56,
            Kind::FunctionWithoutParentheses(_) => 59,
            Kind::TooDeep | Kind::TooManyNests { .. } => 70,
            Kind::WordNotAllowed(_) | Kind::ListWithoutWord { before_word: true, .. } => 76,
            Kind::EmptyParentheses | Kind::UnexpectedMark(_) | Kind::ConditionMissing => 78,
            Kind::WordRequired => 81,
            Kind::NameWithoutEquals { .. } | Kind::NotInDialect { .. } | Kind::StructuredIf { .. } => 82,
            Kind::UnknownFunction(_) => 108,
            Kind::BadInclusiveSubscript => 109,
            Kind::MissingParameters => 129,
            Kind::ObtainTypeExpected => 153,
            Kind::NoSlash(_) | Kind::SlashMissing { .. } | Kind::ObtainComma(_) => 155,
            Kind::MacroForm => 203,
            Kind::MacroVariableNotName => 207,
            Kind::CallNameExpected => 226,
            Kind::CallWithoutSlash => 227,
            Kind::CallValueExpected { .. } => 229,
            Kind::MacroValueMissing => 230,
            Kind::MacroValueNested => 232,
            Kind::CallCommaExpected => 234,
            Kind::MacroValueExpression => 235,
            Kind::LabelMissing => 403,
            Kind::LabelCount { .. } => 409,
            Kind::TakesNoParameters(_) => 505,
            Kind::RunsIntoSequenceField
            | Kind::RelationMissing
            | Kind::LogicalIfStatement
            | Kind::ConditionalClause { .. }
            | Kind::RunsOnAfterWord { .. }
            | Kind::ThenMissing { .. }
            | Kind::ConditionalDo
            | Kind::ToolPositionTwice { .. }
            | Kind::DoForm => return None,
        })
    }

    /// Whether the statement can be used all the same: the fault is reported as a warning.
    pub fn is_warning(&self) -> bool {
        matches!(self, SyntaxErrorKind::RunsIntoSequenceField)
    }

    /// Whether the fault is one of characters and single elements: it stays when other elements are replaced.
    pub fn is_lexical(&self) -> bool {
        matches!(
            self,
            SyntaxErrorKind::NameTooLong { .. }
                | SyntaxErrorKind::NumberTooLong { .. }
                | SyntaxErrorKind::IllegalCharacter(_)
                | SyntaxErrorKind::UnclosedText
                | SyntaxErrorKind::MisplacedDecimalPoint
                | SyntaxErrorKind::RunsOnAfterWord { .. }
                | SyntaxErrorKind::RunsIntoSequenceField
        )
    }

    /// Whether the statement still has a meaning although the fault is an error: only its spelling is beyond a limit.
    pub fn keeps_meaning(&self) -> bool {
        matches!(
            self,
            SyntaxErrorKind::RunsIntoSequenceField
                | SyntaxErrorKind::NameTooLong { .. }
                | SyntaxErrorKind::NumberTooLong { .. }
                | SyntaxErrorKind::TooManyElements { .. }
                | SyntaxErrorKind::TooManyNests { .. }
                | SyntaxErrorKind::ObtainComma(_)
                | SyntaxErrorKind::ToolPositionTwice { .. }
        )
    }
}
