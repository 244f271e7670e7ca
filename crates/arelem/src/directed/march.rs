//! The general route (ARLM3, ADELTA, CENTR2): from vertex to vertex along the common tangent of part and drive surface,
//! every cut vector as long as the proof of its tolerances allows, until a check surface is met.

mod creeping;
mod explained;
mod fewer;
mod finish;
mod never_met;
mod parallel_way;
mod scout;
mod shallow;
mod spared;
mod step;
mod straight;
mod surface_end;
mod tangency;

#[cfg(test)]
pub(crate) use self::fewer::TRIED;

use std::ops::ControlFlow;

use apt_geometry::{Vec3, motion::CheckSurface, patience::Patience};

pub(crate) use self::surface_end::end_from_behind;
use self::{creeping::Creeping, scout::Outlook, step::Stepper};
use super::{
    Path, Prepared,
    stop::{Event, Watcher},
};
use crate::{
    attitude::{Attitude, Sweep},
    bound,
    clearance::{Contact, Shape},
    error::{Iteration, MotionFailure},
    position::{self, Condition, Solution},
    section2::State,
};

/// A position on the path with what is known there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    pub(super) tip: Vec3,
    pub(super) axis: Vec3,
    pub(super) part: Contact,
    pub(super) drive: Contact,
    pub(super) tangent: Vec3,
}

impl Vertex {
    /// The contacts at a position; the tangent continues a given sense.
    pub(super) fn at(prepared: &Prepared, tip: Vec3, sense: &Vec3) -> Result<Self, MotionFailure> {
        let posture = prepared.attitude.posture(&tip)?;
        let part = posture.contact(&prepared.part.gauge, &tip);
        let drive = posture.contact(&prepared.drive.gauge, &tip);
        let axis = posture.tool.axis;
        Ok(Self { tip, axis, part, drive, tangent: tangent(&part, &drive, sense) })
    }

    /// The position on both surfaces next to a place, in the middle of their bands, with the path in a given sense.
    fn settled(prepared: &Prepared, place: &Vec3, sense: &Vec3) -> Option<Self> {
        Self::settled_at(prepared, [prepared.part.rest(), prepared.drive.rest()], place, sense)
    }

    /// The same with these clearances from part and drive surface.
    fn settled_at(
        prepared: &Prepared,
        [from_part, from_drive]: [f64; 2],
        place: &Vec3,
        sense: &Vec3,
    ) -> Option<Self> {
        let Prepared { attitude, part, drive, .. } = prepared;
        let conditions =
            [Condition::Passing(&part.gauge, from_part), Condition::Passing(&drive.gauge, from_drive)];
        Self::found(attitude, position::solve(attitude, &conditions, place).ok()?, sense)
    }

    /// What was found, in the same sense.
    fn found(attitude: &Attitude, solution: Solution, sense: &Vec3) -> Option<Self> {
        let Solution { tip, contacts: [Some(part), Some(drive), _], .. } = solution else { return None };
        let axis = attitude.tool_at(&tip).ok()?.axis;
        Some(Self { tip, axis, part, drive, tangent: tangent(&part, &drive, sense) })
    }

    /// Where the motion begins, with the axis that the tool has there: the first vector turns it if need be.
    fn start(prepared: &Prepared) -> Result<Self, MotionFailure> {
        let mut vertex = Self::at(prepared, prepared.tip, &prepared.tangent)?;
        // In a corner the path goes along another contact than the one that is measured.
        if !prepared.attitude.turns() && vertex.tangent.dot(&prepared.tangent) < SAME_LINE {
            vertex.tangent = prepared.tangent;
        }
        if prepared.attitude.turns() {
            vertex.axis = prepared.tool.axis;
            vertex.part.clearance = prepared.part.gauge.contact(&prepared.tool, &prepared.tip).clearance;
            vertex.drive.clearance = prepared.drive.gauge.contact(&prepared.tool, &prepared.tip).clearance;
        }
        Ok(vertex)
    }

    /// The straight move to another position.
    pub(super) fn sweep<'a>(&self, prepared: &'a Prepared<'a>, to: &Self) -> Sweep<'a> {
        Sweep::new(&prepared.tool, (&self.tip, &self.axis), (&to.tip, &to.axis))
    }
}

