//! The exact two-dimensional route (ARLM2): drive and check surface parallel to a vertical tool, the part surface a
//! plane. The path is the line or circle through the present position, so that a starting error inside the band is
//! kept; stops are intersections in closed form; circles are cut into the fewest chords of the tolerance ring.

mod stops;

use apt_geometry::{
    Vec3,
    motion::{CheckSurface, Relation},
    patience::Patience,
    surface::Surface,
};

use stops::choose;

use super::{Path, Prepared};
use crate::{
    bound::Bent,
    error::{Course, MotionFailure},
    plane_curve::{Curve, flat},
    role::GUARD,
    section2::State,
};

/// |cos| of the tool axis to z above which the tool is vertical.
const VERTICAL: f64 = 0.99995;
/// |cos| between part plane normal and tool axis above which the route applies.
const LEAST_PART_COSINE: f64 = 0.2;
/// Share of the band kept free of the limits when the path is moved to reach a stop.
const LIMIT_GUARD: f64 = 1e-3;
/// Angle, radians, below which a stop on a circle is the start itself.
const START_ANGLE: f64 = 1e-9;

/// Share by which rounding lets a vector be longer than MAXDP.
const LENGTH_ROUNDING: f64 = 1e-9;
/// Halvings of an angle of travel that leave of it what is rounding.
const HALVINGS: u32 = 54;

/// The path of the tool end, normal to the tool axis.
struct Track {
    curve: TrackCurve,
    from: Vec3,
    axis: Vec3,
}

enum TrackCurve {
    Line {
        direction: Vec3,
    },
    /// Radius and unit vectors at the start: outward and in the sense of motion.
    Circle {
        center: Vec3,
        radius: f64,
        outward: Vec3,
        forward: Vec3,
    },
}

impl Track {
    /// Position at a parameter: length on a line, angle on a circle.
    fn at(&self, x: f64) -> Vec3 {
        match &self.curve {
            TrackCurve::Line { direction } => self.from + direction * x,
            TrackCurve::Circle { radius, .. } => self.on_circle(x, *radius),
        }
    }

    fn on_circle(&self, angle: f64, radius: f64) -> Vec3 {
        match &self.curve {
            TrackCurve::Line { .. } => self.from,
            TrackCurve::Circle { center, outward, forward, .. } => {
                let (sin, cos) = angle.sin_cos();
                let height = self.axis * (self.from - center).dot(&self.axis);
                center + height + (outward * cos + forward * sin) * radius
            }
        }
    }

    fn closed(&self) -> bool {
        matches!(self.curve, TrackCurve::Circle { .. })
    }

    /// Parameters at which the path is at a signed distance from a curve; on a circle within one turn.
    fn crossings(&self, curve: &Curve, level: f64) -> Vec<f64> {
        match &self.curve {
            TrackCurve::Line { direction } => curve.line_crossings(&self.from, direction, level, &self.axis),
            TrackCurve::Circle { center, radius, .. } => {
                match curve.circle_crossings(center, *radius, level, &self.axis) {
                    Some((towards, half)) => vec![self.angle(&towards, half), self.angle(&towards, -half)],
                    None => Vec::new(),
                }
            }
        }
    }

    /// Why a curve that is at no level anywhere on the path is never met.
    fn never_meets(&self, stop: &Curve) -> Course {
        match (&self.curve, stop) {
            (TrackCurve::Line { .. }, Curve::Line { .. }) => Course::Parallel,
            (TrackCurve::Circle { center, .. }, Curve::Circle { .. })
                if stop.parallel_directions(center, &self.axis).is_none() =>
            {
                Course::Concentric
            }
            _ => Course::Analytic,
        }
    }

