//! Check surfaces as events along the path (ACHECK, CHECK1 to CHECK3 made safe): clearance changes by no more than the
//! distance moved, so stepping by the clearance itself can never jump over a position. Where the path runs along the check
//! surface the steps are longer: a bound of the second derivative shows that there is no position between two samples.

pub(super) mod graze;
mod watch;

use std::rc::Rc;

use apt_geometry::{
    Vec3,
    motion::{CheckSurface, Relation},
    surface::Bend,
};

use self::watch::{Before, Status, Watch, transition};
use super::{Prepared, is_tangent, proof::lowest};
use crate::{
    attitude::Sweep,
    clearance::{Enough, Gauge, Memory, Tool, Witness, separation, upward_bend},
    role::{LEAST_STEP, Working},
};

/// Bound of the steps along one cut vector; beyond it steps are a fixed share of the vector.
const MAX_STEPS: u32 = 4000;
/// Steps after which near-contact is followed in coarse steps.
const FINE_STEPS: u32 = 400;
/// Steps by the clearance alone after which longer ones are looked for.
const PLAIN_STEPS: u32 = 48;
/// Bound of the halvings of a longer step.
const HALVINGS: u32 = 12;
/// Share of the way that a depth leads at most with which the deepest place is not looked for any closer.
const DEEP_ENOUGH: f64 = 0.5;
/// Share of how far a check surface is away that its distance need not be told closer, and in bands of it how near it is told in full.
const FAR_SHARE: f64 = 1e-3;
const NEAR: f64 = 2.0;
/// Bisections that bring a bracket to rounding.
const BISECTIONS: u32 = 60;
/// Places, each half way from the one before to the end of a vector, at which it is looked from where the tool comes to that.
const LOOKS_BEFORE_END: i32 = 6;
/// Places, as shares of a longer step, at which the tool is at least four fifths as far from the check surface as anywhere on it, if it bends one way.
const LOOKS_BETWEEN: [f64; 3] = [0.25, 0.5, 0.75];
/// Distance, relative to the size of the coordinates, at which tool and check surface touch but for rounding.
const SAME_PLACE: f64 = 1e-9;

/// A stopping position found on a cut vector.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event {
    pub(super) check: usize,
    /// Position on the straight vector.
    pub(super) tip: Vec3,
    /// Distance from the start of the vector.
    pub(super) x: f64,
    /// Side of the check surface on which the tool stands there.
    pub(super) side: f64,
    /// The path touches the check surface there without crossing it: the position is on the path already.
    pub(super) grazed: bool,
    /// Other vectors, elsewhere in their bands, may come to no such position.
    pub(super) is_shallow: bool,
}

/// Watches all check surfaces of a motion.
#[derive(Clone)]
pub(super) struct Watcher<'a> {
    prepared: &'a Prepared<'a>,
    checks: &'a [CheckSurface],
    watches: Rc<[Watch]>,
    /// Positions met so far with the relation asked for: too few of them.
    pub(super) met: usize,
    /// Least distance from a relation, where and of which check surface.
    pub(super) nearest: (f64, Vec3, usize),
    /// Where what may not count as a position ends last: how far the tool was in the check surface or out of it at most, the place, and which one that is.
    pub(super) touched: Option<(f64, Vec3, usize)>,
    /// Looks for the nearest approach on every vector, also where no position is within reach.
    thorough: bool,
    /// A distance from a relation up to which an approach need not be told closer.
    pub(super) near_enough: f64,
    /// Where contact with each check surface was last, on the natural side and on the other.
    memories: Rc<[[Memory; 2]]>,
}

