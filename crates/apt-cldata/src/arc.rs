//! Which way a motion goes along the circle that stands before it.
//!
//! The binary tape holds the drive surface before the points of a motion along it; the tool ends go about its axis at the distance of the
//! surface and the cutter. CL text of CAM systems states the circle on which the tool ends lie themselves. Both are one thing here: points
//! that keep their distance from the axis of a circle.

use std::f64::consts::PI;

use apt_geometry::Vec3;

use crate::{
    geometry::SpaceCircle,
    record::{ClKind, ClPoint, ClWord},
};

/// Distance from a circle, relative to its radius, within which a point belongs to it.
pub(crate) const ON_CIRCLE_FRACTION: f64 = 1e-3;
/// Distance, relative to the radius, within which two points of an arc are one.
pub(crate) const SAME_POINT_FRACTION: f64 = 1e-9;
/// A chord that turns more than this about the centre, radians, does not tell which way round it goes.
const LARGEST_CHORD_ANGLE: f64 = 0.75 * PI;
/// Sine of the angle within which two unit axes are one: what nine decimals leave of it.
const SAME_AXIS: f64 = 1e-8;

/// The tolerances that a file tells on its way, in its unit.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Tolerance {
    inside: f64,
    outside: f64,
}

impl Tolerance {
    /// Takes what a record says.
    pub(crate) fn take(&mut self, kind: &ClKind) {
        let ClKind::Control { word, arguments, .. } = kind else { return };
        let greatest = arguments.iter().fold(0.0, |most: f64, argument| match argument {
            ClWord::Number(value) if value.is_finite() => most.max(*value),
            _ => most,
        });
        match word.as_str() {
            "INTOL" => self.inside = greatest,
            "OUTTOL" => self.outside = greatest,
            "TOLER" => (self.inside, self.outside) = (0.0, greatest),
            _ => {}
        }
    }

    /// How far the points of one motion may lie apart across its surface.
    pub(crate) fn width(self) -> f64 {
        self.inside + self.outside
    }
}

/// How far a point of a circle may be off it: what rounding of a file leaves, or the tolerance that the file tells.
pub(crate) fn slack(circle: &SpaceCircle, tolerance: f64) -> f64 {
    (circle.radius * ON_CIRCLE_FRACTION).max(tolerance)
}

/// Whether a CIRCLE before these points is read as theirs: there are several, at one distance from its axis, on the circle itself or at
/// the distance of the place before them. Before a single point a circle means the arc in the sense of its axis, which a record of the
/// drive surface does not promise.
pub(crate) fn reads_as_circle(
    circle: &SpaceCircle,
    start: Option<&Vec3>,
    points: &[ClPoint],
    tolerance: f64,
) -> bool {
    let Some(first) = points.first().filter(|_| points.len() > 1) else { return false };
    let slack = slack(circle, tolerance);
    let away = circle.deviation(&first.position);
    let expected = if away.abs() <= slack { 0.0 } else { away };
    let concentric = expected == 0.0
        || start.is_some_and(|start| (circle.deviation(start) - expected).abs() <= slack)
            && circle.radius + expected > slack;
    concentric && points.iter().all(|point| (circle.deviation(&point.position) - expected).abs() <= slack)
}

/// A motion along a circle, as far as one statement can say it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PathArc {
    /// The circle on which the tool ends lie; the tool turns about its axis by the right hand.
    pub(crate) circle: SpaceCircle,
    /// How far it turns, radians, above zero.
    pub(crate) sweep: f64,
    /// How far the points lie off the circle, at most.
    pub(crate) off: f64,
    /// How far the chords between them leave it, at most.
    pub(crate) bulge: f64,
}

