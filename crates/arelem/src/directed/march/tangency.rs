//! TANTO and PSTAN as events: where the path runs parallel to the check surface, and in contact with it (CPLAN avoided).

mod begin;
mod sides;
#[cfg(test)]
mod tests;

use std::rc::Rc;

use apt_geometry::{
    Vec3,
    motion::{CheckSurface, Relation},
    patience::Patience,
};

pub(super) use self::sides::Sides;
use super::{
    Vertex,
    parallel_way::{ParallelWay, is_nearly_parallel},
    surface_end::is_at_end,
};
use crate::{
    clearance::{Contact, Gauge},
    directed::{
        Prepared, is_tangent,
        stop::{Event, graze},
    },
    error::{Iteration, MotionFailure},
    position::{self, Condition},
    role::{GUARD, Working},
};

/// Bound of the bisection along one cut vector.
const MAX_ITERATIONS: u32 = 80;

/// Parts of a long cut vector near a check surface in which the slope is looked at.
const PIECES: f64 = 24.0;
/// Their least length, relative to the size of the coordinates.
const LEAST_PIECE: f64 = 2e-3;
/// How exactly, relative to the size of the coordinates, a place where both surfaces are parallel is found.
const POSITION: f64 = 1e-10;

/// Half the length, relative to the size of the coordinates, from which on they are so on a stretch and not at a place.
const STRETCH: f64 = 1e-7;

/// Sine of the angle between path and check surface below which they are parallel.
const PARALLEL: f64 = 1e-9;
/// Sine of the angle between two normals that is rounding.
const AGREEING: f64 = 1e-7;
/// Step of the estimate of how fast normals turn, relative to the size of the coordinates.
const TURNING_STEP: f64 = 1e-4;

/// Whether tool and check surface touch where the path is parallel to it.
enum Gap {
    /// They do, at this position and on this side of the check surface.
    Closed(Box<Vertex>, f64),
    /// They are this far apart.
    Open(f64),
}

/// Part of a cut vector on which the path is parallel to a check surface.
struct Stretch<'a> {
    index: usize,
    from: &'a Vertex,
    to: &'a Vertex,
    slope: Slope,
}

/// What the slope of a check surface's clearance does where the path is parallel to the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Slope {
    /// It changes its sign, from this one.
    Changes { is_positive: bool },
    /// It comes to nothing and goes on with the same sign: the path goes through the surface there.
    Touches,
    /// It stays what it is, as far as it is looked at.
    Stays,
}

/// A check surface seen from a place on a cut vector.
#[derive(Clone)]
struct Reading {
    /// Distance from the start of the vector.
    x: f64,
    vertex: Vertex,
    /// Rate at which the distance along the natural normal grows on the path.
    slope: f64,
    gap: f64,
    side: f64,
}

impl Reading {
    /// Whether the distance grows or falls; `None` where that is rounding.
    fn grows(&self) -> Option<bool> {
        (self.slope.abs() > PARALLEL).then_some(self.slope > 0.0)
    }

    /// Whether the tool comes to touch the check surface elsewhere before another place: the gap then does not change as the
    /// slopes say, and a slope that changed its sign in between may have changed it back.
    fn jumps_before(&self, next: &Self, slack: f64) -> bool {
        let step = next.x - self.x;
        if self.gap.abs() + next.gap.abs() > step + 2.0 * slack {
            return false;
        }
        let change = next.gap - self.gap;
        self.side != next.side || (change - 0.5 * self.side * (self.slope + next.slope) * step).abs() > slack
    }
}

/// What the slope of a check surface's clearance does on the way to where the path is parallel to the surface.
#[derive(Clone, Default)]
struct Approach {
    /// Whether the path was looked at already.
    begun: bool,
    /// Whether the clearance grew where it last changed.
    grew: Option<bool>,
    /// Where the slope fell to what it is, or to nothing: the place before.
    steeper: Option<Reading>,
    /// The way parallel to the surface that the path is on.
    on_way: Option<OnWay>,
}

