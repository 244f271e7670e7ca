//! The proof of a pocket: the tool stays between the walls, the finishing pass follows them exactly, and the bottom
//! is cleared. Nothing of the construction is used: only the statement's points, the cutter and the path.
//!
//! Seen along the tool axis the walls are straight lines and the tool is a disc. Two statements are exact up to
//! round-off: no gouge (a vector is inside a convex area if its ends are) and the finishing pass. What is cleared is
//! the union of the strips around the vectors; that it holds the whole area is proven by halving triangles until each
//! lies in one strip. Strips are widened by the tolerance, which bounds the error: a proof means that no point is
//! farther from a strip than the tolerance, a refusal names a point that is farther than half of it.

use apt_geometry::Vec3;

use super::{Evidence, Extent, Rule, VerifyError, Violation};
use crate::pocket::PocketPath;

type Vec2 = nalgebra::Vector2<f64>;

/// Round-off allowed, relative to the size of the geometry.
const ROUND_OFF: f64 = 1e-9;
/// Least tolerance of the cleared area, relative to the effective radius: offsets made to clear exactly would
/// otherwise be at the mercy of round-off.
const LEAST_TOLERANCE: f64 = 1e-6;
/// Triangles that are looked at before the proof is given up.
const MOST_TRIANGLES: usize = 4_000_000;

/// A wall seen along the tool axis: the half plane `inward · x >= offset` for the tool centre.
struct Wall {
    inward: Vec2,
    offset: f64,
}

/// The pocket seen along the tool axis.
struct View {
    across: [Vec3; 2],
    walls: Vec<Wall>,
    size: f64,
}

/// Judges a pocket: `part` of the evidence is the height over the plane of the pocket, `drive` the distance between
/// tool and walls, greatest in the finishing pass.
///
/// # Errors
///
/// [`VerifyError::Empty`] without positions or area, [`VerifyError::NotFinite`], [`VerifyError::Effort`] when the area
/// is too large for the tool, [`VerifyError::Cancelled`].
pub fn verify_pocket(path: &PocketPath, cancel: &dyn Fn() -> bool) -> Result<Evidence, VerifyError> {
    let tips: Vec<Vec3> = path.positions().map(|position| position.tip).collect();
    let numbers = [path.effective_radius, path.tolerance, path.cutter.radius()];
    let vectors = tips.iter().chain(&path.boundary).chain([&path.axis]);
    if !vectors.flatten().chain(&numbers).all(|x| x.is_finite()) {
        return Err(VerifyError::NotFinite);
    }
    if tips.is_empty() || path.boundary.len() < 3 {
        return Err(VerifyError::Empty);
    }
    let view = View::of(path);
    let guard = ROUND_OFF * view.size;
    let flat: Vec<Vec2> = tips.iter().map(|tip| view.flat(tip)).collect();
    let mut violations = Vec::new();
    let part = heights(path, &tips, guard, &mut violations);
    let drive = clearances(&view, path, &flat, guard, &mut violations);
    let area = view.area(guard);
    if area.len() < 3 {
        return Err(VerifyError::Empty);
    }
    if let Some(value) = finishing_fault(&area, &flat, guard) {
        violations.push(Violation { rule: Rule::DriveBand, vector: flat.len() - 1, value });
    }
    if let Some((vector, value)) = uncleared(path, &area, &flat, cancel)? {
        violations.push(Violation { rule: Rule::Cleared, vector, value });
    }
    let verified = violations.is_empty();
    Ok(Evidence { part: Some(part), drive: Some(drive), check: None, verified, violations })
}

