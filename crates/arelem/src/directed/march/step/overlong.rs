//! What vectors that were too long tell about how much shorter the next one must be.

/// A vector that was too long.
#[derive(Clone, Copy)]
pub(super) struct Overlong {
    /// Index of the role that was out of its band.
    pub(super) culprit: usize,
    /// Whether it was too deep.
    pub(super) is_deep: bool,
    pub(super) length: f64,
    /// How far its clearance was.
    pub(super) beyond: f64,
}

/// Share of the way between two lengths beyond which a third one is tried.
const LEAST_BETWEEN: f64 = 0.1;

/// A length between two others, their middle or a lesser one that is foretold.
pub(super) fn between(low: f64, high: f64, foretold: Option<f64>) -> f64 {
    let least = low + LEAST_BETWEEN * (high - low);
    foretold.unwrap_or(f64::INFINITY).clamp(least, 0.5 * (low + high))
}

impl Overlong {
    /// Whether both were out of the band in the same way.
    pub(super) fn fails_like(&self, other: &Self) -> bool {
        self.culprit == other.culprit && self.is_deep == other.is_deep
    }

    /// The share of the length at which the clearance comes back into its band if that goes on as from a longer vector.
    pub(super) fn meets_band(&self, longer: &Self) -> Option<f64> {
        let fall = longer.beyond - self.beyond;
        let falls = self.fails_like(longer) && fall > 0.0 && self.beyond > 0.0;
        falls.then(|| 1.0 - self.beyond / fall * (longer.length / self.length - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_vectors_tell_the_length_that_fits_by_a_line() {
        let at = |length: f64, beyond: f64| Overlong { culprit: 0, is_deep: false, length, beyond };
        // Out by 3 at 8 and by 1 at 6: in the band at 5.
        assert!((at(6.0, 1.0).meets_band(&at(8.0, 3.0)).unwrap() * 6.0 - 5.0).abs() < 1e-12);
        assert_eq!(at(6.0, 3.0).meets_band(&at(8.0, 3.0)), None);
        assert_eq!(at(6.0, 1.0).meets_band(&Overlong { culprit: 1, ..at(8.0, 3.0) }), None);
        assert_eq!(at(6.0, 1.0).meets_band(&Overlong { is_deep: true, ..at(8.0, 3.0) }), None);
    }

    #[test]
    fn a_length_between_two_others_is_their_middle_or_a_lesser_one_that_is_foretold() {
        assert_eq!(between(1.0, 2.0, None), 1.5);
        assert_eq!(between(1.0, 2.0, Some(1.25)), 1.25);
        assert_eq!(between(1.0, 2.0, Some(1.9)), 1.5);
        assert!((between(1.0, 2.0, Some(0.2)) - 1.1).abs() < 1e-12);
    }
}