/// A way on which the path is parallel to a check surface.
#[derive(Clone)]
struct OnWay {
    slope: f64,
    /// Where it is a tangency, on this side of the check surface, as long as that lies ahead.
    stop: Option<(Vertex, f64)>,
}

impl OnWay {
    /// The tangency on it, if that lies before a distance on a cut vector.
    fn stop_before(&mut self, [from, to]: [&Vertex; 2], x: f64, reach: f64) -> Option<(Vertex, f64)> {
        let along = (to.tip - from.tip).try_normalize(0.0)?;
        self.stop.take_if(|(vertex, _)| {
            let way = vertex.tip - from.tip;
            let aside = (way - along * way.dot(&along)).norm();
            way.dot(&along) <= x && aside <= x.max(reach)
        })
    }

    /// Whether a place is on it. As long as its tangency lies ahead, one that may be counts: cut vectors are beside the path at rest, and where the tool
    /// touches with a whole flank, by a hair's breadth, rounding of the places at which it does leaves more of a sine than along the way.
    fn has(&self, place: &Reading) -> bool {
        let may_be = self.stop.is_some() && is_nearly_parallel(place.slope);
        may_be || (place.slope - self.slope).abs() <= PARALLEL
    }
}

impl Approach {
    /// The same on the next cut vector.
    fn onto(&self, first: &Reading) -> Self {
        Self {
            grew: first.grows().or(self.grew),
            steeper: self.steeper.as_ref().map(|_| first.clone()),
            ..self.clone()
        }
    }

    /// Whether the path is parallel to the surface before the next place, or may be: since where, and how.
    fn parallel<'a>(&'a self, here: &'a Reading, next: &Reading) -> Option<(&'a Reading, Slope)> {
        let (grew, grows) = (self.grew?, next.grows()?);
        if grew != grows {
            let start = if here.grows().is_some() { here } else { self.steeper.as_ref().unwrap_or(here) };
            return Some((start, Slope::Changes { is_positive: grew }));
        }
        let start = self.steeper.as_ref()?;
        (next.slope.abs() >= here.slope.abs()).then_some((start, Slope::Touches))
    }

    /// Goes on to the next place.
    fn go_on(&mut self, here: Reading, next: &Reading) {
        let falls =
            next.slope.abs() < here.slope.abs() && self.grew.is_some_and(|grew| next.grows() != Some(!grew));
        let is_parallel = here.grows().is_none() && next.grows().is_none();
        if !is_parallel {
            self.steeper = falls.then_some(here);
        }
        self.grew = next.grows().or(self.grew);
    }
}

/// Watches the check surfaces that stop at a tangency.
#[derive(Clone)]
pub(super) struct Watch<'a> {
    prepared: &'a Prepared<'a>,
    checks: &'a [CheckSurface],
    patience: Patience<'a>,
    counts: Rc<[u32]>,
    approaches: Rc<[Approach]>,
    sides: Rc<[Sides]>,
    /// Tangencies met so far.
    pub(super) met: usize,
    /// Gap at the nearest parallel position that was not a tangency, and of which check surface.
    pub(super) nearest: f64,
    pub(super) check: usize,
    /// The check surface along which the path leads from its beginning, touching it, for ever.
    along: Option<usize>,
}

impl<'a> Watch<'a> {
    pub(super) fn new(
        prepared: &'a Prepared<'a>,
        checks: &'a [CheckSurface],
        patience: Patience<'a>,
    ) -> Self {
        let counts = checks.iter().map(|_| 0).collect();
        let approaches = checks.iter().map(|_| Approach::default()).collect();
        let sides = prepared.checks.iter().map(Sides::of).collect();
        let (nearest, check, along) = (f64::INFINITY, 0, None);
        Self { prepared, checks, patience, counts, approaches, sides, met: 0, nearest, check, along }
    }

    /// Why there is no tangency.
    pub(super) fn failure(&self) -> MotionFailure {
        match self.along {
            Some(check) => MotionFailure::ParallelThroughout { check },
            None => MotionFailure::NotTangent { check: self.check, gap: self.nearest },
        }
    }

