//! Progress towards the check surfaces: whether one can be met at all on the way ahead. The path is followed far ahead in
//! long steps without regard to tolerances, until it meets a check surface, closes on itself, comes to the end of a surface,
//! or leaves everything behind. Clearances far away are not proven.
//!
//! A step and the path between its ends are apart by no more than the sag of the step; a check surface that stays farther
//! away than that is not met.

use apt_geometry::{Vec3, motion::CheckSurface, patience::Patience};

use super::{Vertex, surface_end::SurfaceEnd, tangency};
use crate::{
    directed::{Prepared, is_tangent, stop::Watcher},
    error::{Course, MotionFailure},
    position::{self, Condition, Effort},
};

/// Bound of the steps of one look ahead.
const MAX_STEPS: u32 = 3000;
/// First step, relative to the size of the coordinates.
const FIRST: f64 = 0.01;
/// Turn of the path, radians, that steps aim at, and the greatest allowed.
const TURN: [f64; 2] = [0.06, 0.12];
/// How far away at most a step may lead, in its own length.
const FARTHEST: f64 = 2.0;
/// How many times as far corrections may lead before the step is in vain.
const STRAYS: f64 = 2.0;
/// What the corrections of a step may take: a shorter one needs fewer.
const STEP: Effort = Effort { corrections: 20, halvings: 2, turns: 3, is_one_of_many: true };
/// Greatest growth from one step to the next.
const GROWTH: f64 = 3.0;
/// How many times its sag a step must stay away from the check surfaces.
const MARGIN: f64 = 4.0;
/// Steps are not shortened below this share of the size of the coordinates.
const LEAST: f64 = 1e-7;
/// How far the path is followed, relative to the size of the coordinates.
const REACH: f64 = 1e5;
/// The longest way that is followed because NUMPTS and MAXDP allow it, relative to the size of the coordinates.
const LONGEST: f64 = 1e8;
/// Turn, radians, over the last nine tenths of the way below which the path does not come back.
const STRAIGHT: f64 = 0.05;
/// Distance, relative to the size of the coordinates, within which the path has come back to a place.
const SAME: f64 = 1e-6;

/// Bound of the halvings that find where a surface ends.
const MAX_HALVINGS: u32 = 40;

/// Cosine between the path at a position and in the middle of the bands beside it below which that is on another leg of a corner (60°).
const SAME_LEG: f64 = 0.5;

/// What lies ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Outlook {
    /// The end of a surface, and no position before it that stops the motion.
    Ends(SurfaceEnd),
    /// No position that stops the motion: the nearest approach on the way, how the way ends, how many positions that
    /// count were met, too few, and how near a place parallel to a check surface is to being tangent to it.
    Nothing { course: Course, nearest: (f64, Vec3, usize), met: usize, parallel: (f64, usize) },
    /// A check surface is met, at the latest after this way (zero where nothing could be told).
    Open { way: f64 },
}

/// A step of the look ahead.
enum Leg {
    /// To a place, and the turn of the path on the way.
    Along(Vertex, f64),
    /// To where a surface has ended.
    Over((Vertex, SurfaceEnd)),
}

/// Nothing could be told.
const UNTOLD: Outlook = Outlook::Open { way: 0.0 };

/// What comes of a step of the look ahead.
enum Step {
    /// This is what lies ahead.
    Told(Outlook),
    /// The path leads on to a place, over this way and turning by so much.
    Leads(Vertex, [f64; 2]),
    /// A check surface is too near to tell whether the path meets it: shorter steps do.
    TooLong,
}

/// A path being looked along.
struct Scout<'a> {
    prepared: &'a Prepared<'a>,
    watcher: Watcher<'a>,
    tangency: tangency::Watch<'a>,
    /// Where the path is entered.
    start: Vertex,
    /// Positions that count and had been met there.
    met_before: usize,
    /// Whether a tangency stops the motion.
    may_be_tangent: bool,
    nearest: (f64, Vec3, usize),
    /// Distance travelled and angle turned at every step so far.
    log: Vec<[f64; 2]>,
}

