//! The place of a surface nearest to a point, by subdivision with proof.
//!
//! A cell's control points hold it; so no place of it is nearer than the least of their distances along any direction from
//! the point. Cells are halved, the most promising first, until none can hold a nearer place than the best one found.

use std::{cmp::Ordering, collections::BinaryHeap};

use super::{
    patch::Patch,
    surface::SculpturedSurface,
    topology::{Edge, PROBES, SAME_EDGE},
};
use crate::Vec3;

/// What a place may be farther than the nearest one, as a share of the size of surface and distance.
const GAP: f64 = 1e-12;
/// The same where many places are equally near and the cells run out.
const LOOSE_GAP: f64 = 1e-3;
/// Bound of the cells of one search.
const MOST_CELLS: usize = 20_000;
/// Bound of the steps that polish a place.
const MOST_STEPS: usize = 40;
/// Step of the parameters that ends the polish.
const SETTLED: f64 = 1e-15;

/// A place of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePlace {
    /// The place.
    pub position: Vec3,
    /// Index of the patch.
    pub patch: usize,
    /// Local parameters there.
    pub local: [f64; 2],
}

/// A part of a patch: its control net and parameters.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    pub(super) index: usize,
    pub(super) patch: Patch,
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
    /// No place is better than this.
    pub(super) bound: f64,
}

impl Cell {
    pub(super) fn whole(index: usize, patch: &Patch) -> Cell {
        Cell { index, patch: *patch, low: [0.0; 2], high: [1.0; 2], bound: 0.0 }
    }

    pub(super) fn middle(&self) -> [f64; 2] {
        [0, 1].map(|side| 0.5 * (self.low[side] + self.high[side]))
    }

    /// Both halves of the direction in which the control net is longer.
    pub(super) fn halves(&self) -> [Cell; 2] {
        let points = self.patch.points();
        let along = |a: &Vec3, b: &Vec3| (b - a).norm();
        let u = (0..4).map(|j| along(&points[0][j], &points[3][j]).max(along(&points[0][j], &points[1][j])));
        let v = (0..4).map(|i| along(&points[i][0], &points[i][3]).max(along(&points[i][0], &points[i][1])));
        let side = usize::from(v.fold(0.0, f64::max) > u.fold(0.0, f64::max));
        let parts = if side == 0 { self.patch.halved_u() } else { self.patch.halved_v() };
        let middle = self.middle()[side];
        let [mut before, mut after] = parts.map(|patch| Cell { patch, ..self.clone() });
        before.high[side] = middle;
        after.low[side] = middle;
        [before, after]
    }
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Cell {
    /// The least bound is the greatest cell; ties go by place, so that searches are the same on every machine.
    fn cmp(&self, other: &Self) -> Ordering {
        other
            .bound
            .total_cmp(&self.bound)
            .then(other.index.cmp(&self.index))
            .then(other.low[0].total_cmp(&self.low[0]))
            .then(other.low[1].total_cmp(&self.low[1]))
    }
}

/// How near a place can be in the box of some points.
pub(super) fn box_distance(points: &[[Vec3; 4]; 4], point: &Vec3) -> f64 {
    let mut low = points[0][0];
    let mut high = low;
    for place in points.iter().flatten() {
        (low, high) = (low.inf(place), high.sup(place));
    }
    (low - point).sup(&(point - high)).sup(&Vec3::zeros()).norm()
}

impl SculpturedSurface {
    /// The place nearest to a point. Where several are equally near one of them is taken, always the same.
    ///
    /// # Errors
    /// How far the best place found may be from the least distance, where the search ran out of cells.
    pub fn nearest(&self, point: &Vec3) -> Result<SurfacePlace, f64> {
        let mut best: Option<(f64, SurfacePlace)> = None;
        let mut heap = BinaryHeap::new();
        for (index, patch) in self.patches.iter().enumerate() {
            let mut cell = Cell::whole(index, patch);
            cell.bound = box_distance(&patch.points(), point);
            heap.push(cell);
        }
        let scale = self.size() + heap.peek().map_or(0.0, |cell| cell.bound);
        let mut seen = 0;
        while let Some(cell) = heap.pop() {
            let reached = best.as_ref().map_or(f64::INFINITY, |found| found.0);
            if cell.bound >= reached - GAP * scale {
                break;
            }
            seen += 1;
            if seen > MOST_CELLS {
                let left = reached - cell.bound;
                if left > LOOSE_GAP * scale {
                    return Err(left);
                }
                break;
            }
            let found = self.polished(cell.index, cell.middle(), point);
            let distance = (found.position - point).norm();
            if distance < reached {
                best = Some((distance, found));
            }
            let Some((reached, place)) = &best else { continue };
            for mut half in cell.halves() {
                let points = half.patch.points();
                half.bound =
                    cell.bound.max(box_distance(&points, point)).max(along(&points, point, &place.position));
                // The direction to the cell itself separates what the one to the best place does not.
                half.bound = half.bound.max(along(&points, point, &half.patch.evaluate(0.5, 0.5).position));
                if half.bound < reached - GAP * scale {
                    heap.push(half);
                }
            }
        }
        best.map(|found| found.1).ok_or(f64::INFINITY)
    }

