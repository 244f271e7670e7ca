//! How clearances are expected to bend along the next vector: as along the last one, and on as they changed from the one before.
//! The nearer that comes, the fewer vectors are tried in vain.

use super::Trial;

/// Change of a curvature from one vector to the next, as a share of it, that is taken to go on.
const STEADY: f64 = 0.1;
/// Share by which a vector may be shorter or longer than was foretold for the next one to be so, too.
const NEARLY_FORETOLD: f64 = 0.01;

/// What the vectors made so far tell of the next one.
#[derive(Debug, Clone, Default)]
pub(super) struct Trend {
    /// Second derivative of each clearance along the path: part, drive.
    curvature: Option<[f64; 2]>,
    /// Length of the last vector and the curvature along it.
    last: Option<(f64, [f64; 2])>,
    /// How much more or less than foretold the last vector was, as a share of its length.
    misfit: f64,
}

impl Trend {
    /// The curvature to be expected, if anything is known.
    pub(super) fn curvature(&self) -> Option<[f64; 2]> {
        self.curvature
    }

    /// How long the next vector is likely to be by what is foretold of it.
    pub(super) fn ratio(&self) -> f64 {
        1.0 + self.misfit
    }

    /// Compares how long a vector could be with what was foretold.
    pub(super) fn compare(&mut self, foretold: f64, length: f64) {
        let misfit = length / foretold - 1.0;
        self.misfit = if misfit.abs() <= NEARLY_FORETOLD { misfit } else { 0.0 };
    }

    /// Nothing is known of the path from here on.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }

    /// The path goes on from the end of a vector.
    pub(super) fn follow(&mut self, found: &Trial) {
        let mut next = found.next_curvature;
        if let Some((length, before)) = self.last {
            // From middle to middle of vectors, the next one being as long as this one.
            let share = 2.0 * found.length / (length + found.length);
            for (k, next) in next.iter_mut().enumerate() {
                let bent = found.curvature[k];
                let change = share * (bent - before[k]);
                // Where the bend changes sides along the vector, its end tells more.
                if change.abs() <= STEADY * bent.abs() && *next == bent {
                    *next += change;
                }
            }
        }
        (self.curvature, self.last) = (Some(next), Some((found.length, found.curvature)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_vector_is_foretold_as_wrongly_as_the_last_one() {
        let mut trend = Trend::default();
        assert_eq!(trend.ratio(), 1.0);
        trend.compare(2.0, 1.999);
        assert!((trend.ratio() - 0.9995).abs() < 1e-12);
        // What is far off is another bend.
        trend.compare(2.0, 1.5);
        assert_eq!(trend.ratio(), 1.0);
    }
}
