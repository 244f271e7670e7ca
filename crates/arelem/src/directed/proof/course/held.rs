//! Whether the clearance keeps the upper limit of the band between two samples: by the way of the tool, by the places of contact there, and by how the
//! distances of these bend.

use super::{Course, Line, Sample};
use crate::clearance::Contact;

/// Bisections that tell which bend serves.
const BISECTIONS: usize = 20;

impl Course<'_, '_> {
    /// Whether the places of contact at both ends of a stretch show that the tool is nowhere above the band on it.
    pub(super) fn is_held_from_both(&self, a: &Sample, b: &Sample, by_contacts: bool) -> bool {
        let Line { sweep, role, limits, .. } = self.line;
        // No clearance changes by more than the tool moves.
        let way = (b.x - a.x) * self.stretch_of(role.gauge.reach(sweep.tool()));
        if 0.5 * (a.value + b.value + way) <= limits[1] {
            return true;
        }
        if sweep.turns() {
            return self.is_held_by_place(a, b)
                || by_contacts
                    && self.bend_of_carried(a, b).is_some_and(|bend| self.line.allows(highest(a, b, bend)));
        }
        let at = |x: f64| sweep.at(x).0;
        let (from, to) = (at(a.x), at(b.x));
        let contacts = [(&from, &a.contact), (&to, &b.contact)];
        let tool = sweep.at(a.x).1;
        let allows = |most: Option<f64>| most.is_some_and(|most| most <= limits[1]);
        allows(role.gauge.at_most_between(&tool, contacts))
            || allows(role.gauge.at_most_along_surface(&tool, contacts))
            || self.is_held_by_witness(a, b)
            || by_contacts
                && self.bend_of_contacts(a, b).is_some_and(|bend| self.line.allows(highest(a, b, bend)))
    }

    /// Whether the point of the tool that goes from one contact to the other along with the vector is nowhere above the band. It is one of
    /// the tool, which is convex; where contact moves little on the surface, as while the tool moves along a straight piece of it, so
    /// does that point.
    fn is_held_by_witness(&self, a: &Sample, b: &Sample) -> bool {
        let (length, way) = (b.x - a.x, b.contact.tool - a.contact.tool);
        // From place to place under what is above the tool it would go over the disc at its top, which touches nothing.
        if [a, b].into_iter().any(|end| {
            let (tip, tool) = self.line.sweep.at(end.x);
            self.line.role.gauge.touches_from_below(&tool, &tip, &end.contact)
        }) {
            return false;
        }
        let [first, last] =
            [a, b].map(|end| Sample { slope: end.contact.gradient.dot(&way) / length, ..*end });
        let held = |bend: f64| self.line.allows(highest(&first, &last, bend * (way.norm() / length).powi(2)));
        held(0.0) && {
            let most = 8.0 * self.line.role.band() / way.norm_squared();
            self.bend_of_witness(a, b, greatest(most, held)).is_some_and(held)
        }
    }

    /// Bound of the second derivative of that point's distance by the length of its way, closely where it is more than enough.
    pub(super) fn bend_of_witness(&self, a: &Sample, b: &Sample, enough: f64) -> Option<f64> {
        let Line { sweep, role, .. } = self.line;
        let (from, tool) = sweep.at(a.x);
        role.gauge.bend_along((&tool, &from), &a.contact, &(b.contact.tool - a.contact.tool), enough)
    }

    /// Bound of the second derivative of the distances of the points of contact of both ends on the stretch between: the
    /// clearance is nowhere greater than either of these, wherever on the tool contact is there.
    fn bend_of_contacts(&self, a: &Sample, b: &Sample) -> Option<f64> {
        let Line { sweep, role, .. } = self.line;
        let way = sweep.direction * (b.x - a.x);
        let (_, tool) = sweep.at(a.x);
        let bend = |contact: &Contact, sense: f64| role.gauge.bend_at(&tool, &contact.tool, &(way * sense));
        Some(bend(&a.contact, 1.0)?.max(bend(&b.contact, -1.0)?))
    }

    /// The same where the tool turns and takes these points along: none of them moves faster than the tool end and the turn of its arm
    /// together, and its way bends no more than the arm swings.
    fn bend_of_carried(&self, a: &Sample, b: &Sample) -> Option<f64> {
        let Line { sweep, role, .. } = self.line;
        let middle = 0.5 * (a.x + b.x);
        let (_, tool) = sweep.at(middle);
        let bend = |end: &Sample| {
            let arm = (end.contact.tool - sweep.at(end.x).0).norm();
            let stretch = sweep.stretch(arm);
            let center = sweep.carried(&end.contact.tool, end.x, middle);
            let bend = role.gauge.bend_about(&tool, &center, 0.5 * (b.x - a.x) * stretch)?;
            // Along a slower way it bends by less.
            Some(bend.max(0.0) * stretch * stretch + sweep.swing(arm))
        };
        if role.gauge.on { None } else { Some(bend(a)?.max(bend(b)?)) }
    }
}

/// The greatest bend up to a bound that holds, of which less does too.
fn greatest(most: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let mut range = [0.0, most];
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (range[0] + range[1]);
        range[usize::from(!holds(middle))] = middle;
    }
    range[0]
}

/// Greatest value on a stretch below the parabolas from both ends with the given second derivative.
pub(super) fn highest(a: &Sample, b: &Sample, bend: f64) -> f64 {
    let h = b.x - a.x;
    let left = |s: f64| a.value + (a.slope + 0.5 * bend * s) * s;
    let right = |s: f64| {
        let t = h - s;
        b.value - (b.slope - 0.5 * bend * t) * t
    };
    // Each is highest at an end of its part, wherever the parts meet; best where both agree: their difference is linear.
    let (at_a, at_b) = (left(0.0) - right(0.0), left(h) - right(h));
    let meet = if at_a < 0.0 && at_b > 0.0 { h * at_a / (at_a - at_b) } else { 0.5 * h };
    left(meet).max(right(meet)).max(a.value).max(b.value)
}
