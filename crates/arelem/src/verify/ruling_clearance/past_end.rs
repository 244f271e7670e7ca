//! How deep a tool is in a surface that ends beside it: what of it is under the surface by more may come out past the end by less.

use apt_geometry::Vec3;

use super::{Bodies, PROOF_STEPS, Ruled};
use crate::verify::{
    clearance::Reading,
    patch::{Patch, jet, sides},
    strip::{Touch, nearest},
    tool::Tool,
};

/// How many times as closely as is looked for the way past an end may be told for it to be the answer at once: another place may be as
/// deep.
const MOST_STEPS_PAST: f64 = 4.0;
/// How often the way past the tangent of an end is taken before what it leaves is gone off step by step.
const TANGENTS: usize = 5;
/// How far from the side of a patch, in its parameters, the end is whose tangent is taken.
const BY_END: f64 = 1e-3;
/// Directions about a tangent, off the own side of the surface, that are tried, and steps in which the best of them is closed in on, each to this share.
const DIRECTIONS_ABOUT: usize = 48;
const CLOSER: usize = 40;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl Ruled {
    /// Where it ends, as patches without width, and of which patch they are which side: what may be as near to a tool as a distance.
    fn ends_within(&self, tip: &Vec3, tool: &Tool<'_>, distance: f64) -> (Vec<Patch>, Vec<(usize, usize)>) {
        let Some(sheet) = self.sheet() else { return Default::default() };
        let (middle, girth) = tool.ball_about(tip);
        let all = sheet.patches.iter().enumerate();
        let near = all.filter(|(_, patch)| patch.within(&middle, distance + girth).is_some());
        let ends = near.flat_map(|(piece, patch)| {
            let is_end = self.ends(piece);
            let sides = sides(&patch.net).into_iter().enumerate().filter(move |(side, _)| is_end[*side]);
            sides.map(move |(side, curve)| (Patch::straight(&[curve, curve]), (piece, side)))
        });
        ends.unzip()
    }
}

