//! Cutter-location data: records, their writers and readers, and the transforms of Section 3.

pub mod record;
