//! What the contact near by tells about other points and about moves of the tool.

use std::cell::Ref;

use apt_geometry::{
    Vec3,
    surface::{Foot, Steady},
};

use super::{Contacts, End, Far, Near, Pose, Start, Zone, trough::Grounds};
use crate::clearance::{Contact, Gauge, Tool};

/// Distances from a contact, in radii of the tool, from which on the ends of the tool are tried for being far.
const ENDS: [f64; 3] = [1.0, 2.0, 4.0];

/// Distance from the ends of the tool, in radii of it, beyond which a level is told to be kept.
const BARELY: f64 = 1e-6;

/// What is known about a tool and a surface, for questions about points near by.
pub(in crate::clearance) struct Around<'a> {
    pose: Pose<'a>,
    contacts: Option<Ref<'a, Contacts>>,
    /// Which of the places serves.
    place: Option<usize>,
}

impl Zone {
    /// Whether the way of a point in contact is in the ball.
    fn holds_way(&self, contact: &Contact, way: &Vec3) -> bool {
        let is_in = |p: &Vec3| (p - self.center).norm() <= self.radius;
        let Contact { clearance, tool: point, surface, .. } = contact;
        is_in(point) && is_in(&(point + way)) && is_in(surface) && clearance + way.norm() <= self.depth
    }
}

/// The steady ball about a contact, for feet of points near by.
#[derive(Clone, Copy)]
pub(in crate::clearance) struct Feet<'a> {
    pose: Pose<'a>,
    known: Option<(Start, Zone)>,
}

impl<'a> Around<'a> {
    pub(in crate::clearance) fn new(
        gauge: &'a Gauge,
        tool: &'a Tool<'a>,
        tip: &'a Vec3,
        spread: f64,
    ) -> Self {
        let Gauge { side, memory, .. } = gauge;
        let pose = Pose { tool, surface: gauge.met(tool), side: *side, tip };
        let contacts = memory.near.try_borrow().ok();
        let place = contacts.as_ref().and_then(|contacts| contacts.at(&pose, spread));
        Self { pose, contacts, place }
    }

    /// The last contact near by.
    fn near(&self) -> Option<&Near> {
        self.contacts.as_ref()?.places.get(self.place?)
    }

    /// The same with its steady ball.
    fn known(&self) -> Option<(&Near, &Zone)> {
        let near = self.near()?;
        Some((near, near.zone.as_ref().ok()?))
    }

    /// Whether a steady ball is known about the contact.
    pub(in crate::clearance) fn is_steady(&self) -> bool {
        self.known().is_some()
    }

