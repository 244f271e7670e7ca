//! Drives Section 2: hands motion commands to the engine, collects CL items, keeps the transfer mode of Trumpy 1970.

mod feed;
mod milling;

use std::{
    sync::atomic::{AtomicU32, Ordering},
    time::Instant,
};

use apt_cldata::{
    edit::EditItem,
    record::{ClKind, ClPoint, ClRecord, ClWord, Units},
};
use apt_geometry::{
    canonical::Geometry,
    motion::{Delta, MotionCommand, PerRole},
    patience::Aside,
};
use apt_program::record::{Origin, PostArgument, Record, RecordKind};
use apt_syntax::dialect::DialectName;
use arelem::{
    cure::{Patience, Remedy, remedies},
    error::MotionWarning,
    section2::{Execution, Output, Restart, StartUpRule, State, execute},
    sequence::{CutSequence, PocketPath, ToolPosition},
    verify::{Evidence, VerifyError, verify, verify_pocket},
};
use smol_str::SmolStr;

use self::feed::Feeds;
use super::{Milling, Motion, RunFinding, RunFindingKind, Suppressed, earlier::Before};
use crate::{
    Cancel, Cancelled,
    memo::{Computation, MotionMemo},
    settings::Settings,
};

/// Class and subclass of the control records on the CL file (language reference 3.2).
mod code {
    pub(super) const CUT: [u16; 2] = [6000, 1];
    pub(super) const CALCULATION: [u16; 2] = [6000, 2];
    pub(super) const INTOL: [u16; 2] = [6000, 4];
    pub(super) const OUTTOL: [u16; 2] = [6000, 5];
    pub(super) const CUTTER: [u16; 2] = [6000, 6];
    /// The post-processor word FEDRAT.
    pub(super) const FEDRAT: u16 = 1009;
}

/// Positions in a CL record of POCKET, without and with tool axis: the buffer of Section 2 holds 240 numbers and is
/// written when less than four positions are free.
const POCKET_RECORD: [usize; 2] = [77, 39];
/// Angle, radians, from which on a tool turns: what rounding of a law of the axis is far below.
const LEAST_TURN: f64 = 1e-6;

/// Everything Section 2 leaves behind.
pub(super) struct SectionTwoOutput {
    pub(super) items: Aside<EditItem>,
    pub(super) origins: Aside<Origin>,
    pub(super) motions: Vec<Motion>,
    pub(super) milled: Vec<Milling>,
    pub(super) suppressed: Vec<Suppressed>,
    pub(super) findings: Vec<RunFinding>,
}

/// The state of the driver.
pub(super) struct Section2<'a> {
    memo: &'a MotionMemo,
    cancel: Cancel<'a>,
    state: State,
    output: SectionTwoOutput,
    /// Label of the record where processing goes on; records before it are passed over.
    transfer: Option<(SmolStr, Origin)>,
    /// First statement passed over in restart mode, how many so far and the last.
    skipped: Option<(Origin, u32, u32)>,
    tool: Option<ToolPosition>,
    /// The directed motion that led to where the tool is.
    before: Option<Before>,
    feeds: Feeds,
    /// Whether FEDRAT may have a distance; a CL file is what has been made of it.
    may_approach: bool,
    output_on: bool,
    /// Whether what DNTCUT keeps from the path is listed.
    lists_suppressed: bool,
    with_axis: bool,
    /// Whether a statement that tells a tool axis has it on the path also without MULTAX, as in CL files.
    axes_without_multax: bool,
    /// Whether it was told that the tool turns by the present law and positions have no axis.
    has_told_of_turning: bool,
    /// Most positions of the path, how many there are, and whether a statement would have made more.
    most_points: u64,
    points: u64,
    too_long: bool,
}

/// What would cure a failed command, and where the motion before it stands if that is one of the cures.
struct Cures {
    remedies: Vec<Remedy>,
    earlier: Option<Origin>,
}

impl<'a> Section2<'a> {
    /// Begins a run of so many records.
    pub(super) fn new(
        records: usize,
        settings: &Settings,
        dialect: DialectName,
        memo: &'a MotionMemo,
        cancel: Cancel<'a>,
    ) -> Self {
        let output = SectionTwoOutput {
            items: Vec::with_capacity(records).into(),
            origins: Vec::with_capacity(records).into(),
            motions: Vec::new(),
            milled: Vec::new(),
            suppressed: Vec::new(),
            findings: Vec::new(),
        };
        Self {
            memo,
            cancel,
            state: State { start_up: start_up_rule(dialect), ..State::new(settings.units.per_inch()) },
            output,
            transfer: None,
            skipped: None,
            tool: None,
            before: None,
            feeds: Feeds::default(),
            may_approach: dialect != DialectName::Cl,
            output_on: true,
            lists_suppressed: false,
            with_axis: false,
            axes_without_multax: dialect == DialectName::Cl,
            has_told_of_turning: false,
            most_points: settings.budget.points,
            points: 0,
            too_long: false,
        }
    }

