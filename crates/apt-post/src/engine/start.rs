//! What has to be known before the first block: units, part name, program number.

use apt_cldata::record::{ClKind, ClRecord, ClWord, POSITIONS_A_UNIT, Units};
use apt_geometry::patience::Patience;

use super::{Engine, MILLIMETERS_PER_INCH, work_offset::WorkOffset};
use crate::{
    control::Values,
    machine::{MachineDefinition, OutputUnits},
    tape::PostOptions,
};

/// Program number of a part whose name has none, and the largest that four-digit controls take.
const DEFAULT_PROGRAM: u32 = 1;
const LARGEST_PROGRAM: u32 = 9999;

/// Unit of the program and of the tape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct UnitChoice {
    pub(super) program: Units,
    pub(super) tape: Units,
}

impl UnitChoice {
    /// Factor from program lengths to tape lengths.
    pub(super) fn scale(self) -> f64 {
        match (self.program, self.tape) {
            (Units::Inches, Units::Millimeters) => MILLIMETERS_PER_INCH,
            (Units::Millimeters, Units::Inches) => MILLIMETERS_PER_INCH.recip(),
            _ => 1.0,
        }
    }
}

/// The program's UNITS; without it the unit of its first feed rate; without that the caller's default.
pub(super) fn units(
    records: &[ClRecord],
    machine: &MachineDefinition,
    options: &PostOptions,
    patience: Patience<'_>,
) -> UnitChoice {
    let stated = first(records, patience, |record| match record.kind {
        ClKind::Units(units) => Some(units),
        _ => None,
    });
    let program = stated.or_else(|| first(records, patience, feed_units)).unwrap_or(options.default_units);
    let tape = match machine.units {
        OutputUnits::Program => program,
        OutputUnits::Mm => Units::Millimeters,
        OutputUnits::Inch => Units::Inches,
    };
    UnitChoice { program, tape }
}

/// The first thing that some records tell; none where who waits gives up before.
fn first<'a, T>(
    records: &'a [ClRecord],
    patience: Patience<'_>,
    told: impl Fn(&'a ClRecord) -> Option<T>,
) -> Option<T> {
    let mut pieces = records.chunks(POSITIONS_A_UNIT).take_while(|_| !patience.ends_after(1));
    pieces.find_map(|records| records.iter().find_map(&told))
}

fn feed_units(record: &ClRecord) -> Option<Units> {
    let ClKind::Postprocessor { word, arguments, .. } = &record.kind else { return None };
    if word != "FEDRAT" && word != "CYCLE" {
        return None;
    }
    arguments.iter().find_map(|argument| match argument {
        ClWord::Word(word) if word == "IPM" || word == "IPR" => Some(Units::Inches),
        ClWord::Word(word) if word == "MMPM" || word == "MMPR" => Some(Units::Millimeters),
        _ => None,
    })
}

impl Engine<'_> {
    /// The first blocks.
    pub(super) fn start(&mut self, records: &[ClRecord]) {
        let name = first(records, self.patience, |record| match &record.kind {
            ClKind::Text { word, text, .. } if word == "PARTNO" => Some((record, text.trim())),
            _ => None,
        });
        if let Some((record, _)) = name {
            self.control.place = (record.isn, record.source);
        }
        self.first_tool = first(records, self.patience, |record| loads_tool(record).then_some(record.isn));
        let text = name.map_or("", |(_, text)| text);
        self.program = program_number(text).to_string();
        let values = self.program_values();
        let machine = self.machine;
        for template in &machine.templates.program_start {
            if template.contains("{partno}") {
                if !text.is_empty() {
                    self.control.remark(&template.replace("{partno}", "{text}"), text);
                }
            } else {
                self.control.template(template, &values);
            }
        }
    }

    /// A motion behind END: the control was reset, perhaps with G91 in force, and the program needs an end again.
    pub(super) fn restart(&mut self) {
        self.ended = false;
        self.position = None;
        self.work_offset = WorkOffset::Due;
        self.control.forget_all();
        let machine = self.machine;
        self.compensation_code = machine.codes.compensation_off.clone().unwrap_or_default();
        let values = self.program_values();
        // The frame of the program stays.
        let again = |template: &&String| template.contains("{unit}") && !template.contains("{program}");
        for template in machine.templates.program_start.iter().filter(again) {
            self.control.template(template, &values);
        }
    }

    /// What the blocks at both ends of a program have to say of it.
    pub(super) fn program_values(&self) -> Values {
        Values::default().text("unit", self.unit_code()).text("program", self.program.clone())
    }

    /// The code of the unit of the tape.
    fn unit_code(&self) -> String {
        let codes = &self.machine.codes;
        match self.control.units {
            Units::Inches => codes.inch.clone(),
            Units::Millimeters => codes.millimeter.clone(),
        }
    }
}

/// Whether a record puts a tool into the spindle.
fn loads_tool(record: &ClRecord) -> bool {
    let ClKind::Postprocessor { word, arguments, .. } = &record.kind else { return false };
    match word.as_str() {
        "LOADTL" | "LOAD" | "TURRET" => true,
        // TOOLNO/ADJUST chooses an offset only.
        "TOOLNO" => !arguments.iter().any(|item| matches!(item, ClWord::Word(word) if word == "ADJUST")),
        _ => false,
    }
}

/// The first whole number in the part's name that a control takes as program number.
fn program_number(name: &str) -> u32 {
    name.split(|c: char| !c.is_ascii_digit())
        .filter_map(|digits| digits.parse().ok())
        .find(|number| (1..=LARGEST_PROGRAM).contains(number))
        .unwrap_or(DEFAULT_PROGRAM)
}
