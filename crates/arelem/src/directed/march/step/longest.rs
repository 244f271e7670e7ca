//! The longest vector to the limits of the bands that is proven, from a first guess.

use apt_geometry::Vec3;

use super::{
    AIM, GREATEST_GROWTH, Guess, LEAST_VECTOR, LONG_ENOUGH, NEARLY, Places, Stepper, Trial, Unproven,
    at_corner::Corners,
    overlong::{self, Overlong},
};
use crate::{
    clearance::Tool,
    directed::march::Vertex,
    error::{Iteration, MotionFailure},
    position,
    role::Bend,
};

/// Bound of the trials for one vector.
const MAX_TRIALS: u32 = 60;
/// Trials that try to lengthen a vector already proven, and how many while one is refused that is no less than so many times as long, or its
/// sag says that it may become so: what is told by both is worth a vector. Where the axis turns the sag says less of a longer one, and a trial
/// is dear.
const LENGTHENINGS: u32 = 4;
const MOST_LENGTHENINGS: u32 = 8;
const MUCH_LONGER: f64 = 1.2;
/// How often vectors are aimed at other limits without being shorter: each clearance may bend the other way once.
const MOST_TURNINGS: u32 = 2;
/// Share of the length that the next trial has at least.
const GREATEST_SHRINKING: f64 = 0.3;
/// Share of the length that is asked for below which a vector tells that the path turns back.
const FALLS_SHORT: f64 = 0.5;
/// Share of the length of a vector by which it may end before the place where the path turns back.
const AT_TURN: f64 = 1e-7;
/// Greatest change of the length that is led to, by the length, from which it is foreseen: beyond that the bend changes for another reason.
const STEEPEST: f64 = 0.5;
/// Least length of a vector that keeps its place in the bands, as a share of the bands: less is no way round a bend.
const LEAST_LEVEL: f64 = 0.1;

/// How far a vector was asked to lead, and how far it does.
#[derive(Clone, Copy)]
struct Led {
    asked: f64,
    led: f64,
}

impl Led {
    /// Where the path turns back, by the line through two vectors that were asked to lead beyond it.
    fn turn(&self, other: &Self) -> Option<f64> {
        let slope = (self.led - other.led) / (self.asked - other.asked);
        (slope < 0.0).then(|| (self.led - slope * self.asked) / (1.0 - slope))
    }
}

/// What the search has come to.
struct Search {
    bends: [Bend; 2],
    /// Second derivatives of the clearances along the last trial.
    bent: [f64; 2],
    /// The length to try next.
    length: f64,
    cap: f64,
    /// The longest vector that is proven, with the length that was asked for.
    best: Option<(Trial, f64)>,
    shortest_bad: f64,
    /// How far the last one that is proven led.
    last_led: Option<Led>,
    last_bad: Option<Overlong>,
    lengthenings: u32,
    /// How often a clearance was found to bend the other way.
    turnings: u32,
    /// Whether the axis turns.
    turns: bool,
    /// Trials before the first one that is proven whose sag said nothing.
    failures: u32,
    corners: Corners,
    /// Index of the role that refused the last trial, and its clearance.
    culprit: Option<(usize, f64)>,
    /// The longest that was refused only because it is not proven.
    unproven: Option<Unproven>,
}

impl Search {
    fn new(guess: &Guess, cap: f64, turns: bool) -> Self {
        Self {
            bends: guess.bends,
            bent: guess.curvature,
            length: guess.length.min(cap),
            cap,
            best: None,
            shortest_bad: f64::INFINITY,
            last_led: None,
            last_bad: None,
            lengthenings: 0,
            turnings: 0,
            turns,
            failures: 0,
            corners: Corners::default(),
            culprit: None,
            unproven: None,
        }
    }

    /// Keeps a vector that is proven; whether another one may be longer.
    fn keep(&mut self, trial: Trial) -> bool {
        let (growth, length) = (trial.growth, self.length);
        if self.turns_back(trial.length) {
            return self.come_back(trial);
        }
        self.last_led = Some(Led { asked: length, led: trial.length });
        let is_enough = growth <= 1.0 + LONG_ENOUGH
            || trial.length >= self.cap * (1.0 - 1e-6)
            || self.corners.is_met
            || self.is_lengthened(length);
        let next = (length * (self.foreseen(growth) * AIM).min(GREATEST_GROWTH)).min(self.cap);
        if self.best.as_ref().is_none_or(|(best, _)| trial.length > best.length) {
            self.best = Some((trial, length));
        }
        let next_is_bad = next >= self.shortest_bad * (1.0 - LONG_ENOUGH);
        let is_longest = next_is_bad && self.shortest_bad <= length * NEARLY;
        if is_enough || next <= length * (1.0 + 1e-9) || is_longest {
            return false;
        }
        // What nothing bends yet is far from its length.
        self.lengthenings += u32::from(growth < GREATEST_GROWTH || next_is_bad);
        self.length = if next_is_bad { 0.5 * (length + self.shortest_bad) } else { next };
        true
    }

