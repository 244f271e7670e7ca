//! The post-processor itself: takes the records in order and makes blocks.

mod arcs;
mod blocks;
mod expansion;
mod helix;
mod hole;
mod motion;
mod rotary_statement;
mod start;
mod statement;
mod tool;
mod turn;
mod turning;
mod work_offset;

use apt_cldata::record::{ClKind, ClRecord, ClWord, Units};
use apt_geometry::{
    Vec3,
    patience::{Patience, put_away},
    pieces::Pieces,
};
use smol_str::SmolStr;

use crate::{
    control::{Control, Values},
    finding::PostFindingKind,
    machine::{LinearAxis, MachineDefinition},
    tape::{PostOptions, Tape},
    words::{FeedMode, LengthUnit},
};

/// Millimetres in an inch.
pub(crate) const MILLIMETERS_PER_INCH: f64 = 25.4;
/// Cosine of the angle by which a tool axis may differ from the spindle's: about a thousandth of a degree.
const SPINDLE_AXIS_COSINE: f64 = 1.0 - 1.5e-10;

/// Makes the control tape of a program for a machine.
///
/// The tape is made also where something is found, with the faulty statement left out; [`Tape::is_ok`] says whether
/// it may be run.
pub fn post(records: &[ClRecord], machine: &MachineDefinition, options: &PostOptions) -> Tape {
    made(records, machine, options, Patience::default())
}

/// The same.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn post_until(
    records: &[ClRecord],
    machine: &MachineDefinition,
    options: &PostOptions,
    patience: Patience<'_>,
) -> Result<Tape, Cancelled> {
    let tape = made(records, machine, options, patience);
    if patience.was_over() {
        let parts = tape.blocks.len() + tape.findings.len();
        put_away(tape, parts);
        return Err(Cancelled);
    }
    Ok(tape)
}

/// The work was ended by the one who wanted it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// The tape up to the end, or to where who waits gives up.
fn made(
    records: &[ClRecord],
    machine: &MachineDefinition,
    options: &PostOptions,
    patience: Patience<'_>,
) -> Tape {
    let units = start::units(records, machine, options, patience);
    let mut engine = Engine::new(records, machine, options, &units, patience);
    engine.start(records);
    for (at, record) in records.iter().enumerate() {
        if patience.ends_after(1) {
            break;
        }
        engine.at = at;
        engine.record(record);
    }
    engine.finish();
    let Control { blocks, findings, .. } = engine.control;
    Tape { blocks: blocks.joined(patience), findings: findings.joined(patience), units: units.tape }
}

/// A feed rate in force, in tape units.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Feed {
    mode: FeedMode,
    value: f64,
    /// `FEDRAT/INVERS,AUTO`: the value is per minute and each block says its time.
    timed: bool,
}

impl Feed {
    /// Whether the value is an inverse time, which is no feed.
    fn is_time(self) -> bool {
        self.mode == FeedMode::Inverse && !self.timed
    }
}

/// The spindle.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Spindle {
    speed: Option<f64>,
    counterclockwise: bool,
    on: bool,
    maximum: Option<f64>,
}

/// One position of a run at feed rate, waiting to be fitted.
#[derive(Debug, Clone, Copy)]
struct RunPoint {
    position: Vec3,
    place: (u32, u32),
    /// Index of the circle that it lies on.
    circle: Option<usize>,
}

/// A circle record, as the part has it, in tape units.
#[derive(Debug, Clone, Copy)]
struct Circle {
    center: Vec3,
    axis: Vec3,
}

/// Cutter compensation that waits for the next motion in its plane.
#[derive(Debug, Clone, PartialEq)]
struct PendingCompensation {
    words: Vec<String>,
    place: (u32, u32),
}

