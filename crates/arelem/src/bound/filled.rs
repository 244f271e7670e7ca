//! How many vectors a path fills. A clearance along the path is what it would be along a straight line, and how the path bends besides:
//! a vector may cover a stretch of the path only if a straight line is as near to that bend as the band is wide, for part and drive
//! surface both, and if the stretch is no longer than MAXDP. A stretch within one that a vector may cover is such a one, too.
//!
//! So no sequence comes farther with any number of vectors than by the longest such stretches, one after the other: if n vectors come no
//! farther than F(n), the next one begins there or before, and one that led beyond F(n + 1) would cover more from F(n) on than any line does.
//!
//! Nor may a vector begin anywhere in the band: it begins where the one before it ends, the first one where the motion does. Both are counted
//! ([`strand`]), along the surface that a vector is full by alone, for of the other one it is not known where another vector would have come to.
//!
//! That holds of what bends as it was read: from clearances at few places of each vector, and along one path for all in the bands. The bands are
//! taken to be wider for that by [`WIDER`], which dynamic programming has found to be enough (`fewest`) and nothing proves.

#[cfg(test)]
mod fewest;
mod hull;
mod steady;
mod strand;

use self::{steady::Turns, strand::Strand};
use super::readings::Readings;
use crate::role::Working;

/// Share of a band by which it is taken to be wider than it is for the least number of vectors: clearances are read at few places of each vector, between
/// which a cubic tells them, and where a vector is full is found to a thousandth of it (`strand`), which is twice as much of what its square fills. It
/// leaves out a thousandth of all vectors.
pub(super) const WIDER: f64 = 0.002;
/// The same for what each vector of a path fills, where fewer are looked for: it leaves out a hundredth, so that no stretch is passed over of which
/// another one, elsewhere in the bands, may be gone along in fewer vectors.
pub(super) const WIDER_ROUGHLY: f64 = 0.02;

/// How wide a band is for a vector; `None` of one without width, which belongs to what does not bend, or no vector would have been proven.
fn room([low, high]: [f64; 2]) -> Option<f64> {
    (high > low).then_some(high - low)
}

/// A band that is wider by a share, on both sides.
fn widened([low, high]: [f64; 2], share: f64) -> [f64; 2] {
    let more = 0.5 * share * (high - low);
    [low - more, high + more]
}

/// What a vector is to keep.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// The clearances at both limits of the widened band, for part and drive surface.
    bands: [[f64; 2]; 2],
    /// The way beside one vector, from its one end to the other.
    longest: f64,
}

impl Limits {
    /// Those of both roles, wider by a share, and MAXDP.
    pub(super) fn new(roles: [&Working; 2], maximum_step: f64, wider: f64) -> Self {
        // The way beside one vector, from its one end to the other within the bands, may be longer by that.
        let longest = maximum_step + 2.0 * (roles[0].band() + roles[1].band());
        Self { bands: roles.map(|role| widened([-role.inside, role.outside], wider)), longest }
    }
}

/// What a path fills of vectors.
#[derive(Debug, Clone, Default)]
pub(super) struct Filled {
    /// Vectors that are full.
    vectors: f64,
    /// The way since then, and that along the last of them.
    length: f64,
    last: f64,
    /// How part and drive surface bend since then; nothing before the first vector.
    bent: Option<[Strand; 2]>,
}

impl Filled {
    /// Adds a vector that keeps its bands. It fills no more than another one, whatever was before.
    pub(super) fn add(&mut self, readings: [&Readings; 2], limits: &Limits) {
        let Self { vectors, length: covered, last, bent } = self;
        let bent =
            bent.get_or_insert_with(|| [0, 1].map(|k| Strand::from_start(readings[k], limits.bands[k])));
        let ([part, drive], [for_part, for_drive]) = (readings, limits.bands);
        let (part, drive) = (Turns::of(part, for_part), Turns::of(drive, for_drive));
        let along = [&part, &drive];
        let length = readings[0].length();
        let mut full = (*covered + length > limits.longest).then_some(limits.longest - *covered);
        // The surface that fills the vector: along the other one it is not known where another vector would have come to.
        let mut by = None;
        for (k, strand) in bent.iter_mut().enumerate() {
            if let Some(x) = strand.full(along[k], limits.bands[k], full.unwrap_or(length)) {
                (full, by) = (Some(x), Some(k));
            }
        }
        let begin = full.map_or(0.0, |x| x.max(0.0));
        if full.is_some() {
            *vectors += 1.0;
            (*last, *covered) = (*covered + begin, 0.0);
            for (k, strand) in bent.iter_mut().enumerate() {
                if by == Some(k) {
                    strand.begin_beyond(along[k], limits.bands[k], begin);
                } else {
                    strand.begin();
                }
            }
        }
        *covered += length - begin;
        for (k, strand) in bent.iter_mut().enumerate() {
            strand.extend(along[k], limits.bands[k], begin);
        }
    }