/// Unit tangent of the path in the given sense; that sense itself where the surfaces are tangent.
fn tangent(part: &Contact, drive: &Contact, sense: &Vec3) -> Vec3 {
    match part.gradient.cross(&drive.gradient).try_normalize(TANGENT_SINE) {
        Some(t) if t.dot(sense) >= 0.0 => t,
        Some(t) => -t,
        None => *sense,
    }
}

/// The first stop on a vector, by crossing a check surface or by a tangency; without one the vector counts as travelled.
fn first_stop<'a>(
    (watcher, tangency): (&mut Watcher<'a>, &mut tangency::Watch<'a>),
    sweep: &Sweep<'_>,
    [from, to]: [&Vertex; 2],
) -> Result<Option<Event>, MotionFailure> {
    if !tangency.has_any() {
        return Ok(watcher.scan(sweep));
    }
    let before = (watcher.clone(), tangency.clone());
    let found = [watcher.scan(sweep), tangency.scan(from, to)?];
    let first = found.into_iter().flatten().min_by(|a, b| a.x.total_cmp(&b.x));
    if first.is_some() {
        // The vector may be tried again shorter: what either saw on it does not count then.
        (*watcher, *tangency) = before;
    }
    Ok(first)
}

/// No last vector leads from a place to the stop.
fn without_last(tip: Vec3, limit: u32) -> MotionFailure {
    MotionFailure::IterationLimit { iteration: Iteration::FinalVector, limit, tip }
}

/// Sine between part and drive normal below which the line of motion is kept.
const TANGENT_SINE: f64 = 1e-7;
/// Cosine of the angle between two lines of motion below which they are not the same but for rounding.
const SAME_LINE: f64 = 1.0 - 1e-6;
/// Way, relative to the size of the coordinates, that is none but for rounding.
const NO_WAY: f64 = 1e-9;
/// How often a vector that ends at the check surface is shortened before giving up.
const MAX_FINALS: u32 = 60;
/// After so many of them the end is looked for where in the bands the last vertex is.
const PATIENT_FINALS: u32 = 12;
/// Cut vectors after which it is first looked whether a check surface lies ahead.
const FIRST_LOOK: usize = 25;
/// Cosine between the path and the way to the stop below which the vertex before it is taken back (60°).
const LEAST_FORWARD: f64 = 0.5;
/// Share of the way to the stop for the vertex before it, when one vector cannot reach it.
const SHARE_BEFORE_STOP: f64 = 0.55;
/// The same along a vector that leads beyond the stop, and back along the vector before.
const SHARES_BEFORE_STOP: [f64; 5] = [0.5, 0.65, 0.35, 0.8, 0.2];
const SHARES_BACK: [f64; 5] = [0.05, 0.12, 0.25, 0.45, 0.7];
/// Share of a vector beyond the stop up to it below which the stop lies across the path more than along it.
const LEAST_BEFORE_STOP: f64 = 0.05;

/// The path of a directed motion.
pub(super) fn run(
    state: &State,
    prepared: &Prepared,
    checks: &[CheckSurface],
    patience: Patience<'_>,
) -> Result<Path, MotionFailure> {
    let flat = prepared.part.shape == Shape::Flat && prepared.drive.shape == Shape::Flat;
    if flat && !prepared.attitude.turns() {
        return straight::run(prepared, checks, patience);
    }
    let mut march = March {
        state,
        prepared,
        checks,
        stepper: Stepper::new(prepared, state.maximum_step, patience),
        watcher: Watcher::new(prepared, checks),
        tangency: tangency::Watch::new(prepared, checks, patience),
        points: Vec::new(),
        look: FIRST_LOOK,
        ahead: 0.0,
        look_for_end: 1,
        creeping: Creeping::default(),
        revolutions: 0,
        mark: None,
        before: None,
    };
    march.run(patience)
}

/// What was known before the last cut vector, to make that vector again.
struct Before<'a> {
    vertex: Vertex,
    watcher: Watcher<'a>,
    tangency: tangency::Watch<'a>,
    revolutions: u32,
}

