//! Paths that come to the end of a surface that does not go on. Vectors are proven from what lies within reach of the tool,
//! so that they become shorter and shorter there; it is told before.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use apt_geometry::{Vec3, patience::Patience, surface::SurfaceEdge};

use super::{March, Vertex};
use crate::{
    clearance::{Contact, Tool},
    directed::Prepared,
    error::{MotionFailure, RoleName},
    role::Working,
};

/// How many times the bands ahead of a place without a way on, or with a very short one, it is looked whether a surface ends.
const AHEAD: f64 = 16.0;
/// Length of such a vector, times the bands.
const CREEPING: f64 = 0.1;
/// Halvings of a vector that find where it leads over the end of a surface.
const HALVINGS: u32 = 24;
/// Stretches of the flank and of the bottom's edge between places at which it is looked whether the tool touches a surface before its end.
const PLACES: u32 = 8;
/// Cosine of the greatest angle by which a path turns along the end of a surface; one that turns by more leads against the end. The place next to one
/// that lies straight ahead is ahead by the square of it.
const TURNED: f64 = 0.5;
/// Share of the way of a tool by which its place of contact with the end of a surface goes along that, at least, where the tool does: as much as
/// on a path at 45 degrees to the end.
const ALONG: f64 = FRAC_1_SQRT_2;
/// Cosine of the angle between contact and tool axis up to which the tool touches with its side.
const BESIDE: f64 = FRAC_1_SQRT_2;
/// Ratio of a vector to the one before below which the way on may be the way to the end of a surface.
const SHRINKING: f64 = 0.5;

/// Where a surface that the tool is guided by ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SurfaceEnd {
    pub(super) role: RoleName,
    pub(super) tip: Vec3,
    pub(super) axis: Vec3,
    pub(super) place: Vec3,
}

impl SurfaceEnd {
    /// The surface whose end the tool touches at a position, if one does.
    pub(super) fn at(prepared: &Prepared, vertex: &Vertex) -> Option<Self> {
        let Vertex { tip, axis, ref tangent, .. } = *vertex;
        let touches = [(&prepared.part, &vertex.part), (&prepared.drive, &vertex.drive)];
        let goes_over = |(role, contact): &(&Working, &Contact)| {
            is_over(role, &prepared.tool, contact, tangent)
                && !is_touched_inside(role, &prepared.tool.turned(axis), &tip, contact)
        };
        let (role, contact) = touches.into_iter().find(goes_over)?;
        let end = Self { role: role.name, tip, axis, place: contact.surface };
        (!end.is_gone_along(prepared, &vertex.tangent)).then_some(end)
    }

    /// The same a little ahead of a position.
    pub(super) fn just_ahead(prepared: &Prepared, vertex: &Vertex) -> Option<Self> {
        Self::ahead(prepared, vertex, just_ahead(prepared))
    }

    fn ahead(prepared: &Prepared, vertex: &Vertex, reach: f64) -> Option<Self> {
        let to = vertex.tip + vertex.tangent * reach;
        let found = Self::at(prepared, &Vertex::at(prepared, to, &vertex.tangent).ok()?)?;
        Some(found.from(prepared, vertex, &to))
    }

    /// Where on the straight way from a position to a place, at which the tool goes over this end, it comes to go over one.
    fn from(self, prepared: &Prepared, vertex: &Vertex, to: &Vec3) -> Self {
        let mut end = self;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let tip = vertex.tip + (to - vertex.tip) * middle;
            // Without an axis on the way, as in the vertex of a cone, the place found last stands.
            let Ok(there) = Vertex::at(prepared, tip, &vertex.tangent) else { break };
            match Self::at(prepared, &there) {
                Some(found) => (high, end) = (middle, found),
                None => low = middle,
            }
        }
        end
    }

    /// Whether the path, which leads over the end here, turns along it within the bands, as where the tool comes to touch the end with another place,
    /// by which it goes along; or where the top of a line passes below the end: beyond that it touches the end with its side, along which the place
    /// of contact goes. A path that leads over the end does not get on, or leaves that place behind. It is looked at as far outside the surfaces as
    /// the bands allow: at the end itself contact has no one direction.
    fn is_gone_along(&self, prepared: &Prepared, tangent: &Vec3) -> bool {
        let Prepared { tool, part, drive, .. } = prepared;
        // How deep a wider tool is there engine and verifier may tell differently: that its place goes along does not tell enough of it.
        let is_line = tool.radius() <= 0.0;
        let reach = just_ahead(prepared);
        let outside = [part, drive].map(|role| if role.outside > 0.0 { role.outside } else { role.rest() });
        let ahead = |from: &Vec3| Vertex::settled_at(prepared, outside, &(from + tangent * reach), tangent);
        let Some(turned) = ahead(&self.tip) else { return false };
        let Some(beyond) = ahead(&turned.tip) else { return false };
        let way = beyond.tip - turned.tip;
        let gets_on = |way: &Vec3| way.dot(tangent) >= TURNED * (TURNED * reach).max(way.norm());
        if !gets_on(&(turned.tip - self.tip)) || !gets_on(&way) {
            return false;
        }
        let guided = [(part, &turned.part, &beyond.part), (drive, &turned.drive, &beyond.drive)];
        guided.into_iter().all(|(role, contact, later)| {
            let is_led = role.name != self.role || is_at_end(role, contact);
            // Below the bottom contact with an end that is parallel to it may be anywhere.
            let is_beside = !role.gauge.on && contact.gradient.dot(&turned.axis).abs() <= BESIDE;
            let goes_along =
                is_line && is_beside && (later.surface - contact.surface).norm() >= ALONG * way.norm();
            is_led && (goes_along || !is_over(role, tool, contact, &way.normalize()))
        })
    }
}

