//! Blocks on which rotary axes turn.

use apt_geometry::Vec3;

use super::{
    Engine, Feed,
    blocks::Shape,
    motion::AXES,
    turning::{Target, Turning, Way},
};
use crate::{
    control::{Values, Word},
    finding::PostFindingKind,
    kinematics::{
        Angles, angle_between,
        divide::{Stand, beyond, divide},
    },
    machine::{Coordinates, VECTOR_REGISTERS},
    words::FeedMode,
};

/// How many times as far as the tool a rotary axis turns where the tool is said to hardly turn: it leans by less than about twelve degrees then.
const SWINGS: f64 = 5.0;

/// Degrees.
const FULL_TURN: f64 = 360.0;
/// How far an axis that the control turns the shorter way is turned in one block: so much less than half a turn that rounding does not matter.
const SHORTER_WAY: f64 = 175.0;

/// The end of a block on which axes turn.
#[derive(Clone, Copy)]
struct Turn {
    stand: Stand,
    /// How far the place goes in the part for which the feed counts.
    length: f64,
    /// Into how many blocks its motion is divided.
    parts: usize,
}

impl Engine<'_> {
    /// A position to which the tool goes by rapid.
    pub(super) fn rapid_target(&mut self, target: &Target) {
        match self.way(target) {
            Way::Straight(position) => self.rapid_to(position),
            // What is turned back is off the part anyway.
            Way::Turning(angles) | Way::Back(_, angles) => {
                self.turn_rapidly(target.place, target.axis, angles);
            }
            Way::Nowhere => {}
        }
    }

    /// A position that is the top of a hole.
    pub(super) fn hole_target(&mut self, target: &Target) {
        match self.way(target) {
            Way::Straight(position) => self.hole(position),
            Way::Turning(angles) | Way::Back(_, angles) => {
                let (clearance, holes) = self.cycle_so_far();
                self.leave_cycle();
                if holes > 0 {
                    self.find(PostFindingKind::CycleTurns);
                }
                self.turn_rapidly(target.place + target.axis * clearance, target.axis, angles);
                if let Some(turning) = &self.turning {
                    self.hole(turning.frame.place(target.place));
                }
            }
            Way::Nowhere => {}
        }
    }

    /// A position to which the tool cuts while axes turn, behind all that waits to be fitted.
    pub(super) fn cut_turning(&mut self, target: &Target, angles: Angles) {
        self.flush();
        if self.compensated || self.compensation.is_some() {
            self.find(PostFindingKind::CompensationTurns);
        }
        self.follow();
        let known = self.position.filter(|_| !self.skipped && self.approach.is_none());
        let Some(position) = known else {
            self.stand(target.axis, angles);
            return self.linear_to(self.on_tape(&target.place));
        };
        let Some(turning) = &self.turning else { return };
        let from = Stand { tip: turning.frame.part(position), axis: turning.axis, angles: turning.angles };
        let to = Stand { tip: target.place, axis: target.axis, angles };
        let Some(turns) = self.divided(&from, &to) else { return };
        self.tell_swing(&from, &to);
        // Where FROM says that the tool stands the control has to be told how its axes do.
        self.approach_now();
        self.check_cutting();
        for turn in turns {
            if self.patience.ends_after(1) {
                return;
            }
            self.turning_block(&turn);
        }
    }

    /// The blocks from one stand to the next; none, with a finding, where they would be too many.
    fn divided(&mut self, from: &Stand, to: &Stand) -> Option<Vec<Turn>> {
        let turning = self.turning.as_ref()?;
        let tolerances = turning.tolerances();
        let Ok(stands) = divide(&turning.kinematics, from, to, &tolerances, self.patience) else {
            let undivided = turning.undivided(from, to);
            self.find(undivided);
            return None;
        };
        let parts = stands.len();
        let up = turning.feed_point;
        let mut here = from.tip + from.axis * up;
        let turn = |stand: Stand| {
            let there = stand.tip + stand.axis * up;
            let length = (there - here).norm();
            here = there;
            Turn { stand, length, parts }
        };
        Some(stands.into_iter().map(turn).collect())
    }

    /// Tells of a rotary axis that turns far where the tool hardly does.
    fn tell_swing(&mut self, from: &Stand, to: &Stand) {
        let Some(turning) = &self.turning else { return };
        let turned = angle_between(&from.axis, &to.axis).to_degrees();
        let swings = (0..2).find_map(|index| {
            let degrees = (to.angles[index] - from.angles[index]).abs();
            let far = degrees > turning.rules.warn_degrees && degrees > SWINGS * turned;
            Some((turning.names[index]?, degrees)).filter(|_| far)
        });
        if let Some((axis, degrees)) = swings {
            self.find(PostFindingKind::RotarySwing { axis: axis.into(), degrees, turned });
        }
    }

    /// One block on which axes turn; several where an axis that the control turns the shorter way turns by half a turn or more, or nearly so.
    fn turning_block(&mut self, turn: &Turn) {
        let Some(before) = self.turning.as_ref().map(|turning| turning.angles) else { return };
        let angles = self.rounded_angles(turn.stand.angles);
        let axis = turn.stand.axis;
        self.stand(axis, angles);
        let end = self.on_tape(&turn.stand.tip);
        let start = self.position.unwrap_or(end);
        let pieces = self.turning.as_ref().map_or(1, |turning| turning.pieces(before));
        let piece = Turn {
            length: turn.length / f64::from(pieces),
            parts: turn.parts.saturating_mul(pieces as usize),
            ..*turn
        };
        let mut last = before;
        for number in 1..=pieces {
            let share = f64::from(number) / f64::from(pieces);
            let between = [0, 1].map(|index| before[index] + (angles[index] - before[index]) * share);
            let to = if number == pieces { angles } else { self.rounded_angles(between) };
            self.stand(axis, to);
            self.joint_block(&piece, last, self.rounded(start.lerp(&end, share)));
            last = to;
        }
    }

    /// A block to slides and to the angles at which the machine has come to stand.
    fn joint_block(&mut self, turn: &Turn, before: Angles, position: Vec3) {
        let words = self.axis_words(position);
        if !words.iter().any(|word| self.control.changes(word.register, word.value)) {
            // Less than the last decimals.
            self.position = Some(position);
            return;
        }
        self.check_travel(position);
        let (feed_code, feed) = self.turning_feed(turn, before, position);
        let words: Vec<Word> = words.into_iter().chain(feed).collect();
        self.cut(&[], feed_code, &Shape::Linear, &words);
        self.skipped = false;
        self.position = Some(position);
    }

    /// The feed of a block on which axes turn: where the tape tells slides the time that it takes, as the control knows no way of the tool end.
    fn turning_feed(
        &mut self,
        turn: &Turn,
        before: Angles,
        position: Vec3,
    ) -> (Option<String>, Option<Word>) {
        let Some(turning) = self.turning.as_ref().filter(|turning| turning.kinematics.slides) else {
            return self.feed_words(turn.length);
        };
        let turned = (0..2).map(|index| (turning.angles[index] - before[index]).abs() / turning.most[index]);
        let start = self.position.unwrap_or(position);
        let slid = (0..AXES.len()).filter_map(|axis| {
            let most = self.machine.axes.get(AXES[axis])?.most_mm_per_minute?;
            Some((position[axis] - start[axis]).abs() / self.tape_length(most))
        });
        let least = turned.chain(slid).fold(0.0, f64::max);
        let stated = match self.feed {
            None => return (None, None),
            Some(Feed { mode: FeedMode::Inverse, value, timed: false }) => {
                (value * turn.parts as f64).recip()
            }
            Some(_) => self.feed_in_force().map_or(0.0, |feed| turn.length / feed),
        };
        let register = self.feed_register(FeedMode::Inverse);
        let minutes = stated.max(least);
        let value = if minutes > 0.0 { minutes.recip() } else { f64::INFINITY };
        let value = value.min(self.control.greatest(register));
        (self.machine.codes.feed_inverse.clone(), Some(Word { register, value, force: true }))
    }

    /// Back off the part along the tool, with an axis that is at its end turned back, to where the tool stood; and on from there.
    pub(super) fn cut_turned_back(&mut self, target: &Target, back: Angles, to: Angles) {
        self.flush();
        let Some((turning, position)) = self.turning.as_ref().zip(self.position) else {
            // From wherever the tool is nothing is divided, and nothing is turned back.
            return self.cut_turning(target, to);
        };
        let (tip, axis) = (turning.frame.part(position), turning.axis);
        let off = tip + axis * turning.rules.retract_mm.unwrap_or_default() * turning.unit;
        let (_, farthest) = turning.farthest(back);
        if let Some(name) = turning.names[farthest] {
            let (from, to) = (turning.angles[farthest], back[farthest]);
            self.find(PostFindingKind::RotaryTurnedBack { axis: name.into(), from, to });
        }
        self.rapid_to(self.on_tape(&off));
        let back = self.rounded_angles(back);
        self.turn_rapidly(off, axis, back);
        self.linear_to(self.on_tape(&tip));
        self.cut_turning(target, to);
    }

    /// A rapid on which the axes turn, divided where the machine wants the tool end on its way there, too, and it is on one.
    fn turn_rapidly(&mut self, place: Vec3, axis: Vec3, angles: Angles) {
        self.follow();
        let Some(stands) = self.rapid_stands(place, angles) else { return };
        for stand in stands {
            if self.patience.ends_after(1) {
                return;
            }
            let angles = self.rounded_angles(stand.angles);
            let between = self.turning.as_ref().map_or(axis, |turning| turning.kinematics.axis(angles));
            self.stand(between, angles);
            self.rapid_to(self.on_tape(&stand.tip));
        }
        self.stand(axis, angles);
        if let Some(turning) = &self.turning {
            self.rapid_to(turning.frame.place(place));
        }
    }

    /// Where a rapid is divided, without its end: its angles turn evenly, to whatever side of the machine they lead. None, with a finding, where it would
    /// be at too many places.
    fn rapid_stands(&mut self, place: Vec3, angles: Angles) -> Option<Vec<Stand>> {
        let known = self.position.filter(|_| !self.skipped && self.approach.is_none());
        let Some((turning, position)) = self.turning.as_ref().zip(known) else { return Some(Vec::new()) };
        let Some(tolerances) = turning.rapid_tolerances() else { return Some(Vec::new()) };
        let from = Stand { tip: turning.frame.part(position), axis: turning.axis, angles: turning.angles };
        // Between ends with one axis the angles themselves are divided.
        let to = Stand { tip: place, axis: from.axis, angles };
        match divide(&turning.kinematics, &from, &to, &tolerances, self.patience) {
            Ok(mut stands) => {
                stands.pop();
                Some(stands)
            }
            Err(_) => {
                self.find(PostFindingKind::TooManyParts { most: tolerances.most });
                None
            }
        }
    }

    /// Lets the tool stand along a direction of the part, by angles as the tape has them.
    pub(super) fn stand(&mut self, axis: Vec3, angles: Angles) {
        let mut unknown = false;
        if let Some(turning) = &mut self.turning {
            unknown = turning.needs_length(angles);
            turning.turn(axis, angles);
        }
        if unknown {
            self.find(PostFindingKind::NoToolLength);
        }
    }

    /// A place of the part as the control reads it.
    fn on_tape(&self, place: &Vec3) -> Vec3 {
        let position = self.turning.as_ref().map_or(*place, |turning| turning.frame.place(*place));
        self.rounded(position)
    }

    pub(super) fn rounded_angles(&self, angles: Angles) -> Angles {
        let Some(turning) = &self.turning else { return angles };
        let mut rounded = angles;
        for (angle, name) in rounded.iter_mut().zip(turning.names) {
            if let Some(name) = name {
                *angle = self.control.rounded(name, *angle);
            }
        }
        rounded
    }

    /// The words of the rotary axes, or of the direction of the tool, as far as the machine has any.
    pub(super) fn rotary_words(&self) -> Vec<Word> {
        let Some(turning) = &self.turning else { return Vec::new() };
        if turning.rules.coordinates == Coordinates::Vector && !turning.follows {
            // Without its transformation the control knows no directions.
            return Vec::new();
        }
        if turning.rules.coordinates != Coordinates::Vector {
            let word = |index: usize| {
                let (register, angle) = (turning.names[index]?, turning.angles[index]);
                let value = if turning.wraps[index] { self.wrapped(register, angle) } else { angle };
                Some(Word { register, value, force: false })
            };
            return (0..2).filter_map(word).collect();
        }
        let direction = VECTOR_REGISTERS.into_iter().zip(turning.axis.iter().copied());
        let changed = direction.clone().any(|(register, value)| self.control.changes(register, value));
        // A direction is told whole.
        direction.filter(|_| changed).map(|(register, value)| Word { register, value, force: true }).collect()
    }

    /// An angle as it is told from 0 to 360.
    fn wrapped(&self, register: &str, angle: f64) -> f64 {
        let wrapped = self.control.rounded(register, angle.rem_euclid(FULL_TURN));
        if wrapped < FULL_TURN { wrapped } else { 0.0 }
    }

    /// Brings the rotary axes to where they stand, where no block has told the control of that.
    pub(super) fn turn_now(&mut self) {
        let words = self.rotary_words();
        if words.iter().any(|word| self.control.changes(word.register, word.value)) {
            self.rapid_block(&[], &words);
        }
    }

    /// Whether the control is to follow the tool end on the way that is being made.
    pub(super) fn is_followed(&self) -> bool {
        let possible = !self.machine.templates.follow_on.is_empty();
        possible && self.turning.as_ref().is_some_and(|turning| turning.to_follow)
    }

    /// Tells the control to follow the tool end, where the machine is one that does; a tool that is on its way to its first place waits.
    pub(super) fn follow(&mut self) {
        let machine = self.machine;
        if machine.templates.follow_on.is_empty() || self.approach.is_some() {
            return;
        }
        let Some(turning) = self.turning.as_mut().filter(|turning| !turning.follows) else { return };
        turning.follows = true;
        self.work_offset_now();
        let values = Values::default().number("H", f64::from(self.length_offset));
        self.control.templates(&machine.templates.follow_on, &values);
    }

    /// Tells the control not to follow the tool end any more; `stays` where the tool goes on, with its length as without rotary axes.
    pub(super) fn follow_no_more(&mut self, stays: bool) {
        let machine = self.machine;
        let Some(turning) = self.turning.as_mut().filter(|turning| turning.follows) else { return };
        turning.follows = false;
        self.control.templates(&machine.templates.follow_off, &Values::default());
        if stays {
            let values = Values::default().number("H", f64::from(self.length_offset));
            self.control.template(&machine.templates.length_offset, &values);
        }
    }

    /// Blocks that take the axes home, in which rotary ones go to 0.
    pub(super) fn home_blocks(&mut self, templates: &[String], values: Values) {
        let Some(turning) = &mut self.turning else { return self.control.templates(templates, &values) };
        let named: Vec<String> =
            templates.iter().flat_map(|text| crate::template::register_names(text)).collect();
        let mut angles = turning.angles;
        let mut values = values;
        for (angle, name) in angles.iter_mut().zip(turning.names) {
            if let Some(name) = name.filter(|name| named.iter().any(|register| register == name)) {
                *angle = 0.0;
                values = values.number(name, 0.0);
            }
        }
        let axis = turning.kinematics.axis(angles);
        turning.turn(axis, angles);
        self.control.templates(templates, &values);
    }

    /// Direction of the spindle in the coordinates of the tape.
    fn spindle_direction(&self) -> Vec3 {
        let direction = self.turning.as_ref().map_or_else(Vec3::z, |turning| turning.frame.spindle);
        // An upright one is so to the last digit.
        if super::turning::leans(&direction) { direction } else { Vec3::z() }
    }

    /// An upright tool makes holes as on a machine without rotary axes, so that the control makes its cycles.
    pub(super) fn follow_for_cycle(&mut self) {
        if self.turning.as_ref().is_some_and(|turning| turning.angles == [0.0; 2]) {
            self.follow_no_more(true);
        }
    }

    /// Whether the control may make its own cycles: along its Z axis, and not while it follows the tool end.
    pub(super) fn makes_cycles(&self) -> bool {
        let follows = self.turning.as_ref().is_some_and(|turning| turning.follows);
        !follows && self.is_upright()
    }

    /// Whether the spindle is along the Z axis of the tape.
    pub(super) fn is_upright(&self) -> bool {
        self.spindle_direction() == Vec3::z()
    }

    /// How high a place is along the spindle.
    pub(super) fn height(&self, place: &Vec3) -> f64 {
        let direction = self.spindle_direction();
        if self.is_upright() { place.z } else { direction.dot(place) }
    }

    /// The place at a height along the spindle over or under another one.
    pub(super) fn at_height(&self, place: &Vec3, height: f64) -> Vec3 {
        let direction = self.spindle_direction();
        if direction == Vec3::z() {
            return Vec3::new(place.x, place.y, height);
        }
        place + direction * (height - direction.dot(place))
    }

    /// Where the tool comes to a height of the part when it is drawn out along itself; none where it lies.
    pub(super) fn drawn_to(&self, here: Vec3, height: f64) -> Option<Vec3> {
        let Some(turning) = self.turning.as_ref() else { return Some(Vec3::new(here.x, here.y, height)) };
        let axis = turning.kinematics.axis(turning.angles);
        if !super::turning::leans(&axis) {
            return Some(turning.frame.place(with_height(turning.frame.part(here), height)));
        }
        let tip = turning.frame.part(here);
        let way = (height - tip.z) / axis.z;
        (axis.z > 0.0 && way.is_finite()).then(|| turning.frame.place(tip + axis * way))
    }
}

