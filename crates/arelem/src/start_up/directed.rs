//! Start-up guided by INDIRV and INDIRP: interim moves that bring the tool near the wanted side and branch.

use apt_geometry::{
    Vec3,
    motion::{Direction, Relation},
    surface::RootSelection,
};

use super::{StartUp, is_plane};
use crate::{
    error::{MotionFailure, RoleName},
    position::{self, Condition},
};

/// When all surfaces are planes only this share of the interim move is made.
const ALL_PLANES_SHARE: f64 = 0.75;

/// Unit vector of a direction seen from a position.
pub(super) fn unit_direction(direction: &Direction, tip: &Vec3) -> Result<Vec3, MotionFailure> {
    let (vector, number) = match direction {
        Direction::Vector(vector) => (*vector, 7),
        Direction::Point(point) => (point - tip, 6),
    };
    vector.try_normalize(0.0).ok_or(MotionFailure::ZeroDirection { number })
}

/// The tool end after one hidden move per direction, in the order drive, part, check. From the observer the ray is
/// shot at the surface; the tool moves up to it, less its radius unless it shall end ON the surface.
pub(super) fn interim(work: &StartUp<'_>) -> Result<Vec3, MotionFailure> {
    let mut tip = work.tip;
    let undirected = greatest_undirected(work);
    let all_planes = work.roles.len() == 3 && work.roles.iter().all(is_plane);
    for name in [RoleName::Drive, RoleName::Part, RoleName::Check(0)] {
        let index = match name {
            RoleName::Drive => 0,
            RoleName::Part => 1,
            RoleName::Check(_) => 2,
        };
        let Some(direction) = work.state.directions[index] else { continue };
        let Some(role) = work.roles.iter().find(|r| r.name == name) else { continue };
        let direction = unit_direction(&direction, &work.tip)?;
        let observer = work.tool.observer(&tip) + direction * role.gauge.thickness;
        let hit = role.gauge.surface.directed_distance(&observer, &direction, RootSelection::Ahead);
        tip += match hit {
            Ok(distance) => {
                let radius = if role.relation == Relation::On { 0.0 } else { work.tool.cutter.radius() };
                let share = if all_planes { ALL_PLANES_SHARE } else { 1.0 };
                direction * (share * (distance - radius - role.band()))
            }
            Err(_) if work.roles.len() == 1 => {
                return Err(MotionFailure::NotReachedAlong { role: name, from: observer, direction });
            }
            Err(_) => direction * undirected,
        };
    }
    Ok(tip)
}

/// Greatest distance from the surfaces without direction.
fn greatest_undirected(work: &StartUp<'_>) -> f64 {
    let mut greatest: f64 = 0.0;
    for role in &work.roles {
        let index = match role.name {
            RoleName::Drive => 0,
            RoleName::Part => 1,
            RoleName::Check(_) => 2,
        };
        if work.state.directions[index].is_none() {
            greatest = greatest.max(role.gauge.surface.signed_distance(&work.tip).abs());
        }
    }
    greatest
}

/// A third plane through the original position that keeps the move in the direction given: with one surface the move
/// is made exactly along it, with two planes in the plane of the direction and the part surface's normal.
pub(super) fn guide_plane(work: &StartUp<'_>, original: &Vec3) -> Option<(Vec3, f64)> {
    let given: Vec<&Direction> = work.state.directions.iter().flatten().collect();
    if given.len() != 1 || work.roles.len() != 2 || !work.roles.iter().all(is_plane) {
        return None;
    }
    let direction = unit_direction(given[0], original).ok()?;
    let part = work.roles[1].gauge.surface.foot(original).normal;
    let drive = work.roles[0].gauge.surface.foot(original).normal;
    let normal = direction.cross(&part).try_normalize(1e-6)?;
    // The plane must cut the line in which the two surfaces meet.
    let tangent = drive.cross(&part).try_normalize(1e-6)?;
    (normal.dot(&tangent).abs() > 1e-3).then(|| (normal, normal.dot(original)))
}

/// GO with TANTO for the third surface: from the position on drive and part surface, the check surface decides by its
/// contact there.
pub(super) fn tangent_start(work: &StartUp<'_>, start: &Vec3) -> Result<Vec3, MotionFailure> {
    let rest: Vec<Condition<'_>> = work
        .roles
        .iter()
        .filter(|r| !matches!(r.relation, Relation::TangentToDrive | Relation::TangentToPart))
        .map(|r| Condition::Clearance(&r.gauge, r.rest()))
        .collect();
    let mut tip = super::converge(work, &rest, start)?;
    let Some(check) = work.roles.iter().find(|r| matches!(r.name, RoleName::Check(_))) else {
        return Ok(tip);
    };
    // Fixed point: the tangency plane through the tool end's foot, normal to the common tangent direction.
    for _ in 0..TANGENCY_ITERATIONS {
        let posture = work.attitude.posture(&tip)?;
        let drive = posture.contact(&work.roles[0].gauge, &tip).gradient;
        let part = work.roles.get(1).map_or(posture.tool.axis, |r| posture.contact(&r.gauge, &tip).gradient);
        let tangent = drive.cross(&part).try_normalize(1e-9).ok_or(MotionFailure::TangentSurfaces { tip })?;
        let slope = |tip: &Vec3| -> Result<f64, MotionFailure> {
            Ok(work.attitude.posture(tip)?.contact(&check.gauge, tip).gradient.dot(&tangent))
        };
        let reach = 1e-4 * position::size(&work.tool, &tip);
        let (here, ahead) = (slope(&tip)?, slope(&(tip + tangent * reach))?);
        let rate = (ahead - here) / reach;
        if here.abs() <= 1e-12 {
            break;
        }
        if rate.abs() <= f64::MIN_POSITIVE {
            return Err(MotionFailure::NotTangent {
                check: 0,
                gap: posture.contact(&check.gauge, &tip).clearance,
            });
        }
        let moved = tip - tangent * (here / rate);
        let next = super::converge(work, &rest, &moved)?;
        let done = (next - tip).norm() <= 1e-13 * position::size(&work.tool, &tip);
        tip = next;
        if done {
            break;
        }
    }
    let gap = work.attitude.posture(&tip)?.contact(&check.gauge, &tip).clearance;
    if gap.abs() > check.band() + work.roles[0].band() {
        return Err(MotionFailure::NotTangent { check: 0, gap });
    }
    Ok(tip)
}

/// Bound of the iteration for tangency.
const TANGENCY_ITERATIONS: u32 = 30;
