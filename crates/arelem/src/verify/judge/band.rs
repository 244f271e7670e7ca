//! The band of a role over whole vectors.

use super::{
    super::{
        Extent, Rule, VerifyError,
        clearance::{Clearance, Reading},
        span::{Extremes, Readings, Span, told},
    },
    Bound, Judge,
};

/// Accuracy of the bounds of a clearance on a vector, relative to the band, at first and when it would decide: less than
/// sequences leave of the band.
const BAND_SHARES: [f64; 3] = [4e-4, 2e-5, 0.0];

/// A vector and the clearance between its ends that the readings there tell of.
#[derive(Clone, Copy)]
struct Told {
    value: f64,
    vector: usize,
    ends: [Reading; 2],
}

/// What the band of a role is measured with.
struct Measure<'a> {
    bound: &'a Bound<'a>,
    clearance: Clearance<'a>,
    rule: Rule,
    guard: f64,
}

impl Judge<'_> {
    /// The band of one role: at the last point, or over every vector.
    ///
    /// Where bounds from the ends of a vector show all of it within the band nothing more is asked of it. So that the least and the
    /// greatest clearance of a motion are readings all the same, those two vectors are looked at of which the readings at the ends
    /// tell the least and the greatest between them.
    pub(super) fn band(
        &mut self,
        bound: &Bound<'_>,
        rule: Rule,
        only_end: bool,
    ) -> Result<Extent, VerifyError> {
        let guard = self.guard();
        if only_end {
            let vector = self.last_vector();
            let end = self.positions[vector + 1];
            let found = bound.at_point(&end, vector)?;
            if let Some((value, excess)) = bound.excess(&found, guard) {
                self.findings.add(rule, vector, value, excess);
            }
            return Ok(bound.extent(&found));
        }
        let measure = Measure { bound, clearance: bound.clearance(), rule, guard };
        let mut all: Option<Extremes> = None;
        let [mut least, mut greatest]: [Option<Told>; 2] = [None; 2];
        bound.normals.borrow_mut().reserve_exact(self.positions.len());
        let mut left = bound.read(self.positions.first().ok_or(VerifyError::Empty)?)?;
        for vector in 0..self.positions.len() - 1 {
            let ends = [left, bound.read(&self.positions[vector + 1])?];
            left = ends[1];
            let (found, told) = self.on_vector(&measure, (vector, ends), false)?;
            all = Some(all.map_or(found, |a| a.join(found)));
            if let Some(value) = told {
                let told = Some(Told { value, vector, ends });
                least = if least.is_none_or(|l| value < l.value) { told } else { least };
                greatest = if greatest.is_none_or(|g| value > g.value) { told } else { greatest };
            }
        }
        let mut all = all.ok_or(VerifyError::Empty)?;
        let least = least.filter(|told| told.value < all.min);
        for told in [least, greatest.filter(|told| told.value > all.max)].into_iter().flatten() {
            all = all.join(self.on_vector(&measure, (told.vector, told.ends), true)?.0);
        }
        Ok(bound.extent(&all))
    }

    /// The extremes of a clearance on a vector, with the readings at its ends, and what these tell of a clearance between them.
    fn on_vector(
        &mut self,
        measure: &Measure<'_>,
        (vector, ends): (usize, [Reading; 2]),
        is_looked_at: bool,
    ) -> Result<(Extremes, Option<f64>), VerifyError> {
        let Measure { bound, clearance, rule, guard } = measure;
        let width = bound.intol + bound.outtol;
        let tolerances = BAND_SHARES.map(|s| (s * width).max(0.1 * guard));
        // A whole band outside is out of tolerance whatever else there is on the vector.
        let beyond = [-bound.intol - width - guard, bound.outtol + width + guard];
        let band = [-bound.intol - guard, bound.outtol + guard];
        let read = Readings::default();
        let (from, to) = (self.positions[vector], self.positions[vector + 1]);
        let span = Span { clearance, from, to, ends, beyond, band, read: &read, is_looked_at };
        let lost = || VerifyError::NoDistance { vector };
        let at_ends = span.at_ends().ok_or_else(lost)?;
        let mut found = span.extremes(at_ends, tolerances[0]).ok_or_else(lost)?;
        for finer in &tolerances[1..] {
            // Let no error term decide that could be made smaller.
            if bound.excess(&found, *guard).is_some() && found.error() > *finer {
                found = span.extremes(at_ends, *finer).ok_or_else(lost)?;
            }
        }
        if let Some((value, excess)) = bound.excess(&found, *guard) {
            self.findings.add(*rule, vector, value, excess);
        }
        Ok((found, told(&at_ends)))
    }
}
