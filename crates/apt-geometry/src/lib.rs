//! Canonical forms of APT geometry, the definitions that make them, the surfaces that the arithmetic element works
//! on, the cutter, and motion commands and copies of paths as plain data.
//!
//! Nothing here knows text: words arrive as [`definition::Modifier`] values, names never arrive at all.
//! Lengths are in the part program's unit, angles in radians unless a name says `degrees`.

pub mod canonical;
pub mod copy;
pub mod cutter;
pub mod definition;
pub mod motion;
pub mod parametric;
pub mod patience;
pub mod pieces;
pub mod regional;
pub mod surface;

/// A point or vector in part-program coordinates.
pub type Vec3 = nalgebra::Vector3<f64>;
