//! Clearances that are neither convex nor concave, and those of a turning tool: the course between samples is bounded by
//! the second derivative. Every point of the tool has a distance that bends upward by no more than K; so has the
//! clearance, the least of them, wherever contact jumps. It is then above every chord less K·s(h − s)/2, and below the
//! parabolas of curvature K from both ends.

mod by_place;
mod held;
mod kept;

use std::borrow::Cow;

use apt_geometry::{Vec3, surface::Bend};

use self::{held::highest, kept::CUTS_BY_FUNCTIONS};
use super::{
    ENOUGH, Extremes, LEAST_OPEN, Ledger, Line, MAX_ITERATIONS, Sample, cubic_minimum, ledger::About,
    second_derivative, tangents_meet,
};
use crate::clearance::Tool;

/// Share of a vector at its ends in which it is not cut first.
const END: f64 = 0.05;
/// How far out of the band, in widths of it, a vector is refused without a second look.
const FAR_OUT: f64 = 1.0;
/// Share of a stretch at which it is cut from an end where the clearance has an extreme, and ratio of the slopes that tells.
const BESIDE_EXTREME: f64 = 1.0 / 6.0;
const LEVEL: f64 = 0.25;
/// Misfit between values and slopes, as a share of the band, above which contact may jump in between.
const JUMP: f64 = 2e-3;
/// Share of how far a clearance is out of its band that says nothing new of how much shorter the vector must be.
const ROUGHLY: f64 = 0.01;
/// Bound of the halvings where it does.
const MAX_DEPTH: u32 = 10;
/// Bound of the samples on one vector.
const MAX_SAMPLES: usize = 400;
/// The same once one of them is out of the band: the vector is refused, and so many tell how much shorter it must be.
const MAX_SAMPLES_REFUSED: usize = 48;
/// Bound of the stretches on one vector that have no bound, as where the tool comes to the end of a surface: shorter ones may
/// have, but so many tell that the vector must be shorter.
const MAX_UNBOUNDED: usize = 12;
/// Share of what is left of the band below a sample that the proof of its depth may leave open. Vertices lie a thousandth of the band inside its limit,
/// and a search for contact leaves open a thousand-millionth of the tool: of bands wider than a hundred-thousandth of that it serves as it is.
const OPEN: f64 = 0.1;
/// Into how many pieces a stretch may have to be cut for a bound of the bend that is of use.
const MOST_PIECES: f64 = 8.0;
/// Cuts of stretches on one vector after which the parts of the surface are looked at: a vector where nothing is steady takes some
/// dozens, others few.
const MOST_CUTS: usize = 3;
/// The same where shorter stretches should do: beside a straight piece of the tool that rubs along a surface at the limit of the band they
/// do not.
const MANY_CUTS: usize = 12;
/// Misfit between slopes and values, as a share of the band, up to which a clearance counts as straight, and share of the band that it then is
/// to be above its lower limit for the parts of the surface to be looked at first: few of them tell it where no bend of all distances does.
const STRAIGHT: f64 = 2e-2;
const CLEAR: f64 = 0.1;
/// Share of a stretch for which a bound is known without a search where none is searched for all of it.
const SHORTER: f64 = 0.25;
/// How often what of a turning tool may come into contact is looked for: the less of it, the shorter its way.
const MOST_NEARS: u32 = 3;
/// Sine between the move and the generators of the surface with which regions are laid out at least.
const LEAST_ACROSS: f64 = 0.01;

/// Every interior extreme between two samples, and the proof that there are no others beyond the band.
pub(super) fn extremes(line: &Line<'_>, a: Sample, b: Sample, ends: Extremes) -> Extremes {
    let (least, greatest) = (ends.least, ends.greatest);
    let mut course = Course { line, samples: vec![a], least, greatest, is_exhausted: false };
    let middle = line.sample(middle(&a, &b));
    course.note(middle.value);
    let readings = line.read(ends.readings, &[Some(middle)]);
    let turning_bend =
        line.sweep.turns().then(|| line.sign * second_derivative([a, middle, b].map(|s| (s.x, s.value))));
    let ends = Extremes { turning_bend, ..ends };
    if course.beyond() > FAR_OUT * line.role.band() {
        return Extremes { least: course.least, greatest: course.greatest, proven: false, readings, ..ends };
    }
    course.between(a, middle, 0);
    course.samples.push(middle);
    course.between(middle, b, 0);
    course.samples.push(b);
    let readings = course.samples.iter().fold(readings, |known, sample| line.read(known, &[Some(*sample)]));
    let proven = ends.proven && !course.is_exhausted && course.holds() && course.prove();
    Extremes { least: course.least, greatest: course.greatest, proven, readings, ..ends }
}

