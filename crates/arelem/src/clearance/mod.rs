//! Signed clearance between tool and surface as one function of the tool end (arelem reference 1.6 and 5.2), with
//! its gradient and the contact points.

mod between;
mod certify;
mod closed_form;
mod cover;
mod crease;
mod dual;
mod empty;
mod enough;
mod floor;
mod kept;
mod matched;
mod memory;
mod near;
mod nearly_straight;
mod open_top;
mod patch;
mod quadric;
mod round;
mod search;
mod tool;
mod waves;

use std::borrow::Cow;

use apt_geometry::{
    Vec3,
    cutter::Disk,
    surface::{Bend, Convexity, Foot, Region, Surface},
};

use self::{
    certify::Effort,
    crease::Beside,
    floor::Bases,
    memory::ByParts,
    near::{Around, Followed},
};
pub(crate) use self::{
    certify::{Certificate, Face},
    cover::{Witness, steady_bend, upward_bend},
    enough::Enough,
};
pub use self::{memory::Memory, tool::Tool};

/// Where tool and surface are nearest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Signed distance, positive when separated; negative depth when the tool cuts into the surface.
    pub clearance: f64,
    /// Unit gradient with respect to the tool end: the surface normal turned towards the tool.
    pub gradient: Vec3,
    /// The tool's contact point; the tool end for ON.
    pub tool: Vec3,
    /// The surface's contact point.
    pub surface: Vec3,
}

impl Contact {
    /// The same of what is on the other side of the place of the surface, and comes out past that.
    fn seen_from_behind(self) -> Self {
        Self { clearance: -self.clearance, gradient: -self.gradient, ..self }
    }
}

/// How clearance behaves along a straight line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Linear.
    Flat,
    /// A convex function: at most one interior minimum.
    Convex,
    /// A concave function: at most one interior maximum.
    Concave,
    /// Anything smooth.
    General,
}

/// A surface with a relation to keep: what clearance is measured, and from which side.
#[derive(Debug, Clone, PartialEq)]
pub struct Gauge {
    /// The surface.
    pub surface: Surface,
    /// True for ON: the tool end itself is measured and THICK does not count.
    pub on: bool,
    /// Side of the natural normal that the tool lives on.
    pub side: f64,
    /// THICK.
    pub thickness: f64,
    /// The disk that is measured in place of the tool; it does not count for ON.
    pub disk: Option<Disk>,
    /// Where contact was last.
    pub memory: Memory,
}

impl Gauge {
    /// What is measured from: the surface as the tool meets it on its side, for ON the surface alone.
    pub(crate) fn met(&self, tool: &Tool) -> &Surface {
        if self.on { &self.surface } else { self.surface.met_from(self.side, tool.patience) }
    }

    /// Clearance with contact points for a tool whose end is at `tip`.
    pub fn contact(&self, tool: &Tool, tip: &Vec3) -> Contact {
        if self.on {
            if let Some(contact) = near::foot(tool, &self.surface, self.side, tip, &self.memory) {
                return contact;
            }
            let foot = self.surface.foot(tip);
            return Contact {
                clearance: self.side * foot.distance,
                gradient: foot.normal * self.side,
                tool: *tip,
                surface: foot.point,
            };
        }
        self.offset_contact(tool, tip, Enough::ALL).0
    }

    /// The contact near the last one where that is proven, else as it is found where nothing need be proven: another point of the
    /// tool may be nearer. For places that are only passed through.
    pub(crate) fn contact_passing(&self, tool: &Tool, tip: &Vec3) -> Contact {
        self.passing(tool, tip, false).0
    }

    /// The same where the last one leads, if it leads anywhere, and whether it is what is found, too.
    pub(crate) fn contact_passing_followed(&self, tool: &Tool, tip: &Vec3) -> (Contact, bool) {
        self.passing(tool, tip, true)
    }

