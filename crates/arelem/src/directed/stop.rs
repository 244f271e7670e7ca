//! Check surfaces as events along the path (ACHECK, CHECK1 to CHECK3 made safe): clearance changes by no more than the
//! distance moved, so stepping by the clearance itself can never jump over a position.

use apt_geometry::{
    Vec3,
    motion::{CheckSurface, Relation},
};

use super::{Prepared, is_tangent};
use crate::{
    attitude::Sweep,
    clearance::{Tool, separation},
    role::Working,
};

/// Bound of the steps along one cut vector; beyond it steps are a fixed share of the vector.
const MAX_STEPS: u32 = 4000;
/// Steps after which near-contact is followed in coarse steps.
const FINE_STEPS: u32 = 400;
/// Least step, as a share of the check surface's band.
const LEAST_STEP: f64 = 0.02;
/// Bisections that bring a bracket to rounding.
const BISECTIONS: u32 = 60;

/// Where the tool stands to a check surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Status {
    /// In the band since the start: no position yet.
    Touching,
    /// Clear of it; for ON: on the positive side.
    Clear,
    /// Cutting into it; for ON: on the negative side.
    Inside,
}

/// One check surface being watched.
#[derive(Debug, Clone, Copy)]
struct Watch {
    status: Status,
    count: u32,
    /// A position and the radius around it in which nothing happens.
    quiet: (Vec3, f64),
}

/// A stopping position found on a cut vector.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event {
    pub(super) check: usize,
    /// Position on the straight vector.
    pub(super) tip: Vec3,
    /// Distance from the start of the vector.
    pub(super) x: f64,
    /// Side of the check surface on which the tool stands there.
    pub(super) side: f64,
}

/// Watches all check surfaces of a motion.
#[derive(Clone)]
pub(super) struct Watcher<'a> {
    prepared: &'a Prepared,
    checks: &'a [CheckSurface],
    watches: Vec<Watch>,
    /// Positions met so far, with any relation.
    pub(super) met: usize,
    /// Least distance from a relation, where and of which check surface.
    pub(super) nearest: (f64, Vec3, usize),
}

impl<'a> Watcher<'a> {
    pub(super) fn new(prepared: &'a Prepared, checks: &'a [CheckSurface]) -> Self {
        let mut watcher =
            Self { prepared, checks, watches: Vec::new(), met: 0, nearest: (f64::INFINITY, prepared.tip, 0) };
        for (index, check) in checks.iter().enumerate() {
            let value = if is_tangent(check.relation) {
                f64::INFINITY
            } else {
                watcher.value(index, &prepared.tool, &prepared.tip).0
            };
            let working = &prepared.checks[index];
            let band = working.inside.max(working.outside) + 1e-9 * prepared.size;
            let status = if value.abs() <= band {
                Status::Touching
            } else if value > 0.0 {
                Status::Clear
            } else {
                Status::Inside
            };
            watcher.watches.push(Watch { status, count: 0, quiet: (prepared.tip, 0.0) });
        }
        watcher
    }

    fn working(&self, index: usize) -> &Working {
        &self.prepared.checks[index]
    }

    /// The function whose sign changes at a position, and the side of the surface.
    fn value(&self, index: usize, tool: &Tool, tip: &Vec3) -> (f64, f64) {
        let working = self.working(index);
        if working.gauge.on {
            let distance = working.gauge.surface.signed_distance(tip);
            return (distance, if distance < 0.0 { -1.0 } else { 1.0 });
        }
        let (contact, side) = separation(tool, &working.gauge.surface, tip);
        (contact.clearance - working.gauge.thickness - working.rest(), side)
    }

    /// The function at a distance from the start of a vector.
    fn value_at(&self, index: usize, sweep: &Sweep<'_>, x: f64) -> (f64, f64) {
        let (tip, tool) = sweep.at(x);
        self.value(index, &tool, &tip)
    }

