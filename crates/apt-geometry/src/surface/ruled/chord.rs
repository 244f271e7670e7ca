//! How far the chord between two places of a ruled surface is from it.

use super::{
    RuledSheet,
    bounds::{SMOOTH, Stretch},
};
use crate::{
    Vec3,
    surface::{
        Place,
        part::{Enclose, Rectangle},
    },
};

/// Bound of the pieces of the curves that a chord may go over: a longer one says nothing of use.
const MOST_PIECES: usize = 8;

impl RuledSheet {
    /// How far a curve of the surface between two places is from its chord at most; `None` where it has a corner, and where it would be long.
    ///
    /// Along the curve both parameters change evenly: for `σ` from 0 to 1 its second derivative is `duu Δt² + 2 duv Δt Δv`. What of it is
    /// across the chord by no more than b leaves the curve within b/8 of the line of the chord, with a place beside each place of that.
    pub(in crate::surface) fn strays(&self, ends: [&Place; 2]) -> Option<f64> {
        let [from, to] = if ends[0].at[0] <= ends[1].at[0] { ends } else { [ends[1], ends[0]] };
        if to.piece < from.piece || to.piece - from.piece >= MOST_PIECES {
            return None;
        }
        let [way, rise] = [0, 1].map(|k| to.at[k] - from.at[k]);
        let [start, end] = [from, to].map(|place| self.jet(place.piece, place.at[0], place.at[1]).point);
        let chord = (end - start).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let share_at =
            |t: f64| if way > 0.0 { from.at[1] + rise * ((t - from.at[0]) / way) } else { to.at[1] };
        let (mut last, mut greatest) = (from.at, 0.0_f64);
        for k in from.piece..=to.piece {
            let next = if k < to.piece {
                let piece = self.pieces.get(k)?;
                let joint = piece.from + piece.width;
                [joint, share_at(joint)]
            } else {
                to.at
            };
            let sorted = |k: usize| [last[k].min(next[k]), last[k].max(next[k])];
            let rectangle = Rectangle::between(sorted(0), sorted(1));
            let bends = Stretch { sheet: self, piece: k }.enclose(&rectangle);
            greatest = greatest.max(bends.bent([way, rise]).across(&chord));
            if k < to.piece {
                let [before, after] = [k, k + 1].map(|k| self.jet(k, next[0], next[1]).du);
                if (before - after).norm() > SMOOTH * before.norm() {
                    return None;
                }
            }
            last = next;
        }
        greatest.is_finite().then_some(0.125 * greatest)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Place, Surface, sheet_tests};

    /// Beside each place of a chord is one of the surface, no farther away than is told; a ruling is a chord on the surface.
    #[test]
    fn chords_are_no_farther_from_the_surface_than_told() {
        let mut seen = 0;
        for geometry in sheet_tests::sheets() {
            let Ok(surface) = Surface::from_geometry(&geometry) else { continue };
            let Surface::Ruled(sheet) = &surface else { continue };
            let place = |t: f64, v: f64| Place { piece: sheet.piece_at(t), at: [t, v] };
            let point = |place: &Place| sheet.jet(place.piece, place.at[0], place.at[1]).point;
            for (from, to) in [([0.2, 0.1], [0.2, 0.9]), ([0.3, 0.2], [0.45, 0.7]), ([0.7, 0.8], [0.6, 0.1])]
            {
                let ends = [from, to].map(|[t, v]| place(t, v));
                let Some(stray) = sheet.strays([&ends[0], &ends[1]]) else { continue };
                seen += 1;
                assert!(from[0] != to[0] || stray <= 1e-12 * sheet.size, "{stray:e} along a ruling");
                let [start, end] = ends.each_ref().map(point);
                for k in 0..=20 {
                    let middle = start + (end - start) * (f64::from(k) / 20.0);
                    let away = surface.signed_distance(&middle).abs();
                    assert!(away <= stray + 1e-9 * sheet.size, "{away} farther than {stray}");
                }
            }
        }
        assert!(seen >= 5, "{seen}");
    }
}