impl<'a> Watcher<'a> {
    pub(super) fn new(prepared: &'a Prepared<'a>, checks: &'a [CheckSurface]) -> Self {
        let mut watcher = Self {
            prepared,
            checks,
            watches: Rc::new([]),
            met: 0,
            nearest: (f64::INFINITY, prepared.tip, 0),
            touched: None,
            thorough: false,
            near_enough: f64::NEG_INFINITY,
            memories: checks.iter().map(|_| Default::default()).collect(),
        };
        let watch = |(index, check): (usize, &CheckSurface)| {
            let (value, clear_on) = if is_tangent(check.relation) {
                (f64::INFINITY, 1.0)
            } else {
                watcher.value(index, &prepared.tool, &prepared.tip)
            };
            let working = &prepared.checks[index];
            let rest = if working.gauge.on { 0.0 } else { working.rest() };
            let status = if working.is_there(value + rest, prepared.size) {
                Status::Touching
            } else if value > 0.0 {
                Status::Clear
            } else {
                Status::Inside
            };
            let quiet = (prepared.tip, 0.0);
            Watch {
                status,
                farthest: value.abs(),
                farthest_at: prepared.tip,
                clear_on,
                count: 0,
                is_shallow: false,
                quiet,
                falling: false,
            }
        };
        watcher.watches = checks.iter().enumerate().map(watch).collect();
        watcher
    }

    /// The same watcher, but one that notes the nearest approach wherever that is.
    pub(super) fn thorough(&self) -> Self {
        Self { thorough: true, ..self.clone() }
    }

    fn working(&self, index: usize) -> &Working {
        &self.prepared.checks[index]
    }

    /// The function whose sign changes at a position, and the side of the surface.
    fn value(&self, index: usize, tool: &Tool, tip: &Vec3) -> (f64, f64) {
        let working = self.working(index);
        if working.gauge.on {
            let distance = working.gauge.surface.signed_distance(tip);
            return (distance, if distance < 0.0 { -1.0 } else { 1.0 });
        }
        self.value_within(index, tool, tip, Enough::ALL)
    }

    /// The same of a check surface that the tool is to be clear of, as closely as it is asked for.
    fn value_within(&self, index: usize, tool: &Tool, tip: &Vec3, enough: Enough) -> (f64, f64) {
        let Working { gauge, .. } = self.working(index);
        let rest = gauge.thickness + self.working(index).rest();
        let enough = enough.above(rest);
        let (contact, side) = separation(tool, &gauge.surface, tip, &self.memories[index], enough);
        (contact.clearance - rest, side)
    }

    /// The function, if it is far from changing its sign no closer than steps need it: it may then be less by a share.
    fn value_far(&self, index: usize, tool: &Tool, tip: &Vec3) -> (f64, f64) {
        let working = self.working(index);
        if working.gauge.on {
            return self.value(index, tool, tip);
        }
        let band = working.band();
        let rough = Enough { lowest: -band, slack: 0.0, share: FAR_SHARE };
        let (value, side) = self.value_within(index, tool, tip, rough);
        if value.abs() > NEAR * band { (value, side) } else { self.value(index, tool, tip) }
    }

    /// The function is at least this where it is positive and told by [`Self::value_far`].
    fn at_least(&self, index: usize, value: f64) -> f64 {
        let working = self.working(index);
        let band = working.band();
        if working.gauge.on || value <= NEAR * band { value } else { value - FAR_SHARE * (value + band) }
    }

    /// How far the relation of the nearest check surface is from a position; infinite where all stop at a tangency.
    pub(super) fn remaining(&self, tip: &Vec3, axis: &Vec3) -> f64 {
        let tool = self.prepared.tool.turned(*axis);
        let crossed = (0..self.checks.len()).filter(|index| !is_tangent(self.checks[*index].relation));
        crossed.map(|index| self.value(index, &tool, tip).0.abs()).fold(f64::INFINITY, f64::min)
    }

    /// The function at a distance from the start of a vector, if it is far from changing its sign no closer than steps need it.
    fn value_at(&self, index: usize, sweep: &Sweep<'_>, x: f64) -> (f64, f64) {
        let (tip, tool) = sweep.at(x);
        self.value_far(index, &tool, &tip)
    }

    /// Whether the tool is out of the band of a check surface half way from a position to the end of a vector.
    pub(super) fn leaves_band(&self, event: &Event, sweep: &Sweep<'_>) -> bool {
        let value = self.value_at(event.check, sweep, 0.5 * (event.x + sweep.length)).0;
        value.abs() > self.working(event.check).band()
    }