    /// Whether a check surface stops at a tangency.
    pub(super) fn has_any(&self) -> bool {
        self.checks.iter().any(|check| is_tangent(check.relation))
    }

    /// The first tangency on a cut vector. With one, or without, the vector counts as travelled.
    pub(super) fn scan(&mut self, from: &Vertex, to: &Vertex) -> Result<Option<Event>, MotionFailure> {
        let mut first: Option<Event> = None;
        for index in 0..self.checks.len() {
            if !is_tangent(self.checks[index].relation) {
                continue;
            }
            if let Some((vertex, side)) = self.follow(index, from, to)? {
                let x = (vertex.tip - from.tip).norm();
                if first.is_none_or(|best| x < best.x) {
                    first = Some(Event {
                        check: index,
                        tip: vertex.tip,
                        x,
                        side,
                        grazed: false,
                        is_shallow: false,
                    });
                }
            }
        }
        Ok(first)
    }

    /// The tangency wanted with one check surface, if it is on a cut vector. Where tool and surface are far from each other
    /// there is none, and near to each other the slope is looked at often enough not to miss where it changes its sign twice.
    fn follow(
        &mut self,
        index: usize,
        from: &Vertex,
        to: &Vertex,
    ) -> Result<Option<(Vertex, f64)>, MotionFailure> {
        let length = (to.tip - from.tip).norm();
        let least = (length / PIECES).max(LEAST_PIECE * self.prepared.size);
        let reach =
            self.prepared.checks[index].band() + self.prepared.part.band() + self.prepared.drive.band();
        let vector = [from, to];
        let mut here = self.read(index, vector, 0.0)?;
        let mut approach = self.approaches[index].onto(&here);
        if !approach.begun {
            (approach.begun, approach.on_way) = (true, self.way(index, &here, true)?);
        }
        while here.x < length {
            if self.patience.is_over() {
                return Err(MotionFailure::Cancelled);
            }
            let mut step = (here.gap.abs() - reach).max(least);
            let mut next = self.read(index, vector, (here.x + step).min(length))?;
            while step > reach && here.jumps_before(&next, reach) {
                step *= 0.5;
                next = self.read(index, vector, (here.x + step).min(length))?;
            }
            if approach.on_way.is_none() {
                approach.on_way = self.way(index, &next, false)?;
            }
            if approach.on_way.is_none() && here.grows().is_some() && next.grows().is_none() {
                approach.on_way = self.way_begun_before(index, vector, here.x, &next)?;
            }
            let tangency = match &mut approach.on_way {
                Some(way) => way.stop_before(vector, next.x, reach),
                None => self.touch_before(index, &approach, [&here, &next], reach + step)?,
            };
            if let Some(tangency) = tangency {
                Rc::make_mut(&mut self.counts)[index] += 1;
                self.met += 1;
                if self.counts[index] >= self.checks[index].occurrence.max(1) {
                    return Ok(Some(tangency));
                }
            }
            let last = std::mem::replace(&mut here, next);
            match &approach.on_way {
                Some(way) if way.has(&here) => {}
                Some(_) => approach = Approach { begun: true, grew: here.grows(), ..Approach::default() },
                None => approach.go_on(last, &here),
            }
        }
        Rc::make_mut(&mut self.approaches)[index] = approach;
        Ok(None)
    }

    /// The way parallel to a check surface that leads on from a place, if there is one, with its tangency.
    fn way(&mut self, index: usize, place: &Reading, is_first: bool) -> Result<Option<OnWay>, MotionFailure> {
        let sides = self.sides.clone();
        let start = (&place.vertex, place.slope);
        let check = (&self.prepared.checks[index], &sides[index]);
        let Some(way) = ParallelWay::from(self.prepared, check, start, self.patience)? else {
            return Ok(None);
        };
        let Some(found) = way.stop(is_first)? else { return Ok(None) };
        let stretch = Stretch { index, from: &found.vertex, to: &found.vertex, slope: Slope::Stays };
        let stop = match self.touching(&stretch)? {
            Gap::Closed(..) if found.is_endless => {
                self.along = Some(index);
                None
            }
            Gap::Closed(vertex, side) => Some((*vertex, side)),
            Gap::Open(gap) => {
                self.note_gap(index, gap);
                None
            }
        };
        Ok(Some(OnWay { slope: way.slope(), stop }))
    }

