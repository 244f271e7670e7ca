//! Out of an interference: tilt, then lift, each found with the checker itself (AVOID, sculptured surfaces reference 3.41).

use apt_geometry::{
    Vec3,
    regional::{LiftDirection, PartRelation, TiltControl},
};
use serde::{Deserialize, Serialize};

use super::{
    Encounter, Job, Remedy, Sink,
    station::{Course, Station},
    way::{OnTheWay, Stand},
};
use crate::{
    check::Hit,
    error::MillingError,
    tool::{Pose, Tool, perpendicular},
};

/// Steps over the admissible range of the tilt.
const TILT_STEPS: u32 = 24;
/// Halvings of the last step.
const TILT_HALVINGS: u32 = 12;
/// Most rounds of the lift: each frees the point that was deepest.
const MOST_LIFTS: usize = 40;
/// Halvings of the way on which one point comes free.
const FREEING_HALVINGS: u32 = 60;
/// The depth to which a point is freed, as a share of what is allowed: so that the next check finds it free.
const FREED: f64 = 0.9;

/// Why no remedy was found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum NotAvoided {
    /// The tool would have to be lifted farther than LIMIT, or no lift frees it.
    Limit {
        /// The limit, program units.
        limit: f64,
        /// How far it had been lifted in trying, program units.
        needed: f64,
    },
    /// The remedies left the tool this deep in the surface.
    StillInside {
        /// Depth, program units.
        depth: f64,
    },
}

/// Where a station is put out, and what was met there.
#[derive(Clone, Copy)]
pub(super) struct Freed {
    pub(super) stand: Stand,
    encounter: Option<(Hit, Remedy)>,
}

impl Freed {
    /// Whether the tool met anything there, so that it may stand elsewhere.
    pub(super) fn met_anything(&self) -> bool {
        self.encounter.is_some()
    }
}

/// What a tilt gives.
struct Tilted {
    angle: f64,
    pitch: bool,
    pose: Pose,
    hit: Option<Hit>,
}

