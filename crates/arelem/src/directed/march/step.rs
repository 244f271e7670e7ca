//! One cut vector: as long as its proof allows (ADELTA, DELTA). Vertices lie at the limit opposite to the sag, so that
//! the whole band serves the sag; the length is found by a secant on the sag, which grows with the square of it. Where the
//! path begins to bend the other way both limits are tried, and the vertex before may move back on its vector ([`window`]).

mod corner;
mod exhaustive;
mod of_use;
mod overlong;
mod sag;
mod trend;
mod window;

use apt_geometry::{Vec3, surface::Surface};

use self::{
    overlong::Overlong,
    sag::{growth, sagging},
    trend::Trend,
};
use super::{Prepared, Vertex, tangent};
use crate::{
    bound::Record,
    clearance::{Contact, Shape},
    directed::{
        prepare::UNDETERMINED,
        proof::{self, Extremes, Ledger},
    },
    error::{Iteration, MotionFailure},
    position::{self, Condition, Solution},
    role::{Bend, GUARD, Working},
};

/// Bound of the trials for one vector.
const MAX_TRIALS: u32 = 60;
/// Bound of the corrections for the end of a vector: far above what a vector that leads on needs.
const CORRECTIONS: u32 = 20;
/// Bound of the trials that shorten a vector which the way back into the bands makes longer than is allowed.
const MOST_SHORTENINGS: u32 = 12;
/// Trials that try to lengthen a vector already proven.
const LENGTHENINGS: u32 = 4;
/// Length, relative to the size of the coordinates, below which a vector leads nowhere: well above the size below which a
/// reader of the path takes two positions for one.
const LEAST_VECTOR: f64 = 1e-8;
/// A vector whose length could grow by less than this share is long enough.
const LONG_ENOUGH: f64 = 2e-4;
/// Share of the band that the sag leaves: the less of it, the more places its proof takes.
const SPARED: f64 = 0.25 * GUARD;
/// Share of the predicted length that is tried.
const AIM: f64 = 0.9999;
/// Greatest growth of the length from one trial to the next.
const GREATEST_GROWTH: f64 = 4.0;
/// Share of the length that the next trial has at least.
const GREATEST_SHRINKING: f64 = 0.3;
/// Cosine between the directions at both ends below which the vector is shortened (60°).
const LEAST_TURN_COSINE: f64 = 0.5;
/// Ratio of the shortest vector that is too long to the longest that is proven at which no better one is looked for.
const NEARLY: f64 = 1.01;
/// How many times the width of the bands a vector may be long to round a corner of the path of up to a right angle.
const CORNER_BANDS: f64 = 20.0;
/// How many times the width of the bands a path goes on before what it does there is not turning on the spot any more.
const KINK_BANDS: f64 = 0.1;
/// How many times the square of the angle between path and vector at its start that at its end may be on a bend that goes on as it
/// begins: on one that grows tighter it is twice the angle at most.
const MOST_TURNED: f64 = 4.0;
/// Cosine of the angle between a vector and the path at its end below which that may go on either way.
const NEARLY_SQUARE: f64 = 0.1;
/// A surface whose sag over the longest vector is below this share of its band counts as straight.
const STRAIGHT_SHARE: f64 = 0.02;
/// Share of a vector's length by which its end may be expected aside of its tangent.
const FAR_ASIDE: f64 = 0.25;
/// Length, relative to the size of the coordinates, over which curvature is first estimated.
const PROBE: f64 = 1e-4;

/// Least length of a vector that keeps its place in the bands, as a share of the bands: less is no way round a bend.
const LEAST_LEVEL: f64 = 0.1;

/// Where in the bands a vector ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Places {
    /// At the limits opposite to the sag.
    Limits,
    /// Where it begins.
    Level,
}

/// Computes vectors one after the other, remembering curvature.
pub(super) struct Stepper<'a> {
    prepared: &'a Prepared,
    maximum: f64,
    cancel: &'a dyn Fn() -> bool,
    /// How clearances are expected to bend along the next vector.
    trend: Trend,
    /// The vector found last.
    latest: Option<Trial>,
    /// Where the path last turned on the spot, and its direction until then.
    turned: Option<(Vec3, Vec3)>,
    /// The last vector; zero before the first.
    last: Vec3,
    /// Where the path came from farther off than it may turn on the spot.
    arrived: Option<Arrival>,
    /// What proofs leave for the next ones: part, drive.
    ledgers: [Ledger; 2],
    /// Length of the longest vector so far.
    longest: f64,
    /// How the path bends so far, for the least number of vectors.
    pub(super) record: Record,
}

