//! How clearances are expected to bend along the next vector: as along the last one, and on as they changed from the one before.
//! The nearer that comes, the fewer vectors are tried in vain.

use super::Trial;

/// Change of a curvature from one vector to the next, as a share of it, that is taken to go on.
const STEADY: f64 = 0.1;

/// What the vectors made so far tell of the next one.
#[derive(Debug, Default)]
pub(super) struct Trend {
    /// Second derivative of each clearance along the path: part, drive.
    curvature: Option<[f64; 2]>,
    /// Length of the last vector and the curvature along it.
    last: Option<(f64, [f64; 2])>,
}

impl Trend {
    /// The curvature to be expected, if anything is known.
    pub(super) fn curvature(&self) -> Option<[f64; 2]> {
        self.curvature
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
        *self = Self { curvature: Some(next), last: Some((found.length, found.curvature)) };
    }
}
