//! Section 0, the traffic control: runs Sections 1 to 4 over a part program, with cancellation, a memo of motions, one
//! catalogue of diagnostics and the report that the command line and the editors share.
//!
//! Nothing here knows a protocol or prints.

pub mod allow;
mod basis;
pub mod catalogue;
pub mod diagnostic;
pub mod document;
mod fix;
pub mod format;
mod include;
pub mod lint;
pub mod memo;
pub mod pipeline;
pub mod position;
pub mod report;
pub mod settings;

pub use apt_geometry::patience::{Patience, Waiting};

/// Asks whether the work should stop. Polled per statement, per record and per cut vector.
pub type Cancel<'a> = &'a (dyn Fn() -> bool + Sync);

/// The work was cancelled before it was complete.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// Counts work and asks once in so much of it; a unit is a statement, a record, a name or a finding. Less work than that
/// asks nothing: it is done before an answer would matter.
///
/// # Errors
///
/// [`Cancelled`] when the work is to be given up.
pub fn go_on(patience: Patience<'_>, work: usize) -> Result<(), Cancelled> {
    match patience.ends_after(u32::try_from(work).unwrap_or(u32::MAX)) {
        true => Err(Cancelled),
        false => Ok(()),
    }
}
