//! Path parameters and path control: CUTTER, tolerances, limits, switches (language reference 6.5, 6.7, 6.8).

use apt_geometry::{
    cutter::Disk,
    motion::{MotionCommand, PerRole, RoleDisk},
};
use apt_syntax::{
    statement::{Argument, Expression},
    vocabulary,
};
use smol_str::SmolStr;

use super::Major;
use crate::{
    evaluator::Evaluator,
    expression::{Item, Items},
    finding::{Expected, FindingKind, Found},
    record::{PostArgument, RecordKind},
};

impl Evaluator<'_> {
    /// CUTTER with 1, 2 or 7 numbers, or CUTTER/OPTION.
    pub(crate) fn cutter(&mut self, major: Major<'_>) {
        const EXPECTED: &str = "1, 2 or 7";
        let Some(items) = self.operands_of(major, EXPECTED, 129) else { return };
        if items.first().and_then(|item| item.word()) == Some("OPTION") {
            return self.disk(major, &items);
        }
        let Some(values) = self.scalars_of(major, &items, 129) else { return };
        match values.len() {
            1 | 2 | 7 => {}
            // CL files of CAM systems give any number of values; there is no profile of which they could be the numbers.
            _ if self.is_cl() => return self.control(major, &items, [6000, 6]),
            _ => return self.wrong_count(major, values.len(), EXPECTED, 129),
        }
        self.motion(MotionCommand::Cutter(values), major.range);
    }

    /// CUTTER/OPTION: a disk that replaces the cutter for the part surface (1) or the drive surface (2).
    fn disk(&mut self, major: Major<'_>, items: &Items) {
        const EXPECTED: &str = "OPTION, 1 or 2, and a radius and height or OFF";
        let numbers: Vec<f64> = items.iter().skip(1).map_while(Item::scalar).collect();
        let off = items.get(2).is_some_and(|item| item.word() == Some("OFF"));
        let out_of_range =
            |value: f64| FindingKind::OperandRange { statement: major.name(), value, number: Some(129) };
        let disk = match *numbers.as_slice() {
            [role, ..] if role != 1.0 && role != 2.0 => return self.report(out_of_range(role), major.range),
            [_, radius, _] if items.len() == 4 && radius < 0.0 => {
                return self.report(out_of_range(radius), major.range);
            }
            [role, radius, height] if items.len() == 4 => {
                Some(RoleDisk { part: role == 1.0, disk: Disk { radius, height } })
            }
            [_] if off && items.len() == 3 => None,
            _ => return self.wrong_count(major, items.len(), EXPECTED, 129),
        };
        self.control(major, items, [6000, 6]);
        self.motion(MotionCommand::Disk(disk), major.range);
    }

    /// INTOL, OUTTOL, TOLER and THICK: missing values repeat the last one.
    pub(crate) fn per_role(&mut self, major: Major<'_>) {
        const EXPECTED: &str = "1 to 4";
        let Some(items) = self.operands_of(major, EXPECTED, 129) else { return };
        let Some(values) = self.scalars_of(major, &items, 129) else { return };
        let (Some(first), 1..=4) = (values.first().copied(), values.len()) else {
            return self.wrong_count(major, values.len(), EXPECTED, 129);
        };
        let last = values.last().copied().unwrap_or(first);
        let value = |index: usize| values.get(index).copied().unwrap_or(last);
        let roles = PerRole { part: first, drive: value(1), check: [value(2), value(3)] };
        let is_thickness = major.spelling() == "THICK";
        if !is_thickness && let Some(negative) = values.iter().find(|value| **value < 0.0) {
            self.report(FindingKind::Doubtful { statement: major.name(), value: *negative }, major.range);
        }
        match major.spelling() {
            "INTOL" => self.motion(MotionCommand::InsideTolerance(roles), major.range),
            "OUTTOL" => self.motion(MotionCommand::OutsideTolerance(roles), major.range),
            "THICK" => self.motion(MotionCommand::Thickness(roles), major.range),
            _ => {
                self.motion(MotionCommand::OutsideTolerance(roles), major.range);
                self.motion(MotionCommand::InsideTolerance(PerRole::all(0.0)), major.range);
            }
        }
    }

    /// MAXDP and NUMPTS.
    pub(crate) fn limit(&mut self, major: Major<'_>) {
        let Some(items) = self.operands_of(major, "1", 129) else { return };
        let Some(values) = self.scalars_of(major, &items, 129) else { return };
        let [value] = *values.as_slice() else { return self.wrong_count(major, values.len(), "1", 129) };
        let is_step = major.spelling() == "MAXDP";
        if value <= 0.0 || (!is_step && value < 1.0) {
            let finding = FindingKind::OperandRange { statement: major.name(), value, number: None };
            return self.report(finding, major.range);
        }
        if is_step {
            return self.motion(MotionCommand::MaximumStep(value), major.range);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive; saturates")]
        self.motion(MotionCommand::MaximumPoints(value as u32), major.range);
    }

    /// CUT, DNTCUT, 2DCALC, 3DCALC, NDTEST, AUTOPS, NOPS, MULTAX and GOUGCK.
    pub(crate) fn path_control(&mut self, major: Major<'_>) {
        if matches!(major.spelling(), "DNTCUT" | "GOUGCK" | "MULTAX") && self.refuse_undefined_option(major) {
            return;
        }
        let Some(items) = self.operands(major.arguments) else { return };
        let words: Option<Vec<&str>> = items.iter().map(|item| item.word()).collect();
        let command = match (major.spelling(), words.as_deref()) {
            ("CUT", Some([])) => MotionCommand::Output(true),
            ("DNTCUT", Some([] | ["PRINT"])) => MotionCommand::Output(false),
            ("2DCALC" | "NDTEST", Some([])) => MotionCommand::ForceIteration(false),
            ("3DCALC", Some([])) => MotionCommand::ForceIteration(true),
            ("AUTOPS", Some([])) => MotionCommand::AutomaticPartSurface,
            ("NOPS", Some([])) => MotionCommand::NoPartSurface,
            ("GOUGCK", Some(["ON"])) => MotionCommand::GougeCheck(true),
            ("GOUGCK", Some(["OFF"])) => MotionCommand::GougeCheck(false),
            ("MULTAX", Some([])) => {
                self.state.axes_for_good = true;
                self.state.axes_on = true;
                MotionCommand::MultipleAxes(None)
            }
            // After plain MULTAX the other forms have no effect (language reference 6.9).
            ("MULTAX", Some(["ON" | "OFF"])) if self.state.axes_for_good => return,
            ("MULTAX", Some([switch @ ("ON" | "OFF")])) => {
                self.state.axes_on = *switch == "ON";
                MotionCommand::MultipleAxes(Some(self.state.axes_on))
            }
            ("MULTAX" | "GOUGCK", _) => {
                let found = items.first().map_or(Found::Nothing, |item| item.found());
                return self.wrong_operand(major, Expected::OnOrOff, found, 132, major.range);
            }
            _ => return self.report(FindingKind::PostBare { word: major.name() }, major.range),
        };
        let lists = command == MotionCommand::Output(false) && !items.is_empty();
        self.motion(command, major.range);
        if lists {
            self.emit(RecordKind::ListSuppressed, major.range);
        }
    }

    /// Where the first operand is a name without a value, and no array's, in a statement that takes words: tells so.
    pub(crate) fn refuse_undefined_option(&mut self, major: Major<'_>) -> bool {
        let Some(Argument::Expression(Expression::Reference(reference))) = major.arguments.first() else {
            return false;
        };
        if reference.subscript.is_some() || !matches!(self.found_name(&reference.name.text), Found::Nothing) {
            return false;
        }
        let words = vocabulary::words().iter().filter(|word| word.used_in.contains(&major.spelling()));
        let similar = self.names_like(&reference.name.text, words.map(|word| word.spelling));
        let (statement, name) = (major.name(), reference.name.text.clone());
        self.report(FindingKind::UndefinedOption { statement, name, similar }, reference.range);
        true
    }

    /// DMILL and BEVELS: the translator takes one word and makes a record, to which the motion phase of APT III gives no
    /// meaning (language reference 6.8).
    pub(crate) fn accepted_control(&mut self, major: Major<'_>) {
        let (subclass, words): (u16, &[&str]) = match major.spelling() {
            "DMILL" => (11, &["DSTAN", "PSTAN", "NOMORE"]),
            _ => (2, &["ON", "OFF"]),
        };
        let Some(items) = self.operands_of(major, "1", 132) else { return };
        match items.as_slice() {
            [item] if item.word().is_some_and(|word| words.contains(&word)) => {
                self.report(FindingKind::NoEffect { word: major.name() }, major.word.range);
                self.control(major, &items, [6000, subclass]);
            }
            [item] => {
                let number = if item.word().is_some() { 133 } else { 132 };
                let expected = if words.len() == 2 { Expected::OnOrOff } else { Expected::Word };
                self.wrong_operand(major, expected, item.found(), number, item.range);
            }
            _ => self.wrong_count(major, items.len(), "1", 132),
        }
    }

    /// A control record of words and numbers.
    pub(crate) fn control(&mut self, major: Major<'_>, items: &[Item], code: [u16; 2]) {
        let mut arguments = Vec::with_capacity(items.len());
        for item in items {
            match (item.scalar(), item.word()) {
                (Some(number), _) => arguments.push(PostArgument::Number(number)),
                (_, Some(word)) => {
                    let code = crate::statements::postprocessor::minor_code(word);
                    arguments.push(PostArgument::Word(SmolStr::new_static(word), code));
                }
                _ => return self.wrong_operand(major, Expected::ScalarOrWord, item.found(), 132, item.range),
            }
        }
        self.emit(RecordKind::Control { word: major.name(), code, arguments }, major.range);
    }
}
