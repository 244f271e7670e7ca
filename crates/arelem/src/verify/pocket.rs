//! The proof of a pocket: the tool stays between the walls, the finishing pass follows them exactly, and the bottom
//! is cleared. Nothing of the construction is used: only the statement's points, the cutter and the path.
//!
//! Seen along the tool axis the walls are straight lines and the tool is a disc. Two statements are exact up to
//! round-off: no gouge (a vector is inside a convex area if its ends are) and the finishing pass. What is cleared is
//! the union of the strips around the vectors; that it holds the whole area is proven by taking strips out of it until
//! every piece that is left lies in one strip. Strips are widened by the tolerance, which bounds the error: a proof
//! means that no point is farther from a strip than the tolerance, a refusal names a point that is out of every strip
//! or a piece smaller than the tolerance at the edge of all.

use std::rc::Rc;

use apt_geometry::Vec3;

use super::{Evidence, Extent, Rule, VerifyError, Violation};
use crate::sequence::PocketPath;

type Vec2 = nalgebra::Vector2<f64>;

/// Round-off allowed, relative to the size of the geometry.
const ROUND_OFF: f64 = 1e-9;
/// Least tolerance of the cleared area, relative to the effective radius: offsets made to clear exactly would
/// otherwise be at the mercy of round-off.
const LEAST_TOLERANCE: f64 = 1e-6;
/// A piece thinner than this part of the tolerance is round-off.
const SLIVER: f64 = 1e-6;
/// A strip is taken out of a piece if it holds more than this share of it; otherwise the piece is halved.
const LEAST_SHARE: f64 = 1e-3;
/// Pieces that are looked at before the proof is given up.
const MOST_PARTS: usize = 4_000_000;

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

/// What the tool clears on one vector: everything within reach of a straight line.
struct Strip {
    from: Vec2,
    to: Vec2,
    along: Vec2,
    length: f64,
}

impl Strip {
    fn of(from: Vec2, to: Vec2) -> Self {
        let length = (to - from).norm();
        let along = if length > 0.0 { (to - from) / length } else { Vec2::x() };
        Self { from, to, along, length }
    }

    fn distance(&self, point: &Vec2) -> f64 {
        let share = self.along.dot(&(point - self.from)).clamp(0.0, self.length);
        (point - (self.from + self.along * share)).norm()
    }

    fn across(&self) -> Vec2 {
        Vec2::new(-self.along.y, self.along.x)
    }

    /// False if the area is surely out of reach.
    fn comes_near(&self, area: &[Vec2], reach: f64) -> bool {
        let range = |direction: Vec2| {
            let heights = area.iter().map(|point| direction.dot(&(point - self.from)));
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)))
        };
        let (low, high) = range(self.across());
        let (first, last) = range(self.along);
        low <= reach && high >= -reach && first <= self.length + reach && last >= -reach
    }

    /// The half planes `direction · x >= offset` around the straight part of the strip.
    fn bounds(&self, reach: f64) -> [(Vec2, f64); 4] {
        let across = self.across();
        let bound = |direction: Vec2, through: Vec2, back: f64| (direction, direction.dot(&through) - back);
        [
            bound(across, self.from, reach),
            bound(-across, self.from, reach),
            bound(self.along, self.from, 0.0),
            bound(-self.along, self.to, 0.0),
        ]
    }
}

/// A convex part of the area and the strips that come near what it was cut from.
struct Part {
    corners: Vec<Vec2>,
    near: Rc<Vec<usize>>,
}

