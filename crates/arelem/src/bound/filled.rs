//! How many vectors a path fills. A clearance along the path is what it would be along a straight line, and how the path bends besides:
//! a vector may cover a stretch of the path only if a straight line is as near to that bend as the band is wide, for part and drive
//! surface both, and if the stretch is no longer than MAXDP. A stretch within one that a vector may cover is such a one, too. So no
//! sequence comes farther with any number of vectors than by the longest such stretches, one after the other.

use super::readings::{Piece, Readings};
use crate::role::Working;

/// Pieces into which what fills a vector is divided: a parabola's sag between them is then a hundredth of that over all.
const PIECES: f64 = 10.0;
/// Bound of the pieces between two readings.
const MOST_PIECES: f64 = 16.0;
/// How many points of a stretch are kept, of which more are not needed than those of its hull.
const MOST_POINTS: usize = 64;
/// Bound of the places that are looked at for where a vector is full, and the share of one by which it need not be found.
const MOST_LOOKS: u32 = 8;
const CLOSELY: f64 = 1e-3;
/// Ratio of bends up to which they are steady: the integral is then less than a hundredth from what points tell. Share of a vector that one
/// fills up to which it is straight.
const STEADY: f64 = 1.5;
const STRAIGHT: f64 = 1e-3;
/// Share of a vector up to which the slopes at the ends of a piece of it tell the bend, and its values too little of it.
const SHORT: f64 = 0.05;
/// Vectors of a stretch that are kept for the points they have: of more points are made.
const MOST_STEADILY: usize = 8;
/// Share of a vector by which one is more than full by rounding alone.
const ROUNDING: f64 = 1e-9;

/// A place along a stretch and how far the path is there from a straight line.
type Point = [f64; 2];

/// What a vector is to keep.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// The clearances at both limits of the band, for part and drive surface.
    bands: [[f64; 2]; 2],
    /// The way beside one vector, from its one end to the other.
    longest: f64,
}

impl Limits {
    /// Those of both roles, and MAXDP.
    pub(super) fn new(roles: [&Working; 2], maximum_step: f64) -> Self {
        // The way beside one vector, from its one end to the other within the bands, may be longer by that.
        let longest = maximum_step + 2.0 * (roles[0].band() + roles[1].band());
        Self { bands: roles.map(|role| [-role.inside, role.outside]), longest }
    }
}

/// What a path fills of vectors.
#[derive(Debug, Clone, Default)]
pub(super) struct Filled {
    /// Vectors that are full.
    vectors: f64,
    /// The way since then.
    length: f64,
    /// How part and drive surface bend since then.
    bent: [Strand; 2],
}

impl Filled {
    /// Adds a vector that keeps its bands. It fills no more than another one, whatever was before.
    pub(super) fn add(&mut self, readings: [&Readings; 2], limits: &Limits) {
        let length = readings[0].length();
        let mut full = (self.length + length > limits.longest).then_some(limits.longest - self.length);
        for (k, strand) in self.bent.iter_mut().enumerate() {
            if let Some(x) = strand.full(readings[k], limits.bands[k], full.unwrap_or(length)) {
                full = Some(x);
            }
        }
        let begin = full.map_or(0.0, |x| x.max(0.0));
        if full.is_some() {
            self.vectors += 1.0;
            self.length = 0.0;
            self.bent.iter_mut().for_each(Strand::begin);
        }
        self.length += length - begin;
        for (k, strand) in self.bent.iter_mut().enumerate() {
            strand.extend(readings[k], limits.bands[k], begin);
        }
    }

    /// All vectors, the last of which need not be full.
    pub(super) fn count(&self, limits: &Limits) -> f64 {
        let shares = [0, 1].map(|k: usize| self.bent[k].filled(limits.bands[k]));
        self.vectors + shares.into_iter().fold(self.length / limits.longest, f64::max)
    }
}

