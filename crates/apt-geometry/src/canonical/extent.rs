//! How far surfaces go on beyond what their definition gives, and other numbers that belong to the meaning of a form and
//! not to a method: whoever measures a surface, the engine or the verifier, must mean the same surface.

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
