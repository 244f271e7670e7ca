//! Check surfaces that the path touches without crossing them: where it comes nearest, and in tolerance, the tool is
//! properly positioned, which is what TO and ON ask for (language reference 6.6).

use apt_geometry::{Vec3, motion::Relation};

use super::{BISECTIONS, Event, Status, Trail, Watch, Watcher};
use crate::{
    attitude::Sweep,
    directed::{Prepared, march::Vertex},
    position::{self, Condition},
};

/// How many times the bands of all surfaces a vector must come near for the path to be followed.
const NEAR: f64 = 4.0;
/// Bound of the search for the least value.
const MAX_ITERATIONS: u32 = 80;
/// Share of the stretch at which it ends.
const RESOLUTION: f64 = 1e-9;
/// The same where only the value counts: beside the least one it changes with the square.
const RESOLUTION_OF_VALUE: f64 = 1e-6;
/// Share of a vector beside the least value on it at which the tool is still on the same side of the surface, if it does not get around its edge.
const BESIDE: f64 = 4.0 * RESOLUTION;
/// How fast the path goes along at most by the way along a vector: it leads at no more than 60° to that.
const PATH_SPEED: f64 = 2.0;
/// Share of the vector at its ends that belongs to its neighbours.
const END: f64 = 1e-6;

/// Where a function of one valley is least on a stretch, by golden sections; `None` where it has no value.
pub(in crate::directed) fn least(
    stretch: [f64; 2],
    value: &dyn Fn(f64) -> Option<f64>,
) -> Option<(f64, f64)> {
    least_up_to((f64::INFINITY, f64::INFINITY), stretch, value)
}

/// The same of a function that is nowhere steeper than a slope, if it is there up to a level.
fn least_up_to(
    (level, slope): (f64, f64),
    [low, high]: [f64; 2],
    value: &dyn Fn(f64) -> Option<f64>,
) -> Option<(f64, f64)> {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut a, mut b) = (low, high);
    let (mut x, mut y) = (b - golden * (b - a), a + golden * (b - a));
    let (mut at_x, mut at_y) = (value(x)?, value(y)?);
    for _ in 0..MAX_ITERATIONS {
        if b - a <= RESOLUTION * (high - low) {
            break;
        }
        // Where it has no value, which counts as infinite, it may leap.
        if at_x.max(at_y) < f64::INFINITY && at_x.min(at_y) - slope * (b - a) > level {
            return None;
        }
        if at_x <= at_y {
            (b, y, at_y) = (y, x, at_x);
            x = b - golden * (b - a);
            at_x = value(x)?;
        } else {
            (a, x, at_x) = (x, y, at_y);
            y = a + golden * (b - a);
            at_y = value(y)?;
        }
    }
    Some(if at_x <= at_y { (x, at_x) } else { (y, at_y) })
}

