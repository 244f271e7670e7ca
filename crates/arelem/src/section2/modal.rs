//! What each command does to the state.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Plane},
    cutter::{Cutter, CutterError, Disk},
    motion::{Delta, Direction, MotionCommand, NamedSurface, PerRole, Relation, RoleDisk, ToolAxis},
    patience::Patience,
};

use super::{Output, State};
use crate::{
    directed::{self, Directed},
    error::{MotionFailure, MotionWarning},
    pocket, role,
    sequence::{CutSequence, ToolPosition},
    start_up,
};

/// Applies a command; `state` is only meaningful afterwards if the result is `Ok`.
pub(super) fn apply(
    state: &mut State,
    command: &MotionCommand,
    warnings: &mut Vec<MotionWarning>,
    patience: Patience<'_>,
) -> Result<Option<Output>, MotionFailure> {
    if state.skip(command) {
        return Ok(Some(Output::Ignored));
    }
    match command {
        MotionCommand::From { position, axis, .. } => {
            set_axis(state, *axis)?;
            finite(position)?;
            state.place(*position);
            state.side_of_part = None;
            Ok(position_output(state))
        }
        MotionCommand::GoTo { position, axis, .. } => {
            set_axis(state, *axis)?;
            finite(position)?;
            go_to(state, *position);
            Ok(position_output(state))
        }
        MotionCommand::GoDelta { delta, .. } => {
            let (increment, axis) = match delta {
                Delta::AlongAxis(length) => (state.axis * *length, None),
                Delta::Vector(increment, axis) => (*increment, *axis),
            };
            let tip = state.tip.ok_or(MotionFailure::NoPosition)? + increment;
            set_axis(state, axis)?;
            finite(&tip)?;
            go_to(state, tip);
            Ok(position_output(state))
        }
        MotionCommand::Direction(directions) => set_directions(state, directions).map(|()| None),
        MotionCommand::SurfaceVectors(vectors) => {
            for vector in vectors.iter().flatten() {
                unit(vector).ok_or(MotionFailure::ZeroDirection { number: 8 })?;
            }
            state.surface_vectors = *vectors;
            Ok(None)
        }
        MotionCommand::Start(surfaces) => {
            warnings.extend(start_up::twice::named(surfaces));
            let sequence = start_up::start(state, surfaces, patience)?;
            if let Some(part) = surfaces.get(1) {
                state.part = part.surface.clone();
            }
            Ok(Some(finish_start_up(state, sequence)))
        }
        MotionCommand::Offset(surfaces) => {
            warnings.extend(start_up::twice::named(surfaces));
            let sequence = start_up::offset(state, surfaces, patience)?;
            if let Some(part) = surfaces.get(1) {
                state.part = part.surface.clone();
            }
            Ok(Some(finish_start_up(state, sequence)))
        }
        MotionCommand::Drive { turn, drive, checks } => {
            let directed = directed::run(state, *turn, drive, checks, warnings, patience);
            let reached = directed.as_ref().map_or(&[][..], |directed| &directed.sequence.points);
            warnings.extend(role::deep_undercuts(state, reached, patience));
            let Directed { sequence, heading } = directed?;
            Ok(Some(finish(state, sequence, heading)))
        }
        MotionCommand::Pocket(pocket) => {
            let path = pocket::clear(state, pocket, patience)?;
            let ends: Vec<Vec3> = path.positions().rev().take(2).map(|position| position.tip).collect();
            if let Some(last) = ends.first() {
                state.move_to(ends.get(1).copied().unwrap_or(state.previous), *last);
                state.side_of_part = None;
            }
            Ok(Some(Output::Pocket(path)))
        }
        _ => set_modal(state, command, warnings).map(|()| None),
    }
}

fn set_modal(
    state: &mut State,
    command: &MotionCommand,
    warnings: &mut Vec<MotionWarning>,
) -> Result<(), MotionFailure> {
    match command {
        MotionCommand::DriveSide(side) => state.drive_side = *side,
        MotionCommand::PartSide(side) => state.part_side = *side,
        MotionCommand::PartSurface(surface) => {
            (state.part, state.side_of_part) = (surface.clone(), None);
        }
        MotionCommand::AutomaticPartSurface => automatic_part(state, warnings)?,
        MotionCommand::NoPartSurface => state.no_part = true,
        MotionCommand::Cutter(numbers) => {
            let (cutter, doubts) = Cutter::with_warnings(numbers, state.units)?;
            warnings.extend(doubts.into_iter().map(MotionWarning::Cutter));
            (state.cutter, state.undercut_told) = (Some(cutter), [false; 2]);
        }
        MotionCommand::Disk(disk) => {
            if let Some(RoleDisk { disk: Disk { radius, height }, .. }) = disk {
                scalar(*radius)?;
                scalar(*height)?;
                if *radius < 0.0 {
                    return Err(CutterError::Diameter { diameter: 2.0 * radius }.into());
                }
            }
            (state.disk, state.undercut_told) = (*disk, [false; 2]);
        }
        MotionCommand::InsideTolerance(values) => state.inside = tolerance(values, warnings)?,
        MotionCommand::OutsideTolerance(values) => state.outside = tolerance(values, warnings)?,
        MotionCommand::Thickness(values) => {
            for value in [values.part, values.drive, values.check[0], values.check[1]] {
                scalar(value)?;
            }
            (state.thickness, state.undercut_told) = (*values, [false; 2]);
        }
        MotionCommand::MaximumStep(length) => state.maximum_step = scalar(*length)?.abs(),
        MotionCommand::MaximumPoints(count) => state.maximum_points = *count,
        MotionCommand::ToolAxis(mode) => set_axis_mode(state, *mode)?,
        MotionCommand::MultipleAxes(mode) => match mode {
            None => {
                state.multiple_axes = true;
                state.multiple_axes_locked = true;
            }
            Some(on) if !state.multiple_axes_locked => state.multiple_axes = *on,
            Some(_) => {}
        },
        MotionCommand::GougeCheck(on) => state.gouge_check = *on,
        MotionCommand::ForceIteration(on) => state.force_iteration = *on,
        MotionCommand::Output(on) => state.output = *on,
        MotionCommand::From { .. }
        | MotionCommand::GoTo { .. }
        | MotionCommand::GoDelta { .. }
        | MotionCommand::Direction(_)
        | MotionCommand::SurfaceVectors(_)
        | MotionCommand::Start(_)
        | MotionCommand::Offset(_)
        | MotionCommand::Drive { .. }
        | MotionCommand::Pocket(_) => {}
    }
    Ok(())
}

