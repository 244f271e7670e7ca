//! Whether the clearance keeps the lower limit of the band between two samples: by the contacts there, or by parts of the surface.

use apt_geometry::Vec3;

use super::{Course, Line, Sample, tangents_meet};
use crate::clearance::{Contact, Gauge, Tool};

/// How the contacts of a tool at two places of its end show that its clearance is nowhere below a level between, looked at up to a third place
/// from either.
type Keeps = fn(&Gauge, &Tool, [(&Vec3, &Contact); 2], &Vec3, f64) -> bool;

impl Course<'_, '_> {
    /// Whether the contacts at both ends of a stretch show that the tool is nowhere below the band on it.
    pub(super) fn is_kept_by_contacts(&self, a: &Sample, b: &Sample) -> bool {
        self.is_kept(a, b, Gauge::keeps_by_contacts)
    }

    /// Whether they, or parts of the surface where contacts tell little, show the same.
    pub(super) fn is_kept_from_both(&self, a: &Sample, b: &Sample) -> bool {
        self.is_kept(a, b, Gauge::keeps_between)
    }

    fn is_kept(&self, a: &Sample, b: &Sample, keeps: Keeps) -> bool {
        let Line { sweep, role, limits, .. } = self.line;
        if sweep.turns() {
            return false;
        }
        let at = |x: f64| sweep.at(x).0;
        let (from, to, meeting) = (at(a.x), at(b.x), at(tangents_meet(*a, *b).0));
        let contacts = [(&from, &a.contact), (&to, &b.contact)];
        keeps(&role.gauge, &sweep.at(a.x).1, contacts, &meeting, limits[0])
    }

    /// Whether the parts of the surface show the same.
    pub(super) fn is_clear_between(&self, a: &Sample, b: &Sample) -> bool {
        let Line { sweep, role, limits, .. } = self.line;
        let (from, tool) = sweep.at(a.x);
        let (to, turned) = sweep.at(b.x);
        if sweep.turns() {
            let contacts = [(&from, &a.contact), (&to, &b.contact)];
            return role.gauge.is_clear_while_turning([&tool, &turned], contacts, limits[0]);
        }
        role.gauge.is_clear_between(&tool, [(&from, &a.contact), (&to, &b.contact)], limits[0])
    }
}