/// What is known of the clearance between two samples.
enum Stretch {
    /// It is in the band.
    Held,
    /// It may leave the band for all that is known; with the bound of its second derivative, unless that is too great to help.
    Open(Option<Bend>),
}

/// The places for which a bound of the bend is asked.
struct Asked<'a> {
    /// The tool in the middle of the stretch.
    tip: Vec3,
    tool: Cow<'a, Tool<'a>>,
    /// No point of the tool that may be in contact strays farther from its place there.
    spread: f64,
    /// No such point is farther from the tool end.
    reach: f64,
    /// The points that are in contact at both ends, taken along to the middle.
    likely: [Vec3; 2],
    /// Least and greatest distance from the surface of what may be in contact.
    range: [f64; 2],
    /// Of a point of the tool across the generators of the surface, by the way of the tool end.
    speed: f64,
    /// Second derivative of the place of a point of a tool that turns.
    swing: f64,
}

impl Asked<'_> {
    fn about(&self) -> About<'_> {
        let Self { ref tool, ref tip, spread, reach, likely, .. } = *self;
        About { tool, tip, spread, reach, likely }
    }

    /// The bound along the way of the tool end.
    fn scaled(&self, bend: Bend) -> Bend {
        match bend {
            Bend::AtMost(bend) => Bend::AtMost(bend * self.speed * self.speed + self.swing),
            other => other,
        }
    }
}

/// The bends of all distances on a stretch, as far as they are known or can be found.
struct Bends<'a, 'b> {
    line: &'a Line<'b>,
    asked: Asked<'a>,
    /// A piece of the stretch, the shortest that is of use.
    piece: f64,
}

impl Bends<'_, '_> {
    /// Whether a bound for the places asked about tells of pieces that they are in the band.
    fn is_of_use(&self, bend: f64) -> bool {
        match self.asked.scaled(Bend::AtMost(bend)) {
            Bend::AtMost(bend) => 0.125 * bend * self.piece * self.piece <= self.line.role.band(),
            Bend::Unbounded => false,
        }
    }

    fn serves(&self, bend: Option<Bend>) -> bool {
        matches!(bend, Some(Bend::AtMost(bend)) if self.is_of_use(bend))
    }

    /// The bound that is known from another stretch.
    fn known(&self) -> Option<Bend> {
        let Line { role, ledger, .. } = self.line;
        ledger.known_bend(&role.gauge, &self.asked.about(), self.asked.range).map(Bend::AtMost)
    }

    /// The bound of a part of the stretch that takes no search.
    fn of_shorter(&self) -> Option<Bend> {
        let gauge = &self.line.role.gauge;
        Ledger::bend_of_shorter(gauge, &self.asked.about(), self.asked.range, SHORTER).map(Bend::AtMost)
    }

    /// Whether the bound that is known was found for much more than this stretch.
    fn is_loose(&self) -> bool {
        self.line.ledger.is_loose(&self.asked.about(), self.asked.range)
    }

    /// The bound that is searched for, as closely as it takes to be of use.
    fn found(&self, is_of_use: &dyn Fn(f64) -> bool) -> Option<Bend> {
        let Line { role, ledger, .. } = self.line;
        ledger.bend(&role.gauge, &self.asked.about(), self.asked.range, is_of_use)
    }
}

struct Course<'a, 'b> {
    line: &'a Line<'b>,
    samples: Vec<Sample>,
    least: f64,
    greatest: f64,
    /// Samples ran out: extremes may have been missed.
    is_exhausted: bool,
}