/// Looks along the path ahead of a vertex. `least` is the way that must have been followed at least before a path that does
/// not close counts as lost.
pub(super) fn ahead(
    prepared: &Prepared,
    checks: &[CheckSurface],
    (watcher, tangency): (&Watcher<'_>, &tangency::Watch<'_>),
    from: &Vertex,
    least: f64,
    patience: Patience<'_>,
) -> Result<Outlook, MotionFailure> {
    // In a corner the middle of the bands may be on another leg, along which the way ahead is not that of the path.
    let settled = Vertex::settled(prepared, &from.tip, &from.tangent);
    let Some(start) = settled.filter(|start| start.tangent.dot(&from.tangent) >= SAME_LEG) else {
        return Ok(UNTOLD);
    };
    let mut scout = Scout {
        prepared,
        watcher: watcher.thorough(),
        tangency: tangency.clone(),
        start,
        met_before: 0,
        may_be_tangent: checks.iter().any(|check| is_tangent(check.relation)),
        nearest: (f64::INFINITY, from.tip, 0),
        log: vec![[0.0; 2]],
    };
    // From elsewhere in the bands to their middle the tool may already come to a position.
    let aside = from.sweep(prepared, &start);
    if aside.length > 0.0 && scout.watcher.scan(&aside).is_some() {
        return Ok(Outlook::Open { way: aside.length });
    }
    scout.met_before = scout.met();
    scout.look(least.clamp(REACH * prepared.size, LONGEST * prepared.size), patience)
}