/// The arc from `start` through `points`, about the axis of a circle; none where the points are no arc about it: off a common radius by more
/// than the slack, back and forth, with a rise that does not follow the turn, or with a tool axis that changes.
pub(crate) fn path_arc(
    circle: &SpaceCircle,
    start: &ClPoint,
    points: &[ClPoint],
    tolerance: f64,
) -> Option<PathArc> {
    let slack = slack(circle, tolerance);
    let last = points.last()?;
    let radius = circle.radius + circle.deviation(&start.position);
    let on = |point: &ClPoint| (circle.deviation(&point.position) - (radius - circle.radius)).abs() <= slack;
    let upright = |point: &ClPoint| point.axis.cross(&start.axis).norm() <= SAME_AXIS;
    if radius <= slack || !points.iter().all(|point| on(point) && upright(point)) {
        return None;
    }
    let mut before = start.position;
    let (mut angles, mut sum, mut widest) = (Vec::with_capacity(points.len()), 0.0_f64, 0.0_f64);
    for point in points {
        let step = circle.angle_between(&before, &point.position);
        let back = sum != 0.0 && step.signum() != sum.signum();
        if step == 0.0 || back || step.abs() > LARGEST_CHORD_ANGLE {
            return None;
        }
        sum += step;
        widest = widest.max(step.abs());
        angles.push(sum);
        before = point.position;
    }
    let height = |position: &Vec3| circle.axis.dot(&(position - start.position));
    let rise = height(&last.position) / sum;
    let level = |(point, angle): (&ClPoint, &f64)| (height(&point.position) - rise * angle).abs() <= slack;
    if !points.iter().zip(&angles).all(level) {
        return None;
    }
    // Where the tool ends lie on the circle that is stated, its own radius is the better one: it is rounded once.
    let stated = (radius - circle.radius).abs() <= slack;
    let radius = if stated { circle.radius } else { radius };
    let circle = SpaceCircle { axis: circle.axis * sum.signum(), radius, ..*circle };
    let across = |position: &Vec3| circle.deviation(position).abs();
    let off = points.iter().fold(across(&start.position), |most, point| most.max(across(&point.position)));
    Some(PathArc { circle, sweep: sum.abs(), off, bulge: radius * (1.0 - (widest / 2.0).cos()) })
}

impl PathArc {
    /// How far the arc, read back by its end alone, is from the points and the chords between them; none where it is read as these points.
    pub(crate) fn misfit(&self, start: &ClPoint, points: &[ClPoint]) -> Option<f64> {
        let end = points.last()?;
        let read = self.circle.sample(&start.position, &end.position, self.sweep);
        let same = self.circle.radius * SAME_POINT_FRACTION;
        let alike = |(one, other): (&Vec3, &ClPoint)| (one - other.position).norm() <= same;
        let exact = read.len() == points.len() && read.iter().zip(points).all(alike);
        (!exact).then(|| self.off + self.bulge.max(self.circle.sample_bulge()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(radius: f64, degrees: &[f64], rise: f64) -> Vec<ClPoint> {
        let point = |degrees: &f64| {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let position = Vec3::new(radius * cosine, radius * sine, rise * degrees);
            ClPoint { position, axis: Vec3::z(), with_axis: false }
        };
        degrees.iter().map(point).collect()
    }

    const CIRCLE: SpaceCircle =
        SpaceCircle { center: Vec3::new(0.0, 0.0, 0.0), axis: Vec3::new(0.0, 0.0, 1.0), radius: 20.0 };

    #[test]
    fn an_arc_goes_about_the_axis_at_any_distance() {
        for (radius, degrees, sense) in [(20.0, [0.0, 40.0, 90.0], 1.0), (25.0, [0.0, -40.0, -200.0], -1.0)] {
            let points = turned(radius, &degrees, 0.1);
            if degrees[2] == -200.0 {
                // A chord of 160 degrees may go either way round.
                assert_eq!(path_arc(&CIRCLE, &points[0], &points[1..], 0.0), None);
                continue;
            }
            let arc = path_arc(&CIRCLE, &points[0], &points[1..], 0.0).unwrap();
            assert!((arc.circle.radius - radius).abs() < 1e-12 && arc.circle.axis.z == sense);
            assert!((arc.sweep - 90_f64.to_radians()).abs() < 1e-12);
            assert!((arc.bulge - radius * (1.0 - 25_f64.to_radians().cos())).abs() < 1e-12);
        }
        let outside = turned(25.0, &[0.0, -40.0, -80.0], 0.0);
        let arc = path_arc(&CIRCLE, &outside[0], &outside[1..], 0.0).unwrap();
        assert!(arc.circle.axis.z == -1.0 && (arc.circle.radius - 25.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_arc_is_none() {
        let points = turned(20.0, &[0.0, 40.0, 90.0], 0.0);
        let mut off = points.clone();
        off[1].position.x += 1.0;
        let mut back = points.clone();
        back.swap(1, 2);
        let mut tilted = points.clone();
        tilted[2].axis = Vec3::new(0.6, 0.0, 0.8);
        let mut humped = points.clone();
        humped[1].position.z = 1.0;
        for points in [off, back, tilted, humped] {
            assert_eq!(path_arc(&CIRCLE, &points[0], &points[1..], 0.0), None, "{points:?}");
        }
        assert!(reads_as_circle(&CIRCLE, Some(&points[0].position), &points[1..], 0.0));
        assert!(!reads_as_circle(&CIRCLE, Some(&points[0].position), &points[2..], 0.0));
        assert!(!reads_as_circle(&CIRCLE, None, &turned(25.0, &[0.0, 40.0], 0.0), 0.0));
    }
}