    /// The first stop on a straight vector; without one the vector counts as travelled.
    pub(super) fn scan(&mut self, sweep: &Sweep<'_>) -> Option<Event> {
        let (from, to) = (sweep.at(0.0).0, sweep.at(sweep.length).0);
        let mut first: Option<Event> = None;
        let mut after = Vec::new();
        for index in 0..self.checks.len() {
            if is_tangent(self.checks[index].relation) {
                continue;
            }
            let watch = self.watches[index];
            let (quiet, radius) = watch.quiet;
            if !sweep.turns() && (from - quiet).norm() < radius && (to - quiet).norm() < radius {
                continue;
            }
            let (event, next) = self.follow(index, watch, sweep);
            if let Some(event) = event
                && first.is_none_or(|best| event.x < best.x)
            {
                first = Some(event);
            }
            after.push((index, next));
        }
        if first.is_none() {
            for (index, next) in after {
                self.met += (next.count - self.watches[index].count) as usize;
                self.watches[index] = next;
            }
        }
        first
    }

    fn follow(&mut self, index: usize, watch: Watch, sweep: &Sweep<'_>) -> (Option<Event>, Watch) {
        let (length, stretch) = (sweep.length, sweep.stretch());
        let working = self.working(index);
        let (band, size) = (working.inside.max(working.outside), self.prepared.size);
        let least = (LEAST_STEP * working.band()).max(1e-10 * size);
        let relation = self.checks[index].relation;
        let wanted = self.checks[index].occurrence.max(1);
        let mut watch = watch;
        let (mut x, mut value) = (0.0, self.value_at(index, sweep, 0.0).0);
        self.note(index, value, &sweep.at(0.0).0);
        for step in 0..MAX_STEPS {
            if x >= length {
                break;
            }
            let floor = if step < FINE_STEPS { least } else { least.max(length / 64.0) };
            let next_x = (x + value.abs().max(floor) / stretch).min(length);
            let (tip, tool) = sweep.at(next_x);
            let (next, side) = self.value(index, &tool, &tip);
            self.note(index, next, &tip);
            let label =
                transition(&mut watch.status, next, band + 1e-9 * size, working_on(self.working(index)));
            if let Some(label) = label {
                watch.count += u32::from(label == relation);
                if label == relation && watch.count >= wanted {
                    let (at, side) = self.bracket(index, sweep, [x, next_x], value > 0.0, (label, side));
                    return (Some(Event { check: index, tip: sweep.at(at).0, x: at, side }), watch);
                }
            }
            (x, value) = (next_x, next);
        }
        watch.quiet = (sweep.at(length).0, value.abs());
        (None, watch)
    }

    fn note(&mut self, index: usize, value: f64, tip: &Vec3) {
        if value.abs() < self.nearest.0 {
            self.nearest = (value.abs(), *tip, index);
        }
    }

    /// Bisects a sign change; the side is that on which the tool is clear (TO: before, PAST: after), for ON that it
    /// comes from.
    fn bracket(
        &self,
        index: usize,
        sweep: &Sweep<'_>,
        [low, high]: [f64; 2],
        positive: bool,
        (label, after): (Relation, f64),
    ) -> (f64, f64) {
        let (mut low, mut high) = (low, high);
        let mut before = self.value_at(index, sweep, low).1;
        let mut beyond = after;
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            let (value, side) = self.value_at(index, sweep, middle);
            if (value > 0.0) == positive {
                (low, before) = (middle, side);
            } else {
                (high, beyond) = (middle, side);
            }
        }
        (0.5 * (low + high), if label == Relation::Past { beyond } else { before })
    }
}

fn working_on(working: &Working) -> bool {
    working.gauge.on
}

/// Follows the sign; the relation that is reached when it changes.
fn transition(status: &mut Status, value: f64, band: f64, on: bool) -> Option<Relation> {
    let now = if value > 0.0 { Status::Clear } else { Status::Inside };
    match (*status, now) {
        (Status::Touching, _) if value.abs() <= band => None,
        (Status::Touching, _) => {
            *status = now;
            None
        }
        (Status::Clear, Status::Inside) => {
            *status = now;
            Some(if on { Relation::On } else { Relation::To })
        }
        (Status::Inside, Status::Clear) => {
            *status = now;
            Some(if on { Relation::On } else { Relation::Past })
        }
        _ => None,
    }
}
