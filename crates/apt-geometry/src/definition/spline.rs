//! The splines of SCURV and SSURF: directions through points, the pace of arcs, and fairing.
//!
//! What the public system does was found from its results: the directions are those of the cubic spline over the chord
//! lengths whose end derivatives are unit vectors; each arc then takes the lengths of its end derivatives that make its
//! bending `∫|r''|²` least, but never turns a direction about; a free end has the direction of the parabola through the last three points whose axis is
//! across their long chord.

use nalgebra::{DMatrix, Matrix2, Vector2};

use super::{parametric_error::ParametricError, space_curve::ParametricNode};
use crate::{Vec3, parametric::CurveArc};

/// Least length of an end derivative, as a share of the chord. The bending alone would make it vanish where the direction
/// is across the chord, and turn it about where it points back: the curve would not run the way it is told. A quarter is
/// what the least bending gives a symmetric arc whose ends are 85 degrees off the chord, so that no flatter one changes.
const LEAST_LENGTH: f64 = 0.25;
/// Distance of two points, as a share of the extent of all, below which they coincide.
const COINCIDENT: f64 = 1e-12;

/// What is known of a node before the spline is laid through it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Condition {
    /// The direction of the curve, of any length.
    pub(super) direction: Option<Vec3>,
    /// A vector that the direction must be across.
    pub(super) across: Option<Vec3>,
}

/// Whether all points are the same place, so that the curve has no extent.
pub(super) fn is_collapsed(points: &[Vec3]) -> bool {
    let Some(first) = points.first() else { return true };
    let size = points.iter().map(Vec3::amax).fold(0.0, f64::max);
    points.iter().all(|point| (point - first).norm() <= COINCIDENT * size)
}

/// The derivatives of the spline through points by its chord length; unit vectors where they are given and at free
/// ends. A collapsed row has none: zero vectors.
///
/// # Errors
/// Fewer than two points, neighbours that coincide, a condition without length, or a direction that vanishes.
pub(super) fn directions(points: &[Vec3], conditions: &[Condition]) -> Result<Vec<Vec3>, ParametricError> {
    if points.len() < 2 {
        return Err(ParametricError::TooFew { least: 2, found: points.len() });
    }
    if is_collapsed(points) {
        return Ok(vec![Vec3::zeros(); points.len()]);
    }
    let extent = points.iter().map(|point| (point - points[0]).norm()).fold(0.0, f64::max);
    let chords: Vec<Vec3> = points.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if let Some(index) = chords.iter().position(|chord| chord.norm() <= COINCIDENT * extent) {
        return Err(ParametricError::Coincident { first: index + 1, second: index + 2 });
    }
    let mut fixed = conditions
        .iter()
        .map(|condition| condition.direction.map(|direction| unit(&direction)).transpose())
        .collect::<Result<Vec<_>, _>>()?;
    fixed.resize(points.len(), None);
    let free = solved(&chords, &fixed)?;
    let mut bound = false;
    for (index, condition) in conditions.iter().enumerate().take(points.len()) {
        let Some(across) = condition.across else { continue };
        let across = unit(&across)?;
        let direction = free.get(index).copied().unwrap_or_else(Vec3::zeros);
        fixed[index] = Some(unit(&(direction - across * across.dot(&direction)))?);
        bound = true;
    }
    if bound { solved(&chords, &fixed) } else { Ok(free) }
}

/// The unit vector along a vector.
fn unit(vector: &Vec3) -> Result<Vec3, ParametricError> {
    vector.try_normalize(f64::MIN_POSITIVE).ok_or(ParametricError::ZeroVector)
}

