//! Macros, branches and loops (language reference 7.1, 7.2 and 10.4).

use rowan::TextRange;
use smol_str::SmolStr;

use super::{Parsed, Parser};
use crate::error::SyntaxErrorKind;
use crate::kind::SyntaxKind;
use crate::statement::{
    Body, Clause, Condition, Element, ElementKind, Expression, MacroParameter, Name, Part, RelationOperator,
    WordUse,
};

type Production = (Body, SyntaxKind);

impl Parser<'_> {
    // Macros.

    /// `MACRO[/v1[=value],…]` after `name=`
    pub(super) fn macro_header(&mut self, name: Name) -> Parsed<Production> {
        let Some(word) = self.word_use() else { return self.fail(SyntaxErrorKind::MacroForm) };
        let mut parameters = Vec::new();
        if !self.at_end() && !self.eat(ElementKind::Slash) {
            return self.fail(SyntaxErrorKind::MacroForm);
        }
        while !self.at_end() {
            parameters.push(self.macro_variable()?);
            if self.at_end() {
                break;
            }
            if !self.eat(ElementKind::Comma) {
                return self.fail(SyntaxErrorKind::MissingSeparator);
            }
            if self.at_end() {
                return self.fail(SyntaxErrorKind::EndsOnPunctuation);
            }
        }
        Ok((Body::Macro { name, word, parameters }, SyntaxKind::MacroHeader))
    }

    /// `name[=value]`
    fn macro_variable(&mut self) -> Parsed<MacroParameter> {
        let first = self.position;
        if !self.name_follows() {
            return self.fail(SyntaxErrorKind::MacroVariableNotName);
        }
        let name = self.name()?;
        let value = if self.eat(ElementKind::Equals) { Some(self.macro_value()?) } else { None };
        self.note(SyntaxKind::MacroParameter, first);
        Ok(MacroParameter { name, value, range: self.range_from(first) })
    }

    /// The elements up to the next comma that is in no parenthesis.
    fn macro_value(&mut self) -> Parsed<Vec<Element>> {
        let first = self.position;
        let mut depth = 0_u32;
        while let Some(kind) = self.kind(0) {
            match kind {
                ElementKind::Comma if depth == 0 => break,
                ElementKind::LeftParenthesis => depth += 1,
                ElementKind::RightParenthesis => depth = depth.saturating_sub(1),
                ElementKind::Equals if depth == 0 => {
                    return self.fail(SyntaxErrorKind::UnexpectedMark("=".into()));
                }
                ElementKind::Bad => return self.fail_at_bad(),
                _ => {}
            }
            self.bump();
        }
        let value = self.elements.get(first..self.position).unwrap_or_default().to_vec();
        self.check_macro_value(first, &value)?;
        Ok(value)
    }

    /// `[sign] number`, a name or a word; anything else only where the dialect has it.
    fn check_macro_value(&mut self, first: usize, value: &[Element]) -> Parsed<()> {
        let is_operand = |kind| matches!(kind, ElementKind::Number | ElementKind::Name | ElementKind::Word);
        let fault = match value {
            [] => Some(SyntaxErrorKind::MacroValueMissing),
            [single] if is_operand(single.kind) => None,
            [sign, number]
                if matches!(sign.kind, ElementKind::Plus | ElementKind::Minus)
                    && number.kind == ElementKind::Number =>
            {
                None
            }
            _ if self.dialect.macro_value_expressions => None,
            [_] => Some(SyntaxErrorKind::MacroValueMissing),
            [name, open, ..]
                if name.kind == ElementKind::Name && open.kind == ElementKind::LeftParenthesis =>
            {
                // APT III looks for a comma after the name.
                Some(SyntaxErrorKind::CallCommaExpected)
            }
            [open, ..]
                if open.kind == ElementKind::LeftParenthesis
                    && value.iter().any(|part| part.kind == ElementKind::Slash) =>
            {
                Some(SyntaxErrorKind::MacroValueNested)
            }
            _ => Some(SyntaxErrorKind::MacroValueExpression),
        };
        match fault {
            None => Ok(()),
            Some(kind) => {
                self.position = if value.is_empty() { self.position } else { first };
                self.fail(kind)
            }
        }
    }

    /// `CALL/name[,SEC1|,SEC2][,variable=value]…`
    pub(super) fn call(&mut self) -> Parsed<Production> {
        let Some(word) = self.word_use() else { return self.fail(SyntaxErrorKind::WordRequired) };
        if !self.eat(ElementKind::Slash) {
            return self.fail(SyntaxErrorKind::CallWithoutSlash);
        }
        if !self.name_follows() {
            return self.fail(SyntaxErrorKind::CallNameExpected);
        }
        let name = self.name()?;
        let mut section = None;
        let mut arguments = Vec::new();
        while !self.at_end() {
            if !self.eat(ElementKind::Comma) {
                return self.fail(SyntaxErrorKind::CallCommaExpected);
            }
            if self.at_end() {
                return self.fail(SyntaxErrorKind::EndsOnPunctuation);
            }
            if section.is_none() && arguments.is_empty() && (self.at_word("SEC1") || self.at_word("SEC2")) {
                section = self.word_use();
                continue;
            }
            arguments.push(self.call_argument(section.is_some())?);
        }
        Ok((Body::Call { word, name, arguments, section }, SyntaxKind::Call))
    }

    /// `variable=value`; installation routines also take values without a variable, whose name is empty then.
    fn call_argument(&mut self, positional: bool) -> Parsed<MacroParameter> {
        let first = self.position;
        if self.name_follows() && self.kind(1) == Some(ElementKind::Equals) {
            return self.macro_variable();
        }
        if !positional {
            let name = self.element(0).map(|element| element.text.clone()).unwrap_or_default();
            return self.fail(match self.kind(0) {
                Some(ElementKind::Name) => SyntaxErrorKind::CallValueExpected { name },
                _ => SyntaxErrorKind::MacroVariableNotName,
            });
        }
        let start = self.element(0).map(|element| element.range.start()).unwrap_or_default();
        let value = self.macro_value()?;
        let name = Name { text: SmolStr::default(), range: TextRange::empty(start) };
        self.note(SyntaxKind::MacroParameter, first);
        Ok(MacroParameter { name, value: Some(value), range: self.range_from(first) })
    }

    // Branches.

    /// `JUMPTO/id` and `TRANTO/id`
    pub(super) fn jump(&mut self) -> Parsed<Production> {
        let Some(word) = self.word_use() else { return self.fail(SyntaxErrorKind::WordRequired) };
        self.slash_behind(&word)?;
        let label = self.label_name()?;
        if !self.at_end() {
            return self.fail(SyntaxErrorKind::LabelCount { found: self.labels_in_rest(1), expected: 1 });
        }
        Ok((Body::Jump { word, label }, SyntaxKind::Jump))
    }

    /// The slash behind the word of a statement.
    fn slash_behind(&mut self, word: &WordUse) -> Parsed<()> {
        if self.eat(ElementKind::Slash) {
            return Ok(());
        }
        let word = SmolStr::from(word.word.spelling);
        self.fail(SyntaxErrorKind::SlashMissing { statement: word.clone(), word })
    }

    /// A label where it is used: a name or digits.
    fn label_name(&mut self) -> Parsed<Name> {
        let Some(element) = self.element(0) else { return self.fail(SyntaxErrorKind::LabelMissing) };
        let is_label = match element.kind {
            ElementKind::Name => true,
            ElementKind::Number => element.text.bytes().all(|byte| byte.is_ascii_digit()),
            ElementKind::Word => self.dialect.words_as_names,
            ElementKind::Bad => return self.fail_at_bad(),
            _ => false,
        };
        if !is_label {
            return self.fail(SyntaxErrorKind::LabelMissing);
        }
        self.bump();
        Ok(Name { text: element.text.clone(), range: element.range })
    }

    /// How many labels there seem to be: those read and one after each comma that follows.
    fn labels_in_rest(&self, read: u32) -> u32 {
        let rest = self.elements.get(self.position..).unwrap_or_default();
        let commas = rest.iter().filter(|element| element.kind == ElementKind::Comma).count();
        read.saturating_add(u32::try_from(commas).unwrap_or(u32::MAX))
    }

    /// `IF(e)a,b,c` or `IF(condition)statement`
    pub(super) fn branch(&mut self) -> Parsed<Production> {
        let Some(word) = self.word_use() else { return self.fail(SyntaxErrorKind::WordRequired) };
        if !self.at(ElementKind::LeftParenthesis) {
            return self.fail(SyntaxErrorKind::ConditionMissing);
        }
        let relation = self.relation_in_parenthesis(self.position);
        if relation
            && !self.dialect.logical_if
            && let Some(word) = self.elements.last().filter(|last| last.text == "THEN")
        {
            self.position = self.elements.len().saturating_sub(1);
            return self.fail(SyntaxErrorKind::StructuredIf { word: word.text.clone() });
        }
        let several = self.dialect.structured_if && self.ends_on_then();
        let logical = self.dialect.logical_if && (relation || several);
        self.bump();
        if self.at(ElementKind::RightParenthesis) {
            return self.fail(SyntaxErrorKind::ConditionMissing);
        }
        if logical {
            let condition = self.condition()?;
            self.close()?;
            if several && self.at_word("THEN") {
                self.bump();
                return Ok((Body::Clause { word, clause: Clause::If(condition) }, SyntaxKind::If));
            }
            if self.dialect.structured_if && self.at_end() {
                return self.fail(SyntaxErrorKind::ThenMissing { word: word.word.spelling.into() });
            }
            self.refuse_clause()?;
            if self.at_word("DO") && self.kind(1) == Some(ElementKind::Slash) {
                // The statements of the loop would stand outside of the condition.
                return self.fail(SyntaxErrorKind::ConditionalDo);
            }
            let then = self.nested(Self::conditional_parts)?;
            return Ok((Body::LogicalIf { word, condition, then }, SyntaxKind::If));
        }
        let condition = self.expression()?;
        self.close()?;
        let labels = self.three_labels()?;
        Ok((Body::ArithmeticIf { word, condition, labels }, SyntaxKind::If))
    }

    /// The statement of a logical IF, with the words that it may begin with as any statement may: `TLRGT,GORGT/L1,PAST,L2`.
    fn conditional_parts(&mut self) -> Parsed<Vec<Part>> {
        let mut parts = Vec::new();
        loop {
            let part = self.part()?;
            let joins = part.joins_another();
            self.refuse_second_position(&parts, &part);
            parts.push(part);
            if self.at_end() {
                return Ok(parts);
            }
            let follows = joins && self.eat(ElementKind::Comma);
            if !follows || (self.word_at(0).is_none() && !self.soft_major_follows()) {
                return self.fail(SyntaxErrorKind::LogicalIfStatement);
            }
        }
    }

    /// An IF over several statements cannot be the statement of a logical IF.
    fn refuse_clause(&self) -> Parsed<()> {
        let ends = self.elements.last().is_some_and(|last| last.text == "THEN");
        if self.dialect.structured_if && self.at_word("IF") && ends {
            return self.fail(SyntaxErrorKind::ConditionalClause { word: "IF".into() });
        }
        Ok(())
    }

    /// Whether the last element is the word THEN.
    fn ends_on_then(&self) -> bool {
        self.elements.last().is_some_and(|last| last.kind == ElementKind::Word && last.text == "THEN")
    }

    /// `ELSEIF(condition)THEN`
    pub(super) fn else_if(&mut self) -> Parsed<Production> {
        let Some(word) = self.word_use() else { return self.fail(SyntaxErrorKind::WordRequired) };
        if !self.eat(ElementKind::LeftParenthesis) || self.at(ElementKind::RightParenthesis) {
            return self.fail(SyntaxErrorKind::ConditionMissing);
        }
        let condition = self.condition()?;
        self.close()?;
        if !self.at_word("THEN") {
            return self.fail(SyntaxErrorKind::ThenMissing { word: word.word.spelling.into() });
        }
        self.bump();
        Ok((Body::Clause { word, clause: Clause::ElseIf(condition) }, SyntaxKind::If))
    }

    /// `ELSE` and `ENDIF`
    pub(super) fn bare_clause(&mut self, clause: Clause) -> Parsed<Production> {
        let Some(word) = self.word_use() else { return self.fail(SyntaxErrorKind::WordRequired) };
        if !self.at_end() {
            return self.fail(SyntaxErrorKind::RunsOnAfterWord { word: word.word.spelling.into() });
        }
        Ok((Body::Clause { word, clause }, SyntaxKind::If))
    }

    fn three_labels(&mut self) -> Parsed<[Name; 3]> {
        let mut labels = Vec::with_capacity(3);
        while labels.len() < 3 {
            labels.push(self.label_name()?);
            if labels.len() < 3 && !self.eat(ElementKind::Comma) {
                break;
            }
        }
        let found = u32::try_from(labels.len()).unwrap_or(u32::MAX);
        match <[Name; 3]>::try_from(labels) {
            Ok(labels) if self.at_end() => Ok(labels),
            _ => self.fail(SyntaxErrorKind::LabelCount { found: self.labels_in_rest(found), expected: 3 }),
        }
    }

    /// Whether a relation stands in the parenthesis that opens at an element.
    fn relation_in_parenthesis(&self, open: usize) -> bool {
        let mut depth = 0_u32;
        for element in self.elements.iter().skip(open) {
            match element.kind {
                ElementKind::LeftParenthesis => depth += 1,
                ElementKind::RightParenthesis if depth <= 1 => return false,
                ElementKind::RightParenthesis => depth -= 1,
                ElementKind::Relation => return true,
                _ => {}
            }
        }
        false
    }

    /// `conjunction { .OR. conjunction }`
    fn condition(&mut self) -> Parsed<Condition> {
        self.nested(|parser| {
            let first = parser.position;
            let mut left = parser.conjunction()?;
            while parser.eat_relation(".OR.") {
                parser.count_operator()?;
                let right = parser.conjunction()?;
                left = Condition::Or(Box::new(left), Box::new(right));
            }
            parser.note(SyntaxKind::Condition, first);
            Ok(left)
        })
    }

    /// `part { .AND. part }`
    fn conjunction(&mut self) -> Parsed<Condition> {
        let mut left = self.condition_part()?;
        while self.eat_relation(".AND.") {
            self.count_operator()?;
            let right = self.condition_part()?;
            left = Condition::And(Box::new(left), Box::new(right));
        }
        Ok(left)
    }

    /// `.NOT.` part, `(condition)` or a relation. APT4 has no `.NOT.` (language reference 10.4).
    fn condition_part(&mut self) -> Parsed<Condition> {
        if self.dialect.logical_not && self.eat_relation(".NOT.") {
            self.count_operator()?;
            let inner = self.nested(Self::condition_part)?;
            return Ok(Condition::Not(Box::new(inner)));
        }
        if self.at(ElementKind::LeftParenthesis) && self.relation_in_parenthesis(self.position) {
            self.bump();
            let condition = self.condition()?;
            self.close()?;
            return Ok(condition);
        }
        self.relation()
    }

    /// `expression relation expression`
    fn relation(&mut self) -> Parsed<Condition> {
        let left = self.expression()?;
        let operator =
            self.element(0).filter(|element| element.kind == ElementKind::Relation).and_then(|element| {
                Some(match element.text.as_str() {
                    ".EQ." => RelationOperator::Eq,
                    ".NE." => RelationOperator::Ne,
                    ".LT." => RelationOperator::Lt,
                    ".LE." => RelationOperator::Le,
                    ".GT." => RelationOperator::Gt,
                    ".GE." => RelationOperator::Ge,
                    _ => return None,
                })
            });
        let Some(operator) = operator else { return self.fail(SyntaxErrorKind::RelationMissing) };
        self.bump();
        let right = self.expression()?;
        Ok(Condition::Relation { operator, left, right })
    }

    fn eat_relation(&mut self, spelling: &str) -> bool {
        let found =
            self.at(ElementKind::Relation) && self.element(0).is_some_and(|element| element.text == spelling);
        self.position += usize::from(found);
        found
    }

    // Loops.

    /// `DO/label,i=first,last[,step]`
    pub(super) fn do_loop(&mut self) -> Parsed<Production> {
        let Some(word) = self.word_use() else { return self.fail(SyntaxErrorKind::WordRequired) };
        self.slash_behind(&word)?;
        let label = self.label_name()?;
        if !self.eat(ElementKind::Comma) {
            return self.fail(SyntaxErrorKind::DoForm);
        }
        let index = self.reference()?;
        if !self.eat(ElementKind::Equals) {
            return self.fail(SyntaxErrorKind::DoForm);
        }
        let mut bounds: Vec<Expression> = vec![self.expression()?];
        while bounds.len() < 3 && self.eat(ElementKind::Comma) {
            bounds.push(self.expression()?);
        }
        if bounds.len() < 2 || !self.at_end() {
            return self.fail(SyntaxErrorKind::DoForm);
        }
        Ok((Body::Do { word, label, index, bounds }, SyntaxKind::Do))
    }
}
