//! Arithmetic expressions (language reference 2.2 and 2.5).

use super::argument::ListRules;
use super::{MAXIMUM_POWER_CHAIN, Parsed, Parser};
use crate::dialect::SignRule;
use crate::error::SyntaxErrorKind;
use crate::kind::SyntaxKind;
use crate::lexer::number_value;
use crate::statement::{ElementKind, Expression, Name, Operator, Reference, WordUse};
use crate::vocabulary::{self, Word, WordClass};

/// A production that gives an expression.
type Production<'a> = fn(&mut Parser<'a>) -> Parsed<Expression>;

impl<'a> Parser<'a> {
    /// `term { (+|-) term }`
    pub(super) fn expression(&mut self) -> Parsed<Expression> {
        self.nested(|parser| {
            let first = parser.position;
            let left = parser.term()?;
            parser.sum(first, left)
        })
    }

    /// What may follow an operand that is already read: the rest of its power, term and sum.
    pub(super) fn expression_from(&mut self, first: usize, operand: Expression) -> Parsed<Expression> {
        let power = self.powers(first, operand)?;
        let term = self.product(first, power)?;
        self.sum(first, term)
    }

    fn sum(&mut self, first: usize, left: Expression) -> Parsed<Expression> {
        self.chain(first, left, Self::term, |kind| match kind {
            ElementKind::Plus => Some(Operator::Add),
            ElementKind::Minus => Some(Operator::Subtract),
            _ => None,
        })
    }

    /// `power { (*|/) power }`
    fn term(&mut self) -> Parsed<Expression> {
        let first = self.position;
        let left = self.power()?;
        self.product(first, left)
    }

    fn product(&mut self, first: usize, left: Expression) -> Parsed<Expression> {
        self.chain(first, left, Self::power, |kind| match kind {
            ElementKind::Star => Some(Operator::Multiply),
            ElementKind::Slash => Some(Operator::Divide),
            _ => None,
        })
    }

    /// Operators of one rank, from left to right.
    fn chain(
        &mut self,
        first: usize,
        left: Expression,
        operand: Production<'a>,
        operator_of: fn(ElementKind) -> Option<Operator>,
    ) -> Parsed<Expression> {
        let mut rest = Vec::new();
        while let Some(operator) = self.kind(0).and_then(operator_of) {
            self.bump();
            rest.push((operator, operand(self)?));
        }
        if rest.is_empty() {
            return Ok(left);
        }
        self.note(SyntaxKind::Binary, first);
        Ok(Expression::Chain { first: Box::new(left), rest, range: self.range_from(first) })
    }

    fn raised(&mut self, first: usize, base: Expression, exponent: Expression) -> Expression {
        self.note(SyntaxKind::Binary, first);
        Expression::Power {
            base: Box::new(base),
            exponent: Box::new(exponent),
            range: self.range_from(first),
        }
    }

    /// A power with its signs: which of them binds tighter is the dialect's.
    fn power(&mut self) -> Parsed<Expression> {
        match self.dialect.signs {
            SignRule::TighterThanPower => {
                let first = self.position;
                let base = self.signed(Self::primary)?;
                self.powers(first, base)
            }
            SignRule::WeakerThanPower => self.signed(|parser| {
                let first = parser.position;
                let base = parser.primary()?;
                parser.powers(first, base)
            }),
        }
    }

    /// `{ ** factor }` after the base.
    fn powers(&mut self, first: usize, base: Expression) -> Parsed<Expression> {
        // Every operand with the element where it begins and the one after it.
        let mut operands = vec![(first, self.position, base)];
        while self.eat(ElementKind::Power) {
            if operands.len() > usize::from(MAXIMUM_POWER_CHAIN) {
                return self.fail(SyntaxErrorKind::TooManyPowers);
            }
            self.count_operator()?;
            let start = self.position;
            let exponent = self.signed(Self::primary)?;
            operands.push((start, self.position, exponent));
        }
        let end = self.position;
        let combined = match self.dialect.signs {
            SignRule::TighterThanPower => {
                operands.into_iter().rev().reduce(|(_, _, right), (start, _, left)| {
                    self.position = end;
                    (start, end, self.raised(start, left, right))
                })
            }
            SignRule::WeakerThanPower => operands.into_iter().reduce(|(start, _, left), (_, stop, right)| {
                self.position = stop;
                (start, stop, self.raised(start, left, right))
            }),
        };
        self.position = end;
        match combined {
            Some((_, _, expression)) => Ok(expression),
            None => self.fail(SyntaxErrorKind::OperandMissing),
        }
    }

