//! What is shown of a circle of the tool inside a convex hollow, where distance is concave: it is least at a corner of whatever holds an arc.

use apt_geometry::Vec3;

use super::{AZIMUTHS, Search};
use crate::verify::{tool::Meridian, trough::meeting};

/// Arcs examined per circle by branch and bound; the gap left then is the error term.
const ARC_BUDGET: usize = 400;
/// Halvings of the arc of the corner for a bound of its places: an arc of a right angle lies within a millionth of its radius in what is
/// left.
const ARC_HALVINGS: u32 = 9;

impl Search<'_> {
    /// Takes into account how much nearer than the best candidate a circle could be for all that is known inside a convex hollow.
    pub(super) fn prove_circle(&mut self, p: Meridian, radius: f64) -> Option<()> {
        let lowest = self.lowest_on_circle(p, radius, true)?;
        self.gap = self.gap.max(self.best_value() - lowest);
        Some(())
    }

    /// Inside a convex hollow no place of a circle is nearer than the best candidate or than this: the arc between two samples lies
    /// in the triangle with the meeting point of its tangents, and a concave function is least at a corner of it. Places of a circle of the
    /// tool are candidates.
    pub(super) fn lowest_on_circle(&mut self, p: Meridian, radius: f64, is_of_tool: bool) -> Option<f64> {
        let (at_axis, _) = self.distance(&self.place([0.0, p[1]], 0.0))?;
        if p[0] <= 0.0 {
            return Some(at_axis - radius);
        }
        if at_axis - p[0] - radius >= self.best_value() {
            return Some(f64::INFINITY);
        }
        let step = std::f64::consts::TAU / AZIMUTHS as f64;
        let slack = 1e-12 * self.tool.profile.reach();
        let mut arcs = Vec::with_capacity(2 * AZIMUTHS);
        let mut least = f64::INFINITY;
        for k in 0..AZIMUTHS {
            let phi = step * k as f64;
            let (first, is_told) = self.of_circle(p, phi, radius)?;
            least = if is_told { least.min(first - radius) } else { least };
            arcs.push((phi, first, step, self.on_circle(p, phi + step)?.0));
        }
        let mut lowest = f64::INFINITY;
        let mut budget = ARC_BUDGET;
        while let Some((phi, first, width, last)) = arcs.pop() {
            let half = 0.5 * width;
            let corner = [p[0] / half.cos(), p[1]];
            let (at_corner, normal) = self.distance(&self.place(corner, phi + half))?;
            let mut bound = first.min(last).min(at_corner) - radius;
            let is_no_nearer = |search: &Self, bound: f64| search.best_value() - bound <= slack;
            if !is_no_nearer(self, bound)
                && radius > 0.0
                && !self.fan_near(&normal, phi + half, half)
                && let Some(of_arc) = self.lowest_of_arc((p, radius), phi, half)?
            {
                bound = bound.max(of_arc);
            }
            if is_no_nearer(self, bound) {
                continue;
            }
            // Of a circle that is nearer no more is told than how near it is.
            if budget == 0 || least - bound <= slack {
                lowest = lowest.min(bound);
                continue;
            }
            budget -= 1;
            let (middle, is_told) = self.of_circle(p, phi + half, radius)?;
            least = if is_told { least.min(middle - radius) } else { least };
            if is_of_tool && middle - radius < self.best_value() {
                self.accept(p, phi + half, radius)?;
            }
            arcs.push((phi, first, half, middle));
            arcs.push((phi + half, middle, half, last));
        }
        Some(lowest)
    }

    /// The distance of a place of a circle, and whether the ball round it touches with a place of the corner: one that does not tells nothing of how
    /// near the tool is.
    fn of_circle(&self, p: Meridian, phi: f64, radius: f64) -> Option<(f64, bool)> {
        let (value, normal) = self.distance(&self.place(p, phi))?;
        Some((value, radius == 0.0 || self.fan_near(&normal, phi, 0.0)))
    }

    /// Inside a convex hollow no place of the corner in a sector of this half is nearer: the arc lies in the triangle of its ends and of where
    /// its tangents there meet, and turned about the axis each of them in another triangle. The arc is halved while that meeting decides, for where
    /// the nearest place is an end of it the surface may lie hardly steeper there than the arc. None where these tangents do not meet.
    fn lowest_of_arc(&self, (center, radius): (Meridian, f64), phi: f64, half: f64) -> Option<Option<f64>> {
        let [lower, upper, _] = self.tool.profile.edges();
        let over = |[rho, height]: Meridian| -> Option<f64> {
            let mut lowest = f64::INFINITY;
            for (rho, azimuth) in [(rho, phi), (rho / half.cos(), phi + half), (rho, phi + 2.0 * half)] {
                lowest = lowest.min(self.distance(&self.place([rho, height], azimuth))?.0);
            }
            Some(lowest)
        };
        let mut lowest = over(lower)?.min(over(upper)?);
        let mut open = vec![([lower, upper], ARC_HALVINGS)];
        while let Some((ends, halvings)) = open.pop() {
            let Some(outer) = meeting(ends, center, radius) else { return Some(None) };
            let beyond = over(outer)?;
            if beyond >= lowest.min(self.best_value()) {
                continue;
            }
            if halvings == 0 {
                lowest = beyond;
                continue;
            }
            let middle = middle_of_arc(ends, center, radius);
            lowest = lowest.min(over(middle)?);
            open.extend([([middle, ends[1]], halvings - 1), ([ends[0], middle], halvings - 1)]);
        }
        Some(Some(lowest))
    }

    /// Whether a ball contact with about this normal could be on the corner arc, if normals turned no more than the azimuth does. They may turn
    /// by any angle where the hollow is narrow, so this proves nothing: it tells which of two bounds is worth looking at.
    fn fan_near(&self, normal: &Vec3, phi: f64, turn: f64) -> bool {
        let height = -normal.dot(&self.tool.axis);
        let outward = -normal.dot(&self.radial(phi));
        let reach = turn + 1e-6;
        [-reach, 0.0, reach].iter().any(|d| {
            let (s, c) = d.sin_cos();
            self.tool.profile.fan_holds([(outward * c - height * s).max(0.0), outward * s + height * c])
        })
    }
}

