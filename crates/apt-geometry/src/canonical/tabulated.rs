//! Where the directrix of a tabulated cylinder is not smooth.

use super::{Interval, TabulatedCylinder};

/// What the ends of two neighbouring intervals of a directrix have between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// Number of the data point, from 1.
    pub point: usize,
    /// Turn of the direction of the curve, in degrees from 0 to 180; 180 is a reversal.
    pub corner: f64,
    /// Jump of the curvature, one over part-program units, without sign.
    pub curvature_jump: f64,
    /// The shorter of the two chords, in part-program units.
    pub chord: f64,
}

impl TabulatedCylinder {
    /// The joints at the data points, in order.
    pub fn joints(&self) -> Vec<Joint> {
        let ends = self.intervals.iter().skip(1).map(|next| [next.u, next.v]).chain([self.last]);
        let pieces: Vec<(&Interval, f64)> = self
            .intervals
            .iter()
            .zip(ends)
            .map(|(interval, end)| (interval, (end[1] - interval.v).atan2(end[0] - interval.u)))
            .collect();
        let joint = |(index, pair): (usize, &[(&Interval, f64)])| {
            let [(before, heading_before), (after, heading_after)] = pair else { return None };
            // An extension of no length, of a curve that ends where it begins, has no direction.
            if before.length <= 0.0 || after.length <= 0.0 {
                return None;
            }
            let (ending, starting) = (before.slope(before.length), after.slope(0.0));
            let turn = (heading_after + starting.atan()) - (heading_before + ending.atan());
            Some(Joint {
                point: index + 1,
                corner: turn.sin().atan2(turn.cos()).to_degrees().abs(),
                curvature_jump: (after.curvature(0.0) - before.curvature(before.length)).abs(),
                chord: before.length.min(after.length),
            })
        };
        pieces.windows(2).enumerate().filter_map(joint).collect()
    }
}

impl Interval {
    /// Slope of the curve against its chord at the station `s` along it.
    fn slope(&self, s: f64) -> f64 {
        3.0 * self.a * s * s + 2.0 * self.b * s - (self.a * self.length + self.b) * self.length
    }

    /// Curvature of the curve, positive to the left of the chord.
    fn curvature(&self, s: f64) -> f64 {
        let slope = self.slope(s);
        (6.0 * self.a * s + 2.0 * self.b) / (1.0 + slope * slope).powf(1.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;

    fn interval(u: f64, v: f64, b: f64, length: f64) -> Interval {
        Interval { u, v, a: 0.0, b, length, maximum: 0.0, minimum: 0.0 }
    }

    #[test]
    fn joints_tell_corners_and_jumps_of_curvature() {
        // Straight, a quarter turn, straight, then a parabola that leaves its chord at 45 degrees.
        let curve = TabulatedCylinder {
            axes: [Vec3::x(), Vec3::y(), Vec3::z()],
            kind: 0.0,
            intervals: vec![
                interval(0.0, 0.0, 0.0, 2.0),
                interval(2.0, 0.0, 0.0, 3.0),
                interval(2.0, 3.0, -0.25, 4.0),
            ],
            last: [2.0, 7.0],
        };
        let joints = curve.joints();
        assert_eq!(joints.iter().map(|joint| joint.point).collect::<Vec<_>>(), [1, 2]);
        assert!((joints[0].corner - 90.0).abs() < 1e-12 && joints[0].curvature_jump == 0.0);
        assert_eq!((joints[0].chord, joints[1].chord), (2.0, 3.0));
        assert!((joints[1].corner - 45.0).abs() < 1e-12);
        assert!((joints[1].curvature_jump - 0.5 / 2f64.powf(1.5)).abs() < 1e-12);
        let mut with_no_extension = curve;
        with_no_extension.intervals.insert(0, interval(0.0, 0.0, 0.0, 0.0));
        let joints = with_no_extension.joints();
        assert_eq!(joints.iter().map(|joint| joint.point).collect::<Vec<_>>(), [2, 3]);
    }
}