    /// `[sign] operand`; several signs where the dialect allows them.
    fn signed(&mut self, operand: impl FnOnce(&mut Self) -> Parsed<Expression>) -> Parsed<Expression> {
        let mut signs = Vec::new();
        while matches!(self.kind(0), Some(ElementKind::Plus | ElementKind::Minus)) {
            if !signs.is_empty() && self.dialect.signs == SignRule::TighterThanPower {
                return self.fail(SyntaxErrorKind::TwoOperators);
            }
            if !signs.is_empty() {
                self.count_operator()?;
            }
            signs.push((self.position, self.at(ElementKind::Minus)));
            self.bump();
        }
        let mut expression = operand(self)?;
        while let Some((first, negative)) = signs.pop() {
            self.note(SyntaxKind::Signed, first);
            expression =
                Expression::Sign { negative, operand: Box::new(expression), range: self.range_from(first) };
        }
        Ok(expression)
    }

    /// A number, a name, a function or something in parentheses.
    pub(super) fn primary(&mut self) -> Parsed<Expression> {
        let first = self.position;
        let Some(element) = self.element(0) else { return self.fail(SyntaxErrorKind::EndsOnPunctuation) };
        match element.kind {
            ElementKind::Number => {
                self.bump();
                let value = number_value(&element.text);
                let Some(value) = value else {
                    self.position = first;
                    return self.fail(SyntaxErrorKind::NumberNotConvertible { text: element.text.clone() });
                };
                Ok(Expression::Number { value, range: element.range })
            }
            ElementKind::Name => match self.later_function() {
                Some(function) => self.function_call(function),
                None => Ok(Expression::Reference(self.reference()?)),
            },
            ElementKind::LeftParenthesis => self.parenthesised(),
            ElementKind::Word => self.function_or_word(),
            ElementKind::Plus
            | ElementKind::Minus
            | ElementKind::Star
            | ElementKind::Power
            | ElementKind::Slash => self.fail(SyntaxErrorKind::TwoOperators),
            ElementKind::Relation => self.fail(SyntaxErrorKind::RelationNotAllowed(element.text.clone())),
            ElementKind::Bad => self.fail_at_bad(),
            ElementKind::Comma | ElementKind::RightParenthesis => self.fail(SyntaxErrorKind::OperandMissing),
            ElementKind::Equals | ElementKind::Text => {
                self.fail(SyntaxErrorKind::UnexpectedMark(element.text.clone()))
            }
        }
    }

    fn function_or_word(&mut self) -> Parsed<Expression> {
        let Some(word) = self.word_at(0) else { return self.fail(SyntaxErrorKind::OperandMissing) };
        if word.class != WordClass::Function {
            if self.dialect.words_as_names {
                return Ok(Expression::Reference(self.reference()?));
            }
            if let Some(error) = self.list_without_word(true) {
                return Err(error);
            }
            return self.fail(match word.class {
                WordClass::GeometricType => SyntaxErrorKind::NoSlash(word.spelling.into()),
                _ => SyntaxErrorKind::WordNotAllowed(word.spelling.into()),
            });
        }
        if self.kind(1) != Some(ElementKind::LeftParenthesis) {
            if self.dialect.words_as_names {
                return Ok(Expression::Reference(self.reference()?));
            }
            return self.fail(SyntaxErrorKind::FunctionWithoutParentheses(word.spelling.into()));
        }
        match self.word_at(0) {
            Some(word) => self.function_call(word),
            None => self.fail(SyntaxErrorKind::OperandMissing),
        }
    }

