//! Where two paths that have parted come together again: so that as little as can be of both is left out, and for long enough.

use rstar::{AABB, PointDistance, RTree, RTreeObject};

use apt_geometry::Vec3;

use super::{
    Tolerance,
    path::{Manner, Path, Point},
    together::{Run, together},
};

/// How many tolerances long paths must go together to count as together again: those that only cross at more than twelve degrees do so for less.
const LONG_ENOUGH: f64 = 10.0;
/// The first look ahead, in tolerances.
const FIRST_LOOK: f64 = 16.0;

/// A vector of a path in the tree of all of them.
pub(super) struct Chord {
    pub(super) vector: usize,
    pub(super) ends: [Vec3; 2],
}

impl Chord {
    /// The fraction at which the chord is nearest to a place.
    pub(super) fn nearest(&self, place: &Vec3) -> f64 {
        let along = self.ends[1] - self.ends[0];
        let square = along.norm_squared();
        if square == 0.0 { 0.0 } else { ((place - self.ends[0]).dot(&along) / square).clamp(0.0, 1.0) }
    }

    /// Its distance from a place.
    pub(super) fn distance(&self, place: &Vec3) -> f64 {
        let [from, to] = self.ends;
        (from + (to - from) * self.nearest(place) - place).norm()
    }
}

impl RTreeObject for Chord {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(self.ends[0].into(), self.ends[1].into())
    }
}

impl PointDistance for Chord {
    fn distance_2(&self, point: &[f64; 3]) -> f64 {
        self.distance(&Vec3::from(*point)).powi(2)
    }
}

/// Two paths, ready to be looked at for where they come together.
pub(super) struct Rejoining<'a> {
    paths: [&'a Path; 2],
    tolerance: Tolerance,
    chords: [RTree<Chord>; 2],
}

/// Points on both paths that are near each other, and how much of the paths is left out before them.
struct Candidate {
    left_out: f64,
    points: [Point; 2],
}

impl<'a> Rejoining<'a> {
    pub(super) fn new(paths: [&'a Path; 2], tolerance: Tolerance) -> Self {
        let chords = |path: &Path| {
            let chord = |vector: usize| Chord {
                vector,
                ends: [path.places[vector].position, path.places[vector + 1].position],
            };
            let moving = (0..path.vectors()).filter(|vector| path.manner(*vector) != Manner::Jump);
            RTree::bulk_load(moving.map(chord).collect())
        };
        Self { paths, tolerance, chords: paths.map(chords) }
    }

    /// The points at which the paths come together again after they have parted, and how far they then go. The outer `None` is for who has given up.
    pub(super) fn after(
        &self,
        parted: [Point; 2],
        cancel: &dyn Fn() -> bool,
    ) -> Option<Option<([Point; 2], Run)>> {
        let [a, b] = self.paths;
        let left = a.length() - a.along(parted[0]) + b.length() - b.along(parted[1]);
        let mut looked = f64::NEG_INFINITY;
        let mut look = FIRST_LOOK * self.tolerance.distance;
        while looked < left {
            for candidate in self.candidates(parted, [looked, look]) {
                if cancel() {
                    return None;
                }
                let run = together(self.paths, candidate.points, self.tolerance, cancel)?;
                if self.is_long_enough(candidate.points, &run) {
                    return Some(Some((candidate.points, run)));
                }
            }
            (looked, look) = (look, look * 2.0);
        }
        Some(None)
    }

    /// What is near each other, with so much left out before it, the least first.
    fn candidates(&self, parted: [Point; 2], [more_than, at_most]: [f64; 2]) -> Vec<Candidate> {
        let mut found = Vec::new();
        for side in [0, 1] {
            let (own, other) = (self.paths[side], self.paths[1 - side]);
            let first = parted[side].vector + usize::from(parted[side].fraction > 0.0);
            for index in first..own.places.len() {
                let point = own.place(index);
                let left_out = own.along(point) - own.along(parted[side]);
                if left_out > at_most {
                    break;
                }
                let place = own.places[index].position;
                let reach = self.tolerance.distance.powi(2);
                for chord in self.chords[1 - side].locate_within_distance(place.into(), reach) {
                    let across = Point { vector: chord.vector, fraction: chord.nearest(&place) };
                    let left_out = left_out + other.along(across) - other.along(parted[1 - side]);
                    if across >= parted[1 - side] && left_out > more_than && left_out <= at_most {
                        let points = if side == 0 { [point, across] } else { [across, point] };
                        found.push(Candidate { left_out, points });
                    }
                }
            }
        }
        let order = |one: &Candidate| (one.points[0].vector, one.points[1].vector);
        found.sort_by(|a, b| a.left_out.total_cmp(&b.left_out).then_with(|| order(a).cmp(&order(b))));
        found
    }

    fn is_long_enough(&self, from: [Point; 2], run: &Run) -> bool {
        let least = if run.is_complete { 0.0 } else { LONG_ENOUGH * self.tolerance.distance };
        let is_long = |side: usize| {
            let path = self.paths[side];
            path.along(run.ends[side]) - path.along(from[side]) > least
        };
        is_long(0) && is_long(1)
    }
}