    /// The tangency before the next place on a cut vector.
    fn touch_before(
        &mut self,
        index: usize,
        approach: &Approach,
        [here, next]: [&Reading; 2],
        near: f64,
    ) -> Result<Option<(Vertex, f64)>, MotionFailure> {
        let Some((start, slope)) = approach.parallel(here, next) else { return Ok(None) };
        let touches = slope == Slope::Touches;
        if touches && here.gap.abs() > near {
            return Ok(None);
        }
        let stretch = Stretch { index, from: &start.vertex, to: &next.vertex, slope };
        match self.touching(&stretch)? {
            Gap::Closed(vertex, side) => return Ok(Some((*vertex, side))),
            Gap::Open(gap) if !touches => self.note_gap(index, gap),
            Gap::Open(_) => {}
        }
        Ok(None)
    }

    /// Notes how far a place parallel to a check surface is from being tangent to it.
    pub(super) fn note_gap(&mut self, index: usize, gap: f64) {
        if gap.abs() < self.nearest.abs() {
            (self.nearest, self.check) = (gap, index);
        }
    }

    /// The check surface at a distance from the start of a cut vector.
    fn read(&self, index: usize, [from, to]: [&Vertex; 2], x: f64) -> Result<Reading, MotionFailure> {
        let length = (to.tip - from.tip).norm();
        let vertex = if x <= 0.0 {
            *from
        } else if x < length {
            Vertex::at(self.prepared, from.tip + (to.tip - from.tip) * (x / length), &from.tangent)?
        } else {
            *to
        };
        let (contact, side) = self.sides[index].nearer(self.prepared, &vertex.tip)?;
        let slope = (contact.gradient * side).dot(&vertex.tangent);
        Ok(Reading { x, vertex, slope, gap: contact.clearance, side })
    }

    /// Where the path runs parallel, the check surface is in its band too, if need be elsewhere in the band of the surface
    /// that it is tangent to: the two may miss each other by as much as both bands allow. Looked for on the path at rest,
    /// then where the tool touches part and drive surface exactly.
    fn touching(&self, stretch: &Stretch<'_>) -> Result<Gap, MotionFailure> {
        let Prepared { part, drive, .. } = self.prepared;
        let at_rest = self.touching_about(stretch, [0.0; 2])?;
        if matches!(at_rest, Gap::Closed(..)) {
            return Ok(at_rest);
        }
        Ok(match self.touching_about(stretch, [-part.rest(), -drive.rest()])? {
            Gap::Open(_) => at_rest,
            closed => closed,
        })
    }

