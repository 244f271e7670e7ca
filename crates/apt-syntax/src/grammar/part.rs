//! Statements and their parts (language reference 2.1, 2.2 and 2.4).

use rowan::TextRange;
use smol_str::SmolStr;

use super::argument::{EmptyPositions, ListRules};
use super::{MAXIMUM_DEPTH, Parsed, Parser};
use crate::dialect::SequenceFieldRule;
use crate::error::{SyntaxError, SyntaxErrorKind};
use crate::kind::SyntaxKind;
use crate::record::DISPLAY_WORD;
use crate::statement::{
    Body, Clause, Definition, Element, ElementKind, MacroParameter, Name, Part, Statement, WordUse,
};
use crate::vocabulary::{self, Word, WordClass};

/// A body and the kind of its node.
type Production = (Body, SyntaxKind);

/// The words of an IF over several statements, which NCL has.
pub(super) const STRUCTURED_IF_WORDS: [&str; 4] = ["THEN", "ELSE", "ELSEIF", "ENDIF"];

impl Parser<'_> {
    /// The whole statement. Errors are noted; the statement part in which one lies becomes [`Body::Error`], or
    /// where it begins a macro a [`Body::Macro`] whose name is [spoiled](super::ParsedStatement::spoiled).
    pub(super) fn statement(&mut self) -> Statement {
        if self.elements.is_empty() {
            return Statement { label: None, parts: Vec::new() };
        }
        if let Some(statement) = self.text_statement() {
            return statement;
        }
        let mut parts = Vec::new();
        let label = match self.label().and_then(|label| self.check_whole().map(|()| label)) {
            Ok(label) => label,
            Err(error) => {
                self.give_up(self.position, error, &mut parts);
                return Statement { label: None, parts };
            }
        };
        loop {
            let first = self.position;
            match self.part_and_separator() {
                Ok((part, more)) => {
                    self.refuse_second_position(&parts, &part);
                    parts.push(part);
                    if !more {
                        self.count_nests();
                        break;
                    }
                }
                Err(error) => {
                    self.give_up(first, error, &mut parts);
                    break;
                }
            }
        }
        Statement { label, parts }
    }

    /// Tells of more nested definitions and points than the dialect takes.
    fn count_nests(&mut self) {
        let Some(limit) = self.dialect.statement_nests else { return };
        let is_nest = |kind| matches!(kind, SyntaxKind::Nested | SyntaxKind::NestedPoint);
        let nests = self.nodes.iter().filter(|node| is_nest(node.kind));
        let count = u32::try_from(nests.count()).unwrap_or(u32::MAX);
        if count > limit {
            let range = self.range_from(0);
            self.errors.push(SyntaxError::new(SyntaxErrorKind::TooManyNests { count, limit }, range));
        }
    }

    /// Notes the error and makes the rest of the statement, from `first` on, a part that says nothing.
    fn give_up(&mut self, first: usize, error: SyntaxError, parts: &mut Vec<Part>) {
        // A bad element makes the rest hard to read: what is said of that would be noise.
        let bad =
            self.elements.iter().any(|element| element.kind == ElementKind::Bad) && !self.errors.is_empty();
        if !bad && !self.errors.contains(&error) {
            self.errors.push(error);
        }
        self.spoiled = self.spoiled.take().or_else(|| self.defined_name(first));
        self.position = self.elements.len();
        self.nodes.retain(|node| node.end as usize <= self.elements.len());
        self.note(SyntaxKind::Error, first);
        let body = self.spoiled_header(first).unwrap_or(Body::Error);
        parts.push(Part { range: self.range_from(first), body });
    }

    /// The header of a macro that begins at an element and has a mistake: what follows up to TERMAC is its text all the
    /// same, and would make no sense where it stands.
    fn spoiled_header(&self, first: usize) -> Option<Body> {
        let name = self.defined_name(first)?;
        let word = self.elements.get(first + 2).filter(|element| element.kind == ElementKind::Word)?;
        let entry = self.dialect.word(&word.text).filter(|entry| entry.spelling == "MACRO")?;
        let variable = |pair: &[Element]| match pair {
            [before, name]
                if matches!(before.kind, ElementKind::Slash | ElementKind::Comma)
                    && name.kind == ElementKind::Name =>
            {
                let text = name.text.clone();
                let name = Name { text, range: name.range };
                Some(MacroParameter { range: name.range, name, value: None })
            }
            _ => None,
        };
        let rest = self.elements.get(first + 3..).unwrap_or_default();
        let parameters = rest.windows(2).filter_map(variable).collect();
        Some(Body::Macro { name, word: WordUse { word: entry, range: word.range }, parameters })
    }

    /// The name that a part beginning at an element assigns to.
    fn defined_name(&self, first: usize) -> Option<Name> {
        let element = self.elements.get(first).filter(|element| element.kind == ElementKind::Name)?;
        let equals = self.elements.get(first + 1).is_some_and(|next| next.kind == ElementKind::Equals);
        equals.then(|| Name { text: element.text.clone(), range: element.range })
    }

    /// PARTNO and its kin: the lexer leaves a word and its text.
    fn text_statement(&mut self) -> Option<Statement> {
        // DISPLY has a text in CL files, where it is no switch.
        let is_displayed = self.elements.get(1).is_some_and(|text| text.kind == ElementKind::Text);
        let is_text = |class, spelling| class == WordClass::Text || spelling == DISPLAY_WORD && is_displayed;
        let word = self.word_at(0).filter(|word| is_text(word.class, word.spelling))?;
        let range = self.element(0)?.range;
        let text = match self.elements.get(1) {
            None => Element {
                kind: ElementKind::Text,
                text: SmolStr::default(),
                range: TextRange::empty(range.end()),
            },
            Some(text) if text.kind == ElementKind::Text && self.elements.len() == 2 => text.clone(),
            Some(_) => return None,
        };
        self.position = self.elements.len();
        self.note(SyntaxKind::TextStatement, 0);
        let body = Body::Text { word: WordUse { word, range }, text: text.text, range: text.range };
        Some(Statement { label: None, parts: vec![Part { range: self.range_from(0), body }] })
    }

    /// `label)`
    fn label(&mut self) -> Parsed<Option<Name>> {
        if self.kind(1) != Some(ElementKind::RightParenthesis) {
            return Ok(None);
        }
        let Some(element) = self.element(0) else { return Ok(None) };
        let digits = element.text.bytes().all(|byte| byte.is_ascii_digit());
        match element.kind {
            ElementKind::Name => {}
            ElementKind::Number if digits => {}
            ElementKind::Word if self.dialect.words_as_names => {}
            ElementKind::Word => return self.fail(SyntaxErrorKind::WordAsLabel(element.text.clone())),
            _ => return Ok(None),
        }
        let first = self.position;
        self.bump();
        self.bump();
        self.note(SyntaxKind::Label, first);
        if self.at_end() {
            return self.fail(SyntaxErrorKind::LabelWithoutStatement);
        }
        Ok(Some(Name { text: element.text.clone(), range: element.range }))
    }

    /// What can be said of all the elements at once: their number, the balance of parentheses, the last element.
    fn check_whole(&mut self) -> Parsed<()> {
        let count = u32::try_from(self.elements.len()).unwrap_or(u32::MAX);
        if let Some(limit) = self.dialect.statement_elements.filter(|limit| count > *limit) {
            let kind = SyntaxErrorKind::TooManyElements { count, limit };
            self.errors.push(SyntaxError::new(
                kind,
                self.elements.last().map(|last| last.range).unwrap_or_default(),
            ));
        }
        let mut open: Vec<TextRange> = Vec::new();
        for element in self.elements.iter().skip(self.position) {
            match element.kind {
                ElementKind::LeftParenthesis if open.len() >= usize::from(MAXIMUM_DEPTH) => {
                    return Err(SyntaxError::new(SyntaxErrorKind::TooDeep, element.range));
                }
                ElementKind::LeftParenthesis => open.push(element.range),
                ElementKind::RightParenthesis if open.pop().is_none() => {
                    return Err(SyntaxError::new(SyntaxErrorKind::UnopenedParenthesis, element.range));
                }
                _ => {}
            }
        }
        match open.pop() {
            Some(range) => Err(SyntaxError::new(SyntaxErrorKind::UnclosedParenthesis, range)),
            None => Ok(()),
        }
    }

    /// A part and, if it can have a successor, the comma after it.
    fn part_and_separator(&mut self) -> Parsed<(Part, bool)> {
        let part = self.part()?;
        if self.at_end() {
            return Ok((part, false));
        }
        if !(part.joins_another() && self.at(ElementKind::Comma)) {
            return self.fail_after_part(&part.body);
        }
        self.bump();
        if self.at_end() {
            return self.fail(SyntaxErrorKind::EndsOnPunctuation);
        }
        if self.word_at(0).is_none() && !self.soft_major_follows() {
            return self.fail(SyntaxErrorKind::WordRequired);
        }
        Ok((part, true))
    }

    /// Tells of a word that says where the tool is after another one has: a statement takes one for the drive surface and
    /// one for the part surface.
    pub(super) fn refuse_second_position(&mut self, before: &[Part], part: &Part) {
        let Some((second, of_drive)) = tool_position(part) else { return };
        let same = |(word, drive): &(&WordUse, bool)| (*drive == of_drive).then_some(word.word.spelling);
        let Some(first) = before.iter().filter_map(tool_position).find_map(|one| same(&one)) else { return };
        let kind = SyntaxErrorKind::ToolPositionTwice {
            first: SmolStr::new_static(first),
            second: SmolStr::new_static(second.word.spelling),
        };
        self.errors.push(SyntaxError::new(kind, second.range));
    }

    fn fail_after_part<T>(&self, body: &Body) -> Parsed<T> {
        match body {
            Body::Major { word, slash: false, .. } if !self.at(ElementKind::RightParenthesis) => {
                match self.kind(0) {
                    Some(ElementKind::Bad) => self.fail_at_bad(),
                    Some(ElementKind::Slash) => {
                        self.fail(SyntaxErrorKind::TakesNoParameters(word.word.spelling.into()))
                    }
                    _ => self.fail(SyntaxErrorKind::UnexpectedMark(self.spelling())),
                }
            }
            Body::Assignment { .. } if self.at(ElementKind::Equals) => {
                self.fail(SyntaxErrorKind::UnexpectedMark("=".into()))
            }
            _ => self.fail_after_operand(false),
        }
    }

    fn spelling(&self) -> SmolStr {
        self.element(0).map(|element| element.text.clone()).unwrap_or_default()
    }

    /// One part of a statement.
    pub(super) fn part(&mut self) -> Parsed<Part> {
        let first = self.position;
        let (body, kind) = self.body()?;
        self.note(kind, first);
        Ok(Part { range: self.range_from(first), body })
    }

    fn body(&mut self) -> Parsed<Production> {
        if self.assignment_follows() {
            return self.assignment();
        }
        if let Some(word) = self.word_at(0) {
            return self.word_statement(word);
        }
        match self.kind(0) {
            Some(ElementKind::Name) => self.name_statement(),
            Some(ElementKind::Number | ElementKind::Plus | ElementKind::Minus)
                if self.dialect.implicit_goto =>
            {
                self.implicit_goto()
            }
            Some(ElementKind::Bad) => self.fail_at_bad(),
            None => self.fail(SyntaxErrorKind::EndsOnPunctuation),
            Some(_) => self.fail(SyntaxErrorKind::BadStatementStart),
        }
    }

    /// A statement that begins with a word.
    fn word_statement(&mut self, word: &'static Word) -> Parsed<Production> {
        if self.kind(1) == Some(ElementKind::Equals) {
            return self.fail(match word.spelling {
                "IF" => SyntaxErrorKind::ConditionMissing,
                _ => SyntaxErrorKind::NoSlash(word.spelling.into()),
            });
        }
        match word.spelling {
            "IF" => self.branch(),
            "ELSEIF" => self.else_if(),
            "ELSE" => self.bare_clause(Clause::Else),
            "ENDIF" => self.bare_clause(Clause::End),
            "DO" => self.do_loop(),
            "CALL" => self.call(),
            "JUMPTO" | "TRANTO" => self.jump(),
            "OBTAIN" => self.obtain(),
            "MACRO" => self.fail(SyntaxErrorKind::MacroForm),
            "FINI" if self.elements.len() > self.position + 1 => {
                self.bump();
                self.fail(SyntaxErrorKind::FiniNotAlone)
            }
            // SEC1 and SEC2 are system flags that only follow other words.
            "SEC1" | "SEC2" => self.fail(SyntaxErrorKind::WordNotAllowed(word.spelling.into())),
            _ if word.class.begins_statements() || self.dialect.unknown_majors => self.major(),
            _ => self.fail(SyntaxErrorKind::WordNotAllowed(word.spelling.into())),
        }
    }

    /// A statement that begins with a name but is no assignment.
    fn name_statement(&mut self) -> Parsed<Production> {
        if self.soft_major_follows() {
            return self.soft_major();
        }
        if self.kind(1) == Some(ElementKind::Slash)
            && self.word_at(2).is_some_and(|word| word.spelling == "MACRO")
        {
            return self.fail(SyntaxErrorKind::MacroForm);
        }
        if self.dialect.unknown_majors {
            return self.unknown_major();
        }
        let name = self.spelling();
        if STRUCTURED_IF_WORDS.contains(&&*name)
            && matches!(self.kind(1), None | Some(ElementKind::LeftParenthesis))
        {
            return self.fail(match self.dialect.structured_if {
                true => SyntaxErrorKind::ConditionalClause { word: name },
                false => SyntaxErrorKind::StructuredIf { word: name },
            });
        }
        let foreign = vocabulary::lookup(&name).filter(|word| word.class.begins_statements());
        match foreign.and_then(|word| word.dialects.first()) {
            Some(dialect) => self.fail(SyntaxErrorKind::NotInDialect { word: name, dialect: *dialect }),
            None => {
                let listed = self.kind(1) == Some(ElementKind::Comma);
                self.fail(SyntaxErrorKind::NameWithoutEquals { name, listed })
            }
        }
    }

    // Assignments and definitions.

    /// `target = …`
    fn assignment(&mut self) -> Parsed<Production> {
        let first = self.position;
        if let Some(word) = self.word_at(0)
            && !self.dialect.words_as_names
        {
            return self.fail(SyntaxErrorKind::NoSlash(word.spelling.into()));
        }
        let target = self.reference()?;
        self.spoiled = Some(target.name.clone());
        self.bump();
        if self.at_end() {
            return self.fail(SyntaxErrorKind::EndsOnPunctuation);
        }
        let body = if self.at_word("MACRO") {
            if target.subscript.is_some() {
                return self.fail(SyntaxErrorKind::MacroForm);
            }
            self.macro_header(target.name)?
        } else if self.geometric_type_follows() {
            let definition = self.definition_body()?;
            (Body::Definition { target, definition }, SyntaxKind::Definition)
        } else if self.dialect.bare_points && self.bare_point_follows() {
            let definition = self.bare_point()?;
            (Body::Definition { target, definition }, SyntaxKind::Definition)
        } else if self.at(ElementKind::LeftParenthesis) && self.kind(1) == Some(ElementKind::RightParenthesis)
        {
            // The number that APT III gives here is that of a wrong mark.
            return self.fail(SyntaxErrorKind::UnexpectedMark("(".into()));
        } else {
            let value = self.assigned_value()?;
            (Body::Assignment { target, value }, SyntaxKind::Assignment)
        };
        if self.at_end() {
            self.spoiled = None;
        }
        debug_assert!(self.position > first);
        Ok(body)
    }

    fn geometric_type_follows(&self) -> bool {
        let is_type = self.word_at(0).is_some_and(|word| word.class == WordClass::GeometricType);
        is_type && (self.kind(1) == Some(ElementKind::Slash) || !self.dialect.words_as_names)
    }

    /// Whether the whole rest is one parenthesis with a comma on its level.
    fn bare_point_follows(&self) -> bool {
        let mut depth = 0_u32;
        let mut comma = false;
        for (ahead, element) in self.elements.iter().skip(self.position).enumerate() {
            match element.kind {
                ElementKind::LeftParenthesis => depth += 1,
                ElementKind::RightParenthesis => depth = depth.saturating_sub(1),
                ElementKind::Comma if depth == 1 => comma = true,
                _ => {}
            }
            if depth == 0 {
                return comma && self.kind(ahead + 1).is_none();
            }
        }
        false
    }

    /// `(x,y)` or `(x,y,z)` as a definition of a point.
    fn bare_point(&mut self) -> Parsed<Definition> {
        let first = self.position;
        let Some(word) = vocabulary::lookup("POINT") else { return self.fail(SyntaxErrorKind::WordRequired) };
        let kind = WordUse { word, range: TextRange::empty(self.range_from(first).start()) };
        self.bump();
        let arguments = self.nested(|parser| parser.parameters(ListRules::DEFINITION))?;
        self.close()?;
        self.note(SyntaxKind::DefinitionBody, first);
        Ok(Definition { kind, arguments, range: self.range_from(first) })
    }

    // Majors.

    /// `WORD` or `WORD/parameters`
    fn major(&mut self) -> Parsed<Production> {
        let Some(word) = self.word_use() else { return self.fail(SyntaxErrorKind::WordRequired) };
        self.parameters_of(word)
    }

    fn parameters_of(&mut self, word: WordUse) -> Parsed<Production> {
        let class = word.word.class;
        let slash = self.at(ElementKind::Slash);
        if slash && class == WordClass::PostprocessorBare && self.dialect.bare_words_strict {
            return self.fail(SyntaxErrorKind::TakesNoParameters(word.word.spelling.into()));
        }
        if slash && matches!(word.word.spelling, "LOOPST" | "LOOPND" | "TERMAC") {
            // They begin and end their block all the same.
            let kind = SyntaxErrorKind::TakesNoParameters(word.word.spelling.into());
            let range = self.element(0).map(|element| element.range).unwrap_or_default();
            self.errors.push(SyntaxError::new(kind, range));
        }
        let empty = match word.word.spelling {
            "INDIRV" | "INDIRP" | "SRFVCT" => EmptyPositions::Always,
            _ => EmptyPositions::AfterCanon,
        };
        let rules = ListRules { empty, bare_expressions: false, units_of: Some(word.word.spelling) };
        let mut arguments = Vec::new();
        if slash {
            self.bump();
            if word.word.spelling == "MACHIN" {
                self.excuse_machine_name();
            }
            if !(self.at_end() && self.dialect.empty_parameters) {
                arguments = self.parameters(rules)?;
            }
        }
        Ok((Body::Major { word, slash, arguments }, SyntaxKind::Major))
    }

    /// Machines are named by their makers: only cards hold them to six characters.
    fn excuse_machine_name(&mut self) {
        let on_cards = self.dialect.sequence_field == SequenceFieldRule::Always;
        let Some(range) = self.element(0).map(|element| element.range).filter(|_| !on_cards) else { return };
        self.errors.retain(|error| {
            !(error.range == range && matches!(error.kind, SyntaxErrorKind::NameTooLong { .. }))
        });
    }

    /// Whether the name here is a major word of later systems, such as UNITS, in a place where no name can stand.
    pub(super) fn soft_major_follows(&self) -> bool {
        self.kind(0) == Some(ElementKind::Name)
            && matches!(self.kind(1), None | Some(ElementKind::Slash | ElementKind::Comma))
            && self.soft_major_word().is_some()
    }

    fn soft_major_word(&self) -> Option<&'static Word> {
        let word = vocabulary::lookup(&self.element(0)?.text)?;
        let class = word.class;
        matches!(class, WordClass::Postprocessor | WordClass::PostprocessorBare | WordClass::InputOutput)
            .then_some(word)
    }

    fn soft_major(&mut self) -> Parsed<Production> {
        let Some(word) = self.soft_major_word() else { return self.fail(SyntaxErrorKind::WordRequired) };
        let range = self.bump().map(|element| element.range).unwrap_or_default();
        // What the lexer said of it as a name (its length) does not hold for a word.
        self.errors.retain(|error| error.range != range);
        self.parameters_of(WordUse { word, range })
    }

    /// `NAME/parameters` with a name that nobody knows (CL dialects).
    fn unknown_major(&mut self) -> Parsed<Production> {
        let name = self.name()?;
        let slash = self.eat(ElementKind::Slash);
        let mut arguments = Vec::new();
        if !self.at_end() {
            let rules = ListRules { empty: EmptyPositions::Always, bare_expressions: false, units_of: None };
            arguments = self.parameters(rules)?;
        }
        Ok((Body::UnknownMajor { name, slash, arguments }, SyntaxKind::Major))
    }

    /// A line of numbers: it goes on with the GOTO before it. The word has an empty range and no slash.
    fn implicit_goto(&mut self) -> Parsed<Production> {
        let Some(word) = vocabulary::lookup("GOTO") else {
            return self.fail(SyntaxErrorKind::BadStatementStart);
        };
        let start = self.element(0).map(|element| element.range.start()).unwrap_or_default();
        let rules = ListRules { empty: EmptyPositions::Always, bare_expressions: false, units_of: None };
        let arguments = self.parameters(rules)?;
        let word = WordUse { word, range: TextRange::empty(start) };
        Ok((Body::Major { word, slash: false, arguments }, SyntaxKind::Major))
    }

    /// `OBTAIN,type/surface,names` or `OBTAIN/type/surface,names`
    fn obtain(&mut self) -> Parsed<Production> {
        let Some(word) = self.word_use() else { return self.fail(SyntaxErrorKind::WordRequired) };
        let slash = self.dialect.obtain_slash && self.at(ElementKind::Slash);
        if !slash && !self.at(ElementKind::Comma) {
            return self.fail(SyntaxErrorKind::ObtainTypeExpected);
        }
        self.bump();
        let is_type = self.word_at(0).is_some_and(|kind| kind.class == WordClass::GeometricType);
        let kind = match self.word_use() {
            Some(kind) if is_type => kind,
            Some(_) | None => return self.fail(SyntaxErrorKind::ObtainTypeExpected),
        };
        if !self.eat(ElementKind::Slash) {
            let spelling = SmolStr::from(kind.word.spelling);
            match self.element(0) {
                // Nothing else can be meant, and the names behind it get their values.
                Some(comma) if comma.kind == ElementKind::Comma => {
                    let kind = SyntaxErrorKind::ObtainComma(spelling);
                    self.errors.push(SyntaxError { kind, range: comma.range });
                    self.bump();
                }
                _ => {
                    let statement = SmolStr::from(word.word.spelling);
                    return self.fail(SyntaxErrorKind::SlashMissing { statement, word: spelling });
                }
            }
        }
        let rules = ListRules { empty: EmptyPositions::Always, bare_expressions: false, units_of: None };
        let arguments = self.parameters(rules)?;
        Ok((Body::Obtain { word, kind, arguments }, SyntaxKind::Obtain))
    }
}

/// A word that says where the tool is, and whether relative to the drive surface, not to the part surface.
fn tool_position(part: &Part) -> Option<(&WordUse, bool)> {
    match &part.body {
        Body::Major { word, .. } if word.word.class == WordClass::ToolPosition => {
            Some((word, !matches!(word.word.spelling, "TLONPS" | "TLOFPS")))
        }
        _ => None,
    }
}
