//! What the sag of a vector tells: how its clearance bends, and by how much it may be longer.

use super::{GREATEST_GROWTH, SPARED};
use crate::{clearance::Shape, directed::proof::Extremes, role::Working};

/// Share of the band that a clearance has to sag by, beyond the ends of its vector, to tell anything of how it bends.
const LEAST_SAG: f64 = 1e-3;

/// Second derivative of the parabola through the clearances of both ends of a vector that sags as much as the clearance; `None` where
/// that has no extreme between them.
pub(super) fn sagging(
    role: &Working,
    extremes: &Extremes,
    (start, end): (f64, f64),
    length: f64,
) -> Option<f64> {
    let sag = (start.min(end) - extremes.least) - (extremes.greatest - start.max(end));
    (sag.abs() > LEAST_SAG * role.band()).then(|| {
        // Between ends of different clearances the extreme is nearer to one of them.
        let depths = [start, end]
            .map(|value| (value - if sag > 0.0 { extremes.least } else { extremes.greatest }).abs());
        2.0 * sag.signum() * (depths[0].sqrt() + depths[1].sqrt()).powi(2) / (length * length)
    })
}

/// Factor by which the length may grow until the sag fills the band, taking the sag as quadratic in the length.
pub(super) fn growth(role: &Working, extremes: &Extremes, (start, end): (f64, f64)) -> f64 {
    if role.shape == Shape::Flat {
        return GREATEST_GROWTH;
    }
    let guard = SPARED * role.band();
    let mut factor: f64 = GREATEST_GROWTH;
    let mut consider = |depth: f64, room_start: f64, room_end: f64, left: f64| {
        // Parabola through both ends with its vertex `depth` beyond the nearer end.
        let sag = depth.max(0.0);
        if sag <= LEAST_SAG * role.band() && left > 0.0 {
            return;
        }
        let used = (room_start - left).max(0.0).sqrt() + (room_end - left).max(0.0).sqrt();
        let available = room_start.max(0.0).sqrt() + room_end.max(0.0).sqrt();
        if used > 0.0 {
            factor = factor.min(available / used);
        }
    };
    let low_left = extremes.least + role.inside - guard;
    consider(
        start.min(end) - extremes.least,
        start + role.inside - guard,
        end + role.inside - guard,
        low_left,
    );
    let high_left = role.outside - guard - extremes.greatest;
    consider(
        extremes.greatest - start.max(end),
        role.outside - guard - start,
        role.outside - guard - end,
        high_left,
    );
    factor
}
