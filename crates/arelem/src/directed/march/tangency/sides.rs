//! A check surface that stops at a tangency, seen from either side.

use apt_geometry::Vec3;

use super::PARALLEL;
use crate::{
    clearance::{Contact, Gauge},
    directed::Prepared,
    error::MotionFailure,
    role::Working,
};

/// A check surface seen from either side; what is known of contact stays with each.
pub(in crate::directed::march) struct Sides([Gauge; 2]);

impl Sides {
    pub(super) fn of(check: &Working) -> Self {
        Self([1.0, -1.0].map(|side| Gauge { side, ..check.gauge.clone() }))
    }

    /// What is measured on a side.
    pub(in crate::directed::march) fn on(&self, side: f64) -> &Gauge {
        &self.0[usize::from(side < 0.0)]
    }

    /// Contact on the side where the tool touches the surface more nearly.
    pub(in crate::directed::march) fn nearer(
        &self,
        prepared: &Prepared,
        tip: &Vec3,
    ) -> Result<(Contact, f64), MotionFailure> {
        let posture = prepared.attitude.posture(tip)?;
        let contact = |side: f64| posture.contact(self.on(side), tip);
        let Gauge { on, surface, disk, .. } = self.on(1.0);
        if *on {
            return Ok((contact(1.0), 1.0));
        }
        // A tool that ends on the surface is on the side of the rest of it.
        let height =
            Some(surface.signed_distance(tip)).filter(|height| height.abs() > PARALLEL * prepared.size);
        let height = height.unwrap_or_else(|| posture.tool.observed(surface, tip));
        let first = if height < 0.0 { -1.0 } else { 1.0 };
        let here = contact(first);
        // Where it has come off on this side the middle of a ball that it holds is as far from the surface as the ball is large, and on the
        // other side it is as deep.
        let ball = if disk.is_some() { 0.0 } else { posture.tool.held_ball() };
        if here.clearance >= 0.0 || -here.clearance <= 0.5 * ball {
            return Ok((here, first));
        }
        let beyond = contact(-first);
        let is_nearer = beyond.clearance.abs() < here.clearance.abs();
        Ok(if is_nearer { (beyond, -first) } else { (here, first) })
    }
}
