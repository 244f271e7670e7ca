//! How far a vector may reach that begins on the vector before, foretold without a try. Both clearances beside the last two vectors tell how
//! high each surface is over a line: cubics join what is known there. The bands about these heights are two corridors over the same line, and
//! a vector is a straight line in either. The lines from a beginning that stay within a corridor up to a place make a cone of slopes (the
//! longest chord in a corridor, after Imai and Iri); where there is none left in either, the longest vector from there ends, at the limit
//! that has closed the cone.
//!
//! What is foretold decides what is tried, never what is true. Where it does not come true more places are read, and it is asked again.

use apt_geometry::Vec3;

use super::{SPARED, Trial};
use crate::{
    bound::{Piece, Reading},
    clearance::Shape,
    directed::march::Vertex,
    position::correction_of_two,
    role::{Bend, Working},
};

/// How many times as far as the latest vector it is looked.
const FARTHEST: f64 = 3.0;
/// Places at which the corridors are looked at beside the vector before, and from there on. Between them a corridor is taken to be straight,
/// which on a bend that fills the band of a vector is wrong by a few thousandths of it.
const BACKWARD: usize = 24;
const ONWARD: usize = 72;
/// Beginnings that are looked at; they are the closer together, the nearer to the vertex: most windows are short.
const BEGINNINGS: u32 = 16;
/// Share of the latest vector by which a beginning farther back is to reach farther: the vector before shall not be shortened for less.
const LEAST_FARTHER: f64 = 1e-3;
/// The least distance of two places that are known, as a share of the latest vector: of two nearer to each other the newer one counts, as what
/// they differ by aside of the line would be a bend.
const APART: f64 = 0.02;
/// Share of the latest vector beyond a beginning from where on a place is ahead of it.
const AHEAD: f64 = 1e-9;
/// The least length, as a share of the latest vector, of the stretch whose cubic is continued beyond the last place.
const TELLING: f64 = 0.25;
/// How far beyond the last place, as a share of the latest vector, its cubic tells enough, and how far onward the next one is read.
const UNKNOWN: f64 = 0.1;
const NEXT: f64 = 0.5;
/// How far the places beside one that counts are apart at most, as such a share.
const CLOSE: f64 = 0.12;
/// Share of the band by which what is read differs from what was known to be new.
const NEW: f64 = 0.02;
/// Misfit, as a share of the way between the limits of the band, by which one of them must fit a line better than the usual one does.
const MISFIT: f64 = 1e-3;
/// Share of a foretold length that is tried: about what is foretold wrongly, for too long a vector is a try in vain.
const SURELY: f64 = 0.998;
/// Steps of a foretold length, as a share of the latest vector: what is foretold rests on slopes, and their rounding shall not be seen in paths.
const STEP: f64 = 1.0 / 1024.0;

/// What is foretold of the longest vector from a beginning.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foretold {
    /// Where it begins, as a share of the way back to the vertex before.
    pub(super) share: f64,
    /// How far it reaches, from the vertex in the direction of the latest vector.
    pub(super) reach: f64,
    pub(super) length: f64,
    /// The bends that tell at which limits it ends.
    pub(super) bends: [Bend; 2],
    /// Second derivatives of the clearances along it, on average.
    pub(super) curvature: [f64; 2],
    /// The length of its way along the line.
    run: f64,
    /// Where it touches the corridor that closes on it.
    touches: Option<f64>,
}

/// The corridors of part and drive surface beside the last two vectors.
pub(super) struct Corridor {
    /// The vertex between the vectors, from where places along the line are counted.
    origin: Vec3,
    /// Direction of the line, that of the latest vector.
    along: Vec3,
    /// From the vertex to the one before.
    back: Vec3,
    /// Length of the latest vector, and the longest that there may be.
    latest: f64,
    cap: f64,
    lanes: [Lane; 2],
    places: Vec<f64>,
}

/// The corridor of one surface.
struct Lane {
    /// Direction in which its height is measured: the gradient at the vertex.
    normal: Vec3,
    /// How high it is over the line, in the order of places.
    known: Vec<Reading>,
    /// The clearances between which a vector stays, and those at which it ends.
    room: [f64; 2],
    ends: [f64; 2],
    usual: Bend,
    /// Whether a vector may end at either limit.
    turns: bool,
    /// Whether it confines vectors at all: a clearance that is linear and kept at the ends does not.
    confines: bool,
    /// The heights at all places, once they are asked for.
    heights: Vec<f64>,
    /// The least length of the stretch whose cubic is continued.
    telling: f64,
}