    /// Where on the way ahead a distance from a curve that is never zero is least.
    fn nearest(&self, stop: &Curve, distance: &dyn Fn(f64) -> f64) -> (f64, f64) {
        let mut places = vec![0.0];
        match (&self.curve, stop) {
            (TrackCurve::Line { direction }, Curve::Circle { center, .. }) => {
                places.push((center - self.from).dot(direction).max(0.0));
            }
            (TrackCurve::Line { .. }, Curve::Line { .. }) => {}
            (TrackCurve::Circle { center, .. }, _) => {
                let towards = stop.parallel_directions(center, &self.axis);
                places.extend(
                    towards.iter().flat_map(|w| [0.0, std::f64::consts::PI].map(|half| self.angle(w, half))),
                );
            }
        }
        let mut best = (0.0, f64::INFINITY);
        for x in places {
            let found = distance(x);
            if found < best.1 {
                best = (x, found);
            }
        }
        best
    }

    /// Angle of travel to a direction turned by another angle, in [0, 2π).
    fn angle(&self, towards: &Vec3, turned: f64) -> f64 {
        let TrackCurve::Circle { outward, forward, .. } = &self.curve else { return 0.0 };
        let angle =
            (towards.dot(forward).atan2(towards.dot(outward)) + turned).rem_euclid(std::f64::consts::TAU);
        if angle > std::f64::consts::TAU - START_ANGLE { 0.0 } else { angle }
    }
}

/// A stop: parameter and signed level of the check surface.
#[derive(Clone, Copy)]
struct Candidate {
    x: f64,
    level: f64,
}

/// The path, or `None` if the route does not apply.
pub(super) fn run(
    state: &State,
    prepared: &Prepared,
    checks: &[CheckSurface],
    patience: Patience<'_>,
) -> Result<Option<Path>, MotionFailure> {
    let [check] = checks else { return Ok(None) };
    let Some((drive, stop)) = eligible(state, prepared, check) else { return Ok(None) };
    if patience.is_over() {
        return Err(MotionFailure::Cancelled);
    }
    let along = |shift: f64| -> Result<Option<Path>, MotionFailure> {
        let track = track(prepared, &drive, shift);
        let Some(found) = choose(prepared, check, &track, &stop)? else { return Ok(None) };
        let points = cut(state, prepared, &track, found.x)?;
        let check_side = side(prepared, &stop, &track, found);
        Ok(Some(Path { points, check: 0, check_side, bent: Bent::none(&prepared.tip) }))
    };
    // The path through the present position; if that meets nothing, others in the band.
    along(0.0).or_else(|failure| {
        let others = other_paths(prepared, &failure).into_iter();
        others.map(along).find_map(Result::ok).ok_or(failure)
    })
}

/// Shifts of the path along the drive surface's gradient, inside its band, that may meet what the path through the
/// present position does not: just so much that the gap of a tangency closes, or to the limits of the band.
fn other_paths(prepared: &Prepared, failure: &MotionFailure) -> Vec<f64> {
    let (below, above) = reach_of_band(prepared);
    let (lowest, highest) = (-below * (1.0 - LIMIT_GUARD), above * (1.0 - LIMIT_GUARD));
    match failure {
        MotionFailure::NotTangent { gap, .. } => {
            let check = &prepared.checks[0];
            let guard = GUARD * check.band();
            let missing = gap.clamp(guard - check.inside, check.outside - guard) - gap;
            [missing, -missing].into_iter().filter(|shift| (lowest..=highest).contains(shift)).collect()
        }
        _ => vec![lowest, highest],
    }
}

fn eligible(state: &State, prepared: &Prepared, check: &CheckSurface) -> Option<(Curve, Curve)> {
    let axis = &prepared.tool.axis;
    let Surface::Plane(part) = &prepared.part.gauge.surface else { return None };
    let applies = !state.force_iteration
        && prepared.part.gauge.disk.or(prepared.drive.gauge.disk).is_none()
        && !prepared.attitude.turns()
        && axis.z.abs() >= VERTICAL
        && prepared.tool.cutter.beta == 0.0
        && part.normal.dot(axis).abs() > LEAST_PART_COSINE
        && prepared.checks[0].gauge.thickness == 0.0
        && check.relation != Relation::TangentToPart;
    if !applies {
        return None;
    }
    let drive = Curve::of(&prepared.drive.gauge.surface, axis)?;
    let stop = Curve::of(&prepared.checks[0].gauge.surface, axis)?;
    Some((drive, stop))
}

