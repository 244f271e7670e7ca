//! Random motions of every pair of part and drive surface: what the engine delivers is proven by the verifier, what it
//! refuses has no solution by a search of the verifier's own clearances, and motions obey the laws of motion: moved,
//! scaled, mirrored, reversed and subdivided they stay what they are.
//!
//! Surfaces are laid against a tool at a random place, so that the start-up has a solution; a share is laid anywhere.
//!
//! `APT_CASES` sets the number of motions of each pair, `APT_SEED` the seed, `APT_PAIR` (`sphere/cone`, `*/ruled`) looks at
//! one pair, and `APT_CASE` at one motion of it; `APT_PAIRS` (`2/5`) looks at the second of five parts of the pairs.
//! `APT_SHARE` says of how many motions one is looked at in pairs with surfaces to which distances are searched for, and
//! `APT_SURFACES=searched` looks at such pairs alone, `APT_TOOLS=barrel` at barrels alone. `APT_BUDGET` is how many times the budget of the tests may be spent on a motion.

mod case;
mod combinations;
mod dense;
mod ends;
mod judge;
mod kinds;
mod laws;
mod modes;
mod search;
mod stand;
#[path = "../support/mod.rs"]
mod support;
mod tools;
#[path = "../support/wave.rs"]
mod wave;

use std::{collections::BTreeMap, fmt::Write as _};

use case::Case;
use judge::Tally;
use kinds::Kind;
use modes::Turning;
use support::Random;

/// Seeds of the test command: of the motions, of those that the laws are tried on, and of those on which the axis turns.
const SEEDS: [u64; 4] = [1, 19_610_315, 19_700_101, 19_850_601];

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

/// The pairs that are looked at.
fn pairs() -> Vec<(Kind, Kind)> {
    let wanted = std::env::var("APT_PAIR").ok();
    let is_wanted = |part: Kind, drive: Kind| match wanted.as_deref().and_then(|w| w.split_once('/')) {
        Some((p, d)) => (p == "*" || part.name() == p) && (d == "*" || drive.name() == d),
        None => true,
    };
    let searched_only = std::env::var("APT_SURFACES").is_ok_and(|word| word == "searched");
    let [slice, slices] = slice().unwrap_or([1, 1]);
    Kind::ALL
        .into_iter()
        .flat_map(|part| Kind::ALL.into_iter().map(move |drive| (part, drive)))
        .enumerate()
        .filter(|(k, (part, drive))| k % slices + 1 == slice && is_wanted(*part, *drive))
        .filter(|(_, (part, drive))| !searched_only || part.is_slow() || drive.is_slow())
        .map(|(_, pair)| pair)
        .collect()
}

/// Which part of the pairs, of how many.
fn slice() -> Option<[usize; 2]> {
    let words = std::env::var("APT_PAIRS").ok()?;
    let (slice, slices) = words.split_once('/')?;
    Some([slice.parse().ok()?, slices.parse().ok().filter(|n| *n > 0)?])
}

/// The seed of one motion of a pair.
fn seed(base: u64, part: Kind, drive: Kind, index: u64) -> u64 {
    let pair = part as u64 * 64 + drive as u64;
    base.wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ pair.wrapping_mul(0xbf58_476d_1ce4_e5b9)
        ^ index.wrapping_mul(0x94d0_49bb_1331_11eb)
}

/// One motion among those looked at.
struct Place {
    part: Kind,
    drive: Kind,
    index: u64,
    seed: u64,
    /// There is little time.
    sparing: bool,
}

impl Place {
    /// The motion, unless it is to be left out; the tally knows why.
    fn draw(&self, tally: &mut Tally) -> Option<Case> {
        self.wanted(Case::draw(self.part, self.drive, self.seed), |case| case, tally)
    }

    fn wanted<T>(&self, drawn: Option<T>, case: impl Fn(&T) -> &Case, tally: &mut Tally) -> Option<T> {
        match drawn {
            Some(drawn) if self.sparing && case(&drawn).has_slow_stop => tally.left_out += 1,
            Some(drawn) => return Some(drawn),
            None => tally.undrawn += 1,
        }
        None
    }
}

/// A table of counts, a row per pair, and every fault.
fn describe(pairs: &BTreeMap<(Kind, Kind), Tally>) -> String {
    let mut report = String::new();
    let mut all = Tally::default();
    let _ = writeln!(report, "{}", Tally::COLUMNS);
    for (pair, tally) in pairs {
        let _ = writeln!(report, "{:<22}{}", name(*pair), tally.row());
        all.add(tally);
    }
    let _ = writeln!(report, "{:<22}{}", "all", all.row());
    let _ = writeln!(report, "rightly refused: {}", all.refusals());
    for (pair, tally) in pairs {
        for line in tally.lines() {
            let _ = writeln!(report, "{} {line}", name(*pair));
        }
    }
    report
}

fn name((part, drive): (Kind, Kind)) -> String {
    format!("{}/{}", part.name(), drive.name())
}