/// How the path came to a place.
#[derive(Clone, Copy)]
struct Arrival {
    at: Vec3,
    /// The vector that led there.
    vector: Vec3,
    /// The direction of the path at its end.
    tangent: Vec3,
}

#[derive(Clone)]
struct Trial {
    vertex: Vertex,
    length: f64,
    /// Second derivative of each clearance along the vector, on average.
    curvature: [f64; 2],
    /// The bends that tell at which limits it ends.
    bends: [Bend; 2],
    /// The bends at its start and at its end, where they count.
    at_start: [Option<Bend>; 2],
    at_end: [Option<Bend>; 2],
    /// What is to be expected of the next vector.
    next_curvature: [f64; 2],
    /// Factor by which the length could grow, below one if it must shrink.
    growth: f64,
    proven: bool,
    /// How the slopes of both clearances turn along the vector.
    turning: [f64; 2],
    culprit: usize,
    worst: f64,
}

/// What the search for the longest vector begins with.
struct Guess {
    bends: [Bend; 2],
    curvature: [f64; 2],
    length: f64,
}

impl<'a> Stepper<'a> {
    pub(super) fn new(prepared: &'a Prepared, maximum: f64, cancel: &'a dyn Fn() -> bool) -> Self {
        Self {
            prepared,
            maximum,
            cancel,
            trend: Trend::default(),
            latest: None,
            turned: None,
            last: Vec3::zeros(),
            arrived: None,
            ledgers: Default::default(),
            longest: 0.0,
            record: Record::new(&prepared.tip, maximum),
        }
    }

    fn roles(&self) -> [&Working; 2] {
        [&self.prepared.part, &self.prepared.drive]
    }

    /// The next vertex, at most `cap` away. Where the path turns sharply because the tool comes to touch a surface at a second
    /// place, the tangent of the vertex becomes that of the path beyond.
    pub(super) fn advance(&mut self, here: &mut Vertex, cap: f64) -> Result<Vertex, MotionFailure> {
        let failure = match self.onward(here, cap, Places::Limits) {
            Err(failure) if failure != MotionFailure::Cancelled => failure,
            found => return self.noted(here, found),
        };
        let corner = self.corner_at(here);
        if let Some(next) = self.around(&corner, here, cap) {
            return self.noted(here, Ok(next));
        }
        // Where the path bends tightly the way from one limit of the bands to the other is too steep: then level.
        self.trend.forget();
        let level = self.onward(here, cap, Places::Level);
        if matches!(level, Ok(_) | Err(MotionFailure::Cancelled)) {
            return self.noted(here, level);
        }
        match self.anywhere_onward(&corner, here, cap)? {
            Some(next) => self.noted(here, Ok(next)),
            None => Err(corner.explained(self.prepared, here, failure)),
        }
    }

    /// Remembers the direction of a vector.
    fn noted(
        &mut self,
        here: &Vertex,
        found: Result<Vertex, MotionFailure>,
    ) -> Result<Vertex, MotionFailure> {
        if let Ok(next) = &found {
            self.last = next.tip - here.tip;
            if !self.is_where_it_arrived(&next.tip) {
                let (vector, tangent) = (self.last, arrival(here, next));
                self.arrived = Some(Arrival { at: next.tip, vector, tangent });
            }
        }
        found
    }

    fn bands(&self) -> f64 {
        self.prepared.part.band() + self.prepared.drive.band()
    }

    /// True if all that the path has done since it arrived is to turn on the spot.
    fn is_where_it_arrived(&self, tip: &Vec3) -> bool {
        self.arrived.is_some_and(|arrival| (tip - arrival.at).norm() <= KINK_BANDS * self.bands())
    }