    fn passing(&self, tool: &Tool, tip: &Vec3, follows: bool) -> (Contact, bool) {
        if self.on || !self.surface.has_charts() {
            return (self.contact(tool, tip), true);
        }
        let Self { side, thickness, memory, .. } = self;
        let (tool, tip) = self.body(tool, tip);
        let surface = self.met(&tool);
        let level = |contact: Contact| Contact { clearance: contact.clearance - thickness, ..contact };
        if let Some(contact) = closed_form::contact(&tool, surface, *side, &tip) {
            return (level(contact), true);
        }
        let beside = Beside { tool: &tool, surface, side: *side, tip: &tip };
        let has_last = memory.has_last(*side);
        if follows && let Some(contact) = memory.crease_passed(*side).and_then(|spot| beside.along(&spot)) {
            return (level(contact), false);
        }
        match near::contact(&tool, surface, *side, &tip, memory) {
            Followed::Proven(contact, _) => {
                memory.pass_crease(*side, None);
                return (level(contact), true);
            }
            Followed::Likely(_, contact) if follows && has_last => return (level(contact), false),
            Followed::Likely(..) | Followed::Lost => {}
        }
        let found = search::found(&tool, Face { surface, side: *side }, &tip);
        near::remember(&tool, surface, *side, &tip, memory, &found);
        memory.pass_crease(*side, beside.spot(&found.surface));
        (level(found), true)
    }

    /// The contact where the last one leads, and whether it is known to be the nearest: that is shown only where it is done at once, or where no
    /// last one leads anywhere.
    pub(crate) fn contact_followed(&self, tool: &Tool, tip: &Vec3) -> (Contact, bool) {
        if self.on || !self.surface.has_charts() {
            return (self.contact(tool, tip), true);
        }
        let Self { side, thickness, ref memory, .. } = *self;
        let (tool, tip) = &self.body(tool, tip);
        let surface = self.met(tool);
        let level = |contact: Contact| Contact { clearance: contact.clearance - thickness, ..contact };
        if let Some(contact) = closed_form::contact(tool, surface, side, tip) {
            return (level(contact), true);
        }
        let beside = Beside { tool, surface, side, tip };
        if let Some(contact) = memory.crease(side).and_then(|spot| beside.along(&spot)) {
            return (level(contact), false);
        }
        let has_last = memory.has_last(side);
        match near::contact(tool, surface, side, tip, memory) {
            Followed::Proven(contact, missed) => {
                memory.remember_level(&tool.axis, side, tip, contact.clearance - missed);
                (level(contact), true)
            }
            Followed::Likely(_, contact) if has_last => (level(contact), false),
            Followed::Likely(..) | Followed::Lost => (level(self.least_contact(tool, tip)), true),
        }
    }

    /// The contact as closely as it is asked for, and how much nearer to the surface another point of the tool may be for all that the search
    /// knows: infinitely much where it proves nothing.
    pub(crate) fn contact_within(&self, tool: &Tool, tip: &Vec3, enough: Enough) -> (Contact, f64) {
        if self.on { (self.contact(tool, tip), 0.0) } else { self.offset_contact(tool, tip, enough) }
    }

