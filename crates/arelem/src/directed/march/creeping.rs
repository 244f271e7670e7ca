//! Paths that creep: one cut vector after the other hardly leads on, though none has to be short.

/// Length of a vector, as a share of the narrower band and of MAXDP, that hardly leads on: a path that bends so tightly turns back within it.
const HARDLY: f64 = 0.02;
/// How many such vectors may follow each other.
const MOST: u32 = 6;

/// Vectors since the last one that led on.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Creeping(u32);

impl Creeping {
    /// Counts a cut vector. `most` is how long it was allowed to be, `band` the width of the narrower band, all in program units. Gives, where too
    /// many hardly led on, how many, and how long such a vector is at most.
    pub(super) fn count(&mut self, vector: f64, most: f64, band: f64) -> Option<(u32, f64)> {
        let hardly = HARDLY * most.min(band);
        self.0 = if vector <= hardly { self.0 + 1 } else { 0 };
        (self.0 >= MOST).then_some((self.0, hardly))
    }
}

#[cfg(test)]
mod tests {
    use super::Creeping;

    /// In a row, with these lengths, allowed lengths and a band of 0.01: after how many vectors the motion ends.
    fn ends_after(vectors: &[[f64; 2]]) -> Option<usize> {
        let mut creeping = Creeping::default();
        let ends = |[vector, most]: &[f64; 2]| creeping.count(*vector, *most, 0.01);
        let (at, (count, hardly)) =
            vectors.iter().map(ends).enumerate().find_map(|(k, end)| Some((k, end?)))?;
        assert!(count as usize <= at + 1 && hardly <= 2e-4, "{count} of {hardly}");
        Some(at + 1)
    }

    #[test]
    fn six_vectors_in_a_row_that_hardly_lead_on_end_a_motion() {
        let (short, long) = ([1e-4, 10.0], [0.3, 10.0]);
        assert_eq!(ends_after(&[short; 9]), Some(6));
        assert_eq!(ends_after(&[long, short, short, short, short, short, short, short]), Some(7));
    }

    #[test]
    fn a_vector_that_leads_on_begins_the_count_anew() {
        let (short, longer) = ([1e-4, 10.0], [3e-4, 10.0]);
        let row = [[short; 5].as_slice(), &[longer], &[short; 5], &[longer], &[short; 6]].concat();
        assert_eq!(ends_after(&row[..17]), None);
        assert_eq!(ends_after(&row), Some(18));
    }

    /// Before a stop, or by MAXDP, vectors are made short on purpose.
    #[test]
    fn a_vector_that_may_not_be_longer_does_not_creep() {
        assert_eq!(ends_after(&[[1e-4, 1e-4]; 20]), None);
        assert_eq!(ends_after(&[[1e-4, 2e-4]; 20]), None);
    }
}