    /// Whether a proven vector tells that the path turns back before where it was asked to lead: it leads far less far, or less far than one that was
    /// asked for less.
    fn turns_back(&self, led: f64) -> bool {
        let before = self.last_led.is_some_and(|last| (last.asked < self.length) != (last.led < led));
        led < FALLS_SHORT * self.length || before
    }

    /// Keeps a vector that was asked to lead beyond where the path turns back, if it is the longest; whether another one may be longer. The less is
    /// asked for beyond that place the nearer to it vectors lead: by a line, as far as two tell.
    fn come_back(&mut self, trial: Trial) -> bool {
        let here = Led { asked: self.length, led: trial.length };
        let turn = self.last_led.and_then(|last| last.turn(&here));
        let known = self.best.as_ref().map_or(0.0, |(best, _)| best.length).max(here.led);
        if trial.length >= known {
            self.best = Some((trial, here.asked));
        }
        self.shortest_bad = self.shortest_bad.min(here.asked);
        self.last_led = Some(here);
        self.length = turn.unwrap_or((here.led * here.asked).sqrt()).max(known).min(self.shortest_bad);
        self.lengthenings += 1;
        self.lengthenings < MOST_LENGTHENINGS && self.length > known * (1.0 + AT_TURN)
    }

    /// The growth to the length that needs no more of it. Where the bend changes along the vector, the growth of a longer one leads on from what that of the last one
    /// led to: by the line through both.
    fn foreseen(&self, growth: f64) -> f64 {
        let length = self.length;
        let Some((before, shorter)) = self.best.as_ref().filter(|(trial, _)| trial.growth < GREATEST_GROWTH)
        else {
            return growth;
        };
        if growth >= GREATEST_GROWTH || *shorter >= length {
            return growth;
        }
        let slope = (length * growth - shorter * before.growth) / (length - shorter);
        if slope <= 0.0 || slope > STEEPEST { growth } else { (growth - slope) / (1.0 - slope) }
    }

    /// Whether enough has been tried to find a longer one than that of a length.
    fn is_lengthened(&self, known: f64) -> bool {
        let is_bad_far = self.shortest_bad.is_finite() && self.shortest_bad >= known * MUCH_LONGER;
        let may_grow =
            !self.turns && self.best.as_ref().is_some_and(|(trial, _)| trial.growth >= MUCH_LONGER);
        self.lengthenings >= if is_bad_far || may_grow { MOST_LENGTHENINGS } else { LENGTHENINGS }
    }

    /// Goes on from a length with which no vector leads on.
    fn halve(&mut self) {
        self.shortest_bad = self.shortest_bad.min(self.length);
        self.length *= 0.5;
    }

    /// Whether a vector that is refused tells that a clearance bends the other way than was taken for granted, so that it was aimed at the
    /// wrong limit of a band: that says nothing of one as long that is aimed at the right one. While the axis stands still the bend is that
    /// of the surface, and is known from the vector before.
    fn turns_about(&mut self, stepper: &Stepper<'_>, trial: &Trial) -> bool {
        let bends = stepper.bends(&trial.curvature);
        if !self.turns || bends == self.bends || self.turnings >= MOST_TURNINGS {
            return false;
        }
        self.turnings += 1;
        self.bends = bends;
        true
    }

    /// Goes on from one that is too long; whether there is more to try.
    fn refuse(&mut self, stepper: &Stepper<'_>, trial: &Trial) -> bool {
        self.culprit = Some((trial.culprit, trial.worst));
        if trial.growth >= 1.0 && self.unproven.is_none_or(|known| known.length < trial.length) {
            self.unproven = Some(Unproven { length: trial.length, open: trial.open });
        }
        if self.best.is_none() && self.turns_about(stepper, trial) {
            return true;
        }
        self.shortest_bad = self.shortest_bad.min(self.length);
        let bad = stepper.overlong(self.length, trial);
        let line = self.last_bad.and_then(|last| bad.meets_band(&last));
        self.last_bad = Some(bad);
        if let Some((_, known)) = &self.best {
            // Where the bend changes the sag says little about the length.
            if self.shortest_bad <= known * NEARLY || self.is_lengthened(*known) {
                return false;
            }
            self.lengthenings += 1;
            self.length = overlong::between(*known, self.shortest_bad, line.map(|share| share * self.length));
            return true;
        }
        self.bends = stepper.bends(&trial.curvature);
        // Where the sag is not quadratic (contact jumps) the prediction is not trusted for long.
        self.failures += u32::from(self.failures > 0 || trial.growth >= 1.0);
        let most = 1.0 - 1e-3 * f64::from((1u32 << self.failures.min(9)) - 1);
        self.failures = self.failures.max(1);
        self.length *= (trial.growth.min(line.unwrap_or(1.0)) * AIM).clamp(GREATEST_SHRINKING, most);
        true
    }
}

