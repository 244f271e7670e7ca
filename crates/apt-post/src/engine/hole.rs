//! Holes: canned cycles of the control, and their expansion into moves where it has none.

mod statement;

use apt_geometry::Vec3;
use smol_str::SmolStr;

use super::{Engine, expansion::PECK_GAP_MM, motion::AXES};
use crate::{
    control::{Values, Word},
    finding::PostFindingKind,
    machine::CycleTemplate,
    words::{FeedMode, Retract},
};

const MILLISECONDS_PER_SECOND: f64 = 1000.0;

/// The cycles of the definitions whose statements need something of their own.
const TAP: &str = "tap";
const LEFT_HAND_TAP: &str = "tap-left";
pub(super) const SHIFT: &str = "shift";
/// The register of how often a cycle is made at a place.
const REPEATS: &str = "L";

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
            .words(&self.heights_from_top(cycle, top, plane, level))
            .number("ZR", plane)
            .number("ZI", level)
            .number("P", if milliseconds { cycle.dwell * MILLISECONDS_PER_SECOND } else { cycle.dwell })
            .optional("Q", cycle.shift.map(|(x, y)| x.hypot(y)).or(cycle.step))
            .optional(REPEATS, (cycle.times > 1).then_some(f64::from(cycle.times)))
            .optional("F", cycle.feed)
            .optional("FQ", cycle.feed)
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
            self.control.template(next, &values);
            return self.again(cycle, template, on, &values);
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
        if !same {
            self.control.templates(&template.define, &values);
        }
        self.control.template(on, &values);
        self.again(cycle, template, on, &values);
        cycle.open = Some(Open { top: top.z, feed: cycle.feed });
    }

    /// Makes a hole as often as is asked for, where the control is told at every hole to make it.
    fn again(&mut self, cycle: &Cycle, template: &CycleTemplate, on: &str, values: &Values) {
        let more = if template.define.is_empty() { 0 } else { cycle.times.saturating_sub(1) };
        for _ in 0..more {
            if self.patience.ends_after(1) {
                return;
            }
            self.control.template(on, values);
        }
    }

    /// A hole as seen from its top: where that is, clearance, depth and the height that the tool goes back to, all between
    /// places as the control reads them, and how far it goes back to break a chip.
    fn heights_from_top(&self, cycle: &Cycle, top: Vec3, plane: f64, level: f64) -> [Word; 5] {
        let read = |height| self.control.rounded(AXES[2], height);
        let surface = read(top.z);
        let words = [
            ("ZT", surface),
            ("RC", read(plane) - surface),
            ("RB", read(level) - surface),
            ("DP", surface - read(top.z - cycle.depth)),
            ("CB", self.tape_length(PECK_GAP_MM)),
        ];
        words.map(|(register, value)| Word { register, value, force: true })
    }

    /// A dwell of some seconds.
    pub(super) fn dwell_block(&mut self, seconds: f64) {
        let machine = self.machine;
        let milliseconds = machine.templates.dwell_in_milliseconds;
        let value = if milliseconds { seconds * MILLISECONDS_PER_SECOND } else { seconds };
        self.control.templates(&machine.templates.dwell, &Values::default().number("P", value));
    }
}
