//! What is told to be needed beside what dynamic programming finds: places along a path, and clearances of both roles across their bands, between
//! which the fewest vectors are looked for.

use std::ops::RangeInclusive;

use super::{super::readings::Reading, *};
use crate::tests::random::Random;

/// Length of a path, on which waves of length 1 to 20 bend the clearances.
const LENGTH: f64 = 30.0;
/// Width of the bands.
const BAND: f64 = 0.01;
/// Waves that are added up.
const WAVES: usize = 3;

/// How one clearance bends along a path, as rates, beginnings and heights of waves, and its band.
struct Bend {
    waves: [[f64; 3]; WAVES],
    band: [f64; 2],
    /// The bend at each place along the path.
    at: Vec<f64>,
    /// Places across the band.
    across: usize,
}

impl Bend {
    /// Waves of up to so many bands, looked at in so many places along the path and across the band.
    fn random(random: &mut Random, height: f64, [along, across]: [usize; 2]) -> Self {
        let mut wave = || [random.between(0.3, 1.2), random.between(0.0, 6.3), random.between(0.0, height)];
        let waves = [wave(), wave(), wave()];
        let below = random.between(0.0, 1.0);
        let mut bend =
            Self { waves, band: [-below * BAND, (1.0 - below) * BAND], at: vec![0.0; along + 1], across };
        bend.at = (0..=along).map(|i| bend.curve(bend.x(i))[0]).collect();
        bend
    }

    /// Places along the path, but for its beginning.
    fn along(&self) -> usize {
        self.at.len() - 1
    }

    fn x(&self, i: usize) -> f64 {
        LENGTH * i as f64 / self.along() as f64
    }

    /// The bend at a place, and its slope.
    fn curve(&self, x: f64) -> [f64; 2] {
        let wave = |[rate, begin, height]: [f64; 3]| {
            let (s, c) = (rate * x + begin).sin_cos();
            [height * BAND * s, height * rate * BAND * c]
        };
        self.waves.map(wave).into_iter().fold([0.0; 2], |sum, wave| [sum[0] + wave[0], sum[1] + wave[1]])
    }

    fn value(&self, j: usize) -> f64 {
        let [low, high] = self.band;
        low + (high - low) * j as f64 / (self.across - 1) as f64
    }

    /// For each place after one the first and the last of the clearances there to which a line leads from one of this role, in its band at all places
    /// between; the first one is greater where there is none.
    fn reached(&self, [i, j]: [usize; 2]) -> Vec<RangeInclusive<usize>> {
        let ([low, high], x) = (self.band, self.x(i));
        let (from, mut slopes) = (self.value(j) - self.at[i], [f64::NEG_INFINITY, f64::INFINITY]);
        let mut found = Vec::new();
        for k in i + 1..=self.along() {
            let slope = |value: f64| (value - self.at[k] - from) / (self.x(k) - x);
            let is_seen = |j: &usize| (slopes[0]..=slopes[1]).contains(&slope(self.value(*j)));
            let first = (0..self.across).find(is_seen);
            let last = first.and_then(|first| (first..self.across).rev().find(is_seen));
            found.push(first.unwrap_or(1)..=last.unwrap_or(0));
            slopes = [slopes[0].max(slope(low)), slopes[1].min(slope(high))];
            if slopes[0] > slopes[1] {
                break;
            }
        }
        found
    }

    /// A vector as its proof reads it: at its ends and at shares of it.
    fn readings(&self, [from, to]: [[usize; 2]; 2]) -> Readings {
        let (begin, length) = (self.x(from[0]), self.x(to[0]) - self.x(from[0]));
        let rise = self.value(to[1]) - self.at[to[0]] - self.value(from[1]) + self.at[from[0]];
        let read = |along: f64| {
            let [bend, slope] = self.curve(begin + along);
            let value = self.value(from[1]) - self.at[from[0]] + rise * along / length + bend;
            Reading { x: along, value, slope: slope + rise / length }
        };
        let ends = Readings::at_ends(read(0.0), read(length));
        [0.25, 0.5, 0.75].iter().fold(ends, |known, share| known.with(read(share * length)))
    }
}

/// A place along the path and clearances of part and drive surface.
type Place = [usize; 3];