impl Course<'_, '_> {
    fn note(&mut self, value: f64) {
        self.least = self.least.min(value);
        self.greatest = self.greatest.max(value);
    }

    /// A length that tells something of extremes: a share of the band, but once they are out of it a share of how far, because the
    /// vector is refused and they only tell how much shorter it must be.
    fn telling(&self, share: f64) -> f64 {
        (share * self.line.role.band()).max(ROUGHLY * self.beyond())
    }

    /// How far out of the band the clearance is.
    fn beyond(&self) -> f64 {
        let [low, high] = self.line.limits;
        (low - self.least).max(self.greatest - high)
    }

    fn holds(&self) -> bool {
        self.line.allows(self.least) && self.line.allows(self.greatest)
    }

    /// Looks for extremes between two samples. Where the values do not fit the slopes, contact jumps from one part of
    /// the tool to another in between, where their clearances are equal: about where the tangents meet.
    fn between(&mut self, a: Sample, b: Sample, depth: u32) {
        self.note(a.value);
        self.note(b.value);
        let misfit = (b.value - a.value) - 0.5 * (a.slope + b.slope) * (b.x - a.x);
        if misfit.abs() > self.telling(JUMP) && depth < MAX_DEPTH {
            let limit = if self.holds() { MAX_SAMPLES } else { MAX_SAMPLES_REFUSED };
            if self.samples.len() >= limit || self.line.patience.is_over() {
                self.is_exhausted = true;
                return;
            }
            let x = match kink(a, b) {
                // Between two parts of the tool there is nothing higher.
                Some((_, value)) if value - a.value.max(b.value) <= self.telling(ENOUGH) => return,
                Some((x, _)) => x,
                None => 0.5 * (a.x + b.x),
            };
            let middle = self.line.sample(x);
            self.between(a, middle, depth + 1);
            self.samples.push(middle);
            self.between(middle, b, depth + 1);
        } else if (a.slope < 0.0) != (b.slope < 0.0) {
            self.turn(a, b, self.telling(ENOUGH));
        }
    }

    /// The extreme between two samples whose slopes differ in sign.
    fn turn(&mut self, mut a: Sample, mut b: Sample, enough: f64) {
        if a.slope.abs().min(b.slope.abs()) * (b.x - a.x) <= enough {
            return;
        }
        let mut last = a;
        for _ in 0..MAX_ITERATIONS {
            let x = (a.x * b.slope - b.x * a.slope) / (b.slope - a.slope);
            let x = if x > a.x && x < b.x { x } else { 0.5 * (a.x + b.x) };
            last = self.line.sample(x);
            self.note(last.value);
            // What is left to gain is at most slope times distance.
            if last.slope.abs() * (b.x - a.x) <= enough {
                break;
            }
            if (last.slope < 0.0) == (a.slope < 0.0) {
                a = last;
            } else {
                b = last;
            }
        }
        self.samples.push(last);
    }

    /// Halves stretches until all of them are proven.
    fn prove(&mut self) -> bool {
        let mut samples = std::mem::take(&mut self.samples);
        samples.sort_by(|a, b| a.x.total_cmp(&b.x));
        if !samples.iter().all(|sample| self.deep_enough(sample)) {
            return false;
        }
        if let [first, .., last] = samples.as_slice() {
            let vector = self.ask(first, last);
            self.line.ledger.foresee(&self.line.role.gauge, &vector.about(), vector.range);
        }
        let (mut count, mut unbounded) = (samples.len(), 0);
        let mut open: Vec<(Sample, Sample)> = samples.windows(2).map(|pair| (pair[0], pair[1])).collect();
        while let Some((a, b)) = open.pop() {
            match self.stretch(&a, &b, count - samples.len()) {
                Stretch::Held => continue,
                Stretch::Open(bend) => {
                    unbounded += usize::from(
                        bend == Some(Bend::Unbounded)
                            && self.bend_of_witness(&a, &b, f64::INFINITY).is_none(),
                    );
                }
            }
            let x = cut(&a, &b, ENOUGH * self.line.role.band());
            count += 1;
            if count > MAX_SAMPLES
                || unbounded > MAX_UNBOUNDED
                || x <= a.x
                || x >= b.x
                || self.line.patience.is_over()
            {
                return false;
            }
            let middle = self.line.sample(x);
            self.note(middle.value);
            if !self.holds() || !self.deep_enough(&middle) {
                return false;
            }
            open.push((a, middle));
            open.push((middle, b));
        }
        true
    }

