//! The long run of the random tests, for the night: many more cases than the test command has time for.
//!
//! The random tests take their number of cases from the environment: `PROPTEST_CASES` per form of a definition,
//! `APT_CASES` for random motion of each pair of surfaces, `APT_SHARE` for the share of them that pairs with tabulated,
//! ruled and polyconic surfaces get. All counts are fixed beforehand, and a motion that does not end is given up by its
//! budget, so that the run ends: with the numbers of the night after about five hours of one core. Unless a seed is given the run draws new cases every time and
//! prints its seed, so that a red run can be repeated.

use std::time::{SystemTime, UNIX_EPOCH};

use crate::failure::Outcome;
use crate::whole::{Run, cargo};

/// Cases per form of a definition.
pub(crate) const DEFINITION_CASES: u32 = 10_000;
/// Random motions of each pair of surfaces.
pub(crate) const MOTION_CASES: u32 = 2_000;
/// Of the motions of pairs with tabulated, ruled or polyconic surfaces one in so many is run: they take as much longer.
pub(crate) const SHARE: u32 = 100;

/// How long the run is and what it draws.
#[derive(Debug, Clone)]
pub(crate) struct Extent {
    pub(crate) definition_cases: u32,
    pub(crate) motion_cases: u32,
    /// One motion in so many is run of pairs with tabulated, ruled or polyconic surfaces.
    pub(crate) share: u32,
    /// A part of the pairs of surfaces (`2/5`: the second of five); all of them if not given.
    pub(crate) pairs: Option<String>,
    /// Of the random numbers; none draws another one every time.
    pub(crate) seed: Option<u64>,
}

/// Runs the random tests of definitions and of motion with many cases, in the release profile.
pub(crate) fn run(extent: &Extent) -> Outcome {
    let seed = extent.seed.unwrap_or_else(seed_of_the_day);
    println!("seed {seed}; repeat with `cargo xtask nightly --seed {seed}`");
    let seed = seed.to_string();
    let mut run = Run::default();
    run.step("definitions", |count| {
        cargo(&["test", "--release", "--locked", "--package", "apt-geometry", "--test", "conditions"])
            .env("PROPTEST_RNG_SEED", &seed)
            .env("PROPTEST_CASES", extent.definition_cases.to_string())
            .run_counting(count)
    });
    run.step("random motion", |count| {
        // What tests print is shown even when they pass: the share of motions that were computed and proven.
        let mut call =
            cargo(&["test", "--release", "--locked", "--package", "arelem", "--", "--show-output"])
                .env("PROPTEST_RNG_SEED", &seed)
                .env("APT_SEED", &seed)
                .env("APT_CASES", extent.motion_cases.to_string())
                .env("APT_SHARE", extent.share.to_string());
        if let Some(pairs) = &extent.pairs {
            call = call.env("APT_PAIRS", pairs);
        }
        call.run_counting(count)
    });
    run.finish()
}

/// The seconds since 1970: another number every night.
fn seed_of_the_day() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_night_has_ten_thousand_cases_per_form_and_two_thousand_motions_per_pair() {
        assert_eq!((DEFINITION_CASES, MOTION_CASES, SHARE), (10_000, 2_000, 100));
    }
}
