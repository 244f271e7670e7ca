//! Through a neck that is narrower than the tool by less than its bands: both walls are one surface, and a tool that is in the band of
//! each of them may pass. A path on one level of the band turns back there. Whichever vectors come to it, the tool passes if it can.

use apt_geometry::Vec3;

use super::Stepper;
use crate::{
    clearance::{Contact, Shape},
    directed::{march::Vertex, neck::Neck},
    error::{MotionFailure, TurnsBack},
    role::Working,
};

/// Shares of the way to the narrowest place of a neck at which a vector may end in its middle: a tool that has come to the limit of the second
/// wall leaves that before it goes on.
const SHARES: [f64; 4] = [1.0, 0.5, 0.25, 0.125];

/// By how much of the band the tool is nearer to the wall that it follows than to the other one.
const NEARER: f64 = 0.05;

/// How many bands the walls may be across each other behind a corner, for the legs of a path are not quite its tangents.
const ACROSS: f64 = 2.0;

/// Where the tool is on its way through a neck.
#[derive(Clone, Copy)]
pub(super) struct Through {
    at: Vec3,
    /// The narrowest place, if that is still to come.
    narrowest: Option<Vertex>,
}

impl Stepper<'_> {
    /// The next vertex in the middle of the neck ahead of a place, if the path turns back there and the bands of both walls leave room.
    /// Errors: cancelled.
    pub(super) fn enter_neck(
        &mut self,
        here: &Vertex,
        [arrived, next]: [&Vec3; 2],
        cap: f64,
    ) -> Result<Option<Vertex>, MotionFailure> {
        let legs = [*arrived, next - here.tip].map(|leg| leg.try_normalize(0.0));
        let [Some(to), Some(away)] = legs else { return Ok(None) };
        if to.dot(&away) >= 0.0 || !self.may_have_corners() {
            return Ok(None);
        }
        let corner = TurnsBack { at: here.tip, onward: (to - away).normalize() };
        // The cosine of half the angle between both legs.
        if !self.may_be_neck(here, corner.onward.dot(&to)) {
            return Ok(None);
        }
        let Some([first, narrowest]) = self.way_into_neck(here, corner, cap) else { return Ok(None) };
        // What is found is looked for again from there, where the vector before it is the last one.
        let (latest, longest, trend, record) =
            (self.latest.take(), self.longest, self.trend.clone(), self.record.clone());
        let beyond = self.out_of_neck(&narrowest, cap);
        (self.latest, self.longest, self.trend, self.record) = (latest, longest, trend, record);
        if beyond?.is_none() {
            return Ok(None);
        }
        let rest = (first.tip != narrowest.tip).then_some(narrowest);
        self.in_neck = Some(Through { at: first.tip, narrowest: rest });
        Ok(Some(first))
    }

    /// Whether bands may leave room beyond a corner: walls lead the middle of the tool along curves that are at least as round as it is, and where two
    /// of these come to each other at an angle they are as far across each other behind as such an arc is high.
    fn may_be_neck(&self, here: &Vertex, cosine: f64) -> bool {
        let across = |contact: &Contact| {
            let arm = contact.tool - here.tip;
            (arm - here.axis * arm.dot(&here.axis)).norm()
        };
        let may_be = |(role, contact): (&Working, &Contact)| {
            matches!(role.shape, Shape::General | Shape::Concave)
                && across(contact) * (1.0 - cosine) <= ACROSS * role.band()
        };
        self.roles().into_iter().zip([&here.part, &here.drive]).any(may_be)
    }

    /// The vertex in the middle of a neck to which a vector leads, and the one where it is narrowest.
    fn way_into_neck(&self, here: &Vertex, corner: TurnsBack, cap: f64) -> Option<[Vertex; 2]> {
        let cap = cap.min(self.maximum);
        let is_vector = |from: &Vertex, to: &Vertex| {
            let length = (to.tip - from.tip).norm();
            length > self.least_vector(&to.tip) && length <= cap && self.proven(from, to)
        };
        let [part, drive] = self.roles();
        let hand = self.hand.or_at(here);
        [[part, drive], [drive, part]].into_iter().find_map(|[role, other]| {
            let neck = Neck::new(self.prepared, [role, other], corner)?;
            let (on, narrowest) = neck.narrowest()?;
            let room = narrowest.clearance + role.inside;
            if room < 0.0 {
                return None;
            }
            // What the path follows is to be what the tool touches there.
            let nearer = (NEARER * role.band()).min(0.5 * room);
            let vertex = |on: f64| {
                [nearer, -nearer].into_iter().find_map(|aside| {
                    let vertex =
                        Vertex::at(self.prepared, neck.beside_middle(on, aside)?.tip, neck.onward()).ok()?;
                    let along = hand.along(&vertex.part, &vertex.drive)?;
                    (along.dot(neck.onward()) > 0.0).then_some(Vertex { tangent: *neck.onward(), ..vertex })
                })
            };
            let narrowest = vertex(on)?;
            SHARES.into_iter().find_map(|share| {
                let first = if share < 1.0 { vertex(share * on)? } else { narrowest };
                let leads_there =
                    is_vector(here, &first) && (first.tip == narrowest.tip || is_vector(&first, &narrowest));
                leads_there.then_some([first, narrowest])
            })
        })
    }

    /// The next vertex from a place in a neck on the way through. Errors: cancelled.
    pub(super) fn on_through_neck(
        &mut self,
        here: &Vertex,
        cap: f64,
    ) -> Result<Option<Vertex>, MotionFailure> {
        let Some(Through { narrowest, .. }) = self.in_neck.take().filter(|through| through.at == here.tip)
        else {
            return Ok(None);
        };
        let Some(narrowest) = narrowest else { return self.out_of_neck(here, cap) };
        if (narrowest.tip - here.tip).norm() > cap {
            return Ok(None);
        }
        self.in_neck = Some(Through { at: narrowest.tip, narrowest: None });
        self.record_shortened(here, &narrowest);
        Ok(Some(narrowest))
    }

    /// The next vertex behind the narrowest place of a neck, on the hand of the path. Errors: cancelled.
    fn out_of_neck(&mut self, narrowest: &Vertex, cap: f64) -> Result<Option<Vertex>, MotionFailure> {
        let known = (self.last, self.came, self.arrived, self.turned);
        (self.last, self.came, self.arrived, self.turned) = (Vec3::zeros(), None, None, None);
        self.kept_hand = Some(self.hand.or_at(narrowest));
        let found = self.in_any_place(narrowest, cap);
        self.kept_hand = None;
        (self.last, self.came, self.arrived, self.turned) = known;
        found
    }
}