    /// Whether the tool may come to the end of a vector, at which it touches a check surface on a side, as its relation says: to TO from where it
    /// is clear on that side, to PAST from anywhere else. Where it is in the band from the start of the motion on there is no telling.
    pub(super) fn arrives(&self, (index, side): (usize, f64), sweep: &Sweep<'_>) -> bool {
        let relation = self.checks[index].relation;
        if is_tangent(relation) || relation == Relation::On || self.watches[index].status == Status::Touching
        {
            return true;
        }
        // What is between the tool and the end of the way is seen nearer and nearer to it.
        (1..=LOOKS_BEFORE_END).any(|k| {
            let share = 1.0 - 0.5_f64.powi(k);
            let (value, at_side) = self.value_at(index, sweep, share * sweep.length);
            (value > 0.0 && at_side == side) == (relation == Relation::To)
        })
    }

    /// Whether the tool has come from farther in the check surface, or out of it, than a touch is, so that it is at the position asked for where it now
    /// comes out of it or into it.
    pub(super) fn awaits(&self, index: usize) -> bool {
        let (watch, relation) = (&self.watches[index], self.checks[index].relation);
        let is_waiting = match relation {
            Relation::Past => watch.status == Status::Inside,
            Relation::On => watch.status != Status::Touching,
            _ => watch.status == Status::Clear,
        };
        let depth = watch.depth(self.working(index), (relation, watch.clear_on));
        let (place, comes_out) = (watch.farthest_at, watch.status == Status::Inside);
        is_waiting
            && depth.is_none_or(|depth| !self.is_touch(index, &Before { depth, place, comes_out }))
            && watch.count + 1 == self.checks[index].occurrence.max(1)
    }

    /// How far the function is above what it is where the tool just touches the check surface.
    fn apart(&self, index: usize, value: f64) -> f64 {
        let working = self.working(index);
        if working.gauge.on { value.abs() } else { value + working.gauge.thickness + working.rest() }
    }

    /// The first stop on a straight vector; without one the vector counts as travelled.
    pub(super) fn scan(&mut self, sweep: &Sweep<'_>) -> Option<Event> {
        let (from, to) = (sweep.at(0.0).0, sweep.at(sweep.length).0);
        let mut first: Option<Event> = None;
        let mut after = Vec::new();
        for index in 0..self.checks.len() {
            if is_tangent(self.checks[index].relation) {
                continue;
            }
            let watch = self.watches[index];
            let (quiet, radius) = watch.quiet;
            let within = (from - quiet).norm() < radius && (to - quiet).norm() < radius;
            if !self.thorough && !sweep.turns() && within {
                continue;
            }
            let (event, next) = self.follow(index, watch, sweep);
            if let Some(event) = event
                && first.is_none_or(|best| event.x < best.x)
            {
                first = Some(event);
            }
            after.push((index, next));
        }
        if first.is_none() {
            for (index, next) in after {
                self.met += (next.count - self.watches[index].count) as usize;
                Rc::make_mut(&mut self.watches)[index] = next;
            }
        }
        first
    }