impl Lane {
    fn new(role: &Working, normal: Vec3, usual: Bend, telling: f64) -> Self {
        let spared = SPARED * role.band();
        Self {
            normal,
            known: Vec::new(),
            room: [spared - role.inside, role.outside - spared],
            ends: [role.vertex(Bend::Concave), role.vertex(Bend::Convex)],
            usual,
            turns: role.shape == Shape::General && usual != Bend::Straight,
            confines: role.shape != Shape::Flat,
            heights: Vec::new(),
            telling,
        }
    }

    /// Adds what is known at a place; what was known as near by gives way.
    fn add(&mut self, reading: Reading, apart: f64) {
        self.known.retain(|known| (known.x - reading.x).abs() >= apart);
        let at = self.known.partition_point(|known| known.x < reading.x);
        self.known.insert(at, reading);
        self.heights.clear();
    }

    /// The height at a place and its slope, by the cubic there.
    fn at(&self, x: f64) -> Reading {
        let [first, .., last] = self.known.as_slice() else {
            return self.known.first().copied().unwrap_or_default();
        };
        if x >= last.x {
            let from = self.known.iter().rev().find(|known| known.x <= last.x - self.telling);
            return Piece { from: *from.unwrap_or(first), to: *last }.at(x);
        }
        let next = self.known[1..].partition_point(|known| known.x < x) + 1;
        Piece { from: self.known[next - 1], to: self.known[next] }.at(x)
    }

    /// Where to read before the height at a place counts, if cubics tell it roughly: onward, or half way between what is known beside it.
    fn unknown_before(&self, x: f64, latest: f64) -> Option<f64> {
        let next = self.known.partition_point(|known| known.x < x);
        let before = self.known[next.checked_sub(1)?].x;
        match self.known.get(next) {
            None => (x > before + UNKNOWN * latest).then_some(x.min(before + NEXT * latest)),
            Some(next) => (next.x > before + CLOSE * latest).then_some(0.5 * (before + next.x)),
        }
    }
}

/// Lines that begin in a corridor: where, and between which slopes they stay in it as far as has been seen.
struct Cone<'a> {
    lane: &'a Lane,
    start: Reading,
    y: f64,
    room: [f64; 2],
    slopes: [f64; 2],
    /// Where the line of either slope touches the corridor.
    touches: [f64; 2],
}

/// How a cone is closed.
#[derive(Clone, Copy)]
struct Closed {
    x: f64,
    /// The slope of the last line in it.
    slope: f64,
    /// The bend that tells at which limit, and where the line touches the other one.
    bend: Bend,
    touches: f64,
}

impl<'a> Cone<'a> {
    fn new(lane: &'a Lane, x: f64, y: f64) -> Self {
        let start = lane.at(x);
        // What has been shown to be in the band may begin a vector.
        let [low, high] = lane.room;
        let room = [low.min(y - start.value), high.max(y - start.value)];
        let slopes = [f64::NEG_INFINITY, f64::INFINITY];
        Self { lane, start: Reading { x, ..start }, y, room, slopes, touches: [x; 2] }
    }

    /// The slope of the line to a height.
    fn slope(&self, x: f64, y: f64) -> f64 {
        (y - self.y) / (x - self.start.x)
    }

    /// Where the cone is closed between two places, the heights of which are told, if no line in it ends in the band at the second one.
    fn closed(&self, before: (f64, f64), next: (f64, f64)) -> Option<Closed> {
        let ([lower, upper], [low, high]) = (self.lane.ends, self.slopes);
        let (slope, end, bend, touches) = if self.slope(next.0, next.1 + upper) < low {
            (low, upper, Bend::Convex, self.touches[0])
        } else if self.slope(next.0, next.1 + lower) > high {
            (high, lower, Bend::Concave, self.touches[1])
        } else {
            return None;
        };
        // How far the limit is from the line.
        let [from, to] = [before, next].map(|(x, height)| height + end - self.y - slope * (x - self.start.x));
        let share = if from == to { 0.0 } else { (from / (from - to)).clamp(0.0, 1.0) };
        Some(Closed { x: before.0 + (next.0 - before.0) * share, slope, bend, touches })
    }

    /// Goes on past a place.
    fn narrow(&mut self, x: f64, height: f64) {
        let [low, high] = self.room.map(|limit| self.slope(x, height + limit));
        if low > self.slopes[0] {
            (self.slopes[0], self.touches[0]) = (low, x);
        }
        if high < self.slopes[1] {
            (self.slopes[1], self.touches[1]) = (high, x);
        }
    }

