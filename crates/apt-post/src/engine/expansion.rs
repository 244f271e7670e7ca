//! Cycles for which the control has no code, as single moves.

use apt_geometry::Vec3;

use super::{
    Engine,
    blocks::Shape,
    hole::{Cycle, SHIFT},
};
use crate::{
    control::{Values, Word},
    finding::PostFindingKind,
};

/// Most passes into which a hole is expanded.
const MOST_PASSES: u32 = 10_000;
/// Gap left above the last depth when a peck comes back, and how far the tool goes back to break a chip, in millimetres.
pub(super) const PECK_GAP_MM: f64 = 0.25;

impl Engine<'_> {
    /// The cycle as single moves.
    pub(super) fn expand(&mut self, cycle: &Cycle, top: Vec3, plane: f64, level: f64) {
        let stops = cycle.name == SHIFT;
        // The directions in which a tool steps aside are those of an upright spindle.
        let aside = stops && (self.machine.codes.spindle_orient.is_none() || !self.is_upright());
        if cycle.taps() || aside {
            return self.find(PostFindingKind::CycleNotPossible { cycle: cycle.word.clone() });
        }
        if cycle.holes == 1 {
            self.find(PostFindingKind::CycleExpanded { cycle: cycle.word.clone() });
        }
        for _ in 0..cycle.times {
            if self.patience.ends_after(1) {
                return;
            }
            self.expanded_hole(cycle, top, plane, level);
        }
    }

    fn expanded_hole(&mut self, cycle: &Cycle, top: Vec3, plane: f64, level: f64) {
        let over = self.position.map_or(level, |position| self.height(&position));
        self.rapid_to(self.at_height(&top, over));
        self.rapid_to(self.at_height(&top, plane));
        self.passes(cycle, top, plane);
        if cycle.dwell > 0.0 {
            self.dwell_block(cycle.dwell);
        }
        if cycle.name == SHIFT {
            return self.step_aside(cycle, top, level);
        }
        if cycle.name == "ream" {
            self.feed_down(self.at_height(&top, plane), cycle.feed);
        }
        // A boring tool that turns would cut a groove on its way out.
        let stops = cycle.name == "bore" && self.spindle.on;
        if stops {
            let machine = self.machine;
            self.control.function(&machine.codes.spindle_off);
        }
        self.rapid_to(self.at_height(&top, level));
        if stops {
            self.spindle_again();
        }
    }

    /// Down to the bottom of a hole, in steps where the cycle has some.
    fn passes(&mut self, cycle: &Cycle, top: Vec3, plane: f64) {
        let bottom = self.height(&top) - cycle.depth;
        let gap = self.tape_length(PECK_GAP_MM);
        let step = cycle.step.unwrap_or(cycle.depth + cycle.clearance);
        let passes = self.passes_of(plane - bottom, step);
        for pass in 1..=passes {
            if self.patience.ends_after(1) {
                return;
            }
            let depth = if pass == passes { bottom } else { plane - step * f64::from(pass) };
            self.feed_down(self.at_height(&top, depth), cycle.feed);
            if pass < passes {
                let lifted = if cycle.name == "chipbreak" { depth + gap } else { plane };
                self.rapid_to(self.at_height(&top, lifted));
                if cycle.name == "peck" {
                    self.rapid_to(self.at_height(&top, depth + gap));
                }
            }
        }
    }

    /// How many steps lead so far down; what is left of the last one when it is less than the last decimals is none.
    fn passes_of(&self, way: f64, step: f64) -> u32 {
        let passes = (way / step).ceil();
        let last = self.control.rounded("Z", way - step * (passes - 1.0));
        let passes = if last > 0.0 { passes } else { passes - 1.0 };
        (passes as u32).clamp(1, MOST_PASSES)
    }

    /// Stops the spindle where its edge is known to stand, takes the edge off the wall and the tool out of the hole, and
    /// lets the spindle turn again.
    fn step_aside(&mut self, cycle: &Cycle, top: Vec3, level: f64) {
        let machine = self.machine;
        match (cycle.orientation, &machine.codes.spindle_orient) {
            (Some(angle), _) if !machine.templates.spindle_orient.is_empty() => {
                let values = Values::default().number("R", angle);
                self.control.template(&machine.templates.spindle_orient, &values);
            }
            (_, Some(code)) => self.control.function(code),
            (_, None) => {}
        }
        let (x, y) = cycle.shift.unwrap_or_default();
        let bottom = self.height(&top) - cycle.depth;
        let aside = top + Vec3::new(x, y, 0.0);
        self.rapid_to(self.at_height(&aside, bottom));
        self.rapid_to(self.at_height(&aside, level));
        self.rapid_to(self.at_height(&top, level));
        self.spindle_again();
    }

    fn feed_down(&mut self, position: Vec3, feed: Option<f64>) {
        let machine = self.machine;
        let mut words = self.axis_words(position);
        words.extend(feed.map(|value| Word { register: "F", value, force: false }));
        if self.feed_mode(&machine.codes.feed_per_minute) {
            self.control.code(&machine.codes.feed_per_minute);
        }
        self.cut(&[], None, &Shape::Linear, &words);
        self.position = Some(self.rounded(position));
    }
}