    fn follow(&mut self, index: usize, watch: Watch, sweep: &Sweep<'_>) -> (Option<Event>, Watch) {
        let prepared = self.prepared;
        let working = &prepared.checks[index];
        let stretch = sweep.stretch(working.gauge.reach(&self.prepared.tool));
        let length = sweep.length;
        let (band, size) = (working.inside.max(working.outside), self.prepared.size);
        let least = working.touch_limit().max(1e-10 * size);
        let on = working.gauge.on;
        let relation = self.checks[index].relation;
        let wanted = self.checks[index].occurrence.max(1);
        let mut watch = watch;
        let mut trail = Trail::new(self.value_at(index, sweep, 0.0));
        let mut crossed = false;
        self.note(index, trail.value, &sweep.at(0.0).0);
        for step in 0..MAX_STEPS {
            if trail.x >= length {
                break;
            }
            let (x, value, side_before) = (trail.x, trail.value, trail.side);
            let floor = if step < FINE_STEPS { least } else { least.max(length / 64.0) };
            let plain = (x + self.way_to_change(index, sweep, (x, value)).max(floor) / stretch).min(length);
            let leap = if step < PLAIN_STEPS { None } else { self.leap(index, sweep, &trail, plain) };
            let next_x = leap.unwrap_or(plain);
            if leap.is_some() && watch.farthest <= self.near(index) {
                self.look_between(index, &mut watch, sweep, [x, next_x]);
            }
            let (tip, tool) = sweep.at(next_x);
            let (next, side) = self.value_far(index, &tool, &tip);
            self.note(index, next, &tip);
            let label = transition(&mut watch.status, next, band + 1e-9 * size, on);
            let crossing = label
                .filter(|label| *label == relation)
                .and_then(|label| self.bracket(index, sweep, [(x, value), (next_x, next)], (label, side)));
            crossed |= label.is_some_and(|label| label != relation) || crossing.is_some();
            // In a check surface the tool may already be nearer to its other side.
            let clear_on = if next > 0.0 { side } else { side_before };
            let depth = label.and_then(|label| watch.depth(working, (label, clear_on)));
            let was_at = watch.farthest_at;
            watch.go_on(label.is_some(), (next, clear_on), &tip);
            let before = depth.map(|depth| Before { depth, place: was_at, comes_out: next > 0.0 });
            let event = crossing.and_then(|found| self.count(index, &mut watch, sweep, (found, before)));
            if event.is_some() {
                return (event, watch);
            }
            let clear = watch.status == Status::Clear && value > 0.0 && next > 0.0;
            if clear
                && side != side_before
                && !on
                && let Some(at) = self.passage(index, sweep, [x, next_x], side_before)
            {
                crossed = true;
                let side = if relation == Relation::Past { side } else { side_before };
                let event = self.count(index, &mut watch, sweep, ((at, side), None));
                if event.is_some() {
                    return (event, watch);
                }
            }
            if let Some(bracket) = trail.step(next_x, (next, side)) {
                self.refine_nearest(index, sweep, bracket, next);
            }
        }
        if !crossed && let Some(event) = self.grazed(index, &mut watch, sweep, &trail, wanted) {
            return (Some(event), watch);
        }
        let clear_of =
            if trail.value > 0.0 { self.apart(index, trail.value).max(0.0) } else { f64::INFINITY };
        let way = self.way_to_change(index, sweep, (length, trail.value));
        watch.quiet = (sweep.at(length).0, way.min(clear_of));
        (None, watch)
    }

    /// Whether a tool that was so far in the check surface, or out of it, at a place, and comes out of it or into it, has only touched it: it is not past
    /// it then, or has not come to it anew. Nor is it where the vectors alone go to and fro in its band, elsewhere in theirs than the path at rest.
    fn is_touch(&self, index: usize, &Before { depth, place, comes_out }: &Before) -> bool {
        let working = self.working(index);
        let is_other = || self.at_rest(index, &place).is_some_and(|value| (value > 0.0) == comes_out);
        depth <= working.touch_limit() || depth <= working.inside.max(working.outside) && is_other()
    }

    /// Notes how far the tool is from a check surface between the ends of a longer step: these are not where it is the farthest.
    fn look_between(&self, index: usize, watch: &mut Watch, sweep: &Sweep<'_>, [low, high]: [f64; 2]) {
        for share in LOOKS_BETWEEN {
            let (tip, tool) = sweep.at(low + share * (high - low));
            watch.go_on(false, self.value_far(index, &tool, &tip), &tip);
        }
    }

    /// Counts a position at a distance along a vector; the stop if it is the last one. Before it the tool was so far in the check surface, or out of it, at a
    /// place, and comes out of it or into it.
    fn count(
        &mut self,
        index: usize,
        watch: &mut Watch,
        sweep: &Sweep<'_>,
        ((x, side), before): ((f64, f64), Option<Before>),
    ) -> Option<Event> {
        let tip = sweep.at(x).0;
        if let Some(before) = before.filter(|before| before.depth <= self.near(index)) {
            watch.is_shallow = true;
            if self.is_touch(index, &before) {
                self.touched = Some((before.depth, tip, index));
                return None;
            }
        }
        watch.count += 1;
        let is_shallow = watch.is_shallow;
        let is_last = watch.count >= self.checks[index].occurrence.max(1);
        is_last.then_some(Event { check: index, tip, x, side, grazed: false, is_shallow })
    }

