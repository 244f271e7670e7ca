//! Proof that a cut vector keeps a role's band over its whole length (GOUGCK made exact). Convex and concave clearances
//! have one interior extreme, which tangents bound from beyond; other clearances are proven by a bound of their second
//! derivative.

mod course;
mod ledger;
mod support;

use apt_geometry::{Vec3, patience::Patience};

pub(super) use self::course::lowest;
pub(crate) use self::ledger::Ledger;
use crate::{
    attitude::Sweep,
    bound::{Reading, Readings},
    clearance::{Contact, Enough, Shape},
    role::{ROUNDING, Working},
};

/// Bound of the refinement of one extreme.
const MAX_ITERATIONS: u32 = 24;
/// Of so many refinements one is made for clearances with a kink.
const TANGENTS_EVERY: u32 = 3;
/// An extreme is known well enough when its bound and its value differ by this share of the band.
const ENOUGH: f64 = 2e-4;

/// Share of the band that a vector leaves free on the side of its sag: errors of another proof must not decide about it.
const ROOM: f64 = 5e-5;

/// Extreme clearances over a cut vector, and whether they were shown to be in the band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extremes {
    pub(crate) least: f64,
    pub(crate) greatest: f64,
    pub(crate) proven: bool,
    /// What has been read of the clearance along the vector: see [`crate::bound`].
    pub(crate) readings: Readings,
    /// Second derivative of the parabola through both ends and a place between them, if one was looked at where the tool turns.
    pub(crate) turning_bend: Option<f64>,
}

/// Second derivative of the parabola through three places, given with their clearances.
fn second_derivative([a, b, c]: [(f64, f64); 3]) -> f64 {
    let rise = |from: (f64, f64), to: (f64, f64)| (to.1 - from.1) / (to.0 - from.0);
    2.0 * (rise(b, c) - rise(a, b)) / (c.0 - a.0)
}

/// Clearance and its derivative at a place along the vector.
#[derive(Clone, Copy)]
struct Sample {
    x: f64,
    value: f64,
    slope: f64,
    /// How much less the value may be for all that the search knows.
    missed: f64,
    contact: Contact,
}

impl Sample {
    /// The same of the clearance taken negative.
    fn turned(&self) -> Self {
        Self { value: -self.value, slope: -self.slope, ..*self }
    }
}

/// A clearance along a straight line.
struct Line<'a> {
    sweep: &'a Sweep<'a>,
    role: &'a Working,
    ledger: &'a Ledger,
    patience: Patience<'a>,
    /// −1 turns a concave clearance into a convex one.
    sign: f64,
    /// Least and greatest clearance that the vector may have between its ends.
    limits: [f64; 2],
}

/// What the proof that no place of the tool is deeper may leave open at least, as a share of the band.
const LEAST_OPEN: f64 = 1e-5;

/// The limits between the ends of a vector: the band less a little room, where the ends themselves leave it. A tool that begins at the
/// very limit, as one beside a plane does where INTOL is zero, is there as far as a proof can tell.
fn limits(role: &Working, ends: &Extremes, size: f64) -> [f64; 2] {
    let (room, open, rounding) = (ROOM * role.band(), LEAST_OPEN * role.band(), ROUNDING * size);
    let lowest = (room - role.inside).min(ends.least - open);
    [lowest - rounding, (role.outside - room).max(ends.greatest) + rounding]
}

impl Line<'_> {
    /// Of a clearance below the limits nothing is proven: the vector is refused, whatever else is nearer.
    fn sample(&self, x: f64) -> Sample {
        let (tip, tool) = self.sweep.at(x);
        let lowest = if self.sign > 0.0 { self.limits[0] } else { -self.limits[1] };
        let (contact, missed) = self.role.gauge.contact_within(
            &tool,
            &tip,
            Enough { lowest, slack: LEAST_OPEN * self.role.band(), share: 0.0 },
        );
        Sample { missed, ..self.known(x, &contact, &tip) }
    }

    /// Readings of the clearance with samples between them, which may be of it turned about.
    fn read(&self, readings: Readings, samples: &[Option<Sample>]) -> Readings {
        let turned = |sample: &Sample| Reading {
            x: sample.x,
            value: self.sign * sample.value,
            slope: self.sign * sample.slope,
        };
        samples.iter().flatten().map(turned).fold(readings, Readings::with)
    }

    fn allows(&self, clearance: f64) -> bool {
        clearance >= self.limits[0] && clearance <= self.limits[1]
    }

    /// True if no part of the tool is nearer to the surface than a level.
    fn certified(&self, x: f64, level: f64, found: Option<&Contact>) -> bool {
        let (tip, tool) = self.sweep.at(x);
        self.ledger.certified(&self.role.gauge, &tool, (&tip, found), level)
    }

    fn known(&self, x: f64, contact: &Contact, tip: &Vec3) -> Sample {
        let (value, slope) = (contact.clearance, self.sweep.slope(contact, tip));
        let (value, slope) = (self.sign * value, self.sign * slope);
        Sample { x, value, slope, missed: f64::INFINITY, contact: *contact }
    }
}

