//! Whether parts of a surface are as far from a tool as is wanted, by what holds each of them: without a contact.

use apt_geometry::Vec3;

use super::{
    super::{
        patch::jet,
        survey::{Part, work_of_pass},
    },
    Following, WORK_OF_PROOF,
};

/// Halvings of a part of which what holds it does not tell that it is far enough.
const HALVINGS: u32 = 4;

impl Following<'_> {
    /// Whether no part is nearer than a distance above zero, as far as the ball or a half-space about each, or about what it is halved into, tells.
    pub(in crate::verify) fn keeps_off(&self, least: f64) -> bool {
        least > 0.0
            && !self.tool.patience.ends_after(work_of_pass(self.parts))
            && self
                .parts
                .iter()
                .all(|part| part.far.get() - self.way >= least || self.is_apart(part, least, HALVINGS))
    }

    /// The same of one part. One whose middle is nearer is not halved.
    fn is_apart(&self, part: &Part, least: f64, halvings: u32) -> bool {
        if self.tool.distance(&(part.center - self.tip)) - part.radius >= least
            || self.is_above(part, self.side, least)
        {
            return true;
        }
        let middle = jet(&part.net, [0.5; 2])[0];
        let is_met = self.tool.distance(&(middle - self.tip)) < least;
        halvings > 0
            && !is_met
            && !self.tool.patience.ends_after(WORK_OF_PROOF)
            && part.halves().0.iter().all(|half| self.is_apart(half, least, halvings - 1))
    }

    /// Whether a part is above a plane by `least` that has the tool on its other side: along the tool where it is nearest to the
    /// part's middle, or along the part there, with and without what of that leads round the tool axis.
    pub(super) fn is_above(&self, part: &Part, side: f64, least: f64) -> bool {
        let [middle, along, across] = jet(&part.net, [0.5; 2]);
        let from = middle - self.tip;
        let (apart, nearest) = self.tool.signed_distance(&from);
        let is_above = |outward: &Vec3| {
            let base = outward.dot(self.tip) + self.tool.support(outward).0 + least;
            part.net.as_flattened().iter().all(|p| outward.dot(p) >= base)
        };
        let own = (from - nearest).try_normalize(0.0).map(|away| away * apart.signum());
        let level = along.cross(&across).try_normalize(0.0).map(|normal| normal * -part.sense(side));
        own.is_some_and(|outward| is_above(&outward))
            || level.is_some_and(|level| {
                self.tool.without_azimuth(&from, &level).is_some_and(|outward| is_above(&outward))
                    || is_above(&level)
            })
    }
}
