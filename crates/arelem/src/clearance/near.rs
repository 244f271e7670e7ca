//! Contact with tabulated cylinders, ruled and polyconic surfaces from the last contact near by.
//!
//! Newton's method moves the azimuth on a circle of the tool, or the place on its flat bottom or on a slanted piece, and the place of
//! the surface at once. What it finds is the contact if the tool about it lies in a ball that is known to be steady: there the
//! distance falls below its tangent by no more than a sphere's does, along a slanted bottom by no more than a cylinder's
//! ([`trough`]), and circles of the tool have closed bounds. The rest of the flank is far away, as is
//! shown once for many positions.

mod around;
mod far;
mod held;
mod last;
mod pieces;
mod touch;
mod trough;
mod zone;

use std::{cell::Cell, sync::Arc};

use apt_geometry::{
    Vec3,
    surface::{Place, Steady, Surface},
};

pub(super) use self::around::{Around, Feet};
use self::far::{Doubts, End, Far, Flank};
#[cfg(test)]
pub(crate) use self::held::LOOKS;
use self::held::{Cap, Held};
use self::last::Last;
use self::trough::{Acrosses, Bends, Grounds};
use super::{Contact, Tool, memory::Memory};

/// Places that are remembered: the ends of a vector, and some between them.
const MOST_PLACES: usize = 6;
/// What following a contact counts in units of work.
const WORK_OF_CONTACT: u32 = 4;
/// Pieces of the tool that are tried for a contact.
const MAX_PIECES: u32 = 4;
/// Shares of the size of the tool and of the coordinates that are rounding of a distance.
const ROUNDING: f64 = 1e-12;
const COORDINATES: f64 = 1e-14;
/// Sizes of a steady ball that are tried about a contact on the bottom or the corner. Where a surface ends beside the tool, or turns
/// away, only small balls are steady, which hold what of the tool is near the contact.
const BALLS: [Size; 9] = [
    Size::all(0.8, f64::INFINITY),
    Size::all(0.8, 1.0),
    Size::all(0.8, 0.3),
    Size::all(0.3, 0.3),
    Size::all(0.1, 0.1),
    Size::all(0.03, 0.05),
    Size { ease: 0.1, beyond: 0.3, depth: 0.3 },
    Size { ease: 0.05, beyond: 0.1, depth: 0.1 },
    Size { ease: 0.03, beyond: 0.05, depth: 0.03 },
];
/// The same about a contact on the flank.
const FLANK_BALLS: [Size; 9] = [
    Size::all(0.8, f64::INFINITY),
    Size::all(0.8, 2.0),
    Size::all(0.8, 1.0),
    Size { ease: 0.3, beyond: 1.0, depth: 0.3 },
    Size { ease: 0.1, beyond: 0.7, depth: 0.3 },
    Size { ease: 0.1, beyond: 0.4, depth: 0.3 },
    Size { ease: 0.1, beyond: 0.3, depth: 0.1 },
    Size { ease: 0.05, beyond: 0.2, depth: 0.05 },
    Size { ease: 0.03, beyond: 0.1, depth: 0.03 },
];
/// Share of what a ball holds to either side of a contact on the flank that is to be left there.
const BESIDE: f64 = 0.25;
/// Share of the distance that the tool may move in a ball by which it lies ahead.
const AHEAD: f64 = 0.75;
/// Sizes of balls for a single point.
const POINT_BALLS: [f64; 4] = [2.0, 0.5, 0.1, 0.02];
/// Way, in radii of the tool, after which a ball is tried for again.
const PATIENCE: f64 = 0.1;
/// Radius, as a share of its height, that a thin tool counts with.
const SLENDER: f64 = 0.05;
/// How much deeper than at first the tool may come to lie in a steady ball.
const DEEPER: f64 = 1.2;
/// Bound of the stretches of the corner's arc that are looked at, and half the widest one (radians): the tangents at its ends meet
/// near by.
const MAX_ARCS: u32 = 24;
const WIDEST_ARC: f64 = 0.8;
/// Bound of the balls that cover a flank, and the shortest stretch, in radii of the tool, that one of them covers.
const MAX_COVER: u32 = 40;
const SHORTEST: f64 = 0.1;

/// The last contacts here and there, the one that was asked for last first: a path is looked at from both ends of a vector in
/// turn.
#[derive(Debug, Default, Clone)]
pub(crate) struct Contacts {
    places: Vec<Near>,
    /// What is known of the ends of the tool, the last first: it holds wherever the tool has not moved far.
    far: Vec<Far>,
}