    /// The function of later systems that begins here, where the dialect has them: a name with several arguments can
    /// be no array. With one argument only the evaluator can tell.
    fn later_function(&self) -> Option<&'static Word> {
        if !self.dialect.later_functions || self.kind(1) != Some(ElementKind::LeftParenthesis) {
            return None;
        }
        let word = vocabulary::later_function(&self.element(0)?.text)?;
        self.comma_in_parenthesis(self.position + 1).then_some(word)
    }

    /// `F(a,b)`, at the name of the function.
    fn function_call(&mut self, word: &'static Word) -> Parsed<Expression> {
        let first = self.position;
        let range = self.bump().map(|element| element.range).unwrap_or_default();
        let function = WordUse { word, range };
        self.bump();
        if self.at(ElementKind::RightParenthesis) {
            return self.fail(SyntaxErrorKind::EmptyParentheses);
        }
        let arguments = self.nested(|parser| parser.parameters(ListRules::FUNCTION))?;
        self.close()?;
        self.note(SyntaxKind::FunctionCall, first);
        Ok(Expression::Call { function, arguments, range: self.range_from(first) })
    }

    /// `(e)` or `(A=e)`.
    fn parenthesised(&mut self) -> Parsed<Expression> {
        let first = self.position;
        self.bump();
        if self.at(ElementKind::RightParenthesis) {
            return self.fail(SyntaxErrorKind::EmptyParentheses);
        }
        if self.assignment_follows() {
            let (target, value) = self.nested(Self::target_and_value)?;
            self.close()?;
            self.note(SyntaxKind::NestedAssignment, first);
            return Ok(Expression::Assign { target, value: Box::new(value), range: self.range_from(first) });
        }
        let inner = self.expression()?;
        self.close()?;
        self.note(SyntaxKind::Parenthesised, first);
        Ok(Expression::Parenthesised { inner: Box::new(inner), range: self.range_from(first) })
    }

    /// The closing parenthesis.
    pub(super) fn close(&mut self) -> Parsed<()> {
        if self.eat(ElementKind::RightParenthesis) {
            return Ok(());
        }
        match self.kind(0) {
            None => self.fail(SyntaxErrorKind::UnclosedParenthesis),
            Some(ElementKind::Comma) => match self.list_without_word(false) {
                Some(error) => Err(error),
                None => self.fail(SyntaxErrorKind::UnexpectedMark(",".into())),
            },
            Some(_) => self.fail_after_operand(false),
        }
    }

    /// Whether `name =` or `name(…) =` follows.
    pub(super) fn assignment_follows(&self) -> bool {
        if !self.name_follows() {
            return false;
        }
        let mut ahead = 1;
        if self.kind(1) == Some(ElementKind::LeftParenthesis) {
            let mut depth = 0_u32;
            while let Some(kind) = self.kind(ahead) {
                ahead += 1;
                match kind {
                    ElementKind::LeftParenthesis => depth += 1,
                    ElementKind::RightParenthesis => depth = depth.saturating_sub(1),
                    _ => {}
                }
                if depth == 0 {
                    break;
                }
            }
        }
        self.kind(ahead) == Some(ElementKind::Equals)
    }

    /// Whether a name stands here, or a word that may serve as one.
    pub(super) fn name_follows(&self) -> bool {
        match self.kind(0) {
            Some(ElementKind::Name) => true,
            Some(ElementKind::Word) => self.dialect.words_as_names,
            _ => false,
        }
    }

    /// `target = value`, where the value may be another assignment in some dialects.
    pub(super) fn target_and_value(&mut self) -> Parsed<(Reference, Expression)> {
        let target = self.reference()?;
        if !self.eat(ElementKind::Equals) {
            return self.fail(SyntaxErrorKind::NameWithoutEquals { name: target.name.text, listed: false });
        }
        let value = self.assigned_value()?;
        Ok((target, value))
    }

    /// What stands after `=`.
    pub(super) fn assigned_value(&mut self) -> Parsed<Expression> {
        if !(self.dialect.chained_assignment && self.assignment_follows()) {
            return self.expression();
        }
        let first = self.position;
        let (target, value) = self.nested(Self::target_and_value)?;
        self.note(SyntaxKind::NestedAssignment, first);
        Ok(Expression::Assign { target, value: Box::new(value), range: self.range_from(first) })
    }

    /// A name with its subscript, if it has one.
    pub(super) fn reference(&mut self) -> Parsed<Reference> {
        let first = self.position;
        let name = self.name()?;
        let mut subscript = None;
        if self.at(ElementKind::LeftParenthesis) {
            let open = self.position;
            self.bump();
            if self.at(ElementKind::RightParenthesis) {
                return self.fail(SyntaxErrorKind::EmptyParentheses);
            }
            let value = self.nested(Self::subscript_value)?;
            if self.at(ElementKind::Comma) {
                self.position = first;
                return self.fail(SyntaxErrorKind::UnknownFunction(name.text));
            }
            self.close()?;
            self.note(SyntaxKind::Subscript, open);
            subscript = Some(Box::new(value));
        }
        self.note(SyntaxKind::Reference, first);
        Ok(Reference { name, subscript, range: self.range_from(first) })
    }

    fn subscript_value(&mut self) -> Parsed<Expression> {
        if matches!(self.word_at(0), Some(word) if matches!(word.spelling, "ALL" | "THRU")) {
            return self.fail(SyntaxErrorKind::BadInclusiveSubscript);
        }
        self.assigned_value()
    }

    /// A name.
    pub(super) fn name(&mut self) -> Parsed<Name> {
        if !self.name_follows() {
            return match self.element(0) {
                Some(element) if element.kind == ElementKind::Word => {
                    self.fail(SyntaxErrorKind::WordNotAllowed(element.text.clone()))
                }
                Some(element) if element.kind == ElementKind::Bad => self.fail_at_bad(),
                _ => self.fail(SyntaxErrorKind::OperandMissing),
            };
        }
        match self.bump() {
            Some(element) => Ok(Name { text: element.text.clone(), range: element.range }),
            None => self.fail(SyntaxErrorKind::OperandMissing),
        }
    }
}