struct March<'a> {
    state: &'a State,
    prepared: &'a Prepared<'a>,
    checks: &'a [CheckSurface],
    stepper: Stepper<'a>,
    watcher: Watcher<'a>,
    tangency: tangency::Watch<'a>,
    points: Vec<Vec3>,
    /// Number of cut vectors after which it is time to look ahead, and the way along which a check surface is known to lie
    /// ahead.
    look: usize,
    ahead: f64,
    /// The same number for the end of a surface, where vectors become shorter.
    look_for_end: usize,
    creeping: Creeping,
    revolutions: u32,
    mark: Option<never_met::Mark>,
    before: Option<Before<'a>>,
}

impl<'a> March<'a> {
    fn run(&mut self, patience: Patience<'_>) -> Result<Path, MotionFailure> {
        let mut here = Vertex::start(self.prepared)?;
        let start = here;
        let mut cap = self.state.maximum_step;
        let mut finals = 0;
        while self.points.len() < self.state.maximum_points as usize {
            if patience.is_over() {
                return Err(MotionFailure::Cancelled);
            }
            self.look_for_end_beside(&here, patience)?;
            let mut next = match self.stepper.advance(&mut here, cap) {
                Ok(next) => next,
                Err(failure) => return Err(self.explained(&here, failure)),
            };
            if self.stepper.straight_on().is_some()
                && let Some([from, straight]) = self.stop_in_corner()?
            {
                (here, next) = (from, straight);
            }
            let mut before = self.snapshot(&here);
            let mut event = self.scan(&here, &next)?;
            // A vertex between the last one and a stop that the last one does not see stays there.
            if event.is_none() && finals == 0 && self.move_back(&start, (&mut here, &mut next), cap)? {
                before = self.snapshot(&here);
                event = self.scan(&here, &next)?;
            }
            let Some(event) = event else {
                self.before = Some(before);
                self.go_on(&start, (&here, &next), cap, patience)?;
                here = next;
                cap = self.state.maximum_step;
                continue;
            };
            match self.end_at(&event, &start, (&mut here, &next), finals)? {
                ControlFlow::Break(path) => return Ok(path),
                ControlFlow::Continue(length) => cap = length,
            }
            finals += 1;
        }
        self.judge_outlook(&here, patience)?;
        Err(MotionFailure::TooManyPoints {
            limit: self.state.maximum_points,
            maximum_step: self.state.maximum_step,
            remaining: self.watcher.remaining(&here.tip, &here.axis).min(self.tangency.nearest.abs()),
            at: here.tip,
        })
    }

    /// Keeps a vector on which nothing stops the motion, and looks whether the path leads on from there.
    fn go_on(
        &mut self,
        start: &Vertex,
        (here, next): (&Vertex, &Vertex),
        cap: f64,
        patience: Patience<'_>,
    ) -> Result<(), MotionFailure> {
        self.points.push(next.tip);
        self.count_revolution(start, here, next)?;
        self.look_ahead((here, next), patience)?;
        self.look_for_end(here, next, patience)?;
        self.count_creeping(here, next, cap)
    }

    /// Ends the motion where it is stopped on a vector that leads on, after so many vectors that were too long for that. The vertex that this one
    /// comes from may be taken back. Either the path, or how long the vector that is to be made in place of that one may be.
    fn end_at(
        &mut self,
        event: &Event,
        start: &Vertex,
        (here, next): (&mut Vertex, &Vertex),
        finals: u32,
    ) -> Result<ControlFlow<Path, f64>, MotionFailure> {
        if event.is_shallow && !self.prepared.attitude.turns() {
            return self.finished_on_vectors(start, event).map(ControlFlow::Break);
        }
        // An end at rest in the band may lie farther across the path than a last vector may be long: then where the
        // path is.
        let held = (finals >= PATIENT_FINALS).then_some([here.part.clearance, here.drive.clearance]);
        let begin = self.points.is_empty().then_some(&here.tip);
        let towards = finish::Towards { event, tangent: &next.tangent, held, begin };
        let sweep = here.sweep(self.prepared, next);
        let end = finish::end(self.prepared, self.checks, (&self.watcher, &sweep), &towards)?;
        let is_passed_by = self.is_passed_by(here, &end)?;
        // What turns the first vector is that the tool comes to its law, which takes a way; a later one is made shorter.
        if self.points.is_empty() && (is_passed_by || self.is_led_back(here, &end)) {
            return Err(without_last(here.tip, finals + 1));
        }
        if !is_passed_by && self.accept(here, &end.tip)? || self.bend_towards(here, next, &end.tip)? {
            self.points.push(end.tip);
            return self.finished(start, &end).map(ControlFlow::Break);
        }
        if finals >= MAX_FINALS {
            return Err(without_last(here.tip, MAX_FINALS));
        }
        if let Some(longer) = self.step_back(here, &end.tip) {
            return Ok(ControlFlow::Continue(SHARE_BEFORE_STOP * longer));
        }
        let cap = SHARE_BEFORE_STOP * (end.tip - here.tip).norm().min((next.tip - here.tip).norm());
        if cap <= NO_WAY * self.prepared.size {
            // The stop is where the last vertex already is.
            self.points.pop();
            self.points.push(end.tip);
            return Ok(ControlFlow::Break(self.path(&end)));
        }
        Ok(ControlFlow::Continue(cap))
    }

