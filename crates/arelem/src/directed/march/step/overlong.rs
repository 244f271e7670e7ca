//! What vectors that were too long tell about how much shorter the next one must be.

/// A vector that was too long.
#[derive(Clone, Copy)]
pub(super) struct Overlong {
    /// Index of the role that was out of its band.
    pub(super) culprit: usize,
    pub(super) length: f64,
    /// How far its clearance was.
    pub(super) beyond: f64,
}

impl Overlong {
    /// The share of the length at which the clearance comes back into its band if that goes on as from a longer vector.
    pub(super) fn meets_band(&self, longer: &Self) -> Option<f64> {
        let fall = longer.beyond - self.beyond;
        let falls = longer.culprit == self.culprit && fall > 0.0 && self.beyond > 0.0;
        falls.then(|| 1.0 - self.beyond / fall * (longer.length / self.length - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_vectors_tell_the_length_that_fits_by_a_line() {
        let at = |length: f64, beyond: f64| Overlong { culprit: 0, length, beyond };
        // Out by 3 at 8 and by 1 at 6: in the band at 5.
        assert!((at(6.0, 1.0).meets_band(&at(8.0, 3.0)).unwrap() * 6.0 - 5.0).abs() < 1e-12);
        assert_eq!(at(6.0, 3.0).meets_band(&at(8.0, 3.0)), None);
        assert_eq!(at(6.0, 1.0).meets_band(&Overlong { culprit: 1, ..at(8.0, 3.0) }), None);
    }
}