/// Where a function that falls below zero on a stretch has come down to that, by halving; `None` where it begins below.
fn first_zero([mut low, mut high]: [f64; 2], value: &dyn Fn(f64) -> Option<f64>) -> Option<f64> {
    if value(low)? <= 0.0 {
        return None;
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if value(middle)? > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

/// The least value of a function of one valley on a stretch and where it is, by parabolas through the last places, and by golden sections
/// where these do not close in on it (Brent): fewer places than by golden sections alone.
pub(in crate::directed) fn least_value(stretch: [f64; 2], value: &dyn Fn(f64) -> f64) -> (f64, f64) {
    least_or_enough(stretch, f64::NEG_INFINITY, value)
}

/// The same, or a place where the value is small enough.
pub(super) fn least_or_enough([low, high]: [f64; 2], enough: f64, value: &dyn Fn(f64) -> f64) -> (f64, f64) {
    let golden = 0.5 * (3.0 - 5.0_f64.sqrt());
    let tolerance = RESOLUTION_OF_VALUE * (high - low);
    let (mut a, mut b) = (low, high);
    let first = a + golden * (b - a);
    // The best places so far, the best one first, and the last two steps.
    let [mut best, mut second, mut third] = [(first, value(first)); 3];
    let (mut step, mut before) = (0.0_f64, 0.0_f64);
    for _ in 0..MAX_ITERATIONS {
        let middle = 0.5 * (a + b);
        if best.1 <= enough || (best.0 - middle).abs() + 0.5 * (b - a) <= 2.0 * tolerance {
            break;
        }
        let parabola = vertex(best, second, third)
            .filter(|x| *x > a + tolerance && *x < b - tolerance && (x - best.0).abs() < 0.5 * before.abs());
        before = step;
        step = match parabola {
            Some(x) => x - best.0,
            None => {
                before = if best.0 >= middle { a - best.0 } else { b - best.0 };
                golden * before
            }
        };
        let x = best.0 + if step.abs() >= tolerance { step } else { tolerance.copysign(step) };
        let found = (x, value(x));
        if found.1 <= best.1 {
            if x >= best.0 {
                a = best.0;
            } else {
                b = best.0;
            }
            (third, second, best) = (second, best, found);
        } else {
            if x < best.0 {
                a = x;
            } else {
                b = x;
            }
            if found.1 <= second.1 || second.0 == best.0 {
                (third, second) = (second, found);
            } else if found.1 <= third.1 || third.0 == best.0 || third.0 == second.0 {
                third = found;
            }
        }
    }
    best
}

/// Where the parabola through three places has its vertex, if it has one.
fn vertex(best: (f64, f64), second: (f64, f64), third: (f64, f64)) -> Option<f64> {
    let side = |other: (f64, f64), against: (f64, f64)| (best.0 - other.0) * (best.1 - against.1);
    let (r, q) = (side(second, third), side(third, second));
    let (over, under) = ((best.0 - third.0) * q - (best.0 - second.0) * r, 2.0 * (q - r));
    let x = best.0 - over / under;
    x.is_finite().then_some(x)
}

impl Watcher<'_> {
    /// The stop where the path along a vector that crosses nothing comes nearest to a check surface, if that is in the band.
    pub(super) fn grazed(
        &mut self,
        index: usize,
        watch: &mut Watch,
        sweep: &Sweep<'_>,
        trail: &Trail,
        wanted: u32,
    ) -> Option<Event> {
        let was_falling = std::mem::take(&mut watch.falling);
        let relation = self.checks[index].relation;
        let waiting = match relation {
            Relation::To => watch.status == Status::Clear,
            Relation::On => watch.status != Status::Touching,
            _ => false,
        };
        if !waiting || trail.least > self.near(index) || sweep.length <= 0.0 {
            return None;
        }
        let value_at = |x: f64| Some(self.on_path(index, sweep, x).map_or(f64::INFINITY, |found| found.1));
        let [low, high] = self.room(index);
        let reach = self.working(index).gauge.reach(&self.prepared.tool);
        let steepest = PATH_SPEED * sweep.stretch(reach);
        let (x, value) = least_up_to((high, steepest), [0.0, sweep.length], &value_at)?;
        if value > high {
            return None;
        }
        if x >= sweep.length * (1.0 - END) {
            watch.falling = true;
            return None;
        }
        if x <= sweep.length * END && !was_falling {
            return None;
        }
        // Where the path itself changes sides the vectors do so near by, and that is the position.
        let side = |x: f64| self.on_path(index, sweep, x).map(|found| found.2);
        if relation == Relation::On && side(0.0)? != side(sweep.length)? {
            return None;
        }
        // Where the tool gets around the edge of the surface the value leaps, and is least on the one side of that only.
        let beside = BESIDE * sweep.length;
        if relation == Relation::To && side(x - beside)? != side(x + beside)? {
            return None;
        }
        watch.status = Status::Touching;
        watch.count += 1;
        let (vertex, _, side) = self.on_path(index, sweep, x)?;
        self.note(index, value.abs(), &vertex.tip);
        let grazed = value >= low;
        (watch.count >= wanted).then_some(Event {
            check: index,
            tip: vertex.tip,
            x,
            side,
            grazed,
            is_shallow: false,
        })
    }

    /// Where a vector that crosses the check surface's relation belongs to a path that only touches it, or goes through it so little that corrections
    /// lose the position: vectors run elsewhere in their bands than the path that ends on part and drive surface.
    pub(in crate::directed) fn touch(&self, index: usize, sweep: &Sweep<'_>) -> Option<Event> {
        if !matches!(self.checks[index].relation, Relation::To | Relation::On) || sweep.length <= 0.0 {
            return None;
        }
        let at = |x: f64| self.on_path(index, sweep, x).map(|found| found.1);
        let (x, value) = least([0.0, sweep.length], &at)?;
        let [low, high] = self.room(index);
        let x = if value < low { first_zero([0.0, x], &at)? } else { x };
        let (vertex, _, side) = self.on_path(index, sweep, x)?;
        let event = Event { check: index, tip: vertex.tip, x, side, grazed: true, is_shallow: false };
        (value <= high).then_some(event)
    }

    /// How near a vector comes to the check surface where the path may touch it.
    pub(super) fn near(&self, index: usize) -> f64 {
        let Self { prepared, .. } = self;
        NEAR * (prepared.part.band() + prepared.drive.band() + self.working(index).band())
    }

    /// The band about a check surface's relation, measured from where the tool rests in it.
    fn room(&self, index: usize) -> [f64; 2] {
        let working = self.working(index);
        if working.gauge.on {
            return [0.0, working.inside.max(working.outside)];
        }
        [-working.inside - working.rest(), working.outside - working.rest()]
    }

    /// The function where the path at rest on part and drive surface is next to a place, if that is not farther away than vectors may be.
    pub(super) fn at_rest(&self, index: usize, place: &Vec3) -> Option<f64> {
        let tip = self.rest_at(place)?;
        let tool = self.prepared.attitude.tool_at(&tip).ok()?;
        let is_near = (tip - place).norm() <= self.near(index);
        is_near.then(|| self.value(index, &tool, &tip).0)
    }

    /// The position at rest on part and drive surface to which corrections lead from a place.
    fn rest_at(&self, place: &Vec3) -> Option<Vec3> {
        let Prepared { attitude, part, drive, .. } = self.prepared;
        let conditions = [
            Condition::Clearance(&part.gauge, part.rest()),
            Condition::Clearance(&drive.gauge, drive.rest()),
        ];
        Some(position::solve(attitude, &conditions, place).ok()?.tip)
    }

    /// The position on part and drive surface next to a place of a vector, how far the check surface is from its relation
    /// there, and the side of it. A position that lies elsewhere along the vector is not next to the place: corrections lead across the path,
    /// unless they are lost.
    fn on_path(&self, index: usize, sweep: &Sweep<'_>, x: f64) -> Option<(Vertex, f64, f64)> {
        let prepared = self.prepared;
        let place = sweep.at(x).0;
        let tip = self.rest_at(&place)?;
        if (tip - place).dot(&sweep.direction).abs() > self.near(index) {
            return None;
        }
        let vertex = Vertex::at(prepared, tip, &sweep.direction).ok()?;
        let tool = prepared.attitude.tool_at(&tip).ok()?;
        let (value, side) = self.value(index, &tool, &tip);
        Some((vertex, if self.working(index).gauge.on { value.abs() } else { value }, side))
    }
}

#[cfg(test)]
mod tests;