    /// Takes one record of Section 1.
    pub(super) fn record(&mut self, record: &Record) -> Result<(), Cancelled> {
        if let Some((label, _)) = &self.transfer {
            if record.label.as_ref() == Some(label) {
                self.transfer = None;
            } else if !matches!(record.kind, RecordKind::End) {
                return Ok(());
            }
        }
        // What would come is not known to follow from what there is.
        if self.too_long && !matches!(record.kind, RecordKind::End) {
            return Ok(());
        }
        let source = self.source(&record.origin);
        match &record.kind {
            RecordKind::Motion(command) => return self.command(command, &record.origin, source),
            RecordKind::Regional(command) => return self.mill(command, &record.origin, source),
            RecordKind::Postprocessor { word, code, arguments } => {
                self.postprocessor(record.origin.isn, source, (word, *code), arguments);
            }
            RecordKind::Text { word, code, text } => {
                let kind = ClKind::Text { word: word.clone(), code: Some(*code), text: text.clone() };
                self.push(record.origin.isn, source, kind);
            }
            RecordKind::Transform(matrix) => {
                self.output.items.push(EditItem::Transform {
                    matrix: *matrix,
                    isn: record.origin.isn,
                    source,
                });
            }
            RecordKind::Index { number, end } => self.output.items.push(EditItem::Index {
                number: *number,
                end: *end,
                isn: record.origin.isn,
                source,
            }),
            RecordKind::Copy { number, step, count } => {
                self.output.items.push(EditItem::Copy {
                    number: *number,
                    step: *step,
                    count: *count,
                    isn: record.origin.isn,
                    source,
                });
            }
            RecordKind::Control { word, code, arguments } => {
                let arguments = cl_words(arguments);
                self.push(
                    record.origin.isn,
                    source,
                    ClKind::Control { word: word.clone(), code: *code, arguments },
                );
            }
            // Section 1 has said why there is no motion here: what follows from it is passed over as after a failure.
            RecordKind::Gap => {
                self.state.restart = Restart::Waiting;
                self.state.forward = None;
            }
            RecordKind::ListSuppressed => self.lists_suppressed = true,
            // With it nothing comes here.
            RecordKind::SkipMotion => {}
            RecordKind::Transfer(label) => self.transfer = Some((label.clone(), record.origin.clone())),
            RecordKind::End => {
                self.pending_transfer();
                self.push(record.origin.isn, source, ClKind::End);
            }
        }
        Ok(())
    }

    /// A word of the post-processor: UNITS is a record of its own, FEDRAT may ask for an approach.
    fn postprocessor(
        &mut self,
        isn: u32,
        source: u32,
        (word, code): (&SmolStr, u16),
        arguments: &[PostArgument],
    ) {
        if let Some(units) = units(word, arguments) {
            self.push(isn, source, ClKind::Units(units));
        } else if word == "FEDRAT" && self.may_approach {
            if let Some(arguments) = self.feeds.state(cl_words(arguments)) {
                self.feed(isn, source, arguments);
            }
        } else {
            let arguments = cl_words(arguments);
            let kind = ClKind::Postprocessor { word: word.clone(), code: Some(code), arguments };
            self.push(isn, source, kind);
        }
    }

    /// Closes the run.
    pub(super) fn finish(mut self) -> SectionTwoOutput {
        self.pending_transfer();
        self.end_of_skipping();
        self.output
    }

    fn command(&mut self, command: &MotionCommand, origin: &Origin, source: u32) -> Result<(), Cancelled> {
        self.parameter_record(command, origin.isn, source);
        let (execution, mut remedies, patience) = if is_costly(command) {
            let computed = {
                let (state, cancel) = (&self.state, self.cancel);
                self.memo.get_or_compute(state, command, || compute(state, command, cancel))
            };
            let computed = computed.ok_or(Cancelled)?;
            self.judge(&computed.evidence, origin);
            if matches!(computed.execution.output, Some(Output::Sequence(_) | Output::Pocket(_))) {
                self.output.motions.push(Motion { origin: origin.clone(), computed: computed.clone() });
            }
            (computed.execution.clone(), computed.remedies.clone(), computed.patience)
        } else {
            (execute(&self.state, command, &self.cancel), Vec::new(), Patience::after(0))
        };
        let earlier = self.earlier(command, &execution, &mut remedies, patience);
        if (self.cancel)() {
            return Err(Cancelled);
        }
        self.remember(command, &execution, origin);
        self.take(execution, Cures { remedies, earlier }, command, origin, source);
        Ok(())
    }

