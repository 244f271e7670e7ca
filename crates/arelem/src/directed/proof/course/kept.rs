//! Whether the clearance keeps the lower limit of the band between two samples: by the contacts there, or by parts of the surface.

use apt_geometry::{Vec3, surface::Surface};

use super::{Course, Line, Sample, highest, tangents_meet};
use crate::clearance::{Contact, Gauge, Tool};

/// How the contacts of a tool at two places of its end show that its clearance is nowhere below a level between, looked at up to a third place
/// from either.
type Keeps = fn(&Gauge, &Tool, [(&Vec3, &Contact); 2], &Vec3, f64) -> bool;

/// Cuts of stretches on one vector up to which these functions are asked.
pub(super) const CUTS_BY_FUNCTIONS: usize = 2;

impl Course<'_, '_> {
    /// Whether the contacts at both ends of a stretch show that the tool is nowhere below the band on it.
    pub(super) fn is_kept_by_contacts(&self, a: &Sample, b: &Sample) -> bool {
        self.is_kept(a, b, Gauge::keeps_by_contacts)
    }

    /// Whether they, or parts of the surface where contacts tell little, show the same.
    pub(super) fn is_kept_from_both(&self, a: &Sample, b: &Sample) -> bool {
        self.is_kept(a, b, Gauge::keeps_between)
    }

    /// The same of a tool that does not turn beside a quadric, and whether they show that it is nowhere above the band: the functions below the
    /// squared distance that touch it at the contacts bend as it does itself, so that a vector takes two of them each way, where a bound of the bends
    /// of all distances takes stretches ever shorter beside an extreme at the limit of the band. `None` where they are not asked: after some cuts,
    /// and where they told nothing of pieces of another vector near by.
    pub(super) fn told_by_functions(&self, a: &Sample, b: &Sample, cuts: usize) -> Option<[bool; 2]> {
        let Line { sweep, role, ledger, .. } = self.line;
        let has_functions = matches!(role.gauge.surface, Surface::Quadric(_)) && !role.gauge.on;
        if !has_functions || sweep.turns() || cuts > CUTS_BY_FUNCTIONS {
            return None;
        }
        let middle = sweep.at(0.5 * (a.x + b.x)).0;
        if !ledger.expects_contacts(sweep.tool(), &middle, b.x - a.x) {
            return None;
        }
        let is_held = self.is_held_by_bends(a, b) || self.is_held_from_both(a, b, true);
        let told = [is_held && self.is_kept_by_contacts(a, b), is_held];
        if told != [true; 2] && cuts == CUTS_BY_FUNCTIONS {
            ledger.note_silence(&middle, b.x - a.x);
        }
        Some(told)
    }

    /// Whether the distances of the points of contact at both ends of a stretch show that the tool is nowhere above the band on it: no point of the
    /// tool goes farther than the stretch is long, so that no nearest place has to be looked for.
    fn is_held_by_bends(&self, a: &Sample, b: &Sample) -> bool {
        let Line { sweep, role, .. } = self.line;
        let bend = |end: &Sample| role.gauge.bend_beside(sweep.tool(), &end.contact, b.x - a.x);
        bend(a).zip(bend(b)).is_some_and(|(first, last)| self.line.allows(highest(a, b, first.max(last))))
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
