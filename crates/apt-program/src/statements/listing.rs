//! PRINT, PUNCH, READ, TITLES and system flags: no effect on geometry or path (language reference 7.9, 7.10).

use super::Major;
use crate::{
    evaluator::{Evaluator, Flow, Region},
    expression::Operand,
    finding::{Expected, FindingKind, Found},
};
use apt_syntax::{
    statement::{Argument, Expression},
    vocabulary::WordClass,
};

/// Largest first number of PRINT and PUNCH.
const LARGEST_PRINT: f64 = 4.0;
const LARGEST_PUNCH: f64 = 3.0;
/// First numbers that PRINT takes in APT4 (language reference 10.4).
const APT4_PRINT_NUMBERS: [f64; 3] = [0.0, 2.0, 3.0];
/// The first number of a READ that puts in a segment of statements.
const READ_SEGMENT: f64 = 2.0;
/// APT III: READ/2 inside a loop or macro, READ/2 with too many operands (language reference 9.2).
const READ_IN_REGION: u16 = 37;
const READ_COUNT: u16 = 34;

/// The name in `READ/2,name`, and what follows it.
pub(crate) fn segment(arguments: &[Argument]) -> Option<(&Argument, &[Argument])> {
    match arguments {
        [Argument::Expression(Expression::Number { value: READ_SEGMENT, .. }), name, rest @ ..] => {
            Some((name, rest))
        }
        _ => None,
    }
}

impl Evaluator<'_> {
    /// PRINT, PUNCH and READ: the form is checked, names count as used; undefined items are no error.
    pub(crate) fn listing(&mut self, major: Major<'_>) -> Flow {
        if let ("READ", Some((name, rest))) = (major.spelling(), segment(major.arguments)) {
            return self.read_segment(major, name, rest);
        }
        for argument in major.arguments {
            self.mark_listed(argument);
        }
        match (major.spelling(), major.arguments) {
            ("READ", [_, ..]) => self.report(FindingKind::NoEffect { word: major.name() }, major.range),
            ("PRINT", arguments) if self.is_apt4() => self.apt4_listing(major, arguments),
            (_, [Argument::Word(word), ..]) if matches!(word.word.spelling, "ON" | "OFF") => {}
            (_, [Argument::Expression(first), ..]) => {
                let largest = if major.spelling() == "PUNCH" { LARGEST_PUNCH } else { LARGEST_PRINT };
                if let Some(value) = self.scalar(first)
                    && !(0.0..=largest).contains(&value)
                {
                    let finding =
                        FindingKind::OperandRange { statement: major.name(), value, number: Some(326) };
                    self.report(finding, first.range());
                }
            }
            (_, arguments) => {
                let found = if arguments.is_empty() { Found::Nothing } else { Found::Text };
                self.wrong_operand(major, Expected::Integer, found, 326, major.range);
            }
        }
        Flow::Next
    }

    /// PRINT in APT4: 0, 2 or 3 with a list, ON, OFF, or the switch of a part of the system.
    fn apt4_listing(&mut self, major: Major<'_>, arguments: &[Argument]) {
        match arguments {
            [Argument::Word(word), ..] if matches!(word.word.spelling, "ON" | "OFF") => {}
            [Argument::Word(word), Argument::Word(switch)]
                if word.word.class == WordClass::SystemFlag
                    && matches!(switch.word.spelling, "ON" | "OFF") => {}
            [Argument::Expression(Expression::Number { value, .. }), ..]
                if APT4_PRINT_NUMBERS.contains(value) => {}
            [Argument::Expression(Expression::Number { value, range }), ..] => {
                let finding =
                    FindingKind::OperandRange { statement: major.name(), value: *value, number: Some(326) };
                self.report(finding, *range);
            }
            _ => self.wrong_operand(major, Expected::Integer, Found::Text, 326, major.range),
        }
    }

    /// READ/2,name: puts in a stored segment of statements, which is looked for as an included file is.
    fn read_segment(&mut self, major: Major<'_>, name: &Argument, rest: &[Argument]) -> Flow {
        if self.here.region != Region::Top {
            self.wrong_operand(major, Expected::Nothing, Found::Text, READ_IN_REGION, major.range);
            return Flow::Next;
        }
        if !rest.is_empty() {
            self.wrong_count(major, rest.len() + 2, "2 and one name", READ_COUNT);
            return Flow::Next;
        }
        match name {
            Argument::Expression(Expression::Reference(reference)) if reference.subscript.is_none() => {
                self.include_file(&reference.name.text, reference.range)
            }
            other => {
                self.wrong_operand(major, Expected::Name, Found::Scalar, 156, other.range());
                Flow::Next
            }
        }
    }

    /// Marks the names of a list as used; nests are evaluated, since they may define names.
    fn mark_listed(&mut self, argument: &Argument) {
        match argument {
            Argument::Expression(Expression::Reference(reference)) => {
                let key = self.array_key(&reference.name.text);
                self.mark_used(&reference.name.text);
                self.mark_used(&key);
            }
            Argument::Inclusive { name, .. } => {
                let key = self.array_key(&name.text);
                self.mark_used(&key);
            }
            Argument::Word(word) if word.word.spelling == "ALL" => self.output.lists_all = true,
            Argument::Nested { .. } => {
                let mut items = Vec::new();
                self.operand(argument, &mut items);
            }
            _ => {}
        }
    }

    /// LIBRY: each name is a macro of the library, which is the folders that INCLUD searches: a file of its name holds
    /// its definition.
    pub(crate) fn library(&mut self, major: Major<'_>) -> Flow {
        for argument in major.arguments {
            match argument {
                Argument::Expression(Expression::Reference(reference)) if reference.subscript.is_none() => {
                    match self.include_file(&reference.name.text, reference.range) {
                        Flow::Next => {}
                        other => return other,
                    }
                }
                other => self.wrong_operand(major, Expected::Name, Found::Nothing, 156, other.range()),
            }
        }
        Flow::Next
    }

    /// System flags: accepted; those that APT III does not implement get its warning.
    pub(crate) fn system_flag(&mut self, major: Major<'_>) {
        match major.spelling() {
            "LTV" | "MIT" | "CMIT" | "TANCRV" => {
                self.report(FindingKind::NoEffect { word: major.name() }, major.word.range);
            }
            "PTONLY" => {
                let Some(items) = self.operands(major.arguments) else { return };
                let valid = matches!(items.first().map(|item| &item.operand), Some(Operand::Scalar(n)) if (1.0..=3.0).contains(n));
                if !valid {
                    let found = items.first().map_or(Found::Nothing, |item| item.found());
                    self.wrong_operand(major, Expected::Integer, found, 553, major.range);
                }
            }
            "DEBUG" => {
                let last = major.arguments.last();
                let valid =
                    matches!(last, Some(Argument::Word(word)) if matches!(word.word.spelling, "ON" | "OFF"));
                if !valid {
                    self.wrong_operand(major, Expected::OnOrOff, Found::Nothing, 22, major.range);
                }
            }
            _ => {}
        }
    }
}
