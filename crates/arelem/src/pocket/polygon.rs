//! Convex polygons in the plane of a pocket: insets, and what a tool of given radius covers of them.

use std::f64::consts::FRAC_1_SQRT_2;

/// A point or vector in the plane.
pub(super) type Vec2 = nalgebra::Vector2<f64>;

/// Round-off, relative to the size of the polygon: a side shorter than this is gone.
const ROUND_OFF: f64 = 1e-11;
/// Sine of an angle below which two sides count as parallel. Corners are never that blunt or sharp.
const PARALLEL: f64 = 1e-9;
/// Halvings when the greatest inset is searched: the result is then exact to round-off.
const HALVINGS: u32 = 60;

/// One side: the half plane `inward · x >= offset`, run along `along`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Side {
    along: Vec2,
    inward: Vec2,
    offset: f64,
}

impl Side {
    fn height(&self, point: &Vec2) -> f64 {
        self.inward.dot(point) - self.offset
    }

    /// Where the lines of two sides that are not parallel meet.
    fn meet(&self, other: &Self) -> Vec2 {
        let determinant = self.inward.perp(&other.inward);
        let x = self.offset * other.inward.y - other.offset * self.inward.y;
        let y = self.inward.x * other.offset - other.inward.x * self.offset;
        Vec2::new(x, y) / determinant
    }
}

/// A convex polygon, in the order of the statement's points.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Polygon {
    /// Side `k` begins at corner `k`.
    sides: Vec<Side>,
    corners: Vec<Vec2>,
}

impl Polygon {
    /// The corners must make a convex polygon; `turn` is +1 if it runs counterclockwise, else −1.
    pub(super) fn new(corners: Vec<Vec2>, turn: f64) -> Self {
        let next = corners.iter().cycle().skip(1);
        let side = |(from, to): (&Vec2, &Vec2)| {
            let along = (to - from).normalize();
            let inward = Vec2::new(-along.y, along.x) * turn;
            Side { along, inward, offset: inward.dot(from) }
        };
        Self { sides: corners.iter().zip(next).map(side).collect(), corners }
    }

    /// Unit directions of the sides.
    pub(super) fn directions(&self) -> impl Iterator<Item = (Vec2, Vec2)> {
        self.sides.iter().map(|side| (side.along, side.inward))
    }

    pub(super) fn count(&self) -> usize {
        self.sides.len()
    }

    /// From the first corner through all others to the first corner.
    pub(super) fn ring(&self) -> Vec<Vec2> {
        self.corners.iter().chain(self.corners.first()).copied().collect()
    }

    /// All sides moved inwards by the same distance; nothing if no area is left.
    pub(super) fn inset(&self, distance: f64) -> Option<Self> {
        self.inset_each(|_| distance)
    }

    /// Every side moved inwards by its own distance. Sides that get outside are left out; the first corner is the
    /// beginning of the first side that remains.
    pub(super) fn inset_each(&self, distance: impl Fn(usize) -> f64) -> Option<Self> {
        let move_side = |(k, side): (usize, &Side)| Side { offset: side.offset + distance(k), ..*side };
        let moved: Vec<Side> = self.sides.iter().enumerate().map(move_side).collect();
        let least = ROUND_OFF * self.size();
        let sides: Vec<Side> = moved.iter().filter(|side| length(side, &moved) > least).copied().collect();
        if sides.len() < 3 {
            return None;
        }
        let before = sides.iter().cycle().skip(sides.len() - 1);
        let corners: Vec<Vec2> = sides.iter().zip(before).map(|(side, before)| before.meet(side)).collect();
        corners.iter().flatten().all(|x| x.is_finite()).then_some(Self { sides, corners })
    }

    /// The greatest factor by which the distances can be multiplied so that something is left.
    pub(super) fn greatest(&self, distances: &[f64]) -> f64 {
        let factor = |factor: f64| self.inset_each(|k| distances.get(k).copied().unwrap_or(0.0) * factor);
        let smallest = distances.iter().copied().fold(f64::INFINITY, f64::min);
        let (mut fits, mut too_much) = (0.0, self.size() / smallest);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (fits + too_much);
            if factor(middle).is_some() { fits = middle } else { too_much = middle }
        }
        fits
    }

    /// Sine of half the sharpest interior angle.
    pub(super) fn sharpest(&self) -> f64 {
        let before = self.sides.iter().cycle().skip(self.sides.len() - 1);
        let sine = |(side, before): (&Side, &Side)| (1.0 + side.along.dot(&before.along)).max(0.0).sqrt();
        FRAC_1_SQRT_2 * self.sides.iter().zip(before).map(sine).fold(f64::INFINITY, f64::min)
    }

    /// Whether the whole polygon is within this distance of the line of one of its sides.
    pub(super) fn is_within(&self, width: f64) -> bool {
        self.sides.iter().any(|side| self.corners.iter().all(|corner| side.height(corner) <= width))
    }

    /// The first side from which every point of the polygon is within this distance: its ends, the one that is nearer
    /// to the first corner at last.
    pub(super) fn covering_side(&self, radius: f64) -> Option<[Vec2; 2]> {
        let next = self.corners.iter().cycle().skip(1);
        let mut ends = self.corners.iter().zip(next);
        let (from, to) =
            ends.find(|(from, to)| self.corners.iter().all(|corner| to_segment(corner, from, to) <= radius))?;
        let first = self.corners.first()?;
        let from_is_nearer = (from - first).norm() <= (to - first).norm();
        Some(if from_is_nearer { [*to, *from] } else { [*from, *to] })
    }

    /// Greatest distance of a corner from the first.
    pub(super) fn size(&self) -> f64 {
        let Some(first) = self.corners.first() else { return 0.0 };
        self.corners.iter().map(|corner| (corner - first).norm()).fold(0.0, f64::max)
    }
}

/// How much of the line of a side is inside all the half planes; negative or zero if nothing is.
fn length(side: &Side, all: &[Side]) -> f64 {
    let foot = side.inward * side.offset;
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for other in all {
        let slope = other.inward.dot(&side.along);
        let height = other.height(&foot);
        if slope > PARALLEL {
            from = from.max(-height / slope);
        } else if slope < -PARALLEL {
            to = to.min(-height / slope);
        } else if height < 0.0 && other.inward.dot(&side.inward) < 0.0 {
            return 0.0;
        }
    }
    to - from
}

fn to_segment(point: &Vec2, from: &Vec2, to: &Vec2) -> f64 {
    let run = to - from;
    let share = ((point - from).dot(&run) / run.norm_squared()).clamp(0.0, 1.0);
    (point - (from + run * share)).norm()
}
