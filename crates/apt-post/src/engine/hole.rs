//! CYCLE: canned cycles of the control, and their expansion into moves where it has none.

use apt_cldata::record::ClWord;
use apt_geometry::Vec3;
use smol_str::SmolStr;

use super::{Engine, motion::AXES};
use crate::{
    control::Values,
    finding::PostFindingKind,
    machine::CycleTemplate,
    words::{
        Arguments, CycleFeed, CycleOrder, FeedMode, LengthUnit, Retract, cycle_not_made, cycle_order,
        feed_unit,
    },
};

/// Part by which the feed of a tap may differ from pitch times speed.
const TAP_FEED_FRACTION: f64 = 0.01;
const SECONDS_PER_MINUTE: f64 = 60.0;
const MILLISECONDS_PER_SECOND: f64 = 1000.0;

/// A move to a position without a hole, which ends the cycle.
const MOVES_AND_ENDS: &str = "MILL";
/// What stands in the place of a type and makes no holes: how cycles are written, and how high the tool goes between them.
const WITHOUT_HOLES: [&str; 3] = [MOVES_AND_ENDS, "AUTO", "AVOID"];

/// The cycles of the definitions whose statements need something of their own.
const TAP: &str = "tap";
const LEFT_HAND_TAP: &str = "tap-left";
pub(super) const SHIFT: &str = "shift";
/// The type that breaks chips wherever it is known.
const BREAKS_CHIPS: &str = "BRKCHP";
/// The register of how often a cycle is made at a place, and the most that anyone can mean.
const REPEATS: &str = "L";
const MOST_REPEATS: f64 = 9999.0;

/// A cycle in force. Lengths in tape units.
#[derive(Debug, Clone)]
pub(super) struct Cycle {
    /// The word of the statement, for messages.
    pub(super) word: SmolStr,
    /// The cycle's name in the machine definition.
    pub(super) name: String,
    pub(super) depth: f64,
    pub(super) clearance: f64,
    retract: Retract,
    pub(super) feed: Option<f64>,
    /// Whether the statement names no feed: then it is the one in force at each hole.
    feed_in_force: bool,
    pub(super) step: Option<f64>,
    pub(super) dwell: f64,
    pitch: Option<f64>,
    /// Whether it goes as far in a turn of the spindle at any speed, by the pitch: a thread does, and what is told per revolution.
    per_turn: bool,
    /// How far the tool steps aside at the bottom, along X and Y.
    pub(super) shift: Option<(f64, f64)>,
    /// Where the spindle stops for it, in degrees.
    pub(super) orientation: Option<f64>,
    /// How often each hole is made.
    pub(super) times: u32,
    /// What the control has in force, once it is in the cycle.
    open: Option<Open>,
    pub(super) holes: usize,
    place: (u32, u32),
}

impl Cycle {
    /// Whether it cuts a thread, which the spindle and the feed have to go together for.
    pub(super) fn taps(&self) -> bool {
        is_tap(&self.name)
    }
}

fn is_tap(name: &str) -> bool {
    name == TAP || name == LEFT_HAND_TAP
}

