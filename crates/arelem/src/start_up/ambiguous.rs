//! Start-ups with more than one answer: several positions that are equally near to where the tool stands. Which of them a
//! search finds is chance, so none is taken.

use apt_geometry::Vec3;

use super::StartUp;
use crate::{
    attitude::Attitude,
    position::{self, Condition},
};

/// Two ways differ if their lengths do by more than this, relative to the size of the coordinates.
const SAME_LENGTH: f64 = 1e-9;
/// Moves shorter than this, relative to the size of the coordinates, have no image.
const SAME_PLACE: f64 = 1e-6;
/// Two answers are farther apart than this share of the way to them: beside the nearest position distances grow with the
/// square of the way, and what a search finds there is the same answer.
const APART: f64 = 1e-2;
/// Corrections from one place.
const CORRECTIONS: u32 = 20;

/// Another position with every relation, as far from the start as the one that was found: its mirror images at the start, at
/// the normals there and at the tool axis lead to it where there is one.
pub(super) fn twin(work: &StartUp<'_>, found: &Vec3) -> Option<Vec3> {
    let StartUp { tip, attitude, tool, .. } = work;
    let conditions: Vec<Condition<'_>> =
        work.roles.iter().map(|role| Condition::Clearance(&role.gauge, role.rest())).collect();
    let way = found - tip;
    let (length, size) = (way.norm(), position::size(tool, tip) + way.norm());
    if length <= SAME_PLACE * size {
        return None;
    }
    let posture = attitude.posture(tip).ok()?;
    let normals = work.roles.iter().map(|role| posture.contact(&role.gauge, tip).gradient);
    let about = normals.chain([tool.axis]).filter_map(|direction| direction.try_normalize(0.0));
    let images = about.map(|direction| direction * (2.0 * way.dot(&direction)) - way).chain([-way]);
    images
        .filter(|image| (image - way).norm() > SAME_PLACE * size)
        .filter_map(|image| position::solve_within(attitude, &conditions, &(tip + image), CORRECTIONS).ok())
        .map(|solution| solution.tip)
        .find(|other| {
            (other - found).norm() > APART * length
                && ((other - tip).norm() - length).abs() <= SAME_LENGTH * size
                && !is_nearer_between(attitude, &conditions, [found, other], tip)
        })
}

/// Whether there is a position between two that is nearer to the start than both: they are then two sides of one answer,
/// about which the way of the search is mirrored.
fn is_nearer_between(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    [found, other]: [&Vec3; 2],
    start: &Vec3,
) -> bool {
    let middle = (found + other) * 0.5;
    let solved = position::solve_within(attitude, conditions, &middle, CORRECTIONS);
    let nearest = (found - start).norm().min((other - start).norm());
    solved.is_ok_and(|between| {
        let is_between =
            [found, other].iter().all(|end| (between.tip - *end).norm() < (found - other).norm());
        is_between && (between.tip - start).norm() < nearest
    })
}
