//! What would cure a failed motion: changes of the program, each found to work by carrying it out.
//!
//! Only the changes that the failure suggests are tried, a handful at most; what is offered is what succeeded, with the place
//! where the tool then ends.

mod attempt;
mod earlier;
#[cfg(test)]
mod tests;

use std::sync::atomic::{AtomicU32, Ordering};

use apt_geometry::{
    Vec3,
    motion::{CheckSurface, DriveSide, MotionCommand, PartSide, PerRole, Relation, Turn},
};

use self::attempt::Attempts;
pub use self::earlier::{Earlier, earlier};
use crate::{
    error::{Iteration, MotionFailure, RoleName},
    section2::State,
};

/// A change of the program. Lengths in program units.
#[derive(Debug, Clone, PartialEq)]
pub enum Cure {
    /// Another relation at a check surface.
    Relation {
        /// Index of the check surface in the command.
        check: usize,
        /// The relation to ask for.
        relation: Relation,
    },
    /// Another count before INTOF.
    Occurrence {
        /// Index of the check surface in the command.
        check: usize,
        /// The count to ask for.
        occurrence: u32,
    },
    /// Another count before INTOF in the directed motion before.
    EarlierOccurrence {
        /// Index of the check surface in that command.
        check: usize,
        /// The count to ask for.
        occurrence: u32,
    },
    /// Another motion word.
    Turn(Turn),
    /// Another word for the side of the drive surface.
    DriveSide(DriveSide),
    /// TLONPS in place of TLOFPS, or the reverse.
    PartSide(PartSide),
    /// INDIRV for the drive surface before the statement.
    Direction(Vec3),
    /// The start-up without INDIRV and INDIRP.
    WithoutDirection,
    /// SRFVCT before the statement.
    SurfaceVector {
        /// The surface whose side is not known.
        role: RoleName,
        /// From the TO side to the PAST side.
        vector: Vec3,
    },
    /// A wider tolerance.
    Tolerance {
        /// The surface that needs it.
        role: RoleName,
        /// INTOL if true, else OUTTOL.
        inside: bool,
        /// By how much it must be wider.
        by: f64,
        /// All values of the statement then.
        values: PerRole,
    },
    /// A move into tolerance before the statement, with the forward direction kept.
    MoveTo {
        /// Tool end.
        position: Vec3,
        /// How far it is.
        by: f64,
        /// Forward direction in force, if there is one.
        forward: Option<Vec3>,
    },
    /// More cut vectors allowed by NUMPTS.
    Points(u32),
}

/// A cure that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Remedy {
    /// What to change.
    pub cure: Cure,
    /// Where the tool ends with it.
    pub end: Vec3,
}

/// Most remedies offered for one failure.
const MOST: usize = 3;
/// A tolerance is not offered that is wider than the one in force by more than this factor.
const WIDEST: f64 = 20.0;
/// Factor by which NUMPTS is raised, and the greatest count that is tried.
const MORE_POINTS: u32 = 8;
const MOST_POINTS: u32 = 20_000;

/// How much may be spent on trying the cures of a failed motion: whoever made a mistake waits for them. It is counted in questions
/// whether to go on, so that what is offered does not depend on the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patience(u32);

/// What may be spent in any case, and how many times what the failed motion took more.
const LEAST_PATIENCE: u32 = 15_000;
const MORE_PATIENCE: u32 = 2;

impl Patience {
    /// For the cures of a motion that asked so often whether to go on before it failed.
    pub fn after(asked: u32) -> Self {
        Self(LEAST_PATIENCE.saturating_add(asked.saturating_mul(MORE_PATIENCE)))
    }

    /// What says true when `cancel` does, and once it has been asked too often.
    pub fn limit<C: Fn() -> bool + ?Sized>(self, cancel: &C) -> impl Fn() -> bool {
        let asked = AtomicU32::new(0);
        move || asked.fetch_add(1, Ordering::Relaxed) >= self.0 || cancel()
    }
}

