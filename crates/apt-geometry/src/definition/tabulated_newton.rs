//! Tangents of continuous curvature by Newton steps on all points at once.
//!
//! APT III turns one tangent at a time, the worst first. On data that swing from side to side that may run away: a
//! tangent that stands on its chord has no curvature there, which passes for a solution. Here all tangents move
//! together, and a step is taken only as far as it lowers the sum of the squared jumps.

use super::tabulated_curve::Chord;
use crate::Vec3;

/// Angle between a tangent and its chord, in radians (75 degrees), beyond which more turning makes less curvature: no
/// spline bends that far between two points.
pub(super) const STEEPEST: f64 = 1.308_996_938_995_747;
/// Newton steps at most; the convergence is quadratic once it is near.
const STEPS: usize = 60;
/// Halvings of a step at most.
const HALVINGS: usize = 30;
/// Turn by which derivatives are measured, in radians: the cube root of the rounding, for a central difference.
const MEASURED_TURN: f64 = 6e-6;
/// Jump of curvature, times the length of a chord, that ends the search.
const ENOUGH: f64 = 1e-11;

/// The tangents as angles, the free ends following their neighbours.
struct Tangents<'a> {
    chords: &'a [Chord],
    given: &'a [Option<Vec3>],
    /// Angles of the chords with the u axis.
    headings: Vec<f64>,
    /// Points whose tangents are to be found.
    free: Vec<usize>,
}

/// Unit directions at all points with continuous curvature at the free inner ones, looked for from `start`; `None`
/// when the search finds none.
pub(super) fn continuous(chords: &[Chord], given: &[Option<Vec3>], start: &[Vec3]) -> Option<Vec<Vec3>> {
    let headings = chords.iter().map(|chord| chord.along.y.atan2(chord.along.x)).collect();
    let free = (1..chords.len()).filter(|index| given.get(*index).is_some_and(Option::is_none)).collect();
    let tangents = Tangents { chords, given, headings, free };
    let mut angles: Vec<f64> = start.iter().map(|direction| direction.y.atan2(direction.x)).collect();
    tangents.follow(&mut angles);
    let mut jumps = tangents.jumps(&angles)?;
    for _ in 0..STEPS {
        if jumps.iter().all(|jump| jump.abs() <= ENOUGH) {
            return Some(angles.iter().map(|angle| Vec3::new(angle.cos(), angle.sin(), 0.0)).collect());
        }
        let step = tangents.step(&angles, &jumps)?;
        let (next, next_jumps) = tangents.descend(&angles, &step, squares(&jumps))?;
        (angles, jumps) = (next, next_jumps);
    }
    None
}

/// The measure that a Newton step, taken short enough, always lowers.
fn squares(jumps: &[f64]) -> f64 {
    jumps.iter().map(|jump| jump * jump).sum()
}

impl Tangents<'_> {
    /// Free ends mirror their neighbour in the chord, which makes the end interval a parabola.
    fn follow(&self, angles: &mut [f64]) {
        let last = self.chords.len();
        let mirrored = |heading: f64, angle: f64| 2.0 * heading - angle;
        if self.given.first().is_some_and(Option::is_none)
            && let (Some(heading), Some(neighbour)) = (self.headings.first(), angles.get(1).copied())
            && let Some(end) = angles.first_mut()
        {
            *end = mirrored(*heading, neighbour);
        }
        if self.given.get(last).is_some_and(Option::is_none)
            && let (Some(heading), Some(neighbour)) =
                (self.headings.last(), angles.get(last.wrapping_sub(1)).copied())
            && let Some(end) = angles.get_mut(last)
        {
            *end = mirrored(*heading, neighbour);
        }
    }

    /// Slope of the tangent at a point against a chord; `None` when it is steeper than a spline can be.
    fn slope(&self, angles: &[f64], point: usize, chord: usize) -> Option<f64> {
        let lean = angles.get(point)? - self.headings.get(chord)?;
        let lean = lean.sin().atan2(lean.cos());
        (lean.abs() < STEEPEST).then(|| lean.tan())
    }

    /// Curvature after an inner point less that before it, times the mean length of the chords.
    fn jump(&self, angles: &[f64], point: usize) -> Option<f64> {
        let (before, after) = (self.chords.get(point.checked_sub(1)?)?, self.chords.get(point)?);
        let (start, end) = (self.slope(angles, point - 1, point - 1)?, self.slope(angles, point, point - 1)?);
        let (next, far) = (self.slope(angles, point, point)?, self.slope(angles, point + 1, point)?);
        let behind = (2.0 * start + 4.0 * end) / (before.length * (1.0 + end * end).powf(1.5));
        let ahead = -(4.0 * next + 2.0 * far) / (after.length * (1.0 + next * next).powf(1.5));
        Some((ahead - behind) * 0.5 * (before.length + after.length))
    }

    fn jumps(&self, angles: &[f64]) -> Option<Vec<f64>> {
        self.free.iter().map(|point| self.jump(angles, *point)).collect()
    }

    /// Derivative of the jump at one point for a turn at another one.
    fn derivative(&self, angles: &mut [f64], of: usize, by: usize) -> Option<f64> {
        let here = *angles.get(by)?;
        let mut measure = |turn: f64| {
            *angles.get_mut(by)? = here + turn;
            self.follow(angles);
            self.jump(angles, of)
        };
        let (ahead, behind) = (measure(MEASURED_TURN), measure(-MEASURED_TURN));
        *angles.get_mut(by)? = here;
        self.follow(angles);
        Some((ahead? - behind?) / (2.0 * MEASURED_TURN))
    }

    /// The Newton step: a tridiagonal system, because a jump depends on a point and its neighbours.
    fn step(&self, angles: &[f64], jumps: &[f64]) -> Option<Vec<f64>> {
        let mut angles = angles.to_vec();
        let neighbour = |point: usize, other: Option<&usize>, distance: isize| {
            other.is_some_and(|other| point.checked_add_signed(distance) == Some(*other))
        };
        // Elimination downwards: `upper` and `right` of the rows above.
        let mut rows: Vec<(f64, f64)> = Vec::with_capacity(self.free.len());
        for (row, point) in self.free.iter().enumerate() {
            let mut diagonal = self.derivative(&mut angles, *point, *point)?;
            let mut right = -jumps.get(row)?;
            if row > 0 && neighbour(*point, self.free.get(row - 1), -1) {
                let lower = self.derivative(&mut angles, *point, point - 1)?;
                let (upper_above, right_above) = *rows.get(row - 1)?;
                diagonal -= lower * upper_above;
                right -= lower * right_above;
            }
            let upper = if neighbour(*point, self.free.get(row + 1), 1) {
                self.derivative(&mut angles, *point, point + 1)?
            } else {
                0.0
            };
            if diagonal == 0.0 || !diagonal.is_finite() {
                return None;
            }
            rows.push((upper / diagonal, right / diagonal));
        }
        let mut step = vec![0.0; rows.len()];
        let mut below = 0.0;
        for (value, (upper, right)) in step.iter_mut().zip(&rows).rev() {
            below = right - upper * below;
            *value = below;
        }
        Some(step)
    }

    /// The step, halved until the jumps are less than they were.
    fn descend(&self, angles: &[f64], step: &[f64], before: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let mut next = angles.to_vec();
            for (point, turn) in self.free.iter().zip(step) {
                *next.get_mut(*point)? += part * turn;
            }
            self.follow(&mut next);
            if let Some(jumps) = self.jumps(&next)
                && squares(&jumps) < before
            {
                return Some((next, jumps));
            }
            part *= 0.5;
        }
        None
    }
}