    /// Adds what in the motion before would cure a failure; gives the place of that motion then.
    fn earlier(
        &self,
        command: &MotionCommand,
        execution: &Execution,
        remedies: &mut Vec<Remedy>,
        patience: Patience,
    ) -> Option<Origin> {
        let (failure, before) = (execution.failure.as_ref()?, self.before.as_ref()?);
        let (memo, cancel) = (self.memo, &patience.limit(self.cancel));
        let mut carry_out = |state: &State, command: &MotionCommand| {
            if !is_costly(command) {
                return Some(execute(state, command, &cancel));
            }
            let computed = memo.get_or_compute(state, command, || compute(state, command, cancel));
            computed.map(|computed| computed.execution.clone())
        };
        let remedy = before.remedy(command, failure, &mut carry_out)?;
        remedies.push(remedy);
        Some(before.origin.clone())
    }

    /// Keeps the last directed motion as long as the tool stays where it ended. Comes before the state changes.
    fn remember(&mut self, command: &MotionCommand, execution: &Execution, origin: &Origin) {
        let before = self.before.take();
        self.before = match (command, &execution.output) {
            _ if execution.failure.is_some() => None,
            (MotionCommand::Drive { .. }, Some(Output::Sequence(_))) => {
                Some(Before::new(self.state.clone(), command, origin))
            }
            (_, None) => before.and_then(|before| before.and(command)),
            _ => None,
        };
    }

    fn judge(&mut self, evidence: &Option<Result<Evidence, VerifyError>>, origin: &Origin) {
        let kind = match evidence {
            Some(Ok(evidence)) if !evidence.verified => RunFindingKind::Unverified(evidence.clone()),
            Some(Err(error)) => RunFindingKind::NotJudged(error.clone()),
            _ => return,
        };
        self.output.findings.push(RunFinding { kind, origin: origin.clone() });
    }

    fn take(
        &mut self,
        execution: Execution,
        Cures { remedies, earlier }: Cures,
        command: &MotionCommand,
        origin: &Origin,
        source: u32,
    ) {
        self.state = execution.state;
        // Section 1 has told of a negative tolerance, where the statement stands.
        let is_news = |warning: &MotionWarning| !matches!(warning, MotionWarning::NegativeTolerance { .. });
        let warnings = execution.warnings.into_iter().filter(is_news).map(RunFindingKind::Warning);
        let failure = execution.failure.map(|failure| RunFindingKind::Failure { failure, remedies, earlier });
        for kind in warnings.chain(failure) {
            self.output.findings.push(RunFinding { kind, origin: origin.clone() });
        }
        match execution.output {
            Some(Output::Position(position)) => {
                self.end_of_skipping();
                let (from, name) = match command {
                    MotionCommand::From { name, .. } => (true, name.as_str()),
                    MotionCommand::GoTo { name, .. } => (false, name.as_str()),
                    // What the tool was moved along stands where the name of a point stands.
                    MotionCommand::GoDelta { delta: Delta::AlongAxis(_), .. } => (false, "TLAXIS"),
                    MotionCommand::GoDelta { name, .. } => (false, name.as_str()),
                    _ => (false, ""),
                };
                self.tool = Some(position);
                let under_multax = self.with_axis;
                self.with_axis |= self.axes_without_multax && tells_axis(command);
                self.positions(origin.isn, source, from, name, &[position]);
                self.with_axis = under_multax;
            }
            Some(Output::Sequence(sequence)) => {
                self.end_of_skipping();
                self.sequence(command, &sequence, origin, source);
            }
            Some(Output::Pocket(path)) => {
                self.end_of_skipping();
                self.pocket(&path, origin.isn, source);
            }
            Some(Output::Ignored) => {
                let (_, count, last) = self.skipped.get_or_insert_with(|| (origin.clone(), 0, origin.isn));
                *count += 1;
                *last = origin.isn;
            }
            None => {}
        }
    }

