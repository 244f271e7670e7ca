//! How deep a tool is in a convex body that is sharper than the tool is deep.
//!
//! About the deepest place of the tool the way out of the body is a leap from one side of it to the other: no normal there tells a
//! plane that has all of the tool before it. What the tool is deep in is that of a plane between: any plane with the body behind it
//! bounds how deep the tool is, and what bounds it best has a straight piece of the tool in it, for there the tool goes as far by one of its ends as
//! by the other one.

use apt_geometry::Vec3;

use super::Search;
use crate::verify::tool::Meridian;

/// Planes along a straight piece of the tool that are tried before the best of them is turned.
const AZIMUTHS: u32 = 64;
/// Halvings of the step by which that is turned: to rounding.
const HALVINGS: u32 = 50;
/// Turns by the same step: from a neighbour of the best there is nowhere to go but past it.
const MOST_TURNS: u32 = 4;
/// What planes leave of the depth, relative to the tool, that is not worth looking for better ones: readings that are proven leave as much.
const SETTLED: f64 = 1e-9;

impl Search<'_> {
    /// Where the normal at the deepest place tells too little, the planes along each straight piece of the tool: the best of them says how
    /// much deeper than there the tool may be.
    pub(super) fn turn_planes(&mut self) {
        let Some(best) = self.best else { return };
        if self.open_top || self.gap <= SETTLED * self.tool.profile.reach() {
            return;
        }
        let mut least = best.value - self.gap;
        for (a, b) in self.tool.profile.lines() {
            if a != b {
                least = least.max(self.planes_along([a, b]));
            }
        }
        self.gap = (best.value - least).max(0.0);
    }

    /// The greatest distance of the tool from a plane along a straight piece of it that has the body behind.
    fn planes_along(&self, [a, b]: [Meridian; 2]) -> f64 {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let [out, up] = [(b[1] - a[1]) / length, (a[0] - b[0]) / length];
        // The body is where the tool faces.
        let before = |phi: f64| self.before_plane(&-(self.radial(phi) * out + self.tool.axis * up));
        let mut step = std::f64::consts::TAU / f64::from(AZIMUTHS);
        let tried = (0..AZIMUTHS).map(|k| step * f64::from(k)).map(|phi| (before(phi), phi));
        let mut best =
            tried.fold((f64::NEG_INFINITY, 0.0), |best, found| if found.0 > best.0 { found } else { best });
        for _ in 0..HALVINGS {
            for _ in 0..MOST_TURNS {
                let [left, right] = [best.1 - step, best.1 + step].map(|phi| (before(phi), phi));
                let found = if left.0 > right.0 { left } else { right };
                if found.0 <= best.0 {
                    break;
                }
                best = found;
            }
            step *= 0.5;
        }
        best.0
    }

    /// How far the tool is before the plane near a unit normal that has the body behind it; as deep as one likes where there is none.
    fn before_plane(&self, normal: &Vec3) -> f64 {
        let local = self.quadric.turned_in(normal);
        let plane = match &self.body {
            Some(body) => body.plane(&local),
            None => {
                let about = self.quadric.turned_in(&self.tip);
                self.quadric.farthest(self.side, &local, &about).map(|place| (local, local.dot(&place)))
            }
        };
        let Some((normal, behind)) = plane else { return f64::NEG_INFINITY };
        let normal = self.quadric.turned_out(&normal);
        normal.dot(&self.tip) - self.tool.support(&-normal).0 - behind
    }
}