    /// The slope of a vector that ends at a place where the cone is open, with the bend that tells at which limit: the usual one if that does.
    fn open(&self, x: f64, height: f64) -> (f64, Bend) {
        let [lower, upper] = self.lane.ends.map(|end| self.slope(x, height + end));
        let (usual, other) = match self.lane.usual {
            Bend::Convex => ((upper, Bend::Convex), (lower, Bend::Concave)),
            Bend::Concave => ((lower, Bend::Concave), (upper, Bend::Convex)),
            Bend::Straight => return (0.5 * (lower + upper), Bend::Straight),
        };
        let [low, high] = self.slopes;
        let off = |slope: f64| (low - slope).max(slope - high).max(0.0);
        let is_better = off(other.0) + MISFIT * (upper - lower) < off(usual.0);
        if self.lane.turns && is_better { other } else { usual }
    }

    /// Second derivative of the clearance, on average, along a vector to a place.
    fn curvature(&self, x: f64, height: f64) -> f64 {
        let Reading { x: from, value, slope } = self.start;
        -2.0 * (height - value - slope * (x - from)) / (x - from).powi(2)
    }
}

impl Foretold {
    /// The same of a vector that is sure to be no longer than foretold, and that reaches no farther than this.
    pub(super) fn within(self, most: f64, latest: f64) -> Self {
        let step = STEP * latest;
        let run = (self.run - (self.reach - most).max(0.0)) * SURELY;
        let run = (run / step).floor() * step;
        Self { reach: self.reach - self.run + run, run, length: self.length * run / self.run, ..self }
    }
}

impl Corridor {
    /// Those beside the vector between two vertices and the latest one, from the second. None where the path doubles back at that.
    pub(super) fn beside(
        (before, here): (&Vertex, &Vertex),
        latest: &Trial,
        roles: [&Working; 2],
        cap: f64,
    ) -> Option<Self> {
        let end = &latest.vertex;
        let along = (end.tip - here.tip).try_normalize(0.0)?;
        let back = before.tip - here.tip;
        if back.dot(&along) >= 0.0 {
            return None;
        }
        let gradients = [here.part.gradient, here.drive.gradient];
        let lane = |k: usize| Lane::new(roles[k], gradients[k], latest.bends[k], TELLING * latest.length);
        let places = places(back.dot(&along), latest.length);
        let lanes = [lane(0), lane(1)];
        let mut corridor = Self { origin: here.tip, along, back, latest: latest.length, cap, lanes, places };
        for vertex in [before, here, end] {
            corridor.note(vertex);
        }
        Some(corridor)
    }

    /// Adds what is known at a vertex; whether that is other than was known.
    pub(super) fn note(&mut self, vertex: &Vertex) -> bool {
        let way = vertex.tip - self.origin;
        let (x, along) = (way.dot(&self.along), self.along);
        let mut is_new = false;
        for (lane, contact) in self.lanes.iter_mut().zip([&vertex.part, &vertex.drive]) {
            let value = lane.normal.dot(&way) - contact.clearance;
            let off = (value - lane.at(x).value).abs();
            is_new |= lane.confines && off > NEW * (lane.room[1] - lane.room[0]);
            let slope = (lane.normal - contact.gradient).dot(&along);
            lane.add(Reading { x, value, slope }, APART * self.latest);
        }
        is_new
    }

    /// What is foretold of the longest vector from the beginning from which one reaches farthest, and of those as far from the nearest.
    pub(super) fn best(&mut self) -> Foretold {
        let share = |k: f64| (k / f64::from(BEGINNINGS)).powi(2);
        let least = LEAST_FARTHER * self.latest;
        let mut best = self.from(share(1.0));
        let all: Vec<Foretold> = (1..BEGINNINGS).map(|k| self.from(share(f64::from(k)))).collect();
        let farthest = all.iter().map(|foretold| foretold.reach).fold(f64::NEG_INFINITY, f64::max);
        let mut nearest = 1.0;
        if let Some(found) = all.iter().position(|foretold| foretold.reach >= farthest - least) {
            (best, nearest) = (all[found], found as f64 + 1.0);
        }
        for beside in [-0.5, 0.5] {
            let foretold = self.from(share(nearest + beside));
            if foretold.reach > best.reach + least {
                best = foretold;
            }
        }
        best
    }