    /// True if the path, bit by bit, has turned so far on the spot that it goes back from where it came: against the vector that
    /// led there, and not plainly onward from how the path ended, from which a vector along a bend differs.
    fn kinks_back(&self, here: &Vertex, direction: &Vec3) -> bool {
        self.is_where_it_arrived(&here.tip)
            && self.arrived.is_some_and(|Arrival { vector, tangent, .. }| {
                let plainly = UNDETERMINED * direction.norm() * tangent.norm();
                direction.dot(&vector) < 0.0 && direction.dot(&tangent) < plainly
            })
    }

    /// True if the path would go back from where it came: against the last vector, or, near a place where it has turned on
    /// the spot, against its direction before that.
    fn leads_back(&self, here: &Vertex, tangent: &Vec3) -> bool {
        let near = CORNER_BANDS * self.bands();
        tangent.dot(&self.last) < 0.0
            || self.kinks_back(here, tangent)
            || self
                .turned
                .is_some_and(|(at, before)| (here.tip - at).norm() <= near && tangent.dot(&before) <= 0.0)
    }

    /// The next vertex along the tangent, at most `cap` away.
    fn onward(&mut self, here: &Vertex, cap: f64, places: Places) -> Result<Vertex, MotionFailure> {
        let cap = cap.min(self.maximum);
        let curvature = match self.trend.curvature() {
            Some(known) => known,
            None => self.probe(here)?,
        };
        let bends = self.bends(&curvature);
        let foretold = self.predict(here, &curvature, &bends);
        let length = foretold * self.trend.ratio();
        let mut best = self.longest(here, cap, places, &Guess { bends, curvature, length })?;
        self.trend.compare(foretold, best.length * best.growth * AIM);
        if places == Places::Limits
            && let Some(other) = self.at_the_other_limit(here, cap, &best)?
        {
            best = other;
        }
        self.follow(&here.tip, &best);
        let vertex = best.vertex;
        self.latest = Some(best);
        Ok(vertex)
    }

    /// Goes on with a vector.
    fn follow(&mut self, from: &Vec3, found: &Trial) {
        self.trend.follow(found);
        self.longest = self.longest.max(found.length);
        self.record.add(from, &found.vertex.tip, [&self.prepared.part, &self.prepared.drive], found.turning);
    }

    /// The longest vector that is proven, from a first guess.
    fn longest(
        &self,
        here: &Vertex,
        cap: f64,
        places: Places,
        guess: &Guess,
    ) -> Result<Trial, MotionFailure> {
        let mut bends = guess.bends;
        let mut bent = guess.curvature;
        let mut length = guess.length.min(cap);
        let mut best: Option<(Trial, f64)> = None;
        let (mut shortest_bad, mut lengthenings, mut failures) = (f64::INFINITY, 0, 0u32);
        let mut culprit = (self.prepared.part.name, 0.0);
        let mut last_bad: Option<Overlong> = None;
        let least = match places {
            Places::Limits => LEAST_VECTOR * self.prepared.size,
            Places::Level => LEAST_LEVEL * (self.prepared.part.band() + self.prepared.drive.band()),
        };
        for _ in 0..MAX_TRIALS {
            if length <= least {
                break;
            }
            if (self.cancel)() {
                return Err(MotionFailure::Cancelled);
            }
            let targets = self.targets(here, &bends, places);
            let Some(trial) = self.attempt(here, length, cap, (targets, &bent, &bends)) else {
                shortest_bad = shortest_bad.min(length);
                length *= 0.5;
                continue;
            };
            bent = trial.curvature;
            if trial.proven {
                let at_cap = trial.length >= cap * (1.0 - 1e-6);
                let enough = trial.growth <= 1.0 + LONG_ENOUGH || at_cap || lengthenings >= LENGTHENINGS;
                let growth = trial.growth;
                let next = (length * (growth * AIM).min(GREATEST_GROWTH)).min(cap);
                if best.as_ref().is_none_or(|(b, _)| trial.length > b.length) {
                    best = Some((trial, length));
                }
                if enough || next <= length * (1.0 + 1e-9) {
                    break;
                }
                let next_is_bad = next >= shortest_bad * (1.0 - LONG_ENOUGH);
                if next_is_bad && shortest_bad <= length * NEARLY {
                    break;
                }
                // What nothing bends yet is far from its length.
                lengthenings += u32::from(growth < GREATEST_GROWTH || next_is_bad);
                length = if next_is_bad { 0.5 * (length + shortest_bad) } else { next };
            } else {
                shortest_bad = shortest_bad.min(length);
                culprit = (self.roles()[trial.culprit].name, trial.worst);
                let bad = self.overlong(length, &trial);
                let line = last_bad.and_then(|last| bad.meets_band(&last));
                last_bad = Some(bad);
                if let Some((_, known)) = &best {
                    // Where the bend changes the sag says little about the length.
                    if shortest_bad <= known * NEARLY || lengthenings >= LENGTHENINGS {
                        break;
                    }
                    lengthenings += 1;
                    length = overlong::between(*known, shortest_bad, line.map(|share| share * length));
                    continue;
                }
                bends = self.bends(&trial.curvature);
                // Where the sag is not quadratic (contact jumps) the prediction is not trusted for long.
                failures += u32::from(failures > 0 || trial.growth >= 1.0);
                let most = 1.0 - 1e-3 * f64::from((1u32 << failures.min(9)) - 1);
                failures = failures.max(1);
                length *= (trial.growth.min(line.unwrap_or(1.0)) * AIM).clamp(GREATEST_SHRINKING, most);
            }
        }
        best.map(|(trial, _)| trial).ok_or(if shortest_bad.is_finite() && culprit.1 != 0.0 {
            MotionFailure::NoAdmissibleVector { role: culprit.0, clearance: culprit.1, tip: here.tip }
        } else {
            MotionFailure::IterationLimit {
                iteration: Iteration::StepLength,
                limit: MAX_TRIALS,
                tip: here.tip,
            }
        })
    }