/// How far ahead of a place the end of a surface is just ahead of it: a tool that touches the end is told to only where that is beyond what its
/// bands leave of the direction of contact.
pub(super) fn just_ahead(prepared: &Prepared) -> f64 {
    AHEAD * (prepared.part.band() + prepared.drive.band())
}

/// A place on the tool's side of a contact, and how far from it that is; that of a tool that is a little inside would be beside the end of a
/// surface that ends there.
fn above(role: &Working, contact: &Contact) -> (Vec3, f64) {
    let height = contact.clearance.max(role.band());
    (contact.surface + contact.gradient * height, height)
}

/// Whether the surface ends at the place nearest to that.
fn ends_below(role: &Working, contact: &Contact) -> bool {
    let (above, height) = above(role, contact);
    role.gauge.ends_at(&above, height)
}

/// Whether the tool touches the end of a role's surface.
pub(super) fn is_at_end(role: &Working, contact: &Contact) -> bool {
    ends_below(role, contact) || is_pushed_back(role, contact)
}

/// The place where the tool touches the end of a role's surface within the bands, and that alone, from the other side of the surface: on its own
/// side it has no position there.
pub(crate) fn end_from_behind(role: &Working, tool: &Tool, tip: &Vec3) -> Option<Vec3> {
    if role.gauge.on || !role.gauge.surface.has_ends() {
        return None;
    }
    let contact = role.gauge.contact(tool, tip);
    if (contact.clearance - role.rest()).abs() > role.band() {
        return None;
    }
    let edge = role.gauge.surface.edge_at(&place_at_end(role, &contact)?)?;
    let is_behind = is_from_behind(role, tool, &contact, &edge)
        && !is_touched_inside_on_its_side(role, tool, tip, &contact);
    is_behind.then_some(contact.surface)
}

/// Whether the tool touches the end of a role's surface, and that alone.
pub(super) fn is_beyond_end(role: &Working, tool: &Tool, tip: &Vec3) -> bool {
    let contact = role.gauge.contact(tool, tip);
    is_at_end(role, &contact) && !is_touched_inside(role, tool, tip, &contact)
}

/// Whether a tool that is a little inside a role's surface is so beyond the end of that, which pushes it back along the surface: the
/// place above the contact is over the surface then, that of the tool is not.
fn is_pushed_back(role: &Working, contact: &Contact) -> bool {
    contact.clearance < 0.0 && role.gauge.ends_at(&contact.tool, (contact.tool - contact.surface).norm())
}

/// Where the tool touches the end of a role's surface, a place beyond that.
fn place_at_end(role: &Working, contact: &Contact) -> Option<Vec3> {
    if ends_below(role, contact) {
        return Some(above(role, contact).0);
    }
    is_pushed_back(role, contact).then_some(contact.tool)
}

/// Whether the tool touches the end of a role's surface and, on a path, goes over it. What is beside a surface all along may touch the
/// end of it; but it goes along that, not out over it or down behind it, and it touches it from the own side of the surface.
fn is_over(role: &Working, tool: &Tool, contact: &Contact, path: &Vec3) -> bool {
    let Some(place) = place_at_end(role, contact) else { return false };
    let edge = role.gauge.surface.edge_at(&place);
    let Some(edge) = edge else { return true };
    let SurfaceEdge { outward, normal, along } = edge;
    let [out, behind] = [outward.dot(path), -role.gauge.side * normal.dot(path)].map(|way| way.max(0.0));
    role.gauge.on || out.hypot(behind) > along.dot(path).abs() || is_from_behind(role, tool, contact, &edge)
}