/// How far the path may move against and along the drive surface's gradient and stay in the band.
fn reach_of_band(prepared: &Prepared) -> (f64, f64) {
    let clearance = prepared.drive.gauge.contact(&prepared.tool, &prepared.tip).clearance;
    ((clearance + prepared.drive.inside).max(0.0), (prepared.drive.outside - clearance).max(0.0))
}

/// The path through the present position, moved by `shift` along the drive surface's gradient.
fn track(prepared: &Prepared, drive: &Curve, shift: f64) -> Track {
    let axis = prepared.tool.axis;
    let gradient = prepared.drive.gauge.contact(&prepared.tool, &prepared.tip).gradient;
    let from = prepared.tip + gradient * shift;
    let ahead = flat(&prepared.tangent, &axis);
    let curve = match drive {
        Curve::Line { normal, .. } => {
            let direction = (ahead - normal * ahead.dot(normal)).try_normalize(0.0).unwrap_or(ahead);
            TrackCurve::Line { direction }
        }
        Curve::Circle { center, .. } => {
            let w = flat(&(from - center), &axis);
            let radius = w.norm();
            let outward = if radius > 0.0 { w / radius } else { gradient };
            let around = axis.cross(&outward);
            let forward = if around.dot(&ahead) < 0.0 { -around } else { around };
            TrackCurve::Circle { center: *center, radius, outward, forward }
        }
    };
    Track { curve, from, axis }
}

/// Side of the check surface on which the tool stands at the end; for ON the side it came from.
fn side(prepared: &Prepared, stop: &Curve, track: &Track, found: Candidate) -> f64 {
    let signed = if found.level == 0.0 {
        let start = stop.signed_distance(&prepared.tip, &track.axis);
        if start == 0.0 { 1.0 } else { start }
    } else {
        found.level
    };
    signed.signum()
}

/// The vertices up to the stop, on the part plane's parallel through the present position.
fn cut(state: &State, prepared: &Prepared, track: &Track, end: f64) -> Result<Vec<Vec3>, MotionFailure> {
    let mut points = match &track.curve {
        TrackCurve::Line { .. } => vec![track.at(end)],
        TrackCurve::Circle { center, radius, .. } => chords(state, prepared, track, (center, *radius), end)?,
    };
    for point in &mut points {
        *point += rise(prepared, &track.axis, &(*point - prepared.tip));
    }
    Ok(points)
}

/// How far the part plane lifts the tool on a way square to its axis.
fn rise(prepared: &Prepared, axis: &Vec3, way: &Vec3) -> Vec3 {
    match &prepared.part.gauge.surface {
        Surface::Plane(part) => axis * (-part.normal.dot(way) / part.normal.dot(axis)),
        _ => Vec3::zeros(),
    }
}

