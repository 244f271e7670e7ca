//! GOLFT and its kin with check surfaces, given or implied (language reference 6.6, arelem reference 3.2).

use apt_geometry::motion::{CheckSurface, DriveSide, MotionCommand, NamedSurface, Relation, Turn};
use apt_syntax::{
    TextRange,
    statement::{Argument, Expression},
};
use smol_str::SmolStr;

use super::{super::Major, relation_of};
use crate::{
    blocks::normalised_label,
    evaluator::{Evaluator, PendingDrive},
    expression::{Item, Operand},
    finding::{Expected, FindingKind, Found},
    record::RecordKind,
    symbols::Meaning,
};

/// Most check surfaces of one statement.
const CHECK_SURFACES: usize = 2;

/// APT4: a word that cannot stand before a check surface or its label.
const APT4_CHECK_RELATION: u16 = 2022;

/// A trailing feed rate with its place.
type Feed = (f64, TextRange);

/// An operand of a directed motion: evaluated, or a name that can only be a label.
enum DriveItem {
    Value(Item),
    Label(SmolStr, TextRange),
}

impl Evaluator<'_> {
    /// A directed motion statement.
    pub(crate) fn directed_motion(&mut self, major: Major<'_>) {
        if let Some(range) = transfer_word(major.arguments) {
            self.drop_pending();
            let finding = FindingKind::RelationNotHere { word: SmolStr::new_static("TRANTO") };
            return self.report_apt4(finding, APT4_CHECK_RELATION, range);
        }
        let Some(items) = self.drive_items(major.arguments) else {
            // The drive surface is not known, so a motion that waits for it is given up without another message.
            self.drop_pending();
            return;
        };
        let Some(first) = items.first() else {
            self.drop_pending();
            return self.wrong_count(major, 0, "a drive surface", 129);
        };
        let drive = match first {
            DriveItem::Value(item) => match &item.operand {
                Operand::Word(word) if relation_of(word.spelling).is_some() => {
                    self.drop_pending();
                    let word = SmolStr::new_static(word.spelling);
                    return self.report(FindingKind::ModifierOnDrive { word }, item.range);
                }
                _ => self.surface_operand(major, item),
            },
            DriveItem::Label(name, range) => {
                self.report(FindingKind::Undefined { name: name.clone(), similar: Vec::new() }, *range);
                None
            }
        };
        let Some(drive) = drive else { return self.drop_pending() };
        let turn = turn_of(major.spelling());
        self.resolve_pending(major, turn, &drive);
        let Some((checks, feed)) = self.check_surfaces(major, &items[1..]) else { return };
        if let Some((rate, range)) = feed {
            self.feed(rate, range);
        }
        let implied = checks.is_empty();
        if implied && matches!(turn, Turn::Up | Turn::Down) {
            return self.report(FindingKind::ImpliedCheckVertical, major.range);
        }
        self.motion(MotionCommand::Drive { turn, drive, checks }, major.range);
        if implied {
            self.pending = Some(PendingDrive {
                record: self.output.records.len().saturating_sub(1),
                side: self.state.drive_side,
                origin: self.origin(major.range),
            });
        }
    }

    /// Gives up a waiting motion whose check surface is the victim of another mistake.
    fn drop_pending(&mut self) {
        if let Some(pending) = self.pending.take() {
            self.give_up(&pending);
        }
    }

    /// The drive surface of this statement is the check surface of the one that waits.
    fn resolve_pending(&mut self, major: Major<'_>, turn: Turn, drive: &NamedSurface) {
        let Some(pending) = &self.pending else { return };
        let Some(relation) = implied_relation(pending.side, turn) else {
            return self.break_pending(FindingKind::ImpliedCheckVertical, major.range);
        };
        let check = CheckSurface { relation, occurrence: 1, surface: drive.clone(), label: None };
        let index = pending.record;
        if let Some(record) = self.output.records.get_mut(index)
            && let RecordKind::Motion(command) = &mut record.kind
            && let MotionCommand::Drive { checks, .. } = &mut **command
        {
            checks.push(check);
        }
        self.pending = None;
    }

    /// Operands, with names that are no values taken as labels.
    fn drive_items(&mut self, arguments: &[Argument]) -> Option<Vec<DriveItem>> {
        let mut items = Vec::with_capacity(arguments.len());
        let mut complete = true;
        for (index, argument) in arguments.iter().enumerate() {
            if index > 1
                && let Argument::Expression(Expression::Reference(reference)) = argument
                && reference.subscript.is_none()
                && self.may_be_label(&reference.name.text, index, arguments)
            {
                items.push(DriveItem::Label(reference.name.text.clone(), reference.range));
                continue;
            }
            let mut values = Vec::with_capacity(1);
            complete &= self.operand(argument, &mut values).is_some();
            items.extend(values.into_iter().map(DriveItem::Value));
        }
        complete.then_some(items)
    }

    /// A name after a surface that has no value or is a label.
    fn may_be_label(&self, name: &str, index: usize, arguments: &[Argument]) -> bool {
        let after_surface = !matches!(arguments.get(index - 1), Some(Argument::Word(_)) | None);
        after_surface
            && matches!(self.look_up(name).map(|symbol| &symbol.meaning), None | Some(Meaning::Label))
    }

    /// `[mod,] [n,INTOF,] cs [,label]` once or twice, and a trailing feed rate.
    fn check_surfaces(
        &mut self,
        major: Major<'_>,
        items: &[DriveItem],
    ) -> Option<(Vec<CheckSurface>, Option<Feed>)> {
        let mut checks: Vec<CheckSurface> = Vec::new();
        let mut relation: Option<Relation> = None;
        let mut occurrence: Option<f64> = None;
        let mut feed = None;
        let mut position = 0;
        while let Some(item) = items.get(position) {
            let next = items.get(position + 1);
            position += 1;
            match item {
                DriveItem::Label(name, range) => self.check_label(&mut checks, name, *range)?,
                DriveItem::Value(value) => match &value.operand {
                    Operand::Word(word) if word.spelling == "INTOF" && occurrence.is_some() => {}
                    Operand::Word(word) => {
                        let Some(found) = relation_of(word.spelling).filter(|_| relation.is_none()) else {
                            let word = SmolStr::new_static(word.spelling);
                            let finding = FindingKind::RelationNotHere { word };
                            self.report_apt4(finding, APT4_CHECK_RELATION, value.range);
                            return None;
                        };
                        relation = Some(found);
                    }
                    Operand::Scalar(number) if is_intersection(next) => {
                        if *number < 1.0 || number.fract() != 0.0 {
                            let finding = FindingKind::OperandRange {
                                statement: SmolStr::new_static("INTOF"),
                                value: *number,
                                number: Some(129),
                            };
                            self.report(finding, value.range);
                            return None;
                        }
                        occurrence = Some(*number);
                    }
                    Operand::Scalar(rate) if next.is_none() && relation.is_none() => {
                        if self.is_numeric_label(&checks, *rate) {
                            self.numeric_label(major, &mut checks, *rate, value.range)?;
                        } else {
                            feed = Some((*rate, value.range));
                        }
                    }
                    Operand::Scalar(number) if relation.is_none() && !checks.is_empty() => {
                        self.numeric_label(major, &mut checks, *number, value.range)?;
                    }
                    _ => {
                        let surface = self.surface_operand(major, value)?;
                        #[expect(
                            clippy::cast_possible_truncation,
                            clippy::cast_sign_loss,
                            reason = "checked above; saturates"
                        )]
                        let occurrence = occurrence.take().map_or(1, |number| number as u32);
                        let relation = relation.take().unwrap_or(Relation::To);
                        checks.push(CheckSurface { relation, occurrence, surface, label: None });
                    }
                },
            }
        }
        if relation.is_some() || occurrence.is_some() {
            self.wrong_operand(major, Expected::Surface, Found::Nothing, 129, major.range);
            return None;
        }
        self.check_counts(major, &checks)?;
        Some((checks, feed))
    }

    /// With two check surfaces, a number after the second is its label and not a feed rate.
    fn is_numeric_label(&self, checks: &[CheckSurface], number: f64) -> bool {
        let whole = number >= 0.0 && number.fract() == 0.0;
        let first_has_label = checks.first().is_some_and(|check| check.label.is_some());
        whole
            && checks.len() == CHECK_SURFACES
            && first_has_label
            && checks.last().is_some_and(|c| c.label.is_none())
    }

    /// A number as the label of the last check surface. It must stand there as it is: what an expression comes to is no label.
    fn numeric_label(
        &mut self,
        major: Major<'_>,
        checks: &mut [CheckSurface],
        number: f64,
        range: TextRange,
    ) -> Option<()> {
        if !is_plain_number(major.arguments, range) {
            self.report(FindingKind::CheckLabelComputed, range);
            return None;
        }
        self.check_label(checks, &SmolStr::from(number.to_string()), range)
    }

    /// Puts a label to the last check surface.
    fn check_label(&mut self, checks: &mut [CheckSurface], name: &SmolStr, range: TextRange) -> Option<()> {
        let Some(check) = checks.last_mut().filter(|check| check.label.is_none()) else {
            self.report(FindingKind::CheckLabels, range);
            return None;
        };
        let label = normalised_label(name);
        check.label = Some(label.to_string());
        let origin = self.origin(range);
        self.mark_used(name);
        self.state.open_checks.insert(label.clone());
        self.output.transfers.push((label, origin));
        Some(())
    }

    /// At most two check surfaces; two need labels.
    fn check_counts(&mut self, major: Major<'_>, checks: &[CheckSurface]) -> Option<()> {
        if checks.len() > CHECK_SURFACES {
            let finding = FindingKind::SurfaceCount { found: checks.len(), limit: CHECK_SURFACES };
            self.report(finding, major.range);
            return None;
        }
        if checks.len() == CHECK_SURFACES && checks.iter().any(|check| check.label.is_none()) {
            self.report(FindingKind::CheckLabels, major.range);
            return None;
        }
        Some(())
    }
}

