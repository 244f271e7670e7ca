//! What samples at three places of a vector tell of a piece of it, where nothing is known of the shape of a clearance.

use super::{Extremes, Sample};

/// Three samples of which each is no farther from another than the tool moves between them, and their errors: what is known closely
/// at one place tells how close the others are.
pub(super) fn told_by_each_other(samples: [Sample; 3], length: f64) -> [Sample; 3] {
    samples.map(|sample| {
        let mut range = [f64::NEG_INFINITY, f64::INFINITY];
        for other in samples {
            let apart = length * (other.t - sample.t).abs() + other.error;
            range = [range[0].max(other.value - apart), range[1].min(other.value + apart)];
        }
        if range[0] > range[1] {
            return sample;
        }
        let value = sample.value.clamp(range[0], range[1]);
        Sample { value, error: (value - range[0]).max(range[1] - value), ..sample }
    })
}

/// What the samples at the ends and the middle of a piece of a vector say.
pub(super) struct Piece {
    pub(super) found: Extremes,
    /// What it may hide beside them.
    pub(super) hidden: f64,
    /// The greatest error of them.
    pub(super) error: f64,
}

impl Piece {
    pub(super) fn of([a, middle, b]: &[Sample; 3], length: f64) -> Self {
        let samples = [a, middle, b];
        let width = b.t - a.t;
        // What the cubic through the ends misses at the middle, and what curvature can hide beside the three samples:
        // twice the bulge of a parabola with the observed change of slope over each half.
        let cubic = 0.5 * (a.value + b.value) + width / 8.0 * (a.slope - b.slope);
        let surprise = (middle.value - cubic).abs();
        let bend = (a.slope - middle.slope).abs().max((b.slope - middle.slope).abs());
        // Where the slope keeps its sign by more than it changes, the extremes are at the ends.
        let steepness = samples.map(|s| s.slope.abs()).into_iter().fold(f64::INFINITY, f64::min);
        let rises = samples.map(|s| s.slope > 0.0);
        let monotone = rises[0] == rises[1] && rises[1] == rises[2] && steepness > bend;
        let bulge = if monotone { 0.0 } else { 0.25 * bend * 0.5 * width };
        // No place is farther from a sample than a quarter of the piece.
        let hidden = (bulge + surprise).min(0.25 * length * width);
        let one = |s: &Sample| Extremes::within(s.error, s.value, s.value);
        let found = one(a).join(one(middle)).join(one(b));
        Self { found, hidden, error: a.error.max(middle.error).max(b.error) }
    }

    /// Its extremes where it may hide so many times as much.
    pub(super) fn hiding(&self, times: f64) -> Extremes {
        let hidden = times * self.hidden;
        Extremes { low: self.found.low - hidden, high: self.found.high + hidden, ..self.found }
    }
}
