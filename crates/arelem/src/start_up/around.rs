//! The last resort of a start-up: Newton's method from places all about the start, in shells of growing radius. Surfaces that
//! bend away, corners and edges can keep every single way from the start from its goal.

use apt_geometry::{Vec3, patience::Patience};

use crate::{
    attitude::Attitude,
    error::MotionFailure,
    position::{self, Condition, Effort, Unsolved},
};

/// Radii of the shells, relative to the greatest distance from the start to what is wanted: surfaces that meet at an acute angle
/// meet several times as far away.
const SHELLS: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];
/// Steps of the lattice whose outer points are the directions.
const LATTICE: i8 = 1;
/// What is tried from one place: a way that winds more leads nowhere, for there are others.
pub(super) const TRY: Effort = Effort { corrections: 15, halvings: 3, turns: 1, is_one_of_many: true };
/// Corrections of what a try came to.
const CORRECTIONS: u32 = 15;
/// How near to the end of a vain try, relative to what was wrong there, another is in vain: clearances change by no more than the
/// tool moves, so that there is no position within the whole of it, and from its middle the way did not lead out of it.
const IN_VAIN: f64 = 0.5;

/// The position nearest to the start among those that places of the first shell with any lead to, of positions that the tool can stand at.
///
/// # Errors
/// [`MotionFailure::Cancelled`].
pub(super) fn solve(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
    stands: &dyn Fn(&Vec3) -> bool,
    patience: Patience<'_>,
) -> Result<Option<Vec3>, MotionFailure> {
    let mut reach = attitude.tool().radius();
    for condition in conditions {
        let clearance =
            |gauge| attitude.posture(start).map(|posture| posture.contact(gauge, start).clearance);
        reach = reach.max(match condition {
            Condition::Clearance(gauge, wanted) | Condition::Passing(gauge, wanted) => {
                (clearance(gauge)? - wanted).abs()
            }
            Condition::Between(gauge, [least, _]) => (clearance(gauge)? - least).abs(),
            Condition::Plane(normal, distance) => (normal.dot(start) - distance).abs(),
        });
    }
    // Most tries lead nowhere: they are made without proofs, and what they come to is then looked at again.
    let passing: Vec<Condition<'_>> = conditions.iter().map(Condition::passing).collect();
    let mut vain: Vec<(Vec3, f64)> = Vec::new();
    for shell in SHELLS {
        let mut nearest: Option<Vec3> = None;
        for direction in directions() {
            if patience.is_over() {
                return Err(MotionFailure::Cancelled);
            }
            let place = start + direction * (shell * reach);
            let is_in_vain =
                |tip: &Vec3| vain.iter().any(|(end, wrong)| (tip - end).norm() <= IN_VAIN * wrong);
            if is_in_vain(&place) {
                continue;
            }
            let likely = match position::solve_unless(attitude, &passing, &place, TRY, &is_in_vain) {
                Ok(likely) => likely,
                Err(Unsolved { tip, residual, .. }) => {
                    if residual.is_finite() && !is_in_vain(&tip) {
                        vain.push((tip, residual));
                    }
                    continue;
                }
            };
            let Ok(found) = position::solve_within(attitude, conditions, &likely.tip, CORRECTIONS) else {
                continue;
            };
            let is_nearer = nearest.is_none_or(|best| (found.tip - start).norm() < (best - start).norm());
            if is_nearer && stands(&found.tip) {
                nearest = Some(found.tip);
            }
        }
        if nearest.is_some() {
            return Ok(nearest);
        }
    }
    Ok(None)
}

/// Unit vectors to the points on the faces of a cube.
pub(super) fn directions() -> impl Iterator<Item = Vec3> {
    let range = || -LATTICE..=LATTICE;
    range()
        .flat_map(move |x| range().flat_map(move |y| range().map(move |z| [x, y, z])))
        .filter(|point| point.iter().any(|x| x.abs() == LATTICE))
        .map(|point| Vec3::from(point.map(f64::from)).normalize())
}
