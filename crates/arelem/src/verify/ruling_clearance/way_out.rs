//! Ways out of a surface for a tool that is in it: how far in a direction it must be moved at least, for certain.

use apt_geometry::Vec3;

use super::{Bodies, DIRECTIONS, Deepest, FARTHER, PROOF_STEPS};
use crate::verify::{
    clearance::Reading,
    strip::{Touch, nearest_to_all},
};

/// Halvings between the last way that does not free the tool and the first that does.
const CLOSER: usize = 6;
/// How much longer than the depth that is meant the way may be out of a place that need not be the deepest.
const ASTRAY: f64 = 2.0;
/// How many times as closely as ways are looked for the depth of a tool without a body is told.
const SURE: f64 = 4.0;
/// How often a tool without a body is cut, the deepest part first: often enough that two places of it are parted that are some eighth of it
/// from each other, wherever they are.
const CUTS: usize = 16;
/// Share of a part that none that is cut off it is shorter than.
const LEAST_SHARE: f64 = 0.125;
/// Cells that may be halved for whether a surface is left behind. Where it is, some hundreds tell so for each direction; where more are
/// left, it is by little more than rounding.
const CELLS_LEFT_BEHIND: usize = 4_000;

/// What holds a tool without a body that is led back into a surface in a direction.
struct Held {
    /// How far out it is then.
    least: f64,
    /// Unit normal away from the surface where it is held.
    normal: Vec3,
    /// How high up it is held.
    height: f64,
}

/// Ways that free a tool without a body.
#[derive(Clone, Copy)]
struct Way {
    /// No place of it is deeper.
    depth: f64,
    /// A place of it is not less deep.
    known: f64,
    /// Unit direction of the shortest, and how high up it was held by that.
    normal: Vec3,
    height: f64,
    /// How high up it was held in the last two.
    held: [f64; 2],
}

impl Way {
    fn held(held: &Held, known: f64) -> Self {
        Self { depth: held.least, known, normal: held.normal, height: held.height, held: [held.height; 2] }
    }

    /// What is known by another way, too.
    fn or(self, held: &Held, known: f64) -> Self {
        let shorter = if held.least < self.depth { Self::held(held, known) } else { self };
        Self { known: self.known.max(known), held: [self.held[1], held.height], ..shorter }
    }

    fn is_sure(&self, close: f64) -> bool {
        self.depth - self.known <= SURE * close
    }
}

/// A part of a tool without a body.
struct Part {
    /// From which height to which.
    heights: [f64; 2],
    /// Its clearance, as closely as ways out tell it; none where none was found.
    found: Option<Reading>,
    /// Where to cut it.
    cut: f64,
}

impl Part {
    fn most_depth(&self) -> f64 {
        self.found.map_or(f64::INFINITY, |found| found.error.max(0.0) - found.value)
    }
}

