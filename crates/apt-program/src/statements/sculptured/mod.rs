//! Statements of the sculptured surfaces of APT4: the conditions of regional milling (SCON), its commands (SMIL), the
//! checks and the avoidance of interference (CHKSRF, AVCTRL, PRINT/AVPRT), and how their operands are read.

mod avoidance;
mod command;
mod condition;
mod curve;
mod place;
mod reader;
mod state;
mod surface;

pub(crate) use state::RegionalState;

use std::sync::Arc;

use apt_geometry::{
    canonical::{Geometry, GeometryKind, Remembering},
    definition::{Defined, ParametricError},
};
use apt_syntax::TextRange;
use smol_str::SmolStr;

pub(super) use place::asks_parametric;
use reader::{Misfit, Reader};

use super::Major;
use crate::{
    evaluator::Evaluator,
    expression::{Item, Items},
    finding::{FindingKind, Found, SculpturedFinding},
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
        self.misfit_of(major.name(), misfit);
    }

    /// The same of a definition or function by its word.
    fn misfit_of(&mut self, statement: SmolStr, misfit: Misfit) {
        let (kind, number, range) = match misfit {
            Misfit::Operand { expected, found, number, range } => {
                (FindingKind::Operand { statement, expected, found, number }, Some(number), range)
            }
            Misfit::Surplus { found, range } => {
                let number = number::SURPLUS;
                let expected = crate::finding::Expected::Nothing;
                (FindingKind::Operand { statement, expected, found, number }, Some(number), range)
            }
            Misfit::Value { value, number, range } => {
                (FindingKind::OperandRange { statement, value, number }, number, range)
            }
            Misfit::Range { low, high, number, range } => (
                FindingKind::Sculptured(SculpturedFinding::RangeReversed { statement, low, high }),
                number,
                range,
            ),
        };
        let mut finding = self.finding(kind, range);
        finding.number = number;
        self.add(finding);
    }

    /// The operands of a statement that must have some; an empty list is reported as no form.
    fn regional_operands(&mut self, major: Major<'_>, number: u16) -> Option<Items> {
        // A name without value makes a statement of no form, as in definitions.
        self.definition_depth += 1;
        let items = self.operands(major.arguments);
        self.definition_depth -= 1;
        let items = items?;
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

    /// Reports what does not exist of a curve or surface.
    fn report_parametric(&mut self, statement: SmolStr, error: ParametricError, range: TextRange) {
        self.report(FindingKind::Sculptured(SculpturedFinding::Parametric { statement, error }), range);
    }

    /// A space curve or a sculptured surface from the operands of its definition; mistakes are reported.
    pub(super) fn parametric_definition(
        &mut self,
        kind: GeometryKind,
        items: &[Item],
        range: TextRange,
    ) -> Option<Geometry> {
        let statement = SmolStr::new_static(kind.word());
        let mut reader = Reader::new(items, range);
        let made = if kind == GeometryKind::SpaceCurve {
            let read = curve::definition(&mut reader, self.state.z_surface);
            read.map(|definition| {
                definition.define().map(|made| boxed(made, |curve| Geometry::SpaceCurve(Arc::new(curve))))
            })
        } else {
            let read = surface::definition(&mut reader);
            read.map(|definition| {
                definition
                    .define()
                    .map(|made| boxed(made, |surface| Geometry::Sculptured(Remembering::new(surface))))
            })
        };
        match made {
            Ok(Ok((geometry, warnings))) => {
                for error in warnings {
                    let statement = statement.clone();
                    self.report(
                        FindingKind::Sculptured(SculpturedFinding::ParametricDoubt { statement, error }),
                        range,
                    );
                }
                Some(geometry)
            }
            Ok(Err(error)) => {
                self.report_parametric(statement, error, range);
                None
            }
            Err(misfit) => {
                self.misfit_of(statement, misfit);
                None
            }
        }
    }

    /// GOMILL, GCLEAR and INTSEC: only their names are public.
    pub(crate) fn undocumented_milling(&mut self, major: Major<'_>) {
        self.report(
            FindingKind::Sculptured(SculpturedFinding::NameOnly { word: major.name() }),
            major.word.range,
        );
    }
}

/// What a definition has made, as geometry, with its warnings.
fn boxed<T>(made: Defined<T>, wrap: fn(T) -> Geometry) -> (Geometry, Vec<ParametricError>) {
    (wrap(made.geometry), made.warnings)
}
