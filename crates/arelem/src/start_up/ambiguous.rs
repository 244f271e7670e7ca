//! Start-ups with more than one answer: several positions that are equally near to where the tool stands. Which of them a
//! search finds is chance, so none is taken.

use std::f64::consts::TAU;

use apt_geometry::Vec3;

use super::{
    StartUp,
    around::{TRY, directions},
};
use crate::{
    attitude::Attitude,
    position::{self, Condition, Solution},
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

/// Directions about the tool axis, in parts of a turn, in which another answer is looked for besides.
const TURNS: u32 = 8;
/// Bound of the steps towards the position that is the nearest about another one.
const STEPS: u32 = 20;
/// How many times what of the way to a position leads along that may come nearer to the start at most: the shares of a step that is made at once.
const STEPS_AHEAD: f64 = 4.0;
const SHARES: [f64; 2] = [0.02, 4.0];

/// Another position with every relation, as far from the start as the one that was found: its mirror images at the start, at
/// the normals there and at the tool axis lead to it where there is one, or the nearest position about another direction from the start.
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
    // From a place all but there two lengths are the same to rounding over a greater share of the way.
    let apart = (APART * length).max((2.0 * length * SAME_LENGTH * size).sqrt());
    let is_twin = |other: &Vec3| {
        (other - found).norm() > apart
            && ((other - tip).norm() - length).abs() <= SAME_LENGTH * size
            && !is_nearer_between(attitude, &conditions, [found, other], tip)
    };
    let imaged = images
        .filter(|image| (image - way).norm() > SAME_PLACE * size)
        .filter_map(|image| position::solve_within(attitude, &conditions, &(tip + image), CORRECTIONS).ok())
        .map(|solution| solution.tip)
        .find(is_twin);
    imaged.or_else(|| {
        let passing: Vec<Condition<'_>> =
            work.roles.iter().map(|role| Condition::Passing(&role.gauge, role.rest())).collect();
        let search = Beside { attitude, conditions: &passing, start: tip, nearest: length, size };
        (1..TURNS)
            .filter_map(|k| search.nearest_about(&turned(&way, &tool.axis, f64::from(k) / f64::from(TURNS))))
            .filter(|place| ((place - tip).norm() - length).abs() <= SAME_LENGTH * size)
            .filter_map(|place| position::solve_within(attitude, &conditions, &place, CORRECTIONS).ok())
            .map(|solution| solution.tip)
            .find(is_twin)
    })
}

/// The position at the one surface of a start-up that is the nearest to the start of those about all directions from there, the found one among
/// them. A search goes where the clearance tells at the start, and in the middle of a sphere, or on the axis of a cylinder, it tells nothing: in
/// the way that is the shortest the tool may well go along its axis.
pub(super) fn nearest_of_all(work: &StartUp<'_>, found: Vec3) -> Vec3 {
    let StartUp { tip, attitude, tool, .. } = work;
    let proven: Vec<Condition<'_>> =
        work.roles.iter().map(|role| Condition::Clearance(&role.gauge, role.rest())).collect();
    let passing: Vec<Condition<'_>> = proven.iter().map(Condition::passing).collect();
    let nearest = (found - tip).norm();
    let size = position::size(tool, tip) + nearest;
    let search = Beside { attitude, conditions: &passing, start: tip, nearest, size };
    let others = directions()
        .chain([tool.axis, -tool.axis])
        .filter_map(|direction| search.nearest_about(&(direction * nearest)))
        .filter(|place| nearest - (place - tip).norm() > SAME_LENGTH * size)
        .filter_map(|place| position::solve_within(attitude, &proven, &place, CORRECTIONS).ok())
        .map(|solution| solution.tip);
    others.fold(found, |best, other| if (other - tip).norm() < (best - tip).norm() { other } else { best })
}

/// A way turned about an axis by a part of a turn.
fn turned(way: &Vec3, axis: &Vec3, part: f64) -> Vec3 {
    let along = axis * way.dot(axis);
    let (sin, cos) = (TAU * part).sin_cos();
    along + (way - along) * cos + axis.cross(way) * sin
}

/// A search for positions that are the nearest to the start of all about them.
struct Beside<'a> {
    attitude: &'a Attitude<'a>,
    conditions: &'a [Condition<'a>],
    start: &'a Vec3,
    /// The way to the nearest position that is known.
    nearest: f64,
    size: f64,
}

impl Beside<'_> {
    /// The position that is the nearest about the one that a way leads to, unless it is plainly not as near as the nearest known. There the way
    /// leads along the gradients of the clearances. What of it does not is left out, by a share that the last step tells, and the
    /// position is corrected, until nothing is left.
    fn nearest_about(&self, way: &Vec3) -> Option<Vec3> {
        let Self { attitude, conditions, start, nearest, size } = *self;
        let (mut place, mut share, mut last) = (start + way, 1.0_f64, None::<Vec3>);
        for _ in 0..STEPS {
            let solved = position::solve_unless(attitude, conditions, &place, TRY, &|_| false);
            let Solution { tip, contacts, .. } = solved.ok()?;
            let way = tip - start;
            let along = across_all(&way, contacts.iter().flatten().map(|contact| contact.gradient));
            let left = along.norm();
            if left <= SAME_LENGTH * size {
                return Some(tip);
            }
            if way.norm() - nearest > STEPS_AHEAD * left {
                return None;
            }
            let ratio = last.map_or(0.0, |last| along.dot(&last) / last.norm_squared());
            if ratio < 1.0 {
                share = (share / (1.0 - ratio)).clamp(SHARES[0], SHARES[1]);
            }
            (place, last) = (tip - along * share, Some(along));
        }
        None
    }
}

/// What of a vector leads across all of these directions.
fn across_all(vector: &Vec3, directions: impl Iterator<Item = Vec3>) -> Vec3 {
    let (mut left, mut frame) = (*vector, Vec::new());
    for direction in directions {
        let own = frame.iter().fold(direction, |own, axis: &Vec3| own - axis * own.dot(axis));
        // Of what is nearly among the others rounding alone would tell.
        if let Some(axis) = own.try_normalize(SAME_PLACE * direction.norm()) {
            left -= axis * left.dot(&axis);
            frame.push(axis);
        }
    }
    left
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
    let solved = position::solve_proven_within(attitude, conditions, &middle, CORRECTIONS);
    let nearest = (found - start).norm().min((other - start).norm());
    solved.is_ok_and(|between| {
        let is_between =
            [found, other].iter().all(|end| (between.tip - *end).norm() < (found - other).norm());
        is_between && (between.tip - start).norm() < nearest
    })
}