impl Job<'_> {
    /// Checks a station and puts it out, avoided if it has to be.
    pub(super) fn put(
        &self,
        station: &Station,
        course: &Course,
        sink: &mut Sink<'_>,
    ) -> Result<(), MillingError> {
        self.cancelled()?;
        let found = self.freed(station, course, sink);
        let way = self.on_the_way(&found.stand, sink);
        self.put_freed(station, found, way, sink)
    }

    /// Where a station is put out, avoided if it has to be.
    pub(super) fn freed(&self, station: &Station, course: &Course, sink: &mut Sink<'_>) -> Freed {
        let tool = self.tool.with_stock(self.thickness());
        let Some(hit) = self.worst(&station.pose, sink) else {
            return Freed { stand: Stand { pose: station.pose, clear: true }, encounter: None };
        };
        let remedy = self.remedy(&tool, station, course, &hit, sink);
        let stand = match remedy {
            Remedy::Avoided { pose, .. } => Stand { pose, clear: true },
            Remedy::None | Remedy::Failed(_) => Stand { pose: station.pose, clear: false },
        };
        Freed { stand, encounter: Some((hit, remedy)) }
    }

    /// Puts a station out, and tells what was met there and on the way to it.
    pub(super) fn put_freed(
        &self,
        station: &Station,
        found: Freed,
        way: Option<OnTheWay>,
        sink: &mut Sink<'_>,
    ) -> Result<(), MillingError> {
        self.was_cancelled()?;
        if let Some(way) = way {
            self.tell(&way.pose, way.hit, Remedy::None, sink);
        }
        if let Some((hit, remedy)) = found.encounter {
            self.tell(&station.pose, hit, remedy, sink);
        }
        sink.location(self, found.stand)
    }

    /// Checks a location away from the part and puts it out as it is.
    pub(super) fn put_free(&self, pose: Pose, sink: &mut Sink<'_>) -> Result<(), MillingError> {
        self.cancelled()?;
        let hit = self.worst(&pose, sink);
        let stand = Stand { pose, clear: hit.is_none() };
        let way = self.on_the_way(&stand, sink);
        self.was_cancelled()?;
        if let Some(way) = way {
            self.tell(&way.pose, way.hit, Remedy::None, sink);
        }
        if let Some(hit) = hit {
            self.tell(&pose, hit, Remedy::None, sink);
        }
        sink.location(self, stand)
    }

    fn tell(&self, pose: &Pose, hit: Hit, remedy: Remedy, sink: &mut Sink<'_>) {
        let surface = self.names.get(hit.obstacle).cloned().unwrap_or_default();
        sink.milled.encounters.push(Encounter { pose: *pose, hit, surface, remedy });
    }

    fn worst(&self, pose: &Pose, sink: &mut Sink<'_>) -> Option<Hit> {
        self.deepest(pose, &self.question(), sink)
    }

    fn remedy(
        &self,
        tool: &Tool,
        station: &Station,
        course: &Course,
        hit: &Hit,
        sink: &mut Sink<'_>,
    ) -> Remedy {
        let control = self.command.avoidance;
        if !control.enabled {
            return Remedy::None;
        }
        let (mut pose, mut worst) = (station.pose, *hit);
        let (mut tilt, mut pitch) = (0.0, false);
        if let Some(range) = &control.tilt
            && let Some(tilted) = self.tilt(tool, station, course, hit, range, sink)
        {
            match tilted.hit {
                None => {
                    let Tilted { angle, pitch, pose, .. } = tilted;
                    return Remedy::Avoided { tilt: angle, pitch, lift: 0.0, along: control.lift, pose };
                }
                Some(left) if left.depth < worst.depth => {
                    (pose, worst, tilt, pitch) = (tilted.pose, left, tilted.angle, tilted.pitch);
                }
                Some(_) => {}
            }
        }
        let limit = control.limit.unwrap_or(self.setting.maximum_step);
        let direction = match control.lift {
            LiftDirection::PartNormal => station.contact.normal,
            LiftDirection::Axis => pose.axis,
        };
        match self.lift(tool, &pose, &worst, &direction, limit, sink) {
            Ok((lift, pose)) => Remedy::Avoided { tilt, pitch, lift, along: control.lift, pose },
            Err(reason) => Remedy::Failed(reason),
        }
    }

    /// The least lift that frees the tool. Any lift that frees it must bring each point out, the deepest one too: so the
    /// way of that point alone never goes too far, and what is then deepest is next.
    fn lift(
        &self,
        tool: &Tool,
        pose: &Pose,
        worst: &Hit,
        direction: &Vec3,
        limit: f64,
        sink: &mut Sink<'_>,
    ) -> Result<(f64, Pose), NotAvoided> {
        let lifted = |way: f64| Pose { end: pose.end + direction * way, axis: pose.axis };
        let (mut way, mut point) = (0.0, worst.point);
        for _ in 0..MOST_LIFTS {
            way += self.way_out(tool, &lifted(way), &point, direction);
            if way > limit {
                return Err(NotAvoided::Limit { limit, needed: way });
            }
            match self.worst(&lifted(way), sink) {
                None => return Ok((way, lifted(way))),
                Some(next) => point = next.point,
            }
        }
        let depth = self.worst(&lifted(way), sink).map_or(0.0, |hit| hit.depth);
        Err(NotAvoided::StillInside { depth })
    }

    /// How far the tool moves along `direction` until a point is free. The depth is concave along the way, so the point
    /// comes free once.
    fn way_out(&self, tool: &Tool, pose: &Pose, point: &Vec3, direction: &Vec3) -> f64 {
        let free = FREED * self.setting.inside;
        let depth = |way: f64| {
            tool.depth(&Pose { end: pose.end + direction * way, axis: pose.axis }, point).value - free
        };
        // Past this the tool has left any point behind.
        let (mut low, mut high) = (0.0, 2.0 * tool.reach());
        for _ in 0..FREEING_HALVINGS {
            let middle = 0.5 * (low + high);
            if depth(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// Turns the axis about the contact, in the plane of axis and feed or across it, whichever the deepest point lies
    /// nearer to, until the tool is clear; and by the constant angle farther.
    fn tilt(
        &self,
        tool: &Tool,
        station: &Station,
        course: &Course,
        hit: &Hit,
        range: &TiltControl,
        sink: &mut Sink<'_>,
    ) -> Option<Tilted> {
        let axis = station.pose.axis;
        let forward = station.guide.forward * course.sign;
        let across = axis.cross(&forward).try_normalize(0.0).unwrap_or_else(|| perpendicular(&axis));
        let ahead = across.cross(&axis);
        let pivot = station.center;
        let surface = hit.point - pivot;
        let pitch = surface.dot(&ahead).abs() >= surface.dot(&across).abs();
        let lean = if pitch { ahead } else { across };
        let inward = tool.depth(&station.pose, &hit.point);
        let touching = surface - inward.ascent * hit.depth;
        let angle = |from: &Vec3| from.dot(&lean).atan2(from.dot(&axis));
        let guess = wrapped(angle(&surface) - angle(&touching));
        let mut best: Option<Tilted> = None;
        for sense in [if guess < 0.0 { -1.0 } else { 1.0 }, if guess < 0.0 { 1.0 } else { -1.0 }] {
            let (least, greatest) = admissible(range, sense);
            if greatest <= 0.0 {
                continue;
            }
            let start = if sense * guess > 0.0 { (sense * guess).clamp(least, greatest) } else { least };
            let mut attempt = |angle: f64| -> Option<Tilted> {
                let leaning = axis * angle.cos() + lean * (sense * angle.sin());
                let pose = self.seated(station, &leaning)?;
                let hit = self.worst(&pose, sink);
                Some(Tilted { angle: sense * angle, pitch, pose, hit })
            };
            if let Some(tilted) = least_tilt(start, least, greatest, range.constant, &mut attempt) {
                let depth = |tilted: &Tilted| tilted.hit.map_or(0.0, |hit| hit.depth);
                if best.as_ref().is_none_or(|best| depth(&tilted) < depth(best)) {
                    best = Some(tilted);
                }
            }
            if best.as_ref().is_some_and(|best| best.hit.is_none()) {
                break;
            }
        }
        best
    }

    /// The tool in contact at a station with another axis; `None` where it has no place for the contact.
    fn seated(&self, station: &Station, axis: &Vec3) -> Option<Pose> {
        let axis = axis.try_normalize(0.0)?;
        let contact = &station.contact;
        let end = match self.command.part.relation {
            PartRelation::To => self
                .tool
                .end_at_contact(
                    &contact.at.position,
                    &contact.normal,
                    &axis,
                    station.offset,
                    &station.sideways,
                )
                .ok()?,
            PartRelation::On => station.pose.end,
        };
        Some(Pose { end, axis })
    }
}

/// An angle between −π and π.
fn wrapped(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    angle - turn * (angle / turn).round()
}

/// The tilts that AVCTRL admits to one side, as sizes (sculptured surfaces reference 1.8).
fn admissible(range: &TiltControl, sense: f64) -> (f64, f64) {
    if range.least >= 0.0 {
        (range.least, range.greatest)
    } else if sense > 0.0 {
        (0.0, range.greatest)
    } else {
        (0.0, -range.least)
    }
}

/// The least tilt found that clears, with the constant added where that stays clear; else the one that leaves least.
fn least_tilt(
    start: f64,
    least: f64,
    greatest: f64,
    constant: f64,
    attempt: &mut dyn FnMut(f64) -> Option<Tilted>,
) -> Option<Tilted> {
    let step = (greatest - least).max(0.0) / f64::from(TILT_STEPS);
    let mut best: Option<Tilted> = None;
    let mut unclear = least;
    let mut clear = None;
    // From the guess upwards; where the guess is clear already, the way down to the least is halved below.
    for index in 0..=TILT_STEPS {
        let angle = start + step * f64::from(index);
        if angle > greatest + step * f64::EPSILON {
            break;
        }
        let Some(tilted) = attempt(angle.min(greatest)) else { continue };
        match tilted.hit {
            None => {
                clear = Some((angle, tilted));
                break;
            }
            Some(hit) => {
                unclear = angle;
                let left = |best: &Tilted| best.hit.map_or(0.0, |hit| hit.depth);
                if best.as_ref().is_none_or(|best| hit.depth < left(best)) {
                    best = Some(tilted);
                }
            }
        }
    }
    let Some((mut angle, mut tilted)) = clear else { return best };
    for _ in 0..TILT_HALVINGS {
        let middle = 0.5 * (unclear + angle);
        match attempt(middle) {
            Some(found) if found.hit.is_none() => (angle, tilted) = (middle, found),
            _ => unclear = middle,
        }
    }
    if constant > 0.0 {
        let farther = (angle + constant).min(greatest);
        if let Some(found) = attempt(farther).filter(|found| found.hit.is_none()) {
            tilted = found;
        }
    }
    Some(tilted)
}
