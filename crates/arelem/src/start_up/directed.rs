//! Start-up guided by INDIRV and INDIRP: interim moves that bring the tool near the wanted side and branch.

use apt_geometry::{
    Vec3,
    motion::{Direction, Relation},
    surface::RootSelection,
};

use super::{StartUp, is_plane};
use crate::{
    clearance::Shape,
    error::{MotionFailure, RoleName},
    position::{self, Condition},
    role::Working,
    section2::StartUpRule,
};

/// When all surfaces are planes only this share of the interim move is made.
const ALL_PLANES_SHARE: f64 = 0.75;
/// Share of the band, from the limit that the sag goes to, at which APT places the tool at curved surfaces.
const AIM: f64 = 0.9;
/// Corrections that the iteration of APT4 makes before it gives up.
const APT4_CORRECTIONS: u32 = 26;
/// |cos| between the normals of two surfaces up to which APT4 takes them as square and uses the guide plane.
const SQUARE: f64 = 1e-4;
/// Bound of the steps along a direction.
const MAX_STEPS: u32 = 4000;
/// Share of the band at which the steps along a direction have arrived.
const LEAST_STEP_SHARE: f64 = 0.02;
/// How far along a direction a surface is looked for, relative to the size of the coordinates.
const FARTHEST: f64 = 1e5;
/// Sine below which two directions are parallel.
const LEAST_SINE: f64 = 1e-6;
/// |cos| between the guide plane and a given plane above which they are the same plane.
const LEAST_ANGLE_COSINE: f64 = 0.9999;

/// Unit vector of a direction seen from a position.
pub(super) fn unit_direction(direction: &Direction, tip: &Vec3) -> Result<Vec3, MotionFailure> {
    let (vector, number) = match direction {
        Direction::Vector(vector) => (*vector, 7),
        Direction::Point(point) => (point - tip, 6),
    };
    vector.try_normalize(0.0).ok_or(MotionFailure::ZeroDirection { number })
}

/// The direction given for a role, if there is one.
fn given<'a>(work: &StartUp<'a>, name: RoleName) -> Option<&'a Direction> {
    work.state.directions[match name {
        RoleName::Drive => 0,
        RoleName::Part => 1,
        RoleName::Check(_) => 2,
    }]
    .as_ref()
}

/// The tool end after one hidden move per direction, in the order drive, part, check. From the observer the ray is
/// shot at the surface; the tool moves up to it, less its radius unless it shall end ON the surface. A ray that misses
/// moves the tool by the greatest distance from the surfaces.
pub(super) fn interim(work: &StartUp<'_>) -> Result<Vec3, MotionFailure> {
    let mut tip = work.tip;
    let all_planes = work.roles.len() == 3 && work.roles.iter().all(is_plane);
    let apt4 = work.state.start_up == StartUpRule::Apt4;
    for name in [RoleName::Drive, RoleName::Part, RoleName::Check(0)] {
        let Some(direction) = given(work, name) else { continue };
        let Some(role) = work.roles.iter().find(|r| r.name == name) else { continue };
        let direction = unit_direction(direction, &work.tip)?;
        tip += match reach(work, role, &tip, &direction) {
            Some(distance) => {
                let distance = if apt4 { nearer(work, role, &tip, &direction, distance) } else { distance };
                let share = if all_planes { ALL_PLANES_SHARE } else { 1.0 };
                direction * (share * (distance - role.band()))
            }
            None if apt4 => {
                let distance = greatest_distance(work, role, &tip);
                direction * (nearer(work, role, &tip, &direction, distance) - role.band())
            }
            None => direction * greatest_undirected(work),
        };
    }
    Ok(tip)
}

/// Where the ray begins: half way up the tool, THICK ahead.
fn observer(work: &StartUp<'_>, role: &Working, tip: &Vec3, direction: &Vec3) -> Vec3 {
    work.tool.observer(tip) + direction * role.gauge.thickness
}

/// How far the tool may go along a direction until it is at the surface, if the ray meets it.
fn reach(work: &StartUp<'_>, role: &Working, tip: &Vec3, direction: &Vec3) -> Option<f64> {
    let from = observer(work, role, tip, direction);
    let hit = role.gauge.surface.directed_distance(&from, direction, RootSelection::Ahead).ok()?;
    let radius = if role.relation == Relation::On { 0.0 } else { work.tool.cutter.radius() };
    Some(hit - radius)
}

/// The move of APT4 ends at the first of the other surfaces that is ahead.
fn nearer(work: &StartUp<'_>, role: &Working, tip: &Vec3, direction: &Vec3, distance: f64) -> f64 {
    let others = work.roles.iter().filter(|other| other.name != role.name);
    let ahead = others.filter_map(|other| reach(work, other, tip, direction));
    ahead.filter(|reach| *reach > 1e-9 * position::size(&work.tool, tip)).fold(distance, f64::min)
}

/// Greatest distance from the surfaces without direction.
fn greatest_undirected(work: &StartUp<'_>) -> f64 {
    let undirected = work.roles.iter().filter(|role| given(work, role.name).is_none());
    undirected.map(|role| role.gauge.surface.signed_distance(&work.tip).abs()).fold(0.0, f64::max)
}

