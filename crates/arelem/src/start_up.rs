//! Start-up motions (STRTUP): GO with one to three surfaces, and OFFSET.

mod ambiguous;
mod around;
mod behind;
mod directed;
mod plane;
mod side;
mod tangent;
#[cfg(test)]
mod tests;
pub(crate) mod twice;

use std::cell::Cell;

use apt_geometry::{
    Vec3,
    motion::{DriveSide, PartSide, Relation, StartSurface, ToolAxis},
    patience::Patience,
    surface::{RootSelection, Surface},
};

use crate::{
    attitude::{Attitude, Law},
    clearance::{Shape, Tool},
    directed::is_tangent,
    error::{AxisFailure, MotionFailure, RoleName},
    position::{self, Condition, Unsolved},
    role::Working,
    section2::{StartUpRule, State, required_position},
    sequence::{CutSequence, Stop, ToolPosition},
    story::Route,
};

/// The roles of the surfaces that a start-up names, in their order.
const NAMES: [RoleName; 3] = [RoleName::Drive, RoleName::Part, RoleName::Check(0)];

/// What a start-up works with.
pub(crate) struct StartUp<'a> {
    pub(crate) state: &'a State,
    pub(crate) tool: Tool<'a>,
    /// How the axis follows the surfaces, once their sides are known.
    pub(crate) attitude: Attitude<'a>,
    pub(crate) tip: Vec3,
    /// Drive, part, check, as far as they take part.
    pub(crate) roles: Vec<Working>,
    /// Whether to give up.
    pub(crate) patience: Patience<'a>,
}

/// GO (class 7000/1).
pub(crate) fn start(
    state: &State,
    surfaces: &[StartSurface],
    patience: Patience<'_>,
) -> Result<CutSequence, MotionFailure> {
    if surfaces.is_empty() || surfaces.len() > 3 {
        return Err(MotionFailure::SurfaceCount { found: surfaces.len() });
    }
    if state.no_part && surfaces.len() > 1 {
        return Err(MotionFailure::NoPartWithSeveral { found: surfaces.len() });
    }
    if patience.is_over() {
        return Err(MotionFailure::Cancelled);
    }
    let mut work = StartUp::new(state, surfaces, patience)?;
    let closed = match state.start_up {
        StartUpRule::Apt3 => plane::solve(&mut work)?,
        StartUpRule::Apt4 => None,
    };
    let tip = match closed {
        Some(tip) => tip,
        None => in_space(&mut work).map_err(|failure| parallel(&work, failure))?,
    };
    work.sequence(tip)
}

/// Where no position is found because two of the surfaces are parallel planes: that.
fn parallel(work: &StartUp<'_>, failure: MotionFailure) -> MotionFailure {
    if !matches!(failure, MotionFailure::StartUpDiverges { .. }) {
        return failure;
    }
    let planes = || {
        work.roles.iter().filter_map(|role| match &role.gauge.surface {
            Surface::Plane(plane) => Some((role.name, plane)),
            _ => None,
        })
    };
    for (k, (one, first)) in planes().enumerate() {
        for (other, second) in planes().skip(k + 1) {
            if first.normal.cross(&second.normal).norm() <= PARALLEL_SINE {
                let sense = first.normal.dot(&second.normal).signum();
                let apart = (first.distance - sense * second.distance).abs();
                return MotionFailure::ParallelPlanes { roles: [one, other], apart };
            }
        }
    }
    failure
}

/// By which route a GO finds its position.
pub(crate) fn route(state: &State, surfaces: &[StartSurface]) -> Route {
    let closed = state.start_up == StartUpRule::Apt3
        && StartUp::new(state, surfaces, Patience::default()).is_ok_and(|work| plane::applies(&work));
    if closed { Route::ClosedForm } else { Route::Iteration }
}

