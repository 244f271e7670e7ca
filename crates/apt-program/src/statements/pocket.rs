//! POCKET (language reference 6.10).

use apt_geometry::{
    Vec3,
    motion::{MotionCommand, Pocket},
};

use super::Major;
use crate::{
    evaluator::Evaluator,
    expression::{Item, Operand},
    finding::FindingKind,
};

/// Numbers before the points.
const NUMBERS: usize = 8;
/// Fewest and most points.
const POINTS: std::ops::RangeInclusive<usize> = 3..=20;

impl Evaluator<'_> {
    /// POCKET with its eight numbers and its points.
    pub(crate) fn pocket(&mut self, major: Major<'_>) {
        let Some(items) = self.operands(major.arguments) else { return };
        let numbers: Vec<f64> = items.iter().take(NUMBERS).map_while(Item::scalar).collect();
        let [re, c, f, f1, f2, f3, keep, kind] = *numbers.as_slice() else {
            if numbers.len() == items.len() && !items.is_empty() {
                return self.report(FindingKind::PocketPoints { found: 0 }, major.range);
            }
            return self.report(FindingKind::PocketNumbers, major.range);
        };
        for (value, limit, number) in [(keep, 1.0, 3515), (kind, 3.0, 3516)] {
            if value.fract() != 0.0 || !(0.0..=limit).contains(&value) {
                let finding =
                    FindingKind::OperandRange { statement: major.name(), value, number: Some(number) };
                return self.report(finding, major.range);
            }
        }
        let Some(points) = pocket_points(&items[NUMBERS..]) else {
            let found = items.len() - NUMBERS;
            return self.report(FindingKind::PocketPoints { found }, major.range);
        };
        if !POINTS.contains(&points.len()) {
            return self.report(FindingKind::PocketPoints { found: points.len() }, major.range);
        }
        if self.pending.is_some() {
            self.break_pending(FindingKind::ImpliedCheckBroken { word: major.name() }, major.range);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 3, checked above")]
        let pocket = Pocket {
            numbers: [re, c, f, f1, f2, f3],
            keep_offsets: keep == 1.0,
            point_kind: kind as u8,
            points,
        };
        self.motion(MotionCommand::Pocket(pocket), major.range);
    }
}

/// Points by name or as triples of numbers; nothing if a triple is incomplete or something else stands there.
fn pocket_points(items: &[Item]) -> Option<Vec<Vec3>> {
    let mut points = Vec::new();
    let mut triple: Vec<f64> = Vec::with_capacity(3);
    for item in items {
        match (&item.operand, item.point()) {
            (Operand::Scalar(value), _) => triple.push(*value),
            (_, Some(point)) if triple.is_empty() => points.push(point),
            _ => return None,
        }
        if let [x, y, z] = *triple.as_slice() {
            points.push(Vec3::new(x, y, z));
            triple.clear();
        }
    }
    triple.is_empty().then_some(points)
}
