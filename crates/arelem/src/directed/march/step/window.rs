//! Where a path begins to bend the other way. A vector that goes as far as any can is tangent to a limit of the band and ends
//! at the other one, or is tangent to both; the vertices before it see no farther from anywhere but the last part of the
//! vector that leads to them, the window. So both limits are tried for the end of a vector along which the bend changes,
//! and its beginning may move back on the vector before: to where the corridors of the bands ([`Corridor`]) foretell that the next one leads
//! farthest.

use super::{
    Guess, LONG_ENOUGH, Places, Stepper, Trial,
    corridor::{Corridor, Foretold},
    sharp_corner::is_elsewhere,
};
use crate::{
    bound::{self, Reading},
    clearance::{Contact, Shape},
    directed::march::Vertex,
    error::MotionFailure,
    role::{Bend, Working},
};
use apt_geometry::Vec3;

/// Sag of a stretch below this share of the band does not tell how it bends.
const TELLING: f64 = 0.05;
/// How many times the length of a vector to one limit is first tried towards the other.
const BEYOND: f64 = 1.5;
/// Share by which a vector must reach farther to be preferred.
const LEAST_GAIN: f64 = 0.02;
/// Distance, as a share of the band, of a vector's beginning from where it ends or ought to begin above which the beginning may
/// move.
const MISPLACED: f64 = 0.5;
/// Share of a vector that another one is to reach to at least which spares the vertex before it.
const WORTH_SPARING: f64 = 0.5;
/// How often half of what has been read of a vector is read again where cubics do not tell what is there.
const DEEPEST: u32 = 3;
/// Bound of the places that are read before a vector is tried, and of the vectors that are tried.
const MOST_LOOKS: u32 = 6;
const MOST_TRIED: u32 = 4;
/// Share of a vector by which another one is to be longer to be tried in its place.
const NEARLY: f64 = 0.005;
/// Share of what a vector was to gain by which the next one is shorter if it was refused, and how far out of its band, in widths of that, it was
/// if the next one is hardly shorter.
const LESS: f64 = 0.25;
const HARDLY: f64 = 0.02;
/// Places along a vector that was refused, in the next of which to where it was worst it is read.
const PLACES: f64 = 64.0;

/// How clearances bend at both ends of a vector.
pub(super) struct Course {
    pub(super) at_start: [Option<Bend>; 2],
    pub(super) at_end: [Option<Bend>; 2],
    pub(super) next_curvature: [f64; 2],
}

/// A vector that begins farther back than the one found first.
pub(in crate::directed::march) struct Moved {
    pub(in crate::directed::march) from: Vertex,
    pub(in crate::directed::march) next: Vertex,
    /// It begins at the vertex before.
    pub(in crate::directed::march) all_the_way: bool,
}

impl Trial {
    /// True if a clearance bends one way at the start and the other way at the end.
    pub(super) fn wavers(&self) -> bool {
        self.at_start.iter().zip(&self.at_end).any(|(a, b)| a.is_some() && b.is_some() && a != b)
    }
}