/// OFFSET (class 7000/2): pierce the drive surface along the direction given, stand off along its normal, then move
/// along the tool axis to the part surface. Both relations hold where it ends: what the way along the axis spoils is put
/// right in the plane of normal and axis.
pub(crate) fn offset(
    state: &State,
    surfaces: &[StartSurface],
    patience: Patience<'_>,
) -> Result<CutSequence, MotionFailure> {
    if surfaces.is_empty() || surfaces.len() > 2 {
        return Err(MotionFailure::SurfaceCount { found: surfaces.len() });
    }
    if patience.is_over() {
        return Err(MotionFailure::Cancelled);
    }
    let mut work = StartUp::new(state, surfaces, patience)?;
    let Some(direction) = state.directions[0] else { return Err(MotionFailure::OffsetWithoutDirection) };
    let direction = directed::unit_direction(&direction, &work.tip)?;
    side::assign(&mut work, None)?;
    follow_surfaces(&mut work, &direction, None)?;
    let drive = &work.roles[0];
    let along =
        drive.gauge.surface.directed_distance(&work.tip, &direction, RootSelection::Ahead).map_err(|_| {
            MotionFailure::NotReachedAlong { role: RoleName::Drive, from: work.tip, direction }
        })?;
    let pierce = work.tip + direction * along;
    // The tool end goes from the pierce point along the normal until the relation holds.
    let rest = drive.rest();
    let normal = drive.gauge.surface.foot(&pierce).normal;
    let line = along_line(&work.attitude, drive, &pierce, &normal, rest)?;
    let mut tip = line;
    if let Some(part) = work.roles.get(1) {
        let axis = work.attitude.tool_at(&tip)?.axis;
        tip = along_line(&work.attitude, part, &tip, &axis, part.rest())
            .map_err(|_| MotionFailure::PartNotReached)?;
        // Along an axis that leans against the drive surface the way to the part surface leads off the former again.
        tip = settle(&work, guide_through(&pierce, &normal, &axis), &tip)?;
    }
    work.sequence(tip)
}

/// The plane through a place that holds two directions, unless they are one.
fn guide_through(place: &Vec3, one: &Vec3, other: &Vec3) -> Option<(Vec3, f64)> {
    let across = one.cross(other).try_normalize(PARALLEL_SINE)?;
    Some((across, across.dot(place)))
}

/// The position on a straight line where a clearance has a value.
fn along_line(
    attitude: &Attitude,
    role: &Working,
    from: &Vec3,
    direction: &Vec3,
    target: f64,
) -> Result<Vec3, MotionFailure> {
    let (u, v) = across(direction);
    let conditions = [
        Condition::Clearance(&role.gauge, target),
        Condition::Plane(u, u.dot(from)),
        Condition::Plane(v, v.dot(from)),
    ];
    position::solve(attitude, &conditions, from).map(|s| s.tip).map_err(|unsolved| {
        MotionFailure::StartUpDiverges {
            residual: unsolved.residual,
            role: role.name,
            tip: unsolved.tip,
            iterations: unsolved.iterations,
        }
    })
}

/// Two unit vectors that make a frame with a direction.
pub(crate) fn across(direction: &Vec3) -> (Vec3, Vec3) {
    let u = apt_geometry::surface::perpendicular(direction);
    let v = direction.cross(&u).try_normalize(0.0).unwrap_or(u);
    (u, v)
}

impl<'a> StartUp<'a> {
    fn new(
        state: &'a State,
        surfaces: &[StartSurface],
        patience: Patience<'a>,
    ) -> Result<Self, MotionFailure> {
        let cutter = state.cutter.ok_or(MotionFailure::NoCutter { start_up: true })?;
        let ToolPosition { tip, axis } = required_position(state)?;
        let mut roles = Vec::with_capacity(3);
        for (start, name) in surfaces.iter().zip(NAMES) {
            let stands_as = match start.relation {
                Relation::TangentToDrive => surfaces.first(),
                Relation::TangentToPart => surfaces.get(1),
                _ => Some(start),
            };
            let on = stands_as.is_some_and(|surface| surface.relation == Relation::On);
            roles.push(Working::new(state, name, &start.surface, start.relation, on, patience)?.at_start());
        }
        if roles.len() == 1 && !state.no_part {
            let on = state.part_side == PartSide::On;
            let relation = if on { Relation::On } else { Relation::To };
            roles.push(Working::new(state, RoleName::Part, &state.part, relation, on, patience)?);
        }
        let tool = Tool::awaited(cutter, axis, patience);
        let attitude = Attitude::fixed(tool.clone());
        Ok(Self { state, tool, attitude, tip, roles, patience })
    }

    fn sequence(&self, tip: Vec3) -> Result<CutSequence, MotionFailure> {
        if let Some(failure) = behind::failure(self, &tip) {
            return Err(failure);
        }
        let axis = self.attitude.tool_at(&tip)?.axis;
        let role = |name: RoleName| self.roles.iter().find(|r| r.name == name).map(Working::role);
        Ok(CutSequence {
            start: ToolPosition { tip: self.tip, axis: self.tool.axis },
            points: vec![ToolPosition { tip, axis }],
            cutter: self.tool.cutter,
            part: role(RoleName::Part),
            drive: role(RoleName::Drive),
            stop: role(RoleName::Check(0)).map(|role| Stop { role, occurrence: 1, index: 0 }),
            drive_side: self.state.drive_side,
            start_up: true,
            forward: Vec3::zeros(),
            maximum_step: self.state.maximum_step,
            minimum: Some(1),
        })
    }
}

