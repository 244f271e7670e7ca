//! The longest vector to limits that are settled, where shorter ones than some are of no use: where the bend of a path changes, the
//! next vector may be too short as well as too long. A few lengths tell whether there is one at all.

use super::{
    AIM, GREATEST_GROWTH, Guess, LONG_ENOUGH, NEARLY, Places, Stepper, Trial,
    overlong::{Overlong, between},
};
use crate::{directed::march::Vertex, error::MotionFailure};

/// Share by which a length is more than one that is of no use.
const MORE: f64 = 1e-6;
/// Ratio of the shortest length that is too long to the longest that is proven at which no better one is looked for.
const ENOUGH: f64 = 1.02;
/// Growth from the first length that is proven to the next: what there is to gain where a path changes its bend is little. The next ones
/// grow by the square.
const FIRST_GROWTH: f64 = 1.1;
/// Bound of the lengths that are tried, and of those among them that lengthen a vector already proven.
const MOST_TRIED: u32 = 9;
const MOST_LENGTHENED: u32 = 3;

/// What has been tried.
struct Tried {
    /// The longest vector that is proven, with the length that was asked for.
    best: Option<(Trial, f64)>,
    /// The shortest that is too long, and the one before it.
    long: Option<Overlong>,
    longer: Option<Overlong>,
    /// The longest that fails in another way than that.
    short: Option<Overlong>,
    /// The shortest length with which no vector leads on.
    nowhere: f64,
    /// By how much a vector that is proven may grow, and how often one has.
    growth: f64,
    lengthened: u32,
}

impl Tried {
    fn nothing() -> Self {
        Self {
            best: None,
            long: None,
            longer: None,
            short: None,
            nowhere: f64::INFINITY,
            growth: FIRST_GROWTH,
            lengthened: 0,
        }
    }

    /// Keeps a vector that is proven.
    fn note(&mut self, length: f64, trial: Trial) {
        if self.best.is_some() {
            self.growth = (self.growth * self.growth).min(GREATEST_GROWTH);
        }
        if self.best.as_ref().is_none_or(|(best, _)| trial.length > best.length) {
            self.best = Some((trial, length));
        }
    }

    /// Keeps one that was refused.
    fn refuse(&mut self, bad: Overlong) {
        match &self.long {
            Some(long) if self.best.is_none() && !bad.fails_like(long) => self.short = Some(bad),
            Some(long) if bad.length >= long.length => {}
            known => (self.longer, self.long) = (*known, Some(bad)),
        }
    }

    /// The length to try next, if there may be a vector of more use.
    fn next(&mut self, last: f64, least: f64, cap: f64) -> Option<f64> {
        let high = self.long.map_or(f64::INFINITY, |long| long.length).min(self.nowhere);
        let Some((best, known)) = &self.best else {
            return match &self.short {
                // What is too short and what is too long are far enough apart for one that is neither.
                Some(short) => (high > short.length * NEARLY).then(|| self.between(short.length, high)),
                None => (last > least).then_some(least),
            };
        };
        let is_enough = best.growth <= 1.0 + LONG_ENOUGH || best.length >= cap * (1.0 - 1e-6);
        if is_enough || self.lengthened >= MOST_LENGTHENED || high <= known * ENOUGH {
            return None;
        }
        self.lengthened += 1;
        let foretold = (known * (best.growth * AIM).min(self.growth)).min(cap);
        let fits = foretold < high * (1.0 - LONG_ENOUGH);
        Some(if fits { foretold } else { self.between(*known, high) })
    }

    /// A length between one that is too short or proven and one that is too long.
    fn between(&self, low: f64, high: f64) -> f64 {
        let line = self.long.zip(self.longer);
        let share = line.and_then(|(long, longer)| Some(long.meets_band(&longer)? * long.length));
        between(low, high, share)
    }
}

impl Stepper<'_> {
    /// The longest vector that is proven and no shorter than is of use, from a guess. What fails alike at two lengths is taken to fail
    /// between them. Errors: cancelled.
    pub(super) fn longest_of_use(
        &self,
        here: &Vertex,
        cap: f64,
        guess: &Guess,
        least: f64,
    ) -> Result<Option<Trial>, MotionFailure> {
        let least = least.max(self.least_vector(&here.tip)) * (1.0 + MORE);
        let targets = self.targets(here, &guess.bends, Places::Limits);
        let (mut tried, mut bent) = (Tried::nothing(), guess.curvature);
        let mut length = guess.length.min(cap).max(least);
        for _ in 0..MOST_TRIED {
            if length > cap {
                break;
            }
            if self.patience.is_over() {
                return Err(MotionFailure::Cancelled);
            }
            match self.attempt(here, length, cap, (targets, &bent, &guess.bends)) {
                None => tried.nowhere = tried.nowhere.min(length),
                Some(trial) => {
                    bent = trial.curvature;
                    if trial.proven {
                        tried.note(length, trial);
                    } else {
                        tried.refuse(self.overlong(length, &trial));
                    }
                }
            }
            match tried.next(length, least, cap) {
                Some(next) => length = next,
                None => break,
            }
        }
        Ok(tried.best.map(|(trial, _)| trial))
    }
}
