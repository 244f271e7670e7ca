//! Evaluation as a fold over statements: chunks with checkpoints, restart after an edit, reuse of what did not change.

mod chunk;
mod close;
mod converge;
mod patch;
mod program;
mod run;
mod shift;
mod unused;

pub use program::{Program, Statistics};