    /// A trial that was refused, and how far the clearance for which that is was out of its band.
    fn overlong(&self, length: f64, trial: &Trial) -> Overlong {
        let role = self.roles()[trial.culprit];
        let (deep, high) = (-role.inside - trial.worst, trial.worst - role.outside);
        Overlong { culprit: trial.culprit, is_deep: deep > high, length, beyond: deep.max(high) }
    }

    /// True if the straight move between two positions keeps both bands.
    pub(super) fn proven(&self, from: &Vertex, to: &Vertex) -> bool {
        self.extremes(from, to).iter().all(|e| e.proven)
    }

    fn extremes(&self, from: &Vertex, to: &Vertex) -> [Extremes; 2] {
        let Prepared { part, drive, size, .. } = self.prepared;
        let sweep = from.sweep(self.prepared, to);
        let [for_part, for_drive] = &self.ledgers;
        let over = |role, ledger, a, b| proof::extremes(&sweep, role, ledger, a, b, *size, self.cancel);
        [
            over(part, for_part, (&from.tip, &from.part), (&to.tip, &to.part)),
            over(drive, for_drive, (&from.tip, &from.drive), (&to.tip, &to.drive)),
        ]
    }

    /// Whether the clearance of a role changes with the axis, too. Its gradient then follows the law of that, from which a vector, on
    /// which the tool turns evenly, is as far as from the path.
    fn is_turned(&self, role: usize) -> bool {
        self.prepared.attitude.turns() && !self.roles()[role].gauge.on
    }

    /// Curvature from the change of the slopes over a short way.
    fn probe(&self, here: &Vertex) -> Result<[f64; 2], MotionFailure> {
        let reach = PROBE * self.prepared.size;
        let ahead = Vertex::at(self.prepared, here.tip + here.tangent * reach, &here.tangent)?;
        let behind = Vertex::at(self.prepared, here.tip - here.tangent * reach, &here.tangent)?;
        let rate = |a: &Contact, b: &Contact| (b.gradient - a.gradient).dot(&here.tangent) / (2.0 * reach);
        Ok([rate(&behind.part, &ahead.part), rate(&behind.drive, &ahead.drive)])
    }

