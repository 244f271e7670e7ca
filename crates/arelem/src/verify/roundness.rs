//! How round a tool is where it is nearest to a place. The clearance is the least distance of the tool from any place of the surface,
//! and each of these distances bends upwards by the curvature of the tool there, wherever the tool goes straight: so does the clearance,
//! whatever edges the surface has.

use apt_geometry::Vec3;

use super::tool::{Meridian, Profile, Tool};

/// Sine of the angle between an arc and a straight piece of the meridian below which they join without an edge.
const TANGENT: f64 = 1e-7;

impl Profile {
    /// The circles of the body that are edges, tips among them.
    fn sharp(&self) -> impl Iterator<Item = Meridian> {
        let [(tip, lower), (upper, top)] = self.lines();
        let joins = |place: Meridian, [from, to]: [Meridian; 2]| {
            let (way, Some((center, radius))) = ([to[0] - from[0], to[1] - from[1]], self.corner()) else {
                return false;
            };
            let length = way[0].hypot(way[1]);
            let out = [place[0] - center[0], place[1] - center[1]];
            length > 0.0 && (out[0] * way[0] + out[1] * way[1]).abs() <= TANGENT * radius * length
        };
        // Without a flat or slanted bottom the arc begins on the axis, square to it.
        let at_bottom = lower == tip && self.corner().is_some_and(|(center, _)| center[0] == 0.0);
        [
            (lower[1] > 0.0).then_some(tip),
            (!at_bottom && !joins(lower, [tip, lower])).then_some(lower),
            (!joins(upper, [upper, top])).then_some(upper),
            Some(top),
        ]
        .into_iter()
        .flatten()
    }

    /// Greatest curvature of the body between its edges; none where it has no bound.
    fn roundness(&self) -> Option<f64> {
        let [(_, lower), (upper, top)] = self.lines();
        // Round the axis the corner bends by the sine of its normal over the distance from the axis: where its centre is beyond that more
        // than along the meridian, and most where it is narrowest.
        let corner = self.corner().map_or(0.0, |(center, radius)| {
            let round = if center[0] < 0.0 { (lower[0] - center[0]) / (radius * lower[0]) } else { 0.0 };
            round.max(1.0 / radius)
        });
        let flank = 1.0 / upper[0].min(top[0]);
        let found = corner.max(flank);
        // A slanted bottom ends in a tip.
        (found.is_finite() && lower[1] <= 0.0).then_some(found)
    }
}

impl Tool<'_> {
    /// Greatest curvature of the tool at its places nearest to the places of a ball, given from the tool end, that are not farther from it
    /// than `reach`; none where an edge of it may be.
    pub(super) fn roundness_at(&self, center: &Vec3, radius: f64, reach: f64) -> Option<f64> {
        let along = center.dot(&self.axis);
        let across = (center - self.axis * along).norm();
        let apart = |circle: Meridian| (across - circle[0]).hypot(along - circle[1]) - radius;
        if self.profile.sharp().all(|circle| apart(circle) > reach) { self.profile.roundness() } else { None }
    }
}
