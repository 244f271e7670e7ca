//! How closely a contact is asked for.

/// Share of what a clearance is above the lowest that counts, that a contact whose neighbours are hard to find may leave open.
const OPEN: f64 = 0.01;

/// What of a contact need not be found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Enough {
    /// Clearance below which a contact need not be the nearest one: how deep the tool is does not matter there.
    pub(crate) lowest: f64,
    /// How much nearer than the contact another point of the tool may be.
    pub(crate) slack: f64,
    /// The same as a share of what the clearance is above the lowest.
    pub(crate) share: f64,
}

impl Enough {
    /// As closely as the search can tell.
    pub(crate) const ALL: Self = Self { lowest: f64::NEG_INFINITY, slack: 0.0, share: 0.0 };

    /// The same of a surface that lies off by a thickness.
    pub(crate) fn above(self, thickness: f64) -> Self {
        Self { lowest: self.lowest + thickness, ..self }
    }

    /// How much nearer another point may be than a contact.
    pub(super) fn slack_of(&self, clearance: f64) -> f64 {
        self.slack.max(self.above_lowest(clearance) * self.share)
    }

    /// How much nearer another point may be where the search has not led to what is nearest at once, as below a sharp ridge or vertex:
    /// there it is where several places of the surface are equally near, and no slope leads to it.
    pub(super) fn slack_of_hard(&self, clearance: f64) -> f64 {
        self.slack_of(clearance).max(OPEN * self.above_lowest(clearance))
    }

    /// What a clearance is above the lowest, if there is one.
    fn above_lowest(&self, clearance: f64) -> f64 {
        let above = clearance - self.lowest;
        if above.is_finite() { above.max(0.0) } else { 0.0 }
    }
}