/// How one clearance bends along a stretch: steadily, or as points tell.
#[derive(Debug, Clone)]
struct Strand {
    /// What is filled while it bends steadily.
    steady: Option<Steady>,
    /// The vectors since it began while it does, and the place of each from which on.
    steadily: Vec<(Readings, f64)>,
    points: Vec<Point>,
    /// The last of them.
    end: Point,
    /// The slope there.
    slope: f64,
}

impl Default for Strand {
    fn default() -> Self {
        Self {
            steady: Some(Steady::default()),
            steadily: Vec::new(),
            points: Vec::new(),
            end: Point::default(),
            slope: 0.0,
        }
    }
}

impl Strand {
    /// Another stretch begins.
    fn begin(&mut self) {
        self.steady = Some(Steady::default());
        self.steadily.clear();
        self.points.clear();
        (self.end, self.slope) = (Point::default(), 0.0);
    }

    /// What is filled.
    fn filled(&self, band: [f64; 2]) -> f64 {
        self.steady.map_or_else(|| share(&self.points, band), |steady| steady.share)
    }

    /// The same with the next vector until a place of it.
    fn filled_until(&self, readings: &Readings, band: [f64; 2], x: f64) -> f64 {
        if let Some(with) = self.steady.and_then(|steady| steady.with(readings, band, [0.0, x])) {
            return with.share;
        }
        let mut points = self.points.clone();
        points.extend(self.ahead(readings, band, [0.0, x]));
        share(&points, band)
    }

    /// The place of the next vector before another one at which the stretch is full.
    fn full(&mut self, readings: &Readings, band: [f64; 2], until: f64) -> Option<f64> {
        let with = self.steady.and_then(|steady| steady.with(readings, band, [0.0, until]));
        let reached = with.map_or_else(
            || {
                self.settle(band);
                self.filled_until(readings, band, until)
            },
            |with| with.share,
        );
        let (mut low, mut high) = ([0.0, self.filled(band)], [until, reached]);
        if high[1] <= 1.0 + ROUNDING {
            return None;
        }
        for _ in 0..MOST_LOOKS {
            let part = ((1.0 - low[1]) / (high[1] - low[1])).clamp(0.0, 1.0);
            let x = low[0] + (high[0] - low[0]) * part;
            let found = [x, self.filled_until(readings, band, x)];
            if (found[1] - 1.0).abs() <= CLOSELY {
                return Some(x);
            }
            if found[1] > 1.0 {
                high = found;
            } else {
                low = found;
            }
        }
        Some(high[0])
    }

    /// Goes on along a vector from one of its places to its end.
    fn extend(&mut self, readings: &Readings, band: [f64; 2], begin: f64) {
        let is_room = self.steadily.len() < MOST_STEADILY;
        let length = readings.length();
        let with =
            self.steady.filter(|_| is_room).and_then(|steady| steady.with(readings, band, [begin, length]));
        if with.is_some() {
            self.steady = with;
            self.steadily.push((*readings, begin));
        } else {
            self.settle(band);
            self.follow(readings, band, begin);
        }
    }

    /// From here on points tell how it bends.
    fn settle(&mut self, band: [f64; 2]) {
        self.steady = None;
        for (readings, begin) in std::mem::take(&mut self.steadily) {
            self.follow(&readings, band, begin);
        }
    }

    /// What the bend is steeper than the clearance along a vector that begins here with a slope.
    fn tilt(&self, slope: f64) -> f64 {
        // At its beginning a stretch has the slope of its first vector: which line it is told from is all the same.
        if self.points.is_empty() { 0.0 } else { self.slope - slope }
    }

