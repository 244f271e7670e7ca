//! A motion whose first vector cannot turn the tool to the axis that the law wants: several vectors turn it, over a way that is
//! as short as the turn allows.

use apt_geometry::Vec3;

use super::{Path, Prepared, Stuck};
use crate::{
    clearance::{Enough, Gauge, Tool, separation},
    error::{Course, Iteration, MotionFailure},
    role::Working,
};

/// The first way that is tried, as a multiple of what the turn moves the rim of the tool by, and how many at least, each twice as long as
/// the one before: as many as lead to that multiple, and twice as far, of what it moves the contacts by.
const FIRST: f64 = 2.0;
const WAYS: u32 = 5;
const MOST_WAYS: u32 = 10;
/// Angle, radians, below which the tool is not turned by the first vector.
const NO_TURN: f64 = 1e-9;

/// The path, and what it was computed with.
pub(super) fn follow<'a>(
    prepared: Prepared<'a>,
    path: &dyn Fn(&Prepared<'_>) -> Result<Path, Stuck>,
) -> Result<(Prepared<'a>, Path), Stuck> {
    let stuck = match path(&prepared) {
        Ok(found) => return Ok((prepared, found)),
        Err(stuck) => stuck,
    };
    if !is_stuck_within(&stuck.failure, &prepared, 0.0) && !turns_out_of_check(&stuck.failure, &prepared)? {
        return Err(stuck);
    }
    let angle = turn_at_start(&prepared)?;
    let shortest = FIRST * angle * extent(&prepared);
    if angle <= NO_TURN || shortest <= 0.0 {
        return Err(stuck);
    }
    let mut farthest = stuck;
    let mut short = None;
    let mut back_and_forth = None;
    for k in 0..ways(&prepared) {
        let length = shortest * f64::from(1u32 << k);
        let attitude = prepared.attitude.running_in(&prepared.tip, length);
        let running = prepared.with(attitude);
        match path(&running) {
            Err(again) if is_stuck_within(&again.failure, &prepared, length) => {}
            // A ring may be wider than the way that it is a ring of; where it is not one, the tool goes round on longer ways too.
            Err(again) if is_closed(&again.failure) => farthest = again,
            // Nor may one that leads away from the check surface from where the tool had not turned yet be the one asked for.
            Err(again) if is_left_within(&again.failure, &prepared.tip, length) => farthest = again,
            // Nor may one on which all vectors that are allowed do not lead as far as the tool turns: it goes round there.
            Err(again) if is_used_up_within(&again.failure, &prepared.tip, length) => farthest = again,
            // Once it has turned the tool goes on with its surfaces on the same hands as it came with, or it goes back along them.
            Ok(found) if changes_hands(&running, &found.points, length)? => {}
            // Nor does it go to and fro while it turns, if it need not.
            Ok(found) if goes_back(&found.points, &prepared.tip, length) => {
                back_and_forth.get_or_insert((running, found));
            }
            // Where it comes back the axis would leave its law again.
            Ok(found) if comes_back(&found.points, &prepared.tip, length) => break,
            // A ring may lead through the check surface as well; where that is as near as the way is long the motion ends before the tool has turned.
            Ok(found) if ends_within(&found.points, &prepared.tip, length) => {
                short.get_or_insert((running, found));
            }
            Err(_) if short.is_some() || back_and_forth.is_some() => break,
            found => return found.map(|found| (running, found)),
        }
    }
    short.or(back_and_forth).ok_or(farthest)
}

/// Whether a tool that has turned to its law, at a distance from where the motion begins, goes on with part and drive surface on other hands than it has them
/// on where it sets out: it then goes along them against the direction asked for, and has the drive surface on the other side than it is told. Nor does a motion
/// end so that is stopped within that distance, on a way back.
fn changes_hands(running: &Prepared, points: &[Vec3], length: f64) -> Result<bool, MotionFailure> {
    let turned = points.iter().position(|point| (point - running.tip).norm() >= length);
    let Some(turned) = turned.or(points.len().checked_sub(1)) else { return Ok(false) };
    let place = points[turned];
    let before = turned.checked_sub(1).map_or(running.tip, |k| points[k]);
    let onward = points.get(turned + 1).map_or(place - before, |next| next - place);
    let tool = running.attitude.tool_at(&place)?;
    let [part, drive] =
        [&running.part, &running.drive].map(|role| role.gauge.contact(&tool, &place).gradient);
    Ok(part.cross(&drive).dot(&onward) * running.hand() < 0.0)
}

/// Whether a vector of a path leads back against the one before while a tool turns up to a distance from a place.
fn goes_back(points: &[Vec3], place: &Vec3, distance: f64) -> bool {
    let turning = points.iter().take_while(|point| (*point - place).norm() < distance).count();
    let before = std::iter::once(place).chain(points);
    let ways: Vec<Vec3> = points.iter().zip(before).take(turning + 1).map(|(to, from)| to - from).collect();
    ways.windows(2).any(|pair| pair[0].dot(&pair[1]) < 0.0)
}

