//! Extremes of a clearance over the whole of one cut vector, with proof.

mod bounds;
mod piece;

use std::{cell::RefCell, collections::HashMap};

use apt_geometry::Vec3;

use crate::sequence::ToolPosition;

use self::{
    bounds::{bounds, crest},
    piece::{Piece, told_by_each_other},
};
use super::clearance::{Clearance, Reading, Shape};

/// Evaluations that one extreme may cost; the gap left then is the error term.
const EVALUATIONS: usize = 60;
/// Halvings of a vector on which the bend is not bounded, so that it may be on its parts.
const HALVINGS: u32 = 6;
/// Share of the error of a reading that what lies between two need not be known closer than.
const SHARE_OF_ERROR: f64 = 0.1;
/// Pieces a vector is cut into where nothing is known about the shape of the clearance.
const FIRST_PIECES: usize = 4;
/// How many times as much as the samples of a piece say it hides may be beside them, where that is within the band.
const WIDE: f64 = 8.0;
/// Evaluations over one vector of unknown shape.
const FREE_EVALUATIONS: usize = 4096;
/// Pieces of a vector that fill the band in which each is read sooner than the bend is bounded more closely.
const FEW_PIECES: f64 = 4.0;
/// Rate with which the slope of a clearance grows, in bands and the length of the vector, on a vector that fills its band twice.
const FULL: f64 = 16.0;
/// Pieces of a vector that a bound of that rate may ask for.
const PIECES: f64 = 1024.0;
/// Sine below which two opposite axes leave the plane open in which the axis turns.
const OPPOSITE: f64 = 1e-9;
/// Step of the derivative with respect to the vector parameter when the tool axis turns.
const TURN_STEP: f64 = 1e-5;
/// Share of the radius of curvature that a tool may be too deep where the slope of a clearance is bounded.
pub(super) const DEEPEST: f64 = 0.5;

/// Where the tool is between two positions of a vector, `t` from 0 to 1: the tool end goes straight and evenly, the axis
/// turns evenly in the plane of both axes. A machine that moves otherwise between them is not judged. None for opposite axes.
pub(super) fn between(from: &ToolPosition, to: &ToolPosition, t: f64) -> Option<ToolPosition> {
    let tip = from.tip + (to.tip - from.tip) * t;
    if from.axis == to.axis {
        return Some(ToolPosition { tip, axis: from.axis });
    }
    let cosine = from.axis.dot(&to.axis);
    let across = to.axis - from.axis * cosine;
    let sine = across.norm();
    if sine <= OPPOSITE {
        return (cosine > 0.0)
            .then_some(ToolPosition { tip, axis: if t < 0.5 { from.axis } else { to.axis } });
    }
    let (s, c) = (t * sine.atan2(cosine)).sin_cos();
    let axis = from.axis * c + across * (s / sine);
    Some(ToolPosition { tip, axis: axis / axis.norm() })
}

/// The angle that the axis turns through on a vector, radians.
pub(super) fn turning(from: &ToolPosition, to: &ToolPosition) -> f64 {
    from.axis.cross(&to.axis).norm().atan2(from.axis.dot(&to.axis))
}

/// How fast the axis turns, by the parameter from 0 to 1, along the line that it turns about.
pub(super) fn round(from: &ToolPosition, to: &ToolPosition) -> Vec3 {
    let line = from.axis.cross(&to.axis);
    line.try_normalize(0.0).map_or(line, |line| line * turning(from, to))
}

/// Least and greatest clearance found, and what no clearance is below or above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extremes {
    pub(super) min: f64,
    pub(super) max: f64,
    /// Proven bounds.
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Extremes {
    /// Values that the true ones are no farther from than `error`.
    pub(super) fn within(error: f64, min: f64, max: f64) -> Self {
        Self { min, max, low: min - error, high: max + error }
    }

    pub(super) fn join(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// How far beyond those found the true ones could be.
    pub(super) fn error(&self) -> f64 {
        (self.min - self.low).max(self.high - self.max)
    }
}

/// How the slope of a clearance can grow along a straight move with a fixed tool axis.
///
/// Behind every contact the surface holds a ball, as large as the radius of the curvature with which it bends away from the
/// tool. The clearance is at most that from the ball, and equal to it at the contact: so where the tool has come in by d, its
/// second derivative is at most 1/(ρ − d). What a turning axis adds is that the tool's places go round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bend {
    /// Bound of the second derivative, per unit of length squared: the clearance less half of it times the square of the way
    /// is concave.
    pub(super) rate: f64,
    /// Bound of the sum of all sudden increases of the slope.
    pub(super) jumps: f64,
    /// At how many corners of the surface there are any.
    pub(super) corners: u32,
}