    /// How far the tool goes at least, from a distance along a vector, before the function changes its sign. In a surface that ends the sides end with
    /// it, and how deep the tool is to either of them leaps; but no point of the surface comes out of the tool nearer than it is deep in that.
    fn way_to_change(&self, index: usize, sweep: &Sweep<'_>, (x, value): (f64, f64)) -> f64 {
        let Working { gauge, .. } = self.working(index);
        if value > 0.0 {
            return self.at_least(index, value);
        }
        if gauge.on || !gauge.surface.has_ends() {
            return value.abs();
        }
        let (tip, tool) = sweep.at(x);
        let offset = gauge.thickness + self.working(index).rest();
        let enough = DEEP_ENOUGH * value.abs() - offset;
        (tool.depth_of(&gauge.surface, &tip, enough) + offset).clamp(0.0, value.abs())
    }

    /// A longer step than by the clearance alone, over which the bound of the second derivative leaves no room for a
    /// position; or over which the samples at its ends say all that there is to say.
    fn leap(&self, index: usize, sweep: &Sweep<'_>, trail: &Trail, plain: f64) -> Option<f64> {
        let &Trail { x, value, side: side_before, .. } = trail;
        let working = self.working(index);
        let on = working.gauge.on;
        if value <= 0.0 && !on {
            return None;
        }
        let reach = working.gauge.reach(&self.prepared.tool);
        let (band, stretch) = (working.inside.max(working.outside), sweep.stretch(reach));
        let (mut end, witness) = (sweep.length, Witness::default());
        for _ in 0..HALVINGS {
            let step = end - x;
            if step <= 2.0 * (plain - x) {
                return None;
            }
            let (tip, tool) = sweep.at(end);
            let (next, side) = self.value_far(index, &tool, &tip);
            // Between two sides of the check surface there is a position, however clear of it the tool is at both ends.
            if (next > 0.0) == (value > 0.0) && side == side_before {
                let Gauge { surface, on, thickness, disk, .. } = working.gauge.clone();
                let thickness = if on { 0.0 } else { thickness };
                let gauge = Gauge { surface, on, side, thickness, disk, memory: Memory::default() };
                let way = step * stretch;
                let (middle, tool) = sweep.at(x + 0.5 * step);
                let base = if on { 0.0 } else { thickness + working.rest() };
                let (low, high) = (value.abs().min(next.abs()), value.abs().max(next.abs()));
                let range = [low - way + base, high + 2.0 * way + base];
                if let Some(Bend::AtMost(bend)) =
                    upward_bend(&gauge, &tool, (&middle, &[], &witness), 0.5 * way, range, &|_| true)
                {
                    let bend = if on { bend } else { bend * stretch * stretch + sweep.swing(reach) };
                    let [from, to] = [value, next].map(|value| self.at_least(index, value).abs());
                    let clear = lowest((from, to), bend, step) > band;
                    if clear || bend * step * step / 8.0 <= LEAST_STEP * working.band() {
                        return Some(end);
                    }
                }
            }
            end = x + 0.5 * step;
        }
        None
    }