    /// What is foretold of the longest vector from a share of the way back.
    pub(super) fn from(&mut self, share: f64) -> Foretold {
        self.measure();
        let way = self.back * share;
        let x = way.dot(&self.along);
        let mut cones = self.lanes.each_ref().map(|lane| Cone::new(lane, x, lane.normal.dot(&way)));
        let (reach, closed) = self.visible(&mut cones, x);
        let run = reach - x;
        let mut foretold = Foretold {
            share,
            reach,
            length: run,
            bends: self.lanes.each_ref().map(|lane| lane.usual),
            curvature: [0.0; 2],
            run,
            touches: closed.map(|(_, closed)| closed.touches),
        };
        if run <= 0.0 {
            return foretold;
        }
        let mut square = 1.0;
        for (k, cone) in cones.iter().enumerate() {
            let height = cone.lane.at(reach).value;
            let (slope, bend) = match closed {
                Some((by, closed)) if by == k => (closed.slope, closed.bend),
                _ => cone.open(reach, height),
            };
            if cone.lane.turns {
                foretold.bends[k] = bend;
            }
            if cone.lane.confines {
                foretold.curvature[k] = cone.curvature(reach, height);
            }
            square += slope * slope;
        }
        foretold.length = run * square.sqrt();
        foretold
    }