/// A contact near by with what is known about it.
#[derive(Debug, Clone)]
pub(crate) struct Near {
    side: f64,
    /// The tool end then.
    tip: Vec3,
    start: Start,
    /// The surface's point at the last contact.
    surface: Vec3,
    /// How near the tool was there.
    last: Option<Last>,
    zone: Result<Zone, Vec3>,
    /// How the flank was last shown to be far.
    flank: Option<Flank>,
    /// Where an end of the tool was not far: what lies above contact, below, and behind.
    doubts: [Doubts; 3],
    /// How the surface bends about the bottom of the tool, or where that was not found.
    bends: Result<Arc<Bends>, Vec3>,
    /// How much along the bottom's straight piece.
    across: Cell<Acrosses>,
}

/// Where Newton's method begins.
#[derive(Debug, Clone, Copy)]
struct Start {
    /// Index among the pieces of the tool; `None` for the tool end.
    piece: Option<usize>,
    /// Cosine and sine of the azimuth; coordinates across the axis on the flat bottom.
    direction: [f64; 2],
    /// How far along a slanted piece, as a share of its length from the lower end.
    rise: f64,
    place: Place,
}

/// Size of a steady ball, in radii of the tool.
#[derive(Debug, Clone, Copy)]
struct Size {
    /// How far the tool may move in it.
    ease: f64,
    /// How much of the flank it holds: above the corner, or to either side of a contact there.
    beyond: f64,
    /// How much of that behind the contact.
    depth: f64,
}

impl Size {
    /// That holds all the way through the tool.
    const fn all(ease: f64, beyond: f64) -> Self {
        Self { ease, beyond, depth: f64::INFINITY }
    }
}

/// A steady ball, and what of the tool is to lie in it.
#[derive(Debug, Clone, Copy)]
struct Zone {
    center: Vec3,
    radius: f64,
    /// Greatest distance from the surface for which it is steady.
    depth: f64,
    held: Held,
    /// Which of the sizes it has.
    size: usize,
    steady: Steady,
    /// The tool end where it was made, and no place of a cap was farther from the surface.
    tip: Vec3,
    deepest: f64,
}

/// A circle of balls about the tool axis; a point for radius 0.
#[derive(Debug, Clone, Copy)]
struct Circle {
    radius: f64,
    height: f64,
    ball: f64,
}

impl Circle {
    /// A point that is at hand itself.
    const POINT: Self = Self { radius: 0.0, height: 0.0, ball: 0.0 };
}

/// What Newton's method found.
struct Touch {
    contact: Contact,
    /// The point of the circle.
    center: Vec3,
    circle: Circle,
    start: Start,
}

/// What following the last contact has found.
pub(super) enum Followed {
    /// The contact, and how much nearer another point may be.
    Proven(Contact, f64),
    /// Contact of a piece of the tool, perhaps not the nearest.
    Likely(usize, Contact),
    /// Nothing.
    Lost,
}

/// The contact near the last one.
pub(super) fn contact(tool: &Tool, surface: &Surface, side: f64, tip: &Vec3, memory: &Memory) -> Followed {
    let Ok(mut memory) = memory.near.try_borrow_mut() else { return Followed::Lost };
    if !surface.has_charts() || tool.patience.ends_after(WORK_OF_CONTACT) {
        return Followed::Lost;
    }
    let pose = Pose { tool, surface, side, tip };
    let Some((known, far)) = memory.about(&pose, || pose.first()) else { return Followed::Lost };
    let Some(found) = known.touch(&pose) else { return Followed::Lost };
    let slack = pose.slack();
    if known.proves(&pose, &found, slack, far) {
        known.note(&pose, found.start, &found.contact);
        return Followed::Proven(found.contact, slack);
    }
    if !known.may_be_nearest(&pose, &found.contact) {
        return Followed::Lost;
    }
    found.start.piece.map_or(Followed::Lost, |piece| Followed::Likely(piece, found.contact))
}

/// Keeps a contact of the tool.
pub(super) fn remember(
    tool: &Tool,
    surface: &Surface,
    side: f64,
    tip: &Vec3,
    memory: &Memory,
    contact: &Contact,
) {
    let Ok(mut memory) = memory.near.try_borrow_mut() else { return };
    let pose = Pose { tool, surface, side, tip };
    let Some(start) = pose.start_at(contact) else { return };
    let first = || Some(Near::new(&pose, start, contact.surface));
    if let Some((known, _)) = memory.about(&pose, first) {
        known.note(&pose, start, contact);
    }
}