/// Least and greatest clearance over the straight move between two positions with known contacts. Once `patience` is over,
/// nothing more is proven.
pub(crate) fn extremes(
    sweep: &Sweep<'_>,
    role: &Working,
    ledger: &Ledger,
    from: (&Vec3, &Contact),
    to: (&Vec3, &Contact),
    size: f64,
    patience: Patience<'_>,
) -> Extremes {
    let (least, greatest) = (from.1.clearance.min(to.1.clearance), from.1.clearance.max(to.1.clearance));
    let length = sweep.length;
    let proven = role.holds(least, size) && role.holds(greatest, size);
    let slope = |contact: &Contact| sweep.direction.dot(&contact.gradient);
    let reading = |x, contact: &Contact| Reading { x, value: contact.clearance, slope: slope(contact) };
    let readings = Readings::at_ends(reading(0.0, from.1), reading(length, to.1));
    let ends = Extremes { least, greatest, proven, readings, turning_bend: None };
    let turns = sweep.turns() && !role.gauge.on;
    let shape = match role.shape {
        Shape::Convex if !turns => role.gauge.shape_along(&sweep.at(0.0).1, [from.0, to.0]),
        Shape::General if !turns && length > 0.0 => {
            let contacts = [(from.0, from.1), (to.0, to.1)];
            let is_convex = role.gauge.is_beside_one_half(sweep.tool(), contacts, role.outside);
            if is_convex { Shape::Convex } else { Shape::General }
        }
        shape => shape,
    };
    if length > 0.0
        && (turns || shape == Shape::General)
        && let Some(found) = support::extremes(sweep, role, ends, size)
    {
        return found;
    }
    if length > 0.0 && turns {
        // Turning the tool bends every clearance, and the gradients at the ends follow the axis' law, not the move.
        let line = Line { sweep, role, ledger, patience, sign: 1.0, limits: limits(role, &ends, size) };
        return course::extremes(&line, line.sample(0.0), line.sample(length), ends);
    }
    if shape == Shape::Flat || length <= 0.0 {
        return ends;
    }
    let sign = if shape == Shape::Concave { -1.0 } else { 1.0 };
    let limits = limits(role, &ends, size);
    let line = Line { sweep, role, ledger, patience, sign, limits };
    let (a, b) = (line.known(0.0, from.1, from.0), line.known(length, to.1, to.0));
    match shape {
        Shape::Flat => ends,
        Shape::Convex => {
            // A proof may leave open what a position may not: beside the limit the least clearance is to be known.
            let spare = (least + role.inside).max(ROUNDING * size);
            let Minimum { value, bound, at } = convex_minimum(&line, a, b, spare.min(ENOUGH * role.band()));
            let proven = ends.proven && bound >= limits[0] && role.holds(value, size);
            Extremes { least: value.min(least), proven, readings: line.read(readings, &at), ..ends }
        }
        Shape::Concave => {
            let Minimum { value, bound, at } = convex_minimum(&line, a, b, ENOUGH * role.band());
            // The least values are those of the ends, if no other part of the tool is deeper there.
            let deepest = |x| line.certified(x, -role.inside - ROUNDING * size, None);
            let proven = ends.proven && -bound <= limits[1] && deepest(0.0) && deepest(length);
            Extremes { greatest: (-value).max(greatest), proven, readings: line.read(readings, &at), ..ends }
        }
        Shape::General => course::extremes(&line, a, b, ends),
    }
}

/// The minimum of a convex function: its least value found, a lower bound from tangents, and the last places looked at for it.
struct Minimum {
    value: f64,
    bound: f64,
    at: [Option<Sample>; 2],
}

/// Minimum of a convex function between two samples.
fn convex_minimum(line: &Line<'_>, a: Sample, b: Sample, enough: f64) -> Minimum {
    let mut value = a.value.min(b.value);
    let found = |value: f64, bound: f64, at: [Option<Sample>; 2]| Minimum { value, bound, at };
    if a.slope >= 0.0 || b.slope <= 0.0 {
        return found(value, value, [None; 2]);
    }
    let (mut a, mut b) = (a, b);
    let mut last = [None; 2];
    for iteration in 0..MAX_ITERATIONS {
        if line.patience.is_over() {
            return found(value, f64::NEG_INFINITY, last);
        }
        let (meeting, bound) = tangents_meet(a, b);
        if value - bound <= enough {
            return found(value, bound, last);
        }
        // Where contact jumps the tangents meet at the minimum, elsewhere it is that of the cubic.
        let x = if iteration % TANGENTS_EVERY == TANGENTS_EVERY - 1 { meeting } else { cubic_minimum(a, b) };
        let middle = line.sample(x);
        last = [last[1], Some(middle)];
        value = value.min(middle.value);
        // With the new tangent both sides are bounded.
        let left = tangents_meet(a, middle).1;
        let right = tangents_meet(middle, b).1;
        let bound = if middle.slope >= 0.0 { left } else { right }.min(middle.value);
        if value - bound <= enough {
            return found(value, bound, last);
        }
        if middle.slope >= 0.0 {
            b = middle;
        } else {
            a = middle;
        }
    }
    found(value, tangents_meet(a, b).1, last)
}

/// Where the cubic through two samples with slopes of opposite sign, falling and rising, has its minimum.
fn cubic_minimum(a: Sample, b: Sample) -> f64 {
    let length = b.x - a.x;
    let middle = a.slope + b.slope - 3.0 * (b.value - a.value) / length;
    let root = (middle * middle - a.slope * b.slope).sqrt();
    let x = b.x - length * (b.slope + root - middle) / (b.slope - a.slope + 2.0 * root);
    if x > a.x && x < b.x { x } else { 0.5 * (a.x + b.x) }
}

/// Where the tangents of two samples with slopes of opposite sign meet.
fn tangents_meet(a: Sample, b: Sample) -> (f64, f64) {
    let turn = b.slope - a.slope;
    if turn <= 0.0 {
        return (0.5 * (a.x + b.x), a.value.min(b.value));
    }
    let x = ((a.value - b.value) + b.slope * b.x - a.slope * a.x) / turn;
    let x = x.clamp(a.x, b.x);
    (x, a.value + a.slope * (x - a.x))
}
