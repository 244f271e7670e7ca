//! Ways on which the path is parallel to a check surface: along the extension of a tabulated cylinder that lies in the line to which that is
//! tangent, above the line on which a bar and the part surface touch, or, also on a path that bends, where the surface becomes one with
//! the check surface.

use apt_geometry::{Vec3, patience::Patience};

use super::{
    Vertex,
    surface_end::{is_beyond_end, just_ahead},
    tangency::Sides,
};
use crate::{directed::Prepared, error::MotionFailure, role::Working};

/// Sine of the angle between a straight path and the check surface up to which they may be meant to be parallel: what the decimals of a slope
/// leave.
const NEARLY: f64 = 1e-4;
/// How much that sine, or the direction of a straight path, changes on a way by rounding.
const STEADY: f64 = 1e-9;
/// How far a way leads on at least, relative to the size of the coordinates: where a curve begins to bend with its third derivative alone, the
/// sine is rounding for a third of that.
const LEAST: f64 = 1e-4;
/// The longest step along a way as far as there may be surfaces, and how far that is, relative to the size of the coordinates.
const STEP: f64 = 0.02;
const SURFACES: f64 = 4.0;
/// A way that goes on so far, relative to the size of the coordinates, has no end.
const ENDLESS: f64 = 1e5;
/// Nor has one on which so many places were looked at: it goes round several times, or to and fro.
const MOST_PLACES: usize = 1000;
/// Cosine of the angle by which a path turns within one step of more than the least length, at most (17°).
const AHEAD: f64 = 0.956;
/// How far aside of its tangent a path is at most at the end of such a step, in its length.
const FARTHEST_ASIDE: f64 = 0.5;
/// Bound of the bisection of the last step.
const MAX_HALVINGS: u32 = 60;

/// Such a way, from a place on it.
pub(super) struct ParallelWay<'a> {
    prepared: &'a Prepared<'a>,
    check: &'a Working,
    /// The check surface from either side: where the tool first comes to touch the end of it both may be as near.
    sides: &'a Sides,
    patience: Patience<'a>,
    origin: Vertex,
    slope: f64,
}

/// Where on a way the tangency is.
pub(super) struct Stop {
    pub(super) vertex: Vertex,
    /// Whether the way has no end.
    pub(super) is_endless: bool,
}

/// Such a way in one sense.
struct Course<'w> {
    way: &'w ParallelWay<'w>,
    /// Along or against the path.
    sense: f64,
    /// Places on it with their distances along it, beginning with none; tangents lead on.
    places: Vec<(f64, Vertex)>,
}

/// Whether a path, by the rate at which the clearance of a check surface changes, may be on such a way.
pub(super) fn is_nearly_parallel(slope: f64) -> bool {
    slope.abs() <= NEARLY
}

impl<'a> ParallelWay<'a> {
    /// The way that leads on from a place where the check surface's clearance changes at this rate.
    pub(super) fn from(
        prepared: &'a Prepared<'a>,
        (check, sides): (&'a Working, &'a Sides),
        (place, slope): (&Vertex, f64),
        patience: Patience<'a>,
    ) -> Result<Option<Self>, MotionFailure> {
        if !is_nearly_parallel(slope) {
            return Ok(None);
        }
        let Some(origin) = Vertex::settled(prepared, &place.tip, &place.tangent) else { return Ok(None) };
        let (contact, side) = sides.nearer(prepared, &origin.tip)?;
        let slope = (contact.gradient * side).dot(&origin.tangent);
        let way = Self { prepared, check, sides, patience, origin, slope };
        let leads_on = way.course(1.0).next(LEAST * prepared.size).is_some();
        Ok(leads_on.then_some(way))
    }

    fn course(&self, sense: f64) -> Course<'_> {
        let origin = Vertex { tangent: self.origin.tangent * sense, ..self.origin };
        Course { way: self, sense, places: vec![(0.0, origin)] }
    }

    /// Where the tangency is: in the middle of the way, or where the motion begins on it at its end, and where it has no end at its
    /// beginning. Where a surface ends the way has no end: how far a sheet goes on straight is no place at which it becomes tangent to anything.
    pub(super) fn stop(&self, is_first: bool) -> Result<Option<Stop>, MotionFailure> {
        let [mut back, mut ahead] = [-1.0, 1.0].map(|sense| self.course(sense));
        let [before, beyond] = [back.end()?.filter(|_| !is_first), ahead.end()?];
        let middle = match (before, beyond) {
            (Some(before), Some(beyond)) => 0.5 * (beyond - before),
            (before, beyond) => beyond.or(before.map(|x| -x)).unwrap_or(0.0),
        };
        let course = if middle < 0.0 { &back } else { &ahead };
        let vertex = course.at(middle.abs());
        let is_endless = before.or(beyond).is_none();
        let along = |place: Vertex| Vertex { tangent: place.tangent * course.sense, ..place };
        Ok(vertex.map(|place| Stop { vertex: along(place), is_endless }))
    }

    /// The rate at which the clearance of the check surface changes on it.
    pub(super) fn slope(&self) -> f64 {
        self.slope
    }

    /// Whether a path that bends is on it, too: where it is parallel to the check surface, and not only nearly so.
    fn may_bend(&self) -> bool {
        self.slope.abs() <= STEADY
    }
}