/// Greatest distance of the tool from its place at the surfaces without direction and at one with (APT4).
fn greatest_distance(work: &StartUp<'_>, missed: &Working, tip: &Vec3) -> f64 {
    let counted =
        work.roles.iter().filter(|role| role.name == missed.name || given(work, role.name).is_none());
    let distance = |role: &Working| {
        let mut role = role.clone();
        let observed = work.tool.observed(&role.gauge.surface, tip);
        role.set_side(if observed < 0.0 { -1.0 } else { 1.0 });
        (role.gauge.contact(&work.tool, tip).clearance - aim(&role)).abs()
    };
    counted.map(distance).fold(0.0, f64::max)
}

/// The place in the band that APT aims at.
fn aim(role: &Working) -> f64 {
    let share = match role.shape {
        Shape::Flat => return 0.0,
        Shape::Convex => AIM,
        Shape::Concave => 1.0 - AIM,
        Shape::General if role.lean < 0.0 => 1.0 - AIM,
        Shape::General => AIM,
    };
    share * role.band() - role.inside
}

/// The unit direction of the move if the one surface of the start-up must be met exactly along it.
pub(super) fn only_direction(work: &StartUp<'_>) -> Result<Option<Vec3>, MotionFailure> {
    match work.roles.as_slice() {
        [only] => given(work, only.name).map(|direction| unit_direction(direction, &work.tip)).transpose(),
        _ => Ok(None),
    }
}

/// The first position along a direction where the one surface has its relation. Clearance changes by no more than the
/// distance moved, so that steps of its own size cannot jump over a position.
pub(super) fn along(work: &StartUp<'_>, direction: &Vec3) -> Result<Vec3, MotionFailure> {
    let [role] = work.roles.as_slice() else {
        return Err(MotionFailure::SurfaceCount { found: work.roles.len() });
    };
    let from = work.tip;
    let missed = MotionFailure::NotReachedAlong { role: role.name, from, direction: *direction };
    let size = position::size(&work.tool, &from);
    let excess = |x: f64| -> Result<f64, MotionFailure> {
        let tip = from + direction * x;
        Ok(work.attitude.posture(&tip)?.contact(&role.gauge, &tip).clearance - role.rest())
    };
    let least = LEAST_STEP_SHARE * role.band().max(f64::MIN_POSITIVE);
    let (mut x, first) = (0.0, excess(0.0)?);
    let mut value = first;
    for _ in 0..MAX_STEPS {
        if (value > 0.0) != (first > 0.0) || value.abs() <= least {
            return super::along_line(&work.attitude, role, &(from + direction * x), direction, role.rest());
        }
        x += value.abs();
        if x > FARTHEST * size {
            break;
        }
        value = excess(x)?;
    }
    Err(missed)
}

/// The plane through the original position that keeps the move in the one direction given: the plane through the direction
/// that cuts the common tangent of the two surfaces most squarely. APT III uses it if both are planes, APT4 if one is
/// and the other stands square on it.
pub(super) fn guide(work: &StartUp<'_>, original: &Vec3, start: &Vec3) -> Option<(Vec3, f64)> {
    let mut directions = work.roles.iter().filter_map(|role| given(work, role.name));
    let (Some(direction), None) = (directions.next(), directions.next()) else { return None };
    let direction = unit_direction(direction, original).ok()?;
    let [drive, part] = work.roles.as_slice() else { return None };
    let normal = guide_plane(work, (drive, part), &direction, start)?;
    Some((normal, normal.dot(original)))
}

fn guide_plane(
    work: &StartUp<'_>,
    (drive, part): (&Working, &Working),
    direction: &Vec3,
    start: &Vec3,
) -> Option<Vec3> {
    let normals = [drive, part].map(|role| role.gauge.surface.foot(start).normal);
    let applies = match work.state.start_up {
        StartUpRule::Apt3 => is_plane(drive) && is_plane(part),
        StartUpRule::Apt4 => normals[0].dot(&normals[1]).abs() <= SQUARE,
    };
    if !applies {
        return None;
    }
    let tangent = normals[1].cross(&normals[0]).try_normalize(LEAST_SINE)?;
    let normal = (tangent - direction * direction.dot(&tangent)).try_normalize(LEAST_SINE)?;
    // One of the two is a plane, and not the guide plane itself.
    let fixed = [drive, part].into_iter().zip(normals).find(|(role, _)| is_plane(role))?.1;
    (normal.dot(&fixed).abs() <= LEAST_ANGLE_COSINE).then_some(normal)
}

/// Where APT4 leaves the tool when there is no position in the guide plane: its iteration makes this many corrections, each
/// in full, and the tool stays where the last one took it.
pub(super) fn searched(work: &StartUp<'_>, (normal, distance): (Vec3, f64), start: &Vec3) -> Vec3 {
    let mut conditions: Vec<Condition<'_>> =
        work.roles.iter().map(|r| Condition::Clearance(&r.gauge, aim(r))).collect();
    conditions.push(Condition::Plane(normal, distance));
    position::corrected(&work.attitude, &conditions, start, APT4_CORRECTIONS)
}