/// The general route: interim moves along the directions given, sides, then the shortest way to the position.
fn in_space(work: &mut StartUp<'_>) -> Result<Vec3, MotionFailure> {
    let original = work.tip;
    if let Some(direction) = directed::only_direction(work)? {
        side::assign(work, None)?;
        follow_surfaces(work, &direction, None)?;
        return directed::along(work, &direction);
    }
    let start = directed::interim(work)?;
    side::assign(work, Some(start))?;
    let guide = directed::guide(work, &original, &start);
    if work.roles.iter().any(|role| is_tangent(role.relation)) {
        follow_surfaces(work, &(start - original), None)?;
        return tangent::position(work, &start);
    }
    let mut tip = if is_following(work) {
        settle_following(work, guide, (&original, &start))?
    } else {
        settle(work, guide, &start)?
    };
    // How a surface without definite shape bends is known for sure only at the contact.
    let leans: Vec<bool> = work.roles.iter().map(|r| r.lean > 0.0).collect();
    work.roles.iter_mut().for_each(|r| r.look_from(&tip));
    if work.roles.iter().zip(&leans).any(|(r, before)| (r.lean > 0.0) != *before) {
        tip = settle(work, guide, &tip)?;
    }
    let directed = work.state.directions.iter().any(Option::is_some);
    if !directed && work.roles.len() == 1 {
        tip = ambiguous::nearest_of_all(work, tip);
    }
    let other = if directed { None } else { ambiguous::twin(work, &tip) };
    match other {
        Some(other) => Err(MotionFailure::StartUpAmbiguous { places: [tip, other] }),
        None => Ok(tip),
    }
}

fn is_following(work: &StartUp<'_>) -> bool {
    !matches!(work.state.axis_mode, ToolAxis::Fixed(_) | ToolAxis::Keep)
}

/// The position of a tool whose axis follows the surfaces. How it does is judged where the move with the present axis ends, and again
/// where the move ends that comes of it: the next motion will judge it there.
fn settle_following(
    work: &mut StartUp<'_>,
    guide: Option<(Vec3, f64)>,
    (original, start): (&Vec3, &Vec3),
) -> Result<Vec3, MotionFailure> {
    // Without a position with the present axis there is but the one place to set out from.
    let reached = settle(work, guide, start).ok();
    let first = reached.unwrap_or(*start);
    follow_surfaces(work, &(first - original), Some(first))?;
    let from_start =
        |work: &StartUp<'_>, failure| reached.map_or(Err(failure), |_| settle(work, guide, start));
    let nearest = match settle(work, guide, &first).or_else(|failure| from_start(work, failure)) {
        Ok(nearest) => nearest,
        Err(failure) => {
            let starts: Vec<Vec3> = reached.into_iter().chain([*start]).collect();
            return tilted_otherwise(work, guide, (original, &starts), failure);
        }
    };
    let mut tip = nearest;
    for _ in 0..JUDGEMENTS {
        match is_judged_alike(work, original, &tip) {
            Ok(true) => return Ok(tip),
            Ok(false) => {}
            Err(_) => break,
        }
        let Ok(next) = settle(work, guide, &tip) else { break };
        tip = next;
    }
    // Each place asks for the other one, or nothing is told there.
    follow_surfaces(work, &(first - original), Some(first))?;
    Ok(nearest)
}

/// Where no position is found with the axis tilted as it is judged where the tool would come to stand with its present one: one with the axis tilted to the
/// other side, of which one is taken first that is judged to be that there. The next motion turns the tool where it is judged otherwise.
fn tilted_otherwise(
    work: &mut StartUp<'_>,
    guide: Option<(Vec3, f64)>,
    (original, starts): (&Vec3, &[Vec3]),
    failure: MotionFailure,
) -> Result<Vec3, MotionFailure> {
    let judged = work.attitude.clone();
    let is_told = matches!(failure, MotionFailure::StartUpDiverges { .. } | MotionFailure::BehindEnd { .. });
    let Some(other) = judged.to_other_side().filter(|_| is_told) else { return Err(failure) };
    let mut contrary = None;
    for start in starts {
        work.attitude = other.clone();
        match settle(work, guide, start) {
            Err(MotionFailure::Cancelled) => return Err(MotionFailure::Cancelled),
            Ok(tip) if is_judged_alike(work, original, &tip) == Ok(true) => return Ok(tip),
            Ok(tip) => contrary = contrary.or(Some(tip)),
            Err(_) => {}
        }
    }
    if let Some(tip) = contrary {
        work.attitude = other;
        return Ok(tip);
    }
    work.attitude = judged;
    Err(failure)
}