    /// From time to time, beyond where a check surface was seen ahead: ends a motion that cannot meet any.
    fn look_ahead(
        &mut self,
        (here, next): (&Vertex, &Vertex),
        patience: Patience<'_>,
    ) -> Result<(), MotionFailure> {
        self.ahead -= (next.tip - here.tip).norm();
        if self.points.len() < self.look || self.ahead > 0.0 {
            return Ok(());
        }
        self.look = 2 * self.points.len();
        self.judge_outlook(next, patience)
    }

    /// Looks as far ahead as the cut vectors that are left can reach: an error if nothing there stops the motion.
    fn judge_outlook(&mut self, from: &Vertex, patience: Patience<'_>) -> Result<(), MotionFailure> {
        let reach = self.state.reach_after(self.points.len());
        let watches = (&self.watcher, &self.tangency);
        match scout::ahead(self.prepared, self.checks, watches, from, reach, patience)? {
            Outlook::Nothing { course, nearest, met, parallel: (gap, check) } => {
                self.tangency.note_gap(check, gap);
                Err(self.never_met(nearest, course, met))
            }
            Outlook::Ends(end) => Err(self.surface_ends(&end)),
            Outlook::Open { way } => {
                self.ahead = way;
                Ok(())
            }
        }
    }

    /// Where one vector after the other hardly leads on, though none has to: that.
    fn count_creeping(&mut self, here: &Vertex, next: &Vertex, cap: f64) -> Result<(), MotionFailure> {
        let Prepared { part, drive, .. } = self.prepared;
        let vector = (next.tip - here.tip).norm();
        let Some((vectors, length)) = self.creeping.count(vector, cap, part.band().min(drive.band())) else {
            return Ok(());
        };
        let failure = MotionFailure::NoProgress { vectors, length, tip: next.tip };
        Err(self.explained(next, failure))
    }

