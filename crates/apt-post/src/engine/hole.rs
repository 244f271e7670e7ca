//! CYCLE: canned cycles of the control, and their expansion into moves where it has none.

use apt_cldata::record::ClWord;
use apt_geometry::Vec3;
use smol_str::SmolStr;

use super::{Engine, motion::AXES};
use crate::{
    control::{Values, Word},
    finding::PostFindingKind,
    machine::CycleTemplate,
    words::{Arguments, CycleFeed, FeedMode, LengthUnit, Retract, cycle_order, feed_unit},
};

/// Part by which the feed of a tap may differ from pitch times speed.
const TAP_FEED_FRACTION: f64 = 0.01;
/// Most passes into which a hole is expanded.
const MOST_PASSES: u32 = 10_000;
/// Gap left above the last depth when a peck comes back, in millimetres.
const PECK_GAP_MM: f64 = 0.25;
const SECONDS_PER_MINUTE: f64 = 60.0;
const MILLISECONDS_PER_SECOND: f64 = 1000.0;

/// A move to a position without a hole, which ends the cycle.
const MOVES_AND_ENDS: &str = "MILL";
/// What stands in the place of a type and makes no holes: how cycles are written, and how high the tool goes between them.
const WITHOUT_HOLES: [&str; 3] = [MOVES_AND_ENDS, "AUTO", "AVOID"];

/// A cycle in force. Lengths in tape units.
#[derive(Debug, Clone)]
pub(super) struct Cycle {
    /// The word of the statement, for messages.
    word: SmolStr,
    /// The cycle's name in the machine definition.
    name: String,
    depth: f64,
    clearance: f64,
    retract: Retract,
    feed: Option<f64>,
    /// Whether the statement names no feed: then it is the one in force at each hole.
    feed_in_force: bool,
    step: Option<f64>,
    dwell: f64,
    pitch: Option<f64>,
    /// What the control has in force, once it is in the cycle.
    open: Option<Open>,
    holes: usize,
    place: (u32, u32),
}

/// A CYCLE that nothing can be made of. The positions that follow are tops of holes, which are no way to go at feed rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct RefusedCycle {
    place: (u32, u32),
    holes: usize,
}

/// What a control that is in a cycle goes by.
#[derive(Debug, Clone, Copy)]
struct Open {
    /// Top of the hole.
    top: f64,
    feed: Option<f64>,
}

