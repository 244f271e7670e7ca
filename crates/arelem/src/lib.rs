//! Section 2, the arithmetic element: motion commands to cut vectors, and evidence when it cannot.
//!
//! Deterministic and free of global state: [`execute`](section2::execute) is a function of the modal state and one
//! command. Sources: Galbiati & Trumpy 1970 (routines DDST … ARLM3), Trumpy 1970 (command level), re-derived.

mod attitude;
pub mod bound;
pub mod clearance;
pub mod cure;
mod directed;
pub mod error;
mod plane_curve;
pub mod pocket;
mod position;
mod role;
pub mod section2;
pub mod sequence;
mod start_up;
pub mod story;
pub mod verify;

#[cfg(test)]
mod tests;

pub use error::{MotionFailure, MotionWarning};
