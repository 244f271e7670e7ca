//! The passes of a pocket from the outermost to the innermost (APOCK, APOCKA).
//!
//! The way from one pass to the next is made in two halves. Half way it is seen what is left between two passes: if
//! that is no wider than twice the effective radius, the half way is the last pass. So the area inside a pass is
//! covered either from that pass or from one in its middle.

use apt_geometry::patience::Patience;

use super::{
    EFFECTIVE_RADIUS, FINISH_OFFSET, GENERAL_OFFSET,
    failure::PocketFailure,
    polygon::{Polygon, Vec2},
};
use crate::error::MotionFailure;

/// Passes of one pocket: no machine would cut more.
const MOST_PASSES: usize = 100_000;

/// From which pass to which the next step goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// From the finishing pass to the one beside it.
    Finish,
    /// Between general passes.
    General,
}

/// Distances between the passes.
#[derive(Debug, Clone)]
pub(super) struct Offsets {
    /// What the tool clears around its centre.
    pub(super) effective_radius: f64,
    general: f64,
    finish: f64,
    /// The offsets may be reduced where they would leave material in a corner.
    reduce: bool,
    /// Sine of half the sharpest angle the offsets are made for.
    sharpest: f64,
}

impl Offsets {
    /// From the numbers of the statement and the radius of the cutter. An effective radius of zero stands for half the
    /// general offset.
    pub(super) fn new(numbers: &[f64; 6], radius: f64, reduce: bool) -> Self {
        let general = numbers[GENERAL_OFFSET] * radius;
        let given = numbers[EFFECTIVE_RADIUS];
        Self {
            effective_radius: if given > 0.0 { given } else { 0.5 * general },
            general,
            finish: numbers[FINISH_OFFSET] * radius,
            reduce,
            sharpest: 1.0,
        }
    }

    fn of(&self, step: Step) -> f64 {
        match step {
            Step::Finish => self.finish,
            Step::General => self.general,
        }
    }

    /// Between two passes whose corners have the half angle with this sine, what is farthest from both is on the
    /// line between the corners: the offset may be `re (1 + sine)`.
    fn limit(&mut self, sharpest: f64) {
        self.sharpest = sharpest;
        let most = self.effective_radius * (1.0 + sharpest);
        self.general = self.general.min(most);
        self.finish = self.finish.min(most);
    }

    /// The second half of a step after which a corner is new: the corner has no counterpart in the pass outside, so
    /// that the pass inside alone must reach it.
    fn to_new_corner(&self, step: Step) -> f64 {
        0.5 * self.of(step).min(2.0 * self.effective_radius * self.sharpest)
    }

    /// First half of a step: the polygon half way and the length of the second half.
    fn first_half(&mut self, polygon: &Polygon, step: Step) -> Option<(Polygon, f64)> {
        let half = 0.5 * self.of(step);
        let middle = polygon.inset(half)?;
        if !self.reduce || middle.count() == polygon.count() {
            return Some((middle, half));
        }
        self.limit(middle.sharpest());
        let rest = self.to_new_corner(step);
        Some((middle, rest))
    }

    /// Second half of a step. If it brings a corner sharper than any before, it is made shorter.
    fn second_half(&mut self, middle: &Polygon, rest: f64, step: Step) -> Option<Polygon> {
        let mut next = middle.inset(rest)?;
        if !self.reduce || next.count() == middle.count() {
            return Some(next);
        }
        let sharpest = next.sharpest();
        if sharpest < self.sharpest {
            self.limit(sharpest);
            let shorter = self.to_new_corner(step);
            if shorter < rest {
                next = middle.inset(shorter)?;
            }
        }
        if next.count() < middle.count() {
            self.limit(next.sharpest());
        }
        Some(next)
    }
}

/// The passes from the outermost to the innermost, each in the order of cutting.
pub(super) fn clear(
    outermost: Polygon,
    mut offsets: Offsets,
    patience: Patience<'_>,
) -> Result<Vec<Vec<Vec2>>, MotionFailure> {
    let both_sides = 2.0 * offsets.effective_radius;
    if offsets.reduce {
        offsets.limit(outermost.sharpest());
    }
    let mut rings = vec![outermost.ring()];
    let mut polygon = outermost;
    let mut step = Step::Finish;
    while !polygon.is_within(both_sides) {
        if patience.is_over() {
            return Err(MotionFailure::Cancelled);
        }
        let offset = offsets.of(step);
        if step == Step::General && offset <= 0.0 {
            return Err(PocketFailure::NoOffset.into());
        }
        if rings.len() >= MOST_PASSES {
            return Err(PocketFailure::TooManyPasses { limit: MOST_PASSES, offset }.into());
        }
        let Some((middle, rest)) = offsets.first_half(&polygon, step) else { break };
        if middle.is_within(both_sides) {
            let line = middle.covering_side(offsets.effective_radius).map(Vec::from);
            rings.push(line.unwrap_or_else(|| middle.ring()));
            break;
        }
        let Some(next) = offsets.second_half(&middle, rest, step) else {
            rings.push(middle.ring());
            break;
        };
        rings.push(next.ring());
        polygon = next;
        step = Step::General;
    }
    Ok(rings)
}