impl Scout<'_> {
    /// Step by step, as far as it takes to tell what lies ahead.
    fn look(&mut self, least: f64, patience: Patience<'_>) -> Result<Outlook, MotionFailure> {
        let (mut here, mut step) = (self.start, FIRST * self.prepared.size);
        for _ in 0..MAX_STEPS {
            if patience.is_over() {
                return Err(MotionFailure::Cancelled);
            }
            match self.step(&here, &mut step)? {
                Step::Told(outlook) => return Ok(outlook),
                Step::TooLong if step <= LEAST * self.prepared.size => return Ok(UNTOLD),
                Step::TooLong => {}
                Step::Leads(to, [length, turn]) => {
                    if let Some(outlook) = self.at_last(&here, &to, least) {
                        return Ok(outlook);
                    }
                    step = length * (TURN[0] / turn.max(f64::MIN_POSITIVE)).min(GROWTH);
                    here = to;
                }
            }
        }
        Ok(UNTOLD)
    }

    /// One step from a place, and whether the motion ends on it. The step is shortened where it is too long.
    fn step(&mut self, here: &Vertex, step: &mut f64) -> Result<Step, MotionFailure> {
        let (to, turn, end) = match self.leg(here, step) {
            // Where the tool is in its surface a little there is no place beside the end of that.
            None => {
                let end = SurfaceEnd::just_ahead(self.prepared, here);
                return Ok(Step::Told(end.map_or(UNTOLD, Outlook::Ends)));
            }
            Some(Leg::Along(to, turn)) => (to, turn, None),
            Some(Leg::Over(beyond)) => {
                let (to, end) = self.end_between(here, beyond);
                (to, TURN[1], Some(end))
            }
        };
        let sweep = here.sweep(self.prepared, &to);
        let sag = sweep.length * turn / 8.0;
        // A step that comes so near is shortened, however much nearer it comes.
        let near = if self.may_be_tangent { f64::NEG_INFINITY } else { MARGIN * sag };
        self.watcher.near_enough = near;
        self.watcher.nearest.0 = f64::INFINITY;
        let before = self.watcher.clone();
        if self.watcher.scan(&sweep).is_some() || self.tangency.scan(here, &to)?.is_some() {
            return Ok(Step::Told(Outlook::Open { way: self.travelled() + sweep.length }));
        }
        let approach = self.watcher.nearest;
        if approach.0 <= near {
            *step = 0.25 * sweep.length;
            self.watcher = before;
            return Ok(Step::TooLong);
        }
        if approach.0 < self.nearest.0 {
            self.nearest = approach;
        }
        if let Some(end) = end {
            return Ok(Step::Told(Outlook::Ends(end)));
        }
        self.note(sweep.length, turn);
        Ok(Step::Leads(to, [sweep.length, turn]))
    }

    /// What is told once the path has closed on a step, or has left everything behind.
    fn at_last(&self, here: &Vertex, to: &Vertex, least: f64) -> Option<Outlook> {
        let is_closed = self.log.len() > 3 && self.passes(&self.start, here, to);
        let course = if is_closed { self.turn() } else { self.left_behind(least)? };
        // On a closed path those that were met come again.
        Some(if is_closed && self.met() > self.met_before {
            UNTOLD
        } else {
            let parallel = (self.tangency.nearest, self.tangency.check);
            Outlook::Nothing { course, nearest: self.nearest, met: self.met(), parallel }
        })
    }

    /// The next place and the turn of the path on the way; shortens the step until the path is followed.
    fn leg(&self, here: &Vertex, step: &mut f64) -> Option<Leg> {
        while *step > LEAST * self.prepared.size {
            let farthest = FARTHEST * *step;
            if let Some(to) = self.settled_after(here, *step) {
                let chord = to.tip - here.tip;
                let length = chord.norm();
                // Not one where the tool has fallen off the end.
                if length <= farthest
                    && let Some(end) = SurfaceEnd::at(self.prepared, &to)
                {
                    return Some(Leg::Over((to, end)));
                }
                let turn = here.tangent.cross(&to.tangent).norm().atan2(here.tangent.dot(&to.tangent));
                let ahead = chord.dot(&here.tangent) > (1.0 - TURN[1]) * length;
                if length > 0.0 && ahead && turn <= TURN[1] && length <= farthest {
                    return Some(Leg::Along(to, turn));
                }
            }
            *step *= 0.5;
        }
        None
    }

    /// The position to which a step leads; `None` where that is not found soon, or is too far away: a step that leads there is shorter.
    fn settled_after(&self, here: &Vertex, step: f64) -> Option<Vertex> {
        let Prepared { attitude, part, drive, .. } = self.prepared;
        let conditions =
            [Condition::Passing(&part.gauge, part.rest()), Condition::Passing(&drive.gauge, drive.rest())];
        let strays = |tip: &Vec3| (tip - here.tip).norm() > STRAYS * FARTHEST * step;
        let place = here.tip + here.tangent * step;
        let found = position::solve_unless(attitude, &conditions, &place, STEP, &strays).ok()?;
        Vertex::found(attitude, found, &here.tangent)
    }

    /// Where a surface ends, between a place that has it below and one that does not.
    fn end_between(
        &self,
        from: &Vertex,
        (mut beyond, mut end): (Vertex, SurfaceEnd),
    ) -> (Vertex, SurfaceEnd) {
        let mut before = from.tip;
        for _ in 0..MAX_HALVINGS {
            if (beyond.tip - before).norm() <= SAME * self.prepared.size {
                break;
            }
            let Some(middle) = Vertex::settled(self.prepared, &(0.5 * (before + beyond.tip)), &from.tangent)
            else {
                break;
            };
            match SurfaceEnd::at(self.prepared, &middle) {
                Some(there) => (beyond, end) = (middle, there),
                None => before = middle.tip,
            }
        }
        (beyond, end)
    }

    fn met(&self) -> usize {
        self.watcher.met + self.tangency.met
    }

    fn note(&mut self, length: f64, turn: f64) {
        let [travelled, turned] = self.log.last().copied().unwrap_or_default();
        self.log.push([travelled + length, turned + turn]);
    }

    fn travelled(&self) -> f64 {
        self.log.last().map_or(0.0, |[travelled, _]| *travelled)
    }

    fn turn(&self) -> Course {
        Course::Closed { length: self.travelled() }
    }

    /// Whether a step passes the place where the path was entered.
    fn passes(&self, start: &Vertex, from: &Vertex, to: &Vertex) -> bool {
        let chord = to.tip - from.tip;
        let length = chord.norm();
        if length <= 0.0 || to.tangent.dot(&start.tangent) <= 0.5 {
            return false;
        }
        let direction = chord / length;
        let along = (start.tip - from.tip).dot(&direction);
        if along <= 0.0
            || along > length
            || (start.tip - from.tip - direction * along).norm() > TURN[1] * length
        {
            return false;
        }
        let Prepared { attitude, part, drive, size, .. } = self.prepared;
        let conditions = [
            Condition::Passing(&part.gauge, part.rest()),
            Condition::Passing(&drive.gauge, drive.rest()),
            Condition::Plane(start.tangent, start.tangent.dot(&start.tip)),
        ];
        let there = position::solve(attitude, &conditions, &(from.tip + direction * along));
        there.is_ok_and(|found| (found.tip - start.tip).norm() <= SAME * size)
    }

    /// The path has gone far and is straight by now.
    fn left_behind(&self, least: f64) -> Option<Course> {
        let [travelled, turned] = *self.log.last()?;
        if travelled < least {
            return None;
        }
        let tenth = self.log.partition_point(|[at, _]| *at < 0.1 * travelled);
        let lately = turned - self.log.get(tenth)?[1];
        (lately < STRAIGHT).then_some(Course::Away { travelled })
    }
}

#[cfg(test)]
mod tests;
