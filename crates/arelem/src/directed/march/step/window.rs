//! Where a path begins to bend the other way. A vector that goes as far as any can is tangent to a limit of the band and ends
//! at the other one, or is tangent to both; the vertices before it see no farther from anywhere but the last part of the
//! vector that leads to them, the window. So both limits are tried for the end of a vector along which the bend changes,
//! and its beginning may move back on the vector before.

use super::{Guess, Stepper, Trial};
use crate::{
    bound,
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
/// By how much of the vector before it a vertex moves back at each trial.
const SHARES: [f64; 6] = [0.035, 0.08, 0.15, 0.25, 0.4, 0.6];
/// What it moves more or less at the end, as shares of the best of these.
const FINER: [f64; 2] = [0.75, 1.3];
/// Share by which a vector that begins elsewhere is to reach farther at least to be tried.
const WORTH_TRYING: f64 = 0.25 * LEAST_GAIN;
/// Share of a vector that another one is to reach to at least which spares the vertex before it.
const WORTH_SPARING: f64 = 0.5;
/// Share of the length wanted below which it is all the same how long a vector is.
const WORTH_KNOWING: f64 = 0.7;

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
        if let Some(trial) = self.past(before, here, cap, &latest)? {
            self.trend.forget();
            self.follow(&before.tip, &trial);
            self.last = trial.vertex.tip - before.tip;
            return Ok(Some(Moved { from: *before, next: trial.vertex, all_the_way: true }));
        }
        let mut search = Search::new(&latest, (before.tip - here.tip, here), cap);
        let mut limits: Vec<[Bend; 2]> = vec![latest.bends];
        limits.extend(self.other_limits(&latest));
        for bends in limits {
            let mut last = if bends == latest.bends { latest.length } else { 0.0 };
            for share in SHARES {
                let Some(reached) = search.attempt(self, (share, last), bends)? else { break };
                if reached <= last {
                    break;
                }
                last = reached;
            }
        }
        if let Some((share, bends)) = search.best {
            for finer in FINER {
                let beaten = search.reach;
                search.attempt(self, (share * finer, beaten), bends)?;
            }
        }
        if search.reach < latest.length * (1.0 + LEAST_GAIN) {
            return Ok(None);
        }
        let Some((from, trial)) = search.found else { return Ok(None) };
        self.trend.forget();
        self.record_shortened(before, &from);
        self.follow(&from.tip, &trial);
        self.last = trial.vertex.tip - from.tip;
        Ok(Some(Moved { from, next: trial.vertex, all_the_way: false }))
    }

    /// Notes the bend along a vector that has come to end at another vertex.
    fn record_shortened(&mut self, from: &Vertex, to: &Vertex) {
        let readings = self.roles().map(|role| bound::read(&self.prepared.tool, role, [&from.tip, &to.tip]));
        self.note_bend(&from.tip, &to.tip, readings);
    }

    /// A vector from the vertex before that leads past the last vertex to the other limits: that vertex can be spared.
    fn past(
        &self,
        before: &Vertex,
        here: &Vertex,
        cap: f64,
        latest: &Trial,
    ) -> Result<Option<Trial>, MotionFailure> {
        let onward = latest.vertex.tip - here.tip;
        let least = (here.tip + onward * WORTH_SPARING - before.tip).norm();
        // Where the path doubles back a vector may lead to the vertex again, or end nearer than was asked for: two vertices would be spared
        // for each other in turn.
        let is_past = |trial: &Trial| {
            trial.length >= least
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

/// The search for a better beginning of a vector.
struct Search<'a> {
    latest: &'a Trial,
    /// From the vertex to the one before.
    back: Vec3,
    here: &'a Vertex,
    cap: f64,
    /// How far the best one reaches, from the vertex in the direction of the vector found first.
    reach: f64,
    /// Its share of the way back and its bends.
    best: Option<(f64, [Bend; 2])>,
    found: Option<(Vertex, Trial)>,
}

impl<'a> Search<'a> {
    fn new(latest: &'a Trial, (back, here): (Vec3, &'a Vertex), cap: f64) -> Self {
        Self { latest, back, here, cap, reach: latest.length, best: None, found: None }
    }

    /// How far the longest vector leads that begins at a share of the way back, if that is farther than one that is beaten.
    fn attempt(
        &mut self,
        stepper: &Stepper<'_>,
        (share, beaten): (f64, f64),
        bends: [Bend; 2],
    ) -> Result<Option<f64>, MotionFailure> {
        let Self { latest, here, .. } = *self;
        let from = Vertex::at(stepper.prepared, here.tip + self.back * share, &-self.back)?;
        let onward = latest.vertex.tip - here.tip;
        let way = (latest.vertex.tip - from.tip).norm();
        let gained = |reach: f64| way + reach + WORTH_TRYING * latest.length - latest.length;
        let length = gained(self.reach);
        let least = gained(beaten).max(WORTH_KNOWING * length);
        let guess = Guess { bends, curvature: latest.curvature, length };
        let Some(trial) = stepper.longest_of_use(&from, self.cap, &guess, least)? else {
            return Ok(None);
        };
        let reached = (trial.vertex.tip - here.tip).dot(&onward) / latest.length;
        if reached > self.reach {
            self.reach = reached;
            self.best = Some((share, bends));
            self.found = Some((from, trial));
        }
        Ok(Some(reached))
    }
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