    /// The same, with these shifts added to the clearances of part and drive surface at rest.
    fn touching_about(&self, stretch: &Stretch<'_>, base: [f64; 2]) -> Result<Gap, MotionFailure> {
        let Prepared { part, drive, size, .. } = self.prepared;
        let parallel = self.parallel(stretch, base)?;
        let check = &self.prepared.checks[stretch.index];
        let (contact, side) = self.measured(stretch.index, &parallel.tip)?;
        let (low, high) = (-check.inside, check.outside);
        // Nothing is tangent to the end of a surface.
        if is_at_end(check, &contact) {
            return Ok(Gap::Open(contact.clearance));
        }
        let to_part = check.relation == Relation::TangentToPart;
        let (partner, its_base, against) = if to_part {
            (part, base[0], parallel.part.gradient)
        } else {
            (drive, base[1], parallel.drive.gradient)
        };
        // What is rounding far away, where the path begins, may be none here, where the next one does.
        if check.holds(contact.clearance, position::size(&self.prepared.tool, &parallel.tip)) {
            let apart = self.apart(stretch.index, partner, &parallel)?;
            return Ok(match apart <= (1.0 - GUARD) * (check.band() + partner.band()) {
                true => Gap::Closed(Box::new(parallel), side),
                false => Gap::Open(apart),
            });
        }
        let sense = contact.gradient.dot(&against).signum();
        let gap = contact.clearance;
        // A little inside the check surface's band, or at its limit where the partner's band begins.
        for guard in [GUARD * check.band(), 0.0] {
            let shift = its_base + sense * (gap.clamp(low + guard, high - guard) - gap);
            if !partner.holds(partner.rest() + shift, *size) {
                continue;
            }
            let shifted =
                self.parallel(stretch, if to_part { [shift, base[1]] } else { [base[0], shift] })?;
            let (contact, side) = self.measured(stretch.index, &shifted.tip)?;
            let outside_by = check.beyond(contact.clearance);
            let apart = self.apart(stretch.index, partner, &shifted)?;
            if apart > (1.0 - GUARD) * (check.band() + partner.band()) {
                return Ok(Gap::Open(apart));
            }
            if outside_by <= POSITION * size {
                return Ok(Gap::Closed(Box::new(shifted), side));
            }
            return Ok(Gap::Open(contact.clearance));
        }
        Ok(Gap::Open(gap))
    }

    /// Contact with a check surface, and its side: of ON, which has none, that in whose band the tool is more nearly, as the next motion has it.
    fn measured(&self, index: usize, tip: &Vec3) -> Result<(Contact, f64), MotionFailure> {
        let (check, sides) = (&self.prepared.checks[index], &self.sides[index]);
        let (contact, side) = sides.nearer(self.prepared, tip)?;
        if !check.gauge.on {
            return Ok((contact, side));
        }
        let other = self.prepared.attitude.posture(tip)?.contact(sides.on(-side), tip);
        let beyond = |contact: &Contact| check.beyond(contact.clearance);
        Ok(if beyond(&other) < beyond(&contact) { (other, -side) } else { (contact, side) })
    }

    /// How far the check surface and the one that it is to be tangent to miss each other where their normals agree, as far as
    /// their bends at a position tell: none if the normals agree there. Where the path is parallel to the check surface they may
    /// differ across the path, and two surfaces that touch the tool there are not tangent by that.
    fn apart(&self, index: usize, partner: &Working, place: &Vertex) -> Result<f64, MotionFailure> {
        let tool = self.prepared.attitude.tool_at(&place.tip)?;
        let (_, side) = self.sides[index].nearer(self.prepared, &place.tip)?;
        let check = self.sides[index].on(side);
        // Normals count, whether or not the tool turns on its way.
        let [touched, normal] =
            [check, &partner.gauge].map(|gauge| gauge.contact(&tool, &place.tip).gradient);
        let sense = touched.dot(&normal).signum();
        let lean = touched * sense - normal * touched.dot(&normal).abs();
        let Some(across) = lean.try_normalize(AGREEING) else { return Ok(0.0) };
        let step = TURNING_STEP * self.prepared.size;
        let turning = |gauge: &Gauge| {
            let at = |way: f64| gauge.contact(&tool, &(place.tip + across * way)).gradient;
            (at(step) - at(-step)).norm() / (2.0 * step)
        };
        // The parabola whose slope is the sine of the angle there.
        Ok(lean.norm_squared() / (2.0 * (turning(check) + turning(&partner.gauge))))
    }