    /// How far lines lead that begin at a place, and which of the cones is closed there.
    fn visible(&self, cones: &mut [Cone<'_>; 2], x: f64) -> (f64, Option<(usize, Closed)>) {
        let mut before = (x, cones.each_ref().map(|cone| cone.start.value));
        let limit = x + self.cap;
        let first = self.places.partition_point(|place| *place <= x + AHEAD * self.latest);
        for k in first..self.places.len() {
            let place = self.places[k];
            let height = |lane: &Lane| lane.heights.get(k).copied().unwrap_or_default();
            let heights = self.lanes.each_ref().map(height);
            let of_cone = |by: usize| {
                let closed = cones[by].closed((before.0, before.1[by]), (place, heights[by]))?;
                Some((by, closed))
            };
            let closed = (0..2).filter(|by| self.lanes[*by].confines).filter_map(of_cone);
            if let Some((by, closed)) = closed.min_by(|a, b| a.1.x.total_cmp(&b.1.x)) {
                return if closed.x < limit { (closed.x, Some((by, closed))) } else { (limit, None) };
            }
            if place >= limit {
                return (limit, None);
            }
            for (cone, height) in cones.iter_mut().zip(heights).filter(|(cone, _)| cone.lane.confines) {
                cone.narrow(place, height);
            }
            before = (place, heights);
        }
        (before.0, None)
    }

    /// The heights at all places, from what is known by now.
    fn measure(&mut self) {
        for lane in self.lanes.iter_mut().filter(|lane| lane.confines && lane.heights.is_empty()) {
            lane.heights = self.places.iter().map(|x| lane.at(*x).value).collect();
        }
    }

    /// Where to read before what is foretold is tried: about where it ends and where it touches a corridor.
    pub(super) fn unknown(&self, foretold: &Foretold) -> Option<f64> {
        [Some(foretold.reach), foretold.touches].into_iter().flatten().find_map(|x| {
            let mut confining = self.lanes.iter().filter(|lane| lane.confines);
            confining.find_map(|lane| lane.unknown_before(x, self.latest))
        })
    }

    /// Whether a place is beyond all that has been read.
    pub(super) fn is_beyond(&self, reach: f64) -> bool {
        let ends = |lane: &Lane| lane.known.last().is_some_and(|last| last.x < reach);
        self.lanes.iter().any(|lane| lane.confines && ends(lane))
    }

    /// A place about the middle of the bands, as far along the line.
    pub(super) fn place(&self, reach: f64) -> Vec3 {
        let way = self.along * reach;
        let off =
            |lane: &Lane| lane.normal.dot(&way) - lane.at(reach).value - 0.5 * (lane.ends[0] + lane.ends[1]);
        let [part, drive] = &self.lanes;
        self.origin + way + correction_of_two([off(part), off(drive)], [part.normal, drive.normal])
    }
}

/// The places at which corridors are looked at, from one behind the vertex.
fn places(first: f64, latest: f64) -> Vec<f64> {
    let between = |from: f64, to: f64, count: usize| {
        (0..count).map(move |k| from + (to - from) * k as f64 / count as f64)
    };
    between(first, 0.0, BACKWARD).chain(between(0.0, FARTHEST * latest, ONWARD + 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BAND: f64 = 1e-3;

    /// The corridor about a curve, told as height and slope, with a vertex before that is on a level in the band as the vertex is.
    fn about(curve: &dyn Fn(f64) -> [f64; 2], before: f64, latest: f64, level: f64) -> Corridor {
        let read = |x: f64| Reading { x, value: curve(x)[0], slope: curve(x)[1] };
        let lane = |confines: bool, known: Vec<Reading>| Lane {
            normal: if confines { Vec3::y() } else { Vec3::z() },
            known,
            room: [0.0, BAND],
            ends: [0.0, BAND],
            usual: if confines { Bend::Convex } else { Bend::Straight },
            turns: confines,
            confines,
            heights: Vec::new(),
            telling: TELLING * latest,
        };
        let step = 0.02 * latest;
        let count = ((FARTHEST * latest + before) / step).ceil() as usize;
        let known = (0..=count).map(|k| read(step * k as f64 - before)).collect();
        let start = curve(0.0)[0] + level;
        Corridor {
            origin: Vec3::new(0.0, start, 0.0),
            along: Vec3::x(),
            back: Vec3::new(-before, curve(-before)[0] + level - start, 0.0),
            latest,
            cap: f64::INFINITY,
            lanes: [lane(true, known), lane(false, Vec::new())],
            places: places(-before, latest),
        }
        .raised(start)
    }

    impl Corridor {
        /// With heights counted from the vertex.
        fn raised(mut self, by: f64) -> Self {
            for reading in &mut self.lanes[0].known {
                reading.value -= by;
            }
            self
        }
    }

    /// From a clearance c over a parabola of the curvature κ a line touches it at √(2c/κ), and is as high again as the band is wide at √(2τ/κ)
    /// beyond that.
    #[test]
    fn over_a_parabola_the_reach_is_what_its_formula_tells() {
        let bend = 0.3;
        let full = (8.0 * BAND / bend).sqrt();
        let curve = |x: f64| [-0.5 * bend * x * x, -bend * x];
        let mut corridor = about(&curve, full, full, BAND);
        for share in [0.02, 0.1, 0.3, 0.8, 1.0] {
            let foretold = corridor.from(share);
            let x = -share * full;
            // The vertex before and this one are at the upper limit, between them the clearance is less.
            let clearance = BAND - 0.5 * bend * (-x) * (full + x);
            let wanted = x + (2.0 * clearance.max(0.0) / bend).sqrt() + 0.5 * full;
            assert!((foretold.reach - wanted).abs() < 5e-3 * full, "{share}: {foretold:?}, not {wanted}");
            assert_eq!(foretold.bends, [Bend::Convex, Bend::Straight]);
            assert!((foretold.curvature[0] - bend).abs() < 1e-6, "{foretold:?}");
        }
        // No beginning is better than the vertex before, which sees the vertex.
        assert!(corridor.best().reach <= full * (1.0 + 5e-3));
    }

    /// How far the best of many lines from a beginning leads.
    fn farthest(curve: &dyn Fn(f64) -> [f64; 2], (x, y): (f64, f64), latest: f64) -> f64 {
        let steep = 20.0 * BAND / latest;
        let leads = |slope: f64| {
            let is_in = |at: f64| {
                let clearance = y + slope * (at - x) - curve(at)[0];
                (-1e-9..=BAND + 1e-9).contains(&clearance)
            };
            let step = latest / 500.0;
            (1..)
                .map(|k| x + step * f64::from(k))
                .take_while(|at| *at < FARTHEST * latest && is_in(*at))
                .last()
        };
        (-2000..=2000).filter_map(|k| leads(steep * f64::from(k) / 2000.0)).fold(x, f64::max)
    }

    #[test]
    fn the_line_reaches_as_far_as_the_best_of_many() {
        for (k, level) in [0.0, 0.2, 0.5, 1.0].into_iter().cycle().take(24).enumerate() {
            // Waves that begin to bend the other way somewhere about the vertex.
            let (phase, length) = (0.4 * k as f64, 3.0 + 0.3 * (k % 7) as f64);
            let wave = |x: f64| {
                let angle = length * x + phase;
                [2.0 * BAND * angle.sin(), 2.0 * BAND * length * angle.cos()]
            };
            let mut corridor = about(&wave, 0.3, 0.5, level * BAND);
            for share in [0.05, 0.2, 0.6] {
                let way = corridor.back * share;
                let height = |x: f64| [wave(x)[0] - corridor.origin.y, wave(x)[1]];
                let clearance = way.y - height(way.x)[0];
                if !(0.0..=BAND).contains(&clearance) {
                    continue;
                }
                let wanted = farthest(&height, (way.x, way.y), 0.5);
                let found = corridor.from(share).reach;
                assert!(
                    (found - wanted).abs() < 0.02 * (wanted - way.x),
                    "{k}, {share}: {found}, not {wanted}"
                );
            }
        }
    }
}