/// Length below which a vector of a tool leads nowhere at a place, on a path that begins where coordinates have a size.
fn least_vector(tool: &Tool<'_>, size: f64, tip: &Vec3) -> f64 {
    LEAST_VECTOR * position::size(tool, tip).max(size)
}

impl Stepper<'_> {
    /// Length below which a vector leads nowhere at a place: a path may lead far away from where it begins, and who reads it takes two positions
    /// for one by the size of all of it.
    pub(super) fn least_vector(&self, tip: &Vec3) -> f64 {
        least_vector(&self.prepared.tool, self.prepared.size, tip)
    }

    /// The longest vector that is proven, from a first guess.
    pub(super) fn longest(
        &self,
        here: &Vertex,
        cap: f64,
        places: Places,
        guess: &Guess,
    ) -> Result<Trial, MotionFailure> {
        let least = match places {
            Places::Limits | Places::Off(_) => self.least_vector(&here.tip),
            Places::Level | Places::Inward(_) => LEAST_LEVEL * self.bands(),
        };
        let mut search = Search::new(guess, cap, self.prepared.attitude.turns());
        for _ in 0..MAX_TRIALS {
            if search.length <= least {
                break;
            }
            if self.patience.is_over() {
                return Err(MotionFailure::Cancelled);
            }
            let Some(trial) = self.trial(here, places, &mut search) else {
                search.halve();
                continue;
            };
            search.bent = trial.curvature;
            let goes_on = if trial.proven { search.keep(trial) } else { search.refuse(self, &trial) };
            if !goes_on {
                break;
            }
        }
        self.end_at_corner(here, places, &mut search);
        self.found(here, &mut search)
    }

    /// Lets the longest vector that is proven end at a corner that is left beyond it.
    fn end_at_corner(&self, here: &Vertex, places: Places, search: &mut Search) {
        while !search.corners.is_met && search.best.is_some() {
            let Some(trial) = self.trial_to_corner(here, places, search) else { return };
            search.keep(trial);
        }
    }

    /// The next trial: to a corner if there is one, or of the length that is to be tried.
    fn trial(&self, here: &Vertex, places: Places, search: &mut Search) -> Option<Trial> {
        if let Some(trial) = self.trial_to_corner(here, places, search) {
            return Some(trial);
        }
        let Search { bends, bent, cap, .. } = *search;
        let targets = self.targets(here, &bends, places);
        let trial = self.attempt(here, search.length, cap, (targets, &bent, &bends));
        match &trial {
            _ if !self.may_have_corners() => {}
            Some(trial) if !trial.proven => search.corners.note(here, trial.vertex, false),
            Some(_) => {}
            None if search.corners.is_unknown() => {
                if let Some(beyond) = self.beyond(here, search.length, targets, &bent) {
                    search.corners.note(here, beyond, true);
                }
            }
            None => {}
        }
        trial
    }

    /// A vector to a corner, if there is one.
    fn trial_to_corner(&self, here: &Vertex, places: Places, search: &mut Search) -> Option<Trial> {
        if search.corners.is_unknown() {
            return None;
        }
        let Search { bends, bent, cap, .. } = *search;
        let aim = (self.targets(here, &bends, places), &bent, &bends);
        let known = search.best.as_ref().map(|(trial, _)| trial);
        let trial = self.to_corner(here, known, cap, aim, &mut search.corners)?;
        search.length = trial.length;
        Some(trial)
    }

    /// The longest vector that has been found, or why there is none.
    fn found(&self, here: &Vertex, search: &mut Search) -> Result<Trial, MotionFailure> {
        let tip = here.tip;
        match (search.best.take(), search.culprit) {
            (Some((mut trial, _)), _) => {
                trial.is_at_corner = search.corners.is_met;
                trial.unproven = search.unproven;
                Ok(trial)
            }
            (None, Some((culprit, clearance))) if clearance != 0.0 => {
                let role = self.roles()[culprit].name;
                Err(MotionFailure::NoAdmissibleVector { role, clearance, tip })
            }
            _ => Err(MotionFailure::IterationLimit {
                iteration: Iteration::StepLength,
                limit: MAX_TRIALS,
                tip,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::cutter::Cutter;

    use super::*;
    use crate::{directed::march::step::LEAST_VECTOR, tests::v};

    /// What is a vector where a path begins is none far from there, where coordinates have fewer digits.
    #[test]
    fn the_least_vector_grows_with_the_coordinates_of_its_end() {
        let tool = Tool::new(Cutter::from_numbers(&[0.5], 1.0).expect("a cutter"), Vec3::z());
        let begin = v(1.0, -0.5, 0.2);
        let size = position::size(&tool, &begin);
        assert_eq!(least_vector(&tool, size, &begin), LEAST_VECTOR * size);
        assert!(least_vector(&tool, size, &v(-100.0, 1.0, 50.0)) >= 100.0 * LEAST_VECTOR);
        assert_eq!(least_vector(&tool, size, &Vec3::zeros()), LEAST_VECTOR * size);
    }
}