    /// What is measured, and where its end is: the tool, or the disk in its place.
    pub(crate) fn body<'a>(&self, tool: &'a Tool<'a>, tip: &Vec3) -> (Cow<'a, Tool<'a>>, Vec3) {
        match &self.disk {
            Some(disk) if !self.on => {
                let disk_alone = Tool::awaited(disk.cutter(), tool.axis, tool.patience);
                (Cow::Owned(disk_alone), tip + tool.axis * disk.height)
            }
            _ => (Cow::Borrowed(tool), *tip),
        }
    }

    /// A distance from the tool end beyond which there is nothing that is measured.
    pub(crate) fn reach(&self, tool: &Tool) -> f64 {
        match &self.disk {
            Some(disk) if !self.on => disk.reach(),
            _ => tool.reach(),
        }
    }

    /// A distance from the tool end beyond which there is nothing that is measured and not farther from the surface than a level.
    pub(crate) fn reach_within(&self, tool: &Tool, tip: &Vec3, level: f64) -> f64 {
        let reach = self.reach(tool);
        if self.disk.is_some() {
            return reach;
        }
        let height = Around::new(self, tool, tip, 0.0).height_within(level);
        reach.min(height.hypot(tool.radius()))
    }

    fn offset_contact(&self, tool: &Tool, tip: &Vec3, enough: Enough) -> (Contact, f64) {
        let Self { side, thickness, memory, .. } = self;
        let (tool, tip) = self.body(tool, tip);
        let mut found =
            offset_contact(&tool, self.met(&tool), *side, &tip, Some(memory), enough.above(*thickness));
        let (contact, missed) = &mut found;
        // Without anything missed it is known otherwise, or the nearest of a family only.
        if *missed > 0.0 && missed.is_finite() {
            memory.remember_level(&tool.axis, *side, &tip, contact.clearance - *missed);
        }
        contact.clearance -= thickness;
        found
    }

    /// Whether the clearance is nowhere on the tool below a level; the contact that was found there tells where to look first.
    pub(crate) fn certify(
        &self,
        tool: &Tool,
        (tip, found): (&Vec3, Option<&Contact>),
        level: f64,
    ) -> Certificate {
        let (tool, tip) = &self.body(tool, tip);
        let surface = self.met(tool);
        let (face, level) = (Face { surface, side: self.side }, level + self.thickness);
        if self.memory.has_shown(&tool.axis, self.side, tip, level) {
            return Certificate::Holds;
        }
        #[cfg(test)]
        CERTIFIED.set(CERTIFIED.get() + 1);
        if let Some(posed) = quadric::Posed::new(tool, surface, self.side, tip) {
            let contact = self.least_contact(tool, tip);
            if contact.clearance >= level && posed.clears(level, &contact) {
                return Certificate::Holds;
            }
        }
        if let Followed::Proven(contact, missed) = near::contact(tool, surface, self.side, tip, &self.memory)
            && contact.clearance - missed >= level
        {
            return Certificate::Holds;
        }
        if let Some(spot) = self.memory.crease(self.side)
            && let beside = (Beside { tool, surface, side: self.side, tip })
            && let Some((_, touch)) = beside.touch(&spot)
            && let Some(contact) = beside.leading_off(touch)
            && beside.clears(&contact, level)
        {
            return Certificate::Holds;
        }
        let known = self.memory.place(tool, self.side).map(|place| tip + place.point);
        let touching = known.or(found.map(|contact| contact.tool));
        if touching.is_some_and(|point| search::lies_above(tool, face, (tip, &point), level, &self.memory)) {
            return Certificate::Holds;
        }
        let bases = touching.map(|point| Bases::about(tool, tip, (surface, self.side), &point));
        let mut proof = self.memory.proof(tool, self.side, tip);
        let found = certify::certify(face, tool, tip, level, &mut proof, bases.as_ref(), Effort::All);
        self.memory.keep_proof(self.side, proof);
        // What is deeper than that at some place may come out past the end of the surface by less.
        let may_come_out = level < 0.0 && surface.has_ends();
        if found == Certificate::Undecided && surface.has_charts()
            || found != Certificate::Holds && may_come_out
        {
            // Parts of the surface may tell, from the contact.
            let contact = self.least_contact(tool, tip);
            let beside = Beside { tool, surface, side: self.side, tip };
            if beside.is_off_own_side(&contact) && beside.clears(&contact, level) {
                return Certificate::Holds;
            }
        }
        found
    }

    /// The contact of a body with the surface itself.
    fn least_contact(&self, body: &Tool, end: &Vec3) -> Contact {
        offset_contact(body, self.met(body), self.side, end, Some(&self.memory), Enough::ALL).0
    }

    /// Whether patches of the tool did not decide about the last contact that was searched for.
    pub(crate) fn is_hard(&self) -> bool {
        self.memory.by_parts() == ByParts::Needed
    }

    /// A bound from above of the clearance of a tool by one place of the surface, which is nowhere nearer to it than its nearest place, nor less
    /// deep in it than it is deep in the surface: a way that frees the tool leads that place out of it. `None` for a place over the open top.
    pub(crate) fn at_most_by(&self, tool: &Tool, tip: &Vec3, place: &Vec3) -> Option<f64> {
        let (body, end) = self.body(tool, tip);
        let from_end = place - end;
        let is_over = open_top::is_above_top(&body, &from_end);
        (!is_over).then(|| crease::outward(&body, &from_end).0 - self.thickness)
    }

    /// How far the chord between two places of the surface is from that at most, where it is known: beside each place of the chord is one of the surface.
    pub(crate) fn strays_between(&self, places: [&Vec3; 2]) -> Option<f64> {
        self.surface.strays_between(places)
    }

    /// Whether a tool touches with the edge of its top what is above it: nothing touches the disc there.
    pub(crate) fn touches_from_below(&self, tool: &Tool, tip: &Vec3, contact: &Contact) -> bool {
        let (tool, tip) = self.body(tool, tip);
        open_top::touches_from_below(&tool, &tip, contact)
    }

    /// Whether the place of the surface that is nearest to a point, no farther from it than a distance, is where the surface ends.
    pub(crate) fn ends_at(&self, point: &Vec3, distance: f64) -> bool {
        !near::goes_on_at(&self.surface, self.side, point, distance, &self.memory)
            && self.surface.ends_at(point)
    }

    /// A bound of the second derivative, by the length of the way, of the distance of a point that goes a straight way.
    pub(crate) fn bend_at(&self, tool: &Tool, point: &Vec3, way: &Vec3) -> Option<f64> {
        self.bend_about(tool, &(point + way * 0.5), 0.5 * way.norm())
    }

    /// The same for a point that goes anywhere in a ball.
    pub(crate) fn bend_about(&self, tool: &Tool, center: &Vec3, radius: f64) -> Option<f64> {
        let surface = self.met(tool);
        let center = *center;
        let foot = surface.foot(&center);
        let distance = self.side * foot.distance;
        let region = Region { center, radius, lowest: distance - radius, highest: distance + radius };
        match surface.bend(self.side, &foot, &region, tool.patience) {
            Bend::AtMost(bend) => Some(bend),
            Bend::Unbounded => None,
        }
    }

    /// The same of the tool's point at a contact that goes no farther from there than a way.
    pub(crate) fn bend_beside(&self, tool: &Tool, contact: &Contact, way: f64) -> Option<f64> {
        let distance = contact.clearance + self.thickness;
        let foot = Foot {
            distance: self.side * distance,
            point: contact.surface,
            normal: contact.gradient * self.side,
        };
        let region =
            Region { center: contact.tool, radius: way, lowest: distance - way, highest: distance + way };
        match self.met(tool).bend(self.side, &foot, &region, tool.patience) {
            Bend::AtMost(bend) => Some(bend),
            Bend::Unbounded => None,
        }
    }

    /// The same for the tool's point at a contact on a surface with charts, by how the surface bends along the way; the tool end is there.
    /// It is told closely where it is more than enough.
    pub(crate) fn bend_along(
        &self,
        (tool, tip): (&Tool, &Vec3),
        contact: &Contact,
        way: &Vec3,
        enough: f64,
    ) -> Option<f64> {
        if self.on || !self.surface.has_charts() {
            return None;
        }
        let (tool, tip) = &self.body(tool, tip);
        let contact = Contact { clearance: contact.clearance + self.thickness, ..*contact };
        Around::new(self, tool, tip, 0.0).bend_along(&contact, way, enough)
    }

    /// Whether the tool is a disc seen along generators or rulings of the surface, away from the ends of one that ends.
    pub(crate) fn is_seen_along(&self, tool: &Tool, tip: &Vec3) -> bool {
        let (body, tip) = self.body(tool, tip);
        !self.on && closed_form::is_disc(&body, self.met(tool), &tip)
    }

    /// How the clearance behaves along a straight line, but for a solid that reaches into the top of the tool.
    pub fn shape(&self) -> Shape {
        shape(&self.surface, self.side)
    }

    /// How it behaves on a straight way of a tool end.
    pub(crate) fn shape_along(&self, tool: &Tool, [from, to]: [&Vec3; 2]) -> Shape {
        let shape = self.shape();
        // Other solids are measured with the disc at the top of the tool.
        if shape != Shape::Convex || self.on || !matches!(self.surface, Surface::Quadric(_)) {
            return shape;
        }
        let (body, start) = self.body(tool, from);
        let end = to + (start - from);
        if open_top::is_entered(&body, &self.surface, self.side, [&start, &end]) {
            Shape::General
        } else {
            shape
        }
    }
}