/// A point of the area that is in no strip: the nearest vector and how far from what it clears the point is.
fn uncleared(
    path: &PocketPath,
    area: &[Vec2],
    flat: &[Vec2],
    cancel: &dyn Fn() -> bool,
) -> Result<Option<(usize, f64)>, VerifyError> {
    let radius = cleared_radius(path);
    let tolerance = path.tolerance.max(LEAST_TOLERANCE * path.cutter.radius());
    let reach = radius + tolerance;
    let strips: Vec<Strip> = (0..flat.len()).map(|k| Strip::of(flat[k.saturating_sub(1)], flat[k])).collect();
    let mut parts = vec![Part { corners: area.to_vec(), near: Rc::new((0..strips.len()).collect()) }];
    let mut looked_at = 0;
    while let Some(part) = parts.pop() {
        looked_at += 1;
        if looked_at > MOST_PARTS {
            return Err(VerifyError::Effort { limit: MOST_PARTS });
        }
        if cancel() {
            return Err(VerifyError::Cancelled);
        }
        let corners = &part.corners;
        let middle = corners.iter().sum::<Vec2>() / corners.len() as f64;
        let extent = corners.iter().map(|corner| (corner - middle).norm()).fold(0.0, f64::max);
        let is_near = |k: &&usize| strips[**k].comes_near(corners, reach);
        let near: Vec<usize> = part.near.iter().filter(is_near).copied().collect();
        let away = near.iter().map(|&k| (k, strips[k].distance(&middle)));
        let nearest = away.min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((nearest, least)) = nearest.filter(|(_, least)| *least <= reach) else {
            // No strip reaches the middle; name the nearest of all.
            let away = strips.iter().map(|strip| strip.distance(&middle)).enumerate();
            return Ok(away.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, least)| (k, least - radius)));
        };
        if size(corners) <= SLIVER * tolerance * extent {
            // Left by round-off of a cut: the pieces beside it stand for it.
            continue;
        }
        // A strip is convex: it holds the part if it holds its corners.
        if near.iter().any(|&k| corners.iter().all(|corner| strips[k].distance(corner) <= reach)) {
            continue;
        }
        if extent <= 0.5 * tolerance {
            return Ok(Some((nearest, least - radius)));
        }
        let near = Rc::new(near);
        let rest =
            outside(corners, &strips[nearest].bounds(reach)).unwrap_or_else(|| halves(corners, &middle));
        parts.extend(rest.into_iter().map(|corners| Part { corners, near: Rc::clone(&near) }));
    }
    Ok(None)
}

/// What is left of a convex polygon when the intersection of half planes is taken out, in convex pieces; nothing if
/// too little would be taken out.
fn outside(corners: &[Vec2], bounds: &[(Vec2, f64)]) -> Option<Vec<Vec<Vec2>>> {
    let mut inside = corners.to_vec();
    let mut pieces = Vec::new();
    for (direction, offset) in bounds {
        let [kept, cut] = split(&inside, direction, *offset);
        if kept.len() < 3 {
            return None;
        }
        if cut.len() >= 3 {
            pieces.push(cut);
        }
        inside = kept;
    }
    (size(&inside) > LEAST_SHARE * size(corners)).then_some(pieces)
}

/// Area of a convex polygon.
fn size(corners: &[Vec2]) -> f64 {
    let Some(first) = corners.first() else { return 0.0 };
    let doubled: f64 = corners.windows(2).map(|pair| (pair[0] - first).perp(&(pair[1] - first))).sum();
    0.5 * doubled.abs()
}

/// Cuts a convex polygon across its longest extent from the middle.
fn halves(corners: &[Vec2], middle: &Vec2) -> Vec<Vec<Vec2>> {
    let farthest = corners.iter().max_by(|a, b| (*a - middle).norm().total_cmp(&(*b - middle).norm()));
    let direction = farthest.map_or_else(Vec2::x, |corner| corner - middle).normalize();
    let [a, b] = split(corners, &direction, direction.dot(middle));
    [a, b].into_iter().filter(|piece| piece.len() >= 3).collect()
}

/// The pieces of a convex polygon where `direction · x >= offset` and where not; the cut belongs to both.
fn split(corners: &[Vec2], direction: &Vec2, offset: f64) -> [Vec<Vec2>; 2] {
    let mut pieces = [Vec::with_capacity(corners.len() + 1), Vec::with_capacity(corners.len() + 1)];
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let [start, end] = [from, to].map(|point| direction.dot(point) - offset);
        pieces[usize::from(start < 0.0)].push(*from);
        if (start < 0.0) != (end < 0.0) {
            let crossing = from + (to - from) * (start / (start - end));
            pieces.iter_mut().for_each(|piece| piece.push(crossing));
        }
    }
    pieces
}

/// What the tool clears around its centre: its flat end, and where that is smaller the radius the programmer takes
/// for enough; never more than the tool has.
fn cleared_radius(path: &PocketPath) -> f64 {
    let pointed = path.cutter.alpha.abs() > ROUND_OFF;
    let flat_end = if pointed { 0.0 } else { path.cutter.corner_offset.max(0.0) };
    path.effective_radius.max(flat_end).min(path.cutter.radius())
}
