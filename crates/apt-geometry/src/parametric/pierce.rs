//! Where a line meets a surface, and a plane a curve.

use std::collections::BinaryHeap;

use nalgebra::{Matrix2, Vector2};

use super::{
    arc::CurveArc,
    curve::SpaceCurve,
    nearest::{Cell, SurfacePlace, box_distance},
    surface::SculpturedSurface,
};
use crate::{Vec3, canonical::Plane};

/// Distance from the line, as a share of the size of the surface, of a place that is on it.
const ON_LINE: f64 = 1e-12;
/// How far outside of a cell, in shares of it, a place may be that steps from it lead to.
const BEYOND: f64 = 1e-6;
/// Side of a cell in parameters that is not halved any more.
const SMALLEST: f64 = 1e-9;
/// Bound of the cells of one search.
const MOST_CELLS: usize = 20_000;
/// Bound of the steps towards a place.
const MOST_STEPS: usize = 30;
/// Halvings of an arc of a curve.
const MOST_HALVINGS: u32 = 52;
/// Places of an arc that lies in the plane from which the nearest one is sought.
const PLACES_IN_PLANE: usize = 64;

/// Two unit vectors across a direction.
struct Across {
    point: Vec3,
    axes: [Vec3; 2],
}

impl SculpturedSurface {
    /// The place where a line through `point` meets the surface; of several the one nearest to `near`.
    ///
    /// # Errors
    /// The least distance found between the line and the surface, if they do not meet.
    pub fn pierced(&self, point: &Vec3, direction: &Vec3, near: &Vec3) -> Result<SurfacePlace, f64> {
        let way = direction.try_normalize(f64::MIN_POSITIVE).ok_or(f64::INFINITY)?;
        let helper = if way.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
        let first = way.cross(&helper).normalize();
        let across = Across { point: *point, axes: [first, way.cross(&first)] };
        let size = self.size();
        let mut heap = BinaryHeap::new();
        let mut miss = f64::INFINITY;
        for (index, patch) in self.patches.iter().enumerate() {
            let mut cell = Cell::whole(index, patch);
            cell.bound = box_distance(&patch.points(), near);
            if across.may_meet(&cell, ON_LINE * size) {
                heap.push(cell);
            } else {
                miss = miss.min(across.off(&patch.evaluate(0.5, 0.5).position).norm());
            }
        }
        let mut best: Option<(f64, SurfacePlace)> = None;
        let mut seen = 0;
        while let Some(cell) = heap.pop() {
            let reached = best.as_ref().map_or(f64::INFINITY, |found| found.0);
            seen += 1;
            if cell.bound >= reached || seen > MOST_CELLS {
                break;
            }
            let (found, off) = across.root(&cell);
            miss = miss.min(off);
            if let Some(local) = found.filter(|_| off <= ON_LINE * size.max(point.norm())) {
                let position = self
                    .patches
                    .get(cell.index)
                    .map_or(*near, |patch| patch.evaluate(local[0], local[1]).position);
                let distance = (position - near).norm();
                if distance < reached {
                    best = Some((distance, SurfacePlace { position, patch: cell.index, local }));
                }
            }
            if (0..2).all(|side| cell.high[side] - cell.low[side] <= SMALLEST) {
                continue;
            }
            for mut half in cell.halves() {
                half.bound = cell.bound.max(box_distance(&half.patch.points(), near));
                if across.may_meet(&half, ON_LINE * size) {
                    heap.push(half);
                }
            }
        }
        best.map(|found| found.1).ok_or(miss)
    }
}

impl Across {
    /// The vector from the line to a place, across the line.
    fn off(&self, place: &Vec3) -> Vector2<f64> {
        let away = place - self.point;
        Vector2::new(self.axes[0].dot(&away), self.axes[1].dot(&away))
    }

    /// Whether the control points of a cell leave room for the line, tried along the axes and along the cell's sides.
    fn may_meet(&self, cell: &Cell, slack: f64) -> bool {
        let places = cell.patch.points().map(|row| row.map(|point| self.off(&point)));
        let sides = [places[3][0] - places[0][0], places[0][3] - places[0][0]];
        let normals = sides.map(|side| Vector2::new(-side.y, side.x));
        let tried = [Vector2::x(), Vector2::y(), normals[0], normals[1]];
        tried.iter().filter_map(|direction| direction.try_normalize(f64::MIN_POSITIVE)).all(|direction| {
            let along = places.iter().flatten().map(|place| direction.dot(place));
            let (low, high) =
                along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
            low <= slack && high >= -slack
        })
    }