/// The directions with the fixed ones as they are: a tridiagonal system of continuous second derivatives.
fn solved(chords: &[Vec3], fixed: &[Option<Vec3>]) -> Result<Vec<Vec3>, ParametricError> {
    let count = chords.len() + 1;
    let lengths: Vec<f64> = chords.iter().map(Vec3::norm).collect();
    // Rows of (below, diagonal, above, right-hand side).
    let mut rows = Vec::with_capacity(count);
    for (index, given) in fixed.iter().enumerate().take(count) {
        rows.push(match given {
            Some(direction) => (0.0, 1.0, 0.0, *direction),
            None if index == 0 => (0.0, 1.0, 0.0, end_direction(chords, fixed, false)?),
            None if index + 1 == count => (0.0, 1.0, 0.0, end_direction(chords, fixed, true)?),
            None => {
                let (before, after) = (lengths[index - 1], lengths[index]);
                let value = (chords[index - 1] * (after / before) + chords[index] * (before / after)) * 3.0;
                (after, 2.0 * (before + after), before, value)
            }
        });
    }
    // Elimination without pivots: every row is diagonally dominant.
    for index in 1..count {
        let (_, pivot, above, value) = rows[index - 1];
        let row = &mut rows[index];
        let factor = row.0 / pivot;
        row.1 -= factor * above;
        row.3 -= value * factor;
    }
    let mut solution = vec![Vec3::zeros(); count];
    for index in (0..count).rev() {
        let (_, pivot, above, value) = rows[index];
        let next = solution.get(index + 1).copied().unwrap_or_else(Vec3::zeros);
        solution[index] = (value - next * above) / pivot;
    }
    Ok(solution)
}

/// The unit direction at a free end. With two points that of the chord, or the other end's direction mirrored at it.
fn end_direction(chords: &[Vec3], fixed: &[Option<Vec3>], last: bool) -> Result<Vec3, ParametricError> {
    if let [chord] = chords {
        let chord = unit(chord)?;
        let other = fixed.get(usize::from(!last)).copied().flatten();
        return Ok(other.map_or(chord, |other| chord * (2.0 * chord.dot(&other)) - other));
    }
    let count = chords.len();
    let (near, far) = if last { (-chords[count - 1], -chords[count - 2]) } else { (chords[0], chords[1]) };
    let long = near + far;
    let (mut first, mut second) = (near.dot(&long), far.dot(&long));
    // Points that turn back by more than a right angle have no such parabola: the one over the chord lengths is taken.
    if first <= 0.0 || second <= 0.0 {
        (first, second) = (near.norm(), far.norm());
    }
    let direction = near * (second * (2.0 * first + second) / (first * first)) - far;
    unit(&direction).map(|direction| if last { -direction } else { direction })
}

/// The cubic arc over a chord with end directions (of any length) whose bending `∫|r''|²` is least.
pub(super) fn bending_arc(start: &Vec3, end: &Vec3, from: &Vec3, to: &Vec3) -> CurveArc {
    let [first, last] = bending_lengths(&(end - start), from, to);
    CurveArc::from_hermite(start, end, &first, &last)
}

/// The end derivatives of that arc: of all that are at least a share of the chord long those that bend it least.
pub(super) fn bending_lengths(chord: &Vec3, from: &Vec3, to: &Vec3) -> [Vec3; 2] {
    let (Some(from), Some(to)) = (from.try_normalize(f64::MIN_POSITIVE), to.try_normalize(f64::MIN_POSITIVE))
    else {
        return [*chord; 2];
    };
    let cosine = from.dot(&to);
    let system = Matrix2::new(2.0, cosine, cosine, 2.0);
    let value = Vector2::new(chord.dot(&from), chord.dot(&to)) * 3.0;
    let least = LEAST_LENGTH * chord.norm();
    // The determinant 4 − cos² is never below 3.
    let free = system.try_inverse().map_or(Vector2::repeat(chord.norm()), |inverse| inverse * value);
    let lengths = if free.min() >= least {
        free
    } else {
        // The bending is convex, so that the least of the admitted ones has one of the lengths at its bound.
        let other = |value: f64| (0.5 * (value - cosine * least)).max(least);
        let bounded = [Vector2::new(least, other(value.y)), Vector2::new(other(value.x), least)];
        let bending = |lengths: &Vector2<f64>| 0.5 * lengths.dot(&(system * lengths)) - value.dot(lengths);
        if bending(&bounded[0]) <= bending(&bounded[1]) { bounded[0] } else { bounded[1] }
    };
    [from * lengths.x, to * lengths.y]
}

