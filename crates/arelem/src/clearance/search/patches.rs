//! Where contact is looked for inside the patches of a tool: of a flank, and of the corner of a barrel.

use nalgebra::Vector2;

use super::{Contact, Curve, SCAN, Search};

/// Shares of the arc of a barrel's corner at which contact is looked for on it.
const BULGE_SHARES: [f64; 3] = [0.15, 0.5, 0.85];

impl Search<'_> {
    /// A conical patch: contact in its interior where the distance falls from both edges inward, looked for at the
    /// azimuth that faces the surface and at the lowest point of the circle half way.
    pub(super) fn frustum(&mut self, radius: [f64; 2], height: [f64; 2]) {
        let Some(contact) = self.best.contact else { return };
        let curve = Curve::Line { radius, height };
        let facing = self.facing(&contact);
        let middle = [0.5 * (radius[0] + radius[1]), 0.5 * (height[0] + height[1])];
        let Some((lowest, across)) = self.lowest_on_circle(middle) else { return };
        for azimuth in [facing, across] {
            for t in self.valleys(radius, height, azimuth).into_iter().flatten() {
                self.inside_patch(&curve, Vector2::new(t, azimuth));
            }
        }
        if lowest < self.best.value {
            self.inside_patch(&curve, Vector2::new(0.5, across));
        }
    }

    /// The azimuth at which a contact faces the surface.
    fn facing(&self, contact: &Contact) -> f64 {
        let (_, _, facing) = self.tool.split(&-contact.gradient);
        facing.dot(&self.tool.across[1]).atan2(facing.dot(&self.tool.across[0]))
    }

    /// The lowest of some places of a circle (radius, height), and its azimuth; none where the search is given up.
    fn lowest_on_circle(&self, [radius, height]: [f64; 2]) -> Option<(f64, f64)> {
        let step = std::f64::consts::TAU / SCAN as f64;
        let mut lowest = (f64::INFINITY, 0.0);
        for k in 0..SCAN {
            if self.is_given_up() {
                return None;
            }
            let azimuth = step * k as f64;
            let value = self.side * self.surface.signed_distance(&self.point(radius, height, azimuth));
            if value < lowest.0 {
                lowest = (value, azimuth);
            }
        }
        Some(lowest)
    }

    /// The corner of a barrel: contact in its interior is looked for on some circles, where these are lowest and at the azimuth that faces
    /// the surface.
    pub(super) fn bulge(&mut self, curve: &Curve) {
        let facing = self.best.contact.map(|contact| self.facing(&contact));
        for share in BULGE_SHARES {
            let Some((_, across)) = self.lowest_on_circle(curve.at(share).place) else { return };
            for azimuth in facing.into_iter().chain([across]) {
                self.inside_patch(curve, Vector2::new(share, azimuth));
            }
        }
    }

    /// Where along a line of the patch to look for least distances inside.
    fn valleys(&self, radius: [f64; 2], height: [f64; 2], azimuth: f64) -> [Option<f64>; 2] {
        let line =
            self.tool.axis * (height[1] - height[0]) + self.direction(azimuth) * (radius[1] - radius[0]);
        let at = |t: f64| {
            let rho = radius[0] + t * (radius[1] - radius[0]);
            let p = self.point(rho, height[0] + t * (height[1] - height[0]), azimuth);
            let foot = self.surface.foot(&p);
            (self.side * foot.distance, self.side * foot.normal.dot(&line))
        };
        let ((v0, s0), (v1, s1)) = (at(0.0), at(1.0));
        if s0 < 0.0 && s1 > 0.0 {
            // The tangents at both ends meet near the valley.
            return [Some(((v1 - v0 - s1) / (s0 - s1)).clamp(0.0, 1.0)), None];
        }
        // Otherwise there may be one behind a ridge, downhill from an end.
        [(s0 < 0.0).then_some(0.0), (s1 > 0.0).then_some(1.0)]
    }
}
