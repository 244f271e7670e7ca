//! The directed motion before the present one, for failures that lie in it: it stopped at another position of its check
//! surface than what follows takes for granted.

use apt_geometry::motion::MotionCommand;
use apt_program::record::Origin;
use arelem::{
    cure::{self, Remedy},
    error::MotionFailure,
    section2::{Execution, State},
};

/// Commands between two motions above which the one before is forgotten.
const MOST_BETWEEN: usize = 32;

/// A directed motion that was carried out, and what came since.
pub(super) struct Before {
    state: State,
    command: MotionCommand,
    pub(super) origin: Origin,
    between: Vec<MotionCommand>,
}

impl Before {
    /// The motion of a command that has just been carried out in a state.
    pub(super) fn new(state: State, command: &MotionCommand, origin: &Origin) -> Self {
        Self { state, command: command.clone(), origin: origin.clone(), between: Vec::new() }
    }

    /// With one more command that does not move the tool; nothing if there are too many.
    pub(super) fn and(mut self, command: &MotionCommand) -> Option<Self> {
        self.between.push(command.clone());
        (self.between.len() <= MOST_BETWEEN).then_some(self)
    }

    /// What in this motion would cure the failure of a later one.
    pub(super) fn remedy(
        &self,
        command: &MotionCommand,
        failure: &MotionFailure,
        carry_out: &mut dyn FnMut(&State, &MotionCommand) -> Option<Execution>,
    ) -> Option<Remedy> {
        let before = cure::Earlier { state: &self.state, command: &self.command, between: &self.between };
        cure::earlier(before, command, failure, carry_out)
    }
}
