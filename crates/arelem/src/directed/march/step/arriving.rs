//! How the path came to a place, and which directions lead back from there.

use apt_geometry::Vec3;

use super::{Stepper, Vertex, along_arc};
use crate::directed::prepare::UNDETERMINED;

/// How many times the width of the bands a path goes on before what it does there is not turning on the spot any more.
const KINK_BANDS: f64 = 0.1;
/// How many times the square of the angle between path and vector at its start that at its end may be on a bend that goes on as it
/// begins: on one that grows tighter it is twice the angle at most.
const MOST_TURNED: f64 = 4.0;

/// How the path came to a place.
#[derive(Clone, Copy)]
pub(super) struct Arrival {
    pub(super) at: Vec3,
    /// The vector that led there.
    pub(super) vector: Vec3,
    /// The direction of the path at its end.
    pub(super) tangent: Vec3,
}

impl Stepper<'_> {
    /// Remembers the direction of a vector.
    pub(super) fn note(&mut self, here: &Vertex, next: &Vertex) {
        self.hand.follow(self.prepared, [here, next]);
        self.last = next.tip - here.tip;
        if self.last.norm() > self.bands() {
            self.came = Some((next.tip, self.last));
        }
        if !self.is_where_it_arrived(&next.tip) {
            let (vector, tangent) = (self.last, arrival(here, next));
            self.arrived = Some(Arrival { at: next.tip, vector, tangent });
        }
    }

    /// True if all that the path has done since it arrived is to turn on the spot.
    pub(super) fn is_where_it_arrived(&self, tip: &Vec3) -> bool {
        self.arrived.is_some_and(|arrival| (tip - arrival.at).norm() <= KINK_BANDS * self.bands())
    }

    /// True if the path, bit by bit, has turned so far on the spot that it goes back from where it came: against the vector that
    /// led there, not plainly onward from how the path ended, from which a vector along a bend differs, and not on the hand on which
    /// the path keeps both surfaces.
    pub(super) fn kinks_back(&self, here: &Vertex, direction: &Vec3) -> bool {
        self.is_where_it_arrived(&here.tip)
            && self.arrived.is_some_and(|Arrival { vector, tangent, .. }| {
                let plainly = UNDETERMINED * direction.norm() * tangent.norm();
                direction.dot(&vector) < 0.0 && direction.dot(&tangent) < plainly
            })
            && !self.hand.leads_along(here, direction)
    }

    /// The vector that tells where the path comes from. A tool that turns has no vectors that end in corners: one within the bands,
    /// to where it may go on along the other leg, leads across the path, and the one before it tells that.
    fn coming(&self, here: &Vertex) -> Vec3 {
        let is_within = |at: &Vec3| (here.tip - at).norm() <= self.bands();
        let came = self.came.filter(|(end, _)| self.prepared.attitude.turns() && is_within(end));
        came.map_or(self.last, |(_, vector)| vector)
    }

    /// True if the path would go back from where it came: against the vector that tells that, or, near a place where it has turned on
    /// the spot, against its direction before that.
    pub(super) fn leads_back(&self, here: &Vertex, tangent: &Vec3) -> bool {
        let near = self.rounding();
        tangent.dot(&self.coming(here)) < 0.0
            || self.kinks_back(here, tangent)
            || self
                .turned
                .is_some_and(|(at, before)| (here.tip - at).norm() <= near && tangent.dot(&before) <= 0.0)
    }
}

/// The direction in which the path arrives at the end of a vector: its tangent there, which on a bent path is not that of the
/// vector; but that of an arc where the tangent is likely to be that of the path beyond a place where it turns.
fn arrival(from: &Vertex, to: &Vertex) -> Vec3 {
    let vector = to.tip - from.tip;
    // The square of an angle, but for a half.
    let turned = |tangent: &Vec3| vector.norm() - tangent.dot(&vector);
    if turned(&to.tangent) <= MOST_TURNED * turned(&from.tangent) {
        to.tangent
    } else {
        along_arc(from, &vector)
    }
}
