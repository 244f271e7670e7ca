//! Circles as they occur in a CL stream: sampling an unsegmented arc, and the angle swept about an axis.

use std::f64::consts::TAU;

use apt_geometry::Vec3;

/// Largest angle, in radians, between two points that stand for an arc that was written without inner points.
const ARC_SAMPLE_ANGLE: f64 = 5.0 * std::f64::consts::PI / 180.0;
/// What a number of steps may be above a whole number without one more being needed: one arc that is stated in two forms is sampled alike.
const STEP_ROUNDING: f64 = 1e-6;

/// The depth of a chamfer: how far down a tool with a point of this angle, in degrees, has the diameter. None of an angle
/// that is no point's.
pub fn chamfer_depth(diameter: f64, angle: f64) -> Option<f64> {
    const STRAIGHT_DEGREES: f64 = 180.0;
    let pointed = angle > 0.0 && angle < STRAIGHT_DEGREES;
    pointed.then(|| diameter / 2.0 / (angle / 2.0).to_radians().tan())
}

/// A circle in space, as a CL file states it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpaceCircle {
    /// Centre.
    pub center: Vec3,
    /// Unit axis; the right-hand rule gives the positive sense.
    pub axis: Vec3,
    /// Radius.
    pub radius: f64,
}

impl SpaceCircle {
    /// Distance of a point from the axis, minus the radius.
    pub fn deviation(&self, point: &Vec3) -> f64 {
        self.in_plane(point).norm() - self.radius
    }

    /// The part of `point − center` that lies in the plane of the circle.
    pub fn in_plane(&self, point: &Vec3) -> Vec3 {
        let arm = point - self.center;
        arm - self.axis * self.axis.dot(&arm)
    }

    /// Angle from `from` to `to` about the axis in (−π, π].
    pub fn angle_between(&self, from: &Vec3, to: &Vec3) -> f64 {
        let (start, end) = (self.in_plane(from), self.in_plane(to));
        let cross = self.axis.dot(&start.cross(&end));
        cross.atan2(start.dot(&end))
    }

    /// Counter-clockwise sweep from `from` to `to` in (0, 2π]; a full turn where the two coincide within `same`.
    pub fn positive_sweep(&self, from: &Vec3, to: &Vec3, same: f64) -> f64 {
        if (self.in_plane(from) - self.in_plane(to)).norm() <= same {
            return TAU;
        }
        let angle = self.angle_between(from, to);
        if angle <= 0.0 { angle + TAU } else { angle }
    }

    /// How far the chords between the points of [`SpaceCircle::sample`] leave the circle at most.
    pub fn sample_bulge(&self) -> f64 {
        self.radius * (1.0 - (ARC_SAMPLE_ANGLE * (1.0 + STEP_ROUNDING) / 2.0).cos())
    }

    /// Points of the arc (or helix) from `start`, which is left out, to exactly `end`, turning `sweep` radians about
    /// the axis. The part along the axis is linear in the angle.
    pub fn sample(&self, start: &Vec3, end: &Vec3, sweep: f64) -> Vec<Vec3> {
        let steps = (sweep.abs() / ARC_SAMPLE_ANGLE - STEP_ROUNDING).ceil() as usize;
        let steps = steps.clamp(1, MAXIMUM_SAMPLES);
        let arm = self.in_plane(start);
        let side = self.axis.cross(&arm);
        let rise = self.axis.dot(&(end - start));
        let base = start - arm;
        let mut points: Vec<Vec3> = (1..steps)
            .map(|step| {
                let part = step as f64 / steps as f64;
                let (sine, cosine) = (sweep * part).sin_cos();
                base + arm * cosine + side * sine + self.axis * (rise * part)
            })
            .collect();
        points.push(*end);
        points
    }
}

/// Most points that one arc is sampled into: 100 turns.
const MAXIMUM_SAMPLES: usize = 7200;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_arc_is_sampled_on_the_circle() {
        let circle = SpaceCircle { center: Vec3::new(40.0, 45.0, -3.0), axis: Vec3::z(), radius: 25.0 };
        let (start, end) = (Vec3::new(40.0, 20.0, -3.0), Vec3::new(65.0, 45.0, -3.0));
        let sweep = circle.positive_sweep(&start, &end, 1e-9);
        assert!((sweep - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        let points = circle.sample(&start, &end, sweep);
        assert_eq!(points.len(), 18);
        assert_eq!(points.last(), Some(&end));
        assert!(points.iter().all(|point| circle.deviation(point).abs() < 1e-12 && point.z == -3.0));
    }

    #[test]
    fn coinciding_ends_are_a_full_turn() {
        let circle = SpaceCircle { center: Vec3::zeros(), axis: Vec3::z(), radius: 5.0 };
        let (start, end) = (Vec3::new(5.0, 0.0, -2.0), Vec3::new(5.0, 0.0, -0.5));
        let sweep = circle.positive_sweep(&start, &end, 1e-9);
        assert_eq!(sweep, TAU);
        let points = circle.sample(&start, &end, sweep);
        assert_eq!(points.len(), 72);
        assert!((points[35] - Vec3::new(-5.0, 0.0, -1.25)).norm() < 1e-12);
    }
}