    fn sequence(&mut self, command: &MotionCommand, sequence: &CutSequence, origin: &Origin, source: u32) {
        let name = match command {
            MotionCommand::Drive { drive, .. } => drive.name.as_str(),
            MotionCommand::Start(surfaces) | MotionCommand::Offset(surfaces) => {
                surfaces.first().map_or("", |first| first.surface.name.as_str())
            }
            _ => "",
        };
        if let MotionCommand::Drive { drive, checks, .. } = command {
            self.tell_of_turning(sequence, origin);
            let circle = match &drive.geometry {
                Geometry::Circle(circle) | Geometry::Cylinder(circle) => Some(circle),
                _ => None,
            };
            self.directed(origin.isn, source, name, sequence, circle);
            let label = sequence
                .stop
                .as_ref()
                .and_then(|stop| checks.get(stop.index))
                .and_then(|check| check.label.as_ref());
            if let Some(label) = label {
                self.transfer = Some((SmolStr::new(label), origin.clone()));
            }
        }
        if !matches!(command, MotionCommand::Drive { .. }) {
            self.positions(origin.isn, source, false, name, &sequence.points);
        }
        self.tool = sequence.points.last().copied().or(self.tool);
    }

    /// Tells, once for each law of the axis, that a tool turns whose positions are put out without axis.
    fn tell_of_turning(&mut self, sequence: &CutSequence, origin: &Origin) {
        let is_seen = self.with_axis || self.axes_without_multax || !self.output_on;
        if is_seen || self.has_told_of_turning {
            return;
        }
        let turn = |at: &ToolPosition| {
            sequence.start.axis.cross(&at.axis).norm().atan2(sequence.start.axis.dot(&at.axis))
        };
        let angle = sequence.points.iter().map(turn).fold(0.0, f64::max);
        if angle > LEAST_TURN {
            self.has_told_of_turning = true;
            let kind = RunFindingKind::AxisNotPutOut { angle };
            self.output.findings.push(RunFinding { kind, origin: origin.clone() });
        }
    }

    /// A pocket: its feeds as FEDRAT, and its positions in records that are full from the outside.
    fn pocket(&mut self, path: &PocketPath, isn: u32, source: u32) {
        self.tool = path.positions().next_back().copied().or(self.tool);
        if !self.output_on {
            let positions: Vec<ToolPosition> = path.positions().copied().collect();
            return self.positions(isn, source, false, "POCKET", &positions);
        }
        let most = POCKET_RECORD[usize::from(self.with_axis)];
        let mut left = path.positions().count();
        for pass in &path.passes {
            self.feed(isn, source, vec![ClWord::Number(pass.feed)]);
            let mut points = pass.points.as_slice();
            while !points.is_empty() {
                let (record, rest) = points.split_at(((left - 1) % most + 1).min(points.len()));
                self.positions(isn, source, false, "POCKET", record);
                left -= record.len();
                points = rest;
            }
        }
    }

    fn positions(&mut self, isn: u32, source: u32, from: bool, name: &str, positions: &[ToolPosition]) {
        if positions.is_empty() || !(self.output_on || self.lists_suppressed) || self.too_long {
            return;
        }
        self.points += positions.len() as u64;
        if self.points > self.most_points {
            self.too_long = true;
            let origin = self.output.origins.get(source as usize).cloned();
            let kind = RunFindingKind::TooManyPoints { limit: self.most_points };
            self.output.findings.extend(origin.map(|origin| RunFinding { kind, origin }));
            return;
        }
        let with_axis = self.with_axis;
        let points =
            positions.iter().map(|at| ClPoint { position: at.tip, axis: at.axis, with_axis }).collect();
        if !self.output_on {
            let origin = self.output.origins.get(source as usize).cloned();
            let listed = origin.map(|origin| Suppressed { origin, name: SmolStr::new(name), points });
            return self.output.suppressed.extend(listed);
        }
        self.push(isn, source, ClKind::Motion { from, surface: SmolStr::new(name), points });
    }

    /// The CL record of a parameter statement, where it has one.
    fn parameter_record(&mut self, command: &MotionCommand, isn: u32, source: u32) {
        let kind = match command {
            MotionCommand::Cutter(numbers) => control("CUTTER", code::CUTTER, numbers),
            MotionCommand::InsideTolerance(values) => control("INTOL", code::INTOL, &per_role(values)),
            MotionCommand::OutsideTolerance(values) => control("OUTTOL", code::OUTTOL, &per_role(values)),
            MotionCommand::ForceIteration(force) => {
                control(if *force { "3DCALC" } else { "2DCALC" }, code::CALCULATION, &[])
            }
            MotionCommand::MultipleAxes(setting) => {
                (self.with_axis, self.has_told_of_turning) = (setting.unwrap_or(true), false);
                ClKind::MultipleAxes(self.with_axis)
            }
            MotionCommand::ToolAxis(_) => return self.has_told_of_turning = false,
            MotionCommand::Output(on) => {
                let resumed = *on && !self.output_on;
                self.output_on = *on;
                self.lists_suppressed = false;
                if let (true, Some(tool)) = (resumed, self.tool) {
                    self.positions(isn, source, false, "", &[tool]);
                }
                control(if *on { "CUT" } else { "DNTCUT" }, code::CUT, &[])
            }
            _ => return,
        };
        self.push(isn, source, kind);
    }