/// Whether a ruled or polyconic surface is known to go on about its place nearest to a point that is no farther from it than a distance,
/// on a side: it does about steady balls.
pub(super) fn goes_on_at(surface: &Surface, side: f64, point: &Vec3, distance: f64, memory: &Memory) -> bool {
    let Ok(memory) = memory.near.try_borrow() else { return false };
    let holds = |zone: &Zone| (point - zone.center).norm() <= zone.radius && distance <= zone.depth;
    matches!(surface, Surface::Ruled(_) | Surface::PolyConic(_))
        && memory.places.iter().any(|known| known.side == side && known.zone.as_ref().is_ok_and(holds))
}

/// The foot of the tool end itself with its signed distance, as a contact.
pub(super) fn foot(
    tool: &Tool,
    surface: &Surface,
    side: f64,
    tip: &Vec3,
    memory: &Memory,
) -> Option<Contact> {
    if !surface.has_charts() || tool.patience.ends_after(WORK_OF_CONTACT) {
        return None;
    }
    let mut memory = memory.near.try_borrow_mut().ok()?;
    let pose = Pose { tool, surface, side, tip };
    let (known, _) = memory.about(&pose, || {
        let start = Start { piece: None, direction: [1.0, 0.0], rise: 0.0, place: surface.place(tip)? };
        Some(Near::new(&pose, start, *tip))
    })?;
    match pose.touch(&known.start) {
        Some(found) if known.is_steady(&pose, &found) => {
            (known.start, known.surface) = (found.start, found.contact.surface);
            Some(found.contact)
        }
        _ => {
            known.start.place = surface.place(tip)?;
            None
        }
    }
}

impl Contacts {
    /// What is known about the place of a tool, or else what is to begin with there: that of the nearest place.
    fn about(
        &mut self,
        pose: &Pose<'_>,
        first: impl FnOnce() -> Option<Near>,
    ) -> Option<(&mut Near, &mut Vec<Far>)> {
        let Self { places, far } = self;
        places.retain(|known| known.side == pose.side);
        far.retain(|known| known.side == pose.side);
        if let Some(known) = places.iter().position(|known| known.holds(pose)) {
            places[..=known].rotate_right(1);
        } else {
            let away = |known: &&Near| (known.tip - pose.tip).norm_squared();
            let nearest = places.iter().min_by(|a, b| away(a).total_cmp(&away(b))).cloned();
            let known = nearest.or_else(first)?;
            places.truncate(MOST_PLACES - 1);
            places.insert(0, known);
        }
        let known = places.first_mut()?;
        known.tip = *pose.tip;
        Some((known, far))
    }

    /// Which place it is that was known last about that of a tool, best where the tool may stray from there, or else the last one.
    fn at(&self, pose: &Pose<'_>, spread: f64) -> Option<usize> {
        let find = |serves: &dyn Fn(&Near) -> bool| {
            self.places.iter().position(|known| known.side == pose.side && serves(known))
        };
        let wide =
            |known: &Near| known.zone.as_ref().is_ok_and(|zone| pose.stays_in(zone, &known.surface, spread));
        let found = if spread > 0.0 { find(&wide) } else { None };
        found.or_else(|| find(&|known| known.holds(pose))).or_else(|| find(&|_| true))
    }

    /// What is known of an end of the tool, as far as it serves a place of the tool best.
    fn far(&self, pose: &Pose<'_>, end: End) -> Option<&Far> {
        let here = self.far.iter().filter(|known| known.side == pose.side && known.end.has(end, pose));
        let left = here.map(|known| (known.left(pose), known));
        left.max_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, known)| known)
    }
}

impl Near {
    /// A contact about which nothing is known.
    fn new(pose: &Pose<'_>, start: Start, surface: Vec3) -> Self {
        let (side, tip, nowhere) = (pose.side, *pose.tip, Vec3::repeat(f64::INFINITY));
        Self {
            side,
            tip,
            start,
            surface,
            last: None,
            zone: Err(nowhere),
            flank: None,
            doubts: [Doubts::default(); 3],
            bends: Err(nowhere),
            across: Cell::default(),
        }
    }

    /// Whether the tool is where the contact is known, or where it has just been looked for in vain.
    fn holds(&self, pose: &Pose<'_>) -> bool {
        match &self.zone {
            Ok(zone) => pose.stays_in(zone, &self.surface, 0.0),
            Err(tried) => (pose.tip - tried).norm() <= PATIENCE * pose.scale(),
        }
    }

    /// A contact on the last piece of the tool or on one that is tried instead.
    fn touch(&self, pose: &Pose<'_>) -> Option<Touch> {
        let (mut start, mut lowest) = (self.start, None::<Touch>);
        for _ in 0..MAX_PIECES {
            let found = pose.touch(&start);
            if found.as_ref().is_some_and(|found| pose.is_apt(found)) {
                return found;
            }
            let next = pose.instead(&start, found.as_ref());
            let lower = |found: &Touch| {
                lowest.as_ref().is_none_or(|known| found.contact.clearance < known.contact.clearance)
            };
            if let Some(found) = found.filter(|found| pose.is_of_tool(found) && lower(found)) {
                lowest = Some(found);
            }
            match next {
                Some(next) => start = next,
                None => break,
            }
        }
        lowest
    }

