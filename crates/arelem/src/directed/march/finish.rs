//! The end of a motion: the position on part, drive and check surface together (CENTR from the last vertex).

use apt_geometry::{Vec3, motion::CheckSurface};

use crate::{
    attitude::Sweep,
    directed::{
        Prepared, is_tangent,
        stop::{Event, Watcher},
    },
    error::{Iteration, MotionFailure},
    position::{self, Condition},
    role::Working,
};

/// Bound of the corrections to an end.
const CORRECTIONS: u32 = 60;
/// Steps in which it is looked whether a place that is aimed at is in one band with the end that was found.
const STEPS_TO_AIM: u32 = 4;

/// Where a motion ends.
pub(in crate::directed) struct End {
    pub(in crate::directed) tip: Vec3,
    pub(in crate::directed) check: usize,
    pub(in crate::directed) side: f64,
}

/// What an end is looked for by.
pub(in crate::directed) struct Towards<'a> {
    pub(in crate::directed) event: &'a Event,
    /// Direction of the path there.
    pub(in crate::directed) tangent: &'a Vec3,
    /// Clearances of part and drive surface to end with, instead of those at rest.
    pub(in crate::directed) held: Option<[f64; 2]>,
    /// Where the motion begins, if the vector does.
    pub(in crate::directed) begin: Option<&'a Vec3>,
}

/// The end of a motion at an event found on a straight vector: where the path only touches the check surface, the place of
/// contact. A motion that begins in the band of its check surface, farther in than motions end, ends half way to where it would come out
/// of it: it does not lead back. One that aims at a place in all bands ends there.
pub(in crate::directed) fn end(
    prepared: &Prepared,
    checks: &[CheckSurface],
    (watcher, sweep): (&Watcher<'_>, &Sweep<'_>),
    towards: &Towards<'_>,
) -> Result<End, MotionFailure> {
    let event = towards.event;
    let end = locate(prepared, checks, towards).or_else(|failure| -> Result<End, MotionFailure> {
        let touch = watcher.touch(event.check, sweep).ok_or(failure)?;
        Ok(End { tip: touch.tip, check: touch.check, side: touch.side })
    })?;
    let leads_back = |tip: &Vec3| towards.begin.filter(|begin| (tip - *begin).dot(towards.tangent) < 0.0);
    let ahead = leads_back(&end.tip).and_then(|begin| half_way(prepared, begin, event));
    let aimed = || at_aim(prepared, &end).filter(|aimed| leads_back(&aimed.tip).is_none());
    Ok(ahead.or_else(aimed).unwrap_or(end))
}

/// The exact position of an event found on a straight vector.
fn locate(
    prepared: &Prepared,
    checks: &[CheckSurface],
    &Towards { event, tangent, held, .. }: &Towards<'_>,
) -> Result<End, MotionFailure> {
    if event.grazed || is_tangent(checks[event.check].relation) {
        return Ok(End { tip: event.tip, check: event.check, side: event.side });
    }
    let mut check = prepared.checks[event.check].clone();
    check.set_side(event.side);
    check.look_from(&event.tip);
    // How a surface without definite shape bends at the end, not at the start, tells where the end lies.
    let (mut part, mut drive) = (prepared.part.clone(), prepared.drive.clone());
    part.look_along(&event.tip, tangent);
    drive.look_along(&event.tip, tangent);
    let [at_part, at_drive] = held.unwrap_or([part.rest(), drive.rest()]);
    let conditions = [
        Condition::Clearance(&part.gauge, at_part),
        Condition::Clearance(&drive.gauge, at_drive),
        Condition::Clearance(&check.gauge, check.rest()),
    ];
    // The end is where the motion is stopped: contacts that were found elsewhere might lead on to where the path meets the surface again.
    match position::solve_proven_within(&prepared.attitude, &conditions, &event.tip, CORRECTIONS) {
        Ok(solution) => Ok(End { tip: solution.tip, check: event.check, side: event.side }),
        // The event lies on a vector that is proven.
        Err(_) if keeps(prepared, &check, &event.tip) => {
            Ok(End { tip: event.tip, check: event.check, side: event.side })
        }
        Err(unsolved) => Err(MotionFailure::IterationLimit {
            iteration: Iteration::ThreeSurfaces,
            limit: unsolved.iterations,
            tip: unsolved.tip,
        }),
    }
}

/// The place that a motion aims at, if the tool is in all bands there and does not leave that of the check surface on the way from an end.
fn at_aim(prepared: &Prepared, end: &End) -> Option<End> {
    let aim = prepared.aim?;
    let mut check = prepared.checks.get(end.check)?.clone();
    check.set_side(end.side);
    check.look_from(&end.tip);
    let stays = (0..=STEPS_TO_AIM).all(|k| {
        keeps(prepared, &check, &(end.tip + (aim - end.tip) * (f64::from(k) / f64::from(STEPS_TO_AIM))))
    });
    let holds =
        stays && [&prepared.part, &prepared.drive].into_iter().all(|role| keeps(prepared, role, &aim));
    holds.then_some(End { tip: aim, ..*end })
}

/// Half way from a place to an event, if the tool is in the band of the check surface there.
fn half_way(prepared: &Prepared, from: &Vec3, event: &Event) -> Option<End> {
    let tip = 0.5 * (from + event.tip);
    let mut check = prepared.checks.get(event.check)?.clone();
    check.set_side(event.side);
    check.look_from(&tip);
    keeps(prepared, &check, &tip).then_some(End { tip, check: event.check, side: event.side })
}

/// True if the tool, at a place of the path, is in the band of a surface.
fn keeps(prepared: &Prepared, role: &Working, tip: &Vec3) -> bool {
    let posture = prepared.attitude.posture(tip);
    posture.is_ok_and(|posture| role.holds(posture.contact(&role.gauge, tip).clearance, prepared.size))
}
