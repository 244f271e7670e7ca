//! Ways out of a surface for a tool that is in it: how far in a direction it must be moved at least, for certain.

use apt_geometry::Vec3;

use super::{Bodies, DIRECTIONS, Deepest, FARTHER, PROOF_STEPS};
use crate::verify::{
    clearance::Reading,
    strip::{Touch, nearest_to_all},
};

/// Halvings between the last way that does not free the tool and the first that does.
const CLOSER: usize = 6;

impl Bodies<'_> {
    /// The same from a direction in which so long a way frees the tool: no place of the surface is deep in it, and what is under the
    /// surface may be anywhere along it.
    pub(super) fn led_out(&self, tip: &Vec3, mut out: Vec3, mut way: f64) -> Option<Option<Reading>> {
        for _ in 0..DIRECTIONS {
            let Some((least, normal)) = self.freed(tip, &out, way)? else { return Some(None) };
            // The place that holds it there holds it as long as it is not moved as far in its own direction.
            let error = least * (1.0 - normal.dot(&out)) + 3.0 * self.close();
            if error <= 4.0 * self.close() {
                return Some(Some(Reading::new(-least, normal, error)));
            }
            (out, way) = (normal, least + self.close());
        }
        Some(None)
    }

    /// What a way need not be closer than.
    pub(super) fn close(&self) -> f64 {
        4.0 * self.resolution
    }

    /// The least way in a direction, from one on that frees the tool, that is found to do so, and the normal where the tool is nearest then.
    /// None inside where that way does not free it.
    fn freed(&self, tip: &Vec3, out: &Vec3, mut way: f64) -> Option<Option<(f64, Vec3)>> {
        for _ in 0..PROOF_STEPS {
            let touch = self.touch(&(tip + out * way))?;
            let room = touch.value - touch.gap;
            if room <= 0.0 || !self.is_on_side(&touch)? {
                return Some(None);
            }
            if room <= 2.0 * self.close() {
                return Some(Some((way, self.away(&touch)?)));
            }
            // Led back by what it is clear it is clear still.
            way -= room - self.close();
        }
        Some(None)
    }

    /// Whether every place of the surface is left behind in one of several directions, each across the surface where those before did not
    /// lead away from it, by as much as is deepest: what is deep at two places is not as deep as both together.
    pub(super) fn is_left_behind(&self, tip: &Vec3, deepest: &Deepest) -> Option<bool> {
        let Some(sheet) = self.surface.sheet() else { return Some(false) };
        let depth = deepest.depth + 4.0 * self.close();
        let mut tips = vec![tip + deepest.out * depth];
        for _ in 0..DIRECTIONS {
            let touch = nearest_to_all(&sheet.patches, &tips, self.tool, self.resolution, self.deep)?;
            if touch.value > touch.gap {
                return self.is_on_side(&touch);
            }
            tips.push(tip + self.away(&touch)? * depth);
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
