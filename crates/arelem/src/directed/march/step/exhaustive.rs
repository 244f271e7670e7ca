//! Where the path turns so sharply that no parabola tells where it goes: vectors of many lengths to many places in the
//! bands, in every direction in which the path may go on.

use apt_geometry::Vec3;

use super::{Stepper, Trial, attempt::LeastCosines};
use crate::{directed::march::Vertex, error::MotionFailure, role::Working};

/// Places in a band at which a vector may end, as shares of it from its inner limit.
const PLACES: [f64; 3] = [0.02, 0.5, 0.98];
/// Each length that is tried is this share of the one before.
const SHORTER: f64 = 0.25;
/// The longest and the shortest one, as shares of the bands: behind the turn vectors are as long as the path bends. One that leaves a rounding of less
/// than a band nearly square to the path ends while it is still in that band, which is a small share of it ahead.
const LONGEST: f64 = 20.0;
const SHORTEST: f64 = 0.05;
/// Cosine between such a vector and the path until then at least: up to nearly a right angle. What turns by more goes on on its hand
/// ([`super::hand`]).
pub(super) const LEAST_ONWARD: f64 = 0.1;

impl Stepper<'_> {
    /// The longest of these vectors that is proven, with the vertex that it begins at: that one's tangent is the direction
    /// which led there. Errors: cancelled.
    pub(super) fn longest_of_all(
        &self,
        here: &Vertex,
        directions: &[Vec3],
        cap: f64,
    ) -> Result<Option<(Vertex, Trial)>, MotionFailure> {
        let mut length = cap.min(self.maximum).min(LONGEST * self.bands());
        while length > SHORTEST * self.bands() {
            for tangent in directions {
                let from = Vertex { tangent: *tangent, ..*here };
                if let Some(trial) = self.to_some_place(&from, &here.tangent, (length, cap))? {
                    return Ok(Some((from, trial)));
                }
            }
            length *= SHORTER;
        }
        Ok(None)
    }

    /// A vector of about this length to one of the places, the longest of those that are proven.
    fn to_some_place(
        &self,
        from: &Vertex,
        until_now: &Vec3,
        (length, cap): (f64, f64),
    ) -> Result<Option<Trial>, MotionFailure> {
        let mut best: Option<Trial> = None;
        let bends = self.bends(&[0.0; 2]);
        let place = |role: &Working, share: f64| share * role.band() - role.inside;
        let [part, drive] = self.roles();
        for share in PLACES.iter().flat_map(|p| PLACES.iter().map(move |d| (*p, *d))) {
            if self.patience.is_over() {
                return Err(MotionFailure::Cancelled);
            }
            let targets = [place(part, share.0), place(drive, share.1)];
            let trial = self.reached(from, length, cap, (targets, &[0.0; 2], &bends)).and_then(|vertex| {
                let least = LeastCosines { forward: LEAST_ONWARD, ..self.least_cosines(from, &vertex) };
                self.judge(from, vertex, &bends, least)
            });
            if let Some(trial) = trial
                && trial.proven
                && trial.length > SHORTEST * self.bands()
                && self.leads_onward(&(trial.vertex.tip - from.tip), until_now)
                && self.leads_onward(&trial.vertex.tangent, until_now)
                && best.as_ref().is_none_or(|best| trial.length > best.length)
            {
                best = Some(trial);
            }
        }
        Ok(best)
    }

    /// True if a direction goes on in about that of the path, of the vector before, and of the one by which the path came
    /// to a place where it turns on the spot.
    fn leads_onward(&self, vector: &Vec3, tangent: &Vec3) -> bool {
        let arrived = self.arrived.map_or_else(Vec3::zeros, |arrival| arrival.vector);
        let least = |before: &Vec3| LEAST_ONWARD * vector.norm() * before.norm();
        [*tangent, self.last, arrived].iter().all(|before| vector.dot(before) >= least(before))
    }
}