impl Bend {
    /// For a surface that bends away with a curvature of `hill` at most, and a tool no deeper in it than `depth`.
    pub(super) fn over(hill: f64, depth: f64) -> Option<Self> {
        let deepest = hill * depth;
        (deepest <= DEEPEST).then(|| Self { rate: hill / (1.0 - deepest), jumps: 0.0, corners: 0 })
    }
}

/// Clearance, derivative by the parameter 0 … 1 and error at one place of the vector.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    t: f64,
    value: f64,
    slope: f64,
    /// How far from there the slope may be that was told, by the parameter: infinitely where it is only one that the clearance does not
    /// rise above.
    slack: f64,
    error: f64,
}

/// A clearance along one cut vector.
pub(super) struct Span<'a> {
    pub(super) clearance: &'a Clearance<'a>,
    pub(super) from: ToolPosition,
    pub(super) to: ToolPosition,
    /// The clearance at both.
    pub(super) ends: [Reading; 2],
    /// A clearance beyond these decides by itself: the search need not go on.
    pub(super) beyond: [f64; 2],
    /// Least and greatest clearance allowed.
    pub(super) band: [f64; 2],
    /// What has been read on a vector on which the axis turns, and where places are searched for.
    pub(super) read: &'a Readings,
    /// Whether extremes between its ends are looked at also where bounds show the whole vector to be within the band.
    pub(super) is_looked_at: bool,
}

/// Readings by their positions, bit for bit: slopes need those beside one place, and closer bounds the same places again.
#[derive(Debug, Default)]
pub(super) struct Readings(RefCell<HashMap<[u64; 6], Reading>>);

impl Readings {
    fn get_or_read(&self, place: &ToolPosition, read: impl FnOnce() -> Option<Reading>) -> Option<Reading> {
        let ToolPosition { tip, axis } = place;
        let key = [tip.x, tip.y, tip.z, axis.x, axis.y, axis.z].map(f64::to_bits);
        let known = self.0.borrow().get(&key).copied();
        known.or_else(|| {
            let reading = read()?;
            self.0.borrow_mut().insert(key, reading);
            Some(reading)
        })
    }
}

