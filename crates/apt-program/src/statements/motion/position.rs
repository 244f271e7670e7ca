//! FROM, GOTO and GODLTA: read by counting (language reference 6.2).

use apt_geometry::{
    Vec3,
    motion::{Delta, MotionCommand},
};
use apt_syntax::{
    TextRange,
    statement::{Argument, Expression},
};

use super::super::Major;
use crate::{
    evaluator::Evaluator,
    expression::{Item, Items, Operand},
    finding::{Expected, FindingKind},
};

/// What the operands of FROM, GOTO and GODLTA say.
struct Position {
    place: Vec3,
    axis: Option<Vec3>,
    feed: Option<(f64, TextRange)>,
    name: String,
}

impl Evaluator<'_> {
    /// FROM and GOTO.
    pub(crate) fn go_to(&mut self, major: Major<'_>) {
        if self.pending.is_some() {
            self.break_pending(FindingKind::ImpliedCheckBroken { word: major.name() }, major.range);
        }
        if let Some(place) = three_numbers(major.arguments) {
            return self
                .emit_position(major, Position { place, axis: None, feed: None, name: String::new() });
        }
        let Some(items) = self.operands_of(major, "2, 3, 4, 6 or 7 numbers", 129) else { return };
        if let Some((name, pattern)) = items.first().and_then(Item::pattern) {
            if major.spelling() == "GOTO" {
                self.go_to_pattern(major, &name, &pattern, &items[1..]);
            } else if let Some(item) = items.first() {
                self.wrong_operand(major, Expected::Point, item.found(), 129, item.range);
            }
            return;
        }
        if let Some(position) = self.position(major, &items) {
            self.emit_position(major, position);
        }
    }

    /// Writes feed and motion record.
    fn emit_position(&mut self, major: Major<'_>, position: Position) {
        if let Some((rate, range)) = position.feed {
            self.feed(rate, range);
        }
        let Position { place, axis, name, .. } = position;
        let axis = self.axis_that_counts(major, axis);
        let command = if major.spelling() == "FROM" {
            MotionCommand::From { position: place, axis, name }
        } else {
            MotionCommand::GoTo { position: place, axis, name }
        };
        self.motion(command, major.range);
    }

    /// The axis that a position gives; in APT4 it counts only while MULTAX is on.
    fn axis_that_counts(&mut self, major: Major<'_>, axis: Option<Vec3>) -> Option<Vec3> {
        if axis.is_some() && self.is_apt4() && !self.state.axes_on {
            self.report(FindingKind::AxisDropped { word: major.name() }, major.range);
            return None;
        }
        axis
    }

    /// Counts scalars; a point counts as three, a vector after the place is the axis.
    fn position(&mut self, major: Major<'_>, items: &Items) -> Option<Position> {
        let mut numbers: Vec<(f64, TextRange)> = Vec::with_capacity(7);
        let mut name = String::new();
        let mut points = 0_usize;
        for (index, item) in items.iter().enumerate() {
            match (item.scalar(), item.point(), item.vector()) {
                (Some(value), _, _) => numbers.push((value, item.range)),
                (_, Some(point), _) if index == 0 => {
                    points += 1;
                    name = item.name().to_string();
                    numbers.extend(point.iter().map(|value| (*value, item.range)));
                }
                (_, _, Some(vector)) if numbers.len() == 3 => {
                    numbers.extend(vector.iter().map(|value| (*value, item.range)));
                }
                _ => {
                    let expected = if index == 0 { Expected::Point } else { Expected::Scalar };
                    self.wrong_operand(major, expected, item.found(), 129, item.range);
                    return None;
                }
            }
        }
        let values: Vec<f64> = numbers.iter().map(|(value, _)| *value).collect();
        let feed = |index: usize| numbers.get(index).copied();
        let (place, axis, feed) = match *values.as_slice() {
            [x, y] => (Vec3::new(x, y, self.z_over(x, y, major.range)?), None, None),
            [x, y, z] => (Vec3::new(x, y, z), None, None),
            [x, y, z, _] => (Vec3::new(x, y, z), None, feed(3)),
            [x, y, z, i, j, k] => (Vec3::new(x, y, z), Some(Vec3::new(i, j, k)), None),
            [x, y, z, i, j, k, _] => (Vec3::new(x, y, z), Some(Vec3::new(i, j, k)), feed(6)),
            _ => {
                let expected =
                    if points > 0 { "a point, an axis, a feed rate" } else { "2, 3, 4, 6 or 7 numbers" };
                self.wrong_count(major, values.len(), expected, 129);
                return None;
            }
        };
        if axis.is_some_and(|axis| axis.norm_squared() == 0.0) {
            let finding = FindingKind::OperandRange { statement: major.name(), value: 0.0, number: Some(3) };
            self.report(finding, major.range);
            return None;
        }
        Some(Position { place, axis, feed, name })
    }

    /// GODLTA: along the axis, or an increment, each perhaps with a feed rate or a new axis.
    pub(crate) fn go_delta(&mut self, major: Major<'_>) {
        if self.pending.is_some() {
            self.break_pending(FindingKind::ImpliedCheckBroken { word: major.name() }, major.range);
        }
        let Some(items) = self.operands_of(major, "1, 2, 3, 4, 6 or 7 numbers", 129) else { return };
        let mut values = Vec::with_capacity(7);
        let mut name = String::new();
        for (index, item) in items.iter().enumerate() {
            match (&item.operand, item.vector().or_else(|| item.point())) {
                (Operand::Scalar(value), _) => values.push(*value),
                (_, Some(vector)) if index == 0 || values.len() == 3 => {
                    if index == 0 {
                        name = item.name().to_string();
                    }
                    values.extend(vector.iter());
                }
                _ => return self.wrong_operand(major, Expected::Vector, item.found(), 129, item.range),
            }
        }
        let (delta, feed) = match *values.as_slice() {
            [d] => (Delta::AlongAxis(d), None),
            [d, feed] => (Delta::AlongAxis(d), Some(feed)),
            [x, y, z] => (Delta::Vector(Vec3::new(x, y, z), None), None),
            [x, y, z, feed] => (Delta::Vector(Vec3::new(x, y, z), None), Some(feed)),
            [x, y, z, i, j, k] => (Delta::Vector(Vec3::new(x, y, z), Some(Vec3::new(i, j, k))), None),
            [x, y, z, i, j, k, feed] => {
                (Delta::Vector(Vec3::new(x, y, z), Some(Vec3::new(i, j, k))), Some(feed))
            }
            _ => return self.wrong_count(major, values.len(), "1, 2, 3, 4, 6 or 7 numbers", 129),
        };
        if let Some(rate) = feed {
            let range = items.last().map_or(major.range, |item| item.range);
            self.feed(rate, range);
        }
        let delta = match delta {
            Delta::Vector(increment, axis) => Delta::Vector(increment, self.axis_that_counts(major, axis)),
            along => along,
        };
        self.motion(MotionCommand::GoDelta { delta, name }, major.range);
    }
}

/// The commonest form, three plain numbers, without any allocation.
fn three_numbers(arguments: &[Argument]) -> Option<Vec3> {
    let [x, y, z] = arguments else { return None };
    Some(Vec3::new(plain_number(x)?, plain_number(y)?, plain_number(z)?))
}

/// A number with an optional sign.
fn plain_number(argument: &Argument) -> Option<f64> {
    match argument {
        Argument::Expression(Expression::Number { value, .. }) => Some(*value),
        Argument::Expression(Expression::Sign { negative, operand, .. }) => match **operand {
            Expression::Number { value, .. } => Some(if *negative { -value } else { value }),
            _ => None,
        },
        _ => None,
    }
}