impl Stepper<'_> {
    /// How clearances bend along a vector, from their values and slopes at its ends.
    pub(super) fn course(&self, from: &Vertex, to: &Vertex, direction: &Vec3, mean: &[f64; 2]) -> Course {
        let length = (to.tip - from.tip).norm();
        let ends = [(&from.part, &to.part), (&from.drive, &to.drive)];
        let mut course = Course { at_start: [None; 2], at_end: [None; 2], next_curvature: *mean };
        for (k, role) in self.roles().into_iter().enumerate() {
            if role.shape != Shape::General || self.is_turned(k) {
                continue;
            }
            let [start, end] = bends_of_cubic(ends[k], direction, length);
            course.at_start[k] = told(role, start, length);
            course.at_end[k] = told(role, end, length);
            if course.at_end[k].is_some() && (end > 0.0) != (mean[k] > 0.0) {
                course.next_curvature[k] = end;
            }
        }
        course
    }

    /// Where a clearance bends the other way at the end of a vector: one that ends at the other limit, if it is longer.
    pub(super) fn at_the_other_limit(
        &self,
        here: &Vertex,
        cap: f64,
        best: &Trial,
    ) -> Result<Option<Trial>, MotionFailure> {
        let mut bends = best.bends;
        for (bend, end) in bends.iter_mut().zip(best.at_end) {
            *bend = end.unwrap_or(*bend);
        }
        if bends == best.bends || best.length >= cap * (1.0 - 1e-6) {
            return Ok(None);
        }
        let (curvature, length) = (best.next_curvature, BEYOND * best.length);
        let least = best.length * (1.0 + LEAST_GAIN);
        self.longest_of_use(here, cap, &Guess { bends, curvature, length }, least)
    }

    /// The start of a vector moved back along the vector before it, and where the vector then leads, if that is farther.
    pub(in crate::directed::march) fn moved_back(
        &mut self,
        before: &Vertex,
        here: &Vertex,
        cap: f64,
    ) -> Result<Option<Moved>, MotionFailure> {
        let Some(latest) = self.latest.take() else { return Ok(None) };
        let at_cap = latest.length >= cap.min(self.maximum) * (1.0 - 1e-6);
        if at_cap || self.prepared.attitude.turns() || !self.may_gain(here, &latest) {
            return Ok(None);
        }
        let Some(corridor) = Corridor::beside((before, here), &latest, self.roles(), cap) else {
            return Ok(None);
        };
        let onward = (latest.vertex.tip - here.tip) / latest.length;
        let mut window = Window { before, here, latest: &latest, onward, cap, corridor };
        self.survey(&mut window)?;
        if let Some(trial) = self.past(&mut window)? {
            self.trend.forget();
            self.follow(&before.tip, &trial);
            self.last = trial.vertex.tip - before.tip;
            return Ok(Some(Moved { from: *before, next: trial.vertex, all_the_way: true }));
        }
        let Some(Found { from, trial, .. }) = self.farther(&mut window)? else { return Ok(None) };
        self.trend.forget();
        self.record_shortened(before, &from);
        self.follow(&from.tip, &trial);
        self.last = trial.vertex.tip - from.tip;
        Ok(Some(Moved { from, next: trial.vertex, all_the_way: false }))
    }

    /// Notes the bend along a vector that has come to end at another vertex.
    pub(super) fn record_shortened(&mut self, from: &Vertex, to: &Vertex) {
        let readings = self.roles().map(|role| bound::read(&self.prepared.tool, role, [&from.tip, &to.tip]));
        self.note_bend(&from.tip, &to.tip, readings);
    }

    /// Reads both vectors where the cubics between what is known do not tell what is there.
    fn survey(&self, window: &mut Window<'_>) -> Result<(), MotionFailure> {
        let [before, here, end] = [window.before.tip, window.here.tip, window.latest.vertex.tip];
        for (from, to) in [(here, end), (before, here)] {
            let mut open = vec![(0.0, 1.0, 0)];
            while let Some((low, high, depth)) = open.pop() {
                let middle = 0.5 * (low + high);
                let is_new = self.read(window, from + (to - from) * middle)?;
                if is_new && depth < DEEPEST {
                    open.extend([(low, middle, depth + 1), (middle, high, depth + 1)]);
                }
            }
        }
        Ok(())
    }

    /// Reads both clearances at a place; whether they are other than was known. Errors: cancelled.
    fn read(&self, window: &mut Window<'_>, place: Vec3) -> Result<bool, MotionFailure> {
        if self.patience.is_over() {
            return Err(MotionFailure::Cancelled);
        }
        Ok(window.corridor.note(&Vertex::at(self.prepared, place, &window.onward)?))
    }

    /// A vector from the vertex before that leads past the last vertex: that vertex can be spared.
    fn past(&self, window: &mut Window<'_>) -> Result<Option<Trial>, MotionFailure> {
        let Window { before, here, latest, cap, .. } = *window;
        let worth = WORTH_SPARING * latest.length;
        let foretold = self.looked_at(window, worth, &|corridor| corridor.from(1.0))?;
        if foretold.reach < worth {
            return Ok(None);
        }
        let onward = latest.vertex.tip - here.tip;
        let least = (here.tip + onward * WORTH_SPARING - before.tip).norm();
        // Where the path doubles back a vector may lead to the vertex again, or end nearer than was asked for: two vertices would be spared
        // for each other in turn.
        let is_past = |trial: &Trial| {
            trial.length >= least
                && self.leads_as(latest, before, trial)
                && (trial.vertex.tip - here.tip).dot(&onward) >= LEAST_GAIN * onward.norm_squared()
        };
        let length = (latest.vertex.tip - before.tip).norm();
        for bends in [Some(latest.bends), self.other_limits(latest)].into_iter().flatten() {
            let guess = Guess { bends, curvature: latest.curvature, length };
            let found = self.longest_of_use(before, cap, &guess, least)?.filter(is_past);
            if found.is_some() {
                return Ok(found);
            }
        }
        Ok(None)
    }

    /// Whether a vector leads along what the latest one leads to, or on the hand of the path at least: out of a neck the path goes along one wall
    /// alone, however near the other one is.
    fn leads_as(&self, latest: &Trial, from: &Vertex, found: &Trial) -> bool {
        let Vertex { tip, part, drive, .. } = &found.vertex;
        let along = || self.hand.along(part, drive).is_none_or(|along| along.dot(&(tip - from.tip)) > 0.0);
        !is_elsewhere(&latest.vertex, &found.vertex) || along()
    }

    /// A vector from a place on the vector before that leads farther than the latest one: where that is foretold to be farthest. Each that is
    /// tried tells more.
    fn farther(&self, window: &mut Window<'_>) -> Result<Option<Found>, MotionFailure> {
        let latest = window.latest.length;
        let worth = (1.0 + LEAST_GAIN) * latest;
        let (mut best, mut most): (Option<Found>, f64) = (None, f64::INFINITY);
        for _ in 0..MOST_TRIED {
            let least = best.as_ref().map_or(worth, |found| found.reach + NEARLY * found.trial.length);
            let foretold = self.looked_at(window, least, &Corridor::best)?.within(most, latest);
            if foretold.reach < best.as_ref().map_or(worth, |found| found.worth(&foretold)) {
                break;
            }
            let from = window.beginning(self, foretold.share)?;
            let trial = self.attempt_foretold(&from, &foretold, window)?;
            let is_nearly = trial.as_ref().is_some_and(|trial| self.is_nearly(trial));
            let is_of_use = |trial: &Trial| trial.proven && self.leads_as(window.latest, &from, trial);
            if let Some(trial) = trial.filter(is_of_use) {
                let reach = window.reached(&trial);
                if reach >= least {
                    best = Some(Found { share: foretold.share, reach, from, trial });
                }
            } else {
                let less = if is_nearly { 0.0 } else { LESS * (foretold.reach - least) };
                most = foretold.reach - less.max(NEARLY * foretold.length);
            }
        }
        Ok(best)
    }

    /// What is foretold, from what is known as far as a vector is to lead that is of use.
    fn looked_at(
        &self,
        window: &mut Window<'_>,
        worth: f64,
        ask: &dyn Fn(&mut Corridor) -> Foretold,
    ) -> Result<Foretold, MotionFailure> {
        let mut foretold = ask(&mut window.corridor);
        for _ in 0..MOST_LOOKS {
            let unknown = (foretold.reach >= worth).then(|| window.corridor.unknown(&foretold)).flatten();
            let Some(x) = unknown else { break };
            let place = window.corridor.place(x);
            let is_new = self.read(window, place)?;
            foretold = ask(&mut window.corridor);
            if !is_new && !window.corridor.is_beyond(foretold.reach) {
                break;
            }
        }
        Ok(foretold)
    }

    /// Tries a vector that has been foretold, and reads where that does not come true.
    fn attempt_foretold(
        &self,
        from: &Vertex,
        foretold: &Foretold,
        window: &mut Window<'_>,
    ) -> Result<Option<Trial>, MotionFailure> {
        let Foretold { bends, curvature, length, .. } = foretold;
        let targets = self.targets(from, bends, Places::Limits);
        let trial = self.attempt(from, length.min(window.cap), window.cap, (targets, curvature, bends));
        window.corridor.note(from);
        if let Some(trial) = &trial {
            window.corridor.note(&trial.vertex);
            if let Some(place) = (!trial.proven).then(|| farthest_out(from, trial)).flatten() {
                self.read(window, place)?;
            }
        }
        Ok(trial)
    }

    /// Whether a vector that was refused is hardly out of its band.
    fn is_nearly(&self, trial: &Trial) -> bool {
        let overlong = self.overlong(trial.length, trial);
        overlong.beyond <= HARDLY * self.roles()[trial.culprit].band()
    }

    /// The bends with which a vector ends at the other limits of clearances that are neither convex nor concave.
    fn other_limits(&self, latest: &Trial) -> Option<[Bend; 2]> {
        let mut bends = latest.bends;
        for (bend, role) in bends.iter_mut().zip(self.roles()) {
            *bend = match *bend {
                Bend::Convex if role.shape == Shape::General => Bend::Concave,
                Bend::Concave if role.shape == Shape::General => Bend::Convex,
                other => other,
            };
        }
        (bends != latest.bends).then_some(bends)
    }

    /// True if a vector bends both ways, or leads from one limit to the other, or begins at the limit that its sag goes to.
    fn may_gain(&self, here: &Vertex, latest: &Trial) -> bool {
        let clearances = |vertex: &Vertex| [vertex.part.clearance, vertex.drive.clearance];
        let (starts, ends) = (clearances(here), clearances(&latest.vertex));
        let is_misplaced = |(k, role): (usize, &Working)| {
            let far = |clearance: f64| (starts[k] - clearance).abs() > MISPLACED * role.band();
            role.shape == Shape::General
                && (far(ends[k]) || latest.at_start[k].is_some_and(|bend| far(role.vertex(bend))))
        };
        latest.wavers() || self.roles().into_iter().enumerate().any(is_misplaced)
    }
}

