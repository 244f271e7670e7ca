//! Carrying out a command with a cure applied, and what the cures are made from. Numbers that the program will hold are
//! rounded as they are written before they are tried.

use apt_geometry::{
    Vec3,
    motion::{Direction, DriveSide, MotionCommand, NamedSurface, PartSide, Relation, StartSurface, Turn},
    patience::Patience,
};

use super::{Cure, MOST_POINTS, Remedy};
use crate::{
    attitude::Attitude,
    clearance::Tool,
    error::{MotionWarning, RoleName},
    position::{self, Condition},
    role::{self, Working},
    section2::{Output, State, execute},
};

/// Share of the way to one of several answers of a start-up from where it is the nearest one.
const NEARER: f64 = 1.0 / 32.0;
/// Share of the distance between two answers within which an end is one of them, wherever in the bands.
const SAME_ANSWER: f64 = 0.05;
/// Decimals of the coordinates that a cure writes.
const DECIMALS: f64 = 1e7;
/// Decimals of the components of a direction that a cure writes.
const DIRECTION_DECIMALS: f64 = 1e6;
/// Significant digits of a tolerance that a cure writes.
const TOLERANCE_DIGITS: i32 = 2;

/// A command that failed, and the remedies found so far.
pub(super) struct Attempts<'a> {
    state: &'a State,
    command: &'a MotionCommand,
    cancel: &'a dyn Fn() -> bool,
    pub(super) found: Vec<Remedy>,
}

impl<'a> Attempts<'a> {
    pub(super) fn new(state: &'a State, command: &'a MotionCommand, cancel: &'a dyn Fn() -> bool) -> Self {
        Self { state, command, cancel, found: Vec::new() }
    }

    /// Carries the command out with the cure; notes it if that works.
    pub(super) fn attempt(&mut self, cure: Cure) {
        let found = self.tried(cure);
        self.found.extend(found);
    }

    /// The cure, if the command can be carried out with it.
    fn tried(&self, cure: Cure) -> Option<Remedy> {
        let cure = written(cure);
        let (state, command) = applied(self.state, self.command, &cure)?;
        let execution = execute(&state, &command, self.cancel);
        if execution.failure.is_some() || !execution.warnings.iter().all(MotionWarning::is_of_the_given) {
            return None;
        }
        let Some(Output::Sequence(sequence)) = &execution.output else { return None };
        let end = sequence.points.last()?.tip;
        Some(Remedy { cure: enough(cure, sequence.points.len()), end })
    }

    /// Notes for each of the answers of a start-up what leads to it: the direction to it, that across the tool axis, or a beginning nearer
    /// to it. A direction may lead elsewhere, for along it the tool is to meet the drive surface first.
    pub(super) fn settle(&mut self, places: &[Vec3; 2]) {
        let Some(tip) = self.state.tip else { return };
        let apart = (places[0] - places[1]).norm();
        for place in places {
            let way = place - tip;
            let across = way - self.state.axis * way.dot(&self.state.axis);
            let directions = [way, across].into_iter().filter_map(|way| way.try_normalize(0.0));
            let forward = way.try_normalize(0.0).or(self.state.forward);
            let nearer = Cure::MoveTo { position: tip + way * NEARER, by: way.norm() * NEARER, forward };
            let settled = directions.map(Cure::Direction).chain([nearer]).find_map(|cure| {
                self.tried(cure).filter(|remedy| (remedy.end - place).norm() <= SAME_ANSWER * apart)
            });
            self.found.extend(settled);
        }
    }
}

/// The numbers of a cure as the program will hold them.
fn written(cure: Cure) -> Cure {
    let rounded = |v: Vec3, decimals: f64| v.map(|x| (x * decimals).round() / decimals + 0.0);
    match cure {
        Cure::Direction(vector) => Cure::Direction(rounded(vector, DIRECTION_DECIMALS)),
        Cure::SurfaceVector { role, vector } => {
            Cure::SurfaceVector { role, vector: rounded(vector, DIRECTION_DECIMALS) }
        }
        Cure::MoveTo { position, by, forward } => Cure::MoveTo {
            position: rounded(position, DECIMALS),
            by,
            forward: forward.map(|v| rounded(v, DIRECTION_DECIMALS)),
        },
        other => other,
    }
}

/// The cure with a count of cut vectors that is enough for so many, where it has been tried with the greatest one.
fn enough(cure: Cure, vectors: usize) -> Cure {
    match cure {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "a count"
        )]
        Cure::Points(MOST_POINTS) => Cure::Points(MOST_POINTS.min(rounded_up(vectors as f64) as u32)),
        other => other,
    }
}