/// Judges how the axis follows the surfaces at a place where a move ends; whether it is there as it was.
fn is_judged_alike(work: &mut StartUp<'_>, original: &Vec3, tip: &Vec3) -> Result<bool, MotionFailure> {
    let before = work.attitude.tool_at(tip)?.axis;
    follow_surfaces(work, &(tip - original), Some(*tip))?;
    Ok((work.attitude.tool_at(tip)?.axis - before).norm() <= SAME_AXIS)
}

/// Lets the axis follow the surfaces, whose sides are known, for a move `ahead`. A part surface that takes no part in the
/// start-up (NOPS) still guides the axis.
///
/// How the axis tilts is judged at the place where the move ends, if that is known, as the next motion will judge it.
fn follow_surfaces(work: &mut StartUp<'_>, ahead: &Vec3, place: Option<Vec3>) -> Result<(), MotionFailure> {
    if !is_following(work) {
        return Ok(());
    }
    let (state, tip) = (work.state, work.tip);
    let mut modal = Working::new(state, RoleName::Part, &state.part, Relation::To, false, work.patience)?;
    let observed = work.tool.observed(&modal.gauge.surface, &tip);
    modal.set_side(if observed < 0.0 { -1.0 } else { 1.0 });
    let find = |name: RoleName| work.roles.iter().find(|r| r.name == name);
    let part = find(RoleName::Part).unwrap_or(&modal);
    let tip = place.unwrap_or(tip);
    let drive = find(RoleName::Drive);
    let towards = |ahead: &Vec3| Law::new(&state.axis_mode, Some(part), drive, (&work.tool, &tip, ahead));
    let law = match (towards(ahead), drive) {
        (Err(AxisFailure::SignUnresolved), Some(drive)) => {
            towards(&ahead_by_side(state.drive_side, (part, drive), &tip))
        }
        (law, _) => law,
    };
    let law = law.map_err(|cause| MotionFailure::AxisUndetermined { cause, tip })?;
    if let Some(law) = law {
        work.attitude = Attitude::following(&work.tool, law);
    }
    Ok(())
}

/// Where the next motion leads as far as TLLFT and TLRGT tell, for a start-up that goes straight at both surfaces and so in no
/// direction along them. With TLON the natural normal of the drive surface points to the right.
fn ahead_by_side(side: DriveSide, (part, drive): (&Working, &Working), tip: &Vec3) -> Vec3 {
    let outward = |role: &Working| role.gauge.surface.foot(tip).normal * role.gauge.side;
    let right = match side {
        DriveSide::On => drive.gauge.surface.foot(tip).normal,
        DriveSide::Right => outward(drive),
        DriveSide::Left => -outward(drive),
    };
    outward(part).cross(&right)
}

/// The position where every relation holds, in the guide plane if there is one; where there is no position in it, by the
/// shortest way.
fn settle(work: &StartUp<'_>, guide: Option<(Vec3, f64)>, start: &Vec3) -> Result<Vec3, MotionFailure> {
    let free: Vec<Condition<'_>> =
        work.roles.iter().map(|r| Condition::Clearance(&r.gauge, r.rest())).collect();
    let Some(guide) = guide else {
        return converge(work, &free, start).or_else(|f| in_bands(work, start, f));
    };
    let mut guided = free.clone();
    guided.push(Condition::Plane(guide.0, guide.1));
    match converge(work, &guided, start) {
        Err(MotionFailure::StartUpDiverges { .. } | MotionFailure::BehindEnd { .. }) => {
            let start = match work.state.start_up {
                StartUpRule::Apt3 => *start,
                StartUpRule::Apt4 => directed::searched(work, guide, start),
            };
            converge(work, &free, &start).or_else(|f| in_bands(work, &start, f))
        }
        found => found,
    }
}