/// What is known where a better beginning of a vector is looked for.
struct Window<'a> {
    before: &'a Vertex,
    here: &'a Vertex,
    /// The vector from here that has been found, and its direction.
    latest: &'a Trial,
    onward: Vec3,
    cap: f64,
    corridor: Corridor,
}

impl Window<'_> {
    /// The place on the vector before at a share of the way back.
    fn beginning(&self, stepper: &Stepper<'_>, share: f64) -> Result<Vertex, MotionFailure> {
        let back = self.before.tip - self.here.tip;
        Vertex::at(stepper.prepared, self.here.tip + back * share, &-back)
    }

    /// How far a vector reaches, from the vertex in the direction of the latest one.
    fn reached(&self, trial: &Trial) -> f64 {
        (trial.vertex.tip - self.here.tip).dot(&self.onward)
    }
}

/// A vector that has been proven.
struct Found {
    /// The share of the way back at which it begins.
    share: f64,
    from: Vertex,
    reach: f64,
    trial: Trial,
}

impl Found {
    /// How far another one is to reach to be tried: one whose sag fills the band is as long as any from where it begins.
    fn worth(&self, foretold: &Foretold) -> f64 {
        let is_full = self.trial.growth <= 1.0 + LONG_ENOUGH;
        if is_full && foretold.share == self.share {
            return f64::INFINITY;
        }
        self.reach + if is_full { LEAST_GAIN } else { NEARLY } * foretold.length
    }
}