/// Where TRANTO stands: some systems write it between a check surface and its label.
fn transfer_word(arguments: &[Argument]) -> Option<TextRange> {
    arguments.iter().find_map(|argument| match argument {
        Argument::Word(word) if word.word.spelling == "TRANTO" => Some(word.range),
        _ => None,
    })
}

/// Whether the argument at a place is a number, and not a name or an expression that comes to one.
fn is_plain_number(arguments: &[Argument], place: TextRange) -> bool {
    arguments.iter().any(|argument| {
        matches!(argument, Argument::Expression(Expression::Number { range, .. }) if *range == place)
    })
}

/// Whether INTOF comes next.
fn is_intersection(next: Option<&DriveItem>) -> bool {
    matches!(next, Some(DriveItem::Value(item)) if item.word() == Some("INTOF"))
}

/// The direction word.
fn turn_of(word: &str) -> Turn {
    match word {
        "GOLFT" => Turn::Left,
        "GORGT" => Turn::Right,
        "GOBACK" => Turn::Back,
        "GOUP" => Turn::Up,
        "GODOWN" => Turn::Down,
        _ => Turn::Forward,
    }
}

/// The relation of an implied check surface, from the tool position held and the next motion; none if there can be none.
fn implied_relation(side: DriveSide, next: Turn) -> Option<Relation> {
    Some(match (side, next) {
        (_, Turn::Up | Turn::Down) => return None,
        (_, Turn::Forward | Turn::Back) => Relation::TangentToDrive,
        (DriveSide::On, Turn::Left | Turn::Right) => Relation::On,
        (DriveSide::Left, Turn::Left) | (DriveSide::Right, Turn::Right) => Relation::To,
        (DriveSide::Left, Turn::Right) | (DriveSide::Right, Turn::Left) => Relation::Past,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn implied_relations_follow_the_table() {
        use DriveSide as Side;
        let cases = [
            (Side::Left, Turn::Left, Some(Relation::To)),
            (Side::Left, Turn::Right, Some(Relation::Past)),
            (Side::Right, Turn::Right, Some(Relation::To)),
            (Side::Right, Turn::Left, Some(Relation::Past)),
            (Side::On, Turn::Left, Some(Relation::On)),
            (Side::On, Turn::Right, Some(Relation::On)),
            (Side::Left, Turn::Forward, Some(Relation::TangentToDrive)),
            (Side::On, Turn::Back, Some(Relation::TangentToDrive)),
            (Side::Left, Turn::Up, None),
        ];
        for (side, turn, expected) in cases {
            assert_eq!(implied_relation(side, turn), expected, "{side:?} {turn:?}");
        }
    }
}
