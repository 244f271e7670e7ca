//! PRINT, PUNCH, READ, TITLES and system flags: no effect on geometry or path (language reference 7.9, 7.10).

use super::Major;
use crate::{
    evaluator::Evaluator,
    expression::Operand,
    finding::{Expected, FindingKind, Found},
};
use apt_syntax::statement::{Argument, Expression};

/// Largest first number of PRINT and PUNCH.
const LARGEST_PRINT: f64 = 4.0;
const LARGEST_PUNCH: f64 = 3.0;

impl Evaluator<'_> {
    /// PRINT, PUNCH and READ: the form is checked, names count as used; undefined items are no error.
    pub(crate) fn listing(&mut self, major: Major<'_>) {
        for argument in major.arguments {
            self.mark_listed(argument);
        }
        match (major.spelling(), major.arguments.first()) {
            (_, Some(Argument::Word(word)))
                if matches!(word.word.spelling, "ON" | "OFF") || self.is_apt4() => {}
            ("READ", Some(_)) => {
                self.report(FindingKind::NoEffect { word: major.name() }, major.range);
            }
            (_, Some(Argument::Expression(first))) => {
                let largest = if major.spelling() == "PUNCH" { LARGEST_PUNCH } else { LARGEST_PRINT };
                if let Some(value) = self.scalar(first)
                    && !(0.0..=largest).contains(&value)
                {
                    let finding =
                        FindingKind::OperandRange { statement: major.name(), value, number: Some(326) };
                    self.report(finding, first.range());
                }
            }
            (_, other) => {
                let found = if other.is_none() { Found::Nothing } else { Found::Text };
                self.wrong_operand(major, Expected::Integer, found, 326, major.range);
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
            Argument::Nested { .. } => {
                let mut items = Vec::new();
                self.operand(argument, &mut items);
            }
            _ => {}
        }
    }

    /// LIBRY: there is no library of system macros, so each name is one that is not found.
    pub(crate) fn library(&mut self, major: Major<'_>) {
        for argument in major.arguments {
            match argument {
                Argument::Expression(Expression::Reference(reference)) => {
                    let name = reference.name.text.clone();
                    self.report(FindingKind::IncludeNotFound { name }, reference.range);
                }
                other => self.wrong_operand(major, Expected::Name, Found::Nothing, 156, other.range()),
            }
        }
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
