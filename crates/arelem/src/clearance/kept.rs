//! Whether the clearance keeps a level on the straight way of a tool end from one contact to another: by these, which takes little, or
//! by parts of the surface, some hundred of them.

use apt_geometry::{
    Vec3,
    surface::{Nearer, Surface},
};

use super::{
    Contact, Gauge, Tool,
    crease::{self, Beside},
    near::Around,
    quadric,
};

#[cfg(test)]
thread_local! {
    /// Ways of a tool about which this thread has asked its contacts, and parts of a surface.
    pub(crate) static CONTACTS_ASKED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
    pub(crate) static PARTS_ASKED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

impl Gauge {
    /// Whether the contacts show that the clearance is nowhere below a level on the straight way of the tool end from one to another.
    /// Half of it, up to a third position, is looked at from either.
    pub(crate) fn keeps_by_contacts(
        &self,
        tool: &Tool,
        contacts: [(&Vec3, &Contact); 2],
        between: &Vec3,
        level: f64,
    ) -> bool {
        if self.on {
            return false;
        }
        #[cfg(test)]
        CONTACTS_ASKED.set(CONTACTS_ASKED.get() + 1);
        let (tool, middle) = &self.body(tool, between);
        let level = level + self.thickness;
        let contacts = self.measured(contacts, &(middle - between));
        let posed = |tip| quadric::Posed::new(tool, &self.surface, self.side, tip);
        if let [(Some(first), from), (Some(last), to)] =
            contacts.each_ref().map(|(tip, contact)| (posed(tip), contact))
        {
            return [(first, from), (last, to)]
                .into_iter()
                .all(|(posed, contact)| posed.on_the_way_to(middle).clears(level, contact));
        }
        let around = Around::new(self, tool, middle, 0.0);
        self.surface.has_charts()
            && contacts.iter().all(|(tip, contact)| around.keeps(contact, [tip, middle], level))
    }

    /// The same by these, or by parts of the surface where contacts tell little.
    pub(crate) fn keeps_between(
        &self,
        tool: &Tool,
        contacts: [(&Vec3, &Contact); 2],
        between: &Vec3,
        level: f64,
    ) -> bool {
        if self.keeps_by_contacts(tool, contacts, between, level) {
            return true;
        }
        if self.on || !self.surface.has_charts() {
            return false;
        }
        let (tool, middle) = &self.body(tool, between);
        let contacts = self.measured(contacts, &(middle - between));
        // Beside an edge, and where several patches are near, no distance of a point is steady; a ball that is may be known from before the
        // tool came to the edge.
        let surface = self.met(tool);
        let is_by_edge = |(tip, contact): &(Vec3, Contact)| {
            Beside { tool, surface, side: self.side, tip }.has_edge_by(&contact.surface)
        };
        let is_unsteady = match surface {
            Surface::Sculptured(_) => true,
            Surface::Ruled(_) | Surface::PolyConic(_) => {
                let may_be = self.memory.crease(self.side).is_some()
                    || !Around::new(self, tool, middle, 0.0).is_steady();
                may_be && contacts.iter().any(is_by_edge)
            }
            _ => false,
        };
        let [(from, first), (to, last)] = &contacts;
        is_unsteady && self.parts_clear(tool, [(from, first), (to, last)], level + self.thickness)
    }

    /// Contacts as distances of what is measured, whose end is moved by a vector from the tool's, without THICK.
    fn measured(&self, contacts: [(&Vec3, &Contact); 2], moved: &Vec3) -> [(Vec3, Contact); 2] {
        contacts.map(|(tip, contact)| {
            (tip + moved, Contact { clearance: contact.clearance + self.thickness, ..*contact })
        })
    }

    /// Whether the parts of a surface show the same, whatever is steady there: they are beside ends of it, and where long and thin gaps
    /// are left beside the contact. Those of a sculptured one have been asked then.
    pub(crate) fn is_clear_between(
        &self,
        tool: &Tool,
        [(from, first), (to, last)]: [(&Vec3, &Contact); 2],
        level: f64,
    ) -> bool {
        if self.on || !self.surface.has_charts() || matches!(self.surface, Surface::Sculptured(_)) {
            return false;
        }
        let (tool, start) = &self.body(tool, from);
        let end = to + (start - from);
        self.parts_clear(tool, [(start, first), (&end, last)], level + self.thickness)
    }

    /// Whether the parts of a surface show that the clearance is nowhere below a level while the tool goes straight from one contact to another and
    /// turns evenly.
    pub(crate) fn is_clear_while_turning(
        &self,
        tools: [&Tool; 2],
        [(from, first), (to, last)]: [(&Vec3, &Contact); 2],
        level: f64,
    ) -> bool {
        // Both ends of a stretch meet the surface as one and the same.
        let is_same = std::ptr::eq(self.met(tools[0]), self.met(tools[1]));
        if self.on || self.disk.is_some() || !is_same || !self.surface.has_charts() {
            return false;
        }
        let Some(away) = (first.gradient + last.gradient).try_normalize(0.0) else { return false };
        let way = crease::Turning { poses: [(tools[0], from), (tools[1], to)], away: &away };
        // A part of the surface in which a place is too near is never shown to keep off, however fine it is cut.
        let touched = [first, last].map(|contact| Nearer { place: contact.surface, stock: 0.0 });
        let likely = touched.into_iter().chain(self.memory.too_near(self.side));
        match way.clears(self.met(tools[0]), level + self.thickness, likely) {
            Ok(()) => true,
            Err(nearer) => {
                if let Some(place) = nearer {
                    self.memory.remember_too_near(self.side, place);
                }
                false
            }
        }
    }

    /// Whether no part of the surface is nearer than a level to what is measured while its end goes straight from one contact to another.
    fn parts_clear(
        &self,
        tool: &Tool,
        [(from, first), (to, last)]: [(&Vec3, &Contact); 2],
        level: f64,
    ) -> bool {
        #[cfg(test)]
        PARTS_ASKED.set(PARTS_ASKED.get() + 1);
        let away = (first.gradient + last.gradient).try_normalize(0.0);
        let surface = self.met(tool);
        let normal = crease::square_to(surface, self.side, first);
        away.is_some_and(|away| crease::clears(surface, tool, [from, to], [&away, &normal], level))
    }
}