/// The place of an arc half way between two others that are less than half a turn apart.
fn middle_of_arc(ends: [Meridian; 2], center: Meridian, radius: f64) -> Meridian {
    let [a, b] = ends.map(|end| [end[0] - center[0], end[1] - center[1]]);
    let sum = [a[0] + b[0], a[1] + b[1]];
    let length = sum[0].hypot(sum[1]);
    [0, 1].map(|k| center[k] + radius * sum[k] / length)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::verify::{
        clearance::Surface,
        tests::{cutter, quadric},
        tool::{Profile, Tool},
    };

    /// Places that are looked at along the arc, and about the axis.
    const PLACES: u32 = 12;

    /// The bottom of a lens, where its corner begins, is nearest to a wall that lies hardly steeper there than the corner.
    #[test]
    fn what_is_nearest_beside_the_corner_is_proven() {
        let form = quadric([-0.03328, -0.03856, 0.0, 0.5589, 0.0, 0.0, 0.09885, -0.1642, -0.28956, 0.0]);
        let Surface::Quadric(form) = Surface::of(&form).unwrap() else { panic!("a quadric") };
        let profile = Profile::of(&cutter(&[1.0, 0.1875, 0.33, 0.22, 5.83, 5.0, 4.1786])).unwrap();
        let tool = Tool::new(&profile, Vec3::new(-0.67305, -0.73768, -0.05319).normalize());
        for tip in [[1.15525, 0.22373, 0.79012], [1.14687, 0.23631, 0.4867], [1.12898, 0.262, 0.28241]] {
            let reading = super::super::at(&form, 1.0, &Vec3::from(tip), &tool).unwrap();
            assert!(reading.error < 1e-9, "{reading:?}");
        }
    }

    proptest! {
        /// In ellipsoids narrower than the tool, too, where the place that is nearest jumps from one side to the other.
        #[test]
        fn no_place_of_an_arc_of_the_corner_is_nearer_than_its_bound(
            squares in [0.2..20.0f64, 0.2..20.0f64, 0.2..20.0f64], tip in prop::array::uniform3(-0.5..0.5f64),
            axis in prop::array::uniform3(-1.0..1.0f64), (phi, half) in (0.0..6.0f64, 0.01..0.2f64), shape in 0usize..3,
        ) {
            prop_assume!(Vec3::from(axis).norm() > 0.1);
            let [a, b, c] = squares;
            let form = quadric([a, b, c, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            let Surface::Quadric(form) = Surface::of(&form).unwrap() else { return Ok(()) };
            let shapes: [&[f64]; 3] = [&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 3.0], &[1.0, 0.1], &[1.0, 0.4]];
            let profile = Profile::of(&cutter(shapes[shape])).unwrap();
            let tool = Tool::new(&profile, Vec3::from(axis).normalize());
            let search = Search::of(&form, -1.0, &Vec3::from(tip), &tool);
            let (center, radius) = profile.corner().unwrap();
            let bound = search.lowest_of_arc((center, radius), phi, half).unwrap().unwrap();
            for (k, l) in (0..=4 * PLACES).flat_map(|k| (0..=PLACES).map(move |l| (k, l))) {
                let [turn, along] = [(k, 4 * PLACES), (l, PLACES)].map(|(k, n)| f64::from(k) / f64::from(n));
                let (sine, cosine) = (std::f64::consts::FRAC_PI_2 * (2.0 * turn - 1.0)).sin_cos();
                if profile.fan_holds([cosine, sine]) {
                    let place = [center[0] + radius * cosine, center[1] + radius * sine];
                    let (distance, _) = search.distance(&search.place(place, phi + 2.0 * half * along)).unwrap();
                    prop_assert!(distance >= bound - 1e-9, "{distance} {bound}");
                }
            }
        }
    }
}