/// The remedies for the failure of a command in a state, the likeliest first; empty where nothing that was tried helps. When
/// `cancel` says true, what has been found so far.
pub fn remedies(
    state: &State,
    command: &MotionCommand,
    failure: &MotionFailure,
    cancel: &dyn Fn() -> bool,
) -> Vec<Remedy> {
    let mut attempts = Attempts::new(state, command, cancel);
    if let (MotionFailure::StartUpAmbiguous { places }, MotionCommand::Start(_)) = (failure, command) {
        attempts.settle(places);
        return attempts.found;
    }
    for cure in candidates(state, command, failure) {
        if attempts.found.len() >= MOST || cancel() {
            break;
        }
        let is_count = |cure: &Cure| matches!(cure, Cure::Points(_));
        if is_count(&cure) && attempts.found.iter().any(|found| is_count(&found.cure)) {
            continue;
        }
        attempts.attempt(cure);
    }
    attempts.found
}

/// What the failure suggests.
fn candidates(state: &State, command: &MotionCommand, failure: &MotionFailure) -> Vec<Cure> {
    match (failure, command) {
        (
            MotionFailure::NeverMet { check, .. }
            | MotionFailure::NoneAhead { check, .. }
            | MotionFailure::TangentLines { check }
            | MotionFailure::ParallelThroughout { check },
            MotionCommand::Drive { turn, checks, .. },
        ) => stops(*check, *turn, checks.get(*check).map(|check| (check.relation, check.occurrence))),
        (MotionFailure::NotTangent { check, gap }, MotionCommand::Drive { turn, checks, .. }) => {
            let asked = checks.get(*check).map(|check| (check.relation, check.occurrence));
            touching(state, *check, *gap).into_iter().chain(stops(*check, *turn, asked)).collect()
        }
        (MotionFailure::NotTangent { check, gap }, MotionCommand::Start(_)) => {
            touching(state, *check, *gap).into_iter().collect()
        }
        (MotionFailure::TooManyPoints { limit, .. }, MotionCommand::Drive { turn, .. }) => {
            let more = limit.saturating_mul(MORE_POINTS).min(MOST_POINTS);
            let counts = [more, MOST_POINTS].into_iter().filter(|count| count > limit);
            counts.map(Cure::Points).chain([Cure::Turn(opposite(*turn))]).collect()
        }
        (MotionFailure::SurfaceEnds { .. }, MotionCommand::Drive { turn, .. }) => {
            vec![Cure::Turn(opposite(*turn))]
        }
        (MotionFailure::DirectionUndetermined { .. }, MotionCommand::Drive { turn, .. }) => {
            let turns = [Turn::Left, Turn::Right, Turn::Forward, Turn::Back, Turn::Up, Turn::Down];
            turns.into_iter().filter(|other| other != turn).map(Cure::Turn).collect()
        }
        (MotionFailure::NoForwardDirection, MotionCommand::Drive { turn, drive, .. }) => {
            attempt::tangent(state, drive).map_or_else(Vec::new, |tangent| {
                let forward = |sense: f64| attempt::before_turn(*turn, &(tangent * sense), &state.axis);
                [1.0, -1.0].into_iter().map(|sense| Cure::Direction(forward(sense))).collect()
            })
        }
        (MotionFailure::OutOfToleranceAtStart { .. }, MotionCommand::Drive { drive, .. }) => {
            start_of_cut(state, failure, attempt::within(state, drive))
        }
        (MotionFailure::NoAdmissibleVector { role, clearance, .. }, _) => {
            wider(state, *role, *clearance).into_iter().collect()
        }
        (
            MotionFailure::IterationLimit {
                iteration: Iteration::ThreeSurfaces | Iteration::FinalVector,
                ..
            },
            MotionCommand::Drive { checks, .. },
        ) => checks.iter().enumerate().flat_map(|(check, asked)| later(check, asked)).collect(),
        (MotionFailure::SideUnknown { role, .. }, MotionCommand::Start(_) | MotionCommand::Offset(_)) => {
            attempt::normals(state, command, *role)
                .into_iter()
                .map(|vector| Cure::SurfaceVector { role: *role, vector })
                .collect()
        }
        (
            MotionFailure::NotReachedAlong { .. }
            | MotionFailure::OffsetWithoutDirection
            | MotionFailure::StartUpDiverges { .. }
            | MotionFailure::BehindEnd { .. }
            | MotionFailure::NoPositionAlong { .. },
            MotionCommand::Start(_) | MotionCommand::Offset(_),
        ) => start_up(state, command),
        _ => Vec::new(),
    }
}