/// A CYCLE that nothing can be made of. The positions that follow are tops of holes, which are no way to go at feed rate.
#[derive(Debug, Clone)]
pub(super) struct RefusedCycle {
    word: SmolStr,
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
                        self.refuse_cycle(arguments);
                    }
                }
                return;
            }
            Some(ClWord::Word(word)) if WITHOUT_HOLES.contains(&word.as_str()) => {
                if word == MOVES_AND_ENDS {
                    self.end_cycle();
                }
                return self.find(cycle_not_made(arguments, word));
            }
            _ => {}
        }
        self.cycle_asked = true;
        self.cycle = self.new_cycle(arguments);
        self.was_refused = self.cycle.is_none();
        if self.was_refused {
            self.refuse_cycle(arguments);
        }
    }

    fn refuse_cycle(&mut self, arguments: &Arguments<'_>) {
        let word = arguments.items.iter().find_map(|item| match item {
            ClWord::Word(word) => Some(word.clone()),
            ClWord::Number(_) => None,
        });
        let (word, place) = (word.unwrap_or_default(), self.control.place);
        self.refused_cycle = Some(RefusedCycle { word, place, holes: 0 });
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
        self.rapid_axis = None;
        if let Some(place) = self.rapid.take() {
            self.find_at(place, PostFindingKind::RapidUnused);
        }
        let meant = match order.kind.as_str() {
            "DEEP" if self.deep_breaks_chips => BREAKS_CHIPS,
            kind => kind,
        };
        let Some(name) = self.machine.cycle_words.get(meant).cloned() else {
            self.find(cycle_not_made(arguments, &order.kind));
            return None;
        };
        let scale = self.scale;
        let (depth, clearance, step) = self.cycle_lengths(arguments, &order, &name)?;
        let (feed, pitch) = self.cycle_feed(arguments, order.feed, is_tap(&name))?;
        let per_turn = is_tap(&name) || order.feed.is_some_and(CycleFeed::is_per_turn);
        let dwell = self.cycle_dwell(arguments, &order)?;
        let shift = self.cycle_shift(arguments, &order, &name)?;
        let times = self.cycle_times(arguments, &order, &name)?;
        self.check_direction(&name, &order.kind);
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
            per_turn,
            shift,
            orientation: order.orientation,
            times,
            open: None,
            holes: 0,
            place,
        })
    }

    /// Depth, clearance and step of a cycle on the tape; none where it is told what is wrong with them.
    fn cycle_lengths(
        &mut self,
        arguments: &Arguments<'_>,
        order: &CycleOrder,
        name: &str,
    ) -> Option<(f64, f64, Option<f64>)> {
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
            return self.bad_value(arguments, "DEPTH", depth);
        }
        if clearance < 0.0 || clearance.is_nan() {
            return self.bad_value(arguments, "RAPTO", clearance);
        }
        if let Some(step) = order.step.filter(|step| *step <= 0.0 || step.is_nan()) {
            return self.bad_value(arguments, "STEP", step);
        }
        let pecks = matches!(name, "peck" | "chipbreak");
        let step = match order.step.map(|step| step * scale) {
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
        Some((depth, clearance, step))
    }

    fn bad_value<T>(&mut self, arguments: &Arguments<'_>, argument: &str, value: f64) -> Option<T> {
        let (word, argument) = (arguments.word.clone(), argument.into());
        self.find(PostFindingKind::BadValue { word, argument, value });
        None
    }

    fn not_used(&mut self, arguments: &Arguments<'_>, argument: &str) {
        let (word, argument) = (arguments.word.clone(), argument.into());
        self.find(PostFindingKind::ArgumentNotUsed { word, argument });
    }

    /// Seconds at the bottom of a hole; none when the statement has to be left out.
    fn cycle_dwell(&mut self, arguments: &Arguments<'_>, order: &CycleOrder) -> Option<f64> {
        match (order.dwell, self.spindle.speed) {
            (Some((dwell, _)), _) if dwell < 0.0 || dwell.is_nan() => {
                self.bad_value(arguments, "DWELL", dwell)
            }
            (Some((turns, true)), Some(speed)) if speed > 0.0 => Some(turns / speed * SECONDS_PER_MINUTE),
            (Some((_, true)), _) => {
                self.find(PostFindingKind::NoSpindleSpeed);
                None
            }
            (Some((seconds, false)), _) => Some(seconds),
            (None, _) => Some(0.0),
        }
    }

    /// How far the tool steps aside at the bottom, where the cycle does; none when the statement has to be left out.
    fn cycle_shift(
        &mut self,
        arguments: &Arguments<'_>,
        order: &CycleOrder,
        name: &str,
    ) -> Option<Option<(f64, f64)>> {
        let by_moves = name == SHIFT && !self.machine.cycles.contains_key(name);
        let turns = by_moves && !self.machine.templates.spindle_orient.is_empty();
        if order.orientation.is_some() && !turns {
            self.not_used(arguments, "ORIENT");
        }
        match order.shift {
            None if name == SHIFT => {
                self.find(arguments.missing("OFFSET"));
                None
            }
            None => Some(None),
            Some(_) if name != SHIFT => {
                self.not_used(arguments, "OFFSET");
                Some(None)
            }
            Some((first, second)) => {
                let second_part = second.unwrap_or(0.0);
                let amount = first.hypot(second_part);
                if amount == 0.0 || !amount.is_finite() {
                    return self.bad_value(arguments, "OFFSET", first);
                }
                if second_part != 0.0 && !by_moves {
                    self.not_used(arguments, "the direction of OFFSET");
                }
                Some(Some((first * self.scale, second_part * self.scale)))
            }
        }
    }

    /// How often each hole is made; none when the statement has to be left out.
    fn cycle_times(&mut self, arguments: &Arguments<'_>, order: &CycleOrder, name: &str) -> Option<u32> {
        let Some(times) = order.times else { return Some(1) };
        if !((1.0..=MOST_REPEATS).contains(&times) && times.fract() == 0.0) {
            return self.bad_value(arguments, "TIMES", times);
        }
        let writes = |text: &String| crate::template::register_names(text).iter().any(|name| name == REPEATS);
        let canned = self.machine.cycles.get(name).filter(|template| template.each.is_empty());
        if canned.is_some_and(|template| !template.on.iter().all(writes) || !template.next.iter().all(writes))
        {
            self.not_used(arguments, "TIMES");
            return Some(1);
        }
        Some(times as u32)
    }

    /// Reports a tap that the spindle does not turn into the hole.
    fn check_direction(&mut self, name: &str, kind: &SmolStr) {
        let left = name == LEFT_HAND_TAP;
        if is_tap(name) && self.spindle.on && self.spindle.counterclockwise != left {
            self.find(PostFindingKind::TapDirection { cycle: kind.clone() });
        }
    }

    /// Revolutions per minute as the control reads them.
    fn speed_on_tape(&self) -> Option<f64> {
        self.spindle.speed.map(|speed| self.control.rounded("S", speed)).filter(|speed| *speed > 0.0)
    }

    /// What the tool goes in a minute at the feed in force; none of an inverse time, which tells nothing of a hole.
    pub(super) fn feed_in_force(&self) -> Option<f64> {
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
        let speed = self.speed_on_tape();
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
        if let Some(RefusedCycle { place, holes: holes @ 1.., .. }) = self.refused_cycle.take() {
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
        let made = self.cycle.as_ref().filter(|cycle| cycle.holes > 0).map(|cycle| &cycle.word);
        let refused = self.refused_cycle.as_ref().filter(|cycle| cycle.holes > 0).map(|cycle| &cycle.word);
        if let Some(cycle) = made.or(refused).cloned() {
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
        let plane = self.height(&top) + cycle.clearance;
        cycle.holes += 1;
        if self.approach.is_some() {
            self.rapid_to(self.at_height(&top, plane));
        }
        self.follow_for_cycle();
        if self.compensating && cycle.holes == 1 {
            self.find(PostFindingKind::CompensationLeftOn { word: "CYCLE".into() });
        }
        if self.position.is_none() {
            self.find(PostFindingKind::CycleWithoutPosition);
            self.cycle = Some(cycle);
            return;
        }
        if let (true, Some(pitch), Some(speed)) = (cycle.per_turn, cycle.pitch, self.speed_on_tape()) {
            cycle.feed = Some(pitch * speed);
        } else if cycle.feed_in_force && !cycle.taps() {
            cycle.feed = self.feed_in_force();
        }
        if cycle.feed.is_none() {
            self.find(PostFindingKind::NoFeed);
            self.cycle = Some(cycle);
            return;
        }
        self.check_tool();
        self.work_offset_now();
        self.turn_now();
        let level = self.level(&mut cycle, top, plane);
        let machine = self.machine;
        let made = machine.cycles.get(&cycle.name).filter(|_| self.makes_cycles());
        match made {
            Some(template) if !template.each.is_empty() => {
                let values = self.cycle_values(&cycle, top, plane, level);
                for _ in 0..cycle.times {
                    if self.patience.ends_after(1) {
                        break;
                    }
                    self.control.templates(&template.each, &values);
                }
            }
            Some(template) => self.canned(&mut cycle, template, top, plane, level),
            None => self.expand(&cycle, top, plane, level),
        }
        self.position = Some(self.rounded(self.at_height(&top, level)));
        // A control with the cycle holds the bottom of the hole as its last Z, and stands elsewhere.
        if made.is_some() {
            self.control.forget(&[AXES[2]]);
        }
        self.cycle = Some(cycle);
    }

    /// The height that the tool goes back to. Where the program states one that is neither the clearance plane nor
    /// where the tool is, it is taken there first, and so it is to a clearance plane above it: the control goes back to
    /// where the tool stood when the cycle began, and on the way to the next hole it does not look for a wall.
    fn level(&mut self, cycle: &mut Cycle, top: Vec3, plane: f64) -> f64 {
        let here = self.position.map_or(plane, |position| self.height(&position));
        let (start, level) = match cycle.retract {
            Retract::Initial => (here.max(plane), here.max(plane)),
            Retract::Above(height) if self.same(height, cycle.clearance) => (here.max(plane), plane),
            Retract::Above(height) => {
                let wanted = (self.height(&top) + height).max(plane);
                (wanted, wanted)
            }
        };
        if !self.same(start, here) {
            self.cancel(cycle);
            cycle.open = None;
            // Up where the tool stands, down over the hole.
            if start > here {
                self.rapid_to(self.at_height(&self.position.unwrap_or(top), start));
            } else {
                self.rapid_to(self.at_height(&top, here));
                self.rapid_to(self.at_height(&top, start));
            }
        }
        level
    }

    /// Whether two heights are the same number on the tape.
    fn same(&self, a: f64, b: f64) -> bool {
        self.control.rounded(AXES[2], a) == self.control.rounded(AXES[2], b)
    }

    /// Clearance of the cycle in force, and how many holes it has made.
    pub(super) fn cycle_so_far(&self) -> (f64, usize) {
        self.cycle.as_ref().map_or((0.0, 0), |cycle| (cycle.clearance, cycle.holes))
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
            .optional("Q", cycle.shift.map(|(x, y)| x.hypot(y)).or(cycle.step))
            .optional(REPEATS, (cycle.times > 1).then_some(f64::from(cycle.times)))
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

    /// A dwell of some seconds.
    pub(super) fn dwell_block(&mut self, seconds: f64) {
        let machine = self.machine;
        let milliseconds = machine.templates.dwell_in_milliseconds;
        let value = if milliseconds { seconds * MILLISECONDS_PER_SECOND } else { seconds };
        self.control.template(&machine.templates.dwell, &Values::default().number("P", value));
    }
}
