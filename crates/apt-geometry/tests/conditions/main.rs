//! Every form of every definition against its defining conditions, over random figures: also nearly degenerate ones,
//! small and large ones and such that stand far from the origin; and against itself in another place and in another
//! unit.
//!
//! The number of cases comes from `PROPTEST_CASES` (256 without it); `cargo xtask nightly` runs ten thousand per form.

mod circles;
mod conics;
mod figure;
mod lines;
mod matrices;
mod patterns;
mod planes;
mod points;
mod rounds;
mod ruled;
mod tabulated;
mod vectors;
