//! Corners of the path: while the axis stands still it turns on the spot where the tool comes to touch a surface at a second
//! place.

use apt_geometry::Vec3;

use super::{Places, Stepper, exhaustive::LEAST_ONWARD};
use crate::{
    clearance::Contact,
    directed::{
        Prepared,
        march::{Vertex, tangent},
    },
    error::MotionFailure,
};

/// How many times the width of the bands ahead of a place without a way on it is looked for another contact.
const PROBES: [f64; 4] = [0.25, 1.0, 4.0, 16.0];
/// Share of the width of the bands below which a vector does nothing but lead up to a kink.
const CREEPING: f64 = 0.05;
/// Sine between the normals of two contacts above which they are not the same one.
const OTHER_CONTACT_SINE: f64 = 0.05;
/// Cosine between two directions above which both need not be tried.
pub(super) const SAME_TANGENT_COSINE: f64 = 0.999;

/// What is seen from a place without a way on.
pub(super) struct Corner {
    pub(super) places: Vec<SecondPlace>,
    /// Directions in which the path may go on: straight, then along a second contact.
    directions: Vec<Vec3>,
}

/// A place ahead at which the tool touches a surface elsewhere.
pub(super) struct SecondPlace {
    pub(super) ahead: Vertex,
    /// Whether the contacts with part and drive surface are others.
    pub(super) others: [bool; 2],
}

impl Corner {
    /// Why the path does not go on, where a second contact prevents it: that.
    pub(super) fn explained(
        &self,
        prepared: &Prepared,
        here: &Vertex,
        failure: MotionFailure,
    ) -> MotionFailure {
        match (failure, self.places.first()) {
            (MotionFailure::IterationLimit { .. }, Some(place)) => place.prevents(prepared, here),
            (failure, _) => failure,
        }
    }
}

impl SecondPlace {
    /// What is told where the path cannot go on along the second contact.
    fn prevents(&self, prepared: &Prepared, here: &Vertex) -> MotionFailure {
        let (role, clearance) = match self.others {
            [true, _] => (prepared.part.name, self.ahead.part.clearance),
            _ => (prepared.drive.name, self.ahead.drive.clearance),
        };
        MotionFailure::NoAdmissibleVector { role, clearance, tip: here.tip }
    }
}

impl Stepper<'_> {
    /// The second contacts ahead of a place.
    pub(super) fn corner_at(&self, here: &Vertex) -> Corner {
        let places: Vec<SecondPlace> =
            PROBES.iter().filter_map(|share| self.second_place(here, *share)).collect();
        let beyond = tangents_beyond(here, &places);
        let mut directions = vec![here.tangent];
        directions.extend(beyond.into_iter().filter(|tangent| !self.leads_back(here, tangent)));
        Corner { places, directions }
    }

    /// The contacts so many bands ahead, if one of them is another than here.
    fn second_place(&self, here: &Vertex, bands: f64) -> Option<SecondPlace> {
        let reach = bands * self.bands();
        let ahead = Vertex::at(self.prepared, here.tip + here.tangent * reach, &here.tangent).ok()?;
        // In a neck the second contact may be all but opposite to the first one; where a tool turns it may be its other end that touches.
        let turns = self.prepared.attitude.turns();
        let is_other = |a: &Contact, b: &Contact| {
            (!turns && a.gradient.dot(&b.gradient) < 0.0)
                || a.gradient.cross(&b.gradient).norm() > OTHER_CONTACT_SINE
        };
        let others = [is_other(&here.part, &ahead.part), is_other(&here.drive, &ahead.drive)];
        others.contains(&true).then_some(SecondPlace { ahead, others })
    }

    /// The next vertex along a second contact. Before the first vector the direction asked for alone tells the way: one nearly square to it may lead
    /// across the bands against it, and is left to the sharp corners.
    pub(super) fn around(&mut self, corner: &Corner, here: &mut Vertex, cap: f64) -> Option<Vertex> {
        let sets_out = self.last == Vec3::zeros();
        corner.directions.iter().skip(1).find_map(|tangent| {
            if sets_out && tangent.dot(&here.tangent) < LEAST_ONWARD {
                return None;
            }
            let turned = Vertex { tangent: *tangent, ..*here };
            self.trend.forget();
            let next = self.onward(&turned, cap, Places::Limits).ok()?;
            // A vector may set out onward, and yet come to a path that does not.
            if next.tangent.dot(&here.tangent) < 0.0 {
                return None;
            }
            self.turn(here, turned);
            Some(next)
        })
    }

    /// The next vertex beyond a kink of the path of a tool that turns, if all that leads on from a place is a vector that is short against the bands: to the kink itself, to
    /// which others would creep up without end.
    pub(super) fn beyond_kink(&mut self, here: &mut Vertex, next: &Vertex, cap: f64) -> Option<Vertex> {
        let led = (next.tip - here.tip).norm();
        if !self.prepared.attitude.turns() || led > CREEPING * self.bands() {
            return None;
        }
        let (latest, turned, before) = (self.latest.take(), self.turned, *here);
        let corner = self.corner_at(here);
        let beyond = self.around(&corner, here, cap).filter(|beyond| (beyond.tip - here.tip).norm() > led);
        if beyond.is_none() {
            // Nothing of what was tried stays.
            (self.turned, *here) = (turned, before);
            if let Some(latest) = &latest {
                self.follow(&before.tip, latest);
            }
            self.latest = latest;
        }
        beyond
    }

    /// The next vertex wherever in the bands there is one, straight on or along a second contact. Errors: cancelled.
    pub(super) fn anywhere_onward(
        &mut self,
        corner: &Corner,
        here: &mut Vertex,
        cap: f64,
    ) -> Result<Option<Vertex>, MotionFailure> {
        let Some((from, found)) = self.longest_of_all(here, &corner.directions, cap)? else {
            return Ok(None);
        };
        if from.tangent != here.tangent {
            self.turn(here, from);
        }
        self.follow(&here.tip, &found);
        self.trend.forget();
        let next = found.vertex;
        self.latest = Some(found);
        Ok(Some(next))
    }

    /// Turns on the spot.
    fn turn(&mut self, here: &mut Vertex, turned: Vertex) {
        self.turned = Some((here.tip, here.tangent));
        *here = turned;
    }
}

/// Directions in which the path may go on from a corner: along the second contact and away from the present one, but not
/// back. Where a second wall would lead the tool back the path ends.
fn tangents_beyond(here: &Vertex, places: &[SecondPlace]) -> Vec<Vec3> {
    let mut found: Vec<Vec3> = Vec::new();
    for SecondPlace { ahead, others } in places {
        for [part_turns, drive_turns] in [[true, false], [false, true], [true, true]] {
            if (part_turns && !others[0]) || (drive_turns && !others[1]) {
                continue;
            }
            let part = if part_turns { &ahead.part } else { &here.part };
            let drive = if drive_turns { &ahead.drive } else { &here.drive };
            let along = tangent(part, drive, &here.tangent);
            let away = |turns: bool, contact: &Contact| !turns || contact.gradient.dot(&along) >= 0.0;
            let is_known = found.iter().any(|t| t.dot(&along) > SAME_TANGENT_COSINE);
            if away(part_turns, &here.part) && away(drive_turns, &here.drive) && !is_known {
                found.push(along);
            }
        }
    }
    found
}
