//! What is told to be needed beside what dynamic programming finds: places along a path, and clearances of both roles across their bands, between
//! which the fewest vectors are looked for.

use super::{super::readings::Reading, *};
use crate::tests::random::Random;

/// Places along a path, and across each band.
const ALONG: usize = 300;
const ACROSS: usize = 9;
/// Curves that are tried.
const CURVES: u32 = 64;
/// Length of a path, on which waves of length 1 to 20 have a height of up to three bands.
const LENGTH: f64 = 30.0;
/// Width of the bands.
const BAND: f64 = 0.01;
/// Share of the vectors found that are told to be needed at least, over all curves.
const TOLD: f64 = 0.85;
/// Waves that are added up.
const WAVES: usize = 3;

/// How one clearance bends along a path, as rates, beginnings and heights of waves, and its band.
struct Bend {
    waves: [[f64; 3]; WAVES],
    band: [f64; 2],
    at: Vec<f64>,
}

impl Bend {
    fn random(random: &mut Random, height: f64) -> Self {
        let mut wave = || [random.between(0.3, 1.2), random.between(0.0, 6.3), random.between(0.0, height)];
        let waves = [wave(), wave(), wave()];
        let below = random.between(0.0, 1.0);
        let mut bend = Self { waves, band: [-below * BAND, (1.0 - below) * BAND], at: Vec::new() };
        bend.at = (0..=ALONG).map(|i| bend.curve(x(i))[0]).collect();
        bend
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
        low + (high - low) * j as f64 / (ACROSS - 1) as f64
    }

    /// For each place after one the clearances there to which a line leads from one of this role, in its band at all places between.
    fn reached(&self, [i, j]: [usize; 2]) -> Vec<[bool; ACROSS]> {
        let [low, high] = self.band;
        let (from, mut slopes) = (self.value(j) - self.at[i], [f64::NEG_INFINITY, f64::INFINITY]);
        let mut found = Vec::new();
        for k in i + 1..=ALONG {
            let slope = |value: f64| (value - self.at[k] - from) / (x(k) - x(i));
            let mut seen = [false; ACROSS];
            for (j, seen) in seen.iter_mut().enumerate() {
                *seen = (slopes[0]..=slopes[1]).contains(&slope(self.value(j)));
            }
            found.push(seen);
            slopes = [slopes[0].max(slope(low)), slopes[1].min(slope(high))];
            if slopes[0] > slopes[1] {
                break;
            }
        }
        found
    }

    /// A vector as its proof reads it: at its ends and at shares of it.
    fn readings(&self, [from, to]: [[usize; 2]; 2]) -> Readings {
        let (begin, length) = (x(from[0]), x(to[0]) - x(from[0]));
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

fn x(i: usize) -> f64 {
    LENGTH * i as f64 / ALONG as f64
}

/// A place along the path and clearances of part and drive surface.
type Place = [usize; 3];

/// All places to which a vector leads from one.
fn reached(bends: &[Bend; 2], [i, part, drive]: Place) -> Vec<Place> {
    let [parts, drives] = [bends[0].reached([i, part]), bends[1].reached([i, drive])];
    let mut found = Vec::new();
    for (ahead, (parts, drives)) in parts.iter().zip(&drives).enumerate() {
        for part in (0..ACROSS).filter(|j| parts[*j]) {
            found.extend((0..ACROSS).filter(|j| drives[*j]).map(|drive| [i + 1 + ahead, part, drive]));
        }
    }
    found
}

/// A sequence of the fewest vectors from a place to any at the end.
fn fewest(bends: &[Bend; 2], start: Place) -> Vec<Place> {
    let mut before = vec![[[None; ACROSS]; ACROSS]; ALONG + 1];
    let mut layer = vec![start];
    while !layer.iter().any(|[i, ..]| *i == ALONG) {
        let mut next = Vec::new();
        for from in &layer {
            for [i, part, drive] in reached(bends, *from) {
                let known = &mut before[i][part][drive];
                if known.is_none() {
                    *known = Some(*from);
                    next.push([i, part, drive]);
                }
            }
        }
        layer = next;
    }
    let mut at = layer.into_iter().find(|[i, ..]| *i == ALONG).expect("the end");
    let mut path = vec![at];
    while at[0] > 0 {
        at = before[at[0]][at[1]][at[2]].expect("a place before");
        path.push(at);
    }
    path.reverse();
    path
}

/// A sequence of vectors that lead anywhere, more of them than are needed.
fn wandering(bends: &[Bend; 2], start: Place, random: &mut Random) -> Vec<Place> {
    let mut path = vec![start];
    while let Some(at) = path.last().filter(|[i, ..]| *i < ALONG) {
        let ahead = reached(bends, *at);
        path.push(random.pick(&ahead));
    }
    path
}

/// How many vectors are told to be needed at least, as read along a sequence.
fn least(bends: &[Bend; 2], path: &[Place]) -> f64 {
    let limits = Limits { bands: [bends[0].band, bends[1].band], longest: f64::INFINITY };
    let mut filled = Filled::default();
    for pair in path.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let [part, drive] =
            [0, 1].map(|k: usize| bends[k].readings([[from[0], from[k + 1]], [to[0], to[k + 1]]]));
        filled.add([&part, &drive], &limits);
    }
    filled.least(0.0).expect("an end")
}

/// No sequence has fewer vectors than are told to be needed, wherever it begins, however both roles bend and along whatever sequence it is read;
/// and not many more are needed.
#[test]
fn dynamic_programming_finds_no_sequence_of_fewer_vectors() {
    let levels: Vec<usize> = (0..ACROSS).collect();
    let (mut needed, mut told, mut read_elsewhere) = (0.0, 0.0, 0.0);
    for seed in 0..CURVES {
        let mut random = Random(u64::from(seed) + 1);
        // In each fourth case the drive surface is flat.
        let height = if seed.is_multiple_of(4) { 0.0 } else { 3.0 };
        let bends = [Bend::random(&mut random, 3.0), Bend::random(&mut random, height)];
        let start = [0, random.pick(&levels), random.pick(&levels)];
        let path = fewest(&bends, start);
        let (count, along) = ((path.len() - 1) as f64, least(&bends, &path));
        assert!(along <= count, "{seed}: {along} told, {count} found");
        let elsewhere = least(&bends, &wandering(&bends, start, &mut random));
        assert!(elsewhere <= count, "{seed}: {elsewhere} told elsewhere, {count} found");
        (needed, told, read_elsewhere) = (needed + count, told + along, read_elsewhere + elsewhere);
    }
    println!("{told} of {needed} told, {read_elsewhere} read elsewhere");
    assert!(told >= TOLD * needed && read_elsewhere >= TOLD * needed, "{told}, {read_elsewhere} of {needed}");
}
