//! Fitting arcs to runs of points with both ends kept exactly.

use std::f64::consts::{PI, SQRT_2, TAU};

use apt_cldata::record::POSITIONS_A_UNIT;
use apt_geometry::{Vec3, patience::Patience};

use crate::{format::NumberFormat, machine::ArcPlane};

/// A chord that turns more than this about the centre does not tell which way round it goes.
const LARGEST_CHORD_ANGLE: f64 = 0.75 * PI;
/// Sweep from which the direction between ends that nearly meet is too poor to place the centre.
const NEAR_FULL_TURN: f64 = 1.5 * PI;
/// Distance of ends, in resolutions, below which they nearly meet.
const NEAR_RESOLUTIONS: f64 = 100.0;
/// Share of a radius that computing it may lose.
const ROUNDED_OFF: f64 = 1e-12;
/// Sweep up to which the middle of an arc between its ends is off by less than its radius is.
const QUARTER_TURN: f64 = 0.5 * PI;

/// What an arc has to keep to. Lengths in the unit of the tape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ArcLimits<'a> {
    /// How far points may be off the arc.
    pub(crate) tolerance: f64,
    /// How far they may be off it along the third axis, where no circle record vouches for anything.
    pub(crate) height_tolerance: f64,
    /// How far the arc may leave the chords, for runs that no circle record vouches for.
    pub(crate) chord_tolerance: f64,
    /// Radii.
    pub(crate) least_radius: f64,
    pub(crate) greatest_radius: f64,
    /// Largest sweep in radians.
    pub(crate) sweep: f64,
    /// Whether the third axis may move.
    pub(crate) helix: bool,
    /// Size of the last decimal on the tape.
    pub(crate) resolution: f64,
    /// Fewest points of a run without a circle record, start included.
    pub(crate) least_points: usize,
    /// Who waits; where he gives up there is no arc.
    pub(crate) patience: Patience<'a>,
}

/// A fitted arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Arc {
    /// Centre; its coordinate across the plane is that of the start.
    pub(crate) center: Vec3,
    /// Seen against the third axis.
    pub(crate) counterclockwise: bool,
    /// Whether start and end are one point in the plane.
    pub(crate) full_turn: bool,
}

impl Arc {
    /// Its radius, from where it starts.
    pub(crate) fn radius(&self, start: &Vec3, plane: ArcPlane) -> f64 {
        let [u, v, _] = plane_axes(plane);
        (start[u] - self.center[u]).hypot(start[v] - self.center[v])
    }

    /// Signed angle from its start to its end, seen against the third axis.
    pub(crate) fn sweep(&self, start: &Vec3, end: &Vec3, plane: ArcPlane) -> f64 {
        let [u, v, _] = plane_axes(plane);
        let (a, b) = (start - self.center, end - self.center);
        let angle = (a[u] * b[v] - a[v] * b[u]).atan2(a[u] * b[u] + a[v] * b[v]);
        match (self.full_turn, self.counterclockwise) {
            (true, true) => TAU,
            (true, false) => -TAU,
            (false, true) => angle.rem_euclid(TAU),
            (false, false) => -(-angle).rem_euclid(TAU),
        }
    }

    /// The place at a share of it.
    fn at(&self, (start, end): (&Vec3, &Vec3), plane: ArcPlane, share: f64) -> Vec3 {
        let [u, v, w] = plane_axes(plane);
        let (sine, cosine) = (self.sweep(start, end, plane) * share).sin_cos();
        let arm = start - self.center;
        let mut place = self.center;
        place[u] += arm[u] * cosine - arm[v] * sine;
        place[v] += arm[u] * sine + arm[v] * cosine;
        place[w] = start[w] + (end[w] - start[w]) * share;
        place
    }