    /// Whether no point of the tool is nearer than the contact by more than a slack.
    fn proves(&mut self, pose: &Pose<'_>, found: &Touch, slack: f64, far: &mut Vec<Far>) -> bool {
        if !self.is_steady(pose, found) {
            return false;
        }
        let Ok(zone) = self.zone else { return false };
        let (contact, ball, level) = (&found.contact, found.circle.ball, found.contact.clearance - slack);
        let held = pose.on_flank(contact).map(|_| zone.held);
        let flank = pose.flank_keeps(contact, &zone, level);
        let keeps = flank && pose.bottom_keeps(contact, ball, &zone, level)
            || (flank || held.is_some()) && self.lies_in_trough(pose, contact, held, level);
        if !keeps && held.is_none() {
            return false;
        }
        // On a flank the ends of the tool are looked at all the same: a lower level, as between two contacts, may be kept with them.
        zone.ends(pose).into_iter().flatten().fold(keeps, |keeps, end| {
            let is_alone = self.is_alone(pose, end, level, far);
            keeps && is_alone
        })
    }

    /// Whether the tool about a contact, and the contact, are within a steady ball.
    fn is_steady(&mut self, pose: &Pose<'_>, found: &Touch) -> bool {
        let kept = self.zone.as_ref().is_ok_and(|zone| pose.is_in(zone, found));
        if !kept {
            let again = match &self.zone {
                Ok(_) => true,
                Err(tried) => (pose.tip - tried).norm() > PATIENCE * pose.scale(),
            };
            if again {
                self.zone = pose.zone(found, self.zone.as_ref().ok()).ok_or(*pose.tip);
            }
        }
        let Ok(zone) = &self.zone else { return false };
        pose.is_in(zone, found)
            && found.contact.clearance + zone.held.ball(found.circle.ball) >= -zone.steady.beyond
    }

    /// Whether a slanted bottom and the corner, or what of the tool is held about a contact on its flank, keep a level as they would from
    /// a cylinder.
    fn lies_in_trough(&mut self, pose: &Pose<'_>, contact: &Contact, held: Option<Held>, level: f64) -> bool {
        let Ok(Zone { steady, held: all, .. }) = self.zone else { return false };
        if held.is_none() && pose.tool.profile.lower.height <= 0.0 {
            return false;
        }
        let grounds = Grounds { steady, level, stray: 0.0, held: all, is_flank: held.is_some() };
        let Some(extent) = pose.extent(contact, &grounds) else { return false };
        let kept = self.bends.as_ref().is_ok_and(|bends| bends.hold(pose, contact, &grounds, extent));
        let patient = |tried: &Vec3| (pose.tip - tried).norm() <= PATIENCE * pose.scale();
        if !kept && !self.bends.as_ref().is_err_and(patient) {
            self.bends = Bends::about(pose, contact, &grounds, extent).map(Arc::new).ok_or(*pose.tip);
            self.across = Cell::default();
        }
        let Ok(bends) = &self.bends else { return false };
        let trough = bends.trough(pose, contact, &grounds, extent, self.across.get_mut());
        trough.is_some_and(|trough| pose.lies_in(&trough, contact, held, level))
    }
}

/// A tool in a position beside a surface.
#[derive(Clone, Copy)]
struct Pose<'a> {
    tool: &'a Tool<'a>,
    surface: &'a Surface,
    side: f64,
    tip: &'a Vec3,
}

impl Pose<'_> {
    /// Rounding of a distance.
    fn slack(&self) -> f64 {
        ROUNDING * (self.tool.radius() + self.tool.profile.top.height) + COORDINATES * self.tip.amax()
    }

    /// The length that sizes of balls are measured by.
    fn scale(&self) -> f64 {
        let height = SLENDER * self.tool.profile.top.height;
        let scale = self.tool.radius().max(height);
        if scale > 0.0 { scale } else { 1.0 }
    }

    /// Where contact may be, seen from the corner of the tool.
    fn first(&self) -> Option<Near> {
        let middle = self.tip + self.tool.axis * self.tool.profile.corner_height();
        let foot = self.surface.foot(&middle);
        let gradient = foot.normal * self.side;
        let ((piece, rise), place) = (self.piece_towards(&gradient)?, self.surface.place(&middle)?);
        let start = Start { piece: Some(piece), direction: self.facing(&gradient), rise, place };
        Some(Near::new(self, start, foot.point))
    }
}