impl Engine<'_> {
    /// The CYCLE statement.
    pub(super) fn cycle_statement(&mut self, arguments: &Arguments<'_>) {
        match arguments.items.first() {
            Some(ClWord::Word(word)) if word == "OFF" || word == "NOMORE" => {
                // Patterns with AVOID say CYCLE/NOMORE whether a cycle is on or not.
                if !std::mem::take(&mut self.cycle_asked) && self.cycle.is_none() && word == "OFF" {
                    self.find(PostFindingKind::NothingOn { word: arguments.word.clone() });
                }
                return self.end_cycle();
            }
            Some(ClWord::Word(word)) if word == "ON" => {
                self.end_refused();
                // Holes of a cycle that could not be made are not those of the one before it.
                let resumed = self.suspended_cycle.clone().filter(|_| !self.was_refused);
                match resumed {
                    Some(cycle) => self.cycle = Some(Cycle { open: None, holes: 0, ..cycle }),
                    None => {
                        self.find(arguments.missing("a cycle before it"));
                        self.refuse_cycle();
                    }
                }
                return;
            }
            Some(ClWord::Word(word)) if WITHOUT_HOLES.contains(&word.as_str()) => {
                if word == MOVES_AND_ENDS {
                    self.end_cycle();
                }
                let (word, argument) = (arguments.word.clone(), word.clone());
                return self.find(PostFindingKind::UnknownArgument { word, argument });
            }
            _ => {}
        }
        self.cycle_asked = true;
        self.cycle = self.new_cycle(arguments);
        self.was_refused = self.cycle.is_none();
        if self.was_refused {
            self.refuse_cycle();
        }
    }

    fn refuse_cycle(&mut self) {
        self.refused_cycle = Some(RefusedCycle { place: self.control.place, holes: 0 });
    }

    /// The cycle that a statement asks for, behind the one before; none where it is told why there is none.
    fn new_cycle(&mut self, arguments: &Arguments<'_>) -> Option<Cycle> {
        self.end_cycle();
        let order = match cycle_order(arguments) {
            Ok(order) => order,
            Err(kind) => {
                self.find(kind);
                return None;
            }
        };
        if let Some(place) = self.rapid.take() {
            self.find_at(place, PostFindingKind::RapidUnused);
        }
        let Some(name) = self.machine.cycle_words.get(order.kind.as_str()).cloned() else {
            let (word, argument) = (arguments.word.clone(), order.kind.clone());
            self.find(PostFindingKind::UnknownArgument { word, argument });
            return None;
        };
        let scale = self.scale;
        let Some(depth) = order.depth.map(|depth| depth * scale) else {
            self.find(arguments.missing("DEPTH"));
            return None;
        };
        let before = self.suspended_cycle.as_ref().map(|cycle| cycle.clearance);
        let Some(clearance) = order.clearance.map(|clearance| clearance * scale).or(before) else {
            self.find(arguments.missing("RAPTO"));
            return None;
        };
        if depth <= 0.0 || depth.is_nan() {
            let word = arguments.word.clone();
            self.find(PostFindingKind::BadValue { word, argument: "DEPTH".into(), value: depth });
            return None;
        }
        let step = order.step.map(|step| step * scale).filter(|step| *step > 0.0);
        let pecks = matches!(name.as_str(), "peck" | "chipbreak");
        let step = match step {
            Some(step) if step < depth => Some(step),
            Some(step) => {
                self.find(PostFindingKind::StepNotLessThanDepth { step, depth });
                Some(depth)
            }
            None if pecks => {
                self.find(arguments.missing("STEP"));
                return None;
            }
            None => None,
        };
        let (feed, pitch) = self.cycle_feed(arguments, order.feed, name == "tap")?;
        let dwell = match order.dwell {
            Some((turns, true)) => match self.spindle.speed {
                Some(speed) if speed > 0.0 => turns / speed * SECONDS_PER_MINUTE,
                _ => {
                    self.find(PostFindingKind::NoSpindleSpeed);
                    return None;
                }
            },
            Some((seconds, false)) => seconds,
            None => 0.0,
        };
        let retract = match order.retract {
            Retract::Initial => Retract::Initial,
            Retract::Above(height) => Retract::Above(height * scale),
        };
        let place = self.control.place;
        let word = order.kind;
        Some(Cycle {
            word,
            name,
            depth,
            clearance,
            retract,
            feed,
            feed_in_force: order.feed.is_none(),
            step,
            dwell,
            pitch,
            open: None,
            holes: 0,
            place,
        })
    }

    /// What the tool goes in a minute at the feed in force; none of an inverse time, which tells nothing of a hole.
    fn feed_in_force(&self) -> Option<f64> {
        let feed = self.feed?;
        match feed.mode {
            FeedMode::PerMinute => Some(feed.value),
            FeedMode::PerRevolution => self.spindle.speed.map(|speed| speed * feed.value),
            FeedMode::Inverse => feed.timed.then_some(feed.value),
        }
    }

    /// Feed per minute and pitch of a cycle; none when the statement has to be left out.
    fn cycle_feed(
        &mut self,
        arguments: &Arguments<'_>,
        feed: Option<CycleFeed>,
        tap: bool,
    ) -> Option<(Option<f64>, Option<f64>)> {
        let speed = self.spindle.speed.filter(|speed| *speed > 0.0);
        let current = self.feed_in_force();
        let (rate, pitch) = match feed {
            None => (current, None),
            Some(CycleFeed::ThreadsPerInch(threads)) if threads > 0.0 => {
                let pitch = self.unit_factor(LengthUnit::Inch) / threads;
                let rate = speed.map(|speed| speed * pitch);
                if let (Some(feed), Some(speed), Some(rate)) = (current, speed, rate)
                    && tap
                    && (feed - rate).abs() > TAP_FEED_FRACTION * rate
                {
                    self.find(PostFindingKind::TapFeed { feed, pitch, speed });
                }
                (rate, Some(pitch))
            }
            Some(CycleFeed::ThreadsPerInch(value)) => {
                let word = arguments.word.clone();
                self.find(PostFindingKind::BadValue { word, argument: "TPI".into(), value });
                return None;
            }
            Some(CycleFeed::Rate(value, mode, unit)) => {
                if value <= 0.0 || value.is_nan() {
                    self.find(PostFindingKind::FeedNotPositive { value });
                    return None;
                }
                let words = arguments.items.iter().find_map(|item| match item {
                    ClWord::Word(word) if feed_unit(word).is_some() => Some(word),
                    _ => None,
                });
                if let Some(word) = words.cloned() {
                    self.check_unit(&word, unit);
                }
                let value = value * self.unit_factor(unit);
                match mode {
                    FeedMode::PerMinute => (Some(value), None),
                    FeedMode::PerRevolution => (speed.map(|speed| speed * value), Some(value)),
                    FeedMode::Inverse => {
                        let (word, argument) = (arguments.word.clone(), "INVERS".into());
                        self.find(PostFindingKind::UnknownArgument { word, argument });
                        return None;
                    }
                }
            }
        };
        if feed.is_some() && rate.is_none() {
            self.find(PostFindingKind::FeedPerRevolutionWithoutSpindle);
            return None;
        }
        let pitch = pitch.or_else(|| Some(rate? / speed?));
        if tap && pitch.is_none() {
            self.find(arguments.missing("TPI"));
            return None;
        }
        Some((rate, pitch))
    }

    /// CYCLE/OFF, and whatever ends a cycle.
    pub(super) fn end_cycle(&mut self) {
        self.end_refused();
        let Some(cycle) = self.cycle.take() else { return };
        if cycle.holes == 0 {
            self.find_at(cycle.place, PostFindingKind::CycleWithoutPoints);
        }
        self.cancel(&cycle);
        self.suspended_cycle = Some(cycle);
    }

    /// Tells what a CYCLE with a mistake has left out.
    fn end_refused(&mut self) {
        if let Some(RefusedCycle { place, holes: holes @ 1.. }) = self.refused_cycle.take() {
            self.find_at(place, PostFindingKind::HolesLeftOut { holes });
        }
    }

    /// Leaves positions out that follow a CYCLE with a mistake; whether they do.
    pub(super) fn leaves_out(&mut self, positions: usize) -> bool {
        let Some(refused) = &mut self.refused_cycle else { return false };
        refused.holes += positions;
        true
    }

    /// Reports a cycle that a statement ends which is not meant to.
    pub(super) fn left_on(&mut self, word: &SmolStr) {
        if let Some(cycle) = self.cycle.as_ref().filter(|cycle| cycle.holes > 0) {
            let cycle = cycle.word.clone();
            self.find(PostFindingKind::CycleLeftOn { cycle, word: word.clone() });
        }
    }

    /// Reports a circle whose points become holes.
    pub(super) fn circle_in_cycle(&mut self) {
        if let Some(cycle) = &self.cycle {
            let cycle = cycle.word.clone();
            self.find(PostFindingKind::CycleOnArc { cycle });
        }
    }

    /// A plain move inside a cycle: the control leaves it, the next hole takes it up again.
    pub(super) fn leave_cycle(&mut self) {
        if let Some(cycle) = self.cycle.take() {
            self.cancel(&cycle);
            self.cycle = Some(Cycle { open: None, ..cycle });
        }
    }

    fn cancel(&mut self, cycle: &Cycle) {
        let machine = self.machine;
        if cycle.open.is_some()
            && let Some(code) = &machine.codes.cycle_off
        {
            self.control.code(code);
        }
    }

    /// One hole with its top at `top`.
    pub(super) fn hole(&mut self, top: Vec3) {
        let Some(mut cycle) = self.cycle.take() else { return };
        let plane = top.z + cycle.clearance;
        cycle.holes += 1;
        if self.approach.is_some() {
            self.rapid_to(Vec3::new(top.x, top.y, plane));
        }
        if self.position.is_none() {
            self.find(PostFindingKind::CycleWithoutPosition);
            self.cycle = Some(cycle);
            return;
        }
        // What a tap goes is a matter of its thread.
        if cycle.feed_in_force && cycle.name != "tap" {
            cycle.feed = self.feed_in_force();
        }
        if cycle.feed.is_none() {
            self.find(PostFindingKind::NoFeed);
            self.cycle = Some(cycle);
            return;
        }
        self.check_tool();
        self.work_offset_now();
        let level = self.level(&mut cycle, top, plane);
        let machine = self.machine;
        match machine.cycles.get(&cycle.name) {
            Some(template) if !template.each.is_empty() => {
                let values = self.cycle_values(&cycle, top, plane, level);
                self.control.templates(&template.each, &values);
            }
            Some(template) => self.canned(&mut cycle, template, top, plane, level),
            None => self.expand(&cycle, top, plane, level),
        }
        self.position = Some(self.rounded(Vec3::new(top.x, top.y, level)));
        // The control holds the bottom of the hole as its last Z, and stands elsewhere.
        self.control.forget(&[AXES[2]]);
        self.cycle = Some(cycle);
    }

    /// The height that the tool goes back to. Where the program states one that is neither the clearance plane nor
    /// where the tool is, it is taken there first, and so it is to a clearance plane above it: the control goes back to
    /// where the tool stood when the cycle began, and on the way to the next hole it does not look for a wall.
    fn level(&mut self, cycle: &mut Cycle, top: Vec3, plane: f64) -> f64 {
        let here = self.position.map_or(plane, |position| position.z);
        let (start, level) = match cycle.retract {
            Retract::Initial => (here.max(plane), here.max(plane)),
            Retract::Above(height) if self.same(height, cycle.clearance) => (here.max(plane), plane),
            Retract::Above(height) => {
                let wanted = (top.z + height).max(plane);
                (wanted, wanted)
            }
        };
        if !self.same(start, here) {
            self.cancel(cycle);
            cycle.open = None;
            let (x, y) = self.position.map_or((top.x, top.y), |position| (position.x, position.y));
            // Up where the tool stands, down over the hole.
            if start > here {
                self.rapid_to(Vec3::new(x, y, start));
            } else {
                self.rapid_to(Vec3::new(top.x, top.y, here));
                self.rapid_to(Vec3::new(top.x, top.y, start));
            }
        }
        level
    }

    /// Whether two heights are the same number on the tape.
    fn same(&self, a: f64, b: f64) -> bool {
        self.control.rounded(AXES[2], a) == self.control.rounded(AXES[2], b)
    }

    fn cycle_values(&self, cycle: &Cycle, top: Vec3, plane: f64, level: f64) -> Values {
        let codes = &self.machine.codes;
        let back = if self.same(level, plane) { &codes.retract_plane } else { &codes.retract_initial };
        let milliseconds = self.machine.templates.dwell_in_milliseconds;
        Values::default()
            .number("X", top.x)
            .number("Y", top.y)
            .number("Z", top.z - cycle.depth)
            .number("R", plane)
            .number("ZR", plane)
            .number("ZI", level)
            .number("P", if milliseconds { cycle.dwell * MILLISECONDS_PER_SECOND } else { cycle.dwell })
            .optional("Q", cycle.step)
            .optional("F", cycle.feed)
            .optional("K", cycle.pitch)
            .optional("S", self.spindle.speed)
            .text("return", back.clone().unwrap_or_default())
    }

    fn canned(&mut self, cycle: &mut Cycle, template: &CycleTemplate, top: Vec3, plane: f64, level: f64) {
        let (Some(on), Some(next)) = (&template.on, &template.next) else {
            return self.find(PostFindingKind::CycleNotPossible { cycle: cycle.word.clone() });
        };
        let values = self.cycle_values(cycle, top, plane, level);
        let moves = self.control.changes(AXES[0], top.x) || self.control.changes(AXES[1], top.y);
        let same = cycle.open.is_some_and(|open| self.same(open.top, top.z) && open.feed == cycle.feed);
        if same && moves {
            return self.control.template(next, &values);
        }
        let machine = self.machine;
        self.level_plane();
        if cycle.feed.is_some() && self.feed_mode(&machine.codes.feed_per_minute) {
            self.control.code(&machine.codes.feed_per_minute);
        }
        if cycle.open.is_none()
            && let Some(pre) = &template.pre
        {
            self.control.template(pre, &values);
        }
        self.control.template(on, &values);
        cycle.open = Some(Open { top: top.z, feed: cycle.feed });
    }

    /// The cycle as single moves.
    fn expand(&mut self, cycle: &Cycle, top: Vec3, plane: f64, level: f64) {
        if matches!(cycle.name.as_str(), "tap") {
            return self.find(PostFindingKind::CycleNotPossible { cycle: cycle.word.clone() });
        }
        if cycle.holes == 1 {
            self.find(PostFindingKind::CycleExpanded { cycle: cycle.word.clone() });
        }
        let at = |z: f64| Vec3::new(top.x, top.y, z);
        let bottom = top.z - cycle.depth;
        let over = self.position.map_or(level, |position| position.z);
        self.rapid_to(at(over));
        self.rapid_to(at(plane));
        let gap = self.tape_length(PECK_GAP_MM);
        let step = cycle.step.unwrap_or(cycle.depth + cycle.clearance);
        let passes = (((plane - bottom) / step).ceil() as u32).clamp(1, MOST_PASSES);
        for pass in 1..=passes {
            if self.patience.ends_after(1) {
                return;
            }
            let depth = if pass == passes { bottom } else { plane - step * f64::from(pass) };
            self.feed_down(at(depth), cycle.feed);
            if pass < passes {
                let lifted = if cycle.name == "chipbreak" { depth + gap } else { plane };
                self.rapid_to(at(lifted));
                if cycle.name == "peck" {
                    self.rapid_to(at(depth + gap));
                }
            }
        }
        if cycle.dwell > 0.0 {
            self.dwell_block(cycle.dwell);
        }
        if cycle.name == "ream" {
            self.feed_down(at(plane), cycle.feed);
        }
        self.rapid_to(at(level));
    }

    fn feed_down(&mut self, position: Vec3, feed: Option<f64>) {
        let machine = self.machine;
        let mut words = Self::axis_words(position);
        words.extend(feed.map(|value| Word { register: "F", value, force: false }));
        if self.feed_mode(&machine.codes.feed_per_minute) {
            self.control.code(&machine.codes.feed_per_minute);
        }
        self.control.motion(&[], &[&machine.codes.linear], &words);
        self.position = Some(self.rounded(position));
    }

    /// A dwell of some seconds.
    pub(super) fn dwell_block(&mut self, seconds: f64) {
        let machine = self.machine;
        let milliseconds = machine.templates.dwell_in_milliseconds;
        let value = if milliseconds { seconds * MILLISECONDS_PER_SECOND } else { seconds };
        self.control.template(&machine.templates.dwell, &Values::default().number("P", value));
    }
}