    /// All vectors, the last of which need not be full.
    pub(super) fn count(&self, limits: &Limits) -> f64 {
        let share = |strands: &[Strand; 2]| {
            let shares = [0, 1].map(|k: usize| strands[k].filled(limits.bands[k]));
            shares.into_iter().fold(self.length / limits.longest, f64::max)
        };
        self.vectors + self.bent.as_ref().map_or(0.0, share)
    }

    /// The vectors that any sequence needs to come to the end, or to within a way before it; `None` if that way is longer than one of them.
    pub(super) fn least(&self, short_of_end: f64) -> Option<f64> {
        if short_of_end < self.length {
            return Some(self.vectors + 1.0);
        }
        (short_of_end < self.length + self.last).then_some(self.vectors)
    }
}

#[cfg(test)]
mod tests {
    use super::{super::readings::Reading, hull::LAID, *};

    const BAND: f64 = 0.01;
    const LIMITS: Limits = Limits { bands: [[-0.25 * BAND, 0.75 * BAND]; 2], longest: f64::INFINITY };

    /// A vector from one x to another along a curve y, told as y and its slope, that begins and ends at the upper limit of the band.
    fn vector(curve: impl Fn(f64) -> [f64; 2], [from, to]: [f64; 2], inner: &[f64]) -> Readings {
        let (start, length) = (curve(from), to - from);
        let steep = (curve(to)[0] - start[0]) / length;
        let read = |x: f64| {
            let [y, slope] = curve(from + x);
            let value = LIMITS.bands[0][1] + y - start[0] - steep * x;
            Reading { x, value, slope: slope - steep }
        };
        inner
            .iter()
            .fold(Readings::at_ends(read(0.0), read(length)), |known, share| known.with(read(share * length)))
    }

    fn straight(length: f64) -> Readings {
        let at = |x: f64| Reading { x, ..Reading::default() };
        Readings::at_ends(at(0.0), at(length))
    }

    /// What vectors fill along one role alone.
    fn count(vectors: &[Readings], limits: &Limits) -> f64 {
        let mut filled = Filled::default();
        vectors.iter().for_each(|along| filled.add([along, &straight(along.length())], limits));
        filled.count(limits)
    }

    fn along(curve: impl Fn(f64) -> [f64; 2], ends: &[f64], inner: &[f64]) -> Vec<Readings> {
        ends.windows(2).map(|pair| vector(&curve, [pair[0], pair[1]], inner)).collect()
    }

    fn places(count: u32, end: f64) -> Vec<f64> {
        (0..=count).map(|k| end * f64::from(k) / f64::from(count)).collect()
    }

    /// On a parabola a vector is √(8τ/κ) long, in whatever vectors it has been gone along; the band is taken to be wider by a share.
    #[test]
    fn a_parabola_fills_its_integral() {
        let parabola = |x: f64| [0.5 * x * x, x];
        let full = (8.0 * BAND).sqrt();
        for vectors in [10, 13, 40, 97] {
            let found = count(&along(parabola, &places(vectors, 9.7 * full), &[0.5]), &LIMITS);
            assert!((found - 9.7).abs() < 0.06, "{vectors}: {found}");
        }
    }

    /// Of y = −x³ between −a and a the line −3a²x/4 is a³/4 off: where the bend changes sides one vector covers what fills 1.63 by the integral.
    /// Of what is a little longer on both sides any two vectors might cover more; from the limit at which the first one begins it needs three, for no
    /// line that the first one leads to goes on to the end.
    #[test]
    fn a_vector_that_bends_both_ways_covers_more_than_its_integral() {
        let cubic = |x: f64| [-x * x * x, -3.0 * x * x];
        let longest = 2.0 * (2.0 * BAND).cbrt();
        for (share, whole) in [(0.98, 1.0), (1.05, 3.0)] {
            let ends: Vec<f64> =
                places(12, share * longest).iter().map(|x| x - 0.5 * share * longest).collect();
            let found = count(&along(cubic, &ends, &[0.5]), &LIMITS);
            assert_eq!(found.ceil(), whole, "{share}: {found}");
        }
    }