    /// What tells the feet of points near by; contacts can be looked for meanwhile.
    pub(in crate::clearance) fn feet(self) -> Feet<'a> {
        Feet { pose: self.pose, known: self.known().map(|(near, zone)| (near.start, *zone)) }
    }

    /// A bound of the second derivatives of the distances of all points of the tool that are not farther than `range[1]` while
    /// no point strays farther than `spread` from its place and none comes nearer than `range[0]`.
    pub(in crate::clearance) fn upward_bend(&self, spread: f64, range: [f64; 2]) -> Option<f64> {
        let (Near { start, surface, .. }, zone) = self.known()?;
        start.piece?;
        let level = range[1] + spread;
        let is_far = |end: End| {
            self.far(end, level).is_some()
                || match end {
                    End::Above(from) if zone.held.low <= 0.0 => self.pose.is_off(from, level),
                    _ => self.is_apart(end, level),
                }
        };
        let alone = self.pose.stays_in(zone, surface, spread)
            && zone.ends(&self.pose).into_iter().flatten().all(is_far);
        alone.then(|| zone.steady.upward_bend(range[0])).flatten()
    }

    /// Whether the clearance is nowhere below a level while the tool end moves straight from one position to another, by the
    /// contact in one of them.
    pub(in crate::clearance) fn keeps(&self, contact: &Contact, way: [&Vec3; 2], level: f64) -> bool {
        let Some((near, zone)) = self.known().filter(|(near, _)| near.start.piece.is_some()) else {
            return false;
        };
        let Tool { axis, profile, .. } = self.pose.tool;
        let polar = contact.gradient.dot(axis).clamp(-1.0, 1.0).acos();
        let has_balls = profile.arc > 0.0 && !profile.is_barrel();
        let on_corner = has_balls && polar >= profile.fan[0] && polar <= profile.fan[1];
        let ball = if on_corner { profile.arc } else { 0.0 };
        let held_ball = zone.held.ball(ball);
        let place = contact.tool + contact.gradient * held_ball;
        if (place - zone.center).norm() > zone.radius || contact.clearance + held_ball > zone.depth {
            return false;
        }
        let kept = |tip: &Vec3| Pose { tip, ..self.pose }.stays_in(zone, &contact.surface, 0.0);
        let [from, to] = way;
        let start = Pose { tip: from, ..self.pose };
        let is_far =
            |far: &Far| [from, to].into_iter().all(|tip| far.left(&Pose { tip, ..self.pose }) >= level);
        let is_apart = |end: End| {
            self.farthest(end).is_some_and(is_far)
                || start.is_apart_on_way(end, to, level.max(0.0) + BARELY * start.scale())
        };
        let flank = |tip: &Vec3| Pose { tip, ..self.pose }.flank_keeps(contact, zone, level);
        let by_ball = |tip: &Vec3| Pose { tip, ..self.pose }.bottom_keeps(contact, ball, zone, level);
        let held = Pose { tip: way[0], ..self.pose }.on_flank(contact).map(|_| zone.held);
        let by_cylinder = || {
            let (stray, is_flank) = ((way[1] - way[0]).norm(), held.is_some());
            if !is_flank && profile.lower.height <= 0.0 {
                return false;
            }
            let Ok(bends) = &near.bends else { return false };
            let grounds = Grounds { steady: zone.steady, level, stray, held: zone.held, is_flank };
            let mut across = near.across.take();
            let kept = way.into_iter().all(|tip| {
                let pose = Pose { tip, ..self.pose };
                let extent = pose.extent(contact, &grounds);
                let trough = extent
                    .filter(|extent| bends.hold(&pose, contact, &grounds, *extent))
                    .and_then(|extent| bends.trough(&pose, contact, &grounds, extent, &mut across));
                trough.is_some_and(|trough| pose.lies_in(&trough, contact, held, level))
            });
            near.across.set(across);
            kept
        };
        let flank = way.into_iter().all(flank);
        contact.clearance + held_ball >= -zone.steady.beyond
            && way.into_iter().all(kept)
            && (flank && way.into_iter().all(by_ball) || (flank || held.is_some()) && by_cylinder())
            && zone.ends(&self.pose).into_iter().flatten().all(is_apart)
    }

    /// A bound of the second derivative, by the length of the way, of the distance of a point in contact that goes a straight way in the
    /// steady ball: of how much the surface bends along the way where feet of the point are.
    ///
    /// At a distance d from a surface with the form S it is that of `−S (1 − d S)⁻¹`: beyond the surface that is more than `−S` by
    /// `|d| S²` where S bends towards the point, and as much by the greater bend of the parallel surface there where it bends away.
    pub(in crate::clearance) fn bend_along(&self, contact: &Contact, way: &Vec3, enough: f64) -> Option<f64> {
        let Pose { tool, surface, side, .. } = self.pose;
        let Contact { clearance, tool: point, gradient, .. } = contact;
        let (length, stock) = (way.norm(), surface.stock(side));
        let along = way.try_normalize(0.0)?;
        let ball = match self.known() {
            Some((_, zone)) if zone.holds_way(contact, way) => (zone.steady, zone.depth),
            _ => self.steady_about(contact, way)?,
        };
        let (steady, depth) = ball;
        let farthest = clearance + length;
        if farthest > depth {
            return None;
        }
        let hollow = steady.bend(farthest.max(-stock));
        let nearest = clearance + gradient.dot(way).min(0.0) - 0.5 * hollow * length * length;
        let round = steady.upward_bend(nearest)?;
        let behind = (-(nearest + stock)).max(0.0);
        let ahead = (farthest + stock).max(0.0);
        let reach = 0.5 * length * (1.0 + ahead * hollow).max(1.0 + behind * round);
        let middle = surface.foot(&(point + way * 0.5));
        let center = middle.point - middle.normal * (side * stock);
        let away = surface.bend_along(side, &center, reach, (&along, enough), tool.patience)?.max(0.0);
        let bend = away + behind * hollow.max(round).powi(2);
        bend.is_finite().then_some(bend)
    }

    /// A steady ball about the way of a point in contact, and its depth.
    fn steady_about(&self, contact: &Contact, way: &Vec3) -> Option<(Steady, f64)> {
        let Pose { tool, surface, side, .. } = self.pose;
        let Contact { clearance, tool: point, surface: foot, .. } = contact;
        let middle = surface.foot(&(point + way * 0.5));
        // On the side that it is asked from.
        let center = middle.point + middle.normal * (side * (side * middle.distance).max(0.0));
        let farthest = |p: &Vec3| (p - center).norm();
        let radius = farthest(point).max(farthest(&(point + way))).max(farthest(foot));
        let depth = (clearance + way.norm()).max(0.0);
        surface.steady(side, &center, [radius, depth], tool.patience).map(|steady| (steady, depth))
    }

    /// Heights between which all of the tool is that is not known to be farther from the surface than a level; beside a contact on the
    /// flank they are looked for.
    pub(in crate::clearance) fn within(&self, level: f64) -> [f64; 2] {
        let upper = self.pose.tool.profile.upper.height;
        let below = match self.far_end(1, level) {
            Some(End::Below(to)) => Some(to),
            _ => self.tried(-1.0).find(|to| *to > upper && self.is_apart(End::Below(*to), level)),
        };
        [below.unwrap_or(0.0), self.top_within(level)]
    }

    /// The upper one of these heights.
    fn top_within(&self, level: f64) -> f64 {
        let top = self.pose.tool.profile.top.height;
        let above = match self.far_end(0, level) {
            Some(End::Above(from)) => Some(from),
            _ => self.tried(1.0).find(|from| *from < top && self.is_apart(End::Above(*from), level)),
        };
        above.unwrap_or(top)
    }

    /// Heights above a contact on the flank, or below it, at which an end of the tool may be far enough.
    fn tried(&self, sense: f64) -> impl Iterator<Item = f64> {
        let Pose { tool, tip, .. } = &self.pose;
        let height = self.near().map(|near| tool.axis.dot(&(near.surface - *tip)));
        let height = height.filter(|height| *height > tool.profile.upper.height);
        let scale = self.pose.scale();
        height.into_iter().flat_map(move |height| ENDS.map(|share| height + sense * share * scale))
    }

    /// What is known to keep a level of the ends of the tool about the last contact: above it, below it.
    fn far_end(&self, which: usize, level: f64) -> Option<End> {
        let ends = self.known().map_or([None; 3], |(_, zone)| zone.ends(&self.pose));
        self.far(ends[which]?, level)
    }

    /// The upper one of these heights; beside a contact below the flank one is looked for, too.
    pub(in crate::clearance) fn height_within(&self, level: f64) -> f64 {
        let profile = &self.pose.tool.profile;
        let (upper, top) = (profile.upper.height, self.top_within(level));
        if top < profile.top.height {
            return top;
        }
        let is_far = |from: &f64| self.pose.is_off(*from, level) || self.is_apart(End::Above(*from), level);
        let heights = ENDS.map(|share| upper + share * self.pose.scale());
        heights.into_iter().filter(|from| *from < top).find(is_far).unwrap_or(top)
    }

    /// Whether the sizes of the surface's parts show an end of the tool to be farther than a level.
    fn is_apart(&self, end: End, level: f64) -> bool {
        self.pose.apart_of(end, level.max(0.0)).is_some()
    }

    /// What is known of an end of the tool, as far as it serves here best.
    fn farthest(&self, end: End) -> Option<&Far> {
        self.contacts.as_ref()?.far(&self.pose, end)
    }

    /// What is known to keep a level and has an end of the tool.
    fn far(&self, end: End, level: f64) -> Option<End> {
        let far = self.farthest(end)?;
        (far.left(&self.pose) >= level).then_some(far.end)
    }
}

impl Feet<'_> {
    /// The foot of a point, if that is known to be the only one.
    pub(in crate::clearance) fn foot(&self, p: &Vec3) -> Option<Foot> {
        let (start, zone) = self.known.as_ref()?;
        let found = Pose { tip: p, ..self.pose }.touch(&Start { piece: None, ..*start })?;
        let Contact { clearance, gradient, surface, .. } = found.contact;
        let inside = |q: &Vec3| (q - zone.center).norm() <= zone.radius;
        let steady = clearance <= zone.depth && clearance >= -zone.steady.beyond;
        let known = inside(p) && inside(&surface) && steady;
        let side = self.pose.side;
        known.then_some(Foot { distance: side * clearance, point: surface, normal: gradient * side })
    }
}