/// The fewest chords of the tolerance ring from the start to an angle of travel, spread evenly.
fn chords(
    state: &State,
    prepared: &Prepared,
    track: &Track,
    (center, radius): (&Vec3, f64),
    angle: f64,
) -> Result<Vec<Vec3>, MotionFailure> {
    let start = flat(&(prepared.tip - center), &track.axis).norm();
    let (below, above) = reach_of_band(prepared);
    let guard = 0.5 * GUARD * prepared.drive.band();
    let (inner, outer) = if prepared.drive.gauge.side > 0.0 {
        (start - below + guard, start + above - guard)
    } else {
        (start - above + guard, start + below - guard)
    };
    let inner = inner.clamp(0.0, start.min(radius));
    // A vector of the greatest length that touches the inner circle ends here; vertices farther out would only add to it.
    let outer = outer.min(inner.hypot(0.5 * state.maximum_step)).max(start).max(radius);
    let half = |r: f64| (inner / r).clamp(0.0, 1.0).acos();
    let longest = (0.5 * state.maximum_step / outer).clamp(0.0, 1.0).asin().max(f64::MIN_POSITIVE);
    // The vectors at both ends reach from a vertex as far as half a vector, so they too are held to the longest.
    let [first, last, step] = [start, radius, outer].map(|r| half(r).min(longest));
    if step <= 0.0 {
        return Err(MotionFailure::NoAdmissibleVector {
            role: prepared.drive.name,
            clearance: above.min(below),
            tip: prepared.tip,
        });
    }
    let inside = ((angle - first - last) / (2.0 * step)).ceil().max(0.0);
    if inside + 1.0 > f64::from(state.maximum_points) {
        return Err(too_many(state, prepared, angle * radius));
    }
    let count = inside as u32;
    let share = if count == 0 { 1.0 } else { angle / (first + last + 2.0 * step * inside) };
    let mut points = Vec::with_capacity(count as usize + 1);
    for k in 0..count {
        let travelled = share * (first + step * f64::from(2 * k + 1));
        points.push(track.on_circle(travelled, outer));
    }
    points.push(track.at(angle));
    let lifted = |from: &Vec3, to: &Vec3| {
        let way = to - from;
        (way + rise(prepared, &track.axis, &way)).norm()
    };
    let rising = Rising { track, most: state.maximum_step, outer, half: &half, lifted: &lifted };
    if rising.keeps(&prepared.tip, &points) {
        return Ok(points);
    }
    rising
        .chords((prepared.tip, start), (angle, radius), state.maximum_points)
        .ok_or_else(|| too_many(state, prepared, angle * radius))
}

fn too_many(state: &State, prepared: &Prepared, remaining: f64) -> MotionFailure {
    MotionFailure::TooManyPoints {
        limit: state.maximum_points,
        maximum_step: state.maximum_step,
        remaining,
        at: prepared.tip,
    }
}

/// Chords of a ring over a part plane that leans: how long they are changes with the direction, and each goes as far as it may.
struct Rising<'a> {
    track: &'a Track,
    /// Length of the longest vector.
    most: f64,
    /// Radius of the vertices.
    outer: f64,
    /// Angle of travel between a vertex at a radius and where the chord touches the inner circle.
    half: &'a dyn Fn(f64) -> f64,
    /// Length of a vector with what it rises.
    lifted: &'a dyn Fn(&Vec3, &Vec3) -> f64,
}

impl Rising<'_> {
    /// Whether none of the vectors is too long.
    fn keeps(&self, start: &Vec3, points: &[Vec3]) -> bool {
        let mut from = start;
        let length = |to| (self.lifted)(std::mem::replace(&mut from, to), to);
        points.iter().map(length).all(|length| length <= self.most * (1.0 + LENGTH_ROUNDING))
    }

    fn is_short(&self, from: &Vec3, to: &Vec3) -> bool {
        (self.lifted)(from, to) <= self.most
    }

    /// From a position at a radius to the end by its angle and radius; `None` if that takes more than so many.
    fn chords(
        &self,
        (mut from, mut radius): (Vec3, f64),
        (end, last): (f64, f64),
        limit: u32,
    ) -> Option<Vec<Vec3>> {
        let (mut points, mut begin) = (Vec::new(), 0.0);
        let goal = self.track.on_circle(end, last);
        // Chords touch the inner circle at most.
        let reach = |radius: f64, next: f64| (self.half)(radius) + (self.half)(next);
        while end - begin > reach(radius, last) || !self.is_short(&from, &goal) {
            let farthest = (begin + reach(radius, self.outer)).min(end);
            let angle = self.longest(&from, begin, farthest);
            if angle <= begin || points.len() as u32 + 1 >= limit {
                return None;
            }
            (from, radius, begin) = (self.track.on_circle(angle, self.outer), self.outer, angle);
            points.push(from);
        }
        points.push(goal);
        Some(points)
    }

    /// The angle of the vertex, the farthest if possible, to which the vector from a position is as long as it may be.
    fn longest(&self, from: &Vec3, mut near: f64, mut far: f64) -> f64 {
        let is_short = |angle: f64| self.is_short(from, &self.track.on_circle(angle, self.outer));
        if is_short(far) {
            return far;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if is_short(middle) {
                near = middle;
            } else {
                far = middle;
            }
        }
        near
    }
}

#[cfg(test)]
mod tests;
