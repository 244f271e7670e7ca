//! The beginning of a motion whose law wants another axis than the tool has: over a short way the axis turns towards that of
//! the law.
//!
//! One cut vector turns it if the tool stays in its bands all along. Where it does not, because contact wanders about the tool
//! while that turns, several vectors do, and they have to lead on.

use apt_geometry::Vec3;

use crate::error::AxisFailure;

/// Sine between opposite axes below which there is no telling about which vector to turn.
const OPPOSITE: f64 = 1e-6;

/// Least way, as a share of the run-in, that a vector goes towards its end: what is left of the turn by then is a thousandth.
const LEAST_WAY: f64 = 0.02;

/// A place about which the axis turns evenly with the distance, but for its ends, where it sets out and arrives level.
#[derive(Debug, Clone)]
pub(super) struct RunIn {
    from: Vec3,
    origin: Vec3,
    /// Distance from there at which the axis follows its law.
    length: f64,
}

impl RunIn {
    /// From an axis at a place, over a distance from there.
    pub(super) fn new(from: &Vec3, origin: &Vec3, length: f64) -> Self {
        Self { from: *from, origin: *origin, length }
    }

    /// How far a vector from a place may lead so that one ends about where the axis comes to follow its law; infinite from there on.
    pub(super) fn way_left(&self, tip: &Vec3) -> f64 {
        let away = (tip - self.origin).norm();
        if away >= self.length { f64::INFINITY } else { self.length - away + LEAST_WAY * self.length }
    }

    /// The axis at a place where the law has one.
    pub(super) fn axis(&self, to: &Vec3, tip: &Vec3) -> Result<Vec3, AxisFailure> {
        let away = (tip - self.origin).norm();
        if away >= self.length {
            return Ok(*to);
        }
        let share = away / self.length;
        let across = self.from.cross(to);
        let (sine, cosine) = (across.norm(), self.from.dot(to));
        if cosine < 0.0 && sine <= OPPOSITE {
            return Err(AxisFailure::SignUnresolved);
        }
        let Some(about) = across.try_normalize(0.0) else { return Ok(*to) };
        // Neither at its beginning nor at its end does the turn change by leaps.
        let turned = sine.atan2(cosine) * share * share * (3.0 - 2.0 * share);
        let (sin, cos) = turned.sin_cos();
        (self.from * cos + about.cross(&self.from) * sin).try_normalize(0.0).ok_or(AxisFailure::NoNormal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::v;

    #[test]
    fn the_axis_is_the_tools_own_at_first_and_that_of_the_law_from_a_distance_on() {
        let (from, to) = (Vec3::z(), v(0.6, 0.0, 0.8));
        let run_in = RunIn::new(&from, &v(1.0, 2.0, 3.0), 0.5);
        let at = |away: f64| run_in.axis(&to, &v(1.0 + 0.6 * away, 2.0 + 0.8 * away, 3.0)).unwrap();
        assert!((at(0.0) - from).norm() < 1e-15);
        assert!((at(0.5) - to).norm() < 1e-15 && (at(7.0) - to).norm() < 1e-15);
        let middle = (from + to).normalize();
        assert!((at(0.25) - middle).norm() < 1e-15);
        let (first, last) = (at(0.01), at(0.49));
        assert!(first.dot(&from) > middle.dot(&from) && last.dot(&to) > middle.dot(&to));
        assert!((first.norm() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn vectors_lead_to_its_end_and_are_not_bound_beyond() {
        let run_in = RunIn::new(&Vec3::z(), &v(1.0, 2.0, 3.0), 0.5);
        let left = |x: f64| run_in.way_left(&v(x, 2.0, 3.0));
        assert!((left(1.0) - 0.51).abs() < 1e-15 && (left(1.3) - 0.21).abs() < 1e-15);
        assert!((left(1.499) - 0.011).abs() < 1e-15 && left(1.5) == f64::INFINITY);
    }

    #[test]
    fn between_opposite_axes_there_is_no_way() {
        let run_in = RunIn::new(&Vec3::z(), &Vec3::zeros(), 1.0);
        assert_eq!(run_in.axis(&-Vec3::z(), &v(0.5, 0.0, 0.0)), Err(AxisFailure::SignUnresolved));
        assert_eq!(run_in.axis(&Vec3::z(), &v(0.5, 0.0, 0.0)), Ok(Vec3::z()));
    }
}