impl Gauge {
    /// Whether the tool, on a straight way of its end between two contacts, is beside one of the two convex halves that a solid
    /// consists of, and farther than a clearance from the other: its clearance is then that from a convex solid.
    pub(crate) fn is_beside_one_half(
        &self,
        tool: &Tool,
        [(from, first), (to, last)]: [(&Vec3, &Contact); 2],
        clearance: f64,
    ) -> bool {
        if self.on || !matches!(self.surface, Surface::Quadric(_)) {
            return false;
        }
        let (body, start) = self.body(tool, from);
        let end = to + (start - from);
        let posed = |tip: &Vec3| quadric::Posed::new(&body, &self.surface, self.side, tip);
        let (Some(here), Some(there)) = (posed(&start), posed(&end)) else { return false };
        let touched =
            |contact: &Contact| Contact { clearance: contact.clearance + self.thickness, ..*contact };
        let (first, last) = (touched(first), touched(last));
        let (Some(half), Some(same)) = (here.half_beside(&first), there.half_beside(&last)) else {
            return false;
        };
        let far = clearance + self.thickness + (to - from).norm();
        half.is(&same)
            && here.keeps_off(&half, far, &first)
            && !open_top::is_entered(&body, &self.surface, self.side, [&start, &end])
    }
}

/// How the distance of a tool on one side of a surface behaves along a straight line.
fn shape(surface: &Surface, side: f64) -> Shape {
    match (surface.convexity(), side > 0.0) {
        (Convexity::Flat, _) => Shape::Flat,
        (Convexity::Convex, true) | (Convexity::Hollow, false) => Shape::Convex,
        (Convexity::Convex, false) | (Convexity::Hollow, true) => Shape::Concave,
        (Convexity::General, _) => Shape::General,
    }
}