struct Engine<'a> {
    patience: Patience<'a>,
    records: &'a [ClRecord],
    /// Index of the record that is being made.
    at: usize,
    control: Control<'a>,
    machine: &'a MachineDefinition,
    fit_points: bool,
    text_limit: usize,
    deep_breaks_chips: bool,
    /// Unit of the program and factor from it to the tape's.
    program_units: Units,
    scale: f64,
    /// The rotary axes, on a machine that has any.
    turning: Option<turning::Turning<'a>>,
    /// Where the tool is on the tape, as far as it is known.
    position: Option<Vec3>,
    /// Whether it may stand elsewhere, since blocks that may be skipped have come after it was last told where to go.
    skipped: bool,
    rapid: Option<(u32, u32)>,
    /// The axis that the RAPID in force lets move apart.
    rapid_axis: Option<LinearAxis>,
    feed: Option<Feed>,
    /// The feed before the inverse times of FEDRAT/INVERS, for when they end.
    feed_before_times: Option<Feed>,
    spindle: Spindle,
    spindle_reported: bool,
    feed_reported: bool,
    tool: Option<u32>,
    /// Statement that loads the first tool, until it is reached or reported.
    first_tool: Option<u32>,
    length_offset: u32,
    /// A tool change after which no motion has come yet, with the coolant code that rides on its first Z.
    approach: Option<String>,
    work_offset: work_offset::WorkOffset,
    /// DISPLY/OFF: PPRINT is not on the tape.
    messages_off: bool,
    coolant: bool,
    coolant_code: Option<String>,
    cutter_diameter: Option<f64>,
    /// Tolerances of the drive surface, once stated.
    intol: Option<f64>,
    outtol: Option<f64>,
    arc_tolerance: Option<f64>,
    run: Pieces<RunPoint>,
    circles: Pieces<Circle>,
    /// Circle of the motion record that comes next.
    next_circle: Option<usize>,
    /// A helix of the run that is being made whose block waits.
    helix: Option<helix::Helix>,
    /// Where the last one has led the control.
    led_to: Option<helix::Led>,
    compensation: Option<PendingCompensation>,
    /// The codes of the compensation in force.
    compensation_code: String,
    /// Whether the tape has switched compensation on: a motion has taken the code.
    compensating: bool,
    /// Whether the last CUTCOM switched compensation on.
    compensated: bool,
    cycle: Option<hole::Cycle>,
    suspended_cycle: Option<hole::Cycle>,
    /// A CYCLE with a mistake, whose holes are left out.
    refused_cycle: Option<hole::RefusedCycle>,
    /// Whether the last CYCLE with a type was one.
    was_refused: bool,
    /// Whether a CYCLE was asked for since the last CYCLE/OFF, also one that could not be carried out.
    cycle_asked: bool,
    clearance: Option<f64>,
    retracted_from: Option<f64>,
    shift: Vec3,
    moved: bool,
    /// The finding about what is left out for the tool's axis, until something can be carried out again.
    missing: Option<usize>,
    /// Whether a FROM has been seen.
    started: bool,
    ended: bool,
    closed: bool,
    after_fini_told: bool,
    named: bool,
    /// Its number, for the blocks at both ends.
    program: String,
    /// Whether a MACHIN has been seen.
    machine_named: bool,
}

impl<'a> Engine<'a> {
    fn new(
        records: &'a [ClRecord],
        machine: &'a MachineDefinition,
        options: &PostOptions,
        units: &start::UnitChoice,
        patience: Patience<'a>,
    ) -> Self {
        let unit = match units.tape {
            Units::Inches => MILLIMETERS_PER_INCH.recip(),
            Units::Millimeters => 1.0,
        };
        Engine {
            patience,
            records,
            at: 0,
            turning: turning::Turning::of(machine, unit),
            control: Control::new(machine, units.tape),
            machine,
            fit_points: options.fit_points.unwrap_or(machine.arc.fit_points),
            text_limit: options.text_limit,
            deep_breaks_chips: options.deep_breaks_chips,
            program_units: units.program,
            scale: units.scale(),
            position: None,
            skipped: false,
            rapid: None,
            rapid_axis: None,
            feed: None,
            feed_before_times: None,
            spindle: Spindle::default(),
            spindle_reported: false,
            feed_reported: false,
            tool: None,
            first_tool: None,
            length_offset: 0,
            approach: None,
            work_offset: work_offset::WorkOffset::Due,
            messages_off: false,
            coolant: false,
            coolant_code: None,
            cutter_diameter: None,
            intol: None,
            outtol: None,
            arc_tolerance: None,
            run: Pieces::default(),
            circles: Pieces::default(),
            next_circle: None,
            helix: None,
            led_to: None,
            compensation: None,
            compensation_code: machine.codes.compensation_off.clone().unwrap_or_default(),
            compensating: false,
            compensated: false,
            cycle: None,
            suspended_cycle: None,
            refused_cycle: None,
            was_refused: false,
            cycle_asked: false,
            clearance: None,
            retracted_from: None,
            shift: Vec3::zeros(),
            moved: false,
            missing: None,
            started: false,
            ended: false,
            closed: false,
            after_fini_told: false,
            named: false,
            program: String::new(),
            machine_named: false,
        }
    }

    fn record(&mut self, record: &ClRecord) {
        if !matches!(record.kind, ClKind::Motion { .. } | ClKind::Arc { .. } | ClKind::Control { .. }) {
            self.flush();
        }
        self.control.place = (record.isn, record.source);
        if self.closed && record.kind != ClKind::End {
            return self.after_fini();
        }
        match &record.kind {
            ClKind::Motion { from, points, .. } => self.motion(*from, points),
            ClKind::Arc { center, axis, .. } => {
                let (center, axis) = self.in_part((center + self.shift) * self.scale, *axis);
                self.circles.push(Circle { center, axis });
                self.next_circle = Some(self.circles.len() - 1);
            }
            ClKind::Control { word, arguments, .. } => self.parameter(word, arguments),
            ClKind::Text { word, text, .. } => self.text(word, text),
            ClKind::Postprocessor { word, arguments, .. } => self.word(word, arguments),
            ClKind::Units(units) => {
                if *units != self.program_units {
                    self.find(PostFindingKind::UnitsChanged);
                }
            }
            ClKind::MultipleAxes(_) => {}
            ClKind::End => self.close(),
        }
    }

