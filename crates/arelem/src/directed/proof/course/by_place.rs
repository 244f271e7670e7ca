//! A bound from above of the clearance of a tool that turns, by a place of the surface: also where the surface ends, beside which nothing bounds how
//! distances from it bend.

use std::borrow::Cow;

use apt_geometry::Vec3;

use super::{Course, Sample};
use crate::clearance::Tool;

impl Course<'_, '_> {
    /// Whether the place of the surface that is touched at one end of a stretch shows that a turning tool is nowhere above the band on it.
    ///
    /// How far a place is from a convex body, signed, is a convex function of the place, and changes by no more than that moves. Seen from the
    /// tool the place goes on a chord, on which it is nowhere farther from the tool than at its ends, but for how far its way bends off that: a
    /// tool that turns by ω for each unit of length makes it accelerate by ω² times its arm and by 2ω, so that on a stretch of length h it
    /// is off the chord by h²/8 of that at most.
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
        let (length, rate) = (b.x - a.x, sweep.rate().norm());
        [a, b].into_iter().any(|touched| {
            let place = &touched.contact.surface;
            let arm = ends.iter().fold(0.0_f64, |arm, (tip, _)| arm.max((place - tip).norm()));
            let off_chord = 0.125 * length * length * rate * (rate * arm + 2.0);
            ends.iter().all(|(tip, tool)| {
                let most = role.gauge.at_most_by(tool, tip, place);
                most.is_some_and(|most| most + off_chord <= limits[1])
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
        clearance::Tool,
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
}