    fn bends(&self, curvature: &[f64; 2]) -> [Bend; 2] {
        let mut bends = [Bend::Straight; 2];
        for ((bend, role), k) in bends.iter_mut().zip(self.roles()).zip(curvature) {
            let sag = k.abs() * self.maximum * self.maximum / 8.0;
            *bend = match role.shape {
                _ if sag <= STRAIGHT_SHARE * role.band() => Bend::Straight,
                Shape::Flat => Bend::Straight,
                // Under a solid that reaches into the top of the tool the path may bend the other way.
                Shape::Convex if *k < 0.0 => Bend::Concave,
                Shape::Convex => Bend::Convex,
                Shape::Concave => Bend::Concave,
                Shape::General if *k > 0.0 => Bend::Convex,
                Shape::General => Bend::Concave,
            };
        }
        bends
    }

    /// Length at which a parabola of the known curvature fills the bands.
    fn predict(&self, here: &Vertex, curvature: &[f64; 2], bends: &[Bend; 2]) -> f64 {
        // A clearance that hardly bends along one vector may do so soon.
        let mut length =
            if self.longest > 0.0 { self.maximum.min(GREATEST_GROWTH * self.longest) } else { self.maximum };
        let clearances = [here.part.clearance, here.drive.clearance];
        for (((role, k), bend), clearance) in self.roles().iter().zip(curvature).zip(bends).zip(clearances) {
            let (at_start, at_end) = match bend {
                Bend::Straight => continue,
                Bend::Convex => (clearance + role.inside, role.vertex(*bend) + role.inside),
                Bend::Concave => (role.outside - clearance, role.outside - role.vertex(*bend)),
            };
            let spared = SPARED * role.band();
            let reach = |room: f64| (2.0 * (room - spared).max(0.0) / k.abs().max(f64::MIN_POSITIVE)).sqrt();
            length = length.min(reach(at_start) + reach(at_end));
        }
        length.max(1e-9 * self.prepared.size)
    }

    /// The clearances that a vector is to end with.
    fn targets(&self, here: &Vertex, bends: &[Bend; 2], places: Places) -> [f64; 2] {
        match places {
            Places::Limits => [self.prepared.part.vertex(bends[0]), self.prepared.drive.vertex(bends[1])],
            Places::Level => [here.part.clearance, here.drive.clearance],
        }
    }

    /// Tries a vector of about this length; `None` if there is no position ahead or it is too long.
    fn attempt(
        &self,
        here: &Vertex,
        length: f64,
        cap: f64,
        how: ([f64; 2], &[f64; 2], &[Bend; 2]),
    ) -> Option<Trial> {
        let Prepared { attitude, part, drive, .. } = self.prepared;
        let (targets, curvature, bends) = how;
        let conditions =
            [Condition::Clearance(&part.gauge, targets[0]), Condition::Clearance(&drive.gauge, targets[1])];
        let mut attempted = length;
        for _ in 0..MOST_SHORTENINGS {
            let start = ahead(here, attempted, targets, curvature);
            let Solution { tip, contacts, .. } =
                position::solve_within(attitude, &conditions, &start, CORRECTIONS).ok()?;
            let [Some(part), Some(drive), _] = contacts else { return None };
            let chord = tip - here.tip;
            let reached = chord.norm();
            if reached <= cap * (1.0 + 1e-9) {
                let axis = attitude.tool_at(&tip).ok()?.axis;
                let vertex =
                    Vertex { tip, axis, part, drive, tangent: tangent(&part, &drive, &here.tangent) };
                return self.judge(here, vertex, (chord, reached), bends);
            }
            // The correction made it longer than allowed: try again a little shorter.
            attempted *= (cap / reached) * (1.0 - 1e-6);
            if attempted < 0.5 * length {
                return None;
            }
        }
        None
    }

    /// How long a vector may be that rounds a corner. The path has one over the vertex of a cone, and, while the axis stands
    /// still, wherever the tool comes to touch a surface at a second place.
    fn corner(&self) -> f64 {
        let turns = self.prepared.attitude.turns();
        let may_turn = |role: &&Working| match role.gauge.surface {
            Surface::Cone(_) => true,
            _ => !turns && role.shape != Shape::Flat,
        };
        CORNER_BANDS * self.roles().into_iter().filter(may_turn).map(Working::band).sum::<f64>()
    }