    /// Points along the next vector, between two of its places.
    fn ahead(&self, readings: &Readings, band: [f64; 2], [begin, end]: [f64; 2]) -> Vec<Point> {
        let start = readings.at(begin);
        let tilt = self.tilt(start.slope);
        // What is proven to be in the band is so, whatever a cubic says.
        let clamped = |value: f64| value.clamp(band[0], band[1]);
        let point = |x: f64| {
            let rise = clamped(readings.at(x).value) - clamped(start.value) + tilt * (x - begin);
            [self.end[0] + x - begin, self.end[1] + rise]
        };
        let mut points = Vec::with_capacity(MOST_POINTS);
        points.push(point(begin));
        for piece in readings.pieces().filter(|piece| piece.to.x > begin && piece.from.x < end) {
            let count = (PIECES * share_of(&piece, band)).ceil().clamp(1.0, MOST_PIECES);
            let (from, length) = (piece.from.x, piece.to.x - piece.from.x);
            let places = (1..=count as u32).map(|k| from + length * f64::from(k) / count);
            points.extend(places.filter(|x| *x > begin && *x < end).map(point));
            if piece.to.x >= end {
                break;
            }
        }
        points.push(point(end));
        points
    }

    /// Adds the points along a vector from one of its places to its end.
    fn follow(&mut self, readings: &Readings, band: [f64; 2], begin: f64) {
        let (start, end) = (readings.at(begin), readings.at(readings.length()));
        let points = self.ahead(readings, band, [begin, end.x]);
        self.slope = end.slope + self.tilt(start.slope);
        let known = usize::from(!self.points.is_empty());
        self.points.extend(&points[known..]);
        self.end = points[points.len() - 1];
        if self.points.len() > MOST_POINTS {
            let mut hull = [chain(&self.points, 1.0), chain(&self.points, -1.0)].concat();
            hull.sort_by(|a, b| a[0].total_cmp(&b[0]));
            hull.dedup();
            self.points = hull;
        }
    }
}

/// What is filled by a bend that changes little and is to one side: by the integral of √(κ/8τ), than which the points tell hardly more.
#[derive(Debug, Clone, Copy, Default)]
struct Steady {
    share: f64,
    /// The least and the greatest bend.
    bends: Option<[f64; 2]>,
}

impl Steady {
    /// The same with a vector between two of its places; `None` if it bends otherwise there.
    fn with(self, readings: &Readings, band: [f64; 2], [begin, end]: [f64; 2]) -> Option<Self> {
        let Self { mut share, bends } = self;
        let [mut least, mut greatest] = bends.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
        for piece in readings.pieces() {
            let (from, to) = (piece.from.x.max(begin), piece.to.x.min(end));
            if to <= from {
                continue;
            }
            let full = share_of(&piece, band);
            let whole = piece.to.x - piece.from.x;
            share += if to - from < whole { full * (to - from) / whole } else { full };
            let part = whole / readings.length();
            // What the whole vector would fill with the bend of this piece.
            let as_whole = full / part;
            let bends = match part {
                _ if as_whole <= STRAIGHT => [0.0; 2],
                _ if part <= SHORT => [(piece.to.slope - piece.from.slope) / whole; 2],
                _ => piece.bends(),
            };
            least = least.min(bends[0].min(bends[1]));
            greatest = greatest.max(bends[0].max(bends[1]));
        }
        let (small, great) = (least.abs().min(greatest.abs()), least.abs().max(greatest.abs()));
        let is_steady = least * greatest >= 0.0 && great <= STEADY * small;
        is_steady.then_some(Self { share, bends: Some([least, greatest]) })
    }
}

/// What a piece fills if its bend is steady.
fn share_of(piece: &Piece, [low, high]: [f64; 2]) -> f64 {
    // A band without width belongs to what does not bend, or no vector would have been proven.
    if high <= low { 0.0 } else { (piece.turning() / (8.0 * (high - low))).sqrt() }
}

/// What points fill of a vector, which covers all that some straight line is near to: by the square of its length on a parabola, so that this
/// is the integral of √(κ/8τ) there.
fn share(points: &[Point], [low, high]: [f64; 2]) -> f64 {
    if high <= low { 0.0 } else { (height(points) / (high - low)).sqrt() }
}

/// The greatest height of the hull of points in order of their places, which is twice what the nearest line is away from the farthest
/// of them.
fn height(points: &[Point]) -> f64 {
    if points.len() < 3 {
        return 0.0;
    }
    let [upper, lower] = [1.0, -1.0].map(|side| chain(points, side));
    apart(&upper, &lower).max(apart(&lower, &upper))
}

