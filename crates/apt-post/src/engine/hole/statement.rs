//! The CYCLE statement: what it asks for, and what is wrong with it.

use apt_cldata::record::ClWord;
use smol_str::SmolStr;

use super::{Cycle, LEFT_HAND_TAP, REPEATS, RefusedCycle, SHIFT, is_tap};
use crate::{
    engine::Engine,
    finding::PostFindingKind,
    words::{
        Arguments, CycleFeed, CycleOrder, FeedMode, LengthUnit, Retract, cycle_not_made, cycle_order,
        feed_unit,
    },
};

/// Part by which the feed of a tap may differ from pitch times speed.
const TAP_FEED_FRACTION: f64 = 0.01;
const SECONDS_PER_MINUTE: f64 = 60.0;

/// A move to a position without a hole, which ends the cycle.
const MOVES_AND_ENDS: &str = "MILL";
/// What stands in the place of a type and makes no holes: how cycles are written, and how high the tool goes between them.
const WITHOUT_HOLES: [&str; 3] = [MOVES_AND_ENDS, "AUTO", "AVOID"];
/// The type that breaks chips wherever it is known.
const BREAKS_CHIPS: &str = "BRKCHP";
/// The most that anyone can mean by how often a cycle is made at a place.
const MOST_REPEATS: f64 = 9999.0;

impl Engine<'_> {
    /// The CYCLE statement.
    pub(in crate::engine) fn cycle_statement(&mut self, arguments: &Arguments<'_>) {
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
        let canned = self
            .machine
            .cycles
            .get(name)
            .filter(|template| template.each.is_empty() && template.define.is_empty());
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
}