impl View {
    fn of(path: &PocketPath) -> Self {
        let axis = path.axis;
        let smallest = if axis.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() };
        let first = (smallest - axis * axis.dot(&smallest)).normalize();
        let mut view = Self { across: [first, axis.cross(&first)], walls: Vec::new(), size: 0.0 };
        let points: Vec<Vec2> = path.boundary.iter().map(|point| view.flat(point)).collect();
        let middle = points.iter().sum::<Vec2>() / points.len() as f64;
        let radius = if path.walls { path.cutter.radius() } else { 0.0 };
        for (from, to) in points.iter().zip(points.iter().cycle().skip(1)) {
            let run = (to - from).normalize();
            let left = Vec2::new(-run.y, run.x);
            let inward = if left.dot(&(middle - from)) < 0.0 { -left } else { left };
            view.walls.push(Wall { inward, offset: inward.dot(from) + radius });
        }
        view.size = path.boundary.iter().map(|point| point.norm()).fold(1.0, f64::max);
        view
    }

    fn flat(&self, point: &Vec3) -> Vec2 {
        Vec2::new(point.dot(&self.across[0]), point.dot(&self.across[1]))
    }

    fn clearance(&self, point: &Vec2) -> f64 {
        self.walls.iter().map(|wall| wall.inward.dot(point) - wall.offset).fold(f64::INFINITY, f64::min)
    }

    /// Corners of the area the tool centre can be in: where two walls meet inside all others, round its middle.
    fn area(&self, guard: f64) -> Vec<Vec2> {
        let mut corners: Vec<Vec2> = Vec::new();
        for (k, one) in self.walls.iter().enumerate() {
            for other in &self.walls[k + 1..] {
                let determinant = one.inward.perp(&other.inward);
                let x = one.offset * other.inward.y - other.offset * one.inward.y;
                let y = one.inward.x * other.offset - other.inward.x * one.offset;
                let corner = Vec2::new(x, y) / determinant;
                let inside = corner.iter().all(|x| x.is_finite()) && self.clearance(&corner) >= -guard;
                if inside && corners.iter().all(|known| (known - corner).norm() > guard) {
                    corners.push(corner);
                }
            }
        }
        let middle = corners.iter().sum::<Vec2>() / corners.len().max(1) as f64;
        let angle = |corner: &Vec2| (corner.y - middle.y).atan2(corner.x - middle.x);
        corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        corners
    }
}

/// Heights of the tool end over the plane through the points of the statement.
fn heights(path: &PocketPath, tips: &[Vec3], guard: f64, violations: &mut Vec<Violation>) -> Extent {
    // Twice the area vector of the polygon: its normal, whichever three points are nearly in line.
    let turned = path.boundary.iter().zip(path.boundary.iter().cycle().skip(1));
    let from = path.boundary.first().copied().unwrap_or_else(Vec3::zeros);
    let normal = turned.map(|(a, b)| (a - from).cross(&(b - from))).sum::<Vec3>().normalize();
    let toward = if normal.dot(&path.axis) < 0.0 { -1.0 } else { 1.0 };
    let mut extent = Extent { min: f64::INFINITY, max: f64::NEG_INFINITY, intol: 0.0, outtol: 0.0 };
    // The points themselves may be out of plane by as much as the statement is allowed to be wrong.
    let own = path.boundary.iter().map(|point| normal.dot(&(point - from)).abs()).fold(0.0, f64::max);
    (extent.intol, extent.outtol) = (own, own);
    let mut worst: Option<Violation> = None;
    for (vector, tip) in tips.iter().enumerate() {
        let value = toward * normal.dot(&(tip - from));
        extent.min = extent.min.min(value);
        extent.max = extent.max.max(value);
        let is_worst = worst.as_ref().is_none_or(|worst| value.abs() > worst.value.abs());
        if (value.abs() > own + guard || value.is_nan()) && is_worst {
            worst = Some(Violation { rule: Rule::PartBand, vector, value });
        }
    }
    violations.extend(worst);
    extent
}

/// Distances between tool and nearest wall; the greatest of the finishing pass.
fn clearances(
    view: &View,
    path: &PocketPath,
    flat: &[Vec2],
    guard: f64,
    violations: &mut Vec<Violation>,
) -> Extent {
    let finish = flat.len() - path.passes[2].points.len().min(flat.len());
    let mut extent = Extent { min: f64::INFINITY, max: f64::NEG_INFINITY, intol: 0.0, outtol: 0.0 };
    let mut deepest: Option<Violation> = None;
    for (vector, point) in flat.iter().enumerate() {
        let value = view.clearance(point);
        extent.min = extent.min.min(value);
        if vector >= finish {
            extent.max = extent.max.max(value);
        }
        if value < -guard && deepest.as_ref().is_none_or(|deepest| value < deepest.value) {
            deepest = Some(Violation { rule: Rule::DriveBand, vector, value });
        }
    }
    violations.extend(deepest);
    extent
}