    /// The position on both surfaces where the path is parallel to the check surface; the shifts are added to the clearances
    /// of part and drive surface at rest.
    fn parallel(
        &self,
        &Stretch { index, from, to, slope }: &Stretch<'_>,
        shift: [f64; 2],
    ) -> Result<Vertex, MotionFailure> {
        let Prepared { attitude, part, drive, .. } = self.prepared;
        let conditions = [
            Condition::Clearance(&part.gauge, part.rest() + shift[0]),
            Condition::Clearance(&drive.gauge, drive.rest() + shift[1]),
        ];
        let at = |share: f64| -> Result<Vertex, MotionFailure> {
            if self.patience.is_over() {
                return Err(MotionFailure::Cancelled);
            }
            let on_chord: Vec3 = from.tip + (to.tip - from.tip) * share;
            let solved = position::solve(attitude, &conditions, &on_chord).map_err(|unsolved| {
                MotionFailure::IterationLimit {
                    iteration: Iteration::TwoSurfaces,
                    limit: unsolved.iterations,
                    tip: unsolved.tip,
                }
            })?;
            Vertex::at(self.prepared, solved.tip, &from.tangent)
        };
        if slope == Slope::Stays {
            return at(0.0);
        }
        let (sides, size) = (&self.sides[index], self.prepared.size);
        let nearest = |tip: &Vec3| sides.nearer(self.prepared, tip);
        let ends = [nearest(&from.tip)?.1, nearest(&to.tip)?.1];
        if ends[0] == ends[1] {
            let gauge = sides.on(ends[0]);
            let followed = |vertex: &Vertex| {
                let posture = attitude.posture(&vertex.tip)?;
                Ok(slope_of((posture.contact_followed(gauge, &vertex.tip).0, gauge.side), vertex))
            };
            let find = Parallel { at: &at, slope: &followed, length: (to.tip - from.tip).norm(), size };
            let place = find.place(slope)?;
            // Another contact may be nearer than the one that was followed.
            if (slope_of(nearest(&place.tip)?, &place) - followed(&place)?).abs() <= PARALLEL {
                return Ok(place);
            }
        }
        let proven = |vertex: &Vertex| Ok(slope_of(nearest(&vertex.tip)?, vertex));
        Parallel { at: &at, slope: &proven, length: (to.tip - from.tip).norm(), size }.place(slope)
    }
}

/// How fast the tool moves away from a check surface, by contact with it on a side.
fn slope_of((contact, side): (Contact, f64), vertex: &Vertex) -> f64 {
    (contact.gradient * side).dot(&vertex.tangent)
}

/// The search for where the path is parallel to a check surface.
struct Parallel<'a> {
    /// The position on the path at a share of the stretch.
    at: &'a dyn Fn(f64) -> Result<Vertex, MotionFailure>,
    slope: &'a dyn Fn(&Vertex) -> Result<f64, MotionFailure>,
    /// Of the stretch, and the size of the coordinates.
    length: f64,
    size: f64,
}

impl Parallel<'_> {
    fn place(&self, slope: Slope) -> Result<Vertex, MotionFailure> {
        let slope_at = |share: f64| (self.slope)(&(self.at)(share)?);
        let place = match slope {
            Slope::Changes { is_positive } => {
                bisected([0.0, 1.0], |x| Ok((slope_at(x)? > 0.0) == is_positive))?
            }
            Slope::Touches | Slope::Stays => {
                graze::least([0.0, 1.0], &|x| Some(slope_at(x).ok()?.abs())).map_or(0.5, |(place, _)| place)
            }
        };
        // A flat bottom may be tangent to a surface all along a stretch of the path: then in the middle of it.
        let is_parallel = |x: f64| Ok(slope_at(x)?.abs() <= PARALLEL);
        let beside = STRETCH * self.size / self.length;
        let ends = [(place - beside).max(0.0), (place + beside).min(1.0)];
        if !is_parallel(place)? || !is_parallel(ends[0])? && !is_parallel(ends[1])? {
            return (self.at)(place);
        }
        let begin = bisected([0.0, place], |x| Ok(!is_parallel(x)?))?;
        let end = bisected([place, 1.0], is_parallel)?;
        (self.at)(0.5 * (begin + end))
    }
}

/// Where a condition that holds at the begin of a stretch ceases to, once.
fn bisected(
    [mut low, mut high]: [f64; 2],
    holds: impl Fn(f64) -> Result<bool, MotionFailure>,
) -> Result<f64, MotionFailure> {
    for _ in 0..MAX_ITERATIONS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if holds(middle)? {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(0.5 * (low + high))
}
