//! Parameters of lists: scalars, words, nested definitions and points, inclusive subscripts.

use super::{Parsed, Parser};
use crate::error::SyntaxErrorKind;
use crate::kind::SyntaxKind;
use crate::statement::{Argument, Definition, ElementKind, Expression, Name, WordUse};
use crate::vocabulary::{Word, WordClass};

/// Where empty positions (two commas in a row) may stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EmptyPositions {
    Never,
    /// After the word CANON.
    AfterCanon,
    Always,
}

/// The major words that take units.
const MAJORS_WITH_UNITS: [&str; 3] = ["UNITS", "FEDRAT", "SPINDL"];

/// What a list of parameters allows.
#[derive(Debug, Clone, Copy)]
pub(super) struct ListRules {
    pub(super) empty: EmptyPositions,
    /// Expressions need no parentheses.
    pub(super) bare_expressions: bool,
    /// The major word whose unit words (MMPM, INCHES) are words although the dialect does not reserve them.
    pub(super) units_of: Option<&'static str>,
}

impl ListRules {
    /// The arguments of a function.
    pub(super) const FUNCTION: ListRules =
        ListRules { empty: EmptyPositions::Never, bare_expressions: true, units_of: None };
    /// The parameters of a definition.
    pub(super) const DEFINITION: ListRules =
        ListRules { empty: EmptyPositions::AfterCanon, bare_expressions: false, units_of: None };
    /// The coordinates of a nested point.
    const POINT: ListRules =
        ListRules { empty: EmptyPositions::Never, bare_expressions: true, units_of: None };
}

