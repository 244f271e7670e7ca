//! Bounds from above of the clearance on the straight way of a tool end from one contact to another, by these alone.

use apt_geometry::Vec3;

use super::{Contact, Gauge, Tool, crease::Beside, near, open_top};

impl Gauge {
    /// A bound from above of the clearance on the straight way of the tool end from one contact to another, where the tool does
    /// not cut in or is at an edge of the surface. The tool is no farther from the surface than from each of its two points of contact, and its distance from a
    /// point is a convex function of its place.
    pub(crate) fn at_most_between(&self, tool: &Tool, contacts: [(&Vec3, &Contact); 2]) -> Option<f64> {
        if self.on {
            return None;
        }
        let [(from, first), (to, last)] = contacts;
        if let Some(most) = self.at_most_along_edge(tool, contacts) {
            return Some(most);
        }
        let distance = |point: &Vec3, tip: &Vec3| {
            let (tool, tip) = self.body(tool, tip);
            let from_tip = point - tip;
            let (along, across, _) = tool.split(&from_tip);
            let found = tool.profile.distance(across, along).0 - self.thickness;
            (!open_top::is_above_top(&tool, &from_tip)).then_some(found)
        };
        let [ahead, behind] = [(first, from, to), (last, to, from)].map(|(contact, here, there)| {
            distance(&contact.surface, here).and_then(|_| distance(&contact.surface, there))
        });
        let (ahead, behind) = (ahead?, behind?);
        let (start, end) = (first.clearance, last.clearance);
        let outside =
            [start, end, ahead, behind].into_iter().all(|clearance| clearance + self.thickness >= 0.0);
        // By as much as any place of an edge is deep in the tool it must be moved at least to be clear.
        let by_edge = self.memory.crease(self.side).is_some();
        (outside || by_edge).then(|| {
            // Where the two chords meet.
            let (falls, rises) = ((behind - start).max(0.0), (ahead - end).max(0.0));
            let share = if falls + rises > 0.0 { falls / (falls + rises) } else { 0.0 };
            (start + share * (ahead - start)).max(behind + share * (end - behind)).max(start.max(end))
        })
    }

    /// The same by a curve on the surface between the places of both contacts, also where the tool cuts in. The signed distance of a place from
    /// the tool, which is convex, is a convex function of the place from its end: along the chord of the curve it is nowhere above its own chord, and beside
    /// the chord greater by no more than the curve strays from it. A tool is no farther from the surface than from a place of it, and one that
    /// has a place of it within is not clear.
    pub(crate) fn at_most_along_surface(&self, tool: &Tool, contacts: [(&Vec3, &Contact); 2]) -> Option<f64> {
        if self.on {
            return None;
        }
        let stray = self.surface.strays_between(contacts.map(|(_, contact)| &contact.surface))?;
        let [(tool, start), (_, end)] = contacts.map(|(tip, contact)| {
            let (tool, tip) = self.body(tool, tip);
            (tool, contact.surface - tip)
        });
        let distance = |from_tip: &Vec3| {
            let (along, across, _) = tool.split(from_tip);
            tool.profile.distance(across, along).0
        };
        // The place of the curve beside one of the chord may be the farthest off anywhere along it.
        let most = distance(&start).max(distance(&end)) + stray;
        let over_top = open_top::at_most_over_top(&tool, [&start, &end], stray)?;
        Some(most.max(over_top) - self.thickness)
    }

    /// The same by a line at which the surface ends, if both contacts are there.
    fn at_most_along_edge(
        &self,
        tool: &Tool,
        [(from, first), (to, last)]: [(&Vec3, &Contact); 2],
    ) -> Option<f64> {
        if near::goes_on_at(&self.surface, self.side, &first.surface, 0.0, &self.memory) {
            return None;
        }
        let (tool, start) = &self.body(tool, from);
        let beside = Beside { tool, surface: self.met(tool), side: self.side, tip: start };
        Some(beside.at_most_along(&(to + (start - from)), [first, last])? - self.thickness)
    }
}
