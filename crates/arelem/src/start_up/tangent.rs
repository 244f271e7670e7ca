//! GO with TANTO for the third surface: the tool goes to where a motion along the first two surfaces would stop.

use apt_geometry::{
    Vec3,
    motion::{CheckSurface, DriveSide, PartSide, Relation, Turn},
};

use super::{StartUp, converge, directed};
use crate::{
    directed as motion,
    error::{MotionFailure, RoleName},
    position::{self, Condition},
    section2::{ANY_NUMBER_OF_POINTS, State},
    sequence::ToolPosition,
};

/// The motions begin this far behind the position on the first two surfaces, relative to the size of the coordinates, so that
/// a tangency at that position lies on their way.
const RUN_UP: f64 = 2e-3;
/// Two tangencies are equally far away if their distances differ by no more than this, relative to the size of the
/// coordinates, and are two if they are this far apart.
const SAME: f64 = 1e-6;
/// Sine between the normals of the first two surfaces below which there is no line of motion.
const TANGENT_SINE: f64 = 1e-6;

/// Where a motion stopped, and the side of the check surface on which it did.
struct Tangency {
    tip: Vec3,
    side: f64,
}

/// The tangency nearest to where the tool stands: from the position on the first two surfaces, motions both ways along them
/// come to it. The side of the check surface is noted with its role.
pub(super) fn position(work: &mut StartUp<'_>, start: &Vec3) -> Result<Vec3, MotionFailure> {
    let begin = first_two(work, start)?;
    let tangent = along(work, &begin)?;
    let size = position::size(&work.tool, &begin);
    let mut found: Vec<Tangency> = Vec::new();
    let mut failures = Vec::new();
    for way in [tangent, -tangent] {
        if work.patience.is_over() {
            return Err(MotionFailure::Cancelled);
        }
        match ahead(work, &begin, &way, size) {
            Ok(tangency) => found.push(tangency),
            Err(MotionFailure::Cancelled) => return Err(MotionFailure::Cancelled),
            Err(failure) => failures.push(failure),
        }
    }
    let nearest = nearest(work, found, size)?.ok_or_else(|| likeliest(failures));
    let Tangency { tip, side } = nearest?;
    for role in work.roles.iter_mut().filter(|role| matches!(role.name, RoleName::Check(_))) {
        role.set_side(side);
    }
    Ok(tip)
}

/// The position on the first two surfaces.
fn first_two(work: &StartUp<'_>, start: &Vec3) -> Result<Vec3, MotionFailure> {
    let conditions: Vec<Condition<'_>> = work
        .roles
        .iter()
        .filter(|role| !motion::is_tangent(role.relation))
        .map(|role| Condition::Clearance(&role.gauge, role.rest()))
        .collect();
    converge(work, &conditions, start)
}

/// The common tangent of the first two surfaces.
fn along(work: &StartUp<'_>, tip: &Vec3) -> Result<Vec3, MotionFailure> {
    let posture = work.attitude.posture(tip)?;
    let normals = work.roles.iter().take(2).map(|role| posture.contact(&role.gauge, tip).gradient);
    let [drive, part] = normals.collect::<Vec<Vec3>>()[..] else {
        return Err(MotionFailure::SurfaceCount { found: work.roles.len() });
    };
    drive.cross(&part).try_normalize(TANGENT_SINE).ok_or(MotionFailure::TangentSurfaces { tip: *tip })
}

/// Where a motion one way along the first two surfaces stops. It begins a little behind, if there is room.
fn ahead(work: &StartUp<'_>, begin: &Vec3, way: &Vec3, size: f64) -> Result<Tangency, MotionFailure> {
    let behind = first_two(work, &(begin - way * (RUN_UP * size))).ok();
    let from = behind.filter(|place| (begin - place).dot(way) > 0.0).unwrap_or(*begin);
    let state = moving(work, &from, way)?;
    let [drive, _, check] = &work.roles[..] else {
        return Err(MotionFailure::SurfaceCount { found: work.roles.len() });
    };
    let check =
        CheckSurface { relation: check.relation, occurrence: 1, surface: check.named.clone(), label: None };
    let motion = motion::run(&state, Turn::Forward, &drive.named, &[check], &mut Vec::new(), work.patience)?;
    let end: Option<&ToolPosition> = motion.sequence.points.last();
    let (Some(end), Some(stop)) = (end, motion.sequence.stop) else {
        return Err(MotionFailure::NotTangent { check: 0, gap: f64::INFINITY });
    };
    Ok(Tangency { tip: end.tip, side: stop.role.side })
}

/// The modal state for a motion that begins on the first two surfaces, stands to them as they say and has as many positions as it
/// needs.
fn moving(work: &StartUp<'_>, from: &Vec3, way: &Vec3) -> Result<State, MotionFailure> {
    let [drive, part, _] = &work.roles[..] else {
        return Err(MotionFailure::SurfaceCount { found: work.roles.len() });
    };
    let axis = work.attitude.tool_at(from)?.axis;
    // From the surface to the tool, seen with the axis up.
    let contact = work.attitude.posture(from)?.contact(&drive.gauge, from);
    let to_the_left = way.cross(&contact.gradient).dot(&axis) > 0.0;
    Ok(State {
        tip: Some(*from),
        previous: *from,
        forward: Some(*way),
        axis,
        part: part.named.clone(),
        part_side: if part.relation == Relation::On { PartSide::On } else { PartSide::Offset },
        drive_side: match (drive.relation, to_the_left) {
            (Relation::On, _) => DriveSide::On,
            (_, true) => DriveSide::Left,
            (_, false) => DriveSide::Right,
        },
        maximum_points: ANY_NUMBER_OF_POINTS,
        gouge_check: false,
        ..work.state.clone()
    })
}

/// The nearest of the tangencies; of two that are equally near the one that a given direction leads to.
fn nearest(work: &StartUp<'_>, found: Vec<Tangency>, size: f64) -> Result<Option<Tangency>, MotionFailure> {
    let far = |tangency: &Tangency| (tangency.tip - work.tip).norm();
    let mut found = found.into_iter();
    let Some(first) = found.next() else { return Ok(None) };
    let Some(second) = found.next() else { return Ok(Some(first)) };
    let (near, apart) = (SAME * size, (first.tip - second.tip).norm());
    if apart <= near || (far(&first) - far(&second)).abs() > near {
        return Ok(Some(if far(&first) <= far(&second) { first } else { second }));
    }
    let direction = work.state.directions.iter().flatten().next();
    let direction = direction.map(|given| directed::unit_direction(given, &work.tip)).transpose()?;
    let ahead = direction.map_or(0.0, |direction| (first.tip - second.tip).dot(&direction));
    if ahead.abs() <= near {
        return Err(MotionFailure::StartUpAmbiguous { places: [first.tip, second.tip] });
    }
    Ok(Some(if ahead > 0.0 { first } else { second }))
}

/// Of the failures of both ways the one that says most: how near the surfaces come to being tangent.
fn likeliest(failures: Vec<MotionFailure>) -> MotionFailure {
    let gap = |failure: &MotionFailure| match failure {
        MotionFailure::NotTangent { gap, .. } => gap.abs(),
        MotionFailure::TangentLines { .. } => 0.0,
        _ => f64::INFINITY,
    };
    let least = failures.into_iter().min_by(|one, other| gap(one).total_cmp(&gap(other)));
    least.unwrap_or(MotionFailure::NotTangent { check: 0, gap: f64::INFINITY })
}