    /// Whether no place is nearer to a point than a distance; not where the search ran out of cells.
    pub(super) fn keeps_off(&self, point: &Vec3, distance: f64) -> bool {
        let mut open: Vec<Cell> =
            self.patches.iter().enumerate().map(|(index, patch)| Cell::whole(index, patch)).collect();
        let mut seen = 0;
        while let Some(cell) = open.pop() {
            let points = cell.patch.points();
            let middle = cell.patch.evaluate(0.5, 0.5).position;
            if box_distance(&points, point).max(along(&points, point, &middle)) >= distance {
                continue;
            }
            seen += 1;
            if (middle - point).norm() < distance || seen > MOST_CELLS {
                return false;
            }
            open.extend(cell.halves());
        }
        true
    }

    /// Whether an edge of one of two surfaces comes to the other one, as near as edges are the same.
    pub fn touches(&self, other: &SculpturedSurface) -> bool {
        let close = SAME_EDGE * self.size().max(other.size());
        let ([low, high], [least, greatest]) = (self.bounds(), other.bounds());
        if (0..3).any(|k| low[k] > greatest[k] + close || high[k] < least[k] - close) {
            return false;
        }
        let comes_to = |one: &SculpturedSurface, another: &SculpturedSurface| {
            one.patches.iter().any(|patch| {
                Edge::ALL.iter().any(|edge| {
                    let arc = patch.edge(*edge);
                    PROBES.iter().any(|t| !another.keeps_off(&arc.evaluate(*t).position, close))
                })
            })
        };
        comes_to(self, other) || comes_to(other, self)
    }

    /// The nearest place that steps from a start in a patch lead to, not leaving it.
    fn polished(&self, index: usize, start: [f64; 2], point: &Vec3) -> SurfacePlace {
        let Some(patch) = self.patches.get(index) else {
            return SurfacePlace { position: Vec3::zeros(), patch: index, local: start };
        };
        let mut local = start;
        let mut at = patch.evaluate(local[0], local[1]);
        for _ in 0..MOST_STEPS {
            let away = at.position - point;
            let slope = [at.du.dot(&away), at.dv.dot(&away)];
            let first = [at.du.norm_squared(), at.du.dot(&at.dv), at.dv.norm_squared()];
            let second = [at.duu.dot(&away), at.duv.dot(&away), at.dvv.dot(&away)];
            // A parameter at its end that wants to go on stays there.
            let free = [0, 1].map(|side| {
                let (low, high) = (local[side] <= 0.0, local[side] >= 1.0);
                !(low && slope[side] >= 0.0 || high && slope[side] <= 0.0)
            });
            let full: [f64; 3] = std::array::from_fn(|index| first[index] + second[index]);
            let way = step(&full, &slope, free).or_else(|| step(&first, &slope, free));
            let Some(way) = way else { break };
            let mut share = 1.0;
            let mut moved = false;
            // Ten halvings: shorter steps change nothing.
            for _ in 0..10 {
                let next: [f64; 2] =
                    std::array::from_fn(|side| (local[side] + way[side] * share).clamp(0.0, 1.0));
                let there = patch.evaluate(next[0], next[1]);
                if (there.position - point).norm_squared() < away.norm_squared() {
                    (local, at, moved) = (next, there, true);
                    break;
                }
                share *= 0.5;
            }
            if !moved || way.iter().all(|by| by.abs() <= SETTLED) {
                break;
            }
        }
        SurfacePlace { position: at.position, patch: index, local }
    }
}

/// The step against a slope with a positive definite form `[a, b; b, c]`, of the free parameters only.
fn step(form: &[f64; 3], slope: &[f64; 2], free: [bool; 2]) -> Option<[f64; 2]> {
    let [a, b, c] = *form;
    match free {
        [false, false] => None,
        [true, false] => (a > 0.0).then(|| [-slope[0] / a, 0.0]),
        [false, true] => (c > 0.0).then(|| [0.0, -slope[1] / c]),
        [true, true] => {
            let determinant = a * c - b * b;
            (a > 0.0 && c > 0.0 && determinant > f64::EPSILON * a * c).then(|| {
                [(b * slope[1] - c * slope[0]) / determinant, (b * slope[0] - a * slope[1]) / determinant]
            })
        }
    }
}

/// How near a place can be among points, by their distance along the direction from `point` to `towards`.
fn along(points: &[[Vec3; 4]; 4], point: &Vec3, towards: &Vec3) -> f64 {
    let Some(direction) = (towards - point).try_normalize(f64::MIN_POSITIVE) else { return 0.0 };
    points.iter().flatten().map(|place| direction.dot(&(place - point))).fold(f64::INFINITY, f64::min)
}