/// Another relation, another count, or the other way.
fn stops(check: usize, turn: Turn, asked: Option<(Relation, u32)>) -> Vec<Cure> {
    let Some((relation, occurrence)) = asked else { return Vec::new() };
    let others = match relation {
        Relation::To => [Relation::Past, Relation::On],
        Relation::Past => [Relation::To, Relation::On],
        Relation::On => [Relation::To, Relation::Past],
        Relation::TangentToDrive | Relation::TangentToPart => [Relation::To, Relation::On],
    };
    let fewer = (1..occurrence.min(4)).rev().map(|occurrence| Cure::Occurrence { check, occurrence });
    let others = others.into_iter().map(|relation| Cure::Relation { check, relation });
    fewer.chain([Cure::Turn(opposite(turn))]).chain(others).collect()
}

/// Where a position at a check surface cannot be taken: the next one, or the other side of it.
fn later(check: usize, asked: &CheckSurface) -> Vec<Cure> {
    let next = Cure::Occurrence { check, occurrence: asked.occurrence.max(1).saturating_add(1) };
    let other = match asked.relation {
        Relation::To => Some(Relation::Past),
        Relation::Past => Some(Relation::To),
        Relation::On | Relation::TangentToDrive | Relation::TangentToPart => None,
    };
    [next].into_iter().chain(other.map(|relation| Cure::Relation { check, relation })).collect()
}

/// The tool is out of tolerance where a cut begins.
fn start_of_cut(state: &State, failure: &MotionFailure, within: Option<Vec3>) -> Vec<Cure> {
    let MotionFailure::OutOfToleranceAtStart { role, clearance, .. } = failure else { return Vec::new() };
    let mut cures: Vec<Cure> = wider(state, *role, *clearance).into_iter().collect();
    match role {
        RoleName::Part => cures.push(Cure::PartSide(match state.part_side {
            PartSide::Offset => PartSide::On,
            PartSide::On => PartSide::Offset,
        })),
        _ => cures.extend(match state.drive_side {
            DriveSide::On => vec![Cure::DriveSide(DriveSide::Left), Cure::DriveSide(DriveSide::Right)],
            DriveSide::Left | DriveSide::Right => vec![Cure::DriveSide(DriveSide::On)],
        }),
    }
    if let (Some(position), Some(tip)) = (within, state.tip) {
        let forward = (tip - state.previous).try_normalize(0.0).or(state.forward);
        cures.push(Cure::MoveTo { position, by: (position - tip).norm(), forward });
    }
    cures
}

/// The tolerance that a clearance needs, unless that is out of all proportion.
fn wider(state: &State, role: RoleName, clearance: f64) -> Option<Cure> {
    let inside = clearance < 0.0;
    let needed = attempt::rounded_up(clearance.abs());
    let mut values = if inside { state.inside } else { state.outside };
    let slot = match role {
        RoleName::Part => &mut values.part,
        RoleName::Drive => &mut values.drive,
        RoleName::Check(index) => &mut values.check[index.min(1)],
    };
    let by = needed - *slot;
    let band = attempt::band(state, role);
    if by <= 0.0 || needed > WIDEST * band {
        return None;
    }
    *slot = needed;
    Some(Cure::Tolerance { role, inside, by, values })
}

/// The tolerance with which a tool touches a check surface that it misses where the path is parallel to it, also as the drive surface of the
/// motion that goes on along it.
fn touching(state: &State, check: usize, gap: f64) -> Option<Cure> {
    let mut cure = wider(state, RoleName::Check(check), gap)?;
    if let Cure::Tolerance { values, .. } = &mut cure {
        values.drive = values.drive.max(values.check[check.min(1)]);
    }
    Some(cure)
}

/// Towards the drive surface, or without a direction at all.
fn start_up(state: &State, command: &MotionCommand) -> Vec<Cure> {
    let towards = attempt::towards_drive(state, command).map(Cure::Direction);
    let given = state.directions.iter().any(Option::is_some);
    let without = (given && matches!(command, MotionCommand::Start(_))).then_some(Cure::WithoutDirection);
    towards.into_iter().chain(without).collect()
}

/// The motion word for the other way.
fn opposite(turn: Turn) -> Turn {
    match turn {
        Turn::Left => Turn::Right,
        Turn::Right => Turn::Left,
        Turn::Forward => Turn::Back,
        Turn::Back => Turn::Forward,
        Turn::Up => Turn::Down,
        Turn::Down => Turn::Up,
    }
}
