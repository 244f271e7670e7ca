//! How deep a tool is in a surface that ends beside it: what of it is under the surface by more may come out past the end by less.

use apt_geometry::Vec3;

use super::{Bodies, PROOF_STEPS, Ruled};
use crate::verify::{
    clearance::Reading,
    patch::{Patch, sides},
    strip::{Touch, nearest},
    tool::Tool,
};

/// How many times as closely as is looked for the way past an end may be told for it to be the answer at once: another place may be as
/// deep.
const MOST_STEPS_PAST: f64 = 4.0;

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
        if found.error <= MOST_STEPS_PAST * self.close() {
            return Some(Some(found));
        }
        // No place is deeper than the way that frees the tool.
        let is_better = |other: &Reading| other.value >= found.value && other.error < found.error;
        Some(Some(other().filter(is_better).unwrap_or(found)))
    }

    /// The clearance of a tool that an end of the surface is deepest in, by the translation past that end: from each place that is deepest
    /// then it is moved off in turn. No translation that is less than the first depth frees it. None inside where it is not freed so.
    fn moved_past_end(&self, tip: &Vec3, first: &Touch) -> Option<Option<Reading>> {
        let (mut way, mut touch) = (Vec3::zeros(), *first);
        for _ in 0..PROOF_STEPS {
            way -= touch.outward * (self.close() - touch.value);
            if way.norm() > self.deep || !self.is_off_own_side(first, &way)? {
                break;
            }
            touch = self.touch(&(tip + way))?;
            if touch.value >= touch.gap {
                let error = way.norm() + first.value;
                let found = Reading { value: -way.norm(), normal: way.normalize(), error };
                return Some(self.is_on_side(&touch)?.then_some(found));
            }
        }
        Some(None)
    }

    /// Whether a tool that is moved in a direction from a place comes off the surface on its own side.
    fn is_off_own_side(&self, touch: &Touch, out: &Vec3) -> Option<bool> {
        Some(self.side * self.surface.natural(touch)?.dot(out) >= 0.0)
    }

    /// The clearance of a tool without a body by the lesser of the translations that just free it: off the surface where that is nearest,
    /// and past the end. None inside where neither is found.
    pub(super) fn led_out_anywhere(&self, tip: &Vec3, touch: &Touch) -> Option<Option<Reading>> {
        let through = self.led_out(tip, self.away(touch)?, self.deep)?;
        let less = through.map_or(self.deep, |found| -found.value);
        let past = self.led_past_end(tip, less)?;
        Some([through, past].into_iter().flatten().max_by(|a, b| a.value.total_cmp(&b.value)))
    }

    /// The same past an end of the surface that is no farther away than `most`.
    fn led_past_end(&self, tip: &Vec3, most: f64) -> Option<Option<Reading>> {
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
        let is_freed = touch.value >= touch.gap && self.is_on_side(&touch)?;
        // Where it goes through the surface it goes on doing so as long as it meets neither an end of it nor what leads off it.
        Some(is_freed.then(|| Reading {
            value: -way,
            normal: end.outward,
            error: 2.0 * self.close() + end.gap,
        }))
    }
}