impl Bodies<'_> {
    /// The clearance of a tool that is deepest at an end of the surface by the way past that; `other` is what is found without regard to
    /// the end. None inside where no such way frees it.
    pub(super) fn past_end(
        &self,
        tip: &Vec3,
        touch: &Touch,
        other: impl Fn() -> Option<Reading>,
    ) -> Option<Option<Reading>> {
        if touch.value > 0.0 || !self.surface.ends_at(touch) {
            return Some(None);
        }
        let Some(found) = self.moved_past_end(tip, touch)? else { return Some(None) };
        // No deeper than is allowed is as close as it is asked for.
        if found.error <= MOST_STEPS_PAST * self.close() || found.error - found.value <= self.tool.depth {
            return Some(Some(found));
        }
        // No place is deeper than the way that frees the tool.
        let is_better = |other: &Reading| {
            other.value - other.error >= found.value - found.error && other.error < found.error
        };
        Some(Some(other().filter(is_better).unwrap_or(found)))
    }

    /// The clearance of a tool that an end of the surface is deepest in, by the translation past that end. It is no deeper than a translation
    /// that frees it, and no less than its deepest place: it lies in the middle between both, with an error of half of what is between.
    /// None inside where it is not freed so.
    ///
    /// Where the end crosses an edge of the tool, one face of that is as near as the other, and to be moved off each in turn leads too
    /// far: the way is that past the tangent where the tool is met last. So it is where the way off leads to the other side of the surface.
    fn moved_past_end(&self, tip: &Vec3, first: &Touch) -> Option<Option<Reading>> {
        let natural = self.surface.natural(first)?;
        let (mut way, mut touch) = (Vec3::zeros(), *first);
        let mut shortest: Option<Vec3> = None;
        for step in 0..PROOF_STEPS {
            let push = way - touch.outward * (self.close() - touch.value);
            let pushed = self.is_off_own_side(first, &push)?.then_some(push);
            let is_close = touch.value.abs() <= MOST_STEPS_PAST * self.close();
            if shortest.is_some() && (is_close || touch.value < 0.0 || step > TANGENTS) {
                break;
            }
            let by_tangent = (1..=TANGENTS).contains(&step) && !is_close || pushed.is_none();
            let past = by_tangent.then(|| self.past_tangent(tip, &touch, &natural)).flatten();
            // Led back by what it is clear it is clear still.
            let back = shortest.map(|shortest| shortest * (1.0 - (touch.value - self.close()) / way.norm()));
            let is_shorter = |past: &Vec3| back.is_none_or(|back| past.norm() < back.norm());
            let next = past.filter(is_shorter).or(back).or(pushed);
            let Some(next) = next.filter(|way| way.norm() <= self.deep) else { break };
            way = next;
            touch = self.touch(&(tip + way))?;
            let is_freed = touch.value > touch.gap && self.is_on_side(&touch)?;
            if is_freed && shortest.is_none_or(|shortest| way.norm() < shortest.norm()) {
                shortest = Some(way);
            }
        }
        Some(shortest.map(|way| {
            let [least, most] = [-first.value, way.norm()];
            let error = 0.5 * (most - least).max(0.0);
            Reading::new(-0.5 * (least + most), way.normalize(), error)
        }))
    }

    /// The least translation on the own side that leaves the tangent of an end behind at a place by it, with the natural normal where the
    /// tool is deepest; none where there is no such end.
    fn past_tangent(&self, tip: &Vec3, touch: &Touch, natural: &Vec3) -> Option<Vec3> {
        let tangent = self.tangent_of_end(touch)?;
        let sideways = (natural * -self.side).cross(&tangent).try_normalize(0.0)?;
        let behind = tangent.cross(&sideways);
        let from = touch.point - tip;
        let outward = |angle: f64| behind * angle.cos() + sideways * angle.sin();
        // How far the tool goes beyond the tangent in a direction.
        let beyond = |angle: f64| {
            let outward = outward(angle);
            self.tool.support(&outward).0 - outward.dot(&from)
        };
        let last = std::f64::consts::FRAC_PI_2 * (1.0 - f64::EPSILON);
        let step = 2.0 * last / DIRECTIONS_ABOUT as f64;
        let angles = (0..=DIRECTIONS_ABOUT).map(|k| step * k as f64 - last);
        let best = angles.min_by(|a, b| beyond(*a).total_cmp(&beyond(*b)))?;
        let (mut low, mut high) = ((best - step).max(-last), (best + step).min(last));
        for _ in 0..CLOSER {
            let inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
            if beyond(inner[0]) <= beyond(inner[1]) {
                high = inner[1];
            } else {
                low = inner[0];
            }
        }
        let angle = 0.5 * (low + high);
        Some(-outward(angle) * (beyond(angle) + self.close()))
    }

    /// The direction of the end of the surface by a place.
    fn tangent_of_end(&self, touch: &Touch) -> Option<Vec3> {
        let patch = self.surface.sheet()?.patches.get(touch.piece)?;
        let Touch { along, across, .. } = *touch;
        let off = [along, 1.0 - along, across, 1.0 - across].into_iter().zip(self.surface.ends(touch.piece));
        let by = off.enumerate().filter(|(_, (off, is_end))| *is_end && *off <= BY_END);
        let (side, _) = by.min_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
        let [_, run, rise] = jet(&patch.net, [along, across]);
        (if side < 2 { rise } else { run }).try_normalize(0.0)
    }

    /// Whether a tool that is moved in a direction from a place comes off the surface on its own side.
    fn is_off_own_side(&self, touch: &Touch, out: &Vec3) -> Option<bool> {
        Some(self.side * self.surface.natural(touch)?.dot(out) >= 0.0)
    }

    /// The clearance of a tool without a body by the way that just frees it past an end of the surface that is no farther away than `most`.
    /// None inside where none does.
    pub(super) fn led_past_end(&self, tip: &Vec3, most: f64) -> Option<Option<Reading>> {
        let (ends, sides) = self.surface.ends_within(tip, self.tool, most);
        if ends.is_empty() {
            return Some(None);
        }
        let end = nearest(&ends, tip, self.tool, self.resolution, self.deep)?;
        let way = end.value + 2.0 * self.close();
        let (piece, side) = *sides.get(end.piece)?;
        let [along, across] = [[0.0, end.along], [1.0, end.along], [end.along, 0.0], [end.along, 1.0]][side];
        let at_end = Touch { piece, along, across, ..end };
        if way > most || !self.is_off_own_side(&at_end, &end.outward)? {
            return Some(None);
        }
        let touch = self.touch(&(tip + end.outward * way))?;
        let is_freed = touch.value > touch.gap && self.is_on_side(&touch)?;
        // Where it goes through the surface it goes on doing so as long as it meets neither an end of it nor what leads off it.
        Some(is_freed.then(|| Reading::new(-way, end.outward, 2.0 * self.close() + end.gap)))
    }
}