/// Whether the tool touches an end of a role's surface from the other side of that: led off the end it would come to be behind the surface, of
/// which no clearance tells, so that it is no position on either side of it. Within its bands a tool of radius r may be led √(2rτ) along
/// the end's tangents until it is τ off, which turns the direction of contact by √(2τ/r): by that much it may be square to the surface
/// or behind. A line that is behind the end is told to be in the surface ([`crate::clearance`]) and has no such side.
fn is_from_behind(role: &Working, tool: &Tool, contact: &Contact, edge: &SurfaceEdge) -> bool {
    let turned = (2.0 * role.band() / tool.radius()).sqrt();
    role.gauge.side * edge.normal.dot(&contact.gradient) < -turned
}

/// Whether a tool that touches the end of a surface touches it before the end, too, as along a straight piece: that guides it on.
fn is_touched_inside(role: &Working, tool: &Tool, tip: &Vec3, contact: &Contact) -> bool {
    let most = contact.clearance + role.band();
    has_place_inside(role, tool, tip, contact, |clearance| clearance <= most)
}

/// The same where the tool comes up to the surface from its own side: what is behind it by more does not touch it.
fn is_touched_inside_on_its_side(role: &Working, tool: &Tool, tip: &Vec3, contact: &Contact) -> bool {
    let apart = |clearance: f64| (clearance - contact.clearance).abs();
    has_place_inside(role, tool, tip, contact, |clearance| apart(clearance) <= role.band())
}

/// Whether a place of a tool that touches the end of a surface is before that end and has such a clearance.
fn has_place_inside(
    role: &Working,
    tool: &Tool,
    tip: &Vec3,
    contact: &Contact,
    is_such: impl Fn(f64) -> bool,
) -> bool {
    if role.gauge.on || role.gauge.disk.is_some() {
        return false;
    }
    let surface = role.gauge.met(tool);
    let touches = |place: &Vec3| {
        let clearance = role.gauge.side * surface.signed_distance(place) - role.gauge.thickness;
        is_such(clearance) && !surface.ends_at(place)
    };
    let profile = &tool.profile;
    let (_, _, radial) = tool.split(&(contact.tool - tip));
    let flank = (0..=PLACES).map(|k| {
        let share = f64::from(k) / f64::from(PLACES);
        let between = |low: f64, high: f64| low + share * (high - low);
        let radius = between(profile.upper.radius, profile.top.radius);
        tip + radial * radius + tool.axis * between(profile.upper.height, profile.top.height)
    });
    let bottom = (0..=PLACES).map(|k| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(PLACES)).sin_cos();
        let aside = tool.across[0] * cos + tool.across[1] * sin;
        tip + aside * profile.lower.radius + tool.axis * profile.lower.height
    });
    flank.chain(bottom).chain([*tip]).any(|place| touches(&place))
}