impl Span<'_> {
    fn turns(&self) -> bool {
        self.from.axis != self.to.axis
    }

    fn at(&self, place: &ToolPosition) -> Option<Reading> {
        let read = || self.clearance.at(&place.tip, &place.axis);
        let is_kept = self.turns() || self.clearance.is_searched_for();
        if is_kept { self.read.get_or_read(place, read) } else { read() }
    }

    fn value(&self, t: f64) -> Option<f64> {
        self.at(&between(&self.from, &self.to, t)?).map(|r| r.value)
    }

    fn sample(&self, t: f64) -> Option<Sample> {
        let place = between(&self.from, &self.to, t)?;
        self.known(t, self.at(&place)?)
    }

    fn known(&self, t: f64, reading: Reading) -> Option<Sample> {
        let way = self.to.tip - self.from.tip;
        let (slope, slack) = match reading.place {
            _ if !self.turns() => (reading.normal.dot(&way), 0.0),
            // Where a flat face or a straight piece of the tool is in contact other places may touch as well, and go round with other
            // speeds: none of them is farther away than this one, which tells no more.
            Some(place) => {
                (reading.normal.dot(&(way + round(&self.from, &self.to).cross(&place))), f64::INFINITY)
            }
            None => {
                let (low, high) = ((t - TURN_STEP).max(0.0), (t + TURN_STEP).min(1.0));
                ((self.value(high)? - self.value(low)?) / (high - low), TURN_STEP)
            }
        };
        Some(Sample { t, value: reading.value, slope, slack, error: reading.error })
    }

    /// The readings at both ends with their slopes.
    pub(super) fn at_ends(&self) -> Option<[Sample; 2]> {
        Some([self.known(0.0, self.ends[0])?, self.known(1.0, self.ends[1])?])
    }

    /// Extremes to within `tolerance`, by the readings at both ends; None where there is no distance.
    pub(super) fn extremes(&self, [first, last]: [Sample; 2], tolerance: f64) -> Option<Extremes> {
        let error = first.error.max(last.error);
        let (low, high) = (first.value.min(last.value), first.value.max(last.value));
        let (shape, missed) = self.shape();
        let error = error + missed;
        match shape {
            Shape::Linear => Some(Extremes::within(error, low, high)),
            Shape::Convex => {
                let (min, gap) = self.trough([first, last], 1.0, [tolerance, missed])?;
                let min = min.min(low);
                Some(Extremes { min, max: high, low: min - error.max(gap), high: high + error })
            }
            Shape::Concave => {
                let (depth, gap) = self.trough([first, last], -1.0, [tolerance, missed])?;
                let max = (-depth).max(high);
                Some(Extremes { min: low, max, low: low - error, high: max + error.max(gap) })
            }
            Shape::Free => {
                let found = self.unshaped(tolerance, HALVINGS)?;
                // Bounds of the halves that are too wide to decide: samples, as if there were none.
                let is_open = self.is_within(found.min, found.max) && !self.is_within(found.low, found.high);
                if is_open && self.bend().is_none() {
                    return self.free(first, last, tolerance);
                }
                Some(found)
            }
        }
    }

    /// How the clearance varies, and what that leaves open of the readings at the ends.
    fn shape(&self) -> (Shape, f64) {
        if self.turns() {
            return (Shape::Free, 0.0);
        }
        let (tips, ends) = ([&self.from.tip, &self.to.tip], [&self.ends[0], &self.ends[1]]);
        match self.clearance.shape_along(tips, &self.from.axis) {
            Shape::Free => match self.clearance.beside_one_body(tips, ends, &self.from.axis) {
                Some(missed) => (Shape::Convex, missed),
                None => (Shape::Free, 0.0),
            },
            shape => (shape, 0.0),
        }
    }

    fn is_within(&self, low: f64, high: f64) -> bool {
        low >= self.band[0] && high <= self.band[1]
    }

    /// Extremes where nothing is known of the shape: by the bend, if that is bounded, of the vector or of halves of it. A bound
    /// that tells nothing tells no more on halves.
    fn unshaped(&self, tolerance: f64, halvings: u32) -> Option<Extremes> {
        let [first, last] = self.at_ends()?;
        let share = 0.5f64.powi((HALVINGS - halvings) as i32);
        match self.bend() {
            // Of several corners that count one alone may be within reach of a part of the vector.
            Some(bend) if bend.corners > 1 && bend.jumps > self.band[1] - self.band[0] && halvings > 0 => {}
            Some(bend) if self.tells(&bend, share) => return self.bent(first, last, bend, tolerance),
            None if halvings > 0 && self.bends_anywhere(0.5f64.powi(halvings as i32))? => {}
            _ => return self.free(first, last, tolerance),
        }
        let middle = between(&self.from, &self.to, 0.5)?;
        let reading = self.at(&middle)?;
        if reading.value < self.beyond[0] || reading.value > self.beyond[1] {
            let [low, high] = [first.value.min(last.value), first.value.max(last.value)];
            let error = first.error.max(last.error).max(reading.error);
            return Some(Extremes::within(error, low.min(reading.value), high.max(reading.value)));
        }
        let halves = [
            Span { to: middle, ends: [self.ends[0], reading], ..*self },
            Span { from: middle, ends: [reading, self.ends[1]], ..*self },
        ];
        let mut found: Option<Extremes> = None;
        for half in halves {
            let part = half.unshaped(tolerance, halvings - 1)?;
            found = Some(found.map_or(part, |f| f.join(part)));
            if part.min < self.beyond[0] || part.max > self.beyond[1] {
                break;
            }
        }
        found
    }

    /// Whether the bend is bounded on some share of it at one of its ends.
    fn bends_anywhere(&self, share: f64) -> Option<bool> {
        let [near, far] = [share, 1.0 - share].map(|t| between(&self.from, &self.to, t));
        let first = Span { to: near?, ends: [self.ends[0]; 2], ..*self };
        let last = Span { from: far?, ends: [self.ends[1]; 2], ..*self };
        Some(first.bend().is_some() || last.bend().is_some())
    }

    /// Least value of the convex function `sign`·clearance between two samples, and the gap to the lower bound that the
    /// tangents at both sides give, from readings that may miss some of it beside their errors.
    fn trough(
        &self,
        [first, last]: [Sample; 2],
        sign: f64,
        [tolerance, missed]: [f64; 2],
    ) -> Option<(f64, f64)> {
        let floor = if sign > 0.0 { self.band[0] } else { -self.band[1] };
        let turn = |s: Sample| Sample { value: sign * s.value, slope: sign * s.slope, ..s };
        let (mut a, mut b) = (turn(first), turn(last));
        let mut least = a.value.min(b.value);
        let mut error = a.error.max(b.error) + missed;
        if a.slope >= 0.0 || b.slope <= 0.0 {
            return Some((least, error));
        }
        let mut gap = 0.0;
        for step in 0..EVALUATIONS {
            let meet = (a.value - b.value + b.slope * b.t - a.slope * a.t) / (b.slope - a.slope);
            let bound = a.value + a.slope * (meet - a.t);
            gap = (least - bound).max(0.0);
            let is_within = !self.is_looked_at && bound - error >= floor;
            if gap <= tolerance || is_within || b.t - a.t <= 4.0 * f64::EPSILON {
                break;
            }
            let t = match step % 4 {
                0 | 1 => lowest_of_cubic([a, b]),
                2 => meet,
                _ => 0.5 * (a.t + b.t),
            };
            let t = if t > a.t && t < b.t { t } else { 0.5 * (a.t + b.t) };
            let middle = turn(self.sample(t)?);
            error = error.max(middle.error + missed);
            least = least.min(middle.value);
            if middle.slope < 0.0 {
                a = middle;
            } else {
                b = middle;
            }
        }
        Some((least, gap + error))
    }

    /// By the parameter from 0 to 1.
    fn bend(&self) -> Option<Bend> {
        let turn = if self.turns() { turning(&self.from, &self.to) } else { 0.0 };
        let swing = turn * self.clearance.reach();
        let travel = (self.to.tip - self.from.tip).norm() + swing;
        let [first, last] = &self.ends;
        let room = self.band[1] - self.band[0];
        let enough = FULL * room / (travel * travel);
        let bend = self.clearance.bend_along([&self.from, &self.to], [first, last], [travel, enough])?;
        let rate = bend.rate * travel * travel + turn * swing;
        Some(Bend { rate, jumps: bend.jumps * travel, ..bend })
    }

    /// The same bend, or a closer bound of it on a part of the vector where that leaves open whether the clearance is within the band there, from
    /// the readings at both ends of it.
    fn closer_bend(&self, ends: [Sample; 2], bend: Bend) -> Bend {
        if bend.jumps > 0.0 || bend.rate <= 0.0 {
            return bend;
        }
        let told = |rate: f64| bounds(ends, &Bend { rate, ..bend }, false);
        let is_enough = |rate: f64| {
            let told = told(rate);
            self.is_within(told.low, told.high)
        };
        let share = ends[1].t - ends[0].t;
        if is_enough(bend.rate) || self.is_soon_told(&bend, share) {
            return bend;
        }
        let of_whole = |rate: f64| rate / (share * share);
        let Extremes { low, high, .. } = told(bend.rate);
        let middle = between(&self.from, &self.to, ends[0].t + 0.5 * share);
        let found = middle.and_then(|middle| {
            let [way, round] = [self.to.tip - self.from.tip, round(&self.from, &self.to)].map(|x| x * share);
            let is_enough = |rate: f64| is_enough(of_whole(rate));
            self.clearance.bend_on(&middle, (way, round), [low, high], is_enough)
        });
        found.map_or(bend, |rate| Bend { rate: bend.rate.min(of_whole(rate)), ..bend })
    }

    /// Whether a few readings of such a share of a vector tell as much as a closer bound of the bend, which takes as long; for a tool without width that
    /// tells far more.
    fn is_soon_told(&self, bend: &Bend, share: f64) -> bool {
        self.clearance.profile.widest() > 0.0 && self.is_filled_by(FEW_PIECES / share, bend)
    }

    /// Whether a bound of the bend tells something, for such a share of a vector: beside the tip of what is nearly a cone it does
    /// not.
    fn tells(&self, bend: &Bend, share: f64) -> bool {
        self.is_filled_by(PIECES * share, bend)
    }

    /// Whether so many pieces of the vector fill the band at most, as a parabola does.
    fn is_filled_by(&self, pieces: f64, bend: &Bend) -> bool {
        bend.rate <= 8.0 * pieces * pieces * (self.band[1] - self.band[0])
    }

    /// Extremes where the growth of the slope is bounded: a vector is divided until each part is proven to lie within the
    /// band, or to hide no more than `tolerance`. A part that may be above the band is divided where it may be highest, which is about
    /// where the tool goes over to another contact if it does; in the middle if that left more than half of it.
    fn bent(&self, first: Sample, last: Sample, bend: Bend, tolerance: f64) -> Option<Extremes> {
        let is_left_once = bend.corners <= 1 && !self.turns();
        let mut found: Option<Extremes> = None;
        let mut open = vec![(first, last, bend, true)];
        let mut budget = FREE_EVALUATIONS;
        while let Some((a, b, bend, may_be_short)) = open.pop() {
            let bend = self.closer_bend([a, b], bend);
            let is_whole = b.t - a.t >= 1.0;
            let part = bounds([a, b], &bend, is_left_once);
            let within = part.low >= self.band[0] && part.high <= self.band[1];
            // Where the slope changes its sign, an extreme is looked at once, unless nothing depends on it.
            let turn = a.t - a.slope * (b.t - a.t) / (b.slope - a.slope);
            let between = turn > a.t && turn < b.t && a.slope * b.slope < 0.0;
            let error = a.error.max(b.error);
            let close = part.error() <= tolerance.max(SHARE_OF_ERROR * error) + error;
            let settled = within || close || budget == 0;
            let beyond = part.min < self.beyond[0] || part.max > self.beyond[1];
            let is_skipped = within && !self.is_looked_at;
            if beyond || is_skipped || settled && !(is_whole && between) {
                found = Some(found.map_or(part, |f| f.join(part)));
                if beyond {
                    return found;
                }
                continue;
            }
            budget = budget.saturating_sub(1);
            let half = 0.5 * (a.t + b.t);
            let highest = crest([a, b], bend.rate).filter(|_| may_be_short && part.high > self.band[1]);
            let t = highest.unwrap_or(if is_whole && between { turn } else { half });
            let middle = self.sample(t)?;
            open.extend([(middle, b, bend, t >= half), (a, middle, bend, t <= half)]);
        }
        found
    }

    /// Subdivision until second differences say that no piece hides more than `tolerance`, or leaves the band if it hides many times
    /// as much; a piece shorter than that cannot hide more, because clearance changes by no more than the tool moves.
    fn free(&self, first: Sample, last: Sample, tolerance: f64) -> Option<Extremes> {
        let swing = if self.turns() { turning(&self.from, &self.to) * self.clearance.reach() } else { 0.0 };
        let length = (self.to.tip - self.from.tip).norm() + swing;
        let mut found: Option<Extremes> = None;
        let mut pieces = Vec::with_capacity(2 * FIRST_PIECES);
        let mut left = first;
        for k in 1..=FIRST_PIECES {
            let right = if k == FIRST_PIECES { last } else { self.sample(k as f64 / FIRST_PIECES as f64)? };
            pieces.push((left, right));
            left = right;
        }
        let mut budget = FREE_EVALUATIONS;
        while let Some((a, b)) = pieces.pop() {
            let middle = self.sample(0.5 * (a.t + b.t))?;
            let seen = told_by_each_other([a, middle, b], length);
            let piece = Piece::of(&seen, length);
            let (part, wide) = (piece.hiding(1.0), piece.hiding(WIDE));
            let is_beyond = part.min < self.beyond[0] || part.max > self.beyond[1];
            // Whether what it hides decides: then the errors of its readings do not excuse it.
            let found_within = self.is_within(piece.found.low, piece.found.high);
            let decides = found_within && !self.is_within(part.low, part.high);
            let share = if decides { 0.0 } else { SHARE_OF_ERROR * piece.error };
            let is_close = piece.hidden <= tolerance.max(share);
            if is_beyond || is_close || self.is_within(wide.low, wide.high) || budget == 0 {
                found = Some(found.map_or(part, |f| f.join(part)));
                if is_beyond {
                    return found;
                }
            } else {
                budget -= 1;
                let [a, middle, b] = seen;
                pieces.extend([(a, middle), (middle, b)]);
            }
        }
        found
    }
}