fn with_height(place: Vec3, height: f64) -> Vec3 {
    Vec3::new(place.x, place.y, height)
}

impl Turning<'_> {
    /// Into how many blocks the way from some angles is divided, so that the control turns each axis the way that is meant.
    fn pieces(&self, from: Angles) -> u32 {
        let pieces = (0..2).filter(|index| self.wraps[*index]).map(|index| {
            let turned = (self.angles[index] - from[index]).abs();
            (turned / SHORTER_WAY).ceil() as u32
        });
        pieces.max().unwrap_or(1).max(1)
    }

    /// Why a move is not divided.
    fn undivided(&self, from: &Stand, to: &Stand) -> PostFindingKind {
        let most = self.rules.most_parts;
        let Some((which, angle)) = beyond(&self.kinematics, from, to) else {
            return PostFindingKind::TooManyParts { most };
        };
        let [least, greatest] = self.kinematics.axes[which].limits;
        let axis = self.names[which].unwrap_or_default().into();
        PostFindingKind::RotaryLimit { axis, angle, least, greatest, positions: 1 }
    }

    /// How far and by which axis the machine turns most on the way to other angles.
    fn farthest(&self, to: Angles) -> (f64, usize) {
        let turned = [0, 1].map(|index| (to[index] - self.angles[index]).abs());
        if turned[1] > turned[0] { (turned[1], 1) } else { (turned[0], 0) }
    }
}
