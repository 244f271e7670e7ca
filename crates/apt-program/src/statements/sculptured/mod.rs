//! Statements of the sculptured surfaces of APT4: the conditions of regional milling (SCON), its commands (SMIL), the
//! checks and the avoidance of interference (CHKSRF, AVCTRL, PRINT/AVPRT), and how their operands are read.

mod avoidance;
mod command;
mod condition;
mod reader;
mod state;

pub(crate) use state::RegionalState;

use reader::Misfit;

use super::Major;
use crate::{
    evaluator::Evaluator,
    expression::Items,
    finding::{FindingKind, Found},
};

/// Numbers of the public system (sculptured surfaces reference, 1.4 to 1.8).
mod number {
    /// No form, or a form with an operand too few.
    pub(super) const NO_FORM: u16 = 2001;
    /// An operand that belongs to no form.
    pub(super) const SURPLUS: u16 = 2021;
    /// CHKSRF without its two operands.
    pub(super) const CHECK_FORM: u16 = 2055;
    /// PRINT with a word that is not known.
    pub(super) const PRINT_WORD: u16 = 2031;
    /// SCON: a word that cannot stand there, or operands that break off.
    pub(super) const CONDITION_WORD: u16 = 3521;
    /// SCON: an operand of the wrong kind.
    pub(super) const CONDITION_OPERAND: u16 = 3522;
    /// SCON: a value that cannot be.
    pub(super) const CONDITION_VALUE: u16 = 3523;
    /// SMIL: a word that cannot stand there.
    pub(super) const COMMAND_WORD: u16 = 3561;
    /// SMIL: an operand of the wrong kind.
    pub(super) const COMMAND_OPERAND: u16 = 3562;
    /// SMIL: a value that cannot be.
    pub(super) const COMMAND_VALUE: u16 = 3563;
    /// SMIL: the guide is of no use for this command.
    pub(super) const COMMAND_GEOMETRY: u16 = 3567;
}

impl Evaluator<'_> {
    /// Reports why a statement fits no form, with the number of the public system.
    fn misfit(&mut self, major: Major<'_>, misfit: Misfit) {
        let (kind, number, range) = match misfit {
            Misfit::Operand { expected, found, number, range } => {
                let statement = major.name();
                (FindingKind::Operand { statement, expected, found, number }, Some(number), range)
            }
            Misfit::Surplus { found, range } => {
                let (statement, number) = (major.name(), number::SURPLUS);
                let expected = crate::finding::Expected::Nothing;
                (FindingKind::Operand { statement, expected, found, number }, Some(number), range)
            }
            Misfit::Value { value, number, range } => {
                (FindingKind::OperandRange { statement: major.name(), value, number }, number, range)
            }
            Misfit::Range { low, high, number, range } => {
                (FindingKind::RangeReversed { statement: major.name(), low, high }, number, range)
            }
        };
        let mut finding = self.finding(kind, range);
        finding.number = number;
        self.add(finding);
    }

    /// The operands of a statement that must have some; an empty list is reported as no form.
    fn regional_operands(&mut self, major: Major<'_>, number: u16) -> Option<Items> {
        let items = self.operands(major.arguments)?;
        if items.is_empty() {
            let expected = crate::finding::Expected::Word;
            self.misfit(
                major,
                Misfit::Operand { expected, found: Found::Nothing, number, range: major.range },
            );
            return None;
        }
        Some(items)
    }

    /// GOMILL, GCLEAR and INTSEC: only their names are public.
    pub(crate) fn undocumented_milling(&mut self, major: Major<'_>) {
        self.report(FindingKind::NameOnly { word: major.name() }, major.word.range);
    }
}
