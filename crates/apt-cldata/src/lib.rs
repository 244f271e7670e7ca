//! Cutter-location data: records, their writers and readers, and the transforms of Section 3.
//!
//! [`record`] is the one shape that everything above works with. [`text`] reads and writes APT CL text, [`cltape`]
//! the binary CLTAPE of APT III, [`edit`] executes TRACUT, INDEX and COPY, [`tilt`] VTLAXS
//! and WCORN, [`totals`] sums a path up, [`difference`] compares two, and [`conversion`] writes a file in another dialect.

mod arc;
pub mod cltape;
pub mod codes;
pub mod conversion;
mod corner;
pub mod difference;
pub mod edit;
pub mod geometry;
pub mod record;
pub mod text;
pub mod tilt;
pub mod totals;