impl Bodies<'_> {
    /// How deep a tool without a body is, by a way in a direction that frees it: no place of the surface is deep in it, and what is under the
    /// surface may be anywhere along it. None inside where the way does not free it.
    fn led_out(&self, tip: &Vec3, mut out: Vec3, mut way: f64) -> Option<Option<Way>> {
        let mut found: Option<Way> = None;
        for _ in 0..DIRECTIONS {
            let Some(held) = self.freed(tip, &out, way)? else { break };
            let Held { least, normal, .. } = held;
            // The place that holds it there holds it as long as it is not moved as far in its own direction.
            let known = least * normal.dot(&out) - 3.0 * self.close();
            let so_far = found.map_or_else(|| Way::held(&held, known), |before| before.or(&held, known));
            found = Some(so_far);
            if so_far.is_sure(self.close()) {
                break;
            }
            (out, way) = (normal, least + self.close());
        }
        Some(found)
    }

    /// The clearance of a tool without a body, by that of its parts where no one way out says how deep it is: the way off the surface at one
    /// place of it leads along the surface at another, and each is as deep as it is for itself. None inside where parts are left that no way
    /// out was found for that says it closely.
    pub(super) fn led_out_in_parts(&self, tip: &Vec3, touch: &Touch) -> Option<Option<Reading>> {
        let length = self.tool.profile.top_height();
        let mut open = vec![self.part(tip, touch, [0.0, length])?];
        for _ in 0..CUTS {
            // That of which it is not known that it is less deep than the others.
            let depths = open.iter().map(Part::most_depth).enumerate();
            let (deepest, _) = depths.max_by(|a, b| a.1.total_cmp(&b.1))?;
            let part = open.swap_remove(deepest);
            match part.found {
                Some(found) if found.error <= SURE * self.close() => {
                    let place = found.place.map(|place| place + self.tool.axis * part.heights[0]);
                    return Some(Some(Reading { place, ..found }));
                }
                None if self.is_too_deep(tip, part.heights)? => return Some(None),
                _ => {}
            }
            let [low, high] = part.heights;
            for heights in [[low, part.cut], [part.cut, high]] {
                let profile = self.tool.profile.below(heights[1] - heights[0]);
                let tool = self.tool.with(&profile);
                let bodies = Bodies { tool: &tool, reach: heights[1] - heights[0], ..*self };
                let from = tip + self.tool.axis * heights[0];
                open.push(bodies.part(&from, &bodies.touch(&from)?, heights)?);
            }
        }
        Some(None)
    }

    /// What is found of the tool as a part of another, between two heights of that.
    fn part(&self, tip: &Vec3, touch: &Touch, heights: [f64; 2]) -> Option<Part> {
        let [low, high] = heights;
        let middle = 0.5 * (low + high);
        if touch.value > touch.gap && self.is_on_side(touch)? {
            let reading = Reading::new(touch.value, self.away(touch)?, touch.gap);
            let found = Some(Reading { place: Some(touch.opposite() - tip), ..reading });
            return Some(Part { heights, found, cut: middle });
        }
        let through = self.led_out(tip, self.away(touch)?, ASTRAY * self.deep)?;
        let past = self.led_past_end(tip, through.map_or(self.deep, |way| way.depth))?;
        let through_by = |way: Way| Reading {
            place: Some(self.tool.axis * way.height),
            ..Reading::new(-way.depth, way.normal, way.depth - way.known)
        };
        let found = past.or(through.map(through_by));
        let between = through.map_or(middle, |way| low + 0.5 * (way.held[0] + way.held[1]));
        let least = LEAST_SHARE * (high - low);
        let cut = if between > low + least && between < high - least { between } else { middle };
        Some(Part { heights, found, cut })
    }

    /// Whether a place in a part of the tool is deeper than is a question of tolerance.
    fn is_too_deep(&self, tip: &Vec3, [low, high]: [f64; 2]) -> Option<bool> {
        for height in [low, 0.5 * (low + high), high] {
            if self.depth(&(tip + self.tool.axis * height))?.depth > self.deep {
                return Some(true);
            }
        }
        Some(false)
    }

    /// What a way need not be closer than.
    pub(super) fn close(&self) -> f64 {
        4.0 * self.resolution
    }

    /// The least way in a direction, from one on that frees the tool, that is found to do so, and what holds it then.
    /// None inside where that way does not free it.
    fn freed(&self, tip: &Vec3, out: &Vec3, mut way: f64) -> Option<Option<Held>> {
        for _ in 0..PROOF_STEPS {
            let moved = tip + out * way;
            let touch = self.touch(&moved)?;
            let room = touch.value - touch.gap;
            if room <= 0.0 || !self.is_on_side(&touch)? {
                return Some(None);
            }
            if room <= 2.0 * self.close() {
                let height = self.tool.axis.dot(&(touch.opposite() - moved));
                return Some(Some(Held { least: way, normal: self.away(&touch)?, height }));
            }
            // Led back by what it is clear it is clear still.
            way -= room - self.close();
        }
        Some(None)
    }

    /// Whether every place of the surface is left behind in one of several directions, each across the surface where those before did not
    /// lead away from it, by as much as is deepest: what is deep at two places is not as deep as both together. Of a place that is left only
    /// the next direction is taken, so it need not be the deepest to the last digit; that the surface is left behind is not told where it
    /// takes too many looks.
    pub(super) fn is_left_behind(&self, tip: &Vec3, deepest: &Deepest) -> Option<bool> {
        let Some(sheet) = self.surface.sheet() else { return Some(false) };
        let depth = deepest.depth + 4.0 * self.close();
        let mut tips = vec![tip + deepest.out * depth];
        let mut cells = CELLS_LEFT_BEHIND;
        for _ in 0..DIRECTIONS {
            let touch =
                nearest_to_all(&sheet.patches, &tips, self.tool, self.resolution, self.deep, &mut cells)?;
            if cells == 0 {
                break;
            }
            if touch.value > touch.gap {
                // About the nearest place tells the side as the nearest does, but where the surface folds back within that little.
                return self.is_on_side(&touch);
            }
            let next = tip + self.away(&touch)? * depth;
            // What is not left behind in a direction is not left behind in it a second time.
            if tips.iter().any(|tip| (tip - next).norm() <= self.resolution) {
                break;
            }
            tips.push(next);
        }
        Some(false)
    }

    /// How much farther than the depth found the tool must be moved out until it is clear for certain; None where none of
    /// the translations tried frees it.
    pub(super) fn unproven(&self, tip: &Vec3, deepest: &Deepest, steps: usize) -> Option<Option<f64>> {
        let mut more = self.close();
        let most = more * FARTHER.powi(steps.saturating_sub(1) as i32);
        let mut less = 0.0;
        for _ in 0..steps {
            let touch = self.touch(&(tip + deepest.out * (deepest.depth + more)))?;
            if self.is_free(&touch)? {
                return self.closer(tip, deepest, [less, more]).map(Some);
            }
            less = more;
            // No place of the surface is left behind faster than the tool is moved.
            more = (FARTHER * more).max(more + self.resolution - touch.value);
            if more > most {
                break;
            }
        }
        Some(None)
    }

    /// Whether the tool is clear for certain. One without a body touches where it goes through.
    fn is_free(&self, touch: &Touch) -> Option<bool> {
        Some(touch.value > touch.gap && self.is_on_side(touch)?)
    }

    /// A way that frees the tool beyond a depth, between one that does not and one that does: the other way need not be much too long.
    fn closer(&self, tip: &Vec3, deepest: &Deepest, [mut less, mut more]: [f64; 2]) -> Option<f64> {
        for _ in 0..CLOSER {
            if more - less <= self.close() {
                break;
            }
            let middle = 0.5 * (less + more);
            let touch = self.touch(&(tip + deepest.out * (deepest.depth + middle)))?;
            if self.is_free(&touch)? {
                more = middle;
            } else {
                less = middle;
            }
        }
        Some(more)
    }
}