    /// Where the tool goes through the check surface between two samples at which it is clear of it, on one side and on the
    /// other: a tool thinner than the steps, or than the place in the band where it stops. It is a TO and a PAST position.
    /// `None` where it only gets to the other side around the edge of the surface: clear of that on the one side, be it that it touches on the other,
    /// where the surface is taken for a body behind its end.
    fn passage(&self, index: usize, sweep: &Sweep<'_>, [low, high]: [f64; 2], side: f64) -> Option<f64> {
        let (mut low, mut high) = (low, high);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if self.value_at(index, sweep, middle).1 == side {
                low = middle;
            } else {
                high = middle;
            }
        }
        let touching = SAME_PLACE * self.prepared.size;
        let through =
            [low, high].iter().all(|x| self.apart(index, self.value_at(index, sweep, *x).0) <= touching);
        through.then_some(0.5 * (low + high))
    }

    fn note(&mut self, index: usize, value: f64, tip: &Vec3) {
        if value.abs() < self.nearest.0 {
            self.nearest = (value.abs(), *tip, index);
        }
    }

    /// The least distance between two samples about a third that is nearer, if it is nearer than all before and these are not near enough.
    fn refine_nearest(&mut self, index: usize, sweep: &Sweep<'_>, [low, high]: [f64; 2], last: f64) {
        if self.nearest.0 <= self.near_enough {
            return;
        }
        let reach = self.working(index).gauge.reach(&self.prepared.tool);
        if last.abs() - (high - low) * sweep.stretch(reach) >= self.nearest.0 {
            return;
        }
        // Of a tool deep in the surface it is not told at once how deep.
        for enough in [self.near_enough, f64::NEG_INFINITY] {
            let (x, told) = graze::least_or_enough([low, high], enough, &|x| {
                #[cfg(test)]
                REFINED.set(REFINED.get() + 1);
                self.value_at(index, sweep, x).0.abs()
            });
            let (tip, tool) = sweep.at(x);
            let value = self.value(index, &tool, &tip).0;
            if told > enough || value.abs() <= enough {
                return self.note(index, value, &tip);
            }
        }
    }

    /// Bisects a sign change; the side is that on which the tool is clear (TO: before, PAST: after), for ON that it
    /// comes from. Where the sign is the new one from the start on it has changed between two vectors, of which one ends and the other begins at
    /// the surface, but for rounding: there. `None` where the tool only gets around the end of the surface, beyond which the sign says nothing:
    /// there the value leaps.
    fn bracket(
        &self,
        index: usize,
        sweep: &Sweep<'_>,
        [from, to]: [(f64, f64); 2],
        (label, after): (Relation, f64),
    ) -> Option<(f64, f64)> {
        let (mut low, mut high) = (from, if (from.1 > 0.0) == (to.1 > 0.0) { from } else { to });
        let mut before = self.value_at(index, sweep, from.0).1;
        let mut beyond = after;
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low.0 + high.0);
            if middle <= low.0 || middle >= high.0 {
                break;
            }
            let (value, side) = self.value_at(index, sweep, middle);
            if (value > 0.0) == (from.1 > 0.0) {
                (low, before) = ((middle, value), side);
            } else {
                (high, beyond) = ((middle, value), side);
            }
        }
        if self.working(index).gauge.on {
            // The sign is the side. A place that is exactly on the surface, as these come to be, tells none.
            before = if to.1 > 0.0 { -1.0 } else { 1.0 };
        }
        let touching = SAME_PLACE * self.prepared.size;
        let met = low.1.abs().min(high.1.abs()) <= touching;
        met.then(|| (0.5 * (low.0 + high.0), if label == Relation::Past { beyond } else { before }))
    }
}

/// The last samples along a vector.
struct Trail {
    x: f64,
    value: f64,
    /// Side of the check surface.
    side: f64,
    /// The place before, and whether the way from there came nearer.
    before: (f64, bool),
    /// Least distance from the relation.
    least: f64,
}

impl Trail {
    fn new((value, side): (f64, f64)) -> Self {
        Self { x: 0.0, value, side, before: (0.0, false), least: value.abs() }
    }

    /// Takes the next sample; the stretch about the last one if that was nearer than both its neighbours.
    fn step(&mut self, x: f64, (value, side): (f64, f64)) -> Option<[f64; 2]> {
        let nearer = value.abs() < self.value.abs();
        let valley = (self.before.1 && !nearer).then_some([self.before.0, x]);
        self.before = (self.x, nearer);
        (self.x, self.value, self.side) = (x, value, side);
        self.least = self.least.min(value.abs());
        valley
    }
}

#[cfg(test)]
thread_local! {
    /// Places between samples at which this thread has looked for the nearest approach.
    pub(super) static REFINED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

#[cfg(test)]
mod tests;
