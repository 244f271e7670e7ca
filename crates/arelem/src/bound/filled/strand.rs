//! How one clearance bends along a stretch that a vector may cover, and where a vector may begin it.
//!
//! The longest line of a stretch touches one limit of the band, then the other one, and leaves the band at the first again: beyond its second
//! contact all places that its number of vectors leads to are on its side of that. So a vector that leads on beyond its end crosses it between
//! that contact and the end, the window, and comes out on the other side: extended backward it is within the limit of the second contact all along
//! the window. Those places bound the next line, too, on that side alone. (Such windows tell the least number of pieces of a line that keeps
//! within a tolerance of a curve: H. Imai, M. Iri, Computer Vision, Graphics, and Image Processing 36, 1986.) The first line goes through the place
//! where the motion begins.

use super::{
    super::readings::Readings,
    hull::{Point, Widest, chain, lengthen, widest, widest_from},
    room,
    steady::{Steady, Turns, share_of},
};

/// Pieces into which what fills a vector is divided: a parabola's sag between them is then a hundredth of that over all.
const PIECES: f64 = 10.0;
/// Bound of the pieces between two readings.
const MOST_PIECES: f64 = 16.0;
/// How many points of a stretch are kept, of which more are not needed than those of its hull.
const MOST_POINTS: usize = 64;
/// Bound of the places that are looked at for where a vector is full, and the share of one by which it need not be found.
const MOST_LOOKS: u32 = 8;
const CLOSELY: f64 = 1e-3;
/// Vectors of a stretch that are kept for the points they have: of more points are made.
const MOST_STEADILY: usize = 8;
/// Share of a vector by which one is more than full by rounding alone.
const ROUNDING: f64 = 1e-9;

/// Upper and lower part of the hull of the points of a stretch.
type Hull = [Vec<Point>; 2];

/// What bounds a line where the stretch before it ended.
#[derive(Debug, Clone)]
struct Window {
    /// On which side of the points the line is: 1 for those that it is to be below, −1 for those above.
    side: f64,
    /// The points, in order of their places before the stretch.
    points: Vec<Point>,
}

/// A window that is not told yet: it hinders no line that bends on to the same side, so that most are never asked for their points.
#[derive(Debug, Clone)]
struct Untold {
    side: f64,
    /// The vectors of the stretch before, with the place of each from which on, and the place of the next one at which that was full.
    before: Vec<(Readings, f64)>,
    next: Readings,
    full: f64,
}

/// How one clearance bends along a stretch: steadily, or as points tell.
#[derive(Debug, Clone)]
pub(super) struct Strand {
    /// What is filled while it bends steadily.
    steady: Option<Steady>,
    /// The vectors since it began while it does, and the place of each from which on.
    steadily: Vec<(Readings, f64)>,
    points: Vec<Point>,
    /// The last of them.
    end: Point,
    /// The slope there.
    slope: f64,
    window: Option<Window>,
    untold: Option<Untold>,
    /// How far from the lower and the upper limit the first line begins, while that is not full.
    start: Option<[f64; 2]>,
}

impl Strand {
    /// From where a motion begins.
    pub(super) fn from_start(readings: &Readings, [low, high]: [f64; 2]) -> Self {
        let value = readings.at(0.0).value;
        let start = (high > low).then(|| {
            let value = value.clamp(low, high);
            [value - low, high - value]
        });
        Self { steady: start.is_none().then(Steady::default), start, ..Self::anywhere() }
    }

    /// From anywhere in the band.
    fn anywhere() -> Self {
        Self {
            steady: Some(Steady::default()),
            steadily: Vec::new(),
            points: Vec::new(),
            end: Point::default(),
            slope: 0.0,
            window: None,
            untold: None,
            start: None,
        }
    }

    /// Another stretch begins, anywhere in the band.
    pub(super) fn begin(&mut self) {
        self.steady = Some(Steady::default());
        self.steadily.clear();
        self.points.clear();
        (self.end, self.slope) = (Point::default(), 0.0);
        (self.window, self.untold, self.start) = (None, None, None);
    }

    /// Another stretch begins where this one is full, at a place of the next vector.
    pub(super) fn begin_beyond(&mut self, along: &Turns<'_>, band: [f64; 2], x: f64) {
        if let Some(side) = self.steady_with(along, [0.0, x]).and_then(|with| with.side()) {
            // What is told no more leaves its room to the next one.
            let room = self.untold.take().map(|untold| untold.before).unwrap_or_default();
            let before = std::mem::replace(&mut self.steadily, room);
            self.begin();
            self.untold = Some(Untold { side, before, next: *along.readings, full: x });
            return;
        }
        self.settle(band);
        let window = self.window_at(along.readings, band, x);
        self.begin();
        self.window = window;
    }

    /// The window where this stretch is full.
    fn window_at(&self, readings: &Readings, band: [f64; 2], x: f64) -> Option<Window> {
        let ahead = self.ahead(readings, band, [0.0, x]);
        let full = *ahead.last()?;
        let (room, [upper, lower]) = (room(band)?, with_points(&self.hull(), &ahead));
        let Widest { height, corner, side, across } = self.widest(&upper, &lower)?;
        if across[0] < full[0] {
            return None;
        }
        // The line is not quite that which is full: it may be nearer to the limit by that.
        let whole = if self.start.is_some() { 1.0 } else { room };
        let less = ((1.0 - height / whole).max(0.0) + 2.0 * CLOSELY) * room;
        let tilt = self.tilt(readings.at(0.0).slope);
        let as_seen_beyond = |point: &Point| {
            let back = point[0] - full[0];
            [back, point[1] - full[1] - tilt * back - side * less]
        };
        let known = if side > 0.0 { &upper } else { &lower };
        let within = known.iter().filter(|point| point[0] >= corner[0] && point[0] < full[0]);
        Some(Window { side, points: within.map(as_seen_beyond).collect() })
    }