    /// The ends of the equal parts, as the control reads places, of an arc that is told by its radius: no more than it takes for each to be told.
    pub(crate) fn told_by_radius(
        &self,
        (start, end): (&Vec3, &Vec3),
        plane: ArcPlane,
        (format, tolerance): (NumberFormat, f64),
        rounded: &dyn Fn(Vec3) -> Vec3,
    ) -> Vec<Vec3> {
        let sweep = self.sweep(start, end, plane).abs();
        let radius = self.radius(start, plane);
        let [u, v, _] = plane_axes(plane);
        let divided = |count: f64| {
            let inner = (1..count as usize).map(|part| self.at((start, end), plane, part as f64 / count));
            inner.map(rounded).chain([*end]).collect::<Vec<Vec3>>()
        };
        let is_told = |places: &[Vec3]| {
            let starts = [start].into_iter().chain(places);
            starts.zip(places).all(|(from, to)| {
                is_told(distance([from[u], from[v]], [to[u], to[v]]), radius, format, tolerance)
            })
        };
        let most = (sweep / QUARTER_TURN).ceil();
        let mut count = (sweep / PI - ROUNDED_OFF).ceil().max(1.0);
        loop {
            let places = divided(count);
            if count >= most || is_told(&places) {
                return places;
            }
            count += 1.0;
        }
    }
}

/// Whether a control finds an arc of up to half a turn over a chord from the radius as it reads it: the nearer the arc is to half a turn, the farther off is
/// its middle for what the last decimal is off, and a radius of less than half the chord has no arc.
fn is_told(chord: f64, radius: f64, format: NumberFormat, tolerance: f64) -> bool {
    let Ok(told) = format.rounded(radius) else { return false };
    let half = chord / 2.0;
    let height = |radius: f64| radius - (radius * radius - half * half).max(0.0).sqrt();
    half - told <= ROUNDED_OFF * half && (height(told) - height(radius)).abs() <= tolerance
}

/// Indices of the coordinates of a plane, so that the first turns to the second counter-clockwise about the third.
pub(crate) fn plane_axes(plane: ArcPlane) -> [usize; 3] {
    match plane {
        ArcPlane::Xy => [0, 1, 2],
        ArcPlane::Zx => [2, 0, 1],
        ArcPlane::Yz => [1, 2, 0],
    }
}

