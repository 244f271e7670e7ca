//! Motion statements (language reference 6).

mod direction;
mod drive;
mod position;
mod start;

use apt_geometry::motion::{DriveSide, MotionCommand, PartSide, Relation};
use apt_syntax::TextRange;
use smol_str::SmolStr;

use super::Major;
use crate::{
    evaluator::{Evaluator, PendingDrive},
    expression::Item,
    finding::{Expected, FindingKind, RelatedKind},
    record::{PostArgument, RecordKind},
};

/// Subclass of FEDRAT on the CL file (language reference 3.5).
const FEDRAT_CODE: u16 = 1009;

/// TO, ON, PAST, TANTO, DSTAN, PSTAN.
pub(crate) fn relation_of(word: &str) -> Option<Relation> {
    Some(match word {
        "TO" => Relation::To,
        "ON" => Relation::On,
        "PAST" => Relation::Past,
        "TANTO" | "DSTAN" => Relation::TangentToDrive,
        "PSTAN" => Relation::TangentToPart,
        _ => return None,
    })
}

impl Evaluator<'_> {
    /// Writes a command to Section 2.
    pub(crate) fn motion(&mut self, command: MotionCommand, range: TextRange) {
        self.emit(RecordKind::Motion(Box::new(command)), range);
    }

    /// A trailing feed rate becomes a FEDRAT record before the motion.
    pub(crate) fn feed(&mut self, rate: f64, range: TextRange) {
        let arguments = vec![PostArgument::Number(rate)];
        let word = SmolStr::new_static("FEDRAT");
        self.emit(RecordKind::Postprocessor { word, code: FEDRAT_CODE, arguments }, range);
    }

    /// TLLFT and its kin; modal.
    pub(crate) fn tool_position(&mut self, major: Major<'_>) {
        if major.slash || !major.arguments.is_empty() {
            self.report(FindingKind::PostBare { word: major.name() }, major.range);
            return;
        }
        let command = match major.spelling() {
            "TLLFT" => MotionCommand::DriveSide(DriveSide::Left),
            "TLRGT" => MotionCommand::DriveSide(DriveSide::Right),
            "TLONPS" => MotionCommand::PartSide(PartSide::On),
            "TLOFPS" => MotionCommand::PartSide(PartSide::Offset),
            _ => MotionCommand::DriveSide(DriveSide::On),
        };
        if let MotionCommand::DriveSide(side) = command {
            self.state.drive_side = side;
        }
        self.motion(command, major.word.range);
    }

    /// PSIS.
    pub(crate) fn part_surface(&mut self, major: Major<'_>) {
        let Some(items) = self.operands_of(major, "1", 576) else { return };
        match items.as_slice() {
            [item] => match item.surface() {
                Some(surface) => self.motion(MotionCommand::PartSurface(surface), major.range),
                None => {
                    let number = if item.scalar().is_some() { 1000 } else { 576 };
                    self.wrong_operand(major, Expected::Surface, item.found(), number, item.range);
                }
            },
            _ => self.wrong_count(major, items.len(), "1", 576),
        }
    }

    /// The surface of an operand, or a finding.
    pub(crate) fn surface_operand(
        &mut self,
        major: Major<'_>,
        item: &Item,
    ) -> Option<apt_geometry::motion::NamedSurface> {
        let surface = item.surface();
        if surface.is_none() {
            self.wrong_operand(major, Expected::Surface, item.found(), 133, item.range);
        }
        surface
    }

    /// A motion that waits for its check surface cannot get one any more: it is reported and given up.
    pub(crate) fn break_pending(&mut self, finding: FindingKind, range: TextRange) {
        let Some(pending) = self.pending.take() else { return };
        self.report_related(finding, range, vec![(RelatedKind::WaitingMotion, pending.origin.clone())]);
        self.give_up(&pending);
    }

    /// A gap takes the place of a motion that gets no check surface.
    fn give_up(&mut self, pending: &PendingDrive) {
        if let Some(record) = self.output.records.get_mut(pending.record) {
            record.kind = RecordKind::Gap;
        }
    }
}