    /// Upper and lower part of the hull of its points, with those of the window.
    fn hull(&self) -> Hull {
        let part = |side: f64| {
            let window = self.window.iter().filter(|window| window.side == side);
            chain(window.flat_map(|window| &window.points).chain(&self.points), side)
        };
        [part(1.0), part(-1.0)]
    }

    /// Where a line is hindered most.
    fn widest(&self, upper: &[Point], lower: &[Point]) -> Option<Widest> {
        match self.start {
            Some(rooms) => widest_from(upper, lower, rooms),
            None => widest(upper, lower),
        }
    }

    /// What so many points fill of a vector, which covers all that some straight line is near to: by the square of its length on a parabola, so that
    /// this is the integral of √(κ/8τ) there.
    fn share(&self, [upper, lower]: &Hull, count: usize, band: [f64; 2]) -> f64 {
        let Some(room) = room(band).filter(|_| count > 2) else { return 0.0 };
        let whole = if self.start.is_some() { 1.0 } else { room };
        self.widest(upper, lower).map_or(0.0, |widest| (widest.height.max(0.0) / whole).sqrt())
    }

    /// What is filled.
    pub(super) fn filled(&self, band: [f64; 2]) -> f64 {
        self.steady.map_or_else(|| self.share(&self.hull(), self.points.len(), band), |steady| steady.share)
    }

    /// What is filled while it bends steadily and no window hinders it.
    fn steady_with(&self, along: &Turns<'_>, between: [f64; 2]) -> Option<Steady> {
        let with = self.steady?.with(along, between)?;
        let told = self.window.as_ref().map(|window| window.side);
        let side = told.or_else(|| self.untold.as_ref().map(|untold| untold.side));
        side.is_none_or(|side| with.agrees(side)).then_some(with)
    }

    /// What is filled with the next vector until a place of it, as points tell.
    fn filled_until(&self, hull: &Hull, along: &Turns<'_>, band: [f64; 2], x: f64) -> f64 {
        let ahead = self.ahead(along.readings, band, [0.0, x]);
        self.share(&with_points(hull, &ahead), self.points.len() + ahead.len(), band)
    }

    /// The place of the next vector before another one at which the stretch is full.
    pub(super) fn full(&mut self, along: &Turns<'_>, band: [f64; 2], until: f64) -> Option<f64> {
        if let Some(with) = self.steady_with(along, [0.0, until]) {
            let filled = [self.steady.map_or(0.0, |steady| steady.share), with.share];
            // A part of what bends steadily does so, too.
            let filled_until =
                |x: f64| self.steady_with(along, [0.0, x]).map_or(with.share, |with| with.share);
            return full_between(filled, until, filled_until);
        }
        self.settle(band);
        let hull = self.hull();
        let filled = self.share(&hull, self.points.len(), band);
        let reached = self.filled_until(&hull, along, band, until);
        full_between([filled, reached], until, |x| self.filled_until(&hull, along, band, x))
    }

    /// Goes on along a vector from one of its places to its end.
    pub(super) fn extend(&mut self, along: &Turns<'_>, band: [f64; 2], begin: f64) {
        let is_room = self.steadily.len() < MOST_STEADILY;
        let length = along.readings.length();
        let with = self.steady_with(along, [begin, length]).filter(|_| is_room);
        if with.is_some() {
            self.steady = with;
            self.steadily.push((*along.readings, begin));
        } else {
            self.settle(band);
            self.follow(along.readings, band, begin);
        }
    }

    /// From here on points tell how it bends, and the window.
    fn settle(&mut self, band: [f64; 2]) {
        self.steady = None;
        if let Some(Untold { before, next, full, .. }) = self.untold.take() {
            let mut stretch = Self { steadily: before, ..Self::anywhere() };
            stretch.settle(band);
            self.window = stretch.window_at(&next, band, full);
        }
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

/// The place before another one at which a stretch is full, of which it is known what is filled before the vector and until there.
fn full_between([before, reached]: [f64; 2], until: f64, filled_until: impl Fn(f64) -> f64) -> Option<f64> {
    let (mut low, mut high) = ([0.0, before], [until, reached]);
    if high[1] <= 1.0 + ROUNDING {
        return None;
    }
    for _ in 0..MOST_LOOKS {
        let part = ((1.0 - low[1]) / (high[1] - low[1])).clamp(0.0, 1.0);
        let x = low[0] + (high[0] - low[0]) * part;
        let found = [x, filled_until(x)];
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

/// A hull with the points ahead of it.
fn with_points([upper, lower]: &Hull, ahead: &[Point]) -> Hull {
    let part = |known: &Vec<Point>, side: f64| {
        let mut part = Vec::with_capacity(known.len() + ahead.len());
        part.extend_from_slice(known);
        lengthen(&mut part, ahead, side);
        part
    };
    [part(upper, 1.0), part(lower, -1.0)]
}