    /// The place of the line that Newton's steps from the middle of a cell lead to, if it is in the cell, and how far from
    /// the line they end.
    fn root(&self, cell: &Cell) -> (Option<[f64; 2]>, f64) {
        let mut local = Vector2::new(0.5, 0.5);
        let mut off = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let at = cell.patch.evaluate(local.x, local.y);
            let away = self.off(&at.position);
            off = away.norm();
            let slope = |vector: &Vec3| Vector2::new(self.axes[0].dot(vector), self.axes[1].dot(vector));
            let system = Matrix2::from_columns(&[slope(&at.du), slope(&at.dv)]);
            let Some(inverse) = system.try_inverse() else { break };
            let next = local - inverse * away;
            if !next.iter().all(|value| (-1.0..=2.0).contains(value)) {
                break;
            }
            let by = (next - local).norm();
            local = next;
            if by <= f64::EPSILON {
                break;
            }
        }
        // A cell's neighbour may hold a place that rounding pushes out of its own.
        let inside = local.iter().all(|value| (-BEYOND..=1.0 + BEYOND).contains(value));
        let clamped = local.map(|value| value.clamp(0.0, 1.0));
        if inside {
            off = self.off(&cell.patch.evaluate(clamped.x, clamped.y).position).norm();
        }
        let global = |side: usize| {
            (cell.low[side] + (cell.high[side] - cell.low[side]) * clamped[side]).clamp(0.0, 1.0)
        };
        (inside.then(|| [global(0), global(1)]), off)
    }
}

impl SpaceCurve {
    /// The arc (index) and its parameter where a plane meets the curve; of several the place nearest to `near`.
    ///
    /// # Errors
    /// The least distance of the curve's control points from the plane, if they do not meet.
    pub fn crossed(&self, plane: &Plane, near: &Vec3) -> Result<(usize, f64), f64> {
        let length = plane.normal.norm();
        let slack = ON_LINE * (self.size() + plane.distance.abs() / length);
        let mut places = Vec::new();
        let mut miss = f64::INFINITY;
        for (index, arc) in self.arcs.iter().enumerate() {
            let heights =
                arc.control.map(|point| (plane.normal.dot(&point.xyz()) - plane.distance * point.w) / length);
            miss = heights
                .iter()
                .zip(&arc.control)
                .map(|(height, point)| (height / point.w).abs())
                .fold(miss, f64::min);
            if heights.iter().all(|height| height.abs() <= slack) {
                places.push((index, nearest_of(arc, near)));
                continue;
            }
            let mut roots = Vec::new();
            crossings(&heights, 0.0, 1.0, slack, MOST_HALVINGS, &mut roots);
            places.extend(roots.into_iter().map(|root| (index, root)));
        }
        let distance = |place: &(usize, f64)| {
            self.arcs.get(place.0).map_or(f64::INFINITY, |arc| (arc.evaluate(place.1).position - near).norm())
        };
        places.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).ok_or(miss)
    }
}

/// Parameters where a cubic in Bernstein form vanishes: it cannot where all its coefficients have one sign.
fn crossings(c: &[f64; 4], low: f64, high: f64, slack: f64, depth: u32, roots: &mut Vec<f64>) {
    if c.iter().all(|value| *value > slack) || c.iter().all(|value| *value < -slack) {
        return;
    }
    let middle = 0.5 * (low + high);
    if depth == 0 || high - low <= f64::EPSILON {
        // Neighbouring cells meet in their common root.
        if roots.last().is_none_or(|last| middle - last > f64::EPSILON.sqrt()) {
            roots.push(middle);
        }
        return;
    }
    let changes = c.windows(2).filter(|pair| (pair[0] <= 0.0) != (pair[1] <= 0.0)).count();
    // One change of sign: exactly one root, which bisection finds.
    if changes == 1 && (c[0] <= 0.0) != (c[3] <= 0.0) {
        let root = bisected(c, low, high);
        if roots.last().is_none_or(|last| root - last > f64::EPSILON.sqrt()) {
            roots.push(root);
        }
        return;
    }
    let mid = |a: f64, b: f64| 0.5 * (a + b);
    let (ab, bc, cd) = (mid(c[0], c[1]), mid(c[1], c[2]), mid(c[2], c[3]));
    let (abc, bcd) = (mid(ab, bc), mid(bc, cd));
    let center = mid(abc, bcd);
    crossings(&[c[0], ab, abc, center], low, middle, slack, depth - 1, roots);
    crossings(&[center, bcd, cd, c[3]], middle, high, slack, depth - 1, roots);
}

fn bisected(c: &[f64; 4], low: f64, high: f64) -> f64 {
    let value = |t: f64| {
        let s = 1.0 - t;
        c[0] * s * s * s + 3.0 * c[1] * s * s * t + 3.0 * c[2] * s * t * t + c[3] * t * t * t
    };
    let below = c[0] <= 0.0;
    let (mut from, mut to) = (0.0, 1.0);
    for _ in 0..MOST_HALVINGS {
        let middle = 0.5 * (from + to);
        if (value(middle) <= 0.0) == below { from = middle } else { to = middle }
    }
    low + (high - low) * 0.5 * (from + to)
}

/// The parameter of an arc nearest to a point: the best of many places, closed in by thirds.
fn nearest_of(arc: &CurveArc, near: &Vec3) -> f64 {
    let distance = |t: f64| (arc.evaluate(t).position - near).norm_squared();
    let at = |index: usize| index as f64 / PLACES_IN_PLANE as f64;
    let best =
        (0..=PLACES_IN_PLANE).min_by(|a, b| distance(at(*a)).total_cmp(&distance(at(*b)))).unwrap_or(0);
    let step = 1.0 / PLACES_IN_PLANE as f64;
    let (mut low, mut high) = ((at(best) - step).max(0.0), (at(best) + step).min(1.0));
    for _ in 0..MOST_HALVINGS {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if distance(a) <= distance(b) { high = b } else { low = a }
    }
    0.5 * (low + high)
}
