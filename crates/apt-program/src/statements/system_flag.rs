//! System flags: switches of the processors of old (language reference 7.10). Their forms are checked; what they switched
//! (listings of the inside of the system, storage sizes, plotters, the order of phases on tapes) does not exist here, or
//! is asked for by a command. Only PTONLY/1 switches something: the motion phase off.

use apt_syntax::{statement::Argument, vocabulary::WordClass};

use super::Major;
use crate::{
    evaluator::Evaluator,
    expression::{Item, Operand},
    finding::{Expected, FindingKind, Found},
    record::RecordKind,
};

/// APT III numbers: a wrong item in PTONLY, a DEBUG form, a wrong count, a word that does not belong here.
const POINTS_ONLY: u16 = 553;
const DEBUG_FORM: u16 = 22;
const COUNT: u16 = 129;
const WORD: u16 = 133;

/// The largest sum of the three tables of TUNEUP and the least size of the last, in words (language reference 1.10).
const TABLES_TOGETHER: f64 = 7200.0;
const LEAST_LAST_TABLE: f64 = 1300.0;

/// The operands that a flag takes.
enum Form {
    /// None at all.
    Bare,
    /// One of these words, or nothing where it says so.
    Words { words: &'static [&'static str], optional: bool },
    /// Pairs of numbers.
    Pairs,
    /// The three sizes of TUNEUP.
    Sizes,
    /// The restart number of PTONLY, with a record number after 3.
    Restart,
    /// DEBUG: perhaps SEC1 or SEC2, then ON or OFF.
    Debug,
    /// No form is documented.
    Any,
}

/// The form of a flag.
fn form(word: &str) -> Form {
    match word {
        "NOPOST" | "NOPLOT" => Form::Bare,
        "CLPRNT" => Form::Words { words: &["ON", "OFF", "OPTION"], optional: true },
        "CLTV" => Form::Words { words: &["OPTION"], optional: true },
        "DAC" | "SSPRT" | "SSTEST" | "TABPRT" | "LIBPRT" | "AVPRT" => {
            Form::Words { words: &["ON", "OFF"], optional: false }
        }
        "DYNDMP" => Form::Pairs,
        "TUNEUP" => Form::Sizes,
        "PTONLY" => Form::Restart,
        "DEBUG" => Form::Debug,
        _ => Form::Any,
    }
}

impl Evaluator<'_> {
    /// A system flag: its form is checked. Flags that APT III itself does not implement get its warning.
    pub(crate) fn system_flag(&mut self, major: Major<'_>) {
        match form(major.spelling()) {
            Form::Bare => {
                if major.slash {
                    self.report(FindingKind::PostBare { word: major.name() }, major.range);
                }
            }
            Form::Words { words, optional } => self.flag_word(major, words, optional),
            Form::Pairs => {
                if let Some(numbers) = self.flag_numbers(major)
                    && (numbers.is_empty() || !numbers.len().is_multiple_of(2))
                {
                    self.wrong_count(major, numbers.len(), "pairs of numbers", COUNT);
                }
            }
            Form::Sizes => self.table_sizes(major),
            Form::Restart => self.restart(major),
            Form::Debug => self.debug_flag(major),
            Form::Any => self.report(FindingKind::NoEffect { word: major.name() }, major.word.range),
        }
    }

    /// One word out of a list.
    fn flag_word(&mut self, major: Major<'_>, words: &[&str], optional: bool) {
        match major.arguments {
            [] if optional && !major.slash => {}
            [Argument::Word(word)] if words.contains(&word.word.spelling) => {}
            [] => self.wrong_operand(major, Expected::Word, Found::Nothing, COUNT, major.range),
            [_] if self.refuse_undefined_option(major) => {}
            [argument] => {
                let found = match argument {
                    Argument::Word(word) => Found::Word(word.word.spelling.into()),
                    _ => Found::Scalar,
                };
                self.wrong_operand(major, Expected::OnOrOff, found, WORD, argument.range());
            }
            several => self.wrong_count(major, several.len(), "1 word", COUNT),
        }
    }

    /// All operands as numbers.
    fn flag_numbers(&mut self, major: Major<'_>) -> Option<Vec<f64>> {
        let items = self.operands(major.arguments)?;
        self.scalars_of(major, &items, COUNT)
    }

    /// TUNEUP/i,j,k: nothing here has a fixed size.
    fn table_sizes(&mut self, major: Major<'_>) {
        let Some(numbers) = self.flag_numbers(major) else { return };
        let [symbols, codes, canonical] = *numbers.as_slice() else {
            return self.wrong_count(major, numbers.len(), "3 numbers", COUNT);
        };
        let together = symbols + codes + canonical;
        let wrong = (canonical < LEAST_LAST_TABLE)
            .then_some(canonical)
            .or_else(|| (together > TABLES_TOGETHER).then_some(together));
        if let Some(value) = wrong {
            self.report(FindingKind::Doubtful { statement: major.name(), value }, major.range);
        }
    }

    /// PTONLY/1: the motions are not computed. PTONLY/2 and PTONLY/3,n go on from the files of an earlier run, which are not
    /// kept.
    fn restart(&mut self, major: Major<'_>) {
        let Some(items) = self.operands(major.arguments) else { return };
        match items.iter().map(|item| &item.operand).collect::<Vec<_>>().as_slice() {
            [Operand::Scalar(1.0)] => {
                self.report(FindingKind::MotionSkipped, major.range);
                self.emit(RecordKind::SkipMotion, major.range);
            }
            [Operand::Scalar(2.0)] => {
                self.report(FindingKind::RestartNotAvailable { number: 2 }, major.range);
            }
            [Operand::Scalar(3.0), Operand::Scalar(_)] => {
                self.report(FindingKind::RestartNotAvailable { number: 3 }, major.range);
            }
            [Operand::Scalar(3.0)] => self.wrong_count(major, 1, "3 and a record number", COUNT),
            [Operand::Scalar(value)] => {
                let (statement, number) = (major.name(), Some(POINTS_ONLY));
                self.report(FindingKind::OperandRange { statement, value: *value, number }, major.range);
            }
            [Operand::Scalar(_), ..] => {
                self.wrong_count(major, items.len(), "1, 2, or 3 and a record number", POINTS_ONLY);
            }
            _ => {
                let found = items.first().map_or(Found::Nothing, Item::found);
                self.wrong_operand(major, Expected::Integer, found, POINTS_ONLY, major.range);
            }
        }
    }

    /// DEBUG/[SEC1|SEC2,]ON|OFF.
    fn debug_flag(&mut self, major: Major<'_>) {
        let spelling = |argument: &Argument| match argument {
            Argument::Word(word) => Some(word.word.spelling),
            _ => None,
        };
        let words: Option<Vec<&str>> = major.arguments.iter().map(spelling).collect();
        let fits = matches!(words.as_deref(), Some(["ON" | "OFF"] | ["SEC1" | "SEC2", "ON" | "OFF"]));
        if !fits {
            let found = match major.arguments.last() {
                None => Found::Nothing,
                Some(Argument::Word(word)) => Found::Word(word.word.spelling.into()),
                Some(_) => Found::Scalar,
            };
            self.wrong_operand(major, Expected::OnOrOff, found, DEBUG_FORM, major.range);
        }
    }

    /// PRINT in APT4 with the switch of a part of the system: PRINT/TABPRT,ON.
    pub(super) fn is_part_switch(arguments: &[Argument]) -> bool {
        matches!(arguments, [Argument::Word(part), Argument::Word(switch)]
            if part.word.class == WordClass::SystemFlag && matches!(switch.word.spelling, "ON" | "OFF"))
    }
}
