//! How far the chord between two places of a polyconic surface is from it.

use super::PolyConicSheet;
use crate::{
    Vec3,
    surface::{
        Place,
        part::{Enclose, Rectangle},
    },
};

/// The conic parameters at which the straight ends begin: the place runs at another rate from there on.
const JOINTS: [f64; 2] = [0.0, 1.0];

impl PolyConicSheet {
    /// How far a curve of the surface between two places is from its chord at most; `None` where it may have a corner, and for one that is
    /// off its conics.
    ///
    /// Along each stretch between the joints both parameters change evenly: for `σ` from 0 to 1 the second derivative is
    /// `dtt Δt² + 2 dts Δt Δs + dss Δs²`. What of it is across the chord of the stretch by no more than b leaves the stretch within b/8 of that
    /// line, with a place beside each place of it; and the chords of the stretches are no farther from that of all than their ends.
    pub(in crate::surface) fn strays(&self, [from, to]: [&Place; 2]) -> Option<f64> {
        if self.form.thickness != 0.0 {
            return None;
        }
        let way = [0, 1].map(|k: usize| to.at[k] - from.at[k]);
        let at = |share: f64| [0, 1].map(|k: usize| from.at[k] + way[k] * share);
        let joints = if way[0] < 0.0 { [JOINTS[1], JOINTS[0]] } else { JOINTS };
        let crossed = joints.map(|joint| (joint - from.at[0]) / way[0]);
        let crossed = crossed.into_iter().filter(|share| *share > 0.0 && *share < 1.0);
        let ends = [from, to].map(|place| self.jet(place.at[0], place.at[1]).point);
        let chord = unit(&(ends[1] - ends[0]));
        let (mut last, mut start, mut aside, mut greatest) = (0.0, ends[0], 0.0_f64, 0.0_f64);
        for share in crossed.chain([1.0]) {
            let [[t0, s0], [t1, s1]] = [at(last), at(share)];
            let rectangle = Rectangle::between([t0.min(t1), t0.max(t1)], [s0.min(s1), s0.max(s1)]);
            let enclosure = self.enclose(&rectangle);
            if enclosure.split {
                return None;
            }
            let [t, s] = at(share);
            let end = self.jet(t, s).point;
            // Before the nose the derivatives are told against the parameter.
            let rise = (s1 - s0) * self.turned(rectangle.middle[1]);
            greatest = greatest.max(enclosure.bent([t1 - t0, rise]).across(&unit(&(end - start))));
            let off = end - ends[0];
            aside = aside.max((off - chord * chord.dot(&off)).norm());
            (last, start) = (share, end);
        }
        greatest.is_finite().then_some(aside + 0.125 * greatest)
    }
}

/// The direction of a way, none if it has no length.
fn unit(way: &Vec3) -> Vec3 {
    way.try_normalize(0.0).unwrap_or_else(Vec3::zeros)
}

#[cfg(test)]
mod tests {
    use super::super::super::{Place, Surface, sheet_tests};

    /// Beside each place of a chord is one of the surface, no farther away than is told: over a conic, along the stations, over the joints
    /// with the straight ends, and about a nose.
    #[test]
    fn chords_are_no_farther_from_the_surface_than_told() {
        let (mut seen, mut close) = (0, 0);
        for geometry in sheet_tests::sheets() {
            let Ok(surface) = Surface::from_geometry(&geometry) else { continue };
            let Surface::PolyConic(sheet) = &surface else { continue };
            for (from, to) in [
                ([0.2, 0.1], [0.2, 0.9]),
                ([0.3, 0.2], [0.45, 0.7]),
                ([-0.3, 0.8], [0.4, 0.1]),
                ([1.2, 0.3], [0.9, 0.35]),
                ([0.1, -0.2], [0.3, 0.1]),
                ([0.999, 0.5], [1.001, 0.501]),
            ] {
                let ends = [from, to].map(|at| Place { piece: 0, at });
                let Some(stray) = sheet.strays([&ends[0], &ends[1]]) else { continue };
                let [start, end] = ends.each_ref().map(|place| surface.chart(place).expect("a chart").point);
                seen += 1;
                close += usize::from(stray < 0.2 * (end - start).norm());
                for k in 0..=20 {
                    let middle = start + (end - start) * (f64::from(k) / 20.0);
                    let away = surface.signed_distance(&middle).abs();
                    assert!(away <= stray + 1e-9 * sheet.size, "{away} farther than {stray}");
                }
            }
        }
        assert!(seen >= 12 && close >= 6, "{seen} {close}");
    }
}
