//! Proof that a cut vector keeps a role's band over its whole length (GOUGCK made exact). Convex and concave clearances
//! have one interior extreme, which tangents bound from beyond; other clearances are followed from slope to slope.

use apt_geometry::Vec3;

use crate::{
    attitude::Sweep,
    clearance::{Contact, Shape},
    role::Working,
};

/// Bound of the refinement of one extreme.
const MAX_ITERATIONS: u32 = 24;
/// Pieces into which a vector is cut when the clearance is neither convex nor concave.
const PIECES: usize = 6;
/// Misfit between values and slopes, as a share of the band, above which contact may jump in between.
const JUMP: f64 = 2e-3;
/// Bound of the halvings where it does.
const MAX_DEPTH: u32 = 10;
/// An extreme is known well enough when its bound and its value differ by this share of the band.
const ENOUGH: f64 = 2e-4;

/// Extreme clearances over a cut vector, and whether they were shown to be in the band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extremes {
    pub(crate) least: f64,
    pub(crate) greatest: f64,
    pub(crate) proven: bool,
}

/// Clearance and its derivative at a place along the vector.
#[derive(Clone, Copy)]
struct Sample {
    x: f64,
    value: f64,
    slope: f64,
}

/// A clearance along a straight line.
struct Line<'a> {
    sweep: &'a Sweep<'a>,
    role: &'a Working,
    /// −1 turns a concave clearance into a convex one.
    sign: f64,
}

impl Line<'_> {
    fn sample(&self, x: f64) -> Sample {
        let (tip, tool) = self.sweep.at(x);
        let contact = self.role.gauge.contact(&tool, &tip);
        self.known(x, &contact, &tip)
    }

    fn known(&self, x: f64, contact: &Contact, tip: &Vec3) -> Sample {
        Sample { x, value: self.sign * contact.clearance, slope: self.sign * self.sweep.slope(contact, tip) }
    }
}

/// Least and greatest clearance over the straight move between two positions with known contacts.
pub(crate) fn extremes(
    sweep: &Sweep<'_>,
    role: &Working,
    from: (&Vec3, &Contact),
    to: (&Vec3, &Contact),
    size: f64,
) -> Extremes {
    let (least, greatest) = (from.1.clearance.min(to.1.clearance), from.1.clearance.max(to.1.clearance));
    let length = sweep.length;
    let ends = Extremes { least, greatest, proven: role.holds(least, size) && role.holds(greatest, size) };
    if length > 0.0 && sweep.turns() && !role.gauge.on {
        // Turning the tool bends every clearance, and the gradients at the ends follow the axis' law, not the move.
        let line = Line { sweep, role, sign: 1.0 };
        return general(&line, line.sample(0.0), line.sample(length), ends, size);
    }
    if role.shape == Shape::Flat || length <= 0.0 {
        return ends;
    }
    let sign = if role.shape == Shape::Concave { -1.0 } else { 1.0 };
    let line = Line { sweep, role, sign };
    let (a, b) = (line.known(0.0, from.1, from.0), line.known(length, to.1, to.0));
    match role.shape {
        Shape::Flat => ends,
        Shape::Convex => {
            let (value, bound) = convex_minimum(&line, a, b, ENOUGH * role.band());
            let proven = ends.proven && role.holds(bound, size);
            Extremes { least: value.min(least), greatest, proven }
        }
        Shape::Concave => {
            let (value, bound) = convex_minimum(&line, a, b, ENOUGH * role.band());
            let proven = ends.proven && role.holds(-bound, size);
            Extremes { least, greatest: (-value).max(greatest), proven }
        }
        Shape::General => general(&line, a, b, ends, size),
    }
}

/// Minimum of a convex function between two samples: its least value found and a lower bound from tangents.
fn convex_minimum(line: &Line<'_>, a: Sample, b: Sample, enough: f64) -> (f64, f64) {
    if a.slope >= 0.0 || b.slope <= 0.0 {
        let value = a.value.min(b.value);
        return (value, value);
    }
    let (mut a, mut b) = (a, b);
    let mut value = a.value.min(b.value);
    for _ in 0..MAX_ITERATIONS {
        let (x, bound) = tangents_meet(a, b);
        if value - bound <= enough {
            return (value, bound);
        }
        let middle = line.sample(x);
        value = value.min(middle.value);
        // With the new tangent both sides are bounded.
        let left = tangents_meet(a, middle).1;
        let right = tangents_meet(middle, b).1;
        let bound = if middle.slope >= 0.0 { left } else { right }.min(middle.value);
        if value - bound <= enough {
            return (value, bound);
        }
        if middle.slope >= 0.0 {
            b = middle;
        } else {
            a = middle;
        }
    }
    (value, tangents_meet(a, b).1)
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

/// Every interior extreme between samples that are close enough to tell the course between them.
fn general(line: &Line<'_>, a: Sample, b: Sample, ends: Extremes, size: f64) -> Extremes {
    let mut found = (ends.least, ends.greatest);
    let mut from = a;
    for k in 1..=PIECES {
        let to = if k == PIECES { b } else { line.sample(b.x * k as f64 / PIECES as f64) };
        between(line, from, to, 0, &mut found);
        from = to;
    }
    let (least, greatest) = found;
    Extremes { least, greatest, proven: line.role.holds(least, size) && line.role.holds(greatest, size) }
}

/// Extremes between two samples. Where the values do not fit the slopes, contact jumps from one part of the tool to
/// another in between, and the stretch is halved.
fn between(line: &Line<'_>, a: Sample, b: Sample, depth: u32, found: &mut (f64, f64)) {
    found.0 = found.0.min(a.value).min(b.value);
    found.1 = found.1.max(a.value).max(b.value);
    let misfit = (b.value - a.value) - 0.5 * (a.slope + b.slope) * (b.x - a.x);
    if misfit.abs() > JUMP * line.role.band() && depth < MAX_DEPTH {
        let middle = line.sample(0.5 * (a.x + b.x));
        between(line, a, middle, depth + 1, found);
        between(line, middle, b, depth + 1, found);
    } else if (a.slope < 0.0) != (b.slope < 0.0) {
        let value = turning_value(line, a, b, ENOUGH * line.role.band());
        found.0 = found.0.min(value);
        found.1 = found.1.max(value);
    }
}

/// The extreme between two samples whose slopes differ in sign.
fn turning_value(line: &Line<'_>, a: Sample, b: Sample, enough: f64) -> f64 {
    let (mut a, mut b) = (a, b);
    let mut value = a.value;
    for _ in 0..MAX_ITERATIONS {
        let x = (a.x * b.slope - b.x * a.slope) / (b.slope - a.slope);
        let x = if x > a.x && x < b.x { x } else { 0.5 * (a.x + b.x) };
        let middle = line.sample(x);
        value = middle.value;
        // What is left to gain is at most slope times distance.
        if middle.slope.abs() * (b.x - a.x) <= enough {
            break;
        }
        if (middle.slope < 0.0) == (a.slope < 0.0) {
            a = middle;
        } else {
            b = middle;
        }
    }
    value
}
