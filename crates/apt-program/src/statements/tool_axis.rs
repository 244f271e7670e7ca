//! TLAXIS in its forms (language reference 6.9).

use apt_geometry::{
    Vec3,
    motion::{AxisAngle, AxisTangency, MotionCommand, ToolAxis},
};

use super::Major;
use crate::{
    evaluator::Evaluator,
    expression::{Item, Operand},
    finding::{Expected, FindingKind, Found},
};

/// Largest angle of ATANGL and CUTANG, degrees (language reference 6.9).
const LARGEST_ANGLE: f64 = 90.0;

impl Evaluator<'_> {
    /// TLAXIS.
    pub(crate) fn tool_axis(&mut self, major: Major<'_>) {
        if self.refuse_undefined_option(major) {
            return;
        }
        let Some(items) = self.operands_of(major, "an axis", 129) else { return };
        let axis = match (items.first().map(|item| &item.operand), items.len()) {
            (Some(Operand::Word(word)), _) => self.axis_by_word(major, word.spelling, &items[1..]),
            (Some(Operand::Scalar(value)), 1) if *value == 1.0 => Some(ToolAxis::Keep),
            _ => self
                .axis_vector(major, &items)
                .and_then(|vector| self.direction(major, vector, 3))
                .map(ToolAxis::Fixed),
        };
        if let Some(axis) = axis {
            self.motion(MotionCommand::ToolAxis(axis), major.range);
        }
    }

    /// A direction, normalised; without a length it has the APT III number of its form.
    fn direction(&mut self, major: Major<'_>, vector: Vec3, number: u16) -> Option<Vec3> {
        let length = vector.norm();
        if length > 0.0 && length.is_finite() {
            return Some(vector / length);
        }
        let finding =
            FindingKind::OperandRange { statement: major.name(), value: length, number: Some(number) };
        self.report(finding, major.range);
        None
    }

    /// A vector by name or by three numbers; the whole of `items`.
    fn axis_vector(&mut self, major: Major<'_>, items: &[Item]) -> Option<Vec3> {
        if let [item] = items
            && let Some(vector) = item.vector()
        {
            return Some(vector);
        }
        if let [x, y, z] = items
            && let (Some(x), Some(y), Some(z)) = (x.scalar(), y.scalar(), z.scalar())
        {
            return Some(Vec3::new(x, y, z));
        }
        let odd = items.iter().find(|item| item.scalar().is_none() && item.vector().is_none());
        match odd {
            Some(item) => self.wrong_operand(major, Expected::Vector, item.found(), 129, item.range),
            None => self.wrong_count(major, items.len(), "a vector or 3 numbers", 129),
        }
        None
    }

    /// NORMPS, NORMDS, PARLEL, ATANGL and the forms that APT III does not document.
    fn axis_by_word(&mut self, major: Major<'_>, word: &'static str, rest: &[Item]) -> Option<ToolAxis> {
        match (word, rest) {
            ("NORMPS", []) => Some(ToolAxis::Normal { part: true }),
            ("NORMDS", []) => Some(ToolAxis::Normal { part: false }),
            ("PARLEL", [which]) => Some(ToolAxis::Parallel { part: self.part_or_drive(major, which)? }),
            ("ATANGL", [which, angle, mode @ ..]) => {
                let part = self.part_or_drive(major, which)?;
                let angle = self.axis_angle(major, angle, 16)?;
                let mode = match mode {
                    [] => AxisAngle::Plain,
                    [word, lead] if word.word() == Some("CUTANG") => {
                        AxisAngle::Lead(self.axis_angle(major, lead, 17)?)
                    }
                    _ => {
                        let vector = self.axis_vector(major, mode)?;
                        AxisAngle::PerpendicularTo(self.direction(major, vector, 19)?)
                    }
                };
                Some(ToolAxis::AtAngle { part, angle, mode })
            }
            ("ATANGL" | "PARLEL", _) => {
                self.wrong_count(major, rest.len(), "1 or 2 and an angle", 129);
                None
            }
            ("NORMPS" | "NORMDS" | "PERPTO" | "TANDS" | "FAN", _) => {
                let axis = self.axis_of_later_systems(major, word, rest)?;
                let word = smol_str::SmolStr::new_static(word);
                self.report(FindingKind::AxisUndocumented { word }, major.range);
                Some(axis)
            }
            _ => {
                let found = Found::Word(smol_str::SmolStr::new_static(word));
                self.wrong_operand(major, Expected::Vector, found, 133, major.range);
                None
            }
        }
    }

    /// The forms that APT III accepts without documenting what they do, with the meaning that later systems gave them:
    /// NORMPS and NORMDS with a vector keep the axis in planes perpendicular to it, PERPTO with a vector and TANDS lay it
    /// along the drive surface, FAN turns it evenly to the position of TANDS at the end. A number behind is the height of
    /// tangency; the normal has none.
    fn axis_of_later_systems(&mut self, major: Major<'_>, word: &str, rest: &[Item]) -> Option<ToolAxis> {
        let (vector, height) = match (word, rest) {
            ("TANDS" | "FAN", _) => (&rest[..0], rest),
            (_, [vector, height @ ..]) if vector.vector().is_some() => (std::slice::from_ref(vector), height),
            _ => rest.split_at(rest.len().min(3)),
        };
        let height = match height {
            [] => 0.0,
            [item] => match item.scalar() {
                Some(height) => height,
                None => {
                    self.wrong_operand(major, Expected::Scalar, item.found(), 129, item.range);
                    return None;
                }
            },
            _ => {
                self.wrong_count(major, rest.len(), "a vector and a number", 129);
                return None;
            }
        };
        if matches!(word, "TANDS" | "FAN") {
            let mode = if word == "FAN" { AxisTangency::Fan } else { AxisTangency::Across };
            return Some(ToolAxis::Tangent { height, mode });
        }
        let vector = self.axis_vector(major, vector)?;
        let vector = self.direction(major, vector, 3)?;
        Some(match word {
            "PERPTO" => ToolAxis::Tangent { height, mode: AxisTangency::PerpendicularTo(vector) },
            _ => {
                let mode = AxisAngle::PerpendicularTo(vector);
                ToolAxis::AtAngle { part: word == "NORMPS", angle: 0.0, mode }
            }
        })
    }

    /// 1 for the part surface, 2 for the drive surface.
    fn part_or_drive(&mut self, major: Major<'_>, item: &Item) -> Option<bool> {
        match item.scalar() {
            Some(1.0) => Some(true),
            Some(2.0) => Some(false),
            Some(value) => {
                let finding = FindingKind::OperandRange { statement: major.name(), value, number: Some(4) };
                self.report(finding, item.range);
                None
            }
            None => {
                self.wrong_operand(major, Expected::Integer, item.found(), 129, item.range);
                None
            }
        }
    }

    /// An angle in degrees up to 90 either way, as radians.
    fn axis_angle(&mut self, major: Major<'_>, item: &Item, number: u16) -> Option<f64> {
        match item.scalar() {
            Some(angle) if angle.abs() <= LARGEST_ANGLE => Some(angle.to_radians()),
            Some(value) => {
                let finding =
                    FindingKind::OperandRange { statement: major.name(), value, number: Some(number) };
                self.report(finding, item.range);
                None
            }
            None => {
                self.wrong_operand(major, Expected::Scalar, item.found(), 129, item.range);
                None
            }
        }
    }
}