/// The extreme clearance between both ends of a vector that the readings there tell of by their slopes, with a cubic: it says whether the
/// vector is worth a look, and proves nothing. None where the slope keeps its sign.
pub(super) fn told(ends: &[Sample; 2]) -> Option<f64> {
    let [first, last] = ends;
    if first.slope * last.slope >= 0.0 {
        return None;
    }
    let sense = last.slope.signum();
    let turned = |s: &Sample| Sample { value: sense * s.value, slope: sense * s.slope, ..*s };
    let t = lowest_of_cubic([turned(first), turned(last)]);
    let (r, rise) = (1.0 - t, last.value - first.value);
    Some(first.value + t * t * (3.0 - 2.0 * t) * rise + t * r * (r * first.slope - t * last.slope))
}

/// Where the cubic with the values and slopes of two samples is lowest, of which the first falls and the last rises.
fn lowest_of_cubic([a, b]: [Sample; 2]) -> f64 {
    let width = b.t - a.t;
    let (first, last, rise) = (a.slope * width, b.slope * width, b.value - a.value);
    // Its slope is `first + linear·u + square·u²` for u from 0 to 1.
    let square = 3.0 * (first + last) - 6.0 * rise;
    let linear = 6.0 * rise - 4.0 * first - 2.0 * last;
    a.t - 2.0 * first * width / (linear + (linear * linear - 4.0 * square * first).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn sample(t: f64, value: f64, error: f64) -> Sample {
        Sample { t, value, slope: 0.0, slack: 0.0, error }
    }

    proptest! {
        /// The true values are a sine that rises no faster than the tool moves.
        #[test]
        fn what_readings_tell_of_each_other_is_true(
            phase in 0.0..6.0f64, rate in 0.1..9.0f64, width in 1e-6..0.5f64,
            off in proptest::collection::vec(-1.0..1.0f64, 3),
            errors in proptest::collection::vec(0.0..0.1f64, 3),
        ) {
            let truth = |t: f64| (phase + rate * t).sin();
            let read = |k: usize| {
                let t = 0.5 * width * k as f64;
                sample(t, truth(t) + off[k] * errors[k], errors[k])
            };
            let samples = [read(0), read(1), read(2)];
            for (told, own) in told_by_each_other(samples, rate).iter().zip(&samples) {
                prop_assert!((told.value - truth(told.t)).abs() <= told.error + 1e-12);
                prop_assert!(told.error <= 2.0 * own.error);
            }
        }
    }

    /// A reading that is known to little says no more than the close ones beside it; a slope that is not that of the values does not make a
    /// piece hide more than the tool moves from its samples.
    #[test]
    fn close_readings_tell_of_a_loose_one() {
        let samples = [sample(0.0, 1.0, 1e-6), sample(1e-4, 1.001, 1e-2), sample(2e-4, 1.0, 1e-6)];
        let told = told_by_each_other(samples, 0.1);
        assert!((told[1].value - 1.0).abs() <= 1.2e-5 && told[1].error <= 2.3e-5, "{:?}", told[1]);
        let steep = told.map(|s| Sample { slope: 50.0 * s.t, ..s });
        assert!(Piece::of(&steep, 0.1).hidden <= 0.25 * 0.1 * 2e-4 * 1.000_001);
    }
}
