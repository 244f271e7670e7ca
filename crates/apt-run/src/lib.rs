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

/// Asks whether the work should stop. Polled per statement, per record and per cut vector.
pub type Cancel<'a> = &'a (dyn Fn() -> bool + Sync);

/// The work was cancelled before it was complete.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;
