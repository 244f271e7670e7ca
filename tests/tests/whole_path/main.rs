//! From text to tape: what holds for the paths of all programs.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

mod contours;
mod cutters;
mod economy;
#[allow(dead_code, unused_imports, reason = "the tests of the post-processor use all of it")]
#[path = "../../../crates/apt-post/tests/interpreter/mod.rs"]
mod interpreter;
mod invariance;
mod labels;
mod sculptured;
mod tapes;
mod verified;
