//! How strongly the clearance can bend upward while the tool moves: a bound over all points of the tool that may come
//! into contact on the way.
//!
//! For every single point of the tool the distance to the surface bends by no more than the surface's bound. The
//! clearance, the least of these functions, then bends by no more either, whatever jumps contact makes.

use apt_geometry::{
    Vec3,
    surface::{Bend, Region, Surface},
};

use super::{Gauge, Tool, closed_form, near};

/// Bound of the boxes into which the tool is cut.
const MAX_BOXES: u32 = 600;
/// The same where some box has no bound yet.
const MAX_BOXES_UNBOUNDED: u32 = 2400;
/// The same on a sculptured surface, where each box asks many patches: none has a bound where a path leaves the surface.
const MAX_BOXES_UNBOUNDED_BY_PATCH: u32 = 96;
/// Boxes that are looked at between two questions whether to give up.
const BOXES_A_QUESTION: u32 = 8;
/// A box is small enough when its bound exceeds that of its centre by this factor at most.
const CLOSE: f64 = 1.25;

/// The same for surfaces whose bounds over large boxes are near enough.
const CLOSE_BY_CHART: f64 = 1.5;

/// A box of points in the frame of the tool: across, across, along the axis.
#[derive(Debug, Clone, Copy)]
struct Cell {
    middle: [f64; 3],
    half: [f64; 3],
}

/// The bound of [`upward_bend`] where the tool is in a ball in which nearest places do not jump: that takes no search.
pub(crate) fn steady_bend(
    gauge: &Gauge,
    tool: &Tool,
    tip: &Vec3,
    spread: f64,
    range: [f64; 2],
) -> Option<f64> {
    let (tool, tip) = &gauge.body(tool, tip);
    if gauge.on { None } else { near::Around::new(gauge, tool, tip).upward_bend(spread, range) }
}

/// Bound of the second derivative along any direction of the distances of all points of the tool that come within
/// `range` (lowest, highest distance from the surface on the gauge's side, THICK included) while no point of the tool
/// strays farther than `spread` from its place for the given tool end. There is none once `cancel`, asked once in
/// [`BOXES_A_QUESTION`] boxes, says true.
pub(crate) fn upward_bend(
    gauge: &Gauge,
    tool: &Tool,
    tip: &Vec3,
    spread: f64,
    range: [f64; 2],
    cancel: &dyn Fn() -> bool,
) -> Bend {
    let region = |center, radius| Region { center, radius, lowest: range[0], highest: range[1] };
    if gauge.on {
        return gauge.surface.bend(gauge.side, &gauge.surface.foot(tip), &region(*tip, spread));
    }
    let touch = || gauge.contact(tool, tip).tool;
    let (tool, tip) = &gauge.body(tool, tip);
    if let Some(reach) = closed_form::disc(tool, &gauge.surface, gauge.side, tip) {
        // All of the tool is as near as its end, less its radius.
        let region = Region { lowest: range[0] + reach, highest: range[1] + reach, ..region(*tip, spread) };
        return gauge.surface.bend(gauge.side, &gauge.surface.foot(tip), &region);
    }
    let (radius, height) = (tool.radius(), tool.profile.top.height);
    // Of a flank that is known to be far away nothing comes within range.
    let near = near::Around::new(gauge, tool, tip);
    let height = near.top(range[1] + spread).unwrap_or(height);
    let mut cells = vec![Cell { middle: [0.0, 0.0, 0.5 * height], half: [radius, radius, 0.5 * height] }];
    let close = if gauge.surface.has_charts() { CLOSE_BY_CHART } else { CLOSE };
    // What the bound is, and what it is at least.
    let (mut greatest, mut needed, mut seen) = (0.0_f64, 0.0_f64, 0);
    let mut is_probed = false;
    while let Some(cell) = cells.pop() {
        seen += 1;
        if seen % BOXES_A_QUESTION == 0 && cancel() {
            return Bend::Unbounded;
        }
        if cell.beside(radius) {
            continue;
        }
        let center = tip
            + tool.across[0] * cell.middle[0]
            + tool.across[1] * cell.middle[1]
            + tool.axis * cell.middle[2];
        let reach = Vec3::from(cell.half).norm() + spread;
        let foot = match near.foot(&center) {
            Some(foot) => foot,
            None if gauge.surface.keeps_off(&center, reach + range[1].max(-range[0])) => continue,
            None => gauge.surface.foot(&center),
        };
        let distance = gauge.side * foot.distance;
        if distance - reach > range[1] || distance + reach < range[0] {
            continue;
        }
        let found = gauge.surface.bend(gauge.side, &foot, &region(center, reach));
        let small = cell.half.iter().all(|h| *h <= 0.5 * spread);
        if let Bend::AtMost(bound) = found
            && (small || bound <= greatest.max(close * needed))
        {
            greatest = greatest.max(bound);
            continue;
        }
        let at_best = gauge.surface.bend(gauge.side, &foot, &region(center, spread));
        match at_best {
            Bend::AtMost(least) => needed = needed.max(least),
            // Every box about that place has it within its reach, and no better bound.
            Bend::Unbounded if distance - spread <= range[1] && distance + spread >= range[0] => {
                return at_best;
            }
            Bend::Unbounded => {}
        }
        // Where the surface ends within reach of the contact no box helps.
        if found == Bend::Unbounded && !is_probed {
            is_probed = true;
            let place = touch();
            let foot = gauge.surface.foot(&place);
            let distance = gauge.side * foot.distance;
            let is_met = distance - spread <= range[1] && distance + spread >= range[0];
            if is_met && gauge.surface.bend(gauge.side, &foot, &region(place, spread)) == Bend::Unbounded {
                return Bend::Unbounded;
            }
        }
        let enough = match (found, at_best) {
            (Bend::AtMost(bound), _) => bound <= greatest.max(close * needed),
            _ => false,
        };
        let limit = match (found, &gauge.surface) {
            (Bend::Unbounded, Surface::Sculptured(_)) => MAX_BOXES_UNBOUNDED_BY_PATCH,
            (Bend::Unbounded, _) => MAX_BOXES_UNBOUNDED,
            _ => MAX_BOXES,
        };
        if enough || small || seen >= limit {
            match found {
                Bend::AtMost(bound) => greatest = greatest.max(bound),
                other => return other,
            }
        } else {
            cells.extend(cell.halves());
        }
    }
    Bend::AtMost(greatest)
}

impl Cell {
    /// True if the box lies farther from the axis than any point of the tool.
    fn beside(&self, radius: f64) -> bool {
        let near = |k: usize| (self.middle[k].abs() - self.half[k]).max(0.0);
        near(0).hypot(near(1)) > radius
    }

    /// Both halves along the longest edge.
    fn halves(&self) -> [Self; 2] {
        let mut k = 0;
        for other in 1..3 {
            if self.half[other] > self.half[k] {
                k = other;
            }
        }
        let (mut low, mut high) = (*self, *self);
        low.half[k] *= 0.5;
        high.half[k] *= 0.5;
        low.middle[k] -= low.half[k];
        high.middle[k] += high.half[k];
        [low, high]
    }
}
