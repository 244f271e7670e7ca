//! READ/2 and LIBRY: statements from files (language reference 7.3).

use apt_syntax::statement::{Argument, Expression};

use super::Major;
use crate::{
    evaluator::{Evaluator, Flow, Region},
    finding::{ControlFinding, Expected, FindingKind, Found},
    symbols::Meaning,
};

/// The first number of a READ that puts in a segment of statements.
const READ_SEGMENT: f64 = 2.0;
/// APT III: READ/2 with too many operands (language reference 9.2).
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
    /// READ/2,name: puts in a stored segment of statements, which is looked for as an included file is.
    pub(super) fn read_segment(&mut self, major: Major<'_>, name: &Argument, rest: &[Argument]) -> Flow {
        if self.here.region != Region::Top {
            self.report(FindingKind::Control(ControlFinding::SegmentInRegion), major.range);
            return Flow::Next;
        }
        // Files may include files; only the library of the cards is read one block after the other.
        if self.dialect.bounded_tables && self.here.source.is_some() {
            self.report(FindingKind::Control(ControlFinding::SegmentInSegment), major.range);
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

    /// LIBRY: each name is a macro of the library, which is the folders that INCLUD searches: a file of its name holds
    /// its definition.
    pub(crate) fn library(&mut self, major: Major<'_>) -> Flow {
        for argument in major.arguments {
            match argument {
                Argument::Expression(Expression::Reference(reference)) if reference.subscript.is_none() => {
                    let name = &reference.name.text;
                    if let Some(source) = self.included_source(name, reference.range) {
                        match self.execute_file(source, name, reference.range) {
                            Flow::Next => {}
                            other => return other,
                        }
                    } else if self.look_up(name).is_none() {
                        // That the macro is missing has been told here; its calls need not be.
                        let origin = self.origin(reference.range);
                        self.set_symbol(name.clone(), Meaning::Poisoned, origin);
                    }
                }
                other => self.wrong_operand(major, Expected::Name, Found::Nothing, 156, other.range()),
            }
        }
        Flow::Next
    }
}