    fn find(&mut self, kind: PostFindingKind) {
        self.control.find(kind);
    }

    fn finish(&mut self) {
        self.flush();
        if !self.closed {
            self.find(PostFindingKind::NoFini);
            self.close();
        }
    }

    /// FINI.
    fn close(&mut self) {
        if self.closed {
            return self.find(PostFindingKind::Repeated { word: "FINI".into() });
        }
        self.unused();
        self.left_on(&"FINI".into());
        if self.compensating && self.compensated {
            self.find(PostFindingKind::CompensationLeftOn { word: "FINI".into() });
        }
        self.end_program();
        self.closed = true;
        let machine = self.machine;
        let values = self.program_values();
        self.control.templates(&machine.templates.trailer, &values);
    }

    /// Something behind FINI, told once.
    fn after_fini(&mut self) {
        if !std::mem::replace(&mut self.after_fini_told, true) {
            self.find(PostFindingKind::AfterFini);
        }
    }

    /// The end of the program, once.
    fn end_program(&mut self) {
        if self.ended {
            return;
        }
        self.end_cycle();
        // Coolant that waits for a motion is not on, and is not needed any more.
        self.coolant &= self.approach.take().is_none();
        self.ended = true;
        let machine = self.machine;
        let off = |on: bool, code: &str| if on { code.to_owned() } else { String::new() };
        let values = Values::default()
            .text("coolant_off", off(self.coolant, &machine.codes.coolant_off))
            .text("spindle_off", off(self.spindle.on, &machine.codes.spindle_off))
            .number("Z", 0.0);
        self.follow_no_more(false);
        self.home_blocks(&machine.templates.program_end, values);
        self.spindle.on = false;
        self.coolant = false;
    }

    /// Reports what waits for a motion that does not come.
    fn unused(&mut self) {
        if let Some(place) = self.rapid.take() {
            self.find_at(place, PostFindingKind::RapidUnused);
        }
        if let Some(pending) = self.compensation.take() {
            self.find_at(pending.place, PostFindingKind::CompensationUnused);
        }
    }

    fn find_at(&mut self, place: (u32, u32), kind: PostFindingKind) {
        let here = std::mem::replace(&mut self.control.place, place);
        self.control.find(kind);
        self.control.place = here;
    }

    /// A length in millimetres as the tape has it.
    fn tape_length(&self, length: f64) -> f64 {
        if self.control.units == Units::Inches { length / MILLIMETERS_PER_INCH } else { length }
    }

    /// Factor from a stated unit to the tape's.
    fn unit_factor(&self, unit: LengthUnit) -> f64 {
        let inch = self.control.units == Units::Inches;
        match unit {
            LengthUnit::Program => self.scale,
            LengthUnit::Inch if inch => 1.0,
            LengthUnit::Inch => MILLIMETERS_PER_INCH,
            LengthUnit::Millimeter if inch => MILLIMETERS_PER_INCH.recip(),
            LengthUnit::Millimeter => 1.0,
        }
    }

    fn parameter(&mut self, word: &SmolStr, arguments: &[ClWord]) {
        let mut numbers = arguments.iter().filter_map(|argument| match argument {
            ClWord::Number(number) => Some(number.abs() * self.scale),
            ClWord::Word(_) => None,
        });
        let number = numbers.next();
        // The part surface's tolerance comes first, then the drive surface's; a missing one repeats the last.
        let drive = numbers.next().or(number);
        // A run made with one tolerance must not be fitted with another.
        if matches!(word.as_str(), "INTOL" | "OUTTOL" | "TOLER") {
            self.flush();
        }
        match (word.as_str(), number) {
            ("INTOL", Some(_)) => self.intol = drive,
            ("OUTTOL", Some(_)) => self.outtol = drive,
            ("TOLER", Some(_)) => (self.intol, self.outtol) = (Some(0.0), drive),
            ("CUTTER", Some(number)) => self.cutter_diameter = Some(number),
            _ => {}
        }
    }

    /// Counts a position or motion that is left out, or notes that this one is not.
    fn left_out(&mut self, missing: Option<PostFindingKind>) {
        use PostFindingKind as Kind;
        let Some(missing) = missing else {
            self.missing = None;
            return;
        };
        let before = self.missing.and_then(|finding| self.control.findings.get_mut(finding));
        let count = match (before.map(|finding| &mut finding.kind), &missing) {
            (Some(Kind::ToolAxis { motions, .. }), Kind::ToolAxis { .. }) => Some(motions),
            (Some(Kind::AxisUnreachable { positions, .. }), Kind::AxisUnreachable { .. })
            | (Some(Kind::RotaryLimit { positions, .. }), Kind::RotaryLimit { .. }) => Some(positions),
            _ => None,
        };
        match count {
            Some(count) => *count = count.saturating_add(1),
            None => {
                self.missing = Some(self.control.findings.len());
                self.find(missing);
            }
        }
    }
}