/// The state and the command with a cure applied; nothing where it does not apply.
fn applied(state: &State, command: &MotionCommand, cure: &Cure) -> Option<(State, MotionCommand)> {
    let (mut state, mut command) = (state.clone(), command.clone());
    match cure {
        Cure::Relation { check, relation } => {
            let MotionCommand::Drive { checks, .. } = &mut command else { return None };
            checks.get_mut(*check)?.relation = *relation;
        }
        Cure::Occurrence { check, occurrence } => {
            let MotionCommand::Drive { checks, .. } = &mut command else { return None };
            checks.get_mut(*check)?.occurrence = *occurrence;
        }
        // It is tried with the motion before.
        Cure::EarlierOccurrence { .. } => return None,
        Cure::Turn(other) => {
            let MotionCommand::Drive { turn, .. } = &mut command else { return None };
            *turn = *other;
        }
        Cure::DriveSide(side) => state.drive_side = *side,
        Cure::PartSide(side) => state.part_side = *side,
        Cure::Direction(vector) => {
            state.directions = [Some(Direction::Vector(*vector)), None, None];
            state.previous = state.tip? - vector.try_normalize(0.0)?;
            state.is_placed = false;
        }
        Cure::WithoutDirection => state.directions = [None; 3],
        Cure::SurfaceVector { role, vector } => {
            let slot = match role {
                RoleName::Drive => 0,
                RoleName::Part => 1,
                RoleName::Check(_) => 2,
            };
            state.surface_vectors[slot] = Some(*vector);
        }
        Cure::Tolerance { inside: true, values, .. } => state.inside = *values,
        Cure::Tolerance { inside: false, values, .. } => state.outside = *values,
        Cure::MoveTo { position, forward, .. } => {
            state.previous = forward.map_or(state.previous, |forward| position - forward);
            state.is_placed &= forward.is_none();
            state.tip = Some(*position);
        }
        Cure::Points(count) => state.maximum_points = *count,
    }
    Some((state, command))
}

/// A length rounded up to a few digits.
pub(super) fn rounded_up(value: f64) -> f64 {
    if value <= 0.0 || !value.is_finite() {
        return 0.0;
    }
    let unit = 10f64.powi(value.log10().floor() as i32 - (TOLERANCE_DIGITS - 1));
    (value / unit * (1.0 + 1e-6)).ceil() * unit
}

/// Width of a role's band.
pub(super) fn band(state: &State, role: RoleName) -> f64 {
    let pick = |values: &apt_geometry::motion::PerRole| match role {
        RoleName::Part => values.part,
        RoleName::Drive => values.drive,
        RoleName::Check(index) => values.check[index.min(1)],
    };
    pick(&state.inside) + pick(&state.outside)
}

/// Tool and roles of a directed motion, with the sides on which the tool stands.
fn roles(state: &State, drive: &NamedSurface) -> Option<(Tool<'static>, Vec3, Working, Working)> {
    let tip = state.tip?;
    let tool = Tool::new(state.cutter?, state.axis);
    let make = |name: RoleName, surface: &NamedSurface, on: bool| {
        let relation = if on { Relation::On } else { Relation::To };
        let mut working = Working::new(state, name, surface, relation, on, Patience::default()).ok()?;
        let observed = tool.observed(&working.gauge.surface, &tip);
        working.set_side(if observed < 0.0 { -1.0 } else { 1.0 });
        working.look_from(&tip);
        Some(working)
    };
    let part = make(RoleName::Part, &state.part, state.part_side == PartSide::On)?;
    let drive = make(RoleName::Drive, drive, state.drive_side == DriveSide::On)?;
    Some((tool, tip, part, drive))
}

/// Unit tangent of the path at the tool, either sense.
pub(super) fn tangent(state: &State, drive: &NamedSurface) -> Option<Vec3> {
    let (tool, tip, part, drive) = roles(state, drive)?;
    let normals = [&part, &drive].map(|role| role.gauge.contact(&tool, &tip).gradient);
    normals[0].cross(&normals[1]).try_normalize(1e-6)
}

/// The position nearest to the tool that keeps part and drive surface.
pub(super) fn within(state: &State, drive: &NamedSurface) -> Option<Vec3> {
    let (tool, tip, part, drive) = roles(state, drive)?;
    let conditions =
        [Condition::Clearance(&part.gauge, part.rest()), Condition::Clearance(&drive.gauge, drive.rest())];
    position::solve(&Attitude::fixed(tool), &conditions, &tip).ok().map(|solution| solution.tip)
}

/// The forward direction from which a motion word leads along a direction.
pub(super) fn before_turn(turn: Turn, along: &Vec3, axis: &Vec3) -> Vec3 {
    match turn {
        Turn::Forward | Turn::Up | Turn::Down => *along,
        Turn::Back => -along,
        Turn::Right => axis.cross(along),
        Turn::Left => along.cross(axis),
    }
}

/// The surface of a role in a start-up.
fn start_surface<'a>(
    state: &'a State,
    command: &'a MotionCommand,
    role: RoleName,
) -> Option<&'a NamedSurface> {
    let (MotionCommand::Start(surfaces) | MotionCommand::Offset(surfaces)) = command else { return None };
    let index = match role {
        RoleName::Drive => 0,
        RoleName::Part => 1,
        RoleName::Check(_) => 2,
    };
    let named = surfaces.get(index).map(|StartSurface { surface, .. }| surface);
    named.or((role == RoleName::Part).then_some(&state.part))
}

/// Both senses of the normal of a surface on which the tool stands; the one along the last move first.
pub(super) fn normals(state: &State, command: &MotionCommand, role: RoleName) -> Vec<Vec3> {
    let (Some(named), Some(tip)) = (start_surface(state, command, role), state.tip) else {
        return Vec::new();
    };
    let Ok(surface) = role::surface(role, named, Patience::default()) else { return Vec::new() };
    let normal = surface.foot(&tip).normal;
    let sense = if state.forward.is_some_and(|forward| forward.dot(&normal) < 0.0) { -1.0 } else { 1.0 };
    vec![normal * sense, normal * -sense]
}

/// From the tool to the nearest point of the drive surface.
pub(super) fn towards_drive(state: &State, command: &MotionCommand) -> Option<Vec3> {
    let named = start_surface(state, command, RoleName::Drive)?;
    let surface = role::surface(RoleName::Drive, named, Patience::default()).ok()?;
    let observer = Tool::new(state.cutter?, state.axis).observer(&state.tip?);
    (surface.foot(&observer).point - observer).try_normalize(0.0)
}