/// Fits one arc through all `points`, the first being the start. `center` is that of a circle record.
///
/// # Errors
/// The largest deviation when the points are off every such arc (infinite when they have no arc's shape).
pub(crate) fn fit(
    points: &[Vec3],
    plane: ArcPlane,
    center: Option<Vec3>,
    limits: &ArcLimits<'_>,
) -> Result<Arc, f64> {
    let least = if center.is_some() { 3 } else { limits.least_points.max(4) };
    if points.len() < least || limits.patience.ends_after(1) {
        return Err(f64::INFINITY);
    }
    let [u, v, w] = plane_axes(plane);
    let flat: Vec<[f64; 2]> = points.iter().map(|point| [point[u], point[v]]).collect();
    let (start, end) = (flat[0], flat[flat.len() - 1]);
    let full_turn = start == end;
    let middle = match center {
        Some(center) if full_turn => [center[u], center[v]],
        Some(center) => on_bisector(start, end, [center[u], center[v]]),
        None if full_turn => return Err(f64::INFINITY),
        None => center_of_run(&flat, limits.patience).ok_or(f64::INFINITY)?,
    };
    let radius = distance(start, middle);
    if !(limits.least_radius..=limits.greatest_radius).contains(&radius) {
        return Err(f64::INFINITY);
    }
    let mut worst = 0.0_f64;
    for (done, point) in flat.iter().enumerate() {
        worst = worst.max((distance(*point, middle) - radius).abs());
        if limits.patience.ends_among(done, POSITIONS_A_UNIT) {
            return Err(f64::INFINITY);
        }
    }
    if worst > limits.tolerance || worst.is_nan() {
        return Err(worst);
    }
    let angles = swept_angles(&flat, middle, limits.patience).ok_or(f64::INFINITY)?;
    let sweep = angles.last().copied().unwrap_or(0.0).abs();
    let full = full_turn && (sweep - TAU).abs() < 1.0;
    // Each place is off its own by half a resolution along both axes at most, and turns by as much; two of them make an angle.
    let rounded = SQRT_2 * limits.resolution / radius;
    if full_turn != full || sweep > limits.sweep + rounded {
        return Err(f64::INFINITY);
    }
    let nearly_met = distance(start, end) < NEAR_RESOLUTIONS * limits.resolution;
    if !full_turn && nearly_met && sweep > NEAR_FULL_TURN {
        return Err(f64::INFINITY);
    }
    if center.is_none() {
        check_chords(&flat, radius, limits)?;
    }
    check_third_axis(points, w, &angles, rounded, limits)?;
    let mut place = points[0];
    (place[u], place[v]) = (middle[0], middle[1]);
    Ok(Arc { center: place, counterclockwise: angles.last().copied().unwrap_or(0.0) > 0.0, full_turn })
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The point nearest to `near` that is equally far from both ends.
pub(crate) fn on_bisector(start: [f64; 2], end: [f64; 2], near: [f64; 2]) -> [f64; 2] {
    let chord = [end[0] - start[0], end[1] - start[1]];
    let square = chord[0] * chord[0] + chord[1] * chord[1];
    if square == 0.0 {
        return near;
    }
    let middle = [(start[0] + end[0]) / 2.0, (start[1] + end[1]) / 2.0];
    let along = ((near[0] - middle[0]) * chord[0] + (near[1] - middle[1]) * chord[1]) / square;
    [near[0] - along * chord[0], near[1] - along * chord[1]]
}

/// The centre on the bisector of the ends that the inner points ask for; the median, so that one of them cannot
/// pull it away.
fn center_of_run(points: &[[f64; 2]], patience: Patience<'_>) -> Option<[f64; 2]> {
    let (start, end) = (points[0], points[points.len() - 1]);
    let length = distance(start, end);
    if length == 0.0 {
        return None;
    }
    let middle = [(start[0] + end[0]) / 2.0, (start[1] + end[1]) / 2.0];
    let normal = [-(end[1] - start[1]) / length, (end[0] - start[0]) / length];
    let mut heights: Vec<f64> = Vec::with_capacity(points.len() - 2);
    for (done, point) in points[1..points.len() - 1].iter().enumerate() {
        let arm = [point[0] - middle[0], point[1] - middle[1]];
        let across = arm[0] * normal[0] + arm[1] * normal[1];
        let height = (arm[0] * arm[0] + arm[1] * arm[1] - length * length / 4.0) / (2.0 * across);
        // A point on the chord itself: the run is straight there.
        if !height.is_finite() || patience.ends_among(done, POSITIONS_A_UNIT) {
            return None;
        }
        heights.push(height);
    }
    let middle_height = heights.len() / 2;
    if heights.is_empty() {
        return None;
    }
    let (_, &mut height, _) = heights.select_nth_unstable_by(middle_height, f64::total_cmp);
    Some([middle[0] + height * normal[0], middle[1] + height * normal[1]])
}

/// Angle from the start to every point, signed; none when the points do not go round in one sense.
fn swept_angles(points: &[[f64; 2]], center: [f64; 2], patience: Patience<'_>) -> Option<Vec<f64>> {
    let mut angles = Vec::with_capacity(points.len());
    let mut sum = 0.0;
    angles.push(sum);
    for (done, pair) in points.windows(2).enumerate() {
        let a = [pair[0][0] - center[0], pair[0][1] - center[1]];
        let b = [pair[1][0] - center[0], pair[1][1] - center[1]];
        let step = (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
        let reversed = sum != 0.0 && step.signum() != f64::signum(sum);
        let given_up = patience.ends_among(done, POSITIONS_A_UNIT);
        if step == 0.0 || reversed || step.abs() > LARGEST_CHORD_ANGLE || given_up {
            return None;
        }
        sum += step;
        angles.push(sum);
    }
    Some(angles)
}

/// Points alone cannot tell an arc from a coarse polygon: no chord may be further from the arc than chords were made.
fn check_chords(points: &[[f64; 2]], radius: f64, limits: &ArcLimits<'_>) -> Result<(), f64> {
    let longest = points.windows(2).map(|pair| distance(pair[0], pair[1])).fold(0.0, f64::max);
    let half = longest / 2.0;
    if half > radius {
        return Err(f64::INFINITY);
    }
    // r − √(r² − h²) in the form that keeps its digits for short chords.
    let sagitta = half * half / (radius + (radius * radius - half * half).sqrt());
    if sagitta <= limits.chord_tolerance + limits.tolerance { Ok(()) } else { Err(sagitta) }
}

/// Whether the third axis rises as the angle grows. An angle between rounded places is off by as much as `rounded`, and so are the
/// heights at both.
fn check_third_axis(
    points: &[Vec3],
    axis: usize,
    angles: &[f64],
    rounded: f64,
    limits: &ArcLimits<'_>,
) -> Result<(), f64> {
    let start = points[0][axis];
    let rise = points[points.len() - 1][axis] - start;
    let whole = angles.last().copied().unwrap_or(0.0);
    if !limits.helix && rise.abs() > limits.resolution {
        return Err(f64::INFINITY);
    }
    let off = |(point, angle): (&Vec3, &f64)| (point[axis] - start - rise * angle / whole).abs();
    let worst = points.iter().zip(angles).map(off).fold(0.0, f64::max);
    let unsure = 2.0 * rounded * (rise / whole).abs();
    if worst <= limits.height_tolerance + unsure { Ok(()) } else { Err(worst) }
}

/// The longest arc from the start of a run: how many points after the start it takes in. Doubling, then halving. Of a circle that
/// a record states it leaves no rest that is too short for an arc.
pub(crate) fn longest(
    points: &[Vec3],
    plane: ArcPlane,
    center: Option<Vec3>,
    limits: &ArcLimits<'_>,
) -> Option<(usize, Arc)> {
    let least = if center.is_some() { 2 } else { limits.least_points.max(4) - 1 };
    let last = points.len().checked_sub(1)?;
    let try_to = |count: usize| fit(&points[..=count], plane, center, limits).ok().map(|arc| (count, arc));
    if last < least {
        return None;
    }
    let mut best = try_to(least)?;
    let mut fails = last + 1;
    let mut step = least;
    while best.0 < last {
        let next = (best.0 + step).min(last);
        match try_to(next) {
            Some(found) => best = found,
            None => {
                fails = next;
                break;
            }
        }
        step *= 2;
    }
    while fails - best.0 > 1 && best.0 < last {
        let next = best.0 + (fails - best.0) / 2;
        match try_to(next) {
            Some(found) => best = found,
            None => fails = next,
        }
    }
    let rest = last - best.0;
    if center.is_some() && (1..least).contains(&rest) {
        let shorter = (best.0 + rest).checked_sub(least).filter(|count| *count >= least);
        return shorter.and_then(try_to).or(Some(best));
    }
    Some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits() -> ArcLimits<'static> {
        ArcLimits {
            tolerance: 1e-3,
            height_tolerance: 1e-3,
            chord_tolerance: 0.05,
            least_radius: 0.01,
            greatest_radius: 1e4,
            sweep: TAU,
            helix: true,
            resolution: 1e-4,
            least_points: 4,
            patience: Patience::default(),
        }
    }

    fn turned(center: [f64; 2], radius: f64, from: f64, to: f64, count: usize, rise: f64) -> Vec<Vec3> {
        (0..=count)
            .map(|step| {
                let part = step as f64 / count as f64;
                let (sine, cosine) = (from + (to - from) * part).sin_cos();
                Vec3::new(center[0] + radius * cosine, center[1] + radius * sine, rise * part)
            })
            .collect()
    }

    #[test]
    fn five_points_of_a_quarter() {
        let points = turned([2.0, 2.0], 2.0, PI, 1.5 * PI, 4, 0.0);
        let arc = fit(&points, ArcPlane::Xy, None, &limits()).unwrap();
        assert!((arc.center - Vec3::new(2.0, 2.0, 0.0)).norm() < 1e-12);
        assert!(arc.counterclockwise && !arc.full_turn);
        // The same points as corners of a polygon that nothing says is round.
        let strict = ArcLimits { chord_tolerance: 0.0, ..limits() };
        assert!(fit(&points, ArcPlane::Xy, None, &strict).is_err());
        assert!(fit(&points, ArcPlane::Xy, Some(Vec3::new(2.0, 2.0, 0.0)), &strict).is_ok());
    }

    #[test]
    fn a_steep_helix_with_rounded_places_is_one_arc() {
        for step in 0..50 {
            let from = f64::from(step) * 0.1;
            let center = [1.234_567_8, 2.345_678_9];
            let mut points = turned(center, 0.6, from, from + 1.5, 9, 14.0);
            for point in &mut points {
                *point = point.map(|value| (value * 1e3).round() / 1e3);
            }
            let limits = ArcLimits { resolution: 1e-3, tolerance: 0.05, height_tolerance: 0.01, ..limits() };
            let center = Vec3::new(center[0], center[1], 0.0);
            let found = longest(&points, ArcPlane::Xy, Some(center), &limits);
            assert_eq!(found.map(|(count, _)| count), Some(9), "{from}");
        }
    }

    #[test]
    fn full_turns_need_a_circle_record() {
        let mut points = turned([0.0, 0.0], 5.0, 0.0, -TAU, 36, 1.5);
        points[36] = Vec3::new(5.0, 0.0, 1.5);
        let arc = fit(&points, ArcPlane::Xy, Some(Vec3::zeros()), &limits()).unwrap();
        assert!(arc.full_turn && !arc.counterclockwise);
        assert!(fit(&points, ArcPlane::Xy, None, &limits()).is_err());
    }

    #[test]
    fn arcs_end_where_the_circle_ends() {
        let mut points = turned([0.0, 0.0], 5.0, 0.0, 1.0, 20, 0.0);
        let end = points[20];
        points.extend((1..20).map(|step| end + Vec3::new(-0.8, 0.6, 0.0) * f64::from(step)));
        let (count, _) = longest(&points, ArcPlane::Xy, None, &limits()).unwrap();
        assert_eq!(count, 20);
        let uneven: Vec<Vec3> = turned([0.0, 0.0], 5.0, 0.0, 1.0, 20, 0.0)
            .into_iter()
            .map(|p| Vec3::new(p.x, p.y, p.x * p.x))
            .collect();
        assert!(fit(&uneven, ArcPlane::Xy, None, &limits()).is_err());
    }

    #[test]
    fn planes_turn_the_right_way() {
        for (plane, axis) in [(ArcPlane::Xy, Vec3::z()), (ArcPlane::Zx, Vec3::y()), (ArcPlane::Yz, Vec3::x())]
        {
            let [u, v, w] = plane_axes(plane);
            let (mut first, mut second) = (Vec3::zeros(), Vec3::zeros());
            (first[u], second[v]) = (1.0, 1.0);
            assert_eq!(first.cross(&second), axis);
            assert_eq!(axis[w], 1.0);
        }
    }

    #[test]
    fn a_circle_is_divided_so_that_each_part_is_an_arc() {
        let points = turned([0.0, 0.0], 5.0, 0.0, TAU, 11, 0.0);
        let halves = ArcLimits { sweep: PI, ..limits() };
        let mut parts = Vec::new();
        let mut rest = points.as_slice();
        while let Some((count, _)) = longest(rest, ArcPlane::Xy, Some(Vec3::zeros()), &halves) {
            parts.push(count);
            rest = &rest[count..];
        }
        assert_eq!((parts, rest.len()), (vec![5, 4, 2], 1));
    }

    #[test]
    fn ends_that_are_rounded_take_nothing_from_a_half_circle() {
        for step in 0..50 {
            let from = f64::from(step) * 0.1;
            let center = [1.234_567_8, 2.345_678_9];
            let mut points = turned(center, 5.0, from, from + PI, 12, 0.0);
            for point in &mut points {
                *point = point.map(|value| (value * 1e4).round() / 1e4);
            }
            let halves = ArcLimits { sweep: PI, ..limits() };
            let center = Vec3::new(center[0], center[1], 0.0);
            let (count, _) = longest(&points, ArcPlane::Xy, Some(center), &halves).unwrap();
            assert_eq!(count, 12, "{from}");
        }
    }
}