    /// What the tool may be deeper at a sample than its contact says.
    fn open(&self, sample: &Sample) -> f64 {
        let role = self.line.role;
        (OPEN * (sample.value + role.inside)).max(LEAST_OPEN * role.band())
    }

    /// The same as far as the contact's own search says, which mostly leaves less open than it may.
    fn left_open(&self, sample: &Sample) -> f64 {
        self.open(sample).min(sample.missed)
    }

    fn deep_enough(&self, sample: &Sample) -> bool {
        let open = self.open(sample);
        sample.missed <= open || self.line.certified(sample.x, sample.value - open, Some(&sample.contact))
    }

    /// Whether the clearance is in the band between two samples: by a bound for all of the tool, if one is known or likely to be of
    /// use, by the contacts at both ends, or by a bound after all; and by parts of the surface where cuts have not done.
    fn stretch(&self, a: &Sample, b: &Sample, cuts: usize) -> Stretch {
        let told = self.told_by_functions(a, b, cuts);
        match told {
            Some([true, true]) => return Stretch::Held,
            // Shorter stretches are told by them before a bend is searched for.
            Some(_) if cuts < CUTS_BY_FUNCTIONS => return Stretch::Open(None),
            _ => {}
        }
        self.stretch_by_bends([a, b], cuts, told)
    }

    /// The same with what functions have told of the lower and the upper limit, if they were asked.
    fn stretch_by_bends(&self, [a, b]: [&Sample; 2], cuts: usize, told: Option<[bool; 2]>) -> Stretch {
        let Line { sweep, role, ledger, .. } = self.line;
        let bends = Bends { line: self.line, asked: self.ask(a, b), piece: (b.x - a.x) / MOST_PIECES };
        let Asked { ref tip, ref tool, .. } = bends.asked;
        let bounded = |bend| self.bounded(a, b, bends.asked.scaled(bend));
        let mut bend = bends.known();
        let known = bend.or_else(|| bends.of_shorter());
        // What is straight without a bend of use that is known is told by places and parts of the surface, not by bends of all distances; by parts,
        // some hundred of them, only where the contacts at both ends do not tell it.
        let is_straight = !bends.serves(known) && self.is_straight(a, b);
        let is_clear = is_straight && (self.is_kept_by_contacts(a, b) || self.is_clear_between(a, b));
        if is_clear && self.is_held_from_both(a, b, false) {
            return Stretch::Held;
        }
        let mut is_asked = known.is_some();
        if !is_asked && ledger.expects_use(tool, tip) {
            (bend, is_asked) = (bends.found(&|bend| bends.is_of_use(bend)), true);
            ledger.note_use(tip, bends.serves(bend));
        }
        // Where pieces will do, that takes less than the contacts on a quadric, than those of a disc seen along a surface, and than contacts that have
        // just told nothing of as long a stretch.
        let by_contacts = told.is_none() && !bends.serves(bend)
            || role.gauge.surface.has_charts()
                && (cuts >= MOST_CUTS || ledger.expects_contacts(tool, tip, b.x - a.x))
                && !role.gauge.is_seen_along(tool, tip);
        let (held, kept) = bend.map_or((false, false), bounded);
        // Where shorter stretches will do, two more feet on the surface cost more than a contact.
        let [is_kept, is_held] = told.unwrap_or_default();
        let high = held || is_held || self.is_held_from_both(a, b, told.is_none() && !bends.serves(bend));
        let low = is_clear || kept || is_kept || high && by_contacts && self.is_kept_from_both(a, b);
        if high && by_contacts && !low {
            ledger.note_silence(tip, b.x - a.x);
        }
        if high && low {
            return Stretch::Held;
        }
        if !is_asked || bend.is_some() && bends.is_loose() {
            bend = bends.found(&|bend| {
                let (held, kept) = bounded(Bend::AtMost(bend));
                (high || held) && (low || kept)
            });
        }
        let (held, kept) = bend.map_or((false, false), bounded);
        let is_high = high || held;
        // Parts of the surface take more than shorter stretches where those will do, unless contacts take as much.
        let by_parts = is_high
            && ((cuts >= MOST_CUTS || sweep.turns()) && !bends.serves(bend.or(known))
                || cuts >= MANY_CUTS
                || role.gauge.is_hard());
        let is_low = low
            || kept
            || !high && by_contacts && self.is_kept_from_both(a, b)
            || by_parts && self.is_clear_between(a, b);
        if is_high && is_low { Stretch::Held } else { Stretch::Open(bend) }
    }