impl Parser<'_> {
    /// `param { , param }`, up to the end of the statement or a closing parenthesis.
    pub(super) fn parameters(&mut self, rules: ListRules) -> Parsed<Vec<Argument>> {
        let first = self.position;
        let mut arguments = Vec::new();
        let mut canon = false;
        loop {
            let empty_allowed = self.dialect.empty_parameters
                || match rules.empty {
                    EmptyPositions::Never => false,
                    EmptyPositions::AfterCanon => canon,
                    EmptyPositions::Always => true,
                };
            if self.empty_position(empty_allowed)? {
                arguments.push(Argument::Empty(self.place_before()));
            } else {
                canon |= self.at_word("CANON");
                arguments.push(self.parameter(rules)?);
            }
            if !self.eat(ElementKind::Comma) {
                break;
            }
        }
        if !self.at_end() && !self.at(ElementKind::RightParenthesis) {
            return self.fail_after_operand(true);
        }
        self.note(SyntaxKind::ParameterList, first);
        Ok(arguments)
    }

    /// Whether the position is empty; an error if it must not be.
    fn empty_position(&self, allowed: bool) -> Parsed<bool> {
        match self.kind(0) {
            Some(ElementKind::Comma | ElementKind::RightParenthesis) if allowed => Ok(true),
            Some(ElementKind::Comma | ElementKind::RightParenthesis) => {
                self.fail(SyntaxErrorKind::EmptyPosition)
            }
            None if allowed && self.dialect.empty_parameters => Ok(true),
            None => self.fail(SyntaxErrorKind::EndsOnPunctuation),
            _ => Ok(false),
        }
    }

    /// The empty place before the present element, or after the last one.
    fn place_before(&self) -> rowan::TextRange {
        match self.element(0) {
            Some(element) => rowan::TextRange::empty(element.range.start()),
            None => {
                rowan::TextRange::empty(self.elements.last().map(|last| last.range.end()).unwrap_or_default())
            }
        }
    }

    /// One parameter.
    fn parameter(&mut self, rules: ListRules) -> Parsed<Argument> {
        let first = self.position;
        let argument = match self.kind(0) {
            Some(ElementKind::Text) => self.text_argument()?,
            Some(ElementKind::Word) if !self.word_is_operand() => match self.word_use() {
                Some(word) => Argument::Word(word),
                None => return self.fail(SyntaxErrorKind::WordRequired),
            },
            Some(ElementKind::Name) if self.soft_word_follows(rules) => self.soft_word()?,
            Some(ElementKind::Name) if self.inclusive_follows() => self.inclusive()?,
            Some(ElementKind::LeftParenthesis) => self.parenthesised_argument(rules)?,
            _ => Argument::Expression(self.scalar(rules)?),
        };
        if self.dialect.unknown_majors && self.words_run_on() {
            return self.run_on_text(first);
        }
        Ok(argument)
    }

    /// Whether the word here is an operand: a function with its argument, or a name where words can be names and an
    /// operator follows.
    fn word_is_operand(&self) -> bool {
        let is_function = self.word_at(0).is_some_and(|word| word.class == WordClass::Function);
        let operator_follows = matches!(
            self.kind(1),
            Some(
                ElementKind::Plus
                    | ElementKind::Minus
                    | ElementKind::Star
                    | ElementKind::Slash
                    | ElementKind::Power
            )
        );
        (is_function && self.kind(1) == Some(ElementKind::LeftParenthesis))
            || (self.dialect.words_as_names && operator_follows)
    }

    /// `[sign] (number|name|(e))`, or any expression where the list allows it.
    fn scalar(&mut self, rules: ListRules) -> Parsed<Expression> {
        if rules.bare_expressions || self.dialect.bare_expressions {
            return self.expression();
        }
        let first = self.position;
        if !matches!(self.kind(0), Some(ElementKind::Plus | ElementKind::Minus)) {
            return self.primary();
        }
        let negative = self.at(ElementKind::Minus);
        self.bump();
        let operand = self.primary()?;
        self.note(SyntaxKind::Signed, first);
        Ok(Expression::Sign { negative, operand: Box::new(operand), range: self.range_from(first) })
    }

    /// What stands in parentheses: a definition, a point or an expression.
    fn parenthesised_argument(&mut self, rules: ListRules) -> Parsed<Argument> {
        let first = self.position;
        if self.nested_definition_follows() {
            return self.nested(Self::nested_definition);
        }
        if !self.comma_in_parenthesis(self.position) {
            let operand = self.primary()?;
            if rules.bare_expressions || self.dialect.bare_expressions {
                return Ok(Argument::Expression(self.expression_from(first, operand)?));
            }
            return Ok(Argument::Expression(operand));
        }
        self.bump();
        let coordinates = self.nested(|parser| parser.parameters(ListRules::POINT))?;
        if coordinates.len() > 3
            && let Some(error) = self.list_without_word(false)
        {
            return Err(error);
        }
        self.close()?;
        self.note(SyntaxKind::NestedPoint, first);
        if coordinates.len() > 3 {
            self.position = first;
            return self.fail(SyntaxErrorKind::UnexpectedMark("(".into()));
        }
        Ok(Argument::Point { coordinates, range: self.range_from(first) })
    }

    /// Whether a comma stands inside the parenthesis that opens at an element, on its own level.
    pub(super) fn comma_in_parenthesis(&self, open: usize) -> bool {
        let mut depth = 0_u32;
        for element in self.elements.iter().skip(open) {
            match element.kind {
                ElementKind::LeftParenthesis => depth += 1,
                ElementKind::RightParenthesis if depth <= 1 => return false,
                ElementKind::RightParenthesis => depth -= 1,
                ElementKind::Comma if depth == 1 => return true,
                _ => {}
            }
        }
        false
    }

    /// Whether `(TYPE/` or `(name=TYPE/` follows.
    fn nested_definition_follows(&self) -> bool {
        let type_at = |ahead: usize| {
            self.word_at(ahead).is_some_and(|word| word.class == WordClass::GeometricType)
                && (self.kind(ahead + 1) == Some(ElementKind::Slash) || !self.dialect.words_as_names)
        };
        if type_at(1) {
            return true;
        }
        // `name=` or `name(…)=`, then the type.
        if self.kind(1) != Some(ElementKind::Name) {
            return false;
        }
        let mut depth = 0_u32;
        for (ahead, element) in self.elements.iter().skip(self.position).enumerate().skip(2) {
            match element.kind {
                ElementKind::LeftParenthesis => depth += 1,
                ElementKind::RightParenthesis if depth == 0 => return false,
                ElementKind::RightParenthesis => depth -= 1,
                ElementKind::Equals if depth == 0 => return type_at(ahead + 1),
                _ if depth == 0 => return false,
                _ => {}
            }
        }
        false
    }

    /// `([name=]TYPE/…)`
    fn nested_definition(&mut self) -> Parsed<Argument> {
        let first = self.position;
        self.bump();
        let target = if self.kind(0) == Some(ElementKind::Name) {
            let target = self.reference()?;
            self.eat(ElementKind::Equals);
            Some(target)
        } else {
            None
        };
        let definition = self.definition_body()?;
        self.close()?;
        self.note(SyntaxKind::Nested, first);
        Ok(Argument::Nested { target, definition, range: self.range_from(first) })
    }

    /// `TYPE/parameters`
    pub(super) fn definition_body(&mut self) -> Parsed<Definition> {
        let first = self.position;
        let Some(kind) = self.word_use() else { return self.fail(SyntaxErrorKind::WordRequired) };
        if !self.eat(ElementKind::Slash) {
            self.position = first;
            return self.fail(SyntaxErrorKind::NoSlash(kind.word.spelling.into()));
        }
        if self.at_end() || self.at(ElementKind::RightParenthesis) {
            return self.fail(SyntaxErrorKind::MissingParameters);
        }
        let arguments = self.parameters(ListRules::DEFINITION)?;
        self.note(SyntaxKind::DefinitionBody, first);
        Ok(Definition { kind, arguments, range: self.range_from(first) })
    }

    // Inclusive subscripts.

    /// Whether the name here has a parenthesis with THRU, ALL, INCR or DECR on its own level.
    fn inclusive_follows(&self) -> bool {
        if self.kind(1) != Some(ElementKind::LeftParenthesis) {
            return false;
        }
        let mut depth = 0_u32;
        for (ahead, element) in self.elements.iter().skip(self.position).enumerate().skip(1) {
            match element.kind {
                ElementKind::LeftParenthesis => depth += 1,
                ElementKind::RightParenthesis if depth <= 1 => return false,
                ElementKind::RightParenthesis => depth -= 1,
                ElementKind::Word if depth == 1 => {
                    let bound = |word: &Word| matches!(word.spelling, "ALL" | "THRU" | "INCR" | "DECR");
                    if self.word_at(ahead).is_some_and(bound) {
                        return true;
                    }
                }
                _ => {}
            }
        }
        false
    }

    /// `name([a,]THRU,(b|ALL)[,(INCR|DECR),c])` or `name(ALL[,(INCR|DECR),c])`
    fn inclusive(&mut self) -> Parsed<Argument> {
        let first = self.position;
        let Some(element) = self.bump() else { return self.fail(SyntaxErrorKind::BadInclusiveSubscript) };
        let name = Name { text: element.text.clone(), range: element.range };
        self.bump();
        let (low, high, step) = self.nested(Self::inclusive_bounds)?;
        if !self.eat(ElementKind::RightParenthesis) {
            return self.fail(SyntaxErrorKind::BadInclusiveSubscript);
        }
        self.note(SyntaxKind::Inclusive, first);
        Ok(Argument::Inclusive { name, first: low, last: high, step, range: self.range_from(first) })
    }

    #[expect(clippy::type_complexity, reason = "the three parts of an inclusive subscript, used at once")]
    fn inclusive_bounds(
        &mut self,
    ) -> Parsed<(Option<Expression>, Option<Expression>, Option<(bool, Expression)>)> {
        let mut low = None;
        let mut high = None;
        if !self.at_word("ALL") {
            if !self.at_word("THRU") {
                low = Some(self.scalar(ListRules::FUNCTION)?);
                self.inclusive_comma()?;
            }
            if !self.at_word("THRU") {
                return self.fail(SyntaxErrorKind::BadInclusiveSubscript);
            }
            self.bump();
            self.inclusive_comma()?;
        }
        if self.at_word("ALL") {
            self.bump();
        } else {
            high = Some(self.scalar(ListRules::FUNCTION)?);
        }
        let mut step = None;
        if self.eat(ElementKind::Comma) {
            let up = self.at_word("INCR");
            if !up && !self.at_word("DECR") {
                return self.fail(SyntaxErrorKind::BadInclusiveSubscript);
            }
            self.bump();
            self.inclusive_comma()?;
            step = Some((up, self.scalar(ListRules::FUNCTION)?));
        }
        Ok((low, high, step))
    }

    fn inclusive_comma(&mut self) -> Parsed<()> {
        if self.eat(ElementKind::Comma) { Ok(()) } else { self.fail(SyntaxErrorKind::BadInclusiveSubscript) }
    }

    // What only CL files and post-processor statements have.

    fn text_argument(&mut self) -> Parsed<Argument> {
        match self.bump() {
            Some(element) => Ok(Argument::Text { text: element.text.clone(), range: element.range }),
            None => self.fail(SyntaxErrorKind::OperandMissing),
        }
    }

    /// Whether the name here is a unit that later systems write with this major word. Other words of later systems may
    /// as well be names of the program (`CYCLE/DRILL,DEPTH`); only the evaluator knows.
    fn soft_word_follows(&self, rules: ListRules) -> bool {
        let Some(major) = rules.units_of.filter(|major| MAJORS_WITH_UNITS.contains(major)) else {
            return false;
        };
        let stands_alone = matches!(self.kind(1), None | Some(ElementKind::Comma));
        stands_alone
            && self
                .element(0)
                .and_then(|element| crate::vocabulary::lookup(&element.text))
                .is_some_and(|word| word.class == WordClass::Minor && word.used_in.contains(&major))
    }

    fn soft_word(&mut self) -> Parsed<Argument> {
        match self.bump().and_then(|element| Some((crate::vocabulary::lookup(&element.text)?, element.range)))
        {
            Some((word, range)) => Ok(Argument::Word(WordUse { word, range })),
            None => self.fail(SyntaxErrorKind::WordRequired),
        }
    }

    /// Whether words follow each other with nothing but blanks between them, as in names that CAM systems write.
    fn words_run_on(&self) -> bool {
        let is_wordlike = |kind| {
            matches!(
                kind,
                Some(ElementKind::Name | ElementKind::Word | ElementKind::Number | ElementKind::Minus)
            )
        };
        let before = self.position.checked_sub(1).and_then(|before| self.elements.get(before));
        is_wordlike(before.map(|element| element.kind)) && is_wordlike(self.kind(0))
    }

    /// Free text as a parameter: words up to the next comma, one blank between them.
    fn run_on_text(&mut self, first: usize) -> Parsed<Argument> {
        while !matches!(self.kind(0), None | Some(ElementKind::Comma | ElementKind::RightParenthesis)) {
            self.bump();
        }
        let words = self.elements.get(first..self.position).unwrap_or_default();
        let words: Vec<&str> = words.iter().map(|element| element.text.as_str()).collect();
        Ok(Argument::Text { text: words.join(" ").into(), range: self.range_from(first) })
    }
}