/// All places to which a vector leads from one.
fn reached(bends: &[Bend; 2], [i, part, drive]: Place) -> impl Iterator<Item = Place> {
    let [parts, drives] = [bends[0].reached([i, part]), bends[1].reached([i, drive])];
    parts.into_iter().zip(drives).enumerate().flat_map(move |(ahead, (parts, drives))| {
        parts.flat_map(move |part| drives.clone().map(move |drive| [i + 1 + ahead, part, drive]))
    })
}

/// A sequence of the fewest vectors from a place to any at the end.
fn fewest(bends: &[Bend; 2], start: Place) -> Vec<Place> {
    let (end, across) = (bends[0].along(), bends[1].across);
    let at = |[i, part, drive]: Place| (i * bends[0].across + part) * across + drive;
    let mut before = vec![None; at([end + 1, 0, 0])];
    let mut layer = vec![start];
    while !layer.iter().any(|[i, ..]| *i == end) {
        let mut next = Vec::new();
        for from in &layer {
            for to in reached(bends, *from) {
                let known = &mut before[at(to)];
                if known.is_none() {
                    *known = Some(*from);
                    next.push(to);
                }
            }
        }
        layer = next;
    }
    let mut path = vec![layer.into_iter().find(|[i, ..]| *i == end).expect("the end")];
    while let Some(last) = path.last().filter(|[i, ..]| *i > 0) {
        path.push(before[at(*last)].expect("a place before"));
    }
    path.reverse();
    path
}

/// A sequence of vectors that lead anywhere, more of them than are needed.
fn wandering(bends: &[Bend; 2], start: Place, random: &mut Random) -> Vec<Place> {
    let mut path = vec![start];
    while let Some(at) = path.last().filter(|[i, ..]| *i < bends[0].along()) {
        let ahead: Vec<Place> = reached(bends, *at).collect();
        path.push(random.pick(&ahead));
    }
    path
}

/// How many vectors are told to be needed at least, as read along a sequence.
fn least(bends: &[Bend; 2], path: &[Place]) -> f64 {
    let bands = [0, 1].map(|k: usize| widened(bends[k].band, WIDER));
    let limits = Limits { bands, longest: f64::INFINITY };
    let mut filled = Filled::default();
    for pair in path.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let [part, drive] =
            [0, 1].map(|k: usize| bends[k].readings([[from[0], from[k + 1]], [to[0], to[k + 1]]]));
        filled.add([&part, &drive], &limits);
    }
    filled.least(0.0).expect("an end")
}

/// Beside what is told along random curves what dynamic programming finds: no fewer vectors than are told to be needed, along whatever sequence that is
/// read, and of all that it finds at least this share is told.
fn is_told_of_all(told: f64, curves: u32, draw: impl Fn(u32, &mut Random) -> [Bend; 2]) {
    let (mut needed, mut along, mut elsewhere) = (0.0, 0.0, 0.0);
    for seed in 0..curves {
        let mut random = Random(u64::from(seed) + 1);
        let bends = draw(seed, &mut random);
        let [part, drive] = [0, 1].map(|k: usize| (0..bends[k].across).collect::<Vec<_>>());
        let start = [0, random.pick(&part), random.pick(&drive)];
        let path = fewest(&bends, start);
        let found = (path.len() - 1) as f64;
        let read = [least(&bends, &path), least(&bends, &wandering(&bends, start, &mut random))];
        assert!(read.iter().all(|least| *least <= found), "{seed}: {read:?} told, {found} found");
        (needed, along, elsewhere) = (needed + found, along + read[0], elsewhere + read[1]);
    }
    println!("{along} of {needed} told, {elsewhere} read elsewhere");
    assert!(along >= told * needed && elsewhere >= told * needed, "{along}, {elsewhere} of {needed}");
}

/// No sequence has fewer vectors than are told to be needed, wherever it begins, however both roles bend and along whatever sequence it is read;
/// and not many more are needed.
#[test]
fn dynamic_programming_finds_no_sequence_of_fewer_vectors() {
    is_told_of_all(0.9, 64, |seed, random| {
        // In each fourth case the drive surface is flat.
        let height = if seed.is_multiple_of(4) { 0.0 } else { 3.0 };
        [3.0, height].map(|height| Bend::random(random, height, [300, 9]))
    });
}

/// Nor has one beside a plane, on which places are looked at more densely.
#[test]
fn dynamic_programming_finds_hardly_more_vectors_beside_a_plane() {
    is_told_of_all(0.98, 6, |_, random| {
        [(30.0, 33), (0.0, 2)].map(|(height, across)| Bend::random(random, height, [1500, across]))
    });
}
