//! How a clearance runs along a vector, from the places at which the proof of the vector has read it.

/// A clearance at a place of a vector.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Reading {
    /// Distance from the beginning of the vector.
    pub(crate) x: f64,
    pub(crate) value: f64,
    /// Change by that distance.
    pub(crate) slope: f64,
}

/// How many readings of a vector are kept: its ends, its extreme, and what is about a place where contact jumps.
pub(super) const MOST: usize = 5;

/// Readings of one vector in the order of their places, between which the clearance is taken to be the cubic through both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Readings {
    all: [Reading; MOST],
    count: usize,
}

impl Readings {
    /// Those at both ends of a vector.
    pub(crate) fn at_ends(from: Reading, to: Reading) -> Self {
        let mut all = [Reading::default(); MOST];
        (all[0], all[1]) = (from, to);
        Self { all, count: 2 }
    }

    /// Adds one between the ends, where none is yet. Where there is no room for it that one goes which those beside it tell best.
    pub(crate) fn add(&mut self, reading: Reading) {
        let at = self.known().partition_point(|known| known.x < reading.x);
        if at == 0 || self.known().get(at).is_none_or(|next| next.x <= reading.x) {
            return;
        }
        let mut more = [Reading::default(); MOST + 1];
        more[..at].copy_from_slice(&self.all[..at]);
        more[at] = reading;
        more[at + 1..=self.count].copy_from_slice(&self.all[at..self.count]);
        self.count += 1;
        if self.count > MOST {
            let misfit = |k: usize| {
                let beside = Piece { from: more[k - 1], to: more[k + 1] };
                (beside.at(more[k].x).value - more[k].value).abs()
            };
            let least = (1..MOST).min_by(|a, b| misfit(*a).total_cmp(&misfit(*b))).unwrap_or(1);
            more.copy_within(least + 1.., least);
            self.count = MOST;
        }
        self.all.copy_from_slice(&more[..MOST]);
    }

    /// The same with one more reading.
    pub(crate) fn with(mut self, reading: Reading) -> Self {
        self.add(reading);
        self
    }

    pub(crate) fn known(&self) -> &[Reading] {
        &self.all[..self.count]
    }

    /// Distance between the ends.
    pub(super) fn length(&self) -> f64 {
        self.all[self.count - 1].x
    }

    /// From reading to reading.
    pub(super) fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        self.known().windows(2).map(|pair| Piece { from: pair[0], to: pair[1] })
    }

    /// The clearance at a place, by the cubic there.
    pub(super) fn at(&self, x: f64) -> Reading {
        let next = self.known()[1..self.count - 1].partition_point(|known| known.x < x) + 1;
        Piece { from: self.all[next - 1], to: self.all[next] }.at(x)
    }
}

/// What is between two readings.
pub(crate) struct Piece {
    pub(crate) from: Reading,
    pub(crate) to: Reading,
}

impl Piece {
    /// The cubic through both readings.
    pub(crate) fn at(&self, x: f64) -> Reading {
        let Self { from, to } = self;
        let length = to.x - from.x;
        if length <= 0.0 {
            return *to;
        }
        let (s, rise) = ((x - from.x) / length, (to.value - from.value) / length);
        // How the slopes at both ends differ from that of the chord.
        let (before, after) = (from.slope - rise, to.slope - rise);
        let bow = s * (1.0 - s) * (before * (1.0 - s) - after * s) * length;
        let turn = before * (1.0 - s) * (1.0 - 3.0 * s) + after * s * (3.0 * s - 2.0);
        Reading { x, value: from.value + rise * (x - from.x) + bow, slope: rise + turn }
    }

    /// Second derivatives of the cubic at both ends.
    pub(super) fn bends(&self) -> [f64; 2] {
        let Self { from, to } = self;
        let length = to.x - from.x;
        let rise = (to.value - from.value) / length;
        [6.0 * rise - 4.0 * from.slope - 2.0 * to.slope, 2.0 * from.slope + 4.0 * to.slope - 6.0 * rise]
            .map(|turn| turn / length)
    }

    /// The square of the integral of √|κ| over it if κ, how the clearance bends, is steady.
    pub(super) fn turning(&self) -> f64 {
        (self.to.slope - self.from.slope).abs() * (self.to.x - self.from.x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x³ − 2x, of which the cubic is exact.
    fn read(x: f64) -> Reading {
        Reading { x, value: x * x * x - 2.0 * x, slope: 3.0 * x * x - 2.0 }
    }

    #[test]
    fn a_cubic_is_told_by_its_ends_and_by_any_readings() {
        let ends = Readings::at_ends(read(0.0), read(2.0));
        let more = ends.with(read(1.5)).with(read(0.25)).with(read(1.5)).with(read(2.0));
        assert_eq!((ends.pieces().count(), more.pieces().count()), (1, 3));
        for readings in [ends, more] {
            for k in 0..=40 {
                let (told, wanted) = (readings.at(0.05 * f64::from(k)), read(0.05 * f64::from(k)));
                assert!((told.value - wanted.value).abs() < 1e-12, "{told:?} {wanted:?}");
                assert!((told.slope - wanted.slope).abs() < 1e-12, "{told:?} {wanted:?}");
            }
        }
    }

    /// Of a clearance that jumps from one contact to another the readings next to that are kept.
    #[test]
    fn readings_are_kept_where_they_tell_most() {
        let kinked = |x: f64| {
            let slope = if x < 0.615 { 1.0 } else { -1.0 };
            Reading { x, value: -(x - 0.615).abs(), slope }
        };
        let mut readings = Readings::at_ends(kinked(0.0), kinked(1.0));
        (1..100).for_each(|k| readings.add(kinked(0.01 * f64::from(k))));
        assert_eq!(readings.pieces().count(), MOST - 1);
        assert!((readings.at(0.61).value + 0.005).abs() < 1e-12);
        assert!((readings.at(0.62).value + 0.005).abs() < 1e-12);
    }
}