    fn snapshot(&self, vertex: &Vertex) -> Before<'a> {
        Before {
            vertex: *vertex,
            watcher: self.watcher.clone(),
            tangency: self.tangency.clone(),
            revolutions: self.revolutions,
        }
    }

    /// Takes the last vertex back if it lies so near to the stop that the way there leads across the path and not
    /// along it: vertices lie at a limit of the band, the stop at rest in it. Gives the length of the vector to divide.
    fn step_back(&mut self, here: &mut Vertex, end: &Vec3) -> Option<f64> {
        let delta = end - here.tip;
        if delta.dot(&here.tangent) > LEAST_FORWARD * delta.norm() {
            return None;
        }
        let before = self.before.take()?;
        self.points.pop()?;
        let length = (here.tip - before.vertex.tip).norm();
        (self.watcher, self.tangency, self.revolutions) =
            (before.watcher, before.tangency, before.revolutions);
        *here = before.vertex;
        Some(length)
    }

    /// The first stop on a vector.
    fn scan(&mut self, here: &Vertex, next: &Vertex) -> Result<Option<Event>, MotionFailure> {
        first_stop((&mut self.watcher, &mut self.tangency), &here.sweep(self.prepared, next), [here, next])
    }

    /// Where the path has turned by more than a right angle: a vector straight on, if that comes to a check surface. What the tool meets in the
    /// corner, within its bands, is not behind it on the other leg.
    fn stop_in_corner(&self) -> Result<Option<[Vertex; 2]>, MotionFailure> {
        let Some([from, to]) = self.stepper.straight_on() else { return Ok(None) };
        let (mut watcher, mut tangency) = (self.watcher.clone(), self.tangency.clone());
        let sweep = from.sweep(self.prepared, to);
        let stop = first_stop((&mut watcher, &mut tangency), &sweep, [from, to])?;
        Ok(stop.map(|_| [*from, *to]))
    }

    /// Moves the last vertex back on the vector that leads to it, if the next one then goes farther. Both vectors are to be
    /// scanned without a stop before.
    fn move_back(
        &mut self,
        start: &Vertex,
        (here, next): (&mut Vertex, &mut Vertex),
        cap: f64,
    ) -> Result<bool, MotionFailure> {
        let Some(before) = &self.before else { return Ok(false) };
        let Some(moved) = self.stepper.moved_back(&before.vertex, here, cap)? else { return Ok(false) };
        let (mut watcher, mut tangency) = (before.watcher.clone(), before.tangency.clone());
        let (from, revolutions) = (before.vertex, before.revolutions);
        if moved.all_the_way {
            self.points.pop();
            self.before = None;
        } else {
            let sweep = from.sweep(self.prepared, &moved.from);
            if watcher.scan(&sweep).is_some() || tangency.scan(&from, &moved.from)?.is_some() {
                return Ok(false);
            }
            if let Some(last) = self.points.last_mut() {
                *last = moved.from.tip;
            }
        }
        (self.watcher, self.tangency, self.revolutions) = (watcher, tangency, revolutions);
        if !moved.all_the_way {
            self.count_revolution(start, &from, &moved.from)?;
        }
        (*here, *next) = (moved.from, moved.next);
        Ok(true)
    }

    /// The path to an end, without what it can do without.
    fn finished(&mut self, start: &Vertex, end: &finish::End) -> Result<Path, MotionFailure> {
        self.straighten_end(start, end)?;
        let along: Vec<Vec3> = std::iter::once(start.tip).chain(self.points.iter().copied()).collect();
        let bent = self.stepper.record.along(&along);
        self.spare_vertices(start)?;
        self.save_vectors(start, &along, &bent)?;
        if self.points.len() + 1 == along.len() {
            return Ok(self.path(end));
        }
        let bent = bound::to_end(self.prepared, &along, bent, self.state.maximum_step);
        Ok(Path { bent, ..self.path(end) })
    }

    fn path(&mut self, end: &finish::End) -> Path {
        let points = std::mem::take(&mut self.points);
        let bent = self.stepper.record.along(&points);
        Path { points, check: end.check, check_side: end.side, bent }
    }

    /// Whether a tool that turns on the way to the end, more than on the vector that leads beyond it, is past the check surface
    /// before it comes there.
    fn is_passed_by(&self, here: &Vertex, end: &finish::End) -> Result<bool, MotionFailure> {
        if !self.prepared.attitude.turns() {
            return Ok(false);
        }
        let to = Vertex::at(self.prepared, end.tip, &here.tangent)?;
        let sweep = here.sweep(self.prepared, &to);
        let event = self.watcher.clone().scan(&sweep);
        Ok(event.is_some_and(|event| self.watcher.leaves_band(&event, &sweep)))
    }

    /// Whether a tool that turns on the way to the end would be led back against the path: once it has turned where it stands it is past the end.
    fn is_led_back(&self, here: &Vertex, end: &finish::End) -> bool {
        self.prepared.attitude.turns()
            && (end.tip - here.tip).dot(&here.tangent) < -NO_WAY * self.prepared.size
    }

    /// Whether a vector to the end leads to the position there: a tool that turns goes another way on it than on those in whose place it is.
    fn arrives(&self, from: &Vertex, to: &Vertex, end: &finish::End) -> bool {
        let place = (end.check, end.side);
        !self.prepared.attitude.turns() || self.watcher.arrives(place, &from.sweep(self.prepared, to))
    }

    /// The last vector must keep the bands like any other, go forward, and not be longer than allowed.
    fn accept(&self, here: &Vertex, end: &Vec3) -> Result<bool, MotionFailure> {
        let delta = end - here.tip;
        if delta.dot(&here.tangent) < LEAST_FORWARD * delta.norm() && self.before.is_some() {
            return Ok(false);
        }
        if delta.norm() > self.state.maximum_step * (1.0 + 1e-9) {
            return Ok(false);
        }
        let end = Vertex::at(self.prepared, *end, &here.tangent)?;
        Ok(self.stepper.proven(here, &end))
    }

    /// Where the last vertex does not see the end: a place that does, on the vector that leads to that vertex or else on the
    /// one that leads beyond the end, becomes the last vertex. Both vectors are proven.
    fn bend_towards(&mut self, here: &Vertex, beyond: &Vertex, end: &Vec3) -> Result<bool, MotionFailure> {
        if self.prepared.attitude.turns() {
            return Ok(false);
        }
        if let Some(before) = &self.before
            && let Some(place) = self.seen_back(here, &before.vertex, end)?
            && let Some(last) = self.points.last_mut()
        {
            *last = place;
            return Ok(true);
        }
        let vector = beyond.tip - here.tip;
        let along = ((end - here.tip).dot(&vector) / vector.norm_squared()).min(1.0);
        if along < LEAST_BEFORE_STOP {
            return Ok(false);
        }
        let place = self.seen_from(here, (vector * along, &vector), &SHARES_BEFORE_STOP, end)?;
        self.points.extend(place);
        Ok(place.is_some())
    }

    /// The same on the vector between a vertex and the one before.
    fn seen_back(&self, here: &Vertex, before: &Vertex, end: &Vec3) -> Result<Option<Vec3>, MotionFailure> {
        let forward = here.tip - before.tip;
        self.seen_from(here, (-forward, &forward), &SHARES_BACK, end)
    }

    /// The first place at a share of a way, on a vector in the direction `forward`, from which a last vector leads to the end.
    fn seen_from(
        &self,
        here: &Vertex,
        (way, forward): (Vec3, &Vec3),
        shares: &[f64],
        end: &Vec3,
    ) -> Result<Option<Vec3>, MotionFailure> {
        for share in shares {
            let tip = here.tip + way * *share;
            let last = end - tip;
            // In a tight bend a place far back would see the end behind it.
            let is_ahead = last.dot(forward) > LEAST_FORWARD * last.norm() * forward.norm();
            if is_ahead
                && last.norm() <= self.state.maximum_step
                && self.accept(&Vertex::at(self.prepared, tip, forward)?, end)?
            {
                return Ok(Some(tip));
            }
        }
        Ok(None)
    }

    /// Leaves out vertices before the end that one straight move can bridge: on a straight stretch the search for the
    /// longest vector looks beyond the stop, where the path may turn, and cuts the stretch into pieces.
    fn straighten_end(&mut self, start: &Vertex, found: &finish::End) -> Result<(), MotionFailure> {
        let end = Vertex::at(self.prepared, found.tip, &self.prepared.tangent)?;
        while let Some(between) = self.points.len().checked_sub(2) {
            let vertex = |k: Option<usize>| match k {
                Some(k) => Vertex::at(self.prepared, self.points[k], &self.prepared.tangent),
                None => Ok(*start),
            };
            let from = vertex(between.checked_sub(1))?;
            let (way, until_now) = (end.tip - from.tip, self.points[between] - from.tip);
            // Nor may one vector turn the tool beyond where it comes to its law.
            let most = self.state.maximum_step.min(self.prepared.attitude.way_to_law(&from.tip));
            let long = way.norm() > most * (1.0 + 1e-9);
            // In a tight bend the way to the end leads back from where the path goes.
            let is_forward = tangent(&from.part, &from.drive, &until_now).dot(&way) > 0.0;
            if !long && is_forward && self.stepper.proven(&from, &end) && self.arrives(&from, &end, found) {
                self.points.remove(between);
                continue;
            }
            // The vertex before may see the end from farther back on the vector that leads to it.
            if let Some(last) = between.checked_sub(1)
                && !self.prepared.attitude.turns()
                && let before = vertex(last.checked_sub(1))?
                && let Some(place) = self.seen_back(&from, &before, &end.tip)?
            {
                self.points[last] = place;
                self.points.remove(between);
            }
            break;
        }
        Ok(())
    }
}
