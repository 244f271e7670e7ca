//! The cure that lies in the motion before: it ended at one position of its check surface, and what follows takes for granted
//! that it ended at a later one.

use apt_geometry::motion::MotionCommand;

use super::{Cure, Remedy};
use crate::{
    error::{MotionFailure, MotionWarning},
    section2::{Execution, Output, State},
};

/// The directed motion before a failed one.
#[derive(Debug, Clone, Copy)]
pub struct Earlier<'a> {
    /// The state before it.
    pub state: &'a State,
    /// The motion.
    pub command: &'a MotionCommand,
    /// The commands between it and the failed one; none of them moves the tool.
    pub between: &'a [MotionCommand],
}

/// The next count before INTOF in the motion before, if the failed motion succeeds with it; it ends where the remedy says.
/// `carry_out` executes a command in a state; `None` when cancelled.
pub fn earlier(
    before: Earlier<'_>,
    command: &MotionCommand,
    failure: &MotionFailure,
    carry_out: &mut dyn FnMut(&State, &MotionCommand) -> Option<Execution>,
) -> Option<Remedy> {
    let is_about_the_place = matches!(
        failure,
        MotionFailure::NeverMet { .. }
            | MotionFailure::NoneAhead { .. }
            | MotionFailure::NotTangent { .. }
            | MotionFailure::ParallelThroughout { .. }
            | MotionFailure::DirectionUndetermined { .. }
            | MotionFailure::OutOfToleranceAtStart { .. }
            | MotionFailure::NoAdmissibleVector { .. }
            | MotionFailure::NoProgress { .. }
            | MotionFailure::SurfaceEnds { .. }
            | MotionFailure::IterationLimit { .. }
    );
    let MotionCommand::Drive { .. } = command else { return None };
    if !is_about_the_place {
        return None;
    }
    let mut longer = before.command.clone();
    let MotionCommand::Drive { checks, .. } = &mut longer else { return None };
    // With several check surfaces the first that is met stops the tool; which of them was not meant is not known.
    let [check] = checks.as_mut_slice() else { return None };
    check.occurrence = check.occurrence.max(1).checked_add(1)?;
    let occurrence = check.occurrence;
    let mut execution = carry_out(before.state, &longer).filter(succeeded)?;
    for command in before.between {
        execution = carry_out(&execution.state, command).filter(|one| one.failure.is_none())?;
    }
    let last = carry_out(&execution.state, command).filter(succeeded)?;
    let Some(Output::Sequence(sequence)) = &last.output else { return None };
    let end = sequence.points.last()?.tip;
    Some(Remedy { cure: Cure::EarlierOccurrence { check: 0, occurrence }, end })
}

fn succeeded(execution: &Execution) -> bool {
    execution.failure.is_none()
        && execution.warnings.iter().all(MotionWarning::is_of_the_given)
        && matches!(execution.output, Some(Output::Sequence(_)))
}
