//! How far surfaces go on beyond what their definition gives, and other numbers that belong to the meaning of a form and
//! not to a method: whoever measures a surface, the engine or the verifier, must mean the same surface.

use crate::Vec3;

/// How far a ruled surface goes on beyond its curves and their ends, as a multiple of itself.
pub const RULED_BEYOND: f64 = 4.0;
/// Share of the way to the place where neighbouring rulings meet at which the extension of a ruled surface ends.
pub const RULED_BEFORE_FOLD: f64 = 0.9;
/// Share of the chord at both ends where the meeting of rulings is not judged: a curve may stand upright there.
pub const RULED_STEADY: f64 = 0.05;
/// How far the section that is a curve of a ruled surface is followed beyond its ends, in chords; it is straight then.
pub const SECTION_BEYOND: f64 = 1.0;
/// Slope over the chord, in chords, above which a section is not followed beyond its ends; no extension runs steeper.
pub const SECTION_STEEP_BEYOND: f64 = 3.0;
/// Distance of an end point from its section, relative to the chord, up to which a section that stands upright there is taken
/// to end in it: points are often given with four or five decimals.
pub const SECTION_MISFIT: f64 = 1e-2;
/// How far the stations of a polyconic surface are followed before 0 and after 1.
pub const POLYCONIC_STATIONS_BEYOND: f64 = 0.25;
/// How far the straight ends of a conic go, as a multiple of the way to where its end tangents meet.
pub const POLYCONIC_ENDS_BEYOND: f64 = 2.0;
/// Least fullness of a conic: below it the conic is its chord (published constant).
pub const LEAST_FULLNESS: f64 = 0.500_000_5;
/// Greatest fullness of a conic: at 1 it is its two tangents.
pub const GREATEST_FULLNESS: f64 = 1.0 - 1e-6;

/// At how many shares of the chord, less one, it is looked where neighbouring rulings meet: at the same ones by whoever
/// measures. Odd and no round number: joints of a curve lie at round shares.
const RULED_STATIONS: u32 = 37;
/// How far from 1 or 0 the rulings meet, as a share, up to which they are taken to meet on the curve itself: an apex.
const AT_THE_CURVE: f64 = 1e-9;

/// How far the rulings of a ruled surface go on, as shares of the way from its first curve (0) to its second (1): until
/// neighbours would meet, seen along the mean of both curves. `tangents` tells how both curves run at a share of the chord; it
/// is asked at places that do not stand near the ends of the chord ([`RULED_STEADY`]). None where it knows none.
pub fn ruled_shares(tangents: impl Fn(f64) -> Option<[Vec3; 2]>) -> Option<[f64; 2]> {
    let (mut low, mut high) = (-RULED_BEYOND, 1.0 + RULED_BEYOND);
    for station in 0..=RULED_STATIONS {
        let part = f64::from(station) / f64::from(RULED_STATIONS);
        let [near, far] = tangents(RULED_STEADY + (1.0 - 2.0 * RULED_STEADY) * part)?;
        let along = near + far;
        let (a, b) = (near.dot(&along), far.dot(&along));
        let meet = a / (a - b);
        if meet >= 1.0 - AT_THE_CURVE {
            let apex = meet <= 1.0 + AT_THE_CURVE;
            high = high.min(if apex { 1.0 } else { 1.0 + RULED_BEFORE_FOLD * (meet - 1.0) });
        } else if meet <= AT_THE_CURVE {
            low = low.max(RULED_BEFORE_FOLD * meet.min(0.0));
        }
    }
    Some([low, high])
}
