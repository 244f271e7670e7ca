//! A bound from above of the clearance of a tool that turns, by a place of the surface: also where the surface ends, beside which nothing bounds how
//! distances from it bend.

use std::borrow::Cow;

use apt_geometry::Vec3;

use super::{Course, Sample};
use crate::clearance::Tool;

impl Course<'_, '_> {
    /// Whether the place of the surface that is touched at one end of a stretch shows that a turning tool is nowhere above the band on it, or one that goes
    /// on the surface evenly from there to the place that is touched at the other end.
    ///
    /// How far a place is from a convex body, signed, is a convex function of the place, and changes by no more than that moves. Seen from the
    /// tool the place goes on a chord, on which it is nowhere farther from the tool than at its ends, but for how far its way bends off that: a
    /// tool that turns by ω for each unit of length makes it accelerate by ω² times its arm and by 2ω times its speed as seen from the tool end, so that on a
    /// stretch of length h it is off the chord by h²/8 of that at most.
    pub(super) fn is_held_by_place(&self, a: &Sample, b: &Sample) -> bool {
        let (sweep, role, limits) = (self.line.sweep, self.line.role, self.line.limits);
        // A disk is carried around the tool end, and nothing touches the open top of a tool.
        let ends = [a, b].map(|end| sweep.at(end.x));
        let is_from_below = |(end, (tip, tool)): (&Sample, &(Vec3, Cow<'_, Tool<'_>>))| {
            role.gauge.touches_from_below(tool, tip, &end.contact)
        };
        if role.gauge.on || role.gauge.disk.is_some() || [a, b].into_iter().zip(&ends).any(is_from_below) {
            return false;
        }
        let places = [a, b].map(|end| end.contact.surface);
        let stays = places.map(|place| ([place; 2], 0.0));
        let goes = role.gauge.strays_between(places.each_ref()).map(|stray| (places, stray));
        let (length, rate) = (b.x - a.x, sweep.rate().norm());
        stays.into_iter().chain(goes).any(|(places, stray)| {
            let arm = |k: usize| (places[k] - ends[k].0).norm();
            let speed = ((places[1] - places[0]) / length - sweep.direction).norm();
            let off_chord = 0.125 * length * length * rate * (rate * arm(0).max(arm(1)) + 2.0 * speed);
            ends.iter().zip(&places).all(|((tip, tool), place)| {
                let most = role.gauge.at_most_by(tool, tip, place);
                most.is_some_and(|most| most + off_chord + stray <= limits[1])
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::{
        Vec3,
        cutter::Cutter,
        motion::{NamedSurface, Relation},
        patience::Patience,
    };

    use crate::{
        attitude::Sweep,
        clearance::{EVALUATIONS, Tool},
        directed::proof::{Ledger, extremes},
        error::RoleName,
        role::Working,
        tests::{Program, level, sheets::ruled, v},
    };

    /// Radius of the tool, and the band on either side, in the unit of the wall.
    const RADIUS: f64 = 0.25;
    const TOLERANCE: f64 = 0.01;
    /// How far the flank is from the end: that much of the band is left outside.
    const OFF: f64 = TOLERANCE - 2e-4;

    /// Clearances that may be computed along an edge; 33 are where each place of that is left behind.
    const MOST_ALONG_EDGE: u64 = 5;

    /// A wall along x, past whose end, an upright line, the flank of a tool goes while it turns about the direction of contact: it stays as far from
    /// that line, by nearly as much as the band allows.
    #[test]
    fn a_tool_that_turns_beside_an_end_is_held_by_its_places() {
        let edge = |z: f64| (level(z), v(0.0, 0.0, z), v(2.0, 0.0, z), Vec3::z());
        let wall = NamedSurface { name: String::new(), geometry: ruled([edge(0.0), edge(1.0)]) };
        let mut p = Program::new();
        p.tolerance(TOLERANCE, TOLERANCE).cutter(&[2.0 * RADIUS]);
        let mut role =
            Working::new(&p.state, RoleName::Drive, &wall, Relation::To, false, Patience::default())
                .expect("a wall");
        role.set_side(role.gauge.surface.signed_distance(&v(1.0, 1.0, 0.5)).signum());
        let end = role.gauge.surface.foot(&v(1e3, 0.0, 0.5)).point;
        assert!(role.gauge.surface.ends_at(&v(1e3, 0.0, 0.5)));
        let out = v(0.6, 0.8, 0.0);
        let tool = Tool::new(Cutter::from_numbers(&[2.0 * RADIUS], 1.0).expect("a cutter"), Vec3::z());
        let at = |lean: f64, height: f64| {
            let axis = (Vec3::z() + Vec3::z().cross(&out) * lean).normalize();
            (end + out * (RADIUS + OFF) + Vec3::z() * height - axis * 0.5, axis)
        };
        let [from, to] = [at(-0.05, 0.0), at(0.05, 0.2)];
        let contact = |(tip, axis): &(Vec3, Vec3)| role.gauge.contact(&tool.turned(*axis), tip);
        let contacts = [contact(&from), contact(&to)];
        assert!(contacts.iter().all(|contact| (contact.clearance - OFF).abs() < 1e-9), "{contacts:?}");
        let sweep = Sweep::new(&tool, (&from.0, &from.1), (&to.0, &to.1));
        let ends = [(&from.0, &contacts[0]), (&to.0, &contacts[1])];
        let found = extremes(&sweep, &role, &Ledger::default(), ends[0], ends[1], 1.0, Patience::default());
        assert!(found.proven, "{found:?}");
    }

    /// The flank of a tool goes along the upper edge of a leaning wall while it turns about the direction of contact: that goes along, too, and each place of
    /// the edge is left behind.
    #[test]
    fn a_tool_that_turns_along_an_edge_is_held_by_a_place_that_goes_along() {
        let out = v(0.0, 0.8, 0.6);
        let back = v(0.0, -0.6, 0.8);
        let edge = |z: f64| (level(z), v(0.0, 0.0, z), v(2.0, 0.0, z), Vec3::z());
        let wall = NamedSurface { name: String::new(), geometry: ruled([edge(0.0), edge(1.0)]) };
        let numbers = [2.0 * RADIUS];
        let mut p = Program::new();
        p.tolerance(TOLERANCE, TOLERANCE).cutter(&numbers);
        let mut role =
            Working::new(&p.state, RoleName::Drive, &wall, Relation::To, false, Patience::default())
                .expect("a wall");
        role.set_side(role.gauge.surface.signed_distance(&v(1.0, 1.0, 0.5)).signum());
        let top = role.gauge.surface.foot(&v(0.9, 0.0, 1e3)).point.z;
        let tool = Tool::new(Cutter::from_numbers(&numbers, 1.0).expect("a cutter"), Vec3::z());
        let at = |x: f64, lean: f64| {
            let axis = (back + Vec3::x() * lean).normalize();
            (v(x, 0.0, top) + out * (RADIUS + OFF) - axis * 0.5, axis)
        };
        let [from, to] = [at(0.8, -0.02), at(1.0, 0.02)];
        let contact = |(tip, axis): &(Vec3, Vec3)| role.gauge.contact(&tool.turned(*axis), tip);
        let contacts = [contact(&from), contact(&to)];
        assert!(contacts.iter().all(|contact| (contact.clearance - OFF).abs() < 1e-9), "{contacts:?}");
        let sweep = Sweep::new(&tool, (&from.0, &from.1), (&to.0, &to.1));
        let ends = [(&from.0, &contacts[0]), (&to.0, &contacts[1])];
        let before = EVALUATIONS.get();
        let found = extremes(&sweep, &role, &Ledger::default(), ends[0], ends[1], 1.0, Patience::default());
        assert!(found.proven, "{found:?}");
        let clearances = EVALUATIONS.get() - before;
        assert!(clearances <= MOST_ALONG_EDGE, "{clearances} clearances");
    }
}