    fn judge(
        &self,
        here: &Vertex,
        vertex: Vertex,
        (chord, reached): (Vec3, f64),
        bends: &[Bend; 2],
    ) -> Option<Trial> {
        let forward = chord.dot(&here.tangent) > 0.5 * reached;
        let least_cosine = if reached <= self.corner() { 0.0 } else { LEAST_TURN_COSINE };
        if !forward
            || self.kinks_back(here, &chord)
            || reached <= LEAST_VECTOR * self.prepared.size
            || vertex.tangent.dot(&here.tangent) < least_cosine
        {
            return None;
        }
        let mut vertex = Vertex { tangent: tangent(&vertex.part, &vertex.drive, &chord), ..vertex };
        // Where the path turns by about a right angle at the end of a bend the vector does not tell which way it goes on.
        if vertex.tangent.dot(&chord) < NEARLY_SQUARE * reached {
            vertex.tangent = tangent(&vertex.part, &vertex.drive, &along_arc(here, &chord));
        }
        let direction = chord / reached;
        let turn = |a: &Contact, b: &Contact| (b.gradient - a.gradient).dot(&direction) / reached;
        let mut curvature = [turn(&here.part, &vertex.part), turn(&here.drive, &vertex.drive)];
        let extremes = self.extremes(here, &vertex);
        let ends =
            [(here.part.clearance, vertex.part.clearance), (here.drive.clearance, vertex.drive.clearance)];
        for k in 0..2 {
            if self.is_turned(k) {
                curvature[k] = sagging(&extremes[k], ends[k], reached).unwrap_or(curvature[k]);
            }
        }
        let course = self.course(here, &vertex, &direction, &curvature);
        let mut trial = Trial {
            vertex,
            length: reached,
            curvature,
            bends: *bends,
            at_start: course.at_start,
            at_end: course.at_end,
            next_curvature: course.next_curvature,
            growth: GREATEST_GROWTH,
            proven: extremes.iter().all(|e| e.proven),
            turning: [extremes[0].turning, extremes[1].turning],
            culprit: 0,
            worst: 0.0,
        };
        for (k, role) in self.roles().iter().enumerate() {
            let growth = growth(role, &extremes[k], ends[k]);
            if growth < trial.growth {
                let deep = extremes[k].least < -role.inside;
                trial.worst = if deep { extremes[k].least } else { extremes[k].greatest };
                (trial.growth, trial.culprit) = (growth, k);
            }
        }
        Some(trial)
    }
}

/// The direction in which the path arrives at the end of a vector: its tangent there, which on a bent path is not that of the
/// vector; but that of an arc where the tangent is likely to be that of the path beyond a place where it turns.
fn arrival(from: &Vertex, to: &Vertex) -> Vec3 {
    let vector = to.tip - from.tip;
    // The square of an angle, but for a half.
    let turned = |tangent: &Vec3| vector.norm() - tangent.dot(&vector);
    if turned(&to.tangent) <= MOST_TURNED * turned(&from.tangent) {
        to.tangent
    } else {
        along_arc(from, &vector)
    }
}

/// The direction at the end of a vector of an arc over it that begins along the path.
fn along_arc(from: &Vertex, vector: &Vec3) -> Vec3 {
    vector * (2.0 * from.tangent.dot(vector) / vector.norm_squared()) - from.tangent
}

/// About where the path is at a distance along its tangent, as far as clearances bend as is known. Where that leads far aside
/// it is not trusted.
fn ahead(here: &Vertex, length: f64, targets: [f64; 2], curvature: &[f64; 2]) -> Vec3 {
    let along = here.tangent * length;
    let contacts = [&here.part, &here.drive];
    let mut residual = [0.0; 2];
    for (k, contact) in contacts.iter().enumerate() {
        let bent = contact.gradient.dot(&along) + 0.5 * curvature[k] * length * length;
        residual[k] = contact.clearance + bent - targets[k];
    }
    let aside = position::correction_of_two(residual, contacts.map(|contact| contact.gradient));
    let trusted = aside.norm() <= FAR_ASIDE * length;
    if !trusted {
        return here.tip + along;
    }
    // No longer than asked for: an arc sags a little more than the parabola that the length is predicted for.
    let way = along + aside;
    here.tip + way * (length * length / way.norm_squared())
}