/// The path must end with one turn round the area, from corner to corner: the greatest distance from that turn, if it
/// is not round-off. Infinite if there are too few positions.
fn finishing_fault(area: &[Vec2], flat: &[Vec2], guard: f64) -> Option<f64> {
    let count = area.len();
    let Some(last) = flat.len().checked_sub(count + 1) else { return Some(f64::INFINITY) };
    let turn = &flat[last..];
    let distance = |start: usize, forward: bool| {
        let corner = |k: usize| {
            let steps = k % count;
            area[if forward { start + steps } else { start + count - steps } % count]
        };
        turn.iter().enumerate().map(|(k, point)| (point - corner(k)).norm()).fold(0.0, f64::max)
    };
    let turns = (0..count).flat_map(|start| [distance(start, true), distance(start, false)]);
    let best = turns.fold(f64::INFINITY, f64::min);
    // Corners are where two walls cross: at sharp angles their round-off is that much greater.
    (best > guard * CORNER_ROUND_OFF).then_some(best)
}

/// How much more round-off a corner may have than a side.
const CORNER_ROUND_OFF: f64 = 1e3;

/// A triangle and the strips that come near it.
struct Cell {
    corners: [Vec2; 3],
    near: Vec<usize>,
}

/// A point of the area that is in no strip: the nearest vector and how far from its strip the point is.
fn uncleared(
    path: &PocketPath,
    area: &[Vec2],
    flat: &[Vec2],
    cancel: &dyn Fn() -> bool,
) -> Result<Option<(usize, f64)>, VerifyError> {
    let radius = cleared_radius(path);
    let tolerance = path.tolerance.max(LEAST_TOLERANCE * path.cutter.radius());
    let reach = radius + tolerance;
    let strip = |k: usize| (flat[k.saturating_sub(1)], flat[k]);
    let distance = |point: &Vec2, k: usize| {
        let (from, to) = strip(k);
        to_segment(point, &from, &to)
    };
    let all: Vec<usize> = (0..flat.len()).collect();
    let fan = area.windows(2).skip(1).map(|pair| [area[0], pair[0], pair[1]]);
    let mut cells: Vec<Cell> = fan.map(|corners| Cell { corners, near: all.clone() }).collect();
    let mut looked_at = 0;
    while let Some(cell) = cells.pop() {
        looked_at += 1;
        if looked_at > MOST_TRIANGLES {
            return Err(VerifyError::Effort { limit: MOST_TRIANGLES });
        }
        if cancel() {
            return Err(VerifyError::Cancelled);
        }
        let middle = cell.corners.iter().sum::<Vec2>() / 3.0;
        let extent = cell.corners.iter().map(|corner| (corner - middle).norm()).fold(0.0, f64::max);
        let (mut nearest, mut least, mut near) = (0, f64::INFINITY, Vec::new());
        for &k in &cell.near {
            let away = distance(&middle, k);
            if away < least {
                (nearest, least) = (k, away);
            }
            if away <= reach + extent {
                near.push(k);
            }
        }
        if least > reach - 0.5 * tolerance && (least > reach || extent <= 0.5 * tolerance) {
            return Ok(Some((nearest, least - radius)));
        }
        // A strip is convex: it holds the triangle if it holds its corners.
        let held = |k: &usize| cell.corners.iter().all(|corner| distance(corner, *k) <= reach);
        if near.iter().any(held) {
            continue;
        }
        cells.extend(halves(&cell.corners).map(|corners| Cell { corners, near: near.clone() }));
    }
    Ok(None)
}

/// What the tool clears around its centre: its flat end, and where that is smaller the radius the programmer takes
/// for enough; never more than the tool has.
fn cleared_radius(path: &PocketPath) -> f64 {
    let pointed = path.cutter.alpha.abs() > ROUND_OFF;
    let flat_end = if pointed { 0.0 } else { path.cutter.corner_offset.max(0.0) };
    path.effective_radius.max(flat_end).min(path.cutter.radius())
}

/// Halves a triangle across its longest side.
fn halves(corners: &[Vec2; 3]) -> [[Vec2; 3]; 2] {
    let length = |k: usize| (corners[(k + 1) % 3] - corners[k]).norm_squared();
    let longest = (0..3).max_by(|a, b| length(*a).total_cmp(&length(*b))).unwrap_or(0);
    let [a, b, c] = [longest, (longest + 1) % 3, (longest + 2) % 3].map(|k| corners[k]);
    let middle = (a + b) * 0.5;
    [[a, middle, c], [middle, b, c]]
}

fn to_segment(point: &Vec2, from: &Vec2, to: &Vec2) -> f64 {
    let run = to - from;
    let squared = run.norm_squared();
    let share = if squared > 0.0 { ((point - from).dot(&run) / squared).clamp(0.0, 1.0) } else { 0.0 };
    (point - (from + run * share)).norm()
}