/// True if the clearance needs no search: it is then the least one for certain.
pub(crate) fn has_closed_form(gauge: &Gauge, tool: &Tool, tip: &Vec3) -> bool {
    let (tool, tip) = gauge.body(tool, tip);
    closed_form::contact(&tool, &gauge.surface, gauge.side, &tip).is_some()
}

#[cfg(test)]
pub(crate) use self::{
    certify::JUDGED,
    cover::{BOXES, STEADY_ASKED},
    kept::{CONTACTS_ASKED, PARTS_ASKED},
    near::LOOKS,
    quadric::{FLOORS, STEPS},
    search::LOOKS_EVERYWHERE,
};

#[cfg(test)]
thread_local! {
    /// Clearances that this thread has computed.
    pub(crate) static EVALUATIONS: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
    /// Levels that it has proven to be kept in one position of a tool, where that had not been shown by a contact.
    pub(crate) static CERTIFIED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// Distance between the tool body and the surface, with the tool on the given side; and how much less it may be.
fn offset_contact(
    tool: &Tool,
    surface: &Surface,
    side: f64,
    tip: &Vec3,
    memory: Option<&Memory>,
    enough: Enough,
) -> (Contact, f64) {
    #[cfg(test)]
    EVALUATIONS.set(EVALUATIONS.get() + 1);
    if let Some(contact) = closed_form::contact(tool, surface, side, tip) {
        return (contact, 0.0);
    }
    if let Some(found) = memory.and_then(|memory| quadric::contact(tool, surface, side, tip, memory)) {
        return found;
    }
    if let Some(contact) = matched::contact(tool, surface, side, tip) {
        if let Some(memory) = memory {
            memory.remember_corner(tool, side, tip, &contact);
        }
        return (contact, 0.0);
    }
    if let Some(found) = quadric::contact_anywhere(tool, surface, side, tip, memory) {
        return found;
    }
    if let Some(contact) = dual::contact(tool, surface, side, tip) {
        return (contact, 0.0);
    }
    let beside = Beside { tool, surface, side, tip };
    if let Some(found) = memory.and_then(|memory| beside.followed(memory)) {
        return found;
    }
    let likely = match memory.map(|memory| near::contact(tool, surface, side, tip, memory)) {
        Some(Followed::Proven(contact, missed)) => return (contact, missed),
        Some(Followed::Likely(piece, contact)) => Some((piece, contact)),
        Some(Followed::Lost) | None => None,
    };
    let found = search::contact(tool, Face { surface, side }, tip, (memory, likely), enough);
    if let Some(memory) = memory {
        near::remember(tool, surface, side, tip, memory, &found.0);
        memory.remember_crease(side, beside.spot(&found.0.surface));
    }
    found
}

/// Distance of the whole tool from a surface without regard to sides: positive when they do not touch, on whichever
/// side the tool is; the side with the greater clearance. The side that the tool end is on is asked first: how deep a tool
/// that is clear on one side is from the other is dear and of no account. What was found last on either side is remembered.
pub(crate) fn separation(
    tool: &Tool,
    surface: &Surface,
    tip: &Vec3,
    memories: &[Memory; 2],
    enough: Enough,
) -> (Contact, f64) {
    let side = if surface.signed_distance(tip) < 0.0 { -1.0 } else { 1.0 };
    let contact = |side: f64| {
        let memory = &memories[usize::from(side < 0.0)];
        let surface = surface.met_from(side, tool.patience);
        offset_contact(tool, surface, side, tip, Some(memory), enough).0
    };
    let here = contact(side);
    if here.clearance >= 0.0 {
        return (here, side);
    }
    let beyond = contact(-side);
    let is_here = here.clearance > beyond.clearance || here.clearance == beyond.clearance && side > 0.0;
    if is_here { (here, side) } else { (beyond, -side) }
}

#[cfg(test)]
mod tests;