/// Points moved as fairing asks: the least sum of `w/(1−w)` times the squared displacements and the bending of the
/// natural spline over the chord lengths; a point with weight 1 stays, and none moves farther than its limit.
///
/// # Errors
/// A weight outside 0 to 1, a negative limit, or neighbours that coincide.
pub(super) fn faired(
    nodes: &[ParametricNode],
    weight: Option<f64>,
    limit: Option<f64>,
) -> Result<Vec<Vec3>, ParametricError> {
    let points: Vec<Vec3> = nodes.iter().map(|node| node.point).collect();
    let weights: Vec<f64> = nodes.iter().map(|node| node.weight.or(weight).unwrap_or(1.0)).collect();
    if let Some(&value) = weights.iter().find(|weight| !(0.0..=1.0).contains(*weight)) {
        return Err(ParametricError::OutOfRange { value, least: 0.0, greatest: 1.0 });
    }
    let limits: Vec<f64> = nodes.iter().map(|node| node.limit.or(limit).unwrap_or(f64::INFINITY)).collect();
    if let Some(&value) = limits.iter().find(|limit| **limit < 0.0 || limit.is_nan()) {
        return Err(ParametricError::OutOfRange { value, least: 0.0, greatest: f64::INFINITY });
    }
    if weights.iter().all(|weight| *weight == 1.0) || points.len() < 3 || is_collapsed(&points) {
        return Ok(points);
    }
    let bending = bending_form(&points)?;
    let count = points.len();
    // A weight of 0 leaves a point to the bending alone; a trace of it keeps a straight line of such points in its place.
    const LEAST_SPRING: f64 = 1e-12;
    let mut system = bending.clone();
    let mut values = DMatrix::<f64>::zeros(count, 3);
    for (index, (point, weight)) in points.iter().zip(&weights).enumerate() {
        if *weight == 1.0 {
            system.row_mut(index).fill(0.0);
            system[(index, index)] = 1.0;
            values.set_row(index, &point.transpose());
        } else {
            let spring = (weight / (1.0 - weight)).max(LEAST_SPRING);
            system[(index, index)] += spring;
            values.set_row(index, &(point.transpose() * spring));
        }
    }
    let solution = system.lu().solve(&values).ok_or(ParametricError::NotFinite)?;
    let moved = points.iter().zip(&limits).enumerate().map(|(index, (point, limit))| {
        let by = solution.row(index).transpose() - point;
        let way = by.norm();
        point + if way > *limit { by * (limit / way) } else { by }
    });
    Ok(moved.collect())
}

/// The form `K` with `xᵀKx` the bending of the natural cubic spline through values x over the chord lengths.
fn bending_form(points: &[Vec3]) -> Result<DMatrix<f64>, ParametricError> {
    let count = points.len();
    let lengths: Vec<f64> = points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
    let extent: f64 = lengths.iter().sum();
    if let Some(index) = lengths.iter().position(|length| *length <= COINCIDENT * extent) {
        return Err(ParametricError::Coincident { first: index + 1, second: index + 2 });
    }
    let mut differences = DMatrix::<f64>::zeros(count, count - 2);
    let mut masses = DMatrix::<f64>::zeros(count - 2, count - 2);
    for inner in 0..count - 2 {
        let (before, after) = (lengths[inner], lengths[inner + 1]);
        differences[(inner, inner)] = 1.0 / before;
        differences[(inner + 1, inner)] = -1.0 / before - 1.0 / after;
        differences[(inner + 2, inner)] = 1.0 / after;
        masses[(inner, inner)] = (before + after) / 3.0;
        if inner + 3 < count {
            masses[(inner, inner + 1)] = after / 6.0;
            masses[(inner + 1, inner)] = after / 6.0;
        }
    }
    let solved = masses.lu().solve(&differences.transpose()).ok_or(ParametricError::NotFinite)?;
    Ok(differences * solved)
}
