//! TRACUT, INDEX and COPY (language reference 6.11).

use apt_geometry::{Vec3, canonical::Geometry, copy::CopyStep};

use super::Major;
use crate::{
    evaluator::Evaluator,
    expression::{Item, Operand},
    finding::{Expected, FindingKind, Found},
    record::RecordKind,
};

/// APT III, edit phase: COPY cannot mirror by itself.
const MIRROR_IN_COPY: u16 = 10;

impl Evaluator<'_> {
    /// TRACUT/matrix or TRACUT/NOMORE.
    pub(crate) fn cut_transformation(&mut self, major: Major<'_>) {
        let Some(items) = self.operands(major.arguments) else { return };
        let matrix = match items.as_slice() {
            [item] if item.word() == Some("NOMORE") => None,
            [item] => match item.geometry() {
                Some(Geometry::Matrix(matrix)) => Some(*matrix),
                _ => return self.report(FindingKind::TransformForm { found: item.found() }, item.range),
            },
            _ => {
                let found = items.first().map_or(Found::Nothing, Item::found);
                return self.report(FindingKind::TransformForm { found }, major.range);
            }
        };
        self.emit(RecordKind::Transform(matrix), major.range);
    }

    /// INDEX/n and INDEX/n,NOMORE.
    pub(crate) fn index(&mut self, major: Major<'_>) {
        let Some(items) = self.operands_of(major, "1 or 2", 507) else { return };
        let Some(number) = self.index_number(major, &items[0]) else { return };
        let end = match items.get(1..) {
            Some([]) | None => false,
            Some([item]) if item.word() == Some("NOMORE") => true,
            Some([item, ..]) => {
                return self.wrong_operand(major, Expected::Word, item.found(), 503, item.range);
            }
        };
        self.emit(RecordKind::Index { number, end }, major.range);
    }

    /// COPY/i,option,...,n.
    pub(crate) fn copy(&mut self, major: Major<'_>) {
        let Some(items) = self.operands_of(major, "at least 3", 507) else { return };
        let Some(number) = self.index_number(major, &items[0]) else { return };
        let Some(option) = items.get(1) else {
            return self.report(FindingKind::CopyCount { found: items.len(), expected: 3 }, major.range);
        };
        let expected = match option.word() {
            Some("SAME") => 3,
            Some("XYROT" | "MODIFY") => 4,
            Some("TRANSL") => 6,
            word => {
                let mut finding =
                    self.finding(FindingKind::CopyOption { found: option.found() }, option.range);
                // MODIFY with a matrix of MIRROR makes a mirrored copy.
                if word == Some("MIRROR") {
                    finding.number = Some(MIRROR_IN_COPY);
                }
                return self.add(finding);
            }
        };
        if items.len() != expected {
            return self.report(FindingKind::CopyCount { found: items.len(), expected }, major.range);
        }
        let Some(step) = self.copy_step(major, &items[2..expected - 1], option.word()) else { return };
        let last = &items[expected - 1];
        let Some(count) = last.scalar() else {
            return self.wrong_operand(major, Expected::Integer, last.found(), 503, last.range);
        };
        if count < 0.0 || count > f64::from(u32::MAX) {
            let finding =
                FindingKind::OperandRange { statement: major.name(), value: count, number: Some(9) };
            return self.report(finding, last.range);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "range checked above")]
        // A fraction of a copy is one copy; beyond one the fraction is cut off.
        let count = if count > 0.0 { (count.trunc() as u32).max(1) } else { 0 };
        self.emit(RecordKind::Copy { number, step, count }, major.range);
    }

    /// What each copy adds.
    fn copy_step(&mut self, major: Major<'_>, items: &[Item], option: Option<&str>) -> Option<CopyStep> {
        if let ([item], Some("MODIFY")) = (items, option) {
            if let Some(Geometry::Matrix(matrix)) = item.geometry() {
                return Some(CopyStep::Matrix(*matrix));
            }
            self.wrong_operand(major, Expected::Matrix, item.found(), 503, item.range);
            return None;
        }
        let mut numbers = Vec::with_capacity(items.len());
        for item in items {
            match &item.operand {
                Operand::Scalar(value) => numbers.push(*value),
                _ => {
                    self.wrong_operand(major, Expected::Scalar, item.found(), 503, item.range);
                    return None;
                }
            }
        }
        match *numbers.as_slice() {
            [] => Some(CopyStep::Same),
            [angle] => Some(CopyStep::RotationAboutZ(angle)),
            [x, y, z] => Some(CopyStep::Translation(Vec3::new(x, y, z))),
            _ => None,
        }
    }

    /// The index number of INDEX and COPY.
    fn index_number(&mut self, major: Major<'_>, item: &Item) -> Option<i64> {
        match item.scalar() {
            #[expect(clippy::cast_possible_truncation, reason = "saturates; index numbers are small")]
            Some(number) => Some(number.trunc() as i64),
            None => {
                self.wrong_operand(major, Expected::Integer, item.found(), 503, item.range);
                None
            }
        }
    }
}