impl March<'_> {
    /// Where vectors become shorter: ends a motion whose path comes to the end of a surface before it meets a check surface.
    /// `here` and `next` are the ends of the last vector.
    pub(super) fn look_for_end(
        &mut self,
        here: &Vertex,
        next: &Vertex,
        patience: Patience<'_>,
    ) -> Result<(), MotionFailure> {
        if !self.has_ends() {
            return Ok(());
        }
        if let Some(end) = SurfaceEnd::at(self.prepared, next) {
            return Err(self.surface_ends(&end.from(self.prepared, here, &next.tip)));
        }
        let Prepared { part, drive, .. } = self.prepared;
        let length = (next.tip - here.tip).norm();
        if length <= CREEPING * (part.band() + drive.band())
            && let Some(failure) = self.without_surface(here)
        {
            return Err(failure);
        }
        let earlier = match self.points.len() {
            ..2 => return Ok(()),
            2 => self.prepared.tip,
            count => self.points[count - 3],
        };
        let shrinks = length < SHRINKING * (here.tip - earlier).norm();
        if !shrinks || self.ahead > 0.0 || self.points.len() < self.look_for_end {
            return Ok(());
        }
        self.look_for_end = 2 * self.points.len();
        self.judge_outlook(next, patience)
    }

    /// Where a surface ends within a radius of the tool ahead of a contact, so that proofs become dear: the same.
    pub(super) fn look_for_end_beside(
        &mut self,
        here: &Vertex,
        patience: Patience<'_>,
    ) -> Result<(), MotionFailure> {
        let Prepared { tool, part, drive, .. } = self.prepared;
        let ends = |(role, contact): (&Working, &Contact)| {
            let ahead = contact.tool + here.tangent * tool.radius();
            role.gauge.surface.has_ends() && role.gauge.ends_at(&ahead, (ahead - contact.surface).norm())
        };
        if self.ahead > 0.0
            || self.points.len() + 1 < self.look_for_end
            || ![(part, &here.part), (drive, &here.drive)].into_iter().any(ends)
        {
            return Ok(());
        }
        self.look_for_end = 2 * (self.points.len() + 1);
        self.judge_outlook(here, patience)
    }

    /// Where no vector goes on because a surface ends within reach of the tool: that.
    pub(super) fn without_surface(&self, here: &Vertex) -> Option<MotionFailure> {
        if !self.has_ends() {
            return None;
        }
        let Prepared { tool, .. } = self.prepared;
        let end = SurfaceEnd::just_ahead(self.prepared, here)
            .or_else(|| SurfaceEnd::ahead(self.prepared, here, tool.radius()));
        end.map(|end| self.surface_ends(&end))
    }

    fn has_ends(&self) -> bool {
        let Prepared { part, drive, .. } = self.prepared;
        [part, drive].into_iter().any(|role| role.gauge.surface.has_ends())
    }

    /// The evidence.
    pub(super) fn surface_ends(&self, SurfaceEnd { role, tip, axis, place }: &SurfaceEnd) -> MotionFailure {
        let remaining = Some(self.watcher.remaining(tip, axis)).filter(|distance| distance.is_finite());
        MotionFailure::SurfaceEnds { role: *role, tip: *tip, place: *place, remaining }
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

    use super::{is_over, is_pushed_back};
    use crate::{
        clearance::{Contact, Tool},
        error::RoleName,
        role::Working,
        tests::{Program, level, sheets::ruled, v},
    };

    /// Radius of the tool, and the band on either side, in the unit of the wall.
    const RADIUS: f64 = 0.25;
    const TOLERANCE: f64 = 0.001;

    /// A wall along x that is met from the side of y > 0, and a place of its end, which lies along z, on the side of x > 0.
    fn wall() -> (Working, Vec3) {
        let edge = |z: f64| (level(z), v(0.0, 0.0, z), v(2.0, 0.0, z), Vec3::z());
        let wall = NamedSurface { name: String::new(), geometry: ruled([edge(0.0), edge(1.0)]) };
        let mut p = Program::new();
        p.tolerance(TOLERANCE, TOLERANCE).cutter(&[2.0 * RADIUS]);
        let mut role =
            Working::new(&p.state, RoleName::Drive, &wall, Relation::To, false, Patience::default())
                .expect("a wall");
        role.set_side(role.gauge.surface.signed_distance(&v(1.0, 1.0, 0.5)).signum());
        // It goes on beyond what it is defined by.
        let (mut before, mut beyond) = (1.0, 100.0);
        while beyond - before > 1e-9 {
            let middle = 0.5 * (before + beyond);
            let ends = role.gauge.surface.ends_at(&v(middle, 0.0, 0.5));
            *(if ends { &mut beyond } else { &mut before }) = middle;
        }
        (role, v(before, 0.0, 0.5))
    }

    fn tool() -> Tool<'static> {
        Tool::new(Cutter::from_numbers(&[2.0 * RADIUS], 1.0).expect("a cutter"), Vec3::z())
    }

    /// A tool that is a little inside the wall just beyond its end, and pushed back.
    #[test]
    fn what_is_pushed_back_goes_over_the_end_unless_it_goes_along_it() {
        let (role, end) = wall();
        let gradient = v(-0.5, 1.0, 0.0).normalize();
        let contact = Contact { clearance: -1e-4, gradient, tool: end - gradient * 1e-4, surface: end };
        assert!(is_pushed_back(&role, &contact));
        for (path, goes_over) in [(Vec3::z(), false), (Vec3::x(), true), (v(2.0, 0.0, 1.0), true)] {
            assert_eq!(is_over(&role, &tool(), &contact, &path), goes_over, "{path:?}");
        }
    }

    /// Square to the wall it goes along its end, also by as much as contact turns within the bands, and from behind it does not.
    #[test]
    fn what_touches_an_end_from_behind_does_not_go_along_it() {
        let (role, end) = wall();
        let turned = (2.0 * (2.0 * TOLERANCE) / RADIUS).sqrt();
        for (behind, goes_over) in [(-0.5, false), (0.0, false), (0.9 * turned, false), (1.1 * turned, true)]
        {
            let gradient = Vec3::x() * f64::sqrt(1.0 - behind * behind) - Vec3::y() * behind;
            let contact = Contact { clearance: 0.0, gradient, tool: end, surface: end };
            assert_eq!(is_over(&role, &tool(), &contact, &Vec3::z()), goes_over, "{behind} behind");
        }
    }
}