impl Course<'_> {
    /// The last place known.
    fn last(&self, x: f64) -> (f64, Vertex) {
        let before = self.places.partition_point(|(from, _)| *from <= x).max(1);
        self.places[before - 1]
    }

    /// The place at a distance, on the path at rest. Without one, or without a tool axis, none.
    fn at(&self, x: f64) -> Option<Vertex> {
        let prepared = self.way.prepared;
        let (from, last) = self.last(x);
        let straight = Vertex::at(prepared, last.tip + last.tangent * (x - from), &last.tangent).ok()?;
        let shifts = [(&straight.part, &last.part), (&straight.drive, &last.drive)]
            .map(|(there, here)| (there.clearance - here.clearance).abs());
        let rounding = self.rounding(x) * prepared.size;
        if !self.way.may_bend() || shifts.into_iter().all(|shift| shift <= rounding) {
            return Some(straight);
        }
        // Over the end of a sheet corrections may lead far along it, to where the way is parallel as well.
        let most = FARTHEST_ASIDE * (x - from) + LEAST * prepared.size;
        let settled = Vertex::settled(prepared, &straight.tip, &last.tangent)?;
        ((settled.tip - straight.tip).norm() <= most).then_some(settled)
    }

    /// The place at a distance, if the way leads there.
    fn next(&self, x: f64) -> Option<Vertex> {
        let ParallelWay { prepared, sides, slope, .. } = self.way;
        let place = self.at(x)?;
        let (contact, side) = sides.nearer(prepared, &place.tip).ok()?;
        let is_ahead = self.way.may_bend() || self.turned(x, &place) <= self.rounding(x);
        let rate = contact.gradient.dot(&place.tangent) * side * self.sense;
        (is_ahead && (rate - slope).abs() <= self.rounding(x)).then_some(place)
    }

    /// By how much, as a sine of small angles, the path has turned at a place at a distance since the last place before that.
    fn turned(&self, x: f64, place: &Vertex) -> f64 {
        (place.tangent - self.last(x).1.tangent).norm()
    }

    /// What rounding leaves of a sine at a distance: far away the coordinates themselves are rounded.
    fn rounding(&self, x: f64) -> f64 {
        STEADY * (1.0 + x / self.way.prepared.size)
    }

    /// How far it leads; `None` where it has no end.
    fn end(&mut self) -> Result<Option<f64>, MotionFailure> {
        let size = self.way.prepared.size;
        let (mut on, mut step) = (0.0, LEAST * size);
        while on < ENDLESS * size && self.places.len() < MOST_PLACES {
            self.ask()?;
            let Some(next) = self.next(on + step) else {
                let last = self.last_on([on, on + step])?;
                return Ok((!self.leads_over_an_end(last)).then_some(last));
            };
            let turned = self.turned(on + step, &next);
            if step > LEAST * size && next.tangent.dot(&self.last(on).1.tangent) < AHEAD {
                step *= 0.5;
                continue;
            }
            on += step;
            self.places.push((on, next));
            let is_straight = turned <= self.rounding(on);
            step =
                if on > SURFACES * size && is_straight { 2.0 * step } else { (2.0 * step).min(STEP * size) };
        }
        Ok(None)
    }

    /// Whether the tool comes off one of the surfaces where the way ends, because that ends.
    fn leads_over_an_end(&self, last: f64) -> bool {
        let ParallelWay { prepared, check, sides, .. } = self.way;
        let beside = just_ahead(prepared) + LEAST * prepared.size;
        let comes_off = || {
            let [here, before] = [self.at(last)?, self.at((last - beside).max(0.0))?];
            let ahead = here.tip + here.tangent * beside;
            let mut check = Working::clone(check);
            check.set_side(sides.nearer(prepared, &before.tip).ok()?.1);
            let tool_at = |tip: &Vec3| prepared.attitude.tool_at(tip).ok();
            let (on, off) = (tool_at(&before.tip)?, tool_at(&ahead)?);
            let is_left =
                |role: &Working| !is_beyond_end(role, &on, &before.tip) && is_beyond_end(role, &off, &ahead);
            Some([&prepared.part, &prepared.drive, &check].into_iter().any(is_left))
        };
        comes_off().unwrap_or(false)
    }

    /// Where it ends between a place on it and one that is not.
    fn last_on(&self, [mut on, mut beyond]: [f64; 2]) -> Result<f64, MotionFailure> {
        for _ in 0..MAX_HALVINGS {
            self.ask()?;
            let middle = 0.5 * (on + beyond);
            if middle <= on || middle >= beyond {
                break;
            }
            if self.next(middle).is_some() {
                on = middle;
            } else {
                beyond = middle;
            }
        }
        Ok(on)
    }

    /// Whether to go on.
    fn ask(&self) -> Result<(), MotionFailure> {
        if self.way.patience.is_over() { Err(MotionFailure::Cancelled) } else { Ok(()) }
    }
}