/// Whether a path ends nearer to a place than a distance.
fn ends_within(points: &[Vec3], place: &Vec3, distance: f64) -> bool {
    points.last().is_some_and(|end| (end - place).norm() < distance)
}

/// Whether no check surface was met by a tool that stands to one of them otherwise where the motion begins than with the axis that the law wants there:
/// the turn to that takes it out of the surface, or into it, and is not to go on to where the law alone would stop the motion.
fn turns_out_of_check(failure: &MotionFailure, prepared: &Prepared) -> Result<bool, MotionFailure> {
    if !matches!(failure, MotionFailure::NeverMet { .. }) {
        return Ok(false);
    }
    let turned = prepared.attitude.tool_at(&prepared.tip)?;
    let is_clear = |tool: &Tool, check: &Working| {
        let Gauge { surface, thickness, .. } = &check.gauge;
        separation(tool, surface, &prepared.tip, &Default::default(), Enough::ALL).0.clearance > *thickness
    };
    let mut crossed = prepared.checks.iter().filter(|check| !check.gauge.on);
    Ok(crossed.any(|check| is_clear(&prepared.tool, check) != is_clear(&turned, check)))
}

/// Whether a path came back to its beginning.
fn is_closed(failure: &MotionFailure) -> bool {
    matches!(failure, MotionFailure::NeverMet { course: Course::Closed { .. }, .. })
}

/// Whether no check surface was met by a path that is nowhere nearer to it than within a distance of a place.
fn is_left_within(failure: &MotionFailure, place: &Vec3, distance: f64) -> bool {
    matches!(failure, MotionFailure::NeverMet { at, .. } if (at - place).norm() <= distance)
}

/// Whether NUMPTS ended a path within a distance of a place. A ring need not come by where it was entered, which is how one is known before.
fn is_used_up_within(failure: &MotionFailure, place: &Vec3, distance: f64) -> bool {
    matches!(failure, MotionFailure::TooManyPoints { at, .. } if (at - place).norm() <= distance)
}

/// Whether a path leaves a place by a distance and is nearer to it later.
fn comes_back(points: &[Vec3], place: &Vec3, distance: f64) -> bool {
    let is_near = |point: &&Vec3| (*point - place).norm() < distance;
    points.iter().skip_while(is_near).any(|point| is_near(&point))
}

/// What a turn moves: the rim of the tool, the length of one without a rim, of a point nothing.
fn extent(prepared: &Prepared) -> f64 {
    let radius = prepared.tool.radius();
    if radius > 0.0 { radius } else { prepared.tool.cutter.height }
}

/// How many ways are tried. A tool that touches a wall which leans over it does so high up: the turn moves it away from there, or into the wall, by
/// much more than its rim, and no way that is short against this leads along the wall. On one that is long against what the turn moves the farthest
/// place of the tool by no contact is moved by as much as the tool goes on: where that is stuck the turn is not why, and a longer one would but keep
/// the axis from its law.
fn ways(prepared: &Prepared) -> u32 {
    let away = [&prepared.part, &prepared.drive]
        .map(|role| (role.gauge.contact(&prepared.tool, &prepared.tip).tool - prepared.tip).norm());
    let cutter = &prepared.tool.cutter;
    let farthest = prepared.tool.radius().hypot(cutter.height);
    let up_to = |distance: f64| {
        let ratio = distance / extent(prepared);
        (2..MOST_WAYS).find(|k| f64::from(1u32 << (k - 2)) >= ratio).unwrap_or(MOST_WAYS)
    };
    up_to(away[0].max(away[1])).max(WAYS).min(up_to(farthest))
}

/// Angle between the axis that the tool has and the one that it is to have.
fn turn_at_start(prepared: &Prepared) -> Result<f64, MotionFailure> {
    let (has, wants) = (prepared.tool.axis, prepared.attitude.tool_at(&prepared.tip)?.axis);
    Ok(has.cross(&wants).norm().atan2(has.dot(&wants)))
}

/// Whether no vector was found that leads on, or to the stop, not farther from where the motion begins, or the path goes round within that
/// distance: where the axis turns too fast the places at which the tool touches both surfaces are a ring about the beginning.
fn is_stuck_within(failure: &MotionFailure, prepared: &Prepared, distance: f64) -> bool {
    match failure {
        MotionFailure::NoAdmissibleVector { tip, .. }
        | MotionFailure::NoProgress { tip, .. }
        | MotionFailure::IterationLimit {
            iteration: Iteration::StepLength | Iteration::FinalVector,
            tip,
            ..
        } => (tip - prepared.tip).norm() <= distance,
        MotionFailure::NeverMet { course: Course::Closed { length }, .. } => 0.5 * length <= distance,
        _ => false,
    }
}
