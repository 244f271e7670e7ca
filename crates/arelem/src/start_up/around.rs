//! The last resort of a start-up: Newton's method from places all about the start, in shells of growing radius. Surfaces that
//! bend away, corners and edges can keep every single way from the start from its goal.

use apt_geometry::Vec3;

use crate::{
    attitude::Attitude,
    error::MotionFailure,
    position::{self, Condition},
};

/// Radii of the shells, relative to the greatest distance from the start to what is wanted: surfaces that meet at an acute angle
/// meet several times as far away.
const SHELLS: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];
/// Steps of the lattice whose outer points are the directions.
const LATTICE: i8 = 1;
/// Corrections from one place.
const CORRECTIONS: u32 = 15;

/// The position nearest to the start among those that places of the first shell with any lead to.
///
/// # Errors
/// [`MotionFailure::Cancelled`].
pub(super) fn solve(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
    cancel: &dyn Fn() -> bool,
) -> Result<Option<Vec3>, MotionFailure> {
    let mut reach = attitude.tool().radius();
    for condition in conditions {
        let clearance =
            |gauge| attitude.posture(start).map(|posture| posture.contact(gauge, start).clearance);
        reach = reach.max(match condition {
            Condition::Clearance(gauge, wanted) => (clearance(gauge)? - wanted).abs(),
            Condition::Between(gauge, [least, _]) => (clearance(gauge)? - least).abs(),
            Condition::Plane(normal, distance) => (normal.dot(start) - distance).abs(),
        });
    }
    for shell in SHELLS {
        let mut nearest: Option<Vec3> = None;
        for direction in directions() {
            if cancel() {
                return Err(MotionFailure::Cancelled);
            }
            let place = start + direction * (shell * reach);
            let Ok(found) = position::solve_within(attitude, conditions, &place, CORRECTIONS) else {
                continue;
            };
            if nearest.is_none_or(|best| (found.tip - start).norm() < (best - start).norm()) {
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
fn directions() -> impl Iterator<Item = Vec3> {
    let range = || -LATTICE..=LATTICE;
    range()
        .flat_map(move |x| range().flat_map(move |y| range().map(move |z| [x, y, z])))
        .filter(|point| point.iter().any(|x| x.abs() == LATTICE))
        .map(|point| Vec3::from(point.map(f64::from)).normalize())
}