fn position_output(state: &State) -> Option<Output> {
    state.position().map(Output::Position)
}

/// GOTO and GODLTA: the direction of the move becomes the forward direction.
fn go_to(state: &mut State, tip: Vec3) {
    let previous = state.tip.unwrap_or_else(Vec3::zeros);
    state.move_to(previous, tip);
    state.side_of_part = None;
}

/// Takes over the end of a computed motion, and where it leads if its last vector does not tell that.
fn finish(state: &mut State, sequence: CutSequence, heading: Option<Vec3>) -> Output {
    let count = sequence.points.len();
    if let Some(last) = sequence.points.last() {
        let before = if count >= 2 { sequence.points.get(count - 2) } else { None };
        let previous = heading.map_or(before.unwrap_or(&sequence.start).tip, |heading| last.tip - heading);
        state.axis = last.axis;
        state.move_to(previous, last.tip);
    }
    let offset_part = sequence.part.as_ref().filter(|role| role.relation != Relation::On);
    state.side_of_part = offset_part.filter(|role| role.surface == state.part).map(|role| role.side);
    state.directions = [None; 3];
    Output::Sequence(sequence)
}

/// The same for a start-up, which uses up what was said for it; NOPS and SRFVCT wait for one behind directed motion, too.
fn finish_start_up(state: &mut State, sequence: CutSequence) -> Output {
    let output = finish(state, sequence, None);
    state.clear_one_shot();
    output
}

/// INDIRV and INDIRP (classes 5000/1 and 5000/2): only the vector of the drive surface sets the direction.
fn set_directions(state: &mut State, directions: &[Option<Direction>; 3]) -> Result<(), MotionFailure> {
    for (index, direction) in directions.iter().enumerate() {
        let (vector, number) = match direction {
            None => continue,
            Some(Direction::Vector(vector)) => (*vector, 7),
            Some(Direction::Point(point)) => (point - state.tip.ok_or(MotionFailure::NoPosition)?, 6),
        };
        let forward = unit(&vector).ok_or(MotionFailure::ZeroDirection { number })?;
        if index == 0 {
            let tip = state.tip.ok_or(MotionFailure::NoPosition)?;
            let forward_only = tip - forward;
            state.move_to(forward_only, tip);
        }
    }
    state.directions = *directions;
    Ok(())
}

fn automatic_part(state: &mut State, warnings: &mut Vec<MotionWarning>) -> Result<(), MotionFailure> {
    let tip = state.tip.ok_or(MotionFailure::NoPosition)?;
    let tilt = state.axis.z.clamp(-1.0, 1.0).acos();
    if tilt > 1e-6 {
        warnings.push(MotionWarning::AutomaticPartWithTiltedAxis { tilt });
    }
    let plane = Plane { normal: Vec3::z(), distance: tip.z };
    state.part = NamedSurface { name: String::new(), geometry: Geometry::Plane(plane) };
    state.side_of_part = None;
    Ok(())
}

fn set_axis(state: &mut State, axis: Option<Vec3>) -> Result<(), MotionFailure> {
    if let Some(vector) = axis {
        set_axis_mode(state, ToolAxis::Fixed(vector))?;
    }
    Ok(())
}

fn set_axis_mode(state: &mut State, mode: ToolAxis) -> Result<(), MotionFailure> {
    state.axis_mode = match mode {
        ToolAxis::Fixed(vector) => {
            let axis = unit(&vector).ok_or(MotionFailure::ZeroAxis)?;
            state.axis = axis;
            ToolAxis::Fixed(axis)
        }
        ToolAxis::Keep => ToolAxis::Fixed(state.axis),
        other => other,
    };
    Ok(())
}

fn tolerance(values: &PerRole, warnings: &mut Vec<MotionWarning>) -> Result<PerRole, MotionFailure> {
    let mut check = |value: f64| -> Result<f64, MotionFailure> {
        scalar(value)?;
        if value < 0.0 {
            warnings.push(MotionWarning::NegativeTolerance { value });
        }
        Ok(value.max(0.0))
    };
    Ok(PerRole {
        part: check(values.part)?,
        drive: check(values.drive)?,
        check: [check(values.check[0])?, check(values.check[1])?],
    })
}

fn unit(vector: &Vec3) -> Option<Vec3> {
    if vector.iter().all(|x| x.is_finite()) { vector.try_normalize(0.0) } else { None }
}

fn scalar(value: f64) -> Result<f64, MotionFailure> {
    if value.is_finite() { Ok(value) } else { Err(MotionFailure::NotFinite) }
}

fn finite(point: &Vec3) -> Result<(), MotionFailure> {
    if point.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(MotionFailure::NotFinite) }
}

/// The position of a state that is known to have one.
pub(crate) fn required_position(state: &State) -> Result<ToolPosition, MotionFailure> {
    state.position().ok_or(MotionFailure::NoPosition)
}
