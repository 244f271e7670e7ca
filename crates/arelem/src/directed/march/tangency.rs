//! TANTO and PSTAN as events: where the path runs parallel to the check surface, and in contact with it (CPLAN avoided).

use apt_geometry::{Vec3, motion::CheckSurface};

use super::Vertex;
use crate::{
    clearance::Contact,
    directed::{Prepared, is_tangent, stop::Event},
    error::{Iteration, MotionFailure},
    position::{self, Condition},
    role::{GUARD, Working},
};

/// Bound of the bisection along one cut vector.
const MAX_ITERATIONS: u32 = 80;

/// Whether tool and check surface touch where the path is parallel to it.
enum Gap {
    /// They do, at this position and on this side of the check surface.
    Closed(Box<Vertex>, f64),
    /// They are this far apart.
    Open(f64),
}

/// Watches the check surfaces that stop at a tangency.
#[derive(Clone)]
pub(super) struct Watch<'a> {
    prepared: &'a Prepared,
    checks: &'a [CheckSurface],
    counts: Vec<u32>,
    /// Tangencies met so far.
    pub(super) met: usize,
    /// Gap at the nearest parallel position that was not a tangency, and of which check surface.
    pub(super) nearest: f64,
    pub(super) check: usize,
}

impl<'a> Watch<'a> {
    pub(super) fn new(prepared: &'a Prepared, checks: &'a [CheckSurface]) -> Self {
        Self { prepared, checks, counts: vec![0; checks.len()], met: 0, nearest: f64::INFINITY, check: 0 }
    }

    /// The first tangency on a cut vector.
    pub(super) fn scan(&mut self, from: &Vertex, to: &Vertex) -> Result<Option<Event>, MotionFailure> {
        let mut first: Option<Event> = None;
        for index in 0..self.checks.len() {
            if !is_tangent(self.checks[index].relation) {
                continue;
            }
            let (before, after) = (self.slope(index, from)?, self.slope(index, to)?);
            if before == 0.0 || (before > 0.0) == (after > 0.0) {
                continue;
            }
            let parallel = self.parallel(index, from, to, before > 0.0, 0.0)?;
            let (vertex, side) = match self.touching(index, from, to, before > 0.0, parallel)? {
                Gap::Closed(vertex, side) => (vertex, side),
                Gap::Open(gap) => {
                    if gap.abs() < self.nearest.abs() {
                        (self.nearest, self.check) = (gap, index);
                    }
                    continue;
                }
            };
            self.counts[index] += 1;
            self.met += 1;
            if self.counts[index] < self.checks[index].occurrence.max(1) {
                continue;
            }
            let x = (vertex.tip - from.tip).norm();
            if first.is_none_or(|best| x < best.x) {
                first = Some(Event { check: index, tip: vertex.tip, x, side, grazed: false });
            }
        }
        if let Some(event) = first {
            // The vector may be tried again shorter: the count starts afresh then.
            self.counts[event.check] -= 1;
            self.met -= 1;
        }
        Ok(first)
    }

    /// How fast the tool moves away from the check surface.
    fn slope(&self, index: usize, vertex: &Vertex) -> Result<f64, MotionFailure> {
        let (contact, side) = nearer(self.prepared, &self.prepared.checks[index], &vertex.tip)?;
        Ok((contact.gradient * side).dot(&vertex.tangent))
    }

    /// Where the path runs parallel, the check surface is in its band too, if need be elsewhere in the drive surface's
    /// band: the surfaces may miss each other by as much as both bands allow.
    fn touching(
        &self,
        index: usize,
        from: &Vertex,
        to: &Vertex,
        positive: bool,
        parallel: Vertex,
    ) -> Result<Gap, MotionFailure> {
        let Prepared { drive, size, .. } = self.prepared;
        let check = &self.prepared.checks[index];
        let (contact, side) = nearer(self.prepared, check, &parallel.tip)?;
        let (low, high) = (-check.inside, check.outside);
        if check.holds(contact.clearance, *size) {
            return Ok(Gap::Closed(Box::new(parallel), side));
        }
        let guard = GUARD * check.band();
        let missing = contact.clearance.clamp(low + guard, high - guard) - contact.clearance;
        let along_drive = (contact.gradient.dot(&parallel.drive.gradient)).signum();
        let shift = missing * along_drive;
        if !drive.holds(drive.rest() + shift, *size) {
            return Ok(Gap::Open(contact.clearance));
        }
        let shifted = self.parallel(index, from, to, positive, shift)?;
        let (contact, side) = nearer(self.prepared, check, &shifted.tip)?;
        let holds = check.holds(contact.clearance, *size);
        Ok(if holds { Gap::Closed(Box::new(shifted), side) } else { Gap::Open(contact.clearance) })
    }

    /// The position on both surfaces where the path is parallel to the check surface; `shift` is added to the drive
    /// surface's clearance at rest.
    fn parallel(
        &self,
        index: usize,
        from: &Vertex,
        to: &Vertex,
        positive: bool,
        shift: f64,
    ) -> Result<Vertex, MotionFailure> {
        let Prepared { attitude, part, drive, .. } = self.prepared;
        let conditions = [
            Condition::Clearance(&part.gauge, part.rest()),
            Condition::Clearance(&drive.gauge, drive.rest() + shift),
        ];
        let at = |share: f64| -> Result<Vertex, MotionFailure> {
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
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..MAX_ITERATIONS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if (self.slope(index, &at(middle)?)? > 0.0) == positive {
                low = middle;
            } else {
                high = middle;
            }
        }
        at(0.5 * (low + high))
    }
}

/// Contact with the check surface on the side where the tool touches it more nearly.
fn nearer(prepared: &Prepared, check: &Working, tip: &Vec3) -> Result<(Contact, f64), MotionFailure> {
    let posture = prepared.attitude.posture(tip)?;
    let mut gauge = check.gauge.clone();
    gauge.side = 1.0;
    let above = posture.contact(&gauge, tip);
    gauge.side = -1.0;
    let below = posture.contact(&gauge, tip);
    Ok(if above.clearance.abs() <= below.clearance.abs() { (above, 1.0) } else { (below, -1.0) })
}