/// The upper or lower part of the hull.
fn chain(points: &[Point], side: f64) -> Vec<Point> {
    let mut hull: Vec<Point> = Vec::with_capacity(points.len());
    for point in points {
        while let [.., a, b] = hull[..]
            && side * ((b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])) >= 0.0
        {
            hull.pop();
        }
        hull.push(*point);
    }
    hull
}

/// How far the corners of one part of the hull are from the other part.
fn apart(corners: &[Point], other: &[Point]) -> f64 {
    let mut next = 1;
    let away = |corner: &Point| {
        while next + 1 < other.len() && other[next][0] < corner[0] {
            next += 1;
        }
        let (a, b) = (other[next - 1], other[next]);
        let along = if b[0] > a[0] { (corner[0] - a[0]) / (b[0] - a[0]) } else { 0.0 };
        (corner[1] - a[1] - along * (b[1] - a[1])).abs()
    };
    corners.iter().map(away).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::{super::readings::Reading, *};

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

    /// On a parabola a vector is √(8τ/κ) long, in whatever vectors it has been gone along.
    #[test]
    fn a_parabola_fills_its_integral() {
        let parabola = |x: f64| [0.5 * x * x, x];
        let full = (8.0 * BAND).sqrt();
        for vectors in [10, 13, 40, 97] {
            let found = count(&along(parabola, &places(vectors, 9.7 * full), &[0.5]), &LIMITS);
            assert!((found - 9.7).abs() < 0.06, "{vectors}: {found}");
        }
    }

    /// Of y = x³ between −a and a the line 3a²x/4 is a³/4 off: where the bend changes sides one vector covers what fills 1.63 by the integral.
    #[test]
    fn a_vector_that_bends_both_ways_covers_more_than_its_integral() {
        let cubic = |x: f64| [x * x * x, 3.0 * x * x];
        let longest = 2.0 * (2.0 * BAND).cbrt();
        for (share, whole) in [(0.99, 1.0), (1.05, 2.0)] {
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

    /// No vector is longer than MAXDP and what the bands are wide, straight ones least of all.
    #[test]
    fn straight_vectors_fill_their_length() {
        let limits = Limits { longest: 2.0, ..LIMITS };
        assert!((count(&[straight(0.7); 10], &limits) - 3.5).abs() < 1e-9);
        assert_eq!(count(&[straight(0.7); 10], &LIMITS), 0.0);
    }

    /// Each vector keeps both bands, so that there cannot be a need for more than there are.
    #[test]
    fn no_more_vectors_are_filled_than_there_are() {
        let reading = |k: usize, at: usize| {
            let share = |m: usize| (k * m % 101) as f64 / 100.0;
            let value = LIMITS.bands[0][0] + BAND * share(37 + at);
            Reading { x: 0.1 * at as f64, value, slope: share(61 + at) - 0.5 }
        };
        let mut filled = Filled::default();
        for k in 0..200 {
            let [part, drive] = [k, k + 7].map(|k| {
                Readings::at_ends(reading(k, 0), reading(k, 3)).with(reading(k, 1)).with(reading(k, 2))
            });
            filled.add([&part, &drive], &LIMITS);
            assert!(filled.count(&LIMITS) <= (k + 1) as f64 + 1e-9);
        }
    }

    #[test]
    fn the_height_of_a_hull_is_that_of_its_highest_place() {
        assert_eq!(height(&[[0.0, 0.0], [1.0, 5.0]]), 0.0);
        assert_eq!(height(&[[0.0, 0.0], [1.0, 2.0], [2.0, 0.0]]), 2.0);
        assert_eq!(height(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]]), 0.0);
        // A corner below and one above, at different places.
        assert!((height(&[[0.0, 0.0], [1.0, -1.0], [3.0, 1.0], [4.0, 0.0]]) - 4.0 / 3.0).abs() < 1e-12);
    }
}
