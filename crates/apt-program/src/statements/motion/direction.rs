//! INDIRV, INDIRP and SRFVCT: directions for the next start-up (language reference 6.3).

use apt_geometry::{
    Vec3,
    motion::{Direction, MotionCommand},
};

use super::super::Major;
use crate::{evaluator::Evaluator, expression::Operand, finding::Expected};

/// Drive, part and check surface.
const ROLES: usize = 3;

impl Evaluator<'_> {
    /// INDIRV and INDIRP.
    pub(crate) fn indirect_direction(&mut self, major: Major<'_>) {
        let by_point = major.spelling() == "INDIRP";
        let Some(entries) = self.role_entries(major, by_point) else { return };
        let directions = entries.map(|entry| {
            entry.map(|value| if by_point { Direction::Point(value) } else { Direction::Vector(value) })
        });
        self.motion(MotionCommand::Direction(directions), major.range);
    }

    /// SRFVCT.
    pub(crate) fn surface_vectors(&mut self, major: Major<'_>) {
        let Some(vectors) = self.role_entries(major, false) else { return };
        self.motion(MotionCommand::SurfaceVectors(vectors), major.range);
    }

    /// Up to three entries, by name or by components; positions may be empty.
    fn role_entries(&mut self, major: Major<'_>, points: bool) -> Option<[Option<Vec3>; ROLES]> {
        const EXPECTED: &str = "1 to 3 vectors or points";
        let items = self.operands_of(major, EXPECTED, 129)?;
        let mut entries = [None; ROLES];
        let mut count = 0;
        let mut numbers: Vec<f64> = Vec::new();
        for item in &items {
            let entry = match (&item.operand, item.vector(), item.point()) {
                (Operand::Scalar(value), _, _) => {
                    numbers.push(*value);
                    if numbers.len() < 3 {
                        continue;
                    }
                    let entry = Vec3::new(numbers[0], numbers[1], numbers[2]);
                    numbers.clear();
                    Some(entry)
                }
                (Operand::Empty, _, _) if numbers.is_empty() => None,
                (_, Some(vector), _) if !points && numbers.is_empty() => Some(vector),
                (_, _, Some(point)) if points && numbers.is_empty() => Some(point),
                _ => {
                    let expected = if points { Expected::Point } else { Expected::Vector };
                    self.wrong_operand(major, expected, item.found(), 129, item.range);
                    return None;
                }
            };
            if let Some(slot) = entries.get_mut(count) {
                *slot = entry;
            }
            count += 1;
        }
        let flat = points && numbers.len() == 2 && items.len() == 2;
        if flat && let [x, y] = *numbers.as_slice() {
            entries[0] = Some(Vec3::new(x, y, self.z_over(x, y, major.range)?));
            return Some(entries);
        }
        if count > ROLES || !numbers.is_empty() || entries.iter().all(Option::is_none) {
            self.wrong_count(major, items.len(), EXPECTED, 129);
            return None;
        }
        Some(entries)
    }
}