    /// A path that turns within a small part of each vector has hardly any integral, and still no vector leads beyond two of its corners.
    #[test]
    fn corners_need_vectors() {
        // Turns by a third within a hundredth after each whole x.
        let bend = |x: f64| {
            let (whole, rest) = (x.floor(), (x.fract() / 0.01).min(1.0));
            let y = whole * (whole - 1.0) / 6.0 + whole * x.fract() / 3.0 - whole * 0.005 / 3.0;
            [y + 0.005 * rest * rest / 3.0 + (x.fract() - 0.01).max(0.0) / 3.0, (whole + rest) / 3.0]
        };
        let ends: Vec<f64> = (0..=10).map(|k| f64::from(k) + 0.005).collect();
        let found = count(&along(bend, &ends, &[0.004, 0.006, 0.5, 0.994]), &LIMITS);
        assert!((9.0..=10.0).contains(&found), "{found}");
    }

    /// Where the surfaces bend in turn a vector is full before what either fills is.
    #[test]
    fn bends_in_turn_fill_more_vectors_than_either_alone() {
        let (parabola, full) = (|x: f64| [0.5 * x * x, x], 0.6 * (8.0 * BAND).sqrt());
        let (bent, level) = (vector(parabola, [0.0, full], &[0.5]), straight(full));
        let mut filled = Filled::default();
        for k in 0..80 {
            filled.add(if k % 2 == 0 { [&bent, &level] } else { [&level, &bent] }, &LIMITS);
        }
        let found = filled.count(&LIMITS);
        assert!(found > 1.1 * 24.0 && found < 48.0, "{found}");
    }

    /// Where a vector is full is looked for with the points ahead alone: those of the stretch are laid to its hull once a vector.
    #[test]
    fn points_of_a_stretch_are_laid_once_a_vector() {
        let wave = |x: f64| [0.02 * (9.0 * x).sin(), 0.18 * (9.0 * x).cos()];
        let vectors = along(wave, &places(240, 8.0), &[0.3, 0.6]);
        let before = LAID.get();
        count(&vectors, &LIMITS);
        let each = (LAID.get() - before) as f64 / vectors.len() as f64;
        assert!(each <= 80.0, "{each} points a vector");
    }

    /// No vector is longer than MAXDP and what the bands are wide, straight ones least of all.
    #[test]
    fn straight_vectors_fill_their_length() {
        let limits = Limits { longest: 2.0, ..LIMITS };
        assert!((count(&[straight(0.7); 10], &limits) - 3.5).abs() < 1e-9);
        assert_eq!(count(&[straight(0.7); 10], &LIMITS), 0.0);
    }

    /// Each vector keeps both bands and begins where the one before it ends, so that there cannot be a need for more than there are.
    #[test]
    fn no_more_vectors_are_filled_than_there_are() {
        let reading = |k: usize, at: usize| {
            let share = |m: usize| (k * m % 101) as f64 / 100.0;
            let at_vertex = |k: usize| (k * 37 % 101) as f64 / 100.0;
            let part = match at {
                0 => at_vertex(k),
                3 => at_vertex(k + 1),
                _ => share(37 + at),
            };
            let value = LIMITS.bands[0][0] + BAND * part;
            Reading { x: 0.1 * at as f64, value, slope: share(61 + at) - 0.5 }
        };
        let mut filled = Filled::default();
        for k in 0..200 {
            let [part, drive] = [k, k + 7].map(|k| {
                Readings::at_ends(reading(k, 0), reading(k, 3)).with(reading(k, 1)).with(reading(k, 2))
            });
            filled.add([&part, &drive], &LIMITS);
            assert!(filled.count(&LIMITS) <= (k + 1) as f64 + 1e-9);
            assert!(filled.least(0.0).is_some_and(|least| least <= (k + 1) as f64));
        }
    }
}