    fn push(&mut self, isn: u32, source: u32, kind: ClKind) {
        self.output.items.push(EditItem::Record(ClRecord { isn, source, kind }));
    }

    fn source(&mut self, origin: &Origin) -> u32 {
        if self.output.origins.last() != Some(origin) {
            self.output.origins.push(origin.clone());
        }
        self.output.origins.len() as u32 - 1
    }

    fn pending_transfer(&mut self) {
        if let Some((label, origin)) = self.transfer.take() {
            let kind = RunFindingKind::TransferPending { label: label.to_string() };
            self.output.findings.push(RunFinding { kind, origin });
        }
    }

    fn end_of_skipping(&mut self) {
        if let Some((origin, statements, last)) = self.skipped.take() {
            self.output
                .findings
                .push(RunFinding { kind: RunFindingKind::Skipped { statements, last }, origin });
        }
    }
}

/// Whether a motion gives the tool an axis.
fn tells_axis(command: &MotionCommand) -> bool {
    match command {
        MotionCommand::From { axis, .. } | MotionCommand::GoTo { axis, .. } => axis.is_some(),
        MotionCommand::GoDelta { delta: Delta::Vector(_, axis), .. } => axis.is_some(),
        _ => false,
    }
}

/// The rule for start-up motions that a dialect has.
pub(crate) fn start_up_rule(dialect: DialectName) -> StartUpRule {
    match dialect {
        DialectName::Apt4 => StartUpRule::Apt4,
        _ => StartUpRule::Apt3,
    }
}

/// Commands whose computation is worth remembering.
fn is_costly(command: &MotionCommand) -> bool {
    matches!(
        command,
        MotionCommand::Start(_)
            | MotionCommand::Offset(_)
            | MotionCommand::Drive { .. }
            | MotionCommand::Pocket(_)
    )
}

/// Computes and verifies; `None` when cancelled on the way.
fn compute(state: &State, command: &MotionCommand, cancel: Cancel<'_>) -> Option<Computation> {
    let begin = Instant::now();
    let asked = AtomicU32::new(0);
    let counted = || {
        asked.fetch_add(1, Ordering::Relaxed);
        cancel()
    };
    let execution = execute(state, command, &counted);
    let patience = Patience::after(asked.into_inner());
    let evidence = match &execution.output {
        Some(Output::Sequence(sequence)) if !cancel() => Some(verify(sequence, &cancel)),
        Some(Output::Pocket(path)) if !cancel() => Some(verify_pocket(path, &cancel)),
        _ => None,
    };
    let remedies = match &execution.failure {
        Some(failure) if !cancel() => remedies(state, command, failure, &patience.limit(cancel)),
        _ => Vec::new(),
    };
    let seconds = begin.elapsed().as_secs_f64();
    (!cancel()).then_some(Computation { execution, evidence, remedies, patience, seconds })
}

fn control(word: &str, code: [u16; 2], numbers: &[f64]) -> ClKind {
    let arguments = numbers.iter().map(|&number| ClWord::Number(number)).collect();
    ClKind::Control { word: SmolStr::new(word), code, arguments }
}

fn per_role(values: &PerRole) -> [f64; 4] {
    [values.part, values.drive, values.check[0], values.check[1]]
}

/// The unit that UNITS/… names, where a CL file has a record for it.
fn units(word: &str, arguments: &[PostArgument]) -> Option<Units> {
    match (word, arguments) {
        ("UNITS", [PostArgument::Word(unit, _)]) => match unit.as_str() {
            "MM" => Some(Units::Millimeters),
            "INCH" | "INCHES" | "IN" => Some(Units::Inches),
            _ => None,
        },
        _ => None,
    }
}

/// A canonical form goes into the record as its numbers.
fn cl_words(arguments: &[PostArgument]) -> Vec<ClWord> {
    let mut words = Vec::with_capacity(arguments.len());
    for argument in arguments {
        match argument {
            PostArgument::Number(number) => words.push(ClWord::Number(*number)),
            PostArgument::Word(word, _) => words.push(ClWord::Word(word.clone())),
            PostArgument::Text(text) => words.push(ClWord::Word(text.clone())),
            PostArgument::Geometry(geometry) => {
                words.extend(geometry.canonical_values().into_iter().map(ClWord::Number));
            }
        }
    }
    words
}