    /// Whether the clearance hardly leaves its chord between two samples, as far as these tell, and that keeps off the lower limit of the band.
    fn is_straight(&self, a: &Sample, b: &Sample) -> bool {
        let Line { role, limits, .. } = self.line;
        let (rise, length, band) = (b.value - a.value, b.x - a.x, role.band());
        let is_along = |end: &Sample| (end.slope * length - rise).abs() <= STRAIGHT * band;
        is_along(a) && is_along(b) && a.value.min(b.value) - limits[0] >= CLEAR * band
    }

    /// For which places a bound of the bend is needed on the stretch between two samples.
    fn ask(&self, a: &Sample, b: &Sample) -> Asked<'_> {
        let Line { sweep, role, ledger, .. } = self.line;
        // Along its generators a surface does not change, so that only the way across them counts.
        let across = match role.gauge.surface.generator() {
            Some(generator) if role.gauge.on || !sweep.turns() => sweep.direction.cross(&generator).norm(),
            _ => 1.0,
        };
        let (low, high) = (a.value.min(b.value), a.value.max(b.value));
        let thickness = role.gauge.thickness;
        let (tip, tool) = sweep.at(0.5 * (a.x + b.x));
        let way_of = |reach: f64| (b.x - a.x) * self.stretch_of(reach) * across.max(LEAST_ACROSS);
        // A point that is in contact on the way is nowhere farther from contact than the way is long.
        let farthest = |way: f64| high + 1.5 * way + thickness;
        let mut reach = role.gauge.reach(sweep.tool());
        let nears = if role.gauge.on || !sweep.turns() { 0 } else { MOST_NEARS };
        for _ in 0..nears {
            // What is too far to come into contact with the way of the farthest point that counts does not count.
            let way = way_of(reach);
            let near = ledger.reach_within(&role.gauge, &tool, &tip, farthest(way) + 0.5 * way);
            if near >= reach {
                break;
            }
            reach = near;
        }
        let way = way_of(reach);
        let middle = 0.5 * (a.x + b.x);
        let likely = [a, b].map(|end| sweep.carried(&end.contact.tool, end.x, middle));
        Asked {
            tip,
            tool,
            spread: 0.5 * way,
            reach,
            likely,
            range: [low - way + thickness, farthest(way)],
            speed: self.stretch_of(reach) * across,
            swing: if role.gauge.on { 0.0 } else { sweep.swing(reach) },
        }
    }

    /// Whether a bound of the second derivative shows that the clearance is nowhere above the band on a stretch, and nowhere below.
    fn bounded(&self, a: &Sample, b: &Sample, bend: Bend) -> (bool, bool) {
        match bend {
            Bend::AtMost(bend) => {
                let ends = (a.value - self.left_open(a), b.value - self.left_open(b));
                (self.line.allows(highest(a, b, bend)), self.line.allows(lowest(ends, bend, b.x - a.x)))
            }
            Bend::Unbounded => (false, false),
        }
    }

    /// How far what is measured of the tool within a distance of its end moves at most, for each length that the end does.
    fn stretch_of(&self, reach: f64) -> f64 {
        let Line { sweep, role, .. } = self.line;
        if role.gauge.on { 1.0 } else { sweep.stretch(reach) }
    }
}