/// About where a vector that was refused was seen to be farthest out of its band: what is told by it shall not depend on rounding.
fn farthest_out(from: &Vertex, trial: &Trial) -> Option<Vec3> {
    let off = |reading: &Reading| (reading.value - trial.worst).abs();
    let known = trial.readings[trial.culprit].known();
    let worst = known.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
    let share = (worst.x / trial.length * PLACES).round() / PLACES;
    (share > 0.0 && share < 1.0).then(|| from.tip + (trial.vertex.tip - from.tip) * share)
}

/// The bend that a second derivative means, if its sag counts.
fn told(role: &Working, derivative: f64, length: f64) -> Option<Bend> {
    let counts = derivative.abs() * length * length / 8.0 > TELLING * role.band();
    counts.then_some(if derivative > 0.0 { Bend::Convex } else { Bend::Concave })
}

/// Second derivatives at both ends of the cubic through the clearances with their slopes.
fn bends_of_cubic((from, to): (&Contact, &Contact), direction: &Vec3, length: f64) -> [f64; 2] {
    let [start, end] = [from, to].map(|contact| contact.gradient.dot(direction));
    let rise = (to.clearance - from.clearance) / length;
    [(6.0 * rise - 4.0 * start - 2.0 * end) / length, (2.0 * start + 4.0 * end - 6.0 * rise) / length]
}