/// Where no position has every clearance in the place that ends of motions have in their bands: one in all of the bands, near
/// where the search for the former came to its end, or from the start. A tool that just fits between walls has no other. On planes it is exactly where it is
/// asked for, unless there is none but in their bands, too: a tool whose axis the surfaces tell may not come as near to a plane with any place of its own.
fn in_bands(work: &StartUp<'_>, start: &Vec3, failure: MotionFailure) -> Result<Vec3, MotionFailure> {
    let MotionFailure::StartUpDiverges { tip: nearest, .. } = failure else { return Err(failure) };
    let within = |room: fn(&Working) -> [f64; 2]| -> Option<Vec3> {
        let bands: Vec<Condition<'_>> =
            work.roles.iter().map(|role| Condition::Between(&role.gauge, room(role))).collect();
        let found = |from: &Vec3| position::solve(&work.attitude, &bands, from).ok();
        [nearest, *start].iter().find_map(found).map(|solution| solution.tip)
    };
    within(Working::room).or_else(|| within(Working::whole_room)).ok_or(failure)
}

/// Newton from the start; if that fails, a homotopy that lets the tool approach every surface from its own side; if that
/// fails too, Newton from places all about the start. A position behind the end of a surface is none: others are looked for.
pub(crate) fn converge(
    work: &StartUp<'_>,
    conditions: &[Condition<'_>],
    start: &Vec3,
) -> Result<Vec3, MotionFailure> {
    let is_behind: Cell<Option<MotionFailure>> = Cell::new(None);
    let stands = |tip: &Vec3| {
        let failure = behind::failure(work, tip);
        let stands = failure.is_none();
        is_behind.set(is_behind.take().or(failure));
        stands
    };
    let taken = |tip: Vec3| {
        if stands(&tip) { Ok(tip) } else { Err(Unsolved { residual: 0.0, row: 0, tip, iterations: 0 }) }
    };
    let first = match position::solve(&work.attitude, conditions, start).and_then(|found| taken(found.tip)) {
        Ok(tip) => return Ok(tip),
        Err(unsolved) => unsolved,
    };
    let mut begin = Vec::with_capacity(conditions.len());
    for condition in conditions {
        begin.push(match condition {
            Condition::Clearance(gauge, _) | Condition::Passing(gauge, _) | Condition::Between(gauge, _) => {
                work.attitude.posture(start)?.contact(gauge, start).clearance
            }
            Condition::Plane(normal, _) => normal.dot(start),
        });
    }
    let last = match staged(work, conditions, &begin, start).and_then(taken) {
        Ok(tip) => return Ok(tip),
        Err(unsolved) => unsolved,
    };
    if let Some(tip) = around::solve(&work.attitude, conditions, start, &stands, work.patience)? {
        return Ok(tip);
    }
    let nearest = if first.residual < last.residual { first } else { last };
    Err(is_behind.take().unwrap_or(MotionFailure::StartUpDiverges {
        residual: nearest.residual,
        role: work.roles.get(nearest.row).map_or(RoleName::Drive, |r| r.name),
        tip: nearest.tip,
        iterations: first.iterations + last.iterations,
    }))
}

/// The homotopy: the values that the conditions have at the start go over to those wanted by stages. Nothing is proven
/// on the way.
fn staged(
    work: &StartUp<'_>,
    conditions: &[Condition<'_>],
    begin: &[f64],
    start: &Vec3,
) -> Result<Vec3, Unsolved> {
    let mut tip = *start;
    for step in 1..HOMOTOPY_STEPS {
        let share = f64::from(step) / f64::from(HOMOTOPY_STEPS);
        let stage: Vec<Condition<'_>> = conditions
            .iter()
            .zip(begin)
            .map(|(condition, from)| match condition {
                Condition::Clearance(gauge, to) | Condition::Passing(gauge, to) => {
                    Condition::Passing(gauge, from + (to - from) * share)
                }
                Condition::Plane(normal, to) => Condition::Plane(*normal, from + (to - from) * share),
                Condition::Between(..) => *condition,
            })
            .collect();
        tip = match position::solve(&work.attitude, &stage, &tip) {
            Ok(solution) => solution.tip,
            Err(unsolved) => unsolved.tip,
        };
    }
    position::solve(&work.attitude, conditions, &tip).map(|solution| solution.tip)
}

/// Sine between the normals of two planes below which they are parallel.
const PARALLEL_SINE: f64 = 1e-6;
/// How often the law of the axis is judged anew where the move ends.
const JUDGEMENTS: u32 = 3;
/// Difference of unit vectors below which an axis is the same.
const SAME_AXIS: f64 = 1e-7;
/// Stages of the homotopy.
const HOMOTOPY_STEPS: u32 = 24;

/// True for a surface whose clearance is linear.
pub(crate) fn is_plane(role: &Working) -> bool {
    role.shape == Shape::Flat && matches!(role.gauge.surface, Surface::Plane(_))
}