/// Looks at so many motions of every pair; sparing ones leave out surfaces to which distances are searched for.
#[expect(clippy::print_stdout, reason = "the long run tells what is done")]
fn every_pair(
    standard: u64,
    cases: u64,
    sparing: bool,
    mut look: impl FnMut(&Place, &mut Tally),
) -> BTreeMap<(Kind, Kind), Tally> {
    let base = number("APT_SEED").unwrap_or(standard);
    let one = number("APT_CASE");
    let share = number("APT_SHARE").unwrap_or(SLOW_SHARE).max(1);
    let mut tallies: BTreeMap<(Kind, Kind), Tally> = BTreeMap::new();
    for (part, drive) in pairs() {
        let slow = part.is_slow() || drive.is_slow();
        if slow && sparing {
            continue;
        }
        let tally = tallies.entry((part, drive)).or_default();
        // Where distances are searched for, a motion takes many times as long.
        let cases = if slow { cases.div_ceil(share) } else { cases };
        for index in one.map_or(0..cases, |index| index..index + 1) {
            let told = [tally.faults.len(), tally.remarks.len()];
            let seed = seed(base, part, drive, index);
            look(&Place { part, drive, index, seed, sparing }, tally);
            if cases > TELLING {
                for line in tally.faults[told[0]..].iter().chain(&tally.remarks[told[1]..]) {
                    println!("{} {line}", name((part, drive)));
                }
            }
        }
        if cases > TELLING {
            println!("{:<22}{}", name((part, drive)), tally.row());
        }
    }
    tallies
}

/// Of the pairs with surfaces to which distances are searched for, the long run looks at one motion in so many.
const SLOW_SHARE: u64 = 100;
/// With more motions than this of each pair, every pair is told as it is done.
const TELLING: u64 = 2;

#[test]
fn motions_of_every_pair_are_proven_or_refused_rightly() {
    let cases = number("APT_CASES").unwrap_or(2);
    let told = number("APT_CASE").is_some();
    let tallies = every_pair(SEEDS[0], cases, number("APT_CASES").is_none(), |place, tally| {
        let Some(case) = place.draw(tally) else { return };
        if told {
            println!("{case:#?}");
        }
        let (verdict, times) = judge::judge(&case);
        if told {
            println!("{verdict:?}");
        }
        tally.note(place.index, &case, (verdict, times));
    });
    settle(&tallies);
}

/// The search finds one start alone, where the tool touches the end of its part surface sixteen degrees behind that.
#[test]
fn a_start_behind_the_end_of_a_surface_is_none() {
    let (part, drive) = (Kind::PolyConic, Kind::Conic);
    let case = Case::draw(part, drive, seed(20_262_699, part, drive, 22)).expect("a motion");
    let (verdict, _) = judge::judge(&case);
    assert!(matches!(verdict, judge::Verdict::Refused(_)), "{verdict:?}");
}

/// Prints the table, and fails where there is a fault.
#[expect(clippy::print_stdout, reason = "the long run tells what is done")]
fn settle(tallies: &BTreeMap<(Kind, Kind), Tally>) {
    let report = describe(tallies);
    println!("{report}");
    assert!(tallies.values().all(|t| t.faults.is_empty()), "\n{report}");
    let proven: usize = tallies.values().map(|t| t.proven).sum();
    assert!(proven > 0 || number("APT_CASE").is_some(), "\n{report}");
}

/// A share of the motions: each is run nine times.
#[test]
fn motions_of_every_pair_obey_the_laws_of_motion() {
    let cases = number("APT_CASES").map_or(1, |cases| cases.div_ceil(10));
    let tallies = every_pair(SEEDS[1], cases, number("APT_CASES").is_none(), |place, tally| {
        let Some(case) = place.draw(tally) else { return };
        let mut random = Random(place.index);
        tally.note_laws(place.index, &case, laws::tried(&case, &mut random));
    });
    settle(&tallies);
}

#[test]
fn motions_on_which_the_axis_turns_keep_bands_and_angles() {
    turn_on_every_pair(SEEDS[2], Turning::draw);
}

#[test]
fn motions_on_which_the_axis_lies_along_the_drive_surface_keep_bands_and_law() {
    turn_on_every_pair(SEEDS[3], Turning::draw_beside);
}

/// Motions whose axis follows a law on every pair, drawn so.
#[expect(clippy::print_stdout, reason = "a case that is looked at is told")]
fn turn_on_every_pair(seed: u64, draw: fn(Kind, Kind, u64) -> Option<Turning>) {
    let cases = number("APT_CASES").map_or(1, |cases| cases.div_ceil(4));
    let told = number("APT_CASE").is_some();
    let tallies = every_pair(seed, cases, number("APT_CASES").is_none(), |place, tally| {
        let drawn = draw(place.part, place.drive, place.seed);
        let Some(turning) = place.wanted(drawn, |turning| &turning.case, tally) else { return };
        if told {
            println!("{turning:#?}");
        }
        let (verdict, times) = judge::timed_verdict(|| modes::judge(&turning));
        if told {
            println!("{verdict:?}");
        }
        tally.note(place.index, &turning.case, (verdict, times));
    });
    settle(&tallies);
}
