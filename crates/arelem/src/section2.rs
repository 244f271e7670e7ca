//! The state machine of Section 2 (SECTN2): modal state, one command at a time, restart mode after a failure.

mod ends;
mod modal;
mod restart;
mod state;

use apt_geometry::{motion::MotionCommand, patience::Waiting};

pub(crate) use self::{modal::required_position, state::ANY_NUMBER_OF_POINTS};
pub use self::{
    restart::Restart,
    state::{StartUpRule, State},
};
use crate::{
    error::{MotionFailure, MotionWarning},
    sequence::{CutSequence, PocketPath, ToolPosition},
};

/// What a command made of the tool.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "one per statement; a box would only add a step")]
pub enum Output {
    /// FROM, GOTO, GODLTA: one position.
    Position(ToolPosition),
    /// GO, OFFSET and the directed motions.
    Sequence(CutSequence),
    /// POCKET.
    Pocket(PocketPath),
    /// Restart mode skipped the command.
    Ignored,
}

/// The result of one command.
#[derive(Debug, Clone, PartialEq)]
pub struct Execution {
    /// The modal state after it.
    pub state: State,
    /// The motion, if the command is one.
    pub output: Option<Output>,
    /// What is doubtful.
    pub warnings: Vec<MotionWarning>,
    /// Why it failed; the state is then in restart mode, if the dialect has it.
    pub failure: Option<MotionFailure>,
}

/// Carries out one command. A function of its arguments: nothing else is read, nothing is kept.
///
/// `cancel` is asked at least once per cut vector and iteration, and during long searches, until it says true; the failure is then
/// [`MotionFailure::Cancelled`] and the state is the one before.
pub fn execute(state: &State, command: &MotionCommand, cancel: &dyn Fn() -> bool) -> Execution {
    let mut next = state.clone();
    let mut warnings = Vec::new();
    let waiting = Waiting::until(cancel);
    let applied = modal::apply(&mut next, command, &mut warnings, waiting.patience());
    // What was found by searches that were given up is worth nothing.
    let applied = if waiting.has_given_up() { Err(MotionFailure::Cancelled) } else { applied };
    match applied {
        Ok(output) => Execution { state: next, output, warnings, failure: None },
        Err(MotionFailure::Cancelled) => Execution {
            state: state.clone(),
            output: None,
            warnings,
            failure: Some(MotionFailure::Cancelled),
        },
        Err(failure) => {
            warnings.extend(ends::beside(state, command, &failure));
            let mut failed = state.clone();
            failed.fail(command);
            Execution { state: failed, output: None, warnings, failure: Some(failure) }
        }
    }
}
