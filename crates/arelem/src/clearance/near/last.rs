//! How near a tool was to a surface in its last position, which tells how far away it may be now.

use apt_geometry::Vec3;

use super::{Contacts, Near, Pose, Start};
use crate::clearance::Contact;

/// How near a tool was to a surface in a position: no farther away than one of its points, which this is of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Last {
    tip: Vec3,
    axis: Vec3,
    clearance: f64,
}

impl Contacts {
    /// Whether a contact was found on a side. Where none was Newton's method begins at a guess, seen from the corner of the tool: it leads to any bend
    /// of the surface, while another part of the tool may be in contact.
    pub(in crate::clearance) fn has_last(&self, side: f64) -> bool {
        self.places.iter().any(|known| known.side == side && known.last.is_some())
    }
}

impl Near {
    /// Keeps a contact, from which the next one is followed.
    pub(super) fn note(&mut self, pose: &Pose<'_>, start: Start, contact: &Contact) {
        (self.start, self.surface) = (start, contact.surface);
        self.last = Some(Last { tip: *pose.tip, axis: pose.tool.axis, clearance: contact.clearance });
    }

    /// Whether a contact that the last one leads to may be the nearest, for all that is known of that: the distance of no point of the tool
    /// has grown by more than the point has moved. Where contact leaves the last place over the end of the surface, Newton's method finds
    /// what is farther away than that.
    pub(super) fn may_be_nearest(&self, pose: &Pose<'_>, contact: &Contact) -> bool {
        self.last.is_none_or(|last| {
            let most = last.clearance + pose.moved_from(&last.tip, &last.axis);
            contact.clearance <= most + pose.slack()
        })
    }
}

impl Pose<'_> {
    /// A bound of how far any point of the tool is from where it was in another position.
    pub(super) fn moved_from(&self, tip: &Vec3, axis: &Vec3) -> f64 {
        let moved = (self.tip - tip).norm();
        if self.tool.axis == *axis {
            return moved;
        }
        let reach = self.tool.profile.top.height.hypot(self.tool.radius());
        moved + reach * (self.tool.axis - axis).norm()
    }
}