/// Where a vector is looked at first: at the extreme of the cubic through both ends with their slopes, if it has just one.
fn middle(a: &Sample, b: &Sample) -> f64 {
    let length = b.x - a.x;
    let x = if a.slope < 0.0 && b.slope > 0.0 {
        cubic_minimum(*a, *b)
    } else if a.slope > 0.0 && b.slope < 0.0 {
        cubic_minimum(a.turned(), b.turned())
    } else {
        0.5 * (a.x + b.x)
    };
    x.clamp(a.x + END * length, b.x - END * length)
}

/// Where a stretch is cut that is not proven. Next to an extreme at the limit of the band only short ones are, while slopes
/// carry far elsewhere.
fn cut(a: &Sample, b: &Sample, enough: f64) -> f64 {
    let (here, there) = (a.slope.abs(), b.slope.abs());
    let share = if here.max(there) * (b.x - a.x) <= enough {
        0.5
    } else if here <= LEVEL * there {
        BESIDE_EXTREME
    } else if there <= LEVEL * here {
        1.0 - BESIDE_EXTREME
    } else {
        0.5
    };
    a.x + share * (b.x - a.x)
}

/// Where the tangents of two samples meet and what they say there, if the second one rises less: the lesser of two clearances
/// then changes between.
fn kink(a: Sample, b: Sample) -> Option<(f64, f64)> {
    let turn = a.slope - b.slope;
    let x = (((b.value - b.slope * b.x) - (a.value - a.slope * a.x)) / turn).clamp(a.x, b.x);
    let tangents = [a, b].map(|end| end.value + end.slope * (x - end.x));
    (turn > 0.0).then(|| (x, tangents[0].min(tangents[1])))
}

/// Least value on a stretch of the chord between the end values, sagging with the given second derivative.
pub(in crate::directed) fn lowest((left, right): (f64, f64), bend: f64, length: f64) -> f64 {
    let sag = 0.5 * bend * length;
    // Slope of chord and sag at both ends: −sag and +sag besides that of the chord.
    let slope = (right - left) / length;
    if slope.abs() >= sag || sag <= 0.0 {
        return left.min(right);
    }
    // Zero of the slope.
    let s = (sag - slope) / bend;
    left + (slope - sag) * s + 0.5 * bend * s * s
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::clearance::Contact;

    fn sample(x: f64, value: f64, slope: f64) -> Sample {
        let none = Vec3::zeros();
        let contact = Contact { clearance: value, gradient: none, tool: none, surface: none };
        Sample { x, value, slope, missed: 0.0, contact }
    }

    #[test]
    fn bounds_of_a_parabola_are_the_parabola() {
        // x² − x on [0, 1]: second derivative 2.
        let (a, b) = (sample(0.0, 0.0, -1.0), sample(1.0, 0.0, 1.0));
        assert!((lowest((0.0, 0.0), 2.0, 1.0) + 0.25).abs() < 1e-15);
        assert!(highest(&a, &b, 2.0).abs() < 1e-15);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        /// The least of several parabolas of curvature K at most stays between the bounds.
        #[test]
        fn no_least_of_parabolas_leaves_its_bounds(
            parts in prop::collection::vec((-1.0..1.0f64, -3.0..3.0f64, -6.0..1.0f64), 1..5),
            length in 0.1..2.0f64,
        ) {
            let bend = 1.0;
            let at = |x: f64| {
                parts
                    .iter()
                    .map(|(c, m, k)| (c + (m + 0.5 * k * x) * x, m + k * x))
                    .min_by(|p, q| p.0.total_cmp(&q.0))
                    .expect("a part")
            };
            let ends = [0.0, length].map(|x| sample(x, at(x).0, at(x).1));
            let low = lowest((ends[0].value, ends[1].value), bend, length);
            let high = highest(&ends[0], &ends[1], bend);
            for k in 0..=200 {
                let value = at(length * f64::from(k) / 200.0).0;
                prop_assert!(value >= low - 1e-12 && value <= high + 1e-12, "{low} {value} {high}");
            }
        }
    }
}
